#include "sim/study/bench/mesa_texture.hpp"

#include <array>
#include <cstddef>

namespace halfplane::gl {
namespace {

std::vector<Texel> texels_of(const Texture& texture, int level) {
  const TextureLevel& image = texture.level[static_cast<std::size_t>(level)];
  std::vector<Texel> texels;
  texels.reserve(image.code.size());
  for (const std::uint32_t code : image.code) texels.push_back(decode_texel(texture.format, code, texture.palette));
  return texels;
}

Enum min_filter(TextureMin min) {
  if (min == TextureMin::nearest) return kNearest;
  if (min == TextureMin::linear) return kLinear;
  return kNearestMipmapNearest + static_cast<Enum>(min) - static_cast<Enum>(TextureMin::nearest_mipmap_nearest);
}

}  // namespace

std::vector<Name> make_textures(const Functions& gl, const Scene& scene) {
  std::vector<Name> names(scene.textures.size());
  gl.gen_textures(static_cast<int>(names.size()), names.data());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Texture& texture = scene.textures[i];
    gl.bind_texture(kTexture2d, names[i]);
    for (int n = 0; n <= texture.last_level(); ++n) {
      const TextureLevel& level = texture.level[static_cast<std::size_t>(n)];
      gl.tex_image_2d(kTexture2d, n, kRgba8, level.width, level.height, 0, kRgba, kUnsignedByte,
                      texels_of(texture, n).data());
    }
    gl.tex_parameteri(kTexture2d, kMaxLevel, texture.last_level());
  }
  return names;
}

void apply_texture(const Functions& gl, Name texture, const State& state) {
  constexpr std::array kWraps{kRepeat, kClampToEdge, kMirroredRepeat};
  gl.bind_texture(kTexture2d, texture);
  gl.tex_parameteri(kTexture2d, kMinFilter, static_cast<int>(min_filter(state.texture_min)));
  gl.tex_parameteri(kTexture2d, kMagFilter,
                    static_cast<int>(state.texture_mag == TextureMag::linear ? kLinear : kNearest));
  for (std::size_t axis = 0; axis < 2; ++axis)
    gl.tex_parameteri(kTexture2d, kWrapS + static_cast<Enum>(axis),
                      static_cast<int>(kWraps[static_cast<std::size_t>(state.texture_wrap[axis])]));
  constexpr std::array kLods{kLodBias, kMinLod, kMaxLod};
  for (std::size_t i = 0; i < kLods.size(); ++i)
    gl.tex_parameterf(kTexture2d, kLods[i], static_cast<float>(state.texture_lod[i]));
}

std::string combine_source(TextureCombine combine, bool has_alpha) {
  switch (combine) {
    case TextureCombine::modulate: return "color * texel";
    case TextureCombine::replace: return has_alpha ? "texel" : "vec4(texel.rgb, color.a)";
    case TextureCombine::decal: return "vec4(mix(color.rgb, texel.rgb, texel.a), color.a)";
    case TextureCombine::add: break;
  }
  return "vec4(color.rgb + texel.rgb, color.a * texel.a)";
}

}  // namespace halfplane::gl
