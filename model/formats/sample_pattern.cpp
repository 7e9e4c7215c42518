#include "sample_pattern.hpp"

#include <bit>
#include <charconv>
#include <cmath>

#include "../input_error.hpp"

namespace halfplane {
namespace {

constexpr int kUnit = 1 << kPatternFraction;  // a pixel

/// Reads one coordinate of a place and removes it from `text`.
int read_coordinate(std::string_view& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const double units = value * kUnit;
  if (error != std::errc() || !(value >= 0 && value < 1) || units != std::floor(units))
    throw InputError("'" + std::string(text) +
                     "' does not begin with a place in a pixel; give pairs X,Y from 0 to below 1, multiples of 1/256, "
                     "as in 0.25,0.25;0.75,0.75");
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return static_cast<int>(units);
}

void take(std::string_view& text, char separator, std::string_view what) {
  if (text.empty() || text.front() != separator)
    throw InputError("'" + std::string(text) + "': " + std::string(what) + "; give X,Y;X,Y and so on");
  text.remove_prefix(1);
}

std::string coordinate_text(int units) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), static_cast<double>(units) / kUnit);
  return error == std::errc() ? std::string(text.data(), end) : std::string();
}

/// Places in sixteenths of a pixel.
template <std::size_t count>
SamplePattern in_sixteenths(const std::array<SampleOffset, count>& places) {
  SamplePattern pattern;
  pattern.count = static_cast<int>(count);
  for (std::size_t k = 0; k < count; ++k) pattern.place[k] = {places[k].x * kUnit / 16, places[k].y * kUnit / 16};
  return pattern;
}

}  // namespace

SamplePattern parse_sample_pattern(std::string_view text) {
  SamplePattern pattern;
  if (text == "standard") return pattern;
  for (;;) {
    if (pattern.count == kMaxPixelSamples)
      throw InputError("more than " + std::to_string(kMaxPixelSamples) +
                       " places; a pixel has at most so many samples");
    SampleOffset& place = pattern.place[static_cast<std::size_t>(pattern.count++)];
    place.x = read_coordinate(text);
    take(text, ',', "a comma is missing between X and Y");
    place.y = read_coordinate(text);
    if (text.empty()) return pattern;
    take(text, ';', "a semicolon is missing between two places");
  }
}

std::string to_string(const SamplePattern& pattern) {
  if (pattern.count == 0) return "standard";
  std::string text;
  for (int k = 0; k < pattern.count; ++k) {
    const SampleOffset& place = pattern.place[static_cast<std::size_t>(k)];
    text += (k == 0 ? "" : ";") + coordinate_text(place.x) + "," + coordinate_text(place.y);
  }
  return text;
}

SamplePattern resolved_pattern(const SamplePattern& pattern, int samples) {
  if (pattern.count != 0) return pattern;
  switch (samples) {
    case 2: return in_sixteenths(std::array<SampleOffset, 2>{{{12, 12}, {4, 4}}});
    case 4: return in_sixteenths(std::array<SampleOffset, 4>{{{6, 2}, {14, 6}, {2, 10}, {10, 14}}});
    case 8:
      return in_sixteenths(
          std::array<SampleOffset, 8>{{{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}}});
    default: return in_sixteenths(std::array<SampleOffset, 1>{{{8, 8}}});
  }
}

int pattern_bits(const SamplePattern& resolved) {
  unsigned any = kUnit;  // its lowest set bit is the lowest in any offset from the centre
  for (int k = 0; k < resolved.count; ++k) {
    const SampleOffset& place = resolved.place[static_cast<std::size_t>(k)];
    any |= static_cast<unsigned>(place.x - kUnit / 2) | static_cast<unsigned>(place.y - kUnit / 2);
  }
  return kPatternFraction - std::countr_zero(any);
}

}  // namespace halfplane
