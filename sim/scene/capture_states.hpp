// The `state` settings of a capture: one table that the reader, the writer and the messages go by.
#pragma once

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

/// Whether `name` is a setting of the format that this version does not draw.
[[nodiscard]] bool is_later_state(std::string_view name);

}  // namespace halfplane
