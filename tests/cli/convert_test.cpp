// `halfplane convert`: any scene as a capture that draws the same picture.

#include "model/capture/capture.hpp"
#include "model/engines/functional.hpp"
#include "program.hpp"
#include "sim/cosim/session.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/load.hpp"
#include "sim/show/image/png.hpp"
#include "tests/gltf_builder.hpp"

namespace halfplane::cli::convert_test {
namespace {

class ConvertCommand : public Cli {
 protected:
  /// The hashes of the picture and its depths.
  [[nodiscard]] std::pair<std::string, std::string> hashes(const Arguments& scene) const {
    Arguments words{"render"};
    words.insert(words.end(), scene.begin(), scene.end());
    const Json json = result(words);
    return {json["color_hash"], json["depth_hash"]};
  }

  void expect_same(const std::string& scene, const std::string& options) const {
    const Arguments words = split_words(scene + " " + options);
    Arguments convert{"convert"};
    convert.insert(convert.end(), words.begin(), words.end());
    convert.insert(convert.end(), {"-o", "out.hpt"});
    const Outcome outcome = run(convert);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(hashes(words), hashes({"out.hpt"})) << scene << " " << options;
  }
};

TEST_F(ConvertCommand, AFileOfEveryKindDrawsTheSame) {
  write("mesh.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\n");
  write(
      "in.hpt",
      "halfplane 1\ntarget 40 30\nclear color 9 9 9 255 depth 0.5\nspace window\nobject a b\nv 1 1 0.25\nv 39 2 0.5 1 "
      "255 0 0 255\nv 20 29 0.1\nt 0 1 2\nstate depth_test greater\nl 0 1\nframe\np 2\n");
  expect_same("mesh.obj", "--size 60x50 --camera eye=1,2,3");
  expect_same("in.hpt", "");
  expect_same("teapot:4", "--size 64x48 --convention d3d");
  expect_same("dust:300", "--size 64x48 --seed 5");
  expect_same("objects:20", "--size 64x48 --cull-objects both");
}

TEST_F(ConvertCommand, ATexturedMeshKeepsItsImagesInTheCapture) {
  Picture image(5, 4);
  for (int i = 0; i < 20; ++i) set_pixel(image, i % 5, i / 5, {static_cast<std::uint8_t>(12 * i), 90, 200});
  write_png((folder_ / "a.png").string(), image);
  write("a.mtl", "newmtl m\nmap_Kd -s 3 2 a.png\n");
  write("a.obj", "mtllib a.mtl\nusemtl m\nv -1 0 2\nv 1 0 2\nv 0 0 -9\nvt 0 0\nvt 1 0\nvt 0 4\nf 1/1 2/2 3/3\n");
  test::GltfBuilder builder = test::one_triangle();
  Json& primitive = builder.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_0"] = builder.accessor(test::GltfBuilder::f32, 2, {0, 0, 2, 0, 0, 3});
  primitive["material"] = 0;
  builder.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  builder.json["textures"] = {{{"source", 0}}};
  builder.json["images"] = {{{"uri", "a.png"}}};
  write("a.glb", builder.glb());
  expect_same("a.obj", "--size 60x50 --camera eye=0,0.5,1;target=0,0,-3;near=0.1;far=20");  // clipped
  expect_same("a.glb", "--size 60x50");
  std::filesystem::remove(folder_ / "a.png");
  expect_refused({"render", "a.glb"}, "images[0].uri: 'a.png' cannot be read; put it beside the glTF file");
  const Outcome plain = run({"render", "a.obj", "--size", "20x20"});
  EXPECT_EQ(plain.status, 0);
  EXPECT_NE(plain.err.find("a.mtl:2: map_Kd 'a.png': there is no such file"), std::string::npos) << plain.err;
}

TEST_F(ConvertCommand, ADepthMappingIsLeftToWhoDrawsTheCapture) {
  for (const char* mapping : {"rev", "w"}) {
    const std::string set = std::string("--set depth.mapping=") + mapping;
    ASSERT_EQ(run(split_words("convert teapot:3 --size 64x48 -o m.hpt " + set)).status, 0);
    EXPECT_EQ(hashes(split_words("teapot:3 --size 64x48 " + set)), hashes(split_words("m.hpt " + set))) << mapping;
  }
}

TEST_F(ConvertCommand, ANameThatIsNotUtf8IsNoReasonToFail) {
  const Outcome outcome = run({"convert", "triangle", "--size", "20x20", "-o", "o\xff.hpt", "--json=r.json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const Bytes bytes = read("r.json");
  EXPECT_FALSE(Json::parse(bytes.begin(), bytes.end(), nullptr, false).is_discarded());
}

/// Every built-in scene, in several sizes, with several seeds, and the random stimulus of cosim: 200 and more.
TEST_F(ConvertCommand, TwoHundredCapturesOfEverySceneRenderToTheSameHashes) {
  int captures = 0;
  const auto expect_equal = [&captures](const Scene& scene, const Config& config) {
    std::ostringstream text;
    write_capture(scene, text);
    const Scene again = read_capture(text.str(), "again.hpt");
    const Rendering a = render_functional(scene, config), b = render_functional(again, config);
    EXPECT_EQ(a.frame.color, b.frame.color) << scene.name << ", " << scene.width;
    EXPECT_EQ(a.frame.depth, b.frame.depth) << scene.name << ", " << scene.width;
    ++captures;
  };
  for (const Builtin& builtin : all_builtin_scenes()) {
    std::string name(builtin.name);
    if (!builtin.size.empty())
      name += ":" + std::to_string(std::min(builtin.default_size, std::max(builtin.min_size, 40)));
    for (const int width : {33, 64, 100})
      for (const std::uint64_t seed : {1, 2})
        expect_equal(make_builtin(name, width, width / 2, {}, seed), preset(width == 64 ? "full" : "embedded"));
  }
  for (const char* name : {"tiny", "small", "embedded", "full"}) {
    const Config config = preset(name);
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      const SceneSource next = random_scenes(config, seed, 150);
      while (const auto scene = next()) expect_equal(*scene, config);
    }
  }
  EXPECT_GE(captures, 200);
}

TEST_F(ConvertCommand, RandomIsTheStimulusOfCosim) {
  ASSERT_EQ(run(split_words("convert --random 120 --seed 9 --config tiny -o r.hpt")).status, 0);
  EXPECT_TRUE(exists("r-1.hpt") && exists("r-2.hpt"));
  EXPECT_FALSE(exists("r.hpt"));
  const SceneSource next = random_scenes(preset("tiny"), 9, 120);
  for (const char* name : {"r-1.hpt", "r-2.hpt"}) {
    std::ostringstream text;
    write_capture(*next(), text);
    const Bytes bytes = read(name);
    EXPECT_EQ(text.str(), std::string(bytes.begin(), bytes.end()));
  }
  ASSERT_EQ(run(split_words("convert --random 20 -o one.hpt")).status, 0);
  EXPECT_TRUE(exists("one.hpt"));
}

TEST_F(ConvertCommand, OneSceneOfARandomRunIsThatOfTheWholeRun) {
  const std::string knobs = " --random 400 --seed 9 --config tiny --random-only triangles,less,9x7 -o ";
  ASSERT_EQ(run(split_words("convert" + knobs + "all.hpt")).status, 0);
  ASSERT_EQ(run(split_words("convert --first-scene 3 --scenes 1" + knobs + "one.hpt")).status, 0);
  ASSERT_EQ(run(split_words("convert --first-scene 2 --scenes 2" + knobs + "two.hpt")).status, 0);
  EXPECT_EQ(read("all-3.hpt"), read("one.hpt"));
  EXPECT_EQ(read("all-2.hpt"), read("two-2.hpt"));
  EXPECT_EQ(read("all-3.hpt"), read("two-3.hpt"));
  expect_refused(split_words("convert --first-scene 9" + knobs + "none.hpt"), "make fewer than 9 scenes");
  expect_refused({"convert", "triangle", "--random-only", "less", "-o", "a.hpt"}, "add --random N");
  expect_refused(split_words("convert --random 9 --config small --random-only lines -o a.hpt"), "set lines.unit=1");
}

TEST_F(ConvertCommand, StdoutTakesTheCaptureAndNothingElse) {
  const Outcome to_stdout = run(split_words("convert triangle --size 20x20 -o -"));
  ASSERT_EQ(to_stdout.status, 0) << to_stdout.err;
  EXPECT_EQ(lines_of(to_stdout.err).size(), 1U) << "the text for people";
  ASSERT_EQ(run(split_words("convert triangle --size 20x20 -o t.hpt")).status, 0);
  const Bytes bytes = read("t.hpt");
  EXPECT_EQ(to_stdout.out, std::string(bytes.begin(), bytes.end()));
  EXPECT_EQ(listing(), std::vector<std::string>{"t.hpt"});
}

TEST_F(ConvertCommand, BadRequestsGetOneLine) {
  expect_refused({"convert", "triangle"}, "-o");
  expect_refused({"convert", "-o", "a.hpt"}, "nothing to convert");
  expect_refused({"convert", "triangle", "--random", "5", "-o", "a.hpt"}, "leave one of them out");
  expect_refused({"convert", "triangle", "-o", "a.png"}, ".hpt");
  expect_refused({"convert", "--random", "500", "-o", "-"}, "several scenes");
  expect_refused({"convert", "triangle", "-o", "-", "--json"}, "stdout");
}

}  // namespace
}  // namespace halfplane::cli::convert_test
