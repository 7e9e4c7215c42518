// Attributes over w: texture coordinates and colours that are linear on the surface, not in the window.
//
// u / w and 1 / w are linear in the window, so both are planes, Q for 1/w and P for each attribute over w, and a pixel
// divides: u = P / Q. Four decisions keep the integers short:
//   base       planes start at the vertex of smallest Q. The error of the reciprocal of the area grows with Q - Q_0, and
//              and is then a fraction of the Q that divides
//   centre     a coordinate is taken from u_ref, an integer near the middle of its three values
//   P from Q   P_i = u'_i Q_i with the rounded Q_i, so that at a vertex the rounding of Q cancels
//   value      the pixel's reciprocal is a floor of a short quotient (reciprocal.hpp), whatever algorithm computes it
//
// Host, binary64   Q_i = floor(2^e / w_i + 1/2) in [1, 2^N), u' = u - u_ref, P_i = floor(u'_i Q_i 2^-sp + 1/2),
//                  2^x > every |u'|
// Setup            the gradients of triangle_setup, modulo 2^(N+1+F) and 2^(N_P+2+F)
// Tile             anchors and steps of l fraction bits, as of depth: Q without sign modulo 2^(N+1+l), P with one modulo
//                  2^(N_P+2+l). A covered sample has Q between the vertices', so both decode as they are
// Pixel            e = floor(log2 Q), m the highest k bits of Q, r(m) its reciprocal,
//                  Pn = P 2^-(e+1+x-sp-k_P) rounded, clamped to k_P bits and a sign,
//                  U = floor(Pn r 2^-(k+k_P-1-x-f) + 1/2), in 2^-f texels or LSB of the colour
// An uncovered sample has no value; engines that carry one carry 0.
#pragma once

#include <array>
#include <cstdint>

#include "../widths.hpp"
#include "interpolate.hpp"
#include "triangle_setup.hpp"

namespace halfplane {

/// Precision of an attribute over w.
struct OverWFormat {
  int bits = 22;           ///< N_P: magnitude bits of P
  int narrow_bits = 17;    ///< k_P: magnitude bits of P, normalised for the product
  int fraction_bits = 8;   ///< f: of the result
  bool is_centred = true;  ///< there is a u_ref
};

/// Precision of a configuration's attributes over w. The default is that of `embedded`.
struct PerspectiveFormat {
  int q_bits = 22;           ///< N
  int guard_bits = 4;        ///< l: fraction bits inside a tile
  int mantissa_bits = 18;    ///< k: leading bits of q used by the reciprocal
  int reciprocal_bits = 20;  ///< r: significant bits of the reciprocal of the area
  OverWFormat coordinate{};
  OverWFormat color{18, 13, 0, false};
};

inline constexpr PerspectiveFormat kTinyPerspective{16, 4, 14, 14, {16, 13, 6, true}, {16, 13, 0, false}};
inline constexpr PerspectiveFormat kEmbeddedPerspective{};
inline constexpr PerspectiveFormat kFullPerspective{26, 4, 18, 28, {26, 17, 8, true}, {18, 13, 0, false}};
/// `full` for textures of 4096 texels.
inline constexpr PerspectiveFormat kFull4096Perspective{26, 4, 20, 28, {26, 19, 8, true}, {18, 13, 0, false}};

/// Largest x: coordinates farther than 2^20 from u_ref are clamped. A pixel's result is then 16 texels coarse or worse.
inline constexpr int kMaxReach = 20;
/// The clamp: slightly less, so that rounding stays within the reach.
inline constexpr double kFarthestCoordinate = (1 << kMaxReach) * (1 - 0x1p-9);

/// The bits of Q and P, over the whole triangle and inside a tile.
[[nodiscard]] constexpr int q_plane_bits(const PerspectiveFormat& format, const Widths& widths) {
  return format.q_bits + 1 + widths.plane_fraction;
}
[[nodiscard]] constexpr int p_plane_bits(const OverWFormat& attribute, const Widths& widths) {
  return attribute.bits + 2 + widths.plane_fraction;
}
[[nodiscard]] constexpr int q_local_bits(const PerspectiveFormat& format) {
  return format.q_bits + 1 + format.guard_bits;
}
[[nodiscard]] constexpr int p_local_bits(const OverWFormat& attribute, const PerspectiveFormat& format) {
  return attribute.bits + 2 + format.guard_bits;
}

/// Error bound of a coordinate, in texels, to first order: an attribute that spans `extent` texels over a triangle
/// whose largest w is `w_ratio` times its smallest. `roundings`: plane_roundings(). Without a u_ref: from 0 to
/// `extent`.
[[nodiscard]] double coordinate_error_bound(double extent, double w_ratio, const PerspectiveFormat& format,
                                            const OverWFormat& attribute, int roundings);
/// Error bound of a texture coordinate: A rho 2^-N (1.5 + 3 delta) + A (2^-r + 3.5 * 2^-k) + 2^-(f+1).
[[nodiscard]] inline double coordinate_error_bound(double extent, double w_ratio, const PerspectiveFormat& format,
                                                   int roundings) {
  return coordinate_error_bound(extent, w_ratio, format, format.coordinate, roundings);
}

// ---- Host

using QCodes = std::array<std::uint32_t, 3>;  ///< Q_i of the vertices

/// Q_i, the largest with N = `bits` bits. w > 0.
[[nodiscard]] QCodes quantize_q(const std::array<double, 3>& w, int bits);
/// Its e: Q_i is 2^e / w_i, rounded.
[[nodiscard]] int q_exponent(const std::array<double, 3>& w, int bits);

/// One attribute of a triangle at the entry of setup.
struct OverW {
  std::array<std::int64_t, 3> p{};  ///< P_i, units of 2^sp
  int reach = 0;                    ///< x, 0 to kMaxReach
  int exponent = 0;                 ///< sp, at least x - 1 - N_P
  double reference = 0;             ///< u_ref, an integer
};

/// P_i of an attribute's values at the vertices, texels or LSB of a colour.
[[nodiscard]] OverW quantize_over_w(const std::array<double, 3>& value, const QCodes& q, const OverWFormat& attribute);

// ---- Setup

/// Constants common to the planes over w of one triangle.
struct PerspectiveFrame {
  std::array<std::size_t, 3> order{};  ///< of the canonical vertices: the base, then the others in turn
  PlaneFrame frame{};
  Reciprocal reciprocal;  ///< of the area, r bits
};

/// The first vertex with the smallest Q.
[[nodiscard]] std::size_t base_vertex(const QCodes& q);

/// `v`: the vertices in canonical order; `setup`: their box and area.
[[nodiscard]] PerspectiveFrame perspective_frame(const std::array<SnappedVertex, 3>& v, std::size_t base,
                                                 const TriangleSetup& setup, const PerspectiveFormat& format,
                                                 const Widths& widths);

/// The planes of Q and of an attribute over w. Codes in canonical order.
[[nodiscard]] Plane setup_q(const QCodes& q, const PerspectiveFrame& frame, const PerspectiveFormat& format,
                            const Widths& widths);
[[nodiscard]] Plane setup_over_w(const OverW& over_w, const PerspectiveFrame& frame, const OverWFormat& attribute,
                                 const Widths& widths);

// ---- Tile

/// Q and P at a pixel, evaluated in its tile: 2^-l codes.
[[nodiscard]] std::uint64_t q_at(const Plane& plane, const PixelPlace& place, const PerspectiveFormat& format,
                                 const Widths& widths);
[[nodiscard]] std::int64_t p_at(const Plane& plane, const PixelPlace& place, const OverWFormat& attribute,
                                const PerspectiveFormat& format, const Widths& widths);

// ---- Pixel

/// 1 / Q of a pixel, common to all its attributes. Q is d 2^(exponent-k), d = 2m + 1, up to truncation.
struct PixelReciprocal {
  int exponent = 0;              ///< e
  std::uint32_t reciprocal = 0;  ///< r(m)
};

/// Precondition: q > 0, as at every covered sample.
[[nodiscard]] PixelReciprocal divide_by_q(std::uint64_t q, const PerspectiveFormat& format);

/// The binary points of an attribute, as hardware gets them: c = 1 + x - sp - k_P, and x. P is narrowed by 2^-(e+c); c
/// >= 1 - k_P where P has the bits of Q, as coordinates have.
struct OverWScale {
  int shift = 0, reach = 0;
};
[[nodiscard]] constexpr OverWScale over_w_scale(const OverW& over_w, const OverWFormat& attribute) {
  return {1 + over_w.reach - over_w.exponent - attribute.narrow_bits, over_w.reach};
}

/// Pn: P normalised by Q, in [-2^k_P, 2^k_P). It is clamped only where |u'| exceeds 2^x.
[[nodiscard]] std::int64_t narrow_p(std::int64_t p, const PixelReciprocal& q, const OverWScale& scale,
                                    const OverWFormat& attribute);
[[nodiscard]] inline std::int64_t narrow_p(std::int64_t p, const PixelReciprocal& q, const OverW& over_w,
                                           const OverWFormat& attribute) {
  return narrow_p(p, q, over_w_scale(over_w, attribute), attribute);
}

/// U: the attribute less u_ref, in 2^-f. |U| <= 2^(x+1+f).
[[nodiscard]] std::int64_t over_q(std::int64_t p, const PixelReciprocal& q, const OverWScale& scale,
                                  const OverWFormat& attribute, const PerspectiveFormat& format);
[[nodiscard]] inline std::int64_t over_q(std::int64_t p, const PixelReciprocal& q, const OverW& over_w,
                                         const OverWFormat& attribute, const PerspectiveFormat& format) {
  return over_q(p, q, over_w_scale(over_w, attribute), attribute, format);
}

/// A colour's code, clamped to the range of the vertices' codes.
[[nodiscard]] constexpr std::uint32_t color_over_q(std::int64_t u, std::uint32_t low, std::uint32_t high) {
  return u < static_cast<std::int64_t>(low)    ? low
         : u > static_cast<std::int64_t>(high) ? high
                                               : static_cast<std::uint32_t>(u);
}

}  // namespace halfplane
