// Every command of OpenGL 1.5, once for all its variants: coordinates are doubles, colours are doubles with 1 as the largest
// integer, arrays of a known length are arrays. Entry points (entry_points.cpp) convert to these. Each takes the context that
// it works on and reports errors by Context::fail(), as the specification has them. "List": commands of display lists;
// the others are carried out at once (OpenGL 1.5, 5.4).
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "context.hpp"
#include "image.hpp"

namespace halfplane::gl {

/// Values of glLight, glMaterial, glFog, ...: of a variant with v up to four, else one. Integers are as they were given
/// (`is_integer`): where they mean colours, color_of() maps them linearly as table 2.6 says.
struct Params {
  Vec4 value{};
  bool is_integer = false, is_vector = false;
};
[[nodiscard]] Vec4 color_of(const Params& params);  // light.cpp
/// Values that `pname` takes in the v variants of light, material, fog, ...: 1, 3 or 4; 1 for unknown names (parameter.cpp).
[[nodiscard]] std::size_t param_count(GLenum pname);
/// Whether they are enums, booleans or whole numbers, which OpenGL ES does not scale in its x variants.
[[nodiscard]] bool is_unscaled(GLenum pname);

// Vertices and attributes: list, allowed between glBegin and glEnd (vertex.cpp).
void begin(Context&, GLenum mode);
void end(Context&);
void vertex(Context&, double x, double y, double z, double w);
void normal(Context&, double x, double y, double z);
void color(Context&, double r, double g, double b, double a);
void secondary_color(Context&, double r, double g, double b);
void index(Context&, double value);
void tex_coord(Context&, GLenum unit, double s, double t, double r, double q);  // unit: GL_TEXTURE0...
void fog_coord(Context&, double value);
void edge_flag(Context&, GLboolean flag);
void material(Context&, GLenum face, GLenum pname, Params params);
void eval_coord1(Context&, double u);
void eval_coord2(Context&, double u, double v);
void eval_point1(Context&, GLint i);
void eval_point2(Context&, GLint i, GLint j);

// More list commands (vertex.cpp).
void rect(Context&, double x1, double y1, double x2, double y2);
void raster_pos(Context&, double x, double y, double z, double w);
void window_pos(Context&, double x, double y, double z);
void shade_model(Context&, GLenum mode);
void front_face(Context&, GLenum mode);
void cull_face(Context&, GLenum face);
void point_size(Context&, double size);
void point_parameter(Context&, GLenum pname, Params params);
void line_width(Context&, double width);
void line_stipple(Context&, GLint factor, GLushort pattern);
void polygon_mode(Context&, GLenum face, GLenum mode);
void polygon_offset(Context&, double factor, double units);
void polygon_stipple(Context&, std::array<std::uint32_t, 32> rows);

// Light and fog: list (light.cpp).
void light(Context&, GLenum light, GLenum pname, Params params);
void light_model(Context&, GLenum pname, Params params);
void color_material(Context&, GLenum face, GLenum mode);
/// Copies the current colour to the materials that follow it, if GL_COLOR_MATERIAL is enabled. For color(), enable() and
/// pop_attrib().
void track_color(Context&);
void fog(Context&, GLenum pname, Params params);

// Matrices: list (matrix.cpp).
void matrix_mode(Context&, GLenum mode);
void load_identity(Context&);
void load_matrix(Context&, Mat4 m);
void load_transpose_matrix(Context&, Mat4 m);
void mult_matrix(Context&, Mat4 m);
void mult_transpose_matrix(Context&, Mat4 m);
void push_matrix(Context&);
void pop_matrix(Context&);
void rotate(Context&, double degrees, double x, double y, double z);
void scale(Context&, double x, double y, double z);
void translate(Context&, double x, double y, double z);
void frustum(Context&, double left, double right, double bottom, double top, double near, double far);
void ortho(Context&, double left, double right, double bottom, double top, double near, double far);
void viewport(Context&, GLint x, GLint y, GLsizei width, GLsizei height);
void depth_range(Context&, double near, double far);
void clip_plane(Context&, GLenum plane, Vec4 equation);

// Vertex arrays (arrays.cpp). Pointers and enables are not list; draws and array_element are, and read the arrays when they
// are compiled.
void array_pointer(Context&, Array which, GLint size, GLenum type, GLsizei stride, const void* pointer);
void interleaved_arrays(Context&, GLenum format, GLsizei stride, const void* pointer);
void client_state(Context&, GLenum array, bool enabled);
void client_active_texture(Context&, GLenum unit);
void array_element(Context&, GLint i);
void draw_arrays(Context&, GLenum mode, GLint first, GLsizei count);
void draw_elements(Context&, GLenum mode, GLsizei count, GLenum type, const void* indices);
void draw_range_elements(Context&, GLenum mode, GLuint start, GLuint end, GLsizei count, GLenum type,
                         const void* indices);
void multi_draw_arrays(Context&, GLenum mode, const GLint* first, const GLsizei* count, GLsizei draws);
void multi_draw_elements(Context&, GLenum mode, const GLsizei* count, GLenum type, const void* const* indices,
                         GLsizei draws);

// Buffer objects and queries: not list (arrays.cpp).
void bind_buffer(Context&, GLenum target, GLuint name);
void delete_buffers(Context&, GLsizei n, const GLuint* names);
void gen_buffers(Context&, GLsizei n, GLuint* names);
GLboolean is_buffer(Context&, GLuint name);
void buffer_data(Context&, GLenum target, GLsizeiptr size, const void* data, GLenum usage);
void buffer_sub_data(Context&, GLenum target, GLintptr offset, GLsizeiptr size, const void* data);
void get_buffer_sub_data(Context&, GLenum target, GLintptr offset, GLsizeiptr size, void* data);
void* map_buffer(Context&, GLenum target, GLenum access);
GLboolean unmap_buffer(Context&, GLenum target);
void get_buffer_parameter(Context&, GLenum target, GLenum pname, GLint* params);
void get_buffer_pointer(Context&, GLenum target, GLenum pname, void** params);
void gen_queries(Context&, GLsizei n, GLuint* names);
void delete_queries(Context&, GLsizei n, const GLuint* names);
GLboolean is_query(Context&, GLuint name);
void begin_query(Context&, GLenum target, GLuint name);
void end_query(Context&, GLenum target);
void get_query(Context&, GLenum target, GLenum pname, GLint* params);
void get_query_object(Context&, GLuint name, GLenum pname, GLint* params);

// Evaluators: list (eval.cpp). `points` are packed as EvaluatorMap::point.
void map1(Context&, GLenum target, double u1, double u2, GLint order,
          const std::shared_ptr<const std::vector<double>>& points);
void map2(Context&, GLenum target, double u1, double u2, GLint uorder, double v1, double v2, GLint vorder,
          const std::shared_ptr<const std::vector<double>>& points);
void map_grid1(Context&, GLint n, double u1, double u2);
void map_grid2(Context&, GLint nu, double u1, double u2, GLint nv, double v1, double v2);
void eval_mesh1(Context&, GLenum mode, GLint i1, GLint i2);
void eval_mesh2(Context&, GLenum mode, GLint i1, GLint i2, GLint j1, GLint j2);
/// Numbers of a control point of a map; 0: no map.
[[nodiscard]] int map_components(GLenum target);

// Fragments and framebuffer: list (fragment.cpp).
void enable(Context&, GLenum cap, bool enabled);
void alpha_func(Context&, GLenum func, double reference);
void blend_func_separate(Context&, GLenum src, GLenum dst, GLenum src_alpha, GLenum dst_alpha);
void blend_equation(Context&, GLenum mode);
void blend_color(Context&, double r, double g, double b, double a);
void depth_func(Context&, GLenum func);
void depth_mask(Context&, GLboolean write);
void stencil_func(Context&, GLenum func, GLint reference, GLuint mask);
void stencil_mask(Context&, GLuint mask);
void stencil_op(Context&, GLenum fail, GLenum depth_fail, GLenum depth_pass);
void color_mask(Context&, GLboolean r, GLboolean g, GLboolean b, GLboolean a);
void index_mask(Context&, GLuint mask);
void logic_op(Context&, GLenum op);
void scissor(Context&, GLint x, GLint y, GLsizei width, GLsizei height);
void sample_coverage(Context&, double value, GLboolean invert);
void hint(Context&, GLenum target, GLenum mode);
void draw_buffer(Context&, GLenum mode);
void read_buffer(Context&, GLenum mode);
void follow_draw_buffer(Context&);               ///< the drawable draws where the state says
[[nodiscard]] bool reads_front(const Context&);  ///< of two buffers
void clear(Context&, GLbitfield mask);
void clear_color(Context&, double r, double g, double b, double a);
void clear_depth(Context&, double depth);
void clear_stencil(Context&, GLint value);
void clear_index(Context&, double index);
void clear_accum(Context&, double r, double g, double b, double a);
void accum(Context&, GLenum op, double value);
// Not list.
void finish(Context&);
void flush(Context&);

// Pixels: list but for read_pixels and pixel_store (pixels.cpp). An Image is unpack()'s result when the command was issued.
void draw_pixels(Context&, std::shared_ptr<const Image> image);
void bitmap(Context&, const std::shared_ptr<const Bitmap>& bitmap, double x_origin, double y_origin, double x_move,
            double y_move);
void copy_pixels(Context&, GLint x, GLint y, GLsizei width, GLsizei height, GLenum type);
void read_pixels(Context&, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type, void* pixels);
void draw_tex(Context&, double x, double y, double z, double width, double height);  // embedded.cpp
void pixel_zoom(Context&, double x, double y);
void pixel_transfer(Context&, GLenum pname, double value);
void pixel_map(Context&, GLenum map, const std::shared_ptr<const std::vector<float>>& values);
void pixel_store(Context&, GLenum pname, double value);
/// The pixels of a rectangle of the read drawable as unpack() would give them: GL_RGBA, GL_DEPTH_COMPONENT or
/// GL_STENCIL_INDEX. Outside the window: zeros.
[[nodiscard]] Image read_rectangle(Context&, int x, int y, int width, int height, GLenum format);

// Textures: list where an Image is taken (texture.cpp, texture_state.cpp). glTexImage1D is 2D with a height of 1, and so on:
// `dimensions`.
void tex_image(Context&, int dimensions, GLenum target, GLint level, GLint internal_format, GLsizei width,
               GLsizei height, GLsizei depth, GLint border,
               std::shared_ptr<const Image> image);  // null or without pixels: undefined texels
void tex_sub_image(Context&, int dimensions, GLenum target, GLint level, GLint x, GLint y, GLint z,
                   std::shared_ptr<const Image> image);
void copy_tex_image(Context&, int dimensions, GLenum target, GLint level, GLenum internal_format, GLint x, GLint y,
                    GLsizei width, GLsizei height, GLint border);
void copy_tex_sub_image(Context&, int dimensions, GLenum target, GLint level, GLint xoffset, GLint yoffset,
                        GLint zoffset, GLint x, GLint y, GLsizei width, GLsizei height);
void tex_parameter(Context&, GLenum target, GLenum pname, Params params);
void tex_env(Context&, GLenum target, GLenum pname, Params params);
void tex_gen(Context&, GLenum coord, GLenum pname, Params params);
void active_texture(Context&, GLenum unit);
void bind_texture(Context&, GLenum target, GLuint name);
void prioritize_textures(Context&, const std::shared_ptr<const std::vector<std::pair<GLuint, double>>>& priorities);
// Not list.
void gen_textures(Context&, GLsizei n, GLuint* names);
void delete_textures(Context&, GLsizei n, const GLuint* names);
GLboolean is_texture(Context&, GLuint name);
GLboolean are_textures_resident(Context&, GLsizei n, const GLuint* names, GLboolean* residences);
void get_tex_image(Context&, GLenum target, GLint level, GLenum format, GLenum type, void* pixels);
void compressed_image(Context&);  // glCompressedTex... without a format: GL_INVALID_ENUM

// Lists (list.cpp): call_list and call_lists are list themselves and allowed between glBegin and glEnd.
void new_list(Context&, GLuint name, GLenum mode);
void end_list(Context&);
void call_list(Context&, GLuint name);
void call_lists(Context&, std::shared_ptr<const std::vector<GLuint>> offsets);
void list_base(Context&, GLuint base);  // list
GLuint gen_lists(Context&, GLsizei range);
void delete_lists(Context&, GLuint name, GLsizei range);
GLboolean is_list(Context&, GLuint name);
/// glCallLists' array as numbers; null: an error was issued.
[[nodiscard]] std::shared_ptr<const std::vector<GLuint>> list_names(Context&, GLsizei n, GLenum type,
                                                                    const void* lists);

// Attributes (attributes.cpp): push_attrib and pop_attrib are list.
void push_attrib(Context&, GLbitfield mask);
void pop_attrib(Context&);
void push_client_attrib(Context&, GLbitfield mask);
void pop_client_attrib(Context&);

// Selection and feedback (feedback.cpp): names and pass_through are list.
void init_names(Context&);
void load_name(Context&, GLuint name);
void push_name(Context&, GLuint name);
void pop_name(Context&);
void pass_through(Context&, double token);
GLint set_render_mode(Context&, GLenum mode);
void select_buffer(Context&, GLsizei size, GLuint* buffer);
void feedback_buffer(Context&, GLsizei size, GLenum type, GLfloat* buffer);

// Queries of state: not list (get.cpp, a table; texture.cpp, light.cpp and eval.cpp for their own state). Values come as
// doubles with their kind, and the entry point converts them to the type asked for (OpenGL 1.5, 6.1.2).
enum class ValueKind { boolean, integer, real, color };  ///< color: also normals and depths, 1 is the largest integer
struct Values {
  ValueKind kind = ValueKind::real;
  std::vector<double> value;  ///< empty: the error has been reported
};
[[nodiscard]] Values get(Context&, GLenum pname);
[[nodiscard]] Values get_light(Context&, GLenum light, GLenum pname);
[[nodiscard]] Values get_material(Context&, GLenum face, GLenum pname);
[[nodiscard]] Values get_tex_env(Context&, GLenum target, GLenum pname);
[[nodiscard]] Values get_tex_gen(Context&, GLenum coord, GLenum pname);
[[nodiscard]] Values get_tex_parameter(Context&, GLenum target, GLenum pname);
[[nodiscard]] Values get_tex_level_parameter(Context&, GLenum target, GLint level, GLenum pname);
[[nodiscard]] Values get_map(Context&, GLenum target, GLenum query);
[[nodiscard]] Values get_pixel_map(Context&, GLenum map);
[[nodiscard]] Vec4 get_clip_plane(Context&, GLenum plane);
GLenum get_error(Context&);
const GLubyte* get_string(Context&, GLenum name);
void get_pointer(Context&, GLenum pname, void** params);
void get_polygon_stipple(Context&, GLubyte* mask);
GLboolean is_enabled(Context&, GLenum cap);
/// The place of an enable; null: `cap` is unknown. Of texgen and texture targets: of the active unit.
[[nodiscard]] bool* enable_flag(State&, GLenum cap);
[[nodiscard]] inline bool* enable_flag(Context& context, GLenum cap) { return enable_flag(context.state, cap); }
/// GL_ENABLE_BIT.
void copy_enables(State& to, State from);

}  // namespace halfplane::gl
