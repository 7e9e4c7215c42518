// glTF files as SCENE: the picture, the cameras of the file, and the messages for broken files.
#include "program.hpp"
#include "tests/gltf_builder.hpp"

namespace halfplane::cli::gltf_test {
namespace {

class GltfScene : public Cli {
 protected:
  // A triangle of three colours, with two cameras of different height.
  static test::GltfBuilder two_cameras() {
    test::GltfBuilder builder = test::one_triangle();
    builder.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        builder.accessor(test::GltfBuilder::u8, 3, {255, 0, 0, 0, 255, 0, 0, 0, 255}, true);
    for (const double height : {1, 3}) {
      builder.json["cameras"].push_back(
          {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", height}, {"znear", 1}, {"zfar", 9}}}});
    }
    builder.root({{"camera", 0}, {"name", "near"}, {"translation", {0, 0, 5}}});
    builder.root({{"camera", 1}, {"name", "wide"}, {"translation", {0, 0, 5}}});
    return builder;
  }
};

TEST_F(GltfScene, BothContainersGiveOneImageAndNamedCamerasAnother) {
  write("a.gltf", two_cameras().text());
  write("a.glb", two_cameras().glb());
  const auto rendered = [this](const std::string& file, const Arguments& camera) {
    Arguments arguments{"render", file, "--size", "96x96"};
    arguments.insert(arguments.end(), camera.begin(), camera.end());
    return result(arguments);
  };
  const Json first = rendered("a.gltf", {});
  EXPECT_EQ(first["primitives"]["drawn"], 1);
  EXPECT_EQ(first["fragments"]["covered"].get<int>(), 48 * 47 / 2);  // legs of 48 px, half-open on the long side
  EXPECT_EQ(rendered("a.glb", {})["color_hash"], first["color_hash"]);
  EXPECT_EQ(rendered("a.glb", {"--camera", "name=near"})["color_hash"], first["color_hash"]);
  EXPECT_EQ(rendered("a.glb", {"--camera", "name=wide"})["fragments"]["covered"].get<int>(), 16 * 15 / 2);
  EXPECT_NE(rendered("a.glb", {"--camera", "fov=45"})["depth_hash"], first["depth_hash"]);
}

TEST_F(GltfScene, ABrokenFileOrAnUnknownCameraIsRefusedInOneLine) {
  write("good.gltf", two_cameras().text());
  write("cut.glb", two_cameras().glb().substr(0, 100));
  write("empty.glb", "");
  test::GltfBuilder lines = two_cameras();
  lines.json["meshes"][0]["primitives"][0]["mode"] = 1;
  write("lines.gltf", lines.text());
  write("alone.gltf", two_cameras().with_uri("gone.bin"));
  expect_refused({"render", "cut.glb"}, "cut.glb: a .glb of");
  expect_refused({"render", "empty.glb"}, "empty.glb:1: not JSON");
  expect_refused({"compare", "lines.gltf"}, "3 corners make no whole lines");
  expect_refused({"render", "alone.gltf"}, "'gone.bin' cannot be read");
  expect_refused({"render", "good.gltf", "--camera", "name=far"},
                 "no camera 'far' in this scene; there are near, wide");
}

}  // namespace
}  // namespace halfplane::cli::gltf_test
