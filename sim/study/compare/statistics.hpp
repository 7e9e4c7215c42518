// Error statistics: figures that a comparison reports about a set of signed errors.
#pragma once

#include <cstdint>
#include <vector>

#include "model/fixed.hpp"

namespace halfplane {

/// `mean` is signed, the rest absolute. All 0 when nothing was compared: check `count`.
struct ErrorMoments {
  std::uint64_t count = 0;
  double max = 0, mean = 0, rms = 0;
};

/// The same, and the smallest error that at least 99.9 % of all do not exceed.
struct ErrorStats : ErrorMoments {
  double p999 = 0;
};

/// Collects the moments of signed errors in any unit: constant size.
class MomentSet {
 public:
  void add(double error);
  [[nodiscard]] ErrorMoments stats() const;

 private:
  std::uint64_t count_ = 0;
  double max_ = 0, sum_ = 0, squares_ = 0;
};

/// Collects all of ErrorStats: 4 bytes an error.
class ErrorSet {
 public:
  void add(double error);
  [[nodiscard]] ErrorStats stats() const;

 private:
  MomentSet moments_;
  std::vector<float> magnitudes_;  // float: only p999 reads them, and a 4096 x 4096 target has 2^26 channels
};

/// One part of an error, in LSB. `sum` is signed, in 2^-20 LSB and exact: the sums of the parts add up to the total's.
struct PartStats {
  double max = 0, rms = 0;
  int128 sum = 0;
  std::uint64_t count = 0;
};

/// Collects one part of an error, held in integers of 2^-20 LSB.
class PartSet {
 public:
  void add(std::int64_t error);
  [[nodiscard]] PartStats stats() const;

 private:
  std::uint64_t count_ = 0;
  std::int64_t max_ = 0;
  int128 sum_ = 0;
  double squares_ = 0;  // LSB^2
};

}  // namespace halfplane
