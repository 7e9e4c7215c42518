// Textures: objects and their images, errors, completeness, and environments on the picture of a drawable without a window
// against the formulas of OpenGL 1.5 (tables 3.22 to 3.25), written again here.
#include "gl/core/texture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "gl/core/commands.hpp"
#include "textured_window.hpp"

namespace halfplane::gl::texture_test {
namespace {

class GlTexture : public ::testing::Test, protected TexturedWindow {};

// ---- environments

struct BaseFormat {
  GLint format;
  std::array<int, 4> source;  ///< of the texture's color as the environment sees it: a channel, 4 for 0, 5 for 1
};
constexpr auto kBases = std::to_array<BaseFormat>({{GL_ALPHA, {4, 4, 4, 3}},
                                                   {GL_LUMINANCE, {0, 0, 0, 5}},
                                                   {GL_LUMINANCE_ALPHA, {0, 0, 0, 3}},
                                                   {GL_INTENSITY, {0, 0, 0, 0}},
                                                   {GL_RGB, {0, 1, 2, 5}},
                                                   {GL_RGBA, {0, 1, 2, 3}}});

Vec4 seen(const BaseFormat& base, const Bytes& texel) {
  Vec4 color{};
  for (std::size_t c = 0; c < 4; ++c)
    color[c] = base.source[c] == 4   ? 0
               : base.source[c] == 5 ? 1
                                     : texel[static_cast<std::size_t>(base.source[c])] / 255.0;
  return color;
}

/// Table 3.22.
Vec4 expected(GLenum mode, GLint format, const Vec4& f, const Vec4& t, const Vec4& constant) {
  const bool has_color = format != GL_ALPHA, has_alpha = format != GL_RGB && format != GL_LUMINANCE;
  Vec4 result = f;
  for (std::size_t c = 0; c < 3 && has_color; ++c) {
    if (mode == GL_REPLACE) result[c] = t[c];
    if (mode == GL_MODULATE) result[c] = f[c] * t[c];
    if (mode == GL_DECAL) result[c] = has_alpha ? f[c] * (1 - t[3]) + t[c] * t[3] : t[c];
    if (mode == GL_BLEND) result[c] = f[c] * (1 - t[c]) + constant[c] * t[c];
    if (mode == GL_ADD) result[c] = std::min(f[c] + t[c], 1.0);
  }
  if (has_alpha && mode != GL_DECAL) result[3] = mode == GL_REPLACE ? t[3] : f[3] * t[3];
  if (format == GL_INTENSITY && mode == GL_BLEND) result[3] = f[3] * (1 - t[3]) + constant[3] * t[3];
  if (format == GL_INTENSITY && mode == GL_ADD) result[3] = std::min(f[3] + t[3], 1.0);
  return result;
}

/// Four texels, each in a quarter of the window.
const std::vector<Bytes> kTexels{{10, 200, 90, 255}, {255, 0, 30, 60}, {128, 128, 128, 130}, {0, 70, 250, 0}};

TEST_F(GlTexture, EnvironmentsAreThoseOfTheTable) {
  enable(context, GL_TEXTURE_2D, true);
  nearest();
  const Vec4 fragment{0.8, 0.4, 0.2, 0.6};
  for (const GLenum mode : {GL_REPLACE, GL_MODULATE, GL_DECAL, GL_BLEND, GL_ADD})
    for (const BaseFormat& base : kBases)
      for (const Vec4& constant : {Vec4{0, 0, 0, 0}, Vec4{0.2, 0.9, 0.5, 0.7}}) {
        if (mode == GL_DECAL && base.format != GL_RGB && base.format != GL_RGBA) continue;  // undefined
        SCOPED_TRACE("mode " + std::to_string(mode) + " format " + std::to_string(base.format));
        upload(0, base.format, image(2, 2, kTexels));
        environment(GL_TEXTURE_ENV_MODE, mode);
        env_color(constant);
        draw(fragment);
        for (std::size_t i = 0; i < kTexels.size(); ++i)
          expect_near(color(16 + 32 * static_cast<int>(i % 2), 16 + 32 * static_cast<int>(i / 2)),
                      expected(mode, base.format, fragment, seen(base, kTexels[i]), constant));
      }
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

/// GL_CLAMP and GL_CLAMP_TO_BORDER at and beyond a side: exact without a texture unit and with texture.border, else the
/// edge.
TEST(GlTextureBorder, IsTheHardwaresWhereItHasATextureUnit) {
  // Red of one colour everywhere: that of texture coordinate s, with a white texture and a border of red 0.2.
  const auto red = [](const char* settings, GLenum wrap, GLenum filter, GLenum base, double s) {
    TexturedWindow window(settings, OnMissing::host);
    enable(window.context, GL_TEXTURE_2D, true);
    window.filter(filter);
    window.parameter(GL_TEXTURE_WRAP_S, wrap);
    window.parameter(GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    tex_parameter(window.context, GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, {{0.2, 0.4, 0.6, 0.8}, false, true});
    window.upload(0, static_cast<GLint>(base), TexturedWindow::filled(2, 2, {255, 255, 255, 255}));
    window.environment(GL_TEXTURE_ENV_MODE, GL_REPLACE);
    window.draw({1, 1, 1, 1}, {s, 0.5}, {s, 0.5});
    return window.color(32, 32)[0] / 255.0;
  };
  constexpr double kNear = 1.5 / 255;
  for (const char* settings : {"full", "full texture.unit=trilinear texture.border=1"}) {
    EXPECT_NEAR(red(settings, GL_CLAMP, GL_LINEAR, GL_RGBA, -3), 0.6, kNear);
    EXPECT_NEAR(red(settings, GL_CLAMP, GL_LINEAR, GL_LUMINANCE, 9), 0.6, kNear);
    EXPECT_NEAR(red(settings, GL_CLAMP, GL_LINEAR, GL_RGB, 0.125), 0.8, kNear);
    EXPECT_NEAR(red(settings, GL_CLAMP, GL_NEAREST, GL_RGBA, -3), 1, kNear);
    EXPECT_NEAR(red(settings, GL_CLAMP_TO_BORDER, GL_LINEAR, GL_RGBA, -3), 0.2, kNear);
    EXPECT_NEAR(red(settings, GL_CLAMP_TO_BORDER, GL_LINEAR, GL_RGBA, 1), 0.6, kNear);
    EXPECT_NEAR(red(settings, GL_CLAMP_TO_BORDER, GL_NEAREST, GL_RGBA, 1.01), 0.2, kNear);
    EXPECT_NEAR(red(settings, GL_CLAMP_TO_BORDER, GL_NEAREST, GL_ALPHA, 1.01), 1, kNear);
    EXPECT_NEAR(red(settings, GL_CLAMP_TO_EDGE, GL_LINEAR, GL_RGBA, -3), 1, kNear);
  }
  for (const GLenum wrap : {GL_CLAMP, GL_CLAMP_TO_BORDER})
    EXPECT_NEAR(red("full texture.unit=trilinear", wrap, GL_LINEAR, GL_RGBA, -3), 1, kNear);
}

/// GL_BLEND with a constant is exact: by the hardware's constant, or shaded on the host where it has none.
TEST(GlTextureConstant, IsExactInEveryConfiguration) {
  const Vec4 fragment{0.8, 0.4, 0.2, 0.6}, constant{0.2, 0.9, 0.5, 0};
  const Vec4 wanted = expected(GL_BLEND, GL_RGBA, fragment, {64 / 255.0, 128 / 255.0, 191 / 255.0, 1}, constant);
  for (const char* settings : {"full", "full texture.unit=trilinear texture.constant=1", "full texture.unit=trilinear"})
    for (const GLenum mode : {GL_BLEND, GL_COMBINE}) {
      TexturedWindow window(settings, OnMissing::host);
      enable(window.context, GL_TEXTURE_2D, true);
      window.nearest();
      window.upload(0, GL_RGBA, TexturedWindow::filled(1, 1, {64, 128, 191, 255}));
      window.env_color(constant);
      window.environment(GL_TEXTURE_ENV_MODE, mode);
      // The same by hand.
      window.environment(GL_COMBINE_RGB, GL_INTERPOLATE);
      window.environment(GL_SOURCE0_RGB, GL_CONSTANT);
      window.environment(GL_SOURCE2_RGB, GL_TEXTURE);
      window.environment(GL_OPERAND2_RGB, GL_SRC_COLOR);
      window.draw(fragment);
      expect_near(window.color(32, 32), wanted);
    }
}

/// A combiner, and its result by the formulas of table 3.23 of one channel.
struct CombineCase {
  std::string name;
  GLenum rgb, alpha;
  std::array<GLenum, 3> source, operand;  ///< of RGB; alpha has the same sources
  double scale;
};

double argument(const CombineCase& test, std::size_t i, std::size_t c, const Vec4& f, const Vec4& t, const Vec4& k) {
  const Vec4& color = test.source[i] == GL_CONSTANT ? k : test.source[i] == GL_PREVIOUS ? f : t;
  const GLenum operand = test.operand[i];
  const bool is_alpha = c == 3 || operand == GL_SRC_ALPHA || operand == GL_ONE_MINUS_SRC_ALPHA;
  const double value = color[is_alpha ? 3 : c];
  return c != 3 && (operand == GL_ONE_MINUS_SRC_COLOR || operand == GL_ONE_MINUS_SRC_ALPHA) ? 1 - value : value;
}

double combined(const CombineCase& test, std::size_t c, const Vec4& f, const Vec4& t, const Vec4& k) {
  const auto arg = [&](std::size_t i, std::size_t channel) { return argument(test, i, channel, f, t, k); };
  double dot = 0;
  for (std::size_t i = 0; i < 3; ++i) dot += 4 * (arg(0, i) - 0.5) * (arg(1, i) - 0.5);
  double value = 0;
  switch (c == 3 ? test.alpha : test.rgb) {
    case GL_REPLACE: value = arg(0, c); break;
    case GL_MODULATE: value = arg(0, c) * arg(1, c); break;
    case GL_ADD: value = arg(0, c) + arg(1, c); break;
    case GL_ADD_SIGNED: value = arg(0, c) + arg(1, c) - 0.5; break;
    case GL_SUBTRACT: value = arg(0, c) - arg(1, c); break;
    case GL_INTERPOLATE: value = arg(0, c) * arg(2, c) + arg(1, c) * (1 - arg(2, c)); break;
    default: value = dot; break;
  }
  return std::clamp(value * (c == 3 ? 1 : test.scale), 0.0, 1.0);
}

TEST_F(GlTexture, CombinersThatTheModelHas) {
  const GLenum color_of = GL_SRC_COLOR, alpha_of = GL_SRC_ALPHA, not_color = GL_ONE_MINUS_SRC_COLOR;
  const GLenum texture = GL_TEXTURE, previous = GL_PREVIOUS, constant = GL_CONSTANT;
  const std::vector<CombineCase> cases{
      {"texture", GL_REPLACE, GL_REPLACE, {texture, texture, texture}, {color_of, color_of, color_of}, 1},
      {"texture twice as bright",
       GL_REPLACE,
       GL_REPLACE,
       {texture, texture, texture},
       {color_of, color_of, color_of},
       2},
      {"previous", GL_REPLACE, GL_REPLACE, {previous, texture, texture}, {color_of, color_of, color_of}, 1},
      {"product", GL_MODULATE, GL_MODULATE, {texture, previous, texture}, {color_of, color_of, color_of}, 1},
      {"product of complement",
       GL_MODULATE,
       GL_MODULATE,
       {texture, previous, texture},
       {not_color, color_of, color_of},
       1},
      {"constant", GL_MODULATE, GL_REPLACE, {constant, previous, texture}, {color_of, color_of, color_of}, 1},
      {"texture times constant",
       GL_MODULATE,
       GL_MODULATE,
       {constant, texture, texture},
       {color_of, color_of, color_of},
       1},
      {"alpha as light", GL_MODULATE, GL_MODULATE, {texture, previous, texture}, {alpha_of, color_of, color_of}, 1},
      {"sum", GL_ADD, GL_MODULATE, {texture, previous, texture}, {color_of, color_of, color_of}, 1},
      {"difference", GL_SUBTRACT, GL_REPLACE, {texture, constant, texture}, {color_of, color_of, color_of}, 1},
      {"signed sum", GL_ADD_SIGNED, GL_REPLACE, {texture, constant, texture}, {color_of, color_of, color_of}, 1},
      {"dot", GL_DOT3_RGB, GL_REPLACE, {texture, constant, texture}, {color_of, color_of, color_of}, 1},
      {"constant by texture",
       GL_INTERPOLATE,
       GL_REPLACE,
       {texture, constant, texture},
       {color_of, color_of, alpha_of},
       1},
  };
  enable(context, GL_TEXTURE_2D, true);
  nearest();
  environment(GL_TEXTURE_ENV_MODE, GL_COMBINE);
  const Vec4 fragment{0.8, 0.4, 0.2, 0.6}, env{0.6, 0.3, 0.9, 0.7};
  env_color(env);
  for (const CombineCase& test : cases)
    for (const BaseFormat& base : kBases) {
      SCOPED_TRACE(test.name + " format " + std::to_string(base.format));
      upload(0, base.format, image(2, 2, kTexels));
      environment(GL_COMBINE_RGB, test.rgb);
      environment(GL_COMBINE_ALPHA, test.alpha);
      environment(GL_RGB_SCALE, test.scale);
      for (GLenum i = 0; i < 3; ++i) {
        environment(GL_SOURCE0_RGB + i, test.source[i]);
        environment(GL_SOURCE0_ALPHA + i, test.source[i]);
        environment(GL_OPERAND0_RGB + i, test.operand[i]);
      }
      draw(fragment);
      for (std::size_t i = 0; i < kTexels.size(); ++i) {
        Vec4 result{};
        for (std::size_t c = 0; c < 4; ++c) result[c] = combined(test, c, fragment, seen(base, kTexels[i]), env);
        expect_near(color(16 + 32 * static_cast<int>(i % 2), 16 + 32 * static_cast<int>(i / 2)), result);
      }
    }
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

/// A decal by hand: its alpha is that of the vertices.
TEST_F(GlTexture, InterpolationByTheTexturesAlphaIsADecal) {
  enable(context, GL_TEXTURE_2D, true);
  nearest();
  upload(0, GL_RGBA, image(2, 2, kTexels));
  environment(GL_TEXTURE_ENV_MODE, GL_COMBINE);
  environment(GL_COMBINE_RGB, GL_INTERPOLATE);
  environment(GL_SOURCE2_RGB, GL_TEXTURE);
  environment(GL_COMBINE_ALPHA, GL_REPLACE);
  environment(GL_SOURCE0_ALPHA, GL_PREVIOUS);
  const Vec4 fragment{0.8, 0.4, 0.2, 0.6};
  draw(fragment);
  expect_near(color(48, 16), expected(GL_DECAL, GL_RGBA, fragment, seen(kBases[5], kTexels[1]), {}));
}

/// Pixels and bitmaps take the texture at the raster position, in every environment.
TEST_F(GlTexture, PixelsAndBitmapsAreTextured) {
  enable(context, GL_TEXTURE_2D, true);
  nearest();
  upload(0, GL_RGBA, image(2, 2, kTexels));
  const Vec4 fragment{0.8, 0.4, 0.2, 0.6}, constant{0.2, 0.9, 0.5, 0};
  env_color(constant);
  for (const GLenum mode : {GL_REPLACE, GL_MODULATE, GL_DECAL, GL_BLEND, GL_ADD})
    for (const BaseFormat& base : kBases) {
      if (mode == GL_DECAL && base.format != GL_RGB && base.format != GL_RGBA) continue;
      SCOPED_TRACE("mode " + std::to_string(mode) + " format " + std::to_string(base.format));
      upload(0, base.format, image(2, 2, kTexels));
      environment(GL_TEXTURE_ENV_MODE, mode);
      gl::color(context, fragment[0], fragment[1], fragment[2], fragment[3]);
      tex_coord(context, GL_TEXTURE0, 0.75, 1.25, 0, 1);  // the second texel
      ++context.revision;
      window_pos(context, 5, 5, 0);
      bitmap(context, std::make_shared<const Bitmap>(Bitmap{1, 1, {true}}), 0, 0, 5, 0);
      draw_pixels(context, filled(1, 1, {204, 102, 51, 153}));
      const Vec4 result = expected(mode, base.format, fragment, seen(base, kTexels[1]), constant);
      expect_near(color(5, 5), result);
      expect_near(color(10, 5), result);
    }
}

// ---- sampling

TEST_F(GlTexture, LevelsOfItsOwn) {
  enable(context, GL_TEXTURE_2D, true);
  nearest();
  parameter(GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
  upload(0, GL_RGB, filled(4, 4, kRed));
  upload(1, GL_RGB, filled(2, 2, kGreen));
  EXPECT_EQ(sampled_texture(context, 0), nullptr);
  upload(2, GL_RGB, filled(1, 1, kBlue));
  ASSERT_NE(sampled_texture(context, 0), nullptr);
  draw({1, 1, 1, 1});
  EXPECT_EQ(color(32, 32), kRed);
  draw({1, 1, 1, 1}, 32);  // 128 texels on 64 pixels
  EXPECT_EQ(color(32, 32), kGreen);
  draw({1, 1, 1, 1}, 64);
  EXPECT_EQ(color(32, 32), kBlue);
  parameter(GL_TEXTURE_MAX_LEVEL, 1);
  draw({1, 1, 1, 1}, 64);
  EXPECT_EQ(color(32, 32), kGreen);
  parameter(GL_TEXTURE_BASE_LEVEL, 1);
  draw({1, 1, 1, 1});
  EXPECT_EQ(color(32, 32), kGreen);
  parameter(GL_TEXTURE_BASE_LEVEL, 2);
  EXPECT_EQ(sampled_texture(context, 0), nullptr);  // above the last level
  draw({1, 1, 1, 1});
  EXPECT_EQ(color(32, 32), (Bytes{255, 255, 255, 255}));
}

TEST_F(GlTexture, GeneratedLevelsAreMeans) {
  parameter(GL_GENERATE_MIPMAP, 1);
  upload(0, GL_RGBA, image(4, 2, {kRed, kRed, kBlue, kBlue, kRed, kRed, kBlue, kGreen}));
  const TextureObject& texture = *bound_texture(context, GL_TEXTURE_2D);
  ASSERT_EQ(texture.face[0].size(), 3U);
  EXPECT_EQ(texture.face[0][1].texel, (std::vector<Texel>{{255, 0, 0, 255}, {0, 64, 191, 255}}));
  EXPECT_EQ(texture.face[0][2].texel, (std::vector<Texel>{{128, 32, 96, 255}}));
  tex_sub_image(context, 2, GL_TEXTURE_2D, 0, 0, 0, 0, filled(2, 2, kBlue));
  EXPECT_EQ(texture.face[0][1].texel[0], (Texel{0, 0, 255, 255}));
  EXPECT_TRUE(is_complete(texture));
}

/// What the engine keeps of small textured triangles ends with their frame, also where none of them is seen.
TEST_F(GlTexture, ATextureAfterAStippleThatDrawsNothing) {
  upload(0, GL_RGBA, filled(4, 4, kRed));
  nearest();
  const auto square = [&] {
    ++context.revision;
    rect(context, -0.9, -0.9, -0.6, -0.6);
    return color(5, 5);
  };
  polygon_stipple(context, {});
  for (int frame = 0; frame < 2; ++frame) {
    enable(context, GL_POLYGON_STIPPLE, true);
    enable(context, GL_TEXTURE_2D, false);
    EXPECT_NE(square(), kRed);
    enable(context, GL_POLYGON_STIPPLE, false);
    enable(context, GL_TEXTURE_2D, true);
    EXPECT_EQ(square(), kRed);
    ++context.revision;
    clear(context, GL_COLOR_BUFFER_BIT);
  }
}

TEST_F(GlTexture, OneDimensionAndWraps) {
  enable(context, GL_TEXTURE_1D, true);
  const auto row = image(2, 1, {kRed, kBlue});
  tex_image(context, 1, GL_TEXTURE_1D, 0, 3, 2, 1, 1, 0, row);
  parameter(GL_TEXTURE_MIN_FILTER, GL_NEAREST, GL_TEXTURE_1D);
  parameter(GL_TEXTURE_MAG_FILTER, GL_NEAREST, GL_TEXTURE_1D);
  draw({1, 1, 1, 1}, 2);
  EXPECT_EQ(color(8, 60), kRed);
  EXPECT_EQ(color(24, 60), kBlue);
  EXPECT_EQ(color(40, 60), kRed);
  parameter(GL_TEXTURE_WRAP_S, GL_MIRRORED_REPEAT, GL_TEXTURE_1D);
  draw({1, 1, 1, 1}, 2);
  EXPECT_EQ(color(40, 60), kBlue);
  EXPECT_EQ(color(56, 60), kRed);
  parameter(GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE, GL_TEXTURE_1D);
  draw({1, 1, 1, 1}, 2);
  EXPECT_EQ(color(56, 60), kBlue);
  enable(context, GL_TEXTURE_2D, true);  // the last target counts, though it is incomplete
  draw({0, 1, 0, 1});
  EXPECT_EQ(color(56, 60), kGreen);
}

TEST_F(GlTexture, CopiedFromTheFramebuffer) {
  clear_color(context, 1, 0, 0, 0.2);
  clear(context, GL_COLOR_BUFFER_BIT);
  copy_tex_image(context, 2, GL_TEXTURE_2D, 0, GL_RGB, 0, 0, 4, 4, 0);
  clear_color(context, 0, 0, 1, 1);
  clear(context, GL_COLOR_BUFFER_BIT);
  copy_tex_sub_image(context, 2, GL_TEXTURE_2D, 0, 1, 1, 0, 10, 10, 1, 2);
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
  std::vector<Bytes> texels(16);
  get_tex_image(context, GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
  EXPECT_EQ(texels[0], kRed);
  EXPECT_EQ(texels[5], kBlue);
  EXPECT_EQ(texels[9], kBlue);
  EXPECT_EQ(texels[6], kRed);
}

// ---- objects

TEST_F(GlTexture, ObjectsAreSharedAndOutliveTheirNames) {
  Context other(context.shared);
  std::array<GLuint, 2> names{};
  gen_textures(context, 2, names.data());
  EXPECT_NE(names[0], names[1]);
  EXPECT_EQ(is_texture(context, names[0]), GL_FALSE);  // until it is bound
  bind_texture(context, GL_TEXTURE_2D, names[0]);
  upload(0, GL_RGB, filled(2, 2, kGreen));
  EXPECT_EQ(is_texture(other, names[0]), GL_TRUE);
  bind_texture(other, GL_TEXTURE_2D, names[0]);
  bind_texture(context, GL_TEXTURE_3D, names[0]);
  EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
  EXPECT_EQ(context.state.texture.unit[0].bound[2], 0U);
  delete_textures(context, 2, names.data());
  EXPECT_EQ(context.state.texture.unit[0].bound[1], 0U);
  EXPECT_EQ(is_texture(context, names[0]), GL_FALSE);
  EXPECT_EQ(get_tex_level_parameter(other, GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH).value.at(0), 2);  // still bound there
  EXPECT_EQ(level_parameter(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH), 0);                             // the default one
  GLboolean resident = GL_FALSE;
  EXPECT_EQ(are_textures_resident(context, 1, names.data(), &resident), GL_FALSE);
  EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(GlTexture, InternalFormatsHaveTheirComponents) {
  struct Case {
    GLint format;
    std::array<int, 6> sizes;  // R G B A L I
  };
  for (const Case& test : {Case{1, {0, 0, 0, 0, 8, 0}}, Case{2, {0, 0, 0, 8, 8, 0}}, Case{3, {8, 8, 8, 0, 0, 0}},
                           Case{4, {8, 8, 8, 8, 0, 0}}, Case{GL_ALPHA12, {0, 0, 0, 8, 0, 0}},
                           Case{GL_INTENSITY4, {0, 0, 0, 0, 0, 8}}, Case{GL_RGB5_A1, {8, 8, 8, 8, 0, 0}},
                           Case{GL_R3_G3_B2, {8, 8, 8, 0, 0, 0}}, Case{GL_COMPRESSED_LUMINANCE, {0, 0, 0, 0, 8, 0}}}) {
    upload(0, test.format, filled(2, 2, kGrey));
    ASSERT_EQ(error(), GLenum{GL_NO_ERROR}) << test.format;
    const auto names =
        std::to_array<GLenum>({GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE,
                               GL_TEXTURE_LUMINANCE_SIZE, GL_TEXTURE_INTENSITY_SIZE});
    for (std::size_t i = 0; i < names.size(); ++i)
      EXPECT_EQ(level_parameter(GL_TEXTURE_2D, 0, names[i]), test.sizes[i]) << test.format;
  }
  EXPECT_EQ(level_parameter(GL_TEXTURE_2D, 0, GL_TEXTURE_INTERNAL_FORMAT), GL_LUMINANCE);
  EXPECT_EQ(level_parameter(GL_TEXTURE_2D, 0, GL_TEXTURE_COMPRESSED), 0);
}

TEST_F(GlTexture, BordersCountAndAreCutOff) {
  std::vector<Bytes> pixels(4 * 6, kRed);
  for (const int y : {1, 2, 3, 4})
    for (const int x : {1, 2}) pixels[static_cast<std::size_t>(y * 4 + x)] = kBlue;
  tex_image(context, 2, GL_TEXTURE_2D, 0, GL_RGB, 4, 6, 1, 1, image(4, 6, pixels));
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
  EXPECT_EQ(level_parameter(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH), 4);
  EXPECT_EQ(level_parameter(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT), 6);
  EXPECT_EQ(level_parameter(GL_TEXTURE_2D, 0, GL_TEXTURE_BORDER), 1);
  EXPECT_EQ(bound_texture(context, GL_TEXTURE_2D)->face[0][0].texel, std::vector<Texel>(8, {0, 0, 255, 255}));
  tex_sub_image(context, 2, GL_TEXTURE_2D, 0, -1, -1, 0, filled(2, 2, kGreen));
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
  EXPECT_EQ(bound_texture(context, GL_TEXTURE_2D)->face[0][0].texel[0], (Texel{0, 255, 0, 255}));
  tex_sub_image(context, 2, GL_TEXTURE_2D, 0, -2, 0, 0, filled(2, 2, kGreen));
  EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
  std::vector<Bytes> read(24);
  get_tex_image(context, GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, read.data());
  EXPECT_EQ(read[4 + 1], kGreen);
  EXPECT_EQ(read[23], kBlue);
}

TEST_F(GlTexture, ImagesWithErrorsAreRefused) {
  const auto refused = [this](GLenum code, int dimensions, GLenum target, int level, GLint format, int width,
                              int height, int depth, int border) {
    tex_image(context, dimensions, target, level, format, width, height, depth, border, nullptr);
    EXPECT_EQ(error(), code) << target << ' ' << level << ' ' << width << ' ' << height;
  };
  refused(GL_INVALID_ENUM, 2, GL_TEXTURE_1D, 0, 3, 1, 1, 1, 0);
  refused(GL_INVALID_ENUM, 2, GL_TEXTURE_CUBE_MAP, 0, 3, 1, 1, 1, 0);
  refused(GL_INVALID_ENUM, 3, GL_TEXTURE_2D, 0, 3, 1, 1, 1, 0);
  refused(GL_INVALID_VALUE, 2, GL_TEXTURE_2D, 0, 5, 1, 1, 1, 0);
  refused(GL_INVALID_VALUE, 2, GL_TEXTURE_2D, -1, 3, 1, 1, 1, 0);
  refused(GL_INVALID_VALUE, 2, GL_TEXTURE_2D, 13, 3, 1, 1, 1, 0);
  refused(GL_INVALID_VALUE, 2, GL_TEXTURE_2D, 0, 3, 3, 1, 1, 0);
  refused(GL_INVALID_VALUE, 2, GL_TEXTURE_2D, 0, 3, -1, 1, 1, 0);
  refused(GL_INVALID_VALUE, 2, GL_TEXTURE_2D, 0, 3, 5, 4, 1, 1);
  refused(GL_INVALID_VALUE, 2, GL_TEXTURE_2D, 0, 3, 4, 4, 1, 2);
  refused(GL_INVALID_VALUE, 2, GL_TEXTURE_2D, 0, 3, 8192, 1, 1, 0);
  refused(GL_INVALID_VALUE, 2, GL_TEXTURE_2D, 12, 3, 2, 1, 1, 0);
  refused(GL_INVALID_VALUE, 2, GL_TEXTURE_CUBE_MAP_POSITIVE_X, 0, 3, 2, 4, 1, 0);
  refused(GL_INVALID_OPERATION, 3, GL_TEXTURE_3D, 0, GL_DEPTH_COMPONENT, 2, 2, 2, 0);
  upload(0, GL_DEPTH_COMPONENT, filled(2, 2, kGrey));
  EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
  tex_sub_image(context, 2, GL_TEXTURE_2D, 0, 0, 0, 0, filled(1, 1, kGrey));
  EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});  // no image
  copy_tex_image(context, 2, GL_TEXTURE_2D, 0, 3, 0, 0, 4, 4, 0);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(level_parameter(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH), 0);
  compressed_image(context);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  GLubyte texel = 7;
  get_tex_image(context, GL_TEXTURE_2D, 0, GL_RGB, GL_UNSIGNED_BYTE, &texel);  // none: nothing is written
  get_tex_image(context, GL_PROXY_TEXTURE_2D, 0, GL_RGB, GL_UNSIGNED_BYTE, &texel);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(texel, 7);
}

TEST_F(GlTexture, ProxiesAnswerWithoutErrors) {
  tex_image(context, 2, GL_PROXY_TEXTURE_2D, 0, GL_RGBA8, 64, 32, 1, 0, nullptr);
  EXPECT_EQ(level_parameter(GL_PROXY_TEXTURE_2D, 0, GL_TEXTURE_WIDTH), 64);
  EXPECT_EQ(level_parameter(GL_PROXY_TEXTURE_2D, 0, GL_TEXTURE_ALPHA_SIZE), 8);
  tex_image(context, 2, GL_PROXY_TEXTURE_2D, 0, GL_RGBA8, 8192, 32, 1, 0, nullptr);
  EXPECT_EQ(level_parameter(GL_PROXY_TEXTURE_2D, 0, GL_TEXTURE_WIDTH), 0);
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

// ---- parameters

TEST_F(GlTexture, ParametersAndTheirErrors) {
  const auto get = [this](GLenum pname) { return get_tex_parameter(context, GL_TEXTURE_2D, pname).value.at(0); };
  parameter(GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  EXPECT_EQ(get(GL_TEXTURE_WRAP_S), GL_CLAMP_TO_BORDER);
  parameter(GL_TEXTURE_WRAP_S, GL_LINEAR);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  parameter(GL_TEXTURE_MAG_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  parameter(GL_TEXTURE_BORDER_COLOR, 1);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  parameter(GL_TEXTURE_BASE_LEVEL, -1);
  EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
  parameter(GL_TEXTURE_WIDTH, 1);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  parameter(GL_TEXTURE_WRAP_S, GL_REPEAT, GL_PROXY_TEXTURE_2D);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  tex_parameter(context, GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, {{2147483647.0, 0.0, -2147483648.0, 0.0}, true, true});
  EXPECT_EQ(get_tex_parameter(context, GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR).value.at(0), 1);
  tex_parameter(context, GL_TEXTURE_2D, GL_TEXTURE_PRIORITY, {{7.0}, false, false});
  EXPECT_EQ(get(GL_TEXTURE_PRIORITY), 1);
  EXPECT_EQ(get(GL_TEXTURE_RESIDENT), 1);
  environment(GL_RGB_SCALE, 3);
  EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
  environment(GL_OPERAND1_ALPHA, GL_SRC_COLOR);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  environment(GL_COMBINE_ALPHA, GL_DOT3_RGB);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  environment(GL_SOURCE1_RGB, GL_TEXTURE0 + kTextureUnits);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  tex_env(context, GL_TEXTURE_FILTER_CONTROL, GL_TEXTURE_LOD_BIAS, {{-2.5}, false, false});
  EXPECT_EQ(get_tex_env(context, GL_TEXTURE_FILTER_CONTROL, GL_TEXTURE_LOD_BIAS).value.at(0), -2.5);
  tex_env(context, GL_TEXTURE_2D, GL_TEXTURE_ENV_MODE, {{GL_ADD}, true, false});
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  tex_gen(context, GL_T, GL_TEXTURE_GEN_MODE, {{GL_SPHERE_MAP}, true, false});
  EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
  tex_gen(context, GL_R, GL_TEXTURE_GEN_MODE, {{GL_SPHERE_MAP}, true, false});
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  tex_gen(context, GL_Q + 1, GL_EYE_PLANE, {{1.0}, true, true});
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
  active_texture(context, GL_TEXTURE0 + kTextureUnits);
  EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(GlTexture, EyePlanesAreOfTheModelviewMatrix) {
  translate(context, 3, 0, 0);
  tex_gen(context, GL_S, GL_EYE_PLANE, {{1, 0, 0, 0}, false, true});
  EXPECT_EQ(get_tex_gen(context, GL_S, GL_EYE_PLANE).value, (std::vector<double>{1, 0, 0, -3}));
}

}  // namespace
}  // namespace halfplane::gl::texture_test
