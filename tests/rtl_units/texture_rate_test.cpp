// How many samples a clock the texture unit gives when a screen is filled at one texel a pixel, by its timing.
#include <gtest/gtest.h>

#include <iostream>

#include "model/engines/cycle/texture_timing.hpp"
#include "model/timing/memory.hpp"

namespace halfplane {
namespace {

/// 2x2 stamps of tiles over 640x480, a texture of 1024x512; turned: u along y. Of a unit with levels a pixel
/// holds 2^(lod/256) texels.
double rate(TextureFormat format, MemoryTiming& memory, const TextureSettings& settings, bool is_turned, int tile = 16,
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
  std::uint64_t samples = 0;
  TextureFrame frame;
  const int narrow = perspective.coordinate.narrow_bits;
  frame.scale.fill({1 - narrow, kReach});
  std::array<TextureSample, 4> sample;
  std::array<Texel, 4> color{};
  Cycle last = 0;
  for (int ty = 0; ty < 480; ty += tile)
    for (int tx = 0; tx < 640; tx += tile)
      for (int y = ty; y < ty + tile; y += 2)
        for (int s = tx; s < tx + tile; s += 2) {
          for (int i = 0; i < 4; ++i) {
            const double u = (s + i % 2 + 0.5) * texels, v = (y + i / 2 + 0.5) * texels;
            auto& at = sample[static_cast<std::size_t>(i)];
            at.q = kQ;
            at.p = {static_cast<std::int64_t>(std::ldexp(is_turned ? v : u, 25 - kReach)),
                    static_cast<std::int64_t>(std::ldexp(is_turned ? u : v, 25 - kReach))};
          }
          x = std::max(x + 1, timing.room());
          const auto lookups = unit.take(SampleMask::all(4), sample, frame, color, read);
          last = timing.take(x, lookups, ask);
          timing.leave(last);
          samples += 4;
        }
  return static_cast<double>(samples) / static_cast<double>(last);
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
          const double samples = rate(format, *memory, settings, is_turned);
          EXPECT_GE(samples, format == TextureFormat::rgba8888 && is_linear ? 0.8 : 0.9)
              << kTextureFormats[static_cast<std::size_t>(format)] << " at " << mhz << " MHz";
          std::cout << (is_linear ? "linear " : "nearest ") << kTextureFormats[static_cast<std::size_t>(format)] << ' '
                    << mhz << " MHz" << (is_turned ? ", turned: " : ": ") << samples << '\n';
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
        const double samples = rate(TextureFormat::rgb565, *memory, settings, is_turned, 8, min, lod);
        EXPECT_GE(samples, min == TextureMin::linear_mipmap_nearest ? 0.95 : 0.45) << lod;
        std::cout << (min == TextureMin::linear_mipmap_nearest ? "one level" : "two levels") << ", level of detail "
                  << lod / 256.0 << (is_turned ? ", turned: " : ": ") << samples << '\n';
      }
}

}  // namespace
}  // namespace halfplane
