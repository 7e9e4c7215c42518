// Written by gl/entry_points.py from Khronos' gl.xml and core/commands.hpp: change that, not this.
// clang-format off
#include "entry_points.hpp"

#include <array>

#include "embedded.hpp"
#include "entry_variants.hpp"

namespace halfplane::gl {
namespace {

void add_families(EntryPoints& to) {
  add_variants<&color, InsideBegin::allowed, Components::normalized, Before::nothing, 3, GLbyte, GLdouble, GLfloat, GLint, GLshort, GLubyte, GLuint, GLushort>(to, "glColor3");
  add_variants<&color, InsideBegin::allowed, Components::normalized, Before::nothing, 4, GLbyte, GLdouble, GLfloat, GLint, GLshort, GLubyte, GLuint, GLushort>(to, "glColor4");
  add_variants<&eval_coord1, InsideBegin::allowed, Components::real, Before::nothing, 1, GLdouble, GLfloat>(to, "glEvalCoord1");
  add_variants<&eval_coord2, InsideBegin::allowed, Components::real, Before::nothing, 2, GLdouble, GLfloat>(to, "glEvalCoord2");
  add_variants<&fog_coord, InsideBegin::allowed, Components::real, Before::nothing, 1, GLdouble, GLfloat>(to, "glFogCoord");
  add_variants<&index, InsideBegin::allowed, Components::real, Before::nothing, 1, GLdouble, GLfloat, GLint, GLshort>(to, "glIndex");
  add_variants<&tex_coord, InsideBegin::allowed, Components::real, Before::given, 1, GLdouble, GLfloat, GLint, GLshort>(to, "glMultiTexCoord1");
  add_variants<&tex_coord, InsideBegin::allowed, Components::real, Before::given, 2, GLdouble, GLfloat, GLint, GLshort>(to, "glMultiTexCoord2");
  add_variants<&tex_coord, InsideBegin::allowed, Components::real, Before::given, 3, GLdouble, GLfloat, GLint, GLshort>(to, "glMultiTexCoord3");
  add_variants<&tex_coord, InsideBegin::allowed, Components::real, Before::given, 4, GLdouble, GLfloat, GLint, GLshort>(to, "glMultiTexCoord4");
  add_variants<&normal, InsideBegin::allowed, Components::normalized, Before::nothing, 3, GLbyte, GLdouble, GLfloat, GLint, GLshort>(to, "glNormal3");
  add_variants<&raster_pos, InsideBegin::refused, Components::real, Before::nothing, 2, GLdouble, GLfloat, GLint, GLshort>(to, "glRasterPos2");
  add_variants<&raster_pos, InsideBegin::refused, Components::real, Before::nothing, 3, GLdouble, GLfloat, GLint, GLshort>(to, "glRasterPos3");
  add_variants<&raster_pos, InsideBegin::refused, Components::real, Before::nothing, 4, GLdouble, GLfloat, GLint, GLshort>(to, "glRasterPos4");
  add_variants<&secondary_color, InsideBegin::allowed, Components::normalized, Before::nothing, 3, GLbyte, GLdouble, GLfloat, GLint, GLshort, GLubyte, GLuint, GLushort>(to, "glSecondaryColor3");
  add_variants<&tex_coord, InsideBegin::allowed, Components::real, Before::first_unit, 1, GLdouble, GLfloat, GLint, GLshort>(to, "glTexCoord1");
  add_variants<&tex_coord, InsideBegin::allowed, Components::real, Before::first_unit, 2, GLdouble, GLfloat, GLint, GLshort>(to, "glTexCoord2");
  add_variants<&tex_coord, InsideBegin::allowed, Components::real, Before::first_unit, 3, GLdouble, GLfloat, GLint, GLshort>(to, "glTexCoord3");
  add_variants<&tex_coord, InsideBegin::allowed, Components::real, Before::first_unit, 4, GLdouble, GLfloat, GLint, GLshort>(to, "glTexCoord4");
  add_variants<&vertex, InsideBegin::allowed, Components::real, Before::nothing, 2, GLdouble, GLfloat, GLint, GLshort>(to, "glVertex2");
  add_variants<&vertex, InsideBegin::allowed, Components::real, Before::nothing, 3, GLdouble, GLfloat, GLint, GLshort>(to, "glVertex3");
  add_variants<&vertex, InsideBegin::allowed, Components::real, Before::nothing, 4, GLdouble, GLfloat, GLint, GLshort>(to, "glVertex4");
  add_variants<&window_pos, InsideBegin::refused, Components::real, Before::nothing, 2, GLdouble, GLfloat, GLint, GLshort>(to, "glWindowPos2");
  add_variants<&window_pos, InsideBegin::refused, Components::real, Before::nothing, 3, GLdouble, GLfloat, GLint, GLshort>(to, "glWindowPos3");
}

void add_others(EntryPoints& to) {
  to.insert({
    {"glAccum", function([](GLenum op, GLfloat value) { return listed<&accum>(op, real(value)); })},
    {"glActiveTexture", function([](GLenum texture) { return listed<&active_texture>(texture); })},
    {"glAlphaFunc", function([](GLenum func, GLfloat ref) { return listed<&alpha_func>(func, real(ref)); })},
    {"glAlphaFuncx", function([](GLenum func, GLfixed ref) { return listed<&alpha_func>(func, fixed(ref)); })},
    {"glAreTexturesResident", function([](GLsizei n, const GLuint* textures, GLboolean* residences) { return now<&are_textures_resident>(n, textures, residences); })},
    {"glArrayElement", function([](GLint i) { return now_inside<&array_element>(i); })},
    {"glBegin", function([](GLenum mode) { return listed_inside<&begin>(mode); })},
    {"glBeginQuery", function([](GLenum target, GLuint id) { return now<&begin_query>(target, id); })},
    {"glBindBuffer", function([](GLenum target, GLuint buffer) { return now<&bind_buffer>(target, buffer); })},
    {"glBindTexture", function([](GLenum target, GLuint texture) { return listed<&bind_texture>(target, texture); })},
    {"glBitmap", function([](GLsizei width, GLsizei height, GLfloat xorig, GLfloat yorig, GLfloat xmove, GLfloat ymove, const GLubyte* bitmap_) { return with_context([&](Context& c) { enter_bitmap(c, width, height, xorig, yorig, xmove, ymove, bitmap_); }); })},
    {"glBlendColor", function([](GLfloat red, GLfloat green, GLfloat blue, GLfloat alpha) { return listed<&blend_color>(real(red), real(green), real(blue), real(alpha)); })},
    {"glBlendEquation", function([](GLenum mode) { return listed<&blend_equation>(mode); })},
    {"glBlendFunc", function([](GLenum sfactor, GLenum dfactor) { return listed<&blend_func_separate>(sfactor, dfactor, sfactor, dfactor); })},
    {"glBlendFuncSeparate", function([](GLenum sfactorRGB, GLenum dfactorRGB, GLenum sfactorAlpha, GLenum dfactorAlpha) { return listed<&blend_func_separate>(sfactorRGB, dfactorRGB, sfactorAlpha, dfactorAlpha); })},
    {"glBufferData", function([](GLenum target, GLsizeiptr size, const void* data, GLenum usage) { return now<&buffer_data>(target, size, data, usage); })},
    {"glBufferSubData", function([](GLenum target, GLintptr offset, GLsizeiptr size, const void* data) { return now<&buffer_sub_data>(target, offset, size, data); })},
    {"glCallList", function([](GLuint list) { return listed_inside<&call_list>(list); })},
    {"glCallLists", function([](GLsizei n, GLenum type, const void* lists) { return with_context([&](Context& c) { enter_call_lists(c, n, type, lists); }); })},
    {"glClear", function([](GLbitfield mask) { return listed<&clear>(mask); })},
    {"glClearAccum", function([](GLfloat red, GLfloat green, GLfloat blue, GLfloat alpha) { return listed<&clear_accum>(real(red), real(green), real(blue), real(alpha)); })},
    {"glClearColor", function([](GLfloat red, GLfloat green, GLfloat blue, GLfloat alpha) { return listed<&clear_color>(real(red), real(green), real(blue), real(alpha)); })},
    {"glClearColorx", function([](GLfixed red, GLfixed green, GLfixed blue, GLfixed alpha) { return listed<&clear_color>(fixed(red), fixed(green), fixed(blue), fixed(alpha)); })},
    {"glClearDepth", function([](GLdouble depth) { return listed<&clear_depth>(real(depth)); })},
    {"glClearDepthf", function([](GLfloat d) { return listed<&clear_depth>(real(d)); })},
    {"glClearDepthx", function([](GLfixed depth) { return listed<&clear_depth>(fixed(depth)); })},
    {"glClearIndex", function([](GLfloat c) { return listed<&clear_index>(real(c)); })},
    {"glClearStencil", function([](GLint s) { return listed<&clear_stencil>(s); })},
    {"glClientActiveTexture", function([](GLenum texture) { return now<&client_active_texture>(texture); })},
    {"glClipPlane", function([](GLenum plane, const GLdouble* equation) { return listed<&clip_plane>(plane, vec4(equation)); })},
    {"glClipPlanef", function([](GLenum p, const GLfloat* eqn) { return listed<&clip_plane>(p, vec4(eqn)); })},
    {"glClipPlanex", function([](GLenum plane, const GLfixed* equation) { return listed<&clip_plane>(plane, vec4_fixed(equation)); })},
    {"glColor4x", function([](GLfixed red, GLfixed green, GLfixed blue, GLfixed alpha) { return listed_inside<&color>(fixed(red), fixed(green), fixed(blue), fixed(alpha)); })},
    {"glColorMask", function([](GLboolean red, GLboolean green, GLboolean blue, GLboolean alpha) { return listed<&color_mask>(red, green, blue, alpha); })},
    {"glColorMaterial", function([](GLenum face, GLenum mode) { return listed<&color_material>(face, mode); })},
    {"glColorPointer", function([](GLint size, GLenum type, GLsizei stride, const void* pointer) { return now<&array_pointer>(Array::color, size, type, stride, pointer); })},
    {"glColorPointerEXT", function([](GLint size, GLenum type, GLsizei stride, GLsizei, const void* pointer) { return now<&array_pointer>(Array::color, size, type, stride, pointer); })},
    {"glCompressedTexImage1D", function([](GLenum, GLint, GLenum, GLsizei, GLint, GLsizei, const void*) { return listed<&compressed_image>(); })},
    {"glCompressedTexImage2D", function([](GLenum target, GLint level, GLenum internalformat, GLsizei width, GLsizei height, GLint border, GLsizei imageSize, const void* data) { return with_context([&](Context& c) { enter_compressed_image(c, target, level, internalformat, width, height, border, imageSize, data); }); })},
    {"glCompressedTexImage3D", function([](GLenum, GLint, GLenum, GLsizei, GLsizei, GLsizei, GLint, GLsizei, const void*) { return listed<&compressed_image>(); })},
    {"glCompressedTexSubImage1D", function([](GLenum, GLint, GLint, GLsizei, GLenum, GLsizei, const void*) { return listed<&compressed_image>(); })},
    {"glCompressedTexSubImage2D", function([](GLenum, GLint, GLint, GLint, GLsizei, GLsizei, GLenum, GLsizei, const void*) { return listed<&compressed_image>(); })},
    {"glCompressedTexSubImage3D", function([](GLenum, GLint, GLint, GLint, GLint, GLsizei, GLsizei, GLsizei, GLenum, GLsizei, const void*) { return listed<&compressed_image>(); })},
    {"glCopyPixels", function([](GLint x, GLint y, GLsizei width, GLsizei height, GLenum type) { return listed<&copy_pixels>(x, y, width, height, type); })},
    {"glCopyTexImage1D", function([](GLenum target, GLint level, GLenum internalformat, GLint x, GLint y, GLsizei width, GLint border) { return listed<&copy_tex_image>(1, target, level, internalformat, x, y, width, 1, border); })},
    {"glCopyTexImage2D", function([](GLenum target, GLint level, GLenum internalformat, GLint x, GLint y, GLsizei width, GLsizei height, GLint border) { return listed<&copy_tex_image>(2, target, level, internalformat, x, y, width, height, border); })},
    {"glCopyTexSubImage1D", function([](GLenum target, GLint level, GLint xoffset, GLint x, GLint y, GLsizei width) { return listed<&copy_tex_sub_image>(1, target, level, xoffset, 0, 0, x, y, width, 1); })},
    {"glCopyTexSubImage2D", function([](GLenum target, GLint level, GLint xoffset, GLint yoffset, GLint x, GLint y, GLsizei width, GLsizei height) { return listed<&copy_tex_sub_image>(2, target, level, xoffset, yoffset, 0, x, y, width, height); })},
    {"glCopyTexSubImage3D", function([](GLenum target, GLint level, GLint xoffset, GLint yoffset, GLint zoffset, GLint x, GLint y, GLsizei width, GLsizei height) { return listed<&copy_tex_sub_image>(3, target, level, xoffset, yoffset, zoffset, x, y, width, height); })},
    {"glCullFace", function([](GLenum mode) { return listed<&cull_face>(mode); })},
    {"glDeleteBuffers", function([](GLsizei n, const GLuint* buffers) { return now<&delete_buffers>(n, buffers); })},
    {"glDeleteLists", function([](GLuint list, GLsizei range) { return now<&delete_lists>(list, range); })},
    {"glDeleteQueries", function([](GLsizei n, const GLuint* ids) { return now<&delete_queries>(n, ids); })},
    {"glDeleteTextures", function([](GLsizei n, const GLuint* textures) { return now<&enter_delete_textures>(n, textures); })},
    {"glDepthFunc", function([](GLenum func) { return listed<&depth_func>(func); })},
    {"glDepthMask", function([](GLboolean flag) { return listed<&depth_mask>(flag); })},
    {"glDepthRange", function([](GLdouble n, GLdouble f) { return listed<&depth_range>(real(n), real(f)); })},
    {"glDepthRangef", function([](GLfloat n, GLfloat f) { return listed<&depth_range>(real(n), real(f)); })},
    {"glDepthRangex", function([](GLfixed n, GLfixed f) { return listed<&depth_range>(fixed(n), fixed(f)); })},
    {"glDisable", function([](GLenum cap) { return listed<&enable>(cap, false); })},
    {"glDisableClientState", function([](GLenum array) { return now<&client_state>(array, false); })},
    {"glDrawArrays", function([](GLenum mode, GLint first, GLsizei count) { return now_inside<&draw_arrays>(mode, first, count); })},
    {"glDrawBuffer", function([](GLenum buf) { return listed<&draw_buffer>(buf); })},
    {"glDrawElements", function([](GLenum mode, GLsizei count, GLenum type, const void* indices) { return now_inside<&draw_elements>(mode, count, type, indices); })},
    {"glDrawPixels", function([](GLsizei width, GLsizei height, GLenum format, GLenum type, const void* pixels) { return with_context([&](Context& c) { enter_draw_pixels(c, width, height, format, type, pixels); }); })},
    {"glDrawRangeElements", function([](GLenum mode, GLuint start, GLuint end_, GLsizei count, GLenum type, const void* indices) { return now_inside<&draw_range_elements>(mode, start, end_, count, type, indices); })},
    {"glDrawTexfOES", function([](GLfloat x, GLfloat y, GLfloat z, GLfloat width, GLfloat height) { return listed<&draw_tex>(real(x), real(y), real(z), real(width), real(height)); })},
    {"glDrawTexfvOES", function([](const GLfloat* coords) { return listed<&draw_tex>(real(coords[0]), real(coords[1]), real(coords[2]), real(coords[3]), real(coords[4])); })},
    {"glDrawTexiOES", function([](GLint x, GLint y, GLint z, GLint width, GLint height) { return listed<&draw_tex>(real(x), real(y), real(z), real(width), real(height)); })},
    {"glDrawTexivOES", function([](const GLint* coords) { return listed<&draw_tex>(real(coords[0]), real(coords[1]), real(coords[2]), real(coords[3]), real(coords[4])); })},
    {"glDrawTexsOES", function([](GLshort x, GLshort y, GLshort z, GLshort width, GLshort height) { return listed<&draw_tex>(real(x), real(y), real(z), real(width), real(height)); })},
    {"glDrawTexsvOES", function([](const GLshort* coords) { return listed<&draw_tex>(real(coords[0]), real(coords[1]), real(coords[2]), real(coords[3]), real(coords[4])); })},
    {"glDrawTexxOES", function([](GLfixed x, GLfixed y, GLfixed z, GLfixed width, GLfixed height) { return listed<&draw_tex>(fixed(x), fixed(y), fixed(z), fixed(width), fixed(height)); })},
    {"glDrawTexxvOES", function([](const GLfixed* coords) { return listed<&draw_tex>(fixed(coords[0]), fixed(coords[1]), fixed(coords[2]), fixed(coords[3]), fixed(coords[4])); })},
    {"glEdgeFlag", function([](GLboolean flag) { return listed_inside<&edge_flag>(flag); })},
    {"glEdgeFlagPointer", function([](GLsizei stride, const void* pointer) { return now<&array_pointer>(Array::edge_flag, 1, GLenum{GL_UNSIGNED_BYTE}, stride, pointer); })},
    {"glEdgeFlagPointerEXT", function([](GLsizei stride, GLsizei, const GLboolean* pointer) { return now<&array_pointer>(Array::edge_flag, 1, GLenum{GL_UNSIGNED_BYTE}, stride, pointer); })},
    {"glEdgeFlagv", function([](const GLboolean* flag) { return listed_inside<&edge_flag>(*flag); })},
    {"glEnable", function([](GLenum cap) { return listed<&enable>(cap, true); })},
    {"glEnableClientState", function([](GLenum array) { return now<&client_state>(array, true); })},
    {"glEnd", function([]() { return listed_inside<&end>(); })},
    {"glEndList", function([]() { return now<&end_list>(); })},
    {"glEndQuery", function([](GLenum target) { return now<&end_query>(target); })},
    {"glEvalMesh1", function([](GLenum mode, GLint i1, GLint i2) { return listed<&eval_mesh1>(mode, i1, i2); })},
    {"glEvalMesh2", function([](GLenum mode, GLint i1, GLint i2, GLint j1, GLint j2) { return listed<&eval_mesh2>(mode, i1, i2, j1, j2); })},
    {"glEvalPoint1", function([](GLint i) { return listed_inside<&eval_point1>(i); })},
    {"glEvalPoint2", function([](GLint i, GLint j) { return listed_inside<&eval_point2>(i, j); })},
    {"glFeedbackBuffer", function([](GLsizei size, GLenum type, GLfloat* buffer) { return now<&feedback_buffer>(size, type, buffer); })},
    {"glFinish", function([]() { return now<&finish>(); })},
    {"glFlush", function([]() { return now<&flush>(); })},
    {"glFogCoordPointer", function([](GLenum type, GLsizei stride, const void* pointer) { return now<&array_pointer>(Array::fog_coord, 1, type, stride, pointer); })},
    {"glFogf", function([](GLenum pname, GLfloat param) { return listed<&fog>(pname, scalar(pname, param)); })},
    {"glFogfv", function([](GLenum pname, const GLfloat* params) { return listed<&fog>(pname, vector(pname, params)); })},
    {"glFogi", function([](GLenum pname, GLint param) { return listed<&fog>(pname, scalar(pname, param)); })},
    {"glFogiv", function([](GLenum pname, const GLint* params) { return listed<&fog>(pname, vector(pname, params)); })},
    {"glFogx", function([](GLenum pname, GLfixed param) { return listed<&fog>(pname, scalar_fixed(pname, param)); })},
    {"glFogxv", function([](GLenum pname, const GLfixed* param) { return listed<&fog>(pname, vector_fixed(pname, param)); })},
    {"glFrontFace", function([](GLenum mode) { return listed<&front_face>(mode); })},
    {"glFrustum", function([](GLdouble left, GLdouble right, GLdouble bottom, GLdouble top, GLdouble zNear, GLdouble zFar) { return listed<&frustum>(real(left), real(right), real(bottom), real(top), real(zNear), real(zFar)); })},
    {"glFrustumf", function([](GLfloat l, GLfloat r, GLfloat b, GLfloat t, GLfloat n, GLfloat f) { return listed<&frustum>(real(l), real(r), real(b), real(t), real(n), real(f)); })},
    {"glFrustumx", function([](GLfixed l, GLfixed r, GLfixed b, GLfixed t, GLfixed n, GLfixed f) { return listed<&frustum>(fixed(l), fixed(r), fixed(b), fixed(t), fixed(n), fixed(f)); })},
    {"glGenBuffers", function([](GLsizei n, GLuint* buffers) { return now<&gen_buffers>(n, buffers); })},
    {"glGenLists", function([](GLsizei range) { return now<&gen_lists>(range); })},
    {"glGenQueries", function([](GLsizei n, GLuint* ids) { return now<&gen_queries>(n, ids); })},
    {"glGenTextures", function([](GLsizei n, GLuint* textures) { return now<&gen_textures>(n, textures); })},
    {"glGetBooleanv", function([](GLenum pname, GLboolean* data) { return outside_begin([&](Context& c) { store(get(c, pname), data); }); })},
    {"glGetBufferParameteriv", function([](GLenum target, GLenum pname, GLint* params) { return now<&get_buffer_parameter>(target, pname, params); })},
    {"glGetBufferPointerv", function([](GLenum target, GLenum pname, void** params) { return now<&get_buffer_pointer>(target, pname, params); })},
    {"glGetBufferSubData", function([](GLenum target, GLintptr offset, GLsizeiptr size, void* data) { return now<&get_buffer_sub_data>(target, offset, size, data); })},
    {"glGetClipPlane", function([](GLenum plane, GLdouble* equation) { return outside_begin([&](Context& c) { store_clip_plane(c, plane, equation); }); })},
    {"glGetClipPlanef", function([](GLenum plane, GLfloat* equation) { return outside_begin([&](Context& c) { store_clip_plane(c, plane, equation); }); })},
    {"glGetClipPlanex", function([](GLenum plane, GLfixed* equation) { return outside_begin([&](Context& c) { store_clip_plane(c, plane, equation); }); })},
    {"glGetCompressedTexImage", function([](GLenum target, GLint level, void*) { return now<&enter_get_compressed_image>(target, level); })},
    {"glGetDoublev", function([](GLenum pname, GLdouble* data) { return outside_begin([&](Context& c) { store(get(c, pname), data); }); })},
    {"glGetError", function([]() { return now<&get_error>(); })},
    {"glGetFixedv", function([](GLenum pname, GLfixed* params) { return outside_begin([&](Context& c) { store_state_fixed(get(c, pname), params); }); })},
    {"glGetFloatv", function([](GLenum pname, GLfloat* data) { return outside_begin([&](Context& c) { store(get(c, pname), data); }); })},
    {"glGetIntegerv", function([](GLenum pname, GLint* data) { return outside_begin([&](Context& c) { store(get(c, pname), data); }); })},
    {"glGetLightfv", function([](GLenum light_, GLenum pname, GLfloat* params) { return outside_begin([&](Context& c) { store(get_light(c, light_, pname), params); }); })},
    {"glGetLightiv", function([](GLenum light_, GLenum pname, GLint* params) { return outside_begin([&](Context& c) { store(get_light(c, light_, pname), params); }); })},
    {"glGetLightxv", function([](GLenum light_, GLenum pname, GLfixed* params) { return outside_begin([&](Context& c) { store_fixed(get_light(c, light_, pname), params); }); })},
    {"glGetMapdv", function([](GLenum target, GLenum query, GLdouble* v) { return outside_begin([&](Context& c) { store(get_map(c, target, query), v); }); })},
    {"glGetMapfv", function([](GLenum target, GLenum query, GLfloat* v) { return outside_begin([&](Context& c) { store(get_map(c, target, query), v); }); })},
    {"glGetMapiv", function([](GLenum target, GLenum query, GLint* v) { return outside_begin([&](Context& c) { store(get_map(c, target, query), v); }); })},
    {"glGetMaterialfv", function([](GLenum face, GLenum pname, GLfloat* params) { return outside_begin([&](Context& c) { store(get_material(c, face, pname), params); }); })},
    {"glGetMaterialiv", function([](GLenum face, GLenum pname, GLint* params) { return outside_begin([&](Context& c) { store(get_material(c, face, pname), params); }); })},
    {"glGetMaterialxv", function([](GLenum face, GLenum pname, GLfixed* params) { return outside_begin([&](Context& c) { store_fixed(get_material(c, face, pname), params); }); })},
    {"glGetPixelMapfv", function([](GLenum map, GLfloat* values) { return outside_begin([&](Context& c) { store(get_pixel_map(c, map), values); }); })},
    {"glGetPixelMapuiv", function([](GLenum map, GLuint* values) { return outside_begin([&](Context& c) { store(get_pixel_map(c, map), values); }); })},
    {"glGetPixelMapusv", function([](GLenum map, GLushort* values) { return outside_begin([&](Context& c) { store(get_pixel_map(c, map), values); }); })},
    {"glGetPointerv", function([](GLenum pname, void** params) { return now<&get_pointer>(pname, params); })},
    {"glGetPolygonStipple", function([](GLubyte* mask) { return now<&get_polygon_stipple>(mask); })},
    {"glGetQueryObjectiv", function([](GLuint id, GLenum pname, GLint* params) { return now<&get_query_object>(id, pname, params); })},
    {"glGetQueryObjectuiv", function([](GLuint id, GLenum pname, GLuint* params) { return now<&get_query_object>(id, pname, reinterpret_cast<GLint*>(params)); })},
    {"glGetQueryiv", function([](GLenum target, GLenum pname, GLint* params) { return now<&get_query>(target, pname, params); })},
    {"glGetString", function([](GLenum name) { return now<&get_string>(name); })},
    {"glGetTexEnvfv", function([](GLenum target, GLenum pname, GLfloat* params) { return outside_begin([&](Context& c) { store(get_tex_env(c, target, pname), params); }); })},
    {"glGetTexEnviv", function([](GLenum target, GLenum pname, GLint* params) { return outside_begin([&](Context& c) { store(get_tex_env(c, target, pname), params); }); })},
    {"glGetTexEnvxv", function([](GLenum target, GLenum pname, GLfixed* params) { return outside_begin([&](Context& c) { store_fixed(get_tex_env(c, target, pname), params); }); })},
    {"glGetTexGendv", function([](GLenum coord, GLenum pname, GLdouble* params) { return outside_begin([&](Context& c) { store(get_tex_gen(c, coord, pname), params); }); })},
    {"glGetTexGenfv", function([](GLenum coord, GLenum pname, GLfloat* params) { return outside_begin([&](Context& c) { store(get_tex_gen(c, coord, pname), params); }); })},
    {"glGetTexGeniv", function([](GLenum coord, GLenum pname, GLint* params) { return outside_begin([&](Context& c) { store(get_tex_gen(c, coord, pname), params); }); })},
    {"glGetTexImage", function([](GLenum target, GLint level, GLenum format, GLenum type, void* pixels) { return now<&get_tex_image>(target, level, format, type, pixels); })},
    {"glGetTexLevelParameterfv", function([](GLenum target, GLint level, GLenum pname, GLfloat* params) { return outside_begin([&](Context& c) { store(get_tex_level_parameter(c, target, level, pname), params); }); })},
    {"glGetTexLevelParameteriv", function([](GLenum target, GLint level, GLenum pname, GLint* params) { return outside_begin([&](Context& c) { store(get_tex_level_parameter(c, target, level, pname), params); }); })},
    {"glGetTexParameterfv", function([](GLenum target, GLenum pname, GLfloat* params) { return outside_begin([&](Context& c) { store(get_tex_parameter(c, target, pname), params); }); })},
    {"glGetTexParameteriv", function([](GLenum target, GLenum pname, GLint* params) { return outside_begin([&](Context& c) { store(get_tex_parameter(c, target, pname), params); }); })},
    {"glGetTexParameterxv", function([](GLenum target, GLenum pname, GLfixed* params) { return outside_begin([&](Context& c) { store_fixed(get_tex_parameter(c, target, pname), params); }); })},
    {"glHint", function([](GLenum target, GLenum mode) { return listed<&hint>(target, mode); })},
    {"glIndexMask", function([](GLuint mask) { return listed<&index_mask>(mask); })},
    {"glIndexPointer", function([](GLenum type, GLsizei stride, const void* pointer) { return now<&array_pointer>(Array::index, 1, type, stride, pointer); })},
    {"glIndexPointerEXT", function([](GLenum type, GLsizei stride, GLsizei, const void* pointer) { return now<&array_pointer>(Array::index, 1, type, stride, pointer); })},
    {"glIndexub", function([](GLubyte c) { return listed_inside<&index>(real(c)); })},
    {"glIndexubv", function([](const GLubyte* c) { return listed_inside<&index>(real(c[0])); })},
    {"glInitNames", function([]() { return listed<&init_names>(); })},
    {"glInterleavedArrays", function([](GLenum format, GLsizei stride, const void* pointer) { return now<&interleaved_arrays>(format, stride, pointer); })},
    {"glIsBuffer", function([](GLuint buffer) { return now<&is_buffer>(buffer); })},
    {"glIsEnabled", function([](GLenum cap) { return now<&is_enabled>(cap); })},
    {"glIsList", function([](GLuint list) { return now<&is_list>(list); })},
    {"glIsQuery", function([](GLuint id) { return now<&is_query>(id); })},
    {"glIsTexture", function([](GLuint texture) { return now<&is_texture>(texture); })},
    {"glLightModelf", function([](GLenum pname, GLfloat param) { return listed<&light_model>(pname, scalar(pname, param)); })},
    {"glLightModelfv", function([](GLenum pname, const GLfloat* params) { return listed<&light_model>(pname, vector(pname, params)); })},
    {"glLightModeli", function([](GLenum pname, GLint param) { return listed<&light_model>(pname, scalar(pname, param)); })},
    {"glLightModeliv", function([](GLenum pname, const GLint* params) { return listed<&light_model>(pname, vector(pname, params)); })},
    {"glLightModelx", function([](GLenum pname, GLfixed param) { return listed<&light_model>(pname, scalar_fixed(pname, param)); })},
    {"glLightModelxv", function([](GLenum pname, const GLfixed* param) { return listed<&light_model>(pname, vector_fixed(pname, param)); })},
    {"glLightf", function([](GLenum light_, GLenum pname, GLfloat param) { return listed<&light>(light_, pname, scalar(pname, param)); })},
    {"glLightfv", function([](GLenum light_, GLenum pname, const GLfloat* params) { return listed<&light>(light_, pname, vector(pname, params)); })},
    {"glLighti", function([](GLenum light_, GLenum pname, GLint param) { return listed<&light>(light_, pname, scalar(pname, param)); })},
    {"glLightiv", function([](GLenum light_, GLenum pname, const GLint* params) { return listed<&light>(light_, pname, vector(pname, params)); })},
    {"glLightx", function([](GLenum light_, GLenum pname, GLfixed param) { return listed<&light>(light_, pname, scalar_fixed(pname, param)); })},
    {"glLightxv", function([](GLenum light_, GLenum pname, const GLfixed* params) { return listed<&light>(light_, pname, vector_fixed(pname, params)); })},
    {"glLineStipple", function([](GLint factor, GLushort pattern) { return listed<&line_stipple>(factor, pattern); })},
    {"glLineWidth", function([](GLfloat width) { return listed<&line_width>(real(width)); })},
    {"glLineWidthx", function([](GLfixed width) { return listed<&line_width>(fixed(width)); })},
    {"glListBase", function([](GLuint base) { return listed<&list_base>(base); })},
    {"glLoadIdentity", function([]() { return listed<&load_identity>(); })},
    {"glLoadMatrixd", function([](const GLdouble* m) { return listed<&load_matrix>(matrix(m)); })},
    {"glLoadMatrixf", function([](const GLfloat* m) { return listed<&load_matrix>(matrix(m)); })},
    {"glLoadMatrixx", function([](const GLfixed* m) { return listed<&load_matrix>(matrix_fixed(m)); })},
    {"glLoadName", function([](GLuint name) { return listed<&load_name>(name); })},
    {"glLoadTransposeMatrixd", function([](const GLdouble* m) { return listed<&load_transpose_matrix>(matrix(m)); })},
    {"glLoadTransposeMatrixf", function([](const GLfloat* m) { return listed<&load_transpose_matrix>(matrix(m)); })},
    {"glLockArraysEXT", function([](GLint, GLsizei) {})},
    {"glLogicOp", function([](GLenum opcode) { return listed<&logic_op>(opcode); })},
    {"glMap1d", function([](GLenum target, GLdouble u1, GLdouble u2, GLint stride, GLint order, const GLdouble* points) { return with_context([&](Context& c) { enter_map1(c, target, u1, u2, stride, order, points); }); })},
    {"glMap1f", function([](GLenum target, GLfloat u1, GLfloat u2, GLint stride, GLint order, const GLfloat* points) { return with_context([&](Context& c) { enter_map1(c, target, u1, u2, stride, order, points); }); })},
    {"glMap2d", function([](GLenum target, GLdouble u1, GLdouble u2, GLint ustride, GLint uorder, GLdouble v1, GLdouble v2, GLint vstride, GLint vorder, const GLdouble* points) { return with_context([&](Context& c) { enter_map2(c, target, u1, u2, ustride, uorder, v1, v2, vstride, vorder, points); }); })},
    {"glMap2f", function([](GLenum target, GLfloat u1, GLfloat u2, GLint ustride, GLint uorder, GLfloat v1, GLfloat v2, GLint vstride, GLint vorder, const GLfloat* points) { return with_context([&](Context& c) { enter_map2(c, target, u1, u2, ustride, uorder, v1, v2, vstride, vorder, points); }); })},
    {"glMapBuffer", function([](GLenum target, GLenum access) { return now<&map_buffer>(target, access); })},
    {"glMapGrid1d", function([](GLint un, GLdouble u1, GLdouble u2) { return listed<&map_grid1>(un, real(u1), real(u2)); })},
    {"glMapGrid1f", function([](GLint un, GLfloat u1, GLfloat u2) { return listed<&map_grid1>(un, real(u1), real(u2)); })},
    {"glMapGrid2d", function([](GLint un, GLdouble u1, GLdouble u2, GLint vn, GLdouble v1, GLdouble v2) { return listed<&map_grid2>(un, real(u1), real(u2), vn, real(v1), real(v2)); })},
    {"glMapGrid2f", function([](GLint un, GLfloat u1, GLfloat u2, GLint vn, GLfloat v1, GLfloat v2) { return listed<&map_grid2>(un, real(u1), real(u2), vn, real(v1), real(v2)); })},
    {"glMaterialf", function([](GLenum face, GLenum pname, GLfloat param) { return listed_inside<&material>(face, pname, scalar(pname, param)); })},
    {"glMaterialfv", function([](GLenum face, GLenum pname, const GLfloat* params) { return listed_inside<&material>(face, pname, vector(pname, params)); })},
    {"glMateriali", function([](GLenum face, GLenum pname, GLint param) { return listed_inside<&material>(face, pname, scalar(pname, param)); })},
    {"glMaterialiv", function([](GLenum face, GLenum pname, const GLint* params) { return listed_inside<&material>(face, pname, vector(pname, params)); })},
    {"glMaterialx", function([](GLenum face, GLenum pname, GLfixed param) { return listed_inside<&material>(face, pname, scalar_fixed(pname, param)); })},
    {"glMaterialxv", function([](GLenum face, GLenum pname, const GLfixed* param) { return listed_inside<&material>(face, pname, vector_fixed(pname, param)); })},
    {"glMatrixMode", function([](GLenum mode) { return listed<&matrix_mode>(mode); })},
    {"glMultMatrixd", function([](const GLdouble* m) { return listed<&mult_matrix>(matrix(m)); })},
    {"glMultMatrixf", function([](const GLfloat* m) { return listed<&mult_matrix>(matrix(m)); })},
    {"glMultMatrixx", function([](const GLfixed* m) { return listed<&mult_matrix>(matrix_fixed(m)); })},
    {"glMultTransposeMatrixd", function([](const GLdouble* m) { return listed<&mult_transpose_matrix>(matrix(m)); })},
    {"glMultTransposeMatrixf", function([](const GLfloat* m) { return listed<&mult_transpose_matrix>(matrix(m)); })},
    {"glMultiDrawArrays", function([](GLenum mode, const GLint* first, const GLsizei* count, GLsizei drawcount) { return now_inside<&multi_draw_arrays>(mode, first, count, drawcount); })},
    {"glMultiDrawElements", function([](GLenum mode, const GLsizei* count, GLenum type, const void*const* indices, GLsizei drawcount) { return now_inside<&multi_draw_elements>(mode, count, type, indices, drawcount); })},
    {"glMultiTexCoord4x", function([](GLenum texture, GLfixed s, GLfixed t, GLfixed r, GLfixed q) { return listed_inside<&tex_coord>(texture, fixed(s), fixed(t), fixed(r), fixed(q)); })},
    {"glNewList", function([](GLuint list, GLenum mode) { return now<&new_list>(list, mode); })},
    {"glNormal3x", function([](GLfixed nx, GLfixed ny, GLfixed nz) { return listed_inside<&normal>(fixed(nx), fixed(ny), fixed(nz)); })},
    {"glNormalPointer", function([](GLenum type, GLsizei stride, const void* pointer) { return now<&array_pointer>(Array::normal, 3, type, stride, pointer); })},
    {"glNormalPointerEXT", function([](GLenum type, GLsizei stride, GLsizei, const void* pointer) { return now<&array_pointer>(Array::normal, 3, type, stride, pointer); })},
    {"glOrtho", function([](GLdouble left, GLdouble right, GLdouble bottom, GLdouble top, GLdouble zNear, GLdouble zFar) { return listed<&ortho>(real(left), real(right), real(bottom), real(top), real(zNear), real(zFar)); })},
    {"glOrthof", function([](GLfloat l, GLfloat r, GLfloat b, GLfloat t, GLfloat n, GLfloat f) { return listed<&ortho>(real(l), real(r), real(b), real(t), real(n), real(f)); })},
    {"glOrthox", function([](GLfixed l, GLfixed r, GLfixed b, GLfixed t, GLfixed n, GLfixed f) { return listed<&ortho>(fixed(l), fixed(r), fixed(b), fixed(t), fixed(n), fixed(f)); })},
    {"glPassThrough", function([](GLfloat token) { return listed<&pass_through>(real(token)); })},
    {"glPixelMapfv", function([](GLenum map, GLsizei mapsize, const GLfloat* values) { return with_context([&](Context& c) { enter_pixel_map(c, map, mapsize, values); }); })},
    {"glPixelMapuiv", function([](GLenum map, GLsizei mapsize, const GLuint* values) { return with_context([&](Context& c) { enter_pixel_map(c, map, mapsize, values); }); })},
    {"glPixelMapusv", function([](GLenum map, GLsizei mapsize, const GLushort* values) { return with_context([&](Context& c) { enter_pixel_map(c, map, mapsize, values); }); })},
    {"glPixelStoref", function([](GLenum pname, GLfloat param) { return now<&pixel_store>(pname, real(param)); })},
    {"glPixelStorei", function([](GLenum pname, GLint param) { return now<&pixel_store>(pname, real(param)); })},
    {"glPixelTransferf", function([](GLenum pname, GLfloat param) { return listed<&pixel_transfer>(pname, real(param)); })},
    {"glPixelTransferi", function([](GLenum pname, GLint param) { return listed<&pixel_transfer>(pname, real(param)); })},
    {"glPixelZoom", function([](GLfloat xfactor, GLfloat yfactor) { return listed<&pixel_zoom>(real(xfactor), real(yfactor)); })},
    {"glPointParameterf", function([](GLenum pname, GLfloat param) { return listed<&point_parameter>(pname, scalar(pname, param)); })},
    {"glPointParameterfv", function([](GLenum pname, const GLfloat* params) { return listed<&point_parameter>(pname, vector(pname, params)); })},
    {"glPointParameteri", function([](GLenum pname, GLint param) { return listed<&point_parameter>(pname, scalar(pname, param)); })},
    {"glPointParameteriv", function([](GLenum pname, const GLint* params) { return listed<&point_parameter>(pname, vector(pname, params)); })},
    {"glPointParameterx", function([](GLenum pname, GLfixed param) { return listed<&point_parameter>(pname, scalar_fixed(pname, param)); })},
    {"glPointParameterxv", function([](GLenum pname, const GLfixed* params) { return listed<&point_parameter>(pname, vector_fixed(pname, params)); })},
    {"glPointSize", function([](GLfloat size) { return listed<&point_size>(real(size)); })},
    {"glPointSizePointerOES", function([](GLenum type, GLsizei stride, const void* pointer) { return now<&array_pointer>(Array::point_size, 1, type, stride, pointer); })},
    {"glPointSizex", function([](GLfixed size) { return listed<&point_size>(fixed(size)); })},
    {"glPolygonMode", function([](GLenum face, GLenum mode) { return listed<&polygon_mode>(face, mode); })},
    {"glPolygonOffset", function([](GLfloat factor, GLfloat units) { return listed<&polygon_offset>(real(factor), real(units)); })},
    {"glPolygonOffsetx", function([](GLfixed factor, GLfixed units) { return listed<&polygon_offset>(fixed(factor), fixed(units)); })},
    {"glPolygonStipple", function([](const GLubyte* mask) { return with_context([&](Context& c) { enter_polygon_stipple(c, mask); }); })},
    {"glPopAttrib", function([]() { return listed<&pop_attrib>(); })},
    {"glPopClientAttrib", function([]() { return now<&pop_client_attrib>(); })},
    {"glPopMatrix", function([]() { return listed<&pop_matrix>(); })},
    {"glPopName", function([]() { return listed<&pop_name>(); })},
    {"glPrioritizeTextures", function([](GLsizei n, const GLuint* textures, const GLfloat* priorities) { return with_context([&](Context& c) { enter_prioritize_textures(c, n, textures, priorities); }); })},
    {"glPushAttrib", function([](GLbitfield mask) { return listed<&push_attrib>(mask); })},
    {"glPushClientAttrib", function([](GLbitfield mask) { return now<&push_client_attrib>(mask); })},
    {"glPushMatrix", function([]() { return listed<&push_matrix>(); })},
    {"glPushName", function([](GLuint name) { return listed<&push_name>(name); })},
    {"glReadBuffer", function([](GLenum src) { return listed<&read_buffer>(src); })},
    {"glReadPixels", function([](GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type, void* pixels) { return now<&read_pixels>(x, y, width, height, format, type, pixels); })},
    {"glRectd", function([](GLdouble x1, GLdouble y1, GLdouble x2, GLdouble y2) { return listed<&rect>(real(x1), real(y1), real(x2), real(y2)); })},
    {"glRectdv", function([](const GLdouble* v1, const GLdouble* v2) { return listed<&rect>(real(v1[0]), real(v1[1]), real(v2[0]), real(v2[1])); })},
    {"glRectf", function([](GLfloat x1, GLfloat y1, GLfloat x2, GLfloat y2) { return listed<&rect>(real(x1), real(y1), real(x2), real(y2)); })},
    {"glRectfv", function([](const GLfloat* v1, const GLfloat* v2) { return listed<&rect>(real(v1[0]), real(v1[1]), real(v2[0]), real(v2[1])); })},
    {"glRecti", function([](GLint x1, GLint y1, GLint x2, GLint y2) { return listed<&rect>(real(x1), real(y1), real(x2), real(y2)); })},
    {"glRectiv", function([](const GLint* v1, const GLint* v2) { return listed<&rect>(real(v1[0]), real(v1[1]), real(v2[0]), real(v2[1])); })},
    {"glRects", function([](GLshort x1, GLshort y1, GLshort x2, GLshort y2) { return listed<&rect>(real(x1), real(y1), real(x2), real(y2)); })},
    {"glRectsv", function([](const GLshort* v1, const GLshort* v2) { return listed<&rect>(real(v1[0]), real(v1[1]), real(v2[0]), real(v2[1])); })},
    {"glRenderMode", function([](GLenum mode) { return now<&set_render_mode>(mode); })},
    {"glRotated", function([](GLdouble angle, GLdouble x, GLdouble y, GLdouble z) { return listed<&rotate>(real(angle), real(x), real(y), real(z)); })},
    {"glRotatef", function([](GLfloat angle, GLfloat x, GLfloat y, GLfloat z) { return listed<&rotate>(real(angle), real(x), real(y), real(z)); })},
    {"glRotatex", function([](GLfixed angle, GLfixed x, GLfixed y, GLfixed z) { return listed<&rotate>(fixed(angle), fixed(x), fixed(y), fixed(z)); })},
    {"glSampleCoverage", function([](GLfloat value, GLboolean invert) { return listed<&sample_coverage>(real(value), invert); })},
    {"glSampleCoveragex", function([](GLfixed value, GLboolean invert) { return listed<&sample_coverage>(fixed(value), invert); })},
    {"glScaled", function([](GLdouble x, GLdouble y, GLdouble z) { return listed<&scale>(real(x), real(y), real(z)); })},
    {"glScalef", function([](GLfloat x, GLfloat y, GLfloat z) { return listed<&scale>(real(x), real(y), real(z)); })},
    {"glScalex", function([](GLfixed x, GLfixed y, GLfixed z) { return listed<&scale>(fixed(x), fixed(y), fixed(z)); })},
    {"glScissor", function([](GLint x, GLint y, GLsizei width, GLsizei height) { return listed<&scissor>(x, y, width, height); })},
    {"glSecondaryColorPointer", function([](GLint size, GLenum type, GLsizei stride, const void* pointer) { return now<&array_pointer>(Array::secondary_color, size, type, stride, pointer); })},
    {"glSelectBuffer", function([](GLsizei size, GLuint* buffer) { return now<&select_buffer>(size, buffer); })},
    {"glShadeModel", function([](GLenum mode) { return listed<&shade_model>(mode); })},
    {"glStencilFunc", function([](GLenum func, GLint ref, GLuint mask) { return listed<&stencil_func>(func, ref, mask); })},
    {"glStencilMask", function([](GLuint mask) { return listed<&stencil_mask>(mask); })},
    {"glStencilOp", function([](GLenum fail, GLenum zfail, GLenum zpass) { return listed<&stencil_op>(fail, zfail, zpass); })},
    {"glTexCoordPointer", function([](GLint size, GLenum type, GLsizei stride, const void* pointer) { return now<&array_pointer>(Array::tex_coord, size, type, stride, pointer); })},
    {"glTexCoordPointerEXT", function([](GLint size, GLenum type, GLsizei stride, GLsizei, const void* pointer) { return now<&array_pointer>(Array::tex_coord, size, type, stride, pointer); })},
    {"glTexEnvf", function([](GLenum target, GLenum pname, GLfloat param) { return listed<&tex_env>(target, pname, scalar(pname, param)); })},
    {"glTexEnvfv", function([](GLenum target, GLenum pname, const GLfloat* params) { return listed<&tex_env>(target, pname, vector(pname, params)); })},
    {"glTexEnvi", function([](GLenum target, GLenum pname, GLint param) { return listed<&tex_env>(target, pname, scalar(pname, param)); })},
    {"glTexEnviv", function([](GLenum target, GLenum pname, const GLint* params) { return listed<&tex_env>(target, pname, vector(pname, params)); })},
    {"glTexEnvx", function([](GLenum target, GLenum pname, GLfixed param) { return listed<&tex_env>(target, pname, scalar_fixed(pname, param)); })},
    {"glTexEnvxv", function([](GLenum target, GLenum pname, const GLfixed* params) { return listed<&tex_env>(target, pname, vector_fixed(pname, params)); })},
    {"glTexGend", function([](GLenum coord, GLenum pname, GLdouble param) { return listed<&tex_gen>(coord, pname, scalar(pname, param)); })},
    {"glTexGendv", function([](GLenum coord, GLenum pname, const GLdouble* params) { return listed<&tex_gen>(coord, pname, vector(pname, params)); })},
    {"glTexGenf", function([](GLenum coord, GLenum pname, GLfloat param) { return listed<&tex_gen>(coord, pname, scalar(pname, param)); })},
    {"glTexGenfv", function([](GLenum coord, GLenum pname, const GLfloat* params) { return listed<&tex_gen>(coord, pname, vector(pname, params)); })},
    {"glTexGeni", function([](GLenum coord, GLenum pname, GLint param) { return listed<&tex_gen>(coord, pname, scalar(pname, param)); })},
    {"glTexGeniv", function([](GLenum coord, GLenum pname, const GLint* params) { return listed<&tex_gen>(coord, pname, vector(pname, params)); })},
    {"glTexImage1D", function([](GLenum target, GLint level, GLint internalformat, GLsizei width, GLint border, GLenum format, GLenum type, const void* pixels) { return with_context([&](Context& c) { enter_tex_image(c, 1, target, level, internalformat, width, 1, 1, border, format, type, pixels); }); })},
    {"glTexImage2D", function([](GLenum target, GLint level, GLint internalformat, GLsizei width, GLsizei height, GLint border, GLenum format, GLenum type, const void* pixels) { return with_context([&](Context& c) { enter_tex_image(c, 2, target, level, internalformat, width, height, 1, border, format, type, pixels); }); })},
    {"glTexImage3D", function([](GLenum target, GLint level, GLint internalformat, GLsizei width, GLsizei height, GLsizei depth, GLint border, GLenum format, GLenum type, const void* pixels) { return with_context([&](Context& c) { enter_tex_image(c, 3, target, level, internalformat, width, height, depth, border, format, type, pixels); }); })},
    {"glTexParameterf", function([](GLenum target, GLenum pname, GLfloat param) { return listed<&tex_parameter>(target, pname, scalar(pname, param)); })},
    {"glTexParameterfv", function([](GLenum target, GLenum pname, const GLfloat* params) { return listed<&tex_parameter>(target, pname, vector(pname, params)); })},
    {"glTexParameteri", function([](GLenum target, GLenum pname, GLint param) { return listed<&tex_parameter>(target, pname, scalar(pname, param)); })},
    {"glTexParameteriv", function([](GLenum target, GLenum pname, const GLint* params) { return listed<&tex_parameter>(target, pname, vector(pname, params)); })},
    {"glTexParameterx", function([](GLenum target, GLenum pname, GLfixed param) { return listed<&tex_parameter>(target, pname, scalar_fixed(pname, param)); })},
    {"glTexParameterxv", function([](GLenum target, GLenum pname, const GLfixed* params) { return listed<&tex_parameter>(target, pname, vector_fixed(pname, params)); })},
    {"glTexSubImage1D", function([](GLenum target, GLint level, GLint xoffset, GLsizei width, GLenum format, GLenum type, const void* pixels) { return with_context([&](Context& c) { enter_tex_sub_image(c, 1, target, level, xoffset, 0, 0, width, 1, 1, format, type, pixels); }); })},
    {"glTexSubImage2D", function([](GLenum target, GLint level, GLint xoffset, GLint yoffset, GLsizei width, GLsizei height, GLenum format, GLenum type, const void* pixels) { return with_context([&](Context& c) { enter_tex_sub_image(c, 2, target, level, xoffset, yoffset, 0, width, height, 1, format, type, pixels); }); })},
    {"glTexSubImage3D", function([](GLenum target, GLint level, GLint xoffset, GLint yoffset, GLint zoffset, GLsizei width, GLsizei height, GLsizei depth, GLenum format, GLenum type, const void* pixels) { return with_context([&](Context& c) { enter_tex_sub_image(c, 3, target, level, xoffset, yoffset, zoffset, width, height, depth, format, type, pixels); }); })},
    {"glTranslated", function([](GLdouble x, GLdouble y, GLdouble z) { return listed<&translate>(real(x), real(y), real(z)); })},
    {"glTranslatef", function([](GLfloat x, GLfloat y, GLfloat z) { return listed<&translate>(real(x), real(y), real(z)); })},
    {"glTranslatex", function([](GLfixed x, GLfixed y, GLfixed z) { return listed<&translate>(fixed(x), fixed(y), fixed(z)); })},
    {"glUnlockArraysEXT", function([]() {})},
    {"glUnmapBuffer", function([](GLenum target) { return now<&unmap_buffer>(target); })},
    {"glVertexPointer", function([](GLint size, GLenum type, GLsizei stride, const void* pointer) { return now<&array_pointer>(Array::vertex, size, type, stride, pointer); })},
    {"glVertexPointerEXT", function([](GLint size, GLenum type, GLsizei stride, GLsizei, const void* pointer) { return now<&array_pointer>(Array::vertex, size, type, stride, pointer); })},
    {"glViewport", function([](GLint x, GLint y, GLsizei width, GLsizei height) { return listed<&viewport>(x, y, width, height); })},
  });
}

// Names of extensions: those of commands with a suffix.
struct Suffixed {
  std::string_view suffix, names;
};
constexpr std::array kSuffixed{
  Suffixed{"ARB",
    "ActiveTexture BeginQuery BindBuffer BufferData BufferSubData ClientActiveTexture CompressedTexImage1D "
    "CompressedTexImage2D CompressedTexImage3D CompressedTexSubImage1D CompressedTexSubImage2D "
    "CompressedTexSubImage3D DeleteBuffers DeleteQueries EndQuery GenBuffers GenQueries GetBufferParameteriv "
    "GetBufferPointerv GetBufferSubData GetCompressedTexImage GetQueryObjectiv GetQueryObjectuiv GetQueryiv "
    "IsBuffer IsQuery LoadTransposeMatrixd LoadTransposeMatrixf MapBuffer MultTransposeMatrixd MultTransposeMatrixf "
    "MultiTexCoord1d MultiTexCoord1dv MultiTexCoord1f MultiTexCoord1fv MultiTexCoord1i MultiTexCoord1iv "
    "MultiTexCoord1s MultiTexCoord1sv MultiTexCoord2d MultiTexCoord2dv MultiTexCoord2f MultiTexCoord2fv "
    "MultiTexCoord2i MultiTexCoord2iv MultiTexCoord2s MultiTexCoord2sv MultiTexCoord3d MultiTexCoord3dv "
    "MultiTexCoord3f MultiTexCoord3fv MultiTexCoord3i MultiTexCoord3iv MultiTexCoord3s MultiTexCoord3sv "
    "MultiTexCoord4d MultiTexCoord4dv MultiTexCoord4f MultiTexCoord4fv MultiTexCoord4i MultiTexCoord4iv "
    "MultiTexCoord4s MultiTexCoord4sv PointParameterf PointParameterfv SampleCoverage UnmapBuffer WindowPos2d "
    "WindowPos2dv WindowPos2f WindowPos2fv WindowPos2i WindowPos2iv WindowPos2s WindowPos2sv WindowPos3d "
    "WindowPos3dv WindowPos3f WindowPos3fv WindowPos3i WindowPos3iv WindowPos3s WindowPos3sv "},
  Suffixed{"EXT",
    "AreTexturesResident ArrayElement BindTexture BlendColor BlendEquation BlendFuncSeparate CopyTexImage1D "
    "CopyTexImage2D CopyTexSubImage1D CopyTexSubImage2D CopyTexSubImage3D DeleteTextures DrawArrays "
    "DrawRangeElements FogCoordPointer FogCoordd FogCoorddv FogCoordf FogCoordfv GenTextures GetPointerv "
    "GetQueryObjectiv IsTexture MultiDrawArrays MultiDrawElements PointParameterf PointParameterfv "
    "PrioritizeTextures SecondaryColor3b SecondaryColor3bv SecondaryColor3d SecondaryColor3dv SecondaryColor3f "
    "SecondaryColor3fv SecondaryColor3i SecondaryColor3iv SecondaryColor3s SecondaryColor3sv SecondaryColor3ub "
    "SecondaryColor3ubv SecondaryColor3ui SecondaryColor3uiv SecondaryColor3us SecondaryColor3usv "
    "SecondaryColorPointer TexImage3D TexSubImage1D TexSubImage2D TexSubImage3D "},
  Suffixed{"INGR",
    "BlendFuncSeparate "},
  Suffixed{"OES",
    "ClearDepthf DepthRangef GetBufferPointerv MapBuffer UnmapBuffer "},
  Suffixed{"KHR",
    "GetPointerv "},
  Suffixed{"SGIS",
    "PointParameterf PointParameterfv "},
  Suffixed{"NV",
    "PointParameteri PointParameteriv PolygonMode "},
  Suffixed{"MESA",
    "WindowPos2d WindowPos2dv WindowPos2f WindowPos2fv WindowPos2i WindowPos2iv WindowPos2s WindowPos2sv "
    "WindowPos3d WindowPos3dv WindowPos3f WindowPos3fv WindowPos3i WindowPos3iv WindowPos3s WindowPos3sv "},
};

EntryPoints all_entry_points() {
  EntryPoints all;
  add_families(all);
  add_others(all);
  for (auto [suffix, names] : kSuffixed)
    for (; !names.empty(); names.remove_prefix(names.find(' ') + 1)) {
      const std::string name = "gl" + std::string(names.substr(0, names.find(' ')));
      all.emplace(name + std::string(suffix), all.at(name));
    }
  return all;
}

}  // namespace

const void* entry_point(std::string_view name) {
  static const EntryPoints all = all_entry_points();
  const auto found = all.find(name);
  return found != all.end() ? found->second : nullptr;
}

}  // namespace halfplane::gl
