// The functional engine: the image, fast, without time. Whole tiles at a time; bit-identical to the stages.
#pragma once

#include <memory>

#include "functional/prepared_scene.hpp"
#include "render.hpp"

namespace halfplane {

/// Renders frames and keeps its memory from one to the next.
class FunctionalEngine {
 public:
  /// Throws InputError for an invalid configuration.
  explicit FunctionalEngine(const Config& config);
  ~FunctionalEngine();
  FunctionalEngine(const FunctionalEngine&) = delete;
  FunctionalEngine& operator=(const FunctionalEngine&) = delete;

  /// Renders every command of `scene` in program order. If options say that the frame follows the previous frame, bins of
  /// 64x64 pixels with the same draws over the same clears keep their pixels, and their draws are not counted; only for
  /// frames whose clears cover the whole target and come first, without stencil. The result lives until the next call.
  /// Throws InputError for a scene that this configuration does not support: a target that is too large, a window-space
  /// vertex outside the guard band, an unsupported state.
  [[nodiscard]] const Rendering& render(const Scene& scene, const RenderOptions& options = {});
  /// The same for a prepared scene: for scenes that are drawn more than once.
  [[nodiscard]] const Rendering& render(const PreparedScene& prepared, const RenderOptions& options = {});

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

/// Renders one frame with a temporary engine.
[[nodiscard]] Rendering render_functional(const Scene& scene, const Config& config, const RenderOptions& options = {});

}  // namespace halfplane
