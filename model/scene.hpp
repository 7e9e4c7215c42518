// The input of the pipeline: vertices, state and draws, in program order. Model, golden and oracle read this type;
// sim/scene makes it from captures, meshes and the built-in scenes.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "formats/texture.hpp"

namespace halfplane {

enum class Space { clip, window };
enum class Topology { triangles, triangle_strip, triangle_fan, lines, line_strip, line_loop, points };
enum class DepthFunc { never, less, lequal, equal, greater, gequal, notequal, always };
enum class Cull { none, back, front, both };
enum class FrontFace { ccw, cw };
/// phong: colours as with smooth, then light at each fragment of filled triangles (State::light_direction).
enum class Shade { smooth, flat, phong };
enum class ColorInterp { affine, perspective };
/// Drawn part of a triangle that is not culled: its samples, its three edges as lines, or its three corners as points.
enum class PolygonMode { fill, line, point };
/// The vertex of a primitive that gives the colour when `shade` is flat.
enum class Provoking { first, last };
/// Shape of a point: the square of its size, or the pixels of the square whose centres lie in the disc.
enum class PointShape { square, round };
/// Clipping of a point whose centre is outside: its pixels only, or the point as a whole.
enum class PointClip { pixel, center };
enum class ClipZ { minus_one_one, zero_one };
/// Position of pixel centres in window coordinates: the first one at 1/2 or at 0.
enum class PixelCenter { half, integer };
/// Origin of window coordinates: top left with y down, or bottom left with y up.
enum class Origin { top_left, bottom_left };
/// Coverage rule of lines; see "Lines" in docs/spec.md. `rectangle`: the samples of a rectangle about the line.
enum class LineRule { midpoint, bresenham, diamond, rectangle };

/// Interpolation of a texture's coordinates over a primitive.
enum class TextureInterp { perspective, affine };
/// Filter where a pixel holds more than one texel, and where it holds less.
enum class TextureMin {
  nearest,
  linear,
  nearest_mipmap_nearest,
  linear_mipmap_nearest,
  nearest_mipmap_linear,
  linear_mipmap_linear
};
enum class TextureMag { nearest, linear };
/// Texels beyond the image: repeated, the last texel, mirrored, or State::texture_border. half_border holds a
/// coordinate in the image, so that a linear filter at its sides mixes half the border, and a nearest one sees none of
/// it. Along u and v.
enum class TextureWrap { repeat, clamp, mirror, border, half_border };
[[nodiscard]] constexpr bool has_border(TextureWrap wrap) {
  return wrap == TextureWrap::border || wrap == TextureWrap::half_border;
}
/// Whether the image comes again; else all far coordinates have the same texel.
[[nodiscard]] constexpr bool has_period(TextureWrap wrap) {
  return wrap == TextureWrap::repeat || wrap == TextureWrap::mirror;
}
/// Combination with the primitive's colour. blend: from that to State::texture_constant, by the texel's channels.
enum class TextureCombine { modulate, replace, decal, add, blend };

/// Density of fog by the distance from the eye.
enum class FogKind { linear, exp, exp2 };

/// Factor of a colour before two are added (OpenGL ES 2.0, table 4.2).
enum class BlendFactor {
  zero,
  one,
  src_color,
  one_minus_src_color,
  dst_color,
  one_minus_dst_color,
  src_alpha,
  one_minus_src_alpha,
  dst_alpha,
  one_minus_dst_alpha,
  constant_color,
  one_minus_constant_color,
  constant_alpha,
  one_minus_constant_alpha,
  src_alpha_saturate
};
/// Combination of the products; min and max take the colours themselves.
enum class BlendEquation { add, subtract, reverse_subtract, min, max };
/// Bitwise operation of a fragment's code s and the stored code d (OpenGL 1.5, table 4.2). The value is its truth table:
/// bit 0 is the result for s = d = 1, bit 1 for s = 1 and d = 0, bit 2 for s = 0 and d = 1, bit 3 for s = d = 0.
enum class LogicOp {
  clear,
  and_op,
  and_reverse,  ///< s & ~d
  copy,
  and_inverted,  ///< ~s & d
  noop,
  xor_op,
  or_op,
  nor,
  equiv,
  invert,
  or_reverse,  ///< s | ~d
  copy_inverted,
  or_inverted,  ///< ~s | d
  nand,
  set
};
/// Update of a stored stencil value.
enum class StencilOp { keep, zero, replace, incr, decr, invert, incr_wrap, decr_wrap };

/// The fraction of a fragment's own colour that remains at a distance w from the eye, 0...1 (OpenGL ES 1.1.12, 3.8).
/// Linear: (end - w) / (end - start), with start at most end * 255/256. exp: e^(-start w), exp2: e^(-(start w)^2), both
/// without `end`.
struct Fog {
  FogKind kind = FogKind::exp;
  double start = 1;  ///< for linear; for the others the density
  double end = 1;
  bool operator==(const Fog&) const = default;
};

/// A fragment is dropped unless its alpha compares so with `reference`.
struct AlphaTest {
  DepthFunc func = DepthFunc::always;
  std::uint8_t reference = 0;
  bool operator==(const AlphaTest&) const = default;
};

/// Source and destination, of the colour and of alpha.
struct BlendFactors {
  BlendFactor src = BlendFactor::one, dst = BlendFactor::zero;
  BlendFactor src_alpha = BlendFactor::one, dst_alpha = BlendFactor::zero;
  bool operator==(const BlendFactors&) const = default;
};

/// The stencil test of one side of triangles. Lines and points have a front.
struct Stencil {
  DepthFunc func = DepthFunc::always;  ///< comparison of (reference & read_mask) with (stored & read_mask)
  std::uint8_t reference = 0, read_mask = 255, write_mask = 255;
  StencilOp stencil_fails = StencilOp::keep, depth_fails = StencilOp::keep, passes = StencilOp::keep;
  bool operator==(const Stencil&) const = default;
};

/// A vertex as given. Clip space: homogeneous clip coordinates, +y up. Window space: x, y in pixels (y down, pixel
/// centres at half-integers, unless its state says otherwise), z in [0, 1], w as the clip-space w.
struct Vertex {
  double x = 0, y = 0, z = 0, w = 1;
  std::array<double, 4> rgba{255, 255, 255, 255};  ///< 0...255
  double u = 0, v = 0;                             ///< 0 to 1 over the texture
};

/// A vertex as numbers, in the order of its members and of a capture's `v` line.
using VertexNumbers = std::array<double, sizeof(Vertex) / sizeof(double)>;
[[nodiscard]] constexpr VertexNumbers numbers_of(const Vertex& v) { return std::bit_cast<VertexNumbers>(v); }
[[nodiscard]] constexpr Vertex vertex_of(const VertexNumbers& numbers) { return std::bit_cast<Vertex>(numbers); }

/// Numbers of a vertex that are given together or not at all.
struct VertexPart {
  std::string_view names;  ///< "r g b a"
  std::size_t end;         ///< the first number after it
  std::string_view what;   ///< name of one of them, in messages
  double low = std::numeric_limits<double>::lowest(), high = std::numeric_limits<double>::max();
};
/// A `v` line ends after one of these parts; the remaining numbers are those of Vertex{}.
inline constexpr std::array kVertexParts{VertexPart{"x y z", 3, "a coordinate"}, VertexPart{"w", 4, "a coordinate"},
                                         VertexPart{"r g b a", 8, "a colour component", 0, 255},
                                         VertexPart{"u v", 10, "a coordinate"}};
static_assert(kVertexParts.back().end == VertexNumbers().size(), "a member of Vertex is in no part");

/// "0...255".
[[nodiscard]] std::string range_of(const VertexPart& part);

/// The first part with a number beyond its bounds, a NaN also; null: all are within.
[[nodiscard]] constexpr const VertexPart* part_out_of_bounds(const VertexNumbers& numbers) {
  std::size_t i = 0;
  for (const VertexPart& part : kVertexParts)
    for (; i < part.end; ++i)
      if (!(numbers[i] >= part.low && numbers[i] <= part.high)) return &part;
  return nullptr;
}

/// A rectangle of whole pixels: column and row of the corner at the state's origin, width, height.
struct Rect {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Rect&) const = default;
};

/// A viewport in the window coordinates of its state: the corner at the origin, width, height. Fractions are allowed.
struct Viewport {
  double x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Viewport&) const = default;
};

/// All state of a draw, without its vertices.
struct State {
  Space space = Space::clip;
  DepthFunc depth_test = DepthFunc::less;
  bool depth_write = true;
  bool color_write = true;
  Cull cull = Cull::none;
  FrontFace front = FrontFace::ccw;  ///< as seen on the screen
  Shade shade = Shade::smooth;       ///< flat: the colour of the provoking vertex; phong: Scene::normals
  Provoking provoking = Provoking::first;
  ColorInterp color_interp = ColorInterp::affine;
  PolygonMode polygon_mode = PolygonMode::fill;
  std::array<double, 2> polygon_offset{0.0, 0.0};  ///< slope factor, constant in depth LSB; see "Polygon offset"
  LineRule line_rule = LineRule::diamond;
  std::optional<bool> line_last;  ///< whether a line's last pixel is drawn; none: by the rule
  double line_width = 1;          ///< pixels, at least 1: across the minor axis, rounded; of a rectangle its true width
  bool smooth = false;            ///< lines with one sample per pixel: the covered area multiplies alpha
  double point_size = 1;          ///< side of the square, pixels, at least 1
  PointShape point_shape = PointShape::square;
  PointClip point_clip = PointClip::pixel;
  ClipZ clip_z = ClipZ::minus_one_one;
  PixelCenter pixel_center = PixelCenter::half;  ///< of window-space vertices and the viewport
  Origin origin = Origin::top_left;              ///< origin of both and of the scissor; `front` is as seen in any case
  std::optional<Rect> scissor;                   ///< none: the whole target
  std::optional<Viewport> viewport;              ///< none: the whole target
  std::array<double, 2> depth_range{0.0, 1.0};
  std::optional<std::uint32_t> texture;  ///< index into Scene::textures; of filled triangles
  TextureInterp texture_interp = TextureInterp::perspective;
  TextureMin texture_min = TextureMin::nearest;
  TextureMag texture_mag = TextureMag::nearest;
  std::array<TextureWrap, 2> texture_wrap{};
  Texel texture_border{};                             ///< of texture_wrap border and half_border
  std::array<double, 3> texture_lod{0.0, 0.0, 12.0};  ///< bias, least and largest level
  TextureCombine texture_combine = TextureCombine::modulate;
  std::array<std::uint8_t, 3> texture_constant{};  ///< of texture_combine blend
  std::optional<Fog> fog;                          ///< none: colours are unchanged
  std::array<std::uint8_t, 3> fog_color{};
  // For shade phong: a fragment of colour C and normal N becomes C (ambient + diffuse N.L) + specular (N.H)^shininess,
  // the highlight where N.L > 0, clamped to 255. L and H may have any length.
  std::array<double, 3> light_direction{0, 0, 1};  ///< L: to the light, in the space of the normals
  std::array<double, 3> light_half{0, 0, 1};       ///< H: between L and the direction to the eye
  std::array<std::uint8_t, 3> light_ambient{51, 51, 51}, light_diffuse{255, 255, 255}, light_specular{};
  double light_shininess = 32;
  AlphaTest alpha_test;
  std::optional<BlendFactors> blend;                       ///< none: the fragment's colour replaces the stored one
  std::array<BlendEquation, 2> blend_equation{};           ///< of colour and of alpha
  std::array<std::uint8_t, 4> blend_color{};               ///< the constant of blend factors
  LogicOp logic_op = LogicOp::copy;                        ///< but for copy: instead of blending, of stored codes
  std::array<bool, 4> color_mask{true, true, true, true};  ///< channels that color_write writes
  std::optional<Stencil> stencil;                          ///< none: no test, no stencil is written
  std::optional<Stencil> stencil_back;                     ///< of triangles that show their back; none: as `stencil`
  bool dither = false;                                     ///< ordered, where a channel has fewer than 8 bits
  // For pixels with several samples; no effect with one.
  std::optional<std::uint32_t> sample_mask;  ///< bit k: sample k is drawn; none: all
  bool alpha_to_coverage = false;            ///< alpha gives the number of samples drawn
  bool operator==(const State&) const = default;
};

/// Among the indices of a draw: ends a strip, fan, loop or list, and begins the next one (primitive restart).
inline constexpr std::uint32_t kRestart = ~0U;

/// Fills colour, depth and stencil inside the scissor of `state`.
struct Clear {
  std::uint32_t state = 0;                       ///< index into Scene::states
  std::optional<std::array<double, 4>> color{};  ///< 0...255
  std::optional<double> depth{};                 ///< window z in [0, 1]: ignores depth_range
  std::optional<std::uint8_t> stencil{};
};

/// A run of indices that share topology, state and object.
struct Draw {
  std::uint32_t state = 0;   ///< index into Scene::states
  std::uint32_t object = 0;  ///< index into Scene::objects
  Topology topology = Topology::triangles;
  std::size_t first = 0;   ///< index of its first entry in Scene::indices
  std::size_t count = 0;   ///< number of entries
  std::uint32_t line = 0;  ///< line in the file it came from, 0 for none: for messages only
  /// Not 0: known to cover no sample (whole-object culling); an engine then only numbers its primitives.
  std::uint8_t outside = 0;
};

/// `frame` in a capture. Buffers keep their contents.
struct EndFrame {};

using Command = std::variant<Clear, Draw, EndFrame>;

inline constexpr int kLargestSide = 16384;      ///< pixels along a side of any target
inline constexpr double kLargestNormal = 1e12;  ///< component of a normal

/// A complete input. validate() checks its invariants; every reader keeps them.
struct Scene {
  /// 0 for a vertex without one.
  [[nodiscard]] std::array<double, 3> normal(std::size_t vertex) const {
    return vertex < normals.size() ? normals[vertex] : std::array<double, 3>{};
  }

  std::string name;
  int width = 640, height = 480;  ///< target, pixels
  /// Near and far for depth mappings, eye-space units, 0 < near < far. None: not specified.
  std::optional<std::array<double, 2>> planes;
  std::vector<Vertex> vertices;
  /// For shade phong: normals of the first vertices, of any length, 0 for none. Later vertices have none: see normal().
  std::vector<std::array<double, 3>> normals;
  std::vector<std::uint32_t> indices;
  std::vector<State> states;
  std::vector<Texture> textures;
  std::vector<std::string> objects{""};
  std::vector<Command> commands;
};

/// "file: draw from line 7", for messages about a draw.
[[nodiscard]] std::string place_of_draw(std::string_view file, std::uint32_t line);

/// Checks everything that readers guarantee and other code may violate: numbers that are finite and in their range
/// (colours 0...255, depths 0...1, states as their table has them), draws inside the indices, indices < vertices.size()
/// or kRestart, states and objects that exist, sides of 1 to kLargestSide pixels. Linear in the scene. Every function
/// of the library that takes a scene calls it. Throws InputError, one line that names the fault and the place.
void validate(const Scene& scene);

}  // namespace halfplane
