// Random scenes for co-simulation: made to provoke faults, not to look like anything.
#pragma once

#include <cstdint>

#include "model/config.hpp"
#include "model/scene.hpp"
#include "sim/cosim/random_profile.hpp"

namespace halfplane {

/// A scene of `count` window-space triangles, lines and points on a random target within 640x480 and the configuration's (a
/// quarter of that with stamps of one sample). Sizes are log-uniform from one subpixel to the whole guard band. The same for
/// the same arguments on every machine. Every vertex snaps.
///
/// Frequent features: vertices on pixel centres and tile corners, shared edges, slivers, triangles of area 0 and
/// outside, piles of one triangle, equal depths, every depth function, mask, cull, front and scissor, partial and whole
/// clears, fully covered tiles. The profile's knobs come on top; without any, the scenes of a seed stay what they are.
[[nodiscard]] Scene random_scene(const Config& config, std::uint64_t seed, std::size_t count,
                                 const RandomProfile& profile = {});

/// `scene` one frame later: one draw less, two vertices with swapped colours, depths or texture coordinates, other
/// clears, or unchanged.
[[nodiscard]] Scene next_frame(const Scene& scene, std::uint64_t seed);

}  // namespace halfplane
