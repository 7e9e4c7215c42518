#include "sim/study/stress/search.hpp"
#include "sim/study/vertices.hpp"

#include <algorithm>
#include <cmath>

#include "model/golden/exact.hpp"
#include "model/stages/fragment_ops.hpp"
#include "model/stages/interpolate.hpp"
#include "sim/study/stress/cases.hpp"
#include "sim/study/stress/check.hpp"
#include "sim/study/stress/shapes.hpp"

namespace halfplane::stress {
namespace {

double ratio(int128 numerator, int128 denominator) {
  return static_cast<double>(numerator < 0 ? -numerator : numerator) / static_cast<double>(denominator);
}

double color_error(const Interpolated& value, const exact::TriangleOracle& oracle, const Config& config, int x, int y) {
  const auto max = golden::channel_max(config.color_format);
  const std::uint32_t stored = pack_color(config.color_format, color_channels(value.code));
  double worst = 0;
  for (int c = 0; c < golden::channel_count(config.color_format); ++c) {
    const exact::Rational plane = oracle.color_at(x, y, c);
    const int code = golden::stored_channel(stored, config.color_format, c);
    worst = std::max(worst, ratio(plane.denominator * 255 * code - plane.numerator * max[static_cast<std::size_t>(c)],
                                  plane.denominator * 255));
  }
  return worst;
}

/// One of the nine (for colours: eighteen) integers of a triangle, moved by `step`; false if out of range.
bool move(Triangle& t, int coordinate, std::int64_t step, const Unit& unit) {
  SnappedVertex& v = t.v[static_cast<std::size_t>(coordinate % 3)];
  const auto within = [&step](std::int64_t value, std::int64_t low, std::int64_t high) {
    return value + step >= low && value + step <= high;
  };
  const int kind = coordinate / 3, even = unit.config.subpixel_bits == 0 ? 2 : 1;  // at S = 0 coordinates are doubled
  if (kind < 2) {
    std::int32_t& c = kind == 0 ? v.x : v.y;
    step *= even;
    const Interval& range = unit.widths.coordinate.range;
    if (!within(c, static_cast<std::int64_t>(range.lo), static_cast<std::int64_t>(range.hi))) return false;
    c += static_cast<std::int32_t>(step);
  } else if (kind == 2) {
    if (!within(v.depth(), 0, max_depth(unit.config))) return false;
    v.depth() = static_cast<std::uint32_t>(v.depth() + step);
  } else {
    std::uint32_t& c = v.code[kColorPlane + static_cast<std::size_t>(kind - 3)];
    if (!within(c, 0, static_cast<std::int64_t>(unit.widths.color().code.range.hi))) return false;
    c = static_cast<std::uint32_t>(c + step);
  }
  return true;
}

/// A start: near the window, thin, or with far corners.
Triangle random_start(Unit& unit) {
  Random& random = unit.random;
  const int shift = unit.widths.grid_bits - unit.config.subpixel_bits,
            window = std::min(kSearchWindow, unit.width(kSearchWindow));
  Triangle t;
  const int kind = random.index(4);
  std::array<Point, 3> p;
  for (std::size_t i = 0; i < 3; ++i)
    p[i] = kind == 1 && i > 0 ? random_guard_point(unit) : random_point(unit, window, window, 2);
  if (kind == 2) p[2] = {(p[0].x + p[1].x) / 2 + random.index(9) - 4, (p[0].y + p[1].y) / 2 + random.index(9) - 4};
  for (std::size_t i = 0; i < 3; ++i) {
    t.v[i].x = static_cast<std::int32_t>(std::clamp(p[i].x, lowest(unit), highest(unit)) * (1 << shift));
    t.v[i].y = static_cast<std::int32_t>(std::clamp(p[i].y, lowest(unit), highest(unit)) * (1 << shift));
    t.v[i].depth() = random_depth(unit);
    set_colors(t.v[i], unit.widths, [&] { return random.index(256); });
  }
  return t;
}

/// The triangle as a scene that snaps to it.
Scene scene_of(Unit& unit, const Triangle& t) {
  const int shift = unit.widths.grid_bits - unit.config.subpixel_bits;
  std::array<Vertex, 3> v;
  for (std::size_t i = 0; i < 3; ++i) {
    v[i] = vertex_at(unit, {t.v[i].x >> shift, t.v[i].y >> shift}, t.v[i].depth());
    v[i].rgba = colors_of(t.v[i]);
  }
  return single(unit.width(kSearchWindow), unit.height(kSearchWindow), v);
}

}  // namespace

double search_error(const Triangle& triangle, Objective objective, const Config& config, const Widths& widths,
                    std::uint64_t& samples) {
  const int width = std::min(kSearchWindow, config.target_width),
            height = std::min(kSearchWindow, config.target_height);
  const TriangleSetup setup = setup_triangle(triangle, config, widths, {0, 0, width, height});
  if (setup.area == 0 || setup.is_empty()) return 0;
  const exact::TriangleOracle oracle(triangle, widths.grid_bits);
  const int128 unit = int128{1} << config.local_guard_bits;
  double worst = 0;
  for (int y = setup.top; y <= setup.bottom; ++y)
    for (int x = setup.left; x <= setup.right; ++x) {
      if (!oracle.covers(x, y)) continue;
      ++samples;
      if (objective == Objective::color) {
        worst = std::max(worst, color_error(interpolate_at(setup, widths, x, y), oracle, config, x, y));
        continue;
      }
      const exact::Rational plane = oracle.depth_at(x, y);
      const PlaneSample depth = plane_at(setup, kDepthPlane, widths, x, y);
      const double error =
          objective == Objective::depth
              ? ratio(plane.denominator * std::int64_t{depth.code} - plane.numerator, plane.denominator)
              : ratio(plane.denominator * depth.unrounded - plane.numerator * unit, plane.denominator * unit);
      worst = std::max(worst, error);
    }
  return worst;
}

Found climb(Unit& unit, Objective objective, int evaluations) {
  Found found;
  found.triangle = random_start(unit);
  const auto error_of = [&](const Triangle& t) {
    --evaluations;
    return search_error(t, objective, unit.config, unit.widths, found.samples);
  };
  found.start = found.error = error_of(found.triangle);
  // Coordinates 0...8 are X, Y, Z of the vertices; the later ones are the channels.
  const int channels = golden::channel_count(unit.config.color_format);
  const int count = objective == Objective::color ? 9 + 3 * channels : 9;
  for (bool is_better = true; is_better && evaluations > 0;) {
    is_better = false;
    for (int coordinate = 0; coordinate < count && evaluations > 0; ++coordinate) {
      if (objective == Objective::color && coordinate / 3 == 2) continue;  // depth does not matter there
      const int most = coordinate / 3 == 2  ? unit.config.depth_bits - 1
                       : coordinate / 3 < 2 ? unit.widths.grid_bits + 5
                                            : 7;
      for (int bit = 0; bit <= most && evaluations > 0; ++bit)
        for (const std::int64_t sign : {1, -1}) {
          Triangle next = found.triangle;
          if (!move(next, coordinate, sign * (std::int64_t{1} << bit), unit)) continue;
          const double error = error_of(next);
          if (error <= found.error) continue;
          found.triangle = next;
          found.error = error;
          is_better = true;
        }
    }
  }
  return found;
}

namespace {

/// Climbs; the engine must draw the error of the stages, where it is one of `drawn`.
std::pair<double, Scene> worst_found(Unit& unit, Objective objective, int evaluations, double AttributeErrors::*drawn) {
  const Found found = climb(unit, objective, evaluations);
  Scene scene = scene_of(unit, found.triangle);
  unit.count_triangles(1);
  unit.count_samples(found.samples);
  if (drawn != nullptr)
    unit.require(
        attribute_errors(scene, unit.config, unit.engine(scene, unit.config, render_options())).*drawn == found.error,
        "engine = stages", scene, "the engine draws another error than the stages have");
  return {found.error, std::move(scene)};
}

}  // namespace

void adversarial_depth(Unit& unit) {
  const auto [error, scene] = worst_found(unit, Objective::depth, 1500, &AttributeErrors::depth);
  unit.measure("depth", "LSB", error, depth_error_bound(unit.config), scene);
  const auto measured = measured_depth_error(scene, unit.config, unit.engine);
  unit.measure("self-report", "of the measured error",
               !measured || *measured == error ? 0 : std::abs(error / *measured - 1), 0.01, scene);
}

void adversarial_interpolation(Unit& unit) {
  const auto [error, scene] = worst_found(unit, Objective::interpolation, 1500, nullptr);
  unit.measure("before rounding", "LSB", error, depth_error_bound(unit.config) - 0.5, scene);
}

void adversarial_color(Unit& unit) {
  const auto [error, scene] = worst_found(unit, Objective::color, 1000, &AttributeErrors::color);
  unit.measure("color", "LSB", error, 1, scene);
}

}  // namespace halfplane::stress
