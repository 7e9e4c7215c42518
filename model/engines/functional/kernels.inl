// The kernels, for the instruction set that HALFPLANE_ISA names (512, 256 or 128 bits), in a namespace of its own:
// HALFPLANE_ISA_NAME. Everything in it is compiled for that set, and nothing else is.

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

#include "lane_ops.inl"

#include "geometry.inl"

#include "line_geometry.inl"

#include "raster.inl"

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
