// Explain: the reasons for a pixel's value. All primitives near it, in program order, by the specification, the
// hardware model, the golden, the oracle and, with a design, the RTL; each compared with the others.
#pragma once

#include <functional>

#include "history.hpp"
#include "model/study/rules.hpp"
#include "sim/cosim/dut.hpp"

namespace halfplane::explain {

struct Options {
  double near = 1;           ///< pixels: distance at which a primitive is still reported; at least 1
  StudyRules rules;          ///< of the specification; the hardware has only its own, the golden its own fill rule
  bool wants_steps = false;  ///< for lines and triangles: every pixel
  Dut* rtl = nullptr;        ///< of exactly this configuration
  std::uint16_t mutant = 0;  ///< the fault in it
  std::function<void(double fraction)> progress;  ///< 0...1 over all of it; may be empty, may throw to end the work
};

/// Throws InputError, naming the first pixel outside the target.
void require_inside(const Scene& scene, const std::vector<Pixel>& pixels);

/// Throws InputError for a pixel outside the target, for a scene that the engines refuse and, with an RTL, for a scene
/// or rules that the hardware does not support.
[[nodiscard]] Explanation explain(const Scene& scene, const Config& config, const std::vector<Pixel>& pixels,
                                  const Options& options = {});

}  // namespace halfplane::explain
