#include "triangle_setup.hpp"

#include <algorithm>
#include <tuple>

#include "cull.hpp"

namespace halfplane {
namespace {

/// Positive area and smallest (Y, X, Z) first: all six orders of the vertices become one.
std::array<SnappedVertex, 3> canonical(const std::array<SnappedVertex, 3>& v, std::int64_t area) {
  const auto first = static_cast<std::size_t>(std::min_element(v.begin(), v.end(), canonically_before) - v.begin());
  std::array<SnappedVertex, 3> order{v[first], v[(first + 1) % 3], v[(first + 2) % 3]};
  if (area < 0) std::swap(order[1], order[2]);
  return order;
}

/// What the planes of one triangle share.
struct PlaneFrame {
  std::int64_t ax, ay, bx, by;  ///< v1 - v0 and v2 - v0, subpixels
  std::int64_t dx, dy;          ///< from v0 to the anchor, subpixels
  Reciprocal reciprocal;
  int fraction;  ///< F
};

PlaneValue gradient(std::int64_t numerator, const PlaneFrame& frame) {
  const int128 product = static_cast<int128>(numerator) * static_cast<int128>(frame.reciprocal.value);
  return static_cast<PlaneValue>(round_shift(product, frame.reciprocal.shift - frame.fraction));  // modulo 2^64
}

Plane setup_plane(std::int64_t c0, std::int64_t c1, std::int64_t c2, const PlaneFrame& f, int bits) {
  const std::int64_t ac = c1 - c0, bc = c2 - c0;
  const auto wrap = [bits](std::uint64_t value) { return wrap_signed(static_cast<std::int64_t>(value), bits); };
  Plane plane;
  plane.step_x = wrap(static_cast<std::uint64_t>(gradient(ac * f.by - bc * f.ay, f)));
  plane.step_y = wrap(static_cast<std::uint64_t>(gradient(f.ax * bc - f.bx * ac, f)));
  // Unsigned arithmetic: the products wrap modulo 2^64, and the plane is a residue of that.
  plane.value = wrap((static_cast<std::uint64_t>(c0) << f.fraction) +
                     static_cast<std::uint64_t>(plane.step_x) * static_cast<std::uint64_t>(f.dx) +
                     static_cast<std::uint64_t>(plane.step_y) * static_cast<std::uint64_t>(f.dy));
  return plane;
}

}  // namespace

Reciprocal reciprocal(std::int64_t area, int significant_bits) {
  if (area <= 0) return {};
  const int shift = floor_log2(static_cast<uint128>(area)) + significant_bits;
  const auto divisor = static_cast<std::uint64_t>(area);
  // One quotient bit more than is kept, then the pipeline's rounding.
  const std::uint64_t quotient =
      shift < 63 ? (std::uint64_t{2} << shift) / divisor : static_cast<std::uint64_t>((uint128{2} << shift) / divisor);
  return {round_shift(quotient, 1), shift};
}

void set_box(TriangleSetup& setup, const std::array<SnappedVertex, 3>& v, const Rect& rect, int grid_bits) {
  const std::int32_t half = std::int32_t{1} << (grid_bits - 1);
  const auto [x_min, x_max] = std::minmax({v[0].x, v[1].x, v[2].x});
  const auto [y_min, y_max] = std::minmax({v[0].y, v[1].y, v[2].y});
  // First pixel whose centre is >= min, last whose centre is <= max.
  setup.left = std::max(rect.x, (x_min + half - 1) >> grid_bits);
  setup.top = std::max(rect.y, (y_min + half - 1) >> grid_bits);
  setup.right = std::min(rect.x + rect.width - 1, (x_max - half) >> grid_bits);
  setup.bottom = std::min(rect.y + rect.height - 1, (y_max - half) >> grid_bits);
}

TriangleSetup setup_triangle(const Triangle& triangle, const Config& config, const Widths& widths, const Rect& rect) {
  TriangleSetup setup;
  setup.primitive = triangle.primitive;
  const std::int64_t area = signed_area(triangle.v[0], triangle.v[1], triangle.v[2]);
  if (area == 0) return setup;
  const auto v = canonical(triangle.v, area);
  const int s = widths.grid_bits;
  setup.area = area < 0 ? -area : area;
  set_box(setup, v, rect, s);
  const int first_x = setup.left >> widths.tile_shift << widths.tile_shift;  // first pixel of the first tile
  const int first_y = setup.top >> widths.tile_shift << widths.tile_shift;

  for (std::size_t i = 0; i < 3; ++i) {
    const SnappedVertex &from = v[i], &to = v[(i + 1) % 3];
    setup.edge[i] = {to.x - from.x, to.y - from.y, edge_function(from, to, first_x, first_y, s)};
  }

  const auto anchor = [&](int first) {  // centre of pixel first + T/2, subpixels
    return (std::int64_t{first + config.tile_size / 2} << s) + (std::int64_t{1} << (s - 1));
  };
  const PlaneFrame frame{std::int64_t{v[1].x} - v[0].x,
                         std::int64_t{v[1].y} - v[0].y,
                         std::int64_t{v[2].x} - v[0].x,
                         std::int64_t{v[2].y} - v[0].y,
                         anchor(first_x) - v[0].x,
                         anchor(first_y) - v[0].y,
                         reciprocal(setup.area, config.depth_bits + config.reciprocal_extra_bits),
                         widths.plane_fraction};
  setup.depth = setup_plane(v[0].z, v[1].z, v[2].z, frame, widths.depth_plane.bits);
  std::tie(setup.depth_min, setup.depth_max) = std::minmax({v[0].z, v[1].z, v[2].z});
  for (std::size_t c = 0; c < 4; ++c) {
    setup.color[c] = setup_plane(v[0].rgba[c], v[1].rgba[c], v[2].rgba[c], frame, widths.color_plane.bits);
    std::tie(setup.color_min[c], setup.color_max[c]) = std::minmax({v[0].rgba[c], v[1].rgba[c], v[2].rgba[c]});
  }
  return setup;
}

TriangleSetup setup_triangle(const Triangle& triangle, const Config& config, const Widths& widths) {
  return setup_triangle(triangle, config, widths,
                        {-config.guard_band, -config.guard_band, 2 * config.guard_band, 2 * config.guard_band});
}

}  // namespace halfplane
