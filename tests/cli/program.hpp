// Runs the halfplane program the way a person or a script does, in an empty folder of the test's own.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace halfplane::cli {

using Bytes = std::vector<std::uint8_t>;
using Json = nlohmann::json;
using Arguments = std::vector<std::string>;

/// Destination of the program's stdout.
enum class Stdout { captured, closed, full_disk, pipe_without_reader };

/// Limits of the machine; 0: no limit.
struct Surroundings {
  Stdout out = Stdout::captured;
  std::size_t file_bytes = 0;    ///< no file may grow beyond
  std::size_t memory_bytes = 0;  ///< address space
  std::string in{};              ///< file on stdin, in the folder; none: nothing to read
  double progress_s = 0;         ///< seconds between lines of progress; 0: as usual
};

/// Results of one run.
struct Outcome {
  int status = -1;  ///< exit status, or 1000 + the signal that killed it
  std::string out, err;
  double ended_after = 0;  ///< seconds since the last signal that was sent
};

/// A test with an empty folder, in which the program runs. The folder is gone when the test ends.
class Cli : public testing::Test {
 protected:
  Cli();
  ~Cli() override;

  [[nodiscard]] Outcome run(const Arguments& arguments, const Surroundings& surroundings = {}) const;

  /// Starts the program and sends it `signal` once it shows progress, which it does every hundredth of a second; then, as
  /// soon as `again` seconds have gone by and if it still runs, once more. 0: never.
  [[nodiscard]] Outcome interrupt(const Arguments& arguments, int signal, double again = 0) const;
  /// Gives a line to sh, as a person who pastes it into a terminal in the folder.
  [[nodiscard]] Outcome paste(const std::string& line) const;

  /// Runs with `--quiet --json` added, expects success and an empty stderr, and parses the whole of stdout.
  [[nodiscard]] Json result(Arguments arguments) const;

  /// Expects one line on stderr that begins "halfplane: " and holds `part`, an empty stdout, the status, and no file in
  /// the folder that was not there before.
  void expect_refused(const Arguments& arguments, const std::string& part, int status = 2,
                      const Surroundings& surroundings = {}) const;

  void write(const std::string& name, const std::string& text) const;
  [[nodiscard]] Bytes read(const std::string& name) const;
  [[nodiscard]] bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

  /// Names of all files in the folder, hidden ones too.
  [[nodiscard]] std::vector<std::string> listing() const;

  std::filesystem::path folder_;

 private:
  /// Starts it in its folder. The process, below 0 if there is none.
  [[nodiscard]] pid_t start(std::string program, Arguments words, const Surroundings& surroundings) const;
  [[nodiscard]] std::string out_path() const { return folder_.parent_path() / "stdout"; }
  [[nodiscard]] std::string err_path() const { return folder_.parent_path() / "stderr"; }
  /// Waits for its end.
  [[nodiscard]] Outcome outcome_of(pid_t child) const;
};

/// For SetUp() of tests that run the RTL. The presets of `./dev test` and of CI have it: HALFPLANE_RTL is REQUIRED there.
void skip_without_rtl();

/// Words between blanks; ' quotes as in a shell.
[[nodiscard]] Arguments split_words(const std::string& line);

/// The lines of `text`, without their ends.
[[nodiscard]] std::vector<std::string> lines_of(const std::string& text);

}  // namespace halfplane::cli
