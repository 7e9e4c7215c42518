// The options that the shells' completions and man pages list: all options of --help, and for bash by trying it.
#include <algorithm>
#include <cstdio>
#include <set>
#include <sstream>

#include "model/config.hpp"
#include "program.hpp"
#include "sim/scene/builtin.hpp"

namespace halfplane::cli::completions_test {
namespace {

using Words = std::vector<std::string>;

class CommandLine : public Cli {
 protected:
  /// The commands that --help lists.
  [[nodiscard]] Words commands() const {
    Words names;
    bool is_list = false;
    for (const std::string& line : lines_of(run({"--help"}).out)) {
      if (is_list && line.starts_with("  ") && line[2] != ' ') names.push_back(line.substr(2, line.find(' ', 2) - 2));
      is_list = line == "Subcommands:" || (is_list && !line.empty());
    }
    EXPECT_GT(names.size(), 10u);
    return names;
  }

  /// The options that a command's --help lists, as "-o" and "--depth".
  [[nodiscard]] std::set<std::string> options(const std::string& command) const {
    std::set<std::string> names;
    for (const std::string& line : lines_of(run({command, "--help"}).out)) {
      if (!line.starts_with("  -")) continue;
      std::istringstream list(line.substr(2, line.find(' ', 2) - 2));
      for (std::string name; std::getline(list, name, ',');) names.insert(name.substr(0, name.find_first_of("{=[")));
    }
    EXPECT_EQ(names.count("--help"), 1u) << command;
    return names;
  }

  /// The output of a shell command, run in the folder.
  [[nodiscard]] std::string shell(const std::string& command, int expected_status = 0) const {
    std::FILE* pipe = popen(("cd '" + folder_.string() + "' && { " + command + "; } 2>&1").c_str(), "r");
    if (pipe == nullptr) return "";
    std::string text;
    char buffer[4096];
    while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, n);
    EXPECT_EQ(WEXITSTATUS(pclose(pipe)), expected_status) << command << "\n" << text;
    return text;
  }

  /// Bash's completions of the last of `words`, which are split as bash splits them.
  [[nodiscard]] Words bash_offers(const Words& words) const {
    write("completions.bash", run({"completions", "bash"}).out);
    std::string script = "set -u\nsource ./completions.bash\nCOMP_WORDS=(";
    for (const std::string& word : words) script += "'" + word + "' ";
    script +=
        ")\nCOMP_CWORD=" + std::to_string(words.size() - 1) + "\n_halfplane\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
    write("try.bash", script);
    Words offers = lines_of(shell("bash try.bash"));
    std::erase(offers, "");
    return offers;
  }
};

bool has(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

TEST_F(CommandLine, BashOffersTheCommands) {
  const Words all = bash_offers({"halfplane", ""});
  for (const std::string& command : commands()) EXPECT_TRUE(has(all, command)) << command;
  EXPECT_EQ(bash_offers({"halfplane", "rend"}), Words{"render"});
  EXPECT_EQ(bash_offers({"halfplane", "man", "rend"}), Words{"render"});
  EXPECT_EQ(bash_offers({"halfplane", "--ver"}), Words{"--version"});
}

TEST_F(CommandLine, BashOffersEveryOptionOfEveryCommand) {
  for (const std::string& command : commands()) {
    const Words offers = bash_offers({"halfplane", command, "-"});
    for (const std::string& option : options(command)) EXPECT_TRUE(has(offers, option)) << command << " " << option;
  }
}

TEST_F(CommandLine, BashOffersPresetsScenesSettingsAndFiles) {
  write("box.obj", "");
  write("mine.toml", "");
  write("notes.txt", "");
  std::filesystem::create_directory(folder_ / "boxes");
  const Words configs = bash_offers({"halfplane", "render", "teapot", "--config", ""});
  for (const auto preset : preset_names()) EXPECT_TRUE(has(configs, std::string(preset)));
  EXPECT_TRUE(has(configs, "mine.toml"));
  EXPECT_FALSE(has(configs, "box.obj"));
  const Words scenes = bash_offers({"halfplane", "compare", ""});
  for (const Builtin& scene : all_builtin_scenes()) EXPECT_TRUE(has(scenes, std::string(scene.name))) << scene.name;
  EXPECT_TRUE(has(scenes, "box.obj"));
  EXPECT_FALSE(has(scenes, "notes.txt"));
  EXPECT_EQ(bash_offers({"halfplane", "render", "box"}), (Words{"boxes", "box.obj"}));
  const Words keys = bash_offers({"halfplane", "render", "--set", ""});
  for (const Setting& setting : settings()) EXPECT_TRUE(has(keys, std::string(setting.key) + "=")) << setting.key;
  EXPECT_EQ(bash_offers({"halfplane", "render", "-o", "not"}), Words{"notes.txt"});
}

TEST_F(CommandLine, BashOffersWhatStandsBehindEqualsSignsAndCommas) {
  EXPECT_EQ(bash_offers({"halfplane", "render", "--set", "color.format", "=", "rgb5"}), Words{"rgb565"});
  EXPECT_EQ(bash_offers({"halfplane", "render", "--set", "setup.kind", "="}), (Words{"pipelined", "serial"}));
  EXPECT_EQ(bash_offers({"halfplane", "render", "--set", "depth.bits", "=", "2"}), Words{});
  EXPECT_EQ(bash_offers({"halfplane", "render", "--engine", "=", "cy"}), Words{"cycle"});
  EXPECT_EQ(bash_offers({"halfplane", "render", "--engine", "func"}), Words{"functional"});
  EXPECT_EQ(bash_offers({"halfplane", "compare", "--panels", "model,dep"}), Words{"model,depth"});
  EXPECT_EQ(bash_offers({"halfplane", "compare", "--golden", "binary3"}), Words{"binary32"});
  EXPECT_EQ(bash_offers({"halfplane", "render", "--convention", "gl", ":", "rev"}), Words{"reversed"});
  EXPECT_EQ(bash_offers({"halfplane", "render", "--json", "tea"}), Words{"teapot"}) << "--json takes no next word";
  EXPECT_EQ(bash_offers({"halfplane", "render", "--size", ""}), Words{}) << "a value that nobody can guess";
}

TEST_F(CommandLine, ZshAndFishAreToldOfEveryOptionOfEveryCommand) {
  const std::string zsh = run({"completions", "zsh"}).out, fish = run({"completions", "fish"}).out;
  EXPECT_TRUE(zsh.starts_with("#compdef halfplane\n"));
  for (const std::string& command : commands()) {
    const std::string mark = "        " + command + ")\n";
    const std::size_t begin = zsh.find(mark);
    ASSERT_NE(begin, std::string::npos) << command;
    const std::string part = zsh.substr(begin, zsh.find(";;", begin) - begin);
    EXPECT_NE(fish.find("-a " + command + " -d "), std::string::npos) << command;
    for (const std::string& option : options(command)) {
      const bool is_in_zsh =
          part.find("'" + option + "[") != std::string::npos || part.find("'" + option + "=") != std::string::npos ||
          part.find("'*" + option + "=") != std::string::npos || part.find("'*" + option + "[") != std::string::npos;
      EXPECT_TRUE(is_in_zsh) << command << " " << option;
      const std::string name =
          option.starts_with("--") ? " -l " + option.substr(2) + " " : " -s " + option.substr(1) + " ";
      bool is_in_fish = false;
      for (const std::string& line : lines_of(fish))
        is_in_fish |= line.find("seen_subcommand_from " + command + "'") != std::string::npos &&
                      line.find(name) != std::string::npos;
      EXPECT_TRUE(is_in_fish) << command << " " << option;
    }
  }
  for (const Builtin& scene : all_builtin_scenes()) {
    EXPECT_NE(zsh.find(std::string(scene.name)), std::string::npos);
    EXPECT_NE(fish.find(std::string(scene.name)), std::string::npos);
  }
  for (const Setting& setting : settings()) {
    EXPECT_NE(zsh.find(std::string(setting.key) + "["), std::string::npos);
    EXPECT_NE(fish.find(std::string(setting.key) + "="), std::string::npos);
  }
  write("_halfplane", zsh);
  write("halfplane.fish", fish);
  // Installed shells parse the file.
  (void)shell("if command -v zsh >/dev/null; then zsh -n _halfplane; fi");
  (void)shell("if command -v fish >/dev/null; then fish --no-execute halfplane.fish; fi");
}

/// The first fault of a page, as far as a reader of man's requests can tell; empty for none.
std::string page_fault(const std::string& page) {
  static const std::set<std::string> requests{".TH", ".SH", ".SS", ".TP", ".B", ".br", ".nf", ".fi"};
  bool is_verbatim = false;
  for (const std::string& line : lines_of(page)) {
    const std::string request = line.substr(0, line.find(' '));
    if (line.starts_with("'") || (line.starts_with(".") && requests.count(request) == 0)) return "request: " + line;
    if (line == ".nf" || line == ".fi") {
      if (is_verbatim == (line == ".nf")) return "nested: " + line;
      is_verbatim = line == ".nf";
    }
    bool is_plain = true;
    for (std::size_t i = line.find('\\'); i != std::string::npos; i = line.find('\\', i + 2)) {
      const std::string escape = line.substr(i, line.compare(i, 2, "\\f") == 0 ? 3 : 2);
      const bool is_font = escape == "\\fB" || escape == "\\fI" || escape == "\\fR";
      if (!is_font && escape != "\\-" && escape != "\\e" && escape != "\\&") return "escape: " + line;
      if (is_font && is_plain == (escape == "\\fR")) return "font: " + line;
      if (is_font) is_plain = escape == "\\fR";
    }
    if (!is_plain) return "font at the end: " + line;
  }
  return is_verbatim ? "no .fi" : "";
}

TEST_F(CommandLine, EveryCommandHasAPageWithEveryOption) {
  ASSERT_EQ(run({"man", "-o", "man1"}).status, 0);
  Words all = commands();
  all.emplace_back();  // the program's own options
  for (const std::string& command : all) {
    const std::string name = command.empty() ? "halfplane" : "halfplane-" + command;
    const Bytes bytes = read("man1/" + name + ".1");
    const std::string page(bytes.begin(), bytes.end());
    EXPECT_TRUE(page.starts_with(".TH \"")) << name;
    EXPECT_EQ(page_fault(page), "") << name;
    for (const char* section : {".SH NAME\nhalfplane", ".SH SYNOPSIS", ".SH OPTIONS", ".SH EXIT STATUS",
                                ".SH ENVIRONMENT", ".SH EXAMPLES", ".SH SEE ALSO"})
      EXPECT_NE(page.find(section), std::string::npos) << name << " " << section;
    if (command.empty()) continue;
    EXPECT_EQ(run({"man", command}).out, page);
    for (std::string option : options(command)) {
      for (std::size_t i = option.find('-'); i != std::string::npos; i = option.find('-', i + 2))
        option.insert(i, "\\");
      EXPECT_NE(page.find("\\fB" + option + "\\fR"), std::string::npos) << name << " " << option;
    }
  }
  // An installed groff gives no warning.
  EXPECT_EQ(shell("if command -v groff >/dev/null; then groff -man -Tutf8 -ww -z man1/*.1; fi"), "");
}

TEST_F(CommandLine, FaultsOfPagesAreFound) {
  EXPECT_EQ(page_fault(".TH A 1\n.SH NAME\n\\fBa\\fR \\- b\n"), "");
  for (const char* page : {".XX\n", "a \\q\n", "\\fBa\n", "a\\fR\n", ".nf\n", ".fi\n", "'a\n"})
    EXPECT_NE(page_fault(page), "") << page;
}

TEST_F(CommandLine, UnknownShellsAndPagesAreRefused) {
  expect_refused({"completions", "tcsh"}, "fish");
  expect_refused({"completions"}, "SHELL is required");
  expect_refused({"man", "rendr"}, "rendr");
  expect_refused({"man", "render", "-o", "man1"}, "-o");
}

}  // namespace
}  // namespace halfplane::cli::completions_test
