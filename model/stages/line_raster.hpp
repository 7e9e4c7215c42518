// Line raster: a LineSetup in, one pixel of the line out per cycle, from start to end.
//
// The registers of LineState are all that changes along a line; the next state is one addition per register, two of
// them chosen by the sign of the error. Depth and colour live modulo 2^(bits + G'): inside the line the true value
// fits, with one half LSB already added, so that a code is the register's upper bits: no rounding, no clamp.
#pragma once

#include "line_setup.hpp"

namespace halfplane {

/// What a unit holds while it draws a line.
struct LineState {
  std::int32_t x = 0, y = 0;             ///< Widths::pixel_x, pixel_y
  std::int64_t error = 0;                ///< Widths::line_error
  std::uint32_t remaining = 0;           ///< Widths::line_count; 0: this is the last pixel
  std::uint8_t is_before_start = 0;      ///< 1 at most at the first pixel
  std::uint64_t depth = 0;               ///< Widths::line_depth
  std::array<std::uint64_t, 4> color{};  ///< Widths::line_color
};

/// line_raster -> primitive_join: one covered pixel.
struct LinePixel {
  std::uint32_t primitive_id = 0;
  std::int32_t x = 0, y = 0;
  std::uint8_t is_last = 0;  ///< 1: the line ends here
  std::uint32_t depth = 0;   ///< code
  std::uint32_t color = 0;   ///< 8 bits a stored channel, R lowest
  bool operator==(const LinePixel&) const = default;

  static constexpr std::string_view name = "line_pixel";
  static constexpr auto fields() {
    using P = LinePixel;
    return std::tuple{Field{"primitive_id", &P::primitive_id, &Widths::primitive_id},
                      Field{"x", &P::x, &Widths::pixel_x},
                      Field{"y", &P::y, &Widths::pixel_y},
                      Field{"is_last", &P::is_last, &Widths::flag},
                      Field{"depth", &P::depth, &Widths::depth_code},
                      Field{"color", &P::color, &Widths::vertex_color}};
  }
};

/// The registers after a line was taken.
[[nodiscard]] inline LineState first_state(const LineSetup& line) {
  return {line.x, line.y, line.error, line.remaining, line.is_before_start, line.depth, line.color};
}

/// The pixel that the registers stand for.
[[nodiscard]] inline LinePixel pixel_of(const LineState& state, const LineSetup& line, const Widths& widths) {
  LinePixel pixel{line.primitive_id, state.x,         state.y, static_cast<std::uint8_t>(state.remaining == 0),
                  line.depth_start,  line.color_start};
  if (state.is_before_start != 0) return pixel;
  pixel.depth = static_cast<std::uint32_t>(state.depth >> widths.line_guard_bits);
  pixel.color = 0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(widths.color_channels); ++c)
    pixel.color |= static_cast<std::uint32_t>(state.color[c] >> widths.line_guard_bits) << 8 * c;
  return pixel;
}

/// The registers one cycle later. Precondition: state.remaining > 0.
[[nodiscard]] inline LineState next_state(const LineState& state, const LineSetup& line, const Widths& widths) {
  const bool moves = state.error >= 0;
  LineState next;
  next.x = state.x + (line.is_x_major != 0 || moves ? (line.is_x_negative != 0 ? -1 : 1) : 0);
  next.y = state.y + (line.is_x_major == 0 || moves ? (line.is_y_negative != 0 ? -1 : 1) : 0);
  next.error = state.error + (moves ? line.step_move : line.step_stay);
  next.remaining = state.remaining - 1;
  next.depth = wrap_unsigned(state.depth + line.depth_step, widths.line_depth.bits);
  for (std::size_t c = 0; c < 4; ++c)
    next.color[c] = wrap_unsigned(state.color[c] + line.color_step[c], widths.line_color.bits);
  return next;
}

/// The stage: calls emit(LinePixel) from the first pixel to the last.
template <class Emit>
void line_raster(const LineSetup& line, const Widths& widths, Emit&& emit) {
  LineState state = first_state(line);
  for (; state.remaining != 0; state = next_state(state, line, widths)) emit(pixel_of(state, line, widths));
  emit(pixel_of(state, line, widths));
}

}  // namespace halfplane
