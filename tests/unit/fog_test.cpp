// Fog: the table against real arithmetic and its bound, the mix, and scenes on every path.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../functional_case.hpp"
#include "../scene_builder.hpp"
#include "model/capture/capture.hpp"
#include "model/golden/fog.hpp"
#include "model/golden/golden.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/stages/fog.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/random_state.hpp"
#include "sim/study/compare/compare.hpp"

namespace halfplane::fog_test {
namespace {

using test::expect_all_same;
using test::Random;
using test::SceneBuilder;

constexpr double kCut = 1.0 / 65536;  // half of a place of q

Fog linear(double start, double end) { return {FogKind::linear, start, end}; }
Fog exponential(FogKind kind, double density) { return {kind, density, density}; }

std::vector<Fog> fogs() {
  std::vector<Fog> list;
  for (const double scale : {1.0, 0.7, 1e-9, 3e8}) {
    for (const FogKind kind : {FogKind::exp, FogKind::exp2}) list.push_back(exponential(kind, scale));
    for (const double start : {0.0, 0.001, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0, 2.0})
      list.push_back(linear(start * scale, scale));
  }
  return list;
}

/// q = 1/w as a code of 40 bits, the part of itself by which that is off.
std::uint32_t factor_at(const FogTable& table, double w) {
  int exponent = 0;
  const double mantissa = std::frexp(1 / w, &exponent);
  return table.factor(static_cast<std::uint64_t>(std::llround(std::ldexp(mantissa, 40))), 40 - exponent);
}

/// The worst error of a table over 24 octaves about a distance, minus the bound's part for q; LSB of 8 bits.
double worst_error(const FogTable& table, double about, double* part_of_bound = nullptr) {
  double worst = 0;
  for (int i = 0; i < 24 * 500; ++i) {
    const double w = about * std::exp2(-18 + i / 500.0);
    const double error =
        std::abs(std::ldexp(factor_at(table, w), -kFogFactorBits) - golden::fog_part(table.fog(), 1 / w));
    worst = std::max(worst, error);
    if (part_of_bound != nullptr) *part_of_bound = std::max(*part_of_bound, error / fog_error_bound(table, w, kCut));
  }
  return worst * 255;
}

double distance_of(const Fog& fog) { return fog.kind == FogKind::linear ? fog.end : 4 / fog.start; }

TEST(Fog, TheFactorIsTheRealOne) {
  for (const Fog& fog : fogs())
    for (int i = -400; i <= 400; ++i) {
      const double w = distance_of(fog) * std::exp2(i / 16.0);
      EXPECT_NEAR(fog_factor(fog, w), golden::fog_part(fog, 1 / w), 1e-13) << i;
    }
}

TEST(Fog, TheTableKeepsItsBound) {
  for (const Fog& fog : fogs()) {
    const FogTable table(fog);
    double part = 0;
    const double worst = worst_error(table, distance_of(fog), &part);
    EXPECT_LE(part, 1) << static_cast<int>(fog.kind) << ' ' << fog.start << ' ' << fog.end;
    if (fog.kind != FogKind::linear || fog.start <= 0.9 * fog.end) {
      EXPECT_LT(worst, 0.2);
    }
    for (const FogTable::Line& line : table.lines()) EXPECT_LT(line.rise, 1 << (kFogStartBits - 1));
  }
}

// Must fail: an eighth of the lines.
TEST(FogMustFail, AShorterTableBreaksTheBound) {
  const FogTable table(linear(0, 1)), shorter(linear(0, 1), {}, 5);
  EXPECT_GT(worst_error(shorter, 1), 255 * (table.error_bound() + 0.005));
  EXPECT_LE(worst_error(shorter, 1), 255 * (shorter.error_bound() + 0.005));
}

TEST(Fog, OfNoDensityThereIsNoneAndAnEndAtTheEyeIsAllFog) {
  for (const FogKind kind : {FogKind::exp, FogKind::exp2}) {
    EXPECT_EQ(fog_factor(exponential(kind, 0), 1e300), 1);
    EXPECT_EQ(factor_at(FogTable(exponential(kind, 0)), 1e9), kFogClear);
  }
  EXPECT_EQ(fog_factor(linear(0, 0), 1e-9), 0);
  EXPECT_EQ(factor_at(FogTable(linear(0, 0)), 1e-9), 0U);
  EXPECT_LE(FogTable(linear(0, 0)).error_bound(), 1.0 / 4096);
}

TEST(Fog, BeyondItsEndsATableIsAsAtThem) {
  const FogTable table(exponential(FogKind::exp, 1));
  EXPECT_EQ(table.position(1, 1000), 0);
  EXPECT_EQ(table.position(1, -1000), table.last_position());
  EXPECT_EQ(table.position(1, 0), table.position(1U << 20, 20)) << "fewer bits than a place has";
  EXPECT_EQ(table.position(3, 1), table.position(3U << 20, 21));
  const FogTable steep(linear(1, 1));
  EXPECT_EQ(factor_at(steep, 0.99), kFogClear);
  EXPECT_EQ(factor_at(steep, 1.01), 0U);
  EXPECT_GE(fog_error_bound(table, 1, 2), std::exp(-1.0)) << "a q that is not known: all that is left may be wrong";
}

TEST(Fog, AVertexHasTheRealFactor) {
  EXPECT_EQ(fog_factor_of_vertex(linear(1, 3), 2), kFogClear / 2);
  EXPECT_EQ(fog_factor_of_vertex(linear(1, 3), -5), kFogClear);
  EXPECT_EQ(fog_factor_of_vertex(exponential(FogKind::exp2, 0.5), 2), 1507U) << "4096 / e";
}

TEST(Fog, TheMixIsRoundedOnce) {
  for (std::uint32_t color = 0; color < 256; color += 5)
    for (std::uint32_t fog = 0; fog < 256; fog += 3)
      for (std::uint32_t factor = 0; factor <= kFogClear; factor += 7) {
        const double part = std::ldexp(factor, -kFogFactorBits);
        ASSERT_EQ(fogged<std::uint32_t>(color, fog, factor), std::floor(color * part + fog * (1 - part) + 0.5));
      }
  EXPECT_EQ(fogged<std::uint32_t>(255, 0, kFogClear), 255U);
  EXPECT_EQ(fogged<std::uint32_t>(255, 9, 0), 9U);
}

TEST(Fog, DrawsOfOneStateShareATable) {
  State state;
  EXPECT_EQ(fog_table(state), nullptr);
  state.fog = exponential(FogKind::exp, 2);
  const auto table = fog_table(state);
  EXPECT_EQ(fog_table(state), table);
  state.fog_color = {1, 2, 3};
  EXPECT_NE(fog_table(state), table);
  EXPECT_EQ(fog_table(state)->color(), state.fog_color);
}

// ---- captures

std::optional<Fog> read_fog(const std::string& words) {
  return read_capture("halfplane 1\nv 0 0 0\nstate fog " + words + "\np 0\n", "test.hpt").states.at(0).fog;
}

TEST(Fog, IsReadAsItIsWritten) {
  EXPECT_EQ(read_fog("off"), std::nullopt);
  EXPECT_EQ(read_fog("linear 1 5"), linear(1, 5));
  EXPECT_EQ(read_fog("exp 0.25"), exponential(FogKind::exp, 0.25));
  EXPECT_EQ(read_fog("exp2 3"), exponential(FogKind::exp2, 3));
  for (const char* wrong : {"", "dense", "exp", "exp -1", "linear -1 2", "linear 1 -2", "exp 1 2 3"})
    EXPECT_THROW((void)read_fog(wrong), InputError) << wrong;
}

// ---- scenes

/// A line or a point in the last state.
void add_outline(Scene& scene, const std::vector<Vertex>& vertices) {
  const std::size_t first = scene.indices.size();
  for (const Vertex& v : vertices) {
    scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
    scene.vertices.push_back(v);
  }
  scene.commands.push_back(Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0,
                                vertices.size() == 2 ? Topology::lines : Topology::points, first, vertices.size(), 0});
}

/// Triangles, lines and points at distances to 2^octaves, each draw in a fog of its own.
Scene random_fog(std::uint32_t seed, double octaves) {
  Random random(seed);
  SceneBuilder builder(150, 100);
  const StateRows rows = states_named({"depth_test", "fog", "fog_color", "color_interp", "shade", "polygon_mode"});
  const StateRows operations = states_named({"alpha_test", "blend", "color_mask", "dither"});
  for (int n = 0; n < 12; ++n) {
    State state = random_state(SceneBuilder::window_state(), rows, chooser(random));
    if (state.polygon_mode != PolygonMode::fill) state.color_interp = ColorInterp::affine;
    if (n % 3 == 0) state = random_state(state, operations, chooser(random));
    if (n % 5 == 0) state.stencil = Stencil{.reference = 3, .passes = StencilOp::replace};
    builder.with_state(state);
    const double size = std::exp2(random.between(1, 8));
    std::array<Vertex, 3> v;
    for (int i = 0; i < 12; ++i) {
      const double x = random.between(0, 150), y = random.between(0, 100);
      for (Vertex& vertex : v) {
        const std::array<double, 3> at{random.unit() - 0.5, random.unit() - 0.5, random.unit()};
        vertex = test::at(x + size * at[0], y + size * at[1], at[2]);
        vertex.w = std::exp2(random.between(0, octaves) - 2);
        for (double& channel : vertex.rgba) channel = random.index(256);
      }
      builder.triangle(v[0], v[1], v[2]);
    }
    if (state.color_interp == ColorInterp::perspective) continue;
    add_outline(builder.scene, {v[0], v[1]});
    add_outline(builder.scene, {v[2]});
  }
  return builder.scene;
}

Config with_colors(const std::string& name) {
  Config config = preset(name);
  config.color_format = ColorFormat::rgba8888;
  config.stamp_size = std::min(config.stamp_size, 2);
  return config;
}

TEST(Fog, RandomScenesAreTheSameOnEveryPath) {
  for (const char* name : {"embedded", "full", "small"})
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      expect_all_same(random_fog(seed, seed), with_colors(name));
    }
}

/// Meshes in clip space, cut by the near plane; a chain of lines.
TEST(Fog, MeshesAreTheSameOnEveryPath) {
  for (const char* name : {"walk", "city:40", "wires:8", "layers_linear:6"}) {
    Scene scene = make_builtin(name, 120, 90, {}, 1);
    for (State& state : scene.states) state.fog = exponential(FogKind::exp2, 0.3), state.fog_color = {200, 210, 220};
    SCOPED_TRACE(name);
    expect_all_same(scene, with_colors("embedded"));
    const Rendering fogged = render_scalar(scene, preset("embedded"));
    for (State& state : scene.states) state.fog.reset();
    EXPECT_NE(fogged.frame.color, render_scalar(scene, preset("embedded")).frame.color);
  }
}

TEST(Fog, TheSameQIsTakenFromColoursFromCoordinatesAndAlone) {
  std::vector<Rendering> drawn;
  for (const bool has_texture : {false, true})
    for (const TextureInterp texture : {TextureInterp::perspective, TextureInterp::affine})
      for (const ColorInterp color : {ColorInterp::affine, ColorInterp::perspective}) {
        State state = SceneBuilder::window_state();
        state.fog = exponential(FogKind::exp, 0.4);
        state.texture_interp = texture;
        state.color_interp = color;
        SceneBuilder builder(64, 48, state);
        Scene& scene = builder.scene;
        if (has_texture) {
          scene.textures.push_back(
              make_texture("white", {1, 1, {Texel{255, 255, 255, 255}}}, TextureFormat::rgba8888, Mips::none));
          for (State& of : scene.states) of.texture = 0;
        }
        builder.triangle(test::clip_at(1, 2, 0, 1), test::clip_at(60, 4, 0, 3), test::clip_at(20, 46, 0, 9));
        drawn.push_back(render_scalar(scene, with_colors("embedded")));
      }
  for (const Rendering& one : drawn) EXPECT_EQ(one.frame.color, drawn[0].frame.color);
  EXPECT_NE(drawn[0].frame.color[drawn[0].frame.at(10, 8)], drawn[0].frame.color[drawn[0].frame.at(22, 40)]);
}

TEST(Fog, LinesAndPointsAreFoggedAtTheirEnds) {
  State state = SceneBuilder::window_state();
  state.fog = linear(1, 3);
  state.fog_color = {0, 0, 200};
  state.line_rule = LineRule::midpoint;
  SceneBuilder builder(32, 16, state);
  add_outline(builder.scene, {test::clip_at(2.5, 2.5, 0.5, 1), test::clip_at(22.5, 2.5, 0.5, 3)});
  add_outline(builder.scene, {test::clip_at(4.5, 8.5, 0.5, 2)});
  const Config config = with_colors("embedded");
  const Rendering drawn = render_scalar(builder.scene, config);
  const golden::Image golden = golden::render(builder.scene, config);
  const auto channel = [&](int x, int y, int c) {
    return golden::stored_channel(drawn.frame.color[drawn.frame.at(x, y)], config.color_format, c);
  };
  EXPECT_EQ(channel(2, 2, 0), 255);
  EXPECT_EQ(channel(12, 2, 0), 128);
  EXPECT_EQ(channel(22, 2, 0), 0);
  EXPECT_EQ(channel(22, 2, 2), 200);
  EXPECT_EQ(channel(4, 8, 0), 128);
  for (const auto& [x, y] : {std::pair{2, 2}, {12, 2}, {22, 2}, {4, 8}})
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(channel(x, y, c), golden.color[static_cast<std::size_t>(y * 32 + x)][static_cast<std::size_t>(c)],
                  1.01);
}

TEST(Fog, TheGoldenIsTheFormula) {
  State state = SceneBuilder::window_state();
  state.fog = exponential(FogKind::exp, 0.25);
  state.fog_color = {10, 20, 30};
  SceneBuilder builder(16, 16, state);
  builder.triangle(test::clip_at(0, 0, 0, 2), test::clip_at(40, 0, 0, 2), test::clip_at(0, 40, 0, 2));
  const golden::Image image = golden::render(builder.scene, preset("embedded"));
  const double f = std::exp(-0.5);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(image.color[5 * 16 + 5][c], 255 * f + state.fog_color[c] * (1 - f), 1e-9);
  golden::Options options;
  options.clipping = Clipping::homogeneous;
  for (State& of : builder.scene.states) of.space = Space::clip;
  for (Vertex& v : builder.scene.vertices) v = {v.x == 0 ? -2.0 : 6.0, v.y == 0 ? 2.0 : -6.0, 0, 2};
  EXPECT_NEAR(golden::render(builder.scene, preset("embedded"), options).color[5 * 16 + 5][0], 255 * f + 10 * (1 - f),
              1e-9);
}

TEST(Fog, CompareHoldsItsBound) {
  for (const char* name : {"tiny", "embedded", "full"}) {
    Config config = preset(name);
    config.target_width = std::max(config.target_width, 150);
    config.target_height = std::max(config.target_height, 100);
    config.guard_band = std::max(config.guard_band, 512);
    std::uint64_t pixels = 0;
    double of_bound = 0;
    for (std::uint32_t seed = 21; seed <= 26; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      const Comparison c = compare(random_fog(seed, seed - 20), config);
      EXPECT_EQ(broken_bounds(c, config), std::vector<std::string>{});
      pixels += c.fog.count;
      of_bound = std::max(of_bound, c.fragments.surfaces.fog_factor.ratio());
    }
    EXPECT_GT(pixels, 1000U);
    EXPECT_GT(of_bound, 0.5);
  }
}

// Must fail: a specification whose fog is another.
TEST(FogMustFail, CompareSeesAnotherFog) {
  const Config config = with_colors("embedded");
  Scene scene = random_fog(30, 3);
  CompareOptions options;
  options.specification = [](const Scene& of, const Config& with, const RenderOptions& render) {
    Scene thinner = of;
    for (State& state : thinner.states)
      if (state.fog) state.fog->start *= 0.98, state.fog->end *= 0.98;
    return render_scalar(thinner, with, render);
  };
  EXPECT_NE(broken_bounds(compare(scene, config, options), config), std::vector<std::string>{});
}

TEST(Fog, HardwareRefusesItByName) {
  State state = SceneBuilder::window_state();
  state.fog = exponential(FogKind::exp, 1);
  SceneBuilder builder(16, 16, state);
  builder.triangle(test::at(1, 1), test::at(9, 1), test::at(1, 9));
  const auto message = [&] {
    try {
      check_hardware_scene(builder.scene, preset("embedded"));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message().find("state fog, but this hardware has no unit for it"), std::string::npos) << message();
  for (State& of : builder.scene.states) of.color_write = false;
  EXPECT_EQ(message(), "");
}

TEST(Fog, ADistanceThatIsNoneIsRefusedAndSaysHow) {
  State state = SceneBuilder::window_state();
  state.fog = exponential(FogKind::exp, 1);
  SceneBuilder builder(16, 16, state);
  builder.triangle(test::clip_at(1, 1, 0, 0), test::at(9, 1), test::at(1, 9));
  EXPECT_THROW((void)render_scalar(builder.scene, preset("embedded")), InputError);
  EXPECT_NO_THROW((void)golden::render(builder.scene, preset("embedded")));
}

}  // namespace
}  // namespace halfplane::fog_test
