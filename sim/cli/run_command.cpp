// `halfplane run`: a program whose OpenGL is the model's, by the driver in gl/.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <thread>

#include "model/as_number.hpp"
#include "sim/cli/child.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/cli/render_frames.hpp"
#include "sim/show/image/whole_file.hpp"
#include "sim/show/report/page.hpp"

namespace halfplane {
namespace {

struct RunCommand : CommonOptions {
  std::string engine = "functional", on_missing = "warn", frames, save_path, save_folder, csv_path, chart_path;
  MemorySettings memory;
  std::vector<int> save;
  bool hud = false;
  RunCommand() { threads = 2; }  // a program is there to be looked at
  std::vector<std::string> program;
};

struct FrameSpan {
  int first = 0, last = -1;  ///< -1: no end
};
/// `--frames A..B`. Throws InputError.
FrameSpan parse_frames(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t dots = text.find("..");
  const auto first = as_number<int>(text.substr(0, dots));
  const auto last = dots == std::string::npos ? std::nullopt : as_number<int>(text.substr(dots + 2));
  if (!first || !last || *first < 0 || *last < *first)
    throw InputError("--frames '" + text + "': give A..B, frames counted from 0");
  return {*first, *last};
}

/// The frame after which the program ends; -1: it ends by itself. Where captures are all that was asked for, their last one.
int last_frame(const RunCommand& options, const FrameSpan& span) {
  const bool saves_alone = !options.save.empty() && options.frames.empty() && !options.hud &&
                           options.engine == "functional" && options.json.empty() && options.csv_path.empty() &&
                           options.chart_path.empty();
  return saves_alone ? std::ranges::max(options.save) : span.last;
}

/// The driver's folder: in the build folder of this program, or the installation. Throws when it was not built.
std::filesystem::path driver_folder() {
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  for (const char* folder : {"gl", "../" HALFPLANE_LIBDIR})
    if (std::filesystem::exists(here / folder / "libGLX_halfplane.so.0"))
      return std::filesystem::canonical(here / folder);
  throw std::runtime_error(
      "run: this build has no OpenGL driver (libGLX_halfplane.so.0); install libglvnd-dev, libx11-dev and libxcb-shm0-dev, "
      "and build again");
}

/// Where the driver saves; absolute, because programs change their folder.
std::string save_target(const RunCommand& options) {
  std::string name = options.save_folder.empty() ? options.save_path : options.save_folder;
  if (name.empty()) name = options.save.size() == 1 ? "frame-" + std::to_string(options.save[0]) + ".hpt" : "frame.hpt";
  return std::filesystem::absolute(name).string();
}

/// Captures that a program was ended in are not whole: the driver writes NAME.part and then renames it.
void remove_unfinished(const RunCommand& options) {
  if (options.save.empty() && options.save_folder.empty()) return;
  const std::filesystem::path target = save_target(options);
  std::error_code error;
  const auto folder = options.save_folder.empty() ? target.parent_path() : target;
  const std::string start = options.save_folder.empty() ? target.stem().string() : "frame";
  std::vector<std::filesystem::path> unfinished;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().filename().string().starts_with(start) && entry.path().extension() == ".part")
      unfinished.push_back(entry.path());
  for (const auto& path : unfinished) std::filesystem::remove(path, error);
}

/// The driver's options, as gl/core/options.cpp reads them.
Json driver_options(const RunCommand& options, const Config& config, const FrameSpan& span,
                    const TemporaryFolder& folder) {
  Json settings_of_it = Json::array();
  const Config start = preset(config.preset);
  for (const Setting& setting : settings())
    if (get(config, setting) != get(start, setting))
      settings_of_it.push_back(std::string(setting.key) + "=" + get(config, setting));
  return {{"preset", config.preset},
          {"config", settings_of_it},
          {"threads", options.threads},
          {"on_missing", options.on_missing},
          {"hud", options.hud},
          {"cycles", options.engine == "cycle"},
          {"first_frame", span.first},
          {"last_frame", span.last},
          {"mhz", options.memory.mhz},
          {"memory", memory_name(options.memory)},
          {"memory_latency", options.memory.latency},
          {"save", options.save},
          {"save_to", save_target(options)},
          {"save_all", !options.save_folder.empty()},
          {"results", folder.file("results")}};
}

/// This program's environment, with what leads the program to the driver.
std::vector<std::string> environment(const TemporaryFolder& folder, const Json& driver) {
  const std::filesystem::path libraries = driver_folder();
  const Json vendor{{"file_format_version", "1.0.0"},
                    {"ICD", {{"library_path", (libraries / "libEGL_halfplane.so.0").string()}}}};
  write_text_file(folder.file("egl.json"), vendor.dump());
  const char* const before = std::getenv("LD_LIBRARY_PATH");
  const std::map<std::string, std::string> added{
      {"__GLX_VENDOR_LIBRARY_NAME", "halfplane"},
      {"__EGL_VENDOR_LIBRARY_FILENAMES", folder.file("egl.json")},
      {"LD_LIBRARY_PATH", libraries.string() + (before == nullptr || *before == '\0' ? "" : ":" + std::string(before))},
      {"HALFPLANE_GL", driver.dump(-1, ' ', false, Json::error_handler_t::replace)},
      {"HALFPLANE_GL_ANSWERED", folder.file("answered")}};
  std::vector<std::string> all;
  for (const std::string& variable : own_environment())
    if (!added.contains(variable.substr(0, variable.find('=')))) all.push_back(variable);
  for (const auto& [name, value] : added) all.push_back(name + "=" + value);
  return all;
}

/// What all frames together took.
struct RunTotals {
  std::uint64_t frames = 0;
  double seconds = 0, drawing = 0;
  std::vector<std::uint64_t> cycles, bytes;  ///< of the frames that were measured
  std::vector<std::string> missing, lacks;   ///< each once
  Json last;                                 ///< the last row; null: there is none

  void add(const Json& row) {
    ++frames;
    const Json& time = row["time_s"];
    seconds += time["frame"].get<double>();
    drawing += time["geometry"].get<double>() + time["raster"].get<double>();
    if (!row["cycles"].is_null()) {
      cycles.push_back(row["cycles"].get<std::uint64_t>());
      bytes.push_back(row["bytes"].get<std::uint64_t>());
    }
    const auto note = [](std::vector<std::string>& texts, const Json& text) {
      if (text.is_string() && std::ranges::find(texts, text.get<std::string>()) == texts.end()) texts.push_back(text);
    };
    for (const Json& text : row["missing"]) note(missing, text);
    note(lacks, row["lacks"]);
    last = row;
  }
};

/// The lines of JSON that the driver appends to a file. It is taken away at each reading: a game of an hour has a hundred
/// thousand frames.
class ResultLines {
 public:
  /// `keeps_rows`: else there are totals alone.
  ResultLines(std::string path, bool keeps_rows) : path_(std::move(path)), keeps_rows_(keeps_rows) {}
  void read() {
    const std::string taken = path_ + ".taken";
    std::error_code error;
    std::filesystem::rename(path_, taken, error);
    if (error) return;
    const int lock = open(taken.c_str(), O_RDONLY | O_CLOEXEC);
    flock(lock, LOCK_EX);  // until a line that is under way is whole; later ones go to a new file
    std::ifstream in(taken);
    for (std::string line; std::getline(in, line);) {
      Json row = Json::parse(line, nullptr, false);
      if (!row.is_object()) continue;  // the program was ended while it wrote
      totals.add(row);
      if (keeps_rows_) rows.push_back(std::move(row));
    }
    close(lock);
    std::filesystem::remove(taken, error);
  }
  RunTotals totals;
  Json rows = Json::array();

 private:
  std::string path_;
  bool keeps_rows_;
};

/// The figures that every frame has.
Json csv_rows(const Json& rows) {
  Json list = Json::array();
  for (Json row : rows) {
    for (const char* key : {"missing", "lacks", "stages", "traffic_bytes"}) row.erase(key);
    list.push_back(std::move(row));
  }
  return list;
}

void print_run(std::ostream& out, const RunCommand& options, const RunTotals& totals,
               const std::vector<std::string>& answered, const Config& config) {
  out << joined(options.program, " ") << ": " << label(config) << ", engine " << options.engine << ", "
      << options.threads << (options.threads == 1 ? " thread, " : " threads, ") << joined(answered) << '\n'
      << "frames      " << with_commas(totals.frames);
  if (totals.frames > 0)
    out << " in " << fixed(totals.seconds, 2) << " s, "
        << fixed(static_cast<double>(totals.frames) / std::max(totals.seconds, 1e-9), 1) << " a second; "
        << fixed(1e3 * totals.drawing / static_cast<double>(totals.frames), 2) << " ms each to draw";
  out << '\n';
  if (!totals.cycles.empty()) {
    print_range(out, "cycles", totals.cycles);
    print_range(out, "bytes", totals.bytes);
    constexpr std::uint64_t kRate = 30, kMega = 1'000'000;  // frames a second
    out << "clock       " << with_commas((std::ranges::max(totals.cycles) * kRate + kMega - 1) / kMega)
        << " MHz for 30 frames a second, each of the most cycles\n";
  }
  for (const std::string& text : totals.lacks) out << "no cycles   " << text << '\n';
  for (const std::string& text : totals.missing) out << "missing     " << text << '\n';
}

int run(const RunCommand& options) {
  const auto start = std::chrono::steady_clock::now();
  const Config config = effective_config(options);
  const FrameSpan span = parse_frames(options.frames);
  if (!options.save.empty() && !options.save_folder.empty())
    throw InputError("--save and --save-all: give one of the two");
  if (!options.save_path.empty() && options.save.empty())
    throw InputError("-o: the capture of --save N; add that, or use --save-all DIR");
  for (const std::string* path : {&options.save_path, &options.csv_path, &options.chart_path})
    if (*path == "-") throw InputError("run: stdout is the program's; give a file in place of -");
  if (!options.chart_path.empty()) require_chart_library();
  make_folder("--save-all", options.save_folder);

  const TemporaryFolder folder;
  const bool keeps_rows = !options.json.empty() || !options.csv_path.empty() || !options.chart_path.empty();
  ResultLines lines(folder.file("results"), keeps_rows);
  const RunTotals& totals = lines.totals;
  stop_in_order();
  bool is_partial = false, has_all = false;
  int status = 0;
  const int last = last_frame(options, span);
  {
    // From a terminal it stays in the terminal's group, so that Ctrl-C and reading work.
    Child child(options.program, environment(folder, driver_options(options, config, span, folder)),
                {.output = options.json == "-" ? ChildOptions::Output::to_stderr : ChildOptions::Output::as_here,
                 .has_group = isatty(STDIN_FILENO) == 0});
    while (!child.has_ended()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      lines.read();
      has_all = last >= 0 && !totals.last.is_null() && totals.last["frame"].get<int>() >= last;
      if (has_all || is_interrupted()) child.end();
    }
    status = child.status();
  }
  lines.read();
  remove_unfinished(options);
  is_partial = is_interrupted();

  Json result = result_head("run", options, config);
  std::vector<std::string> answered;
  std::ifstream answers(folder.file("answered"));
  for (std::string line; std::getline(answers, line);)
    if (std::ranges::find(answered, line) == answered.end()) answered.push_back(line);
  result["program"] = options.program;
  result["status"] = or_null(!has_all, status);
  result["answered"] = answered;
  result["engine"] = options.engine;
  result["memory"] = options.engine == "cycle" ? memory_json(options.memory) : Json(nullptr);
  result["width"] = totals.last.is_null() ? Json(0) : totals.last["width"];
  result["height"] = totals.last.is_null() ? Json(0) : totals.last["height"];
  result["missing"] = totals.missing;
  result["lacks"] = totals.lacks;
  result["frames"] = lines.rows;
  if (!options.csv_path.empty()) write_text_file(options.csv_path, csv_text(csv_rows(lines.rows)));
  if (!options.chart_path.empty()) write_page(options.chart_path, kFramesPage, result);
  finish_json(options, result, start, is_partial);
  std::ostream& out = human(options);
  if (!answered.empty()) print_run(out, options, totals, answered, config);
  const auto complain = [&](int exit_status, const std::string& what) {
    std::cerr << "halfplane: run: " << what << '\n';
    return exit_status;
  };
  if (is_partial) return ended(out, is_partial, exit_ok);
  if (answered.empty())
    return complain(
        exit_mismatch,
        options.program[0] + " did not load the driver: it draws without OpenGL, or its libGL is not libglvnd's");
  if (has_all || status == 0) return exit_ok;
  if (options.on_missing == "stop" && status == exit_bad_input) return exit_bad_input;  // the driver has said why
  return complain(exit_mismatch, options.program[0] + " ended with status " + std::to_string(status));
}

}  // namespace

void add_run_command(CLI::App& app, Action& selected) {
  const auto [command, options] = add_command<RunCommand>(
      app, selected, "run", "runs a program with this model as its OpenGL driver (Linux, libglvnd)", run);
  add_output_options(*command, *options);
  add_choice_option(*command, "--engine", options->engine, {"functional", "cycle"},
                    "functional, or cycle: the cycles of each frame as well");
  add_memory_options(*command, options->memory);
  command
      ->add_option("--frames", options->frames, "A..B: figures of these frames, counted from 0; then the program ends")
      ->type_name("A..B");
  command
      ->add_option("--save", options->save,
                   "frame N as a capture; may be given several times; the program ends after the "
                   "last one if no figures are asked for")
      ->check(whole_number(0, 1'000'000'000))
      ->type_name("N");
  add_text_option(*command, "--save-all", options->save_folder, "every frame as a capture in this folder", "DIR");
  add_file_option(*command, "-o", options->save_path, "the capture of --save, .hpt (default frame-N.hpt)", ".hpt");
  command->add_flag("--hud", options->hud, "frames a second and cycles in a corner of the window");
  add_choice_option(*command, "--on-missing", options->on_missing, {"host", "warn", "stop"},
                    "a draw that this hardware cannot do: is drawn on the host (host), the same with a warning (warn), "
                    "or ends the program (stop)");
  add_number_option(*command, "--threads", options->threads, 1, 1024, "threads that draw");
  add_file_option(*command, "--csv", options->csv_path, "a row of figures for each frame, .csv", ".csv");
  add_file_option(*command, "--chart", options->chart_path, "the figures over time, .html", ".html");
  command->add_option("PROGRAM", options->program, "the program and its arguments, after --")->required();
  command->footer(
      "\nExample:\n  halfplane run --config full --hud -- glxgears\n"
      "  halfplane run --frames 10..19 --engine cycle --csv gears.csv -- glxgears");
}

}  // namespace halfplane
