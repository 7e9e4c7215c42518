// A row for each function that programs call: its type is that of GL/gl.h, which has those of OpenGL ES as extensions.
#include "entry_points.hpp"

#include <array>

#include "embedded.hpp"
#include "entry_variants.hpp"

namespace halfplane::gl {
namespace {

void add_families(EntryPoints& to) {
  using enum Components;
  using enum Before;
  using B = GLbyte;
  using D = GLdouble;
  using F = GLfloat;
  using I = GLint;
  using S = GLshort;
  using X = Fixed;
  using UB = GLubyte;
  using UI = GLuint;
  using US = GLushort;

  add_variants<&color, normalized, nothing, 3, B, D, F, I, S, UB, UI, US>(to, "glColor3");
  add_variants<&color, normalized, nothing, 4, B, D, F, I, S, UB, UI, US>(to, "glColor4");
  add_variants<&draw_tex, plain, nothing, 5, F, I, S, X>(to, "glDrawTex", {"OES"});
  add_variants<&eval_coord1, plain, nothing, 1, D, F>(to, "glEvalCoord1");
  add_variants<&eval_coord2, plain, nothing, 2, D, F>(to, "glEvalCoord2");
  add_variants<&fog_coord, plain, nothing, 1, D, F>(to, "glFogCoord", {"", "EXT"});
  add_variants<&index, plain, nothing, 1, D, F, I, S, UB>(to, "glIndex");
  add_variants<&tex_coord, plain, given, 1, D, F, I, S>(to, "glMultiTexCoord1", {"", "ARB"});
  add_variants<&tex_coord, plain, given, 2, D, F, I, S>(to, "glMultiTexCoord2", {"", "ARB"});
  add_variants<&tex_coord, plain, given, 3, D, F, I, S>(to, "glMultiTexCoord3", {"", "ARB"});
  add_variants<&tex_coord, plain, given, 4, D, F, I, S>(to, "glMultiTexCoord4", {"", "ARB"});
  add_variants<&normal, normalized, nothing, 3, B, D, F, I, S>(to, "glNormal3");
  add_variants<&raster_pos, plain, nothing, 2, D, F, I, S>(to, "glRasterPos2");
  add_variants<&raster_pos, plain, nothing, 3, D, F, I, S>(to, "glRasterPos3");
  add_variants<&raster_pos, plain, nothing, 4, D, F, I, S>(to, "glRasterPos4");
  add_variants<&secondary_color, normalized, nothing, 3, B, D, F, I, S, UB, UI, US>(to, "glSecondaryColor3",
                                                                                    {"", "EXT"});
  add_variants<&tex_coord, plain, first_unit, 1, D, F, I, S>(to, "glTexCoord1");
  add_variants<&tex_coord, plain, first_unit, 2, D, F, I, S>(to, "glTexCoord2");
  add_variants<&tex_coord, plain, first_unit, 3, D, F, I, S>(to, "glTexCoord3");
  add_variants<&tex_coord, plain, first_unit, 4, D, F, I, S>(to, "glTexCoord4");
  add_variants<&vertex, plain, nothing, 2, D, F, I, S>(to, "glVertex2");
  add_variants<&vertex, plain, nothing, 3, D, F, I, S>(to, "glVertex3");
  add_variants<&vertex, plain, nothing, 4, D, F, I, S>(to, "glVertex4");
  add_variants<&window_pos, plain, nothing, 2, D, F, I, S>(to, "glWindowPos2", {"", "ARB", "MESA"});
  add_variants<&window_pos, plain, nothing, 3, D, F, I, S>(to, "glWindowPos3", {"", "ARB", "MESA"});

  add_numbers<&alpha_func, X>(to, "glAlphaFunc");
  add_numbers<&clear_color, X>(to, "glClearColor");
  add_numbers<&clear_depth, F, X>(to, "glClearDepth");
  add_numbers<&color, X>(to, "glColor4");
  add_numbers<&depth_range, F, X>(to, "glDepthRange");
  add_numbers<&frustum, F, X>(to, "glFrustum");
  add_numbers<&line_width, X>(to, "glLineWidth");
  add_numbers<&map_grid1, D, F>(to, "glMapGrid1");
  add_numbers<&map_grid2, D, F>(to, "glMapGrid2");
  add_numbers<&normal, X>(to, "glNormal3");
  add_numbers<&ortho, F, X>(to, "glOrtho");
  add_numbers<&pixel_transfer, F, I>(to, "glPixelTransfer");
  add_numbers<&point_size, X>(to, "glPointSize");
  add_numbers<&polygon_offset, X>(to, "glPolygonOffset");
  add_numbers<&rect, D, F, I, S>(to, "glRect");
  add_numbers<&rotate, D, F, X>(to, "glRotate");
  add_numbers<&sample_coverage, X>(to, "glSampleCoverage");
  add_numbers<&scale, D, F, X>(to, "glScale");
  add_numbers<&tex_coord, X>(to, "glMultiTexCoord4");
  add_numbers<&translate, D, F, X>(to, "glTranslate");

  add_parameters<&fog, F, I, X>(to, "glFog");
  add_parameters<&light, F, I, X>(to, "glLight");
  add_parameters<&light_model, F, I, X>(to, "glLightModel");
  add_parameters<&material, F, I, X>(to, "glMaterial");
  add_parameters<&point_parameter, F, I, X>(to, "glPointParameter");
  add_parameters<&tex_env, F, I, X>(to, "glTexEnv");
  add_parameters<&tex_gen, D, F, I>(to, "glTexGen");
  add_parameters<&tex_parameter, F, I, X>(to, "glTexParameter");

  add_queries<&get_light, F, I, X>(to, "glGetLight");
  add_queries<&get_map, D, F, I>(to, "glGetMap");
  add_queries<&get_material, F, I, X>(to, "glGetMaterial");
  add_queries<&get_pixel_map, F, UI, US>(to, "glGetPixelMap");
  add_queries<&get_tex_env, F, I, X>(to, "glGetTexEnv");
  add_queries<&get_tex_gen, D, F, I>(to, "glGetTexGen");
  add_queries<&get_tex_level_parameter, F, I>(to, "glGetTexLevelParameter");
  add_queries<&get_tex_parameter, F, I, X>(to, "glGetTexParameter");

  add_matrices<&load_matrix, D, F, X>(to, "glLoadMatrix");
  add_matrices<&load_transpose_matrix, D, F>(to, "glLoadTransposeMatrix");
  add_matrices<&mult_matrix, D, F, X>(to, "glMultMatrix");
  add_matrices<&mult_transpose_matrix, D, F>(to, "glMultTransposeMatrix");
}

/// A pointer to an array; `kKnown`: size and type where the entry point does not say them.
template <Array kArray, auto... kKnown>
constexpr auto array = [](auto... given) { now<&array_pointer>(kArray, kKnown..., given...); };
template <class T>
constexpr auto get_state =
    [](GLenum pname, T* values) { outside_begin([&](Context& context) { store<T>(get(context, pname), values); }); };
/// glGetFixedv scales integers, too.
constexpr auto get_fixed = [](GLenum pname, GLfixed* values) {
  outside_begin([&](Context& context) { store<Fixed>({ValueKind::real, get(context, pname).value}, values); });
};
template <class T>
constexpr auto clip_plane_of =
    [](GLenum plane, const Raw<T>* equation) { listed<&clip_plane>(plane, read_all<4, T>(equation)); };
constexpr auto get_clip_plane_of = [](GLenum plane, auto* equation) {
  outside_begin([&](Context& context) { store_clip_plane(context, plane, equation); });
};
constexpr auto map1_of = [](auto... given) { with_context([&](Context& context) { enter_map1(context, given...); }); };
constexpr auto map2_of = [](auto... given) { with_context([&](Context& context) { enter_map2(context, given...); }); };
constexpr auto pixel_map_of = [](GLenum map, GLsizei size, const auto* values) {
  with_context([&](Context& context) { enter_pixel_map(context, map, size, values); });
};
constexpr auto rect_of = [](const auto* a, const auto* b) { listed<&rect>(a[0], a[1], b[0], b[1]); };
constexpr auto no_format = [](auto...) { listed<&compressed_image>(); };
constexpr auto nothing = [](auto...) {};

#define ENTRY(name, ...) to[#name] = Entry<decltype(::name)>::of(__VA_ARGS__)

void add_commands(EntryPoints& to) {
  ENTRY(glAccum, listed<&accum>);
  ENTRY(glActiveTexture, listed<&active_texture>);
  ENTRY(glAlphaFunc, listed<&alpha_func>);
  ENTRY(glAreTexturesResident, now<&are_textures_resident>);
  ENTRY(glArrayElement, now<&array_element>);
  ENTRY(glBegin, listed<&begin>);
  ENTRY(glBeginQuery, now<&begin_query>);
  ENTRY(glBindBuffer, now<&bind_buffer>);
  ENTRY(glBindTexture, listed<&bind_texture>);
  ENTRY(glBitmap, entered<&enter_bitmap>);
  ENTRY(glBlendColor, listed<&blend_color>);
  ENTRY(glBlendEquation, listed<&blend_equation>);
  ENTRY(glBlendFuncSeparate, listed<&blend_func_separate>);
  ENTRY(glBufferData, now<&buffer_data>);
  ENTRY(glBufferSubData, now<&buffer_sub_data>);
  ENTRY(glCallList, listed<&call_list>);
  ENTRY(glCallLists, entered<&enter_call_lists>);
  ENTRY(glClear, listed<&clear>);
  ENTRY(glClearAccum, listed<&clear_accum>);
  ENTRY(glClearColor, listed<&clear_color>);
  ENTRY(glClearDepth, listed<&clear_depth>);
  ENTRY(glClearIndex, listed<&clear_index>);
  ENTRY(glClearStencil, listed<&clear_stencil>);
  ENTRY(glClientActiveTexture, now<&client_active_texture>);
  ENTRY(glColorMask, listed<&color_mask>);
  ENTRY(glColorMaterial, listed<&color_material>);
  ENTRY(glColorPointer, array<Array::color>);
  ENTRY(glCompressedTexImage1D, no_format);
  ENTRY(glCompressedTexImage2D, entered<&enter_compressed_image>);
  ENTRY(glCompressedTexImage3D, no_format);
  ENTRY(glCompressedTexSubImage1D, no_format);
  ENTRY(glCompressedTexSubImage2D, no_format);
  ENTRY(glCompressedTexSubImage3D, no_format);
  ENTRY(glCopyPixels, listed<&copy_pixels>);
  ENTRY(glCullFace, listed<&cull_face>);
  ENTRY(glDeleteBuffers, now<&delete_buffers>);
  ENTRY(glDeleteLists, now<&delete_lists>);
  ENTRY(glDeleteQueries, now<&delete_queries>);
  ENTRY(glDeleteTextures, now<&delete_textures>);
  ENTRY(glDepthFunc, listed<&depth_func>);
  ENTRY(glDepthMask, listed<&depth_mask>);
  ENTRY(glDepthRange, listed<&depth_range>);
  ENTRY(glDrawArrays, now<&draw_arrays>);
  ENTRY(glDrawBuffer, listed<&draw_buffer>);
  ENTRY(glDrawElements, now<&draw_elements>);
  ENTRY(glDrawPixels, entered<&enter_draw_pixels>);
  ENTRY(glDrawRangeElements, now<&draw_range_elements>);
  ENTRY(glEdgeFlag, listed<&edge_flag>);
  ENTRY(glEdgeFlagPointer, array<Array::edge_flag, 1, GLenum{GL_UNSIGNED_BYTE}>);
  ENTRY(glEnd, listed<&end>);
  ENTRY(glEndList, now<&end_list>);
  ENTRY(glEndQuery, now<&end_query>);
  ENTRY(glEvalMesh1, listed<&eval_mesh1>);
  ENTRY(glEvalMesh2, listed<&eval_mesh2>);
  ENTRY(glEvalPoint1, listed<&eval_point1>);
  ENTRY(glEvalPoint2, listed<&eval_point2>);
  ENTRY(glFeedbackBuffer, now<&feedback_buffer>);
  ENTRY(glFinish, now<&finish>);
  ENTRY(glFlush, now<&flush>);
  ENTRY(glFogCoordPointer, array<Array::fog_coord, 1>);
  ENTRY(glFrontFace, listed<&front_face>);
  ENTRY(glFrustum, listed<&frustum>);
  ENTRY(glGenBuffers, now<&gen_buffers>);
  ENTRY(glGenLists, now<&gen_lists>);
  ENTRY(glGenQueries, now<&gen_queries>);
  ENTRY(glGenTextures, now<&gen_textures>);
  ENTRY(glGetBooleanv, get_state<GLboolean>);
  ENTRY(glGetBufferParameteriv, now<&get_buffer_parameter>);
  ENTRY(glGetBufferPointerv, now<&get_buffer_pointer>);
  ENTRY(glGetBufferSubData, now<&get_buffer_sub_data>);
  ENTRY(glGetDoublev, get_state<GLdouble>);
  ENTRY(glGetError, now<&get_error>);
  ENTRY(glGetFloatv, get_state<GLfloat>);
  ENTRY(glGetIntegerv, get_state<GLint>);
  ENTRY(glGetPointerv, now<&get_pointer>);
  ENTRY(glGetPolygonStipple, now<&get_polygon_stipple>);
  ENTRY(glGetQueryObjectiv, now<&get_query_object>);
  ENTRY(glGetQueryiv, now<&get_query>);
  ENTRY(glGetString, now<&get_string>);
  ENTRY(glGetTexImage, now<&get_tex_image>);
  ENTRY(glHint, listed<&hint>);
  ENTRY(glIndexMask, listed<&index_mask>);
  ENTRY(glIndexPointer, array<Array::index, 1>);
  ENTRY(glInitNames, listed<&init_names>);
  ENTRY(glInterleavedArrays, now<&interleaved_arrays>);
  ENTRY(glIsBuffer, now<&is_buffer>);
  ENTRY(glIsEnabled, now<&is_enabled>);
  ENTRY(glIsList, now<&is_list>);
  ENTRY(glIsQuery, now<&is_query>);
  ENTRY(glIsTexture, now<&is_texture>);
  ENTRY(glLineStipple, listed<&line_stipple>);
  ENTRY(glLineWidth, listed<&line_width>);
  ENTRY(glListBase, listed<&list_base>);
  ENTRY(glLoadIdentity, listed<&load_identity>);
  ENTRY(glLoadName, listed<&load_name>);
  ENTRY(glLockArraysEXT, nothing);
  ENTRY(glLogicOp, listed<&logic_op>);
  ENTRY(glMap1d, map1_of);
  ENTRY(glMap1f, map1_of);
  ENTRY(glMap2d, map2_of);
  ENTRY(glMap2f, map2_of);
  ENTRY(glMapBuffer, now<&map_buffer>);
  ENTRY(glMatrixMode, listed<&matrix_mode>);
  ENTRY(glMultiDrawArrays, now<&multi_draw_arrays>);
  ENTRY(glMultiDrawElements, now<&multi_draw_elements>);
  ENTRY(glNewList, now<&new_list>);
  ENTRY(glNormalPointer, array<Array::normal, 3>);
  ENTRY(glOrtho, listed<&ortho>);
  ENTRY(glPassThrough, listed<&pass_through>);
  ENTRY(glPixelMapfv, pixel_map_of);
  ENTRY(glPixelMapuiv, pixel_map_of);
  ENTRY(glPixelMapusv, pixel_map_of);
  ENTRY(glPixelStoref, now<&pixel_store>);
  ENTRY(glPixelStorei, now<&pixel_store>);
  ENTRY(glPixelZoom, listed<&pixel_zoom>);
  ENTRY(glPointSize, listed<&point_size>);
  ENTRY(glPolygonMode, listed<&polygon_mode>);
  ENTRY(glPolygonOffset, listed<&polygon_offset>);
  ENTRY(glPolygonStipple, entered<&enter_polygon_stipple>);
  ENTRY(glPopAttrib, listed<&pop_attrib>);
  ENTRY(glPopClientAttrib, now<&pop_client_attrib>);
  ENTRY(glPopMatrix, listed<&pop_matrix>);
  ENTRY(glPopName, listed<&pop_name>);
  ENTRY(glPrioritizeTextures, entered<&enter_prioritize_textures>);
  ENTRY(glPushAttrib, listed<&push_attrib>);
  ENTRY(glPushClientAttrib, now<&push_client_attrib>);
  ENTRY(glPushMatrix, listed<&push_matrix>);
  ENTRY(glPushName, listed<&push_name>);
  ENTRY(glReadBuffer, listed<&read_buffer>);
  ENTRY(glReadPixels, now<&read_pixels>);
  ENTRY(glRectdv, rect_of);
  ENTRY(glRectfv, rect_of);
  ENTRY(glRectiv, rect_of);
  ENTRY(glRectsv, rect_of);
  ENTRY(glRenderMode, now<&set_render_mode>);
  ENTRY(glSampleCoverage, listed<&sample_coverage>);
  ENTRY(glScissor, listed<&scissor>);
  ENTRY(glSecondaryColorPointer, array<Array::secondary_color>);
  ENTRY(glSelectBuffer, now<&select_buffer>);
  ENTRY(glShadeModel, listed<&shade_model>);
  ENTRY(glStencilFunc, listed<&stencil_func>);
  ENTRY(glStencilMask, listed<&stencil_mask>);
  ENTRY(glStencilOp, listed<&stencil_op>);
  ENTRY(glTexCoordPointer, array<Array::tex_coord>);
  ENTRY(glUnlockArraysEXT, nothing);
  ENTRY(glUnmapBuffer, now<&unmap_buffer>);
  ENTRY(glVertexPointer, array<Array::vertex>);
  ENTRY(glViewport, listed<&viewport>);
}

void add_adapted(EntryPoints& to) {
  ENTRY(glBlendFunc, [](GLenum src, GLenum dst) { listed<&blend_func_separate>(src, dst, src, dst); });
  ENTRY(glClipPlane, clip_plane_of<GLdouble>);
  to["glClipPlanef"] = Entry<decltype(::glClipPlanefOES)>::of(clip_plane_of<GLfloat>);
  to["glClipPlanex"] = Entry<decltype(::glClipPlanexOES)>::of(clip_plane_of<Fixed>);
  ENTRY(glCopyTexImage1D, [](GLenum target, GLint level, GLenum format, GLint x, GLint y, GLsizei width, GLint border) {
    listed<&copy_tex_image>(1, target, level, format, x, y, width, 1, border);
  });
  ENTRY(glCopyTexImage2D, [](auto... given) { listed<&copy_tex_image>(2, given...); });
  ENTRY(glCopyTexSubImage1D, [](GLenum target, GLint level, GLint at, GLint x, GLint y, GLsizei width) {
    listed<&copy_tex_sub_image>(1, target, level, at, 0, 0, x, y, width, 1);
  });
  ENTRY(glCopyTexSubImage2D, [](GLenum target, GLint level, GLint x_at, GLint y_at, auto... from) {
    listed<&copy_tex_sub_image>(2, target, level, x_at, y_at, 0, from...);
  });
  ENTRY(glCopyTexSubImage3D, [](auto... given) { listed<&copy_tex_sub_image>(3, given...); });
  ENTRY(glDisable, [](GLenum cap) { listed<&enable>(cap, false); });
  ENTRY(glDisableClientState, [](GLenum array) { now<&client_state>(array, false); });
  ENTRY(glEdgeFlagv, [](const GLboolean* flag) { listed<&edge_flag>(*flag); });
  ENTRY(glEnable, [](GLenum cap) { listed<&enable>(cap, true); });
  ENTRY(glEnableClientState, [](GLenum array) { now<&client_state>(array, true); });
  ENTRY(glGetClipPlane, get_clip_plane_of);
  to["glGetClipPlanef"] = Entry<decltype(::glGetClipPlanefOES)>::of(get_clip_plane_of);
  to["glGetClipPlanex"] = Entry<decltype(::glGetClipPlanexOES)>::of(get_clip_plane_of);
  ENTRY(glGetCompressedTexImage,
        [](GLenum target, GLint level, void*) { now<&enter_get_compressed_image>(target, level); });
  to["glGetFixedv"] = Entry<decltype(::glGetFixedvOES)>::of(get_fixed);
  ENTRY(glGetQueryObjectuiv, [](GLuint id, GLenum pname, GLuint* values) {
    now<&get_query_object>(id, pname, reinterpret_cast<GLint*>(values));
  });
  to["glPointSizePointerOES"] = Entry<void(GLenum, GLsizei, const void*)>::of(array<Array::point_size, 1>);
  ENTRY(glTexImage1D, [](GLenum target, GLint level, GLint format, GLsizei width, GLint border, auto... image) {
    entered<&enter_tex_image>(1, target, level, format, width, 1, 1, border, image...);
  });
  ENTRY(glTexImage2D,
        [](GLenum target, GLint level, GLint format, GLsizei width, GLsizei height, GLint border, auto... image) {
          entered<&enter_tex_image>(2, target, level, format, width, height, 1, border, image...);
        });
  ENTRY(glTexImage3D, [](auto... given) { entered<&enter_tex_image>(3, given...); });
  ENTRY(glTexSubImage1D, [](GLenum target, GLint level, GLint x, GLsizei width, auto... image) {
    entered<&enter_tex_sub_image>(1, target, level, x, 0, 0, width, 1, 1, image...);
  });
  ENTRY(glTexSubImage2D,
        [](GLenum target, GLint level, GLint x, GLint y, GLsizei width, GLsizei height, auto... image) {
          entered<&enter_tex_sub_image>(2, target, level, x, y, 0, width, height, 1, image...);
        });
  ENTRY(glTexSubImage3D, [](auto... given) { entered<&enter_tex_sub_image>(3, given...); });
  // GL_EXT_vertex_array: a count that is not used.
  ENTRY(glColorPointerEXT, [](GLint size, GLenum type, GLsizei stride, GLsizei, const void* at) {
    array<Array::color>(size, type, stride, at);
  });
  ENTRY(glEdgeFlagPointerEXT, [](GLsizei stride, GLsizei, const GLboolean* at) {
    array<Array::edge_flag, 1, GLenum{GL_UNSIGNED_BYTE}>(stride, at);
  });
  ENTRY(glIndexPointerEXT,
        [](GLenum type, GLsizei stride, GLsizei, const void* at) { array<Array::index, 1>(type, stride, at); });
  ENTRY(glNormalPointerEXT,
        [](GLenum type, GLsizei stride, GLsizei, const void* at) { array<Array::normal, 3>(type, stride, at); });
  ENTRY(glTexCoordPointerEXT, [](GLint size, GLenum type, GLsizei stride, GLsizei, const void* at) {
    array<Array::tex_coord>(size, type, stride, at);
  });
  ENTRY(glVertexPointerEXT, [](GLint size, GLenum type, GLsizei stride, GLsizei, const void* at) {
    array<Array::vertex>(size, type, stride, at);
  });
}
#undef ENTRY

/// Names of extensions: those of commands with a suffix.
struct Suffixed {
  std::string_view suffix, names;
};
constexpr Suffixed kSuffixed[] = {
    {"ARB",
     "ActiveTexture BeginQuery BindBuffer BufferData BufferSubData ClientActiveTexture CompressedTexImage1D "
     "CompressedTexImage2D CompressedTexImage3D CompressedTexSubImage1D CompressedTexSubImage2D "
     "CompressedTexSubImage3D DeleteBuffers DeleteQueries EndQuery GenBuffers GenQueries GetBufferParameteriv "
     "GetBufferPointerv GetBufferSubData GetCompressedTexImage GetQueryObjectiv GetQueryObjectuiv GetQueryiv "
     "IsBuffer IsQuery LoadTransposeMatrixd LoadTransposeMatrixf MapBuffer MultTransposeMatrixd MultTransposeMatrixf "
     "PointParameterf PointParameterfv SampleCoverage UnmapBuffer "},
    {"EXT",
     "AreTexturesResident ArrayElement BindTexture BlendColor BlendEquation BlendFuncSeparate CopyTexImage1D "
     "CopyTexImage2D CopyTexSubImage1D CopyTexSubImage2D CopyTexSubImage3D DeleteTextures DrawArrays "
     "DrawRangeElements FogCoordPointer GenTextures GetPointerv GetQueryObjectiv IsTexture MultiDrawArrays "
     "MultiDrawElements PointParameterf PointParameterfv PrioritizeTextures SecondaryColorPointer TexImage3D "
     "TexSubImage1D TexSubImage2D TexSubImage3D "},
    {"INGR", "BlendFuncSeparate "},
    {"OES", "ClearDepthf DepthRangef GetBufferPointerv MapBuffer UnmapBuffer "},
    {"KHR", "GetPointerv "},
    {"SGIS", "PointParameterf PointParameterfv "},
    {"NV", "PointParameteri PointParameteriv PolygonMode "}};

}  // namespace

const EntryPoints& entry_points() {
  static const EntryPoints all = [] {
    EntryPoints entries;
    add_families(entries);
    add_commands(entries);
    add_adapted(entries);
    for (auto [suffix, names] : kSuffixed)
      for (; !names.empty(); names.remove_prefix(names.find(' ') + 1)) {
        const std::string name = "gl" + std::string(names.substr(0, names.find(' ')));
        entries.emplace(name + std::string(suffix), entries.at(name));
      }
    return entries;
  }();
  return all;
}

const void* entry_point(std::string_view name) {
  const auto found = entry_points().find(name);
  return found != entry_points().end() ? found->second.function : nullptr;
}

}  // namespace halfplane::gl
