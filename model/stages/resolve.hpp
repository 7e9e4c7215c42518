// Resolve: the one colour of a pixel with several samples.
//
// In: the images of the samples. Out: the images of the pixel. Each stored channel is (sum + n/2) >> log2 n, n samples:
// the mean rounded to the nearest code, halves up, so at most half a stored LSB off. Depth and stencil are sample 0's:
// a mean of depths lies on no surface.
#pragma once

#include "../config.hpp"
#include "framebuffer.hpp"

namespace halfplane {

/// The mean of stored colours, channel by channel; their number a power of two. `color(k)` gives the k-th.
template <class Color>
[[nodiscard]] constexpr std::uint32_t mean_color(ColorFormat format, int samples, Color&& color) {
  struct Channel {
    int shift;
    std::uint32_t mask;
  };
  constexpr std::array<Channel, 4> k565{{{11, 31}, {5, 63}, {0, 31}, {0, 0}}},
      k8888{{{0, 255}, {8, 255}, {16, 255}, {24, 255}}};
  const auto n = static_cast<std::uint32_t>(samples);
  std::uint32_t mean = 0;
  for (const Channel& channel : format == ColorFormat::rgb565 ? k565 : k8888) {
    std::uint32_t sum = n / 2;
    for (int k = 0; k < samples; ++k) sum += color(k) >> channel.shift & channel.mask;
    mean |= sum / n << channel.shift;
  }
  return mean;
}

/// Fills the images of the pixels from the samples' images. Does nothing with one sample per pixel.
inline void resolve(Framebuffer& frame, ColorFormat format) {
  if (frame.samples.empty()) return;
  const int samples = static_cast<int>(frame.samples.size());
  for (std::size_t p = 0; p < frame.color.size(); ++p)
    frame.color[p] =
        mean_color(format, samples, [&](int k) { return frame.samples[static_cast<std::size_t>(k)].color[p]; });
  frame.depth = frame.samples.front().depth;
  frame.stencil = frame.samples.front().stencil;
}

}  // namespace halfplane
