#include "sim/cli/regress_plan.hpp"

#include <algorithm>
#include <filesystem>

#include "model/as_number.hpp"
#include "model/nearest_word.hpp"
#include "sim/cli/options.hpp"
#include "sim/config_file.hpp"
#include "sim/words.hpp"

namespace halfplane {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostCases = 100'000;  // a file each
constexpr std::array<std::string_view, 8> kKeys{"config", "scenes", "random",  "only",
                                                "seeds",  "stalls", "options", "timeout"};

struct Row {
  std::string name, place;
  std::vector<std::string> configs{"embedded"}, scenes, stalls{"0"}, options;
  std::vector<std::uint64_t> seeds{1};
  std::uint64_t random = 0;
  std::string only;
  double timeout_s = 3600;
};

std::uint64_t number_of(const std::string& text, const std::string& place) {
  const auto value = as_number<std::uint64_t>(text);
  if (!value) throw InputError(place + ": '" + text + "' is not a whole number");
  return *value;
}

/// "1..50", "1|4|9".
std::vector<std::uint64_t> seeds_of(const std::string& text, const std::string& place) {
  std::vector<std::uint64_t> seeds;
  for (const std::string& part : words_of(text, '|')) {
    const std::size_t dots = part.find("..");
    const std::uint64_t first = number_of(part.substr(0, dots), place);
    const std::uint64_t last = dots == std::string::npos ? first : number_of(part.substr(dots + 2), place);
    if (last < first || last - first >= kMostCases)
      throw InputError(place + ": seeds: '" + part + "' is no range of at most " + with_commas(kMostCases) +
                       " seeds; give FIRST..LAST");
    for (std::uint64_t seed = first; seed <= last; ++seed) seeds.push_back(seed);
  }
  return seeds;
}

/// A file of the plan from anywhere; other words stay.
std::string from_anywhere(const std::string& word, const fs::path& folder, bool is_file) {
  return is_file ? fs::absolute(folder / word).lexically_normal().string() : word;
}

void set(Row& row, const std::string& key, const std::string& value, const std::string& place, const fs::path& folder) {
  if (value.empty()) throw InputError(place + ": " + key + " is empty; leave it out, or give a value");
  if (key == "config") {
    row.configs.clear();
    for (const std::string& config : words_of(value, '|')) {
      const std::size_t end = config.find(' ');
      row.configs.push_back(from_anywhere(config.substr(0, end), folder, config.substr(0, end).ends_with(".toml")) +
                            (end == std::string::npos ? "" : config.substr(end)));
    }
  } else if (key == "scenes") {
    for (const std::string& scene : words_of(value, '|'))
      row.scenes.push_back(from_anywhere(scene, folder, fs::exists(folder / scene)));
  } else if (key == "random") {
    row.random = number_of(value, place);
  } else if (key == "only") {
    std::vector<std::string> words;
    for (const std::string& word : words_of(value, ','))
      words.push_back(from_anywhere(word, folder, word.ends_with(".toml")));
    row.only = joined(words, ",");
  } else if (key == "seeds") {
    row.seeds = seeds_of(value, place);
  } else if (key == "stalls") {
    row.stalls = words_of(value, '|');
  } else if (key == "options") {
    row.options = words_of(value, ' ');
  } else if (key == "timeout") {
    row.timeout_s = parse_duration(value, place + ": timeout");
  } else {
    throw InputError(place + ": no key '" + key + "';" + did_you_mean(key, kKeys) + " give some of " + joined(kKeys));
  }
}

RegressCase case_of(const Row& row, const std::string& config, const std::string& scene, const std::string& stalls,
                    std::uint64_t seed) {
  RegressCase one{row.name, "", config, scene, scene.empty() ? row.random : 0, seed, {"cosim"}, row.timeout_s};
  const std::string stimulus = scene.empty() ? "random " + std::to_string(row.random) : scene;
  one.name = row.name + ": " + config + ", " + stimulus + (stalls == "0" ? "" : ", stalls " + stalls) + ", seed " +
             std::to_string(seed);
  auto& words = one.arguments;
  if (scene.empty()) {
    words.insert(words.end(), {"--random", std::to_string(row.random)});
    if (!row.only.empty()) words.insert(words.end(), {"--random-only", row.only});
  } else {
    words.push_back(scene);
  }
  const char* option = "--config";
  for (const std::string& word : words_of(config, ' ')) {
    words.insert(words.end(), {option, word});
    option = "--set";
  }
  if (stalls != "0") words.insert(words.end(), {"--stalls", stalls});
  words.insert(words.end(), {"--seed", std::to_string(seed)});
  words.insert(words.end(), row.options.begin(), row.options.end());
  return one;
}

}  // namespace

double parse_duration(const std::string& text, const std::string& option) {
  constexpr std::string_view kUnits = "smh";
  const std::size_t unit = text.empty() ? std::string_view::npos : kUnits.find(text.back());
  const auto value = unit == std::string_view::npos ? std::nullopt : as_number<double>(text.substr(0, text.size() - 1));
  if (!value || !(*value >= 0 && *value < 1e6))
    throw InputError(option + ": '" + text + "' is no time; give a number with s, m or h, as in 90s, 30m or 8h");
  return *value * (unit == 0 ? 1 : unit == 1 ? 60 : 3600);
}

std::vector<RegressCase> read_regress_plan(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  std::vector<Row> rows;
  for (const TomlWord& word : read_toml_words(path)) {
    const std::string place = path + ":" + std::to_string(word.line);
    const std::size_t dot = word.key.find('.');
    const std::string name = word.key.substr(0, dot);
    if (dot == std::string::npos && !word.value.empty())
      throw InputError(place + ": '" + name + "' stands in no row; begin with a table, as in [triangles]");
    auto row = std::ranges::find(rows, name, &Row::name);
    if (row == rows.end()) {
      rows.emplace_back();
      row = rows.end() - 1;
      row->name = name;
      row->place = place;
    }
    if (dot != std::string::npos) set(*row, word.key.substr(dot + 1), word.value, place, folder);
  }
  std::vector<std::pair<std::size_t, RegressCase>> cases;  // with the number of their seed
  for (const Row& row : rows) {
    auto scenes = row.scenes;
    if (row.random != 0) scenes.emplace_back();
    if (scenes.empty())
      throw InputError(row.place + ": the row '" + row.name + "' has nothing to run; give scenes, random, or both");
    if (!row.only.empty() && row.random == 0)
      throw InputError(row.place + ": the row '" + row.name + "' has no random scenes for `only`; give random");
    if (cases.size() + row.seeds.size() * row.configs.size() * scenes.size() * row.stalls.size() > kMostCases)
      throw InputError(path + ": more than " + with_commas(kMostCases) +
                       " cases; make each longer, with a larger random");
    for (std::size_t n = 0; n < row.seeds.size(); ++n)
      for (const std::string& config : row.configs)
        for (const std::string& scene : scenes)
          for (const std::string& stalls : row.stalls)
            cases.emplace_back(n, case_of(row, config, scene, stalls, row.seeds[n]));
  }
  if (cases.empty()) throw InputError(path + ": no rows; a row is a table, as in [triangles] with random = 20000");
  std::ranges::stable_sort(cases, {}, &std::pair<std::size_t, RegressCase>::first);
  std::vector<RegressCase> list;
  for (auto& one : cases) list.push_back(std::move(one.second));
  return list;
}

}  // namespace halfplane
