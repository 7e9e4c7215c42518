#include <algorithm>

#include "config.hpp"

namespace halfplane {
namespace {

constexpr std::string_view kToml =
#include "designs_toml.inc"  // designs.toml as a string: written by CMakeLists.txt
    ;

/// The text before the next `separator`; both are removed from `text`.
std::string_view take_until(std::string_view& text, char separator) {
  const std::string_view head = text.substr(0, text.find(separator));
  text.remove_prefix(std::min(text.size(), head.size() + 1));
  return head;
}

/// "depth.bits=20 stamp.size=4".
void set_all(Config& config, std::string_view settings) {
  while (!settings.empty()) {
    std::string_view value = take_until(settings, ' ');
    if (const std::string_view key = take_until(value, '='); !key.empty()) set(config, key, value);
  }
}

[[noreturn]] void refuse(std::string_view line) { throw std::logic_error("model/designs.toml: " + std::string(line)); }

Design preset_of(std::string_view name, std::string_view settings) {
  Design design{name, name, {}};
  design.config.preset = name;
  set_all(design.config, settings);
  return design;
}

Design design_of(std::string_view name, std::string_view label, std::span<const Design> known) {
  std::string_view settings = label;
  const auto base = std::ranges::find(known, take_until(settings, ' '), &Design::name);
  if (base == known.end()) refuse(label);
  Design design{name, label, base->config};
  set_all(design.config, settings);
  return design;
}

std::vector<Design> read_designs() {
  std::vector<Design> all;
  std::string_view table, rest = kToml;
  while (!rest.empty()) {
    const std::string_view line = take_until(rest, '\n');
    if (line.empty() || line.starts_with('#')) continue;
    if (line == "[presets]" || line == "[designs]" || line == "[parts]") {
      table = line;
      continue;
    }
    std::string_view value = line;
    const std::string_view name = take_until(value, ' ');
    if (table.empty() || !value.starts_with("= \"") || value.find('"', 3) != value.size() - 1) refuse(line);
    const std::string_view text = value.substr(3, value.size() - 4);
    all.push_back(table == "[presets]" ? preset_of(name, text) : design_of(name, text, all));
  }
  return all;
}

}  // namespace

std::span<const Design> designs() {
  static const std::vector<Design> all = read_designs();
  return all;
}

std::span<const std::string_view> preset_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> list;
    for (const Design& design : designs())
      if (design.is_preset()) list.push_back(design.name);
    return list;
  }();
  return names;
}

Config preset(std::string_view name) {
  const auto found = std::ranges::find(designs(), name, &Design::name);
  if (found != designs().end()) return found->config;
  std::string list;
  for (const auto known : preset_names()) list.append(list.empty() ? "" : ", ").append(known);
  throw InputError("no preset '" + std::string(name) + "'; the presets are " + list);
}

Config labelled(std::string_view label) {
  Config config = preset(take_until(label, ' '));
  set_all(config, label);
  return config;
}

}  // namespace halfplane
