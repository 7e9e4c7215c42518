#include "sim/scene/json_place.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "model/config.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {

// The parser of nlohmann-json keeps its own stack, so depth of nesting is no danger.
std::shared_ptr<const nlohmann::json> parse_json(std::string_view text, const std::string& file) {
  try {
    return std::make_shared<const nlohmann::json>(nlohmann::json::parse(text.begin(), text.end()));
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t read = std::min<std::size_t>(error.byte, text.size());
    const auto lines = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(read), '\n');
    fail_at(file, static_cast<std::uint32_t>(lines + 1), "not JSON (at byte " + std::to_string(read) + ")",
            "export the file again, or mend the text there");
  } catch (const nlohmann::json::exception&) {  // the only other one: a number such as 1e999
    throw InputError(file + ":1: a number beyond binary64; correct it");
  }
}

void JsonPlace::require_object() const {
  if (!value_->is_object()) fail("not an object", "write {...} there");
}

std::optional<JsonPlace> JsonPlace::find(std::string_view key) const {
  require_object();
  const auto found = value_->find(std::string(key));
  if (found == value_->end()) return std::nullopt;
  return JsonPlace(*found, *file_, (path_.empty() ? "" : path_ + ".") + std::string(key));
}

JsonPlace JsonPlace::at(std::string_view key) const {
  std::optional<JsonPlace> found = find(key);
  if (!found) fail("no " + std::string(key), "add it, or export the file again");
  return *found;
}

std::vector<std::string> JsonPlace::keys() const {
  require_object();
  std::vector<std::string> names;
  for (const auto& [name, member] : value_->items()) names.push_back(name);
  return names;
}

std::size_t JsonPlace::size() const {
  if (!value_->is_array()) fail("not a list", "write [...] there");
  return value_->size();
}

JsonPlace JsonPlace::operator[](std::size_t i) const {
  return {value_->at(i), *file_, path_ + "[" + std::to_string(i) + "]"};
}

double JsonPlace::number() const {
  if (!value_->is_number()) fail("not a number", "write one there");
  return value_->get<double>();  // finite: the parser refuses what is not
}

std::uint64_t JsonPlace::whole(std::uint64_t most) const {
  const double value = number();
  // 2^53 bounds what a double tells apart; every `most` of ours is below it.
  const bool fits = value >= 0 && value <= 0x1p53 && value == std::floor(value);
  if (!fits || static_cast<std::uint64_t>(value) > most) {
    fail("not a whole number of 0..." + std::to_string(most), "correct it, or export the file again");
  }
  return static_cast<std::uint64_t>(value);
}

bool JsonPlace::is_text() const { return value_->is_string(); }

std::string JsonPlace::text() const {
  if (!is_text()) fail("not a string", "write \"...\" there");
  return value_->get<std::string>();
}

double JsonPlace::number_or(std::string_view key, double otherwise) const {
  const std::optional<JsonPlace> found = find(key);
  return found ? found->number() : otherwise;
}

std::uint64_t JsonPlace::whole_or(std::string_view key, std::uint64_t most, std::uint64_t otherwise) const {
  const std::optional<JsonPlace> found = find(key);
  return found ? found->whole(most) : otherwise;
}

std::string JsonPlace::text_or(std::string_view key, const std::string& otherwise) const {
  const std::optional<JsonPlace> found = find(key);
  return found ? found->text() : otherwise;
}

bool JsonPlace::flag_or(std::string_view key, bool otherwise) const {
  const std::optional<JsonPlace> found = find(key);
  if (!found) return otherwise;
  if (!found->value_->is_boolean()) found->fail("neither true nor false", "write one of them");
  return found->value_->get<bool>();
}

std::size_t JsonPlace::index(std::size_t count, std::string_view what) const {
  const std::uint64_t value = whole(0xffffffff);
  if (value >= count) {
    fail("index " + std::to_string(value) + " of " + std::to_string(count) + " " + std::string(what),
         "correct it, or export the file again");
  }
  return static_cast<std::size_t>(value);
}

void JsonPlace::fail(const std::string& what, const std::string& mend) const {
  // Keys come from us, but for the names in `attributes`: printable() keeps it at one line.
  throw InputError(*file_ + ": " + (path_.empty() ? "" : printable(path_) + ": ") + what + "; " + mend);
}

}  // namespace halfplane
