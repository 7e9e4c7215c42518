// The range of an option that is a whole number.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <type_traits>

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

}  // namespace halfplane
