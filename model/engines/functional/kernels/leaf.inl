// The leaf arithmetic of the stages, in lanes: reciprocal, gradient, rounding, decode, pack. Each exists once.
//
// These are not the stages' own templates: GCC compiles a template for the instruction set in force where it is
// written, not where it is used, so that a shared one would take these lanes apart (ADR 15). The tests of the engine
// keep both equal.
#pragma once

#include "lane_moves.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// The fill rule: a sample on an edge belongs to the triangle if the edge is a left or a top edge. A mask.
template <class Lanes>
HALFPLANE_LEAF auto is_top_left(const Lanes& dx, const Lanes& dy) {
  return (dy < 0) | ((dy == 0) & (dx > 0));
}

/// Cross product of two vectors: twice the area between them, and the side of an edge on which a point lies.
template <class Lanes>
HALFPLANE_LEAF Lanes cross(const Lanes& ax, const Lanes& ay, const Lanes& bx, const Lanes& by) {
  return ax * by - ay * bx;
}

HALFPLANE_LEAF I16 magnitude(const I16& v) { return max(v, -v); }

/// -v where the mask is set.
HALFPLANE_LEAF I16 turned(const I16& v, const I16& mask) { return (v ^ mask) - mask; }

HALFPLANE_LEAF L16 turned(const L16& v, const I16& mask) {
  const auto wide = convert<std::int64_t>(mask);
  return (v ^ wide) - wide;
}

/// How the values of a tile are held and read: in the upper bits of a lane, so that they wrap by overflow.
struct LaneFormat {
  int drop;       ///< from a plane's value at the anchor to a tile's
  int up;         ///< from a tile's value to a lane
  int down;       ///< from a lane to a code plus `bias`
  int step_drop;  ///< from a plane's step to a step of a pixel in a tile
  std::int32_t bias;
  std::uint64_t anchor_bias;
  std::uint64_t to_centred;  ///< added to the value: then an arithmetic shift by `down` gives the code minus `bias`

  /// `lane_bits`: bits of a lane.
  LaneFormat(const AttributeWidths& attribute, int lane_bits, const Widths& widths) {
    const int guard_bits = attribute.guard_bits();
    drop = widths.plane_fraction - guard_bits;
    up = lane_bits - attribute.local.bits;
    down = up + guard_bits;
    step_drop = drop - widths.grid_bits;
    bias = std::int32_t{1} << (attribute.code.bits - 1);
    anchor_bias = plane_bias(attribute, widths);
    to_centred = std::uint64_t{1} << (attribute.code.bits + widths.plane_fraction);
  }

  /// Without a bias, of signed planes.
  LaneFormat(int drop_, int up_, int grid_bits)
      : drop(drop_),
        up(up_),
        down(0),
        step_drop(drop - grid_bits),
        bias(0),
        anchor_bias(std::uint64_t{1} << (drop - 1)),
        to_centred(0) {}

  /// With centred anchors.
  [[nodiscard]] LaneFormat centred() const {
    LaneFormat format = *this;
    format.anchor_bias += to_centred;
    return format;
  }
};

/// A plane over the pixels of a block, row after row, from its steps and its value at `first`. `column`, `row`: of the
/// pixels, with as many lanes for each pixel as there are planes. `below`: step_y times block_rows<Lanes>.
template <class Lanes>
constexpr int block_rows = 4 / Lanes::kParts;  ///< in a register
template <class Lanes>
HALFPLANE_LEAF Lanes block_plane(const Lanes& column, const Lanes& row, const Lanes& step_x, const Lanes& step_y,
                                 const Lanes& below, const Lanes& first) {
  Lanes plane;
  plane.part[0] = column.part[0] * step_x.part[0] + row.part[0] * step_y.part[0] + first.part[0];
  HALFPLANE_EACH_PART(Lanes::kParts - 1, i, plane.part[i + 1] = plane.part[i] + below.part[0])
  return plane;
}

/// Two channels in the halves of a lane: red and blue, green and alpha.
using ChannelPairs = std::array<std::int32_t, 2>;

/// Adds the halves separately.
HALFPLANE_LEAF std::int32_t sum_of_pairs(std::int32_t a, std::int32_t b) {
  const auto first = static_cast<std::uint32_t>(a), second = static_cast<std::uint32_t>(b);
  return static_cast<std::int32_t>(((first + second) & 0xffff) | ((first & 0xffff0000) + (second & 0xffff0000)));
}

/// The codes of values in lanes, clamped to the range of the vertices.
HALFPLANE_LEAF I16 decode(const I16& value, const LaneFormat& format, const I16& low, const I16& high) {
  return min(max(shift_right_logical(value, format.down) - format.bias, low), high);
}

[[nodiscard]] HALFPLANE_LEAF I16 color_codes(const S32& value, const I16& low, const I16& high,
                                             const LaneFormat& format) {
  const S32 code = shift_right_logical(value, format.down) - static_cast<std::int16_t>(format.bias);
  return as<I16>(min(max(code, as<S32>(low)), as<S32>(high)));
}

/// Codes of 8 bits, red with blue and green with alpha, in the target's format.
[[nodiscard]] HALFPLANE_LEAF I16 packed(const I16& red_blue, const I16& green_alpha, ColorFormat format) {
  if (format == ColorFormat::rgba8888) return red_blue | green_alpha << 8;
  // 16 bits suffice: 255 * 253 + 1014 < 2^16.
  const auto rounded = [](const I16& codes, std::int16_t factor, std::int16_t addend, int drop) HALFPLANE_LAMBDA {
    return as<I16>(shift_right_logical(as<S32>(codes) * factor + addend, drop));
  };
  return multiply_add_pairs(rounded(red_blue, 249, 1014, 11), I16(1 << 16 | 1 << 11)) |
         multiply_add_pairs(rounded(green_alpha, 253, 505, 10), I16(1 << 5));
}
/// R lowest, A highest.
[[nodiscard]] HALFPLANE_LEAF I16 packed(const I16& rgba, ColorFormat format) {
  return packed(rgba & 0xff00ff, shift_right_logical(rgba, 8) & 0xff00ff, format);
}

/// How a draw's colours are stored.
struct Packing {
  ColorFormat format;
  bool dithers;  ///< rgb565 alone
};
inline constexpr Packing kUnpacked{ColorFormat::rgba8888, false};

/// dither_threshold() in both halves. `place`: of pixels in a bin's memory, whose lowest bits are column and row in a
/// block; a block has the side of the matrix.
HALFPLANE_LEAF S32 thresholds_at(const I16& place) {
  const I16 across = place ^ shift_right_logical(place, 2);  // x ^ y
  const I16 bayer = ((across & 1) << 3) | (place & 4) | (across & 2) | (shift_right_logical(place, 3) & 1),
            threshold = bayer ^ 15;
  return as<S32>(threshold | (threshold << 16));
}
/// Of the pixels of a block.
HALFPLANE_LEAF S32 block_thresholds() {
  return as<S32>(I16::of([](int i) {
    const auto t = static_cast<std::int32_t>(dither_threshold(i % 4, i / 4));
    return t | t << 16;
  }));
}

/// Colours in a draw's packing; the last: thresholds of the pixels.
[[nodiscard]] HALFPLANE_LEAF I16 packed(const I16& red_blue, const I16& green_alpha, const Packing& to,
                                        const S32& threshold) {
  if (!to.dithers) return packed(red_blue, green_alpha, to.format);
  const auto rounded = [&threshold](const I16& codes, std::int16_t factor, int drop) HALFPLANE_LAMBDA {
    const S32 at_threshold = (threshold << (drop - 4)) + static_cast<std::int16_t>(1 << (drop - 5));
    return as<I16>(shift_right_logical(as<S32>(codes) * factor + at_threshold, drop));
  };
  return multiply_add_pairs(rounded(red_blue, 249, 11), I16(1 << 16 | 1 << 11)) |
         multiply_add_pairs(rounded(green_alpha, 253, 10), I16(1 << 5));
}
/// R lowest, A highest; of pixels at these places.
[[nodiscard]] HALFPLANE_LEAF I16 packed_at(const I16& place, const I16& rgba, const Packing& to) {
  if (to.format == ColorFormat::rgba8888) return rgba;
  if (!to.dithers) return packed(rgba, to.format);
  return packed(rgba & 0xff00ff, shift_right_logical(rgba, 8) & 0xff00ff, to, thresholds_at(place));
}
/// The same for the pixels of a block.
[[nodiscard]] HALFPLANE_LEAF I16 packed(const I16& red_blue, const I16& green_alpha, const Packing& to) {
  return packed(red_blue, green_alpha, to, block_thresholds());
}

/// area_quotient() by a division in binary64, corrected by its remainder: exact.
HALFPLANE_LEAF AreaQuotient fast_area_quotient(std::int64_t area, int significant_bits) {
  const int shift = 63 - std::countl_zero(static_cast<std::uint64_t>(area)) + significant_bits;
  double power;
  const std::uint64_t bits = static_cast<std::uint64_t>(1023 + shift + 1) << 52;
  std::memcpy(&power, &bits, sizeof power);
  std::int64_t quotient = static_cast<std::int64_t>(power / static_cast<double>(area));
  const std::uint64_t numerator =
      shift + 1 < 64 ? std::uint64_t{2} << shift : 0;  // modulo 2^64: the remainder is small
  const auto remainder =
      static_cast<std::int64_t>(numerator - static_cast<std::uint64_t>(quotient) * static_cast<std::uint64_t>(area));
  quotient += remainder < 0 ? -1 : remainder >= area ? 1 : 0;
  return {static_cast<std::uint64_t>(quotient), shift};
}
/// Sixteen quotients, and shifts.
struct QuotientLanes {
  I16 value, shift;
};
/// Whether binary64 distinguishes all quotients of areas below 2^`area_bits`: its division is exact when rounded down.
[[nodiscard]] constexpr bool is_exact_division(int area_bits, int significant_bits) {
  return area_bits + significant_bits + 2 <= 52;
}
HALFPLANE_LEAF QuotientLanes exact_quotient_lanes(const I16& area, int significant_bits) {
  const D16 divisor = convert<double>(max(area, I16(1)));
  const L16 exponent = as<L16>(divisor) & (std::int64_t{0x7ff} << 52);  // of 2^m
  const auto power = as<D16>(exponent + (static_cast<std::int64_t>(significant_bits + 1) << 52));
  return {convert<std::int32_t>(power / divisor), (upper_halves(exponent) >> 20) + (significant_bits - 1023)};
}
/// For areas below 2^31. significant_bits <= 29: a quotient fits 31 bits.
HALFPLANE_LEAF QuotientLanes quotient_lanes(const I16& area, int significant_bits) {
  const D16 divisor = convert<double>(max(area, I16(1)));
  const auto bits = as<L16>(divisor);
  const L16 shift = shift_right_logical(bits, 52) - (1023 - significant_bits);
  const L16 power_bits = (shift + 1024) << 52;  // of 2^(shift + 1)
  const auto power = as<D16>(power_bits);
  L16 quotient = convert<std::int64_t>(convert<std::int32_t>(power / divisor));
  const L16 remainder = (L16(1) << (shift + 1)) - multiply_narrow(quotient, convert<std::int64_t>(area));
  quotient = quotient + (remainder < 0) - (remainder >= convert<std::int64_t>(area));
  return {convert<std::int32_t>(quotient), convert<std::int32_t>(shift)};
}
/// Reciprocals of the areas, without the lowest `dropped` bits.
struct ReciprocalLanes {
  I16 value, shift;
  HALFPLANE_LEAF ReciprocalLanes(const QuotientLanes& quotient, int dropped)
      : value(shift_right_logical(shift_right_logical(quotient.value, dropped) + 1, 1)),
        shift(quotient.shift - dropped) {}
};

/// Gradients of sixteen planes: numerators times reciprocals, rounded.
struct GradientLanes {
  static constexpr std::int64_t kRaise = std::int64_t{1} << 62;  ///< makes a product positive: no shift needs a sign
  L16 reciprocal, left, right;                                   ///< shifts; one of them is 0
  L16 addend, lowered;

  /// `k`: bits that a product drops; negative: bits gained.
  HALFPLANE_LEAF GradientLanes(const I16& reciprocal_, const I16& k)
      : reciprocal(convert<std::int64_t>(reciprocal_)),
        left(convert<std::int64_t>(max(-k, I16(0)))),
        right(convert<std::int64_t>(max(k, I16(0)))),
        addend(shift_right_logical(L16(1) << right, 1) + kRaise),
        lowered(shift_right_logical(L16(kRaise), right)) {}

  HALFPLANE_LEAF L16 operator()(const I16& numerator) const {
    return rounded(multiply_narrow(convert<std::int64_t>(numerator), reciprocal));
  }
  HALFPLANE_LEAF L16 operator()(const L16& numerator) const { return rounded(numerator * reciprocal); }

  HALFPLANE_LEAF L16 rounded(const L16& product) const {
    return shift_right_logical((product << left) + addend, right) - lowered;
  }
};

/// A value that wraps, split into two lanes of 32 bits: the bits below some place, and the bits from there on.
struct SplitLanes {
  I16 upper, lower;

  HALFPLANE_LEAF SplitLanes(const I16& upper_, const I16& lower_) : upper(upper_), lower(lower_) {}
  HALFPLANE_LEAF SplitLanes(const SplitLanes& from) : SplitLanes(from.upper, from.lower) {}
  HALFPLANE_LEAF friend SplitLanes operator+(const SplitLanes& a, const SplitLanes& b) {
    return {a.upper + b.upper, a.lower + b.lower};
  }
  HALFPLANE_LEAF friend SplitLanes operator<<(const SplitLanes& a, int bits) {
    return {a.upper << bits, a.lower << bits};
  }
  HALFPLANE_LEAF friend SplitLanes turned(const SplitLanes& v, const I16& mask) {
    return {turned(v.upper, mask), turned(v.lower, mask)};
  }
};

/// The same for products that fit binary64: numerators times reciprocals below 2^53, gradients below 2^51.
struct ExactGradientLanes {
  D16 factor;  ///< R 2^-k
  int place;   ///< bit at which a gradient is split

  HALFPLANE_LEAF ExactGradientLanes(const I16& reciprocal, const I16& k, int place_) : place(place_) {
    const L16 power = convert<std::int64_t>(1023 - k) << 52;
    factor = convert<double>(reciprocal) * as<D16>(power);
  }

  HALFPLANE_LEAF SplitLanes operator()(const I16& numerator) const { return (*this)(convert<double>(numerator)); }
  HALFPLANE_LEAF SplitLanes operator()(const D16& numerator) const {
    constexpr double kInteger = 0x1.8p52;  // adding it leaves the integer in the lower bits
    const auto bits = as<L16>(floor(numerator * factor + 0.5) + kInteger);
    return {convert<std::int32_t>(shift_right_logical(bits, place)),
            convert<std::int32_t>(bits) & ((std::int32_t{1} << place) - 1)};
  }
};

/// The same for products, and wrapping planes, that fit 32 bits.
struct NarrowGradientLanes {
  I16 reciprocal, right, addend;

  HALFPLANE_LEAF NarrowGradientLanes(const I16& reciprocal_, const I16& k)
      : reciprocal(reciprocal_ << max(-k, I16(0))),  // if a product gains bits
        right(max(k, I16(0))),
        addend((I16(1) << right) >> 1) {}

  HALFPLANE_LEAF I16 operator()(const I16& numerator) const { return (numerator * reciprocal + addend) >> right; }
};

/// round_shift(), the lower 32 bits. bits <= 32.
HALFPLANE_LEAF I16 round_shift_lanes(const L16& value, int bits) {
  if (bits <= 0) return convert<std::int32_t>(value << -bits);
  return convert<std::int32_t>(shift_right_logical(value + (std::int64_t{1} << (bits - 1)), bits));
}

/// One number per channel.
using Channels __attribute__((vector_size(32))) = std::int64_t;
HALFPLANE_LEAF Channels load(const std::array<std::int64_t, 4>& from) {
  using InMemory __attribute__((vector_size(32), aligned(8), may_alias)) = std::int64_t;
  return *reinterpret_cast<const InMemory*>(from.data());
}
HALFPLANE_LEAF void store(std::array<std::int64_t, 4>& to, const Channels& value) {
  using InMemory __attribute__((vector_size(32), aligned(8), may_alias)) = std::int64_t;
  *reinterpret_cast<InMemory*>(to.data()) = value;
}
/// The channels of a colour, R lowest.
HALFPLANE_LEAF Channels channels_of(std::uint32_t rgba) {
  using Unsigned __attribute__((vector_size(32))) = std::uint64_t;
  return (Channels)((Unsigned{} + rgba) >> Unsigned{0, 8, 16, 24}) & 255;
}
using Codes __attribute__((vector_size(16))) = std::int32_t;
/// The lower halves: red with blue, green with alpha.
HALFPLANE_LEAF ChannelPairs channel_pairs(const Codes& code) {
  const Codes pair = (code & 0xffff) | __builtin_shufflevector(code, code, 2, 3, 0, 1) << 16;
  return {pair[0], pair[1]};
}
HALFPLANE_LEAF ChannelPairs channel_pairs(const Channels& value) {
  return channel_pairs(__builtin_convertvector(value, Codes));
}
/// round_shift(). The lanes have no signed shift: the shifted sign bit is copied to all bits above it.
HALFPLANE_LEAF Channels round_shift_channels(const Channels& value, int bits) {
  if (bits <= 0) return value << -bits;
  using Unsigned __attribute__((vector_size(32))) = std::uint64_t;
  const Channels half = (Channels)((Unsigned)value >> (bits - 1)) & 1;
  const auto sign = static_cast<std::int64_t>(std::uint64_t{1} << (63 - bits));
  return (((Channels)((Unsigned)value >> bits)) ^ sign) - sign + half;
}

inline std::uint64_t product(std::int64_t a, std::int64_t b) {
  return static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(b);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
