#include "capture_text.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>

#include "../as_number.hpp"
#include "../config.hpp"

namespace halfplane {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

constexpr std::ptrdiff_t max_digits = 18;  // 10^18 < 2^64: the digits do not wrap

/// 10^0 ... 10^18: all of them exact in binary64.
constexpr std::array<double, max_digits + 1> powers_of_ten = [] {
  std::array<double, max_digits + 1> powers{1};
  for (std::size_t i = 1; i < powers.size(); ++i) powers[i] = powers[i - 1] * 10;
  return powers;
}();

std::string text_of(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

/// std::from_chars, extended by a leading '+' and the 0x of hex floats. invalid_argument: not a number.
std::errc parse_number(std::string_view word, double& value) {
  const bool is_negative = word.starts_with('-');
  if (is_negative || word.starts_with('+')) word.remove_prefix(1);
  const bool is_hex = word.starts_with("0x") || word.starts_with("0X");
  if (is_hex) word.remove_prefix(2);
  // from_chars accepts a sign, "inf" and "nan" too: here a number begins with a digit or a point.
  if (word.empty() || !(word[0] == '.' || (is_hex ? hex_digit(word[0]) >= 0 : is_digit(word[0]))))
    return std::errc::invalid_argument;
  const char* end = word.data() + word.size();
  const auto result =
      std::from_chars(word.data(), end, value, is_hex ? std::chars_format::hex : std::chars_format::general);
  if (result.ec == std::errc::invalid_argument || result.ptr != end) return std::errc::invalid_argument;
  if (is_negative) value = -value;
  return result.ec;
}

/// Reads the common form: few digits and no exponent. Both the digits (up to 2^53) and the power of ten are exact
/// doubles, so that the one division rounds to nearest. Returns the end of the number, or nullptr for any other form,
/// right or wrong.
inline const char* read_short_decimal(const char* p, const char* line_end, double& value) {
  const bool is_negative = p != line_end && *p == '-';
  if (is_negative) ++p;
  const char* begin = p;
  std::uint64_t digits = 0;  // unsigned: a long run wraps, and is refused below by its length
  for (; p != line_end && is_digit(*p); ++p) digits = digits * 10 + static_cast<std::uint64_t>(*p - '0');
  auto count = p - begin;
  std::ptrdiff_t places = 0;
  if (p != line_end && *p == '.') {
    const char* fraction = ++p;
    for (; p != line_end && is_digit(*p); ++p) digits = digits * 10 + static_cast<std::uint64_t>(*p - '0');
    places = p - fraction;
    count += places;
  }
  const bool ends_here = p == line_end || is_blank(*p) || *p == '#';
  if (!ends_here || count == 0 || count > max_digits || digits > (std::uint64_t{1} << 53)) return nullptr;
  const double magnitude = static_cast<double>(digits) / powers_of_ten[static_cast<std::size_t>(places)];
  value = is_negative ? -magnitude : magnitude;
  return p;
}

}  // namespace

void append_number(std::string& out, double value) {
  std::array<char, 32> buffer{};  // the longest shortest decimal has 24 characters: -2.2250738585072014e-308
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  out.append(buffer.data(), result.ptr);
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::string quoted_word(std::string_view text) {
  constexpr std::size_t longest = 40;  // bytes
  constexpr std::string_view digits = "0123456789abcdef";
  std::string result = "'";
  for (const char c : text.substr(0, longest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f) {
      result += c;
    } else {
      result += "\\x";
      result += digits[byte >> 4];
      result += digits[byte & 15];
    }
  }
  return result + (text.size() > longest ? "...'" : "'");
}

std::string comma_list(std::span<const std::string_view> names) {
  std::string list;
  for (const std::string_view name : names) {
    if (!list.empty()) list += ", ";
    list += name;
  }
  return list;
}

bool CaptureText::next_line() {
  while (next_ < text_.size()) {
    at_ = text_.data() + next_;
    const std::size_t left = text_.size() - next_;
    const auto* newline = static_cast<const char*>(std::memchr(at_, '\n', left));
    line_end_ = newline != nullptr ? newline : at_ + left;
    next_ += static_cast<std::size_t>(line_end_ - at_) + (newline != nullptr ? 1 : 0);
    ++line_;
    if (line_end_ != at_ && line_end_[-1] == '\r') --line_end_;
    if (has_word()) return true;
  }
  return false;
}

bool CaptureText::has_word() {
  while (at_ != line_end_ && is_blank(*at_)) ++at_;
  return at_ != line_end_ && *at_ != '#';
}

std::string_view CaptureText::word() {
  if (!has_word()) return {};
  const char* begin = at_;
  while (at_ != line_end_ && !is_blank(*at_) && *at_ != '#') ++at_;
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

std::string_view CaptureText::rest() {
  if (!has_word()) return {};
  const char* begin = at_;
  at_ = std::find(begin, line_end_, '#');
  const char* end = at_;
  while (is_blank(end[-1])) --end;  // *begin is not blank
  return {begin, static_cast<std::size_t>(end - begin)};
}

std::string_view CaptureText::expect_word(std::string_view what) {
  const std::string_view found = word();
  if (!found.empty()) return found;
  fail("the line ends where " + std::string(what) + " should follow" +
       (is_terminated() ? "; add it" : "; the file may be cut off: add what is missing"));
}

std::size_t CaptureText::numbers(std::span<double> values) {
  std::size_t count = 0;
  const char* p = at_;  // a local: this loop takes most of the time for a large file
  while (count < values.size()) {
    while (p != line_end_ && is_blank(*p)) ++p;
    if (p == line_end_ || *p == '#') break;
    const char* after = read_short_decimal(p, line_end_, values[count]);
    if (after == nullptr) {
      at_ = p;
      values[count] = number();
      after = at_;
    }
    ++count;
    p = after;
  }
  at_ = p;
  return count;
}

double CaptureText::number() {
  double value = 0;
  const std::string_view found = expect_word("a number");
  const std::errc error = parse_number(found, value);
  if (error == std::errc{}) return value;
  if (error == std::errc::result_out_of_range)
    fail(quoted_word(found) +
         " is outside the range of a double; write a number of magnitude 4.95e-324 to 1.79e308, or 0");
  fail(quoted_word(found) + " is not a finite number; write a decimal such as 12.5 or a hex float such as 0x1.9p3");
}

double CaptureText::number(std::string_view what, double low, double high) {
  if (!has_word()) (void)expect_word(what);
  const double value = number();
  if (value >= low && value <= high) return value;
  fail(std::string(what) + " is " + text_of(value) + "; write a number from " + text_of(low) + " to " + text_of(high));
}

int CaptureText::integer(std::string_view what, int low, int high) {
  const std::string_view found = expect_word(what);
  if (const auto value = as_number<int>(found); value && *value >= low && *value <= high) return *value;
  fail(std::string(what) + " is " + quoted_word(found) + "; write a whole number from " + std::to_string(low) + " to " +
       std::to_string(high));
}

std::uint32_t CaptureText::index(std::size_t count) {
  const std::string_view found = expect_word("a vertex index");
  std::uint32_t value = 0;
  const char* end = found.data() + found.size();
  const auto result = std::from_chars(found.data(), end, value);
  if (result.ec == std::errc{} && result.ptr == end && value < count) return value;
  if (result.ec == std::errc::invalid_argument || result.ptr != end)
    fail(quoted_word(found) + " is not an index; write whole numbers, counted from 0 over the whole file");
  if (count == 0) fail("index " + quoted_word(found) + " has no vertex yet; write the 'v' lines above the indices");
  fail("index " + quoted_word(found) + " has no vertex yet; write 0 to " + std::to_string(count - 1) +
       ", or the missing 'v' lines above");
}

bool CaptureText::take(std::string_view expected) {
  if (!has_word() || *at_ != expected.front()) return false;  // fast path: this is called before every index
  const char* before = at_;
  if (word() == expected) return true;
  at_ = before;
  return false;
}

std::size_t CaptureText::choice(std::string_view what, std::span<const std::string_view> names) {
  const std::string_view found = expect_word("the value of " + std::string(what));
  const auto* name = std::find(names.data(), names.data() + names.size(), found);
  if (name != names.data() + names.size()) return static_cast<std::size_t>(name - names.data());
  fail(quoted_word(found) + " is no value of " + std::string(what) + "; write one of " + comma_list(names));
}

void CaptureText::expect_end() {
  if (has_word()) fail(quoted_word(word()) + " is left over at the end of the line; remove it");
}

void CaptureText::refuse_nul() const {
  const std::size_t nul = text_.find('\0');
  if (nul == std::string_view::npos) return;
  const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(nul), '\n');
  fail_at(static_cast<std::size_t>(line) - head_,
          "a NUL byte; a capture is plain text (ASCII or UTF-8): write it anew");
}

void CaptureText::fail_at(std::size_t line, const std::string& message) const {
  throw InputError(std::string(file_name_) + ":" + std::to_string(line) + ": " + message);
}

}  // namespace halfplane
