// Checks of a drawn scene: coverage sample by sample, depth and colour fragment by fragment, counts.
#pragma once

#include <optional>
#include <span>

#include "sim/study/compare/compare.hpp"
#include "sim/study/compare/fragment_judge.hpp"
#include "sim/study/stress/unit.hpp"

namespace halfplane::stress {

/// A point of the grid on which snapped vertices lie, in units of 2^-S pixel.
struct Point {
  std::int64_t x = 0, y = 0;
  auto operator<=>(const Point&) const = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 and <=>
};

/// The engine of a run without one of its own: render_functional, or, when fragments are requested, render_scalar.
[[nodiscard]] Rendering draw(const Scene& scene, const Config& config, const RenderOptions& options);

/// Draws the scene with the unit's engine and compares it with the exact oracle: every sample of every triangle's box,
/// and the stored depth and colour of every pixel that shows a triangle. Measures "coverage" (samples that differ),
/// "depth" and "color" (LSB from the exact plane). Depth must be of the format `plane`. Bound of a colour: 1 LSB. In
/// some units the fragments are judged as well, before the operations (FragmentJudge), which adds no figure.
Rendering check_scene(Unit& unit, const Scene& scene, FillRule rule = FillRule::top_left);

/// The largest |stored depth - exact plane| over the pixels that show a triangle, in LSB. Adds no count.
struct AttributeErrors {
  double depth = 0, color = 0;  ///< LSB of the stored formats
  std::uint64_t fragments = 0;  ///< of each
};
[[nodiscard]] AttributeErrors attribute_errors(const Scene& scene, const Config& config, const Rendering& rendering);

/// Whether the convex polygon (corners clockwise as seen, y down, grid points) owns the centre of pixel (x, y) by the
/// top-left rule. From the definition, edge by edge.
[[nodiscard]] bool polygon_covers(std::span<const Point> polygon, int x, int y, int subpixel_bits);

/// Measures `property`: the wrong pixels (x, y), number y * width + x.
template <class IsWrong>
void expect_pixels(Unit& unit, std::string_view property, const Scene& scene, IsWrong&& is_wrong) {
  std::uint64_t wrong = 0;
  std::size_t p = 0;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x, ++p) wrong += is_wrong(x, y, p) ? 1 : 0;
  unit.count_checks(p);
  unit.measure(property, "pixels", static_cast<double>(wrong), 0, scene);
}

/// Requires that each pixel was covered `expected(x, y)` times; measures "count", the pixels for which this fails.
template <class Expected>
void expect_count(Unit& unit, const Scene& scene, const Rendering& rendering, Expected&& expected) {
  expect_pixels(unit, "count", scene, [&](int x, int y, std::size_t p) {
    return rendering.count[p] != static_cast<std::uint32_t>(expected(x, y));
  });
}

/// Requires that the pixels of the polygon were covered once and no others.
void expect_once(Unit& unit, const Scene& scene, const Rendering& rendering, std::span<const Point> polygon);

/// Requires equal images; measures "image", the pixels whose depth, colour or count differ.
void expect_same_image(Unit& unit, const Scene& scene, const Rendering& a, const Rendering& b);

/// Whether such hardware exists, and supports the scene.
[[nodiscard]] bool is_drawn_by_hardware(const Scene& scene, const Config& config);

/// The options of every scene drawn here: counts, visible triangles.
[[nodiscard]] RenderOptions render_options();

// The independent checker: depth errors of a drawn scene in GMP rationals, from the vertices as given. Its own snap, its own
// plane (normal and point, not barycentric weights), no code of the stages, the oracle or the other checks.

/// The largest |stored depth - exact plane through the snapped vertices| over the pixels that show a triangle, in LSB.
/// None if the scene has unsupported features: clip space, other topologies than lists of triangles, polygon offset,
/// another depth format than `plane`, conventions.
[[nodiscard]] std::optional<double> measured_depth_error(const Scene& scene, const Config& config,
                                                         const Engine& engine);

}  // namespace halfplane::stress
