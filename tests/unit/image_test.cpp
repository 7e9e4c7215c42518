// Pictures for people: colour maps, text, panels, sheets, previews.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/show/image/color_map.hpp"
#include "sim/show/image/panel.hpp"
#include "sim/show/image/terminal.hpp"

namespace halfplane::image_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// CIE 1976 lightness, by its own formula: independent of the space the map is made in.
double lightness(Rgb c) {
  const auto linear = [](int byte) {
    const double s = byte / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  };
  const double y = 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

TEST(ColorMap, SequentialLightnessRisesWithTheValue) {
  for (int i = 1; i <= 256; ++i)
    EXPECT_GE(lightness(sequential_color(i / 256.0)) + 0.5, lightness(sequential_color((i - 1) / 256.0))) << i;
  EXPECT_GT(lightness(sequential_color(1)) - lightness(sequential_color(0)), 60);
}

TEST(ColorMap, DivergingErrorsOfEqualSizeAreEquallyLight) {
  for (int i = 0; i <= 100; ++i) {
    const double t = i / 100.0;
    EXPECT_NEAR(lightness(diverging_color(t)), lightness(diverging_color(-t)), 6) << t;
    EXPECT_LE(lightness(diverging_color(t)), lightness(diverging_color(t - 0.01)) + (i == 0 ? 100 : 0.5)) << t;
  }
  EXPECT_GT(diverging_color(1).r, diverging_color(1).b + 80);    // positive: red
  EXPECT_GT(diverging_color(-1).b, diverging_color(-1).r + 80);  // negative: blue
  EXPECT_EQ(diverging_color(5), diverging_color(1));
}

TEST(ColorMap, ScaleEndsAreRoundAndHoldTheValue) {
  EXPECT_DOUBLE_EQ(nice_ceiling(0.71), 0.8);
  EXPECT_DOUBLE_EQ(nice_ceiling(0.2), 0.2);
  EXPECT_DOUBLE_EQ(nice_ceiling(0.0201), 0.024);
  EXPECT_DOUBLE_EQ(nice_ceiling(340), 400);
  EXPECT_DOUBLE_EQ(nice_ceiling(0), 1);
  EXPECT_DOUBLE_EQ(nice_ceiling(std::nan("")), 1);
  for (double value = 1e-6; value < 1e6; value *= 1.37) {
    EXPECT_GE(nice_ceiling(value) * (1 + 1e-8), value);
    EXPECT_LE(nice_ceiling(value) * 0.75 * (1 - 1e-8), value) << "of a scale no more than a quarter is unused";
  }
}

bool has_ink(const Picture& picture, const Rect& rect) {
  for (int y = rect.y; y < rect.y + rect.height; ++y)
    for (int x = rect.x; x < rect.x + rect.width; ++x)
      if (!(picture.get(x, y) == Rgb{})) return true;
  return false;
}

TEST(Text, StaysInsideItsMeasuredBoxAtEveryScale) {
  std::string all;
  for (char c = ' '; c <= '~'; ++c) all += c;
  for (const int scale : {1, 2, 3}) {
    const int width = text_width(all, scale), height = text_height(scale);
    Picture picture(width + 20, height + 20);
    draw_text(picture, 10, 10, all, {255, 255, 255}, scale);
    EXPECT_TRUE(has_ink(picture, {10, 10, width, height}));
    EXPECT_FALSE(has_ink(picture, {0, 0, width + 20, 10}));
    EXPECT_FALSE(has_ink(picture, {0, 10 + height, width + 20, 10}));
    EXPECT_FALSE(has_ink(picture, {0, 0, 10, height + 20}));
    EXPECT_FALSE(has_ink(picture, {10 + width, 0, 10, height + 20}));
  }
}

TEST(Text, BytesWithoutAGlyphShowAsQuestionMarks) {
  Picture with(40, 12), without(40, 12);
  draw_text(with, 0, 0, "a\xc3\x7f\n", {255, 255, 255}, 1);
  draw_text(without, 0, 0, "a???", {255, 255, 255}, 1);
  EXPECT_EQ(with.rgb, without.rgb);
}

TEST(Text, AccentedLettersShowWithoutTheirAccentsAndOthersAsOneQuestionMark) {
  const auto drawn = [](std::string_view text) {
    Picture picture(200, 12);
    draw_text(picture, 0, 0, text, {255, 255, 255}, 1);
    return picture.rgb;
  };
  EXPECT_EQ(drawn("Zähne-Łódź-ß-Čapek.hpt"), drawn("Zahne-Lodz-s-Capek.hpt"));
  EXPECT_EQ(drawn("a\xcc\x88 – 3×2 µm"), drawn("a - 3x2 um"));  // the first: a letter and its mark apart
  EXPECT_EQ(drawn("茶壺 1"), drawn("?? 1"));
  EXPECT_EQ(drawn("\xf0\x9f\xab\x96."), drawn("?."));
  EXPECT_EQ(drawn("a\xe8\x8c"), drawn("a?")) << "half a character is none";
  EXPECT_EQ(text_width("äöü", 2), text_width("aou", 2));
}

TEST(Text, LongTextIsWrappedBetweenWordsAndNothingIsCut) {
  EXPECT_EQ(wrap_text("depth error", 500, 2), std::vector<std::string>{"depth error"});
  EXPECT_EQ(wrap_text("", 500, 2), std::vector<std::string>{""});
  const std::string bound = "  depth: 3.214 LSB from the exact plane through the snapped vertices (bound 0.67)";
  for (const int width : {200, 260, 333, 480, 1000}) {
    std::string words;
    const auto lines = wrap_text(bound, width, 2);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      EXPECT_LE(text_width(lines[i], 2), width) << lines[i];
      EXPECT_TRUE(lines[i].starts_with(i == 0 ? "  d" : "    ")) << lines[i];
      words += (i == 0 ? "" : " ") + lines[i].substr(lines[i].find_first_not_of(' '));
    }
    EXPECT_EQ(words, bound.substr(2));
  }
}

TEST(Text, AWordWiderThanItsLineIsBrokenBetweenCharacters) {
  std::string word;
  for (int i = 0; i < 40; ++i) word += "ä";
  std::string joined;
  for (const std::string& line : wrap_text(word, 100, 2)) {
    EXPECT_LE(text_width(line, 2), 100);
    joined += line.substr(line.find_first_not_of(' '));
    EXPECT_EQ(line.substr(line.find_first_not_of(' ')).size() % 2, 0u) << "no half of an ä";
  }
  EXPECT_EQ(joined, word);
}

TEST(Panel, CoverageClassesAreCountedAndTakeTheirLegendsColor) {
  using enum CoverageClass;
  const std::vector<CoverageClass> classes{none, both, missing, extra, other, both};
  const Panel panel = coverage_panel(6, 1, classes);
  const auto& legend = std::get<std::vector<LegendEntry>>(panel.legend);
  ASSERT_EQ(legend.size(), 5u);
  EXPECT_EQ(legend[1].label, "both 2");
  EXPECT_EQ(legend[2].label, "missing 1");
  for (int x = 0; x < 5; ++x) EXPECT_EQ(panel.picture.get(x, 0), legend[static_cast<std::size_t>(x)].color) << x;
}

TEST(Panel, ErrorsAreSignedSymmetricAndDarkWhereNotCompared) {
  const std::vector<float> errors{0.75f, -0.75f, 0.0f, kNan};
  const Panel panel = error_panel("depth error", 4, 1, errors, "LSB", true);
  EXPECT_DOUBLE_EQ(std::get<ScaleLegend>(panel.legend).range, 0.8);
  EXPECT_EQ(panel.caption, "depth error, LSB");
  EXPECT_EQ(panel.picture.get(0, 0), diverging_color(0.75 / 0.8));
  EXPECT_EQ(panel.picture.get(1, 0), diverging_color(-0.75 / 0.8));
  EXPECT_EQ(panel.picture.get(2, 0), diverging_color(0));
  EXPECT_EQ(panel.picture.get(3, 0), kNotCompared);
}

TEST(Panel, OutlierDoesNotFlattenTheScaleButIsCounted) {
  std::vector<float> errors(1000, 0.3f);
  errors[500] = -5000;
  const Panel panel = error_panel("depth error", 100, 10, errors, "LSB", true);
  EXPECT_DOUBLE_EQ(std::get<ScaleLegend>(panel.legend).range, 0.4);
  EXPECT_NE(panel.note.find("max 5e+03"), std::string::npos) << panel.note;
  EXPECT_NE(panel.note.find("beyond scale: 1"), std::string::npos) << panel.note;
}

TEST(Panel, NothingComparedIsSaid) {
  const std::vector<float> errors(4, kNan);
  EXPECT_EQ(error_panel("depth error", 2, 2, errors, "LSB", true).note, "no pixel compared");
}

TEST(Panel, FiguresThatAreSaidElsewhereReplaceThePixelsOwn) {
  const std::vector<float> errors{0.25f, 0.5f};
  EXPECT_EQ(error_panel("colour error", 2, 1, errors, "LSB", false, "max 0.500  rms 0.3 of all channels").note,
            "max 0.500  rms 0.3 of all channels");
}

TEST(Panel, LogarithmicScaleEndsAtDecadesAndItsNumbersStandAtTheirColours) {
  const std::vector<float> cycles{0, 0.3f, 1, 10, 700};
  const Panel panel = log_panel("cycles of each pixel", 5, 1, cycles, "cycles", "none");
  EXPECT_EQ(panel.caption, "cycles of each pixel, logarithmic");
  const auto& scale = std::get<ScaleLegend>(panel.legend);
  EXPECT_DOUBLE_EQ(scale.low, 0.1);
  EXPECT_DOUBLE_EQ(scale.range, 1000);
  EXPECT_EQ(scale.rest, "none");
  EXPECT_EQ(panel.picture.get(0, 0), kNotCompared);
  const auto ticks = scale_ticks(scale, 400);
  ASSERT_EQ(ticks.size(), 5u);
  for (const auto& [pixel, tick, label] : {std::tuple{2, 1U, "1"}, {3, 2U, "10"}}) {
    EXPECT_EQ(ticks[tick].label, label);
    EXPECT_EQ(panel.picture.get(pixel, 0), sequential_color(ticks[tick].at)) << label;
  }
  EXPECT_EQ(ticks.back().label, "1000");
  EXPECT_EQ(scale_ticks(scale, 30).size(), 2u) << "no room for more than the ends";
}

TEST(Panel, LogarithmicScaleSaysThatLessIsLeftToItsEnd) {
  const std::vector<float> values{1e-7f, 5};
  const auto scale = std::get<ScaleLegend>(log_panel("error", 2, 1, values, "", "none").legend);
  EXPECT_DOUBLE_EQ(scale.low, 1e-3);
  EXPECT_EQ(scale_ticks(scale, 400).front().label, "<0.001");
  const std::vector<float> nothing(3, 0);
  EXPECT_EQ(log_panel("error", 3, 1, nothing, "", "none").note, "no pixel has any");
}

TEST(Panel, ReducedPictureKeepsTheOneMissingPixel) {
  const int width = 2 * kMaxPanelSide + 1;
  std::vector<CoverageClass> classes(static_cast<std::size_t>(width) * 2, CoverageClass::both);
  classes[static_cast<std::size_t>(width) + 301] = CoverageClass::missing;  // x = 301, y = 1: reduced by 3 to (100, 0)
  const Panel panel = coverage_panel(width, 2, classes);
  ASSERT_LE(panel.picture.width, kMaxPanelSide);
  const auto& legend = std::get<std::vector<LegendEntry>>(panel.legend);
  EXPECT_EQ(panel.picture.get(100, 0), legend[2].color);
  EXPECT_EQ(panel.picture.get(99, 0), legend[1].color);
  EXPECT_NE(panel.caption.find("worst of 3x3"), std::string::npos) << panel.caption;
}

/// The columns of a picture beside its left cell: where text of that cell must not be.
bool is_clear_between(const Picture& sheet, int from, int to) {
  for (int y = 0; y < sheet.height; ++y)
    for (int x = from; x < to; ++x)
      if (!(sheet.get(x, y) == sheet.get(0, 0))) return false;
  return true;
}

TEST(Sheet, TextStaysInItsCellHoweverLongItIs) {
  std::string words;
  for (int i = 0; i < 40; ++i) words += "from the exact plane ";
  Panel text;
  text.caption = words;
  text.lines = {words, "name\tmax\trms", words.substr(0, 60) + "\t0.591\t0.2512", "last"};
  Panel picture;
  picture.caption = words;
  picture.note = words;
  picture.picture = Picture(4, 4, {1, 2, 3});
  const std::vector<Panel> panels{picture, text};
  const Picture sheet = compose_sheet(words, panels, 2);
  const int cell = (sheet.width - 3 * 24) / 2;  // margins of 24
  const Picture untitled = compose_sheet("", panels, 2);
  EXPECT_TRUE(is_clear_between(untitled, 24 + cell, 24 + cell + 24));
  EXPECT_TRUE(is_clear_between(untitled, untitled.width - 24, untitled.width));
  EXPECT_TRUE(is_clear_between(sheet, sheet.width - 24, sheet.width));
  EXPECT_GT(sheet.height, untitled.height + 60) << "a title of several lines";
}

TEST(Sheet, SmallPixelsBecomeWholeBlocksOfAllPanels) {
  ComparisonSheet comparison;
  comparison.title = "two pixels";
  comparison.width = 2;
  comparison.height = 1;
  comparison.model = Picture(2, 1, {200, 10, 20});
  comparison.golden = Picture(2, 1, {10, 200, 20});
  comparison.coverage = {CoverageClass::both, CoverageClass::missing};
  comparison.depth_error = {0.5f, kNan};
  comparison.color_error = {0.0f, kNan};
  const Picture sheet = comparison_sheet(comparison);
  std::size_t model_pixels = 0, golden_pixels = 0;
  for (int y = 0; y < sheet.height; ++y)
    for (int x = 0; x < sheet.width; ++x) {
      model_pixels += sheet.get(x, y) == Rgb{200, 10, 20} ? 1 : 0;
      golden_pixels += sheet.get(x, y) == Rgb{10, 200, 20} ? 1 : 0;
    }
  EXPECT_GT(model_pixels, 10'000u);  // enlarged
  EXPECT_EQ(model_pixels, golden_pixels);
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(model_pixels / 2)));
  EXPECT_EQ(model_pixels, 2 * side * side);  // by one whole factor
}

TEST(Shrink, BlocksAreAveragedAlsoAtTheEdges) {
  Picture picture(3, 1);
  picture.rgb = {10, 0, 0, 20, 0, 3, 90, 7, 0};
  const Picture small = shrink(picture, 2);
  ASSERT_EQ(small.width, 2);
  EXPECT_EQ(small.get(0, 0), (Rgb{15, 0, 2}));  // 1.5 rounds up
  EXPECT_EQ(small.get(1, 0), (Rgb{90, 7, 0}));  // a block of one pixel
}

std::size_t count_of(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

TEST(Terminal, ColorPreviewHasTwoPixelsPerCellAndTheirExactColors) {
  Picture picture(2, 2);
  picture.rgb = {255, 0, 0, 255, 0, 0, 0, 0, 255, 0, 255, 0};
  const std::string text = terminal_preview(picture, {2, 1}, TerminalStyle::color);
  EXPECT_EQ(text,
            "\x1b[38;2;255;0;0m\x1b[48;2;0;0;255m\xe2\x96\x80"
            "\x1b[48;2;0;255;0m\xe2\x96\x80\x1b[0m\n");
}

TEST(Terminal, LargePictureFitsTheCellsAndKeepsItsShape) {
  const Picture picture(640, 480, {90, 90, 90});
  const std::string text = terminal_preview(picture, {80, 40}, TerminalStyle::color);
  EXPECT_EQ(count_of(text, "\n"), 30u);  // 80 x 60 pixels
  EXPECT_EQ(count_of(text, "\xe2\x96\x80"), 80u * 30);
  EXPECT_EQ(count_of(text, "38;2;90;90;90m"), 30u);  // the average of one colour is that colour
  const std::string low = terminal_preview(picture, {80, 10}, TerminalStyle::color);
  EXPECT_EQ(count_of(low, "\n"), 10u);
}

TEST(Terminal, SmallPictureIsEnlargedByAWholeFactor) {
  const std::string text = terminal_preview(Picture(16, 16, {1, 2, 3}), {80, 40}, TerminalStyle::color);
  EXPECT_EQ(count_of(text, "\n"), 40u);
  EXPECT_EQ(count_of(text, "\xe2\x96\x80"), 80u * 40);
}

TEST(Terminal, PlainPreviewIsAsciiAndBrighterIsDenser) {
  Picture picture(4, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x) {
      const auto grey = static_cast<std::uint8_t>(85 * x);
      set_pixel(picture, x, y, {grey, grey, grey});
    }
  EXPECT_EQ(terminal_preview(picture, {4, 1}, TerminalStyle::plain), " -*@\n");
}

TEST(Terminal, ColorNeedsATerminalThatWantsIt) {
  EXPECT_EQ(terminal_style(true, nullptr, "xterm"), TerminalStyle::color);
  EXPECT_EQ(terminal_style(true, "", "xterm"), TerminalStyle::color);  // empty means not set
  EXPECT_EQ(terminal_style(true, "1", "xterm"), TerminalStyle::plain);
  EXPECT_EQ(terminal_style(true, nullptr, "dumb"), TerminalStyle::plain);
  EXPECT_EQ(terminal_style(true, nullptr, nullptr), TerminalStyle::plain);
  EXPECT_EQ(terminal_style(false, nullptr, "xterm"), TerminalStyle::plain);
}

TEST(Terminal, ExtremeShapesStillGiveOneLine) {
  EXPECT_EQ(count_of(terminal_preview(Picture(5000, 1), {80, 40}, TerminalStyle::plain), "\n"), 1u);
  EXPECT_EQ(count_of(terminal_preview(Picture(1, 5000), {80, 40}, TerminalStyle::plain), "\n"), 40u);
  EXPECT_EQ(terminal_preview(Picture(), {80, 40}, TerminalStyle::color), "");
}

}  // namespace
}  // namespace halfplane::image_test
