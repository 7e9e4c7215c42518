// A value in a JSON document with its path, so that every message names file and place.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halfplane {

/// Parses a whole text. Throws InputError "file:line: what; the mend" when it is not JSON.
[[nodiscard]] std::shared_ptr<const nlohmann::json> parse_json(std::string_view text, const std::string& file);

/// One value and its path from the root, as `nodes[3].mesh`. A view: document and file name must outlive it. Every read
/// that finds something of another kind throws InputError "file: path: what; the mend".
class JsonPlace {
 public:
  JsonPlace(const nlohmann::json& value, const std::string& file, std::string path = "")
      : value_(&value), file_(&file), path_(std::move(path)) {}

  /// A member of this object, or nothing.
  [[nodiscard]] std::optional<JsonPlace> find(std::string_view key) const;
  /// A member that must be there.
  [[nodiscard]] JsonPlace at(std::string_view key) const;
  /// The names of this object's members.
  [[nodiscard]] std::vector<std::string> keys() const;
  /// How many elements this array has.
  [[nodiscard]] std::size_t size() const;
  /// An element of this array; i < size().
  [[nodiscard]] JsonPlace operator[](std::size_t i) const;

  /// This value as a finite number.
  [[nodiscard]] double number() const;
  /// This value as a whole number of 0...most; 3.0 is one too.
  [[nodiscard]] std::uint64_t whole(std::uint64_t most) const;
  [[nodiscard]] bool is_text() const;
  /// This value as a string. It may hold any byte that JSON lets through.
  [[nodiscard]] std::string text() const;

  // The same for a member that may be left out.
  [[nodiscard]] double number_or(std::string_view key, double otherwise) const;
  [[nodiscard]] std::uint64_t whole_or(std::string_view key, std::uint64_t most, std::uint64_t otherwise) const;
  [[nodiscard]] std::string text_or(std::string_view key, const std::string& otherwise) const;
  [[nodiscard]] bool flag_or(std::string_view key, bool otherwise) const;

  /// This value as an index into a list of `count` things called `what` ("meshes").
  [[nodiscard]] std::size_t index(std::size_t count, std::string_view what) const;

  /// Throws InputError "file: path: what; mend".
  [[noreturn]] void fail(const std::string& what, const std::string& mend) const;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  void require_object() const;

  const nlohmann::json* value_;
  const std::string* file_;
  std::string path_;
};

}  // namespace halfplane
