// A whole co-simulation: scene after scene into one design, and the handling of the first failure.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "sim/cosim/lockstep.hpp"
#include "sim/cosim/random_profile.hpp"
#include "sim/cosim/reduce.hpp"

namespace halfplane {

/// Gives one scene after the other; none at the end.
using SceneSource = std::function<std::optional<Scene>()>;

[[nodiscard]] SceneSource single_scene(Scene scene);

/// Scenes of a random run: all, or some of them alone.
struct SceneRange {
  std::uint64_t first = 1;      ///< counted from 1
  std::uint64_t count = ~0ULL;  ///< at most so many
};

/// `count` random triangles, lines and points, in scenes of up to 2,000 so that a failing one is small. The first
/// scenes are smaller. A scene is the same whatever range it is of.
[[nodiscard]] SceneSource random_scenes(const Config& config, std::uint64_t seed, std::uint64_t count,
                                        const RandomProfile& profile = {}, SceneRange range = {});

/// The order in which a session's scenes are sent, and the buffers that they store: as configured; or, where the
/// hardware allows a choice and the configuration makes none, one of the four for each scene, by the seed.
enum class HostOrders { configured, drawn };

struct Session {
  LockstepResult result;        ///< result of all scenes together
  std::optional<Scene> failed;  ///< the scene with the mismatch, or whose model differs from the specification
  std::string disagreement;     ///< difference_from_specification() of it
  Config config;                ///< of the last scene
  Counters counters;            ///< the host's, of that scene
  std::uint64_t scenes = 0;
  std::uint64_t scene = 0;    ///< number of the last one that `next` gave, from 1
  bool has_trace = false;     ///< `options.trace` has been written
  std::string trace_failure;  ///< reason why the trace was not written
  double seconds = 0;         ///< the model's work included
};

/// Runs all scenes without a reset between them, up to the first mismatch. With `holds_model` the model of each scene
/// is also compared with the scalar engine's picture. `options.progress` gets the fraction of the current scene.
/// `first`: number of the first scene, which takes the order that it takes in a run from 1 on.
[[nodiscard]] Session run_session(Dut& dut, const Config& config, const LockstepOptions& options,
                                  const SceneSource& next, HostOrders orders = HostOrders::configured,
                                  bool holds_model = false, std::uint64_t first = 1);

/// A reduced failing scene, with its waveform.
struct Finding {
  Scene scene;                     ///< reduced; unchanged if it does not fail alone
  LockstepOptions lockstep;        ///< with which it fails
  Mismatch mismatch;               ///< of `scene`
  std::optional<Reduced> reduced;  ///< none: after a reset the scene alone does not fail, or no time to find out
  bool is_stopped = false;         ///< by reducing.progress, before that was known
  bool has_trace = false;          ///< `trace` has been written
  std::string trace_failure;       ///< reason why the trace was not written
};

/// Reduces, and writes, completely or not at all, the waveform around the mismatch to `trace` (empty: none; also if the
/// design has none).
[[nodiscard]] Finding investigate(Dut& dut, const Config& config, const LockstepOptions& options, const Scene& failed,
                                  const Mismatch& mismatch, const std::string& trace, const ReduceOptions& reducing);

}  // namespace halfplane
