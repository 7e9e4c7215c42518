// The RTL against the model, packet by packet: random scenes in every configuration that was Verilated, with and without
// stalls, and every seeded fault caught by the same run.
#include <gtest/gtest.h>

#include <algorithm>

#include "sim/cosim/dut.hpp"
#include "sim/cosim/session.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/load.hpp"

namespace halfplane {
namespace {

Session run(const DutFactory& factory, const LockstepOptions& options, const SceneSource& scenes) {
  const auto dut = make_dut(factory);
  return run_session(*dut, factory.config, options, scenes);
}

std::string describe(const Session& session) {
  const auto& mismatch = session.result.mismatch;
  if (!mismatch) return "";
  std::string text = mismatch->stage + ", arrow " + mismatch->arrow + ", cycle " + std::to_string(mismatch->cycle);
  for (const std::string& field : mismatch->differing()) text += " " + field;
  return text;
}

/// Small targets and slow setup cost more cycles a triangle.
std::uint64_t triangles_for(const DutFactory& factory) {
  return factory.config.stamp_size == 1 ? 2000 : factory.config.stamp_size == 4 ? 1500 : 6000;
}

bool has_lines(const Scene& scene) {
  return std::any_of(scene.commands.begin(), scene.commands.end(), [&](const Command& command) {
    const auto* draw = std::get_if<Draw>(&command);
    return draw != nullptr && drawn_as(scene.states[draw->state], draw->topology) == PrimitiveType::line;
  });
}

TEST(Cosim, ThisBuildHasRtl) { ASSERT_GE(verilated_duts().size(), 3u); }

TEST(Cosim, EveryPacketOfRandomScenesIsEqualWithAndWithoutStalls) {
  for (const DutFactory& factory : verilated_duts()) {
    for (const double stalls : {0.0, 0.2, 0.6}) {
      LockstepOptions options;
      options.seed = 30;
      options.stall_probability = stalls;
      SCOPED_TRACE(factory.name + ", seed 30, stalls " + std::to_string(stalls));
      const Session session =
          run(factory, options, random_scenes(factory.config, options.seed, triangles_for(factory)));
      EXPECT_EQ(describe(session), "");
      EXPECT_GT(session.result.total(), 10000u);
    }
  }
}

TEST(Cosim, TheTeapotIsEqualInEveryPacket) {
  const DutFactory& factory = find_dut(preset("embedded"));
  std::vector<std::string> warnings;
  const Session session = run(factory, {}, single_scene(load_scene({"teapot:8", 320, 240, "", 1}, warnings)));
  EXPECT_EQ(describe(session), "");
  EXPECT_GT(session.result.total(), 10000u);
}

TEST(Cosim, EveryBuiltInSceneIsEqualInEveryPacket) {
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
    }
  }
}

// Must fail: each mutant differs from the design by one expression.
TEST(Cosim, EveryMutantIsCaughtByTheRandomRun) {
  const DutFactory& factory = find_dut(preset("embedded"));
  ASSERT_TRUE(factory.has_mutants);
  EXPECT_GE(mutants().size(), 55u);
  const auto dut = make_dut(factory);
  for (const Mutant& mutant : mutants()) {
    LockstepOptions options;
    options.seed = 1;
    options.stall_probability = 0.2;
    options.mutant = static_cast<std::uint16_t>(mutant.id);
    const Session session =
        run_session(*dut, factory.config, options, random_scenes(factory.config, options.seed, 6000));
    EXPECT_TRUE(session.result.mismatch.has_value())
        << "mutant " << mutant.id << " of " << mutant.file << " is not caught: " << mutant.what;
  }
}

}  // namespace
}  // namespace halfplane
