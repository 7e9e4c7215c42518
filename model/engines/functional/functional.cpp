#include "../functional.hpp"

#include "../scalar.hpp"
#include "frame_renderer.hpp"

namespace halfplane {
namespace {

/// Renders by the stages, for features that lanes lack: counts, ids, taps, other tile sizes, more depth and reciprocal
/// bits, depth formats, and surfaces with vertices that are not in front of the eye (is_supported()).
Rendering render_by_stages(const Scene& scene, const Config& config, const RenderOptions& options) {
  if (options.rules != StudyRules{})
    throw InputError("the functional engine has no other traversal, fill rule or clipping; use the scalar engine");
  return render_scalar(scene, config, options);
}

}  // namespace

struct FunctionalEngine::Memory {
  explicit Memory(const Config& config_) : config(config_), fast(config_) {}
  Config config;
  functional::FrameRenderer fast;
  Rendering plain;
};

FunctionalEngine::FunctionalEngine(const Config& config) {
  validate(config);
  memory_ = std::make_unique<Memory>(config);
}

FunctionalEngine::~FunctionalEngine() = default;

const Rendering& FunctionalEngine::render(const Scene& scene, const RenderOptions& options) {
  validate(scene);
  if (functional::is_supported(scene, memory_->config, options))
    return memory_->fast.render(PreparedScene(scene), options);
  memory_->plain = render_by_stages(scene, memory_->config, options);
  return memory_->plain;
}

const Rendering& FunctionalEngine::render(const PreparedScene& prepared, const RenderOptions& options) {
  if (!functional::is_supported(prepared.scene(), memory_->config, options)) return render(prepared.scene(), options);
  return memory_->fast.render(prepared, options);
}

Rendering render_functional(const Scene& scene, const Config& config, const RenderOptions& options) {
  validate(config);
  validate(scene);
  if (!functional::is_supported(scene, config, options)) return render_by_stages(scene, config, options);
  functional::FrameRenderer renderer(config);
  (void)renderer.render(PreparedScene(scene), options);
  return renderer.take();
}

}  // namespace halfplane
