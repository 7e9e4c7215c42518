#include "capture_states.hpp"

#include <array>
#include <optional>
#include <type_traits>
#include <utility>

namespace halfplane {
namespace {

using Name = std::string_view;

// In the order of the enumerators (false, true for switches).
constexpr std::array<Name, 2> space_names{"clip", "window"};
constexpr std::array<Name, 8> depth_names{"never",   "less",   "lequal",   "equal",
                                          "greater", "gequal", "notequal", "always"};
constexpr std::array<Name, 2> switch_names{"off", "on"};
constexpr std::array<Name, 4> cull_names{"none", "back", "front", "both"};
constexpr std::array<Name, 2> front_names{"ccw", "cw"};
constexpr std::array<Name, 2> shade_names{"smooth", "flat"};
constexpr std::array<Name, 2> interp_names{"affine", "perspective"};
constexpr std::array<Name, 2> clip_z_names{"minus_one_one", "zero_one"};
constexpr std::array<Name, 2> pixel_center_names{"half", "integer"};
constexpr std::array<Name, 2> origin_names{"top_left", "bottom_left"};

constexpr std::array<Name, 2> provoking_names{"first", "last"};
constexpr std::array<Name, 3> polygon_mode_names{"fill", "line", "point"};
constexpr std::array<Name, 3> line_rule_names{"midpoint", "bresenham", "diamond"};
constexpr std::array<Name, 3> line_last_names{"off", "on", "rule"};
constexpr std::array<Name, 2> point_clip_names{"pixel", "center"};

// Rectangles stay small enough that sums of their numbers fit an int: far beyond any target (16384 pixels).
constexpr int far_away = 1 << 20;  // pixels

/// A setting whose value is one word. Each instance has a reader of its own, so its name is a template argument too.
template <auto member, const auto& names, const Name& name>
constexpr CaptureState choice() {
  using Value = std::remove_cvref_t<decltype(std::declval<State>().*member)>;
  return {name, [](CaptureText& text, State& state) { state.*member = static_cast<Value>(text.choice(name, names)); },
          [](const State& state, std::string& out) {
            out += ' ';
            out += names[static_cast<std::size_t>(state.*member)];
          },
          [](const State& a, const State& b) { return a.*member == b.*member; }};
}

void append_integer(std::string& out, int value) { out += ' ' + std::to_string(value); }

void read_scissor(CaptureText& text, State& state) {
  CaptureText ahead = text;  // a word to look at before it is read
  if (ahead.word() == "off") {
    text = ahead;
    state.scissor.reset();
    return;
  }
  if (!text.has_word()) text.fail("scissor without a value; write off or x y width height in pixels");
  Rect rect;
  rect.x = text.integer("scissor x", -far_away, far_away);
  rect.y = text.integer("scissor y", -far_away, far_away);
  rect.width = text.integer("scissor width", 0, far_away);
  rect.height = text.integer("scissor height", 0, far_away);
  state.scissor = rect;
}

void write_scissor(const State& state, std::string& out) {
  if (!state.scissor) {
    out += " off";
    return;
  }
  for (const int value : {state.scissor->x, state.scissor->y, state.scissor->width, state.scissor->height})
    append_integer(out, value);
}

void read_viewport(CaptureText& text, State& state) {
  CaptureText ahead = text;
  if (ahead.word() == "full") {
    text = ahead;
    state.viewport.reset();
    return;
  }
  if (!text.has_word()) text.fail("viewport without a value; write full or x y width height in pixels");
  Viewport viewport;
  viewport.x = text.number("viewport x", -far_away, far_away);
  viewport.y = text.number("viewport y", -far_away, far_away);
  viewport.width = text.number("viewport width", 0, far_away);
  viewport.height = text.number("viewport height", 0, far_away);
  if (viewport.width <= 0 || viewport.height <= 0)
    text.fail("viewport width and height must be above 0; write full or x y width height in pixels");
  viewport.x += 0.0;  // -0 becomes 0: equal states are then equal in every bit
  viewport.y += 0.0;
  state.viewport = viewport;
}

void write_viewport(const State& state, std::string& out) {
  if (!state.viewport) {
    out += " full";
    return;
  }
  for (const double value : {state.viewport->x, state.viewport->y, state.viewport->width, state.viewport->height}) {
    out += ' ';
    append_number(out, value);
  }
}

void read_depth_range(CaptureText& text, State& state) {
  for (double& bound : state.depth_range) bound = text.number("a bound of depth_range", 0, 1) + 0.0;  // no -0
}

void write_depth_range(const State& state, std::string& out) {
  for (const double bound : state.depth_range) {
    out += ' ';
    append_number(out, bound);
  }
}

void read_polygon_offset(CaptureText& text, State& state) {
  constexpr double limit = 1e12;  // more than any slope between two codes of 32 bits
  state.polygon_offset[0] = text.number("polygon_offset's slope factor", -limit, limit) + 0.0;
  state.polygon_offset[1] = text.number("polygon_offset's constant", -limit, limit) + 0.0;
}

void write_polygon_offset(const State& state, std::string& out) {
  for (const double part : state.polygon_offset) {
    out += ' ';
    append_number(out, part);
  }
}

void read_line_last(CaptureText& text, State& state) {
  const std::size_t value = text.choice("line_last", line_last_names);
  state.line_last = value == 2 ? std::nullopt : std::optional<bool>(value == 1);
}

void write_line_last(const State& state, std::string& out) {
  out += ' ';
  out += line_last_names[state.line_last ? (*state.line_last ? 1 : 0) : 2];
}

void read_point_size(CaptureText& text, State& state) { state.point_size = text.number("point_size", 1, far_away); }

void write_point_size(const State& state, std::string& out) {
  out += ' ';
  append_number(out, state.point_size);
}

constexpr Name space = "space", depth_test = "depth_test", depth_write = "depth_write", color_write = "color_write",
               cull = "cull", front = "front", shade = "shade", color_interp = "color_interp", clip_z = "clip_z",
               provoking = "provoking", polygon_mode = "polygon_mode", line_rule = "line_rule",
               point_clip = "point_clip", pixel_center = "pixel_center", origin = "origin";

constexpr CaptureState space_setting = choice<&State::space, space_names, space>();

constexpr std::array<CaptureState, 20> settings_table{{
    choice<&State::depth_test, depth_names, depth_test>(),
    choice<&State::depth_write, switch_names, depth_write>(),
    choice<&State::color_write, switch_names, color_write>(),
    choice<&State::cull, cull_names, cull>(),
    choice<&State::front, front_names, front>(),
    choice<&State::shade, shade_names, shade>(),
    choice<&State::color_interp, interp_names, color_interp>(),
    choice<&State::clip_z, clip_z_names, clip_z>(),
    choice<&State::pixel_center, pixel_center_names, pixel_center>(),
    choice<&State::origin, origin_names, origin>(),
    {"scissor", read_scissor, write_scissor, [](const State& a, const State& b) { return a.scissor == b.scissor; }},
    {"viewport", read_viewport, write_viewport,
     [](const State& a, const State& b) { return a.viewport == b.viewport; }},
    {"depth_range", read_depth_range, write_depth_range,
     [](const State& a, const State& b) { return a.depth_range == b.depth_range; }},
    choice<&State::provoking, provoking_names, provoking>(),
    choice<&State::polygon_mode, polygon_mode_names, polygon_mode>(),
    {"polygon_offset", read_polygon_offset, write_polygon_offset,
     [](const State& a, const State& b) { return a.polygon_offset == b.polygon_offset; }},
    choice<&State::line_rule, line_rule_names, line_rule>(),
    {"line_last", read_line_last, write_line_last,
     [](const State& a, const State& b) { return a.line_last == b.line_last; }},
    {"point_size", read_point_size, write_point_size,
     [](const State& a, const State& b) { return a.point_size == b.point_size; }},
    choice<&State::point_clip, point_clip_names, point_clip>(),
}};

}  // namespace

std::span<const CaptureState> capture_states() { return settings_table; }

const CaptureState& capture_space() { return space_setting; }

}  // namespace halfplane
