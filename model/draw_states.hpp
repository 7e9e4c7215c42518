// The one table of draw states: each member of State with its name, values, default, purpose and home.
//
// A new state is a member of State and a row of the table; draw_states.cpp does not compile while one of the two is
// missing, or while a value of an enum has no name. These follow from the rows: captures (reading, writing, messages),
// the hash of states, the reducer of co-simulation, the random states of tests, fuzzer and co-simulation, and the table
// of docs/capture.md.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "scene.hpp"

namespace halfplane {

/// The place that needs a state after its draw is sent.
enum class StateHome {
  host,       ///< consumed by geometry: the hardware sees only its effect on the vertices
  primitive,  ///< travels with the primitive through the hardware
  unit        ///< held in a unit of the hardware, set by a token of kind state
};

/// The value of any state in one form: a word of its list, or numbers.
struct StateValue {
  std::size_t word = 0;             ///< index into DrawState::words; words.size(): `numbers` hold the value
  std::array<double, 7> numbers{};  ///< as many as DrawState::numbers has; the rest is 0
  bool operator==(const StateValue&) const = default;
};

/// One number of a value: its bounds, and its random values.
struct StateNumber {
  std::string_view what;  ///< its name in messages
  double low = 0, high = 0;
  bool is_whole = false;
  bool is_positive = false;  ///< 0 itself is refused; `what` begins with the name of the state
  /// Random values: random_low + k * random_step, 0 <= k < random_count, near the small targets of tests.
  double random_low = 0, random_step = 0;
  unsigned random_count = 1;
  std::span<const std::string_view> words{};  ///< written as one of these: the number is its index
  bool is_texture = false;                    ///< an index into Scene::textures, written as a name
  /// It and all later numbers may be left out: it then equals the number that many places before. 0: mandatory.
  std::size_t repeats = 0;
  bool is_hex = false;  ///< written in hexadecimal digits
};

/// A row of the table.
struct DrawState {
  std::string_view name;
  std::span<const std::string_view> words{};  ///< values that are one word, in the order of the enumerators
  std::span<const StateNumber> numbers{};     ///< the other form of a value, if there is one
  std::string_view form{};                    ///< the written form of the numbers: "x y width height"
  std::string_view unit{};                    ///< unit of the numbers, if any: "pixels"
  std::string_view purpose{};                 ///< Markdown, for docs/capture.md
  StateHome home = StateHome::host;
  std::string_view refused{};   ///< a word that the hardware refuses
  std::string_view simplest{};  ///< the word that a failing scene is reduced to, if not the default
  /// Do not call: see value() and set().
  StateValue (*get_value)(const State& state, std::size_t words) = nullptr;
  void (*set_value)(State& state, const StateValue& value, std::size_t words) = nullptr;

  [[nodiscard]] StateValue value(const State& state) const { return get_value(state, words.size()); }
  /// Precondition: a value of the row, numbers within their bounds.
  void set(State& state, const StateValue& value) const { set_value(state, value, words.size()); }
  [[nodiscard]] bool is_same(const State& a, const State& b) const { return value(a) == value(b); }
  [[nodiscard]] StateValue default_value() const { return value(State{}); }
  /// The default, except for `space`: window space is simpler to read, and does not move with a smaller target.
  [[nodiscard]] StateValue simplest_value() const;
};

/// All rows, in the order in which captures write them: `space` first.
[[nodiscard]] std::span<const DrawState> draw_states();

/// The row with that name. Precondition: it exists.
[[nodiscard]] const DrawState& draw_state(std::string_view name);

/// Signature of all values of a state: equal states have equal signatures.
[[nodiscard]] Signature signature_of(const State& state);

/// Equal states have equal hashes.
struct StateHash {
  [[nodiscard]] std::size_t operator()(const State& state) const;
};

}  // namespace halfplane
