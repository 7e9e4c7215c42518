#include "sim/study/bench/engines.hpp"

#include <chrono>
#include <string>
#include <type_traits>
#include <utility>

#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/golden.hpp"
#include "model/host/primitive_stream.hpp"
#include "sim/cosim/rtl_engine.hpp"
#include "sim/study/bench/mesa_peer.hpp"

namespace halfplane {
namespace {

/// Timed by the wall clock; `work` returns its cycles, or nothing.
template <typename Work>
FrameCost timed_frame(Work&& work) {
  FrameCost cost;
  const auto start = std::chrono::steady_clock::now();
  if constexpr (std::is_void_v<decltype(work())>)
    work();
  else
    cost.cycles = work();
  cost.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return cost;
}

Frame functional_frame(std::shared_ptr<const Scene> scene, const Config& config, int threads) {
  RenderOptions options;
  options.threads = threads;
  options.resolved_only = true;
  // Prepared once, as the peer's buffers are filled once. The scene must live as long.
  auto prepared = std::make_shared<PreparedScene>(*scene);
  return [engine = std::make_shared<FunctionalEngine>(config), scene = std::move(scene), prepared, options] {
    return timed_frame([&] { (void)engine->render(*prepared, options); });
  };
}

Frame rtl_frame(std::shared_ptr<const Scene> scene, const Config& config, const RenderOptions& options) {
  return [dut = std::shared_ptr<Dut>(make_dut(find_dut(config))), scene = std::move(scene), config, options] {
    return timed_frame([&] { return render_rtl(*dut, *scene, config, options).run.cycles; });
  };
}

/// Frame after frame through one chip, and all of each: no bin is left as it was.
Frame cycle_frame(std::shared_ptr<const Scene> scene, const Config& config, RenderOptions options) {
  struct Chip {
    explicit Chip(const Config& config) : memory(make_memory({}, config)), frames(config, *memory) {}
    std::unique_ptr<MemoryTiming> memory;
    CycleFrames frames;
  };
  options.skip.bins = false;
  return [chip = std::make_shared<Chip>(config), scene = std::move(scene), options] {
    return timed_frame([&] { return chip->frames.draw(*scene, options).run.cycles; });
  };
}

Frame llvmpipe_frame(const Scene& scene, const Config& config, int threads) {
  auto peer = std::make_shared<MesaPeer>(scene.width, scene.height, config.depth_bits, threads, config.msaa_samples);
  peer->upload(scene);
  (void)peer->render();  // compiles shaders: a frame of many states would pass for a slow one
  return [peer] { return FrameCost{peer->render(), 0}; };
}

}  // namespace

bool has_threads(std::string_view engine) {
  return engine == "functional" || engine == "cycle" || engine == "llvmpipe";
}

bool is_bit_exact(std::string_view engine) { return engine != "golden" && engine != "llvmpipe"; }

Frame make_frame(std::string_view engine, std::shared_ptr<const Scene> scene, const Config& config, int threads,
                 const std::function<void()>& poll) {
  RenderOptions options;
  options.threads = threads;
  if (poll) options.progress = [poll](double) { poll(); };
  if (engine == "llvmpipe" &&
      ((config.msaa_samples != 1 && config.msaa_samples != 4) || config.msaa_pattern.count != 0))
    throw InputError(
        "msaa.samples: llvmpipe has one sample a pixel, or four in their standard places; use one of these");
  if (engine == "functional") return functional_frame(std::move(scene), config, threads);
  if (engine == "llvmpipe") return llvmpipe_frame(*scene, config, threads);
  if (engine == "cycle" || engine == "rtl") check_hardware_scene(*scene, config);
  if (engine == "rtl") return rtl_frame(std::move(scene), config, options);
  if (engine == "cycle") return cycle_frame(std::move(scene), config, options);
  if (engine == "scalar")
    return [scene = std::move(scene), config, options] {
      return timed_frame([&] { (void)render_scalar(*scene, config, options); });
    };
  if (engine == "golden") {
    golden::Options golden;
    golden.progress = options.progress;
    return [scene = std::move(scene), config, golden] {
      return timed_frame([&] { (void)golden::render(*scene, config, golden); });
    };
  }
  throw InputError("no engine '" + std::string(engine) + "'");
}

}  // namespace halfplane
