#include "verilated_messages.hpp"

#include <verilated.h>

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace {

std::string& said() {
  thread_local std::string text;
  return text;
}

}  // namespace

void halfplane_verilated_print(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  std::va_list again;
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, again);
  va_end(again);
  std::string text(static_cast<std::size_t>(length < 0 ? 0 : length), ' ');
  std::vsnprintf(text.data(), text.size() + 1, format, arguments);
  va_end(arguments);
  said() += text;
}

/// Ends a simulation that cannot go on: the message must be seen.
void vl_fatal(const char* file, int line, const char* /*where*/, const char* message) {
  std::fprintf(stderr, "%sVerilator: %s:%d: %s\n", said().c_str(), file, line, message);
  std::abort();
}

namespace halfplane {

std::string take_verilated_text() { return std::exchange(said(), {}); }

std::string assertion_message(const std::string& text) {
  // "[0] %Error: FILE.sv:LINE: Assertion failed in SCOPE: MESSAGE"
  constexpr const char* kFailed = "Assertion failed in ";
  std::string message = text;
  if (const std::size_t scope = text.find(kFailed); scope != std::string::npos)
    if (const std::size_t colon = text.find(": ", scope); colon != std::string::npos) message = text.substr(colon + 2);
  return message.substr(0, message.find('\n'));
}

}  // namespace halfplane
