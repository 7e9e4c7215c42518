// The draw states of a capture, read and written by their table (model/draw_states.hpp); and its words for draws.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "../draw_states.hpp"
#include "../scene.hpp"
#include "capture_text.hpp"

namespace halfplane {

/// Reads the value of `row` from the line into `state`; names of textures are looked up in `textures`. `space` has a line
/// of its own, the others stand on `state` lines.
void read_state_value(CaptureText& text, const DrawState& row, std::span<const Texture> textures, State& state);

/// Appends the value of `row`, each of its words, numbers and names after a blank.
void write_state_value(const State& state, const DrawState& row, std::span<const Texture> textures, std::string& out);

/// The rows that `state` lines may name: all except `space`, in the order in which they are written.
[[nodiscard]] std::span<const DrawState> capture_states();

/// The row of `space`.
[[nodiscard]] const DrawState& capture_space();

/// The written form of a draw: its word, and its number of indices.
struct CaptureDraw {
  std::string_view word;
  Topology topology;
  std::string_view primitive;  ///< name of one of them in messages
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
