// Golden texture mapping: OpenGL's filtering (OpenGL 4.6 core profile, 8.14), with real coordinates, derivatives, levels of
// detail and weights. Only the texels have 8 bits.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "../scene.hpp"

namespace halfplane::golden {

/// The place of a sample on a texture, 0 to 1 over its sides; and its change from pixel to pixel.
struct TextureCoordinates {
  double u = 0, v = 0;
  double u_x = 0, u_y = 0, v_x = 0, v_y = 0;
};

/// R, G, B, A, 0...255.
using Color = std::array<double, 4>;

/// The level of detail before bias and bounds: the base-2 logarithm of the larger extent, in texels, of a pixel's side.
[[nodiscard]] inline double level_of_detail(const Texture& texture, const TextureCoordinates& at) {
  const double width = texture.width(), height = texture.height();
  return std::log2(std::max(std::hypot(at.u_x * width, at.v_x * height), std::hypot(at.u_y * width, at.v_y * height)));
}

/// The texel of the image for a whole number, with `size` texels along the axis; next to the border, if it is there.
[[nodiscard]] inline int wrapped(double texel, int size, TextureWrap wrap) {
  const auto modulo = [texel](double period) {
    const double rest = std::fmod(texel, period);  // exact, unlike a quotient
    return rest < 0 ? rest + period : rest;
  };
  if (!has_period(wrap)) return static_cast<int>(std::clamp(texel, 0.0, static_cast<double>(size - 1)));
  if (wrap == TextureWrap::repeat) return static_cast<int>(modulo(size));
  const int i = static_cast<int>(modulo(2.0 * size));
  return i < size ? i : 2 * size - 1 - i;
}

/// Whether a whole number is on the border: OpenGL 1.5, 3.8.7 and 3.8.8; CLAMP, which is half_border, selects no border
/// texel for a nearest filter.
[[nodiscard]] inline bool is_on_border(double texel, int size, TextureWrap wrap, bool is_linear) {
  const bool has_one = wrap == TextureWrap::border || (wrap == TextureWrap::half_border && is_linear);
  return has_one && (texel < 0 || texel >= size);
}

[[nodiscard]] inline Color texel_at(const Texture& texture, const State& state, int n, double x, double y,
                                    bool is_linear) {
  const TextureLevel& level = texture.level[static_cast<std::size_t>(n)];
  Texel t =
      texture.texel(n, wrapped(x, level.width, state.texture_wrap[0]), wrapped(y, level.height, state.texture_wrap[1]));
  if (is_on_border(x, level.width, state.texture_wrap[0], is_linear) ||
      is_on_border(y, level.height, state.texture_wrap[1], is_linear)) {
    t = state.texture_border;
    if (!has_alpha(texture.format)) t[3] = 255;
  }
  return {static_cast<double>(t[0]), static_cast<double>(t[1]), static_cast<double>(t[2]), static_cast<double>(t[3])};
}

[[nodiscard]] inline Color between(const Color& a, const Color& b, double part) {
  Color c;
  for (std::size_t i = 0; i < c.size(); ++i) c[i] = a[i] + part * (b[i] - a[i]);
  return c;
}

/// Texels of level 0.
struct TexelPlace {
  double x = 0, y = 0;
};

/// Moves a place within binary64's error of a border of texels, 2^-40 of the extent, onto the border: a sprite whose
/// coordinates lie on borders shows the texel that begins there.
[[nodiscard]] inline double on_border(double place, double extent) {
  const double border = std::round(place);
  return std::abs(place - border) <= std::ldexp(std::max(std::abs(place), extent), -40) ? border : place;
}

/// One level: its nearest texel, or the four around the place by their distances.
[[nodiscard]] inline Color filtered_level(const Texture& texture, const State& state, const TexelPlace& at, int n,
                                          bool is_linear) {
  const TextureLevel& level = texture.level[static_cast<std::size_t>(n)];
  const auto on_level = [is_linear](double texels, int size, int whole, TextureWrap wrap) {
    double place = texels * size / whole;
    if (wrap == TextureWrap::half_border) place = std::clamp<double>(place, 0, size);
    place = is_linear ? place - 0.5 : on_border(place, size);
    return std::isfinite(place) ? place : 0;  // an overflow has no place
  };
  const double x = on_level(at.x, level.width, texture.width(), state.texture_wrap[0]),
               y = on_level(at.y, level.height, texture.height(), state.texture_wrap[1]);
  const double left = std::floor(x), top = std::floor(y);
  const auto texel = [&](int i, int j) { return texel_at(texture, state, n, left + i, top + j, is_linear); };
  if (!is_linear) return texel(0, 0);
  return between(between(texel(0, 0), texel(1, 0), x - left), between(texel(0, 1), texel(1, 1), x - left), y - top);
}

/// A level of detail with bias and bounds.
[[nodiscard]] inline double bounded_level(const State& state, double lod) {
  const auto [bias, least, largest] = state.texture_lod;
  return std::clamp(lod + bias, least, std::max(least, largest));
}

/// The texture's colour at a place; `lod`: with bias and bounds.
[[nodiscard]] inline Color filtered(const Texture& texture, const State& state, const TexelPlace& at, double lod) {
  const TextureMin min = state.texture_min;
  const bool is_nearest = min == TextureMin::nearest || min == TextureMin::nearest_mipmap_nearest ||
                          min == TextureMin::nearest_mipmap_linear;
  const bool has_levels = min != TextureMin::nearest && min != TextureMin::linear;
  // Where a nearest level would switch from a linear image at once, OpenGL magnifies half a level longer.
  const double magnified = state.texture_mag == TextureMag::linear && is_nearest && has_levels ? 0.5 : 0;
  if (!(lod > magnified)) return filtered_level(texture, state, at, 0, state.texture_mag == TextureMag::linear);
  if (!has_levels) return filtered_level(texture, state, at, 0, !is_nearest);
  const auto held = [&texture](double n) { return static_cast<int>(std::min<double>(n, texture.last_level())); };
  if (min == TextureMin::nearest_mipmap_nearest || min == TextureMin::linear_mipmap_nearest)
    return filtered_level(texture, state, at, held(std::ceil(lod + 0.5) - 1), !is_nearest);
  const double lower = std::floor(lod);
  return between(filtered_level(texture, state, at, held(lower), !is_nearest),
                 filtered_level(texture, state, at, held(lower + 1), !is_nearest), lod - lower);
}

/// The texture's colour at a sample.
[[nodiscard]] inline Color filtered(const Texture& texture, const State& state, const TextureCoordinates& at) {
  return filtered(texture, state, TexelPlace{at.u * texture.width(), at.v * texture.height()},
                  bounded_level(state, level_of_detail(texture, at)));
}

/// The primitive's colour and the texture's combined: OpenGL ES 1.1's table 3.17; alpha is unchanged if the format has
/// none. `constant`: of blend, 0...255.
[[nodiscard]] inline Color combined(const Color& color, const Color& texel, TextureCombine combine, bool has_alpha,
                                    const std::array<std::uint8_t, 3>& constant) {
  Color c = color;
  for (std::size_t i = 0; i < 3; ++i) switch (combine) {
      case TextureCombine::modulate: c[i] = color[i] * texel[i] / 255; break;
      case TextureCombine::replace: c[i] = texel[i]; break;
      case TextureCombine::decal: c[i] = color[i] + (texel[i] - color[i]) * texel[3] / 255; break;
      case TextureCombine::add: c[i] = std::min(color[i] + texel[i], 255.0); break;
      case TextureCombine::blend: c[i] = color[i] * (1 - texel[i] / 255) + constant[i] * (texel[i] / 255); break;
    }
  if (combine != TextureCombine::replace && combine != TextureCombine::decal) c[3] = color[3] * texel[3] / 255;
  if (combine == TextureCombine::replace && has_alpha) c[3] = texel[3];
  return c;
}

}  // namespace halfplane::golden
