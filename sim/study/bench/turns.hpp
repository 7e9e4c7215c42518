// Measurement of run times: frames of all candidates in turns, medians.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <span>
#include <vector>

namespace halfplane {

struct FrameCost {
  double seconds = 0;        ///< by the wall clock
  std::uint64_t cycles = 0;  ///< of the hardware; 0: the engine has none
};

/// Renders one frame, clear included.
using Frame = std::function<FrameCost()>;

/// The measured frames.
struct FrameTimes {
  std::vector<double> seconds;  ///< in order of time; empty if refused
  std::uint64_t cycles = 0;     ///< cycles of the last turn
  std::exception_ptr refusal;   ///< the InputError or missing tool that ended its first frame

  /// Seconds; of an even number the mean of the middle two. At least a nanosecond, so that rates are finite.
  [[nodiscard]] double median() const;
  [[nodiscard]] double min() const;
};

/// A frame whose warm-up takes longer than this, seconds, is not rendered again: that frame is its only measurement.
inline constexpr double kSlowFrame = 2;

/// Before each measurement of a frame shorter than kShortFrame, frames are rendered unmeasured for kWarmUp, both in
/// seconds: caches and threads are then as after a preceding frame, not as after a second of other work.
inline constexpr double kShortFrame = 0.1, kWarmUp = 0.02;

/// Measures every frame `repeat` times, in turns, so that other load of the machine affects all of them equally; the
/// first turn warms up. A frame that throws a std::runtime_error there is left out. `progress` gets 0...1; may be
/// empty. Interrupted, thrown there or by a frame, ends it: frames not measured by then have no seconds.
[[nodiscard]] std::vector<FrameTimes> measure_in_turns(std::span<const Frame> frames, int repeat,
                                                       const std::function<void(double)>& progress = {});

}  // namespace halfplane
