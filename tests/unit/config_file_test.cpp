// Configuration files: every setting arrives, every mistake is one line with file, line and remedy.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "sim/config_file.hpp"

namespace halfplane::config_file_test {
namespace {

std::string error_of(std::string_view text) {
  try {
    (void)read_config_toml(text, "c.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ConfigFile, EmptyFileIsTheDefault) {
  EXPECT_EQ(read_config_toml("", "c.toml"), Config());
  EXPECT_EQ(read_config_toml("# nothing but a comment: \xc3\xa9.........................\n[depth]\n", "c.toml"),
            Config());
}

TEST(ConfigFile, EverySettingCanBeWritten) {
  Config expected = preset("full");
  std::string text;
  for (const Setting& setting : settings()) {
    const bool number = setting.is_number();
    const std::string value = get(expected, setting);
    text += std::string(setting.key) + " = " + (number ? value : '"' + value + '"') + "\n";
  }
  expected.preset = "embedded";
  EXPECT_EQ(read_config_toml(text, "c.toml"), expected);
}

TEST(ConfigFile, TablesDottedKeysAndInlineTablesMeanTheSame) {
  const Config dotted = read_config_toml("depth.bits = 20", "c.toml");
  EXPECT_EQ(dotted.depth_bits, 20);
  EXPECT_EQ(read_config_toml("[depth]\nbits = 20\n", "c.toml"), dotted);
  EXPECT_EQ(read_config_toml("depth = { bits = 20 }\r\n", "c.toml"), dotted);
  EXPECT_EQ(read_config_toml("\xef\xbb\xbf'depth'.\"bits\" = 0x14", "c.toml"), dotted);
}

TEST(ConfigFile, PresetIsTakenFirstWhereverItStands) {
  Config expected = preset("full");
  expected.depth_bits = 20;
  EXPECT_EQ(read_config_toml("depth.bits = 20\npreset = \"full\"\n", "c.toml"), expected);
}

TEST(ConfigFile, UnknownKeyNamesTheLineAndTheNearestKey) {
  const std::string message = error_of("# comment\n\n[depth]\nbitz = 20\n");
  EXPECT_EQ(message.rfind("c.toml:4: no setting 'depth.bitz'; did you mean depth.bits?", 0), 0u) << message;
  EXPECT_NE(error_of("presett = \"full\"").find("did you mean preset?"), std::string::npos);
  EXPECT_EQ(error_of("zzzzzzzzzzzzzzzzzzzz = 1").find("did you mean"), std::string::npos);
}

TEST(ConfigFile, UnknownEmptyTableIsAnUnknownKey) {
  EXPECT_EQ(error_of("[depht]\n").rfind("c.toml:1: no setting 'depht'", 0), 0u) << error_of("[depht]\n");
  EXPECT_EQ(error_of("[depth.bits.more]\n").rfind("c.toml:1: no setting 'depth.bits.more'", 0), 0u);
}

TEST(ConfigFile, WrongTypesSayWhatToGive) {
  EXPECT_EQ(error_of("\ndepth.bits = \"20\""), "c.toml:2: depth.bits: give a whole number 8...32, without quotes");
  EXPECT_EQ(error_of("depth.bits = 20.0"), "c.toml:1: depth.bits: give a whole number 8...32, without quotes");
  EXPECT_EQ(error_of("color.format = 565"), "c.toml:1: color.format: give one of rgb565|rgba8888 in quotes");
  EXPECT_EQ(error_of("preset = 1"), "c.toml:1: preset: give a name in quotes, as in preset = \"embedded\"");
}

TEST(ConfigFile, ValueOutsideItsRangeNamesTheRange) {
  const std::string message = error_of("subpixel.bits = 4\ndepth.bits = 33");
  EXPECT_EQ(message.rfind("c.toml:2: depth.bits", 0), 0u) << message;
  EXPECT_NE(message.find("8...32"), std::string::npos) << message;
  EXPECT_NE(error_of("depth.bits = 9000000000000000000").find("8...32"), std::string::npos);
  EXPECT_EQ(error_of("depth.bits = 99999999999999999999").rfind("c.toml:1: not TOML", 0), 0u);
}

TEST(ConfigFile, UnknownNamesAreRefusedWithTheirLine) {
  EXPECT_EQ(error_of("preset = \"huge\"").rfind("c.toml:1: no preset 'huge'", 0), 0u);
  EXPECT_EQ(error_of("\n[color]\nformat = \"rgb666\"").rfind("c.toml:3: color.format", 0), 0u);
}

TEST(ConfigFile, RefusedCombinationNamesTheFile) {
  const std::string message = error_of("target.width = 1000\nguard.band = 512\n");
  EXPECT_EQ(message.rfind("c.toml: configuration refused", 0), 0u) << message;
}

TEST(ConfigFile, SyntaxErrorNamesTheLine) {
  EXPECT_EQ(error_of("depth.bits = 20\n[color\nformat = 1").rfind("c.toml:2: not TOML", 0), 0u);
  EXPECT_EQ(error_of("depth.bits = 20\ndepth.bits = 21").rfind("c.toml:2: not TOML", 0), 0u);
}

// Found by the fuzzer: toml++ 3.3 with its assertions on ends the process at most of these.
TEST(ConfigFile, TextThatTheParserCannotTakeIsRefusedBeforeIt) {
  std::string dots = "a";
  for (int i = 0; i < 30'000; ++i) dots += ".a";
  EXPECT_NE(error_of("x = 1\n" + dots + " = 1").find("c.toml:2: too many dots"), std::string::npos);
  EXPECT_NE(error_of("a = " + std::string(60'000, '[')).find("array"), std::string::npos);
  EXPECT_NE(error_of("a = " + std::string(60'000, '{')).find("too many braces"), std::string::npos);
  EXPECT_NE(error_of(std::string("[a\0]", 4)).find("control character"), std::string::npos);
  EXPECT_NE(error_of("[(a]").find("a table needs a name"), std::string::npos);
  EXPECT_NE(error_of("[[[a]").find("a table needs a name"), std::string::npos);
  EXPECT_NE(error_of("[de \xef\xbb\xbd 0").find("beyond ASCII"), std::string::npos);
  EXPECT_NE(error_of("a = 09\"q\xc3\xa4").find("beyond ASCII"), std::string::npos);
  EXPECT_NE(error_of("a = [}]").find("array"), std::string::npos);
  EXPECT_NE(error_of("a = 1979-05-27Tb3:00").find("date"), std::string::npos);
}

TEST(ConfigFile, DotsAndBracketsInStringsAndCommentsDoNotCount) {
  const std::string dots(100, '.');
  EXPECT_NE(error_of("a = \"" + dots + "[[{{\\\"" + dots + "\"").find("no setting 'a'"), std::string::npos);
  EXPECT_NE(error_of("a = '''" + dots + "\n[\n''[" + dots + "'''").find("no setting 'a'"), std::string::npos);
  EXPECT_EQ(error_of("# " + dots + "[[{{\ndepth.bits = 20 # " + dots), "no error");
}

TEST(ConfigFile, MessageStaysOneShortLineWhateverTheKey) {
  const std::string message = error_of("\"" + std::string(5000, 'k') + "\\n\\u001b[31m\" = 1");
  EXPECT_LT(message.size(), 200u);
  EXPECT_EQ(error_of("\"a\\nb\\u001b\" = 1").find_first_of("\n\x1b"), std::string::npos);
}

TEST(ConfigFile, HugeFileIsRefusedUnread) {
  EXPECT_NE(error_of(std::string(70'000, '#')).find("at most 65536 bytes"), std::string::npos);
}

TEST(ConfigOption, TakesPresetsAndFiles) {
  EXPECT_EQ(config_from_option("tiny"), preset("tiny"));
  const auto path = std::filesystem::path(testing::TempDir()) / ("halfplane-" + std::to_string(getpid()) + ".toml");
  std::ofstream(path) << "preset = \"tiny\"\ndepth.bits = 9\n";
  Config expected = preset("tiny");
  expected.depth_bits = 9;
  EXPECT_EQ(config_from_option(path.string()), expected);
  std::filesystem::remove(path);
}

TEST(ConfigOption, WhatIsNeitherIsRefusedWithTheChoices) {
  const auto message = [](const std::string& option) {
    try {
      (void)config_from_option(option);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(message("huge").find("give tiny, small, embedded, full or a .toml file"), std::string::npos);
  EXPECT_NE(message("missing.toml").find("'missing.toml': No such file"), std::string::npos);
  EXPECT_NE(message(testing::TempDir()).find("directory"), std::string::npos);
}

}  // namespace
}  // namespace halfplane::config_file_test
