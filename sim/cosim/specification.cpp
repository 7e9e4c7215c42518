#include "sim/cosim/specification.hpp"

#include <array>
#include <cstdio>

#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/stages/stencil_packets.hpp"

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
             ": the model has " + codes;
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

Framebuffer hardware_picture(const Scene& scene, const Config& config) { return render_hardware(scene, config).frame; }

std::string difference_from_specification(const Scene& scene, const Config& config, const PictureOf& model) {
  const Framebuffer drawn = model(scene, config), scalar = render_scalar(scene, config).frame;
  for (std::size_t k = 0; k < drawn.samples.size(); ++k) {
    const std::string text = difference(drawn.samples[k], scalar.samples[k], config, ", sample " + std::to_string(k));
    if (!text.empty()) return text;
  }
  return difference(drawn, scalar, config, "");
}

FailTest specification_test(const Config& config, const PictureOf& model) {
  return [config, model](const Scene& scene, const LockstepOptions&) -> std::optional<Mismatch> {
    Mismatch mismatch;
    mismatch.stage = "specification";
    mismatch.hint = difference_from_specification(scene, config, model);
    return mismatch.hint.empty() ? std::nullopt : std::optional(mismatch);
  };
}

Config random_shading_config(Random& random) {
  constexpr std::array kNames{"tiny", "embedded", "full"};
  constexpr std::array kUnits{TextureUnitKind::nearest, TextureUnitKind::bilinear, TextureUnitKind::trilinear};
  while (true) {
    Config config = preset(kNames[random.next() % 3]);
    config.msaa_samples = 2 << (random.next() % 3);
    config.cache_kind = CacheKind::blocks;  // before a texture unit
    config.color_format = random.next() % 2 != 0 ? ColorFormat::rgba8888 : config.color_format;
    config.texture_unit = kUnits[random.next() % 3];
    config.perspective_colors = static_cast<int>(random.next() % 2);
    config.fog_units = static_cast<int>(random.next() % 2);
    config.shade_units = static_cast<int>(random.next() % 2);
    config.alpha_units = static_cast<int>(random.next() % 2);
    config.stamp_size = 1 << (random.next() % 3);
    while (config.stamp_size * config.stamp_size * config.msaa_samples > 64) config.stamp_size /= 2;
    if (config.stamp_size == 2 && config.texture_unit != TextureUnitKind::nearest && random.next() % 2 != 0)
      config.texture_lanes = 4;
    try {
      validate(config);
      return config;
    } catch (const InputError&) {  // the settings exclude each other
    }
  }
}

}  // namespace halfplane
