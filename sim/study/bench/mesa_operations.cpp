#include "sim/study/bench/mesa_operations.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>

namespace halfplane::gl {

namespace {

std::vector<Texel> texels_of(const Texture& texture, int level) {
  const TextureLevel& image = texture.level[static_cast<std::size_t>(level)];
  std::vector<Texel> texels;
  texels.reserve(image.code.size());
  for (const std::uint32_t code : image.code) texels.push_back(decode_texel(texture.format, code, texture.palette));
  return texels;
}

Enum min_filter(TextureMin min) {
  if (min == TextureMin::nearest) return kNearest;
  if (min == TextureMin::linear) return kLinear;
  return kNearestMipmapNearest + static_cast<Enum>(min) - static_cast<Enum>(TextureMin::nearest_mipmap_nearest);
}

}  // namespace

std::vector<Name> make_textures(const Functions& gl, const Scene& scene) {
  std::vector<Name> names(scene.textures.size());
  gl.gen_textures(static_cast<int>(names.size()), names.data());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Texture& texture = scene.textures[i];
    gl.bind_texture(kTexture2d, names[i]);
    for (int n = 0; n <= texture.last_level(); ++n) {
      const TextureLevel& level = texture.level[static_cast<std::size_t>(n)];
      gl.tex_image_2d(kTexture2d, n, kRgba8, level.width, level.height, 0, kRgba, kUnsignedByte,
                      texels_of(texture, n).data());
    }
    gl.tex_parameteri(kTexture2d, kMaxLevel, texture.last_level());
  }
  return names;
}

void apply_texture(const Functions& gl, Name texture, const State& state) {
  constexpr std::array kWraps{kRepeat, kClampToEdge, kMirroredRepeat, kClampToBorder, kClamp};
  gl.bind_texture(kTexture2d, texture);
  gl.tex_parameteri(kTexture2d, kMinFilter, static_cast<int>(min_filter(state.texture_min)));
  gl.tex_parameteri(kTexture2d, kMagFilter,
                    static_cast<int>(state.texture_mag == TextureMag::linear ? kLinear : kNearest));
  for (std::size_t axis = 0; axis < 2; ++axis)
    gl.tex_parameteri(kTexture2d, kWrapS + static_cast<Enum>(axis),
                      static_cast<int>(kWraps[static_cast<std::size_t>(state.texture_wrap[axis])]));
  if (has_border(state.texture_wrap[0]) || has_border(state.texture_wrap[1])) {
    std::array<float, 4> border{};
    for (std::size_t c = 0; c < border.size(); ++c) border[c] = static_cast<float>(state.texture_border[c]) / 255;
    gl.tex_parameterfv(kTexture2d, kBorderColor, border.data());
  }
  constexpr std::array kLods{kLodBias, kMinLod, kMaxLod};
  for (std::size_t i = 0; i < kLods.size(); ++i)
    gl.tex_parameterf(kTexture2d, kLods[i], static_cast<float>(state.texture_lod[i]));
}

std::string combine_source(const State& state, bool has_alpha) {
  switch (state.texture_combine) {
    case TextureCombine::modulate: return "color * texel";
    case TextureCombine::replace: return has_alpha ? "texel" : "vec4(texel.rgb, color.a)";
    case TextureCombine::decal: return "vec4(mix(color.rgb, texel.rgb, texel.a), color.a)";
    case TextureCombine::blend: {
      std::string constant = "vec3(";
      for (std::size_t c = 0; c < 3; ++c)
        constant += std::to_string(int{state.texture_constant[c]}) + (c == 2 ? ".0)" : ".0, ");
      return "vec4(mix(color.rgb, " + constant + " / 255.0, texel.rgb), color.a * texel.a)";
    }
    case TextureCombine::add: break;
  }
  return "vec4(color.rgb + texel.rgb, color.a * texel.a)";
}
namespace {

constexpr std::array<Enum, 15> kFactors{0,     1,     0x300,  0x301,  0x306,  0x307,  0x302, 0x303,
                                        0x304, 0x305, 0x8001, 0x8002, 0x8003, 0x8004, 0x308};
constexpr std::array<Enum, 5> kEquations{0x8006, 0x800a, 0x800b, 0x8007, 0x8008};
constexpr Enum kClear = 0x1500;  // the first of sixteen logic operations, which LogicOp has in the same order
constexpr std::array<Enum, 8> kStencilOps{0x1e00, 0, 0x1e01, 0x1e02, 0x1e03, 0x150a, 0x8507, 0x8508};

Enum factor(BlendFactor f) { return kFactors[static_cast<std::size_t>(f)]; }
Enum equation(BlendEquation e) { return kEquations[static_cast<std::size_t>(e)]; }
Enum operation(StencilOp op) { return kStencilOps[static_cast<std::size_t>(op)]; }

}  // namespace

Enum comparison(DepthFunc func) {
  constexpr std::array<Enum, 8> kComparisons{0x200, 0x201, 0x203, 0x202, 0x204, 0x206, 0x205, 0x207};
  return kComparisons[static_cast<std::size_t>(func)];
}

void apply_operations(const Functions& gl, const State& state) {
  const auto writes = [&](std::size_t c) {
    return static_cast<unsigned char>(state.color_write && state.color_mask[c]);
  };
  gl.color_mask(writes(0), writes(1), writes(2), writes(3));
  state.blend ? gl.enable(kBlend) : gl.disable(kBlend);
  if (state.blend) {
    const BlendFactors& f = *state.blend;
    gl.blend_func_separate(factor(f.src), factor(f.dst), factor(f.src_alpha), factor(f.dst_alpha));
    gl.blend_equation_separate(equation(state.blend_equation[0]), equation(state.blend_equation[1]));
    const auto part = [&](std::size_t c) { return static_cast<float>(state.blend_color[c] / 255.0); };
    gl.blend_color(part(0), part(1), part(2), part(3));
  }
  const bool has_logic_op = state.logic_op != LogicOp::copy;
  has_logic_op ? gl.enable(kColorLogicOp) : gl.disable(kColorLogicOp);
  if (has_logic_op) gl.logic_op(kClear + static_cast<Enum>(state.logic_op));
  state.stencil ? gl.enable(kStencilTest) : gl.disable(kStencilTest);
  if (!state.stencil) return;
  for (const Enum side : {kFront, kBack}) {
    const Stencil& s = side == kBack && state.stencil_back ? *state.stencil_back : *state.stencil;
    gl.stencil_func_separate(side, comparison(s.func), s.reference, s.read_mask);
    gl.stencil_op_separate(side, operation(s.stencil_fails), operation(s.depth_fails), operation(s.passes));
    gl.stencil_mask_separate(side, s.write_mask);
  }
}

std::string alpha_test_source(const AlphaTest& test) {
  constexpr std::array<const char*, 8> kComparisons{"", " < ", " <= ", " == ", " > ", " >= ", " != ", ""};
  if (test.func == DepthFunc::always) return "";
  if (test.func == DepthFunc::never) return "discard;";
  return "if (!(floor(result.a * 255.0 + 0.5)" + std::string(kComparisons[static_cast<std::size_t>(test.func)]) +
         std::to_string(test.reference) + ".0)) discard;";
}

std::string fog_source(const State& state) {
  if (!state.fog) return "";
  const auto number = [](double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.9e", value);
    return std::string(text.data());
  };
  const Fog& fog = *state.fog;
  const std::string w = "float w = 1.0 / gl_FragCoord.w; ", depth = "(w * " + number(fog.start) + ")";
  const double start = std::min(fog.start, fog.end * 255 / 256);
  const std::string part = fog.kind == FogKind::exp    ? "exp(-" + depth + ")"
                           : fog.kind == FogKind::exp2 ? "exp(-" + depth + " * " + depth + ")"
                                                       : "(" + number(fog.end) + " - w) / " + number(fog.end - start);
  std::string color;
  for (const std::uint8_t channel : state.fog_color) color += (color.empty() ? "" : ", ") + number(channel / 255.0);
  return w + "result.rgb = mix(vec3(" + color + "), result.rgb, clamp(" + part + ", 0.0, 1.0));";
}

}  // namespace halfplane::gl
