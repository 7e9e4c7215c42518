#include "sim/study/depth/error_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/widths.hpp"

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

DepthBound::DepthBound(const DepthVariant& variant)
    : scale_(variant.mapping, variant.planes[0], variant.planes[1]),
      format_(variant.format),
      is_identity_(DepthEncode(variant.config, variant.planes).is_identity()),
      is_reversed_(is_reversed(variant.mapping)),
      plane_lsb_(1 / (std::ldexp(1.0, variant.config.depth_bits) - 1)),
      // The bound of docs/spec.md includes half an LSB of rounding, which is a separate term here; the snap of Z
      // replaces it.
      datapath_(depth_error_bound(variant.config)),
      half_subpixel_(std::ldexp(0.5, -variant.config.subpixel_bits)) {}

DepthBudget DepthBound::budget(double slope, bool is_flat) const {
  if (is_flat) return {slope * half_subpixel_, 0.5 * plane_lsb_, 0};
  return {slope * half_subpixel_, datapath_ * plane_lsb_, 0.5 * plane_lsb_};
}

/// Half the distance between neighbouring values next to d, the larger one.
double DepthBound::half_step(double d) const {
  if (!format_.is_float())
    return 0.5 / (format_.kind == DepthFormat::Kind::bins ? std::exp2(format_.bits) : top_code(format_));
  const std::uint32_t top = top_code(format_);
  const std::uint32_t code = std::min(depth_code(format_, static_cast<long double>(d)), top - 1);
  const long double own = depth_value(format_, code), above = depth_value(format_, code + 1);
  return static_cast<double>(above - own) / 2;
}

double DepthBound::error(double z, const DepthBudget& budget) const {
  const double t = scale_.t_of_z(z), delta = budget.snap + budget.datapath + budget.rounding;
  double worst = 0;
  for (const double moved : {t - delta, t + delta}) {
    double eye = scale_.z_of_t(moved);
    if (!(eye > 0) || std::isinf(eye)) return std::numeric_limits<double>::infinity();
    if (!is_identity_) {
      const double d = scale_.d_of_z(eye), step = half_step(d);
      const double away = scale_.z_of_d((eye < z) != is_reversed_ ? d - step : d + step);
      if (!(away > 0) || std::isinf(away)) return std::numeric_limits<double>::infinity();
      eye = away;
    }
    worst = std::max(worst, std::abs(eye - z));
  }
  return worst;
}

DepthBound::Separation DepthBound::separation(double z, const DepthBudget& budget) const {
  // The longest step of storage between the two surfaces with the datapath's errors: towards far, or towards near if
  // reversed. A float's steps double on the way.
  const double d = scale_.d_of_z(z);
  const Separation plain = separation(z, budget, half_step(d));
  if (!format_.is_float() || std::isinf(plain.total())) return plain;
  const double reach = is_reversed_ ? z - (plain.datapath + plain.snap) : z + plain.total();
  const double longest = half_step(std::clamp(scale_.d_of_z(std::max(reach, scale_.near())), 0.0, 1.0));
  return separation(z, budget, std::max(half_step(d), longest));
}

DepthBound::Separation DepthBound::separation(double z, const DepthBudget& budget, double half_step) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double away = is_reversed_ ? -1 : 1;
  const auto moved_t = [&](double from, double distance) {
    const double eye = scale_.z_of_t(scale_.t_of_z(from) + away * distance);
    return eye > 0 ? eye : kNever;
  };
  const double stored = scale_.z_of_d(scale_.d_of_z(z) + away * 2 * half_step);
  if (!(stored > 0) || std::isinf(stored)) return {kNever, 0, 0};
  // Flat surfaces of plane codes are rounded once, by the snap, which is the storage. Otherwise the snap of Z and the
  // interpolation are added, twice; so is the rounding if codes are rounded again.
  const bool is_single_rounding = is_identity_ && budget.rounding == 0;
  const double datapath = is_single_rounding ? 0 : 2 * (budget.datapath + (is_identity_ ? 0 : budget.rounding));
  const double through = moved_t(stored, datapath), snapped = moved_t(through, 2 * budget.snap);
  if (snapped > scale_.far()) return {kNever, 0, 0};
  return {stored - z, through - stored, snapped - through};
}

double DepthBound::screen_slope(double z, double slope, double pixel) const {
  // dz per pixel is z * pixel * slope; dt = t_per_inverse_z * dz / z^2.
  return std::abs(scale_.t_per_inverse_z()) * slope * pixel / z;
}

}  // namespace halfplane
