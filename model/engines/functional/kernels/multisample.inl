// Several samples a pixel: depths are kept by sample, colours once a pixel while all samples of it have the same one. Only a
// tile in which they differ is split, into n images; one that a triangle takes as a whole is whole again. So what is far from
// edges costs what one sample costs, but for depths: those of a triangle that has taken a tile are computed when somebody needs
// them, at whichever sample.
//
// An edge at a sample is the edge at the centre plus a constant, and so is a depth (multisample.hpp).
// A room of the kernels, compiled once for each instruction set: see ../kernels.inl.

/// The triangle at work. In its order: the centre's edges as those of BinTriangle, from there to each sample.
struct SeveralSamples {
  std::array<EdgeWords, kMaxPixelSamples> edge;
  std::array<std::int32_t, kMaxPixelSamples> depth;  ///< in a lane
  EdgeWords edge_least, edge_most;                   ///< of them, and of the centre's 0
  std::uint32_t drawn;                               ///< samples that the draw's mask lets pass, a bit each
  bool draws_all;

  HALFPLANE_INLINE explicit SeveralSamples(const Bin& bin) : drawn(bin.drawn_samples) {
    const EdgeWords zero{};
    for (EdgeWords& one : edge) one = zero;
    depth.fill(0);
    edge_least = edge_most = zero;
    draws_all = drawn == (1U << bin.samples) - 1;
  }

  /// sample_edge_offset() of the three edges. The bits that they have lost are the same at every pixel's centre.
  HALFPLANE_INLINE void move_edges(const Bin& bin, const Corners& corners, const BinTriangle& t) {
    typedef std::uint32_t Unsigned __attribute__((vector_size(16)));
    const int s = bin.widths.grid_bits;
    const auto half = static_cast<std::uint32_t>(1 << (s - 1));
    const EdgeWords x{corners.a->x, corners.b->x, corners.c->x, 0}, y{corners.a->y, corners.b->y, corners.c->y, 0};
    const EdgeWords dx = load_edges(t.dx), dy = load_edges(t.dy);
    const Unsigned exact =
        cross((Unsigned)dx, (Unsigned)dy, half - (Unsigned)x, half - (Unsigned)y) + (Unsigned)~is_top_left(dx, dy);
    const auto low = (EdgeWords)(exact & ((1U << s) - 1));
    for (std::size_t k = 0; k < bin.samples; ++k) {
      const SampleOffset& o = bin.widths.sample_offset[k];
      edge[k] = (low - dy * o.x + dx * o.y) >> s;
      edge_least = smaller(edge_least, edge[k]);
      edge_most = larger(edge_most, edge[k]);
    }
  }

  HALFPLANE_INLINE void move_depths(const Bin& bin, BinTriangle& t) {
    std::int64_t least = 0, most = 0;
    for (unsigned k = 0; k < bin.samples; ++k) {
      const std::int64_t gain = depth_to_sample(bin, t, k);
      depth[k] = static_cast<std::int32_t>(static_cast<std::uint32_t>(gain) << bin.depth_format.up);
      least = std::min(least, gain);
      most = std::max(most, gain);
    }
    const int s = bin.widths.grid_bits, drop = bin.depth_format.step_drop;
    find_reach(bin, round_shift(t.z_tile_x >> (kTileShift + s), drop),
               round_shift(t.z_tile_y >> (kTileShift + s), drop), t, least, most);
  }

  HALFPLANE_INLINE const EdgeWords& least() const { return edge_least; }
  HALFPLANE_INLINE const EdgeWords& most() const { return edge_most; }
  HALFPLANE_INLINE static std::size_t surfaces() { return 1 + kMaxPixelSamples; }
  HALFPLANE_INLINE std::uint64_t takeable() const { return draws_all ? ~std::uint64_t{0} : 0; }
  HALFPLANE_INLINE std::uint64_t as_one(const Bin& bin) const {
    if (!draws_all) return 0;
    const std::uint64_t is_far = bits_of(S64::load(bin.color_owner.data()) == S64(std::int16_t{Bin::kInTarget}));
    return ~(bin.split | is_far);
  }
  template <class Fragments>
  HALFPLANE_INLINE void draw(Bin& bin, const Slice& slice, const Record& record, const BinTriangle& t,
                             std::uint64_t tiles, std::uint64_t full, std::uint64_t in_front) const;
};

/// Depths of the samples of a tile: in memory.
HALFPLANE_NOINLINE void need_sample_depths(Bin& bin, int tile) {
  if (bin.depth_owner[tile] == Bin::kInMemory) return;
  for (unsigned k = 0; k < bin.samples; ++k) {
    const TileBlocks blocks = sample_depths(bin, tile, k);
    for (std::size_t i = 0; i < 4; ++i)
      store_sample(bin, k, static_cast<std::size_t>(first_of(tile)) + kBlockPixels * i, blocks[i]);
  }
  bin.depth_owner[tile] = Bin::kInMemory;
}

/// Colours of a tile, of whichever owner: in memory, split where they are the target's.
HALFPLANE_NOINLINE void need_sample_colors(Bin& bin, int tile) {
  if (bin.color_owner[tile] != Bin::kInTarget) return need_color(bin, tile);
  for (unsigned k = 0; k < bin.samples; ++k) {
    const TileBlocks blocks = fetched(bin, tile, false, 0, bin.job.target.samples[k].color);
    std::uint32_t* const to = bin.sample_memory.color[k] + first_of(tile);
    for (std::size_t i = 0; i < 4; ++i) blocks[i].store(to + kBlockPixels * i);
  }
  bin.color_owner[tile] = Bin::kInMemory;
  bin.split |= std::uint64_t{1} << tile;
}

HALFPLANE_NOINLINE void split_tile(Bin& bin, int tile) {
  need_sample_colors(bin, tile);
  if ((bin.split >> tile & 1) != 0) return;
  const std::uint32_t* const from = bin.memory.color.data() + first_of(tile);
  for (unsigned k = 0; k < bin.samples; ++k)
    for (std::size_t i = 0; i < 4; ++i)
      I16::load(from + kBlockPixels * i).store(bin.sample_memory.color[k] + first_of(tile) + kBlockPixels * i);
  bin.split |= std::uint64_t{1} << tile;
}

/// What a triangle covers of a tile, and what of that has passed the depth test: a bit a pixel.
struct SamplePixels {
  std::uint64_t centre = ~std::uint64_t{0};
  std::array<std::uint64_t, kMaxPixelSamples> covered, passed{};
  std::uint64_t any = 0, all = ~std::uint64_t{0};  ///< of `passed`

  HALFPLANE_INLINE void find_any_and_all(unsigned samples) {
    any = 0;
    all = ~std::uint64_t{0};
    for (unsigned k = 0; k < samples; ++k) {
      any |= passed[k];
      all &= passed[k];
    }
  }
};

/// The colours of a tile's pixels as they are stored or, of 8 bits a channel, before they are.
struct PixelColors {
  alignas(64) std::array<std::uint32_t, kTileSize * kTileSize> code{};

  HALFPLANE_INLINE ColorPairs operator[](std::size_t block) const {
    return ColorPairs(I16::load(code.data() + block * kBlockPixels));
  }
};

/// One triangle in its tiles.
struct SampledTriangle {
  Bin& bin;
  const Slice& slice;
  const Record& record;
  const BinTriangle& t;
  const SeveralSamples& at;
  const TileConstants constants;
  std::array<std::int32_t, kMaxPixelSamples> surface{};   ///< its number where a sample shades; 0: none yet
  std::array<ChannelPairs, kMaxPixelSamples> color_gain;  ///< from the centre to each sample: once somebody asks
  bool has_gains = false;

  HALFPLANE_INLINE SampledTriangle(Bin& bin_, const Slice& slice_, const Record& record_, const BinTriangle& t_,
                                   const SeveralSamples& at_)
      : bin(bin_), slice(slice_), record(record_), t(t_), at(at_), constants(bin_, t_) {}

  /// Takes the pixels outside an edge out of what is covered. `smallest`: its value at the centre where it is least.
  HALFPLANE_INLINE void leave_out(std::size_t e, std::int32_t smallest, SamplePixels& pixels) const {
    const std::int32_t below = constants.below[e], to_first = constants.to_smallest[e];
    // As in outside_edges().
    const auto first = [&](std::int32_t moved)
                           HALFPLANE_LAMBDA { return std::min(std::max(smallest + moved, below), 0) - to_first; };
    const auto each = [&](auto&& outside) HALFPLANE_LAMBDA {
      pixels.centre &= ~outside(first(0));
      for (unsigned k = 0; k < bin.samples; ++k) pixels.covered[k] &= ~outside(first(at.edge[k][e]));
    };
    if (constants.is_steep)
      return each([&](std::int32_t from) HALFPLANE_LAMBDA { return bits_of(constants.steep_edges[e](from)); });
    const S64 ramp = constants.edges[e](0);
    each([&](std::int32_t from) HALFPLANE_LAMBDA { return bits_at_most(ramp, static_cast<std::int16_t>(~from)); });
  }

  /// False where nothing is covered. Mostly one edge cuts a tile: the others are not looked at.
  HALFPLANE_INLINE bool cover(int tile, bool is_full, SamplePixels& pixels) const {
    std::uint64_t in_box = ~std::uint64_t{0};
    const int x = tile % kBinTiles, y = tile / kBinTiles;
    if (!is_full && !constants.is_whole) in_box = ~bits_of(outside_box(bin, t.box, x, y));
    pixels.centre = in_box;
    for (unsigned k = 0; k < bin.samples; ++k) pixels.covered[k] = in_box;
    if (is_full) return true;
    const EdgeWords smallest = constants.edge + constants.to_smallest + (y * constants.tile_dx - x * constants.tile_dy);
    const auto at_centre = stored(smallest), at_least = stored(smallest + at.edge_least);
    for (std::size_t e = 0; e < 3; ++e)
      if (at_least[e] < 0) leave_out(e, at_centre[e], pixels);
    std::uint64_t any = 0;
    for (unsigned k = 0; k < bin.samples; ++k) any |= pixels.covered[k];
    return any != 0;
  }

  template <class Fragments>
  HALFPLANE_INLINE void test(int tile, SamplePixels& pixels) const {
    need_sample_depths(bin, tile);
    const std::int32_t anchor = depth_anchor(bin, t, tile % kBinTiles, tile / kBinTiles);
    const auto first = static_cast<std::size_t>(first_of(tile));
    const bool writes = bin.state.depth_write;
    if (constants.is_narrow) {
      std::uint16_t* const depths = bin.sample_memory.narrow_depth[0] + first;
      const DepthLanes limits(constants.z_low, constants.z_high, constants.middle);
      const unsigned samples = bin.samples;
      U64 low(0xffff), high(0);
      for (unsigned k = 0; k < samples; ++k) {
        std::uint16_t* const to = depths + k * std::size_t{kBinSize * kBinSize};
        const U64 stored = U64::load(to);
        U64 now = stored;
        if ((at.drawn >> k & 1) != 0) {
          const TestedTile result = tested<Fragments>(bin, constants, limits, wrapped_sum(anchor, at.depth[k]),
                                                      ~lanes_of(pixels.covered[k]), stored);
          pixels.passed[k] = result.passed;
          now = result.now;
          if (writes && result.passed != 0) now.store(to);
        }
        low = min(low, now);
        high = max(high, now);
      }
      pixels.find_any_and_all(bin.samples);
      if (!writes || pixels.any == 0) return;
      bin.tile_low[tile] = static_cast<std::uint16_t>(min_lane(low));
      bin.tile_high[tile] = static_cast<std::uint16_t>(max_lane(high));
      return;
    }
    for (unsigned k = 0; k < bin.samples; ++k) {
      if ((at.drawn >> k & 1) == 0) continue;
      const BlockRamp<I16> plane = depth_ramp(bin, t, wrapped_sum(anchor, at.depth[k]));
      for_each_block([&](auto block) HALFPLANE_LAMBDA {
        const std::uint32_t covered = block_bits(pixels.covered[k], block);
        if (covered == 0) return;
        const std::size_t place = first + block * kBlockPixels;
        const I16 stored = load_sample(bin, k, place), depths = block_depths(bin, t, plane, block);
        const std::uint32_t passed = covered & bits_of(Fragments::passes(bin.state, depths, stored));
        pixels.passed[k] |= std::uint64_t{passed} << (kBlockPixels * block);
        if (writes) store_sample(bin, k, place, select_by_bits(passed, depths, stored, bin.position.to_sign));
      });
    }
    pixels.find_any_and_all(bin.samples);
    if (writes && pixels.any != 0) find_sample_range(bin, tile);
  }

  /// The pixels whose colour is from sample m, which is the first that is covered where the centre is not.
  template <class Visit>
  HALFPLANE_INLINE void for_each_place(const SamplePixels& pixels, Visit&& visit) const {
    std::uint64_t rest = pixels.any & ~pixels.centre;
    for (unsigned m = 0; rest != 0 && m < bin.samples; ++m) {
      const std::uint64_t here = rest & pixels.covered[m];
      rest &= ~here;
      if (here != 0) visit(m, here);
    }
  }

  HALFPLANE_INLINE std::int32_t surface_at(unsigned m) {
    if (surface[m] == 0) surface[m] = add_surface(bin, slice, record, static_cast<int>(m));
    return surface[m];
  }
  HALFPLANE_INLINE ChannelPairs anchor_of(int tile) const {
    return color_anchor(bin, t, tile % kBinTiles, tile / kBinTiles);
  }
  HALFPLANE_INLINE const ChannelPairs& gain_at(unsigned m) {
    if (!has_gains)
      for (unsigned k = 0; k < bin.samples; ++k) color_gain[k] = color_at_sample(bin, t, k);
    has_gains = true;
    return color_gain[m];
  }
  HALFPLANE_INLINE ChannelPairs anchor_at(unsigned m, int tile) {
    const ChannelPairs centre = anchor_of(tile), gain = gain_at(m);
    return {sum_of_pairs(centre[0], gain[0]), sum_of_pairs(centre[1], gain[1])};
  }

  /// Colours of a block's pixels with a sample that has passed, `any` of them. `plane`: at the centres.
  HALFPLANE_INLINE I16 colors_of_block(const ColorRamp& plane, const SamplePixels& pixels, std::size_t block,
                                       std::uint32_t any, ColorFormat format) {
    I16 color = block_colors(t.color, plane, block, bin.color_format, format);
    std::uint32_t rest = any & ~block_bits(pixels.centre, block);
    for (unsigned m = 0; rest != 0 && m < bin.samples; ++m) {
      const std::uint32_t here = rest & block_bits(pixels.covered[m], block);
      if (here == 0) continue;
      rest &= ~here;
      const ChannelPairs& gain = gain_at(m);
      const auto pair = [&](std::size_t p) HALFPLANE_LAMBDA {
        return color_codes(plane[p](block) + as<S32>(I16(gain[p])), I16(t.color.low[p]), I16(t.color.high[p]),
                           bin.color_format);
      };
      color = select_by_bits(here, packed(pair(0), pair(1), format), color, bin.position.to_sign);
    }
    return color;
  }

  /// Colours of all pixels with a sample that has passed, of a surface or of planes.
  HALFPLANE_NOINLINE void find_colors(int tile, const SamplePixels& pixels, ColorFormat format, PixelColors& colors) {
    if (t.surface != 0) {
      const auto set = [&](std::int32_t number, std::uint64_t here) {
        shade(bin, drawn_surface(bin, static_cast<std::size_t>(number)), tile, here, colors.code.data(), format);
      };
      if ((pixels.any & pixels.centre) != 0) set(t.surface, pixels.any & pixels.centre);
      return for_each_place(pixels, [&](unsigned m, std::uint64_t here) { set(surface_at(m), here); });
    }
    const ColorRamp plane = color_ramp(bin, t.color, anchor_of(tile));
    for_each_block([&](auto block) HALFPLANE_LAMBDA {
      const std::uint32_t any = block_bits(pixels.any, block);
      if (any != 0) colors_of_block(plane, pixels, block, any, format).store(colors.code.data() + block * kBlockPixels);
    });
  }

  /// Colours of a block to the samples that have passed.
  HALFPLANE_INLINE void store_samples(int tile, const SamplePixels& pixels, std::size_t block, const I16& color) const {
    std::uint32_t* const to = bin.sample_memory.color[0] + first_of(tile) + block * kBlockPixels;
    for (unsigned k = 0; k < bin.samples; ++k) {
      std::uint32_t* const at_sample = to + k * std::size_t{kBinSize * kBinSize};
      select_by_bits(block_bits(pixels.passed[k], block), color, I16::load(at_sample), bin.position.to_sign)
          .store(at_sample);
    }
  }

  /// Whether the pixels of a tile have one colour each, before and after; what is all covered is so in any case.
  HALFPLANE_INLINE bool stays_whole(int tile, const SamplePixels& pixels) const {
    const std::uint64_t bit = std::uint64_t{1} << tile;
    if (bin.color_owner[tile] == Bin::kInTarget) need_sample_colors(bin, tile);
    if (pixels.all == ~std::uint64_t{0} && !bin.has_operations) bin.split &= ~bit;
    return pixels.any == pixels.all && (bin.split & bit) == 0;
  }

  HALFPLANE_NOINLINE void color(int tile, const SamplePixels& pixels) {
    if (stays_whole(tile, pixels)) {
      const std::uint64_t centre = pixels.any & pixels.centre;
      if (t.surface != 0) {
        if (centre != 0) see(bin, t.surface, tile, centre);
        for_each_place(pixels, [&](unsigned m, std::uint64_t here) { see(bin, surface_at(m), tile, here); });
        return;
      }
      if (centre != 0) color_tile(bin, t, tile, anchor_of(tile), centre);
      for_each_place(pixels,
                     [&](unsigned m, std::uint64_t here) { color_tile(bin, t, tile, anchor_at(m, tile), here); });
      return;
    }
    split_tile(bin, tile);
    if (t.surface != 0) {
      PixelColors colors;
      find_colors(tile, pixels, bin.config.color_format, colors);
      for_each_block([&](auto block) HALFPLANE_LAMBDA {
        if (block_bits(pixels.any, block) != 0)
          store_samples(tile, pixels, block, I16::load(colors.code.data() + block * kBlockPixels));
      });
      return;
    }
    const ColorRamp plane = color_ramp(bin, t.color, anchor_of(tile));
    for_each_block([&](auto block) HALFPLANE_LAMBDA {
      const std::uint32_t any = block_bits(pixels.any, block);
      if (any != 0)
        store_samples(tile, pixels, block, colors_of_block(plane, pixels, block, any, bin.config.color_format));
    });
  }

  /// Depths of what has passed every test.
  HALFPLANE_INLINE void write_depths(int tile, const SamplePixels& pixels) const {
    if (pixels.any == 0) return;
    const std::int32_t anchor = depth_anchor(bin, t, tile % kBinTiles, tile / kBinTiles);
    for (unsigned k = 0; k < bin.samples; ++k) {
      const BlockRamp<I16> plane = depth_ramp(bin, t, wrapped_sum(anchor, at.depth[k]));
      for_each_block([&](auto block) HALFPLANE_LAMBDA {
        const std::size_t place = static_cast<std::size_t>(first_of(tile)) + block * kBlockPixels;
        store_sample(bin, k, place,
                     select_by_bits(block_bits(pixels.passed[k], block), block_depths(bin, t, plane, block),
                                    load_sample(bin, k, place), bin.position.to_sign));
      });
    }
    find_sample_range(bin, tile);
  }

  /// operate_on_tile() of samples.
  HALFPLANE_NOINLINE void operate(int tile, SamplePixels& pixels) {
    const FragmentOps& ops = *bin.ops;
    const auto count = [&] {
      unsigned sum = 0;
      for (unsigned k = 0; k < bin.samples; ++k) sum += static_cast<unsigned>(std::popcount(pixels.passed[k]));
      return sum;
    };
    if (bin.is_killed) return count_killed(bin, count());
    if (!bin.tests_alpha && !ops.state.color_write) return;
    if (!bin.tests_alpha && stays_whole(tile, pixels) && (pixels.any & ~pixels.centre) == 0)
      return operate_on_tile(bin, t, tile, pixels.any);
    PixelColors colors;
    find_colors(tile, pixels, ColorFormat::rgba8888, colors);
    if (bin.tests_alpha) {
      const std::uint64_t kept = test_alpha(bin, pixels.any, colors);
      const unsigned before = count();
      for (unsigned k = 0; k < bin.samples; ++k) pixels.passed[k] &= kept;
      pixels.find_any_and_all(bin.samples);
      count_killed(bin, before - count());
      if (ops.state.depth_write) write_depths(tile, pixels);
    }
    if (!ops.state.color_write || pixels.any == 0) return;
    if (stays_whole(tile, pixels)) {
      need_color(bin, tile);
      return store_colors(bin, bin.memory.color.data() + first_of(tile), pixels.any, colors);
    }
    split_tile(bin, tile);
    for (unsigned k = 0; k < bin.samples; ++k)
      if (pixels.passed[k] != 0)
        store_colors(bin, bin.sample_memory.color[k] + first_of(tile), pixels.passed[k], colors);
  }

  template <class Fragments>
  HALFPLANE_INLINE void draw(int tile, bool is_full, PixelCounts& counts) {
    SamplePixels pixels;
    if (!cover(tile, is_full, pixels)) return;
    test<Fragments>(tile, pixels);
    for (unsigned k = 0; k < bin.samples; ++k) {
      if ((at.drawn >> k & 1) == 0) continue;
      counts.covered += static_cast<unsigned>(std::popcount(pixels.covered[k]));
      counts.passed += static_cast<unsigned>(std::popcount(pixels.passed[k]));
    }
    if (pixels.any == 0) return;
    if (bin.has_operations)
      operate(tile, pixels);
    else if (bin.state.color_write)
      color(tile, pixels);
  }
};

template <class Fragments>
HALFPLANE_NOINLINE void draw_sampled_tiles(Bin& bin, const Slice& slice, const Record& record, const BinTriangle& t,
                                           const SeveralSamples& at, std::uint64_t tiles, std::uint64_t full,
                                           std::uint64_t in_front) {
  SampledTriangle drawn(bin, slice, record, t, at);
  PixelCounts pixels;
  constexpr std::uint64_t kPixels = kTileSize * kTileSize;
  bin.job.counters.skipped.trivially_accepted += static_cast<unsigned>(std::popcount(tiles & full));
  bin.job.counters.samples_tested += kPixels * bin.samples * static_cast<unsigned>(std::popcount(tiles & ~full));
  for (; tiles != 0; tiles &= tiles - 1) {
    const int tile = std::countr_zero(tiles);
    if ((in_front >> tile & 1) != 0) {
      operate_on_tile(bin, t, tile, ~std::uint64_t{0});
      if (bin.is_killed) count_killed(bin, static_cast<unsigned>(kPixels) * (bin.samples - 1));
      pixels.covered += kPixels * bin.samples;
      pixels.passed += kPixels * bin.samples;
      continue;
    }
    drawn.draw<Fragments>(tile, (full >> tile & 1) != 0, pixels);
  }
  count_fragments(bin, pixels.covered, pixels.passed);
}

template <class Fragments>
HALFPLANE_INLINE void SeveralSamples::draw(Bin& bin, const Slice& slice, const Record& record, const BinTriangle& t,
                                           std::uint64_t tiles, std::uint64_t full, std::uint64_t in_front) const {
  draw_sampled_tiles<Fragments>(bin, slice, record, t, *this, tiles, full, in_front);
}
