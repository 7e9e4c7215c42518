#include "calls.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <tuple>
#include <utility>

namespace halfplane::gl {
namespace {

using Caller = bool (*)(const void* entry, Arguments& arguments);

template <class Function>
struct Typed;
template <class R, class... A>
struct Typed<R(A...)> {
  static bool call(const void* entry, Arguments& arguments) {
    if (arguments.size() != sizeof...(A)) return false;
    const auto function = reinterpret_cast<R (*)(A...)>(const_cast<void*>(entry));
    const auto typed = [&]<std::size_t... I>(std::index_sequence<I...>) {
      return std::tuple<A...>{arguments.get<A>(I)...};
    }
    (std::index_sequence_for<A...>());
    if (arguments.has_wild_pointer()) return false;
    std::apply(function, typed);
    return true;
  }
};

struct Row {
  std::string_view name;
  Caller caller;
};

constexpr Row kCalls[]{
#define HALFPLANE_ENTRY(name) Row{#name, &Typed<decltype(::name)>::call},
#include "../core/entry_names.inc"
#undef HALFPLANE_ENTRY
};

}  // namespace

void* Arguments::memory(const TraceValue& value) {
  if (value.kind != TraceValue::Kind::bytes) {
    const bool is_null = value.kind == TraceValue::Kind::null;
    wild_ = wild_ || addresses_ == Addresses::none || (!is_null && addresses_ != Addresses::offsets);
    return reinterpret_cast<void*>(value.integer);
  }
  std::vector<std::byte>& bytes = hold(value.bytes.size());
  std::memcpy(bytes.data(), value.bytes.data(), value.bytes.size());
  return bytes.data();
}

std::vector<std::byte>& Arguments::hold(std::size_t size) {
  return held_.emplace_back(std::max(size + 1, reach_));  // a string ends in 0
}

bool call_entry(std::string_view name, const void* entry, Arguments& arguments) {
  const auto row = std::lower_bound(std::begin(kCalls), std::end(kCalls), name,
                                    [](const Row& a, std::string_view b) { return a.name < b; });
  return row != std::end(kCalls) && row->name == name && row->caller(entry, arguments);
}

}  // namespace halfplane::gl
