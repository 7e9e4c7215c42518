// Shared by `cosim`, `vectors` and `convert`: random scenes in place of a SCENE.
#pragma once

#include <cstdint>
#include <string>

#include "sim/cli/options.hpp"
#include "sim/cosim/session.hpp"

namespace halfplane {

struct RandomOptions {
  std::uint64_t random = 0;  ///< primitives; 0: a scene
  std::string random_only;
  std::uint64_t first_scene = 0, scenes = 0;  ///< 0: not given
};

/// Adds --random, for up to `most` primitives, --random-only, --first-scene and --scenes.
void add_random_options(CLI::App& app, RandomOptions& options, const std::string& meaning, std::uint64_t most);

/// Throws InputError unless there is either a SCENE or --random, and the others come with --random. `done`: "run".
void check_random_options(const CommonOptions& common, const RandomOptions& options, const std::string& done);

/// The scenes of --random. Throws InputError for knobs that the configuration does not have, and for a first scene that
/// the run does not have.
[[nodiscard]] SceneSource random_source(const CommonOptions& common, const RandomOptions& options,
                                        const Config& config);

/// The options as typed, from " --random N" on.
[[nodiscard]] std::string random_arguments(const RandomOptions& options);

/// Adds `random`, and `random_only`, `first_scene`, `scenes` where they are given.
void add_random_json(Json& result, const RandomOptions& options);

}  // namespace halfplane
