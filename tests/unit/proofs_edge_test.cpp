// Proofs by enumeration: a shared edge, and the ranges of values computed from three vertices.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "../enumeration.hpp"
#include "model/stages/cull.hpp"
#include "model/stages/triangle_setup.hpp"
#include "model/study/fill_rule.hpp"

namespace halfplane::proofs_edge_test {
namespace {

using test::is_whole;
using test::report_proof;
using test::tiny;
using test::tiny_widths;
using test::vertex_at;

/// How many cases there were, in how many a sample was drawn twice, and in how many not at all.
struct Tally {
  std::uint64_t cases = 0, twice = 0, lost = 0;
};

/// Every edge whose ends lie in [low, high) of the sample along each axis, in subpixels, seen from its two sides.
template <class Bias>
Tally edges_round_a_sample(int low, int high, Bias bias) {
  const int s = tiny_widths().grid_bits, centre = 1 << (s - 1);  // of pixel (0, 0)
  Tally tally;
  for (int from_y = centre + low; from_y < centre + high; ++from_y)
    for (int from_x = centre + low; from_x < centre + high; ++from_x)
      for (int to_y = from_y; to_y < centre + high; ++to_y)  // the others are the same edges, named from the other end
        for (int to_x = centre + low; to_x < centre + high; ++to_x) {
          const SnappedVertex from = vertex_at(from_x, from_y), to = vertex_at(to_x, to_y);
          const bool is_ours = edge_function(from, to, 0, 0, s, bias(from, to)) >= 0;
          const bool is_theirs = edge_function(to, from, 0, 0, s, bias(to, from)) >= 0;
          const bool is_edge = from_x != to_x || from_y != to_y;
          tally.cases += is_edge;
          tally.twice += is_edge && is_ours && is_theirs;
          tally.lost += is_edge && !is_ours && !is_theirs;
        }
  return tally;
}

constexpr int top_left_bias(const SnappedVertex& from, const SnappedVertex& to) {
  return is_top_left(from, to) ? 0 : 1;
}

TEST(Proofs, AnEdgeGivesEachSampleToExactlyOneOfItsTwoSides) {
  // Whole: all that a sample of the target can see of the guard band.
  const int s = tiny_widths().grid_bits, centre = 1 << (s - 1);
  const int last = ((tiny().target_width - 1) << s) + centre;
  const int low = is_whole() ? static_cast<int>(tiny_widths().coordinate.range.lo) - last : -24;
  const int high = is_whole() ? static_cast<int>(tiny_widths().coordinate.range.hi) - centre + 1 : 25;
  const Tally tally = edges_round_a_sample(low, high, top_left_bias);
  EXPECT_EQ(tally.twice, 0U);
  EXPECT_EQ(tally.lost, 0U);
  report_proof("(b) an edge gives a sample to exactly one of its sides", tally.cases);
}

TEST(ProofsMustFail, AnEdgeOfAnotherFillRuleGivesSamplesToBothSidesOrToNone) {
  const auto by = [](FillRule rule) {
    return edges_round_a_sample(
        -6, 7, [rule](const auto& from, const auto& to) { return edge_bias(from, to, rule, tiny_widths().grid_bits); });
  };
  EXPECT_GT(by(FillRule::inclusive).twice, 0U);
  EXPECT_GT(by(FillRule::offset_point).lost, 0U);
}

/// A triangle of positive area, as bits over the samples of a grid.
struct Masks {
  std::uint32_t covered = 0;
  std::uint32_t interior = 0;  // all three exact areas with the sample are positive
  std::uint32_t on_edge = 0;   // on the first edge, between its ends
};

Masks masks_of(const std::array<SnappedVertex, 3>& v, int pixels, FillRule rule) {
  const int s = tiny_widths().grid_bits, centre = 1 << (s - 1);
  Masks masks;
  for (int y = 0; y < pixels; ++y)
    for (int x = 0; x < pixels; ++x) {
      const SnappedVertex sample = vertex_at((x << s) + centre, (y << s) + centre);
      bool is_covered = true;
      std::array<std::int64_t, 3> exact{};
      for (std::size_t e = 0; e < 3; ++e) {
        const SnappedVertex &from = v[e], &to = v[(e + 1) % 3];
        is_covered &= edge_function(from, to, x, y, s, edge_bias(from, to, rule, s)) >= 0;
        exact[e] = signed_area(from, to, sample);
      }
      const std::uint32_t bit = 1U << (y * pixels + x);
      const bool is_between = exact[1] > 0 && exact[2] > 0;
      masks.covered |= is_covered ? bit : 0;
      masks.interior |= exact[0] > 0 && is_between ? bit : 0;
      masks.on_edge |= exact[0] == 0 && is_between ? bit : 0;
    }
  return masks;
}

/// Every two triangles on an edge, their third vertices on either side, all vertices in an n x n grid of subpixels.
Tally pairs_on_an_edge(int n, FillRule rule) {
  const int pixels = n >> tiny_widths().grid_bits, points = n * n;
  const auto at = [n](int point) { return vertex_at(point % n, point / n); };
  Tally tally;
  std::vector<Masks> ours, theirs;
  for (int from = 0; from < points; ++from)
    for (int to = 0; to < points; ++to) {
      ours.clear();
      theirs.clear();
      for (int apex = 0; apex < points; ++apex) {
        const std::int64_t area = signed_area(at(from), at(to), at(apex));
        if (area > 0) ours.push_back(masks_of({at(from), at(to), at(apex)}, pixels, rule));
        if (area < 0) theirs.push_back(masks_of({at(to), at(from), at(apex)}, pixels, rule));
      }
      for (const Masks& a : ours)
        for (const Masks& b : theirs) {
          const std::uint32_t in_union = a.interior | b.interior | (a.on_edge & b.on_edge);
          ++tally.cases;
          tally.twice += (a.covered & b.covered) != 0;
          tally.lost += (in_union & ~(a.covered | b.covered)) != 0;
        }
    }
  return tally;
}

TEST(Proofs, TwoTrianglesOnAnEdgeCoverEachSampleOfTheirUnionOnce) {
  const Tally tally = pairs_on_an_edge(is_whole() ? 13 : 8, FillRule::top_left);
  EXPECT_EQ(tally.twice, 0U);
  EXPECT_EQ(tally.lost, 0U);
  report_proof("(b) two triangles on an edge cover a sample of their union once", tally.cases);
}

TEST(ProofsMustFail, TwoTrianglesOnAnEdgeOfTheInclusiveRuleCoverASampleTwice) {
  EXPECT_GT(pairs_on_an_edge(5, FillRule::inclusive).twice, 0U);
  EXPECT_GT(pairs_on_an_edge(7, FillRule::offset_point).lost, 0U);
}

/// The smallest and the largest edge value over an edge and a sample anywhere in the guard band. E is affine in each of
/// the six coordinates alone, so its extremes are among the 64 corners.
template <class Visit>
void for_corners(const Widths& widths, Visit visit) {
  const auto lo = static_cast<std::int64_t>(widths.coordinate.range.lo);
  const auto hi = static_cast<std::int64_t>(widths.coordinate.range.hi);
  for (unsigned corner = 0; corner < 64; ++corner) {
    const auto coordinate = [&](unsigned bit) { return (corner >> bit & 1U) != 0 ? hi : lo; };
    const std::int64_t dx = coordinate(2) - coordinate(0), dy = coordinate(3) - coordinate(1);
    const std::int64_t to_x = coordinate(4) - coordinate(0), to_y = coordinate(5) - coordinate(1);
    visit(dx, dy, dx * to_y - dy * to_x);
  }
}

bool holds(const Width& width, std::int64_t value) { return width.range.lo <= value && value <= width.range.hi; }

TEST(Proofs, EdgeValuesOverTheWholeGuardBandStayInTheirRangeAndReachItsEnds) {
  std::uint64_t cases = 0;
  for (const auto name : preset_names()) {
    const Widths widths = derive_widths(preset(name));
    std::int64_t largest = 0;
    for_corners(widths, [&](std::int64_t dx, std::int64_t dy, std::int64_t exact) {
      EXPECT_TRUE(holds(widths.delta, dx) && holds(widths.delta, dy));
      EXPECT_TRUE(holds(widths.edge_value, exact >> widths.grid_bits));
      EXPECT_TRUE(holds(widths.edge_value, (exact - 1) >> widths.grid_bits));
      largest = std::max(largest, exact);
      ++cases;
    });
    EXPECT_EQ(largest, static_cast<std::int64_t>(widths.area.range.hi))
        << name << ": no bound wider than what is reached";
  }
  report_proof("(e) edge values at the corners of their domain, every preset", cases);
}

TEST(ProofsMustFail, EdgeValuesLeaveARangeThatIsOneBitShort) {
  const Widths& widths = tiny_widths();
  Width narrow = widths.edge_value;
  narrow.range = {narrow.range.lo / 2, narrow.range.hi / 2};
  bool is_left = false;
  for_corners(widths, [&](std::int64_t, std::int64_t, std::int64_t exact) {
    is_left |= !holds(narrow, exact >> widths.grid_bits);
  });
  EXPECT_TRUE(is_left);
}

/// Areas whose reciprocal, rounded by `round` (1: to nearest, 0: down), is out of range or further than half from 2^k / A.
std::uint64_t bad_reciprocals(int round) {
  const int bits = tiny().depth_bits + tiny().reciprocal_extra_bits;
  std::uint64_t bad = 0;
  for (std::int64_t area = 1; area <= static_cast<std::int64_t>(tiny_widths().area.range.hi); ++area) {
    Reciprocal r = reciprocal(area, bits);
    const std::int64_t power = std::int64_t{1} << r.shift;
    if (round == 0) r.value = static_cast<std::uint64_t>(power / area);
    const std::int64_t error = static_cast<std::int64_t>(r.value) * area - power;
    const bool is_normal = r.value >= std::uint64_t{1} << (bits - 1) &&
                           holds(tiny_widths().reciprocal, static_cast<std::int64_t>(r.value));
    bad += !is_normal || !holds(tiny_widths().reciprocal_shift, r.shift) || 2 * std::abs(error) > area;
  }
  return bad;
}

TEST(Proofs, ReciprocalOfEveryAreaIsTheNearestAndInItsRange) {
  EXPECT_EQ(bad_reciprocals(1), 0U);
  report_proof("(e) reciprocals of every area, nearest and in range",
               static_cast<std::uint64_t>(tiny_widths().area.range.hi));
}

TEST(ProofsMustFail, ReciprocalsRoundedDownAreNotTheNearest) { EXPECT_GT(bad_reciprocals(0), 0U); }

}  // namespace
}  // namespace halfplane::proofs_edge_test
