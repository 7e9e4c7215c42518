#include "sim/study/compare/texture_errors.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "model/golden/exact.hpp"

namespace halfplane {
namespace {

/// The channel that is farthest off, LSB.
float worst_channel(const std::array<std::int64_t, 4>& error) {
  const auto size = [](std::int64_t e) { return std::abs(e); };
  return static_cast<float>(
      std::ldexp(static_cast<double>(*std::ranges::max_element(error, {}, size)), -exact::kGridBits));
}

}  // namespace

TextureErrorSets::TextureErrorSets(std::size_t pixels) {
  auto& picture = errors_.picture;
  for (auto* values : {&picture.coordinate, &picture.footprints, &picture.level, &picture.weights, &picture.rounding})
    values->assign(pixels, std::numeric_limits<float>::quiet_NaN());
}

void TextureErrorSets::add(std::size_t pixel, const SurfaceErrors& errors) {
  ++errors_.pixels;
  errors_.coordinate_of_bound = std::max(errors_.coordinate_of_bound, errors.coordinate.ratio());
  coordinate_.add(errors.coordinate.value);
  footprints_.add(errors.footprints);
  level_.add(errors.level);
  const auto& [coordinate, level, weights, rounding] = errors.texel;
  for (std::size_t c = 0; c < 4; ++c) {
    part_coordinate_.add(coordinate[c]);
    part_level_.add(level[c]);
    part_weights_.add(weights[c]);
    part_rounding_.add(rounding[c]);
    total_.add(coordinate[c] + level[c] + weights[c] + rounding[c]);
  }
  auto& picture = errors_.picture;
  picture.coordinate[pixel] = static_cast<float>(errors.coordinate.value);
  picture.footprints[pixel] = static_cast<float>(errors.footprints);
  picture.level[pixel] = static_cast<float>(errors.level);
  picture.weights[pixel] = worst_channel(weights);
  picture.rounding[pixel] = worst_channel(rounding);
}

TextureErrors TextureErrorSets::result() && {
  errors_.coordinate = coordinate_.stats();
  errors_.footprints = footprints_.stats();
  errors_.level = level_.stats();
  errors_.part_coordinate = part_coordinate_.stats();
  errors_.part_level = part_level_.stats();
  errors_.part_weights = part_weights_.stats();
  errors_.part_rounding = part_rounding_.stats();
  errors_.total = total_.stats();
  return std::move(errors_);
}

}  // namespace halfplane
