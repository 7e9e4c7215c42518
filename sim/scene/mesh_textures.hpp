// The textures of a mesh under construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "model/scene.hpp"

namespace halfplane {

/// Limit of texels of one mesh: a small file can request any number of large images.
inline constexpr std::size_t kMostMeshTexels = std::size_t{1} << 27;

/// Appends an image as rgba8888 and returns its number. Its name is `wanted` as a word of a capture, made unique.
/// Throws InputError "place: the error; the remedy" when the texels exceed `most`.
[[nodiscard]] std::uint32_t add_texture(std::vector<Texture>& textures, const TexelImage& image,
                                        std::string_view wanted, const std::string& place,
                                        std::size_t most = kMostMeshTexels);

/// Makes mipmaps for a minification that reads them, if there are none yet: means of the codes' linear light.
void add_mips_for(TextureMin min, Texture& texture);

}  // namespace halfplane
