// A point of the design space: one configuration on one scene, with its error and the cost of a frame.
#pragma once

#include <map>
#include <string>

#include "model/config.hpp"
#include "model/timing/memory.hpp"
#include "sim/study/bench/rows.hpp"
#include "sim/study/space/front.hpp"

namespace halfplane {

/// Data shared by all points, so that nothing is computed twice.
class PointStudy {
 public:
  explicit PointStudy(const MemorySettings& memory) : memory_(memory) {}

  /// Errors (as of `compare`), cycles and bytes of a whole frame in the cycle engine, milliseconds at the memory's
  /// clock, and the abilities of the hardware; without gates. Throws InputError for a scene that this hardware does not
  /// support.
  [[nodiscard]] SpaceJson measure(const BenchCase& at, const std::function<void(double)>& progress);

 private:
  const BenchFacts& facts_of(const BenchCase& at, const Rendering& picture,
                             const std::function<void(double)>& progress);

  MemorySettings memory_;
  std::map<std::string, BenchFacts> facts_;
};

/// Every key of --vary with its value, from a `label` like "depth.bits=24 stamp.size=4".
[[nodiscard]] SpaceJson settings_of(const std::string& label);

}  // namespace halfplane
