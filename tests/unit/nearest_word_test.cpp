#include "model/nearest_word.hpp"

#include <gtest/gtest.h>

#include <array>

namespace halfplane::nearest_word_test {
namespace {

constexpr std::array<std::string_view, 4> kWords{"tiny", "small", "embedded", "full"};

TEST(NearestWord, FewEditsAreForgivenAndMoreAreAnotherWord) {
  EXPECT_EQ(nearest_word("tinny", kWords), "tiny");
  EXPECT_EQ(nearest_word("ful", kWords), "full");
  EXPECT_EQ(nearest_word("embeded", kWords), "embedded");
  EXPECT_EQ(nearest_word("emdebbed", kWords), "") << "three edits in eight letters";
  EXPECT_EQ(nearest_word("large", kWords), "");
  EXPECT_EQ(nearest_word("fu", kWords), "");
}

TEST(NearestWord, NothingIsNearToNothingOrToNoise) {
  EXPECT_EQ(nearest_word("", kWords), "");
  EXPECT_EQ(nearest_word("f", kWords), "");
  EXPECT_EQ(nearest_word(std::string(100000, 'x'), kWords), "");
  EXPECT_EQ(nearest_word("tiny", {}), "");
}

TEST(NearestWord, TheHintIsAQuestion) {
  EXPECT_EQ(did_you_mean("smal", kWords), " did you mean small?");
  EXPECT_EQ(did_you_mean("gigantic", kWords), "");
}

}  // namespace
}  // namespace halfplane::nearest_word_test
