// Pairs of values of draw states: the states of fragment operations and of textures, and which pairs have been drawn.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string_view>
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
  /// The word of a row, or the word of its number `number`.
  const auto word = [](std::string_view name, const DrawState& row, std::optional<std::size_t> number = {},
                       std::string_view part_of = {}) {
    const Words words = number ? row.numbers[*number].words : row.words;
    return Dimension{name,
                     static_cast<int>(words.size()),
                     [&row, number, part_of](const State& s) {
                       if (!part_of.empty() && draw_state(part_of).value(s).word == 0) return -1;
                       const StateValue value = row.value(s);
                       return static_cast<int>(number ? value.numbers[*number] : static_cast<double>(value.word));
                     },
                     [&row, number](State& s, int v) {
                       StateValue value = row.value(s);
                       if (number)
                         value.numbers[*number] = v;
                       else
                         value.word = static_cast<std::size_t>(v);
                       row.set(s, value);
                     },
                     row.name,
                     words,
                     part_of};
  };
  const auto direct = [word](std::string_view name, std::string_view part_of = {}) {
    return word(name, draw_state(name), {}, part_of);
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
      direct("depth_test"),
      direct("shade"),
      direct("depth_write"),
      direct("color_write"),
      direct("cull"),
      word("alpha_test", draw_state("alpha_test"), 0),
      optional("stencil", &State::stencil, Stencil{}),
      {"stencil_back", 2, [](const State& s) { return s.stencil ? (s.stencil_back ? 1 : 0) : -1; },
       [](State& s, int v) {
         if (v == 0) s.stencil_back.reset();
         if (v == 1 && !s.stencil_back)
           s.stencil_back =
               Stencil{DepthFunc::notequal, 1, 255, 15, StencilOp::incr, StencilOp::invert, StencilOp::decr_wrap};
       },
       "stencil_back", kBack, "stencil"},
      word("stencil func", draw_state("stencil"), 0, "stencil"),
      word("sfail", draw_state("stencil"), 4, "stencil"),
      word("zfail", draw_state("stencil"), 5, "stencil"),
      word("zpass", draw_state("stencil"), 6, "stencil"),
      optional("blend", &State::blend, BlendFactors{}),
      word("src", draw_state("blend"), 0, "blend"),
      word("dst", draw_state("blend"), 1, "blend"),
      word("src_alpha", draw_state("blend"), 2, "blend"),
      word("dst_alpha", draw_state("blend"), 3, "blend"),
      word("equation", draw_state("blend_equation"), 0, "blend"),
      word("alpha equation", draw_state("blend_equation"), 1, "blend"),
      {"color_mask", 8,
       [](const State& s) { return (s.color_mask[0] ? 1 : 0) + (s.color_mask[1] ? 2 : 0) + (s.color_mask[2] ? 4 : 0); },
       [](State& s, int v) {
         for (std::size_t n = 0; n < 3; ++n) s.color_mask[n] = (v >> n & 1) != 0;
       },
       "color_mask", kMask},
      direct("dither"),
      {"fog", 4, [](const State& s) { return s.fog ? 1 + static_cast<int>(s.fog->kind) : 0; },
       [](State& s, int v) {
         if (v == 0) return s.fog.reset();
         const auto kind = static_cast<FogKind>(v - 1);
         if (!s.fog || s.fog->kind != kind) s.fog = kind == FogKind::linear ? Fog{kind, 0.25, 3} : Fog{kind, 0.75, 0};
       },
       "fog", kFog},
      optional("texture", &State::texture, std::uint32_t{0}),
      direct("texture_combine", "texture"),
      direct("texture_interp", "texture"),
      word("texture_wrap s", draw_state("texture_wrap"), 0, "texture"),
      word("texture_wrap t", draw_state("texture_wrap"), 1, "texture"),
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
