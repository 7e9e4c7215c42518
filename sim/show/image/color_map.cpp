#include "color_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace halfplane {
namespace {

// viridis sampled at 16 equal steps; between them sRGB values are blended.
constexpr std::array<Rgb, 16> kViridis{{{0x44, 0x01, 0x54},
                                        {0x48, 0x1a, 0x6c},
                                        {0x47, 0x2f, 0x7d},
                                        {0x41, 0x44, 0x87},
                                        {0x39, 0x56, 0x8c},
                                        {0x31, 0x68, 0x8e},
                                        {0x2a, 0x78, 0x8e},
                                        {0x23, 0x88, 0x8e},
                                        {0x1f, 0x98, 0x8b},
                                        {0x22, 0xa8, 0x84},
                                        {0x35, 0xb7, 0x79},
                                        {0x54, 0xc5, 0x68},
                                        {0x7a, 0xd1, 0x51},
                                        {0xa5, 0xdb, 0x36},
                                        {0xd2, 0xe2, 0x1b},
                                        {0xfd, 0xe7, 0x25}}};

struct OkLab {
  double lightness, a, b;
};

constexpr OkLab kWhite{0.97, 0.0, 0.0};
constexpr OkLab kBlue{0.47, -0.035, -0.165};  // both ends: the same lightness and chroma 0.169, inside sRGB
constexpr OkLab kRed{0.47, 0.148, 0.081};

std::uint8_t to_byte(double unit) { return static_cast<std::uint8_t>(std::lround(std::clamp(unit, 0.0, 1.0) * 255)); }

double srgb_encode(double linear) {  // IEC 61966-2-1
  if (linear <= 0.0031308) return 12.92 * linear;
  return 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

Rgb to_srgb(const OkLab& c) {
  const double l = std::pow(c.lightness + 0.3963377774 * c.a + 0.2158037573 * c.b, 3);
  const double m = std::pow(c.lightness - 0.1055613458 * c.a - 0.0638541728 * c.b, 3);
  const double s = std::pow(c.lightness - 0.0894841775 * c.a - 1.2914855480 * c.b, 3);
  return {to_byte(srgb_encode(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s)),
          to_byte(srgb_encode(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s)),
          to_byte(srgb_encode(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s))};
}

}  // namespace

Rgb sequential_color(double t) {
  const double position = std::clamp(t, 0.0, 1.0) * (kViridis.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(position), kViridis.size() - 2);
  const double part = position - static_cast<double>(i);
  const auto blend = [part](std::uint8_t from, std::uint8_t to) { return to_byte((from + part * (to - from)) / 255); };
  const Rgb a = kViridis[i], b = kViridis[i + 1];
  return {blend(a.r, b.r), blend(a.g, b.g), blend(a.b, b.b)};
}

Rgb diverging_color(double t) {
  const OkLab& end = t < 0 ? kBlue : kRed;
  const double part = std::min(std::abs(t), 1.0);
  return to_srgb({std::lerp(kWhite.lightness, end.lightness, part), part * end.a, part * end.b});
}

double nice_ceiling(double value) {
  if (!(value > 0) || !std::isfinite(value)) return 1;
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.2, 1.6, 2.0, 2.4, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0})  // quarters are short too
    if (value <= step * decade * (1 + 1e-9)) return step * decade;  // 1e-9: a value of 0.2 must not become 0.24
  return 20 * decade;                                               // log10 rounded down across a power of ten
}

std::string short_number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value == 0 ? 0.0 : value);  // no "-0"
  return text.data();
}

}  // namespace halfplane
