// The instruction sets that the functional engine's loops are compiled for.
#pragma once

#include <span>

#include "frame.hpp"

namespace halfplane::functional {

extern const Kernels kPortableKernels;
#if defined(__x86_64__) && !defined(__clang__)
extern const Kernels kAvx2Kernels, kAvx512Kernels;
#endif

/// The kernels that this machine can run, the fastest first; the portable ones are always among them.
[[nodiscard]] std::span<const Kernels* const> available_kernels();

}  // namespace halfplane::functional
