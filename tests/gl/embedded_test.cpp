// Contexts of OpenGL ES-CM 1.1: what is theirs alone, and what they refuse.
#include "gl/core/embedded.hpp"

#include <GL/glext.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <string_view>
#include <vector>

#include "gl/core/commands.hpp"
#include "gl/core/entry_points.hpp"
#include "tests/gl/textured_window.hpp"

namespace halfplane::gl::embedded_test {
namespace {

struct Embedded : testing::Test {
  Embedded() { context.is_embedded = true; }
  GLenum error_after(const auto& command) {
    command();
    return get_error(context);
  }
  std::string_view text(GLenum name) { return reinterpret_cast<const char*>(get_string(context, name)); }

  TexturedWindow window;
  Context& context = window.context;
};

TEST_F(Embedded, TheNameOfTheVersionSaysWhichApiItIs) {
  EXPECT_TRUE(text(GL_VERSION).starts_with("OpenGL ES-CM 1.1 "));
  EXPECT_NE(text(GL_EXTENSIONS).find("GL_OES_point_sprite"), std::string_view::npos);
  EXPECT_EQ(text(GL_EXTENSIONS).find("GL_ARB_"), std::string_view::npos);
  context.is_embedded = false;
  EXPECT_TRUE(text(GL_VERSION).starts_with("1.5 "));
}

TEST_F(Embedded, WhatOpenGlEsDoesNotHaveIsRefused) {
  for (const GLenum mode : {GL_QUADS, GL_QUAD_STRIP, GL_POLYGON}) {
    EXPECT_EQ(error_after([&] { draw_arrays(context, mode, 0, 4); }), GLenum{GL_INVALID_ENUM});
  }
  EXPECT_EQ(error_after([&] { draw_arrays(context, GL_TRIANGLE_FAN, 0, 0); }), GLenum{GL_NO_ERROR});
  EXPECT_EQ(error_after([&] { enable(context, GL_TEXTURE_1D, true); }), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(error_after([&] { enable(context, GL_LINE_STIPPLE, true); }), GLenum{GL_INVALID_ENUM});
  for (const GLenum cap : {GL_TEXTURE_2D, GL_POINT_SPRITE, GL_CLIP_PLANE5, GL_LIGHT7, GL_ALPHA_TEST}) {
    EXPECT_EQ(error_after([&] { enable(context, cap, false); }), GLenum{GL_NO_ERROR});
  }
  EXPECT_EQ(error_after([&] { array_pointer(context, Array::vertex, 3, GL_DOUBLE, 0, nullptr); }),
            GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(error_after([&] { array_pointer(context, Array::vertex, 3, GL_BYTE, 0, nullptr); }), GLenum{GL_NO_ERROR});
  EXPECT_EQ(error_after([&] { array_pointer(context, Array::color, 4, GL_SHORT, 0, nullptr); }),
            GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(error_after([&] { array_pointer(context, Array::color, 4, GL_UNSIGNED_BYTE, 0, nullptr); }),
            GLenum{GL_NO_ERROR});
}

TEST_F(Embedded, VariantsWithVReadAsManyNumbersAsTheParameterHas) {
  constexpr std::array<GLint, 4> kCrop{3, 5, 16, 8};
  const EntryPoint& entry = entry_points().at("glTexParameteriv");
  make_current(&context, context.drawable, context.drawable);
  reinterpret_cast<void (*)(GLenum, GLenum, const GLint*)>(const_cast<void*>(entry.function))(
      GL_TEXTURE_2D, kTextureCropRect, kCrop.data());
  make_current(nullptr, nullptr, nullptr);
  EXPECT_EQ(get_tex_parameter(context, GL_TEXTURE_2D, kTextureCropRect).value, (std::vector<double>{3, 5, 16, 8}));
  for (const auto& [name, count] : {std::pair{GL_AMBIENT, 4U},
                                    {GL_SPOT_DIRECTION, 3U},
                                    {GL_SHININESS, 1U},
                                    {GL_COLOR_INDEXES, 3U},
                                    {GL_LIGHT_MODEL_AMBIENT, 4U},
                                    {GL_FOG_COLOR, 4U},
                                    {GL_POINT_DISTANCE_ATTENUATION, 3U},
                                    {GL_TEXTURE_ENV_COLOR, 4U},
                                    {GL_TEXTURE_BORDER_COLOR, 4U},
                                    {GL_EYE_PLANE, 4U},
                                    {GL_TEXTURE_WRAP_S, 1U},
                                    {0, 1U}})
    EXPECT_EQ(param_count(static_cast<GLenum>(name)), count) << name;
  for (const GLenum name : {GL_FOG_MODE, GL_LIGHT_MODEL_TWO_SIDE, GL_TEXTURE_MIN_FILTER, GL_OPERAND2_ALPHA})
    EXPECT_TRUE(is_unscaled(name)) << name;
  for (const GLenum name : {GL_FOG_DENSITY, GL_AMBIENT, GL_RGB_SCALE}) EXPECT_FALSE(is_unscaled(name)) << name;
}

TEST_F(Embedded, MatricesAsBitsOfFloats) {
  translate(context, 0.5, 0, 0);
  const Values bits = get(context, kModelviewBits);
  ASSERT_EQ(bits.value.size(), 16U);
  EXPECT_EQ(bits.kind, ValueKind::integer);
  EXPECT_EQ(bits.value[12], std::bit_cast<int>(0.5F));
}

/// A red point of 16 pixels in the middle of the window, with a texture that is green above and blue below.
struct Sprites : Embedded {
  Sprites() {
    window.use_unit(GL_TEXTURE0);
    window.upload(0, GL_RGBA, TexturedWindow::image(1, 2, {kGreen, kBlue}));  // t = 0 is the upper row of a sprite
    window.environment(GL_TEXTURE_ENV_MODE, GL_REPLACE);
    point_size(context, 16);
    tex_env(context, GL_POINT_SPRITE, GL_COORD_REPLACE, {{1}, true, false});
  }
  void draw_point() {
    ++context.revision;
    begin(context, GL_POINTS);
    tex_coord(context, GL_TEXTURE0, 0.5, 0.75, 0, 1);
    vertex(context, 0, 0, 0, 1);
    end(context);
  }
};

TEST_F(Sprites, HaveTheTextureFromTheUpperLeftCorner) {
  enable(context, GL_POINT_SPRITE, true);
  draw_point();
  EXPECT_EQ(window.color(32, 36), kGreen);
  EXPECT_EQ(window.color(32, 28), kBlue);
  EXPECT_EQ(window.color(32, 44), (Bytes{0, 0, 0, window.color(0, 0)[3]}));
}

TEST_F(Sprites, WithoutThemAPointHasTheCoordinatesOfItsVertex) {
  draw_point();
  EXPECT_EQ(window.color(32, 36), kBlue);
  EXPECT_EQ(window.color(32, 28), kBlue);
}

TEST_F(Embedded, EachPointHasItsSizeInAnArray) {
  const std::array<GLfloat, 4> places{-0.5F, 0, 0.5F, 0};
  const std::array<GLfixed, 2> sizes{2 << 16, 6 << 16};
  array_pointer(context, Array::vertex, 2, GL_FLOAT, 0, places.data());
  array_pointer(context, Array::point_size, 1, GL_FIXED, 0, sizes.data());
  client_state(context, GL_VERTEX_ARRAY, true);
  client_state(context, kPointSizeArray, true);
  draw_arrays(context, GL_POINTS, 0, 2);
  EXPECT_EQ(window.drawn_pixels(), 2 * 2 + 6 * 6);
  EXPECT_EQ(get(context, GL_POINT_SIZE).value.at(0), 1);
  EXPECT_EQ(get(context, kPointSizeArrayType).value.at(0), GL_FIXED);
}

/// A palette of `bytes`, the rest of it 0, and indices behind it.
std::vector<GLubyte> paletted(std::vector<GLubyte> palette, std::size_t bytes, const std::vector<GLubyte>& indices) {
  palette.resize(bytes);
  palette.insert(palette.end(), indices.begin(), indices.end());
  return palette;
}

struct Palettes : Embedded {
  void load(GLenum format, GLint level, const std::vector<GLubyte>& bytes) {
    make_current(&context, &window.drawable, &window.drawable);
    enter_compressed_image(context, GL_TEXTURE_2D, level, format, 2, 2, 0, static_cast<GLsizei>(bytes.size()),
                           bytes.data());
    make_current(nullptr, nullptr, nullptr);
  }
  std::vector<Bytes> texels(int level, std::size_t count) {
    std::vector<Bytes> read(count);
    get_tex_image(context, GL_TEXTURE_2D, level, GL_RGBA, GL_UNSIGNED_BYTE, read.data());
    return read;
  }
};

TEST_F(Palettes, OfFourBitsATexelWithTwoLevels) {
  // Three entries of RGBA: red, green, blue.
  const std::vector<GLubyte> colors{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255};
  load(kFirstPalette + 1, -1, paletted(colors, 16 * 4, {0x01, 0x20, 0x10}));
  EXPECT_EQ(get_error(context), GLenum{GL_NO_ERROR});
  EXPECT_EQ(texels(0, 4), (std::vector<Bytes>{kRed, kGreen, kBlue, kRed}));
  EXPECT_EQ(texels(1, 1), std::vector<Bytes>{kGreen});
}

TEST_F(Palettes, OfEightBitsATexelWithPackedEntries) {
  std::vector<GLubyte> bytes(256 * 2, 0);
  bytes[1] = 0xf8;                // 565: red
  bytes[4] = 0xe0, bytes[5] = 7;  // entry 2: green
  bytes.insert(bytes.end(), {0, 2, 2, 0});
  load(kFirstPalette + 7, 0, bytes);
  EXPECT_EQ(texels(0, 4), (std::vector<Bytes>{kRed, kGreen, kGreen, kRed}));
}

TEST_F(Palettes, AreRefusedWhereTheyAreNotWhole) {
  const std::vector<GLubyte> bytes(16 * 4 + 2);
  const auto error_of = [&](GLenum format, GLint level, const std::vector<GLubyte>& data) {
    load(format, level, data);
    return get_error(context);
  };
  EXPECT_EQ(error_of(kFirstPalette + 1, 0, bytes), GLenum{GL_NO_ERROR});
  EXPECT_EQ(error_of(kFirstPalette + 1, -1, bytes), GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(error_of(kFirstPalette + 1, 1, bytes), GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(error_of(kFirstPalette + 1, -99, bytes), GLenum{GL_INVALID_VALUE});
  EXPECT_EQ(error_of(kFirstPalette + kPalettes, 0, bytes), GLenum{GL_INVALID_ENUM});
  context.is_embedded = false;
  EXPECT_EQ(error_of(kFirstPalette + 1, 0, bytes), GLenum{GL_INVALID_ENUM});
}

}  // namespace
}  // namespace halfplane::gl::embedded_test
