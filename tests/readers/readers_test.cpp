// Every reader accepts or refuses the fuzzers' corpus and damaged copies of it, under sanitizers. The required
// properties are in the fuzzers (tests/fuzz); a broken property or a finding of a sanitizer ends the program.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "../tier.hpp"
#include "halfplane_paths.hpp"
#include "sim/scene/random.hpp"

extern "C" int fuzz_capture(const std::uint8_t* data, std::size_t size);
extern "C" int fuzz_obj(const std::uint8_t* data, std::size_t size);
extern "C" int fuzz_gltf(const std::uint8_t* data, std::size_t size);
extern "C" int fuzz_toml(const std::uint8_t* data, std::size_t size);

namespace halfplane {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// One to four times: a byte changed, a part removed, a part doubled, or the end truncated.
Bytes damaged(Bytes bytes, Random& random) {
  for (std::uint64_t left = 1 + random.next() % 4; left > 0 && !bytes.empty(); --left) {
    const auto at = static_cast<std::ptrdiff_t>(random.next() % bytes.size());
    const auto end = std::min(at + 1 + static_cast<std::ptrdiff_t>(random.next() % 16), std::ssize(bytes));
    switch (random.next() % 4) {
      case 0: bytes[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(random.next()); break;
      case 1: bytes.erase(bytes.begin() + at, bytes.begin() + end); break;
      case 2: {
        const Bytes part(bytes.begin() + at, bytes.begin() + end);
        bytes.insert(bytes.begin() + at, part.begin(), part.end());
        break;
      }
      default: bytes.resize(static_cast<std::size_t>(at));
    }
  }
  return bytes;
}

/// The corpus in tests/fuzz/corpus/`reader`, and damaged copies of each file.
void read_all(const char* reader, int (*read)(const std::uint8_t* data, std::size_t size)) {
  constexpr std::uint64_t kSeed = 1;
  std::printf("seed %llu\n", static_cast<unsigned long long>(kSeed));
  Random random(kSeed);
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(HALFPLANE_SOURCE_DIR "/tests/fuzz/corpus/" + std::string(reader)))
    files.push_back(entry.path());
  std::ranges::sort(files);
  ASSERT_FALSE(files.empty());
  for (const auto& path : files) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const Bytes whole(text.begin(), text.end());
    EXPECT_EQ(read(whole.data(), whole.size()), 0) << path;
    for (int n = 0; n < test::cases(100, 5000); ++n) {
      const Bytes bytes = damaged(whole, random);
      EXPECT_EQ(read(bytes.data(), bytes.size()), 0) << path << ", copy " << n;
    }
  }
}

TEST(Readers, CapturesAreReadOrRefusedUnderSanitizers) { read_all("capture", fuzz_capture); }
TEST(Readers, ObjFilesAreReadOrRefusedUnderSanitizers) { read_all("obj", fuzz_obj); }
TEST(Readers, GltfFilesAreReadOrRefusedUnderSanitizers) { read_all("gltf", fuzz_gltf); }
TEST(Readers, TomlFilesAreReadOrRefusedUnderSanitizers) { read_all("toml", fuzz_toml); }

}  // namespace
}  // namespace halfplane
