#define HALFPLANE_ISA 512
#define HALFPLANE_ISA_NAME avx512
#include "../../model/engines/functional/kernel_headers.hpp"
#include "shade_kernels.hpp"

#if defined(__x86_64__) && !defined(__clang__)
#pragma GCC push_options
#pragma GCC target("avx512f,avx512bw,avx512dq,avx512vl,avx2,bmi,bmi2,popcnt")
#include "shade_lanes.inl"
#pragma GCC pop_options

namespace halfplane::gl {

const ShadeKernels kAvx512Shading{"avx512", avx512::place, avx512::finish, avx512::traits};

}  // namespace halfplane::gl
#endif
