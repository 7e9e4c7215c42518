#include "program.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

#include "halfplane_paths.hpp"
#include "sim/cosim/dut.hpp"

namespace halfplane::cli {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void limit(int resource, std::size_t bytes) {
  if (bytes == 0) return;
  const rlimit both{bytes, bytes};
  if (setrlimit(static_cast<__rlimit_resource_t>(resource), &both) != 0) _exit(126);
}

// After this, descriptor `target` is the file `path`.
void redirect(int target, const char* path, int flags) {
  const int file = open(path, flags, 0600);
  if (file < 0 || dup2(file, target) < 0) _exit(126);
  close(file);
}

void redirect_stdout(Stdout kind, const char* captured) {
  int ends[2];
  switch (kind) {
    case Stdout::captured: return redirect(STDOUT_FILENO, captured, O_CREAT | O_WRONLY | O_TRUNC);
    case Stdout::closed: close(STDOUT_FILENO); return;
    case Stdout::full_disk: return redirect(STDOUT_FILENO, "/dev/full", O_WRONLY);
    case Stdout::pipe_without_reader:
      if (pipe(ends) != 0 || dup2(ends[1], STDOUT_FILENO) < 0) _exit(126);
      close(ends[0]);
      close(ends[1]);
      return;
  }
}

// A folder name of this process and test.
fs::path own_folder() {
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  return fs::temp_directory_path() / ("halfplane-cli-" + std::to_string(getpid()) + "-" + test.name());
}

}  // namespace

Cli::Cli() : folder_(own_folder() / "run") {
  fs::remove_all(folder_.parent_path());
  fs::create_directories(folder_);
}

Cli::~Cli() { fs::remove_all(folder_.parent_path()); }

Outcome Cli::run(const Arguments& arguments, const Surroundings& surroundings) const {
  return outcome_of(start(HALFPLANE_PROGRAM, arguments, surroundings));
}

Outcome Cli::paste(const std::string& line) const { return outcome_of(start("/bin/sh", {"-c", line}, {})); }

pid_t Cli::start(std::string program, std::vector<std::string> words, const Surroundings& surroundings) const {
  const std::string out = out_path(), err = err_path();
  fs::remove(out);
  fs::remove(err);
  std::vector<char*> argv;
  argv.push_back(program.data());
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const pid_t child = fork();
  if (child != 0) return child;
  if (chdir(folder_.c_str()) != 0) _exit(126);
  redirect(STDIN_FILENO, surroundings.in.empty() ? "/dev/null" : surroundings.in.c_str(), O_RDONLY);
  redirect(STDERR_FILENO, err.c_str(), O_CREAT | O_WRONLY | O_TRUNC);
  redirect_stdout(surroundings.out, out.c_str());
  limit(RLIMIT_FSIZE, surroundings.file_bytes);
  limit(RLIMIT_AS, surroundings.memory_bytes);
  if (surroundings.progress_s > 0) setenv("HALFPLANE_PROGRESS", std::to_string(surroundings.progress_s).c_str(), 1);
  execv(program.c_str(), argv.data());
  _exit(127);
}

Outcome Cli::outcome_of(pid_t child) const {
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child) return {};
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), text_of(out_path()), text_of(err_path())};
}

Outcome Cli::interrupt(const Arguments& arguments, int signal, double again) const {
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const auto is_running = [](pid_t child) {
    siginfo_t info{};
    return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == 0;
  };
  const pid_t child = start(HALFPLANE_PROGRAM, arguments, {.progress_s = 0.01});
  if (child < 0) return {};
  while (is_running(child) && text_of(err_path()).find('\n') == std::string::npos)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  auto sent = Clock::now();
  kill(child, signal);
  if (again > 0) {
    while (is_running(child) && seconds_since(sent) < again) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    sent = Clock::now();
    kill(child, signal);  // to a process that has ended but was not waited for it does nothing
  }
  Outcome outcome = outcome_of(child);
  outcome.ended_after = seconds_since(sent);
  return outcome;
}

Json Cli::result(Arguments arguments) const {
  arguments.insert(arguments.end(), {"--quiet", "--json"});
  const Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.status, 0) << testing::PrintToString(arguments);
  // Few bits of depth may not separate a scene's places, and then a line warns of it.
  EXPECT_EQ(outcome.err.starts_with("halfplane: warning: distances ") ? "" : outcome.err, "");
  const Json json = Json::parse(outcome.out, nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << "not JSON alone: " << outcome.out;
  return json;
}

void Cli::expect_refused(const Arguments& arguments, const std::string& part, int status,
                         const Surroundings& surroundings) const {
  const auto before = listing();
  const Outcome outcome = run(arguments, surroundings);
  const std::string words = testing::PrintToString(arguments);
  EXPECT_EQ(outcome.status, status) << words << "\n" << outcome.err;
  EXPECT_EQ(outcome.err.rfind("halfplane: ", 0), 0u) << words << "\n" << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << words << "\n" << outcome.err;
  EXPECT_TRUE(outcome.err.ends_with("\n")) << words << "\n" << outcome.err;
  EXPECT_NE(outcome.err.find(part), std::string::npos) << words << "\n" << outcome.err;
  EXPECT_EQ(outcome.out, "") << words;
  EXPECT_EQ(listing(), before) << words;
}

void Cli::write(const std::string& name, const std::string& text) const {
  std::ofstream file(folder_ / name, std::ios::binary);
  file << text;
  ASSERT_TRUE(file.flush()) << name;
}

Bytes Cli::read(const std::string& name) const {
  const std::string text = text_of(folder_ / name);
  return {text.begin(), text.end()};
}

std::vector<std::string> Cli::listing() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

void skip_without_rtl() {
  if (verilated_duts().empty()) GTEST_SKIP() << "this build has no RTL";
}

Arguments split_words(const std::string& line) {
  Arguments words;
  std::string word;
  bool is_quoted = false, is_open = false;  // open: a word has begun, if only with a quote
  for (const char c : line + " ") {
    if (c == '\'') {
      is_quoted = !is_quoted;
      is_open = true;
    } else if (c != ' ' || is_quoted) {
      word += c;
      is_open = true;
    } else if (is_open) {
      words.push_back(word);
      word.clear();
      is_open = false;
    }
  }
  return words;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace halfplane::cli
