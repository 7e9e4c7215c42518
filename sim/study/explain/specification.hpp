// The specification's part of an explanation: the scene once through the host's stages, and the primitives near a pixel
// through the other stages at that pixel only.
#pragma once

#include <unordered_set>
#include <vector>

#include "explain.hpp"

namespace halfplane::explain {

struct SpecificationRecord {
  std::vector<PixelHistory> pixels;        ///< history and model
  std::unordered_set<std::uint32_t> near;  ///< input primitives named in a history
  std::uint64_t primitives = 0;            ///< of the scene
};

[[nodiscard]] SpecificationRecord record_specification(const Scene& scene, const Config& config,
                                                       const std::vector<Pixel>& pixels, const Options& options,
                                                       std::vector<std::string>& differences, std::uint64_t& checks);

}  // namespace halfplane::explain
