// `halfplane compare --against`: a whole foreign rasterizer, judged by its image alone.
#include "halfplane_paths.hpp"
#include "model/capture/capture_textures.hpp"
#include "program.hpp"
#include "sim/show/image/png.hpp"

namespace halfplane::cli {
namespace {

class Against : public Cli {
 protected:
  /// What is said of an image of the city that was drawn with these words.
  [[nodiscard]] Json against(const std::string& scene, const std::string& drawn_with, const std::string& more = "",
                             bool is_depth = false) const {
    Arguments render = split_words("render " + scene + " " + drawn_with + " --quiet");
    const std::string file = is_depth ? "foreign.npy" : "foreign.png";
    render.insert(render.end(), {is_depth ? "--depth" : "-o", file});
    EXPECT_EQ(run(render).status, 0);
    Arguments compare = split_words("compare " + scene + " " + more + " --quiet --json=r.json --against " + file);
    const Outcome outcome = run(compare);
    const Bytes bytes = read("r.json");
    const Json result = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    EXPECT_EQ(outcome.status, result["against"]["different"] == 0 ? 0 : 1) << outcome.err;
    return result["against"];
  }
  static std::uint64_t pixels(const Json& against, const char* kind) { return against["kinds"][kind]["pixels"]; }
};

TEST_F(Against, TheSameImageHasNoDifference) {
  EXPECT_EQ(against("city --size 96x72", "")["different"], 0);
  const Json depth = against("city --size 96x72", "", "", true);
  EXPECT_EQ(depth["different"], 0);
  EXPECT_EQ(depth["image"], "depth");
}

TEST_F(Against, AnotherFillRuleIsTheEdgeRule) {
  const std::string scene = HALFPLANE_SOURCE_DIR "/docs/rules/square.hpt";
  const Json found = against(scene, "--engine scalar --traversal bbox --fill-rule offset_point");
  EXPECT_GT(pixels(found, "edge_rule"), 10U);
  EXPECT_EQ(pixels(found, "edge_rule"), found["different"]);
  EXPECT_EQ(against(scene, "--engine scalar --traversal bbox --fill-rule offset_point",
                    "--traversal bbox --fill-rule offset_point")["different"],
            0)
      << "chosen as the rule, it is no difference";
}

TEST_F(Against, FewerSubpixelBitsAreTheSnap) {
  const Json found = against("city --size 96x72", "--set subpixel.bits=2");
  EXPECT_GT(found["different"], 50);
  EXPECT_GE(pixels(found, "snap") * 10, found["different"].get<std::uint64_t>() * 9);
}

TEST_F(Against, AnotherDepthTestShowsOtherFragments) {
  const std::string head = "halfplane 1\ntarget 32 32\nclear color 0 0 0 255 depth 1\nspace window\n";
  const std::string body =
      "v 1 1 0.5 1 255 0 0 255\nv 30 1 0.5 1 255 0 0 255\nv 1 30 0.5 1 255 0 0 255\nv 1 1 0.5 1 0 0 255 255\n"
      "v 30 1 0.5 1 0 0 255 255\nv 1 30 0.5 1 0 0 255 255\nt 0 1 2 3 4 5\n";
  write("less.hpt", head + body);
  write("lequal.hpt", head + "state depth_test lequal\n" + body);
  ASSERT_EQ(run({"render", "lequal.hpt", "-o", "foreign.png", "--quiet"}).status, 0);
  const Outcome outcome = run({"compare", "less.hpt", "--against", "foreign.png"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("of 1,024 pixels differ"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("  depth "), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("  other "), std::string::npos) << outcome.out;
}

TEST_F(Against, AColourThatIsACodeOffIsColourAndWhatNothingExplainsIsOther) {
  ASSERT_EQ(run({"render", "triangle", "--size", "32x32", "-o", "r.png", "--quiet"}).status, 0);
  const TexelImage drawn = read_image_file(folder_ / "r.png");
  Picture changed(drawn.width, drawn.height);
  for (int y = 0; y < drawn.height; ++y)
    for (int x = 0; x < drawn.width; ++x) {
      const Texel& t = drawn.texel[static_cast<std::size_t>(y * drawn.width + x)];
      set_pixel(changed, x, y, {t[0], t[1], t[2]});
    }
  const Rgb middle = changed.get(16, 16);
  set_pixel(changed, 16, 16, {static_cast<std::uint8_t>(middle.r ^ 8), middle.g, middle.b});
  set_pixel(changed, 16, 18, {1, 2, 3});
  write_png((folder_ / "c.png").string(), changed);
  EXPECT_EQ(run({"compare", "triangle", "--size", "32x32", "--against", "c.png", "--quiet", "--json=r.json"}).status,
            1);
  const Bytes bytes = read("r.json");
  const Json found = Json::parse(bytes.begin(), bytes.end())["against"];
  EXPECT_EQ(found["different"], 2);
  EXPECT_EQ(pixels(found, "color"), 1U);
  EXPECT_EQ(pixels(found, "other"), 1U);
  EXPECT_EQ(found["first"]["x"], 16);
  EXPECT_EQ(found["first"]["y"], 16);
  EXPECT_EQ(found["first"]["kind"], "color");
}

TEST_F(Against, BadImagesAreRefused) {
  ASSERT_EQ(run({"render", "triangle", "--size", "16x16", "-o", "r.png", "--depth", "r.npy", "--quiet"}).status, 0);
  expect_refused({"compare", "triangle", "--size", "17x16", "--against", "r.png"}, "give the same --size");
  expect_refused({"compare", "triangle", "--size", "17x16", "--against", "r.npy"}, "give the same --size");
  expect_refused({"compare", "triangle", "--against", "r.txt"}, "is no image");
  expect_refused({"compare", "triangle", "--against", "none.png"}, "none.png");
  expect_refused({"compare", "triangle", "--against", "none.npy"}, "there is no such file");
  write("bad.npy", "NUMPY");
  expect_refused({"compare", "triangle", "--size", "16x16", "--against", "bad.npy"}, "no array of depth codes");
  const Bytes whole = read("r.npy");
  write("short.npy", std::string(whole.begin(), whole.end() - 1));
  expect_refused({"compare", "triangle", "--size", "16x16", "--against", "short.npy"}, "cut short");
}

}  // namespace
}  // namespace halfplane::cli
