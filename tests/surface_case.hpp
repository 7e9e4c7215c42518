// Surfaces of any state, for the tests of the functional engine's lanes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "model/config.hpp"
#include "model/formats/texture.hpp"
#include "scene_builder.hpp"

namespace halfplane::test {

inline constexpr int kWidth = 150, kHeight = 100;

inline Config with_colors(const std::string& name) {
  Config config = preset(name);
  config.color_format = ColorFormat::rgba8888;
  config.stamp_size = std::min(config.stamp_size, 2);
  return config;
}

/// Noise: no two texels equal, so that a wrong one shows.
inline Texture noise(Random& random, int width, int height, TextureFormat format, Mips mips) {
  TexelImage image{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    Texel texel{};
    for (std::uint8_t& channel : texel) channel = static_cast<std::uint8_t>(random.index(256));
    image.texel.push_back(texel);
  }
  return make_texture("t" + std::to_string(random.index(1 << 20)), image, format, mips);
}

inline constexpr std::array kWraps{TextureWrap::repeat, TextureWrap::clamp, TextureWrap::mirror, TextureWrap::border,
                                   TextureWrap::half_border};

inline State random_surface(Random& random) {
  State state = SceneBuilder::window_state();
  state.depth_test = static_cast<DepthFunc>(random.index(8));
  state.depth_write = random.index(5) != 0;
  state.color_write = random.index(8) != 0;
  state.shade = static_cast<Shade>(random.index(2));
  state.color_interp = static_cast<ColorInterp>(random.index(2));
  state.texture_interp = static_cast<TextureInterp>(random.index(2));
  state.texture_min = static_cast<TextureMin>(random.index(6));
  state.texture_mag = static_cast<TextureMag>(random.index(2));
  for (TextureWrap& wrap : state.texture_wrap) wrap = static_cast<TextureWrap>(random.index(3));
  Random own = random;  // of the constant, so that the other numbers are the same with it and without
  state.texture_combine = static_cast<TextureCombine>(random.index(4));
  if (own.index(5) == 4) state.texture_combine = TextureCombine::blend;
  for (std::uint8_t& channel : state.texture_constant) channel = static_cast<std::uint8_t>(own.index(256));
  for (TextureWrap& wrap : state.texture_wrap)
    if (own.index(4) == 0) wrap = own.index(2) == 0 ? TextureWrap::border : TextureWrap::half_border;
  for (std::uint8_t& channel : state.texture_border) channel = static_cast<std::uint8_t>(own.index(256));
  state.texture_lod[0] = random.index(3) == 0 ? random.between(-16, 16) : random.between(-1, 1);
  state.texture_lod[1] = random.index(4) == 0 ? random.between(0, 12) : 0;
  state.texture_lod[2] = random.index(4) == 0 ? random.between(0, 12) : 12;
  return state;
}

}  // namespace halfplane::test
