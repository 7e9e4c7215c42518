// Questions to the theory over a range of eye depths: the distribution of precision, and the cost of a wanted one.
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

/// The figures at logarithmically spaced eye depths, from near to far, and at the depths in `also`, so that a table of these
/// agrees with the curve. Eye-space units.
struct DepthCurve {
  std::vector<double> z, bin_width, max_recon_err, first_order;
};
[[nodiscard]] DepthCurve depth_curve(const ExactDepth& theory, int points, std::span<const NamedDepth> also = {});

/// Codes for the eye depths between two powers of ten, limited to [near, far].
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

/// The small float with the fewest bits that does the same, among floats with 2 to 6 bits of exponent.
[[nodiscard]] std::optional<DepthFormat> smallest_float(DepthMapping mapping, const Rational& near, const Rational& far,
                                                        const Rational& low, const Rational& high, double length);

/// The least near plane, at most `low`, with which no bin in [low, high] is longer than `length`; none if even a near
/// plane at `low` has a longer one, 0 if any down to 10^-12 of `low` suffices. To one part in 10^6. None for floats:
/// their longest bin is not monotonic in near.
[[nodiscard]] std::optional<double> best_near(DepthMapping mapping, const DepthFormat& format, const Rational& far,
                                              const Rational& low, const Rational& high, double length);

}  // namespace halfplane
