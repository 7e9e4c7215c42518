// A program that this one starts, and whoever that starts.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace halfplane {

struct ChildOptions {
  enum class Output {
    as_here,
    to_stderr,  ///< stdout goes to stderr, too
    to_file     ///< both go to `file`
  };
  Output output = Output::as_here;
  std::string file{};
  /// Has a process group of its own: Ctrl-C does not reach it, and end() reaches whoever it started.
  bool has_group = false;
  int signal_if_orphan = 15;  ///< SIGTERM: what it gets when this program dies
};

class Child {
 public:
  /// The words of the program, looked up in PATH, and its environment, NAME=VALUE. Throws InputError when it cannot be
  /// started.
  Child(const std::vector<std::string>& program, const std::vector<std::string>& environment,
        const ChildOptions& options);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Whether it has ended by now.
  bool has_ended();
  /// Asks it to end, and after three seconds does not ask.
  void end();
  /// As a shell has it: 128 and the signal that ended it.
  [[nodiscard]] int status() const;
  /// Processor time once it has ended.
  [[nodiscard]] double cpu_seconds() const { return cpu_seconds_; }

 private:
  void signal(int number) const;
  bool wait(int flags);

  pid_t pid_ = -1;
  int status_ = 0;
  double cpu_seconds_ = 0;
  bool has_group_ = false, has_ended_ = false;
};

/// A folder that is gone when the object is.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// The environment of this program, NAME=VALUE.
[[nodiscard]] std::vector<std::string> own_environment();

}  // namespace halfplane
