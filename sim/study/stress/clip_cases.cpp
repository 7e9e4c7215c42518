// Clip space: cuts by the planes against rationals, closed meshes around the eye, viewports and scissors.
#include <gmpxx.h>

#include <algorithm>
#include <cmath>

#include "model/host/primitives.hpp"
#include "sim/study/stress/cases.hpp"
#include "sim/study/stress/shapes.hpp"

namespace halfplane::stress {
namespace {

/// A corner of the exactly clipped polygon in subpixels of 2^-S pixel, and its depth in codes; not snapped.
struct ExactCorner {
  double x, y, z;
};

using HomogeneousPoint = std::array<mpq_class, 4>;

mpq_class plane_distance(const ClipPlane& p, const HomogeneousPoint& v) {
  return mpq_class(p.a) * v[0] + mpq_class(p.b) * v[1] + mpq_class(p.c) * v[2] + mpq_class(p.d) * v[3];
}

/// The triangle cut by the planes in rationals, divided and mapped to a viewport of the whole target.
std::vector<ExactCorner> exact_clip(const Config& config, const Scene& scene, const std::array<Vertex, 3>& v) {
  std::vector<HomogeneousPoint> polygon;
  for (const Vertex& p : v) polygon.push_back({mpq_class(p.x), mpq_class(p.y), mpq_class(p.z), mpq_class(p.w)});
  const Viewport viewport{0, 0, static_cast<double>(scene.width), static_cast<double>(scene.height)};
  for (const ClipPlane& plane : guard_band_planes(ClipZ::minus_one_one, viewport, guard_band_limit(config))) {
    std::vector<HomogeneousPoint> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const HomogeneousPoint &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
      const mpq_class a = plane_distance(plane, from), b = plane_distance(plane, to);
      if (a >= 0) kept.push_back(from);
      if ((a >= 0) == (b >= 0)) continue;
      const mpq_class t = a / (a - b);
      HomogeneousPoint cut;
      for (std::size_t k = 0; k < 4; ++k) cut[k] = from[k] + t * (to[k] - from[k]);
      kept.push_back(cut);
    }
    polygon = std::move(kept);
  }
  std::vector<ExactCorner> corners;
  const double pixel = std::ldexp(1.0, config.subpixel_bits);
  for (const HomogeneousPoint& p : polygon) {
    if (p[3] <= 0) return {};  // seen edge-on from the eye itself
    const mpq_class x = (p[0] / p[3] + 1) * scene.width / 2 * pixel, y = (1 - p[1] / p[3]) * scene.height / 2 * pixel;
    const mpq_class z = (p[2] / p[3] + 1) / 2 * mpq_class(max_depth(config));
    corners.push_back({x.get_d(), y.get_d(), z.get_d()});
  }
  return corners;
}

/// Distance of p outside the polygon (corners in either direction), in the coordinates' unit; negative inside.
double outside(const std::vector<ExactCorner>& polygon, double x, double y) {
  double area = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ExactCorner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    area += a.x * b.y - a.y * b.x;
  }
  double farthest = -HUGE_VAL;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ExactCorner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
    if (length == 0) continue;
    const double inside = (dx * (y - a.y) - dy * (x - a.x)) / length;
    farthest = std::max(farthest, area > 0 ? -inside : inside);
  }
  return farthest;
}

/// Whether the snap folds the cut triangle: some corner then turns the other way, or all do. The folded part lies on
/// its neighbours, which cover the same samples: no fill rule can prevent that.
bool is_folded(const Config& config, const Scene& scene, const std::array<Vertex, 3>& v) {
  const std::vector<ExactCorner> corners = exact_clip(config, scene, v);
  const std::size_t n = corners.size();
  double exact_area = 0;
  std::int64_t least = 0, most = 0;
  const auto snapped = [&](std::size_t i) {
    return Point{std::llround(std::floor(corners[i % n].x + 0.5)), std::llround(std::floor(corners[i % n].y + 0.5))};
  };
  for (std::size_t i = 0; i < n; ++i) {
    const ExactCorner &a = corners[i], &b = corners[(i + 1) % n];
    exact_area += a.x * b.y - a.y * b.x;
    const Point p = snapped(i), q = snapped(i + 1);
    for (std::size_t k = 2; k < n; ++k) {
      const Point r = snapped(i + k);
      const std::int64_t turn = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
      least = std::min(least, turn);
      most = std::max(most, turn);
    }
  }
  return exact_area > 0 ? least < 0 : most > 0;
}

/// Adds the quadrilateral a, b, c, d, halved along either diagonal, in either winding; returns whether the snap folds the
/// clipped polygon of one half.
bool add_quad(Unit& unit, SceneBuilder& builder, const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) {
  using Half = std::array<Vertex, 3>;
  bool is_any_folded = false;
  for (const Half& v :
       unit.random.coin() ? std::array{Half{a, b, c}, Half{a, c, d}} : std::array{Half{b, a, d}, Half{d, b, c}}) {
    builder.triangle(v[0], v[1], v[2]);
    is_any_folded |= is_folded(unit.config, builder.scene, v);
  }
  return is_any_folded;
}

/// Draws the triangle and compares every drawn corner, and every sample not at an edge, with the exact clip.
void check_clip(Unit& unit, const std::array<Vertex, 3>& v) {
  State state;  // clip space
  state.depth_test = DepthFunc::always;
  const Scene scene = single(unit.width(48), unit.height(40), v, state);
  Rendering rendering;
  try {
    rendering = check_scene(unit, scene);
  } catch (const InputError&) {
    return;  // coordinates so large that a cut is not exact to a pixel: refused by name
  }
  const auto corners = exact_clip(unit.config, scene, v);
  const int shift = unit.widths.grid_bits - unit.config.subpixel_bits;
  double farthest = 0, depth = 0;
  for (const Triangle& t : rendering.triangles)
    for (const SnappedVertex& p : t.v) {
      double nearest = HUGE_VAL, code = 0;
      for (const ExactCorner& c : corners) {
        const double away = std::max(std::abs(std::ldexp(p.x, -shift) - c.x), std::abs(std::ldexp(p.y, -shift) - c.y));
        if (away < nearest) {
          nearest = away;
          code = std::abs(static_cast<double>(p.depth()) - c.z);
        } else if (away == nearest) {
          code = std::min(code, std::abs(static_cast<double>(p.depth()) - c.z));
        }
      }
      farthest = std::max(farthest, nearest);
      // Corners closer than a subpixel are not distinguished: their depths are.
      if (nearest <= 1) {
        for (const ExactCorner& c : corners)
          if (std::max(std::abs(std::ldexp(p.x, -shift) - c.x), std::abs(std::ldexp(p.y, -shift) - c.y)) <= 1)
            code = std::min(code, std::abs(static_cast<double>(p.depth()) - c.z));
        depth = std::max(depth, code);
      }
    }
  unit.count_checks(3 * rendering.triangles.size());
  unit.measure("corner", "subpixels", farthest, 1, scene);
  unit.measure("corner depth", "LSB", depth, 1, scene);
  if (is_folded(unit.config, scene, v)) return;  // the fan then draws a sliver of itself three times
  expect_pixels(unit, "samples off the edges", scene, [&](int x, int y, std::size_t p) {
    const double away =
        corners.size() < 3 ? HUGE_VAL : outside(corners, (x + 0.5) * unit.pixel(), (y + 0.5) * unit.pixel());
    // A corner moves by at most 0.71 subpixels, and the edges with it.
    return std::abs(away) > 1 && rendering.count[p] != (away < 0 ? 1U : 0U);
  });
}

}  // namespace

void near_plane(Unit& unit) {
  Random& random = unit.random;
  const int kind = random.index(5);
  std::array<Vertex, 3> v;
  for (std::size_t i = 0; i < 3; ++i) {
    double w = random.between(-1, 3);
    if (kind == 1 && i == 0) w = std::ldexp(random.unit(), -20 - random.index(20));  // w -> 0+
    if (kind == 2) w = -random.between(0.01, 3);                                     // all behind
    if (kind == 3) w = random.between(0.2, 3);                                       // far and sides only
    const double reach = kind == 4 ? 40 : 3;
    const double x = random.between(-reach, reach), y = random.between(-reach, reach);
    // Between near and far, and beyond both, in any combination.
    const double z = random.between(-1.6, 1.6) * std::max(std::abs(w), 0.1);
    v[i] = clip_at(x, y, z, w, random_color(random));
  }
  check_clip(unit, v);
}

void w_ratio(Unit& unit) {
  Random& random = unit.random;
  std::array<Vertex, 3> v;
  for (std::size_t i = 0; i < 3; ++i) {
    const double w = i == 0 ? 1 : i == 1 ? 1e6 : std::pow(10.0, random.between(0, 6));
    const double x = random.between(-1.5, 1.5), y = random.between(-1.5, 1.5);
    v[i] = clip_at(x * w, y * w, random.between(-1, 1) * w, w, random_color(random));
  }
  check_clip(unit, v);
}

void closed_meshes(Unit& unit) {
  // The eye inside a box that reaches behind it and far beyond the guard band: every pixel sees one inner wall.
  Random& random = unit.random;
  const int width = unit.width(48), height = unit.height(40), cells = 1 + random.index(4);
  State state;
  state.depth_test = DepthFunc::always;
  const double turn = random.between(0, 6.3), tilt = random.between(-1, 1);
  const std::array low{-random.between(1, 9), -random.between(1, 9), -random.between(1, 9)},
      high{random.between(1, 9), random.between(1, 9), random.between(1, 9)};
  const auto corner = [&](double fx, double fy, double fz) {
    const double x0 = low[0] + fx * (high[0] - low[0]), y0 = low[1] + fy * (high[1] - low[1]),
                 z0 = low[2] + fz * (high[2] - low[2]);
    const double x = x0 * std::cos(turn) + z0 * std::sin(turn), z1 = z0 * std::cos(turn) - x0 * std::sin(turn);
    const double y = y0 * std::cos(tilt) + z1 * std::sin(tilt), z = z1 * std::cos(tilt) - y0 * std::sin(tilt);
    return clip_at(1.1 * x, 1.3 * y, (20.1 * z - 4.0) / 19.9, z);  // near 0.1, far 20: beyond every corner
  };
  SceneBuilder builder(width, height, state);
  bool has_fold = false;
  for (int face = 0; face < 6; ++face)
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        const auto vertex = [&](int a, int b) {
          const double s = static_cast<double>(i + a) / cells, t = static_cast<double>(j + b) / cells, r = face % 2;
          return face < 2 ? corner(r, s, t) : face < 4 ? corner(s, r, t) : corner(s, t, r);
        };
        const Vertex a = vertex(0, 0), b = vertex(1, 0), c = vertex(1, 1), d = vertex(0, 1);
        has_fold |= add_quad(unit, builder, a, b, c, d);
      }
  const Rendering rendering = check_scene(unit, builder.scene);
  if (has_fold) return;  // the same as in slabs
  expect_count(unit, builder.scene, rendering, [](int, int) { return 1; });
}

void slabs(Unit& unit) {
  // A plane through near, far and all four sides, in pieces: no pixel twice, and once without near and far.
  Random& random = unit.random;
  const int width = unit.width(48), height = unit.height(40), cells = 2 + random.index(6);
  State state;
  state.depth_test = DepthFunc::always;
  const double near = 0.5, far = 8, nx = random.between(-0.6, 0.6), nz = random.between(-0.3, 0.3),
               h = -random.between(0.2, 1);
  // y = h + nx x + nz z in eye space, z forward; the sheet reaches far beyond everything.
  const auto vertex = [&](int i, int j) {
    const double x = -90 + 180.0 * i / cells, z = -20 + 60.0 * j / cells;
    return clip_at(x, h + nx * x + nz * z, ((far + near) * z - 2 * far * near) / (far - near), z);
  };
  SceneBuilder builder(width, height, state);
  bool has_fold = false;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const Vertex a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
      has_fold |= add_quad(unit, builder, a, b, c, d);
    }
  const Rendering rendering = check_scene(unit, builder.scene);
  if (has_fold) return;  // nearly edge-on, on a coarse grid: the number of covers is not defined
  // The eye depth at which a ray meets the plane: y z' = h + nx x z' + nz z'.
  const auto depth = [&](double px, double py) {
    const double x = 2 * px / width - 1, y = 1 - 2 * py / height, denominator = y - nx * x - nz;
    return h / denominator;
  };
  expect_pixels(unit, "count", builder.scene, [&](int x, int y, std::size_t p) {
    int inside = 0;
    for (const double dx : {-1.5, 1.5})
      for (const double dy : {-1.5, 1.5}) {
        const double z = depth(x + 0.5 + dx, y + 0.5 + dy);
        inside += z > near && z < far ? 1 : 0;
      }
    return rendering.count[p] > 1 || (inside == 4 && rendering.count[p] != 1);
  });
}

void scissor(Unit& unit) {
  // A scissored image equals the unscissored one inside, and is unchanged outside.
  Random& random = unit.random;
  const int width = unit.width(40), height = unit.height(40), tile = unit.config.tile_size;
  SceneBuilder whole(width, height);
  State state = SceneBuilder::window_state();
  const auto extent = [&](int size) {
    const int kind = random.index(4);
    return kind == 0 ? 1 : kind == 1 ? tile : kind == 2 ? 2 * random.index(size / 2 + 1) + 1 : random.index(size + 3);
  };
  const auto start = [&](int size) {
    return random.coin() ? tile * random.index(size / tile + 1) : random.index(size + 4) - 2;
  };
  const int left = start(width), top = start(height), columns = extent(width);
  state.scissor = Rect{left, top, columns, extent(height)};
  SceneBuilder part(width, height, state);
  for (int n = 0; n < 6; ++n) {
    const auto point = [&] { return random_vertex_at(unit, random_point(unit, width, height, 8)); };
    const Vertex a = point(), b = point(), c = point();
    whole.triangle(a, b, c);
    part.triangle(a, b, c);
  }
  const Rendering all = check_scene(unit, whole.scene), cut = check_scene(unit, part.scene);
  expect_pixels(unit, "image", part.scene, [&](int x, int y, std::size_t p) {
    const Rect& r = *state.scissor;
    const bool is_inside = x >= r.x && x < r.x + r.width && y >= r.y && y < r.y + r.height;
    const std::size_t at = all.frame.at(x, y), bt = cut.frame.at(x, y);
    return cut.count[p] != (is_inside ? all.count[p] : 0) ||
           (is_inside && (all.frame.depth[at] != cut.frame.depth[bt] || all.frame.color[at] != cut.frame.color[bt]));
  });
}

void viewports(Unit& unit) {
  // 1x1 and odd viewports: nothing outside; inside, a mesh over the whole volume covers every pixel once.
  Random& random = unit.random;
  const int width = unit.width(40), height = unit.height(40);
  State state;
  state.depth_test = DepthFunc::always;
  const auto extent = [&](int size) { return random.index(3) == 0 ? 1 : 2 * random.index(size / 2) + 1; };
  const int columns = extent(width), rows = extent(height), left = random.index(width - columns + 1);
  const int top = random.index(height - rows + 1);
  state.viewport = Viewport{static_cast<double>(left), static_cast<double>(top), static_cast<double>(columns),
                            static_cast<double>(rows)};
  SceneBuilder builder(width, height, state);
  const double x = random.between(-0.9, 0.9), y = random.between(-0.9, 0.9);
  const auto vertex = [&](double cx, double cy) {
    const double w = random.between(0.5, 4);
    return clip_at(cx * w, cy * w, random.between(-1, 1) * w, w, random_color(random));
  };
  const Vertex hub = vertex(x, y);
  const std::array rim{vertex(-1.5, -1.5), vertex(1.5, -1.5), vertex(1.5, 1.5), vertex(-1.5, 1.5)};
  for (std::size_t i = 0; i < 4; ++i) builder.triangle(hub, rim[i], rim[(i + 1) % 4]);
  const Rendering rendering = check_scene(unit, builder.scene);
  expect_count(unit, builder.scene, rendering, [&](int px, int py) {
    return px >= left && px < left + columns && py >= top && py < top + rows ? 1 : 0;
  });
}

}  // namespace halfplane::stress
