#include "explain.hpp"


#include "golden_record.hpp"
#include "hardware_record.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/stages/resolve.hpp"
#include "specification.hpp"
#include "verify.hpp"

namespace halfplane::explain {
namespace {

Stored stored_at(const Framebuffer& frame, Pixel pixel) {
  const std::size_t at = frame.at(pixel.x, pixel.y);
  return {frame.depth[at], frame.color[at], -1, frame.stencil[at]};
}

/// Why the hardware cannot draw the scene; empty: it can.
std::string hardware_refusal(const Scene& scene, const Config& config, const StudyRules& rules) {
  if (rules != StudyRules{})
    return "hardware has its own rules for traversal, fill rule, gradients, accumulator and weights; "
           "leave them as they are for its record";
  try {
    require_one_sample(config, "the hardware whose record is kept here");
    check_hardware_scene(scene, config);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

/// A part of the work, as a part of the whole.
std::function<void(double)> part_of(const Options& options, double from, double to) {
  return [&options, from, to](double fraction) {
    if (options.progress) options.progress(from + (to - from) * fraction);
  };
}

void add_engine(const Scene& scene, const Config& config, const StudyRules& rules, Explanation& result) {
  RenderOptions options;
  options.want_ids = true;
  options.rules = rules;
  const Rendering rendering =
      rules == StudyRules{} ? render_functional(scene, config, options) : render_scalar(scene, config, options);
  const auto stored = [&](const Framebuffer& frame, const Owners& owners, Pixel at) {
    Stored of = stored_at(frame, at);
    of.owner = owners.ids[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(scene.width) +
                          static_cast<std::size_t>(at.x)];
    return of;
  };
  for (PixelHistory& pixel : result.pixels) {
    const auto k = static_cast<std::size_t>(pixel.sample);
    const Stored whole = stored(rendering.frame, rendering, pixel.at);
    pixel.engine =
        result.samples == 1 ? whole : stored(rendering.frame.samples[k], rendering.sample_owners[k], pixel.at);
    if (pixel.resolved) pixel.resolved->engine = whole;
  }
}

/// Of pixels with several samples: what those of the specification come to.
void resolve(const Config& config, Explanation& result) {
  if (result.samples == 1) return;
  for (std::size_t first = 0; first < result.pixels.size(); first += static_cast<std::size_t>(result.samples)) {
    Resolved& resolved = result.pixels[first].resolved.emplace();
    resolved.model = result.pixels[first].model;
    resolved.model.color = mean_color(config.color_format, result.samples, [&](int k) {
      return result.pixels[first + static_cast<std::size_t>(k)].model.color;
    });
  }
}

}  // namespace

void require_inside(const Scene& scene, const std::vector<Pixel>& pixels) {
  for (const auto [x, y] : pixels)
    if (x < 0 || y < 0 || x >= scene.width || y >= scene.height)
      throw InputError("pixel " + std::to_string(x) + " " + std::to_string(y) + " lies outside the target of " +
                       std::to_string(scene.width) + "x" + std::to_string(scene.height) + "; give 0 0 to " +
                       std::to_string(scene.width - 1) + " " + std::to_string(scene.height - 1));
}

Explanation explain(const Scene& scene, const Config& config, const std::vector<Pixel>& pixels,
                    const Options& options) {
  validate(config);
  check_scene(scene, config);
  require_inside(scene, pixels);
  Explanation result;
  SpecificationRecord record =
      record_specification(scene, with_alpha(config, scene), pixels, options, result.differences, result.checks);
  result.pixels = std::move(record.pixels);
  result.samples = config.msaa_samples;
  result.fill_rule = options.rules.fill_rule;
  resolve(config, result);
  result.primitives = record.primitives;
  result.no_hardware = hardware_refusal(scene, config, options.rules);
  if (options.rtl != nullptr && !result.no_hardware.empty()) throw InputError(result.no_hardware);
  const double golden_ends = options.rtl == nullptr ? 0.5 : 0.1, hardware_ends = 2 * golden_ends;
  record_golden(scene, config, part_of(options, 0, golden_ends), result);
  add_engine(scene, config, options.rules, result);
  if (result.no_hardware.empty()) {
    const HardwareRecord hardware = record_hardware(scene, config, pixels, record.near,
                                                    part_of(options, golden_ends, hardware_ends), result.packets);
    join_hardware(hardware, config, result);
    for (PixelHistory& pixel : result.pixels) pixel.hardware = stored_at(hardware.frame, pixel.at);
    record_cycles(scene, config, result.packets);
  }
  if (options.rtl != nullptr) {
    const auto progress = part_of(options, hardware_ends, 1);
    const Framebuffer frame = record_rtl(
        *options.rtl, scene, config, options.mutant,
        [&progress](double fraction) {
          progress(fraction);
          return true;
        },
        result.packets);
    for (PixelHistory& pixel : result.pixels) pixel.rtl = stored_at(frame, pixel.at);
  }
  verify(config, result);
  return result;
}

}  // namespace halfplane::explain
