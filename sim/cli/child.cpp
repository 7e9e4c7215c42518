#include "sim/cli/child.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "model/input_error.hpp"

extern char** environ;

namespace halfplane {
namespace {

std::vector<char*> pointers(const std::vector<std::string>& words) {
  std::vector<char*> list;
  for (const std::string& word : words) list.push_back(const_cast<char*>(word.c_str()));
  list.push_back(nullptr);
  return list;
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

Child::Child(const std::vector<std::string>& program, const std::vector<std::string>& environment,
             const ChildOptions& options)
    : has_group_(options.has_group) {
  const std::vector<char*> words = pointers(program), variables = pointers(environment);
  int file = -1;
  if (options.output == ChildOptions::Output::to_file) {
    file = open(options.file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) throw InputError("cannot write '" + options.file + "': " + std::strerror(errno));
  }
  std::array<int, 2> failure{};
  if (pipe2(failure.data(), O_CLOEXEC) != 0 || (pid_ = fork()) < 0) {
    if (file >= 0) close(file);
    throw std::runtime_error("cannot start a program: " + std::string(std::strerror(errno)));
  }
  if (pid_ == 0) {
    if (has_group_) setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, options.signal_if_orphan);
    if (options.output == ChildOptions::Output::to_stderr) dup2(STDERR_FILENO, STDOUT_FILENO);
    if (file >= 0) {
      dup2(file, STDOUT_FILENO);
      dup2(file, STDERR_FILENO);
    }
    for (const int number : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM}) std::signal(number, SIG_DFL);
    execvpe(words[0], words.data(), variables.data());
    const int reason = errno;
    (void)!write(failure[1], &reason, sizeof reason);
    _exit(127);
  }
  if (has_group_) setpgid(pid_, pid_);  // here, too: end() may come before the child has done it
  if (file >= 0) close(file);
  close(failure[1]);
  int reason = 0;
  const bool has_failed = read(failure[0], &reason, sizeof reason) == sizeof reason;
  close(failure[0]);
  if (!has_failed) return;
  wait(0);
  throw InputError("cannot start '" + program[0] + "': " + std::strerror(reason));
}

Child::~Child() {
  if (!has_ended_) end();
}

bool Child::wait(int flags) {
  rusage used{};
  if (wait4(pid_, &status_, flags, &used) != pid_) return false;
  cpu_seconds_ = seconds(used.ru_utime) + seconds(used.ru_stime);
  return true;
}

bool Child::has_ended() {
  if (!has_ended_) has_ended_ = wait(WNOHANG);
  return has_ended_;
}

void Child::end() {
  signal(SIGTERM);
  for (int i = 0; i < 60 && !has_ended(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  if (has_ended_) return;
  signal(SIGKILL);
  has_ended_ = wait(0);
}

int Child::status() const { return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_); }

void Child::signal(int number) const { kill(has_group_ ? -pid_ : pid_, number); }

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "halfplane-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw std::runtime_error("cannot make a folder for temporary files: " + std::string(std::strerror(errno)));
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code error;
  std::filesystem::remove_all(path_, error);
}

std::vector<std::string> own_environment() {
  std::vector<std::string> variables;
  for (char** word = environ; *word != nullptr; ++word) variables.emplace_back(*word);
  return variables;
}

}  // namespace halfplane
