// Questions to the theory over a range of eye depths: where the precision goes, and what a wanted one takes.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sim/study/depth/exact_depth.hpp"

namespace halfplane {

/// An eye depth, and the binary64 that names it.
struct NamedDepth {
  Rational exact;
  double z = 0;
};

/// The figures at eye depths evenly spaced by the logarithm, from near to far, and at those that `also` names, so that a
/// table of these says the same as the curve. Eye-space units.
struct DepthCurve {
  std::vector<double> z, bin_width, max_recon_err, first_order;
};
[[nodiscard]] DepthCurve depth_curve(const ExactDepth& theory, int points, std::span<const NamedDepth> also = {});

/// Codes that serve the eye depths between two powers of ten, cut to [near, far].
struct CodeShare {
  double from = 0, to = 0;
  std::uint64_t codes = 0;
  double share = 0;  ///< of the codes in use
};
[[nodiscard]] std::vector<CodeShare> codes_by_decade(const ExactDepth& theory);

/// Codes in use between near and far.
[[nodiscard]] std::uint64_t codes_in_use(const ExactDepth& theory);

/// The fewest bits b of `u<b>` with no bin in [low, high] longer than `length`; none up to 32.
[[nodiscard]] std::optional<int> fewest_bits(DepthMapping mapping, const Rational& near, const Rational& far,
                                             const Rational& low, const Rational& high, double length);

/// The small float of the fewest bits that does the same, of those with 2 to 6 bits of exponent.
[[nodiscard]] std::optional<DepthFormat> smallest_float(DepthMapping mapping, const Rational& near, const Rational& far,
                                                        const Rational& low, const Rational& high, double length);

/// The least near plane, at most `low`, with which no bin in [low, high] is longer than `length`; none if even a near
/// plane at `low` has a longer one, 0 if any down to 10^-12 of `low` will do. To one part in
/// 10^6. None for floats: their longest bin goes up and down with near.
[[nodiscard]] std::optional<double> best_near(DepthMapping mapping, const DepthFormat& format, const Rational& far,
                                              const Rational& low, const Rational& high, double length);

}  // namespace halfplane
