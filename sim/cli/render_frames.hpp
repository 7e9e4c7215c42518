// `halfplane render`: its options and one frame of it, and `--frames`: an animated scene, frame by frame.
#pragma once

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>

#include "sim/cli/cycle_options.hpp"
#include "sim/cli/study_options.hpp"
#include "sim/cosim/rtl_engine.hpp"

namespace halfplane {

inline constexpr int kAllFrames = -1;

struct RenderCommand : CommonOptions {
  std::string engine = "functional";
  StudyOptions study;
  CycleCommandOptions cycle;
  std::string color_path, depth_path, count_path, ids_path, draws_path;
  std::string supersample;  ///< "4x4": the mean of this many pictures, each moved by a fraction of a pixel; empty: one
  int repeat = 0;
  int frames = 0;                    ///< 0: one picture; kAllFrames: all of a capture
  std::string csv_path, chart_path;  ///< of frames
};

/// Results of the engines with cycles besides the picture.
struct CycleFacts {
  LockstepResult rtl;
  std::optional<CycleResult> cycle;
};

/// `facts` is set by the engines cycle and rtl; null: only the picture is wanted. `progress` may throw Interrupted.
/// `onto`: as RenderOptions::onto, for the engines functional and scalar. `keeps_samples`: another frame may be drawn
/// on the result.
[[nodiscard]] Rendering run_engine(const RenderCommand& options, const Scene& scene, const Config& config,
                                   CycleFacts* facts, const std::function<void(double)>& progress,
                                   const Framebuffer* onto = nullptr, bool keeps_samples = false);

/// primitives, fragments, samples_tested, tiles_visited and skipped of a result.
[[nodiscard]] Json counters_json(const Counters& counters);

/// Writes the pictures and arrays named in the options.
void write_files(const RenderCommand& options, const Rendering& rendering, const Config& config,
                 const std::string& title);

/// A table of all rows: a column for each figure, named as its keys with dots between them; nothing where it is null.
[[nodiscard]] std::string csv_text(const Json& rows);

/// The least, the median and the largest of a figure over the frames. Precondition: there are some.
void print_range(std::ostream& out, const std::string& name, std::vector<std::uint64_t> values);

/// Adds --frames, --csv and --chart.
void add_frames_options(CLI::App& app, RenderCommand& options);

/// Throws InputError for options that can be refused before a scene is read.
void check_frames(const RenderCommand& options);

/// "out.png" as "out-0007.png": the file of frame 7 of up to 10,000; longer numbers for more frames. An empty path
/// stays empty, and - stays -.
[[nodiscard]] std::string numbered(const std::string& path, int frame, int frames);

/// Frame i of N shows `--time A..B` at A + i (B - A) / N, and the camera when i/N of its orbit is done, so that a
/// cyclic animation shows no frame twice. Without --time: the whole animation. For a capture with `frame` lines, frame
/// i is the picture at the end of its frame i. Returns the exit status.
[[nodiscard]] int run_frames(const RenderCommand& options, const Config& config);

}  // namespace halfplane
