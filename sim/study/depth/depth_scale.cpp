#include "sim/study/depth/depth_scale.hpp"

#include <cmath>

namespace halfplane {

DepthScale::DepthScale(DepthMapping mapping, double near, double far) : mapping_(mapping), near_(near), far_(far) {
  const double range = std::isinf(far) ? 1 : far / (far - near);  // times near: near far / (far - near)
  switch (mapping) {
    case DepthMapping::stdinf: offset_ = 1, slope_ = -near; break;
    case DepthMapping::revinf: offset_ = 0, slope_ = near; break;
    case DepthMapping::rev: offset_ = -near / (far - near), slope_ = near * range; break;
    default: offset_ = range, slope_ = -near * range; break;
  }
}

double DepthScale::d_of_z(double z) const {
  if (mapping_ == DepthMapping::w) return (z - near_) / (far_ - near_);
  if (mapping_ == DepthMapping::log) return std::log(z / near_) / std::log(far_ / near_);
  return t_of_z(z);
}

double DepthScale::z_of_d(double d) const {
  if (mapping_ == DepthMapping::w) return near_ + d * (far_ - near_);
  if (mapping_ == DepthMapping::log) return near_ * std::pow(far_ / near_, d);
  return z_of_t(d);
}

}  // namespace halfplane
