// Small and medium triangles: the blocks of 4 x 4 pixels that they cover; of those within two by two pixels, their
// samples.
// A room of the kernels, compiled once for each instruction set: see ../kernels.inl.

/// Batches after which a tile's range is found anew.
constexpr std::uint8_t kTouches = 4;

/// The tiles that the boxes of the batch touch.
struct BatchTiles {
  std::uint64_t touched = 0;  ///< a bit each
  bool is_over_two = false;   ///< along the side of a box
};

HALFPLANE_INLINE BatchTiles batch_tiles(Bin& bin) {
  const auto tiles_of = [](const SmallBatch::Lane& at) HALFPLANE_LAMBDA { return I16::load(at.data()) >> kTileShift; };
  const I16 left = tiles_of(bin.small.left), top = tiles_of(bin.small.top), columns = tiles_of(bin.small.right) - left,
            rows = tiles_of(bin.small.bottom) - top;
  BatchTiles tiles;
  for (int row = 0; row < kMediumTiles; ++row)
    for (int column = 0; column < kMediumTiles; ++column) {
      const std::uint32_t lanes = bits_of((columns >= column) & (rows >= row)) & bin.small.live;
      if (lanes == 0) break;
      tiles.touched |= or_of_bits((top + row) * kBinTiles + (left + column), lanes);
      tiles.is_over_two |= row == 2 || column == 2;
      bin.job.counters.tiles_visited += static_cast<unsigned>(std::popcount(lanes));
    }
  return tiles;
}

/// They must be in memory, and their ranges are known no more. Every now and then finds a tile's range anew; says so.
template <class Fragments>
HALFPLANE_INLINE bool touch_tiles(Bin& bin, std::uint64_t tiles) {
  for (std::uint64_t rest = tiles & ~bin.in_memory; rest != 0; rest &= rest - 1) {
    const int at = std::countr_zero(rest);
    need_depth(bin, at);
    if (bin.state.color_write) need_color(bin, at);
  }
  if (bin.state.color_write) bin.in_memory |= tiles;
  if (!bin.state.depth_write) return false;
  bool is_changed = false;
  for (std::uint64_t rest = tiles; rest != 0; rest &= rest - 1) {
    const auto at = static_cast<std::size_t>(std::countr_zero(rest));
    if (++bin.touches[at] == kTouches) {
      bin.touches[at] = 0;
      find_range(bin, static_cast<int>(at));
      is_changed = true;
    }
    forget_range<Fragments>(bin, static_cast<int>(at));
  }
  return is_changed;
}

/// The blocks of the batch in which a sample is covered, triangle by triangle. Two by two of them are looked at without
/// asking whether the box touches them: a branch that nobody can foresee costs more.
HALFPLANE_INLINE std::size_t find_blocks(Bin& bin) {
  std::size_t blocks = 0, tested = 0;
  const auto add = [&](std::uint32_t place, const I16& signs, std::uint32_t is_there) HALFPLANE_LAMBDA {
    const std::uint32_t covered = ~bits_of(signs) & 0xffff & (0U - is_there);
    bin.blocks[blocks] = {place, covered};
    blocks += covered != 0 ? 1U : 0U;
  };
  for (std::uint32_t rest = bin.small.live; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    std::array<I16, 3> edge, right, below;
    for (std::size_t e = 0; e < 3; ++e) {
      edge[e] = multiply_add_pairs(I16(bin.small.edge_step[e][i]), bin.position.block_yx) + bin.small.edge[e][i];
      right[e] = edge[e] + bin.small.to_right[e][i];
      below[e] = edge[e] + bin.small.to_below[e][i];
    }
    const auto place = static_cast<std::uint32_t>(bin.small.place[i]),
               there = static_cast<std::uint32_t>(bin.small.there[i]);
    constexpr std::uint32_t kColumn = 1 << 8, kRow = 1 << 16;
    add(place, edge[0] | edge[1] | edge[2], there & 1);
    add(place + kColumn, right[0] | right[1] | right[2], there >> 1 & 1);
    add(place + kRow, below[0] | below[1] | below[2], there >> 2 & 1);
    add(place + kColumn + kRow,
        (below[0] + bin.small.to_right[0][i]) | (below[1] + bin.small.to_right[1][i]) |
            (below[2] + bin.small.to_right[2][i]),
        there >> 3 & 1);
    const int columns = (bin.small.right[i] >> kBlockShift) - (bin.small.left[i] >> kBlockShift),
              rows = (bin.small.bottom[i] >> kBlockShift) - (bin.small.top[i] >> kBlockShift);
    tested += static_cast<unsigned>((columns + 1) * (rows + 1));
    if (columns < 2 && rows < 2) continue;
    for (int dy = 0; dy <= rows; ++dy) {
      std::array<I16, 3> at = edge;
      for (int dx = 0; dx <= columns; ++dx) {
        if (dx >= 2 || dy >= 2)
          add(place + kColumn * static_cast<std::uint32_t>(dx) + kRow * static_cast<std::uint32_t>(dy),
              at[0] | at[1] | at[2], there & 1);
        for (std::size_t e = 0; e < 3; ++e) at[e] += I16(bin.small.to_right[e][i]);
      }
      for (std::size_t e = 0; e < 3; ++e) edge[e] += I16(bin.small.to_below[e][i]);
    }
  }
  bin.job.counters.samples_tested += kBlockPixels * tested;
  return blocks;
}

/// Depth, test and colour of a block.
template <class Fragments>
HALFPLANE_INLINE void draw_block(Bin& bin, const Block& block, std::uint64_t& covered_pixels,
                                 std::uint64_t& passed_pixels) {
  const std::size_t i = block.place & 255;
  const int column = static_cast<int>(block.place >> 8 & 255), row = static_cast<int>(block.place >> 16);
  const auto of_box = static_cast<std::size_t>((column >> 1) + kMediumTiles * (row >> 1) - bin.small.first_tile[i]);
  const std::size_t right = block.place >> 8 & 1, below = block.place >> 16 & 1;  // in its tile
  const auto at = static_cast<std::size_t>(kColumnPlaces[static_cast<std::size_t>(column)] +
                                           kRowPlaces[static_cast<std::size_t>(row)]);
  const I16 value = bin.position.column[right] * bin.small.z_step_x[i] +
                    bin.position.row[below] * bin.small.z_step_y[i] + bin.small.z_anchor[of_box][i];
  const I16 depth = decode(value, bin.depth_format, bin.small.z_low[i], bin.small.z_high[i]);
  const I16 stored = load_depths(bin, at);
  const I16 covered = I16(static_cast<std::int32_t>(block.covered)) << bin.position.to_sign;
  const I16 passed = covered & Fragments::passes(bin.state, depth, stored);  // signs
  const std::uint32_t passed_bits = bits_of(passed);
  covered_pixels += static_cast<unsigned>(std::popcount(block.covered));
  passed_pixels += static_cast<unsigned>(std::popcount(passed_bits));
  if (passed_bits == 0 && bin.skip.fragments_early_z) return;
  if (bin.state.depth_write) store_depths(bin, at, select_by_sign(passed, depth, stored));
  if (!bin.state.color_write) return;
  const auto pair = [&](std::size_t p) HALFPLANE_LAMBDA {
    return channel_codes(bin, bin.position.column_pair[right], bin.position.row_pair[below], bin.small.c_step_x[p][i],
                         bin.small.c_step_y[p][i], bin.small.c_anchor[p][of_box][i], bin.small.c_low[p][i],
                         bin.small.c_high[p][i]);
  };
  const I16 color = packed(pair(0), pair(1), bin.config.color_format);
  std::uint32_t* pixels = bin.memory.color.data() + at;
  select_by_sign(passed, color, I16::load(pixels)).store(pixels);
}

template <class Fragments>
HALFPLANE_INLINE void draw_blocks(Bin& bin) {
  const std::size_t blocks = find_blocks(bin);
  std::uint64_t covered = 0, passed = 0;
  for (std::size_t b = 0; b < blocks; ++b) draw_block<Fragments>(bin, bin.blocks[b], covered, passed);
  count_fragments(bin, covered, passed);
}

/// Triangles whose few samples are known: a triangle a lane, then sample by sample in their order.
template <class Fragments>
HALFPLANE_INLINE void draw_samples(Bin& bin) {
  constexpr std::size_t kSamples = 4;
  alignas(64) std::array<SmallBatch::Lane, kSamples> depth, color, place;
  const I16 left = I16::load(bin.small.left.data()), top = I16::load(bin.small.top.data());
  const auto from_anchor = [](const I16& at) HALFPLANE_LAMBDA { return (at & (kTileSize - 1)) - kTileSize / 2; };
  const std::array<I16, 2> x{left, left + 1}, y{top, top + 1};
  const std::array<I16, 2> column{from_anchor(x[0]), from_anchor(x[1])}, row{from_anchor(y[0]), from_anchor(y[1])};
  const auto load = [](const SmallBatch::Lane& lane) HALFPLANE_LAMBDA { return I16::load(lane.data()); };
  for (std::size_t s = 0; s < kSamples; ++s) {
    const std::size_t i = s & 1, j = s >> 1, anchor = i + kMediumTiles * j;
    place_of(x[i], y[j]).store(place[s].data());
    const I16 value =
        column[i] * load(bin.small.z_step_x) + row[j] * load(bin.small.z_step_y) + load(bin.small.z_anchor[anchor]);
    decode(value, bin.depth_format, load(bin.small.z_low), load(bin.small.z_high)).store(depth[s].data());
    if (!bin.state.color_write) continue;
    const I16 columns = pairs(column[i], column[i]), rows = pairs(row[j], row[j]);
    const auto channels = [&](std::size_t p) HALFPLANE_LAMBDA {
      return channel_codes(bin, columns, rows, load(bin.small.c_step_x[p]), load(bin.small.c_step_y[p]),
                           load(bin.small.c_anchor[p][anchor]), load(bin.small.c_low[p]), load(bin.small.c_high[p]));
    };
    packed(channels(0), channels(1), bin.config.color_format).store(color[s].data());
  }
  const DepthPixels depths(bin);
  const bool has_depth = bin.state.depth_write, has_color = bin.state.color_write;
  std::uint64_t covered_pixels = 0, passed_pixels = 0;
  for (std::uint32_t rest = bin.small.live; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    const auto samples = static_cast<std::uint32_t>(bin.small.samples[i]);
    covered_pixels += static_cast<unsigned>(std::popcount(samples));
    for (std::uint32_t left_over = samples; left_over != 0; left_over &= left_over - 1) {
      const auto s = static_cast<std::size_t>(std::countr_zero(left_over));
      const auto at = static_cast<std::size_t>(place[s][i]);
      const std::int32_t stored = depths.at(at);
      // Stored as it was where it fails: which do, nobody can foresee.
      const std::uint32_t passed = Fragments::passes_one(bin.state, depth[s][i], stored) ? 1U : 0U, mask = 0U - passed;
      passed_pixels += passed;
      if (has_depth) depths.set(at, stored ^ ((stored ^ depth[s][i]) & static_cast<std::int32_t>(mask)));
      if (has_color) bin.memory.color[at] ^= (bin.memory.color[at] ^ static_cast<std::uint32_t>(color[s][i])) & mask;
    }
  }
  bin.job.counters.samples_tested += kSamples * static_cast<unsigned>(std::popcount(bin.small.live));
  count_fragments(bin, covered_pixels, passed_pixels);
}

/// Draws the small and medium triangles that wait.
template <class Fragments>
void draw_batch(Bin& bin, const Slice& slice) {
  if (bin.small.count == 0) return;
  bin.line_tiles = 0;
  load_records(bin.small, bin.first_x, bin.first_y);
  const BatchTiles tiles = batch_tiles(bin);
  if (tiles.is_over_two)
    set_up_small<kMediumTiles>(bin.small, slice, bin.job.frame, bin.depth_format, bin.color_format, bin.first_x,
                               bin.first_y);
  else
    set_up_small<kSmallTiles>(bin.small, slice, bin.job.frame, bin.depth_format, bin.color_format, bin.first_x,
                              bin.first_y);
  const bool is_changed = touch_tiles<Fragments>(bin, tiles.touched);
  bin.small.has_samples ? draw_samples<Fragments>(bin) : draw_blocks<Fragments>(bin);
  bin.small.count = 0;
  // With less, a bound that is too high will do.
  if (is_changed || (!Fragments::kIsLess && bin.state.depth_write)) find_bin_range(bin);
}
