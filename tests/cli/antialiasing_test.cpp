// Several samples a pixel from the command line: the engines that draw them, and the refusals of the others.
#include <map>
#include <string>
#include <utility>

#include "program.hpp"

namespace halfplane::cli::antialiasing_test {
namespace {

class AntialiasingCommand : public Cli {};

TEST_F(AntialiasingCommand, EnginesThatHaveSamplesDrawThemAndCompareHoldsEachToItsBounds) {
  const Json functional =
      result({"render", "teapot", "--size", "120x90", "--set", "msaa.samples=4", "--set", "color.format=rgba8888"});
  const Json scalar = result({"render", "teapot", "--size", "120x90", "--set", "msaa.samples=4", "--set",
                              "color.format=rgba8888", "--engine", "scalar"});
  const Json one = result({"render", "teapot", "--size", "120x90", "--set", "color.format=rgba8888"});
  EXPECT_EQ(functional["config"]["msaa.samples"], 4);
  EXPECT_EQ(functional["config"]["msaa.pattern"], "standard");
  EXPECT_EQ(functional["color_hash"], scalar["color_hash"]);
  EXPECT_EQ(functional["fragments"]["written"], scalar["fragments"]["written"]);
  EXPECT_NE(functional["color_hash"], one["color_hash"]);
  EXPECT_GT(functional["fragments"]["written"], 3 * one["fragments"]["written"].get<int>());
  const Json compared = result(
      {"compare", "teapot", "--size", "80x60", "--set", "msaa.samples=2", "--set", "msaa.pattern=0.125,0.5;0.75,0.25"});
  EXPECT_EQ(compared["coverage"]["oracle_mismatches"], 0);
  EXPECT_GT(compared["coverage"]["oracle_samples"], 1000);
}

TEST_F(AntialiasingCommand, SupersampledPicturesAreTheMeanOfWholeOnes) {
  const Json json = result({"render", "teapot", "--size", "60x40", "--supersample", "2x2"});
  const Json one = result({"render", "teapot", "--size", "60x40"});
  EXPECT_EQ(json["supersample"], "2x2");
  EXPECT_TRUE(one["supersample"].is_null());
  EXPECT_NE(json["color_hash"], one["color_hash"]);
  EXPECT_GT(json["fragments"]["covered"], 3 * one["fragments"]["covered"].get<int>());
  EXPECT_EQ(json["color_hash"], result({"render", "teapot", "--size", "60x40", "--supersample", "2x2", "--engine",
                                        "scalar"})["color_hash"]);
  expect_refused({"render", "teapot", "--supersample", "2x3"}, "--supersample");
  expect_refused({"render", "teapot", "--supersample", "4x4", "--engine", "cycle"}, "--supersample");
  expect_refused({"bench", "teapot", "--antialiasing"}, "--antialiasing");
  expect_refused({"bench", "--antialiasing", "--space"}, "--antialiasing");
  expect_refused({"bench", "--antialiasing", "--set", "msaa.samples=2"}, "msaa.samples");
}

// The mean leaves the chip, so several samples do not multiply the bytes; N x N pictures take as many frames.
TEST_F(AntialiasingCommand, HardwareOfEachKindIsMeasured) {
  const Json study = result({"bench", "--antialiasing", "--size", "96x72", "--repeat", "1"})["antialiasing"];
  std::map<std::string, Json> kinds;
  for (const Json& row : study["rows"]) kinds[row["kind"]] = row;
  const auto one = [&](const char* key) { return kinds["1 sample"][key].get<double>(); };
  for (const char* kind : {"msaa 2", "msaa 4", "msaa 8"}) {
    EXPECT_LT(kinds[kind]["bytes"].get<double>(), 2 * one("bytes")) << kind;  // slightly more blocks are touched
    EXPECT_LT(kinds[kind]["rms"].get<double>(), one("rms")) << kind;
  }
  for (const auto& [kind, frames] : {std::pair("supersample 2x2", 4), std::pair("supersample 4x4", 16)}) {
    EXPECT_GT(kinds[kind]["cycles"].get<double>(), 0.8 * frames * one("cycles")) << kind;
    EXPECT_GT(kinds[kind]["bytes"].get<double>(), frames * one("bytes") + (frames + 1) * 2.0 * 96 * 72 - 1) << kind;
  }
  EXPECT_TRUE(kinds["msaa 8"]["hardware"].get<std::string>().find("resolve.unit=1") != std::string::npos);
  for (const auto& name : kinds["1 sample"]["fronts"]) EXPECT_NE(name, "ecp5.places") << "gates are not counted";
  EXPECT_FALSE(kinds["1 sample"]["fronts"].empty()) << "nothing costs less";
  const Json smooth = study["lines"]["rows"].back();
  EXPECT_EQ(smooth["kind"], "smooth");
  EXPECT_GT(smooth["cycles"], 0);
  for (const Json& row : result({"bench", "--antialiasing", "--size", "48x32", "--repeat", "1", "--config",
                                 "small"})["antialiasing"]["rows"])
    EXPECT_FALSE(row.contains("cycles")) << "a serial setup has no bins";
}

TEST_F(AntialiasingCommand, WhoHasOneSampleAPixelSaysSo) {
  for (const Arguments& arguments :
       std::vector<Arguments>{{"render", "teapot", "--engine", "cycle", "--config", "small"},
                              {"cosim", "--random", "3", "--config", "small"},
                              {"widths"},
                              {"depth"},
                              {"stress"},
                              {"vectors", "--random", "3", "--stage", "cull", "-o", "v", "--config", "small"},
                              {"config", "--sv", "--config", "small"},
                              {"config", "--dpi", "--config", "small"},
                              {"render", "teapot", "--engine", "scalar", "--traversal", "bbox"}}) {
    Arguments with_samples = arguments;
    with_samples.insert(with_samples.end(), {"--set", "msaa.samples=4"});
    SCOPED_TRACE(arguments[0] + " " + (arguments.size() > 1 ? arguments.back() : std::string()));
    expect_refused(with_samples, "msaa.samples");
  }
  expect_refused({"render", "teapot", "--config", "full", "--set", "msaa.samples=8"}, "stamp.size");
  expect_refused({"render", "teapot", "--set", "msaa.samples=2", "--set", "msaa.pattern=0.5,0.5"}, "msaa.pattern");
  expect_refused({"render", "teapot", "--set", "msaa.samples=2", "--set", "msaa.pattern=0.5"}, "msaa.pattern");
}

}  // namespace
}  // namespace halfplane::cli::antialiasing_test
