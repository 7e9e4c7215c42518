// Delta debugging (Zeller and Hildebrandt 2002): the fewest primitives and the simplest states that still fail.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/config.hpp"
#include "model/scene.hpp"
#include "sim/cosim/lockstep.hpp"

namespace halfplane {

/// The mismatch of a scene, if any: any mismatch counts, not only the first one seen.
using FailTest = std::function<std::optional<Mismatch>(const Scene&, const LockstepOptions&)>;

/// A test that resets the design and runs the scene; a run beyond the deadline counts as equal.
[[nodiscard]] FailTest lockstep_test(Dut& dut, const Config& config);

struct ReduceOptions {
  double seconds = 20;  ///< stops after that with the best result so far
  /// Gets the fraction of the time; may be empty. Interrupted, thrown there, ends the search like the end of the time.
  std::function<void(double fraction)> progress;
  /// What stays as it is in every scene that is tried: names of states, `target` for its size.
  std::vector<std::string> kept;
};

struct Reduced {
  Scene scene;
  LockstepOptions lockstep;  ///< without stalls, if it fails without them
  Mismatch mismatch;         ///< of `scene`
  std::size_t primitives_before = 0, primitives_after = 0;
  std::size_t runs = 0;
  bool is_minimal = false;  ///< the time was enough: no single item can be removed
};

/// Reduces a failing scene; none when it does not fail (from reset, with these options). Throws Interrupted when
/// interrupted before that was known.
[[nodiscard]] std::optional<Reduced> reduce(const Scene& scene, const Config& config, const LockstepOptions& lockstep,
                                            const FailTest& test, const ReduceOptions& options = {});

/// The same primitives in window space, clipped and snapped: as sent to the hardware. Lines begin and end at their
/// first and last pixel.
[[nodiscard]] Scene window_scene(const Scene& scene, const Config& config);

}  // namespace halfplane
