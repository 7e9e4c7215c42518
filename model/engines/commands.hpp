// What the engines share: running a scene's commands in program order, and the pixels of lines and points.
#pragma once

#include <algorithm>
#include <chrono>

#include "../pipeline.hpp"

namespace halfplane {

/// A covered sample through depth_encode, depth_test and rop. `color()` gives its four codes, when they are needed.
template <class Color>
void shade_sample(const DrawContext& context, const RenderOptions& options, int x, int y, std::uint32_t plane_code,
                  Color&& color, std::uint32_t primitive, std::int32_t visible, Rendering& rendering) {
  const State& state = context.state;
  const std::uint32_t depth = context.depth_encode(plane_code);
  const std::size_t pixel = rendering.frame.at(x, y);
  const auto plain =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(rendering.frame.width) + static_cast<std::size_t>(x);
  ++rendering.counters.covered;
  if (!rendering.count.empty()) ++rendering.count[plain];
  if (!depth_passes(state.depth_test, depth, rendering.frame.depth[pixel])) {
    rendering.counters.skipped.fragments_early_z += options.skip.fragments_early_z ? 1 : 0;
    return;
  }
  ++rendering.counters.depth_passed;
  if (!state.depth_write && !state.color_write) return;
  ++rendering.counters.written;
  if (state.depth_write) rendering.frame.depth[pixel] = depth;
  if (state.color_write) rendering.frame.color[pixel] = pack_color(context.config.color_format, color());
  if (!rendering.ids.empty()) rendering.ids[plain] = static_cast<std::int32_t>(primitive);
  if (!rendering.visible.empty()) rendering.visible[plain] = visible;
}

/// `visible` of a pixel that a line or a point owns.
inline constexpr std::int32_t kVisibleOutline = -2;

inline void draw_line(const DrawContext& context, const Widths& widths, const RenderOptions& options,
                      const LinePrimitive& line, Rendering& rendering) {
  line_raster(line.setup, widths, [&](const LinePixel& pixel) {
    if (options.pixel_tap) options.pixel_tap(line.drawn.primitive, pixel.x, pixel.y);
    const auto color = [&pixel] {
      std::array<std::uint8_t, 4> code;
      for (std::size_t c = 0; c < 4; ++c) code[c] = static_cast<std::uint8_t>(pixel.color >> 8 * c);
      return code;
    };
    shade_sample(context, options, pixel.x, pixel.y, pixel.depth, color, line.drawn.primitive, kVisibleOutline,
                 rendering);
  });
}

inline void draw_point(const DrawContext& context, const RenderOptions& options, const PointPrimitive& point,
                       Rendering& rendering) {
  const SnappedVertex& at = point.drawn.at;
  for (int y = point.box.top; y <= point.box.bottom; ++y)
    for (int x = point.box.left; x <= point.box.right; ++x) {
      if (options.pixel_tap) options.pixel_tap(point.drawn.primitive, x, y);
      shade_sample(
          context, options, x, y, at.z, [&at] { return at.rgba; }, point.drawn.primitive, kVisibleOutline, rendering);
    }
}

/// Host side and raster of a draw whose primitives end as lines or points.
inline void draw_outlines(const DrawContext& context, const Widths& widths, VertexCache& cache,
                          std::uint32_t& primitive, const RenderOptions& options, Rendering& rendering) {
  Outline outline;
  for_each_primitive(context.scene, context.draw, context.state.provoking, [&](const AssembledPrimitive& assembled) {
    outline.lines.clear();
    outline.points.clear();
    geometry(context, widths, cache, assembled, primitive++, rendering.counters, outline);
    for (const LinePrimitive& line : outline.lines) {
      draw_line(context, widths, options, line, rendering);
      if (options.keeps_triangles()) rendering.lines.push_back(line.drawn);
    }
    for (const PointPrimitive& point : outline.points) {
      draw_point(context, options, point, rendering);
      if (options.keeps_triangles()) rendering.points.push_back(point.drawn);
    }
  });
}

/// A draw of filled triangles that run_commands() leaves to nobody else.
struct NoOtherPath {
  bool operator()(const DrawContext&, std::uint32_t&, Rendering&) const { return false; }
};

/// Runs every command of `scene`. Calls raster(context, triangle, index, rendering) for each triangle that the host
/// side leaves, in program order; `index` counts them over the whole scene. Before a draw of filled triangles, asks
/// other_path(context, primitive, rendering): true says that it has drawn and counted them all, `primitive` included.
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
      if (is_outline) draw_outlines(context, widths, cache, primitive, options, rendering);
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
  return rendering;
}

}  // namespace halfplane
