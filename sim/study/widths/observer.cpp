#include "sim/study/widths/observer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/stages/fine_raster.hpp"
#include "model/stages/interpolate.hpp"
#include "model/stages/line_raster.hpp"
#include "model/stages/tile_walk.hpp"

namespace halfplane {
namespace {

constexpr std::array kByConstruction{&Widths::primitive_id,
                                     &Widths::slot,
                                     &Widths::stored_color,
                                     &Widths::stored_depth,
                                     &Widths::kind,
                                     &Widths::flag,
                                     &Widths::depth_func,
                                     &Widths::cull_mode,
                                     &Widths::hiz_code,
                                     &Widths::hiz_update,
                                     &Widths::tile_plane,
                                     &Widths::memory_lane,
                                     &Widths::counter,
                                     &Widths::depth_source,
                                     &Widths::run,
                                     &Widths::address,
                                     &Widths::row_stride,
                                     &Widths::burst_length,
                                     &Widths::port_strobe,
                                     &Widths::port_byte,
                                     &Widths::coordinate_shift,
                                     &Widths::coordinate_reach,
                                     &Widths::color_shift,
                                     &Widths::color_reach,
                                     &Widths::coordinate_reference,
                                     &Widths::written_color,
                                     &Widths::shaded_color,
                                     &Widths::texture_byte,
                                     &Widths::texture_beats};

void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(std::string("the width observer and the stage disagree: ") + what);
}

/// A plane of `bits` bits at a covered sample: the wrap window begins half the range of the codes below 0.
std::int64_t decoded(std::uint64_t residue, int bits) {
  const std::uint64_t below = std::uint64_t{1} << (bits - 2);
  return static_cast<std::int64_t>(wrap_unsigned(residue + below, bits)) - static_cast<std::int64_t>(below);
}

/// A coordinate of a line that runs against its axis, reversed as in line_setup.
std::int64_t turned_pixel(std::int64_t pixel, bool is_negative) { return is_negative ? ~pixel : pixel; }

constexpr int kWalkedPixels = 256;

}  // namespace

Interval value_range(const Width& width, const Widths& widths, const Config& config) {
  const auto codes = [&](int code_bits) {
    const int fraction = width.bits - code_bits - 1;
    // Storage is not included: the rest of the bound below 1/2 is the datapath's own.
    const auto error = static_cast<int128>(std::ceil(std::ldexp(depth_error_bound(config) - 0.5, fraction)));
    return Interval{-error, (((int128{1} << code_bits) - 1) << fraction) + error};
  };
  for (const AttributeWidths& attribute : widths.attribute)
    if (&width == &attribute.plane || &width == &attribute.local) return codes(attribute.code.bits);
  return width.range;
}

WidthObserver::WidthObserver(const Config& config)
    : config_(config),
      widths_(derive_widths(config)),
      target_{0, 0, config.target_width - 1, config.target_height - 1},
      all_(widths_.all()),
      is_observed_(all_.size(), true),
      seen_(all_.size()) {
  for (std::size_t i = 0; i < all_.size(); ++i) place_.emplace_back(all_[i], i);
  for (int a = 0; a < widths_.attributes.attributes; ++a) {  // the same width under another name
    const AttributeWidths& w = widths_.attribute[static_cast<std::size_t>(a)];
    const auto place = [this](const Width& width) {
      return static_cast<std::size_t>(std::find(all_.begin(), all_.end(), &width) - all_.begin());
    };
    const bool is_affine = w.affine_code.bits != 0;
    if (is_affine) place_.emplace_back(&w.affine_code, place(w.code));
    place_.emplace_back(&w.fragment, place(is_affine ? w.code : w.local));
  }
  std::sort(place_.begin(), place_.end());
  for (const auto member : kByConstruction) is_observed_[place_of(widths_.*member)] = false;
  for (const UnitValue& value : kUnitValues) is_observed_[place_of(widths_.*value.width)] = false;
  for (int a = 0; a < widths_.attributes.attributes; ++a) {  // planes over w: not in probes
    const AttributeWidths& w = widths_.attribute[static_cast<std::size_t>(a)];
    if (w.affine_code.bits != 0) continue;
    for (const auto member :
         {&AttributeWidths::code, &AttributeWidths::delta, &AttributeWidths::numerator, &AttributeWidths::reciprocal,
          &AttributeWidths::product, &AttributeWidths::plane, &AttributeWidths::local})
      is_observed_[place_of(w.*member)] = false;
  }
}

std::size_t WidthObserver::place_of(const Width& width) const {
  return std::lower_bound(place_.begin(), place_.end(), std::pair<const Width*, std::size_t>(&width, 0))->second;
}

void WidthObserver::see(const Width& width, int128 value) { seen_[place_of(width)].add(value); }

template <class Packet>
void WidthObserver::see_packet(const Packet& packet) {
  for_each_value(packet, widths_, [&](const auto& value, const Width& width) {
    if (width.is_modular) return;
    const std::size_t place = place_of(width);
    if (!is_observed_[place]) return;
    const std::uint64_t bits = to_bits(value);
    seen_[place].add(width.is_signed ? int128{static_cast<std::int64_t>(bits)} : static_cast<int128>(bits));
  });
}

void WidthObserver::clear() { std::fill(seen_.begin(), seen_.end(), Seen{}); }

void WidthObserver::observe(const Probe& probe) {
  if (probe.is_line)
    observe_line(probe);
  else
    observe_triangle(probe.v);
}

// ----------------------------------------------------------------------------------------------------------- triangles

struct WidthObserver::TriangleStages {
  TrianglePacket packet;
  TriangleSetup setup;  // input of interpolate_at()
  SetupPacket setup_packet;
  ContextPacket context;
  EdgeContext edges;
};

void WidthObserver::observe_triangle(const std::array<SnappedVertex, 3>& v) {
  PrimitivePacket primitive;
  set_vertices(primitive.vertex, v);
  primitive.box = to_box(target_);
  see_packet(primitive);
  observe_area(v);
  CounterPacket counters;
  const auto kept = cull(primitive, widths_, counters);
  if (!kept) return;
  TriangleStages stages{*kept, setup_primitive(*kept, config_, widths_), setup_packet(*kept, config_, widths_), {}, {}};
  stages.context = make_context(stages.setup_packet, widths_);
  stages.edges = make_edge_context(stages.setup_packet);
  see_packet(stages.packet);
  see_packet(stages.setup_packet);
  see_packet(stages.context);
  see_packet(stages.edges);
  observe_edges(stages.packet);
  observe_planes(stages);

  // The tiles of the corners and vertices, and tiles in which an edge crosses a border or a middle line of the box.
  const auto& box = stages.packet.box;
  const int to_pixel = widths_.grid_bits, to_tile = widths_.tile_shift;
  const std::array<int, 3> columns{box.left, (box.left + box.right) / 2, box.right},
      rows{box.top, (box.top + box.bottom) / 2, box.bottom};
  std::vector<std::pair<int, int>> tiles;  // (y, x)
  const auto add = [&](double x, double y) {
    const int pixel_x = static_cast<int>(std::clamp<double>(x, box.left, box.right)),
              pixel_y = static_cast<int>(std::clamp<double>(y, box.top, box.bottom));
    tiles.emplace_back(pixel_y >> to_tile, pixel_x >> to_tile);
  };
  for (const int y : {rows.front(), rows.back()})
    for (const int x : {columns.front(), columns.back()}) add(x, y);
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = std::ldexp(v[i].x, -to_pixel), y = std::ldexp(v[i].y, -to_pixel);
    const double dx = std::ldexp(v[(i + 1) % 3].x, -to_pixel) - x, dy = std::ldexp(v[(i + 1) % 3].y, -to_pixel) - y;
    add(x, y);
    for (std::size_t k = 0; k < 3; ++k) {
      if (dy != 0) add(x + dx / dy * (rows[k] + 0.5 - y), rows[k]);
      if (dx != 0) add(columns[k], y + dy / dx * (columns[k] + 0.5 - x));
    }
  }
  std::sort(tiles.begin(), tiles.end());
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
  for (const auto& [y, x] : tiles) observe_tile(stages, x, y);
}

void WidthObserver::observe_area(const std::array<SnappedVertex, 3>& v) {
  const int128 ax = int128{v[1].x} - v[0].x, ay = int128{v[1].y} - v[0].y;
  const int128 bx = int128{v[2].x} - v[0].x, by = int128{v[2].y} - v[0].y;
  for (const int128 delta : {ax, ay, bx, by}) see(widths_.delta, delta);
  for (const int128 product : {ax * by, ay * bx}) see(widths_.edge_product, product);
  const int128 area = ax * by - ay * bx;
  see(widths_.area, area < 0 ? -area : area);
  require(area == signed_area(v[0], v[1], v[2]), "area");
}

/// cull: the edge functions at the first pixel of the first tile.
void WidthObserver::observe_edges(const TrianglePacket& packet) {
  const auto v = to_snapped(packet.vertex);
  const int s = widths_.grid_bits, shift = widths_.tile_shift;
  const auto centre = [&](int pixel) { return (int128{pixel >> shift << shift} << s) + (int128{1} << (s - 1)); };
  for (std::size_t i = 0; i < 3; ++i) {
    const SnappedVertex &from = v[i], &to = v[(i + 1) % 3];
    const int128 dx = int128{to.x} - from.x, dy = int128{to.y} - from.y;
    const int128 px = centre(packet.box.left) - from.x, py = centre(packet.box.top) - from.y;
    for (const int128 delta : {px, py}) see(widths_.delta, delta);
    for (const int128 product : {dx * py, dy * px}) see(widths_.edge_product, product);
    const int bias = is_top_left(from, to) ? 0 : 1;
    require((dx * py - dy * px - bias) >> s == packet.edge_value[i], "edge value");
  }
}

/// triangle_setup: numerators and their products with the reciprocal.
void WidthObserver::observe_planes(const TriangleStages& stages) {
  const auto v = to_snapped(stages.packet.vertex);
  const int128 ax = int128{v[1].x} - v[0].x, ay = int128{v[1].y} - v[0].y;
  const int128 bx = int128{v[2].x} - v[0].x, by = int128{v[2].y} - v[0].y;
  const Reciprocal widest = reciprocal(stages.setup.area, widths_.reciprocal_bits());
  see(widths_.reciprocal, static_cast<int128>(widest.value));
  see(widths_.reciprocal_shift, widest.shift);
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths_.affine_planes); ++p) {
    const AttributeWidths& widths = widths_.of_plane(p);
    const Plane& result = stages.setup.plane[p];
    const Reciprocal r = reciprocal(stages.setup.area, widths.reciprocal_bits());
    see(widths.reciprocal, static_cast<int128>(r.value));
    const int128 ac = int128{v[1].code[p]} - v[0].code[p], bc = int128{v[2].code[p]} - v[0].code[p];
    for (const int128 delta : {ac, bc}) see(widths.delta, delta);
    const std::array<int128, 2> numerators{ac * by - bc * ay, ax * bc - bx * ac};
    const std::array<std::int64_t, 2> steps{result.step_x, result.step_y};
    for (std::size_t i = 0; i < 2; ++i) {
      const int128 value = numerators[i] * static_cast<int128>(r.value);
      see(widths.numerator, numerators[i]);
      see(widths.product, value);
      const auto step = static_cast<std::int64_t>(round_shift(value, r.shift - widths_.plane_fraction));
      require(wrap_signed(step, widths.plane.bits) == steps[i], "gradient");
    }
  }
}

/// coarse_raster and fine_raster.
void WidthObserver::observe_tile(const TriangleStages& stages, int tile_x, int tile_y) {
  const EdgeValues edges = edges_at_tile(stages.setup_packet, tile_x, tile_y, widths_);
  for (const EdgeValue value : edges) see(widths_.edge_value, value);
  if (classify(stages.setup, edges, config_.tile_size) == TileClass::outside) return;
  const TilePacket tile = make_tile_packet(stages.setup_packet, tile_x, tile_y, 0, false, widths_);
  see_packet(tile);
  const int last = config_.tile_size - 1;
  for (std::size_t i = 0; i < 3; ++i)
    for (const int y : {0, last})
      for (const int x : {0, last})
        see(widths_.sample_edge,
            int128{tile.edge_value[i]} + int128{x} * stages.edges.step_x[i] + int128{y} * stages.edges.step_y[i]);
  StampPacket first, newest;  // stamps with coverage: the extremes of every field are among them
  fine_raster(tile, stages.edges, widths_, [&](const StampPacket& stamp) {
    if (!stamp.mask.any()) return;
    if (!first.mask.any()) first = stamp;
    newest = stamp;
  });
  if (!first.mask.any()) return;
  observe_stamp(stages, first);
  if (newest.stamp != first.stamp) observe_stamp(stages, newest);
}

/// interpolate.
void WidthObserver::observe_stamp(const TriangleStages& stages, const StampPacket& stamp) {
  see_packet(stamp);
  const FragmentPacket fragment = interpolate(stamp, stages.context, widths_);
  see_packet(fragment);
  const int first = stamp.mask.first(), last = stamp.mask.last();
  observe_sample(stages, fragment, static_cast<std::size_t>(first));
  if (last != first) observe_sample(stages, fragment, static_cast<std::size_t>(last));
}

/// The planes at a covered sample, before rounding and clamp.
void WidthObserver::observe_sample(const TriangleStages& stages, const FragmentPacket& fragment, std::size_t sample) {
  const int shift = widths_.tile_shift;
  const PixelOffset origin = widths_.stamps.origin_of(fragment.stamp),
                    pixel_offset = widths_.stamps.pixel_of(static_cast<int>(sample));
  const int x = (fragment.key.tile_x << shift) + origin.x + pixel_offset.x;
  const int y = (fragment.key.tile_y << shift) + origin.y + pixel_offset.y;
  const TriangleSetup& setup = stages.setup;
  const Interpolated at = interpolate_at(setup, widths_, x, y);
  require(at.code == fragment.code[sample], "codes at a sample");
  const auto subpixels = [&](int pixel, int box) {  // from the anchor of the first tile
    const int anchor = (box >> shift << shift) + config_.tile_size / 2;
    return static_cast<std::uint64_t>(std::int64_t{pixel - anchor} << widths_.grid_bits);
  };
  const std::uint64_t dx = subpixels(x, setup.left), dy = subpixels(y, setup.top);
  const auto wide = [&](const Plane& plane, int bits) {
    return decoded(static_cast<std::uint64_t>(plane.value) + static_cast<std::uint64_t>(plane.step_x) * dx +
                       static_cast<std::uint64_t>(plane.step_y) * dy,
                   bits);
  };
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths_.affine_planes); ++p) {
    const AttributeWidths& widths = widths_.of_plane(p);
    see(widths.plane, wide(setup.plane[p], widths.plane.bits));
    see(widths.local, at.unrounded[p]);
  }
  int128 color = 0;  // rop's input: the codes side by side
  for (int c = widths_.color_planes - 1; c >= 0; --c)
    color = color << widths_.color().code.bits | at.code[kColorPlane + static_cast<std::size_t>(c)];
  see(widths_.vertex_color, color);
}

// --------------------------------------------------------------------------------------------------------------- lines

void WidthObserver::observe_line(const Probe& probe) {
  for (std::size_t i = 0; i < 2; ++i) {
    for (const std::int32_t v : {probe.v[i].x, probe.v[i].y}) see(widths_.coordinate, v);
    for (std::size_t p = 0; p < static_cast<std::size_t>(widths_.affine_planes); ++p)
      see(widths_.of_plane(p).code, probe.v[i].code[p]);
  }
  // No clipping here: the pixels covered by a line in the guard band lie at most one outside it.
  const int edge = config_.guard_band + 2;
  const PixelBounds everything{-edge, -edge, edge, edge};
  for (const bool is_whole : {true, false}) {
    const auto line = setup_line(probe.v[0], probe.v[1], probe.rule, false, is_whole ? everything : target_, widths_);
    if (!line) continue;
    observe_positions(probe, *line, is_whole);
    if (is_whole) continue;
    see_packet(*line);
    observe_attributes(probe, *line);
    observe_pixels(*line);
  }
}

namespace {

/// The ends of a line along one axis of its octant, reversed as in line_setup.
struct Ends {
  std::int64_t from, to;
};

Ends ends_of(std::int32_t from, std::int32_t to, bool is_negative, LineRule rule, int s) {
  const auto at = [&](std::int32_t v) -> std::int64_t {  // the textbooks' rules begin at the pixel's centre
    const std::int64_t end = rule == LineRule::diamond ? v : (std::int64_t{v >> s} << s) + (std::int64_t{1} << (s - 1));
    return is_negative ? -end : end;
  };
  return {at(from), at(to)};
}

}  // namespace

/// The position along the minor axis at the first and the last pixel; for a whole line, its inputs.
void WidthObserver::observe_positions(const Probe& probe, const LineSetup& line, bool is_whole) {
  const int s = widths_.grid_bits;
  const bool x_major = line.is_x_major, x_negative = line.is_x_negative, y_negative = line.is_y_negative;
  const Ends x = ends_of(probe.v[0].x, probe.v[1].x, x_negative, probe.rule, s),
             y = ends_of(probe.v[0].y, probe.v[1].y, y_negative, probe.rule, s);
  const Ends &a = x_major ? x : y, &b = x_major ? y : x;
  const int128 d = line.step_stay, D = d - line.step_move;
  require(d == b.to - b.from && D == std::max<std::int64_t>(a.to - a.from, 1), "line deltas");
  const std::int64_t column = x_major ? turned_pixel(line.x, x_negative) : turned_pixel(line.y, y_negative);
  const std::int64_t row =
      (x_major ? turned_pixel(line.y, y_negative) : turned_pixel(line.x, x_negative)) - (b.from >> s);
  const int128 position = row * D + line.error - d + D;
  see(widths_.line_position, position);
  see(widths_.line_position, position + d * line.remaining);
  if (!is_whole) return;
  const int128 pixel = int128{1} << s, offset = (int128{column} << s) + pixel / 2 - a.from;
  const int128 numerator = (int128{b.from} & (pixel - 1)) * D + d * offset;
  const bool moves = numerator >> s == position;  // a tie; without one the bias has no effect
  require(moves || (numerator - 1) >> s == position, "line position");
  see(widths_.line_numerator, numerator - (moves ? 0 : 1));
}

void WidthObserver::observe_attributes(const Probe& probe, const LineSetup& line) {
  const bool x_major = line.is_x_major, is_negative = x_major ? line.is_x_negative : line.is_y_negative;
  const auto along = [x_major](const SnappedVertex& v) { return x_major ? v.x : v.y; };
  const Ends a = ends_of(along(probe.v[0]), along(probe.v[1]), is_negative, probe.rule, widths_.grid_bits);
  const Reciprocal r = reciprocal(a.to - a.from, widths_.reciprocal_bits());
  see(widths_.reciprocal, static_cast<int128>(r.value));
  see(widths_.reciprocal_shift, r.shift);
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths_.affine_planes); ++p) {
    const int128 delta = int128{probe.v[1].code[p]} - probe.v[0].code[p],
                 product = delta * static_cast<int128>(r.value);
    see(widths_.of_plane(p).delta, delta);
    see(widths_.line_product, product);
    const int128 step = round_shift(product, r.shift - widths_.grid_bits - widths_.line_guard_bits);
    require(wrap_unsigned(static_cast<std::uint64_t>(step), widths_.of_plane(p).line.bits) == line.step[p],
            "line step");
  }
}

void WidthObserver::observe_pixels(const LineSetup& line) {
  const auto pixel = [&](const LineState& state) {
    see(widths_.line_error, state.error);
    see(widths_.line_count, state.remaining);
    see_packet(pixel_of(state, line, widths_));
    if (state.is_before_start) return;  // it shows the start's codes
    for (std::size_t p = 0; p < static_cast<std::size_t>(widths_.affine_planes); ++p)
      see(widths_.of_plane(p).line, static_cast<int128>(state.value[p]));
  };
  LineState state = first_state(line);
  pixel(state);
  for (int i = 1; i < kWalkedPixels && state.remaining != 0; ++i) {
    advance(state, line, widths_);
    pixel(state);
  }
  if (state.remaining == 0) return;
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths_.affine_planes); ++p) {
    const Width& width = widths_.of_plane(p).line;
    see(width, static_cast<int128>(wrap_unsigned(state.value[p] + state.remaining * line.step[p], width.bits)));
  }
}

}  // namespace halfplane
