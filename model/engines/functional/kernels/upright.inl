// Texels of upright images: w is constant, u depends on the column alone and v on the row alone, as in 2D and menus. A
// tile then has eight columns and eight rows of texels: places and weights are computed once for each, and a row of
// texels is filtered along u once for all rows of pixels that lie on it. The sums are those of linear_sums(): exact, so
// that their order is free.
#pragma once

#include "bin.inl"
#include "perspective.inl"
#include "texture.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Finds u of a tile's columns and v of its rows, each twice: in lanes 0 to 7 and 8 to 15. Tiles of one column have the
/// same u, tiles of one row the same v.
HALFPLANE_INLINE const UprightMemory& upright_places(Bin& bin, const DrawnSurface& surface, int tile) {
  const SurfaceConstants& of = surface.constants;
  UprightMemory& memory = bin.memory.upright;
  if (memory.image != surface.number || !of.repeats_places) memory.known = 0;
  memory.image = surface.number;
  const std::size_t place[2] = {UprightMemory::column_of(tile), UprightMemory::row_of(tile)};
  const std::uint32_t both = 1U << place[0] | 1U << place[1];
  if ((memory.known & both) == both) return memory;
  memory.known |= both;
  const int tile_x = (bin.first_x >> kTileShift) + tile % kBinTiles,
            tile_y = (bin.first_y >> kTileShift) + tile / kBinTiles;
  const ReciprocalsOfQ reciprocal(I16(of.coordinate.q.anchor(tile_x, tile_y)), of.division);
  const I16 steps = bin.position.pair_x - kTileSize / 2;
  const auto along = [&](std::size_t axis, std::int32_t step) HALFPLANE_LAMBDA {
    const LaneAttribute& attribute = of.coordinate.attribute[axis];
    const I16 u = over_q(steps * step + attribute.p.anchor(tile_x, tile_y), reciprocal, attribute, of.of_coordinate);
    on_axis(of.texture, axis, u, of.texture.reference[axis]).store(memory.at[place[axis]].data());
  };
  along(0, of.coordinate.attribute[0].p.step_x);
  along(1, of.coordinate.attribute[1].p.step_y);
  return memory;
}

/// A linear filter on one level.
class UprightFilter {
 public:
  template <class Level>
  HALFPLANE_INLINE UprightFilter(const Bin& bin, const LaneTexture& of, const CoordinateLanes& at, const Level& level)
      : texture_(of) {
    const auto from_middle = [&](const I16& rounded, std::size_t axis, const I16& last)
                                 HALFPLANE_LAMBDA { return held_in_image(rounded - 128, of.beyond[axis], last); };
    const I16 u = from_middle(level.template rounded<0>(at.u), 0, level.template last<0>()),
              v = from_middle(level.template rounded<1>(at.v), 1, level.template last<1>());
    const I16 is_second = (bin.position.lane >> 3) & 1;  // right, or lower
    const I16 x = (u >> kTexelFraction) + is_second, y = (v >> kTexelFraction) + is_second;
    columns_ = column_place(wrapped_texel(x, of.wrap[0], level.template last<0>()), level.pitch());
    const I16 rows = level.first() + row_place(wrapped_texel(y, of.wrap[1], level.template last<1>()));
    (has_border(of.beyond[1]) ? select(is_on_border(y, level.template last<1>()), I16(kBorder), rows) : rows)
        .store(place_.data());
    across_ = channels_of_eight<false>((u & 255) * 0x01010101);
    weights_of(v & 255).store(down_.data());
    border_columns_ = has_border(of.beyond[0]) ? is_on_border(x, level.template last<0>()) : I16(0);
  }

  /// linear_sums() of a row of eight pixels: red with blue, and green with alpha.
  struct Sums {
    I16 red_blue, green_alpha;
  };
  HALFPLANE_INLINE Sums row(std::size_t j, SumTo to) {
    const std::int32_t upper = place_[j], lower = place_[j + kTileSize];
    if (upper == at_lower_ || lower == at_upper_) {
      const S32 kept = upper_;
      upper_ = lower_;
      lower_ = kept;
      std::swap(at_upper_, at_lower_);
    }
    if (upper != at_upper_) upper_ = filtered_across(j);
    if (lower != at_lower_) lower_ = filtered_across(j + kTileSize);
    at_upper_ = upper;
    at_lower_ = lower;
    const I16 weights(down_[j]);
    return {weighted(pairs(as<I16>(upper_), as<I16>(lower_)), weights, to),
            weighted(upper_pairs(as<I16>(upper_), as<I16>(lower_)), weights, to)};
  }

 private:
  /// Four channels of eight pixels, less 2^15. `row`: upper ones of the tile's rows, then lower ones.
  HALFPLANE_INLINE S32 filtered_across(std::size_t row) const {
    I16 texels(texture_.border);
    if (place_[row] != kBorder)
      texels = gather(static_cast<const std::uint32_t*>(texture_.texels) + place_[row], columns_);
    if (texture_.has_border) texels = select(border_columns_, I16(texture_.border), texels);
    const S32 left = channels_of_eight<false>(texels), right = channels_of_eight<true>(texels);
    return ((left << kTexelFraction) + (right - left) * across_) ^ std::int16_t{-0x8000};
  }

  static constexpr std::int32_t kNone = -1, kBorder = -2;  ///< places of no row, and of the border's rows
  const LaneTexture& texture_;
  I16 columns_;  ///< places of the left texels of the columns, then of the right ones
  I16 border_columns_;
  S32 across_, upper_, lower_;
  std::int32_t at_upper_ = kNone, at_lower_ = kNone;  ///< places of `upper_` and `lower_`
  alignas(64) std::array<std::int32_t, kBlockPixels> place_, down_;
};

/// Stores colors_of(row), four channels of eight pixels, for each row of a tile.
template <class ColorsOf>
HALFPLANE_INLINE void store_upright(std::uint32_t* to, ColorsOf&& colors_of) {
  for (std::size_t j = 0; j < kTileSize; j += kBlockSize) {
    const S32 first = colors_of(j), second = colors_of(j + 1), third = colors_of(j + 2), fourth = colors_of(j + 3);
    store_rows_as_blocks(first, second, third, fourth, to + j * kTileSize);
  }
}

template <class Level>
HALFPLANE_NOINLINE void upright_linear(const Bin& bin, const LaneTexture& texture, const CoordinateLanes& at,
                                       const Level& level, std::uint32_t* to) {
  UprightFilter filter(bin, texture, at, level);
  store_upright(to, [&](std::size_t j) HALFPLANE_LAMBDA {
    const UprightFilter::Sums sums = filter.row(j, SumTo::integer);
    return as<S32>(upper_pairs(sums.red_blue, sums.green_alpha));
  });
}

HALFPLANE_NOINLINE void upright_trilinear(const Bin& bin, const LaneTexture& texture, const CoordinateLanes& at,
                                          const LevelPair& levels, std::uint32_t* to) {
  UprightFilter lower(bin, texture, at, OneLevel(texture, levels.lower)),
      upper(bin, texture, at, OneLevel(texture, levels.upper));
  const I16 weights = weights_of(I16(static_cast<std::int32_t>(levels.part)));
  store_upright(to, [&](std::size_t j) HALFPLANE_LAMBDA {
    const UprightFilter::Sums first = lower.row(j, SumTo::level), second = upper.row(j, SumTo::level);
    return as<S32>(upper_pairs(blended_levels(first.red_blue, second.red_blue, weights),
                               blended_levels(first.green_alpha, second.green_alpha, weights)));
  });
}

/// The texels at a tile's pixels, R lowest; false if the filter is not linear.
HALFPLANE_NOINLINE bool find_upright_texels(Bin& bin, const DrawnSurface& surface, int tile, std::uint32_t* to) {
  const SurfaceConstants& of = surface.constants;
  const LaneTexture& texture = of.texture;
  const int tile_x = (bin.first_x >> kTileShift) + tile % kBinTiles,
            tile_y = (bin.first_y >> kTileShift) + tile / kBinTiles;
  const std::int32_t q = of.coordinate.q.anchor(tile_x, tile_y);
  const UprightMemory& places = upright_places(bin, surface, tile);
  const CoordinateLanes at{I16::load(places.at[UprightMemory::column_of(tile)].data()),
                           I16::load(places.at[UprightMemory::row_of(tile)].data())};
  const auto base = [&](bool is_linear) HALFPLANE_LAMBDA {
    if (is_linear) upright_linear(bin, texture, at, BaseLevel(texture), to);
    return is_linear;
  };
  if (sampling_of(texture) == Sampling::linear) return base(true);
  const Lod lambda = level_of_detail(texture.lod, static_cast<std::uint32_t>(q) >> of.division.up, tile_x << kTileShift,
                                     tile_y << kTileShift);
  const Lod lod = std::clamp(lambda + texture.bias, texture.least, texture.largest);
  if (lod <= texture.magnified) return base(texture.mag == TextureMag::linear);
  switch (texture.min) {
    case TextureMin::linear: return base(true);
    case TextureMin::linear_mipmap_nearest:
      upright_linear(bin, texture, at, OneLevel(texture, halfplane::nearest_level(lod, texture.last_level)), to);
      return true;
    case TextureMin::linear_mipmap_linear:
      upright_trilinear(bin, texture, at, levels_around(lod, texture.last_level), to);
      return true;
    default: return false;
  }
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
