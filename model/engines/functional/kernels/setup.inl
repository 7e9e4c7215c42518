// The constants of one triangle in one bin: triangle_setup for a single triangle.
#pragma once

#include "bin.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Constants common to a triangle's planes.
struct PlaneSteps {
  std::int64_t ax, ay, bx, by;  ///< second and third corner from the first
  std::int64_t dx, dy;          ///< from the origin to the anchor of the bin's first tile
  AreaQuotient quotient;
};

/// The factor from numerators to gradients.
struct GradientFactor {
  std::int64_t reciprocal;  ///< reciprocal of the area
  int k;                    ///< bits that a product with the reciprocal drops

  HALFPLANE_INLINE GradientFactor(const AreaQuotient& quotient, const AttributeWidths& attribute,
                                  const Widths& widths) {
    const Reciprocal shortened =
        halfplane::reciprocal(quotient, widths.reciprocal_bits() - attribute.reciprocal_bits());
    reciprocal = static_cast<std::int64_t>(shortened.value);
    k = shortened.shift - widths.plane_fraction;
  }
};

/// The three edges at once: edge_function(), whose values binary64 holds. Inside a bin they change by less than 2^30: a
/// larger value has the same sign everywhere.
HALFPLANE_INLINE void set_up_edges(const Bin& bin, const VertexRow& a, const VertexRow& b, const VertexRow& c,
                                   BinTriangle& out) {
  using Words __attribute__((vector_size(16))) = std::int32_t;
  using Values __attribute__((vector_size(32))) = double;
  const int s = bin.widths.grid_bits, half = 1 << (s - 1);
  const Words x{a.x, b.x, c.x, 0}, y{a.y, b.y, c.y, 0};
  const Words dx = __builtin_shufflevector(x, x, 1, 2, 0, 3) - x, dy = __builtin_shufflevector(y, y, 1, 2, 0, 3) - y;
  const Words px = (bin.first_x << s) + half - x, py = (bin.first_y << s) + half - y;
  const auto value_of = [](const Words& v) HALFPLANE_LAMBDA {
#if HALFPLANE_ISA == 128
    return __builtin_convertvector(v, Values);
#else  // GCC would convert in two halves
    return (Values)_mm256_cvtepi32_pd((__m128i)v);
#endif
  };
  Values value = cross(value_of(dx), value_of(dy), value_of(px), value_of(py)) + value_of(~is_top_left(dx, dy));
  constexpr double kFar = 1 << 30;
  value *= bin.pixel;
  value = value < -kFar ? Values{} - kFar : value;
  value = value > kFar - 1 ? Values{} + (kFar - 1) : value;
  const Words edge = __builtin_convertvector(value + kFar, Words) - (1 << 30);  // floor: truncated above 0
  std::memcpy(out.edge.data(), &edge, sizeof edge);
  std::memcpy(out.dx.data(), &dx, sizeof dx);
  std::memcpy(out.dy.data(), &dy, sizeof dy);
  constexpr int kSteep = ((1 << 15) - 1) / (kTileSize - 1);
  const Words slope = (dx < 0 ? -dx : dx) + (dy < 0 ? -dy : dy);
  out.is_steep = std::max({slope[0], slope[1], slope[2]}) > kSteep;
}

/// The four channels at once.
HALFPLANE_INLINE void set_up_colors(const Bin& bin, const VertexRow& a, const VertexRow& b, const VertexRow& c,
                                    const VertexRow& origin, const PlaneSteps& f, BinTriangle& out) {
  const int s = bin.widths.grid_bits, F = bin.widths.plane_fraction;
  const auto codes = [](const VertexRow& v) HALFPLANE_LAMBDA { return channels_of(v.rgba); };
  const Channels ca = codes(a), cb = bin.state.is_flat ? ca : codes(b), cc = bin.state.is_flat ? ca : codes(c);
  const Channels ab = cb - ca, ac = cc - ca;
  const GradientFactor factor(f.quotient, bin.widths.color(), bin.widths);
  const auto gradient = [R = factor.reciprocal, k = factor.k](const Channels& numerator)
                            HALFPLANE_LAMBDA { return round_shift_channels(numerator * R, k); };
  const auto times = [](const Channels& code, std::int64_t side) HALFPLANE_LAMBDA {  // codes of 9 bits, sides of 24
#if HALFPLANE_ISA == 128
    return code * side;
#else
    return (Channels)_mm256_mul_epi32((__m256i)code, (__m256i)(Channels{} + side));
#endif
  };
  const Channels step_x = gradient(times(ab, f.by) - times(ac, f.ay)),
                 step_y = gradient(times(ac, f.ax) - times(ab, f.bx));
  const Channels at_origin = bin.state.is_flat ? ca : codes(origin);
  store(out.c_anchor,
        (at_origin << F) + step_x * f.dx + step_y * f.dy + static_cast<std::int64_t>(bin.color_format.anchor_bias));
  store(out.c_tile_x, step_x << (kTileShift + s));
  store(out.c_tile_y, step_y << (kTileShift + s));
  const auto local = [&bin](const Channels& step) HALFPLANE_LAMBDA {
    return channel_pairs(round_shift_channels(step, bin.color_format.step_drop) << bin.color_format.up);
  };
  const auto smaller = [](const Channels& p, const Channels& q) HALFPLANE_LAMBDA { return p < q ? p : q; };
  const auto larger = [](const Channels& p, const Channels& q) HALFPLANE_LAMBDA { return p > q ? p : q; };
  out.color = {local(step_x), local(step_y), channel_pairs(smaller(smaller(ca, cb), cc)),
               channel_pairs(larger(larger(ca, cb), cc))};
}

/// A rectangle of constant depth and colour: no edges.
inline void set_up_flat(const Bin& bin, const VertexRow& v, BinTriangle& out) {
  out.z_low = out.z_high = static_cast<std::int32_t>(v.z);
  out.edge = {};
  out.dx = out.dy = {};
  const int F = bin.widths.plane_fraction;
  out.z_anchor = static_cast<std::int64_t>((static_cast<std::uint64_t>(v.z) << F) + bin.depth_format.anchor_bias);
  out.z_tile_x = out.z_tile_y = 0;
  out.z_step_x = out.z_step_y = 0;
  out.to_low = out.to_high = 0;
  out.is_gentle = true;
  out.is_narrow = bin.tests_narrow;
  out.is_steep = false;
  out.c_tile_x = out.c_tile_y = {};
  const Channels codes = channels_of(v.rgba);
  for (std::size_t i = 0; i < 4; ++i)
    out.c_anchor[i] =
        static_cast<std::int64_t>((static_cast<std::uint64_t>(codes[i]) << F) + bin.color_format.anchor_bias);
  const ChannelPairs pair = channel_pairs(codes);
  out.color = {{}, {}, pair, pair};
}

/// Distance of a tile's depths from the depth at its anchor, which has four pixels to the left and above, three to the
/// right and below. Steps per pixel, in a tile's units; `least`, `most`: increments to a sample.
HALFPLANE_INLINE void find_reach(const Bin& bin, std::int64_t step_x, std::int64_t step_y, BinTriangle& out,
                                 std::int64_t least = 0, std::int64_t most = 0) {
  const auto low = [](std::int64_t step)
                       HALFPLANE_LAMBDA { return std::min((kTileSize / 2 - 1) * step, -kTileSize / 2 * step); };
  const auto high = [](std::int64_t step)
                        HALFPLANE_LAMBDA { return std::max((kTileSize / 2 - 1) * step, -kTileSize / 2 * step); };
  const int drop = bin.depth_format.down - bin.depth_format.up + bin.range_bits_dropped;
  const std::int64_t to_low = (low(step_x) + low(step_y) + least) >> drop,
                     to_high = (high(step_x) + high(step_y) + most) >> drop;
  out.to_low = static_cast<std::int32_t>(to_low);
  out.to_high = static_cast<std::int32_t>(to_high);
  // At least one pixel of the tile is inside the triangle. From there to the anchor, and on to any other pixel, 16 bits
  // must hold the distance to the middle of the vertices' depths.
  constexpr std::int64_t kRange = std::int64_t{1} << 15, kRounding = 8;
  out.is_narrow = bin.tests_narrow && out.z_high - out.z_low < (1 << 16) - kRounding;
  const std::int64_t half = (std::int64_t{out.z_high} - out.z_low) >> (bin.range_bits_dropped + 1);
  out.is_gentle = half + 2 * (to_high - to_low) + kRounding < kRange;
}

/// Depth: its plane from tile to tile, and its steps per pixel in a lane.
HALFPLANE_INLINE void set_up_depth(const Bin& bin, const VertexRow& a, const VertexRow& b, const VertexRow& c,
                                   const VertexRow& origin, const PlaneSteps& f, BinTriangle& out) {
  const LaneFormat& format = bin.depth_format;
  const int s = bin.widths.grid_bits;
  const std::int64_t az = std::int64_t{b.z} - a.z, bz = std::int64_t{c.z} - a.z;
  const std::int64_t numerator_x = az * f.by - bz * f.ay, numerator_y = f.ax * bz - f.bx * az;
  constexpr std::int64_t kNarrow = std::int64_t{1} << 32;  // numerator times a reciprocal of 30 bits
  const bool is_narrow = std::abs(numerator_x) < kNarrow && std::abs(numerator_y) < kNarrow;
  const GradientFactor factor(f.quotient, bin.widths.depth(), bin.widths);
  const auto gradient = [=, R = factor.reciprocal, k = factor.k](std::int64_t numerator) HALFPLANE_LAMBDA {
    return is_narrow ? round_shift(numerator * R, k)
                     : static_cast<std::int64_t>(round_shift(static_cast<int128>(numerator) * R, k));
  };
  const std::int64_t step_x = gradient(numerator_x), step_y = gradient(numerator_y);
  const std::uint64_t at_origin = static_cast<std::uint64_t>(origin.z) << bin.widths.plane_fraction;
  out.z_anchor =
      static_cast<std::int64_t>(at_origin + product(step_x, f.dx) + product(step_y, f.dy) + format.anchor_bias);
  out.z_tile_x = step_x << (kTileShift + s);
  out.z_tile_y = step_y << (kTileShift + s);
  const std::int64_t local_x = round_shift(step_x, format.step_drop), local_y = round_shift(step_y, format.step_drop);
  const auto in_lane = [&format](std::int64_t step) HALFPLANE_LAMBDA {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(step) << format.up);
  };
  out.z_step_x = in_lane(local_x);
  out.z_step_y = in_lane(local_y);
  find_reach(bin, local_x, local_y, out);
}

/// The corners of a triangle, swapped so that its area is positive.
struct Corners {
  const VertexRow *a, *b, *c;
  PlaneSteps f;  ///< the sides; the rest is set with the planes
  std::int64_t area;
};

/// False if the area is 0.
HALFPLANE_INLINE bool find_corners(const Slice& slice, const Record& record, Corners& out) {
  const VertexRow* v = slice.vertices.data();
  out.a = v + record.v[0];
  out.b = v + record.v[1];
  out.c = v + record.v[2];
  const auto difference = [](std::int32_t p, std::int32_t q) HALFPLANE_LAMBDA { return std::int64_t{p} - q; };
  PlaneSteps& f = out.f;
  f.ax = difference(out.b->x, out.a->x);
  f.ay = difference(out.b->y, out.a->y);
  f.bx = difference(out.c->x, out.a->x);
  f.by = difference(out.c->y, out.a->y);
  out.area = cross(f.ax, f.ay, f.bx, f.by);
  if (out.area < 0) {
    std::swap(out.b, out.c);
    std::swap(f.ax, f.bx);
    std::swap(f.ay, f.by);
    out.area = -out.area;
  }
  return out.area != 0;
}

/// The first corner in the order of (Y, X): two at one place would give area 0.
HALFPLANE_INLINE const VertexRow& origin_of(const Corners& corners) {
  const auto is_before = [](const VertexRow* p, const VertexRow* q) HALFPLANE_LAMBDA {
    return (std::int64_t{p->y} << 32) + p->x < (std::int64_t{q->y} << 32) + q->x;
  };
  const VertexRow* origin = corners.a;
  origin = is_before(corners.b, origin) ? corners.b : origin;
  origin = is_before(corners.c, origin) ? corners.c : origin;
  return *origin;
}

/// Sets up the constants common to the planes, and the depth plane.
HALFPLANE_INLINE void set_up_planes(const Bin& bin, const Record& record, Corners& corners, BinTriangle& out) {
  PlaneSteps& f = corners.f;
  const VertexRow& origin = origin_of(corners);
  const int s = bin.widths.grid_bits;
  const auto anchor = [s](int first) HALFPLANE_LAMBDA {
    return (std::int64_t{first + kTileSize / 2} << s) + (std::int64_t{1} << (s - 1));
  };
  f.dx = anchor(bin.first_x) - origin.x;
  f.dy = anchor(bin.first_y) - origin.y;
  f.quotient = fast_area_quotient(corners.area, bin.widths.reciprocal_bits());
  out.z_low = record.z_low;
  out.z_high = record.z_high;
  set_up_depth(bin, *corners.a, *corners.b, *corners.c, origin, f, out);
}

HALFPLANE_INLINE void set_up_colors(const Bin& bin, const Corners& corners, BinTriangle& out) {
  set_up_colors(bin, *corners.a, *corners.b, *corners.c, origin_of(corners), corners.f, out);
}

/// Sets up a triangle or rectangle completely; false if the area is 0.
HALFPLANE_NOINLINE bool set_up(const Bin& bin, const Slice& slice, const Record& record, BinTriangle& out) {
  if (record.kind() == RecordKind::rectangle) {
    set_up_flat(bin, slice.vertices[record.v[0]], out);
    return true;
  }
  Corners corners;
  if (!find_corners(slice, record, corners)) return false;
  set_up_edges(bin, *corners.a, *corners.b, *corners.c, out);
  set_up_planes(bin, record, corners, out);
  if (bin.state.color_write) set_up_colors(bin, corners, out);
  return true;
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
