// Draws frames of a built-in scene with the functional engine's AVX2 kernels on one thread, for tools/instructions.py to
// count: the first allocates memory, later ones only draw. Arguments: scene, width, height, frames. Status 77: no AVX2.
#include <algorithm>
#include <cstdlib>

#include "model/engines/functional.hpp"
#include "model/engines/functional/kernels.hpp"
#include "sim/scene/builtin.hpp"

int main(int argc, char** argv) {
  using namespace halfplane;
  if (argc != 5) return 2;
  Config config = preset("embedded");
  set(config, "color.format", "rgba8888");
  const Scene scene = make_builtin(argv[1], std::atoi(argv[2]), std::atoi(argv[3]), {}, 1);
  const PreparedScene prepared(scene);
  FunctionalEngine engine(config);
  RenderOptions options;
  options.threads = 1;
  options.instruction_set = "avx2";
  const auto is_it = [&](const functional::Kernels* kernels) { return kernels->name == options.instruction_set; };
  if (std::ranges::none_of(functional::available_kernels(), is_it)) return 77;
  std::uint64_t written = 0;
  for (int frame = 0; frame < std::atoi(argv[4]); ++frame) written = engine.render(prepared, options).counters.written;
  return written != 0 ? 0 : 1;
}
