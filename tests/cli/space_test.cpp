// `bench --space`, --area, --slurm, --collect: the design space, its front, its page, and the same from a cluster's tasks.
#include <filesystem>
#include <set>

#include "halfplane_paths.hpp"
#include "program.hpp"

namespace halfplane::cli::space_test {
namespace {

class SpaceCommand : public Cli {
 protected:
  /// A `yosys` that elaborates any package to two modules, one of which knows the depth bits, and counts 10 LUT4 in each:
  /// it leaves a line in calls.txt for every module that it is to synthesise.
  void write_fake_yosys() const {
    std::filesystem::create_directory(folder_ / "bin");
    write("bin/yosys", R"(#!/bin/sh
if [ "$1" = -V ]; then echo 'Yosys 0.0 (git sha1 x)'; exit 0; fi
script=$3
[ ! -e "$(dirname "$0")/broken" ] || { echo 'ERROR: this one is broken'; exit 1; }
netlist=$(printf '%s\n' "$script" | sed -n 's/.*write_rtlil \([^;]*\).*/\1/p')
if [ -n "$netlist" ]; then
  package=$(printf '%s\n' "$script" | sed 's/^read_verilog \(-[^ ]* \)*\([^ ]*\) .*/\2/')
  depth=$(sed -n 's/.* DEPTH_BITS = \([0-9]*\);.*/\1/p' "$package" | head -n 1)
  cat >"$netlist" <<END
module \\cull
  wire width 3 input 1 \\a
  attribute \\src "/somewhere/cull.sv:1.2-3.4"
  cell \$add \$add\$/somewhere/cull.sv:7\$$$
  end
end
module \\raster_top
  wire width $depth input 1 \\z
  cell \\cull \\u_cull
    connect \\a \\z
  end
  cell \\cull \\u_again
    connect \\a \\z
  end
end
END
  exit 0
fi
top=$(printf '%s\n' "$script" | sed -n 's/.*-top \\*\([a-z_0-9]*\).*/\1/p')
echo "$top" >>"$(dirname "$0")/calls.txt"
stat=$(printf '%s\n' "$script" | sed -n 's/.*tee -o \([^ ]*\) stat.*/\1/p')
printf '=== %s ===\n\n     LUT4                           10\n     cull                            2\n' "$top" >"$stat"
)");
    ASSERT_EQ(paste("chmod +x bin/yosys").status, 0);
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    const Bytes bytes = read(name);
    return {bytes.begin(), bytes.end()};
  }
  /// The program with the folder's bin before everything else on the path.
  [[nodiscard]] Outcome with_fake(const std::string& words) const {
    return paste("PATH=\"$PWD/bin:$PATH\" '" HALFPLANE_PROGRAM "' bench " + words);
  }
  [[nodiscard]] std::multiset<std::string> synthesised() const {
    const auto lines = lines_of(text("bin/calls.txt"));
    return {lines.begin(), lines.end()};
  }
};

const Arguments kSpace{"bench",  "teapot:2",          "--size", "64x48",         "--space",
                       "--vary", "subpixel.bits=2,6", "--vary", "stamp.size=1,2"};

Arguments with(Arguments arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST_F(SpaceCommand, PointsHaveTheErrorsOfCompareAndTheCyclesOfTheCycleEngine) {
  const Json json = result(with(kSpace, {"--memory", "sdram", "--mhz", "100"}));
  ASSERT_EQ(json["points"].size(), 4u) << "every combination, and no base beside them";
  EXPECT_TRUE(json["rows"].empty());
  for (const Json& point : json["points"]) {
    Arguments settings{"teapot:2", "--size", "64x48"};
    for (const auto& entry : point["settings"].items())
      settings = with(settings, {"--set", entry.key() + "=" + entry.value().get<std::string>()});
    const Json compared = result(with({"compare"}, settings));
    const Json rendered =
        result(with(with({"render"}, settings), {"--engine", "cycle", "--memory", "sdram", "--mhz", "100"}));
    EXPECT_EQ(point["depth_eye_rms"], compared["depth_eye"]["rms"]);
    EXPECT_EQ(point["depth_lsb_max"], compared["depth_lsb"]["max"]);
    EXPECT_EQ(point["color_lsb_max"], compared["color_lsb"]["max"]);
    EXPECT_EQ(point["cycles"], rendered["cycles"]);
    EXPECT_DOUBLE_EQ(point["ms"].get<double>(), rendered["cycles"].get<double>() / 1e5);
  }
}

TEST_F(SpaceCommand, TheFrontIsWhatNoOtherPointBeats) {
  const Json json = result(with(kSpace, {"--front", "depth_eye_rms,cycles"}));
  std::size_t on_front = 0;
  for (const Json& point : json["points"]) {
    bool is_beaten = false;
    for (const Json& other : json["points"])
      is_beaten =
          is_beaten || (other["cycles"] <= point["cycles"] && other["depth_eye_rms"] <= point["depth_eye_rms"] &&
                        (other["cycles"] < point["cycles"] || other["depth_eye_rms"] < point["depth_eye_rms"]));
    EXPECT_EQ(point["on_front"], !is_beaten) << point;
    on_front += point["on_front"].get<bool>() ? 1 : 0;
  }
  EXPECT_GE(on_front, 1u);
  EXPECT_LT(on_front, 4u) << "a stamp of one pixel is beaten";
}

TEST_F(SpaceCommand, AUnitThatIsLeftOutDoesNotBeatOneThatIsThere) {
  const Json json = result(
      {"bench", "teapot:2", "--size", "64x48", "--space", "--vary", "texture.unit=off,nearest", "--front", "cycles"});
  ASSERT_EQ(json["points"].size(), 2u);
  EXPECT_LE(json["points"][0]["cycles"], json["points"][1]["cycles"]);
  EXPECT_TRUE(json["points"][1]["on_front"]) << "it can do more";
}

TEST_F(SpaceCommand, GatesAreCountedOnceForEveryModuleThatIsTheSame) {
  write_fake_yosys();
  const std::string run_it =
      "triangle --config tiny --size 16x16 --area --parts ecp5 --cache kept --json --quiet --vary ";
  const Outcome first = with_fake(run_it + "depth.bits=8,9");
  ASSERT_EQ(first.status, 0) << first.err;
  const Json json = Json::parse(first.out);
  ASSERT_EQ(json["points"].size(), 2u);
  for (const Json& point : json["points"])
    EXPECT_EQ(point["ecp5"]["places"], 30) << "raster_top once, the module in it twice";
  EXPECT_EQ(synthesised(), (std::multiset<std::string>{"cull", "raster_top", "raster_top"}))
      << "only the module that knows the depth is made again";
  ASSERT_EQ(with_fake(run_it + "depth.bits=8,9,10").status, 0);
  EXPECT_EQ(synthesised().size(), 4u);
  EXPECT_EQ(synthesised().count("cull"), 1u);
}

TEST_F(SpaceCommand, WhatYosysSaysAndThatItIsMissingAreOneLineAndStatus3) {
  std::filesystem::create_directory(folder_ / "bin");
  const Outcome missing = paste("PATH=\"$PWD/bin\" '" HALFPLANE_PROGRAM "' bench triangle --area");
  EXPECT_EQ(missing.status, 3);
  EXPECT_EQ(lines_of(missing.err).size(), 1u) << missing.err;
  EXPECT_NE(missing.err.find("there is no yosys on the PATH"), std::string::npos) << missing.err;
  write_fake_yosys();
  write("bin/broken", "");
  const Outcome broken = with_fake("triangle --config tiny --size 16x16 --area --cache kept");
  EXPECT_EQ(broken.status, 3);
  EXPECT_EQ(lines_of(broken.err).size(), 1u) << broken.err;
  EXPECT_NE(broken.err.find("this one is broken"), std::string::npos) << broken.err;
}

TEST_F(SpaceCommand, TasksOfAClusterGiveTheSamePointsAndGoOnWhereTheyStopped) {
  const Json here = result(kSpace);
  ASSERT_EQ(run(with(kSpace, {"--slurm", "job", "--quiet"})).status, 0);
  EXPECT_EQ(lines_of(text("job/tasks")).size(), 4u);
  EXPECT_NE(text("job/job.sh").find("#SBATCH --array=1-4\n"), std::string::npos);
  EXPECT_EQ(result({"bench", "--collect", "job"})["missing"], 4);
  // One by one, as an array job calls the script; the last is missing.
  for (const char* task : {"1", "2", "3"})
    ASSERT_EQ(paste("SLURM_ARRAY_TASK_ID=" + std::string(task) + " sh job/job.sh").status, 0);
  EXPECT_EQ(result({"bench", "--collect", "job"})["missing"], 1);
  ASSERT_EQ(paste("echo kept >job/points/00001.json; cp job/points/00002.json second; rm job/points/00003.json").status,
            0);
  ASSERT_EQ(paste("cd job && while read -r line; do sh -c \"$line\" || exit 1; done <tasks").status, 0)
      << "as GNU parallel reads them";
  EXPECT_EQ(text("job/points/00001.json"), "kept\n") << "what is there is not made again";
  expect_refused({"bench", "--collect", "job"}, "job/points/00001.json");
  ASSERT_EQ(paste("rm job/points/00001.json; SLURM_ARRAY_TASK_ID=1 sh job/job.sh").status, 0);
  const Json gathered = result({"bench", "--collect", "job"});
  EXPECT_EQ(gathered["missing"], 0);
  EXPECT_EQ(gathered["points"], here["points"]);
  EXPECT_EQ(gathered["front_axes"], here["front_axes"]);
}

TEST_F(SpaceCommand, CsvHasARowForEachPoint) {
  const Outcome outcome = run(with(kSpace, {"--csv", "-"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto lines = lines_of(outcome.out);
  ASSERT_EQ(lines.size(), 5u) << outcome.out;
  EXPECT_EQ(lines[0].rfind("scene,subpixel.bits,stamp.size,width,", 0), 0u) << lines[0];
  EXPECT_EQ(lines[1].rfind("teapot:2,2,1,64,48,", 0), 0u) << lines[1];
}

TEST_F(SpaceCommand, WhatDoesNotGoTogetherIsRefused) {
  expect_refused(with(kSpace, {"--engines", "cycle"}), "leave out --engines");
  expect_refused(with(kSpace, {"--front", "beauty"}), "not every point has a figure 'beauty'; give some of");
  expect_refused(with(kSpace, {"--parts", "virtex"}), "no part 'virtex'");
  expect_refused(with(kSpace, {"--slurm", "a", "--collect", "b"}), "give one of them");
  expect_refused(with(kSpace, {"--slurm", "a", "--json"}), "--collect DIR");
  expect_refused({"bench", "--collect", "."}, "a folder that --slurm has made");
  expect_refused({"bench", "triangle", "--memory", "sdram"}, "for --area and --space");
}

TEST_F(SpaceCommand, ThePageOpensInHeadlessChromium) {
  ASSERT_EQ(run(with(kSpace, {"-o", "p.html", "--quiet"})).status, 0);
  EXPECT_EQ(text("p.html").find("src="), std::string::npos) << "nothing is loaded";
  if (paste("for b in chromium chromium-browser google-chrome; do command -v $b && break; done >browser.txt").status !=
          0 ||
      read("browser.txt").empty())
    GTEST_SKIP() << "no Chromium here";
  const Outcome outcome =
      paste("\"$(cat browser.txt)\" --headless --no-sandbox --disable-gpu --dump-dom \"file://$PWD/p.html\"");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* part : {"4 points, ", "choose-x", "Not beaten in these two", "subpixel.bits=6 stamp.size=2",
                           "cycles a frame", "How to reproduce"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part;
}

}  // namespace
}  // namespace halfplane::cli::space_test
