// Files are written whole or not at all.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace halfplane {

/// Replaces `path` by `bytes`: written to a temporary name in the same folder, then renamed, so that a reader sees the
/// old file or the new one. A symbolic link keeps pointing at its target; a device or pipe is written directly; "-" is
/// stdout. Throws InputError naming path and reason; nothing half-written is left.
void write_whole_file(const std::string& path, std::span<const std::uint8_t> bytes);

/// Writes to stdout and flushes. A reader that went away is no error: std::cout stays bad, for main() to end silently.
/// Throws InputError for any other failure, beginning with `what` and ending with `mend`.
void write_stdout(std::span<const std::uint8_t> bytes, const std::string& what, const std::string& mend);

/// Whether stdout is a pipe or socket that nobody reads any more.
[[nodiscard]] bool is_stdout_unread();

}  // namespace halfplane
