#include "sim/study/bench/growth.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <utility>

#include "model/engines/functional.hpp"
#include "sim/interrupt.hpp"
#include "sim/scene/mesh_scene.hpp"
#include "sim/study/bench/engines.hpp"

namespace halfplane {
namespace {

// Number of cells that fit the target: a quotient like 20 may be rounded down slightly.
int whole_cells(int pixels, double cell) { return std::max(1, static_cast<int>(pixels / cell + 1e-9)); }
int grid_columns(const LayeredGrid& grid) { return whole_cells(grid.width, grid.cell_width); }
int grid_rows(const LayeredGrid& grid) { return whole_cells(grid.height, grid.cell_height); }

/// A point of a series before it is measured.
struct GrowthPoint {
  double x;
  LayeredGrid grid;
  int threads;
};

struct GrowthTarget {
  int width, height;
};

GrowthTarget target_within(const Config& config, int width, int height) {
  return {std::min(width, config.target_width), std::min(height, config.target_height)};
}

/// 1, 3, 10, 30... up to `last`.
std::vector<double> half_decades(double first, double last) {
  std::vector<double> steps;
  for (double decade = first; decade <= last; decade *= 10)
    for (const double step : {decade, 3 * decade})
      if (step <= last) steps.push_back(step);
  return steps;
}

// A million pixels, limited by the number of triangles.
std::vector<GrowthPoint> size_points(const GrowthPlan& plan) {
  const GrowthTarget target = target_within(plan.config, 1920, 1080);
  const double aspect = static_cast<double>(target.width) / target.height;
  const double pixels = static_cast<double>(std::min<std::size_t>(1'000'000, plan.most_triangles));
  std::vector<GrowthPoint> points;
  for (const double size : half_decades(1, pixels)) {
    LayeredGrid grid{target.width, target.height, std::sqrt(2 * size * aspect), std::sqrt(2 * size / aspect)};
    if (grid.cell_width > target.width || grid.cell_height > target.height) {
      if (plan.left_out)
        plan.left_out("triangle_size from " + std::to_string(std::llround(size)) + " pixels: the target is " +
                      std::to_string(target.width) + "x" + std::to_string(target.height) + "; add --config full");
      break;
    }
    grid.triangles = static_cast<std::size_t>(std::llround(pixels / size));
    points.push_back({size, grid, plan.threads});
  }
  return points;
}

// Cells of 4 x 5 pixels, so that the two triangles of a cell have 20 at any position.
std::vector<GrowthPoint> count_points(const GrowthPlan& plan) {
  const GrowthTarget target = target_within(plan.config, 640, 480);
  std::vector<GrowthPoint> points;
  for (const double count : half_decades(100, static_cast<double>(plan.most_triangles)))
    points.push_back({count, {target.width, target.height, 4, 5, static_cast<std::size_t>(count)}, plan.threads});
  return points;
}

std::vector<GrowthPoint> layer_points(const GrowthPlan& plan, bool front_to_back) {
  const GrowthTarget target = target_within(plan.config, 640, 480);
  LayeredGrid grid{target.width, target.height, target.width / 20.0, target.height / 15.0, 0, front_to_back};
  const std::size_t layer = triangles_of_layer(grid);
  std::vector<GrowthPoint> points;
  for (const int layers : {1, 2, 5, 10, 20, 50, 100}) {
    grid.triangles = layer * static_cast<std::size_t>(layers);
    if (layers == 1 || grid.triangles <= plan.most_triangles)
      points.push_back({static_cast<double>(layers), grid, plan.threads});
  }
  return points;
}

std::vector<GrowthPoint> resolution_points(const GrowthPlan& plan) {
  constexpr std::size_t kPixelsATriangle = 100;  // with the bound of --growth-max
  std::vector<GrowthPoint> points;
  for (int side = 64; side <= 4096; side *= 2) {
    const auto pixels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    if (side > 64 && pixels > plan.most_triangles * kPixelsATriangle) break;
    if (side > plan.config.target_width || side > plan.config.target_height) {
      if (plan.left_out)
        plan.left_out("resolution from " + std::to_string(side) + "x" + std::to_string(side) + ": targets end at " +
                      std::to_string(plan.config.target_width) + "x" + std::to_string(plan.config.target_height) +
                      "; add --config full");
      break;
    }
    LayeredGrid grid{side, side, side / 16.0, side / 16.0};
    grid.triangles = triangles_of_layer(grid);
    points.push_back({static_cast<double>(side), grid, plan.threads});
  }
  return points;
}

std::vector<GrowthPoint> thread_points(const GrowthPlan& plan) {
  const GrowthTarget target = target_within(plan.config, 1920, 1080);
  LayeredGrid grid{target.width, target.height, target.width / 120.0, target.height / 72.0};
  grid.triangles = std::min(4 * triangles_of_layer(grid), std::max<std::size_t>(plan.most_triangles, 2));
  std::vector<GrowthPoint> points;
  for (int threads = 1; threads <= plan.most_threads; ++threads)
    points.push_back({static_cast<double>(threads), grid, threads});
  return points;
}

void measure_series(const std::string& name, const std::vector<GrowthPoint>& points, const GrowthPlan& plan,
                    const std::function<void(double)>& progress, std::vector<GrowthRow>& rows) {
  std::vector<Frame> frames;
  std::vector<GrowthRow> series;
  RenderOptions nothing_skipped;
  nothing_skipped.skip = skip_none();
  for (const GrowthPoint& point : points) {
    progress(0);
    const auto scene = std::make_shared<const Scene>(make_layered_grid(point.grid));
    const Counters counters = render_functional(*scene, plan.config, nothing_skipped).counters;
    series.push_back({name, point.x, counters.primitives_in, counters.covered, {}});
    frames.push_back(make_frame("functional", scene, plan.config, point.threads));
  }
  auto times = measure_in_turns(frames, plan.repeat, progress);
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (times[i].refusal) std::rethrow_exception(times[i].refusal);
    if (times[i].seconds.empty()) continue;  // the study was ended early
    series[i].times = std::move(times[i]);
    rows.push_back(std::move(series[i]));
  }
}

}  // namespace

std::size_t triangles_of_layer(const LayeredGrid& grid) {
  return 2 * static_cast<std::size_t>(grid_columns(grid)) * static_cast<std::size_t>(grid_rows(grid));
}

Scene make_layered_grid(const LayeredGrid& grid) {
  Scene scene = cleared_scene(grid.width, grid.height);
  const int columns = grid_columns(grid);
  const std::size_t layer_size = triangles_of_layer(grid);
  const std::size_t layers = (grid.triangles + layer_size - 1) / layer_size;
  scene.indices.reserve(3 * grid.triangles);
  for (std::size_t layer = 0; layer < layers; ++layer) {
    const double place = (static_cast<double>(layer) + 0.5) / static_cast<double>(layers);  // 0...1 in program order
    const double z = grid.front_to_back ? 1.8 * place - 0.9 : 0.9 - 1.8 * place;
    const std::size_t count = std::min(layer_size, grid.triangles - layer * layer_size);
    const std::size_t used_rows =
        (count + 2 * static_cast<std::size_t>(columns) - 1) / (2 * static_cast<std::size_t>(columns));
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    for (std::size_t row = 0; row <= used_rows; ++row)
      for (int column = 0; column <= columns; ++column) {
        const double x = column * grid.cell_width / grid.width,
                     y = static_cast<double>(row) * grid.cell_height / grid.height;
        scene.vertices.push_back({2 * x - 1, 1 - 2 * y, z, 1, {255 * x, 255 * y, 255 * place, 255}, x, y});
      }
    for (std::size_t i = 0; i < count; ++i) {
      const auto cell = static_cast<std::uint32_t>(i / 2), across = static_cast<std::uint32_t>(columns);
      const std::uint32_t a = first + cell / across * (across + 1) + cell % across, b = a + across + 1;
      if (i % 2 == 0)
        scene.indices.insert(scene.indices.end(), {a, b, a + 1});
      else
        scene.indices.insert(scene.indices.end(), {a + 1, b, b + 1});
    }
  }
  scene.commands.emplace_back(Draw{0, 0, Topology::triangles, 0, scene.indices.size()});
  return scene;
}

const std::vector<GrowthSeries>& growth_series() {
  static const std::vector<GrowthSeries> kSeries{
      {"triangle_size", "pixels of a triangle", "A million pixels in all, or as many as the triangles allowed."},
      {"triangle_count", "triangles", "Every triangle has 10 pixels; layers lie over each other, back to front."},
      {"depth_back_to_front", "layers", "Layers of 600 triangles that fill the target, back to front: all are drawn."},
      {"depth_front_to_back", "layers", "The same layers, front to back: only the first is seen."},
      {"resolution", "pixels along a side", "512 triangles fill a square target."},
      {"threads", "threads", "Four layers of 120 x 72 cells, two triangles each, back to front."}};
  return kSeries;
}

std::vector<GrowthRow> measure_growth(const GrowthPlan& plan) {
  const std::vector<std::pair<std::string, std::function<std::vector<GrowthPoint>()>>> makers{
      {"triangle_size", [&] { return size_points(plan); }},
      {"triangle_count", [&] { return count_points(plan); }},
      {"depth_back_to_front", [&] { return layer_points(plan, false); }},
      {"depth_front_to_back", [&] { return layer_points(plan, true); }},
      {"resolution", [&] { return resolution_points(plan); }},
      {"threads", [&] { return thread_points(plan); }}};
  std::vector<GrowthRow> rows;
  try {
    for (std::size_t i = 0; i < makers.size(); ++i)
      measure_series(
          makers[i].first, makers[i].second(), plan,
          [&, i](double fraction) {
            if (plan.progress) plan.progress((static_cast<double>(i) + fraction) / static_cast<double>(makers.size()));
          },
          rows);
  } catch (const Interrupted&) {  // the points so far are kept
  }
  return rows;
}

}  // namespace halfplane
