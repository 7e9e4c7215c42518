#include "kernels.hpp"

#include <stdexcept>
#include <vector>

namespace halfplane::functional {

std::span<const Kernels* const> available_kernels() {
  static const std::vector<const Kernels*> found = [] {
    std::vector<const Kernels*> kernels;
#if defined(__x86_64__) && !defined(__clang__)
    __builtin_cpu_init();
    [[maybe_unused]] const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
                                           __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt");
#ifndef HALFPLANE_WITHOUT_AVX512
    if (has_avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
      kernels.push_back(&kAvx512Kernels);
#endif
#ifndef HALFPLANE_WITHOUT_AVX2
    if (has_avx2) kernels.push_back(&kAvx2Kernels);
#endif
#endif
#ifndef HALFPLANE_WITHOUT_PORTABLE
    kernels.push_back(&kPortableKernels);
#endif
    if (kernels.empty())
      throw std::runtime_error(
          "the functional engine was built for another processor (HALFPLANE_KERNELS); run ./dev build");
    return kernels;
  }();
  return found;
}

}  // namespace halfplane::functional
