// The graph of the pipeline against the files it speaks of.
#include "model/pipeline_graph.hpp"
#include "halfplane_paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "model/engines/cycle/stage_table.hpp"

namespace halfplane::pipeline_graph_test {
namespace {

const std::filesystem::path kRoot = HALFPLANE_SOURCE_DIR;

TEST(PipelineGraph, EveryStageIsAPairOfFilesOfItsNameAndAStageOfTheHostIsOne) {
  for (const StageInfo& stage : kStageInfo) {
    const std::string stem(stage.name), folder = stage.side == Side::host ? "model/host" : "model/stages";
    EXPECT_EQ(std::filesystem::exists(kRoot / folder / (stem + ".hpp")), stage.side != Side::memory) << stem;
    EXPECT_EQ(std::filesystem::exists(kRoot / "rtl_ref/stages" / (stem + ".sv")), stage.side == Side::rtl) << stem;
  }
}

TEST(PipelineGraph, ThePageOfThePipelineListsTheStagesInTheSameOrder) {
  std::ifstream page(kRoot / "docs" / "pipeline.md");
  std::vector<std::string> listed;
  for (std::string line; std::getline(page, line);)
    if (line.starts_with("| ") &&
        (line.find("| `stages/") != std::string::npos || line.find("| `host/") != std::string::npos))
      listed.push_back(line.substr(2, line.find(' ', 2) - 2));
  std::vector<std::string> stages;
  for (const StageInfo& stage : kStageInfo)
    if (stage.side != Side::memory) stages.emplace_back(stage.name);
  EXPECT_EQ(listed, stages);
}

TEST(PipelineGraph, TheStageTableIsInItsOrder) {
  for (const char* preset_name : {"embedded", "small"}) {
    const auto rows = stage_table(preset(preset_name));
    EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end(),
                               [](const StageRow& a, const StageRow& b) { return a.stage < b.stage; }));
  }
}

TEST(PipelineGraph, EveryStageOfTheRtlIsOnTheWayOfAnArrow) {
  std::set<Stage> reached, left;
  for (const ArrowInfo& arrow : kArrowInfo) {
    left.insert({arrow.from, arrow.via});
    reached.insert({arrow.to, arrow.via});
  }
  for (std::size_t i = 0; i < kStages; ++i) {
    const auto stage = static_cast<Stage>(i);
    if (info(stage).side != Side::rtl) continue;
    EXPECT_EQ(reached.count(stage), 1u) << info(stage).name;
    EXPECT_TRUE(left.count(stage) == 1 || stage == Stage::primitive_join) << info(stage).name;
  }
}

TEST(PipelineGraph, TheContextIsCoarseRastersAndAWriteIsBlamedByWhatDiffers) {
  EXPECT_EQ(suspect(Arrow::context), Stage::coarse_raster);
  EXPECT_EQ(suspect(Arrow::setup), Stage::triangle_setup);
  EXPECT_EQ(suspect(Arrow::write), Stage::rop);
  EXPECT_EQ(suspect(Arrow::write, {.is_of_line = true, .is_in_color_only = false}), Stage::depth_test);
  EXPECT_EQ(suspect(Arrow::write, {.is_of_line = false, .is_in_color_only = true}), Stage::rop);
  EXPECT_EQ(suspect(Arrow::fragment, {.is_of_line = true, .is_in_color_only = false}), Stage::primitive_join);
  EXPECT_EQ(suspect(Arrow::fragment, {.is_of_line = false, .is_in_color_only = false}), Stage::interpolate);
  EXPECT_EQ(suspect(Arrow::tile, {.is_of_line = true, .is_in_color_only = true}), Stage::coarse_raster);
}

/// The numbers of the stalls are in the hash: another number would be another run for every seed that anybody has noted.
TEST(PipelineGraph, AStallKeepsItsNumber) {
  EXPECT_EQ(kMemoryStall, 10);
  constexpr std::array kByNumber{Arrow::primitive, Arrow::triangle, Arrow::setup,    Arrow::tile, Arrow::stamp,
                                 Arrow::fragment,  Arrow::request,  Arrow::response, Arrow::line, Arrow::line_pixel};
  for (std::size_t i = 0; i < kByNumber.size(); ++i) EXPECT_EQ(stall_bit(kByNumber[i]), 1U << i);
  EXPECT_EQ(stall_bit(Arrow::beat), 1U << 11);
  EXPECT_EQ(stall_bit(Arrow::answer), 1U << 12);
}

}  // namespace
}  // namespace halfplane::pipeline_graph_test
