// Line raster: a LineSetup in, one pixel of the line out per cycle, from start to end.
//
// The registers of LineState hold all that changes along a line; the next state is one addition per register, two with
// steps chosen by the sign of the error. Depth and colour are held modulo 2^(bits + G'): inside the line the true value
// fits, with one half LSB already added, so that a code is the register's upper bits: no rounding, no clamp.
#pragma once

#include "../packets/packets.hpp"

namespace halfplane {

/// The state of the unit while it draws a line.
struct LineState {
  std::int32_t x = 0, y = 0;        ///< Widths::pixel_x, pixel_y
  std::int64_t error = 0;           ///< Widths::line_error
  std::uint32_t remaining = 0;      ///< Widths::line_count; 0: this is the last pixel
  bool is_before_start = false;     ///< at most at the first pixel
  PerPlane<std::uint64_t> value{};  ///< AttributeWidths::line
};

/// The registers after a line was taken.
[[nodiscard]] inline LineState first_state(const LineSetup& line) {
  return {line.x, line.y, line.error, line.remaining, line.is_before_start, line.value};
}

/// The pixel described by the registers.
[[nodiscard]] inline LinePixel pixel_of(const LineState& state, const LineSetup& line, const Widths& widths) {
  LinePixel pixel{line.primitive_id, state.x, state.y, state.remaining == 0, {}};
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p)
    pixel.code[p] =
        state.is_before_start ? line.start[p] : static_cast<std::uint32_t>(state.value[p] >> widths.line_guard_bits);
  return pixel;
}

/// The registers one cycle later. Precondition: state.remaining > 0.
inline void advance(LineState& state, const LineSetup& line, const Widths& widths) {
  const bool moves = state.error >= 0;
  state.x += line.is_x_major || moves ? (line.is_x_negative ? -1 : 1) : 0;
  state.y += !line.is_x_major || moves ? (line.is_y_negative ? -1 : 1) : 0;
  state.error += moves ? line.step_move : line.step_stay;
  --state.remaining;
  state.is_before_start = false;
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p)
    state.value[p] = (state.value[p] + line.step[p]) & widths.line_mask[p];
}

/// The stage: calls emit(LinePixel) from the first pixel to the last.
template <class Emit>
void line_raster(const LineSetup& line, const Widths& widths, Emit&& emit) {
  LineState state = first_state(line);
  for (; state.remaining != 0; advance(state, line, widths)) emit(pixel_of(state, line, widths));
  emit(pixel_of(state, line, widths));
}

}  // namespace halfplane
