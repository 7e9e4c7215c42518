// Setup of small and medium triangles with a texture or colours over w, sixteen at a time, a triangle a lane, once a pixel
// of one of them is shaded. The sixteen of a batch are a group, each one a piece.
#pragma once

#include "bin.inl"
#include "codes_over_w.inl"
#include "small_batch.inl"
#include "small_setup.inl"
#include "texture.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Stores four numbers of each piece of a group, a piece a lane.
HALFPLANE_INLINE void store_row(const Columns& from, PieceRow& to) {
#if HALFPLANE_ISA == 512
  from.first.store(to.number.data());
  from.second.store(to.number.data() + 16);
  from.third.store(to.number.data() + 32);
  from.fourth.store(to.number.data() + 48);
#else
  store_rows(from, to.number.data(), 4 * sizeof to.number[0]);
#endif
}

/// setup_lod(). Returns the lanes that it cannot set up, a bit each.
HALFPLANE_NOINLINE std::uint32_t set_up_levels(const SmallCorners& corners, const FirstCorner& first, const QLanes& q,
                                               const OfCorners<D16>& u, const OfCorners<D16>& v,
                                               const PerspectiveFormat& format, int grid_bits, PieceLevels& to) {
  const L16 first_is_b = convert<std::int64_t>(first.is_b), first_is_c = convert<std::int64_t>(first.is_c),
            is_turned = convert<std::int64_t>(corners.is_turned);
  // Corners in canonical order, the order in which sums are rounded.
  const auto in_order = [&](const OfCorners<D16>& of, D16* ordered) HALFPLANE_LAMBDA {
    ordered[0] = select(first_is_c, of.c, select(first_is_b, of.b, of.a));
    const D16 next = select(first_is_c, of.a, select(first_is_b, of.c, of.b)),
              last = select(first_is_c, of.b, select(first_is_b, of.a, of.c));
    ordered[1] = select(is_turned, last, next);
    ordered[2] = select(is_turned, next, last);
  };
  const auto numbers_of = [&](const I16& a, const I16& b, const I16& c, D16* ordered) HALFPLANE_LAMBDA {
    in_order(OfCorners<D16>{convert<double>(a), convert<double>(b), convert<double>(c)}, ordered);
  };
  D16 codes[3], texels[2][3], x[3], y[3];
  in_order(q.number, codes);
  in_order(u, texels[0]);
  in_order(v, texels[1]);
  numbers_of(corners.a.x, corners.b.x, corners.c.x, x);
  numbers_of(corners.a.y, corners.b.y, corners.c.y, y);
  D16 slope[2], row[2], column[2], largest(0.0);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    D16 part[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      part[k] = codes[i] * codes[j] * (texels[axis][i] - texels[axis][j]);
    }
    slope[axis] = part[0] + part[1] + part[2];
    const auto sum = [&part](const D16* at, std::size_t i) HALFPLANE_LAMBDA {
      return part[0] * (at[i] - at[0]) + part[1] * (at[i] - at[1]) + part[2] * (at[i] - at[2]);
    };
    row[axis] = sum(y, 0);
    column[axis] = sum(x, 0);
    for (std::size_t i = 0; i < 3; ++i)
      largest =
          max(largest, max(magnitude(i == 0 ? row[axis] : sum(y, i)), magnitude(i == 0 ? column[axis] : sum(x, i))));
  }
  const D16 to_pixels =
      D16(static_cast<double>(std::int64_t{1} << grid_bits)) / convert<double>(max(corners.area, I16(1)));
  const I16 is_flat = convert<std::int32_t>(largest == 0.0);
  const I16 up = 30 + kDoubleBias - exponent_field(largest * to_pixels);  // g
  const D16 scale = to_pixels * power_of_field(select(is_flat, I16(0), up) + kDoubleBias);
  const auto residue = [](const D16& number) HALFPLANE_LAMBDA {
    const D16 whole = floor(number + 0.5), rest = whole - floor(whole * 0x1p-32) * 0x1p32;
    return convert<std::int32_t>(rest - 0x1p31) ^ static_cast<std::int32_t>(0x80000000U);
  };
  const double pixel_size = static_cast<double>(std::int64_t{1} << grid_bits);
  I16 at_zero[4], step[4];
  const auto find_line = [&](std::size_t line, const D16& value, const D16& of_slope, const D16& position)
                             HALFPLANE_LAMBDA {
                               const D16 pixel = floor(position * (1 / pixel_size));
                               const D16 centre = (pixel + 0.5) * pixel_size;
                               step[line] = residue(of_slope * scale * pixel_size);
                               at_zero[line] = residue((value + of_slope * (centre - position)) * scale) -
                                               convert<std::int32_t>(pixel) * step[line];
                             };
  for (std::size_t axis = 0; axis < 2; ++axis) {
    find_line(axis, row[axis], slope[axis], y[0]);
    find_line(2 + axis, column[axis], slope[axis], x[0]);
  }
  const I16 offset = select(is_flat, I16(-64), 2 * format.guard_bits - up) << kLodFraction;
  store_row({at_zero[0], at_zero[1], at_zero[2], at_zero[3]}, to.at_zero);
  store_row({step[0], step[1], step[2], step[3]}, to.step);
  store_row({offset, offset, offset, offset}, to.offset);
  return bits_of(~is_flat & convert<std::int32_t>(largest < 0x1p-500));
}

/// GradientLanes where products exceed 64 bits, for numerators of kMostNumeratorBits and reciprocals of 0 to 2^31:
/// the bits of a numerator from kSplit on and those below them are multiplied apart, and gradients wrap in 64 bits.
struct WideGradientLanes {
  static constexpr int kSplit = kMostNumeratorBits - 30;
  L16 reciprocal, half;
  L16 upper_left, lower_right, lower_left, right;  ///< shifts of the two products, and of their sum
  L16 lowered;

  HALFPLANE_INLINE WideGradientLanes(const I16& reciprocal_, const I16& k)
      : reciprocal(convert<std::int64_t>(reciprocal_)),
        half(shift_right_logical(L16(1) << convert<std::int64_t>(max(k, I16(0))), 1)),
        upper_left(convert<std::int64_t>(max(kSplit - k, I16(0)))),
        lower_right(convert<std::int64_t>(min(max(k, I16(0)), I16(kSplit)))),
        lower_left(convert<std::int64_t>(max(-k, I16(0)))),
        right(convert<std::int64_t>(max(k - kSplit, I16(0)))),
        lowered(shift_right_logical(L16(GradientLanes::kRaise), right)) {}

  HALFPLANE_INLINE L16 operator()(const L16& numerator) const {
    const L16 upper = multiply_narrow(numerator >> kSplit, reciprocal) << upper_left,
              lower = multiply_narrow(numerator & ((1 << kSplit) - 1), reciprocal) + half;
    const L16 sum = upper + (shift_right_logical(lower, lower_right) << lower_left);
    return shift_right_logical(sum + GradientLanes::kRaise, right) - lowered;
  }
};

/// Planes over w of sixteen triangles, at the anchors of their windows' tiles. `Gradient`: WideGradientLanes, or
/// ExactGradientLanes where are_exact_planes().
template <class Gradient>
struct PiecePlanes {
  const Widths& widths;
  int guard_bits;
  TwoCorners corner;              ///< from the base, with the sign of the area
  FromOrigin to;                  ///< from the base to the anchor of the tile of even column and row
  I16 is_odd_column, is_odd_row;  ///< masks: column and row of the window's first tile
  const Gradient& gradient;

  /// Plane in lanes, with `up` bits below its values.
  struct Plane {
    Anchors at;  ///< at the anchors of PieceConstants::tile
    I16 step_x, step_y;
  };

  HALFPLANE_INLINE Plane operator()(const OfCorners<I16>& code, int up) const {
    using Numerator = std::conditional_t<std::is_same_v<Gradient, ExactGradientLanes>, D16, L16>;
    const int to_tile = kTileShift + widths.grid_bits;
    const LaneFormat format(widths.plane_fraction - guard_bits, up, widths.grid_bits);
    const auto steps = gradients_by<Numerator>(code.b - code.a, code.c - code.a, corner, gradient);
    const auto& [step_x, step_y] = steps;
    const auto first = plane_at(to, widths.plane_fraction, code.a, step_x, step_y, format);
    const auto aside = turned(step_x << to_tile, is_odd_column), lower = first + turned(step_y << to_tile, is_odd_row);
    return {{narrowed(first, format), narrowed(first + aside, format), narrowed(lower, format),
             narrowed(lower + aside, format)},
            local_step(step_x, format),
            local_step(step_y, format)};
  }
};

/// Whether ExactGradientLanes and SplitLanes hold planes over w. The area between three codes within a range and three
/// corners is below the product of both; half a unit is added to its quotients, which are below 2^51.
HALFPLANE_INLINE bool are_exact_planes(const PerspectiveFormat& format, const Widths& widths, const I16& area,
                                       std::uint32_t live) {
  const int numerator =
      std::max({format.q_bits, format.coordinate.bits + 1, format.color.bits}) + extent_bits(kMediumPixelBits, widths);
  const int area_bits = numerator + widths.plane_fraction - 51;  // that every area must have
  return numerator + format.reciprocal_bits < 53 && area_bits < 16 &&
         fits_split(LaneFormat(widths.plane_fraction - format.guard_bits, 0, widths.grid_bits), widths) &&
         (bits_of((area >> std::max(area_bits, 0)) == 0) & live) == 0;
}

/// Division of P: LaneAttribute.
struct PieceScale {
  I16 narrow;             ///< without kNarrowLess
  I16 drop;               ///< minus 1
  I16 may_gain, is_tame;  ///< masks
  static constexpr std::int32_t kNarrowLess = 128;

  HALFPLANE_INLINE PieceScale(const OverWLanes& of, const OfCorners<D16>& q, const PerspectiveFormat& all,
                              const OverWFormat& format, const LaneOverW& lanes) {
    const I16 to_narrow = of.reach - of.exponent + (1 - format.narrow_bits);
    narrow = to_narrow + (lanes.up - 1 - kFloatBias + kNarrowLess);
    drop = (all.mantissa_bits + format.narrow_bits - 2 - format.fraction_bits - lanes.split) - of.reach;
    const D16 least = least_of(q), most = max(max(q.a, q.b), q.c);
    const I16 smallest = exponent_field(least) - (kDoubleBias - all.guard_bits + 1),
              largest = exponent_field(most) - (kDoubleBias - all.guard_bits - 1);
    constexpr int kNarrowBits = 12, kReciprocalBits = 14, kCodes = 11;  // SurfaceConstants::is_never_held()
    const bool may_be = format.narrow_bits >= kNarrowBits && all.reciprocal_bits >= kReciprocalBits;
    const std::int32_t enough = std::int32_t{1} << (kCodes + all.q_bits - format.bits);
    may_gain = smallest + to_narrow < 1;
    is_tame =
        may_be ? ~may_gain & (largest + to_narrow <= 32 - lanes.up) & (convert<std::int32_t>(least) >= enough) : I16(0);
  }
};

/// Byte `at` of each lane.
HALFPLANE_INLINE I16 byte_of(const I16& lanes, std::size_t at) { return (lanes >> static_cast<int>(8 * at)) & 255; }

/// Colours over w of a group. Returns the lanes that it cannot set up, a bit each.
template <class Planes>
HALFPLANE_NOINLINE std::uint32_t set_up_colors_over_w(const SmallCorners& corners, bool is_flat,
                                                      const PieceOrder& order, const QLanes& q, const Planes& over_w,
                                                      std::uint32_t live, SurfaceStyle& style, PieceColors& to) {
  const OverWFormat& format = style.format.color;
  const ColorRange range(corners, is_flat);
  I16 narrow(0), drop(0);
  std::uint32_t alone = 0;
  const auto plane_of = [&](std::size_t c) HALFPLANE_LAMBDA {
    const auto code = [&](const SnappedLanes& corner)
                          HALFPLANE_LAMBDA { return convert<double>(byte_of(corner.rgba, c)); };
    const D16 first = code(corners.a);
    const OverWLanes along({first, is_flat ? first : code(corners.b), is_flat ? first : code(corners.c)}, q, format);
    const PieceScale scale(along, q.number, style.format, format, style.of_color);
    alone |= bits_of(scale.drop < 0) & live;
    style.may_gain = style.may_gain || (bits_of(scale.may_gain) & live) != 0;
    narrow = narrow | ((scale.narrow & 255) << static_cast<int>(8 * c));
    drop = drop | ((scale.drop & 255) << static_cast<int>(8 * c));
    return over_w(order.turned_to_base(along.p.a, along.p.b, along.p.c), style.of_color.up);
  };
  const auto red = plane_of(0), green = plane_of(1), blue = plane_of(2), alpha = plane_of(3);
  store_row({red.step_x, green.step_x, blue.step_x, alpha.step_x}, to.step_x);
  store_row({red.step_y, green.step_y, blue.step_y, alpha.step_y}, to.step_y);
  store_row({narrow, drop, range.low, range.high}, to.scale);
  for (std::size_t i = 0; i < 4; ++i) store_row({red.at[i], green.at[i], blue.at[i], alpha.at[i]}, to.tile[i]);
  return alone;
}

/// Coordinates on the texture of a group.
struct PieceCoordinates {
  OfCorners<I16> u, v;  ///< P
  I16 reference_u, reference_v;
  I16 drops;  ///< LaneAttribute::narrow of both and drop of both, a byte each

  HALFPLANE_INLINE PieceCoordinates() = default;
  /// Adds the lanes that it cannot set up to `alone`.
  HALFPLANE_INLINE PieceCoordinates(const QLanes& q, const OfCorners<D16>& at_u, const OfCorners<D16>& at_v,
                                    std::uint32_t live, std::uint32_t& alone, SurfaceStyle& style) {
    const OverWLanes along_u(at_u, q, style.format.coordinate), along_v(at_v, q, style.format.coordinate);
    const auto scale_of = [&](const OverWLanes& along) HALFPLANE_LAMBDA {
      return PieceScale(along, q.number, style.format, style.format.coordinate, style.of_coordinate);
    };
    const PieceScale scale_u = scale_of(along_u), scale_v = scale_of(along_v);
    alone |= bits_of((scale_u.drop < 0) | (scale_v.drop < 0));
    style.is_tame = style.is_tame && (~(bits_of(scale_u.is_tame & scale_v.is_tame) | alone) & live) == 0;
    const auto reference = [&style](const OverWLanes& along, std::size_t axis) HALFPLANE_LAMBDA {
      const I16 whole = convert<std::int32_t>(along.reference);
      const TextureWrap wrap = style.texture.wrap[axis];
      constexpr std::int32_t kFar = 1 << (kMaxReach + 2);
      const std::int32_t last = style.texture.last[axis];
      return (wrap == TextureWrap::clamp ? min(max(whole, I16(-kFar)), I16(kFar))
                                         : whole & (wrap == TextureWrap::mirror ? 2 * last + 1 : last))
             << kTexelFraction;
    };
    const auto byte = [](const I16& value, int at) HALFPLANE_LAMBDA { return (value & 255) << at; };
    const auto take = [](const OfCorners<I16>& from, OfCorners<I16>& to) HALFPLANE_LAMBDA {
      to.a = from.a;
      to.b = from.b;
      to.c = from.c;
    };
    take(along_u.p, u);
    take(along_v.p, v);
    reference_u = reference(along_u, 0);
    reference_v = reference(along_v, 1);
    drops = byte(scale_u.narrow, 0) | byte(scale_v.narrow, 8) | byte(scale_u.drop, 16) | (scale_v.drop << 24);
  }
};

/// Constants of a group. Triangles that lanes cannot set up become PieceGroup::alone.
template <class Arithmetic>
HALFPLANE_NOINLINE void set_up_pieces(Bin& bin, std::size_t number) {
  BinMemory& memory = bin.memory;
  PieceGroup& group = memory.groups[number];
  PieceConstants& to = memory.constants[number];
  SurfaceStyle& style = memory.styles[group.style];
  const Widths& widths = bin.widths;
  const Slice& slice = *group.slice;
  const auto* const vertices = reinterpret_cast<const char*>(slice.surface);
  static_assert(sizeof(SurfaceRow) == 2 * sizeof(VertexRow));  // `corner` counts in units of SurfaceRow
  for (const SmallBatch::Lane& corner : group.corner)          // prefetched for the code below
    for (const std::int32_t place : corner)
      __builtin_prefetch(vertices + std::size_t{2} * static_cast<std::uint32_t>(place));
  const SmallCorners corners = small_corners(group.corner, group.live, slice);
  const SmallPlanes<Arithmetic> planes(corners, widths);
  const I16 left = I16::load(group.left.data()), top = I16::load(group.top.data());
  const FromOrigin from_origin = anchor_from_origin(corners, left, top, widths.grid_bits, bin.first_x, bin.first_y);
  const auto is_odd = [](const I16& pixel) HALFPLANE_LAMBDA { return -((pixel >> kTileShift) & 1); };
  const I16 is_odd_column = is_odd(left), is_odd_row = is_odd(top);
  if (!style.is_color_over_w) {
    const ColorRange range(corners, slice.state.is_flat);
    std::array<SmallChannels, 2> colors;
    OnlyCentres centres;
    find_small_colors(planes, from_origin, bin.centred_color, slice.state.is_flat, range, centres, colors);
    store_row({colors[0].step_x, colors[1].step_x, colors[0].step_y, colors[1].step_y}, to.color);
    I16 at[2][4];
    for (std::size_t p = 0; p < 2; ++p) {
      const Anchors& from = colors[p].at;
      const I16 even_column[2] = {select(is_odd_column, from[1], from[0]), select(is_odd_column, from[3], from[2])},
                odd_column[2] = {select(is_odd_column, from[0], from[1]), select(is_odd_column, from[2], from[3])};
      at[p][0] = select(is_odd_row, even_column[1], even_column[0]);
      at[p][1] = select(is_odd_row, odd_column[1], odd_column[0]);
      at[p][2] = select(is_odd_row, even_column[0], even_column[1]);
      at[p][3] = select(is_odd_row, odd_column[0], odd_column[1]);
    }
    for (std::size_t i = 0; i < 4; ++i) store_row({at[0][i], at[1][i], range.low, range.high}, to.tile[i].colors);
  }

  const bool has_texture = style.sampling != Sampling::none;
  OfCorners<D16> w, inverse, u, v;
  if (!has_texture) u.a = u.b = u.c = v.a = v.b = v.c = D16(0.0);
  std::uint32_t alone = 0;
  {
    const auto fetch = [&](std::size_t k, D16& its_w, D16& its_inverse, D16& its_u, D16& its_v) HALFPLANE_LAMBDA {
      const Places place(I16::load(group.corner[k].data()) << 1);
      static_assert(offsetof(SurfaceRow, w) == 0 && offsetof(SurfaceRow, u) == 8 && offsetof(SurfaceRow, v) == 16 &&
                    offsetof(SurfaceRow, inverse) == 24);
      const DoubleColumns rows =
          turned_doubles([&](int i) HALFPLANE_LAMBDA -> const void* { return vertices + place[i]; });
      its_w = style.is_affine ? D16(1.0) : rows.first;
      its_inverse = style.is_affine ? D16(1.0) : rows.fourth;
      if (!has_texture) return;
      its_u = rows.second * style.size[0];
      its_v = rows.third * style.size[1];
    };
    fetch(0, w.a, inverse.a, u.a, v.a);
    fetch(1, w.b, inverse.b, u.b, v.b);
    fetch(2, w.c, inverse.c, u.c, v.c);
    const L16 is_usual = (max(largest_magnitude(u), largest_magnitude(v)) < D16(0x1p30)) &
                         (largest_magnitude(w) < D16(0x1p500)) & (least_of(w) > D16(0x1p-500));
    alone = ~bits_of(convert<std::int32_t>(is_usual)) & 0xffff;
  }
  const QLanes q(w, inverse, style.format.q_bits);
  const PieceCoordinates coordinates =
      has_texture ? PieceCoordinates(q, u, v, group.live, alone, style) : PieceCoordinates();

  const FirstCorner first(corners);
  if (style.sampling == Sampling::any)
    alone |= set_up_levels(corners, first, q, u, v, style.format, widths.grid_bits, memory.levels[number]);
  const PieceOrder order(first.is_b, first.is_c, corners.is_turned, q.code);
  const auto x = order.turned_to_base(corners.a.x, corners.b.x, corners.c.x),
             y = order.turned_to_base(corners.a.y, corners.b.y, corners.c.y);
  const int tile = kTileSize << widths.grid_bits;
  const int bits = style.format.reciprocal_bits, less = widths.reciprocal_bits() - bits;
  I16 reciprocal, shift;
  const auto take = [&](const QuotientLanes& quotient, int dropped) HALFPLANE_LAMBDA {
    const ReciprocalLanes of(quotient, dropped);
    reciprocal = of.value;
    shift = of.shift - widths.plane_fraction;
  };
  if (less >= 0)
    take(planes.quotient, less);
  else if (is_exact_division(2 * extent_bits(kMediumPixelBits, widths), bits))
    take(exact_quotient_lanes(corners.area, bits), 0);
  else
    take(quotient_lanes(corners.area, bits), 0);
  const auto turn = [&order](const OfCorners<I16>& of)
                        HALFPLANE_LAMBDA { return order.turned_to_base(of.a, of.b, of.c); };
  const auto side = [&corners](const I16& to_corner, const I16& from)
                        HALFPLANE_LAMBDA { return turned(to_corner - from, corners.is_turned); };
  const auto store_planes = [&](const auto& gradient) HALFPLANE_LAMBDA {
    const PiecePlanes<std::remove_cvref_t<decltype(gradient)>> over_w{
        widths,
        style.format.guard_bits,
        {side(x.b, x.a), side(y.b, y.a), side(x.c, x.a), side(y.c, y.a)},
        {from_origin.x + corners.origin.x - x.a + (is_odd_column & tile),
         from_origin.y + corners.origin.y - y.a + (is_odd_row & tile)},
        is_odd_column,
        is_odd_row,
        gradient};
    const auto of_q = over_w(turn(q.code), style.division.up);
    if (has_texture) {
      const auto of_u = over_w(turn(coordinates.u), style.of_coordinate.up),
                 of_v = over_w(turn(coordinates.v), style.of_coordinate.up);
      store_row({of_q.step_x, of_u.step_x, of_v.step_x, coordinates.drops}, to.step_x);
      store_row({of_q.step_y, of_u.step_y, of_v.step_y, coordinates.reference_u}, to.step_y);
      for (std::size_t i = 0; i < 4; ++i)
        store_row({of_q.at[i], of_u.at[i], of_v.at[i], coordinates.reference_v}, to.tile[i].coordinates);
    } else {
      const I16 none(0);
      store_row({of_q.step_x, none, none, none}, to.step_x);
      store_row({of_q.step_y, none, none, none}, to.step_y);
      for (std::size_t i = 0; i < 4; ++i) store_row({of_q.at[i], none, none, none}, to.tile[i].coordinates);
    }
    if (style.is_color_over_w)
      alone |= set_up_colors_over_w(corners, slice.state.is_flat, order, q, over_w, group.live, style,
                                    memory.colors[number]);
  };
  if (are_exact_planes(style.format, widths, corners.area, group.live))
    store_planes(ExactGradientLanes(reciprocal, shift, widths.plane_fraction - style.format.guard_bits));
  else
    store_planes(WideGradientLanes(reciprocal, shift));
  group.alone = alone & group.live;
  group.is_set_up = true;
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
