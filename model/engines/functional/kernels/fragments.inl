// What a draw needs of its fragments, as a policy: a type whose functions compare, and say what may be left out.
//
//   opaque   what passes replaces what is stored, what fails leaves no trace. So a tile that lies behind may be left
//            out, one in front may be taken whole, and blocks are drawn lane by lane.
//   general  anything else: fragment by fragment through the scalar operations, out of line, nothing left out
//            (general.inl). What blending, stencil and alpha ask for belongs there.
//
// A room of the kernels, compiled once for each instruction set: see ../kernels.inl.

/// Up to sixteen fragments that follow each other.
struct FragmentLanes {
  using Lane = std::array<std::int32_t, 16>;
  alignas(64) Lane place;  ///< pixel of the bin's memory
  alignas(64) Lane depth;  ///< code
  alignas(64) Lane color;  ///< packed in the policy's format
};

/// IsLess: the test that nearly every scene has, known when compiled. Otherwise it is the state's.
template <bool IsLess>
struct OpaqueFragments {
  static constexpr bool kIsOpaque = true, kIsLess = IsLess;

  HALFPLANE_INLINE static DepthFunc func(const SliceState& state) {
    return IsLess ? DepthFunc::less : state.depth_test;
  }

  HALFPLANE_INLINE static I16 passes(const SliceState& state, const I16& depth, const I16& stored) {
    switch (func(state)) {
      case DepthFunc::less: return depth < stored;
      case DepthFunc::lequal: return depth <= stored;
      case DepthFunc::greater: return depth > stored;
      case DepthFunc::gequal: return depth >= stored;
      case DepthFunc::equal: return depth == stored;
      case DepthFunc::notequal: return depth != stored;
      case DepthFunc::always: return I16(-1);
      default: return I16(0);
    }
  }

  /// The same for one fragment.
  HALFPLANE_INLINE static bool passes_one(const SliceState& state, std::int32_t depth, std::int32_t stored) {
    return depth_passes(func(state), static_cast<std::uint32_t>(depth), static_cast<std::uint32_t>(stored));
  }

  /// Whether no depth in [record.z_low, record.z_high] passes against one in [low, high].
  HALFPLANE_INLINE static bool is_behind(const SliceState& state, const Record& record, std::int32_t low,
                                         std::int32_t high) {
    switch (func(state)) {
      case DepthFunc::less: return record.z_low >= high;
      case DepthFunc::lequal: return record.z_low > high;
      case DepthFunc::greater: return record.z_high <= low;
      case DepthFunc::gequal: return record.z_high < low;
      case DepthFunc::equal: return record.z_low > high || record.z_high < low;
      case DepthFunc::never: return true;
      default: return false;
    }
  }

  /// Tiles with depths in [low, high] where no fragment in [z_low, z_high] passes, and tiles where all do.
  HALFPLANE_INLINE static void compare_ranges(const SliceState& state, const I16& z_low, const I16& z_high,
                                              const I16& low, const I16& high, I16& behind, I16& front) {
    behind = front = I16(0);
    switch (func(state)) {
      case DepthFunc::less: behind = z_low >= high, front = z_high < low; break;
      case DepthFunc::lequal: behind = z_low > high, front = z_high <= low; break;
      case DepthFunc::greater: behind = z_high <= low, front = z_low > high; break;
      case DepthFunc::gequal: behind = z_high < low, front = z_low >= high; break;
      case DepthFunc::equal: behind = (z_low > high) | (z_high < low); break;
      case DepthFunc::notequal: front = (z_low > high) | (z_high < low); break;
      case DepthFunc::always: front = I16(-1); break;
      case DepthFunc::never: behind = I16(-1); break;
    }
  }

  /// Colours are packed before the test.
  HALFPLANE_INLINE static ColorFormat format(const Config& config) { return config.color_format; }

  /// Writes fragments that follow each other. What is stored to memory might change the bin, for all that the compiler
  /// knows: hence copies.
  struct Writer {
    SliceState state;
    std::int32_t* depths;
    std::uint32_t* pixels;

    HALFPLANE_INLINE explicit Writer(Bin& bin)
        : state(bin.state), depths(bin.memory.depth.data()), pixels(bin.memory.color.data()) {}

    /// Tests and writes the first `count`. Returns how many passed. What fails is stored as it was: which do, nobody
    /// can foresee.
    HALFPLANE_INLINE unsigned operator()(const FragmentLanes& fragments, int count) const {
      unsigned passed_pixels = 0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
        const auto to = static_cast<std::size_t>(fragments.place[k]);
        const std::int32_t stored = depths[to], depth = fragments.depth[k];
        const std::uint32_t has_passed = passes_one(state, depth, stored) ? 1U : 0U, mask = 0U - has_passed;
        passed_pixels += has_passed;
        if (state.depth_write) depths[to] = stored ^ ((stored ^ depth) & static_cast<std::int32_t>(mask));
        if (state.color_write) pixels[to] ^= (pixels[to] ^ static_cast<std::uint32_t>(fragments.color[k])) & mask;
      }
      return passed_pixels;
    }
  };
};

struct GeneralFragments {
  static constexpr bool kIsOpaque = false, kIsLess = false;

  /// A colour's codes, R lowest: packed when they are written.
  HALFPLANE_INLINE static ColorFormat format(const Config&) { return ColorFormat::rgba8888; }

  /// Those whose bit is set, one after the other. Returns how many passed.
  HALFPLANE_NOINLINE static unsigned draw_some(Bin& bin, const FragmentLanes& fragments, std::uint32_t covered) {
    unsigned passed = 0;
    for (; covered != 0; covered &= covered - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(covered));
      const auto to = static_cast<std::size_t>(fragments.place[k]);
      const auto depth = static_cast<std::uint32_t>(fragments.depth[k]);
      if (!depth_passes(bin.state.depth_test, depth, static_cast<std::uint32_t>(bin.memory.depth[to]))) continue;
      ++passed;
      if (bin.state.depth_write) bin.memory.depth[to] = fragments.depth[k];
      if (!bin.state.color_write) continue;
      std::array<std::uint8_t, 4> code;
      for (std::size_t c = 0; c < 4; ++c)
        code[c] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(fragments.color[k]) >> 8 * c);
      bin.memory.color[to] = pack_color(bin.config.color_format, code);
    }
    return passed;
  }

  struct Writer {
    Bin& bin;

    HALFPLANE_INLINE explicit Writer(Bin& bin_) : bin(bin_) {}
    HALFPLANE_INLINE unsigned operator()(const FragmentLanes& fragments, int count) const {
      return draw_some(bin, fragments, (1U << count) - 1);
    }
  };
};

inline void count_fragments(Bin& bin, std::uint64_t covered, std::uint64_t passed) {
  Counters& counters = bin.job.counters;
  counters.covered += covered;
  counters.depth_passed += passed;
  if (bin.state.depth_write || bin.state.color_write) counters.written += passed;
  if (bin.skip.fragments_early_z) counters.skipped.fragments_early_z += covered - passed;
}
