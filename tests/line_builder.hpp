// Lines for tests: the coverage of the stages, checked against the exact oracle pixel by pixel.
#pragma once

#include <gtest/gtest.h>

#include "scene_builder.hpp"
#include "sim/study/stress/line_check.hpp"

namespace halfplane::test {

using namespace halfplane::stress;  // LineSpace, pixels_of, oracle_positions_nearby, ...

/// The vertex at the centre of pixel (x, y).
inline SnappedVertex centre_of(int x, int y, const LineSpace& space) {
  const int s = space.widths.grid_bits, half = 1 << (s - 1);
  return snapped_vertex((x << s) + half, (y << s) + half);
}

/// The oracle's coverage, over the box of both ends and one pixel around it.
inline Positions oracle_positions(const exact::Line& line) {
  const int s = line.grid_bits;
  const auto [left, right] = std::minmax({line.start.x >> s, line.end.x >> s});
  const auto [top, bottom] = std::minmax({line.start.y >> s, line.end.y >> s});
  Positions list;
  for (int x = left - 1; x <= right + 1; ++x)
    for (int y = top - 1; y <= bottom + 1; ++y)
      if (exact::covers(line, x, y)) list.emplace_back(x, y);
  return list;
}

/// A line in words, for messages.
inline std::string text(const exact::Line& line) {
  constexpr std::array<const char*, 3> kNames{"midpoint", "bresenham", "diamond"};
  return std::string(kNames[static_cast<std::size_t>(line.rule)]) + (line.drops_last ? " " : " (last drawn) ") +
         std::to_string(line.start.x) + "," + std::to_string(line.start.y) + " -> " + std::to_string(line.end.x) + "," +
         std::to_string(line.end.y) + ", s = " + std::to_string(line.grid_bits);
}

/// Every combination of rule and last pixel that means something.
inline std::vector<std::pair<LineRule, bool>> all_rules() {
  return {{LineRule::midpoint, false},
          {LineRule::midpoint, true},
          {LineRule::bresenham, false},
          {LineRule::bresenham, true},
          {LineRule::diamond, true}};
}

}  // namespace halfplane::test
