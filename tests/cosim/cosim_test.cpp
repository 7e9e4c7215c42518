// The RTL against the model, packet by packet and cycle by cycle: random scenes in every configuration that was
// Verilated, with and without stalls, and every seeded fault caught by the same run.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <map>

#include "../state_pairs.hpp"
#include "../tier.hpp"
#include "halfplane_paths.hpp"
#include "model/host/primitives.hpp"
#include "model/stages/memory_port.hpp"
#include "model/stages/stencil_packets.hpp"
#include "sim/cosim/dut.hpp"
#include "sim/cosim/rtl_engine.hpp"
#include "sim/cosim/session.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/depth_mapping.hpp"
#include "sim/scene/load.hpp"

namespace halfplane::cosim_test {
namespace {

/// Compares cycles as well, and in a random run (drawn orders) the model with the specification.
Session run(const DutFactory& factory, LockstepOptions options, const SceneSource& scenes,
            HostOrders orders = HostOrders::configured) {
  const auto dut = make_dut(factory);
  options.compares_cycles = true;
  Session session = run_session(*dut, factory.config, options, scenes, orders, orders == HostOrders::drawn);
  std::printf("%s: %llu cycles, %llu crossings, %s\n", factory.name.c_str(),
              static_cast<unsigned long long>(session.result.cycles),
              static_cast<unsigned long long>(session.result.total_cycles_compared()),
              session.result.mismatch ? "a difference" : "0 cycles of difference");
  return session;
}

std::string describe(const Session& session) {
  const auto& mismatch = session.result.mismatch;
  if (!mismatch) return session.disagreement;
  std::string text = mismatch->stage + ", arrow " + mismatch->arrow + ", cycle " + std::to_string(mismatch->cycle);
  for (const std::string& field : mismatch->differing()) text += " " + field;
  return text;
}

/// Small targets and slow setup cost more cycles a triangle.
std::uint64_t triangles_for(const DutFactory& factory) {
  const std::uint64_t all = factory.config.stamp_size == 1 ? 2000 : factory.config.stamp_size == 4 ? 1500 : 6000;
  return test::cases(all / 16, all);
}

bool has_lines(const Scene& scene) {
  return std::any_of(scene.commands.begin(), scene.commands.end(), [&](const Command& command) {
    const auto* draw = std::get_if<Draw>(&command);
    return draw != nullptr && drawn_as(scene.states[draw->state], draw->topology) == PrimitiveType::line;
  });
}

// The share of random scenes in `./dev test --quick`.
TEST(CosimOfEmbedded, ThousandRandomPrimitivesAreEqualInEveryPacketAndCycle) {
  LockstepOptions options;
  options.seed = 29;
  options.stall_probability = 0.3;
  const DutFactory& factory = find_dut(preset("embedded"));
  const Session session = run(factory, options, random_scenes(factory.config, 29, 1000), HostOrders::drawn);
  EXPECT_EQ(describe(session), "");
  EXPECT_GT(session.result.total_cycles_compared(), 5000u);
}

TEST(Cosim, ThisBuildHasRtl) { ASSERT_GE(verilated_duts().size(), 3u); }

TEST(Cosim, EveryPacketOfRandomScenesIsEqualWithAndWithoutStalls) {
  for (const DutFactory& factory : verilated_duts()) {
    for (const double stalls : {0.0, 0.2, 0.6}) {
      if (stalls == 0.2 && !test::runs_all()) continue;
      LockstepOptions options;
      options.seed = 30;
      options.stall_probability = stalls;
      SCOPED_TRACE(factory.name + ", seed 30, stalls " + std::to_string(stalls));
      const Session session =
          run(factory, options, random_scenes(factory.config, options.seed, triangles_for(factory)), HostOrders::drawn);
      EXPECT_EQ(describe(session), "");
      EXPECT_GT(session.result.total(), test::cases(600u, 10000u));
      EXPECT_GT(session.result.total_cycles_compared(), test::cases(600u, 10000u));
      EXPECT_EQ(session.result.model_cycles, session.result.cycles);
      EXPECT_EQ(session.result.model_raster_cycles, session.result.raster_cycles);
      EXPECT_EQ(session.result.model_tile_cycles, session.result.tile_cycles);
    }
  }
}

// A texture unit's requests and results are compared too, if the design has one.
TEST(Cosim, TexturesAreLookedUpInRandomScenes) {
  std::size_t units = 0;
  for (const DutFactory& factory : verilated_duts()) {
    if (!has_texture_planes(factory.config)) continue;
    ++units;
    const std::uint64_t count = factory.config.target_width < 100 ? 12'000 : 3000;  // of few stamps each
    const Session session = run(factory, {}, random_scenes(factory.config, 31, test::cases(count / 8, count)));
    EXPECT_EQ(describe(session), "");
    EXPECT_GT(session.result.compared[index(Arrow::texture)],
              test::cases(15u, 150u));  // fewer where a stencil test is in front
    EXPECT_GT(session.result.compared[index(Arrow::color)], test::cases(1250u, 10000u));
  }
  EXPECT_GT(units, 0u);
}

// Colours are read and blended, depth is written late, and alpha drops samples.
TEST(Cosim, ColoursAreBlendedInRandomScenes) {
  std::size_t units = 0;
  for (const DutFactory& factory : verilated_duts()) {
    if (!packs_at_write(factory.config) && !tests_alpha(factory.config)) continue;
    ++units;
    for (const double stalls : {0.0, 0.4}) {
      LockstepOptions options;
      options.seed = 32;
      options.stall_probability = stalls;
      const Session session =
          run(factory, options, random_scenes(factory.config, 32, test::cases(200, 3000)), HostOrders::drawn);
      EXPECT_EQ(describe(session), "") << factory.name;
      if (factory.config.frame_store == FrameStore::color) continue;  // bins, which read nothing
      EXPECT_GT(session.result.compared[index(Arrow::response)], test::cases(30u, 500u));
    }
  }
  EXPECT_GT(units, 0u);
}

// The stencil shares the depth's word, marks failing fragments, and waits for a late alpha test.
TEST(Cosim, StencilsAreDrawnInRandomScenes) {
  std::size_t units = 0;
  for (const DutFactory& factory : verilated_duts()) {
    if (!has_stencil(factory.config)) continue;
    ++units;
    for (const double stalls : {0.0, 0.4}) {
      LockstepOptions options;
      options.seed = 33;
      options.stall_probability = stalls;
      const Session session =
          run(factory, options, random_scenes(factory.config, 33, test::cases(200, 3000)), HostOrders::drawn);
      EXPECT_EQ(describe(session), "") << factory.name;
      EXPECT_GT(session.result.compared[index(Arrow::write)], test::cases(6'000u, 100'000u));
    }
  }
  EXPECT_GT(units, 0u);
}

// Fragment operations together with textures: each pair of values of two states (tests/state_pairs.hpp lists them).
TEST(Cosim, EveryPairOfValuesOfTwoStatesIsEqualInEveryPacket) {
  const Config config = preset("stencilled");
  const auto scenes = test::paired_scenes(config, test::dimensions(), 1);
  for (const double stalls : {0.3, 0.0}) {
    if (stalls == 0 && !test::runs_all()) continue;
    LockstepOptions options;
    options.seed = 34;
    options.stall_probability = stalls;
    std::size_t next = 0;
    const Session session = run(
        find_dut(config), options,
        [&]() -> std::optional<Scene> { return next < scenes.size() ? std::optional(scenes[next++]) : std::nullopt; },
        HostOrders::drawn);
    EXPECT_EQ(describe(session), "");
    EXPECT_EQ(session.result.model_cycles, session.result.cycles);
    EXPECT_EQ(next, scenes.size());
    EXPECT_GT(session.result.compared[index(Arrow::color)], 50'000u);
  }
}

// Every day each design with one or two of the memories.
TEST(Cosim, EveryMemoryKeepsRtlAndCycleModelTogether) {
  std::size_t number = 0;
  for (const DutFactory& factory : verilated_duts())
    for (const MemoryKind kind :
         {MemoryKind::fixed, MemoryKind::sram, MemoryKind::sdram, MemoryKind::psram, MemoryKind::ddr3}) {
      if (number++ % 4 != 0 && !test::runs_all()) continue;
      LockstepOptions options;
      options.memory.kind = kind;
      options.memory.latency = 40;
      options.stall_probability = 0.1;
      SCOPED_TRACE(factory.name + ", " + std::string(kMemoryKinds[static_cast<std::size_t>(kind)]));
      const Session session = run(factory, options, random_scenes(factory.config, 8, 250));
      EXPECT_EQ(describe(session), "");
      if (factory.config.resolve_units == 0) {  // else nothing is read
        EXPECT_GT(session.result.cycles_compared[index(Arrow::response)], 1000u);
      } else {
        EXPECT_GT(session.result.cycles_compared[index(Arrow::beat)], 100u);
      }
    }
}

// Scan-out, other masters and another SDRAM take the same time from the RTL's memory and from the model's.
TEST(Cosim, OtherMastersAtTheMemoryKeepRtlAndCycleModelTogether) {
  std::size_t number = 0;
  for (const DutFactory& factory : verilated_duts()) {
    for (const char* const memory : {"sdram,width=32,mhz=133", "fixed", "ddr3"}) {
      if (number++ % 4 != 0 && !test::runs_all()) continue;
      LockstepOptions options;
      set_memory(options.memory, memory);
      options.memory.traffic = {120, 20'000'000};
      SCOPED_TRACE(factory.name + ", " + memory);
      const Session session = run(factory, options, random_scenes(factory.config, 9, 250));
      EXPECT_EQ(describe(session), "");
      EXPECT_EQ(session.result.model_cycles, session.result.cycles);
      EXPECT_GT(session.result.cycles_compared[index(Arrow::beat)], 100u);
    }
  }
}

/// Clears inside a scissor, then whole ones, and a triangle that is culled: the writes come before it in program
/// order and around it in time.
Scene clears_before_a_culled_triangle(int scissored, int whole) {
  Scene scene;
  scene.name = "clears";
  scene.width = scene.height = 16;
  State state;
  state.space = Space::window;
  state.cull = Cull::both;
  scene.states.push_back(state);
  state.scissor = Rect{3, 3, 1, 1};
  scene.states.push_back(state);
  for (int i = 0; i < scissored; ++i) scene.commands.push_back(Clear{1, std::array<double, 4>{9, 9, 9, 255}, 0.5});
  for (int i = 0; i < whole; ++i) scene.commands.push_back(Clear{0, std::array<double, 4>{1, 2, 3, 255}, 1.0});
  for (const auto& [x, y] : {std::pair{1.0, 1.0}, {9.0, 1.0}, {1.0, 9.0}}) {
    Vertex v;
    v.x = x;
    v.y = y;
    scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
    scene.vertices.push_back(v);
  }
  scene.commands.push_back(Draw{0, 0, Topology::triangles, 0, scene.indices.size(), 0});
  return scene;
}

TEST(Cosim, ClearsAroundTheFirstTriangleCountAsInTheRtl) {
  for (const DutFactory& factory : verilated_duts())
    for (const auto& [scissored, whole] : {std::pair{2, 0}, {1, 1}, {1, 7}, {3, 2}, {0, 2}}) {
      if (factory.config.resolve_units != 0 && scissored != 0) continue;  // bins that begin twice are refused
      SCOPED_TRACE(factory.name + ", " + std::to_string(scissored) + " and " + std::to_string(whole));
      const Session session = run(factory, {}, single_scene(clears_before_a_culled_triangle(scissored, whole)));
      EXPECT_EQ(describe(session), "");
      EXPECT_EQ(session.result.model_raster_cycles, session.result.raster_cycles);
      EXPECT_EQ(session.result.model_tile_cycles, session.result.tile_cycles);
    }
}

// Work in flight at a reset is lost, and the packets after it have the bits and cycles of a fresh start.
TEST(Cosim, AResetInTheMiddleOfAnythingLeavesNothingBehind) {
  for (const DutFactory& factory : verilated_duts())
    for (const double stalls : {0.0, 0.4}) {
      SCOPED_TRACE(factory.name + ", stalls " + std::to_string(stalls));
      LockstepOptions options;
      options.seed = 11;
      options.stall_probability = stalls;
      options.resets = test::cases(6, 40);
      options.memory.latency = 30;
      const Session session = run(factory, options, random_scenes(factory.config, 5, test::cases(60, 300)));
      EXPECT_EQ(describe(session), "");
      EXPECT_GT(session.result.cycles_compared[index(Arrow::beat)], test::cases(10u, 100u));
    }
}

// Registers start with any value, that of the reset among them: a reset that begins low has no edge, and clock gates must be
// open in it.
TEST(Cosim, EveryDesignStartsFromAnyState) {
  for (const DutFactory& factory : verilated_duts())
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      LockstepOptions options;
      options.seed = seed;
      EXPECT_EQ(describe(run(factory, options, random_scenes(factory.config, seed, 4))), "")
          << factory.name << ' ' << seed;
    }
}

TEST(Cosim, PlanesMayLieElsewhereInMemory) {
  for (const DutFactory& factory : verilated_duts()) {
    const Widths widths = derive_widths(factory.config);
    LockstepOptions options;
    options.layout = default_layout(widths);
    const std::uint32_t by = 5U << std::max(widths.memory.tile(), widths.memory.flag_row);
    options.layout->row_stride += 1U << widths.memory.tile();
    options.layout->depth_base += by;
    options.layout->color_base += by;
    options.layout->depth_flags_base += 1U << 27;
    options.layout->color_flags_base += 1U << 27;
    const Session session = run(factory, options, random_scenes(factory.config, 6, test::cases(100, 300)));
    EXPECT_EQ(describe(session), "") << factory.name;
  }
}

TEST(Cosim, TheTeapotIsEqualInEveryPacket) {
  const DutFactory& factory = find_dut(preset("embedded"));
  std::vector<std::string> warnings;
  const Session session = run(factory, {}, single_scene(load_scene({"teapot:8", 320, 240, "", 1}, warnings)));
  EXPECT_EQ(describe(session), "");
  EXPECT_GT(session.result.total(), 10000u);
}

// A reversed mapping is the host's: the RTL sees other depths, the other comparison and another clear value.
TEST(Cosim, ReversedDepthIsEqualInEveryPacketOnTheSameRtl) {
  Config config = preset("embedded");
  for (const DepthMapping mapping : {DepthMapping::rev, DepthMapping::revinf}) {
    config.depth_mapping = mapping;
    std::vector<std::string> warnings;
    const Scene scene = in_depth_mapping(load_scene({"teapot:5", 160, 120, "", 1}, warnings), mapping);
    const Session session = run(find_dut(config), {}, single_scene(scene));
    EXPECT_EQ(describe(session), "");
    EXPECT_GT(session.result.total(), 5000u);
  }
}

/// The committed cycles of a scene: lines of "configuration; scene; cycles; raster cycles; tile cycles".
std::map<std::string, std::string> cycle_baseline() {
  std::map<std::string, std::string> lines;
  std::ifstream file(HALFPLANE_TEST_DATA "/rtl_cycles.txt");
  for (std::string line; std::getline(file, line);) {
    const auto scene_ends = line.find(';', line.find(';') + 1);
    if (line.starts_with('#') || scene_ends == std::string::npos) continue;
    lines[line.substr(0, scene_ends)] = line;
  }
  return lines;
}

// Faster fails as well: a change of cycles must be committed, with the line that this prints.
TEST(Cosim, EveryBuiltInSceneIsEqualInEveryPacketAndTakesTheCyclesOfTheBaseline) {
  const auto baseline = cycle_baseline();
  for (const DutFactory& factory : verilated_duts()) {
    // A scene that fits the smallest target, and light enough for the serial setup.
    const int width = std::min(96, factory.config.target_width), height = std::min(64, factory.config.target_height);
    for (const Builtin& builtin : builtin_scenes()) {
      std::string name(builtin.name);
      if (builtin.default_size != 0) name += ":" + std::to_string(std::max(3, builtin.min_size));
      SCOPED_TRACE(factory.name + ", " + name);
      std::vector<std::string> warnings;
      Scene scene = load_scene({name, width, height, "", 1}, warnings);
      if (factory.config.line_units == 0 && has_lines(scene)) {
        EXPECT_THROW(check_hardware_scene(scene, factory.config), InputError);
        continue;
      }
      const Session session = run(factory, {}, single_scene(std::move(scene)));
      EXPECT_EQ(describe(session), "");
      EXPECT_GT(session.result.total(), 10u);
      const std::string key = factory.name + "; " + name + " " + std::to_string(width) + "x" + std::to_string(height);
      const LockstepResult& r = session.result;
      const std::string line = key + "; " + std::to_string(r.cycles) + "; " + std::to_string(r.raster_cycles) + "; " +
                               std::to_string(r.tile_cycles);
      const auto expected = baseline.find(key);
      EXPECT_EQ(line, expected == baseline.end() ? "no line in tests/data/rtl_cycles.txt" : expected->second);
    }
  }
}

TEST(Cosim, TheStageTableOfTheCycleEngineIsThatOfTheRtl) {
  for (const DutFactory& factory : verilated_duts())
    for (const char* name : {"city:4", "wireframe:3"}) {
      const int width = std::min(96, factory.config.target_width), height = std::min(64, factory.config.target_height);
      const Scene scene = make_builtin(name, width, height, {}, 1);
      if (factory.config.line_units == 0 && has_lines(scene)) continue;
      SCOPED_TRACE(factory.name + ", " + name);
      const RtlRendering rtl = render_rtl(*make_dut(factory), scene, factory.config, {});
      const auto memory = make_memory({}, factory.config);
      const CycleRun cycle = render_cycle(scene, factory.config, *memory).run;
      EXPECT_EQ(cycle.cycles, rtl.run.cycles);
      EXPECT_EQ(cycle.raster_cycles, rtl.run.raster_cycles);
      EXPECT_EQ(cycle.tile_cycles, rtl.run.tile_cycles);
      for (std::size_t i = 0; i < kStreams.size(); ++i) {
        const StreamUse& use = cycle.use[index(kStreams[i])];
        EXPECT_EQ(use.busy, rtl.run.use[i].busy) << sender_name(kStreams[i]);
        EXPECT_EQ(use.stalled, rtl.run.use[i].stalled) << sender_name(kStreams[i]);
        EXPECT_EQ(use.starved + rtl.run.clocks - rtl.run.cycles, rtl.run.use[i].starved) << sender_name(kStreams[i]);
      }
    }
}

/// Runs embedded's RTL against a cycle model that is wrong in one thing.
Session run_wrong(const Config& config, const TimingParameters& parameters, int latency) {
  LockstepOptions options;
  options.seed = 4;
  options.stall_probability = 0.1;
  options.parameters = parameters;
  options.model_memory = MemorySettings{};
  options.model_memory->latency += latency;
  return run(find_dut(config), options, random_scenes(config, 4, 1500));
}

// Must fail: a queue one deeper, a latency one longer, a rule another.
TEST(Cosim, ACycleModelThatIsWrongInOneThingIsCaught) {
  for (const char* name : {"embedded", "small"}) {
    const Config config = preset(name);
    EXPECT_EQ(describe(run_wrong(config, {}, 0)), "");
    for (const int latency : {1, -1}) {
      const Session session = run_wrong(config, {}, latency);
      ASSERT_TRUE(session.result.mismatch.has_value()) << name << ", memory latency";
      EXPECT_EQ(session.result.mismatch->kind, Mismatch::Kind::cycle);
    }
    for (const TimingSetting& setting : timing_settings()) {
      if (setting.is_pipelined_only && config.setup_kind == SetupKind::serial) continue;
      TimingParameters parameters;
      int& value = parameters.*setting.member;
      value +=
          value == setting.max || setting.key == "divide.bits" ? -1 : 1;  // a divider of 4 bits waits for the planes
      const Session session = run_wrong(config, parameters, 0);
      ASSERT_TRUE(session.result.mismatch.has_value()) << name << ", " << setting.key;
      EXPECT_EQ(session.result.mismatch->kind, Mismatch::Kind::cycle);
    }
  }
}

}  // namespace
}  // namespace halfplane::cosim_test
