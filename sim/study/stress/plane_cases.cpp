// Depth and colour planes: the steepest, the flattest, planes that fight, and the remaining error.
#include <gmpxx.h>

#include <algorithm>
#include <cmath>

#include "model/golden/exact.hpp"
#include "model/stages/interpolate.hpp"
#include "sim/study/depth/measure.hpp"
#include "sim/study/depth/two_planes.hpp"
#include "sim/study/stress/cases.hpp"
#include "sim/study/stress/shapes.hpp"

namespace halfplane::stress {
namespace {

/// A grid of cells whose inner vertices are moved by up to a quarter of a cell: triangles of all slopes, none reversed.
Mesh jittered_grid(Unit& unit, int cells, std::int64_t low, std::int64_t pitch) {
  std::vector<Point> grid;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const std::int64_t dx = unit.random.integer(-pitch / 4, pitch / 4);
      grid.push_back({low + i * pitch + dx, low + j * pitch + unit.random.integer(-pitch / 4, pitch / 4)});
    }
  Mesh mesh;
  const auto at = [&](int i, int j) { return grid[static_cast<std::size_t>(j * (cells + 1) + i)]; };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      mesh.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      mesh.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

std::uint32_t sum_depth(const Config& config, std::int64_t code) {
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(code, 0, max_depth(config)));
}

/// One triangle drawn twice, the second time with its vertices in another order and another depth function.
struct Pair {
  Scene scene;
  bool second_wins;
};
Pair same_triangle_twice(Unit& unit, int width, int height) {
  constexpr std::array kFuncs{DepthFunc::less,   DepthFunc::lequal,  DepthFunc::equal,
                              DepthFunc::gequal, DepthFunc::greater, DepthFunc::notequal};
  const auto point = [&] { return random_vertex_at(unit, random_point(unit, width, height, 2)); };
  const std::array<Vertex, 3> v{point(), point(), point()};
  const DepthFunc func = kFuncs[static_cast<std::size_t>(unit.random.index(6))];
  SceneBuilder builder(width, height);
  builder.triangle(v[0], v[1], v[2]);
  State state = SceneBuilder::window_state();
  state.depth_test = func;
  const auto turn = static_cast<std::size_t>(unit.random.index(3));
  const bool mirrored = unit.random.coin();
  builder.with_state(state).triangle(v[turn], v[(turn + (mirrored ? 2 : 1)) % 3], v[(turn + (mirrored ? 1 : 2)) % 3]);
  return {std::move(builder.scene), func == DepthFunc::lequal || func == DepthFunc::equal || func == DepthFunc::gequal};
}

/// One step of a sweep: the comparison in this configuration.
Comparison compared(Unit& unit, Unit& swept, const Scene& scene, int bits) {
  CompareOptions options;
  options.wants_affine_cost = false;
  unit.count_config(static_cast<std::uint64_t>(bits));
  Comparison c = compare(scene, swept.config, options);
  unit.count_triangles(c.rendering.triangles.size());
  unit.count_samples(c.oracle.samples + c.datapath.count);
  swept.measure("coverage", "samples", static_cast<double>(c.oracle.mismatches), 0, scene);
  return c;
}

}  // namespace

void steep_planes(Unit& unit) {
  Random& random = unit.random;
  const Config& config = unit.config;
  const int width = unit.width(32), height = unit.height(32), kind = random.index(4);
  const std::uint32_t max = max_depth(config);
  const auto end = [&] { return random.coin() ? max : 0U; };
  SceneBuilder builder(width, height);
  for (int n = 0; n < 8; ++n) {
    std::array<Point, 3> p{random_point(unit, width, height, 4), random_point(unit, width, height, 4),
                           random_point(unit, width, height, 4)};
    std::array<std::uint32_t, 3> z{end(), end(), end()};  // kind 0: the extreme codes, flat and sloped
    if (kind == 1) {                                      // the whole range within a pixel
      p[1] = {p[0].x + unit.pixel(), p[0].y};
      z = {0, max, end()};
    } else if (kind == 2) {  // less than an LSB over the span
      const std::uint32_t base = static_cast<std::uint32_t>(random.integer(0, max - 1));
      for (std::uint32_t& code : z) code = base + static_cast<std::uint32_t>(random.index(2));
    } else if (kind == 3) {  // a plane that leaves the range outside the triangle: thin, and steep across
      p[2] = {(p[0].x + p[1].x) / 2 + random.integer(-unit.pixel(), unit.pixel()), (p[0].y + p[1].y) / 2};
      z = {random_depth(unit), random_depth(unit), end()};
    }
    const auto limit = [&](std::int64_t v) { return std::clamp(v, lowest(unit), highest(unit)); };
    std::array<Vertex, 3> v;
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] = vertex_at(unit, {limit(p[i].x), limit(p[i].y)}, z[i]);
      v[i].rgba = random_color(random);
    }
    builder.triangle(v[0], v[1], v[2]);
  }
  (void)check_scene(unit, builder.scene);
}

void cancellation(Unit& unit) {
  // Constant depth, and depth that changes along only one axis: the other gradient is exactly 0, however large its
  // cancelling products.
  Random& random = unit.random;
  Triangle triangle;
  const bool is_constant = random.coin(), along_x = random.coin();
  const std::uint32_t z = random_depth(unit);
  const std::int64_t max = max_depth(unit.config);
  for (SnappedVertex& v : triangle.v) {
    const Point p = random_guard_point(unit);
    const int shift = unit.widths.grid_bits - unit.config.subpixel_bits;
    v.x = static_cast<std::int32_t>(p.x << shift);
    v.y = static_cast<std::int32_t>(p.y << shift);
    v.depth() = z;
  }
  if (!is_constant) {
    const std::int64_t slope = 1 + random.index(3), base = random.integer(0, max / 2), reach = (max - base) / slope;
    for (SnappedVertex& v : triangle.v) {
      std::int32_t& along = along_x ? v.x : v.y;
      along = static_cast<std::int32_t>(along % (reach + 1));
      along -= along % (1 << (unit.widths.grid_bits - unit.config.subpixel_bits));
      along = along < 0 ? -along : along;
      v.depth() = static_cast<std::uint32_t>(base + slope * along);
    }
  }
  const TriangleSetup setup = setup_triangle(triangle, unit.config, unit.widths);
  unit.count_triangles(1);
  const bool x_is_zero = is_constant || !along_x, y_is_zero = is_constant || along_x;
  unit.require(
      (!x_is_zero || setup.plane[kDepthPlane].step_x == 0) && (!y_is_zero || setup.plane[kDepthPlane].step_y == 0),
      "gradient", {}, "a gradient that cancels is not 0");
  if (!is_constant || setup.area == 0) return;
  const exact::TriangleOracle oracle(triangle, unit.widths.grid_bits);
  for (int n = 0; n < 64; ++n) {
    const int band = unit.config.guard_band;
    const int x = static_cast<int>(random.integer(-band, band - 1)),
              y = static_cast<int>(random.integer(-band, band - 1));
    if (!oracle.covers(x, y)) continue;
    unit.count_samples(1);
    unit.measure(
        "depth", "LSB",
        std::abs(static_cast<double>(plane_at(setup, kDepthPlane, unit.widths, x, y).code) - static_cast<double>(z)), 0,
        {});
  }
}

void coplanar(Unit& unit) {
  Random& random = unit.random;
  const int width = unit.width(32), height = unit.height(32);
  const Pair pair = same_triangle_twice(unit, width, height);
  const Rendering rendering = check_scene(unit, pair.scene);
  expect_pixels(unit, "order", pair.scene, [&](int, int, std::size_t p) {
    return rendering.count[p] == 2 && rendering.ids[p] != (pair.second_wins ? 1 : 0);
  });

  // A rectangle in a plane of integer codes at every grid point, cut in two ways: nowhere more than the two bounds
  // apart.
  const std::int64_t max = max_depth(unit.config), side = std::int64_t{std::max(width, height) + 2} * unit.pixel();
  const std::int64_t slope = std::min<std::int64_t>(max / (2 * side), 40);
  const std::int64_t kx = random.integer(-slope, slope), ky = random.integer(-slope, slope);
  const std::int64_t base = (kx < 0 ? -kx * side : 0) + (ky < 0 ? -ky * side : 0);
  const auto vertex = [&](std::int64_t x, std::int64_t y) {
    return vertex_at(unit, {x, y}, sum_depth(unit.config, base + kx * x + ky * y));
  };
  const std::int64_t hub_x = random.integer(1, side - 1), hub_y = random.integer(1, side - 1);
  const std::array corners{vertex(0, 0), vertex(side, 0), vertex(side, side), vertex(0, side)};
  SceneBuilder halves(width, height), fan(width, height);
  halves.triangle(corners[0], corners[1], corners[2]).triangle(corners[0], corners[2], corners[3]);
  for (std::size_t i = 0; i < 4; ++i) fan.triangle(vertex(hub_x, hub_y), corners[i], corners[(i + 1) % 4]);
  const Rendering a = check_scene(unit, halves.scene), b = check_scene(unit, fan.scene);
  std::int64_t apart = 0;
  std::uint64_t fights = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto difference = std::int64_t{a.frame.depth[a.frame.at(x, y)]} - b.frame.depth[b.frame.at(x, y)];
      apart = std::max(apart, std::abs(difference));
      fights += difference != 0 ? 1 : 0;
    }
  unit.count_checks(a.count.size());
  unit.measure("codes apart", "LSB", static_cast<double>(apart), std::floor(2 * depth_error_bound(unit.config)),
               fan.scene);
  unit.measure("fights", "of pixels", static_cast<double>(fights) / static_cast<double>(a.count.size()), 1, fan.scene);
}

void separation(Unit& unit) {
  // Surfaces at the predicted separation never fight; at half of it they do. In eye space, over mappings and formats.
  Config config = unit.config;
  config.depth_mapping = DepthMapping::projection;
  if (config.target_width < 120 || config.target_height < 90) return;
  constexpr std::array kMappings{DepthMapping::std,    DepthMapping::rev, DepthMapping::stdinf,
                                 DepthMapping::revinf, DepthMapping::w,   DepthMapping::log};
  constexpr std::array kFormats{"u12", "u16", "bins16", "f16", "uf4.12"};
  Random& random = unit.random;
  const auto mapping = kMappings[static_cast<std::size_t>(random.index(6))];
  const auto format = parse_depth_format(kFormats[static_cast<std::size_t>(random.index(5))]);
  const double z = random.between(2, 45);
  const SurfaceView view{random.between(0, 3), 45, 120, 90};
  std::optional<DepthVariant> variant;
  try {
    variant = make_variant(config, mapping, format, {random.coin() ? 1.0 : 0.1, 1000});
  } catch (const InputError&) {
    return;  // a format that needs more than this width of depth
  }
  const DepthBound bound(*variant);
  if (surface_separation(bound, z, view).total() > 0.1 * z) return;  // few depths are distinguished there
  MeasureOptions options;
  options.wants_errors = false;
  const std::uint64_t seed = random.next();
  const Scene whole = two_planes(bound, z, view, 1, seed);
  const DepthOrder order = measure_depth(whole, *variant, options).order;
  if (order.pairs < 1000) return;
  unit.count_checks(order.pairs);
  unit.measure("fights at the minimum", "pairs", static_cast<double>(order.fights()), 0, whole);
  // A few thousand pairs may miss the worst rounding: tries other planes.
  std::uint64_t fights = 0;
  Scene half;
  for (int attempt = 0; attempt < 16 && fights == 0; ++attempt) {
    half = two_planes(bound, z, view, 0.5, attempt == 0 ? seed : random.next());
    fights = measure_depth(half, *variant, options).order.fights();
  }
  unit.require(fights > 0, "fights at half of it", half,
               "no pair fights at half the predicted separation, in sixteen scenes: the prediction is too large");
}

void polygon_offset(Unit& unit) {
  Random& random = unit.random;
  const int width = unit.width(32), height = unit.height(32);
  const std::int64_t max = max_depth(unit.config);
  std::array<Vertex, 3> v;
  std::array<std::uint32_t, 3> z{};
  std::array<Point, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    z[i] = static_cast<std::uint32_t>(random.integer(8, max - 8));
    p[i] = random_point(unit, width, height, 3);
    v[i] = vertex_at(unit, p[i], z[i]);
  }
  const int codes = random.coin() ? (random.coin() ? 1 : -1) : random.index(17) - 8;
  State state = SceneBuilder::window_state();
  state.polygon_offset = {0.0, static_cast<double>(codes)};
  const Scene plain = single(width, height, v), moved = single(width, height, v, state);
  const Rendering a = check_scene(unit, plain), b = check_scene(unit, moved);
  expect_pixels(unit, "moved by r", moved, [&](int x, int y, std::size_t at) {
    return a.count[at] == 1 && std::int64_t{a.frame.depth[a.frame.at(x, y)]} + codes != b.frame.depth[b.frame.at(x, y)];
  });

  // A decal one LSB in front wins everywhere under LESS.
  state.polygon_offset = {0.0, -1.0};
  state.depth_test = DepthFunc::less;
  SceneBuilder decal(width, height);
  decal.triangle(v[0], v[1], v[2]).with_state(state).triangle(v[2], v[0], v[1]);
  const Rendering c = check_scene(unit, decal.scene);
  expect_pixels(unit, "decal", decal.scene, [&](int, int, std::size_t at) { return c.ids[at] == 0; });

  // The slope factor: floor(f m + c + 1/2) codes at each vertex, in rationals.
  const std::int64_t area = doubled_area(p[0], p[1], p[2]);
  if (area == 0) return;
  const double factor = random.between(-4, 4), constant = random.between(-20, 20);
  state.depth_test = DepthFunc::always;
  state.polygon_offset = {factor, constant};
  const auto big = [](std::int64_t value) { return mpq_class(mpz_class(static_cast<long>(value))); };
  const std::int64_t z1 = std::int64_t{z[1]} - z[0], z2 = std::int64_t{z[2]} - z[0];
  const mpq_class per_x = abs(big(z1) * big(p[2].y - p[0].y) - big(z2) * big(p[1].y - p[0].y));
  const mpq_class per_y = abs(big(z2) * big(p[1].x - p[0].x) - big(z1) * big(p[2].x - p[0].x));
  const mpq_class slope = std::max(per_x, per_y) / abs(big(area)) * unit.pixel();
  const double offset = mpq_class(mpq_class(factor) * slope + mpq_class(constant)).get_d();
  if (std::abs(offset) > 1e6 || std::abs(offset + 0.5 - std::round(offset + 0.5)) < 1e-6) return;  // a tie, to binary64
  const Scene sloped = single(width, height, v, state);
  for (const Triangle& t : check_scene(unit, sloped).triangles)
    for (std::size_t i = 0; i < 3; ++i)
      unit.require(t.v[i].depth() == sum_depth(unit.config, z[i] + static_cast<std::int64_t>(std::floor(offset + 0.5))),
                   "slope offset", sloped, "the vertices were not moved by floor(f m + c + 1/2) codes");
}

void mean_bias(Unit& unit) {
  // Sloped triangles with separate depths: D - S, triangle by triangle.
  const int size = std::min(unit.width(128), unit.height(128)), cells = size / 6;
  const std::int64_t pixel = unit.pixel(), pitch = std::max<std::int64_t>(2, 6 * pixel);
  // On a small target several times: a mean with a large error is not judged.
  for (int drawn = 0; drawn < 128 * 128; drawn += size * size) {
    const Scene scene = mesh_scene(unit, jittered_grid(unit, cells, 0, pitch), size, size);
    const Rendering rendering = check_scene(unit, scene);
    std::vector<std::pair<std::int64_t, std::int64_t>> sums(rendering.triangles.size());
    std::size_t p = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x, ++p) {
        if (rendering.visible[p] < 0) continue;
        const auto i = static_cast<std::size_t>(rendering.visible[p]);
        const std::int64_t exact = exact::on_grid(exact::depth_at(rendering.triangles[i], x, y, unit.widths.grid_bits));
        sums[i].first += (std::int64_t{rendering.frame.depth[rendering.frame.at(x, y)]} << exact::kGridBits) - exact;
        ++sums[i].second;
      }
    for (const auto& [sum, count] : sums)
      if (count > 0) unit.add_bias(sum, count);
  }
}

void subpixel_sweep(Unit& unit) {
  // The snap error halves with every subpixel bit.
  Config config = preset("full");
  const int cells = 20;
  SceneBuilder builder(4 * cells, 4 * cells);
  // One plane over the whole mesh: with separate slopes a few thin triangles would decide the mean.
  for (const Corner& t :
       jittered_grid(unit, cells, 0, std::int64_t{4} << 20)) {  // 2^-20 pixel: off every grid of the sweep
    const auto vertex = [](Point p) {
      const double x = std::ldexp(static_cast<double>(p.x), -20), y = std::ldexp(static_cast<double>(p.y), -20);
      return at(x, y, 0.2 + 0.004 * x + 0.003 * y);
    };
    builder.triangle(vertex(t[0]), vertex(t[1]), vertex(t[2]));
  }
  double first = 0, last = 0;
  for (int bits = 0; bits <= 8; ++bits) {
    config.subpixel_bits = bits;
    Unit swept(unit, config);
    const Comparison c = compared(unit, swept, builder.scene, bits);
    swept.require(std::isfinite(c.depth_lsb.rms) && std::isfinite(c.parts.snap.rms), "finite", builder.scene, "a NaN");
    if (bits > 2)
      swept.measure("snap, factor per bit - 1/2", "", std::abs(c.parts.snap.rms / last - 0.5), 0.2, builder.scene);
    last = c.parts.snap.rms;
    if (bits == 2) first = last;  // before that the snap may reverse triangles
  }
  unit.measure("snap, mean factor - 1/2", "", std::abs(std::pow(last / first, 1.0 / 6) - 0.5), 0.05, builder.scene);
}

void depth_sweep(Unit& unit) {
  // Depth errors halve with every depth bit until only the snap of x and y is left.
  Config config = preset("full");
  SceneBuilder builder(64, 64);
  for (const Corner& t : jittered_grid(unit, 8, 0, 8 * 1024)) {
    const auto vertex = [&](Point p) {
      return at(static_cast<double>(p.x) / 1024, static_cast<double>(p.y) / 1024, unit.random.between(0.3, 0.7));
    };
    const Vertex a = vertex(t[0]), b = vertex(t[1]), c = vertex(t[2]);
    builder.triangle(a, b, c);
  }
  double last = 0;
  for (int bits = 8; bits <= 32; ++bits) {
    config.depth_bits = bits;
    Unit swept(unit, config);
    const Comparison c = compared(unit, swept, builder.scene, bits);
    swept.measure("depth", "LSB", c.datapath.max, depth_error_bound(config), builder.scene);
    const double error = std::ldexp(c.depth_lsb.rms, -bits);
    swept.require(std::isfinite(error), "finite", builder.scene, "a NaN");
    if (bits > 8 && bits <= 11)
      swept.measure("factor per bit - 1/2", "", std::abs(error / last - 0.5), 0.1, builder.scene);
    if (bits > 24) swept.measure("floor, factor per bit - 1", "", std::abs(error / last - 1), 0.01, builder.scene);
    last = error;
  }
}

}  // namespace halfplane::stress
