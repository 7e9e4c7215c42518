// Texture filter: from a coordinate and a level to a texel colour, combined with the primitive's own colour.
//
// A coordinate counts texels of level 0 with f fraction bits; texel i holds [i, i + 1), its centre is i + 1/2. On its
// level it has 8 fraction bits: truncated to select one texel, rounded to give weights, which halves their error.
//   nearest    the texel that contains the place
//   linear     the four whose centres surround it, weights (256 - a, a) (256 - b, b): the 8 bits after the point of u -
//   1/2, v - 1/2
//   trilinear  linear on two levels, each kept to 8 fraction bits of a channel, then (256 - c, c)
// A sum is rounded once, (sum + 2^15) >> 16; between two levels twice, with an error of 2^-9 of a code, which saves a
// multiplier of 25 bits. `fetch(level, x, y)` gives the texel there, R, G, B, A; `border` is the colour beyond the
// image of an axis that has one.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "../fixed.hpp"
#include "../scene.hpp"
#include "color_ops.hpp"
#include "level_of_detail.hpp"

namespace halfplane {

inline constexpr int kTexelFraction = 8;  ///< fraction bits of a coordinate on its level, and bits of a weight

/// Texels along one axis of an image: 1 to 4096, any number.
struct TextureAxis {
  int size = 1;
  TextureWrap wrap = TextureWrap::repeat;

  [[nodiscard]] constexpr bool is_power_of_two() const { return std::has_single_bit(static_cast<unsigned>(size)); }
  /// Period of the image in texels, if it has one.
  [[nodiscard]] constexpr std::int64_t period() const {
    return wrap == TextureWrap::mirror ? std::int64_t{2} * size : std::int64_t{size};
  }
  [[nodiscard]] constexpr TextureAxis at_level(int level) const { return {std::max(1, size >> level), wrap}; }
};

/// value modulo period, non-negative.
[[nodiscard]] constexpr std::int64_t floor_modulo(std::int64_t value, std::int64_t period) {
  const std::int64_t rest = value % period;
  return rest < 0 ? rest + period : rest;
}

/// u_ref as passed to the hardware: modulo the period; or, without one, moved without effect on any coordinate of the
/// triangle. Host.
[[nodiscard]] inline std::int32_t wrapped_reference(double reference, const TextureAxis& axis) {
  if (!has_period(axis.wrap)) {
    const double limit = std::ldexp(1.0, kMaxReach + 2);  // twice the largest U
    return static_cast<std::int32_t>(std::clamp(reference, -limit, limit));
  }
  const auto period = static_cast<double>(axis.period());
  const double rest = std::fmod(reference, period);  // exact, unlike a quotient
  return static_cast<std::int32_t>(rest < 0 ? rest + period : rest);
}

/// U + u_ref, 2^-f texels; modulo the period if there is one.
[[nodiscard]] constexpr std::int64_t texture_coordinate(std::int64_t u, std::int32_t reference, int fraction_bits,
                                                        const TextureAxis& axis) {
  const std::int64_t sum = u + reference * (std::int64_t{1} << fraction_bits);
  return !has_period(axis.wrap) ? sum : floor_modulo(sum, axis.period() << fraction_bits);
}

/// A coordinate of level 0, f fraction bits, on another level, 8 fraction bits: coordinate size_n / size, truncated.
[[nodiscard]] constexpr std::int64_t at_level(std::int64_t coordinate, int fraction_bits, const TextureAxis& axis,
                                              int level) {
  const std::int64_t fine = coordinate << (kTexelFraction - fraction_bits);
  if (axis.is_power_of_two()) return fine >> std::min(level, floor_log2(static_cast<unsigned>(axis.size)));
  const std::int64_t scaled = fine * axis.at_level(level).size;
  return (scaled - floor_modulo(scaled, axis.size)) / axis.size;
}

/// The same rounded: truncated to one more bit, then rounded by it.
[[nodiscard]] constexpr std::int64_t rounded_at_level(std::int64_t coordinate, int fraction_bits,
                                                      const TextureAxis& axis, int level) {
  return round_shift(at_level(2 * coordinate, fraction_bits, axis, level), 1);
}

/// The texel of the image for texel number i; where that is in the border, the texel next to it.
[[nodiscard]] constexpr int wrapped_texel(std::int64_t i, const TextureAxis& axis) {
  const std::int64_t last = axis.size - 1;
  if (!has_period(axis.wrap)) return static_cast<int>(std::clamp<std::int64_t>(i, 0, last));
  const std::int64_t period = axis.period();
  const std::int64_t rest = axis.is_power_of_two() ? i & (period - 1) : floor_modulo(i, period);
  return static_cast<int>(rest > last ? period - 1 - rest : rest);  // beyond the last texel: mirrored
}

/// Whether texel number i is the border's.
[[nodiscard]] constexpr bool is_on_border(std::int64_t i, const TextureAxis& axis) {
  return has_border(axis.wrap) && (i < 0 || i >= axis.size);
}

/// A sample's place on a texture: coordinates of level 0 with f fraction bits.
struct TexturePlace {
  std::array<std::int64_t, 2> coordinate{};
  int fraction_bits = kTexelFraction;
  int weight_bits = kTexelFraction;  ///< of a linear filter's weights; fewer for studies
};
/// Along u and v, of level 0.
using TextureAxes = std::array<TextureAxis, 2>;

/// Input of one axis of a linear filter: two texels, and the weight of the second, in 256ths.
struct TexelPair {
  int first = 0, second = 0;
  std::uint32_t part = 0;
  bool is_first_border = false, is_second_border = false;  ///< the border's colour instead of the texel
};
[[nodiscard]] constexpr TexelPair texels_around(const TexturePlace& place, const TextureAxes& axes, std::size_t axis,
                                                int level) {
  const TextureAxis on_level = axes[axis].at_level(level);
  std::int64_t u = rounded_at_level(place.coordinate[axis], place.fraction_bits, axes[axis], level);
  if (on_level.wrap == TextureWrap::half_border)
    u = std::clamp<std::int64_t>(u, 0, std::int64_t{on_level.size} << kTexelFraction);
  const std::int64_t from_middle = u - (1 << (kTexelFraction - 1));
  const std::int64_t first = from_middle >> kTexelFraction;
  const int dropped = kTexelFraction - place.weight_bits;
  return {wrapped_texel(first, on_level), wrapped_texel(first + 1, on_level),
          static_cast<std::uint32_t>(round_shift(from_middle & 255, dropped) << dropped), is_on_border(first, on_level),
          is_on_border(first + 1, on_level)};
}
/// Input of one axis of a nearest filter, twice. half_border shows no border.
[[nodiscard]] constexpr TexelPair nearest_texel(const TexturePlace& place, const TextureAxes& axes, std::size_t axis,
                                                int level) {
  const std::int64_t i = at_level(place.coordinate[axis], place.fraction_bits, axes[axis], level) >> kTexelFraction;
  const TextureAxis on_level = axes[axis].at_level(level);
  const int texel = wrapped_texel(i, on_level);
  const bool is_border = on_level.wrap == TextureWrap::border && is_on_border(i, on_level);
  return {texel, texel, 0, is_border, is_border};
}

template <class Fetch>
[[nodiscard]] Texel filter_nearest(Fetch&& fetch, const TextureAxes& axes, const TexturePlace& place, int level,
                                   const Texel& border = {}) {
  const TexelPair x = nearest_texel(place, axes, 0, level), y = nearest_texel(place, axes, 1, level);
  return x.is_first_border || y.is_first_border ? border : fetch(level, x.first, y.first);
}

/// The sums of a linear filter, 16 fraction bits.
template <class Fetch>
[[nodiscard]] std::array<std::uint32_t, 4> linear_sums(Fetch&& fetch, const TextureAxes& axes,
                                                       const TexturePlace& place, int level, const Texel& border = {}) {
  const TexelPair x = texels_around(place, axes, 0, level), y = texels_around(place, axes, 1, level);
  const auto at = [&](int column, int row, bool is_border) -> Texel {
    return is_border ? border : fetch(level, column, row);
  };
  const std::array<Texel, 4> texel{at(x.first, y.first, x.is_first_border || y.is_first_border),
                                   at(x.second, y.first, x.is_second_border || y.is_first_border),
                                   at(x.first, y.second, x.is_first_border || y.is_second_border),
                                   at(x.second, y.second, x.is_second_border || y.is_second_border)};
  const std::array weight{(256 - x.part) * (256 - y.part), x.part * (256 - y.part), (256 - x.part) * y.part,
                          x.part * y.part};
  std::array<std::uint32_t, 4> sum{};
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t t = 0; t < 4; ++t) sum[c] += weight[t] * texel[t][c];
  return sum;
}

template <class Fetch>
[[nodiscard]] Texel filter_linear(Fetch&& fetch, const TextureAxes& axes, const TexturePlace& place, int level,
                                  const Texel& border = {}) {
  const auto sum = linear_sums(fetch, axes, place, level, border);
  Texel result{};
  for (std::size_t c = 0; c < 4; ++c) result[c] = static_cast<std::uint8_t>(round_shift(sum[c], 16));
  return result;
}

/// Blends two colours with 8 fraction bits each; `part`: the weight of the second, in 256ths.
[[nodiscard]] constexpr std::uint8_t blend_levels(std::uint32_t lower, std::uint32_t upper, std::uint32_t part) {
  return static_cast<std::uint8_t>(round_shift(lower * (256 - part) + upper * part, 16));
}

/// Linear on two levels (linear_mipmap_linear).
template <class Fetch>
[[nodiscard]] Texel filter_trilinear(Fetch&& fetch, const TextureAxes& axes, const TexturePlace& place,
                                     const LevelPair& levels, const Texel& border = {}) {
  const auto lower = linear_sums(fetch, axes, place, levels.lower, border),
             upper = linear_sums(fetch, axes, place, levels.upper, border);
  Texel result{};
  for (std::size_t c = 0; c < 4; ++c)
    result[c] = blend_levels(round_shift(lower[c], 8), round_shift(upper[c], 8), levels.part);
  return result;
}

/// Nearest on two levels (nearest_mipmap_linear).
template <class Fetch>
[[nodiscard]] Texel filter_between_nearest(Fetch&& fetch, const TextureAxes& axes, const TexturePlace& place,
                                           const LevelPair& levels, const Texel& border = {}) {
  const Texel lower = filter_nearest(fetch, axes, place, levels.lower, border),
              upper = filter_nearest(fetch, axes, place, levels.upper, border);
  Texel result{};
  for (std::size_t c = 0; c < 4; ++c)
    result[c] = blend_levels(std::uint32_t{lower[c]} << 8, std::uint32_t{upper[c]} << 8, levels.part);
  return result;
}

/// The primitive's colour and the texture's combined: OpenGL ES 1.1, table 3.17. A format without alpha keeps the
/// primitive's alpha; its texels have 255 there. `constant`: for blend, which modulates alpha.
[[nodiscard]] constexpr Texel combined(const Texel& color, const Texel& texel, TextureCombine combine, bool has_alpha,
                                       const std::array<std::uint8_t, 3>& constant) {
  const auto rounded = [](std::uint32_t value) { return static_cast<std::uint8_t>(divide_by_255(value)); };
  const auto product = [rounded](std::uint32_t a, std::uint32_t b) { return rounded(a * b); };
  Texel result = color;
  for (std::size_t c = 0; c < 3; ++c) {
    switch (combine) {
      case TextureCombine::modulate: result[c] = product(color[c], texel[c]); break;
      case TextureCombine::replace: result[c] = texel[c]; break;
      case TextureCombine::decal:
        result[c] = rounded(std::uint32_t{color[c]} * (255U - texel[3]) + std::uint32_t{texel[c]} * texel[3]);
        break;
      case TextureCombine::add: result[c] = static_cast<std::uint8_t>(std::min(color[c] + texel[c], 255)); break;
      case TextureCombine::blend:
        result[c] = rounded(std::uint32_t{color[c]} * (255U - texel[c]) + std::uint32_t{constant[c]} * texel[c]);
        break;
    }
  }
  if (combine != TextureCombine::replace && combine != TextureCombine::decal) result[3] = product(color[3], texel[3]);
  if (combine == TextureCombine::replace && has_alpha) result[3] = texel[3];
  return result;
}

}  // namespace halfplane
