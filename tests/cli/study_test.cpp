// `--traversal`, `--fill-rule` and `--clipping`: their effect on results, and the commands that refuse them.
#include <algorithm>

#include "halfplane_paths.hpp"
#include "program.hpp"

namespace halfplane::cli::study_test {
namespace {

class StudyRules : public Cli {};

TEST_F(StudyRules, EveryTraversalGivesTheSameHashesAtItsOwnCost) {
  const Arguments base{"render", "teapot", "--size", "96x72"};
  const Json functional = result(base);
  std::uint64_t covered = 0;
  for (const char* traversal : {"tiled", "bbox", "scanline", "brute"}) {
    Arguments arguments = base;
    arguments.insert(arguments.end(), {"--engine", "scalar", "--traversal", traversal});
    const Json json = result(arguments);
    EXPECT_EQ(json["traversal"], traversal);
    EXPECT_EQ(json["fill_rule"], "top_left");
    EXPECT_EQ(json["double_draws"], 0u);
    EXPECT_EQ(json["color_hash"], functional["color_hash"]) << traversal;
    EXPECT_EQ(json["depth_hash"], functional["depth_hash"]) << traversal;
    EXPECT_GT(json["time_s"]["raster"], 0.0);
    covered = json["fragments"]["covered"];
    const std::uint64_t tested = json["samples_tested"], drawn = json["primitives"]["drawn"];
    if (std::string(traversal) == "scanline") {
      EXPECT_EQ(tested, covered);
    }
    if (std::string(traversal) == "bbox") {
      EXPECT_GT(tested, covered);
    }
    if (std::string(traversal) == "brute") {
      EXPECT_EQ(tested, drawn * 96 * 72);
    }
  }
}

const char* const kSquare =
    "halfplane 1\ntarget 24 24\nclear color 0 0 0 255 depth 1\nspace window\n"
    "v 2 2 .5\nv 20 20 .5\nv 20 2 .5\nv 2 20 .5\nt 0 1 2 1 0 3\n";

TEST_F(StudyRules, ExplainFollowsTheFillRule) {
  write("square.hpt", kSquare);
  // Pixel 9 9 lies on the diagonal that both triangles have: one owns it, both, none.
  const auto verdicts = [this](const char* rule) {
    const Json told = result({"explain", "square.hpt", "9", "9", "--fill-rule", rule});
    EXPECT_EQ(told["fill_rule"], rule);
    EXPECT_EQ(told["differences"], Json::array()) << rule;
    std::string text;
    for (const Json& entry : told["pixels"][0]["history"])
      if (entry["kind"] == "triangle") text += entry["verdict"].get<std::string>() + " ";
    return text;
  };
  EXPECT_EQ(verdicts("top_left"), "written uncovered ");
  EXPECT_EQ(verdicts("inclusive"), "written depth ");
  EXPECT_EQ(verdicts("exclusive"), "uncovered uncovered ");
  EXPECT_EQ(verdicts("offset_point"), "uncovered uncovered ") << "the diagonal runs through (-1, -1)";
  const Outcome outcome = run({"explain", "square.hpt", "9", "9", "--fill-rule", "exclusive"});
  EXPECT_NE(outcome.out.find("does not own its samples (fill rule exclusive)"), std::string::npos) << outcome.out;
  expect_refused({"explain", "square.hpt", "9", "9", "--fill-rule", "exclusive", "--rtl"},
                 "hardware has its own rules");
}

TEST_F(StudyRules, ExplainIsWhatTheScalarEngineDrawsByEveryRule) {
  for (const char* rules : {"--traversal scanline", "--gradients truncated", "--gradients two_reciprocals",
                            "--accumulator saturate", "--fill-rule inclusive --traversal bbox"}) {
    Arguments arguments = split_words("explain teapot:2 40 30 --size 96x72 --box 8x8 --seed 1 " + std::string(rules));
    const Json told = result(arguments);  // the status is 1 where specification and engine differ
    EXPECT_GT(told["checks"], 300) << rules;
  }
  const Outcome page = run(split_words("explain teapot:2 40 30 --size 96x72 --traversal bbox --quiet -o p.html"));
  EXPECT_EQ(page.status, 0) << page.err;
  const Bytes bytes = read("p.html");
  EXPECT_NE(std::string(bytes.begin(), bytes.end()).find("--traversal bbox"), std::string::npos) << "to be repeated";
}

TEST_F(StudyRules, AffineTextureCoordinatesAreOffByAThirdAtMostWhereWGrowsFourfold) {
  // v is 0 where w is 1, and 1 where w is 4: affine it is s, in perspective s / (s + 4 (1 - s)) at a part s of the way up
  // the screen. The difference is largest at s = 2/3, 1/3: 64/3 texels.
  write("t.hpt",
        "halfplane 1\ntarget 96 96\nclear color 0 0 0 255 depth 1\ntexture t pattern grid 64 64\nspace window\n"
        "state texture t\nv 0 95 .5 1 255 255 255 255 .05 0\nv 95 95 .5 1 255 255 255 255 .05 0\n"
        "v 48 1 .5 4 255 255 255 255 .05 1\nt 0 1 2\n");
  const Json affine = result({"compare", "t.hpt", "--interpolation", "affine"});
  EXPECT_EQ(affine["interpolation"], "affine");
  EXPECT_LE(affine["affine_coordinate_texels"]["max"], 64 / 3.0);
  EXPECT_GT(affine["affine_coordinate_texels"]["max"], 64 / 3.0 - 0.01);
  EXPECT_GT(affine["parts"]["affine"]["max"], 10);
  EXPECT_EQ(affine["bounds"]["broken"], Json::array());
  const Json perspective = result({"compare", "t.hpt", "--interpolation", "perspective"});
  EXPECT_EQ(perspective["affine_coordinate_texels"]["max"], 0);
  EXPECT_EQ(perspective["parts"]["affine"]["max"], 0);
  // The same as the states of a capture.
  const Bytes text = read("t.hpt");
  std::string states(text.begin(), text.end());
  states.insert(states.find("state texture t"), "state texture_interp affine\n");
  write("s.hpt", states);
  const auto hash = [this](const Arguments& words) { return result(words)["color_hash"]; };
  EXPECT_EQ(hash({"render", "t.hpt", "--interpolation", "affine"}), hash({"render", "s.hpt"}));
  EXPECT_NE(hash({"render", "t.hpt"}), hash({"render", "s.hpt"}));
  EXPECT_EQ(result({"explain", "t.hpt", "48", "30", "--interpolation", "affine"})["pixels"][0]["final"]["model"],
            result({"explain", "s.hpt", "48", "30"})["pixels"][0]["final"]["model"]);
}

TEST_F(StudyRules, TheFiguresOfTheRulesPageAreThoseOfItsScenes) {
  const std::string rules = HALFPLANE_SOURCE_DIR "/docs/rules/";
  const auto square = [&](const char* rule) {
    return result({"render", rules + "square.hpt", "--engine", "scalar", "--fill-rule", rule});
  };
  EXPECT_EQ(square("inclusive")["double_draws"], 36);
  EXPECT_EQ(square("exclusive")["undrawn_samples"], 36);
  EXPECT_EQ(square("offset_point")["undrawn_samples"], 18);
  const Json floor = result(split_words("compare " + rules + "floor.hpt --interpolation affine"));
  EXPECT_NEAR(floor["affine_coordinate_texels"]["max"], 44.6, 0.05);
  EXPECT_EQ(run(split_words("compare " + rules +
                            "floor.hpt --interpolation affine --quiet -o a.png --panels "
                            "model,perspective,affine,affine_coordinate"))
                .status,
            0);
  expect_refused({"compare", "triangle", "--size", "16x16", "-o", "a.png", "--panels", "affine_coordinate"},
                 "is about textures");
}

TEST_F(StudyRules, RenderSaysWhyAPrimitiveIsDropped) {
  write("t.hpt",
        "halfplane 1\ntarget 32 32\nspace window\nv 1 1 .5\nv 9 9 .5\nv 17 17 .5\nv 1 20 .5\nv 1.1 1.1 .5\n"
        "v 1.3 1.1 .5\nv 1.2 1.3 .5\nt 0 1 2 0 1 3 4 5 6\n");
  const Outcome outcome = run({"render", "t.hpt"});
  EXPECT_NE(
      outcome.out.find("3 in, 1 drawn (0 clipped), 2 dropped: 1 without area, 1 with no pixel centre in their box"),
      std::string::npos)
      << outcome.out;
  write("u.hpt",
        "halfplane 1\ntarget 32 32\nspace window\nstate cull back\nv 1 1 .5\nv 9 1 .5\nv 1 9 .5\nt 0 1 2 0 2 1\n");
  EXPECT_NE(run({"render", "u.hpt"}).out.find("2 in, 1 drawn (0 clipped), 1 dropped: 1 facing the culled side"),
            std::string::npos);
}

TEST_F(StudyRules, FillRulesShowInTheResultOfRenderAndCompare) {
  write("square.hpt", kSquare);
  const Json inclusive = result({"render", "square.hpt", "--engine", "scalar", "--fill-rule", "inclusive"});
  EXPECT_EQ(inclusive["fill_rule"], "inclusive");
  EXPECT_EQ(inclusive["double_draws"], 18u);
  EXPECT_EQ(inclusive["fragments"]["covered"], 18u * 18u + 18u);
  const Json offset = result({"compare", "square.hpt", "--fill-rule", "offset_point", "--traversal", "bbox"});
  EXPECT_EQ(offset["engine"], "scalar");
  EXPECT_EQ(offset["traversal"], "bbox");
  EXPECT_EQ(offset["coverage"]["missing"], 18u);
  EXPECT_EQ(offset["coverage"]["oracle_mismatches"], 0u);  // the oracle has the same rule
  EXPECT_EQ(offset["samples_tested"], 2u * 18u * 18u);
  const Json exclusive = result({"compare", "square.hpt", "--fill-rule", "exclusive", "--traversal", "scanline"});
  EXPECT_EQ(exclusive["coverage"]["missing"], 18u);
  EXPECT_EQ(exclusive["coverage"]["oracle_mismatches"], 0u);
  EXPECT_EQ(exclusive["undrawn_samples"], 18u);
  EXPECT_EQ(exclusive["double_draws"], 0u);
  EXPECT_EQ(exclusive["bounds"]["given_up"].size(), 1u);
  const Json plain = result({"compare", "square.hpt"});
  EXPECT_EQ(plain["undrawn_samples"], 0u);
  EXPECT_EQ(plain["engine"], "functional");
  EXPECT_EQ(plain["fill_rule"], "top_left");
  EXPECT_EQ(plain["coverage"]["missing"], 0u);
}

TEST_F(StudyRules, BoundsThatARuleGivesUpAreListed) {
  write("square.hpt", kSquare);
  const Json plain = result({"compare", "square.hpt"});
  EXPECT_EQ(plain["bounds"]["given_up"], Json::array());
  EXPECT_EQ(plain["bounds"]["broken"], plain["broken_bounds"]);
  const auto given_up = [&](const Arguments& rule) {
    Arguments arguments{"compare", "square.hpt", "--json"};
    arguments.insert(arguments.end(), rule.begin(), rule.end());
    const Outcome outcome = run(arguments);
    const Json list = Json::parse(outcome.out)["bounds"]["given_up"];
    for (const Json& bound : list)
      EXPECT_NE(outcome.err.find("given up: " + bound.get<std::string>()), std::string::npos) << outcome.err;
    const auto lines = lines_of(outcome.err);
    const bool says_all = std::find(lines.begin(), lines.end(), "every bound holds") != lines.end();
    EXPECT_EQ(says_all, list.empty() && outcome.status == 0) << outcome.err;
    return list.size();
  };
  EXPECT_EQ(given_up({"--fill-rule", "inclusive"}), 1u);
  EXPECT_EQ(given_up({"--fill-rule", "offset_point"}), 1u);
  EXPECT_EQ(given_up({"--gradients", "two_reciprocals"}), 1u);
  EXPECT_EQ(given_up({"--accumulator", "saturate", "--gradients", "truncated", "--fill-rule", "inclusive"}), 3u);
  EXPECT_EQ(given_up({"--traversal", "bbox"}), 0u) << "another order of the same arithmetic";
  const Outcome whole = run({"render", "walk", "--size", "64x48", "--engine", "scalar", "--clipping", "homogeneous"});
  EXPECT_NE(whole.out.find("given up    a sample at a shared vertex"), std::string::npos) << whole.out;
  EXPECT_EQ(run({"render", "walk", "--size", "64x48"}).out.find("given up"), std::string::npos);
}

TEST_F(StudyRules, DrawsSheetIsWrittenByEveryEngineThatCountsAndShowsTheRule) {
  write("square.hpt", kSquare);
  for (const char* engine : {"functional", "scalar", "golden"})
    EXPECT_EQ(run({"render", "square.hpt", "--engine", engine, "--draws", std::string(engine) + ".png"}).status, 0);
  const Arguments inclusive{"render",      "square.hpt", "--engine", "scalar",
                            "--fill-rule", "inclusive",  "--draws",  "inclusive.png"};
  EXPECT_EQ(run(inclusive).status, 0);
  EXPECT_GT(read("functional.png").size(), 500u);
  EXPECT_NE(read("inclusive.png"), read("scalar.png"));
  expect_refused({"render", "square.hpt", "--draws", "draws.npy"}, ".png");
}

TEST_F(StudyRules, OtherEnginesRefuseThemByName) {
  for (const char* engine : {"functional", "golden", "golden32"}) {
    expect_refused({"render", "triangle", "--engine", engine, "--traversal", "brute"}, "--traversal brute");
    expect_refused({"render", "triangle", "--engine", engine, "--fill-rule", "inclusive"}, "--fill-rule inclusive");
    expect_refused({"render", "triangle", "--engine", engine, "--fill-rule", "inclusive"}, engine);
  }
  expect_refused({"render", "triangle", "--traversal", "scanline"}, "add --engine scalar");
  EXPECT_EQ(run({"render", "triangle", "--traversal", "tiled", "--fill-rule", "top_left"}).status, 0);
}

TEST_F(StudyRules, ClippingShowsInTheResultsOfScalarAndGoldenAndNoOtherEngineHasIt) {
  const Arguments base{"render", "walk", "--size", "64x48", "--clipping"};
  const auto with = [&base](const char* clipping, const char* engine) {
    Arguments arguments = base;
    arguments.insert(arguments.end(), {clipping, "--engine", engine});
    return arguments;
  };
  const Json cut = result(with("polygon", "scalar")), whole = result(with("homogeneous", "scalar"));
  EXPECT_EQ(whole["clipping"], "homogeneous");
  EXPECT_EQ(whole["double_draws"], 0u);
  EXPECT_GT(cut["primitives"]["clipped"], 0u);
  EXPECT_EQ(whole["primitives"]["clipped"], 0u);
  EXPECT_EQ(whole["fragments"]["covered"], 64u * 48u);
  const Json golden = result(with("homogeneous", "golden"));
  EXPECT_EQ(golden["clipping"], "homogeneous");
  EXPECT_EQ(golden["color_hash"], result(with("polygon", "golden"))["color_hash"]);
  expect_refused(with("homogeneous", "functional"), "--clipping homogeneous");
  expect_refused(with("homogeneous", "golden32"), "--engine golden");
  expect_refused(with("sutherland", "scalar"), "polygon,homogeneous");
  Arguments both = with("homogeneous", "scalar");
  both.insert(both.end(), {"--traversal", "brute"});
  expect_refused(both, "leave out --traversal");
}

TEST_F(StudyRules, FaultsShowInTheResultAndCompareSaysThatTheBoundIsBroken) {
  write("slope.hpt", "halfplane 1\ntarget 400 200\nspace window\nv 0 0 .1\nv 400 0 .15\nv 0 200 .13\nt 0 1 2\n");
  const Json usual = result({"compare", "slope.hpt"});
  EXPECT_EQ(usual["gradients"], "one_reciprocal");
  EXPECT_EQ(usual["accumulator"], "wrap");
  const Outcome broken =
      run({"compare", "slope.hpt", "--gradients", "truncated", "--panels", "model,depth", "-o", "error.png", "--json"});
  EXPECT_EQ(broken.status, 1);
  const Json truncated = Json::parse(broken.out);
  EXPECT_EQ(truncated["engine"], "scalar");
  EXPECT_EQ(truncated["gradients"], "truncated");
  EXPECT_GT(truncated["datapath"]["depth_lsb"]["max"], 1.0);
  EXPECT_EQ(truncated["coverage"]["oracle_mismatches"], 0u);
  EXPECT_EQ(truncated["broken_bounds"].size(), 1u);
  EXPECT_NE(broken.err.find("embedded, seed 1, gradients truncated"), std::string::npos) << broken.err;
  EXPECT_GT(read("error.png").size(), 1000u);
  const Json both = result(
      {"render", "slope.hpt", "--engine", "scalar", "--gradients", "two_reciprocals", "--accumulator", "saturate"});
  EXPECT_EQ(both["gradients"], "two_reciprocals");
  EXPECT_EQ(both["accumulator"], "saturate");
}

TEST_F(StudyRules, WeightsOfFourBitsShowInTheResultAndBreakTheFiltersBound) {
  write("t.hpt",
        "halfplane 1\ntarget 32 32\ntexture t pattern chequer 8 8\nspace window\nstate texture t\n"
        "state texture_mag linear\nv 0 0 0.5 1 255 255 255 255 0 0\nv 32 0 0.5 1 255 255 255 255 0.2 0\n"
        "v 0 32 0.5 1 255 255 255 255 0 0.2\nt 0 1 2\n");
  const Json usual = result({"compare", "t.hpt", "--config", "full"});
  EXPECT_EQ(usual["weights"], "8");
  EXPECT_EQ(usual["texture"]["parts"]["weights"]["max"], 0);
  const Outcome outcome = run({"compare", "t.hpt", "--config", "full", "--weights", "4", "--quiet", "--json=r.json"});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  const Bytes bytes = read("r.json");
  const Json coarse = Json::parse(bytes.begin(), bytes.end());
  EXPECT_EQ(coarse["weights"], "4");
  EXPECT_GT(coarse["texture"]["parts"]["weights"]["max"], 5);
  EXPECT_LT(coarse["texture"]["parts"]["weights"]["max"], 16);
  ASSERT_EQ(coarse["broken_bounds"].size(), 1u);
  EXPECT_NE(coarse["broken_bounds"][0].get<std::string>().find("from the real filter"), std::string::npos);
  EXPECT_NE(result({"render", "t.hpt", "--engine", "scalar", "--weights", "4"})["color_hash"],
            result({"render", "t.hpt", "--engine", "scalar"})["color_hash"]);
  expect_refused({"render", "t.hpt", "--weights", "4"}, "--weights 4: the engine functional does not have it");
  expect_refused({"compare", "t.hpt", "--weights", "5"}, "8,4");
}

TEST_F(StudyRules, ThePagesScenesOfTexturesBreakNoBound) {
  for (const char* name : {"floor", "road", "wall", "texels"}) {
    const Json json = result({"compare", HALFPLANE_SOURCE_DIR "/docs/texture/" + std::string(name) + ".hpt"});
    EXPECT_TRUE(json["broken_bounds"].empty()) << name;
    EXPECT_GT(json["texture"]["pixels"], 10000) << name;
  }
}

TEST_F(StudyRules, OtherEnginesAndHomogeneousTrianglesRefuseFaults) {
  for (const char* engine : {"functional", "cycle", "golden"}) {
    expect_refused({"render", "triangle", "--engine", engine, "--gradients", "truncated"}, "--gradients truncated");
    expect_refused({"render", "triangle", "--engine", engine, "--accumulator", "saturate"}, engine);
  }
  expect_refused({"render", "walk", "--engine", "scalar", "--clipping", "homogeneous", "--accumulator", "saturate"},
                 "--accumulator");
}

TEST_F(StudyRules, UnknownNamesAreRefusedWithTheLegalOnes) {
  expect_refused({"render", "triangle", "--engine", "scalar", "--traversal", "spiral"}, "tiled,bbox,scanline,brute");
  expect_refused({"compare", "triangle", "--fill-rule", "bottom_right"}, "top_left,offset_point,inclusive");
  expect_refused({"compare", "triangle", "--gradients", "rounded"}, "one_reciprocal,two_reciprocals,truncated");
  expect_refused({"compare", "triangle", "--accumulator", "clamp"}, "wrap,saturate");
}

}  // namespace
}  // namespace halfplane::cli::study_test
