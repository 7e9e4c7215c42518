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
      std::array<I16, 3> at;
      for (std::size_t e = 0; e < 3; ++e) at[e] = edge[e];
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

/// The samples of triangles that have few, round by round: of each triangle one more.
struct SampleRounds {
  static constexpr std::size_t kMost = 4;
  std::size_t count = 0;
  alignas(64) std::array<SmallBatch::Lane, kMost> to_x, to_y;   ///< FromOrigin of its tile's anchor
  alignas(64) std::array<SmallBatch::Lane, kMost> column, row;  ///< from there, in both halves
  alignas(64) std::array<SmallBatch::Lane, kMost> place, depth, color;

  [[nodiscard]] HALFPLANE_INLINE FromOrigin to(std::size_t round) const {
    return {I16::load(to_x[round].data()), I16::load(to_y[round].data())};
  }
};

/// Where they are. As many rounds as one triangle has samples; who has none left has a place somewhere in the bin.
HALFPLANE_INLINE void find_samples(const Bin& bin, const SmallCorners& corners, SampleRounds& rounds) {
  const SmallBatch& batch = bin.small;
  const I16 left = I16::load(batch.left.data()), top = I16::load(batch.top.data());
  I16 rest = I16::load(batch.samples.data());
  for (rounds.count = 0; is_any(rest != 0); ++rounds.count) {
    const I16 sample = rest & -rest, is_last = shift_right_logical(sample, 3);  // 1 2 / 4 8
    rest &= rest - 1;
    const I16 x = left + ((shift_right_logical(sample, 1) & 1) | is_last),
              y = top + ((shift_right_logical(sample, 2) & 1) | is_last);
    const FromOrigin to = anchor_from_origin(corners, x, y, bin.widths.grid_bits, bin.first_x, bin.first_y);
    const I16 column = (x & (kTileSize - 1)) - kTileSize / 2, row = (y & (kTileSize - 1)) - kTileSize / 2;
    const std::size_t r = rounds.count;
    to.x.store(rounds.to_x[r].data());
    to.y.store(rounds.to_y[r].data());
    pairs(column, column).store(rounds.column[r].data());
    pairs(row, row).store(rounds.row[r].data());
    place_of(x, y).store(rounds.place[r].data());
  }
}

template <class Arithmetic>
HALFPLANE_INLINE void sample_depths(const Bin& bin, const SmallPlanes<Arithmetic>& planes, SampleRounds& rounds) {
  const LaneFormat& format = bin.depth_format;
  const auto [x, y] = planes.depth_gradients(format);
  const I16 step_x = local_step(x, format), step_y = local_step(y, format);
  const I16 &low = planes.corners.z_low, &high = planes.corners.z_high;
  for (std::size_t r = 0; r < rounds.count; ++r) {
    const I16 anchor =
        narrowed(plane_at(rounds.to(r), bin.widths.plane_fraction, planes.corners.origin.z, x, y, format), format);
    const I16 column = I16::load(rounds.column[r].data()) >> 16, row = I16::load(rounds.row[r].data()) >> 16;
    decode(column * step_x + row * step_y + anchor, format, low, high).store(rounds.depth[r].data());
  }
}

/// A channel: half of a lane.
template <class Step>
struct SampleChannel {
  I16 at_origin;
  Step x, y;
  I16 step_x, step_y;
};

/// Two channels of each round, to `code`.
template <class Arithmetic>
HALFPLANE_INLINE void sample_pair(const Bin& bin, const SmallPlanes<Arithmetic>& planes, std::size_t pair,
                                  const SampleRounds& rounds, std::array<SmallBatch::Lane, SampleRounds::kMost>& code) {
  const LaneFormat& format = bin.color_format;
  const PairCodes codes(planes.corners, pair, bin.state.is_flat);
  const auto gradient = planes.color();
  const auto channel = [&](std::size_t half) HALFPLANE_LAMBDA {
    const auto of_half = [half](const I16& both) HALFPLANE_LAMBDA { return PairCodes::of_half(both, half); };
    const auto [x, y] = channel_gradients(planes.corners, gradient, codes, half);
    using Step = std::remove_const_t<decltype(x)>;
    return SampleChannel<Step>{of_half(codes.at_origin), x, y, local_step(x, format), local_step(y, format)};
  };
  const auto first = channel(0), second = channel(1);
  const I16 step_x = pairs(first.step_x, second.step_x), step_y = pairs(first.step_y, second.step_y);
  for (std::size_t r = 0; r < rounds.count; ++r) {
    const auto anchor = [&](const auto& half) HALFPLANE_LAMBDA {
      return narrowed(plane_at(rounds.to(r), bin.widths.plane_fraction, half.at_origin, half.x, half.y, format),
                      format);
    };
    channel_codes(bin, I16::load(rounds.column[r].data()), I16::load(rounds.row[r].data()), step_x, step_y,
                  pairs(anchor(first), anchor(second)), codes.low, codes.high)
        .store(code[r].data());
  }
}

/// Depths and colours of the samples of a batch, from the planes at the anchors of their tiles.
template <class Arithmetic>
HALFPLANE_NOINLINE void set_up_samples(Bin& bin, const Slice& slice, SampleRounds& rounds) {
  const SmallCorners corners = small_corners(bin.small, slice);
  const SmallPlanes<Arithmetic> planes(corners, bin.widths);
  find_samples(bin, corners, rounds);
  sample_depths(bin, planes, rounds);
  if (!bin.state.color_write) return;
  alignas(64) std::array<SmallBatch::Lane, SampleRounds::kMost> red_blue, green_alpha;
  sample_pair(bin, planes, 0, rounds, red_blue);
  sample_pair(bin, planes, 1, rounds, green_alpha);
  for (std::size_t r = 0; r < rounds.count; ++r)
    packed(I16::load(red_blue[r].data()), I16::load(green_alpha[r].data()), bin.config.color_format)
        .store(rounds.color[r].data());
}

/// Triangles whose few samples are known: their samples one by one, in their order. What is written, the state says.
template <class Fragments, bool kDepth, bool kColor, class Depth>
HALFPLANE_INLINE void draw_samples(Bin& bin, const SampleRounds& rounds, Depth* depths) {
  const SliceState state = bin.state;
  std::uint32_t* const colors = bin.memory.color.data();
  unsigned covered_pixels = 0, passed_pixels = 0;
  for (std::uint32_t lanes = bin.small.live; lanes != 0; lanes &= lanes - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(lanes));
    const auto samples = static_cast<unsigned>(bin.small.samples[i]);
    std::size_t round = 0;
    for (unsigned rest = samples; rest != 0; rest &= rest - 1, ++round) {
      const auto at = static_cast<std::uint32_t>(rounds.place[round][i]);
      const std::int32_t depth = rounds.depth[round][i], stored = depths[at];
      // Stored as it was where it fails: which do, nobody can foresee.
      const bool passed = Fragments::passes_one(state, depth, stored);
      passed_pixels += passed ? 1 : 0;
      if (kDepth) depths[at] = static_cast<Depth>(passed ? depth : stored);
      if (kColor) {
        const std::uint32_t color = static_cast<std::uint32_t>(rounds.color[round][i]), old = colors[at];
        colors[at] = passed ? color : old;
      }
    }
    covered_pixels += static_cast<unsigned>(round);
  }
  bin.job.counters.samples_tested += 4 * static_cast<unsigned>(std::popcount(bin.small.live));
  count_fragments(bin, covered_pixels, passed_pixels);
}
template <class Fragments, class Depth>
HALFPLANE_INLINE void draw_samples(Bin& bin, const SampleRounds& rounds, Depth* depths) {
  const bool has_depth = bin.state.depth_write, has_color = bin.state.color_write;
  if (has_depth && has_color) return draw_samples<Fragments, true, true>(bin, rounds, depths);
  if (has_depth) return draw_samples<Fragments, true, false>(bin, rounds, depths);
  has_color ? draw_samples<Fragments, false, true>(bin, rounds, depths)
            : draw_samples<Fragments, false, false>(bin, rounds, depths);
}

/// Draws the small and medium triangles that wait.
template <class Fragments>
void draw_batch(Bin& bin, const Slice& slice) {
  if (bin.small.count == 0) return;
  bin.line_tiles = 0;
  load_records(bin.small, bin.first_x, bin.first_y);
  const BatchTiles tiles = batch_tiles(bin);
  const bool is_short = bin.is_short;
  bool is_changed = false;
  if (bin.small.has_samples) {
    SampleRounds rounds;
    (is_short ? set_up_samples<ShortArithmetic> : set_up_samples<LongArithmetic>)(bin, slice, rounds);
    is_changed = touch_tiles<Fragments>(bin, tiles.touched);
    bin.is_narrow ? draw_samples<Fragments>(bin, rounds, bin.memory.narrow_depth.data())
                  : draw_samples<Fragments>(bin, rounds, bin.memory.depth.data());
  } else {
    const auto set_up =
        tiles.is_over_two
            ? (is_short ? set_up_small<kMediumTiles, ShortArithmetic> : set_up_small<kMediumTiles, LongArithmetic>)
            : (is_short ? set_up_small<kSmallTiles, ShortArithmetic> : set_up_small<kSmallTiles, LongArithmetic>);
    set_up(bin.small, slice, bin.widths, bin.depth_format, bin.color_format, bin.first_x, bin.first_y);
    is_changed = touch_tiles<Fragments>(bin, tiles.touched);
    draw_blocks<Fragments>(bin);
  }
  bin.small.count = 0;
  // With less, a bound that is too high will do.
  if (is_changed || (!Fragments::kIsLess && bin.state.depth_write)) find_bin_range(bin);
}
