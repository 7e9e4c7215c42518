// How a slice is built: its vertices, its records, its bin lists.
#include <algorithm>

#include "frame_renderer.hpp"

namespace halfplane::functional {
namespace {

Record record_of(const std::array<std::uint32_t, 3>& v, std::int64_t z_low, std::int64_t z_high, const PixelBounds& box,
                 RecordKind kind) {
  Record record;
  record.v = v;
  record.z_low = static_cast<std::int32_t>(z_low);
  record.z_high = static_cast<std::int32_t>(z_high);
  record.left = static_cast<std::int16_t>(box.left);
  record.top = static_cast<std::int16_t>(box.top);
  record.right = static_cast<std::int16_t>(box.right);
  record.bottom = static_cast<std::int16_t>(box.bottom);
  record.kind = kind;
  return record;
}

/// Appends; Slice::records may be longer than it is full.
void add_record(Slice& slice, const Record& record, std::size_t room) {
  if (slice.records.size() < slice.record_count + 1 + room) slice.records.resize(2 * (slice.record_count + 1 + room));
  slice.records[slice.record_count++] = record;
}

/// A triangle that needs the clipper, or whose vertex is refused: the host side's function, message included.
void draw_slowly(const FrameContext& frame, Slice& slice, const Slice::Part& part, std::size_t triangle) {
  const Scene& scene = frame.prepared.scene();
  const DrawContext context(scene, frame.config, std::get<Draw>(scene.commands[part.command]), part.command);
  static thread_local std::vector<Triangle> pieces;
  pieces.clear();
  VertexCache cache(0);
  const auto& index = frame.prepared.index;
  const std::size_t at = part.first + triangle;
  geometry(context, cache, {index[0][at], index[1][at], index[2][at]},
           part.primitive + static_cast<std::uint32_t>(triangle), frame.skip, slice.counters, pieces);
  const Rect& rect = context.rect;
  const PixelBounds limit{rect.x, rect.y, rect.x + rect.width - 1, rect.y + rect.height - 1};
  for (const Triangle& piece : pieces) {
    const PixelBounds box = pixel_bounds(piece.v, limit, frame.widths.grid_bits);
    if (box.is_empty()) continue;
    const auto first = static_cast<std::uint32_t>(slice.vertices.size());
    slice.vertices.insert(slice.vertices.end(), piece.v.begin(), piece.v.end());
    const auto [low, high] = std::minmax({piece.v[0].z, piece.v[1].z, piece.v[2].z});
    add_record(slice, record_of({first, first + 1, first + 2}, low, high, box, RecordKind::triangle), slice.triangles);
  }
}

/// The pixels of a line, as a box.
PixelBounds line_box(const LineSetup& line) {
  const std::int64_t D = line.step_stay - line.step_move, n = line.remaining;
  const auto moved = static_cast<int>(n == 0 || D == 0 ? 0 : (line.error + (n - 1) * line.step_stay + D) / D);
  const int along = static_cast<int>(n);
  const int dx = line.is_x_major != 0 ? along : moved, dy = line.is_x_major != 0 ? moved : along;
  const int end_x = line.x + (line.is_x_negative != 0 ? -dx : dx),
            end_y = line.y + (line.is_y_negative != 0 ? -dy : dy);
  return {std::min(line.x, end_x), std::min(line.y, end_y), std::max(line.x, end_x), std::max(line.y, end_y)};
}

/// Appends what the host side has made of a line or point.
void add_outline(Slice& slice, const Outline& outline, std::size_t room) {
  for (const LinePrimitive& line : outline.lines) {
    const auto [low, high] = std::minmax(line.drawn.start.z, line.drawn.end.z);
    const auto at = static_cast<std::uint32_t>(slice.lines.size());
    add_record(slice, record_of({at, 0, 0}, low, high, line_box(line.setup), RecordKind::cut_line), room);
    slice.lines.push_back(line.setup);
  }
  for (const PointPrimitive& point : outline.points) {
    const auto at = static_cast<std::uint32_t>(slice.vertices.size());
    slice.vertices.push_back(point.drawn.at);
    const std::uint32_t z = point.drawn.at.z;
    add_record(slice, record_of({at, at, at}, z, z, point.box, RecordKind::rectangle), room);
  }
}

/// A line that the scissor or the clipper cuts, or whose vertex is refused.
void draw_line_slowly(const FrameContext& frame, Slice& slice, const Slice::Part& part, std::size_t line) {
  const Scene& scene = frame.prepared.scene();
  const DrawContext context(scene, frame.config, std::get<Draw>(scene.commands[part.command]), part.command);
  VertexCache cache(0);
  Outline outline;
  const std::size_t at = part.first + line;
  const std::uint32_t start = frame.prepared.index[0][at], end = frame.prepared.index[1][at];
  geometry(context, frame.widths, cache, {PrimitiveType::line, {start, end, end}},
           part.primitive + static_cast<std::uint32_t>(line), slice.counters, outline);
  add_outline(slice, outline, slice.triangles);
}

}  // namespace

void FrameRenderer::build(Slice& slice) const {
  slice.record_count = 0;
  slice.lines.clear();
  if (!slice.outlines.empty()) {
    slice.vertices.clear();
    build_outlines(slice);
  } else {
    const FrameContext frame{*prepared_, config_, widths_, skip_, bins_x_, bins_y_};
    const std::size_t range = std::size_t{slice.high_index} - slice.low_index + 1, corners = 3 * slice.triangles;
    slice.is_wide = range > corners;
    const std::size_t vertices = slice.is_wide ? corners : range;
    slice.vertices.resize(vertices + 16);
    slice.codes.resize(vertices + 16);
    if (slice.records.size() < slice.triangles) slice.records.resize(slice.triangles);
    // Polygon offset is a property of the triangle: no vertex has it.
    if (!slice.is_lines && slice.context->state.polygon_offset != std::array<double, 2>{0.0, 0.0}) {
      for (const Slice::Part& part : slice.parts)
        for (std::size_t i = 0; i < part.count; ++i) draw_slowly(frame, slice, part, i);
    } else {
      kernels_->project(frame, slice);
      slice.is_lines ? kernels_->cull_lines(frame, slice, draw_line_slowly) : kernels_->cull(frame, slice, draw_slowly);
    }
  }
  fill_bins(slice);
}

void FrameRenderer::build_outlines(Slice& slice) const {
  const DrawContext& context = *slice.context;
  VertexCache cache(0);
  Outline outline;
  std::uint32_t number = slice.parts.front().primitive;
  for (const AssembledPrimitive& assembled : slice.outlines) {
    outline.lines.clear();
    outline.points.clear();
    geometry(context, widths_, cache, assembled, number++, slice.counters, outline);
    add_outline(slice, outline, 0);
  }
}

/// The records of each bin, in order: a counting sort.
void FrameRenderer::fill_bins(Slice& slice) const {
  const auto bins = static_cast<std::size_t>(bins_x_) * static_cast<std::size_t>(bins_y_);
  slice.bin_first.assign(bins + 1, 0);
  const auto for_each_bin = [this](const Record& record, auto&& visit) {
    const int left = record.left >> kBinShift, right = record.right >> kBinShift;
    const int top = record.top >> kBinShift, bottom = record.bottom >> kBinShift;
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x) visit(static_cast<std::size_t>(y * bins_x_ + x));
  };
  const std::span records(slice.records.data(), slice.record_count);
  for (const Record& record : records) for_each_bin(record, [&](std::size_t bin) { ++slice.bin_first[bin + 1]; });
  for (std::size_t bin = 0; bin < bins; ++bin) slice.bin_first[bin + 1] += slice.bin_first[bin];
  slice.bin_records.resize(slice.bin_first[bins]);
  static thread_local std::vector<std::uint32_t> next;
  next.assign(slice.bin_first.begin(), slice.bin_first.end() - 1);
  for (std::size_t i = 0; i < records.size(); ++i)
    for_each_bin(records[i], [&](std::size_t bin) { slice.bin_records[next[bin]++] = static_cast<std::uint32_t>(i); });
}

}  // namespace halfplane::functional
