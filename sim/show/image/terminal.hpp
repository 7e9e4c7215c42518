// A picture as text for a terminal.
#pragma once

#include <string>

#include "sim/show/image/picture.hpp"

namespace halfplane {

/// color: 24-bit ANSI escapes and half blocks, two pixels per character cell. plain: an ASCII grey ramp.
enum class TerminalStyle { plain, color };

/// Room for a preview, in character cells.
struct TerminalSize {
  int columns = 80;
  int rows = 40;
};

/// The style for the terminal on a file descriptor (1: stdout): plain for a pipe, when NO_COLOR is set and not empty,
/// and when TERM is unset, empty or "dumb".
[[nodiscard]] TerminalStyle terminal_style(int descriptor);

/// The same decision from its three facts; null: not set.
[[nodiscard]] TerminalStyle terminal_style(bool is_terminal, const char* no_color, const char* term);

/// Columns of the terminal on a file descriptor and at most max_rows rows; 80 columns if unknown.
[[nodiscard]] TerminalSize terminal_size(int descriptor, int max_rows = 40);

/// The picture in at most that many cells, with its aspect ratio: averaged over areas when it is larger, enlarged by a
/// whole factor when it is smaller. Each line ends in a newline.
[[nodiscard]] std::string terminal_preview(const Picture& picture, TerminalSize size, TerminalStyle style);

}  // namespace halfplane
