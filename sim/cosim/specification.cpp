#include "sim/cosim/specification.hpp"

#include <cstdio>

#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"

namespace halfplane {
namespace {

template <class Plane>
std::string difference(const char* plane, const Plane& model, const Plane& specification, const Framebuffer& frame,
                       const std::string& sample) {
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const std::size_t at = frame.at(x, y);
      if (model[at] == specification[at]) continue;
      char codes[64];
      std::snprintf(codes, sizeof codes, "0x%x, the scalar engine 0x%x", static_cast<unsigned>(model[at]),
                    static_cast<unsigned>(specification[at]));
      return std::string(plane) + " of pixel (" + std::to_string(x) + ", " + std::to_string(y) + ")" + sample +
             ": the hardware model has " + codes;
    }
  return {};
}

std::string difference(const Framebuffer& model, const Framebuffer& specification, const Config& config,
                       const std::string& sample) {
  std::string text = difference("colour", model.color, specification.color, model, sample);
  if (!text.empty() || config.frame_store == FrameStore::color) return text;
  text = difference("depth", model.depth, specification.depth, model, sample);
  if (text.empty() && has_stencil(config))
    text = difference("stencil", model.stencil, specification.stencil, model, sample);
  return text;
}

}  // namespace

std::string difference_from_specification(const Scene& scene, const Config& config) {
  const Framebuffer model = render_hardware(scene, config).frame, scalar = render_scalar(scene, config).frame;
  for (std::size_t k = 0; k < model.samples.size(); ++k) {
    const std::string text = difference(model.samples[k], scalar.samples[k], config, ", sample " + std::to_string(k));
    if (!text.empty()) return text;
  }
  return difference(model, scalar, config, "");
}

}  // namespace halfplane
