// Answers in words: what a way of keeping depth loses on a scene, where, and what would help, each tried.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/study/depth/fewest_bits.hpp"
#include "sim/study/depth/measure.hpp"

namespace halfplane {

/// One change that was tried, and what it measured.
struct DepthTrial {
  std::string what;     ///< "one more bit"
  std::string options;  ///< how to try it: "--format u17"
  DepthVariant variant;
  DepthMeasurement result;
};

/// Another near plane, reversed float, w, one more bit, two more subpixel bits, each at the same storage unless its name
/// says otherwise; those that `base` does not have already, and that a study ended early came to. Best first: fewest fights,
/// to a tenth of a percent of the pairs, then the least rms error.
[[nodiscard]] std::vector<DepthTrial> try_changes(const Scene& scene, const DepthVariant& base,
                                                  const DepthMeasurement& measured, int threads,
                                                  const std::function<void(double fraction)>& progress);

/// How many bits are enough, of the first mapping and then of the others: at which near plane, what one bit less costs, whether
/// the RTL stores them. One sentence, and that another view may need more.
[[nodiscard]] std::string fewest_bits_answer(std::span<const FewestBits> fewest, const DepthPlanes& planes,
                                             double rate);

/// What a variant loses and what would help: two or three sentences.
[[nodiscard]] std::vector<std::string> depth_answers(const DepthVariant& base, const DepthMeasurement& measured,
                                                     const std::vector<DepthTrial>& trials);

/// The fights of a scene against one thing that hardware can spend: for each mapping a line of {x, rate}.
struct DepthSweep {
  std::string what, unit;
  struct Line {
    std::string name;
    std::vector<double> x, rate;
  };
  std::vector<Line> lines;
};

/// Over storage bits, each mapping as u<b> and reversed small floats beside them, and over subpixel bits at `bits`.
[[nodiscard]] std::vector<DepthSweep> sweep_depth(const Scene& scene, const Config& config,
                                                  const std::vector<DepthMapping>& mappings, int bits,
                                                  const DepthPlanes& planes, int threads,
                                                  const std::function<void(double fraction)>& progress);

}  // namespace halfplane
