// The oracle by itself: figures worked out by hand, and properties that any right coverage rule has.
#include "model/golden/exact.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace halfplane::exact_test {
namespace {

/// Coordinates in half pixels: grid_bits = 1.
Triangle triangle(std::array<std::array<std::int32_t, 2>, 3> xy, std::array<std::uint32_t, 3> z = {0, 0, 0}) {
  Triangle t;
  for (std::size_t i = 0; i < 3; ++i) {
    t.v[i].x = xy[i][0];
    t.v[i].y = xy[i][1];
    t.v[i].depth() = z[i];
  }
  return t;
}

TEST(Exact, TopAndLeftBorderBelongAndRightAndBottomDoNot) {
  // A square from centre (0, 0) to centre (4, 4), as two triangles.
  const Triangle upper = triangle({{{1, 1}, {9, 1}, {1, 9}}}), lower = triangle({{{9, 1}, {9, 9}, {1, 9}}});
  for (int y = -1; y <= 5; ++y) {
    for (int x = -1; x <= 5; ++x) {
      const int count = exact::covers(upper, x, y, 1) + exact::covers(lower, x, y, 1);
      EXPECT_EQ(count, x >= 0 && x < 4 && y >= 0 && y < 4 ? 1 : 0) << x << ", " << y;
    }
  }
}

TEST(Exact, AllSixVertexOrdersCoverTheSame) {
  const std::array<std::array<std::int32_t, 2>, 3> corner{{{1, 1}, {9, 3}, {3, 9}}};
  std::array<std::size_t, 3> order{0, 1, 2};
  const Triangle reference = triangle(corner, {10, 200, 3000});
  do {
    const Triangle t = triangle({corner[order[0]], corner[order[1]], corner[order[2]]});
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 5; ++x) EXPECT_EQ(exact::covers(t, x, y, 1), exact::covers(reference, x, y, 1));
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_TRUE(exact::covers(reference, 1, 1, 1));
}

TEST(Exact, ZeroAreaCoversNothing) {
  EXPECT_FALSE(exact::covers(triangle({{{1, 1}, {5, 5}, {9, 9}}}), 1, 1, 1));
  EXPECT_FALSE(exact::covers(triangle({{{3, 3}, {3, 3}, {3, 3}}}), 1, 1, 1));
}

TEST(Exact, BorderIsTheClosedTriangleWithoutItsInside) {
  const Triangle t = triangle({{{1, 1}, {9, 1}, {1, 9}}});
  EXPECT_TRUE(exact::is_on_border(t, 0, 0, 1));   // a vertex
  EXPECT_TRUE(exact::is_on_border(t, 2, 0, 1));   // the top edge
  EXPECT_FALSE(exact::is_on_border(t, 1, 1, 1));  // inside
  EXPECT_FALSE(exact::is_on_border(t, 6, 0, 1));  // on the line of the top edge, beyond its end
}

TEST(Exact, DepthIsTheExactQuotientForBothWindings) {
  // 0 at the left vertex, 7 over a run of 3 pixels: at one pixel in, 7/3.
  for (const bool mirrored : {false, true}) {
    const std::int32_t s = mirrored ? -1 : 1;
    const Triangle t = triangle({{{1, 1}, {7, 1 + 6 * s}, {7, 1 - 6 * s}}}, {0, 7, 7});
    const exact::Rational z = exact::depth_at(t, 1, 0, 1);
    EXPECT_TRUE(z.numerator * 3 == z.denominator * 7);
    EXPECT_EQ(exact::on_grid(z), (7 * (std::int64_t{1} << 20) + 1) / 3);  // 7/3 * 2^20 = 2446677.33: rounds down
  }
}

TEST(Exact, GridRoundsHalvesUpOnBothSidesOfZero) {
  const int128 one = int128{1} << 21;  // half a grid step is 1 / 2^21
  EXPECT_EQ(exact::on_grid({1, one}), 1);
  EXPECT_EQ(exact::on_grid({-1, one}), 0);
  EXPECT_EQ(exact::on_grid({-3, one}), -1);
  EXPECT_EQ(exact::on_grid({-2, one}), -1);
  EXPECT_EQ(exact::on_grid({255, 1}, 31, 255), 31 * (std::int64_t{1} << 20));
}

TEST(Exact, LargestCoordinatesAndCodesDoNotOverflow) {
  constexpr std::int32_t kFar = (std::int32_t{1} << 30) - 1;
  const Triangle t = triangle({{{-kFar - 1, -kFar - 1}, {kFar, -kFar - 1}, {-kFar - 1, kFar}}},
                              {0xffffffffu, 0xffffffffu, 0xffffffffu});
  EXPECT_TRUE(exact::covers(t, -5, -7, 1));
  EXPECT_FALSE(exact::covers(t, 5, 7, 1));
  EXPECT_EQ(exact::on_grid(exact::depth_at(t, -5, -7, 1)), std::int64_t{0xffffffff} << 20);
}

TEST(Exact, ColorPlaneReadsItsOwnChannel) {
  Triangle t = triangle({{{0, 0}, {8, 0}, {0, 8}}});
  t.v[0].code = {0, 0, 10, 20, 30};
  t.v[1].code = {0, 80, 10, 20, 30};
  t.v[2].code = {0, 0, 10, 100, 30};
  // Centre (0, 0) is an eighth of the way along both legs.
  for (const auto& [channel, value] : {std::pair{0, 10}, {1, 10}, {2, 30}, {3, 30}})
    EXPECT_EQ(exact::on_grid(exact::color_at(t, 0, 0, 1, channel)), std::int64_t{value} << 20);
}

}  // namespace
}  // namespace halfplane::exact_test
