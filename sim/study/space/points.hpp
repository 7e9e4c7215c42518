// A point of the design space: one configuration on one scene, with its error and the cost of a frame.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "model/config.hpp"
#include "model/timing/memory.hpp"
#include "sim/study/bench/rows.hpp"

namespace halfplane {

using SpaceJson = nlohmann::ordered_json;

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

// The Pareto front of a design space: the points that no other point beats.

/// The figure of a point by its name, "cycles", "ecp5.places"; none if missing.
[[nodiscard]] std::optional<double> figure(const SpaceJson& point, const std::string& name);

/// The names of figures that every point has, in the order of the first point.
[[nodiscard]] std::vector<std::string> figures_of(const SpaceJson& points);

/// The default axes: the error of depth in eye space (or of the depth range, for a scene without eye space), cycles
/// and, if gates were counted, ECP5 places and block RAMs.
[[nodiscard]] std::vector<std::string> default_axes(const SpaceJson& points);

/// Sets `on_front` of every point. A point beats another of the same scene when no figure of `axes` is worse, one is
/// better, and it has all abilities (`abilities`: a unit less is cheaper and does less). Points that lack a figure are
/// on no front.
void mark_front(SpaceJson& points, const std::vector<std::string>& axes);

}  // namespace halfplane
