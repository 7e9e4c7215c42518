#include "calls.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace halfplane::gl {
namespace {

/// Writes a number as an entry point takes it, or reads it from memory; bytes lie from the lowest on.
void put(const TraceValue& value, const Parameter& type, void* to) {
  const auto single = static_cast<float>(value.real);
  const void* const from = !type.is_real                 ? static_cast<const void*>(&value.integer)
                           : type.bytes == sizeof single ? static_cast<const void*>(&single)
                                                         : &value.real;
  std::memcpy(to, from, type.bytes);
}

/// The memory that a pointer's argument holds.
std::vector<std::byte> memory_of(const TraceValue& value, const Parameter& type, std::size_t reach) {
  const bool is_array = value.kind == TraceValue::Kind::array;
  const std::size_t size = is_array ? value.items.size() * type.bytes : value.bytes.size();
  std::vector<std::byte> memory(std::max(size + 1, reach));  // a string ends in 0
  std::byte* to = memory.data();
  if (!is_array) std::memcpy(to, value.bytes.data(), size);
  for (const TraceValue& item : value.items) {
    put(item, type, to);
    to += type.bytes;
  }
  return memory;
}

}  // namespace

bool call_entry(const EntryPoint& entry, const std::vector<TraceValue>& values, std::size_t reach, Addresses addresses,
                HeldMemory& held) {
  std::array<std::uint64_t, 16> arguments{};
  if (values.size() != entry.parameters.size() || values.size() > arguments.size()) return false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const TraceValue& value = values[i];
    const Parameter& type = entry.parameters[i];
    const bool has_memory =
        value.kind == TraceValue::Kind::bytes || (value.kind == TraceValue::Kind::array && type.bytes != 0);
    if (!type.is_pointer) {
      put(value, type, &arguments[i]);
    } else if (has_memory) {
      arguments[i] = reinterpret_cast<std::uintptr_t>(held.emplace_back(memory_of(value, type, reach)).data());
    } else {
      const bool is_null = value.kind == TraceValue::Kind::null;
      if (addresses == Addresses::none || (!is_null && addresses != Addresses::offsets)) return false;
      arguments[i] = static_cast<std::uint64_t>(value.integer);
    }
  }
  entry.call(entry.function, arguments.data());
  return true;
}

}  // namespace halfplane::gl
