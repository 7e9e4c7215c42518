// halfplane_light_table: a light for hp_state::light, as C source. For a host: roots and binary64 are the model's.
#include "model/stages/phong.hpp"
#include "table_tool.hpp"

namespace halfplane {
namespace {

constexpr const char* kTool = "halfplane_light_table";

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
  print_lines(kTool, words, "hp_light_line", light.lines(),
              [](const auto& line) { return std::pair(line.start, line.fall); });
  const auto& [lx, ly, lz] = light.direction();
  const auto& [hx, hy, hz] = light.half();
  std::printf("const hp_light %s = {{%d, %d, %d}, {%d, %d, %d}", name, lx, ly, lz, hx, hy, hz);
  for (const auto& c : {given.ambient, given.diffuse, given.specular})
    std::printf(", HP_RGBA(%d, %d, %d, 0)", c[0], c[1], c[2]);
  std::printf(", %s_lines, %d};\n", name, light.narrow());
}

}  // namespace
}  // namespace halfplane

int main(int argc, char** argv) { return halfplane::run_tool(halfplane::kTool, halfplane::run, argc, argv); }
