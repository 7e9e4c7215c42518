// Positions of the samples of a pixel: the standard patterns of 2, 4 and 8, and any pattern given in a configuration.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace halfplane {

inline constexpr int kMaxPixelSamples = 8;  ///< of a pixel
inline constexpr int kPatternFraction = 8;  ///< places are multiples of 2^-8 pixel

/// A place in a pixel, or an offset from its centre; right and down.
struct SampleOffset {
  int x = 0, y = 0;
  bool operator==(const SampleOffset&) const = default;
};

/// The value of msaa.pattern: the standard pattern, or explicit places.
struct SamplePattern {
  int count = 0;                                       ///< places; 0: standard
  std::array<SampleOffset, kMaxPixelSamples> place{};  ///< from the pixel's upper left corner, 2^-8 pixel, 0 to 255
  bool operator==(const SamplePattern&) const = default;
};

/// Reads `standard`, or `X,Y;...` in pixels from the upper left corner, each from 0 to below 1 and a multiple of 1/256. Throws
/// InputError.
[[nodiscard]] SamplePattern parse_sample_pattern(std::string_view text);
[[nodiscard]] std::string to_string(const SamplePattern& pattern);

/// The places of a pattern; for `standard` those of Direct3D and Vulkan for 1, 2, 4 or 8 samples.
[[nodiscard]] SamplePattern resolved_pattern(const SamplePattern& pattern, int samples);

/// The fewest fraction bits that hold every offset from the pixel's centre to a place.
[[nodiscard]] int pattern_bits(const SamplePattern& resolved);

}  // namespace halfplane
