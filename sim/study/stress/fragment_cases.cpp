// Fragment operations: pictures that must be equal to the bit, and colours under layers against real arithmetic.
#include <array>
#include <cmath>

#include "model/engines/scalar.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "model/stages/fragment_ops.hpp"
#include "sim/scene/random_state.hpp"
#include "sim/study/compare/fragment_frame.hpp"
#include "sim/study/compare/fragment_judge.hpp"
#include "sim/study/stress/cases.hpp"
#include "sim/study/stress/check.hpp"
#include "sim/study/stress/shapes.hpp"

namespace halfplane::stress {
namespace {

State with(Unit& unit, State state, std::initializer_list<std::string_view> names) {
  const Chooser choose = chooser(unit.random);
  for (const std::string_view name : names) draw_state(name).set(state, random_value(draw_state(name), choose));
  return state;
}

/// Adds triangles of any size, with random alpha.
void add_triangles(Unit& unit, SceneBuilder& builder, int count) {
  const int width = builder.scene.width, height = builder.scene.height;
  for (int n = 0; n < count; ++n) {
    std::array<Vertex, 3> v;
    for (Vertex& vertex : v) {
      vertex = random_vertex_at(unit, random_point(unit, width, height, 4));
      for (double& channel : vertex.rgba) channel = unit.random.index(256);
    }
    builder.triangle(v[0], v[1], v[2]);
  }
}

/// Checks that the engine's picture is the specification's.
Rendering rendered(Unit& unit, const Scene& scene) {
  Rendering drawn = unit.engine(scene, unit.config, render_options());
  unit.count_triangles(drawn.triangles.size());
  const Rendering expected = render_scalar(scene, unit.config, render_options());
  expect_same_image(unit, scene, expected, drawn);
  unit.require(drawn.frame.stencil == expected.frame.stencil, "stencil", scene, "stored stencil values differ");
  unit.require(drawn.counters.alpha_killed == expected.counters.alpha_killed, "alpha_killed", scene,
               "the alpha test drops other fragments");
  return drawn;
}

/// Checks the engine's own path, used without taps.
void check_without_taps(Unit& unit, const Scene& scene) {
  const Rendering drawn = rendered(unit, scene), plain = unit.engine(scene, unit.config, {});
  unit.require(plain.frame.color == drawn.frame.color, "plain", scene, "another picture without taps");
}

/// Draws the same triangles again, in another state.
void again(Scene& scene, const State& state) {
  const auto draws = scene.commands;
  scene.states.push_back(state);
  for (const Command& command : draws)
    if (const auto* draw = std::get_if<Draw>(&command)) {
      Draw second = *draw;
      second.state = static_cast<std::uint32_t>(scene.states.size() - 1);
      scene.commands.emplace_back(second);
    }
}

/// Judges every fragment of the specification against the oracle.
FragmentVerdict judged(Unit& unit, const Scene& scene) {
  const Config config = with_alpha(unit.config, scene);
  FragmentJudge judge(scene, config);
  RenderOptions options = render_options();
  options.fragment_tap = [&judge](const TappedFragment& fragment) { judge.add(fragment); };
  const FragmentVerdict verdict = judge.finish(render_scalar(scene, unit.config, options));
  unit.count_samples(verdict.fragments);
  return verdict;
}

}  // namespace

void random_operations(Unit& unit) {
  SceneBuilder builder(unit.width(40), unit.height(32));
  for (int n = 0; n < 6; ++n) {
    State state = with(unit, SceneBuilder::window_state(), {"depth_test", "depth_write", "blend", "dither"});
    if (unit.random.coin()) state = with(unit, state, {"blend_equation", "blend_color", "color_mask"});
    if (unit.random.coin()) state = with(unit, state, {"alpha_test"});
    if (unit.random.coin()) state = with(unit, state, {"stencil", "stencil_back"});
    builder.with_state(state);
    add_triangles(unit, builder, 2);
  }
  (void)rendered(unit, builder.scene);
}

namespace {

/// Judges the colours of a scene by the bound of their layers.
void judge_layers(Unit& unit, const Scene& scene) {
  const Config config = with_alpha(unit.config, scene);
  FragmentFrame frame(scene, config);
  RenderOptions options = render_options();
  options.fragment_tap = [&frame](const TappedFragment& fragment) { frame.add(fragment); };
  const Rendering rendering = unit.engine(scene, unit.config, options);
  frame.finish();
  unit.count_triangles(rendering.triangles.size());
  LayeredColors colors = frame.layers();
  std::size_t p = 0;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x, ++p)
      if (frame.owners()[p] >= 0) colors.judge(p, rendering.frame.color[rendering.frame.at(x, y)]);
  for (const LayerRow& row : colors.rows()) {
    unit.count_checks(row.pixels);
    unit.measure("layers", "of its bound", row.part_of_bound, 1, scene);
  }
}

}  // namespace

void layers(Unit& unit) {
  State state = SceneBuilder::window_state();
  state = with(unit, state, {"blend", "blend_equation", "blend_color", "dither"});
  if (!state.blend || unit.random.coin())
    state.blend = BlendFactors{BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha, BlendFactor::one,
                               BlendFactor::one_minus_src_alpha};
  SceneBuilder builder(unit.width(12), unit.height(10), state);
  const int count = 1 << unit.random.index(7);
  add_triangles(unit, builder, count);
  judge_layers(unit, builder.scene);
}

void logic_ops(Unit& unit) {
  State state = SceneBuilder::window_state();
  SceneBuilder builder(unit.width(12), unit.height(10), state);
  const int count = 1 << unit.random.index(5);
  for (int n = 0; n < count; ++n) {
    builder.with_state(unit.random.index(4) == 0 ? with(unit, state, {"blend", "blend_equation", "blend_color"})
                                                 : with(unit, state, {"logic_op", "color_mask", "dither"}));
    add_triangles(unit, builder, 1);
  }
  judge_layers(unit, builder.scene);
  (void)rendered(unit, builder.scene);
}

void opaque_blend(Unit& unit) {
  SceneBuilder builder(unit.width(40), unit.height(32));
  add_triangles(unit, builder, 6);
  for (Vertex& vertex : builder.scene.vertices) vertex.rgba[3] = 255;
  const Rendering plain = rendered(unit, builder.scene);
  for (State& state : builder.scene.states)
    state.blend = BlendFactors{BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha, BlendFactor::src_alpha,
                               BlendFactor::one_minus_src_alpha};
  expect_same_image(unit, builder.scene, plain, rendered(unit, builder.scene));
}

void alpha_parts(Unit& unit) {
  // Fragments that pass a test, and fragments that pass its opposite, are all fragments: where order does not matter.
  State state = SceneBuilder::window_state();
  state.blend = BlendFactors{BlendFactor::one, BlendFactor::one, BlendFactor::one, BlendFactor::one};
  state.blend_equation = {BlendEquation::max, BlendEquation::max};
  SceneBuilder builder(unit.width(40), unit.height(32), state);
  add_triangles(unit, builder, 5);
  const Rendering whole = rendered(unit, builder.scene);
  constexpr std::array<std::array<DepthFunc, 2>, 4> kOpposites{{{DepthFunc::less, DepthFunc::gequal},
                                                                {DepthFunc::lequal, DepthFunc::greater},
                                                                {DepthFunc::equal, DepthFunc::notequal},
                                                                {DepthFunc::never, DepthFunc::always}}};
  const auto& funcs = kOpposites[static_cast<std::size_t>(unit.random.index(4))];
  const auto reference = static_cast<std::uint8_t>(unit.random.index(256));
  Scene parts = builder.scene;
  for (State& of : parts.states) of.alpha_test = {funcs[0], reference};
  state.alpha_test = {funcs[1], reference};
  again(parts, state);
  const Rendering both = rendered(unit, parts);
  unit.count_checks(1);
  unit.require(both.frame.color == whole.frame.color, "parts", parts, "the parts are not the whole");
  unit.require(both.counters.written == whole.counters.written, "written", parts, "a fragment is in both, or in none");
}

void mask_parts(Unit& unit) {
  SceneBuilder builder(unit.width(40), unit.height(32));
  add_triangles(unit, builder, 1);
  const Rendering whole = rendered(unit, builder.scene);
  Scene parts = builder.scene;
  const int bits = unit.random.index(16);
  State other = parts.states.back();
  for (std::size_t c = 0; c < 4; ++c) {
    for (State& of : parts.states) of.color_mask[c] = (bits >> c & 1) != 0;
    other.color_mask[c] = (bits >> c & 1) == 0;
  }
  again(parts, other);
  const Rendering both = rendered(unit, parts);
  unit.count_checks(2);
  unit.require(both.frame.color == whole.frame.color, "parts", parts, "the parts are not the whole");
  unit.require(both.frame.depth == whole.frame.depth, "depth", parts, "the depths are others");
}

void stencil_counts(Unit& unit) {
  // Each fragment adds one; a later draw where the value is k fills the pixels with k fragments.
  State state = SceneBuilder::window_state();
  state.depth_test = static_cast<DepthFunc>(unit.random.index(8));
  state.stencil = Stencil{.func = DepthFunc::always,
                          .stencil_fails = StencilOp::zero,
                          .depth_fails = StencilOp::incr_wrap,
                          .passes = StencilOp::incr_wrap};
  SceneBuilder builder(unit.width(24), unit.height(20), state);
  add_triangles(unit, builder, 1 + unit.random.index(12));
  const Rendering drawn = rendered(unit, builder.scene);
  expect_pixels(unit, "stencil", builder.scene, [&](int x, int y, std::size_t p) {
    return drawn.frame.stencil[drawn.frame.at(x, y)] != (drawn.count[p] & 255U);
  });
}

void fog(Unit& unit) {
  Random& random = unit.random;
  State state = SceneBuilder::window_state();
  state = with(unit, state, {"fog_color", "color_interp", "alpha_test", "blend"});
  const double ratio = std::exp2(random.between(0, 13)), scale = std::exp2(random.between(-20, 20));
  const auto distance = [&] { return scale * std::pow(ratio, random.unit()); };
  Fog of{static_cast<FogKind>(random.index(3)), distance(), distance()};
  if (of.kind != FogKind::linear) of.start = of.end = 1 / of.end;
  if (of.start > of.end) std::swap(of.start, of.end);
  if (random.index(8) == 0) of.start = 0;
  if (of.kind != FogKind::linear) of.end = of.start;
  state.fog = of;
  SceneBuilder builder(unit.width(40), unit.height(32), state);
  add_triangles(unit, builder, 3);
  for (Vertex& vertex : builder.scene.vertices) vertex.w = distance();
  const Scene& scene = builder.scene;
  const FragmentVerdict verdict = judged(unit, scene);
  if (verdict.fragments > 0) {
    unit.measure("fog", "LSB", verdict.surfaces.fog.value, verdict.surfaces.fog.bound, scene);
    unit.measure("factor", "LSB", verdict.surfaces.fog_factor.value, verdict.surfaces.fog_factor.bound, scene);
  }
  check_without_taps(unit, scene);
}

void light(Unit& unit) {
  Random& random = unit.random;
  State state = SceneBuilder::window_state();
  state = with(unit, state, {"color_interp", "light_ambient", "light_diffuse", "light_specular", "blend"});
  if (random.coin()) state = with(unit, state, {"fog", "fog_color"});
  const auto direction = [&random] {
    return std::array{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
  };
  state.shade = Shade::phong;
  state.light_direction = direction();
  state.light_half = direction();
  state.light_shininess = std::exp2(random.between(0, 7));
  SceneBuilder builder(unit.width(40), unit.height(32), state);
  add_triangles(unit, builder, 3);
  Scene& scene = builder.scene;
  const double ratio = std::exp2(random.between(0, 10)), scale = std::exp2(random.between(-20, 20));
  // Normals of a flat triangle, of a curved one, or random ones; and some where highlights are.
  const double bend = std::exp2(random.between(-8, 1));
  const auto middle = random.coin() ? state.light_half : direction();
  for (Vertex& vertex : scene.vertices) {
    vertex.w = scale * std::pow(ratio, random.unit());
    auto normal = direction();
    for (std::size_t c = 0; c < 3; ++c) normal[c] = middle[c] + bend * normal[c];
    scene.normals.push_back(normal);
  }
  const FragmentVerdict verdict = judged(unit, scene);
  if (verdict.fragments > 0)
    unit.measure("light", "LSB", verdict.surfaces.light.value, verdict.surfaces.light.bound, scene);
  check_without_taps(unit, scene);
}

}  // namespace halfplane::stress
