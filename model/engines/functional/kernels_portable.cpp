#define HALFPLANE_ISA 128
#define HALFPLANE_ISA_NAME portable
#include "kernel_headers.hpp"
#include "kernels/cull.inl"
#include "kernels/cull_lines.inl"
#include "kernels/project.inl"
#include "kernels/raster.inl"
#include "kernels/smooth.inl"

namespace halfplane::functional {

const Kernels kPortableKernels{"portable",           portable::project, portable::cull,
                               portable::cull_lines, portable::raster,  portable::smooth_coverage};

}  // namespace halfplane::functional
