// Framebuffers and pictures as files: PNG, NPY, hashes, and writing them whole.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "sim/show/image/framebuffer_files.hpp"
#include "sim/show/image/png.hpp"
#include "sim/show/image/whole_file.hpp"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb_image.h>

namespace halfplane::image_files_test {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

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

}  // namespace
}  // namespace halfplane::image_files_test
