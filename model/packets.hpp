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

/// Name, member and width of one field. An array field is packed element 0 lowest.
template <class Packet, class Member>
struct Field {
  std::string_view name;
  Member Packet::*member;
  Width Widths::*width;
};
template <class Packet, class Member>
Field(std::string_view, Member Packet::*, Width Widths::*) -> Field<Packet, Member>;

/// Elements of an array member; 0 for a plain one.
template <class T>
inline constexpr std::size_t kArraySize = 0;
template <class T, std::size_t N>
inline constexpr std::size_t kArraySize<std::array<T, N>> = N;

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

/// coarse_raster -> fine_raster: one tile of one triangle.
struct TilePacket {
  std::uint32_t primitive_id = 0;                         ///< Triangle::primitive modulo 2^key.primitive_bits
  std::uint8_t slot = 0;                                  ///< context RAM slot of the triangle's constants
  std::uint16_t tile_x = 0, tile_y = 0;                   ///< tiles
  std::uint8_t left = 0, top = 0, right = 0, bottom = 0;  ///< pixels of the tile inside box and scissor, inclusive
  std::array<std::int32_t, 3> edge_value{};  ///< edge values at the tile's first pixel, saturated (coarse_raster.hpp)

  static constexpr std::string_view name = "tile_packet";
  static constexpr auto fields() {
    return std::tuple{Field{"primitive_id", &TilePacket::primitive_id, &Widths::primitive_id},
                      Field{"slot", &TilePacket::slot, &Widths::slot},
                      Field{"tile_x", &TilePacket::tile_x, &Widths::tile_x},
                      Field{"tile_y", &TilePacket::tile_y, &Widths::tile_y},
                      Field{"left", &TilePacket::left, &Widths::tile_pixel},
                      Field{"top", &TilePacket::top, &Widths::tile_pixel},
                      Field{"right", &TilePacket::right, &Widths::tile_pixel},
                      Field{"bottom", &TilePacket::bottom, &Widths::tile_pixel},
                      Field{"edge_value", &TilePacket::edge_value, &Widths::tile_edge}};
  }
};

/// The part of a triangle's context that fine_raster reads: what each edge value gains per pixel.
struct EdgeContext {
  std::array<std::int32_t, 3> step_x{};  ///< -dy: per pixel to the right
  std::array<std::int32_t, 3> step_y{};  ///< dx: per pixel down

  static constexpr std::string_view name = "edge_context";
  static constexpr auto fields() {
    return std::tuple{Field{"step_x", &EdgeContext::step_x, &Widths::edge_step},
                      Field{"step_y", &EdgeContext::step_y, &Widths::edge_step}};
  }
};

/// fine_raster -> interpolate: one stamp with at least one sample covered.
struct StampPacket {
  std::uint32_t primitive_id = 0;
  std::uint8_t slot = 0;
  std::uint16_t tile_x = 0, tile_y = 0;
  std::uint16_t stamp = 0;  ///< row-major number of the stamp in its tile
  std::uint64_t mask = 0;   ///< bit j * stamp_size + i: sample in column i, row j of the stamp is covered

  static constexpr std::string_view name = "stamp_packet";
  static constexpr auto fields() {
    return std::tuple{Field{"primitive_id", &StampPacket::primitive_id, &Widths::primitive_id},
                      Field{"slot", &StampPacket::slot, &Widths::slot},
                      Field{"tile_x", &StampPacket::tile_x, &Widths::tile_x},
                      Field{"tile_y", &StampPacket::tile_y, &Widths::tile_y},
                      Field{"stamp", &StampPacket::stamp, &Widths::stamp_index},
                      Field{"mask", &StampPacket::mask, &Widths::sample_mask}};
  }
};

/// Calls visit(field, width, elements) for each field of a packet type, first field first.
template <class Packet, class Visit>
constexpr void for_each_field(const Widths& widths, Visit&& visit) {
  std::apply(
      [&](const auto&... field) {
        (visit(field, widths.*field.width,
               std::max<std::size_t>(1, kArraySize<std::decay_t<decltype(Packet{}.*field.member)>>)),
         ...);
      },
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
