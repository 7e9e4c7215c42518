#include "homogeneous_setup.hpp"

#include <cmath>
#include <tuple>
#include <utility>

#include "../host/viewport.hpp"
#include "../stages/cull.hpp"

namespace halfplane {
namespace {

/// A vertex in window coordinates times w, all scaled by a power of two common to the triangle.
struct Corner {
  double x = 0, y = 0, w = 0;      ///< pixels
  double z = 0;                    ///< window depth, 0...1
  double near = 0, far = 0;        ///< distances: not negative inside
  PerPlane<std::uint32_t> code{};  ///< of the planes except depth
};

/// a x + b y + c in pixels, before rounding.
struct Line {
  double a = 0, b = 0, c = 0;
  [[nodiscard]] double at(double x, double y) const { return a * x + b * y + c; }
};

using Corners = std::array<Corner, 3>;
using Lines = std::array<Line, 3>;

/// Exchanged ends negate each coefficient exactly: products commute, and p - q = -(q - p) in binary64.
Line cross(const Corner& p, const Corner& q) {
  return {p.y * q.w - q.y * p.w, p.w * q.x - q.w * p.x, p.x * q.y - q.x * p.y};
}

Corner to_corner(const Vertex& v, int exponent, const HomogeneousFrame& frame) {
  const auto scaled = [exponent](double value) { return std::ldexp(value, -exponent); };
  const Viewport& vp = frame.viewport;
  const double x = scaled(v.x), y = scaled(v.y), z = scaled(v.z), w = scaled(v.w);
  const bool is_zero_one = frame.state.clip_z == ClipZ::zero_one;
  const auto [low, high] = frame.state.depth_range;
  Corner corner{vp.x * w + (x + w) / 2 * vp.width, vp.y * w + (w - y) / 2 * vp.height, w, 0, 0, 0, {}};
  corner.z = low * w + (high - low) * (is_zero_one ? z : (z + w) / 2);
  corner.near = is_zero_one ? z : z + w;
  corner.far = w - z;
  corner.code = snap_codes(0, v, frame.config);
  return corner;
}

/// The largest coordinate decides the scale, so that a product of three stays in the range of binary64.
Corners to_corners(const std::array<Vertex, 3>& v, const HomogeneousFrame& frame) {
  double largest = 0;
  for (const Vertex& vertex : v)
    for (const double c : {vertex.x, vertex.y, vertex.z, vertex.w}) largest = std::max(largest, std::abs(c));
  const int exponent = largest > 0 ? std::ilogb(largest) : 0;
  return {to_corner(v[0], exponent, frame), to_corner(v[1], exponent, frame), to_corner(v[2], exponent, frame)};
}

/// Sorts by position: sums of three depend on their order in the last bit. Returns whether the facing was reversed.
bool sort_corners(Corners& v) {
  bool is_turned = false;
  const auto order = [&](std::size_t i, std::size_t j) {
    const auto key = [](const Corner& c) { return std::tie(c.y, c.x, c.w, c.z); };
    if (!(key(v[j]) < key(v[i]))) return;
    std::swap(v[i], v[j]);
    is_turned = !is_turned;
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return is_turned;
}

/// Rounds away from zero at 1/2: a negated value gives the negated integer.
std::int64_t round_symmetric(double value) { return static_cast<std::int64_t>(std::round(value)); }

/// The integer function of a line, at pixel centres. The larger slope keeps m bits; far away, c only has to keep its
/// sign.
LinearFunction to_bound(const Line& line, const HomogeneousWidths& widths) {
  const double slope = std::max(std::abs(line.a), std::abs(line.b));
  const double at_first = line.c + (line.a + line.b) / 2;  // at the centre of pixel (0, 0)
  const auto limit = static_cast<double>(widths.offset.range.hi);
  if (slope == 0)
    return {0, 0, static_cast<std::int64_t>(std::copysign(limit, at_first))};  // through two points at infinity
  const int shift = widths.fraction - 1 - std::ilogb(slope);
  return {round_symmetric(std::ldexp(line.a, shift)), round_symmetric(std::ldexp(line.b, shift)),
          round_symmetric(std::clamp(std::ldexp(at_first, shift), -limit, limit))};
}

/// Top-left rule: samples on a left edge (a > 0) or a top edge (level, inside below it) belong to the triangle.
LinearFunction to_edge(const Line& line, const HomogeneousWidths& widths) {
  LinearFunction edge = to_bound(line, widths);
  edge.c -= edge.a > 0 || (edge.a == 0 && edge.b > 0) ? 0 : 1;
  return edge;
}

/// sum e_i f_i, f linear in clip space: f / w, times the determinant.
template <class Value>
Line blend(const Lines& e, const Corners& v, Value&& value) {
  const double f0 = value(v[0]), f1 = value(v[1]), f2 = value(v[2]);
  return {e[0].a * f0 + e[1].a * f1 + e[2].a * f2, e[0].b * f0 + e[1].b * f1 + e[2].b * f2,
          e[0].c * f0 + e[1].c * f1 + e[2].c * f2};
}

/// value * 2^fraction, rounded, modulo 2^bits. std::remainder is exact.
std::int64_t residue(double value, int fraction, int bits) {
  const double modulus = std::ldexp(1.0, bits);
  const double rest = std::remainder(std::floor(std::ldexp(value, fraction) + 0.5), modulus);
  return wrap_signed(static_cast<std::int64_t>(rest), bits);  // rest may be +modulus / 2
}

/// The plane of triangle_setup: value at the anchor of the first tile, steps per subpixel.
Plane to_plane(const Line& codes, const TriangleSetup& box, const HomogeneousFrame& frame, int bits) {
  const Widths& w = frame.widths;
  const auto anchor = [&](int first) {
    const int centre = (first >> w.tile_shift << w.tile_shift) + frame.config.tile_size / 2;
    return centre + 0.5;
  };
  return {residue(codes.at(anchor(box.left), anchor(box.top)), w.plane_fraction, bits),
          residue(codes.a, w.guard_bits, bits), residue(codes.b, w.guard_bits, bits)};
}

/// Target pixels around the vertices, one more on each side; all of them if a vertex has no window position.
void set_box(TriangleSetup& box, const Corners& v, bool is_in_front, const Rect& rect) {
  box.left = rect.x;
  box.top = rect.y;
  box.right = rect.x + rect.width - 1;
  box.bottom = rect.y + rect.height - 1;
  if (!is_in_front) return;
  // A rounded edge moves by half a subpixel, half a pixel at most: the wider box always contains it.
  const auto narrow = [&v](int& first, int& last, double Corner::*position) {
    const auto at = [&](const Corner& c) { return c.*position / c.w; };
    const auto [low, high] = std::minmax({at(v[0]), at(v[1]), at(v[2])});
    const double one_before = first - 1, one_after = last + 1;
    first = std::max(first, static_cast<int>(std::clamp(std::ceil(low - 1.5), one_before, one_after)));
    last = std::min(last, static_cast<int>(std::clamp(std::floor(high + 0.5), one_before, one_after)));
  };
  narrow(box.left, box.right, &Corner::x);
  narrow(box.top, box.bottom, &Corner::y);
}

void set_depth(HomogeneousSetup& setup, const Lines& e, const Corners& v, double determinant, bool is_in_front,
               const HomogeneousFrame& frame) {
  const int bits = frame.config.depth_bits;
  const double top = std::ldexp(1.0, bits) - 1;
  const Line z = blend(e, v, [&](const Corner& c) { return c.z / determinant * top; });
  setup.triangle.plane[kDepthPlane] = to_plane(z, setup.triangle, frame, frame.widths.depth().plane.bits);
  CodeRange& range = setup.triangle.range;
  const auto [a, b] = std::minmax(frame.state.depth_range[0], frame.state.depth_range[1]);
  const auto code = [&, low = a, high = b](double depth) { return snap_depth(std::clamp(depth, low, high), bits); };
  std::tie(range.low[kDepthPlane], range.high[kDepthPlane]) = std::pair(code(a), code(b));
  if (is_in_front)
    std::tie(range.low[kDepthPlane], range.high[kDepthPlane]) =
        std::minmax({code(v[0].z / v[0].w), code(v[1].z / v[1].w), code(v[2].z / v[2].w)});
  const auto& [factor, constant] = frame.state.polygon_offset;
  const double offset = factor * std::max(std::abs(z.a), std::abs(z.b)) + constant;
  setup.depth_offset = snap(std::clamp(offset, -top, top), 1.0);  // enough to reach either end from the other
}

/// Scales 1 / w and colour / w by one factor, so that their quotient keeps its value: by the largest magnitude of the
/// sum of weights at a corner of the box or of a step.
void set_perspective(HomogeneousSetup& setup, const Lines& e, const Corners& v, const HomogeneousFrame& frame) {
  const TriangleSetup& box = setup.triangle;
  double largest = 0;
  const auto include = [&](auto&& part) {
    largest = std::max(largest, std::abs(part(e[0])) + std::abs(part(e[1])) + std::abs(part(e[2])));
  };
  for (const int x : {box.left, box.right})
    for (const int y : {box.top, box.bottom}) include([&](const Line& line) { return line.at(x + 0.5, y + 0.5); });
  include([](const Line& line) { return line.a; });
  include([](const Line& line) { return line.b; });
  const int shift = frame.homogeneous.weight_scale - 1 - std::ilogb(largest);
  const auto scaled = [&](auto&& value) {
    const Line line = blend(e, v, value);
    const auto round = [shift](double f) { return round_symmetric(std::ldexp(f, shift)); };
    return LinearFunction{round(line.a), round(line.b), round(line.at(box.left + 0.5, box.top + 0.5))};
  };
  setup.weight = scaled([](const Corner&) { return 1.0; });
  for (std::size_t p = kColorPlane; p < static_cast<std::size_t>(frame.widths.affine_planes); ++p)
    setup.code_weight[p] = scaled([p](const Corner& corner) { return static_cast<double>(corner.code[p]); });
}

/// Sets every plane except depth.
void set_attributes(HomogeneousSetup& setup, const Lines& e, const Corners& v, double determinant,
                    const HomogeneousFrame& frame) {
  TriangleSetup& triangle = setup.triangle;
  for (std::size_t p = kColorPlane; p < static_cast<std::size_t>(frame.widths.affine_planes); ++p) {
    std::tie(triangle.range.low[p], triangle.range.high[p]) = std::minmax({v[0].code[p], v[1].code[p], v[2].code[p]});
    if (!setup.is_perspective)
      triangle.plane[p] = to_plane(blend(e, v, [&](const Corner& c) { return c.w / determinant * c.code[p]; }),
                                   triangle, frame, frame.widths.of_plane(p).plane.bits);
  }
  if (setup.is_perspective) set_perspective(setup, e, v, frame);
}

bool all_of(const Corners& v, bool (*holds)(const Corner&)) { return holds(v[0]) && holds(v[1]) && holds(v[2]); }

HomogeneousSetup rejected(Rejection rejection) {
  HomogeneousSetup setup;
  setup.rejection = rejection;
  return setup;
}

}  // namespace

HomogeneousSetup setup_homogeneous(const std::array<Vertex, 3>& vertices, const HomogeneousFrame& frame) {
  // Part of the definition, for any --skip: rounded edges of outside triangles could graze the border.
  unsigned outside = ~0U;
  for (const Vertex& vertex : vertices) outside &= outcode(frame.view_volume, vertex);
  Corners v = to_corners(vertices, frame);
  if (outside != 0 || all_of(v, [](const Corner& c) { return !(c.w > 0); })) return rejected(Rejection::outside);

  const bool is_turned = sort_corners(v);
  Lines e{cross(v[1], v[2]), cross(v[2], v[0]), cross(v[0], v[1])};
  double determinant = e[0].a * v[0].x + e[0].b * v[0].y + e[0].c * v[0].w;
  // Smaller than any other: its reciprocal must stay finite.
  if (!(std::abs(determinant) > 1e-200)) return rejected(Rejection::zero_area);
  const int facing = (determinant > 0) == is_turned ? -1 : 1;  // 1: clockwise as seen
  if (cull(facing, frame.state) != CullResult::keep) return rejected(Rejection::backface);
  if (determinant < 0) {
    determinant = -determinant;
    for (Line& line : e) line = {-line.a, -line.b, -line.c};
  }

  HomogeneousSetup setup;
  const bool is_in_front = all_of(v, [](const Corner& c) { return c.w > 0; });
  set_box(setup.triangle, v, is_in_front, frame.rect);
  if (setup.triangle.is_empty()) return rejected(Rejection::empty);
  for (std::size_t i = 0; i < 3; ++i) setup.bound[i] = to_edge(e[i], frame.homogeneous);
  // A plane with all vertices inside cuts nothing: its bound stays 0, which is never negative.
  if (!all_of(v, [](const Corner& c) { return c.near >= 0; }))
    setup.bound[3] = to_bound(blend(e, v, [](const Corner& c) { return c.near; }), frame.homogeneous);
  if (!all_of(v, [](const Corner& c) { return c.far >= 0; }))
    setup.bound[4] = to_bound(blend(e, v, [](const Corner& c) { return c.far; }), frame.homogeneous);
  setup.is_back = shows_back(facing, frame.state.front);
  set_depth(setup, e, v, determinant, is_in_front, frame);
  setup.is_perspective = !is_in_front;
  set_attributes(setup, e, v, determinant, frame);
  return setup;
}

Interpolated interpolate_at(const HomogeneousSetup& setup, const Widths& widths, int x, int y) {
  const TriangleSetup& triangle = setup.triangle;
  Interpolated result = interpolate_at(triangle, widths, x, y);
  const std::int64_t moved = result.code[kDepthPlane] + setup.depth_offset,
                     largest = static_cast<std::int64_t>(widths.depth().code.range.hi);
  result.code[kDepthPlane] = static_cast<std::uint32_t>(std::clamp<std::int64_t>(moved, 0, largest));
  if (!setup.is_perspective) return result;
  const int i = x - triangle.left, j = y - triangle.top;
  const std::int64_t weight = std::max<std::int64_t>(1, setup.weight.at(i, j));  // positive except for rounding
  for (std::size_t p = kColorPlane; p < static_cast<std::size_t>(widths.affine_planes); ++p) {
    const std::int64_t code = std::max<std::int64_t>(0, setup.code_weight[p].at(i, j));
    result.code[p] = static_cast<std::uint32_t>(
        std::clamp<std::int64_t>((2 * code + weight) / (2 * weight), triangle.range.low[p], triangle.range.high[p]));
  }
  return result;
}

}  // namespace halfplane
