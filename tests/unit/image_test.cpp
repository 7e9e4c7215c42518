// Pictures, the files they become, and what is drawn for people.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "sim/show/image/color_map.hpp"
#include "sim/show/image/framebuffer_files.hpp"
#include "sim/show/image/panel.hpp"
#include "sim/show/image/png.hpp"
#include "sim/show/image/terminal.hpp"
#include "sim/show/image/whole_file.hpp"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb_image.h>

namespace halfplane {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// A folder of this test's own, gone when it ends.
struct ScratchFolder {
  fs::path path = fs::path(testing::TempDir()) / ("halfplane-image-" + std::to_string(getpid()));
  ScratchFolder() {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~ScratchFolder() { fs::remove_all(path); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] std::string file(const std::string& name) const { return (path / name).string(); }
  [[nodiscard]] std::ptrdiff_t entries() const {
    return std::distance(fs::directory_iterator(path), fs::directory_iterator());
  }
};

Bytes read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Bytes as_bytes(std::string_view text) { return {text.begin(), text.end()}; }

template <typename Action>
std::string input_error_of(Action action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

// Every pixel differs, padding included: 5 x 3 visible pixels in rows of 8.
Framebuffer numbered_frame() {
  Framebuffer frame(5, 3, 8);
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    frame.depth[i] = static_cast<std::uint32_t>(1000 * i + 7);
    frame.color[i] = static_cast<std::uint32_t>(0x1234 + 0x0203 * i);
  }
  return frame;
}

TEST(Png, ColorPictureReadsBackBitForBit) {
  Picture picture(7, 5);
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) picture.rgb[i] = static_cast<std::uint8_t>(37 * i + 11);
  const Bytes file = encode_png(picture);
  int width = 0, height = 0, channels = 0;
  stbi_uc* pixels = stbi_load_from_memory(file.data(), static_cast<int>(file.size()), &width, &height, &channels, 0);
  ASSERT_NE(pixels, nullptr);
  EXPECT_EQ(width, 7);
  EXPECT_EQ(height, 5);
  EXPECT_EQ(channels, 3);  // opaque: no alpha channel
  EXPECT_TRUE(std::equal(picture.rgb.begin(), picture.rgb.end(), pixels));
  stbi_image_free(pixels);
}

TEST(Png, DepthReadsBackAsUnscaled16BitGrey) {
  const std::vector<std::uint16_t> samples{0, 1, 255, 256, 0x1234, 65535};
  const Bytes file = encode_png_grey16(3, 2, samples);
  int width = 0, height = 0, channels = 0;
  EXPECT_TRUE(stbi_is_16_bit_from_memory(file.data(), static_cast<int>(file.size())));
  stbi_us* read = stbi_load_16_from_memory(file.data(), static_cast<int>(file.size()), &width, &height, &channels, 0);
  ASSERT_NE(read, nullptr);
  EXPECT_EQ(width, 3);
  EXPECT_EQ(height, 2);
  EXPECT_EQ(channels, 1);
  EXPECT_TRUE(std::equal(samples.begin(), samples.end(), read));
  stbi_image_free(read);
  const std::string gamma = "gAMA";  // with it, viewers would change the values
  EXPECT_EQ(std::search(file.begin(), file.end(), gamma.begin(), gamma.end()), file.end());
}

TEST(Png, PictureWithoutPixelsIsRefused) {
  EXPECT_NE(input_error_of([] { (void)encode_png(Picture()); }).find("give it a size"), std::string::npos);
  EXPECT_NE(input_error_of([] { (void)encode_png_grey16(0, 4, {}); }).find("give it a size"), std::string::npos);
}

TEST(Png, WidthThatLibpngRefusesIsOneLineWithItsReason) {
  const std::vector<std::uint16_t> row(1'000'001);  // libpng's own limit is 1,000,000
  const std::string message = input_error_of([&] { (void)encode_png_grey16(1'000'001, 1, row); });
  EXPECT_NE(message.find("write a .npy instead"), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(WholeFile, ReplacesAFileAndLeavesNothingElse) {
  const ScratchFolder folder;
  write_whole_file(folder.file("a.bin"), as_bytes("old and longer"));
  write_whole_file(folder.file("a.bin"), as_bytes("new"));
  EXPECT_EQ(read_bytes(folder.file("a.bin")), as_bytes("new"));
  EXPECT_EQ(folder.entries(), 1);
}

TEST(WholeFile, MissingFolderIsNamedWithItsMend) {
  const ScratchFolder folder;
  const std::string path = folder.file("none/a.png");
  const std::string message = input_error_of([&] { write_png(path, Picture(1, 1)); });
  EXPECT_NE(message.find(path), std::string::npos) << message;
  EXPECT_NE(message.find("create its folder first"), std::string::npos) << message;
  EXPECT_EQ(folder.entries(), 0);
}

TEST(WholeFile, FolderInPlaceOfAFileIsRefused) {
  const ScratchFolder folder;
  EXPECT_NE(input_error_of([&] { write_whole_file(folder.path.string(), as_bytes("x")); }).find("directory"),
            std::string::npos);
  EXPECT_EQ(folder.entries(), 0);
}

TEST(WholeFile, FullDiskIsReported) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const std::string message = input_error_of([] { write_whole_file("/dev/full", Bytes(100'000, 1)); });
  EXPECT_NE(message.find("free some space"), std::string::npos) << message;
}

TEST(WholeFile, DeviceIsWrittenToRatherThanReplaced) {
  write_whole_file("/dev/null", as_bytes("x"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(WholeFile, SymbolicLinkKeepsPointingAtItsTarget) {
  const ScratchFolder folder;
  write_whole_file(folder.file("target"), as_bytes("old"));
  fs::create_symlink(folder.path / "target", folder.path / "link");
  write_whole_file(folder.file("link"), as_bytes("new"));
  EXPECT_TRUE(fs::is_symlink(folder.path / "link"));
  EXPECT_EQ(read_bytes(folder.file("target")), as_bytes("new"));
}

TEST(Npy, HeaderAndDataAreExactlyFormatOne) {
  const std::vector<std::uint32_t> values{1, 2, 3, 0x01020304, 0xffffffff, 6};
  Bytes expected = as_bytes(std::string_view("\x93NUMPY\x01\x00\x76\x00", 10));  // 0x76: 118 bytes of header follow
  std::string header = "{'descr': '<u4', 'fortran_order': False, 'shape': (2, 3), }";
  header.resize(117, ' ');
  header += '\n';
  expected.insert(expected.end(), header.begin(), header.end());
  ASSERT_EQ(expected.size() % 64, 0u);
  for (const int byte : {1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4, 3, 2, 1, 255, 255, 255, 255, 6, 0, 0, 0})
    expected.push_back(static_cast<std::uint8_t>(byte));
  EXPECT_EQ(encode_npy(3, 2, std::span(values)), expected);
}

TEST(Npy, SignedIdsAreI4WithMinusOneAsAllOnes) {
  const std::vector<std::int32_t> ids{-1, 5};
  const Bytes file = encode_npy(2, 1, std::span(ids));
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  EXPECT_NE(text.find("'descr': '<i4'"), std::string_view::npos);
  EXPECT_NE(text.find("'shape': (1, 2)"), std::string_view::npos);
  EXPECT_EQ(Bytes(file.end() - 8, file.end()), (Bytes{255, 255, 255, 255, 5, 0, 0, 0}));
}

TEST(Npy, AnyShapeStartsItsDataAtAMultipleOf64) {
  const std::vector<std::uint32_t> none;
  for (int width = 1; width < 100'000'000; width = width * 3 + 1)
    EXPECT_EQ(encode_npy(width, 7, std::span(none)).size() % 64, 0u) << width;
}

TEST(Npy, OtherExtensionIsRefused) {
  const std::vector<std::uint32_t> values{1};
  EXPECT_NE(input_error_of([&] { write_npy("count.txt", 1, 1, std::span(values)); }).find(".npy"), std::string::npos);
  EXPECT_FALSE(fs::exists("count.txt"));
}

TEST(DepthFile, NpyAndPngHoldTheVisibleCodesOnly) {
  const ScratchFolder folder;
  Framebuffer frame = numbered_frame();
  write_depth(folder.file("z.npy"), frame, 24);
  std::vector<std::uint32_t> expected;
  for (const std::uint32_t index : {0u, 1u, 2u, 3u, 4u, 8u, 9u, 10u, 11u, 12u, 16u, 17u, 18u, 19u, 20u})
    expected.push_back(1000 * index + 7);
  EXPECT_EQ(read_bytes(folder.file("z.npy")), encode_npy(5, 3, std::span(expected)));

  write_depth(folder.file("z.PNG"), frame, 16);
  const std::vector<std::uint16_t> samples(expected.begin(), expected.end());
  EXPECT_EQ(read_bytes(folder.file("z.PNG")), encode_png_grey16(5, 3, samples));
}

TEST(DepthFile, MoreThan16BitsInAPngNamesNpyAsTheMend) {
  const std::string message = input_error_of([] { check_depth_path("z.png", 17); });
  EXPECT_NE(message.find("'z.png'"), std::string::npos) << message;
  EXPECT_NE(message.find("write a .npy instead"), std::string::npos) << message;
  EXPECT_NO_THROW(check_depth_path("z.png", 16));
  EXPECT_NO_THROW(check_depth_path("z.npy", 32));
  EXPECT_THROW(check_depth_path("z.exr", 16), InputError);
  EXPECT_THROW(check_depth_path("z", 16), InputError);
}

TEST(ColorPicture, Rgb565IsExpandedByBitReplication) {
  Framebuffer frame(5, 1, 8);
  const std::vector<std::uint32_t> codes{0x0000, 0xffff, 0x8410, 0x0821, 0x7bef};
  std::copy(codes.begin(), codes.end(), frame.color.begin());
  const Picture picture = color_picture(frame, ColorFormat::rgb565);
  EXPECT_EQ(picture.get(0, 0), (Rgb{0, 0, 0}));
  EXPECT_EQ(picture.get(1, 0), (Rgb{255, 255, 255}));
  EXPECT_EQ(picture.get(2, 0), (Rgb{132, 130, 132}));  // 10000 -> 10000100, 100000 -> 10000010
  EXPECT_EQ(picture.get(3, 0), (Rgb{8, 4, 8}));        // 00001 -> 00001000, 000001 -> 00000100
  EXPECT_EQ(picture.get(4, 0), (Rgb{123, 125, 123}));  // 01111 -> 01111011, 011111 -> 01111101
}

TEST(ColorPicture, Rgba8888DropsAlpha) {
  Framebuffer frame(1, 1, 4);
  frame.color[0] = 0x44332211;
  EXPECT_EQ(color_picture(frame, ColorFormat::rgba8888).get(0, 0), (Rgb{0x11, 0x22, 0x33}));
}

TEST(Hash, PublishedFnvVectorsHold) {
  EXPECT_EQ(fnv1a64({}), 0xcbf29ce484222325u);
  EXPECT_EQ(fnv1a64(as_bytes("a")), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(fnv1a64(as_bytes("foobar")), 0x85944171f73967e8u);
}

TEST(Hash, ImagesHashAsTheirVisibleBytesInTheOrderOfTheContract) {
  const Framebuffer frame = numbered_frame();
  Bytes color565, color8888, depth;
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x) {
      const std::uint32_t c = frame.color[static_cast<std::size_t>(8 * y + x)];
      const std::uint32_t z = frame.depth[static_cast<std::size_t>(8 * y + x)];
      for (const std::uint32_t byte : {c & 255, c >> 8 & 255}) color565.push_back(static_cast<std::uint8_t>(byte));
      for (const std::uint32_t byte : {c & 255, c >> 8 & 255, c >> 16 & 255, c >> 24})
        color8888.push_back(static_cast<std::uint8_t>(byte));
      for (const std::uint32_t byte : {z & 255, z >> 8 & 255, z >> 16 & 255, z >> 24})
        depth.push_back(static_cast<std::uint8_t>(byte));
    }
  }
  EXPECT_EQ(std::stoull(color_hash(frame, ColorFormat::rgb565), nullptr, 16), fnv1a64(color565));
  EXPECT_EQ(std::stoull(color_hash(frame, ColorFormat::rgba8888), nullptr, 16), fnv1a64(color8888));
  EXPECT_EQ(std::stoull(depth_hash(frame), nullptr, 16), fnv1a64(depth));
}

TEST(Hash, PaddingOfTheRowsDoesNotMatter) {
  Framebuffer frame = numbered_frame();
  const std::string before = depth_hash(frame);
  frame.depth[5] += 1;  // x = 5 of a 5-pixel row
  EXPECT_EQ(depth_hash(frame), before);
  frame.depth[4] += 1;
  EXPECT_NE(depth_hash(frame), before);
}

TEST(Hash, IsSixteenLowercaseHexDigitsWithLeadingZeros) {
  Framebuffer frame(1, 1, 1);
  bool leading_zero = false;
  for (std::uint32_t code = 0; code < 200; ++code) {
    frame.depth[0] = code;
    const std::string text = depth_hash(frame);
    ASSERT_EQ(text.size(), 16u);
    ASSERT_EQ(text.find_first_not_of("0123456789abcdef"), std::string::npos) << text;
    leading_zero = leading_zero || text[0] == '0';
  }
  EXPECT_TRUE(leading_zero);  // otherwise the padding was never tried
}

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
  EXPECT_DOUBLE_EQ(nice_ceiling(0.71), 1);
  EXPECT_DOUBLE_EQ(nice_ceiling(0.2), 0.2);
  EXPECT_DOUBLE_EQ(nice_ceiling(0.0201), 0.05);
  EXPECT_DOUBLE_EQ(nice_ceiling(340), 500);
  EXPECT_DOUBLE_EQ(nice_ceiling(0), 1);
  EXPECT_DOUBLE_EQ(nice_ceiling(std::nan("")), 1);
  for (double value = 1e-6; value < 1e6; value *= 1.37) EXPECT_GE(nice_ceiling(value) * (1 + 1e-8), value);
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
  const std::vector<float> errors{0.7f, -0.7f, 0.0f, kNan};
  const Panel panel = error_panel("depth error", 4, 1, errors, "LSB", true);
  EXPECT_DOUBLE_EQ(std::get<ScaleLegend>(panel.legend).range, 1);
  EXPECT_EQ(panel.caption, "depth error, LSB");
  EXPECT_EQ(panel.picture.get(0, 0), diverging_color(static_cast<double>(0.7f)));
  EXPECT_EQ(panel.picture.get(1, 0), diverging_color(-static_cast<double>(0.7f)));
  EXPECT_EQ(panel.picture.get(2, 0), diverging_color(0));
  EXPECT_EQ(panel.picture.get(3, 0), kNotCompared);
}

TEST(Panel, OutlierDoesNotFlattenTheScaleButIsCounted) {
  std::vector<float> errors(1000, 0.3f);
  errors[500] = -5000;
  const Panel panel = error_panel("depth error", 100, 10, errors, "LSB", true);
  EXPECT_DOUBLE_EQ(std::get<ScaleLegend>(panel.legend).range, 0.5);
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
}  // namespace halfplane
