// Display lists (OpenGL 1.5, 5.4).
#include "entry_point_case.hpp"

namespace halfplane::gl::list_test {
namespace {

class Lists : public EntryPointCase {
 protected:
  // A list of the calls of `commands`.
  template <class Commands>
  void compile(GLuint name, const Commands& commands, GLenum mode = GL_COMPILE) {
    HALFPLANE_GL(glNewList)(name, mode);
    commands();
    HALFPLANE_GL(glEndList)();
  }
};

TEST_F(Lists, CompiledCommandsWaitForTheCall) {
  compile(3, [] { HALFPLANE_GL(glLineWidth)(5); });
  EXPECT_EQ(integer(GL_LINE_WIDTH), 1);
  HALFPLANE_GL(glCallList)(3);
  EXPECT_EQ(integer(GL_LINE_WIDTH), 5);
  compile(
      3,
      [] {
        HALFPLANE_GL(glLineWidth)
        (7);
      },
      GL_COMPILE_AND_EXECUTE);
  EXPECT_EQ(integer(GL_LINE_WIDTH), 7);
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(Lists, NotEveryCommandIsCompiled) {
  HALFPLANE_GL(glNewList)(1, GL_COMPILE);
  EXPECT_EQ(integer(GL_LIST_INDEX), 1);
  EXPECT_EQ(integer(GL_LIST_MODE), GL_COMPILE);
  HALFPLANE_GL(glPixelStorei)(GL_PACK_ALIGNMENT, 1);
  HALFPLANE_GL(glEnableClientState)(GL_COLOR_ARRAY);
  EXPECT_EQ(integer(GL_PACK_ALIGNMENT), 1);
  EXPECT_EQ(integer(GL_COLOR_ARRAY), 1);
  EXPECT_EQ(HALFPLANE_GL(glIsList)(1), GL_FALSE);  // not before glEndList
  HALFPLANE_GL(glEndList)();
  EXPECT_EQ(HALFPLANE_GL(glIsList)(1), GL_TRUE);
  EXPECT_EQ(integer(GL_LIST_INDEX), 0);
}

TEST_F(Lists, ErrorsComeWhenTheListIsCalled) {
  const auto is_compiled_error = [&](GLenum wanted, auto commands) {
    compile(1, commands);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    HALFPLANE_GL(glCallList)(1);
    EXPECT_EQ(error(), wanted);
  };
  is_compiled_error(GL_INVALID_ENUM, [] { HALFPLANE_GL(glEnable)(GL_FOG_COLOR); });
  is_compiled_error(GL_INVALID_ENUM, [] { HALFPLANE_GL(glDrawPixels)(1, 1, GL_FOG, GL_FLOAT, nullptr); });
  is_compiled_error(GL_INVALID_VALUE, [] { HALFPLANE_GL(glCallLists)(-1, GL_INT, nullptr); });
  is_compiled_error(GL_INVALID_OPERATION, [] { HALFPLANE_GL(glEnd)(); });
}

TEST_F(Lists, ErrorsOfNewAndEnd) {
  HALFPLANE_GL(glEndList)();
  EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
  HALFPLANE_GL(glNewList)(0, GL_COMPILE);
  EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
  HALFPLANE_GL(glNewList)(1, GL_FOG);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  HALFPLANE_GL(glNewList)(1, GL_COMPILE);
  HALFPLANE_GL(glNewList)(2, GL_COMPILE);
  EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
  HALFPLANE_GL(glEndList)();
  HALFPLANE_GL(glDeleteLists)(1, -1);
  EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
  HALFPLANE_GL(glGenLists)(-1);
  EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(Lists, NamesOfEachType) {
  compile(0x102, [] { HALFPLANE_GL(glPointSize)(1); });
  compile(0x10203, [] { HALFPLANE_GL(glPointSize)(2); });
  compile(0x1020304, [] { HALFPLANE_GL(glPointSize)(3); });
  compile(5, [] { HALFPLANE_GL(glPointSize)(4); });
  HALFPLANE_GL(glListBase)(0);
  const auto called = [&](GLenum type, auto values) {
    HALFPLANE_GL(glPointSize)(9);
    HALFPLANE_GL(glCallLists)(1, type, values.data());
    return integer(GL_POINT_SIZE);
  };
  EXPECT_EQ(called(GL_2_BYTES, std::array<GLubyte, 2>{1, 2}), 1);
  EXPECT_EQ(called(GL_3_BYTES, std::array<GLubyte, 3>{1, 2, 3}), 2);
  EXPECT_EQ(called(GL_4_BYTES, std::array<GLubyte, 4>{1, 2, 3, 4}), 3);
  EXPECT_EQ(called(GL_UNSIGNED_INT, std::array<GLuint, 1>{0x10203}), 2);
  EXPECT_EQ(called(GL_FLOAT, std::array<GLfloat, 1>{5.9F}), 4);
  HALFPLANE_GL(glListBase)(6);
  EXPECT_EQ(called(GL_BYTE, std::array<GLbyte, 1>{-1}), 4);
  EXPECT_EQ(called(GL_SHORT, std::array<GLshort, 1>{-1}), 4);
  EXPECT_EQ(called(GL_UNSIGNED_BYTE, std::array<GLubyte, 1>{255}), 9);  // none
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(Lists, ListsCallListsUpToTheLimit) {
  compile(1, [] {
    HALFPLANE_GL(glTranslatef)(1, 0, 0);
    HALFPLANE_GL(glCallList)(1);
  });
  HALFPLANE_GL(glCallList)(1);
  EXPECT_EQ(floats<16>(GL_MODELVIEW_MATRIX)[12], 64);
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(Lists, AListThatRunsIsItsLastDefinition) {
  compile(2, [] { HALFPLANE_GL(glPointSize)(2); });
  compile(1, [] { HALFPLANE_GL(glCallList)(2); });
  compile(2, [] { HALFPLANE_GL(glPointSize)(3); });
  HALFPLANE_GL(glCallList)(1);
  EXPECT_EQ(integer(GL_POINT_SIZE), 3);
  HALFPLANE_GL(glDeleteLists)(2, 1);
  HALFPLANE_GL(glPointSize)(1);
  HALFPLANE_GL(glCallList)(1);
  EXPECT_EQ(integer(GL_POINT_SIZE), 1);
}

TEST_F(Lists, ArgumentsAreReadWhenCompiled) {
  std::array<float, 3> color{1, 0, 0};
  std::array<GLubyte, 128> stipple{};
  compile(1, [&] {
    HALFPLANE_GL(glColor3fv)(color.data());
    HALFPLANE_GL(glPolygonStipple)(stipple.data());
    HALFPLANE_GL(glMap1f)(GL_MAP1_INDEX, 0, 1, 1, 3, color.data());
  });
  color.fill(0.5F);
  stipple.fill(255);
  HALFPLANE_GL(glCallList)(1);
  EXPECT_EQ(floats<4>(GL_CURRENT_COLOR), (std::array<float, 4>{1, 0, 0, 1}));
  EXPECT_EQ(context.state.stipple.row[5], 0U);
  std::array<float, 3> read{};
  HALFPLANE_GL(glGetMapfv)(GL_MAP1_INDEX, GL_COEFF, read.data());
  EXPECT_EQ(read, (std::array<float, 3>{1, 0, 0}));
}

TEST_F(Lists, ProxiesAreAskedAtOnce) {
  HALFPLANE_GL(glNewList)(1, GL_COMPILE);
  HALFPLANE_GL(glTexImage2D)(GL_PROXY_TEXTURE_2D, 0, GL_RGBA, 64, 32, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  int width = 0;
  HALFPLANE_GL(glGetTexLevelParameteriv)(GL_PROXY_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
  EXPECT_EQ(width, 64);
  HALFPLANE_GL(glEndList)();
}

TEST_F(Lists, GeneratedNamesAreFreeAndInARow) {
  const GLuint first = HALFPLANE_GL(glGenLists)(3);
  for (GLuint i = 0; i < 3; ++i) EXPECT_EQ(HALFPLANE_GL(glIsList)(first + i), GL_TRUE);
  compile(~GLuint{0}, [] {});
  const GLuint second = HALFPLANE_GL(glGenLists)(5);
  EXPECT_EQ(second, first + 3);
  HALFPLANE_GL(glDeleteLists)(first + 1, 1);
  EXPECT_EQ(HALFPLANE_GL(glGenLists)(1), first + 1);
  HALFPLANE_GL(glDeleteLists)(1, 2147483647);
  EXPECT_EQ(HALFPLANE_GL(glIsList)(second), GL_FALSE);
  EXPECT_EQ(HALFPLANE_GL(glGenLists)(0), 0U);
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(Lists, ContextsShareThem) {
  Context other(context.shared);
  make_current(&other, &drawable, &drawable);
  compile(1, [] { HALFPLANE_GL(glPointSize)(6); });
  make_current(&context, &drawable, &drawable);
  HALFPLANE_GL(glCallList)(1);
  EXPECT_EQ(integer(GL_POINT_SIZE), 6);
  EXPECT_EQ(other.state.point.size, 1);
}

TEST_F(Lists, BeginMayBeInOneAndEndInAnother) {
  compile(1, [] { HALFPLANE_GL(glBegin)(GL_POINTS); });
  compile(2, [] { HALFPLANE_GL(glEnd)(); });
  HALFPLANE_GL(glCallList)(1);
  EXPECT_TRUE(context.inside_begin());
  HALFPLANE_GL(glVertex2f)(0, 0);
  HALFPLANE_GL(glCallLists)(1, GL_UNSIGNED_BYTE, std::array<GLubyte, 1>{2}.data());
  EXPECT_FALSE(context.inside_begin());
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(Lists, VerticesLeaveWhatTheListDoesNotSet) {
  compile(1, [] {
    HALFPLANE_GL(glBegin)(GL_POINTS);
    HALFPLANE_GL(glVertex2f)(0, 0);
    HALFPLANE_GL(glEnd)();
  });
  HALFPLANE_GL(glEdgeFlag)(GL_FALSE);
  HALFPLANE_GL(glCallList)(1);
  EXPECT_FALSE(context.state.current.edge_flag);
}

TEST_F(Lists, VerticesTakeFromTheCallWhatTheListDoesNotSet) {
  const std::array<void (*)(), 2> calls{[] {  // all vertices have a coordinate of the list's
                                          HALFPLANE_GL(glBegin)(GL_POINTS);
                                          HALFPLANE_GL(glTexCoord2f)(1, 2);
                                          HALFPLANE_GL(glVertex2f)(0, 0);
                                          HALFPLANE_GL(glVertex2f)(0.5F, 0);
                                          HALFPLANE_GL(glTexCoord2f)(3, 4);
                                          HALFPLANE_GL(glEnd)();
                                        },
                                        [] {  // the first one has the current one
                                          HALFPLANE_GL(glBegin)(GL_POINTS);
                                          HALFPLANE_GL(glVertex2f)(0, 0);
                                          HALFPLANE_GL(glTexCoord2f)(3, 4);
                                          HALFPLANE_GL(glVertex2f)(0.5F, 0);
                                          HALFPLANE_GL(glEnd)();
                                        }};
  const auto fed = [&](const auto& draw) {
    std::vector<float> buffer(64);
    HALFPLANE_GL(glFeedbackBuffer)(64, GL_4D_COLOR_TEXTURE, buffer.data());
    HALFPLANE_GL(glRenderMode)(GL_FEEDBACK);
    HALFPLANE_GL(glColor3f)(0.5F, 0.25F, 1);
    HALFPLANE_GL(glTexCoord2f)(5, 6);
    draw();
    EXPECT_EQ(context.state.current.tex_coord[0], (Vec4{3, 4, 0, 1}));
    buffer.resize(static_cast<std::size_t>(HALFPLANE_GL(glRenderMode)(GL_RENDER)));
    return buffer;
  };
  HALFPLANE_GL(glViewport)(0, 0, 8, 8);
  for (GLuint list = 1; list <= 2; ++list) {
    compile(list, calls[list - 1]);
    const std::vector<float> at_once = fed(calls[list - 1]);
    EXPECT_EQ(at_once.size(), 2U * 13);
    EXPECT_EQ(fed([&] { HALFPLANE_GL(glCallList)(list); }), at_once);
    // Within a primitive its glBegin is an error, and the vertices and glEnd are that primitive's.
    HALFPLANE_GL(glBegin)(GL_POINTS);
    HALFPLANE_GL(glVertex2f)(0, 0);
    HALFPLANE_GL(glCallList)(list);
    EXPECT_EQ(context.input.size(), 3U);
    EXPECT_FALSE(context.inside_begin());
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
  }
}

}  // namespace
}  // namespace halfplane::gl::list_test
