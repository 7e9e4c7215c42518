#include "depth_format.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "../enum_names.hpp"
#include "../fixed.hpp"
#include "../input_error.hpp"

namespace halfplane {
namespace {

std::uint64_t all_ones(int bits) { return (std::uint64_t{1} << bits) - 1; }

/// Reads a whole number off the front of `text`; -1 if there is none.
int take_number(std::string_view& text) {
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + std::min<std::size_t>(text.size(), 3), value);
  if (error != std::errc() || text.front() == '-') return -1;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

bool take(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

/// d = 1 in smallest steps: factor * 2^exponent.
struct FloatScale {
  std::uint64_t factor;
  int exponent;
};
FloatScale scale_of(const DepthFormat& format) {
  const int largest_field = (1 << format.exponent_bits) - 1;
  if (format.kind == DepthFormat::Kind::small_float)
    return {all_ones(format.mantissa_bits + 1), largest_field - 1};  // the top code is 1
  return {1, largest_field / 2 - 1 + format.mantissa_bits};          // 1.0: the exponent field holds the bias
}

/// The float nearest to steps * 2^exponent, ties to even. A code is its significand with the hidden one, plus the binade
/// shifted above it: carries out of the significand come out right.
std::uint32_t float_code(const DepthFormat& format, long double steps, int exponent) {
  if (!(steps > 0)) return 0;
  const int binade = std::max(0, std::ilogb(steps) + exponent - format.mantissa_bits);
  const auto significand = static_cast<std::uint64_t>(std::nearbyint(std::ldexp(steps, exponent - binade)));
  const std::uint64_t code = (static_cast<std::uint64_t>(binade) << format.mantissa_bits) + significand;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(code, top_code(format)));
}

}  // namespace

std::span<const std::string_view> depth_mapping_names() { return kNamesOf<DepthMapping>; }

DepthFormat parse_depth_format(std::string_view text) {
  using Kind = DepthFormat::Kind;
  std::string_view rest = text;
  DepthFormat format;
  if (text == "plane") return format;
  if (text == "f16") return {Kind::ieee, 16, 5, 10};
  if (text == "f32") return {Kind::ieee, 32, 8, 23};
  bool is_good = false;
  if (take(rest, "uf")) {
    format.kind = Kind::small_float;
    format.exponent_bits = take_number(rest);
    const bool has_point = take(rest, ".");
    format.mantissa_bits = take_number(rest);
    format.bits = format.exponent_bits + format.mantissa_bits;
    is_good = has_point && format.exponent_bits >= 1 && format.exponent_bits <= 8 && format.mantissa_bits >= 1 &&
              format.mantissa_bits <= 24;
  } else if (take(rest, "bins")) {
    format.kind = Kind::bins;
    format.bits = take_number(rest);
    is_good = format.bits >= 2;
  } else if (take(rest, "u")) {
    format.kind = Kind::unorm;
    format.bits = take_number(rest);
    is_good = format.bits >= 2;
  }
  if (!is_good || !rest.empty() || format.bits > 32)
    throw InputError("no depth format '" + std::string(text) +
                     "'; give u<bits> or bins<bits> (2 to 32), f16, f32, or uf<exponent>.<mantissa> such as uf4.12 "
                     "(exponent 1 to 8, mantissa 1 to 24)");
  return format;
}

std::string to_string(const DepthFormat& format) {
  switch (format.kind) {
    case DepthFormat::Kind::plane: return "plane";
    case DepthFormat::Kind::unorm: return "u" + std::to_string(format.bits);
    case DepthFormat::Kind::bins: return "bins" + std::to_string(format.bits);
    case DepthFormat::Kind::ieee: return "f" + std::to_string(format.bits);
    case DepthFormat::Kind::small_float: break;
  }
  return "uf" + std::to_string(format.exponent_bits) + "." + std::to_string(format.mantissa_bits);
}

std::uint32_t top_code(const DepthFormat& format) {
  if (format.kind == DepthFormat::Kind::ieee)
    return static_cast<std::uint32_t>(all_ones(format.exponent_bits - 1)) << format.mantissa_bits;
  return static_cast<std::uint32_t>(all_ones(format.bits));
}

FloatSteps float_steps(const DepthFormat& format, std::uint32_t code) {
  const std::uint32_t field = code >> format.mantissa_bits;
  const auto fraction = static_cast<std::uint32_t>(code & all_ones(format.mantissa_bits));
  if (field == 0) return {fraction, 0};
  return {fraction + (1U << format.mantissa_bits), static_cast<int>(field) - 1};
}

long double depth_value(const DepthFormat& format, std::uint32_t code) {
  if (format.kind == DepthFormat::Kind::bins) return std::ldexp(code + 0.5L, -format.bits);
  if (!format.is_float()) return static_cast<long double>(code) / static_cast<long double>(top_code(format));
  const FloatSteps steps = float_steps(format, code);
  const FloatScale one = scale_of(format);
  return std::ldexp(static_cast<long double>(steps.significand) / static_cast<long double>(one.factor),
                    steps.shift - one.exponent);
}

std::uint32_t depth_code(const DepthFormat& format, std::uint64_t numerator, std::uint64_t denominator) {
  const std::uint64_t top = top_code(format);
  if (format.kind == DepthFormat::Kind::bins)
    return static_cast<std::uint32_t>(
        std::min<uint128>(static_cast<uint128>(numerator) << format.bits, static_cast<uint128>(top) * denominator) /
        denominator);
  if (!format.is_float())
    return static_cast<std::uint32_t>((2 * static_cast<uint128>(numerator) * top + denominator) / (2 * denominator));
  // The quotient is rounded to 64 bits or more. A midpoint between codes has 26 at most and the denominator 32, so a
  // quotient that is not a midpoint is more than 2^-59 (relative) away from one: rounding moves none across a midpoint.
  static_assert(std::numeric_limits<long double>::digits >= 64);
  const FloatScale one = scale_of(format);
  return float_code(format, static_cast<long double>(numerator * one.factor) / static_cast<long double>(denominator),
                    one.exponent);
}

std::uint32_t depth_code(const DepthFormat& format, long double d) {
  d = std::clamp(d, 0.0L, 1.0L);
  const auto top = static_cast<long double>(top_code(format));
  if (format.kind == DepthFormat::Kind::bins)
    return static_cast<std::uint32_t>(std::min(std::floor(std::ldexp(d, format.bits)), top));
  if (!format.is_float()) return static_cast<std::uint32_t>(std::floor(d * top + 0.5L));
  const FloatScale one = scale_of(format);
  return float_code(format, d * static_cast<long double>(one.factor), one.exponent);
}

}  // namespace halfplane
