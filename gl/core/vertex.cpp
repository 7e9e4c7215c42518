// Vertices between glBegin and glEnd, their attributes, and the state of points, lines and polygons (OpenGL 1.5, 2.6, 2.7,
// 2.10, 2.13, 3.3 to 3.5).

#include "matrix.hpp"
#include "parameter.hpp"
#include "primitive.hpp"
#include "shading.hpp"

namespace halfplane::gl {
namespace {

/// Sets a size, or GL_INVALID_VALUE for one that is not positive.
void set_size(Context& context, double& where, double size) {
  if (!(size > 0)) return context.fail(GL_INVALID_VALUE);
  where = size;
}

bool is_inside(const Context& context, const ShadedVertex& vertex) {
  const auto& [x, y, z, w] = vertex.clip;
  if (!(w > 0 && x >= -w && x <= w && y >= -w && y <= w && z >= -w && z <= w)) return false;
  const TransformState& transform = context.state.transform;
  for (std::size_t i = 0; i < kClipPlanes; ++i) {
    if (!transform.clip_enabled[i]) continue;
    double distance = 0;
    for (std::size_t k = 0; k < 4; ++k) distance += transform.clip_plane[i][k] * vertex.eye[k];
    if (!(distance >= 0)) return false;
  }
  return true;
}

/// Sets an attribute of the next vertices, and says whether there is a primitive that has them.
bool set_attribute(Context& context, Attribute attribute, std::span<const double> value, std::size_t unit = 0) {
  if (context.inside_begin()) context.input.set(attribute, value, unit);
  return context.inside_begin();
}

}  // namespace

void begin(Context& context, GLenum mode) {
  if (context.inside_begin()) return context.fail(GL_INVALID_OPERATION);
  if (mode > GL_POLYGON) return context.fail(GL_INVALID_ENUM);
  update_shading(context);
  context.input.begin(context.state);
  context.shaded.clear();
  context.primitive = mode;
}

void end(Context& context) {
  if (!context.inside_begin()) return context.fail(GL_INVALID_OPERATION);
  const GLenum mode = context.primitive;
  context.primitive = Context::kNoPrimitive;
  draw_vertices(context, mode, context.input, context.input.values(), counting(context.input.size()));
  track_color(context);
}

void draw_joined(Context& context, GLenum mode, const InputVertices& vertices, std::span<const std::uint32_t> indices) {
  update_shading(context);
  context.input.begin(context.state);
  context.shaded.clear();
  draw_vertices(context, mode, vertices, context.input.values(), indices);
  vertices.store(context.state);
  track_color(context);
}

void vertex(Context& context, double x, double y, double z, double w) {
  if (context.inside_begin()) context.input.add({x, y, z, w});
}

void normal(Context& context, double x, double y, double z) {
  context.state.current.normal = {x, y, z};
  set_attribute(context, Attribute::normal, context.state.current.normal);
}

void color(Context& context, double r, double g, double b, double a) {
  context.state.current.color = {r, g, b, a};
  if (!set_attribute(context, Attribute::color, context.state.current.color)) track_color(context);
}

void secondary_color(Context& context, double r, double g, double b) {
  context.state.current.secondary = {r, g, b, 1};
  set_attribute(context, Attribute::secondary, std::array{r, g, b});
}

void index(Context& context, double value) { context.state.current.index = value; }

void tex_coord(Context& context, GLenum unit, double s, double t, double r, double q) {
  if (unit < GL_TEXTURE0 || unit >= GL_TEXTURE0 + kTextureUnits) return context.fail(GL_INVALID_ENUM);
  Vec4& current = context.state.current.tex_coord[unit - GL_TEXTURE0];
  current = {s, t, r, q};
  set_attribute(context, Attribute::tex_coord, current, unit - GL_TEXTURE0);
}

void fog_coord(Context& context, double value) {
  context.state.current.fog_coord = value;
  set_attribute(context, Attribute::fog_coord, std::array{value});
}

void edge_flag(Context& context, GLboolean flag) {
  context.state.current.edge_flag = flag != GL_FALSE;
  set_attribute(context, Attribute::edge_flag, std::array{flag != GL_FALSE ? 1.0 : 0.0});
}

void rect(Context& context, double x1, double y1, double x2, double y2) {
  begin(context, GL_POLYGON);
  vertex(context, x1, y1, 0, 1);
  vertex(context, x2, y1, 0, 1);
  vertex(context, x2, y2, 0, 1);
  vertex(context, x1, y2, 0, 1);
  end(context);
}

void raster_pos(Context& context, double x, double y, double z, double w) {
  update_shading(context);
  InputVertices given;
  given.begin(context.state);
  given.add({x, y, z, w});
  ShadedVertices shaded;
  place_vertices(context, given, shaded);
  finish_vertices(context, given, given.values(), shaded, true);
  const ShadedVertex vertex = shaded[0];
  RasterPosition& raster = context.state.current.raster;
  raster.valid = is_inside(context, vertex);
  if (!raster.valid) return;
  const ViewportState& viewport = context.state.viewport;
  const double clip_w = vertex.clip[3];
  raster.window = {viewport.x + (vertex.clip[0] / clip_w + 1) / 2 * viewport.width,
                   viewport.y + (vertex.clip[1] / clip_w + 1) / 2 * viewport.height,
                   viewport.near + (vertex.clip[2] / clip_w + 1) / 2 * (viewport.far - viewport.near), clip_w};
  raster.distance = vertex.fog_distance;
  raster.color = vertex.color[0];
  raster.secondary = vertex.secondary[0];
  raster.tex_coord = vertex.tex_coord;
  hit(context, raster.window[2]);
}

void window_pos(Context& context, double x, double y, double z) {
  const ViewportState& viewport = context.state.viewport;
  CurrentState& current = context.state.current;
  RasterPosition& raster = current.raster;
  raster.valid = true;
  raster.window = {x, y, viewport.near + held(z) * (viewport.far - viewport.near), 1};
  raster.distance = context.state.fog.coord_source == GL_FOG_COORDINATE ? current.fog_coord : 0;
  // Not lit: the current attributes unchanged.
  raster.color = held_color(current.color);
  raster.secondary = {};
  if (context.state.fog.color_sum)
    for (std::size_t i = 0; i < 3; ++i) raster.secondary[i] = held(current.secondary[i]);
  raster.tex_coord = current.tex_coord;
  hit(context, raster.window[2]);
}

void shade_model(Context& context, GLenum mode) {
  set_enum(context, context.state.lighting.shade_model, mode, {GL_FLAT, GL_SMOOTH});
}

void front_face(Context& context, GLenum mode) {
  set_enum(context, context.state.polygon.front_face, mode, {GL_CW, GL_CCW});
}

void cull_face(Context& context, GLenum face) {
  set_enum(context, context.state.polygon.cull_face, face, {GL_FRONT, GL_BACK, GL_FRONT_AND_BACK});
}

void point_size(Context& context, double size) { set_size(context, context.state.point.size, size); }

std::optional<Place> point_place(PointState& point, GLenum pname) {
  switch (pname) {
    case GL_POINT_SIZE_MIN: return Place{.where = &point.least, .low = 0};
    case GL_POINT_SIZE_MAX: return Place{.where = &point.largest, .low = 0};
    case GL_POINT_FADE_THRESHOLD_SIZE: return Place{.where = &point.fade, .low = 0};
    case GL_POINT_DISTANCE_ATTENUATION: return Place{&point.attenuation};
    default: return std::nullopt;
  }
}

void point_parameter(Context& context, GLenum pname, Params params) {
  set_parameter(context, point_place(context.state.point, pname), params);
}

void line_width(Context& context, double width) { set_size(context, context.state.line.width, width); }

void line_stipple(Context& context, GLint factor, GLushort pattern) {
  context.state.line.stipple_factor = std::clamp(factor, 1, 256);
  context.state.line.stipple_pattern = pattern;
}

void polygon_mode(Context& context, GLenum face, GLenum mode) {
  GLenum checked = 0, checked_face = 0;
  set_enum(context, checked, mode, {GL_POINT, GL_LINE, GL_FILL});
  set_enum(context, checked_face, face, {GL_FRONT, GL_BACK, GL_FRONT_AND_BACK});
  if (checked == 0 || checked_face == 0) return;
  if (face != GL_BACK) context.state.polygon.mode[0] = mode;
  if (face != GL_FRONT) context.state.polygon.mode[1] = mode;
}

void polygon_offset(Context& context, double factor, double units) {
  context.state.polygon.offset_factor = factor;
  context.state.polygon.offset_units = units;
}

void polygon_stipple(Context& context, std::array<std::uint32_t, 32> rows) { context.state.stipple.row = rows; }

}  // namespace halfplane::gl
