// Reads a text file word by word and tracks the line: shared by the OBJ and MTL readers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace halfplane {

/// A position in a text whose lines are words between blanks. Lines end in LF, CR LF or CR; `#` starts a comment; a
/// backslash just before a line's end joins the next line. A leading byte order mark is skipped.
class TextCursor {
 public:
  /// Throws InputError for text in UTF-16.
  TextCursor(std::string_view text, std::string file);

  /// Moves to the start of the next line that contains a word. False at the end of the text.
  [[nodiscard]] bool next_line();

  /// The next word of this line, or an empty view at its end.
  std::string_view next_word();

  /// The rest of this line, without blanks around it: names may contain blanks.
  std::string_view rest_of_line();

  /// The rest of this line as a name, which may contain blanks and `#`: without quotes around it, `\\ ` is a blank.
  std::string name();

  /// The next word as a number. Throws InputError naming `what` if it is missing, no number, NaN, infinite, or beyond
  /// `limit` in size.
  double number(std::string_view what, double limit);

  /// Whether this line contains another word.
  [[nodiscard]] bool more();

  [[nodiscard]] std::uint32_t line() const { return line_; }
  [[nodiscard]] const std::string& file() const { return file_; }

  /// Throws InputError "file:line: the error; the remedy".
  [[noreturn]] void fail(const std::string& what, const std::string& mend) const;

 private:
  void skip_blanks();
  [[nodiscard]] std::size_t line_end_length(std::size_t at) const;

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 0;          // counts from 1 once next_line() was called
  std::uint32_t lines_passed_ = 0;  // line ends before at_, including joined ones
};

/// Throws InputError "file:line: the error; the remedy".
[[noreturn]] void fail_at(const std::string& file, std::uint32_t line, const std::string& what,
                          const std::string& mend);

/// A name up to the ` #` of a comment; all of it without a comment. Names may contain `#` as well: the whole is tried
/// first.
[[nodiscard]] std::string without_comment(std::string_view name);

/// Problems that do not stop a reader: reported once for each kind.
class Warnings {
 public:
  explicit Warnings(std::vector<std::string>& all) : all_(all) {}
  void once(const std::string& kind, const std::string& text) {
    if (kinds_.insert(kind).second) all_.push_back(text);
  }

 private:
  std::vector<std::string>& all_;
  std::unordered_set<std::string> kinds_;
};

/// A word for a one-line message: unprintable bytes become '?', long words are cut.
[[nodiscard]] std::string printable(std::string_view word);

/// The same in quotes.
[[nodiscard]] std::string in_quotes(std::string_view word);

/// A finite decimal number that takes the whole word; a leading + is allowed. A number that underflows is zero.
[[nodiscard]] std::optional<double> parse_number(std::string_view word);

/// The text of a regular file (devices and pipes may never end), or none if it cannot be read.
[[nodiscard]] std::optional<std::string> read_regular_file(const std::string& path);

}  // namespace halfplane
