#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "context.hpp"
#include "matrix.hpp"
#include "texture.hpp"

namespace halfplane::gl {
namespace {

/// How RGB and alpha come from the vertex's colour and the texel that is handed to the model. of_white: not exactly; the
/// environment's result for white vertices is multiplied with their colour.
enum class Rgb : std::uint8_t { modulate, replace, add, decal, decal_constant, blend, of_white };
enum class Alpha : std::uint8_t { multiply, replace, of_white };
struct Fit {
  Rgb rgb = Rgb::modulate;
  Alpha alpha = Alpha::multiply;
  bool folds = false;  ///< the environment is folded into the texels
  [[nodiscard]] bool is_exact() const { return rgb != Rgb::of_white && alpha != Alpha::of_white; }
};

/// One channel of an environment's result for one texel: a times the vertex's, plus b.
struct Affine {
  double a = 0, b = 0;
  bool is_exact = true;  ///< false: right for white, opaque vertices only

  [[nodiscard]] double of_white() const { return a + b; }
};
using Result = std::array<Affine, 4>;

constexpr double kTolerance = 1.0 / 512;
bool is_near(double x, double y) { return std::abs(x - y) < kTolerance; }

Affine sum(const Affine& x, const Affine& y, double factor, double bias) {
  return {x.a + factor * y.a, x.b + factor * y.b + bias, x.is_exact && y.is_exact};
}
Affine product(const Affine& x, const Affine& y) {
  if (x.a != 0 && y.a != 0) return {x.of_white() * y.of_white(), 0, false};
  return {x.a * y.b + y.a * x.b, x.b * y.b, x.is_exact && y.is_exact};
}
Affine complement(const Affine& x) { return {-x.a, 1 - x.b, x.is_exact}; }

/// Inputs of an environment: the texture's color as table 3.20 fills it in, the constant, and the fragment's color where
/// it is known.
struct Inputs {
  Vec4 texel, constant;
  const Vec4* fragment;
};

/// An argument of GL_COMBINE in one channel (tables 3.24 and 3.25).
Affine argument(const TextureCombiner& combiner, std::size_t i, std::size_t channel, const Inputs& inputs) {
  const GLenum source = combiner.source[i], operand = combiner.operand[i];
  const bool takes_alpha = operand == GL_SRC_ALPHA || operand == GL_ONE_MINUS_SRC_ALPHA;
  const std::size_t c = takes_alpha ? 3 : channel;
  Affine value;
  if (source == GL_CONSTANT)
    value.b = inputs.constant[c];
  else if (source == GL_PRIMARY_COLOR || source == GL_PREVIOUS)  // the first unit's previous color is the primary one
    value = inputs.fragment != nullptr ? Affine{0, (*inputs.fragment)[c]} : Affine{1, 0, c == channel};
  else
    value.b = inputs.texel[c];
  return operand == GL_ONE_MINUS_SRC_COLOR || operand == GL_ONE_MINUS_SRC_ALPHA ? complement(value) : value;
}

/// Table 3.23. `channel`: of RGB or alpha.
Affine combined(const TextureCombiner& combiner, std::size_t channel, const Inputs& inputs) {
  const auto arg = [&](std::size_t i, std::size_t c) { return argument(combiner, i, c, inputs); };
  Affine result = arg(0, channel);
  switch (combiner.function) {
    case GL_MODULATE: result = product(result, arg(1, channel)); break;
    case GL_ADD: result = sum(result, arg(1, channel), 1, 0); break;
    case GL_ADD_SIGNED: result = sum(result, arg(1, channel), 1, -0.5); break;
    case GL_SUBTRACT: result = sum(result, arg(1, channel), -1, 0); break;
    case GL_INTERPOLATE: {
      const Affine part = arg(2, channel);
      result = sum(product(result, part), product(arg(1, channel), complement(part)), 1, 0);
      break;
    }
    case GL_DOT3_RGB:
    case GL_DOT3_RGBA: {
      result = {};
      for (std::size_t c = 0; c < 3; ++c)
        result = sum(result, product(sum(arg(0, c), {}, 0, -0.5), sum(arg(1, c), {}, 0, -0.5)), 4, 0);
      result.is_exact = result.is_exact && result.a == 0;  // sum over all channels
      break;
    }
    default: break;
  }
  result.a *= combiner.scale;
  result.b *= combiner.scale;
  if (result.a == 0) result.b = held(result.b);
  return result;
}

/// The environment of a unit: tables 3.21 and 3.22, and GL_COMBINE. `texel`: as it is stored, in 0...1.
Result environment(const TextureUnit& unit, GLenum base, const Vec4& texel, const Vec4* fragment = nullptr) {
  Result result;
  if (unit.env_mode == GL_COMBINE) {
    Inputs inputs{texel, unit.env_color, fragment};
    if (base == GL_ALPHA) inputs.texel[0] = inputs.texel[1] = inputs.texel[2] = 0;
    const auto& [rgb, alpha] = unit.combine;
    for (std::size_t c = 0; c < 3; ++c) result[c] = combined(rgb, c, inputs);
    result[3] = rgb.function == GL_DOT3_RGBA ? result[0] : combined(alpha, 3, inputs);
    return result;
  }
  const bool is_opaque = base == GL_RGB || base == GL_LUMINANCE;
  for (std::size_t c = 0; c < 4; ++c) {
    const double t = texel[c];
    const Affine kept{1, 0}, product{t, 0};
    const bool is_alpha = c == 3 && base != GL_INTENSITY;  // alpha is then a color in all channels, but for GL_DECAL
    switch (unit.env_mode) {
      case GL_REPLACE: result[c] = (c == 3 ? is_opaque : base == GL_ALPHA) ? kept : Affine{0, t}; break;
      case GL_DECAL:
        result[c] = c == 3 || base == GL_ALPHA ? kept : is_opaque ? Affine{0, t} : Affine{1 - texel[3], t * texel[3]};
        break;
      case GL_ADD: result[c] = is_alpha ? product : base == GL_ALPHA ? kept : Affine{1, t}; break;
      case GL_BLEND:
        result[c] = is_alpha ? product : base == GL_ALPHA ? kept : Affine{1 - t, unit.env_color[c] * t};
        break;
      default: result[c] = product; break;
    }
  }
  return result;
}

Vec4 real(const Texel& texel) { return {texel[0] / 255.0, texel[1] / 255.0, texel[2] / 255.0, texel[3] / 255.0}; }

bool is_linear(GLenum filter) {
  return filter == GL_LINEAR || filter == GL_LINEAR_MIPMAP_NEAREST || filter == GL_LINEAR_MIPMAP_LINEAR;
}

/// The fit of modes that take texels as they are; none: the texels decide. `blends`: the hardware has a constant color.
std::optional<Fit> direct_fit(GLenum mode, GLenum base, bool blends) {
  const bool is_opaque = base == GL_RGB || base == GL_LUMINANCE;
  switch (mode) {
    case GL_MODULATE: return Fit{};
    case GL_REPLACE:
      return Fit{base == GL_ALPHA ? Rgb::modulate : Rgb::replace, is_opaque ? Alpha::multiply : Alpha::replace};
    case GL_DECAL: return Fit{base == GL_RGBA ? Rgb::decal : is_opaque ? Rgb::replace : Rgb::modulate};
    case GL_ADD:
      if (base == GL_ALPHA) return Fit{};
      if (base != GL_INTENSITY) return Fit{Rgb::add};
      break;
    case GL_BLEND:
      if (base == GL_ALPHA) return Fit{};
      if (blends && base != GL_INTENSITY) return Fit{Rgb::blend};
      break;
    default: break;
  }
  return std::nullopt;
}

/// A texture as one unit samples it.
struct Sampled {
  const TextureObject& texture;
  const TextureUnit& unit;
  GLenum base;              ///< of depth textures the format that they are read as
  std::size_t first, last;  ///< levels

  [[nodiscard]] const TextureImage& level(std::size_t l) const { return texture.face[0][l]; }
  [[nodiscard]] Texel texel(std::size_t l, std::size_t i) const {
    const Texel& t = level(l).texel[i];
    if (level(l).base_format != GL_DEPTH_COMPONENT || base == GL_INTENSITY) return t;
    return base == GL_ALPHA ? Texel{255, 255, 255, t[0]} : Texel{t[0], t[0], t[0], 255};
  }
  /// The border's colour as a texel of the base format.
  [[nodiscard]] Texel border() const {
    Texel t{};
    for (std::size_t c = 0; c < 4; ++c) {
      const double channel = texture.border_color[c];
      t[c] = static_cast<std::uint8_t>(std::lround(255 * (channel > 0 ? std::min(channel, 1.0) : 0)));  // NaN: 0
    }
    const std::uint8_t of_alpha = level(first).base_format == GL_DEPTH_COMPONENT ? t[0] : t[3];
    switch (base) {
      case GL_ALPHA: return {255, 255, 255, of_alpha};
      case GL_INTENSITY: return {t[0], t[0], t[0], t[0]};
      case GL_LUMINANCE: return {t[0], t[0], t[0], 255};
      case GL_LUMINANCE_ALPHA: return {t[0], t[0], t[0], t[3]};
      case GL_RGB: return {t[0], t[1], t[2], 255};
      default: return t;
    }
  }
  /// Texels of one level: of a texture with several layers the first.
  [[nodiscard]] std::size_t texels(std::size_t l) const {
    return static_cast<std::size_t>(level(l).width) * static_cast<std::size_t>(level(l).height);
  }
};

/// A side whose coordinates may show the border; `filters`: the texture has a linear filter.
bool shows_border(GLenum wrap, bool filters) { return wrap == GL_CLAMP_TO_BORDER || (wrap == GL_CLAMP && filters); }
bool shows_border(const TextureObject& texture) {
  const bool filters = is_linear(texture.min_filter) || is_linear(texture.mag_filter);
  return shows_border(texture.wrap[0], filters) ||
         (texture.target != GL_TEXTURE_1D && shows_border(texture.wrap[1], filters));
}

/// Which of the model's modes gives the results of all texels, and of the border where `has_border`.
Fit fit_texels(const Sampled& sampled, bool blends, bool has_border) {
  std::array<bool, 6> rgb{true, true, true, true, true, blends};  // by Rgb
  std::array<bool, 2> alpha{true, true};                          // by Alpha
  bool keeps_alpha = true;
  const Vec4& constant = sampled.unit.env_color;
  const std::size_t borders = has_border ? 1 : 0;
  for (std::size_t l = sampled.first; l <= sampled.last; ++l)
    for (std::size_t i = 0; i < sampled.texels(l) + borders; ++i) {
      const Texel texel = i < sampled.texels(l) ? sampled.texel(l, i) : sampled.border();
      if (i != 0 && texel == sampled.texel(l, i - 1)) continue;
      const Result result = environment(sampled.unit, sampled.base, real(texel));
      for (std::size_t c = 0; c < 4; ++c) {
        const auto [a, b, is_exact] = result[c];
        const bool modulates = is_exact && is_near(b, 0) && a > -kTolerance && a < 1 + kTolerance;
        const bool replaces = is_exact && is_near(a, 0);
        if (c == 3) {
          alpha[0] = alpha[0] && modulates;
          alpha[1] = alpha[1] && replaces;
          keeps_alpha = keeps_alpha && modulates && is_near(a, 1);
          continue;
        }
        const bool is_part = is_exact && a > -kTolerance && a < 1 + kTolerance;
        const bool is_even = is_part && is_near(a, result[0].a);
        const std::array<bool, 6> holds{modulates,
                                        replaces,
                                        is_exact && is_near(a, 1) && b > -kTolerance,
                                        is_even && is_near(b, (1 - a) * texel[c] / 255.0),
                                        is_even && is_near(b, (1 - a) * constant[c]),
                                        is_part && is_near(b, (1 - a) * constant[c])};
        for (std::size_t k = 0; k < rgb.size(); ++k) rgb[k] = rgb[k] && holds[k];
      }
    }
  Fit fit{.folds = true};
  rgb[3] = rgb[3] && keeps_alpha;
  rgb[4] = rgb[4] && keeps_alpha;
  fit.rgb = static_cast<Rgb>(std::ranges::find(rgb, true) - rgb.begin());
  fit.alpha = static_cast<Alpha>(std::ranges::find(alpha, true) - alpha.begin());
  return fit;
}

/// A texel that makes the model's mode give the environment's result.
Texel folded(const Fit& fit, const Result& result, const Texel& texel, const Vec4& constant) {
  std::array<float, 4> color{};
  for (std::size_t c = 0; c < 4; ++c) {
    const auto& [a, b, is_exact] = result[c];
    const bool is_of_white = c == 3 ? fit.alpha == Alpha::of_white : fit.rgb == Rgb::of_white;
    const bool takes_a = c == 3 ? fit.alpha == Alpha::multiply : fit.rgb == Rgb::modulate;
    const bool takes_rest = c != 3 && fit.rgb == Rgb::blend;
    color[c] = static_cast<float>(is_of_white ? a + b : takes_rest ? 1 - a : takes_a ? a : b);
  }
  if (fit.rgb == Rgb::decal || fit.rgb == Rgb::decal_constant) {
    for (std::size_t c = 0; c < 3; ++c)
      color[c] = static_cast<float>(fit.rgb == Rgb::decal ? texel[c] / 255.0 : constant[c]);
    color[3] = static_cast<float>(1 - result[0].a);
  }
  return texel_of(color);
}

Texel folded(const Sampled& sampled, const Fit& fit, const Texel& texel) {
  return folded(fit, environment(sampled.unit, sampled.base, real(texel)), texel, sampled.unit.env_color);
}

halfplane::Texture made(const Sampled& sampled, const Fit& fit, bool has_levels) {
  std::vector<TexelImage> levels;
  for (std::size_t l = sampled.first; l <= sampled.last; ++l) {
    TexelImage image{sampled.level(l).width, sampled.level(l).height, {}};
    if (!fit.folds && sampled.level(l).base_format != GL_DEPTH_COMPONENT) {
      const std::span<const Texel> texels(sampled.level(l).texel);
      image.texel.assign(texels.begin(), texels.begin() + static_cast<std::ptrdiff_t>(sampled.texels(l)));
      levels.push_back(std::move(image));
      continue;
    }
    image.texel.reserve(sampled.texels(l));
    for (std::size_t i = 0; i < sampled.texels(l); ++i) {
      const Texel texel = sampled.texel(l, i);
      image.texel.push_back(fit.folds ? folded(sampled, fit, texel) : texel);
    }
    levels.push_back(std::move(image));
  }
  const bool is_grey = !fit.folds && sampled.base != GL_RGB && sampled.base != GL_RGBA;
  const TextureFormat format = !is_grey                       ? TextureFormat::rgba8888
                               : sampled.base == GL_LUMINANCE ? TextureFormat::l8
                                                              : TextureFormat::la88;
  std::string name = "texture" + std::to_string(sampled.texture.name);
  return has_levels ? make_texture(std::move(name), levels, format)
                    : make_texture(std::move(name), levels.front(), format, Mips::none);
}

/// A number for values that differ (SplitMix64's last step after each).
class Key {
 public:
  template <class... Values>
  explicit Key(const Values&... values) {
    (add(values), ...);
  }
  void add(std::uint64_t value) {
    key_ += value + 0x9e3779b97f4a7c15ULL;
    key_ = (key_ ^ key_ >> 30) * 0xbf58476d1ce4e5b9ULL;
    key_ = (key_ ^ key_ >> 27) * 0x94d049bb133111ebULL;
    key_ ^= key_ >> 31;
  }
  /// Without the highest bit, which is of pixel rectangles.
  [[nodiscard]] std::uint64_t value() const { return key_ >> 1; }

 private:
  std::uint64_t key_ = 0;
};

/// The fit of an environment that has to be folded, found once for each key.
Fit folded_fit(Context& context, const Sampled& sampled, bool blends, bool has_border, std::uint64_t key) {
  constexpr std::size_t kMost = 1024;
  if (const auto known = context.texture_fits.find(key); known != context.texture_fits.end())
    return {static_cast<Rgb>(known->second & 255), static_cast<Alpha>(known->second >> 8), true};
  if (context.texture_fits.size() >= kMost) context.texture_fits.clear();
  const Fit fit = fit_texels(sampled, blends, has_border);
  context.texture_fits[key] = static_cast<std::uint32_t>(fit.rgb) | static_cast<std::uint32_t>(fit.alpha) << 8;
  return fit;
}

void say_what_is_missing(Frame& frame, const TextureObject& texture, bool has_borders) {
  const bool filters = is_linear(texture.min_filter) || is_linear(texture.mag_filter);
  for (std::size_t i = 0; !has_borders && i < (texture.target == GL_TEXTURE_1D ? 1U : 2U); ++i) {
    if (texture.wrap[i] == GL_CLAMP_TO_BORDER) frame.missing("GL_CLAMP_TO_BORDER", "drawn as GL_CLAMP_TO_EDGE");
    if (texture.wrap[i] == GL_CLAMP && filters)
      frame.missing("GL_CLAMP with a linear filter", "drawn as GL_CLAMP_TO_EDGE");
  }
  const TextureImage& image = texture.face[0][static_cast<std::size_t>(texture.base_level)];
  if (image.border != 0) frame.missing("borders of textures", "their texels are left out");
  if (texture.target == GL_TEXTURE_3D) frame.missing("three-dimensional textures", "the first layer is drawn");
  if (texture.target == GL_TEXTURE_CUBE_MAP) frame.missing("cube maps", "drawn without the texture");
  if (image.base_format == GL_DEPTH_COMPONENT && texture.compare_mode != GL_NONE)
    frame.missing("depth textures that compare", "the depths are drawn");
}

/// The texel that a coordinate in texels means along a side.
int wrapped(GLenum wrap, double at, int size) {
  const double last = size - 1;
  if (wrap == GL_REPEAT || wrap == GL_MIRRORED_REPEAT) {
    const double period = wrap == GL_REPEAT ? size : 2 * size;
    at -= std::floor(at / period) * period;
    if (at > last && wrap == GL_MIRRORED_REPEAT) at = period - 1 - at;
  }
  return static_cast<int>(at > 0 ? std::min(at, last) : 0);  // NaN: 0
}

/// A texture at one place, magnified.
Vec4 sampled_at(const Sampled& sampled, double s, double t) {
  const TextureImage& image = sampled.level(sampled.first);
  const TextureObject& texture = sampled.texture;
  const bool is_linear = texture.mag_filter == GL_LINEAR;
  const double shift = is_linear ? 0.5 : 0;
  const auto place = [&](double coordinate, int size, GLenum wrap) {
    const double held = wrap == GL_CLAMP ? std::clamp(coordinate, 0.0, 1.0) : coordinate;
    return held * size - shift;
  };
  const double u = place(s, image.width, texture.wrap[0]), v = place(t, image.height, texture.wrap[1]);
  const auto is_beyond = [&](double at, int size, GLenum wrap) {
    return shows_border(wrap, is_linear) && (at < 0 || at >= size);
  };
  Vec4 sum{};
  for (const int j : {0, 1})
    for (const int i : {0, 1}) {
      const double wide = i == 0 ? 1 - (u - std::floor(u)) : u - std::floor(u);
      const double high = j == 0 ? 1 - (v - std::floor(v)) : v - std::floor(v);
      const double weight = is_linear ? wide * high : (i == 0 && j == 0 ? 1 : 0);
      const int x = wrapped(texture.wrap[0], std::floor(u) + i, image.width);
      const int y = wrapped(texture.wrap[1], std::floor(v) + j, image.height);
      const bool is_border = is_beyond(std::floor(u) + i, image.width, texture.wrap[0]) ||
                             is_beyond(std::floor(v) + j, image.height, texture.wrap[1]);
      const std::size_t at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
      const Vec4 texel = real(is_border ? sampled.border() : sampled.texel(sampled.first, at));
      for (std::size_t c = 0; c < 4; ++c) sum[c] += weight * texel[c];
    }
  return sum;
}

GLenum base_of(const TextureObject& texture, const TextureImage& image) {
  return image.base_format == GL_DEPTH_COMPONENT ? texture.depth_mode : image.base_format;
}

TextureWrap wrap_of(GLenum wrap, bool shows_border) {
  if (wrap == GL_REPEAT) return TextureWrap::repeat;
  if (wrap == GL_MIRRORED_REPEAT) return TextureWrap::mirror;
  if (!shows_border) return TextureWrap::clamp;
  return wrap == GL_CLAMP ? TextureWrap::half_border : TextureWrap::border;
}

}  // namespace

TextureUse use_texture(Context& context, halfplane::State& state) {
  const TextureObject* texture = context.drawable == nullptr ? nullptr : sampled_texture(context, 0);
  if (texture == nullptr) return {};
  Frame& frame = context.drawable->frame;
  // A configuration without a texture unit has no hardware to keep to.
  const Config& config = frame.options().config;
  const bool has_unit = config.texture_unit != TextureUnitKind::off;
  const bool blends = !has_unit || config.texture_constants != 0, borders = !has_unit || config.texture_borders != 0;
  say_what_is_missing(frame, *texture, borders);
  if (texture->target == GL_TEXTURE_CUBE_MAP) return {};
  const TextureUnit& unit = context.state.texture.unit[0];
  const auto first = static_cast<std::size_t>(texture->base_level);
  const TextureImage& image = texture->face[0][first];
  const int side = std::max(image.width, image.height);
  const bool is_mipmapped = texture->min_filter != GL_NEAREST && texture->min_filter != GL_LINEAR;
  const std::size_t last =
      !is_mipmapped ? first
                    : std::min(first + static_cast<std::size_t>(std::bit_width(static_cast<unsigned>(side))) - 1,
                               static_cast<std::size_t>(texture->max_level));
  const bool has_levels = last > first;
  const Sampled sampled{*texture, unit, base_of(*texture, image), first, last};

  Key key(texture->revision, first, last, sampled.base);
  const bool has_border = borders && shows_border(*texture);
  std::optional<Fit> fit = direct_fit(unit.env_mode, sampled.base, blends);
  if (!fit) {
    key.add(unit.env_mode);
    for (const double channel : unit.env_color) key.add(std::bit_cast<std::uint64_t>(channel));
    for (const TextureCombiner& combiner : unit.combine) {
      if (unit.env_mode != GL_COMBINE) break;
      key.add(combiner.function);
      key.add(static_cast<std::uint64_t>(combiner.scale));
      for (std::size_t i = 0; i < 3; ++i) key.add(std::uint64_t{combiner.source[i]} << 32 | combiner.operand[i]);
    }
    if (has_border)
      for (const double channel : texture->border_color) key.add(std::bit_cast<std::uint64_t>(channel));
    fit = folded_fit(context, sampled, blends, has_border, key.value());
    if (!fit->is_exact())
      frame.missing(unit.env_mode == GL_COMBINE ? "this GL_COMBINE environment"
                    : unit.env_mode == GL_BLEND ? "this GL_BLEND environment"
                                                : "GL_ADD with GL_INTENSITY",
                    "drawn as for white vertices, multiplied with their colours");
  }
  const auto make = [&] { return made(sampled, *fit, has_levels); };
  state.texture = frame.texture(key.value(), std::cref(make));  // no memory for the function

  const GLenum min = has_levels || !is_mipmapped      ? texture->min_filter
                     : is_linear(texture->min_filter) ? GLenum{GL_LINEAR}
                                                      : GLenum{GL_NEAREST};
  state.texture_min = static_cast<TextureMin>(min >= GL_NEAREST_MIPMAP_NEAREST ? min - GL_NEAREST_MIPMAP_NEAREST + 2
                                                                               : min - GL_NEAREST);
  state.texture_mag = is_linear(texture->mag_filter) ? TextureMag::linear : TextureMag::nearest;
  const bool filters = is_linear(texture->min_filter) || is_linear(texture->mag_filter);
  const auto wrap = [&](std::size_t axis) {
    return wrap_of(texture->wrap[axis], has_border && shows_border(texture->wrap[axis], filters));
  };
  state.texture_wrap = {wrap(0), texture->target == GL_TEXTURE_1D ? TextureWrap::clamp : wrap(1)};
  if (has_border) state.texture_border = fit->folds ? folded(sampled, *fit, sampled.border()) : sampled.border();
  const double largest = has_levels ? static_cast<double>(last - first) : 12;
  const auto in = [](double value, double low, double high) { return value > low ? std::min(value, high) : low; };
  state.texture_lod = {in(texture->lod_bias + unit.lod_bias, -16, 16), in(texture->min_lod, 0, largest),
                       in(texture->max_lod, 0, largest)};
  const bool replaces_alpha = fit->alpha == Alpha::replace;
  state.texture_combine = fit->rgb == Rgb::add                                        ? TextureCombine::add
                          : fit->rgb == Rgb::decal || fit->rgb == Rgb::decal_constant ? TextureCombine::decal
                          : fit->rgb == Rgb::blend                                    ? TextureCombine::blend
                          : fit->rgb == Rgb::replace && replaces_alpha                ? TextureCombine::replace
                                                                                      : TextureCombine::modulate;
  if (fit->rgb == Rgb::blend)
    for (std::size_t c = 0; c < 3; ++c)
      state.texture_constant[c] = static_cast<std::uint8_t>(std::lround(255 * in(unit.env_color[c], 0, 1)));
  return {fit->rgb == Rgb::replace, replaces_alpha};
}

std::function<Vec4(const Vec4&)> raster_texture(const Context& context) {
  const TextureObject* texture = sampled_texture(context, 0);
  if (texture == nullptr || texture->target == GL_TEXTURE_CUBE_MAP) return {};
  const TextureUnit& unit = context.state.texture.unit[0];
  const auto base = static_cast<std::size_t>(texture->base_level);
  const Sampled sampled{*texture, unit, base_of(*texture, texture->face[0][base]), base, base};
  const auto& [s, t, r, q] = context.state.current.raster.tex_coord[0];
  return [&unit, format = sampled.base, texel = sampled_at(sampled, s / q, t / q)](const Vec4& color) {
    const Result result = environment(unit, format, texel, &color);
    Vec4 textured{};
    for (std::size_t c = 0; c < 4; ++c) textured[c] = held(result[c].a * color[c] + result[c].b);
    return textured;
  };
}

}  // namespace halfplane::gl
