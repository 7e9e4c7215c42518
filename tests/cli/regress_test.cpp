// `halfplane regress`: cases, what ends them, what is kept, and what is said of them.
#include <csignal>
#include <filesystem>
#include <fstream>

#include "halfplane_paths.hpp"
#include "program.hpp"

namespace halfplane::cli::regress_test {
namespace {

namespace fs = std::filesystem;

class Regress : public Cli {
 protected:
  void SetUp() override { skip_without_rtl(); }

  [[nodiscard]] std::string text(const std::string& name) const {
    const Bytes bytes = read(name);
    return {bytes.begin(), bytes.end()};
  }
  /// The result of a regression that ends with `status`.
  [[nodiscard]] Json regress(const std::string& words, int status) const {
    Arguments arguments = split_words("regress " + words);
    arguments.insert(arguments.end(), {"--quiet", "--json=r.json"});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    return Json::parse(text("r.json"));
  }
  /// The results that are in the folder.
  [[nodiscard]] std::vector<fs::path> kept(const std::string& folder) const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder_ / folder / "cases")) files.push_back(entry.path());
    return files;
  }
};

TEST_F(Regress, CasesAreScenesByConfigurationsByStallsBySeeds) {
  write("t.hpt", "halfplane 1\ntarget 8 8\nspace window\nv 1 1 .5\nv 7 1 .5\nv 1 7 .5\nt 0 1 2\n");
  write("p.toml",
        "[random]\nconfig = \"tiny|embedded\"\nrandom = 30\nonly = \"triangles,8x8\"\nseeds = \"1..2|7\"\n"
        "stalls = \"0|0.3\"\n[scene]\nconfig = \"tiny\"\nscenes = \"t.hpt|triangle:1\"\noptions = \"--size 16x16\"\n");
  write("q.toml", "[scene]\nconfig = \"tiny\"\nscenes = \"t.hpt\"\n");
  const Json result = regress("p.toml -j 2 --junit r.xml", 125);
  EXPECT_EQ(result["planned"], 14);
  EXPECT_EQ(result["ran"], 14);
  EXPECT_EQ(result["passed"], 12) << result.dump(1);
  EXPECT_EQ(result["skipped"], 2) << "--size is not for captures, and there is no triangle:1";
  EXPECT_EQ(result["primitives"]["ran"], 12 * 30);
  EXPECT_GT(result["triangles"], 100) << "some are outside";
  const std::string xml = text("r.xml");
  for (const char* part :
       {"name=\"random: tiny, random 30, stalls 0.3, seed 7\"", "property name=\"seed\" value=\"7\"",
        "property name=\"commit\"", "--random-only triangles,8x8 --config tiny --stalls 0.3 --seed 7",
        "tests=\"14\" failures=\"0\"", "skipped=\"2\""})
    EXPECT_NE(xml.find(part), std::string::npos) << part << "\n" << xml;
  EXPECT_EQ(result["cases"][0]["seed"], 1);
  EXPECT_EQ(paste(result["cases"][0]["repeat"].get<std::string>()).status, 0);
  EXPECT_EQ(regress("q.toml", 0)["passed"], 1);
}

TEST_F(Regress, AKillLosesTheRunningCasesAlone) {
  write("p.toml", "[r]\nconfig = \"tiny\"\nrandom = 2000\nonly = \"triangles\"\nseeds = \"1..12\"\n");
  const Outcome killed = paste("'" HALFPLANE_PROGRAM
                               "' regress p.toml -j 2 -o out & pid=$!\n"
                               "for i in $(seq 6000); do [ -e out/cases/00003.json ] || sleep 0.01; done\n"
                               "kill -9 $pid; wait $pid");
  ASSERT_EQ(killed.status, 128 + SIGKILL) << killed.err;
  std::vector<std::pair<fs::path, fs::file_time_type>> before;
  for (const fs::path& file : kept("out"))
    if (file.extension() == ".json") before.emplace_back(file, fs::last_write_time(file));
  EXPECT_GE(before.size(), 2U) << "the cases that were running are lost, and no other";
  EXPECT_LT(before.size(), 12U);
  for (const auto& [file, time] : before) {
    std::ifstream in(file);
    EXPECT_EQ(Json::parse(in, nullptr, false).value("outcome", ""), "passed") << file << " is a whole result";
  }
  EXPECT_EQ(regress("p.toml -o out --report", 0)["ran"], before.size());
  EXPECT_EQ(run({"regress", "p.toml", "-o", "out"}).status, 125) << "nothing is thrown away";
  const Json result = regress("p.toml -j 2 -o out --resume", 0);
  EXPECT_EQ(result["passed"], 12);
  for (const auto& [file, time] : before) EXPECT_EQ(fs::last_write_time(file), time) << "run once: " << file;
}

TEST_F(Regress, TwoRunsInOneFolderAreRefused) {
  write("p.toml", "[r]\nconfig = \"tiny\"\nrandom = 500000\nonly = \"triangles\"\n");
  const Outcome second = paste("'" HALFPLANE_PROGRAM
                               "' regress p.toml --quiet -o out & pid=$!\n"
                               "for i in $(seq 6000); do [ -e out/plan.json ] || sleep 0.01; done\n"
                               "'" HALFPLANE_PROGRAM
                               "' regress p.toml --quiet -o out --resume; status=$?\n"
                               "'" HALFPLANE_PROGRAM
                               "' regress p.toml --quiet -o out --report\n"
                               "kill -9 $pid; wait $pid; exit $status");
  EXPECT_EQ(second.status, 125);
  EXPECT_NE(second.err.find("another regress is running in it"), std::string::npos) << second.err;
  EXPECT_EQ(regress("p.toml -o out --resume --until 0s", 125)["ran"], 0) << "the lock ended with its process";
}

TEST_F(Regress, UntilBeginsNoCaseAndResumeGoesOnOfTheSamePlanAlone) {
  write("p.toml", "[r]\nconfig = \"tiny\"\nrandom = 20\nseeds = \"1..4\"\n");
  EXPECT_EQ(regress("p.toml --until 0s", 125)["ran"], 0);
  EXPECT_EQ(regress("p.toml --resume --until 1h", 0)["ran"], 4);
  const auto time = fs::last_write_time(kept("out/regress-p").front());
  EXPECT_EQ(regress("p.toml --resume", 0)["ran"], 4);
  EXPECT_EQ(fs::last_write_time(kept("out/regress-p").front()), time);
  write("p.toml", "[r]\nconfig = \"tiny\"\nrandom = 20\nseeds = \"1..3\"\n");
  EXPECT_EQ(regress("p.toml --resume --until 0s", 125)["ran"], 0) << "results of another plan";
}

TEST_F(Regress, AFaultIsFoundAgainAndHasItsCaptureAndCommand) {
  write("p.toml", "[good]\nconfig = \"tiny\"\nrandom = 20\n[bad]\nrandom = 60\noptions = \"--mutant 3\"\n");
  const Json result = regress("p.toml --junit r.xml", 1);
  EXPECT_EQ(result["passed"], 1);
  ASSERT_EQ(result["failed"], 1);
  const Json& bad = result["cases"][1];
  EXPECT_EQ(bad["outcome"], "failed");
  EXPECT_EQ(bad["runs"], 2);
  EXPECT_EQ(bad["mismatch"]["stage"], "cull");
  EXPECT_TRUE(fs::exists(bad["capture"].get<std::string>()));
  EXPECT_EQ(paste(bad["repeat"].get<std::string>()).status, 1);
  EXPECT_NE(text("r.xml").find("<failure message=\"failed: mismatch of kind differs in cull"), std::string::npos);
}

TEST_F(Regress, ACaseThatFailsOnceIsFlaky) {
  const std::string head = "halfplane 1\ntarget 32 32\nspace window\n";
  ASSERT_EQ(run(split_words("convert --random 50 --seed 1 -o bad.hpt")).status, 0);
  write("good.hpt", head + "v 5.5 5.5 .5\np 0\n");
  write("p.toml", "[r]\nscenes = \"t.hpt\"\noptions = \"--mutant 3\"\n");
  // The scene is a pipe: each run reads another one.
  const Outcome outcome = paste("mkfifo t.hpt; '" HALFPLANE_PROGRAM
                                "' regress p.toml -o out --quiet --json=r.json & pid=$!\n"
                                "timeout 60 sh -c 'cat bad.hpt >t.hpt'\n"
                                "for i in $(seq 2000); do [ -e out/work/00001.hpt ] || sleep 0.01; done\n"
                                "timeout 60 sh -c 'cat good.hpt >t.hpt'; wait $pid");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  const Json result = Json::parse(text("r.json"));
  EXPECT_EQ(result["flaky"], 1) << result.dump(1);
  EXPECT_EQ(result["flaky_cases"].size(), 1U);
  EXPECT_EQ(result["cases"][0]["mismatch"]["stage"], "cull") << "the failure is kept";
}

TEST_F(Regress, ACaseThatTakesTooLongEnds) {
  write("p.toml", "[r]\nconfig = \"tiny\"\nrandom = 100000000\ntimeout = \"0.2s\"\n");
  const Json result = regress("p.toml", 1);
  EXPECT_EQ(result["timeout"], 1);
  EXPECT_EQ(result["cases"][0]["runs"], 1);
}

TEST_F(Regress, TasksOfAnArrayAreTheSameCases) {
  write("p.toml", "[r]\nconfig = \"tiny\"\nrandom = 20\nseeds = \"1..2\"\n");
  ASSERT_EQ(run({"regress", "p.toml", "--slurm", "-o", "job"}).status, 0);
  EXPECT_TRUE(exists("job/job.sh"));
  EXPECT_EQ(paste("cd job && sed -n 2p tasks | sh").status, 0);
  EXPECT_EQ(kept("job"), std::vector<fs::path>{folder_ / "job/cases/00002.json"});
  EXPECT_EQ(paste("cd job && sh tasks").status, 0);
  EXPECT_EQ(regress("p.toml -o job --report", 0)["passed"], 2);
}

TEST_F(Regress, APlanThatCannotBeRunIsNeitherGoodNorBad) {
  const auto refused = [this](const std::string& plan, const std::string& part) {
    write("p.toml", plan);
    expect_refused({"regress", "p.toml"}, part, 125);
  };
  expect_refused({"regress", "none.toml"}, "cannot read file 'none.toml'", 125);
  refused("config = \"tiny\"\n", "p.toml:1: 'config' stands in no row");
  refused("[r]\nconfig = \"tiny\"\n", "has nothing to run");
  refused("[r]\nrandon = 5\n", "p.toml:2: no key 'randon'; did you mean random?");
  refused("[r]\nrandom = 5\nseeds = \"9..1\"\n", "give FIRST..LAST");
  refused("[r]\nrandom = 5\ntimeout = \"9\"\n", "90s, 30m or 8h");
  refused("[r]\nscenes = \"triangle\"\nonly = \"less\"\n", "give random");
  refused("", "no rows");
  write("p.toml", "[r]\nrandom = 5\n");
  expect_refused({"regress", "p.toml", "--until", "soon"}, "--until: 'soon' is no time", 125);
}

}  // namespace
}  // namespace halfplane::cli::regress_test
