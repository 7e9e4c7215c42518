// A capture's text, line by line and word by word, with the position for messages. Used by the capture reader only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace halfplane {

/// `text` between quotes, fit for a one-line message: at most 40 bytes of it, unprintable bytes by their number.
[[nodiscard]] std::string quoted_word(std::string_view text);

/// The value of a hexadecimal digit of either case, -1 for any other character.
[[nodiscard]] int hex_digit(char c);

/// "none, back, front, both"
[[nodiscard]] std::string comma_list(std::span<const std::string_view> names);

/// Appends the shortest decimal that reads back as `value`, bit for bit.
void append_number(std::string& out, double value);

/// A cursor over the words of a text. Words are separated by blanks and tabs; `#` ends a line early, CR LF is one end.
class CaptureText {
 public:
  /// `head`: lines at the beginning that are not the caller's, and not counted.
  CaptureText(std::string_view text, std::string_view file_name, std::size_t head = 0)
      : text_(text), file_name_(file_name), head_(head), line_(0 - head) {}

  /// Moves on to the next line that has a word in it. False at the end of the text.
  [[nodiscard]] bool next_line();
  /// Whether the line has another word.
  [[nodiscard]] bool has_word();
  /// The next word, empty at the end of the line.
  [[nodiscard]] std::string_view word();
  /// The rest of the line, without the blanks around it.
  [[nodiscard]] std::string_view rest();

  /// The next word as a finite number: decimal or C hex float, rounded to nearest.
  [[nodiscard]] double number();
  /// Reads the following numbers, as many as the line and `values` have. Returns how many.
  [[nodiscard]] std::size_t numbers(std::span<double> values);
  /// A number in [low, high]; `what` names it in the message.
  [[nodiscard]] double number(std::string_view what, double low, double high);
  /// The next word as a whole number in [low, high].
  [[nodiscard]] int integer(std::string_view what, int low, int high);
  /// The next word as the index of one of `count` vertices.
  [[nodiscard]] std::uint32_t index(std::size_t count);
  /// Takes the next word if it is `expected`.
  [[nodiscard]] bool take(std::string_view expected);
  /// The index in `names` of the next word; `what` names the setting in the message.
  [[nodiscard]] std::size_t choice(std::string_view what, std::span<const std::string_view> names);

  /// Refuses left-over words.
  void expect_end();
  /// Refuses a NUL byte anywhere in the text.
  void refuse_nul() const;
  /// Whether the line has a line end, as all lines but the last one of a truncated text do.
  [[nodiscard]] bool is_terminated() const { return next_ > 0 && text_[next_ - 1] == '\n'; }
  /// Bytes of the whole text, and of its lines up to this one.
  [[nodiscard]] std::size_t size() const { return text_.size(); }
  [[nodiscard]] std::size_t bytes_read() const { return next_; }
  /// Number of the line, from 1.
  [[nodiscard]] std::size_t line() const { return line_; }
  /// Throws InputError "file:line: message".
  [[noreturn]] void fail(const std::string& message) const { fail_at(line_, message); }

 private:
  [[noreturn]] void fail_at(std::size_t line, const std::string& message) const;
  /// The next word; fails, naming `what`, if there is none.
  std::string_view expect_word(std::string_view what);

  std::string_view text_, file_name_;
  std::size_t head_;                // lines that are not counted
  std::size_t next_ = 0;            // start of the next line in text_
  std::size_t line_;                // 0: before the first counted line; modulo 2^64 before that
  const char* at_ = nullptr;        // start of the search for the next word
  const char* line_end_ = nullptr;  // before its LF or CR LF
};

}  // namespace halfplane
