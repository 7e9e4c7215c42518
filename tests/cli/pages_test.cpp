// The commands in the pages print the output that the pages show.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include "halfplane_paths.hpp"
#include "program.hpp"

namespace halfplane::cli::pages_test {
namespace {

class Pages : public Cli {};

/// A command of a page, "halfplane ...", and the lines below it; a line "..." stands for any number of lines.
struct Transcript {
  std::string page, command;
  std::vector<std::string> lines;
};

/// Transcripts in blocks between fences: the text from a line "$ build/halfplane ..." to the next one.
std::vector<Transcript> transcripts(const std::filesystem::path& page) {
  std::vector<Transcript> list;
  const std::string prompt = "$ build/halfplane ";
  bool is_in_block = false, is_open = false;
  std::ifstream file(page);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("```")) {
      is_in_block = !is_in_block;
      is_open = false;
    } else if (is_in_block && line.starts_with(prompt)) {
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

TEST_F(Pages, CommandsPrintWhatStandsBelowThem) {
  std::vector<Transcript> all;
  const std::filesystem::path root = HALFPLANE_SOURCE_DIR;
  for (const auto& folder : {root, root / "docs"})
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".md")
        for (const Transcript& transcript : transcripts(entry.path())) all.push_back(transcript);
  EXPECT_GE(all.size(), 8U);
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

TEST_F(Pages, ALineThatIsNotPrintedIsFound) {
  EXPECT_EQ(first_difference({"a", "...", "c"}, {"a", "b", "b", "c"}), "");
  EXPECT_EQ(first_difference({"a", "..."}, {"a", "b"}), "");
  EXPECT_EQ(first_difference({"a", "c"}, {"a", "b", "c"}), "c");
  EXPECT_EQ(first_difference({"...", "d"}, {"a", "b"}), "d");
  EXPECT_NE(first_difference({"a"}, {"a", "b"}), "");
}

}  // namespace
}  // namespace halfplane::cli::pages_test
