// Front and back as two colour buffers.
#include <gtest/gtest.h>

#include <array>

#include "picture.hpp"

namespace halfplane::gl::color_buffers_test {
namespace {

TEST(ColorBuffers, FrontAndBackAreTwoOnceTheFrontIsNamed) {
  Picture p;
  const auto fill = [&](GLenum buffer, double r, double g) {
    p.changed();
    draw_buffer(p.context, buffer);
    clear_color(p.context, r, g, 0, 1);
    clear(p.context, GL_COLOR_BUFFER_BIT);
  };
  const auto read = [&](GLenum buffer) {
    std::array<std::uint8_t, 4> pixel{};
    read_buffer(p.context, buffer);
    read_pixels(p.context, 3, 5, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
    return std::array<int, 2>{pixel[0], pixel[1]};
  };
  constexpr std::array kRed{255, 0}, kGreen{0, 255}, kYellow{255, 255};
  fill(GL_BACK, 1, 0);
  p.drawable.swap();
  EXPECT_EQ(read(GL_FRONT), kRed);
  fill(GL_BACK, 0, 1);
  EXPECT_EQ(read(GL_FRONT), kRed);
  EXPECT_EQ(read(GL_BACK), kGreen);
  fill(GL_FRONT, 1, 1);
  EXPECT_EQ(read(GL_BACK), kGreen);
  EXPECT_EQ(read(GL_FRONT), kYellow);
  push_attrib(p.context, GL_COLOR_BUFFER_BIT);
  fill(GL_BACK, 1, 0);
  pop_attrib(p.context);
  clear_color(p.context, 0, 1, 0, 1);
  clear(p.context, GL_COLOR_BUFFER_BIT);  // in front again
  EXPECT_EQ(read(GL_BACK), kRed);
  EXPECT_EQ(read(GL_FRONT), kGreen);
  p.drawable.swap();
  EXPECT_EQ(read(GL_FRONT), kRed);
  EXPECT_EQ(read(GL_BACK), kRed);
  fill(GL_FRONT_AND_BACK, 0, 1);
  EXPECT_EQ(read(GL_FRONT), kGreen);
  fill(GL_BACK, 1, 0);
  EXPECT_EQ(read(GL_FRONT), kGreen);
  EXPECT_EQ(read(GL_BACK), kRed);
  EXPECT_EQ(p.error(), GLenum{GL_NO_ERROR});
}

TEST(ColorBuffers, DepthsAreOfBoth) {
  Picture p;
  p.black();
  enable(p.context, GL_DEPTH_TEST, true);
  p.draw(GL_POINTS, {{3.5, 5.5}});
  const std::uint32_t depth = p.depth(3, 5);
  draw_buffer(p.context, GL_FRONT);
  EXPECT_EQ(p.depth(3, 5), depth);
  EXPECT_NE(p.depth(4, 5), depth);
}

}  // namespace
}  // namespace halfplane::gl::color_buffers_test
