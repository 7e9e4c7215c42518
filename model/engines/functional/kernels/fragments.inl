// The depth test as a policy: a type that compares depths with the stored ones, and says which tiles may be skipped.
//
//   opaque   a passing fragment replaces the stored values, a failing one has no effect. So a hidden tile may be
//   skipped,
//            a tile in front may be taken as a whole, and blocks are drawn lane by lane.
//   general  any other state: fragment by fragment through the scalar operations, out of line, nothing skipped
//            (general.inl). Blending, masks and the alpha test of triangles are in lanes too (operations.inl).
#pragma once

#include "bin.inl"
#include "tile_memory.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Counts fragments that have passed the depth test and fail the alpha test.
inline void count_killed(Bin& bin, std::uint64_t killed) {
  bin.job.counters.alpha_killed += killed;
  if (bin.ops->state.writes()) bin.job.counters.written -= killed;
}

/// Up to sixteen consecutive fragments.
struct FragmentLanes {
  using Lane = std::array<std::int32_t, 16>;
  alignas(64) Lane place;  ///< pixel of the bin's memory
  alignas(64) Lane depth;  ///< code
  alignas(64) Lane color;  ///< packed in the policy's format
};

/// Ranges of the bin's tiles, and a bit each for their comparison with another range. Ranges with dropped bits that
/// touch may overlap.
struct RangeLanes {
  const Bin& bin;

  HALFPLANE_INLINE explicit RangeLanes(const Bin& bin_) : bin(bin_) {}
  HALFPLANE_INLINE U64 low() const { return U64::load(bin.tile_low); }
  HALFPLANE_INLINE U64 high() const { return U64::load(bin.tile_high); }
  HALFPLANE_INLINE static std::uint64_t is_above(const U64& a, const U64& b) { return ~bits_at_least(b, a); }
  HALFPLANE_INLINE std::uint64_t is_at_least(const U64& a, const U64& b) const {
    return bin.range_bits_dropped == 0 ? bits_at_least(a, b) : is_above(a, b);
  }
};

/// IsLess: the most common test, known at compile time. Otherwise the test is the state's.
template <bool IsLess>
struct OpaqueFragments {
  static constexpr bool kIsOpaque = true, kIsLess = IsLess;

  HALFPLANE_INLINE static DepthFunc func(const SliceState& state) {
    return IsLess ? DepthFunc::less : state.depth_test;
  }

  /// A mask. `Lanes`: I16 or U64.
  template <class Lanes>
  HALFPLANE_INLINE static auto passes(const SliceState& state, const Lanes& depth, const Lanes& stored) {
    using Mask = decltype(depth < stored);
    switch (func(state)) {
      case DepthFunc::less: return depth < stored;
      case DepthFunc::lequal: return depth <= stored;
      case DepthFunc::greater: return depth > stored;
      case DepthFunc::gequal: return depth >= stored;
      case DepthFunc::equal: return depth == stored;
      case DepthFunc::notequal: return depth != stored;
      case DepthFunc::always: return Mask(-1);
      default: return Mask(0);
    }
  }

  /// The same for one fragment.
  HALFPLANE_INLINE static bool passes_one(const SliceState& state, std::int32_t depth, std::int32_t stored) {
    return depth_passes(func(state), static_cast<std::uint32_t>(depth), static_cast<std::uint32_t>(stored));
  }

  /// Whether no depth in `range` passes against one in the bin.
  HALFPLANE_INLINE static bool is_behind(const Bin& bin, const DepthRange& range) {
    const std::int32_t touch = bin.range_bits_dropped != 0 ? 1 : 0;
    switch (func(bin.state)) {
      case DepthFunc::less: return range.low >= bin.high + touch;
      case DepthFunc::lequal: return range.low > bin.high;
      case DepthFunc::greater: return range.high + touch <= bin.low;
      case DepthFunc::gequal: return range.high < bin.low;
      case DepthFunc::equal: return range.low > bin.high || range.high < bin.low;
      case DepthFunc::never: return true;
      default: return false;
    }
  }

  /// Compares fragments in [depths.low(), depths.high()] with the bin's tiles, a lane per tile: tiles where none
  /// passes.
  template <class Depths>
  HALFPLANE_INLINE static std::uint64_t tiles_behind(const Bin& bin, const Depths& depths) {
    const RangeLanes tile(bin);
    switch (func(bin.state)) {
      case DepthFunc::less: return tile.is_at_least(depths.low(), tile.high());
      case DepthFunc::lequal: return tile.is_above(depths.low(), tile.high());
      case DepthFunc::greater: return tile.is_at_least(tile.low(), depths.high());
      case DepthFunc::gequal: return tile.is_above(tile.low(), depths.high());
      case DepthFunc::equal: return tile.is_above(depths.low(), tile.high()) | tile.is_above(tile.low(), depths.high());
      case DepthFunc::never: return ~std::uint64_t{0};
      default: return 0;
    }
  }

  /// Tiles where all pass.
  template <class Depths>
  HALFPLANE_INLINE static std::uint64_t tiles_in_front(const Bin& bin, const Depths& depths) {
    const RangeLanes tile(bin);
    switch (func(bin.state)) {
      case DepthFunc::less: return tile.is_above(tile.low(), depths.high());
      case DepthFunc::lequal: return tile.is_at_least(tile.low(), depths.high());
      case DepthFunc::greater: return tile.is_above(depths.low(), tile.high());
      case DepthFunc::gequal: return tile.is_at_least(depths.low(), tile.high());
      case DepthFunc::notequal:
        return tile.is_above(depths.low(), tile.high()) | tile.is_above(tile.low(), depths.high());
      case DepthFunc::always: return ~std::uint64_t{0};
      default: return 0;
    }
  }

  /// Colours are packed before the test.
  HALFPLANE_INLINE static Packing packing(const Bin& bin) { return bin.packing; }

  /// Writes consecutive fragments. The compiler must assume that stores change the bin: hence copies.
  struct Writer {
    SliceState state;
    DepthPixels depths;
    std::uint32_t* pixels;

    HALFPLANE_INLINE explicit Writer(Bin& bin) : state(bin.state), depths(bin), pixels(bin.memory.color.data()) {}

    /// Tests and writes the first `count`; returns how many passed.
    HALFPLANE_INLINE unsigned operator()(const FragmentLanes& fragments, int count) const {
      return depths.is_narrow ? write(depths.narrow, fragments, count) : write(depths.wide, fragments, count);
    }

   private:
    /// All tests, then the writes of those that pass: a branch for each test would be mispredicted. Places differ.
    template <class Code>
    HALFPLANE_INLINE unsigned write(Code* codes, const FragmentLanes& fragments, int count) const {
      const auto place = [&fragments](std::size_t k)
                             HALFPLANE_LAMBDA { return static_cast<std::uint32_t>(fragments.place[k]); };
      std::uint32_t passed = 0;
      for (int i = count - 1; i >= 0; --i) {
        const auto k = static_cast<std::size_t>(i);
        const auto stored = static_cast<std::uint32_t>(codes[place(k)]);
        const bool passes = depth_passes(func(state), static_cast<std::uint32_t>(fragments.depth[k]), stored);
        passed = passed + passed + (passes ? 1U : 0U);
      }
      for (std::uint32_t left = passed; left != 0; left &= left - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(left));
        if (state.depth_write) codes[place(k)] = static_cast<Code>(fragments.depth[k]);
        if (state.color_write) pixels[place(k)] = static_cast<std::uint32_t>(fragments.color[k]);
      }
      return static_cast<unsigned>(std::popcount(passed));
    }
  };
};

struct GeneralFragments {
  static constexpr bool kIsOpaque = false, kIsLess = false;

  /// A colour's codes, R lowest: packed when they are written.
  HALFPLANE_INLINE static Packing packing(const Bin&) { return kUnpacked; }

  /// Draws the fragments whose bit is set, one after the other. Returns the number that passed.
  HALFPLANE_NOINLINE static unsigned draw_some(Bin& bin, const FragmentLanes& fragments, std::uint32_t covered) {
    const DepthPixels depths(bin);
    unsigned passed = 0, killed = 0;
    for (; covered != 0; covered &= covered - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(covered));
      const auto to = static_cast<std::size_t>(fragments.place[k]);
      const auto [x, y] = pixel_of(fragments.place[k]);
      auto depth = static_cast<std::uint32_t>(depths.at(to));
      const StoredPixel stored{depth, bin.memory.color[to],
                               bin.job.target.stencil[bin.job.target.at(bin.first_x + x, bin.first_y + y)]};
      const TestedFragment fragment{static_cast<std::uint32_t>(fragments.depth[k]), bin.first_x + x, bin.first_y + y,
                                    bin.is_back};
      const auto color = [&] {
        std::array<std::uint32_t, 4> code;
        for (std::size_t c = 0; c < 4; ++c) code[c] = static_cast<std::uint32_t>(fragments.color[k]) >> 8 * c & 255;
        return code;
      };
      const Fate fate = apply_fragment(*bin.ops, bin.config.color_format, fragment, color, stored);
      depths.set(to, static_cast<std::int32_t>(depth));
      passed += fate != Fate::failed ? 1 : 0;
      killed += fate == Fate::killed ? 1 : 0;
    }
    count_killed(bin, killed);
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
  if (bin.ops->state.writes()) counters.written += passed;
  if (bin.skip.fragments_early_z) counters.skipped.fragments_early_z += covered - passed;
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
