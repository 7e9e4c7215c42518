// The state of OpenGL 1.5, a struct for each attribute group of glPushAttrib (OpenGL 1.5, tables 6.5 to 6.33). The
// initial values are those of the specification. Colours are real numbers as the program gave them, not yet held to 0...1.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <GL/gl.h>
#include <GL/glext.h>

namespace halfplane::gl {

using Vec3 = std::array<double, 3>;
using Vec4 = std::array<double, 4>;

inline constexpr int kTextureUnits = 2;  ///< GL_MAX_TEXTURE_UNITS
inline constexpr int kLights = 8;
inline constexpr int kClipPlanes = 6;
inline constexpr int kLargestTexture = 4096;  ///< texels along a side
inline constexpr int kLargestTexture3D = 256;
inline constexpr int kLargestPoint = 64, kLargestLine = 64;  ///< pixels: limits of sizes and widths
inline constexpr int kEvalOrder = 30;                        ///< GL_MAX_EVAL_ORDER
inline constexpr int kPixelMapTable = 256;                   ///< GL_MAX_PIXEL_MAP_TABLE
inline constexpr int kListNesting = 64;                      ///< GL_MAX_LIST_NESTING
inline constexpr int kAttribDepth = 16;  ///< GL_MAX_ATTRIB_STACK_DEPTH, and that of client attributes
inline constexpr int kNameDepth = 64;    ///< GL_MAX_NAME_STACK_DEPTH
inline constexpr int kModelviewDepth = 32, kProjectionDepth = 4, kTextureDepth = 10;  ///< of matrix stacks
inline constexpr int kLargestViewport = 16384;                                        ///< GL_MAX_VIEWPORT_DIMS

/// The position that glDrawPixels and glBitmap draw at (OpenGL 1.5, 2.13).
struct RasterPosition {
  Vec4 window{0, 0, 0, 1};  ///< x and y in pixels from the bottom left, z in 0...1, clip w
  double distance = 0;      ///< from the eye, for fog
  Vec4 color{1, 1, 1, 1}, secondary{0, 0, 0, 1};
  std::array<Vec4, kTextureUnits> tex_coord;
  bool valid = true;
};

struct CurrentState {  // GL_CURRENT_BIT
  Vec4 color{1, 1, 1, 1}, secondary{0, 0, 0, 1};
  Vec3 normal{0, 0, 1};
  std::array<Vec4, kTextureUnits> tex_coord;
  double fog_coord = 0, index = 1;
  bool edge_flag = true;
  RasterPosition raster;
  CurrentState() {
    tex_coord.fill({0, 0, 0, 1});
    raster.tex_coord = tex_coord;
  }
};

struct PointState {  // GL_POINT_BIT
  double size = 1, least = 0, largest = 1e6, fade = 1;
  Vec3 attenuation{1, 0, 0};  ///< 1 / sqrt(a + b d + c d^2) multiplies the size
  bool smooth = false, sprite = false;
};

struct LineState {  // GL_LINE_BIT
  double width = 1;
  bool smooth = false, stipple = false;
  int stipple_factor = 1;
  std::uint16_t stipple_pattern = 0xffff;
};

struct PolygonState {  // GL_POLYGON_BIT
  bool cull = false, smooth = false, stipple = false;
  bool offset_point = false, offset_line = false, offset_fill = false;
  GLenum cull_face = GL_BACK, front_face = GL_CCW;
  std::array<GLenum, 2> mode{GL_FILL, GL_FILL};  ///< of front and back
  double offset_factor = 0, offset_units = 0;
};

struct StippleState {                 // GL_POLYGON_STIPPLE_BIT
  std::array<std::uint32_t, 32> row;  ///< row 0 at the bottom, the leftmost pixel the highest bit
  StippleState() { row.fill(0xffffffff); }
};

struct Light {
  Vec4 ambient{0, 0, 0, 1}, diffuse{0, 0, 0, 1}, specular{0, 0, 0, 1};
  Vec4 position{0, 0, 1, 0};      ///< eye space
  Vec3 spot_direction{0, 0, -1};  ///< eye space
  double spot_exponent = 0, spot_cutoff = 180;
  Vec3 attenuation{1, 0, 0};  ///< constant, linear, quadratic
};

struct Material {
  Vec4 ambient{0.2, 0.2, 0.2, 1}, diffuse{0.8, 0.8, 0.8, 1}, specular{0, 0, 0, 1}, emission{0, 0, 0, 1};
  double shininess = 0;
  Vec3 indexes{0, 1, 1};
};

struct LightingState {  // GL_LIGHTING_BIT
  bool enabled = false, two_side = false, local_viewer = false, color_material = false;
  GLenum color_control = GL_SINGLE_COLOR;
  GLenum color_material_face = GL_FRONT_AND_BACK, color_material_mode = GL_AMBIENT_AND_DIFFUSE;
  GLenum shade_model = GL_SMOOTH;
  Vec4 model_ambient{0.2, 0.2, 0.2, 1};
  std::array<Light, kLights> light;
  std::array<bool, kLights> light_enabled{};
  std::array<Material, 2> material;  ///< front, back
  LightingState() { light[0].diffuse = light[0].specular = {1, 1, 1, 1}; }
};

struct FogState {  // GL_FOG_BIT
  bool enabled = false, color_sum = false;
  GLenum mode = GL_EXP, coord_source = GL_FRAGMENT_DEPTH;
  double density = 1, start = 0, end = 1, index = 0;
  Vec4 color{0, 0, 0, 0};
};

struct DepthState {  // GL_DEPTH_BUFFER_BIT
  bool test = false, write = true;
  GLenum func = GL_LESS;
  double clear = 1;
};

struct StencilState {  // GL_STENCIL_BUFFER_BIT
  bool test = false;
  GLenum func = GL_ALWAYS, fail = GL_KEEP, depth_fail = GL_KEEP, depth_pass = GL_KEEP;
  int reference = 0, clear = 0;
  std::uint32_t value_mask = ~0U, write_mask = ~0U;
};

struct ViewportState {  // GL_VIEWPORT_BIT
  int x = 0, y = 0, width = 0, height = 0;
  double near = 0, far = 1;
};

struct ScissorState {  // GL_SCISSOR_BIT
  bool test = false;
  int x = 0, y = 0, width = 0, height = 0;
};

struct TransformState {  // GL_TRANSFORM_BIT
  GLenum matrix_mode = GL_MODELVIEW;
  bool normalize = false, rescale_normal = false;
  std::array<bool, kClipPlanes> clip_enabled{};
  std::array<Vec4, kClipPlanes> clip_plane{};  ///< eye space
};

struct ColorState {  // GL_COLOR_BUFFER_BIT
  bool alpha_test = false, blend = false, logic_op = false, index_logic_op = false, dither = true;
  GLenum alpha_func = GL_ALWAYS;
  double alpha_reference = 0;
  GLenum src_rgb = GL_ONE, dst_rgb = GL_ZERO, src_alpha = GL_ONE, dst_alpha = GL_ZERO;
  GLenum equation = GL_FUNC_ADD;
  Vec4 blend_color{0, 0, 0, 0}, clear{0, 0, 0, 0};
  GLenum logic_func = GL_COPY, draw_buffer = GL_BACK;
  std::array<bool, 4> write{true, true, true, true};
  double clear_index = 0;
  std::uint32_t index_write = ~0U;
};

struct AccumState {  // GL_ACCUM_BUFFER_BIT
  Vec4 clear{0, 0, 0, 0};
};

/// Targets of glHint.
inline constexpr std::array<GLenum, 7> kHints{
    GL_PERSPECTIVE_CORRECTION_HINT, GL_POINT_SMOOTH_HINT, GL_LINE_SMOOTH_HINT,
    GL_POLYGON_SMOOTH_HINT,         GL_FOG_HINT,          GL_GENERATE_MIPMAP_HINT,
    GL_TEXTURE_COMPRESSION_HINT};
struct HintState : std::array<GLenum, kHints.size()> {  // GL_HINT_BIT
  HintState() { fill(GL_DONT_CARE); }
};

struct MultisampleState {  // GL_MULTISAMPLE_BIT
  bool enabled = true, alpha_to_coverage = false, alpha_to_one = false, coverage = false, invert = false;
  double value = 1;
};

struct EvalState {  // GL_EVAL_BIT; the maps themselves are Context::maps
  bool auto_normal = false;
  std::array<bool, 9> map1{}, map2{};  ///< from GL_MAP1_COLOR_4 and GL_MAP2_COLOR_4 on
  int grid1 = 1;
  std::array<int, 2> grid2{1, 1};
  std::array<double, 2> range1{0, 1};
  std::array<double, 4> range2{0, 1, 0, 1};
};

struct ListState {  // GL_LIST_BIT
  GLuint base = 0;
};

struct PixelState {  // GL_PIXEL_MODE_BIT; the tables of glPixelMap are Context::pixel_maps
  Vec4 scale{1, 1, 1, 1}, bias{0, 0, 0, 0};
  double depth_scale = 1, depth_bias = 0, zoom_x = 1, zoom_y = 1;
  int index_shift = 0, index_offset = 0;
  bool map_color = false, map_stencil = false;
  GLenum read_buffer = GL_BACK;
};

struct TexGen {
  bool enabled = false;
  GLenum mode = GL_EYE_LINEAR;
  Vec4 object{}, eye{};  ///< planes
};

/// GL_COMBINE (OpenGL 1.5, 3.8.13): of RGB and of alpha.
struct TextureCombiner {
  GLenum function = GL_MODULATE;
  std::array<GLenum, 3> source{GL_TEXTURE, GL_PREVIOUS, GL_CONSTANT};
  std::array<GLenum, 3> operand{};
  double scale = 1;
};

inline constexpr std::array<GLenum, 4> kTextureTargets{GL_TEXTURE_1D, GL_TEXTURE_2D, GL_TEXTURE_3D,
                                                       GL_TEXTURE_CUBE_MAP};

struct TextureUnit {
  std::array<bool, 4> enabled{};  ///< by kTextureTargets, the last one counts
  std::array<GLuint, 4> bound{};  ///< names of textures, 0 the default one
  GLenum env_mode = GL_MODULATE;
  Vec4 env_color{0, 0, 0, 0};
  double lod_bias = 0;
  bool coord_replace = false;              ///< of point sprites
  std::array<TextureCombiner, 2> combine;  ///< RGB, alpha
  std::array<TexGen, 4> gen;               ///< s, t, r, q
  TextureUnit() {
    combine[0].operand = {GL_SRC_COLOR, GL_SRC_COLOR, GL_SRC_ALPHA};
    combine[1].operand = {GL_SRC_ALPHA, GL_SRC_ALPHA, GL_SRC_ALPHA};
    gen[0].object = gen[0].eye = {1, 0, 0, 0};
    gen[1].object = gen[1].eye = {0, 1, 0, 0};
  }
};

struct TextureState {  // GL_TEXTURE_BIT
  int active = 0;
  std::array<TextureUnit, kTextureUnits> unit;
};

/// Everything that glPushAttrib can save. Plain values: a copy is a snapshot.
struct State {
  CurrentState current;
  PointState point;
  LineState line;
  PolygonState polygon;
  StippleState stipple;
  LightingState lighting;
  FogState fog;
  DepthState depth;
  StencilState stencil;
  ViewportState viewport;
  ScissorState scissor;
  TransformState transform;
  ColorState color;
  AccumState accum;
  HintState hint;
  MultisampleState multisample;
  EvalState eval;
  ListState list;
  PixelState pixel;
  TextureState texture;
};

/// One of glPixelStore's two sets (OpenGL 1.5, table 3.1).
struct PixelStore {
  bool swap_bytes = false, lsb_first = false;
  int row_length = 0, image_height = 0, skip_rows = 0, skip_pixels = 0, skip_images = 0, alignment = 4;
};

/// Vertex arrays. Those of texture coordinates come last, one for each unit.
enum class Array { vertex, normal, color, secondary_color, index, edge_flag, fog_coord, point_size, tex_coord };
inline constexpr std::size_t kArrayKinds = static_cast<std::size_t>(Array::tex_coord) + 1,
                             kArrays = kArrayKinds - 1 + kTextureUnits;

struct ArrayPointer {
  bool enabled = false;
  int size = 4;
  GLenum type = GL_FLOAT;
  GLsizei stride = 0;
  const void* pointer = nullptr;  ///< an offset where `buffer` is not 0
  GLuint buffer = 0;
};

/// Everything that glPushClientAttrib can save.
struct ClientState {
  PixelStore pack, unpack;
  std::array<ArrayPointer, kArrays> array;  ///< by Array, texture coordinates unit by unit
  int active_texture = 0;
  GLuint array_buffer = 0, element_buffer = 0;
  ClientState();  // arrays.cpp
};

}  // namespace halfplane::gl
