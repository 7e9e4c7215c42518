// Options of the form `eye=0,1,3;fov=45`: shared by --camera and --light.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "model/config.hpp"
#include "sim/scene/mesh.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {

/// Reads the values of one option; errors name the option.
struct OptionParts {
  std::string_view option;   ///< "--camera"
  std::string_view example;  ///< "write for example --camera ..."

  [[noreturn]] void fail(const std::string& what, std::string_view mend) const {
    throw InputError(std::string(option) + ": " + what + "; " + std::string(mend));
  }

  static std::string_view trimmed(std::string_view text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
  }

  /// Cuts the first part off `text`, up to `separator` or the end.
  static std::string_view cut(std::string_view& text, char separator) {
    const std::size_t end = text.find(separator);
    const std::string_view part = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    return trimmed(part);
  }

  [[nodiscard]] double number(std::string_view key, std::string_view word) const {
    const std::optional<double> value = parse_number(trimmed(word));
    if (!value) fail(std::string(key) + "=" + printable(word) + " is not a finite number", example);
    if (std::abs(*value) > kLargestCoordinate) fail(std::string(key) + " is beyond +-1e30", "choose a smaller number");
    return *value;
  }

  [[nodiscard]] Vec3 vector(std::string_view key, std::string_view text) const {
    if (std::count(text.begin(), text.end(), ',') != 2) {
      fail(std::string(key) + "=" + printable(text) + " is not three numbers", "write " + std::string(key) + "=X,Y,Z");
    }
    Vec3 result{};
    for (double& component : result) component = number(key, cut(text, ','));
    return result;
  }

  [[nodiscard]] double positive(std::string_view key, std::string_view text) const {
    const double value = number(key, text);
    if (!(value > 0)) fail(std::string(key) + "=" + printable(text) + " is not above 0", "choose a positive number");
    return value;
  }
};

}  // namespace halfplane
