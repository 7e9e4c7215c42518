// From shaded vertices to draws of the model (primitive.cpp, feedback.cpp, hardware_state.cpp).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "../../model/scene.hpp"
#include "shade.hpp"

namespace halfplane::gl {

struct Context;

/// Draws what glBegin(mode) makes of vertices[indices[0]], vertices[indices[1]], ...: clip planes, two-sided light, polygon
/// modes, stipples, selection and feedback; then Frame::draw in the state of the context.
void draw_primitives(Context& context, GLenum mode, std::span<const ShadedVertex> vertices,
                     std::span<const std::uint32_t> indices);

/// Pixels of the window as points, for glBitmap and what has no better way: x and y from the bottom left, the centre of a
/// pixel at one half, with z in 0...1 and colours in 0...1. They pass the fragment operations of the context's state.
struct WindowFragment {
  int x = 0, y = 0;
  double z = 0, w = 1;
  Vec4 color{};
};
void draw_fragments(Context& context, std::span<const WindowFragment> fragments);

/// A rectangle of texels drawn to the window, texel (i, j) to the pixels of its zoomed square, for glDrawPixels: through the
/// fragment operations, without the context's texture. `x` and `y` from the bottom left; zoom as glPixelZoom.
void draw_rectangle(Context& context, const halfplane::Texture& texels, double x, double y, double zoom_x,
                    double zoom_y, double z, double w);

enum class DrawKind { triangles, lines, points, rectangle };

/// The model's state of what the context's state says. None: nothing can be drawn (a face culled away, no buffer).
/// Says by Frame::missing() what the model does not have.
[[nodiscard]] std::optional<halfplane::State> hardware_state(Context& context, DrawKind kind);
/// As hardware_state(), for a clear: scissor and masks.
[[nodiscard]] halfplane::State clear_state(Context& context);

}  // namespace halfplane::gl
