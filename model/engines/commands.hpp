// Shared code of the engines: runs a scene's commands in program order, and draws the pixels of lines and points.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "../host/primitives.hpp"
#include "../stages/fragment_ops.hpp"
#include "../stages/line_raster.hpp"
#include "../stages/surface.hpp"
#include "render.hpp"
#include "tapped_fragment.hpp"

namespace halfplane {

/// The end of fragments: the images and owners of pixels, or of one of their samples.
struct FragmentTarget {
  Framebuffer& frame;
  Owners& owners;
  std::uint32_t sample = 0;
};

/// Passes a covered sample through depth_encode, the tests and rop, into `target` of the rendering. `color()` gives its
/// four codes, when they are needed. `is_back`: the triangle shows its back.
template <class Color>
void shade_sample(const DrawContext& context, const RenderOptions& options, int x, int y, std::uint32_t plane_code,
                  Color&& color, std::uint32_t primitive, std::int32_t visible, const FragmentTarget& target,
                  Rendering& rendering, bool is_back) {
  const FragmentOps& ops = context.fragment_ops;
  const std::uint32_t depth = context.depth_encode(plane_code);
  Framebuffer& frame = target.frame;
  Owners& owners = target.owners;
  const std::size_t pixel = frame.at(x, y);
  const auto plain =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(rendering.frame.width) + static_cast<std::size_t>(x);
  ++rendering.counters.covered;
  if (!rendering.count.empty()) ++rendering.count[plain];
  const Fate fate = apply_fragment(ops, context.config.color_format, {depth, x, y, is_back, target.sample}, color,
                                   {frame.depth[pixel], frame.color[pixel], frame.stencil[pixel]});
  if (fate == Fate::failed) {
    rendering.counters.skipped.fragments_early_z += options.skip.fragments_early_z ? 1 : 0;
    return;
  }
  ++rendering.counters.depth_passed;
  if (fate == Fate::killed) {
    ++rendering.counters.alpha_killed;
    return;
  }
  if (!ops.state.writes()) return;
  ++rendering.counters.written;
  if (!owners.ids.empty()) owners.ids[plain] = static_cast<std::int32_t>(primitive);
  if (!owners.visible.empty()) owners.visible[plain] = visible;
}

/// A fully covered pixel, or of a multisampled pixel the samples in `covered`: plane_code(k) gives the depth of each
/// sample, `color()` the colour of all.
template <class Depth, class Color>
void shade_pixel(const DrawContext& context, const RenderOptions& options, int x, int y, unsigned covered,
                 Depth&& plane_code, Color&& color, std::uint32_t primitive, std::int32_t visible, Rendering& rendering,
                 bool is_back = false) {
  if (rendering.frame.samples.empty()) {
    shade_sample(context, options, x, y, plane_code(0), color, primitive, visible, {rendering.frame, rendering},
                 rendering, is_back);
    return;
  }
  std::optional<std::array<std::uint32_t, 4>> known;
  const auto once = [&] {
    if (!known) known = color();
    return *known;
  };
  covered &= drawn_samples(context.state);
  for (std::uint32_t k = 0; k < rendering.frame.samples.size(); ++k)
    if ((covered >> k & 1U) != 0)
      shade_sample(context, options, x, y, plane_code(static_cast<int>(k)), once, primitive, visible,
                   {rendering.frame.samples[k], rendering.sample_owners[k], k}, rendering, is_back);
}

inline constexpr unsigned kAllSamples = ~0U;

/// Taps a fragment of a line or point, which covers all samples of its pixel.
inline void tap_samples(TappedFragment fragment, int samples, const FragmentTap& tap) {
  for (fragment.sample = 0; fragment.sample < samples; ++fragment.sample) tap(fragment);
}

/// The surface of a triangle whose setup is not empty, if its draw has one; with `setup` at a sample, `offset` from
/// pixel centres. Throws InputError for a vertex that is not in front of the eye, which only window space can give.
[[nodiscard]] inline std::optional<Surface> surface_of(const DrawContext& context, const Triangle& triangle,
                                                       const TriangleSetup& setup, const Widths& widths,
                                                       const SampleOffset& offset = {}) {
  const State& state = context.state;
  if (!has_surface(state)) return std::nullopt;
  require_positive_w(context, triangle);
  const Texture* texture = state.texture ? &context.scene.textures[*state.texture] : nullptr;
  return std::optional<Surface>(std::in_place, triangle, setup, state, texture, context.fog.get(), context.phong.get(),
                                context.config, widths, offset);
}

/// `visible` of a pixel owned by a line or a point.
inline constexpr std::int32_t kVisibleOutline = -2;

/// The fragments of a line, from the registers of line_raster.
inline void tap_line(const LinePrimitive& line, const Widths& widths, std::uint32_t item, const FragmentTap& tap) {
  const int guard_bits = widths.line_guard_bits;
  TappedFragment fragment{PrimitiveKind::line,
                          line.drawn.primitive,
                          line.drawn.draw,
                          item,
                          nullptr,
                          &line.drawn,
                          nullptr,
                          0,
                          0,
                          guard_bits,
                          {}};
  for (LineState state = first_state(line.setup);; advance(state, line.setup, widths)) {
    const LinePixel pixel = pixel_of(state, line.setup, widths);
    const auto sample = [&](std::uint64_t value, std::uint32_t code) -> PlaneSample {
      // A pixel before the start shows the start's codes; a register includes half an LSB.
      if (state.is_before_start) return {std::int64_t{code} << guard_bits, code};
      return {static_cast<std::int64_t>(value) - (std::int64_t{1} << (guard_bits - 1)), code};
    };
    fragment.x = pixel.x;
    fragment.y = pixel.y;
    for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p)
      fragment.plane[p] = sample(state.value[p], pixel.code[p]);
    tap_samples(fragment, widths.pixel_samples, tap);
    if (state.remaining == 0) return;
  }
}

/// The fragments of a point: its vertex everywhere.
inline void tap_point(const PointPrimitive& point, const Widths& widths, std::uint32_t item, const FragmentTap& tap) {
  const DrawnPoint& drawn = point.drawn;
  TappedFragment fragment{PrimitiveKind::point, drawn.primitive, drawn.draw, item, nullptr, nullptr, &drawn};
  for (std::size_t p = 0; p < kMaxPlanes; ++p)
    fragment.plane[p] = {static_cast<std::int64_t>(drawn.at.code[p]), drawn.at.code[p]};
  for_each_run(point, widths.grid_bits, [&](const PixelBounds& box) {
    for (fragment.y = box.top; fragment.y <= box.bottom; ++fragment.y)
      for (fragment.x = box.left; fragment.x <= box.right; ++fragment.x)
        tap_samples(fragment, widths.pixel_samples, tap);
  });
}

inline void draw_line(const DrawContext& context, const Widths& widths, const RenderOptions& options,
                      const LinePrimitive& line, Rendering& rendering) {
  if (options.fragment_tap)
    tap_line(line, widths, static_cast<std::uint32_t>(rendering.lines.size()), options.fragment_tap);
  line_raster(line.setup, widths, [&](const LinePixel& pixel) {
    if (options.pixel_tap) options.pixel_tap(line.drawn.primitive, pixel.x, pixel.y);
    shade_pixel(
        context, options, pixel.x, pixel.y, kAllSamples, [&pixel](int) { return pixel.code[kDepthPlane]; },
        [&pixel] { return color_channels(pixel.code); }, line.drawn.primitive, kVisibleOutline, rendering);
  });
}

inline void draw_point(const DrawContext& context, const Widths& widths, const RenderOptions& options,
                       const PointPrimitive& point, Rendering& rendering) {
  if (options.fragment_tap)
    tap_point(point, widths, static_cast<std::uint32_t>(rendering.points.size()), options.fragment_tap);
  const SnappedVertex& at = point.drawn.at;
  for_each_run(point, widths.grid_bits, [&](const PixelBounds& box) {
    for (int y = box.top; y <= box.bottom; ++y)
      for (int x = box.left; x <= box.right; ++x) {
        if (options.pixel_tap) options.pixel_tap(point.drawn.primitive, x, y);
        shade_pixel(
            context, options, x, y, kAllSamples, [&at](int) { return at.code[kDepthPlane]; },
            [&at] { return color_channels(at.code); }, point.drawn.primitive, kVisibleOutline, rendering);
      }
  });
}

/// Host side and raster of a draw whose primitives become lines or points. Calls raster(triangle) for the triangles of
/// lines that are rectangles.
template <class Raster>
void draw_outlines(const DrawContext& context, const Widths& widths, VertexCache& cache, std::uint32_t& primitive,
                   const RenderOptions& options, Rendering& rendering, Raster&& raster) {
  Outline outline;
  for_each_primitive(context.scene, context.draw, context.state.provoking, [&](const AssembledPrimitive& assembled) {
    outline.clear();
    geometry(context, widths, cache, assembled, primitive++, rendering.counters, outline);
    for (const LinePrimitive& line : outline.lines) {
      draw_line(context, widths, options, line, rendering);
      if (options.keeps_triangles()) rendering.lines.push_back(line.drawn);
    }
    for (const Triangle& triangle : outline.triangles) {
      raster(triangle);
      if (options.keeps_triangles()) rendering.triangles.push_back(triangle);
    }
    for (const PointPrimitive& point : outline.points) {
      draw_point(context, widths, options, point, rendering);
      if (options.keeps_triangles()) rendering.points.push_back(point.drawn);
    }
  });
}

/// For run_commands(): no other path draws filled triangles.
struct NoOtherPath {
  bool operator()(const DrawContext&, std::uint32_t&, Rendering&) const { return false; }
};

/// Runs every command of `scene`. Calls raster(context, triangle, index, rendering) for each triangle that leaves the
/// host side, in program order; `index` counts them over the whole scene. Before a draw of filled triangles, calls
/// other_path(context, primitive, rendering): true says that it has drawn and counted all of them, and advanced
/// `primitive`.
template <class Raster, class OtherPath = NoOtherPath>
Rendering run_commands(const Scene& scene, const Config& config, const RenderOptions& options, Raster&& raster,
                       OtherPath&& other_path = {}) {
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  constexpr std::size_t kBatch = 4096;  // triangles between host side and raster: small enough for the cache

  validate(config);
  check_scene(scene, config);
  Rendering rendering = make_rendering(scene, config, options);
  const Widths widths = derive_widths(config);
  VertexCache cache(scene.vertices.size());
  std::vector<Triangle> batch;
  std::uint32_t primitive = 0, index = 0;
  std::size_t entries_done = 0;
  auto started = Clock::now(), last_report = started;

  const auto flush = [&](const DrawContext& context) {
    rendering.geometry_s += seconds_since(started);
    started = Clock::now();
    for (const Triangle& triangle : batch) raster(context, triangle, index++, rendering);
    if (options.keeps_triangles()) rendering.triangles.insert(rendering.triangles.end(), batch.begin(), batch.end());
    batch.clear();
    rendering.raster_s += seconds_since(started);
    started = Clock::now();
    if (options.progress && seconds_since(last_report) > 0.1) {
      last_report = started;
      options.progress(static_cast<double>(entries_done) /
                       static_cast<double>(std::max<std::size_t>(1, scene.indices.size())));
    }
  };

  for (std::size_t i = 0; i < scene.commands.size(); ++i) {
    if (const auto* command = std::get_if<Clear>(&scene.commands[i])) {
      started = Clock::now();
      clear(rendering, scene, *command, config);
      rendering.raster_s += seconds_since(started);
      started = Clock::now();
    } else if (const auto* draw = std::get_if<Draw>(&scene.commands[i]); draw != nullptr && draw->outside != 0) {
      const std::size_t count = primitive_count(scene, *draw);
      primitive += static_cast<std::uint32_t>(count);
      rendering.counters.primitives_in += count;
      rendering.counters.culled += count;
      entries_done += draw->count;
    } else if (draw != nullptr) {
      const DrawContext context(scene, config, *draw, static_cast<std::uint32_t>(i));
      const bool is_outline = drawn_as(context.state, draw->topology) != PrimitiveType::triangle;
      started = Clock::now();
      if (is_outline)
        draw_outlines(context, widths, cache, primitive, options, rendering,
                      [&](const Triangle& triangle) { raster(context, triangle, index++, rendering); });
      if (is_outline || other_path(context, primitive, rendering)) {
        entries_done += draw->count;
        rendering.raster_s += seconds_since(started);
        continue;
      }
      for_each_triangle(scene, *draw, context.state.provoking, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        geometry(context, cache, {a, b, c}, primitive++, options.skip, rendering.counters, batch);
        entries_done += 3;
        if (batch.size() >= kBatch) flush(context);
      });
      flush(context);
    }
  }
  started = Clock::now();
  finish_samples(rendering, config);
  rendering.raster_s += seconds_since(started);
  return rendering;
}

}  // namespace halfplane
