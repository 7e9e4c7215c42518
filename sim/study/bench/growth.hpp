// Growth of the functional engine's run time: with the size of triangles, their number, the depth complexity, the
// resolution and the threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "model/config.hpp"
#include "model/scene.hpp"
#include "sim/study/bench/turns.hpp"

namespace halfplane {

/// Layers of a grid of cells, two triangles each, with shared vertices in smooth colours. Every layer has its own
/// depth.
struct LayeredGrid {
  int width = 640, height = 480;             ///< target, pixels
  double cell_width = 32, cell_height = 32;  ///< pixels; at most the target's
  std::size_t triangles = 0;                 ///< cells are filled row by row, layer by layer, up to this number
  bool front_to_back = false;
};

/// Whole cells only: the rest of the target at its right and its bottom stays empty.
[[nodiscard]] Scene make_layered_grid(const LayeredGrid& grid);
[[nodiscard]] std::size_t triangles_of_layer(const LayeredGrid& grid);

struct GrowthRow {
  std::string series;
  double x = 0;
  std::uint64_t primitives = 0, fragments = 0;  ///< of the scene, with nothing skipped
  FrameTimes times;
  [[nodiscard]] double mtri_s() const { return static_cast<double>(primitives) / 1e6 / times.median(); }
  [[nodiscard]] double mpix_s() const { return static_cast<double>(fragments) / 1e6 / times.median(); }
};

/// The variable and the constants of a series.
struct GrowthSeries {
  std::string name;     ///< "triangle_size"
  std::string x;        ///< "pixels of a triangle"
  std::string meaning;  ///< one sentence: the constants
};
[[nodiscard]] const std::vector<GrowthSeries>& growth_series();

struct GrowthPlan {
  Config config;
  int threads = 1, repeat = 5;
  int most_threads = 1;                                   ///< the last of the series `threads`
  std::size_t most_triangles = 1'000'000;                 ///< limit per frame; fewer make the other series smaller too
  std::function<void(double)> progress;                   ///< 0...1; may be empty. Interrupted there ends the study
  std::function<void(const std::string& line)> left_out;  ///< points that do not fit the target; may be empty
};

/// Measures every series, the points of each in turns. A study ended early returns the points measured so far.
[[nodiscard]] std::vector<GrowthRow> measure_growth(const GrowthPlan& plan);

}  // namespace halfplane
