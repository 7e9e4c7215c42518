// `halfplane render --frames`: scenes that move, a numbered file for each frame, figures as CSV and a page.
#include <fstream>
#include <set>

#include "program.hpp"
#include "tests/gltf_builder.hpp"

namespace halfplane::cli::frames_test {
namespace {

class Frames : public Cli {
 protected:
  /// A triangle that moves 4 to the right within 2 s, in front of a fixed camera.
  void write_moving() const {
    test::GltfBuilder b = test::one_triangle();
    const std::size_t input = b.accessor(test::GltfBuilder::f32, 1, {0, 2});
    const std::size_t output = b.accessor(test::GltfBuilder::f32, 3, {-2, 0, 0, 2, 0, 0});
    b.json["animations"] = {{{"samplers", {{{"input", input}, {"output", output}}}},
                             {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    b.json["cameras"] = {
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 3}, {"ymag", 3}, {"znear", 1}, {"zfar", 9}}}}};
    b.root({{"camera", 0}, {"translation", {0, 0, 5}}});
    write("move.gltf", b.text());
  }

  [[nodiscard]] std::string text_of(const std::string& file) const {
    std::ifstream in(folder_ / file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(Frames, EachIsThePictureOfItsOwnTime) {
  write_moving();
  const Json all = result({"render", "move.gltf", "--size", "48x48", "--frames", "4", "--time", "0..2", "-o", "a.png"});
  ASSERT_EQ(all["frames"].size(), 4u);
  std::set<std::string> hashes;
  for (int i = 0; i < 4; ++i) {
    const Json& frame = all["frames"][static_cast<std::size_t>(i)];
    EXPECT_EQ(frame["time"], 0.5 * i);
    const std::string number = std::to_string(i);
    const Json one =
        result({"render", "move.gltf", "--size", "48x48", "--time", frame["time"].dump(), "-o", "one.png"});
    EXPECT_EQ(frame["color_hash"], one["color_hash"]) << i;
    EXPECT_EQ(text_of("a-000" + number + ".png"), text_of("one.png")) << i;
    hashes.insert(frame["color_hash"].get<std::string>());
  }
  EXPECT_EQ(hashes.size(), 4u);
  // Without --time all of the animation; a still picture shows the file at rest, equal to half way.
  EXPECT_EQ(result({"render", "move.gltf", "--size", "48x48", "--frames", "4"})["frames"][3]["time"], 1.5);
  EXPECT_EQ(result({"render", "move.gltf", "--size", "48x48"})["color_hash"], all["frames"][2]["color_hash"]);
}

// A default camera frames all of the motion, not each frame.
TEST_F(Frames, WhatMovesIsSeenToMove) {
  test::GltfBuilder b = test::one_triangle();
  const std::size_t input = b.accessor(test::GltfBuilder::f32, 1, {0, 2});
  const std::size_t output = b.accessor(test::GltfBuilder::f32, 3, {-2, 0, 0, 2, 0, 0});
  b.json["animations"] = {{{"samplers", {{{"input", input}, {"output", output}}}},
                           {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
  write("move.gltf", b.text());
  const Json all = result({"render", "move.gltf", "--size", "48x48", "--frames", "4"});
  std::set<std::string> hashes;
  for (const Json& frame : all["frames"]) {
    EXPECT_GT(frame["fragments"]["written"], 5);
    hashes.insert(frame["color_hash"].get<std::string>());
    const Json one = result({"render", "move.gltf", "--size", "48x48", "--time", frame["time"].dump()});
    EXPECT_EQ(one["color_hash"], frame["color_hash"]);
  }
  EXPECT_EQ(hashes.size(), 4U);
}

TEST_F(Frames, AnOrbitGoesRoundOnceAndKeepsItsDistance) {
  const auto hash = [this](const std::string& camera) {
    return result({"render", "teapot:2", "--size", "64x48", "--camera", camera})["color_hash"];
  };
  const Json all = result({"render", "teapot:2", "--size", "64x48", "--frames", "3", "--camera", "orbit"});
  EXPECT_EQ(all["frames"][0]["color_hash"], hash("orbit=0"));
  EXPECT_EQ(all["frames"][1]["color_hash"], hash("orbit=120"));
  EXPECT_EQ(all["frames"][2]["color_hash"], hash("orbit=240"));
  EXPECT_NE(all["frames"][1]["color_hash"], all["frames"][2]["color_hash"]);
  EXPECT_TRUE(all["frames"][0]["time"].is_null());
}

TEST_F(Frames, CyclesAndBytesStandInTheTableOfEachFrame) {
  write_moving();
  const Json all = result({"render", "move.gltf", "--size", "48x48", "--frames", "3", "--engine", "cycle", "--csv",
                           "t.csv", "--chart", "t.html"});
  const auto lines = lines_of(text_of("t.csv"));
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0].rfind("frame,time,turn,primitives.in,", 0), 0u) << lines[0];
  for (std::size_t i = 0; i < 3; ++i) {
    const Json& frame = all["frames"][i];
    EXPECT_GT(frame["cycles"], 0);
    EXPECT_GT(frame["bytes"], 0);
    EXPECT_NE(lines[i + 1].find("," + frame["cycles"].dump() + "," + frame["bytes"].dump() + ","), std::string::npos);
    const Json one =
        result({"render", "move.gltf", "--size", "48x48", "--engine", "cycle", "--time", frame["time"].dump()});
    EXPECT_EQ(frame["cycles"], one["cycles"]);
  }
  EXPECT_NE(text_of("t.html").find("\"halfplane.frames/1\""), std::string::npos);
}

TEST_F(Frames, WhatHasNoMeaningIsRefusedInOneLine) {
  write_moving();
  expect_refused({"render", "teapot:2", "--frames", "3"}, "nothing moves in teapot:2");
  expect_refused({"render", "teapot:2", "--time", "1"}, "teapot:2 has no animations");
  expect_refused({"render", "teapot:2", "--animation", "0"}, "teapot:2 has no animations");
  expect_refused({"render", "move.gltf", "--time", "0..2"}, "for render --frames");
  expect_refused({"render", "move.gltf", "--frames", "2", "--time", "2..1"}, "'2..1' is no time");
  expect_refused({"render", "move.gltf", "--time", "-1"}, "'-1' is no time");
  expect_refused({"render", "move.gltf", "--animation", "run"}, "no animation 'run' in this scene; there are 0");
  expect_refused({"render", "move.gltf", "--csv", "t.csv"}, "add --frames N");
  expect_refused({"render", "move.gltf", "--frames", "2", "--repeat", "3"}, "leave out --repeat");
  expect_refused({"render", "move.gltf", "--frames", "2", "-o", "-"}, "several files do not fit on stdout");
  expect_refused({"render", "move.gltf", "--frames", "2", "--chart", "t.txt"}, "this option writes .html files");
}

TEST_F(Frames, TheOtherCommandsSeeTheSceneAtATime) {
  write_moving();
  const Json picture = result({"render", "move.gltf", "--size", "32x32", "--time", "1.5"});
  ASSERT_EQ(run({"convert", "move.gltf", "--size", "32x32", "--time", "1.5", "-o", "t.hpt"}).status, 0);
  EXPECT_EQ(result({"render", "t.hpt"})["color_hash"], picture["color_hash"]);
  EXPECT_EQ(result({"compare", "move.gltf", "--size", "32x32", "--time", "1.5"})["coverage"]["oracle_mismatches"], 0);
}

/// Three frames with areas counted by hand: a square of 20 x 10 pixels; beside it, on the same picture, a square of 5 x
/// 4; a new picture with a square of 8 x 8.
class CaptureFrames : public Frames {
 protected:
  static constexpr const char* kHead = "halfplane 1\ntarget 48 40\nspace window\n";
  static constexpr const char* kFirst =
      "clear color 10 20 30 255 depth 1\nv 4 4 0.5 1 255 0 0 255\nv 24 4 0.5 1 255 0 0 255\nv 4 14 0.5 1 255 0 0 255\n"
      "v 24 14 0.5 1 0 255 0 255\nts 0 1 2 3\n";
  static constexpr const char* kSecond =
      "v 30 4 0.25\nv 35 4 0.25\nv 30 8 0.25\nv 35 8 0.25\nstate depth_test lequal\nts 4 5 6 7\nl 4 3\n";
  /// The first texture and the first vertices belong to other frames.
  static constexpr const char* kThird =
      "clear color 0 0 0 255\nclear depth 1\nv 20 20 0.5\na normal 0 0 1\nv 28 20 0.5\na normal 1 0 1\nv 20 28 0.5\n"
      "v 28 28 0.5\na normal 0 1 1\ntexture A inline l8 1 1\ntexels 40\ntexture B inline l8 2 1\ntexels 80ff\n"
      "state texture B\nstate shade phong\nts 8 9 10 11\n";

  void write_captures() const {
    const std::string head = kHead, first = kFirst, second = kSecond, third = kThird;
    write("game.hpt", head + first + "frame\n" + second + "frame\n" + third + "frame\n");
    write("open.hpt", head + first + "frame\n" + second + "frame\n" + third);
    write("cleared.hpt", head + first + "frame\n" + "clear color 1 2 3 255 depth 1\n" + second + "frame\n");
    write("one.hpt", head + first);
    write("two.hpt", head + first + second);
    write("three.hpt", head + first + second + third);
    write("second.hpt", head + first + "clear color 1 2 3 255 depth 1\n" + second);
  }
};

TEST_F(CaptureFrames, EachIsThePictureAtItsEnd) {
  write_captures();
  const std::vector<std::string> wholes{"one.hpt", "two.hpt", "three.hpt"};
  const std::vector<std::vector<std::string>> variants{
      {}, {"--threads", "3"}, {"--engine", "scalar"}, {"--ids", "ids.npy"}, {"--set", "msaa.samples=4"}};
  for (const std::string capture : {"game.hpt", "open.hpt"})
    for (const std::vector<std::string>& variant : variants) {
      const auto with = [&variant](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), variant.begin(), variant.end());
        return arguments;
      };
      const Json all = result(with({"render", capture, "--frames", "all", "-o", "a.png"}));
      ASSERT_EQ(all["frames"].size(), 3u) << capture;
      for (std::size_t i = 0; i < 3; ++i) {
        const Json one = result(with({"render", wholes[i], "-o", "one.png"}));
        const Json& frame = all["frames"][i];
        EXPECT_EQ(frame["color_hash"], one["color_hash"]) << capture << i << testing::PrintToString(variant);
        EXPECT_EQ(frame["depth_hash"], one["depth_hash"]) << capture << i << testing::PrintToString(variant);
        EXPECT_EQ(text_of("a-000" + std::to_string(i) + ".png"), text_of("one.png"));
        EXPECT_EQ(frame["goes_on"], i == 1);
        EXPECT_EQ(frame["frame"], i);
        EXPECT_TRUE(frame["time"].is_null());
      }
      EXPECT_EQ(all["frames"][0]["primitives"]["in"], 2);
      EXPECT_EQ(all["frames"][1]["primitives"]["in"], 3);
      if (!variant.empty() && variant.back() == "msaa.samples=4") continue;  // fragments are then samples
      EXPECT_EQ(all["frames"][0]["fragments"]["written"], 20 * 10);
      EXPECT_EQ(all["frames"][2]["fragments"]["written"], 8 * 8);
    }
  EXPECT_EQ(result({"render", "game.hpt"})["color_hash"], result({"render", "three.hpt"})["color_hash"])
      << "without --frames the picture at the end";
  const Json two = result({"render", "game.hpt", "--frames", "2"});
  EXPECT_EQ(two["frames"].size(), 2u);
}

TEST_F(CaptureFrames, TheStencilOfTheFrameBeforeIsKept) {
  const std::string head = kHead, first = kFirst;
  // The second frame clears colour and depth, and draws where the first frame left stencil 7.
  const std::string mark = "clear stencil 0\nstate stencil always 7 255 255 keep keep replace\n" + first,
                    use =
                        "clear color 9 9 9 255 depth 1\nstate stencil equal 7 255 255 keep keep keep\n"
                        "v 0 0 0.5\nv 48 0 0.5\nv 0 40 0.5\nv 48 40 0.5\nts 4 5 6 7\n";
  write("marked.hpt", head + mark + "frame\n" + use);
  const Json all = result({"render", "marked.hpt", "--frames", "all"});
  EXPECT_EQ(all["frames"][1]["goes_on"], true);
  EXPECT_EQ(all["frames"][1]["fragments"]["written"], 20 * 10);
}

TEST_F(CaptureFrames, HardwareAndGoldenDrawThoseThatBeginWithAClear) {
  write_captures();
  const Json cleared = result({"render", "second.hpt"});
  for (const char* engine : {"cycle", "golden"}) {
    const Json all = result({"render", "cleared.hpt", "--frames", "2", "--engine", engine});
    EXPECT_EQ(all["frames"][0]["fragments"]["written"], 20 * 10) << engine;
    EXPECT_EQ(all["frames"][1]["goes_on"], false);
    if (engine != std::string("golden")) {
      EXPECT_EQ(all["frames"][1]["color_hash"], cleared["color_hash"]) << engine;
      EXPECT_GT(all["frames"][1]["cycles"], 0);
    }
    expect_refused({"render", "game.hpt", "--frames", "all", "-o", "a.png", "--engine", engine},
                   "game.hpt: frame 1 draws on the picture of frame 0");
  }
  expect_refused({"render", "game.hpt", "--frames", "2", "--supersample", "2x2"}, "without --supersample");
}

TEST_F(CaptureFrames, TheRtlDrawsThoseThatBeginWithAClear) {
  skip_without_rtl();
  if (IsSkipped()) return;
  write_captures();
  const Json all = result({"render", "cleared.hpt", "--frames", "all", "--engine", "rtl"});
  EXPECT_EQ(all["frames"][1]["color_hash"], result({"render", "second.hpt"})["color_hash"]);
  expect_refused({"render", "game.hpt", "--frames", "all", "--engine", "rtl"}, "which the engine rtl does not keep");
}

TEST_F(CaptureFrames, ANumberThatItDoesNotHaveIsRefused) {
  write_captures();
  expect_refused({"render", "game.hpt", "--frames", "4"}, "--frames 4: game.hpt has 3 frames; give at most so many");
  expect_refused({"render", "one.hpt", "--frames", "2"}, "--frames 2: one.hpt has 1 frame;");
  expect_refused({"render", "teapot:2", "--frames", "all", "--camera", "orbit"}, "--frames all: that is for captures");
  expect_refused({"render", "game.hpt", "--frames", "-1"}, "--frames");
  expect_refused({"render", "game.hpt", "--frames", "some"}, "--frames");
  EXPECT_EQ(result({"render", "one.hpt", "--frames", "all"})["frames"].size(), 1u);
}

}  // namespace
}  // namespace halfplane::cli::frames_test
