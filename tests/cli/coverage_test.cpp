// --coverage of cosim, vectors and check; `cover`: merging, text, page, Verilator's file; the options that it names.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "../tier.hpp"
#include "halfplane_paths.hpp"
#include "program.hpp"

namespace halfplane::cli::coverage_test {
namespace {

class Cover : public Cli {
 protected:
  [[nodiscard]] Json read(const std::string& file) const {
    std::ifstream in(folder_ / file);
    return Json::parse(in);
  }
  [[nodiscard]] std::string text(const std::string& file) const {
    std::ifstream in(folder_ / file);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }
  /// The coverage file of `vectors` with these options.
  [[nodiscard]] Json vectors(const std::string& options, const std::string& file = "v.json") const {
    const Outcome outcome =
        paste("'" HALFPLANE_PROGRAM "' vectors --stage cull -o /dev/null --quiet --coverage " + file + " " + options);
    EXPECT_EQ(outcome.status, 0) << options << ": " << outcome.err;
    return read(file);
  }
  [[nodiscard]] static Json bin(const Json& coverage, const std::string& name) {
    for (const Json& one : coverage["bins"])
      if (one["name"] == name) return one;
    return {};
  }
};

TEST_F(Cover, RunsAreMergedBinByBin) {
  const Json first = vectors("--random 200 --seed 1", "a.json"), second = vectors("--random 200 --seed 2", "b.json");
  const Json both = result({"cover", "a.json", "b.json", "-o", "all.json"});
  ASSERT_EQ(both["bins"].size(), first["bins"].size());
  for (std::size_t n = 0; n < first["bins"].size(); ++n)
    EXPECT_EQ(both["bins"][n]["hits"].get<int>(),
              first["bins"][n]["hits"].get<int>() + second["bins"][n]["hits"].get<int>());
  EXPECT_EQ(both["runs"].size(), 2U);
  EXPECT_EQ(read("all.json")["totals"], both["totals"]);
  EXPECT_GT(both["totals"]["hit"], 60);
}

TEST_F(Cover, ANewRunOfTheSameSeedHasTheSameHits) {
  EXPECT_EQ(vectors("--random 200 --config tiny", "a.json")["bins"],
            vectors("--random 200 --config tiny", "b.json")["bins"]);
}

TEST_F(Cover, StrictFailsWhileThereIsAHole) {
  (void)vectors("triangle --size 16x16", "a.json");
  EXPECT_EQ(run({"cover", "a.json", "--quiet"}).status, 0);
  EXPECT_EQ(run({"cover", "a.json", "--quiet", "--strict"}).status, 1);
}

TEST_F(Cover, CheckSeesThePortsOfItsStage) {
  ASSERT_EQ(run({"vectors", "--random", "200", "--stage", "coarse_raster", "-o", "v.jsonl"}).status, 0);
  ASSERT_EQ(run({"check", "--stage", "coarse_raster", "v.jsonl", "--coverage", "c.json"}).status, 0);
  const Json stage = read("c.json"), whole = vectors("--random 200");
  for (const char* name : {"tile.accepted", "tile.cut", "tile.saturated", "walk.left", "hiz.update.set"}) {
    EXPECT_EQ(bin(stage, name)["hits"], bin(whole, name)["hits"]) << name;
    EXPECT_GT(bin(stage, name)["hits"], 0) << name;
  }
  EXPECT_EQ(bin(stage, "tie.top")["excluded"], "not at the ports of coarse_raster");
  EXPECT_EQ(bin(stage, "depth.equal.less")["excluded"], "not at the ports of coarse_raster");
  EXPECT_EQ(bin(whole, "flow.held.tile")["excluded"], "needs cosim: the model alone has no cycles");
}

TEST_F(Cover, CosimSeesTheSameStimulusAndTheStreamsOfTheRtl) {
  const Outcome outcome = run({"cosim", "triangle", "--config", "tiny", "--size", "16x16", "--stalls", "0.4",
                               "--coverage", "c.json", "--json=r.json"});
  if (outcome.status == 3) GTEST_SKIP() << "no RTL in this build";
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("coverage    "), std::string::npos) << outcome.out;
  const Json coverage = read("c.json"), model = vectors("triangle --config tiny --size 16x16");
  for (const Json& one : model["bins"])
    if (one["excluded"].is_null()) {
      EXPECT_EQ(bin(coverage, one["name"])["hits"], one["hits"]) << one["name"];
    }
  EXPECT_GT(bin(coverage, "flow.held.stamp")["hits"], 0);
  EXPECT_EQ(read("r.json")["coverage"], coverage["totals"]);
}

TEST_F(Cover, VerilatorReadsWhatIsWrittenForIt) {
  const Json coverage = vectors("--random 100 --config tiny", "a.json");
  ASSERT_EQ(run({"cover", "a.json", "-o", "a.dat", "--quiet"}).status, 0);
  const auto lines = lines_of(text("a.dat.txt"));
  ASSERT_EQ(lines.size() + 1, lines_of(text("a.dat")).size());
  if (paste("command -v verilator_coverage >tool.txt").status != 0) GTEST_SKIP() << "no verilator_coverage here";
  ASSERT_EQ(paste("verilator_coverage --write-info a.info a.dat").status, 0);
  std::map<std::string, std::uint64_t> counts;  // by name, out of lcov's DA:LINE,COUNT
  for (const std::string& line : lines_of(text("a.info")))
    if (line.starts_with("DA:"))
      counts[lines.at(std::stoul(line.substr(3)) - 1)] = std::stoull(line.substr(line.find(',') + 1));
  std::size_t compared = 0;
  for (const Json& one : coverage["bins"]) {
    if (!one["excluded"].is_null()) continue;
    EXPECT_EQ(counts.at(one["name"]), one["hits"]) << one["name"];
    ++compared;
  }
  EXPECT_GT(compared, 80U);
}

/// In a small stand-in for a browser, if Node.js is installed.
TEST_F(Cover, ThePageNamesHolesAndTheOptionsThatHitThemInNodeJs) {
  const Json coverage = vectors("triangle --size 16x16", "a.json");
  ASSERT_EQ(run({"cover", "a.json", "-o", "a.html", "--quiet"}).status, 0);
  if (paste("command -v node >node.txt").status != 0) GTEST_SKIP() << "no Node.js here";
  const Outcome outcome = paste("node '" HALFPLANE_SOURCE_DIR "/tests/cli/explain_page.js' a.html");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string page = Json::parse(outcome.out)["main"];
  std::size_t holes = 0;
  for (const Json& one : coverage["bins"]) {
    EXPECT_NE(page.find(one["name"].get<std::string>()), std::string::npos) << one["name"];
    if (one["hits"] != 0 || !one["excluded"].is_null()) continue;
    EXPECT_NE(page.find(one["hit_by"].get<std::string>()), std::string::npos) << one["name"];
    ++holes;
  }
  EXPECT_GT(holes, 20U);
}

// Each bin's options hit it: every day one bin of each family whose options are quick, in all tests all of them.
TEST_F(Cover, OptionsBesideABinHitIt) {
  const Json coverage = vectors("triangle --size 16x16 --config stencilled");
  std::map<std::string, std::set<std::string>> bins;  // by options
  std::set<std::string> families;
  for (const Json& one : coverage["bins"]) {
    const std::string options = one["hit_by"], name = one["name"];
    if (!one["excluded"].is_null()) continue;
    const bool is_quick =
        options.find("--random 20000") == std::string::npos && families.insert(name.substr(0, name.rfind('.'))).second;
    if (is_quick || test::runs_all()) bins[options].insert(name);
  }
  EXPECT_GT(bins.size(), 5U);
  for (const auto& [options, names] : bins) {
    const Json hit = vectors(options + " --config stencilled", "hit.json");
    for (const std::string& name : names) EXPECT_GT(bin(hit, name)["hits"], 0) << name << ": " << options;
  }
}

TEST_F(Cover, WhatIsNoCoverageIsRefused) {
  write("bad.json", "{\"schema\": \"halfplane.render/1\"}");
  write("worse.json", "{\"schema\": \"halfplane.coverage/1\", \"runs\": []}");
  (void)vectors("triangle --size 16x16", "a.json");
  expect_refused({"cover", "none.json"}, "cannot read file 'none.json'");
  expect_refused({"cover", "bad.json"}, "bad.json: its schema is \"halfplane.render/1\"");
  expect_refused({"cover", "worse.json"}, "worse.json: not a coverage file");
  expect_refused({"cover", "a.json", "-o", "a.csv"}, "is none of .json, .html, .dat");
  expect_refused({"vectors", "triangle", "--stage", "cull", "-o", "v", "--coverage", "c.txt"}, ".json");
}

}  // namespace
}  // namespace halfplane::cli::coverage_test
