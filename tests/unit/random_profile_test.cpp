// Knobs of random scenes: each holds in every scene, none changes a scene without it.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "model/capture/capture.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/host/primitives.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/cosim/session.hpp"
#include "sim/show/image/framebuffer_files.hpp"
#include "tests/committed.hpp"

namespace halfplane::random_profile_test {
namespace {

std::string text_of(const Scene& scene) {
  std::ostringstream text;
  write_capture(scene, text);
  return text.str();
}

/// A line for each design and seed: "embedded 1 HASH".
std::string hashes() {
  std::string lines;
  for (const Design& design : designs())
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const std::string text = text_of(*random_scenes(preset(std::string(design.name)), seed, 50)());
      char hash[17];
      std::snprintf(
          hash, sizeof hash, "%016llx",
          static_cast<unsigned long long>(fnv1a64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()})));
      lines += std::string(design.name) + " " + std::to_string(seed) + " " + hash + "\n";
    }
  return lines;
}

/// Scenes of seeds 1 to 6, each valid for the hardware.
std::vector<Scene> scenes_with(const std::string& knobs, const Config& config) {
  const RandomProfile profile = read_random_profile(knobs, config);
  std::vector<Scene> scenes;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    scenes.push_back(random_scene(config, seed, 120, profile));
    check_hardware_scene(scenes.back(), config);
  }
  return scenes;
}

template <class Check>
void for_each_draw(const Scene& scene, Check check) {
  for (const Command& command : scene.commands)
    if (const auto* draw = std::get_if<Draw>(&command)) check(*draw, scene.states[draw->state]);
}

/// Corner n of the scene's triangles, in order.
const Vertex& corner(const Scene& scene, std::size_t n) { return scene.vertices[scene.indices[n]]; }

TEST(RandomScenesCommitted, WithoutKnobsASeedGivesTheSceneThatItGave) {
  test::expect_committed("tests/data/random_scenes.txt", [](const std::string&) { return hashes(); });
}

TEST(RandomProfile, TrianglesAloneNeedNoFilter) {
  for (const Design& design : designs()) {
    const Config config = preset(std::string(design.name));
    for (const Scene& scene : scenes_with("triangles,less,16x16,no-scissor,no-clears", config)) {
      EXPECT_EQ(scene.width, 16);
      EXPECT_EQ(scene.height, 16);
      for_each_draw(scene, [](const Draw& draw, const State& state) {
        EXPECT_EQ(drawn_as(state, draw.topology), PrimitiveType::triangle);
        EXPECT_EQ(state.depth_test, DepthFunc::less);
        EXPECT_FALSE(state.scissor);
      });
      for (const Command& command : scene.commands) EXPECT_TRUE(std::holds_alternative<Draw>(command));
    }
  }
}

TEST(RandomProfile, KindsAndValuesAllOccur) {
  std::size_t lines = 0, points = 0, none = 0, back = 0;
  for (const Scene& scene : scenes_with("lines,points,cull=none|back", preset("embedded")))
    for_each_draw(scene, [&](const Draw& draw, const State& state) {
      EXPECT_NE(draw.topology, Topology::triangles);
      (draw.topology == Topology::lines ? lines : points) += 1;
      (state.cull == Cull::none ? none : back) += 1;
      EXPECT_TRUE(state.cull == Cull::none || state.cull == Cull::back);
    });
  for (const std::size_t n : {lines, points, none, back}) EXPECT_GT(n, 10U);
}

TEST(RandomProfile, EveryStateCanBeLeftOutOrFixedInEveryDesign) {
  for (const Design& design : designs()) {
    const Config config = preset(std::string(design.name));
    for (const DrawState& row : draw_states()) {
      if (row.name == "space") continue;
      for (const Scene& scene : scenes_with("no-" + std::string(row.name), config))
        for_each_draw(scene, [&](const Draw&, const State& state) {
          EXPECT_EQ(row.value(state), row.default_value()) << design.name << " " << row.name;
        });
      for (const std::string_view word : row.words) {
        try {
          (void)scenes_with(std::string(row.name) + "=" + std::string(word), config);
        } catch (const InputError& error) {
          const std::string why = error.what();
          EXPECT_TRUE(why.starts_with("--random-only: " + std::string(row.name) + "=" + std::string(word) + ": "))
              << design.name << ": " << why;
        }
      }
    }
  }
}

TEST(RandomProfile, SizesStayWithinTheirBounds) {
  const Config config = preset("embedded");
  double least = 1e9, most = 0;
  for (const Scene& scene : scenes_with("triangles,size=3..9,reuse=30,ties=0", config))
    for (std::size_t n = 0; n + 2 < scene.indices.size(); n += 3) {
      const auto [left, right] = std::minmax({corner(scene, n).x, corner(scene, n + 1).x, corner(scene, n + 2).x});
      const auto [top, bottom] = std::minmax({corner(scene, n).y, corner(scene, n + 1).y, corner(scene, n + 2).y});
      const double extent = std::max(right - left, bottom - top);
      EXPECT_LE(extent, 9);
      least = std::min(least, extent);
      most = std::max(most, extent);
    }
  EXPECT_LT(least, 5);
  EXPECT_GT(most, 7);
}

TEST(RandomProfile, SharesPerHundredAreMet) {
  const Config config = preset("embedded");
  std::size_t triangles = 0, ties = 0, reused = 0, same = 0;
  for (const Scene& scene : scenes_with("triangles,ties=40,reuse=30,overlap=20,size=8..64", config))
    for (std::size_t n = 0; n + 2 < scene.indices.size(); n += 3, ++triangles) {
      const auto at = [&](std::size_t i) { return std::pair(corner(scene, i).x, corner(scene, i).y); };
      const auto is_tie = [&](std::size_t i) {
        return at(i).first - std::floor(at(i).first) == 0.5 && at(i).second - std::floor(at(i).second) == 0.5;
      };
      ties += is_tie(n) && is_tie(n + 1) && is_tie(n + 2) ? 1 : 0;
      if (n == 0) continue;
      same += at(n) == at(n - 3) && at(n + 1) == at(n - 2) && at(n + 2) == at(n - 1) ? 1 : 0;
    }
  for (const Scene& scene : scenes_with("triangles,reuse=30,overlap=0,ties=0,size=8..64", config))
    for (std::size_t n = 3; n + 2 < scene.indices.size(); n += 3)
      reused += corner(scene, n).x == corner(scene, n - 2).x && corner(scene, n).y == corner(scene, n - 2).y &&
                        corner(scene, n + 1).x == corner(scene, n - 3).x &&
                        corner(scene, n + 1).y == corner(scene, n - 3).y
                    ? 1
                    : 0;
  const auto share = [&](std::size_t n) { return 100.0 * static_cast<double>(n) / static_cast<double>(triangles); };
  EXPECT_GT(share(ties), 30);
  EXPECT_LT(share(ties), 65);
  EXPECT_NEAR(share(reused), 30, 6);
  // A repeated triangle is moved to pixel centres in 40 of 100 cases.
  EXPECT_GT(share(same), 8);
  EXPECT_LT(share(same), 22);
}

TEST(RandomProfile, DepthsComeInTheirOrder) {
  const Config config = preset("embedded");
  for (const auto& [order, sign] : {std::pair("front_to_back", 1), {"back_to_front", -1}, {"equal", 0}})
    for (const Scene& scene : scenes_with("triangles,depth=" + std::string(order), config)) {
      double last = corner(scene, 0).z;
      bool has_moved = false;
      for (std::size_t n = 0; n < scene.indices.size(); ++n) {
        const double step = corner(scene, n).z - last;
        if (n % 3 != 0 || sign == 0) {
          EXPECT_EQ(step, 0) << "a primitive has one depth";
        } else {
          EXPECT_GE(step * sign, 0);
          has_moved = has_moved || step != 0;
        }
        last = corner(scene, n).z;
      }
      EXPECT_EQ(has_moved, sign != 0);
    }
  bool has_risen = false, has_fallen = false;
  for (const Scene& scene : scenes_with("triangles,depth=flat", config))
    for (std::size_t n = 0; n < scene.indices.size(); ++n) {
      const double step = n == 0 ? 0 : corner(scene, n).z - corner(scene, n - 1).z;
      EXPECT_TRUE(n % 3 == 0 || step == 0) << "a primitive has one depth";
      has_risen = has_risen || step > 0;
      has_fallen = has_fallen || step < 0;
    }
  EXPECT_TRUE(has_risen && has_fallen);
}

TEST(RandomProfile, TexturesHaveTheirNumberAndSize) {
  for (const Scene& scene : scenes_with("textures=7,texture_size=4", preset("textured"))) {
    ASSERT_EQ(scene.textures.size(), 7U);
    for (const Texture& texture : scene.textures) EXPECT_TRUE(texture.width() == 4 && texture.height() == 4);
  }
}

TEST(RandomProfile, SomeScenesOfARunAreThoseOfTheWholeRun) {
  const Config config = preset("tiny");
  const RandomProfile profile = read_random_profile("triangles,ties=50", config);
  std::vector<Scene> whole, part;
  for (auto next = random_scenes(config, 5, 700, profile); auto scene = next();) whole.push_back(std::move(*scene));
  for (auto next = random_scenes(config, 5, 700, profile, {2, 2}); auto scene = next();)
    part.push_back(std::move(*scene));
  ASSERT_EQ(whole.size(), 4U);
  ASSERT_EQ(part.size(), 2U);
  EXPECT_TRUE(same_scene(whole[1], part[0]));
  EXPECT_TRUE(same_scene(whole[2], part[1]));
}

TEST(RandomProfile, AProfileIsAFileAndWordsBesideItAddToIt) {
  const std::string path = testing::TempDir() + "random_profile.toml";
  std::ofstream(path) << "kinds = \"triangles|points\"\nsize = \"1..8\"\nties = 25\nno = \"scissor|clears\"\n"
                         "depth_test = \"less|lequal\"\n";
  const Config config = preset("embedded");
  const RandomProfile file = read_random_profile(path + ",32x8", config);
  const RandomProfile words =
      read_random_profile("triangles,points,size=1..8,ties=25,no-scissor,no-clears,less,lequal,32x8", config);
  EXPECT_TRUE(same_scene(random_scene(config, 3, 200, file), random_scene(config, 3, 200, words)));
  std::ofstream(path) << "kinds = \"triangles\"\ntie = 25\n";
  try {
    (void)read_random_profile(path, config);
    ADD_FAILURE() << "an unknown key";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).rfind(path + ":2: no knob 'tie'; did you mean ties?", 0), 0U) << error.what();
  }
}

TEST(RandomProfile, WhatAConfigurationDoesNotHaveIsRefusedInOneLine) {
  const auto expect_refused = [](const std::string& knobs, const char* design, const std::string& part) {
    try {
      (void)read_random_profile(knobs, preset(design));
      ADD_FAILURE() << knobs;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  };
  expect_refused("lines", "small", "no unit that draws them; set lines.unit=1");
  expect_refused("17x16", "tiny", "more than the 16x16 of this configuration");
  expect_refused("textures=2", "embedded", "no texture unit");
  expect_refused("blend=one one", "embedded", "set blend.lanes=4");
  expect_refused("logic_op=xor", "embedded", "set logic.unit=1");
  expect_refused("fog=exp 1,texture_interp=affine", "stencilled", "leave one out");
  expect_refused("texture_min=linear", "stencilled", "nearest texels alone");
  expect_refused("trianlges", "embedded", "did you mean triangles?");
  expect_refused("cull=sometimes", "embedded", "cull=sometimes: ");
  expect_refused("size=9..3", "embedded", "goes down");
  expect_refused("ties=101", "embedded", "from 0 to 100");
  expect_refused("texture_size=12", "textured", "power of two");
  expect_refused("no-lines", "embedded", "say which kinds are left");
}

}  // namespace
}  // namespace halfplane::random_profile_test
