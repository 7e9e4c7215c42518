// Recorded calls as calls of the driver's entry points.
#pragma once

#include <cstddef>
#include <list>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "trace_file.hpp"

namespace halfplane::gl {

/// Arguments for a pointer whose memory the trace lacks.
enum class Addresses { none, null, offsets };

/// The arguments of a call in the types of its entry point. Their data is held here, followed by zeros up to `reach`
/// bytes: the bytes that the command may read however short the recorded memory is.
class Arguments {
 public:
  Arguments(std::span<const TraceValue> values, std::size_t reach, Addresses addresses)
      : values_(values), reach_(reach), addresses_(addresses) {}
  [[nodiscard]] std::size_t size() const { return values_.size(); }

  template <class T>
  [[nodiscard]] T get(std::size_t index) {
    const TraceValue& value = values_[index];
    if constexpr (std::is_floating_point_v<T>) {
      return static_cast<T>(value.real);
    } else if constexpr (std::is_pointer_v<T>) {
      using Item = std::remove_cv_t<std::remove_pointer_t<T>>;
      if constexpr (std::is_arithmetic_v<Item>) {
        if (value.kind == TraceValue::Kind::array) return static_cast<T>(numbers<Item>(value));
      }
      return static_cast<T>(memory(value));
    } else {
      return static_cast<T>(value.integer);
    }
  }

  /// Whether a pointer has come that the command must not get.
  [[nodiscard]] bool has_wild_pointer() const { return wild_; }
  /// Everything that arguments point at, to outlive them.
  [[nodiscard]] std::list<std::vector<std::byte>>& held() { return held_; }

 private:
  template <class Item>
  void* numbers(const TraceValue& value) {
    std::vector<std::byte>& bytes = hold(value.items.size() * sizeof(Item));
    auto* out = reinterpret_cast<Item*>(bytes.data());
    for (const TraceValue& item : value.items) {
      if constexpr (std::is_floating_point_v<Item>) {
        *out++ = static_cast<Item>(item.real);
      } else {
        *out++ = static_cast<Item>(item.integer);
      }
    }
    return bytes.data();
  }
  void* memory(const TraceValue& value);
  std::vector<std::byte>& hold(std::size_t size);

  std::span<const TraceValue> values_;
  std::size_t reach_;
  Addresses addresses_;
  bool wild_ = false;
  std::list<std::vector<std::byte>> held_;
};

/// Calls `entry`, which is the command `name` without its ARB or EXT; false: there is none, or it takes other arguments.
/// Not for commands that write to the program's memory: `reach` is the number of bytes they read.
bool call_entry(std::string_view name, const void* entry, Arguments& arguments);

}  // namespace halfplane::gl
