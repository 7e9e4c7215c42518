#include "depth_encode.hpp"

#include <cmath>

#include "../fixed.hpp"

namespace halfplane {

DepthFormat stored_format(const Config& config) {
  if (config.depth_format.kind != DepthFormat::Kind::plane) return config.depth_format;
  return {DepthFormat::Kind::unorm, config.depth_bits, 0, 0};
}

DepthEncode::DepthEncode(const Config& config, const std::optional<DepthPlanes>& planes)
    : mapping_(config.depth_mapping),
      format_(stored_format(config)),
      plane_bits_(config.depth_bits),
      is_identity_(is_screen_linear(mapping_) && format_ == DepthFormat{DepthFormat::Kind::unorm, plane_bits_, 0, 0}),
      plane_top_(static_cast<std::uint32_t>((std::uint64_t{1} << plane_bits_) - 1)) {
  if (is_screen_linear(mapping_)) return;
  if (!planes)
    throw InputError("depth.mapping " + std::string(depth_mapping_names()[static_cast<std::size_t>(mapping_)]) +
                     " needs the near and far plane; give `planes NEAR FAR` in the capture");
  if (!((*planes)[0] > 0 && (*planes)[0] < (*planes)[1] && std::isfinite((*planes)[1])))
    throw InputError("depth.mapping w and log need planes of 0 < near < far, both finite");
  ratio_ = static_cast<long double>((*planes)[1]) / static_cast<long double>((*planes)[0]);
  log_ratio_ = std::log(ratio_);
}

std::uint32_t DepthEncode::operator()(std::uint32_t plane_code) const {
  if (is_identity_) return plane_code;
  if (is_screen_linear(mapping_)) return depth_code(format_, plane_code, plane_top_);
  // With t the std depth, far - t (far - near) = near far / z.
  const long double top = plane_top_;
  const long double far_over_z = (static_cast<long double>(plane_top_ - plane_code) * ratio_ + plane_code) / top;
  if (mapping_ == DepthMapping::w) return depth_code(format_, plane_code / top / far_over_z);
  return depth_code(format_, std::log(ratio_ / far_over_z) / log_ratio_);
}

std::uint32_t DepthEncode::of_window(double z) const {
  return format_.kind == DepthFormat::Kind::unorm ? snap_depth(z, format_.bits)
                                                  : depth_code(format_, static_cast<long double>(z));
}

long double DepthEncode::plane_value(std::uint32_t stored) const {
  const long double d = window_value(stored);
  if (is_screen_linear(mapping_)) return d;
  // z / near, then the std depth of z.
  const long double z = mapping_ == DepthMapping::w ? 1 + d * (ratio_ - 1) : std::exp(d * log_ratio_);
  return ratio_ * (z - 1) / (z * (ratio_ - 1));
}

}  // namespace halfplane
