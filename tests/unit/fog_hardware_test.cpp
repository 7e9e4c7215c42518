// Fog in hardware: the hardware and the cycle engine against the scalar one, the tokens that bring its table, the
// refusals.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "../hardware_scene.hpp"
#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/packets/state_packets.hpp"
#include "model/stages/fog_unit.hpp"
#include "model/stages/texture_levels.hpp"
#include "sim/cosim/random_scene.hpp"

namespace halfplane::fog_hardware_test {
namespace {

using test::with;

TEST(FogHardware, DrawsRandomScenesAsTheScalarEngine) {
  std::size_t fogged = 0;
  for (const Config& config :
       {with("embedded", {{"texture.unit", "nearest"}, {"fog.unit", "1"}}),
        with("embedded", {{"texture.unit", "bilinear"}, {"fog.unit", "1"}, {"blend.lanes", "1"}, {"alpha.unit", "1"}}),
        with("embedded",
             {{"texture.unit", "trilinear"}, {"fog.unit", "1"}, {"frame.order", "bins"}, {"cache.lines", "16"}}),
        with("full", {{"texture.unit", "nearest"}, {"fog.unit", "1"}}),
        with("tiny",
             {{"cache.kind", "blocks"}, {"texture.unit", "nearest"}, {"fog.unit", "1"}, {"stencil.bits", "8"}})})
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const Scene scene = random_scene(config, seed, 40);
      for (const State& state : scene.states) fogged += state.fog ? 1 : 0;
      const Rendering scalar = render_scalar(scene, config);
      EXPECT_EQ(scalar.frame.color, render_hardware(scene, config).frame.color) << scene.name << ", " << label(config);
      const auto memory = make_memory({}, config);
      EXPECT_EQ(scalar.frame.color, render_cycle(scene, config, *memory).rendering.frame.color)
          << scene.name << ", " << label(config);
    }
  EXPECT_GT(fogged, 100U);
}

TEST(FogHardware, TheTableComesOutOfItsTokensAsItWentIn) {
  std::mt19937_64 random(6);
  const auto below = [&random](unsigned n) { return static_cast<unsigned>(random() % n); };
  for (int n = 0; n < 50; ++n) {
    const double start = 0.01 * below(200);
    const FogTable table({static_cast<FogKind>(below(3)), start, start + 0.03 * below(100)},
                         {static_cast<std::uint8_t>(below(256)), static_cast<std::uint8_t>(below(256)), 7});
    FogUnit unit;
    const FogState state{true, table.octave_bits(), table.color()};
    EXPECT_EQ(FogState::unpack(state.pack()), state);
    unit.set(state.pack());
    for (std::size_t i = 0; i < table.lines().size(); ++i) {
      EXPECT_EQ(levels_word(fog_line_word(i, table.lines()[i])), LevelsWord::fog_line);
      EXPECT_LT(fog_line_word(i, table.lines()[i]), std::uint64_t{1} << 45);
      unit.set(fog_line_word(i, table.lines()[i]));
    }
    for (int k = 0; k < 200; ++k) {
      const std::uint64_t q = 1 + random() % ((std::uint64_t{1} << (1 + below(31))) - 0);
      const int scale = static_cast<int>(below(80)) - 30;
      Texel color{static_cast<std::uint8_t>(below(256)), 100, 200, 50};
      const Texel before = color;
      unit.add(q, fog_octave(table, scale), color);
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_EQ(color[c], fogged<std::uint32_t>(before[c], table.color()[c], table.factor(q, scale)));
      EXPECT_EQ(color[3], before[3]);
    }
  }
}

/// A triangle under each of the fogs.
Scene triangles(const std::vector<std::optional<Fog>>& fogs) {
  Scene scene;
  scene.name = "fogs";
  scene.width = scene.height = 16;
  scene.states.push_back({});
  scene.commands.push_back(Clear{0, std::array<double, 4>{10, 20, 30, 255}, 1.0});
  for (const auto& fog : fogs) {
    State state;
    state.space = Space::window;
    state.fog = fog;
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
    }
    scene.commands.push_back(
        Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0, Topology::triangles, first, 3, 0});
  }
  return scene;
}

/// How many tokens of fog the host sends, of either kind.
std::array<std::size_t, 2> tokens_sent(const Scene& scene, const Config& config) {
  std::array<std::size_t, 2> sent{};
  const Widths widths = derive_widths(config);
  HostStream host(scene, config);
  while (const auto next = host.next())
    if (next->packet.kind == PrimitiveKind::state &&
        state_register(next->packet.state) == StateRegister::texture_levels) {
      const LevelsWord word = levels_word(state_word(next->packet.vertex.code[0], widths));
      sent[0] += word == LevelsWord::fog ? 1U : 0U;
      sent[1] += word == LevelsWord::fog_line ? 1U : 0U;
    }
  return sent;
}

TEST(FogHardware, TheHostSendsTheLinesThatDiffer) {
  const Config config = with("embedded", {{"texture.unit", "nearest"}, {"fog.unit", "1"}});
  const Fog near{FogKind::linear, 1, 4}, far{FogKind::exp, 0.01, 0.01};
  using Sent = std::array<std::size_t, 2>;
  EXPECT_EQ(tokens_sent(triangles({std::nullopt, std::nullopt}), config), (Sent{1, 0}));
  EXPECT_EQ(tokens_sent(triangles({near, near, near}), config), (Sent{1, 256}));
  EXPECT_EQ(tokens_sent(triangles({near, std::nullopt, near}), config), (Sent{3, 256}));
  const Sent both = tokens_sent(triangles({near, far}), config);
  EXPECT_EQ(both[0], 2U);
  EXPECT_GT(both[1], 256U);
  EXPECT_LE(both[1], 512U);
}

TEST(FogHardware, RefusesByNameWhatItHasNoUnitFor) {
  const Scene scene = triangles({Fog{FogKind::exp, 0.1, 0.1}});
  const auto fault = [](const Scene& of, const Config& config) -> std::string {
    try {
      check_hardware_scene(of, config);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  const Config config = with("embedded", {{"texture.unit", "nearest"}, {"fog.unit", "1"}});
  EXPECT_EQ(fault(scene, config), "");
  EXPECT_NE(fault(scene, preset("embedded")).find("fog.unit=1"), std::string::npos);
  Scene affine = scene;
  affine.textures.push_back(make_texture("one", TexelImage{1, 1, {Texel{1, 2, 3, 4}}}, TextureFormat::l8, Mips::none));
  affine.states[1].texture = 0;
  EXPECT_EQ(fault(affine, config), "");
  affine.states[1].texture_interp = TextureInterp::affine;
  EXPECT_NE(fault(affine, config).find("one plane of 1/w"), std::string::npos) << fault(affine, config);
  Config alone = preset("embedded");
  alone.fog_units = 1;
  EXPECT_THROW(validate(alone), InputError);
}

}  // namespace
}  // namespace halfplane::fog_hardware_test
