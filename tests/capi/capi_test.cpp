// The C interface: the same bits as the engines and stages, and one line for every error.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "halfplane.h"

namespace {

constexpr const char* kScene =
    "halfplane 1\ntarget 16 16\nclear color 10 20 30 255 depth 1 stencil 7\nspace window\n"
    "v 1 1 0.25 1 255 0 0 255\nv 15 2 0.5 1 0 255 0 255\nv 3 14 0.75 1 0 0 255 255\nt 0 1 2\n";

class Capi : public testing::Test {
 protected:
  void SetUp() override {
    config = halfplane_config_new("tiny");
    ASSERT_NE(config, nullptr) << halfplane_last_error();
    scene = halfplane_scene_read(kScene, std::strlen(kScene));
    ASSERT_NE(scene, nullptr) << halfplane_last_error();
  }
  void TearDown() override {
    halfplane_scene_free(scene);
    halfplane_config_free(config);
  }
  [[nodiscard]] std::vector<std::uint32_t> plane(const char* engine, const char* name) const {
    halfplane_frame* frame = halfplane_render(scene, config, engine);
    EXPECT_NE(frame, nullptr) << halfplane_last_error();
    std::vector<std::uint32_t> values(256);
    EXPECT_EQ(halfplane_frame_plane(frame, name, values.data(), values.size()), 256) << halfplane_last_error();
    halfplane_frame_free(frame);
    return values;
  }
  static void expect_error(std::int64_t status, const std::string& part) {
    EXPECT_LT(status, 0);
    EXPECT_NE(std::string(halfplane_last_error()).find(part), std::string::npos) << halfplane_last_error();
  }
  static void expect_error(const void* made, const std::string& part) { expect_error(made == nullptr ? -1 : 0, part); }

  halfplane_config* config = nullptr;
  halfplane_scene* scene = nullptr;
};

TEST_F(Capi, IsTheAbiOfItsHeader) { EXPECT_EQ(halfplane_abi(), HALFPLANE_ABI); }

TEST_F(Capi, ASceneOfArraysIsTheSceneOfItsCapture) {
  const std::vector<std::uint32_t> color = plane("functional", "color"), depth = plane("functional", "depth");
  halfplane_scene_free(scene);
  scene = halfplane_scene_new(16, 16);
  ASSERT_NE(scene, nullptr) << halfplane_last_error();
  const std::string lines = "clear color 10 20 30 255 depth 1 stencil 7\nspace window\n";
  ASSERT_EQ(halfplane_scene_say(scene, lines.data(), lines.size()), 0) << halfplane_last_error();
  const double vertices[][8]{
      {1, 1, 0.25, 1, 255, 0, 0, 255}, {15, 2, 0.5, 1, 0, 255, 0, 255}, {3, 14, 0.75, 1, 0, 0, 255, 255}};
  ASSERT_EQ(halfplane_scene_vertices(scene, &vertices[0][0], 8, 2), 0) << halfplane_last_error();
  ASSERT_EQ(halfplane_scene_vertices(scene, &vertices[2][0], 8, 1), 2) << "the index of the first";
  const std::uint32_t indices[]{0, 1, 2};
  ASSERT_EQ(halfplane_scene_draw(scene, "triangles", indices, 3), 0) << halfplane_last_error();
  EXPECT_EQ(plane("functional", "color"), color);
  EXPECT_EQ(plane("functional", "depth"), depth);
  // Another state for another draw: a triangle behind the first one, always drawn, owns the pixels it covers.
  const std::string always = "space window\nstate depth_test always\n";
  ASSERT_EQ(halfplane_scene_say(scene, always.data(), always.size()), 0);
  ASSERT_EQ(halfplane_scene_draw(scene, "points", indices, 1), 0) << halfplane_last_error();
  const std::string whole = std::string(kScene) + "state depth_test always\np 0\n";
  const std::vector<std::uint32_t> drawn = plane("functional", "color");
  halfplane_scene_free(scene);
  scene = halfplane_scene_read(whole.data(), whole.size());
  EXPECT_EQ(drawn, plane("functional", "color"));
}

TEST_F(Capi, ArraysThatAreNoSceneAreRefusedAndLeaveItAsItWas) {
  const double vertex[]{1, 1, 0.25, 1};
  const std::uint32_t indices[]{0, 1, 7};
  const auto before = plane("functional", "color");
  expect_error(halfplane_scene_new(0, 16), "");
  expect_error(halfplane_scene_vertices(scene, vertex, 5, 1), "4, 8 or 10 numbers, not 5");
  expect_error(halfplane_scene_vertices(scene, nullptr, 4, 1), "NULL");
  expect_error(halfplane_scene_draw(scene, "triangles", indices, 3), "index 2 of the draw is 7");
  expect_error(halfplane_scene_draw(scene, "hexagons", indices, 3), "no topology 'hexagons'");
  expect_error(halfplane_scene_say(scene, "state cull none\nv 1 1 1 1\n", 26), "vertices are given by");
  expect_error(halfplane_scene_say(scene, "state cul none\n", 15), "lines:1: ");
  expect_error(halfplane_scene_say(scene, "state cull none\nstate cul none\n", 31), "lines:2: ");
  const std::string incomplete = "texture T inline l8 2 1\nstate cull none\n", target = "target 16 16\ntarget 16 16\n";
  expect_error(halfplane_scene_say(scene, incomplete.data(), incomplete.size()), "from line 1 ");
  expect_error(halfplane_scene_say(scene, target.data(), target.size()),
               "lines:2: a second target, the first is on line 1");
  EXPECT_EQ(plane("functional", "color"), before);
}

TEST_F(Capi, AClearThatIsSaidHasTheScissorOfItsOwnLines) {
  halfplane_scene_free(scene);
  scene = halfplane_scene_new(16, 16);
  const std::string lines = "clear color 0 0 0 255 depth 1\nstate scissor 2 3 4 5\nclear color 255 255 255 255\n";
  ASSERT_EQ(halfplane_scene_say(scene, lines.data(), lines.size()), 0) << halfplane_last_error();
  const auto drawn = plane("functional", "color");
  for (unsigned y = 0; y < 16; ++y)
    for (unsigned x = 0; x < 16; ++x)
      EXPECT_EQ(drawn[y * 16 + x], x >= 2 && x < 6 && y >= 3 && y < 8 ? 0xffffu : 0u) << x << ", " << y;
}

TEST_F(Capi, EnginesDrawTheSameBits) {
  for (const char* name : {"depth", "color", "stencil"}) {
    const auto functional = plane("functional", name);
    EXPECT_EQ(plane("scalar", name), functional) << name;
    if (std::strcmp(name, "stencil") != 0) {
      EXPECT_EQ(plane("cycle", name), functional) << name;
    }
    halfplane_frame* frame = halfplane_render_threads(scene, config, "functional", 4);
    std::vector<std::uint32_t> values(256);
    EXPECT_EQ(halfplane_frame_plane(frame, name, values.data(), values.size()), 256) << halfplane_last_error();
    EXPECT_EQ(values, functional) << name;
    halfplane_frame_free(frame);
  }
  EXPECT_EQ(plane("functional", "stencil")[0], 7u);
}

TEST_F(Capi, FramesCountAndTheGoldenIsReal) {
  halfplane_frame* golden = halfplane_render(scene, config, "golden");
  ASSERT_NE(golden, nullptr) << halfplane_last_error();
  EXPECT_EQ(halfplane_frame_width(golden), 16);
  EXPECT_EQ(halfplane_frame_height(golden), 16);
  std::vector<double> depth(256), color(1024);
  EXPECT_EQ(halfplane_frame_reals(golden, "depth", depth.data(), depth.size()), 256);
  EXPECT_EQ(halfplane_frame_reals(golden, "color", color.data(), color.size()), 1024);
  EXPECT_NEAR(color[0], 10, 1e-9);
  const auto codes = plane("functional", "depth");
  for (std::size_t p = 0; p < 256; ++p) EXPECT_NEAR(depth[p], codes[p], 40) << p;  // snapped by up to 1/32 pixel
  halfplane_frame* cycle = halfplane_render(scene, config, "cycle");
  EXPECT_GT(halfplane_frame_counter(cycle, "cycles"), 64);
  EXPECT_EQ(halfplane_frame_counter(cycle, "written"), halfplane_frame_counter(golden, "written"));
  expect_error(halfplane_frame_counter(golden, "cycles"), "no counter 'cycles'");
  expect_error(halfplane_frame_reals(cycle, "depth", depth.data(), depth.size()), "only the golden");
  expect_error(halfplane_frame_plane(golden, "color", nullptr, 256), "is NULL");
  std::vector<std::uint32_t> few(255);
  expect_error(halfplane_frame_plane(golden, "color", few.data(), few.size()), "room for 255 values of 256");
  halfplane_frame_free(cycle);
  halfplane_frame_free(golden);
}

TEST_F(Capi, SettingsAreThoseOfTheProgram) {
  std::array<char, 8> value{};
  EXPECT_EQ(halfplane_config_set(config, "depth.bits", "20"), 0);
  EXPECT_EQ(halfplane_config_get(config, "depth.bits", value.data(), value.size()), 2);
  EXPECT_STREQ(value.data(), "20");
  EXPECT_EQ(halfplane_config_get(config, "color.format", value.data(), 4), 6);
  EXPECT_STREQ(value.data(), "rgb") << "cut";
  EXPECT_EQ(halfplane_config_get(config, "color.format", nullptr, 0), 6);
  expect_error(halfplane_config_set(config, "depth.bit", "20"), "no setting 'depth.bit'");
  expect_error(halfplane_config_set(config, "depth.bits", "99"), "depth.bits");
  expect_error(halfplane_config_get(config, "none", value.data(), value.size()), "no setting 'none'");
}

TEST_F(Capi, WhatIsWrongIsSaidInOneLine) {
  expect_error(halfplane_config_new("big"), "no preset 'big'");
  expect_error(halfplane_config_new(nullptr), "the preset is NULL");
  expect_error(halfplane_scene_read("halfplane 1\nnothing\n", 20), "scene:2: ");
  expect_error(halfplane_render(scene, config, "gpu"), "no engine 'gpu'");
  expect_error(halfplane_render(nullptr, config, "scalar"), "the scene is NULL");
  expect_error(halfplane_render_threads(scene, config, "functional", 0), "0 threads; give 1 to 1024");
  expect_error(halfplane_stage_new(config, "fine_rast"), "did you mean fine_raster?");
  expect_error(halfplane_stage_new(config, "viewport"), "cannot be run by itself");
  expect_error(halfplane_stage_new(config, "texture_unit"), "no texture unit");
  expect_error(halfplane_frame_width(nullptr), "the frame is NULL");
  std::thread([] { EXPECT_STREQ(halfplane_last_error(), "") << "another thread's"; }).join();
  halfplane_config_free(nullptr);
  halfplane_scene_free(nullptr);
  halfplane_frame_free(nullptr);
  halfplane_stage_free(nullptr);
}

/// The words of a packet of which some fields are given, the others 0. Fields count from the highest bit.
class PacketOf {
 public:
  PacketOf(halfplane_stage* stage, int is_out, int port) : stage_(stage), is_out_(is_out), port_(port) {
    words_.resize(static_cast<std::size_t>((halfplane_stage_port_bits(stage, is_out, port) + 31) / 32));
  }
  void set(const std::string& field, std::uint64_t value) {
    const auto [low, bits] = place(field);
    for (int i = 0; i < bits; ++i)
      if ((value >> i & 1) != 0) words_[static_cast<std::size_t>((low + i) / 32)] |= 1U << (low + i) % 32;
  }
  [[nodiscard]] std::uint64_t get(const std::string& field) const {
    const auto [low, bits] = place(field);
    std::uint64_t value = 0;
    for (int i = 0; i < bits; ++i)
      value |= std::uint64_t{words_[static_cast<std::size_t>((low + i) / 32)] >> (low + i) % 32 & 1} << i;
    return value;
  }
  [[nodiscard]] std::uint32_t* words() { return words_.data(); }

 private:
  [[nodiscard]] std::pair<int, int> place(const std::string& field) const {
    int low = halfplane_stage_port_bits(stage_, is_out_, port_);
    for (int f = 0; f < halfplane_stage_fields(stage_, is_out_, port_); ++f) {
      const int bits = std::abs(halfplane_stage_field_bits(stage_, is_out_, port_, f));
      low -= bits;
      if (halfplane_stage_field_name(stage_, is_out_, port_, f) == field) return {low, bits};
    }
    ADD_FAILURE() << "no field " << field;
    return {0, 0};
  }
  halfplane_stage* stage_;
  int is_out_, port_;
  std::vector<std::uint32_t> words_;
};

TEST_F(Capi, AStageTakesPacketsAsTheyCome) {
  halfplane_stage* stage = halfplane_stage_new(config, "fine_raster");
  ASSERT_NE(stage, nullptr) << halfplane_last_error();
  EXPECT_EQ(halfplane_stage_ports(stage, 0), 2);
  EXPECT_EQ(halfplane_stage_ports(stage, 1), 1);
  EXPECT_STREQ(halfplane_stage_port_name(stage, 0, 0), "tile");
  EXPECT_STREQ(halfplane_stage_port_name(stage, 0, 1), "edges");
  PacketOf tile(stage, 0, 0), edges(stage, 0, 1), stamp(stage, 1, 0);
  tile.set("is_visit", 1);
  tile.set("ends_primitive", 1);
  tile.set("right", 3);
  for (const char* step : {"step_x[0]", "step_x[1]", "step_x[2]"}) edges.set(step, 1);  // inside from the left on
  EXPECT_EQ(halfplane_stage_get(stage, 0, stamp.words()), 0) << "nothing has gone in";
  EXPECT_EQ(halfplane_stage_put(stage, 1, edges.words()), 0);
  EXPECT_EQ(halfplane_stage_get(stage, 0, stamp.words()), 0) << "edges wait for their tile";
  EXPECT_EQ(halfplane_stage_put(stage, 0, tile.words()), 0);
  for (unsigned n = 0; n < 4; ++n) {
    ASSERT_EQ(halfplane_stage_get(stage, 0, stamp.words()), 1);
    EXPECT_EQ(stamp.get("stamp"), n);
    EXPECT_EQ(stamp.get("mask"), 1u);
    EXPECT_EQ(stamp.get("ends_visit"), n == 3 ? 1u : 0u);
  }
  EXPECT_EQ(halfplane_stage_get(stage, 0, stamp.words()), 0);
  expect_error(halfplane_stage_put(stage, 2, tile.words()), "no port 2");
  expect_error(halfplane_stage_get(stage, 1, stamp.words()), "no port 1");
  expect_error(halfplane_stage_put(stage, 0, nullptr), "the packet is NULL");
  expect_error(halfplane_stage_field_name(stage, 0, 0, 99), "no field 99");
  EXPECT_LT(halfplane_stage_field_bits(stage, 0, 1, 0), 0) << "steps are signed";
  halfplane_stage_free(stage);
}

TEST_F(Capi, APlaceOutsideTheTargetIsRefusedAndNothingElseHappens) {
  halfplane_config* small = halfplane_config_new("small");
  halfplane_stage* stage = halfplane_stage_new(small, "coarse_raster");
  ASSERT_NE(stage, nullptr) << halfplane_last_error();
  PacketOf setup(stage, 0, 0), outside(stage, 0, 1), inside(stage, 0, 1), context(stage, 1, 0);
  outside.set("tile_x", 63);
  EXPECT_EQ(halfplane_stage_put(stage, 1, inside.words()), 0);
  expect_error(halfplane_stage_put(stage, 1, outside.words()), "'tile_x' is 63, and the largest target ends at");
  EXPECT_EQ(halfplane_stage_put(stage, 0, setup.words()), 0);
  EXPECT_EQ(halfplane_stage_get(stage, 0, context.words()), 1);
  halfplane_stage_free(stage);
  halfplane_config_free(small);
}

TEST_F(Capi, InAChildAStageOfItsParentIsRefused) {
  halfplane_stage* stage = halfplane_stage_new(config, "fine_raster");
  ASSERT_NE(stage, nullptr) << halfplane_last_error();
  const pid_t child = fork();
  if (child == 0) {
    alarm(10);
    PacketOf tile(stage, 0, 0);
    const bool is_refused = halfplane_stage_put(stage, 0, tile.words()) < 0;
    halfplane_stage_free(stage);
    _exit(is_refused ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  halfplane_stage_free(stage);
}

/// Bits that no hardware sends. A stage takes them, or says in a line that it does not; none hangs, none leaves its memory
/// (this test is meant for the sanitizers).
TEST_F(Capi, RandomBitsAreTakenOrRefused) {
  constexpr const char* kStages[] = {"cull",        "triangle_setup", "coarse_raster", "fine_raster", "interpolate",
                                     "line_raster", "primitive_join", "depth_test",    "rop",         "texture_unit",
                                     "framebuffer", "memory_port",    "memory"};
  std::mt19937_64 random(26);
  for (const char* settings : {"", "texture.unit=trilinear fog.unit=1 alpha.unit=1 stencil.bits=8 blend.lanes=4"}) {
    halfplane_config* all = halfplane_config_new("embedded");
    std::istringstream words(settings);
    for (std::string word; words >> word;)
      ASSERT_EQ(
          halfplane_config_set(all, word.substr(0, word.find('=')).c_str(), word.substr(word.find('=') + 1).c_str()),
          0);
    for (const char* name : kStages) {
      SCOPED_TRACE(name);
      int taken = 0;
      for (int n = 0; n < 40; ++n) {
        halfplane_stage* stage = halfplane_stage_new(all, name);
        if (stage == nullptr) break;  // this hardware has no such unit
        const int ports = halfplane_stage_ports(stage, 0), out_ports = halfplane_stage_ports(stage, 1);
        const unsigned density = n % 4;  // every bit by chance; or fewer: places inside of the target are more likely
        for (int packet = 0; packet < 30; ++packet)
          for (int port = 0; port < ports; ++port) {
            std::vector<std::uint32_t> bits(static_cast<std::size_t>(halfplane_stage_port_bits(stage, 0, port) + 31) /
                                            32);
            for (std::uint32_t& word : bits) {
              word = static_cast<std::uint32_t>(random());
              for (unsigned less = 0; less < density; ++less) word &= static_cast<std::uint32_t>(random());
            }
            taken += halfplane_stage_put(stage, port, bits.data()) == 0 ? 1 : 0;
            EXPECT_EQ(std::string(halfplane_last_error()).find('\n'), std::string::npos);
          }
        for (int port = 0; port < out_ports; ++port) {
          std::vector<std::uint32_t> bits(static_cast<std::size_t>(halfplane_stage_port_bits(stage, 1, port) + 31) /
                                          32);
          while (halfplane_stage_get(stage, port, bits.data()) == 1) {
          }
        }
        halfplane_stage_free(stage);
      }
      if (std::strcmp(name, "texture_unit") != 0 || *settings != 0) {
        EXPECT_GT(taken, 0);
      }
    }
    halfplane_config_free(all);
  }
}

TEST_F(Capi, AReadOfFlagsThatAreShorterThanAStampIsRefused) {
  halfplane_config* stencilled = halfplane_config_new("embedded");
  ASSERT_EQ(halfplane_config_set(stencilled, "stencil.bits", "8"),
            0);  // a stamp's depths are 16 bytes, a word of flags 8
  halfplane_stage* stage = halfplane_stage_new(stencilled, "memory_port");
  ASSERT_NE(stage, nullptr) << halfplane_last_error();
  PacketOf request(stage, 0, 0);
  request.set("plane", 2);  // depth_flags
  expect_error(halfplane_stage_put(stage, 0, request.words()), "a read of flags");
  halfplane_stage_free(stage);
  halfplane_config_free(stencilled);
}

TEST_F(Capi, ABoxThatEndsBeforeItBeginsIsRefused) {
  halfplane_stage* stage = halfplane_stage_new(config, "coarse_raster");
  ASSERT_NE(stage, nullptr) << halfplane_last_error();
  PacketOf setup(stage, 0, 0);
  setup.set("left", 9);
  setup.set("right", 8);
  expect_error(halfplane_stage_put(stage, 0, setup.words()), "a box that ends before it begins");
  halfplane_stage_free(stage);
}

TEST_F(Capi, AStageThatCannotTakeAPacketSaysSoFromThenOn) {
  halfplane_stage* stage = halfplane_stage_new(config, "triangle_setup");
  ASSERT_NE(stage, nullptr) << halfplane_last_error();
  PacketOf flat(stage, 0, 0);  // a triangle of area 0
  expect_error(halfplane_stage_put(stage, 0, flat.words()), "a triangle without area");
  expect_error(halfplane_stage_put(stage, 0, flat.words()), "a triangle without area");
  halfplane_stage_free(stage);
}

}  // namespace
