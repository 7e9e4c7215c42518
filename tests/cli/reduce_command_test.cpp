// `reduce --command`: somebody else's program as the predicate.
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
                    "0.3", "--seconds", "5", "-o", "small.hpt"});
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
}

}  // namespace
}  // namespace halfplane::cli::reduce_command_test
