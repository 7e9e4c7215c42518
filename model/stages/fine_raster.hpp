// Fine raster: one tile in, the covered samples of its stamps out.
//
// In: a TilePacket and the triangle's EdgeContext. Out: a StampPacket for each stamp with at least one covered sample,
// row by row. Time: docs/pipeline.md. A sample is covered when all three edge values are >= 0 there and it lies in the
// tile's box (which carries the scissor). With several samples per pixel all of them are tested, and the centre too: an
// uncovered centre is not shaded. The last row of stamps ends the visit: its last covered stamp, or, if it has none, an
// empty one at its first column. So the end is known with one row of look-ahead. A packet without a visit passes as an
// empty stamp.
#pragma once

#include "triangle_setup.hpp"

namespace halfplane {

[[nodiscard]] inline EdgeContext make_edge_context(const TriangleSetup& setup) {
  EdgeContext context;
  for (std::size_t i = 0; i < 3; ++i) {
    context.step_x[i] = -setup.edge[i].dy;
    context.step_y[i] = setup.edge[i].dx;
    context.low[i] = setup.edge[i].low;
  }
  return context;
}

[[nodiscard]] inline EdgeContext make_edge_context(const SetupPacket& setup) {
  EdgeContext context;
  for (std::size_t i = 0; i < 3; ++i) {
    context.step_x[i] = -setup.dy[i];
    context.step_y[i] = setup.dx[i];
    context.low[i] = setup.edge_low[i];
  }
  return context;
}

/// The edges of a triangle at one sample position of every pixel: increments from the pixel's centre.
using EdgePlace = EdgeDeltas;

/// The edge values at pixel (x, y) of the tile.
[[nodiscard]] inline EdgeDeltas edges_at(const TilePacket& tile, const EdgeContext& edges, int x, int y) {
  EdgeDeltas value;
  for (std::size_t e = 0; e < 3; ++e) value[e] = tile.edge_value[e] + x * edges.step_x[e] + y * edges.step_y[e];
  return value;
}

/// Whether no edge is negative at a place of the pixel with these edge values: the sign bit of their OR is 0.
[[nodiscard]] constexpr bool is_inside(const EdgeDeltas& edge, const EdgePlace& place) {
  return ((edge[0] + place[0]) | (edge[1] + place[1]) | (edge[2] + place[2])) >= 0;
}

[[nodiscard]] constexpr bool is_in_box(const TilePacket& tile, int x, int y) {
  return x >= tile.box.left && x <= tile.box.right && y >= tile.box.top && y <= tile.box.bottom;
}

/// Whether pixel (x, y) of the tile is covered at one sample position.
[[nodiscard]] inline bool is_covered(const TilePacket& tile, const EdgeContext& edges, const EdgePlace& place, int x,
                                     int y) {
  return is_in_box(tile, x, y) && (tile.is_inside || is_inside(edges_at(tile, edges, x, y), place));
}

/// The edges of a triangle over a stamp: their increments from the centre of its first pixel to each of its samples, and to
/// the centre of each pixel.
class StampEdges {
 public:
  StampEdges(const EdgeContext& edges, const Widths& widths)
      : samples_(static_cast<std::size_t>(widths.samples)), pixels_(static_cast<std::size_t>(widths.pixels)) {
    const StampGrid& stamps = widths.stamps;
    for (std::size_t pixel = 0; pixel < pixels_; ++pixel) {
      const PixelOffset at = stamps.place_of(static_cast<int>(pixel));
      for (std::size_t e = 0; e < 3; ++e) centre_[pixel][e] = at.x * edges.step_x[e] + at.y * edges.step_y[e];
    }
    for (std::size_t s = 0; widths.has_samples != 0 && s < samples_; ++s) {
      const auto pixel = static_cast<std::size_t>(stamps.pixel_number(static_cast<int>(s)));
      const SampleOffset& offset = widths.sample_offset[s & static_cast<std::size_t>(stamps.per_pixel - 1)];
      for (std::size_t e = 0; e < 3; ++e)
        sample_[s][e] =
            centre_[pixel][e] + static_cast<std::int32_t>(sample_edge_offset(
                                    edges.low[e], edges.step_x[e], edges.step_y[e], offset, widths.grid_bits));
    }
  }

  /// The pixels of a stamp whose centre is inside all edges, and its samples that are. `first`: the edge values at its
  /// first pixel. A single sample is the centre.
  [[nodiscard]] SampleMask centres(const EdgeDeltas& first) const { return inside(first, centre_, pixels_); }
  [[nodiscard]] SampleMask samples(const EdgeDeltas& first) const {
    return samples_ == pixels_ ? centres(first) : inside(first, sample_, samples_);
  }

 private:
  using Places = std::array<EdgePlace, kMaxSamples>;
  [[nodiscard]] static SampleMask inside(const EdgeDeltas& first, const Places& places, std::size_t count) {
    std::uint64_t mask = 0;
    for (std::size_t n = 0; n < count; ++n) mask |= std::uint64_t{is_inside(first, places[n])} << n;
    return SampleMask(mask);
  }

  std::size_t samples_, pixels_;
  Places centre_, sample_;  ///< the second with several samples a pixel
};

/// The pixels of a stamp, whose first pixel is `origin` of the tile, that are in the tile's box.
[[nodiscard]] inline SampleMask pixels_in_box(const TilePacket& tile, PixelOffset origin, const StampGrid& stamps) {
  const int last = stamps.size - 1;
  const int left = std::max(tile.box.left - origin.x, 0), right = std::min(tile.box.right - origin.x, last);
  const int top = std::max(tile.box.top - origin.y, 0), bottom = std::min(tile.box.bottom - origin.y, last);
  const std::uint64_t row = SampleMask::all(right - left + 1).bits() << left;
  std::uint64_t mask = 0;
  for (int y = top; y <= bottom; ++y) mask |= row << y * stamps.size;
  return SampleMask(mask);
}

/// Calls visit(stamp, samples, centres) for every stamp of the tile with a covered sample, row by row: its covered samples,
/// and with several samples a pixel the pixels whose centre is covered.
template <class Visit>
void cover_tile(const TilePacket& tile, const EdgeContext& edges, const StampEdges& places, const Widths& widths,
                Visit&& visit) {
  const StampGrid& stamps = widths.stamps;
  const int first = stamps.stamp_at(tile.box.left, tile.box.top),
            last = stamps.stamp_at(tile.box.right, tile.box.bottom);
  for (int row = stamps.row_of(first); row <= stamps.row_of(last); ++row)
    for (int column = stamps.column_of(first); column <= stamps.column_of(last); ++column) {
      const int stamp = stamps.stamp_number(column, row);
      const PixelOffset origin = stamps.origin_of(stamp);
      SampleMask centres = pixels_in_box(tile, origin, stamps), samples = stamps.samples_of(centres);
      if (!tile.is_inside) {
        const EdgeDeltas edge = edges_at(tile, edges, origin.x, origin.y);
        samples = samples & places.samples(edge);
        if (stamps.per_pixel != 1) centres = centres & places.centres(edge);
      }
      if (samples.any()) visit(stamp, samples, stamps.per_pixel != 1 ? centres : SampleMask());
    }
}

/// The fields of a stamp that are its tile's.
[[nodiscard]] inline StampPacket empty_stamp(const TilePacket& tile) {
  StampPacket stamp;
  stamp.kind = tile.kind;
  stamp.key = tile.key;
  stamp.slot = tile.slot;
  stamp.anchor = tile.anchor;
  return stamp;
}

/// Calls emit(StampPacket) for every stamp of the tile that has coverage or ends a visit.
template <class Emit>
void fine_raster(const TilePacket& tile, const EdgeContext& edges, const Widths& widths, Emit&& emit) {
  StampPacket stamp = empty_stamp(tile);
  if (!tile.is_visit) {
    stamp.ends_primitive = tile.ends_primitive;
    emit(stamp);
    return;
  }
  const int last_row = widths.stamps.stamp_at(0, tile.box.bottom);  // its first stamp
  StampPacket held = stamp;                                         // the last covered stamp of the last row so far
  held.stamp = static_cast<std::uint16_t>(last_row);
  cover_tile(tile, edges, StampEdges(edges, widths), widths, [&](int number, SampleMask samples, SampleMask centres) {
    stamp.stamp = static_cast<std::uint16_t>(number);
    stamp.mask = samples;
    stamp.centre = centres;
    const bool is_in_last_row = number >= last_row;
    if (!is_in_last_row) emit(stamp);
    if (is_in_last_row && held.mask.any()) emit(held);
    if (is_in_last_row) held = stamp;
  });
  held.ends_visit = true;
  held.ends_primitive = tile.ends_primitive;
  emit(held);
}

}  // namespace halfplane
