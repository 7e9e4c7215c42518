#include "sim/cosim/rtl_engine.hpp"

#include <chrono>
#include <stdexcept>

namespace halfplane {

RtlRendering render_rtl(Dut& dut, const Scene& scene, const Config& config, const RenderOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  check_hardware_scene(scene, config);
  if (options.rules != StudyRules{})
    throw InputError("the RTL has no other traversal, fill rule or clipping; use the scalar engine");
  LockstepOptions lockstep_options;
  lockstep_options.compares = false;
  if (options.progress)
    lockstep_options.progress = [&options](double fraction) {
      options.progress(fraction);
      return true;
    };
  Lockstep lockstep(dut, config, lockstep_options);
  RtlRendering result;
  result.run = lockstep.run(scene);
  if (result.run.mismatch) throw std::runtime_error("the RTL hangs: " + result.run.mismatch->hint);
  result.rendering.frame = to_framebuffer(lockstep.memory(), scene.width, scene.height, config);
  const CounterPacket counted = lockstep.counters();
  if (config.counter_units == 0 || counted.overflow) {  // no counters, or an overflow: use the specification's counts
    result.rendering.counters = render_hardware(scene, config, {}).counters;
  } else {
    result.rendering.counters = lockstep.host_counters();
    count_hardware(counted, result.run.drawn, result.rendering.counters);
  }
  result.rendering.raster_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

RtlFrames::RtlFrames(Dut& dut, const Config& config)
    : config_(config),
      lockstep_(dut, config,
                [this] {
                  LockstepOptions options;
                  options.compares = false;
                  options.progress = [this](double fraction) {
                    if (progress_) progress_(fraction);
                    return true;
                  };
                  return options;
                }()),
      specification_(config) {}

RtlRendering RtlFrames::draw(const Scene& scene, const RenderOptions& options) {
  check_hardware_scene(scene, config_);
  progress_ = options.progress;
  RtlRendering result;
  result.run = lockstep_.run(scene, config_, !options.skip.bins);
  if (result.run.mismatch) throw std::runtime_error("the RTL hangs: " + result.run.mismatch->hint);
  RenderOptions quiet;
  quiet.skip = options.skip;
  result.rendering.counters = specification_.draw(scene, quiet).counters;
  result.rendering.frame = to_framebuffer(lockstep_.memory(), scene.width, scene.height, config_);
  return result;
}

FaultyFrame render_faulty(Dut& dut, const Scene& scene, const Config& config, std::uint16_t mutant,
                          std::uint64_t most_cycles) {
  LockstepOptions options;
  options.compares = false;
  options.mutant = mutant;
  // Called every 2^16 cycles.
  options.progress = [most_cycles, spent = std::uint64_t{0}](double) mutable {
    return (spent += std::uint64_t{1} << 16) < most_cycles;
  };
  Lockstep lockstep(dut, config, options);
  const LockstepResult run = lockstep.run(scene);
  FaultyFrame result{{}, run.cycles};
  if (!run.mismatch && !run.is_stopped)
    result.frame = to_framebuffer(lockstep.memory(), scene.width, scene.height, config);
  return result;
}

}  // namespace halfplane
