// The files of `halfplane render`: formats, hashes recomputed from the contents, and writes that fail.
#include <algorithm>

#include "program.hpp"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb_image.h>

namespace halfplane::cli::files_test {
namespace {

class RenderFiles : public Cli {
 protected:
  void render(Arguments arguments) const {
    arguments.insert(arguments.begin(), "render");
    arguments.push_back("--quiet");
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
};

/// FNV-1a 64, implemented again from its definition: the program's own must not judge itself.
std::string fnv1a(const Bytes& bytes) {
  std::uint64_t hash = 14695981039346656037u;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 1099511628211u;
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

/// A parsed array file: format 1.0, four bytes an element, C order.
struct Array {
  std::string type;
  int width = 0, height = 0;
  Bytes data;
  [[nodiscard]] std::uint32_t at(int x, int y) const {
    const std::size_t i =
        4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return data[i] | std::uint32_t{data[i + 1]} << 8 | std::uint32_t{data[i + 2]} << 16 |
           std::uint32_t{data[i + 3]} << 24;
  }
};

Array parse_npy(const Bytes& file) {
  Array array;
  const Bytes magic{0x93, 'N', 'U', 'M', 'P', 'Y', 1, 0};
  if (file.size() < 10 || !std::equal(magic.begin(), magic.end(), file.begin())) {
    ADD_FAILURE() << "no array file of format 1.0";
    return array;
  }
  const std::size_t start = 10 + file[8] + 256u * file[9];
  EXPECT_EQ(start % 64, 0u);
  const std::string header(file.begin() + 10, file.begin() + static_cast<std::ptrdiff_t>(start));
  char type[4] = {};
  const int fields = std::sscanf(header.c_str(), "{'descr': '%3[^']', 'fortran_order': False, 'shape': (%d, %d), }",
                                 type, &array.height, &array.width);
  EXPECT_EQ(fields, 3) << header;
  EXPECT_EQ(header.back(), '\n');
  array.type = type;
  array.data.assign(file.begin() + static_cast<std::ptrdiff_t>(start), file.end());
  EXPECT_EQ(array.data.size(), 4u * static_cast<std::size_t>(array.width) * static_cast<std::size_t>(array.height));
  return array;
}

struct PngHead {
  std::uint32_t width = 0, height = 0;
  int depth = 0, color_type = -1;
  bool operator==(const PngHead&) const = default;
};

PngHead png_head(const Bytes& file) {
  const Bytes signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13, 'I', 'H', 'D', 'R'};
  if (file.size() < 26 || !std::equal(signature.begin(), signature.end(), file.begin())) return {};
  const auto word = [&file](std::size_t i) {
    return std::uint32_t{file[i]} << 24 | std::uint32_t{file[i + 1]} << 16 | std::uint32_t{file[i + 2]} << 8 |
           file[i + 3];
  };
  return {word(16), word(20), file[24], file[25]};
}

constexpr int kRgb = 2, kGrey = 0;  // PNG colour types

/// The pixels of an 8-bit RGB picture, three bytes each.
Bytes png_pixels(const Bytes& file) {
  int width = 0, height = 0, channels = 0;
  stbi_uc* data = stbi_load_from_memory(file.data(), static_cast<int>(file.size()), &width, &height, &channels, 3);
  if (data == nullptr) return {};
  Bytes pixels(data, data + 3 * width * height);
  stbi_image_free(data);
  return pixels;
}

TEST_F(RenderFiles, ColorPictureHoldsTheHashedRgb565Buffer) {
  render({"teapot", "--size", "101x67", "-o", "color.png", "--json=result.json"});
  EXPECT_EQ(png_head(read("color.png")), (PngHead{101, 67, 8, kRgb}));
  const Bytes pixels = png_pixels(read("color.png"));
  ASSERT_EQ(pixels.size(), 3u * 101 * 67);
  Bytes stored;
  for (std::size_t i = 0; i < pixels.size(); i += 3) {
    const unsigned r = pixels[i] >> 3, g = pixels[i + 1] >> 2, b = pixels[i + 2] >> 3, code = r << 11 | g << 5 | b;
    EXPECT_EQ(pixels[i], r << 3 | r >> 2);  // expanded by bit replication
    EXPECT_EQ(pixels[i + 1], g << 2 | g >> 4);
    stored.push_back(static_cast<std::uint8_t>(code & 255));
    stored.push_back(static_cast<std::uint8_t>(code >> 8));
  }
  EXPECT_EQ(fnv1a(stored), Json::parse(read("result.json"))["color_hash"]);
}

TEST_F(RenderFiles, ColorPictureHoldsTheHashedRgba8888Buffer) {
  render({"teapot", "--config", "full", "--size", "101x67", "-o", "color.png", "--json=result.json"});
  const Bytes pixels = png_pixels(read("color.png"));
  ASSERT_EQ(pixels.size(), 3u * 101 * 67);
  Bytes stored;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    stored.push_back(pixels[i]);
    if (i % 3 == 2) stored.push_back(255);  // the teapot is opaque
  }
  EXPECT_EQ(fnv1a(stored), Json::parse(read("result.json"))["color_hash"]);
}

TEST_F(RenderFiles, DepthArrayHoldsTheHashedCodesOfEveryPreset) {
  for (const char* config : {"tiny", "embedded", "full"}) {
    render({"teapot", "--config", config, "--size", "15x11", "--depth", "depth.npy", "--json=result.json"});
    const Array depth = parse_npy(read("depth.npy"));
    EXPECT_EQ(depth.type, "<u4");
    EXPECT_EQ(depth.width, 15);
    EXPECT_EQ(depth.height, 11);
    EXPECT_EQ(fnv1a(depth.data), Json::parse(read("result.json"))["depth_hash"]) << config;
  }
}

TEST_F(RenderFiles, DepthPictureHoldsTheCodesUnscaled) {
  for (const char* config : {"tiny", "embedded"}) {
    render({"teapot", "--config", config, "--size", "16x13", "--depth", "depth.png"});
    render({"teapot", "--config", config, "--size", "16x13", "--depth", "depth.npy"});
    const Bytes file = read("depth.png");
    ASSERT_EQ(png_head(file), (PngHead{16, 13, 16, kGrey}));
    const Array codes = parse_npy(read("depth.npy"));
    int width = 0, height = 0, channels = 0;
    stbi_us* data = stbi_load_16_from_memory(file.data(), static_cast<int>(file.size()), &width, &height, &channels, 1);
    ASSERT_NE(data, nullptr);
    for (int i = 0; i < 16 * 13; ++i) EXPECT_EQ(data[i], codes.at(i % 16, i / 16)) << config;
    stbi_image_free(data);
  }
}

TEST_F(RenderFiles, DepthPictureAboveSixteenBitsIsRefused) {
  render({"triangle", "--set", "depth.bits=16", "--depth", "depth.png"});
  std::filesystem::remove(folder_ / "depth.png");
  expect_refused({"render", "triangle", "--set", "depth.bits=17", "--depth", "depth.png"}, "16-bit PNG");
  expect_refused({"render", "triangle", "--config", "full", "--depth", "depth.png"}, ".npy");
}

// Two triangles in window space, drawn back to front. Row 0 is at the top, and a pixel belongs to its centre.
constexpr const char* kTwoTriangles =
    "halfplane 1\ntarget 4 3\nclear color 255 0 0 255 depth 1\nspace window\n"
    "v 0 0 .5\nv 3 0 .5\nv 0 2 .5\nt 0 1 2\n"
    "v 0 0 .25\nv 1 0 .25\nv 0 1 .25\nv 1 1 .25\nts 3 4 5 6\n";

TEST_F(RenderFiles, CountsIdsAndDepthsOfASmallCaptureAreTheOnesComputedByHand) {
  write("two.hpt", kTwoTriangles);
  render({"two.hpt", "--count", "count.npy", "--ids", "ids.npy", "--depth", "depth.npy"});
  const Array count = parse_npy(read("count.npy")), ids = parse_npy(read("ids.npy")),
              depth = parse_npy(read("depth.npy"));
  EXPECT_EQ(count.type, "<u4");
  EXPECT_EQ(ids.type, "<i4");
  EXPECT_EQ(depth.type, "<u4");
  const std::uint32_t none = 0xffffffff;                          // -1
  const std::uint32_t near = 16384, middle = 32768, far = 65535;  // round(.25 * 65535), round(.5 * 65535)
  const std::uint32_t counts[3][4] = {{2, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 0}};
  const std::uint32_t depths[3][4] = {{near, middle, far, far}, {middle, far, far, far}, {far, far, far, far}};
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      EXPECT_EQ(count.at(x, y), counts[y][x]) << x << ", " << y;
      EXPECT_EQ(depth.at(x, y), depths[y][x]) << x << ", " << y;
      if (x + y > 0) {
        EXPECT_EQ(ids.at(x, y), counts[y][x] == 0 ? none : 0u) << x << ", " << y;
      }
    }
  }
  // The centre lies on the strip's shared edge: one of its two triangles owns it.
  EXPECT_TRUE(ids.at(0, 0) == 1 || ids.at(0, 0) == 2) << ids.at(0, 0);
}

TEST_F(RenderFiles, SceneWithoutTrianglesIsItsClear) {
  write("clear.hpt", "halfplane 1\ntarget 3 2\nclear color 255 0 0 255 depth .5\n");
  const Json json = result({"render", "clear.hpt"});
  Bytes color, depth;
  for (int i = 0; i < 6; ++i) {
    color.insert(color.end(), {0x00, 0xf8});        // R in bits 15...11, little-endian
    depth.insert(depth.end(), {0x00, 0x80, 0, 0});  // round(.5 * 65535) = 32768
  }
  EXPECT_EQ(json["color_hash"], fnv1a(color));
  EXPECT_EQ(json["depth_hash"], fnv1a(depth));
  EXPECT_EQ(json["primitives"]["in"], 0u);
  EXPECT_EQ(json["fragments"]["covered"], 0u);
}

TEST_F(RenderFiles, CountsSumToTheCoveredSamplesAndIdsNamePrimitives) {
  render({"city", "--size", "120x90", "--skip", "none", "--count", "count.npy", "--ids", "ids.npy", "--json=r.json"});
  const Json json = Json::parse(read("r.json"));
  const Array count = parse_npy(read("count.npy")), ids = parse_npy(read("ids.npy"));
  std::uint64_t sum = 0;
  for (int y = 0; y < 90; ++y) {
    for (int x = 0; x < 120; ++x) {
      sum += count.at(x, y);
      const auto id = static_cast<std::int32_t>(ids.at(x, y));
      EXPECT_EQ(id == -1, count.at(x, y) == 0);
      EXPECT_LT(id, json["primitives"]["in"].get<int>());
    }
  }
  EXPECT_GT(sum, 0u);
  EXPECT_EQ(sum, json["fragments"]["covered"].get<std::uint64_t>());
  const Bytes before = read("count.npy");
  render({"city", "--size", "120x90", "--skip", "all", "--count", "count.npy"});
  EXPECT_EQ(read("count.npy"), before);
}

TEST_F(RenderFiles, FileThatCannotBeWrittenIsRefusedBeforeAnyOtherIsWritten) {
  std::filesystem::create_directory(folder_ / "folder");
  std::filesystem::create_directory(folder_ / "folder.npy");
  for (const char* option : {"-o", "--depth", "--count", "--ids"}) {
    const std::string end = std::string(option) == "-o" ? ".png" : ".npy";
    expect_refused({"render", "triangle", "-o", "ok.png", option, "missing/file" + end}, "", 2);
    expect_refused({"render", "triangle", option, "missing/file" + end}, "missing/file" + end);
    expect_refused({"render", "triangle", option, ""}, option);
    expect_refused({"render", "triangle", option}, option);
    expect_refused({"render", "triangle", option, end == ".png" ? "folder" : "folder.npy"}, "folder");
  }
  expect_refused({"render", "triangle", "-o", "ok.png", "--count", "count.txt"}, "count.txt");
  expect_refused({"render", "triangle", "-o", "ok.png", "--ids", "ids"}, ".npy");
  expect_refused({"render", "triangle", "--depth", "depth.txt"}, "depth.txt");
  expect_refused({"render", "triangle", "-o", "ok.png", "--json=missing/result.json"}, "missing/result.json");
  expect_refused({"render", "triangle", "--json=folder"}, "folder");
  expect_refused({"compare", "triangle", "-o", "missing/sheet.png"}, "missing/sheet.png");
}

TEST_F(RenderFiles, FullDiskLeavesTheOldFileAndNoHalfOfANewOne) {
  const Surroundings small_disk{Stdout::captured, 4096, 0, ""};
  expect_refused({"render", "teapot", "-o", "new.png"}, "new.png", 2, small_disk);
  expect_refused({"render", "teapot", "--depth", "new.npy"}, "new.npy", 2, small_disk);
  write("old.png", "old");
  expect_refused({"render", "teapot", "-o", "old.png"}, "old.png", 2, small_disk);
  EXPECT_EQ(read("old.png"), (Bytes{'o', 'l', 'd'}));
  expect_refused({"render", "triangle", "-o", "/dev/full"}, "/dev/full");
  expect_refused({"render", "triangle", "--json=/dev/full"}, "/dev/full");
}

TEST_F(RenderFiles, ExistingFileIsReplacedWhole) {
  write("picture.png", std::string(1 << 20, 'x'));
  render({"triangle", "--size", "8x8", "-o", "picture.png"});
  EXPECT_EQ(png_head(read("picture.png")), (PngHead{8, 8, 8, kRgb}));
  EXPECT_LT(read("picture.png").size(), 1000u);
  EXPECT_EQ(listing(), std::vector<std::string>{"picture.png"});
}

class Streams : public Cli {};

TEST_F(Streams, ACaptureOnStdinIsTheSceneOfTheFile) {
  write("two.hpt", kTwoTriangles);
  Surroundings piped;
  piped.in = "two.hpt";
  for (const char* command : {"render", "compare"}) {
    const Json file = result({command, "two.hpt"});
    const Outcome outcome = run({command, "-", "--quiet", "--json"}, piped);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Json json = Json::parse(outcome.out);
    EXPECT_EQ(json["scene"], "-");
    for (const char* key : {"width", "height", "color_hash", "coverage"}) {
      if (file.contains(key)) {
        EXPECT_EQ(json[key], file[key]) << key;
      }
    }
  }
  write("cut.hpt", "halfplane 1\nv 0 0\n");
  piped.in = "cut.hpt";
  expect_refused({"render", "-"}, "stdin:2: ", 2, piped);
  expect_refused({"render", "-"}, "stdin:1: the file is empty");
  expect_refused({"render", "-", "--camera", "fov=30"}, "--camera: - is a capture");
}

TEST_F(Streams, AFileOnStdoutIsTheFileAndHumanTextGoesToStderr) {
  EXPECT_EQ(run({"render", "triangle", "--size", "64x48", "-o", "a.png", "--depth", "d.npy", "--ids", "i.npy"}).status,
            0);
  for (const auto& [option, file] : {std::pair{"-o", "a.png"}, {"--depth", "d.npy"}, {"--ids", "i.npy"}}) {
    const Outcome outcome = run({"render", "triangle", "--size", "64x48", option, "-"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(Bytes(outcome.out.begin(), outcome.out.end()), read(file)) << option;
    EXPECT_NE(outcome.err.find("primitives  "), std::string::npos) << outcome.err;
  }
  const Outcome sheet = run({"compare", "triangle", "--size", "64x48", "-o", "-", "--quiet"});
  EXPECT_EQ(png_head(Bytes(sheet.out.begin(), sheet.out.end())).depth, 8);
  EXPECT_EQ(sheet.err, "");
  const Outcome xml = run({"stress", "--case", "zero_area", "--config", "tiny", "--seconds", "0.1", "--junit", "-"});
  EXPECT_TRUE(xml.out.starts_with("<?xml")) << xml.out;
  EXPECT_NE(xml.err.find("every bound holds"), std::string::npos) << xml.err;
  EXPECT_FALSE(exists("-"));
}

TEST_F(Streams, TwoResultsOnStdoutAreRefused) {
  expect_refused({"render", "triangle", "-o", "-", "--depth", "-"}, "-o and --depth both write to stdout");
  expect_refused({"render", "triangle", "--json", "--ids", "-"}, "both write to stdout; give one of them a file");
  expect_refused({"stress", "--junit", "-", "--json"}, "both write to stdout");
  EXPECT_EQ(run({"render", "triangle", "-o", "-", "--json=r.json", "--quiet"}).status, 0);
}

TEST_F(Streams, AFullDiskOrAReaderThatWentAwayIsToldOfFilesOnStdoutToo) {
  expect_refused({"render", "triangle", "-o", "-", "--quiet"}, "writing to stdout failed", 2,
                 {Stdout::full_disk, 0, 0, ""});
  const Outcome unread =
      run({"render", "triangle", "-o", "-", "--depth", "d.npy", "--quiet"}, {Stdout::pipe_without_reader, 0, 0, ""});
  EXPECT_EQ(unread.status, 141);
  EXPECT_EQ(unread.err, "");
  EXPECT_TRUE(exists("d.npy"));
}

}  // namespace
}  // namespace halfplane::cli::files_test
