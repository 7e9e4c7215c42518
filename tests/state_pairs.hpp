// Pairs of values of draw states: the states of fragment operations and of textures, and scenes in which every pair of
// values of two of them is drawn, in as few draws as a greedy choice takes.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "model/config.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/scene/random.hpp"
#include "sim/scene/random_state.hpp"

namespace halfplane::test {

/// A state, as a number from 0 to values - 1; negative where a draw has none of it.
struct Dimension {
  std::string_view name;
  int values;
  std::function<int(const State&)> value;
  std::function<void(State&, int)> set;
  std::string_view part_of = {};  ///< the state that has it; where that is off there is none of it
};

inline std::vector<Dimension> dimensions() {
  /// A member, by the number of its enumerator.
  const auto direct = [](std::string_view name, int values, auto member) {
    using Value = std::remove_cvref_t<decltype(std::declval<State>().*member)>;
    return Dimension{name, values, [member](const State& s) { return static_cast<int>(s.*member); },
                     [member](State& s, int v) { s.*member = static_cast<Value>(v); }};
  };
  const auto side = [](std::string_view name, auto member) {
    using Value = std::remove_cvref_t<decltype(std::declval<Stencil>().*member)>;
    return Dimension{name, 8,
                     [member](const State& s) { return s.stencil ? static_cast<int>((*s.stencil).*member) : -1; },
                     [member](State& s, int v) { (*s.stencil).*member = static_cast<Value>(v); }, "stencil"};
  };
  const auto factor = [](std::string_view name, auto member) {
    using Value = std::remove_cvref_t<decltype(std::declval<BlendFactors>().*member)>;
    return Dimension{name, 15, [member](const State& s) { return s.blend ? static_cast<int>((*s.blend).*member) : -1; },
                     [member](State& s, int v) { (*s.blend).*member = static_cast<Value>(v); }, "blend"};
  };
  const auto equation = [](std::string_view name, std::size_t n) {
    return Dimension{name, 5, [n](const State& s) { return s.blend ? static_cast<int>(s.blend_equation[n]) : -1; },
                     [n](State& s, int v) { s.blend_equation[n] = static_cast<BlendEquation>(v); }, "blend"};
  };
  const auto wrap = [](std::string_view name, std::size_t n) {
    return Dimension{name, 3, [n](const State& s) { return s.texture ? static_cast<int>(s.texture_wrap[n]) : -1; },
                     [n](State& s, int v) { s.texture_wrap[n] = static_cast<TextureWrap>(v); }, "texture"};
  };
  /// A state that is off, or has the value of `make`.
  const auto optional = [](std::string_view name, auto member, auto make) {
    return Dimension{name, 2, [member](const State& s) { return s.*member ? 1 : 0; },
                     [member, make](State& s, int v) {
                       if (v == 0) (s.*member).reset();
                       if (v == 1 && !(s.*member)) s.*member = make;
                     }};
  };
  return {
      direct("depth_test", 8, &State::depth_test),
      direct("shade", 3, &State::shade),
      direct("depth_write", 2, &State::depth_write),
      direct("color_write", 2, &State::color_write),
      direct("cull", 4, &State::cull),
      {"alpha_test", 8, [](const State& s) { return static_cast<int>(s.alpha_test.func); },
       [](State& s, int v) { s.alpha_test.func = static_cast<DepthFunc>(v); }},
      optional("stencil", &State::stencil, Stencil{}),
      {"stencil_back", 2, [](const State& s) { return s.stencil ? (s.stencil_back ? 1 : 0) : -1; },
       [](State& s, int v) {
         if (v == 0) s.stencil_back.reset();
         if (v == 1 && !s.stencil_back)
           s.stencil_back =
               Stencil{DepthFunc::notequal, 1, 255, 15, StencilOp::incr, StencilOp::invert, StencilOp::decr_wrap};
       },
       "stencil"},
      side("stencil func", &Stencil::func),
      side("sfail", &Stencil::stencil_fails),
      side("zfail", &Stencil::depth_fails),
      side("zpass", &Stencil::passes),
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
       }},
      direct("dither", 2, &State::dither),
      {"fog", 4, [](const State& s) { return s.fog ? 1 + static_cast<int>(s.fog->kind) : 0; },
       [](State& s, int v) {
         if (v == 0) return s.fog.reset();
         const auto kind = static_cast<FogKind>(v - 1);
         if (!s.fog || s.fog->kind != kind) s.fog = kind == FogKind::linear ? Fog{kind, 0.25, 3} : Fog{kind, 0.75, 0};
       }},
      optional("texture", &State::texture, std::uint32_t{0}),
      {"texture_combine", 4, [](const State& s) { return s.texture ? static_cast<int>(s.texture_combine) : -1; },
       [](State& s, int v) { s.texture_combine = static_cast<TextureCombine>(v); }, "texture"},
      {"texture_interp", 2, [](const State& s) { return s.texture ? static_cast<int>(s.texture_interp) : -1; },
       [](State& s, int v) { s.texture_interp = static_cast<TextureInterp>(v); }, "texture"},
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

/// Values of all states, a row a draw, so that each pair is in some row: the first missing pair, then state by state
/// the value that adds most of the missing pairs.
inline std::vector<std::vector<int>> pair_rows(const std::vector<Dimension>& all, std::uint64_t seed) {
  halfplane::Random random(seed);
  PairCounts counts(all);
  std::vector<std::vector<int>> rows;
  constexpr int kUnset = -2;
  const auto index_of = [&all](std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(all, name, &Dimension::name) - all.begin());
  };
  while (true) {
    std::vector<int> row(all.size(), kUnset);
    bool is_missing = false;
    counts.for_each([&](std::size_t a, int va, std::size_t b, int vb, std::size_t times) {
      if (times != 0 || is_missing) return;
      is_missing = true;
      row[a] = va;
      row[b] = vb;
    });
    if (!is_missing) return rows;
    for (std::size_t n = 0; n < all.size(); ++n)
      if (row[n] >= 0 && !all[n].part_of.empty()) row[index_of(all[n].part_of)] = 1;
    std::vector<std::size_t> order;  // parts in order, after the commands before them
    for (const bool parts : {false, true}) {
      const auto first = static_cast<std::ptrdiff_t>(order.size());
      for (std::size_t n = 0; n < all.size(); ++n)
        if (all[n].part_of.empty() != parts) order.push_back(n);
      for (auto n = static_cast<std::size_t>(first); n < order.size(); ++n)
        std::swap(order[n], order[n + random.next() % (order.size() - n)]);
    }
    for (const std::size_t n : order) {
      if (row[n] != kUnset) continue;
      std::size_t best = 0, ties = 0;
      for (int v = 0; v < all[n].values; ++v) {
        bool fits = true;
        std::size_t gain = 1;
        for (std::size_t m = 0; m < all.size() && fits; ++m) {
          if (m == n || row[m] < 0) continue;
          fits = is_possible(all[n], v, all[m], row[m]);
          if (fits && counts.times(n, v, m, row[m]) == 0) ++gain;
        }
        if (!fits || gain < best) continue;
        ties = gain > best ? 1 : ties + 1;
        best = gain;
        if (random.next() % ties == 0) row[n] = v;
      }
      if (row[n] == kUnset) row[n] = -1;  // a part of a disabled unit
    }
    counts.add(row);
    rows.push_back(std::move(row));
  }
}

/// Random scenes of 150 primitives whose draws have the values of the rows, one row a draw.
inline std::vector<Scene> paired_scenes(const Config& config, const std::vector<Dimension>& all, std::uint64_t seed) {
  const auto rows = pair_rows(all, seed);
  std::vector<Scene> scenes;
  for (std::size_t next = 0; next < rows.size(); ++seed) {
    Scene scene = random_scene(config, seed, 150);
    scene.name = "paired-" + std::to_string(seed);
    for (const Command& command : scene.commands) {
      const auto* draw = std::get_if<Draw>(&command);
      if (draw == nullptr || next == rows.size()) continue;
      State& state = scene.states[draw->state];
      for (std::size_t n = 0; n < all.size(); ++n)
        if (rows[next][n] >= 0 && all[n].part_of.empty()) all[n].set(state, rows[next][n]);
      for (std::size_t n = 0; n < all.size(); ++n)
        if (rows[next][n] >= 0 && !all[n].part_of.empty()) all[n].set(state, rows[next][n]);
      ++next;
    }
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

}  // namespace halfplane::test
