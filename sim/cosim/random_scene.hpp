// Random scenes for co-simulation: made to be nasty, not to look like anything.
#pragma once

#include <cstdint>

#include "model/config.hpp"
#include "model/scene.hpp"

namespace halfplane {

/// A scene of `count` window-space triangles, lines and points on a random target within 640x480 and the configuration's (a
/// quarter of that with stamps of one sample). Sizes are log-uniform from one subpixel to the whole guard band. The same for
/// the same arguments on every machine. Every vertex snaps.
///
/// What it is rich in: vertices on pixel centres and tile corners, shared edges, slivers, triangles of zero area and
/// outside, piles of one triangle, equal depths, every depth function, mask, cull, front and scissor, partial
/// and whole clears, tiles covered completely.
[[nodiscard]] Scene random_scene(const Config& config, std::uint64_t seed, std::size_t count);

/// `scene` as it may look a frame later: a draw less, two vertices with each other's colour, depth or place on a texture, other
/// clears, or the same.
[[nodiscard]] Scene next_frame(const Scene& scene, std::uint64_t seed);

}  // namespace halfplane
