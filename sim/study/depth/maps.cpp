#include "sim/study/depth/maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/show/image/color_map.hpp"
#include "sim/show/image/panel.hpp"

namespace halfplane {
namespace {

constexpr std::array<Rgb, 4> kFightColors{kNotCompared, {0x4a, 0x55, 0x60}, {0xf2, 0xbf, 0x4b}, {0xe0, 0x45, 0x2b}};

/// One pixel per block of factor x factor: color(worst), with `worst` the largest of key(value).
template <class Value, class Key, class Color>
Picture reduced(int width, int height, std::span<const Value> values, int max_width, Key&& key, Color&& color) {
  const int factor = (width + max_width - 1) / max_width;
  Picture picture((width + factor - 1) / factor, (height + factor - 1) / factor);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      double worst = -1;
      for (int j = y * factor; j < std::min(height, (y + 1) * factor); ++j)
        for (int i = x * factor; i < std::min(width, (x + 1) * factor); ++i)
          worst = std::max(
              worst,
              key(values[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)]));
      set_pixel(picture, x, y, color(worst));
    }
  return picture;
}

}  // namespace

Picture error_map(int width, int height, std::span<const float> errors, double low, double high, int max_width) {
  return reduced(
      width, height, errors, max_width, [](float e) { return std::isnan(e) ? -1.0 : static_cast<double>(std::abs(e)); },
      [low, high](double worst) {
        if (worst < 0) return kNotCompared;
        return sequential_color(worst <= low ? 0.0 : std::log(worst / low) / std::log(high / low));
      });
}

Picture fight_map(int width, int height, std::span<const std::uint8_t> fights, int max_width) {
  return reduced(
      width, height, fights, max_width, [](std::uint8_t f) { return static_cast<double>(f); },
      [](double worst) { return kFightColors[static_cast<std::size_t>(std::max(worst, 0.0))]; });
}

}  // namespace halfplane
