#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "../config.hpp"
#include "capture_textures.hpp"

#define STB_IMAGE_STATIC  // our copy stays in this file, whatever other libraries contain
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#include <stb_image.h>

namespace halfplane {
namespace {

// More than the uncompressed size of the largest texture, at 16 bits a channel. A device or a pipe may have no end at
// all.
constexpr std::size_t kMostBytes = std::size_t{1} << 28;

}  // namespace

TexelImage read_image(std::string_view bytes, const std::string& what) {
  int width = 0, height = 0, channels = 0;
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const auto size = static_cast<int>(std::min<std::size_t>(bytes.size(), 1U << 30));
  if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0)
    throw InputError(what + ": no PNG, JPEG, BMP or TGA image (" + stbi_failure_reason() + "); give one");
  if (width > kLargestTexture || height > kLargestTexture)
    throw InputError(what + ": " + std::to_string(width) + "x" + std::to_string(height) +
                     " texels; give an image of at most 4096x4096");
  stbi_uc* texels = stbi_load_from_memory(data, size, &width, &height, &channels, 4);
  if (texels == nullptr)
    throw InputError(what + ": the image is damaged (" + stbi_failure_reason() + "); save it again");
  TexelImage image{width, height, {}};
  const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  image.texel.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    image.texel[i] = {texels[4 * i], texels[4 * i + 1], texels[4 * i + 2], texels[4 * i + 3]};
  stbi_image_free(texels);
  return image;
}

TexelImage read_image_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw InputError(path + ": this is a folder; give an image file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": the image cannot be opened");
  std::string bytes;
  for (std::size_t part = std::size_t{1} << 16; file && bytes.size() <= kMostBytes; part *= 2) {
    const std::size_t had = bytes.size();
    bytes.resize(had + part);
    file.read(bytes.data() + had, static_cast<std::streamsize>(part));
    bytes.resize(had + static_cast<std::size_t>(file.gcount()));
  }
  if (bytes.size() > kMostBytes)
    throw InputError(path + ": more than " + std::to_string(kMostBytes) + " bytes; give an image file");
  return read_image(bytes, path);
}

}  // namespace halfplane
