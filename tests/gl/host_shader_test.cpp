// Fragments that the host shades, on the picture of a drawable without a window, against the formulas of OpenGL 1.5, written
// again here: combiners of two units (3.8.13), 3D textures and cube maps (3.8.6, 3.8.8), depth comparison (3.8.14), colour
// sum (3.9) and fog (3.10). Coverage and depths: host_coverage_test.cpp.
#include "gl/core/host_shader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "sim/scene/random.hpp"
#include "textured_window.hpp"

namespace halfplane::gl::host_shader_test {
namespace {

constexpr int kSide = TexturedWindow::kSide;

class HostShader : public ::testing::Test, protected TexturedWindow {
 protected:
  HostShader() : TexturedWindow("full stencil.bits=8", OnMissing::host) {}

  /// The whole window; each corner of it has the coordinates that `place(x, y)` gives for x and y of 0 or 1.
  template <class Place>
  void quad(const Vec4& c, const Place& place, double z = 0) {
    ++context.revision;
    gl::color(context, c[0], c[1], c[2], c[3]);
    begin(context, GL_QUADS);
    for (const auto& [x, y] : {std::array{0, 0}, std::array{1, 0}, std::array{1, 1}, std::array{0, 1}}) {
      place(x, y);
      vertex(context, 2 * x - 1, 2 * y - 1, z, 1);
    }
    gl::end(context);
  }
  void coordinates(GLenum unit, double s, double t, double r = 0, double q = 1) {
    gl::tex_coord(context, unit, s, t, r, q);
  }
};

Vec4 real(const Bytes& bytes) { return {bytes[0] / 255.0, bytes[1] / 255.0, bytes[2] / 255.0, bytes[3] / 255.0}; }

// ---- combiners

struct Combiner {
  GLenum function = GL_MODULATE;
  std::array<GLenum, 3> source{}, operand{};
  double scale = 1;
};

struct Colors {
  std::array<Vec4, 2> texture;
  std::array<Vec4, 2> constant;
  Vec4 primary, previous;
};

/// Tables 3.24 and 3.25. `unit`: at work.
double argument(const Combiner& combiner, std::size_t i, std::size_t c, const Colors& colors, std::size_t unit) {
  const auto color = [&]() -> const Vec4& {
    switch (combiner.source[i]) {
      case GL_TEXTURE0: return colors.texture[0];
      case GL_TEXTURE1: return colors.texture[1];
      case GL_TEXTURE: return colors.texture[unit];
      case GL_CONSTANT: return colors.constant[unit];
      case GL_PRIMARY_COLOR: return colors.primary;
      default: return colors.previous;
    }
  }();
  switch (combiner.operand[i]) {
    case GL_SRC_COLOR: return color[c];
    case GL_ONE_MINUS_SRC_COLOR: return 1 - color[c];
    case GL_SRC_ALPHA: return color[3];
    default: return 1 - color[3];
  }
}

double combined(const Combiner& combiner, std::size_t c, const Colors& colors, std::size_t unit) {
  const auto arg = [&](std::size_t i, std::size_t channel) { return argument(combiner, i, channel, colors, unit); };
  double value = 0;
  switch (combiner.function) {
    case GL_REPLACE: value = arg(0, c); break;
    case GL_MODULATE: value = arg(0, c) * arg(1, c); break;
    case GL_ADD: value = arg(0, c) + arg(1, c); break;
    case GL_ADD_SIGNED: value = arg(0, c) + arg(1, c) - 0.5; break;
    case GL_INTERPOLATE: value = arg(0, c) * arg(2, c) + arg(1, c) * (1 - arg(2, c)); break;
    case GL_SUBTRACT: value = arg(0, c) - arg(1, c); break;
    default:
      value = 4 * ((arg(0, 0) - 0.5) * (arg(1, 0) - 0.5) + (arg(0, 1) - 0.5) * (arg(1, 1) - 0.5) +
                   (arg(0, 2) - 0.5) * (arg(1, 2) - 0.5));
  }
  return std::clamp(value * combiner.scale, 0.0, 1.0);
}

TEST_F(HostShader, EveryCombinerOfTwoUnits) {
  constexpr std::array<GLenum, 8> kFunctions{GL_REPLACE,     GL_MODULATE, GL_ADD,      GL_ADD_SIGNED,
                                             GL_INTERPOLATE, GL_SUBTRACT, GL_DOT3_RGB, GL_DOT3_RGBA};
  constexpr std::array<GLenum, 6> kSources{GL_TEXTURE,  GL_TEXTURE0,      GL_TEXTURE1,
                                           GL_CONSTANT, GL_PRIMARY_COLOR, GL_PREVIOUS};
  constexpr std::array<GLenum, 4> kOperands{GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_SRC_COLOR, GL_ONE_MINUS_SRC_COLOR};
  Random random(53);
  const auto any = [&](const auto& values, std::size_t count) { return values[random.next() % count]; };
  const auto any_color = [&] {
    Bytes color;
    for (GLubyte& c : color) c = static_cast<GLubyte>(random.next() % 256);
    return color;
  };
  for (int turn = 0; turn < 400; ++turn) {
    SCOPED_TRACE("turn " + std::to_string(turn));
    std::array<std::array<Combiner, 2>, 2> combiner;
    Colors colors;
    for (std::size_t unit = 0; unit < 2; ++unit) {
      use_unit(GL_TEXTURE0 + static_cast<GLenum>(unit));
      const Bytes texel = any_color();
      upload(0, GL_RGBA, filled(1, 1, texel));
      colors.texture[unit] = real(texel);
      colors.constant[unit] = real(any_color());
      env_color(colors.constant[unit]);
      environment(GL_TEXTURE_ENV_MODE, GL_COMBINE);
      for (const std::size_t alpha : {0U, 1U}) {
        Combiner& of = combiner[unit][alpha];
        // Each function comes in the first unit and in the second, of RGB and of alpha.
        const auto start = static_cast<std::size_t>(turn / 8 + 3) * unit + static_cast<std::size_t>(turn) + 5 * alpha;
        of.function = kFunctions[start % (alpha == 0 ? 8 : 6)];
        of.scale = std::array{1.0, 2.0, 4.0}[random.next() % 3];
        environment(alpha == 0 ? GL_COMBINE_RGB : GL_COMBINE_ALPHA, of.function);
        environment(alpha == 0 ? GL_RGB_SCALE : GL_ALPHA_SCALE, of.scale);
        for (GLenum i = 0; i < 3; ++i) {
          of.source[i] = any(kSources, 6);
          of.operand[i] = any(kOperands, alpha == 0 ? 4 : 2);
          environment((alpha == 0 ? GL_SOURCE0_RGB : GL_SOURCE0_ALPHA) + i, of.source[i]);
          environment((alpha == 0 ? GL_OPERAND0_RGB : GL_OPERAND0_ALPHA) + i, of.operand[i]);
        }
      }
    }
    ASSERT_EQ(error(), GLenum{GL_NO_ERROR});
    colors.primary = colors.previous = real(any_color());
    draw(colors.primary);
    for (std::size_t unit = 0; unit < 2; ++unit) {
      const auto& [rgb, alpha] = combiner[unit];
      Vec4 result{};
      for (std::size_t c = 0; c < 4; ++c)
        result[c] = combined(c < 3 || rgb.function == GL_DOT3_RGBA ? rgb : alpha, c, colors, unit);
      colors.previous = result;
    }
    expect_near(color(turn % kSide, 33), colors.previous);
  }
}

TEST_F(HostShader, UnitsOfOtherModesFollowEachOther) {
  use_unit(GL_TEXTURE0);
  upload(0, GL_RGB, filled(1, 1, {200, 100, 50, 255}));
  environment(GL_TEXTURE_ENV_MODE, GL_MODULATE);
  use_unit(GL_TEXTURE1);
  upload(0, GL_LUMINANCE_ALPHA, filled(1, 1, {102, 0, 0, 51}));
  const Vec4 f{0.8, 0.4, 0.2, 0.6}, once{0.8 * 200 / 255, 0.4 * 100 / 255, 0.2 * 50 / 255, 0.6},
      constant{0.1, 0.7, 1, 0};
  env_color(constant);
  const auto check = [&](GLenum mode, const Vec4& expected) {
    SCOPED_TRACE(mode);
    environment(GL_TEXTURE_ENV_MODE, mode);
    draw(f);
    expect_near(color(20, 40), expected);
  };
  check(GL_REPLACE, {0.4, 0.4, 0.4, 0.2});
  check(GL_MODULATE, {0.4 * once[0], 0.4 * once[1], 0.4 * once[2], 0.12});
  check(GL_ADD, {std::min(once[0] + 0.4, 1.0), once[1] + 0.4, once[2] + 0.4, 0.12});
  check(GL_BLEND, {0.6 * once[0] + 0.04, 0.6 * once[1] + 0.28, 0.6 * once[2] + 0.4, 0.12});
  upload(0, GL_RGBA, filled(1, 1, {102, 204, 0, 51}));
  check(GL_DECAL, {0.8 * once[0] + 0.08, 0.8 * once[1] + 0.16, 0.8 * once[2], 0.6});
}

/// Each unit has its own coordinates, and both are divided at every pixel.
TEST_F(HostShader, CoordinatesOfEachUnitUnderPerspective) {
  constexpr int kTexels = 64;
  std::vector<Bytes> columns, rows;
  for (int y = 0; y < kTexels; ++y)
    for (int x = 0; x < kTexels; ++x) {
      columns.push_back({static_cast<GLubyte>(3 * x), 0, 0, 255});
      rows.push_back({0, static_cast<GLubyte>(3 * y), 0, 255});
    }
  use_unit(GL_TEXTURE0);
  upload(0, GL_RGB, image(kTexels, kTexels, columns));
  environment(GL_TEXTURE_ENV_MODE, GL_REPLACE);
  use_unit(GL_TEXTURE1);
  upload(0, GL_RGB, image(kTexels, kTexels, rows));
  environment(GL_TEXTURE_ENV_MODE, GL_ADD);
  // A floor from x = -4 to 4, with w from 1 at the bottom to 4 at the top. Unit 0 has s = (x + 4) / 8, unit 1 has
  // t = (w - 1) / 3 over q = 1 + s.
  ++context.revision;
  begin(context, GL_QUADS);
  for (const auto& [x, w] : {std::array{-4, 1}, std::array{4, 1}, std::array{4, 4}, std::array{-4, 4}}) {
    const double s = (x + 4) / 8.0;
    coordinates(GL_TEXTURE0, s, 0);
    coordinates(GL_TEXTURE1, 0, (w - 1) / 3.0, 0, 1 + s);
    vertex(context, x, w == 1 ? -1 : 4, 0, w);
  }
  gl::end(context);
  int compared = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      // The floor's height in clip space is (5 w - 8) / 3.
      const double px = 2 * (x + 0.5) / kSide - 1, py = 2 * (y + 0.5) / kSide - 1, w = 8 / (5 - 3 * py);
      const double s = (px * w + 4) / 8, t = (w - 1) / 3 / (1 + s);
      const auto is_clear = [](double texel) { return std::abs(texel - std::rint(texel)) > 0.02; };
      if (!is_clear(kTexels * s) || !is_clear(kTexels * t)) continue;
      ++compared;
      ASSERT_EQ(color(x, y), (Bytes{static_cast<GLubyte>(3 * std::floor(kTexels * s)),
                                    static_cast<GLubyte>(3 * std::floor(kTexels * t)), 0, 255}))
          << x << " " << y;
    }
  EXPECT_GT(compared, kSide * kSide * 9 / 10);
}

/// A unit of its own, whichever it is, is what the model's texture unit draws: nothing is missing.
TEST(HostShaderDeath, OneUnitNeedsNoHost) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  const auto draw_with = [](bool first, bool second) {
    TexturedWindow window("full texture.unit=trilinear perspective.colors=1", OnMissing::stop);
    Context& context = window.context;
    for (const GLenum unit : {GL_TEXTURE0, GL_TEXTURE1}) {
      active_texture(context, unit);
      enable(context, GL_TEXTURE_2D, unit == GL_TEXTURE0 ? first : second);
      window.nearest();
    }
    window.upload(0, GL_RGB, TexturedWindow::image(2, 1, {kRed, kBlue}));
    tex_coord(context, GL_TEXTURE1, 0.75, 0, 0, 1);
    window.draw({1, 1, 1, 1});
    std::_Exit(window.color(10, 10) == (second ? kBlue : kRed) ? 0 : 1);
  };
  EXPECT_EXIT(draw_with(true, false), testing::ExitedWithCode(0), "");
  EXPECT_EXIT(draw_with(false, true), testing::ExitedWithCode(0), "");
  EXPECT_EXIT(draw_with(true, true), testing::ExitedWithCode(2), "several textures at once");
}

// ---- 3D textures and cube maps

TEST_F(HostShader, ThreeDimensionalTexturesAreTrilinear) {
  const std::vector<Bytes> corners{{0, 10, 20, 255},   {250, 0, 40, 255},  {30, 200, 60, 255}, {90, 90, 90, 255},
                                   {255, 255, 0, 255}, {0, 128, 255, 255}, {70, 20, 190, 255}, {10, 240, 130, 255}};
  enable(context, GL_TEXTURE_3D, true);
  upload(0, GL_RGB, image(2, 2, corners, 2), GL_TEXTURE_3D, 3);
  filter(GL_LINEAR, GL_TEXTURE_3D);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    parameter(wrap, GL_CLAMP_TO_EDGE, GL_TEXTURE_3D);
  environment(GL_TEXTURE_ENV_MODE, GL_REPLACE);
  for (const double r : {0.0, 0.3, 0.5, 0.65, 1.0}) {
    quad({1, 1, 1, 1}, [&](int x, int y) { coordinates(GL_TEXTURE0, x, y, r); });
    for (const auto& [px, py] : {std::array{5, 9}, std::array{20, 40}, std::array{33, 31}, std::array{60, 62}}) {
      const std::array<double, 3> place{(px + 0.5) / kSide, (py + 0.5) / kSide, r};
      Vec4 expected{};
      for (std::size_t corner = 0; corner < 8; ++corner) {
        double weight = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double along = std::clamp(2 * place[axis] - 0.5, 0.0, 1.0);
          weight *= (corner >> axis & 1) != 0 ? along : 1 - along;
        }
        for (std::size_t c = 0; c < 4; ++c) expected[c] += weight * corners[corner][c] / 255;
      }
      expect_near(color(px, py), expected);
    }
  }
  filter(GL_NEAREST, GL_TEXTURE_3D);
  quad({1, 1, 1, 1}, [&](int x, int y) { coordinates(GL_TEXTURE0, x, y, 0.75); });
  EXPECT_EQ(color(40, 10), corners[5]);
  EXPECT_EQ(color(10, 40), corners[6]);
}

/// Table 3.19: each face, and each of its quarters.
TEST_F(HostShader, EveryFaceOfACubeMap) {
  enable(context, GL_TEXTURE_CUBE_MAP, true);
  nearest(GL_TEXTURE_CUBE_MAP);
  environment(GL_TEXTURE_ENV_MODE, GL_REPLACE);
  const auto texel = [](std::size_t face, int s, int t) {
    return Bytes{static_cast<GLubyte>(40 * face + 10), static_cast<GLubyte>(200 * s), static_cast<GLubyte>(100 * t),
                 255};
  };
  for (std::size_t face = 0; face < 6; ++face)
    upload(0, GL_RGB, image(2, 2, {texel(face, 0, 0), texel(face, 1, 0), texel(face, 0, 1), texel(face, 1, 1)}),
           GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face));
  // Directions whose sc and tc are given: solved from the table.
  const auto direction = [](std::size_t face, double sc, double tc) -> Vec3 {
    switch (face) {
      case 0: return {1, -tc, -sc};
      case 1: return {-1, -tc, sc};
      case 2: return {sc, 1, tc};
      case 3: return {sc, -1, -tc};
      case 4: return {sc, -tc, 1};
      default: return {-sc, -tc, -1};
    }
  };
  for (std::size_t face = 0; face < 6; ++face) {
    SCOPED_TRACE(face);
    // The window is the face, of any length of directions.
    quad({1, 1, 1, 1}, [&](int x, int y) {
      const Vec3 d = direction(face, 0.98 * (2 * x - 1), 0.98 * (2 * y - 1));
      coordinates(GL_TEXTURE0, 3 * d[0], 3 * d[1], 3 * d[2]);
    });
    for (const int s : {0, 1})
      for (const int t : {0, 1})
        for (const int within : {3, 16, 29}) EXPECT_EQ(color(32 * s + within, 32 * t + within), texel(face, s, t));
  }
}

/// A face's levels by how fast the direction moves on it.
TEST_F(HostShader, LevelsOfACubeMap) {
  enable(context, GL_TEXTURE_CUBE_MAP, true);
  parameter(GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST, GL_TEXTURE_CUBE_MAP);
  for (GLenum face = 0; face < 6; ++face)
    for (int level = 0; level < 3; ++level)
      upload(level, GL_RGB,
             filled(4 >> level, 4 >> level, std::array{kRed, kGreen, kBlue}[static_cast<std::size_t>(level)]),
             GL_TEXTURE_CUBE_MAP_POSITIVE_X + face);
  // `extent`: of the face over 64 pixels; a texel a pixel at 16.
  const auto middle = [&](double extent) {
    viewport(context, 0, 0, 8, 8);
    quad({1, 1, 1, 1}, [&](int x, int y) { coordinates(GL_TEXTURE0, 1, extent * (y - 0.5), extent * (x - 0.5)); });
    return color(4, 4);
  };
  EXPECT_EQ(middle(1), kRed);    // 2 texels on 8 pixels
  EXPECT_EQ(middle(8), kGreen);  // 2 texels a pixel
  EXPECT_EQ(middle(16), kBlue);
}

// ---- sampling

/// Between two levels by the fraction of the level of detail, in a unit of two.
TEST_F(HostShader, LevelsAreThoseOfTheSpecification) {
  use_unit(GL_TEXTURE0);
  upload(0, GL_RGB, filled(1, 1, {255, 255, 255, 255}));
  use_unit(GL_TEXTURE1);
  for (int level = 0; level < 5; ++level)
    upload(level, GL_RGB, filled(16 >> level, 16 >> level, {static_cast<GLubyte>(50 * level + 20), 0, 0, 255}));
  parameter(GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  // Texels a pixel: 16 repeats / 64.
  const auto red_at = [&](double lod) {
    const double repeats = 4 * std::exp2(lod);
    quad({1, 1, 1, 1}, [&](int x, int y) { coordinates(GL_TEXTURE1, repeats * x, y); });
    return double{1} * color(30, 30)[0];
  };
  for (const double lod : {0.25, 1.0, 1.5, 2.75, 3.5}) EXPECT_NEAR(red_at(lod), 20 + 50 * lod, 1.01) << lod;
  EXPECT_NEAR(red_at(9), 220, 1.01);
  EXPECT_NEAR(red_at(-2), 20, 1.01);
  tex_env(context, GL_TEXTURE_FILTER_CONTROL, GL_TEXTURE_LOD_BIAS, {{0.5}, false, true});
  parameter(GL_TEXTURE_LOD_BIAS, 0.25);
  EXPECT_NEAR(red_at(1), 20 + 50 * 1.75, 1.01);
  parameter(GL_TEXTURE_MAX_LOD, 1.5);
  EXPECT_NEAR(red_at(3), 95, 1.01);
  parameter(GL_TEXTURE_MIN_LOD, 1);
  EXPECT_NEAR(red_at(-3), 70, 1.01);
  parameter(GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
  EXPECT_NEAR(red_at(0.7), 70, 1.01);  // 1.45
}

TEST_F(HostShader, DepthTexturesCompare) {
  enable(context, GL_TEXTURE_2D, true);
  nearest();
  environment(GL_TEXTURE_ENV_MODE, GL_REPLACE);
  // 0.5 and a depth that 8 bits do not tell from it.
  constexpr float kHalf = 0.5F, kMore = 0.5F + 1.0F / 4096;
  auto depths = std::make_shared<Image>(Image{2, 1, 1, GL_DEPTH_COMPONENT, {{kHalf}, {kMore}}});
  upload(0, GL_DEPTH_COMPONENT24, depths);
  EXPECT_EQ(level_parameter(GL_TEXTURE_2D, 0, GL_TEXTURE_DEPTH_SIZE), 24);
  std::array<float, 2> read{};
  get_tex_image(context, GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT, GL_FLOAT, read.data());
  EXPECT_NEAR(read[1], kMore, 1e-7);
  parameter(GL_TEXTURE_COMPARE_MODE, GL_COMPARE_R_TO_TEXTURE);
  const auto passes = [&](double r) {
    quad({0.2, 0.2, 0.2, 1}, [&](int x, int y) { coordinates(GL_TEXTURE0, x, y, r); });
    return std::array{color(10, 10)[0] == 255, color(50, 10)[0] == 255};
  };
  struct Row {
    GLenum func;
    std::array<bool, 2> at_low, between, above;  ///< r of 0, between both depths, 1
  };
  const std::array<Row, 8> rows{{{GL_LEQUAL, {true, true}, {false, true}, {false, false}},
                                 {GL_GEQUAL, {false, false}, {true, false}, {true, true}},
                                 {GL_LESS, {true, true}, {false, true}, {false, false}},
                                 {GL_GREATER, {false, false}, {true, false}, {true, true}},
                                 {GL_EQUAL, {false, false}, {false, false}, {false, false}},
                                 {GL_NOTEQUAL, {true, true}, {true, true}, {true, true}},
                                 {GL_ALWAYS, {true, true}, {true, true}, {true, true}},
                                 {GL_NEVER, {false, false}, {false, false}, {false, false}}}};
  for (const Row& row : rows) {
    SCOPED_TRACE(row.func);
    parameter(GL_TEXTURE_COMPARE_FUNC, row.func);
    EXPECT_EQ(passes(-1), row.at_low);
    EXPECT_EQ(passes(0.5 + 1.0 / 8192), row.between);
    EXPECT_EQ(passes(7), row.above);  // held to 1
  }
  // What the result is read as, and between two texels of which one passes.
  parameter(GL_TEXTURE_COMPARE_FUNC, GL_LESS);
  for (const auto& [mode, wanted] : {std::pair<GLenum, Vec4>{GL_LUMINANCE, {0.5, 0.5, 0.5, 1}},
                                     {GL_INTENSITY, {0.5, 0.5, 0.5, 0.5}},
                                     {GL_ALPHA, {0.2, 0.2, 0.2, 0.5}}}) {
    SCOPED_TRACE(mode);
    parameter(GL_DEPTH_TEXTURE_MODE, mode);
    filter(GL_LINEAR);
    quad({0.2, 0.2, 0.2, 1}, [&](int, int y) { coordinates(GL_TEXTURE0, 0.5, y, 0.5 + 1.0 / 8192); });
    expect_near(color(10, 10), wanted);
  }
}

// ---- after the textures

/// Blending, alpha test and stencil take the sum of the texture and the second colour.
TEST_F(HostShader, ASecondColourIsAddedBeforeBlending) {
  enable(context, GL_TEXTURE_2D, true);
  nearest();
  upload(0, GL_RGB, filled(1, 1, {100, 100, 100, 255}));
  enable(context, GL_COLOR_SUM, true);
  secondary_color(context, 0.2, 0, 0.9);
  clear_color(context, 0, 1, 0, 1);
  clear(context, GL_COLOR_BUFFER_BIT);
  enable(context, GL_BLEND, true);
  blend_func_separate(context, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ZERO);
  draw({1, 0.5, 0.25, 0.5});
  const double t = 100 / 255.0;
  expect_near(color(9, 9), {(t + 0.2) / 2, (t * 0.5 + 1) / 2, std::min(t * 0.25 + 0.9, 1.0) / 2, 0.5});
}

TEST_F(HostShader, FogOfTexturesIsOfEachFragment) {
  enable(context, GL_TEXTURE_2D, true);
  nearest();
  upload(0, GL_RGB, filled(1, 1, {255, 255, 255, 255}));
  enable(context, GL_FOG, true);
  enable(context, GL_BLEND, true);
  blend_func_separate(context, GL_ONE, GL_ZERO, GL_ONE, GL_ZERO);
  fog(context, GL_FOG_MODE, {.value = {GL_EXP2}});
  fog(context, GL_FOG_DENSITY, {.value = {1}});
  fog(context, GL_FOG_COORD_SRC, {.value = {GL_FOG_COORD}});
  fog(context, GL_FOG_COLOR, {.value = {0, 0, 1, 1}, .is_vector = true});
  quad({1, 0.5, 0, 1}, [&](int x, int) { fog_coord(context, 3.0 * x); });
  for (const int x : {2, 17, 30, 45, 63}) {
    const double distance = 3 * (x + 0.5) / kSide, f = std::exp(-distance * distance);
    expect_near(color(x, 20), {f, 0.5 * f, 1 - f, 1});
  }
}

TEST_F(HostShader, StippledPolygonsKeepTheirTextureAndTheAlphaTest) {
  enable(context, GL_TEXTURE_2D, true);
  nearest();
  upload(0, GL_RGBA, image(2, 1, {{255, 0, 0, 200}, {0, 255, 0, 0}}));
  environment(GL_TEXTURE_ENV_MODE, GL_REPLACE);
  std::array<std::uint32_t, 32> rows;
  rows.fill(0xcccccccc);
  polygon_stipple(context, rows);
  enable(context, GL_POLYGON_STIPPLE, true);
  clear(context, GL_COLOR_BUFFER_BIT);
  draw({1, 1, 1, 1});
  for (const int x : {4, 5, 36, 37}) EXPECT_NE(color(x, 3)[x < 32 ? 0 : 1], 0) << x;
  for (const int x : {6, 7, 38, 39}) EXPECT_EQ(color(x, 3), (Bytes{0, 0, 0, 0})) << x;
  clear(context, GL_COLOR_BUFFER_BIT);
  enable(context, GL_ALPHA_TEST, true);
  alpha_func(context, GL_GREATER, 0.5);
  draw({1, 1, 1, 1});
  EXPECT_EQ(color(4, 3), (Bytes{255, 0, 0, 200}));
  EXPECT_EQ(color(36, 3), (Bytes{0, 0, 0, 0}));
}

}  // namespace
}  // namespace halfplane::gl::host_shader_test
