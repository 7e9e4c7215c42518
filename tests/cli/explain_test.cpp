// `halfplane explain`: a pixel's history, checked against the other commands' results for it.
#include <algorithm>
#include <cstring>

#include "halfplane_paths.hpp"
#include "model/capture/capture_textures.hpp"
#include "program.hpp"

namespace halfplane::cli::explain_test {
namespace {

class ExplainCommand : public Cli {
 protected:
  [[nodiscard]] Json pixel(const std::string& scene, int x, int y, const Arguments& more = {}) const {
    Arguments words{"explain", scene, std::to_string(x), std::to_string(y)};
    words.insert(words.end(), more.begin(), more.end());
    return result(words);
  }
  /// An image of `render`, 32 bits a pixel, row by row.
  [[nodiscard]] std::vector<std::uint32_t> image(const std::string& name, std::size_t pixels) const {
    const Bytes bytes = read(name);
    std::vector<std::uint32_t> values(pixels);
    EXPECT_GE(bytes.size(), 4 * pixels);
    std::memcpy(values.data(), bytes.data() + bytes.size() - 4 * pixels, 4 * pixels);
    return values;
  }
};

std::uint32_t number(const Json& hex) {
  return static_cast<std::uint32_t>(std::stoul(hex.get<std::string>(), nullptr, 16));
}

TEST_F(ExplainCommand, TellsOfEveryPixelWhatRenderDraws) {
  ASSERT_EQ(run({"convert", "--random", "50", "--seed", "5", "--config", "tiny", "-o", "r.hpt"}).status, 0);
  const Json drawn = result({"render", "r.hpt", "--config", "tiny", "--depth", "d.npy", "--ids", "i.npy", "--count",
                             "c.npy", "--skip", "none"});
  const int width = drawn["width"], height = drawn["height"];
  const auto pixels = static_cast<std::size_t>(width * height);
  const auto depth = image("d.npy", pixels), ids = image("i.npy", pixels), count = image("c.npy", pixels);
  const int columns = std::min(width, 16), rows = std::min(height, 16);
  const Json told = pixel("r.hpt", (width - columns) / 2, (height - rows) / 2,
                          {"--config", "tiny", "--box", std::to_string(columns) + "x" + std::to_string(rows)});
  EXPECT_EQ(told["differences"].size(), 0u);
  ASSERT_EQ(told["pixels"].size(), static_cast<std::size_t>(columns * rows));
  std::size_t fragments = 0;
  for (const Json& at : told["pixels"]) {
    const auto p = static_cast<std::size_t>(at["y"].get<int>() * width + at["x"].get<int>());
    EXPECT_EQ(number(at["final"]["model"]["depth"]), depth[p]);
    const Json& owner = at["final"]["model"]["owner"];
    EXPECT_EQ(owner.is_null() ? -1 : owner.get<std::int32_t>(), static_cast<std::int32_t>(ids[p]));
    std::uint32_t covered = 0;
    for (const Json& entry : at["history"]) {
      const std::string verdict = entry["model"]["verdict"];
      covered +=
          entry["kind"] != "clear" && (verdict == "depth" || verdict == "masked" || verdict == "written") ? 1 : 0;
    }
    EXPECT_EQ(covered, count[p]) << at["x"] << " " << at["y"];
    fragments += covered;
  }
  EXPECT_GT(fragments, 50u);
}

TEST_F(ExplainCommand, GoldenAndModelNameTheTestThatFailed) {
  write("t.hpt",
        "halfplane 1\ntarget 8 8\nspace window\nclear color 0 0 0 255 depth 1 stencil 3\n"
        "v 0 0 0.5 1 255 255 255 100\nv 8 0 0.5 1 255 255 255 100\nv 0 8 0.5 1 255 255 255 100\n"
        "state stencil equal 4 255 255 keep keep keep\nt 0 1 2\n"
        "state stencil off\nstate alpha_test gequal 128\nt 0 1 2\n"
        "state alpha_test always 0\nstate depth_test greater\nt 0 1 2\n");
  const Json told = pixel("t.hpt", 1, 1);
  const Json& history = told["pixels"][0]["history"];
  const std::array expected{"stencil", "alpha", "depth"};
  std::size_t seen = 0;
  for (const Json& entry : history) {
    if (entry["kind"] == "clear") continue;
    ASSERT_LT(seen, expected.size());
    EXPECT_EQ(entry["model"]["verdict"], expected[seen]);
    EXPECT_EQ(entry["golden"]["verdict"], expected[seen]);
    ++seen;
  }
  EXPECT_EQ(seen, expected.size());
}

TEST_F(ExplainCommand, ATieIsTheTopOrLeftEdges) {
  // Two triangles share the edge from (0, 8) to (8, 0): it runs through the centre of pixel 3 4.
  write("t.hpt",
        "halfplane 1\ntarget 16 16\nspace window\nv 0 0 0.5\nv 8 0 0.5\nv 0 8 0.5\nv 8 8 0.5\nt 0 1 2\nt 1 3 2\n");
  const Json history = pixel("t.hpt", 3, 4)["pixels"][0]["history"];
  ASSERT_EQ(history.size(), 2u);
  int owners = 0;
  for (const Json& entry : history) {
    for (const Json& edge : entry["model"]["edges"]) {
      if (edge["tie"] == false) continue;
      EXPECT_EQ(edge["exact"], 0);
      EXPECT_EQ(edge["owns_ties"], edge["side"] == "top" || edge["side"] == "left");
      EXPECT_EQ(edge["value"].get<int>() >= 0, edge["owns_ties"].get<bool>());
      EXPECT_EQ(entry["verdict"], edge["owns_ties"] == true ? "written" : "uncovered");
      owners += edge["owns_ties"] == true ? 1 : 0;
    }
    EXPECT_EQ(entry["oracle"]["on_border"], true);
  }
  EXPECT_EQ(owners, 1);
}

TEST_F(ExplainCommand, ALineHasItsDecisionsBesideTheBooks) {
  write("l.hpt",
        "halfplane 1\ntarget 32 32\nspace window\nstate line_rule bresenham\nv 1.5 1.5 0.5\nv 21.5 8.5 0.5\nl 0 1\n");
  const Json told = pixel("l.hpt", 11, 5, {"--steps"});
  const Json& line = told["pixels"][0]["history"][0]["model"]["line"];
  const Json &registers = line["registers"]["bresenham"], &book = line["textbook"]["bresenham"];
  ASSERT_EQ(registers.size(), 21u);
  ASSERT_EQ(book.size(), 21u);
  EXPECT_EQ(book[0]["error"], 2 * 7 - 20);
  EXPECT_EQ(book, line["textbook"]["midpoint"]);
  for (std::size_t i = 0; i < book.size(); ++i)
    for (const char* key : {"x", "y", "decision"}) EXPECT_EQ(registers[i][key], book[i][key]) << i;
  const std::string text = run({"explain", "l.hpt", "11", "5"}).out;
  EXPECT_NE(text.find("bresenham, along x: D 320, d 112 subpixels"), std::string::npos) << text;
}

TEST_F(ExplainCommand, TextNamesStageAndReason) {
  write("t.hpt",
        "halfplane 1\ntarget 16 16\nclear color 0 0 0 255 depth 0.25\nspace window\nv 0 0 0.5\nv 16 0 0.5\nv 0 16 0.5\n"
        "t 0 1 2\nstate depth_test always\nstate depth_write off\nstate color_write off\nt 0 1 2\nstate cull both\nt 0 "
        "1 2\n");
  const std::string text = run({"explain", "t.hpt", "3", "3"}).out;
  for (const char* part : {"#0 triangle, command 1 (line 8): depth at depth_test", "masked at rop", "backface at cull",
                           "func less  fragment 0x8000  stored 0x4000  fails", "all agree"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST_F(ExplainCommand, SeveralSamplesAreToldOneByOne) {
  // A triangle over the lower right half of pixel 1 1: its standard samples 0 and 1 of 2 lie at (3/4, 3/4) and (1/4, 1/4).
  write("t.hpt",
        "halfplane 1\ntarget 4 4\nspace window\nv 2 1 0.5\nv 4 4 0.5\nv 1 2 0.5\nt 0 1 2\n"
        "state sample_mask 2\nt 0 1 2\n");
  const Json told = pixel("t.hpt", 1, 1, {"--set", "msaa.samples=2"});
  EXPECT_EQ(told["differences"].size(), 0U);
  const Json& at = told["pixels"][0];
  ASSERT_EQ(at["history"].size(), 4U);
  const std::array expected{"written", "uncovered", "uncovered", "uncovered"};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(at["history"][i]["sample"], i % 2);
    EXPECT_EQ(at["history"][i]["verdict"], expected[i]) << i;
  }
  EXPECT_EQ(at["history"][2]["oracle"]["covers"], true) << "the mask alone leaves it out";
  EXPECT_EQ(at["samples"][0]["x_pixels"], 0.75);
  EXPECT_EQ(at["samples"][0]["final"]["model"]["color"], "0xffff");
  EXPECT_EQ(at["samples"][1]["final"]["model"]["color"], "0x0000");
  EXPECT_EQ(at["final"]["model"]["color"], "0x8410") << "the mean, halves up";
  const std::string text = run({"explain", "t.hpt", "1", "1", "--set", "msaa.samples=2"}).out;
  for (const char* part : {"written in 1 of 2 samples", "sample 0      at 0.7500 0.7500: written at rop",
                           "but the sample mask leaves it out", "the mean of their colours"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

/// By a judge that knows only the program's files (tests/cli/explain_judge.py).
TEST_F(ExplainCommand, AJudgeFromOutsideFindsNoFigureWrong) {
  if (paste("command -v python3 >python.txt").status != 0) GTEST_SKIP() << "no Python here";
  const auto judged = [&](const std::string& options, const std::string& seed) {
    ASSERT_EQ(paste("mkdir s" + seed + " && '" HALFPLANE_PROGRAM "' convert --random 40 --seed " + seed + " " +
                    options + " -o s" + seed + "/r.hpt")
                  .status,
              0);
    const Outcome outcome =
        paste("python3 '" HALFPLANE_SOURCE_DIR "/tests/cli/explain_judge.py' '" HALFPLANE_PROGRAM "' s" + seed + " 8 " +
              seed + " -- " + options);
    EXPECT_EQ(outcome.status, 0) << options << "\n" << outcome.out << outcome.err;
  };
  judged("--config tiny", "1");
  judged(
      "--config embedded --set texture.unit=trilinear --set perspective.colors=1 --set fog.unit=1 --set alpha.unit=1 "
      "--set stencil.bits=8 --set blend.lanes=4 --set dither.unit=1",
      "2");
  judged("--config full --set msaa.samples=4", "3");
  judged("--config embedded --set blend.lanes=4 --set dither.unit=1 --set logic.unit=1", "6");
  judged("--config full --set blend.lanes=4 --set logic.unit=1", "11");
}

TEST_F(ExplainCommand, BadPixelsAreRefused) {
  expect_refused({"explain", "triangle", "16", "0", "--size", "16x16"}, "pixel 16 0 lies outside the target of 16x16");
  expect_refused({"explain", "triangle", "-1", "0", "--size", "16x16"}, "pixel -1 0 lies outside");
  expect_refused({"explain", "triangle", "0", "0", "--box", "17x1", "--size", "16x16"}, "pixel 16 0 lies outside");
  expect_refused({"explain", "triangle", "2147483647", "0", "--box", "2x1"}, "pixel 2147483647 0 lies outside");
  expect_refused({"explain", "triangle", "0", "0", "--box", "0x1"}, "--box");
  expect_refused({"explain", "triangle", "0", "0", "--box", "100x100"}, "more than 4096 pixels");
  expect_refused({"explain", "triangle", "0", "0", "--near", "0"}, "--near");
  expect_refused({"explain", "triangle", "0", "0", "--near", "nan"}, "--near");
  expect_refused({"explain", "triangle", "0", "0", "--mutant", "3"}, "--rtl");
  expect_refused({"explain", "triangle", "zero", "0"}, "zero");
  expect_refused({"explain", "triangle", "0"}, "Y is required");
  expect_refused({"explain", "triangle", "0", "0", "-o", "p.txt"}, ".png or .html");
  expect_refused({"explain", "triangle", "0", "0", "-o", "none/p.png"}, "no such folder");
}

TEST_F(ExplainCommand, ThePictureIsAnEnlargedNeighbourhood) {
  const Outcome outcome = run({"explain", "triangle", "8", "8", "--size", "16x16", "--margin", "2", "-o", "p.png"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto count = [](const TexelImage& image, const Texel& color) {
    return std::count(image.texel.begin(), image.texel.end(), color);
  };
  const TexelImage picture = read_image_file(folder_ / "p.png");
  EXPECT_GT(count(picture, {0xe8, 0xea, 0xed, 255}), 200) << "samples, frame and text";
  EXPECT_GT(count(picture, {0x4b, 0xa3, 0xe3, 255}), 1000) << "edges and coverage of the one triangle";
  // A pixel is 96 along a side of the picture, and shows the stored colour.
  ASSERT_EQ(run({"render", "triangle", "--size", "16x16", "-o", "r.png"}).status, 0);
  const TexelImage drawn = read_image_file(folder_ / "r.png");
  EXPECT_GT(count(picture, drawn.texel[8 * 16 + 8]), 1000);
}

/// The page in a small stand-in for a browser (tests/cli/explain_page.js), if Node.js is installed.
TEST_F(ExplainCommand, ThePageTellsThePixelThatIsHoveredAndStepsThroughPrimitives) {
  if (paste("command -v node >node.txt").status != 0) GTEST_SKIP() << "no Node.js here";
  ASSERT_EQ(run({"explain", "teapot:2", "20", "16", "--size", "40x32", "--margin", "2", "-o", "p.html"}).status, 0);
  const Outcome outcome = paste("node '" HALFPLANE_SOURCE_DIR "/tests/cli/explain_page.js' p.html");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json page = Json::parse(outcome.out);
  const Json told = pixel("teapot:2", 18, 14, {"--size", "40x32", "--box", "5x5"});
  ASSERT_EQ(page["hovered"].size(), told["pixels"].size());
  for (std::size_t i = 0; i < told["pixels"].size(); ++i) {
    const Json& at = told["pixels"][i];
    const std::string text = page["hovered"][i];
    EXPECT_NE(text.find("Pixel " + at["x"].dump() + " " + at["y"].dump()), std::string::npos) << text;
    EXPECT_NE(text.find("model colour " + at["final"]["model"]["color"].get<std::string>()), std::string::npos) << text;
    for (const Json& entry : at["history"]) {
      if (entry["kind"] == "clear") continue;
      EXPECT_NE(text.find("#" + entry["primitive"].dump() + " triangle"), std::string::npos) << text;
      EXPECT_NE(text.find(entry["why"].get<std::string>()), std::string::npos) << text;
    }
  }
  EXPECT_GT(page["steps"].size(), 2U);
  EXPECT_EQ(page["steps"][0], "0 of " + std::to_string(page["steps"].size() - 1) + ": nothing yet");
  EXPECT_GT(page["painted"]["arc"], 100);
}

/// The same page in a real browser.
TEST_F(ExplainCommand, ThePageOpensInHeadlessChromium) {
  if (paste("for b in chromium chromium-browser google-chrome; do command -v $b && break; done >browser.txt").status !=
          0 ||
      read("browser.txt").empty())
    GTEST_SKIP() << "no Chromium here";
  ASSERT_EQ(run({"explain", "teapot:2", "20", "16", "--size", "40x32", "--margin", "2", "-o", "p.html"}).status, 0);
  const Outcome outcome =
      paste("\"$(cat browser.txt)\" --headless --no-sandbox --disable-gpu --dump-dom \"file://$PWD/p.html\"");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* part : {"Pixel 20 16", "model colour", "Why is this pixel what it is?", "next"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part;
  // A simulated mouse: over the upper left pixel, then a step back.
  const Bytes page = read("p.html");
  std::string text(page.begin(), page.end());
  text.insert(
      text.rfind("</body>"),
      "<script>{const c = document.getElementById('grid'), b = c.getBoundingClientRect();"
      "c.dispatchEvent(new MouseEvent('mousemove', {clientX: b.left + b.width / 10, clientY: b.top + b.height / 10}));"
      "document.getElementById('previous').click();}</script>");
  write("hand.html", text);
  const Outcome moved =
      paste("\"$(cat browser.txt)\" --headless --no-sandbox --disable-gpu --dump-dom \"file://$PWD/hand.html\"");
  ASSERT_EQ(moved.status, 0) << moved.err;
  EXPECT_NE(moved.out.find("<h2 id=\"where\">Pixel 18 14</h2>"), std::string::npos);
  const std::size_t drawn = moved.out.find("<span id=\"drawn\">");
  ASSERT_NE(drawn, std::string::npos);
  const auto steps = [](const std::string& from) { return std::stoi(from); };
  const std::string shown = moved.out.substr(drawn + 17, 40);
  EXPECT_EQ(steps(shown) + 1, steps(shown.substr(shown.find("of ") + 3))) << shown;
}

class RtlExplainCommand : public ExplainCommand {
 protected:
  void SetUp() override { skip_without_rtl(); }
};

TEST_F(RtlExplainCommand, TheRtlsPacketsAreTheModelsInTheSameCycles) {
  const Json told = pixel("teapot:2", 20, 16, {"--size", "40x32", "--box", "4x4", "--rtl"});
  EXPECT_EQ(told["differences"].size(), 0u);
  std::size_t crossings = 0;
  for (const Json& at : told["pixels"]) {
    EXPECT_EQ(at["final"]["rtl"], at["final"]["hardware"]);
    for (const Json& entry : at["history"]) {
      if (entry["rtl"].is_null()) continue;
      EXPECT_EQ(entry["rtl"]["differing"], 0);
      const Json &rtl = entry["rtl"]["packets"], &model = entry["model"]["hardware"]["packets"];
      ASSERT_EQ(rtl.size(), model.size());
      for (std::size_t i = 0; i < rtl.size(); ++i) {
        EXPECT_EQ(rtl[i]["number"], model[i]["number"]);
        EXPECT_EQ(rtl[i]["cycle"], model[i]["cycle"]) << rtl[i]["arrow"];
        crossings += rtl[i]["cycle"].is_number() ? 1 : 0;
      }
    }
  }
  EXPECT_GT(crossings, 100u);
}

TEST_F(RtlExplainCommand, AFaultInTheRtlShowsAtThePixel) {
  bool is_found = false;
  for (const char* mutant : {"11", "12", "13", "14"}) {
    const Outcome outcome =
        run({"explain", "teapot:2", "20", "16", "--size", "40x32", "--box", "8x8", "--rtl", "--mutant", mutant});
    is_found |= outcome.status == 1 && outcome.out.find("model and RTL differ") != std::string::npos;
  }
  EXPECT_TRUE(is_found);
}

}  // namespace
}  // namespace halfplane::cli::explain_test
