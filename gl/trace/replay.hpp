// A program's trace drawn by the driver: frame by frame as the program drew it, without the program or a window system.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "../core/context.hpp"

namespace halfplane::gl {

struct TraceContents {
  /// A window or pbuffer. apitrace records no sizes of windows: it is that of the largest viewport that begins at (0, 0).
  struct Surface {
    int width = 0, height = 0;
    bool has_fixed_size = false;  ///< of a pbuffer
  };
  std::map<std::int64_t, Surface> surfaces;
  int frames = 0;              ///< swaps of any surface
  std::int64_t unswapped = 0;  ///< without swaps: the surface whose only frame is the trace
  std::string damage;          ///< place and kind of the file's early end, empty: complete
};

/// Reads a trace without drawing. Throws InputError for a file that is no trace, or in which nothing is drawn.
[[nodiscard]] TraceContents survey(const std::string& path);

struct ReplayHooks {
  /// A line for each command that cannot be carried out, once.
  std::function<void(const std::string&)> warn = [](const std::string&) {};
  /// Called before frame `number` ends.
  std::function<void(int number, Frame& frame)> frame = [](int, Frame&) {};
};

/// Draws the first `frames` frames; each saves and measures as `options` ask. Throws InputError for
/// a damaged file, and for surfaces that the configuration does not take.
void replay(const std::string& path, const TraceContents& contents, const Options& options, int frames,
            const ReplayHooks& hooks);

}  // namespace halfplane::gl
