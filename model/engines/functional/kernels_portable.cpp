#include "kernel_headers.hpp"

#define HALFPLANE_ISA 128
#define HALFPLANE_ISA_NAME portable
#include "kernels.inl"

namespace halfplane::functional {

const Kernels kPortableKernels{"portable", portable::project, portable::cull, portable::cull_lines, portable::raster};

}  // namespace halfplane::functional
