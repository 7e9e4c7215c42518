// Points of one pixel, sixteen at a time: the pixels of smooth lines. One after the other in program order, without tests of
// whole tiles, as lines are.
#pragma once

#include "bin.inl"
#include "fragments.inl"
#include "lines.inl"
#include "tile_memory.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

HALFPLANE_INLINE bool is_dot(const Bin& bin, const Slice& slice, const Record& record) {
  return record.kind() == RecordKind::rectangle && record.left_top == record.right_bottom && bin.samples == 1 &&
         !slice.state.has_surface;
}

/// Draws dots from `first` up to the first record that is none, which is returned.
template <class Fragments>
HALFPLANE_NOINLINE const std::uint32_t* draw_dots(Bin& bin, const Slice& slice, const std::uint32_t* first,
                                                  const std::uint32_t* last) {
  const ColorFormat format = Fragments::format(bin.config);
  const typename Fragments::Writer write(bin);
  std::uint64_t dots = 0, passed = 0, tiles = 0;
  alignas(64) FragmentLanes::Lane x{}, y{}, rgba{};
  FragmentLanes group;
  while (first != last && is_dot(bin, slice, slice.records[*first])) {
    int count = 0;
    for (; count < 16 && first != last && is_dot(bin, slice, slice.records[*first]); ++first, ++count) {
      const auto lane = static_cast<std::size_t>(count);
      const Record& record = slice.records[*first];
      const VertexRow& v = slice.vertices[record.v[0]];
      x[lane] = record.left() - bin.first_x;
      y[lane] = record.top() - bin.first_y;
      group.depth[lane] = static_cast<std::int32_t>(v.z);
      rgba[lane] = static_cast<std::int32_t>(v.rgba);
    }
    const I16 at = place_of(I16::load(x.data()), I16::load(y.data()));
    at.store(group.place.data());
    packed(I16::load(rgba.data()), format).store(group.color.data());
    const std::uint64_t touched = or_of_bits(I16(1), at >> 6, (1U << count) - 1);
    tiles |= touched;
    if ((touched & ~bin.line_tiles) != 0) touch_line_tiles<Fragments>(bin, touched & ~bin.line_tiles);
    passed += write(group, count);
    dots += static_cast<unsigned>(count);
  }
  bin.job.counters.tiles_visited += static_cast<unsigned>(std::popcount(tiles));
  count_fragments(bin, dots, passed);
  return first;
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
