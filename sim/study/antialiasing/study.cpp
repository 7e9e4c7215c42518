#include "sim/study/antialiasing/study.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>

#include "model/engines/functional.hpp"
#include "model/engines/hardware.hpp"
#include "model/golden/golden.hpp"
#include "model/widths.hpp"
#include "sim/scene/random.hpp"
#include "sim/scene/scene_builder.hpp"
#include "sim/show/report/hardware.hpp"

namespace halfplane::antialiasing {

namespace {

/// A kind of antialiasing: samples per pixel, and the grid of pictures, if any.
struct Kind {
  std::string name;
  int msaa = 1;
  std::optional<SupersampleGrid> grid;
  bool is_smooth = false;
  [[nodiscard]] int samples() const { return is_smooth ? 0 : grid ? grid->side * grid->side : msaa; }
};

std::vector<Kind> kinds(const Scene& scene) {
  std::vector<Kind> list;
  for (const int samples : {1, 2, 4, 8})
    list.push_back({samples == 1 ? "1 sample" : "msaa " + std::to_string(samples), samples, {}});
  for (const char* grid : {"2x2", "2x2:rotated", "4x4", "4x4:rotated"})
    list.push_back({"supersample " + std::string(grid), 1, parse_supersample(grid)});
  const bool has_lines =
      std::ranges::any_of(scene.states, [](const State& state) { return state.line_rule == LineRule::rectangle; });
  if (has_lines) list.push_back({"smooth", 1, {}, true});
  return list;
}

/// The scene with smooth lines, blended by alpha.
Scene smooth(Scene scene) {
  for (State& state : scene.states) {
    state.smooth = true;
    state.blend = BlendFactors{BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha};
  }
  return scene;
}

/// The hardware for a kind; none: not with this configuration.
std::optional<Config> hardware_of(Config config, const Kind& kind, const Scene& scene) {
  config.frame_order = FrameOrder::bins;
  config.frame_store = FrameStore::color;
  config.frame_clears = FrameClears::flags;
  config.msaa_samples = kind.msaa;
  config.resolve_units = kind.msaa > 1 ? 1 : 0;
  while (config.stamp_size * config.stamp_size * config.msaa_samples > 64) config.stamp_size /= 2;
  if (kind.is_smooth) {
    config.alpha_units = 1;
    config.blend_lanes = std::max(1, config.blend_lanes);
  }
  try {
    validate(config);
    check_hardware_scene(scene, config);
  } catch (const InputError&) {
    return std::nullopt;
  }
  return config;
}

/// A frame of it in the cycle engine.
std::optional<AreaHardware> hardware_frame(const Scene& scene, const Config& config, const Kind& kind) {
  const auto own = hardware_of(config, kind, scene);
  if (!own) return std::nullopt;
  AreaHardware result{*own, 0, 0};
  const auto draw = [&result](const Scene& of) {
    CycleRendering frame = run_cycles(of, {result.config, {}, {}});
    result.cycles += frame.run.cycles;
    result.bytes += traffic(frame.run, result.config).total();
    return std::move(frame.rendering);
  };
  if (!kind.grid) {
    (void)draw(scene);
    return result;
  }
  (void)supersampled(scene, result.config, *kind.grid, draw);
  const int pictures = kind.grid->side * kind.grid->side + 1;  // pictures read, and the picture written
  const std::uint64_t pixel = derive_widths(result.config).stored_color.bits <= 16 ? 2 : 4;
  result.bytes += static_cast<std::uint64_t>(pictures) * static_cast<std::uint64_t>(scene.width * scene.height) * pixel;
  return result;
}

/// The white fraction of a pixel, 0 to 1, in the stored format.
double whiteness(std::uint32_t color, ColorFormat format) {
  return static_cast<double>(golden::stored_channel(color, format, 1)) / golden::channel_max(format)[1];
}

/// Fills the errors of a picture.
void judge(const Framebuffer& frame, ColorFormat format, const std::vector<double>& area, AreaRow& row) {
  double squares = 0, sum = 0;
  std::size_t edges = 0, p = 0;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x, ++p) {
      const double error = whiteness(frame.color[frame.at(x, y)], format) - area[p];
      row.max = std::max(row.max, std::abs(error));
      if (area[p] <= 0 || area[p] >= 1) continue;
      ++edges;
      squares += error * error;
      sum += error;
    }
  if (edges == 0) return;
  row.rms = std::sqrt(squares / static_cast<double>(edges));
  row.mean = sum / static_cast<double>(edges);
}

/// The pictures of a kind, drawn as in a program: each scene is prepared once.
class Frames {
 public:
  Frames(const Scene& scene, const Config& config, const Kind& kind)
      : scene_(kind.is_smooth ? smooth(scene) : scene), kind_(kind), config_(config), engine_(config) {}

  Rendering draw() {
    if (!kind_.grid) return engine_.render(scene_);
    return supersampled(scene_, config_, *kind_.grid, [this](const Scene& moved) { return engine_.render(moved); });
  }

 private:
  Scene scene_;
  const Kind& kind_;
  Config config_;
  FunctionalEngine engine_;
};

}  // namespace

Scene blades(int width, int height, std::uint64_t seed) {
  Random random(seed);
  SceneBuilder builder(width, height);
  const double cx = width / 2.0, cy = height / 2.0, longest = std::min(width, height) * 0.48, inner = longest * 0.2;
  constexpr int kBlades = 64;
  const auto at = [&](double radius, double angle) {
    return Vertex{.x = cx + radius * std::cos(angle), .y = cy + radius * std::sin(angle), .z = 0.5};
  };
  for (int i = 0; i < kBlades; ++i) {
    const double step = 2 * std::acos(-1.0) / kBlades, from = (i + 0.3 * random.uniform(0, 1)) * step;
    const double width_of = step * 0.6 * std::exp2(-(i % 8));
    builder.triangle(at(inner, from), at(longest, from), at(longest, from + width_of));
  }
  return std::move(builder.scene);
}

Scene spokes(int width, int height, std::uint64_t seed) {
  Random random(seed);
  SceneBuilder builder(width, height);
  builder.scene.states.clear();
  builder.scene.commands.clear();
  State state = SceneBuilder::window_state();
  state.line_rule = LineRule::rectangle;
  const double cx = width / 2.0, cy = height / 2.0, longest = std::min(width, height) * 0.48;
  constexpr int kSpokes = 64, kWidths = 4;
  for (std::uint32_t k = 0; k < kWidths; ++k) {
    state.line_width = 1 + k;
    builder.scene.states.push_back(state);
    if (k == 0) builder.scene.commands.push_back(Clear{0, std::array<double, 4>{0, 0, 0, 255}, 1.0});
    builder.scene.commands.push_back(
        Draw{k, 0, Topology::lines, builder.scene.indices.size(), 2 * kSpokes / kWidths, 0});
    for (int i = static_cast<int>(k); i < kSpokes; i += kWidths) {
      const double angle = (i + 0.3 * random.uniform(0, 1)) * 2 * std::acos(-1.0) / kSpokes;
      for (const double radius : {longest * 0.4, longest}) {
        builder.scene.indices.push_back(static_cast<std::uint32_t>(builder.scene.vertices.size()));
        builder.scene.vertices.push_back(at(cx + radius * std::cos(angle), cy + radius * std::sin(angle)));
      }
    }
  }
  return std::move(builder.scene);
}

AreaStudy measure_areas(const Scene& scene, const Config& config, int repeat,
                        const std::function<void(double)>& progress) {
  using Clock = std::chrono::steady_clock;
  AreaStudy study;
  RenderOptions options;
  options.want_triangles = true;
  const auto area = covered_areas(render_functional(scene, config, options).triangles, scene.width, scene.height,
                                  derive_widths(config).grid_bits);
  study.edge_pixels = static_cast<std::size_t>(std::ranges::count_if(area, [](double a) { return a > 0 && a < 1; }));
  const std::vector<Kind> list = kinds(scene);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Kind& kind = list[i];
    Config own = config;
    own.msaa_samples = kind.msaa;
    if (own.stamp_size * own.stamp_size * own.msaa_samples > 64) own.stamp_size = 2;  // no effect on a picture
    AreaRow row;
    row.kind = kind.name;
    row.samples = kind.samples();
    Frames frames(scene, own, kind);
    judge(frames.draw().frame, own.color_format, area, row);
    std::vector<double> times;
    for (int n = 0; n < repeat; ++n) {
      const auto start = Clock::now();
      (void)frames.draw();
      times.push_back(std::chrono::duration<double>(Clock::now() - start).count());
      progress((static_cast<double>(i) + static_cast<double>(n + 1) / repeat) / static_cast<double>(list.size()));
    }
    std::ranges::nth_element(times, times.begin() + repeat / 2);
    row.frame_s = times[static_cast<std::size_t>(repeat / 2)];
    row.hardware = hardware_frame(kind.is_smooth ? smooth(scene) : scene, config, kind);
    study.rows.push_back(row);
  }
  for (AreaRow& row : study.rows)
    row.is_front = std::ranges::none_of(study.rows, [&row](const AreaRow& other) {
      return &other != &row && other.rms <= row.rms && other.frame_s <= row.frame_s;
    });
  return study;
}

namespace {

struct Point {
  mpq_class x, y;
};
using Polygon = std::vector<Point>;

/// The part of the polygon with sign * (coordinate - border) >= 0, for one coordinate of a point.
Polygon clipped(const Polygon& polygon, mpq_class Point::*coordinate, const mpq_class& border, int sign) {
  const auto inside_by = [&](const Point& p) { return mpq_class(sign * (p.*coordinate - border)); };
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const mpq_class da = inside_by(a), db = inside_by(b);
    if (da >= 0) kept.push_back(a);
    if ((da < 0) == (db < 0)) continue;
    const mpq_class t = da / (da - db);
    kept.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
  }
  return kept;
}

mpq_class area_of(const Polygon& polygon) {
  mpq_class doubled = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    doubled += a.x * b.y - b.x * a.y;
  }
  return abs(doubled) / 2;
}

Polygon in_pixels(const Triangle& triangle, int grid_bits) {
  Polygon polygon;
  for (const SnappedVertex& v : triangle.v) {
    Point p{mpq_class(v.x, 1L << grid_bits), mpq_class(v.y, 1L << grid_bits)};
    p.x.canonicalize();
    p.y.canonicalize();
    polygon.push_back(p);
  }
  return polygon;
}

/// The part of a triangle between two lines at distance 1.
Polygon strip(const Polygon& polygon, mpq_class Point::*coordinate, int from) {
  return clipped(clipped(polygon, coordinate, from, 1), coordinate, from + 1, -1);
}

}  // namespace

mpq_class covered_area(const Triangle& triangle, int x, int y, int grid_bits) {
  return area_of(strip(strip(in_pixels(triangle, grid_bits), &Point::y, y), &Point::x, x));
}

std::vector<double> covered_areas(const std::vector<Triangle>& triangles, int width, int height, int grid_bits) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<mpq_class> sum(pixels);
  for (const Triangle& triangle : triangles) {
    const Polygon polygon = in_pixels(triangle, grid_bits);
    const auto [top, bottom] = std::minmax({triangle.v[0].y, triangle.v[1].y, triangle.v[2].y});
    for (int y = std::max(0, top >> grid_bits); y <= std::min(height - 1, bottom >> grid_bits); ++y) {
      const Polygon row = strip(polygon, &Point::y, y);
      if (row.empty()) continue;
      mpq_class left = row[0].x, right = left;
      for (const Point& p : row) {
        left = std::min(left, p.x);
        right = std::max(right, p.x);
      }
      const int first = std::max(0, static_cast<int>(std::floor(left.get_d())) - 1);  // get_d() may round
      const int last = std::min(width - 1, static_cast<int>(std::floor(right.get_d())) + 1);
      for (int x = first; x <= last; ++x)
        sum[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] +=
            area_of(strip(row, &Point::x, x));
    }
  }
  std::vector<double> areas;
  for (const mpq_class& area : sum) areas.push_back(area.get_d());
  return areas;
}

}  // namespace halfplane::antialiasing
