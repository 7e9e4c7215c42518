// Light of fragments: normals, tables and their bounds, captures, and scenes on every path.
#include "model/stages/phong.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "../functional_case.hpp"
#include "../scene_builder.hpp"
#include "model/capture/capture.hpp"
#include "model/draw_states.hpp"
#include "model/golden/golden.hpp"
#include "model/golden/phong.hpp"
#include "model/host/primitive_stream.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/mesh_scene.hpp"
#include "sim/study/compare/compare.hpp"

namespace halfplane::phong_test {
namespace {

using test::expect_all_same;
using test::Random;
using test::SceneBuilder;
using Vec = std::array<double, 3>;

Vec direction(Random& random) { return {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; }

double length(const Vec& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// ---- normals

TEST(Phong, ANormalOfAnyLengthIsMadeAsLongAsOne) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    Vec v = direction(random);
    const double scale = std::exp2(random.between(-40, 39));
    for (double& c : v) c *= scale;
    const Vec unit = unit_normal(v), real = golden::unit(v);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(unit[c], real[c], 1e-15);
  }
  EXPECT_EQ(unit_normal({}), Vec{});
  EXPECT_EQ(golden::unit({}), Vec{});
  EXPECT_EQ(unit_normal({0, -3, 0}), (Vec{0, -1, 0}));
  EXPECT_EQ(normal_codes({0, -1, 0.5}), (Normal{0, -32768, 16384}));
}

TEST(Phong, AllComponentsAreShiftedAlikeUntilTheLargestFits) {
  Random random(2);
  for (int i = 0; i < 20000; ++i) {
    std::array<std::int64_t, 3> p{};
    const double scale = std::exp2(random.between(0, 26));
    for (std::int64_t& c : p) c = std::llround(scale * random.between(-1, 1));
    const Normal m = block_normal(p);
    const Vec real{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    if (length(real) == 0) {
      EXPECT_EQ(m, Normal{});
      continue;
    }
    int largest = 0;
    for (const std::int32_t c : m) {
      ASSERT_GE(c, -32768);
      ASSERT_LE(c, 32767);
      largest = std::max(largest, std::abs(c));
    }
    ASSERT_GE(largest, 16384);
    const Vec made = golden::unit({double(m[0]), double(m[1]), double(m[2])}), exact = golden::unit(real);
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(made[c], exact[c], 6e-5) << i;
  }
  EXPECT_EQ(block_normal({0, 0, 0}), Normal{});
  EXPECT_EQ(block_normal({0, -1, 0}), (Normal{0, -16384, 0})) << "-1 has no bit besides its sign";
  EXPECT_EQ(block_normal({65535, 0, 0}), (Normal{32767, 0, 0})) << "rounded up it would not fit";
}

TEST(Phong, TheRootIsTheRealOne) {
  Random random(3);
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const Vec n = golden::unit(direction(random));
    const double scale = std::exp2(random.between(14.9, 15));
    Normal m{};
    for (std::size_t c = 0; c < 3; ++c) m[c] = static_cast<std::int32_t>(scale * n[c] * (i % 2 == 0 ? 1 : 0.6));
    if (std::max({std::abs(m[0]), std::abs(m[1]), std::abs(m[2])}) < 16384) continue;
    const InverseLength made = inverse_length(m);
    ASSERT_LT(made.root, 1U << kRootFraction);
    ASSERT_GE(made.root, 1U << (kRootFraction - 1));
    const double real = 1 / length({double(m[0]), double(m[1]), double(m[2])});
    worst = std::max(worst, std::abs(std::ldexp(made.root, -kRootFraction - made.exponent) / real - 1));
  }
  EXPECT_LT(worst, 1.1e-5);
  EXPECT_GT(worst, 1e-6);
}

// ---- tables

TEST(Phong, ThePowerIsTheRealOne) {
  Random random(4);
  for (int i = 0; i < 20000; ++i) {
    const double n = random.between(1, 128), x = random.unit();
    const double code = std::floor(std::ldexp(n, 16) + 0.5);
    EXPECT_NEAR(power_of(x, static_cast<std::uint32_t>(code)), std::pow(x, std::ldexp(code, -16)), 1e-12);
  }
  EXPECT_EQ(power_of(0, 1 << 16), 0);
  EXPECT_EQ(power_of(1, 77777), 1);
}

PhongLight::Given light(double shininess, const Vec& half = {0, 0, 1}) {
  return {{0, 0, 1}, half, {10, 20, 30}, {200, 255, 0}, {255, 0, 128}, shininess};
}

/// The worst error of a power over all cosines, times 255.
double worst_of_power(const PhongLight& of, double n, double half_length) {
  double worst = 0;
  for (std::uint32_t x = 0; x <= 1U << kCosineFraction; ++x) {
    const double real = std::min(1.0, std::pow(std::ldexp(x, -kCosineFraction) / half_length, n));
    worst = std::max(worst, std::abs(std::ldexp(of.power(x), -kLightFraction) - real));
  }
  return 255 * worst;
}

TEST(Phong, TheTableOfAPowerKeepsItsBound) {
  for (const double n : {1.0, 1.5, 2.0, 5.0, 10.5, 16.0, 32.0, 50.0, 64.0, 100.0, 127.25, 128.0}) {
    const PhongLight of(light(n));
    const double worst = worst_of_power(of, n, 32767.0 / 32768);
    EXPECT_LE(worst, 255 * of.error_bounds(1, 1, 0).specular) << n;
    EXPECT_LT(worst, 0.17) << n;
    EXPECT_EQ(of.power((1U << kCosineFraction) + 9), 1U << kLightFraction) << "a hair beyond 1";
    EXPECT_EQ(of.power(0), 0U) << n;
    EXPECT_EQ(of.lines().size(), 256U);
    for (const FallingLine& line : of.lines()) EXPECT_LT(line.fall, 1 << 12);
  }
  EXPECT_EQ(PhongLight(light(64)).narrow(), 3);
  EXPECT_EQ(PhongLight(light(1)).narrow(), 0);
}

TEST(Phong, FactorsOfAnyNormalKeepTheirBound) {
  Random random(5);
  double of_bound = 0, worst = 0;
  for (int i = 0; i < 400; ++i) {
    State state;
    state.light_direction = direction(random);
    state.light_half = direction(random);
    state.light_shininess = std::exp2(random.between(0, 7));
    const PhongLight of(PhongLight::given_by(state));
    for (int k = 0; k < 400; ++k) {
      const double near = std::exp2(random.between(-9, 3));
      const Vec away = direction(random), h = golden::unit(state.light_half);
      const Vec n = golden::unit({h[0] + near * away[0], h[1] + near * away[1], h[2] + near * away[2]});
      const double scale = std::exp2(random.between(18, 25));
      const auto p = [&](std::size_t c) { return std::llround(scale * n[c]); };
      const PhongLight::Factors made = of.factors(block_normal({p(0), p(1), p(2)}));
      const golden::LightFactors real = golden::light_factors(state, n);
      const PhongLight::Bounds bounds = of.error_bounds(golden::dot(n, golden::unit(state.light_direction)),
                                                        golden::dot(n, h), std::sqrt(0.75) / scale);
      const double diffuse = std::abs(std::ldexp(made.diffuse, -kLightFraction) - real.diffuse),
                   specular = std::abs(std::ldexp(made.specular, -kLightFraction) - real.specular);
      ASSERT_LE(diffuse, bounds.diffuse);
      ASSERT_LE(specular, bounds.specular) << state.light_shininess;
      if (bounds.specular > 0) of_bound = std::max(of_bound, specular / bounds.specular);
      if (golden::dot(n, golden::unit(state.light_direction)) > 1e-3) worst = std::max(worst, 255 * specular);
    }
  }
  EXPECT_GT(of_bound, 0.3);
  EXPECT_LT(worst, 0.8);
  RecordProperty("worst_specular_lsb", std::to_string(worst));
}

TEST(Phong, WhatLooksAwayHasNeitherLightNorHighlight) {
  const PhongLight of(light(8));
  EXPECT_EQ(of.factors({0, 0, -20000}).diffuse, 0U);
  EXPECT_EQ(of.factors({0, 0, -20000}).specular, 0U);
  EXPECT_EQ(of.factors({20000, 0, 0}).specular, 0U) << "N.L is 0";
  EXPECT_EQ(of.factors({}).diffuse, 0U) << "no normal";
  EXPECT_EQ(of.factors({0, 0, 20000}).diffuse, 1U << kLightFraction);
  PhongLight::Given none = light(8);
  none.half = {};
  EXPECT_EQ(PhongLight(none).factors({0, 0, 20000}).specular, 0U) << "no H";
}

TEST(Phong, AChannelIsWhatTheFormulaSays) {
  Random random(6);
  State state;
  state.light_ambient = {0, 51, 255};
  state.light_diffuse = {255, 100, 255};
  state.light_specular = {0, 255, 90};
  const PhongLight of(PhongLight::given_by(state));
  for (int i = 0; i < 20000; ++i) {
    const PhongLight::Factors factors{static_cast<std::uint32_t>(random.index(4097)),
                                      static_cast<std::uint32_t>(random.index(4097))};
    const auto color = static_cast<std::uint32_t>(random.index(256));
    const golden::RealColor own{double(color), double(color), double(color), 7};
    const auto real = golden::in_light(
        state, own, {std::ldexp(factors.diffuse, -kLightFraction), std::ldexp(factors.specular, -kLightFraction)});
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(of.lit(c, color, factors), real[c], 0.6);
    ASSERT_EQ(real[3], 7);
  }
  EXPECT_EQ(of.lit(2, 255, {4096, 4096}), 255U);
  EXPECT_EQ(of.lit(0, 255, {4096, 0}), 255U);
  EXPECT_EQ(of.lit(0, 255, {0, 0}), 0U);
}

TEST(Phong, DrawsOfOneStateShareALight) {
  State state;
  EXPECT_EQ(phong_light(state), nullptr);
  state.shade = Shade::phong;
  const auto first = phong_light(state);
  EXPECT_EQ(phong_light(state), first);
  state.light_shininess = 9;
  EXPECT_NE(phong_light(state), first);
}

// ---- captures

TEST(Phong, NormalsAreReadAndWritten) {
  const std::string text =
      "halfplane 1\ntarget 8 8\nv 0 0 0\nv 1 0 0\na normal 0 -0.25 1e3\nv 0 1 0\nspace clip\nstate shade phong\n"
      "state light_direction 1 2 -3\nstate light_half 0 0.5 1\nstate light_ambient 1 2 3\nstate light_diffuse 4 5 6\n"
      "state light_specular 7 8 9\nstate light_shininess 64\nt 0 1 2\n";
  const Scene scene = read_capture(text, "test.hpt");
  EXPECT_EQ(scene.normal(0), Vec{});
  EXPECT_EQ(scene.normal(1), (Vec{0, -0.25, 1000}));
  EXPECT_EQ(scene.normal(2), Vec{});
  EXPECT_EQ(scene.states.at(0).light_direction, (Vec{1, 2, -3}));
  EXPECT_EQ(scene.states.at(0).light_shininess, 64);
  std::ostringstream out;
  write_capture(scene, out);
  const Scene again = read_capture(out.str(), "again.hpt");
  EXPECT_TRUE(same_scene(scene, again));
  EXPECT_EQ(again.normals, scene.normals);
  Scene other = again;
  other.normals[1][0] = 1;
  EXPECT_FALSE(same_scene(scene, other));
}

TEST(Phong, WrongLinesOfNormalsAreRefused) {
  const auto message = [](const std::string& lines) {
    try {
      (void)read_capture("halfplane 1\n" + lines, "test.hpt");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message("a normal 0 0 1\n"),
            "test.hpt:2: a normal without a vertex; write it below the 'v' line of its vertex");
  EXPECT_EQ(message("v 0 0 0\na uv1 0 0\n"), "test.hpt:3: 'uv1' is no attribute of a vertex; write a normal x y z");
  EXPECT_EQ(message("v 0 0 0\na\n"), "test.hpt:3: an attribute without a name; write a normal x y z");
  EXPECT_EQ(message("v 0 0 0\na normal 0 0 1\na normal 0 0 1\n"),
            "test.hpt:4: a second normal of vertex 0; remove one of them");
  for (const char* wrong : {"a normal 0 0", "a normal 0 0 1 2", "a normal 0 0 nan", "a normal 0 0 1e13"})
    EXPECT_NE(message("v 0 0 0\n" + std::string(wrong) + "\n"), "") << wrong;
  for (const char* wrong :
       {"light_shininess 0.5", "light_shininess 129", "light_specular 1 2 256", "light_half 0 0", "shade gouraud"})
    EXPECT_NE(message("state " + std::string(wrong) + "\n"), "") << wrong;
}

TEST(Phong, NormalsThatNobodyCouldReadAreRefused) {
  Scene scene;
  scene.normals.push_back({0, 0, 1});
  EXPECT_THROW(validate(scene), InputError) << "more than vertices";
  scene.vertices.emplace_back();
  EXPECT_NO_THROW(validate(scene));
  scene.normals[0][1] = std::nan("");
  EXPECT_THROW(validate(scene), InputError);
}

// ---- scenes

Config with_colors(const std::string& name) {
  Config config = preset(name);
  config.color_format = ColorFormat::rgba8888;
  config.stamp_size = std::min(config.stamp_size, 2);
  config.target_width = std::max(config.target_width, 150);
  config.target_height = std::max(config.target_height, 100);
  config.guard_band = std::max(config.guard_band, 512);
  return config;
}

/// Triangles with normals, w ratios to 2^octaves; some without light, some textured, some under fog.
Scene random_light(std::uint32_t seed, double octaves, double shininess = 0) {
  Random random(seed);
  SceneBuilder builder(150, 100);
  Scene& scene = builder.scene;
  const StateRows rows = states_named({"depth_test", "color_interp", "light_ambient", "light_diffuse", "light_specular",
                                       "light_shininess", "texture_interp", "texture_combine", "polygon_mode"});
  TexelImage image{4, 4, {}};
  for (int i = 0; i < 16; ++i)
    image.texel.push_back({static_cast<std::uint8_t>(random.index(256)), static_cast<std::uint8_t>(random.index(256)),
                           static_cast<std::uint8_t>(random.index(256)), 255});
  scene.textures.push_back(make_texture("noise", image, TextureFormat::rgba8888, Mips::none));
  for (int n = 0; n < 10; ++n) {
    State state = random_state(SceneBuilder::window_state(), rows, chooser(random));
    if (state.polygon_mode != PolygonMode::fill) state.color_interp = ColorInterp::affine;
    state.shade = n % 5 == 4 ? Shade::smooth : Shade::phong;
    state.light_direction = direction(random);
    state.light_half = direction(random);
    if (shininess != 0) state.light_shininess = shininess;
    if (n % 3 == 0) state.texture = 0;
    if (n % 4 == 0) state.fog = Fog{FogKind::exp2, 0.3, 0.3};
    if (n % 4 == 2) state = random_state(state, states_named({"alpha_test", "blend", "dither"}), chooser(random));
    if (n == 7) state.stencil = Stencil{.reference = 3, .passes = StencilOp::replace};
    builder.with_state(state);
    const double size = std::exp2(random.between(2, 8)), bend = std::exp2(random.between(-6, 0));
    for (int i = 0; i < 10; ++i) {
      const double x = random.between(0, 150), y = random.between(0, 100);
      const Vec middle = random.index(2) == 0 ? state.light_half : direction(random);
      std::array<Vertex, 3> v;
      for (Vertex& vertex : v) {
        const std::array<double, 3> at{random.unit() - 0.5, random.unit() - 0.5, random.unit()};
        vertex = test::at(x + size * at[0], y + size * at[1], at[2]);
        vertex.w = std::exp2(random.between(0, octaves) - 2);
        vertex.u = random.between(-1, 2);
        vertex.v = random.between(-1, 2);
        for (double& channel : vertex.rgba) channel = random.index(256);
        Vec normal = direction(random);
        for (std::size_t c = 0; c < 3; ++c) normal[c] = middle[c] + bend * normal[c];
        scene.normals.push_back(normal);
      }
      builder.triangle(v[0], v[1], v[2]);
    }
  }
  return scene;
}

TEST(Phong, RandomScenesAreTheSameOnEveryPath) {
  for (const char* name : {"embedded", "full", "small"})
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      Scene scene = random_light(seed, seed);
      expect_all_same(scene, with_colors(name));
      for (State& state : scene.states) state.stencil.reset();  // without one, the fast path
      expect_all_same(scene, with_colors(name));
    }
}

/// Meshes in clip space, cut by the near plane, and lines and points among them.
TEST(Phong, MeshesAreTheSameOnEveryPath) {
  MeshOptions options;
  options.light.is_phong = true;
  for (const char* name : {"walk", "knot:16", "teapot:4", "wires:8"}) {
    SCOPED_TRACE(name);
    const Scene scene = make_builtin(name, 120, 90, {}, 1, options);
    expect_all_same(scene, with_colors("embedded"));
  }
}

TEST(Phong, SeveralSamplesAPixelAreLitOnce) {
  Config config = with_colors("embedded");
  config.msaa_samples = 4;
  for (std::uint32_t seed = 31; seed <= 33; ++seed) {
    const Scene scene = random_light(seed, 2);
    const Rendering scalar = render_scalar(scene, config), fast = render_functional(scene, config, {});
    EXPECT_EQ(scalar.frame.color, fast.frame.color);
    const Comparison c = compare(scene, config);
    EXPECT_EQ(broken_bounds(c, config), std::vector<std::string>{});
    EXPECT_GT(c.light.count, 0U);
  }
}

/// A square of one normal.
SceneBuilder lit_square(const Vec& normal, State state) {
  state.shade = Shade::phong;
  SceneBuilder builder(16, 16, state);
  builder.triangle(test::clip_at(0, 0, 0, 2), test::clip_at(40, 0, 0, 3), test::clip_at(0, 40, 0, 5));
  for (Vertex& v : builder.scene.vertices) v.rgba = {200, 100, 50, 255};
  builder.scene.normals.assign(3, normal);
  return builder;
}

TEST(Phong, GoldenAndSpecificationAreTheFormula) {
  State state = SceneBuilder::window_state();
  state.light_direction = {1, 1, 1};
  state.light_half = {0, 0, 1};
  state.light_specular = {100, 0, 50};
  state.light_shininess = 16;
  const Vec n = golden::unit({0.25, -0.125, 1});
  SceneBuilder builder = lit_square({2.5, -1.25, 10}, state);
  const double facing = (n[0] + n[1] + n[2]) / std::sqrt(3.0), shine = std::pow(n[2], 16);
  const golden::Image image = golden::render(builder.scene, preset("embedded"));
  const Rendering drawn = render_scalar(builder.scene, with_colors("embedded"));
  for (std::size_t c = 0; c < 3; ++c) {
    const double real = builder.scene.vertices[0].rgba[c] * (0.2 + facing) + state.light_specular[c] * shine;
    EXPECT_NEAR(image.color[5 * 16 + 5][c], real, 1e-9);
    EXPECT_NEAR(drawn.frame.color[drawn.frame.at(5, 5)] >> 8 * c & 255, real, 0.7);
  }
  golden::Options options;
  options.clipping = Clipping::homogeneous;
  for (State& of : builder.scene.states) of.space = Space::clip;
  for (Vertex& v : builder.scene.vertices) v = {v.x == 0 ? -2.0 : 6.0, v.y == 0 ? 2.0 : -6.0, 0, 2, v.rgba};
  EXPECT_NEAR(golden::render(builder.scene, preset("embedded"), options).color[5 * 16 + 5][0],
              200 * (0.2 + facing) + 100 * shine, 1e-9);
}

TEST(Phong, CompareHoldsItsBounds) {
  for (const char* name : {"tiny", "embedded", "full"}) {
    const Config config = with_colors(name);
    std::uint64_t pixels = 0;
    double of_bound = 0;
    for (std::uint32_t seed = 41; seed <= 45; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      const Comparison c = compare(random_light(seed, seed - 41), config);
      EXPECT_EQ(broken_bounds(c, config), std::vector<std::string>{});
      pixels += c.light.count;
      of_bound = std::max(of_bound, c.fragments.surfaces.light.ratio());
      EXPECT_FALSE(c.per_vertex.empty());
    }
    EXPECT_GT(pixels, 1000U);
    EXPECT_GT(of_bound, 0.3);
  }
}

// Must fail: a specification whose power is another.
TEST(PhongMustFail, CompareSeesAnotherPower) {
  const Config config = with_colors("embedded");
  const Scene scene = random_light(50, 1, 64);
  CompareOptions options;
  options.specification = [](const Scene& of, const Config& with, const RenderOptions& render) {
    Scene duller = of;
    for (State& state : duller.states) state.light_shininess = 60;
    return render_scalar(duller, with, render);
  };
  EXPECT_NE(broken_bounds(compare(scene, config, options), config), std::vector<std::string>{});
}

// Two LSB from the golden at a power of 64: the guarantee for a mesh.
TEST(Phong, AtAPowerOf64AMeshIsWithinTwoLsbOfTheGolden) {
  MeshOptions options;
  options.light = parse_lights(std::vector<std::string>{"phong", "from=1,2,3"});
  for (const char* name : {"embedded", "full"}) {
    Config config = with_colors(name);
    config.target_width = std::max(config.target_width, 320);
    config.target_height = std::max(config.target_height, 240);
    Scene scene = make_builtin("teapot", 320, 240, {}, 1, options);
    for (State& state : scene.states) {
      state.light_shininess = 64;
      state.light_specular = {255, 255, 255};
      state.color_interp = ColorInterp::perspective;
    }
    const Comparison c = compare(scene, config);
    EXPECT_EQ(broken_bounds(c, config), std::vector<std::string>{});
    EXPECT_GT(c.light.count, 10000U);
    EXPECT_LE(c.light.max, 2) << name;
    EXPECT_LE(c.color_parts.interpolation.max, 2) << name << ", against the golden through the snapped vertices";
    RecordProperty(std::string("light_lsb_") + name, std::to_string(c.light.max));
  }
}

// ---- meshes

TEST(Phong, OneLightFromInfinitelyFarIsTaken) {
  const auto state_of = [](std::vector<std::string> texts) {
    MeshOptions options;
    options.light = parse_lights(texts);
    const Scene scene = make_builtin("knot:16", 40, 30, parse_camera("eye=0,0,9;target=0,0,0;up=0,1,0"), 1, options);
    return scene.states.at(std::get<Draw>(scene.commands.at(1)).state);
  };
  const State alone = state_of({"phong"});
  EXPECT_EQ(alone.shade, Shade::phong);
  EXPECT_EQ(alone.light_direction, (Vec{0, 0, 1}));
  EXPECT_EQ(alone.light_half, (Vec{0, 0, 1}));
  EXPECT_EQ(alone.light_ambient, (std::array<std::uint8_t, 3>{51, 51, 51}));
  EXPECT_EQ(state_of({"phong", "eye;color=1,0.2,2"}).light_diffuse, (std::array<std::uint8_t, 3>{255, 51, 255}));
  const State side = state_of({"from=1,0,0", "phong", "ambient=0,0,1"});
  EXPECT_NEAR(side.light_direction[0], 1, 1e-15);
  EXPECT_NEAR(side.light_half[0], std::sqrt(0.5), 1e-15);
  EXPECT_EQ(side.light_ambient, (std::array<std::uint8_t, 3>{0, 0, 255}));
  EXPECT_EQ(state_of({"eye"}).shade, Shade::smooth);
  for (const auto& texts :
       {std::vector<std::string>{"phong", "at=1,2,3"}, {"phong", "eye", "from=1,0,0"}, {"phong", "off"}})
    EXPECT_THROW((void)state_of(texts), InputError) << texts[1];
}

TEST(Phong, OnlyATriangleThatLooksAwayAtAllCornersIsTurned) {
  Mesh mesh;
  const auto add = [&mesh](double z, const std::array<Vec3, 3>& normals) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const std::array<Vec3, 3> places{Vec3{-1, -1, z}, Vec3{1, -1, z}, Vec3{0, 1, z}};
    for (std::size_t i = 0; i < 3; ++i) mesh.vertices.push_back({places[i], normals[i], {255, 255, 255, 255}, 0, 0});
    mesh.triangles.push_back({first, first + 1, first + 2});
  };
  constexpr Vec3 kToUs{0, 0, 1}, kAway{0, 0, -1};
  add(0, {kAway, kAway, kAway});
  add(-1, {kAway, kToUs, kToUs});
  add(-2, {kToUs, Vec3{}, kToUs});  // a corner without one: shown as it is
  mesh.objects = {""};
  mesh.parts = {{.object = 0, .first = 0, .count = 3}};
  MeshOptions options;
  options.light.is_phong = true;
  const Scene scene = mesh_scene(mesh, parse_camera("eye=0,0,9;target=0,0,0;up=0,1,0"), 40, 30, Cull::none, options);
  EXPECT_EQ(scene.vertices.size(), 12U) << "three copies";
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(scene.normal(scene.indices[i])[2], 1, 1e-12);
  EXPECT_NEAR(scene.normal(scene.indices[3])[2], -1, 1e-12);
  ASSERT_EQ(scene.commands.size(), 3U);
  EXPECT_EQ(scene.states[std::get<Draw>(scene.commands[1]).state].shade, Shade::phong);
  EXPECT_EQ(std::get<Draw>(scene.commands[1]).count, 6U);
  EXPECT_EQ(scene.states[std::get<Draw>(scene.commands[2]).state].shade, Shade::smooth);
}

TEST(Phong, FrameByFrameANormalThatMovesIsSeen) {
  State state = SceneBuilder::window_state();
  SceneBuilder builder = lit_square({0, 0, 1}, state);
  FunctionalEngine engine(with_colors("embedded"));
  const PreparedScene first(builder.scene);
  RenderOptions options;
  options.skip.bins = true;
  const auto before = engine.render(first, options).frame.color;
  builder.scene.normals[1] = {1, 0, 0};
  const PreparedScene second(builder.scene);
  const auto after = engine.render(second, options).frame.color;
  EXPECT_NE(before, after);
  EXPECT_EQ(after, render_scalar(builder.scene, with_colors("embedded")).frame.color);
}

TEST(Phong, HardwareRefusesItByName) {
  SceneBuilder builder = lit_square({0, 0, 1}, SceneBuilder::window_state());
  const auto message = [&] {
    try {
      check_hardware_scene(builder.scene, preset("embedded"));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message().find("state shade phong: this hardware lights no fragments"), std::string::npos) << message();
  for (State& of : builder.scene.states) of.color_write = false;
  EXPECT_EQ(message(), "");
}

TEST(Phong, ANormalThatCannotBeDividedIsRefused) {
  SceneBuilder builder = lit_square({0, 0, 1}, SceneBuilder::window_state());
  builder.scene.vertices[1].w = 0;
  EXPECT_THROW((void)render_scalar(builder.scene, preset("embedded")), InputError);
  EXPECT_NO_THROW((void)golden::render(builder.scene, preset("embedded")));
  RenderOptions options;
  options.rules.clipping = Clipping::homogeneous;
  for (State& of : builder.scene.states) of.space = Space::clip;
  EXPECT_THROW((void)render_scalar(builder.scene, preset("embedded"), options), InputError);
}

}  // namespace
}  // namespace halfplane::phong_test
