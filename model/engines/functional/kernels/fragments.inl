// What a draw needs of its fragments, as a policy: a type whose functions compare, and say what may be left out.
//
//   opaque   what passes replaces what is stored, what fails leaves no trace. So a tile that lies behind may be left
//            out, one in front may be taken whole, and blocks are drawn lane by lane.
//   general  anything else: fragment by fragment through the scalar operations, out of line, nothing left out.
//
// A room of the kernels, compiled once for each instruction set: see ../kernels.inl.

/// IsLess: the test that nearly every scene has, known when compiled. Otherwise it is the state's.
template <bool IsLess>
struct OpaqueFragments {
  static constexpr bool kIsOpaque = true, kIsLess = IsLess;

  HALFPLANE_INLINE static DepthFunc func(const FragmentState& state) {
    return IsLess ? DepthFunc::less : state.depth_test;
  }

  HALFPLANE_INLINE static I16 passes(const FragmentState& state, const I16& depth, const I16& stored) {
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
  HALFPLANE_INLINE static bool passes_one(const FragmentState& state, std::int32_t depth, std::int32_t stored) {
    return depth_passes(func(state), static_cast<std::uint32_t>(depth), static_cast<std::uint32_t>(stored));
  }

  /// Whether no depth in [record.z_low, record.z_high] passes against one in [low, high].
  HALFPLANE_INLINE static bool is_behind(const FragmentState& state, const Record& record, std::int32_t low,
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
  HALFPLANE_INLINE static void compare_ranges(const FragmentState& state, const I16& z_low, const I16& z_high,
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
};

inline void count_fragments(Bin& bin, std::uint64_t covered, std::uint64_t passed) {
  Counters& counters = bin.job.counters;
  counters.covered += covered;
  counters.depth_passed += passed;
  if (bin.state.depth_write || bin.state.color_write) counters.written += passed;
  if (bin.skip.fragments_early_z) counters.skipped.fragments_early_z += covered - passed;
}
