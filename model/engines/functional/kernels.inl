// The kernels, for the instruction set that HALFPLANE_ISA names (512, 256 or 128 bits), in a namespace of its own:
// HALFPLANE_ISA_NAME. Everything in it is compiled for that set, and nothing else is.

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

// Each room stands on those above it.
// clang-format off
#include "kernels/lanes.inl"            // vectors of a fixed number of lanes
#include "kernels/lane_moves.inl"       // lanes to bits, to one number, to memory and back
#include "kernels/leaf.inl"             // the leaf arithmetic of the stages
#include "kernels/project.inl"          // vertices: viewport, snap, codes
#include "kernels/cull.inl"             // triangles to records
#include "kernels/cull_lines.inl"       // lines to records
#include "kernels/small_batch.inl"      // sixteen small triangles: records, corners, edges
#include "kernels/small_setup.inl"      // their planes
#include "kernels/small_samples.inl"    // and what these gain from centres to samples
#include "kernels/line_setup.inl"       // sixteen lines through line_setup
#include "kernels/bin.inl"              // the state of a bin
#include "kernels/values.inl"           // depths and colours of a tile
#include "kernels/tile_memory.inl"      // where a tile's pixels are, and their range
#include "kernels/fragments.inl"        // what a draw needs of its fragments
#include "kernels/setup.inl"            // one triangle through triangle_setup
#include "kernels/perspective.inl"      // attributes over w
#include "kernels/level_of_detail.inl"  // how many texels a pixel spans
#include "kernels/texture.inl"          // texels of sixteen pixels
#include "kernels/light.inl"            // light of sixteen pixels
#include "kernels/surface.inl"          // colours of a tile's pixels from them
#include "kernels/pieces.inl"           // surfaces of small triangles, sixteen at a time
#include "kernels/piece_colors.inl"     // colours of pixels that show them
#include "kernels/seen.inl"             // whose colours wait
#include "kernels/layers.inl"           // blended triangles that wait on whole tiles
#include "kernels/operations.inl"       // alpha test, blending, masks
#include "kernels/samples.inl"          // small triangles: samples
#include "kernels/small.inl"            // and blocks
#include "kernels/tiles.inl"            // large triangles: tiles
#include "kernels/cutouts.inl"          // cut ones that wait where pixels have several samples
#include "kernels/multisample.inl"      // the same where pixels have several samples
#include "kernels/sampled_blocks.inl"   // blocks of small triangles where they have
#include "kernels/lines.inl"            // pixels of lines
#include "kernels/general.inl"          // fragments one by one
#include "kernels/finish.inl"           // the end of a bin
#include "kernels/raster.inl"           // a bin's records in their order
// clang-format on

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
