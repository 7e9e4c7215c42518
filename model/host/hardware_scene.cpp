// The scenes that this hardware supports.
#include "../draw_states.hpp"
#include "../stages/depth_encode.hpp"
#include "../stages/fragment_ops.hpp"
#include "../stages/stencil_packets.hpp"
#include "../stages/surface.hpp"
#include "primitive_stream.hpp"
#include "primitives.hpp"

namespace halfplane {
namespace {

/// A unit in the stream of stamps, and the draw state that it executes.
struct UnitOfState {
  const Setting& setting;
  const DrawState& state;

  [[nodiscard]] bool is_used_by(const State& of) const {
    static const State kDefault;
    return of.color_write && !state.is_same(of, kDefault);
  }
};

const std::vector<UnitOfState>& units_of_states() {
  static const std::vector<UnitOfState> kUnits = [] {
    std::vector<UnitOfState> units;
    for (const Setting& setting : settings())
      if (!setting.executed.name.empty()) units.push_back({setting, draw_state(setting.executed.name)});
    return units;
  }();
  return kUnits;
}

/// The missing feature of this hardware for a textured draw, or a draw with colours over w; empty: none.
std::string surface_fault(const Scene& scene, const State& state, const Config& config) {
  if (state.shade == Shade::phong && state.color_write && !has_normals(config))
    return "shade phong: this hardware lights no fragments; set shade.unit=1 (with texture.unit=nearest and "
           "perspective.colors=0), or light the vertices and use shade smooth";
  if (state.color_interp == ColorInterp::perspective && !has_colors_over_w(config))
    return "color_interp perspective: this hardware divides no colours by w; set texture.unit=nearest and "
           "perspective.colors=1";
  const bool is_affine = state.texture && state.texture_interp == TextureInterp::affine;
  for (const UnitOfState& unit : units_of_states())
    if (is_affine && unit.setting.executed.reads_w && unit.is_used_by(state)) {
      const std::string name(unit.state.name);
      return name + " over a texture_interp affine: both look at one plane of 1/w, which is not the same; use " +
             "texture_interp perspective, or " + name + " off";
    }
  if (state.shade == Shade::phong && state.color_write && is_affine)
    return "shade phong under a texture_interp affine: normals and coordinates start where one plane of 1/w says, "
           "which is not the same; use texture_interp perspective, or shade smooth";
  if (!state.texture) return "";
  if (state.color_interp == ColorInterp::perspective && state.texture_interp == TextureInterp::affine)
    return "texture_interp affine: a triangle of this hardware has one plane of 1/w, and color_interp perspective "
           "needs "
           "it; make both perspective or both affine";
  if (config.texture_unit == TextureUnitKind::off)
    return "texture: this hardware has no texture unit; set texture.unit=nearest";
  if (state.texture_combine == TextureCombine::blend && config.texture_constants == 0)
    return "texture_combine blend: this texture unit has no constant colour; set texture.constant=1, or use another "
           "way "
           "to combine";
  if ((has_border(state.texture_wrap[0]) || has_border(state.texture_wrap[1])) && config.texture_borders == 0)
    return "texture_wrap border and half_border: this texture unit has no border colour; set texture.border=1, or use "
           "clamp";
  const bool is_linear = state.texture_min == TextureMin::linear && state.texture_mag == TextureMag::linear;
  if (is_linear && config.texture_unit == TextureUnitKind::nearest)
    return "texture_min and texture_mag: this texture unit takes nearest texels alone; use nearest, or set "
           "texture.unit=bilinear";
  if (config.texture_unit != TextureUnitKind::trilinear && !is_linear &&
      (state.texture_min != TextureMin::nearest || state.texture_mag != TextureMag::nearest))
    return "texture_min and texture_mag: this texture unit knows no levels, nor which of the two counts; make both "
           "nearest or both linear, or set texture.unit=trilinear";
  const Texture& texture = scene.textures[*state.texture];
  if (!TextureAxis{texture.width()}.is_power_of_two() || !TextureAxis{texture.height()}.is_power_of_two())
    return "texture: " + texture.name + " has " + std::to_string(texture.width()) + "x" +
           std::to_string(texture.height()) + " texels, and this texture unit takes powers of two";
  return "";
}

/// The missing feature of this hardware for a state's operations, and the remedy; empty: none.
std::string fragment_fault(const State& state, const Config& config) {
  const FragmentOps ops = fragment_ops(state, config.color_format);
  const auto unit = [](const char* setting) {
    return std::string(", but this hardware has no unit for it; set ") + setting +
           " (with cache.kind=blocks and setup.kind=pipelined), or leave it out";
  };
  if (ops.alpha.func != DepthFunc::always && !tests_alpha(config)) return "alpha_test" + unit("alpha.unit=1");
  if (state.alpha_to_coverage && config.msaa_samples > 1 && !tests_alpha(config))
    return "alpha_to_coverage" + unit("alpha.unit=1");
  if (ops.stencil && !has_stencil(config))
    return "stencil, but this hardware keeps none; set stencil.bits=8 (with cache.kind=blocks, "
           "setup.kind=pipelined and depth.bits up to 24), or leave it out";
  if (!ops.state.color_write) return {};
  for (const auto& [setting, executed] : units_of_states())
    if (get(config, setting) == "0" && UnitOfState{setting, executed}.is_used_by(state))
      return std::string(executed.name) + ", but this hardware has no unit for it; set " + std::string(setting.key) +
             "=1 (with " + std::string(setting.executed.with) + "), or leave it out";
  if (ops.color.logic != LogicOp::copy && config.logic_units == 0)
    return "logic_op" + unit("logic.unit=1 and blend.lanes=4");
  if (ops.color.blends() && config.blend_lanes == 0) return "blend" + unit("blend.lanes=4");
  if (ops.color.reads_stored() && config.blend_lanes == 0) return "color_mask of some channels" + unit("blend.lanes=4");
  if (ops.color.dithers && config.dither_units == 0) return "dither" + unit("dither.unit=1");
  return {};
}

}  // namespace

void check_hardware_scene(const Scene& scene, const Config& config) {
  require_sampled_hardware(config, "this hardware");
  check_scene(scene, config);
  if (config.resolve_units != 0 && !begins_once(scene))
    throw InputError((scene.name.empty() ? "scene" : scene.name) +
                     ": a clear of the whole depth after a draw, but with resolve.unit the samples of what is drawn "
                     "are gone by then; use resolve.unit=0, or the functional, scalar or golden engine");
  if (!DepthEncode(config, scene.planes).is_identity())
    throw InputError(
        "depth.mapping w and log and every depth.format but plane: this hardware stores the depth that it "
        "interpolates; use the functional, scalar or golden engine, or depth.format=plane");
  for (const Command& command : scene.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr) continue;
    const State& state = scene.states[draw->state];
    if (drawn_as(state, draw->topology) == PrimitiveType::triangle)
      if (const std::string fault = surface_fault(scene, state, config); !fault.empty())
        throw InputError(place_of_draw(scene.name, draw->line) + ": state " + fault +
                         "; or use the functional, scalar or golden engine");
    if (const std::string fault = fragment_fault(state, config); !fault.empty())
      throw InputError(place_of_draw(scene.name, draw->line) + ": state " + fault +
                       "; or use the functional, scalar or golden engine");
    if (config.line_units == 0 && drawn_as(state, draw->topology) == PrimitiveType::line &&
        state.line_rule != LineRule::rectangle && !state.smooth)
      throw InputError(place_of_draw(scene.name, draw->line) +
                       ": lines, but this hardware has no unit that draws them; set lines.unit=1, or state line_rule "
                       "rectangle");
  }
}

}  // namespace halfplane
