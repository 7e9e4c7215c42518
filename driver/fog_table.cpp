// halfplane_fog_table: a table of fog for hp_state::fog, as C source. For a host: exp() and binary64 are the model's.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "model/input_error.hpp"
#include "model/stages/fog.hpp"

namespace halfplane {
namespace {

double number(const std::string& word) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != '\0' || !(value >= 0 && value <= 32768))
    throw InputError("'" + word + "' is no number from 0 to 32768");
  return value;
}

void run(const std::vector<std::string>& words) {
  Fog fog;
  if (words.size() == 4 && words[1] == "linear") {
    fog = {FogKind::linear, number(words[2]), number(words[3])};
    if (fog.end <= fog.start) throw InputError("a linear fog ends beyond its start");
  } else if (words.size() == 3 && (words[1] == "exp" || words[1] == "exp2")) {
    fog = {words[1] == "exp" ? FogKind::exp : FogKind::exp2, number(words[2]), 1};
  } else {
    throw InputError("give NAME linear START END, NAME exp DENSITY or NAME exp2 DENSITY");
  }
  const FogTable table(fog);
  const char* name = words[0].c_str();
  std::printf("/* halfplane_fog_table");
  for (const std::string& word : words) std::printf(" %s", word.c_str());
  std::printf("; do not edit. */\n#include \"halfplane.h\"\n\nstatic const hp_fog_line %s_lines[256] = {", name);
  for (std::size_t i = 0; i < table.lines().size(); ++i)
    std::printf("%s{%d, %d}",
                i == 0       ? "\n    "
                : i % 8 == 0 ? ",\n    "
                             : ", ",
                table.lines()[i].start, table.lines()[i].rise);
  std::printf("};\nconst hp_fog %s = {%s_lines, %d, %d};\n", name, name, table.first(), table.octave_bits());
}

}  // namespace
}  // namespace halfplane

int main(int argc, char** argv) {
  try {
    halfplane::run({argv + 1, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "halfplane_fog_table: %s\n", error.what());
    return 2;
  }
}
