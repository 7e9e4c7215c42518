// Configuration files: TOML with the keys of settings(), a dot being a table. `preset` chooses the start values of the
// others:
//
//   preset = "full"
//   [depth]
//   bits = 20
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "model/config.hpp"

namespace halfplane {

/// Reads a configuration from TOML text and validates it. Throws InputError "file:line: ..." for text that is not TOML,
/// an unknown key (naming the nearest one), a wrong type, a value outside its range, or a refused combination.
[[nodiscard]] Config read_config_toml(std::string_view text, std::string_view file_name);

/// The same for a file. Throws InputError when it cannot be read.
[[nodiscard]] Config read_config_file(const std::string& path);

/// One `key = value` of another TOML file, a dot being a table: its value as text. An empty table has an empty value.
struct TomlWord {
  std::string key, value;
  std::size_t line = 0;
};

/// The keys of a file whose values are whole numbers or texts, in their order. Throws InputError as above.
[[nodiscard]] std::vector<TomlWord> read_toml_words(const std::string& path);

/// Text from which read_config_toml() reads the same configuration: the preset and every value, each with its meaning.
[[nodiscard]] std::string config_toml(const Config& config);

/// The setting with that key; null: there is none.
[[nodiscard]] const Setting* find_setting(std::string_view key);

/// set(), with an InputError for an unknown key that names the nearest one.
void set_by_key(Config& config, std::string_view key, std::string_view value);

/// Value of `--config`: the name of a preset, or a file ending in .toml.
[[nodiscard]] Config config_from_option(const std::string& option);

/// The preset and every effective value, keyed as in --set.
[[nodiscard]] nlohmann::ordered_json config_json(const Config& config);

}  // namespace halfplane
