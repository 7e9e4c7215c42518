// The cases: one for each entry of the stress list (docs/stress.md), and more.
#pragma once

#include <span>
#include <string_view>

#include "sim/study/stress/unit.hpp"

namespace halfplane::stress {

struct Case {
  std::string_view name;
  std::string_view item;         ///< of the stress list; "" for cases not on it
  std::string_view property;     ///< in words
  void (*run)(Unit&);            ///< makes one random input and checks it
  int every = 1;                 ///< runs once in this many rounds: for expensive units
  bool own_configs = false;      ///< chooses its own configurations
  bool prefers_presets = false;  ///< half of its units run in the presets
};

/// In the order of the list.
[[nodiscard]] std::span<const Case> cases();

using RunCase = void(Unit& unit);
// mesh_cases.cpp
RunCase pixel_centres, fans, delaunay_small, delaunay_large, t_junctions, close_edges;
// triangle_cases.cpp
RunCase random_families, large_target, vertex_orders, zero_area, unit_area_slivers, snap_flip, guard_band_corners,
    half_subpixel_rounding, translation;
// plane_cases.cpp
RunCase steep_planes, cancellation, coplanar, separation, polygon_offset, mean_bias, subpixel_sweep, depth_sweep;
// clip_cases.cpp
RunCase near_plane, w_ratio, closed_meshes, slabs, scissor, viewports;
// line_cases.cpp
RunCase lines_random, lines_octants, lines_long, polylines, wires;
// texture_cases.cpp
RunCase textured_w_ratio, textured_slivers, texel_borders, texture_repeats, texture_mirrors, texture_of_one_texel,
    constant_coordinate, equal_w, q_near_one, wrap_across_a_tile, levels_along_a_scanline, texture_viewport;
// fragment_cases.cpp
RunCase random_operations, layers, opaque_blend, alpha_parts, mask_parts, stencil_counts, fog, light, logic_ops;
// sample_cases.cpp
RunCase samples, rectangles;
// engine_cases.cpp
RunCase traversals, fill_rules, full_guard_band, stalls, frames, hardware_surfaces;
// search.cpp
RunCase adversarial_depth, adversarial_interpolation, adversarial_color;

}  // namespace halfplane::stress
