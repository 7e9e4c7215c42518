// The stencil in hardware, in one word with the depth: the hardware and the cycle engine against the scalar one, the
// tokens that set it, the memory reads for it, the form of clears, HiZ, and the refusals without it.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "../hardware_scene.hpp"
#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/stages/stencil_packets.hpp"
#include "sim/cosim/random_scene.hpp"

namespace halfplane::stencil_hardware_test {
namespace {

using test::with;

const std::vector<Config>& configurations() {
  static const std::vector<Config> all{
      with("embedded", {{"stencil.bits", "8"}}),
      with("embedded", {{"stencil.bits", "8"}, {"alpha.unit", "1"}, {"cache.lines", "4"}, {"cache.victims", "2"}}),
      with("embedded", {{"stencil.bits", "8"},
                        {"blend.lanes", "1"},
                        {"stamp.size", "4"},
                        {"depth.bits", "24"},
                        {"cache.lines", "8"}}),
      with("embedded", {{"stencil.bits", "8"}, {"frame.order", "bins"}, {"cache.lines", "16"}}),
      with("embedded", {{"stencil.bits", "8"}, {"texture.unit", "nearest"}, {"alpha.unit", "1"}, {"blend.lanes", "4"}}),
      with("full", {{"stencil.bits", "8"}, {"texture.unit", "bilinear"}, {"alpha.unit", "1"}, {"hiz.bits", "6"}}),
      with("tiny", {{"stencil.bits", "8"}, {"cache.kind", "blocks"}, {"alpha.unit", "1"}})};
  return all;
}

TEST(StencilHardware, DrawsRandomScenesAsTheScalarEngine) {
  std::uint64_t not_zero = 0, killed = 0;
  for (const Config& config : configurations())
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      const Scene scene = random_scene(config, seed, 40);
      const Rendering scalar = render_scalar(scene, config), hardware = render_hardware(scene, config),
                      functional = render_functional(scene, config);
      const auto memory = make_memory({}, config);
      const Rendering cycle = render_cycle(scene, config, *memory).rendering;
      for (const Rendering* other : {&hardware, &cycle, &functional}) {
        EXPECT_EQ(scalar.frame.stencil, other->frame.stencil) << scene.name << ", " << label(config);
        EXPECT_EQ(scalar.frame.depth, other->frame.depth) << scene.name << ", " << label(config);
        EXPECT_EQ(scalar.frame.color, other->frame.color) << scene.name << ", " << label(config);
        EXPECT_EQ(scalar.counters.depth_passed, other->counters.depth_passed) << scene.name << ", " << label(config);
        EXPECT_EQ(scalar.counters.alpha_killed, other->counters.alpha_killed) << scene.name << ", " << label(config);
        EXPECT_EQ(scalar.counters.written, other->counters.written) << scene.name << ", " << label(config);
      }
      not_zero += static_cast<std::uint64_t>(
          std::ranges::count_if(hardware.frame.stencil, [](std::uint8_t value) { return value != 0; }));
      killed += scalar.counters.alpha_killed;
    }
  EXPECT_GT(not_zero, 40'000u);
  EXPECT_GT(killed, 1000u);
}

TEST(StencilHardware, StatesComeOutOfTheirTokensAsTheyWentIn) {
  std::mt19937_64 random(9);
  const auto below = [&random](unsigned n) { return static_cast<unsigned>(random() % n); };
  const auto byte = [&] { return static_cast<std::uint8_t>(below(256)); };
  const auto op = [&] { return static_cast<StencilOp>(below(8)); };
  StencilState state;
  StencilSides wanted{};
  for (int n = 0; n < 4000; ++n) {
    const Stencil next{static_cast<DepthFunc>(below(8)), byte(), byte(), byte(), op(), op(), op()};
    const std::uint32_t sides = 1 + below(3);
    const StateRegister which = below(2) == 0 ? StateRegister::stencil_test : StateRegister::stencil_update;
    const bool is_test = which == StateRegister::stencil_test;
    const std::uint32_t word = with_sides(which, is_test ? pack_test(next) : pack_update(next), sides);
    EXPECT_LT(word, 1U << 21);
    state.set(which, word);
    for (const std::size_t side : {0U, 1U}) {
      if ((sides >> side & 1) == 0) continue;
      Stencil& held = wanted[side];
      held = is_test ? Stencil{next.func,          next.reference,   next.read_mask, held.write_mask,
                               held.stencil_fails, held.depth_fails, held.passes}
                     : Stencil{held.func,          held.reference,   held.read_mask, next.write_mask,
                               next.stencil_fails, next.depth_fails, next.passes};
    }
    EXPECT_EQ(state.side, wanted);
    state.set(StateRegister::alpha_test, byte());
    EXPECT_EQ(state.side, wanted);
    EXPECT_EQ(state.clear_value(), wanted[0].reference);
  }
}

/// Squares of `side` pixels at the origin, in halves, one a state, the first after a whole clear of all three planes.
Scene squares(const std::vector<State>& states, double side = 8, int size = 16) {
  Scene scene;
  scene.name = "squares";
  scene.width = scene.height = size;
  scene.states.push_back({});
  scene.commands.push_back(Clear{0, std::array<double, 4>{10, 20, 30, 255}, 1.0, std::uint8_t{7}});
  double z = 0.25;
  for (State state : states) {
    state.space = Space::window;
    scene.states.push_back(state);
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {side, 0.0}, {side, side}, {0.0, side}}) {
      Vertex v;
      v.x = x;
      v.y = y;
      v.z = z;
      scene.vertices.push_back(v);
    }
    z += 0.25;
    const std::size_t index = scene.indices.size();
    for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) scene.indices.push_back(first + i);
    scene.commands.push_back(
        Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0, Topology::triangles, index, 6, 0});
  }
  return scene;
}

State with_stencil(const Stencil& stencil) {
  State state;
  state.stencil = stencil;
  return state;
}

std::vector<HostPrimitive> sent(const Scene& scene, const Config& config) {
  std::vector<HostPrimitive> all;
  HostStream host(scene, config);
  while (auto next = host.next()) all.push_back(std::move(*next));
  return all;
}

std::size_t count(const std::vector<HostPrimitive>& all, PrimitiveKind kind) {
  return static_cast<std::size_t>(
      std::ranges::count_if(all, [kind](const HostPrimitive& p) { return p.packet.kind == kind; }));
}

TEST(StencilHardware, TokensComeOnlyWhereSomethingChanges) {
  const Config config = with("embedded", {{"stencil.bits", "8"}});
  const State marking = with_stencil(replacing_stencil(1));
  State two_sided = marking;
  two_sided.stencil_back = replacing_stencil(2);
  const auto tokens = [&](const std::vector<State>& states) {
    return count(sent(squares(states), config), PrimitiveKind::state);
  };
  EXPECT_EQ(tokens({}), 1u) << "the value of the clear";
  EXPECT_EQ(tokens({State{}, State{}}), 1u);
  EXPECT_EQ(tokens({marking, marking}), 3u) << "both sides at once: how they are compared, what they do";
  EXPECT_EQ(tokens({marking, State{}, marking}), 3u);
  EXPECT_EQ(tokens({two_sided}), 4u) << "the two compare with other values, and do the same";
  EXPECT_EQ(tokens({with_stencil({})}), 1u) << "a test that passes all and changes nothing is none";
}

TEST(StencilHardware, AClearOfOneOfThemIsFastWhereTheOtherIsKnown) {
  const Config config = with("embedded", {{"stencil.bits", "8"}});
  const auto clears = [&](Scene scene, const Clear& clear) {
    scene.commands.push_back(clear);
    const Rendering scalar = render_scalar(scene, config), hardware = render_hardware(scene, config);
    EXPECT_EQ(scalar.frame.stencil, hardware.frame.stencil);
    EXPECT_EQ(scalar.frame.depth, hardware.frame.depth);
    EXPECT_EQ(scalar.frame.color, hardware.frame.color);
    const auto all = sent(scene, config);
    return std::pair{count(all, PrimitiveKind::fast_clear), count(all, PrimitiveKind::rectangle)};
  };
  const Clear depth{0, {}, 0.5, {}}, stencil{0, {}, {}, std::uint8_t{3}}, both{0, {}, 0.5, std::uint8_t{3}},
      colors{0, std::array<double, 4>{1, 2, 3, 255}, {}, {}};
  const std::pair fast{std::size_t{2}, std::size_t{0}}, drawn{std::size_t{1}, std::size_t{1}};
  const Scene plain = squares({State{}});
  EXPECT_EQ(clears(plain, depth), fast) << "no draw has touched the stencil";
  EXPECT_EQ(clears(plain, stencil), drawn);
  EXPECT_EQ(clears(plain, both), fast);
  EXPECT_EQ(clears(plain, colors), fast);
  State marking = with_stencil(replacing_stencil(1));
  const Scene marked = squares({marking});
  EXPECT_EQ(clears(marked, depth), drawn);
  EXPECT_EQ(clears(marked, both), fast);
  marking.depth_write = false;
  EXPECT_EQ(clears(squares({marking}), stencil), fast) << "no draw has touched the depth";
  EXPECT_EQ(clears(squares({}), depth), fast);
}

TEST(StencilHardware, NothingIsLeftOutWhereWhatFailsIsMarked) {
  const Config config = with("embedded", {{"stencil.bits", "8"}});
  Stencil counting;
  counting.depth_fails = StencilOp::incr;
  Stencil looking;
  looking.func = DepthFunc::equal;
  looking.reference = 7;
  State passing;
  passing.depth_test = DepthFunc::always;
  const auto rejected = [&](const Stencil& stencil) {
    const Scene scene = squares({passing, passing, with_stencil(stencil)}, 64, 64);
    Scene hidden = scene;
    for (std::size_t i = 8; i < 12; ++i) hidden.vertices[i].z = 1.0;  // behind
    const Rendering scalar = render_scalar(hidden, config), hardware = render_hardware(hidden, config);
    EXPECT_EQ(scalar.frame.stencil, hardware.frame.stencil);
    return hardware.counters.skipped.tiles_hiz;
  };
  EXPECT_GT(rejected(looking), 0u);
  EXPECT_EQ(rejected(counting), 0u);
  Stencil masked = counting;
  masked.write_mask = 0;
  EXPECT_GT(rejected(masked), 0u);
}

TEST(StencilHardware, DepthThatIsOverwrittenIsReadOnlyForTheSakeOfTheStencil) {
  State over;
  over.depth_test = DepthFunc::always;
  const auto cleared = [&](const char* bits) {
    const Scene scene = squares({over, over});
    const Config config = with("embedded", {{"stencil.bits", bits}});
    PacketSink sink;
    HardwareModel hardware(config, sink);
    HostStream host(scene, config);
    while (const auto next = host.next()) hardware.run(next->packet, next->line);
    return hardware.counters().tile_clears;
  };
  EXPECT_EQ(cleared("0"), 4u) << "the stamps on the diagonal, which no triangle covers";
  EXPECT_EQ(cleared("8"), 16u);
}

// A draw that replaces the whole stored word does not read it.
TEST(StencilHardware, AWordThatIsReplacedAsAWholeGoesUnread) {
  State over;
  over.depth_test = DepthFunc::always;
  const Config config = with("embedded", {{"stencil.bits", "8"}});
  // Tile clears for a square on a cleared target: all tiles that it touches, or only the tiles shared by its two
  // triangles.
  const auto asked = [&](const State& state) {
    const Scene scene = squares({state});
    const Rendering scalar = render_scalar(scene, config), drawn = render_hardware(scene, config);
    EXPECT_EQ(scalar.frame.stencil, drawn.frame.stencil);
    EXPECT_EQ(scalar.frame.depth, drawn.frame.depth);
    PacketSink sink;
    HardwareModel hardware(config, sink);
    HostStream host(scene, config);
    while (const auto next = host.next()) hardware.run(next->packet, next->line);
    return hardware.counters().tile_clears;
  };
  Stencil replacing;
  replacing.reference = 3;
  replacing.passes = StencilOp::replace;
  const auto drawn = [&](const Stencil& front, const std::optional<Stencil>& back = {}) {
    State state = over;
    state.stencil = front;
    state.stencil_back = back;
    return state;
  };
  EXPECT_EQ(asked(over), 16u) << "what is above a depth stays";
  EXPECT_EQ(asked(drawn(replacing)), 4u) << "the stamps on the diagonal, which no triangle covers";
  Stencil zero = replacing;
  zero.passes = StencilOp::zero;
  EXPECT_EQ(asked(drawn(zero)), 4u);
  Stencil in_part = replacing;
  in_part.write_mask = 127;
  EXPECT_EQ(asked(drawn(in_part)), 16u);
  Stencil looking = replacing;
  looking.func = DepthFunc::equal;
  EXPECT_EQ(asked(drawn(looking)), 16u);
  Stencil counting = replacing;
  counting.passes = StencilOp::incr;
  EXPECT_EQ(asked(drawn(counting)), 16u);
  EXPECT_NE(asked(drawn(replacing, counting)), asked(drawn(counting, replacing))) << "the square shows one side";
  State depthless = drawn(replacing);
  depthless.depth_write = false;
  EXPECT_EQ(asked(depthless), 16u);
}

TEST(StencilHardware, WithoutOneItIsRefusedByName) {
  const Scene scene = squares({with_stencil(replacing_stencil(1))});
  for (const Config& config : {preset("embedded"), preset("tiny")}) try {
      check_hardware_scene(scene, config);
      ADD_FAILURE() << label(config);
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("state stencil"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("stencil.bits=8"), std::string::npos) << error.what();
    }
  for (const auto& [key, value] : {std::pair{"cache.kind", "tiles"}, {"setup.kind", "serial"}, {"depth.bits", "25"}}) {
    Config config = preset("embedded");
    set(config, "stencil.bits", "8");
    EXPECT_NO_THROW(validate(config));
    set(config, key, value);
    if (std::string_view(key) == "cache.kind") set(config, "cache.lines", "16");
    EXPECT_THROW(validate(config), InputError) << key;
  }
  Config config = preset("embedded");
  config.stencil_bits = 4;
  EXPECT_THROW(validate(config), InputError);
}

}  // namespace
}  // namespace halfplane::stencil_hardware_test
