// halfplane_fog_table: a table of fog for hp_state::fog, as C source. For a host: exp() and binary64 are the model's.
#include "model/stages/fog.hpp"
#include "table_tool.hpp"

namespace halfplane {
namespace {

constexpr const char* kTool = "halfplane_fog_table";

void run(const std::vector<std::string>& words) {
  Fog fog;
  if (words.size() == 4 && words[1] == "linear") {
    fog = {FogKind::linear, number(words[2], 0, 32768), number(words[3], 0, 32768)};
    if (fog.end <= fog.start) throw InputError("a linear fog ends beyond its start");
  } else if (words.size() == 3 && (words[1] == "exp" || words[1] == "exp2")) {
    fog = {words[1] == "exp" ? FogKind::exp : FogKind::exp2, number(words[2], 0, 32768), 1};
  } else {
    throw InputError("give NAME linear START END, NAME exp DENSITY or NAME exp2 DENSITY");
  }
  const FogTable table(fog);
  const char* name = words[0].c_str();
  print_lines(kTool, words, "hp_fog_line", table.lines(),
              [](const auto& line) { return std::pair(line.start, line.rise); });
  std::printf("const hp_fog %s = {%s_lines, %d, %d};\n", name, name, table.first(), table.octave_bits());
}

}  // namespace
}  // namespace halfplane

int main(int argc, char** argv) { return halfplane::run_tool(halfplane::kTool, halfplane::run, argc, argv); }
