// Golden texture mapping: figures worked out by hand.
#include "model/golden/texture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../scene_builder.hpp"
#include "model/golden/golden.hpp"
#include "model/golden/interpolate.hpp"

namespace halfplane::golden_texture_test {
namespace {

using golden::Image;
using test::SceneBuilder;

Texture gradient(int width, int height, Mips mips = Mips::none) {
  return make_texture("t", pattern_image(TexturePattern::gradient, width, height), TextureFormat::rgba8888, mips);
}

State textured() {
  State state = SceneBuilder::window_state();
  state.texture = 0;
  state.texture_combine = TextureCombine::replace;
  return state;
}

Vertex corner(double x, double y, double u, double v, double w = 1) {
  Vertex vertex = test::at(x, y);
  vertex.u = u;
  vertex.v = v;
  vertex.w = w;
  return vertex;
}

/// The square (0, 0)...(size, size), texture coordinates `u0` to `u1` along both sides.
Scene square(int size, const State& state, Texture texture, double u0 = 0, double u1 = 1) {
  SceneBuilder builder(size, size, state);
  builder.triangle(corner(0, 0, u0, u0), corner(size, 0, u1, u0), corner(0, size, u0, u1))
      .triangle(corner(size, 0, u1, u0), corner(size, size, u1, u1), corner(0, size, u0, u1));
  builder.scene.textures.push_back(std::move(texture));
  return builder.scene;
}

std::array<double, 4> color_at(const Image& image, int x, int y) {
  return image.color[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)];
}

// The texture viewport: pixel centres fall on texel centres, half a texel from the sides.
TEST(GoldenTexture, OneTexelAPixelIsTheImageItself) {
  for (const TextureMag mag : {TextureMag::nearest, TextureMag::linear}) {
    State state = textured();
    state.texture_mag = mag;
    const Texture texture = gradient(16, 16);
    const Image image = golden::render(square(16, state, texture), preset("embedded"));
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x)
        for (std::size_t c = 0; c < 4; ++c)
          ASSERT_NEAR(color_at(image, x, y)[c], texture.texel(0, x, y)[c], 1e-9) << x << ' ' << y;
  }
}

TEST(GoldenTexture, LinearMagnificationBlendsFourTexels) {
  State state = textured();
  state.texture_mag = TextureMag::linear;
  state.texture_wrap = {TextureWrap::clamp, TextureWrap::clamp};
  const Image image = golden::render(square(8, state, gradient(2, 2)), preset("embedded"));
  EXPECT_NEAR(color_at(image, 0, 0)[0], 0, 1e-9);  // beyond the first texel's centre
  EXPECT_NEAR(color_at(image, 2, 0)[0], 255 * 0.125, 1e-9);
  EXPECT_NEAR(color_at(image, 5, 3)[0], 255 * 0.875, 1e-9);
  EXPECT_NEAR(color_at(image, 5, 3)[1], 255 * 0.375, 1e-9);
}

TEST(GoldenTexture, BeyondTheImageIsTheBorder) {
  State state = textured();
  state.texture_border = {100, 200, 50, 255};
  const Texture texture = gradient(4, 4);
  const auto red = [&](TextureWrap wrap, bool is_linear, double x) {
    state.texture_wrap = {wrap, TextureWrap::clamp};
    return golden::filtered_level(texture, state, {x, 1.5}, 0, is_linear)[0];
  };
  const double first = texture.texel(0, 0, 1)[0], last = texture.texel(0, 3, 1)[0];
  EXPECT_NEAR(red(TextureWrap::border, false, -0.01), 100, 1e-9);
  EXPECT_NEAR(red(TextureWrap::border, false, 0), first, 1e-9);
  EXPECT_NEAR(red(TextureWrap::border, false, 4), 100, 1e-9);
  EXPECT_NEAR(red(TextureWrap::border, true, -0.25), first * 0.25 + 100 * 0.75, 1e-9);
  EXPECT_NEAR(red(TextureWrap::border, true, 4.5), 100, 1e-9);
  for (const double beyond : {0.0, 0.01, 3.0, 1e200}) {
    EXPECT_NEAR(red(TextureWrap::half_border, true, -beyond), (first + 100) / 2, 1e-9);
    EXPECT_NEAR(red(TextureWrap::half_border, true, 4 + beyond), (last + 100) / 2, 1e-9);
    EXPECT_NEAR(red(TextureWrap::half_border, false, -beyond), first, 1e-9);
    EXPECT_NEAR(red(TextureWrap::half_border, false, 4 + beyond), last, 1e-9);
  }
}

TEST(GoldenTexture, BeyondTheImageItWrapsClampsOrTurns) {
  using golden::wrapped;
  for (const auto [texel, repeat, clamp, mirror] : {std::array{-5.0, 3.0, 0.0, 3.0},
                                                    {-1.0, 3.0, 0.0, 0.0},
                                                    {0.0, 0.0, 0.0, 0.0},
                                                    {3.0, 3.0, 3.0, 3.0},
                                                    {4.0, 0.0, 3.0, 3.0},
                                                    {7.0, 3.0, 3.0, 0.0},
                                                    {8.0, 0.0, 3.0, 0.0},
                                                    {1e12 + 1, 1.0, 3.0, 1.0}}) {
    EXPECT_EQ(wrapped(texel, 4, TextureWrap::repeat), repeat) << texel;
    EXPECT_EQ(wrapped(texel, 4, TextureWrap::clamp), clamp) << texel;
    EXPECT_EQ(wrapped(texel, 4, TextureWrap::mirror), mirror) << texel;
  }
}

// w is 1 at the top and 3 at the bottom: half way down the screen is a quarter of the way along the ground.
TEST(GoldenTexture, FarAwayItStillWrapsExactly) {
  // 10^17 = 33 * 3030303030303030 + 10; its neighbours in binary64 are 16 apart.
  EXPECT_EQ(golden::wrapped(1e17, 33, TextureWrap::repeat), 10);
  EXPECT_EQ(golden::wrapped(-1e17, 33, TextureWrap::repeat), 23);
  EXPECT_EQ(golden::wrapped(1e17, 33, TextureWrap::mirror), std::fmod(1e17, 66) < 33 ? 10 : 22);
  for (const double far : {1e30, -1e200, 1e308})
    for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::clamp, TextureWrap::mirror}) {
      const int texel = golden::wrapped(far, 33, wrap);
      EXPECT_TRUE(texel >= 0 && texel < 33) << far;
    }
}

TEST(GoldenTexture, PerspectiveDividesAndAffineDoesNot) {
  const Texture texture = gradient(256, 256);
  for (const TextureInterp interp : {TextureInterp::perspective, TextureInterp::affine}) {
    State state = textured();
    state.texture_interp = interp;
    state.texture_mag = TextureMag::linear;
    state.texture_min = TextureMin::linear;
    SceneBuilder builder(9, 9, state);
    builder.triangle(corner(0, 0.5, 0, 0, 1), corner(100, 0.5, 0, 0, 1), corner(0, 8.5, 0, 1, 3));
    builder.scene.textures.push_back(texture);
    const Image image = golden::render(builder.scene, preset("embedded"));
    const double v = interp == TextureInterp::affine ? 0.5 : 0.25;
    EXPECT_NEAR(color_at(image, 0, 4)[1], v * 256 - 0.5, 1e-6);
  }
}

TEST(GoldenTexture, TheLevelIsTheLogarithmOfTexelsAPixel) {
  const Texture texture = gradient(64, 32, Mips::box);
  EXPECT_NEAR(golden::level_of_detail(texture, {0, 0, 4.0 / 64, 0, 0, 2.0 / 32}), 2, 1e-12);
  EXPECT_NEAR(golden::level_of_detail(texture, {0, 0, 3.0 / 64, 0, 4.0 / 32, 0}), std::log2(5.0), 1e-12);
  // Derivatives of a perspective coordinate against differences.
  golden::Slope<double> n{2, 0.3, -0.1}, d{0.5, 0.02, 0.01};
  const auto q = n / d;
  const double h = 1e-6;
  EXPECT_NEAR(q.x, ((n.value + h * n.x) / (d.value + h * d.x) - q.value) / h, 1e-4);
  EXPECT_NEAR(q.y, ((n.value + h * n.y) / (d.value + h * d.y) - q.value) / h, 1e-4);
}

TEST(GoldenTexture, MinificationTakesTheLevelThatItsStateNames) {
  // 32 texels over 8 pixels: level 2, where each level is one colour.
  Texture texture = gradient(32, 32, Mips::box);
  for (std::size_t n = 0; n < texture.level.size(); ++n)
    std::ranges::fill(texture.level[n].code, static_cast<std::uint32_t>(n * 10) << 24 | 255);
  const auto red = [&](TextureMin min, std::array<double, 3> lod) {
    State state = textured();
    state.texture_min = min;
    state.texture_lod = lod;
    return color_at(golden::render(square(8, state, texture), preset("embedded")), 4, 4)[0];
  };
  EXPECT_NEAR(red(TextureMin::nearest, {0, 0, 12}), 0, 1e-9);
  EXPECT_NEAR(red(TextureMin::nearest_mipmap_nearest, {0, 0, 12}), 20, 1e-9);
  EXPECT_NEAR(red(TextureMin::nearest_mipmap_nearest, {0.5, 0, 12}), 20, 1e-9);  // a half goes down
  EXPECT_NEAR(red(TextureMin::nearest_mipmap_nearest, {0.75, 0, 12}), 30, 1e-9);
  EXPECT_NEAR(red(TextureMin::linear_mipmap_linear, {0.25, 0, 12}), 22.5, 1e-9);
  EXPECT_NEAR(red(TextureMin::linear_mipmap_linear, {0, 0, 1.5}), 15, 1e-9);
  EXPECT_NEAR(red(TextureMin::linear_mipmap_linear, {0, 4, 12}), 40, 1e-9);
  EXPECT_NEAR(red(TextureMin::linear_mipmap_linear, {16, 0, 12}), 50, 1e-9);  // the last there is
  EXPECT_NEAR(red(TextureMin::linear_mipmap_linear, {-3, 0, 12}), 0, 1e-9);
}

TEST(GoldenTexture, CombinesColourAndTexel) {
  using golden::combined;
  const golden::Color color{200, 100, 0, 128}, texel{51, 255, 128, 64};
  const auto expect = [&](TextureCombine combine, bool has_alpha, golden::Color wanted) {
    const golden::Color got = combined(color, texel, combine, has_alpha, {100, 0, 51});
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(got[c], wanted[c], 1e-9) << static_cast<int>(combine) << ' ' << c;
  };
  expect(TextureCombine::modulate, true, {40, 100, 0, 128.0 * 64 / 255});
  expect(TextureCombine::replace, true, {51, 255, 128, 64});
  expect(TextureCombine::replace, false, {51, 255, 128, 128});
  expect(TextureCombine::decal, true, {200 - 149.0 * 64 / 255, 100 + 155.0 * 64 / 255, 128.0 * 64 / 255, 128});
  expect(TextureCombine::add, true, {251, 255, 128, 128.0 * 64 / 255});
  expect(TextureCombine::blend, true, {180, 0, 51.0 * 128 / 255, 128.0 * 64 / 255});
}

// The same picture with and without geometric clipping: the ground from the eye to the horizon.
// Coordinates lie exactly on borders, where binary64 falls to either side: pixel (x, y) shows texel (x, y).
TEST(GoldenTexture, ASpriteWhosePixelsLieOnBordersOfTexelsShowsEachOnce) {
  State state = textured();
  state.pixel_center = PixelCenter::integer;
  state.texture_mag = TextureMag::nearest;
  for (const int side : {10, 100, 224}) {
    const Texture texture = gradient(side, side);
    const Image image = golden::render(square(side, state, texture), preset("full"));
    int wrong = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        for (std::size_t c = 0; c < 3; ++c) wrong += color_at(image, x, y)[c] != texture.texel(0, x, y)[c] ? 1 : 0;
    EXPECT_EQ(wrong, 0) << side;
  }
}

TEST(GoldenTexture, ClippingDoesNotMoveTheTexture) {
  State state;
  state.texture = 0;
  state.texture_mag = TextureMag::linear;
  state.texture_min = TextureMin::linear;
  SceneBuilder builder(32, 32, state);
  const auto ground = [](double x, double z, double u, double v) {  // eye at 1 above it, near 0.5, far 50
    Vertex vertex = test::clip_at(x, -1, (50.5 * z - 50) / 49.5, z);
    vertex.u = u;
    vertex.v = v;
    return vertex;
  };
  builder.triangle(ground(-40, -10, 0, 0), ground(40, -10, 4, 0), ground(0, 45, 2, 4));
  builder.scene.textures.push_back(gradient(64, 64));
  golden::Options options;
  const Image clipped = golden::render(builder.scene, preset("full"), options);
  options.clipping = Clipping::homogeneous;
  const Image whole = golden::render(builder.scene, preset("full"), options);
  int covered = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      covered += clipped.count[static_cast<std::size_t>(32 * y + x)] != 0 ? 1 : 0;
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(color_at(clipped, x, y)[c], color_at(whole, x, y)[c], 1e-6);
    }
  EXPECT_GT(covered, 300);
}

}  // namespace
}  // namespace halfplane::golden_texture_test
