// The adversary: looks for the triangle with the largest error by random restarts and coordinate-wise hill climbing on
// the grid of snapped values.
#pragma once

#include "model/packets/packets.hpp"
#include "sim/study/stress/unit.hpp"

namespace halfplane::stress {

/// The quantity that the search maximises, over the covered pixels of a window of the target.
enum class Objective {
  depth,          ///< |stored depth - exact plane|, LSB
  interpolation,  ///< |interpolated depth before rounding - exact plane|, LSB
  color           ///< |stored channel - exact plane|, stored LSB
};

/// Side of the window in pixels, from pixel (0, 0) of the target.
inline constexpr int kSearchWindow = 24;

/// The largest error of the triangle in the window; 0 if it covers no pixel there. Adds the samples to `samples`.
[[nodiscard]] double search_error(const Triangle& triangle, Objective objective, const Config& config,
                                  const Widths& widths, std::uint64_t& samples);

/// One restart: a random triangle, climbed until no coordinate's step of 1, 2, 4, ... raises the error or `evaluations`
/// are used up.
struct Found {
  Triangle triangle;
  double error = 0, start = 0;
  std::uint64_t samples = 0;
};
[[nodiscard]] Found climb(Unit& unit, Objective objective, int evaluations);

}  // namespace halfplane::stress
