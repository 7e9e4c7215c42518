// How many samples a clock the texture unit gives when a screen is filled at one texel a pixel, by its timing.
#include <gtest/gtest.h>

#include <iostream>

#include "../tier.hpp"
#include "model/engines/cycle/texture_timing.hpp"
#include "model/timing/memory.hpp"

namespace halfplane {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

struct Rate {
  double samples = 0;  ///< a clock
  double passes = 0;   ///< a stamp
  double hits = 0;     ///< of the samples
  double bytes = 0;    ///< bytes of lines, a sample
};

/// 2x2 stamps of tiles over 640x480, a texture of 1024x512, turned by `degrees`. A pixel holds 2^(lod/256) texels.
Rate rate(TextureFormat format, MemoryTiming& memory, const TextureSettings& settings, double degrees, int tile = 16,
          TextureMin min = TextureMin::nearest, Lod lod = 0) {
  const PerspectiveFormat perspective;
  TextureUnit unit(settings, perspective);
  TextureTiming timing(settings);
  TextureState state;
  state.enable = true;
  state.format = format;
  state.log2_size = {10, 9};
  state.is_linear = settings.has_linear;
  unit.set(state);
  timing.leave(timing.set(0, false));
  constexpr int kReach = 11, kQ = 1 << 25;       // u = 2^kReach P / Q
  const double texels = std::exp2(lod / 256.0);  // in a pixel
  if (settings.has_levels) {
    unit.set_levels({min, 10, 0, TextureLevels::kLargest});
    LodSetup lines;
    lines.along_y[0].at_zero = lines.along_x[1].at_zero = 1U << 30;
    lines.offset = lod - level_of_detail(lines, kQ, 0, 0);
    const TextureLines packed = TextureLines::pack(lines, 0);
    for (int n = 0; n < line_parts(settings.line_bits); ++n) unit.move_in(line_part(packed, settings.line_bits, n));
  }
  Cycle x = 0;
  Stream requests(Stalls{}, 1), answers(Stalls{}, 2);
  TexturePort port(memory, requests, answers);
  const auto ask = [&](Cycle cycle, std::uint32_t address, int beats) {
    return port.ask(cycle, address, beats, [](int, Cycle) {});
  };
  const auto read = [](std::uint32_t, int) { return TextureLine{}; };
  std::uint64_t samples = 0, stamps = 0, passes = 0, hits = 0, fills = 0;
  TextureFrame frame;
  const int narrow = perspective.coordinate.narrow_bits;
  frame.scale.fill({1 - narrow, kReach});
  std::array<TextureSample, 4> sample;
  std::array<Texel, 4> color{};
  Cycle last = 0;
  const double cosine = std::cos(degrees * kDegree), sine = std::sin(degrees * kDegree);
  for (int ty = 0; ty < 480; ty += tile)
    for (int tx = 0; tx < 640; tx += tile)
      for (int y = ty; y < ty + tile; y += 2)
        for (int s = tx; s < tx + tile; s += 2) {
          for (int i = 0; i < 4; ++i) {
            const double u = (s + i % 2 + 0.5) * texels, v = (y + i / 2 + 0.5) * texels;
            auto& at = sample[static_cast<std::size_t>(i)];
            at.q = kQ;
            at.p = {static_cast<std::int64_t>(std::ldexp(cosine * u + sine * v, 25 - kReach)),
                    static_cast<std::int64_t>(std::ldexp(cosine * v - sine * u, 25 - kReach))};
          }
          x = std::max(x + 1, timing.room());
          const auto lookups = unit.take(SampleMask::all(4), sample, frame, color, read);
          for (const TextureLookup& lookup : lookups) passes += lookup.ends ? 1 : 0;
          hits += use_of(lookups).hits;
          fills += use_of(lookups).fills;
          last = timing.take(x, lookups, ask);
          timing.leave(last);
          samples += 4;
          ++stamps;
        }
  const auto share = [](auto part, auto whole) { return static_cast<double>(part) / static_cast<double>(whole); };
  return {share(samples, last), share(passes, stamps), share(hits, samples),
          share(fills * (std::uint64_t{16} << texel_size_log2(format)), samples)};
}

TEST(TextureRate, AScreenAtOneTexelAPixel) {
  Config config;
  config.memory_port_bits = 64;
  for (const TextureFormat format : {TextureFormat::l8, TextureFormat::rgb565, TextureFormat::rgba8888})
    for (const int mhz : {50, 100})
      for (const bool is_turned : {false, true})
        for (const bool is_linear : {false, true}) {
          const auto memory = make_memory({MemoryKind::ddr3, 0, mhz}, config);
          TextureSettings settings;
          settings.has_linear = is_linear;
          const Rate whole = rate(format, *memory, settings, is_turned ? 90 : 0);
          const double samples = whole.samples;
          EXPECT_GE(samples, format == TextureFormat::rgba8888 && is_linear ? 0.8 : 0.9)
              << kTextureFormats[static_cast<std::size_t>(format)] << " at " << mhz << " MHz";
          std::cout << (is_linear ? "linear " : "nearest ") << kTextureFormats[static_cast<std::size_t>(format)] << ' '
                    << mhz << " MHz" << (is_turned ? ", turned: " : ": ") << samples << ", " << whole.bytes
                    << " bytes a sample\n";
        }
}

TEST(TextureRate, ALevelASampleOrTwo) {
  Config config;
  config.memory_port_bits = 64;
  TextureSettings settings;
  settings.has_linear = settings.has_levels = true;
  for (const TextureMin min : {TextureMin::linear_mipmap_nearest, TextureMin::linear_mipmap_linear})
    for (const bool is_turned : {false, true})
      for (const Lod lod : {64, 128, 192, 320}) {
        const auto memory = make_memory({MemoryKind::ddr3, 0, 50}, config);
        const double samples = rate(TextureFormat::rgb565, *memory, settings, is_turned ? 90 : 0, 8, min, lod).samples;
        EXPECT_GE(samples, min == TextureMin::linear_mipmap_nearest ? 0.95 : 0.45) << lod;
        std::cout << (min == TextureMin::linear_mipmap_nearest ? "one level" : "two levels") << ", level of detail "
                  << lod / 256.0 << (is_turned ? ", turned: " : ": ") << samples << '\n';
      }
}

// A clock takes a stamp, nearest or linear, turned or not, where its lines are there, up to more than a texel a pixel. Then
// it waits for lines, one a clock at most and four beats each, and farther away samples are in each other's way too.
TEST(TextureRate, FourLanesTakeAStampAClock) {
  Config config;
  config.memory_port_bits = 64;
  for (const bool is_linear : {false, true})
    for (const Lod lod : {-256, 0, 128, 384})
      for (const double degrees : {0.0, 30.0}) {
        TextureSettings settings{64, 64, 32, 32, is_linear};
        settings.lanes = 4;
        const auto memory = make_memory({MemoryKind::ddr3, 0, 50}, config);
        const Rate small = rate(TextureFormat::rgb565, *memory, settings, degrees, 8, TextureMin::nearest, lod);
        EXPECT_GE(small.passes, 1);
        EXPECT_LE(small.passes, 4);
        if (lod <= 128) {
          EXPECT_LE(small.passes, 1.0) << "no two samples are in each other's way";
        }
        if (lod <= -256) {
          EXPECT_GE(small.samples, 3.6) << lod << " turned by " << degrees;
        }
        std::cout << (is_linear ? "linear, " : "nearest, ") << std::exp2(lod / 256.0) << " texels a pixel, " << degrees
                  << " degrees: " << small.samples << " samples a clock, " << small.passes << " passes a stamp, "
                  << 100 * small.hits << " % hits\n";
      }
}

// With levels a stamp takes a clock where its samples look at one, and two where they look at two, up to more than a texel a
// pixel. It waits for lines there: they come at four beats each.
TEST(TextureRate, FourLanesBetweenLevels) {
  int number = 0;
  Config config;
  config.memory_port_bits = 64;
  for (const TextureMin min : {TextureMin::linear_mipmap_nearest, TextureMin::linear_mipmap_linear})
    for (const Lod lod : {-256, 0, 64, 128, 192})
      for (const double degrees : {0.0, 30.0}) {
        if (number++ % 3 != 0 && !test::runs_all()) continue;  // every day a third, with each value of each
        const bool is_between = min == TextureMin::linear_mipmap_linear && lod > 0;
        std::array<Rate, 2> of_lanes{};
        for (const int lanes : {1, 4}) {
          TextureSettings settings{64, 64, lanes == 1 ? 16 : 32, 32, true, true};
          settings.ways = 2;
          settings.lanes = lanes;
          const auto memory = make_memory({MemoryKind::ddr3, 0, 50}, config);
          of_lanes[lanes == 1 ? 0 : 1] = rate(TextureFormat::rgb565, *memory, settings, degrees, 8, min, lod);
        }
        const auto& [one, four] = of_lanes;
        EXPECT_EQ(one.passes, is_between ? 8 : 4);
        if (lod <= 128) {
          EXPECT_EQ(four.passes, is_between ? 2 : 1) << "no two samples are in each other's way";
        }
        EXPECT_GE(four.samples, (lod <= 64 ? 1.8 : 1.4) * one.samples);
        std::cout << (min == TextureMin::linear_mipmap_linear ? "two levels, " : "one level, ")
                  << std::exp2(lod / 256.0) << " texels a pixel, " << degrees << " degrees: one lane " << one.samples
                  << " samples a clock, four " << four.samples << "; " << four.passes << " passes a stamp, "
                  << four.bytes << " bytes a sample\n";
      }
}

// Where two levels' lines want one place each, again and again, a second place keeps both.
TEST(TextureRate, TwoWaysHoldTwoLevels) {
  int number = 0;
  Config config;
  config.memory_port_bits = 64;
  for (const int lines : {16, 32, 64})
    for (const Lod lod : {64, 128, 192})
      for (const double degrees : {0.0, 30.0, 90.0}) {
        if (number++ % 4 != 0 && !test::runs_all()) continue;  // every day a quarter, with each value of each
        std::array<Rate, 2> of_ways{};
        for (const int ways : {1, 2}) {
          TextureSettings settings{lines, 64, 16, 32, true, true};
          settings.ways = ways;
          const auto memory = make_memory({MemoryKind::ddr3, 0, 50}, config);
          of_ways[static_cast<std::size_t>(ways - 1)] =
              rate(TextureFormat::rgb565, *memory, settings, degrees, 8, TextureMin::linear_mipmap_linear, lod);
        }
        EXPECT_GE(of_ways[1].hits, of_ways[0].hits) << lines << ' ' << lod << ' ' << degrees;
        if (lines >= 32) {
          EXPECT_GE(of_ways[1].samples, 0.46) << "one in two clocks is what two levels leave";
        }
        std::cout << lines << " lines, level of detail " << lod / 256.0 << ", " << degrees << " degrees: one way "
                  << 100 * of_ways[0].hits << " % hits, " << of_ways[0].samples << " samples a clock; two ways "
                  << 100 * of_ways[1].hits << " %, " << of_ways[1].samples << '\n';
      }
}

}  // namespace
}  // namespace halfplane
