// The table of draw states, and that everything derived from it agrees.
#include "model/draw_states.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "model/capture/capture.hpp"
#include "model/capture/capture_states.hpp"
#include "model/packets/packet_words.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/cosim/reduce.hpp"
#include "sim/scene/random.hpp"
#include "sim/scene/random_state.hpp"
#include "tests/committed.hpp"
#include "tests/pipeline_case.hpp"
#include "tests/scene_builder.hpp"

namespace halfplane::draw_states_test {
namespace {

/// Every word of a row, and numbers once.
std::vector<StateValue> values_of(const DrawState& row) {
  std::vector<StateValue> values;
  for (std::size_t word = 0; word < row.words.size(); ++word) values.push_back({word, {}});
  if (row.numbers.empty() || row.numbers.front().random_count == 0) return values;  // names of textures: texture_test
  StateValue value{row.words.size(), {}};
  for (std::size_t i = 0; i < row.numbers.size(); ++i)
    value.numbers[i] =
        row.numbers[i].random_low + std::min(3U, row.numbers[i].random_count - 1) * row.numbers[i].random_step;
  if (row.name == "fog") {  // the others have a density and no end
    value.numbers[0] = static_cast<double>(FogKind::linear);
    values.push_back(value);
    value.numbers[0] = static_cast<double>(FogKind::exp2);
    value.numbers[2] = value.numbers[1];
  }
  values.push_back(value);
  return values;
}

TEST(DrawStates, EachRowReadsAndWritesAMemberOfItsOwn) {
  for (const DrawState& row : draw_states())
    for (const StateValue& value : values_of(row)) {
      State state;
      row.set(state, value);
      EXPECT_EQ(row.value(state), value) << row.name;
      EXPECT_EQ(state == State{}, value == row.default_value()) << row.name;
      EXPECT_EQ(StateHash{}(state) == StateHash{}(State{}), value == row.default_value()) << row.name;
      for (const DrawState& other : draw_states())
        EXPECT_EQ(other.is_same(state, State{}), &other != &row || value == row.default_value()) << other.name;
    }
}

TEST(DrawStates, EveryValueIsReadBackFromACapture) {
  for (const DrawState& row : draw_states())
    for (const StateValue& value : values_of(row)) {
      State state;
      row.set(state, value);
      std::string line = &row == &capture_space() ? "" : "state ";
      line += row.name;
      write_state_value(state, row, {}, line);
      const std::string text = "halfplane 1\nv 0 0 0\n" + line + "\np 0\n";
      EXPECT_EQ(read_capture(text, "test.hpt").states.at(0), state) << line;
    }
}

/// A line of a state as it is written again.
std::string written_again(const std::string& row, const std::string& value) {
  const State state =
      read_capture("halfplane 1\nv 0 0 0\nstate " + row + " " + value + "\np 0\n", "test.hpt").states.at(0);
  std::string text;
  write_state_value(state, draw_state(row), {}, text);
  return text.substr(1);
}

// Captures of before say a third number.
TEST(DrawStates, FogHasANumberLessWhereItHasADensity) {
  for (const std::string kind : {"exp", "exp2"})
    for (const std::string rest : {"", " 0.25", " 0", " 7"})
      EXPECT_EQ(written_again("fog", kind + " 0.25" + rest), kind + " 0.25");
  EXPECT_EQ(written_again("fog", "linear 4 12"), "linear 4 12");
  EXPECT_EQ(written_again("fog", "linear 0 0.25"), "linear 0 0.25");
  State made;
  made.fog = Fog{FogKind::exp, 0.5, 0};  // set by a program; the third value is unused
  std::string text;
  write_state_value(made, draw_state("fog"), {}, text);
  EXPECT_EQ(text, " exp 0.5");
  State other = made;
  other.fog->end = 3;
  EXPECT_TRUE(draw_state("fog").is_same(made, other));
  made.fog->kind = other.fog->kind = FogKind::linear;
  EXPECT_FALSE(draw_state("fog").is_same(made, other));
}

TEST(DrawStates, WhatRidesWithThePrimitiveIsWhatItsPacketHas) {
  std::set<std::string> fields;
  for (const auto& [name, width] : element_names<PrimitivePacket>(derive_widths(preset("tiny")))) fields.insert(name);
  for (const DrawState& row : draw_states()) {
    const bool rides = std::ranges::any_of(
        fields, [&](const std::string& field) { return field == row.name || field == std::string(row.name) + "_cw"; });
    EXPECT_EQ(rides, row.home == StateHome::primitive) << row.name;
  }
}

std::string words_of(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "`" : " `") + std::string(word) + "`";
  return text;
}

/// "x, y: −5 to 5": the names in `form` with the same bounds together.
std::string bounds_of(const DrawState& row) {
  std::istringstream words{std::string(row.form)};
  std::string text, names, last;
  for (const StateNumber& number : row.numbers) {
    std::string name, bounds;
    words >> name;
    std::erase_if(name, [](char c) { return c == '[' || c == ']'; });
    if (number.is_texture) return "the name of a `texture` line";
    const auto append = [&](double value) {
      if (number.is_whole || std::abs(value) < 1e7)
        bounds += std::to_string(static_cast<long>(value));
      else
        append_number(bounds, value);
    };
    if (number.words.empty()) {
      append(number.low);
      bounds += " to ";
      append(number.high);
    } else {
      bounds = words_of(number.words);
    }
    if (number.is_positive) bounds += ", above 0";
    if (bounds != last && !last.empty()) text += names + ": " + last + "; ", names.clear();
    names += (names.empty() ? "" : ", ") + name;
    last = bounds;
  }
  return text + names + ": " + last;
}

/// The row of docs/capture.md.
std::string markdown(const DrawState& row) {
  std::string text = "| `" + std::string(row.name) + "` |";
  for (const std::string_view word : row.words) text += " `" + std::string(word) + "`";
  if (!row.numbers.empty())
    text += std::string(row.words.empty() ? "" : ", or") + " `" + std::string(row.form) + "`" +
            (row.unit.empty() ? "" : " in " + std::string(row.unit)) + " (" + bounds_of(row) + ")";
  std::string value;
  write_state_value(State{}, row, {}, value);
  return text + " | `" + value.substr(1) + "` | " + std::string(row.purpose) + " | " +
         (row.home == StateHome::host        ? "host"
          : row.home == StateHome::primitive ? "primitive"
                                             : "unit") +
         " |";
}

TEST(DrawStates, TheCommittedTableOfTheReferencePageIsThisOne) {
  test::expect_committed("docs/capture.md", [](const std::string& page) {
    const std::size_t begin = page.find("\n| --- ", page.find("\n## States\n")), rows = page.find('\n', begin + 1) + 1;
    std::string text = page.substr(0, rows);
    for (const DrawState& row : draw_states()) text += markdown(row) + "\n";
    return text + page.substr(page.find("\n\n", begin) + 1);
  });
}

// ---- the reducer

TEST(DrawStates, TheReducerSetsEveryStateThatDoesNotMatterToItsDefault) {
  const Config config = preset("tiny");
  constexpr double kMark = 7;  // as w of a window-space vertex it means nothing, and the reducer leaves it
  const FailTest test = [](const Scene& s, const LockstepOptions&) -> std::optional<Mismatch> {
    const bool fails = std::ranges::any_of(s.vertices, [](const Vertex& v) { return v.w == kMark; });
    return fails ? std::optional(Mismatch{}) : std::nullopt;
  };
  for (const DrawState& row : draw_states())
    for (const StateValue& value : values_of(row)) {
      State state;
      state.space = Space::window;
      row.set(state, value);
      test::SceneBuilder builder(16, 16, state);
      builder.triangle(test::at(1, 1), test::clip_at(9, 1, 0.5, kMark), test::at(1, 9));
      const auto reduced = reduce(builder.scene, config, {}, test);
      ASSERT_TRUE(reduced.has_value()) << row.name;
      ASSERT_EQ(reduced->scene.states.size(), 1u) << row.name;
      const State& left = reduced->scene.states[0];
      for (const DrawState& other : draw_states()) EXPECT_EQ(other.value(left), other.simplest_value()) << row.name;
    }
}

// Must fail: a state that does matter stays.
TEST(DrawStates, TheReducerLeavesAStateThatMatters) {
  const Config config = preset("tiny");
  for (const DrawState& row : draw_states())
    for (const StateValue& value : values_of(row)) {
      State state;
      state.space = Space::window;
      row.set(state, value);
      const FailTest test = [&](const Scene& s, const LockstepOptions&) -> std::optional<Mismatch> {
        const bool fails = std::ranges::any_of(s.states, [&](const State& t) { return row.value(t) == value; });
        return fails ? std::optional(Mismatch{}) : std::nullopt;
      };
      if (value == row.simplest_value()) continue;
      if (row.refused == (value.word < row.words.size() ? row.words[value.word] : "")) continue;
      test::SceneBuilder builder(16, 16, state);
      builder.triangle(test::at(1, 1), test::at(9, 1), test::at(1, 9));
      const auto reduced = reduce(builder.scene, config, {}, test);
      ASSERT_TRUE(reduced.has_value()) << row.name;
      EXPECT_EQ(row.value(reduced->scene.states.at(0)), value) << row.name;
    }
}

// ---- the generators

/// How often each value of each row was seen: {name, word}.
class Seen {
 public:
  void add(const State& state) {
    for (const DrawState& row : draw_states()) ++count_[{row.name, row.value(state).word}];
  }
  /// The words, or numbers, of these rows that did not come up although a generator may make them.
  [[nodiscard]] std::string missing(const StateRows& rows) const {
    std::string text;
    for (const DrawState* row : rows)
      for (std::size_t word = 0; word < choices(*row); ++word) {
        const bool is_refused = word < row->words.size() && row->words[word] == row->refused;
        if (count_.contains({row->name, word}) == is_refused)
          text += std::string(row->name) + " " + std::to_string(word) + (is_refused ? " is refused, " : ", ");
      }
    return text;
  }

  /// Words, and numbers as one more, that a generator may choose.
  static std::size_t choices(const DrawState& row) {
    return row.words.size() + (row.numbers.empty() || row.numbers.front().random_count == 0 ? 0 : 1);
  }

 private:
  std::map<std::pair<std::string_view, std::size_t>, int> count_;
};

TEST(DrawStates, RandomStatesHaveEveryValue) {
  Random random(1);
  Seen seen;
  for (int i = 0; i < 400; ++i) seen.add(random_state({}, states_but({}), chooser(random)));
  EXPECT_EQ(seen.missing(states_but({})), "");
}

TEST(DrawStates, RandomNumbersAreWithinTheirBounds) {
  for (const DrawState& row : draw_states())
    for (const StateNumber& number : row.numbers) {
      if (number.random_count == 0) continue;
      const double highest = number.random_low + (number.random_count - 1) * number.random_step;
      EXPECT_GE(number.random_low, number.low) << number.what;
      EXPECT_LE(highest, number.high) << number.what;
      EXPECT_TRUE(!number.is_positive || number.random_low > 0) << number.what;
    }
}

TEST(DrawStates, TheBytesOfTheFuzzerReachEveryValue) {
  Random random(2);
  Seen seen;
  for (int n = 0; n < 800; ++n) {
    std::vector<std::uint8_t> bytes(400);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
    for (const State& state : read_capture(test::pipeline_case(bytes).capture, "bytes.hpt").states) seen.add(state);
  }
  EXPECT_EQ(seen.missing(states_but({})), "");
}

TEST(DrawStates, RandomScenesOfCosimHaveEveryValueThatRidesWithThePrimitive) {
  Seen seen;
  for (const State& state : random_scene(preset("embedded"), 1, 4000).states) seen.add(state);
  StateRows rows;
  for (const DrawState& row : draw_states())
    if (row.home == StateHome::primitive) rows.push_back(&row);
  EXPECT_EQ(seen.missing(rows), "");
  EXPECT_EQ(seen.missing(states_named(
                {"shade", "scissor", "line_rule", "line_last", "line_width", "smooth", "point_size", "point_shape"})),
            "");
}

}  // namespace
}  // namespace halfplane::draw_states_test
