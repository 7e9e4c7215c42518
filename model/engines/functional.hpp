// The functional engine: the image, fast, without time. Whole tiles at a time; bit-identical to the stages.
#pragma once

#include <memory>

#include "functional/prepared_scene.hpp"
#include "render.hpp"

namespace halfplane {

/// Renders frames and keeps its memory from one to the next.
class FunctionalEngine {
 public:
  /// Throws InputError for a configuration that is none.
  explicit FunctionalEngine(const Config& config);
  ~FunctionalEngine();
  FunctionalEngine(const FunctionalEngine&) = delete;
  FunctionalEngine& operator=(const FunctionalEngine&) = delete;

  /// Renders every command of `scene` in program order. Where options say that it follows the frame before, bins of 64x64
  /// pixels in which the same is drawn over the same clears stay as they are, and what is drawn in them is not counted; that
  /// is for frames whose clears are of the whole target and come first, without stencil. The result lives until the next call.
  /// Throws InputError for a scene that this configuration cannot take: a target that is too large, a window-space vertex
  /// outside the guard band, a state that the engine does not have.
  [[nodiscard]] const Rendering& render(const Scene& scene, const RenderOptions& options = {});
  /// The same of a scene that was prepared before: for scenes that are drawn more than once.
  [[nodiscard]] const Rendering& render(const PreparedScene& prepared, const RenderOptions& options = {});

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

/// One frame by an engine of its own.
[[nodiscard]] Rendering render_functional(const Scene& scene, const Config& config, const RenderOptions& options = {});

}  // namespace halfplane
