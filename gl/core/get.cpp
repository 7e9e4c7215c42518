// Queries of state by tables (OpenGL 1.5, 6.1 and tables 6.5 to 6.35).
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <numeric>
#include <utility>

#include "arrays.hpp"
#include "parameter.hpp"

namespace halfplane::gl {
namespace {

// Properties of a value's type: its kind, and its conversion to doubles.
struct Numbers : Values {
  template <class T>
  requires std::is_arithmetic_v<T> Numbers(T number) : Values{kind_of<T>(), {static_cast<double>(number)}} {}
  template <class T, std::size_t N>
  Numbers(const std::array<T, N>& numbers) : Values{kind_of<T>(), {}} {
    for (const T number : numbers) value.push_back(static_cast<double>(number));
  }

 private:
  template <class T>
  static constexpr ValueKind kind_of() {
    if constexpr (std::is_same_v<T, bool>)
      return ValueKind::boolean;
    else
      return std::is_integral_v<T> ? ValueKind::integer : ValueKind::real;
  }
};

Numbers color_values(Numbers numbers) {
  numbers.kind = ValueKind::color;
  return numbers;
}

Numbers transposed(const Mat4& m) {
  Mat4 rows;
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = m[i % 4 * 4 + i / 4];
  return rows;
}

/// GL_OES_matrix_get: the bits of its floats.
Numbers bits_of(const Mat4& m) {
  std::array<GLint, 16> bits;
  std::ranges::transform(m, bits.begin(), [](double v) { return std::bit_cast<GLint>(static_cast<GLfloat>(v)); });
  return bits;
}

Config config_of(const Context& context) {
  return context.drawable == nullptr ? Config() : context.drawable->frame.options().config;
}
// Red, green, blue, alpha, depth, stencil; zeros without a drawable.
std::array<int, 6> buffer_bits(const Context& context) {
  if (context.drawable == nullptr) return {};
  const Config config = config_of(context);
  const int depth = config.depth_format.bits != 0 ? config.depth_format.bits : config.depth_bits;
  if (config.color_format == ColorFormat::rgb565) return {5, 6, 5, 0, depth, config.stencil_bits};
  return {8, 8, 8, 8, depth, config.stencil_bits};
}
int samples(const Context& context) {
  const int count = config_of(context).msaa_samples;
  return count == 1 ? 0 : count;
}

template <class Rectangle>
Numbers box(const Rectangle& r) {
  return std::array{r.x, r.y, r.width, r.height};
}

GLenum list_mode(const Context& context) {
  if (context.compiling == nullptr) return 0;
  return context.compiles_and_executes ? GL_COMPILE_AND_EXECUTE : GL_COMPILE;
}

// The active unit's one of an array of units.
template <class T>
const T& active(const Context& context, const std::array<T, kTextureUnits>& units) {
  return units[static_cast<std::size_t>(context.state.texture.active)];
}
constexpr std::array<double, 2> kPointSizes{1, kLargestPoint}, kLineWidths{1, kLargestLine};

struct StateValue {
  GLenum pname;
  Numbers (*value)(const Context& c);
};

// In the order of the specification's tables. Enables and arrays have tables of their own.
const StateValue kStateValues[] = {
    // 6.5: current values
    {GL_CURRENT_COLOR, [](const Context& c) { return color_values(c.state.current.color); }},
    {GL_CURRENT_SECONDARY_COLOR, [](const Context& c) { return color_values(c.state.current.secondary); }},
    {GL_CURRENT_INDEX, [](const Context& c) -> Numbers { return c.state.current.index; }},
    {GL_CURRENT_TEXTURE_COORDS, [](const Context& c) -> Numbers { return active(c, c.state.current.tex_coord); }},
    {GL_CURRENT_NORMAL, [](const Context& c) { return color_values(c.state.current.normal); }},
    {GL_CURRENT_FOG_COORD, [](const Context& c) -> Numbers { return c.state.current.fog_coord; }},
    {GL_EDGE_FLAG, [](const Context& c) -> Numbers { return c.state.current.edge_flag; }},
    {GL_CURRENT_RASTER_POSITION, [](const Context& c) -> Numbers { return c.state.current.raster.window; }},
    {GL_CURRENT_RASTER_DISTANCE, [](const Context& c) -> Numbers { return c.state.current.raster.distance; }},
    {GL_CURRENT_RASTER_COLOR, [](const Context& c) { return color_values(c.state.current.raster.color); }},
    {GL_CURRENT_RASTER_SECONDARY_COLOR,
     [](const Context& c) { return color_values(c.state.current.raster.secondary); }},
    {GL_CURRENT_RASTER_INDEX, [](const Context&) -> Numbers { return 1.0; }},
    {GL_CURRENT_RASTER_TEXTURE_COORDS,
     [](const Context& c) -> Numbers { return active(c, c.state.current.raster.tex_coord); }},
    {GL_CURRENT_RASTER_POSITION_VALID, [](const Context& c) -> Numbers { return c.state.current.raster.valid; }},
    // 6.6: arrays
    {GL_CLIENT_ACTIVE_TEXTURE, [](const Context& c) -> Numbers { return GL_TEXTURE0 + c.client.active_texture; }},
    {GL_ARRAY_BUFFER_BINDING, [](const Context& c) -> Numbers { return c.client.array_buffer; }},
    {GL_ELEMENT_ARRAY_BUFFER_BINDING, [](const Context& c) -> Numbers { return c.client.element_buffer; }},
    // 6.7: transformation
    {GL_MATRIX_MODE, [](const Context& c) -> Numbers { return c.state.transform.matrix_mode; }},
    {GL_VIEWPORT, [](const Context& c) -> Numbers { return box(c.state.viewport); }},
    {GL_DEPTH_RANGE,
     [](const Context& c) {
       return color_values(std::array{c.state.viewport.near, c.state.viewport.far});
     }},
    // 6.8 and 6.9: colour, fog, light
    {GL_SHADE_MODEL, [](const Context& c) -> Numbers { return c.state.lighting.shade_model; }},
    {GL_COLOR_MATERIAL_PARAMETER, [](const Context& c) -> Numbers { return c.state.lighting.color_material_mode; }},
    {GL_COLOR_MATERIAL_FACE, [](const Context& c) -> Numbers { return c.state.lighting.color_material_face; }},
    // 6.11 and 6.12: rasterization, multisampling
    {GL_POINT_SIZE, [](const Context& c) -> Numbers { return c.state.point.size; }},
    {GL_LINE_WIDTH, [](const Context& c) -> Numbers { return c.state.line.width; }},
    {GL_LINE_STIPPLE_PATTERN, [](const Context& c) -> Numbers { return c.state.line.stipple_pattern; }},
    {GL_LINE_STIPPLE_REPEAT, [](const Context& c) -> Numbers { return c.state.line.stipple_factor; }},
    {GL_CULL_FACE_MODE, [](const Context& c) -> Numbers { return c.state.polygon.cull_face; }},
    {GL_FRONT_FACE, [](const Context& c) -> Numbers { return c.state.polygon.front_face; }},
    {GL_POLYGON_MODE, [](const Context& c) -> Numbers { return c.state.polygon.mode; }},
    {GL_POLYGON_OFFSET_FACTOR, [](const Context& c) -> Numbers { return c.state.polygon.offset_factor; }},
    {GL_POLYGON_OFFSET_UNITS, [](const Context& c) -> Numbers { return c.state.polygon.offset_units; }},
    {GL_SAMPLE_COVERAGE_VALUE, [](const Context& c) -> Numbers { return c.state.multisample.value; }},
    {GL_SAMPLE_COVERAGE_INVERT, [](const Context& c) -> Numbers { return c.state.multisample.invert; }},
    // 6.13 to 6.16: textures
    {GL_TEXTURE_BINDING_3D, [](const Context& c) -> Numbers { return active(c, c.state.texture.unit).bound[2]; }},
    {GL_TEXTURE_BINDING_CUBE_MAP, [](const Context& c) -> Numbers { return active(c, c.state.texture.unit).bound[3]; }},
    {GL_ACTIVE_TEXTURE, [](const Context& c) -> Numbers { return GL_TEXTURE0 + c.state.texture.active; }},
    // 6.19: pixel operations
    {GL_SCISSOR_BOX, [](const Context& c) -> Numbers { return box(c.state.scissor); }},
    {GL_ALPHA_TEST_FUNC, [](const Context& c) -> Numbers { return c.state.color.alpha_func; }},
    {GL_ALPHA_TEST_REF, [](const Context& c) { return color_values(c.state.color.alpha_reference); }},
    {GL_STENCIL_FUNC, [](const Context& c) -> Numbers { return c.state.stencil.func; }},
    {GL_STENCIL_VALUE_MASK, [](const Context& c) -> Numbers { return c.state.stencil.value_mask; }},
    {GL_STENCIL_REF, [](const Context& c) -> Numbers { return c.state.stencil.reference; }},
    {GL_STENCIL_FAIL, [](const Context& c) -> Numbers { return c.state.stencil.fail; }},
    {GL_STENCIL_PASS_DEPTH_FAIL, [](const Context& c) -> Numbers { return c.state.stencil.depth_fail; }},
    {GL_STENCIL_PASS_DEPTH_PASS, [](const Context& c) -> Numbers { return c.state.stencil.depth_pass; }},
    {GL_DEPTH_FUNC, [](const Context& c) -> Numbers { return c.state.depth.func; }},
    {GL_BLEND_SRC, [](const Context& c) -> Numbers { return c.state.color.src_rgb; }},
    {GL_BLEND_DST, [](const Context& c) -> Numbers { return c.state.color.dst_rgb; }},
    {GL_BLEND_SRC_RGB, [](const Context& c) -> Numbers { return c.state.color.src_rgb; }},
    {GL_BLEND_SRC_ALPHA, [](const Context& c) -> Numbers { return c.state.color.src_alpha; }},
    {GL_BLEND_DST_RGB, [](const Context& c) -> Numbers { return c.state.color.dst_rgb; }},
    {GL_BLEND_DST_ALPHA, [](const Context& c) -> Numbers { return c.state.color.dst_alpha; }},
    {GL_BLEND_EQUATION, [](const Context& c) -> Numbers { return c.state.color.equation; }},
    {GL_BLEND_COLOR, [](const Context& c) { return color_values(c.state.color.blend_color); }},
    {GL_LOGIC_OP_MODE, [](const Context& c) -> Numbers { return c.state.color.logic_func; }},
    // 6.20: framebuffer
    {GL_DRAW_BUFFER, [](const Context& c) -> Numbers { return c.state.color.draw_buffer; }},
    {GL_INDEX_WRITEMASK, [](const Context& c) -> Numbers { return c.state.color.index_write; }},
    {GL_COLOR_WRITEMASK, [](const Context& c) -> Numbers { return c.state.color.write; }},
    {GL_DEPTH_WRITEMASK, [](const Context& c) -> Numbers { return c.state.depth.write; }},
    {GL_STENCIL_WRITEMASK, [](const Context& c) -> Numbers { return c.state.stencil.write_mask; }},
    {GL_COLOR_CLEAR_VALUE, [](const Context& c) { return color_values(c.state.color.clear); }},
    {GL_INDEX_CLEAR_VALUE, [](const Context& c) -> Numbers { return c.state.color.clear_index; }},
    {GL_DEPTH_CLEAR_VALUE, [](const Context& c) { return color_values(c.state.depth.clear); }},
    {GL_STENCIL_CLEAR_VALUE, [](const Context& c) -> Numbers { return c.state.stencil.clear; }},
    {GL_ACCUM_CLEAR_VALUE, [](const Context& c) { return color_values(c.state.accum.clear); }},
    // 6.21 to 6.24: pixels
    {GL_ZOOM_X, [](const Context& c) -> Numbers { return c.state.pixel.zoom_x; }},
    {GL_ZOOM_Y, [](const Context& c) -> Numbers { return c.state.pixel.zoom_y; }},
    {GL_READ_BUFFER, [](const Context& c) -> Numbers { return c.state.pixel.read_buffer; }},
    // 6.25 and 6.26: evaluators, hints
    {GL_MAP1_GRID_DOMAIN, [](const Context& c) -> Numbers { return c.state.eval.range1; }},
    {GL_MAP2_GRID_DOMAIN, [](const Context& c) -> Numbers { return c.state.eval.range2; }},
    {GL_MAP1_GRID_SEGMENTS, [](const Context& c) -> Numbers { return c.state.eval.grid1; }},
    {GL_MAP2_GRID_SEGMENTS, [](const Context& c) -> Numbers { return c.state.eval.grid2; }},
    // 6.27 and 6.28: limits
    {GL_MAX_LIGHTS, [](const Context&) -> Numbers { return kLights; }},
    {GL_MAX_CLIP_PLANES, [](const Context&) -> Numbers { return kClipPlanes; }},
    {GL_MAX_MODELVIEW_STACK_DEPTH, [](const Context&) -> Numbers { return kModelviewDepth; }},
    {GL_MAX_PROJECTION_STACK_DEPTH, [](const Context&) -> Numbers { return kProjectionDepth; }},
    {GL_MAX_TEXTURE_STACK_DEPTH, [](const Context&) -> Numbers { return kTextureDepth; }},
    {GL_SUBPIXEL_BITS, [](const Context& c) -> Numbers { return config_of(c).subpixel_bits; }},
    {GL_MAX_3D_TEXTURE_SIZE, [](const Context&) -> Numbers { return kLargestTexture3D; }},
    {GL_MAX_TEXTURE_SIZE, [](const Context&) -> Numbers { return kLargestTexture; }},
    {GL_MAX_CUBE_MAP_TEXTURE_SIZE, [](const Context&) -> Numbers { return kLargestTexture; }},
    {GL_MAX_TEXTURE_LOD_BIAS, [](const Context&) -> Numbers { return 16.0; }},
    {GL_MAX_PIXEL_MAP_TABLE, [](const Context&) -> Numbers { return kPixelMapTable; }},
    {GL_MAX_NAME_STACK_DEPTH, [](const Context&) -> Numbers { return kNameDepth; }},
    {GL_MAX_LIST_NESTING, [](const Context&) -> Numbers { return kListNesting; }},
    {GL_MAX_EVAL_ORDER, [](const Context&) -> Numbers { return kEvalOrder; }},
    {GL_MAX_VIEWPORT_DIMS, [](const Context&) -> Numbers { return std::array{kLargestViewport, kLargestViewport}; }},
    {GL_MAX_ATTRIB_STACK_DEPTH, [](const Context&) -> Numbers { return kAttribDepth; }},
    {GL_MAX_CLIENT_ATTRIB_STACK_DEPTH, [](const Context&) -> Numbers { return kAttribDepth; }},
    {GL_MAX_TEXTURE_UNITS, [](const Context&) -> Numbers { return kTextureUnits; }},
    {GL_MAX_ELEMENTS_INDICES, [](const Context&) -> Numbers { return 1 << 16; }},
    {GL_MAX_ELEMENTS_VERTICES, [](const Context&) -> Numbers { return 1 << 16; }},
    {GL_POINT_SIZE_RANGE, [](const Context&) -> Numbers { return kPointSizes; }},
    {GL_ALIASED_POINT_SIZE_RANGE, [](const Context&) -> Numbers { return kPointSizes; }},
    {GL_POINT_SIZE_GRANULARITY, [](const Context&) -> Numbers { return 1.0 / 16; }},
    {GL_LINE_WIDTH_RANGE, [](const Context&) -> Numbers { return kLineWidths; }},
    {GL_ALIASED_LINE_WIDTH_RANGE, [](const Context&) -> Numbers { return kLineWidths; }},
    {GL_LINE_WIDTH_GRANULARITY, [](const Context&) -> Numbers { return 1.0 / 16; }},
    {GL_AUX_BUFFERS, [](const Context&) -> Numbers { return 0; }},
    {GL_RGBA_MODE, [](const Context&) -> Numbers { return true; }},
    {GL_INDEX_MODE, [](const Context&) -> Numbers { return false; }},
    {GL_DOUBLEBUFFER,
     [](const Context& c) -> Numbers { return c.drawable != nullptr && !c.drawable->single_buffered; }},
    {GL_STEREO, [](const Context&) -> Numbers { return false; }},
    {GL_SAMPLE_BUFFERS, [](const Context& c) -> Numbers { return samples(c) == 0 ? 0 : 1; }},
    {GL_SAMPLES, [](const Context& c) -> Numbers { return samples(c); }},
    {GL_NUM_COMPRESSED_TEXTURE_FORMATS, [](const Context& c) -> Numbers { return c.is_embedded ? kPalettes : 0; }},
    {GL_COMPRESSED_TEXTURE_FORMATS,
     [](const Context& c) -> Numbers {
       if (!c.is_embedded) return std::array<GLenum, 0>{};
       std::array<GLenum, kPalettes> formats;
       std::iota(formats.begin(), formats.end(), kFirstPalette);
       return formats;
     }},
    {GL_IMPLEMENTATION_COLOR_READ_TYPE, [](const Context&) -> Numbers { return GL_UNSIGNED_BYTE; }},
    {GL_IMPLEMENTATION_COLOR_READ_FORMAT, [](const Context&) -> Numbers { return GL_RGBA; }},
    // 6.33: bits of the buffers
    {GL_INDEX_BITS, [](const Context&) -> Numbers { return 0; }},
    // 6.34: the rest
    {GL_LIST_BASE, [](const Context& c) -> Numbers { return c.state.list.base; }},
    {GL_LIST_INDEX, [](const Context& c) -> Numbers { return c.compiling == nullptr ? 0 : c.compiling_name; }},
    {GL_LIST_MODE, [](const Context& c) -> Numbers { return list_mode(c); }},
    {GL_ATTRIB_STACK_DEPTH, [](const Context& c) -> Numbers { return c.attributes.size(); }},
    {GL_CLIENT_ATTRIB_STACK_DEPTH, [](const Context& c) -> Numbers { return c.client_attributes.size(); }},
    {GL_NAME_STACK_DEPTH, [](const Context& c) -> Numbers { return c.names.size(); }},
    {GL_RENDER_MODE, [](const Context& c) -> Numbers { return c.render_mode; }},
    {GL_SELECTION_BUFFER_SIZE, [](const Context& c) -> Numbers { return c.select_size; }},
    {GL_FEEDBACK_BUFFER_SIZE, [](const Context& c) -> Numbers { return c.feedback_size; }},
    {GL_FEEDBACK_BUFFER_TYPE, [](const Context& c) -> Numbers { return c.feedback_type; }},
};

// Names in a row: `first`, `first` + 1, ...
struct StateRow {
  GLenum first;
  GLuint count;
  Numbers (*value)(const Context& c, std::size_t i);
};
// Of the model view, the projection, and the active unit's texture coordinates.
const std::vector<Mat4>& stack(const Context& c, std::size_t i) {
  return i == 0 ? c.modelview : i == 1 ? c.projection : active(c, c.texture_matrix);
}
const StateRow kStateRows[] = {
    {GL_MODELVIEW_STACK_DEPTH, 3, [](const Context& c, std::size_t i) -> Numbers { return stack(c, i).size(); }},
    {GL_MODELVIEW_MATRIX, 3, [](const Context& c, std::size_t i) -> Numbers { return stack(c, i).back(); }},
    {GL_TRANSPOSE_MODELVIEW_MATRIX, 3, [](const Context& c, std::size_t i) { return transposed(stack(c, i).back()); }},
    {kModelviewBits, 3, [](const Context& c, std::size_t i) { return bits_of(stack(c, i).back()); }},
    {GL_TEXTURE_BINDING_1D, 2,
     [](const Context& c, std::size_t i) -> Numbers { return active(c, c.state.texture.unit).bound[i]; }},
    {GL_RED_BITS, 6,
     [](const Context& c, std::size_t i) -> Numbers { return buffer_bits(c)[i]; }},  // and depth, stencil
    {GL_ACCUM_RED_BITS, 4, [](const Context&, std::size_t) -> Numbers { return 16; }},
};

// A row of flags: `first`, `first` + 1, ... of glEnable, and whether OpenGL ES has them (OpenGL ES 1.1, table 6).
struct Enable {
  GLenum first;
  GLuint count;
  bool is_embedded;
  bool* (*flag)(State& s, std::size_t i);
};
TextureUnit& active_unit(State& state) { return state.texture.unit[static_cast<std::size_t>(state.texture.active)]; }
constexpr Enable kEnables[] = {
    {GL_ALPHA_TEST, 1, true, [](State& s, std::size_t) { return &s.color.alpha_test; }},
    {GL_AUTO_NORMAL, 1, false, [](State& s, std::size_t) { return &s.eval.auto_normal; }},
    {GL_BLEND, 1, true, [](State& s, std::size_t) { return &s.color.blend; }},
    {GL_CLIP_PLANE0, kClipPlanes, true, [](State& s, std::size_t i) { return &s.transform.clip_enabled[i]; }},
    {GL_COLOR_LOGIC_OP, 1, true, [](State& s, std::size_t) { return &s.color.logic_op; }},
    {GL_COLOR_MATERIAL, 1, true, [](State& s, std::size_t) { return &s.lighting.color_material; }},
    {GL_COLOR_SUM, 1, false, [](State& s, std::size_t) { return &s.fog.color_sum; }},
    {GL_CULL_FACE, 1, true, [](State& s, std::size_t) { return &s.polygon.cull; }},
    {GL_DEPTH_TEST, 1, true, [](State& s, std::size_t) { return &s.depth.test; }},
    {GL_DITHER, 1, true, [](State& s, std::size_t) { return &s.color.dither; }},
    {GL_FOG, 1, true, [](State& s, std::size_t) { return &s.fog.enabled; }},
    {GL_INDEX_LOGIC_OP, 1, false, [](State& s, std::size_t) { return &s.color.index_logic_op; }},
    {GL_LIGHT0, kLights, true, [](State& s, std::size_t i) { return &s.lighting.light_enabled[i]; }},
    {GL_LIGHTING, 1, true, [](State& s, std::size_t) { return &s.lighting.enabled; }},
    {GL_LINE_SMOOTH, 1, true, [](State& s, std::size_t) { return &s.line.smooth; }},
    {GL_LINE_STIPPLE, 1, false, [](State& s, std::size_t) { return &s.line.stipple; }},
    {GL_MAP1_COLOR_4, 9, false, [](State& s, std::size_t i) { return &s.eval.map1[i]; }},
    {GL_MAP2_COLOR_4, 9, false, [](State& s, std::size_t i) { return &s.eval.map2[i]; }},
    {GL_MULTISAMPLE, 1, true, [](State& s, std::size_t) { return &s.multisample.enabled; }},
    {GL_NORMALIZE, 1, true, [](State& s, std::size_t) { return &s.transform.normalize; }},
    {GL_POINT_SPRITE, 1, true, [](State& s, std::size_t) { return &s.point.sprite; }},
    {GL_POINT_SMOOTH, 1, true, [](State& s, std::size_t) { return &s.point.smooth; }},
    {GL_POLYGON_OFFSET_FILL, 1, true, [](State& s, std::size_t) { return &s.polygon.offset_fill; }},
    {GL_POLYGON_OFFSET_LINE, 1, false, [](State& s, std::size_t) { return &s.polygon.offset_line; }},
    {GL_POLYGON_OFFSET_POINT, 1, false, [](State& s, std::size_t) { return &s.polygon.offset_point; }},
    {GL_POLYGON_SMOOTH, 1, false, [](State& s, std::size_t) { return &s.polygon.smooth; }},
    {GL_POLYGON_STIPPLE, 1, false, [](State& s, std::size_t) { return &s.polygon.stipple; }},
    {GL_RESCALE_NORMAL, 1, true, [](State& s, std::size_t) { return &s.transform.rescale_normal; }},
    {GL_SAMPLE_ALPHA_TO_COVERAGE, 1, true, [](State& s, std::size_t) { return &s.multisample.alpha_to_coverage; }},
    {GL_SAMPLE_ALPHA_TO_ONE, 1, true, [](State& s, std::size_t) { return &s.multisample.alpha_to_one; }},
    {GL_SAMPLE_COVERAGE, 1, true, [](State& s, std::size_t) { return &s.multisample.coverage; }},
    {GL_SCISSOR_TEST, 1, true, [](State& s, std::size_t) { return &s.scissor.test; }},
    {GL_STENCIL_TEST, 1, true, [](State& s, std::size_t) { return &s.stencil.test; }},
    {GL_TEXTURE_1D, 1, false, [](State& s, std::size_t) { return &active_unit(s).enabled[0]; }},
    {GL_TEXTURE_2D, 1, true, [](State& s, std::size_t) { return &active_unit(s).enabled[1]; }},
    {GL_TEXTURE_3D, 1, false, [](State& s, std::size_t) { return &active_unit(s).enabled[2]; }},
    {GL_TEXTURE_CUBE_MAP, 1, false, [](State& s, std::size_t) { return &active_unit(s).enabled[3]; }},
    {GL_TEXTURE_GEN_S, 4, false, [](State& s, std::size_t i) { return &active_unit(s).gen[i].enabled; }},
};

constexpr GLuint kPixelMaps = 10;  // from GL_PIXEL_MAP_I_TO_I on
// Until it is set, a map is a single zero.
std::vector<float> pixel_map_of(const Context& context, GLenum map) {
  const auto found = context.pixel_maps.find(map);
  return found == context.pixel_maps.end() ? std::vector<float>{0} : found->second;
}

constexpr const char* kExtensions =
    "GL_ARB_depth_texture GL_ARB_multisample GL_ARB_multitexture GL_ARB_occlusion_query GL_ARB_point_parameters "
    "GL_ARB_point_sprite "
    "GL_ARB_shadow GL_ARB_texture_cube_map GL_ARB_texture_env_add GL_ARB_texture_env_combine "
    "GL_ARB_texture_env_crossbar GL_ARB_texture_env_dot3 GL_ARB_texture_mirrored_repeat GL_ARB_transpose_matrix "
    "GL_ARB_vertex_buffer_object GL_ARB_window_pos GL_EXT_abgr GL_EXT_bgra GL_EXT_blend_color "
    "GL_EXT_blend_func_separate GL_EXT_blend_minmax GL_EXT_blend_subtract GL_EXT_compiled_vertex_array "
    "GL_EXT_copy_texture GL_EXT_draw_range_elements GL_EXT_fog_coord GL_EXT_multi_draw_arrays GL_EXT_packed_pixels "
    "GL_EXT_point_parameters GL_EXT_rescale_normal GL_EXT_secondary_color GL_EXT_separate_specular_color "
    "GL_EXT_shadow_funcs GL_EXT_stencil_wrap GL_EXT_subtexture GL_EXT_texture GL_EXT_texture3D "
    "GL_EXT_texture_cube_map GL_EXT_texture_edge_clamp GL_EXT_texture_env_add GL_EXT_texture_env_combine "
    "GL_EXT_texture_lod_bias GL_EXT_texture_object GL_EXT_vertex_array GL_OES_draw_texture GL_SGIS_generate_mipmap "
    "GL_SGIS_texture_edge_clamp GL_SGIS_texture_lod";

}  // namespace

Values get(Context& context, GLenum pname) {
  for (const StateValue& row : kStateValues)
    if (row.pname == pname) return row.value(context);
  for (const StateRow& row : kStateRows)
    if (pname - row.first < row.count) return row.value(context, pname - row.first);
  if (const auto hint = std::ranges::find(kHints, pname); hint != kHints.end())
    return Numbers(context.state.hint[static_cast<std::size_t>(hint - kHints.begin())]);
  State& state = context.state;
  for (const std::optional<Place>& place :
       {fog_place(state.fog, pname), light_model_place(state.lighting, pname), point_place(state.point, pname),
        transfer_place(state.pixel, pname), store_place(context.client, pname)})
    if (place) return parameter(context, place);
  if (const bool* flag = enable_flag(context, pname)) return Numbers(*flag);
  if (pname - GL_PIXEL_MAP_I_TO_I_SIZE < kPixelMaps)
    return Numbers(pixel_map_of(context, pname - GL_PIXEL_MAP_I_TO_I_SIZE + GL_PIXEL_MAP_I_TO_I).size());
  const auto array_with = [&](GLenum ArrayKind::*name) {
    const std::size_t place = find_array(context.client, name, pname);
    return place == kArrays ? nullptr : &context.client.array[place];
  };
  if (const ArrayPointer* array = array_with(&ArrayKind::enable)) return Numbers(array->enabled);
  if (const ArrayPointer* array = array_with(&ArrayKind::stride)) return Numbers(array->stride);
  if (const ArrayPointer* array = array_with(&ArrayKind::buffer)) return Numbers(array->buffer);
  if (const ArrayPointer* array = array_with(&ArrayKind::size)) return Numbers(array->size);
  if (const ArrayPointer* array = array_with(&ArrayKind::type)) return Numbers(array->type);
  context.fail(GL_INVALID_ENUM);
  return {};
}

bool* enable_flag(State& state, GLenum cap) {
  for (const Enable& row : kEnables)
    if (cap - row.first < row.count) return row.flag(state, cap - row.first);
  return nullptr;
}

bool takes_enable(const Context& context, GLenum cap) {
  return !context.is_embedded || std::ranges::any_of(kEnables, [cap](const Enable& row) {
    return row.is_embedded && cap - row.first < row.count;
  });
}

void copy_enables(State& to, State from) {
  const int active = to.texture.active;
  for (int unit = 0; unit < kTextureUnits; ++unit) {
    to.texture.active = from.texture.active = unit;
    for (const Enable& row : kEnables)
      for (std::size_t i = 0; i < row.count; ++i) *row.flag(to, i) = *row.flag(from, i);
  }
  to.texture.active = active;
}

GLboolean is_enabled(Context& context, GLenum cap) {
  if (const bool* flag = enable_flag(context, cap)) return *flag;
  const std::size_t array = find_array(context.client, &ArrayKind::enable, cap);
  if (array != kArrays) return context.client.array[array].enabled;
  return context.fail(GL_INVALID_ENUM), GL_FALSE;
}

Values get_pixel_map(Context& context, GLenum map) {
  if (map - GL_PIXEL_MAP_I_TO_I >= kPixelMaps) return context.fail(GL_INVALID_ENUM), Values{};
  const std::vector<float> table = pixel_map_of(context, map);
  const bool is_index = map == GL_PIXEL_MAP_I_TO_I || map == GL_PIXEL_MAP_S_TO_S;
  return {is_index ? ValueKind::real : ValueKind::color, {table.begin(), table.end()}};
}

Vec4 get_clip_plane(Context& context, GLenum plane) {
  if (plane - GL_CLIP_PLANE0 < GLuint{kClipPlanes}) return context.state.transform.clip_plane[plane - GL_CLIP_PLANE0];
  context.fail(GL_INVALID_ENUM);
  return {};
}

GLenum get_error(Context& context) { return std::exchange(context.error, GLenum{GL_NO_ERROR}); }

const GLubyte* get_string(Context& context, GLenum name) {
  const auto text = [](const char* of) { return reinterpret_cast<const GLubyte*>(of); };
  switch (name) {
    case GL_VENDOR: return text("Halfplane");
    case GL_RENDERER:
      if (context.renderer.empty())
        context.renderer =
            context.drawable == nullptr ? "Halfplane" : "Halfplane " + label(context.drawable->frame.options().config);
      return text(context.renderer.c_str());
    case GL_VERSION: return text(context.is_embedded ? kEmbeddedVersion : "1.5 Halfplane 0.1");
    case GL_EXTENSIONS: return text(context.is_embedded ? kEmbeddedExtensions : kExtensions);
    default: context.fail(GL_INVALID_ENUM); return nullptr;
  }
}

void get_pointer(Context& context, GLenum pname, void** params) {
  const std::size_t array = find_array(context.client, &ArrayKind::pointer, pname);
  if (array != kArrays)
    *params = const_cast<void*>(context.client.array[array].pointer);
  else if (pname == GL_SELECTION_BUFFER_POINTER)
    *params = context.select_buffer;
  else if (pname == GL_FEEDBACK_BUFFER_POINTER)
    *params = context.feedback_buffer;
  else
    context.fail(GL_INVALID_ENUM);
}

void get_polygon_stipple(Context& context, GLubyte* mask) {
  const PixelStore& store = context.client.pack;
  const std::ptrdiff_t bytes = ((store.row_length > 0 ? std::ptrdiff_t{store.row_length} : 32) + 7) / 8;
  const std::ptrdiff_t pitch = (bytes + store.alignment - 1) / store.alignment * store.alignment;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const int column = x + store.skip_pixels, bit = store.lsb_first ? column % 8 : 7 - column % 8;
      GLubyte& byte = mask[(y + store.skip_rows) * pitch + column / 8];
      const bool is_set = (context.state.stipple.row[static_cast<std::size_t>(y)] >> (31 - x) & 1) != 0;
      byte = static_cast<GLubyte>((byte & ~(1 << bit)) | is_set << bit);
    }
}

}  // namespace halfplane::gl
