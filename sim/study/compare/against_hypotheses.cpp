#include "against_hypotheses.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <unordered_map>

#include "model/capture/capture_states.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"

namespace halfplane {
namespace {

constexpr int kMostSubpixelBits = 8;

/// The engine's image of a scene; none if it refuses it.
std::optional<ImageValues> drawn_values(const HypothesisScene& of, const Scene& scene, const Config& config,
                                        const StudyRules& rules) {
  try {
    RenderOptions options;
    options.rules = rules;
    const Rendering drawn =
        rules == StudyRules{} ? render_functional(scene, config) : render_scalar(scene, config, options);
    return image_values(drawn.frame, config.color_format, of.is_depth);
  } catch (const InputError&) {  // for example too wide together with the rest of this configuration
    return {};
  }
}

/// A copy of the scene that hypotheses change, draw and restore.
class ChangedScene {
 public:
  explicit ChangedScene(const HypothesisScene& of) : of_(of), scene_(of.scene) {}

  std::optional<ImageValues> with_states(const std::function<void(State& state)>& change) {
    for (State& state : scene_.states) change(state);
    auto values = drawn_values(of_, scene_, of_.config, of_.rules);
    scene_.states = of_.scene.states;
    return values;
  }

  using MovedCoordinate = std::function<std::array<double, 2>(const Vertex& vertex, int width, int height)>;
  /// The image with other texture coordinates, made from a vertex and the size of its texture.
  std::optional<ImageValues> with_coordinates(const MovedCoordinate& moved) {
    if (!has_own_vertices_) give_own_vertices();
    for (const OwnVertex& own : own_) {
      const auto [u, v] = moved(of_.scene.vertices[own.vertex], own.width, own.height);
      scene_.vertices[own.copy].u = u;
      scene_.vertices[own.copy].v = v;
    }
    auto values = drawn_values(of_, scene_, of_.config, of_.rules);
    for (const OwnVertex& own : own_) scene_.vertices[own.copy] = of_.scene.vertices[own.vertex];
    return values;
  }

 private:
  struct OwnVertex {
    std::uint32_t vertex, copy;
    int width, height;  ///< of the texture, texels
  };

  /// Draws share vertices, but textures have different sizes.
  void give_own_vertices() {
    has_own_vertices_ = true;
    const bool has_normals = !scene_.normals.empty();
    for (Command& command : scene_.commands) {
      auto* draw = std::get_if<Draw>(&command);
      if (draw == nullptr || !of_.scene.states[draw->state].texture) continue;
      const Texture& texture = of_.scene.textures[*of_.scene.states[draw->state].texture];
      std::unordered_map<std::uint32_t, std::uint32_t> copies;
      const std::size_t first = scene_.indices.size();
      for (std::size_t i = draw->first; i < draw->first + draw->count; ++i) {
        const std::uint32_t index = of_.scene.indices[i];
        if (index == kRestart) {
          scene_.indices.push_back(index);
          continue;
        }
        const auto [copy, is_new] = copies.try_emplace(index, static_cast<std::uint32_t>(scene_.vertices.size()));
        if (is_new) {
          own_.push_back({index, copy->second, texture.width(), texture.height()});
          scene_.vertices.push_back(of_.scene.vertices[index]);
          if (has_normals) {
            scene_.normals.resize(scene_.vertices.size());
            scene_.normals.back() = of_.scene.normal(index);
          }
        }
        scene_.indices.push_back(copy->second);
      }
      draw->first = first;
    }
  }

  const HypothesisScene& of_;
  Scene scene_;
  std::vector<OwnVertex> own_;
  bool has_own_vertices_ = false;
};

/// The other values of a state: its other words, and each of its words-as-numbers exchanged, with the numbers that
/// repeat it.
std::vector<StateValue> other_values(const DrawState& row, const StateValue& value) {
  std::vector<StateValue> others;
  const bool has_numbers = value.word == row.words.size();
  for (std::size_t w = 0; w < row.words.size(); ++w)
    if (w != value.word) others.push_back({w, {}});
  if (!has_numbers) return others;
  const auto exchange = [&](const std::vector<std::size_t>& places, std::size_t word) {
    StateValue other = value;
    for (const std::size_t i : places) other.numbers[i] = static_cast<double>(word);
    if (other != value) others.push_back(other);
  };
  for (std::size_t i = 0; i < row.numbers.size(); ++i) {
    const std::size_t words = row.numbers[i].words.size();
    std::vector<std::size_t> places{i};
    for (std::size_t k = i + 1; k < row.numbers.size(); ++k)
      if (row.numbers[k].repeats == k - i && value.numbers[k] == value.numbers[i]) places.push_back(k);
    for (std::size_t w = 0; w < words; ++w) exchange(places, w);
  }
  if (row.numbers.size() == 2 && row.numbers[1].repeats == 0)  // both at once: texture_wrap
    for (std::size_t w = 0; w < row.numbers[0].words.size(); ++w) exchange({0, 1}, w);
  return others;
}

class Hypotheses {
 public:
  explicit Hypotheses(const HypothesisScene& of) : of_(of), changed_(std::make_shared<ChangedScene>(of)) {
    for (std::size_t s = 0; s < of.scene.states.size(); ++s)
      if (s < of.is_touched.size() && of.is_touched[s]) touched_.push_back(&of.scene.states[s]);
  }

  std::vector<Hypothesis> all() && {
    add(ForeignDifference::snap, "no snap, as the golden",
        [&of = of_] { return image_values(of.golden, of.config.color_format, of.is_depth); });
    add_states(ForeignDifference::depth_func, "depth_test", [](const State&) { return true; });
    for (int bits = 0; bits <= kMostSubpixelBits; ++bits) add_snap(bits);
    const bool has_alpha_test =
        std::ranges::any_of(touched_, [](const State* s) { return s->alpha_test.func != DepthFunc::always; });
    if (of_.is_depth && !has_alpha_test) return std::move(list_);
    if (!of_.is_depth && of_.config.color_format == ColorFormat::rgb565)
      add_states(ForeignDifference::dither, "dither", [](const State&) { return true; });
    if (std::ranges::any_of(touched_, is_textured)) add_textures();
    if (!of_.is_depth)
      for (const char* name : {"blend_equation", "blend"})
        add_states(ForeignDifference::blend, name, [](const State& s) { return s.blend.has_value(); });
    if (!of_.is_depth) add_states(ForeignDifference::blend, "logic_op", has_logic_op);
    return std::move(list_);
  }

 private:
  static bool has_logic_op(const State& state) { return state.logic_op != LogicOp::copy; }
  static bool is_textured(const State* state) { return state->texture.has_value(); }

  void add(ForeignDifference kind, std::string change, std::function<std::optional<ImageValues>()> draw) {
    list_.push_back({kind, std::move(change), std::move(draw)});
  }

  void add_snap(int bits) {
    if (bits == of_.config.subpixel_bits) return;
    Config other = of_.config;
    other.subpixel_bits = bits;
    add(ForeignDifference::snap, "subpixel.bits=" + std::to_string(bits),
        [&of = of_, other] { return drawn_values(of, of.scene, other, of.rules); });
  }

  /// Each value that a touched state has, exchanged for each other one in all states that have it.
  void add_states(ForeignDifference kind, std::string_view name, bool (*is_of)(const State&)) {
    const DrawState& row = draw_state(name);
    std::vector<const State*> seen;
    for (const State* state : touched_) {
      if (!is_of(*state)) continue;
      if (std::ranges::any_of(seen, [&](const State* s) { return row.is_same(*s, *state); })) continue;
      seen.push_back(state);
      for (const StateValue& value : other_values(row, row.value(*state))) add_state(kind, row, *state, value, is_of);
    }
  }

  void add_state(ForeignDifference kind, const DrawState& row, const State& from, const StateValue& value,
                 bool (*is_of)(const State&)) {
    State to = from;
    row.set(to, value);
    std::string change(row.name);
    write_state_value(to, row, of_.scene.textures, change);
    change += " in place of";
    write_state_value(from, row, of_.scene.textures, change);
    add(kind, change, [changed = changed_, &row, from, value, is_of] {
      return changed->with_states([&](State& state) {
        if (is_of(state) && row.is_same(state, from)) row.set(state, value);
      });
    });
  }

  void add_textures() {
    constexpr auto kKind = ForeignDifference::texture;
    constexpr auto is_one = [](const State& s) { return s.texture.has_value(); };
    const auto with = [this](const std::string& change, void (*set)(State&)) {
      add(kKind, change, [changed = changed_, set] {
        return changed->with_states([set](State& state) {
          if (state.texture) set(state);
        });
      });
    };
    for (const char* name : {"texture_mag", "texture_min"}) add_states(kKind, name, is_one);
    with("texture_min and texture_mag nearest",
         [](State& s) { s.texture_min = TextureMin::nearest, s.texture_mag = TextureMag::nearest; });
    with("texture_min and texture_mag linear",
         [](State& s) { s.texture_min = TextureMin::linear, s.texture_mag = TextureMag::linear; });
    for (const char* name : {"texture_wrap", "texture_interp", "texture_combine"}) add_states(kKind, name, is_one);
    with("a level of detail more", [](State& s) { s.texture_lod[0] += 1; });
    with("a level of detail less", [](State& s) { s.texture_lod[0] -= 1; });
    add_coordinates("texture coordinates upside down", [](const Vertex& v, int, int) -> std::array<double, 2> {
      return {v.u, 1 - v.v};
    });
    for (const double step : {0.5, 1.0})
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          if (x != 0 || y != 0) add_moved(step * x, step * y);
    if (of_.rules == StudyRules{})
      add(kKind, "weights of 4 bits",
          [&of = of_] { return drawn_values(of, of.scene, of.config, {.weights = Weights::four}); });
  }

  void add_coordinates(std::string change, const ChangedScene::MovedCoordinate& moved) {
    add(ForeignDifference::texture, std::move(change),
        [changed = changed_, moved] { return changed->with_coordinates(moved); });
  }

  void add_moved(double x, double y) {
    const auto text = [](double value) {
      std::string out;
      append_number(out, value);
      return out;
    };
    add_coordinates("texture coordinates " + text(x) + " " + text(y) + " texels off",
                    [x, y](const Vertex& v, int width, int height) -> std::array<double, 2> {
                      return {v.u + x / width, v.v + y / height};
                    });
  }

  const HypothesisScene& of_;
  std::shared_ptr<ChangedScene> changed_;
  std::vector<const State*> touched_;
  std::vector<Hypothesis> list_;
};

}  // namespace

std::vector<Hypothesis> hypotheses(const HypothesisScene& of) { return Hypotheses(of).all(); }

}  // namespace halfplane
