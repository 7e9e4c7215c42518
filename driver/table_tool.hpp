// The common part of the tools that write a table of 256 lines as C source: arguments, lines, main().
#pragma once

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "model/input_error.hpp"

namespace halfplane {

/// Throws InputError for what is no number, or outside `low` to `high`.
inline double number(const std::string& word, int low, int high) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != '\0' || !(value >= low && value <= high))
    throw InputError("'" + word + "' is no number from " + std::to_string(low) + " to " + std::to_string(high));
  return value;
}

/// Prints the head of the source and NAME_lines[256] of `type`; `pair` gives the two members of a line.
template <class Lines, class Pair>
void print_lines(const char* tool, const std::vector<std::string>& words, const char* type, const Lines& lines,
                 Pair pair) {
  std::printf("/* %s", tool);
  for (const std::string& word : words) std::printf(" %s", word.c_str());
  std::printf("; do not edit. */\n#include \"halfplane.h\"\n\nstatic const %s %s_lines[256] = {", type,
              words[0].c_str());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const char* between = ", ";
    if (i % 8 == 0) between = i == 0 ? "\n    " : ",\n    ";
    const auto [first, second] = pair(lines[i]);
    std::printf("%s{%d, %d}", between, int{first}, int{second});
  }
  std::printf("};\n");
}

/// main() of a tool. Exit status 0, or 2 and a line on stderr.
inline int run_tool(const char* tool, void (*run)(const std::vector<std::string>&), int argc, char** argv) {
  try {
    run({argv + 1, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", tool, error.what());
    return 2;
  }
}

}  // namespace halfplane
