// Each stage on its own: the closed forms, the stepped forms, and the cases by which they could differ.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "../scene_builder.hpp"
#include "model/host/primitives.hpp"
#include "model/packets/packet_words.hpp"
#include "model/stages/coarse_raster.hpp"
#include "model/stages/cull.hpp"
#include "model/stages/depth_test.hpp"
#include "model/stages/fine_raster.hpp"
#include "model/stages/interpolate.hpp"
#include "model/stages/rop.hpp"
#include "model/stages/triangle_setup.hpp"
#include "sim/cosim/arrows.hpp"
#include "tests/packet_values.hpp"

namespace halfplane::stages_test {
namespace {

using test::Random;

Triangle random_triangle(Random& random, const Widths& widths, double reach) {
  Triangle triangle;
  for (auto& v : triangle.v) {
    v.x = static_cast<std::int32_t>(reach * random.between(static_cast<double>(widths.coordinate.range.lo),
                                                           static_cast<double>(widths.coordinate.range.hi)));
    v.y = static_cast<std::int32_t>(reach * random.between(static_cast<double>(widths.coordinate.range.lo),
                                                           static_cast<double>(widths.coordinate.range.hi)));
    v.depth() = static_cast<std::uint32_t>(random.between(0, static_cast<double>(widths.depth().code.range.hi)));
  }
  return triangle;
}

/// The tiles of a triangle's box that lie outside of no edge, and how the walk comes to them.
struct WalkTally {
  std::uint64_t tiles = 0, met = 0, met_twice = 0, visited = 0, in_boxes = 0;
};

/// `way`: called with the edges that a tile is outside of; the walk uses its return value.
template <class Way>
WalkTally walk_random_triangles(std::uint64_t seed, Way&& way) {
  const Config config = preset("embedded");
  const Widths widths = derive_widths(config);
  std::mt19937_64 random(seed);
  const auto below = [&random](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
  WalkTally tally;
  for (int n = 0; n < 3000; ++n) {
    const int reach = 16 << below(9), x = below(640 * 16), y = below(480 * 16);  // subpixels
    std::array<SnappedVertex, 3> v{};
    for (SnappedVertex& corner : v) {
      corner.x = std::clamp(x + below(2 * reach) - reach, -32768, 32767);
      corner.y = std::clamp(y + below(2 * reach) - reach, -32768, 32767);
    }
    if (below(3) == 0) {  // a sliver
      v[2].x = (v[0].x + v[1].x) / 2 + below(5) - 2;
      v[2].y = (v[0].y + v[1].y) / 2 + below(5) - 2;
    }
    PrimitivePacket primitive;
    set_vertices(primitive.vertex, v);
    primitive.box = to_box({0, 0, 639, 479});
    CounterPacket counters;
    const auto kept = cull(primitive, widths, counters);
    if (!kept) continue;
    const SetupPacket setup = setup_packet(*kept, config, widths);
    const int left = setup.box.left / 8, top = setup.box.top / 8, right = setup.box.right / 8,
              bottom = setup.box.bottom / 8;
    const auto outside = [&](int tile_x, int tile_y) {
      return outside_edges(setup.dx, setup.dy, edges_at_tile(setup, tile_x, tile_y, widths), 8);
    };
    for (int tile_y = top; tile_y <= bottom; ++tile_y)
      for (int tile_x = left; tile_x <= right; ++tile_x) {
        ++tally.in_boxes;
        tally.tiles += outside(tile_x, tile_y) == 0;
      }
    std::set<std::pair<int, int>> seen;
    TileWalk walk(left, top, right, bottom, setup.dy);
    unsigned edges = 0;
    bool was_last = false;
    do {
      EXPECT_FALSE(was_last) << "nothing follows the last tile";
      edges = outside(walk.x(), walk.y());
      ++tally.visited;
      if (edges == 0) tally.met_twice += !seen.emplace(walk.x(), walk.y()).second;
      was_last = edges == 0 && walk.is_last();
    } while (walk.next(way(edges)));
    tally.met += seen.size();
  }
  return tally;
}

TEST(CoarseRaster, TheWalkMeetsEveryTileThatIsNotOutsideOnceAndFewOthers) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const WalkTally tally = walk_random_triangles(seed, [](unsigned edges) { return edges; });
    EXPECT_EQ(tally.met, tally.tiles);
    EXPECT_EQ(tally.met_twice, 0u);
    EXPECT_GT(tally.in_boxes, 2 * tally.tiles);
    EXPECT_LT(tally.visited, tally.tiles + tally.tiles / 4 * 3) << "of " << tally.in_boxes << " in boxes";
    EXPECT_EQ(walk_random_triangles(seed, [](unsigned) { return 0U; }).visited, tally.in_boxes);
  }
}

TEST(CoarseRasterMustFail, AWalkThatTakesEdgesForOthersOverlooksTiles) {
  const WalkTally tally =
      walk_random_triangles(1, [](unsigned edges) { return edges == 0 ? 0U : (edges << 1 | edges >> 2) & 7U; });
  EXPECT_LT(tally.met, tally.tiles);
}

TEST(Snap, RoundsHalvesUpOnBothSidesOfZeroAndMovesWithTheScene) {
  EXPECT_EQ(snap(0.5, 1), 1);
  EXPECT_EQ(snap(-0.5, 1), 0);
  EXPECT_EQ(snap(-1.5, 1), -1);
  EXPECT_EQ(snap(0.49999999999999994, 1), 0) << "adding one half would round this up";
  EXPECT_EQ(snap(-0.03125, 16), 0);
  EXPECT_EQ(snap(10.03125, 16), 161);
}

TEST(Snap, RoundShiftIsFloorOfTheQuotientPlusOneHalf) {
  for (std::int64_t value = -100; value <= 100; ++value)
    for (int bits = 1; bits <= 6; ++bits)
      EXPECT_EQ(round_shift(value, bits),
                static_cast<std::int64_t>(std::floor(static_cast<double>(value) / (1 << bits) + 0.5)));
}

TEST(Rop, PackedChannelIsTheNearestCodeForEveryInput) {
  for (std::uint32_t c = 0; c < 256; ++c) {
    EXPECT_EQ(to_5_bits(c), static_cast<std::uint32_t>(std::floor(c * 31 / 255.0 + 0.5))) << c;
    EXPECT_EQ(to_6_bits(c), static_cast<std::uint32_t>(std::floor(c * 63 / 255.0 + 0.5))) << c;
  }
}

constexpr std::array kDepthFuncs{DepthFunc::never,   DepthFunc::less,   DepthFunc::lequal,   DepthFunc::equal,
                                 DepthFunc::greater, DepthFunc::gequal, DepthFunc::notequal, DepthFunc::always};

TEST(DepthTest, EveryFunctionIsTheUnionOfItsOutcomes) {
  for (const auto func : kDepthFuncs) {
    const bool less = depth_passes(func, 1, 2), equal = depth_passes(func, 2, 2), greater = depth_passes(func, 3, 2);
    const int outcomes = less * 4 + equal * 2 + greater;
    const std::array<int, 8> expected{0, 4, 6, 2, 1, 3, 5, 7};
    EXPECT_EQ(outcomes, expected[static_cast<std::size_t>(func)]);
  }
}

TEST(FragmentOps, LanesDoWhatTheScalarInstanceDoes) {
  typedef std::uint32_t Four __attribute__((vector_size(16)));  // NOLINT(modernize-use-using)
  Random random(12);
  std::mt19937 words(12);
  for (const auto func : kDepthFuncs) {
    const DepthOutcomes outcomes(func);
    EXPECT_EQ(can_raise_depth(func), func >= DepthFunc::greater);
    for (int n = 0; n < 100; ++n) {
      Four fragment, stored;
      for (int i = 0; i < 4; ++i) {
        stored[i] = static_cast<std::uint32_t>(words());
        fragment[i] = random.index(3) == 0 ? stored[i] : static_cast<std::uint32_t>(words());
      }
      const Four mask = outcomes(fragment, stored), written = write_where(mask, fragment, stored);
      for (int i = 0; i < 4; ++i) {
        const std::uint32_t f = fragment[i], s = stored[i], expected = depth_passes(func, f, s) ? ~0U : 0U;
        EXPECT_EQ(mask[i], expected);
        EXPECT_EQ(outcomes(f, s), expected);
        EXPECT_EQ(written[i], depth_passes(func, f, s) ? f : s);
      }
    }
  }
  for (const auto format : {ColorFormat::rgb565, ColorFormat::rgba8888})
    for (int n = 0; n < 200; ++n) {
      std::array<Four, 4> channel;
      for (Four& lanes : channel)
        for (int i = 0; i < 4; ++i) lanes[i] = static_cast<std::uint32_t>(random.index(256));
      const Four packed = pack_color(format, channel);
      const std::array<Four, 4> stored = unpack_color(format, packed);
      for (int i = 0; i < 4; ++i) {
        std::array<std::uint8_t, 4> code;
        for (std::size_t c = 0; c < 4; ++c) code[c] = static_cast<std::uint8_t>(channel[c][i]);
        EXPECT_EQ(packed[i], pack_color(format, code));
        for (std::size_t c = 0; c < 4; ++c) {
          EXPECT_EQ(stored[c][i], unpack_color(format, std::uint32_t{packed[i]})[c]);
          if (format == ColorFormat::rgba8888) {
            EXPECT_EQ(stored[c][i], code[c]);
          }
        }
      }
    }
}

TEST(FragmentOps, APacketThroughDepthTestAndRopIsEachOfItsFragmentsThroughTheOperations) {
  Random random(13);
  std::mt19937_64 words(13);
  for (const auto name : {"tiny", "embedded", "full"}) {
    const Config config = preset(name);
    const Widths widths = derive_widths(config);
    for (int n = 0; n < 400; ++n) {
      FragmentPacket fragment;
      fragment.state.depth_test = static_cast<DepthFunc>(random.index(8));
      fragment.state.depth_write = random.index(2) != 0;
      fragment.state.color_write = random.index(2) != 0;
      fragment.mask = SampleMask(words() & ((std::uint64_t{1} << widths.samples) - 1));
      std::array<std::uint32_t, 64> depth, color;
      for (std::size_t s = 0; s < 64; ++s) {
        fragment.code[s][kDepthPlane] = static_cast<std::uint32_t>(random.index(4));  // equal codes meet often
        depth[s] = static_cast<std::uint32_t>(random.index(4));
        const std::uint64_t rgba = words();
        for (std::size_t c = 0; c < 4; ++c) fragment.code[s][kColorPlane + c] = rgba >> 8 * c & 255;
        color[s] = static_cast<std::uint32_t>(words());
        if (config.color_format == ColorFormat::rgb565) color[s] &= 0xffff;
      }
      const WritePacket written = rop(fragment, depth_test(fragment, depth, {}, widths), config, widths);
      for (std::size_t s = 0; s < static_cast<std::size_t>(widths.samples); ++s) {
        std::uint32_t expected_depth = depth[s], expected_color = color[s];
        std::uint8_t stencil = 0;
        const auto source = [&] { return color_channels(fragment.code[s]); };
        const bool passes =
            fragment.mask.has(s) &&
            apply_fragment({fragment.state, {}, {}, {}}, config.color_format, {fragment.code[s][kDepthPlane]}, source,
                           {expected_depth, expected_color, stencil}) == Fate::passed;
        EXPECT_EQ(written.passed.has(s), passes);
        EXPECT_EQ(written.write_depth.has(s) ? written.depth[s] : depth[s], expected_depth);
        EXPECT_EQ(written.write_color.has(s) ? written.color[s] : color[s], expected_color);
      }
    }
  }
}

TEST(Reciprocal, IsTheNearestQuotientWithAllItsSignificantBits) {
  Random random(11);
  for (const int bits : {10, 20, 28, 36}) {
    for (int n = 0; n < 2000; ++n) {
      const auto area = n < 64 ? std::int64_t{n + 1} : static_cast<std::int64_t>(std::exp2(random.between(0, 45)));
      const Reciprocal r = reciprocal(area, bits);
      EXPECT_GE(r.value, std::uint64_t{1} << (bits - 1));
      EXPECT_LE(r.value, std::uint64_t{1} << bits);
      // |value * area - 2^shift| <= area / 2, in integers.
      const int128 error = static_cast<int128>(r.value) * area - (int128{1} << r.shift);
      EXPECT_LE(2 * (error < 0 ? -error : error), static_cast<int128>(area)) << "area " << area << ", bits " << bits;
    }
  }
}

TEST(Reciprocal, OfTheUpperBitsOfAQuotientIsThatOfADivisionOfItsOwn) {
  Random random(13);
  for (int n = 0; n < 4000; ++n) {
    const auto area = n < 1024 ? std::int64_t{n + 1} : static_cast<std::int64_t>(std::exp2(random.between(0, 45)));
    const int bits = 20 + static_cast<int>(random.index(17));
    const AreaQuotient quotient = area_quotient(area, bits);
    for (int dropped = 0; dropped <= bits - 10; ++dropped) {
      const Reciprocal upper = reciprocal(quotient, dropped), own = reciprocal(area, bits - dropped);
      ASSERT_EQ(upper.value, own.value) << "area " << area << ", " << bits - dropped << " of " << bits << " bits";
      ASSERT_EQ(upper.shift, own.shift);
    }
  }
}

TEST(EdgeFunction, SteppedToAnyTileEqualsDirectEvaluation) {
  Random random(12);
  for (const auto name : preset_names()) {
    const Config config = preset(name);
    const Widths widths = derive_widths(config);
    const Rect all{0, 0, config.target_width, config.target_height};
    for (int n = 0; n < 500; ++n) {
      const Triangle triangle = random_triangle(random, widths, 1);
      const TriangleSetup setup = setup_triangle(triangle, config, widths, all);
      if (setup.is_empty()) continue;
      const int tile_x = setup.right >> widths.tile_shift, tile_y = setup.bottom >> widths.tile_shift;
      const EdgeValues stepped = edges_at_tile(setup, tile_x, tile_y, widths);
      // The same edges found again by their direction, whatever order setup chose.
      for (std::size_t e = 0; e < 3; ++e) {
        bool is_found = false;
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t j = 0; j < 3; ++j) {
            const auto &from = triangle.v[i], &to = triangle.v[j];
            is_found |= i != j && to.x - from.x == setup.edge[e].dx && to.y - from.y == setup.edge[e].dy &&
                        stepped[e] == edge_function(from, to, tile_x << widths.tile_shift, tile_y << widths.tile_shift,
                                                    widths.grid_bits);
          }
        EXPECT_TRUE(is_found) << name << ", triangle " << n << ", edge " << e;
      }
    }
  }
}

TEST(EdgeFunction, SharedEdgeSeenFromBothSidesIsCoveredFromExactlyOne) {
  // tiny's grid, every edge of a 5 x 5 subpixel neighbourhood, every pixel nearby: a sample on the line belongs to one.
  for (std::int32_t x = -8; x <= 8; ++x)
    for (std::int32_t y = -8; y <= 8; ++y) {
      if (x == 0 && y == 0) continue;
      SnappedVertex a, b;
      a.x = a.y = 2;
      b.x = 2 + x;
      b.y = 2 + y;
      for (int px = -4; px <= 4; ++px)
        for (int py = -4; py <= 4; ++py)
          EXPECT_NE(edge_function(a, b, px, py, 2) >= 0, edge_function(b, a, px, py, 2) >= 0) << x << ' ' << y;
    }
}

TEST(CoarseRaster, SaturatedTileEdgeKeepsTheSignOfEverySample) {
  Random random(13);
  for (const auto name : preset_names()) {
    const Config config = preset(name);
    const Widths widths = derive_widths(config);
    const Rect all{0, 0, config.target_width, config.target_height};
    std::size_t saturated = 0;
    for (int n = 0; n < 300; ++n) {
      const TriangleSetup setup = setup_triangle(random_triangle(random, widths, 1), config, widths, all);
      if (setup.is_empty()) continue;
      const int tile_x = (setup.left + setup.right) / 2 >> widths.tile_shift;
      const int tile_y = (setup.top + setup.bottom) / 2 >> widths.tile_shift;
      const EdgeValues wide = edges_at_tile(setup, tile_x, tile_y, widths);
      for (std::size_t e = 0; e < 3; ++e) {
        const std::int32_t narrow = saturate_tile_edge(wide[e], widths);
        saturated += narrow != wide[e];
        for (int j = 0; j < config.tile_size; ++j)
          for (int i = 0; i < config.tile_size; ++i) {
            const std::int64_t step = std::int64_t{j} * setup.edge[e].dx - std::int64_t{i} * setup.edge[e].dy;
            EXPECT_EQ(wide[e] + step >= 0, narrow + step >= 0);
          }
      }
    }
    EXPECT_GT(saturated, 0u) << name << ": the case was never met";
  }
}

TEST(CoarseRaster, ClassOfATileIsWhatItsSamplesSay) {
  Random random(14);
  const Config config = preset("embedded");
  const Widths widths = derive_widths(config);
  std::array<int, 3> met{};
  for (int n = 0; n < 2000; ++n) {
    const TriangleSetup setup = setup_triangle(random_triangle(random, widths, 0.02), config, widths, {0, 0, 64, 64});
    if (setup.is_empty()) continue;
    const int tile_x = (setup.left >> 3) + random.index((setup.right >> 3) - (setup.left >> 3) + 1);
    const int tile_y = (setup.top >> 3) + random.index((setup.bottom >> 3) - (setup.top >> 3) + 1);
    const EdgeValues edges = edges_at_tile(setup, tile_x, tile_y, widths);
    const TileClass kind = classify(setup, edges, config.tile_size);
    int inside = 0;
    bool is_outside_one = false;
    for (std::size_t e = 0; e < 3; ++e) {
      int of_edge = 0;
      for (int s = 0; s < 64; ++s)
        of_edge += edges[e] + std::int64_t{s / 8} * setup.edge[e].dx - std::int64_t{s % 8} * setup.edge[e].dy >= 0;
      inside += of_edge;
      is_outside_one |= of_edge == 0;
    }
    const TileClass expected = is_outside_one     ? TileClass::outside
                               : inside == 3 * 64 ? TileClass::inside
                                                  : TileClass::cut;
    EXPECT_EQ(kind, expected);
    ++met[static_cast<std::size_t>(kind)];
  }
  for (const int count : met) EXPECT_GT(count, 10);
}

TEST(Interpolate, FlatDepthHasNoGradientAtAll) {
  Random random(15);
  const Config config = preset("full");
  const Widths widths = derive_widths(config);
  for (int n = 0; n < 1000; ++n) {
    Triangle triangle = random_triangle(random, widths, 1);
    triangle.v[0].depth() = triangle.v[1].depth() = triangle.v[2].depth();
    const TriangleSetup setup = setup_triangle(triangle, config, widths);
    EXPECT_EQ(setup.plane[kDepthPlane].step_x, 0);
    EXPECT_EQ(setup.plane[kDepthPlane].step_y, 0);
  }
}

TEST(Interpolate, ValueFarOutsideTheTriangleWrapsWithoutHarmInside) {
  // A full-range gradient over a pixel: far away the plane leaves its range thousands of times over.
  const Config config = preset("embedded");
  const Widths widths = derive_widths(config);
  Triangle triangle;
  triangle.v[0] = {160, 160, {0}};
  triangle.v[1] = {176, 160, {65535}};
  triangle.v[2] = {160, 30000, {0}};
  const TriangleSetup setup = setup_triangle(triangle, config, widths);
  EXPECT_EQ(interpolate_at(setup, widths, 10, 10).code[kDepthPlane], 32768u);  // 65535 * 8/16, rounded
}

TEST(Packets, EveryMemberHoldsItsFieldInEveryLegalTileAndStamp) {
  for (const int tile : {4, 8, 16, 32})
    for (const int stamp : {1, 2, 4, 8}) {
      if (stamp > tile) continue;
      Config config = preset("full");
      config.tile_size = tile;
      config.stamp_size = stamp;
      config.local_guard_bits = 8;
      config.context_slots = 64;
      config.primitive_id_bits = 32;
      config.guard_band = config.target_width = config.target_height = 16384;
      validate(config);
      const Widths widths = derive_widths(config);
      test::expect_members_wide_enough<TilePacket>(widths);
      test::expect_members_wide_enough<EdgeContext>(widths);
      test::expect_members_wide_enough<StampPacket>(widths);
    }
}

TEST(Packets, DifferenceNamesTheFieldAndTheElement) {
  const Widths widths = derive_widths(preset("embedded"));
  TilePacket a, b;
  b.edge_value[1] = -5;
  b.slot = 2;
  b.anchor[kColorPlane] = 3;
  const auto words_a = packed(a, widths), words_b = packed(b, widths);
  std::vector<std::string> names;
  for (const FieldPair& pair : field_pairs(Arrow::tile, widths, words_a.data(), words_b.data())) {
    if (!pair.differs()) continue;
    names.push_back(pair.name);
    if (pair.name == "edge_value[1]") {
      EXPECT_EQ(pair.rtl_text(), "-5");
    }
  }
  EXPECT_EQ(names, (std::vector<std::string>{"slot", "edge_value[1]", "anchor[red]"}));
}

}  // namespace
}  // namespace halfplane::stages_test
