// Binned order (frame.order bins) against program order: the same picture and the same counts, and no depth in memory
// unless requested.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/functional.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/scene/builtin.hpp"
#include "tests/hardware_scene.hpp"
#include "tests/scene_builder.hpp"

namespace halfplane::frame_bins_test {
namespace {

using test::at;
using test::SceneBuilder;
using test::with;

Config in_bins(Config config, FrameStore store = FrameStore::all) {
  config.frame_order = FrameOrder::bins;
  config.frame_store = store;
  return config;
}

std::vector<HostPrimitive> sent(const Scene& scene, const Config& config) {
  HostStream host(scene, config);
  std::vector<HostPrimitive> all;
  while (auto primitive = host.next()) all.push_back(*primitive);
  return all;
}

std::size_t count(const std::vector<HostPrimitive>& primitives, PrimitiveKind kind) {
  return static_cast<std::size_t>(
      std::ranges::count_if(primitives, [kind](const HostPrimitive& p) { return p.packet.kind == kind; }));
}

/// The requests of a scene, by plane.
std::map<TilePlane, std::size_t> requests(const Scene& scene, const Config& config) {
  test::Recorder recorder;
  (void)test::run_scene(scene, config, recorder);
  std::map<TilePlane, std::size_t> by_plane;
  for (const MemoryRequest& request : recorder.requests) ++by_plane[request.plane];
  return by_plane;
}

/// Hardware model and cycle engine in bins show the functional engine's picture and count the counters of program
/// order.
void expect_equal_in_bins(const Scene& scene, const Config& config) {
  const Rendering expected = render_functional(scene, config, {});
  const Counters program = render_hardware(scene, config).counters;
  for (const FrameStore store : {FrameStore::all, FrameStore::color}) {
    const Config bins = in_bins(config, store);
    const Rendering hardware = render_hardware(scene, bins);
    const auto memory = make_memory({}, bins);
    const Rendering cycle = render_cycle(scene, bins, *memory).rendering;
    EXPECT_EQ(hardware.frame.color, expected.frame.color);
    EXPECT_EQ(cycle.frame.color, expected.frame.color);
    if (store == FrameStore::all) {
      EXPECT_EQ(hardware.frame.depth, expected.frame.depth);
      EXPECT_EQ(cycle.frame.depth, expected.frame.depth);
    }
    for (const Counters& counters : {hardware.counters, cycle.counters}) {
      for (const auto member : {&Counters::depth_passed, &Counters::written, &Counters::primitives_in,
                                &Counters::culled, &Counters::drawn, &Counters::clipped})
        EXPECT_EQ(counters.*member, program.*member);
      EXPECT_EQ(counters.skipped.frustum, program.skipped.frustum);
      EXPECT_EQ(counters.skipped.backface, program.skipped.backface);
      EXPECT_EQ(counters.skipped.zero_area, program.skipped.zero_area);
      EXPECT_EQ(counters.skipped.empty, program.skipped.empty);
    }
    EXPECT_EQ(cycle.counters.bins, hardware.counters.bins);
    EXPECT_EQ(cycle.counters.pairs, hardware.counters.pairs);
  }
}

TEST(FrameBins, EveryBuiltInSceneIsThatOfProgramOrder) {
  for (const Builtin& builtin : builtin_scenes()) {
    SCOPED_TRACE(builtin.name);
    expect_equal_in_bins(make_builtin(builtin.name, 200, 150, {}, 1), preset("embedded"));
  }
}

// Bins of 64x64 pixels and 64x32, of less than a tile, of one block, of more than the target; stamps of one block.
TEST(FrameBins, RandomScenesAreThoseOfProgramOrderWhateverTheBin) {
  const std::vector<Config> configs{preset("embedded"),
                                    preset("full"),
                                    with("embedded", {{"cache.lines", "128"}, {"hiz.lag", "2"}}),
                                    with("embedded", {{"cache.lines", "4"}, {"tile.size", "32"}, {"stamp.size", "1"}}),
                                    with("embedded", {{"cache.lines", "1"}, {"tile.size", "4"}}),
                                    with("embedded", {{"cache.lines", "4096"}, {"frame.clears", "flags"}}),
                                    with("tiny", {{"cache.kind", "blocks"}, {"cache.lines", "2"}})};
  for (const Config& config : configs)
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      SCOPED_TRACE(label(config) + ", seed " + std::to_string(seed));
      expect_equal_in_bins(random_scene(config, seed, 60), config);
    }
}

TEST(FrameBins, ATriangleIsSentOnceForEachBinThatItTouches) {
  SceneBuilder builder(640, 480);
  builder
      .triangle(at(10, 10), at(60, 10), at(10, 60))               // one bin
      .triangle(at(60, 10), at(70, 10), at(60, 20))               // two
      .triangle(at(0, 0), at(640, 0), at(0, 480))                 // bins on its diagonal, and above
      .triangle(at(10, 10), at(10, 10), at(60, 60))               // no area
      .triangle(at(10.3, 10.3), at(10.7, 10.3), at(10.3, 10.6));  // no sample
  const auto primitives = sent(builder.scene, in_bins(preset("embedded")));
  std::map<std::uint32_t, int> bins;
  for (const HostPrimitive& p : primitives)
    if (p.packet.kind == PrimitiveKind::triangle) {
      ++bins[p.primitive];
      EXPECT_EQ(p.packet.box.left / 64, p.packet.box.right / 64);
      EXPECT_EQ(p.packet.box.top / 64, p.packet.box.bottom / 64);
    }
  EXPECT_EQ(bins, (std::map<std::uint32_t, int>{{0, 1}, {1, 2}, {2, 45}}));
  const Rendering rendering = render_hardware(builder.scene, in_bins(preset("embedded")));
  EXPECT_EQ(rendering.counters.pairs, 48u);
  EXPECT_EQ(rendering.counters.bins, 45u);
  EXPECT_EQ(rendering.counters.skipped.no_sample, 1u);
}

TEST(FrameBins, ThePartsOfALineAreItsPixels) {
  State state = SceneBuilder::window_state();
  for (const LineRule rule : {LineRule::diamond, LineRule::bresenham, LineRule::midpoint}) {
    state.line_rule = rule;
    SceneBuilder builder(640, 480, state);
    for (const auto& [x, y] : {std::pair{3.5, 8.25}, {630.75, 471.5}, {630.0, 9.5}, {12.0, 300.0}}) {
      builder.scene.indices.push_back(static_cast<std::uint32_t>(builder.scene.vertices.size()));
      builder.scene.vertices.push_back(at(x, y, x / 640, {x / 4, y / 4, 0, 255}));
    }
    builder.scene.commands.push_back(Draw{0, 0, Topology::line_strip, 0, 4, 0});
    SCOPED_TRACE(static_cast<int>(rule));
    expect_equal_in_bins(builder.scene, preset("embedded"));
    EXPECT_GT(count(sent(builder.scene, in_bins(preset("embedded"))), PrimitiveKind::line), 20u);
  }
}

TEST(FrameBins, WithoutStoredDepthAFrameThatClearsItAsksMemoryForNone) {
  const Scene scene = make_builtin("city", 320, 240, {}, 1);
  const Config config = with("embedded", {{"frame.clears", "flags"}});
  const auto stored = requests(scene, in_bins(config)), lost = requests(scene, in_bins(config, FrameStore::color));
  EXPECT_GT(stored.at(TilePlane::depth), 0u);
  EXPECT_GT(stored.at(TilePlane::depth_flags), 0u);
  EXPECT_EQ(lost.count(TilePlane::depth), 0u);
  EXPECT_EQ(lost.count(TilePlane::depth_flags), 0u);
  EXPECT_EQ(lost.at(TilePlane::color), stored.at(TilePlane::color));
  EXPECT_EQ(lost.at(TilePlane::color_flags), stored.at(TilePlane::color_flags));
}

// In program order depth that leaves the chip may be wanted again: only the last blocks' is lost, and the flags.
TEST(FrameBins, InProgramOrderWithoutStoredDepthThePictureIsTheSameAndTheFlushShorter) {
  const Scene scene = make_builtin("city", 320, 240, {}, 1);
  Config config = preset("embedded");
  const auto all = requests(scene, config);
  const Rendering expected = render_hardware(scene, config);
  config.frame_store = FrameStore::color;
  const auto color = requests(scene, config);
  EXPECT_EQ(render_hardware(scene, config).frame.color, expected.frame.color);
  EXPECT_LT(color.at(TilePlane::depth), all.at(TilePlane::depth));
  EXPECT_EQ(color.count(TilePlane::depth_flags), 0u);
}

/// A triangle in one bin, one in another, with clears between.
class ClearsInBins : public testing::Test {
 protected:
  ClearsInBins() : builder(128, 64) { builder.triangle(at(0, 0), at(60, 0), at(0, 60)); }
  void clear(std::optional<double> depth, bool color, std::optional<Rect> scissor = {}) {
    State state = SceneBuilder::window_state();
    state.scissor = scissor;
    builder.with_state(state);
    Clear command{static_cast<std::uint32_t>(builder.scene.states.size() - 1), {}, depth};
    if (color) command.color = {1, 2, 3, 255};
    builder.scene.commands.push_back(command);
  }
  void draw_in_the_other_bin() { builder.triangle(at(70, 0), at(120, 0), at(70, 60)); }
  [[nodiscard]] std::size_t rectangles(FrameStore store) const {
    expect_equal_in_bins(builder.scene, preset("embedded"));
    return count(sent(builder.scene, in_bins(preset("embedded"), store)), PrimitiveKind::rectangle);
  }
  [[nodiscard]] std::size_t fast_clears() const {
    return count(sent(builder.scene, in_bins(preset("embedded"))), PrimitiveKind::fast_clear);
  }
  SceneBuilder builder;
};

TEST_F(ClearsInBins, OneOfDepthBeginsNewBins) {
  for (const bool color : {true, false}) {
    clear(0.5, color);
    draw_in_the_other_bin();
    EXPECT_EQ(rectangles(FrameStore::all), 0u);
  }
  EXPECT_EQ(fast_clears(), 3u);
}

TEST_F(ClearsInBins, OneOfColorIsARectangleInEachBin) {
  clear({}, true);
  draw_in_the_other_bin();
  EXPECT_EQ(rectangles(FrameStore::all), 2u);
  EXPECT_EQ(fast_clears(), 1u);
}

TEST_F(ClearsInBins, OneOfAPlaneBeforeAnythingIsDrawnIsFast) {
  SceneBuilder empty(128, 64);
  std::swap(builder, empty);
  clear({}, true);
  clear(0.25, false);
  draw_in_the_other_bin();
  EXPECT_EQ(rectangles(FrameStore::all), 0u);
  EXPECT_EQ(fast_clears(), 3u);
}

TEST_F(ClearsInBins, OneOfDepthThatNobodyLooksAtIsLeftOut) {
  clear(0.5, false, Rect{0, 0, 128, 32});
  draw_in_the_other_bin();
  EXPECT_EQ(rectangles(FrameStore::all), 2u);
  EXPECT_EQ(rectangles(FrameStore::color), 1u);
}

TEST_F(ClearsInBins, OneInsideAScissorIsCutToItsBins) {
  clear(0.5, true, Rect{50, 10, 30, 20});
  EXPECT_EQ(rectangles(FrameStore::all), 2u);
}

}  // namespace
}  // namespace halfplane::frame_bins_test
