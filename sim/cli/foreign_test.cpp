#include "sim/cli/foreign_test.hpp"

#include <csignal>
#include <memory>
#include <thread>

#include "model/as_number.hpp"
#include "sim/cli/child.hpp"
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

  /// "0", "1", "139", "timeout". Throws Interrupted.
  std::string status_of(const Scene& scene) {
    const std::string file = folder_.file("scene.hpt");
    write_text_file(file, capture_text(scene));
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

 private:
  ForeignOptions options_;
  TemporaryFolder folder_;
};

}  // namespace

void add_foreign_options(CLI::App& app, ForeignOptions& options) {
  app.add_option("--command", options.command,
                 "instead of the RTL: a command for sh, {} being the capture, that fails with a status other than 0")
      ->check(refuse_empty)
      ->type_name("COMMAND");
  app.add_option("--status", options.status, "of --command: only this exit status is the failure: a number, or timeout")
      ->check(refuse_empty)
      ->type_name("STATUS");
  app.add_option("--timeout", options.timeout_s, "of --command: seconds after which a run is stopped")
      ->check(CLI::Range(0.01, 86400.0))
      ->check(is_number)
      ->capture_default_str();
}

ForeignTest foreign_test(const ForeignOptions& options, const Scene& scene) {
  if (options.command.find("{}") == std::string::npos)
    throw InputError(
        "--command: no {} in it, so it gets no scene; write it where the capture belongs, as in './sim {}'");
  const auto number = as_number<int>(options.status);
  if (!options.status.empty() && options.status != "timeout" && !(number && *number >= 1 && *number <= 255))
    throw InputError("--status: '" + options.status + "' is no failure; give 1 to 255, or timeout");
  const auto program = std::make_shared<ForeignProgram>(options);
  std::string whole, seen;
  bool is_steady = true;
  for (int i = 0; i < kRunsBefore; ++i) {
    const std::string status = program->status_of(scene);
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
          whole};
}

}  // namespace halfplane
