// Frames through the cycle model, and the cost of each.
#include <algorithm>
#include <chrono>
#include <utility>

#include "../../stages/resolve.hpp"
#include "../hardware.hpp"
#include "cycle_model.hpp"

namespace halfplane {
namespace {

/// Totals since `before`; members that describe the current frame are copied.
TimingTotals since(TimingTotals now, const TimingTotals& before) {
  using T = TimingTotals;
  for (auto count : {&T::hazard_cycles, &T::move_cycles, &T::memory_cycles, &T::bound_cycles, &T::visit_cycles,
                     &T::slot_cycles, &T::texel_beats})
    now.*count -= before.*count;
  for (std::size_t i = 0; i < kStages; ++i) now.works[i] -= before.works[i];
  for (std::size_t cause = 0; cause < now.beats.size(); ++cause)
    for (const std::size_t plane : {0U, 1U}) now.beats[cause][plane] -= before.beats[cause][plane];
  return now;
}

MemoryUse since(MemoryUse now, const MemoryUse& before) {
  for (auto count : {&MemoryUse::scan_out_bytes, &MemoryUse::other_bytes, &MemoryUse::bands, &MemoryUse::late_bands})
    now.*count -= before.*count;
  return now;
}

}  // namespace

CycleFrames::CycleFrames(const Config& config, MemoryTiming& memory, const CycleOptions& options)
    : config_(config), memory_(memory), model_(make_cycle_model(config, memory, options)) {}

CycleRendering CycleFrames::draw(const Scene& scene, const RenderOptions& render) {
  if (!render.skip.bins) held_.forget();
  return draw(scene, render, &held_);
}

CycleRendering CycleFrames::draw(const Scene& scene, const RenderOptions& render, BinContents* held) {
  const auto started = std::chrono::steady_clock::now();
  HostStream host(scene, config_, held);
  model_->hold_textures(scene);
  memory_.show(scene.width, scene.height);
  model_->begin(scene.width, scene.height, start_, render.threads);
  DrawnCount drawn;
  std::uint32_t sent = 0;
  while (const HostPrimitive* const primitive = host.pull()) {
    drawn.add(*primitive, model_->run(*primitive));
    if (render.progress && ++sent % 256 == 0) render.progress(host.progress());
  }
  model_->end();
  resolve(model_->rendering().frame, config_.color_format);
  Framebuffer kept;  // where the next frame does not draw; without bins it begins with a clear of all
  if (held != nullptr && compares_bins(config_)) kept = model_->rendering().frame;
  model_->complete();
  CycleRendering result{std::move(model_->rendering()), {}, std::move(model_->cost()), std::move(model_->misses())};
  model_->rendering().frame = std::move(kept);
  result.rendering.counters = host.counters();
  count_hardware(since(model_->counters(), counted_), drawn.count(), result.rendering.counters);
  result.rendering.raster_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  CycleRun& run = result.run;
  run.totals = since(model_->totals(), totals_);
  run.cycles = model_->totals().last + 1 - start_;
  run.raster_cycles = run.totals.raster_cycles();
  run.tile_cycles = run.totals.tile_cycles;
  run.totals.works[index(Stage::framebuffer)] =
      run.totals.move_cycles - std::min(run.totals.move_cycles, run.totals.memory_cycles);
  for (const Arrow arrow : kElastic) {
    const StreamUse now = model_->stream(arrow).use(0), before = std::exchange(use_[index(arrow)], now);
    StreamUse& use = run.use[index(arrow)];
    use.busy = now.busy - before.busy;
    use.stalled = now.stalled - before.stalled;
    use.starved = run.cycles - use.busy - use.stalled;
  }
  run.others = since(memory_.use(), others_);
  others_ = memory_.use();
  counted_ = model_->counters();
  totals_ = model_->totals();
  start_ = totals_.last + 1;
  return result;
}

CycleRendering render_cycle(const Scene& scene, const Config& config, MemoryTiming& memory, const RenderOptions& render,
                            const CycleOptions& options) {
  CycleOptions wanted = options;
  wanted.want_count = render.want_count;
  wanted.want_ids = render.want_ids;
  return CycleFrames(config, memory, wanted).draw(scene, render, nullptr);
}

}  // namespace halfplane
