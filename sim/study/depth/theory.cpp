#include "sim/study/depth/theory.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace halfplane {

DepthCurve depth_curve(const ExactDepth& theory, int points, std::span<const NamedDepth> also) {
  DepthCurve curve;
  const double near = theory.near().get_d(), far = theory.far().get_d();
  std::vector<NamedDepth> depths(also.begin(), also.end());
  for (int i = 0; i < points; ++i) {
    const double z = near * std::pow(far / near, static_cast<double>(i) / (points - 1));
    // The power may end slightly before far, in another bin.
    const Rational exact = i == points - 1 ? theory.far() : std::clamp(Rational(z), theory.near(), theory.far());
    const bool is_named = std::any_of(also.begin(), also.end(), [&](const NamedDepth& named) {
      return named.exact == exact || named.z == exact.get_d();
    });
    if (!is_named) depths.push_back({exact, exact.get_d()});
  }
  std::sort(depths.begin(), depths.end(), [](const NamedDepth& a, const NamedDepth& b) { return a.exact < b.exact; });
  for (const NamedDepth& depth : depths) {
    const DepthFigures figures = theory.at(depth.exact);
    curve.z.push_back(depth.z);
    curve.bin_width.push_back(figures.bin_width);
    curve.max_recon_err.push_back(figures.max_recon_err);
    curve.first_order.push_back(figures.first_order);
  }
  return curve;
}

std::uint64_t codes_in_use(const ExactDepth& theory) {
  const std::int64_t first = theory.code(theory.near()), last = theory.code(theory.far());
  return static_cast<std::uint64_t>(std::abs(last - first)) + 1;
}

std::vector<CodeShare> codes_by_decade(const ExactDepth& theory) {
  std::vector<CodeShare> shares;
  const double near = theory.near().get_d(), far = theory.far().get_d();
  const std::uint64_t all = codes_in_use(theory);
  std::int64_t last = theory.code(theory.near());
  double from = near;
  for (int power = static_cast<int>(std::floor(std::log10(near))) + 1; from < far; ++power) {
    const double to = std::min(std::pow(10.0, power), far);
    if (to <= from) continue;
    const std::int64_t code = theory.code(to == far ? theory.far() : Rational(to));
    // The code at a boundary counts in the decade where it begins; the last one belongs to the last decade.
    const std::uint64_t codes = static_cast<std::uint64_t>(std::abs(code - last)) + (to == far ? 1 : 0);
    shares.push_back({from, to, codes, static_cast<double>(codes) / static_cast<double>(all)});
    last = code;
    from = to;
  }
  return shares;
}

std::optional<int> fewest_bits(DepthMapping mapping, const Rational& near, const Rational& far, const Rational& low,
                               const Rational& high, double length) {
  for (int bits = 2; bits <= 32; ++bits) {
    const ExactDepth theory(mapping, {DepthFormat::Kind::unorm, bits, 0, 0}, near, far);
    if (theory.longest_bin(low, high) <= length) return bits;
  }
  return std::nullopt;
}

std::optional<DepthFormat> smallest_float(DepthMapping mapping, const Rational& near, const Rational& far,
                                          const Rational& low, const Rational& high, double length) {
  for (int bits = 3; bits <= 30; ++bits)
    for (int exponent = 2; exponent <= 6; ++exponent) {
      const DepthFormat format{DepthFormat::Kind::small_float, bits, exponent, bits - exponent};
      if (format.mantissa_bits < 1 || format.mantissa_bits > 24) continue;
      if (ExactDepth(mapping, format, near, far).longest_bin(low, high) <= length) return format;
    }
  return std::nullopt;
}

std::optional<double> best_near(DepthMapping mapping, const DepthFormat& format, const Rational& far,
                                const Rational& low, const Rational& high, double length) {
  const auto is_enough = [&](const Rational& near) {
    return ExactDepth(mapping, format, near, far).longest_bin(low, high) <= length;
  };
  if (format.is_float() || !is_enough(low)) return std::nullopt;
  double enough = low.get_d(), too_near = enough * 1e-12;
  if (is_enough(Rational(too_near))) return 0;
  while (enough / too_near > 1 + 1e-6) {
    const double middle = std::sqrt(enough * too_near);
    (is_enough(Rational(middle)) ? enough : too_near) = middle;
  }
  return enough;
}

}  // namespace halfplane
