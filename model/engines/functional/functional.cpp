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

Rendering& FunctionalEngine::render(const Scene& scene, const RenderOptions& options) {
  if (functional::is_supported(scene, memory_->config, options))
    return memory_->fast.render(PreparedScene(scene), options);
  memory_->plain = render_tiles(scene, memory_->config, options);
  return memory_->plain;
}

Rendering& FunctionalEngine::render(const PreparedScene& prepared, const RenderOptions& options) {
  if (!functional::is_supported(prepared.scene(), memory_->config, options)) return render(prepared.scene(), options);
  return memory_->fast.render(prepared, options);
}

Rendering render_functional(const Scene& scene, const Config& config, const RenderOptions& options) {
  return std::move(FunctionalEngine(config).render(scene, options));
}

}  // namespace halfplane
