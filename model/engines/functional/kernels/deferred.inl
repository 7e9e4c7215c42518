// Deferred shading of textured primitives. A pixel keeps the number of its triangle until its colour is needed, mostly at the
// end of the bin, so that only visible pixels are shaded. A triangle is set up when the first of its pixels is shaded.
//
// A tile with deferred pixels has Bin::kSurfaces as the owner of its colours; a tile fully covered by such a triangle
// has the triangle. Draws without textures have no cost: fetch_color() calls this file only for such owners.
#pragma once

#include "bin.inl"
#include "piece_colors.inl"
#include "pieces.inl"
#include "setup.inl"
#include "small_batch.inl"
#include "small_setup.inl"
#include "surface.inl"
#include "tile_memory.inl"
#include "values.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Affine colours of a triangle of any slice.
inline void set_up_surface_colors(Bin& bin, const SeenSurface& seen, BinTriangle& out) {
  const SliceState state = bin.state;
  bin.state = seen.slice->state;
  (void)set_up(bin, *seen.slice, *seen.record, out);
  if (seen.place != kAtCentre) move_colors(bin, static_cast<std::size_t>(seen.place), out);
  bin.state = state;
}

/// Surface number `number`, set up on first use.
inline const DrawnSurface& drawn_surface(Bin& bin, std::size_t number) {
  BinMemory& memory = bin.memory;
  SeenSurface& seen = memory.seen[number];
  if (seen.drawn >= 0) return memory.drawn[static_cast<std::size_t>(seen.drawn)];
  seen.drawn = static_cast<std::int32_t>(memory.drawn.size());
  const FrameContext& frame = bin.job.frame;
  const StageSurface stage(frame, *seen.slice, *seen.record, seen.place, false);
  const auto& texture = seen.slice->context->state.texture;
  DrawnSurface& drawn = memory.drawn.emplace_back(stage, frame, texture ? &frame.prepared.textures[*texture] : nullptr,
                                                  bin.packing_of(seen.slice->context->fragment_ops));
  drawn.number = ++memory.drawn_before;
  if (!drawn.constants.are_in_lanes)
    drawn.stage = std::make_unique<StageSurface>(frame, *seen.slice, *seen.record, seen.place, true);
  else if ((drawn.constants.has_color || drawn.constants.light) && !drawn.constants.is_color_over_w &&
           !drawn.constants.has_constant_color)
    set_up_surface_colors(bin, seen, drawn.colors);
  return drawn;
}

/// Number of one more surface.
inline std::uint16_t add_surface(Bin& bin, const Slice& slice, const Record& record, int place = kAtCentre) {
  const std::size_t number = ++bin.surface_count;
  bin.memory.seen[number] = {&slice, &record, place, -1};
  return static_cast<std::uint16_t>(number);
}

/// The pixels of a tile that show pieces, if its owner is kSurfaces.
HALFPLANE_INLINE std::uint64_t pixels_of_pieces(const Bin& bin, const U64& surface) {
  if (bin.group_count == 0) return 0;
  return bits_at_least(surface, U64(static_cast<std::uint16_t>(BinMemory::kFirstPiece)));
}

/// A group, set up when its first piece is seen.
HALFPLANE_INLINE const PieceGroup& group_set_up(Bin& bin, std::size_t number) {
  const PieceGroup& group = bin.memory.groups[number];
  if (!group.is_set_up)
    bin.is_short ? set_up_pieces<ShortArithmetic>(bin, number) : set_up_pieces<LongArithmetic>(bin, number);
  return group;
}

/// Renumbers `pixels` of pieces that lanes cannot set up, to be shaded one triangle at a time; returns the other pixels.
HALFPLANE_NOINLINE std::uint64_t without_lone(Bin& bin, PieceGroup& group, std::uint16_t* numbers,
                                              std::uint64_t pixels) {
  for (std::uint64_t rest = pixels; rest != 0; rest &= rest - 1) {
    std::uint16_t& number = numbers[std::countr_zero(rest)];
    const std::size_t i = number % 16;
    if ((group.alone >> i & 1) == 0) continue;
    if (group.surface[i] == 0) group.surface[i] = add_surface(bin, *group.slice, *group.records[i]);
    number = group.surface[i];
    pixels &= ~(rest & -rest);
  }
  return pixels;
}

/// Shades the `pixels` of a tile that show pieces; returns the others. `colors`, `packing`: as in shade_numbered().
HALFPLANE_NOINLINE std::uint64_t shade_pieces_of(Bin& bin, int tile, std::uint64_t pixels, std::uint32_t* const colors,
                                                 const Packing* packing) {
  BinMemory& memory = bin.memory;
  std::uint16_t* const numbers = memory.surface.data() + first_of(tile);
  const U64 surface = U64::load(numbers), group = surface & U64(0xfff0);
  TilePieces shown;
  std::uint64_t pieces = 0;
  for (std::uint64_t rest = pixels_of_pieces(bin, surface) & pixels; rest != 0;) {
    const auto first = static_cast<std::uint16_t>(numbers[std::countr_zero(rest)] & 0xfff0);
    const std::size_t number = (first - BinMemory::kFirstPiece) / 16;
    std::uint64_t here = bits_equal(group, U64(first)) & pixels;
    rest &= ~here;
    if (group_set_up(bin, number).alone != 0) here = without_lone(bin, memory.groups[number], numbers, here);
    if (here == 0) continue;
    shown.add(number, here);
    pieces |= here;
  }
  const auto style_of = [&](std::size_t i) { return memory.groups[shown.group[i]].style; };
  std::uint64_t rest = pieces;
  for (std::size_t i = 0; rest != 0; ++i) {
    if ((shown.pixels[i] & rest) == 0) continue;
    const std::size_t style = style_of(i);
    std::uint64_t here = 0;
    for (std::size_t k = i; k < shown.count; ++k)
      if (style_of(k) == style) here |= shown.pixels[k];
    const SurfaceStyle& of = memory.styles[style];
    shade_pieces(bin, of, tile, shown, here, colors,
                 packing != nullptr ? *packing : bin.packing_of(of.context->fragment_ops));
    rest &= ~here;
  }
  return pixels & ~pieces;
}

/// Shades `pixels` of a tile by the numbers of their surfaces, to `colors` of its 64. `packing`: of them all; null: each
/// surface's own.
HALFPLANE_NOINLINE void shade_numbered(Bin& bin, int tile, std::uint64_t pixels, std::uint32_t* const colors,
                                       const Packing* packing) {
  if (bin.group_count != 0) pixels = shade_pieces_of(bin, tile, pixels, colors, packing);
  const std::uint16_t* const numbers = bin.memory.surface.data() + first_of(tile);
  const U64 surface = U64::load(numbers);
  while (pixels != 0) {
    const std::uint16_t number = numbers[std::countr_zero(pixels)];
    const std::uint64_t here = bits_equal(surface, U64(number)) & pixels;
    const DrawnSurface& drawn = drawn_surface(bin, number);
    shade(bin, drawn, tile, here, colors, packing != nullptr ? *packing : drawn.packing);
    pixels &= ~here;
  }
}

/// Brings colours of a tile with deferred pixels to memory.
HALFPLANE_NOINLINE void shade_tile(Bin& bin, int tile) {
  const std::int32_t owner = std::exchange(bin.color_owner[tile], Bin::kInMemory);
  if (owner >= 0) {
    const std::int32_t number = bin.memory.planes[static_cast<std::size_t>(owner)].surface;
    return shade(bin, drawn_surface(bin, static_cast<std::size_t>(number)), tile, ~std::uint64_t{0});
  }
  const std::uint16_t* const numbers = bin.memory.surface.data() + first_of(tile);
  shade_numbered(bin, tile, ~bits_equal(U64::load(numbers), U64(0)), bin.memory.color.data() + first_of(tile), nullptr);
}

inline void shade_tiles(Bin& bin, std::uint64_t tiles) {
  for (; tiles != 0; tiles &= tiles - 1)
    if (is_waiting(bin, std::countr_zero(tiles))) shade_tile(bin, std::countr_zero(tiles));
}

/// Shades all deferred pixels of the bin: numbers start again.
HALFPLANE_NOINLINE void shade_all(Bin& bin) {
  shade_tiles(bin, ~std::uint64_t{0});
  bin.surface_count = 0;
  bin.memory.drawn.clear();
  bin.group_count = 0;
  bin.memory.styles.clear();
}

/// Makes room for this many surface numbers, at most 16.
HALFPLANE_INLINE void need_surfaces(Bin& bin, std::size_t count) {
  if (bin.surface_count + 16 * bin.group_count + count >= BinMemory::kSurfaces) shade_all(bin);
}

/// Whether lanes set up the surfaces of a slice: their style is the last of BinMemory::styles.
inline bool has_style(Bin& bin, const Slice& slice) {
  BinMemory& memory = bin.memory;
  if (memory.styles.empty() || memory.styles.back().context != slice.context) {
    memory.styles.emplace_back(bin.job.frame, *slice.context);
  }
  if (memory.styles.back().is_in_lanes && memory.groups.empty()) {
    memory.groups.resize(BinMemory::kGroups);
    memory.constants.resize(BinMemory::kGroups);
  }
  const SurfaceStyle& style = memory.styles.back();
  if (style.sampling == Sampling::any && memory.levels.empty()) memory.levels.resize(BinMemory::kGroups);
  if (style.is_color_over_w && memory.colors.empty()) memory.colors.resize(BinMemory::kGroups);
  return style.is_in_lanes;
}

/// Numbers the triangles of a batch: as a group of pieces, or one by one where lanes cannot set up their draw.
HALFPLANE_NOINLINE void add_surfaces(Bin& bin, const Slice& slice) {
  const SmallBatch& batch = bin.small;
  need_surfaces(bin, batch.records.size());
  if (!has_style(bin, slice)) {
    bin.batch_surface = static_cast<std::int32_t>(bin.surface_count + 1);
    for (int i = 0; i < batch.count; ++i) add_surface(bin, slice, *batch.records[static_cast<std::size_t>(i)]);
    return;
  }
  const std::size_t number = ++bin.group_count;
  bin.batch_surface = static_cast<std::int32_t>(BinMemory::kFirstPiece + 16 * number);
  PieceGroup& group = bin.memory.groups[number];
  group.slice = &slice;
  group.style = bin.memory.styles.size() - 1;
  group.records = batch.records;
  group.corner = batch.corner;
  group.left = batch.left;
  group.top = batch.top;
  group.live = batch.live;
  group.is_set_up = false;
  group.surface = {};
}

/// Assigns triangle numbers to the tile's pixels; 0: the colour is in memory already.
inline void need_numbers(Bin& bin, int tile) {
  const std::int32_t owner = bin.color_owner[tile];
  if (owner == Bin::kSurfaces) return;
  std::uint16_t number = 0;
  if (owner >= 0) number = static_cast<std::uint16_t>(bin.memory.planes[static_cast<std::size_t>(owner)].surface);
  if (number == 0) need_color(bin, tile);
  U64(number).store(bin.memory.surface.data() + first_of(tile));
  bin.color_owner[tile] = Bin::kSurfaces;
  bin.in_memory &= ~(std::uint64_t{1} << tile);
}

/// Marks pixels of a tile as showing a surface.
HALFPLANE_INLINE void see(Bin& bin, std::int32_t number, int tile, std::uint64_t pixels) {
  if (!bin.skip.attributes) {
    need_color(bin, tile);
    return shade(bin, drawn_surface(bin, static_cast<std::size_t>(number)), tile, pixels);
  }
  need_numbers(bin, tile);
  std::uint16_t* const at = bin.memory.surface.data() + first_of(tile);
  select(lanes_of(pixels), U64(static_cast<std::uint16_t>(number)), U64::load(at)).store(at);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
