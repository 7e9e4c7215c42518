// Primitives and fragments as pictures of 64x64 pixels.
#include "gl/core/primitive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/formats/texture.hpp"
#include "model/stages/color_ops.hpp"
#include "picture.hpp"

namespace halfplane::gl::primitive_test {
namespace {

using Rgb = std::array<int, 3>;
constexpr Rgb kBlack{0, 0, 0}, kRed{255, 0, 0}, kGreen{0, 255, 0}, kBlue{0, 0, 255}, kWhite{255, 255, 255};

void set_color(Context& context, const Rgb& rgb, double alpha = 1) {
  color(context, rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0, alpha);
}

TEST(GlPrimitive, EveryModeCoversItsPixels) {
  const auto pixels = [](GLenum mode, std::initializer_list<std::array<double, 2>> places) {
    Picture picture;
    picture.draw(mode, places);
    EXPECT_EQ(picture.error(), GLenum{GL_NO_ERROR});
    return picture.drawn_pixels();
  };
  EXPECT_EQ(pixels(GL_POINTS, {{1.5, 1.5}, {5.5, 9.5}}), 2);
  EXPECT_EQ(pixels(GL_LINES, {{1.5, 1.5}, {11.5, 1.5}, {1.5, 3.5}, {11.5, 3.5}, {1.5, 7.5}}), 20);
  EXPECT_EQ(pixels(GL_LINE_STRIP, {{1.5, 1.5}, {11.5, 1.5}, {11.5, 11.5}}), 20);
  EXPECT_EQ(pixels(GL_LINE_LOOP, {{1.5, 1.5}, {11.5, 1.5}, {11.5, 11.5}, {1.5, 11.5}}), 40);
  EXPECT_EQ(pixels(GL_TRIANGLES, {{0, 0}, {8, 0}, {8, 8}, {0, 0}, {8, 8}, {0, 8}, {20, 20}, {30, 30}}), 64);
  EXPECT_EQ(pixels(GL_TRIANGLE_STRIP, {{0, 0}, {8, 0}, {0, 8}, {8, 8}}), 64);
  EXPECT_EQ(pixels(GL_TRIANGLE_FAN, {{0, 0}, {8, 0}, {8, 8}, {0, 8}}), 64);
  EXPECT_EQ(pixels(GL_QUADS, {{0, 0}, {8, 0}, {8, 8}, {0, 8}, {20, 20}, {30, 20}, {30, 30}}), 64);
  EXPECT_EQ(pixels(GL_QUAD_STRIP, {{0, 0}, {0, 8}, {8, 0}, {8, 8}, {16, 0}, {16, 8}, {20, 0}}), 128);
  EXPECT_EQ(pixels(GL_POLYGON, {{0, 0}, {8, 0}, {12, 4}, {8, 8}, {0, 8}}), 76);
  EXPECT_EQ(pixels(GL_POLYGON, {{0, 0}, {8, 0}}), 0);
}

/// Colours of the vertices in their order, and colours of the primitives at the given pixels.
struct FlatCase {
  GLenum mode;
  std::vector<std::array<double, 2>> places;
  std::vector<std::size_t> provoking;
  std::vector<std::array<int, 2>> at;
};

TEST(GlPrimitive, FlatShadingTakesTheVertexOfTheMode) {
  const std::vector<FlatCase> cases{
      {GL_LINES, {{1.5, 1.5}, {9.5, 1.5}}, {1}, {{4, 1}}},
      {GL_LINE_STRIP, {{1.5, 1.5}, {9.5, 1.5}, {9.5, 9.5}}, {1, 2}, {{4, 1}, {9, 4}}},
      {GL_LINE_LOOP, {{1.5, 1.5}, {9.5, 1.5}, {1.5, 9.5}}, {1, 0}, {{4, 1}, {1, 4}}},
      {GL_TRIANGLES, {{0, 0}, {20, 0}, {0, 20}}, {2}, {{4, 4}}},
      {GL_TRIANGLE_STRIP, {{0, 0}, {20, 0}, {0, 20}, {20, 20}}, {2, 3}, {{4, 4}, {16, 16}}},
      {GL_TRIANGLE_FAN, {{0, 0}, {20, 0}, {20, 20}, {0, 20}}, {2, 3}, {{16, 4}, {4, 16}}},
      {GL_QUADS, {{0, 0}, {20, 0}, {20, 20}, {0, 20}}, {3, 3}, {{16, 4}, {4, 16}}},
      {GL_QUAD_STRIP, {{0, 0}, {0, 20}, {20, 0}, {20, 20}, {40, 0}, {40, 20}}, {3, 3, 5}, {{2, 16}, {16, 2}, {30, 9}}},
      {GL_POLYGON, {{0, 0}, {20, 0}, {20, 20}, {0, 20}}, {0, 0}, {{16, 4}, {4, 16}}},
  };
  const auto color_of = [](std::size_t i) { return Rgb{static_cast<int>(51 * (i % 5)), 255, i > 4 ? 255 : 0}; };
  for (const bool is_taken_apart : {false, true})
    for (const FlatCase& one : cases) {
      Picture picture;
      shade_model(picture.context, GL_FLAT);
      if (is_taken_apart) {
        enable(picture.context, GL_CLIP_PLANE0, true);
        clip_plane(picture.context, GL_CLIP_PLANE0, {0, 0, 0, 1});  // cuts nothing
      }
      picture.changed();
      begin(picture.context, one.mode);
      for (std::size_t i = 0; i < one.places.size(); ++i) {
        set_color(picture.context, color_of(i));
        vertex(picture.context, one.places[i][0], one.places[i][1], 0, 1);
      }
      end(picture.context);
      for (std::size_t i = 0; i < one.at.size(); ++i)
        EXPECT_EQ(picture.rgb(one.at[i][0], one.at[i][1]), color_of(one.provoking[i])) << one.mode << " " << i;
    }
}

TEST(GlPrimitive, ClipPlanesCutInEyeSpace) {
  Picture picture;
  enable(picture.context, GL_CLIP_PLANE2, true);
  clip_plane(picture.context, GL_CLIP_PLANE2, {-1, 0, 0, 10});  // x <= 10
  picture.draw(GL_QUADS, {{0, 0}, {32, 0}, {32, 8}, {0, 8}});
  EXPECT_EQ(picture.drawn_pixels(), 80);
  picture.draw(GL_LINES, {{2.5, 20.5}, {30.5, 20.5}});
  EXPECT_EQ(picture.row(20, 0, 14), "..#######.....");  // the end lies in the last diamond
  picture.draw(GL_POINTS, {{9.5, 30.5}, {11.5, 30.5}});
  EXPECT_EQ(picture.row(30, 8, 5), ".#...");
}

TEST(GlPrimitive, ACutInterpolatesColors) {
  Picture whole, cut;
  enable(cut.context, GL_CLIP_PLANE0, true);
  clip_plane(cut.context, GL_CLIP_PLANE0, {1, 1, 0, -30});
  for (Picture* picture : {&whole, &cut}) {
    picture->changed();
    begin(picture->context, GL_TRIANGLES);
    set_color(picture->context, kRed);
    vertex(picture->context, 0, 0, 0, 1);
    set_color(picture->context, kGreen);
    vertex(picture->context, 60, 0, 0, 1);
    set_color(picture->context, kBlue);
    vertex(picture->context, 0, 60, 0, 1);
    end(picture->context);
  }
  int drawn = 0;
  for (int y = 0; y < Picture::kSide; ++y)
    for (int x = 0; x < Picture::kSide; ++x) {
      EXPECT_FALSE(x + y < 29 && cut.is_drawn(x, y));
      if (x + y < 30) continue;
      const auto a = whole.rgb(x, y), b = cut.rgb(x, y);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1);
      drawn += b != kBlack ? 1 : 0;
    }
  EXPECT_GT(drawn, 1000);
}

TEST(GlPrimitive, TheBackHasItsColorAndMode) {
  Picture picture;
  std::vector<ShadedVertex> triangle(3);
  constexpr std::array<std::array<double, 2>, 3> kPlaces{{{-1, -1}, {1, -1}, {-1, 1}}};
  for (std::size_t i = 0; i < 3; ++i) {
    triangle[i].clip = {kPlaces[i][0], kPlaces[i][1], 0, 1};
    triangle[i].color = {Vec4{1, 0, 0, 1}, Vec4{0, 1, 0, 1}};
  }
  const std::vector<std::uint32_t> front{0, 1, 2}, back{0, 2, 1};
  const auto draw = [&](const std::vector<std::uint32_t>& indices) {
    picture.black();
    draw_primitives(picture.context, GL_TRIANGLES, ShadedVertices(triangle), indices);
    return picture.rgb(10, 10);
  };
  EXPECT_EQ(draw(front), kRed);
  EXPECT_EQ(draw(back), kGreen);
  front_face(picture.context, GL_CW);
  EXPECT_EQ(draw(front), kGreen);
  polygon_mode(picture.context, GL_FRONT, GL_LINE);
  EXPECT_EQ(draw(back), kBlack);
  EXPECT_EQ(picture.rgb(32, 31), kRed);
  enable(picture.context, GL_CULL_FACE, true);
  EXPECT_EQ(draw(front), kBlack);
}

TEST(GlPrimitive, EdgeFlagsChooseEdgesAndCorners) {
  Picture picture;
  const auto draw = [&](GLenum mode) {
    picture.black();
    polygon_mode(picture.context, GL_FRONT_AND_BACK, mode);
    picture.changed();
    begin(picture.context, GL_QUADS);
    constexpr std::array<std::array<double, 2>, 4> kPlaces{{{8.5, 8.5}, {24.5, 8.5}, {24.5, 24.5}, {8.5, 24.5}}};
    for (std::size_t i = 0; i < 4; ++i) {
      edge_flag(picture.context, i == 1 ? GL_FALSE : GL_TRUE);
      vertex(picture.context, kPlaces[i][0], kPlaces[i][1], 0, 1);
    }
    end(picture.context);
  };
  draw(GL_LINE);
  EXPECT_TRUE(picture.is_drawn(16, 8));
  EXPECT_FALSE(picture.is_drawn(24, 16));
  EXPECT_TRUE(picture.is_drawn(16, 24));
  EXPECT_TRUE(picture.is_drawn(8, 16));
  EXPECT_FALSE(picture.is_drawn(16, 16));  // no diagonal
  EXPECT_EQ(picture.drawn_pixels(), 48);
  draw(GL_POINT);
  EXPECT_EQ(picture.drawn_pixels(), 3);
  EXPECT_FALSE(picture.is_drawn(24, 8));
}

TEST(GlPrimitive, LineStippleCountsAlongStrips) {
  Picture picture;
  enable(picture.context, GL_LINE_STIPPLE, true);
  line_stipple(picture.context, 1, 0x000f);
  picture.draw(GL_LINES, {{0.5, 1.5}, {24.5, 1.5}, {24.5, 3.5}, {0.5, 3.5}});
  EXPECT_EQ(picture.row(1, 0, 26), "####............####......");
  EXPECT_EQ(picture.row(3, 0, 26), ".....####............####.");
  picture.draw(GL_LINE_STRIP, {{0.5, 5.5}, {6.5, 5.5}, {6.5, 35.5}});
  EXPECT_EQ(picture.row(5, 0, 8), "####....");
  int column = 0;
  for (int y = 5; y < 36; ++y) column |= picture.is_drawn(6, y) ? 1 << (y - 5) : 0;
  EXPECT_EQ(column, 0xf << 10 | 0xf << 26);
  line_stipple(picture.context, 3, 0x5555);
  picture.draw(GL_LINES, {{0.5, 50.5}, {16.5, 50.5}});
  EXPECT_EQ(picture.row(50, 0, 18), "###...###...###...");
}

TEST(GlPrimitive, AStippleOfOnesIsTheLine) {
  Picture plain, stippled;
  enable(stippled.context, GL_LINE_STIPPLE, true);
  line_stipple(stippled.context, 1, 0xffff);
  for (int i = 0; i < 24; ++i) {
    const double angle = 0.13 + i * 0.2618;
    const std::array<double, 2> from{32.3, 31.7}, to{32.3 + 40 * std::cos(angle), 31.7 + 40 * std::sin(angle)};
    plain.draw(GL_LINES, {from, to});
    stippled.draw(GL_LINES, {from, to});
  }
  int differ = 0;
  for (int y = 0; y < Picture::kSide; ++y)
    for (int x = 0; x < Picture::kSide; ++x) differ += plain.is_drawn(x, y) != stippled.is_drawn(x, y) ? 1 : 0;
  EXPECT_EQ(differ, 0);
  // Dots are a subset of it.
  Picture dotted;
  enable(dotted.context, GL_LINE_STIPPLE, true);
  line_stipple(dotted.context, 1, 0x5555);
  dotted.draw(GL_LINES, {{3.2, 5.1}, {60.7, 40.9}});
  EXPECT_EQ(dotted.drawn_pixels(), 29);
}

TEST(GlPrimitive, PolygonStippleLiesOnTheWindow) {
  Picture picture;
  std::array<std::uint32_t, 32> rows{};
  for (std::size_t y = 0; y < 32; ++y) rows[y] = y % 2 == 0 ? 0xaaaaaaaaU : 0x0000ffffU;
  polygon_stipple(picture.context, rows);
  enable(picture.context, GL_POLYGON_STIPPLE, true);
  set_color(picture.context, kGreen, 0);
  picture.draw(GL_POLYGON, {{-20, -20}, {90, -20}, {90, 90}, {-20, 90}});
  for (int y = 0; y < Picture::kSide; ++y)
    for (int x = 0; x < Picture::kSide; ++x) {
      const bool is_set = y % 2 == 0 ? x % 2 == 0 : x % 32 >= 16;
      ASSERT_EQ(picture.rgb(x, y), is_set ? kGreen : kBlack) << x << " " << y;
    }
}

TEST(GlPrimitive, PolygonOffsetMovesEveryMode) {
  for (const GLenum mode : std::array<GLenum, 3>{GL_FILL, GL_LINE, GL_POINT}) {
    Picture picture;
    const double from = mode == GL_FILL ? 8 : 8.5, to = from + 32;
    enable(picture.context, GL_DEPTH_TEST, true);
    polygon_mode(picture.context, GL_FRONT_AND_BACK, mode);
    for (const GLenum cap :
         std::array<GLenum, 3>{GL_POLYGON_OFFSET_FILL, GL_POLYGON_OFFSET_LINE, GL_POLYGON_OFFSET_POINT})
      enable(picture.context, cap, true);
    picture.draw(GL_TRIANGLES, {{from, from}, {to, from}, {from, to}});
    const std::uint32_t before = picture.depth(8, 8);
    polygon_offset(picture.context, 0, -1000);
    picture.draw(GL_TRIANGLES, {{from, from}, {to, from}, {from, to}});
    EXPECT_NEAR(static_cast<double>(picture.depth(8, 8)), before - 1000.0, 1) << mode;
    // A slope of one whole range over 64 pixels, twice that.
    picture.black();
    polygon_offset(picture.context, -2, 0);
    picture.changed();
    begin(picture.context, GL_TRIANGLES);
    for (const auto& [x, y] : {std::array{from, from}, {to, from}, {from, to}})
      vertex(picture.context, x, y, -x / 32 + 1, 1);
    end(picture.context);
    const double range = std::ldexp(1.0, 24) - 1;
    EXPECT_NEAR(static_cast<double>(picture.depth(8, 8)) / range, (8.5 - 2) / 64, 1e-5) << mode;
  }
}

TEST(GlPrimitive, PointsHaveTheirOwnSizes) {
  Picture picture;
  std::vector<ShadedVertex> points(2);
  for (std::size_t i = 0; i < 2; ++i) {
    points[i].clip = {i == 0 ? -0.5 : 0.5, 0, 0, 1};
    points[i].color.fill({1, 1, 1, 1});
    points[i].point_size = i == 0 ? 4 : 6.2;
  }
  const std::vector<std::uint32_t> indices{0, 1};
  draw_primitives(picture.context, GL_POINTS, ShadedVertices(points), indices);
  EXPECT_EQ(picture.drawn_pixels(), 16 + 36);
}

TEST(GlPrimitive, FogByTheEyeDistanceWhereWIsOne) {
  Picture picture;
  enable(picture.context, GL_FOG, true);
  fog(picture.context, GL_FOG_MODE, {.value = {GL_LINEAR}});
  fog(picture.context, GL_FOG_START, {.value = {0}});
  fog(picture.context, GL_FOG_END, {.value = {1}});
  fog(picture.context, GL_FOG_COLOR, {.value = {0, 0, 1, 1}, .is_vector = true});
  set_color(picture.context, kRed);
  picture.changed();
  begin(picture.context, GL_QUADS);
  for (const auto& [x, y] : {std::array{0, 0}, {64, 0}, {64, 64}, {0, 64}}) vertex(picture.context, x, y, -0.25, 1);
  end(picture.context);
  const Rgb rgb = picture.rgb(32, 32);
  EXPECT_NEAR(rgb[0], 191, 1);
  EXPECT_NEAR(rgb[2], 64, 1);
}

TEST(GlFragment, LogicOperationsOfZerosAndOnes) {
  for (GLenum op = GL_CLEAR; op <= GL_SET; ++op)
    for (const bool source : {false, true})
      for (const bool stored : {false, true}) {
        Picture picture;
        clear_color(picture.context, stored, stored, stored, stored);
        clear(picture.context, GL_COLOR_BUFFER_BIT);
        enable(picture.context, GL_COLOR_LOGIC_OP, true);
        enable(picture.context, GL_BLEND, true);  // does not count beside it
        logic_op(picture.context, op);
        color(picture.context, source, source, source, source);
        picture.draw(GL_QUADS, {{0, 0}, {64, 0}, {64, 64}, {0, 64}});
        const unsigned bit = source ? (stored ? 0 : 1) : (stored ? 2 : 3);
        EXPECT_EQ(picture.rgb(5, 5), ((op - GL_CLEAR) >> bit & 1) != 0 ? kWhite : kBlack) << op << source << stored;
      }
}

TEST(GlFragment, XorOfEachChannel) {
  Picture picture;
  clear_color(picture.context, 0.2, 1, 0, 0);
  clear(picture.context, GL_COLOR_BUFFER_BIT);
  enable(picture.context, GL_COLOR_LOGIC_OP, true);
  logic_op(picture.context, GL_XOR);
  set_color(picture.context, {255, 255, 0});
  picture.draw(GL_QUADS, {{0, 0}, {64, 0}, {64, 64}, {0, 64}});
  EXPECT_EQ(picture.rgb(5, 5), (Rgb{204, 0, 0}));
  picture.draw(GL_QUADS, {{0, 0}, {64, 0}, {64, 64}, {0, 64}});
  EXPECT_EQ(picture.rgb(5, 5), (Rgb{51, 255, 0}));
  logic_op(picture.context, GL_NAND);  // 1 where it is zero; the stored bit inverted where it is one
  picture.draw(GL_QUADS, {{0, 0}, {64, 0}, {64, 64}, {0, 64}});
  EXPECT_EQ(picture.rgb(5, 5), (Rgb{204, 0, 255}));
}

TEST(GlFragment, EveryLogicOperationOfPixels) {
  const std::array<std::uint32_t (*)(std::uint32_t, std::uint32_t), 16> operations{
      [](auto, auto) { return 0U; },           [](auto s, auto d) { return s & d; },
      [](auto s, auto d) { return s & ~d; },   [](auto s, auto) { return s; },
      [](auto s, auto d) { return ~s & d; },   [](auto, auto d) { return d; },
      [](auto s, auto d) { return s ^ d; },    [](auto s, auto d) { return s | d; },
      [](auto s, auto d) { return ~(s | d); }, [](auto s, auto d) { return ~(s ^ d); },
      [](auto, auto d) { return ~d; },         [](auto s, auto d) { return s | ~d; },
      [](auto s, auto) { return ~s; },         [](auto s, auto d) { return ~s | d; },
      [](auto s, auto d) { return ~(s & d); }, [](auto, auto) { return ~0U; }};
  const TexelImage image{2, 1, {{0x35, 0xf0, 0x0f, 0xaa}, {0x11, 0x22, 0x44, 0x88}}};
  const halfplane::Texture texels = make_texture("texels", image, TextureFormat::rgba8888, Mips::none);
  constexpr std::array<std::uint32_t, 4> kStored{0x53, 0x3c, 0xc3, 0x5a};
  for (std::size_t op = 0; op < 16; ++op) {
    Picture picture;
    clear_color(picture.context, kStored[0] / 255.0, kStored[1] / 255.0, kStored[2] / 255.0, kStored[3] / 255.0);
    clear(picture.context, GL_COLOR_BUFFER_BIT);
    enable(picture.context, GL_COLOR_LOGIC_OP, true);
    logic_op(picture.context, static_cast<GLenum>(GL_CLEAR + op));
    draw_rectangle(picture.context, texels, 20, 10, -3, 2, 0, 1);
    for (const int x : {15, 18})
      for (std::size_t c = 0; c < 4; ++c) {
        const std::uint32_t source = image.texel[x == 18 ? 0 : 1][c];
        EXPECT_EQ(picture.pixel(x, 11)[c], static_cast<int>(operations[op](source, kStored[c]) & 255))
            << op << " " << x;
      }
    EXPECT_EQ(picture.pixel(13, 11)[0], static_cast<int>(kStored[0]));
  }
}

TEST(GlFragment, LogicOperationsOfAnyColors) {
  Picture picture;
  clear_color(picture.context, 0x53 / 255.0, 0x3c / 255.0, 0xc3 / 255.0, 0);
  clear(picture.context, GL_COLOR_BUFFER_BIT);
  enable(picture.context, GL_COLOR_LOGIC_OP, true);
  logic_op(picture.context, GL_XOR);
  color_mask(picture.context, GL_TRUE, GL_TRUE, GL_FALSE, GL_TRUE);
  set_color(picture.context, {0x35, 0xf0, 0x0f});
  picture.draw(GL_QUADS, {{8, 8}, {16, 8}, {16, 16}, {8, 16}});
  EXPECT_EQ(picture.rgb(8, 8), (Rgb{0x66, 0xcc, 0xc3}));
  EXPECT_EQ(picture.rgb(16, 15), (Rgb{0x53, 0x3c, 0xc3}));
  picture.draw(GL_QUADS, {{8, 8}, {16, 8}, {16, 16}, {8, 16}});
  EXPECT_EQ(picture.rgb(8, 8), (Rgb{0x53, 0x3c, 0xc3}));
  EXPECT_EQ(picture.pixel(20, 20)[3], 0);
}

/// Hardware with the unit draws the operation itself, in either format; hardware without it is named.
TEST(GlFragment, LogicOperationsAreTheHardwaresWhereItHasTheUnit) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  const auto draw = [](Picture& picture) {
    enable(picture.context, GL_COLOR_LOGIC_OP, true);
    logic_op(picture.context, GL_XOR);
    set_color(picture.context, {0x35, 0xf0, 0x0f});
    picture.draw(GL_QUADS, {{8, 8}, {16, 8}, {16, 16}, {8, 16}});
  };
  for (const auto format : {ColorFormat::rgb565, ColorFormat::rgba8888}) {
    const std::string without = std::string("embedded stencil.bits=8 blend.lanes=4 color.format=") +
                                (format == ColorFormat::rgb565 ? "rgb565" : "rgba8888");
    Picture picture(without + " logic.unit=1", OnMissing::stop);
    clear_color(picture.context, 0x53 / 255.0, 0x3c / 255.0, 0xc3 / 255.0, 0);
    clear(picture.context, GL_COLOR_BUFFER_BIT);
    const Framebuffer before = picture.drawable.frame.picture();
    draw(picture);
    const Framebuffer once = picture.drawable.frame.picture();
    const auto own = pack_color(format, std::array<std::uint8_t, 4>{0x35, 0xf0, 0x0f, 0xff});
    const std::size_t inside = once.at(8, Picture::kSide - 1 - 8);
    EXPECT_EQ(once.color[inside], before.color[inside] ^ own);
    draw(picture);
    EXPECT_EQ(picture.drawable.frame.picture().color, before.color);
    const auto draw_without = [&] {
      Picture other(without, OnMissing::stop);
      draw(other);
      (void)other.drawable.frame.picture();
    };
    EXPECT_EXIT(draw_without(), testing::ExitedWithCode(2), "logic operations");
  }
}

TEST(GlPrimitive, FogBendsAlongALine) {
  Picture picture;
  Context& context = picture.context;
  matrix_mode(context, GL_PROJECTION);
  load_identity(context);
  frustum(context, -1, 1, -1, 1, 1, 1000);
  matrix_mode(context, GL_MODELVIEW);
  enable(context, GL_FOG, true);
  fog(context, GL_FOG_MODE, {.value = {GL_EXP}});
  fog(context, GL_FOG_DENSITY, {.value = {0.1}});
  picture.changed();
  begin(context, GL_LINES);  // on the floor, from behind the eye far away
  vertex(context, 0.01, -1, 5, 1);
  vertex(context, 0.01, -1, -500, 1);
  end(context);
  for (int y = 2; y < 30; ++y) {
    const double distance = 32 / (32 - y - 0.5);
    EXPECT_NEAR(picture.rgb(32, y)[0], 255 * std::exp(-0.1 * distance), 3) << y;
  }
}

TEST(GlFragment, ClearsObeyMasksAndScissor) {
  Picture picture;
  Context& context = picture.context;
  clear_color(context, 1, 1, 1, 1);
  clear_depth(context, 0.5);
  clear_stencil(context, 0x55);
  enable(context, GL_SCISSOR_TEST, true);
  scissor(context, 0, 0, 32, 64);
  color_mask(context, GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE);
  stencil_mask(context, 0x0f);
  depth_mask(context, GL_FALSE);
  const std::uint32_t before = picture.depth(5, 5);
  clear(context, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  EXPECT_EQ(picture.rgb(31, 5), kGreen);
  EXPECT_EQ(picture.rgb(32, 5), kBlack);
  EXPECT_EQ(picture.stencil(5, 5), 5);
  EXPECT_EQ(picture.stencil(40, 5), 0);
  EXPECT_EQ(picture.depth(5, 5), before);
  depth_mask(context, GL_TRUE);
  stencil_mask(context, ~0U);
  clear(context, GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  EXPECT_NE(picture.depth(5, 5), before);
  EXPECT_EQ(picture.depth(40, 5), before);
  EXPECT_EQ(picture.stencil(5, 5), 0x55);
  clear(context, 1);
  EXPECT_EQ(picture.error(), GLenum{GL_INVALID_VALUE});
}

TEST(GlFragment, NothingIsDrawnToNoBuffer) {
  Picture picture;
  draw_buffer(picture.context, GL_NONE);
  clear_color(picture.context, 1, 1, 1, 1);
  clear(picture.context, GL_COLOR_BUFFER_BIT);
  picture.draw(GL_QUADS, {{0, 0}, {64, 0}, {64, 64}, {0, 64}});
  EXPECT_EQ(picture.drawn_pixels(), 0);
}

TEST(GlFragment, BuffersThatDoNotExistAreErrors) {
  Picture picture;
  Context& context = picture.context;
  const auto draws = [&](GLenum mode) { return draw_buffer(context, mode), picture.error(); };
  const auto reads = [&](GLenum mode) { return read_buffer(context, mode), picture.error(); };
  for (const GLenum mode : std::array<GLenum, 5>{GL_FRONT, GL_BACK, GL_LEFT, GL_FRONT_LEFT, GL_BACK_LEFT}) {
    EXPECT_EQ(draws(mode), GLenum{GL_NO_ERROR});
    EXPECT_EQ(reads(mode), GLenum{GL_NO_ERROR});
  }
  EXPECT_EQ(draws(GL_FRONT_AND_BACK), GLenum{GL_NO_ERROR});
  EXPECT_EQ(reads(GL_FRONT_AND_BACK), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(draws(GL_NONE), GLenum{GL_NO_ERROR});
  EXPECT_EQ(reads(GL_NONE), GLenum{GL_INVALID_ENUM});
  EXPECT_EQ(draws(GL_BACK_RIGHT), GLenum{GL_INVALID_OPERATION});
  EXPECT_EQ(draws(GL_AUX0), GLenum{GL_INVALID_OPERATION});
  EXPECT_EQ(draws(GL_RGBA), GLenum{GL_INVALID_ENUM});
  picture.drawable.single_buffered = true;
  EXPECT_EQ(draws(GL_BACK), GLenum{GL_INVALID_OPERATION});
  EXPECT_EQ(context.state.color.draw_buffer, GLenum{GL_NONE});  // unchanged
}

TEST(GlFragment, SettersRefuseWhatIsNone) {
  Picture picture;
  Context& context = picture.context;
  const auto is_refused = [&](GLenum code, auto&& command) {
    command();
    EXPECT_EQ(picture.error(), code);
  };
  is_refused(GL_INVALID_ENUM, [&] { alpha_func(context, GL_ONE, 0); });
  is_refused(GL_INVALID_ENUM, [&] { depth_func(context, 0); });
  is_refused(GL_INVALID_ENUM, [&] { blend_func_separate(context, GL_ONE, GL_SRC_ALPHA_SATURATE, GL_ONE, GL_ONE); });
  is_refused(GL_INVALID_ENUM, [&] { blend_func_separate(context, GL_ONE, GL_ONE, 2, GL_ONE); });
  is_refused(GL_INVALID_ENUM, [&] { blend_equation(context, GL_LOGIC_OP); });
  is_refused(GL_INVALID_ENUM, [&] { stencil_func(context, GL_KEEP, 0, 0); });
  is_refused(GL_INVALID_ENUM, [&] { stencil_op(context, GL_KEEP, GL_ONE, GL_KEEP); });
  is_refused(GL_INVALID_ENUM, [&] { logic_op(context, GL_SET + 1); });
  is_refused(GL_INVALID_ENUM, [&] { hint(context, GL_FOG, GL_NICEST); });
  is_refused(GL_INVALID_ENUM, [&] { hint(context, GL_FOG_HINT, GL_FOG); });
  is_refused(GL_INVALID_ENUM, [&] { enable(context, GL_RGBA, true); });
  is_refused(GL_INVALID_ENUM, [&] { accum(context, GL_REPLACE, 1); });
  is_refused(GL_INVALID_VALUE, [&] { scissor(context, 0, 0, -1, 1); });
  is_refused(GL_NO_ERROR, [&] { blend_func_separate(context, GL_SRC_COLOR, GL_DST_COLOR, GL_ONE, GL_ZERO); });
}

TEST(GlFragment, Accumulation) {
  Picture picture;
  Context& context = picture.context;
  clear_color(context, 0.4, 0.8, 0, 1);
  clear(context, GL_COLOR_BUFFER_BIT);
  clear(context, GL_ACCUM_BUFFER_BIT);
  accum(context, GL_LOAD, 0.5);
  accum(context, GL_ACCUM, 0.25);
  accum(context, GL_ADD, 0.1);
  accum(context, GL_MULT, 0.5);
  enable(context, GL_SCISSOR_TEST, true);
  scissor(context, 8, 8, 16, 16);
  color_mask(context, GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
  accum(context, GL_RETURN, 2);
  EXPECT_EQ(picture.rgb(3, 3), (Rgb{102, 204, 0}));
  const Rgb rgb = picture.rgb(10, 10);
  EXPECT_NEAR(rgb[0], 255 * (0.75 * 0.4 + 0.1), 1);
  EXPECT_NEAR(rgb[1], 255 * (0.75 * 0.8 + 0.1), 1);
  EXPECT_NEAR(rgb[2], 255 * 0.1, 1);
}

TEST(GlFragment, WindowFragmentsAndRectangles) {
  Picture picture;
  Context& context = picture.context;
  const std::vector<WindowFragment> fragments{{3, 4, 0, 1, {1, 0, 0, 1}}, {63, 63, 0, 1, {0, 1, 0, 1}}, {-1, 70}};
  draw_fragments(context, fragments);
  EXPECT_EQ(picture.rgb(3, 4), kRed);
  EXPECT_EQ(picture.rgb(63, 63), kGreen);
  EXPECT_EQ(picture.drawn_pixels(), 2);

  const TexelImage image{
      3,
      2,
      {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 0, 255}, {9, 9, 9, 255}, {255, 255, 255, 255}}};
  const halfplane::Texture texels = make_texture("texels", image, TextureFormat::rgba8888, Mips::none);
  picture.black();
  draw_rectangle(context, texels, 10, 20, 1, 1, 0, 1);
  EXPECT_EQ(picture.drawn_pixels(), 6);
  EXPECT_EQ(picture.rgb(10, 20), kRed);
  EXPECT_EQ(picture.rgb(12, 20), kBlue);
  EXPECT_EQ(picture.rgb(11, 21), (Rgb{9, 9, 9}));
  picture.black();
  draw_rectangle(context, texels, 10, 20, -2, -3, 0, 1);
  EXPECT_EQ(picture.drawn_pixels(), 36);
  EXPECT_EQ(picture.rgb(9, 19), kRed);
  EXPECT_EQ(picture.rgb(8, 17), kRed);
  EXPECT_EQ(picture.rgb(7, 19), kGreen);
  EXPECT_EQ(picture.rgb(4, 14), kWhite);
  picture.black();
  draw_rectangle(context, texels, -1, -1, 1, 1, 0, 1);  // partly outside
  EXPECT_EQ(picture.drawn_pixels(), 2);
  EXPECT_EQ(picture.rgb(1, 0), kWhite);
  picture.black();
  draw_rectangle(context, texels, -1e5, 0, 1e5, 64, 0, 1);  // far outside
  EXPECT_EQ(picture.rgb(5, 5), kGreen);
}

/// Two texels, red on the left and half of green on the right.
void bind_two_texels(Picture& picture, GLenum env_mode) {
  auto image = std::make_shared<Image>();
  image->width = 2, image->height = 1;
  image->pixel = {{1, 0, 0, 1}, {0, 0.5, 0, 1}};
  Context& context = picture.context;
  tex_image(context, 2, GL_TEXTURE_2D, 0, GL_RGBA8, 2, 1, 1, 0, image);
  for (const GLenum filter : std::array<GLenum, 2>{GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    tex_parameter(context, GL_TEXTURE_2D, filter, {.value = {GL_NEAREST}, .is_integer = true});
  tex_env(context, GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, {.value = {static_cast<double>(env_mode)}, .is_integer = true});
  enable(context, GL_TEXTURE_2D, true);
  picture.changed();
}

constexpr Rgb kHalfGreen{0, 128, 0};

/// Quads with s from 0 to 1 across, of the given q on the right.
void draw_textured(Picture& picture, GLenum mode, std::initializer_list<std::array<double, 2>> places, double right,
                   double q = 1) {
  picture.changed();
  begin(picture.context, mode);
  for (const auto& [x, y] : places) {
    const bool is_right = x >= right;
    tex_coord(picture.context, GL_TEXTURE0, is_right ? q : 0, 0, 0, is_right ? q : 1);
    vertex(picture.context, x, y, 0, 1);
  }
  end(picture.context);
}

TEST(GlPrimitive, TexturesLieOnLinesAndPoints) {
  Picture picture;
  bind_two_texels(picture, GL_REPLACE);
  draw_textured(picture, GL_LINES, {{2, 10.5}, {22, 10.5}}, 22);
  EXPECT_EQ(picture.row(10, 0, 24), "..####################..");
  EXPECT_EQ(picture.drawn_pixels(), 20);
  EXPECT_EQ(picture.rgb(11, 10), kRed);
  EXPECT_EQ(picture.rgb(12, 10), kHalfGreen);
  point_size(picture.context, 4);
  draw_textured(picture, GL_POINTS, {{10, 30}, {30, 30}}, 30, 0.75);
  EXPECT_EQ(picture.drawn_pixels(), 20 + 32);
  EXPECT_EQ(picture.rgb(9, 29), kRed);
  EXPECT_EQ(picture.rgb(29, 29), kRed);  // s / q is 1, which repeats
  line_width(picture.context, 3);
  picture.black();
  draw_textured(picture, GL_LINES, {{30.5, 2}, {34.5, 42}}, 34);
  EXPECT_EQ(picture.drawn_pixels(), 3 * 40);
}

TEST(GlPrimitive, ASecondColorIsAddedAfterTheTexture) {
  Picture picture;
  bind_two_texels(picture, GL_MODULATE);
  enable(picture.context, GL_COLOR_SUM, true);
  enable(picture.context, GL_DEPTH_TEST, true);
  secondary_color(picture.context, 0, 0.25, 1);
  draw_textured(picture, GL_QUADS, {{0, 0}, {64, 0}, {64, 64}, {0, 64}}, 64);
  EXPECT_EQ(picture.rgb(5, 5), (Rgb{255, 64, 255}));
  const Rgb right = picture.rgb(60, 5);
  EXPECT_NEAR(right[1], 192, 1);
  EXPECT_EQ(picture.pixel(5, 5)[3], 255);
  enable(picture.context, GL_TEXTURE_2D, false);
  picture.black();
  color(picture.context, 0.5, 0.5, 0.5, 1);
  draw_textured(picture, GL_QUADS, {{0, 0}, {64, 0}, {64, 64}, {0, 64}}, 64);
  EXPECT_EQ(picture.rgb(5, 5), (Rgb{128, 191, 255}));
}

TEST(GlPrimitive, FogOfTexturesByCoordinates) {
  Picture picture;
  bind_two_texels(picture, GL_REPLACE);
  enable(picture.context, GL_FOG, true);
  fog(picture.context, GL_FOG_MODE, {.value = {GL_LINEAR}});
  fog(picture.context, GL_FOG_COORD_SRC, {.value = {GL_FOG_COORD}});
  fog(picture.context, GL_FOG_COLOR, {.value = {0, 0, 1, 1}, .is_vector = true});
  fog_coord(picture.context, 0.75);
  draw_textured(picture, GL_QUADS, {{0, 0}, {64, 0}, {64, 64}, {0, 64}}, 64);
  const Rgb left = picture.rgb(5, 5);
  EXPECT_NEAR(left[0], 64, 1);
  EXPECT_NEAR(left[2], 191, 1);
}

TEST(GlPrimitive, TextureCoordinatesAreDividedByQ) {
  Picture picture;
  bind_two_texels(picture, GL_REPLACE);
  // s = 3x, q = 1 + 2x: s / q is one half at x = 1/4.
  draw_textured(picture, GL_QUADS, {{0, 0}, {64, 0}, {64, 64}, {0, 64}}, 64, 3);
  for (const int y : {3, 31, 60}) {
    EXPECT_EQ(picture.rgb(15, y), kRed);
    EXPECT_EQ(picture.rgb(16, y), kHalfGreen);
    EXPECT_EQ(picture.rgb(63, y), kHalfGreen);
  }
}

TEST(GlPrimitive, AnyNumbersAreTaken) {
  constexpr double kHuge = 1e308, kNan = std::numeric_limits<double>::quiet_NaN(),
                   kInfinite = std::numeric_limits<double>::infinity();
  constexpr std::array<GLenum, 6> kCaps{GL_LINE_STIPPLE, GL_POLYGON_STIPPLE, GL_CLIP_PLANE0,
                                        GL_FOG,          GL_CULL_FACE,       GL_POLYGON_OFFSET_LINE};
  for (unsigned caps = 0; caps < 64; ++caps)
    for (const GLenum polygon : std::array<GLenum, 3>{GL_FILL, GL_LINE, GL_POINT}) {
      Picture picture("tiny guard.band=256 target.width=64 target.height=64");
      for (std::size_t i = 0; i < kCaps.size(); ++i) enable(picture.context, kCaps[i], (caps >> i & 1) != 0);
      polygon_mode(picture.context, GL_FRONT_AND_BACK, polygon);
      polygon_offset(picture.context, kHuge, kHuge);
      picture.changed();
      for (GLenum mode = GL_POINTS; mode <= GL_POLYGON; ++mode) {
        begin(picture.context, mode);
        for (const double value : {0.0, kHuge, kNan, -kInfinite, 7.0, -kHuge, 1e-308}) {
          vertex(picture.context, value, 3, -value, 1);
          vertex(picture.context, 3, value, 0, value);
        }
        end(picture.context);
      }
      (void)picture.drawn_pixels();
    }
}

}  // namespace
}  // namespace halfplane::gl::primitive_test
