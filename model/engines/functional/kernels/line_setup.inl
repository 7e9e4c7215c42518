// Sixteen lines at a time through line_setup, clipped to the bin: a line a lane.
#pragma once

#include "cull.inl"
#include "cull_lines.inl"
#include "leaf.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Pending lines of a slice, and after set_up_lines() the entry point into the bin and the steps of each.
///
/// Codes are held in the upper bits of a lane: registers then wrap by overflow.
struct LineBatch {
  using Lane = std::array<std::int32_t, 16>;

  int count = 0;
  std::uint32_t cut = 0;                   ///< lines that were set up alone, a bit each
  std::array<std::uint32_t, 16> cut_line;  ///< of those: into Slice::lines
  alignas(64) std::array<Lane, 3> v;       ///< into Slice::vertices: start, end, provoking vertex
  alignas(64) Lane pixels;                 ///< in the bin; none if below 1
  alignas(64) Lane major;                  ///< into LinePositions::place: the first pixel
  alignas(64) Lane minor, minor_step;  ///< position across, below the point kMinorPoint; a step of it, at most a pixel
  alignas(64) Lane is_x_major;         ///< masks: true is -1
  alignas(64) Lane shows_start;
  bool is_long;  ///< 32 bits do not tell the rows of these lines apart: take `row` and `slope`
  alignas(64) std::array<double, 16> row, slope;  ///< rows moved after n pixels: floor(row + n slope)
  alignas(64) std::array<std::int64_t, 16> depth, depth_step;
  alignas(64) std::array<Lane, 4> color, color_step;
  alignas(64) Lane depth_start, color_start;

  /// True if the batch is full now. A cut line's lane is set up by the first vertices, then replaced.
  HALFPLANE_INLINE bool add(const Record& record) {
    const auto i = static_cast<std::size_t>(count);
    const bool is_cut = record.kind() == RecordKind::cut_line;
    if (is_cut) {
      cut |= 1U << i;
      cut_line[i] = record.v[0];
    }
    for (std::size_t k = 0; k < 3; ++k) v[k][i] = is_cut ? 0 : static_cast<std::int32_t>(record.v[k]);
    return ++count == 16;
  }
};

/// floor(numerator / denominator) of integers below 2^53, the quotient in an int32. Rounding never reaches an integer
/// from below: the exact quotient is at least 1 / denominator away.
HALFPLANE_INLINE I16 floor_divide(const D16& numerator, const D16& denominator) {
  const D16 quotient = numerator / denominator;
  const I16 truncated = convert<std::int32_t>(quotient);
  return truncated + convert<std::int32_t>(convert<double>(truncated) > quotient);
}

/// Fraction bits of LineBatch::minor: the pixels of a bin are the upper bits, so that it wraps inside the bin.
inline constexpr int kMinorPoint = 32 - kBinShift;
/// Positions are off by less than 2^-20 after 63 steps, and half a unit, 1 / (2 D), away from every border of pixels. A
/// slope is 0 or at least 1 / D, and D is below 2^26, so that its sign outlives the cut to kMinorPoint bits.
inline constexpr std::int32_t kLongLine = 1 << 18;

/// Places in the bin's memory of the pixels along a line.
struct LinePositions {
  static constexpr int kCourse = kBinSize + 16;  ///< a group that begins at the last pixel reads sixteen
  /// By course: rightwards, leftwards, downwards, upwards.
  alignas(64) std::array<std::int32_t, std::size_t{4} * kCourse> place;

  LinePositions() {
    for (int i = 0; i < 4 * kCourse; ++i) {
      const int along = i % kCourse % kBinSize, course = i / kCourse,
                at = course % 2 != 0 ? kBinSize - 1 - along : along;
      place[static_cast<std::size_t>(i)] =
          course < 2 ? (at & 56) << 3 | (at & 4) << 2 | (at & 3) : (at & 56) << 6 | (at & 4) << 3 | (at & 3) << 2;
    }
  }

  /// Where the course of a line begins. `at`: the first pixel's column or row in the bin.
  template <class Lanes>
  HALFPLANE_INLINE static Lanes first(const Lanes& at, const Lanes& is_x_major, const Lanes& is_negative) {
    return ((at ^ is_negative) & Lanes(kBinSize - 1)) + (is_negative & Lanes(kCourse)) +
           (~is_x_major & Lanes(2 * kCourse));
  }
};

/// The course of sixteen lines in the bin.
struct LineWay {
  I16 offset;  ///< subpixels from the start to the centre of the first column
  I16 low;     ///< the first step in the bin
};

/// Pixels and positions of a batch. `rect`: the scissor.
HALFPLANE_INLINE LineWay set_up_way(LineBatch& batch, const OctantLanes& line, const LineRules& rules, int first_x,
                                    int first_y, const Rect& rect) {
  // Q, as in stages/line_setup: n columns on, the line is in row floor((Q + n d) / D) from the start's.
  const int s = rules.grid_bits, half = 1 << (s - 1);
  const I16 offset = (line.first << s) + half - line.a0, base_row = line.b0 >> s;
  const D16 D = convert<double>(line.major), d = convert<double>(line.minor);
  const L16 numerator = convert<std::int64_t>(line.b0 & ((1 << s) - 1)) * convert<std::int64_t>(line.major) +
                        convert<std::int64_t>(line.minor) * convert<std::int64_t>(offset) +
                        convert<std::int64_t>(~line.tie_moves(rules));
  const D16 Q = convert<double>(numerator >> s);

  // Steps whose column and row lie in the bin and in the scissor.
  struct Range {
    std::int32_t from, to;
  };
  const Range columns{std::max(first_x, rect.x), std::min(first_x + kBinSize, rect.x + rect.width) - 1},
      rows{std::max(first_y, rect.y), std::min(first_y + kBinSize, rect.y + rect.height) - 1};
  const auto range = [](const I16& choose, const Range& a, const Range& b, const I16& is_negative,
                        bool is_low) HALFPLANE_LAMBDA {
    const I16 from = select(choose, I16(a.from), I16(b.from)), to = select(choose, I16(a.to), I16(b.to));
    return select(is_negative, is_low ? ~to : ~from, is_low ? from : to);
  };
  const auto of_major = [&](bool is_low) HALFPLANE_LAMBDA {
    return range(line.is_x_major, columns, rows, line.is_major_negative, is_low);
  };
  const auto of_minor = [&](bool is_low) HALFPLANE_LAMBDA {
    return range(line.is_x_major, rows, columns, line.is_minor_negative, is_low);
  };
  const I16 bin_major = select(line.is_x_major, I16(first_x), I16(first_y)),
            bin_minor = select(line.is_x_major, I16(first_y), I16(first_x));
  I16 low = max(of_major(true) - line.first, I16(0));
  I16 high = min(of_major(false), line.end - 1) - line.first;
  const D16 top = convert<double>(of_minor(true) - base_row), bottom = convert<double>(of_minor(false) - base_row);
  const D16 never(1 << 20), some_d = max(d, D16(1.0));
  const L16 is_level = d == 0.0;
  const D16 missing = top * D - Q;                  // until the first row of the bin
  const D16 room = (bottom + 1.0) * D - (Q + 1.0);  // to its last row
  const D16 enters = select(is_level, never, min((missing + (d - 1.0)) / some_d, never));
  const D16 leaves = select(is_level, never, min(room / some_d, never));
  low = max(low, convert<std::int32_t>(select(missing > 0.0, enters, D16(0.0))));
  high = min(high, convert<std::int32_t>(select(room < 0.0, D16(-1.0), leaves)));
  (high - low + 1).store(batch.pixels.data());

  const D16 steps = convert<double>(low), position = Q + d * steps;
  const I16 moved = floor_divide(position, D);
  const D16 reciprocal_D = 1.0 / D;
  // Half a unit away from every border between rows: far more than the error of these products.
  const D16 row = (position - convert<double>(moved) * D + 0.5) * reciprocal_D, slope = d * reciprocal_D;
  batch.is_long = is_any(line.major >= kLongLine);
  row.store(batch.row.data());
  slope.store(batch.slope.data());
  constexpr double kPixel = 1 << kMinorPoint;
  const I16 &is_minor_negative = line.is_minor_negative, &is_major_negative = line.is_major_negative;
  const auto with_sign = [&](const I16& v) HALFPLANE_LAMBDA { return (v ^ is_minor_negative) - is_minor_negative; };
  const I16 minor = ((base_row + moved) ^ is_minor_negative) - bin_minor;
  (((minor - is_minor_negative) << kMinorPoint) + with_sign(convert<std::int32_t>(row * kPixel)))
      .store(batch.minor.data());
  with_sign(convert<std::int32_t>(slope * kPixel)).store(batch.minor_step.data());
  const I16 major = ((line.first + low) ^ is_major_negative) - bin_major;
  LinePositions::first(major, line.is_x_major, is_major_negative).store(batch.major.data());
  line.is_x_major.store(batch.is_x_major.data());
  ((low == 0) & (offset < 0)).store(batch.shows_start.data());
  return {offset, low};
}

/// Sets up the pending lines. The attributes' arithmetic stays in one function: as functions on a struct it took a
/// tenth more instructions.
HALFPLANE_NOINLINE void set_up_lines(LineBatch& batch, const Slice& slice, const FrameContext& frame, int first_x,
                                     int first_y) {
  const Widths& widths = frame.widths;
  const LineRules rules(slice.context->state, widths);
  for (int i = batch.count; i < 16; ++i)  // unused lanes copy the first
    for (std::size_t k = 0; k < 3; ++k) batch.v[k][static_cast<std::size_t>(i)] = batch.v[k][0];
  const auto fetch = [&](std::size_t k)
                         HALFPLANE_LAMBDA { return load_rows(slice.vertices.data(), batch.v[k].data()); };
  const SnappedLanes start = fetch(0), end = fetch(1);
  const OctantLanes line(start.x, start.y, end.x, end.y, rules);
  const LineWay way = set_up_way(batch, line, rules, first_x, first_y, slice.context->rect);
  ReciprocalLanes reciprocal(quotient_lanes(line.major, widths.reciprocal_bits()), 0);
  reciprocal.value = select(line.a1 == line.a0, I16(0), reciprocal.value);
  const int s = rules.grid_bits, guard_bits = widths.line_guard_bits;
  const GradientLanes gradient(reciprocal.value, reciprocal.shift - (s + guard_bits));
  const L16 to_first = convert<std::int64_t>(way.offset), to_bin = convert<std::int64_t>(way.low);
  const std::int64_t half_code = std::int64_t{1} << (guard_bits - 1), half_step = std::int64_t{1} << (s - 1);
  // Values wrap far above their bits: shifts need no sign. Steps wrap too, except before a shift down: a line shorter
  // than a pixel has steps above the whole range.
  const auto start_of = [&](const I16& from, const L16& moved) HALFPLANE_LAMBDA {
    return (convert<std::int64_t>(from) << guard_bits) + half_code + shift_right_logical(moved + half_step, s);
  };
  struct Narrow {
    I16 value, step;
  };
  const auto narrow_attribute = [&](const I16& from, const I16& to) HALFPLANE_LAMBDA {
    const L16 step64 = gradient(to - from);
    const I16 step = convert<std::int32_t>(step64);
    return Narrow{convert<std::int32_t>(start_of(from, step64 * to_first)) + step * way.low, step};
  };
  const int unused = 64 - widths.depth().line.bits;
  if (unused >= 32) {
    const Narrow z = narrow_attribute(start.z, end.z);
    (convert<std::int64_t>(z.value) << unused).store(batch.depth.data());
    (convert<std::int64_t>(z.step) << unused).store(batch.depth_step.data());
  } else {
    const L16 step = gradient(end.z - start.z);
    ((start_of(start.z, step * to_first) + step * to_bin) << unused).store(batch.depth.data());
    (step << unused).store(batch.depth_step.data());
  }
  start.z.store(batch.depth_start.data());
  if (!slice.state.color_write) return;
  const bool is_flat = slice.state.is_flat;
  const I16 c0 = is_flat ? fetch(2).rgba : start.rgba, c1 = is_flat ? c0 : end.rgba;
  c0.store(batch.color_start.data());
  for (std::size_t c = 0; c < 4; ++c) {
    const int down = static_cast<int>(8 * c);
    const auto code = [down](const I16& rgba) HALFPLANE_LAMBDA { return shift_right_logical(rgba, down) & 255; };
    const Narrow channel = narrow_attribute(code(c0), code(c1));
    (channel.value << (32 - widths.color().line.bits)).store(batch.color[c].data());
    (channel.step << (32 - widths.color().line.bits)).store(batch.color_step[c].data());
  }
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
