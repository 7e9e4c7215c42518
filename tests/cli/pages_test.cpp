// The commands in the pages print the output that the pages show.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>

#include "halfplane_paths.hpp"
#include "program.hpp"

namespace halfplane::cli::pages_test {
namespace {

/// A command of a page, "halfplane ...", and the lines below it; a line "..." stands for any number of lines.
struct Transcript {
  std::string page, command;
  std::vector<std::string> lines;
};

/// Transcripts in blocks between fences: the text from a line "$ build/halfplane ..." to the next one. Blocks of a list's
/// items are indented.
std::vector<Transcript> transcripts(const std::filesystem::path& page) {
  std::vector<Transcript> list;
  const std::string prompt = "$ build/halfplane ";
  bool is_in_block = false, is_open = false;
  std::size_t indent = 0;
  std::ifstream file(page);
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
    if (line.compare(first, 3, "```") == 0) {
      is_in_block = !is_in_block;
      is_open = false;
      indent = first;
      continue;
    }
    if (is_in_block) line.erase(0, std::min(indent, first));
    if (is_in_block && line.starts_with(prompt)) {
      list.push_back({page.filename().string(), line.substr(prompt.size()), {}});
      is_open = true;
    } else if (is_open) {
      list.back().lines.push_back(line);
    }
  }
  return list;
}

/// The first line of the page that is not in its place; "" if all are.
std::string first_difference(const std::vector<std::string>& page, const std::vector<std::string>& printed) {
  auto at = printed.begin();
  bool may_skip = false;
  for (const std::string& line : page) {
    if (line == "...") {
      may_skip = true;
      continue;
    }
    if (may_skip) at = std::find(at, printed.end(), line);
    if (at == printed.end() || *at != line) return line;
    ++at;
    may_skip = false;
  }
  return may_skip || at == printed.end() ? "" : "the end of the block, where '" + *at + "' follows";
}

class Pages : public Cli {
 protected:
  /// The commands of all pages that run the RTL, or the others.
  void print_what_stands_below_them(bool runs_rtl) {
    std::vector<Transcript> all;
    const std::filesystem::path root = HALFPLANE_SOURCE_DIR;
    for (const auto& folder : {root, root / "docs", root / "docs/course"})
      for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".md")
          for (const Transcript& transcript : transcripts(entry.path()))
            if (transcript.command.starts_with("cosim ") == runs_rtl) all.push_back(transcript);
    EXPECT_GE(all.size(), runs_rtl ? 3U : 8U);
    std::filesystem::create_directory_symlink(root / "docs", folder_ / "docs");  // scenes of the pages
    std::map<std::string, Outcome> outcomes;
    for (const Transcript& transcript : all) {
      const auto [known, is_new] = outcomes.try_emplace(transcript.command);
      Outcome& outcome = known->second;
      if (is_new) outcome = paste("'" HALFPLANE_PROGRAM "' " + transcript.command);
      EXPECT_EQ(first_difference(transcript.lines, lines_of(outcome.out)), "")
          << transcript.page << ": halfplane " << transcript.command << "\n"
          << outcome.out << outcome.err;
    }
  }
};

class RtlPages : public Pages {
 protected:
  void SetUp() override { skip_without_rtl(); }
};

TEST_F(Pages, CommandsPrintWhatStandsBelowThem) { print_what_stands_below_them(false); }
TEST_F(RtlPages, CommandsPrintWhatStandsBelowThem) { print_what_stands_below_them(true); }

std::string text_of(const std::filesystem::path& page) {
  std::ifstream file(page);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Numbers in bold: the figures of an answer.
std::vector<std::string> bold_figures(const std::string& text) {
  static const std::regex kFigure(R"(\*\*(-?[0-9][0-9.,]*)\*\*)");
  std::vector<std::string> figures;
  for (std::sregex_iterator at(text.begin(), text.end(), kFigure), end; at != end; ++at) figures.push_back((*at)[1]);
  return figures;
}

bool is_word_of(const std::string& figure, const std::vector<Transcript>& list) {
  const auto is_part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.'; };
  for (const Transcript& transcript : list)
    for (const std::string& line : transcript.lines)
      for (std::size_t at = line.find(figure); at != std::string::npos; at = line.find(figure, at + 1)) {
        const std::size_t end = at + figure.size();
        if ((at == 0 || !is_part(line[at - 1])) && (end == line.size() || !is_part(line[end]))) return true;
      }
  return false;
}

TEST_F(Pages, TheAnswersOfTheCourseArePrintedByItsCommands) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(HALFPLANE_SOURCE_DIR "/docs/course"))
    for (const std::string& figure : bold_figures(text_of(entry.path()))) {
      ++count;
      EXPECT_TRUE(is_word_of(figure, transcripts(entry.path()))) << entry.path().filename() << ": " << figure;
    }
  EXPECT_GE(count, 24U);  // three an average lesson
  EXPECT_FALSE(is_word_of("36", {{"", "", {"136 missing, 36.5 extra"}}}));
}

TEST_F(Pages, ALineThatIsNotPrintedIsFound) {
  EXPECT_EQ(first_difference({"a", "...", "c"}, {"a", "b", "b", "c"}), "");
  EXPECT_EQ(first_difference({"a", "..."}, {"a", "b"}), "");
  EXPECT_EQ(first_difference({"a", "c"}, {"a", "b", "c"}), "c");
  EXPECT_EQ(first_difference({"...", "d"}, {"a", "b"}), "d");
  EXPECT_NE(first_difference({"a"}, {"a", "b"}), "");
}

}  // namespace
}  // namespace halfplane::cli::pages_test
