// Functional coverage: the table of bins, what hits them, holes of a stimulus that lacks something, and merging.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "model/capture/capture.hpp"
#include "sim/cosim/dut.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/cosim/session.hpp"
#include "sim/cover/bins.hpp"
#include "sim/cover/collector.hpp"
#include "sim/cover/report.hpp"

namespace halfplane::coverage_bins_test {
namespace {

using cover::BinResult;
using cover::Collector;
using cover::Report;
using cover::Source;

Report covered(const Config& config, const SceneSource& scenes) {
  Collector collector(config);
  while (const auto scene = scenes()) collector.run(*scene, config);
  return cover::report_of(collector.hits(), config, {}, Source::model);
}

Report covered(const Config& config, std::uint64_t count, const std::string& knobs = "") {
  const RandomProfile profile = knobs.empty() ? RandomProfile{} : read_random_profile(knobs, config);
  return covered(config, random_scenes(config, 1, count, profile));
}

Report covered(const std::string& capture, const Config& config = preset("embedded")) {
  return covered(config, single_scene(read_capture("halfplane 1\ntarget 64 64\nspace window\n" + capture, "")));
}

const BinResult& bin(const Report& report, const std::string& name) {
  const auto found = std::ranges::find(report.bins, name, &BinResult::name);
  if (found == report.bins.end()) throw std::runtime_error("no bin " + name);
  return *found;
}
std::uint64_t hits(const Report& report, const std::string& name) { return bin(report, name).hits; }
bool is_hole(const Report& report, const std::string& name) { return bin(report, name).is_hole(); }

std::set<std::string> holes(const Report& report) {
  std::set<std::string> names;
  for (const BinResult& one : report.bins)
    if (one.is_hole()) names.insert(one.name);
  return names;
}

TEST(CoverageBins, NamesAreDistinctAndFaultsExist) {
  std::set<std::string> names;
  std::set<int> faults;
  for (const Mutant& mutant : mutants()) faults.insert(mutant.id);
  for (const cover::Bin& one : cover::bins()) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    EXPECT_EQ(one.what.find('*'), std::string::npos) << one.name;
    std::istringstream numbers{std::string(one.row->faults)};
    for (int fault = 0; numbers >> fault;)
      EXPECT_TRUE(faults.empty() || faults.count(fault) == 1) << one.name << " names fault " << fault;
    EXPECT_NO_THROW((void)cover::missing_setting(*one.row, Config{}));
  }
}

// A square of two triangles whose left and top sides, diagonal and corners lie on pixel centres: by hand.
TEST(CoverageBins, TiesOfATriangleByHand) {
  const Report tied = covered("v 8.5 8.5 .5\nv 12.5 8.5 .5\nv 8.5 12.5 .5\nt 0 1 2\n");
  EXPECT_EQ(hits(tied, "tie.top"), 1U);  // the top edge: 4 centres, in two tiles, of which one holds pixels on it
  EXPECT_EQ(hits(tied, "tie.left"), 1U);
  EXPECT_EQ(hits(tied, "tie.other"), 1U);  // the diagonal
  EXPECT_EQ(hits(tied, "tie.corner"), 1U);
  const Report beside = covered("v 8.25 8.25 .5\nv 12.3125 8.25 .5\nv 8.25 12.4375 .5\nt 0 1 2\n");
  for (const char* name : {"tie.top", "tie.left", "tie.other", "tie.corner"})
    EXPECT_TRUE(is_hole(beside, name)) << name;
}

TEST(CoverageBins, TilesOfATriangleByHand) {
  const Report large = covered("v 0 0 .5\nv 60 0 .5\nv 0 60 .5\nt 0 1 2\n");
  EXPECT_GT(hits(large, "tile.accepted"), 10U);
  EXPECT_GT(hits(large, "tile.cut"), 5U);
  EXPECT_EQ(hits(large, "tile.rejected"), 1U);  // counted for a primitive
  const Report small = covered("v 1 1 .5\nv 5 1 .5\nv 1 5 .5\nt 0 1 2\n");
  EXPECT_TRUE(is_hole(small, "tile.accepted"));
  EXPECT_TRUE(is_hole(small, "tile.rejected"));
}

TEST(CoverageBins, EqualDepthsAreCountedByFunction) {
  const std::string twice = "v 1 1 .5\nv 20 1 .5\nv 1 20 .5\nt 0 1 2\nt 0 1 2\n";
  const Report lequal = covered("state depth_test lequal\n" + twice);
  EXPECT_GT(hits(lequal, "depth.equal.lequal"), 100U);
  EXPECT_EQ(hits(lequal, "depth.equal.less"), 0U);
  EXPECT_EQ(hits(lequal, "depth.fail.lequal"), 0U);
  const Report less = covered(twice);
  EXPECT_EQ(hits(less, "depth.fail.less"), hits(less, "depth.equal.less"));
}

TEST(CoverageBins, HizBinsTellSkippedTilesFromTilesThatTheLagLetsPass) {
  Config config = preset("embedded");
  const std::string full = "v 0 0 .2\nv 128 0 .2\nv 0 128 .2\nt 0 1 2\n",
                    behind = "v 0 0 .8\nv 128 0 .8\nv 0 128 .8\nt 3 4 5\n";
  const Report report = covered(full + behind, config);
  EXPECT_GT(hits(report, "hiz.lag"), 0U);
  EXPECT_EQ(hits(report, "hiz.skip"), 1U);
  config.hiz_bits = 0;
  EXPECT_EQ(bin(covered(full + behind, config), "hiz.lag").excluded, "needs hiz.bits");
}

TEST(CoverageBins, StencilWrapsAreCounted) {
  const std::string head = "clear stencil 255 depth 1\n", drawn = "v 1 1 .5\nv 20 1 .5\nv 1 20 .5\nt 0 1 2\n";
  const Config config = preset("stencilled");
  const Report wraps = covered(head + "state stencil always 0 255 255 keep keep incr_wrap\n" + drawn, config);
  EXPECT_GT(hits(wraps, "stencil.wrap.incr"), 100U);
  EXPECT_TRUE(is_hole(wraps, "stencil.wrap.decr"));
  EXPECT_TRUE(is_hole(wraps, "stencil.hold.incr"));
  const Report holds = covered(head + "state stencil always 0 255 255 keep keep incr\n" + drawn, config);
  EXPECT_GT(hits(holds, "stencil.hold.incr"), 100U);
  EXPECT_TRUE(is_hole(holds, "stencil.wrap.incr"));
}

// The default stimulus leaves no hole but those that need something else, which their options give.
TEST(CoverageBins, TheDefaultStimulusHitsWhatItCan) {
  const Report report = covered(preset("embedded"), 20'000);
  EXPECT_EQ(holes(report), (std::set<std::string>{"clip.outside", "bin.part", "flush.drops_depth"}));
  EXPECT_EQ(cover::totals_of(report).pairs_hit, cover::totals_of(report).pairs);
}

TEST(CoverageBins, WhatIsExcludedIsNeverHit) {
  for (const Design& design : designs()) {
    const Report report = covered(design.config, 150);
    std::size_t excluded = 0;
    for (const BinResult& one : report.bins) {
      if (one.excluded.empty()) continue;
      EXPECT_EQ(one.hits, 0U) << design.name << ": " << one.name << ' ' << one.excluded;
      ++excluded;
    }
    EXPECT_GT(excluded, 8U) << design.name;
  }
}

// Mutants of the stimulus: what each leaves out shows as holes, and only that.
TEST(CoverageBins, AStimulusThatLacksSomethingHasHoles) {
  const Config config = preset("embedded");
  const Report whole = covered(config, 4000);
  const auto lacks = [&](const std::string& knobs, const std::vector<std::string>& names) {
    const Report report = covered(config, 4000, knobs);
    for (const std::string& name : names) {
      EXPECT_FALSE(is_hole(whole, name)) << name;
      EXPECT_TRUE(is_hole(report, name)) << knobs << " hits " << name;
    }
    EXPECT_FALSE(is_hole(report, "stamp.partial")) << knobs;
  };
  lacks("points", {"tie.top", "tie.left", "tie.other", "tie.corner", "tile.cut", "hiz.skip", "draw.triangles"});
  lacks("triangles,less,no-clears",
        {"depth.equal.lequal", "depth.equal.equal", "depth.pass.greater", "hiz.raising", "line.tie"});
  lacks("triangles,size=1..4", {"tile.saturated"});
  lacks("no-scissor", {"scissor"});
  lacks("no-clears", {"clear.depth", "clear.color"});
}

// A generator that keeps every corner off the grid on which edges meet pixel centres.
TEST(CoverageBins, AStimulusWithoutTiesHasThemAsHoles) {
  std::string capture;
  for (int n = 0; n < 300; ++n) {
    const int x = n % 20, y = n / 20;
    capture += "v " + std::to_string(x) + " " + std::to_string(y) + " .5\nv " + std::to_string(x + 24) + " " +
               std::to_string(y) + " .5\nv " + std::to_string(x) + " " + std::to_string(y + 12) +
               " .5\n";  // x/24 + y/12
  }
  for (int n = 0; n < 300; ++n)
    capture += "t " + std::to_string(3 * n) + " " + std::to_string(3 * n + 1) + " " + std::to_string(3 * n + 2) + "\n";
  const Report report = covered(capture);
  for (const char* name : {"tie.top", "tie.left", "tie.other", "tie.corner"})
    EXPECT_TRUE(is_hole(report, name)) << name;
  EXPECT_FALSE(is_hole(report, "tile.cut"));
}

// The options beside a pair that was not drawn draw it.
TEST(CoverageBins, OptionsOfAMissingPairDrawIt) {
  const Config config = preset("blended");
  const auto missing = covered("v 1 1 .5\nv 9 1 .5\nv 1 9 .5\nt 0 1 2\n", config).missing_pairs();
  ASSERT_GT(missing.size(), 7000U);
  const std::string head = "--random 2000 --random-only '";
  for (std::size_t n = 0; n < missing.size(); n += missing.size() / 40) {
    const cover::MissingPair& pair = missing[n];
    ASSERT_TRUE(pair.hit_by.starts_with(head) && pair.hit_by.ends_with("'")) << pair.hit_by;
    const Report drawn = covered(config, 300, pair.hit_by.substr(head.size(), pair.hit_by.size() - head.size() - 1));
    const auto left = drawn.missing_pairs();
    EXPECT_TRUE(std::ranges::none_of(left,
                                     [&](const cover::MissingPair& one) {
                                       return one.a == pair.a && one.b == pair.b && one.a_value == pair.a_value &&
                                              one.b_value == pair.b_value;
                                     }))
        << pair.a << ' ' << pair.a_value << ", " << pair.b << ' ' << pair.b_value << ": " << pair.hit_by;
  }
}

TEST(CoverageBins, HitsAddAndAnExclusionEndsWhereOneRunHasTheHardware) {
  const Report plain = covered("v 1 1 .5\nv 9 1 .5\nv 1 9 .5\nt 0 1 2\n");
  const Report stencilled = covered("v 1 1 .5\nv 9 1 .5\nv 1 9 .5\nt 0 1 2\n", preset("stencilled"));
  Report both;
  both.merge(plain);
  both.merge(stencilled);
  EXPECT_EQ(hits(both, "stamp.partial"), hits(plain, "stamp.partial") + hits(stencilled, "stamp.partial"));
  EXPECT_EQ(bin(plain, "stencil.back").excluded, "needs stencil.bits");
  EXPECT_TRUE(is_hole(both, "stencil.back"));
  EXPECT_EQ(cover::totals_of(both).pairs, cover::totals_of(stencilled).pairs);
  EXPECT_GT(cover::totals_of(stencilled).pairs, cover::totals_of(plain).pairs);
  const auto missing = plain.missing_pairs();
  ASSERT_FALSE(missing.empty());
  EXPECT_EQ(missing.front().hit_by.substr(0, 14), "--random 2000 ");
}

TEST(CoverageBins, AFileReadsBackAsItWasWritten) {
  const std::string path = testing::TempDir() + "coverage_bins_test.json";
  const Report report = covered(preset("tiny"), 300);
  cover::write_coverage(path, report);
  const Report read = cover::read_coverage(path);
  EXPECT_EQ(cover::summary_line(read), cover::summary_line(report));
  ASSERT_EQ(read.bins.size(), report.bins.size());
  for (std::size_t n = 0; n < read.bins.size(); ++n) {
    EXPECT_EQ(read.bins[n].hits, report.bins[n].hits);
    EXPECT_EQ(read.bins[n].excluded, report.bins[n].excluded);
  }
  std::ofstream(path) << "{\"schema\": \"halfplane.coverage/1\"}";
  EXPECT_THROW((void)cover::read_coverage(path), InputError);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace halfplane::coverage_bins_test
