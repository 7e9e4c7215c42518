// The program's help texts, and that their worked examples work.
#include <algorithm>

#include "program.hpp"

namespace halfplane::cli::help_test {
namespace {

class Help : public Cli {};

/// The commands under "Example:", each as typed.
std::vector<std::string> examples(const std::string& help) {
  std::vector<std::string> found;
  bool is_example = false;
  for (const std::string& line : lines_of(help)) {
    is_example |= line.rfind("Example", 0) == 0;
    if (is_example && line.rfind("  halfplane ", 0) == 0) found.push_back(line.substr(2));
  }
  return found;
}

TEST_F(Help, EveryCommandHasAWorkedExampleThatWorks) {
  for (const Arguments& command : {Arguments{},
                                   {"render"},
                                   {"compare"},
                                   {"depth"},
                                   {"scenes"},
                                   {"stress"},
                                   {"widths"},
                                   {"config"},
                                   {"explain"},
                                   {"vectors"},
                                   {"check"},
                                   {"cover"},
                                   {"completions"},
                                   {"man"}}) {
    Arguments arguments = command;
    arguments.push_back("--help");
    const Outcome help = run(arguments);
    EXPECT_EQ(help.status, 0);
    EXPECT_EQ(help.err, "");
    const auto lines = examples(help.out);
    EXPECT_FALSE(lines.empty()) << help.out;
    for (const std::string& line : lines) {
      Arguments words = split_words(line);
      words.erase(words.begin());
      const Outcome outcome = run(words);
      EXPECT_EQ(outcome.status, 0) << line << "\n" << outcome.err;
      for (std::size_t i = 0; i + 1 < words.size(); ++i) {
        EXPECT_TRUE(words[i] != "-o" || exists(words[i + 1])) << line;
      }
    }
  }
}

TEST_F(Help, ProgramWithoutArgumentsShowsACommandThatWorks) {
  const std::string line = run({}).err;
  const std::size_t start = line.find('`'), end = line.find('`', start + 1);
  ASSERT_NE(end, std::string::npos) << line;
  Arguments words = split_words(line.substr(start + 1, end - start - 1));
  ASSERT_GT(words.size(), 1u);
  EXPECT_EQ(words.front(), "halfplane");
  words.erase(words.begin());
  EXPECT_EQ(run(words).status, 0) << line;
  EXPECT_FALSE(listing().empty()) << "the example draws a picture";
}

TEST_F(Help, ListsTheCommandsAndTheCommonOptions) {
  const std::string program = run({"--help"}).out;
  for (const char* command : {"render", "compare", "cosim", "reduce", "mutants", "regress", "depth", "stress", "scenes",
                              "widths", "config", "explain", "vectors", "check", "cover"})
    EXPECT_NE(program.find(command), std::string::npos) << command;
  for (const char* command : {"render", "compare"}) {
    const std::string help = run({command, "--help"}).out;
    for (const char* option : {"SCENE", "--config", "--set", "--size", "--camera", "--seed", "--threads", "--skip",
                               "--convention", "--json", "--quiet", "-o"})
      EXPECT_NE(help.find(option), std::string::npos) << command << " " << option;
  }
}

TEST_F(Help, EveryRowOfTheSettingsHasTheSameColumns) {
  const Arguments list{"config", "--list", "--set", "depth.format=uf8.24"};
  const auto lines = lines_of(run(list).out);
  const Json json = result(list);
  std::size_t begin = 0, end = 0;
  for (const char* table : {"settings", "timing_settings"})
    for (const Json& setting : json[table]) {
      const std::string key = setting["key"], meaning = setting["meaning"];
      const std::string value =
          setting["value"].is_string() ? setting["value"].get<std::string>() : setting["value"].dump();
      const auto line = std::find_if(lines.begin(), lines.end(),
                                     [&](const std::string& text) { return text.starts_with(key + " "); });
      ASSERT_NE(line, lines.end()) << key;
      ASSERT_TRUE(line->ends_with("  " + meaning)) << *line;
      const std::size_t value_end = line->find(" " + value + " ") + 1 + value.size();
      if (begin == 0) begin = line->size() - meaning.size();
      if (end == 0) end = value_end;
      EXPECT_EQ(line->size() - meaning.size(), begin) << *line;
      EXPECT_EQ(value_end, end) << *line;
    }
  EXPECT_NE(begin, 0u);
}

TEST_F(Help, VersionIsOneLine) {
  const Outcome outcome = run({"--version"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(lines_of(outcome.out).size(), 1u);
  EXPECT_EQ(outcome.out.rfind("halfplane ", 0), 0u);
}

}  // namespace
}  // namespace halfplane::cli::help_test
