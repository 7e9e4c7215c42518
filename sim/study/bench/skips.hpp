// The savings of skipping work: every kind of skipping on a scene made for it and on one where it cannot help.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/config.hpp"
#include "model/scene.hpp"
#include "sim/study/bench/turns.hpp"

namespace halfplane {

/// A kind of skipping, and the scenes that show its value. `objects` is the culling of whole objects when a scene is
/// loaded, `nodes` the skipping of their vertices by a tree, frame by frame, when a mesh becomes a scene; the others
/// are those of kSkipNames.
struct SkipPair {
  std::string_view skip, made_for, cannot_help;
};
[[nodiscard]] std::span<const SkipPair> skip_pairs();

/// A scene, and the number of primitives left out by object culling.
struct SkipScene {
  std::shared_ptr<const Scene> scene;
  std::size_t primitives_culled = 0;
};
/// Loads a scene by name, with or without culling of whole objects.
using SkipSceneLoader = std::function<SkipScene(const std::string& name, bool culls_objects)>;

/// Makes a scene again from a loaded mesh. `vertices_skipped`: of the last one.
struct SkipMaker {
  std::function<Scene()> make;
  std::function<std::size_t()> vertices_skipped;
};
using SkipSceneOpener = std::function<SkipMaker(const std::string& name, bool has_nodes)>;

struct SkipRow {
  std::string skip, scene;
  bool is_made_for = false;  ///< by the table of pairs
  FrameTimes with, without;  ///< this kind of skipping on and off, all others on
  std::uint64_t counter =
      0;  ///< counter of that name, with everything on; for `objects` primitives, for `nodes` vertices
  /// Fraction of the frame time saved; negative if the test costs more.
  [[nodiscard]] double saved() const { return 1 - with.median() / without.median(); }
};

struct SkipPlan {
  Config config;
  int width = 640, height = 480;  ///< pixels of a generated scene
  int threads = 1, repeat = 5;
  std::vector<std::string> scenes;  ///< every skip on each of them; empty: by the table of pairs
  SkipSceneLoader load;
  SkipSceneOpener open;
  std::function<void(double)> progress;  ///< 0...1; may be empty. Interrupted, thrown there, ends the study
};

/// Measures on the functional engine, with and without in turns. Throws InputError as loader and engine do. A study
/// ended early returns the rows measured so far.
[[nodiscard]] std::vector<SkipRow> measure_skips(const SkipPlan& plan);

}  // namespace halfplane
