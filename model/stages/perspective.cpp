#include "perspective.hpp"

#include <algorithm>
#include <cmath>

#include "../binary64.hpp"
#include "reciprocal.hpp"

namespace halfplane {
namespace {

/// A plane at a pixel, narrowed at its tile's anchor: 2^-l codes, modulo 2^64.
std::uint64_t value_at(const Plane& plane, const PixelPlace& place, int bits, const PerspectiveFormat& format,
                       const Widths& widths) {
  const PlaneValue anchor = plane_at_tile(plane, place.tile, bits);
  const auto local = narrow_plane<std::uint64_t>(anchor, plane, format.guard_bits, widths);
  return local.anchor + place.i * local.step_x + place.j * local.step_y;
}

/// 2^e / w, rounded.
std::uint32_t q_code(double w, int e) {
  const int exponent = floor_log2_of(w) + 1;  // w = mantissa 2^exponent, 1/2 <= mantissa < 1
  const double mantissa = scaled(w, -exponent);
  return static_cast<std::uint32_t>(snap(1 / mantissa, power_of_two(e - exponent)));
}

}  // namespace

double coordinate_error_bound(double extent, double w_ratio, const PerspectiveFormat& format,
                              const OverWFormat& attribute, int roundings) {
  // The largest |u'|: half the extent plus the distance of u_ref, an integer, from the middle; the whole extent without
  // a u_ref.
  const double reach = attribute.is_centred ? extent / 2 + 1 : extent;
  const double delta = std::ldexp(roundings + 1, -format.guard_bits - 1) + std::ldexp(1.0, -5);  // of a plane, codes
  const double smallest_q = std::ldexp(1.0, format.q_bits - 1) / w_ratio;
  const double p_code = 2 * reach * std::ldexp(1.0, format.q_bits - attribute.bits);  // 2^sp at most
  const double planes = extent / 4                         // Q_i rounded: shifts the weights of the vertices
                        + reach * delta                    // the plane of Q
                        + p_code * (0.5 + delta);          // P_i rounded, and its plane
  return planes / smallest_q                               //
         + std::ldexp(extent, -format.reciprocal_bits)     // the reciprocal of the area, from the smallest Q
         + std::ldexp(3 * reach, -format.mantissa_bits)    // m truncated, r a floor
         + std::ldexp(2 * reach, -attribute.narrow_bits)   // Pn
         + std::ldexp(1.0, -attribute.fraction_bits - 1);  // the result
}

int q_exponent(const std::array<double, 3>& w, int bits) {
  const double nearest = std::min({w[0], w[1], w[2]});
  const int e = bits + floor_log2_of(nearest);
  return e - (q_code(nearest, e) >> bits != 0 ? 1 : 0);
}

QCodes quantize_q(const std::array<double, 3>& w, int bits) {
  const int e = q_exponent(w, bits);
  QCodes q{};
  for (std::size_t i = 0; i < 3; ++i) q[i] = std::max(1U, q_code(w[i], e));
  return q;
}

OverW quantize_over_w(const std::array<double, 3>& value, const QCodes& q, const OverWFormat& attribute) {
  OverW result;
  const auto [low, high] = std::minmax({value[0], value[1], value[2]});
  if (attribute.is_centred) result.reference = std::floor(low / 2 + high / 2);
  std::array<double, 3> product{};  // u'_i Q_i
  double farthest = 0, largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double u = std::clamp(value[i] - result.reference, -kFarthestCoordinate, kFarthestCoordinate);
    product[i] = u * q[i];
    farthest = std::max(farthest, std::abs(u));
    largest = std::max(largest, std::abs(product[i]));
  }
  const auto bits_above_point = [](double number) { return number < 1 ? 0 : floor_log2_of(number) + 1; };
  result.reach = bits_above_point(farthest * (1 + 0x1p-10));
  // If all products are tiny, P needs no more bits than the result shows.
  const int largest_bits = largest > 0 ? floor_log2_of(largest) + 1 : result.reach - 1;
  result.exponent = std::max(largest_bits, result.reach - 1) - attribute.bits;
  const auto codes = [&] {
    for (std::size_t i = 0; i < 3; ++i) result.p[i] = snap(product[i], power_of_two(-result.exponent));
  };
  codes();
  const auto is_too_large = [&](std::int64_t p) { return std::abs(p) >> attribute.bits != 0; };
  if (std::any_of(result.p.begin(), result.p.end(), is_too_large)) {
    ++result.exponent;
    codes();
  }
  return result;
}

std::size_t base_vertex(const QCodes& q) {
  return static_cast<std::size_t>(std::min_element(q.begin(), q.end()) - q.begin());
}

PerspectiveFrame perspective_frame(const std::array<SnappedVertex, 3>& v, std::size_t base, const TriangleSetup& setup,
                                   const PerspectiveFormat& format, const Widths& widths) {
  const std::array order{base, (base + 1) % 3, (base + 2) % 3};
  const auto first_of_tile = [&widths](int pixel) { return pixel >> widths.tile_shift << widths.tile_shift; };
  return {order,
          plane_frame(v[order[0]], v[order[1]], v[order[2]], first_of_tile(setup.left), first_of_tile(setup.top),
                      1 << widths.tile_shift, widths),
          reciprocal(setup.area, format.reciprocal_bits)};
}

Plane setup_q(const QCodes& q, const PerspectiveFrame& frame, const PerspectiveFormat& format, const Widths& widths) {
  const auto& [base, next, last] = frame.order;
  return setup_plane(q[base], q[next], q[last], frame.frame, frame.reciprocal, q_plane_bits(format, widths));
}

Plane setup_over_w(const OverW& over_w, const PerspectiveFrame& frame, const OverWFormat& attribute,
                   const Widths& widths) {
  const auto& [base, next, last] = frame.order;
  return setup_plane(over_w.p[base], over_w.p[next], over_w.p[last], frame.frame, frame.reciprocal,
                     p_plane_bits(attribute, widths));
}

std::uint64_t q_at(const Plane& plane, const PixelPlace& place, const PerspectiveFormat& format, const Widths& widths) {
  return wrap_unsigned(value_at(plane, place, q_plane_bits(format, widths), format, widths), q_local_bits(format));
}

std::int64_t p_at(const Plane& plane, const PixelPlace& place, const OverWFormat& attribute,
                  const PerspectiveFormat& format, const Widths& widths) {
  const std::uint64_t value = value_at(plane, place, p_plane_bits(attribute, widths), format, widths);
  return wrap_signed(static_cast<std::int64_t>(value), p_local_bits(attribute, format));
}

PixelReciprocal divide_by_q(std::uint64_t q, const PerspectiveFormat& format) {
  const int k = format.mantissa_bits, e = floor_log2(q);
  const std::uint64_t mantissa = e < k ? q << (k - 1 - e) : q >> (e - k + 1);
  return {e, mantissa_reciprocal(static_cast<std::uint32_t>(mantissa), k)};
}

std::int64_t narrow_p(std::int64_t p, const PixelReciprocal& q, const OverWScale& scale, const OverWFormat& attribute) {
  const std::int64_t limit = std::int64_t{1} << attribute.narrow_bits;
  return std::clamp(round_shift(p, q.exponent + scale.shift), -limit, limit - 1);
}

std::int64_t over_q(std::int64_t p, const PixelReciprocal& q, const OverWScale& scale, const OverWFormat& attribute,
                    const PerspectiveFormat& format) {
  const int drop = format.mantissa_bits + attribute.narrow_bits - 1 - scale.reach - attribute.fraction_bits;
  return round_shift(narrow_p(p, q, scale, attribute) * q.reciprocal, drop);
}

}  // namespace halfplane
