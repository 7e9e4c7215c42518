#include "sim/study/antialiasing/supersample.hpp"

#include <array>
#include <cstddef>
#include <string>

#include "model/golden/golden.hpp"
#include "model/host/primitives.hpp"

namespace halfplane::antialiasing {
namespace {

/// Moves the states that contain positions by (dx, dy) pixels to the right and down.
void move(State& state, double dx, double dy, int width, int height) {
  const double up = state.origin == Origin::bottom_left ? -1 : 1;
  const double corner = state.pixel_center == PixelCenter::integer ? -0.5 : 0;
  if (!state.viewport)
    state.viewport = Viewport{corner, corner, static_cast<double>(width), static_cast<double>(height)};
  state.viewport->x += dx;
  state.viewport->y += up * dy;
}

void add(Counters& sum, const Counters& c) {
  sum.covered += c.covered;
  sum.depth_passed += c.depth_passed;
  sum.alpha_killed += c.alpha_killed;
  sum.written += c.written;
  sum.samples_tested += c.samples_tested;
  sum.tiles_visited += c.tiles_visited;
  for (const SkipName& one : kSkipNames) sum.skipped.*one.counter += c.skipped.*one.counter;
}

/// The colours of some pictures, channel by channel.
class ColorSums {
 public:
  ColorSums(const Framebuffer& frame, ColorFormat format)
      : format_(format), channels_(golden::channel_count(format)), sum_(frame.color.size()) {}

  void add(const Framebuffer& frame) {
    ++pictures_;
    for (std::size_t p = 0; p < sum_.size(); ++p)
      for (int c = 0; c < channels_; ++c)
        sum_[p][static_cast<std::size_t>(c)] +=
            static_cast<std::uint32_t>(golden::stored_channel(frame.color[p], format_, c));
  }

  void store_mean(Framebuffer& frame) const {
    constexpr std::array<int, 4> k565{11, 5, 0, 0}, k8888{0, 8, 16, 24};
    const auto& shift = format_ == ColorFormat::rgb565 ? k565 : k8888;
    for (std::size_t p = 0; p < sum_.size(); ++p) {
      frame.color[p] = 0;
      for (std::size_t c = 0; c < static_cast<std::size_t>(channels_); ++c)
        frame.color[p] |= (sum_[p][c] + pictures_ / 2) / pictures_ << shift[c];
    }
  }

 private:
  ColorFormat format_;
  int channels_;
  std::uint32_t pictures_ = 0;
  std::vector<std::array<std::uint32_t, 4>> sum_;
};

}  // namespace

SupersampleGrid parse_supersample(std::string_view text) {
  constexpr std::string_view kRotated = ":rotated";
  SupersampleGrid grid;
  std::string_view size = text;
  grid.is_rotated = size.ends_with(kRotated);
  if (grid.is_rotated) size.remove_suffix(kRotated.size());
  if (size.size() == 3 && size[1] == 'x' && size[0] == size[2]) grid.side = size[0] - '0';
  if (grid.side < 2 || grid.side > 8)
    throw InputError("--supersample: '" + std::string(text) + "'; give NxN or NxN:rotated, N from 2 to 8, as in 4x4");
  return grid;
}

std::vector<Place> places_of(const SupersampleGrid& grid) {
  std::vector<Place> places;
  const double n = grid.side;
  for (int j = 0; j < grid.side; ++j)
    for (int i = 0; i < grid.side; ++i)
      // Rotated: row j of column i lies (j + 1/2) / N into the column, and column i of row j as far from its end into
      // the row.
      places.push_back(grid.is_rotated ? Place{(i + (j + 0.5) / n) / n, (j + (n - i - 0.5) / n) / n}
                                       : Place{(i + 0.5) / n, (j + 0.5) / n});
  return places;
}

Scene seen_from(Scene scene, const Place& place) {
  const double dx = 0.5 - place.x, dy = 0.5 - place.y;
  // A vertex may be used in draws of window and of clip space, and with either origin: each draw gets its own copy.
  std::vector<Vertex> vertices;
  for (State& state : scene.states)
    if (state.space == Space::clip) move(state, dx, dy, scene.width, scene.height);
  for (const Command& command : scene.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr) continue;
    const State& state = scene.states[draw->state];
    if (state.space == Space::clip) continue;
    const double up = state.origin == Origin::bottom_left ? -1 : 1;
    for (std::size_t i = draw->first; i < draw->first + draw->count; ++i) {
      std::uint32_t& index = scene.indices[i];
      if (index == kRestart) continue;
      Vertex moved = scene.vertices[index];
      moved.x += dx;
      moved.y += up * dy;
      index = static_cast<std::uint32_t>(scene.vertices.size() + vertices.size());
      vertices.push_back(moved);
    }
  }
  scene.vertices.insert(scene.vertices.end(), vertices.begin(), vertices.end());
  return scene;
}

Rendering supersampled(const Scene& scene, const Config& config, const SupersampleGrid& grid,
                       const std::function<Rendering(const Scene&)>& draw) {
  Rendering first;
  std::vector<ColorSums> sums;
  for (const Place& place : places_of(grid)) {
    Rendering picture = draw(seen_from(scene, place));
    if (sums.empty()) {
      first = std::move(picture);
      sums.emplace_back(first.frame, config.color_format);
      sums.back().add(first.frame);
      continue;
    }
    sums.back().add(picture.frame);
    add(first.counters, picture.counters);
    for (std::size_t p = 0; p < first.count.size(); ++p) first.count[p] += picture.count[p];
    first.geometry_s += picture.geometry_s;
    first.raster_s += picture.raster_s;
  }
  sums.back().store_mean(first.frame);
  return first;
}

}  // namespace halfplane::antialiasing
