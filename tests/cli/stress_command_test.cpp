// `halfplane stress`: its output, files and refusals; and the whole quick set.

#include "program.hpp"

namespace halfplane::cli::stress_command_test {
namespace {

class CliStress : public Cli {};

TEST_F(CliStress, ResultHasEveryKeyOfTheContractAndTheWorstAsCapturesThatReadBack) {
  const Json json = result({"stress", "--case", "fans,adversarial_depth", "--config", "tiny", "--seconds", "1",
                            "--seed", "5", "--captures", "worst", "--junit", "stress.xml"});
  EXPECT_EQ(json["schema"], "halfplane.stress/1");
  EXPECT_EQ(json["seed"], 5);
  EXPECT_EQ(json["failures"], 0);
  EXPECT_EQ(json["config"]["preset"], "tiny");
  EXPECT_TRUE(json["wall_s"].is_number());
  ASSERT_EQ(json["cases"].size(), 2U);
  for (const Json& row : json["cases"]) {
    for (const char* key : {"name", "configs", "triangles", "checks", "failures", "worst"})
      EXPECT_TRUE(row.contains(key)) << key;
    EXPECT_EQ(row["configs"], 1);
    EXPECT_GT(row["checks"], 1000);
    const Json& depth = row["worst"]["depth"];
    EXPECT_LE(depth["value"], depth["bound"]);
    const std::string capture = depth["capture"];
    ASSERT_TRUE(exists(capture));
    // Another command confirms the search's findings.
    const Json compared = result({"compare", capture, "--config", "tiny"});
    EXPECT_EQ(compared["coverage"]["oracle_mismatches"], 0);
    EXPECT_NEAR(depth["measured"].get<double>(), depth["value"].get<double>(), 0.01 * depth["value"].get<double>());
  }
  const Bytes xml = read("stress.xml");
  EXPECT_NE(std::string(xml.begin(), xml.end()).find("failures=\"0\""), std::string::npos);
}

TEST_F(CliStress, TheCommandThatRepeatsAUnitFindsTheSameWorst) {
  const Json json = result({"stress", "--case", "adversarial_depth", "--config", "tiny", "--seconds", "0.5"});
  const Json& worst = json["cases"][0]["worst"]["depth"];
  Arguments words = split_words(worst["repeat"].get<std::string>());
  words.erase(words.begin());
  EXPECT_EQ(result(words)["cases"][0]["worst"]["depth"]["value"], worst["value"]);
}

TEST_F(CliStress, TheCommandThatRepeatsAUnitCanBePasted) {
  write("my set's.toml", "preset = \"tiny\"\n[depth]\nbits = 12\n");
  const Json json = result({"stress", "--case", "fans", "--config", "my set's.toml", "--seconds", "0.3"});
  const Json& worst = json["cases"][0]["worst"]["depth"];
  const Outcome again = paste(worst["repeat"].get<std::string>() + " --quiet --json");
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(Json::parse(again.out)["cases"][0]["worst"]["depth"]["value"], worst["value"]);
}

TEST_F(CliStress, TheBiasOfAllUnitsIsRepeatedByAllUnits) {
  const Json json = result({"stress", "--case", "mean_bias", "--config", "tiny", "--seconds", "2"});
  ASSERT_TRUE(json["cases"][0]["worst"].contains("bias")) << json.dump(1);
  const std::string repeat = json["cases"][0]["worst"]["bias"]["repeat"];
  EXPECT_EQ(repeat.find("--unit"), std::string::npos) << repeat;
  EXPECT_NE(repeat.find("--seconds 2"), std::string::npos) << repeat;
}

TEST_F(CliStress, TableSaysWhatWasComparedWithWhichSeed) {
  const Outcome outcome = run({"stress", "--case", "zero_area", "--config", "tiny", "--seconds", "0.2", "--seed", "9"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  for (const char* part : {"zero_area", "checks", "seed 9", "every bound holds"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << '\n' << outcome.out;
  EXPECT_TRUE(listing().empty());
}

TEST_F(CliStress, ListNamesEveryCaseWithItsProperty) {
  const auto lines = lines_of(run({"stress", "--list"}).out);
  EXPECT_GT(lines.size(), 30U);
  for (const std::string& line : lines) EXPECT_GT(line.size(), 35U) << line;
}

TEST_F(CliStress, ListAsJsonHasNameItemAndPropertyOfEveryCase) {
  const auto lines = lines_of(run({"stress", "--list"}).out);
  const Json json = result({"stress", "--list"});
  EXPECT_EQ(json["schema"], "halfplane.stress.list/1");
  ASSERT_EQ(json["cases"].size(), lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (const char* key : {"name", "item", "property"})
      EXPECT_NE(lines[i].find(json["cases"][i][key].get<std::string>()), std::string::npos) << key << ": " << lines[i];
}

TEST_F(CliStress, WrongUsageIsRefusedInOneLine) {
  expect_refused({"stress", "--case", "fan"}, "no case 'fan'");
  expect_refused({"stress", "--quick", "--seconds", "3"}, "leave one of them out");
  expect_refused({"stress", "--seconds", "0"}, "--seconds");
  expect_refused({"stress", "--seconds", "nan"}, "--seconds");
  expect_refused({"stress", "--unit", "-1"}, "--unit");
  expect_refused({"stress", "--config", "tiny", "--set", "depth.bits=99"}, "depth.bits");
  expect_refused({"stress", "--captures", "/dev/null/x"}, "cannot make the folder");
  expect_refused({"stress", "--unit", "3"}, "add the --case");
  expect_refused({"stress", "--case", "fans", "--unit", "3", "--seconds", "1"}, "leave out --quick and --seconds");
  expect_refused({"stress", "--set", "depth.format=f16"}, "leave depth.format and depth.mapping as they are");
  expect_refused({"stress", "--junit", "nowhere/x.xml"}, "no such folder");
}

/// The quick set, as a suite of its own that counts as slow.
class StressQuickSet : public Cli {};

TEST_F(StressQuickSet, HoldsEveryBoundOverTheWholeGrid) {
  const Json json = result({"stress", "--threads", "2"});
  EXPECT_EQ(json["failures"], 0) << json.dump(1);
  EXPECT_GE(json["samples"], 10'000'000);
  EXPECT_GE(json["cases"].size(), 40U);
  for (const char* name : {"tiny", "embedded", "full"}) {
    EXPECT_LE(json["preset_depth"][name], 0.75) << name;
    EXPECT_GT(json["preset_depth"][name], 0.5) << name;
  }
  for (const Json& row : json["cases"]) {
    EXPECT_GT(row["checks"], 0) << row["name"];
    if (row["name"] != "mean_bias") continue;
    EXPECT_GE(row["bias"]["judged"], row["bias"]["configs"].get<int>() * 8 / 10);
  }
}

}  // namespace
}  // namespace halfplane::cli::stress_command_test
