#include "statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace halfplane {
namespace {

constexpr double kStepsPerLsb = 1 << 20;  // steps of a PartSet per LSB

}  // namespace

void MomentSet::add(double error) {
  ++count_;
  max_ = std::max(max_, std::abs(error));
  sum_ += error;
  squares_ += error * error;
}

ErrorMoments MomentSet::stats() const {
  if (count_ == 0) return {};
  const auto n = static_cast<double>(count_);
  return {count_, max_, sum_ / n, std::sqrt(squares_ / n)};
}

void ErrorSet::add(double error) {
  moments_.add(error);
  magnitudes_.push_back(static_cast<float>(std::abs(error)));
}

ErrorStats ErrorSet::stats() const {
  ErrorStats stats{moments_.stats(), 0};
  if (magnitudes_.empty()) return stats;
  const auto rank = static_cast<std::size_t>(std::ceil(0.999 * static_cast<double>(magnitudes_.size()))) - 1;
  std::vector<float> order = magnitudes_;
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(rank), order.end());
  stats.p999 = std::min<double>(order[rank], stats.max);  // the float may have been rounded up
  return stats;
}

void PartSet::add(std::int64_t error) {
  const double lsb = static_cast<double>(error) / kStepsPerLsb;
  ++count_;
  max_ = std::max(max_, error < 0 ? -error : error);
  sum_ += error;
  squares_ += lsb * lsb;
}

PartStats PartSet::stats() const {
  if (count_ == 0) return {};
  return {static_cast<double>(max_) / kStepsPerLsb, std::sqrt(squares_ / static_cast<double>(count_)), sum_, count_};
}

}  // namespace halfplane
