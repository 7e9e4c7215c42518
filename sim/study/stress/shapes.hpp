// Vertices and scenes on the grid of snapped coordinates, for the cases.
#pragma once

#include "sim/scene/scene_builder.hpp"
#include "sim/study/stress/delaunay.hpp"

namespace halfplane::stress {

/// A window-space vertex that snaps to the grid point `p` and the depth code `z`.
[[nodiscard]] Vertex vertex_at(const Unit& unit, Point p, std::uint32_t z);

/// The window z that snaps to a code.
[[nodiscard]] double depth_of(const Config& config, std::uint32_t code);

[[nodiscard]] std::uint32_t max_depth(const Config& config);

/// A random code, one in four of them the smallest or the largest.
[[nodiscard]] std::uint32_t random_depth(Unit& unit);

/// Whole numbers 0...255, one channel in four at an end of the range.
[[nodiscard]] std::array<double, 4> random_color(Random& random);

/// A vertex at a grid point with random depth and colour.
[[nodiscard]] Vertex random_vertex_at(Unit& unit, Point p);

/// Anywhere within `margin` pixels around the target, and inside the guard band.
[[nodiscard]] Point random_point(Unit& unit, int width, int height, int margin);

/// Anywhere in the guard band.
[[nodiscard]] Point random_guard_point(Unit& unit);

/// The smallest and the largest grid coordinate.
[[nodiscard]] std::int64_t lowest(const Unit& unit);
[[nodiscard]] std::int64_t highest(const Unit& unit);

/// Draws a mesh in random order with mixed windings, every vertex of every triangle with a depth and a colour of its own.
[[nodiscard]] Scene mesh_scene(Unit& unit, Mesh mesh, int width, int height);

/// Draws the mesh, compares it with the oracle, and requires the pixels of `outline` (convex, clockwise) to be covered
/// once.
void check_mesh(Unit& unit, const Mesh& mesh, int width, int height, std::span<const Point> outline);

/// Whether the triangle, of either orientation, covers the centre of pixel (x, y). As polygon_covers; area 0 covers
/// nothing.
[[nodiscard]] bool triangle_covers(Corner t, int x, int y, int subpixel_bits);

/// One triangle as a scene of its own.
[[nodiscard]] Scene single(int width, int height, const std::array<Vertex, 3>& v,
                           const State& state = SceneBuilder::window_state());

}  // namespace halfplane::stress
