// Small and medium triangles: the blocks of 4 x 4 pixels that they cover; of those within two by two pixels, their
// samples.
// Included inside class Bin: see raster.inl.

/// A block of a triangle of the batch with at least one covered pixel.
struct Block {
  std::uint32_t place;    ///< lane of the batch, column and row among the bin's blocks: a byte each
  std::uint32_t covered;  ///< bits
};

template <DepthFunc Test>
void draw_batch(const Slice& slice) {
  if (small_.count == 0) return;
  line_tiles_ = 0;
  small_.load(first_x_, first_y_);
  const BatchTiles tiles = batch_tiles();
  if (tiles.is_over_two)
    small_.set_up<kMediumTiles>(slice, job_.frame, depth_format_, color_format_, first_x_, first_y_);
  else
    small_.set_up<kSmallTiles>(slice, job_.frame, depth_format_, color_format_, first_x_, first_y_);
  const bool is_changed = touch<Test>(tiles.touched);
  small_.has_samples ? draw_samples<Test>() : draw_blocks<Test>();
  small_.count = 0;
  // With less, a bound that is too high will do.
  if (is_changed || (Test != DepthFunc::less && state_.depth_write)) find_bin_range();
}

/// The tiles that the boxes of the batch touch.
struct BatchTiles {
  std::uint64_t touched = 0;  ///< a bit each
  bool is_over_two = false;   ///< along the side of a box
};
HALFPLANE_INLINE BatchTiles batch_tiles() {
  const auto tiles_of = [](const SmallBatch::Lane& at) HALFPLANE_LAMBDA { return I16::load(at.data()) >> kTileShift; };
  const I16 left = tiles_of(small_.left), top = tiles_of(small_.top), columns = tiles_of(small_.right) - left,
            rows = tiles_of(small_.bottom) - top;
  BatchTiles tiles;
  for (int row = 0; row < kMediumTiles; ++row)
    for (int column = 0; column < kMediumTiles; ++column) {
      const std::uint32_t lanes = bits_of((columns >= column) & (rows >= row)) & small_.live;
      if (lanes == 0) break;
      tiles.touched |= or_of_bits((top + row) * kBinTiles + (left + column), lanes);
      tiles.is_over_two |= row == 2 || column == 2;
      job_.counters.tiles_visited += static_cast<unsigned>(std::popcount(lanes));
    }
  return tiles;
}

/// They must be in memory, and their ranges are known no more. Every now and then finds a tile's range anew; says so.
template <DepthFunc Test>
HALFPLANE_INLINE bool touch(std::uint64_t tiles) {
  for (std::uint64_t rest = tiles & ~in_memory_; rest != 0; rest &= rest - 1) {
    const int at = std::countr_zero(rest);
    need_depth(at);
    if (state_.color_write) need_color(at);
  }
  if (state_.color_write) in_memory_ |= tiles;
  if (!state_.depth_write) return false;
  bool is_changed = false;
  for (std::uint64_t rest = tiles; rest != 0; rest &= rest - 1) {
    const auto at = static_cast<std::size_t>(std::countr_zero(rest));
    if (++touches_[at] == kTouches) {
      touches_[at] = 0;
      find_range(static_cast<int>(at));
      is_changed = true;
    }
    forget_range<Test>(static_cast<int>(at));
  }
  return is_changed;
}

template <DepthFunc Test>
HALFPLANE_INLINE void draw_blocks() {
  const std::size_t blocks = find_blocks();
  std::uint64_t covered = 0, passed = 0;
  for (std::size_t b = 0; b < blocks; ++b) draw_block<Test>(blocks_[b], covered, passed);
  count(covered, passed);
}

/// The blocks of the batch in which a sample is covered, triangle by triangle. Two by two of them are looked at without
/// asking whether the box touches them: a branch that nobody can foresee costs more.
HALFPLANE_INLINE std::size_t find_blocks() {
  std::size_t blocks = 0, tested = 0;
  const auto add = [&](std::uint32_t place, const I16& signs, std::uint32_t is_there) HALFPLANE_LAMBDA {
    const std::uint32_t covered = ~bits_of(signs) & 0xffff & (0U - is_there);
    blocks_[blocks] = {place, covered};
    blocks += covered != 0 ? 1U : 0U;
  };
  for (std::uint32_t rest = small_.live; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    std::array<I16, 3> edge, right, below;
    for (std::size_t e = 0; e < 3; ++e) {
      edge[e] = multiply_add_pairs(I16(small_.edge_step[e][i]), position_.block_yx) + small_.edge[e][i];
      right[e] = edge[e] + small_.to_right[e][i];
      below[e] = edge[e] + small_.to_below[e][i];
    }
    const auto place = static_cast<std::uint32_t>(small_.place[i]), there = static_cast<std::uint32_t>(small_.there[i]);
    constexpr std::uint32_t kColumn = 1 << 8, kRow = 1 << 16;
    add(place, edge[0] | edge[1] | edge[2], there & 1);
    add(place + kColumn, right[0] | right[1] | right[2], there >> 1 & 1);
    add(place + kRow, below[0] | below[1] | below[2], there >> 2 & 1);
    add(place + kColumn + kRow,
        (below[0] + small_.to_right[0][i]) | (below[1] + small_.to_right[1][i]) | (below[2] + small_.to_right[2][i]),
        there >> 3 & 1);
    const int columns = (small_.right[i] >> kBlockShift) - (small_.left[i] >> kBlockShift),
              rows = (small_.bottom[i] >> kBlockShift) - (small_.top[i] >> kBlockShift);
    tested += static_cast<unsigned>((columns + 1) * (rows + 1));
    if (columns < 2 && rows < 2) continue;
    for (int dy = 0; dy <= rows; ++dy) {
      std::array<I16, 3> at = edge;
      for (int dx = 0; dx <= columns; ++dx) {
        if (dx >= 2 || dy >= 2)
          add(place + kColumn * static_cast<std::uint32_t>(dx) + kRow * static_cast<std::uint32_t>(dy),
              at[0] | at[1] | at[2], there & 1);
        for (std::size_t e = 0; e < 3; ++e) at[e] += I16(small_.to_right[e][i]);
      }
      for (std::size_t e = 0; e < 3; ++e) edge[e] += I16(small_.to_below[e][i]);
    }
  }
  job_.counters.samples_tested += kBlockPixels * tested;
  return blocks;
}

/// Depth, test and colour of a block.
template <DepthFunc Test>
HALFPLANE_INLINE void draw_block(const Block& block, std::uint64_t& covered_pixels, std::uint64_t& passed_pixels) {
  const std::size_t i = block.place & 255;
  const int column = static_cast<int>(block.place >> 8 & 255), row = static_cast<int>(block.place >> 16);
  const auto of_box = static_cast<std::size_t>((column >> 1) + kMediumTiles * (row >> 1) - small_.first_tile[i]);
  const std::size_t right = block.place >> 8 & 1, below = block.place >> 16 & 1;  // in its tile
  const auto at = static_cast<std::size_t>(kColumnPlaces[static_cast<std::size_t>(column)] +
                                           kRowPlaces[static_cast<std::size_t>(row)]);
  const I16 value = position_.column[right] * small_.z_step_x[i] + position_.row[below] * small_.z_step_y[i] +
                    small_.z_anchor[of_box][i];
  const I16 depth = decode(value, depth_format_, small_.z_low[i], small_.z_high[i]);
  std::int32_t* depths = memory_.depth.data() + at;
  const I16 stored = I16::load(depths);
  const I16 covered = I16(static_cast<std::int32_t>(block.covered)) << position_.to_sign;
  const I16 passed = covered & passes<Test>(depth, stored);  // signs
  const std::uint32_t passed_bits = bits_of(passed);
  covered_pixels += static_cast<unsigned>(std::popcount(block.covered));
  passed_pixels += static_cast<unsigned>(std::popcount(passed_bits));
  if (passed_bits == 0 && skip_.fragments_early_z) return;
  if (state_.depth_write) select_by_sign(passed, depth, stored).store(depths);
  if (!state_.color_write) return;
  const auto pair = [&](std::size_t p) HALFPLANE_LAMBDA {
    return channel_codes(position_.column_pair[right], position_.row_pair[below], small_.c_step_x[p][i],
                         small_.c_step_y[p][i], small_.c_anchor[p][of_box][i], small_.c_low[p][i], small_.c_high[p][i]);
  };
  const I16 color = packed(pair(0), pair(1), config_.color_format);
  std::uint32_t* pixels = memory_.color.data() + at;
  select_by_sign(passed, color, I16::load(pixels)).store(pixels);
}

/// Triangles whose few samples are known: a triangle a lane, then sample by sample in their order.
template <DepthFunc Test>
HALFPLANE_INLINE void draw_samples() {
  constexpr std::size_t kSamples = 4;
  alignas(64) std::array<SmallBatch::Lane, kSamples> depth, color, place;
  const I16 left = I16::load(small_.left.data()), top = I16::load(small_.top.data());
  const auto from_anchor = [](const I16& at) HALFPLANE_LAMBDA { return (at & (kTileSize - 1)) - kTileSize / 2; };
  const std::array<I16, 2> x{left, left + 1}, y{top, top + 1};
  const std::array<I16, 2> column{from_anchor(x[0]), from_anchor(x[1])}, row{from_anchor(y[0]), from_anchor(y[1])};
  const auto load = [](const SmallBatch::Lane& lane) HALFPLANE_LAMBDA { return I16::load(lane.data()); };
  for (std::size_t s = 0; s < kSamples; ++s) {
    const std::size_t i = s & 1, j = s >> 1, anchor = i + kMediumTiles * j;
    place_of(x[i], y[j]).store(place[s].data());
    const I16 value =
        column[i] * load(small_.z_step_x) + row[j] * load(small_.z_step_y) + load(small_.z_anchor[anchor]);
    decode(value, depth_format_, load(small_.z_low), load(small_.z_high)).store(depth[s].data());
    if (!state_.color_write) continue;
    const I16 columns = pairs(column[i], column[i]), rows = pairs(row[j], row[j]);
    const auto channels = [&](std::size_t p) HALFPLANE_LAMBDA {
      return channel_codes(columns, rows, load(small_.c_step_x[p]), load(small_.c_step_y[p]),
                           load(small_.c_anchor[p][anchor]), load(small_.c_low[p]), load(small_.c_high[p]));
    };
    packed(channels(0), channels(1), config_.color_format).store(color[s].data());
  }
  const bool has_depth = state_.depth_write, has_color = state_.color_write;
  std::uint64_t covered_pixels = 0, passed_pixels = 0;
  for (std::uint32_t rest = small_.live; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    const auto samples = static_cast<std::uint32_t>(small_.samples[i]);
    covered_pixels += static_cast<unsigned>(std::popcount(samples));
    for (std::uint32_t left_over = samples; left_over != 0; left_over &= left_over - 1) {
      const auto s = static_cast<std::size_t>(std::countr_zero(left_over));
      const auto at = static_cast<std::size_t>(place[s][i]);
      const std::int32_t stored = memory_.depth[at];
      // Stored as it was where it fails: which do, nobody can foresee.
      const std::uint32_t passed = passes_one<Test>(depth[s][i], stored) ? 1U : 0U, mask = 0U - passed;
      passed_pixels += passed;
      if (has_depth) memory_.depth[at] = stored ^ ((stored ^ depth[s][i]) & static_cast<std::int32_t>(mask));
      if (has_color) memory_.color[at] ^= (memory_.color[at] ^ static_cast<std::uint32_t>(color[s][i])) & mask;
    }
  }
  job_.counters.samples_tested += kSamples * static_cast<unsigned>(std::popcount(small_.live));
  count(covered_pixels, passed_pixels);
}
