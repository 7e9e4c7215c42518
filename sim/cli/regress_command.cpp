// `regress`: the cases of a plan, each a run of `cosim` by a process of its own, with a file of its own for its result.
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <thread>

#include "sim/cli/build_info.hpp"
#include "sim/cli/child.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/progress.hpp"
#include "sim/cli/regress_plan.hpp"
#include "sim/cli/regress_report.hpp"
#include "sim/cli/task_folder.hpp"
#include "sim/show/image/framebuffer_files.hpp"
#include "sim/show/image/whole_file.hpp"

namespace halfplane {
namespace {

namespace fs = std::filesystem;

struct RegressOptions : CommonOptions {
  std::string plan, folder, until, junit_path;
  int jobs = 1;
  std::size_t only_case = 0;  ///< counted from 1; 0: all
  bool resumes = false, writes_tasks = false, reports = false;
};

std::string text_of_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Of the whole program: a result of other code is none.
std::string program_hash() {
  const std::string bytes = text_of_file("/proc/self/exe");
  return std::to_string(fnv1a64({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
}

/// The cases, and the folder with their results.
class Regression {
 public:
  explicit Regression(const RegressOptions& options)
      : options_(options), cases_(read_regress_plan(options.plan)), results_(cases_.size()) {
    folder_ =
        fs::absolute(options.folder.empty() ? "out/regress-" + fs::path(options.plan).stem().string() : options.folder)
            .lexically_normal();
    manifest_ = {{"schema", "halfplane.regress.folder/1"},
                 {"commit", build_info().commit},
                 {"program", program_hash()},
                 {"cases", Json::array()}};
    for (const RegressCase& one : cases_) manifest_["cases"].push_back(one.arguments);
    if (options.only_case > cases_.size())
      throw InputError("--case: the plan has " + with_commas(cases_.size()) + " cases");
  }
  ~Regression() {
    if (lock_ >= 0) close(lock_);
  }
  Regression(const Regression&) = delete;
  Regression& operator=(const Regression&) = delete;

  /// Makes the folder, or goes on with the results in it.
  void open_folder() {
    if (!options_.reports && options_.only_case == 0) lock_folder();
    const fs::path manifest = folder_ / "plan.json";
    if (!fs::exists(manifest)) return begin();
    const bool is_same = read_task_json(manifest, "remove its folder") == manifest_;
    if (is_same) read_results();
    const std::size_t done = count_done();
    if (is_same && (options_.resumes || options_.reports || options_.only_case != 0)) return;
    if (options_.reports || options_.only_case != 0)
      throw InputError(folder_.string() +
                       ": the results of another plan or program; begin without --report and --case");
    if (is_same && done != 0 && done < cases_.size())
      throw InputError(folder_.string() + " has " + with_commas(done) + " of " + with_commas(cases_.size()) +
                       " cases; --resume goes on with them, and without the folder all begin again");
    begin();
  }

  /// Runs what is missing, until a signal or the end of the time.
  void run() {
    const double until = options_.until.empty() ? 1e9 : parse_duration(options_.until, "--until");  // seconds
    Progress progress(options_, "regression", "cases");
    const auto start = std::chrono::steady_clock::now();
    std::size_t next = options_.only_case == 0 ? 0 : options_.only_case - 1;
    const std::size_t end = options_.only_case == 0 ? cases_.size() : options_.only_case;
    std::vector<std::unique_ptr<Running>> running;
    const std::size_t before = count_done();  // rate and time left are of what is run now
    const double missing = std::max(1.0, static_cast<double>(cases_.size() - before));
    while (true) {
      const std::size_t now = count_done() - before;
      const bool goes_on = progress.goes_on(static_cast<double>(now) / missing, now);
      if (!goes_on) return;  // ends the running ones
      while (next < end && running.size() < static_cast<std::size_t>(options_.jobs) && seconds_since(start) < until) {
        if (results_[next].is_null()) running.push_back(begin_case(next));
        ++next;
      }
      std::erase_if(running, [this](const auto& one) { return is_over(*one); });
      if (running.empty() && (next == end || seconds_since(start) >= until)) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

  void write_task_file() const {
    std::vector<std::string> commands;
    for (std::size_t i = 0; i < cases_.size(); ++i)
      commands.push_back(quoted(own_program()) + " regress " + quoted(fs::absolute(options_.plan).string()) +
                         " -o . --quiet --case " + std::to_string(i + 1));
    write_tasks(folder_, "cases", commands);
    human(options_) << tasks_text(
        folder_, cases_.size(),
        program_word() + " regress " + quoted(options_.plan) + " -o " + quoted(folder_.string()) + " --report");
  }

  [[nodiscard]] RegressReport report() const {
    return {options_.plan, folder_.string(), std::string(build_info().commit), cases_, results_};
  }

 private:
  struct Running {
    std::size_t number = 0;
    int run = 1;
    double cpu_s = 0;  ///< of the runs before
    std::unique_ptr<Child> child;
    std::chrono::steady_clock::time_point start{};
    Json first;  ///< result of the first run, if it failed
  };

  /// Two runs would write the same files. The lock ends with the process, however that ends.
  void lock_folder() {
    std::error_code error;
    fs::create_directories(folder_, error);  // that it cannot be made says begin()
    lock_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      throw InputError(folder_.string() +
                       ": another regress is running in it; wait for it, or give another folder with -o");
  }

  void begin() {
    std::error_code error;
    for (const char* part : {"cases", "work", "plan.json"}) fs::remove_all(folder_ / part, error);
    make_task_folder("-o", folder_, "cases");
    fs::create_directories(folder_ / "work", error);
    results_.assign(cases_.size(), nullptr);
    write_text_file(folder_ / "plan.json", manifest_.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  }

  void read_results() {
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      const fs::path path = folder_ / task_result("cases", i);
      if (fs::exists(path)) results_[i] = read_task_json(path, "remove it");
    }
  }

  [[nodiscard]] std::size_t count_done() const {
    return static_cast<std::size_t>(std::ranges::count_if(results_, [](const Json& one) { return !one.is_null(); }));
  }

  /// A file of case `number` while it runs, and of a failed one.
  [[nodiscard]] std::string work(std::size_t number, const char* ending) const {
    return (folder_ / fs::path(task_result("work", number)).replace_extension(ending)).string();
  }

  void start(Running& one) const {
    std::vector<std::string> words{own_program()};
    words.insert(words.end(), cases_[one.number].arguments.begin(), cases_[one.number].arguments.end());
    words.insert(words.end(), {"--save", work(one.number, ".hpt"), "--json=" + work(one.number, ".json")});
    auto environment = own_environment();
    std::erase_if(environment, [](const std::string& word) { return word.starts_with("HALFPLANE_PROGRESS="); });
    environment.emplace_back("HALFPLANE_PROGRESS=1000000");  // the log is for the report
    std::error_code error;
    fs::remove(work(one.number, ".json"), error);
    one.start = std::chrono::steady_clock::now();
    one.child = std::make_unique<Child>(words, environment,
                                        ChildOptions{.output = ChildOptions::Output::to_file,
                                                     .file = work(one.number, ".log"),
                                                     .has_group = true,
                                                     .signal_if_orphan = SIGKILL});
  }

  std::unique_ptr<Running> begin_case(std::size_t number) const {
    auto one = std::make_unique<Running>();
    one->number = number;
    start(*one);
    return one;
  }

  /// Whether the case is through; then its result is written. A failure is run a second time.
  bool is_over(Running& one) {
    const double limit = cases_[one.number].timeout_s;
    const bool is_late = !one.child->has_ended() && seconds_since(one.start) > limit;
    if (!one.child->has_ended() && !is_late) return false;
    if (is_late) one.child->end();
    Json result = result_of(one, is_late);
    const bool may_be_flaky = result["outcome"] == "failed" || result["outcome"] == "crashed";
    if (one.run == 1 && may_be_flaky) {
      one.first = std::move(result);
      one.cpu_s += one.child->cpu_seconds();
      one.run = 2;
      start(one);
      return false;
    }
    if (one.run == 2 && result["outcome"] == "passed") {
      result = std::move(one.first);
      result["outcome"] = "flaky";
    }
    result["runs"] = one.run;
    result["cpu_s"] = one.cpu_s + one.child->cpu_seconds();
    write_text_file(folder_ / task_result("cases", one.number),
                    result.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    std::error_code error;
    fs::remove(work(one.number, ".json"), error);
    if (result["outcome"] == "passed") fs::remove(work(one.number, ".log"), error);
    results_[one.number] = std::move(result);
    return true;
  }

  [[nodiscard]] Json result_of(const Running& one, bool is_late) const {
    const RegressCase& planned = cases_[one.number];
    const int status = one.child->status();
    const Json cosim = Json::parse(text_of_file(work(one.number, ".json")), nullptr, false);
    const bool has_result = cosim.is_object();
    const bool is_refused = status == exit_bad_input || status == exit_missing;
    std::string log = text_of_file(work(one.number, ".log"));
    constexpr std::size_t kLongestLog = 8192;
    if (log.size() > kLongestLog) log.erase(0, log.size() - kLongestLog);
    std::vector<std::string> words{program_word()};
    for (const std::string& word : planned.arguments) words.push_back(quoted(word));
    const bool has_capture = fs::exists(work(one.number, ".hpt"));
    return {{"number", one.number + 1},
            {"row", planned.row},
            {"name", planned.name},
            {"config", planned.config},
            {"scene", or_null(planned.scene)},
            {"random", or_null(planned.random != 0, planned.random)},
            {"seed", planned.seed},
            {"commit", build_info().commit},
            {"outcome", is_late                   ? "timeout"
                        : is_refused              ? "skipped"
                        : status == exit_ok       ? "passed"
                        : status == exit_mismatch ? "failed"
                                                  : "crashed"},
            {"status", status},
            {"runs", one.run},
            {"wall_s", seconds_since(one.start)},
            {"cpu_s", one.child->cpu_seconds()},
            {"triangles", has_result ? cosim["triangles"] : Json(0)},
            {"rtl_cycles", has_result ? cosim["cycles"]["rtl"] : Json(0)},
            {"mismatch", has_result ? cosim["first_mismatch"] : Json(nullptr)},
            {"capture", or_null(has_capture, work(one.number, ".hpt"))},
            {"log", status == exit_ok ? "" : log},
            {"repeat", joined(words, " ")}};
  }

  const RegressOptions& options_;
  std::vector<RegressCase> cases_;
  std::vector<Json> results_;  ///< null: not run yet
  fs::path folder_;
  Json manifest_;
  int lock_ = -1;  ///< of the folder
};

int run_plan(const RegressOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  if (!options.until.empty()) (void)parse_duration(options.until, "--until");  // before a folder is made
  Regression regression(options);
  regression.open_folder();
  if (options.writes_tasks) {
    regression.write_task_file();
    return exit_ok;
  }
  if (!options.reports) regression.run();
  const bool is_partial = is_interrupted();
  if (options.only_case != 0) return is_partial ? exit_interrupted : exit_ok;  // its file has the result
  const RegressReport report = regression.report();
  Json result = regress_json(report);
  finish_json(options, result, start, is_partial);
  if (!options.junit_path.empty())
    write_text_file(options.junit_path, regress_junit(report, seconds_since(start), typed_command(), is_partial));
  print_regression(human(options), report, program_word());
  return ended(human(options), is_partial, regress_status(report));
}

/// With the statuses that `git bisect run` wants: a plan that cannot be run is neither good nor bad.
int run(const RegressOptions& options) {
  try {
    return run_plan(options);
  } catch (const std::runtime_error& error) {
    std::string message = error.what();
    std::ranges::replace(message, '\n', ' ');
    std::cerr << "halfplane: " << message << '\n';
    return kCannotTell;
  }
}

}  // namespace

void add_regress_command(CLI::App& app, Action& selected) {
  const auto [command, options] = add_command<RegressOptions>(
      app, selected, "regress", "a plan of co-simulations: scenes, configurations, seeds", run);
  add_text_option(*command, "PLAN", options->plan, "the plan, .toml (docs/random.md)")->required()->each(claim_input);
  add_result_options(*command, *options);
  add_number_option(*command, "-j,--jobs", options->jobs, 1, 1024, "cases at a time");
  add_text_option(*command, "--until", options->until, "start no case after this time: 90s, 30m, 8h", "TIME");
  command->add_flag("--resume", options->resumes,
                    "continue from the results of this plan and program in the folder, if there are any");
  add_text_option(*command, "-o,--folder", options->folder, "folder of the results (default out/regress-PLAN)", "DIR");
  command->add_flag("--slurm", options->writes_tasks,
                    "runs nothing: writes tasks, a command for each case, and job.sh for sbatch into the folder");
  command->add_option("--case", options->only_case, "case N of the plan alone, into the folder: a task of --slurm")
      ->check(whole_number(std::size_t{1}, std::size_t{100'000}))
      ->type_name("N");
  command->add_flag("--report", options->reports, "runs nothing: writes the report of the results in the folder");
  add_file_option(*command, "--junit", options->junit_path, "result as JUnit XML, a case each");
  command->footer(
      "\nExit status, as `git bisect run` wants it: 0 every case that ran matches, 1 one does not, 125 no verdict,\n"
      "because the plan or a case cannot be run; 130 interrupted.\n"
      "\nExample:\n  halfplane regress overnight.toml -j 2 --until 8h --resume --junit overnight.xml");
}

}  // namespace halfplane
