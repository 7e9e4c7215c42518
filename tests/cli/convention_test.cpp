// --convention and --cull-objects, as typed.
#include "program.hpp"

namespace halfplane::cli::convention_test {
namespace {

class ConventionOption : public Cli {};
class CullObjectsOption : public Cli {};

TEST_F(ConventionOption, EachGivesTheSamePictureOfAMeshAndOfAWindowSpaceCapture) {
  write("window.hpt",
        "halfplane 1\ntarget 32 24\nclear color 0 0 40 255 depth 1\nspace window\n"
        "state scissor 2 3 27 17\n"
        "v 2.5 1.25 0.25 1 255 0 0 255\nv 30.5 7.0625 0.5 1 0 255 0 255\nv 9.5 22.5 0.75 1 0 0 255 255\nt 0 1 2\n");
  for (const char* scene : {"knot:24", "window.hpt"}) {
    const Json gl = result({"render", scene, "--convention", "gl"});
    for (const char* name : {"gl:standard", "d3d", "mit3dcg", "fcg:standard", "fcg", "d3d:reversed"}) {
      const Json json = result({"render", scene, "--convention", name});
      EXPECT_EQ(json["color_hash"], gl["color_hash"]) << scene << " " << name;
      EXPECT_EQ(json["primitives"], gl["primitives"]) << scene << " " << name;
      const bool is_reversed = std::string(name) == "fcg" || std::string(name) == "d3d:reversed";
      EXPECT_EQ(json["depth_hash"] == gl["depth_hash"], !is_reversed) << scene << " " << name;
    }
  }
}

TEST_F(ConventionOption, CompareFindsNoErrorThatGlHasNot) {
  const Json gl = result({"compare", "teapot:4", "--size", "96x64"});
  for (const char* name : {"d3d", "mit3dcg", "fcg"}) {
    const Json json = result({"compare", "teapot:4", "--size", "96x64", "--convention", name});
    EXPECT_EQ(json["coverage"]["oracle_mismatches"], 0u) << name;
    EXPECT_NEAR(json["depth_lsb"]["max"].get<double>(), gl["depth_lsb"]["max"].get<double>(), 1.0) << name;
  }
}

TEST_F(ConventionOption, ACaptureMaySayItItself) {
  const std::string head = "halfplane 1\ntarget 8 6\nspace window\n";
  write("half.hpt", head + "v 1 1 0.5\nv 7 1 0.5\nv 1 5.5 0.5\nt 0 1 2\n");
  write("integer.hpt", head +
                           "state pixel_center integer\nstate origin bottom_left\n"
                           "v 0.5 4.5 0.5\nv 6.5 4.5 0.5\nv 0.5 0 0.5\nt 0 1 2\n");
  EXPECT_EQ(result({"render", "half.hpt"})["color_hash"], result({"render", "integer.hpt"})["color_hash"]);
}

TEST_F(ConventionOption, ANameThatIsNoneIsRefusedWithTheOnesThereAre) {
  for (const char* name : {"nonsense", "d3d:upwards", "GL"})
    expect_refused({"render", "triangle", "--convention", name}, "give one of gl, d3d, mit3dcg, fcg");
}

TEST_F(CullObjectsOption, ObjectsOutsideTheViewAreCountedAndThePictureStays) {
  const std::string camera = "eye=0,2,0;target=10,1,0";
  const Json none = result({"render", "city:80", "--camera", camera, "--cull-objects", "none"});
  EXPECT_EQ(none["objects"]["in"], 81u);
  EXPECT_EQ(none["objects"]["primitives_skipped"], 0u);
  for (const char* tests : {"sphere", "box", "both"}) {
    const Json json = result({"render", "city:80", "--camera", camera, "--cull-objects", tests});
    EXPECT_EQ(json["color_hash"], none["color_hash"]) << tests;
    EXPECT_EQ(json["depth_hash"], none["depth_hash"]) << tests;
    EXPECT_EQ(json["fragments"], none["fragments"]) << tests;
    EXPECT_EQ(json["primitives"], none["primitives"]) << tests;
    const Json& objects = json["objects"];
    const std::size_t culled =
        std::max(objects["culled_sphere"].get<std::size_t>(), objects["culled_box"].get<std::size_t>());
    EXPECT_GT(culled, 10u) << tests;
    EXPECT_EQ(objects["primitives_skipped"], 12 * culled)
        << tests;  // here a box's test culls as many objects as the sphere's
  }
}

TEST_F(CullObjectsOption, BoxesAreTheDefault) {
  const Json json = result({"render", "city:80", "--camera", "eye=0,2,0;target=10,1,0"});
  EXPECT_GT(json["objects"]["culled_box"], 0u);
  EXPECT_EQ(json["objects"]["culled_sphere"], 0u);
  expect_refused({"render", "triangle", "--cull-objects", "all"}, "give none, sphere, box or both");
}

}  // namespace
}  // namespace halfplane::cli::convention_test
