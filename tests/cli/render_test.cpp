// `halfplane render`: the contents of stdout, stderr and the JSON result, and the effect of each option.
#include <set>

#include "program.hpp"

namespace halfplane::cli::render_test {
namespace {

class RenderCommand : public Cli {};

/// Keys of one object, each with its type: u unsigned, n number, s string, o object.
void expect_types(const Json& json, const std::vector<std::pair<std::string, char>>& keys) {
  for (const auto& [key, type] : keys) {
    ASSERT_TRUE(json.contains(key)) << key;
    const Json& value = json[key];
    const bool is_right = type == 'u'   ? value.is_number_unsigned()
                          : type == 'n' ? value.is_number()
                          : type == 's' ? value.is_string()
                                        : value.is_object();
    EXPECT_TRUE(is_right) << key << ": " << value;
  }
}

TEST_F(RenderCommand, ResultHasEveryKeyOfTheContractInItsType) {
  const Json json = result({"render", "walk", "--size", "96x64", "--repeat", "3"});
  expect_types(json, {{"schema", 's'},
                      {"config", 'o'},
                      {"scene", 's'},
                      {"seed", 'u'},
                      {"wall_s", 'n'},
                      {"engine", 's'},
                      {"width", 'u'},
                      {"height", 'u'},
                      {"skipped", 'o'},
                      {"primitives", 'o'},
                      {"fragments", 'o'},
                      {"samples_tested", 'u'},
                      {"time_s", 'o'},
                      {"frame_s", 'o'},
                      {"color_hash", 's'},
                      {"depth_hash", 's'}});
  expect_types(json["primitives"], {{"in", 'u'}, {"culled", 'u'}, {"drawn", 'u'}, {"clipped", 'u'}});
  expect_types(json["fragments"], {{"covered", 'u'}, {"depth_passed", 'u'}, {"alpha_killed", 'u'}, {"written", 'u'}});
  expect_types(json["skipped"], {{"frustum", 'u'},
                                 {"trivially_accepted", 'u'},
                                 {"backface", 'u'},
                                 {"zero_area", 'u'},
                                 {"empty", 'u'},
                                 {"tiles_outside", 'u'},
                                 {"tiles_hiz", 'u'},
                                 {"fragments_early_z", 'u'}});
  expect_types(json["time_s"], {{"load", 'n'}, {"geometry", 'n'}, {"raster", 'n'}});
  expect_types(json["frame_s"], {{"min", 'n'}, {"median", 'n'}});
  EXPECT_EQ(json["schema"], "halfplane.render/1");
  EXPECT_EQ(json["engine"], "functional");
  EXPECT_EQ(json["scene"], "walk");
  EXPECT_EQ(json["width"], 96);
  EXPECT_EQ(json["height"], 64);
  EXPECT_GT(json["frame_s"]["min"], 0.0);
  EXPECT_LE(json["frame_s"]["min"], json["frame_s"]["median"]);
  for (const char* key : {"color_hash", "depth_hash"}) {
    const std::string hash = json[key];
    EXPECT_EQ(hash.size(), 16u);
    EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos) << hash;
  }
}

TEST_F(RenderCommand, EveryPrimitiveIsCulledOrDrawn) {
  for (const char* scene : {"walk", "teapot", "city", "slivers", "coplanar"}) {
    const Json count = result({"render", scene, "--size", "160x120"})["primitives"];
    EXPECT_GT(count["drawn"], 0u) << scene;
    EXPECT_EQ(count["in"], count["culled"].get<unsigned>() + count["drawn"].get<unsigned>()) << scene;
    EXPECT_LE(count["clipped"], count["drawn"]) << scene;
  }
  EXPECT_GT(result({"render", "walk"})["primitives"]["clipped"], 0u) << "the walk crosses the near plane";
}

TEST_F(RenderCommand, HumanTextGoesToStdoutUnlessTheResultDoes) {
  const Outcome plain = run({"render", "triangle"});
  EXPECT_EQ(plain.status, 0);
  EXPECT_NE(plain.out.find("primitives"), std::string::npos);
  EXPECT_EQ(plain.err, "");

  const Outcome json = run({"render", "triangle", "--json"});
  EXPECT_EQ(json.status, 0);
  EXPECT_FALSE(Json::parse(json.out, nullptr, false).is_discarded()) << json.out;
  EXPECT_NE(json.err.find("primitives"), std::string::npos);
}

TEST_F(RenderCommand, JsonWithAFileNameWritesTheFileAndLeavesStdoutToPeople) {
  const Outcome outcome = run({"render", "triangle", "--json=result.json"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.out.find("primitives"), std::string::npos);
  EXPECT_EQ(outcome.err, "");
  const Json json = Json::parse(read("result.json"), nullptr, false);
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["schema"], "halfplane.render/1");
  expect_refused({"render", "triangle", "--json", "result.json"}, "result.json");  // a value after a space is none
}

TEST_F(RenderCommand, QuietSaysNothing) {
  const Outcome outcome = run({"render", "triangle", "--quiet", "-o", "picture.png"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  EXPECT_TRUE(exists("picture.png"));
}

TEST_F(RenderCommand, TextInAPipeHasNoEscapesAndNoProgress) {
  const Outcome outcome = run({"render", "teapot"});
  EXPECT_FALSE(outcome.out.empty());
  EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos);
  EXPECT_EQ(outcome.out.find('\r'), std::string::npos);
}

TEST_F(RenderCommand, TargetIsTheSizeAskedForOrTheCapturesOrWhatTheConfigurationTakes) {
  const auto size = [this](const Arguments& arguments) {
    const Json json = result(arguments);
    return std::pair<int, int>(json["width"], json["height"]);
  };
  write("small.hpt", "halfplane 1\ntarget 50 40\nclear color 1 2 3 255\n");
  EXPECT_EQ(size({"render", "triangle", "--size", "33x17"}), std::pair(33, 17));
  EXPECT_EQ(size({"render", "triangle", "--size", "1x1"}), std::pair(1, 1));
  EXPECT_EQ(size({"render", "triangle"}), std::pair(640, 480));
  EXPECT_EQ(size({"render", "triangle", "--config", "tiny"}), std::pair(16, 16));
  EXPECT_EQ(size({"render", "small.hpt"}), std::pair(50, 40));
  EXPECT_EQ(
      size({"render", "triangle", "--size", "16384x2", "--set", "target.width=16384", "--set", "guard.band=16384"}),
      std::pair(16384, 2));
}

TEST_F(RenderCommand, ConfigurationIsPresetThenFileThenSettings) {
  EXPECT_EQ(result({"render", "triangle"})["config"]["preset"], "embedded");
  EXPECT_EQ(result({"render", "triangle", "--config", "full"})["config"]["depth.bits"], 24);

  write("mine.toml", "preset = \"full\"\n[depth]\nbits = 20\n[subpixel]\nbits = 5\n");
  const Json json = result({"render", "triangle", "--config", "mine.toml", "--set", "depth.bits=19"})["config"];
  EXPECT_EQ(json["preset"], "full");
  EXPECT_EQ(json["depth.bits"], 19);
  EXPECT_EQ(json["subpixel.bits"], 5);
  EXPECT_EQ(json["color.format"], "rgba8888");
  EXPECT_EQ(result({"render", "triangle", "--set", "depth.bits=18", "--set", "depth.bits=17"})["config"]["depth.bits"],
            17);
}

TEST_F(RenderCommand, SeedIsEchoedAndChangesARandomScene) {
  const Json first = result({"render", "slivers", "--seed", "1"}),
             second = result({"render", "slivers", "--seed", "2"});
  EXPECT_EQ(first["seed"], 1u);
  EXPECT_EQ(second["seed"], 2u);
  EXPECT_NE(first["color_hash"], second["color_hash"]);
  EXPECT_EQ(result({"render", "slivers"})["color_hash"], first["color_hash"]);
  EXPECT_EQ(result({"render", "slivers", "--seed", "18446744073709551615"})["seed"], 18446744073709551615u);
  EXPECT_EQ(result({"render", "triangle", "--seed", "010"})["seed"], 10u);  // decimal, as printed
  EXPECT_NE(run({"render", "slivers", "--seed", "77"}).out.find("seed 77"), std::string::npos);
}

TEST_F(RenderCommand, CameraMovesAMesh) {
  const auto hash = [this](const std::string& camera) {
    return result({"render", "teapot", "--size", "80x60", "--camera", camera})["color_hash"];
  };
  const std::set<Json> hashes{hash("eye=0,1,9;target=0,0,0;up=0,1,0;fov=45;near=.1;far=100"), hash("eye=1,1,9"),
                              hash("ortho=5"), hash("fov=20;eye=0,1,9")};
  EXPECT_EQ(hashes.size(), 4u);
}

TEST_F(RenderCommand, FramesAreTimedOnlyOnRequest) {
  EXPECT_FALSE(result({"render", "triangle"}).contains("frame_s"));
  EXPECT_NE(run({"render", "triangle", "--repeat", "2"}).out.find("median"), std::string::npos);
}

TEST_F(RenderCommand, ScalarEngineEqualsFunctionalInImagesAndProgramOrderCounts) {
  for (const char* scene : {"teapot", "walk", "slivers:80"}) {
    for (const char* config : {"tiny", "embedded", "full"}) {
      const Arguments base{"render", scene, "--config", config, "--size", "16x16"};
      Arguments scalar = base;
      scalar.insert(scalar.end(), {"--engine", "scalar"});
      const Json a = result(base), b = result(scalar);
      EXPECT_EQ(b["engine"], "scalar");
      for (const char* key : {"color_hash", "depth_hash", "primitives"}) EXPECT_EQ(a[key], b[key]) << scene << config;
      for (const char* key : {"depth_passed", "written"})
        EXPECT_EQ(a["fragments"][key], b["fragments"][key]) << scene << config;
      EXPECT_GT(a["fragments"]["written"], 0u) << scene << config;
    }
  }
}

TEST_F(RenderCommand, SkippingWorkChangesNoImageAndIsCounted) {
  const Json all = result({"render", "walk", "--skip", "all"});
  for (const char* skip :
       {"none", "frustum", "empty", "tiles_outside", "trivially_accepted", "fragments_early_z", "frustum,empty"}) {
    const Json some = result({"render", "walk", "--skip", skip});
    for (const char* key : {"color_hash", "depth_hash"}) EXPECT_EQ(all[key], some[key]) << skip;
    for (const char* key : {"depth_passed", "written"})
      EXPECT_EQ(all["fragments"][key], some["fragments"][key]) << skip;
  }
  const Json none = result({"render", "walk", "--skip", "none"});
  EXPECT_GT(none["samples_tested"], all["samples_tested"]);
  for (const char* key : {"tiles_outside", "trivially_accepted"}) {
    EXPECT_GT(all["skipped"][key], 0u) << key;
    EXPECT_EQ(none["skipped"][key], 0u) << key;
  }
}

TEST_F(RenderCommand, TextSaysWhyFewerSamplesAreTestedThanCovered) {
  const Json all = result({"render", "walk"});
  ASSERT_LT(all["samples_tested"], all["fragments"]["covered"]);
  const std::string part = "tiles inside a triangle are covered untested";
  EXPECT_NE(run({"render", "walk"}).out.find(part), std::string::npos);
  EXPECT_EQ(run({"render", "walk", "--skip", "none"}).out.find(part), std::string::npos);
  EXPECT_NE(run({"render", "wires", "--size", "64x48"}).out.find("lines and points are covered untested"),
            std::string::npos);
}

TEST_F(RenderCommand, ThreadsChangeNoImage) {
  const Json one = result({"render", "teapot", "--threads", "1"}),
             four = result({"render", "teapot", "--threads", "4"});
  EXPECT_EQ(one["threads"], 1);
  EXPECT_EQ(four["threads"], 4);
  for (const char* key : {"color_hash", "depth_hash", "fragments"}) EXPECT_EQ(one[key], four[key]);
}

TEST_F(RenderCommand, EnginesDrawWhatTheHardwareDoesNot) {
  write("perspective.hpt",
        "halfplane 1\ntarget 8 8\nclear color 0 0 0 255 depth 1\nstate color_interp perspective\n"
        "v -1 -1 0 1 255 0 0 255\nv 1 -1 0 1 0 255 0 255\nv 0 1 0 1 0 0 255 255\nt 0 1 2\n");
  for (const char* engine : {"golden", "golden32", "scalar", "functional"})
    EXPECT_GT(result({"render", "perspective.hpt", "--engine", engine})["fragments"]["written"], 0u) << engine;
  expect_refused({"render", "perspective.hpt", "--engine", "cycle"}, "state color_interp perspective");
  EXPECT_GT(result({"compare", "perspective.hpt"})["datapath"]["color_over_w_lsb"]["count"], 0);
}

TEST_F(RenderCommand, WhatTheModelHasNotYetIsNamed) {
  for (const char* engine : {"tracer", "nonsense", ""})
    expect_refused({"render", "triangle", "--engine", engine}, std::string("no engine '") + engine + "'");
}

}  // namespace
}  // namespace halfplane::cli::render_test
