// The command line as data, from the tree of CLI::App: the input of completions and man pages.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace halfplane {

/// A value of an option or a positional, for a shell to complete.
struct Completion {
  enum class Kind {
    none,     ///< no value: a flag
    text,     ///< a value that cannot be guessed
    words,    ///< one of `words`
    list,     ///< several of `words`, separated by commas
    setting,  ///< key=value
    key,      ///< a key of `words`, then '=' and a value that cannot be guessed
    scene,    ///< a scene of `words`, or a file
    scenes,   ///< such scenes, separated by commas
    preset,   ///< a preset of `words`, or a file
    file,
    folder
  };
  Kind kind = Kind::none;
  std::vector<std::string> words;
  std::vector<std::string> endings;  ///< endings of files, as ".hpt"; empty: any
};

struct OptionText {
  std::vector<std::string> names;  ///< "-o", "--depth"; empty for a positional
  std::string value;               ///< "FILE", "SCENE..."; empty for a flag
  std::string meaning;
  std::string standard;  ///< the default; may be empty
  std::string range;     ///< "1 to 1024"; may be empty
  std::string group;     ///< heading; empty for the default one
  Completion completion;
  bool is_required = false;
  bool is_attached = false;  ///< takes its value only after '=', and optionally: --json
  bool is_repeatable = false;
};

/// A command, or the program itself.
struct CommandText {
  std::string name;  ///< empty: the program
  std::string meaning;
  std::vector<OptionText> positionals, options;
  std::vector<std::string> notes;     ///< lines of the footer that are not examples
  std::vector<std::string> examples;  ///< each as typed
};

/// The program first, then its commands in order.
[[nodiscard]] std::vector<CommandText> command_texts(const CLI::App& program);

/// The named values of a setting; empty for a number.
[[nodiscard]] std::vector<std::string> setting_values(std::string_view unit);

}  // namespace halfplane
