// How many samples a clock the texture unit gives when a screen is filled at one texel a pixel, by its timing.
#include <gtest/gtest.h>

#include <iostream>

#include "model/engines/cycle/texture_timing.hpp"
#include "model/timing/memory.hpp"

namespace halfplane {
namespace {

/// 2x2 stamps of tiles of 16x16 pixels over 640x480, a texture of 1024x512; turned: u along y.
double rate(TextureFormat format, MemoryTiming& memory, const TextureSettings& settings, bool is_turned) {
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
  constexpr int kReach = 11, kQ = 1 << 25;  // u = 2^kReach P / Q
  frame.scale.fill({1 - narrow, kReach});
  std::array<TextureSample, 4> sample;
  std::array<Texel, 4> color{};
  Cycle last = 0;
  for (int ty = 0; ty < 480; ty += 16)
    for (int tx = 0; tx < 640; tx += 16)
      for (int y = ty; y < ty + 16; y += 2)
        for (int s = tx; s < tx + 16; s += 2) {
          for (int i = 0; i < 4; ++i) {
            const double u = s + i % 2 + 0.5, v = y + i / 2 + 0.5;
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

}  // namespace
}  // namespace halfplane
