// Traversals for study: other ways to find the same samples. The pipeline's own is coarse_raster and fine_raster.
//
// Each calls emit(x, y) once for every covered pixel and returns how many samples it tested. The buffers are the same
// for any order: coverage is exact, attributes are a closed form of the pixel, and a triangle covers it once.
#pragma once

#include "scanline.hpp"

namespace halfplane {

/// Every sample of the setup's box: the three edge functions start at its first pixel and are stepped by additions.
template <class Emit>
std::uint64_t traverse_bbox(const TriangleSetup& setup, const Widths& widths, Emit&& emit) {
  const EdgeValue first_x = setup.left - (setup.left >> widths.tile_shift << widths.tile_shift);
  const EdgeValue first_y = setup.top - (setup.top >> widths.tile_shift << widths.tile_shift);
  std::array<EdgeValue, 3> row{};
  for (std::size_t i = 0; i < 3; ++i)
    row[i] = setup.edge[i].value - first_x * setup.edge[i].dy + first_y * setup.edge[i].dx;
  std::uint64_t tested = 0;
  for (int y = setup.top; y <= setup.bottom; ++y) {
    std::array<EdgeValue, 3> value = row;
    for (int x = setup.left; x <= setup.right; ++x) {
      ++tested;
      if (value[0] >= 0 && value[1] >= 0 && value[2] >= 0) emit(x, y);
      for (std::size_t i = 0; i < 3; ++i) value[i] -= setup.edge[i].dy;
    }
    for (std::size_t i = 0; i < 3; ++i) row[i] += setup.edge[i].dx;
  }
  return tested;
}

/// Every sample of a target of width x height pixels, each by three direct evaluations; `rect`: the pixels that the
/// draw may write. `v`: positive area, as canonical() gives it.
template <class Emit>
std::uint64_t traverse_brute(const std::array<SnappedVertex, 3>& v, const Rect& rect, int width, int height,
                             FillRule rule, int grid_bits, Emit&& emit) {
  std::array<int, 3> bias{};
  for (std::size_t i = 0; i < 3; ++i) bias[i] = edge_bias(v[i], v[(i + 1) % 3], rule, grid_bits);
  std::uint64_t tested = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      ++tested;
      bool covered = x >= rect.x && x < rect.x + rect.width && y >= rect.y && y < rect.y + rect.height;
      for (std::size_t i = 0; i < 3; ++i) covered &= edge_function(v[i], v[(i + 1) % 3], x, y, grid_bits, bias[i]) >= 0;
      if (covered) emit(x, y);
    }
  }
  return tested;
}

}  // namespace halfplane
