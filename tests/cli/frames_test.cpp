// `halfplane render --frames`: scenes that move, a numbered file for each frame, figures as CSV and a page.
#include <fstream>
#include <set>

#include "program.hpp"
#include "tests/gltf_builder.hpp"

namespace halfplane::cli {
namespace {

class Frames : public Cli {
 protected:
  /// A triangle that goes 4 to the right within 2 s, before a camera that stands still.
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
  // Without --time all of the animation; at rest the file as it is, which is how it stands half way.
  EXPECT_EQ(result({"render", "move.gltf", "--size", "48x48", "--frames", "4"})["frames"][3]["time"], 1.5);
  EXPECT_EQ(result({"render", "move.gltf", "--size", "48x48"})["color_hash"], all["frames"][2]["color_hash"]);
}

// A camera that the file does not have is framed around all of the motion, not around each frame.
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
  expect_refused({"render", "move.gltf", "--frames", "2", "--chart", "t.txt"}, "this file is a .html");
}

TEST_F(Frames, TheOtherCommandsSeeTheSceneAtATime) {
  write_moving();
  const Json picture = result({"render", "move.gltf", "--size", "32x32", "--time", "1.5"});
  ASSERT_EQ(run({"convert", "move.gltf", "--size", "32x32", "--time", "1.5", "-o", "t.hpt"}).status, 0);
  EXPECT_EQ(result({"render", "t.hpt"})["color_hash"], picture["color_hash"]);
  EXPECT_EQ(result({"compare", "move.gltf", "--size", "32x32", "--time", "1.5"})["coverage"]["oracle_mismatches"], 0);
}

}  // namespace
}  // namespace halfplane::cli
