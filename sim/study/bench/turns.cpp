#include "sim/study/bench/turns.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "sim/interrupt.hpp"

namespace halfplane {
namespace {

constexpr double kNanosecond = 1e-9;  // an empty scene may take less than the clock's resolution

void warm_up(const Frame& frame) {
  using Clock = std::chrono::steady_clock;
  const auto started = Clock::now();
  do frame();
  while (std::chrono::duration<double>(Clock::now() - started).count() < kWarmUp);
}

}  // namespace

double FrameTimes::median() const {
  if (seconds.empty()) return kNanosecond;
  auto sorted = seconds;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t middle = sorted.size() / 2;
  const double median = sorted.size() % 2 != 0 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
  return std::max(median, kNanosecond);
}

double FrameTimes::min() const {
  return seconds.empty() ? kNanosecond : std::max(*std::min_element(seconds.begin(), seconds.end()), kNanosecond);
}

std::vector<FrameTimes> measure_in_turns(std::span<const Frame> frames, int repeat,
                                         const std::function<void(double)>& progress) {
  std::vector<FrameTimes> times(frames.size());
  std::vector<bool> is_done(frames.size());
  std::vector<double> last(frames.size());  // seconds
  const double all = static_cast<double>(frames.size()) * (repeat + 1);
  const auto measure = [&](int turn, std::size_t i) {
    if (progress)
      progress((static_cast<double>(turn) * static_cast<double>(frames.size()) + static_cast<double>(i)) / all);
    if (is_done[i]) return;
    try {
      if (turn > 0 && last[i] < kShortFrame) warm_up(frames[i]);
      const FrameCost cost = frames[i]();
      last[i] = cost.seconds;
      times[i].cycles = cost.cycles;
      is_done[i] = turn == 0 && cost.seconds > kSlowFrame;
      if (turn > 0 || is_done[i]) times[i].seconds.push_back(cost.seconds);
    } catch (const std::runtime_error&) {
      if (turn > 0) throw;
      times[i].refusal = std::current_exception();
      is_done[i] = true;
    }
  };
  try {
    for (int turn = 0; turn <= repeat; ++turn)
      for (std::size_t i = 0; i < frames.size(); ++i) measure(turn, i);
  } catch (const Interrupted&) {  // the frames so far count
  }
  return times;
}

}  // namespace halfplane
