// Planes of sixteen small or medium triangles at a time, with the integers of triangle_setup, a triangle a lane.
#pragma once

#include "cull.inl"
#include "leaf.inl"
#include "small_batch.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// A place at which planes are evaluated, from their origin, subpixels.
struct FromOrigin {
  I16 x, y;
};

/// The anchor of the tile that holds a pixel of the bin. `first_x`, `first_y`: the bin's first; `s`: bits of the grid.
HALFPLANE_INLINE FromOrigin anchor_from_origin(const SmallCorners& corners, const I16& x, const I16& y, int s,
                                               int first_x, int first_y) {
  const auto anchor_of = [s](const I16& pixel, int first) HALFPLANE_LAMBDA {
    return ((pixel & ~(kTileSize - 1)) << s) + (((first + kTileSize / 2) << s) + (1 << (s - 1)));
  };
  return {anchor_of(x, first_x) - corners.origin.x, anchor_of(y, first_y) - corners.origin.y};
}

// Planes and gradients that wrap come in three widths: I16 where 32 bits hold them; SplitLanes, split at
// LaneFormat::drop, where 32 bits suffice for the upper part; L16.

/// The value of a plane, with LaneFormat::anchor_bias. `fraction`: its bits.
HALFPLANE_INLINE I16 plane_at(const FromOrigin& to, int fraction, const I16& at_origin, const I16& step_x,
                              const I16& step_y, const LaneFormat& format) {
  return (at_origin << fraction) + step_x * to.x + step_y * to.y +
         static_cast<std::int32_t>(static_cast<std::uint32_t>(format.anchor_bias));
}
HALFPLANE_INLINE SplitLanes plane_at(const FromOrigin& to, int fraction, const I16& at_origin, const SplitLanes& step_x,
                                     const SplitLanes& step_y, const LaneFormat& format) {
  const auto bias = static_cast<std::int64_t>(format.anchor_bias);
  const auto low_bias = static_cast<std::int32_t>(bias & ((std::int64_t{1} << format.drop) - 1));
  return {(at_origin << (fraction - format.drop)) + step_x.upper * to.x + step_y.upper * to.y +
              static_cast<std::int32_t>(bias >> format.drop),
          step_x.lower * to.x + step_y.lower * to.y + low_bias};
}
HALFPLANE_INLINE L16 plane_at(const FromOrigin& to, int fraction, const I16& at_origin, const L16& step_x,
                              const L16& step_y, const LaneFormat& format) {
  return (convert<std::int64_t>(at_origin) << fraction) + step_x * convert<std::int64_t>(to.x) +
         step_y * convert<std::int64_t>(to.y) + static_cast<std::int64_t>(format.anchor_bias);
}
/// Limits assumed by fits_split(): offsets below 64 pixels, two products, two steps to tiles and a bias.
HALFPLANE_INLINE bool fits_split(const LaneFormat& format, const Widths& widths) {
  constexpr int kOffset = 6 + 2;
  return format.drop + widths.grid_bits + kOffset < 32 && format.step_drop > 0;
}

/// The plane's value in a tile's precision.
HALFPLANE_INLINE I16 narrowed(const I16& value, const LaneFormat& format) {
  return shift_right_logical(value, format.drop) << format.up;
}
HALFPLANE_INLINE I16 narrowed(const SplitLanes& value, const LaneFormat& format) {
  return (value.upper + (value.lower >> format.drop)) << format.up;
}
HALFPLANE_INLINE I16 narrowed(const L16& value, const LaneFormat& format) {
  return convert<std::int32_t>(shift_right_logical(value, format.drop)) << format.up;
}

/// A gradient in a tile's precision: per pixel.
HALFPLANE_INLINE I16 local_step(const I16& step, const LaneFormat& format) {
  const int drop = format.step_drop;
  return shift_right_logical(step + (1 << (drop - 1)), drop) << format.up;
}
HALFPLANE_INLINE I16 local_step(const SplitLanes& step, const LaneFormat& format) {
  const int drop = format.step_drop;
  return ((step.upper << (format.drop - drop)) + ((step.lower + (1 << (drop - 1))) >> drop)) << format.up;
}
HALFPLANE_INLINE I16 local_step(const L16& step, const LaneFormat& format) {
  return round_shift_lanes(step, format.step_drop) << format.up;
}

/// Gradients of a plane, in x and in y.
template <class Step>
struct Gradients {
  Step x, y;
};
template <class Step>
Gradients(Step, Step) -> Gradients<Step>;  // clang 14 does not deduce it

/// Two corners from the first.
struct TwoCorners {
  I16 ax, ay, bx, by;
};

/// Gradients of a plane, which is `az` and `bz` larger at these corners. `Gradient`: GradientLanes or
/// ExactGradientLanes; `Numerator`: I16, L16 or D16.
template <class Numerator, class Gradient>
HALFPLANE_INLINE auto gradients_by(const I16& az, const I16& bz, const TwoCorners& t, const Gradient& gradient) {
  const auto product = [](const I16& m, const I16& n) HALFPLANE_LAMBDA {
    if constexpr (std::is_same_v<Numerator, I16>)
      return m * n;
    else if constexpr (std::is_same_v<Numerator, L16>)
      return multiply_narrow(convert<std::int64_t>(m), convert<std::int64_t>(n));
    else
      return convert<double>(m) * convert<double>(n);
  };
  return Gradients{gradient(product(az, t.by) - product(bz, t.ay)), gradient(product(t.ax, bz) - product(t.bx, az))};
}

/// The range of codes to which colours of sixteen triangles are clamped, in the target's format: a byte a channel, R
/// lowest.
struct ColorRange {
  I16 low, high;
  std::uint32_t differs;  ///< bytes: 0 where a channel is constant over each triangle

  HALFPLANE_INLINE ColorRange(const SmallCorners& t, bool is_flat) {
    const B64 a = as<B64>(t.a.rgba), b = is_flat ? a : as<B64>(t.b.rgba), c = is_flat ? a : as<B64>(t.c.rgba);
    low = as<I16>(min(min(a, b), c));
    high = as<I16>(max(max(a, b), c));
    differs = static_cast<std::uint32_t>(or_of_lanes(low ^ high));
  }
  /// For consecutive channels: then the clamp alone gives the value.
  [[nodiscard]] HALFPLANE_INLINE bool is_flat(std::size_t channel) const { return (differs >> 8 * channel & 255) == 0; }

  /// Packed colours from centred values after saturated().
  [[nodiscard]] HALFPLANE_INLINE static I16 clamped(const B64& channels, const I16& low, const I16& high) {
    return as<I16>(min(max(channels ^ 0x80, as<B64>(low)), as<B64>(high)));
  }
};

/// Two channels: the halves of each lane.
struct PairCodes {
  I16 at_origin, ac, bc;

  /// Red and green, or blue and alpha.
  HALFPLANE_INLINE PairCodes(const SmallCorners& t, std::size_t pair, bool is_flat) {
    const auto codes = [pair](const SnappedLanes& v) HALFPLANE_LAMBDA { return as<S32>(channel_pair(v.rgba, pair)); };
    const S32 a = codes(t.a), b = is_flat ? a : codes(t.b), c = is_flat ? a : codes(t.c);
    at_origin = as<I16>(is_flat ? a : codes(t.origin));
    ac = as<I16>(b - a);
    bc = as<I16>(c - a);
  }
  /// Half 0 or 1 of a lane.
  HALFPLANE_INLINE static I16 of_half(const I16& pair, std::size_t half) {
    return half == 0 ? pair << 16 >> 16 : pair >> 16;
  }
};

/// Gradients of one half of the pairs.
HALFPLANE_INLINE auto channel_gradients(const SmallCorners& t, const GradientLanes& gradient, const PairCodes& codes,
                                        std::size_t half) {
  const I16 ac = PairCodes::of_half(codes.ac, half), bc = PairCodes::of_half(codes.bc, half);
  return Gradients{gradient(ac * t.by - bc * t.ay), gradient(t.ax * bc - t.bx * ac)};
}
HALFPLANE_INLINE auto channel_gradients(const SmallCorners& t, const NarrowGradientLanes& gradient,
                                        const PairCodes& codes, std::size_t half) {
  const I16 both = half == 0 ? pairs(codes.ac, codes.bc)
                             : shift_right_logical(codes.ac, 16) | (codes.bc & static_cast<std::int32_t>(0xffff0000));
  return Gradients{gradient(multiply_add_pairs(both, pairs(t.by, -t.ay))),
                   gradient(multiply_add_pairs(both, pairs(-t.bx, t.ax)))};
}

/// Whether the short arithmetic, below, is exact for triangles within kMediumTiles.
HALFPLANE_INLINE bool is_short_enough(const Widths& widths, const LaneFormat& depth_format,
                                      const LaneFormat& color_format) {
  const int extent = extent_bits(kMediumPixelBits, widths);
  const AttributeWidths &depth = widths.depth(), &color = widths.color();
  // Binary64 holds quotients of areas, and the products for gradients of depth.
  const bool is_exact = is_exact_division(2 * extent, widths.reciprocal_bits()) && fits_split(depth_format, widths) &&
                        depth.code.bits + extent + depth.reciprocal.bits <= 53 &&
                        depth.code.bits + extent + widths.plane_fraction <= 50;
  // 32 bits hold colours: products with their reciprocal, and planes.
  const bool is_narrow =
      color.code.bits + extent + color.reciprocal_bits() <= 30 && color.plane.bits <= 32 && color_format.step_drop > 0;
  return is_exact && is_narrow;
}

/// How gradients are computed: in short lanes, or in general ones.
struct ShortArithmetic {
  using DepthGradient = ExactGradientLanes;
  using ColorGradient = NarrowGradientLanes;
  using WideNumerator = D16;
  HALFPLANE_INLINE static QuotientLanes quotient(const I16& area, int bits) { return exact_quotient_lanes(area, bits); }
};
struct LongArithmetic {
  using DepthGradient = GradientLanes;
  using ColorGradient = GradientLanes;
  using WideNumerator = L16;
  HALFPLANE_INLINE static QuotientLanes quotient(const I16& area, int bits) { return quotient_lanes(area, bits); }
};

/// The planes of a batch, as functions of its corners.
template <class Arithmetic>
struct SmallPlanes {
  const SmallCorners& corners;
  const Widths& widths;
  QuotientLanes quotient;

  HALFPLANE_INLINE SmallPlanes(const SmallCorners& corners_, const Widths& widths_)
      : corners(corners_),
        widths(widths_),
        quotient(Arithmetic::quotient(corners.area, widths.reciprocal_bits())),
        steep_(std::int32_t{1} << (30 - extent_bits(kMediumPixelBits, widths))) {}

  /// Gradients of depth, in x and in y.
  [[nodiscard]] HALFPLANE_INLINE auto depth_gradients(const LaneFormat& format) const {
    const auto gradient = depth(format);
    const I16 az = corners.b.z - corners.a.z, bz = corners.c.z - corners.a.z;
    const TwoCorners from_a{corners.ax, corners.ay, corners.bx, corners.by};
    return is_any(corners.z_high - corners.z_low >= steep_)
               ? gradients_by<typename Arithmetic::WideNumerator>(az, bz, from_a, gradient)
               : gradients_by<I16>(az, bz, from_a, gradient);
  }
  [[nodiscard]] HALFPLANE_INLINE typename Arithmetic::ColorGradient color() const {
    const auto [reciprocal, k] = factor(widths.color());
    return {reciprocal, k};
  }

 private:
  std::int32_t steep_;  ///< from this difference of depth codes on products need more than 32 bits

  [[nodiscard]] HALFPLANE_INLINE typename Arithmetic::DepthGradient depth(const LaneFormat& format) const {
    const auto [reciprocal, k] = factor(widths.depth());
    if constexpr (std::is_same_v<typename Arithmetic::DepthGradient, ExactGradientLanes>)
      return {reciprocal, k, format.drop};
    else
      return {reciprocal, k};
  }
  /// The reciprocal of the area, with its sign, and the bits that a product with it drops.
  struct Factor {
    I16 reciprocal, k;
  };
  [[nodiscard]] HALFPLANE_INLINE Factor factor(const AttributeWidths& attribute) const {
    const ReciprocalLanes reciprocal(quotient, widths.reciprocal_bits() - attribute.reciprocal_bits());
    return {turned(reciprocal.value, corners.is_turned), reciprocal.shift - widths.plane_fraction};
  }
};

/// A plane at the anchors of a window's tiles.
using Anchors = std::array<I16, SmallBatch::kTiles>;

/// From the first anchor on. `to_tile`: shift from a step per subpixel to one per tile.
template <class Step>
HALFPLANE_INLINE void find_anchors(const Step& first, const Step& step_x, const Step& step_y, int to_tile,
                                   const LaneFormat& format, Anchors& out) {
  const Step aside = step_x << to_tile, lower = first + (step_y << to_tile);
  out[0] = narrowed(first, format);
  out[1] = narrowed(first + aside, format);
  out[2] = narrowed(lower, format);
  out[3] = narrowed(lower + aside, format);
}

template <class Arithmetic, class Samples>
HALFPLANE_INLINE void set_up_small_depth(SmallBatch& batch, const SmallPlanes<Arithmetic>& planes, const FromOrigin& to,
                                         const LaneFormat& format, Samples& samples) {
  const SmallCorners& corners = planes.corners;
  const Widths& widths = planes.widths;
  const auto steps = planes.depth_gradients(format);
  const auto& [step_x, step_y] = steps;
  samples.move_depth(steps, format);
  Anchors at;
  find_anchors(plane_at(to, widths.plane_fraction, corners.origin.z, step_x, step_y, format), step_x, step_y,
               kTileShift + widths.grid_bits, format, at);
  for (std::size_t i = 0; i < SmallBatch::kTiles; ++i) at[i].store(batch.tile[i].depth.data());
  local_step(step_x, format).store(batch.z_step_x.data());
  const I16 local_y = local_step(step_y, format);
  local_y.store(batch.z_step_y.data());
  (local_y * block_rows<I16>).store(batch.z_step_below.data());
  const bool is_narrow = HALFPLANE_ISA <= 256 && widths.depth().code.bits <= 16;  // for NarrowTest
  const auto limit = [&](const I16& z)
                         HALFPLANE_LAMBDA { return is_narrow ? doubled(z - format.bias) : z - format.bias; };
  limit(corners.z_low).store(batch.z_low.data());
  limit(corners.z_high).store(batch.z_high.data());
}

/// A channel of sixteen triangles, or two of them in the halves of each lane.
struct SmallChannels {
  Anchors at;
  I16 step_x, step_y;
};

/// Red and green, blue and alpha.
template <class Arithmetic, class Samples>
HALFPLANE_INLINE void find_small_colors(const SmallPlanes<Arithmetic>& planes, const FromOrigin& to,
                                        const LaneFormat& format, bool is_flat, const ColorRange& range,
                                        Samples& samples, std::array<SmallChannels, 2>& colors) {
  const Widths& widths = planes.widths;
  const auto gradient = planes.color();
  for (std::size_t p = 0; p < 2; ++p) {
    const PairCodes codes(planes.corners, p, is_flat);
    std::array<SmallChannels, 2> halves;
    for (std::size_t h = 0; h < 2; ++h) {
      SmallChannels& half = halves[h];
      if (range.is_flat(2 * p + h)) {
        for (I16& at : half.at) at = I16(0);
        half.step_x = half.step_y = I16(0);
        samples.keep_channel(2 * p + h);
        continue;
      }
      const auto of_half = [h](const I16& pair) HALFPLANE_LAMBDA { return PairCodes::of_half(pair, h); };
      const auto steps = channel_gradients(planes.corners, gradient, codes, h);
      const auto& [step_x, step_y] = steps;
      samples.move_channel(2 * p + h, steps, format);
      find_anchors(plane_at(to, widths.plane_fraction, of_half(codes.at_origin), step_x, step_y, format), step_x,
                   step_y, kTileShift + widths.grid_bits, format, half.at);
      half.step_x = local_step(step_x, format);
      half.step_y = local_step(step_y, format);
    }
    SmallChannels& pair = colors[p];
    for (std::size_t i = 0; i < SmallBatch::kTiles; ++i) pair.at[i] = pairs(halves[0].at[i], halves[1].at[i]);
    pair.step_x = pairs(halves[0].step_x, halves[1].step_x);
    pair.step_y = pairs(halves[0].step_y, halves[1].step_y);
  }
}

template <class Arithmetic, class Samples>
HALFPLANE_INLINE void set_up_small_colors(SmallBatch& batch, const SmallPlanes<Arithmetic>& planes,
                                          const FromOrigin& to, const LaneFormat& format, bool is_flat,
                                          Samples& samples) {
  const ColorRange range(planes.corners, is_flat);
  range.low.store(batch.c_low.data());
  range.high.store(batch.c_high.data());
  std::array<SmallChannels, 2> colors;
  find_small_colors(planes, to, format, is_flat, range, samples, colors);
  for (std::size_t i = 0; i < SmallBatch::kTiles; ++i)
    store_interleaved(colors[0].at[i], colors[1].at[i], batch.tile[i].color.data());
  store_interleaved(colors[0].step_x, colors[1].step_x, batch.c_step_x.data());
  store_interleaved(colors[0].step_y, colors[1].step_y, batch.c_step_y.data());
  samples.join_channels();
}

/// Sets up the constants of a loaded batch. Formats: centred.
template <class Arithmetic, class Samples>
HALFPLANE_NOINLINE void set_up_small(SmallBatch& batch, const Slice& slice, const Widths& widths,
                                     const LaneFormat& depth_format, const LaneFormat& color_format, int first_x,
                                     int first_y, Samples& samples) {
  const SmallCorners corners = small_corners(batch.corner, batch.live, slice);
  set_up_small_edges(batch, corners, widths.grid_bits, are_short_edges(widths), first_x, first_y, samples);
  find_places(batch);
  const SmallPlanes<Arithmetic> planes(corners, widths);
  const FromOrigin to = anchor_from_origin(corners, I16::load(batch.left.data()), I16::load(batch.top.data()),
                                           widths.grid_bits, first_x, first_y);
  set_up_small_depth(batch, planes, to, depth_format, samples);
  // Colours of surfaces are deferred until they are visible.
  if (slice.state.color_write && !slice.state.has_surface)
    set_up_small_colors(batch, planes, to, color_format, slice.state.is_flat, samples);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
