#include "config_file.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "model/nearest_word.hpp"

namespace halfplane {
namespace {

constexpr std::size_t kMaxBytes = 65536;  // every setting with a paragraph of comment is below 4 KiB
constexpr int kMaxDotsPerLine = 16;       // a key has one
constexpr int kMaxBraces = 4;             // { } once, as in depth = { bits = 20 }

struct Place {
  std::string_view file;
  std::size_t line = 0;  ///< from 1; 0: the file as a whole
};

[[noreturn]] void fail(const Place& place, const std::string& message) {
  const std::string line = place.line == 0 ? "" : ":" + std::to_string(place.line);
  throw InputError(std::string(place.file) + line + ": " + message);
}

// Text from the file inside a one-line message: short, and without control characters.
std::string shown(std::string_view text) {
  constexpr std::size_t kLength = 48;
  std::string result = "'";
  for (const char c : text.substr(0, kLength)) result += static_cast<unsigned char>(c) < ' ' || c == 0x7f ? '?' : c;
  return result + (text.size() > kLength ? "...'" : "'");
}

// Index just after the string whose opening quote is at `start`; the line's end if it is not closed there.
std::size_t skip_string(std::string_view text, std::size_t start) {
  const char quote = text[start];
  const std::string triple(3, quote);
  const bool multi_line = text.substr(start, 3) == triple;
  for (std::size_t i = start + (multi_line ? 3 : 1); i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;  // the escaped character closes nothing
    } else if (multi_line) {
      if (text.substr(i, 3) != triple) continue;
      i += 3;
      while (i < text.size() && text[i] == quote) ++i;  // up to two quotes may precede the closing three
      return i;
    } else if (text[i] == quote || text[i] == '\n') {
      return i + (text[i] == quote ? 1 : 0);
    }
  }
  return text.size();
}

// Whether a key, bare or quoted, can begin after the brackets of a table header.
bool begins_table_name(std::string_view header) {
  std::size_t i = 1;
  if (i < header.size() && header[i] == '[') ++i;
  while (i < header.size() && (header[i] == ' ' || header[i] == '\t')) ++i;
  if (i == header.size()) return true;
  const char c = header[i];
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("_-\"'").find(c) != std::string_view::npos;
}

// Refuses text that toml++ 3.3 cannot handle. toml++ recurses once per level of nesting, and once per dot when it frees
// the tables of a dotted key, so a hostile file could exhaust the stack: settings need one level. And its assertions
// (undefined behaviour where they are compiled out) fail on malformed arrays and dates and on letters beyond ASCII,
// which no setting uses, and on control characters and table headers without a name, which TOML forbids.
void refuse_hostile_text(std::string_view text, std::string_view file) {
  std::size_t line = 1, string_end = 0, comment_end = 0;
  int dots = 0, braces = 0;
  bool line_start = true;  // only blanks since the last line break
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if ((static_cast<unsigned char>(c) < ' ' && c != '\t' && c != '\n' && c != '\r') || c == 0x7f)
      fail({file, line}, "not TOML: a control character; is this a text file?");
    if (c == '\n') {
      ++line;
      dots = 0;
    }
    const bool first_of_line = line_start && c != ' ' && c != '\t';
    line_start = c == '\n' || (line_start && !first_of_line);
    if (i < comment_end) continue;
    if (static_cast<unsigned char>(c) >= 0x80 && !(i < 3 && text.starts_with("\xef\xbb\xbf")))  // a byte order mark
      fail({file, line}, "a letter beyond ASCII; only comments take them");
    if (i < string_end) continue;
    if (c == '[' && !first_of_line && text[i - 1] != '[') fail({file, line}, "no setting takes an array");
    if (c == '[' && first_of_line && !begins_table_name(text.substr(i)))
      fail({file, line}, "not TOML: a table needs a name, as in [depth]");
    const bool after_digit = i > 0 && text[i - 1] >= '0' && text[i - 1] <= '9';
    if (c == ':' || (c == '-' && after_digit)) fail({file, line}, "no setting takes a date or a time");
    if (c == '"' || c == '\'') string_end = skip_string(text, i);
    if (c == '#') comment_end = text.find('\n', i);  // npos: to the end
    if (c == '.' && ++dots > kMaxDotsPerLine) fail({file, line}, "too many dots; a key has one, as in depth.bits");
    if (c == '{' && ++braces > kMaxBraces) fail({file, line}, "too many braces; a setting is written as key = value");
    if (c == '}' && braces > 0) --braces;
  }
}

// `keys` starts with the valid keys of this place other than settings.
std::string unknown_key_message(std::string_view key, std::vector<std::string_view> keys = {"preset"}) {
  for (const Setting& setting : settings()) keys.push_back(setting.key);
  return "no setting " + shown(key) + ";" + did_you_mean(key, keys) + " `halfplane config --list` shows them all";
}

/// One `key = value` of the file.
struct Entry {
  std::string key;
  const toml::node* value = nullptr;
  std::size_t line = 0;
};

bool is_table_of_settings(std::string_view name) {
  return std::any_of(settings().begin(), settings().end(),
                     [name](const Setting& setting) { return setting.key.starts_with(std::string(name) + "."); });
}

// Depth is bounded by refuse_hostile_text(). An empty table is an entry without a value.
void collect(const toml::table& table, const std::string& prefix, std::vector<Entry>& entries) {
  for (const auto& [key, value] : table) {
    const std::string name = prefix + std::string(key.str());
    const std::size_t line = key.source().begin.line;
    const toml::table* inner = value.as_table();
    if (inner == nullptr || inner->empty())
      entries.push_back({name, inner == nullptr ? &value : nullptr, line});
    else
      collect(*inner, name + ".", entries);
  }
}

// The value in the form of `--set`.
std::string value_text(const Entry& entry, const Setting& setting, const Place& place) {
  if (setting.is_number()) {
    if (const auto* number = entry.value->as_integer()) return std::to_string(number->get());
    fail(place, entry.key + ": give a whole number " + std::to_string(setting.min) + "..." +
                    std::to_string(setting.max) + ", without quotes");
  }
  if (const auto* text = entry.value->as_string()) return text->get();
  fail(place, entry.key + ": give one of " + std::string(setting.unit) + " in quotes");
}

// Runs an action of model/config.hpp and adds the place to its errors.
template <typename Action>
void at_place(const Place& place, Action action) {
  try {
    action();
  } catch (const InputError& error) {
    fail(place, error.what());
  }
}

toml::table parse(std::string_view text, std::string_view file) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    const std::string message(error.description());
    fail({file, error.source().begin.line}, "not TOML: " + message.substr(0, message.find('\n')));
  }
}

Config config_of(const std::vector<Entry>& entries, std::string_view file) {
  Config config;
  for (const Entry& entry : entries) {
    if (entry.key != "preset") continue;
    const Place place{file, entry.line};
    const auto* name = entry.value == nullptr ? nullptr : entry.value->as_string();
    if (name == nullptr) fail(place, "preset: give a name in quotes, as in preset = \"embedded\"");
    if (std::ranges::find(preset_names(), name->get()) == preset_names().end())
      fail(place, "no preset " + shown(name->get()) + ";" + did_you_mean(name->get(), preset_names()) +
                      " the presets are tiny, small, embedded and full");
    config = preset(name->get());
  }
  for (const Entry& entry : entries) {
    if (entry.key == "preset" || (entry.value == nullptr && is_table_of_settings(entry.key))) continue;
    const Place place{file, entry.line};
    const Setting* setting = find_setting(entry.key);
    if (setting == nullptr || entry.value == nullptr) fail(place, unknown_key_message(entry.key));
    const std::string text = value_text(entry, *setting, place);
    at_place(place, [&] { set(config, entry.key, text); });
  }
  return config;
}

std::string read_text(const std::string& path, const std::string& what) {
  errno = 0;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  std::string text(kMaxBytes + 1, '\0');  // one more, so that a too long file is detected
  if (file) text.resize(std::fread(text.data(), 1, text.size(), file.get()));
  if (!file || std::ferror(file.get()) != 0)
    throw InputError("cannot read " + what + " '" + path + "': " + std::strerror(errno) +
                     (what == "configuration" ? "; give a preset (tiny, small, embedded, full) or a .toml file" : ""));
  return text;
}

/// The keys of the text, in their order; values are of `table`.
std::vector<Entry> read_entries(std::string_view text, std::string_view file_name, toml::table& table) {
  if (text.size() > kMaxBytes)
    fail({file_name}, "a configuration is at most " + std::to_string(kMaxBytes) + " bytes; is this the right file?");
  refuse_hostile_text(text, file_name);
  table = parse(text, file_name);
  std::vector<Entry> entries;
  collect(table, "", entries);
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.line < b.line; });
  return entries;
}

}  // namespace

const Setting* find_setting(std::string_view key) {
  for (const Setting& setting : settings())
    if (setting.key == key) return &setting;
  return nullptr;
}

Config read_config_toml(std::string_view text, std::string_view file_name) {
  toml::table table;
  Config config = config_of(read_entries(text, file_name, table), file_name);
  at_place({file_name}, [&] { validate(config); });
  return config;
}

std::string config_toml(const Config& config) {
  std::string text = "preset = \"" + config.preset + "\"  # what the values started from\n";
  std::vector<std::string_view> tables;  // in the order of their first setting
  for (const Setting& setting : settings())
    if (const auto table = setting.key.substr(0, setting.key.find('.'));
        std::ranges::find(tables, table) == tables.end())
      tables.push_back(table);
  for (const std::string_view table : tables) {
    text += "\n[" + std::string(table) + "]\n";
    for (const Setting& setting : settings()) {
      const auto dot = setting.key.find('.');
      if (setting.key.substr(0, dot) != table) continue;
      const std::string value = get(config, setting);
      const bool is_number = setting.is_number();
      text += std::string(setting.key.substr(dot + 1)) + " = " + (is_number ? value : '"' + value + '"') + "  # " +
              (is_number ? std::to_string(setting.min) + "..." + std::to_string(setting.max) + " " : std::string()) +
              std::string(setting.unit) + ": " + std::string(setting.meaning) + '\n';
    }
  }
  return text;
}

void set_by_key(Config& config, std::string_view key, std::string_view value) {
  if (find_setting(key) == nullptr) throw InputError(unknown_key_message(key, {}));
  set(config, key, value);
}

Config read_config_file(const std::string& path) { return read_config_toml(read_text(path, "configuration"), path); }

std::vector<TomlWord> read_toml_words(const std::string& path) {
  toml::table table;
  std::vector<TomlWord> words;
  for (const Entry& entry : read_entries(read_text(path, "file"), path, table)) {
    TomlWord word{entry.key, "", entry.line};
    if (entry.value != nullptr && entry.value->is_string()) {
      word.value = entry.value->as_string()->get();
    } else if (entry.value != nullptr && entry.value->is_integer()) {
      word.value = std::to_string(entry.value->as_integer()->get());
    } else if (entry.value != nullptr) {
      fail({path, entry.line}, entry.key + ": give a whole number, or text in quotes");
    }
    words.push_back(word);
  }
  return words;
}

Config config_from_option(const std::string& option) {
  if (std::ranges::find(designs(), option, &Design::name) != designs().end()) return preset(option);
  const bool is_file = std::filesystem::path(option).extension() == ".toml" || option.find('/') != std::string::npos;
  if (is_file) return read_config_file(option);
  throw InputError("--config: no preset " + shown(option) + ";" + did_you_mean(option, preset_names()) +
                   " give tiny, small, embedded, full or a .toml file");
}

nlohmann::ordered_json config_json(const Config& config) {
  nlohmann::ordered_json json{{"preset", config.preset}};
  for (const Setting& setting : settings()) {
    const std::string value = get(config, setting);
    if (setting.is_number())
      json[std::string(setting.key)] = std::stoi(value);
    else
      json[std::string(setting.key)] = value;
  }
  return json;
}

}  // namespace halfplane
