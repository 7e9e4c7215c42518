// Small triangles: the blocks of 4 x 4 pixels that they cover; of those within two by two pixels, their samples.
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
  small_.set_up(slice, job_.frame, depth_format_, color_format_, first_x_, first_y_);
  bool is_changed = false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(small_.count); ++i) is_changed |= touch_tiles(i);
  if (state_.depth_write)
    for (std::size_t i = 0; i < static_cast<std::size_t>(small_.count); ++i)
      for (const int tile : small_tiles(i)) forget_range<Test>(tile);
  std::uint64_t tiles = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(small_.count); ++i)
    tiles += static_cast<unsigned>((1 + (small_.right[i] >> kTileShift) - (small_.left[i] >> kTileShift)) *
                                   (1 + (small_.bottom[i] >> kTileShift) - (small_.top[i] >> kTileShift)));
  job_.counters.tiles_visited += tiles;
  small_.has_samples ? draw_samples<Test>() : draw_blocks<Test>();
  small_.count = 0;
  if (is_changed || Test != DepthFunc::less) find_bin_range();  // with less, a bound that is too high will do
}

template <DepthFunc Test>
HALFPLANE_INLINE void draw_blocks() {
  const std::size_t blocks = find_blocks();
  std::uint64_t covered = 0, passed = 0;
  for (std::size_t b = 0; b < blocks; ++b) draw_block<Test>(blocks_[b], covered, passed);
  count(covered, passed);
}

/// The tiles that a small triangle's box touches: four at most, some of them the same.
HALFPLANE_INLINE std::array<int, 4> small_tiles(std::size_t i) const {
  const int left = small_.left[i], top = small_.top[i], right = small_.right[i], bottom = small_.bottom[i];
  return {tile_of(left, top), tile_of(right, top), tile_of(left, bottom), tile_of(right, bottom)};
}

/// They must be in memory. Every now and then finds a tile's range anew; says so.
HALFPLANE_INLINE bool touch_tiles(std::size_t i) {
  const std::array<int, 4> tiles = small_tiles(i);
  for (const int tile : tiles) {
    need_depth(tile);
    if (state_.color_write) need_color(tile);
  }
  if (!state_.depth_write) return false;
  std::uint8_t& touches = touches_[static_cast<std::size_t>(tiles[0])];
  if (++touches != kTouches) return false;
  touches = 0;
  find_range(tiles[0]);
  return true;
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
  for (std::size_t i = 0; i < static_cast<std::size_t>(small_.count); ++i) {
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
    const int columns = (small_.right[i] >> 2) - (small_.left[i] >> 2),
              rows = (small_.bottom[i] >> 2) - (small_.top[i] >> 2);
    tested += static_cast<unsigned>((columns + 1) * (rows + 1));
    if (columns < 2 && rows < 2) continue;
    for (int dy = 0; dy <= rows; ++dy)
      for (int dx = dy < 2 ? 2 : 0; dx <= columns; ++dx) {
        I16 signs(0);
        for (std::size_t e = 0; e < 3; ++e)
          signs |= edge[e] + (dx * small_.to_right[e][i] + dy * small_.to_below[e][i]);
        add(place + kColumn * static_cast<std::uint32_t>(dx) + kRow * static_cast<std::uint32_t>(dy), signs, there & 1);
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
  const int tile_x = column >> 1, tile_y = row >> 1;
  // Of the tiles that the box may touch, and of the blocks of a tile.
  const auto of_box =
      static_cast<std::size_t>(tile_x - (small_.left[i] >> kTileShift) + 2 * (tile_y - (small_.top[i] >> kTileShift)));
  const auto of_tile = static_cast<std::size_t>((column & 1) + 2 * (row & 1));
  const auto at = static_cast<std::size_t>(first_of(tile_y * kBinTiles + tile_x)) + kBlockPixels * of_tile;
  const I16 value = position_.column[of_tile & 1] * small_.z_step_x[i] +
                    position_.row[of_tile >> 1] * small_.z_step_y[i] + small_.z_anchor[of_box][i];
  const I16 depth = decode(value, depth_format_, small_.z_low[i], small_.z_high[i]);
  std::int32_t* depths = memory_.depth.data() + at;
  const I16 stored = I16::load(depths);
  const I16 passed = from_bits(block.covered) & passes<Test>(depth, stored);
  const std::uint32_t passed_bits = bits_of(passed);
  covered_pixels += static_cast<unsigned>(std::popcount(block.covered));
  passed_pixels += static_cast<unsigned>(std::popcount(passed_bits));
  if (passed_bits == 0 && skip_.fragments_early_z) return;
  if (state_.depth_write) select(passed, depth, stored).store(depths);
  if (!state_.color_write) return;
  const auto pair = [&](std::size_t p) HALFPLANE_LAMBDA {
    return channel_codes(position_.column_pair[of_tile & 1], position_.row_pair[of_tile >> 1], small_.c_step_x[p][i],
                         small_.c_step_y[p][i], small_.c_anchor[p][of_box][i], small_.c_low[p][i], small_.c_high[p][i]);
  };
  const I16 color = packed(pair(0) | pair(1) << 8);
  std::uint32_t* pixels = memory_.color.data() + at;
  select(passed, color, I16::load(pixels)).store(pixels);
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
    const std::size_t i = s & 1, j = s >> 1;
    place_of(x[i], y[j]).store(place[s].data());
    const I16 value = column[i] * load(small_.z_step_x) + row[j] * load(small_.z_step_y) + load(small_.z_anchor[s]);
    decode(value, depth_format_, load(small_.z_low), load(small_.z_high)).store(depth[s].data());
    if (!state_.color_write) continue;
    const I16 columns = pairs(column[i], column[i]), rows = pairs(row[j], row[j]);
    const auto channels = [&](std::size_t p) HALFPLANE_LAMBDA {
      return channel_codes(columns, rows, load(small_.c_step_x[p]), load(small_.c_step_y[p]), load(small_.c_anchor[p][s]),
                           load(small_.c_low[p]), load(small_.c_high[p]));
    };
    packed(channels(0) | channels(1) << 8).store(color[s].data());
  }
  // All four, covered or not: which they are, nobody can foresee.
  std::uint64_t covered_pixels = 0, passed_pixels = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(small_.count); ++i) {
    const auto samples = static_cast<std::uint32_t>(small_.samples[i]);
    covered_pixels += static_cast<unsigned>(std::popcount(samples));
    for (std::size_t s = 0; s < kSamples; ++s) {
      const auto at = static_cast<std::size_t>(place[s][i]);
      std::int32_t& stored = memory_.depth[at];
      const std::uint32_t passed = samples >> s & (passes_one<Test>(depth[s][i], stored) ? 1U : 0U);
      const std::int32_t mask = -static_cast<std::int32_t>(passed);
      passed_pixels += passed;
      if (state_.depth_write) stored ^= (stored ^ depth[s][i]) & mask;
      if (state_.color_write)
        memory_.color[at] ^= (memory_.color[at] ^ static_cast<std::uint32_t>(color[s][i])) & static_cast<std::uint32_t>(mask);
    }
  }
  job_.counters.samples_tested += kSamples * static_cast<unsigned>(small_.count);
  count(covered_pixels, passed_pixels);
}
