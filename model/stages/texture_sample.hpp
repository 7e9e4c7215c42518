// Texture sample: a triangle's sampler state, and the texture's colour at a place and a level of detail.
//
// Where a pixel spans more than a texel, texture_min applies, else texture_mag; the border is a level of 0, or of 1/2
// where a linear image meets nearest ones (OpenGL 4.6, 8.14.3).
#pragma once

#include "../scene.hpp"
#include "texture_filter.hpp"

namespace halfplane {

/// The border's colour as a texel of a format: R, G, B, A.
[[nodiscard]] inline Texel border_texel(Texel border, TextureFormat format) {
  if (!has_alpha(format)) border[3] = 255;
  return border;
}

struct Sampler {
  const Texture* texture = nullptr;
  TextureAxes axes{};
  TextureMin min = TextureMin::nearest;
  TextureMag mag = TextureMag::nearest;
  Lod bias = 0, least = 0, largest = 0;
  int last_level = 0;
  Texel border{};  ///< opaque for a format without alpha

  Sampler() = default;
  Sampler(const Texture& texture_, const State& state)
      : texture(&texture_),
        axes{TextureAxis{texture_.width(), state.texture_wrap[0]},
             TextureAxis{texture_.height(), state.texture_wrap[1]}},
        min(state.texture_min),
        mag(state.texture_mag),
        bias(to_lod(state.texture_lod[0])),
        least(to_lod(state.texture_lod[1])),
        largest(std::max(least, to_lod(state.texture_lod[2]))),
        last_level(texture_.last_level()),
        border(border_texel(state.texture_border, texture_.format)) {}

 private:
  [[nodiscard]] static Lod to_lod(double level) { return static_cast<Lod>(std::floor(level * 256 + 0.5)); }
};

/// The texels that a sample reads.
struct SampleFilter {
  bool is_linear = false;   ///< on each level; else the nearest texel
  bool is_between = false;  ///< two levels; else `levels.lower` alone
  LevelPair levels;
};

/// `lod`: level_of_detail(), without bias and bounds.
[[nodiscard]] inline SampleFilter filter_of(const Sampler& s, Lod lod) {
  const bool is_nearest = s.min == TextureMin::nearest || s.min == TextureMin::nearest_mipmap_nearest ||
                          s.min == TextureMin::nearest_mipmap_linear;
  const bool has_levels = s.min != TextureMin::nearest && s.min != TextureMin::linear;
  const Lod level = std::clamp(lod + s.bias, s.least, s.largest);
  const Lod magnified = s.mag == TextureMag::linear && is_nearest && has_levels ? 128 : 0;
  if (level <= magnified) return {s.mag == TextureMag::linear, false, {}};
  if (!has_levels) return {!is_nearest, false, {}};
  if (s.min == TextureMin::nearest_mipmap_nearest || s.min == TextureMin::linear_mipmap_nearest)
    return {!is_nearest, false, {nearest_level(level, s.last_level), 0, 0}};
  return {!is_nearest, true, levels_around(level, s.last_level)};
}

/// The texture's colour; `lod` as above.
[[nodiscard]] inline Texel sample(const Sampler& s, const TexturePlace& place, Lod lod) {
  const auto fetch = [&s](int level, int x, int y) { return s.texture->texel(level, x, y); };
  const auto [is_linear, is_between, levels] = filter_of(s, lod);
  if (is_between)
    return is_linear ? filter_trilinear(fetch, s.axes, place, levels, s.border)
                     : filter_between_nearest(fetch, s.axes, place, levels, s.border);
  return is_linear ? filter_linear(fetch, s.axes, place, levels.lower, s.border)
                   : filter_nearest(fetch, s.axes, place, levels.lower, s.border);
}

}  // namespace halfplane
