// The one table of draw states: each member of State with its name, values, default and purpose, and where it lives.
//
// A new state is a member of State and a row of the table; draw_states.cpp does not compile while one of the two is
// missing, or while a value of an enum has no name. From the rows follow captures (reading, writing, messages), the hash
// of states, the reducer of co-simulation, the random states of tests, fuzzer and co-simulation, and the table of
// docs/capture.md.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "scene.hpp"

namespace halfplane {

/// Who needs a state once its draw is under way.
enum class StateHome {
  host,       ///< geometry uses it up: the hardware sees what it made of the vertices
  primitive,  ///< rides with the primitive through the hardware
  unit        ///< held by a unit of the hardware, from a token of kind state on
};

/// Any state's value in one form: a word of its list, or numbers.
struct StateValue {
  std::size_t word = 0;             ///< place in DrawState::words; words.size(): `numbers` say it
  std::array<double, 7> numbers{};  ///< as many as DrawState::numbers has; the others are 0
  bool operator==(const StateValue&) const = default;
};

/// One number of a value: its bounds, and what random states take.
struct StateNumber {
  std::string_view what;  ///< its name in messages
  double low = 0, high = 0;
  bool is_whole = false;
  bool is_positive = false;  ///< 0 itself is refused; `what` begins with the name of the state
  /// Random values: random_low + k * random_step, 0 <= k < random_count, near the small targets of tests.
  double random_low = 0, random_step = 0;
  unsigned random_count = 1;
  std::span<const std::string_view> words{};  ///< written as one of these: the number is its place
  bool is_texture = false;                    ///< an index into Scene::textures, written as a name
  /// May be left out with all behind it: it is then the number that stands so many places before it. 0: may not.
  std::size_t repeats = 0;
  bool is_hex = false;  ///< written in hexadecimal digits
};

/// A row of the table.
struct DrawState {
  std::string_view name;
  std::span<const std::string_view> words{};  ///< values that are one word, in the order of the enumerators
  std::span<const StateNumber> numbers{};     ///< the other form of a value, if there is one
  std::string_view form{};                    ///< what people write for the numbers: "x y width height"
  std::string_view unit{};                    ///< of the numbers, if they have one: "pixels"
  std::string_view purpose{};                 ///< Markdown, for docs/capture.md
  StateHome home = StateHome::host;
  std::string_view refused{};   ///< a word that the hardware refuses
  std::string_view simplest{};  ///< the word that a failing scene is reduced to, if not the default
  /// Do not call: see value() and set().
  StateValue (*get_value)(const State& state, std::size_t words) = nullptr;
  void (*set_value)(State& state, const StateValue& value, std::size_t words) = nullptr;

  [[nodiscard]] StateValue value(const State& state) const { return get_value(state, words.size()); }
  /// Precondition: a value that the row has, numbers within their bounds.
  void set(State& state, const StateValue& value) const { set_value(state, value, words.size()); }
  [[nodiscard]] bool is_same(const State& a, const State& b) const { return value(a) == value(b); }
  [[nodiscard]] StateValue default_value() const { return value(State{}); }
  /// The default, but for `space`: window space is simpler to look at, and a smaller target leaves it where it is.
  [[nodiscard]] StateValue simplest_value() const;
};

/// All rows, in the order in which captures write them: `space` first.
[[nodiscard]] std::span<const DrawState> draw_states();

/// The row of that name. Precondition: there is one.
[[nodiscard]] const DrawState& draw_state(std::string_view name);

/// Of all values of a state: equal states have equal signatures.
[[nodiscard]] Signature signature_of(const State& state);

/// Equal states have equal hashes.
struct StateHash {
  [[nodiscard]] std::size_t operator()(const State& state) const;
};

}  // namespace halfplane
