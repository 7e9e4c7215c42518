// Fragments one by one, tile after tile, nothing skipped or deferred. A triangle of any size is set up alone. For lines
// with operations, and dots with those that dots.inl does not have in lanes; RenderOptions::general_fragments uses it for all.
#pragma once

#include "bin.inl"
#include "fragments.inl"
#include "lines.inl"
#include "setup.inl"
#include "stencil.inl"
#include "tile_memory.inl"
#include "values.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// The part of a triangle in one tile. `edge`: at the tile's first pixel.
HALFPLANE_NOINLINE void draw_tile_general(Bin& bin, const BinTriangle& t, int tile,
                                          const std::array<std::int32_t, 3>& edge) {
  const int tile_x = tile % kBinTiles, tile_y = tile / kBinTiles;
  need_depth(bin, tile);
  need_color(bin, tile);
  const BlockRamp<I16> depth_plane = depth_ramp(bin, t, depth_anchor(bin, t, tile_x, tile_y));
  const bool needs_colors = bin.state.color_write || bin.ops->alpha.func != DepthFunc::always;
  const ColorRamp color_plane =
      needs_colors ? color_ramp(bin, t.color, color_anchor(bin, t, tile_x, tile_y)) : ColorRamp{};
  std::uint64_t covered_pixels = 0, passed_pixels = 0;
  for (std::size_t block = 0; block < 4; ++block) {
    const I16 column = bin.position.block_x + static_cast<int>(block & 1) * kBlockSize,
              row = bin.position.block_y + static_cast<int>(block >> 1) * kBlockSize;
    const I16 x = column + tile_x * kTileSize, y = row + tile_y * kTileSize;
    I16 outside = (x - t.box.left) | (t.box.right - x) | (y - t.box.top) | (t.box.bottom - y);  // signs
    for (std::size_t e = 0; e < 3; ++e) outside |= row * t.dx[e] - column * t.dy[e] + edge[e];
    const std::uint32_t covered = ~bits_of(outside) & 0xffff;
    FragmentLanes fragments;
    (bin.position.lane + (first_of(tile) + static_cast<int>(block) * kBlockPixels)).store(fragments.place.data());
    block_depths(bin, t, depth_plane, block).store(fragments.depth.data());
    if (needs_colors)
      block_colors(t.color, color_plane, block, bin.color_format, GeneralFragments::packing(bin))
          .store(fragments.color.data());
    covered_pixels += static_cast<unsigned>(std::popcount(covered));
    passed_pixels += GeneralFragments::draw_some(bin, fragments, covered);
  }
  bin.job.counters.samples_tested += kTilePixels;
  count_fragments(bin, covered_pixels, passed_pixels);
  if (bin.state.depth_write && passed_pixels != 0) find_range(bin, tile);
}

inline void draw_triangle_general(Bin& bin, const BinTriangle& t) {
  bin.line_tiles = 0;
  for (int tile_y = t.box.top >> kTileShift; tile_y <= t.box.bottom >> kTileShift; ++tile_y)
    for (int tile_x = t.box.left >> kTileShift; tile_x <= t.box.right >> kTileShift; ++tile_x) {
      std::array<std::int32_t, 3> edge;
      for (std::size_t e = 0; e < 3; ++e) edge[e] = t.edge[e] + kTileSize * (tile_y * t.dx[e] - tile_x * t.dy[e]);
      ++bin.job.counters.tiles_visited;
      draw_tile_general(bin, t, tile_y * kBinTiles + tile_x, edge);
    }
}

/// draw_records() for such a slice.
HALFPLANE_NOINLINE void draw_records_general(Bin& bin, const Slice& slice, const std::uint32_t* first,
                                             const std::uint32_t* last) {
  bin.line_tiles = 0;
  for (; first != last; ++first) {
    const Record& record = slice.records[*first];
    if (record.kind() == RecordKind::whole_line || record.kind() == RecordKind::cut_line) {
      if (bin.lines.add(record)) draw_lines<GeneralFragments>(bin, slice);
      continue;
    }
    draw_lines<GeneralFragments>(bin, slice);
    BinTriangle triangle;
    triangle.box = box_of(bin, record);
    triangle.is_whole = false;
    bin.is_back = shows_back(bin, slice, record);
    if (set_up(bin, slice, record, triangle) && !record.has(Record::kDrawsNothing))
      draw_triangle_general(bin, triangle);
    bin.is_back = false;  // lines and points show their front
  }
  draw_lines<GeneralFragments>(bin, slice);
  bin.line_tiles = 0;
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
