// halfplane man: manual pages in roff, one for the program and one for each command, made from the options themselves.
#include <filesystem>
#include <iostream>
#include <memory>

#include "model/nearest_word.hpp"
#include "sim/cli/command_line.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/option_kinds.hpp"
#include "sim/cli/options.hpp"
#include "sim/show/image/whole_file.hpp"

namespace halfplane {
namespace {

/// Text escaped for roff: no minus becomes a hyphen, no line a request.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
  if (result.starts_with(".") || result.starts_with("'")) result.insert(0, "\\&");
  return result;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

std::string page_name(const CommandText& command) {
  return command.name.empty() ? "halfplane" : "halfplane-" + command.name;
}

std::string option_entry(const OptionText& option) {
  std::string names;
  for (const std::string& name : option.names) {
    names += (names.empty() ? "" : ", ") + bold(name);
    if (option.is_attached)
      names += "[=" + italic(option.value) + "]";
    else if (!option.value.empty())
      names += " " + italic(option.value);
  }
  if (option.names.empty()) names = italic(option.value);
  std::string text = ".TP\n" + names + "\n" + roff(option.meaning) + "\n";
  const std::string both = option.range.empty() || option.standard.empty() ? "" : "; ";
  const std::string standard = option.standard.empty() ? "" : "default: " + option.standard;
  if (const std::string limits = option.range + both + standard; !limits.empty()) text += "(" + roff(limits) + ")\n";
  using Kind = Completion::Kind;
  const bool is_choice = option.completion.kind == Kind::words || option.completion.kind == Kind::list;
  if (is_choice && !option.names.empty()) {
    std::vector<std::string> words;
    for (const std::string& word : option.completion.words) words.push_back(bold(word));
    text += ".br\nKnown values: " + joined(words) + "\n";
  }
  return text;
}

std::string option_entries(const CommandText& command) {
  std::string text, group;
  for (const OptionText& option : command.options) {
    if (option.group != group) text += ".SS " + roff(option.group) + "\n";
    group = option.group;
    text += option_entry(option);
  }
  return text;
}

std::string synopsis(const CommandText& command) {
  std::string text = bold("halfplane") + " " + (command.name.empty() ? italic("COMMAND") : bold(command.name));
  for (const OptionText& positional : command.positionals)
    text += " " + (positional.is_required ? italic(positional.value) : "[" + italic(positional.value) + "]");
  return text + " [" + italic("options") + "]\n";
}

constexpr const char* kEnding = R"(.SH EXIT STATUS
.TP
.B 0
success
.TP
.B 1
a mismatch or a broken bound
.TP
.B 2
wrong usage or bad input; one line on stderr says what and how to mend it
.TP
.B 3
this machine or this build lacks something
.TP
.B 130
interrupted
.SH ENVIRONMENT
.TP
.B NO_COLOR
set and not empty: no escapes for colours, anywhere
)";

/// The text after the name: without the program's own name and a full stop.
std::string purpose(const CommandText& command) {
  std::string text = command.meaning;
  if (const auto colon = text.find(": "); command.name.empty() && colon != std::string::npos) text.erase(0, colon + 2);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

std::string man_page(const CommandText& command, const std::vector<CommandText>& all) {
  std::string title = page_name(command);
  for (char& c : title) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  // No date: the same program makes the same page.
  std::string text =
      ".TH \"" + roff(title) + "\" 1 \"\" \"halfplane " HALFPLANE_VERSION "\" \"Halfplane\"\n.SH NAME\n" +
      roff(page_name(command)) + " \\- " + roff(purpose(command)) + "\n.SH SYNOPSIS\n" + synopsis(command);
  if (!command.positionals.empty() || !command.notes.empty()) text += ".SH DESCRIPTION\n";
  for (const std::string& note : command.notes) text += roff(note) + "\n.br\n";
  for (const OptionText& positional : command.positionals) text += option_entry(positional);
  if (command.name.empty()) {
    text += ".SH COMMANDS\n";
    for (const CommandText& one : all)
      if (!one.name.empty()) text += ".TP\n" + bold(one.name) + "\n" + roff(one.meaning) + "\n";
  }
  text += ".SH OPTIONS\n" + option_entries(command) + kEnding;
  if (!command.examples.empty()) text += ".SH EXAMPLES\n.nf\n";
  for (const std::string& example : command.examples) text += roff(example) + "\n";
  if (!command.examples.empty()) text += ".fi\n";
  std::vector<std::string> others;
  for (const CommandText& one : all)
    if (one.name != command.name) others.push_back(bold(page_name(one)) + "(1)");
  return text + ".SH SEE ALSO\n" + joined(others, ",\n") + "\n";
}

struct ManOptions {
  std::string command, folder;
};

int run_man(const CLI::App& program, const ManOptions& options) {
  const auto commands = command_texts(program);
  if (!options.folder.empty()) {
    if (!options.command.empty()) throw InputError("-o writes every page; leave out '" + options.command + "'");
    make_folder("-o", options.folder);
    for (const CommandText& command : commands) {
      const std::string page = man_page(command, commands);
      write_text_file((std::filesystem::path(options.folder) / (page_name(command) + ".1")).string(), page);
    }
    return exit_ok;
  }
  for (const CommandText& command : commands)
    if (command.name == options.command) {
      std::cout << man_page(command, commands);
      return exit_ok;
    }
  std::vector<std::string_view> names;
  for (const CommandText& command : commands) names.push_back(command.name);
  throw InputError("no command '" + options.command + "', so it has no page;" + did_you_mean(options.command, names) +
                   " see `halfplane --help`");
}

}  // namespace

void add_man_command(CLI::App& app, Action& selected) {
  CLI::App* command = app.add_subcommand("man", "prints or writes the manual pages");
  auto options = std::make_shared<ManOptions>();
  command->add_option("COMMAND", options->command, "the command whose page is printed (default: the program's)");
  add_text_option(*command, "-o", options->folder, "writes every page into this folder instead", "DIR");
  command->footer("\nRead a page with `halfplane man render | man -l -`.\n\nExample:\n  halfplane man -o man1");
  command->callback([&selected, &app, options] { selected = [&app, options] { return run_man(app, *options); }; });
}

}  // namespace halfplane
