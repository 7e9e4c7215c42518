// Lines as rectangles: their corners, their samples, and the parts of a draw's state that they use.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../scene_builder.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/golden.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/host/primitives.hpp"
#include "sim/study/compare/compare.hpp"

namespace halfplane::rectangle_test {
namespace {

using test::at;
using test::clip_at;
using test::Random;
using test::SceneBuilder;

constexpr int kSide = 40;  // of targets, pixels

SnappedVertex at_grid(std::int32_t x, std::int32_t y) {
  SnappedVertex v;
  v.x = x;
  v.y = y;
  return v;
}

State rectangle_lines(double width) {
  State state = SceneBuilder::window_state();
  state.line_rule = LineRule::rectangle;
  state.line_width = width;
  return state;
}

Scene scene_of_lines(const State& state, const std::vector<Vertex>& ends, Topology topology = Topology::lines,
                     int side = kSide) {
  SceneBuilder builder(side, side, state);
  for (const Vertex& v : ends) {
    builder.scene.indices.push_back(static_cast<std::uint32_t>(builder.scene.vertices.size()));
    builder.scene.vertices.push_back(v);
  }
  builder.scene.commands.push_back(Draw{.topology = topology, .count = ends.size()});
  return builder.scene;
}

Config with_samples_a_pixel(std::string_view name, int samples) {
  Config config = preset(name);
  config.msaa_samples = samples;
  while (config.stamp_size * config.stamp_size * samples > 64) config.stamp_size /= 2;
  return config;
}

RenderOptions counted() {
  RenderOptions options;
  options.want_count = options.want_ids = options.want_triangles = true;
  return options;
}

TEST(Rectangles, CornersAreTheEndsPlusAndMinusOneVectorAcrossTheLine) {
  constexpr std::uint32_t kSeed = 17;
  Random random(kSeed);
  for (int n = 0; n < 20000; ++n) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", line " + std::to_string(n));
    const int grid_bits = 1 + random.index(8);
    const std::int32_t reach = n % 2 == 0 ? 3 : 4000;
    const auto coordinate = [&] { return random.index(2 * reach + 1) - reach; };
    const std::int32_t x0 = coordinate(), y0 = coordinate(), x1 = coordinate(), y1 = coordinate();
    const SnappedVertex start = at_grid(x0, y0), end = at_grid(x1, y1);
    const double width = 1 + random.index(60) / 4.0;
    const auto corners = line_rectangle(start, end, width, grid_bits);
    ASSERT_EQ(corners.has_value(), x0 != x1 || y0 != y1);
    if (!corners) continue;
    const auto& [a, b, c, d] = *corners;
    EXPECT_TRUE(a.x + b.x == 2 * x0 && a.y + b.y == 2 * y0 && d.x + c.x == 2 * x1 && d.y + c.y == 2 * y1);
    EXPECT_TRUE(a.x - b.x == d.x - c.x && a.y - b.y == d.y - c.y) << "no parallelogram";
    EXPECT_NE(signed_area(a, b, c), 0);
    EXPECT_EQ(signed_area(a, b, c), signed_area(c, d, a));
    const double length = std::hypot(x1 - x0, y1 - y0), half = std::ldexp(width / 2, grid_bits);
    EXPECT_LE(std::abs(a.x - x0 + half * (y1 - y0) / length), 0.5 + 1e-9);
    EXPECT_LE(std::abs(a.y - y0 - half * (x1 - x0) / length), 0.5 + 1e-9);
    const auto turned = line_rectangle(end, start, width, grid_bits);
    ASSERT_TRUE(turned.has_value());
    const auto same = [](const SnappedVertex& p, const SnappedVertex& q) { return p.x == q.x && p.y == q.y; };
    EXPECT_TRUE(same((*turned)[0], c) && same((*turned)[1], d) && same((*turned)[2], a) && same((*turned)[3], b));
  }
}

/// Whether a convex polygon covers a point, both on the grid: by its sides; left and top sides own the points on them.
bool quad_covers(std::array<SnappedVertex, 4> v, std::int64_t x, std::int64_t y) {
  if (signed_area(v[0], v[1], v[2]) < 0) std::swap(v[1], v[3]);
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex &from = v[i], &to = v[(i + 1) % 4];
    const std::int64_t dx = std::int64_t{to.x} - from.x, dy = std::int64_t{to.y} - from.y;
    const std::int64_t e = dx * (y - from.y) - dy * (x - from.x);
    if (e < 0 || (e == 0 && !(dy < 0 || (dy == 0 && dx > 0)))) return false;
  }
  return true;
}

TEST(Rectangles, EverySampleInsideIsDrawnOnceByEveryEngine) {
  constexpr std::uint32_t kSeed = 23;
  Random random(kSeed);
  std::uint64_t drawn = 0;
  for (int n = 0; n < 240; ++n) {
    const int samples = 1 << n % 4;
    const Config config = with_samples_a_pixel(n % 3 == 0 ? "full" : n % 3 == 1 ? "embedded" : "small", samples);
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", line " + std::to_string(n) + ", " + config.preset + ", " +
                 std::to_string(samples) + " samples");
    const auto end = [&] {
      const double x = random.between(-4, kSide + 4), y = random.between(-4, kSide + 4);
      return n % 5 == 0 ? at(std::floor(x), std::floor(y)) : at(x, y);
    };
    const Vertex start = end(), stop = end();
    const double width = 1 + random.index(32) / 4.0;
    const Scene scene = scene_of_lines(rectangle_lines(width), {start, stop});
    const Rendering scalar = render_scalar(scene, config, counted());
    const Rendering functional = render_functional(scene, config, counted());
    EXPECT_EQ(scalar.count, functional.count);
    EXPECT_EQ(scalar.frame.color, functional.frame.color);
    EXPECT_EQ(scalar.frame.depth, functional.frame.depth);
    EXPECT_EQ(functional.frame.color, render_functional(scene, config, {}).frame.color);
    if (samples == 1) {
      const Rendering hardware = render_hardware(scene, config);
      EXPECT_EQ(scalar.frame.color, hardware.frame.color);
      EXPECT_EQ(scalar.frame.depth, hardware.frame.depth);
    }
    const Widths widths = derive_widths(config);
    const auto snapped = [&](const Vertex& v) { return snap_vertex({v.x, v.y, v.z}, v, config, {scene.name, 0, 0}); };
    const auto corners = line_rectangle(snapped(start), snapped(stop), width, widths.grid_bits);
    ASSERT_TRUE(corners.has_value());
    std::size_t p = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x, ++p) {
        std::uint32_t expected = 0;
        for (int k = 0; k < samples; ++k) {
          const SampleOffset o = samples == 1 ? SampleOffset{} : widths.sample_offset[static_cast<std::size_t>(k)];
          const std::int64_t half = std::int64_t{1} << (widths.grid_bits - 1);
          expected += quad_covers(*corners, x * 2 * half + half + o.x, y * 2 * half + half + o.y) ? 1 : 0;
        }
        ASSERT_EQ(scalar.count[p], expected) << x << "," << y;
        drawn += expected;
      }
  }
  EXPECT_GT(drawn, 50000U);
}

/// Crossing lines of every topology with the state that triangles would use.
std::vector<Vertex> zigzag() {
  return {at(3.25, 5.5, 0.2, {255, 0, 0, 255}), at(35.5, 9.75, 0.8, {0, 255, 0, 128}),
          at(6.5, 33.25, 0.4, {0, 0, 255, 255}), at(33, 36.5, 0.6, {255, 255, 0, 255})};
}

TEST(Rectangles, NeitherCullingNorFacingNorTexturesTouchThem) {
  Config config = preset("embedded");
  config.texture_unit = TextureUnitKind::nearest;
  config.stencil_bits = 8;
  State state = rectangle_lines(5.5);
  state.stencil = Stencil{};
  state.stencil->passes = StencilOp::incr;
  const auto pictures = [&](const State& of, const Vertex& first) {
    auto ends = zigzag();
    ends.front() = first;
    Scene scene = scene_of_lines(of, ends, Topology::line_strip);
    TexelImage image{1, 1, {{9, 9, 9, 9}}};
    scene.textures.push_back(make_texture("gray", image, TextureFormat::rgba8888, Mips::none));
    const auto rows = [](const Rendering& r) { return std::tuple(r.frame.color, r.frame.depth, r.frame.stencil); };
    return std::array{rows(render_scalar(scene, config)), rows(render_functional(scene, config)),
                      rows(render_hardware(scene, config))};
  };
  for (const FrontFace front : {FrontFace::ccw, FrontFace::cw}) {
    state.front = front;
    state.cull = Cull::none;
    const auto plain = pictures(state, zigzag().front());
    EXPECT_EQ(plain[0], plain[1]);
    EXPECT_EQ(plain[0], plain[2]);
    State other = state;
    other.stencil_back = Stencil{};
    other.stencil_back->func = DepthFunc::never;
    other.texture = 0;
    for (const Cull cull : {Cull::none, Cull::front, Cull::back, Cull::both}) {
      other.cull = cull;
      EXPECT_EQ(pictures(other, zigzag().front()), plain);
    }
    EXPECT_NE(pictures(state, at(20, 3)), plain);
  }
}

TEST(Rectangles, TheJudgesAndTheGoldenAgree) {
  std::uint64_t near = 0, compared = 0;
  for (std::uint32_t seed = 1; seed <= 120; ++seed) {
    Random random(seed);
    const Config plain = with_samples_a_pixel(seed % 2 == 0 ? "embedded" : "full", 1 << random.index(4));
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + plain.preset + ", " + std::to_string(plain.msaa_samples) +
                 " samples");
    Scene scene = SceneBuilder(kSide, kSide).scene;
    for (int d = 0; d < 4; ++d) {
      State state = random_state(rectangle_lines(1 + random.index(24) / 4.0),
                                 states_named({"cull", "front", "shade", "provoking", "polygon_mode", "polygon_offset",
                                               "stencil", "stencil_back", "fog", "fog_color", "scissor"}),
                                 chooser(random));
      if (state.polygon_mode == PolygonMode::fill) state.polygon_mode = PolygonMode::line;
      scene.states.push_back(state);
      const std::size_t first = scene.indices.size();
      for (int i = 0; i < 6; ++i) {
        scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
        const double x = random.between(-8, kSide + 8), y = random.between(-8, kSide + 8), z = random.unit();
        const double red = random.index(256), green = random.index(256);
        scene.vertices.push_back(at(x, y, z, {red, green, 90, 255}));
        scene.vertices.back().w = random.between(0.5, 2);
      }
      scene.commands.push_back(Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0,
                                    static_cast<Topology>(random.index(6)), first, 6, 0});
    }
    const Config config = with_alpha(plain, scene);
    const Comparison c = compare(scene, config);
    if (c.rendering.counters.covered == 0) continue;
    const auto broken = broken_bounds(c, config);
    EXPECT_TRUE(broken.empty()) << broken.front();
    EXPECT_EQ(c.coverage.near_edge, c.coverage.missing + c.coverage.extra);
    near += c.coverage.near_edge;
    compared += c.compared_pixels;
  }
  EXPECT_GT(near, 20U);
  EXPECT_GT(compared, 30000U);
}

TEST(Rectangles, ALineBeyondTheGuardBandIsCutWhereNobodySeesIt) {
  const Config config = preset("embedded");
  const double band = config.guard_band - 1;
  State state = rectangle_lines(6);
  const auto filled_rows = [&](const std::vector<Vertex>& ends) {
    const Scene scene = scene_of_lines(state, ends);
    const Rendering rendering = render_functional(scene, config, counted());
    EXPECT_EQ(rendering.counters.clipped, 1U);
    EXPECT_EQ(rendering.count, golden::render(scene, config).count);
    EXPECT_EQ(rendering.frame.color, render_hardware(scene, config).frame.color);
    return std::count(rendering.count.begin(), rendering.count.end(), 1U) / kSide;
  };
  EXPECT_EQ(filled_rows({at(-band, 20), at(band, 20)}), 6);
  EXPECT_EQ(filled_rows({at(12, band), at(12, -band)}), 6);
  state.origin = Origin::bottom_left;
  EXPECT_EQ(filled_rows({at(-band, 10), at(band, 10)}), 6);
  state.origin = Origin::top_left;
  state.space = Space::clip;
  EXPECT_EQ(filled_rows({clip_at(-1e4, 0, 0, 1), clip_at(1e4, 0, 0, 1)}), 6);
  state.line_width = config.guard_band - 3 - kSide;
  EXPECT_EQ(filled_rows({clip_at(-1e4, 0, 0, 1), clip_at(1e4, 0, 0, 1)}), kSide);
  state.line_width += 1;
  EXPECT_THROW((void)render_functional(scene_of_lines(state, {at(1, 1), at(9, 9)}), config), InputError);
}

TEST(Rectangles, OfALineBesideTheGuardBandNothingIsLeft) {
  const Vertex inside = at(10, 20), beside = at(120, 20), far = at(140, -20), below = at(10, 200);
  EXPECT_FALSE(clip_to_square(100, beside, far));
  EXPECT_FALSE(clip_to_square(100, below, below));
  const auto cut = clip_to_square(100, inside, beside);
  ASSERT_TRUE(cut);
  EXPECT_EQ((*cut)[1].x, 100);
}

TEST(Rectangles, HardwareWithoutAUnitForLinesDrawsThem) {
  Config config = preset("embedded");
  config.line_units = 0;
  Scene scene = scene_of_lines(rectangle_lines(1), zigzag(), Topology::line_loop);
  EXPECT_EQ(render_hardware(scene, config).frame.color, render_scalar(scene, config).frame.color);
  scene.states[0].line_rule = LineRule::diamond;
  EXPECT_THROW((void)render_hardware(scene, config), InputError);
}

TEST(RectanglesMustFail, TheOracleNoticesASampleOfOneThatIsMissingOrDrawnTwice) {
  const Config config = with_samples_a_pixel("embedded", 4);
  const Scene scene = scene_of_lines(rectangle_lines(3), zigzag(), Topology::line_strip);
  const auto mismatches = [&](int turn) {
    CompareOptions options;
    int left = 5;  // tiles left: the sixth is damaged
    options.engine = [&](const Scene& drawn, const Config& of, const RenderOptions& asked) {
      RenderOptions changed = asked;
      changed.coverage_tap = [&](std::uint32_t triangle, int x, int y, TileMask mask, int sample) {
        if (left-- == 0)
          for (auto& row : mask) row = turn == 0 ? row : turn == 1 ? row & (row - 1) : row | row >> 1U;
        asked.coverage_tap(triangle, x, y, mask, sample);
      };
      return render_functional(drawn, of, changed);
    };
    return compare(scene, config, options).oracle.mismatches;
  };
  EXPECT_EQ(mismatches(0), 0U);
  EXPECT_GT(mismatches(1), 0U);
  EXPECT_GT(mismatches(2), 0U);
}

}  // namespace
}  // namespace halfplane::rectangle_test
