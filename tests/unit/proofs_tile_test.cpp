// Proofs by enumeration: trivial reject and accept, stepped coverage of whole triangles, HiZ.
#include <algorithm>
#include <array>
#include <bitset>
#include <vector>

#include "../enumeration.hpp"
#include "model/stages/coarse_raster.hpp"
#include "model/stages/fine_raster.hpp"
#include "model/stages/fragment_ops.hpp"

namespace halfplane::proofs_tile_test {
namespace {

using test::is_whole;
using test::report_proof;
using test::tiny;
using test::tiny_widths;
using test::vertex_at;

// --- c: trivial reject and accept of one edge --------------------------------------------------------------------------

/// How many tiles there were, and how many of them were rejected with a covered sample, accepted with an uncovered one,
/// or neither although they could have been.
struct TileTally {
  std::uint64_t cases = 0, wrongly_rejected = 0, wrongly_accepted = 0, missed = 0;
};

/// Every slope of an edge; values at the tile's first pixel around all that matter to it. `extent`: the tile size that
/// classify is told.
TileTally classify_every_slope(int reach, int extent) {
  const int tile = tiny().tile_size, side = static_cast<int>(tiny_widths().delta.range.hi);
  TileTally tally;
  for (int dy = -side; dy <= side; ++dy)
    for (int dx = -side; dx <= side; ++dx) {
      // Over all samples of the tile, one by one.
      std::int64_t least = 0, most = 0;
      for (int y = 0; y < tile; ++y)
        for (int x = 0; x < tile; ++x) {
          const std::int64_t offset = std::int64_t{y} * dx - std::int64_t{x} * dy;
          least = std::min(least, offset);
          most = std::max(most, offset);
        }
      for (const std::int64_t around : {-most, -least})
        for (std::int64_t value = around - reach; value <= around + reach; ++value) {
          // The other two edges cover the whole tile.
          const TileClass found = classify({dx, 0, 0}, {dy, 0, 0}, {value, 0, 0}, extent);
          const bool has_covered = value + most >= 0, has_uncovered = value + least < 0;
          ++tally.cases;
          tally.wrongly_rejected += found == TileClass::outside && has_covered;
          tally.wrongly_accepted += found == TileClass::inside && has_uncovered;
          tally.missed += found == TileClass::cut && !(has_covered && has_uncovered);
        }
    }
  return tally;
}

TEST(Proofs, ATileIsRejectedOrAcceptedExactlyWhenNoneOrAllOfItsSamplesAreCovered) {
  const TileTally tally = classify_every_slope(is_whole() ? 512 : 4, tiny().tile_size);
  EXPECT_EQ(tally.wrongly_rejected, 0U);
  EXPECT_EQ(tally.wrongly_accepted, 0U);
  EXPECT_EQ(tally.missed, 0U);
  report_proof("(c) a tile and an edge: outside, cut and inside", tally.cases);
}

TEST(ProofsMustFail, ATileIsJudgedWronglyAtACornerOnePixelOff) {
  const TileTally smaller = classify_every_slope(4, tiny().tile_size - 1),
                  larger = classify_every_slope(4, tiny().tile_size + 1);
  EXPECT_GT(smaller.wrongly_rejected, 0U);
  EXPECT_GT(smaller.wrongly_accepted, 0U);
  EXPECT_GT(larger.missed, 0U);
}

// --- a, c: whole triangles through cull, coarse_raster and fine_raster --------------------------------------------------

using Coverage = std::bitset<256>;  // tiny's target, row by row

/// The stages' coverage of a triangle, and their tiles that are wrongly rejected or accepted. `is_broken`: the edges'
/// steps along x and y are swapped after coarse_raster.
Coverage stepped_coverage(const SetupPacket& setup, bool is_broken, TileTally& tally, const Coverage& expected) {
  const Widths& widths = tiny_widths();
  const int shift = widths.tile_shift, tile = tiny().tile_size;
  EdgeContext edges = make_edge_context(setup);
  if (is_broken) std::swap(edges.step_x, edges.step_y);
  Hiz hiz(tiny(), widths);
  CounterPacket counters;
  Coverage covered;
  std::array<bool, 4> is_visited{};
  coarse_raster(setup, 0, hiz, widths, counters, [&](const TilePacket& packet) {
    if (!packet.is_visit) return;
    is_visited[static_cast<std::size_t>(packet.key.tile_y * widths.tiles_x + packet.key.tile_x)] = true;
    fine_raster(packet, edges, widths, [&](const StampPacket& stamp) {
      const int x = (packet.key.tile_x << shift) + stamp.stamp % tile,
                y = (packet.key.tile_y << shift) + stamp.stamp / tile;
      if (stamp.mask.any()) covered.set(static_cast<std::size_t>(y * tiny().target_width + x));
    });
    for (int y = packet.box.top; packet.is_inside && y <= packet.box.bottom; ++y)
      for (int x = packet.box.left; x <= packet.box.right; ++x)
        tally.wrongly_accepted += !expected.test(static_cast<std::size_t>(
            ((packet.key.tile_y << shift) + y) * tiny().target_width + (packet.key.tile_x << shift) + x));
  });
  for (int y = 0; y < tiny().target_height; ++y)
    for (int x = 0; x < tiny().target_width; ++x)
      tally.wrongly_rejected += expected.test(static_cast<std::size_t>(y * tiny().target_width + x)) &&
                                !is_visited[static_cast<std::size_t>((y >> shift) * widths.tiles_x + (x >> shift))];
  return covered;
}

/// Every triangle with vertices in places x places; how many were drawn, and in how many stepping and the closed form,
/// evaluated at each sample of the target, differ.
struct TriangleTally {
  std::uint64_t triangles = 0, drawn = 0, differ = 0;
  TileTally tiles;
};

TriangleTally every_triangle(const std::vector<int>& places, bool is_broken) {
  const Widths& widths = tiny_widths();
  const auto n = static_cast<int>(places.size()), points = n * n;
  const auto at = [&](int point) {
    return vertex_at(places[static_cast<std::size_t>(point % n)], places[static_cast<std::size_t>(point / n)]);
  };
  TriangleTally tally;
  for (int a = 0; a < points; ++a)
    for (int b = 0; b < points; ++b)
      for (int c = 0; c < points; ++c) {
        ++tally.triangles;
        PrimitivePacket primitive;
        set_vertices(primitive.vertex, {at(a), at(b), at(c)});
        primitive.box = to_box({0, 0, tiny().target_width - 1, tiny().target_height - 1});
        CounterPacket counters;
        const auto kept = cull(primitive, widths, counters);
        if (!kept) continue;
        ++tally.drawn;
        const auto v = to_snapped(kept->vertex);
        Coverage expected;
        for (int y = 0; y < tiny().target_height; ++y)
          for (int x = 0; x < tiny().target_width; ++x) {
            bool is_covered = true;
            for (std::size_t e = 0; e < 3; ++e)
              is_covered &= edge_function(v[e], v[(e + 1) % 3], x, y, widths.grid_bits) >= 0;
            expected.set(static_cast<std::size_t>(y * tiny().target_width + x), is_covered);
          }
        const SetupPacket setup = setup_packet(*kept, tiny(), widths);
        tally.differ += stepped_coverage(setup, is_broken, tally.tiles, expected) != expected;
      }
  return tally;
}

TEST(Proofs, SteppedCoverageIsTheClosedFormForEveryTriangleOfALattice) {
  // On and beside pixel centres and the border of two tiles, and at the guard band's.
  const std::vector<int> few{-128, 2, 17, 30, 63}, many{-128, -41, 0, 2, 17, 29, 30, 34, 45, 62, 127};
  const TriangleTally tally = every_triangle(is_whole() ? many : few, false);
  EXPECT_GT(tally.drawn, tally.triangles / 4);
  EXPECT_EQ(tally.differ, 0U);
  EXPECT_EQ(tally.tiles.wrongly_rejected, 0U);
  EXPECT_EQ(tally.tiles.wrongly_accepted, 0U);
  report_proof("(a, c) triangles of a lattice, every sample, stepped against the closed form", tally.triangles);
}

TEST(ProofsMustFail, SteppedCoverageIsAnotherWhenXAndYStepsChangePlaces) {
  EXPECT_GT(every_triangle({2, 30, 63}, true).differ, 0U);
}

// --- d: HiZ -----------------------------------------------------------------------------------------------------------

/// Every smallest vertex code, bound and depth function that is tested at all: how many tiles are rejected although some
/// code not below one bound, against a stored code not above the other, passes. `asked`: the function that HiZ is told.
TileTally every_bound(int hiz_bits, DepthFunc func, DepthFunc asked) {
  Config config = tiny();
  config.hiz_bits = hiz_bits;
  const Widths widths = derive_widths(config);
  const int codes = 1 << config.depth_bits, dropped = config.depth_bits - hiz_bits;
  // passes[f][z]: some fragment code >= f passes against some stored code <= z.
  std::vector<std::vector<bool>> passes(static_cast<std::size_t>(codes) + 1,
                                        std::vector<bool>(static_cast<std::size_t>(codes)));
  for (std::size_t f = static_cast<std::size_t>(codes); f-- > 0;)
    for (std::size_t z = 0; z < static_cast<std::size_t>(codes); ++z)
      passes[f][z] = depth_passes(func, static_cast<std::uint32_t>(f), static_cast<std::uint32_t>(z)) ||
                     passes[f + 1][z] || (z > 0 && passes[f][z - 1]);
  Hiz hiz(config, widths);
  TileTally tally;
  for (std::uint32_t code = 0; code < 1U << hiz_bits; ++code) {
    RetirePacket retired;
    retired.update = HizUpdate::set;
    retired.hiz_code = code;
    for (int n = 0; n < config.hiz_lag; ++n) {  // so many visits later it is seen
      hiz.begin_visit({});
      hiz.retire(retired);
    }
    const std::uint32_t farthest = ((code + 1) << dropped) - 1;  // the largest depth whose high bits are the code
    for (std::uint32_t nearest = 0; nearest < static_cast<std::uint32_t>(codes); ++nearest) {
      SetupPacket setup;
      setup.range.low[kDepthPlane] = nearest;
      setup.state.depth_test = asked;
      ++tally.cases;
      const bool can_pass = passes[nearest][farthest];
      tally.wrongly_rejected += hiz.rejects(setup, 0, 0) && can_pass;
      tally.missed += !hiz.rejects(setup, 0, 0) && !can_pass;
    }
  }
  return tally;
}

TEST(Proofs, HizRejectsATileExactlyWhenNoFragmentCanPass) {
  std::uint64_t cases = 0;
  for (int bits = 1; bits <= tiny().depth_bits; ++bits)
    for (const DepthFunc func : {DepthFunc::less, DepthFunc::lequal, DepthFunc::equal}) {
      const TileTally tally = every_bound(bits, func, func);
      EXPECT_EQ(tally.wrongly_rejected, 0U) << bits;
      EXPECT_EQ(tally.missed, 0U) << bits;
      cases += tally.cases;
    }
  report_proof("(d) HiZ: nearest code, bound, depth function, bits of the bound", cases);
}

TEST(ProofsMustFail, HizThatTakesLequalForLessRejectsWhatWouldPass) {
  EXPECT_GT(every_bound(8, DepthFunc::lequal, DepthFunc::less).wrongly_rejected, 0U);
}

}  // namespace
}  // namespace halfplane::proofs_tile_test
