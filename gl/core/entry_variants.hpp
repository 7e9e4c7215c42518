// Entry points of one command that differ in the type of their components and in how these are passed: glVertex2d, glVertex2dv,
// glVertex2f, ...
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "entry_conversions.hpp"

namespace halfplane::gl {

using EntryPoints = std::map<std::string, const void*, std::less<>>;

/// The address of a lambda without captures, with the calling convention of C.
template <class Lambda>
const void* function(Lambda lambda) {
  return reinterpret_cast<const void*>(+lambda);
}

/// A type's letters in names of entry points.
template <class T>
constexpr std::string_view letters_of() {
  if (std::is_floating_point_v<T>) return sizeof(T) == sizeof(GLdouble) ? "d" : "f";
  constexpr std::array<std::string_view, 3> kNames{"ub", "us", "ui"};
  return kNames[sizeof(T) / 2].substr(std::is_signed_v<T> ? 1 : 0);
}

enum class Components { real, normalized };
/// What a command takes before its components: nothing, GL_TEXTURE0, or a value that the program gives.
enum class Before { nothing, first_unit, given };

template <class... Args>
constexpr std::size_t doubles_of(void (*)(Context&, Args...)) {
  return (std::size_t{std::is_same_v<Args, double>} + ...);
}

/// Issues a command; its components that are not given are 0, the fourth 1.
template <auto Command, InsideBegin kInside, Components kComponents, class T, std::size_t kGiven, class... First>
void enter_components(const std::array<T, kGiven>& given, First... first) {
  const auto component = [&given](std::size_t i) {
    if (i >= kGiven) return i == 3 ? 1.0 : 0.0;
    return kComponents == Components::normalized ? norm(given[i]) : real(given[i]);
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    with_context([&](Context& context) { issue<Command, kInside>(context, first..., component(I)...); });
  }
  (std::make_index_sequence<doubles_of(Command)>());
}

template <class T, std::size_t>
using Each = T;

/// Adds both variants of each type: `name` with its letters, and with v.
template <auto Command, InsideBegin kInside, Components kComponents, Before kBefore, std::size_t kGiven, class... T>
void add_variants(EntryPoints& to, const std::string& name) {
  const auto of_type = [&]<class Type, std::size_t... I>(std::index_sequence<I...>) {
    const std::string letters = name + std::string(letters_of<Type>());
    if constexpr (kBefore == Before::nothing) {
      constexpr auto enter = &enter_components<Command, kInside, kComponents, Type, kGiven>;
      to[letters] = function([](Each<Type, I>... v) { enter({v...}); });
      to[letters + "v"] = function([](const Type* v) { enter({v[I]...}); });
    } else {
      constexpr auto enter = &enter_components<Command, kInside, kComponents, Type, kGiven, GLenum>;
      if constexpr (kBefore == Before::given) {
        to[letters] = function([](GLenum first, Each<Type, I>... v) { enter({v...}, first); });
        to[letters + "v"] = function([](GLenum first, const Type* v) { enter({v[I]...}, first); });
      } else {
        to[letters] = function([](Each<Type, I>... v) { enter({v...}, GL_TEXTURE0); });
        to[letters + "v"] = function([](const Type* v) { enter({v[I]...}, GL_TEXTURE0); });
      }
    }
  };
  (of_type.template operator()<T>(std::make_index_sequence<kGiven>()), ...);
}

}  // namespace halfplane::gl
