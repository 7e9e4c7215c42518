// Stages at the ends of their range: refusals, empty results and cases that scenes seldom have.
#include <gtest/gtest.h>

#include <limits>

#include "../scene_builder.hpp"
#include "model/host/clip.hpp"
#include "model/host/viewport.hpp"
#include "model/packets/packet_words.hpp"
#include "model/stages/cull.hpp"
#include "model/stages/hiz.hpp"
#include "model/stages/line_raster.hpp"
#include "model/stages/triangle_setup.hpp"
#include "model/study/fill_rule.hpp"
#include "model/study/homogeneous_setup.hpp"

namespace halfplane::stage_corners_test {
namespace {

std::string refusal(const WindowPosition& p, const Config& config) {
  try {
    (void)snap_vertex(p, Vertex{}, config, {"scene.hpt", 7, 3});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Viewport, AVertexThatSnapsToNoCodeIsRefusedOnEverySideAndTheOneBesideItIsTaken) {
  const Config config = preset("tiny");  // 2 subpixel bits, +-32 pixels
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const WindowPosition& p : {WindowPosition{32, 0, 0},
                                  {0, 32, 0},
                                  {-32.25, 0, 0},
                                  {0, -32.25, 0},
                                  {0, 0, 1.01},
                                  {0, 0, -0.01},
                                  {1e9, 0, 0},
                                  {0, -1e9, 0},
                                  {0, 0, 3},
                                  {0, 0, -3},
                                  {nan, 0, 0},
                                  {0, nan, 0},
                                  {0, 0, nan}}) {
    const std::string text = refusal(p, config);
    EXPECT_EQ(text.rfind("scene.hpt: draw from line 7: vertex 3 at window (", 0), 0u) << text;
    EXPECT_NE(text.find("must snap into [-32, 32) pixels and z into [0, 1]"), std::string::npos) << text;
  }
  const SnappedVertex low = snap_vertex({-32, -32, 0}, Vertex{}, config, {});
  EXPECT_EQ((std::array{low.x, low.y}), (std::array{-128, -128}));
  const SnappedVertex high = snap_vertex({31.75, 31.75, 1}, Vertex{}, config, {});
  EXPECT_EQ((std::array{high.x, high.y}), (std::array{127, 127}));
  EXPECT_EQ(high.depth(), 255u);
}

TEST(Viewport, ADrawOfNoFilesLineIsNamedWithoutOne) {
  EXPECT_EQ(place_of_draw("teapot", 0), "teapot");
  EXPECT_EQ(place_of_draw("a.hpt", 12), "a.hpt: draw from line 12");
}

TEST(Viewport, ColoursBeyondTheRangeAreTheEndsCodes) {
  EXPECT_EQ(snap_color(-3), 0);
  EXPECT_EQ(snap_color(300), 255);
  EXPECT_EQ(snap_color(127.5), 128);
}

TEST(Viewport, BottomLeftOriginTurnsVertexScissorAndViewportTheSameWay) {
  State state;
  state.origin = Origin::bottom_left;
  state.pixel_center = PixelCenter::integer;
  Vertex v;
  v.x = 2;
  v.y = 3;
  const WindowPosition p = window_position(v, state, 10);
  EXPECT_EQ((std::array{p.x, p.y}), (std::array{2.5, 6.5})) << "the centre of pixel (2, 3) from below";
  state.scissor = Rect{2, 3, 1, 1};
  const Rect rect = raster_rect(state, 20, 10);
  EXPECT_EQ((std::array{rect.x, rect.y, rect.width, rect.height}), (std::array{2, 6, 1, 1}));
  state.viewport = Viewport{0, 0, 4, 4};
  const Viewport viewport = effective_viewport(state, 20, 10);
  EXPECT_EQ((std::array{viewport.x, viewport.y}), (std::array{0.5, 5.5}));
}

TEST(Viewport, ClipZDecidesWhatDepthMeans) {
  State state;
  const Viewport viewport{0, 0, 8, 8};
  Vertex v;
  v.w = 2;
  v.z = 1;
  state.clip_z = ClipZ::zero_one;
  EXPECT_EQ(to_window(v, state, viewport).z, 0.5);
  state.clip_z = ClipZ::minus_one_one;
  EXPECT_EQ(to_window(v, state, viewport).z, 0.75);
}

TEST(FillRules, EachRuleOwnsTheEdgesThatItsDefinitionNames) {
  const auto at = [](std::int32_t x, std::int32_t y) { return SnappedVertex{x, y, 0, {}}; };
  const SnappedVertex a = at(0, 0), right = at(64, 0), below = at(0, 64);
  // A top edge and a left one, each way round.
  EXPECT_EQ(edge_bias(a, right, FillRule::top_left, 4), 0);
  EXPECT_EQ(edge_bias(right, a, FillRule::top_left, 4), 1);
  EXPECT_EQ(edge_bias(a, right, FillRule::offset_point, 4) + edge_bias(right, a, FillRule::offset_point, 4), 1);
  EXPECT_EQ(edge_bias(a, below, FillRule::offset_point, 4) + edge_bias(below, a, FillRule::offset_point, 4), 1);
  EXPECT_EQ(edge_bias(at(-16, 0), at(-16, 64), FillRule::offset_point, 4), 1) << "through the point: nobody's";
  EXPECT_EQ(edge_bias(at(-16, 64), at(-16, 0), FillRule::offset_point, 4), 1);
  EXPECT_EQ(edge_bias(right, a, FillRule::inclusive, 4), 0);
  EXPECT_EQ(edge_bias(a, right, FillRule::exclusive, 4), 1);
}

/// By its definition, sample by sample, over small triangles everywhere: in the middle of the target, at its border, and in
/// scissors that leave a few samples of larger ones.
TEST(Cull, ASmallTriangleIsDroppedIfAndOnlyIfItCoversNoSample) {
  const Config config = preset("embedded");
  const Widths widths = derive_widths(config);
  test::Random random(21);
  std::size_t dropped = 0, drawn = 0, large = 0;
  for (int n = 0; n < 300000; ++n) {
    PrimitivePacket in;
    const int reach = 16 << random.index(4), x = random.index(200), y = random.index(200);
    for (std::size_t i = 0; i < 3; ++i) {
      in.vertex.x[i] = x + random.index(reach);
      in.vertex.y[i] = y + random.index(reach);
    }
    const int left = random.index(12), top = random.index(12);
    in.box = n % 2 == 0 ? to_box({0, 0, 63, 63}) : to_box({left, top, left + random.index(3), top + random.index(3)});
    CounterPacket counters, ignored;
    const auto all = cull(in, widths, ignored);
    if (!all) continue;
    const bool is_kept = cull(in, widths, counters, true).has_value();
    ASSERT_EQ(counters.no_sample, is_kept ? 0u : 1u);
    const SetupPacket setup = setup_packet(*all, config, widths);
    const int first_x = all->box.left & ~7, first_y = all->box.top & ~7;
    int covered = 0;
    for (int j = all->box.top; j <= all->box.bottom; ++j)
      for (int i = all->box.left; i <= all->box.right; ++i) {
        bool is_covered = true;
        for (std::size_t e = 0; e < 3; ++e)
          is_covered = is_covered && setup.edge_value[e] + std::int64_t{setup.dx[e]} * (j - first_y) -
                                             std::int64_t{setup.dy[e]} * (i - first_x) >=
                                         0;
        covered += is_covered ? 1 : 0;
      }
    if (!is_kept) {
      ASSERT_EQ(covered, 0);
    }
    const auto [x_min, x_max] = std::minmax({in.vertex.x[0], in.vertex.x[1], in.vertex.x[2]});
    const auto [y_min, y_max] = std::minmax({in.vertex.y[0], in.vertex.y[1], in.vertex.y[2]});
    const bool is_small = x_max - x_min < 64 && y_max - y_min < 64 && all->box.right - all->box.left <= 1 &&
                          all->box.bottom - all->box.top <= 1;
    if (is_small) {
      ASSERT_EQ(is_kept, covered != 0);
    }
    (is_small ? is_kept ? drawn : dropped : large) += 1;
  }
  EXPECT_GT(dropped, 10000u);
  EXPECT_GT(drawn, 10000u);
  EXPECT_GT(large, 10000u);
}

TEST(Cull, EachReasonToDropIsCountedOnce) {
  const Config config = preset("tiny");
  const Widths widths = derive_widths(config);
  const auto counters_of = [&](PrimitiveKind kind, std::array<std::int32_t, 6> xy, int left, Cull mode, int top = 0) {
    PrimitivePacket in;
    in.kind = kind;
    in.cull = mode;
    for (std::size_t i = 0; i < 3; ++i) in.vertex.x[i] = xy[2 * i], in.vertex.y[i] = xy[2 * i + 1];
    in.box = to_box({left, top, 15, 15});
    CounterPacket counters;
    const bool is_kept = cull(in, widths, counters).has_value();
    return std::array<std::uint64_t, 5>{is_kept, counters.primitives_in, counters.zero_area, counters.backface,
                                        counters.empty};
  };
  using Counts = std::array<std::uint64_t, 5>;  // kept, in, zero area, back face, empty
  EXPECT_EQ(counters_of(PrimitiveKind::triangle, {0, 0, 40, 0, 0, 40}, 0, Cull::none), (Counts{1, 1, 0, 0, 0}));
  EXPECT_EQ(counters_of(PrimitiveKind::triangle, {0, 0, 40, 40, 20, 20}, 0, Cull::none), (Counts{0, 1, 1, 0, 0}));
  EXPECT_EQ(counters_of(PrimitiveKind::triangle, {0, 0, 40, 0, 0, 40}, 0, Cull::both), (Counts{0, 1, 0, 1, 0}));
  EXPECT_EQ(counters_of(PrimitiveKind::triangle, {0, 0, 1, 0, 0, 1}, 0, Cull::none), (Counts{0, 1, 0, 0, 1}));
  EXPECT_EQ(counters_of(PrimitiveKind::point, {}, 16, Cull::none), (Counts{0, 1, 0, 0, 1}));
  EXPECT_EQ(counters_of(PrimitiveKind::point, {}, 0, Cull::none), (Counts{1, 1, 0, 0, 0}));
  EXPECT_EQ(counters_of(PrimitiveKind::point, {}, 0, Cull::none, 16), (Counts{0, 1, 0, 0, 1}));
  EXPECT_EQ(counters_of(PrimitiveKind::rectangle, {}, 16, Cull::none), (Counts{0, 0, 0, 0, 0})) << "a clear";
}

TEST(Homogeneous, ATriangleBetweenPixelCentresBesideTheScissorIsEmpty) {
  const Config config = preset("tiny");
  const Widths widths = derive_widths(config);
  State state;
  const HomogeneousFrame frame{config, widths, state, {0, 0, 16, 16}, {0, 0, 4, 4}};
  std::array<Vertex, 3> v;
  v[0].x = 0.5, v[1].x = 0.75, v[2].y = 0.5;
  v[2].x = 0.5;
  const auto rejection = [&] { return setup_homogeneous(v, frame).rejection; };
  EXPECT_EQ(rejection(), Rejection::empty) << "inside the view, right of pixels 0 to 3";
  v[2].y = 0;
  EXPECT_EQ(rejection(), Rejection::zero_area);
  for (Vertex& vertex : v) vertex.x = vertex.y = vertex.z = vertex.w = 0;
  EXPECT_NE(rejection(), Rejection::none) << "no place at all";
}

TEST(Homogeneous, ATriangleWithTwoVerticesAtInfinityIsAQuarterOfTheView) {
  const Config config = preset("embedded");
  const Widths widths = derive_widths(config);
  const State state;
  const HomogeneousFrame frame{config, widths, state, {0, 0, 32, 32}, {0, 0, 32, 32}};
  std::array<Vertex, 3> v;  // from the middle to the right and up
  v[0].w = 1, v[1].x = 1, v[2].y = 1;
  v[1].w = v[2].w = 0;
  const HomogeneousSetup setup = setup_homogeneous(v, frame);
  ASSERT_EQ(setup.rejection, Rejection::none);
  std::uint64_t covered = 0;
  traverse_homogeneous(setup, [&](int x, int y) {
    EXPECT_TRUE(x >= 16 && y < 16) << x << " " << y;
    ++covered;
  });
  EXPECT_EQ(covered, 256u);
}

TEST(Homogeneous, FlatTrianglesHaveTheirProvokingVertexColorAndOffsetMovesDepthByCodes) {
  const Config config = preset("embedded");
  const Widths widths = derive_widths(config);
  test::SceneBuilder builder(32, 32, State{});
  const std::array<double, 4> red{255, 0, 0, 255}, blue{0, 0, 255, 255};
  builder.triangle(test::clip_at(-0.5, -0.5, 0, 1, red), test::clip_at(0.5, -0.5, 0, 1, blue),
                   test::clip_at(0, 0.5, 0, 1, blue));
  const auto& draw = std::get<Draw>(builder.scene.commands.back());
  for (const bool is_flat : {false, true}) {
    State state;
    state.shade = is_flat ? Shade::flat : Shade::smooth;
    state.polygon_offset = {0, is_flat ? 5.0 : 0.0};
    const HomogeneousFrame frame{config, widths, state, {0, 0, 32, 32}, {0, 0, 32, 32}};
    for_each_homogeneous(builder.scene, draw, frame, [&](const HomogeneousSetup& setup) {
      const Interpolated middle = interpolate_at(setup, widths, 16, 18);
      EXPECT_EQ(middle.code[kColorPlane + 2] == 0, is_flat);
      EXPECT_EQ(middle.code[kDepthPlane], is_flat ? 0x8005u : 0x8000u);
    });
  }
}

TEST(Clip, ATriangleOrALineWithAVertexAtTheEyeItselfIsNothing) {
  const ClipPlanes planes = view_volume_planes(ClipZ::minus_one_one);
  const Vertex eye = test::clip_at(0, 0, 0, 0), a = test::clip_at(0.5, 0, 0, 1), b = test::clip_at(0, 0.5, 0, 1);
  EXPECT_EQ(clip(planes, a, b, test::clip_at(0, 0, 0, 1)).size, 3);
  EXPECT_EQ(clip(planes, eye, a, b).size, 0);
  EXPECT_EQ(clip(planes, a, b, eye).size, 0);
  EXPECT_TRUE(clip(planes, a, b).has_value());
  EXPECT_FALSE(clip(planes, eye, a).has_value());
  EXPECT_FALSE(clip(planes, a, eye).has_value());
}

TEST(Hiz, ALineThatMayRaiseDepthsTakesTheBoundsAwayUntilAClear) {
  const Config config = preset("embedded");
  const Widths widths = derive_widths(config);
  Hiz hiz(config, widths, 0);
  hiz.clear(widths.tiles_x - 1, widths.tiles_y - 1, 0);
  SetupPacket triangle;
  triangle.state.depth_test = DepthFunc::less;
  const auto line = [](DepthFunc test, bool writes) {
    SetupPacket packet;
    packet.kind = PrimitiveKind::line;
    packet.state = {test, writes, false};
    return packet;
  };
  EXPECT_TRUE(hiz.is_eligible(triangle, widths));
  hiz.pass_line(line(DepthFunc::always, false));
  hiz.pass_line(line(DepthFunc::lequal, true));
  EXPECT_TRUE(hiz.is_eligible(triangle, widths)) << "neither raises a depth";
  hiz.pass_line(line(DepthFunc::greater, true));
  EXPECT_FALSE(hiz.is_eligible(triangle, widths));
  hiz.clear(0, 0, 0xffff);
  EXPECT_TRUE(hiz.is_eligible(triangle, widths));
}

TEST(LineRaster, EveryFieldOfAPixelHasTheWidthOfWhatItHolds) {
  const Widths widths = derive_widths(preset("tiny"));
  std::vector<std::pair<std::string, int>> fields;
  for (const auto& [field, width] : element_names<LinePixel>(widths)) fields.emplace_back(field, width.bits);
  const std::vector<std::pair<std::string, int>> expected{{"primitive_id", widths.primitive_id.bits},
                                                          {"x", 4},
                                                          {"y", 4},
                                                          {"is_last", 1},
                                                          {"code[depth]", 8},
                                                          {"code[red]", 8},
                                                          {"code[green]", 8},
                                                          {"code[blue]", 8}};
  EXPECT_EQ(fields, expected);
}

}  // namespace
}  // namespace halfplane::stage_corners_test
