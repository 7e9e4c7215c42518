// Depth quantization in the pipeline: every fragment of a scene, its stored code against its exact eye depth.
//
// The functional engine draws the scene and taps the covered samples of each triangle; plane_at and depth_encode, the
// stages, give each sample's depth before rounding and its code. U is the exact eye depth of the unsnapped triangle, S
// that of the plane through the snapped vertices, H the interpolated depth before rounding, D the stored code: as in
// compare.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "model/scene.hpp"
#include "sim/study/compare/statistics.hpp"
#include "sim/study/depth/variant.hpp"

namespace halfplane {

/// Eye-space errors of the fragments between two powers of ten of eye depth.
struct DepthDecade {
  double from = 0, to = 0;
  ErrorStats error;                           ///< D - U
  ErrorMoments snap, interpolation, storage;  ///< its parts
  double bound = 0;                           ///< the largest predicted bound of these
  double worst_share = 0;                     ///< the largest fraction of its own bound that a fragment's error reaches
};

/// Pairs of fragments of one pixel, in the order of their exact eye depths and of their codes. Pairs closer than 1e-12
/// of their depth have no order and do not count.
struct DepthOrder {
  std::uint64_t pairs = 0, ties = 0, inversions = 0;
  std::uint64_t fighting_pixels = 0;  ///< with at least one of either
  double nearest_fight = 0;           ///< the least eye depth of a pair that ties or inverts; 0: none
  [[nodiscard]] std::uint64_t fights() const { return ties + inversions; }
  [[nodiscard]] double rate() const {
    return pairs == 0 ? 0 : static_cast<double>(fights()) / static_cast<double>(pairs);
  }
};

struct DepthMeasurement {
  bool is_whole = false;  ///< false: the members below are invalid, because the study was ended early
  std::uint64_t fragments = 0, triangles = 0;
  /// Samples left out: covered by the snapped triangle where the true one is behind the eye; and, from the errors only,
  /// fragments with a code for infinity or for no depth.
  std::uint64_t beyond = 0;
  double eye_min = 0, eye_max = 0;
  ErrorStats total;                           ///< D - U, eye-space units
  ErrorMoments snap, interpolation, storage;  ///< S - U, H - S, D - H: they sum to the total
  std::vector<DepthDecade> decades;           ///< the decades with fragments
  double worst_share = 0;                     ///< of the predicted bound, over all fragments
  DepthOrder order;
  std::uint64_t stage_mismatches = 0;  ///< pixels whose stored code differs from the stages'
  std::vector<float> error;            ///< per pixel, D - U of the visible fragment, NaN for none; if requested
  std::vector<std::uint8_t> fights;    ///< per pixel: 0 no pair, 1 all in order, 2 a tie, 3 an inversion; if requested
};

struct MeasureOptions {
  bool wants_errors = true;  ///< false: only the order, in half the time
  bool wants_maps = false;
  /// Called from the measuring thread; may be empty. Interrupted, thrown there, ends the study.
  std::function<void(double fraction)> progress;
};

/// `scene`: without a mapping; the variant's mapping and planes are applied. Throws InputError as in_depth_mapping()
/// and eye_planes() do, and the exceptions of `progress`.
[[nodiscard]] DepthMeasurement measure_depth(const Scene& scene, const DepthVariant& variant,
                                             const MeasureOptions& options = {});

/// Several variants, each on a thread of its own as far as there are cores. `progress` gets the fraction of the whole.
/// In a study ended early, the completed measurements are valid.
[[nodiscard]] std::vector<DepthMeasurement> measure_depths(const Scene& scene, std::span<const DepthVariant> variants,
                                                           const MeasureOptions& options, int threads);

}  // namespace halfplane
