// Constants of one triangle's surface, as lanes take them: the planes of surface.hpp, whose values wrap in 32 bits, and
// the access to a texture. Made only for triangles that a bin has found visible.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include "../../binary64.hpp"
#include "../../stages/multisample.hpp"
#include "../../stages/surface.hpp"
#include "frame.hpp"
#include "texel_blocks.hpp"

namespace halfplane::functional {

/// Format of binary32.
inline constexpr int kFloatFraction = 23, kFloatBias = 127;

/// The surface of a record, through the stages. `place`: kAtCentre, or a sample of pixels. `has_planes`: false leaves out what
/// lanes compute for themselves, the setup's edges and affine planes.
struct StageSurface {
  StageSurface(const FrameContext& frame, const Slice& slice, const Record& record, int place, bool has_planes);
  StageSurface(const StageSurface&) = delete;
  StageSurface& operator=(const StageSurface&) = delete;

  Triangle triangle;
  TriangleSetup setup;
  Surface surface;  ///< surface of that setup
};

/// A plane over w, 2^-l codes, in the upper bits of a lane: it wraps by overflow.
struct LanePlane {
  std::uint64_t at_zero = 0;             ///< at the anchor of the target's first tile, 2^-F codes, with rounding term
  std::uint64_t tile_x = 0, tile_y = 0;  ///< from tile to tile
  std::int32_t step_x = 0, step_y = 0;   ///< per pixel
  int drop = 0;                          ///< F - l
  int up = 0;                            ///< bits below the plane in a lane

  /// At the anchor of a tile of the target.
  [[nodiscard]] std::int32_t anchor(int x, int y) const {
    const std::uint64_t value = at_zero + tile_x * static_cast<std::uint64_t>(std::int64_t{x}) +
                                tile_y * static_cast<std::uint64_t>(std::int64_t{y});
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(value >> drop) << up);
  }
};

/// Constants of the division by Q.
struct LaneDivision {
  int up;                      ///< bits below Q in a lane
  std::int32_t mantissa_mask;  ///< in binary32: the k highest bits of a number without the first
  std::int32_t middle;         ///< the bit after them, and the exponent of 1
  int to_divisor;              ///< from d 2^-k in binary32 to d
  float power;                 ///< 2^k
  std::int32_t whole;          ///< 2^(2k) modulo 2^32

  explicit LaneDivision(const PerspectiveFormat& format);
};

/// Format of P for one kind of attribute. A product Pn r is computed in two parts, with the upper and the lower bits of
/// r.
struct LaneOverW {
  int up;                        ///< bits below P in a lane
  std::int32_t lowest, highest;  ///< range of Pn
  int split;                     ///< lower bits of r
  std::int32_t lower_bits;       ///< mask of these bits

  LaneOverW(const OverWFormat& attribute, const PerspectiveFormat& format);
};

/// An attribute: P, and its shifts.
struct LaneAttribute {
  LanePlane p;
  int narrow = 0;         ///< from Q's exponent in binary32 to the bits that a lane of P drops, less one for rounding
  bool may_gain = false;  ///< whether P itself may drop less than one bit, and gain some
  bool is_tame = false;   ///< at covered pixels P drops 1 to 31 bits of a lane, and no Pn is clamped
  int drop = 1;           ///< bits that the upper part of Pn r drops, at least 1
  std::int32_t half = 1;  ///< half a unit of that
};

/// Attributes over one Q.
template <std::size_t N>
struct LaneQuotients {
  LanePlane q;
  std::array<LaneAttribute, N> attribute{};
};

/// Access to a texture whose sides are powers of two.
struct LaneTexture {
  const void* texels = nullptr;              ///< TexelBlocks
  const TexelBlocks::Quad* quads = nullptr;  ///< if present
  std::array<std::int32_t, TexelBlocks::kLevels> first{};
  std::array<int, 2> bits{};                ///< log2 of its sides
  std::array<std::int32_t, 2> last{};       ///< last texel along them
  int pitch = 0;                            ///< from a column's number, without the two lowest bits, to its place
  std::array<TextureWrap, 2> wrap{};        ///< clamp where there is a border
  std::array<std::int32_t, 2> reference{};  ///< u_ref, 2^-8 texels
  int up = 0;                               ///< from a coordinate to 2^-8 texels
  TextureMin min = TextureMin::nearest;
  TextureMag mag = TextureMag::nearest;
  int last_level = 0;
  LodSetup lod;
  Lod bias = 0, least = 0, largest = 0;
  Lod magnified = 0;  ///< up to this lambda mag applies
  TextureCombine combine = TextureCombine::modulate;
  bool has_alpha = false;
  std::array<std::int32_t, 2> constant{};                  ///< of blend: red and blue, green, in the halves of a lane
  const std::uint32_t* alpha_quads = nullptr;              ///< alphas of TexelBlocks, if present and without a border
  const TexelBlocks::AlphaRanges* alpha_ranges = nullptr;  ///< alpha ranges of level 0, likewise
  std::array<TextureWrap, 2> beyond{};                     ///< wraps as given
  bool has_border = false;                                 ///< along u or v
  std::int32_t border = 0;                                 ///< R lowest
  std::array<std::int32_t, 2> margin{};                    ///< coordinates_margin(), 2^-8 texels
};

/// How much of sample() is needed.
enum class Sampling { none, nearest, linear, any };
[[nodiscard]] inline Sampling sampling_of(const LaneTexture& texture) {
  const bool is_nearest = texture.min == TextureMin::nearest && texture.mag == TextureMag::nearest;
  if (is_nearest) return texture.has_border ? Sampling::any : Sampling::nearest;
  if (texture.min == TextureMin::linear && texture.mag == TextureMag::linear) return Sampling::linear;
  return Sampling::any;
}

/// Bound: how far a coordinate in a tile may lie below (above) the least (the greatest) coordinate of its corners, 2^-8
/// texels, if all four are covered. P and Q are linear over the pixels, so P / Q has its extremes in corners, as Q > 0.
/// The error at a pixel is less than 2^x (2^(2-k) + 2^(1-k_P)), for the reciprocal and for Pn, and 2^-f for the last
/// rounding; twice that, and a last bit each.
[[nodiscard]] inline std::int32_t coordinates_margin(int reach, const PerspectiveFormat& format) {
  const int k = format.mantissa_bits, narrow = format.coordinate.narrow_bits;
  const double off = power_of_two(reach) * (power_of_two(2 - k) + power_of_two(1 - narrow)) +
                     power_of_two(-format.coordinate.fraction_bits);
  return static_cast<std::int32_t>(std::ceil(2 * off * (1 << kTexelFraction))) + 2;
}

/// Constants of a texture and its sampler. `combine`: with the primitive's colour, blend with `constant`;
/// `fraction_bits`: of a coordinate.
[[nodiscard]] LaneTexture texture_lanes(const Sampler& sampler, const TexelBlocks& texels, TextureCombine combine,
                                        const std::array<std::uint8_t, 3>& constant, int fraction_bits);

/// Numerators of gradients over w that lanes multiply, in magnitude below 2^46.
inline constexpr int kMostNumeratorBits = 46;

/// Constants common to the surfaces of a draw, where lanes set up sixteen surfaces at a time and shade pixels of any of
/// them: one texture, and colours that are affine or over the same w as its coordinates; or such colours alone.
struct SurfaceStyle {
  SurfaceStyle(const FrameContext& frame, const DrawContext& draw);

  const DrawContext* context;
  bool is_in_lanes = false;  ///< false: the other members are unused
  Sampling sampling = Sampling::none;
  bool is_affine = false;  ///< w does not change coordinates
  bool is_color_over_w = false;
  bool is_tame = true;               ///< the coordinates of all surfaces set up so far are tame: LaneAttribute
  bool may_gain = false;             ///< a channel over w of one of them may: LaneAttribute
  std::array<double, 2> size{1, 1};  ///< texels along the texture's sides
  PerspectiveFormat format;
  LaneDivision division;
  LaneOverW of_coordinate, of_color;
  LaneTexture texture;
};

/// Lookup of a fog table, from Q in binary32 whose exponent and upper mantissa are one number.
struct LaneFog {
  LanePlane q;
  const FogTable::Line* lines = nullptr;
  std::int32_t first = 0, last = 0;  ///< the exponent and mantissa at the first place; the last place
  int place_bits = 0, drop = 0;      ///< bits of a place in a line; shift from a line's sum to f
  std::array<std::int32_t, 3> color{};
};

/// Light of fragments.
struct LaneLight {
  std::array<LanePlane, 3> normal;
  int up = 0;                          ///< bits below P in a lane
  const FallingLine* roots = nullptr;  ///< table of 1 / sqrt
  const FallingLine* power = nullptr;
  int place_bits = 0, drop = 0;  ///< bits of a place in a power's line; shift from a line's sum to its value
  Normal direction{}, half{};
  std::array<std::int32_t, 3> ambient{}, diffuse{}, specular{};
};

struct SurfaceConstants {
  SurfaceConstants(const StageSurface& from, const FrameContext& frame, const TexelBlocks* texels);

  bool are_in_lanes = true;  ///< the members below are complete
  bool has_texture = false;  ///< false: only the colour counts
  bool has_color = true;     ///< false: only the texture's colour counts, except for lit surfaces
  bool is_color_over_w = false;
  bool has_constant_color = false;  ///< color_low is its colour
  bool has_constant_w = false;      ///< textured, with one w: the level of detail is constant as well
  bool is_upright = false;          ///< upright.inl: one w, u along columns, v along rows, a linear filter
  bool repeats_places = false;      ///< upright, and tiles of one column have the same u, tiles of one row the same v
  bool has_fog = false;
  LaneDivision division;
  LaneOverW of_coordinate, of_color;
  LaneQuotients<2> coordinate;
  LaneQuotients<4> color;
  std::array<std::uint32_t, 4> color_low{}, color_high{};  ///< of the vertices
  LaneTexture texture;
  LaneFog fog;
  std::unique_ptr<const LaneLight> light;  ///< null: not lit

 private:
  void set_color(const StageSurface& from, const Widths& widths);
  void set_texture(const StageSurface& from, const Widths& widths, const TexelBlocks& texels);
  void set_fog(const StageSurface& from, const Widths& widths);
  void set_light(const StageSurface& from, const Widths& widths);
  [[nodiscard]] bool sees_texture_alone(const StageSurface& from) const;
  [[nodiscard]] bool has_one_w() const;
  [[nodiscard]] static bool is_never_held(const OverWFormat& format, const PerspectiveFormat& all, const QCodes& q);
  [[nodiscard]] LaneAttribute attribute_of(const Surface::Attribute& from, const OverWFormat& format,
                                           const LaneOverW& lanes, const Surface::Divisor& divisor,
                                           const StageSurface& surface, const Widths& widths);
};

}  // namespace halfplane::functional
