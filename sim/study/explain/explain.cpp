#include "explain.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>

#include "hardware_record.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/depth_format.hpp"
#include "model/host/primitives.hpp"
#include "model/scene.hpp"
#include "model/stages/fragment_ops.hpp"
#include "model/stages/resolve.hpp"
#include "model/widths.hpp"
#include "sim/study/explain/history.hpp"
#include "specification.hpp"
#include "verify.hpp"

namespace halfplane::explain {

namespace {

/// Distance of a piece's corners from the corners of an outline, in the best assignment, pixels.
double distance_between(const Entry& entry, const golden::Outline& outline, int grid_bits) {
  if (entry.corners.size() != outline.corners) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const SnappedVertex& v : entry.corners) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < outline.corners; ++i)
      nearest = std::min(
          nearest, std::hypot(std::ldexp(v.x, -grid_bits) - outline.x[i], std::ldexp(v.y, -grid_bits) - outline.y[i]));
    sum += nearest;
  }
  return sum;
}

/// Edge values at the pixel's centre or sample, square pixels, by opposite corner; positive inside.
std::vector<double> golden_edges(const golden::Outline& o, const PixelHistory& pixel) {
  if (o.corners != 3) return {};
  const double px = pixel.at.x + std::ldexp(pixel.place.x, -kPatternFraction),
               py = pixel.at.y + std::ldexp(pixel.place.y, -kPatternFraction);
  const auto edge = [&](std::size_t a, std::size_t b) {
    return (o.x[b] - o.x[a]) * (py - o.y[a]) - (o.y[b] - o.y[a]) * (px - o.x[a]);
  };
  const double area = (o.x[1] - o.x[0]) * (o.y[2] - o.y[0]) - (o.y[1] - o.y[0]) * (o.x[2] - o.x[0]);
  const double sign = area < 0 ? -1 : 1;
  return {sign * edge(1, 2), sign * edge(2, 0), sign * edge(0, 1)};
}

void match_outlines(PixelHistory& pixel, std::span<const golden::Outline> outlines, int grid_bits) {
  for (Entry& entry : pixel.history) {
    if (!entry.primitive) continue;
    GoldenFigure& figure = entry.golden.emplace();
    const golden::Outline* best = nullptr;
    for (const golden::Outline& outline : outlines) {
      if (outline.primitive != *entry.primitive || outline.corners != entry.corners.size()) continue;
      if (best == nullptr || distance_between(entry, outline, grid_bits) < distance_between(entry, *best, grid_bits))
        best = &outline;
    }
    if (best == nullptr) continue;
    figure.outline = *best;
    figure.edges = golden_edges(*best, pixel);
  }
}

bool is_same(const golden::Outline& a, const golden::Outline& b) { return a.x == b.x && a.y == b.y; }

/// The entry of a fragment: the entry with its outline, or another entry of its primitive without an outline.
Entry* entry_of(PixelHistory& pixel, const golden::TappedFragment& fragment,
                std::span<const golden::Outline> outlines) {
  // The strands of a wide line have one outline: the strand that draws the pixel comes first.
  const golden::Outline* own = fragment.outline < outlines.size() ? &outlines[fragment.outline] : nullptr;
  const auto rank = [own](const Entry& entry) {
    const bool is_own = own != nullptr && entry.golden->outline && is_same(*entry.golden->outline, *own);
    return 2 * (is_own ? 1 : 0) + (has_fragment(entry.specification.verdict) ? 1 : 0);
  };
  Entry* best = nullptr;
  for (Entry& entry : pixel.history) {
    if (!entry.primitive || *entry.primitive != fragment.primitive || entry.golden->fragment) continue;
    if (best == nullptr || rank(entry) > rank(*best)) best = &entry;
  }
  return best;
}

std::int64_t to_grid(double lsb) {
  return static_cast<std::int64_t>(std::floor(std::ldexp(lsb, exact::kGridBits) + 0.5));
}

/// The golden's value next to each plane that it has, and the parts of the difference. `colors`: planes of colours.
void add_parts(Entry& entry, std::size_t colors) {
  if (!entry.golden || !entry.golden->fragment) return;
  const golden::TappedFragment& fragment = *entry.golden->fragment;
  for (std::size_t p = 0; p < entry.planes.size(); ++p) {
    PlaneFigure& plane = entry.planes[p];
    const bool is_color = p >= kColorPlane && p < kColorPlane + colors;
    if (p != kDepthPlane && (!is_color || entry.surface)) continue;  // its colour is that of the whole surface
    plane.golden = p == kDepthPlane ? fragment.depth : fragment.color[p - kColorPlane];
    const std::int64_t u = to_grid(*plane.golden), s = exact::on_grid(plane.oracle),
                       h = exact::on_grid({plane.unrounded, int128{1} << plane.guard_bits}),
                       d = std::int64_t{plane.code} << exact::kGridBits;
    plane.parts = Parts{s - u, h - s, d - h};
  }
}

/// Draws the golden at the pixels of `result` only, and adds its triangles, fragments and stored values to their
/// entries. Clipped triangles have other pieces there: a piece is matched with the piece that has the nearest corners.
/// `progress` gets the fraction done; it may throw.
void record_golden(const Scene& scene, const Config& config, const std::function<void(double)>& progress,
                   Explanation& result) {
  const int grid_bits = derive_widths(config).grid_bits;
  const auto colors = static_cast<std::size_t>(color_planes(attributes_of(with_alpha(config, scene))));
  int left = scene.width, top = scene.height, right = 0, bottom = 0;
  for (const PixelHistory& pixel : result.pixels) {
    left = std::min(left, pixel.at.x);
    top = std::min(top, pixel.at.y);
    right = std::max(right, pixel.at.x + 1);
    bottom = std::max(bottom, pixel.at.y + 1);
  }
  std::vector<golden::TappedFragment> fragments;
  golden::Options options;
  options.want_outlines = true;
  options.progress = progress;
  options.only = Rect{left, top, right - left, bottom - top};
  options.fragment_tap = [&fragments](const golden::TappedFragment& fragment) { fragments.push_back(fragment); };
  const golden::Image image = golden::render(scene, config, options);
  const golden::DepthBuffer depth_buffer(config, scene.planes);
  const double depth_max = std::ldexp(1.0, config.depth_bits) - 1;
  const auto stored_at = [&](const golden::Samples& of, std::size_t p) {
    const std::uint32_t code = depth_buffer.code(depth_buffer.stored_depth(of.depth[p] / depth_max));
    return GoldenStored{
        of.depth[p], of.color[p], {code, golden::rounded_color(of.color[p], config.color_format), of.ids[p]}};
  };
  for (PixelHistory& pixel : result.pixels) {
    match_outlines(pixel, image.outlines, grid_bits);
    for (const golden::TappedFragment& fragment : fragments) {
      if (fragment.x != pixel.at.x || fragment.y != pixel.at.y || fragment.sample != pixel.sample) continue;
      ++result.checks;
      if (Entry* entry = entry_of(pixel, fragment, image.outlines))
        entry->golden->fragment = fragment;
      else
        result.differences.push_back("pixel " + std::to_string(fragment.x) + "," + std::to_string(fragment.y) +
                                     ": the golden draws primitive " + std::to_string(fragment.primitive) +
                                     ", which passes nowhere near it in the model");
    }
    for (Entry& entry : pixel.history) add_parts(entry, colors);
    const auto p = static_cast<std::size_t>(pixel.at.y) * static_cast<std::size_t>(image.width) +
                   static_cast<std::size_t>(pixel.at.x);
    const std::size_t at = image.frame.at(pixel.at.x, pixel.at.y);
    const GoldenStored whole{
        image.depth[p], image.color[p], {image.frame.depth[at], image.frame.color[at], image.ids[p]}};
    pixel.golden = result.samples == 1 ? whole : stored_at(image.samples[static_cast<std::size_t>(pixel.sample)], p);
    if (pixel.resolved) pixel.resolved->golden = whole;
  }
}

Stored stored_at(const Framebuffer& frame, Pixel pixel) {
  const std::size_t at = frame.at(pixel.x, pixel.y);
  return {frame.depth[at], frame.color[at], -1, frame.stencil[at]};
}

/// The reason why the hardware cannot draw the scene; empty: it can.
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

/// Progress of a part of the work, as a fraction of the whole.
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

/// With several samples per pixel: the resolved values of the specification.
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
