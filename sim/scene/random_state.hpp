// Random draw states from their table, for tests, fuzzers and co-simulation.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "model/draw_states.hpp"

namespace halfplane {

/// Picks one of 0...n-1, n > 0: by random numbers, or by the bytes of a fuzzer.
using Chooser = std::function<std::uint32_t(std::uint32_t n)>;

/// Chooses by random numbers: from our generator (next() or index()), or from <random>. Keeps a reference.
template <class Random>
[[nodiscard]] Chooser chooser(Random& random) {
  return [&random](std::uint32_t n) {
    if constexpr (requires { random.next(); })
      return static_cast<std::uint32_t>(random.next() % n);
    else if constexpr (requires { random.index(1); })
      return static_cast<std::uint32_t>(random.index(static_cast<int>(n)));
    else
      return static_cast<std::uint32_t>(random() % n);
  };
}

/// Whether words that only the golden model supports may occur.
enum class Refused { left_out, kept };

/// Any value of the row: each word equally likely, numbers (from the table) as likely as all words together. A row of
/// words takes one choice.
[[nodiscard]] StateValue random_value(const DrawState& row, const Chooser& choose, Refused refused = Refused::left_out);

/// Rows of the table.
using StateRows = std::vector<const DrawState*>;
[[nodiscard]] StateRows states_named(std::initializer_list<std::string_view> names);
[[nodiscard]] StateRows states_but(std::initializer_list<std::string_view> names);

/// All rows except those held by units downstream of the depth test: fragment operations.
[[nodiscard]] StateRows without_operations(StateRows rows);

/// `state` with random values in those rows, each unchanged in half of the cases.
[[nodiscard]] State random_state(State state, const StateRows& rows, const Chooser& choose,
                                 Refused refused = Refused::left_out);

}  // namespace halfplane
