// Triangle setup: three snapped vertices in, all constants of the triangle out.
//
//   edges       E_i(p) = dx_i (p_y - y_i) - dy_i (p_x - x_i), folded to one integer per pixel (see edge_function)
//   reciprocal  R = floor(2^k / A + 1/2), k placing R in [2^(r-1), 2^r], r = bits of a code + extra: one quotient for all
//               planes; planes with shorter codes take its upper bits
//   planes      z(p) = z_0 + (N_x (p_x - x_0) + N_y (p_y - y_0)) / A, gradients per subpixel with F fraction bits
//
// Because x and y gradients share R, its error scales z - z_0 as a whole: at most 2^-r of the range of the codes inside
// the triangle, however thin. Planes are held modulo 2^(bits + 1 + F): correct inside the triangle, even if they wrap
// outside it.
//
// Values are given at the first tile of the triangle's box: edges at its first pixel, planes at its anchor (the centre of
// pixel (T/2, T/2)); coarse_raster steps them from tile to tile.
#pragma once

#include <array>
#include <cstdint>

#include "../packets/packets.hpp"
#include "../scene.hpp"
#include "../widths.hpp"
#include "edge_function.hpp"

namespace halfplane {

using PlaneValue = std::int64_t;  ///< 2^-F LSB, modulo 2^(bits + 1 + F)

/// The edge function at pixel centres. Bits below a pixel are constant along an edge, so they fold into the bias.
struct Edge {
  std::int32_t dx = 0, dy = 0;  ///< subpixels; one pixel to the right adds -dy, one pixel down adds dx
  EdgeValue value = 0;          ///< at the first pixel of the first tile
  std::uint16_t low = 0;        ///< edge_low(), where a pixel has several samples
};

/// One attribute over the triangle.
struct Plane {
  PlaneValue value = 0;               ///< at the anchor of the first tile
  PlaneValue step_x = 0, step_y = 0;  ///< per subpixel
};

/// A triangle's constants: the content of the context RAM, and the start of its tile walk.
struct TriangleSetup {
  std::uint32_t primitive = 0;
  std::int64_t area = 0;  ///< twice the area, square subpixels, > 0
  std::array<Edge, 3> edge{};
  int left = 0, top = 0, right = -1, bottom = -1;  ///< box of pixel centres inside the scissor, inclusive
  PerPlane<Plane> plane{};
  CodeRange range;  ///< of the vertices: the final codes are clamped to it

  [[nodiscard]] bool is_empty() const { return left > right || top > bottom; }
};

/// floor(2^(shift+1) / area): the one division of a triangle, with one more bit for rounding.
struct AreaQuotient {
  std::uint64_t value = 0;
  int shift = 0;
};
[[nodiscard]] AreaQuotient area_quotient(std::int64_t area, int significant_bits);

/// floor(2^shift / area + 1/2).
struct Reciprocal {
  std::uint64_t value = 0;
  int shift = 0;
};
[[nodiscard]] Reciprocal reciprocal(std::int64_t area, int significant_bits);
/// Without the lowest `dropped` bits: rounded as exactly as the whole.
[[nodiscard]] constexpr Reciprocal reciprocal(const AreaQuotient& quotient, int dropped) {
  return {round_shift(quotient.value >> dropped, 1), quotient.shift - dropped};
}

/// Constants common to the planes of one triangle.
struct PlaneFrame {
  std::int64_t ax, ay, bx, by;  ///< from the base vertex to the other two, subpixels
  std::int64_t dx, dy;          ///< from the base vertex to the anchor, subpixels
  int fraction;                 ///< F
};
/// The frame of planes that start at `base`; `next` and `last` are the vertices after it in the triangle's order, which
/// has positive area. The anchor is that of the tile with pixel (first_x, first_y) as its first.
[[nodiscard]] PlaneFrame plane_frame(const SnappedVertex& base, const SnappedVertex& next, const SnappedVertex& last,
                                     int first_x, int first_y, int tile_size, const Widths& widths);
/// The plane through three codes, in the order of the frame's vertices, modulo 2^bits. Codes may have a sign.
[[nodiscard]] Plane setup_plane(std::int64_t base, std::int64_t next, std::int64_t last, const PlaneFrame& frame,
                                const Reciprocal& reciprocal, int bits);

/// Area, box and range of codes alone: edges and planes stay 0. Zero area gives an empty box.
[[nodiscard]] TriangleSetup setup_outline(const Triangle& triangle, const Widths& widths, const Rect& rect);

/// The whole setup. Zero area gives an empty box.
[[nodiscard]] TriangleSetup setup_triangle(const Triangle& triangle, const Config& config, const Widths& widths,
                                           const Rect& rect);

/// The same over the whole guard band: for questions about a single pixel.
[[nodiscard]] TriangleSetup setup_triangle(const Triangle& triangle, const Config& config, const Widths& widths);

/// The constant that SetupPacket adds to the value of a plane: half of a tile's last place, and for a clamped code the
/// offset that makes decode() a shift. With it, a tile's local anchor is the stepped value shifted right by F - l.
[[nodiscard]] std::uint64_t plane_bias(const AttributeWidths& attribute, const Widths& widths);

/// A setup whose box lies inside the target, in the form for coarse_raster. Kind and state are left at 0.
[[nodiscard]] SetupPacket to_setup_packet(const TriangleSetup& setup, const Widths& widths);

/// The setup of any kind of primitive.
[[nodiscard]] TriangleSetup setup_primitive(const TrianglePacket& primitive, const Config& config,
                                            const Widths& widths);

/// The stage: any kind of primitive. The first form sets every field that `widths` uses, so
/// that one packet serves for one primitive after the other.
void setup_packet(const TrianglePacket& primitive, const Config& config, const Widths& widths, SetupPacket& packet);
[[nodiscard]] SetupPacket setup_packet(const TrianglePacket& primitive, const Config& config, const Widths& widths);

/// From the first tile to another one, subpixels, modulo 2^64.
struct TileOffset {
  std::uint64_t dx, dy;
};
[[nodiscard]] inline TileOffset tile_offset(const TriangleSetup& setup, int tile_x, int tile_y, const Widths& widths) {
  const auto subpixels = [&widths](int tiles) {
    return static_cast<std::uint64_t>(std::int64_t{tiles} << (widths.tile_shift + widths.grid_bits));
  };
  return {subpixels(tile_x - (setup.left >> widths.tile_shift)), subpixels(tile_y - (setup.top >> widths.tile_shift))};
}

/// A plane at the anchor of the tile at that offset, modulo 2^bits.
[[nodiscard]] inline PlaneValue plane_at_tile(const Plane& plane, const TileOffset& offset, int bits) {
  return wrap_signed(static_cast<std::int64_t>(static_cast<std::uint64_t>(plane.value) +
                                               static_cast<std::uint64_t>(plane.step_x) * offset.dx +
                                               static_cast<std::uint64_t>(plane.step_y) * offset.dy),
                     bits);
}

}  // namespace halfplane
