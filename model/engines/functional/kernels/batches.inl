// Batches of small and medium triangles: sixteen records are collected, set up together, and drawn by their coverage.
#pragma once

#include "bin.inl"
#include "deferred.inl"
#include "multisample_blocks.inl"
#include "small.inl"
#include "small_batch.inl"
#include "small_setup.inl"
#include "tile_memory.inl"
#include "tiny.inl"
#include "waiting.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Draws a batch whose records are loaded.
template <class Fragments>
HALFPLANE_NOINLINE void draw_loaded(Bin& bin, const Slice& slice) {
  bin.line_tiles = 0;
  if (bin.samples > 1) return draw_sampled_batch<Fragments>(bin, slice);
  if (bin.sees_surfaces()) add_surfaces(bin, slice);
  const std::uint64_t tiles = batch_tiles(bin);
  bool is_changed = false;
  if (bin.small.has_samples && !bin.has_operations) {
    SampleRounds rounds;
    bin.is_short ? set_up_samples<ShortArithmetic>(bin, slice, rounds)
                 : set_up_samples<LongArithmetic>(bin, slice, rounds);
    is_changed = touch_tiles<Fragments>(bin, tiles);
    bin.is_narrow ? draw_samples<Fragments>(bin, rounds, bin.memory.narrow_depth.data())
                  : draw_samples<Fragments>(bin, rounds, bin.memory.depth.data());
  } else {
    OnlyCentres centres;
    set_up_batch(bin, slice, centres);
    is_changed = touch_tiles<Fragments>(bin, tiles);
    Coverage covered;
    find_covered(bin, covered);
    bin.is_narrow ? draw_blocks<Fragments, NarrowTest>(bin, covered) : draw_blocks<Fragments, WideTest>(bin, covered);
  }
  if (bin.is_operated()) {
    operate_on_all_waiting(bin, tiles);
    const bool is_group = bin.sees_surfaces() && bin.batch_surface > static_cast<std::int32_t>(BinMemory::kFirstPiece);
    if (is_group) --bin.group_count;  // nobody waits for it
  } else if (bin.sees_surfaces() && !bin.skip.attributes) {
    shade_tiles(bin, tiles);
  }
  bin.small.count = 0;
  // With less, a bound that is too high is valid.
  if (is_changed || (!Fragments::kIsLess && bin.state.depth_write)) find_bin_range(bin);
}

/// Draws the pending small and medium triangles.
template <class Fragments>
HALFPLANE_INLINE void draw_batch(Bin& bin, const Slice& slice) {
  if (bin.small.count == 0) return;
  load_records(bin.small, bin.first_x, bin.first_y);
  draw_loaded<Fragments>(bin, slice);
}

/// Adds a record to the batch. A medium one may need several windows.
template <class Fragments>
HALFPLANE_INLINE void add_small(Bin& bin, const Slice& slice, const Record& record) {
  if (bin.small.add(record, 0)) draw_batch<Fragments>(bin, slice);
}
template <class Fragments>
HALFPLANE_INLINE void add_medium(Bin& bin, const Slice& slice, const Record& record, const BinBounds& box) {
  constexpr int kSize = kSmallTiles * kTileSize;
  const int width = box.right - (box.left & ~(kTileSize - 1)), height = box.bottom - (box.top & ~(kTileSize - 1));
  for (int y = 0; y <= height; y += kSize)
    for (int x = 0; x <= width; x += kSize)
      if (bin.small.add(record, x | y << 16)) draw_batch<Fragments>(bin, slice);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
