// Building a slice: its vertices, its records, its bin lists.
#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include "../../draw_states.hpp"
#include "../../host/smooth_raster.hpp"
#include "../../packets/packet_words.hpp"
#include "frame_renderer.hpp"

namespace halfplane::functional {
namespace {

constexpr std::size_t kPadding = 16;  // kernels write whole rows of lanes

Record record_of(const std::array<std::uint32_t, 3>& v, std::int64_t z_low, std::int64_t z_high, const PixelBounds& box,
                 RecordKind kind) {
  Record record;
  record.v = v;
  record.z_low = static_cast<std::int32_t>(z_low);
  record.z_high = static_cast<std::int32_t>(z_high);
  const auto place = [](int x, int y) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(y) << 16) | (x & 0xffff);
  };
  record.left_top = place(box.left, box.top);
  record.right_bottom = place(box.right, box.bottom);
  record.traits = static_cast<std::int32_t>(kind);
  return record;
}

/// Appends; Slice::records may be longer than its content.
inline void add_record(Slice& slice, const Record& record, std::size_t room) {
  if (slice.records.size() < slice.record_count + 1 + room) slice.records.resize(2 * (slice.record_count + 1 + room));
  slice.records[slice.record_count++] = record;
}

/// Appends the attributes over w of a triangle's vertices, before the vertices. The scene's own attributes are copied first.
void add_surface_vertices(Slice& slice, const Triangle& triangle) {
  const bool is_lit = slice.normals != nullptr;
  if (slice.surface != slice.own_surface.data()) {
    slice.own_surface.assign(slice.surface, slice.surface + slice.vertices.size());
    if (is_lit) slice.own_normals.assign(slice.normals, slice.normals + slice.vertices.size());
  }
  for (const SurfaceVertex& v : triangle.surface) {
    slice.own_surface.push_back(surface_row(v.w, v.u, v.v));
    if (is_lit) slice.own_normals.push_back(v.normal);
  }
  slice.surface = slice.own_surface.data();
  if (is_lit) slice.normals = slice.own_normals.data();
}

/// Appends a triangle of the host side, if its box may contain a sample.
void add_triangle(Slice& slice, const Triangle& triangle, const Rect& rect, const Widths& widths, std::size_t room) {
  const PixelBounds box = sample_bounds(triangle.v, {rect.x, rect.y, rect.x + rect.width - 1, rect.y + rect.height - 1},
                                        widths.grid_bits, widths.pixel_samples);
  if (box.is_empty()) return;
  if (slice.state.has_surface) add_surface_vertices(slice, triangle);
  const auto first = static_cast<std::uint32_t>(slice.vertices.size());
  for (const SnappedVertex& v : triangle.v) slice.vertices.push_back(row_of(v));
  const auto [low, high] = std::minmax({triangle.v[0].depth(), triangle.v[1].depth(), triangle.v[2].depth()});
  add_record(slice, record_of({first, first + 1, first + 2}, low, high, box, RecordKind::triangle), room);
}

/// A triangle that needs the clipper, or with a refused vertex: drawn by the host side's function, message included.
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
  for (const Triangle& piece : pieces)
    add_triangle(slice, piece, context.rect, frame.widths, slice.triangles + kPadding);
}

/// Finds the attributes over w of a slice's vertices.
void find_surface_vertices(const FrameContext& frame, Slice& slice) {
  const PreparedScene& prepared = frame.prepared;
  const bool is_lit = slice.context->phong != nullptr;
  slice.own_surface.clear();
  slice.own_normals.clear();
  slice.surface = prepared.surface.data() + slice.low_index;
  slice.normals = is_lit ? prepared.normals.data() + slice.low_index : nullptr;
  if (!slice.is_wide) return;
  for (const Slice::Part& part : slice.parts)
    for (std::size_t t = part.first; t < part.first + part.count; ++t)
      for (const auto& corner : prepared.index) {
        slice.own_surface.push_back(prepared.surface[corner[t]]);
        if (is_lit) slice.own_normals.push_back(prepared.normals[corner[t]]);
      }
  slice.own_surface.resize(slice.vertices.size());
  slice.surface = slice.own_surface.data();
  if (!is_lit) return;
  slice.own_normals.resize(slice.vertices.size());
  slice.normals = slice.own_normals.data();
}

PixelBounds line_box(const LineSetup& line) {
  const std::int64_t D = line.step_stay - line.step_move, n = line.remaining;
  const auto moved = static_cast<int>(n == 0 || D == 0 ? 0 : (line.error + (n - 1) * line.step_stay + D) / D);
  const int along = static_cast<int>(n);
  const int dx = line.is_x_major != 0 ? along : moved, dy = line.is_x_major != 0 ? moved : along;
  const int end_x = line.x + (line.is_x_negative != 0 ? -dx : dx),
            end_y = line.y + (line.is_y_negative != 0 ? -dy : dy);
  return {std::min(line.x, end_x), std::min(line.y, end_y), std::max(line.x, end_x), std::max(line.y, end_y)};
}

/// Whether a draw's primitives are drawn as dots: smooth ones, and small points.
bool are_all_dots(const DrawContext& context, const Widths& widths) {
  if (widths.has_samples != 0) return false;
  if (is_smooth(context.state, context.config)) return true;
  return drawn_as(context.state, context.draw.topology) == PrimitiveType::point && are_dots(context.state, widths);
}

/// Finds the dots of a slice of points, whose vertices are projected.
void find_dots(const FrameContext& frame, Slice& slice, Outline& outline) {
  const DrawContext& context = *slice.context;
  const Scene& scene = frame.prepared.scene();
  const Rect& rect = context.rect;
  const PixelBounds limit{rect.x, rect.y, rect.x + rect.width - 1, rect.y + rect.height - 1};
  const int grid_bits = frame.widths.grid_bits;
  const double pixel = static_cast<double>(std::int64_t{1} << grid_bits);
  const auto size = static_cast<std::int32_t>(snap(context.state.point_size, pixel));
  const std::uint32_t outside = context.state.point_clip == PointClip::center ? Slice::kVolume : 0;
  std::size_t number = 0;
  SnappedVertex place;
  for (const Slice::Part& part : slice.parts) {
    std::optional<DrawContext> of_part;
    for (std::size_t i = part.first; i < part.first + part.count; ++i, ++number) {
      const std::uint32_t index = frame.prepared.index[0][i];
      const std::size_t at = slice.is_wide ? 3 * number : index - slice.low_index;
      const std::uint32_t code = slice.any_code == 0 ? 0 : slice.codes[at];
      if ((code & Slice::kSlow) != 0) {  // outside the guard band, or refused
        if (!of_part) of_part.emplace(scene, frame.config, std::get<Draw>(scene.commands[part.command]), part.command);
        VertexCache cache(0);
        geometry(*of_part, frame.widths, cache, {PrimitiveType::point, {index, index, index}},
                 part.primitive + static_cast<std::uint32_t>(i - part.first), slice.counters, outline);
        continue;
      }
      const VertexRow& v = slice.vertices[at];
      place.x = v.x;
      place.y = v.y;
      const PixelBounds box = point_bounds(place, size, limit, grid_bits);
      const bool is_drawn = !box.is_empty() && (code & outside) == 0;
      if (is_drawn) add_dots(box, {0, 0, v.z, v.rgba}, outline.dots);
      ++slice.counters.primitives_in;
      ++(is_drawn ? slice.counters.drawn : slice.counters.culled);
      slice.counters.skipped.empty += is_drawn ? 0 : 1;
    }
  }
}

/// Appends a line or point of the host side.
void add_outline(Slice& slice, const Outline& outline, const Rect& rect, const Config& config, const Widths& widths,
                 std::size_t room) {
  for (const Triangle& triangle : outline.triangles) add_triangle(slice, triangle, rect, widths, room);
  for (const LinePrimitive& line : outline.lines) {
    const auto [low, high] = std::minmax({line.drawn.start.depth(), line.drawn.end.depth()});
    if (lanes_hold_lines(config, widths)) {
      const auto at = static_cast<std::uint32_t>(slice.vertices.size());
      add_record(slice, record_of({at, at + 1, at}, low, high, line_box(line.setup), RecordKind::whole_line), room);
      for (const SnappedVertex& end : {line.drawn.start, line.drawn.end}) slice.vertices.push_back(row_of(end));
    } else {
      const auto at = static_cast<std::uint32_t>(slice.lines.size());
      add_record(slice, record_of({at, 0, 0}, low, high, line_box(line.setup), RecordKind::cut_line), room);
      slice.lines.push_back(line.setup);
    }
  }
  const std::size_t most = slice.record_count + outline.points.size() + room;
  if (slice.records.size() < most) slice.records.resize(2 * most);
  for (const PointPrimitive& point : outline.points) {
    const auto at = static_cast<std::uint32_t>(slice.vertices.size());
    slice.vertices.push_back(row_of(point.drawn.at));
    const std::uint32_t z = point.drawn.at.depth();
    for_each_run(point, widths.grid_bits, [&](const PixelBounds& box) {
      add_record(slice, record_of({at, at, at}, z, z, box, RecordKind::rectangle), room);
    });
  }
}

/// A line that the scissor or the clipper cuts, or with a refused vertex.
void draw_line_slowly(const FrameContext& frame, Slice& slice, const Slice::Part& part, std::size_t line) {
  const Scene& scene = frame.prepared.scene();
  const DrawContext context(scene, frame.config, std::get<Draw>(scene.commands[part.command]), part.command);
  VertexCache cache(0);
  Outline outline;
  const std::size_t at = part.first + line;
  const std::uint32_t start = frame.prepared.index[0][at], end = frame.prepared.index[1][at];
  geometry(context, frame.widths, cache, {PrimitiveType::line, {start, end, end}},
           part.primitive + static_cast<std::uint32_t>(line), slice.counters, outline);
  add_outline(slice, outline, context.rect, frame.config, frame.widths, slice.triangles);
}

}  // namespace

void FrameRenderer::build(Slice& slice) const {
  slice.record_count = 0;
  slice.lines.clear();
  if (!slice.outlines.empty()) {
    slice.vertices.clear();
    build_outlines(slice);
  } else {
    const FrameContext frame{*prepared_, config_, widths_, skip_, bins_x_, !is_opaque_};
    const std::size_t range = std::size_t{slice.high_index} - slice.low_index + 1, corners = 3 * slice.triangles;
    slice.is_wide = range > corners;
    const std::size_t vertices = slice.is_wide ? corners : range;
    slice.vertices.resize(vertices + kPadding);
    slice.codes.resize(vertices + kPadding);
    if (slice.state.has_surface) find_surface_vertices(frame, slice);
    if (slice.records.size() < slice.triangles + kPadding) slice.records.resize(slice.triangles + kPadding);
    // Polygon offset is a property of the triangle, not of vertices.
    if (slice.has_dots) {
      kernels_->project(frame, slice);
      static thread_local Outline outline;
      outline.clear();
      outline.keeps_dots = true;
      find_dots(frame, slice, outline);
      fill_bins(slice, outline.dots);
    } else if (!slice.is_lines && slice.context->state.polygon_offset != std::array<double, 2>{0.0, 0.0}) {
      for (const Slice::Part& part : slice.parts)
        for (std::size_t i = 0; i < part.count; ++i) draw_slowly(frame, slice, part, i);
    } else {
      kernels_->project(frame, slice);
      slice.is_lines ? kernels_->cull_lines(frame, slice, draw_line_slowly) : kernels_->cull(frame, slice, draw_slowly);
    }
  }
  if (!slice.has_dots) fill_bins(slice);
  if (compares_) sign(slice);
}

/// Everything that the pixels of each record depend on, except the clears below it.
void FrameRenderer::sign(Slice& slice) const {
  const State& state = slice.context->state;
  SignatureHash of_state;
  of_state.add(signature_of(state));
  if (state.texture) of_state.add(texels_[*state.texture]);
  slice.state_signature = of_state.signature();
  slice.signatures.resize(slice.record_count);
  const auto pair = [](auto low, auto high) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(high)) << 32 | static_cast<std::uint32_t>(low);
  };
  for (std::size_t i = 0; i < slice.record_count; ++i) {
    const Record& record = slice.records[i];
    SignatureHash hash;
    hash.add(pair(record.left_top, record.right_bottom));
    hash.add(pair(record.z_low, record.z_high));
    hash.add(static_cast<std::uint32_t>(record.traits));
    if (record.kind() == RecordKind::cut_line) {
      LineSetup line = slice.lines[record.v[0]];
      line.primitive_id = 0;
      for_each_value(std::as_const(line), widths_,
                     [&hash](const auto& value, const Width&) { hash.add(to_bits(value)); });
    } else {
      for (const std::uint32_t v : record.v) {
        const VertexRow& row = slice.vertices[v];
        hash.add(pair(row.x, row.y));
        hash.add(pair(row.z, row.rgba));
        if (!slice.state.has_surface) continue;
        const SurfaceRow& surface = slice.surface[v];
        for (const double value : {surface.w, surface.u, surface.v}) hash.add(std::bit_cast<std::uint64_t>(value));
        if (slice.normals == nullptr) continue;
        const Normal& normal = slice.normals[v];
        hash.add(pair(normal[0], normal[1]));
        hash.add(static_cast<std::uint32_t>(normal[2]));
      }
    }
    slice.signatures[i] = hash.signature();
  }
}

void FrameRenderer::build_outlines(Slice& slice) const {
  const DrawContext& context = *slice.context;
  VertexCache cache(0);
  static thread_local Outline outline;
  outline.clear();
  outline.keeps_dots = are_all_dots(context, widths_);
  outline.smooth_lanes = kernels_->smooth_coverage;
  slice.state.is_flat = false;  // the vertices have the colour of the provoking one
  slice.is_lines = !outline.keeps_dots;
  std::uint32_t number = slice.parts.front().primitive;
  for (const AssembledPrimitive& assembled : slice.outlines) {
    geometry(context, widths_, cache, assembled, number++, slice.counters, outline);
    if (outline.keeps_dots) continue;
    slice.is_lines &= outline.triangles.empty() && outline.points.empty();
    add_outline(slice, outline, context.rect, config_, widths_, 0);
    outline.clear();
  }
  slice.has_dots = outline.keeps_dots;
  if (slice.has_dots) fill_bins(slice, outline.dots);
}

/// The same as for records: a counting sort of runs.
void FrameRenderer::fill_bins(Slice& slice, std::span<const Dot> dots) const {
  const auto bins = static_cast<std::size_t>(bins_x_) * static_cast<std::size_t>(bins_y_);
  const auto for_each_run =
      [&](auto&& visit) {  // visit(bin, dots): a counter for each dot would wait for the store before
        for (std::size_t first = 0, end; first < dots.size(); first = end) {
          const int x = dots[first].x >> kBinShift, y = dots[first].y >> kBinShift;
          for (end = first + 1; end < dots.size() && dots[end].x >> kBinShift == x && dots[end].y >> kBinShift == y;)
            ++end;
          visit(static_cast<std::size_t>(y * bins_x_ + x), dots.subspan(first, end - first));
        }
      };
  slice.bin_first.assign(bins + 1, 0);
  std::uint32_t* const first = slice.bin_first.data();
  for_each_run([&](std::size_t bin, auto run) { first[bin + 1] += static_cast<std::uint32_t>(run.size()); });
  for (std::size_t bin = 0; bin < bins; ++bin) first[bin + 1] += first[bin];
  slice.dots.resize(dots.size());
  static thread_local std::vector<std::uint32_t> next;
  next.assign(first, first + bins);
  for_each_run([&](std::size_t bin, auto run) {
    std::ranges::copy(run, slice.dots.begin() + next[bin]);
    next[bin] += static_cast<std::uint32_t>(run.size());
  });
}

/// The records of each bin, in order: a counting sort of runs. Most records lie in one bin, that of the record before.
void FrameRenderer::fill_bins(Slice& slice) const {
  struct Run {  // records that follow each other in a bin, or one record in bins side by side
    std::uint32_t bin, bins, first, end;
  };
  const auto bins = static_cast<std::size_t>(bins_x_) * static_cast<std::size_t>(bins_y_);
  static thread_local std::vector<std::uint32_t> next;
  static thread_local std::vector<Run> runs;
  next.assign(bins, 0);
  const std::span records(slice.records.data(), slice.record_count);
  // At most a run for each record, and more where it lies in several rows of bins.
  runs.resize(std::max(runs.size(), records.size() + 1));
  Run* run = runs.data();
  std::size_t count = 0;  // and run[0] is unused
  const auto bin_at = [in_row = bins_x_](int x, int y) {
    return static_cast<std::uint32_t>((y >> kBinShift) * in_row + (x >> kBinShift));
  };
  constexpr std::uint32_t kNone = ~0U;
  std::uint32_t in_run = kNone, run_first = 0;  // in registers: memory would be read back at once
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Record& record = records[i];
    const auto number = static_cast<std::uint32_t>(i);
    const std::uint32_t first = bin_at(record.left(), record.top());
    constexpr auto kInBin = static_cast<std::int32_t>((kBinSize - 1) * 0x10001);
    if (((record.left_top ^ record.right_bottom) & ~kInBin) == 0) {
      const bool is_new = first != in_run;
      count += is_new ? 1 : 0;
      run_first = is_new ? number : run_first;
      in_run = first;
      run[count] = {first, 1, run_first, number + 1};
      continue;
    }
    in_run = kNone;
    const std::uint32_t last = bin_at(record.left(), record.bottom()),
                        columns = bin_at(record.right(), record.top()) - first + 1;
    if (const std::size_t room = count + bins + records.size() - i; runs.size() <= room) {
      runs.resize(2 * room);
      run = runs.data();
    }
    for (std::uint32_t bin = first; bin <= last; bin += static_cast<std::uint32_t>(bins_x_))
      run[++count] = {bin, columns, number, number + 1};
  }
  const std::span all(run + 1, count);
  std::uint32_t* const in_bin = next.data();
  for (const Run& one : all)
    for (std::uint32_t bin = one.bin; bin < one.bin + one.bins; ++bin) in_bin[bin] += one.end - one.first;
  slice.bin_first.resize(bins + 1);
  std::uint32_t sum = 0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    slice.bin_first[bin] = sum;
    sum += std::exchange(next[bin], sum);
  }
  slice.bin_first[bins] = sum;
  slice.bin_records.resize(sum);
  std::uint32_t* const listed = slice.bin_records.data();
  for (const Run& one : all) {
    const std::uint32_t length = one.end - one.first;
    if (length == 1) {
      for (std::uint32_t bin = one.bin; bin < one.bin + one.bins; ++bin) listed[in_bin[bin]++] = one.first;
      continue;
    }
    std::uint32_t* const to = listed + in_bin[one.bin];
    in_bin[one.bin] += length;
    for (std::uint32_t i = 0; i < length; ++i) to[i] = one.first + i;
  }
}

}  // namespace halfplane::functional
