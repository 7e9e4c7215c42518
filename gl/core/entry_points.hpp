// The functions that programs call, by name.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace halfplane::gl {

/// The type of an entry point's parameter.
struct Parameter {
  bool is_pointer = false, is_const = false;
  // The number, or what the pointer points at; 0 bytes: no number.
  std::uint8_t bytes = 0;
  bool is_real = false, is_signed = false;
  bool operator==(const Parameter&) const = default;
};

struct EntryPoint {
  const void* function = nullptr;  ///< to be called with the type that GL/gl.h gives it
  std::span<const Parameter> parameters;
  /// Calls it with the bits of as many arguments.
  void (*call)(const void* function, const std::uint64_t* arguments) = nullptr;
};
using EntryPoints = std::map<std::string, EntryPoint, std::less<>>;

/// The commands of OpenGL 1.5 and OpenGL ES-CM 1.1, and their names in extensions. Without a current context each does nothing
/// and returns 0.
[[nodiscard]] const EntryPoints& entry_points();

/// The function of a name; null: none.
[[nodiscard]] const void* entry_point(std::string_view name);

}  // namespace halfplane::gl
