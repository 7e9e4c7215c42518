#include "sim/study/depth/variant.hpp"

#include <algorithm>
#include <cmath>

namespace halfplane {

std::string DepthVariant::name() const {
  return std::string(depth_mapping_names()[static_cast<std::size_t>(mapping)]) + " " + to_string(format);
}

DepthVariant make_variant(const Config& config, DepthMapping mapping, const DepthFormat& format,
                          const DepthPlanes& planes) {
  DepthVariant variant{mapping, format, planes, config};
  const bool is_plane = is_screen_linear(mapping) && format.kind == DepthFormat::Kind::unorm && format.bits >= 8;
  int bits = format.bits + 4;
  if (format.is_float()) bits = 32;
  // The std depth has far / near fewer steps for an eye-space length at far than at near.
  if (!is_screen_linear(mapping)) bits += static_cast<int>(std::ceil(std::log2(planes[1] / planes[0])));
  variant.config.depth_mapping = mapping;
  variant.config.depth_format = format;
  variant.config.depth_bits = is_plane ? format.bits : std::clamp(bits, 8, 32);
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
