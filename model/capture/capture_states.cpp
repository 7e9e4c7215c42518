#include "capture_states.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace halfplane {
namespace {

/// The form of a row's value: "off or x y width height in pixels"
std::string what_to_write(const DrawState& row) {
  std::string text = row.words.empty() ? "" : std::string(row.words.back()) + " or ";
  text += row.form;
  return row.unit.empty() ? text : text + " in " + std::string(row.unit);
}

/// Reads a word if the line has one of the row's; otherwise numbers must follow.
bool read_word(CaptureText& text, const DrawState& row, StateValue& value) {
  CaptureText ahead = text;  // to look at a word before it is read
  const std::string_view word = ahead.word();
  for (value.word = 0; value.word < row.words.size(); ++value.word)
    if (row.words[value.word] == word) {
      text = ahead;
      return true;
    }
  if (!text.has_word()) text.fail(std::string(row.name) + " without a value; write " + what_to_write(row));
  return false;
}

/// The number of the texture whose name is the next word.
double read_texture(CaptureText& text, const DrawState& row, std::span<const Texture> textures) {
  const std::string_view name = text.word();
  const auto found = std::ranges::find(textures, name, &Texture::name);
  if (found == textures.end())
    text.fail(std::string(row.name) + " " + quoted_word(name) + " is not known here; write off, or the name of a " +
              "texture line above");
  return static_cast<double>(found - textures.begin());
}

/// A number in hexadecimal digits; a 0x prefix is accepted.
double read_hex(CaptureText& text, const DrawState& row, const StateNumber& number) {
  const std::string_view word = text.word();
  std::string_view digits = word;
  if (digits.starts_with("0x") || digits.starts_with("0X")) digits.remove_prefix(2);
  double value = digits.empty() ? -1 : 0;
  for (const char c : digits) value = hex_digit(c) < 0 || value < 0 ? -1 : std::min(value * 16 + hex_digit(c), 1e9);
  if (value < number.low || value > number.high) {
    std::array<char, 32> range{};
    std::snprintf(range.data(), range.size(), "%x to %x", static_cast<unsigned>(number.low),
                  static_cast<unsigned>(number.high));
    text.fail(quoted_word(word) + " is no value of " + std::string(row.name) + "; write " +
              std::string(row.words.back()) + ", or hexadecimal digits from " + range.data());
  }
  return value;
}

void append_hex(std::string& out, unsigned value) {
  std::array<char, 16> digits{};
  std::snprintf(digits.data(), digits.size(), "%x", value);
  out += digits.data();
}

void read_numbers(CaptureText& text, const DrawState& row, std::span<const Texture> textures, StateValue& value) {
  std::string positive;  // "viewport width and height": numbers that must be positive
  bool is_refused = false;
  for (std::size_t i = 0; i < row.numbers.size(); ++i) {
    const StateNumber& number = row.numbers[i];
    double& read = value.numbers[i];
    if (number.repeats != 0 && !text.has_word()) {
      read = value.numbers[i - number.repeats];
      continue;
    }
    if (number.is_texture)
      read = read_texture(text, row, textures);
    else if (!number.words.empty())
      read = static_cast<double>(text.choice(number.what, number.words));
    else if (number.is_hex)
      read = read_hex(text, row, number);
    else if (number.is_whole)
      read = text.integer(number.what, static_cast<int>(number.low), static_cast<int>(number.high));
    else  // -0 becomes 0: equal states are then equal in every bit
      read = text.number(number.what, number.low, number.high) + 0.0;
    if (!number.is_positive) continue;
    positive +=
        positive.empty() ? std::string(number.what) : " and " + std::string(number.what.substr(row.name.size() + 1));
    is_refused |= read <= 0;
  }
  if (is_refused) text.fail(positive + " must be above 0; write " + what_to_write(row));
}

}  // namespace

void read_state_value(CaptureText& text, const DrawState& row, std::span<const Texture> textures, State& state) {
  StateValue value;
  if (row.numbers.empty())
    value.word = text.choice(row.name, row.words);
  else if (row.words.empty() || !read_word(text, row, value))
    read_numbers(text, row, textures, value);
  row.set(state, value);
}

void write_state_value(const State& state, const DrawState& row, std::span<const Texture> textures, std::string& out) {
  const StateValue value = row.value(state);
  if (value.word < row.words.size()) {
    out += ' ';
    out += row.words[value.word];
    return;
  }
  std::size_t count = row.numbers.size();
  const auto says_nothing = [&](std::size_t i) {
    const std::size_t repeats = row.numbers[i].repeats;
    return repeats != 0 && value.numbers[i] == value.numbers[i - repeats];
  };
  std::size_t needed = count;
  while (needed > 0 && says_nothing(needed - 1)) --needed;
  if (needed == 0 || row.numbers[needed - 1].repeats == 0)
    count = needed;  // either all optional numbers are absent, or none
  for (std::size_t i = 0; i < count; ++i) {
    const StateNumber& number = row.numbers[i];
    out += ' ';
    if (number.is_texture)
      out += textures[static_cast<std::size_t>(value.numbers[i])].name;
    else if (!number.words.empty())
      out += number.words[static_cast<std::size_t>(value.numbers[i])];
    else if (number.is_hex)
      append_hex(out, static_cast<unsigned>(value.numbers[i]));
    else if (number.is_whole)
      out += std::to_string(static_cast<int>(value.numbers[i]));
    else
      append_number(out, value.numbers[i]);
  }
}

std::span<const DrawState> capture_states() { return draw_states().subspan(1); }

const DrawState& capture_space() { return draw_states().front(); }

}  // namespace halfplane
