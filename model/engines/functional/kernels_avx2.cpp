#define HALFPLANE_ISA 256
#define HALFPLANE_ISA_NAME avx2
#include "kernel_headers.hpp"

#if defined(__x86_64__) && !defined(__clang__)
#pragma GCC push_options
#pragma GCC target("avx2,bmi,bmi2,popcnt")
#include "kernels/cull.inl"
#include "kernels/cull_lines.inl"
#include "kernels/project.inl"
#include "kernels/raster.inl"
#include "kernels/smooth.inl"
#pragma GCC pop_options

namespace halfplane::functional {

const Kernels kAvx2Kernels{"avx2", avx2::project, avx2::cull, avx2::cull_lines, avx2::raster, avx2::smooth_coverage};

}  // namespace halfplane::functional
#endif
