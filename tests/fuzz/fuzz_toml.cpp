// Any bytes as a configuration file: either a valid configuration or an InputError of one line, never anything else.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "sim/config_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  halfplane::Config config;
  try {
    config = halfplane::read_config_toml(text, "input.toml");
  } catch (const halfplane::InputError& error) {
    const std::string_view message(error.what());
    if (!message.starts_with("input.toml") || message.find('\n') != std::string_view::npos) std::abort();
  }
  halfplane::validate(config);  // an accepted configuration is valid: a throw from here ends the fuzzer
  return 0;
}
