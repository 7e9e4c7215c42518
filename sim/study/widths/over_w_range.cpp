#include "sim/study/widths/over_w_range.hpp"

#include <cmath>

#include "sim/study/compare/surface_oracle.hpp"

namespace halfplane {

std::optional<double> proven_w_ratio(double extent, double error, const PerspectiveFormat& format,
                                     const OverWFormat& attribute, int tile_size) {
  const auto holds = [&](double log_ratio) {
    return over_w_bound(extent, std::exp2(log_ratio), format, attribute, tile_size) <= error;
  };
  if (!holds(0)) return std::nullopt;
  double low = 0, high = format.q_bits;  // at 2^N nothing is left of Q
  while (high - low > 1e-9) {
    const double middle = (low + high) / 2;
    (holds(middle) ? low : high) = middle;
  }
  return std::exp2(low);
}

}  // namespace halfplane
