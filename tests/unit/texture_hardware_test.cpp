// Textured triangles in hardware: the hardware and the cycle engine against the scalar one, and what a texture unit refuses.
#include <gtest/gtest.h>

#include <string>

#include "../hardware_scene.hpp"
#include "model/capture/capture.hpp"
#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/host_stream.hpp"
#include "model/stages/texture_packets.hpp"
#include "sim/cosim/random_scene.hpp"

namespace halfplane {
namespace {

using test::with;

const std::vector<Config>& configurations() {
  static const std::vector<Config> all{
      with("embedded", {{"texture.unit", "nearest"}}),
      with("embedded", {{"texture.unit", "nearest"}, {"frame.order", "bins"}, {"texture.cache_kb", "1"}}),
      with("embedded", {{"texture.unit", "bilinear"}}),
      with("full", {{"texture.unit", "bilinear"}, {"texture.cache_kb", "1"}, {"memory.port_bits", "32"}}),
      with("full", {{"texture.unit", "nearest"}, {"texture.queue", "8"}}),
      with("tiny", {{"texture.unit", "nearest"}, {"cache.kind", "blocks"}, {"perspective.bits", "12"}})};
  return all;
}

/// A floor to the horizon that crosses the eye's plane, a wall in front of it, and a triangle without a texture.
constexpr const char* kRoom = R"(halfplane 1
target 64 48
clear color 90 140 200 255 depth 1
texture ground pattern grid 64 64 format rgb565
texture wall pattern chequer 16 8 format l8
state texture ground
state texture_wrap repeat mirror
v -40 -4 60 62 255 255 255 255 -8 16
v 40 -4 60 62 255 255 255 255 8 16
v 8 -2 -1 -1.5 200 220 255 255 2 0
v -8 -2 -1 -1.5 255 220 200 255 -2 0
t 0 1 2 0 2 3
state texture wall
state texture_combine decal
state texture_interp affine
v -3 -1 6 8 255 40 40 255 0 2
v 0 -1.5 4 6 40 255 40 255 2 2
v 0 3 4 6 40 40 255 255 2 0
t 4 5 6
state texture off
v 2 -1 5 7 255 0 0 255
v 5 -1 5 7 0 255 0 255
v 3.5 3 5 7 0 0 255 255
t 7 8 9
)";

void expect_equal(const Scene& scene, const Config& config) {
  const Rendering scalar = render_scalar(scene, config), hardware = render_hardware(scene, config);
  EXPECT_EQ(scalar.frame.color, hardware.frame.color) << scene.name << ", " << label(config);
  EXPECT_EQ(scalar.frame.depth, hardware.frame.depth) << scene.name << ", " << label(config);
  const auto memory = make_memory({}, config);
  const Rendering cycle = render_cycle(scene, config, *memory).rendering;
  EXPECT_EQ(scalar.frame.color, cycle.frame.color) << scene.name << ", " << label(config);
}

TEST(TexturedHardware, DrawsARoomAsTheScalarEngine) {
  for (Config config : configurations()) {
    config.target_width = std::max(config.target_width, 64);
    config.target_height = std::max(config.target_height, 64);
    config.guard_band = std::max(config.guard_band, 128);
    expect_equal(read_capture(kRoom, "room"), config);
  }
}

TEST(TexturedHardware, DrawsRandomScenesAsTheScalarEngine) {
  for (const Config& config : configurations())
    for (std::uint64_t seed = 1; seed <= 12; ++seed) expect_equal(random_scene(config, seed, 25), config);
}

// One word of 45 bits, over the codes of a vertex and back from a fragment that setup and interpolation have made of it.
TEST(TexturedHardware, ATokenKeepsItsWordThroughThePlanes) {
  for (const Config& config : configurations()) {
    const Widths widths = derive_widths(config);
    for (std::uint64_t word = 1; word < std::uint64_t{1} << TextureState::kBits; word = word * 5 + 3) {
      const TextureState state = TextureState::unpack(word);
      PerPlane<std::uint32_t> code{};
      set_texture_word(code, state.pack(), widths);
      EXPECT_EQ(TextureState::unpack(texture_word(code, widths)), state) << label(config);
    }
  }
}

TEST(TexturedHardware, RefusesByNameWhatTheUnitLacks) {
  const Config with_unit = configurations().front();
  const auto fault = [](std::string text, const Config& config, const std::string& from, const std::string& to) {
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    try {
      check_hardware_scene(read_capture(text, "room"), config);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto names = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_EQ(fault(kRoom, with_unit, "", ""), "");
  EXPECT_TRUE(names(fault(kRoom, preset("embedded"), "", ""), "texture.unit=nearest"));
  EXPECT_TRUE(names(fault(kRoom, with_unit, "state texture off", "state color_interp perspective"), "color_interp"));
  EXPECT_TRUE(names(fault(kRoom, with_unit, "state texture off", "state texture_mag linear"), "texture_mag"));
  const std::string linear = "state texture_mag linear\nstate texture_min linear";
  EXPECT_TRUE(names(fault(kRoom, with_unit, "state texture_wrap", linear + "\nstate texture_wrap"), "bilinear"));
  EXPECT_EQ(fault(kRoom, configurations()[2], "state texture_wrap", linear + "\nstate texture_wrap"), "");
  EXPECT_TRUE(names(fault(kRoom, with_unit, "16 8 format", "16 9 format"), "16x9"));
  EXPECT_THROW(validate(with("tiny", {{"texture.unit", "nearest"}})), InputError);
  EXPECT_THROW(validate(with("full", {{"texture.unit", "nearest"}, {"stamp.size", "8"}})), InputError);
  EXPECT_THROW(validate(with("embedded", {{"texture.cache_kb", "3"}})), InputError);
}

// A triangle in window space may have any w; by one that is not above 0 nothing can be divided.
TEST(TexturedHardware, RefusesATriangleBehindTheEye) {
  const Scene scene = read_capture(
      "halfplane 1\ntarget 8 8\ntexture t pattern chequer 8 8\nspace window\nstate texture t\nv 0 0 0 1\nv 8 0 0 1\nv "
      "0 8 0 0\n"
      "t 0 1 2\n",
      "behind");
  EXPECT_THROW((void)render_hardware(scene, configurations().front()), InputError);
}

}  // namespace
}  // namespace halfplane
