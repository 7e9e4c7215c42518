#include "sim/scene/text_cursor.hpp"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "model/config.hpp"

namespace halfplane {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

}  // namespace

void fail_at(const std::string& file, std::uint32_t line, const std::string& what, const std::string& mend) {
  throw InputError(file + ":" + std::to_string(line) + ": " + what + "; " + mend);
}

void TextCursor::fail(const std::string& what, const std::string& mend) const { fail_at(file_, line_, what, mend); }

TextCursor::TextCursor(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {
  if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  const bool has_mark = text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF");
  if (has_mark || (text_.size() > 1 && (text_[0] == '\0') != (text_[1] == '\0')))
    fail_at(file_, 1, "the text is in UTF-16", "save it in UTF-8");
}

std::string printable(std::string_view word) {
  constexpr std::size_t kLongest = 60;  // characters
  std::string result;
  for (const char c : word.substr(0, kLongest)) result += (c < ' ' && c >= 0) || c == '\x7f' ? '?' : c;
  if (word.size() > kLongest) result += "...";
  return result;
}

std::string in_quotes(std::string_view word) { return std::string(1, '\'').append(printable(word)).append(1, '\''); }

std::optional<double> parse_number(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty() || error == std::errc::invalid_argument) return std::nullopt;
  // from_chars fails at both ends of the range; strtod distinguishes them: infinity, or zero and subnormals.
  if (error == std::errc::result_out_of_range) value = std::strtod(std::string(word).c_str(), nullptr);
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::string> read_regular_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || error) return std::nullopt;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  if (size < 0) return std::nullopt;
  std::string text(static_cast<std::size_t>(size), '\0');
  file.seekg(0);
  if (!file.read(text.data(), size)) return std::nullopt;
  return text;
}

// The length of the line end at `at`, 0 if there is none.
std::size_t TextCursor::line_end_length(std::size_t at) const {
  if (at >= text_.size() || !is_line_end(text_[at])) return 0;
  return text_[at] == '\r' && at + 1 < text_.size() && text_[at + 1] == '\n' ? 2 : 1;
}

void TextCursor::skip_blanks() {
  while (at_ < text_.size()) {
    if (is_space(text_[at_])) {
      ++at_;
    } else if (const std::size_t joined = text_[at_] == '\\' ? line_end_length(at_ + 1) : 0; joined != 0) {
      at_ += 1 + joined;
      ++lines_passed_;
    } else {
      return;
    }
  }
}

bool TextCursor::next_line() {
  bool inside = line_ != 0;  // the rest of the current line is skipped first
  for (;;) {
    if (inside) {
      while (at_ < text_.size() && !is_line_end(text_[at_])) {
        const std::size_t joined = text_[at_] == '\\' ? line_end_length(at_ + 1) : 0;
        if (joined != 0) ++lines_passed_;
        at_ += 1 + joined;
      }
      if (at_ >= text_.size()) return false;
      at_ += line_end_length(at_);
      ++lines_passed_;
    }
    skip_blanks();
    line_ = lines_passed_ + 1;
    inside = true;
    if (at_ < text_.size() && !is_line_end(text_[at_]) && text_[at_] != '#') return true;
    if (at_ >= text_.size()) return false;
  }
}

bool TextCursor::more() {
  skip_blanks();
  return at_ < text_.size() && !is_line_end(text_[at_]) && text_[at_] != '#';
}

std::string_view TextCursor::next_word() {
  if (!more()) return {};
  const std::size_t start = at_;
  while (at_ < text_.size() && !is_space(text_[at_]) && !is_line_end(text_[at_]) &&
         !(text_[at_] == '\\' && line_end_length(at_ + 1) != 0)) {
    ++at_;
  }
  return text_.substr(start, at_ - start);
}

std::string_view TextCursor::rest_of_line() {
  if (!more()) return {};
  const std::size_t start = at_;
  while (at_ < text_.size() && !is_line_end(text_[at_]) && text_[at_] != '#') ++at_;
  std::string_view rest = text_.substr(start, at_ - start);
  while (!rest.empty() && is_space(rest.back())) rest.remove_suffix(1);
  return rest;
}

std::string TextCursor::name() {
  skip_blanks();
  const std::size_t start = at_;
  while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
  std::string_view rest = text_.substr(start, at_ - start);
  while (!rest.empty() && is_space(rest.back())) rest.remove_suffix(1);
  if (const std::size_t end = rest.starts_with('"') ? rest.find('"', 1) : std::string_view::npos;
      end != std::string_view::npos)
    return std::string(rest.substr(1, end - 1));
  std::string plain;
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (rest[i] != '\\' || i + 1 == rest.size() || rest[i + 1] != ' ') plain += rest[i];
  return plain;
}

std::string without_comment(std::string_view name) {
  std::size_t end = 0;
  while (end < name.size() && !(name[end] == '#' && (end == 0 || is_space(name[end - 1])))) ++end;
  while (end > 0 && is_space(name[end - 1])) --end;
  return std::string(name.substr(0, end));
}

double TextCursor::number(std::string_view what, double limit) {
  const std::string_view word = next_word();
  if (word.empty()) fail(std::string(what) + " is missing", "write it at the end of the line");
  const std::optional<double> value = parse_number(word);
  if (!value) fail(std::string(what) + " " + in_quotes(word) + " is not a finite number", "write one such as 1.25");
  if (std::abs(*value) > limit) {
    fail(std::string(what) + " " + in_quotes(word) + " is beyond +-1e30", "scale the model down");
  }
  return *value;
}

}  // namespace halfplane
