// Location of a tile's pixels: in the target, in the bin's memory, or a triangle not yet computed; and the range of its
// depths.
#pragma once

#include "bin.inl"
#include "values.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// First pixel of a tile in the bin's memory.
inline int first_of(int tile) { return tile * kTileSize * kTileSize; }

/// Place of pixel (x, y) of the bin in its memory.
HALFPLANE_INLINE I16 place_of(const I16& x, const I16& y) {
  return (((x & 56) << 3) | ((x & 4) << 2) | (x & 3)) + (((y & 56) << 6) | ((y & 4) << 3) | ((y & 3) << 2));
}

/// The pixel at a place: the inverse.
struct BinPixel {
  int x, y;
};
[[nodiscard]] inline BinPixel pixel_of(std::int32_t place) {
  const int tile = place >> 6, block = place >> 4 & 3;
  return {tile % kBinTiles * kTileSize + (block & 1) * kBlockSize + (place & 3),
          tile / kBinTiles * kTileSize + (block >> 1) * kBlockSize + (place >> 2 & 3)};
}

/// Prefetches the bin's part of the target: it is written at the end, and comes from distant memory.
inline void fetch_target(const Bin& bin) {
  constexpr int kLine = 16;  // pixels
  const int rows = std::min(kBinSize, bin.job.target.height - bin.first_y),
            columns = std::min(kBinSize, bin.job.target.width - bin.first_x);
  for (int y = 0; y < rows; ++y) {
    const std::size_t at = bin.job.target.at(bin.first_x, bin.first_y + y);
    for (int x = 0; x < columns + kLine - 1; x += kLine) {
      const std::size_t pixel = at + static_cast<std::size_t>(std::min(x, columns - 1));
      __builtin_prefetch(bin.job.target.depth.data() + pixel, 1, 2);
      __builtin_prefetch(bin.job.target.color.data() + pixel, 1, 2);
    }
  }
}

/// First pixel of a tile in the target, or none if the tile is outside.
[[nodiscard]] inline std::ptrdiff_t in_target(const Bin& bin, int tile) {
  const int x = bin.first_x + tile % kBinTiles * kTileSize, y = bin.first_y + tile / kBinTiles * kTileSize;
  if (x >= bin.job.target.width || y >= bin.job.target.height) return -1;
  return static_cast<std::ptrdiff_t>(bin.job.target.at(x, y));
}

/// The bin's depths, in 16 bits if these suffice, else in 32.
struct DepthPixels {
  bool is_narrow;
  std::uint16_t* narrow;
  std::int32_t* wide;

  HALFPLANE_INLINE explicit DepthPixels(Bin& bin)
      : is_narrow(bin.is_narrow), narrow(bin.memory.narrow_depth.data()), wide(bin.memory.depth.data()) {}
  HALFPLANE_INLINE std::int32_t at(std::size_t pixel) const { return is_narrow ? narrow[pixel] : wide[pixel]; }
  HALFPLANE_INLINE void set(std::size_t pixel, std::int32_t depth) const {
    if (is_narrow)
      narrow[pixel] = static_cast<std::uint16_t>(depth);
    else
      wide[pixel] = depth;
  }
};

/// Depths of the block that begins with pixel `at`.
HALFPLANE_INLINE I16 load_depths(const Bin& bin, std::size_t at) {
  return bin.is_narrow ? load_narrow(bin.memory.narrow_depth.data() + at) : I16::load(bin.memory.depth.data() + at);
}
HALFPLANE_INLINE void store_depths(Bin& bin, std::size_t at, const I16& depths) {
  if (bin.is_narrow)
    store_narrow(depths, bin.memory.narrow_depth.data() + at);
  else
    depths.store(bin.memory.depth.data() + at);
}

using TileBlocks = std::array<I16, 4>;

/// A tile's depths, from memory or from a triangle.
HALFPLANE_INLINE TileBlocks depths_of(const Bin& bin, int tile) {
  TileBlocks blocks;
  const std::int32_t owner = bin.depth_owner[tile];
  if (owner >= 0) {
    const BinTriangle& t = bin.memory.planes[static_cast<std::size_t>(owner)];
    const auto ramp = depth_ramp(bin, t, depth_anchor(bin, t, tile % kBinTiles, tile / kBinTiles));
    for (std::size_t i = 0; i < 4; ++i) blocks[i] = block_depths(bin, t, ramp, i);
  } else {
    const auto from = static_cast<std::size_t>(first_of(tile));
    for (std::size_t i = 0; i < 4; ++i) blocks[i] = load_depths(bin, from + kBlockPixels * i);
  }
  return blocks;
}

HALFPLANE_INLINE TileBlocks colors_of(const Bin& bin, int tile) {
  TileBlocks blocks;
  const std::int32_t owner = bin.color_owner[tile];
  if (owner >= 0) {
    const BinTriangle& t = bin.memory.planes[static_cast<std::size_t>(owner)];
    const auto ramp = color_ramp(bin, t.color, color_anchor(bin, t, tile % kBinTiles, tile / kBinTiles));
    for (std::size_t i = 0; i < 4; ++i) blocks[i] = block_colors(t.color, ramp, i, bin.color_format, t.packing);
  } else {
    const std::uint32_t* from = bin.memory.color.data() + first_of(tile);
    for (std::size_t i = 0; i < 4; ++i) blocks[i] = I16::load(from + kBlockPixels * i);
  }
  return blocks;
}

/// A tile of the target, or with the values of a clear.
HALFPLANE_INLINE TileBlocks fetched(const Bin& bin, int tile, bool is_cleared, std::uint32_t clear,
                                    const Framebuffer::Image& image) {
  TileBlocks blocks;
  for (I16& block : blocks) block = I16(static_cast<std::int32_t>(clear));
  const std::ptrdiff_t from = is_cleared ? -1 : in_target(bin, tile);
  if (from < 0) return blocks;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto row = static_cast<std::ptrdiff_t>(i >> 1), column = static_cast<std::ptrdiff_t>(i & 1);
    blocks[i] =
        load_block(image.data() + from + kBlockSize * (row * bin.job.target.stride + column), bin.job.target.stride);
  }
  return blocks;
}

HALFPLANE_NOINLINE void fetch_depth(Bin& bin, int tile) {
  const std::int32_t owner = bin.depth_owner[tile];
  const TileBlocks blocks = owner >= 0
                                ? depths_of(bin, tile)
                                : fetched(bin, tile, owner == Bin::kCleared, bin.job.clear_depth, bin.job.target.depth);
  const auto to = static_cast<std::size_t>(first_of(tile));
  for (std::size_t i = 0; i < 4; ++i) store_depths(bin, to + kBlockPixels * i, blocks[i]);
  bin.depth_owner[tile] = Bin::kInMemory;
}

/// Whether the colours of a tile are textured primitives not yet shaded.
HALFPLANE_INLINE bool is_waiting(const Bin& bin, int tile) {
  const std::int32_t owner = bin.color_owner[tile];
  return owner == Bin::kSurfaces || (owner >= 0 && bin.memory.planes[static_cast<std::size_t>(owner)].surface != 0);
}

HALFPLANE_NOINLINE void fetch_color(Bin& bin, int tile) {
  const std::int32_t owner = bin.color_owner[tile];
  if (owner == Bin::kLayers || owner == Bin::kCutouts || is_waiting(bin, tile)) return bin.compute_deferred(bin, tile);
  const TileBlocks blocks = owner >= 0
                                ? colors_of(bin, tile)
                                : fetched(bin, tile, owner == Bin::kCleared, bin.job.clear_color, bin.job.target.color);
  std::uint32_t* const to = bin.memory.color.data() + first_of(tile);
  for (std::size_t i = 0; i < 4; ++i) blocks[i].store(to + kBlockPixels * i);
  bin.color_owner[tile] = Bin::kInMemory;
}

/// Brings the tile's depths to memory.
HALFPLANE_INLINE void need_depth(Bin& bin, int tile) {
  if (bin.depth_owner[tile] != Bin::kInMemory) fetch_depth(bin, tile);
}

HALFPLANE_INLINE void need_color(Bin& bin, int tile) {
  if (bin.color_owner[tile] != Bin::kInMemory) fetch_color(bin, tile);
}

inline void find_bin_range(Bin& bin) {
  bin.is_range_old = false;
  const U64 high = U64::load(bin.tile_high);
  bin.low = static_cast<std::int32_t>(min_lane(U64::load(bin.tile_low)));
  bin.high = static_cast<std::int32_t>(max_lane(high));
  bin.lowest_high = static_cast<std::int32_t>(min_lane(high));
  bin.closed_from = std::min(bin.closed_from, bin.high + (bin.range_bits_dropped != 0 ? 1 : 0));
}

HALFPLANE_INLINE void set_range(Bin& bin, int tile, std::int32_t low, std::int32_t high) {
  bin.tile_low[tile] = static_cast<std::uint16_t>(low >> bin.range_bits_dropped);
  bin.tile_high[tile] = static_cast<std::uint16_t>(high >> bin.range_bits_dropped);
}

/// Depths of sample k in the block that begins with pixel `at`.
HALFPLANE_INLINE I16 load_sample(const Bin& bin, unsigned k, std::size_t at) {
  const SampleMemory& memory = bin.sample_memory;
  const std::size_t place = bin.sample_place(k, at);
  return bin.is_narrow ? load_narrow(memory.narrow_depth.data() + place) : I16::load(memory.depth.data() + place);
}
HALFPLANE_INLINE void store_sample(const Bin& bin, unsigned k, std::size_t at, const I16& depths) {
  SampleMemory& memory = bin.sample_memory;
  const std::size_t place = bin.sample_place(k, at);
  if (bin.is_narrow)
    store_narrow(depths, memory.narrow_depth.data() + place);
  else
    depths.store(memory.depth.data() + place);
}

/// A tile's depths at sample k, from any owner.
HALFPLANE_INLINE TileBlocks sample_depths(const Bin& bin, int tile, unsigned k) {
  TileBlocks blocks;
  const std::int32_t owner = bin.depth_owner[tile];
  if (owner >= 0) {
    const BinTriangle& t = bin.memory.planes[static_cast<std::size_t>(owner)];
    const auto ramp = depth_ramp(
        bin, t, wrapped_sum(depth_anchor(bin, t, tile % kBinTiles, tile / kBinTiles), depth_at_sample(bin, t, k)));
    for (std::size_t i = 0; i < 4; ++i) blocks[i] = block_depths(bin, t, ramp, i);
  } else if (owner == Bin::kInMemory) {
    const auto from = static_cast<std::size_t>(first_of(tile));
    for (std::size_t i = 0; i < 4; ++i) blocks[i] = load_sample(bin, k, from + kBlockPixels * i);
  } else {
    const bool is_cleared = owner == Bin::kCleared;
    const TileBlocks from = fetched(bin, tile, is_cleared, bin.job.clear_depth,
                                    is_cleared ? bin.job.target.depth : bin.job.target.samples[k].depth);
    for (std::size_t i = 0; i < 4; ++i) blocks[i] = from[i];
  }
  return blocks;
}

HALFPLANE_INLINE void find_sample_range(Bin& bin, int tile) {
  if (bin.is_narrow) {
    const std::uint16_t* const from = bin.sample_memory.narrow_depth.data() + bin.sample_place(0, first_of(tile));
    U64 low = U64::load(from), high = low;
    for (unsigned k = 1; k < bin.samples; ++k) {
      const U64 depths = U64::load(from + k * kTilePixels);
      low = min(low, depths);
      high = max(high, depths);
    }
    bin.tile_low[tile] = static_cast<std::uint16_t>(min_lane(low));
    bin.tile_high[tile] = static_cast<std::uint16_t>(max_lane(high));
    return;
  }
  I16 low(0x7fffffff), high(0);
  for (unsigned k = 0; k < bin.samples; ++k)
    for (std::size_t i = 0; i < 4; ++i) {
      const I16 depths = load_sample(bin, k, static_cast<std::size_t>(first_of(tile)) + kBlockPixels * i);
      low = min(low, depths);
      high = max(high, depths);
    }
  set_range(bin, tile, min_lane(low), max_lane(high));
}

/// The range of a tile's depths, from its pixels.
HALFPLANE_INLINE void find_range(Bin& bin, int tile) {
  if (bin.is_narrow) {
    const U64 depth = U64::load(bin.memory.narrow_depth.data() + first_of(tile));
    bin.tile_low[tile] = static_cast<std::uint16_t>(min_lane(depth));
    bin.tile_high[tile] = static_cast<std::uint16_t>(max_lane(depth));
    return;
  }
  const std::int32_t* from = bin.memory.depth.data() + first_of(tile);
  I16 low = I16::load(from), high = low;
  for (std::size_t block = 1; block < 4; ++block) {
    const I16 depth = I16::load(from + kBlockPixels * block);
    low = min(low, depth);
    high = max(high, depth);
  }
  set_range(bin, tile, min_lane(low), max_lane(high));
}

/// Marks that a tile may now also hold any depth. A store, not a minimum: the next triangle of the tile need not wait
/// for it.
template <class Fragments>
HALFPLANE_INLINE void forget_range(Bin& bin, int tile) {
  if (Fragments::kIsLess || !bin.rises) bin.tile_low[tile] = 0;
  if (!Fragments::kIsLess && !bin.falls) bin.tile_high[tile] = 0xffff;
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
