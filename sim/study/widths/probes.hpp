// Primitives that test widths: random ones, directed extremes, and small changes of one.
#pragma once

#include <vector>

#include "model/config.hpp"
#include "sim/scene/random.hpp"
#include "sim/study/widths/observer.hpp"

namespace halfplane {

/// Makes probes inside the guard band, the same for the same seed on every machine.
class ProbeMaker {
 public:
  ProbeMaker(const Config& config, std::uint64_t seed);

  /// A random probe, with frequent ends of ranges, near-equal coordinates, slivers and pixel centres; one in three is a
  /// line.
  [[nodiscard]] Probe random();
  /// Changes one to three of its numbers: to an end of the range, by a power of two, or to that of another vertex.
  [[nodiscard]] Probe changed(Probe probe);

 private:
  [[nodiscard]] int below(int count) { return static_cast<int>(random_.next() % static_cast<std::uint64_t>(count)); }
  [[nodiscard]] std::int32_t coordinate();
  [[nodiscard]] std::int32_t legal(std::int64_t subpixels) const;
  [[nodiscard]] std::uint32_t depth();

  Random random_;
  int grid_bits_;
  std::int32_t low_, high_;  // of a coordinate, subpixels
  std::int32_t odd_mask_;    // clears impossible bits of a coordinate: at S = 0 all are even
  std::uint32_t depth_max_;
  Widths widths_;
};

/// The corners of the guard band in every combination, full depth across them, area 1 across the whole band, lines from
/// corner to corner and of one subpixel.
[[nodiscard]] std::vector<Probe> extreme_probes(const Config& config);

/// The probe as a scene that snaps to it, for a capture: window space, on the configuration's whole target.
[[nodiscard]] Scene probe_scene(const Probe& probe, const Config& config);

}  // namespace halfplane
