// The targets of the pages' and comments' links exist: files, folders, headings, and the stems of rtl_ref/README.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "halfplane_paths.hpp"
#include "model/pipeline_graph.hpp"
#include "tests/committed.hpp"

namespace halfplane::docs_test {
namespace {

namespace fs = std::filesystem;
using Texts = std::vector<std::string>;

const fs::path kRoot{HALFPLANE_SOURCE_DIR};
constexpr std::array<std::string_view, 13> kFolders{"cmake",   "core", "docs", "driver", "examples", "gl", "model",
                                                    "rtl_ref", "sim",  "soc",  "tests",  "tools",    "web"};

std::string read(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

bool has_suffix(std::string_view text, std::string_view suffix) {
  return text.size() >= suffix.size() && text.substr(text.size() - suffix.size()) == suffix;
}

bool is_code(std::string_view name) {
  const std::array<std::string_view, 4> endings{".hpp", ".cpp", ".inl", ".sv"};
  return std::any_of(endings.begin(), endings.end(), [&](auto ending) { return has_suffix(name, ending); });
}

/// Every file and folder of the project by its path from the root; `ends` holds the short forms of paths.
struct Tree {
  std::set<std::string> paths, ends;

  Tree() {
    for (const auto& entry : fs::directory_iterator(kRoot))
      if (entry.is_regular_file()) add(entry.path());
    for (const std::string_view folder : kFolders) {
      add(kRoot / folder);
      for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) add(entry.path());
    }
  }

  void add(const fs::path& path) {
    const std::string text = path.lexically_relative(kRoot).generic_string();
    paths.insert(text);
    ends.insert(text);
    for (std::size_t slash = text.find('/'); slash != std::string::npos; slash = text.find('/', slash + 1))
      ends.insert(text.substr(slash + 1));
  }
};

const Tree& tree() {
  static const Tree tree;
  return tree;
}

/// `NAME.sv` stands for any name, `_serial.sv` for the end of one; files in build/ are generated.
bool is_placeholder(const std::string& word) {
  if (word[0] == '.' || word[0] == '_' || word.rfind("build/", 0) == 0) return true;
  const std::string stem = fs::path(word).stem().string();
  return std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isupper(c) != 0; });
}

/// The words of `text` that name a file or a folder from the root, or a source file by the end of its path, and are none.
Texts untrue_paths(std::string_view text) {
  Texts result;
  const auto is_part = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.' || c == '/';
  };
  for (auto at = text.begin(); at != text.end();) {
    const auto begin = std::find_if(at, text.end(), is_part);
    at = std::find_if_not(begin, text.end(), is_part);
    std::string word(begin, at);
    const bool is_pattern = at != text.end() && (*at == '*' || *at == '<' || *at == '{' || *at == '$');
    while (!word.empty() && (word.back() == '.' || word.back() == '/')) word.pop_back();
    while (word.rfind("../", 0) == 0) word.erase(0, 3);
    if (word.rfind("halfplane/", 0) == 0) word.erase(0, 10);  // path as installed
    const std::string top = word.substr(0, word.find('/'));
    const bool is_rooted = top != word && std::find(kFolders.begin(), kFolders.end(), top) != kFolders.end();
    if (is_pattern || (!is_rooted && !is_code(word))) continue;
    if (tree().ends.count(word) == 0 && !is_placeholder(word)) result.push_back(word);
  }
  return result;
}

/// A heading's anchor, as GitHub makes it.
std::string anchor_of(std::string_view heading) {
  std::string anchor;
  for (const char c : heading) {
    const auto u = static_cast<unsigned char>(c);
    if (c == ' ' || c == '-') anchor += '-';
    if (std::isalnum(u) != 0 || c == '_' || u >= 0x80) anchor += static_cast<char>(std::tolower(u));
  }
  return anchor;
}

bool has_anchor(const std::string& page, const std::string& anchor) {
  for (std::size_t at = 0; at < page.size();) {
    const std::size_t end = std::min(page.find('\n', at), page.size());
    const std::string_view line(page.data() + at, end - at);
    const std::size_t text = line.find_first_not_of('#');
    if (text != 0 && text != std::string_view::npos && anchor_of(line.substr(text + 1)) == anchor) return true;
    at = end + 1;
  }
  return false;
}

/// The links of a page at `folder` whose file or heading is not there. An empty `text` before '#' means the page itself;
/// behind the # of an .html is a state.
Texts untrue_links(const std::string& page, const fs::path& folder) {
  Texts result;
  for (std::size_t at = page.find("]("); at != std::string::npos; at = page.find("](", at + 2)) {
    const std::string link = page.substr(at + 2, page.find_first_of(") \n", at + 2) - at - 2);
    if (link.find("://") != std::string::npos) continue;
    const std::size_t hash = std::min(link.find('#'), link.size());
    const fs::path target = folder / link.substr(0, hash);
    const bool is_there = hash == 0 || fs::exists(target);
    const std::string other = hash < link.size() && hash != 0 ? read(target) : page;
    const bool has_heading =
        target.extension() == ".html" || hash == link.size() || has_anchor(other, link.substr(hash + 1));
    if (!is_there || !has_heading) result.push_back(link);
  }
  return result;
}

std::vector<fs::path> files(std::string_view folder, const std::vector<std::string>& endings) {
  std::vector<fs::path> result;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder))
    if (std::find(endings.begin(), endings.end(), entry.path().extension()) != endings.end()) result.push_back(entry);
  return result;
}

std::vector<fs::path> pages() {
  std::vector<fs::path> result = files("docs", {".md"});
  for (const char* page : {"README.md", "CONTRIBUTING.md", "CHANGELOG.md", "rtl_ref/README.md"})
    result.push_back(kRoot / page);
  return result;
}

/// The text after "//" in each line.
std::string comments_of(const std::string& source) {
  std::string result;
  for (std::size_t at = source.find("//"); at != std::string::npos; at = source.find("//", at)) {
    const std::size_t end = std::min(source.find('\n', at), source.size());
    result.append(source, at, end - at).push_back('\n');
    at = end;
  }
  return result;
}

void expect_none(const Texts& untrue, const fs::path& where) {
  for (const std::string& word : untrue)
    ADD_FAILURE() << where.lexically_relative(kRoot).generic_string() << " points at " << word
                  << ", which is not there";
}

TEST(Docs, EveryLinkLeadsToAFileAndAHeading) {
  for (const fs::path& page : pages()) expect_none(untrue_links(read(page), page.parent_path()), page);
}

// Decisions and changes of old speak of the files of their day.
TEST(Docs, EveryPathInAPageIsThere) {
  for (const fs::path& page : pages()) {
    if (page.parent_path().filename() == "adr" || page.filename() == "CHANGELOG.md") continue;
    expect_none(untrue_paths(read(page)), page);
  }
}

TEST(Docs, EveryPathInACommentIsThere) {
  for (const std::string_view folder : {"gl", "model", "rtl_ref", "sim", "tests", "tools"})
    for (const fs::path& source : files(folder, {".hpp", ".cpp", ".inl", ".sv"}))
      expect_none(untrue_paths(comments_of(read(source))), source);
}

TEST(Docs, PathsAndLinksThatAreNotThereAreFound) {
  EXPECT_EQ(untrue_paths("`model/config.hpp`, config.hpp, sim/scene/, tests/formal/NAME.sv, docs/*.md, build/x.cpp"),
            Texts{});
  EXPECT_EQ(untrue_paths("see model/confog.hpp and ../sim/nowhere; cull.svh confog.inl."),
            (Texts{"model/confog.hpp", "sim/nowhere", "confog.inl"}));
  EXPECT_EQ(
      untrue_links("# A `b`: c\n[1](#a-b-c) [2](#a) [3](docs/spec.md#lines) [4](docs/spec.md#none) [5](no.md)", kRoot),
      (Texts{"#a", "docs/spec.md#none", "no.md"}));
}

/// The lines of a page's code between a phrase and the end of the block that follows it.
Texts block_after(const std::string& page, const std::string& phrase) {
  const std::size_t begin = page.find("```cpp\n", page.find(phrase)) + 7, end = page.find("```", begin);
  Texts lines;
  std::istringstream text(page.substr(begin, end - begin));
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

TEST(Docs, TheLoopWithMatricesIsThatOfItsExample) {
  const std::string source = read(kRoot / "examples/turning_cube/turning_cube.cpp");
  const Texts lines = block_after(read(kRoot / "docs/library.md"), "## A loop with matrices");
  EXPECT_GT(lines.size(), 5u);
  for (std::string line : lines) {
    line.erase(0, line.find_first_not_of(' '));
    EXPECT_NE(source.find(line), std::string::npos) << line;
  }
}

TEST(Docs, EveryPresetIsInATableOfTheReadme) {
  const std::string page = read(kRoot / "README.md");
  const auto is_in_a_row = [&page](const std::string& name) {
    std::istringstream text(page);
    for (std::string line; std::getline(text, line);)
      if (line.starts_with("| `") && line.substr(0, line.find('|', 1)).find("`" + name + "`") != std::string::npos)
        return true;
    return false;
  };
  const auto presets = nlohmann::json::parse(read(kRoot / "CMakePresets.json")).at("configurePresets");
  for (const auto& preset : presets)
    EXPECT_TRUE(preset.value("hidden", false) || is_in_a_row(preset.at("name"))) << preset.at("name");
  std::istringstream designs(read(kRoot / "model/designs.toml"));
  int count = 0;
  for (std::string line; std::getline(designs, line);)
    if (const std::size_t equals = line.find(" = \""); equals != std::string::npos && line[0] != '#') {
      EXPECT_TRUE(is_in_a_row(line.substr(0, equals))) << line;
      ++count;
    }
  EXPECT_GT(count, 5);
  EXPECT_FALSE(is_in_a_row("large"));
}

/// Stems of the files in a folder.
std::set<std::string> stems(std::string_view folder, const std::vector<std::string>& endings) {
  std::set<std::string> result;
  for (const fs::path& file : files(folder, endings)) result.insert(file.stem().string());
  return result;
}

TEST(Docs, ModulesOfTheRtlAreStagesOfTheGraphAndStemsOfTheModelBesidesTheExceptionsNamed) {
  const std::set<std::string> model = stems("model/stages", {".hpp", ".cpp"}), rtl = stems("rtl_ref/stages", {".sv"});
  const std::string page = read(kRoot / "rtl_ref/README.md");
  const std::size_t begin = page.find("## Stems");
  ASSERT_NE(begin, std::string::npos);
  const std::string table = page.substr(begin, page.find("\n## ", begin) - begin);
  const auto is_named = [&table](const std::string& stem) { return table.find('`' + stem + '`') != std::string::npos; };
  const auto is_of_unit = [&model](const std::string& stem) {
    return model.count(stem.substr(0, stem.find('_')) + "_unit") == 1;
  };
  for (std::string stem : rtl) {
    if (has_suffix(stem, "_serial")) stem.resize(stem.size() - 7);
    EXPECT_TRUE(std::ranges::count(kStageInfo, stem, &StageInfo::name) == 1 || is_of_unit(stem) || is_named(stem))
        << "rtl_ref/stages/" << stem << ".sv is no stage of the graph, and rtl_ref/README.md does not say what it is";
  }
  for (const std::string& stem : model)
    EXPECT_TRUE(rtl.count(stem) == 1 || model.count(stem + "_unit") == 1 || is_named(stem))
        << "model/stages/" << stem << " has no RTL, and rtl_ref/README.md does not say so";
}

/// The modules of the core for FuseSoC: those of lib, then those of stages, then the top.
TEST(Docs, TheCommittedCoreListsTheModulesOfTheRtl) {
  test::expect_committed("halfplane.core", [](const std::string& text) {
    const std::size_t begin = text.find("      - rtl_ref/lib/"), end = text.find("      - rtl_ref/raster_top.sv");
    std::string list;
    for (const std::string folder : {"rtl_ref/lib/", "rtl_ref/stages/"})
      for (const std::string& stem : stems(folder, {".sv"})) list += "      - " + folder + stem + ".sv\n";
    return text.substr(0, begin) + list + text.substr(end);
  });
}

}  // namespace
}  // namespace halfplane::docs_test
