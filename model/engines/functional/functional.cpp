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
  return render(PreparedScene(scene), options);
}

const Rendering& FunctionalEngine::render(const PreparedScene& prepared, const RenderOptions& options) {
  if (functional::is_supported(prepared.scene(), memory_->config, options))
    return memory_->fast.render(prepared, options);
  memory_->plain = render_by_stages(prepared.scene(), memory_->config, options);
  return memory_->plain;
}

Rendering render_functional(const Scene& scene, const Config& config, const RenderOptions& options) {
  validate(config);
  const PreparedScene prepared(scene);  // refuses a scene that is not valid
  if (!functional::is_supported(scene, config, options)) return render_by_stages(scene, config, options);
  functional::FrameRenderer renderer(config);
  (void)renderer.render(prepared, options);
  return renderer.take();
}

}  // namespace halfplane
