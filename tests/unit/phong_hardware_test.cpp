// Light of fragments in hardware: the hardware and the cycle engine against the scalar one, the tokens that bring its
// registers, the refusals.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "../hardware_scene.hpp"
#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/packets/state_packets.hpp"
#include "model/stages/light_unit.hpp"
#include "sim/cosim/random_scene.hpp"

namespace halfplane::phong_hardware_test {
namespace {

using test::with;

TEST(PhongHardware, DrawsRandomScenesAsTheScalarEngine) {
  std::size_t lit = 0;
  for (const Config& config :
       {with("embedded", {{"texture.unit", "nearest"}, {"shade.unit", "1"}}),
        with("embedded", {{"texture.unit", "bilinear"},
                          {"texture.lanes", "4"},
                          {"shade.unit", "1"},
                          {"fog.unit", "1"},
                          {"blend.lanes", "1"},
                          {"alpha.unit", "1"}}),
        with("embedded",
             {{"texture.unit", "trilinear"}, {"shade.unit", "1"}, {"frame.order", "bins"}, {"cache.lines", "16"}}),
        with("full", {{"texture.unit", "nearest"}, {"shade.unit", "1"}}),
        with("tiny",
             {{"cache.kind", "blocks"}, {"texture.unit", "nearest"}, {"shade.unit", "1"}, {"stencil.bits", "8"}})})
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
      const Scene scene = random_scene(config, seed, 40);
      for (const State& state : scene.states) lit += state.shade == Shade::phong ? 1 : 0;
      const Rendering scalar = render_scalar(scene, config);
      EXPECT_EQ(scalar.frame.color, render_hardware(scene, config).frame.color) << scene.name << ", " << label(config);
      const auto memory = make_memory({}, config);
      EXPECT_EQ(scalar.frame.color, render_cycle(scene, config, *memory).rendering.frame.color)
          << scene.name << ", " << label(config);
    }
  EXPECT_GT(lit, 100U);
}

TEST(PhongHardware, TheLightComesOutOfItsTokensAsItWentIn) {
  std::mt19937_64 random(6);
  const auto below = [&random](unsigned n) { return static_cast<unsigned>(random() % n); };
  const auto byte = [&] { return static_cast<std::uint8_t>(below(256)); };
  const auto component = [&] { return static_cast<double>(below(201)) - 100; };
  for (int n = 0; n < 100; ++n) {
    const PhongLight light({.direction = {component(), component(), component()},
                            .half = {component(), component(), component()},
                            .ambient = {byte(), byte(), byte()},
                            .diffuse = {byte(), 255, byte()},
                            .specular = {byte(), byte(), 255},
                            .shininess = 1 + 0.1 * below(1271)});
    LightUnit unit;
    EXPECT_FALSE(unit.is_lit(true));
    for (const std::uint64_t word : light_words(light.registers())) {
      EXPECT_EQ(levels_word(word), LevelsWord::light);
      EXPECT_LT(word, std::uint64_t{1} << 45);
      unit.set(word);
    }
    EXPECT_TRUE(unit.is_lit(true));
    EXPECT_FALSE(unit.is_lit(false));
    for (std::size_t i = 0; i < light.lines().size(); ++i) {
      EXPECT_LT(light.lines()[i].start, 1 << 16);
      EXPECT_LT(light.lines()[i].fall, 1 << 11);
      EXPECT_GE(std::min(light.lines()[i].start, light.lines()[i].fall), 0);
      unit.set(light_line_word(i, light.lines()[i]));
    }
    for (int k = 0; k < 200; ++k) {
      std::array<std::int64_t, 3> p{};
      for (std::int64_t& c : p) c = static_cast<std::int64_t>(random() % 4001) - 2000;
      Texel color{byte(), byte(), byte(), byte()};
      const Texel before = color;
      unit.add(p, color);
      const LightFactors factors = light.factors(block_normal(p));
      for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(color[c], light.lit(c, before[c], factors));
      EXPECT_EQ(color[3], before[3]);
    }
    unit.set(no_light_word());
    EXPECT_FALSE(unit.is_lit(true));
  }
}

/// A triangle for each power; 0: it is not lit.
Scene triangles(const std::vector<double>& powers) {
  Scene scene;
  scene.name = "lights";
  scene.width = scene.height = 16;
  scene.states.push_back({});
  scene.commands.push_back(Clear{0, std::array<double, 4>{10, 20, 30, 255}, 1.0});
  for (const double power : powers) {
    State state;
    state.space = Space::window;
    if (power > 0) state.shade = Shade::phong, state.light_shininess = power;
    scene.states.push_back(state);
    const auto first = scene.indices.size();
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {16.0, 0.0}, {0.0, 16.0}}) {
      Vertex v;
      v.x = x;
      v.y = y;
      v.z = 0.5;
      v.w = 1 + x;
      v.rgba = {200, 100, 50, 128};
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
      scene.vertices.push_back(v);
      scene.normals.push_back({x / 16, y / 16, 1});
    }
    scene.commands.push_back(
        Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0, Topology::triangles, first, 3, 0});
  }
  return scene;
}

/// How many tokens of light the host sends.
std::size_t tokens_sent(const Scene& scene, const Config& config) {
  std::size_t sent = 0;
  const Widths widths = derive_widths(config);
  HostStream host(scene, config);
  while (const auto next = host.next())
    if (next->packet.kind == PrimitiveKind::state &&
        state_register(next->packet.state) == StateRegister::texture_levels)
      sent += levels_word(state_word(next->packet.vertex.code[0], widths)) == LevelsWord::light ? 1U : 0U;
  return sent;
}

TEST(PhongHardware, TheHostSendsWhatDiffers) {
  const Config config = with("embedded", {{"texture.unit", "nearest"}, {"shade.unit", "1"}});
  constexpr std::size_t kAll = kLightWords + 256;
  EXPECT_EQ(tokens_sent(triangles({0, 0}), config), 1U);
  EXPECT_EQ(tokens_sent(triangles({8, 8, 8}), config), kAll);
  EXPECT_EQ(tokens_sent(triangles({8, 0, 8}), config), kAll + 2);
  const std::size_t both = tokens_sent(triangles({8, 64}), config);
  EXPECT_GT(both, kAll);
  EXPECT_LE(both, kAll + 257);
}

TEST(PhongHardware, RefusesByNameWhatItHasNoUnitFor) {
  const Scene scene = triangles({8});
  const auto fault = [](const Scene& of, const Config& config) -> std::string {
    try {
      check_hardware_scene(of, config);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  const Config config = with("embedded", {{"texture.unit", "nearest"}, {"shade.unit", "1"}});
  EXPECT_EQ(fault(scene, config), "");
  EXPECT_NE(fault(scene, preset("embedded")).find("shade.unit=1"), std::string::npos);
  Scene affine = scene;
  affine.textures.push_back(make_texture("one", TexelImage{1, 1, {Texel{1, 2, 3, 4}}}, TextureFormat::l8, Mips::none));
  affine.states[1].texture = 0;
  EXPECT_EQ(fault(affine, config), "");
  affine.states[1].texture_interp = TextureInterp::affine;
  EXPECT_NE(fault(affine, config).find("one plane of 1/w"), std::string::npos) << fault(affine, config);
  Config alone = preset("embedded");
  alone.shade_units = 1;
  EXPECT_THROW(validate(alone), InputError);
  Config divides = config;
  divides.perspective_colors = 1;
  EXPECT_THROW(validate(divides), InputError);
}

}  // namespace
}  // namespace halfplane::phong_hardware_test
