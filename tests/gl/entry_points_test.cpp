// Entry points: there is one for each command, their conversions (OpenGL 1.5, table 2.6 and 6.1.2), errors, state that they
// change and that glPushAttrib brings back, and any arguments at all.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "../../gl/core/entry_variants.hpp"
#include "entry_point_case.hpp"

namespace halfplane::gl::entry_points_test {
namespace {

class EntryPoints : public EntryPointCase {};

// The commands of OpenGL 1.5 that Khronos' gl.xml lists.
// clang-format off
#define HALFPLANE_COMMANDS(X) \
  X(glAccum) X(glActiveTexture) X(glAlphaFunc) X(glAreTexturesResident) X(glArrayElement) X(glBegin) X(glBeginQuery) \
  X(glBindBuffer) X(glBindTexture) X(glBitmap) X(glBlendColor) X(glBlendEquation) X(glBlendFunc) \
  X(glBlendFuncSeparate) X(glBufferData) X(glBufferSubData) X(glCallList) X(glCallLists) X(glClear) X(glClearAccum) \
  X(glClearColor) X(glClearDepth) X(glClearIndex) X(glClearStencil) X(glClientActiveTexture) X(glClipPlane) \
  X(glColor3b) X(glColor3bv) X(glColor3d) X(glColor3dv) X(glColor3f) X(glColor3fv) X(glColor3i) X(glColor3iv) \
  X(glColor3s) X(glColor3sv) X(glColor3ub) X(glColor3ubv) X(glColor3ui) X(glColor3uiv) X(glColor3us) X(glColor3usv) \
  X(glColor4b) X(glColor4bv) X(glColor4d) X(glColor4dv) X(glColor4f) X(glColor4fv) X(glColor4i) X(glColor4iv) \
  X(glColor4s) X(glColor4sv) X(glColor4ub) X(glColor4ubv) X(glColor4ui) X(glColor4uiv) X(glColor4us) X(glColor4usv) \
  X(glColorMask) X(glColorMaterial) X(glColorPointer) X(glCompressedTexImage1D) X(glCompressedTexImage2D) \
  X(glCompressedTexImage3D) X(glCompressedTexSubImage1D) X(glCompressedTexSubImage2D) X(glCompressedTexSubImage3D) \
  X(glCopyPixels) X(glCopyTexImage1D) X(glCopyTexImage2D) X(glCopyTexSubImage1D) X(glCopyTexSubImage2D) \
  X(glCopyTexSubImage3D) X(glCullFace) X(glDeleteBuffers) X(glDeleteLists) X(glDeleteQueries) X(glDeleteTextures) \
  X(glDepthFunc) X(glDepthMask) X(glDepthRange) X(glDisable) X(glDisableClientState) X(glDrawArrays) X(glDrawBuffer) \
  X(glDrawElements) X(glDrawPixels) X(glDrawRangeElements) X(glEdgeFlag) X(glEdgeFlagPointer) X(glEdgeFlagv) \
  X(glEnable) X(glEnableClientState) X(glEnd) X(glEndList) X(glEndQuery) X(glEvalCoord1d) X(glEvalCoord1dv) \
  X(glEvalCoord1f) X(glEvalCoord1fv) X(glEvalCoord2d) X(glEvalCoord2dv) X(glEvalCoord2f) X(glEvalCoord2fv) \
  X(glEvalMesh1) X(glEvalMesh2) X(glEvalPoint1) X(glEvalPoint2) X(glFeedbackBuffer) X(glFinish) X(glFlush) \
  X(glFogCoordPointer) X(glFogCoordd) X(glFogCoorddv) X(glFogCoordf) X(glFogCoordfv) X(glFogf) X(glFogfv) X(glFogi) \
  X(glFogiv) X(glFrontFace) X(glFrustum) X(glGenBuffers) X(glGenLists) X(glGenQueries) X(glGenTextures) \
  X(glGetBooleanv) X(glGetBufferParameteriv) X(glGetBufferPointerv) X(glGetBufferSubData) X(glGetClipPlane) \
  X(glGetCompressedTexImage) X(glGetDoublev) X(glGetError) X(glGetFloatv) X(glGetIntegerv) X(glGetLightfv) \
  X(glGetLightiv) X(glGetMapdv) X(glGetMapfv) X(glGetMapiv) X(glGetMaterialfv) X(glGetMaterialiv) X(glGetPixelMapfv) \
  X(glGetPixelMapuiv) X(glGetPixelMapusv) X(glGetPointerv) X(glGetPolygonStipple) X(glGetQueryObjectiv) \
  X(glGetQueryObjectuiv) X(glGetQueryiv) X(glGetString) X(glGetTexEnvfv) X(glGetTexEnviv) X(glGetTexGendv) \
  X(glGetTexGenfv) X(glGetTexGeniv) X(glGetTexImage) X(glGetTexLevelParameterfv) X(glGetTexLevelParameteriv) \
  X(glGetTexParameterfv) X(glGetTexParameteriv) X(glHint) X(glIndexMask) X(glIndexPointer) X(glIndexd) X(glIndexdv) \
  X(glIndexf) X(glIndexfv) X(glIndexi) X(glIndexiv) X(glIndexs) X(glIndexsv) X(glIndexub) X(glIndexubv) \
  X(glInitNames) X(glInterleavedArrays) X(glIsBuffer) X(glIsEnabled) X(glIsList) X(glIsQuery) X(glIsTexture) \
  X(glLightModelf) X(glLightModelfv) X(glLightModeli) X(glLightModeliv) X(glLightf) X(glLightfv) X(glLighti) \
  X(glLightiv) X(glLineStipple) X(glLineWidth) X(glListBase) X(glLoadIdentity) X(glLoadMatrixd) X(glLoadMatrixf) \
  X(glLoadName) X(glLoadTransposeMatrixd) X(glLoadTransposeMatrixf) X(glLogicOp) X(glMap1d) X(glMap1f) X(glMap2d) \
  X(glMap2f) X(glMapBuffer) X(glMapGrid1d) X(glMapGrid1f) X(glMapGrid2d) X(glMapGrid2f) X(glMaterialf) \
  X(glMaterialfv) X(glMateriali) X(glMaterialiv) X(glMatrixMode) X(glMultMatrixd) X(glMultMatrixf) \
  X(glMultTransposeMatrixd) X(glMultTransposeMatrixf) X(glMultiDrawArrays) X(glMultiDrawElements) \
  X(glMultiTexCoord1d) X(glMultiTexCoord1dv) X(glMultiTexCoord1f) X(glMultiTexCoord1fv) X(glMultiTexCoord1i) \
  X(glMultiTexCoord1iv) X(glMultiTexCoord1s) X(glMultiTexCoord1sv) X(glMultiTexCoord2d) X(glMultiTexCoord2dv) \
  X(glMultiTexCoord2f) X(glMultiTexCoord2fv) X(glMultiTexCoord2i) X(glMultiTexCoord2iv) X(glMultiTexCoord2s) \
  X(glMultiTexCoord2sv) X(glMultiTexCoord3d) X(glMultiTexCoord3dv) X(glMultiTexCoord3f) X(glMultiTexCoord3fv) \
  X(glMultiTexCoord3i) X(glMultiTexCoord3iv) X(glMultiTexCoord3s) X(glMultiTexCoord3sv) X(glMultiTexCoord4d) \
  X(glMultiTexCoord4dv) X(glMultiTexCoord4f) X(glMultiTexCoord4fv) X(glMultiTexCoord4i) X(glMultiTexCoord4iv) \
  X(glMultiTexCoord4s) X(glMultiTexCoord4sv) X(glNewList) X(glNormal3b) X(glNormal3bv) X(glNormal3d) X(glNormal3dv) \
  X(glNormal3f) X(glNormal3fv) X(glNormal3i) X(glNormal3iv) X(glNormal3s) X(glNormal3sv) X(glNormalPointer) \
  X(glOrtho) X(glPassThrough) X(glPixelMapfv) X(glPixelMapuiv) X(glPixelMapusv) X(glPixelStoref) X(glPixelStorei) \
  X(glPixelTransferf) X(glPixelTransferi) X(glPixelZoom) X(glPointParameterf) X(glPointParameterfv) \
  X(glPointParameteri) X(glPointParameteriv) X(glPointSize) X(glPolygonMode) X(glPolygonOffset) X(glPolygonStipple) \
  X(glPopAttrib) X(glPopClientAttrib) X(glPopMatrix) X(glPopName) X(glPrioritizeTextures) X(glPushAttrib) \
  X(glPushClientAttrib) X(glPushMatrix) X(glPushName) X(glRasterPos2d) X(glRasterPos2dv) X(glRasterPos2f) \
  X(glRasterPos2fv) X(glRasterPos2i) X(glRasterPos2iv) X(glRasterPos2s) X(glRasterPos2sv) X(glRasterPos3d) \
  X(glRasterPos3dv) X(glRasterPos3f) X(glRasterPos3fv) X(glRasterPos3i) X(glRasterPos3iv) X(glRasterPos3s) \
  X(glRasterPos3sv) X(glRasterPos4d) X(glRasterPos4dv) X(glRasterPos4f) X(glRasterPos4fv) X(glRasterPos4i) \
  X(glRasterPos4iv) X(glRasterPos4s) X(glRasterPos4sv) X(glReadBuffer) X(glReadPixels) X(glRectd) X(glRectdv) \
  X(glRectf) X(glRectfv) X(glRecti) X(glRectiv) X(glRects) X(glRectsv) X(glRenderMode) X(glRotated) X(glRotatef) \
  X(glSampleCoverage) X(glScaled) X(glScalef) X(glScissor) X(glSecondaryColor3b) X(glSecondaryColor3bv) \
  X(glSecondaryColor3d) X(glSecondaryColor3dv) X(glSecondaryColor3f) X(glSecondaryColor3fv) X(glSecondaryColor3i) \
  X(glSecondaryColor3iv) X(glSecondaryColor3s) X(glSecondaryColor3sv) X(glSecondaryColor3ub) X(glSecondaryColor3ubv) \
  X(glSecondaryColor3ui) X(glSecondaryColor3uiv) X(glSecondaryColor3us) X(glSecondaryColor3usv) \
  X(glSecondaryColorPointer) X(glSelectBuffer) X(glShadeModel) X(glStencilFunc) X(glStencilMask) X(glStencilOp) \
  X(glTexCoord1d) X(glTexCoord1dv) X(glTexCoord1f) X(glTexCoord1fv) X(glTexCoord1i) X(glTexCoord1iv) X(glTexCoord1s) \
  X(glTexCoord1sv) X(glTexCoord2d) X(glTexCoord2dv) X(glTexCoord2f) X(glTexCoord2fv) X(glTexCoord2i) \
  X(glTexCoord2iv) X(glTexCoord2s) X(glTexCoord2sv) X(glTexCoord3d) X(glTexCoord3dv) X(glTexCoord3f) \
  X(glTexCoord3fv) X(glTexCoord3i) X(glTexCoord3iv) X(glTexCoord3s) X(glTexCoord3sv) X(glTexCoord4d) \
  X(glTexCoord4dv) X(glTexCoord4f) X(glTexCoord4fv) X(glTexCoord4i) X(glTexCoord4iv) X(glTexCoord4s) \
  X(glTexCoord4sv) X(glTexCoordPointer) X(glTexEnvf) X(glTexEnvfv) X(glTexEnvi) X(glTexEnviv) X(glTexGend) \
  X(glTexGendv) X(glTexGenf) X(glTexGenfv) X(glTexGeni) X(glTexGeniv) X(glTexImage1D) X(glTexImage2D) \
  X(glTexImage3D) X(glTexParameterf) X(glTexParameterfv) X(glTexParameteri) X(glTexParameteriv) X(glTexSubImage1D) \
  X(glTexSubImage2D) X(glTexSubImage3D) X(glTranslated) X(glTranslatef) X(glUnmapBuffer) X(glVertex2d) \
  X(glVertex2dv) X(glVertex2f) X(glVertex2fv) X(glVertex2i) X(glVertex2iv) X(glVertex2s) X(glVertex2sv) \
  X(glVertex3d) X(glVertex3dv) X(glVertex3f) X(glVertex3fv) X(glVertex3i) X(glVertex3iv) X(glVertex3s) \
  X(glVertex3sv) X(glVertex4d) X(glVertex4dv) X(glVertex4f) X(glVertex4fv) X(glVertex4i) X(glVertex4iv) \
  X(glVertex4s) X(glVertex4sv) X(glVertexPointer) X(glViewport) X(glWindowPos2d) X(glWindowPos2dv) X(glWindowPos2f) \
  X(glWindowPos2fv) X(glWindowPos2i) X(glWindowPos2iv) X(glWindowPos2s) X(glWindowPos2sv) X(glWindowPos3d) \
  X(glWindowPos3dv) X(glWindowPos3f) X(glWindowPos3fv) X(glWindowPos3i) X(glWindowPos3iv) X(glWindowPos3s) \
  X(glWindowPos3sv)
// clang-format on

/// Parameters as GL/gl.h declares them.
template <class Type>
struct Declared;
template <class R, class... A>
struct Declared<R(A...)> {
  static std::vector<Parameter> parameters() { return {parameter_of<A>()...}; }
};
struct Command {
  const char* name;
  std::vector<Parameter> parameters;
};
std::vector<Command> commands() {
#define HALFPLANE_COMMAND(name) {#name, Declared<decltype(::name)>::parameters()},
  return {HALFPLANE_COMMANDS(HALFPLANE_COMMAND)};
#undef HALFPLANE_COMMAND
}

TEST_F(EntryPoints, EveryCommandHasOneAndOldNamesLeadToTheSame) {
  EXPECT_EQ(commands().size(), 452U);
  for (const auto& [name, parameters] : commands()) {
    const auto found = entry_points().find(name);
    ASSERT_NE(found, entry_points().end()) << name;
    EXPECT_TRUE(std::ranges::equal(found->second.parameters, parameters)) << name;
  }
  for (const auto& [old, name] : {std::pair{"glActiveTextureARB", "glActiveTexture"},
                                  {"glBindBufferARB", "glBindBuffer"},
                                  {"glGenTexturesEXT", "glGenTextures"},
                                  {"glBlendEquationEXT", "glBlendEquation"},
                                  {"glPointParameterfEXT", "glPointParameterf"},
                                  {"glFogCoordfvEXT", "glFogCoordfv"}})
    EXPECT_EQ(entry_point(old), entry_point(name)) << old;
  for (const char* name : {"glLockArraysEXT", "glOrthox", "glGetFixedv", "glDrawTexxvOES", "glVertexPointerEXT"})
    EXPECT_NE(entry_point(name), nullptr) << name;
  for (const char* name : {"", "gl", "glCreateShader", "glVertex5f", "glZ", "color"})
    EXPECT_EQ(entry_point(name), nullptr);
}

TEST_F(EntryPoints, WithoutAContextNothingHappens) {
  make_current(nullptr, nullptr, nullptr);
  HALFPLANE_GL(glColor3f)(1, 0, 0);
  EXPECT_EQ(HALFPLANE_GL(glGetError)(), GLenum{GL_NO_ERROR});
  EXPECT_EQ(HALFPLANE_GL(glGetString)(GL_VERSION), nullptr);
}

TEST_F(EntryPoints, IntegersAreColoursAndNormalsByTheirRange) {
  HALFPLANE_GL(glColor3ub)(255, 0, 51);
  EXPECT_EQ(context.state.current.color, (Vec4{1, 0, 0.2, 1}));
  HALFPLANE_GL(glColor4b)(127, -128, 0, -1);
  EXPECT_EQ(context.state.current.color, (Vec4{1, -1, 1.0 / 255, -1.0 / 255}));
  HALFPLANE_GL(glColor4usv)(std::array<GLushort, 4>{65535, 0, 13107, 65535}.data());
  EXPECT_EQ(context.state.current.color, (Vec4{1, 0, 0.2, 1}));
  HALFPLANE_GL(glColor3i)(2147483647, std::numeric_limits<int>::min(), 0);
  EXPECT_EQ(context.state.current.color, (Vec4{1, -1, 1.0 / 4294967295.0, 1}));
  HALFPLANE_GL(glSecondaryColor3ui)(4294967295U, 0, 0);
  EXPECT_EQ(context.state.current.secondary, (Vec4{1, 0, 0, 1}));
  HALFPLANE_GL(glNormal3s)(32767, -32768, 0);
  EXPECT_EQ(context.state.current.normal, (Vec3{1, -1, 1.0 / 65535}));
  HALFPLANE_GL(glTexCoord2s)(3, -4);  // no colour: as it is
  EXPECT_EQ(context.state.current.tex_coord[0], (Vec4{3, -4, 0, 1}));
  HALFPLANE_GL(glMultiTexCoord3dv)(GL_TEXTURE0, std::array{1.5, 2.5, 3.5}.data());
  EXPECT_EQ(context.state.current.tex_coord[0], (Vec4{1.5, 2.5, 3.5, 1}));
  reinterpret_cast<void (*)(GLfixed, GLfixed, GLfixed, GLfixed)>(const_cast<void*>(entry_point("glColor4x")))(
      0x8000, 0x10000, 0, 0x4000);
  EXPECT_EQ(context.state.current.color, (Vec4{0.5, 1, 0, 0.25}));
}

TEST_F(EntryPoints, StateIsReadInAnyType) {
  HALFPLANE_GL(glColor4d)(1, -1, 0, 0.25);
  std::array<int, 4> integers{};
  HALFPLANE_GL(glGetIntegerv)(GL_CURRENT_COLOR, integers.data());
  EXPECT_EQ(integers, (std::array{2147483647, std::numeric_limits<int>::min(), 0, 536870911}));
  std::array<GLboolean, 4> booleans{};
  HALFPLANE_GL(glGetBooleanv)(GL_CURRENT_COLOR, booleans.data());
  EXPECT_EQ(booleans, (std::array<GLboolean, 4>{1, 1, 0, 1}));
  HALFPLANE_GL(glLineWidth)(2.5F);
  EXPECT_EQ(integer(GL_LINE_WIDTH), 3);
  HALFPLANE_GL(glStencilMask)(0xfffffff0U);
  EXPECT_EQ(integer(GL_STENCIL_WRITEMASK), -16);
  HALFPLANE_GL(glEnable)(GL_FOG);
  EXPECT_EQ(integer(GL_FOG), 1);
  EXPECT_EQ(floats<1>(GL_FOG)[0], 1);
  HALFPLANE_GL(glClearDepth)(1);
  EXPECT_EQ(integer(GL_DEPTH_CLEAR_VALUE), 2147483647);
  int fixed = 0;
  reinterpret_cast<void (*)(GLenum, GLint*)>(const_cast<void*>(entry_point("glGetFixedv")))(GL_LINE_WIDTH, &fixed);
  EXPECT_EQ(fixed, 0x28000);
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(EntryPoints, MatricesAreColumnsOrRows) {
  std::array<float, 16> m{};
  for (std::size_t i = 0; i < m.size(); ++i) m[i] = static_cast<float>(i);
  HALFPLANE_GL(glLoadMatrixf)(m.data());
  EXPECT_EQ(floats<16>(GL_MODELVIEW_MATRIX), m);
  HALFPLANE_GL(glLoadTransposeMatrixf)(m.data());
  EXPECT_EQ(floats<16>(GL_TRANSPOSE_MODELVIEW_MATRIX), m);
  EXPECT_EQ(floats<16>(GL_MODELVIEW_MATRIX)[1], 4);
}

TEST_F(EntryPoints, BetweenBeginAndEndOnlyVerticesAreAllowed) {
  HALFPLANE_GL(glBegin)(GL_TRIANGLES);
  HALFPLANE_GL(glColor3f)(0, 1, 0);
  HALFPLANE_GL(glLineWidth)(3);
  EXPECT_EQ(HALFPLANE_GL(glGetString)(GL_VENDOR), nullptr);
  EXPECT_EQ(HALFPLANE_GL(glGenLists)(1), 0U);
  EXPECT_EQ(error(), 0U);  // glGetError is not allowed either
  HALFPLANE_GL(glEnd)();
  EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
  EXPECT_EQ(integer(GL_LINE_WIDTH), 1);
  HALFPLANE_GL(glEnd)();
  EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(EntryPoints, ErrorsOfArgumentsThatAreReadHere) {
  const std::array<GLubyte, 256> bytes{};
  HALFPLANE_GL(glDrawPixels)(-1, 1, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
  EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
  HALFPLANE_GL(glDrawPixels)(1, 1, GL_RGBA, GL_RGBA, bytes.data());
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  HALFPLANE_GL(glDrawPixels)(1, 1, GL_RGBA, GL_UNSIGNED_SHORT_5_6_5, bytes.data());
  EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
  HALFPLANE_GL(glTexImage2D)(GL_TEXTURE_2D, 0, GL_RGBA, 1 << 30, 1 << 30, 0, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
  EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
  HALFPLANE_GL(glBitmap)(-1, 0, 0, 0, 0, 0, bytes.data());
  EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
  const std::array<float, 64> points{};
  HALFPLANE_GL(glMap1f)(GL_MAP1_VERTEX_3, 0, 1, 2, 4, points.data());
  EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
  HALFPLANE_GL(glMap1f)(GL_MAP2_VERTEX_3, 0, 1, 3, 4, points.data());
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  HALFPLANE_GL(glMap1f)(GL_MAP1_VERTEX_3, 1, 1, 3, 4, points.data());
  EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
  HALFPLANE_GL(glPixelMapfv)(GL_PIXEL_MAP_R_TO_R, 257, points.data());
  EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
  HALFPLANE_GL(glCallLists)(1, GL_DOUBLE, points.data());
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  HALFPLANE_GL(glCallLists)(-1, GL_FLOAT, points.data());
  EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
  HALFPLANE_GL(glEnable)(GL_LIGHT0 + 8);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  std::array<double, 4> plane{7, 7, 7, 7};
  HALFPLANE_GL(glGetClipPlane)(GL_CLIP_PLANE0 + 6, plane.data());
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(plane[0], 7);
  HALFPLANE_GL(glGetFloatv)(GL_TRIANGLES, nullptr);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(EntryPoints, MapsArePacked) {
  std::array<float, 48> points{};
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = static_cast<float>(i);
  HALFPLANE_GL(glMap2f)(GL_MAP2_VERTEX_3, 0, 1, 4, 3, 2, 3, 16, 2, points.data());
  ASSERT_EQ(error(), GLenum{GL_NO_ERROR});
  std::array<float, 18> read{};
  HALFPLANE_GL(glGetMapfv)(GL_MAP2_VERTEX_3, GL_COEFF, read.data());
  EXPECT_EQ(read, (std::array<float, 18>{0, 1, 2, 16, 17, 18, 4, 5, 6, 20, 21, 22, 8, 9, 10, 24, 25, 26}));
}

TEST_F(EntryPoints, PixelMapsAreColoursOrIndices) {
  HALFPLANE_GL(glPixelMapusv)(GL_PIXEL_MAP_R_TO_R, 2, std::array<GLushort, 2>{0, 65535}.data());
  HALFPLANE_GL(glPixelMapuiv)(GL_PIXEL_MAP_I_TO_I, 2, std::array<GLuint, 2>{5, 9}.data());
  EXPECT_EQ(integer(GL_PIXEL_MAP_R_TO_R_SIZE), 2);
  EXPECT_EQ(integer(GL_PIXEL_MAP_G_TO_G_SIZE), 1);
  std::array<float, 2> colors{};
  HALFPLANE_GL(glGetPixelMapfv)(GL_PIXEL_MAP_R_TO_R, colors.data());
  EXPECT_EQ(colors, (std::array<float, 2>{0, 1}));
  std::array<GLuint, 2> numbers{};
  HALFPLANE_GL(glGetPixelMapuiv)(GL_PIXEL_MAP_R_TO_R, numbers.data());
  EXPECT_EQ(numbers, (std::array<GLuint, 2>{0, 4294967295U}));
  HALFPLANE_GL(glGetPixelMapuiv)(GL_PIXEL_MAP_I_TO_I, numbers.data());
  EXPECT_EQ(numbers, (std::array<GLuint, 2>{5, 9}));
}

TEST_F(EntryPoints, StipplesComeBackByPixelStore) {
  std::array<GLubyte, 128> mask{}, read{};
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = static_cast<GLubyte>(i * 37);
  HALFPLANE_GL(glPolygonStipple)(mask.data());
  EXPECT_EQ(context.state.stipple.row[0], std::uint32_t{0} << 24 | 37U << 16 | 74U << 8 | 111U);
  HALFPLANE_GL(glGetPolygonStipple)(read.data());
  EXPECT_EQ(read, mask);
  HALFPLANE_GL(glPixelStorei)(GL_PACK_LSB_FIRST, 1);
  HALFPLANE_GL(glGetPolygonStipple)(read.data());
  EXPECT_EQ(read[1], 0b10100100);  // 37 turned round
}

TEST_F(EntryPoints, QueriesOfLimitsAndStrings) {
  EXPECT_STREQ(reinterpret_cast<const char*>(HALFPLANE_GL(glGetString)(GL_VENDOR)), "Halfplane");
  const std::string version = reinterpret_cast<const char*>(HALFPLANE_GL(glGetString)(GL_VERSION));
  EXPECT_EQ(version.substr(0, 4), "1.5 ");
  EXPECT_NE(HALFPLANE_GL(glGetString)(GL_RENDERER), nullptr);
  const std::string extensions = reinterpret_cast<const char*>(HALFPLANE_GL(glGetString)(GL_EXTENSIONS));
  EXPECT_NE(extensions.find("GL_ARB_vertex_buffer_object "), std::string::npos);
  EXPECT_GE(integer(GL_MAX_LIGHTS), 8);
  EXPECT_GE(integer(GL_MAX_LIST_NESTING), 64);
  EXPECT_GE(integer(GL_MAX_EVAL_ORDER), 8);
  EXPECT_GE(integer(GL_MAX_MODELVIEW_STACK_DEPTH), 32);
  EXPECT_EQ(integer(GL_DOUBLEBUFFER), 1);
  EXPECT_EQ(integer(GL_RED_BITS), 5);                      // embedded
  EXPECT_EQ(integer(GL_COMPRESSED_TEXTURE_FORMATS), -77);  // there is none
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
  EXPECT_EQ(HALFPLANE_GL(glGetString)(GL_FOG), nullptr);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  std::array<float, 8> array{};
  HALFPLANE_GL(glVertexPointer)(2, GL_FLOAT, 8, array.data());
  HALFPLANE_GL(glEnableClientState)(GL_VERTEX_ARRAY);
  void* pointer = nullptr;
  HALFPLANE_GL(glGetPointerv)(GL_VERTEX_ARRAY_POINTER, &pointer);
  EXPECT_EQ(pointer, array.data());
  EXPECT_EQ(integer(GL_VERTEX_ARRAY_SIZE), 2);
  EXPECT_EQ(HALFPLANE_GL(glIsEnabled)(GL_VERTEX_ARRAY), GL_TRUE);
}

TEST_F(EntryPoints, AttributesComeBackByTheirGroup) {
  HALFPLANE_GL(glPushAttrib)(GL_ENABLE_BIT | GL_LINE_BIT | GL_LIST_BIT);
  HALFPLANE_GL(glLineWidth)(4);
  HALFPLANE_GL(glPointSize)(4);
  HALFPLANE_GL(glListBase)(17);
  HALFPLANE_GL(glEnable)(GL_TEXTURE_2D);
  HALFPLANE_GL(glEnable)(GL_LIGHT3);
  HALFPLANE_GL(glDisable)(GL_DITHER);
  EXPECT_EQ(integer(GL_ATTRIB_STACK_DEPTH), 1);
  HALFPLANE_GL(glPopAttrib)();
  EXPECT_EQ(integer(GL_LINE_WIDTH), 1);
  EXPECT_EQ(integer(GL_POINT_SIZE), 4);
  EXPECT_EQ(integer(GL_LIST_BASE), 0);
  EXPECT_EQ(integer(GL_TEXTURE_2D), 0);
  EXPECT_EQ(integer(GL_LIGHT3), 0);
  EXPECT_EQ(integer(GL_DITHER), 1);
  HALFPLANE_GL(glPopAttrib)();
  EXPECT_EQ(error(), GLenum{GL_STACK_UNDERFLOW});
  for (int i = 0; i < 16; ++i) HALFPLANE_GL(glPushAttrib)(GL_ALL_ATTRIB_BITS);
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
  HALFPLANE_GL(glPushAttrib)(0);
  EXPECT_EQ(error(), GLenum{GL_STACK_OVERFLOW});
}

TEST_F(EntryPoints, TexturesComeBackWithTheirParameters) {
  std::array<GLuint, 2> names{};
  HALFPLANE_GL(glGenTextures)(2, names.data());
  HALFPLANE_GL(glBindTexture)(GL_TEXTURE_2D, names[0]);
  HALFPLANE_GL(glTexParameteri)(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  HALFPLANE_GL(glPushAttrib)(GL_TEXTURE_BIT);
  HALFPLANE_GL(glTexParameteri)(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  HALFPLANE_GL(glBindTexture)(GL_TEXTURE_2D, names[1]);
  HALFPLANE_GL(glTexParameteri)(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP);
  HALFPLANE_GL(glPopAttrib)();
  EXPECT_EQ(integer(GL_TEXTURE_BINDING_2D), static_cast<int>(names[0]));
  int value = 0;
  HALFPLANE_GL(glGetTexParameteriv)(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, &value);
  EXPECT_EQ(value, GL_NEAREST);
  HALFPLANE_GL(glBindTexture)(GL_TEXTURE_2D, names[1]);
  HALFPLANE_GL(glGetTexParameteriv)(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, &value);
  EXPECT_EQ(value, GL_CLAMP);
  HALFPLANE_GL(glPushAttrib)(GL_TEXTURE_BIT);
  HALFPLANE_GL(glDeleteTextures)(1, &names[1]);
  HALFPLANE_GL(glPopAttrib)();  // its texture is gone
  EXPECT_EQ(integer(GL_TEXTURE_BINDING_2D), 0);
}

TEST_F(EntryPoints, ClientAttributesComeBack) {
  HALFPLANE_GL(glPushClientAttrib)(GL_CLIENT_PIXEL_STORE_BIT);
  HALFPLANE_GL(glPixelStorei)(GL_PACK_ALIGNMENT, 1);
  HALFPLANE_GL(glEnableClientState)(GL_VERTEX_ARRAY);
  HALFPLANE_GL(glPopClientAttrib)();
  EXPECT_EQ(integer(GL_PACK_ALIGNMENT), 4);
  EXPECT_EQ(integer(GL_VERTEX_ARRAY), 1);
  HALFPLANE_GL(glPushClientAttrib)(GL_CLIENT_VERTEX_ARRAY_BIT);
  HALFPLANE_GL(glPixelStorei)(GL_PACK_ALIGNMENT, 1);
  HALFPLANE_GL(glDisableClientState)(GL_VERTEX_ARRAY);
  HALFPLANE_GL(glPopClientAttrib)();
  EXPECT_EQ(integer(GL_PACK_ALIGNMENT), 1);
  EXPECT_EQ(integer(GL_VERTEX_ARRAY), 1);
  HALFPLANE_GL(glPopClientAttrib)();
  EXPECT_EQ(error(), GLenum{GL_STACK_UNDERFLOW});
}

// Calls an entry point with arguments that a source makes for the type of each parameter.
template <class Source>
void call(const EntryPoint& entry, Source& source) {
  std::vector<std::uint64_t> arguments;
  for (const Parameter& type : entry.parameters) {
    const double number = type.is_pointer ? 0 : source.number(type);
    const auto single = static_cast<float>(number);
    std::uint64_t bits = type.is_pointer   ? reinterpret_cast<std::uintptr_t>(source.zeros())
                         : !type.is_real   ? static_cast<std::uint64_t>(static_cast<std::int64_t>(number))
                         : type.bytes == 8 ? std::bit_cast<std::uint64_t>(number)
                                           : std::bit_cast<std::uint32_t>(single);
    arguments.push_back(bits);
  }
  entry.call(entry.function, arguments.data());
}

struct Zeros {
  std::vector<std::byte> memory = std::vector<std::byte>(1 << 20);
  [[nodiscard]] const void* zeros() const { return memory.data(); }
  static double number(const Parameter&) { return 0; }
};

TEST_F(EntryPoints, EachTakesZerosOnAFreshContext) {
  for (const auto& [name, entry] : entry_points()) {
    SCOPED_TRACE(name);
    Context fresh;
    make_current(&fresh, &drawable, &drawable);
    Zeros zeros;
    call(entry, zeros);
  }
}

TEST_F(EntryPoints, EachTakesZerosWithoutADrawable) {
  for (const auto& [name, entry] : entry_points()) {
    SCOPED_TRACE(name);
    Context fresh;
    make_current(&fresh, nullptr, nullptr);
    Zeros zeros;
    call(entry, zeros);
  }
}

// Enums of OpenGL, small numbers and now and then any number; a byte array of zeros.
struct Noise {
  explicit Noise(std::uint32_t seed) : random(seed) {}
  std::mt19937 random;
  std::vector<std::byte> memory = std::vector<std::byte>(4 << 20);

  std::uint32_t below(std::uint32_t bound) { return static_cast<std::uint32_t>(random() % bound); }
  const void* zeros() {
    std::fill_n(memory.begin(), 1 << 16, std::byte{0});
    return memory.data();
  }
  double number(const Parameter& type) {
    if (type.is_real) {
      constexpr std::array<double, 12> kNumbers{0,
                                                1,
                                                -1,
                                                0.5,
                                                2,
                                                10,
                                                -0.25,
                                                1e30,
                                                -1e30,
                                                64,
                                                std::numeric_limits<double>::quiet_NaN(),
                                                std::numeric_limits<double>::infinity()};
      return kNumbers[below(kNumbers.size())];
    }
    if (!type.is_signed && type.bytes == sizeof(GLuint)) {
      // Ranges where the enums of OpenGL 1.5 lie.
      constexpr std::array<std::array<std::uint32_t, 2>, 14> kRanges{{{0, 16},
                                                                      {0x0100, 8},
                                                                      {0x0200, 8},
                                                                      {0x0300, 10},
                                                                      {0x0400, 16},
                                                                      {0x0b00, 256},
                                                                      {0x0c00, 256},
                                                                      {0x0d00, 256},
                                                                      {0x1000, 64},
                                                                      {0x1200, 16},
                                                                      {0x1400, 16},
                                                                      {0x1900, 16},
                                                                      {0x1e00, 8},
                                                                      {0, 0}}};
      constexpr std::array<std::array<std::uint32_t, 2>, 12> kMore{{{0x1b00, 3},
                                                                    {0x1d00, 2},
                                                                    {0x2100, 4},
                                                                    {0x2200, 4},
                                                                    {0x2300, 4},
                                                                    {0x2400, 8},
                                                                    {0x2500, 4},
                                                                    {0x2600, 4},
                                                                    {0x2700, 4},
                                                                    {0x2800, 4},
                                                                    {0x3000, 6},
                                                                    {0x4000, 8}}};
      constexpr std::array<std::array<std::uint32_t, 2>, 10> kLater{{{0x8000, 128},
                                                                     {0x8060, 32},
                                                                     {0x84c0, 4},
                                                                     {0x84f8, 4},
                                                                     {0x8500, 128},
                                                                     {0x8570, 32},
                                                                     {0x8074, 24},
                                                                     {0x8890, 48},
                                                                     {0x88e0, 12},
                                                                     {0x2900, 2}}};
      const auto pick = [&](const auto& ranges) {
        const auto [first, count] = ranges[below(static_cast<std::uint32_t>(ranges.size()))];
        return first + below(std::max(count, 1U));
      };
      switch (below(8)) {
        case 0: return below(4) == 0 ? static_cast<std::uint32_t>(random()) : below(6);
        case 1: return 1U << below(20);
        case 2:
        case 3: return pick(kRanges);
        case 4:
        case 5: return pick(kMore);
        default: return pick(kLater);
      }
    }
    return type.bytes == 8 ? below(80) - 8.0 : below(12) - 2.0;
  }
};

TEST_F(EntryPoints, AnyCallsInAnyOrderDoNoHarm) {
  const std::vector<std::pair<std::string, EntryPoint>> entries(entry_points().begin(), entry_points().end());
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    Noise noise(seed);
    Context fresh;
    make_current(&fresh, &drawable, &drawable);
    for (int i = 0; i < 2000; ++i) {
      call(entries[noise.below(static_cast<std::uint32_t>(entries.size()))].second, noise);
    }
  }
}

}  // namespace
}  // namespace halfplane::gl::entry_points_test
