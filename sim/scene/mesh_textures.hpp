// The textures of a mesh under construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "model/scene.hpp"

namespace halfplane {

/// A small file can ask for any number of large images: at most so many texels are kept of one mesh.
inline constexpr std::size_t kMostMeshTexels = std::size_t{1} << 27;

/// Appends an image as rgba8888; its number. Its name is `wanted` as a word of a capture, and unlike the others'. Throws
/// InputError "place: what; the mend" when that makes more than `most` texels.
[[nodiscard]] std::uint32_t add_texture(std::vector<Texture>& textures, const TexelImage& image,
                                        std::string_view wanted, const std::string& place,
                                        std::size_t most = kMostMeshTexels);

/// Makes mipmaps for a minification that reads them, if there are none yet: means of the light that the codes stand for.
void add_mips_for(TextureMin min, Texture& texture);

}  // namespace halfplane
