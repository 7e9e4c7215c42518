// What light at fragments costs against light at vertices in time: cycles of whole frames.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "model/config.hpp"
#include "model/scene.hpp"

namespace halfplane {

/// Cycles of the frame, of hardware that lights fragments, with the default memory.
struct PerVertexCycles {
  std::uint64_t fragments = 0;     ///< of the scene as it is
  std::uint64_t vertices = 0;      ///< of the same hardware, of the scene lit at its vertices
  std::uint64_t without_unit = 0;  ///< likewise, of hardware with shade.unit=0
  std::vector<std::string> set;    ///< "shade.unit=1": what was changed in the configuration to have the unit
  std::string refused;             ///< why there are no figures: no such hardware, or it does not take the scene
};

/// Runs the cycle engine on hardware of this configuration, with shade.unit and a texture unit that takes the scene set
/// where they are off. `progress` is given 0...1; it may be empty, and may throw to end the work.
[[nodiscard]] PerVertexCycles per_vertex_cycles(const Scene& scene, const Config& config,
                                                const std::function<void(double)>& progress = {});

}  // namespace halfplane
