// Lines, sixteen at a time: stages/line_setup up to the covered columns, and culling.
#pragma once

#include "cull.inl"
#include "lane_memory.inl"
#include "leaf.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// How the lines of a draw end.
struct LineRules {
  bool is_diamond, drops_last;
  int grid_bits;

  LineRules(const State& state, const Widths& widths)
      : is_diamond(state.line_rule == LineRule::diamond),
        drops_last(is_diamond || (state.line_last ? !*state.line_last : drops_last_by_default(state.line_rule))),
        grid_bits(widths.grid_bits) {}
};

/// Sixteen lines, each in its own octant, and the columns [first, end) that they cover: OctantLine and Columns of
/// stages/line_setup. Reversing an axis maps coordinate v to -v, and so pixel i to ~i.
struct OctantLanes {
  I16 is_x_major, is_major_negative, is_minor_negative;
  I16 a0, b0, a1, b1;  ///< subpixels: the start, the end
  I16 major, minor;    ///< from the start to the end, subpixels; major >= 1
  I16 first, end;

  HALFPLANE_INLINE OctantLanes(const I16& from_x, const I16& from_y, const I16& to_x, const I16& to_y,
                               const LineRules& rules) {
    const int s = rules.grid_bits, half = 1 << (s - 1);
    const auto at = [&](const I16& v) HALFPLANE_LAMBDA { return rules.is_diamond ? v : ((v >> s) << s) + half; };
    const I16 x0 = at(from_x), y0 = at(from_y), x1 = at(to_x), y1 = at(to_y);
    is_x_major = magnitude(x1 - x0) >= magnitude(y1 - y0);
    a0 = select(is_x_major, x0, y0);
    a1 = select(is_x_major, x1, y1);
    b0 = select(is_x_major, y0, x0);
    b1 = select(is_x_major, y1, x1);
    is_major_negative = a1 < a0;
    is_minor_negative = b1 < b0;
    a0 = turned(a0, is_major_negative);
    a1 = turned(a1, is_major_negative);
    b0 = turned(b0, is_minor_negative);
    b1 = turned(b1, is_minor_negative);
    major = max(a1 - a0, I16(1));
    minor = b1 - b0;
    if (rules.is_diamond) {
      first = exit_column(a0, b0, s);
      end = exit_column(a1, b1, s);
    } else {
      first = a0 >> s;
      end = (a1 >> s) + (rules.drops_last ? 0 : 1);
    }
  }

  /// Whether a tie between two rows goes to the later one.
  [[nodiscard]] HALFPLANE_INLINE I16 tie_moves(const LineRules& rules) const {
    const I16 of_x_major = rules.is_diamond ? ~is_major_negative & (minor != 0) : is_major_negative;
    return select(is_x_major, of_x_major, is_minor_negative);
  }

 private:
  /// Diamond exit: the first column that a line from (a, b) on would cover.
  [[nodiscard]] HALFPLANE_INLINE I16 exit_column(const I16& a, const I16& b, int s) const {
    const int pixel = 1 << s, half = pixel / 2;
    const I16 column = select(is_major_negative, ((a - half) >> s) + 1, (a + (half - 1)) >> s);
    const I16 u = a - ((column - 1) << s) - half, v = (b & (pixel - 1)) - half, reach = u + magnitude(v);
    const I16 of_y_major = (v == -half) | ((v != 0) & ((v > 0) ^ is_minor_negative));
    const I16 on_border = select(is_x_major, ~is_major_negative, of_y_major);
    return column + ((reach < half) | ((reach == half) & on_border));
  }
};

/// Records of lines that surely have a pixel inside the scissor; the others take the slow path.
static void cull_lines(const FrameContext& frame, Slice& slice, SlowPath slow) {
  const DrawContext& context = *slice.context;
  const Widths& widths = frame.widths;
  const LineRules rules(context.state, widths);
  const int s = rules.grid_bits;
  const Rect& rect = context.rect;
  const PixelBounds limit{rect.x, rect.y, rect.x + rect.width - 1, rect.y + rect.height - 1};
  constexpr int kFromEnd = 3;  // pixels
  const bool fits = lanes_hold_lines(frame.config, widths);
  std::size_t number = 0;
  for (const Slice::Part& part : slice.parts)
    for (std::size_t first = 0; first < part.count; first += 16) {
      const std::size_t count = std::min<std::size_t>(16, part.count - first);
      const std::array<I16, 3> v = corner_lanes(frame, slice, part.first + first, count, number);
      number += count;
      const std::uint32_t lanes = (1U << count) - 1;
      I16 codes(0);
      if (slice.any_code != 0) codes = gather(slice.codes.data(), v[0]) | gather(slice.codes.data(), v[1]);
      std::array<std::array<std::int32_t, 16>, 2> ends;
      for (std::size_t k = 0; k < 2; ++k) v[k].store(ends[k].data());
      const SnappedLanes start = load_rows(slice.vertices.data(), ends[0].data()),
                         end = load_rows(slice.vertices.data(), ends[1].data());
      const OctantLanes line(start.x, start.y, end.x, end.y, rules);
      // In its octant it covers only the rows from one end to the other, and the row before where it starts on a border
      // of rows.
      const auto side = [&](const I16& from, const I16& to, const I16& is_negative, bool is_low)
                            HALFPLANE_LAMBDA { return select(is_negative, is_low ? ~to : ~from, is_low ? from : to); };
      const I16 last = line.end - 1, top_row = (line.b0 >> s) - 1, bottom_row = line.b1 >> s;
      const auto of_major = [&](bool is_low)
                                HALFPLANE_LAMBDA { return side(line.first, last, line.is_major_negative, is_low); };
      const auto of_minor = [&](bool is_low)
                                HALFPLANE_LAMBDA { return side(top_row, bottom_row, line.is_minor_negative, is_low); };
      const I16 left = select(line.is_x_major, of_major(true), of_minor(true)),
                right = select(line.is_x_major, of_major(false), of_minor(false)),
                top = select(line.is_x_major, of_minor(true), of_major(true)),
                bottom = select(line.is_x_major, of_minor(false), of_major(false));
      const std::uint32_t covers = bits_of(last >= line.first) & lanes;
      // Or its first or last pixel does, less than kFromEnd pixels from the end.
      const auto is_inside = [&](const SnappedLanes& point) HALFPLANE_LAMBDA {
        const I16 x = point.x >> s, y = point.y >> s;
        return (x > limit.left + kFromEnd) & (x < limit.right - kFromEnd) & (y > limit.top + kFromEnd) &
               (y < limit.bottom - kFromEnd);
      };
      const std::uint32_t is_seen =
          bits_of(is_inside(start) | is_inside(end) |
                  ((left > limit.left) & (right < limit.right) & (top > limit.top) & (bottom < limit.bottom)));
      const std::uint32_t slow_bits =
          (fits ? bits_of((codes & static_cast<int>(Slice::kSlow)) != 0) | (covers & ~is_seen) : 0xffffU) & lanes;
      const std::uint32_t drawn = covers & ~slow_bits;
      const auto counted = [](std::uint32_t bits)
                               HALFPLANE_LAMBDA { return static_cast<unsigned>(std::popcount(bits)); };
      slice.counters.primitives_in += counted(lanes & ~slow_bits);
      slice.counters.drawn += counted(drawn);
      slice.counters.culled += counted(lanes & ~slow_bits & ~drawn);
      slice.counters.skipped.empty += counted(lanes & ~slow_bits & ~drawn);
      alignas(64) std::array<Record, 16> lane;
      std::int32_t* const words = reinterpret_cast<std::int32_t*>(lane.data());
      store_rows({v[0], v[1], v[2], min(start.z, end.z)}, words, sizeof(Record));
      constexpr auto kTraits = static_cast<std::int32_t>(RecordKind::whole_line);
      store_rows({max(start.z, end.z), pairs(max(left, I16(limit.left)), max(top, I16(limit.top))),
                  pairs(min(right, I16(limit.right)), min(bottom, I16(limit.bottom))), I16(kTraits)},
                 words + 4, sizeof(Record));
      for (std::uint32_t rest = drawn | slow_bits; rest != 0; rest &= rest - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(rest));
        if ((slow_bits >> i & 1) != 0)
          slow(frame, slice, part, first + i);
        else
          slice.records[slice.record_count++] = lane[i];
      }
    }
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
