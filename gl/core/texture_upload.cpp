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
#include "environment.hpp"
#include "matrix.hpp"
#include "sampler.hpp"
#include "texture.hpp"

namespace halfplane::gl {
namespace {

/// How RGB and alpha come from the vertex's colour and the texel that is handed to the model. none: the model has no mode
/// for it.
enum class Rgb : std::uint8_t { modulate, replace, add, decal, decal_constant, blend, none };
enum class Alpha : std::uint8_t { multiply, replace, none };
struct Fit {
  Rgb rgb = Rgb::modulate;
  Alpha alpha = Alpha::multiply;
  bool folds = false;  ///< the environment is folded into the texels
  [[nodiscard]] bool is_exact() const { return rgb != Rgb::none && alpha != Alpha::none; }
};

/// One channel of an environment's result for one texel: a times the vertex's, plus b.
struct Affine {
  Affine(double number = 0) : b(number) {}  // NOLINT(google-explicit-constructor): one that the vertex has no part in
  Affine(double a_, double b_, bool is_exact_ = true) : a(a_), b(b_), is_exact(is_exact_) {}
  double a = 0, b = 0;
  bool is_exact = true;  ///< else it has another form
};
Affine operator+(const Affine& x, const Affine& y) { return {x.a + y.a, x.b + y.b, x.is_exact && y.is_exact}; }
Affine operator-(const Affine& x, const Affine& y) { return {x.a - y.a, x.b - y.b, x.is_exact && y.is_exact}; }
Affine operator*(const Affine& x, const Affine& y) {
  if (x.a != 0 && y.a != 0) return {0, 0, false};
  return {x.a * y.b + y.a * x.b, x.b * y.b, x.is_exact && y.is_exact};
}
using Result = std::array<Affine, 4>;

constexpr double kTolerance = 1.0 / 512;
bool is_near(double x, double y) { return std::abs(x - y) < kTolerance; }

/// The environment of a unit. `texel`: as it is stored, in 0...1.
Result environment(const TextureUnit& unit, GLenum base, const Vec4& texel) {
  Result result;
  const auto source = [&](GLenum name, std::size_t c, std::size_t to) -> Affine {
    // The first unit's previous color is the primary one.
    if (name == GL_PRIMARY_COLOR || name == GL_PREVIOUS) return {1, 0, c == to};
    return name == GL_CONSTANT ? unit.env_color[c] : base == GL_ALPHA && c < 3 ? 0 : texel[c];
  };
  const auto& [rgb, alpha] = unit.combine;
  for (std::size_t c = 0; c < 4; ++c) {
    if (unit.env_mode != GL_COMBINE) {
      result[c] = plain<Affine>(unit, base, c, {1, 0}, texel);
      continue;
    }
    const TextureCombiner& combiner = c < 3 || rgb.function == GL_DOT3_RGBA ? rgb : alpha;
    Affine& value = result[c] = combined<Affine>(combiner, c, source);
    const bool is_sum_of_channels = combiner.function == GL_DOT3_RGB || combiner.function == GL_DOT3_RGBA;
    value = value * combiner.scale;
    value.is_exact = value.is_exact && (!is_sum_of_channels || value.a == 0);
    if (value.a == 0) value.b = held(value.b);
  }
  return result;
}

Vec4 real(const Texel& texel) { return {texel[0] / 255.0, texel[1] / 255.0, texel[2] / 255.0, texel[3] / 255.0}; }

/// Of the modes that take texels as they are; none: the texels decide. `blends`: the hardware has a constant color.
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
    if (level(l).base_format != GL_DEPTH_COMPONENT) return t;
    const auto depth = static_cast<std::uint8_t>(std::lround(255 * depth_of_texel(t)));
    return stored_texel(base, {depth, depth, depth, depth});
  }
  [[nodiscard]] Texel border() const { return border_texel(texture); }
  /// Texels of one level.
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
    const bool takes_a = c == 3 ? fit.alpha == Alpha::multiply : fit.rgb == Rgb::modulate;
    const bool takes_rest = c != 3 && fit.rgb == Rgb::blend;
    color[c] = static_cast<float>(takes_rest ? 1 - a : takes_a ? a : b);
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

/// How the model's unit draws a texture of a unit, if it does.
struct Choice {
  Choice(Context& context, const TextureObject& texture, const TextureUnit& unit)
      : sampled{texture, unit, base_of(texture), static_cast<std::size_t>(texture.base_level), last_level(texture)},
        key(texture.revision, sampled.first, sampled.last, sampled.base) {
    // A configuration without a texture unit has no hardware to keep to.
    const Config& config = context.drawable->frame.options().config;
    const bool has_unit = config.texture_unit != TextureUnitKind::off;
    const bool blends = !has_unit || config.texture_constants != 0;
    borders = !has_unit || config.texture_borders != 0;
    has_border = borders && shows_border(texture);
    if (const std::optional<Fit> direct = direct_fit(unit.env_mode, sampled.base, blends)) {
      fit = *direct;
      return;
    }
    key.add(unit.env_mode);
    for (const double channel : unit.env_color) key.add(std::bit_cast<std::uint64_t>(channel));
    for (const TextureCombiner& combiner : unit.combine) {
      if (unit.env_mode != GL_COMBINE) break;
      key.add(combiner.function);
      key.add(static_cast<std::uint64_t>(combiner.scale));
      for (std::size_t i = 0; i < 3; ++i) key.add(std::uint64_t{combiner.source[i]} << 32 | combiner.operand[i]);
    }
    if (has_border)
      for (const double channel : texture.border_color) key.add(std::bit_cast<std::uint64_t>(channel));
    fit = folded_fit(context, sampled, blends, has_border, key.value());
  }

  Sampled sampled;
  Key key;
  Fit fit;
  bool borders = false;     ///< the hardware has them
  bool has_border = false;  ///< the texture shows one
};

void say_what_is_missing(Frame& frame, const TextureObject& texture, bool has_borders) {
  const bool filters = is_linear(texture.min_filter) || is_linear(texture.mag_filter);
  for (std::size_t i = 0; !has_borders && i < (texture.target == GL_TEXTURE_1D ? 1U : 2U); ++i) {
    if (texture.wrap[i] == GL_CLAMP_TO_BORDER) frame.missing("GL_CLAMP_TO_BORDER", "drawn as GL_CLAMP_TO_EDGE");
    if (texture.wrap[i] == GL_CLAMP && filters)
      frame.missing("GL_CLAMP with a linear filter", "drawn as GL_CLAMP_TO_EDGE");
  }
  const TextureImage& image = texture.face[0][static_cast<std::size_t>(texture.base_level)];
  if (image.border != 0) frame.missing("borders of textures", "their texels are left out");
}

TextureWrap wrap_of(GLenum wrap, bool shows_border) {
  if (wrap == GL_REPEAT) return TextureWrap::repeat;
  if (wrap == GL_MIRRORED_REPEAT) return TextureWrap::mirror;
  if (!shows_border) return TextureWrap::clamp;
  return wrap == GL_CLAMP ? TextureWrap::half_border : TextureWrap::border;
}

}  // namespace

Texel border_texel(const TextureObject& texture) {
  std::array<float, 4> color{};
  std::ranges::transform(texture.border_color, color.begin(), [](double c) { return static_cast<float>(c); });
  Texel texel = texel_of(color);
  if (texture.face[0][static_cast<std::size_t>(texture.base_level)].base_format == GL_DEPTH_COMPONENT)
    texel.fill(texel[0]);
  return stored_texel(base_of(texture), texel);
}

const char* beyond_texture_unit(Context& context, unsigned units) {
  if (!std::has_single_bit(units)) return units == 0 ? nullptr : "several textures at once";
  const auto unit = static_cast<std::size_t>(std::countr_zero(units));
  const TextureObject& texture = *sampled_texture(context, static_cast<int>(unit));
  if (texture.target == GL_TEXTURE_3D) return "three-dimensional textures";
  if (texture.target == GL_TEXTURE_CUBE_MAP) return "cube maps";
  const TextureImage& image = texture.face[0][static_cast<std::size_t>(texture.base_level)];
  if (image.base_format == GL_DEPTH_COMPONENT && texture.compare_mode != GL_NONE) return "depth textures that compare";
  const TextureUnit& state = context.state.texture.unit[unit];
  if (Choice(context, texture, state).fit.is_exact()) return nullptr;
  return state.env_mode == GL_COMBINE ? "this GL_COMBINE environment"
         : state.env_mode == GL_BLEND ? "this GL_BLEND environment"
                                      : "GL_ADD with GL_INTENSITY";
}

TextureUse use_texture(Context& context, std::size_t unit, halfplane::State& state) {
  Frame& frame = context.drawable->frame;
  const TextureObject& texture = *sampled_texture(context, static_cast<int>(unit));
  const TextureUnit& from = context.state.texture.unit[unit];
  const Choice choice(context, texture, from);
  const Fit& fit = choice.fit;
  const Sampled& sampled = choice.sampled;
  say_what_is_missing(frame, texture, choice.borders);
  const bool has_levels = sampled.last > sampled.first;
  const auto make = [&] { return made(sampled, fit, has_levels); };
  state.texture = frame.texture(choice.key.value(), std::cref(make));  // no memory for the function

  const bool is_mipmapped = texture.min_filter != GL_NEAREST && texture.min_filter != GL_LINEAR;
  const GLenum min = has_levels || !is_mipmapped     ? texture.min_filter
                     : is_linear(texture.min_filter) ? GLenum{GL_LINEAR}
                                                     : GLenum{GL_NEAREST};
  state.texture_min = static_cast<TextureMin>(min >= GL_NEAREST_MIPMAP_NEAREST ? min - GL_NEAREST_MIPMAP_NEAREST + 2
                                                                               : min - GL_NEAREST);
  state.texture_mag = is_linear(texture.mag_filter) ? TextureMag::linear : TextureMag::nearest;
  const bool filters = is_linear(texture.min_filter) || is_linear(texture.mag_filter);
  const auto wrap = [&](std::size_t axis) {
    return wrap_of(texture.wrap[axis], choice.has_border && shows_border(texture.wrap[axis], filters));
  };
  state.texture_wrap = {wrap(0), texture.target == GL_TEXTURE_1D ? TextureWrap::clamp : wrap(1)};
  if (choice.has_border) state.texture_border = fit.folds ? folded(sampled, fit, sampled.border()) : sampled.border();
  const double largest = has_levels ? static_cast<double>(sampled.last - sampled.first) : 12;
  state.texture_lod = {held(texture.lod_bias + from.lod_bias, -16, 16), held(texture.min_lod, 0, largest),
                       held(texture.max_lod, 0, largest)};
  const bool replaces_alpha = fit.alpha == Alpha::replace;
  state.texture_combine = fit.rgb == Rgb::add                                       ? TextureCombine::add
                          : fit.rgb == Rgb::decal || fit.rgb == Rgb::decal_constant ? TextureCombine::decal
                          : fit.rgb == Rgb::blend                                   ? TextureCombine::blend
                          : fit.rgb == Rgb::replace && replaces_alpha               ? TextureCombine::replace
                                                                                    : TextureCombine::modulate;
  if (fit.rgb == Rgb::blend)
    for (std::size_t c = 0; c < 3; ++c)
      state.texture_constant[c] = static_cast<std::uint8_t>(std::lround(255 * held(from.env_color[c])));
  return {fit.rgb == Rgb::replace, replaces_alpha};
}

}  // namespace halfplane::gl
