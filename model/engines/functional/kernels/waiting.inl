// Operated triangles of a batch, sixteen set up together. A pixel that has passed the depth test waits with its colour, or the
// number of its surface, until the batch ends or another triangle passes at the same pixel: then all waiting pixels of
// the tile are operated upon at once. Waiting pixels are those of Bin::waiting, of tiles whose colours are in memory.
#pragma once

#include "bin.inl"
#include "deferred.inl"
#include "operations.inl"
#include "tile_memory.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Colours of a tile, 8 bits a channel.
struct WaitingColors {
  const std::uint32_t* rgba;

  HALFPLANE_INLINE ColorPairs operator[](std::size_t block) const {
    return ColorPairs(I16::load(rgba + block * kBlockPixels));
  }
};

/// Operates on the waiting pixels of a tile.
HALFPLANE_NOINLINE void operate_on_waiting(Bin& bin, int tile) {
  const std::uint64_t pixels = std::exchange(bin.waiting[static_cast<std::size_t>(tile)], 0);
  alignas(64) std::array<std::uint32_t, kTilePixels> shaded;
  WaitingColors colors{bin.memory.source.data() + first_of(tile)};
  if (bin.state.has_surface) {
    shaded.fill(0);
    shade_numbered(bin, tile, pixels, shaded.data(), &kUnpacked);
    colors.rgba = shaded.data();
  }
  const std::uint64_t kept = bin.tests_alpha ? test_alpha(bin, pixels, colors) : pixels;
  count_killed(bin, static_cast<unsigned>(std::popcount(pixels & ~kept)));
  if (kept != 0) store_colors(bin, bin.memory.color.data() + first_of(tile), kept, colors);
}

/// Lets `pixels` of the block that begins with pixel `at` wait: their colours, or numbers, are stored next.
HALFPLANE_INLINE void wait_for_operations(Bin& bin, std::size_t at, std::uint32_t pixels) {
  std::uint64_t& waiting = bin.waiting[at / kTilePixels];
  const std::uint64_t those = std::uint64_t{pixels} << at % kTilePixels;
  if ((waiting & those) != 0) operate_on_waiting(bin, static_cast<int>(at / kTilePixels));
  waiting |= those;
}

/// The end of a batch that has touched `tiles`.
HALFPLANE_INLINE void operate_on_all_waiting(Bin& bin, std::uint64_t tiles) {
  for (; tiles != 0; tiles &= tiles - 1)
    if (const int tile = std::countr_zero(tiles); bin.waiting[static_cast<std::size_t>(tile)] != 0)
      operate_on_waiting(bin, tile);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
