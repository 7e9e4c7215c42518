// The kinds of options that have a value: what each refuses, and what the help shows of it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "sim/cli/options.hpp"

namespace halfplane {

/// CLI::Range of whole numbers, with a message that tells 1e7 and 10M from a number out of the range.
template <class Whole>
[[nodiscard]] CLI::Validator whole_number(Whole least, Whole most) {
  static_assert(std::is_integral_v<Whole>);
  const CLI::Range range(least, most);
  CLI::Validator validator = range;
  validator.operation([range, least, most](std::string& word) {
    const std::string said = range(word), digits = word.substr(word.starts_with('-') || word.starts_with('+') ? 1 : 0);
    if (said.empty() || (!digits.empty() && digits.find_first_not_of("0123456789") == std::string::npos)) return said;
    return "'" + word + "' is not a whole number; give " + std::to_string(least) + " to " + std::to_string(most);
  });
  return validator;
}

/// A text, or several, of which none is empty; the help has `type` in its place.
template <class Text>
CLI::Option* add_text_option(CLI::App& app, const std::string& name, Text& text, const std::string& meaning,
                             const std::string& type = "TEXT") {
  return app.add_option(name, text, meaning)->check(refuse_empty)->type_name(type);
}

/// A whole number from `least` to `most`; the help shows its default.
template <class Number, class Whole>
CLI::Option* add_number_option(CLI::App& app, const std::string& name, Number& number, Whole least, Whole most,
                               const std::string& meaning) {
  return app.add_option(name, number, meaning)->check(whole_number(least, most))->capture_default_str();
}

/// A number from `least` to `most`.
template <class Number>
CLI::Option* add_real_option(CLI::App& app, const std::string& name, Number& number, double least, double most,
                             const std::string& meaning) {
  return app.add_option(name, number, meaning)->check(CLI::Range(least, most))->check(is_number);
}

/// One of `words`; the help shows the default.
inline CLI::Option* add_choice_option(CLI::App& app, const std::string& name, std::string& word,
                                      const std::vector<std::string>& words, const std::string& meaning) {
  return app.add_option(name, word, meaning)->check(CLI::IsMember(words))->capture_default_str();
}

}  // namespace halfplane
