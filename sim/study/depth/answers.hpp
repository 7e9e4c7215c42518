// Answers in words: the errors of a depth format on a scene, their place, and remedies, each tried.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/study/depth/fewest_bits.hpp"
#include "sim/study/depth/measure.hpp"

namespace halfplane {

/// One change that was tried, and its measurement.
struct DepthTrial {
  std::string what;     ///< "one more bit"
  std::string options;  ///< how to try it: "--format u17"
  DepthVariant variant;
  DepthMeasurement result;
};

/// Another near plane, reversed float, w, one more bit, two more subpixel bits, each at the same storage unless its
/// name says otherwise; without answers that `base` already has, and answers that a study ended early did not reach. Best
/// first: fewest fights, to a tenth of a percent of the pairs, then the least rms error.
[[nodiscard]] std::vector<DepthTrial> try_changes(const Scene& scene, const DepthVariant& base,
                                                  const DepthMeasurement& measured, int threads,
                                                  const std::function<void(double fraction)>& progress);

/// The sufficient number of bits, for the first mapping and then for the others: at which near plane, the cost of one
/// bit less, whether the RTL stores them. One sentence, with a note that another view may need more.
[[nodiscard]] std::string fewest_bits_answer(std::span<const FewestBits> fewest, const DepthPlanes& planes,
                                             double rate);

/// The errors of a variant and the remedies: two or three sentences.
[[nodiscard]] std::vector<std::string> depth_answers(const DepthVariant& base, const DepthMeasurement& measured,
                                                     const std::vector<DepthTrial>& trials);

/// The fights of a scene as a function of one hardware resource: for each mapping a line of {x, rate}.
struct DepthSweep {
  std::string what, unit;
  struct Line {
    std::string name;
    std::vector<double> x, rate;
  };
  std::vector<Line> lines;
};

/// Over storage bits, each mapping as u<b>, also reversed small floats, and over subpixel bits at `bits`.
[[nodiscard]] std::vector<DepthSweep> sweep_depth(const Scene& scene, const Config& config,
                                                  const std::vector<DepthMapping>& mappings, int bits,
                                                  const DepthPlanes& planes, int threads,
                                                  const std::function<void(double fraction)>& progress);

}  // namespace halfplane
