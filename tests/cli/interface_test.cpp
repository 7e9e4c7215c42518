// The promises of docs/interface.md for every command: the version, NO_COLOR, hints for misspelt names, configuration
// files.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <regex>

#include "halfplane_paths.hpp"
#include "model/config.hpp"
#include "program.hpp"

namespace halfplane::cli::interface_test {
namespace {

class Interface : public Cli {
 protected:
  /// The program's output on a terminal.
  [[nodiscard]] std::string on_terminal(const Arguments& arguments, const char* no_color) const {
    const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
    if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0) return "no terminal";
    const std::string name = ptsname(terminal);
    const int slave = open(name.c_str(), O_RDWR | O_NOCTTY);
    std::vector<char*> argv;
    std::string program = HALFPLANE_PROGRAM;
    Arguments words = arguments;
    argv.push_back(program.data());
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      setenv("TERM", "xterm", 1);
      unsetenv("NO_COLOR");
      if (no_color != nullptr) setenv("NO_COLOR", no_color, 1);
      if (dup2(slave, STDOUT_FILENO) < 0 || dup2(slave, STDERR_FILENO) < 0 || chdir(folder_.c_str()) != 0) _exit(126);
      execv(program.c_str(), argv.data());
      _exit(127);
    }
    close(slave);
    std::string text;
    char buffer[4096];
    for (ssize_t n = 0; (n = read_some(terminal, buffer, sizeof buffer)) > 0;)
      text.append(buffer, static_cast<std::size_t>(n));
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0) << text;
    close(terminal);
    return text;
  }

 private:
  static ssize_t read_some(int file, char* buffer, std::size_t size) { return ::read(file, buffer, size); }
};

TEST_F(Interface, VersionNamesCommitBuildAndRtl) {
  const std::regex form(
      R"(halfplane \d+\.\d+\.\d+ \(commit (unknown|[0-9a-f]{7,40}(\+changes)?), \w+, \w+ [0-9.]+, RTL: (none|\S.*)\)\n)");
  const std::string text = run({"--version"}).out;
  EXPECT_TRUE(std::regex_match(text, form)) << text;
  EXPECT_TRUE(text.starts_with("halfplane " HALFPLANE_VERSION " ")) << text;
}

TEST_F(Interface, NoColorLeavesOutTheEscapes) {
  for (const char* command : {"render", "compare"}) {
    const Arguments arguments{command, "triangle", "--size", "16x16"};
    EXPECT_NE(on_terminal(arguments, nullptr).find("\x1b["), std::string::npos) << command;
    EXPECT_NE(on_terminal(arguments, "").find("\x1b["), std::string::npos) << "empty counts as not set";
    const std::string plain = on_terminal(arguments, "1");
    EXPECT_EQ(plain.find('\x1b'), std::string::npos) << plain;
    EXPECT_NE(plain.find("triangle, 16x16"), std::string::npos) << plain;
  }
}

TEST_F(Interface, MisspeltWordsAreAnsweredWithTheNearestOne) {
  expect_refused({"rendr", "teapot"}, "no command 'rendr' in this version; did you mean render? give one of render,");
  expect_refused({"confg"}, "did you mean config?");
  expect_refused({"render", "taepot"}, "did you mean teapot?");
  expect_refused({"render", "cty:3"}, "did you mean city?");
  expect_refused({"render", "triangle", "--config", "embeded"}, "did you mean embedded?");
  expect_refused({"config", "--config", "ful"}, "did you mean full?");
  expect_refused({"render", "triangle", "--set", "depth.bit=20"}, "did you mean depth.bits?");
  expect_refused({"bench", "triangle", "--vary", "subpixl.bits=1,2"}, "did you mean subpixel.bits?");
  expect_refused({"render", "triangle", "--engine", "cycle", "--what-if", "cache.line=4"}, "did you mean cache.lines?");
  expect_refused({"render", "triangle", "--sise", "8x8"}, "did you mean --size?");
  expect_refused({"compare", "triangle", "--cofnig=full"}, "did you mean --config?");
  write("c.toml", "preset = \"tinny\"\n");
  expect_refused({"config", "--config", "c.toml"}, "did you mean tiny?");
  for (const Arguments& far : {Arguments{"sweep"},
                               {"render", "spaceship"},
                               {"config", "--set", "blah=1"},
                               {"render", "triangle", "--nonsense"}}) {
    const Outcome outcome = run(far);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.err.find("did you mean"), std::string::npos) << outcome.err;
  }
}

TEST_F(Interface, ConfigurationsSurviveTheirFile) {
  const std::vector<Arguments> changes{
      {},
      {"--set", "depth.bits=20"},
      {"--set", "depth.mapping=rev", "--set", "depth.format=uf4.12"},
      {"--set", "color.format=rgba8888", "--set", "setup.kind=serial", "--set", "hiz.bits=0"}};
  for (const auto name : preset_names())
    for (const Arguments& change : changes) {
      Arguments asked{"config", "--config", std::string(name)};
      asked.insert(asked.end(), change.begin(), change.end());
      Arguments written = asked;
      written.insert(written.end(), {"-o", "mine.toml", "--quiet"});
      ASSERT_EQ(run(written).status, 0) << testing::PrintToString(written);
      const Json before = result(asked)["config"];
      EXPECT_EQ(result({"config", "--config", "mine.toml"})["config"], before);
      Arguments printed = asked;
      printed.emplace_back("--toml");
      const Outcome outcome = run(printed);
      EXPECT_EQ(outcome.status, 0);
      const Bytes file = read("mine.toml");
      EXPECT_EQ(outcome.out, std::string(file.begin(), file.end()));
      EXPECT_EQ(outcome.err, "");
    }
}

TEST_F(Interface, AMisspeltPageIsGuessed) { expect_refused({"man", "rendr"}, "did you mean render?"); }

TEST_F(Interface, ConfigurationFilesAreNamedSo) {
  expect_refused({"config", "-o", "mine.json"}, "this option writes .toml files");
  expect_refused({"config", "-o", "nowhere/mine.toml"}, "no such folder");
  expect_refused({"config", "--toml", "--json"}, "--toml");
  expect_refused({"config", "-o", "-", "--toml"}, "both write to stdout");
  ASSERT_EQ(run({"config", "-o", "mine.toml"}).status, 0);
  expect_refused({"config", "--config", "mine.toml", "-o", "mine.toml"}, "two options name");
}

}  // namespace
}  // namespace halfplane::cli::interface_test
