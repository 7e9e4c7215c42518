// Pairs of values of draw states: the states of fragment operations and of textures, and which pairs have been drawn.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "model/draw_states.hpp"

namespace halfplane::cover {

/// A state, as a number from 0 to values - 1; negative where a draw has none of it.
struct Dimension {
  std::string_view name;
  int values;
  std::function<int(const State&)> value;
  std::function<void(State&, int)> set;
  std::string_view row;                     ///< of the table of draw states that has it
  std::span<const std::string_view> words;  ///< of its values
  std::string_view part_of = {};            ///< the state that has it; where that is off there is none of it
};

inline std::vector<Dimension> dimensions() {
  using Words = std::span<const std::string_view>;
  static constexpr std::array<std::string_view, 2> kSwitch{"off", "on"}, kBack{"same", "other"};
  static constexpr std::array<std::string_view, 4> kFog{"off", "linear", "exp", "exp2"};
  static constexpr std::array<std::string_view, 8> kMask{"none", "r", "g", "rg", "b", "rb", "gb", "rgb"};
  const Words functions = draw_state("depth_test").words, operations = draw_state("stencil").numbers[4].words;
  /// A member, by the number of its enumerator.
  const auto direct = [](std::string_view name, int values, auto member) {
    using Value = std::remove_cvref_t<decltype(std::declval<State>().*member)>;
    return Dimension{name,
                     values,
                     [member](const State& s) { return static_cast<int>(s.*member); },
                     [member](State& s, int v) { s.*member = static_cast<Value>(v); },
                     name,
                     draw_state(name).words};
  };
  const auto side = [](std::string_view name, auto member, Words words) {
    using Value = std::remove_cvref_t<decltype(std::declval<Stencil>().*member)>;
    return Dimension{name,
                     8,
                     [member](const State& s) { return s.stencil ? static_cast<int>((*s.stencil).*member) : -1; },
                     [member](State& s, int v) { (*s.stencil).*member = static_cast<Value>(v); },
                     "stencil",
                     words,
                     "stencil"};
  };
  const auto factor = [](std::string_view name, auto member) {
    using Value = std::remove_cvref_t<decltype(std::declval<BlendFactors>().*member)>;
    return Dimension{name,
                     15,
                     [member](const State& s) { return s.blend ? static_cast<int>((*s.blend).*member) : -1; },
                     [member](State& s, int v) { (*s.blend).*member = static_cast<Value>(v); },
                     "blend",
                     draw_state("blend").numbers[0].words,
                     "blend"};
  };
  const auto equation = [](std::string_view name, std::size_t n) {
    return Dimension{name,
                     5,
                     [n](const State& s) { return s.blend ? static_cast<int>(s.blend_equation[n]) : -1; },
                     [n](State& s, int v) { s.blend_equation[n] = static_cast<BlendEquation>(v); },
                     "blend_equation",
                     draw_state("blend_equation").numbers[0].words,
                     "blend"};
  };
  const auto wrap = [](std::string_view name, std::size_t n) {
    return Dimension{name,
                     5,
                     [n](const State& s) { return s.texture ? static_cast<int>(s.texture_wrap[n]) : -1; },
                     [n](State& s, int v) { s.texture_wrap[n] = static_cast<TextureWrap>(v); },
                     "texture_wrap",
                     draw_state("texture_wrap").numbers[0].words,
                     "texture"};
  };
  /// A state that is off, or has the value of `make`.
  const auto optional = [](std::string_view name, auto member, auto make) {
    return Dimension{name,
                     2,
                     [member](const State& s) { return s.*member ? 1 : 0; },
                     [member, make](State& s, int v) {
                       if (v == 0) (s.*member).reset();
                       if (v == 1 && !(s.*member)) s.*member = make;
                     },
                     name,
                     kSwitch};
  };
  return {
      direct("depth_test", 8, &State::depth_test),
      direct("shade", 3, &State::shade),
      direct("depth_write", 2, &State::depth_write),
      direct("color_write", 2, &State::color_write),
      direct("cull", 4, &State::cull),
      {"alpha_test", 8, [](const State& s) { return static_cast<int>(s.alpha_test.func); },
       [](State& s, int v) { s.alpha_test.func = static_cast<DepthFunc>(v); }, "alpha_test", functions},
      optional("stencil", &State::stencil, Stencil{}),
      {"stencil_back", 2, [](const State& s) { return s.stencil ? (s.stencil_back ? 1 : 0) : -1; },
       [](State& s, int v) {
         if (v == 0) s.stencil_back.reset();
         if (v == 1 && !s.stencil_back)
           s.stencil_back =
               Stencil{DepthFunc::notequal, 1, 255, 15, StencilOp::incr, StencilOp::invert, StencilOp::decr_wrap};
       },
       "stencil_back", kBack, "stencil"},
      side("stencil func", &Stencil::func, functions),
      side("sfail", &Stencil::stencil_fails, operations),
      side("zfail", &Stencil::depth_fails, operations),
      side("zpass", &Stencil::passes, operations),
      optional("blend", &State::blend, BlendFactors{}),
      factor("src", &BlendFactors::src),
      factor("dst", &BlendFactors::dst),
      factor("src_alpha", &BlendFactors::src_alpha),
      factor("dst_alpha", &BlendFactors::dst_alpha),
      equation("equation", 0),
      equation("alpha equation", 1),
      {"color_mask", 8,
       [](const State& s) { return (s.color_mask[0] ? 1 : 0) + (s.color_mask[1] ? 2 : 0) + (s.color_mask[2] ? 4 : 0); },
       [](State& s, int v) {
         for (std::size_t n = 0; n < 3; ++n) s.color_mask[n] = (v >> n & 1) != 0;
       },
       "color_mask", kMask},
      direct("dither", 2, &State::dither),
      {"fog", 4, [](const State& s) { return s.fog ? 1 + static_cast<int>(s.fog->kind) : 0; },
       [](State& s, int v) {
         if (v == 0) return s.fog.reset();
         const auto kind = static_cast<FogKind>(v - 1);
         if (!s.fog || s.fog->kind != kind) s.fog = kind == FogKind::linear ? Fog{kind, 0.25, 3} : Fog{kind, 0.75, 0};
       },
       "fog", kFog},
      optional("texture", &State::texture, std::uint32_t{0}),
      {"texture_combine", 5, [](const State& s) { return s.texture ? static_cast<int>(s.texture_combine) : -1; },
       [](State& s, int v) { s.texture_combine = static_cast<TextureCombine>(v); }, "texture_combine",
       draw_state("texture_combine").words, "texture"},
      {"texture_interp", 2, [](const State& s) { return s.texture ? static_cast<int>(s.texture_interp) : -1; },
       [](State& s, int v) { s.texture_interp = static_cast<TextureInterp>(v); }, "texture_interp",
       draw_state("texture_interp").words, "texture"},
      wrap("texture_wrap s", 0),
      wrap("texture_wrap t", 1),
  };
}

/// Whether a draw can have both values: no part of a disabled unit; no fog or light with an affine texture, which
/// hardware refuses by name.
inline bool is_possible(const Dimension& a, int va, const Dimension& b, int vb) {
  const auto is_part = [](const Dimension& part, const Dimension& whole, int v) {
    return part.part_of == whole.name && v == 0;
  };
  const auto is_refused = [](const Dimension& of, int v, const Dimension& interp, int w) {
    return ((of.name == "fog" && v != 0) || (of.name == "shade" && v == static_cast<int>(Shade::phong))) &&
           interp.name == "texture_interp" && w == static_cast<int>(TextureInterp::affine);
  };
  return !is_part(a, b, vb) && !is_part(b, a, va) && !is_refused(a, va, b, vb) && !is_refused(b, vb, a, va);
}

/// Which pairs of values have been seen, and how often.
class PairCounts {
 public:
  explicit PairCounts(const std::vector<Dimension>& all) : all_(all) {
    for (std::size_t a = 0; a < all.size(); ++a)
      for (std::size_t b = a + 1; b < all.size(); ++b)
        seen_[{a, b}].resize(static_cast<std::size_t>(all[a].values * all[b].values));
  }

  void add(const State& state) {
    std::vector<int> values;
    for (const Dimension& dimension : all_) values.push_back(dimension.value(state));
    add(values);
  }
  void add(const std::vector<int>& values) {
    for (auto& [pair, counts] : seen_)
      if (const int a = values[pair.first], b = values[pair.second]; a >= 0 && b >= 0) ++counts[place(pair, a, b)];
  }

  [[nodiscard]] std::size_t times(std::size_t a, int va, std::size_t b, int vb) const {
    return a < b ? seen_.at({a, b})[place({a, b}, va, vb)] : seen_.at({b, a})[place({b, a}, vb, va)];
  }

  /// visit(a, va, b, vb, times) for each pair that is possible.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const auto& [pair, counts] : seen_)
      for (int va = 0; va < all_[pair.first].values; ++va)
        for (int vb = 0; vb < all_[pair.second].values; ++vb)
          if (is_possible(all_[pair.first], va, all_[pair.second], vb))
            visit(pair.first, va, pair.second, vb, counts[place(pair, va, vb)]);
  }

 private:
  using Pair = std::pair<std::size_t, std::size_t>;
  [[nodiscard]] std::size_t place(const Pair& pair, int a, int b) const {
    return static_cast<std::size_t>(a * all_[pair.second].values + b);
  }

  const std::vector<Dimension>& all_;
  std::map<Pair, std::vector<std::size_t>> seen_;
};

}  // namespace halfplane::cover
