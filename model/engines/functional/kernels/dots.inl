// Points of one pixel, sixteen at a time: the pixels of smooth lines and points, and of square points up to kLargestDots wide.
// In program order, without tests of whole tiles, as lines are.
#pragma once

#include "bin.inl"
#include "fragments.inl"
#include "operations.inl"
#include "tile_memory.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Whether dots may be operated on in lanes, where no two of them are at one pixel.
HALFPLANE_INLINE bool takes_dots_in_lanes(const Bin& bin) {
  const FragmentOps& ops = *bin.ops;
  return !ops.stencil && ops.alpha.func == DepthFunc::always && ops.state.color_write;
}

/// Whether such dots look at stored depths, or write them.
HALFPLANE_INLINE bool sees_depth(const Bin& bin) {
  return bin.state.depth_test != DepthFunc::always || bin.state.depth_write;
}

/// The depth test of the first `count` fragments, and its writes: those that pass, a bit each.
HALFPLANE_INLINE std::uint32_t passing_dots(Bin& bin, const FragmentLanes& group, int count) {
  const DepthFunc func = bin.state.depth_test;
  const DepthPixels depths(bin);
  std::uint32_t passed = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const auto stored = static_cast<std::uint32_t>(depths.at(static_cast<std::size_t>(group.place[k])));
    passed |= (depth_passes(func, static_cast<std::uint32_t>(group.depth[k]), stored) ? 1U : 0U) << k;
  }
  for (std::uint32_t left = bin.state.depth_write ? passed : 0; left != 0; left &= left - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(left));
    depths.set(static_cast<std::size_t>(group.place[k]), group.depth[k]);
  }
  return passed;
}

/// The first `count` of such fragments; returns how many passed.
HALFPLANE_INLINE unsigned operate_on_dots(Bin& bin, const FragmentLanes& group, int count) {
  const ColorOps& ops = bin.ops->color;
  const ColorFormat format = bin.config.color_format;
  std::uint32_t* const pixels = bin.memory.color.data();
  alignas(64) FragmentLanes::Lane color{};
  std::uint32_t passed = (1U << count) - 1;
  if (sees_depth(bin)) passed = passing_dots(bin, group, count);
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
    color[k] = static_cast<std::int32_t>(pixels[static_cast<std::size_t>(group.place[k])]);
  const I16 stored = I16::load(color.data());
  const ColorPairs source(I16::load(group.color.data()));
  const ColorPairs mixed =
      ops.blends() ? BlendLanes(ops, source, widened(stored, format))(format == ColorFormat::rgba8888) : source;
  const auto written = static_cast<std::int32_t>(written_bits(ops, format));
  I16 code = packed(mixed.red_blue, mixed.green_alpha, bin.packing, thresholds_at(I16::load(group.place.data())));
  if (ops.logic != LogicOp::copy) code = LogicLanes(ops.logic)(code, stored);
  ((code & written) | (stored & ~written)).store(color.data());
  for (std::uint32_t left = passed; left != 0; left &= left - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(left));
    pixels[static_cast<std::size_t>(group.place[k])] = static_cast<std::uint32_t>(color[k]);
  }
  return static_cast<unsigned>(std::popcount(passed));
}

/// The number of lanes, of the first `most`, before one at the pixel of a lane before it.
HALFPLANE_INLINE int apart(const I16& x, const I16& y, int most) {
  constexpr std::size_t kWords = 16;  // of 64 bits: by the lower bits of both coordinates
  const I16 bit = ((y & 31) << 5) | (x & 31);
  alignas(64) FragmentLanes::Lane bits;
  bit.store(bits.data());
  std::array<std::uint64_t, kWords> seen{};
  for (int i = 0; i < most; ++i) {
    const auto at = static_cast<unsigned>(bits[static_cast<std::size_t>(i)]);
    std::uint64_t& word = seen[at >> 6];
    const std::uint64_t mask = std::uint64_t{1} << (at & 63);
    if ((std::exchange(word, word | mask) & mask) != 0) return i;
  }
  return most;
}

/// Brings tiles of dots to memory: their depths where they are read or written.
template <class Fragments>
HALFPLANE_NOINLINE void touch_tiles_of_dots(Bin& bin, std::uint64_t tiles, bool reads_depths) {
  for (; tiles != 0; tiles &= tiles - 1) {
    const int tile = std::countr_zero(tiles);
    if (reads_depths) need_depth(bin, tile);
    if (bin.state.color_write) need_color(bin, tile);
    if (bin.state.depth_write) forget_range<Fragments>(bin, tile);
  }
  bin.is_range_old = true;
}

/// Draws dots of one slice.
template <class Fragments>
HALFPLANE_NOINLINE void draw_dots(Bin& bin, const Dot* first, const Dot* last) {
  const Packing packing = Fragments::packing(bin);
  const typename Fragments::Writer write(bin);
  const auto dots = static_cast<std::uint64_t>(last - first);
  std::uint64_t passed = 0, tiles = 0;
  FragmentLanes group;
  const bool is_in_lanes = !Fragments::kIsOpaque && takes_dots_in_lanes(bin),
             are_apart = is_in_lanes || Fragments::kIsOpaque, reads_depths = !is_in_lanes || sees_depth(bin);
  while (first != last) {
    const auto most = static_cast<int>(std::min<std::ptrdiff_t>(last - first, kBlockPixels));
    const Columns of = turned_rows([&](int i) HALFPLANE_LAMBDA { return first + std::min(i, most - 1); });
    const I16 x = of.first - bin.first_x, y = of.second - bin.first_y, at = place_of(x, y);
    const int count = are_apart ? apart(x, y, most) : most;
    at.store(group.place.data());
    of.third.store(group.depth.data());
    packed_at(at, of.fourth, packing).store(group.color.data());
    const std::uint64_t touched = or_of_bits(I16(1), at >> 6, (1U << count) - 1);
    if ((touched & ~tiles) != 0) touch_tiles_of_dots<Fragments>(bin, touched & ~tiles, reads_depths);
    tiles |= touched;
    passed += is_in_lanes ? operate_on_dots(bin, group, count) : write(group, count);
    first += count;
  }
  bin.job.counters.tiles_visited += static_cast<unsigned>(std::popcount(tiles));
  count_fragments(bin, dots, passed);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
