// Pairs of values of two draw states: the random scenes of the co-simulation, with all units of fragment operations, draw each
// of them; and so do a few scenes that are made for it, which every engine draws equally (and the RTL: tests/cosim).
#include <gtest/gtest.h>

#include <iostream>
#include <vector>

#include "../state_pairs.hpp"
#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "sim/cosim/random_scene.hpp"

namespace halfplane::state_pairs_test {
namespace {

using test::Dimension;
using test::dimensions;
using test::PairCounts;

/// Each pair that is possible has been seen. Returns how many there are.
std::size_t expect_all(const std::vector<Dimension>& all, const PairCounts& counts) {
  std::size_t pairs = 0;
  counts.for_each([&](std::size_t a, int va, std::size_t b, int vb, std::size_t times) {
    EXPECT_GT(times, 0U) << all[a].name << " " << va << " with " << all[b].name << " " << vb;
    ++pairs;
  });
  return pairs;
}

TEST(StatePairs, RandomScenesDrawEveryPairOfValues) {
  const Config config = preset("stencilled");
  const std::vector<Dimension> all = dimensions();
  PairCounts counts(all);
  constexpr std::uint64_t kFirstSeed = 33,
                          kScenes = 1600;  // of 200 primitives: a third of the scenes of `./dev soak-cosim`
  std::size_t draws = 0;
  for (std::uint64_t seed = kFirstSeed; seed < kFirstSeed + kScenes; ++seed) {
    const Scene scene = random_scene(config, seed, 200);
    for (const Command& command : scene.commands)
      if (const Draw* draw = std::get_if<Draw>(&command)) {
        ++draws;
        counts.add(scene.states[draw->state]);
      }
  }
  std::cout << expect_all(all, counts) << " pairs of values of " << all.size() << " states, in " << draws
            << " draws of seeds " << kFirstSeed << " to " << kFirstSeed + kScenes - 1 << '\n';
}

TEST(StatePairs, AFewScenesDrawEveryPairAndAllEnginesDrawThemAlike) {
  const Config config = preset("stencilled");
  const std::vector<Dimension> all = dimensions();
  PairCounts counts(all);
  std::size_t draws = 0;
  std::uint64_t written = 0;
  const auto scenes = test::paired_scenes(config, all, 1);
  for (const Scene& scene : scenes) {
    for (const Command& command : scene.commands)
      if (const Draw* draw = std::get_if<Draw>(&command)) {
        ++draws;
        counts.add(scene.states[draw->state]);
      }
    const auto memory = make_memory({}, config);
    const Rendering scalar = render_scalar(scene, config), hardware = render_hardware(scene, config),
                    functional = render_functional(scene, config),
                    cycle = render_cycle(scene, config, *memory).rendering;
    for (const Rendering* other : {&hardware, &functional, &cycle}) {
      EXPECT_EQ(scalar.frame.color, other->frame.color) << scene.name;
      EXPECT_EQ(scalar.frame.depth, other->frame.depth) << scene.name;
      EXPECT_EQ(scalar.frame.stencil, other->frame.stencil) << scene.name;
      EXPECT_EQ(scalar.counters.depth_passed, other->counters.depth_passed) << scene.name;
      EXPECT_EQ(scalar.counters.alpha_killed, other->counters.alpha_killed) << scene.name;
      EXPECT_EQ(scalar.counters.written, other->counters.written) << scene.name;
    }
    written += scalar.counters.written;
  }
  EXPECT_LT(draws, 1500u);
  EXPECT_GT(written, 50'000u);
  std::cout << expect_all(all, counts) << " pairs of values of " << all.size() << " states, in " << draws
            << " draws of " << scenes.size() << " scenes\n";
}

}  // namespace
}  // namespace halfplane::state_pairs_test
