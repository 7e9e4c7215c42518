#include "sim/study/compare/surface_oracle.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "model/golden/exact.hpp"
#include "model/golden/fog.hpp"
#include "model/golden/phong.hpp"
#include "model/widths.hpp"

namespace halfplane {
namespace {

constexpr double kLevelBound = 0.1;           // levels
constexpr double kRoundingBound = 0.5078125;  // LSB: a half, and 2^-7 for the rounding between two levels
constexpr double kLargestTurn = 0.25;         // of a normal's length: beyond this its light has no bound
constexpr double kWeightBound = 1;            // LSB: two coordinates off by 2^-9 of 255

std::int64_t grid_units(double lsb) {
  return static_cast<std::int64_t>(std::floor(std::ldexp(lsb, exact::kGridBits) + 0.5));
}

double ratio_of(const std::array<double, 3>& w) {
  const auto [low, high] = std::minmax({w[0], w[1], w[2]});
  return high / low;
}

/// The filter with its weights, without rounding.
std::array<double, 4> weighted_texel(const Sampler& s, const SurfaceSample& sample) {
  const auto fetch = [&s](int level, int x, int y) { return s.texture->texel(level, x, y); };
  const auto [is_linear, is_between, levels] = filter_of(s, sample.lod);
  const auto on_level = [&, linear = is_linear](int level) {
    std::array<double, 4> color{};
    const Texel nearest = filter_nearest(fetch, s.axes, sample.place, level, s.border);
    const auto sums = linear_sums(fetch, s.axes, sample.place, level, s.border);
    for (std::size_t c = 0; c < 4; ++c) color[c] = linear ? std::ldexp(sums[c], -16) : nearest[c];
    return color;
  };
  const auto lower = on_level(levels.lower);
  return is_between ? golden::between(lower, on_level(levels.upper), levels.part / 256.0) : lower;
}

}  // namespace

double over_w_bound(double extent, double w_ratio, const PerspectiveFormat& format, const OverWFormat& attribute,
                    int roundings) {
  const double delta = std::ldexp(roundings + 1, -format.guard_bits - 1) + std::ldexp(1.0, -5);  // of Q's plane, codes
  const double smallest_q = std::ldexp(1.0, format.q_bits - 1) / w_ratio, lost = 0.5 + delta;
  // |U| <= 2^(x+1), 2^x at most twice the largest |u'| with its margin; this bounds the distance from the real value.
  const double held = attribute.is_centred ? 5.01 * (extent / 2 + 1) : extent;
  if (smallest_q <= lost) return held;
  const double first_order = coordinate_error_bound(extent, w_ratio, format, attribute, roundings);
  return std::min(held, first_order * smallest_q / (smallest_q - lost));
}

double largest_level_w_ratio(const PerspectiveFormat& format) { return std::ldexp(1.0, format.q_bits - 10); }

SurfaceOracle::SurfaceOracle(const Scene& scene, const Config& config, const Triangle& triangle,
                             const SampleOffset& offset)
    : state_(scene.states[std::get<Draw>(scene.commands[triangle.draw]).state]),
      texture_(state_.texture ? &scene.textures[*state_.texture] : nullptr),
      rules_{state_.color_interp, state_.texture_interp} {
  const Widths widths = derive_widths(config);
  offset_ = {std::ldexp(offset.x, -widths.grid_bits), std::ldexp(offset.y, -widths.grid_bits)};
  const PerspectiveFormat format = perspective_format(config);
  std::array<golden::ScreenVertex<double>, 3> v;
  std::array<double, 3> w{};
  std::uint32_t largest_code = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const SnappedVertex& from = triangle.v[i];
    v[i].x = std::ldexp(from.x, -widths.grid_bits);
    v[i].y = std::ldexp(from.y, -widths.grid_bits);
    w[i] = triangle.surface[i].w;
    v[i].inverse_w = 1 / w[i];
    v[i].uv = {triangle.surface[i].u, triangle.surface[i].v};
    v[i].rgba[3] = 255;
    for (std::size_t c = 0; c < static_cast<std::size_t>(widths.color_planes); ++c) {
      v[i].rgba[c] = from.code[kColorPlane + c];
      largest_code = std::max(largest_code, from.code[kColorPlane + c]);
    }
  }
  if (state_.color_interp == ColorInterp::perspective)
    color_bound_ = over_w_bound(largest_code, ratio_of(w), format, format.color, plane_roundings(config));
  fog_ = fog_table(state_);
  phong_ = phong_light(state_);
  setup_ = golden::setup_triangle(v);
  if (phong_) {
    auto of_normals = v;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        of_normals[i].rgba[c] = std::ldexp(triangle.surface[i].normal[c], -kNormalFraction);
    normals_ = golden::setup_triangle(of_normals);
  }
  if (fog_ || phong_) set_q(w, format, plane_roundings(config));
  if (texture_ == nullptr) return;
  sampler_ = Sampler(*texture_, state_);
  const double w_ratio = state_.texture_interp == TextureInterp::affine ? 1 : ratio_of(w);
  if (w_ratio <= largest_level_w_ratio(format)) level_bound_ = kLevelBound;
  for (const std::size_t axis : {0U, 1U}) {
    const auto [low, high] = std::minmax({v[0].uv[axis], v[1].uv[axis], v[2].uv[axis]});
    const double extent = (high - low) * sampler_.axes[axis].size;
    // A corner farther than 2^20 from u_ref is clamped; weighted means of corners have at most the corners' error, and
    // the real coordinate that of binary64, which overflows beyond 2^900.
    constexpr double kReach = kFarthestCoordinate;
    const double farthest = extent / 2 + 1;
    const double held_off = farthest > kReach ? farthest - kReach + std::ldexp(extent, -40) : 0;
    const double within =
        over_w_bound(std::min(extent, 2 * kReach), w_ratio, format, format.coordinate, plane_roundings(config));
    coordinate_bound_[axis] = farthest < std::ldexp(1.0, 900) ? within + held_off : HUGE_VAL;
  }
}

/// Q_i is rounded, below 1/2 to 1, and its plane has the error delta; the error of the reciprocal of the area scales
/// all of it.
void SurfaceOracle::set_q(const std::array<double, 3>& w, const PerspectiveFormat& format, int roundings) {
  q_code_ = std::ldexp(1.0, -q_exponent(w, format.q_bits));
  const double smallest = 1 / std::max({w[0], w[1], w[2]}) / q_code_;
  const double delta = std::ldexp(roundings + 1, -format.guard_bits - 1) + std::ldexp(1.0, -5);
  q_lost_ = (smallest < 0.5 ? 1 : 0.5) + delta;
  q_relative_ = std::ldexp(1.0, -format.reciprocal_bits);
  // P_i is that of a rounded Q_i, and rounded itself.
  const int less = format.q_bits - normal_format(format).bits;
  normal_code_ = std::ldexp(q_code_, less);
  normal_lost_ = std::sqrt(3.0) * (0.5 + delta) + std::ldexp(smallest < 0.5 ? 1 : 0.5, -less);
}

golden::Fragment<double> SurfaceOracle::exact_at(double x, double y, const golden::Setup<double>& setup,
                                                 const golden::InterpolationRules& rules) const {
  return golden::interpolate(
      setup, std::array{setup_.edge[0].value(x, y), setup_.edge[1].value(x, y), setup_.edge[2].value(x, y)}, rules);
}

/// u_x is N_x(y) / Q^2 (level_of_detail.hpp): N in the row and column of the pixel's centre, Q at the sample.
double SurfaceOracle::exact_level(golden::Fragment<double> exact, int x, int y) const {
  if (rules_.texture == TextureInterp::perspective && offset_ != std::array{0.0, 0.0}) {
    const auto centre = exact_at(x + 0.5 - offset_[0], y + 0.5 - offset_[1], setup_, rules_);
    const double ratio = centre.inverse_w / exact.inverse_w, by = ratio * ratio;
    const golden::TextureCoordinates& t = centre.texture;
    exact.texture = {exact.texture.u, exact.texture.v, t.u_x * by, t.u_y * by, t.v_x * by, t.v_y * by};
  }
  return golden::level_of_detail(*texture_, exact.texture);
}

SurfaceErrors SurfaceOracle::errors(const SurfaceSample& sample, int x, int y) const {
  const double px = x + 0.5, py = y + 0.5;
  const golden::Fragment<double> exact = exact_at(px, py, setup_, rules_);
  SurfaceErrors errors;
  errors.exact = exact.rgba;
  errors.color.bound = color_bound_;
  for (std::size_t c = 0; c < 4 && color_bound_ < HUGE_VAL; ++c)
    errors.color.value = std::max(errors.color.value, std::abs(sample.primitive[c] - exact.rgba[c]));
  if (phong_) {
    const golden::Color n = exact_at(px, py, normals_, {ColorInterp::perspective, TextureInterp::perspective}).rgba;
    compare_light(sample, {n[0], n[1], n[2]}, exact.inverse_w, errors);
  }
  if (texture_ != nullptr) compare_texels(sample, exact, exact_level(exact, x, y), errors);
  if (fog_) compare_fog(sample, exact.inverse_w, errors);
  return errors;
}

double SurfaceOracle::affine_texels(int x, int y) const {
  if (texture_ == nullptr || rules_.texture == TextureInterp::perspective) return 0;
  const auto at = [&](TextureInterp interp) {
    return exact_at(x + 0.5, y + 0.5, setup_, {rules_.color, interp}).texture;
  };
  const golden::TextureCoordinates affine = at(TextureInterp::affine), perspective = at(TextureInterp::perspective);
  return std::hypot((affine.u - perspective.u) * sampler_.axes[0].size,
                    (affine.v - perspective.v) * sampler_.axes[1].size);
}

/// Relative to the model's own colour before the light.
void SurfaceOracle::compare_light(const SurfaceSample& sample, const std::array<double, 3>& normal, double inverse_w,
                                  SurfaceErrors& errors) const {
  const golden::LightFactors real = golden::light_factors(state_, normal);
  const double length = std::sqrt(golden::dot(normal, normal)) * inverse_w;  // of n / w
  const golden::Direction n = golden::unit(normal);
  errors.is_lit = true;
  errors.light = {0, HUGE_VAL};
  // The error of the reciprocal of the area scales the difference between the pixel and the farthest vertex, whose 1/w
  // is no larger.
  const double turn =
      length > 0 ? normal_lost_ * normal_code_ / length + q_relative_ * (1 + inverse_w / length) : HUGE_VAL;
  golden::RealColor own{};
  for (std::size_t c = 0; c < 4; ++c) own[c] = sample.primitive[c];
  const golden::RealColor lit = golden::in_light(state_, own, real);
  if (turn < kLargestTurn) {
    const PhongLight::Bounds bounds =
        phong_->error_bounds(golden::dot(n, golden::unit(state_.light_direction)),
                             golden::dot(n, golden::unit(state_.light_half)), turn * (1 + turn));
    errors.light = {0, 0.5};
    for (std::size_t c = 0; c < 3; ++c) {
      const Held held{std::abs(sample.lit[c] - lit[c]), phong_->error_bound(c, sample.primitive[c], bounds)};
      if (!(held.ratio() <= errors.light.ratio())) errors.light = held;
    }
  }
  errors.exact = golden::in_light(state_, errors.exact, real);
}

/// Relative to the model's own colour before the fog: the errors are of the factor, and of its product's rounding.
void SurfaceOracle::compare_fog(const SurfaceSample& sample, double inverse_w, SurfaceErrors& errors) const {
  const double off = fog_error_bound(*fog_, 1 / inverse_w, q_lost_ * q_code_ / inverse_w + q_relative_);
  const double part = golden::fog_part(*state_.fog, inverse_w);
  golden::RealColor clear{};
  for (std::size_t c = 0; c < 4; ++c) clear[c] = sample.clear[c];
  const golden::RealColor real = golden::in_fog(state_, clear, part);
  errors.has_fog = true;
  errors.fog_factor = {255 * std::abs(std::ldexp(sample.fog, -kFogFactorBits) - part), 255 * off};
  errors.fog = {0, 0.5};
  for (std::size_t c = 0; c < 3; ++c) {
    const Held held{std::abs(sample.color[c] - real[c]), std::abs(clear[c] - state_.fog_color[c]) * off + 0.5};
    if (!(held.ratio() <= errors.fog.ratio())) errors.fog = held;
  }
  errors.exact = golden::in_fog(state_, errors.exact, part);
}

void SurfaceOracle::compare_texels(const SurfaceSample& sample, const golden::Fragment<double>& exact, double lod,
                                   SurfaceErrors& errors) const {
  errors.has_texture = true;
  const golden::TexelPlace place{exact.texture.u * texture_->width(), exact.texture.v * texture_->height()};
  const std::array off{std::abs(sample.coordinate[0] - place.x), std::abs(sample.coordinate[1] - place.y)};
  errors.coordinate = {off[0], coordinate_bound_[0]};
  if (const Held v{off[1], coordinate_bound_[1]}; !(v.ratio() <= errors.coordinate.ratio())) errors.coordinate = v;
  const double worse = std::max(off[0], off[1]);
  errors.footprints = std::isfinite(lod) ? worse / std::exp2(lod) : 0;
  const double least = -1 - state_.texture_lod[0], model_lod = std::ldexp(sample.lod, -kLodFraction);
  if (lod < HUGE_VAL) errors.level = std::max(model_lod, least) - std::max(lod, least);  // otherwise unknown
  errors.level_size = {std::abs(errors.level), level_bound_};

  const double bounded = golden::bounded_level(state_, lod);
  const double model_bounded =
      std::ldexp(std::clamp(sample.lod + sampler_.bias, sampler_.least, sampler_.largest), -kLodFraction);
  const double unit = std::ldexp(1.0, -sample.place.fraction_bits);
  const golden::TexelPlace own{static_cast<double>(sample.place.coordinate[0]) * unit,
                               static_cast<double>(sample.place.coordinate[1]) * unit};
  const golden::Color s = golden::filtered(*texture_, state_, place, bounded),
                      c = golden::filtered(*texture_, state_, own, bounded),
                      l = golden::filtered(*texture_, state_, own, model_bounded), w = weighted_texel(sampler_, sample);
  errors.filter.bound = kRoundingBound + (filter_of(sampler_, sample.lod).is_linear ? kWeightBound : 0);
  for (std::size_t i = 0; i < 4; ++i) {
    const double d = sample.texel[i];
    errors.texel.coordinate[i] = grid_units(c[i]) - grid_units(s[i]);
    errors.texel.level_of_detail[i] = grid_units(l[i]) - grid_units(c[i]);
    errors.texel.weights[i] = grid_units(w[i]) - grid_units(l[i]);
    errors.texel.rounding[i] = grid_units(d) - grid_units(w[i]);
    errors.filter.value = std::max(errors.filter.value, std::abs(d - l[i]));
  }
  errors.exact =
      golden::combined(errors.exact, s, state_.texture_combine, has_alpha(texture_->format), state_.texture_constant);
}

namespace {

/// The channel with the largest error, LSB.
float worst_channel(const std::array<std::int64_t, 4>& error) {
  const auto size = [](std::int64_t e) { return std::abs(e); };
  return static_cast<float>(
      std::ldexp(static_cast<double>(*std::ranges::max_element(error, {}, size)), -exact::kGridBits));
}

}  // namespace

TextureErrorSets::TextureErrorSets(std::size_t pixels) {
  auto& picture = errors_.picture;
  for (auto* values : {&picture.coordinate, &picture.footprints, &picture.level, &picture.weights, &picture.rounding})
    values->assign(pixels, std::numeric_limits<float>::quiet_NaN());
}

void TextureErrorSets::add(std::size_t pixel, const SurfaceErrors& errors) {
  ++errors_.pixels;
  errors_.coordinate_of_bound = std::max(errors_.coordinate_of_bound, errors.coordinate.ratio());
  coordinate_.add(errors.coordinate.value);
  footprints_.add(errors.footprints);
  level_.add(errors.level);
  const auto& [coordinate, level, weights, rounding] = errors.texel;
  for (std::size_t c = 0; c < 4; ++c) {
    part_coordinate_.add(coordinate[c]);
    part_level_.add(level[c]);
    part_weights_.add(weights[c]);
    part_rounding_.add(rounding[c]);
    total_.add(coordinate[c] + level[c] + weights[c] + rounding[c]);
  }
  auto& picture = errors_.picture;
  picture.coordinate[pixel] = static_cast<float>(errors.coordinate.value);
  picture.footprints[pixel] = static_cast<float>(errors.footprints);
  picture.level[pixel] = static_cast<float>(errors.level);
  picture.weights[pixel] = worst_channel(weights);
  picture.rounding[pixel] = worst_channel(rounding);
}

TextureErrors TextureErrorSets::result() && {
  errors_.coordinate = coordinate_.stats();
  errors_.footprints = footprints_.stats();
  errors_.level = level_.stats();
  errors_.part_coordinate = part_coordinate_.stats();
  errors_.part_level = part_level_.stats();
  errors_.part_weights = part_weights_.stats();
  errors_.part_rounding = part_rounding_.stats();
  errors_.total = total_.stats();
  return std::move(errors_);
}

}  // namespace halfplane
