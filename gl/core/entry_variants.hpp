// Entry points from commands: C functions by the types that GL/gl.h gives them, and the variants of one command that differ in
// the type of their numbers and in how these are passed (glVertex2d, glVertex2dv, glVertex2f, ...).
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

#include "entry_conversions.hpp"
#include "entry_points.hpp"

namespace halfplane::gl {

template <class T>
constexpr Parameter parameter_of() {
  using Item = std::remove_pointer_t<T>;
  Parameter parameter{.is_pointer = std::is_pointer_v<T>, .is_const = std::is_const_v<Item>};
  if constexpr (std::is_arithmetic_v<Item>) {
    parameter.bytes = sizeof(Item);
    parameter.is_real = std::is_floating_point_v<Item>;
    parameter.is_signed = std::is_signed_v<Item>;
  }
  return parameter;
}

/// Entry points of a type.
template <class Type>
struct Entry;
template <class R, class... A>
struct Entry<R(A...)> {
  static constexpr std::array<Parameter, sizeof...(A)> kParameters{parameter_of<A>()...};

  static void call(const void* function, [[maybe_unused]] const std::uint64_t* arguments) {
    const auto of_bits = [](std::uint64_t bits, auto value) {
      std::memcpy(&value, &bits, sizeof value);
      return value;
    };
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      reinterpret_cast<R (*)(A...)>(const_cast<void*>(function))(of_bits(arguments[I], A())...);
    }
    (std::index_sequence_for<A...>());
  }

  /// The one that does what a lambda without captures does.
  template <class Body>
  static EntryPoint of(Body) {
    R (*const function)(A...) = [](A... args) -> R { return Body()(args...); };
    return {reinterpret_cast<const void*>(function), kParameters, call};
  }
};

/// A type's letters in names of entry points.
template <class T>
constexpr std::string_view letters_of() {
  if (std::is_same_v<T, Fixed>) return "x";
  if (std::is_floating_point_v<T>) return std::is_same_v<T, GLdouble> ? "d" : "f";
  constexpr std::array<std::string_view, 3> kNames{"ub", "us", "ui"};
  return kNames[sizeof(Raw<T>) / 2].substr(std::is_signed_v<T> ? 1 : 0);
}

template <class T, std::size_t>
using Each = T;

/// Adds a variant of a command for each type that its doubles have: `name` with the type's letters.
template <auto Command, class... T>
void add_numbers(EntryPoints& to, const std::string& name) {
  const auto add = [&]<class Number, class... P>(void (*)(Context&, P...)) {
    to[name + std::string(letters_of<Number>())] = Entry<void(Given<P, Number>...)>::of(
        [](Given<P, Number>... given) { listed<Command>(read<P, Number>(given)...); });
  };
  (add.template operator()<T>(Command), ...);
}

enum class Components { plain, normalized };
/// What a command takes before its components: nothing, GL_TEXTURE0, or a value that the program gives.
enum class Before { nothing, first_unit, given };

template <class... P>
constexpr std::size_t doubles_of(void (*)(Context&, P...)) {
  return (std::size_t{std::is_same_v<P, double>} + ...);
}

/// Issues a command; its components that are not given are 0, the fourth 1.
template <auto Command, Components kComponents, class T, std::size_t kGiven, class... First>
void enter_components(const std::array<Raw<T>, kGiven>& given, First... first) {
  const auto component = [&given](std::size_t i) {
    if (i >= kGiven) return i == 3 ? 1.0 : 0.0;
    return kComponents == Components::normalized ? norm(given[i]) : read<double, T>(given[i]);
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) { listed<Command>(first..., component(I)...); }
  (std::make_index_sequence<doubles_of(Command)>());
}

/// Adds both variants of each type, with each suffix: `name` with the type's letters, and with v.
template <auto Command, Components kComponents, Before kBefore, std::size_t kGiven, class... T>
void add_variants(EntryPoints& to, const std::string& name, std::initializer_list<const char*> suffixes = {""}) {
  const auto of_type = [&]<class Number, std::size_t... I>(std::index_sequence<I...>) {
    using C = Raw<Number>;
    const auto add = [&](EntryPoint each, EntryPoint vector) {
      for (const std::string suffix : suffixes) {
        const std::string letters = name + std::string(letters_of<Number>());
        to[letters + suffix] = each;
        to[letters + "v" + suffix] = vector;
      }
    };
    if constexpr (kBefore == Before::given) {
      constexpr auto enter = &enter_components<Command, kComponents, Number, kGiven, GLenum>;
      add(Entry<void(GLenum, Each<C, I>...)>::of([](GLenum first, Each<C, I>... v) { enter({v...}, first); }),
          Entry<void(GLenum, const C*)>::of([](GLenum first, const C* v) { enter({v[I]...}, first); }));
    } else if constexpr (kBefore == Before::first_unit) {
      constexpr auto enter = &enter_components<Command, kComponents, Number, kGiven, GLenum>;
      add(Entry<void(Each<C, I>...)>::of([](Each<C, I>... v) { enter({v...}, GL_TEXTURE0); }),
          Entry<void(const C*)>::of([](const C* v) { enter({v[I]...}, GL_TEXTURE0); }));
    } else {
      constexpr auto enter = &enter_components<Command, kComponents, Number, kGiven>;
      add(Entry<void(Each<C, I>...)>::of([](Each<C, I>... v) { enter({v...}); }),
          Entry<void(const C*)>::of([](const C* v) { enter({v[I]...}); }));
    }
  };
  (of_type.template operator()<T>(std::make_index_sequence<kGiven>()), ...);
}

constexpr GLenum last_of(GLenum name) { return name; }
constexpr GLenum last_of(GLenum, GLenum name) { return name; }

/// Adds both variants of each type of a command with Params after one or two enums, of which the last one names them.
template <auto Command, class T, class... Enum>
void add_parameters_of(EntryPoints& to, const std::string& letters, void (*)(Context&, Enum...)) {
  to[letters] = Entry<void(Enum..., Raw<T>)>::of([](Enum... enums, Raw<T> value) {
    listed<Command>(enums..., params_of<T>(last_of(enums...), {&value, 1}, false));
  });
  to[letters + "v"] = Entry<void(Enum..., const Raw<T>*)>::of([](Enum... enums, const Raw<T>* values) {
    const GLenum pname = last_of(enums...);
    listed<Command>(enums..., params_of<T>(pname, {values, param_count(pname)}, true));
  });
}
template <auto Command, class... T>
void add_parameters(EntryPoints& to, const std::string& name) {
  constexpr bool has_target = std::is_same_v<decltype(Command), void (*)(Context&, GLenum, GLenum, Params)>;
  using Enums = std::conditional_t<has_target, void(Context&, GLenum, GLenum), void(Context&, GLenum)>;
  const auto add = [&]<class Number>() {
    add_parameters_of<Command, Number>(to, name + std::string(letters_of<Number>()), static_cast<Enums*>(nullptr));
  };
  (add.template operator()<T>(), ...);
}

/// Adds a variant of each type of a query.
template <auto Query, class... T>
void add_queries(EntryPoints& to, const std::string& name) {
  const auto add = [&]<class Number, class... P>(Values (*)(Context&, P...)) {
    to[name + std::string(letters_of<Number>()) + "v"] =
        Entry<void(P..., Raw<Number>*)>::of([](P... args, Raw<Number>* values) {
          outside_begin([&](Context& context) { store<Number>(Query(context, args...), values); });
        });
  };
  (add.template operator()<T>(Query), ...);
}

/// Adds a variant of each type of a command with a matrix.
template <auto Command, class... T>
void add_matrices(EntryPoints& to, const std::string& name) {
  ((to[name + std::string(letters_of<T>())] =
        Entry<void(const Raw<T>*)>::of([](const Raw<T>* m) { listed<Command>(read_all<16, T>(m)); })),
   ...);
}

}  // namespace halfplane::gl
