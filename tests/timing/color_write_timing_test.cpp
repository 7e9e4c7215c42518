// The cycles in which W accepts the next stamp: the times of block_timing.hpp without a memory.
#include <gtest/gtest.h>

#include <string>

#include "model/engines/cycle/block_timing.hpp"
#include "model/engines/cycle/port_timing.hpp"

namespace halfplane::color_write_timing_test {
namespace {

/// A memory that nothing is asked of.
struct NoMemory {
  LineTimes texture(Cycle, std::uint32_t, int) const { return {}; }
  PortTimes read(Cycle, TilePlane, const BlockStamp&) const {
    ADD_FAILURE() << "read";
    return {};
  }
  Cycle write(Cycle, TilePlane, const BlockStamp&, int) const {
    ADD_FAILURE() << "written";
    return 0;
  }
  [[nodiscard]] bool has_one_color(const BlockStamp&, SampleMask) const { return false; }
};

// Equal for the same stamp and for different stamps; with one lane a clock for each of its samples.
TEST(ColorWriteTiming, AStampIsBlendedAgainInTheNextClock) {
  for (const char* lanes : {"4", "1"}) {
    Config config = preset("embedded");
    set(config, "blend.lanes", lanes);
    const Widths widths = derive_widths(config);
    BlockTiming timing(config, widths);
    TagResult tags;
    tags.source = DepthSource::none;
    tags.color_source = DepthSource::chip;
    BlockItem item;
    item.mask = item.colors = SampleMask::all(widths.samples);
    item.color_write = item.blends = true;
    Cycle before = 0;
    for (Cycle n = 0; n < 50; ++n) {
      timing.take(100 + 4 * n / std::stoul(lanes), tags, item, {}, NoMemory{});
      if (n > 0) {
        EXPECT_EQ(timing.colored() - before, 4 / std::stoul(lanes)) << lanes << " lanes, " << n;
      }
      before = timing.colored();
    }
  }
}

// X likewise: a stamp is tested against the result of the previous stamp, with and without a stencil above the depth.
TEST(ColorWriteTiming, AStampIsTestedAgainInTheNextClock) {
  for (const char* stencil : {"0", "8"}) {
    Config config = preset("embedded");
    set(config, "stencil.bits", stencil);
    const Widths widths = derive_widths(config);
    BlockTiming timing(config, widths);
    TagResult tags;
    tags.source = DepthSource::clear;
    BlockItem item;
    item.mask = SampleMask::all(widths.samples);
    item.depth_write = item.wrote_depth = true;
    Cycle before = 0;
    for (Cycle n = 0; n < 50; ++n) {
      timing.take(100 + n, tags, item, {}, NoMemory{});
      if (n > 0) {
        EXPECT_EQ(timing.tested() - before, 1U) << "stencil.bits=" << stencil << ", " << n;
      }
      before = timing.tested();
      tags.source = DepthSource::chip;
    }
  }
}

}  // namespace
}  // namespace halfplane::color_write_timing_test
