// `halfplane compare`, `scenes` and `config`: their results and output.
#include <set>

#include "program.hpp"

namespace halfplane::cli::compare_test {
namespace {

class CompareCommand : public Cli {};
class ScenesCommand : public Cli {};
class ConfigCommand : public Cli {};

void expect_numbers(const Json& json, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    ASSERT_TRUE(json.contains(key)) << key << " in " << json;
    EXPECT_TRUE(json[key].is_number()) << key << ": " << json[key];
  }
}

TEST_F(CompareCommand, ResultHasEveryKeyOfTheContract) {
  const Json json = result({"compare", "teapot", "--size", "160x120", "--seed", "5"});
  EXPECT_EQ(json["schema"], "halfplane.compare/1");
  EXPECT_EQ(json["scene"], "teapot");
  EXPECT_EQ(json["seed"], 5);
  EXPECT_EQ(json["config"]["depth.bits"], 16);
  EXPECT_TRUE(json["wall_s"].is_number());
  for (const char* key : {"missing", "extra", "oracle_mismatches"})
    EXPECT_TRUE(json["coverage"][key].is_number_unsigned()) << key;
  for (const char* key : {"depth_lsb", "depth_eye", "color_lsb"})
    expect_numbers(json[key], {"max", "mean", "rms", "p999"});
  for (const char* part : {"snap", "interpolation", "storage", "affine"})
    expect_numbers(json["parts"][part], {"max", "rms"});
}

TEST_F(CompareCommand, SmallerNumbersOfTheHostAreShownBesideTheRest) {
  EXPECT_TRUE(result({"compare", "teapot:2", "--size", "64x48"})["transform"].is_null());
  double before = 0;
  for (const char* numbers : {"binary32", "s15.16"}) {
    const Json json = result({"compare", "teapot:2", "--size", "64x48", "--transform", numbers});
    EXPECT_EQ(json["transform"]["numbers"], numbers);
    EXPECT_GT(json["transform"]["pixels"]["max"], before);
    before = json["transform"]["pixels"]["max"].get<double>();
    EXPECT_NE(json["transform"]["depth_lsb"]["max"], 0);
    EXPECT_GT(json["transform"]["parts"]["divide"]["pixels"]["max"], 0);
    EXPECT_EQ(json["transform"]["cut"], 0);
    EXPECT_TRUE(json["broken_bounds"].empty()) << "golden and model are given the same vertices";
    const Json cut = result({"compare", "walk", "--size", "64x48", "--transform", numbers});
    EXPECT_GT(cut["transform"]["cut"], 0);
    EXPECT_GT(cut["transform"]["parts"]["clip"]["pixels"]["max"], 0);
    EXPECT_TRUE(cut["broken_bounds"].empty());
  }
}

TEST_F(CompareCommand, CyclesOfLightAreShownBesideItsErrors) {
  const std::vector<std::string> lit{"compare", "knot:16", "--size", "96x64", "--light", "phong"};
  const auto beside = [&](std::vector<std::string> words) {
    words.insert(words.begin(), lit.begin(), lit.end());
    return words;
  };
  const Json cycles = result(lit)["per_vertex_cycles"];
  EXPECT_EQ(cycles["set"], (Json{"texture.unit=nearest", "shade.unit=1"}));
  const std::vector<std::string> unit{"--set", "texture.unit=nearest", "--set", "shade.unit=1"};
  std::vector<std::string> render = beside(unit);
  render[0] = "render";
  render.insert(render.end(), {"--engine", "cycle"});
  EXPECT_EQ(cycles["at_fragments"], result(render)["cycles"]);
  EXPECT_LT(cycles["at_vertices"], cycles["at_fragments"]);
  EXPECT_TRUE(result(beside(unit))["per_vertex_cycles"]["set"].empty());
  EXPECT_NE(run(lit).out.find("set texture.unit=nearest, shade.unit=1"), std::string::npos);

  EXPECT_TRUE(result({"compare", "knot:16", "--size", "96x64"})["per_vertex_cycles"].is_null());
  const auto serial = beside({"--set", "setup.kind=serial"});
  const Json refused = result(serial);
  EXPECT_TRUE(refused["per_vertex_cycles"].is_null());
  EXPECT_FALSE(refused["per_vertex"].empty());
  EXPECT_NE(run(serial).out.find("no cycles: configuration refused: a texture unit"), std::string::npos);
}

TEST_F(CompareCommand, FiguresAreInOrderAndBounded) {
  for (const char* config : {"tiny", "embedded", "full"}) {
    const Json json = result({"compare", "teapot", "--config", config, "--size", "16x16"});
    EXPECT_EQ(json["coverage"]["oracle_mismatches"], 0) << config;
    for (const char* key : {"depth_lsb", "depth_eye", "color_lsb"}) {
      const Json& s = json[key];
      EXPECT_GE(s["max"], s["p999"]) << config << key;
      EXPECT_GE(s["max"], s["rms"]) << config << key;
      EXPECT_GE(s["rms"].get<double>() * (1 + 1e-12), std::abs(s["mean"].get<double>())) << config << key;
      EXPECT_GT(s["max"], 0.0) << config << key << ": nothing was compared";
    }
    EXPECT_LE(json["parts"]["interpolation"]["max"], 0.25) << config;  // with storage: 0.75 LSB
    EXPECT_LE(json["parts"]["storage"]["max"], 0.5) << config;
    EXPECT_GT(json["compared_pixels"], 0) << config;
  }
}

TEST_F(CompareCommand, HumanTextSumsUpOnStdoutOrBesideTheResultOnStderr) {
  const Outcome plain = run({"compare", "triangle", "--size", "64x48"});
  EXPECT_EQ(plain.status, 0);
  EXPECT_NE(plain.out.find("0 mismatches"), std::string::npos) << plain.out;
  EXPECT_EQ(plain.err, "");
  const Outcome json = run({"compare", "triangle", "--size", "64x48", "--json"});
  EXPECT_FALSE(Json::parse(json.out, nullptr, false).is_discarded()) << json.out;
  EXPECT_NE(json.err.find("0 mismatches"), std::string::npos);
}

TEST_F(CompareCommand, ModelPictureIsTheRenderedOneAndSheetAndGoldenAreWritten) {
  ASSERT_EQ(run({"compare", "teapot", "--size", "64x48", "-o", "sheet.png", "--model", "model.png", "--golden-picture",
                 "golden.png"})
                .status,
            0);
  ASSERT_EQ(run({"render", "teapot", "--size", "64x48", "-o", "render.png"}).status, 0);
  EXPECT_EQ(read("model.png"), read("render.png"));
  const Bytes signature{0x89, 'P', 'N', 'G'};
  for (const char* name : {"sheet.png", "golden.png"}) {
    const Bytes file = read(name);
    ASSERT_GT(file.size(), 100u) << name;
    EXPECT_EQ(Bytes(file.begin(), file.begin() + 4), signature) << name;
  }
}

TEST_F(CompareCommand, ATexturedSheetHasAPictureOfEachPartAndAnUntexturedOneHasNone) {
  write("t.hpt",
        "halfplane 1\ntarget 32 32\ntexture t pattern grid 16 16 mips box\nspace window\nstate texture t\n"
        "state texture_min linear_mipmap_linear\nv 1 1 0.5 1 255 0 0 255 0 0\nv 30 2 0.5 4 0 255 0 255 9 0\n"
        "v 5 30 0.5 2 0 0 255 255 0 9\nt 0 1 2\n");
  const Json texture = result({"compare", "t.hpt", "-o", "all.png"})["texture"];
  for (const char* part : {"coordinate", "level_of_detail", "weights", "rounding"})
    EXPECT_GT(texture["parts"][part]["count"], 0) << part;
  EXPECT_LE(texture["coordinate"]["of_bound"], 1);
  EXPECT_EQ(
      run({"compare", "t.hpt", "-o", "some.png", "--panels", "coordinate,footprints,level,weights,rounding"}).status,
      0);
  EXPECT_GT(read("all.png").size(), read("some.png").size());
  EXPECT_TRUE(result({"compare", "triangle", "--size", "32x32"})["texture"].is_null());
  expect_refused({"compare", "triangle", "--size", "32x32", "-o", "none.png", "--panels", "model,level"},
                 "--panels: level is about textures");
}

TEST_F(CompareCommand, SinglePrecisionGoldenDiffersFromTheDoubleOne) {
  const Arguments base{"compare", "walk", "--size", "64x48", "--config", "full"};
  Arguments single = base;
  single.insert(single.end(), {"--golden", "binary32"});
  const Json a = result(base), b = result(single);
  EXPECT_EQ(a["golden"], "binary64");
  EXPECT_EQ(b["golden"], "binary32");
  EXPECT_NE(a["depth_lsb"], b["depth_lsb"]);  // a binary32 cannot hold a 24-bit z with its rounding
}

TEST_F(CompareCommand, SceneWithoutTrianglesComparesNothingWhichIsNoPass) {
  write("clear.hpt", "halfplane 1\ntarget 9 7\nclear color 9 9 9 255 depth .5\n");
  const auto outcome = run({"compare", "clear.hpt", "--json"});
  EXPECT_EQ(outcome.status, 1);
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["compared_pixels"], 0);
  EXPECT_EQ(json["coverage"]["missing"], 0);
  ASSERT_EQ(json["broken_bounds"].size(), 1u);
  // A figure that was not measured is not zero.
  EXPECT_EQ(json["depth_lsb"]["count"], 0);
  for (const char* key : {"depth_lsb", "color_lsb"})
    for (const char* moment : {"max", "mean", "rms", "p999"}) EXPECT_TRUE(json[key][moment].is_null()) << key << moment;
  EXPECT_TRUE(json["parts"]["snap"]["max"].is_null());
  EXPECT_TRUE(json["datapath"]["depth_bias"].is_null());
  int rows = 0;
  for (const std::string& line : lines_of(outcome.err)) {
    if (!line.starts_with("depth") && !line.starts_with("colour") && !line.starts_with("  s")) continue;
    if (line.starts_with("  samples")) continue;
    EXPECT_TRUE(line.ends_with(" -")) << line;
    ++rows;
  }
  EXPECT_GE(rows, 5) << outcome.err;
}

TEST_F(CompareCommand, MissingAndExtraAreCountedInPixelsAsThePictureDoesAndInSamples) {
  const Outcome outcome = run({"compare", "knot", "--size", "64x48", "--set", "subpixel.bits=0", "--json"});
  const Json json = Json::parse(outcome.out);
  const Json& coverage = json["coverage"];
  EXPECT_GT(coverage["missing_pixels"], 0u);
  EXPECT_LE(coverage["missing_pixels"], coverage["missing"]);
  EXPECT_LE(coverage["extra_pixels"], coverage["extra"]);
  const auto text = [&](const char* key) { return std::to_string(coverage[key].get<int>()); };
  EXPECT_NE(outcome.err.find("pixels: " + text("missing_pixels") + " missing, " + text("extra_pixels") + " extra, " +
                             text("other_visible") + " other primitive"),
            std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("samples: " + text("missing") + " missing, " + text("extra") + " extra"),
            std::string::npos);
  EXPECT_NE(outcome.err.find("colour, all channels"), std::string::npos);
}

TEST_F(CompareCommand, ASceneWithLettersThatTheFontLacksHasTheSheetOfOneWithout) {
  const std::string capture = "halfplane 1\ntarget 24 24\nspace window\nv 2 2 .5\nv 20 20 .5\nv 20 2 .5\nt 0 1 2\n";
  write("Zähne.hpt", capture);
  write("Zahne.hpt", capture);
  for (const char* name : {"Zähne", "Zahne"})
    EXPECT_EQ(run({"compare", std::string(name) + ".hpt", "-o", std::string(name) + ".png"}).status, 0);
  EXPECT_EQ(read("Zähne.png"), read("Zahne.png"));
}

TEST_F(ScenesCommand, EveryListedSceneRendersByItsName) {
  const Json json = result({"scenes"});
  EXPECT_EQ(json["schema"], "halfplane.scenes/1");
  const std::string text = run({"scenes"}).out;
  std::set<std::string> names;
  for (const Json& scene : json["scenes"]) {
    const std::string name = scene["name"];
    names.insert(name);
    EXPECT_NE(text.find(name), std::string::npos) << name;
    EXPECT_FALSE(scene["description"].get<std::string>().empty()) << name;
    EXPECT_GT(result({"render", name, "--size", "64x48"})["fragments"]["written"], 0u) << name;
    if (!scene.contains("n")) continue;
    const std::string smallest = name + ":" + std::to_string(scene["n"]["min"].get<int>());
    EXPECT_EQ(result({"render", smallest, "--size", "64x48"})["scene"], smallest);
  }
  for (const char* name : {"teapot", "city", "knot", "coplanar", "slivers", "walk", "layers", "layers_front", "ball",
                           "blocks", "scratches", "dust", "objects", "hidden", "shell"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST_F(ConfigCommand, ListShowsEverySettingWithItsRangeAndItsValue) {
  const Json json = result({"config", "--list", "--config", "full", "--set", "depth.bits=20"});
  const std::string text = run({"config", "--list"}).out;
  EXPECT_EQ(json["schema"], "halfplane.config/1");
  EXPECT_EQ(json["config"]["depth.bits"], 20);
  EXPECT_EQ(json["config"].size(), json["settings"].size() + 1);  // the preset's name is no setting
  for (const Json& setting : json["settings"]) {
    const std::string key = setting["key"];
    EXPECT_EQ(setting["value"], json["config"][key]) << key;
    EXPECT_NE(text.find(key), std::string::npos) << key;
    EXPECT_FALSE(setting["meaning"].get<std::string>().empty()) << key;
    if (!setting["value"].is_number()) continue;
    EXPECT_LE(setting["range"][0], setting["value"]) << key;
    EXPECT_GE(setting["range"][1], setting["value"]) << key;
    for (const int outside : {setting["range"][0].get<int>() - 1, setting["range"][1].get<int>() + 1})
      expect_refused({"config", "--set", key + "=" + std::to_string(outside)}, key);
  }
}

TEST_F(ConfigCommand, ShownValuesGivenBackMakeTheSameConfiguration) {
  const Json full = result({"config", "--config", "full"})["config"];
  std::string toml = "preset = \"full\"\n";
  Arguments settings{"config", "--config", "full"};
  for (const auto& [key, value] : full.items()) {
    if (key == "preset") continue;
    toml += key + " = " + value.dump() + "\n";
    settings.insert(settings.end(),
                    {"--set", key + "=" + (value.is_string() ? value.get<std::string>() : value.dump())});
  }
  write("full.toml", toml);
  EXPECT_EQ(result({"config", "--config", "full.toml"})["config"], full);
  EXPECT_EQ(result(settings)["config"], full);
}

TEST_F(ConfigCommand, WidthsComeWithTheirBounds) {
  const Json json = result({"config", "--widths"});
  ASSERT_FALSE(json["widths"].empty());
  const std::string text = run({"config", "--widths"}).out;
  for (const Json& width : json["widths"]) {
    EXPECT_GT(width["bits"], 0) << width;
    EXPECT_FALSE(width["bound"].get<std::string>().empty()) << width;
    EXPECT_NE(text.find(width["name"].get<std::string>()), std::string::npos) << width;
  }
}

TEST_F(ConfigCommand, EveryResultBeginsWithTheSameHead) {
  for (const Arguments& arguments :
       {Arguments{"render", "triangle"}, {"compare", "triangle"}, {"scenes"}, {"config"}}) {
    const Json json = result(arguments);
    EXPECT_EQ(json["schema"], "halfplane." + arguments[0] + "/1");
    EXPECT_EQ(json["config"]["preset"], "embedded") << arguments[0];
    EXPECT_TRUE(json.contains("scene") && json.contains("seed")) << arguments[0];
    EXPECT_TRUE(json["wall_s"].is_number()) << arguments[0];
  }
}

}  // namespace
}  // namespace halfplane::cli::compare_test
