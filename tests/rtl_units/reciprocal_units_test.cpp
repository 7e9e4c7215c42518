// The reciprocal units of the RTL give the floor for every mantissa; a unit with a fault does not.
#include <gtest/gtest.h>
#include <verilated.h>

#include <array>
#include <cstdint>

#include "VReciprocalUnits.h"
#include "model/stages/reciprocal.hpp"

namespace halfplane {
namespace {

constexpr std::array kBits{8, 13, 14, 16, 18, 20};
constexpr std::size_t kFaults = 3;
constexpr int kFaultBits = 14;
constexpr std::uint32_t kMantissas = 1U << 19;  // mantissas of k = 20; with fewer bits each occurs several times

/// Value number n of a port that holds 20 bits for each.
template <class Port>
std::uint32_t value_of(const Port& port, std::size_t n) {
  std::uint32_t value = 0;
  for (std::size_t bit = 0; bit < 20; ++bit) {
    const std::size_t at = 20 * n + bit;
    value |= static_cast<std::uint32_t>(port[at / 32] >> (at % 32) & 1U) << bit;
  }
  return value;
}
template <>
std::uint32_t value_of(const QData& port, std::size_t n) {
  return static_cast<std::uint32_t>(port >> (20 * n) & 0xfffffU);
}

/// r of the mantissa whose bits below the highest are the lowest of `low`.
std::uint32_t expected(std::uint32_t low, int bits) {
  const std::uint32_t highest = 1U << (bits - 1);
  return mantissa_reciprocal(highest | (low & (highest - 1)), bits);
}

/// In how many cases each unit was wrong.
struct Tally {
  std::array<std::uint64_t, kBits.size()> wrong{};
  std::array<std::uint64_t, kFaults> fault{};

  template <class Port, class FaultPort>
  void compare(std::uint32_t mantissa, const Port& port, const FaultPort& faults) {
    for (std::size_t i = 0; i < kBits.size(); ++i) wrong[i] += value_of(port, i) != expected(mantissa, kBits[i]);
    for (std::size_t i = 0; i < kFaults; ++i) fault[i] += value_of(faults, i) != expected(mantissa, kFaultBits);
  }
  void judge() const {
    for (std::size_t i = 0; i < kBits.size(); ++i) EXPECT_EQ(wrong[i], 0U) << "k = " << kBits[i];
    for (std::size_t i = 0; i < kFaults; ++i) EXPECT_GT(fault[i], 0U) << "fault " << i << " is not found";
  }
};

class ReciprocalUnits : public testing::Test {
 protected:
  void SetUp() override {
    dut.rst_ni = 0;
    clock();
    dut.rst_ni = 1;
  }
  void TearDown() override { dut.final(); }
  void clock() {
    dut.clk_i = 0;
    dut.eval();
    dut.clk_i = 1;
    dut.eval();
  }

  VReciprocalUnits dut;
};

TEST_F(ReciprocalUnits, TheTableAndTheRowOfSubtractionsGiveAFloorEachClock) {
  constexpr std::uint32_t kLatency = 4;
  Tally table, row;
  for (std::uint32_t n = 0; n < kMantissas + kLatency - 1; ++n) {
    dut.mantissa_i = n & (kMantissas - 1);
    clock();
    if (n + 1 < kLatency) continue;
    table.compare(n + 1 - kLatency, dut.table_o, dut.table_faults_o);
    row.compare(n + 1 - kLatency, dut.division_o, dut.division_faults_o);
  }
  table.judge();
  row.judge();
}

TEST_F(ReciprocalUnits, TheDivisionGivesAFloorAfterKClocksAndKeepsIt) {
  Tally tally;
  for (std::uint32_t n = 0; n < kMantissas; ++n) {
    dut.mantissa_i = n;
    dut.valid_i = 1;
    dut.ready_i = 0;
    clock();
    dut.valid_i = 0;
    dut.mantissa_i = ~n & (kMantissas - 1);  // only the accepted value counts
    for (int clocks = 1; clocks < kBits.back(); ++clocks) {
      for (std::size_t i = 0; i < kBits.size(); ++i) {
        ASSERT_EQ(dut.restoring_valid_o >> i & 1, clocks >= kBits[i]) << "k = " << kBits[i] << " behind " << clocks;
        ASSERT_EQ(dut.restoring_ready_o >> i & 1, 0) << "k = " << kBits[i];
      }
      clock();
    }
    tally.compare(n, dut.restoring_o, dut.restoring_faults_o);
    dut.ready_i = 1;
    clock();
    ASSERT_EQ(dut.restoring_valid_o, 0);
    ASSERT_EQ(dut.restoring_ready_o, 63);
  }
  tally.judge();
}

}  // namespace
}  // namespace halfplane
