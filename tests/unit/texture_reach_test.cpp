// Texture coordinates that go farther than 2^20 texels from their middle: found, and judged by a bound that holds.
#include "sim/scene/texture_reach.hpp"

#include <gtest/gtest.h>

#include "model/capture/capture.hpp"
#include "sim/study/compare/compare.hpp"

namespace halfplane::texture_reach_test {
namespace {

/// A wall of one triangle, 1024 texels wide and `repeats` times as high, upright or in perspective.
Scene wall(int repeats, bool is_tilted) {
  const std::string far = is_tilted ? "5" : "1";
  return read_capture(
      "halfplane 1\ntarget 60 40\ntexture grid pattern grid 1024 1024 mips box\nspace clip\n"
      "state texture grid\nv -4 -1 0 1 255 255 255 255 0 0\nv 4 -1 0 1 255 255 255 255 0 0\nv 0 " +
          far + " 0 " + far + " 255 255 255 255 0 " + std::to_string(repeats) + "\nt 0 1 2\n",
      "wall.hpt");
}

TEST(TextureReach, IsSaidAndJudgedByABoundThatHolds) {
  for (const bool is_tilted : {false, true})
    for (const int repeats : {1500, 2047, 2049, 4096, 20000}) {
      SCOPED_TRACE(std::to_string(repeats) + (is_tilted ? " tilted" : ""));
      const Scene scene = wall(repeats, is_tilted);
      const auto beyond = beyond_reach(scene);
      EXPECT_EQ(beyond.has_value(), repeats > 2048);
      if (beyond) {
        EXPECT_EQ(beyond->triangles, 1U);
        EXPECT_EQ(beyond->span, 1024.0 * repeats);
      }
      const Comparison c = compare(scene, preset("full"));
      EXPECT_EQ(broken_bounds(c, preset("full")), std::vector<std::string>{});
      const double texels = c.texture->coordinate.max, of_bound = c.texture->coordinate_of_bound;
      EXPECT_GT(of_bound, 0.0);
      EXPECT_LE(of_bound, 1.0);
      // The ends of the wall are held so far from where they are, and a pixel near one of them shows nearly all of it.
      const double held_off = 512.0 * repeats - (1 << 20);
      if (held_off > 20000) {
        EXPECT_GT(texels, 0.8 * held_off);
        EXPECT_GT(of_bound, 0.5);
      }
    }
}

}  // namespace
}  // namespace halfplane::texture_reach_test
