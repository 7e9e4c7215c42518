// Operations on a fragment's colour after the tests and its texture: alpha test, blending, dithering, logic operations,
// masks. The arithmetic of each exists once.
//
// Colours are codes of 8 bits, 0...255 for 0...1; a stored colour is widened to 8 bits by repeating its upper bits. A
// blend is
//   s fs + d fd  (or d fd - s fs, s fs - d fd), clamped at 0, divided by 255 and rounded once, clamped at 255
// which is exact: (t + (t >> 8)) >> 8 with t = x + 128 is x / 255 to the nearest for every such sum.
// Lane: std::uint32_t, or a vector of them. The scalar instance is the specification.
// Source: OpenGL ES 2.0.25, 4.1.6 to 4.1.9; alpha test: ES 1.1.12, 4.1.4.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "../config.hpp"
#include "../scene.hpp"

namespace halfplane {

/// R, G, B, A.
template <class Lane>
using Channels = std::array<Lane, 4>;

// --- lanes ----------------------------------------------------------------------------------------------------------

/// The result of a comparison of lanes as a mask: all bits set where it holds.
template <class Lane, class Comparison>
[[nodiscard]] constexpr Lane lane_mask(const Comparison& holds) {
  if constexpr (std::is_integral_v<Lane>)
    return holds ? static_cast<Lane>(~Lane{}) : Lane{};
  else
    return (Lane)holds;  // a mask as wide as the lane
}

/// `value` where the mask is set, `stored` elsewhere.
template <class Lane>
[[nodiscard]] constexpr Lane write_where(const Lane& mask, const Lane& value, const Lane& stored) {
  return (value & mask) | (stored & ~mask);
}

template <class Lane>
[[nodiscard]] constexpr Lane least(const Lane& a, const Lane& b) {
  return write_where<Lane>(lane_mask<Lane>(a < b), a, b);
}
template <class Lane>
[[nodiscard]] constexpr Lane largest(const Lane& a, const Lane& b) {
  return write_where<Lane>(lane_mask<Lane>(a < b), b, a);
}

// --- the stored format ----------------------------------------------------------------------------------------------

/// The nearest 5- or 6-bit code of an 8-bit one: floor(c * 31 / 255 + 1/2), or with 63, as one multiply, add and shift
/// (exact for all 256 inputs; tested). The sums have 16 bits.
template <class Lane>
[[nodiscard]] constexpr Lane to_5_bits(const Lane& c) {
  return (c * 249 + 1014) >> 11;
}
template <class Lane>
[[nodiscard]] constexpr Lane to_6_bits(const Lane& c) {
  return (c * 253 + 505) >> 10;
}

template <class Lane>
[[nodiscard]] constexpr Lane pack_rgb565(const Lane& r, const Lane& g, const Lane& b) {
  return to_5_bits(r) << 11 | to_6_bits(g) << 5 | to_5_bits(b);
}
template <class Lane>
[[nodiscard]] constexpr Lane pack_rgba8888(const Lane& r, const Lane& g, const Lane& b, const Lane& a) {
  return r | g << 8 | b << 16 | a << 24;
}

/// 8-bit codes to the stored code. rgb565 ignores the last.
template <class Lane>
[[nodiscard]] constexpr Lane pack_color(ColorFormat format, const Channels<Lane>& c) {
  return format == ColorFormat::rgb565 ? pack_rgb565(c[0], c[1], c[2]) : pack_rgba8888(c[0], c[1], c[2], c[3]);
}
[[nodiscard]] constexpr std::uint32_t pack_color(ColorFormat format, const std::array<std::uint8_t, 4>& c) {
  return pack_color(format, Channels<std::uint32_t>{c[0], c[1], c[2], c[3]});
}

/// A stored code split into its fields, 5, 6, 5 bits or 8 each. For rgb565 the last is 0.
template <class Lane>
[[nodiscard]] constexpr Channels<Lane> unpack_color(ColorFormat format, const Lane& color) {
  if (format == ColorFormat::rgb565) return {color >> 11 & 31, color >> 5 & 63, color & 31, Lane{}};
  return {color & 255, color >> 8 & 255, color >> 16 & 255, color >> 24};
}

/// A stored code as 8-bit codes: 5 and 6 bits repeat their upper ones; a format without alpha is opaque.
template <class Lane>
[[nodiscard]] constexpr Channels<Lane> widen_color(ColorFormat format, const Lane& color) {
  const Channels<Lane> c = unpack_color(format, color);
  if (format == ColorFormat::rgba8888) return c;
  return {c[0] << 3 | c[0] >> 2, c[1] << 2 | c[1] >> 4, c[2] << 3 | c[2] >> 2, Lane{} + 255};
}

/// Ordered dithering: the threshold of a pixel, one of sixteen (Bayer's 4x4 matrix). A code is rounded up where the
/// lost fraction is more than (threshold + 1/2) / 16.
[[nodiscard]] constexpr std::uint32_t dither_threshold(int x, int y) {
  constexpr std::array<std::uint8_t, 16> kBayer{0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
  return 15U - kBayer[static_cast<std::size_t>((y & 3) * 4 + (x & 3))];
}
/// floor(c * 31 / 255 + (threshold + 1/2) / 16), or with 63: pack_rgb565() with another rounding.
template <class Lane>
[[nodiscard]] constexpr Lane pack_rgb565_dithered(const Lane& r, const Lane& g, const Lane& b, const Lane& threshold) {
  const auto to_5 = [&](const Lane& c) -> Lane { return (c * 249 + threshold * 128 + 64) >> 11; };
  return to_5(r) << 11 | (g * 253 + threshold * 64 + 32) >> 10 << 5 | to_5(b);
}

// --- blending -------------------------------------------------------------------------------------------------------

/// floor(value / 255 + 1/2), 0 <= value <= 255^2; above 255 for larger sums of two products.
template <class Lane>
[[nodiscard]] constexpr Lane divide_by_255(const Lane& value) {
  const Lane t = value + 128;
  return (t + (t >> 8)) >> 8;
}

/// One of the constants that a blend factor may be.
using BlendColor = std::array<std::uint8_t, 4>;

/// A factor of channel c, 0...255.
template <class Lane>
[[nodiscard]] constexpr Lane blend_factor(BlendFactor factor, std::size_t c, const Channels<Lane>& src,
                                          const Channels<Lane>& dst, const BlendColor& constant) {
  const Lane full = Lane{} + 255;
  switch (factor) {
    case BlendFactor::zero: return Lane{};
    case BlendFactor::one: return full;
    case BlendFactor::src_color: return src[c];
    case BlendFactor::one_minus_src_color: return full - src[c];
    case BlendFactor::dst_color: return dst[c];
    case BlendFactor::one_minus_dst_color: return full - dst[c];
    case BlendFactor::src_alpha: return src[3];
    case BlendFactor::one_minus_src_alpha: return full - src[3];
    case BlendFactor::dst_alpha: return dst[3];
    case BlendFactor::one_minus_dst_alpha: return full - dst[3];
    case BlendFactor::constant_color: return Lane{} + constant[c];
    case BlendFactor::one_minus_constant_color: return full - constant[c];
    case BlendFactor::constant_alpha: return Lane{} + constant[3];
    case BlendFactor::one_minus_constant_alpha: return full - constant[3];
    case BlendFactor::src_alpha_saturate: return c == 3 ? full : least<Lane>(src[3], full - dst[3]);
  }
  return Lane{};
}

/// One channel of the blended colour.
template <class Lane>
[[nodiscard]] constexpr Lane blend_channel(BlendEquation equation, const Lane& s, const Lane& fs, const Lane& d,
                                           const Lane& fd) {
  const Lane a = s * fs, b = d * fd;
  switch (equation) {
    case BlendEquation::add: return least<Lane>(divide_by_255<Lane>(a + b), Lane{} + 255);
    case BlendEquation::subtract: return divide_by_255<Lane>(largest<Lane>(a, b) - b);
    case BlendEquation::reverse_subtract: return divide_by_255<Lane>(largest<Lane>(a, b) - a);
    case BlendEquation::min: return least<Lane>(s, d);
    case BlendEquation::max: return largest<Lane>(s, d);
  }
  return Lane{};
}

// --- logic operations -----------------------------------------------------------------------------------------------

/// Whether the result depends on the stored code.
[[nodiscard]] constexpr bool reads_stored(LogicOp op) {
  const auto table = static_cast<unsigned>(op);
  return ((table ^ table >> 1) & 0b0101U) != 0;
}

/// A logic operation as an exclusive or of products, each term all ones or zero: without a choice per bit or lane.
struct LogicTerms {
  std::uint32_t none, source, stored, both;

  constexpr explicit LogicTerms(LogicOp op) {
    const auto result = [table = static_cast<unsigned>(op)](unsigned bit) {
      return (table >> bit & 1) != 0 ? ~std::uint32_t{} : 0;
    };
    none = result(3);
    source = result(1) ^ none;
    stored = result(2) ^ none;
    both = result(0) ^ result(1) ^ result(2) ^ none;
  }
};

/// The operation on every bit of the codes, of unused bits as well.
template <class Lane>
[[nodiscard]] constexpr Lane operated(const LogicTerms& terms, const Lane& source, const Lane& stored) {
  return (source & terms.source) ^ (stored & terms.stored) ^ (source & stored & terms.both) ^ terms.none;
}

// --- the operations of a draw ---------------------------------------------------------------------------------------

/// Colour operations of a draw. Normalised so that draws with equal effect are equal.
struct ColorOps {
  BlendFactors factors;                                ///< one, zero: the fragment's colour unchanged
  std::array<BlendEquation, 2> equation{};             ///< of colour, of alpha
  BlendColor constant{};                               ///< 0 unless a factor uses it
  LogicOp logic = LogicOp::copy;                       ///< but for copy nothing blends
  std::array<bool, 4> writes{true, true, true, true};  ///< channels
  bool dithers = false;
  bool operator==(const ColorOps&) const = default;

  /// The stored code is that of the fragment's colour: no operation has an effect.
  /// blends() is asked first: mostly that decides, and without a call.
  [[nodiscard]] constexpr bool is_plain() const { return !blends() && *this == ColorOps{}; }
  [[nodiscard]] constexpr bool blends() const {
    return factors != BlendFactors{} || equation != std::array<BlendEquation, 2>{};
  }
  /// Whether the result depends on the stored colour.
  [[nodiscard]] constexpr bool reads_stored() const {
    return blends() || halfplane::reads_stored(logic) || writes != std::array{true, true, true, true};
  }
  /// Whether a factor uses the constant.
  [[nodiscard]] constexpr bool reads_constant() const {
    const auto is_constant = [](BlendFactor factor) {
      return factor >= BlendFactor::constant_color && factor <= BlendFactor::one_minus_constant_alpha;
    };
    return is_constant(factors.src) || is_constant(factors.dst) || is_constant(factors.src_alpha) ||
           is_constant(factors.dst_alpha);
  }
};

/// Whether a source of alpha 255 replaces the stored colour, for all values of both.
[[nodiscard]] constexpr bool replaces_where_opaque(const ColorOps& ops, ColorFormat format) {
  const auto is_one = [](BlendFactor f) { return f == BlendFactor::one || f == BlendFactor::src_alpha; };
  const auto is_zero = [](BlendFactor f) { return f == BlendFactor::zero || f == BlendFactor::one_minus_src_alpha; };
  const auto takes_source = [](BlendEquation e) { return e == BlendEquation::add || e == BlendEquation::subtract; };
  const BlendFactors& f = ops.factors;
  const bool has_color = is_one(f.src) && is_zero(f.dst) && takes_source(ops.equation[0]);
  const bool has_alpha = (is_one(f.src_alpha) || f.src_alpha == BlendFactor::src_alpha_saturate) &&
                         is_zero(f.dst_alpha) && takes_source(ops.equation[1]);
  return has_color && (has_alpha || format != ColorFormat::rgba8888) && !ops.dithers && ops.logic == LogicOp::copy &&
         ops.writes == ColorOps{}.writes;
}

/// The operations of `state` that affect a format: rgb565 has no alpha, rgba8888 needs no dithering.
[[nodiscard]] constexpr ColorOps color_ops(const State& state, ColorFormat format) {
  const bool has_alpha = format == ColorFormat::rgba8888;
  const auto takes_factors = [](BlendEquation e) { return e != BlendEquation::min && e != BlendEquation::max; };
  ColorOps ops;
  ops.logic = state.logic_op;
  if (state.blend && ops.logic == LogicOp::copy) {
    ops.equation = state.blend_equation;
    ops.factors = *state.blend;
    if (!has_alpha) ops.equation[1] = BlendEquation::add;
    if (!takes_factors(ops.equation[0])) ops.factors.src = BlendFactor::one, ops.factors.dst = BlendFactor::zero;
    if (!takes_factors(ops.equation[1]) || !has_alpha)
      ops.factors.src_alpha = BlendFactor::one, ops.factors.dst_alpha = BlendFactor::zero;
    if (ops.reads_constant()) ops.constant = state.blend_color;
    // subtract with one and zero subtracts nothing
    for (const std::size_t part : {0U, 1U}) {
      const BlendFactors& f = ops.factors;
      const bool is_source = part == 0 ? f.src == BlendFactor::one && f.dst == BlendFactor::zero
                                       : f.src_alpha == BlendFactor::one && f.dst_alpha == BlendFactor::zero;
      if (ops.equation[part] == BlendEquation::subtract && is_source) ops.equation[part] = BlendEquation::add;
    }
  }
  ops.writes = state.color_mask;
  if (!has_alpha) ops.writes[3] = true;
  ops.dithers = state.dither && !has_alpha;
  return ops;
}

/// Whether it writes any channel of the format.
[[nodiscard]] constexpr bool writes_color(const State& state, ColorFormat format) {
  const auto& mask = state.color_mask;
  return state.color_write && (mask[0] || mask[1] || mask[2] || (mask[3] && format == ColorFormat::rgba8888));
}

/// The blend of `source` and `stored`, 8-bit codes.
template <class Lane>
[[nodiscard]] constexpr Channels<Lane> blended(const ColorOps& ops, const Channels<Lane>& source,
                                               const Channels<Lane>& stored) {
  const BlendFactors& f = ops.factors;
  Channels<Lane> result{};
  for (std::size_t c = 0; c < 4; ++c) {
    const Lane fs = blend_factor<Lane>(c == 3 ? f.src_alpha : f.src, c, source, stored, ops.constant),
               fd = blend_factor<Lane>(c == 3 ? f.dst_alpha : f.dst, c, source, stored, ops.constant);
    result[c] = blend_channel<Lane>(ops.equation[c == 3 ? 1 : 0], source[c], fs, stored[c], fd);
  }
  return result;
}

/// The bits of a stored code that are written.
[[nodiscard]] constexpr std::uint32_t written_bits(const ColorOps& ops, ColorFormat format) {
  const std::array<std::uint32_t, 4> bits = format == ColorFormat::rgb565
                                                ? std::array<std::uint32_t, 4>{0xF800, 0x07E0, 0x001F, 0}
                                                : std::array<std::uint32_t, 4>{0xFF, 0xFF00, 0xFF0000, 0xFF000000};
  std::uint32_t result = 0;
  for (std::size_t c = 0; c < 4; ++c) result |= ops.writes[c] ? bits[c] : 0;
  return result;
}

/// The code to store for `source` over `stored`. `threshold`: dither_threshold() of the pixel.
template <class Lane>
[[nodiscard]] constexpr Lane store_color(const ColorOps& ops, ColorFormat format, const Channels<Lane>& source,
                                         const Lane& stored, const Lane& threshold) {
  const Channels<Lane> c = ops.blends() ? blended<Lane>(ops, source, widen_color<Lane>(format, stored)) : source;
  const Lane packed =
      ops.dithers ? pack_rgb565_dithered<Lane>(c[0], c[1], c[2], threshold) : pack_color<Lane>(format, c);
  const Lane code = ops.logic == LogicOp::copy ? packed : operated<Lane>(LogicTerms(ops.logic), packed, stored);
  const std::uint32_t bits = written_bits(ops, format);
  return (code & bits) | (stored & ~bits);
}

}  // namespace halfplane
