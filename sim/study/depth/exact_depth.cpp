#include "sim/study/depth/exact_depth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "model/as_number.hpp"
#include "model/config.hpp"

namespace halfplane {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Rational rational_power_of_two(int exponent) {
  mpz_class power = 1;
  power <<= static_cast<mp_bitcnt_t>(std::abs(exponent));
  return exponent >= 0 ? Rational(power) : Rational(mpz_class(1), power);
}

/// To about one rounding of 64 bits: mpq_get_d would give 53.
long double to_long_double(const Rational& value) {
  if (value == 0) return 0;
  const mpz_class& numerator = value.get_num();
  const mpz_class& denominator = value.get_den();
  const long shift = 70 - static_cast<long>(mpz_sizeinbase(numerator.get_mpz_t(), 2)) +
                     static_cast<long>(mpz_sizeinbase(denominator.get_mpz_t(), 2));
  mpz_class scaled = shift >= 0 ? mpz_class(numerator << static_cast<mp_bitcnt_t>(shift))
                                : mpz_class(numerator >> static_cast<mp_bitcnt_t>(-shift));
  scaled /= denominator;  // 70 or 71 bits
  const mpz_class high = scaled >> 32, low = scaled - (high << 32);
  return std::ldexp(std::ldexp(static_cast<long double>(high.get_d()), 32) + static_cast<long double>(low.get_d()),
                    static_cast<int>(-shift));
}

Rational power(const Rational& base, unsigned long exponent) {
  Rational result;
  mpz_pow_ui(result.get_num().get_mpz_t(), base.get_num().get_mpz_t(), exponent);
  mpz_pow_ui(result.get_den().get_mpz_t(), base.get_den().get_mpz_t(), exponent);
  return result;
}

}  // namespace

Rational parse_decimal(std::string_view text, std::string_view what) {
  const auto fail = [&]() -> Rational {
    throw InputError(std::string(what) + ": '" + std::string(text) +
                     "' is no number; give a decimal such as 0.1 or 1e-3");
  };
  std::string_view rest = text;
  const bool is_negative = rest.starts_with('-');
  if (is_negative || rest.starts_with('+')) rest.remove_prefix(1);
  std::string digits;
  int exponent = 0;
  bool has_point = false;
  for (; !rest.empty() && (rest.front() == '.' || (rest.front() >= '0' && rest.front() <= '9'));
       rest.remove_prefix(1)) {
    if (rest.front() == '.') {
      if (has_point) return fail();
      has_point = true;
    } else {
      digits += rest.front();
      exponent -= has_point ? 1 : 0;
    }
  }
  if (digits.empty() || digits.size() > 400) return fail();
  if (!rest.empty()) {
    if (rest.front() != 'e' && rest.front() != 'E') return fail();
    rest.remove_prefix(rest.size() > 1 && rest[1] == '+' ? 2 : 1);
    const auto power_of_ten = as_number<int>(rest);
    if (!power_of_ten || std::abs(*power_of_ten) > 300) return fail();
    exponent += *power_of_ten;
  }
  const Rational scale = power(Rational(10), static_cast<unsigned long>(std::abs(exponent)));
  const mpz_class whole(digits, 10);
  const Rational value = exponent >= 0 ? Rational(whole * scale.get_num()) : Rational(whole) / scale;
  return is_negative ? Rational(-value) : value;
}

ExactDepth::ExactDepth(DepthMapping mapping, const DepthFormat& format, const Rational& near, const Rational& far)
    : mapping_(mapping), format_(format), near_(near), far_(far) {
  if (mapping == DepthMapping::projection || format.kind == DepthFormat::Kind::plane)
    throw InputError("the theory of depth needs a mapping and a format by name, as in std and u16");
  if (!(near > 0 && near < far)) throw InputError("near and far: give 0 < near < far");
  log_ratio_ = std::log(to_long_double(far / near));
  d_near_ = d_of(near);
  d_far_ = d_of(far);
}

/// d(z) where it is rational; the end points where it is not.
Rational ExactDepth::d_of(const Rational& z) const {
  switch (mapping_) {
    case DepthMapping::std: return far_ * (z - near_) / (z * (far_ - near_));
    case DepthMapping::rev: return near_ * (far_ - z) / (z * (far_ - near_));
    case DepthMapping::stdinf: return 1 - near_ / z;
    case DepthMapping::revinf: return near_ / z;
    case DepthMapping::w: return (z - near_) / (far_ - near_);
    default: return z == near_ ? 0 : 1;
  }
}

/// z(d) where it is rational; none at infinity.
std::optional<Rational> ExactDepth::z_of(const Rational& d) const {
  Rational denominator;
  switch (mapping_) {
    case DepthMapping::std: return near_ * far_ / (far_ - d * (far_ - near_));
    case DepthMapping::rev: return near_ * far_ / (near_ + d * (far_ - near_));
    case DepthMapping::stdinf: denominator = 1 - d; break;
    case DepthMapping::revinf: denominator = d; break;
    default: return near_ + d * (far_ - near_);
  }
  if (denominator == 0) return std::nullopt;
  return near_ / denominator;
}

/// |z(d0) - z(d1)|, without cancellation.
double ExactDepth::distance(const Rational& d0, const Rational& d1) const {
  if (mapping_ == DepthMapping::log) {
    const Rational &low = std::min(d0, d1), &high = std::max(d0, d1);
    const long double from = to_long_double(near_) * std::exp(to_long_double(low) * log_ratio_);
    return static_cast<double>(from * std::expm1(to_long_double(high - low) * log_ratio_));
  }
  const auto z0 = z_of(d0), z1 = z_of(d1);
  if (!z0 || !z1) return kInfinity;
  return static_cast<double>(to_long_double(abs(*z0 - *z1)));
}

Rational ExactDepth::value(std::uint32_t code) const {
  if (format_.kind == DepthFormat::Kind::bins)
    return (2 * Rational(code) + 1) * rational_power_of_two(-format_.bits - 1);
  if (!format_.is_float()) return Rational(code) / Rational(top_code(format_));
  const FloatSteps steps = float_steps(format_, code), one = float_steps(format_, top_code(format_));
  return Rational(steps.significand) / Rational(one.significand) * rational_power_of_two(steps.shift - one.shift);
}

ExactDepth::Boundaries ExactDepth::boundaries(std::uint32_t code) const {
  if (format_.kind == DepthFormat::Kind::bins)
    return {Rational(code) * rational_power_of_two(-format_.bits),
            (Rational(code) + 1) * rational_power_of_two(-format_.bits)};
  const Rational own = value(code);
  return {code == 0 ? Rational(0) : Rational((value(code - 1) + own) / 2),
          code == top_code(format_) ? Rational(1) : Rational((own + value(code + 1)) / 2)};
}

long double ExactDepth::d_estimate(const Rational& z) const {
  // log1p: near the near plane the logarithm itself would lose the remaining bits of d.
  if (mapping_ == DepthMapping::log) return std::log1p(to_long_double(z / near_ - 1)) / log_ratio_;
  return to_long_double(d_of(z));
}

/// The sign of d(z) - d.
int ExactDepth::compare_d(const Rational& z, const Rational& d) const {
  if (mapping_ != DepthMapping::log) return cmp(d_of(z), d);
  // The logarithm of a rational is at a rational part of another's only if a power of one is a power of the other:
  // (z / near)^q = (far / near)^p. Beyond q = 64 far / near would be a 65th power.
  const mpz_class &p = d.get_num(), &q = d.get_den();
  if (q <= 64 && p >= 0) return cmp(power(z / near_, q.get_ui()), power(far_ / near_, p.get_ui()));
  const long double own = d_estimate(z), other = to_long_double(d);
  return own < other ? -1 : own > other ? 1 : 0;
}

std::uint32_t ExactDepth::code(const Rational& z) const {
  std::uint32_t guess = depth_code(format_, d_estimate(z));
  // Ties: up for unorm and bins, to the even code for floats.
  const auto is_below = [&](std::uint32_t code) {
    const int side = compare_d(z, boundaries(code).low);
    return side < 0 || (side == 0 && format_.is_float() && code % 2 == 1);
  };
  while (guess > 0 && is_below(guess)) --guess;
  while (guess < top_code(format_) && !is_below(guess + 1)) ++guess;
  return guess;
}

std::optional<ExactDepth::Bin> ExactDepth::bin(std::uint32_t code) const {
  Boundaries b = boundaries(code);
  const Rational &least = std::min(d_near_, d_far_), &most = std::max(d_near_, d_far_);
  if (b.high < least || b.low > most) return std::nullopt;
  b.low = std::max(b.low, least);
  b.high = std::min(b.high, most);
  const bool is_turned = is_reversed(mapping_);
  const Rational &first = is_turned ? b.high : b.low, &last = is_turned ? b.low : b.high;
  return Bin{to_double(first), to_double(last), distance(first, last)};
}

double ExactDepth::d_width(std::uint32_t code) const {
  if (format_.kind == DepthFormat::Kind::bins) return std::exp2(-format_.bits);
  if (!format_.is_float()) return 1.0 / top_code(format_);
  const Boundaries b = boundaries(code);
  if (code == 0) return static_cast<double>(to_long_double(2 * b.high));
  if (code == top_code(format_)) return static_cast<double>(to_long_double(2 * (1 - b.low)));
  return static_cast<double>(to_long_double(b.high - b.low));
}

double ExactDepth::to_double(const Rational& d) const {
  if (mapping_ == DepthMapping::log)
    return static_cast<double>(to_long_double(near_) * std::exp(to_long_double(d) * log_ratio_));
  const auto z = z_of(d);
  return z ? static_cast<double>(to_long_double(*z)) : kInfinity;
}

double ExactDepth::reconstructed(std::uint32_t code) const { return to_double(value(code)); }

DepthFigures ExactDepth::at(const Rational& z) const {
  DepthFigures figures;
  figures.code = code(z);
  Boundaries b = boundaries(figures.code);
  const Rational &least = std::min(d_near_, d_far_), &most = std::max(d_near_, d_far_);
  b.low = std::clamp(b.low, least, most);
  b.high = std::clamp(b.high, least, most);
  const Rational own = value(figures.code);
  figures.bin_width = distance(b.low, b.high);
  figures.max_recon_err = std::max(distance(b.low, own), distance(b.high, own));
  const auto depth = static_cast<double>(to_long_double(z));
  const Rational range = far_ - near_;
  double slope = 0;  // |dz/dd|
  switch (mapping_) {
    case DepthMapping::w: slope = static_cast<double>(to_long_double(range)); break;
    case DepthMapping::log: slope = depth * static_cast<double>(log_ratio_); break;
    case DepthMapping::stdinf:
    case DepthMapping::revinf: slope = static_cast<double>(to_long_double(z * z / near_)); break;
    default: slope = static_cast<double>(to_long_double(z * z * range / (far_ * near_))); break;
  }
  figures.first_order = slope * d_width(figures.code);
  return figures;
}

/// Codes from the one of `low` to the one of `high`, in the order of z, split where a bin may be shorter than the one
/// before it: within a run bins do not get shorter with z. Each entry is the last code of a run.
std::vector<std::uint32_t> ExactDepth::run_ends(std::uint32_t first, std::uint32_t last) const {
  std::vector<std::uint32_t> ends;
  const bool is_up = first <= last;
  const std::uint32_t low = std::min(first, last), high = std::max(first, last);
  std::vector<std::uint32_t> cuts{low, high};  // the first and the last bin are clipped: runs of their own
  if (low < high) cuts.push_back(high - 1);
  if (format_.is_float())
    for (std::uint64_t binade = 1; binade << format_.mantissa_bits <= high; ++binade) {
      // The code at the foot of a binade has a narrower half below it.
      const std::uint64_t foot = binade << format_.mantissa_bits;
      for (const std::uint64_t cut : {foot - 1, foot})
        if (cut > low && cut < high) cuts.push_back(static_cast<std::uint32_t>(cut));
    }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  if (is_up) return cuts;
  // Downwards a run ends one above the next lower cut.
  for (std::size_t i = cuts.size(); i-- > 1;) ends.push_back(cuts[i - 1] + 1);
  ends.push_back(low);
  return ends;
}

std::optional<double> ExactDepth::first_exceeding(double length, const Rational& low, const Rational& high) const {
  const std::uint32_t first = code(low), last = code(high);
  const bool is_up = first <= last;
  const auto width = [this](std::uint32_t c) {
    const auto b = bin(c);
    return b ? b->width : 0.0;
  };
  std::uint32_t start = first;
  for (const std::uint32_t end : run_ends(first, last)) {
    if (width(end) > length) {
      std::uint32_t near_side = start, far_side = end;  // far_side is longer
      while (near_side != far_side) {
        const std::uint32_t middle =
            near_side < far_side ? near_side + (far_side - near_side) / 2 : near_side - (near_side - far_side) / 2;
        if (width(middle) > length)
          far_side = middle;
        else
          near_side = is_up ? middle + 1 : middle - 1;
      }
      return std::max(bin(far_side)->nearest, static_cast<double>(to_long_double(low)));
    }
    start = is_up ? end + 1 : end - 1;
  }
  return std::nullopt;
}

double ExactDepth::longest_bin(const Rational& low, const Rational& high) const {
  double longest = 0;
  for (const std::uint32_t end : run_ends(code(low), code(high)))
    if (const auto b = bin(end)) longest = std::max(longest, b->width);
  return longest;
}

}  // namespace halfplane
