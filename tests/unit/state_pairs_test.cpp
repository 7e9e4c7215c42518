// The random scenes of the co-simulation, with all units of fragment operations: every pair of values of two states is drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "model/config.hpp"
#include "sim/cosim/random_scene.hpp"

namespace halfplane {
namespace {

/// A state, as a number from 0 to values - 1; negative where a draw has none of it.
struct Dimension {
  const char* name;
  int values;
  std::function<int(const State&)> value;
  const char* part_of = "";  ///< the state that has it; where that is off there is none of it
};

std::vector<Dimension> dimensions() {
  const auto side = [](auto member) {
    return [member](const State& s) { return s.stencil ? static_cast<int>((*s.stencil).*member) : -1; };
  };
  const auto factor = [](auto member) {
    return [member](const State& s) { return s.blend ? static_cast<int>((*s.blend).*member) : -1; };
  };
  return {
      {"depth_test", 8, [](const State& s) { return static_cast<int>(s.depth_test); }},
      {"depth_write", 2, [](const State& s) { return s.depth_write ? 1 : 0; }},
      {"color_write", 2, [](const State& s) { return s.color_write ? 1 : 0; }},
      {"cull", 4, [](const State& s) { return static_cast<int>(s.cull); }},
      {"alpha_test", 8, [](const State& s) { return static_cast<int>(s.alpha_test.func); }},
      {"stencil", 2, [](const State& s) { return s.stencil ? 1 : 0; }},
      {"stencil_back", 2, [](const State& s) { return s.stencil ? (s.stencil_back ? 1 : 0) : -1; }, "stencil"},
      {"stencil func", 8, side(&Stencil::func), "stencil"},
      {"sfail", 8, side(&Stencil::stencil_fails), "stencil"},
      {"zfail", 8, side(&Stencil::depth_fails), "stencil"},
      {"zpass", 8, side(&Stencil::passes), "stencil"},
      {"blend", 2, [](const State& s) { return s.blend ? 1 : 0; }},
      {"src", 15, factor(&BlendFactors::src), "blend"},
      {"dst", 15, factor(&BlendFactors::dst), "blend"},
      {"src_alpha", 15, factor(&BlendFactors::src_alpha), "blend"},
      {"dst_alpha", 15, factor(&BlendFactors::dst_alpha), "blend"},
      {"equation", 5, [](const State& s) { return s.blend ? static_cast<int>(s.blend_equation[0]) : -1; }, "blend"},
      {"alpha equation", 5, [](const State& s) { return s.blend ? static_cast<int>(s.blend_equation[1]) : -1; },
       "blend"},
      {"color_mask", 8,
       [](const State& s) {
         return (s.color_mask[0] ? 1 : 0) + (s.color_mask[1] ? 2 : 0) + (s.color_mask[2] ? 4 : 0);
       }},
      {"dither", 2, [](const State& s) { return s.dither ? 1 : 0; }},
      {"fog", 4, [](const State& s) { return s.fog ? 1 + static_cast<int>(s.fog->kind) : 0; }},
      {"texture", 2, [](const State& s) { return s.texture ? 1 : 0; }},
      {"texture_combine", 4, [](const State& s) { return s.texture ? static_cast<int>(s.texture_combine) : -1; },
       "texture"},
  };
}

TEST(StatePairs, RandomScenesDrawEveryPairOfValues) {
  Config config = preset("embedded");
  config.texture_unit = TextureUnitKind::nearest;
  config.alpha_units = config.dither_units = 1;
  config.blend_lanes = 4;
  config.stencil_bits = 8;
  config.fog_units = 1;
  const std::vector<Dimension> all = dimensions();
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> seen;  // by pair: draws by both values
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = a + 1; b < all.size(); ++b)
      seen[{a, b}].resize(static_cast<std::size_t>(all[a].values * all[b].values));
  constexpr std::uint64_t kFirstSeed = 33,
                          kScenes = 1600;  // of 200 primitives: a third of what `./dev soak-cosim` draws
  std::size_t draws = 0;
  for (std::uint64_t seed = kFirstSeed; seed < kFirstSeed + kScenes; ++seed) {
    const Scene scene = random_scene(config, seed, 200);
    for (const Command& command : scene.commands) {
      const Draw* draw = std::get_if<Draw>(&command);
      if (draw == nullptr) continue;
      ++draws;
      const State& state = scene.states[draw->state];
      std::vector<int> values;
      for (const Dimension& dimension : all) {
        values.push_back(dimension.value(state));
        ASSERT_LT(values.back(), dimension.values) << dimension.name;
      }
      for (auto& [pair, counts] : seen)
        if (const int a = values[pair.first], b = values[pair.second]; a >= 0 && b >= 0)
          ++counts[static_cast<std::size_t>(a * all[pair.second].values + b)];
    }
  }
  const auto is_possible = [](const Dimension& a, const Dimension& b, int va, int vb) {
    return !(va == 0 && a.name == std::string(b.part_of)) && !(vb == 0 && b.name == std::string(a.part_of));
  };
  std::size_t pairs = 0;
  for (const auto& [pair, counts] : seen) {
    const Dimension &a = all[pair.first], &b = all[pair.second];
    std::size_t fewest = draws;
    for (int va = 0; va < a.values; ++va)
      for (int vb = 0; vb < b.values; ++vb) {
        if (!is_possible(a, b, va, vb)) continue;
        const std::size_t times = counts[static_cast<std::size_t>(va * b.values + vb)];
        EXPECT_GT(times, 0U) << a.name << " " << va << " with " << b.name << " " << vb;
        fewest = std::min(fewest, times);
        ++pairs;
      }
    RecordProperty(std::string(a.name) + " x " + b.name, std::to_string(fewest));
  }
  std::cout << pairs << " pairs of values of " << all.size() << " states, in " << draws << " draws of seeds "
            << kFirstSeed << " to " << kFirstSeed + kScenes - 1 << '\n';
}

}  // namespace
}  // namespace halfplane
