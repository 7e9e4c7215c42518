// Clipping::homogeneous: the golden without clipping equals the clipped one; the model's rounded edges stay within
// their derived bound, every sample lies on one side of a shared edge, and the remaining faults at vertices are
// counted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "../scene_builder.hpp"
#include "../tier.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/golden.hpp"
#include "model/host/viewport.hpp"
#include "model/study/homogeneous_setup.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/study/compare/double_draws.hpp"

namespace halfplane::homogeneous_test {
namespace {

using test::clip_at;
using test::Random;
using test::SceneBuilder;

constexpr double kNear = 0.1, kFar = 20;
constexpr int kWidth = 90, kHeight = 70;

/// A point of eye space (x right, y up, z forward) through a camera of 90 degrees.
Vertex project(double x, double y, double z, const State& state, std::array<double, 4> rgba) {
  const double depth = kFar / (kFar - kNear) * (z - kNear);  // 0 at near, w at far
  return clip_at(x, y, state.clip_z == ClipZ::zero_one ? depth : 2 * depth - z, z, rgba);
}

/// Ranges, conventions, viewport, scissor.
State random_state(Random& random) {
  State state;
  state.depth_test = DepthFunc::always;
  return random_state(
      state, without_operations(states_but({"space", "depth_test", "depth_write", "color_write", "polygon_mode"})),
      chooser(random));
}

/// One triangle with a vertex on each side of the eye plane.
Scene crossing_triangle(std::uint32_t seed, int width, int height) {
  Random random(seed);
  const State state = random_state(random);
  SceneBuilder builder(width, height, state);
  std::array<Vertex, 3> v;
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = random.between(-2, 2), y = random.between(-2, 2);
    const double z = i == 0 ? random.between(0.05, 6) : i == 1 ? -random.between(0, 3) : random.between(-3, 6);
    std::array<double, 4> rgba{};
    for (double& channel : rgba) channel = random.index(256);
    v[i] = project(x, y, z, state, rgba);
  }
  std::rotate(v.begin(), v.begin() + random.index(3), v.end());
  builder.triangle(v[0], v[1], v[2]);
  return builder.scene;
}

golden::Image golden_by(const Scene& scene, const Config& config, Clipping clipping,
                        std::optional<ColorInterp> color_interp = {}) {
  golden::Options options;
  options.color_interp = color_interp;
  options.clipping = clipping;
  return golden::render(scene, config, options);
}

Rendering model_by(const Scene& scene, const Config& config, Clipping clipping) {
  RenderOptions options;
  options.want_count = options.want_ids = true;
  options.rules.clipping = clipping;
  return render_scalar(scene, config, options);
}

/// How far a pixel's centre lies from the lines that bound a triangle, near and far among them: pixels, in long double.
class BoundLines {
 public:
  BoundLines(const Scene& scene, std::size_t first_index) {
    const State& state = scene.states[std::get<Draw>(scene.commands.back()).state];
    const Viewport vp = effective_viewport(state, scene.width, scene.height);
    std::array<std::array<Real, 3>, 3> v;
    std::array<Real, 3> near{}, far{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex& c = scene.vertices[scene.indices[first_index + i]];
      const Real w = c.w;
      v[i] = {vp.x * w + (c.x + w) / 2 * vp.width, vp.y * w + (w - c.y) / 2 * vp.height, w};
      near[i] = state.clip_z == ClipZ::zero_one ? Real(c.z) : Real(c.z) + w;
      far[i] = w - c.z;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const auto &p = v[(i + 1) % 3], &q = v[(i + 2) % 3];
      line_[i] = {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
      for (std::size_t k = 0; k < 3; ++k) {
        line_[3][k] += near[i] * line_[i][k];
        line_[4][k] += far[i] * line_[i][k];
      }
    }
  }

  [[nodiscard]] double distance(int x, int y) const {
    Real nearest = INFINITY;
    for (const auto& [a, b, c] : line_)
      nearest = std::min(nearest, std::abs(a * (x + Real(0.5)) + b * (y + Real(0.5)) + c) / std::hypot(a, b));
    return static_cast<double>(nearest);
  }

 private:
  using Real = long double;
  std::array<std::array<Real, 3>, 5> line_{};
};

/// Calls visit(x, y, i) for every pixel.
template <class Visit>
void for_each_pixel(const Scene& scene, Visit&& visit) {
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) visit(x, y, static_cast<std::size_t>(y * scene.width + x));
}

TEST(HomogeneousGolden, TwoThousandTrianglesAcrossTheEyePlaneGiveThePixelsOfTheClippedOnes) {
  const Config config = preset("embedded");
  std::uint64_t covered = 0, differ = 0, crossing = 0;
  double worst_depth = 0, worst_color = 0;
  for (std::uint32_t seed = 1; seed <= 2000; ++seed) {
    const Scene scene = crossing_triangle(seed, 64, 48);
    const auto by = [&](Clipping clipping) { return golden_by(scene, config, clipping, ColorInterp::perspective); };
    const golden::Image polygon = by(Clipping::polygon), whole = by(Clipping::homogeneous);
    const BoundLines lines(scene, 0);
    crossing += whole.counters.covered > 0 ? 1 : 0;
    for_each_pixel(scene, [&](int x, int y, std::size_t p) {
      covered += polygon.count[p];
      if (polygon.count[p] != whole.count[p]) {
        ++differ;
        EXPECT_LT(lines.distance(x, y), 1e-9) << "seed " << seed << ", pixel " << x << ", " << y;
      } else if (whole.count[p] == 1) {
        worst_depth = std::max(worst_depth, std::abs(polygon.depth[p] - whole.depth[p]));
        for (std::size_t c = 0; c < 4; ++c)
          worst_color = std::max(worst_color, std::abs(polygon.color[p][c] - whole.color[p][c]));
      }
    });
  }
  RecordProperty("covered", std::to_string(covered));
  RecordProperty("differ", std::to_string(differ));
  RecordProperty("worst_depth_lsb", std::to_string(worst_depth));
  RecordProperty("worst_color", std::to_string(worst_color));
  EXPECT_GT(crossing, 800u);
  EXPECT_GT(covered, 400000u);
  EXPECT_EQ(differ, 0u);
  EXPECT_LT(worst_depth, 1e-4);
  EXPECT_LT(worst_color, 1e-4);
}

TEST(HomogeneousGolden, ScenesGiveTheSamePixels) {
  CameraRequest close;  // the lid's knob behind the eye
  close.eye = Vec3{0.4, 1.2, 1.1};
  close.target = Vec3{-0.3, 0.3, -1};
  close.near = 0.4;
  const auto differences = [](const Scene& scene) {
    const golden::Image polygon = golden_by(scene, preset("embedded"), Clipping::polygon),
                        whole = golden_by(scene, preset("embedded"), Clipping::homogeneous);
    std::uint64_t differ = 0, ids = 0;
    for_each_pixel(scene, [&](int, int, std::size_t p) {
      differ += polygon.count[p] != whole.count[p] ? 1 : 0;
      ids += polygon.ids[p] != whole.ids[p] ? 1 : 0;
    });
    return std::array{differ, ids, whole.counters.covered, polygon.counters.clipped};
  };
  for (const auto* name : {"walk", "city", "teapot", "close teapot"}) {
    const bool is_close = std::string_view(name) == "close teapot";
    const auto [differ, ids, covered, clipped] =
        differences(make_builtin(is_close ? "teapot" : name, 320, 240, is_close ? close : CameraRequest{}, 1));
    std::cout << name << ": " << differ << " counts and " << ids << " owners differ of " << covered << ", " << clipped
              << " clipped\n";
    EXPECT_EQ(differ, 0u) << name;
    EXPECT_EQ(ids, 0u) << name;
    EXPECT_GT(covered, 10000u) << name;
  }
}

/// Samples in which the model's coverage is not the golden's, and how far the farthest lies from a bounding line.
struct EdgeError {
  std::uint64_t covered = 0, differ = 0, clipped_differ = 0;  ///< the last: of the model that clips and snaps
  double farthest = 0;                                        ///< pixels
  double worst_depth = 0;                                     ///< LSB, where both cover
  int worst_color = 0;                                        ///< codes, likewise
};

/// Scenes as large as the target: every pixel counts for the bound.
EdgeError measure_edges(const Config& config, std::uint32_t seeds) {
  EdgeError error;
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
    const Scene scene = crossing_triangle(seed, config.target_width, config.target_height);
    const golden::Image real = golden_by(scene, config, Clipping::homogeneous);
    const Rendering model = model_by(scene, config, Clipping::homogeneous);
    const Rendering clipped = model_by(scene, config, Clipping::polygon);
    const BoundLines lines(scene, 0);
    for_each_pixel(scene, [&](int x, int y, std::size_t p) {
      error.covered += real.count[p];
      error.clipped_differ += real.count[p] != clipped.count[p] ? 1 : 0;
      const std::size_t at = model.frame.at(x, y);
      if (real.count[p] != model.count[p]) {
        ++error.differ;
        error.farthest = std::max(error.farthest, lines.distance(x, y));
      } else if (real.count[p] == 1) {
        const double half_lsb = scene.states[0].polygon_offset[0] != 0 ? 0.5 : 0;  // the offset is a whole code
        error.worst_depth = std::max(error.worst_depth, std::abs(real.depth[p] - model.frame.depth[at]) - half_lsb);
        for (int c = 0; c < golden::channel_count(config.color_format); ++c)
          error.worst_color = std::max(
              error.worst_color,
              std::abs(static_cast<int>(golden::stored_channel(real.frame.color[at], config.color_format, c)) -
                       static_cast<int>(golden::stored_channel(model.frame.color[at], config.color_format, c))));
      }
    });
  }
  return error;
}

TEST(Homogeneous, RoundedEdgesDepthAndColorStayWithinTheirBoundsInEveryPreset) {
  for (const std::string_view name : preset_names()) {
    SCOPED_TRACE(name);
    Config config = preset(name);
    config.target_width = std::min(config.target_width, kWidth);
    config.target_height = std::min(config.target_height, kHeight);
    const EdgeError error = measure_edges(config, test::cases(500U, 2000U));
    const double bound = homogeneous_edge_bound(config);
    std::cout << name << ": " << error.differ << " of " << error.covered
              << " samples differ (clipped: " << error.clipped_differ << "), up to " << error.farthest
              << " px from an edge (bound " << bound << "); depth " << error.worst_depth << " LSB, colour "
              << error.worst_color << '\n';
    EXPECT_LE(error.farthest, bound);
    EXPECT_LT(error.differ, error.clipped_differ);  // an edge is rounded once; the snap moves both of its ends
    EXPECT_LE(bound, std::ldexp(0.5, -config.subpixel_bits));
    // Unsnapped, and no reciprocal.
    EXPECT_LE(error.worst_depth, depth_error_bound(config) - std::ldexp(1.0, -config.reciprocal_extra_bits));
    EXPECT_LE(error.worst_color, 1);
    EXPECT_GT(error.covered, test::cases(2500U, 10000U));
  }
}

TEST(HomogeneousMustFail, TheBoundOfMoreSubpixelsRejectsTheEdgesOfFewer) {
  Config fine = preset("embedded");
  fine.target_width = kWidth;
  fine.target_height = kHeight;
  Config coarse = fine;
  coarse.subpixel_bits = 0;
  EXPECT_GT(measure_edges(coarse, 200).farthest, homogeneous_edge_bound(fine));
}

HomogeneousFrame frame_of(const Scene& scene, const Config& config, const Widths& widths) {
  const State& state = scene.states[0];
  return {config, widths, state, effective_viewport(state, scene.width, scene.height),
          raster_rect(state, scene.width, scene.height)};
}

TEST(Homogeneous, SharedEdgesAreNegatedToTheLastBitWhereverTheirEndsLie) {
  const Config config = preset("full");
  const Widths widths = derive_widths(config);
  const Scene scene = SceneBuilder(200, 100, State{}).scene;
  const HomogeneousFrame frame = frame_of(scene, config, widths);
  int pairs = 0;
  for (std::uint32_t seed = 1; seed <= 3000; ++seed) {
    Random random(seed);
    std::array<Vertex, 4> v;
    for (Vertex& vertex : v) {
      const double x = random.between(-2, 2), y = random.between(-2, 2);
      const double scale = std::ldexp(1.0, random.index(40) - 20);  // triangles of very different scale share edges
      vertex = project(x * scale, y * scale, random.between(-1, 5) * scale, State{}, {});
    }
    const HomogeneousSetup one = setup_homogeneous({v[0], v[1], v[2]}, frame),
                           other = setup_homogeneous({v[1], v[0], v[3]}, frame);
    if (one.rejection != Rejection::none || other.rejection != Rejection::none) continue;
    ++pairs;
    int negated = 0, equal = 0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const LinearFunction &e = one.bound[i], &f = other.bound[j];
        negated += e.a == -f.a && e.b == -f.b && e.c + f.c == -1 ? 1 : 0;  // E >= 0 for exactly one of them
        equal += e.a == f.a && e.b == f.b && e.c == f.c ? 1 : 0;           // one of the two is seen from behind
      }
    EXPECT_EQ(negated + equal, 1) << "seed " << seed;
  }
  EXPECT_GT(pairs, 500);
}

TEST(Homogeneous, AllSixOrdersOfTheVerticesGiveTheSameBits) {
  const Config config = preset("embedded");
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    Scene scene = crossing_triangle(seed, 48, 40);
    scene.states[0].cull = Cull::none;
    scene.states[0].shade = Shade::smooth;
    const Rendering first = model_by(scene, config, Clipping::homogeneous);
    std::array<std::uint32_t, 3> order{0, 1, 2};
    while (std::next_permutation(order.begin(), order.end())) {
      scene.indices.assign(order.begin(), order.end());
      const Rendering other = model_by(scene, config, Clipping::homogeneous);
      EXPECT_EQ(first.count, other.count) << "seed " << seed;
      EXPECT_EQ(first.frame.depth, other.frame.depth) << "seed " << seed;
      EXPECT_EQ(first.frame.color, other.frame.color) << "seed " << seed;
    }
  }
}

TEST(Homogeneous, EveryValueFitsItsWidth) {
  const auto fits = [](const Width& width, std::int64_t value) {
    return width.range.lo <= value && value <= width.range.hi;
  };
  for (const std::string_view name : preset_names()) {
    const Config config = preset(name);
    const Widths widths = derive_widths(config);
    const HomogeneousWidths w = derive_homogeneous_widths(config);
    for (const Width* width : w.all()) EXPECT_LE(width->bits, 60) << name << ' ' << width->name;
    for (std::uint32_t seed = 1; seed <= 500; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      const Scene scene = crossing_triangle(seed, config.target_width, config.target_height);
      const auto& v = scene.vertices;
      const HomogeneousSetup setup = setup_homogeneous({v[0], v[1], v[2]}, frame_of(scene, config, widths));
      const int right = scene.width - 1, bottom = scene.height - 1;
      for (const LinearFunction& bound : setup.bound) {
        EXPECT_TRUE(fits(w.coefficient, bound.a) && fits(w.coefficient, bound.b));
        EXPECT_TRUE(fits(w.edge_value, bound.c));
        for (const int x : {0, right})
          for (const int y : {0, bottom}) EXPECT_TRUE(fits(w.edge_value, bound.at(x, y)));
      }
      const int columns = setup.triangle.right - setup.triangle.left, rows = setup.triangle.bottom - setup.triangle.top;
      if (!setup.is_perspective) continue;
      EXPECT_TRUE(fits(w.weight_step, setup.weight.a) && fits(w.weight_step, setup.weight.b));
      for (const int x : {0, columns})
        for (const int y : {0, rows}) {
          EXPECT_TRUE(fits(w.weight, setup.weight.at(x, y)));
          for (const LinearFunction& color : setup.code_weight) {
            EXPECT_TRUE(fits(w.color_step, color.a) && fits(w.color_step, color.b));
            EXPECT_TRUE(fits(w.color_weight, color.at(x, y)));
          }
        }
    }
  }
}

/// A cube round the eye, turned, each face of n x n uneven squares of two triangles: seen once in every direction.
Scene cube_round_the_eye(int n, int width, int height) {
  State state;
  state.depth_test = DepthFunc::always;
  SceneBuilder builder(width, height, state);
  Random random(7);
  const auto corner = [&](int axis, double side, double s, double t) {
    std::array<double, 3> p{};
    p[static_cast<std::size_t>(axis)] = side;
    p[static_cast<std::size_t>((axis + 1) % 3)] = s;
    p[static_cast<std::size_t>((axis + 2) % 3)] = t;
    const double a = 0.6 * p[0] + 0.8 * p[1], b = -0.8 * p[0] + 0.6 * p[1];  // two turns, by 3-4-5 and 5-12-13
    return project((5 * a + 12 * p[2]) / 13, b, (-12 * a + 5 * p[2]) / 13, state, {255, 255, 255, 255});
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      std::vector<Vertex> grid;
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
          const bool is_rim = i == 0 || i == n || j == 0 || j == n;  // shared with the next face
          const double di = is_rim ? 0 : random.between(-0.2, 0.2), dj = is_rim ? 0 : random.between(-0.2, 0.2);
          grid.push_back(corner(axis, side, 2 * (i + di) / n - 1, 2 * (j + dj) / n - 1));
        }
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const auto k = static_cast<std::size_t>(j * (n + 1) + i), row = static_cast<std::size_t>(n + 1);
          builder.triangle(grid[k], grid[k + 1], grid[k + row + 1]).triangle(grid[k], grid[k + row + 1], grid[k + row]);
        }
    }
  return builder.scene;
}

struct MeshError {
  std::int64_t holes = 0, doubles = 0;
};

MeshError mesh_error(const std::vector<std::uint32_t>& count) {
  MeshError error;
  for (const std::uint32_t n : count) {
    error.holes += n == 0 ? 1 : 0;
    error.doubles += n > 1 ? 1 : 0;
  }
  return error;
}

TEST(Homogeneous, AMeshRoundTheEyeIsDrawnOnceButForSamplesByAVertexFourTimesFewerWithEachBit) {
  const Scene scene = cube_round_the_eye(128, 640, 480);
  std::vector<std::int64_t> errors;
  for (const int bits : {0, 1, 2, 4, 6}) {
    Config config = preset("embedded");
    config.target_width = 640;
    config.target_height = 480;
    config.subpixel_bits = bits;
    const MeshError clipped = mesh_error(model_by(scene, config, Clipping::polygon).count),
                    whole = mesh_error(model_by(scene, config, Clipping::homogeneous).count);
    EXPECT_EQ(clipped.holes + clipped.doubles, 0) << bits;  // the snap keeps the ends of edges together
    std::cout << bits << " subpixel bits: " << whole.holes << " holes, " << whole.doubles << " double draws of "
              << 640 * 480 << '\n';
    errors.push_back(whole.holes + whole.doubles);
  }
  EXPECT_GT(errors[0], 50);
  EXPECT_LT(errors[2], errors[0] / 4);
  EXPECT_LE(errors[4], 1);
}

TEST(Homogeneous, ScenesDifferFromClippingOnlyAlongEdges) {
  CameraRequest close;
  close.eye = Vec3{0.4, 1.2, 1.1};
  close.target = Vec3{-0.3, 0.3, -1};
  close.near = 0.4;
  for (const std::string_view preset_name : {"embedded", "full"})
    for (const std::string_view name : {"walk", "city", "teapot", "close teapot"}) {
      const bool is_close = name == "close teapot";
      const Config config = preset(preset_name);
      const Scene scene = make_builtin(is_close ? "teapot" : name, 640, 480, is_close ? close : CameraRequest{}, 1);
      const Rendering polygon = model_by(scene, config, Clipping::polygon),
                      whole = model_by(scene, config, Clipping::homogeneous);
      const golden::Image real = golden_by(scene, config, Clipping::polygon);
      std::array<std::uint64_t, 3> differ{};  // between the two models, and of each from the golden
      for (std::size_t p = 0; p < whole.count.size(); ++p) {
        differ[0] += whole.count[p] != polygon.count[p] || whole.ids[p] != polygon.ids[p] ? 1 : 0;
        differ[1] += polygon.count[p] != real.count[p] || polygon.ids[p] != real.ids[p] ? 1 : 0;
        differ[2] += whole.count[p] != real.count[p] || whole.ids[p] != real.ids[p] ? 1 : 0;
      }
      const std::uint64_t doubles = count_draws(scene, config, {.clipping = Clipping::homogeneous}).doubled;
      std::cout << preset_name << ' ' << name << ": " << differ[0] << " differ; from the golden " << differ[1]
                << " clipped, " << differ[2] << " homogeneous; " << doubles << " double draws, "
                << polygon.counters.clipped << " clipped, tested " << polygon.counters.samples_tested << " and "
                << whole.counters.samples_tested << '\n';
      EXPECT_EQ(whole.counters.clipped, 0u);
      EXPECT_LT(differ[2], differ[1]) << name;  // an edge is rounded once; the snap moves both its ends
      if (name != "walk") continue;             // the corridor covers every pixel once
      EXPECT_EQ(std::ranges::count(whole.count, 1u), 640 * 480);
      EXPECT_EQ(doubles, 0u);
    }
}

TEST(Homogeneous, DoubleDrawsAreCountedAgainstTheClippedMesh) {
  Config config = preset("embedded");
  config.target_width = 320;
  config.target_height = 240;
  config.subpixel_bits = 0;
  const Scene scene = cube_round_the_eye(64, 320, 240);
  std::uint64_t expected = 0;
  for (const std::uint32_t n : model_by(scene, config, Clipping::homogeneous).count) expected += n > 1 ? n - 1 : 0;
  EXPECT_GT(expected, 10u);
  EXPECT_EQ(count_draws(scene, config, {.clipping = Clipping::homogeneous}).doubled, expected);
}

TEST(Homogeneous, WindowSpaceLinesAndPointsAreDrawnAsEver) {
  const Config config = preset("embedded");
  SceneBuilder window(40, 30);
  window.triangle(test::at(1, 2, 0.3), test::at(37, 5, 0.9), test::at(8, 29, 0.1));
  for (const Scene& scene : {window.scene, make_builtin("star", 64, 64, {}, 1), make_builtin("wires", 64, 48, {}, 1)}) {
    const Rendering polygon = model_by(scene, config, Clipping::polygon),
                    whole = model_by(scene, config, Clipping::homogeneous);
    EXPECT_EQ(polygon.frame.color, whole.frame.color) << scene.name;
    EXPECT_EQ(polygon.frame.depth, whole.frame.depth) << scene.name;
    EXPECT_GT(whole.counters.covered, 0u) << scene.name;
  }
}

TEST(Homogeneous, NumbersAtTheEndsOfBinary64AndFlatTrianglesDrawNothingWrong) {
  const Config config = preset("embedded");
  for (const double scale : {1e-300, 1e-150, 1.0, 1e150, 1e300}) {
    SceneBuilder builder(32, 32, State{});
    const auto v = [scale](double x, double y, double w) { return clip_at(x * scale, y * scale, 0, w * scale); };
    builder.triangle(v(-0.5, -0.5, 1), v(0.5, -0.5, 1), v(0, 0.5, 1));  // 32 px wide, half of it
    EXPECT_EQ(model_by(builder.scene, config, Clipping::homogeneous).counters.covered,
              golden_by(builder.scene, config, Clipping::polygon).counters.covered)
        << scale;
    builder.triangle(v(0, 0, 1), v(0, 0, 1), v(1, 1, -1)).triangle(v(0, 0, 0), v(0, 0, 0), v(0, 0, 0));
    builder.triangle(v(0, 0, 1), v(1e-200, 0, 1), v(0, 1e-200, 1));
    EXPECT_EQ(model_by(builder.scene, config, Clipping::homogeneous).counters.drawn, 1u) << scale;
  }
}

TEST(Homogeneous, SkipChangesNothingAndWhatIsNotThereIsRefused) {
  const Config config = preset("embedded");
  const Scene scene = make_builtin("city", 160, 120, {}, 1);
  RenderOptions options;
  options.rules.clipping = Clipping::homogeneous;
  const Rendering all = render_scalar(scene, config, options);
  options.skip = {false, false, false, false, false};
  EXPECT_EQ(render_scalar(scene, config, options).frame.color, all.frame.color);
  EXPECT_THROW((void)render_functional(scene, config, options), InputError);
  options.want_triangles = true;
  EXPECT_THROW((void)render_scalar(scene, config, options), InputError);
  options.want_triangles = false;
  options.rules.traversal = Traversal::bbox;
  EXPECT_THROW((void)render_scalar(scene, config, options), InputError);
}

}  // namespace
}  // namespace halfplane::homogeneous_test
