// `reduce --command`: somebody else's program as the predicate.
#include <map>
#include <sstream>

#include "program.hpp"

namespace halfplane::cli::reduce_command_test {
namespace {

class ReduceCommand : public Cli {
 protected:
  void SetUp() override {
    ASSERT_EQ(run(split_words("convert --random 50 --seed 3 --random-only triangles,cull=none|back -o c.hpt")).status,
              0);
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    const Bytes bytes = read(name);
    return {bytes.begin(), bytes.end()};
  }
};

TEST_F(ReduceCommand, ReducesWhileAForeignProgramFails) {
  // Fails, with status 3, at one back-face cull of a triangle.
  const Json result =
      this->result({"reduce", "c.hpt", "--command", "if grep -q 'cull back' {}; then exit 3; fi", "-o", "small.hpt"});
  EXPECT_EQ(result["status"], "3");
  EXPECT_EQ(result["triangles"]["before"], 50);
  EXPECT_EQ(result["triangles"]["after"], 1);
  EXPECT_EQ(result["minimal"], true);
  const std::string small = text("small.hpt");
  EXPECT_NE(small.find("state cull back"), std::string::npos) << small;
  for (const char* word : {"depth_test", "scissor", "front", "shade"})
    EXPECT_EQ(small.find(word), std::string::npos) << word << "\n" << small;
}

TEST_F(ReduceCommand, WhatIsKeptStaysAndNothingElse) {
  // Any triangle of c.hpt fails, so that nothing but --keep holds a state or the target.
  ASSERT_EQ(
      run(split_words("convert --random 20 --random-only triangles,64x64,shade=flat,less,cull=back -o d.hpt")).status,
      0);
  const Arguments words{"reduce", "d.hpt", "--command", "if grep -q '^t ' {}; then exit 3; fi", "-o", "small.hpt"};
  ASSERT_EQ(run(words).status, 0);
  std::string small = text("small.hpt");
  for (const char* word : {"target 64 64", "state shade", "state cull"})
    EXPECT_EQ(small.find(word), std::string::npos) << word << "\n" << small;
  Arguments keeping = words;
  keeping.insert(keeping.end(), {"--keep", "target,shade"});
  ASSERT_EQ(run(keeping).status, 0);
  small = text("small.hpt");
  for (const char* word : {"target 64 64", "state shade flat"})
    EXPECT_NE(small.find(word), std::string::npos) << word << "\n" << small;
  EXPECT_EQ(small.find("state cull"), std::string::npos) << small;
}

TEST_F(ReduceCommand, NoSceneIsRunTwiceButTheWholeOne) {
  write("runs", "");
  const Json result = this->result({"reduce", "c.hpt", "--command",
                                    "cksum {} >>runs; if grep -q 'cull back' {}; then exit 3; fi", "-o", "small.hpt"});
  std::istringstream lines(text("runs"));
  std::map<std::string, int> times;
  std::string whole;
  for (std::string line; std::getline(lines, line); ++times[line])
    if (whole.empty()) whole = line;
  EXPECT_EQ(times.size() + 2, result["runs"]);
  EXPECT_GT(times.size(), 5U);
  for (const auto& [line, count] : times) EXPECT_EQ(count, line == whole ? 3 : 1) << line;
}

TEST_F(ReduceCommand, AStatusThatIsNamedCountsAlone) {
  const std::string command = "if grep -q 'cull back' {}; then exit 3; fi; if grep -q '^t' {}; then exit 4; fi";
  expect_refused({"reduce", "c.hpt", "--command", command, "--status", "4"}, "it ends with status 3");
  const Json result = this->result({"reduce", "c.hpt", "--command", command, "--status", "3", "-o", "small.hpt"});
  EXPECT_NE(text("small.hpt").find("cull back"), std::string::npos) << "a triangle without it ends with status 4";
  EXPECT_EQ(result["triangles"]["after"], 1);
}

TEST_F(ReduceCommand, AHangIsAFailureWhereTheWholeSceneHangs) {
  const Json result =
      this->result({"reduce", "c.hpt", "--command", "if grep -q 'cull back' {}; then sleep 60; fi; exit 0", "--timeout",
                    "1", "--seconds", "8", "-o", "small.hpt"});  // a second: more than a busy machine takes for a grep
  EXPECT_EQ(result["status"], "timeout");
  EXPECT_LT(result["triangles"]["after"], 50);
  EXPECT_NE(text("small.hpt").find("cull back"), std::string::npos);
}

TEST_F(ReduceCommand, AProgramThatDoesNotDoTheSameEachTimeIsRefused) {
  write("runs", "");
  expect_refused({"reduce", "c.hpt", "--command", ": {}; echo >>runs; exit $(wc -l <runs)"},
                 "ends with status 1, 2, 3; a reduction needs a program that does the same each time");
  expect_refused({"reduce", "c.hpt", "--command", "true {}"}, "does not fail, it ends with status 0");
  expect_refused({"reduce", "c.hpt", "--command", "./none {}"}, "sh cannot run it (status 127)");
  expect_refused({"reduce", "c.hpt", "--command", "false"}, "no {} in it");
  expect_refused({"reduce", "c.hpt", "--command", "false {}", "--status", "0"}, "is no failure");
  expect_refused({"reduce", "c.hpt", "--command", "false {}", "--mutant", "3"}, "leave it out");
  expect_refused({"reduce", "c.hpt", "--status", "3"}, "add --command");
  expect_refused({"reduce", "c.hpt", "--keep", "shade"}, "add --command");
  expect_refused({"reduce", "c.hpt", "--command", "false {}", "--keep", "size"}, "no state 'size'; give target");
}

}  // namespace
}  // namespace halfplane::cli::reduce_command_test
