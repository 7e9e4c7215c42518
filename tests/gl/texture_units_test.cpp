// State of two texture units through the entry points: each has its own, attributes and display lists bring it back, arrays
// and coordinates go to the unit that is named (OpenGL 1.5, 2.7, 2.8, 2.11.2, 3.8.16 and table 6.17).
#include <array>
#include <string>

#include "entry_point_case.hpp"

namespace halfplane::gl::texture_units_test {
namespace {

class TextureUnits : public EntryPointCase {
 protected:
  static void activate(GLenum unit) { HALFPLANE_GL(glActiveTexture)(unit); }
  int environment(GLenum pname) {
    int value = -77;
    HALFPLANE_GL(glGetTexEnviv)(GL_TEXTURE_ENV, pname, &value);
    return value;
  }
};

constexpr std::array<GLenum, 2> kUnits{GL_TEXTURE0, GL_TEXTURE1};

TEST_F(TextureUnits, ThereAreTwo) {
  EXPECT_EQ(integer(GL_MAX_TEXTURE_UNITS), 2);
  const std::string extensions = reinterpret_cast<const char*>(HALFPLANE_GL(glGetString)(GL_EXTENSIONS));
  for (const char* name : {"GL_ARB_multitexture", "GL_ARB_texture_env_combine", "GL_ARB_texture_env_crossbar",
                           "GL_ARB_texture_env_dot3", "GL_ARB_texture_cube_map", "GL_EXT_texture3D", "GL_ARB_shadow"})
    EXPECT_NE((extensions + " ").find(std::string(name) + " "), std::string::npos) << name;
  activate(GL_TEXTURE1);
  EXPECT_EQ(integer(GL_ACTIVE_TEXTURE), GL_TEXTURE1);
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
  for (const GLenum none : {GL_TEXTURE2, GL_TEXTURE0 - 1, GL_TEXTURE_2D}) {
    activate(none);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    HALFPLANE_GL(glClientActiveTexture)(none);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    HALFPLANE_GL(glTexEnvi)(GL_TEXTURE_ENV, GL_SOURCE0_RGB, static_cast<int>(none));
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  }
  EXPECT_EQ(integer(GL_ACTIVE_TEXTURE), GL_TEXTURE1);
}

TEST_F(TextureUnits, EachHasItsOwnState) {
  for (const GLenum unit : kUnits) {
    const int i = static_cast<int>(unit - GL_TEXTURE0);
    activate(unit);
    HALFPLANE_GL(glBindTexture)(GL_TEXTURE_2D, static_cast<GLuint>(7 + i));
    (i == 0 ? HALFPLANE_GL(glDisable) : HALFPLANE_GL(glEnable))(GL_TEXTURE_2D);
    (i == 0 ? HALFPLANE_GL(glEnable) : HALFPLANE_GL(glDisable))(GL_TEXTURE_GEN_S);
    HALFPLANE_GL(glTexGeni)(GL_S, GL_TEXTURE_GEN_MODE, i == 0 ? GL_SPHERE_MAP : GL_OBJECT_LINEAR);
    HALFPLANE_GL(glTexEnvi)(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, i == 0 ? GL_ADD : GL_COMBINE);
    HALFPLANE_GL(glTexEnvi)(GL_TEXTURE_ENV, GL_SOURCE1_RGB, i == 0 ? GL_TEXTURE1 : GL_TEXTURE0);
    HALFPLANE_GL(glTexEnvf)(GL_TEXTURE_ENV, GL_RGB_SCALE, i == 0 ? 4 : 2);
    HALFPLANE_GL(glMultiTexCoord3f)(unit, 1.0F + static_cast<float>(i), 5, 6);
    HALFPLANE_GL(glMatrixMode)(GL_TEXTURE);
    HALFPLANE_GL(glLoadIdentity)();
    HALFPLANE_GL(glTranslatef)(3.0F + static_cast<float>(i), 0, 0);
    if (i == 1) HALFPLANE_GL(glPushMatrix)();
  }
  for (const GLenum unit : kUnits) {
    SCOPED_TRACE(unit);
    const int i = static_cast<int>(unit - GL_TEXTURE0);
    activate(unit);
    EXPECT_EQ(integer(GL_TEXTURE_BINDING_2D), 7 + i);
    EXPECT_EQ(HALFPLANE_GL(glIsEnabled)(GL_TEXTURE_2D), i == 1);
    EXPECT_EQ(HALFPLANE_GL(glIsEnabled)(GL_TEXTURE_GEN_S), i == 0);
    int mode = 0;
    HALFPLANE_GL(glGetTexGeniv)(GL_S, GL_TEXTURE_GEN_MODE, &mode);
    EXPECT_EQ(mode, i == 0 ? GL_SPHERE_MAP : GL_OBJECT_LINEAR);
    EXPECT_EQ(environment(GL_TEXTURE_ENV_MODE), i == 0 ? GL_ADD : GL_COMBINE);
    EXPECT_EQ(environment(GL_SOURCE1_RGB), i == 0 ? GL_TEXTURE1 : GL_TEXTURE0);
    EXPECT_EQ(environment(GL_RGB_SCALE), i == 0 ? 4 : 2);
    EXPECT_EQ(floats<4>(GL_CURRENT_TEXTURE_COORDS), (std::array<float, 4>{1.0F + static_cast<float>(i), 5, 6, 1}));
    EXPECT_EQ(floats<16>(GL_TEXTURE_MATRIX)[12], 3.0F + static_cast<float>(i));
    EXPECT_EQ(integer(GL_TEXTURE_STACK_DEPTH), 1 + i);
  }
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
  activate(GL_TEXTURE0);
  HALFPLANE_GL(glPopMatrix)();
  EXPECT_EQ(error(), GLenum{GL_STACK_UNDERFLOW});
  activate(GL_TEXTURE1);
  HALFPLANE_GL(glPopMatrix)();
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(TextureUnits, AttributesComeBackInBoth) {
  for (const GLbitfield mask : {GLbitfield{GL_TEXTURE_BIT}, GLbitfield{GL_ENABLE_BIT}}) {
    activate(GL_TEXTURE0);
    HALFPLANE_GL(glPushAttrib)(mask);
    for (const GLenum unit : kUnits) {
      activate(unit);
      HALFPLANE_GL(glEnable)(GL_TEXTURE_CUBE_MAP);
      HALFPLANE_GL(glEnable)(GL_TEXTURE_GEN_Q);
      HALFPLANE_GL(glTexEnvi)(GL_TEXTURE_ENV, GL_COMBINE_RGB, GL_DOT3_RGB);
    }
    HALFPLANE_GL(glPopAttrib)();
    EXPECT_EQ(integer(GL_ACTIVE_TEXTURE), mask == GL_TEXTURE_BIT ? GL_TEXTURE0 : GL_TEXTURE1);
    for (const GLenum unit : kUnits) {
      activate(unit);
      EXPECT_EQ(HALFPLANE_GL(glIsEnabled)(GL_TEXTURE_CUBE_MAP), GL_FALSE);
      EXPECT_EQ(HALFPLANE_GL(glIsEnabled)(GL_TEXTURE_GEN_Q), GL_FALSE);
      EXPECT_EQ(environment(GL_COMBINE_RGB), mask == GL_TEXTURE_BIT ? GL_MODULATE : GL_DOT3_RGB);
    }
  }
  HALFPLANE_GL(glMultiTexCoord2f)(GL_TEXTURE1, 3, 4);
  HALFPLANE_GL(glPushAttrib)(GL_CURRENT_BIT);
  HALFPLANE_GL(glMultiTexCoord2f)(GL_TEXTURE1, 8, 9);
  HALFPLANE_GL(glPopAttrib)();
  EXPECT_EQ(context.state.current.tex_coord[1], (Vec4{3, 4, 0, 1}));
}

TEST_F(TextureUnits, DisplayListsHoldThem) {
  HALFPLANE_GL(glNewList)(1, GL_COMPILE);
  activate(GL_TEXTURE1);
  HALFPLANE_GL(glEnable)(GL_TEXTURE_3D);
  HALFPLANE_GL(glMultiTexCoord4s)(GL_TEXTURE1, 1, 2, 3, 4);
  HALFPLANE_GL(glClientActiveTexture)(GL_TEXTURE1);  // at once
  HALFPLANE_GL(glEndList)();
  EXPECT_EQ(integer(GL_ACTIVE_TEXTURE), GL_TEXTURE0);
  EXPECT_EQ(integer(GL_CLIENT_ACTIVE_TEXTURE), GL_TEXTURE1);
  HALFPLANE_GL(glCallList)(1);
  EXPECT_EQ(integer(GL_ACTIVE_TEXTURE), GL_TEXTURE1);
  EXPECT_EQ(HALFPLANE_GL(glIsEnabled)(GL_TEXTURE_3D), GL_TRUE);
  EXPECT_EQ(context.state.current.tex_coord[1], (Vec4{1, 2, 3, 4}));
  EXPECT_EQ(context.state.current.tex_coord[0], (Vec4{0, 0, 0, 1}));
}

TEST_F(TextureUnits, ArraysGoToTheirUnit) {
  const std::array<float, 4> first{0.25F, 0.5F, 1, 1}, second{5, 6, 7, 8};
  for (const GLenum unit : kUnits) {
    HALFPLANE_GL(glClientActiveTexture)(unit);
    HALFPLANE_GL(glEnableClientState)(GL_TEXTURE_COORD_ARRAY);
    HALFPLANE_GL(glTexCoordPointer)(2, GL_FLOAT, 0, unit == GL_TEXTURE0 ? first.data() : second.data());
  }
  HALFPLANE_GL(glArrayElement)(1);
  EXPECT_EQ(context.state.current.tex_coord[0], (Vec4{1, 1, 0, 1}));
  EXPECT_EQ(context.state.current.tex_coord[1], (Vec4{7, 8, 0, 1}));
  HALFPLANE_GL(glPushClientAttrib)(GL_CLIENT_VERTEX_ARRAY_BIT);
  HALFPLANE_GL(glDisableClientState)(GL_TEXTURE_COORD_ARRAY);
  HALFPLANE_GL(glArrayElement)(0);
  EXPECT_EQ(context.state.current.tex_coord[0], (Vec4{0.25, 0.5, 0, 1}));
  EXPECT_EQ(context.state.current.tex_coord[1], (Vec4{7, 8, 0, 1}));
  HALFPLANE_GL(glPopClientAttrib)();
  EXPECT_EQ(HALFPLANE_GL(glIsEnabled)(GL_TEXTURE_COORD_ARRAY), GL_TRUE);
  void* pointer = nullptr;
  HALFPLANE_GL(glGetPointerv)(GL_TEXTURE_COORD_ARRAY_POINTER, &pointer);
  EXPECT_EQ(pointer, second.data());
  // OpenGL ES 1.1's fixed point.
  using MultiTexCoord4x = void (*)(GLenum, GLint, GLint, GLint, GLint);
  reinterpret_cast<MultiTexCoord4x>(const_cast<void*>(entry_point("glMultiTexCoord4x")))(GL_TEXTURE1, 0x8000, 0x10000,
                                                                                         0, 0x10000);
  EXPECT_EQ(context.state.current.tex_coord[1], (Vec4{0.5, 1, 0, 1}));
}

}  // namespace
}  // namespace halfplane::gl::texture_units_test
