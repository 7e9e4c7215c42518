// Large triangles: their tiles sixteen at a time, outside, behind, taken as a whole, or drawn block by block.
// A room of the kernels, compiled once for each instruction set: see ../kernels.inl.

/// A pair of rows of tiles, one a lane.
struct TileLanes {
  I16 live, full;           ///< to be looked at; wholly covered
  I16 z_low, z_high;        ///< range of the triangle's depths
  std::array<I16, 3> edge;  ///< at the tiles' first pixels
};

/// What the pairs of rows of a triangle have in common. Of the depths at the tiles' anchors the bits below `drop`
/// only carry: where their sums fit 32 bits, that is all that a lane needs.
struct TileRows {
  std::array<std::int32_t, 3> outside, cut;  ///< from a tile's first pixel to where an edge is largest, smallest
  std::array<std::int32_t, 3> edge_step;     ///< from a row of tiles to the next
  std::array<I16, 3> edge;                   ///< of the first pair of rows
  I16 beside;                                ///< signs: columns without a pixel of the box
  std::int32_t to_low, to_high;              ///< from an anchor
  bool is_narrow;
  I16 upper, lower;  ///< depth at the anchors of row 0
  std::int32_t upper_step, lower_step;
  I16 z_low, z_high;
};

HALFPLANE_INLINE TileRows tile_rows(const Bin& bin, const BinTriangle& t) {
  TileRows rows;
  constexpr int kExtent = kTileSize - 1, kSumBits = 4;  // sums of 7 + 7 + 1
  const I16 x = bin.position.pair_x * kTileSize, y = bin.position.pair_y * kTileSize;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int32_t dx = t.dx[i], dy = t.dy[i];
    rows.edge[i] = y * dx - x * dy + t.edge[i];
    rows.edge_step[i] = kTileSize * dx;
    rows.outside[i] = kExtent * (std::max(dx, 0) + std::max(-dy, 0));
    rows.cut[i] = kExtent * (std::min(dx, 0) + std::min(-dy, 0));
  }
  rows.beside = (x + (kExtent - t.box.left)) | (t.box.right - x);
  // From the anchor a tile reaches four pixels to the left and up, three to the right and down.
  const auto reach = [](std::int32_t step, bool is_high) HALFPLANE_LAMBDA {
    return (step > 0) == is_high ? (kTileSize / 2 - 1) * step : -kTileSize / 2 * step;
  };
  rows.to_low = reach(t.z_step_x, false) + reach(t.z_step_y, false);
  rows.to_high = reach(t.z_step_x, true) + reach(t.z_step_y, true);
  const int drop = bin.depth_format.drop;
  rows.is_narrow = drop + kSumBits <= 32;
  if (rows.is_narrow) {
    const auto upper = [drop](std::int64_t v) HALFPLANE_LAMBDA { return static_cast<std::int32_t>(v >> drop); };
    const auto lower = [drop](std::int64_t v)
                           HALFPLANE_LAMBDA { return static_cast<std::int32_t>(v & ((std::int64_t{1} << drop) - 1)); };
    rows.upper_step = upper(t.z_tile_y);
    rows.lower_step = lower(t.z_tile_y);
    rows.upper = bin.position.pair_x * upper(t.z_tile_x) + bin.position.pair_y * rows.upper_step + upper(t.z_anchor);
    rows.lower = bin.position.pair_x * lower(t.z_tile_x) + bin.position.pair_y * rows.lower_step + lower(t.z_anchor);
  }
  rows.z_low = I16(t.z_low);
  rows.z_high = I16(t.z_high);
  return rows;
}

/// The depths at the anchors of a pair of rows of tiles, in lanes.
HALFPLANE_INLINE I16 depth_anchors(const Bin& bin, const BinTriangle& t, const TileRows& rows, int row) {
  if (rows.is_narrow)
    return (rows.upper + row * rows.upper_step +
            shift_right_logical(rows.lower + row * rows.lower_step, bin.depth_format.drop))
           << bin.depth_format.up;
  const L16 value = convert<std::int64_t>(bin.position.pair_x) * t.z_tile_x +
                    convert<std::int64_t>(bin.position.pair_y + row) * t.z_tile_y + t.z_anchor;
  return convert<std::int32_t>(shift_right_logical(value, bin.depth_format.drop)) << bin.depth_format.up;
}

HALFPLANE_INLINE TileLanes classify_tiles(Bin& bin, const BinTriangle& t, const TileRows& rows, int row) {
  TileLanes lanes;
  constexpr int kExtent = kTileSize - 1;
  I16 outside(0), cut(0);
  for (std::size_t i = 0; i < 3; ++i) {
    lanes.edge[i] = rows.edge[i] + row * rows.edge_step[i];
    outside |= lanes.edge[i] + rows.outside[i];
    cut |= lanes.edge[i] + rows.cut[i];
  }
  const I16 y = bin.position.pair_y * kTileSize + row * kTileSize;
  const I16 apart = rows.beside | (y + (kExtent - t.box.top)) | (t.box.bottom - y);  // from the box
  if (!t.is_whole) {
    const I16 x = bin.position.pair_x * kTileSize;
    cut |= (x - t.box.left) | ((t.box.right - kExtent) - x) | (y - t.box.top) | ((t.box.bottom - kExtent) - y);
  }
  const std::uint32_t box = ~bits_of(apart) & 0xffff;
  outside |= apart;
  bin.job.counters.tiles_visited += static_cast<unsigned>(std::popcount(box));
  if (bin.skip.tiles_outside) {
    bin.job.counters.skipped.tiles_outside += static_cast<unsigned>(std::popcount(bits_of(outside) & box));
    lanes.live = ~(outside >> 31);
  } else {
    lanes.live = ~(apart >> 31);
  }
  lanes.full = ~((outside | cut) >> 31);
  lanes.z_low = rows.z_low;
  lanes.z_high = rows.z_high;
  if (t.is_gentle) {
    const I16 anchor = depth_anchors(bin, t, rows, row);
    lanes.z_low = decode(anchor + rows.to_low, bin.depth_format, rows.z_low, rows.z_high);
    lanes.z_high = decode(anchor + rows.to_high, bin.depth_format, rows.z_low, rows.z_high);
  }
  return lanes;
}

/// Forgets the triangles of which no tile is left.
HALFPLANE_NOINLINE void drop_planes(Bin& bin) {
  std::array<std::int32_t, BinMemory::kPlanes> moved;
  moved.fill(-1);
  for (const auto* owners : {&bin.depth_owner, &bin.color_owner})
    for (const std::int32_t owner : *owners)
      if (owner >= 0) moved[static_cast<std::size_t>(owner)] = 0;
  bin.plane_count = 0;
  for (std::size_t i = 0; i < BinMemory::kPlanes; ++i) {
    if (moved[i] < 0) continue;
    moved[i] = static_cast<std::int32_t>(bin.plane_count);
    bin.memory.planes[bin.plane_count++] = bin.memory.planes[i];
  }
  for (auto* owners : {&bin.depth_owner, &bin.color_owner})
    for (std::int32_t& owner : *owners)
      if (owner >= 0) owner = moved[static_cast<std::size_t>(owner)];
}

/// Tiles that the triangle takes as a whole.
HALFPLANE_INLINE void take_tiles(Bin& bin, const BinTriangle& t, int row, const I16& taken, const TileLanes& lanes,
                                 std::int32_t& plane) {
  if (plane < 0) {
    if (bin.plane_count == BinMemory::kPlanes) drop_planes(bin);
    plane = static_cast<std::int32_t>(bin.plane_count);
    bin.memory.planes[bin.plane_count++] = t;
  }
  const auto replace = [&](std::int32_t* at, const I16& with)
                           HALFPLANE_LAMBDA { select(taken, with, I16::load(at)).store(at); };
  bin.in_memory &= ~(std::uint64_t{bits_of(taken)} << (row * kBinTiles));
  if (bin.state.depth_write) {
    replace(bin.depth_owner.data() + row * kBinTiles, I16(plane));
    replace(bin.tile_low + row * kBinTiles, lanes.z_low);
    replace(bin.tile_high + row * kBinTiles, lanes.z_high);
  }
  if (bin.state.color_write) {
    const I16 owner = I16::load(bin.color_owner.data() + row * kBinTiles);
    bin.job.counters.skipped.attributes += 64 * static_cast<unsigned>(std::popcount(bits_of(taken & ~(owner >> 31))));
    replace(bin.color_owner.data() + row * kBinTiles, I16(plane));
  }
  const std::uint64_t pixels = 64 * static_cast<std::uint64_t>(std::popcount(bits_of(taken)));
  bin.job.counters.skipped.trivially_accepted += pixels / 64;
  count_fragments(bin, pixels, pixels);
}

template <class Visit>
HALFPLANE_INLINE void for_each_block(Visit&& visit) {
  visit(std::integral_constant<std::size_t, 0>{});
  visit(std::integral_constant<std::size_t, 1>{});
  visit(std::integral_constant<std::size_t, 2>{});
  visit(std::integral_constant<std::size_t, 3>{});
}

/// The part of a triangle in one tile, block by block.
template <class Fragments>
HALFPLANE_NOINLINE void draw_tile(Bin& bin, const BinTriangle& t, int tile, bool is_full,
                                  const std::array<std::int32_t, 3>& edge) {
  const int tile_x = tile % kBinTiles, tile_y = tile / kBinTiles;
  const int x = tile_x * kTileSize, y = tile_y * kTileSize;
  const int left = std::max(t.box.left - x, 0), right = std::min(t.box.right - x, 7);
  const int top = std::max(t.box.top - y, 0), bottom = std::min(t.box.bottom - y, 7);
  const bool is_whole = t.is_whole || (left == 0 && top == 0 && right == 7 && bottom == 7);
  need_depth(bin, tile);
  const BlockRamp<I16> depth_plane = depth_ramp(bin, t, depth_anchor(bin, t, tile_x, tile_y));
  std::array<BlockRamp<I16>, 3> edge_plane;
  for (std::size_t e = 0; e < 3; ++e)
    edge_plane[e] = {bin.position.block_y * t.dx[e] - bin.position.block_x * t.dy[e] + edge[e],
                     I16(-kBlockSize * t.dy[e]), I16(kBlockSize * t.dx[e])};
  // Copies: what is stored to memory might change the members, for all that the compiler knows.
  const LaneFormat format = bin.depth_format;
  const I16 z_low(t.z_low), z_high(t.z_high);
  const bool has_depth = bin.state.depth_write, skips = bin.skip.fragments_early_z;
  std::int32_t* const stored_depths = bin.memory.depth.data() + first_of(tile);
  std::array<I16, 4> passed;                        // signs
  std::uint64_t covered_bits = 0, passed_bits = 0;  // of a block: sixteen
  I16 lowest(0x7fffffff), highest(0);
  for_each_block([&](auto block) HALFPLANE_LAMBDA {
    constexpr int kX = (block & 1) * kBlockSize, kY = (block >> 1) * kBlockSize;
    I16 outside(0);  // signs
    if (!is_full) outside = edge_plane[0](block) | edge_plane[1](block) | edge_plane[2](block);
    if (!is_whole)
      outside |= (bin.position.block_x + (kX - left)) | ((right - kX) - bin.position.block_x) |
                 (bin.position.block_y + (kY - top)) | ((bottom - kY) - bin.position.block_y);
    std::int32_t* const at = stored_depths + block * kBlockPixels;
    const I16 stored = I16::load(at), depth = decode(depth_plane(block), format, z_low, z_high);
    passed[block] = ~outside & Fragments::passes(bin.state, depth, stored);
    const I16 now = select_by_sign(passed[block], depth, stored);
    covered_bits |= std::uint64_t{~bits_of(outside) & 0xffff} << (kBlockPixels * block);
    passed_bits |= std::uint64_t{bits_of(passed[block])} << (kBlockPixels * block);
    lowest = min(lowest, now);
    highest = max(highest, now);
    if (has_depth) now.store(at);
  });
  if (bin.state.color_write && (passed_bits != 0 || !skips)) {
    need_color(bin, tile);
    const ColorRamp color_plane = color_ramp(bin, t.color, color_anchor(bin, t, tile_x, tile_y));
    std::uint32_t* const pixels = bin.memory.color.data() + first_of(tile);
    const ColorSteps steps = t.color;
    const LaneFormat color_format = bin.color_format;
    const ColorFormat pixel_format = bin.config.color_format;
    for_each_block([&](auto block) HALFPLANE_LAMBDA {
      if ((passed_bits >> (kBlockPixels * block) & 0xffff) == 0 && skips) return;
      std::uint32_t* const at = pixels + block * kBlockPixels;
      const I16 color = block_colors(steps, color_plane, block, color_format, pixel_format);
      select_by_sign(passed[block], color, I16::load(at)).store(at);
    });
  }
  const auto covered_pixels = static_cast<std::uint64_t>(std::popcount(covered_bits)),
             passed_pixels = static_cast<std::uint64_t>(std::popcount(passed_bits));
  Counters& counters = bin.job.counters;
  if (is_full)
    ++counters.skipped.trivially_accepted;
  else
    counters.samples_tested += static_cast<unsigned>((right - left + 1) * (bottom - top + 1));
  count_fragments(bin, covered_pixels, passed_pixels);
  if (bin.state.depth_write && passed_pixels != 0) {
    bin.tile_low[tile] = min_lane(lowest);
    bin.tile_high[tile] = max_lane(highest);
  }
}

template <class Fragments>
void draw_large(Bin& bin, const BinTriangle& t) {
  std::int32_t plane = -1;
  bin.line_tiles = 0;
  const TileRows rows = tile_rows(bin, t);
  bool is_changed = false;
  for (int row = t.box.top >> kTileShift & ~1; row <= t.box.bottom >> kTileShift; row += 2) {
    TileLanes lanes = classify_tiles(bin, t, rows, row);
    std::int32_t* low = bin.tile_low + row * kBinTiles;
    std::int32_t* high = bin.tile_high + row * kBinTiles;
    const I16 stored_low = I16::load(low), stored_high = I16::load(high);
    I16 behind, front;
    Fragments::compare_ranges(bin.state, lanes.z_low, lanes.z_high, stored_low, stored_high, behind, front);
    if (bin.skip.tiles_hiz) {
      bin.job.counters.skipped.tiles_hiz += static_cast<unsigned>(std::popcount(bits_of(lanes.live & behind)));
      lanes.live &= ~behind;
    }
    I16 taken(0);
    if (bin.skip.attributes && bin.skip.trivially_accepted && (bin.state.depth_write || bin.state.color_write)) {
      taken = lanes.live & lanes.full & front;
      if (is_any(taken)) take_tiles(bin, t, row, taken, lanes, plane);
    }
    const std::uint32_t full_bits = bits_of(lanes.full);
    const std::uint32_t live_bits = bits_of(lanes.live);
    is_changed |= live_bits != 0;
    std::uint32_t rest = live_bits & ~bits_of(taken);
    if (rest == 0) continue;
    struct {
      std::array<std::array<std::int32_t, 16>, 3> edge;
    } lane;
    for (std::size_t e = 0; e < 3; ++e) lanes.edge[e].store(lane.edge[e].data());
    for (; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      const bool is_full = bin.skip.trivially_accepted && (full_bits >> i & 1) != 0;
      draw_tile<Fragments>(bin, t, row * kBinTiles + static_cast<int>(i), is_full,
                           {lane.edge[0][i], lane.edge[1][i], lane.edge[2][i]});
    }
  }
  if (!is_changed || !bin.state.depth_write) return;
  if (!Fragments::kIsLess) return find_bin_range(bin);
  // An upper bound that only falls: the old one will do.
  bin.low = std::min(bin.low, t.z_low);
  bin.may_be_lower = true;
}
