#include "eye_depth.hpp"

#include <algorithm>
#include <cmath>

namespace halfplane {
namespace {

/// The vertices of smallest and largest 1/w of one draw.
struct Extremes {
  double low = INFINITY, low_z = 0, high = -INFINITY, high_z = 0;

  void add(double inverse_w, double z) {
    if (inverse_w < low) {
      low = inverse_w;
      low_z = z;
    }
    if (inverse_w > high) {
      high = inverse_w;
      high_z = z;
    }
  }
};

std::optional<EyeMapping> mapping_of(const Extremes& e) {
  // At least 1e-6 apart: below that the fit would amplify the rounding of its two vertices.
  if (!(e.low > 0) || !std::isfinite(e.high) || e.high - e.low < 1e-6 * e.high) return std::nullopt;
  const double b = (e.high_z - e.low_z) / (e.high - e.low);
  if (b == 0) return std::nullopt;
  return EyeMapping{e.low_z - b * e.low, b};
}

}  // namespace

std::optional<double> EyeMapping::eye_depth(double z) const {
  const double w = b / (z - a);
  if (!std::isfinite(w) || w <= 0) return std::nullopt;
  return w;
}

std::vector<std::optional<EyeMapping>> fit_eye_mappings(std::span<const golden::Outline> outlines,
                                                        std::size_t command_count) {
  std::vector<Extremes> extremes(command_count);
  for (const auto& o : outlines)
    for (std::size_t i = 0; i < o.corners; ++i) extremes[o.draw].add(o.inverse_w[i], o.z[i]);
  std::vector<std::optional<EyeMapping>> mappings(command_count);
  std::transform(extremes.begin(), extremes.end(), mappings.begin(), mapping_of);
  constexpr double kTolerance = 1e-6;  // of the window depth range: far above rounding, far below another projection
  for (const auto& o : outlines) {
    auto& mapping = mappings[o.draw];
    for (std::size_t i = 0; i < o.corners && mapping; ++i)
      if (!(std::abs(mapping->a + mapping->b * o.inverse_w[i] - o.z[i]) <= kTolerance)) mapping.reset();
  }
  return mappings;
}

}  // namespace halfplane
