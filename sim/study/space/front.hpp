// The Pareto front of a design space: the points that no other point beats.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace halfplane {

using SpaceJson = nlohmann::ordered_json;

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
