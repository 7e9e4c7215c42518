#include "sim/study/stress/cases.hpp"

#include <array>

namespace halfplane::stress {
namespace {

constexpr std::array kCases{
    Case{"pixel_centres", "1", "right triangles with vertices on pixel centres: each centre once", pixel_centres},
    Case{"fans", "2", "3 to 64 blades round a centre, a corner, a half-edge point: each pixel once", fans},
    Case{"delaunay", "3", "shuffled Delaunay meshes, also on the half-pixel grid: each pixel once", delaunay_small},
    Case{"delaunay_large", "3", "the same with 100,000 triangles", delaunay_large, 64},
    Case{"t_junctions", "4", "on the snapped edge: each pixel once; off it: wrong by its sliver and no more",
         t_junctions},
    Case{"close_edges", "5", "shared edges one subpixel apart: each pixel once", close_edges},
    Case{"vertex_orders", "6", "all six orders, both windings: the same image", vertex_orders},
    Case{"zero_area", "7", "collinear, coincident, snapped to a line or a point: nothing drawn", zero_area},
    Case{"unit_area_slivers", "8", "twice the area one square subpixel, across the screen", unit_area_slivers},
    Case{"snap_flip", "9", "orientation turned by the snap: culled as snapped", snap_flip},
    Case{"guard_band_corners", "10", "corners in all sign patterns; one subpixel beyond is refused",
         guard_band_corners},
    Case{"full_guard_band", "11", "stepped over the whole guard band: equal to direct evaluation", full_guard_band},
    Case{"traversals", "12", "tiled, bbox, scanline, brute, serpentine: the same image", traversals},
    Case{"steep_planes", "13", "full range in a pixel, below an LSB, extreme codes, leaving the range", steep_planes},
    Case{"near_plane", "14", "cut by near, far, guard band: the rational clip to a subpixel", near_plane},
    Case{"closed_meshes", "14", "a closed mesh round the eye, cut by near and sides: each pixel once", closed_meshes},
    Case{"slabs", "14", "a sheet through all six planes: no pixel twice, none left out inside", slabs},
    Case{"w_ratio", "15", "w from 1 to 10^6 across a triangle: the rational clip to a subpixel", w_ratio},
    Case{"coplanar", "16", "coplanar pairs by every depth function; two tessellations of one plane", coplanar},
    Case{"separation", "17", "planes at the predicted minimum never fight, at half of it they do", separation, 16},
    Case{"cancellation", "18", "products that cancel: a gradient of exactly 0", cancellation},
    Case{"lines_octants", "19", "octants, axes, 45 degrees, ties, diamond corners, no length, reversal", lines_octants},
    Case{"lines_random", "19", "random lines by every rule against the exact oracle", lines_random},
    Case{"lines_long", "19", "16384 pixels at slopes 1/16383, 8191/16384, 0, 1/2, 1", lines_long, 16},
    Case{"polylines", "19", "diamond exit along a polyline: no pixel twice, no column left out", polylines},
    Case{"wires", "19", "outlines and points through the engine, scissored: the exact oracle's pixels", wires},
    Case{"scissor", "20", "a part of the unscissored image, 1x1, odd and on tile edges", scissor},
    Case{"viewports", "20", "1x1 and odd viewports: inside once, outside nothing", viewports},
    Case{"subpixel_sweep", "21", "S = 0...8: what the snap costs halves with every bit", subpixel_sweep, 64, true},
    Case{"depth_sweep", "21", "B = 8...32: depth errors halve with every bit down to their floor", depth_sweep, 64,
         true},
    Case{"half_subpixel_rounding", "22", "halves of a subpixel and negative coordinates: floor(x + 1/2)",
         half_subpixel_rounding},
    Case{"polygon_offset", "23", "r = 1 LSB moves every code by one; a decal wins; floor(f m + c + 1/2)",
         polygon_offset},
    Case{"stalls", "24", "cycle engine with random stalls and memories: the same image", stalls, 16},
    Case{"textured_w_ratio", "t1", "w ratios to 10^6: coordinates, levels, texels, colours within their bounds",
         textured_w_ratio},
    Case{"textured_slivers", "t2", "slivers and triangles that hold the whole screen", textured_slivers},
    Case{"texel_borders", "t3", "pixel centres on borders of texels: one of the two", texel_borders},
    Case{"texture_repeats", "t4", "16 repeats; whole periods more: the same image", texture_repeats},
    Case{"texture_mirrors", "t5", "mirrored at negative places; whole periods more: the same image", texture_mirrors},
    Case{"texture_of_one_texel", "t6", "1x1 texels: that texel everywhere", texture_of_one_texel},
    Case{"constant_coordinate", "t7", "u constant on its grid: exactly that", constant_coordinate},
    Case{"equal_w", "t8", "w the same at all vertices: a power of two gives the affine image", equal_w},
    Case{"q_near_one", "t9", "w beside a power of two", q_near_one},
    Case{"wrap_across_a_tile", "t10", "an image ends every few pixels", wrap_across_a_tile},
    Case{"levels_along_a_scanline", "t11", "all levels on a row", levels_along_a_scanline},
    Case{"texture_viewport", "t12", "a texel a pixel: the image itself, at every size and offset", texture_viewport},
    Case{"random_families", "", "random and nasty triangles of eight families", random_families},
    Case{"large_target", "", "the same far from the first tile of the widest target", large_target},
    Case{"translation", "", "by tiles: the same image, moved; by pixels: the same coverage", translation},
    Case{"fill_rules", "", "offset_point and inclusive against their own oracles", fill_rules},
    Case{"mean_bias", "", "mean depth error of each configuration below 0.05 LSB", mean_bias},
    Case{"adversarial_depth", "", "hill climbing towards larger depth errors; measured again in rationals",
         adversarial_depth, 2, false, true},
    Case{"adversarial_interpolation", "", "the same before the last rounding", adversarial_interpolation, 2, false,
         true},
    Case{"adversarial_color", "", "the same for stored colours", adversarial_color, 2, false, true},
};

}  // namespace

std::span<const Case> cases() { return kCases; }

}  // namespace halfplane::stress
