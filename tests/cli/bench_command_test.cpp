// `bench`: its measurements, output, files and refusals. Times are never compared.
#include <map>
#include <set>

#include "program.hpp"

namespace halfplane::cli::bench_command_test {
namespace {

class BenchCommandLine : public Cli {};

const Arguments kTiny{"bench", "triangle", "--size", "64x48", "--repeat", "1"};

Arguments with(Arguments arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST_F(BenchCommandLine, RowsHaveTheContractsKeysForEveryEngine) {
  const Json json = result(with(kTiny, {"--engines", "golden,scalar,functional,cycle", "--threads", "1,2"}));
  EXPECT_EQ(json["schema"], "halfplane.bench/1");
  EXPECT_EQ(json["seed"], 1);
  std::multiset<std::string> engines;
  for (const Json& row : json["rows"]) {
    engines.insert(row["engine"]);
    for (const char* key : {"engine", "config", "scene", "frame_s", "mtri_s", "mpix_s", "cycles", "depth_lsb_max",
                            "depth_lsb_rms", "color_lsb_max", "coverage_mismatches", "threads", "frames", "frame_s_min",
                            "cycles_per_s", "coverage", "label"})
      EXPECT_TRUE(row.contains(key)) << key;
    EXPECT_GT(row["frame_s"], 0.0);
    EXPECT_EQ(row["frames"], 1);
    EXPECT_EQ(row["cycles"].is_null(), row["engine"] != "cycle");
    EXPECT_EQ(row["fragments"], json["rows"][0]["fragments"]) << "the same work for every engine";
  }
  EXPECT_EQ(engines, (std::multiset<std::string>{"cycle", "cycle", "functional", "functional", "golden", "scalar"}))
      << "threads are for those that have them";
}

TEST_F(BenchCommandLine, ErrorsAreThoseOfCompareForEachConfiguration) {
  const Json bench = result({"bench", "knot", "--size", "64x48", "--repeat", "1", "--engines",
                             "golden,functional,scalar", "--vary", "subpixel.bits=2,8"});
  ASSERT_EQ(bench["rows"].size(), 9u);
  std::map<std::string, Json> compared;
  for (const char* bits : {"2", "8"})
    compared[std::string("subpixel.bits=") + bits] =
        result({"compare", "knot", "--size", "64x48", "--set", std::string("subpixel.bits=") + bits});
  compared[""] = result({"compare", "knot", "--size", "64x48"});
  for (const Json& row : bench["rows"]) {
    const Json& expected = compared.at(row["label"]);
    const bool is_reference = row["engine"] == "golden";
    const auto of = [&](const char* what, const char* moment) {  // the reference has no comparison
      return is_reference ? Json(nullptr) : expected[what][moment];
    };
    EXPECT_EQ(row["depth_lsb_max"], of("depth_lsb", "max")) << row;
    EXPECT_EQ(row["depth_lsb_rms"], of("depth_lsb", "rms")) << row;
    EXPECT_EQ(row["color_lsb_max"], of("color_lsb", "max")) << row;
    EXPECT_EQ(row["depth_eye_rms"], of("depth_eye", "rms")) << row;
    EXPECT_EQ(row["coverage_missing"], of("coverage", "missing")) << row;
    EXPECT_EQ(row["coverage_mismatches"], of("coverage", "oracle_mismatches")) << row;
  }
}

TEST_F(BenchCommandLine, RowsOfDifferentDepthBitsAreComparableInEyeSpace) {
  const Arguments vary{"--engines", "functional,golden", "--vary", "depth.bits=12,24"};
  const Outcome outcome = run(with({"bench", "knot", "--size", "64x48", "--repeat", "1", "--json"}, vary));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::map<int, Json> rows;
  const Json json = Json::parse(outcome.out);
  for (const Json& row : json["rows"])
    if (row["engine"] == "functional") rows[row["depth_bits"].get<int>()] = row;
  EXPECT_GT(rows[24]["depth_lsb_rms"], rows[12]["depth_lsb_rms"]) << "what misleads: an LSB is 4,096 times as small";
  EXPECT_LT(rows[24]["depth_eye_rms"], rows[12]["depth_eye_rms"]);
  EXPECT_LT(rows[24]["depth_range_rms"], rows[12]["depth_range_rms"]);
  for (const char* part : {"depth rms, LSB", "depth rms, eye", "each row's own depth.bits"})
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("ppm"), std::string::npos) << "eye depth is known";
  const std::string golden = lines_of(outcome.err)[3];
  EXPECT_NE(golden.find("golden"), std::string::npos);
  EXPECT_NE(golden.find(" - "), std::string::npos) << golden;
}

TEST_F(BenchCommandLine, WithoutEyeDepthTheDepthRangeIsTheUnit) {
  write("flat.hpt", "halfplane 1\ntarget 64 48\nspace window\nv 0 0 .1\nv 60 0 .3\nv 0 40 .7\nt 0 1 2\n");
  const Arguments flat{"bench", "flat.hpt", "--repeat", "1", "--engines", "functional"};
  const Outcome varied = run(with(flat, {"--vary", "depth.bits=12,24", "-o", "page.html"}));
  EXPECT_EQ(varied.status, 0) << varied.err;
  EXPECT_NE(varied.out.find("depth rms, ppm"), std::string::npos) << varied.out;
  EXPECT_EQ(varied.out.find("depth rms, eye"), std::string::npos) << "a column of nothing";
  EXPECT_NE(varied.out.find("millionths of the depth range"), std::string::npos);
  EXPECT_EQ(run(flat).out.find("ppm"), std::string::npos) << "one LSB needs no other unit";
}

TEST_F(BenchCommandLine, EveryCombinationOfWhatIsVariedStandsBesideTheBaseOnce) {
  const Json json = result(with(
      kTiny, {"--engines", "functional", "--no-errors", "--vary", "subpixel.bits=4,8", "--vary", "depth.bits=16,24"}));
  std::vector<std::string> labels;
  for (const Json& row : json["rows"]) {
    labels.push_back(row["label"]);
    EXPECT_TRUE(row["depth_lsb_max"].is_null());
  }
  EXPECT_EQ(labels, (std::vector<std::string>{"", "subpixel.bits=4 depth.bits=24", "subpixel.bits=8 depth.bits=16",
                                              "subpixel.bits=8 depth.bits=24"}));
  EXPECT_EQ(json["rows"][3]["config"], "embedded, subpixel.bits=8, depth.bits=24");
}

TEST_F(BenchCommandLine, WhatAnEngineCannotDoIsLeftOutWithOneLine) {
  const Arguments star{"bench", "star:4", "--size", "64x48", "--repeat", "1", "--config", "small", "--json", "--quiet"};
  const Outcome asked = run(with(star, {"--engines", "functional,cycle"}));
  EXPECT_EQ(asked.status, 0);
  EXPECT_EQ(lines_of(asked.err).size(), 1u);
  EXPECT_NE(asked.err.find("halfplane: left out: cycle on star:4"), std::string::npos) << asked.err;
  EXPECT_EQ(Json::parse(asked.out)["rows"].size(), 1u);
  const Outcome not_asked = run(star);
  EXPECT_EQ(not_asked.status, 0);
  EXPECT_EQ(not_asked.err, "");
  expect_refused(
      {"bench", "star:4", "--size", "64x48", "--repeat", "1", "--config", "small", "--engines", "cycle", "--quiet"},
      "lines.unit=1");
}

TEST_F(BenchCommandLine, SkipsAreMeasuredOnEachSceneThatIsGiven) {
  const Json json = result(with(kTiny, {"--skips"}));
  EXPECT_TRUE(json["rows"].empty());
  std::set<std::string> names;
  for (const Json& row : json["skips"]) {
    names.insert(row["skip"]);
    EXPECT_EQ(row["scene"], "triangle");
    for (const char* key : {"with_s", "without_s"}) EXPECT_GT(row[key], 0.0);
    EXPECT_DOUBLE_EQ(row["saved"], 1 - row["with_s"].get<double>() / row["without_s"].get<double>());
    if (row["skip"] == "trivially_accepted") {
      EXPECT_GT(row["counter"], 0) << "a triangle of half the picture";
    }
  }
  EXPECT_EQ(names.size(), 19u);
  EXPECT_EQ(names.count("objects"), 1u);
}

TEST_F(BenchCommandLine, GrowthCountsTheWorkOfEachPoint) {
  const Json json = result({"bench", "--growth", "--growth-max", "200", "--repeat", "1"});
  std::map<std::string, int> points;
  for (const Json& row : json["growth"]) {
    ++points[row["series"]];
    EXPECT_GT(row["frame_s"], 0.0);
    EXPECT_GT(row["mtri_s"], 0.0);
    EXPECT_GT(row["mpix_s"], 0.0);
    if (row["series"] == "triangle_count") {
      EXPECT_EQ(row["primitives"], row["x"]);
      EXPECT_EQ(row["fragments"], 10 * row["x"].get<int>());
    }
    if (row["series"] == "resolution") {
      EXPECT_EQ(row["fragments"], row["x"].get<int>() * row["x"].get<int>()) << "the grid fills the target";
    }
    if (row["series"] == "depth_back_to_front") {
      EXPECT_EQ(row["fragments"], 640 * 480 * row["x"].get<int>());
    }
  }
  EXPECT_EQ(points.size(), 6u);
  EXPECT_EQ(points["triangle_size"], 5);
  EXPECT_EQ(points["triangle_count"], 1);
}

TEST_F(BenchCommandLine, ReportIsOneFileWithItsDataInside) {
  const Outcome outcome = run(with(kTiny, {"--engines", "functional,golden", "-o", "bench.html"}));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(listing(), std::vector<std::string>{"bench.html"});
  const Bytes bytes = read("bench.html");
  const std::string page(bytes.begin(), bytes.end());
  const std::string open = "<script id=\"data\" type=\"application/json\">";
  const std::size_t start = page.find(open) + open.size();
  const Json data = Json::parse(page.substr(start, page.find("</script>", start) - start));
  EXPECT_EQ(data["rows"].size(), 2u);
  EXPECT_EQ(data["command"],
            "halfplane bench triangle --engines functional,golden --size 64x48 --repeat 1 -o bench.html");
  for (const char* outside : {"src=\"", "href=\"", "/*@"}) EXPECT_EQ(page.find(outside), std::string::npos) << outside;
}

TEST_F(BenchCommandLine, TextHasARatioWhenItsEngineIsInTheRun) {
  const Outcome outcome = run(with(kTiny, {"--engines", "functional,cycle"}));
  const auto lines = lines_of(outcome.out);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0], "embedded, 64x48, median of 1 frame, in turns");
  EXPECT_NE(lines[1].find("M cycles/s"), std::string::npos);
  EXPECT_EQ(lines[1].find("x rtl"), std::string::npos);
  EXPECT_EQ(lines[1].find("variation"), std::string::npos);
}

TEST_F(BenchCommandLine, BadInputIsRefusedWithOneLine) {
  const auto refused = [&](const Arguments& more, const std::string& part) { expect_refused(with(kTiny, more), part); };
  refused({"--engines", "gpu"}, "--engines: no engine 'gpu'; give some of functional");
  refused({"--engines", "functional,functional"}, "functional is named twice");
  refused({"--engines", ""}, "--engines");
  refused({"--vary", "depth.bits"}, "give KEY=VALUE,VALUE");
  refused({"--vary", "depth.bits="}, "names no values");
  refused({"--vary", "depth.bits=16,,24"}, "has an empty value");
  refused({"--vary", "depth.bits=16,16"}, "names the value 16 twice");
  refused({"--vary", "depth.bits=16", "--vary", "depth.bits=24"}, "varied twice");
  refused({"--vary", "depth.bit=16"}, "depth.bit");
  refused({"--vary", "depth.bits=99"}, "depth.bits");
  refused({"--threads", "0"}, "--threads");
  refused({"--threads", "2,2"}, "2 is named twice");
  refused({"--growth", "--growth-max", "3"}, "--growth-max");
  refused({"--skips", "--engines", "scalar"}, "or add --all");
  refused({"-o", "bench.json"}, ".html");
  expect_refused({"bench", "nosuch"}, "nosuch");
}

}  // namespace
}  // namespace halfplane::cli::bench_command_test
