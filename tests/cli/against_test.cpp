// `halfplane compare --against`: a whole foreign rasterizer, judged by its image alone.
#include "halfplane_paths.hpp"
#include "model/capture/capture_textures.hpp"
#include "program.hpp"
#include "sim/show/image/png.hpp"

namespace halfplane::cli::against_test {
namespace {

class Against : public Cli {
 protected:
  /// The comparison's result for an image of the city drawn with these arguments.
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
  /// The comparison's result for the picture of one scene against another scene.
  [[nodiscard]] Json against_scene(const std::string& scene, const std::string& foreign,
                                   const std::string& drawn_with = "", const std::string& more = "") const {
    write("foreign.hpt", foreign);
    write("ours.hpt", scene);
    Arguments render = split_words("render foreign.hpt -o foreign.png --quiet " + drawn_with);
    EXPECT_EQ(run(render).status, 0);
    return against_file("foreign.png", more);
  }
  [[nodiscard]] Json against_file(const std::string& file, const std::string& more = "") const {
    (void)run(split_words("compare ours.hpt --quiet --json=r.json --against " + file + " " + more));
    const Bytes bytes = read("r.json");
    return Json::parse(bytes.begin(), bytes.end(), nullptr, false)["against"];
  }
  /// Expects all differences to be of one kind, and enough of them to decide.
  static void expect_all(const Json& against, const char* kind, const std::string& what) {
    EXPECT_GT(against["different"], 15) << what;
    EXPECT_EQ(pixels(against, kind), against["different"])
        << what << ": " << against["kinds"] << against["explanations"];
  }
  [[nodiscard]] Picture picture(const std::string& file) const {
    const TexelImage drawn = read_image_file(folder_ / file);
    Picture result(drawn.width, drawn.height);
    for (int y = 0; y < drawn.height; ++y)
      for (int x = 0; x < drawn.width; ++x) {
        const Texel& t = drawn.texel[static_cast<std::size_t>(y * drawn.width + x)];
        set_pixel(result, x, y, {t[0], t[1], t[2]});
      }
    return result;
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

/// Two textured triangles that cross, and a blended one over both.
std::string states_scene(const std::string& before, const std::string& of_blended, double texel = 0) {
  const auto at = [texel](const std::string& vertex, double u, double v) {
    return "v " + vertex + " " + std::to_string(u + texel) + " " + std::to_string(v) + "\n";
  };
  return "halfplane 1\ntarget 48 48\ntexture t pattern grid 16 16\nclear color 20 20 30 255 depth 1\nspace window\n"
         "state texture t\nstate depth_test lequal\n" +
         before + at("2 2 0.2 1 255 200 200 255", 0, 0) + at("46 4 0.3 4 200 255 200 255", 3, 0) +
         at("6 45 0.4 2 200 200 255 255", 0, 3) + at("46 46 0.6 1 90 140 230 255", 0, 0) +
         at("2 40 0.2 3 240 160 90 255", 2, 1) + at("44 3 0.5 2 160 90 240 255", 1, 2) +
         "t 0 1 2 3 4 5\nstate texture off\nstate depth_test always\n"
         "state blend src_alpha one_minus_src_alpha\n" +
         of_blended + "v 10 8 0.1 1 255 40 40 90\nv 40 12 0.1 1 40 255 40 160\nv 20 44 0.1 1 40 40 255 220\nt 6 7 8\n";
}

TEST_F(Against, AnotherStateIsCalledByItsKind) {
  struct Change {
    const char *kind, *before, *of_blended;
  };
  const Change changes[] = {
      {"depth_func", "state depth_test less\nstate depth_test greater\n", ""},
      {"depth_func", "state depth_test always\n", ""},
      {"depth_func", "state depth_test never\n", ""},
      {"texture", "state texture_mag linear\nstate texture_min linear\n", ""},
      {"texture", "state texture_wrap clamp clamp\n", ""},
      {"texture", "state texture_wrap repeat mirror\n", ""},
      {"texture", "state texture_interp affine\n", ""},
      {"texture", "state texture_combine decal\n", ""},
      {"texture", "state texture_combine add\n", ""},
      {"blend", "", "state blend one one_minus_src_alpha\n"},
      {"blend", "", "state blend src_alpha one\n"},
      {"blend", "", "state blend off\n"},
      {"blend", "", "state blend_equation reverse_subtract\n"},
      {"dither", "state dither on\n", ""},
  };
  for (const Change& c : changes)
    expect_all(against_scene(states_scene("", ""), states_scene(c.before, c.of_blended)), c.kind,
               std::string(c.before) + c.of_blended);
  expect_all(against_scene(states_scene("state dither on\n", ""), states_scene("", "")), "dither", "no dithering");
  // A texel of 16, and half a one.
  expect_all(against_scene(states_scene("", ""), states_scene("", "", 1 / 16.0)), "texture", "a texel off");
  expect_all(against_scene(states_scene("", ""), states_scene("", "", -1 / 32.0)), "texture", "half a texel off");
  const std::string linear = states_scene("state texture_mag linear\nstate texture_min linear\n", "");
  expect_all(against_scene(linear, linear, "--engine scalar --weights 4", ""), "texture", "weights of 4 bits");
}

TEST_F(Against, TwoFaultsAreBothCalledByTheirKinds) {
  // Left: two triangles of equal depth; right: one over the other, blended.
  const auto scene = [](const std::string& depth, const std::string& blend) {
    return "halfplane 1\ntarget 64 32\nclear color 9 9 9 255 depth 1\nspace window\n" + depth +
           "v 1 1 0.5 1 250 20 20 255\nv 30 1 0.5 1 20 20 250 255\nv 1 30 0.5 1 20 250 20 255\n"
           "v 1 2 0.5 1 90 90 20 255\nv 29 2 0.5 1 20 90 90 255\nv 2 30 0.5 1 90 20 90 255\n"
           "v 33 1 0.5 1 250 90 20 255\nv 62 1 0.5 1 20 90 250 255\nv 33 30 0.5 1 20 250 90 255\n"
           "t 0 1 2 3 4 5 6 7 8\nstate depth_test always\n" +
           blend + "v 34 2 0.5 1 50 90 20 100\nv 60 2 0.5 1 20 90 50 100\nv 34 28 0.5 1 20 50 90 100\nt 9 10 11\n";
  };
  const Json found = against_scene(scene("", "state blend src_alpha one_minus_src_alpha\n"),
                                   scene("state depth_test lequal\n", "state blend src_alpha one\n"));
  EXPECT_GT(pixels(found, "depth_func"), 100U);
  EXPECT_GT(pixels(found, "blend"), 100U);
}

TEST_F(Against, AMatrixOfDitheringThatIsMovedIsDither) {
  // One colour everywhere, so that a moved matrix is a moved picture.
  const std::string scene =
      "halfplane 1\ntarget 32 32\nclear color 0 0 0 255 depth 1\nspace window\nstate dither on\n"
      "v 0 0 0.5 1 101 77 203 255\nv 64 0 0.5 1 101 77 203 255\nv 0 64 0.5 1 101 77 203 255\nt 0 1 2\n";
  write("ours.hpt", scene);
  ASSERT_EQ(run({"render", "ours.hpt", "-o", "a.png", "--quiet"}).status, 0);
  const Picture straight = picture("a.png");
  Picture moved = straight;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) set_pixel(moved, x, y, straight.get((x + 1) % 32, (y + 2) % 32));
  write_png((folder_ / "moved.png").string(), moved);
  expect_all(against_file("moved.png"), "dither", "moved");
}

TEST_F(Against, BlendingThatIsCutIsBlend) {
  // (40 * 100 + 200 * 155) / 255 = 137.25, (60 * 100 + 90 * 155) / 255 = 78.24, (10 * 100 + 37 * 155) / 255 = 26.41:
  // unchanged. (41 * 100 + 202 * 155) / 255 = 138.86, rounded to 139 and truncated to 138.
  const std::string quad = " 0 0.5 1 202 90 37 255\nv 64 0 0.5 1 202 90 37 255\nv 0 64 0.5 1 202 90 37 255\n";
  write("ours.hpt", "halfplane 1\ntarget 32 32\nclear color 0 0 0 255 depth 1\nspace window\nv 0" + quad +
                        "t 0 1 2\nstate depth_test always\nstate blend src_alpha one_minus_src_alpha\n"
                        "v 4 4 0.5 1 41 60 10 100\nv 28 4 0.5 1 41 60 10 100\nv 4 28 0.5 1 41 60 10 100\nt 3 4 5\n");
  const std::string format = "--set color.format=rgba8888";
  ASSERT_EQ(run(split_words("render ours.hpt -o a.png --quiet " + format)).status, 0);
  Picture cut = picture("a.png");
  int blended = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      if (cut.get(x, y) == Rgb{139, 78, 26}) {
        set_pixel(cut, x, y, {138, 78, 26});
        ++blended;
      }
  EXPECT_GT(blended, 200);
  write_png((folder_ / "cut.png").string(), cut);
  const Json found = against_file("cut.png", format);
  EXPECT_EQ(found["different"], blended);
  expect_all(found, "blend", "cut");
  EXPECT_EQ(found["explanations"][0]["change"], "products of blending cut, not rounded");
  // Values within one code of each other are equal.
  const Json equal = against_file("cut.png", format + " --tolerance color=1");
  EXPECT_EQ(equal["different"], 0);
  EXPECT_EQ(equal["within_tolerance"], blended);
}

TEST_F(Against, AToleranceIsOfCodesOfTheStoredFormat) {
  ASSERT_EQ(run({"render", "triangle", "--size", "32x32", "-o", "r.png", "--depth", "r.npy", "--quiet"}).status, 0);
  // rgb565: a code of 5 bits is 8 or 9 of 8 bits, two are 16 or 17.
  Picture changed = picture("r.png");
  const Rgb middle = changed.get(16, 16), below = changed.get(16, 18);
  const auto off = [](std::uint8_t c, int by) { return static_cast<std::uint8_t>(c < 128 ? c + by : c - by); };
  set_pixel(changed, 16, 16, {off(middle.r, 8), middle.g, middle.b});
  set_pixel(changed, 16, 18, {off(below.r, 16), below.g, below.b});
  write_png((folder_ / "c.png").string(), changed);
  const auto differing = [&](const std::string& words) {
    const int status = run(split_words("compare triangle --size 32x32 --quiet --json=r.json " + words)).status;
    const Bytes bytes = read("r.json");
    const Json found = Json::parse(bytes.begin(), bytes.end())["against"];
    EXPECT_EQ(status, found["different"] == 0 ? 0 : 1) << words;
    return found["different"].get<int>();
  };
  EXPECT_EQ(differing("--against c.png"), 2);
  EXPECT_EQ(differing("--against c.png --tolerance color=1"), 1);
  EXPECT_EQ(differing("--against c.png --tolerance color=2,depth=9"), 0);
  EXPECT_EQ(differing("--against c.png --tolerance depth=9"), 2);
  Bytes codes = read("r.npy");
  const std::size_t last = codes.size() - 4;  // code of the last pixel, which is cleared: 65535
  codes[last] = 0xfc;                         // 3 less
  write("d.npy", std::string(codes.begin(), codes.end()));
  EXPECT_EQ(differing("--against d.npy --tolerance color=9,depth=2"), 1);
  EXPECT_EQ(differing("--against d.npy --tolerance depth=3"), 0);
}

TEST_F(Against, TheFirstPixelsAreListedAsChannels) {
  const std::string head = "halfplane 1\ntarget 8 8\nspace window\nclear color ";
  write("ours.hpt", head + "255 0 0 255 depth 1\n");
  write("foreign.hpt", head + "0 255 255 255 depth 1\n");
  ASSERT_EQ(run({"render", "foreign.hpt", "-o", "f.png", "--quiet"}).status, 0);
  const Json found = against_file("f.png", "--first 11");
  ASSERT_EQ(found["differences"].size(), 11U);
  EXPECT_EQ(found["differences"][10]["x"], 2);
  EXPECT_EQ(found["differences"][10]["y"], 1);
  EXPECT_EQ(found["differences"][10]["expected"], (Json{{"r", 255}, {"g", 0}, {"b", 0}}));
  EXPECT_EQ(found["differences"][10]["found"], (Json{{"r", 0}, {"g", 255}, {"b", 255}}));
  EXPECT_EQ(against_file("f.png", "--first 0")["differences"].size(), 0U);
  const Outcome outcome = run(split_words("compare ours.hpt --against f.png --first 2 -o s.png --junit j.xml"));
  EXPECT_EQ(outcome.status, 1);
  const auto lines = lines_of(outcome.out);
  EXPECT_TRUE(lines.back().starts_with("FAILED: ")) << lines.back();
  EXPECT_NE(outcome.out.find("255   0   0     0 255 255\n"), std::string::npos) << outcome.out;
  const Bytes bytes = read("j.xml");
  const std::string xml(bytes.begin(), bytes.end());
  EXPECT_NE(xml.find("failures=\"2\""), std::string::npos) << "nothing was compared with the golden, too\n" << xml;
  EXPECT_NE(xml.find("f.png: 64 of 64 pixels differ"), std::string::npos) << xml;
}

TEST_F(Against, TheSheetShowsTheOtherImageAndTheDifference) {
  ASSERT_EQ(run({"render", "triangle", "--size", "32x32", "-o", "a.png", "--depth", "a.npy", "--quiet"}).status, 0);
  Picture changed = picture("a.png");
  set_pixel(changed, 3, 3, {255, 255, 255});
  write_png((folder_ / "b.png").string(), changed);
  const Arguments compare =
      split_words("compare triangle --size 32x32 --quiet -o s.png --against b.png --panels against");
  EXPECT_EQ(run(compare).status, 1);
  // A pixel is 15 x 15 here. The only white square of that size is the changed pixel.
  const Picture sheet = picture("s.png");
  int white = 0;
  for (int y = 60; y < sheet.height; ++y)  // below the title and the caption, whose letters are not this white
    for (int x = 0; x < sheet.width; ++x) white += sheet.get(x, y) == Rgb{255, 255, 255} ? 1 : 0;
  EXPECT_EQ(white, 15 * 15);
  for (const char* more : {"difference", "kinds", "against,difference,kinds"})
    EXPECT_EQ(
        run(split_words("compare triangle --size 32x32 --quiet -o s.png --against a.npy --panels " + std::string(more)))
            .status,
        0)
        << more;
  expect_refused({"compare", "triangle", "--panels", "kinds", "-o", "t.png"}, "add --against FILE");
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
  EXPECT_NE(outcome.out.find("  depth_func: "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("depth_test lequal in place of less"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("  other "), std::string::npos) << outcome.out;
}

TEST_F(Against, AColourThatIsACodeOffIsColourAndWhatNothingExplainsIsOther) {
  ASSERT_EQ(run({"render", "triangle", "--size", "32x32", "-o", "r.png", "--quiet"}).status, 0);
  Picture changed = picture("r.png");
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

TEST_F(Against, EachSceneOfAFolderHasItsVerdict) {
  ASSERT_EQ(paste("mkdir scenes images").status, 0);
  for (const char* seed : {"1", "2", "3", "4"}) {
    const std::string scene = std::string("scenes/s") + seed + ".hpt", image = std::string("images/s") + seed;
    ASSERT_EQ(
        run({"convert", "--random", "20", "--random-only", "triangles,48x48,size=8..40", "--seed", seed, "-o", scene})
            .status,
        0);
    Arguments render{"render", scene, "-o", image + ".png", "--depth", image + ".npy", "--quiet"};
    if (*seed == '2') render.insert(render.end(), {"--set", "subpixel.bits=0"});
    ASSERT_EQ(run(render).status, 0);
  }
  ASSERT_EQ(paste("rm images/s3.png images/s4.png images/s4.npy").status, 0);
  const Outcome outcome = run({"compare", "scenes", "--against", "images", "--json=r.json", "--junit", "r.xml"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("2 of 4 scenes equal"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("DIFFERENT  s2.png"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("FAILED     s4.hpt: no image s4.png or .npy"), std::string::npos) << outcome.out;
  const Bytes bytes = read("r.json");
  const Json result = Json::parse(bytes.begin(), bytes.end());
  EXPECT_EQ(result["failed"], 2);
  EXPECT_EQ(result["scenes"][0]["against"].size(), 2U) << "colour and depth";
  EXPECT_EQ(result["scenes"][2]["against"].size(), 1U);
  const Bytes xml = read("r.xml");
  EXPECT_NE(std::string(xml.begin(), xml.end()).find("tests=\"6\" failures=\"3\""), std::string::npos);
  expect_refused({"compare", "scenes"}, "add --against FOLDER");
  expect_refused({"compare", "scenes", "--against", "scenes/s1.hpt"}, "give a folder of images here too");
  expect_refused({"compare", "images", "--against", "images"}, "no scene in it");
  expect_refused({"compare", "scenes", "--against", "images", "-o", "a.png"}, "-o: it is of one scene");
}

TEST_F(Against, BadImagesAreRefused) {
  ASSERT_EQ(run({"render", "triangle", "--size", "16x16", "-o", "r.png", "--depth", "r.npy", "--quiet"}).status, 0);
  expect_refused({"compare", "triangle", "--size", "17x16", "--against", "r.png"}, "give the same --size");
  expect_refused({"compare", "triangle", "--size", "17x16", "--against", "r.npy"}, "give the same --size");
  expect_refused({"compare", "triangle", "--against", "r.txt"}, "is no image");
  const auto tolerance = [](const char* text) {
    return Arguments{"compare", "triangle", "--size", "16x16", "--against", "r.png", "--tolerance", text};
  };
  expect_refused(tolerance("color"), "give color=N");
  expect_refused(tolerance("color=-1"), "give color=N");
  expect_refused(tolerance("color=1,stencil=1"), "an image has no 'stencil'");
  expect_refused(tolerance("depth=99999999999"), "give depth=N");
  expect_refused({"compare", "triangle", "--tolerance", "color=1"}, "add --against FILE");
  expect_refused({"compare", "triangle", "--first", "5"}, "add --against FILE");
  expect_refused({"compare", "triangle", "--against", "none.png"}, "none.png");
  expect_refused({"compare", "triangle", "--against", "none.npy"}, "there is no such file");
  write("bad.npy", "NUMPY");
  expect_refused({"compare", "triangle", "--size", "16x16", "--against", "bad.npy"}, "no array of depth codes");
  const Bytes whole = read("r.npy");
  write("short.npy", std::string(whole.begin(), whole.end() - 1));
  expect_refused({"compare", "triangle", "--size", "16x16", "--against", "short.npy"}, "cut short");
}

}  // namespace
}  // namespace halfplane::cli::against_test
