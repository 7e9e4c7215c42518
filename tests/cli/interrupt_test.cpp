// Long work that a signal ends: the files written by then, and the program's message.
#include <algorithm>
#include <csignal>

#include "program.hpp"

namespace halfplane::cli::interrupt_test {
namespace {

class CliInterrupt : public Cli {
 protected:
  [[nodiscard]] std::string text(const std::string& name) const {
    const Bytes bytes = read(name);
    return {bytes.begin(), bytes.end()};
  }

  /// Sends `signal` to work that would take minutes at least. Expects the files, each of them complete, and the result
  /// in result.json, which is returned.
  [[nodiscard]] Json partial_result(Arguments arguments, std::vector<std::string> files, int signal = SIGINT) const {
    arguments.push_back("--json=result.json");
    files.push_back("result.json");
    const Outcome outcome = interrupt(arguments, signal);
    EXPECT_EQ(outcome.status, 130) << outcome.err;
    EXPECT_NE(outcome.out.find("interrupted: this result is partial"), std::string::npos) << outcome.out;
    std::sort(files.begin(), files.end());
    EXPECT_EQ(listing(), files);
    Json json = Json::parse(text("result.json"), nullptr, false);
    EXPECT_EQ(json.value("partial", false), true) << json.dump(1);
    return json;
  }
};

/// Interrupts of commands that run the RTL.
class RtlInterrupt : public CliInterrupt {
 protected:
  void SetUp() override { skip_without_rtl(); }
};

TEST_F(CliInterrupt, StressReportsTheUnitsSoFar) {
  const Json json = partial_result({"stress", "--case", "fans,zero_area", "--seconds", "3600", "--threads", "2",
                                    "--junit", "stress.xml", "--captures", "worst"},
                                   {"stress.xml", "worst"});
  ASSERT_EQ(json["cases"].size(), 2U);
  EXPECT_GT(json["checks"], 0);
  EXPECT_EQ(json["failures"], 0) << json.dump(1);
  EXPECT_NE(text("stress.xml").find("<property name=\"partial\" value=\"true\"/>"), std::string::npos);
}

TEST_F(CliInterrupt, StressLeavesALongUnitAndCallsWhatWasNotReachedSkipped) {
  const Json json = partial_result(
      {"stress", "--case", "delaunay_large,wires", "--seconds", "3600", "--junit", "s.xml"}, {"s.xml"}, SIGTERM);
  EXPECT_EQ(json["cases"][1]["units"], 0);
  EXPECT_EQ(json["failures"], 0) << json.dump(1);
  EXPECT_NE(text("s.xml").find("<skipped message"), std::string::npos);
}

TEST_F(CliInterrupt, BenchReportsTheRowsThatWereMeasured) {
  const Json json = partial_result(
      {"bench", "triangle", "--size", "32x32", "--repeat", "1000", "--engines", "golden,scalar", "--no-errors"}, {});
  for (const Json& row : json["rows"]) {
    EXPECT_GT(row["frames"], 0);
    EXPECT_LT(row["frames"], 1000);
    EXPECT_GT(row["frame_s"], 0);
  }
}

TEST_F(CliInterrupt, BenchLeavesOutSkipsAndGrowthThatItDidNotReach) {
  const Json json = partial_result({"bench", "--growth", "--repeat", "1000"}, {});
  EXPECT_TRUE(json["rows"].empty());
  EXPECT_LT(json.value("growth", Json::array()).size(), 60U);
}

TEST_F(CliInterrupt, DepthKeepsItsTheoryAndMarksTheTable) {
  const Json json =
      partial_result({"depth", "--scene", "city", "--size", "1920x1080", "--format", "u16,u20,u24", "--mapping",
                      "std,rev,w,log", "--threads", "2", "--sweep", "--csv", "depth.csv", "-o", "depth.html"},
                     {"depth.csv", "depth.html"});
  EXPECT_TRUE(json["sweeps"].empty());
  EXPECT_NE(text("depth.csv").find(",partial,1\n"), std::string::npos);
  EXPECT_NE(text("depth.html").find("\"partial\":true"), std::string::npos);
}

TEST_F(CliInterrupt, WidthsReportWhatWasSeen) {
  const Json json = partial_result({"widths", "--config", "tiny", "--samples", "100000000"}, {});
  EXPECT_GT(json["probes"], 0);
  EXPECT_LT(json["probes"], 100000000);
  EXPECT_GT(json["widths"].size(), 20U);
}

TEST_F(CliInterrupt, TheSearchForTheSmallestWidthsReportsTheBestSoFar) {
  const Json json = partial_result({"widths", "--smallest", "--scene", "city,teapot,knot", "--size", "640x480",
                                    "--depth-error", "0.7lsb", "--coverage-error", "1000"},
                                   {});
  EXPECT_TRUE(json["one_less"].empty());
  EXPECT_EQ(json["smallest"].is_null(), json["trials"] == 0);
}

TEST_F(CliInterrupt, RenderReportsTheRepetitionsSoFar) {
  const Json json = partial_result({"render", "teapot", "--size", "640x480", "--repeat", "100000", "-o", "teapot.png"},
                                   {"teapot.png"});
  EXPECT_TRUE(json["frame_s"].is_null() || json["frame_s"]["frames"] < 100000);
}

TEST_F(CliInterrupt, WhatIsWholeOrNothingEndsWithoutAFile) {
  const Outcome outcome = interrupt(
      {"compare", "city", "--config", "full", "--size", "1920x1080", "-o", "city.png", "--json=city.json"}, SIGTERM);
  EXPECT_EQ(outcome.status, 130);
  EXPECT_EQ(lines_of(outcome.err).back(),
            "halfplane: interrupted: this command has no partial result, so nothing was written");
  EXPECT_TRUE(listing().empty());
}

TEST_F(CliInterrupt, ExplanationsAndVectorsAreWholeOrNothing) {
  for (const Arguments& words :
       {Arguments{"explain", "city:65536", "640", "360", "--size", "1280x720", "-o", "p.html", "--json=p.json"},
        Arguments{"vectors", "--random", "1000000", "--stage", "cull", "-o", "v.jsonl", "--json=v.json"}}) {
    const Outcome outcome = interrupt(words, SIGINT);
    EXPECT_EQ(outcome.status, 130) << words[0];
    EXPECT_EQ(lines_of(outcome.err).back(),
              "halfplane: interrupted: this command has no partial result, so nothing was written");
    EXPECT_TRUE(listing().empty());
  }
}

TEST_F(CliInterrupt, ASecondSignalEndsItAtOnce) {
  const Outcome outcome =
      interrupt({"stress", "--case", "fans", "--seconds", "3600", "--json=result.json"}, SIGINT, 0.2);
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_LT(outcome.ended_after, 5);
  for (const std::string& name : listing()) EXPECT_EQ(name, "result.json");
}

TEST_F(CliInterrupt, ALogGetsALineOfProgressWithRateAndTimeLeft) {
  Surroundings log;
  log.progress_s = 0.1;
  const Outcome outcome = run({"stress", "--case", "fans", "--seconds", "1"}, log);
  EXPECT_EQ(outcome.status, 0);
  const auto lines = lines_of(outcome.err);
  ASSERT_GE(lines.size(), 2U) << outcome.err;
  for (const std::string& line : lines) {
    EXPECT_TRUE(line.starts_with("stress ")) << line;
    EXPECT_NE(line.find("checks a second"), std::string::npos) << line;
    EXPECT_EQ(line.find_first_of("\r\033"), std::string::npos) << line;
  }
  EXPECT_NE(lines.back().find(" left"), std::string::npos) << lines.back();
  EXPECT_EQ(run({"stress", "--case", "fans", "--seconds", "0.5", "--quiet"}, log).err, "");
}

TEST_F(RtlInterrupt, CosimReportsWhatWasEqualSoFar) {
  const Json json =
      partial_result({"cosim", "--random", "1000000000", "--stalls", "0.2", "--junit", "cosim.xml"}, {"cosim.xml"});
  EXPECT_GT(json["packets"]["cull"], 0) << json.dump(1);
  EXPECT_EQ(json["mismatches"], 0);
  EXPECT_TRUE(json["cycles"]["model"].is_null());
  EXPECT_NE(text("cosim.xml").find("<property name=\"partial\" value=\"true\"/>"), std::string::npos);
  EXPECT_EQ(text("cosim.xml").find("<failure"), std::string::npos);
}

TEST_F(RtlInterrupt, ReduceWritesTheBestSoFarOrSaysThatThereIsNothing) {
  // A million triangles: the first run alone takes seconds, and each step with many of them as long.
  const Outcome outcome = interrupt(
      {"reduce", "dust", "--size", "640x480", "--mutant", "5", "-o", "small.hpt", "--json=small.json"}, SIGINT);
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_EQ(exists("small.hpt"), exists("small.json"));
  if (!exists("small.json")) return;
  const Json json = Json::parse(text("small.json"), nullptr, false);
  EXPECT_EQ(json["partial"], true);
  EXPECT_EQ(json["capture"], "small.hpt");
}

TEST_F(RtlInterrupt, MutantsKeepTheirVerdicts) {
  const Json json = partial_result({"mutants", "--random", "1000000"}, {});
  for (const Json& row : json["mutants"]) EXPECT_EQ(row["caught"], true);
}

}  // namespace
}  // namespace halfplane::cli::interrupt_test
