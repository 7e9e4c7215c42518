#define HALFPLANE_ISA 128
#define HALFPLANE_ISA_NAME portable
#include "../../model/engines/functional/kernel_headers.hpp"
#include "shade_kernels.hpp"

#include "shade_lanes.inl"

namespace halfplane::gl {

const ShadeKernels kPortableShading{"portable", portable::place, portable::finish, portable::traits};

}  // namespace halfplane::gl
