// Framebuffer: depth and colour memory of one target.
//
// In: depth-tested stamps, clears. Out: the two images. Depth is one code per pixel, colour one stored code per pixel
// (Config::color_format). Rows are padded to whole tiles, so that an engine may touch a tile as a whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace halfplane {

struct Framebuffer {
  int width = 0, height = 0;  ///< pixels
  int stride = 0;             ///< pixels from one row to the next; rows below `height` are padding as well
  std::vector<std::uint32_t> depth;
  std::vector<std::uint32_t> color;

  Framebuffer() = default;
  Framebuffer(int width_, int height_, int tile_size)
      : width(width_), height(height_), stride((width_ + tile_size - 1) / tile_size * tile_size) {
    const auto rows = static_cast<std::size_t>((height_ + tile_size - 1) / tile_size * tile_size);
    depth.resize(static_cast<std::size_t>(stride) * rows);
    color.resize(depth.size());
  }

  /// Index of pixel (x, y) in `depth` and `color`.
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(x);
  }
};

}  // namespace halfplane
