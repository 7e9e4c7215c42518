// Files are written completely or not at all.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sim/interrupt.hpp"

namespace halfplane {

/// Replaces `path` by `bytes`: written to a temporary name in the same folder, then renamed, so that a reader sees the
/// old file or the new one. A symbolic link keeps pointing at its target; a device or pipe is written directly; "-" is
/// stdout. Throws InputError naming path and reason; nothing half-written is left.
void write_whole_file(const std::string& path, std::span<const std::uint8_t> bytes);
inline void write_text_file(const std::string& path, std::string_view text) {
  write_whole_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

/// A file that other code writes, under a temporary name in the same folder until it is complete. While the object
/// exists, a signal that ends the program removes the file.
class PartFile {
 public:
  /// Creates the temporary file. Throws InputError naming path and reason.
  explicit PartFile(const std::string& path);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }  ///< the temporary one
  /// Moves the complete file to its place. With `error`, the errno of a write, or if the move fails, throws InputError.
  void finish(int error = 0);

 private:
  std::string path_, target_, name_;
  std::optional<HalfWrittenFile> half_written_;
};

/// Writes to stdout and flushes. A closed reader is no error: std::cout stays bad, so that main() ends silently. Throws
/// InputError for any other failure, beginning with `what` and ending with `mend`.
void write_stdout(std::span<const std::uint8_t> bytes, const std::string& what, const std::string& mend);

/// Whether stdout is a pipe or socket without a reader.
[[nodiscard]] bool is_stdout_unread();

}  // namespace halfplane
