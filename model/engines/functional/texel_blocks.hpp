// A texture as lanes fetch it: decoded, in blocks of 4 x 4 texels, a cache line each. A linear footprint then lies in
// one line more often than in two, for any rotation of the texture.
//
// For linear filters each texel may be stored with its footprint: itself, the next texel, and both of the row below.
// That takes four times the memory, and one load per pixel instead of four.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "../../scene.hpp"

namespace halfplane {

class TexelBlocks {
 public:
  static constexpr int kShift = 2, kSize = 1 << kShift, kTexels = kSize * kSize;
  static constexpr std::size_t kLevels = 16;  ///< levels of 4096 texels, and a few empty ones
  static constexpr std::size_t kMostQuads = std::size_t{1}
                                            << 21;  ///< texels of a texture with footprints: 32 MB of them
  struct alignas(64) Block {
    std::array<std::uint32_t, kTexels> texel{};  ///< row after row, R lowest
  };
  /// A footprint by channel, R first: from the lowest byte on its left and right texel, and those of the row below; each
  /// less 128, in two's complement.
  using Quad = std::array<std::uint32_t, 4>;
  static constexpr std::uint32_t kCentre = 0x80808080U;  ///< of a quad's bytes

  explicit TexelBlocks(const Texture& texture);

  /// Makes footprints for these borders, if supported: not for mirrored images, nor for large ones.
  void add_quads(const std::array<TextureWrap, 2>& wrap);
  /// Indexed like `blocks`; null if there are none.
  [[nodiscard]] const Quad* quads(const std::array<TextureWrap, 2>& wrap) const;

  /// The minimum and the maximum alpha of level 0 in squares of 4, 8, ... texels, up to one that covers all.
  class AlphaRanges {
   public:
    struct Range {
      std::uint8_t low = 255, high = 0;
    };
    /// `bits`: log2 of the sides.
    AlphaRanges(const TexelBlocks& texels, const std::array<int, 2>& bits);
    /// Range over columns and rows `low` to `high`, which may cross the end of the image: over the squares that meet
    /// them.
    [[nodiscard]] Range range(const std::array<std::int32_t, 2>& low, const std::array<std::int32_t, 2>& high,
                              const std::array<TextureWrap, 2>& wrap) const;

   private:
    /// log2 of the squares along an axis.
    [[nodiscard]] int bits_along(std::size_t axis, int shift) const { return std::max(bits_[axis] - shift, 0); }
    std::array<int, 2> bits_;
    std::vector<std::vector<Range>> squares_;  ///< ranges of squares of 4, 8, ... texels, row after row
  };
  /// Makes the ranges, if sides are powers of two.
  void add_alpha_ranges();
  /// Makes separate alphas of existing footprints.
  void add_alpha_quads();
  /// The last words of the footprints, indexed like `blocks`; null if there are none.
  [[nodiscard]] const std::uint32_t* alpha_quads(const std::array<TextureWrap, 2>& wrap) const;
  [[nodiscard]] const AlphaRanges* alpha_ranges() const { return alpha_ranges_ ? &*alpha_ranges_ : nullptr; }

  std::vector<Block> blocks;                  ///< level after level, column of blocks after column
  std::array<std::int32_t, kLevels> first{};  ///< first texel of each level
  bool is_opaque = true;                      ///< the alpha of all texels is 255

 private:
  struct Size {
    int width, height;
  };
  [[nodiscard]] std::size_t place_of(std::size_t level, int x, int y) const;
  /// The part of a row of texels from (x, y) that lies in one block.
  [[nodiscard]] std::uint32_t* row_of(std::size_t level, int x, int y) {
    const std::size_t place = place_of(level, x, y);
    return blocks[place / kTexels].texel.data() + place % kTexels;
  }
  [[nodiscard]] std::uint32_t texel(std::size_t place) const { return blocks[place / kTexels].texel[place % kTexels]; }

  std::vector<Size> size_;                  ///< of each level
  std::array<std::vector<Quad>, 4> quads_;  ///< by the axes that repeat: u, v
  std::array<std::vector<std::uint32_t>, 4> alpha_quads_;
  std::optional<AlphaRanges> alpha_ranges_;
};

}  // namespace halfplane
