#include "sim/cli/explain_page.hpp"

#include <cmath>

#include "model/engines/render.hpp"
#include "model/stages/depth_encode.hpp"

namespace halfplane::explain {

Json page_json(const Explanation& around, const Window& window, const Rect& box, const Scene& scene,
               const Config& config) {
  const int depth_bits = DepthEncode(config, scene.planes).format().bits;
  const Rendering empty = make_rendering(scene, config, {});
  const std::size_t at = empty.frame.at(box.x, box.y);
  Json page{{"label", label(config)},
            {"version", HALFPLANE_VERSION},
            {"primitives", around.primitives},
            {"checks", around.checks},
            {"differences", around.differences},
            {"color_format", config.color_format == ColorFormat::rgb565 ? "rgb565" : "rgba8888"},
            {"window", {{"x", window.left}, {"y", window.top}, {"width", window.width}, {"height", window.height}}},
            {"box", {{"x", box.x}, {"y", box.y}, {"width", box.width}, {"height", box.height}}},
            {"empty",
             {{"depth", hex_text(empty.frame.depth[at], depth_bits)},
              {"color", hex_text(empty.frame.color[at], config.color_format == ColorFormat::rgb565 ? 16 : 32)}}}};
  page["samples"] = Json::array();  // where they lie in each pixel
  const std::vector<PixelSamples> pixels = pixels_of(around);
  for (const PixelHistory& sample : pixels.front())
    page["samples"].push_back(
        {std::ldexp(sample.place.x, -kPatternFraction), std::ldexp(sample.place.y, -kPatternFraction)});
  page["pixels"] = Json::array();
  for (const PixelSamples& pixel : pixels) {
    Json json = pixel_json(pixel, around, scene, config);
    for (Json& entry : json["history"]) {
      Json& hardware = entry["model"]["hardware"];
      if (hardware.is_object())
        for (Json& packet : hardware["packets"]) packet.erase("fields");  // most of the bytes, and nobody shows them
    }
    page["pixels"].push_back(std::move(json));
  }
  return page;
}

}  // namespace halfplane::explain
