// glDrawPixels, glBitmap, glCopyPixels and glReadPixels on the picture of a drawable without a window.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "gl/core/commands.hpp"
#include "model/config.hpp"

namespace halfplane::gl::pixels_test {
namespace {

constexpr int kSide = 64;
using Color = std::array<GLubyte, 4>;

class GlPixels : public ::testing::Test {
 protected:
  GlPixels() : drawable_(options(), kSide, kSide) {
    context.drawable = context.read_drawable = &drawable_;
    context.state.viewport.width = context.state.viewport.height = kSide;
    clear(context, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    window_pos(context, 0, 0, 0);
  }
  static Options options() {
    Options options;
    options.config = labelled("full stencil.bits=8");
    return options;
  }
  /// Draws an image of one row for each of `rows`.
  template <class T>
  void draw(GLenum format, GLenum type, int width, int height, const std::vector<T>& pixels) {
    draw_pixels(context, std::make_shared<const Image>(unpack(context, width, height, 1, format, type, pixels.data())));
  }
  Color color(int x, int y) {
    Color read{};
    read_pixels(context, x, y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, read.data());
    return read;
  }
  int stencil(int x, int y) {
    GLubyte read = 0;
    read_pixels(context, x, y, 1, 1, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, &read);
    return read;
  }
  float depth(int x, int y) {
    float read = 0;
    read_pixels(context, x, y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &read);
    return read;
  }

  Context context;

 private:
  Drawable drawable_;
};

constexpr Color kBlack{0, 0, 0, 0}, kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255};
const std::vector<Color> kTwo{kRed, kGreen};

TEST_F(GlPixels, DrawnAndRead) {
  std::vector<Color> pixels;
  for (int i = 0; i < 7 * 5; ++i)
    pixels.push_back({static_cast<GLubyte>(7 * i), static_cast<GLubyte>(255 - 5 * i), static_cast<GLubyte>(i), 200});
  window_pos(context, 10, 20, 0.5);
  draw(GL_RGBA, GL_UNSIGNED_BYTE, 7, 5, pixels);
  std::vector<Color> read(pixels.size());
  read_pixels(context, 10, 20, 7, 5, GL_RGBA, GL_UNSIGNED_BYTE, read.data());
  EXPECT_EQ(read, pixels);
  EXPECT_EQ(color(9, 20), kBlack);
  EXPECT_EQ(color(17, 24), kBlack);
  EXPECT_EQ(color(10, 19), kBlack);
  EXPECT_EQ(color(10, 25), kBlack);
}

TEST_F(GlPixels, ZoomedBothWays) {
  window_pos(context, 30, 30, 0);
  pixel_zoom(context, 3, 2);
  draw(GL_RGBA, GL_UNSIGNED_BYTE, 2, 1, kTwo);
  EXPECT_EQ(color(30, 30), kRed);
  EXPECT_EQ(color(32, 31), kRed);
  EXPECT_EQ(color(33, 30), kGreen);
  EXPECT_EQ(color(35, 31), kGreen);
  EXPECT_EQ(color(36, 30), kBlack);
  EXPECT_EQ(color(30, 32), kBlack);
  pixel_zoom(context, -2, -1);
  draw(GL_RGBA, GL_UNSIGNED_BYTE, 2, 1, kTwo);
  EXPECT_EQ(color(29, 29), kRed);
  EXPECT_EQ(color(28, 29), kRed);
  EXPECT_EQ(color(27, 29), kGreen);
  EXPECT_EQ(color(26, 29), kGreen);
  EXPECT_EQ(color(25, 29), kBlack);
  EXPECT_EQ(color(29, 28), kBlack);
}

TEST_F(GlPixels, DepthsPassTheTestInTheRasterColor) {
  enable(context, GL_DEPTH_TEST, true);
  depth_func(context, GL_LESS);
  gl::color(context, 0, 1, 0, 1);
  window_pos(context, 4, 4, 0);
  draw(GL_DEPTH_COMPONENT, GL_FLOAT, 2, 1, std::vector<float>{0.25F, 1});
  EXPECT_NEAR(depth(4, 4), 0.25F, 1e-6);
  EXPECT_EQ(color(4, 4), kGreen);
  EXPECT_EQ(depth(5, 4), 1);
  EXPECT_EQ(color(5, 4), kBlack);  // 1 is not less
  window_pos(context, 4, 8, 0);
  copy_pixels(context, 4, 4, 1, 1, GL_DEPTH);
  EXPECT_EQ(depth(4, 8), depth(4, 4));
}

TEST_F(GlPixels, StencilsAreWrittenThroughTheirMask) {
  enable(context, GL_DEPTH_TEST, true);
  depth_func(context, GL_NEVER);
  stencil_mask(context, 0x7f);
  window_pos(context, 1, 1, 0);
  draw(GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, 3, 1, std::vector<GLubyte>{3, 255, 0, 0});
  EXPECT_EQ(stencil(1, 1), 3);
  EXPECT_EQ(stencil(2, 1), 127);
  EXPECT_EQ(stencil(3, 1), 0);
  EXPECT_EQ(color(1, 1), kBlack);
  EXPECT_EQ(depth(1, 1), 1);
  window_pos(context, 1, 5, 0);
  copy_pixels(context, 1, 1, 2, 1, GL_STENCIL);
  EXPECT_EQ(stencil(2, 5), 127);
  EXPECT_EQ(context.state.stencil.reference, 0);
  EXPECT_FALSE(context.state.stencil.test);
}

TEST_F(GlPixels, BitmapsMoveTheRasterPosition) {
  gl::color(context, 1, 0, 0, 1);
  window_pos(context, 10.6, 10.6, 0);
  const std::array<GLubyte, 8> rows{0x80, 0, 0, 0, 0x40, 0, 0, 0};
  bitmap(context, std::make_shared<const Bitmap>(unpack_bitmap(context, 2, 2, rows.data())), 1, 0, 5, -2);
  EXPECT_EQ(color(9, 10), kRed);
  EXPECT_EQ(color(10, 11), kRed);
  EXPECT_EQ(color(10, 10), kBlack);
  EXPECT_EQ(color(9, 11), kBlack);
  EXPECT_DOUBLE_EQ(context.state.current.raster.window[0], 15.6);
  EXPECT_DOUBLE_EQ(context.state.current.raster.window[1], 8.6);
  context.state.current.raster.valid = false;
  bitmap(context, std::make_shared<const Bitmap>(unpack_bitmap(context, 2, 2, rows.data())), 0, 0, 5, 0);
  EXPECT_DOUBLE_EQ(context.state.current.raster.window[0], 15.6);
}

TEST_F(GlPixels, CopiedWithTransferAndBeyondTheWindow) {
  window_pos(context, 0, 0, 0);
  draw(GL_RGBA, GL_UNSIGNED_BYTE, 2, 1, kTwo);
  pixel_transfer(context, GL_RED_SCALE, 0);
  pixel_transfer(context, GL_BLUE_BIAS, 1);
  window_pos(context, 20, 20, 0);
  copy_pixels(context, -3, -2, 8, 4, GL_COLOR);
  pixel_transfer(context, GL_RED_SCALE, 1);
  pixel_transfer(context, GL_BLUE_BIAS, 0);
  EXPECT_EQ(color(23, 22), (Color{0, 0, 255, 255}));
  EXPECT_EQ(color(24, 22), (Color{0, 255, 255, 255}));
  EXPECT_EQ(color(22, 22), kBlack);
}

TEST_F(GlPixels, LuminanceIsTheSumOfTheChannels) {
  draw(GL_RGBA, GL_UNSIGNED_BYTE, 1, 1, std::vector<Color>{{50, 60, 70, 255}});
  GLubyte luminance = 0;
  read_pixels(context, 0, 0, 1, 1, GL_LUMINANCE, GL_UNSIGNED_BYTE, &luminance);
  EXPECT_EQ(luminance, 180);
}

TEST_F(GlPixels, ErrorsDrawNothing) {
  GLubyte pixel = 7;
  read_pixels(context, 0, 0, 1, 1, GL_COLOR_INDEX, GL_UNSIGNED_BYTE, &pixel);
  EXPECT_EQ(get_error(context), GLenum{GL_INVALID_OPERATION});
  read_pixels(context, 0, 0, -1, 1, GL_RGBA, GL_UNSIGNED_BYTE, &pixel);
  EXPECT_EQ(get_error(context), GLenum{GL_INVALID_VALUE});
  read_pixels(context, 0, 0, 1, 1, GL_RGBA, GL_BITMAP, &pixel);
  EXPECT_EQ(get_error(context), GLenum{GL_INVALID_ENUM});
  copy_pixels(context, 0, 0, 1, 1, GL_RGBA);
  EXPECT_EQ(get_error(context), GLenum{GL_INVALID_ENUM});
  copy_pixels(context, 0, 0, 1, -1, GL_COLOR);
  EXPECT_EQ(get_error(context), GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(pixel, 7);
  // Far away and huge, with valid memory.
  copy_pixels(context, -2147483647 - 1, 5, 2147483647, 2147483647, GL_COLOR);
  copy_pixels(context, 2147483647, 2147483647, 2147483647, 2147483647, GL_DEPTH);
  pixel_zoom(context, 1e300, std::nan(""));
  draw(GL_RGBA, GL_UNSIGNED_BYTE, 2, 1, kTwo);
  draw(GL_DEPTH_COMPONENT, GL_FLOAT, 2, 1, std::vector<float>{std::nanf(""), 1e30F});
  EXPECT_EQ(get_error(context), GLenum{GL_NO_ERROR});
}

}  // namespace
}  // namespace halfplane::gl::pixels_test
