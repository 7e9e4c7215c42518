// `widths`: the table's JSON, the captures of overflows, the smallest configuration, and the refusals.
#include <algorithm>
#include <stdexcept>

#include "program.hpp"

namespace halfplane::cli::widths_test {
namespace {

class WidthsCommandLine : public Cli {};

const Json& named(const Json& widths, const std::string& name) {
  for (const Json& width : widths)
    if (width["name"] == name) return width;
  throw std::out_of_range(name);
}

TEST_F(WidthsCommandLine, JsonHasEveryWidthWithRangeAndWhatWasSeen) {
  const Json json = result({"widths", "--config", "full", "--samples", "400", "--seed", "7"});
  EXPECT_EQ(json["schema"], "halfplane.widths/1");
  EXPECT_EQ(json["seed"], 7);
  EXPECT_GT(json["wall_s"], 0);
  EXPECT_EQ(json["config"]["preset"], "full");
  EXPECT_GT(json["widths"].size(), 45U);
  const Json& delta = named(json["widths"], "delta");
  EXPECT_EQ(delta["formula"], "X - X");
  EXPECT_EQ(delta["bits"], 23);
  EXPECT_EQ(delta["hi"], 4194303);
  EXPECT_EQ(delta["seen_lo"], -4194303);
  EXPECT_TRUE(delta["attained"]["lo"] == true && delta["attained"]["hi"] == true);
  EXPECT_EQ(delta["spare_bits"], 0);
  EXPECT_EQ(delta["overflows_first"]["input"]["vertices"].size(),
            delta["overflows_first"]["input"]["kind"] == "line" ? 2U : 3U);
  // A value too large for a double is text: L (2^24 - 1) 2^28, L = 2^22 - 1.
  EXPECT_EQ(named(json["widths"], "depth product")["hi"], "18889460301979315077120");
  EXPECT_EQ(named(json["widths"], "local depth")["modular"], true);
  EXPECT_TRUE(named(json["widths"], "local depth")["overflows_first"].is_null());
  EXPECT_EQ(named(json["widths"], "counter")["observed"], false);
  EXPECT_FALSE(json["overflow_order"].empty());
  EXPECT_EQ(json["homogeneous"].size(), 7U);
  EXPECT_NEAR(json["error_bounds"]["depth_lsb"], 0.664, 0.001);
  const Json& over_w = json["error_bounds"]["over_w"];
  EXPECT_EQ(over_w["coordinate"][1]["texels"], 1024);
  EXPECT_GT(over_w["coordinate"][1]["w_ratio"], 1024);
  EXPECT_GT(over_w["color"]["w_ratio"], 400);
}

TEST_F(WidthsCommandLine, TableNamesEachWidthItsFormulaAndWhatOverflows) {
  const Outcome outcome = run({"widths", "--config", "tiny", "--samples", "400"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  for (const char* part : {"coordinate           8 s", "guard band g * 2^s", "One bit less: what overflows first",
                           "seed 1", "nothing seen overflows with a bit less: ", "exact by construction"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
  EXPECT_EQ(outcome.out.find("BROKEN"), std::string::npos);
}

TEST_F(WidthsCommandLine, EachCaptureIsASceneThatTheProgramDraws) {
  EXPECT_EQ(run({"widths", "--config", "tiny", "--samples", "400", "--captures", "found"}).status, 0);
  for (const char* name : {"found/area.hpt", "found/depth-product.hpt", "found/line-move.hpt"}) {
    ASSERT_TRUE(exists(name)) << name;
    EXPECT_EQ(result({"render", name, "--config", "tiny"})["primitives"]["in"], 1) << name;
  }
}

TEST_F(WidthsCommandLine, SmallestConfigurationIsReproducedByTheOptionsThatItNames) {
  const Arguments common{"widths", "--smallest", "--scene", "teapot:2,wires:6", "--size", "48x32"};
  Arguments arguments = common;
  arguments.insert(arguments.end(), {"--depth-error", "2lsb", "--coverage-error", "40"});
  const Json json = result(arguments);
  EXPECT_EQ(json["schema"], "halfplane.widths/1");
  EXPECT_EQ(json["measured"], true);
  ASSERT_FALSE(json["smallest"].is_null());
  EXPECT_LT(json["smallest"]["bits"]["total"], json["start_bits"]["total"]);
  EXPECT_EQ(json["smallest"]["scenes"].size(), 2U);
  EXPECT_EQ(json["one_less"].size(), 5U);
  EXPECT_GT(json["trials"], 5);
  for (const Json& scene : json["smallest"]["scenes"]) {
    EXPECT_LE(scene["depth"], json["bounds"]["depth"]);
    Arguments again{"compare", scene["scene"], "--size", "48x32"};
    for (const std::string& word : split_words(json["smallest"]["set"])) again.push_back(word);
    const Json compared = result(again);
    EXPECT_EQ(compared["coverage"]["missing"].get<int>() + compared["coverage"]["extra"].get<int>(), scene["coverage"]);
    const auto largest = [&compared](const char* of) {
      const Json& error = compared["datapath"][of];  // null where there is no triangle, or no line
      return error["count"] == 0 ? 0.0 : error["max"].get<double>();
    };
    const double depth = std::max(largest("depth_lsb"), largest("line_depth_lsb"));
    EXPECT_NEAR(depth, scene["depth_lsb"], 1e-6);
  }
  const Outcome text = run(arguments);
  EXPECT_EQ(text.status, 0);
  EXPECT_NE(text.out.find("measured and not proven"), std::string::npos);
  EXPECT_NE(text.out.find("proven 0."), std::string::npos) << "the derived bound beside it";
}

TEST_F(WidthsCommandLine, BoundThatNothingKeepsIsSaidWithStatusOne) {
  const Outcome outcome =
      run({"widths", "--smallest", "--scene", "teapot:2", "--size", "16x16", "--depth-error", "1e-15"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("none keeps the bounds"), std::string::npos) << outcome.out;
}

TEST_F(WidthsCommandLine, BadInputIsRefusedWithTheMend) {
  const auto smallest = [](const std::string& option, const std::string& value) {
    return Arguments{"widths", "--smallest", "--scene", "triangle", option, value};
  };
  for (const char* error : {"", "lsb", "0lsb", "-1lsb", "nanlsb", "1lsbs", "1 lsb", "2", "0", "1e-4x", "inf"})
    expect_refused(smallest("--depth-error", error), *error == 0 ? "no bound" : "--depth-error");
  for (const char* error : {"1", "lsb", "x", "-1lsb"})
    expect_refused(smallest("--color-error", error), "--color-error");
  for (const char* error : {"-1", "0", "1lsb", "x"})
    expect_refused(smallest("--texture-error", error), "--texture-error");
  expect_refused(smallest("--texture-error", "0.1"), "no scene has a texture");
  for (const char* part : {"0", "2", "1%%", "-1%", "few", "nan"})
    expect_refused(smallest("--fight-rate", part), "--fight-rate");
  expect_refused({"widths", "--smallest", "--scene", "triangle", "--fight-rate", "0.5"}, "near and far plane");
  for (const char* error : {"-1", "1.5", "many"})
    expect_refused(smallest("--coverage-error", error), "--coverage-error");
  expect_refused({"widths", "--smallest", "--scene", "nosuch", "--depth-error", "1lsb"}, "nosuch");
  expect_refused({"widths", "--smallest", "--depth-error", "1lsb"}, "--scene");
  expect_refused({"widths", "--smallest", "--scene", "triangle"}, "--depth-error");
  expect_refused({"widths", "--scene", "triangle"}, "--smallest");
  expect_refused({"widths", "--smallest", "--captures", "."}, "--captures");
  expect_refused({"widths", "--captures", "/dev/null/x"}, "cannot make the folder");
  expect_refused({"widths", "--samples", "0"}, "--samples");
  expect_refused({"widths", "--set", "depth.bits=99"}, "depth.bits");
  expect_refused({"widths", "--smallest", "--scene", "triangle", "--depth-error", "1lsb", "--set", "depth.format=f16"},
                 "depth.format");
}

}  // namespace
}  // namespace halfplane::cli::widths_test
