// Bins with unchanged contents are skipped (Skip::bins): successive frames, each equal to the same frame alone.
#include <gtest/gtest.h>

#include <bit>
#include <set>

#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/functional.hpp"
#include "model/packets/packet_words.hpp"
#include "sim/cosim/random_scene.hpp"
#include "tests/hardware_scene.hpp"
#include "tests/scene_builder.hpp"

namespace halfplane::bin_contents_test {
namespace {

using test::at;
using test::SceneBuilder;
using test::with;

Config in_bins(Config config) {
  config.frame_order = FrameOrder::bins;
  config.frame_store = FrameStore::color;
  return config;
}

RenderOptions following() {
  RenderOptions options;
  options.follows = true;
  return options;
}

/// Every engine, from frame to frame.
class Following {
 public:
  explicit Following(const Config& config)
      : config_(in_bins(config)),
        memory_(make_memory({}, config_)),
        functional_(config_),
        hardware_(config_),
        cycle_(config_, *memory_) {}

  /// Draws the next frame with all engines; equal to the functional engine's frame alone. Returns the bins that the
  /// hardware skipped.
  std::uint64_t expect_equal(const Scene& scene) {
    const Rendering alone = render_functional(scene, config_, {});
    const Rendering& functional = functional_.render(scene, following());
    EXPECT_EQ(functional.frame.color, alone.frame.color);
    EXPECT_EQ(functional.frame.depth, alone.frame.depth);
    EXPECT_EQ(functional.frame.stencil, alone.frame.stencil);
    left_by_functional += functional.counters.skipped.bins;
    const Rendering hardware = hardware_.draw(scene);
    EXPECT_EQ(hardware.frame.color, alone.frame.color);
    const CycleRendering cycle = cycle_.draw(scene);
    EXPECT_EQ(cycle.rendering.frame.color, alone.frame.color);
    EXPECT_EQ(cycle.rendering.counters.skipped.bins, hardware.counters.skipped.bins);
    EXPECT_EQ(cycle.rendering.counters.covered, hardware.counters.covered);
    cycles = cycle.run.cycles;
    requests = hardware.counters.pairs;
    return hardware.counters.skipped.bins;
  }

  std::uint64_t left_by_functional = 0;
  std::uint64_t cycles = 0, requests = 0;  ///< of the last frame

 private:
  Config config_;
  std::unique_ptr<MemoryTiming> memory_;
  FunctionalEngine functional_;
  HardwareFrames hardware_;
  CycleFrames cycle_;
};

// Flags that stay and flags that are resolved; bins smaller than a tile, which are always drawn; units after the depth
// test.
TEST(BinContents, RandomFramesAreWhatEachIsAlone) {
  const std::vector<Config> configs{
      preset("embedded"),
      with("embedded", {{"frame.clears", "flags"}}),
      with("embedded", {{"cache.lines", "64"}, {"frame.clears", "flags"}}),
      with("embedded", {{"cache.lines", "4"}, {"tile.size", "32"}, {"stamp.size", "1"}}),
      with("tiny", {{"cache.kind", "blocks"}, {"cache.lines", "16"}}),
      with("embedded", {{"texture.unit", "bilinear"}, {"perspective.colors", "1"}}),
      with("embedded", {{"blend.lanes", "4"}, {"alpha.unit", "1"}, {"dither.unit", "1"}}),
      with("embedded", {{"stencil.bits", "8"}, {"frame.clears", "flags"}}),
  };
  std::uint64_t left = 0, left_by_functional = 0;
  for (const Config& config : configs)
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      SCOPED_TRACE(label(config) + ", seed " + std::to_string(seed));
      Following frames(config);
      Scene scene = random_scene(config, seed, 20);
      for (std::uint64_t n = 0; n < 5; ++n) {
        left += frames.expect_equal(scene);
        scene = next_frame(scene, 100 * seed + n);
      }
      left_by_functional += frames.left_by_functional;
      left += frames.expect_equal(random_scene(config, seed + 1, 10));  // another size
    }
  EXPECT_GT(left, 100u);
  EXPECT_GT(left_by_functional, 100u);
}

/// Two triangles in bins of their own on a target of 10x2 bins of 64x64 pixels, one of them `x` to the right.
Scene two_triangles(double x, std::array<double, 4> clear = {10, 20, 30, 255}) {
  SceneBuilder builder(640, 128);
  builder.scene.commands.push_back(Clear{0, clear, 1.0});
  builder.triangle(at(2, 2), at(62, 2), at(2, 62));
  builder.triangle(at(322 + x, 66), at(376 + x, 66), at(322 + x, 126));
  return builder.scene;
}

TEST(BinContents, OnlyTheBinThatChangesIsDrawnAgain) {
  Following frames(with("embedded", {{"frame.clears", "flags"}}));
  EXPECT_EQ(frames.expect_equal(two_triangles(0)), 0u);
  const std::uint64_t first = frames.cycles;
  EXPECT_EQ(frames.expect_equal(two_triangles(0)), 2u);
  EXPECT_EQ(frames.requests, 0u);
  EXPECT_LT(frames.cycles, first);
  EXPECT_EQ(frames.expect_equal(two_triangles(3)), 1u);
  EXPECT_EQ(frames.requests, 1u);
  EXPECT_EQ(frames.expect_equal(two_triangles(64)), 1u);  // the bin that it left is cleared
  EXPECT_EQ(frames.requests, 1u);
}

TEST(BinContents, AnotherClearIsAnotherPicture) {
  Following frames(preset("embedded"));
  (void)frames.expect_equal(two_triangles(0));
  EXPECT_EQ(frames.expect_equal(two_triangles(0, {10, 20, 31, 255})), 0u);
  EXPECT_EQ(frames.expect_equal(two_triangles(0, {10, 20, 31, 255})), 2u);
}

TEST(BinContents, NothingAtAllBehindSomethingIsAClear) {
  Following frames(preset("embedded"));
  (void)frames.expect_equal(two_triangles(0));
  Scene empty = two_triangles(0);
  empty.commands.resize(1);
  EXPECT_EQ(frames.expect_equal(empty), 0u);
  EXPECT_EQ(frames.expect_equal(two_triangles(0)), 0u);
}

// The texels are not in a triangle's packet.
TEST(BinContents, AnotherTextureInTheSamePlaceIsDrawn) {
  Following frames(with("embedded", {{"texture.unit", "nearest"}}));
  SceneBuilder builder(128, 64);
  TexelImage image{2, 2, {{1, 2, 3, 255}, {4, 5, 6, 255}, {7, 8, 9, 255}, {10, 11, 12, 255}}};
  builder.scene.textures.push_back(make_texture("a", image, TextureFormat::rgba8888, Mips::none));
  State state = SceneBuilder::window_state();
  state.texture = 0;
  state.texture_min = TextureMin::nearest;
  state.texture_mag = TextureMag::nearest;
  builder.with_state(state);
  builder.triangle(at(0, 0), at(60, 0), at(0, 60));
  (void)frames.expect_equal(builder.scene);
  EXPECT_EQ(frames.expect_equal(builder.scene), 1u);
  image.texel[0][0] = 2;
  builder.scene.textures[0] = make_texture("a", image, TextureFormat::rgba8888, Mips::none);
  EXPECT_EQ(frames.expect_equal(builder.scene), 0u);
}

// A clear of depth in the middle begins new bins: such frames are drawn, and nothing is known after them.
TEST(BinContents, FramesThatBeginBinsTwiceAreDrawn) {
  Following frames(preset("embedded"));
  Scene twice = two_triangles(0);
  twice.commands.push_back(Clear{0, {}, 1.0});
  (void)frames.expect_equal(two_triangles(0));
  EXPECT_EQ(frames.expect_equal(twice), 0u);
  EXPECT_EQ(frames.expect_equal(twice), 0u);
  EXPECT_EQ(frames.expect_equal(two_triangles(0)), 0u);
  EXPECT_EQ(frames.expect_equal(two_triangles(0)), 2u);
}

TEST(BinContents, WithoutTheSwitchEverythingIsDrawn) {
  HardwareFrames frames(in_bins(preset("embedded")));
  RenderOptions all;
  all.skip.bins = false;
  (void)frames.draw(two_triangles(0), all);
  EXPECT_EQ(frames.draw(two_triangles(0), all).counters.skipped.bins, 0u);
  EXPECT_EQ(frames.draw(two_triangles(0)).counters.skipped.bins, 2u);
}

// The functional engine knows no range of depths of a skipped bin: a later draw on the frame must not pass as nearer.
TEST(BinContents, WhatIsDrawnOnAFrameIsTestedAgainstBinsThatStayed) {
  const auto triangle = [](double z) {
    SceneBuilder builder(128, 64);
    builder.triangle(at(2, 2, z), at(62, 2, z), at(2, 62, z));
    return builder.scene;
  };
  FunctionalEngine engine(preset("embedded"));
  (void)engine.render(triangle(0.2), following());
  const Rendering& near = engine.render(triangle(0.2), following());
  EXPECT_EQ(near.counters.skipped.bins, 1u);
  const Framebuffer before = near.frame;
  RenderOptions on;
  on.onto = &near.frame;
  EXPECT_EQ(engine.render(triangle(0.8), on).frame.color, before.color);
}

// A frame of tiny triangles, where clears of single bins would cost more than is saved.
TEST(BinContents, NoFrameTakesLongerForIt) {
  const auto tiny = [](int moved) {
    SceneBuilder builder(640, 480);
    for (int n = 0; n < 80; ++n) {
      const double x = n % 10 * 64 + 8 + (n % 5 < moved ? 3 : 0), y = n / 10 * 64 % 480 + 8;
      builder.triangle(at(x, y), at(x + 4, y), at(x, y + 4));
    }
    return builder.scene;
  };
  for (const char* lines : {"16", "256", "1024"})
    for (const char* clears : {"flags", "resolve"})
      for (int moved = 0; moved <= 5; ++moved) {
        const Config config = in_bins(with("embedded", {{"cache.lines", lines}, {"frame.clears", clears}}));
        const auto cycles = [&](bool skips) {
          const auto memory = make_memory({}, config);
          CycleFrames frames(config, *memory);
          RenderOptions options;
          options.skip.bins = skips;
          (void)frames.draw(tiny(0), options);
          return frames.draw(tiny(moved), options).run.cycles;
        };
        SCOPED_TRACE(std::string(lines) + " lines, " + clears + ", " + std::to_string(moved));
        EXPECT_LE(cycles(true), cycles(false) * 102 / 100);
      }
}

// Where hardly anything is the same, as with a moving camera, the frame is sent as if there had been none before: to the cycle.
TEST(BinContents, WhereNearlyAllChangesTheFrameIsSentAsEver) {
  const auto columns = [](double x) {
    SceneBuilder builder(640, 128);
    for (int n = 1; n < 10; ++n) builder.triangle(at(64 * n + x, 10), at(64 * n + 40 + x, 10), at(64 * n + x, 100));
    builder.triangle(at(0, 0), at(10, 0), at(0, 10));
    return builder.scene;
  };
  const Config config = in_bins(preset("embedded"));
  BinContents held;
  const auto sent = [&](double x, BinContents* contents) {
    const Scene scene = columns(x);
    HostStream host(scene, config, contents);
    std::vector<std::vector<std::uint32_t>> packets;
    while (const auto primitive = host.next()) packets.push_back(packed(primitive->packet, derive_widths(config)));
    return packets;
  };
  (void)sent(0, &held);
  EXPECT_EQ(sent(1, &held), sent(1, nullptr));
}

TEST(Signature, EveryBitOfEveryWordChangesAboutHalfOfIt) {
  std::set<std::pair<std::uint64_t, std::uint64_t>> seen;
  const auto signature = [&seen](std::array<std::uint64_t, 4> words, std::size_t length) {
    SignatureHash hash;
    for (std::size_t i = 0; i < length; ++i) hash.add(words[i]);
    const Signature s = hash.signature();
    EXPECT_TRUE(seen.insert({s.low, s.high}).second);
    return s;
  };
  const std::array<std::uint64_t, 4> zero{};
  for (std::size_t length = 0; length < 4; ++length) (void)signature(zero, length);
  const Signature base = signature(zero, 4);
  for (std::size_t word = 0; word < 4; ++word)
    for (int bit = 0; bit < 64; ++bit) {
      auto words = zero;
      words[word] = std::uint64_t{1} << bit;
      const Signature other = signature(words, 4);
      for (const std::uint64_t changed : {base.low ^ other.low, base.high ^ other.high}) {
        EXPECT_GT(std::popcount(changed), 10);
        EXPECT_LT(std::popcount(changed), 54);
      }
    }
}

}  // namespace
}  // namespace halfplane::bin_contents_test
