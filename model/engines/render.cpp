#include "render.hpp"

#include <algorithm>
#include <string>

#include "../host/primitives.hpp"
#include "../stages/fragment_ops.hpp"
#include "../stages/resolve.hpp"

namespace halfplane {

std::uint32_t clear_color(const std::array<double, 4>& color, ColorFormat format) {
  std::array<std::uint8_t, 4> code;
  for (std::size_t c = 0; c < 4; ++c) code[c] = snap_color(color[c]);
  return pack_color(format, code);
}

void clear(Rendering& rendering, const Scene& scene, const Clear& command, const Config& config) {
  const Rect rect = clear_rect(scene, command);
  const auto fill = [&rect](auto& image, int stride, auto value) {
    for (int y = rect.y; y < rect.y + rect.height; ++y)
      std::fill_n(image.begin() + static_cast<std::ptrdiff_t>(y) * stride + rect.x, rect.width, value);
  };
  const auto clear_image = [&](Framebuffer& frame, Owners& owners) {
    if (command.depth) fill(frame.depth, frame.stride, DepthEncode(config, scene.planes).of_window(*command.depth));
    if (command.color) fill(frame.color, frame.stride, clear_color(*command.color, config.color_format));
    if (command.stencil) fill(frame.stencil, frame.stride, *command.stencil);
    if (!owners.ids.empty()) fill(owners.ids, frame.width, -1);
    if (!owners.visible.empty()) fill(owners.visible, frame.width, -1);
  };
  clear_image(rendering.frame, rendering);
  for (std::size_t k = 0; k < rendering.frame.samples.size(); ++k)
    clear_image(rendering.frame.samples[k], rendering.sample_owners[k]);
}

void finish_samples(Rendering& rendering, const Config& config) {
  if (rendering.frame.samples.empty()) return;
  resolve(rendering.frame, config.color_format);
  static_cast<Owners&>(rendering) = rendering.sample_owners.front();
}

void check_onto(const Scene& scene, const Config& config, const RenderOptions& options) {
  const Framebuffer* onto = options.onto;
  const std::size_t samples = config.msaa_samples == 1 ? 0 : static_cast<std::size_t>(config.msaa_samples);
  if (onto != nullptr && onto->samples.size() != samples)
    throw InputError((scene.name.empty() ? "scene" : scene.name) +
                     ": the frame that it is drawn on was made with another msaa.samples");
  if (onto != nullptr && (onto->width != scene.width || onto->height != scene.height))
    throw InputError((scene.name.empty() ? "scene" : scene.name) + ": made for " + std::to_string(scene.width) + "x" +
                     std::to_string(scene.height) + ", but the frame that it is drawn on has " +
                     std::to_string(onto->width) + "x" + std::to_string(onto->height));
}

Rendering make_rendering(const Scene& scene, const Config& config, const RenderOptions& options) {
  check_onto(scene, config, options);
  Rendering rendering;
  if (options.onto != nullptr) {
    rendering.frame = *options.onto;
  } else {
    rendering.frame = Framebuffer(scene.width, scene.height, config.tile_size);
    std::fill(rendering.frame.depth.begin(), rendering.frame.depth.end(),
              DepthEncode(config, scene.planes).of_window(1.0));
    std::fill(rendering.frame.color.begin(), rendering.frame.color.end(),
              pack_color(config.color_format, {0, 0, 0, 255}));
    if (config.msaa_samples > 1) {
      const Framebuffer empty = rendering.frame;
      rendering.frame.samples.assign(static_cast<std::size_t>(config.msaa_samples), empty);
    }
  }
  const auto pixels = static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height);
  if (options.want_count) rendering.count.assign(pixels, 0);
  if (options.want_ids) rendering.ids.assign(pixels, -1);
  if (options.want_ids && options.keeps_triangles()) rendering.visible.assign(pixels, -1);
  rendering.sample_owners.assign(rendering.frame.samples.size(), rendering);
  return rendering;
}

}  // namespace halfplane
