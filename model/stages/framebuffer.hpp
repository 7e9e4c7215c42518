// Framebuffer: depth, colour and stencil memory of one target.
//
// In: depth-tested stamps, clears. Out: the two images. Depth is one code per pixel, colour one stored code per pixel
// (Config::color_format), stencil 8 bits. Rows are padded to whole tiles, so that an engine may touch a tile as a
// whole. With several samples per pixel each sample has its own images, and resolve() computes the pixel's images.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace halfplane {

/// Allocates from the start of a cache line on. resize() leaves what is new undefined.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};

  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}  // NOLINT: as allocators are
  [[nodiscard]] T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kLine)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, kLine); }
  template <class U>
  void construct(U* p) {
    ::new (static_cast<void*>(p)) U;
  }
  bool operator==(const CacheLineAllocator&) const = default;
};

enum class FrameContent { zero, undefined };

struct Framebuffer {
  using Image = std::vector<std::uint32_t, CacheLineAllocator<std::uint32_t>>;

  int width = 0, height = 0;  ///< pixels
  int stride = 0;             ///< pixels from one row to the next; rows below `height` are padding as well
  Image depth, color;
  std::vector<std::uint8_t> stencil;
  std::vector<Framebuffer> samples;  ///< of each sample of a pixel; empty with one sample per pixel

  Framebuffer() = default;
  /// `content`: of depth and colour.
  Framebuffer(int width_, int height_, int tile_size, FrameContent content = FrameContent::zero)
      : width(width_), height(height_), stride((width_ + tile_size - 1) / tile_size * tile_size) {
    const auto rows = static_cast<std::size_t>((height_ + tile_size - 1) / tile_size * tile_size);
    const std::size_t pixels = static_cast<std::size_t>(stride) * rows;
    for (Image* image : {&depth, &color})
      if (content == FrameContent::zero)
        image->assign(pixels, 0);
      else
        image->resize(pixels);
    stencil.resize(pixels);
  }

  /// Whether every sixteen pixels of a row, from its first on, are a cache line.
  [[nodiscard]] bool has_whole_lines() const { return stride % 16 == 0; }

  /// Index of pixel (x, y) in each image.
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(x);
  }
};

}  // namespace halfplane
