#include "sim/cli/convert_trace.hpp"

#include <iostream>
#ifdef HALFPLANE_HAS_TRACES
#include <filesystem>

#include "gl/trace/replay.hpp"
#include "model/as_number.hpp"
#include "model/capture/capture.hpp"
#include "sim/cli/progress.hpp"
#endif

namespace halfplane {

Json capture_json(const std::string& path, const Scene& scene, std::size_t bytes) {
  return {{"path", path},
          {"width", scene.width},
          {"height", scene.height},
          {"vertices", scene.vertices.size()},
          {"indices", scene.indices.size()},
          {"states", scene.states.size()},
          {"commands", scene.commands.size()},
          {"bytes", bytes}};
}

bool is_trace(const std::string& name) { return name.ends_with(".trace"); }

#ifdef HALFPLANE_HAS_TRACES
namespace {

struct FrameRange {
  int first = 0, last = 0;
};
/// Throws InputError for ranges outside the trace's frames.
FrameRange parse_frames(const std::string& text, int frames) {
  if (text.empty()) return {0, frames - 1};
  FrameRange range;
  const auto number = [&](std::string_view word) {
    const int value = as_number<int>(word).value_or(-1);
    if (value < 0) throw InputError("--frame " + text + ": give N or A..B, counted from 0");
    return value;
  };
  const std::size_t dots = text.find("..");
  range.first = number(std::string_view(text).substr(0, dots));
  range.last = dots == std::string::npos ? range.first : number(std::string_view(text).substr(dots + 2));
  if (range.last < range.first) throw InputError("--frame " + text + ": the last frame comes before the first");
  if (range.last >= frames)
    throw InputError("--frame " + text + ": the trace has " + std::to_string(frames) + " whole frames, 0 to " +
                     std::to_string(frames - 1));
  return range;
}

}  // namespace

int convert_trace(const CommonOptions& options, const ConvertTraceOptions& trace, Json& result) {
  const gl::TraceContents contents = gl::survey(options.scene);
  if (!contents.damage.empty() && trace.frames.empty())
    throw InputError(contents.damage + "; " +
                     (contents.frames > 0 ? "give --frame 0.." + std::to_string(contents.frames - 1)
                                          : std::string("no frame of it is whole")));
  const FrameRange range = parse_frames(trace.frames, contents.frames);
  gl::Options driver;
  driver.config = effective_config(options);
  driver.threads = options.threads;
  driver.save_to = trace.output;
  if (trace.output.ends_with(".hpt")) {
    check_output(trace.output, ".hpt");
    for (int frame = range.first; frame <= range.last; ++frame) driver.save.push_back(frame);
  } else {
    make_folder("-o", trace.output);
    driver.save_all = true;
    driver.first_frame = range.first;
    driver.last_frame = range.last;
  }

  std::ostream& out = human(options);
  Progress progress(options, "drawing", "frames");
  std::vector<std::string> written;
  gl::ReplayHooks hooks;
  hooks.warn = [](const std::string& line) { std::cerr << "halfplane: " << line << '\n'; };
  hooks.frame = [&](int number, gl::Frame&) {
    progress(static_cast<double>(number) / (range.last + 1), static_cast<std::uint64_t>(number));
    if (number < range.first) return;
    written.push_back(gl::saved_name(driver, number));
    std::error_code ignored;
    std::filesystem::remove(written.back(), ignored);  // so that the file, if it exists, is this frame's
  };
  gl::replay(options.scene, contents, driver, range.last + 1, hooks);
  int status = exit_ok;
  for (const std::string& path : written) {
    std::error_code error;
    const auto bytes = std::filesystem::file_size(path, error);
    if (error) {  // Frame has said why
      status = exit_bad_input;
      continue;
    }
    const Scene scene = read_capture_file(path);
    result["captures"].push_back(capture_json(path, scene, bytes));
    out << path << "  " << scene.width << "x" << scene.height << ", " << with_commas(scene.vertices.size())
        << " vertices, " << with_commas(scene.commands.size()) << " commands, " << with_commas(bytes) << " bytes\n";
  }
  return status;
}

#else

int convert_trace(const CommonOptions& options, const ConvertTraceOptions&, Json&) {
  std::cerr
      << "halfplane: " << options.scene
      << ": this build reads no traces; install libglvnd-dev, libx11-dev, libxcb-shm0-dev and libsnappy-dev and build "
         "again\n";
  return exit_missing;
}

#endif

}  // namespace halfplane
