// Draws frames of a built-in scene on one thread, for tools/instructions.py: the first allocates memory, later ones only
// draw, and callgrind counts the last. Arguments: engine, scene, width, height, frames, samples a pixel; engine functional
// draws with its AVX2 kernels, cycle with its own memory. Status 77: no AVX2.
#include <valgrind/callgrind.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "model/engines/cycle/cycle_model.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/functional/kernels.hpp"
#include "sim/scene/builtin.hpp"

namespace {

using namespace halfplane;

int draw_functional(const Scene& scene, Config config, int frames) {
  set(config, "color.format", "rgba8888");
  const PreparedScene prepared(scene);
  FunctionalEngine engine(config);
  RenderOptions options;
  options.threads = 1;
  options.resolved_only = true;
  options.instruction_set = "avx2";
  const auto is_it = [&](const functional::Kernels* kernels) { return kernels->name == options.instruction_set; };
  if (std::ranges::none_of(functional::available_kernels(), is_it)) return 77;
  std::uint64_t written = 0;
  for (int frame = 0; frame < frames; ++frame) {
    CALLGRIND_ZERO_STATS;
    written = engine.render(prepared, options).counters.written;
  }
  return written != 0 ? 0 : 1;
}

int draw_cycle(const Scene& scene, const Config& config, int frames) {
  const auto memory = make_memory({}, config);
  CycleFrames engine(config, *memory);
  Cycle cycles = 0;
  for (int frame = 0; frame < frames; ++frame) {
    CALLGRIND_ZERO_STATS;
    cycles = engine.draw(scene).run.cycles;
  }
  return cycles != 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 7) return 2;
  const Scene scene = make_builtin(argv[2], std::atoi(argv[3]), std::atoi(argv[4]), {}, 1);
  Config config = preset("embedded");
  set(config, "msaa.samples", argv[6]);
  const int frames = std::atoi(argv[5]);
  return std::string_view(argv[1]) == "cycle" ? draw_cycle(scene, config, frames)
                                              : draw_functional(scene, config, frames);
}
