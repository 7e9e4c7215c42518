// The packets on the arrows between the stages. Each field is authored ONCE: name, type and width. From these follow
// the C++ member, the packed SystemVerilog struct (model/generate/raster_pkg.hpp), the bits on the RTL's ports, and the
// field-by-field diff (model/packets/packet_words.hpp). model/pipeline_graph.hpp lists the stages that an arrow joins.
//
// Units: coordinates in subpixels of 2^-s pixel (s = max(S, 1)), depth and colour in codes (LSB).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <utility>

#include "../enum_names.hpp"
#include "../samples.hpp"
#include "../scene.hpp"
#include "../widths.hpp"

namespace halfplane {

/// The widest memory port.
inline constexpr std::size_t kMaxPortBytes = 64;

// ------------------------------------------------------------------------------------------------------- types of fields

/// Placeholder for the width of a member with fields of its own.
struct Nested {};

/// One field of a packet. `width`: of an element: a member of Widths, or a member of AttributeWidths for a member with
/// an element for each plane, or Nested. An array is packed element 0 lowest; `count`: the number of its elements in
/// this configuration; none: all of them.
template <class Packet, class Member, class Place>
struct Field {
  std::string_view name;
  Member Packet::*member;
  Place width;
  int Widths::*count = nullptr;
};
template <class Packet, class Member, class Place>
Field(std::string_view, Member Packet::*, Place) -> Field<Packet, Member, Place>;
template <class Packet, class Member, class Place>
Field(std::string_view, Member Packet::*, Place, int Widths::*) -> Field<Packet, Member, Place>;

/// Elements of an array member; 0 for a plain one.
template <class T>
inline constexpr std::size_t kArraySize = 0;
template <class T, std::size_t N>
inline constexpr std::size_t kArraySize<std::array<T, N>> = N;

namespace packet_detail {

template <int N>
struct Line {};

template <class Packet, int N>
concept HasFieldOn = requires {
  Packet::field(Line<N>{});
};

/// Lines of this file.
template <std::size_t N>
struct Lines {
  int line[N]{};
  std::size_t count = 0;
};

/// The lines on which a packet declares a field, in order.
template <class Packet, int... I>
consteval auto field_lines(std::integer_sequence<int, I...>) {
  constexpr bool kHasField[] = {HasFieldOn<Packet, Packet::kFirstLine + I>...};
  Lines<sizeof...(I)> lines;
  for (int i = 0; const bool has_field : kHasField) {
    if (has_field) lines.line[lines.count++] = Packet::kFirstLine + i;
    ++i;
  }
  return lines;
}
template <class Packet>
inline constexpr auto kFieldLines =
    field_lines<Packet>(std::make_integer_sequence<int, Packet::kLastLine - Packet::kFirstLine>{});

}  // namespace packet_detail

/// Calls visit(field) for every Field of a packet type, in order.
template <class Packet, class Visit>
constexpr void for_each_field(Visit&& visit) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    constexpr auto& lines = packet_detail::kFieldLines<Packet>;
    (visit(Packet::field(packet_detail::Line<lines.line[I]>{})), ...);
  }
  (std::make_index_sequence<packet_detail::kFieldLines<Packet>.count>{});
}
/// In reverse order: from the lowest bit up.
template <class Packet, class Visit>
constexpr void for_each_field_upwards(Visit&& visit) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    constexpr auto& lines = packet_detail::kFieldLines<Packet>;
    (visit(Packet::field(packet_detail::Line<lines.line[lines.count - 1 - I]>{})), ...);
  }
  (std::make_index_sequence<packet_detail::kFieldLines<Packet>.count>{});
}

// PACKET, FIELDs, each on a line of its own, PACKET_END: a struct that knows its fields. FIELD(type, name, width[, count]).
#define PACKET(Type, text)                       \
  using Self = Type;                             \
  static constexpr std::string_view name = text; \
  static constexpr int kFirstLine = __LINE__
#define FIELD(Type, member_name, ...)                                                           \
  Type member_name{};                                                                           \
  static constexpr auto field(packet_detail::Line<__LINE__>) {                                  \
    return ::halfplane::Field{std::string_view(#member_name), &Self::member_name, __VA_ARGS__}; \
  }
#define PACKET_END static constexpr int kLastLine = __LINE__;

// ------------------------------------------------------------------------------------------------------- parts of packets

/// A vertex after the snap.
struct SnappedVertex {
  std::int32_t x = 0, y = 0;       ///< subpixels, y down
  PerPlane<std::uint32_t> code{};  ///< of each plane
  bool operator==(const SnappedVertex&) const = default;
  [[nodiscard]] constexpr std::uint32_t& depth() { return code[kDepthPlane]; }
  [[nodiscard]] constexpr std::uint32_t depth() const { return code[kDepthPlane]; }
};

/// The order of vertices on which setup and the fan of a clipped polygon agree: by (Y, X, Z).
[[nodiscard]] inline bool canonically_before(const SnappedVertex& a, const SnappedVertex& b) {
  return std::tie(a.y, a.x, a.code[kDepthPlane]) < std::tie(b.y, b.x, b.code[kDepthPlane]);
}

/// A vertex's attributes over w: host side.
struct SurfaceVertex {
  double w = 1;                          ///< clip-space w
  double u = 0, v = 0;                   ///< 0 to 1 over the texture
  std::array<std::int32_t, 3> normal{};  ///< for shade phong: codes of 2^-15
};

/// A triangle between viewport and triangle_setup: the input of the RTL. A clipped input triangle yields several of
/// these with the same `primitive`.
struct Triangle {
  std::uint32_t primitive = 0;  ///< number of the input triangle, over the whole scene
  std::uint32_t draw = 0;       ///< index into Scene::commands
  std::array<SnappedVertex, 3> v{};
  std::array<SurfaceVertex, 3> surface{};  ///< of the same vertices
};

/// Kind of a primitive. Rectangles and points cover their whole box with one code per plane. Bit 1 set: a token, which
/// visits no tile on its way to depth_test.
enum class PrimitiveKind : std::uint8_t {
  triangle = 0,
  rectangle = 1,   ///< a clear inside the scissor: drawn like a triangle that covers every pixel, and not counted
  fast_clear = 2,  ///< a clear of the whole target: marks tiles, writes no pixel
  flush = 3,       ///< writes back all data on the chip; the box is the whole target
  point = 4,       ///< a rectangle that is counted
  line = 6,        ///< the place of a line in program order; its pixels come from line_raster
  state = 7  ///< sets a register of a unit downstream of the depth test: a StateRegister, in the place of the depth
             ///< test, and its value, spread over the codes (packets/state_packets.hpp)
};

/// Register that a token of kind state sets.
enum class StateRegister : std::uint8_t {
  texture = 0,  ///< TextureState
  texture_levels =
      1,  ///< TextureLevels; also FogState, a line of its table, light, TextureConstant, TextureBorder: LevelsWord
  texture_lines = 2,   ///< a part of a TextureLines, shifted in after the earlier parts
  color_ops = 4,       ///< ColorOps without its constant (stages/color_packets.hpp)
  blend_constant = 5,  ///< the constant of ColorOps
  alpha_test = 6,      ///< AlphaTest
  stencil_test = 3,    ///< the comparison of one side or both (stages/stencil_packets.hpp)
  stencil_update = 7   ///< the update of the stored value, likewise
};

/// Whether it is a register of the texture unit.
[[nodiscard]] constexpr bool is_of_texture(StateRegister which) { return which <= StateRegister::texture_lines; }

/// Whether the counters count it; clears and flushes are the host's own.
[[nodiscard]] constexpr bool is_counted(PrimitiveKind kind) {
  return kind == PrimitiveKind::triangle || kind == PrimitiveKind::point || kind == PrimitiveKind::line;
}

/// Whether it visits no tile on its way to depth_test.
[[nodiscard]] constexpr bool is_token(PrimitiveKind kind) { return (static_cast<unsigned>(kind) & 2U) != 0; }

/// Effect of the end of a tile visit on the tile's HiZ bound.
enum class HizUpdate : std::uint8_t { none, set, clear };

/// Buffers of a tile in memory; and the flags of its cleared blocks, written by a flush. With compress.unit also the
/// colours of blocks with one per pixel, and the flags of these blocks.
enum class TilePlane : std::uint8_t { depth, color, depth_flags, color_flags, pixel_color = 5, pixel_flags = 7 };
inline constexpr std::array kTilePlanes{TilePlane::depth, TilePlane::color};

/// Source of a stamp's stored depths; also of its stored colours, for colour operations.
enum class DepthSource : std::uint8_t {
  none,    ///< no read: `always`, with a full mask; operations that store the fragment's colour
  chip,    ///< on the chip
  clear,   ///< the last fast clear's value
  memory,  ///< a read
};

/// An enum in the generated package: `depth_func_t` with DEPTH_FUNC_NEVER and so on; its values are kEnumerators.
template <class Enum>
struct WireEnum;  // name; width
template <>
struct WireEnum<PrimitiveKind> {
  static constexpr std::string_view name = "primitive_kind";
  static constexpr Width Widths::*width = &Widths::kind;
};
template <>
struct WireEnum<StateRegister> {
  static constexpr std::string_view name = "state_register";
  static constexpr Width Widths::*width = &Widths::depth_func;  // in whose place it stands
};
/// In the order of the units that have them.
template <>
inline constexpr std::array<Enumerator<StateRegister>, 8> kEnumerators<StateRegister>{
    {{StateRegister::texture, "texture"},
     {StateRegister::texture_levels, "texture_levels"},
     {StateRegister::texture_lines, "texture_lines"},
     {StateRegister::color_ops, "color_ops"},
     {StateRegister::blend_constant, "blend_constant"},
     {StateRegister::alpha_test, "alpha_test"},
     {StateRegister::stencil_test, "stencil_test"},
     {StateRegister::stencil_update, "stencil_update"}}};
template <>
struct WireEnum<DepthFunc> {
  static constexpr std::string_view name = "depth_func";
  static constexpr Width Widths::*width = &Widths::depth_func;
};
template <>
struct WireEnum<Cull> {
  static constexpr std::string_view name = "cull_mode";
  static constexpr Width Widths::*width = &Widths::cull_mode;
};
template <>
struct WireEnum<HizUpdate> {
  static constexpr std::string_view name = "hiz_update";
  static constexpr Width Widths::*width = &Widths::hiz_update;
};
template <>
struct WireEnum<TilePlane> {
  static constexpr std::string_view name = "tile_plane";
  static constexpr Width Widths::*width = &Widths::tile_plane;
};
template <>
struct WireEnum<DepthSource> {
  static constexpr std::string_view name = "depth_source";
  static constexpr Width Widths::*width = &Widths::depth_source;
};

/// A rectangle of pixels, inclusive; empty when left > right or top > bottom.
struct PixelBox {
  PACKET(PixelBox, "pixel_box");
  FIELD(std::uint16_t, left, &Widths::pixel_x)
  FIELD(std::uint16_t, top, &Widths::pixel_y)
  FIELD(std::uint16_t, right, &Widths::pixel_x)
  FIELD(std::uint16_t, bottom, &Widths::pixel_y)
  PACKET_END
};

/// The same inside one tile, from its first pixel.
struct TileBox {
  PACKET(TileBox, "tile_box");
  FIELD(std::uint8_t, left, &Widths::tile_pixel)
  FIELD(std::uint8_t, top, &Widths::tile_pixel)
  FIELD(std::uint8_t, right, &Widths::tile_pixel)
  FIELD(std::uint8_t, bottom, &Widths::tile_pixel)
  PACKET_END
};

/// The states that travel with a primitive.
struct PrimitiveState {
  PACKET(PrimitiveState, "primitive_state");
  FIELD(DepthFunc, depth_test,
        &Widths::depth_func)  ///< for a fast clear or a flush: drops_depth(), clears_bin(); for a state: register
  FIELD(bool, depth_write, &Widths::flag)                             ///< for a fast clear: clears depth
  FIELD(bool, color_write, &Widths::flag)                             ///< likewise
  FIELD(bool, tests_stencil, &Widths::flag, &Widths::stencil_flags)   ///< the stored stencil is read, or changes
  FIELD(bool, writes_stencil, &Widths::flag, &Widths::stencil_flags)  ///< it may change, on a side and for some sample
  FIELD(bool, marks_failed, &Widths::flag, &Widths::stencil_flags)    ///< also where a sample fails one of the tests
  FIELD(bool, is_back, &Widths::flag, &Widths::stencil_flags)  ///< set for a triangle that shows its back, from cull on
  FIELD(std::uint8_t, masked_samples, &Widths::masked_samples, &Widths::has_samples)  ///< per pixel: not drawn
  PACKET_END
  [[nodiscard]] constexpr bool writes() const { return depth_write || color_write; }
  /// Whether a stored depth may change, or the stencil above it.
  [[nodiscard]] constexpr bool writes_word() const { return depth_write || writes_stencil; }
  /// For a fast clear: depth of blocks evicted before the next fast clear or flush is lost. For a flush: depth of the
  /// blocks on the chip, and depth flags are not written. Only in a framebuffer of blocks.
  [[nodiscard]] constexpr bool drops_depth() const { return depth_test == DepthFunc::never; }
  /// For a fast clear of colours only, after a flush: clears the bin with its last tile.
  [[nodiscard]] constexpr bool clears_bin() const { return depth_test == DepthFunc::equal; }
};

/// The owner of a tile packet.
struct TileKey {
  PACKET(TileKey, "tile_key");
  FIELD(std::uint32_t, primitive_id, &Widths::primitive_id)  ///< Triangle::primitive modulo 2^key.primitive_bits
  FIELD(std::uint16_t, tile_x, &Widths::tile_x)              ///< tiles
  FIELD(std::uint16_t, tile_y, &Widths::tile_y)
  PACKET_END
};

/// Three vertices, and the codes of each.
struct TriangleVertices {
  PACKET(TriangleVertices, "triangle_vertices");
  using Coordinates = std::array<std::int32_t, 3>;
  using Codes = std::array<PerPlane<std::uint32_t>, 3>;
  FIELD(Coordinates, x, &Widths::coordinate)
  FIELD(Coordinates, y, &Widths::coordinate)
  FIELD(Codes, code, &AttributeWidths::code)
  PACKET_END
};

/// The range of the vertices' codes, to which the final codes are clamped.
struct CodeRange {
  PACKET(CodeRange, "code_range");
  FIELD(PerPlane<std::uint32_t>, low, &AttributeWidths::affine_code)
  FIELD(PerPlane<std::uint32_t>, high, &AttributeWidths::affine_code)
  PACKET_END
};

/// The format of a triangle's texture coordinates u and v, and its colours over w (stages/perspective.hpp), and its
/// fog. Only with a texture unit.
struct CoordinateFrame {
  PACKET(CoordinateFrame, "coordinate_frame");
  using Pair = std::array<std::int32_t, 2>;
  FIELD(Pair, shift, &Widths::coordinate_shift, &Widths::coordinates)  ///< c = 1 + x - sp - k_P: P goes right by e + c
  FIELD(Pair, reach, &Widths::coordinate_reach, &Widths::coordinates)  ///< x
  FIELD(Pair, origin, &Widths::coordinate_reference, &Widths::coordinates)  ///< u_ref, texels: wrapped_reference()
  FIELD(std::int32_t, fog_octave, &Widths::fog_octave,
        &Widths::fog_octaves)  ///< octave of Q = 1 in a fog's table
  using Channels = std::array<std::int32_t, 4>;
  FIELD(bool, divides_colors, &Widths::flag, &Widths::has_colors_over_w)      ///< P over Q, not the affine codes
  FIELD(Channels, color_shift, &Widths::color_shift, &Widths::colors_over_w)  ///< c and x of each
  FIELD(Channels, color_reach, &Widths::color_reach, &Widths::colors_over_w)
  PACKET_END
  bool operator==(const CoordinateFrame&) const = default;
};

/// Addresses of the buffers in memory, chosen by the host: bytes. Constant while anything is under way. Bases of tiles
/// and the stride are multiples of a tile's buffer, flag strides of a row of flags (MemoryGrid); lower bits count as
/// 0.
struct MemoryLayout {
  PACKET(MemoryLayout, "memory_layout");
  FIELD(std::uint32_t, depth_base, &Widths::address)
  FIELD(std::uint32_t, color_base, &Widths::address)
  FIELD(std::uint32_t, depth_flags_base, &Widths::address)
  FIELD(std::uint32_t, color_flags_base, &Widths::address)
  FIELD(std::uint32_t, row_stride, &Widths::row_stride)  ///< from one row of tiles to the next
  PACKET_END
  bool operator==(const MemoryLayout&) const = default;
};

/// One value for each edge of a triangle.
using EdgeValues = std::array<std::int64_t, 3>;
using EdgeDeltas = std::array<std::int32_t, 3>;
using EdgeLows = std::array<std::uint16_t, 3>;

/// Colours of a vertex or a sample, 8 bits a channel, R lowest: the input of a texture unit, upstream of rop.
[[nodiscard]] constexpr std::uint32_t vertex_color(const PerPlane<std::uint32_t>& code, const Widths& widths) {
  std::uint32_t color = 0;
  for (int c = widths.color_planes - 1; c >= 0; --c)
    color = color << 8 | code[kColorPlane + static_cast<std::size_t>(c)];
  return color;
}

// ------------------------------------------------------------------------------------------------------------- the packets

/// host -> cull: a snapped primitive, its vertices in the given order.
struct PrimitivePacket {
  PACKET(PrimitivePacket, "primitive_packet");
  FIELD(PrimitiveKind, kind, &Widths::kind)
  FIELD(std::uint32_t, primitive_id, &Widths::primitive_id)
  FIELD(PixelBox, box, Nested{})  ///< the scissor, inside the target
  FIELD(PrimitiveState, state, Nested{})
  FIELD(Cull, cull, &Widths::cull_mode)
  FIELD(bool, front_cw, &Widths::flag)  ///< clockwise is the front
  FIELD(TriangleVertices, vertex, Nested{})
  FIELD(CoordinateFrame, coordinates, Nested{})
  PACKET_END
};

/// cull -> triangle_setup: a triangle with the right facing and a pixel centre in its box, in canonical order.
struct TrianglePacket {
  PACKET(TrianglePacket, "triangle_packet");
  FIELD(PrimitiveKind, kind, &Widths::kind)
  FIELD(std::uint32_t, primitive_id, &Widths::primitive_id)
  FIELD(PixelBox, box, Nested{})  ///< pixel centres of the triangle inside the scissor
  FIELD(PrimitiveState, state, Nested{})
  FIELD(TriangleVertices, vertex, Nested{})
  FIELD(CoordinateFrame, coordinates, Nested{})
  FIELD(std::uint64_t, area, &Widths::area)           ///< twice the area, square subpixels; 0 for other kinds
  FIELD(EdgeValues, edge_value, &Widths::edge_value)  ///< at the first pixel of the first tile; 0 for other kinds
  FIELD(EdgeLows, edge_low, &Widths::edge_low, &Widths::edge_lows)  ///< edge_low() of each; likewise
  PACKET_END
};

/// triangle_setup -> coarse_raster: all constants of the primitive.
struct SetupPacket {
  PACKET(SetupPacket, "setup_packet");
  FIELD(PrimitiveKind, kind, &Widths::kind)
  FIELD(std::uint32_t, primitive_id, &Widths::primitive_id)
  FIELD(PixelBox, box, Nested{})
  FIELD(PrimitiveState, state, Nested{})
  FIELD(EdgeDeltas, dx, &Widths::delta)  ///< of each edge, subpixels; 0 for other kinds than triangles
  FIELD(EdgeDeltas, dy, &Widths::delta)
  FIELD(EdgeValues, edge_value, &Widths::edge_value)  ///< edge_function at the first pixel of the first tile
  FIELD(EdgeLows, edge_low, &Widths::edge_low, &Widths::edge_lows)  ///< its dropped bits
  FIELD(PerPlane<std::int64_t>, value, &AttributeWidths::plane)     ///< Plane::value + plane_bias()
  FIELD(PerPlane<std::int64_t>, step_x, &AttributeWidths::plane)    ///< per subpixel
  FIELD(PerPlane<std::int64_t>, step_y, &AttributeWidths::plane)
  FIELD(CodeRange, range, Nested{})
  FIELD(CoordinateFrame, coordinates, Nested{})
  PACKET_END
};

/// The part of a primitive's constants that waits in the context RAM, by slot, until its stamps come to interpolate.
struct ContextPacket {
  PACKET(ContextPacket, "context_packet");
  FIELD(PrimitiveState, state, Nested{})
  FIELD(PerPlane<std::int64_t>, step_x, &AttributeWidths::step)  ///< LocalPlane steps
  FIELD(PerPlane<std::int64_t>, step_y, &AttributeWidths::step)
  FIELD(CodeRange, range, Nested{})
  FIELD(CoordinateFrame, coordinates, Nested{})
  PACKET_END
};

/// coarse_raster -> fine_raster: one tile of one primitive, or (is_visit = 0) only the end of a primitive.
struct TilePacket {
  PACKET(TilePacket, "tile_packet");
  FIELD(PrimitiveKind, kind, &Widths::kind)
  FIELD(bool, is_visit,
        &Widths::flag)  ///< 0: no tile; fast clears, flushes, and primitives whose last tile was skipped
  FIELD(bool, ends_primitive, &Widths::flag)         ///< the last packet of this primitive
  FIELD(TileKey, key, Nested{})                      ///< without a visit: the last tile of the box
  FIELD(std::uint8_t, slot, &Widths::slot)           ///< context RAM slot of the triangle's constants
  FIELD(TileBox, box, Nested{})                      ///< pixels of the tile inside box and scissor
  FIELD(bool, is_inside, &Widths::flag)              ///< trivially accepted: every sample of the box is covered
  FIELD(EdgeDeltas, edge_value, &Widths::tile_edge)  ///< at the tile's first pixel, saturated (coarse_raster.hpp)
  FIELD(PerPlane<std::int64_t>, anchor, &AttributeWidths::local)  ///< LocalPlane::anchor
  PACKET_END
};

/// The part of a triangle's constants that fine_raster reads: the increments of each edge value per pixel.
struct EdgeContext {
  PACKET(EdgeContext, "edge_context");
  FIELD(EdgeDeltas, step_x, &Widths::edge_step)                ///< -dy: per pixel to the right
  FIELD(EdgeDeltas, step_y, &Widths::edge_step)                ///< dx: per pixel down
  FIELD(EdgeLows, low, &Widths::edge_low, &Widths::edge_lows)  ///< bits below the values
  PACKET_END
};

/// fine_raster -> interpolate: one stamp. Sent when a sample is covered or when it ends a visit or primitive.
struct StampPacket {
  PACKET(StampPacket, "stamp_packet");
  FIELD(PrimitiveKind, kind, &Widths::kind)
  FIELD(bool, ends_visit, &Widths::flag)      ///< the last of its tile visit
  FIELD(bool, ends_primitive, &Widths::flag)  ///< the last of its primitive
  FIELD(TileKey, key, Nested{})
  FIELD(std::uint8_t, slot, &Widths::slot)
  FIELD(std::uint16_t, stamp, &Widths::stamp_index)                     ///< row-major number of the stamp in its tile
  FIELD(SampleMask, mask, &Widths::sample_mask)                         ///< covered samples
  FIELD(SampleMask, centre, &Widths::pixel_mask, &Widths::has_samples)  ///< pixels whose centre is covered
  FIELD(PerPlane<std::int64_t>, anchor, &AttributeWidths::local)
  PACKET_END
};

/// interpolate -> primitive_join -> depth_test: a stamp with its attributes. Samples that are not covered carry values too.
struct FragmentPacket {
  PACKET(FragmentPacket, "fragment_packet");
  using Codes = std::array<PerPlane<std::uint32_t>, kMaxSamples>;
  FIELD(PrimitiveKind, kind, &Widths::kind)
  FIELD(bool, ends_visit, &Widths::flag)
  FIELD(bool, ends_primitive, &Widths::flag)
  FIELD(TileKey, key, Nested{})
  FIELD(std::uint16_t, stamp, &Widths::stamp_index)
  FIELD(SampleMask, mask, &Widths::sample_mask)
  FIELD(PrimitiveState, state, Nested{})
  FIELD(CoordinateFrame, coordinates, Nested{})
  FIELD(std::uint32_t, least_color, &Widths::vertex_color, &Widths::has_colors_over_w)     ///< range of the
  FIELD(std::uint32_t, greatest_color, &Widths::vertex_color, &Widths::has_colors_over_w)  ///< quotients, R lowest
  using Depths = std::array<std::uint32_t, kMaxSamples>;
  FIELD(Depths, further_depth, &Widths::further_depth,
        &Widths::further_samples)  ///< depths of all samples but the first of each pixel
  FIELD(Codes, code, &AttributeWidths::fragment,
        &Widths::pixels)  ///< of each pixel: clamped codes, local Q and P; its depth
                          ///< is that of its first sample
  PACKET_END
};

[[nodiscard]] inline std::uint32_t fragment_depth(const FragmentPacket& fragment, std::size_t s, const Widths& widths) {
  if (widths.has_samples == 0) return fragment.code[s][kDepthPlane];
  const auto n = static_cast<std::size_t>(widths.pixel_samples);
  const auto pixel = static_cast<std::size_t>(widths.stamps.pixel_number(static_cast<int>(s)));
  const std::size_t k = s & (n - 1);
  return k == 0 ? fragment.code[pixel][kDepthPlane] : fragment.further_depth[pixel * (n - 1) + k - 1];
}

/// The codes of the pixel of sample `s`. Their depth is that of its first sample.
[[nodiscard]] inline const PerPlane<std::uint32_t>& fragment_code(const FragmentPacket& fragment, std::size_t s,
                                                                  const Widths& widths) {
  return fragment.code[static_cast<std::size_t>(widths.stamps.pixel_number(static_cast<int>(s)))];
}

/// depth_test, rop -> framebuffer: the values to write, and their place; sent for every stamp with a covered sample.
struct WritePacket {
  PACKET(WritePacket, "write_packet");
  using Codes = std::array<std::uint32_t, kMaxSamples>;
  FIELD(TileKey, key, Nested{})
  FIELD(std::uint16_t, stamp, &Widths::stamp_index)
  FIELD(SampleMask, passed, &Widths::sample_mask)  ///< samples that passed the depth test
  FIELD(SampleMask, write_depth,
        &Widths::sample_mask)  ///< samples of these to write; and samples whose stencil changes
  FIELD(SampleMask, write_color, &Widths::sample_mask)
  FIELD(Codes, depth, &Widths::stored_depth,
        &Widths::samples)  ///< stored words; for samples that are not written, the fragment's codes
  FIELD(Codes, color, &Widths::written_color,
        &Widths::samples)  ///< stored code, or the colour before the texture or the blend; likewise
  PACKET_END
};

/// depth_test -> coarse_raster: a tile visit has retired.
struct RetirePacket {
  PACKET(RetirePacket, "retire_packet");
  FIELD(TileKey, key, Nested{})
  FIELD(HizUpdate, update, &Widths::hiz_update)
  FIELD(std::uint32_t, hiz_code, &Widths::hiz_code)  ///< the bound for `set`, all ones for `clear`, 0 for `none`
  PACKET_END
};

/// host -> line_raster: a line with at least one pixel inside the scissor; the output of line_setup
/// (host/line_setup.hpp). The states travel with the line's place in program order, a PrimitivePacket of kind line.
struct LineSetup {
  PACKET(LineSetup, "line_setup");
  FIELD(std::uint32_t, primitive_id, &Widths::primitive_id)  ///< number of the PrimitivePacket; left at 0 by setup_line
  FIELD(std::int32_t, x, &Widths::pixel_x)  ///< the first pixel; inside the target when it goes to the RTL
  FIELD(std::int32_t, y, &Widths::pixel_y)
  FIELD(bool, is_x_major, &Widths::flag)     ///< every step changes x
  FIELD(bool, is_x_negative, &Widths::flag)  ///< x decreases
  FIELD(bool, is_y_negative, &Widths::flag)  ///< likewise y
  FIELD(bool, is_before_start,
        &Widths::flag)  ///< the first pixel's centre lies before the start: it shows the start's codes
  FIELD(std::uint32_t, remaining, &Widths::line_count)  ///< pixels after the first
  FIELD(std::int64_t, error, &Widths::line_error)       ///< p: >= 0 when the next pixel lies in the next row
  FIELD(std::int64_t, step_stay, &Widths::line_stay)    ///< d, added to p after a step along the major axis only
  FIELD(std::int64_t, step_move, &Widths::line_move)    ///< d - D, added to p after a step along both
  FIELD(PerPlane<std::uint64_t>, value,
        &AttributeWidths::line)  ///< 2^-G' LSB at the first pixel's major coordinate, plus 1/2 LSB
  FIELD(PerPlane<std::uint64_t>, step, &AttributeWidths::line)          ///< per pixel
  FIELD(PerPlane<std::uint32_t>, start, &AttributeWidths::affine_code)  ///< codes of the start
  PACKET_END
};

/// line_raster -> primitive_join: one covered pixel.
struct LinePixel {
  PACKET(LinePixel, "line_pixel");
  FIELD(std::uint32_t, primitive_id, &Widths::primitive_id)
  FIELD(std::int32_t, x, &Widths::pixel_x)
  FIELD(std::int32_t, y, &Widths::pixel_y)
  FIELD(bool, is_last, &Widths::flag)  ///< the line ends here
  FIELD(PerPlane<std::uint32_t>, code, &AttributeWidths::affine_code)
  PACKET_END
  bool operator==(const LinePixel&) const = default;
};

/// framebuffer -> memory_port: a write of one stamp of one buffer, or a read of `run` of them, one response each.
/// Requests go in program order; reads are answered in the same order. A run is consecutive in memory
/// (stages/memory_port.hpp) and is one burst: its writes follow each other, each with the number of stamps left. A word
/// of flags is bits of `data`, flag n of the word bit n; words lie in rows of blocks: word n of block row y is
/// addressed as tile_x n and stamp y modulo BlockGrid::per_tile of tile_y.
struct MemoryRequest {
  PACKET(MemoryRequest, "memory_request");
  using Lanes = std::array<std::uint32_t, kMaxSamples>;
  FIELD(bool, is_write, &Widths::flag)
  FIELD(TilePlane, plane, &Widths::tile_plane)
  FIELD(std::uint16_t, tile_x, &Widths::tile_x)
  FIELD(std::uint16_t, tile_y, &Widths::tile_y)
  FIELD(std::uint16_t, stamp, &Widths::stamp_index)
  FIELD(std::uint16_t, run, &Widths::run)                     ///< stamps or words left in its burst, including this one
  FIELD(SampleMask, strobe, &Widths::sample_mask)             ///< the samples to write; 0 for a read
  FIELD(Lanes, data, &Widths::memory_lane, &Widths::samples)  ///< one code per sample; 0 if not written
  PACKET_END
};

/// memory_port -> framebuffer: a stamp that was read.
struct MemoryResponse {
  PACKET(MemoryResponse, "memory_response");
  FIELD(MemoryRequest::Lanes, data, &Widths::memory_lane, &Widths::samples)
  PACKET_END
};

/// memory_port -> memory: a beat of a write burst, or a whole read burst. Bursts lie in one buffer of one tile or in
/// one row of flags, and their bytes are consecutive.
struct MemoryBeat {
  PACKET(MemoryBeat, "memory_beat");
  using Bytes = std::array<std::uint8_t, kMaxPortBytes>;
  FIELD(bool, is_write, &Widths::flag)
  FIELD(bool, is_first, &Widths::flag)                         ///< a burst begins
  FIELD(std::uint32_t, address, &Widths::address)              ///< of its first byte; a multiple of the port's bytes
  FIELD(std::uint16_t, length, &Widths::burst_length)          ///< beats left in the burst, including this one
  FIELD(std::uint64_t, strobe, &Widths::port_strobe)           ///< the bytes to write; 0 for a read
  FIELD(Bytes, data, &Widths::port_byte, &Widths::port_bytes)  ///< 0 for bytes that are not written
  PACKET_END
};

/// memory -> memory_port: a beat that was read, or the acknowledgement of a written burst. In the order of the bursts.
struct MemoryAnswer {
  PACKET(MemoryAnswer, "memory_answer");
  FIELD(bool, is_write, &Widths::flag)
  FIELD(MemoryBeat::Bytes, data, &Widths::port_byte, &Widths::port_bytes)  ///< 0 for a write
  PACKET_END
};

/// texture_unit -> texture_memory: a read of a line of 4x4 texels.
struct TextureRequest {
  PACKET(TextureRequest, "texture_request");
  FIELD(std::uint32_t, address, &Widths::address)      ///< bytes
  FIELD(std::uint16_t, beats, &Widths::texture_beats)  ///< number of beats
  PACKET_END
};

/// texture_memory -> texture_unit: a beat of a line, in the order of the requests.
struct TexelBeat {
  PACKET(TexelBeat, "texel_beat");
  using Bytes = std::array<std::uint8_t, 8>;
  FIELD(Bytes, data, &Widths::texture_byte, &Widths::texture_port_bytes)
  PACKET_END
};

/// texture_unit, rop -> framebuffer: the colours of a stamp with any live sample; of other samples 0.
struct ColorPacket {
  PACKET(ColorPacket, "color_packet");
  /// Samples whose colour is written, or read by the alpha test; of several in a pixel all, if one is.
  FIELD(SampleMask, mask, &Widths::sample_mask)
  FIELD(WritePacket::Codes, color, &Widths::shaded_color,
        &Widths::samples)  ///< stored code, or the colour before blending or dithering; 0 for other samples
  PACKET_END
};

/// The performance counters of the hardware: items since reset; the RTL has them modulo
/// 2^counters.bits. Names as in Counters (counters.hpp).
struct CounterPacket {
  PACKET(CounterPacket, "counter_packet");
  FIELD(bool, overflow, &Widths::flag)                   ///< a counter has exceeded its width in the RTL
  FIELD(std::uint64_t, primitives_in, &Widths::counter)  ///< triangles, points and lines that came to cull
  FIELD(std::uint64_t, zero_area, &Widths::counter)
  FIELD(std::uint64_t, backface, &Widths::counter)
  FIELD(std::uint64_t, empty, &Widths::counter)
  FIELD(std::uint64_t, no_sample, &Widths::counter)  ///< small triangles, by the pipelined cull
  FIELD(std::uint64_t, tiles_visited, &Widths::counter)
  FIELD(std::uint64_t, tiles_outside, &Widths::counter)
  FIELD(std::uint64_t, trivially_accepted, &Widths::counter)
  FIELD(std::uint64_t, tiles_hiz, &Widths::counter)
  FIELD(std::uint64_t, samples_tested, &Widths::counter)
  FIELD(std::uint64_t, covered, &Widths::counter)
  FIELD(std::uint64_t, depth_passed, &Widths::counter)
  FIELD(std::uint64_t, written, &Widths::counter)
  FIELD(std::uint64_t, tile_fills,
        &Widths::counter)  ///< stamps read, like the next two; with blending colours too
  FIELD(std::uint64_t, tile_evictions, &Widths::counter)
  FIELD(std::uint64_t, tile_clears, &Widths::counter)  ///< clears of depth only
  /// Only with a texture unit: samples looked up, samples whose lines were all in the cache, lines requested.
  FIELD(std::uint64_t, texture_samples, &Widths::counter, &Widths::texture_counters)
  FIELD(std::uint64_t, texture_hits, &Widths::counter, &Widths::texture_counters)
  FIELD(std::uint64_t, texture_fills, &Widths::counter, &Widths::texture_counters)
  FIELD(std::uint64_t, alpha_killed, &Widths::counter, &Widths::alpha_counters)  ///< only with the alpha test
  PACKET_END
};

#undef PACKET
#undef FIELD
#undef PACKET_END

}  // namespace halfplane
