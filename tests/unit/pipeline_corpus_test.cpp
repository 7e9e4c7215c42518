// Replays the corpus of tests/fuzz/fuzz_pipeline.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "../pipeline_case.hpp"
#include "halfplane_paths.hpp"
#include "sim/scene/random.hpp"

namespace halfplane::pipeline_corpus_test {
namespace {

TEST(PipelineCorpus, EveryInputHolds) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(HALFPLANE_SOURCE_DIR "/tests/fuzz/corpus/pipeline"))
    files.push_back(entry.path());
  std::ranges::sort(files);
  ASSERT_GE(files.size(), 20u);
  for (const auto& path : files) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> text{std::istreambuf_iterator<char>(file), {}};
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    const test::PipelineCase input = test::pipeline_case(bytes);
    EXPECT_EQ(test::pipeline_fault(input), "") << path.filename() << ", " << label(input.config) << '\n'
                                               << input.capture;
  }
}

TEST(PipelineCorpus, RandomBytesHold) {
  constexpr std::uint64_t kSeed = 8;
  Random random(kSeed);
  for (int n = 0; n < 1500; ++n) {
    std::vector<std::uint8_t> bytes(20 + random.next() % 400);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
    const test::PipelineCase input = test::pipeline_case(bytes);
    ASSERT_EQ(test::pipeline_fault(input), "")
        << "seed " << kSeed << ", input " << n << ", " << label(input.config) << '\n'
        << input.capture;
  }
}

/// The checks can fail: a scene against itself with one pixel changed.
TEST(PipelineCorpus, ADifferenceIsSeen) {
  const test::PipelineCase input = test::pipeline_case(std::vector<std::uint8_t>(40, 3));
  const Scene scene = read_capture(input.capture, "bytes.hpt");
  const test::Outcome a = test::outcome_of([&] { return render_scalar(scene, input.config); });
  ASSERT_TRUE(a.rendering);
  test::Outcome b = a;
  EXPECT_EQ(test::difference(a, b, true), "");
  b.rendering->frame.depth[0] ^= 1;
  EXPECT_EQ(test::difference(a, b, true), "the depths differ");
  b.rendering.reset();
  b.refusal = "no";
  EXPECT_NE(test::difference(a, b, true), "");
}

}  // namespace
}  // namespace halfplane::pipeline_corpus_test
