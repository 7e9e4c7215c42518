#include "sim/cli/foreign_test.hpp"

#include <algorithm>
#include <csignal>
#include <thread>
#include <unordered_map>

#include "model/as_number.hpp"
#include "model/draw_states.hpp"
#include "sim/cli/child.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/interrupt.hpp"
#include "sim/show/image/whole_file.hpp"

namespace halfplane {
namespace {

constexpr int kRunsBefore = 3;  // of the whole scene, to see whether the program does the same each time

/// The command with each {} replaced by a file.
std::string with_file(const std::string& command, const std::string& file) {
  std::string text;
  for (std::size_t at = 0;;) {
    const std::size_t next = command.find("{}", at);
    text += command.substr(at, next - at);
    if (next == std::string::npos) return text;
    text += quoted(file);
    at = next + 2;
  }
}

/// Runs the program on scenes, one at a time.
class ForeignProgram {
 public:
  explicit ForeignProgram(const ForeignOptions& options) : options_(options) {}

  std::size_t runs = 0;

  /// "0", "1", "139", "timeout": of the program's last run on this scene, if there was one. Throws Interrupted.
  std::string status_of(const Scene& scene) {
    const std::string text = capture_text(scene);
    const auto known = known_.find(std::hash<std::string>{}(text));
    return known == known_.end() ? run(text) : known->second;
  }

  /// The status of another run. Throws Interrupted.
  std::string run(const std::string& text) {
    ++runs;
    return known_[std::hash<std::string>{}(text)] = status_of_run(text);
  }

 private:
  std::string status_of_run(const std::string& text) {
    const std::string file = folder_.file("scene.hpt");
    write_text_file(file, text);
    Child child(
        {"/bin/sh", "-c", with_file(options_.command, file)}, own_environment(),
        {.output = ChildOptions::Output::to_file, .file = "/dev/null", .has_group = true, .signal_if_orphan = SIGKILL});
    const auto start = std::chrono::steady_clock::now();
    while (!child.has_ended()) {
      stop_if_interrupted();
      if (seconds_since(start) > options_.timeout_s) {
        child.end();
        return "timeout";
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return std::to_string(child.status());
  }

  ForeignOptions options_;
  TemporaryFolder folder_;
  std::unordered_map<std::size_t, std::string> known_;  // statuses, by hashes of scenes
};

}  // namespace

void add_foreign_options(CLI::App& app, ForeignOptions& options) {
  add_text_option(app, "--command", options.command,
                  "instead of the RTL: a command for sh, {} being the capture, that fails with a status other than 0",
                  "COMMAND");
  add_text_option(app, "--status", options.status,
                  "of --command: only this exit status is the failure: a number, or timeout", "STATUS");
  add_real_option(app, "--timeout", options.timeout_s, 0.01, 86400.0,
                  "of --command: seconds after which a run is stopped")
      ->capture_default_str();
  app.add_option("--keep", options.kept,
                 "of --command: what its program has no other of, states and target (its size), comma-separated; it is "
                 "not made simpler")
      ->delimiter(',')
      ->type_name("NAMES");
}

ForeignTest foreign_test(const ForeignOptions& options, const Scene& scene) {
  if (options.command.find("{}") == std::string::npos)
    throw InputError(
        "--command: no {} in it, so it gets no scene; write it where the capture belongs, as in './sim {}'");
  const auto number = as_number<int>(options.status);
  if (!options.status.empty() && options.status != "timeout" && !(number && *number >= 1 && *number <= 255))
    throw InputError("--status: '" + options.status + "' is no failure; give 1 to 255, or timeout");
  for (const std::string& name : options.kept)
    if (name != "target" && std::none_of(draw_states().begin(), draw_states().end(),
                                         [&name](const DrawState& row) { return row.name == name; }))
      throw InputError("--keep: no state '" + name + "'; give target, or states by their names in captures, as shade");
  const auto program = std::make_shared<ForeignProgram>(options);
  const std::string text = capture_text(scene);
  std::string whole, seen;
  bool is_steady = true;
  for (int i = 0; i < kRunsBefore; ++i) {
    const std::string status = program->run(text);
    if (status == "126" || status == "127")
      throw InputError("--command: sh cannot run it (status " + status + "); check its path");
    is_steady = is_steady && (i == 0 || status == whole);
    whole = i == 0 ? status : whole;
    seen += (i == 0 ? "" : ", ") + status;
  }
  if (!is_steady)
    throw InputError("--command: the same scene ends with status " + seen +
                     "; a reduction needs a program that does the same each time: fix its seed");
  if (options.status.empty() ? whole == "0" : whole != options.status)
    throw InputError("--command: the scene does not fail, it ends with status " + whole +
                     "; give a scene that fails, or --status with how it does");
  const bool is_any = options.status.empty() && whole != "timeout";
  return {[program, is_any, whole](const Scene& next, const LockstepOptions&) -> std::optional<Mismatch> {
            const std::string status = program->status_of(next);
            if (is_any ? status == "0" || status == "timeout" : status != whole) return {};
            Mismatch mismatch;
            mismatch.stage = "command";
            mismatch.hint = "status " + status;
            return mismatch;
          },
          whole, std::shared_ptr<const std::size_t>(program, &program->runs)};
}

}  // namespace halfplane
