#include "sim/cosim/random_profile.hpp"

#include <algorithm>
#include <bit>
#include <map>

#include "model/as_number.hpp"
#include "model/capture/capture.hpp"
#include "model/host/primitive_stream.hpp"
#include "model/host/primitives.hpp"
#include "model/nearest_word.hpp"
#include "sim/config_file.hpp"
#include "sim/scene/random.hpp"
#include "sim/words.hpp"

namespace halfplane {
namespace {

constexpr std::array<std::string_view, 3> kKinds{"triangles", "lines", "points"};
constexpr std::array<std::string_view, 5> kDepths{"random", "flat", "equal", "front_to_back", "back_to_front"};
constexpr std::array<std::string_view, 10> kKnobs{"kinds", "no",    "target",   "size",         "ties",
                                                  "reuse", "depth", "textures", "texture_size", "overlap"};
constexpr int kMostTextures = 16, kMostTexels = 1024;

[[noreturn]] void fail(const std::string& place, const std::string& message) {
  throw InputError(place + ": " + message);
}

bool is_state(std::string_view name) {
  return std::ranges::find(draw_states(), name, &DrawState::name) != draw_states().end();
}

int whole_number_of(const std::string& text, int least, int most, const std::string& place, const std::string& key) {
  const auto value = as_number<int>(text);
  if (!value || *value < least || *value > most)
    fail(place,
         key + ": '" + text + "' is not a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return *value;
}

/// Two numbers with `between` in between, the first at most the second if `is_range`.
std::array<int, 2> pair_of(const std::string& text, std::string_view between, int most, const std::string& place,
                           const std::string& key) {
  const std::size_t at = text.find(between);
  if (at == std::string::npos)
    fail(place, key + ": '" + text + "' has no '" + std::string(between) + "'; give two numbers, as in 16" +
                    std::string(between) + "64");
  return {whole_number_of(text.substr(0, at), 1, most, place, key),
          whole_number_of(text.substr(at + between.size()), 1, most, place, key)};
}

/// Of two states that this hardware refuses together, changes the one that the profile does not have.
void settle(State& s, Topology topology, const Config& config, const RandomProfile& profile) {
  const bool is_triangle = topology == Topology::triangles;
  const bool has_only_triangles = profile.has_kinds() && !profile.kinds[1];
  if (is_triangle && (has_only_triangles || (config.line_units == 0 && s.line_rule != LineRule::rectangle)) &&
      profile.rule("polygon_mode") == nullptr)
    s.polygon_mode = PolygonMode::fill;
  if (drawn_as(s, topology) != PrimitiveType::triangle) s.color_interp = ColorInterp::affine;
  if (config.texture_unit == TextureUnitKind::nearest || config.texture_unit == TextureUnitKind::bilinear) {
    if (profile.rule("texture_min") == nullptr) s.texture_min = static_cast<TextureMin>(s.texture_mag);
    s.texture_mag = static_cast<TextureMag>(s.texture_min);  // the unit knows one filter
  }
  if (!s.texture || s.texture_interp == TextureInterp::perspective) return;
  if (profile.rule("texture_interp") == nullptr && (s.fog || s.shade == Shade::phong)) {
    s.texture_interp = TextureInterp::perspective;
    return;
  }
  if (s.color_interp == ColorInterp::perspective && profile.rule("texture_interp") == nullptr) {
    s.texture_interp = TextureInterp::perspective;
    return;
  }
  s.fog.reset();
  if (s.shade == Shade::phong) s.shade = Shade::smooth;
  s.color_interp = ColorInterp::affine;
}

class Reader {
 public:
  explicit Reader(const Config& config) : config_(config) {}

  void list(const std::string& text, const std::string& place) {
    for (const std::string& word : words_of(text, ',')) {
      if (word.ends_with(".toml")) {
        for (const TomlWord& one : read_toml_words(word))
          knob(one.key, one.value, word + ":" + std::to_string(one.line));
      } else if (const auto equals = word.find('='); equals != std::string::npos) {
        knob(word.substr(0, equals), word.substr(equals + 1), place);
      } else if (word.starts_with("no-")) {
        knob("no", word.substr(3), place);
      } else if (std::ranges::find(kKinds, word) != kKinds.end()) {
        knob("kinds", word, place);
      } else if (const auto& functions = draw_state("depth_test").words;
                 std::ranges::find(functions, word) != functions.end()) {
        knob("depth_test", word, place);
      } else if (!word.empty() && word.front() >= '0' && word.front() <= '9') {
        knob("target", word, place);
      } else {
        unknown(word, place);
      }
    }
  }

  RandomProfile finish(const std::string& text) {
    for (const auto& [name, values] : states_) profile_.rules.push_back({&draw_state(name), values});
    profile_.text = text;
    const auto has = [this](std::string_view name, std::size_t word, bool is_word) {
      const auto* rule = profile_.rule(name);
      return rule != nullptr && std::ranges::any_of(rule->values, [&](const StateValue& value) {
               return (value.word == word) == is_word;
             });
    };
    // A triangle has one plane of 1/w: texture_interp affine goes with none of these.
    if (has("texture_interp", static_cast<std::size_t>(TextureInterp::affine), true) &&
        (has("fog", draw_state("fog").words.size() - 1, false) ||
         has("shade", static_cast<std::size_t>(Shade::phong), true) ||
         has("color_interp", static_cast<std::size_t>(ColorInterp::perspective), true)))
      fail("--random-only",
           "texture_interp=affine goes with no fog, shade=phong or color_interp=perspective in this "
           "hardware; leave one out");
    return std::move(profile_);
  }

 private:
  [[noreturn]] static void unknown(const std::string& word, const std::string& place) {
    std::vector<std::string_view> names(kKinds.begin(), kKinds.end());
    names.insert(names.end(), kKnobs.begin(), kKnobs.end());
    names.insert(names.end(), draw_state("depth_test").words.begin(), draw_state("depth_test").words.end());
    for (const DrawState& row : draw_states()) names.push_back(row.name);
    fail(place, "no knob '" + word + "';" + did_you_mean(word, names) +
                    " give triangles, lines, points, a depth function, WxH, STATE=VALUE, no-STATE, no-clears, "
                    "size=A..B, ties=N, reuse=N, overlap=N, depth=ORDER, textures=N, texture_size=N or FILE.toml");
  }

  void knob(const std::string& key, const std::string& value, const std::string& place) {
    const auto percent = [&] { return whole_number_of(value, 0, 100, place, key); };
    if (key == "kinds") {
      for (const std::string& kind : words_of(value, '|')) {
        const auto found = std::ranges::find(kKinds, kind);
        if (found == kKinds.end()) fail(place, "kinds: no '" + kind + "'; give some of triangles, lines, points");
        profile_.kinds[static_cast<std::size_t>(found - kKinds.begin())] = true;
      }
      if (profile_.kinds[1] && config_.line_units == 0)
        fail(place, "lines: this hardware has no unit that draws them; set lines.unit=1, or leave lines out");
    } else if (key == "no") {
      for (const std::string& name : words_of(value, '|')) leave_out(name, place);
    } else if (key == "target") {
      const auto [width, height] = pair_of(value, "x", 16384, place, key);
      if (width > config_.target_width || height > config_.target_height)
        fail(place, "target: " + value + " is more than the " + std::to_string(config_.target_width) + "x" +
                        std::to_string(config_.target_height) +
                        " of this configuration; set target.width and "
                        "target.height");
      profile_.width = width;
      profile_.height = height;
    } else if (key == "size") {
      const auto [least, most] = pair_of(value, "..", config_.guard_band, place, key);
      if (least > most) fail(place, "size: " + value + " goes down; write the smaller number first");
      profile_.extent = {least, most};
    } else if (key == "ties") {
      profile_.ties = percent();
    } else if (key == "reuse") {
      profile_.reuse = percent();
    } else if (key == "overlap") {
      profile_.overlap = percent();
    } else if (key == "depth") {
      const auto found = std::ranges::find(kDepths, value);
      if (found == kDepths.end())
        fail(place, "depth: no order '" + value + "'; give random, flat, equal, front_to_back or back_to_front");
      profile_.depth = static_cast<RandomProfile::DepthOrder>(found - kDepths.begin());
    } else if (key == "textures" || key == "texture_size") {
      if (config_.texture_unit == TextureUnitKind::off)
        fail(place, key + ": this hardware has no texture unit; set texture.unit=nearest, or leave it out");
      auto& number = key == "textures" ? profile_.textures : profile_.texels;
      number = whole_number_of(value, 1, key == "textures" ? kMostTextures : kMostTexels, place, key);
      if (key == "texture_size" && !std::has_single_bit(static_cast<unsigned>(*number)))
        fail(place, "texture_size: " + value + " is not a power of two, the only sizes of texture units");
    } else if (is_state(key) && key != "space") {
      for (const std::string& one : words_of(value, '|')) states_[key].push_back(state_value(key, one, place));
    } else {
      unknown(key, place);
    }
  }

  void leave_out(const std::string& name, const std::string& place) {
    if (name == "clears") {
      profile_.has_clears = false;
    } else if (std::ranges::find(kKinds, name) != kKinds.end()) {
      fail(place,
           "no-" + name + ": say which kinds are left, as in " + (name == "lines" ? "triangles,points" : "lines"));
    } else if (is_state(name) && name != "space") {
      states_[name].push_back(draw_state(name).default_value());
    } else {
      unknown(name, place);
    }
  }

  /// A value as a capture writes it. Throws for one that the hardware does not have, whatever is drawn.
  StateValue state_value(const std::string& name, const std::string& text, const std::string& place) {
    static constexpr std::string_view kHead = "halfplane 1\ntarget 1 1\n",
                                      kTail = "space window\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const DrawState& row = draw_state(name);
    std::string states = "state " + name + " " + text + "\n";
    if (name.starts_with("texture_")) {
      states = "texture t pattern chequer 4 4\nstate texture t\n" + states;
      if ((name == "texture_min" || name == "texture_mag") && (text == "nearest" || text == "linear"))
        states += "state texture_m" + std::string(name.back() == 'n' ? "ag " : "in ") + text + "\n";
    }
    for (const std::string_view drawn : {"t 0 1 2\n", "l 0 1\n", "p 0\n"}) {
      if (drawn[0] == 'l' && config_.line_units == 0) continue;
      const std::string capture = std::string(kHead) + states + std::string(kTail) + std::string(drawn);
      try {
        const Scene scene = read_capture(capture, "");
        check_hardware_scene(scene, config_);
        if (drawn[0] == 'p') return row.value(scene.states.front());
      } catch (const InputError& error) {
        std::string why = error.what();
        if (const auto colon = why.find(": "); colon != std::string::npos) why.erase(0, colon + 2);
        fail(place, name + "=" + text + ": " + why);
      }
    }
    return {};
  }

  const Config& config_;
  RandomProfile profile_;
  std::map<std::string, std::vector<StateValue>> states_;  // in an order that does not depend on that of the words
};

}  // namespace

const RandomProfile::StateRule* RandomProfile::rule(std::string_view state) const {
  const auto found = std::ranges::find_if(rules, [state](const StateRule& one) { return one.row->name == state; });
  return found == rules.end() ? nullptr : &*found;
}

RandomProfile read_random_profile(const std::string& text, const Config& config) {
  Reader reader(config);
  reader.list(text, "--random-only");
  return reader.finish(text);
}

void apply_profile(Scene& scene, const Config& config, const RandomProfile& profile, std::uint64_t seed) {
  Random random(seed ^ 0x701f11eu);
  for (const Command& command : scene.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    State& state = scene.states[draw != nullptr ? draw->state : std::get<Clear>(command).state];
    for (const RandomProfile::StateRule& rule : profile.rules)
      rule.row->set(state, rule.values[random.next() % rule.values.size()]);
    if (draw != nullptr && !profile.text.empty()) settle(state, draw->topology, config, profile);
  }
}

}  // namespace halfplane
