// Level of detail in lanes: level_of_detail.hpp.
#pragma once

#include "bin.inl"
#include "perspective.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

HALFPLANE_INLINE W16 octagon_length(const W16& a, const W16& b) {
  const W16 high = max(a, b), low = min(a, b);
  return max(high, high - (high >> 3) + (low >> 1));
}

/// log2_code(), of float_bits().
HALFPLANE_INLINE I16 log2_code(const I16& bits) {
  const I16 log = (bits >> (kFloatFraction - kLodFraction)) - (kFloatBias << kLodFraction), part = log & 255;
  return log + (multiply_add_pairs(multiply_add_pairs(part, 256 - part), I16(95)) >> 16);
}

/// For lengths that may take all 32 bits.
HALFPLANE_INLINE I16 log2_code_of(const W16& length) {
  const W16 has_all = length >> 31;
  const I16 halved = max(as<I16>(length >> has_all), I16(1));
  return log2_code(float_bits(halved)) + (as<I16>(has_all) << kLodFraction);
}

/// Lines in a tile: their magnitudes at the pixels of a block.
struct LodRamps {
  std::array<I16, 2> along_x, along_y;  ///< in the first block

  HALFPLANE_INLINE LodRamps() = default;
  HALFPLANE_INLINE void set(const Bin& bin, const LodSetup& lod, int tile_x, int tile_y) {
    const auto line = [](const LodLine& of, int first, const I16& pixel) HALFPLANE_LAMBDA {
      const std::uint32_t at_first = of.at_zero + static_cast<std::uint32_t>(first) * of.step;
      return pixel * static_cast<std::int32_t>(of.step) + static_cast<std::int32_t>(at_first);
    };
    const int x = bin.first_x + tile_x * kTileSize, y = bin.first_y + tile_y * kTileSize;
    along_x[0] = line(lod.along_x[0], x, bin.position.block_x);
    along_x[1] = line(lod.along_x[1], x, bin.position.block_x);
    along_y[0] = line(lod.along_y[0], y, bin.position.block_y);
    along_y[1] = line(lod.along_y[1], y, bin.position.block_y);
  }

  /// lambda in block 0...3 of the tile. `q`: float_bits() of Q.
  HALFPLANE_INLINE I16 operator()(const LodSetup& lod, std::size_t block, const I16& q) const {
    const auto length = [](const std::array<I16, 2>& of, const std::array<LodLine, 2>& line, std::size_t side)
                            HALFPLANE_LAMBDA {
                              const auto at = [&](std::size_t c) HALFPLANE_LAMBDA {
                                const std::int32_t aside = static_cast<std::int32_t>(side) * kBlockSize;
                                return as<W16>(magnitude(of[c] + aside * static_cast<std::int32_t>(line[c].step)));
                              };
                              return octagon_length(at(0), at(1));
                            };
    const W16 longest = max(length(along_y, lod.along_y, block >> 1), length(along_x, lod.along_x, block & 1));
    return log2_code_of(longest) - (log2_code(q) << 1) + lod.offset;
  }
};

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
