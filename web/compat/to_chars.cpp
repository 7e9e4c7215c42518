// std::to_chars of libstdc++, digit for digit: {fmt} finds the digits, their layout is libstdc++'s.
#define FMT_HEADER_ONLY
#include <fmt/format.h>

#include <charconv>
#include <string>

namespace std {

to_chars_result to_chars(char* first, char* last, double value) {
  string text = isfinite(value) ? fmt::format("{}", value) : value < 0 ? "-inf" : isnan(value) ? "nan" : "inf";
  if (isfinite(value) && value != 0) {
    // As digits * 10^exponent.
    string digits;
    int exponent = 0;
    bool is_behind_point = false;
    const bool is_negative = text[0] == '-';
    for (size_t i = is_negative ? 1 : 0; i < text.size(); ++i) {
      if (text[i] == 'e') {
        exponent += stoi(text.substr(i + 1));
        break;
      }
      if (text[i] == '.') {
        is_behind_point = true;
        continue;
      }
      digits += text[i];
      exponent -= is_behind_point ? 1 : 0;
    }
    digits.erase(0, digits.find_first_not_of('0'));
    while (digits.size() > 1 && digits.back() == '0') {
      digits.pop_back();
      ++exponent;
    }
    const int length = static_cast<int>(digits.size());
    const int point = length == 1 ? 1 : 0;  // what scientific saves without a point
    if (exponent >= -(length + 3) + point && exponent <= 5 - point) {
      if (exponent >= 0) {
        digits = fmt::format("{:.0f}", fabs(value));
      } else if (length + exponent <= 0) {
        digits = "0." + string(static_cast<size_t>(-length - exponent), '0') + digits;
      } else {
        digits.insert(static_cast<size_t>(length + exponent), ".");
      }
    } else {
      const int scientific = exponent + length - 1;
      if (length > 1) digits.insert(1, ".");
      digits += fmt::format("e{}{:02}", scientific < 0 ? '-' : '+', scientific < 0 ? -scientific : scientific);
    }
    text = (is_negative ? "-" : "") + digits;
  } else if (isfinite(value)) {
    text = signbit(value) ? "-0" : "0";
  }
  if (static_cast<size_t>(last - first) < text.size()) return {last, errc::value_too_large};
  return {text.copy(first, text.size()) + first, errc{}};
}

}  // namespace std
