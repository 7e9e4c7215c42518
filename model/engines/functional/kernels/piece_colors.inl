// Colours of pixels that show small and medium textured triangles (pieces.inl), sixteen pixels at a time, each of any
// triangle: a lane fetches the constants of its own triangle.
#pragma once

#include "bin.inl"
#include "level_of_detail.inl"
#include "perspective.inl"
#include "pieces.inl"
#include "surface.inl"
#include "texture.inl"
#include "tile_memory.inl"
#include "values.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// The pieces that pixels of a tile show, by group.
struct TilePieces {
  std::size_t count = 0;
  // GCC 12 takes an access to a std::array of these for one of another array.
  std::uint16_t group[kTilePixels];
  std::uint64_t pixels[kTilePixels];  ///< a bit each

  HALFPLANE_INLINE TilePieces() = default;
  HALFPLANE_INLINE void add(std::size_t number, std::uint64_t its_pixels) {
    group[count] = static_cast<std::uint16_t>(number);
    pixels[count++] = its_pixels;
  }
};

#if HALFPLANE_ISA == 512
/// The pieces that the pixels of a block show, a pixel a lane. A register holds a constant of all pieces of a group and
/// can be indexed, and so can two: a block mostly has one or two groups.
class BlockPieces {
 public:
  HALFPLANE_INLINE BlockPieces() = default;
  /// `pixels`: of the tile, at least one in the block; `numbers`: of the block.
  HALFPLANE_INLINE void set(const TilePieces& shown, std::uint64_t pixels, std::size_t block,
                            const std::uint16_t* numbers, const I16& to_sign) {
    count_ = 0;
    group_[1] = shown.group[0];
    lanes_[1] = 0;
    for (std::size_t i = 0; i < shown.count; ++i) {
      const std::uint32_t here = block_bits(shown.pixels[i] & pixels, block);
      group_[count_] = shown.group[i];
      lanes_[count_] = here;
      count_ += here != 0 ? 1 : 0;
    }
    const I16 in_group = load_narrow(numbers) & 15;
    of_two_ = select_by_bits(lanes_[1], in_group + 16, in_group, to_sign);
  }
  /// Lane by lane the rows of the pixel's piece, `first` being the rows of the first group; 0 for a pixel without a piece.
  /// `group_size`: bytes from one group to the next.
  template <std::size_t N>
  HALFPLANE_INLINE void rows(const PieceRow* const (&first)[N], std::size_t group_size, ColumnsOfRows<N>& to) const {
    const auto number = [&](std::size_t k, std::size_t n, std::size_t column) HALFPLANE_LAMBDA {
      const char* const row = reinterpret_cast<const char*>(first[n]) + group_[k] * group_size;
      return _mm512_load_si512(row + column * sizeof(I16));
    };
    const auto of_two = (__m512i)of_two_.part[0];
    const auto of_each = [&](auto&& visit) HALFPLANE_LAMBDA {
      for (std::size_t n = 0; n < N; ++n) {
        visit(to.row[n].first, n, std::size_t{0});
        visit(to.row[n].second, n, std::size_t{1});
        visit(to.row[n].third, n, std::size_t{2});
        visit(to.row[n].fourth, n, std::size_t{3});
      }
    };
    of_each([&](I16& lanes, std::size_t n, std::size_t column) HALFPLANE_LAMBDA {
      lanes.part[0] = (I16::Register)_mm512_maskz_permutex2var_epi32(
          static_cast<__mmask16>(lanes_[0] | lanes_[1]), number(0, n, column), of_two, number(1, n, column));
    });
    for (std::size_t k = 2; k < count_; ++k)
      of_each([&](I16& lanes, std::size_t n, std::size_t column) HALFPLANE_LAMBDA {
        lanes.part[0] = (I16::Register)_mm512_mask_permutexvar_epi32(
            (__m512i)lanes.part[0], static_cast<__mmask16>(lanes_[k]), of_two, number(k, n, column));
      });
  }

 private:
  static constexpr std::size_t kMost = kBlockPixels + 1;
  I16 of_two_;                  ///< a piece's index in its group, 16 more in the second group
  std::size_t count_;           ///< of groups
  std::size_t group_[kMost];    ///< numbers of the groups
  std::uint32_t lanes_[kMost];  ///< pixels of each group
};
#else
/// The same, row by row.
class BlockPieces {
 public:
  HALFPLANE_INLINE BlockPieces() = default;
  HALFPLANE_INLINE void set(const TilePieces&, std::uint64_t pixels, std::size_t block, const std::uint16_t* numbers,
                            const I16& to_sign) {
    number_ = select_by_bits(block_bits(pixels, block),
                             load_narrow(numbers) - static_cast<std::int32_t>(BinMemory::kFirstPiece), I16(0), to_sign);
  }
  template <std::size_t N>
  HALFPLANE_INLINE void rows(const PieceRow* const (&first)[N], std::size_t group_size, ColumnsOfRows<N>& to) const {
    constexpr int kRow = 4 * sizeof(std::int32_t);
    const Places place((number_ >> 4) * static_cast<std::int32_t>(group_size) + (number_ & 15) * kRow);
    for (std::size_t n = 0; n < N; ++n) {
      const Columns columns =
          turned_rows([&](int i) HALFPLANE_LAMBDA { return reinterpret_cast<const char*>(first[n]) + place[i]; });
      to.row[n].first = columns.first;
      to.row[n].second = columns.second;
      to.row[n].third = columns.third;
      to.row[n].fourth = columns.fourth;
    }
  }

 private:
  I16 number_;
};
#endif

/// over_q(), `value`: P. Lanes hold the members of LaneAttribute. `is_tame`, `may_gain`: as there, for all.
HALFPLANE_LEAF I16 over_q(const I16& value, const ReciprocalsOfQ& q, const I16& narrow, const I16& drop, bool is_tame,
                          bool may_gain, const LaneOverW& format) {
  const I16 down = q.exponent + narrow - PieceScale::kNarrowLess;
  const auto held = [&format](const I16& p)
                        HALFPLANE_LAMBDA { return min(max((p + 1) >> 1, I16(format.lowest)), I16(format.highest)); };
  I16 number;
  if (is_tame) {
    number = ((value >> down) + 1) >> 1;
  } else if (may_gain) {
    const I16 dropped = down - format.up;
    number = held(with_more_bits(value >> format.up, max(-dropped, I16(0))) >> min(max(dropped, I16(0)), I16(31)));
  } else {
    number = held(value >> as<I16>(min(as<W16>(down), W16(31))));
  }
  const I16 lower = q.reciprocal & format.lower_bits;
  const I16 product = number * (q.reciprocal >> format.split) + ((number * lower) >> format.split);
  return ((product >> drop) + 1) >> 1;
}

/// Levels of detail at pixels, by the rows of PieceLevels. `q`: float_bits() of Q.
HALFPLANE_INLINE I16 piece_lod(const Columns& at_zero, const Columns& step, const I16& offset, const I16& x,
                               const I16& y, const I16& q) {
  const auto at = [](const I16& zero, const I16& of_pixel, const I16& pixel)
                      HALFPLANE_LAMBDA { return as<W16>(magnitude(zero + pixel * of_pixel)); };
  const W16 to_right = octagon_length(at(at_zero.first, step.first, y), at(at_zero.second, step.second, y)),
            down = octagon_length(at(at_zero.third, step.third, x), at(at_zero.fourth, step.fourth, x));
  return log2_code_of(max(to_right, down)) - (log2_code(q) << 1) + offset;
}

/// The colours of a tile's pixels that show pieces of one style, to `colors` of its 64. Each step runs for all four blocks
/// before the next, as in shade(): the four dependency chains overlap.
template <Sampling kSampling>
HALFPLANE_NOINLINE void shade_pieces(Bin& bin, const SurfaceStyle& style, int tile, const TilePieces& shown,
                                     std::uint64_t pixels, std::uint32_t* const colors, const Packing& packing) {
  const LaneTexture& texture = style.texture;
  const LanePositions& position = bin.position;
  const std::uint16_t* const numbers = bin.memory.surface.data() + first_of(tile);
  const PieceConstants& constants = bin.memory.constants.front();
  const auto place = static_cast<std::size_t>((tile & 1) | (tile / kBinTiles & 1) << 1);
  const PieceConstants::Tile& of_tile = constants.tile[place];
  const bool is_tame = style.is_tame;
  const int color_down = bin.centred_color.down;
  BlockPieces pieces[4];
  alignas(64) std::array<std::uint32_t, kTilePixels> nearest;
  CoordinateLanes at[4];
  ReciprocalsOfQ reciprocals[4];
  I16 lod[4], red_blue[4], green_alpha[4];
  for_each_block([&](auto block) HALFPLANE_LAMBDA {
    if (block_bits(pixels, block) != 0)
      pieces[block].set(shown, pixels, block, numbers + block * kBlockPixels, position.to_sign);
  });
  for_each_block([&](auto block) HALFPLANE_LAMBDA {
    if (block_bits(pixels, block) == 0) return;
    ColumnsOfRows<3> rows;
    const BlockPieces& whose = pieces[block];
    whose.rows({&constants.step_x, &constants.step_y, &of_tile.coordinates}, sizeof constants, rows);
    const Columns &step_x = rows.row[0], &step_y = rows.row[1], &anchor = rows.row[2];
    const std::size_t right = block & 1, below = block >> 1;
    const I16 &column = position.column[right], &line = position.row[below];
    ReciprocalsOfQ& q = reciprocals[block];
    q.set(anchor.first + column * step_x.first + line * step_y.first, style.division);
    if constexpr (kSampling == Sampling::none) return;
    const auto along = [&](const I16& at_anchor, const I16& of_x, const I16& of_y, const I16& narrow, const I16& drop,
                           const I16& reference, std::size_t axis) HALFPLANE_LAMBDA {
      const I16 u =
          over_q(at_anchor + column * of_x + line * of_y, q, narrow, drop, is_tame, true, style.of_coordinate);
      return on_axis(texture, axis, u, reference);
    };
    const I16& drops = step_x.fourth;
    at[block].u =
        along(anchor.second, step_x.second, step_y.second, drops << 24 >> 24, drops << 8 >> 24, step_y.fourth, 0);
    at[block].v = along(anchor.third, step_x.third, step_y.third, drops << 16 >> 24, drops >> 24, anchor.fourth, 1);
    if constexpr (kSampling == Sampling::nearest)
      nearest_places(texture, at[block], BaseLevel(texture)).store(nearest.data() + block * kBlockPixels);
    if constexpr (kSampling == Sampling::any) {
      const PieceLevels& levels = bin.memory.levels.front();
      ColumnsOfRows<3> lines;
      whose.rows({&levels.at_zero, &levels.step, &levels.offset}, sizeof levels, lines);
      const I16 x = position.block_x +
                    (bin.first_x + tile % kBinTiles * kTileSize + static_cast<int>(right) * kBlockSize),
                y = position.block_y +
                    (bin.first_y + tile / kBinTiles * kTileSize + static_cast<int>(below) * kBlockSize);
      lod[block] = piece_lod(lines.row[0], lines.row[1], lines.row[2].first, x, y, q.bits);
    }
  });
  if constexpr (kSampling == Sampling::nearest) {
    for_each_block([&](auto block) HALFPLANE_LAMBDA {
      if (block_bits(pixels, block) == 0) return;
      std::uint32_t* const of_block = nearest.data() + block * kBlockPixels;
      fetch_texels(texture.texels, of_block, of_block);
    });
  } else if constexpr (kSampling != Sampling::none) {
    find_texels<kSampling>(bin, texture, pixels, at, lod, red_blue, green_alpha);
  }
  const auto over_w = [&](auto block) HALFPLANE_LAMBDA {
    const PieceColors& of = bin.memory.colors.front();
    ColumnsOfRows<4> rows;
    pieces[block].rows({&of.step_x, &of.step_y, &of.tile[place], &of.scale}, sizeof of, rows);
    const Columns &step_x = rows.row[0], &step_y = rows.row[1], &anchor = rows.row[2], &scale = rows.row[3];
    const I16 &column = position.column[block & 1], &line = position.row[block >> 1];
    const auto channel = [&](std::size_t c, const I16& at_anchor, const I16& of_x, const I16& of_y) HALFPLANE_LAMBDA {
      const int up = 24 - static_cast<int>(8 * c);
      const I16 code = over_q(at_anchor + column * of_x + line * of_y, reciprocals[block], scale.first << up >> 24,
                              scale.second << up >> 24, false, style.may_gain, style.of_color);
      return min(max(code, byte_of(scale.third, c)), byte_of(scale.fourth, c));
    };
    const I16 red = channel(0, anchor.first, step_x.first, step_y.first),
              green = channel(1, anchor.second, step_x.second, step_y.second),
              blue = channel(2, anchor.third, step_x.third, step_y.third),
              alpha = channel(3, anchor.fourth, step_x.fourth, step_y.fourth);
    return ColorPairs(red | (blue << 16), green | (alpha << 16));
  };
  const auto affine = [&](auto block) HALFPLANE_LAMBDA {
    const std::size_t right = block & 1, below = block >> 1;
    ColumnsOfRows<2> rows;
    pieces[block].rows({&constants.color, &of_tile.colors}, sizeof constants, rows);
    const Columns &step = rows.row[0], &from = rows.row[1];
    const S32 column_pair = as<S32>(position.column_pair[right]), row_pair = as<S32>(position.row_pair[below]);
    const auto pair = [&](const I16& at_anchor, const I16& of_x, const I16& of_y, std::size_t which) HALFPLANE_LAMBDA {
      const S32 value = column_pair * as<S32>(of_x) + row_pair * as<S32>(of_y) + as<S32>(at_anchor);
      const S32 code = (value >> color_down) + static_cast<std::int16_t>(0x80);
      return as<I16>(
          min(max(code, as<S32>(channel_pair(from.third, which))), as<S32>(channel_pair(from.fourth, which))));
    };
    const I16 red_green = pair(from.first, step.first, step.third, 0),
              blue_alpha = pair(from.second, step.second, step.fourth, 1);
    return ColorPairs(pairs(red_green, blue_alpha), upper_pairs(red_green, blue_alpha));
  };
  store_pixels(bin, colors, pixels, true, [&](auto block, const I16&) HALFPLANE_LAMBDA {
    const ColorPairs own = style.is_color_over_w ? over_w(block) : affine(block);
    if constexpr (kSampling == Sampling::none) return packed(own.red_blue, own.green_alpha, packing);
    const ColorPairs texels = [&]() HALFPLANE_LAMBDA {
      if constexpr (kSampling == Sampling::nearest) return ColorPairs(I16::load(nearest.data() + block * kBlockPixels));
      return ColorPairs(red_blue[block], green_alpha[block]);
    }();
    const ColorPairs mixed = combined(own, texels, texture);
    return packed(mixed.red_blue, mixed.green_alpha, packing);
  });
}
HALFPLANE_INLINE void shade_pieces(Bin& bin, const SurfaceStyle& style, int tile, const TilePieces& shown,
                                   std::uint64_t pixels, std::uint32_t* const colors, const Packing& packing) {
  switch (style.sampling) {
    case Sampling::none: return shade_pieces<Sampling::none>(bin, style, tile, shown, pixels, colors, packing);
    case Sampling::nearest: return shade_pieces<Sampling::nearest>(bin, style, tile, shown, pixels, colors, packing);
    case Sampling::linear: return shade_pieces<Sampling::linear>(bin, style, tile, shown, pixels, colors, packing);
    default: return shade_pieces<Sampling::any>(bin, style, tile, shown, pixels, colors, packing);
  }
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
