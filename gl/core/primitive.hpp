// From shaded vertices to draws of the model (primitive.cpp, feedback.cpp, hardware_state.cpp).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "../../model/scene.hpp"
#include "texture.hpp"
#include "vertices.hpp"

namespace halfplane::gl {

struct Context;

/// Draws glBegin(mode) with vertices[indices[0]], vertices[indices[1]], ...: clip planes, two-sided light, polygon
/// modes, stipples, selection and feedback; then Frame::draw in the state of the context.
void draw_primitives(Context& context, GLenum mode, const ShadedVertices& vertices,
                     std::span<const std::uint32_t> indices);
/// Likewise with vertices that are shaded here, but for those of Context::shaded, and have `values` where they do not vary.
/// Precondition: update_shading().
void draw_vertices(Context& context, GLenum mode, const InputVertices& vertices, const InputVertices::Values& values,
                   std::span<const std::uint32_t> indices);
/// What glBegin(mode), the vertices and glEnd do together. Precondition: vertices.is_complete(), outside glBegin and glEnd.
void draw_joined(Context& context, GLenum mode, const InputVertices& vertices, std::span<const std::uint32_t> indices);

/// Pixels of the window as points, for glBitmap and pixels without a faster way: x and y from the bottom left, the centre of a
/// pixel at one half, with z in 0...1 and colours in 0...1. They pass fog, for which w is the distance, and the fragment
/// operations of the context's state, but no texture.
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

/// The model's state of what the context's state says, but for textures (use_texture()). None: nothing can be drawn (a face
/// culled away, no buffer). Says by Frame::missing() what the model does not have.
[[nodiscard]] std::optional<halfplane::State> hardware_state(Context& context, DrawKind kind);
/// Whether the model's numbers reach this fog.
[[nodiscard]] bool has_hardware_fog(const FogState& fog);
/// As hardware_state(), for a clear: scissor and masks.
[[nodiscard]] halfplane::State clear_state(Context& context);
/// State for pixels that the host writes: in the window, without tests, depth and stencil.
[[nodiscard]] halfplane::State all_pixels();
/// Fills the target in such a state, colours 0...255.
void fill_target(Context& context, const halfplane::State& state, const std::array<double, 4>& rgba);
/// Draws in the state as it is, but for the logic operation, which may change the vertices' colours.
void draw_in(Context& context, halfplane::State state, Topology topology, std::span<Vertex> vertices,
             std::span<const std::uint32_t> indices);
/// Draws texels, one for each pixel from (x, y) on, in a state of space window. Culling and texture are set here.
void draw_image(Context& context, const halfplane::State& state, const TexelImage& image, int x, int y, double z = 0,
                double w = 1);

/// In selection and feedback: takes a point, a line or a polygon after clipping, `clip` in window coordinates as
/// RasterPosition::window and colours in the first place. `token`: GL_POINT_TOKEN, GL_LINE_TOKEN, ...
void feed_primitive(Context& context, GLenum token, std::span<const ShadedVertex> vertices);
/// Likewise the raster position of glBitmap, glDrawPixels and glCopyPixels (GL_BITMAP_TOKEN, ...). Whether the command is
/// thereby done; false in GL_RENDER.
bool feed_raster(Context& context, GLenum token);
/// In GL_SELECT: something at the depth z (0...1) is inside the view volume. A valid glRasterPos is.
void hit(Context& context, double z);

}  // namespace halfplane::gl
