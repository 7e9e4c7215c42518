// A mismatch in readable form: place, model above RTL, the differing bits marked.
#pragma once

#include <string>
#include <vector>

#include "sim/cosim/junit.hpp"
#include "sim/cosim/lockstep.hpp"

namespace halfplane {

/// One line: "fine_raster: mask differs in packet 12 of stamp, primitive 3, tile (4, 2), stamp 5, cycle 678".
[[nodiscard]] std::string mismatch_line(const Mismatch& mismatch);

/// The full report, in lines of at most 120 characters.
[[nodiscard]] std::string mismatch_report(const Mismatch& mismatch);

/// "triangle 12 · setup 12 · ...": the compared packets, arrow by arrow.
[[nodiscard]] std::string compared_report(const LockstepResult& result);

/// The fate of a mismatch: that of the reduced scene, and the text for a person.
struct JunitFinding {
  const Mismatch& mismatch;
  std::string report;
};

/// A test case for each arrow, the memory image and the counters, and one that fails when nothing was compared. With a
/// finding that case fails, not the first symptom.
[[nodiscard]] std::vector<JunitCase> junit_cases(const LockstepResult& result, const JunitFinding* finding = nullptr);

}  // namespace halfplane
