// docs/pipeline.md holds the figures that the cycle model computes with.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "halfplane_paths.hpp"
#include "model/engines/cycle/stage_table.hpp"

namespace halfplane {
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

}  // namespace
}  // namespace halfplane
