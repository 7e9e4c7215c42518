// Where the samples of a pixel lie: the standard patterns of 2, 4 and 8, and any other that a configuration gives.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace halfplane {

inline constexpr int kMaxPixelSamples = 8;  ///< of a pixel
inline constexpr int kPatternFraction = 8;  ///< places are multiples of 2^-8 pixel

/// A place in a pixel, or a way from its centre; right and down.
struct SampleOffset {
  int x = 0, y = 0;
  bool operator==(const SampleOffset&) const = default;
};

/// The value of msaa.pattern: the standard one of so many samples, or places of its own.
struct SamplePattern {
  int count = 0;                                       ///< places; 0: standard
  std::array<SampleOffset, kMaxPixelSamples> place{};  ///< from the pixel's upper left corner, 2^-8 pixel, 0 to 255
  bool operator==(const SamplePattern&) const = default;
};

/// Reads `standard`, or `X,Y;...` in pixels from the upper left corner, each from 0 to below 1 and a multiple of 1/256. Throws
/// InputError.
[[nodiscard]] SamplePattern parse_sample_pattern(std::string_view text);
[[nodiscard]] std::string to_string(const SamplePattern& pattern);

/// The places of a pattern; of `standard` those that Direct3D and Vulkan give 1, 2, 4 or 8 samples.
[[nodiscard]] SamplePattern resolved_pattern(const SamplePattern& pattern, int samples);

/// The fewest fraction bits that hold every way from the pixel's centre to a place.
[[nodiscard]] int pattern_bits(const SamplePattern& resolved);

}  // namespace halfplane
