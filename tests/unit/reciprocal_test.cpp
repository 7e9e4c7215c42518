// The reciprocal of a normalised 1/w: each way to compute it gives the floor, for every m.
#include "model/stages/reciprocal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace halfplane::reciprocal_test {
namespace {

/// How many mantissas of k bits an algorithm has, and of how many its result is not the floor, by multiplication.
struct Tally {
  std::uint64_t cases = 0, wrong = 0;
};
template <class Algorithm>
Tally every_mantissa(int bits, Algorithm&& algorithm) {
  Tally tally;
  const std::uint64_t whole = std::uint64_t{1} << (2 * bits);
  for (std::uint32_t m = 1U << (bits - 1); m < 1U << bits; ++m) {
    const std::uint64_t d = 2 * std::uint64_t{m} + 1, r = algorithm(m);
    ++tally.cases;
    tally.wrong += r * d > whole || (r + 1) * d <= whole || r >> (bits - 1) != 1;
  }
  return tally;
}

class EveryWidth : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Reciprocal, EveryWidth, testing::Range(kMinMantissaBits, kMaxMantissaBits + 1));

TEST_P(EveryWidth, IsTheFloorWithItsTopBitSet) {
  const int k = GetParam();
  const Tally tally = every_mantissa(k, [k](std::uint32_t m) { return mantissa_reciprocal(m, k); });
  EXPECT_EQ(tally.cases, std::uint64_t{1} << (k - 1));
  EXPECT_EQ(tally.wrong, 0U);
}

TEST_P(EveryWidth, IsWhatLanesDivideInBinary32) {
  const int k = GetParam();
  EXPECT_EQ(every_mantissa(k, [k](std::uint32_t m) { return lane_reciprocal(m, k); }).wrong, 0U);
}

TEST_P(EveryWidth, IsWhatTheTableGivesAfterOneCorrection) {
  const int k = GetParam();
  const ReciprocalTable table(k);
  std::uint64_t one_too_large = 0, other = 0;
  const Tally tally = every_mantissa(k, [&](std::uint32_t m) {
    const std::uint32_t excess = table.guess(m) - mantissa_reciprocal(m, k);
    one_too_large += excess == 1;
    other += excess > 1;
    return table.reciprocal(m);
  });
  EXPECT_EQ(tally.wrong, 0U);
  EXPECT_EQ(other, 0U) << "the guess is right or one too large";
  EXPECT_GT(one_too_large, tally.cases / 8) << "so it has to be corrected";
  // The stored table: the bits of a start below its highest, and of a drop.
  const int nodes = 1 << ((k + 1) / 2);
  ASSERT_EQ(table.lines().size(), static_cast<std::size_t>(nodes));
  for (const ReciprocalTable::Line& line : table.lines()) {
    EXPECT_EQ(line.start >> k, 1U);
    EXPECT_LT(line.drop, 2U << (k / 2));
  }
}

TEST_P(EveryWidth, IsOffTheTrueReciprocalByThreeInTwoToTheKAtMost) {
  const int k = GetParam();
  double worst = 0;
  for (std::uint32_t m = 1U << (k - 1); m < 1U << k; ++m)
    for (const double q : {m + 0.0, m + 1.0}) {  // the ends of the range that m represents
      const double exact = std::ldexp(0.5, 2 * k) / q;
      worst = std::max(worst, std::abs(mantissa_reciprocal(m, k) - exact) / exact);
    }
  EXPECT_LE(std::ldexp(worst, k), 3.0);
  EXPECT_GT(std::ldexp(worst, k), 1.5);
}

TEST(ReciprocalMustFail, WithoutItsCorrectionNeitherLaneNorTableIsTheFloor) {
  for (const int k : {16, 18, 20}) {
    const ReciprocalTable table(k);
    EXPECT_GT(every_mantissa(k, [&](std::uint32_t m) { return table.guess(m); }).wrong, 0U) << k;
    EXPECT_GT(every_mantissa(k, [&](std::uint32_t m) { return table.reciprocal(m ^ 1U); }).wrong, 0U) << k;
  }
  // A quotient of binary32 has 24 bits and r has k: rounding reaches the next integer where k is large.
  const auto quotient = [](std::uint32_t m) {
    return static_cast<std::uint32_t>(0x1p40F / static_cast<float>(reciprocal_divisor(m)));
  };
  EXPECT_GT(every_mantissa(20, quotient).wrong, 0U);
}

}  // namespace
}  // namespace halfplane::reciprocal_test
