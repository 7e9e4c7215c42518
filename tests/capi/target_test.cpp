// Targets of the C interface: call by call the bits of the capture that holds the same commands, for every vertex
// layout and number of threads; and a refused call changes nothing.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "halfplane.h"

namespace {

constexpr int kWidth = 70, kHeight = 40;  // larger than a bin of the engine, and no whole number of tiles
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

/// An emulator's vertex: 16 bits a coordinate, 8 a channel.
struct SmallVertex {
  std::int16_t x, y;
  std::array<std::uint8_t, 4> rgba;
};
/// A vertex of floats, with the colour in the middle.
struct FloatVertex {
  std::array<float, 4> xyzw;
  std::array<std::uint8_t, 3> rgb;
  std::uint8_t unused;
  std::array<float, 2> uv;
  std::array<double, 3> normal;
};

constexpr halfplane_attribute kNone{HALFPLANE_NONE, 0, 0};
constexpr halfplane_layout kSmall{
    sizeof(SmallVertex), {HALFPLANE_I16, 2, 0}, {HALFPLANE_U8, 4, offsetof(SmallVertex, rgba)}, kNone, kNone};
constexpr halfplane_layout kFloat{sizeof(FloatVertex),
                                  {HALFPLANE_F32, 4, 0},
                                  {HALFPLANE_U8, 3, offsetof(FloatVertex, rgb)},
                                  {HALFPLANE_F32, 2, offsetof(FloatVertex, uv)},
                                  {HALFPLANE_F64, 3, offsetof(FloatVertex, normal)}};

constexpr std::array<SmallVertex, 4> kSquare{
    {{2, 3, {255, 0, 0, 255}}, {68, 5, {0, 255, 0, 200}}, {4, 38, {0, 0, 255, 100}}, {66, 35, {9, 99, 199, 50}}}};
constexpr std::array<FloatVertex, 3> kTriangle{{{{-0.75F, -0.5F, 0.25F, 1.0F}, {200, 100, 50}, 0, {0, 0}, {0, 0, 1}},
                                                {{1.5F, -0.75F, 0.5F, 2.0F}, {255, 255, 0}, 0, {3, 0}, {1, 0, 2}},
                                                {{0.0F, 0.875F, -0.25F, 1.0F}, {0, 255, 255}, 0, {0, 2}, {0, -1, 1}}}};

/// The commands that the tests make by calls.
constexpr const char* kCapture = R"(halfplane 1
target 70 40
texture T inline rgba8888 2 2 mips box
texels ff0000ff 00ff00c0 0000ff80 ffffff40
clear color 20 30 40 255 depth 1 stencil 3
space window
state depth_test always
v 2 3 0 1 255 0 0 255
v 68 5 0 1 0 255 0 200
v 4 38 0 1 0 0 255 100
v 66 35 0 1 9 99 199 50
ts 0 1 2 3
state scissor 10 10 20 20
clear depth 0.9 stencil 7
space clip
state scissor off
state depth_test less
state texture T
state texture_mag linear
state blend src_alpha one_minus_src_alpha
state stencil equal 7 255 255 keep keep incr
state shade phong
v -0.75 -0.5 0.25 1 200 100 50 255 0 0
a normal 0 0 1
v 1.5 -0.75 0.5 2 255 255 0 255 3 0
a normal 1 0 2
v 0 0.875 -0.25 1 0 255 255 255 0 2
a normal 0 -1 1
t 4 5 6
space window
state depth_test always
state stencil off
state texture off
state shade smooth
state blend off
p 1 3
l 0 3
)";

class CapiTarget : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    config_ = halfplane_config_new("embedded");
    ASSERT_EQ(halfplane_config_set(config_, "color.format", GetParam()), 0);
    target_ = halfplane_target_new(config_, kWidth, kHeight, nullptr);
    ASSERT_NE(target_, nullptr) << halfplane_last_error();
  }
  void TearDown() override {
    halfplane_target_free(target_);
    halfplane_config_free(config_);
  }
  int say(const std::string& lines) { return halfplane_target_say(target_, lines.data(), lines.size()); }
  int draw(const char* topology, const std::vector<std::uint32_t>& indices) {
    return halfplane_target_draw(target_, topology, &kSmall, kSquare.data(), sizeof kSquare, kSquare.size(),
                                 indices.data(), indices.size());
  }
  void draw_all() {
    const std::array<std::uint8_t, 16> texels{255, 0, 0, 255, 0, 255, 0, 192, 0, 0, 255, 128, 255, 255, 255, 64};
    ASSERT_EQ(halfplane_target_texture(target_, "T", 2, 2, texels.data(), "rgba8888", "box"), 0)
        << halfplane_last_error();
    const std::array<double, 4> color{20, 30, 40, 255};
    const double far = 1, nearer = 0.9;
    ASSERT_EQ(halfplane_target_clear(target_, color.data(), &far, 3), 0) << halfplane_last_error();
    ASSERT_EQ(say("space window\nstate depth_test always\n"), 0) << halfplane_last_error();
    ASSERT_EQ(halfplane_target_draw(target_, "triangle_strip", &kSmall, kSquare.data(), sizeof kSquare, kSquare.size(),
                                    nullptr, 0),
              0)
        << halfplane_last_error();
    ASSERT_EQ(say("state scissor 10 10 20 20\n"), 0);
    ASSERT_EQ(halfplane_target_clear(target_, nullptr, &nearer, 7), 0);
    ASSERT_EQ(say("state texture T\nstate texture_mag linear\nstate blend src_alpha one_minus_src_alpha\n"
                  "state stencil equal 7 255 255 keep keep incr\nstate shade phong\n"),
              0)
        << halfplane_last_error();
    const std::array<std::uint32_t, 3> indices{0, 1, 2};
    ASSERT_EQ(halfplane_target_draw(target_, "triangles", &kFloat, kTriangle.data(), sizeof kTriangle, kTriangle.size(),
                                    indices.data(), indices.size()),
              0)
        << halfplane_last_error();
    EXPECT_GT(halfplane_target_counter(target_, "written"), 50);
    ASSERT_EQ(say("space window\nstate depth_test always\n"), 0);
    ASSERT_EQ(draw("points", {1, 3}), 0) << halfplane_last_error();
    ASSERT_EQ(draw("lines", {0, 3}), 0) << halfplane_last_error();
  }
  using Planes = std::array<std::vector<std::uint32_t>, 3>;
  [[nodiscard]] Planes planes() const {
    Planes all;
    constexpr std::array<const char*, 3> kNames{"color", "depth", "stencil"};
    for (std::size_t i = 0; i < 3; ++i) {
      all[i].resize(kPixels);
      EXPECT_EQ(halfplane_target_plane(target_, kNames[i], all[i].data(), kPixels), static_cast<std::int64_t>(kPixels));
    }
    return all;
  }
  [[nodiscard]] Planes capture_planes(const char* engine) const {
    halfplane_scene* scene = halfplane_scene_read(kCapture, std::strlen(kCapture));
    EXPECT_NE(scene, nullptr) << halfplane_last_error();
    halfplane_frame* frame = halfplane_render(scene, config_, engine);
    EXPECT_NE(frame, nullptr) << halfplane_last_error();
    Planes all;
    constexpr std::array<const char*, 3> kNames{"color", "depth", "stencil"};
    for (std::size_t i = 0; i < 3; ++i) {
      all[i].resize(kPixels);
      EXPECT_EQ(halfplane_frame_plane(frame, kNames[i], all[i].data(), kPixels), static_cast<std::int64_t>(kPixels));
    }
    halfplane_frame_free(frame);
    halfplane_scene_free(scene);
    return all;
  }

  halfplane_config* config_ = nullptr;
  halfplane_target* target_ = nullptr;
};

TEST_P(CapiTarget, CallByCallItIsTheCaptureOfTheSameCommands) {
  draw_all();
  const Planes drawn = planes();
  EXPECT_EQ(drawn, capture_planes("functional"));
  EXPECT_EQ(drawn, capture_planes("scalar"));
  ASSERT_EQ(halfplane_target_set_threads(target_, 3), 0);
  draw_all();
  EXPECT_EQ(planes(), drawn) << "three threads";
}

TEST_P(CapiTarget, AWholeSceneIsDrawnOnWhatIsThere) {
  halfplane_scene* scene = halfplane_scene_read(kCapture, std::strlen(kCapture));
  ASSERT_EQ(halfplane_target_draw_scene(target_, scene), 0) << halfplane_last_error();
  EXPECT_EQ(planes(), capture_planes("functional"));
  halfplane_scene_free(scene);
}

TEST_P(CapiTarget, ItsFrameGoesToTheCallersMemoryAndComesBack) {
  draw_all();
  const Planes drawn = planes();
  const std::size_t bytes = std::strcmp(GetParam(), "rgb565") == 0 ? 2 : 4, pitch = bytes * 80;
  std::vector<std::uint8_t> color(pitch * kHeight);
  std::vector<std::uint32_t> depth(kPixels);
  ASSERT_EQ(halfplane_target_copy_to(target_, color.data(), pitch, depth.data(), std::size_t{kWidth} * 4), 0);
  EXPECT_EQ(depth, drawn[1]);
  std::uint32_t code = 0;  // code of pixel 12, 11, lowest byte first in both formats
  std::memcpy(&code, &color[pitch * 11 + bytes * 12], bytes);
  EXPECT_EQ(code, drawn[0][11 * kWidth + 12]);
  const double near = 0;
  ASSERT_EQ(halfplane_target_clear(target_, nullptr, &near, -1), 0);
  EXPECT_NE(planes()[1], drawn[1]);
  ASSERT_EQ(halfplane_target_copy_from(target_, color.data(), pitch, depth.data(), std::size_t{kWidth} * 4), 0);
  EXPECT_EQ(planes(), drawn);
}

TEST_P(CapiTarget, WhatIsRefusedIsSaidInALineAndLeavesItAsItWas) {
  draw_all();
  ASSERT_EQ(say("space window\nstate depth_test always\n"), 0);
  const Planes before = planes();
  const auto expect_refusal = [&](std::int64_t status, const std::string& part) {
    EXPECT_LT(status, 0) << part;
    EXPECT_NE(std::string(halfplane_last_error()).find(part), std::string::npos) << halfplane_last_error();
    EXPECT_EQ(planes(), before) << part;
  };
  const auto refuse_layout = [&](const halfplane_layout& layout, std::size_t bytes, const std::string& part) {
    expect_refusal(halfplane_target_draw(target_, "triangles", &layout, kSquare.data(), bytes, 4, nullptr, 0), part);
  };
  halfplane_layout layout = kSmall;
  refuse_layout(layout, sizeof kSquare - 1, "layout: color of 4 vertices ends beyond the 31 bytes");
  layout.stride = ~std::size_t{0} / 2;
  refuse_layout(layout, sizeof kSquare, "layout: position of 4 vertices ends beyond");
  layout = kSmall;
  layout.position.type = 9;
  refuse_layout(layout, sizeof kSquare, "layout: position of type 9");
  layout.position = kNone;
  refuse_layout(layout, sizeof kSquare, "vertices without a position");
  layout = kSmall;
  layout.color.components = 2;
  refuse_layout(layout, sizeof kSquare, "layout: color of 2 components; give 3 to 4");
  layout = kSmall;
  layout.color = {HALFPLANE_I16, 3, 0};  // 68 and 38 are colours, so the third value is not: 255 * 256
  refuse_layout(layout, sizeof kSquare, "colour component outside 0...255");
  expect_refusal(draw("triangles", {0, 1, 4}), "index 2 of the draw is 4, and the draw has 4 vertices");
  expect_refusal(draw("hexagons", {0, 1, 2}), "no topology 'hexagons'; give one of triangles, triangle_strip");
  expect_refusal(halfplane_target_draw(target_, "triangles", nullptr, nullptr, 0, 0, nullptr, 0), "the layout is NULL");
  expect_refusal(halfplane_target_draw(target_, "triangles", &kSmall, nullptr, sizeof kSquare, 4, nullptr, 0),
                 "is NULL");
  expect_refusal(say("clear color 255 255 255 255\nstate cul none\n"), "lines:2: ");
  expect_refusal(say("clear color 255 255 255 255\nplanes 1 2\n"), "the planes of the target are given by");
  expect_refusal(say("state texture U\n"), "lines:1: ");
  const double wrong = 1.5;
  expect_refusal(halfplane_target_clear(target_, nullptr, &wrong, -1), "a depth outside 0...1");
  expect_refusal(halfplane_target_clear(target_, nullptr, nullptr, 256), "a stencil of 256");
  const std::array<std::uint8_t, 4> texel{};
  expect_refusal(halfplane_target_texture(target_, "two words", 1, 1, texel.data(), "l8", "none"),
                 "no word of a capture");
  expect_refusal(halfplane_target_texture(target_, "U", 0, 1, texel.data(), "l8", "none"), "sides of 1 to 4096");
  expect_refusal(halfplane_target_texture(target_, "U", 1, 1, texel.data(), "l9", "none"), "no texture format 'l9'");
  expect_refusal(halfplane_target_texture(target_, "U", 1, 1, nullptr, "l8", "none"), "is NULL");
  expect_refusal(halfplane_target_set_threads(target_, 0), "0 threads");
  std::vector<std::uint32_t> memory(kPixels);
  expect_refusal(halfplane_target_copy_to(target_, memory.data(), 3, nullptr, 0), "color_pitch of 3 bytes");
  expect_refusal(halfplane_target_plane(target_, "colour", memory.data(), kPixels), "no plane 'colour'");
  expect_refusal(halfplane_target_plane(target_, "color", memory.data(), 3), "room for 3 values");
  expect_refusal(halfplane_target_draw_scene(target_, nullptr), "the scene is NULL");
  EXPECT_EQ(halfplane_target_new(config_, 0, 4, nullptr), nullptr);
  EXPECT_EQ(halfplane_target_new(nullptr, 4, 4, nullptr), nullptr);
  const std::array<double, 2> planes_of_nothing{2, 1};
  EXPECT_EQ(halfplane_target_new(config_, 4, 4, planes_of_nothing.data()), nullptr);
  // The last state still holds, and the texture is unchanged.
  ASSERT_EQ(draw("triangle_strip", {0, 1, 2, 3}), 0) << halfplane_last_error();
  const auto written = halfplane_target_counter(target_, "written");
  EXPECT_GT(written, 1000);
  ASSERT_EQ(say("space window\nstate depth_test always\nstate texture T\n"), 0) << halfplane_last_error();
}

TEST_P(CapiTarget, ATextureOfTheSameNameTakesTheOthersPlace) {
  const std::array<std::uint8_t, 4> red{255, 0, 0, 255}, blue{0, 0, 255, 255};
  ASSERT_EQ(halfplane_target_texture(target_, "T", 1, 1, red.data(), "rgba8888", "none"), 0);
  ASSERT_EQ(say("space window\nstate depth_test always\nstate texture_combine replace\nstate texture T\n"), 0);
  const auto pixel = [&] {
    EXPECT_EQ(draw("triangle_strip", {0, 1, 2, 3}), 0) << halfplane_last_error();
    return planes()[0][20 * kWidth + 35];
  };
  const bool is_565 = std::strcmp(GetParam(), "rgb565") == 0;
  EXPECT_EQ(pixel(), is_565 ? 0xf800u : 0xff0000ffu);
  ASSERT_EQ(halfplane_target_texture(target_, "T", 1, 1, blue.data(), "rgba8888", "none"), 0);
  EXPECT_EQ(pixel(), is_565 ? 0x001fu : 0xffff0000u);
}

TEST_P(CapiTarget, ASceneTakesTheSameVerticesAndTextures) {
  halfplane_scene* scene = halfplane_scene_new(kWidth, kHeight);
  const std::array<std::uint8_t, 16> texels{255, 0, 0, 255, 0, 255, 0, 192, 0, 0, 255, 128, 255, 255, 255, 64};
  ASSERT_EQ(halfplane_scene_texture(scene, "T", 2, 2, texels.data(), "rgba8888", "box"), 0) << halfplane_last_error();
  EXPECT_LT(halfplane_scene_texture(scene, "T", 2, 2, texels.data(), "rgba8888", "box"), 0);
  const std::string lines = "state texture T\nstate shade phong\n";
  ASSERT_EQ(halfplane_scene_say(scene, lines.data(), lines.size()), 0) << halfplane_last_error();
  EXPECT_EQ(halfplane_scene_records(scene, &kSmall, kSquare.data(), sizeof kSquare, 4), 0);
  ASSERT_EQ(halfplane_scene_records(scene, &kFloat, kTriangle.data(), sizeof kTriangle, 3), 4);
  const std::array<std::uint32_t, 3> indices{4, 5, 6};
  ASSERT_EQ(halfplane_scene_draw(scene, "triangles", indices.data(), 3), 0) << halfplane_last_error();
  halfplane_frame* frame = halfplane_render(scene, config_, "functional");
  ASSERT_NE(frame, nullptr) << halfplane_last_error();
  std::vector<std::uint32_t> color(kPixels);
  EXPECT_EQ(halfplane_frame_plane(frame, "color", color.data(), kPixels), static_cast<std::int64_t>(kPixels));
  halfplane_frame_free(frame);
  halfplane_scene_free(scene);
  ASSERT_EQ(halfplane_target_texture(target_, "T", 2, 2, texels.data(), "rgba8888", "box"), 0);
  ASSERT_EQ(say(lines), 0);
  ASSERT_EQ(halfplane_target_draw(target_, "triangles", &kFloat, kTriangle.data(), sizeof kTriangle, 3, nullptr, 0), 0);
  EXPECT_EQ(planes()[0], color);
}

INSTANTIATE_TEST_SUITE_P(Formats, CapiTarget, testing::Values("rgb565", "rgba8888"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
