// The fewest bits of depth that keep the surfaces of a scene in order.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "sim/study/depth/measure.hpp"

namespace halfplane {

/// The fewest bits of one mapping, stored as `u<bits>`.
struct FewestBits {
  DepthMapping mapping = DepthMapping::std;
  std::optional<int> bits;         ///< 8 to 32; none: 32 are not enough
  std::uint64_t pairs = 0;         ///< overlapping pairs of fragments
  double rate = 0;                 ///< fraction of them that fight with `bits`; with 32 if there are none
  std::optional<double> one_less;  ///< fraction that fights with one bit less; none: 8 are enough
  bool is_in_rtl = false;          ///< the RTL stores this mapping
};

/// The interpolated depth stored without `depth.format`: `u<depth.bits>`, mapped by `std`, or by `stdinf` where the far
/// plane is infinite.
[[nodiscard]] DepthVariant stored_plane(const Config& config, const DepthPlanes& planes);

/// For each mapping the least number of bits with which less than `rate` of the overlapping pairs of fragments fight,
/// by bisection: assumes that fights decrease with each bit. Throws as measure_depths(). Empty if `progress` ended the
/// study.
[[nodiscard]] std::vector<FewestBits> fewest_depth_bits(const Scene& scene, const Config& config,
                                                        std::span<const DepthMapping> mappings,
                                                        const DepthPlanes& planes, double rate, int threads,
                                                        const std::function<void(double fraction)>& progress = {});

}  // namespace halfplane
