// Coverage, depths and images of fragments that the host shades: those of the model, on a drawable without a window.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sim/scene/random.hpp"
#include "textured_window.hpp"

namespace halfplane::gl::host_coverage_test {
namespace {

/// The same triangles drawn by the model's unit and shaded on the host: the same pixels and depths, those cut by the near
/// plane too, and so that a second pass by GL_EQUAL finds each pixel of the first.
TEST(HostCoverage, IsTheModels) {
  TexturedWindow window("full stencil.bits=8", OnMissing::host);
  Context& context = window.context;
  for (const GLenum unit : {GL_TEXTURE1, GL_TEXTURE0}) {
    window.use_unit(unit);
    window.upload(0, GL_RGB, TexturedWindow::filled(1, 1, {255, 255, 255, 255}));
  }
  Random random(7);
  int pixels = 0;
  for (int turn = 0; turn < 200; ++turn) {
    SCOPED_TRACE("turn " + std::to_string(turn));
    std::array<Vec4, 12> place;
    for (Vec4& p : place) {
      p[3] = random.uniform(turn % 3 == 0 ? -0.5 : 0.3, 4);
      for (std::size_t c = 0; c < 3; ++c) p[c] = random.uniform(-1.5, 1.5) * std::abs(p[3]);
    }
    const auto draw_all = [&](bool is_shaded) {
      active_texture(context, GL_TEXTURE1);
      enable(context, GL_TEXTURE_2D, is_shaded);
      ++context.revision;
      begin(context, GL_TRIANGLES);
      for (const Vec4& p : place) vertex(context, p[0], p[1], p[2], p[3]);
      gl::end(context);
    };
    std::array<std::vector<std::uint32_t>, 2> depth;
    for (const bool is_shaded : {false, true}) {
      depth_func(context, GL_LESS);
      enable(context, GL_DEPTH_TEST, true);
      clear(context, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
      draw_all(is_shaded);
      const Framebuffer& picture = window.drawable.frame.picture();
      depth[is_shaded ? 1 : 0].assign(picture.depth.begin(), picture.depth.end());
    }
    EXPECT_TRUE(depth[0] == depth[1]);
    const int covered = window.drawn_pixels();
    pixels += covered;
    depth_func(context, GL_EQUAL);
    clear(context, GL_COLOR_BUFFER_BIT);
    draw_all(false);
    EXPECT_EQ(window.drawn_pixels(), covered);
  }
  EXPECT_GT(pixels, 10000);
}

/// With several samples a pixel's colour is that of its centre, or of the nearest place of the triangle.
TEST(HostCoverage, PartlyCoveredPixelsHaveTheirColour) {
  TexturedWindow window("embedded color.format=rgba8888 msaa.samples=4", OnMissing::host);
  Context& context = window.context;
  for (const GLenum unit : {GL_TEXTURE0, GL_TEXTURE1}) {
    window.use_unit(unit);
    window.upload(0, GL_RGB, TexturedWindow::filled(1, 1, {255, 255, 255, 255}));
  }
  ++context.revision;
  begin(context, GL_TRIANGLES);
  vertex(context, -0.9, -0.83, 0, 1);
  vertex(context, 0.87, -0.4, 0, 1);
  vertex(context, -0.3, 0.91, 0, 1);
  end(context);
  const Framebuffer& picture = window.drawable.frame.picture();
  ASSERT_EQ(picture.samples.size(), 4U);
  int drawn = 0;
  for (const Framebuffer& sample : picture.samples)
    for (const std::uint32_t code : sample.color) {
      drawn += code == ~0U ? 1 : 0;
      ASSERT_TRUE(code == 0xff000000 || code == ~0U) << std::hex << code;
    }
  EXPECT_GT(drawn, 4 * 800);
}

/// The same white texel in both units, so that the host shades.
void use_white_units(TexturedWindow& window) {
  for (const GLenum unit : {GL_TEXTURE0, GL_TEXTURE1}) {
    active_texture(window.context, unit);
    enable(window.context, GL_TEXTURE_2D, true);
    window.nearest();
  }
  window.upload(0, GL_RGB, TexturedWindow::filled(1, 1, {255, 255, 255, 255}));
}

/// Many triangles of all sizes need several images; each pixel has the colour of its own triangle.
TEST(HostCoverage, ManyTrianglesAreEachShadedOnce) {
  TexturedWindow window("full target.width=1024 target.height=1024", OnMissing::host);
  Context& context = window.context;
  window.drawable.frame.resize(1000, 1000);
  viewport(context, 0, 0, 1000, 1000);
  use_white_units(window);
  shade_model(context, GL_FLAT);
  enable(context, GL_DEPTH_TEST, true);
  ++context.revision;
  constexpr int kLayers = 6;
  begin(context, GL_QUADS);
  for (int i = 0; i < kLayers; ++i) {  // from the back to the front, each smaller
    color(context, (i + 1) / 255.0, 1, 0, 1);
    const double half = 1 - i / double{kLayers};
    for (const auto& [x, y] : {std::array{-1, -1}, std::array{1, -1}, std::array{1, 1}, std::array{-1, 1}})
      vertex(context, half * x, half * y, -i / double{kLayers}, 1);
  }
  end(context);
  const Framebuffer& picture = window.drawable.frame.picture();
  for (int y = 0; y < 1000; ++y)
    for (int x = 0; x < 1000; ++x) {
      const double place = std::max(std::abs((x + 0.5) / 500 - 1), std::abs((y + 0.5) / 500 - 1));
      if (std::abs(kLayers * place - std::rint(kLayers * place)) < 0.03) continue;  // near an edge
      const auto layer = static_cast<std::uint32_t>(kLayers - std::floor(kLayers * place));
      ASSERT_EQ(picture.color[picture.at(x, y)] & 255, layer) << x << " " << y;
    }
}

/// A target wider than a texture.
TEST(HostCoverage, OfLargeTargetsAreSeveral) {
  TexturedWindow window("full target.width=5000 target.height=64 guard.band=8192", OnMissing::host);
  Context& context = window.context;
  window.drawable.frame.resize(5000, 8);
  viewport(context, 0, 0, 5000, 8);
  use_white_units(window);
  ++context.revision;
  begin(context, GL_TRIANGLES);
  for (const auto& [x, y] : {std::array{-1, -1}, std::array{3, -1}, std::array{-1, 3}}) {
    color(context, (x + 1) / 4.0, 1, 1, 1);
    vertex(context, x, y, 0, 1);
  }
  end(context);
  const Framebuffer& picture = window.drawable.frame.picture();
  for (int x = 0; x < 5000; ++x) ASSERT_NEAR(picture.color[picture.at(x, 3)] & 255, 255 * (x + 0.5) / 10000, 1) << x;
}

}  // namespace
}  // namespace halfplane::gl::host_coverage_test
