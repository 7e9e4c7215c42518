#include "surface_constants.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace halfplane::functional {
namespace {

/// The inverse of row_of().
SnappedVertex vertex_of(const VertexRow& row, std::uint32_t rgba, const Widths& widths) {
  SnappedVertex v;
  v.x = row.x;
  v.y = row.y;
  v.depth() = row.z;
  for (std::size_t c = 0; c < static_cast<std::size_t>(widths.color_planes); ++c)
    v.code[kColorPlane + c] = rgba >> 8 * c & 255;
  return v;
}

Triangle triangle_of(const Slice& slice, const Record& record, const Widths& widths) {
  Triangle triangle;
  for (std::size_t i = 0; i < 3; ++i) {
    const VertexRow& row = slice.vertices[record.v[i]];
    const std::uint32_t rgba = slice.vertices[record.v[slice.state.is_flat ? 0 : i]].rgba;
    triangle.v[i] = vertex_of(row, rgba, widths);
    const SurfaceRow& over_w = slice.surface[record.v[i]];
    triangle.surface[i] = {over_w.w, over_w.u, over_w.v,
                           slice.normals != nullptr ? slice.normals[record.v[i]] : Normal{}};
  }
  return triangle;
}

const Texture* texture_of(const DrawContext& context) {
  return context.state.texture ? &context.scene.textures[*context.state.texture] : nullptr;
}

/// `up`: bits below its values in a lane.
LanePlane lanes_of(const Plane& plane, const TriangleSetup& setup, int guard_bits, int up, const Widths& widths) {
  LanePlane lanes;
  lanes.up = up;
  lanes.drop = widths.plane_fraction - guard_bits;
  const int to_tile = widths.tile_shift + widths.grid_bits;
  lanes.tile_x = static_cast<std::uint64_t>(plane.step_x) << to_tile;
  lanes.tile_y = static_cast<std::uint64_t>(plane.step_y) << to_tile;
  const auto tiles = [&widths](int pixels) {
    return static_cast<std::uint64_t>(std::int64_t{pixels >> widths.tile_shift});
  };
  lanes.at_zero = static_cast<std::uint64_t>(plane.value) + (std::uint64_t{1} << (lanes.drop - 1)) -
                  lanes.tile_x * tiles(setup.left) - lanes.tile_y * tiles(setup.top);
  const auto local = narrow_plane<std::uint64_t>(0, plane, guard_bits, widths);
  const auto in_lane = [up](std::uint64_t step) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(step) << up);
  };
  lanes.step_x = in_lane(local.step_x);
  lanes.step_y = in_lane(local.step_y);
  return lanes;
}

bool is_nearest(TextureMin min) {
  return min == TextureMin::nearest || min == TextureMin::nearest_mipmap_nearest ||
         min == TextureMin::nearest_mipmap_linear;
}

}  // namespace

StageSurface::StageSurface(const FrameContext& frame, const Slice& slice, const Record& record, int place,
                           bool has_planes)
    : triangle(triangle_of(slice, record, frame.widths)),
      setup(has_planes ? setup_at_sample(setup_triangle(triangle, frame.config, frame.widths, slice.context->rect),
                                         offset_of(place, frame.widths), frame.widths)
                       : setup_outline(triangle, frame.widths, slice.context->rect)),
      surface(triangle, setup, slice.context->state, texture_of(*slice.context), slice.context->fog.get(),
              slice.context->phong.get(), frame.config, frame.widths, offset_of(place, frame.widths)) {}

LaneDivision::LaneDivision(const PerspectiveFormat& format)
    : up(32 - q_local_bits(format)),
      mantissa_mask((1 << kFloatFraction) - (1 << (kFloatFraction + 1 - format.mantissa_bits))),
      middle(kFloatBias << kFloatFraction | 1 << (kFloatFraction - format.mantissa_bits)),
      to_divisor(kFloatFraction - format.mantissa_bits),
      power(std::ldexp(1.0F, format.mantissa_bits)),
      whole(format.mantissa_bits < 16 ? 1 << (2 * format.mantissa_bits) : 0) {}

LaneOverW::LaneOverW(const OverWFormat& attribute, const PerspectiveFormat& format)
    : up(32 - p_local_bits(attribute, format)),
      lowest(-(1 << attribute.narrow_bits)),
      highest((1 << attribute.narrow_bits) - 1),
      split(std::max(format.mantissa_bits + attribute.narrow_bits - 30, 0)),
      lower_bits((1 << split) - 1) {}

LaneTexture texture_lanes(const Sampler& sampler, const TexelBlocks& texels, TextureCombine combine,
                          const std::array<std::uint8_t, 3>& constant, int fraction_bits) {
  LaneTexture lanes;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    lanes.bits[axis] = floor_log2(static_cast<unsigned>(sampler.axes[axis].size));
    lanes.last[axis] = sampler.axes[axis].size - 1;
    lanes.beyond[axis] = sampler.axes[axis].wrap;
    lanes.wrap[axis] = has_border(lanes.beyond[axis]) ? TextureWrap::clamp : lanes.beyond[axis];
    lanes.has_border |= has_border(lanes.beyond[axis]);
  }
  for (std::size_t c = 0; c < 4; ++c)
    lanes.border =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(lanes.border) | std::uint32_t{sampler.border[c]} << 8 * c);
  lanes.texels = texels.blocks.data();
  lanes.quads = texels.quads(lanes.wrap);
  lanes.alpha_quads = lanes.has_border ? nullptr : texels.alpha_quads(lanes.wrap);
  lanes.pitch = std::max(lanes.bits[1], TexelBlocks::kShift);
  lanes.first = texels.first;
  lanes.up = kTexelFraction - fraction_bits;
  lanes.min = sampler.min;
  lanes.mag = sampler.mag;
  lanes.last_level = sampler.texture->last_level();
  lanes.bias = sampler.bias;
  lanes.least = sampler.least;
  lanes.largest = sampler.largest;
  const bool has_levels = sampler.min != TextureMin::nearest && sampler.min != TextureMin::linear;
  lanes.magnified = sampler.mag == TextureMag::linear && is_nearest(sampler.min) && has_levels ? 128 : 0;
  lanes.combine = combine;
  lanes.constant = {constant[2] << 16 | constant[0], constant[1]};
  lanes.has_alpha = has_alpha(sampler.texture->format);
  return lanes;
}

/// The bound: P less P of another vertex has a bit more than P, and a numerator is the difference of two products of such
/// a number and a side.
SurfaceStyle::SurfaceStyle(const FrameContext& frame, const DrawContext& draw)
    : context(&draw),
      format(perspective_format(frame.config)),
      division(format),
      of_coordinate(format.coordinate, format),
      of_color(format.color, format) {
  const State& state = draw.state;
  is_affine = state.texture && state.texture_interp == TextureInterp::affine;
  is_color_over_w = state.color_interp == ColorInterp::perspective;
  if ((is_color_over_w && is_affine) || draw.fog || draw.phong) return;
  const Widths& widths = frame.widths;
  const int numerator =
      std::max({format.q_bits, format.coordinate.bits, format.color.bits}) + 2 + extent_bits(kMediumPixelBits, widths);
  if (numerator > kMostNumeratorBits || division.up < 1) return;
  if (!state.texture) {
    is_in_lanes = is_color_over_w;
    return;
  }
  const Sampler sampler(draw.scene.textures[*state.texture], state);
  for (const TextureAxis& axis : sampler.axes)
    if (!axis.is_power_of_two()) return;
  is_in_lanes = true;
  for (std::size_t axis = 0; axis < 2; ++axis) size[axis] = sampler.axes[axis].size;
  texture = texture_lanes(sampler, frame.prepared.textures[*state.texture], state.texture_combine,
                          state.texture_constant, format.coordinate.fraction_bits);
  sampling = sampling_of(texture);
}

SurfaceConstants::SurfaceConstants(const StageSurface& from, const FrameContext& frame, const TexelBlocks* texels)
    : division(from.surface.format()),
      of_coordinate(from.surface.format().coordinate, from.surface.format()),
      of_color(from.surface.format().color, from.surface.format()) {
  is_color_over_w = from.surface.color_divisor().has_value();
  has_texture = texels != nullptr;
  for (std::size_t c = 0; c < 4; ++c) {
    const bool is_stored = c < static_cast<std::size_t>(frame.widths.color_planes);
    color_low[c] = is_stored ? from.setup.range.low[kColorPlane + c] : 255;
    color_high[c] = is_stored ? from.setup.range.high[kColorPlane + c] : 255;
  }
  has_constant_color = color_low == color_high;
  if (has_texture) set_texture(from, frame.widths, *texels);
  has_fog = from.surface.fog_divisor().has_value();
  if (has_fog) set_fog(from, frame.widths);
  const bool is_lit = from.surface.is_lit();
  has_color = !has_texture || (!is_lit && !sees_texture_alone(from));
  if ((has_color || is_lit) && is_color_over_w && !has_constant_color) set_color(from, frame.widths);
  if (is_lit) set_light(from, frame.widths);
}

/// Whether the primitive's colour has no effect.
bool SurfaceConstants::sees_texture_alone(const StageSurface& from) const {
  const bool is_white = std::ranges::all_of(color_low, [](std::uint32_t code) { return code == 255; });
  switch (from.surface.combine()) {
    case TextureCombine::modulate: return is_white;
    case TextureCombine::replace: return is_white || texture.has_alpha;
    default: return false;
  }
}

/// Whether every Pn of a covered pixel lies in its range. x leaves a margin of 2^-10 above the largest |u'|. Rounding
/// takes 2^-13 of it (Pn, of 12 bits and more), the reciprocal of the area 2 * 2^-14, and the planes of P and Q, off by
/// less than 0.82 and 0.32 codes, 1.14 of 2^11 codes of Q; errors of P are scaled by N / N_P.
bool SurfaceConstants::is_never_held(const OverWFormat& format, const PerspectiveFormat& all, const QCodes& q) {
  constexpr int kNarrowBits = 12, kReciprocalBits = 14, kCodes = 11;
  return format.narrow_bits >= kNarrowBits && all.reciprocal_bits >= kReciprocalBits &&
         *std::ranges::min_element(q) >> (kCodes + all.q_bits - format.bits) != 0;
}

LaneAttribute SurfaceConstants::attribute_of(const Surface::Attribute& from, const OverWFormat& format,
                                             const LaneOverW& lanes, const Surface::Divisor& divisor,
                                             const StageSurface& surface, const Widths& widths) {
  const PerspectiveFormat& all = surface.surface.format();
  LaneAttribute attribute;
  attribute.p = lanes_of(from.plane, surface.setup, all.guard_bits, lanes.up, widths);
  const int narrow = 1 + from.over_w.reach - from.over_w.exponent - format.narrow_bits;  // from e to the shift of P
  attribute.narrow = narrow - 1 - kFloatBias + lanes.up;
  attribute.drop = all.mantissa_bits + format.narrow_bits - 1 - from.over_w.reach - format.fraction_bits - lanes.split;
  // At a covered pixel Q is at least the smallest vertex's, less a third of a code.
  const int smallest = floor_log2(*std::ranges::min_element(divisor.q)) + all.guard_bits - 1;
  attribute.may_gain = smallest + narrow < 1;
  const int largest = floor_log2(*std::ranges::max_element(divisor.q)) + all.guard_bits + 1;
  attribute.is_tame =
      !attribute.may_gain && largest + narrow - 1 + lanes.up <= 31 && is_never_held(format, all, divisor.q);
  are_in_lanes &= attribute.drop >= 1;
  attribute.half = 1 << std::max(attribute.drop - 1, 0);
  return attribute;
}

void SurfaceConstants::set_color(const StageSurface& from, const Widths& widths) {
  const Surface& surface = from.surface;
  const Surface::Divisor& divisor = *surface.color_divisor();
  color.q = lanes_of(divisor.plane, from.setup, surface.format().guard_bits, division.up, widths);
  for (std::size_t c = 0; c < static_cast<std::size_t>(widths.color_planes); ++c)
    color.attribute[c] = attribute_of(surface.channel(c), surface.format().color, of_color, divisor, from, widths);
}

void SurfaceConstants::set_texture(const StageSurface& from, const Widths& widths, const TexelBlocks& texels) {
  const Surface& surface = from.surface;
  const PerspectiveFormat& format = surface.format();
  const Surface::Divisor& divisor = *surface.texture_divisor();
  const Sampler& sampler = surface.sampler();
  coordinate.q = lanes_of(divisor.plane, from.setup, format.guard_bits, division.up, widths);
  texture = texture_lanes(sampler, texels, surface.combine(), surface.constant(), format.coordinate.fraction_bits);
  texture.alpha_ranges = texture.has_border ? nullptr : texels.alpha_ranges();
  for (std::size_t axis = 0; axis < 2; ++axis) {
    texture.margin[axis] = coordinates_margin(surface.coordinate(axis).over_w.reach, format);
    coordinate.attribute[axis] =
        attribute_of(surface.coordinate(axis), format.coordinate, of_coordinate, divisor, from, widths);
    are_in_lanes &= sampler.axes[axis].is_power_of_two();
    texture.reference[axis] = surface.reference(axis) * (1 << kTexelFraction);
  }
  texture.lod = surface.lod();
  has_constant_w = has_one_w();
  is_upright = has_constant_w && sampling_of(texture) != Sampling::nearest && coordinate.attribute[0].p.step_y == 0 &&
               coordinate.attribute[1].p.step_x == 0;
  repeats_places = is_upright && coordinate.q.tile_x == 0 && coordinate.q.tile_y == 0 &&
                   coordinate.attribute[0].p.tile_y == 0 && coordinate.attribute[1].p.tile_x == 0;
}

bool SurfaceConstants::has_one_w() const {
  const auto is_constant = [](const LodLine& line) { return line.step == 0; };
  return coordinate.q.step_x == 0 && coordinate.q.step_y == 0 &&
         std::ranges::all_of(texture.lod.along_x, is_constant) && std::ranges::all_of(texture.lod.along_y, is_constant);
}

void SurfaceConstants::set_light(const StageSurface& from, const Widths& widths) {
  const Surface& surface = from.surface;
  const PhongLight& phong = surface.phong();
  auto made = std::make_unique<LaneLight>();
  made->up = 32 - p_local_bits(normal_format(surface.format()), surface.format());
  for (std::size_t c = 0; c < 3; ++c) {
    made->normal[c] = lanes_of(surface.normal(c), from.setup, surface.format().guard_bits, made->up, widths);
    made->ambient[c] = static_cast<std::int32_t>(phong.ambient()[c]);
    made->diffuse[c] = static_cast<std::int32_t>(phong.diffuse()[c]);
    made->specular[c] = phong.given().specular[c];
  }
  made->roots = root_lines().data();
  made->power = phong.lines().data();
  made->place_bits = phong.place_bits();
  made->drop = phong.place_bits() + kPowerStartFraction - kLightFraction;
  made->direction = phong.direction();
  made->half = phong.half();
  light = std::move(made);
}

void SurfaceConstants::set_fog(const StageSurface& from, const Widths& widths) {
  const Surface& surface = from.surface;
  const FogTable& table = surface.fog();
  fog.q = lanes_of(surface.fog_divisor()->plane, from.setup, surface.format().guard_bits, division.up, widths);
  fog.lines = table.lines().data();
  fog.first = (table.first() + surface.fog_scale() + kFloatBias) * (1 << kFogPlaceBits);
  fog.last = table.last_position();
  fog.place_bits = table.place_bits();
  fog.drop = table.place_bits() + kFogStartFraction - kFogFactorBits;
  for (std::size_t c = 0; c < 3; ++c) fog.color[c] = table.color()[c];
}

}  // namespace halfplane::functional
