// `depth`: its output, files and refusals.
#include <algorithm>
#include <cmath>
#include <map>

#include "program.hpp"

namespace halfplane::cli::depth_command_test {
namespace {

class DepthCommandLine : public Cli {};

TEST_F(DepthCommandLine, CsvHasTheContractsRows) {
  const Outcome outcome = run({"depth", "--near", "1", "--far", "1000", "--mapping", "std,rev,w", "--format",
                               "u16,u24,uf4.12", "--z", "10,100,900", "--csv", "-"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  const auto lines = lines_of(outcome.out);
  ASSERT_EQ(lines.size(), 1U + 3 * 3 * 3 * 4);
  EXPECT_EQ(lines[0], "mapping,format,near,far,z,metric,value");
  const auto has = [&](const std::string& line) { return std::find(lines.begin(), lines.end(), line) != lines.end(); };
  EXPECT_TRUE(has("std,u16,1,1000,900,code,65528"));
  EXPECT_TRUE(has("std,u16,1,1000,900,bin_width,12.446521336596586"));
  EXPECT_TRUE(has("rev,u16,1,1000,900,code,7"));
}

TEST_F(DepthCommandLine, JsonHasRowsSeriesAndNoPictures) {
  const Json theory = result({"depth", "--near", "0.1", "--far", "50", "--mapping", "stdinf", "--format", "f32"});
  EXPECT_EQ(theory["schema"], "halfplane.depth/1");
  EXPECT_TRUE(theory["scene"].is_null());
  EXPECT_EQ(theory["series"][0]["order"], "less");
  EXPECT_TRUE(theory["series"][0]["measured"].is_null());
  const Json scene = result({"depth", "--scene", "coplanar", "--size", "80x60", "--bits", "14", "--mapping", "rev"});
  EXPECT_EQ(scene["series"][0]["name"], "rev u14");
  EXPECT_EQ(scene["series"][0]["clear_code"], 0);
  const Json& measured = scene["series"][0]["measured"];
  EXPECT_GT(measured["pairs"], 500);
  EXPECT_GT(measured["rate"], 0.0);
  EXPECT_LE(measured["worst_share_of_bound"], 1.0);
  EXPECT_EQ(measured["stage_mismatches"], 0);
  EXPECT_EQ(scene["answers"].size(), 4U);
  EXPECT_FALSE(scene["trials"].empty());
}

// Clip z of near 1 and far 10 is (11 w - 20) / 9. Text in front, which neither tests nor writes depth, is no part of it.
TEST_F(DepthCommandLine, PlanesOfACaptureAreThoseOfItsProjection) {
  const std::string drawn = "v -1 -1 -1 1\nv 0 10 10 10\nv 5 -5 3.888888888888889 5\nt 0 1 2\n",
                    front =
                        "state depth_test always\nstate depth_write off\nv -1 -1 0 1\nv 0 1 0 1\nv 1 -1 0 1\nt 3 4 5\n";
  write("found.hpt", "halfplane 1\ntarget 64 64\n" + drawn + front);
  write("given.hpt", "halfplane 1\ntarget 64 64\nplanes 1 10\n" + drawn);
  const Json found = result({"depth", "--scene", "found.hpt"}), given = result({"depth", "--scene", "given.hpt"});
  EXPECT_NEAR(found["near"].get<double>(), 1, 1e-12);
  EXPECT_NEAR(found["far"].get<double>(), 10, 1e-12);
  const Json &a = found["series"][0]["measured"], &b = given["series"][0]["measured"];
  EXPECT_EQ(a["fragments"], b["fragments"]);
  EXPECT_EQ(a["pairs"], b["pairs"]);
}

// The options that a suggestion names reproduce its result.
TEST_F(DepthCommandLine, EachTrialComesOutTheSameWhenItsOptionsAreTyped) {
  const Arguments common{"depth", "--scene", "coplanar", "--size", "80x60", "--far", "100", "--mapping", "std"};
  const auto with = [&](const std::string& more, const char* more_format) {
    Arguments arguments = common;
    for (const std::string& word : split_words(more)) arguments.push_back(word);
    if (more.find("--format") == std::string::npos) arguments.insert(arguments.end(), {"--format", more_format});
    if (more.find("--near") == std::string::npos) arguments.insert(arguments.end(), {"--near", "0.3"});
    // An option typed twice is refused: the later mapping replaces the first.
    if (more.find("--mapping") != std::string::npos) arguments.erase(arguments.begin() + 7, arguments.begin() + 9);
    return result(arguments);
  };
  const Json base = with("", "u14");
  ASSERT_GE(base["trials"].size(), 5U);
  for (const Json& trial : base["trials"]) {
    const Json again = with(trial["options"].get<std::string>(), "u14");
    EXPECT_EQ(again["series"][0]["measured"]["rate"], trial["measured"]["rate"]) << trial["options"];
    EXPECT_EQ(again["series"][0]["measured"]["parts"], trial["measured"]["parts"]) << trial["options"];
  }
}

// Two squares face the camera, so each has one depth, and all pairs fight or none: by the formula of the std mapping.
TEST_F(DepthCommandLine, FewestBitsAreThoseWhereTheCodesOfTwoSquaresBegin) {
  const double z[] = {10, 10.003}, near = 1, far = 1000;
  const auto mapped = [&](double depth) { return far * (depth - near) / (depth * (far - near)); };
  const auto code = [&](double depth, int bits) {
    return std::floor(mapped(depth) * (std::ldexp(1.0, bits) - 1) + 0.5);
  };
  std::string text = "halfplane 1\ntarget 64 64\nspace clip\nplanes 1 1000\n";
  for (const double depth : z)
    for (const char* corner : {"-5 -5 ", "5 -5 ", "5 5 ", "-5 5 "})
      text += std::string("v ") + corner + Json(mapped(depth) * depth).dump() + " " + Json(depth).dump() + "\n";
  write("squares.hpt", text + "t 0 1 2\nt 0 2 3\nt 4 5 6\nt 4 6 7\n");
  int expected = 32;
  while (expected > 8 && code(z[0], expected - 1) < code(z[1], expected - 1)) --expected;
  ASSERT_EQ(expected, 13);
  const Json json = result({"depth", "--scene", "squares.hpt", "--mapping", "std,w"});
  const Json& fewest = json["fewest_bits"];
  ASSERT_EQ(fewest.size(), 2U);
  EXPECT_EQ(fewest[0]["bits"], expected);
  EXPECT_EQ(fewest[0]["rate"], 0.0);
  EXPECT_EQ(fewest[0]["rate_one_less"], 1.0);
  EXPECT_EQ(fewest[0]["rtl"], true);
  EXPECT_EQ(fewest[1]["rtl"], false);
  const auto answer = json["answers"][0].get<std::string>();
  EXPECT_NE(answer.find("For fewer than 1 %"), std::string::npos) << answer;
  EXPECT_NE(answer.find("near 1: 13 bits of std"), std::string::npos) << answer;
  const Json smallest = result({"widths", "--smallest", "--scene", "squares.hpt", "--fight-rate", "1%"});
  EXPECT_NE(smallest["smallest"]["set"].get<std::string>().find("depth.bits=13"), std::string::npos);
  EXPECT_EQ(smallest["smallest"]["scenes"][0]["fight_rate"], 0.0);
}

TEST_F(DepthCommandLine, SeparationIsPredictedAndTried) {
  const Json json = result({"depth", "--near", "1", "--far", "1000", "--mapping", "std,w", "--format", "u16,f16", "--z",
                            "20", "--slope", "1"});
  std::map<std::string, int> seen;
  for (const Json& row : json["rows"]) {
    ++seen[row["metric"]];
    if (row["metric"] == "fights_at_separation") {
      EXPECT_EQ(row["value"], 0.0) << row;
    }
    if (row["metric"] == "fights_at_half") {
      EXPECT_GT(row["value"], 0.0) << row;
    }
  }
  for (const char* metric : {"separation", "separation_storage", "separation_datapath", "separation_snap"})
    EXPECT_EQ(seen[metric], 4) << metric;
  EXPECT_EQ(seen["fights_at_separation"], 4);
  EXPECT_EQ(seen["fights_at_half"], 4);
}

TEST_F(DepthCommandLine, AskedForALengthItSaysWhereAndWhatItTakes) {
  const Json json = result({"depth", "--near", "1", "--far", "1000", "--mapping", "std", "--bits", "16", "--z", "10",
                            "--error", "0.1", "--range", "1,500"});
  std::map<std::string, double> value;
  for (const Json& row : json["rows"]) value[row["metric"]] = row["value"];
  EXPECT_NEAR(value["z_exceeds"], 80.98, 0.01);
  EXPECT_EQ(value["fewest_bits"], 22);
  EXPECT_GT(value["longest_bin"], 3.7);
  // A near plane keeps the length beyond 100, and a slightly nearer plane does not.
  double best = 0;
  const Json far_half = result({"depth", "--near", "1", "--far", "1000", "--mapping", "std", "--bits", "16", "--error",
                                "0.1", "--range", "100,500"});
  for (const Json& row : far_half["rows"])
    if (row["metric"] == "best_near") best = row["value"];
  ASSERT_GT(best, 10);
  for (const auto& [part, keeps] : {std::pair{1.00001, true}, {0.999, false}}) {
    const Json again = result({"depth", "--near", std::to_string(best * part), "--far", "1000", "--mapping", "std",
                               "--bits", "16", "--z", "1000", "--error", "0.1", "--range", "100,500"});
    double longest = 0;
    for (const Json& row : again["rows"])
      if (row["metric"] == "longest_bin") longest = row["value"];
    EXPECT_EQ(longest <= 0.1, keeps) << longest;
  }
}

TEST_F(DepthCommandLine, ReportNeedsNothingBesideIt) {
  const Outcome outcome = run({"depth", "--scene", "coplanar", "--size", "96x72", "--mapping", "std,w", "-o",
                               "report.html", "--heat", "heat.png", "--fights", "fights.png", "--csv", "rows.csv"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const Bytes bytes = read("report.html");
  const std::string page(bytes.begin(), bytes.end());
  EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0U);
  EXPECT_EQ(page.find("/*@"), std::string::npos);
  for (const char* outside : {"src=\"http", "href=\"http", "@import", "url(http"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  EXPECT_NE(page.find("Chart.js"), std::string::npos);
  // The data between its tags is JSON with two pictures for each series.
  const std::string open = "type=\"application/json\">";
  const std::size_t start = page.find(open) + open.size();
  const Json data = Json::parse(page.substr(start, page.find("</script>", start) - start));
  ASSERT_EQ(data["series"].size(), 2U);
  for (const Json& series : data["series"])
    for (const char* picture : {"heat", "fight"})
      EXPECT_EQ(series["measured"][picture].get<std::string>().rfind("data:image/png;base64,", 0), 0U);
  EXPECT_EQ(data["sweeps"].size(), 2U);
  EXPECT_EQ(data["heat_scale"].get<std::string>().rfind("data:image/png;base64,", 0), 0U);
  EXPECT_NE(data["heat_legend"].get<std::string>().find("logarithmic"), std::string::npos);
  EXPECT_TRUE(exists("heat.png") && exists("fights.png") && exists("rows.csv"));
  EXPECT_EQ(run({"depth", "--near", "1", "--far", "9", "-o", "theory.html"}).status, 0);
}

TEST_F(DepthCommandLine, CurveOfTheReportGoesThroughTheFiguresOfTheTable) {
  for (const Arguments& depths : {Arguments{}, Arguments{"--z", "0.3,7,55.5,123.456,1000"}}) {
    Arguments arguments{"depth",     "--near",        "0.1",      "--far",         "1000",
                        "--mapping", "std,rev,w,log", "--format", "u16,f16,uf4.12"};
    arguments.insert(arguments.end(), depths.begin(), depths.end());
    const Json json = result(arguments);
    std::map<std::string, Json> curves;
    for (const Json& series : json["series"]) curves[series["name"].get<std::string>()] = series["curve"];
    int compared = 0;
    for (const Json& row : json["rows"]) {
      const std::string metric = row["metric"];
      if (metric == "code") continue;
      const Json& curve = curves.at(row["mapping"].get<std::string>() + " " + row["format"].get<std::string>());
      const std::vector<double> z = curve["z"];
      EXPECT_TRUE(std::is_sorted(z.begin(), z.end()));
      const auto at = std::find(z.begin(), z.end(), std::stod(row["z"].get<std::string>())) - z.begin();
      ASSERT_LT(at, static_cast<std::ptrdiff_t>(z.size())) << row;
      EXPECT_EQ(std::count(z.begin(), z.end(), z[static_cast<std::size_t>(at)]), 1) << row;
      EXPECT_EQ(curve[metric][static_cast<std::size_t>(at)], row["value"]) << row;
      ++compared;
    }
    EXPECT_GE(compared, 4 * 3 * 3 * 5);
    for (const auto& [name, curve] : curves) EXPECT_EQ(curve["z"].back(), 1000.0) << name;
  }
}

TEST_F(DepthCommandLine, SweepsMeetTheTableOfFights) {
  const Json json = result({"depth", "--scene", "coplanar", "--size", "100x75", "--bits", "16", "--sweep"});
  int met = 0;
  for (const Json& series : json["series"])
    for (const Json& sweep : json["sweeps"])
      for (const Json& line : sweep["lines"]) {
        const bool is_storage = sweep["what"] == "storage bits";
        const std::string name = series["mapping"].get<std::string>() + (is_storage ? " u" : " u16");
        if (line["name"] != name) continue;
        const int here = is_storage ? 16 : json["config"]["subpixel.bits"].get<int>();
        for (std::size_t i = 0; i < line["x"].size(); ++i) {
          if (line["x"][i] != here) continue;
          EXPECT_EQ(line["rate"][i], series["measured"]["rate"]) << name;
          ++met;
        }
      }
  EXPECT_EQ(met, 6);
}

TEST_F(DepthCommandLine, WhatNoPairOfFragmentsShowsHasNoRate) {
  write("one.hpt",
        "halfplane 1\ntarget 40 40\nspace clip\nplanes 1 9\nv -2 -2 1.5 2\nv 3 -3 2 3\nv 0 4 3 4\nt 0 1 2\n");
  const Outcome one = run({"depth", "--scene", "one.hpt", "--mapping", "std", "--sweep", "--json"});
  EXPECT_EQ(one.status, 0) << one.err;
  const Json json = Json::parse(one.out);
  const Json& measured = json["series"][0]["measured"];
  EXPECT_EQ(measured["pairs"], 0);
  EXPECT_TRUE(measured["rate"].is_null());
  EXPECT_TRUE(measured["parts"]["total"]["max"].is_number());
  for (const Json& row : json["rows"]) EXPECT_NE(row["metric"], "fight_rate");
  for (const Json& sweep : json["sweeps"])
    for (const Json& line : sweep["lines"]) EXPECT_TRUE(line["x"].empty()) << line;
  EXPECT_EQ(one.err.find("0.0000 %"), std::string::npos) << one.err;
}

TEST_F(DepthCommandLine, BadQuestionsGetOneLine) {
  const Arguments planes{"depth", "--near", "1", "--far", "1000"};
  const auto refused = [&](Arguments more, const std::string& part, int status = 2) {
    Arguments arguments = planes;
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_refused(arguments, part, status);
  };
  expect_refused({"depth"}, "give --near");
  expect_refused({"depth", "--near", "5", "--far", "5"}, "give 0 < near < far");
  expect_refused({"depth", "--near", "0", "--far", "5"}, "give 0 < near < far");
  expect_refused({"depth", "--near", "x", "--far", "5"}, "'x' is no number");
  expect_refused({"depth", "--near", "1e-20", "--far", "1e20"}, "far / near");
  refused({"--mapping", "std,upside"}, "no mapping 'upside'");
  refused({"--mapping", "std,,w"}, "empty part");
  refused({"--format", "u99"}, "no depth format 'u99'");
  refused({"--format", "plane"}, "name the stored format");
  refused({"--z", "2000"}, "not between near and far");
  refused({"--z", "ten"}, "'ten' is no number");
  refused({"--bits", "16", "--format", "u16"}, "leave one of them out");
  refused({"--range", "5", "--error", "1"}, "two depths");
  refused({"--range", "5,10"}, "add --error");
  refused({"--camera", "fov=30"}, "add --scene");
  refused({"--z", ""}, "the value is empty");
  refused({"--set", "depth.bits=20"}, "leave depth.bits out");
  refused({"--error", "-1"}, "'-1' is not above 0");
  refused({"--heat", "x.png"}, "add --scene");
  refused({"-o", "report.txt"}, ".html");
  refused({"-o", "nowhere/report.html"}, "no such folder");
  refused({"--csv", "-", "--json"}, "both write to stdout; give one of them a file");
  refused({"--set", "depth.format=u16"}, "this command takes them by --mapping and --format");
  refused({"--slope", "steep"}, "is no number");
  expect_refused({"depth", "--near", "0." + std::string(345, '0') + "1", "--far", "9"}, "1e-30");
  // Clip z is (11 w - 20) / 9 from near 1 to far 10, but for the third vertex.
  write("bent.hpt", "halfplane 1\nv 0 0 -1 1\nv 0 1 10 10\nv 1 0 3 5\nt 0 1 2\n");
  expect_refused({"depth", "--scene", "bent.hpt"}, "give --near and --far");
  write("front.hpt",
        "halfplane 1\nstate depth_test always\nstate depth_write off\nv 0 0 0 1\nv 0 1 0 2\nv 1 0 0 1\nt 0 1 2\n");
  expect_refused({"depth", "--scene", "front.hpt"}, "no draw tests or writes depth");
  write("empty.hpt", "halfplane 1\nplanes 1 9\nv 0 0 0 2\nv 0 0 0 3\nt 0 0 1\n");
  expect_refused({"depth", "--scene", "empty.hpt"}, "nothing to measure");
  expect_refused({"depth", "--scene", "triangle", "--near", "1", "--far", "9"}, "every w is the same");
  expect_refused({"depth", "--scene", "teapot", "--camera", "ortho=3"}, "no perspective projection");
  expect_refused({"render", "teapot", "--set", "depth.mapping=rev", "--convention", "fcg"}, "order of depth");
  expect_refused({"render", "teapot", "--set", "depth.format=f16", "--engine", "cycle"}, "this hardware");
}

// A 16-bit plane has 253 codes where the format has 5,050.
TEST_F(DepthCommandLine, AFormatIsMadeFromAPlaneThatHasItsCodes) {
  const Arguments render{"render", "coplanar", "--set", "depth.mapping=w", "--set", "depth.format=u16"};
  const auto with = [&render](const char* bits) {
    Arguments all = render;
    all.insert(all.end(), {"--set", bits});
    return all;
  };
  const Json chosen = result(render);
  EXPECT_EQ(chosen["config"]["depth.bits"], 30);
  EXPECT_EQ(chosen["depth_hash"], result(with("depth.bits=30"))["depth_hash"]);
  EXPECT_NE(chosen["depth_hash"], result(with("depth.bits=16"))["depth_hash"]);
  EXPECT_NE(run(render).err.find("depth.bits=30: chosen for depth.format=u16"), std::string::npos);
  EXPECT_EQ(run(with("depth.bits=16")).err, "") << "nothing is chosen";
  EXPECT_EQ(result({"render", "coplanar", "--set", "depth.format=u12"})["config"]["depth.bits"], 12);
}

TEST_F(DepthCommandLine, EveryMappingAndFormatDrawsTheSamePicture) {
  const Json plain = result({"render", "teapot", "--size", "120x90", "--set", "depth.bits=24"});
  for (const char* setting :
       {"depth.mapping=std", "depth.mapping=rev", "depth.mapping=stdinf", "depth.mapping=revinf"}) {
    const Json cycle = result(
        {"render", "teapot", "--size", "120x90", "--set", "depth.bits=24", "--set", setting, "--engine", "cycle"});
    EXPECT_EQ(cycle["color_hash"], plain["color_hash"]) << setting;
  }
  for (const char* mapping : {"depth.mapping=rev", "depth.mapping=w", "depth.mapping=log"})
    for (const char* format : {"depth.format=f32", "depth.format=u24", "depth.format=bins24"})
      EXPECT_EQ(result({"render", "teapot", "--size", "120x90", "--set", "depth.bits=32", "--set", mapping, "--set",
                        format})["color_hash"],
                plain["color_hash"])
          << mapping << ' ' << format;
}

}  // namespace
}  // namespace halfplane::cli::depth_command_test
