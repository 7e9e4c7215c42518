#include "sim/study/depth/variant.hpp"

#include <algorithm>
#include <cmath>

namespace halfplane {

std::string DepthVariant::name() const {
  return std::string(depth_mapping_names()[static_cast<std::size_t>(mapping)]) + " " + to_string(format);
}

int interpolated_bits(const DepthFormat& format, bool is_linear, int more) {
  if (is_linear && format.kind == DepthFormat::Kind::unorm && format.bits >= 8) return format.bits;
  return std::clamp((format.is_float() ? 32 : format.bits + 4) + more, 8, 32);
}

DepthVariant make_variant(const Config& config, DepthMapping mapping, const DepthFormat& format,
                          const DepthPlanes& planes) {
  DepthVariant variant{mapping, format, planes, config};
  // The std depth has far / near fewer steps for an eye-space length at far than at near.
  const bool is_linear = is_screen_linear(mapping);
  const int more = is_linear ? 0 : static_cast<int>(std::ceil(std::log2(planes[1] / planes[0])));
  variant.config.depth_mapping = mapping;
  variant.config.depth_format = format;
  variant.config.depth_bits = interpolated_bits(format, is_linear, more);
  validate(variant.config);
  return variant;
}

std::string hardware_cost(const DepthVariant& variant) {
  const bool is_plane = DepthEncode(variant.config, variant.planes).is_identity();
  std::string text;
  if (is_plane) text = "none: the interpolated depth is stored as it is";
  if (!is_plane && variant.format.is_float()) text = "leading-zero count and shift for each fragment";
  if (!is_plane && !variant.format.is_float()) text = "rounding of the interpolated depth";
  if (variant.mapping == DepthMapping::w) text = "a division for each fragment";
  if (variant.mapping == DepthMapping::log) text = "a division and a logarithm for each fragment";
  if (!is_screen_linear(variant.mapping) && variant.format.is_float()) text += ", then a shift";
  if (!is_plane) text += "; depth interpolated with " + std::to_string(variant.config.depth_bits) + " bits";
  return text;
}

}  // namespace halfplane
