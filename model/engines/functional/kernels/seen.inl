// Who is seen: colours of surfaces are put off. A pixel keeps the number of its triangle until somebody needs its colour,
// mostly the end of the bin, and only those are computed that are still there. A triangle is set up when the first one is.
//
// A tile of which pixels wait has Bin::kSurfaces as the owner of its colours; one that such a triangle has taken waits as
// any other that was taken. So what draws without surfaces asks nothing that it has not always asked.
// A room of the kernels, compiled once for each instruction set: see ../kernels.inl.

/// Whether pixels of a tile wait.
HALFPLANE_INLINE bool is_waiting(const Bin& bin, int tile) {
  const std::int32_t owner = bin.color_owner[tile];
  return owner == Bin::kSurfaces || (owner >= 0 && bin.memory.planes[static_cast<std::size_t>(owner)].surface != 0);
}

/// Affine colours of a triangle of any slice.
inline void set_up_surface_colors(Bin& bin, const SeenSurface& seen, BinTriangle& out) {
  const SliceState state = bin.state;
  bin.state = seen.slice->state;
  (void)set_up(bin, *seen.slice, *seen.record, out);
  if (seen.place != kAtCentre) move_colors(bin, static_cast<std::size_t>(seen.place), out);
  bin.state = state;
}

/// Surface number `number`, which is set up when it is first asked for.
inline const DrawnSurface& drawn_surface(Bin& bin, std::size_t number) {
  BinMemory& memory = bin.memory;
  SeenSurface& seen = memory.seen[number];
  if (seen.drawn >= 0) return memory.drawn[static_cast<std::size_t>(seen.drawn)];
  seen.drawn = static_cast<std::int32_t>(memory.drawn.size());
  const FrameContext& frame = bin.job.frame;
  auto stage = std::make_unique<StageSurface>(frame, *seen.slice, *seen.record, seen.place);
  const auto& texture = seen.slice->context->state.texture;
  DrawnSurface& drawn = memory.drawn.emplace_back(DrawnSurface{
      SurfaceConstants(*stage, frame, texture ? &frame.prepared.textures[*texture] : nullptr), {}, nullptr});
  if (!drawn.constants.are_in_lanes)
    drawn.stage = std::move(stage);
  else if ((drawn.constants.has_color || drawn.constants.light) && !drawn.constants.is_color_over_w)
    set_up_surface_colors(bin, seen, drawn.colors);
  return drawn;
}

/// The number of one more.
inline std::uint16_t add_surface(Bin& bin, const Slice& slice, const Record& record, int place = kAtCentre) {
  const std::size_t number = ++bin.surface_count;
  bin.memory.seen[number] = {&slice, &record, place, -1};
  return static_cast<std::uint16_t>(number);
}

/// The pixels of a tile that show pieces, where it waits pixel by pixel.
HALFPLANE_INLINE std::uint64_t pixels_of_pieces(const Bin& bin, const U64& surface) {
  if (bin.piece_count == 0) return 0;
  return bits_at_least(surface, U64(static_cast<std::uint16_t>(BinMemory::kFirstPiece)));
}

/// Sets up the pieces that tiles show.
HALFPLANE_NOINLINE void set_up_seen(Bin& bin, std::uint64_t tiles) {
  BinMemory& memory = bin.memory;
  std::uint8_t* const states = memory.piece_states.data();
  std::uint8_t* const seen = memory.seen_numbers.data();  // by the number of a pixel, whoever has it
  for (; tiles != 0; tiles &= tiles - 1) {
    const int tile = std::countr_zero(tiles);
    if (bin.color_owner[tile] != Bin::kSurfaces) continue;
    const std::uint16_t* const numbers = memory.surface.data() + first_of(tile);
    for (int i = 0; i < kTileSize * kTileSize; ++i) seen[numbers[i]] = 1;
  }
  std::array<std::uint16_t, 16> numbers{};
  std::size_t style = 0;
  int count = 0;
  const auto set_up_those = [&]() {
    if (count == 0) return;
    SurfaceStyle& of = memory.styles[style];
    const std::uint32_t alone = bin.is_short ? set_up_pieces<ShortArithmetic>(bin, of, numbers, count)
                                             : set_up_pieces<LongArithmetic>(bin, of, numbers, count);
    for (int i = 0; i < count; ++i) {
      const std::size_t number = numbers[static_cast<std::size_t>(i)];
      Piece& piece = memory.pieces[number];
      const bool is_alone = (alone >> i & 1) != 0;
      states[number] = is_alone ? BinMemory::kAlone : BinMemory::kSetUp;
      bin.has_lone_pieces |= is_alone;
      if (is_alone) piece.alone = add_surface(bin, *piece.slice, *piece.record);
    }
    count = 0;
  };
  const auto add = [&](std::size_t number) {
    if (states[number] != BinMemory::kUnseen) return;
    const auto style_ends = [&]() {
      return style + 1 < memory.styles.size() && static_cast<std::size_t>(memory.styles[style + 1].first) <= number;
    };
    if (style_ends() || (count != 0 && memory.pieces[numbers[0]].slice != memory.pieces[number].slice)) set_up_those();
    while (style_ends()) ++style;
    numbers[static_cast<std::size_t>(count)] = static_cast<std::uint16_t>(number);
    if (++count == 16) set_up_those();
  };
  constexpr std::size_t kWord = 8;
  for (std::size_t first = 0; first <= bin.piece_count; first += kWord) {
    std::uint8_t* const word = seen + BinMemory::kFirstPiece + first;
    std::uint64_t any;
    std::memcpy(&any, word, kWord);
    if (any == 0) continue;
    for (std::size_t i = 0; i < kWord; ++i)
      if (word[i] != 0) add(first + i);
    std::memset(word, 0, kWord);
  }
  set_up_those();
}

/// Shades those `pixels` of a tile that show pieces which are set up; returns the others.
HALFPLANE_NOINLINE std::uint64_t shade_pieces_of(Bin& bin, int tile, std::uint64_t pixels) {
  BinMemory& memory = bin.memory;
  std::uint16_t* const numbers = memory.surface.data() + first_of(tile);
  std::uint64_t pieces = pixels_of_pieces(bin, U64::load(numbers));
  if (bin.has_lone_pieces) {
    for (std::uint64_t rest = pieces; rest != 0; rest &= rest - 1) {
      std::uint16_t& number = numbers[std::countr_zero(rest)];
      if (memory.piece_states[number - BinMemory::kFirstPiece] != BinMemory::kAlone) continue;
      number = memory.pieces[number - BinMemory::kFirstPiece].alone;
      pieces &= ~(rest & -rest);
    }
  }
  const U64 surface = U64::load(numbers);
  std::uint64_t rest = pieces;
  for (std::size_t style = memory.styles.size(); rest != 0 && style-- != 0;) {
    const auto first = static_cast<std::uint16_t>(memory.styles[style].first + BinMemory::kFirstPiece);
    const std::uint64_t here = rest & bits_at_least(surface, U64(first));
    if (here != 0) shade_pieces(bin, memory.styles[style], tile, here);
    rest &= ~here;
  }
  return pixels & ~pieces;
}

/// Colours of a tile of which pixels wait: then they are in memory. Its pieces are set up.
HALFPLANE_NOINLINE void shade_set_up_tile(Bin& bin, int tile) {
  const std::int32_t owner = std::exchange(bin.color_owner[tile], std::int16_t{Bin::kInMemory});
  if (owner >= 0) {
    const std::int32_t number = bin.memory.planes[static_cast<std::size_t>(owner)].surface;
    return shade(bin, drawn_surface(bin, static_cast<std::size_t>(number)), tile, ~std::uint64_t{0});
  }
  const std::uint16_t* const numbers = bin.memory.surface.data() + first_of(tile);
  std::uint64_t rest = ~bits_equal(U64::load(numbers), U64(0));
  if (bin.piece_count != 0) rest = shade_pieces_of(bin, tile, rest);
  const U64 surface = U64::load(numbers);
  while (rest != 0) {
    const std::uint16_t number = numbers[std::countr_zero(rest)];
    const std::uint64_t pixels = bits_equal(surface, U64(number));
    shade(bin, drawn_surface(bin, number), tile, pixels);
    rest &= ~pixels;
  }
}

inline void shade_tiles(Bin& bin, std::uint64_t tiles) {
  if (bin.piece_count != 0) set_up_seen(bin, tiles);
  for (; tiles != 0; tiles &= tiles - 1)
    if (is_waiting(bin, std::countr_zero(tiles))) shade_set_up_tile(bin, std::countr_zero(tiles));
}
HALFPLANE_NOINLINE void shade_tile(Bin& bin, int tile) { shade_tiles(bin, std::uint64_t{1} << tile); }

/// Nobody waits any longer: numbers begin anew.
HALFPLANE_NOINLINE void shade_all(Bin& bin) {
  shade_tiles(bin, ~std::uint64_t{0});
  bin.surface_count = 0;
  bin.memory.drawn.clear();
  bin.piece_count = 0;
  bin.has_lone_pieces = false;
  bin.memory.styles.clear();
}

/// Numbers for so many triangles, at most 16.
HALFPLANE_INLINE void need_surfaces(Bin& bin, std::size_t count) {
  if (bin.surface_count + bin.piece_count + count >= BinMemory::kSurfaces) shade_all(bin);
}

/// Whether lanes set up the surfaces of a slice: the last of BinMemory::styles is theirs.
inline bool has_style(Bin& bin, const Slice& slice) {
  BinMemory& memory = bin.memory;
  if (memory.styles.empty() || memory.styles.back().context != slice.context) {
    memory.styles.emplace_back(bin.job.frame, *slice.context);
    memory.styles.back().first = static_cast<std::int32_t>(bin.piece_count + 1);
  }
  if (memory.styles.back().is_in_lanes && memory.pieces.empty()) {
    memory.pieces.resize(BinMemory::kSurfaces);
    memory.piece_states.resize(BinMemory::kSurfaces);
    memory.seen_numbers.resize(BinMemory::kFirstPiece + BinMemory::kSurfaces);
    memory.constants.resize(BinMemory::kSurfaces);
  }
  if (memory.styles.back().sampling == Sampling::any && memory.levels.empty())
    memory.levels.resize(BinMemory::kSurfaces);
  return memory.styles.back().is_in_lanes;
}

/// Those of a batch, one after the other.
HALFPLANE_NOINLINE void add_surfaces(Bin& bin, const Slice& slice) {
  need_surfaces(bin, bin.small.records.size());
  if (!has_style(bin, slice)) {
    bin.batch_surface = static_cast<std::int32_t>(bin.surface_count + 1);
    for (int i = 0; i < bin.small.count; ++i) add_surface(bin, slice, *bin.small.records[static_cast<std::size_t>(i)]);
    return;
  }
  const std::size_t first = bin.piece_count + 1;
  bin.batch_surface = static_cast<std::int32_t>(BinMemory::kFirstPiece + first);
  bin.piece_count += static_cast<std::size_t>(bin.small.count);
  for (std::size_t i = 0; i < static_cast<std::size_t>(bin.small.count); ++i) {
    bin.memory.pieces[first + i] = {&slice, bin.small.records[i], bin.small.window[i], 0};
    bin.memory.piece_states[first + i] = BinMemory::kUnseen;
  }
}

/// Makes the tile's pixels have numbers. Those of nobody have their colours in memory, and 0.
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

/// Pixels of a tile show a surface.
HALFPLANE_INLINE void see(Bin& bin, std::int32_t number, int tile, std::uint64_t pixels) {
  if (!bin.skip.attributes) {
    need_color(bin, tile);
    return shade(bin, drawn_surface(bin, static_cast<std::size_t>(number)), tile, pixels);
  }
  need_numbers(bin, tile);
  std::uint16_t* const at = bin.memory.surface.data() + first_of(tile);
  select(lanes_of(pixels), U64(static_cast<std::uint16_t>(number)), U64::load(at)).store(at);
}
