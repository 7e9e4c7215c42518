#include "sim/study/depth/two_planes.hpp"

#include <algorithm>
#include <cmath>

#include "sim/scene/mesh_scene.hpp"
#include "sim/scene/random.hpp"

namespace halfplane {
namespace {

constexpr int kParts = 3;  // quads along either side of a surface

/// A plane: its eye depth on the ray with the tangent t is depth / (1 - slope (t - middle)).
struct SlopingPlane {
  double depth, slope, middle;
  [[nodiscard]] double at(double tangent) const { return depth / (1 - slope * (tangent - middle)); }
};

/// Pairs along either side of the scene: few enough for each surface to cross some codes, if it can.
int cells(const DepthBound& bound, double z, const SurfaceView& view) {
  const double step = surface_separation(bound, z, view).storage;  // of depth
  const double pixels = 6 * step / (view.slope * z * view.pixel());
  for (const int count : {8, 4})
    if (view.slope == 0 || pixels < std::min(view.width, view.height) / count) return count;
  return 2;
}

}  // namespace

double SurfaceView::pixel() const { return 2 * std::tan(fov * std::acos(-1.0) / 360) / height; }

DepthBound::Separation surface_separation(const DepthBound& bound, double z, const SurfaceView& view) {
  return bound.separation(z, bound.budget(bound.screen_slope(z, view.slope, view.pixel()), view.slope == 0));
}

Scene two_planes(const DepthBound& bound, double z, const SurfaceView& view, double part, std::uint64_t seed) {
  Scene scene = cleared_scene(view.width, view.height);
  scene.name = "two planes";
  scene.planes = {bound.scale().near(), bound.scale().far()};
  const double step = surface_separation(bound, z, view).storage;
  if (std::isinf(step)) return scene;
  Random random(seed);
  const double pixel = view.pixel();
  const int count = cells(bound, z, view), side = std::min(view.width, view.height) / count;
  const int cell = side - 2;  // pixels
  const auto add_surface = [&](const SlopingPlane& surface, double left, double top) {
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    for (int j = 0; j <= kParts; ++j)
      for (int i = 0; i <= kParts; ++i) {
        const auto place = [&](int k) {
          return cell * (k + (k % kParts == 0 ? 0.0 : random.uniform(-0.3, 0.3))) / kParts + random.uniform(0, 1);
        };
        const double x = left + place(i), y = top + place(j);
        const double w = surface.at((x - view.width / 2.0) * pixel);
        scene.vertices.push_back({(2 * x / view.width - 1) * w, (1 - 2 * y / view.height) * w, 0, w});
      }
    for (int j = 0; j < kParts; ++j)
      for (int i = 0; i < kParts; ++i) {
        const auto v = first + static_cast<std::uint32_t>(j * (kParts + 1) + i);
        for (const std::uint32_t offset : {0U, kParts + 1U, 1U, 1U, kParts + 1U, kParts + 2U})
          scene.indices.push_back(v + offset);
      }
  };
  for (int row = 0; row < count; ++row)
    for (int column = 0; column < count; ++column) {
      const double left = view.width / 2.0 + (column - count / 2) * side, top = row * side;
      const auto tangent = [&](double x) { return (left + x - view.width / 2.0) * pixel; };
      // Anywhere within a few steps of storage: each pair at another offset between two codes.
      const double jitter = 1 + random.uniform(0, 8) * step / z;
      const SlopingPlane nearer{z * std::min(jitter, 1.05), view.slope, tangent(cell / 2.0)};
      // Along the screen a plane's 1/z, and so t, changes evenly: one budget for all of it.
      const DepthBudget budget = bound.budget(bound.screen_slope(nearer.depth, view.slope, pixel), view.slope == 0);
      double ratio = 0;  // of the separation to the depth, at its largest
      for (int x = 0; x <= 4 * (cell + 1); ++x) {
        const double depth = nearer.at(tangent(x / 4.0));
        ratio = std::max(ratio, bound.separation(depth, budget).total() / depth);
      }
      const SlopingPlane farther{nearer.depth * (1 + part * ratio), view.slope, nearer.middle};
      const auto fits = [&](double x) {
        return nearer.at(tangent(x)) >= bound.scale().near() && farther.at(tangent(x)) <= bound.scale().far();
      };
      if (view.slope * (cell + 1) * pixel > 1 || !fits(0) || !fits(cell + 1)) continue;
      add_surface(nearer, left, top);
      add_surface(farther, left, top);
    }
  scene.commands.push_back(Draw{0, 0, Topology::triangles, 0, scene.indices.size(), 0});
  return scene;
}

}  // namespace halfplane
