// The `state` settings of a capture: one table that the reader, the writer and the messages go by.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "capture_text.hpp"
#include "model/scene.hpp"

namespace halfplane {

/// One setting: how it is named, read, written and compared.
struct CaptureState {
  std::string_view name;
  void (*read)(CaptureText& text, State& state);        ///< takes the values from the line
  void (*write)(const State& state, std::string& out);  ///< appends the values, each after a blank
  bool (*is_same)(const State& a, const State& b);      ///< whether a and b agree in this setting
};

/// All settings of `state` lines, in the order in which they are written.
[[nodiscard]] std::span<const CaptureState> capture_states();

/// `space` has a line of its own; otherwise it is a setting like the others.
[[nodiscard]] const CaptureState& capture_space();

/// How a draw is written: its word, and how many indices it takes.
struct CaptureDraw {
  std::string_view word;
  Topology topology;
  std::string_view primitive;  ///< what one of them is called in messages
  std::size_t least;           ///< indices of one primitive
  bool is_list;                ///< every `least` indices are a primitive of their own; otherwise they share vertices
};

inline constexpr std::array<CaptureDraw, 7> kCaptureDraws{{
    {"t", Topology::triangles, "triangle", 3, true},
    {"ts", Topology::triangle_strip, "triangle", 3, false},
    {"tf", Topology::triangle_fan, "triangle", 3, false},
    {"l", Topology::lines, "line", 2, true},
    {"ll", Topology::line_loop, "line", 2, false},
    {"ls", Topology::line_strip, "line", 2, false},
    {"p", Topology::points, "point", 1, true},
}};

}  // namespace halfplane
