// Smooth lines and points: their coverage of a pixel is the exact area, their codes are the line's, and every engine
// draws them equally.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "../functional_case.hpp"
#include "../scene_builder.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/golden.hpp"
#include "model/golden/line.hpp"
#include "model/host/line_setup.hpp"
#include "model/host/smooth_raster.hpp"
#include "sim/study/antialiasing/study.hpp"
#include "sim/study/compare/compare.hpp"

namespace halfplane::smooth_test {
namespace {

using test::at;
using test::Random;
using test::SceneBuilder;

constexpr int kTarget = 32;  // pixels
constexpr PixelBounds kWholeTarget{0, 0, kTarget - 1, kTarget - 1};

SnappedVertex random_end(Random& random, int grid_bits) {
  const auto coordinate = [&] { return random.index((kTarget + 8) << grid_bits) - (4 << grid_bits); };
  SnappedVertex v;
  v.x = coordinate();
  v.y = coordinate();
  return v;
}

TEST(SmoothRaster, CoverageIsTheExactAreaRounded) {
  constexpr std::uint32_t kSeed = 41;
  Random random(kSeed);
  double worst = 0, worst_area = 0;
  std::size_t parts = 0;
  for (int n = 0; n < 60; ++n) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", line " + std::to_string(n));
    const int grid_bits = 1 + n % 8;
    const SnappedVertex start = random_end(random, grid_bits), end = random_end(random, grid_bits);
    const auto corners = line_rectangle(start, end, 1 + random.index(16) / 4.0, grid_bits);
    if (!corners) continue;
    const auto& [a, b, c, d] = *corners;
    std::vector<Triangle> halves(2);
    halves[0].v = {a, b, c};
    halves[1].v = {c, d, a};
    const auto exact = antialiasing::covered_areas(halves, kTarget, kTarget, grid_bits);
    std::map<std::pair<int, int>, std::uint32_t> drawn;
    for (const SmoothPixel& pixel : smooth_raster(*corners, kWholeTarget, grid_bits))
      EXPECT_TRUE(drawn.emplace(std::pair{pixel.x, pixel.y}, pixel.coverage).second) << "a pixel comes twice";
    for (int y = 0; y < kTarget; ++y)
      for (int x = 0; x < kTarget; ++x) {
        const double area = exact[static_cast<std::size_t>(y * kTarget + x)];
        worst_area = std::max(worst_area, std::abs(area_in_pixel(*corners, x, y, grid_bits) - area));
        const auto found = drawn.find({x, y});
        const double shown = found == drawn.end() ? 0 : static_cast<double>(found->second) / kWholePixel;
        worst = std::max(worst, std::abs(shown - area));
        parts += area > 0 && area < 1 ? 1 : 0;
      }
  }
  EXPECT_LE(worst_area, 1e-9);
  EXPECT_LE(worst, 0.5 / kWholePixel + 1e-9);
  EXPECT_GT(parts, 2000U);
}

TEST(SmoothRaster, CodesBesideALineAreTheNearestPointsRounded) {
  const Widths widths = derive_widths(preset("full"));
  Random random(43);
  for (int n = 0; n < 2000; ++n) {
    SnappedVertex start = random_end(random, widths.grid_bits), end = random_end(random, widths.grid_bits);
    if (start.x == end.x && start.y == end.y) continue;
    start.code[kDepthPlane] = static_cast<std::uint32_t>(random.index(1 << 24));
    end.code[kDepthPlane] = static_cast<std::uint32_t>(random.index(1 << 24));
    const int x = random.index(kTarget), y = random.index(kTarget);
    const double dx = end.x - start.x, dy = end.y - start.y, step = std::ldexp(1.0, widths.grid_bits);
    const double t = std::clamp(
        (((x + 0.5) * step - start.x) * dx + ((y + 0.5) * step - start.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    const double exact =
        start.code[kDepthPlane] + t * (static_cast<double>(end.code[kDepthPlane]) - start.code[kDepthPlane]);
    EXPECT_NEAR(CodesBeside(start, end, widths)(x, y)[kDepthPlane], exact, 0.5 + 1e-6);
  }
}

TEST(SmoothRaster, OfPointsIsTheAreaOfSquareOrDisc) {
  constexpr std::uint32_t kSeed = 47;
  Random random(kSeed);
  constexpr int kGridBits = 6;
  double worst = 0;
  std::size_t parts = 0;
  for (int n = 0; n < 400; ++n) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", point " + std::to_string(n));
    State state;
    state.point_shape = n % 2 == 0 ? PointShape::square : PointShape::round;
    const std::int32_t size = (1 << kGridBits) + random.index(n % 3 == 0 ? 40 : 900);
    state.point_size = std::ldexp(size, -kGridBits);
    const SnappedVertex point = random_end(random, kGridBits);
    golden::ScreenVertex<double> real;
    real.x = std::ldexp(point.x, -kGridBits);
    real.y = std::ldexp(point.y, -kGridBits);
    double sum = 0;
    for (int y = -24; y < kTarget + 24; ++y)
      for (int x = -24; x < kTarget + 24; ++x) {
        const double exact = golden::area_in_pixel(real, state, x, y);
        const double area = area_in_pixel(point, size, state.point_shape, x, y, kGridBits);
        worst = std::max(worst, std::abs(area - exact));
        sum += exact;
        parts += exact > 0 && exact < 1 ? 1 : 0;
      }
    const double whole = state.point_size * state.point_size;
    EXPECT_NEAR(sum, state.point_shape == PointShape::round ? whole * std::acos(-1.0) / 4 : whole, 1e-6);
    for (const SmoothPixel& pixel : smooth_raster(point, size, state.point_shape, kWholeTarget, kGridBits))
      EXPECT_NEAR(static_cast<double>(pixel.coverage) / kWholePixel,
                  golden::area_in_pixel(real, state, pixel.x, pixel.y), 0.5 / kWholePixel + 0.004);
  }
  EXPECT_LE(worst, 0.004);
  EXPECT_GT(worst, 0.001);
  EXPECT_GT(parts, 4000U);
}

/// Smooth lines and points, blended by alpha over a grey ground.
Scene smooth_lines(std::uint32_t seed) {
  Random random(seed);
  SceneBuilder builder(kTarget, kTarget);
  Scene& scene = builder.scene;
  std::get<Clear>(scene.commands[0]).color = std::array<double, 4>{40, 60, 80, 255};
  for (std::uint32_t k = 0; k < 4; ++k) {
    State state = SceneBuilder::window_state();
    state.smooth = true;
    state.line_rule = static_cast<LineRule>(random.index(4));  // smooth lines ignore it
    state.line_width = 1 + random.index(20) / 4.0;
    state.blend = BlendFactors{BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha};
    state.depth_write = k == 0;
    if (k == 3) state.scissor = Rect{5, 7, 20, 18};
    scene.states.push_back(state);
    state.point_size = 1 + random.index(40) / 8.0;
    state.point_shape = static_cast<PointShape>(random.index(2));
    const std::array topologies{Topology::lines, Topology::line_loop, Topology::points, Topology::lines};
    const auto number = static_cast<std::uint32_t>(scene.states.size() - 1);
    scene.commands.push_back(Draw{number, 0, topologies[k], scene.indices.size(), 4, 0});
    for (int i = 0; i < 4; ++i) {
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      const double x = random.between(-3, kTarget + 3), y = random.between(-3, kTarget + 3), z = random.unit();
      const double red = random.index(256), alpha = 128 + random.index(128);
      scene.vertices.push_back(at(x, y, z, {red, 200, 90, alpha}));
    }
  }
  return scene;
}

TEST(Smooth, EveryEngineDrawsThemAlikeAndNearTheGolden) {
  Config plain = preset("embedded");
  plain.color_format = ColorFormat::rgba8888;
  plain.alpha_units = 1;
  plain.blend_lanes = 4;
  double worst = 0;
  std::uint64_t near = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scene scene = smooth_lines(seed);
    const Rendering scalar = render_scalar(scene, plain);
    test::expect_all_same(scene, plain);
    const Rendering other = render_hardware(scene, plain);
    EXPECT_EQ(scalar.frame.color, other.frame.color);
    EXPECT_EQ(scalar.frame.depth, other.frame.depth);
    const Comparison c = compare(scene, plain);
    const auto broken = broken_bounds(c, plain);
    EXPECT_TRUE(broken.empty()) << broken.front();
    EXPECT_EQ(c.coverage.near_edge, c.coverage.missing + c.coverage.extra);
    near += c.coverage.near_edge;
    worst = std::max(worst, c.color_lsb.max);
  }
  EXPECT_GT(near, 0U);
  // The snap moves a side by up to 0.09 pixels and turns it: the area changes by as much of a pixel, of 255.
  EXPECT_LT(worst, 40);
  EXPECT_GT(worst, 1);
}

TEST(Smooth, IsNotLookedAtWhereAPixelHasSeveralSamplesNorWithTriangles) {
  Config config = preset("embedded");
  config.msaa_samples = 4;
  Scene scene = smooth_lines(5);
  const auto picture = [&](bool is_smooth) {
    for (State& state : scene.states) state.smooth = is_smooth;
    return render_functional(scene, config).frame.color;
  };
  EXPECT_EQ(picture(true), picture(false));
  config.msaa_samples = 1;
  EXPECT_NE(picture(true), picture(false));
  for (Command& command : scene.commands)
    if (auto* draw = std::get_if<Draw>(&command)) {
      draw->topology = Topology::triangles;
      draw->count = 3;
    }
  EXPECT_EQ(picture(true), picture(false));
}

TEST(Smooth, WithoutAlphaToSeeItTheyAreEveryPixelTheyTouch) {
  SceneBuilder builder(kTarget, kTarget);
  builder.scene.states[0].smooth = true;
  builder.scene.states[0].line_width = 2;
  builder.scene.vertices = {at(4, 10.25), at(20, 10.25)};
  builder.scene.indices = {0, 1};
  builder.scene.commands.push_back(Draw{.topology = Topology::lines, .count = 2});
  RenderOptions options;
  options.want_count = true;
  const Rendering rendering = render_functional(builder.scene, preset("embedded"), options);
  EXPECT_EQ(rendering.counters.covered, 16U * 3U);  // rows 9 to 11, of which two in part
}

}  // namespace
}  // namespace halfplane::smooth_test
