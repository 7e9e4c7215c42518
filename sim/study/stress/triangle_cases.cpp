// Single triangles: every shape that might stress the arithmetic.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/study/stress/cases.hpp"
#include "sim/study/stress/shapes.hpp"
#include "sim/study/stress/triangle_families.hpp"

namespace halfplane::stress {
namespace {

int random_sign(Random& random) { return random.coin() ? 1 : -1; }

/// The random generator of a family of its own, so that the number of random numbers per triangle does not matter.
TriangleFamilies<Random> families_of(Unit& unit, int width, int height) {
  return {unit.config, width, height, Random(unit.random.next())};
}

/// c and d with a d - b c = 1, for a, b > 0 without a common divisor.
Point companion(std::int64_t a, std::int64_t b) {
  std::int64_t r0 = a, r1 = b, s0 = 1, s1 = 0;  // r = s a mod b
  while (r1 != 0) {
    const std::int64_t q = r0 / r1;
    std::tie(r0, r1) = std::pair{r1, r0 - q * r1};
    std::tie(s0, s1) = std::pair{s1, s0 - q * s1};
  }
  const std::int64_t d = ((s0 % b) + b) % b;
  return {(a * d - 1) / b, d};
}

}  // namespace

void random_families(Unit& unit) {
  const int width = unit.width(16 + unit.random.index(48)), height = unit.height(16 + unit.random.index(48));
  auto families = families_of(unit, width, height);
  SceneBuilder builder(width, height);
  for (int k = 0; k < 16; ++k) {
    const auto v = families.triangle(k % decltype(families)::kFamilies);
    builder.triangle(v[0], v[1], v[2]);
  }
  (void)check_scene(unit, builder.scene);
}

void large_target(Unit& unit) {
  // The longest steps between tiles; a new place each time, so that no screen needs to be drawn completely.
  const int width = unit.width(unit.config.target_width), height = unit.height(1024);
  State state = SceneBuilder::window_state();
  state.scissor = Rect{unit.random.index(width), unit.random.index(height), 96, 64};
  auto families = families_of(unit, width, height);
  SceneBuilder builder(width, height, state);
  for (int k = 0; k < 12; ++k) {
    const auto v = families.triangle(k % 3 == 0 ? 0 : 2 + k % 4);
    builder.triangle(v[0], v[1], v[2]);
  }
  (void)check_scene(unit, builder.scene);
}

void vertex_orders(Unit& unit) {
  const int width = unit.width(24), height = unit.height(24);
  auto families = families_of(unit, width, height);
  const auto v = families.triangle(unit.random.index(decltype(families)::kFamilies));
  std::array<std::size_t, 3> order{0, 1, 2};
  std::optional<Rendering> first;
  do {
    const Scene scene = single(width, height, {v[order[0]], v[order[1]], v[order[2]]});
    Rendering rendering = check_scene(unit, scene);
    if (first)
      expect_same_image(unit, scene, *first, rendering);
    else
      first = std::move(rendering);
  } while (std::next_permutation(order.begin(), order.end()));
}

void zero_area(Unit& unit) {
  Random& random = unit.random;
  const int width = unit.width(24), height = unit.height(24), kind = random.index(5);
  const Point a = random_point(unit, width, height, 1), far = random_point(unit, width, height, 1);
  const std::int64_t n = 1 + random.index(8), k = random.index(static_cast<int>(n) + 1);
  const Point d{(far.x - a.x) / n, (far.y - a.y) / n};
  std::array<Point, 3> p{a, {a.x + n * d.x, a.y + n * d.y}, {a.x + k * d.x, a.y + k * d.y}};  // collinear
  if (kind == 1) p[2] = p[random.coin() ? 0 : 1];                                             // two equal
  if (kind == 2 || kind == 3) p[1] = p[2] = a;                                                // all equal
  std::array<Vertex, 3> v;
  for (std::size_t i = 0; i < 3; ++i) {
    v[i] = random_vertex_at(unit, p[i]);
    if (kind < 3) continue;  // 3: snapped to a point, 4: to a line, from up to half a subpixel away
    v[i].x = std::clamp(v[i].x + random.between(-0.49, 0.49) / unit.pixel(), 1.0 - unit.config.guard_band,
                        unit.config.guard_band - 1.0);
    v[i].y = std::clamp(v[i].y + random.between(-0.49, 0.49) / unit.pixel(), 1.0 - unit.config.guard_band,
                        unit.config.guard_band - 1.0);
  }
  const Scene scene = single(width, height, v);
  const Rendering rendering = unit.engine(scene, unit.config, render_options());
  unit.count_triangles(1);
  expect_count(unit, scene, rendering, [](int, int) { return 0; });
  unit.require(rendering.counters.drawn == 0 && rendering.counters.culled == 1, "culled", scene,
               "a triangle of no area was not culled");
}

void unit_area_slivers(Unit& unit) {
  // From one side of the target to the other, up to the guard band; doubled area: `scale` square subpixels.
  Random& random = unit.random;
  const int width = unit.width(96), height = unit.height(96);
  const std::int64_t longest =
      std::min<std::int64_t>((width + 8) * std::int64_t{unit.pixel()}, highest(unit) - lowest(unit));
  std::int64_t a = 1 + random.integer(longest / 2, longest - 1), b = 1 + random.integer(0, longest - 1);
  const std::int64_t common = std::gcd(a, b), scale = random.coin() ? 1 : 1 + random.index(64);
  a /= common;
  b /= common;
  const Point c = companion(a, b);
  const Point start{-4 * unit.pixel(), -4 * unit.pixel()};
  const int mirror = random_sign(random);
  const auto place = [&](std::int64_t x, std::int64_t y) {
    const std::int64_t column = start.x + x, row = mirror > 0 ? start.y + y : height * unit.pixel() - start.y - y;
    return Point{std::clamp(column, lowest(unit), highest(unit)), std::clamp(row, lowest(unit), highest(unit))};
  };
  const Point apex = scale == 1 ? c : Point{c.x * scale % (longest + 1), c.y * scale % (longest + 1)};
  const Vertex v0 = random_vertex_at(unit, place(0, 0)), v1 = random_vertex_at(unit, place(a * common, b * common)),
               v2 = random_vertex_at(unit, place(apex.x, apex.y)), v3 = random_vertex_at(unit, place(a, b));
  SceneBuilder builder(width, height);
  builder.triangle(v0, v3, v2).triangle(v0, v1, v2);
  // Thin, but with samples: one subpixel wide along its whole length.
  const Vertex v4 = random_vertex_at(unit, place(a * common + 1, b * common));
  builder.triangle(v0, v1, v4);
  (void)check_scene(unit, builder.scene);
}

void snap_flip(Unit& unit) {
  Random& random = unit.random;
  const int width = unit.width(32), height = unit.height(32), bits = unit.config.subpixel_bits;
  const double subpixel = 1.0 / unit.pixel();
  for (int attempt = 0; attempt < 200; ++attempt) {
    const Point a = random_point(unit, width, height, 1), b = random_point(unit, width, height, 1);
    const double t = random.unit();
    const Point c{std::llround(static_cast<double>(a.x) + t * static_cast<double>(b.x - a.x)) + random.index(3) - 1,
                  std::llround(static_cast<double>(a.y) + t * static_cast<double>(b.y - a.y)) + random.index(3) - 1};
    const std::int64_t snapped = doubled_area(a, b, c);
    std::array<Vertex, 3> v{random_vertex_at(unit, a), random_vertex_at(unit, b), random_vertex_at(unit, c)};
    for (Vertex& vertex : v) {
      vertex.x += random.between(-0.49, 0.49) * subpixel;
      vertex.y += random.between(-0.49, 0.49) * subpixel;
    }
    const double real = (v[1].x - v[0].x) * (v[2].y - v[0].y) - (v[1].y - v[0].y) * (v[2].x - v[0].x);
    if (snapped == 0 || (snapped > 0) == (real > 0)) continue;
    State state = SceneBuilder::window_state();
    state.cull = random.coin() ? Cull::back : Cull::front;
    state.front = random.coin() ? FrontFace::cw : FrontFace::ccw;
    const bool is_front = (snapped > 0) == (state.front == FrontFace::cw);
    const bool is_drawn = is_front == (state.cull == Cull::back);
    const Scene scene = single(width, height, v, state);
    const Rendering rendering = check_scene(unit, scene);
    expect_count(unit, scene, rendering, [&](int x, int y) {
      return is_drawn && triangle_covers({a, b, c}, x, y, bits) ? 1 : 0;
    });
    return;
  }
}

void guard_band_corners(Unit& unit) {
  Random& random = unit.random;
  const int width = unit.width(48), height = unit.height(48);
  const auto corner = [&] {
    const auto coordinate = [&] {
      return random.coin() ? lowest(unit) + random.index(2) : highest(unit) - random.index(2);
    };
    const std::int64_t x = coordinate();
    return Point{x, coordinate()};
  };
  const Point a = corner(), b = corner(), c = random.coin() ? corner() : random_point(unit, width, height, 2);
  std::array<Vertex, 3> v{random_vertex_at(unit, a), random_vertex_at(unit, b), random_vertex_at(unit, c)};
  (void)check_scene(unit, single(width, height, v));
  // One subpixel beyond: refused by name, not saturated.
  Vertex& beyond = v[static_cast<std::size_t>(random.index(3))];
  const double outside =
      std::ldexp(static_cast<double>(random.coin() ? lowest(unit) - 1 : highest(unit) + 1), -unit.config.subpixel_bits);
  (random.coin() ? beyond.x : beyond.y) = outside;
  const Scene scene = single(width, height, v);
  bool is_refused = false;
  try {
    (void)unit.engine(scene, unit.config, {});
  } catch (const InputError&) {
    is_refused = true;
  }
  unit.require(is_refused, "refused", scene, "a vertex one subpixel beyond the guard band was drawn");
}

void half_subpixel_rounding(Unit& unit) {
  const int width = unit.width(24), height = unit.height(24), bits = unit.config.subpixel_bits;
  std::array<Point, 3> p;
  std::array<Vertex, 3> v;
  for (std::size_t i = 0; i < 3; ++i) {
    // x + 1/2 subpixel snaps to x + 1, on both sides of 0.
    p[i] = random_point(unit, width, height, 6);
    v[i] = random_vertex_at(unit, p[i]);
    v[i].x = std::ldexp(static_cast<double>(p[i].x) - 0.5, -bits);
    v[i].y = std::ldexp(static_cast<double>(p[i].y) - 0.5, -bits);
    if (p[i].x == lowest(unit) || p[i].y == lowest(unit)) return;
  }
  const Scene scene = single(width, height, v);
  const Rendering rendering = check_scene(unit, scene);
  expect_count(unit, scene, rendering, [&](int x, int y) {
    return triangle_covers({p[0], p[1], p[2]}, x, y, bits) ? 1 : 0;
  });
  const int shift = derive_widths(unit.config).grid_bits - bits;
  for (const Triangle& t : rendering.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      unit.require(t.v[i].x == p[i].x << shift && t.v[i].y == p[i].y << shift, "snap", scene,
                   "half a subpixel was not rounded up");
}

void translation(Unit& unit) {
  // By whole tiles: the same image, moved. By whole pixels: the same coverage.
  Random& random = unit.random;
  const int tile = unit.config.tile_size;
  const int width = unit.width(5 * tile + 3), height = unit.height(4 * tile + 5);
  const bool by_tiles = random.coin();
  const int step = by_tiles ? tile : 1;
  const int dx = step * (random.index(5) - 2), dy = step * (random.index(5) - 2);
  auto families = families_of(unit, width, height);
  SceneBuilder here(width, height), there(width, height);
  const double limit = unit.config.guard_band - 1;
  for (int k = 0; k < 6; ++k) {
    auto v = families.triangle(k);
    here.triangle(v[0], v[1], v[2]);
    const auto fits = [&](const Vertex& p) { return std::abs(p.x + dx) <= limit && std::abs(p.y + dy) <= limit; };
    if (!std::all_of(v.begin(), v.end(), fits)) return;
    for (Vertex& p : v) {
      p.x += dx;
      p.y += dy;
    }
    there.triangle(v[0], v[1], v[2]);
  }
  const Rendering a = check_scene(unit, here.scene), b = check_scene(unit, there.scene);
  std::uint64_t wrong = 0, compared = 0;
  for (int y = std::max(0, -dy); y < std::min(height, height - dy); ++y)
    for (int x = std::max(0, -dx); x < std::min(width, width - dx); ++x) {
      const auto at = [width](int column, int row) { return static_cast<std::size_t>(row * width + column); };
      const bool same_image = a.frame.depth[a.frame.at(x, y)] == b.frame.depth[b.frame.at(x + dx, y + dy)] &&
                              a.frame.color[a.frame.at(x, y)] == b.frame.color[b.frame.at(x + dx, y + dy)];
      wrong += a.count[at(x, y)] != b.count[at(x + dx, y + dy)] || (by_tiles && !same_image) ? 1 : 0;
      ++compared;
    }
  unit.count_checks(compared);
  unit.measure("image", "pixels", static_cast<double>(wrong), 0, there.scene);
}

}  // namespace halfplane::stress
