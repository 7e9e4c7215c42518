#include "surface.hpp"

#include <cmath>

#include "cull.hpp"

namespace halfplane {
namespace {

/// texture_coordinates(). `q`: the codes of the vertices' w, if they are known.
TextureCoordinates coordinates_over_w(const std::array<SurfaceVertex, 3>& surface, const State& state,
                                      const Texture& texture, const PerspectiveFormat& format, const QCodes* q) {
  const bool is_affine = state.texture_interp == TextureInterp::affine;
  TextureCoordinates result;
  std::array<double, 3> w{1, 1, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!is_affine) w[i] = surface[i].w;
    result.texels[0][i] = surface[i].u * texture.width();
    result.texels[1][i] = surface[i].v * texture.height();
  }
  result.q = q != nullptr ? *q : quantize_q(w, format.q_bits);
  const TextureAxes axes{TextureAxis{texture.width(), state.texture_wrap[0]},
                         TextureAxis{texture.height(), state.texture_wrap[1]}};
  for (const std::size_t axis : {0U, 1U}) {
    result.over_w[axis] = quantize_over_w(result.texels[axis], result.q, format.coordinate);
    result.reference[axis] = wrapped_reference(result.over_w[axis].reference, axes[axis]);
  }
  return result;
}

}  // namespace

TextureCoordinates texture_coordinates(const std::array<SurfaceVertex, 3>& surface, const State& state,
                                       const Texture& texture, const PerspectiveFormat& format) {
  return coordinates_over_w(surface, state, texture, format, nullptr);
}

Surface::Surface(const Triangle& triangle, const TriangleSetup& setup, const State& state, const Texture* texture,
                 const FogTable* fog, const PhongLight* phong, const Config& config, const Widths& widths,
                 const SampleOffset& offset)
    : setup_(setup), widths_(widths), offset_(offset), format_(perspective_format(config)), fog_(fog), phong_(phong) {
  order_ = canonical_order(triangle.v, signed_area(triangle.v[0], triangle.v[1], triangle.v[2]));
  std::array<double, 3> w{};
  for (std::size_t i = 0; i < 3; ++i) {
    vertex_[i] = triangle.v[order_[i]];
    w[i] = triangle.surface[order_[i]].w;
  }
  if (state.color_interp == ColorInterp::perspective) {
    color_divisor_ = make_divisor(quantize_q(w, format_.q_bits));
    for (std::size_t c = 0; c < static_cast<std::size_t>(widths.color_planes); ++c) {
      const std::size_t p = kColorPlane + c;
      if (setup.range.low[p] == setup.range.high[p]) {  // the clamp alone gives the code; the plane stays 0
        color_[c].over_w.exponent = -1 - format_.color.bits;
        continue;
      }
      const std::array value{static_cast<double>(vertex_[0].code[p]), static_cast<double>(vertex_[1].code[p]),
                             static_cast<double>(vertex_[2].code[p])};
      color_[c] = make_attribute(value, *color_divisor_, format_.color);
    }
  }
  if (texture != nullptr) set_texture(triangle, state, *texture);
  if (fog == nullptr && phong == nullptr) return;
  const Divisor divisor = true_divisor(w, state.texture_interp == TextureInterp::perspective);
  if (phong != nullptr) set_normals(triangle, divisor);
  if (fog == nullptr) return;
  fog_divisor_ = divisor;
  fog_scale_ = q_exponent(w, format_.q_bits) + format_.guard_bits;
}

/// All planes over w have the guard bits of Q.
Plane Surface::at_sample(const Plane& plane) const {
  if (offset_ == SampleOffset{}) return plane;
  return plane_at_sample(plane, format_.guard_bits, offset_, widths_);
}

/// Q of fog and normals is shared with colours or coordinates over w, if there are any: the same codes, and the same
/// plane.
Surface::Divisor Surface::true_divisor(const std::array<double, 3>& w, bool is_over_w) const {
  if (color_divisor_) return *color_divisor_;
  if (texture_divisor_ && is_over_w) return *texture_divisor_;
  return make_divisor(quantize_q(w, format_.q_bits));
}

void Surface::set_normals(const Triangle& triangle, const Divisor& divisor) {
  for (std::size_t c = 0; c < 3; ++c) {
    const auto of = [&](std::size_t i) { return triangle.surface[order_[i]].normal[c]; };
    normal_[c] = at_sample(setup_over_w(quantize_normal({of(0), of(1), of(2)}, divisor.q, format_), divisor.frame,
                                        normal_format(format_), widths_));
  }
}

void Surface::set_texture(const Triangle& triangle, const State& state, const Texture& texture) {
  sampler_ = Sampler(texture, state);
  combine_ = state.texture_combine;
  constant_ = state.texture_constant;
  const bool has_q_of_colors = color_divisor_ && state.texture_interp == TextureInterp::perspective;
  TextureCoordinates coordinates =
      coordinates_over_w({triangle.surface[order_[0]], triangle.surface[order_[1]], triangle.surface[order_[2]]}, state,
                         texture, format_, has_q_of_colors ? &color_divisor_->q : nullptr);
  texture_divisor_ = has_q_of_colors ? *color_divisor_ : make_divisor(coordinates.q);
  for (const std::size_t axis : {0U, 1U})
    coordinate_[axis] = {
        coordinates.over_w[axis],
        at_sample(setup_over_w(coordinates.over_w[axis], texture_divisor_->frame, format_.coordinate, widths_))};
  reference_ = coordinates.reference;
  lod_ =
      setup_lod(vertex_, setup_.area, texture_divisor_->q, coordinates.texels, format_.guard_bits, widths_.grid_bits);
}

Surface::Divisor Surface::make_divisor(const QCodes& q) const {
  Divisor divisor;
  divisor.q = q;
  divisor.frame = perspective_frame(vertex_, base_vertex(divisor.q), setup_, format_, widths_);
  divisor.plane = at_sample(setup_q(divisor.q, divisor.frame, format_, widths_));
  return divisor;
}

Surface::Attribute Surface::make_attribute(const std::array<double, 3>& value, const Divisor& divisor,
                                           const OverWFormat& attribute) const {
  const OverW over_w = quantize_over_w(value, divisor.q, attribute);
  return {over_w, at_sample(setup_over_w(over_w, divisor.frame, attribute, widths_))};
}

std::uint64_t Surface::q_of(const Divisor& divisor, const PixelPlace& place) const {
  return q_at(divisor.plane, place, format_, widths_);
}

std::int64_t Surface::value_of(const Attribute& attribute, const OverWFormat& of, const PixelReciprocal& q,
                               const PixelPlace& place) const {
  return over_q(p_at(attribute.plane, place, of, format_, widths_), q, attribute.over_w, of, format_);
}

Texel Surface::primitive_color(int x, int y, const PixelPlace& place) const {
  Texel color{0, 0, 0, 255};
  const auto channels = static_cast<std::size_t>(widths_.color_planes);
  if (color_divisor_) {
    const PixelReciprocal q = divide_by_q(q_of(*color_divisor_, place), format_);
    for (std::size_t c = 0; c < channels; ++c) {
      const std::size_t p = kColorPlane + c;
      color[c] = static_cast<std::uint8_t>(
          color_over_q(value_of(color_[c], format_.color, q, place), setup_.range.low[p], setup_.range.high[p]));
    }
  } else {
    for (std::size_t c = 0; c < channels; ++c)
      color[c] = static_cast<std::uint8_t>(plane_at(setup_, kColorPlane + c, widths_, x, y).code);
  }
  return color;
}

SurfaceSample Surface::at(int x, int y, int weight_bits) const {
  const PixelPlace pixel = place_of(setup_, widths_, x, y);
  SurfaceSample s;
  s.primitive = s.lit = primitive_color(x, y, pixel);
  if (phong_ != nullptr) add_light(pixel, s);
  s.clear = s.lit;
  if (texture_divisor_) add_texture(x, y, weight_bits, pixel, s);
  s.color = s.clear;
  if (fog_divisor_) add_fog(pixel, s);
  return s;
}

void Surface::add_light(const PixelPlace& pixel, SurfaceSample& s) const {
  std::array<std::int64_t, 3> p{};
  for (std::size_t c = 0; c < 3; ++c) p[c] = p_at(normal_[c], pixel, normal_format(format_), format_, widths_);
  s.normal = block_normal(p);
  s.light = phong_->factors(s.normal);
  for (std::size_t c = 0; c < 3; ++c) s.lit[c] = static_cast<std::uint8_t>(phong_->lit(c, s.primitive[c], s.light));
}

void Surface::add_texture(int x, int y, int weight_bits, const PixelPlace& pixel, SurfaceSample& s) const {
  const std::uint64_t q = q_of(*texture_divisor_, pixel);
  const PixelReciprocal reciprocal = divide_by_q(q, format_);
  s.place.fraction_bits = format_.coordinate.fraction_bits;
  s.place.weight_bits = weight_bits;
  for (const std::size_t axis : {0U, 1U}) {
    const std::int64_t u = value_of(coordinate_[axis], format_.coordinate, reciprocal, pixel);
    s.coordinate[axis] =
        std::ldexp(static_cast<double>(u), -s.place.fraction_bits) + coordinate_[axis].over_w.reference;
    s.place.coordinate[axis] = texture_coordinate(u, reference_[axis], s.place.fraction_bits, sampler_.axes[axis]);
  }
  s.lod = level_of_detail(lod_, q, x, y);
  s.texel = sample(sampler_, s.place, s.lod);
  s.clear = combined(s.lit, s.texel, combine_, has_alpha(sampler_.texture->format), constant_);
}

void Surface::add_fog(const PixelPlace& pixel, SurfaceSample& s) const {
  s.fog_q = q_of(*fog_divisor_, pixel);
  s.fog = fog_->factor(s.fog_q, fog_scale_);
  for (std::size_t c = 0; c < 3; ++c)
    s.color[c] = static_cast<std::uint8_t>(fogged<std::uint32_t>(s.clear[c], fog_->color()[c], s.fog));
}

}  // namespace halfplane
