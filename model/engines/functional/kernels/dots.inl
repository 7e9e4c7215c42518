// Points of one pixel, sixteen at a time: the pixels of smooth lines. One after the other in program order, without tests of
// whole tiles, as lines are.
#pragma once

#include "bin.inl"
#include "fragments.inl"
#include "lines.inl"
#include "operations.inl"
#include "tile_memory.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

HALFPLANE_INLINE bool is_dot(const Bin& bin, const Slice& slice, const Record& record) {
  return record.kind() == RecordKind::rectangle && record.left_top == record.right_bottom && bin.samples == 1 &&
         !slice.state.has_surface;
}

/// Whether dots may be operated on in lanes, where no two of them are at one pixel.
HALFPLANE_INLINE bool takes_dots_in_lanes(const Bin& bin) {
  const FragmentOps& ops = *bin.ops;
  return !ops.stencil && ops.alpha.func == DepthFunc::always && !ops.state.depth_write && ops.state.color_write;
}

/// The first `count` of such fragments; returns how many passed.
HALFPLANE_INLINE unsigned operate_on_dots(Bin& bin, const FragmentLanes& group, int count) {
  const ColorOps& ops = bin.ops->color;
  const ColorFormat format = bin.config.color_format;
  const DepthFunc func = bin.state.depth_test;
  const DepthPixels depths(bin);
  std::uint32_t* const pixels = bin.memory.color.data();
  alignas(64) FragmentLanes::Lane color{};
  std::uint32_t passed = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const auto at = static_cast<std::size_t>(group.place[k]);
    const bool passes =
        depth_passes(func, static_cast<std::uint32_t>(group.depth[k]), static_cast<std::uint32_t>(depths.at(at)));
    passed |= (passes ? 1U : 0U) << k;
    color[k] = static_cast<std::int32_t>(pixels[at]);
  }
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

/// Pixels that have been seen, by the lower bits of their places in the bin.
struct SeenPixels {
  static constexpr int kBits = 1024;
  std::array<std::uint64_t, kBits / 64> word{};
  /// Whether none of these bits has been added before.
  HALFPLANE_INLINE bool add(int x, int y) {
    const int bit = ((y & 31) << 5) | (x & 31);
    std::uint64_t& of = word[static_cast<std::size_t>(bit >> 6)];
    const std::uint64_t mask = std::uint64_t{1} << (bit & 63);
    return (std::exchange(of, of | mask) & mask) == 0;
  }
};

/// Draws dots from `first` up to the first record that is none, which is returned.
template <class Fragments>
HALFPLANE_NOINLINE const std::uint32_t* draw_dots(Bin& bin, const Slice& slice, const std::uint32_t* first,
                                                  const std::uint32_t* last) {
  const Packing packing = Fragments::packing(bin);
  const typename Fragments::Writer write(bin);
  std::uint64_t dots = 0, passed = 0, tiles = 0;
  alignas(64) FragmentLanes::Lane x{}, y{}, rgba{};
  FragmentLanes group;
  const bool is_in_lanes = !Fragments::kIsOpaque && takes_dots_in_lanes(bin),
             are_apart = is_in_lanes || Fragments::kIsOpaque;
  while (first != last && is_dot(bin, slice, slice.records[*first])) {
    int count = 0;
    SeenPixels seen;
    for (; count < 16 && first != last && is_dot(bin, slice, slice.records[*first]); ++first, ++count) {
      const auto lane = static_cast<std::size_t>(count);
      const Record& record = slice.records[*first];
      const VertexRow& v = slice.vertices[record.v[0]];
      x[lane] = record.left() - bin.first_x;
      y[lane] = record.top() - bin.first_y;
      if (are_apart && !seen.add(x[lane], y[lane])) break;
      group.depth[lane] = static_cast<std::int32_t>(v.z);
      rgba[lane] = static_cast<std::int32_t>(v.rgba);
    }
    const I16 at = place_of(I16::load(x.data()), I16::load(y.data()));
    at.store(group.place.data());
    packed_at(at, I16::load(rgba.data()), packing).store(group.color.data());
    const std::uint64_t touched = or_of_bits(I16(1), at >> 6, (1U << count) - 1);
    tiles |= touched;
    if ((touched & ~bin.line_tiles) != 0) touch_line_tiles<Fragments>(bin, touched & ~bin.line_tiles);
    passed += is_in_lanes ? operate_on_dots(bin, group, count) : write(group, count);
    dots += static_cast<unsigned>(count);
  }
  bin.job.counters.tiles_visited += static_cast<unsigned>(std::popcount(tiles));
  count_fragments(bin, dots, passed);
  return first;
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
