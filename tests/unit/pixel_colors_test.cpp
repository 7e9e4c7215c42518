// Blocks whose pixels have one colour each: how they lie in memory (compress.unit).
#include <gtest/gtest.h>

#include <algorithm>

#include "../hardware_scene.hpp"
#include "../scene_builder.hpp"
#include "model/engines/scalar.hpp"
#include "model/stages/memory_port.hpp"
#include "model/stages/pixel_colors.hpp"

namespace halfplane::pixel_colors_test {
namespace {

using test::at;
using test::Recorder;
using test::run_scene;
using test::SceneBuilder;
using test::with;

TEST(PixelColors, OneColourAPixelIsStoredWhereNothingElseOfTheBlockCounts) {
  const auto move = [](bool fills, bool is_uniform, bool is_whole, bool of_pixels) {
    return color_move({fills, is_uniform, is_whole}, of_pixels);
  };
  for (const bool fills : {false, true})
    for (const bool is_whole : {false, true})
      for (const bool of_pixels : {false, true}) {
        EXPECT_EQ(move(fills, true, is_whole, of_pixels),
                  fills || is_whole || of_pixels ? ColorMove::pixels : ColorMove::samples);
        EXPECT_EQ(move(fills, false, is_whole, of_pixels), of_pixels && !fills ? ColorMove::merge : ColorMove::samples);
      }
}

TEST(PixelColors, APixelHasOneColourWhereAllItsSamplesAreThereAndEqual) {
  const Widths widths = derive_widths(with("embedded", {{"msaa.samples", "4"}}));  // four samples of four pixels
  std::array<std::uint32_t, 16> color{};
  const auto has_one = [&](std::uint64_t mask) {
    return has_one_color(SampleMask(mask), widths, [&](std::size_t s) { return color[s]; });
  };
  EXPECT_TRUE(has_one(0));
  EXPECT_TRUE(has_one(0xFFFF));
  EXPECT_TRUE(has_one(0xF0F0));
  EXPECT_FALSE(has_one(0xF0E0)) << "a sample is missing";
  EXPECT_FALSE(has_one(0x0001));
  color[6] = 1;
  EXPECT_FALSE(has_one(0xFFFF));
  EXPECT_TRUE(has_one(0xFF0F)) << "who is not there has no colour";
  std::fill_n(color.begin() + 4, 4, 1U);
  EXPECT_TRUE(has_one(0xFFFF)) << "pixels differ as they like";
}

Config compressed(const char* clears) {
  return with("embedded",
              {{"msaa.samples", "4"}, {"compress.unit", "1"}, {"cache.lines", "1"}, {"frame.clears", clears}});
}

/// The whole block n of a target of 4 rows.
void fill_block(SceneBuilder& builder, int n) {
  const double x = 4 * n;
  builder.triangle(at(x, 0), at(x + 4, 0), at(x, 4));
  builder.triangle(at(x + 4, 0), at(x + 4, 4), at(x, 4));
}

/// With edges in the first block's pixels.
void triangle(SceneBuilder& builder, double size, const std::array<double, 4>& rgba) {
  builder.triangle(at(0.1, 0, 0.5, rgba), at(0.1 + size, 0, 0.5, rgba), at(0.1, size, 0.5, rgba));
}

struct Requests {
  std::size_t reads = 0, pixel_writes = 0, writes = 0;
  bool operator==(const Requests&) const = default;
};
Requests color_requests(const Recorder& sink) {
  Requests count;
  for (const MemoryRequest& request : sink.requests) {
    if (request.is_write == 0)
      count.reads += request.plane == TilePlane::pixel_color ? 1 : 0;
    else if (request.plane == TilePlane::pixel_color)
      ++count.pixel_writes;
    else if (request.plane == TilePlane::color)
      ++count.writes;
  }
  return count;
}

TEST(PixelColors, ABlockIsMergedOnceAndWholeAgainWhenItIsDrawnOver) {
  SceneBuilder builder(64, 4);
  const Config config = compressed("flags");
  const auto expect = [&](const Requests& requests, const char* what) {
    Recorder sink;
    (void)run_scene(builder.scene, config, sink);
    EXPECT_EQ(color_requests(sink), requests) << what;
    EXPECT_EQ(render_hardware(builder.scene, config).frame.color, render_scalar(builder.scene, config).frame.color);
  };
  fill_block(builder, 0);
  fill_block(builder, 1);
  expect({0, 8, 0}, "two blocks of four stamps");
  triangle(builder, 2.2, {255, 0, 0, 255});
  expect({4, 8, 4}, "an edge in the first: its pixels are read, its samples written");
  fill_block(builder, 1);
  triangle(builder, 1.2, {0, 255, 0, 255});
  expect({4, 12, 5}, "another one there, one stamp: nothing is read, all samples count already");
  fill_block(builder, 1);
  fill_block(builder, 0);
  expect({4, 20, 5}, "all of it is drawn over");
}

TEST(PixelColors, FlagsSayWhichBlocksHaveThem) {
  for (const char* clears : {"flags", "resolve"}) {
    SceneBuilder builder(64, 8);  // 16 x 2 blocks
    builder.triangle(at(1, 1), at(3, 1), at(1, 3));
    fill_block(builder, 2);
    const Config config = compressed(clears);
    Recorder sink;
    (void)run_scene(builder.scene, config, sink);
    std::vector<std::uint64_t> words;
    for (const MemoryRequest& request : sink.requests)
      if (request.plane == TilePlane::pixel_flags) words.push_back(flag_word(request, derive_widths(config)));
    // The first block has an edge. Cleared ones have one colour where a flush writes it.
    const std::vector<std::uint64_t> expected = clears == std::string_view("flags")
                                                    ? std::vector<std::uint64_t>{0x0004, 0x0000}
                                                    : std::vector<std::uint64_t>{0xFFFE, 0xFFFF};
    EXPECT_EQ(words, expected) << clears;
    EXPECT_EQ(render_hardware(builder.scene, config).frame.color, render_scalar(builder.scene, config).frame.color);
  }
}

TEST(PixelColors, WantSeveralSamplesInMemory) {
  for (const auto& [key, value] : {std::pair{"msaa.samples", "1"}, std::pair{"cache.kind", "tiles"}}) {
    Config config = compressed("flags");
    set(config, key, value);
    EXPECT_THROW(validate(config), InputError) << key;
  }
}

}  // namespace
}  // namespace halfplane::pixel_colors_test
