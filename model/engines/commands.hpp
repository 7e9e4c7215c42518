// What the engines share: running a scene's commands in program order.
#pragma once

#include <algorithm>
#include <chrono>

#include "../pipeline.hpp"

namespace halfplane {

/// Runs every command of `scene`. Calls raster(context, triangle, index, rendering) for each triangle that the host side
/// leaves, in program order; `index` counts them over the whole scene.
template <class Raster>
Rendering run_commands(const Scene& scene, const Config& config, const RenderOptions& options, Raster&& raster) {
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  constexpr std::size_t kBatch = 4096;  // triangles between host side and raster: small enough for the cache

  validate(config);
  check_scene(scene, config);
  Rendering rendering = make_rendering(scene, config, options);
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
