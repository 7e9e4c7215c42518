// Golden colour operations: blending, in real arithmetic. Channels are 0...255; in a target without alpha the last is
// 255. A logic operation works on codes: both colours are rounded to the target's codes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "../scene.hpp"
#include "depth_test.hpp"

namespace halfplane::golden {

using RealColor = std::array<double, 4>;

/// A blend factor of channel c, 0...1.
[[nodiscard]] inline double factor_value(BlendFactor factor, std::size_t c, const RealColor& src, const RealColor& dst,
                                         const RealColor& constant) {
  const double sa = src[3] / 255, da = dst[3] / 255;
  switch (factor) {
    case BlendFactor::zero: return 0;
    case BlendFactor::one: return 1;
    case BlendFactor::src_color: return src[c] / 255;
    case BlendFactor::one_minus_src_color: return 1 - src[c] / 255;
    case BlendFactor::dst_color: return dst[c] / 255;
    case BlendFactor::one_minus_dst_color: return 1 - dst[c] / 255;
    case BlendFactor::src_alpha: return sa;
    case BlendFactor::one_minus_src_alpha: return 1 - sa;
    case BlendFactor::dst_alpha: return da;
    case BlendFactor::one_minus_dst_alpha: return 1 - da;
    case BlendFactor::constant_color: return constant[c] / 255;
    case BlendFactor::one_minus_constant_color: return 1 - constant[c] / 255;
    case BlendFactor::constant_alpha: return constant[3] / 255;
    case BlendFactor::one_minus_constant_alpha: return 1 - constant[3] / 255;
    case BlendFactor::src_alpha_saturate: return c == 3 ? 1.0 : std::min(sa, 1 - da);
  }
  return 0;
}

/// A logic operation on codes with the bits of `most`.
[[nodiscard]] inline int operated(LogicOp op, int s, int d, int most) {
  int result = 0;
  switch (op) {
    case LogicOp::clear: result = 0; break;
    case LogicOp::and_op: result = s & d; break;
    case LogicOp::and_reverse: result = s & ~d; break;
    case LogicOp::copy: result = s; break;
    case LogicOp::and_inverted: result = ~s & d; break;
    case LogicOp::noop: result = d; break;
    case LogicOp::xor_op: result = s ^ d; break;
    case LogicOp::or_op: result = s | d; break;
    case LogicOp::nor: result = ~(s | d); break;
    case LogicOp::equiv: result = ~(s ^ d); break;
    case LogicOp::invert: result = ~d; break;
    case LogicOp::or_reverse: result = s | ~d; break;
    case LogicOp::copy_inverted: result = ~s; break;
    case LogicOp::or_inverted: result = ~s | d; break;
    case LogicOp::nand: result = ~(s & d); break;
    case LogicOp::set: result = ~0; break;
  }
  return result & most;
}

[[nodiscard]] inline int largest_code(bool has_alpha, std::size_t c) { return has_alpha ? 255 : c == 1 ? 63 : 31; }

/// The nearest code, 0...most, of a value 0...255.
[[nodiscard]] inline int nearest_code(double value, int most) {
  return static_cast<int>(std::floor(std::clamp(value, 0.0, 255.0) * most / 255 + 0.5));
}

/// The colour after a write of `src` over `dst`: operated on or blended, under the mask. `has_alpha`: the target is
/// rgba8888, else rgb565.
[[nodiscard]] inline RealColor blended(const State& state, const RealColor& src, const RealColor& dst,
                                       bool has_alpha = true) {
  RealColor result = src;
  for (std::size_t c = 0; c < 4; ++c) {
    if (!state.color_mask[c]) {
      result[c] = dst[c];
      continue;
    }
    if (state.logic_op != LogicOp::copy) {
      const int most = largest_code(has_alpha, c);
      const int code = operated(state.logic_op, nearest_code(src[c], most), nearest_code(dst[c], most), most);
      result[c] = code * 255.0 / most;
      continue;
    }
    if (!state.blend) continue;
    const BlendFactors& f = *state.blend;
    RealColor constant{};
    for (std::size_t i = 0; i < 4; ++i) constant[i] = state.blend_color[i];
    const double s = src[c] * factor_value(c == 3 ? f.src_alpha : f.src, c, src, dst, constant);
    const double d = dst[c] * factor_value(c == 3 ? f.dst_alpha : f.dst, c, src, dst, constant);
    switch (state.blend_equation[c == 3 ? 1 : 0]) {
      case BlendEquation::add: result[c] = s + d; break;
      case BlendEquation::subtract: result[c] = s - d; break;
      case BlendEquation::reverse_subtract: result[c] = d - s; break;
      case BlendEquation::min: result[c] = std::min(src[c], dst[c]); break;
      case BlendEquation::max: result[c] = std::max(src[c], dst[c]); break;
    }
    result[c] = std::clamp(result[c], 0.0, 255.0);
  }
  return result;
}

/// The stencil test of the visible side.
[[nodiscard]] inline const Stencil* stencil_of(const State& state, bool is_back) {
  if (!state.stencil) return nullptr;
  return is_back && state.stencil_back ? &*state.stencil_back : &*state.stencil;
}
[[nodiscard]] inline bool passes(const Stencil& s, int stored) {
  return passes(s.func, s.reference & s.read_mask, stored & s.read_mask);
}
/// The stored value after an operation, a whole number 0...255.
[[nodiscard]] inline int operated(StencilOp op, const Stencil& s, int stored) {
  int result = stored;
  switch (op) {
    case StencilOp::keep: break;
    case StencilOp::zero: result = 0; break;
    case StencilOp::replace: result = s.reference; break;
    case StencilOp::incr: result = stored == 255 ? 255 : stored + 1; break;
    case StencilOp::decr: result = stored == 0 ? 0 : stored - 1; break;
    case StencilOp::invert: result = ~stored; break;
    case StencilOp::incr_wrap: result = stored + 1; break;
    case StencilOp::decr_wrap: result = stored - 1; break;
  }
  return (result & s.write_mask & 255) | (stored & ~s.write_mask & 255);
}

}  // namespace halfplane::golden
