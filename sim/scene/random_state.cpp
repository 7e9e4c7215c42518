#include "sim/scene/random_state.hpp"

#include <algorithm>

namespace halfplane {

StateValue random_value(const DrawState& row, const Chooser& choose, Refused refused) {
  StateValue value{row.words.size(), {}};
  const bool has_numbers = !row.numbers.empty() && row.numbers.front().random_count > 0;
  if (!row.words.empty() && (!has_numbers || choose(2) == 0)) {
    const auto out = static_cast<std::size_t>(std::ranges::find(row.words, row.refused) - row.words.begin());
    const bool is_short = refused == Refused::left_out && out < row.words.size();
    value.word = choose(static_cast<std::uint32_t>(row.words.size() - (is_short ? 1 : 0)));
    if (is_short && value.word >= out) ++value.word;
    return value;
  }
  for (std::size_t i = 0; i < row.numbers.size(); ++i) {
    const StateNumber& number = row.numbers[i];
    value.numbers[i] = number.random_low + choose(number.random_count) * number.random_step;
  }
  return value;
}

StateRows states_named(std::initializer_list<std::string_view> names) {
  StateRows rows;
  for (const std::string_view name : names) rows.push_back(&draw_state(name));
  return rows;
}

StateRows states_but(std::initializer_list<std::string_view> names) {
  StateRows rows;
  for (const DrawState& row : draw_states())
    if (std::ranges::find(names, row.name) == names.end()) rows.push_back(&row);
  return rows;
}

StateRows without_operations(StateRows rows) {
  std::erase_if(rows, [](const DrawState* row) { return row->home == StateHome::unit; });
  return rows;
}

State random_state(State state, const StateRows& rows, const Chooser& choose, Refused refused) {
  for (const DrawState* row : rows)
    if (choose(2) == 0) row->set(state, random_value(*row, choose, refused));
  return state;
}

}  // namespace halfplane
