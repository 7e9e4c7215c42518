// GL_OES_draw_texture: a rectangle of the window with the crop rectangle of the texture.
#include <algorithm>
#include <array>

#include "commands.hpp"
#include "primitive.hpp"
#include "texture.hpp"

namespace halfplane::gl {

void draw_tex(Context& context, double x, double y, double z, double width, double height) {
  if (!(width > 0 && height > 0)) return context.fail(GL_INVALID_VALUE);
  if (context.drawable == nullptr || context.render_mode != GL_RENDER) return;
  const State saved = context.state;
  const ViewportState& view = saved.viewport;
  const double depth = view.near + std::clamp(z, 0.0, 1.0) * (view.far - view.near);

  ShadedVertex vertex;
  vertex.color.fill(saved.current.color);
  vertex.fog_distance = saved.current.fog_coord;
  std::array<ShadedVertex, 4> corners;
  const Frame& frame = context.drawable->frame;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double right = i == 1 || i == 2 ? 1 : 0, up = i >= 2 ? 1 : 0;
    vertex.clip = {2 * (x + right * width) / frame.width() - 1, 2 * (y + up * height) / frame.height() - 1,
                   2 * depth - 1, 1};
    for (int unit = 0; unit < kTextureUnits; ++unit)
      if (const TextureObject* texture = sampled_texture(context, unit)) {
        const TextureImage& image = texture->face[0][static_cast<std::size_t>(texture->base_level)];
        const auto& [u, v, columns, rows] = texture->crop;
        vertex.tex_coord[static_cast<std::size_t>(unit)] = {(u + right * columns) / image.width,
                                                            (v + up * rows) / image.height, 0, 1};
      }
    corners[i] = vertex;
  }

  // In a viewport of the whole window, without the states of polygons that do not apply here.
  context.state.viewport = {0, 0, frame.width(), frame.height(), 0, 1};
  context.state.polygon = {};
  context.state.transform.clip_enabled = {};
  ++context.revision;
  constexpr std::array<std::uint32_t, 4> kCorners{0, 1, 2, 3};
  draw_primitives(context, GL_TRIANGLE_FAN, ShadedVertices(corners), kCorners);
  context.state = saved;
  ++context.revision;
}

}  // namespace halfplane::gl
