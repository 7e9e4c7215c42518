// halfplane_light_table: a light for hp_state::light, as C source. For a host: roots and binary64 are the model's.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "model/input_error.hpp"
#include "model/stages/phong.hpp"

namespace halfplane {
namespace {

double number(const std::string& word, double low, double high) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != '\0' || !(value >= low && value <= high))
    throw InputError("'" + word + "' is no number from " + std::to_string(low) + " to " + std::to_string(high));
  return value;
}

std::array<std::uint8_t, 3> color(const std::string& word) {
  char* end = nullptr;
  const unsigned long value = std::strtoul(word.c_str(), &end, 16);
  if (word.size() != 6 || *end != '\0') throw InputError("'" + word + "' is no colour RRGGBB");
  return {static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8),
          static_cast<std::uint8_t>(value)};
}

void run(const std::vector<std::string>& words) {
  if (words.size() != 11)
    throw InputError("give NAME LX LY LZ HX HY HZ AMBIENT DIFFUSE SPECULAR SHININESS: colours as RRGGBB");
  PhongLight::Given given;
  for (std::size_t i = 0; i < 3; ++i) {
    given.direction[i] = number(words[1 + i], -32768, 32768);
    given.half[i] = number(words[4 + i], -32768, 32768);
  }
  given.ambient = color(words[7]);
  given.diffuse = color(words[8]);
  given.specular = color(words[9]);
  given.shininess = number(words[10], 1, 128);
  const PhongLight light(given);
  const char* name = words[0].c_str();
  std::printf("/* halfplane_light_table");
  for (const std::string& word : words) std::printf(" %s", word.c_str());
  std::printf("; do not edit. */\n#include \"halfplane.h\"\n\nstatic const hp_light_line %s_lines[256] = {", name);
  for (std::size_t i = 0; i < light.lines().size(); ++i) {
    const char* between = ", ";
    if (i % 8 == 0) between = i == 0 ? "\n    " : ",\n    ";
    std::printf("%s{%d, %d}", between, light.lines()[i].start, light.lines()[i].fall);
  }
  const auto& [lx, ly, lz] = light.direction();
  const auto& [hx, hy, hz] = light.half();
  std::printf("};\nconst hp_light %s = {{%d, %d, %d}, {%d, %d, %d}", name, lx, ly, lz, hx, hy, hz);
  for (const auto& c : {given.ambient, given.diffuse, given.specular})
    std::printf(", HP_RGBA(%d, %d, %d, 0)", c[0], c[1], c[2]);
  std::printf(", %s_lines, %d};\n", name, light.narrow());
}

}  // namespace
}  // namespace halfplane

int main(int argc, char** argv) {
  try {
    halfplane::run({argv + 1, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "halfplane_light_table: %s\n", error.what());
    return 2;
  }
}
