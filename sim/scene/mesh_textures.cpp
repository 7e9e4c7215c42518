#include "sim/scene/mesh_textures.hpp"

#include <algorithm>

#include "model/config.hpp"

namespace halfplane {
namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '_';
}

}  // namespace

std::uint32_t add_texture(std::vector<Texture>& textures, const TexelImage& image, std::string_view wanted,
                          const std::string& place, std::size_t most) {
  std::size_t texels = image.texel.size();
  for (const Texture& texture : textures) texels += texture.level.front().code.size();
  if (texels > most) {
    throw InputError(place + ": more than " + std::to_string(most) + " texels up to here; make the images smaller");
  }
  constexpr std::size_t kLongest = 40;
  std::string word(wanted.substr(0, kLongest));
  std::ranges::replace_if(
      word, [](char c) { return !is_plain(c); }, '_');
  if (word.empty() || word == "off") word = "texture";
  std::string name = word;
  for (std::size_t i = 2; std::ranges::find(textures, name, &Texture::name) != textures.end(); ++i) {
    name = word + "-" + std::to_string(i);
  }
  textures.push_back(make_texture(name, image, TextureFormat::rgba8888, Mips::none));
  return static_cast<std::uint32_t>(textures.size() - 1);
}

void add_mips_for(TextureMin min, Texture& texture) {
  if (min == TextureMin::nearest || min == TextureMin::linear || texture.mips != Mips::none) return;
  texture.mips = Mips::box_linear;
  add_mips(texture);
}

}  // namespace halfplane
