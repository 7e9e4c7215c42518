// The end of a bin: all new data goes to the target, a row of tiles at a time.
#pragma once

#include "bin.inl"
#include "cutouts.inl"
#include "deferred.inl"
#include "layers.inl"
#include "tile_memory.inl"
#include "values.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

inline int tiles_along(int pixels) { return std::min((pixels + kTileSize - 1) / kTileSize, kBinTiles); }

/// A row of tiles as rows of pixels.
using PixelRows = std::array<std::array<std::uint32_t, kBinSize>, kTileSize>;

using TileOwners = std::array<std::int16_t, Bin::kTiles>;

/// Writes the row of tiles that begins with `first`. `cleared`: the clears no longer pending after the write.
/// `blocks_of(tile)`: a tile's values; `write_rows(left, right, tile, rows)`: the values of two tiles owned by
/// triangles.
template <class BlocksOf, class WriteRows>
HALFPLANE_INLINE void finish_row(Bin& bin, int first, int columns, std::uint32_t* image, const TileOwners& owners,
                                 std::uint8_t cleared, BlocksOf&& blocks_of, WriteRows&& write_rows) {
  const std::int16_t* owner = owners.data() + first;
  alignas(64) PixelRows rows;
  std::uint32_t is_new = 0;
  for (int i = 0; i < columns; ++i) is_new |= (owner[i] >= Bin::kInMemory ? 1U : 0U) << i;
  if (is_new == 0) return;
  for (int i = 0; i < kBinTiles; i += 2) {
    if ((is_new >> i & 3) == 3 && owner[i] >= 0 && owner[i + 1] >= 0) {
      const auto plane = [&](int at) HALFPLANE_LAMBDA -> const BinTriangle& {
        return bin.memory.planes[static_cast<std::size_t>(owner[at])];
      };
      write_rows(plane(i), plane(i + 1), first + i, rows);
      continue;
    }
    for (int at = i; at < i + 2; ++at) {
      if ((is_new >> at & 1) == 0) continue;
      const TileBlocks blocks = blocks_of(first + at);
      for (std::size_t half = 0; half < 2; ++half)
        store_blocks(rows[half * kBlockSize].data() + std::ptrdiff_t{at} * kTileSize, kBinSize, blocks[2 * half],
                     blocks[2 * half + 1]);
    }
  }
  const std::size_t first_tile = static_cast<std::size_t>(bin.job.bin * Bin::kTiles + first);
  for (std::uint32_t rest = is_new; rest != 0; rest &= rest - 1) {
    const std::size_t at = first_tile + static_cast<std::size_t>(std::countr_zero(rest));
    bin.job.tiles.pending[at] &= static_cast<std::uint8_t>(~cleared);
    bin.job.tiles.held[at] &= static_cast<std::uint8_t>(~cleared);
  }
  const std::ptrdiff_t stride = bin.job.target.stride;
  const std::uint32_t in_lines = bin.are_lines ? is_new & is_new >> 1 & 0x55 : 0, alone = is_new & ~(in_lines * 3);
  for (int y = 0; y < kTileSize; ++y) {
    const std::uint32_t* from = rows[static_cast<std::size_t>(y)].data();
    std::uint32_t* const to = image + y * stride;
    if (in_lines == 0x55) {
      for (int x = 0; x < kBinSize; x += 16) stream_line(to + x, I16::load(from + x));
      continue;
    }
    for (std::uint32_t rest = in_lines; rest != 0; rest &= rest - 1) {
      const int x = std::countr_zero(rest) * kTileSize;
      stream_line(to + x, I16::load(from + x));
    }
    for (std::uint32_t rest = alone; rest != 0; rest &= rest - 1) {
      const int x = std::countr_zero(rest) * kTileSize;
      std::memcpy(to + x, from + x, kTileSize * sizeof *to);
    }
  }
}

/// Writes depths of two tiles side by side, each owned by a triangle, row by row: a cache line each. `left_moved`,
/// `right_moved`: their gain to a sample.
HALFPLANE_INLINE void write_depth_rows(const Bin& bin, const BinTriangle& left, const BinTriangle& right, int tile,
                                       PixelRows& rows, std::int32_t left_moved = 0, std::int32_t right_moved = 0) {
  const int to = tile % kBinTiles * kTileSize;
  const auto both = [&](auto&& of) HALFPLANE_LAMBDA { return halves(of(left), of(right)); };
  const I16 step_y = both([](const BinTriangle& t) HALFPLANE_LAMBDA { return t.z_step_y; });
  const I16 low = both([](const BinTriangle& t) HALFPLANE_LAMBDA { return t.z_low; });
  const I16 high = both([](const BinTriangle& t) HALFPLANE_LAMBDA { return t.z_high; });
  const I16 step_x = both([](const BinTriangle& t) HALFPLANE_LAMBDA { return t.z_step_x; });
  I16 value = (bin.position.pair_x - kTileSize / 2) * step_x - step_y * (kTileSize / 2) +
              halves(wrapped_sum(depth_anchor(bin, left, tile % kBinTiles, tile / kBinTiles), left_moved),
                     wrapped_sum(depth_anchor(bin, right, tile % kBinTiles + 1, tile / kBinTiles), right_moved));
  for (auto& row : rows) {
    decode(value, bin.depth_format, low, high).store(row.data() + to);
    value += step_y;
  }
}

/// Likewise colours.
HALFPLANE_INLINE void write_color_rows(const Bin& bin, const BinTriangle& left, const BinTriangle& right, int tile,
                                       PixelRows& rows) {
  const int to = tile % kBinTiles * kTileSize;
  const auto both = [&](const auto& of) HALFPLANE_LAMBDA { return as<S32>(halves(of(left.color), of(right.color))); };
  const ChannelPairs at_left = color_anchor(bin, left, tile % kBinTiles, tile / kBinTiles),
                     at_right = color_anchor(bin, right, tile % kBinTiles + 1, tile / kBinTiles);
  const I16 x = bin.position.pair_x - kTileSize / 2;
  const auto column = as<S32>(pairs(x, x));
  std::array<S32, 2> value, step_y, low, high;
  const LaneFormat format = bin.color_format;
  const Packing plain{bin.config.color_format, false}, dithered{plain.format, true};
  const bool is_dithered = left.packing.dithers || right.packing.dithers;
  const I16 dithers =
      halves(-static_cast<std::int32_t>(left.packing.dithers), -static_cast<std::int32_t>(right.packing.dithers));
  for (std::size_t p = 0; p < 2; ++p) {
    step_y[p] = both([p](const ColorSteps& t) HALFPLANE_LAMBDA { return t.step_y[p]; });
    low[p] = both([p](const ColorSteps& t) HALFPLANE_LAMBDA { return t.low[p]; });
    high[p] = both([p](const ColorSteps& t) HALFPLANE_LAMBDA { return t.high[p]; });
    value[p] = column * both([p](const ColorSteps& t) HALFPLANE_LAMBDA { return t.step_x[p]; }) -
               (step_y[p] << (kTileShift - 1)) + as<S32>(halves(at_left[p], at_right[p]));
  }
  I16 place = bin.position.lane & 3;  // of the row's pixels in their blocks
  for (auto& row : rows) {
    const auto pair = [&](std::size_t p)
                          HALFPLANE_LAMBDA { return color_codes(value[p], as<I16>(low[p]), as<I16>(high[p]), format); };
    const I16 red_blue = pair(0), green_alpha = pair(1);
    I16 code = packed(red_blue, green_alpha, plain.format);
    if (is_dithered) code = select(dithers, packed(red_blue, green_alpha, dithered, thresholds_at(place)), code);
    code.store(row.data() + to);
    place += I16(kBlockSize);
    for (std::size_t p = 0; p < 2; ++p) value[p] += step_y[p];
  }
}

HALFPLANE_INLINE I16 mean_colors(const Bin& bin, std::size_t at) {
  const std::uint32_t* const from = bin.sample_memory.color.data() + bin.sample_place(0, at);
  const auto sample = [from](unsigned k) HALFPLANE_LAMBDA { return I16::load(from + k * kBlockPixels); };
  if (bin.samples == 4 && bin.config.color_format == ColorFormat::rgba8888)
    return mean_of_bytes(sample(0), sample(1), sample(2), sample(3));
  ColorSums sums(bin);
  for (unsigned k = 0; k < bin.samples; ++k) sums.add(sample(k));
  return sums.mean(bin);
}

/// A tile's colours at sample k, or its resolved ones.
constexpr unsigned kResolved = ~0U;
HALFPLANE_INLINE TileBlocks sample_colors(const Bin& bin, int tile, unsigned k) {
  TileBlocks blocks;
  if ((bin.split >> tile & 1) == 0) {
    const TileBlocks from = colors_of(bin, tile);
    for (std::size_t i = 0; i < 4; ++i) blocks[i] = from[i];
    return blocks;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t at = static_cast<std::size_t>(first_of(tile)) + kBlockPixels * i;
    blocks[i] =
        k == kResolved ? mean_colors(bin, at) : I16::load(bin.sample_memory.color.data() + bin.sample_place(k, at));
  }
  return blocks;
}

/// Writes a row of tiles with multisampled pixels: the resolved images, and with BinJob::keeps_samples the samples'
/// images.
HALFPLANE_NOINLINE void finish_samples(Bin& bin, int first, int columns) {
  const auto color_rows = [&bin](auto&&... of) HALFPLANE_LAMBDA { write_color_rows(bin, of...); };
  const auto write = [&](Framebuffer& to, unsigned depth_of, unsigned color_of) {
    const std::size_t at = to.at(bin.first_x, bin.first_y + first / kBinTiles * kTileSize);
    finish_row(
        bin, first, columns, to.depth.data() + at, bin.depth_owner, TileStates::kDepthCleared,
        [&](int tile) HALFPLANE_LAMBDA { return sample_depths(bin, tile, depth_of); },
        [&](const BinTriangle& left, const BinTriangle& right, int tile, PixelRows& rows) HALFPLANE_LAMBDA {
          write_depth_rows(bin, left, right, tile, rows, depth_at_sample(bin, left, depth_of),
                           depth_at_sample(bin, right, depth_of));
        });
    finish_row(
        bin, first, columns, to.color.data() + at, bin.color_owner, TileStates::kColorCleared,
        [&](int tile) HALFPLANE_LAMBDA { return sample_colors(bin, tile, color_of); }, color_rows);
  };
  write(bin.job.target, 0, kResolved);
  if (!bin.job.keeps_samples) return;
  for (unsigned k = 0; k < bin.samples; ++k) write(bin.job.target.samples[k], k, k);
}

/// Writes all new data to the target, a row of tiles at a time.
inline void finish(Bin& bin) {
  if (bin.surface_count + bin.group_count != 0) shade_all(bin);
  bin.memory.styles.clear();  // also of batches none of which was seen: the next frame's slices are other ones
  if (bin.layer_count != 0) lay_all(bin);
  const int columns = tiles_along(bin.job.target.width - bin.first_x),
            rows = tiles_along(bin.job.target.height - bin.first_y);
  if (bin.samples > 1) {
    bin.job.keeps_samples ? finish_cutouts(bin) : resolve_all_cutouts(bin);
    for (int row = 0; row < rows; ++row) finish_samples(bin, row * kBinTiles, columns);
    finish_lines();
    return;
  }
  const auto depths = [&bin](int tile) HALFPLANE_LAMBDA { return depths_of(bin, tile); };
  const auto colors = [&bin](int tile) HALFPLANE_LAMBDA { return colors_of(bin, tile); };
  const auto depth_rows = [&bin](auto&&... of) HALFPLANE_LAMBDA { write_depth_rows(bin, of...); };
  const auto color_rows = [&bin](auto&&... of) HALFPLANE_LAMBDA { write_color_rows(bin, of...); };
  for (int row = 0; row < rows; ++row) {
    const int tile = row * kBinTiles;
    const std::size_t to = bin.job.target.at(bin.first_x, bin.first_y + row * kTileSize);
    finish_row(bin, tile, columns, bin.job.target.depth.data() + to, bin.depth_owner, TileStates::kDepthCleared, depths,
               depth_rows);
    finish_row(bin, tile, columns, bin.job.target.color.data() + to, bin.color_owner, TileStates::kColorCleared, colors,
               color_rows);
  }
  finish_lines();
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
