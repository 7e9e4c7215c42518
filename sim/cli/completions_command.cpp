// halfplane completions: completions for bash, zsh and fish, made from the options themselves.
#include <iostream>
#include <memory>

#include "model/config.hpp"
#include "sim/cli/command_line.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/options.hpp"
#include "sim/words.hpp"

namespace halfplane {
namespace {

using CompletionKind = Completion::Kind;

std::string spaced(const std::vector<std::string>& words, const std::string& before = " ") {
  return words.empty() ? "" : before + joined(words, before);
}

std::string replaced(std::string text, const std::string& characters, const std::string& before) {
  for (std::size_t i = text.find_first_of(characters); i != std::string::npos;
       i = text.find_first_of(characters, i + before.size() + 1))
    text.insert(i, before);
  return text;
}

std::string in_fish_quotes(const std::string& text) { return "'" + replaced(text, "'", "\\") + "'"; }

std::vector<std::string> command_names(const std::vector<CommandText>& commands) {
  std::vector<std::string> names;
  for (const CommandText& command : commands)
    if (!command.name.empty()) names.push_back(command.name);
  return names;
}

std::vector<std::string> option_names(const CommandText& command) {
  std::vector<std::string> names;
  for (const OptionText& option : command.options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
    if (option.is_attached) names.push_back(option.names.back() + "=");
  }
  return names;
}

std::string first_line(const char* shell) {
  return std::string("halfplane " HALFPLANE_VERSION " for ") + shell + "; made by `halfplane completions " + shell +
         "`.\n";
}

// ---- bash

constexpr const char* kBashHelpers = R"(
# Each takes what there is to choose from; `value` is what is typed of it, `attached` the option before its '='.
_halfplane_words() {
  local word
  for word in "$@"; do [[ $word != "$value"* ]] || COMPREPLY+=("$attached$word"); done
}

_halfplane_list() { # the word behind the last comma
  local word head=${value%"${value##*,}"} last=${value##*,}
  for word in "$@"; do [[ $word != "$last"* ]] || COMPREPLY+=("$attached$head$word"); done
}

_halfplane_files() { # names that end so, and folders; any without arguments
  local name ending
  compopt -o filenames 2>/dev/null
  while IFS= read -r name; do COMPREPLY+=("$attached$name"); done < <(compgen -d -- "$value")
  (($# > 0)) || set -- ''
  for ending in "$@"; do
    while IFS= read -r name; do
      [[ -d $name ]] || COMPREPLY+=("$attached$name")
    done < <(compgen -f -X "!*$ending" -- "$value")
  done
}

_halfplane_keys() {
  compopt -o nospace 2>/dev/null
  _halfplane_words "${@/%/=}"
}
)";

// Bash cuts words at '=' and ':'; they are joined first, and the part that bash already has is left out of the answers.
constexpr const char* kBashHead = R"(
_halfplane() {
  local line=() word i is_glued=''
  COMPREPLY=()
  for ((i = 0; i <= COMP_CWORD; i++)); do
    word=${COMP_WORDS[i]}
    if ((i > 1)) && [[ $is_glued || $word == [=:] ]]; then line[-1]+=$word; else line+=("$word"); fi
    is_glued=''
    [[ $word != [=:] ]] || is_glued=1
  done
  local current=${line[-1]} raw=${COMP_WORDS[COMP_CWORD]}
  [[ $raw != [=:] ]] || raw=''
  local taken=${current%"$raw"}
  if ((${#line[@]} < 3)); then
    local value=$current attached=''
    _halfplane_words $commands
  else
    local option=${line[-2]} value=$current attached=''
    if [[ $current == --*=* ]]; then option=${current%%=*} value=${current#*=} attached=$option=; fi
    _halfplane_of "${line[1]}" "$option" || { value=$current attached=''; _halfplane_plain "${line[1]}"; }
  fi
  for i in "${!COMPREPLY[@]}"; do COMPREPLY[i]=${COMPREPLY[i]#"$taken"}; done
}

complete -F _halfplane halfplane
)";

/// The call that completes one value; empty if there is none.
std::string bash_call(const Completion& completion) {
  const std::string words = spaced(completion.words);
  switch (completion.kind) {
    case CompletionKind::words: return "_halfplane_words" + words;
    case CompletionKind::list:
    case CompletionKind::scenes: return "_halfplane_list" + words;
    case CompletionKind::setting: return "_halfplane_setting";
    case CompletionKind::key: return "_halfplane_keys" + words;
    case CompletionKind::scene:
    case CompletionKind::preset: return "_halfplane_words" + words + "; _halfplane_files" + spaced(completion.endings);
    case CompletionKind::file: return "_halfplane_files" + spaced(completion.endings);
    case CompletionKind::folder: return "_halfplane_files /";
    case CompletionKind::text: return ":";  // a free value: no option names here
    case CompletionKind::none: break;
  }
  return "";
}

std::string bash_setting() {
  std::string text = "\n_halfplane_setting() {\n  case $value in\n";
  std::vector<std::string> keys;
  for (const Setting& setting : settings()) {
    const std::string key(setting.key);
    keys.push_back(key);
    if (const auto values = setting_values(setting.unit); !values.empty())
      text += "    " + key + "=*) _halfplane_words" + spaced(values, " " + key + "=") + " ;;\n";
  }
  return text + "    *=*) ;;\n    *) _halfplane_keys" + spaced(keys) + " ;;\n  esac\n}\n";
}

std::string bash_script(const std::vector<CommandText>& commands) {
  std::string values =
      "\n# The value of option $2 of command $1; fails where it takes none.\n_halfplane_of() {\n  case $1.$2 in\n";
  std::string plain = "\n# Words of command $1 that are no option's value.\n_halfplane_plain() {\n  case $1 in\n";
  for (const CommandText& command : commands) {
    if (command.name.empty()) continue;
    for (const OptionText& option : command.options) {
      const std::string call = bash_call(option.completion);
      if (call.empty()) continue;
      std::string pattern;
      for (const std::string& name : option.names)
        pattern.append(pattern.empty() ? "" : " | ").append(command.name).append(".").append(name);
      // An option that needs '=' takes no value after a blank.
      values += "    " + pattern + ") " + (option.is_attached ? "[[ $attached ]] || return 1; " : "") + call + " ;;\n";
    }
    plain += "    " + command.name + ")\n      if [[ $value == -* ]]; then _halfplane_words" +
             spaced(option_names(command)) + "\n      else ";
    std::string calls;
    for (const OptionText& positional : command.positionals) calls += bash_call(positional.completion) + "; ";
    plain += (calls.empty() ? ":; " : calls) + "fi\n      ;;\n";
  }
  std::string head = kBashHead;
  const std::string mark = "$commands";
  head.replace(head.find(mark), mark.size(),
               spaced(command_names(commands)).substr(1) + spaced(option_names(commands[0])));
  return "# Completion of " + first_line("bash") + kBashHelpers + bash_setting() + values +
         "    *) return 1 ;;\n  esac\n}\n" + plain + "  esac\n}\n" + head;
}

// ---- zsh

std::string zsh_description(const std::string& text) { return replaced(text, "[]:\\", "\\"); }

/// An action of _arguments.
std::string zsh_action(const Completion& completion) {
  const std::string words = replaced(spaced(completion.words), ":", "\\");
  const auto glob = [&] {
    std::string names;
    for (const std::string& ending : completion.endings) names += (names.empty() ? "" : "|") + ending.substr(1);
    return names.empty() ? std::string("_files") : "_files -g \"*.(" + names + ")\"";
  };
  switch (completion.kind) {
    case CompletionKind::words: return "(" + words + ")";
    case CompletionKind::list:
    case CompletionKind::scenes: return "_sequence compadd -" + words;
    case CompletionKind::setting: return "_halfplane_setting";
    case CompletionKind::key: return "_halfplane_keys" + words;
    case CompletionKind::scene: return "_halfplane_scenes";
    case CompletionKind::preset: return "_halfplane_presets";
    case CompletionKind::file: return glob();
    case CompletionKind::folder: return "_files -/";
    case CompletionKind::text:
    case CompletionKind::none: break;
  }
  return " ";
}

/// One spec of _arguments for each name of an option.
std::vector<std::string> zsh_specs(const OptionText& option) {
  std::vector<std::string> specs;
  for (const std::string& name : option.names) {
    std::string spec = (option.is_repeatable ? "*" : "") + name;
    if (option.is_attached)
      spec += "=-";
    else if (!option.value.empty() && name.starts_with("--"))
      spec += "=";
    spec += "[" + zsh_description(option.meaning) + "]";
    if (!option.value.empty())
      spec += (option.is_attached ? "::" : ":") + zsh_description(option.value) + ":" + zsh_action(option.completion);
    specs.push_back(in_single_quotes(spec));
  }
  if (option.names.empty())
    specs.push_back(in_single_quotes((option.value.ends_with("...") ? "*:" : ":") + option.value + ":" +
                                     zsh_action(option.completion)));
  return specs;
}

/// A function that offers words, and files with these endings.
std::string zsh_words_or_files(const std::string& name, const std::string& what, const Completion& completion) {
  Completion files = completion;
  files.kind = CompletionKind::file;
  return "\n_halfplane_" + name + "() {\n  _alternative " +
         in_single_quotes(name + ":" + what + ":(" + spaced(completion.words).substr(1) + ")") + " " +
         in_single_quotes("files:file:" + zsh_action(files)) + "\n}\n";
}

/// The first completion of that kind in any command.
Completion completion_of_kind(const std::vector<CommandText>& commands, CompletionKind kind) {
  for (const CommandText& command : commands)
    for (const auto* list : {&command.positionals, &command.options})
      for (const OptionText& option : *list)
        if (option.completion.kind == kind) return option.completion;
  return {};
}

std::string zsh_setting() {
  std::string text = "\n_halfplane_keys() { compadd -q -S = - \"$@\" }\n\n_halfplane_setting() {\n  _values setting";
  for (const Setting& setting : settings()) {
    const auto values = setting_values(setting.unit);
    text +=
        " \\\n    " + in_single_quotes(std::string(setting.key) + "[" + zsh_description(std::string(setting.meaning)) +
                                       "]:value:" + (values.empty() ? " " : "(" + spaced(values).substr(1) + ")"));
  }
  return text + "\n}\n";
}

std::string zsh_script(const std::vector<CommandText>& commands) {
  std::string text = "#compdef halfplane\n# Completion of " + first_line("zsh");
  text += zsh_words_or_files("scenes", "scene", completion_of_kind(commands, CompletionKind::scene));
  text += zsh_words_or_files("presets", "preset", completion_of_kind(commands, CompletionKind::preset));
  text += zsh_setting();
  text +=
      "\n_halfplane() {\n  local curcontext=$curcontext state line ret=1\n  local -a commands\n  typeset -A opt_args\n "
      " _arguments -C";
  for (const OptionText& option : commands[0].options)
    for (const std::string& spec : zsh_specs(option)) text += " \\\n    " + spec;
  text +=
      " \\\n    '1:command:->command' '*::argument:->argument' && ret=0\n  case $state in\n    command)\n      "
      "commands=(\n";
  for (const CommandText& command : commands)
    if (!command.name.empty())
      text += "        " + in_single_quotes(command.name + ":" + replaced(command.meaning, ":", "\\")) + "\n";
  text += "      )\n      _describe command commands && ret=0\n      ;;\n    argument)\n      case $words[1] in\n";
  for (const CommandText& command : commands) {
    if (command.name.empty()) continue;
    text += "        " + command.name + ")\n          _arguments";
    for (const auto* list : {&command.options, &command.positionals})
      for (const OptionText& option : *list)
        for (const std::string& spec : zsh_specs(option)) text += " \\\n            " + spec;
    text += " && ret=0\n          ;;\n";
  }
  return text +
         "      esac\n      ;;\n  esac\n  return ret\n}\n\n"
         "if [[ $funcstack[1] == _halfplane ]]; then _halfplane \"$@\"; else compdef _halfplane halfplane; fi\n";
}

// ---- fish

constexpr const char* kFishHelpers = R"(
# The words, each behind what is typed up to the last comma.
function __halfplane_list
    set -l head (commandline -ct | string replace -r '^--[a-z-]+=' '' | string replace -r '[^,]*$' '')
    printf '%s\n' $head$argv
end

complete -c halfplane -f
)";

/// The arguments of -a, and -F or -f for files or none.
std::string fish_arguments(const Completion& completion) {
  switch (completion.kind) {
    case CompletionKind::words: return " -f -a '" + spaced(completion.words).substr(1) + "'";
    case CompletionKind::list:
    case CompletionKind::scenes: return " -f -a '(__halfplane_list" + spaced(completion.words) + ")'";
    case CompletionKind::key: {
      std::string keys;
      for (const std::string& word : completion.words) keys += " " + word + "=";
      return " -f -a '" + keys.substr(1) + "'";
    }
    case CompletionKind::setting: {
      std::string keys;
      for (const Setting& setting : settings()) {
        const std::string key = std::string(setting.key) + "=";
        const auto values = setting_values(setting.unit);
        keys += values.empty() ? " " + key : spaced(values, " " + key);
      }
      return " -f -a '" + keys.substr(1) + "'";
    }
    case CompletionKind::scene:
    case CompletionKind::preset: return " -F -a '" + spaced(completion.words).substr(1) + "'";
    case CompletionKind::file: return " -F";
    case CompletionKind::folder: return " -f -a '(__fish_complete_directories)'";
    case CompletionKind::text: return " -f";
    case CompletionKind::none: break;
  }
  return "";
}

std::string fish_script(const std::vector<CommandText>& commands) {
  std::string text = "# Completion of " + first_line("fish") + kFishHelpers;
  for (const CommandText& command : commands) {
    const bool is_program = command.name.empty();
    const std::string start =
        std::string("complete -c halfplane -n ") +
        (is_program ? "__fish_use_subcommand" : "'__fish_seen_subcommand_from " + command.name + "'");
    if (!is_program)
      text += "\ncomplete -c halfplane -n __fish_use_subcommand -a " + command.name + " -d " +
              in_fish_quotes(command.meaning) + "\n";
    for (const OptionText& option : command.options) {
      std::string names;
      for (const std::string& name : option.names)
        names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      const bool takes_word = !option.value.empty() && !option.is_attached;
      text += start + names + (takes_word ? " -r" : "") + fish_arguments(option.completion) + " -d " +
              in_fish_quotes(option.meaning) + "\n";
    }
    for (const OptionText& positional : command.positionals)
      text += start + fish_arguments(positional.completion) + "\n";
  }
  return text;
}

int run_completions(const CLI::App& program, const std::string& shell) {
  const auto commands = command_texts(program);
  std::cout << (shell == "bash"  ? bash_script(commands)
                : shell == "zsh" ? zsh_script(commands)
                                 : fish_script(commands));
  return exit_ok;
}

}  // namespace

void add_completions_command(CLI::App& app, Action& selected) {
  CLI::App* command = app.add_subcommand("completions", "prints the completion of this command line for a shell");
  auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "bash, zsh or fish")->check(CLI::IsMember({"bash", "zsh", "fish"}))->required();
  command->footer("\nExample:\n  halfplane completions bash");
  command->callback([&selected, &app, shell] { selected = [&app, shell] { return run_completions(app, *shell); }; });
}

}  // namespace halfplane
