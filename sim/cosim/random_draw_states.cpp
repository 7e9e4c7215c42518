#include "sim/cosim/random_draw_states.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "model/host/primitives.hpp"
#include "sim/scene/random.hpp"
#include "sim/scene/random_state.hpp"

namespace halfplane {
namespace {

class Passes {
 public:
  Passes(Scene& scene, const Config& config, const RandomProfile& profile, std::uint64_t seed)
      : scene_(scene), config_(config), profile_(profile), seed_(seed) {}

  void run(bool has_shapes) {
    set_newer();
    if (has_shapes) set_shapes();
    set_units();
    if (config_.logic_units != 0) set_logic_ops();
    if (config_.stencil_bits != 0) set_stencils();
    if (has_texture_planes(config_)) set_textures();
    if (config_.fog_units != 0) set_fogs();
    if (has_normals(config_)) set_lights();
    if (config_.msaa_samples > 1) set_samples();
    if (config_.resolve_units != 0) drop_later_clears();
    if (has_colors_over_w(config_)) set_colors_over_w();
  }

 private:
  void set_newer();
  void set_shapes();
  void set_samples();
  void drop_later_clears();
  void set_units();
  void set_logic_ops();
  void set_stencils();
  void set_constants();
  void set_borders();
  void set_textures();
  void set_fogs();
  void set_lights();
  void set_colors_over_w();

  Scene& scene_;
  const Config& config_;
  const RandomProfile& profile_;
  std::uint64_t seed_;
};

/// Sets the other states that travel with a primitive.
void Passes::set_newer() {
  StateRows rows = states_but({"depth_test", "depth_write", "color_write", "cull", "front"});
  std::erase_if(rows, [](const DrawState* row) { return row->home != StateHome::primitive; });
  Random random(~seed_);
  for (State& state : scene_.states) state = random_state(state, rows, chooser(random));
}

/// Sets wide lines and round points in a third of the draws of either; rectangles in a third of the draws of lines, and
/// without a line unit as edges of triangles; few rectangles and points are smooth, since that takes a primitive per
/// pixel.
void Passes::set_shapes() {
  Random random(seed_ ^ 0x51a9e5u), of_rectangles(seed_ ^ 0x2ec7a91eu);
  const int beside = config_.guard_band - std::max(scene_.width, scene_.height);
  const int widest = 2 * (beside - 1), widest_rectangle = beside - 3;
  for (const Command& command : scene_.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr) continue;
    State& state = scene_.states[draw->state];
    const PrimitiveType type = drawn_as(state, draw->topology);
    const unsigned one_of = type == PrimitiveType::line ? 3 : 24;
    const bool may_be_rectangle =
        type == PrimitiveType::line || (type == PrimitiveType::triangle && config_.line_units == 0);
    if (may_be_rectangle && widest_rectangle >= 1 && of_rectangles.next() % one_of == 0) {
      if (type == PrimitiveType::triangle) state.polygon_mode = PolygonMode::line;
      state.line_rule = LineRule::rectangle;
      state.smooth = of_rectangles.next() % 8 == 0;
      const auto quarters = static_cast<std::uint64_t>(4 * (widest_rectangle - 1) + 1);
      state.line_width = 1 + static_cast<double>(of_rectangles.next() % std::min<std::uint64_t>(quarters, 25)) / 4;
      continue;
    }
    if (type == PrimitiveType::triangle) continue;
    if (type == PrimitiveType::point) state.smooth = of_rectangles.next() % 8 == 0;
    if (random.next() % 3 != 0) continue;
    if (type == PrimitiveType::line)
      state.line_width = std::clamp(static_cast<int>(2 + random.next() % 6), 1, std::max(widest, 1));
    else
      state.point_shape = PointShape::round;
  }
}

/// In a third of the draws selects some of a pixel's samples; by alpha if the hardware has it.
void Passes::set_samples() {
  Random random(seed_ ^ 0x5a3b1e5u);
  StateRows rows = states_named({"sample_mask"});
  if (tests_alpha(config_)) rows.push_back(&draw_state("alpha_to_coverage"));
  for (State& state : scene_.states)
    if (random.next() % 3 == 0) state = random_state(state, rows, chooser(random));
}

/// Of the clears after a draw, keeps clears of colours alone.
void Passes::drop_later_clears() {
  bool is_after_draw = false;
  std::erase_if(scene_.commands, [&](const Command& command) {
    const auto* clear = std::get_if<Clear>(&command);
    is_after_draw = is_after_draw || clear == nullptr;
    return clear != nullptr && is_after_draw && (clear->depth || clear->stencil);
  });
}

/// Sets states of this hardware's units downstream of the depth test, in runs of draws with and without.
void Passes::set_units() {
  StateRows rows;
  const auto add = [&rows](const StateRows& more) { rows.insert(rows.end(), more.begin(), more.end()); };
  if (config_.blend_lanes != 0)  // the first ones twice: blending is as likely as not
    add(states_named({"blend", "blend", "blend_equation", "blend_color", "color_mask"}));
  if (config_.dither_units != 0) add(states_named({"dither"}));
  if (tests_alpha(config_)) add(states_named({"alpha_test"}));
  for (const Setting& setting : settings())  // fogs have a pass of their own
    if (const auto name = setting.executed.name; !name.empty() && name != "fog" && get(config_, setting) != "0")
      add(states_named({name}));
  Random random(seed_ ^ 0xb1e4du);
  bool has_units = false;
  for (State& state : scene_.states) {
    if (random.next() % 4 == 0) has_units = !has_units;
    if (has_units) state = random_state(state, rows, chooser(random));
  }
}

/// Gives some states a logic operation, in the place of blending.
void Passes::set_logic_ops() {
  Random random(seed_ ^ 0x106100u);
  for (State& state : scene_.states)
    if (random.next() % 4 == 0) state.logic_op = static_cast<LogicOp>(random.next() % 16);
}

/// Sets stencil tests in runs of draws, with few values so that they meet, and clears of the stencil, alone and with
/// others.
void Passes::set_stencils() {
  Random random(seed_ ^ 0x57e4c11u);
  const auto below = [&random](std::uint64_t n) { return random.next() % n; };
  const auto value = [&] { return static_cast<std::uint8_t>(below(4) == 0 ? below(256) : below(3)); };
  const auto side = [&] {
    Stencil s;
    s.func = below(2) == 0 ? DepthFunc::always : static_cast<DepthFunc>(below(8));
    s.reference = value();
    if (below(3) == 0) s.read_mask = static_cast<std::uint8_t>(below(256));
    if (below(3) == 0) s.write_mask = below(4) == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(below(256));
    const auto op = [&] { return below(3) == 0 ? StencilOp::keep : static_cast<StencilOp>(below(8)); };
    const bool marks_failed = below(2) == 0;
    s.passes = op();
    if (marks_failed) s.stencil_fails = op();
    if (marks_failed) s.depth_fails = op();
    return s;
  };
  bool has_stencil = false;
  for (State& state : scene_.states) {
    if (below(4) == 0) has_stencil = !has_stencil;
    if (!has_stencil) continue;
    state.stencil = side();
    if (below(3) == 0) state.stencil_back = side();
  }
  // Now and then a whole word is replaced, or all but a few bits of it.
  Random rare(seed_ ^ 0x4e91aceu);
  const auto one_of = [&rare](std::uint64_t n) { return rare.next() % n == 0; };
  for (State& state : scene_.states) {
    if (!state.stencil || !one_of(6)) continue;
    state.depth_test = DepthFunc::always;
    state.depth_write = true;
    for (Stencil* s : {&*state.stencil, state.stencil_back ? &*state.stencil_back : nullptr}) {
      if (s == nullptr) continue;
      s->passes = one_of(6) ? StencilOp::zero : StencilOp::replace;
      s->reference |= 1;
      if (one_of(2)) s->func = DepthFunc::always;
      s->write_mask = one_of(3) ? static_cast<std::uint8_t>(rare.next() % 256) : std::uint8_t{255};
    }
  }
  for (Command& command : scene_.commands)
    if (auto* clear = std::get_if<Clear>(&command)) {
      if (below(2) == 0) clear->stencil = value();
      if (clear->stencil && below(4) == 0) clear->depth.reset();
      if (clear->stencil && below(4) == 0) clear->color.reset();
    }
}

/// Lets some states blend by their texels.
void Passes::set_constants() {
  Random random(seed_ ^ 0xc057u);
  for (State& state : scene_.states) {
    if (random.next() % 3 != 0) continue;
    state.texture_combine = TextureCombine::blend;
    for (std::uint8_t& channel : state.texture_constant)
      channel = static_cast<std::uint8_t>(random.next() % 4 == 0 ? 255 * (random.next() % 2) : random.next() % 256);
  }
}

/// Lets some states have a border.
void Passes::set_borders() {
  Random random(seed_ ^ 0xb0bdu);
  for (State& state : scene_.states) {
    for (TextureWrap& wrap : state.texture_wrap)
      if (random.next() % 3 == 0) wrap = random.next() % 2 == 0 ? TextureWrap::border : TextureWrap::half_border;
    const bool is_same = random.next() % 2 == 0;  // equal to other states' textures: no token in between
    for (std::uint8_t& channel : state.texture_border)
      channel = static_cast<std::uint8_t>(is_same ? 77 : random.next() % 4 == 0 ? 255 : random.next() % 256);
  }
}

/// Makes a few small textures, with levels if the unit has them, and triangles that show them: w ratios up to 2^10,
/// coordinates from next to a texel's border to many repeats away.
void Passes::set_textures() {
  Random random(seed_ ^ 0x7e87u);
  const auto below = [&random](std::uint64_t n) { return random.next() % n; };
  const auto chance = [&random](double probability) { return random.uniform(0, 1) < probability; };
  const bool has_levels = config_.texture_unit == TextureUnitKind::trilinear;
  const std::size_t drawn = 1 + below(4);
  const auto count = static_cast<std::size_t>(profile_.textures.value_or(static_cast<int>(drawn)));
  for (std::size_t n = 0; n < count; ++n) {
    TexelImage image{1 << below(7), 1 << below(7), {}};
    if (profile_.texels)
      image.width = image.height = *profile_.texels;
    else if (has_levels && chance(0.2))
      (chance(0.5) ? image.width : image.height) <<= 4;
    image.texel.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    const bool has_few_colors = chance(0.5);
    for (Texel& texel : image.texel)
      for (std::uint8_t& channel : texel)
        channel = static_cast<std::uint8_t>(has_few_colors ? 255 * below(2) : below(256));
    const std::size_t formats = has_few_colors ? 8 : 6;  // a palette has no more
    const auto format = static_cast<TextureFormat>(below(formats));
    const Mips mips = has_levels && chance(0.8) ? Mips::box : Mips::none;
    scene_.textures.push_back(make_texture("random" + std::to_string(n), image, format, mips));
  }
  for (State& state : scene_.states) {
    if (!chance(0.75)) continue;
    state.texture = static_cast<std::uint32_t>(below(count));
    state.texture_interp = chance(0.8) ? TextureInterp::perspective : TextureInterp::affine;
    for (TextureWrap& wrap : state.texture_wrap) wrap = static_cast<TextureWrap>(below(3));
    state.texture_combine = static_cast<TextureCombine>(below(4));
    if (config_.texture_unit == TextureUnitKind::bilinear && !chance(0.3)) {
      state.texture_min = TextureMin::linear;
      state.texture_mag = TextureMag::linear;
    }
    if (!has_levels) continue;
    state.texture_min = static_cast<TextureMin>(below(6));
    state.texture_mag = static_cast<TextureMag>(below(2));
    if (chance(0.5)) state.texture_lod[0] = random.uniform(-3, 3);
    if (chance(0.2)) state.texture_lod[1] = random.uniform(0, 4);
    if (chance(0.2)) state.texture_lod[2] = random.uniform(0, 12);
  }
  if (config_.texture_constants != 0) set_constants();
  if (config_.texture_borders != 0) set_borders();
  const double reach = std::ldexp(1.0, static_cast<int>(below(8)) - 2);  // offset of the coordinates, in repeats
  for (Vertex& v : scene_.vertices) {
    v.w = chance(0.3) ? 1.0 : std::exp2(random.uniform(-5, 5));
    v.u = random.uniform(-reach, reach);
    v.v = random.uniform(-reach, reach);
    if (chance(0.3)) v.u = static_cast<double>(below(65)) / 64;
    if (chance(0.3)) v.v = static_cast<double>(below(65)) / 64;
  }
  // Levels that have nothing to do with their image.
  for (Texture& texture : scene_.textures) {
    if (texture.mips != Mips::box || !chance(0.3)) continue;
    texture.mips = Mips::levels;
    const std::size_t codes =
        texture.palette.empty() ? std::size_t{1} << texel_bits(texture.format) : texture.palette.size();
    for (std::size_t n = 1; n < texture.level.size(); ++n)
      for (std::uint32_t& code : texture.level[n].code) code = static_cast<std::uint32_t>(below(codes));
  }
}

/// Makes a few fogs, from one that begins at the eye to one with almost no width, at distances of vertices and beyond;
/// in runs of draws, since each needs a table.
void Passes::set_fogs() {
  Random random(seed_ ^ 0xf06u);
  const auto below = [&random](std::uint64_t n) { return random.next() % n; };
  std::vector<State> fogs(1 + below(3));
  for (State& state : fogs) {
    Fog fog;
    fog.kind = static_cast<FogKind>(below(3));
    const double reach = std::exp2(random.uniform(-7, 7));
    if (fog.kind == FogKind::linear) {
      fog.start = below(2) == 0 ? 0 : reach * random.uniform(0, 1.25);
      fog.end = below(8) == 0 ? 0 : reach;
    } else {
      fog.start = fog.end = below(8) == 0 ? 0 : 1 / reach;
    }
    state.fog = fog;
    for (std::uint8_t& channel : state.fog_color) channel = static_cast<std::uint8_t>(below(256));
  }
  const State* fog = nullptr;
  for (State& state : scene_.states) {
    if (below(6) == 0) fog = below(3) == 0 ? nullptr : &fogs[below(fogs.size())];
    if (fog == nullptr || (state.texture && state.texture_interp == TextureInterp::affine)) continue;
    state.fog = fog->fog;
    state.fog_color = fog->fog_color;
  }
}

/// Makes a few lights, in runs of draws, since each needs a table; and normals, some of them 0, along an axis, or
/// nearly equal.
void Passes::set_lights() {
  Random random(seed_ ^ 0x11967u);
  const auto below = [&random](std::uint64_t n) { return random.next() % n; };
  const auto vector = [&]() -> std::array<double, 3> {
    std::array<double, 3> v{};
    if (below(6) == 0)
      v[below(3)] = below(2) == 0 ? 1 : -1;
    else if (below(12) != 0)
      for (double& c : v) c = random.uniform(-1, 1);
    return v;
  };
  std::vector<State> lights(1 + below(3));
  for (State& state : lights) {
    state.light_direction = vector();
    state.light_half = below(2) == 0 ? state.light_direction : vector();
    if (below(4) == 0)  // a normal away from the light would have the highlight
      for (std::size_t c = 0; c < 3; ++c) state.light_half[c] = -state.light_direction[c];
    for (auto* color : {&state.light_ambient, &state.light_diffuse, &state.light_specular})
      for (std::uint8_t& channel : *color) channel = static_cast<std::uint8_t>(below(4) == 0 ? 255 : below(256));
    state.light_shininess = below(4) == 0 ? 1 : std::exp2(random.uniform(0, 7));
  }
  const State* light = nullptr;
  for (State& state : scene_.states) {
    if (below(4) == 0) light = below(3) == 0 ? nullptr : &lights[below(lights.size())];
    if (light == nullptr || (state.texture && state.texture_interp == TextureInterp::affine)) continue;
    state.shade = Shade::phong;
    state.light_direction = light->light_direction;
    state.light_half = light->light_half;
    state.light_ambient = light->light_ambient;
    state.light_diffuse = light->light_diffuse;
    state.light_specular = light->light_specular;
    state.light_shininess = light->light_shininess;
  }
  std::array<double, 3> axis = vector();
  for (std::size_t n = 0; n < scene_.vertices.size(); ++n) {
    if (below(9) == 0) axis = vector();
    std::array<double, 3> normal = vector();
    if (below(2) == 0)
      for (std::size_t c = 0; c < 3; ++c) normal[c] = axis[c] + normal[c] / 16;
    scene_.normals.push_back(normal);
  }
}

/// Colours over w in runs of draws, textured and not.
void Passes::set_colors_over_w() {
  Random random(seed_ ^ 0xc0107u);
  bool is_over_w = false;
  for (const Command& command : scene_.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr) continue;
    if (random.next() % 3 == 0) is_over_w = !is_over_w;
    State& state = scene_.states[draw->state];
    if (!is_over_w || drawn_as(state, draw->topology) != PrimitiveType::triangle) continue;
    state.color_interp = ColorInterp::perspective;
    state.texture_interp = TextureInterp::perspective;  // one 1/w per triangle
  }
}

}  // namespace

void set_draw_states(Scene& scene, const Config& config, const RandomProfile& profile, std::uint64_t seed,
                     bool has_shapes) {
  Passes(scene, config, profile, seed).run(has_shapes);
}

}  // namespace halfplane
