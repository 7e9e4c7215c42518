// Selection and feedback.
#include <gtest/gtest.h>

#include <vector>

#include "gl/core/primitive.hpp"
#include "picture.hpp"

namespace halfplane::gl::feedback_test {
namespace {

class GlFeedback : public ::testing::Test {
 protected:
  /// Feedback of `commands`.
  template <class Commands>
  std::vector<float> feedback(GLenum type, const Commands& commands) {
    std::vector<float> buffer(1000);
    feedback_buffer(context_, static_cast<GLsizei>(buffer.size()), type, buffer.data());
    EXPECT_EQ(set_render_mode(context_, GL_FEEDBACK), 0);
    picture_.changed();
    commands();
    const GLint values = set_render_mode(context_, GL_RENDER);
    EXPECT_EQ(picture_.error(), GLenum{GL_NO_ERROR});
    buffer.resize(static_cast<std::size_t>(std::max(values, 0)));
    return buffer;
  }
  template <class Commands>
  std::vector<GLuint> selection(GLint hits, const Commands& commands) {
    std::vector<GLuint> buffer(100, 77);
    select_buffer(context_, static_cast<GLsizei>(buffer.size()), buffer.data());
    EXPECT_EQ(set_render_mode(context_, GL_SELECT), 0);
    picture_.changed();
    commands();
    EXPECT_EQ(set_render_mode(context_, GL_RENDER), hits);
    while (!buffer.empty() && buffer.back() == 77) buffer.pop_back();
    return buffer;
  }

  Picture picture_;
  Context& context_ = picture_.context;
};

using Values = std::vector<float>;

TEST_F(GlFeedback, VerticesOfEachType) {
  color(context_, 1, 0.5, 0.25, 1);
  tex_coord(context_, GL_TEXTURE0, 2, 3, 4, 5);
  const auto point = [&](GLenum type) { return feedback(type, [&] { picture_.draw(GL_POINTS, {{16, 24}}); }); };
  EXPECT_EQ(point(GL_2D), (Values{GL_POINT_TOKEN, 16, 24}));
  EXPECT_EQ(point(GL_3D), (Values{GL_POINT_TOKEN, 16, 24, 0.5}));
  EXPECT_EQ(point(GL_3D_COLOR), (Values{GL_POINT_TOKEN, 16, 24, 0.5, 1, 0.5, 0.25, 1}));
  EXPECT_EQ(point(GL_3D_COLOR_TEXTURE), (Values{GL_POINT_TOKEN, 16, 24, 0.5, 1, 0.5, 0.25, 1, 2, 3, 4, 5}));
  EXPECT_EQ(point(GL_4D_COLOR_TEXTURE), (Values{GL_POINT_TOKEN, 16, 24, 0.5, 1, 1, 0.5, 0.25, 1, 2, 3, 4, 5}));
  EXPECT_EQ(picture_.drawn_pixels(), 0);
}

TEST_F(GlFeedback, PrimitivesAfterClipping) {
  EXPECT_EQ(feedback(GL_2D,
                     [&] {
                       picture_.draw(GL_LINE_STRIP, {{0, 0}, {8, 8}, {8, 128}});
                     }),
            (Values{GL_LINE_RESET_TOKEN, 0, 0, 8, 8, GL_LINE_TOKEN, 8, 8, 8, 64}));
  EXPECT_EQ(feedback(GL_2D,
                     [&] {
                       picture_.draw(GL_LINES, {{0, 0}, {8, 8}, {8, 8}, {4, 4}});
                     }),
            (Values{GL_LINE_RESET_TOKEN, 0, 0, 8, 8, GL_LINE_RESET_TOKEN, 8, 8, 4, 4}));
  EXPECT_EQ(feedback(GL_2D,
                     [&] {
                       picture_.draw(GL_QUADS, {{16, 16}, {48, 16}, {48, 80}, {16, 80}});
                     }),
            (Values{GL_POLYGON_TOKEN, 4, 16, 16, 48, 16, 48, 64, 16, 64}));
  EXPECT_EQ(feedback(GL_2D, [&] { picture_.draw(GL_POINTS, {{-1, 5}, {70, 5}}); }), Values{});
  enable(context_, GL_CULL_FACE, true);
  EXPECT_EQ(feedback(GL_2D, [&] { picture_.draw(GL_TRIANGLES, {{0, 0}, {0, 8}, {8, 0}}); }), Values{});
  enable(context_, GL_CULL_FACE, false);
  polygon_mode(context_, GL_FRONT, GL_LINE);
  EXPECT_EQ(feedback(GL_2D,
                     [&] {
                       picture_.draw(GL_TRIANGLES, {{0, 0}, {8, 0}, {0, 8}});
                     }),
            (Values{GL_LINE_RESET_TOKEN, 0, 0, 8, 0, GL_LINE_TOKEN, 8, 0, 0, 8, GL_LINE_TOKEN, 0, 8, 0, 0}));
  polygon_mode(context_, GL_FRONT, GL_POINT);
  EXPECT_EQ(feedback(GL_2D,
                     [&] {
                       picture_.draw(GL_TRIANGLES, {{1, 1}, {8, 0}, {0, 8}});
                     }),
            (Values{GL_POINT_TOKEN, 1, 1, GL_POINT_TOKEN, 8, 0, GL_POINT_TOKEN, 0, 8}));
}

TEST_F(GlFeedback, TokensOfPixelsAndPassThrough) {
  EXPECT_EQ(feedback(GL_2D,
                     [&] {
                       raster_pos(context_, 5, 6, 0, 1);
                       pass_through(context_, 12);
                       EXPECT_TRUE(feed_raster(context_, GL_BITMAP_TOKEN));
                     }),
            (Values{GL_PASS_THROUGH_TOKEN, 12, GL_BITMAP_TOKEN, 5, 6}));
  pass_through(context_, 12);
  EXPECT_FALSE(feed_raster(context_, GL_BITMAP_TOKEN));
}

TEST_F(GlFeedback, ABufferThatIsTooSmall) {
  Values buffer(5, -1.0F);
  feedback_buffer(context_, 4, GL_2D, buffer.data());
  set_render_mode(context_, GL_FEEDBACK);
  picture_.draw(GL_POINTS, {{1, 1}, {2, 2}});
  EXPECT_EQ(set_render_mode(context_, GL_RENDER), -1);
  EXPECT_EQ(buffer, (Values{GL_POINT_TOKEN, 1, 1, GL_POINT_TOKEN, -1}));
  std::vector<GLuint> names(3, 9);
  select_buffer(context_, 2, names.data());
  set_render_mode(context_, GL_SELECT);
  picture_.draw(GL_POINTS, {{1, 1}});
  EXPECT_EQ(set_render_mode(context_, GL_RENDER), -1);
  EXPECT_EQ(names[2], 9U);
}

TEST_F(GlFeedback, HitsHaveNamesAndDepths) {
  const auto point = [&](double x, double z) {
    picture_.changed();
    begin(context_, GL_POINTS);
    vertex(context_, x, 5, z, 1);
    end(context_);
  };
  constexpr GLuint kAll = ~0U, kHalf = 1U << 31;
  EXPECT_EQ(selection(3,
                      [&] {
                        init_names(context_);
                        push_name(context_, 3);
                        point(5, 1);
                        point(5, 0);
                        push_name(context_, 4);
                        point(99, 0);  // outside
                        load_name(context_, 5);
                        point(5, -1);
                        pop_name(context_);
                        point(99, 0);
                        pop_name(context_);
                        point(5, 0);
                      }),
            (std::vector<GLuint>{1, 0, kHalf, 3, 2, kAll, kAll, 3, 5, 0, kHalf, kHalf}));
  EXPECT_EQ(picture_.drawn_pixels(), 0);
}

TEST_F(GlFeedback, PolygonsThatSurroundTheViewAreHits) {
  const auto hits = [&](GLint count, std::initializer_list<std::array<double, 2>> places) {
    return selection(count, [&] { picture_.draw(GL_QUADS, places); }).size();
  };
  EXPECT_EQ(hits(1, {{-100, -100}, {200, -100}, {200, 200}, {-100, 200}}), 3U);
  EXPECT_EQ(hits(0, {{100, -100}, {200, -100}, {200, 200}, {100, 200}}), 0U);
  polygon_mode(context_, GL_FRONT_AND_BACK, GL_LINE);
  EXPECT_EQ(hits(0, {{-100, -100}, {200, -100}, {200, 200}, {-100, 200}}), 0U);
}

TEST_F(GlFeedback, Errors) {
  const auto is_refused = [&](GLenum code, auto&& command) {
    command();
    EXPECT_EQ(picture_.error(), code);
  };
  std::array<GLuint, 4> names{};
  std::array<GLfloat, 4> values{};
  is_refused(GL_INVALID_OPERATION, [&] { set_render_mode(context_, GL_SELECT); });
  is_refused(GL_INVALID_OPERATION, [&] { set_render_mode(context_, GL_FEEDBACK); });
  is_refused(GL_INVALID_ENUM, [&] { set_render_mode(context_, GL_FILL); });
  is_refused(GL_INVALID_VALUE, [&] { select_buffer(context_, -1, names.data()); });
  is_refused(GL_INVALID_VALUE, [&] { feedback_buffer(context_, -1, GL_2D, values.data()); });
  is_refused(GL_INVALID_ENUM, [&] { feedback_buffer(context_, 4, GL_RGBA, values.data()); });
  is_refused(GL_NO_ERROR, [&] { pop_name(context_); });  // not in GL_SELECT
  select_buffer(context_, 4, names.data());
  set_render_mode(context_, GL_SELECT);
  is_refused(GL_INVALID_OPERATION, [&] { select_buffer(context_, 4, names.data()); });
  is_refused(GL_INVALID_OPERATION, [&] { load_name(context_, 1); });
  is_refused(GL_STACK_UNDERFLOW, [&] { pop_name(context_); });
  for (GLuint i = 0; i < kNameDepth; ++i) push_name(context_, i);
  is_refused(GL_STACK_OVERFLOW, [&] { push_name(context_, 1); });
  EXPECT_EQ(set_render_mode(context_, GL_RENDER), 0);
}

}  // namespace
}  // namespace halfplane::gl::feedback_test
