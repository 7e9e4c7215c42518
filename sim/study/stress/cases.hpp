// The cases: one for each entry of the stress list (docs/stress.md), and more.
#pragma once

#include <span>
#include <string_view>

#include "sim/study/stress/unit.hpp"

namespace halfplane::stress {

struct Case {
  std::string_view name;
  std::string_view item;         ///< of the stress list; "" for what is not on it
  std::string_view property;     ///< in words
  void (*run)(Unit&);            ///< makes one random input and checks it
  int every = 1;                 ///< runs in every so manieth round: dear units run more rarely
  bool own_configs = false;      ///< chooses its configurations itself
  bool prefers_presets = false;  ///< half of its units run in the presets
};

/// In the order of the list.
[[nodiscard]] std::span<const Case> cases();

// mesh_cases.cpp
void pixel_centres(Unit& unit);
void fans(Unit& unit);
void delaunay_small(Unit& unit);
void delaunay_large(Unit& unit);
void t_junctions(Unit& unit);
void close_edges(Unit& unit);
// triangle_cases.cpp
void random_families(Unit& unit);
void large_target(Unit& unit);
void vertex_orders(Unit& unit);
void zero_area(Unit& unit);
void unit_area_slivers(Unit& unit);
void snap_flip(Unit& unit);
void guard_band_corners(Unit& unit);
void half_subpixel_rounding(Unit& unit);
void translation(Unit& unit);
// plane_cases.cpp
void steep_planes(Unit& unit);
void cancellation(Unit& unit);
void coplanar(Unit& unit);
void separation(Unit& unit);
void polygon_offset(Unit& unit);
void mean_bias(Unit& unit);
void subpixel_sweep(Unit& unit);
void depth_sweep(Unit& unit);
// clip_cases.cpp
void near_plane(Unit& unit);
void w_ratio(Unit& unit);
void closed_meshes(Unit& unit);
void slabs(Unit& unit);
void scissor(Unit& unit);
void viewports(Unit& unit);
// line_cases.cpp
void lines_random(Unit& unit);
void lines_octants(Unit& unit);
void lines_long(Unit& unit);
void polylines(Unit& unit);
void wires(Unit& unit);
// texture_cases.cpp
void textured_w_ratio(Unit& unit);
void textured_slivers(Unit& unit);
void texel_borders(Unit& unit);
void texture_repeats(Unit& unit);
void texture_mirrors(Unit& unit);
void texture_of_one_texel(Unit& unit);
void constant_coordinate(Unit& unit);
void equal_w(Unit& unit);
void q_near_one(Unit& unit);
void wrap_across_a_tile(Unit& unit);
void levels_along_a_scanline(Unit& unit);
void texture_viewport(Unit& unit);
// fragment_cases.cpp
void random_operations(Unit& unit);
void layers(Unit& unit);
void opaque_blend(Unit& unit);
void alpha_parts(Unit& unit);
void mask_parts(Unit& unit);
void stencil_counts(Unit& unit);
void fog(Unit& unit);
void light(Unit& unit);
// sample_cases.cpp
void samples(Unit& unit);
void rectangles(Unit& unit);
// engine_cases.cpp
void traversals(Unit& unit);
void fill_rules(Unit& unit);
void full_guard_band(Unit& unit);
void stalls(Unit& unit);
void frames(Unit& unit);
void hardware_surfaces(Unit& unit);
// search.cpp
void adversarial_depth(Unit& unit);
void adversarial_interpolation(Unit& unit);
void adversarial_color(Unit& unit);

}  // namespace halfplane::stress
