#define HALFPLANE_ISA 256
#define HALFPLANE_ISA_NAME avx2
#include "../../model/engines/functional/kernel_headers.hpp"
#include "shade_kernels.hpp"

#if defined(__x86_64__) && !defined(__clang__)
#pragma GCC push_options
#pragma GCC target("avx2,bmi,bmi2,popcnt")
#include "shade_lanes.inl"
#pragma GCC pop_options

namespace halfplane::gl {

const ShadeKernels kAvx2Shading{"avx2", avx2::place, avx2::finish, avx2::traits};

}  // namespace halfplane::gl
#endif
