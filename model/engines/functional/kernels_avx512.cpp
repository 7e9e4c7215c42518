#define HALFPLANE_ISA 512
#define HALFPLANE_ISA_NAME avx512
#include "kernel_headers.hpp"

#if defined(__x86_64__) && !defined(__clang__)
#pragma GCC push_options
#pragma GCC target("avx512f,avx512bw,avx512dq,avx512vl,avx2,bmi,bmi2,popcnt")
#include "kernels/cull.inl"
#include "kernels/cull_lines.inl"
#include "kernels/project.inl"
#include "kernels/raster.inl"
#include "kernels/smooth.inl"
#pragma GCC pop_options

namespace halfplane::functional {

const Kernels kAvx512Kernels{"avx512",           avx512::project, avx512::cull,
                             avx512::cull_lines, avx512::raster,  avx512::smooth_coverage};

}  // namespace halfplane::functional
#endif
