// The packets on the arrows between the stages. Each has ONE field list: it yields the packed SystemVerilog struct
// (model/raster_pkg.hpp), the bits that go into and come out of the RTL, the trace line and the field-by-field diff.
//
// Units: coordinates in subpixels of 2^-s pixel (s = max(S, 1)), depth and colour in codes (LSB).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "widths.hpp"

namespace halfplane {

/// Name, member and width of one field. An array field is packed element 0 lowest; `count` says how many of its elements
/// this configuration has, none: all of them.
template <class Packet, class Member>
struct Field {
  std::string_view name;
  Member Packet::*member;
  Width Widths::*width;
  int Widths::*count = nullptr;
};
template <class Packet, class Member>
Field(std::string_view, Member Packet::*, Width Widths::*) -> Field<Packet, Member>;
template <class Packet, class Member>
Field(std::string_view, Member Packet::*, Width Widths::*, int Widths::*) -> Field<Packet, Member>;

/// Elements of an array member; 0 for a plain one.
template <class T>
inline constexpr std::size_t kArraySize = 0;
template <class T, std::size_t N>
inline constexpr std::size_t kArraySize<std::array<T, N>> = N;

/// Elements of a field in one configuration; 1 for a plain one.
template <class Packet, class Member>
[[nodiscard]] constexpr std::size_t element_count(const Field<Packet, Member>& field, const Widths& widths) {
  if (field.count != nullptr) return static_cast<std::size_t>(widths.*field.count);
  return std::max<std::size_t>(1, kArraySize<Member>);
}

/// A vertex after the snap.
struct SnappedVertex {
  std::int32_t x = 0, y = 0;           ///< subpixels, y down
  std::uint32_t z = 0;                 ///< depth code
  std::array<std::uint8_t, 4> rgba{};  ///< colour codes, 8 bits a channel
  bool operator==(const SnappedVertex&) const = default;
};

/// The order of vertices on which setup and the fan of a clipped polygon agree: by (Y, X, Z).
[[nodiscard]] inline bool canonically_before(const SnappedVertex& a, const SnappedVertex& b) {
  return std::tie(a.y, a.x, a.z) < std::tie(b.y, b.x, b.z);
}

/// A triangle between viewport and triangle_setup: where the RTL starts. One input triangle that was clipped yields
/// several of these with the same `primitive`.
struct Triangle {
  std::uint32_t primitive = 0;  ///< number of the input triangle, over the whole scene
  std::uint32_t draw = 0;       ///< index into Scene::commands
  std::array<SnappedVertex, 3> v{};
};

/// What a primitive is. Rectangles and points cover their whole box with one depth and one colour. Bit 1 set: a token,
/// which visits no tile on its way to depth_test.
enum class PrimitiveKind : std::uint8_t {
  triangle = 0,
  rectangle = 1,   ///< a clear inside the scissor: drawn like a triangle that covers every pixel, and not counted
  fast_clear = 2,  ///< a clear of the whole target: marks tiles, writes no pixel
  flush = 3,       ///< writes back all that is on the chip; the box is the whole target
  point = 4,       ///< a rectangle that is counted
  line = 6         ///< the place of a line in program order; its pixels come from line_raster
};

/// What the counters count; clears and flushes are the host's own.
[[nodiscard]] constexpr bool is_counted(std::uint8_t kind) {
  return kind == static_cast<std::uint8_t>(PrimitiveKind::triangle) ||
         kind == static_cast<std::uint8_t>(PrimitiveKind::point) ||
         kind == static_cast<std::uint8_t>(PrimitiveKind::line);
}

/// The states that ride with a primitive.
struct PrimitiveState {
  std::uint8_t depth_test = 0;   ///< DepthFunc
  std::uint8_t depth_write = 0;  ///< 0 or 1; for a fast clear: clears depth
  std::uint8_t color_write = 0;  ///< likewise
  bool operator==(const PrimitiveState&) const = default;
};

/// A rectangle of pixels, inclusive; empty when left > right or top > bottom.
struct PixelBox {
  std::uint16_t left = 0, top = 0, right = 0, bottom = 0;
};

/// host -> cull: a snapped primitive, as it was named.
struct PrimitivePacket : PixelBox, PrimitiveState {
  std::uint8_t kind = 0;           ///< PrimitiveKind
  std::uint32_t primitive_id = 0;  ///< Triangle::primitive modulo 2^key.primitive_bits
  std::uint8_t cull = 0;           ///< Cull
  std::uint8_t front_cw = 0;       ///< 1: clockwise is the front
  std::array<std::int32_t, 3> x{}, y{};
  std::array<std::uint32_t, 3> z{};
  std::array<std::uint32_t, 3> rgba{};  ///< 8 bits a stored channel, R lowest
  // left...bottom: the scissor, inside the target

  static constexpr std::string_view name = "primitive_packet";
  static constexpr auto fields() {
    using P = PrimitivePacket;
    return std::tuple{Field{"kind", &P::kind, &Widths::kind},
                      Field{"primitive_id", &P::primitive_id, &Widths::primitive_id},
                      Field{"left", &P::left, &Widths::pixel_x},
                      Field{"top", &P::top, &Widths::pixel_y},
                      Field{"right", &P::right, &Widths::pixel_x},
                      Field{"bottom", &P::bottom, &Widths::pixel_y},
                      Field{"depth_test", &P::depth_test, &Widths::depth_func},
                      Field{"depth_write", &P::depth_write, &Widths::flag},
                      Field{"color_write", &P::color_write, &Widths::flag},
                      Field{"cull", &P::cull, &Widths::cull_mode},
                      Field{"front_cw", &P::front_cw, &Widths::flag},
                      Field{"x", &P::x, &Widths::coordinate},
                      Field{"y", &P::y, &Widths::coordinate},
                      Field{"z", &P::z, &Widths::depth_code},
                      Field{"rgba", &P::rgba, &Widths::vertex_color}};
  }
};

/// cull -> triangle_setup: a triangle that faces the right way and has a pixel centre in its box, in canonical order.
struct TrianglePacket : PixelBox, PrimitiveState {
  std::uint8_t kind = 0;
  std::uint32_t primitive_id = 0;
  std::array<std::int32_t, 3> x{}, y{};
  std::array<std::uint32_t, 3> z{};
  std::array<std::uint32_t, 3> rgba{};
  std::uint64_t area = 0;                    ///< twice the area, square subpixels; 0 for other kinds
  std::array<std::int64_t, 3> edge_value{};  ///< edge_function at the first pixel of the first tile; 0 for other kinds
  // left...bottom: pixel centres of the triangle inside the scissor

  static constexpr std::string_view name = "triangle_packet";
  static constexpr auto fields() {
    using P = TrianglePacket;
    return std::tuple{Field{"kind", &P::kind, &Widths::kind},
                      Field{"primitive_id", &P::primitive_id, &Widths::primitive_id},
                      Field{"left", &P::left, &Widths::pixel_x},
                      Field{"top", &P::top, &Widths::pixel_y},
                      Field{"right", &P::right, &Widths::pixel_x},
                      Field{"bottom", &P::bottom, &Widths::pixel_y},
                      Field{"depth_test", &P::depth_test, &Widths::depth_func},
                      Field{"depth_write", &P::depth_write, &Widths::flag},
                      Field{"color_write", &P::color_write, &Widths::flag},
                      Field{"x", &P::x, &Widths::coordinate},
                      Field{"y", &P::y, &Widths::coordinate},
                      Field{"z", &P::z, &Widths::depth_code},
                      Field{"rgba", &P::rgba, &Widths::vertex_color},
                      Field{"area", &P::area, &Widths::area},
                      Field{"edge_value", &P::edge_value, &Widths::edge_value}};
  }
};

/// triangle_setup -> coarse_raster: everything that stays constant over the primitive.
struct SetupPacket : PixelBox, PrimitiveState {
  std::uint8_t kind = 0;
  std::uint32_t primitive_id = 0;
  std::array<std::int32_t, 3> dx{}, dy{};    ///< of each edge, subpixels; 0 for other kinds than triangles
  std::array<std::int64_t, 3> edge_value{};  ///< edge_function at the first pixel of the first tile; likewise 0
  std::int64_t depth_value = 0;              ///< Plane::value + plane_bias()
  std::int64_t depth_step_x = 0, depth_step_y = 0;
  std::array<std::int64_t, 4> color_value{};  ///< likewise
  std::array<std::int64_t, 4> color_step_x{}, color_step_y{};
  std::uint32_t depth_min = 0, depth_max = 0;
  std::array<std::uint8_t, 4> color_min{}, color_max{};

  static constexpr std::string_view name = "setup_packet";
  static constexpr auto fields() {
    using P = SetupPacket;
    return std::tuple{Field{"kind", &P::kind, &Widths::kind},
                      Field{"primitive_id", &P::primitive_id, &Widths::primitive_id},
                      Field{"left", &P::left, &Widths::pixel_x},
                      Field{"top", &P::top, &Widths::pixel_y},
                      Field{"right", &P::right, &Widths::pixel_x},
                      Field{"bottom", &P::bottom, &Widths::pixel_y},
                      Field{"depth_test", &P::depth_test, &Widths::depth_func},
                      Field{"depth_write", &P::depth_write, &Widths::flag},
                      Field{"color_write", &P::color_write, &Widths::flag},
                      Field{"dx", &P::dx, &Widths::delta},
                      Field{"dy", &P::dy, &Widths::delta},
                      Field{"edge_value", &P::edge_value, &Widths::edge_value},
                      Field{"depth_value", &P::depth_value, &Widths::depth_plane},
                      Field{"depth_step_x", &P::depth_step_x, &Widths::depth_plane},
                      Field{"depth_step_y", &P::depth_step_y, &Widths::depth_plane},
                      Field{"color_value", &P::color_value, &Widths::color_plane, &Widths::color_channels},
                      Field{"color_step_x", &P::color_step_x, &Widths::color_plane, &Widths::color_channels},
                      Field{"color_step_y", &P::color_step_y, &Widths::color_plane, &Widths::color_channels},
                      Field{"depth_min", &P::depth_min, &Widths::depth_code},
                      Field{"depth_max", &P::depth_max, &Widths::depth_code},
                      Field{"color_min", &P::color_min, &Widths::color_code, &Widths::color_channels},
                      Field{"color_max", &P::color_max, &Widths::color_code, &Widths::color_channels}};
  }
};

/// The part of a primitive's constants that waits in the context RAM, by slot, until its stamps come to interpolate.
struct ContextPacket : PrimitiveState {
  std::int64_t depth_step_x = 0, depth_step_y = 0;  ///< LocalPlane steps
  std::array<std::int64_t, 4> color_step_x{}, color_step_y{};
  std::uint32_t depth_min = 0, depth_max = 0;
  std::array<std::uint8_t, 4> color_min{}, color_max{};

  static constexpr std::string_view name = "context_packet";
  static constexpr auto fields() {
    using P = ContextPacket;
    return std::tuple{Field{"depth_test", &P::depth_test, &Widths::depth_func},
                      Field{"depth_write", &P::depth_write, &Widths::flag},
                      Field{"color_write", &P::color_write, &Widths::flag},
                      Field{"depth_step_x", &P::depth_step_x, &Widths::local_depth},
                      Field{"depth_step_y", &P::depth_step_y, &Widths::local_depth},
                      Field{"color_step_x", &P::color_step_x, &Widths::local_color, &Widths::color_channels},
                      Field{"color_step_y", &P::color_step_y, &Widths::local_color, &Widths::color_channels},
                      Field{"depth_min", &P::depth_min, &Widths::depth_code},
                      Field{"depth_max", &P::depth_max, &Widths::depth_code},
                      Field{"color_min", &P::color_min, &Widths::color_code, &Widths::color_channels},
                      Field{"color_max", &P::color_max, &Widths::color_code, &Widths::color_channels}};
  }
};

/// coarse_raster -> fine_raster: one tile of one primitive, or (is_visit = 0) only the news that a primitive has ended.
struct TilePacket {
  std::uint8_t kind = 0;
  std::uint8_t is_visit = 0;        ///< 0: no tile; fast clears, flushes, and primitives whose last tile was skipped
  std::uint8_t ends_primitive = 0;  ///< nothing of this primitive follows
  std::uint32_t primitive_id = 0;
  std::uint8_t slot = 0;                                  ///< context RAM slot of the triangle's constants
  std::uint16_t tile_x = 0, tile_y = 0;                   ///< tiles; without a visit: the last tile of the box
  std::uint8_t left = 0, top = 0, right = 0, bottom = 0;  ///< pixels of the tile inside box and scissor, inclusive
  std::uint8_t is_inside = 0;                             ///< trivially accepted: every sample of the box is covered
  std::array<std::int32_t, 3> edge_value{};  ///< edge values at the tile's first pixel, saturated (coarse_raster.hpp)
  std::int64_t depth_anchor = 0;             ///< LocalPlane::anchor
  std::array<std::int64_t, 4> color_anchor{};

  static constexpr std::string_view name = "tile_packet";
  static constexpr auto fields() {
    return std::tuple{Field{"kind", &TilePacket::kind, &Widths::kind},
                      Field{"is_visit", &TilePacket::is_visit, &Widths::flag},
                      Field{"ends_primitive", &TilePacket::ends_primitive, &Widths::flag},
                      Field{"primitive_id", &TilePacket::primitive_id, &Widths::primitive_id},
                      Field{"slot", &TilePacket::slot, &Widths::slot},
                      Field{"tile_x", &TilePacket::tile_x, &Widths::tile_x},
                      Field{"tile_y", &TilePacket::tile_y, &Widths::tile_y},
                      Field{"left", &TilePacket::left, &Widths::tile_pixel},
                      Field{"top", &TilePacket::top, &Widths::tile_pixel},
                      Field{"right", &TilePacket::right, &Widths::tile_pixel},
                      Field{"bottom", &TilePacket::bottom, &Widths::tile_pixel},
                      Field{"is_inside", &TilePacket::is_inside, &Widths::flag},
                      Field{"edge_value", &TilePacket::edge_value, &Widths::tile_edge},
                      Field{"depth_anchor", &TilePacket::depth_anchor, &Widths::local_depth},
                      Field{"color_anchor", &TilePacket::color_anchor, &Widths::local_color, &Widths::color_channels}};
  }
};

/// The part of a triangle's constants that fine_raster reads: what each edge value gains per pixel.
struct EdgeContext {
  std::array<std::int32_t, 3> step_x{};  ///< -dy: per pixel to the right
  std::array<std::int32_t, 3> step_y{};  ///< dx: per pixel down

  static constexpr std::string_view name = "edge_context";
  static constexpr auto fields() {
    return std::tuple{Field{"step_x", &EdgeContext::step_x, &Widths::edge_step},
                      Field{"step_y", &EdgeContext::step_y, &Widths::edge_step}};
  }
};

/// fine_raster -> interpolate: one stamp. Sent when a sample is covered or when it ends something.
struct StampPacket {
  std::uint8_t kind = 0;
  std::uint8_t ends_visit = 0;      ///< the last of its tile visit
  std::uint8_t ends_primitive = 0;  ///< the last of its primitive
  std::uint32_t primitive_id = 0;
  std::uint8_t slot = 0;
  std::uint16_t tile_x = 0, tile_y = 0;
  std::uint16_t stamp = 0;  ///< row-major number of the stamp in its tile
  std::uint64_t mask = 0;   ///< bit j * stamp_size + i: sample in column i, row j of the stamp is covered
  std::int64_t depth_anchor = 0;
  std::array<std::int64_t, 4> color_anchor{};

  static constexpr std::string_view name = "stamp_packet";
  static constexpr auto fields() {
    using P = StampPacket;
    return std::tuple{Field{"kind", &P::kind, &Widths::kind},
                      Field{"ends_visit", &P::ends_visit, &Widths::flag},
                      Field{"ends_primitive", &P::ends_primitive, &Widths::flag},
                      Field{"primitive_id", &P::primitive_id, &Widths::primitive_id},
                      Field{"slot", &P::slot, &Widths::slot},
                      Field{"tile_x", &P::tile_x, &Widths::tile_x},
                      Field{"tile_y", &P::tile_y, &Widths::tile_y},
                      Field{"stamp", &P::stamp, &Widths::stamp_index},
                      Field{"mask", &P::mask, &Widths::sample_mask},
                      Field{"depth_anchor", &P::depth_anchor, &Widths::local_depth},
                      Field{"color_anchor", &P::color_anchor, &Widths::local_color, &Widths::color_channels}};
  }
};

/// interpolate -> primitive_join -> depth_test: a stamp with its attributes. Samples that are not covered carry values too.
struct FragmentPacket : PrimitiveState {
  std::uint8_t kind = 0, ends_visit = 0, ends_primitive = 0;
  std::uint32_t primitive_id = 0;
  std::uint16_t tile_x = 0, tile_y = 0;
  std::uint16_t stamp = 0;
  std::uint64_t mask = 0;
  std::array<std::uint32_t, 64> depth{};  ///< codes, clamped to the vertices' range
  std::array<std::uint32_t, 64> rgba{};   ///< 8 bits a stored channel, R lowest

  static constexpr std::string_view name = "fragment_packet";
  static constexpr auto fields() {
    using P = FragmentPacket;
    return std::tuple{Field{"kind", &P::kind, &Widths::kind},
                      Field{"ends_visit", &P::ends_visit, &Widths::flag},
                      Field{"ends_primitive", &P::ends_primitive, &Widths::flag},
                      Field{"primitive_id", &P::primitive_id, &Widths::primitive_id},
                      Field{"tile_x", &P::tile_x, &Widths::tile_x},
                      Field{"tile_y", &P::tile_y, &Widths::tile_y},
                      Field{"stamp", &P::stamp, &Widths::stamp_index},
                      Field{"mask", &P::mask, &Widths::sample_mask},
                      Field{"depth_test", &P::depth_test, &Widths::depth_func},
                      Field{"depth_write", &P::depth_write, &Widths::flag},
                      Field{"color_write", &P::color_write, &Widths::flag},
                      Field{"depth", &P::depth, &Widths::depth_code, &Widths::samples},
                      Field{"rgba", &P::rgba, &Widths::vertex_color, &Widths::samples}};
  }
};

/// depth_test, rop -> framebuffer: what is written, and where; sent for every stamp with a covered sample.
struct WritePacket {
  std::uint32_t primitive_id = 0;
  std::uint16_t tile_x = 0, tile_y = 0;
  std::uint16_t stamp = 0;
  std::uint64_t passed = 0;                        ///< samples that passed the depth test
  std::uint64_t write_depth = 0, write_color = 0;  ///< of those, the ones to write
  std::array<std::uint32_t, 64> depth{};           ///< codes; also of samples that are not written
  std::array<std::uint32_t, 64> color{};           ///< stored colours; likewise

  static constexpr std::string_view name = "write_packet";
  static constexpr auto fields() {
    using P = WritePacket;
    return std::tuple{Field{"primitive_id", &P::primitive_id, &Widths::primitive_id},
                      Field{"tile_x", &P::tile_x, &Widths::tile_x},
                      Field{"tile_y", &P::tile_y, &Widths::tile_y},
                      Field{"stamp", &P::stamp, &Widths::stamp_index},
                      Field{"passed", &P::passed, &Widths::sample_mask},
                      Field{"write_depth", &P::write_depth, &Widths::sample_mask},
                      Field{"write_color", &P::write_color, &Widths::sample_mask},
                      Field{"depth", &P::depth, &Widths::depth_code, &Widths::samples},
                      Field{"color", &P::color, &Widths::stored_color, &Widths::samples}};
  }
};

/// What the end of a tile visit does to the tile's HiZ bound.
enum class HizUpdate : std::uint8_t { none, set, clear };

/// depth_test -> coarse_raster: a tile visit has retired.
struct RetirePacket {
  std::uint32_t primitive_id = 0;
  std::uint16_t tile_x = 0, tile_y = 0;
  std::uint8_t update = 0;     ///< HizUpdate
  std::uint32_t hiz_code = 0;  ///< the bound for `set`, all ones for `clear`, 0 for `none`

  static constexpr std::string_view name = "retire_packet";
  static constexpr auto fields() {
    using P = RetirePacket;
    return std::tuple{Field{"primitive_id", &P::primitive_id, &Widths::primitive_id},
                      Field{"tile_x", &P::tile_x, &Widths::tile_x}, Field{"tile_y", &P::tile_y, &Widths::tile_y},
                      Field{"update", &P::update, &Widths::hiz_update},
                      Field{"hiz_code", &P::hiz_code, &Widths::hiz_code}};
  }
};

/// framebuffer -> memory: one stamp of one plane. Requests go in program order; reads are answered in the same order.
struct MemoryRequest {
  std::uint8_t is_write = 0;
  std::uint8_t is_color = 0;  ///< 0: the depth plane
  std::uint16_t tile_x = 0, tile_y = 0;
  std::uint16_t stamp = 0;
  std::array<std::uint32_t, 64> data{};  ///< one code a sample; 0 for a read

  static constexpr std::string_view name = "memory_request";
  static constexpr auto fields() {
    using P = MemoryRequest;
    return std::tuple{Field{"is_write", &P::is_write, &Widths::flag},
                      Field{"is_color", &P::is_color, &Widths::flag},
                      Field{"tile_x", &P::tile_x, &Widths::tile_x},
                      Field{"tile_y", &P::tile_y, &Widths::tile_y},
                      Field{"stamp", &P::stamp, &Widths::stamp_index},
                      Field{"data", &P::data, &Widths::memory_lane, &Widths::samples}};
  }
};

/// memory -> framebuffer: the answer to a read.
struct MemoryResponse {
  std::array<std::uint32_t, 64> data{};

  static constexpr std::string_view name = "memory_response";
  static constexpr auto fields() {
    return std::tuple{Field{"data", &MemoryResponse::data, &Widths::memory_lane, &Widths::samples}};
  }
};

/// The performance counters of the hardware: items since reset, modulo 2^32. Names as in Counters (engines/render.hpp).
struct CounterPacket {
  std::uint32_t primitives_in = 0;  ///< triangles, points and lines that came to cull
  std::uint32_t zero_area = 0, backface = 0, empty = 0;
  std::uint32_t tiles_visited = 0, tiles_outside = 0, trivially_accepted = 0, tiles_hiz = 0, samples_tested = 0;
  std::uint32_t covered = 0, depth_passed = 0, written = 0;
  std::uint32_t tile_fills = 0, tile_evictions = 0, tile_clears = 0;  ///< by plane: depth and colour count apart

  static constexpr std::string_view name = "counter_packet";
  static constexpr auto fields() {
    using P = CounterPacket;
    return std::tuple{Field{"primitives_in", &P::primitives_in, &Widths::counter},
                      Field{"zero_area", &P::zero_area, &Widths::counter},
                      Field{"backface", &P::backface, &Widths::counter},
                      Field{"empty", &P::empty, &Widths::counter},
                      Field{"tiles_visited", &P::tiles_visited, &Widths::counter},
                      Field{"tiles_outside", &P::tiles_outside, &Widths::counter},
                      Field{"trivially_accepted", &P::trivially_accepted, &Widths::counter},
                      Field{"tiles_hiz", &P::tiles_hiz, &Widths::counter},
                      Field{"samples_tested", &P::samples_tested, &Widths::counter},
                      Field{"covered", &P::covered, &Widths::counter},
                      Field{"depth_passed", &P::depth_passed, &Widths::counter},
                      Field{"written", &P::written, &Widths::counter},
                      Field{"tile_fills", &P::tile_fills, &Widths::counter},
                      Field{"tile_evictions", &P::tile_evictions, &Widths::counter},
                      Field{"tile_clears", &P::tile_clears, &Widths::counter}};
  }
};

/// Calls visit(field, width, elements) for each field of a packet type, first field first.
template <class Packet, class Visit>
constexpr void for_each_field(const Widths& widths, Visit&& visit) {
  std::apply([&](const auto&... field) { (visit(field, widths.*field.width, element_count(field, widths)), ...); },
             Packet::fields());
}

/// Bits of the packed struct.
template <class Packet>
[[nodiscard]] constexpr int packet_bits(const Widths& widths) {
  int bits = 0;
  for_each_field<Packet>(
      widths, [&](const auto&, const Width& width, std::size_t n) { bits += width.bits * static_cast<int>(n); });
  return bits;
}

}  // namespace halfplane
