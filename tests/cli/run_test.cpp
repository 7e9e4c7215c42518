// `halfplane run`: programs that draw through the driver, and others. tests/gl_program/egl_program.cpp needs no screen.
#include <algorithm>

#include "halfplane_paths.hpp"
#include "program.hpp"

namespace halfplane::cli::run_test {
namespace {

/// Programs that are no scenes: the driver itself must have been built.
class Run : public Cli {
 protected:
  void SetUp() override {
    if (run({"run", "--quiet", "--", "true"}).status == 3) GTEST_SKIP() << "this build has no OpenGL driver";
  }
};

TEST_F(Run, SaysWhatIsWrong) {
  expect_refused({"run"}, "PROGRAM");
  expect_refused({"run", "--", "./none"}, "cannot start './none': No such file");
  expect_refused({"run", "--frames", "3", "--", "true"}, "--frames '3': give A..B");
  expect_refused({"run", "--frames", "3..2", "--", "true"}, "give A..B");
  expect_refused({"run", "--save", "1", "--save-all", "all", "--", "true"}, "give one of the two");
  expect_refused({"run", "-o", "a.hpt", "--", "true"}, "--save N");
  expect_refused({"run", "--save", "1", "-o", "a.png", "--", "true"}, ".hpt");
  expect_refused({"run", "--csv", "-", "--", "true"}, "stdout");
  expect_refused({"run", "--engine", "rtl", "--", "true"}, "--engine");
  expect_refused({"run", "--config", "none", "--", "true"}, "none");
  expect_refused({"run", "--", "true"}, "did not load the driver", 1);
}

/// The program itself sends the signal, so that it runs when it comes: a fixed time is too short on a busy machine.
TEST_F(Run, IsInterruptedWithItsProgram) {
  const Outcome outcome = paste("'" HALFPLANE_PROGRAM "' run -- sh -c 'kill -TERM $PPID; sleep 100'");
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.out.find("interrupted"), std::string::npos) << outcome.out;
}

#ifdef HALFPLANE_EGL_PROGRAM
constexpr const char* kProgram = HALFPLANE_EGL_PROGRAM;

TEST_F(Run, AProgramDrawsAndItsFrameIsSaved) {
  const Arguments arguments{"run",       "--engine", "cycle", "--memory",        "sdram", "--save", "2", "-o",
                            "saved.hpt", "--csv",    "f.csv", "--json=run.json", "--",    kProgram, "4"};
  const Outcome outcome = run(arguments);
  ASSERT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("frames      4 in "), std::string::npos) << outcome.out;
  const Bytes text = read("run.json");
  const Json json = Json::parse(text.begin(), text.end());
  ASSERT_EQ(json["frames"].size(), 4U);
  EXPECT_EQ(json["answered"], Json::array({"EGL"}));
  EXPECT_EQ(json["status"], 0);
  for (const Json& row : json["frames"]) {
    EXPECT_EQ(row["primitives"]["in"], 1);
    EXPECT_GT(row["cycles"], 100) << row["lacks"];
    EXPECT_FALSE(row["goes_on"]);
  }
  EXPECT_EQ(result({"render", "saved.hpt"})["color_hash"], json["frames"][2]["color_hash"]);
  const Json cycle = result({"render", "saved.hpt", "--engine", "cycle", "--memory", "sdram"});
  EXPECT_EQ(cycle["cycles"], json["frames"][2]["cycles"]);
  EXPECT_EQ(cycle["traffic_bytes"], json["frames"][2]["traffic_bytes"]);
  const Bytes csv = read("f.csv");
  EXPECT_EQ(std::ranges::count(csv, std::uint8_t{'\n'}), 5);
}

TEST_F(Run, TheResultIsDescribed) {
  ASSERT_EQ(run({"run", "--engine", "cycle", "--quiet", "--json=a.json", "--", kProgram, "3"}).status, 0);
  ASSERT_EQ(run({"run", "--quiet", "--json=b.json", "--", kProgram, "3"}).status, 0);
  const Outcome outcome =
      paste("python3 '" HALFPLANE_SOURCE_DIR "/tests/cli/check_json.py' --described '" HALFPLANE_SOURCE_DIR
            "/docs/json/halfplane.run.schema.json' a.json b.json");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
}

TEST_F(Run, EndsTheProgramAfterTheLastFrame) {
  const Outcome outcome = run({"run", "--frames", "3..5", "--save-all", "all", "--", kProgram, "1000000000"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("frames      3 in "), std::string::npos) << outcome.out;
  for (const char* name : {"all/frame-0003.hpt", "all/frame-0005.hpt"}) EXPECT_TRUE(exists(name)) << name;
  EXPECT_FALSE(exists("all/frame-0002.hpt"));
}

TEST_F(Run, EndsTheProgramAfterTheLastCaptureIfNothingElseIsAskedFor) {
  const Outcome outcome = run({"run", "--save", "2", "--save", "4", "-o", "a.hpt", "--", kProgram, "1000000000"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* name : {"a-0002.hpt", "a-0004.hpt"}) EXPECT_EQ(run({"render", name, "--quiet"}).status, 0) << name;
  const Outcome whole = run({"run", "--save", "2", "-o", "b.hpt", "--json=b.json", "--", kProgram, "6"});
  EXPECT_NE(whole.out.find("frames      6 in "), std::string::npos) << whole.out;
}

/// Whatever is there after it is a whole capture. The shell waits for frames and for the program's end, not for a time.
TEST_F(Run, AProgramThatIsKilledLeavesWholeCaptures) {
  const Outcome outcome =
      paste("timeout -s KILL 60 '" HALFPLANE_PROGRAM "' run --save-all all -- sh -c '\"" HALFPLANE_EGL_PROGRAM
            "\" 1000000000 & until [ -e all/frame-0003.hpt ]; do sleep 0.01; done; kill -9 $!; wait $!; exit 0'");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const Outcome check =
      paste("set -e; ls all | grep -qv hpt$ && exit 9; n=0; for f in $(ls all | tail -3); do '" HALFPLANE_PROGRAM
            "' render all/$f --quiet; n=1; done; test $n = 1");
  EXPECT_EQ(check.status, 0) << check.out << check.err;
}

TEST_F(Run, AProgramThatFailsIsSaid) {
  const Outcome outcome = run({"run", "--", kProgram, "1", "7"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("ended with status 7"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("1.5"), std::string::npos) << outcome.out;
}

/// A feature that the hardware lacks: an error that names it. This program's colours run over w.
TEST_F(Run, MissingStatesEndTheProgramIfAsked) {
  const Outcome outcome = run({"run", "--on-missing", "stop", "--", kProgram});
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("--on-missing stop"), std::string::npos) << outcome.err;
  EXPECT_EQ(run({"run", "--on-missing", "stop", "--config", "textured", "--", kProgram}).status, 0);
}
#endif

#ifdef HALFPLANE_WINDOW_PROGRAM
/// Windows of an X server: pictures, sizes, a window that is gone. The program's status names the check that does not hold.
TEST_F(Run, WindowsShowWhatIsDrawn) {
  const Outcome outcome = paste(
      "Xvfb -displayfd 1 -screen 0 320x240x24 -nolisten tcp >display.txt 2>xvfb.txt & server=$!\n"
      "trap 'kill $server' EXIT TERM INT\n"
      "while kill -0 $server && ! [ -s display.txt ]; do sleep 0.02; done\n"
      "DISPLAY=:$(cat display.txt) timeout 60 '" HALFPLANE_PROGRAM "' run --quiet -- '" HALFPLANE_WINDOW_PROGRAM "'");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
}
#endif

}  // namespace
}  // namespace halfplane::cli::run_test
