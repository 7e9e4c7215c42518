// Blending, masks, dithering and the alpha test in hardware: the hardware and the cycle engine against the scalar one,
// the tokens that set them, the memory reads for them, and the refusals without the unit.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "../hardware_scene.hpp"
#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/stages/color_packets.hpp"
#include "sim/cosim/random_scene.hpp"

namespace halfplane::color_hardware_test {
namespace {

using test::with;

const std::vector<Config>& configurations() {
  static const std::vector<Config> all{
      with("embedded", {{"blend.lanes", "4"}}),
      with("embedded", {{"blend.lanes", "4"}, {"dither.unit", "1"}, {"alpha.unit", "1"}, {"cache.lines", "4"}}),
      with("embedded", {{"blend.lanes", "1"}, {"alpha.unit", "1"}, {"frame.order", "bins"}, {"cache.lines", "16"}}),
      with("embedded", {{"dither.unit", "1"}}),
      with("embedded", {{"texture.unit", "nearest"}, {"alpha.unit", "1"}, {"blend.lanes", "4"}, {"dither.unit", "1"}}),
      with("full", {{"blend.lanes", "1"}, {"alpha.unit", "1"}, {"texture.unit", "bilinear"}}),
      with("embedded", {{"blend.lanes", "4"}, {"logic.unit", "1"}, {"dither.unit", "1"}, {"cache.lines", "4"}}),
      with("full", {{"blend.lanes", "1"}, {"logic.unit", "1"}, {"alpha.unit", "1"}}),
      with("embedded", {{"blend.lanes", "1"}, {"logic.unit", "1"}, {"msaa.samples", "4"}, {"compress.unit", "1"}}),
      with("tiny", {{"cache.kind", "blocks"}, {"blend.lanes", "4"}, {"dither.unit", "1"}, {"alpha.unit", "1"}})};
  return all;
}

TEST(ColorHardware, DrawsRandomScenesAsTheScalarEngine) {
  std::uint64_t killed = 0;
  for (const Config& config : configurations())
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Scene scene = random_scene(config, seed, 40);
      const Rendering scalar = render_scalar(scene, config), hardware = render_hardware(scene, config);
      EXPECT_EQ(scalar.frame.color, hardware.frame.color) << scene.name << ", " << label(config);
      if (config.frame_order == FrameOrder::program) {
        EXPECT_EQ(scalar.frame.depth, hardware.frame.depth) << scene.name << ", " << label(config);
      }
      const auto memory = make_memory({}, config);
      const Rendering cycle = render_cycle(scene, config, *memory).rendering;
      EXPECT_EQ(scalar.frame.color, cycle.frame.color) << scene.name << ", " << label(config);
      for (const Rendering* other : {&hardware, &cycle}) {
        EXPECT_EQ(scalar.counters.depth_passed, other->counters.depth_passed) << scene.name << ", " << label(config);
        EXPECT_EQ(scalar.counters.alpha_killed, other->counters.alpha_killed) << scene.name << ", " << label(config);
        EXPECT_EQ(scalar.counters.written, other->counters.written) << scene.name << ", " << label(config);
      }
      killed += scalar.counters.alpha_killed;
    }
  EXPECT_GT(killed, 1000u);
}

TEST(ColorHardware, OperationsComeOutOfTheirTokensAsTheyWentIn) {
  std::mt19937_64 random(5);
  const auto below = [&random](unsigned n) { return static_cast<unsigned>(random() % n); };
  for (int n = 0; n < 2000; ++n) {
    ColorState wanted, state;
    wanted.ops.factors = {static_cast<BlendFactor>(below(15)), static_cast<BlendFactor>(below(15)),
                          static_cast<BlendFactor>(below(15)), static_cast<BlendFactor>(below(15))};
    for (BlendEquation& equation : wanted.ops.equation) equation = static_cast<BlendEquation>(below(5));
    for (bool& writes : wanted.ops.writes) writes = below(2) != 0;
    for (std::uint8_t& channel : wanted.ops.constant) channel = static_cast<std::uint8_t>(below(256));
    wanted.ops.dithers = below(2) != 0;
    if (n % 4 == 0) {
      wanted.ops.logic = static_cast<LogicOp>(below(16));
      wanted.ops.factors = {};
      wanted.ops.equation = {};
    }
    wanted.alpha = {static_cast<DepthFunc>(below(8)), static_cast<std::uint8_t>(below(256))};
    state.set(StateRegister::color_ops, pack(wanted.ops));
    state.set(StateRegister::blend_constant, pack(wanted.ops.constant));
    state.set(StateRegister::alpha_test, pack(wanted.alpha));
    EXPECT_EQ(state.ops, wanted.ops);
    EXPECT_EQ(state.alpha, wanted.alpha);
    EXPECT_EQ(pack(wanted.ops) >> 27 & 1, wanted.ops.blends() ? 1u : 0u);
    EXPECT_EQ(pack(wanted.ops) >> 28, wanted.ops.reads_stored() ? 1u : 0u);
  }
}

TEST(ColorHardware, AWordWithoutALogicOperationIsWhatItWasBeforeThereWereAny) {
  EXPECT_EQ(pack(ColorOps{}), 0x03c00101U) << "one, zero, one, zero; four channels";
  ColorOps ops;
  ops.logic = LogicOp::xor_op;
  EXPECT_EQ(pack(ops), 0x13c50106U) << "the operation, the code 5 in the place of the equation; it reads colours";
}

/// A rectangle of 8x8 pixels at the origin, in halves, under a state.
Scene rectangles(const std::vector<State>& states) {
  Scene scene;
  scene.name = "rectangles";
  scene.width = scene.height = 16;
  scene.states.push_back({});
  scene.commands.push_back(Clear{0, std::array<double, 4>{10, 20, 30, 255}, 1.0});
  for (State state : states) {
    state.space = Space::window;
    scene.states.push_back(state);
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {8.0, 0.0}, {8.0, 8.0}, {0.0, 8.0}}) {
      Vertex v;
      v.x = x;
      v.y = y;
      v.z = 0.5;
      v.rgba = {200, 100, 50, 128};
      scene.vertices.push_back(v);
    }
    const std::size_t index = scene.indices.size();
    for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) scene.indices.push_back(first + i);
    scene.commands.push_back(
        Draw{static_cast<std::uint32_t>(scene.states.size() - 1), 0, Topology::triangles, index, 6, 0});
  }
  return scene;
}

State blending() {
  State state;
  state.depth_test = DepthFunc::always;
  state.blend =
      BlendFactors{BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha, BlendFactor::one, BlendFactor::zero};
  return state;
}

/// The registers that the host sets for a scene, in order; `kinds`: the other tokens that it sends.
std::vector<StateRegister> registers_set(const Scene& scene, const Config& config) {
  std::vector<StateRegister> found;
  HostStream host(scene, config);
  while (const auto next = host.next())
    if (next->packet.kind == PrimitiveKind::state) found.push_back(state_register(next->packet.state));
  return found;
}

TEST(ColorHardware, TheHostSetsARegisterWhereItsValueChanges) {
  using R = StateRegister;
  const Config config = with("embedded", {{"blend.lanes", "4"}, {"alpha.unit", "1"}});
  State constant = blending(), tested = blending(), unwritten = blending();
  constant.blend->src = BlendFactor::constant_color;
  constant.blend_color = {1, 2, 3, 4};
  tested.alpha_test = {DepthFunc::greater, 7};
  unwritten.color_write = false;
  unwritten.blend.reset();
  EXPECT_EQ(registers_set(rectangles({blending(), blending()}), config), (std::vector{R::color_ops, R::alpha_test}));
  EXPECT_EQ(registers_set(rectangles({blending(), constant, constant}), config),
            (std::vector{R::color_ops, R::alpha_test, R::color_ops, R::blend_constant}));
  EXPECT_EQ(registers_set(rectangles({blending(), tested, unwritten}), config),
            (std::vector{R::color_ops, R::alpha_test, R::alpha_test, R::alpha_test}))
      << "what writes no colour has no operations on it";
  EXPECT_TRUE(registers_set(rectangles({State{}}), preset("embedded")).empty());
  Scene cleared = rectangles({blending()});
  State scissored;
  scissored.scissor = Rect{0, 0, 4, 4};
  cleared.states.push_back(scissored);
  cleared.commands.push_back(
      Clear{static_cast<std::uint32_t>(cleared.states.size() - 1), std::array<double, 4>{1, 2, 3, 255}, {}});
  EXPECT_EQ(registers_set(cleared, config), (std::vector{R::color_ops, R::alpha_test, R::color_ops}))
      << "a clear's rectangle is drawn without operations";
}

TEST(ColorHardware, ColoursAreFetchedOnceAStampAndOnlyWhereTheyAreRead) {
  struct Reads : PacketSink {
    using PacketSink::take;
    std::array<std::size_t, 2> count{};
    void take(On<Arrow::request>, const MemoryRequest& request) override {
      if (!request.is_write) ++count[request.plane == TilePlane::color ? 1 : 0];
    }
  };
  const Config config = with("embedded", {{"blend.lanes", "4"}});
  const auto reads = [&](const Scene& scene) {
    Reads sink;
    HardwareModel hardware(config, sink);
    HostStream host(scene, config);
    while (const auto next = host.next()) hardware.run(next->packet, next->line);
    return sink.count[1];
  };
  State plain, masked;
  plain.depth_test = DepthFunc::always;
  masked = plain;
  masked.color_mask = {true, false, true, true};
  EXPECT_EQ(reads(rectangles({plain})), 0u);
  EXPECT_EQ(reads(rectangles({blending()})), 0u) << "the clear value";
  Scene stored = rectangles({plain, blending(), masked});
  State depth_only;
  stored.states.push_back(depth_only);  // a clear of depth alone writes the colours back, and forgets them
  stored.commands.insert(stored.commands.begin() + 2,
                         Clear{static_cast<std::uint32_t>(stored.states.size() - 1), {}, 1.0});
  EXPECT_EQ(reads(stored), 16u) << "8x8 pixels are 16 stamps";
}

TEST(ColorHardware, WhatAnAlphaTestMayKillNeedsTheDepthBehindItOnlyWhereItWritesDepth) {
  const Config config = with("embedded", {{"blend.lanes", "4"}, {"alpha.unit", "1"}});
  for (const bool is_tested : {false, true})
    for (const bool writes : {false, true}) {
      State state = blending();
      if (is_tested) state.alpha_test = {DepthFunc::greater, 7};
      state.depth_write = writes;
      const Scene scene = rectangles({state});
      const Rendering scalar = render_scalar(scene, config), hardware = render_hardware(scene, config);
      EXPECT_EQ(scalar.frame.color, hardware.frame.color) << is_tested << writes;
      EXPECT_EQ(scalar.frame.depth, hardware.frame.depth) << is_tested << writes;
    }
}

TEST(ColorHardware, TheConstantIsSetWhereAnyFactorReadsIt) {
  const Config config = with("embedded", {{"blend.lanes", "4"}, {"color.format", "rgba8888"}});
  for (const auto factor :
       {&BlendFactors::src, &BlendFactors::dst, &BlendFactors::src_alpha, &BlendFactors::dst_alpha}) {
    State state = blending();
    (*state.blend).*factor = BlendFactor::constant_alpha;
    state.blend_color = {1, 2, 3, 4};
    EXPECT_EQ(registers_set(rectangles({state}), config),
              (std::vector{StateRegister::color_ops, StateRegister::blend_constant}));
  }
}

TEST(ColorHardware, RefusesByNameWhatItHasNoUnitFor) {
  const auto fault = [](const State& state, const Config& config) -> std::string {
    try {
      check_hardware_scene(rectangles({state}), config);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  State masked, dithered, tested;
  masked.color_mask = {true, false, true, true};
  dithered.dither = true;
  tested.alpha_test = {DepthFunc::less, 9};
  const Config plain = preset("embedded");
  EXPECT_NE(fault(blending(), plain).find("blend.lanes=4"), std::string::npos);
  EXPECT_NE(fault(masked, plain).find("color_mask"), std::string::npos);
  EXPECT_NE(fault(dithered, plain).find("dither.unit=1"), std::string::npos);
  EXPECT_NE(fault(tested, plain).find("alpha.unit=1"), std::string::npos);
  const Config all = with("embedded", {{"blend.lanes", "1"}, {"dither.unit", "1"}, {"alpha.unit", "1"}});
  for (const State& state : {blending(), masked, dithered, tested}) EXPECT_EQ(fault(state, all), "");
  EXPECT_THROW(validate(with("embedded", {{"blend.lanes", "2"}})), InputError);
  EXPECT_THROW(validate(with("tiny", {{"blend.lanes", "1"}})), InputError);
}

}  // namespace
}  // namespace halfplane::color_hardware_test
