// docs/pipeline.md holds the figures that the cycle model computes with.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "halfplane_paths.hpp"
#include "model/engines/cycle/stage_table.hpp"

namespace halfplane::stage_table_test {
namespace {

TEST(StageTable, TheOnesInThePipelinePageAreThoseOfTheCode) {
  std::ifstream file(HALFPLANE_SOURCE_DIR "/docs/pipeline.md");
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  for (const char* name : {"embedded", "small"}) {
    const std::string table = stage_table_markdown(preset(name));
    EXPECT_NE(page.find(table), std::string::npos) << "halfplane config --config " << name << " --stages prints\n"
                                                   << table;
  }
}

// The figures of rtl_ref/stages/triangle_setup.sv: phases up to the offer, and as many triangles as parts.
TEST(StageTable, TwoClocksAPlaneMakeASetupHalfAsOftenInFewerParts) {
  const auto setup = [](const char* unit, int clocks) {
    Config config = preset("embedded");
    set(config, "texture.unit", unit);
    config.setup_plane_clocks = clocks;
    for (const StageRow& row : stage_table(config))
      if (row.stage == Stage::triangle_setup) return row.latency + "; " + row.interval + "; " + row.holds;
    return std::string("none");
  };
  EXPECT_EQ(setup("off", 1), "21; 4; 6");
  EXPECT_EQ(setup("off", 2), "25; 8; 4");
  EXPECT_EQ(setup("nearest", 1), "25; 7, of a state 1; 4, 8 states, 1 of either");
  EXPECT_EQ(setup("nearest", 2), "32; 14, of a state 1; 3, 8 states, 1 of either");
}

}  // namespace
}  // namespace halfplane::stage_table_test
