#include "../functional.hpp"

#include <optional>

#include "frame_renderer.hpp"
#include "tiles.hpp"

namespace halfplane {

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
  if (functional::is_supported(scene, memory_->config, options))
    return memory_->fast.render(PreparedScene(scene), options);
  memory_->plain = render_tiles(scene, memory_->config, options);
  return memory_->plain;
}

const Rendering& FunctionalEngine::render(const PreparedScene& prepared, const RenderOptions& options) {
  if (!functional::is_supported(prepared.scene(), memory_->config, options)) return render(prepared.scene(), options);
  return memory_->fast.render(prepared, options);
}

Rendering render_functional(const Scene& scene, const Config& config, const RenderOptions& options) {
  validate(config);
  if (!functional::is_supported(scene, config, options)) return render_tiles(scene, config, options);
  functional::FrameRenderer renderer(config);
  (void)renderer.render(PreparedScene(scene), options);
  return renderer.take();
}

}  // namespace halfplane
