// Interpolate: attributes at the covered samples of a tile.
//
// In: the planes at the tile's anchor. Out: a code for each plane and sample. Inside a tile a plane is narrow: l local
// guard bits, anchored at the centre of pixel (T/2, T/2), so the rounding of a step acts over at most T/2 pixels a
// side. The value at a pixel is the closed form anchor + i step_x + j step_y: every traversal computes the same value.
// Final value: floor(v + 1/2), in the range of the triangle's vertices: engines that read uncovered samples clamp it.
#pragma once

#include "triangle_setup.hpp"

namespace halfplane {

/// A plane inside one tile, in 2^-l LSB, modulo 2^(bits + 1 + l), held in the low bits of a lane.
/// Lane: std::uint32_t when bits + 1 + l <= 32, else std::uint64_t.
template <class Lane>
struct LocalPlane {
  Lane anchor = 0;              ///< at pixel (T/2, T/2), plus the offset that makes decode() a shift
  Lane step_x = 0, step_y = 0;  ///< per pixel
};

/// Reads a LocalPlane of `bits`-bit codes.
template <class Lane>
struct LocalFormat {
  int bits = 0;        ///< of a code
  int guard_bits = 0;  ///< l >= 1
  Lane modulus_mask = 0;

  explicit LocalFormat(const AttributeWidths& widths) : LocalFormat(widths.code.bits, widths.guard_bits()) {}
  LocalFormat(int bits_, int guard_bits_)
      : bits(bits_), guard_bits(guard_bits_), modulus_mask(static_cast<Lane>(~0ULL >> (63 - bits_ - guard_bits_))) {}

  /// Codes wrap modulo 2^(bits + 1); the wrap window [-2^(bits-1), 3 * 2^(bits-1)) holds every value near a legal code.
  [[nodiscard]] constexpr Lane offset() const { return Lane{1} << (bits - 1 + guard_bits); }
};

/// Narrows a plane at a tile's anchor to l = `guard_bits`: both roundings are to the nearest 2^-l LSB.
template <class Lane>
[[nodiscard]] inline LocalPlane<Lane> narrow_plane(PlaneValue anchor, const Plane& plane, int guard_bits,
                                                   const Widths& widths) {
  const int drop = widths.plane_fraction - guard_bits;  // F - l
  return {static_cast<Lane>(round_shift(anchor, drop)),
          static_cast<Lane>(round_shift(plane.step_x, drop - widths.grid_bits)),
          static_cast<Lane>(round_shift(plane.step_y, drop - widths.grid_bits))};
}

/// The same for a plane of codes: with the offset that makes decode() a shift.
template <class Lane>
[[nodiscard]] inline LocalPlane<Lane> local_plane(PlaneValue anchor, const Plane& plane,
                                                  const LocalFormat<Lane>& format, const Widths& widths) {
  LocalPlane<Lane> local = narrow_plane<Lane>(anchor, plane, format.guard_bits, widths);
  local.anchor = static_cast<Lane>(local.anchor + format.offset() + (Lane{1} << (format.guard_bits - 1)));
  return local;
}

/// The rounded code of an accumulated local value, clamped to [low, high]. SignedLane: signed type of the lane's size.
template <class SignedLane, class Lane>
[[nodiscard]] constexpr SignedLane decode(Lane value, const LocalFormat<Lane>& format, SignedLane low,
                                          SignedLane high) {
  const auto code = static_cast<SignedLane>((value & format.modulus_mask) >> format.guard_bits) -
                    static_cast<SignedLane>(SignedLane{1} << (format.bits - 1));
  return code < low ? low : code > high ? high : code;
}

/// d: the increment of a plane from the centre of a pixel to a sample at `o` from it, in 2^-s pixel. Steps: of a
/// LocalPlane, signed; with steps modulo 2^(s+n), d is valid modulo 2^n.
[[nodiscard]] constexpr std::int64_t sample_plane_offset(std::int64_t step_x, std::int64_t step_y,
                                                         const SampleOffset& o, int grid_bits) {
  return round_shift(step_x * o.x + step_y * o.y, grid_bits);
}

/// A plane at a sample, modulo 2^64: its value at a centre is the original's at that sample. `guard_bits`: l, kept in its
/// tiles.
[[nodiscard]] inline Plane plane_at_sample(Plane plane, int guard_bits, const SampleOffset& o, const Widths& widths) {
  const int drop = widths.plane_fraction - guard_bits;
  const auto step = [&](PlaneValue per_subpixel) { return round_shift(per_subpixel, drop - widths.grid_bits); };
  const std::int64_t offset = sample_plane_offset(step(plane.step_x), step(plane.step_y), o, widths.grid_bits);
  plane.value =
      static_cast<PlaneValue>(static_cast<std::uint64_t>(plane.value) + (static_cast<std::uint64_t>(offset) << drop));
  return plane;
}

/// The place of a pixel: its tile, and its distance from the tile's anchor in pixels, modulo 2^64.
struct PixelPlace {
  TileOffset tile;
  std::uint64_t i, j;
};
[[nodiscard]] PixelPlace place_of(const TriangleSetup& setup, const Widths& widths, int x, int y);

/// Every affine plane at one pixel.
struct Interpolated {
  PerPlane<std::int64_t> unrounded{};  ///< as in PlaneSample
  PerPlane<std::uint32_t> code{};
};

/// Affine plane `p` of a triangle at pixel (x, y), and all of them: the specification that every engine must match.
[[nodiscard]] PlaneSample plane_at(const TriangleSetup& setup, std::size_t p, const Widths& widths, int x, int y);
[[nodiscard]] Interpolated interpolate_at(const TriangleSetup& setup, const Widths& widths, int x, int y);

/// The stage: the codes of every sample of the stamp, covered or not, from its tile's anchors. `context` is
/// that of the stamp's slot.
[[nodiscard]] FragmentPacket interpolate(const StampPacket& stamp, const ContextPacket& context, const Widths& widths);

// The same for a reused packet, at once and step by step: only the codes of `pixels` change.
void interpolate(const StampPacket& stamp, const ContextPacket& context, const Widths& widths,
                 FragmentPacket& fragment);
/// All fields except the codes.
void start_fragment(const StampPacket& stamp, const ContextPacket& context, const Widths& widths,
                    FragmentPacket& fragment);
/// Of these the fields that differ between the stamps of a tile visit: place and mask.
void enter_stamp(const StampPacket& stamp, const Widths& widths, FragmentPacket& fragment);
/// The depths of all samples of these pixels.
void interpolate_depths(const StampPacket& stamp, const ContextPacket& context, SampleMask pixels, const Widths& widths,
                        FragmentPacket& fragment);
/// The planes `first` to `end` - 1, without depth.
void interpolate_planes(const StampPacket& stamp, const ContextPacket& context, int first, int end, SampleMask pixels,
                        const Widths& widths, FragmentPacket& fragment);

}  // namespace halfplane
