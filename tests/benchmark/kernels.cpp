// The functional engine's kernels one by one, for every instruction set that this machine has: how many vertices,
// triangles, blocks and tiles a second on one thread. Google Benchmark; `./dev bench kernels` builds and runs it.
#include <benchmark/benchmark.h>

#include <string>

#include "model/engines/functional.hpp"
#include "model/engines/functional/kernels.hpp"
#include "sim/scene/builtin.hpp"

namespace halfplane {
namespace {

/// A scene in which one kind of work is nearly all of it.
struct Work {
  const char* name;
  const char* scene;
  State change;  ///< every state: cull and depth test
  bool skips;
  std::uint64_t (*items)(const Counters&);
};

State with(Cull cull, DepthFunc test) {
  State state;
  state.cull = cull;
  state.depth_test = test;
  return state;
}

void run(benchmark::State& bench, const Work& work, const char* instruction_set) {
  Scene scene = make_builtin(work.scene, 1280, 720, {}, 1);
  for (State& state : scene.states) {
    state.cull = work.change.cull;
    state.depth_test = work.change.depth_test;
  }
  const PreparedScene prepared(scene);
  FunctionalEngine engine(preset("embedded"));
  RenderOptions options;
  options.instruction_set = instruction_set;
  if (!work.skips) options.skip = skip_none();
  std::uint64_t items = 0;
  for (auto _ : bench) items += work.items(engine.render(prepared, options).counters);
  bench.SetItemsProcessed(static_cast<std::int64_t>(items));
}

}  // namespace
}  // namespace halfplane

int main(int argc, char** argv) {
  using namespace halfplane;
  const Work works[] = {
      {"project and cull, triangles", "ball", with(Cull::both, DepthFunc::less), true,
       [](const Counters& c) { return c.primitives_in; }},
      {"small triangles behind their tiles", "dust:200000", with(Cull::none, DepthFunc::never), true,
       [](const Counters& c) { return c.drawn; }},
      {"small triangles", "dust:200000", with(Cull::none, DepthFunc::always), true,
       [](const Counters& c) { return c.drawn; }},
      {"fragments of small triangles", "ball", with(Cull::back, DepthFunc::always), true,
       [](const Counters& c) { return c.covered; }},
      {"tiles taken", "layers:256", with(Cull::none, DepthFunc::always), true,
       [](const Counters& c) { return c.skipped.trivially_accepted; }},
      {"tiles behind", "layers_front:256", with(Cull::none, DepthFunc::less), true,
       [](const Counters& c) { return c.skipped.tiles_hiz; }},
      {"fragments that are tested one by one", "layers:16", with(Cull::none, DepthFunc::less), false,
       [](const Counters& c) { return c.covered; }},
      {"fragments with nearest texels", "layers_nearest:16", with(Cull::none, DepthFunc::less), false,
       [](const Counters& c) { return c.covered; }},
      {"fragments with linear filter", "layers_linear:16", with(Cull::none, DepthFunc::less), false,
       [](const Counters& c) { return c.covered; }},
      {"pixels of lines", "scratches:10000", with(Cull::none, DepthFunc::always), true,
       [](const Counters& c) { return c.covered; }},
  };
  for (const Work& work : works)
    for (const functional::Kernels* kernels : functional::available_kernels())
      benchmark::RegisterBenchmark((std::string(work.name) + "/" + kernels->name).c_str(),
                                   [&work, kernels](benchmark::State& bench) { run(bench, work, kernels->name); })
          ->Unit(benchmark::kMillisecond);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
