// Attributes interpolated over a primitive: the one list of planes. Plane 0 is depth, colours follow.
//
// A plane is authored here and in the snap of its codes (host/viewport.cpp). From this list follow its widths
// (widths.hpp), the arrays in the packets (packets.hpp), the tables and generate loops of the RTL (raster_pkg.hpp), and
// the loops of observer, random scenes and comparison. Planes of one attribute share its widths.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "config.hpp"

namespace halfplane {

/// Whether the attribute itself is linear in the window, or its quotient by w.
enum class Interpolation : std::uint8_t { affine, over_w };
/// The vertex at which a plane starts: the first of the canonical order, or the one with the smallest 1/w.
enum class BaseVertex : std::uint8_t { canonical, smallest_q };
/// The buffer that stores the codes of an attribute.
enum class StoredAs : std::uint8_t { nothing, depth, color };

/// An attribute: one plane, or several with equal properties.
struct Attribute {
  std::string_view name;                 ///< base name of its widths: "depth code", "local depth"
  std::array<std::string_view, 4> part;  ///< names of its planes
  int planes;                            ///< 1 to 4
  int bits;                              ///< bits of a code, with its sign
  std::string_view symbol;               ///< symbol for `bits` in docs/spec.md
  int reciprocal_bits;                   ///< r: significant bits of the reciprocal for its gradients
  int guard_bits;                        ///< l: fraction bits inside a tile
  bool is_signed = false;                ///< the codes have a sign
  bool is_clamped = true;                ///< to the range of the vertices' codes
  Interpolation interpolation = Interpolation::affine;
  BaseVertex base = BaseVertex::canonical;
  StoredAs stored = StoredAs::nothing;
};

inline constexpr int kMaxAttributes = 5, kMaxPlanes = 12;
inline constexpr std::size_t kDepthPlane = 0, kColorPlane = 1;  ///< the first colour: red; then green, blue and alpha

/// Constants of the planes over w in every configuration: l, and the difference in bits between Q and the reciprocal of
/// the area.
inline constexpr int kPerspectiveGuardBits = 4, kPerspectiveReciprocalLess = 2;
/// k_P of a colour over w.
inline constexpr int kColorNarrowBits = 13;

/// N_P of a colour over w: its P has no more bits than Q.
[[nodiscard]] constexpr int color_over_w_bits(const Config& config) { return std::min(config.perspective_bits, 18); }

/// N_P of a normal over w: two bits more than a colour's, and at most as many as Q.
[[nodiscard]] constexpr int normal_over_w_bits(const Config& config) { return std::min(config.perspective_bits, 20); }

/// Codes of a normal, in 2^-15.
using Normal = std::array<std::int32_t, 3>;

/// One value for each plane. Elements from plane_count() on are unused.
template <class T>
using PerPlane = std::array<T, kMaxPlanes>;

/// A plane at one pixel, before and after the final rounding.
struct PlaneSample {
  std::int64_t unrounded = 0;  ///< 2^-l LSB, before rounding and clamp
  std::uint32_t code = 0;
};

/// The attributes of a configuration, in the order of their planes.
struct AttributeList {
  std::array<Attribute, kMaxAttributes> attribute{};
  int attributes = 0;

  [[nodiscard]] constexpr const Attribute* begin() const { return attribute.data(); }
  [[nodiscard]] constexpr const Attribute* end() const { return attribute.data() + attributes; }
  constexpr void add(const Attribute& next) { attribute[static_cast<std::size_t>(attributes++)] = next; }
};

/// Whether a unit reads alpha: rop, if the stored format keeps it, a blend, or a test.
[[nodiscard]] constexpr bool needs_alpha(const Config& config) {
  return config.color_format == ColorFormat::rgba8888 || config.alpha_units != 0 || config.blend_lanes != 0;
}

/// Whether colours are packed only when they are written, because they are blended or dithered there.
[[nodiscard]] constexpr bool packs_at_write(const Config& config) {
  return config.blend_lanes != 0 || config.dither_units != 0;
}

/// Whether the hardware tests alpha. Other hardware with alpha.unit only interpolates it.
[[nodiscard]] constexpr bool tests_alpha(const Config& config) {
  return config.alpha_units != 0 && config.cache_kind == CacheKind::blocks && config.setup_kind == SetupKind::pipelined;
}

/// Whether the hardware lights fragments: in configurations that pass validate(), with shade.unit.
[[nodiscard]] constexpr bool has_normals(const Config& config) {
  return config.shade_units != 0 && config.texture_unit != TextureUnitKind::off && config.perspective_colors == 0;
}

[[nodiscard]] constexpr AttributeList attributes_of(const Config& config) {
  AttributeList list;
  list.add({.name = "depth",
            .part = {"depth"},
            .planes = 1,
            .bits = config.depth_bits,
            .symbol = "B",
            .reciprocal_bits = config.depth_bits + config.reciprocal_extra_bits,
            .guard_bits = config.local_guard_bits,
            .stored = StoredAs::depth});
  list.add({.name = "color",
            .part = {"red", "green", "blue", "alpha"},
            .planes = needs_alpha(config) ? 4 : 3,
            .bits = 8,
            .symbol = "8",
            .reciprocal_bits = 8 + config.reciprocal_extra_bits,
            .guard_bits = config.local_guard_bits,
            .stored = StoredAs::color});
  if (config.texture_unit == TextureUnitKind::off) return list;
  const int bits = config.perspective_bits;
  const auto add_with_w = [&](std::string_view name, std::array<std::string_view, 4> part, int planes, int code_bits,
                              std::string_view symbol, bool is_over_w) {
    list.add({.name = name,
              .part = part,
              .planes = planes,
              .bits = code_bits,
              .symbol = symbol,
              .reciprocal_bits = bits - kPerspectiveReciprocalLess,
              .guard_bits = kPerspectiveGuardBits,
              .is_signed = is_over_w,
              .is_clamped = false,
              .interpolation = is_over_w ? Interpolation::over_w : Interpolation::affine,
              .base = BaseVertex::smallest_q});
  };
  add_with_w("reciprocal w", {"q"}, 1, bits, "N", false);
  add_with_w("coordinate", {"u", "v"}, 2, bits + 1, "N_P + 1", true);
  if (config.perspective_colors != 0)
    add_with_w("color over w", {"red over w", "green over w", "blue over w", "alpha over w"},
               needs_alpha(config) ? 4 : 3, color_over_w_bits(config) + 1, "N_C + 1", true);
  if (has_normals(config))  // 2^N_P is a code: of a normal along an axis
    add_with_w("normal over w", {"normal x over w", "normal y over w", "normal z over w"}, 3,
               normal_over_w_bits(config) + 2, "N_N + 2", true);
  return list;
}

[[nodiscard]] constexpr bool has_texture_planes(const Config& config) {
  return config.texture_unit != TextureUnitKind::off;
}

/// Whether it has colours over w, which the texture unit divides.
[[nodiscard]] constexpr bool has_colors_over_w(const Config& config) {
  return has_texture_planes(config) && config.perspective_colors != 0;
}

/// Number of planes.
[[nodiscard]] constexpr int plane_count(const AttributeList& list) {
  int count = 0;
  for (const Attribute& attribute : list) count += attribute.planes;
  return count;
}

/// The colour planes as channels R, G, B, A. Without alpha the last one is undefined.
[[nodiscard]] constexpr std::array<std::uint32_t, 4> color_channels(const PerPlane<std::uint32_t>& code) {
  return {code[kColorPlane], code[kColorPlane + 1], code[kColorPlane + 2], code[kColorPlane + 3]};
}

/// Planes that hold the stored colour; they are consecutive from kColorPlane on.
[[nodiscard]] constexpr int color_planes(const AttributeList& list) {
  int count = 0;
  for (const Attribute& attribute : list) count += attribute.stored == StoredAs::color ? attribute.planes : 0;
  return count;
}

/// The planes whose codes are linear in the window, depth and colour: lines have these only. They come first.
[[nodiscard]] constexpr int affine_planes(const AttributeList& list) {
  int count = 0;
  for (const Attribute& attribute : list) count += attribute.is_clamped ? attribute.planes : 0;
  return count;
}

}  // namespace halfplane
