#include "sim/cli/command_line.hpp"

#include <map>
#include <sstream>

#include "model/config.hpp"
#include "model/counters.hpp"
#include "model/timing/memory.hpp"
#include "model/vectors/stages.hpp"
#include "sim/scene/builtin.hpp"
#include "sim/scene/convention.hpp"
#include "sim/show/report/hardware.hpp"
#include "sim/study/bench/engines.hpp"
#include "sim/study/stress/cases.hpp"
#include "sim/words.hpp"

namespace halfplane {
namespace {

using Kind = Completion::Kind;
using Words = std::vector<std::string>;

template <typename Range>
Words words_of(const Range& names) {
  return Words(std::begin(names), std::end(names));
}

template <typename Range, typename Member>
Words names_of(const Range& entries, Member member) {
  Words words;
  for (const auto& entry : entries) words.emplace_back(entry.*member);
  return words;
}

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Words scene_names() { return names_of(all_builtin_scenes(), &Builtin::name); }

Words stage_names() {
  Words words;
  for (const vectors::JudgedStage& stage : vectors::judged_stages()) words.emplace_back(info(stage.stage).name);
  return words;
}

Words convention_names() {
  Words words;
  for (const Convention& convention : conventions())
    for (const char* order : {"", ":standard", ":reversed"}) words.push_back(std::string(convention.name) + order);
  return words;
}

const Words kSceneFiles{".obj", ".gltf", ".glb", ".hpt"};

/// Completions of options whose words CLI11 does not know, by their long names.
std::map<std::string, Completion> known_completions() {
  const Words keys = names_of(settings(), &Setting::key), timing = names_of(timing_settings(), &TimingSetting::key);
  const Words mappings = words_of(depth_mapping_names().subspan(1));  // the first is the scene's own
  return {
      {"--config", {Kind::preset, names_of(designs(), &Design::name), {".toml"}}},
      {"--set", {Kind::setting, {}, {}}},
      {"--vary", {Kind::key, keys, {}}},
      {"--what-if", {Kind::key, with(with(keys, timing), words_of(kMemoryKeys)), {}}},
      {"--timing", {Kind::key, timing, {}}},
      {"--engine", {Kind::words, {"functional", "scalar", "cycle", "rtl", "golden", "golden32"}, {}}},
      {"--engines", {Kind::list, words_of(kBenchEngines), {}}},
      {"--skip", {Kind::list, with({"all", "none"}, names_of(kSkipNames, &SkipName::name)), {}}},
      {"--convention", {Kind::words, convention_names(), {}}},
      {"--cull-objects", {Kind::words, {"none", "sphere", "box", "both"}, {}}},
      {"--memory", {Kind::words, words_of(kMemoryKinds), {}}},
      {"--mapping", {Kind::list, mappings, {}}},
      {"--format", {Kind::list, {"u16", "u24", "u32", "bins16", "bins24", "f16", "f32", "uf4.12", "uf5.11"}, {}}},
      {"--case", {Kind::list, names_of(stress::cases(), &stress::Case::name), {}}},
      {"--stage", {Kind::words, stage_names(), {}}},
      {"--scene", {Kind::scene, scene_names(), kSceneFiles}},
      {"SCENE", {Kind::scene, scene_names(), kSceneFiles}},
      {"SCENES", {Kind::scene, scene_names(), kSceneFiles}},
      {"--json", {Kind::file, {}, {".json"}}},
  };
}

/// Extracts "{a,b,c}" from a type name: CLI::IsMember's description.
Words member_words(const std::string& type) {
  const auto open = type.find('{'), close = type.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {};
  return split(type.substr(open + 1, close - open - 1), ',');
}

Completion completion_of(const OptionText& option, const CLI::Option& source, const std::string& type) {
  const bool is_list = source.get_delimiter() != '\0';
  if (const Words words = member_words(type); !words.empty()) return {is_list ? Kind::list : Kind::words, words, {}};
  static const std::map<std::string, Completion> known = known_completions();
  const auto found = known.find(option.names.empty() ? source.get_name(true) : option.names.back());
  if (found != known.end()) {
    Completion completion = found->second;
    if (completion.kind == Kind::scene && is_list) completion.kind = Kind::scenes;
    return completion;
  }
  if (option.value.empty()) return {};
  const std::string kind = type.substr(0, type.find(':'));
  if (kind == "FILE") return {Kind::file, {}, {}};
  if (kind == "DIR" || kind == "FOLDER") return {Kind::folder, {}, {}};
  return {Kind::text, {}, {}};
}

/// "SCENE..." and the like: the placeholder of the value.
std::string value_name(const CLI::Option& option, const std::string& type) {
  if (option.get_items_expected_max() == 0) return "";
  if (option.get_positional() && option.get_lnames().empty())
    return option.get_name(true) + (option.get_items_expected_max() > 1 ? "..." : "");
  std::string word = type.substr(0, type.find_first_of(":{ "));
  if (word.starts_with("--")) word.clear();
  return word.empty() ? "VALUE" : word;
}

/// CLI11 names the type in C++; a reader needs the kind of value.
std::string readable(const std::string& word, Kind kind) {
  if (word == "INT" || word == "UINT" || word == "FLOAT") return "N";
  if (word != "TEXT" && word != "VALUE") return word;
  switch (kind) {
    case Kind::words: return "NAME";
    case Kind::list:
    case Kind::scenes: return "LIST";
    case Kind::setting: return "KEY=VALUE";
    case Kind::key: return "KEY=LIST";
    case Kind::preset: return "PRESET|FILE";
    case Kind::scene: return "SCENE";
    default: return word;
  }
}

/// "1 to 1024" from "INT in [1 - 1024]", CLI::Range's description; empty without one.
std::string range_text(const std::string& type) {
  const auto open = type.find(" in ["), close = type.find(']', open);
  if (open == std::string::npos || close == std::string::npos) return "";
  std::string range = type.substr(open + 5, close - open - 5);
  if (const auto dash = range.find(" - "); dash != std::string::npos) range.replace(dash, 3, " to ");
  return range;
}

OptionText option_text(const CLI::Option& source) {
  OptionText option;
  for (const std::string& name : source.get_snames()) option.names.push_back("-" + name);
  for (const std::string& name : source.get_lnames()) option.names.push_back("--" + name);
  const std::string type = source.get_type_name();
  option.value = value_name(source, type);
  option.meaning = source.get_description();
  option.standard = source.get_default_str();
  if (const std::string& group = source.get_group(); group != "Options" && group != "Positionals") option.group = group;
  option.is_required = source.get_required();
  option.is_attached = !option.names.empty() && option.names.back() == "--json";
  if (option.is_attached) option.value = "FILE";
  option.is_repeatable = source.get_items_expected_max() > 1;
  option.completion = completion_of(option, source, type);
  if (!option.names.empty()) option.value = readable(option.value, option.completion.kind);
  option.range = range_text(type);
  return option;
}

/// Adds options of `app` and of its groups, which CLI11 keeps as commands without a name.
void add_options_of(const CLI::App& app, const std::string& group, CommandText& command) {
  for (const CLI::Option* source : app.get_options()) {
    if (source->get_group().empty()) continue;  // hidden
    OptionText option = option_text(*source);
    if (option.group.empty()) option.group = group;
    (option.names.empty() ? command.positionals : command.options).push_back(std::move(option));
  }
  for (const CLI::App* inner : app.get_subcommands({}))
    if (inner->get_name().empty()) add_options_of(*inner, inner->get_group(), command);
}

CommandText command_text(const CLI::App& app, bool is_program) {
  CommandText command;
  if (!is_program) command.name = app.get_name();
  command.meaning = app.get_description();
  add_options_of(app, "", command);
  std::istringstream footer(app.get_footer());
  for (std::string line; std::getline(footer, line);) {
    if (line.starts_with("  halfplane "))
      command.examples.push_back(line.substr(2));
    else if (!line.empty() && !line.starts_with("Example"))
      command.notes.push_back(line);
  }
  return command;
}

}  // namespace

std::vector<CommandText> command_texts(const CLI::App& program) {
  std::vector<CommandText> commands{command_text(program, true)};
  for (const CLI::App* app : program.get_subcommands({}))
    if (!app->get_name().empty()) commands.push_back(command_text(*app, false));
  Words names;
  for (const CommandText& command : commands)
    if (!command.name.empty()) names.push_back(command.name);
  for (CommandText& command : commands)
    for (OptionText& positional : command.positionals)
      if (positional.value == "COMMAND") positional.completion = {Kind::words, names, {}};
  return commands;
}

std::vector<std::string> setting_values(std::string_view unit) {
  std::vector<std::string> values;
  if (unit.find('|') == std::string_view::npos) return values;
  for (const std::string& value : split(unit, '|'))
    if (value.find('<') == std::string::npos) values.push_back(value);  // u<b> stands for many values
  return values;
}

}  // namespace halfplane
