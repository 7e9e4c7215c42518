// Work that a signal ends in order: the first SIGINT (Ctrl-C) or SIGTERM asks it to stop, a second ends the program.
#pragma once

#include <string>

namespace halfplane {

/// Thrown by progress reports to leave the current work. Studies catch it and return their results so far. Not a
/// std::exception: error handlers let it pass.
struct Interrupted {};

/// From now on either signal ends the program at once with exit status 130, without a half-written file.
void catch_signals();

/// From now on the first signal only asks to stop; a second ends the program as above. A signal within a tenth of a
/// second counts as the same: timeout(1) sends each twice, to the process and to its group.
void stop_in_order();

/// Whether a signal has asked to stop.
[[nodiscard]] bool is_interrupted() noexcept;

/// Throws Interrupted if a signal has.
void stop_if_interrupted();

/// While it exists, a signal that ends the program removes the file. One at a time.
class HalfWrittenFile {
 public:
  explicit HalfWrittenFile(const std::string& path);
  ~HalfWrittenFile();
  HalfWrittenFile(const HalfWrittenFile&) = delete;
  HalfWrittenFile& operator=(const HalfWrittenFile&) = delete;
};

}  // namespace halfplane
