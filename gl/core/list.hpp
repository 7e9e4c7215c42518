// Display lists, and how a command is issued: at once, into the list that is being compiled, or both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <new>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <vector>

#include "commands.hpp"
#include "context.hpp"

namespace halfplane::gl {

/// What a call is for DisplayList::join_vertices().
enum class CallKind : std::uint32_t { other, begin, end, vertex_or_attribute, joined };
template <auto Command, auto... These>
inline constexpr bool kIsOneOf = (std::is_same_v<std::integral_constant<decltype(Command), Command>,
                                                 std::integral_constant<decltype(These), These>> ||
                                  ...);
template <auto Command>
inline constexpr CallKind kCallKind =
    kIsOneOf<Command, &begin> ? CallKind::begin
    : kIsOneOf<Command, &end> ? CallKind::end
    : kIsOneOf<Command, &vertex, &normal, &color, &secondary_color, &tex_coord, &fog_coord, &edge_flag>
        ? CallKind::vertex_or_attribute
        : CallKind::other;

/// A row of calls in memory, each a function and its arguments. Arguments that own memory (images, tables) lie apart.
class DisplayList {
 public:
  template <auto Command, class... Args>
  void record(CallKind kind, const Args&... args) {
    using Call = std::tuple<Args...>;
    if constexpr ((std::is_trivially_copyable_v<Args> && ...)) {
      static_assert(alignof(Call) <= kAlignment);
      void* at = add(
          [](Context& context, const void* call) {
            std::apply([&](const Args&... a) { Command(context, a...); }, *static_cast<const Call*>(call));
          },
          sizeof(Call), kind);
      new (at) Call(args...);
    } else {
      owned_.push_back([call = Call(args...)](Context& context) {
        std::apply([&](const Args&... a) { Command(context, a...); }, call);
      });
      add(nullptr, 0, kind);  // the next one of owned_
    }
  }
  /// Draws vertices[indices[0]], vertices[indices[1]], ... when it is played outside glBegin and glEnd.
  void add_vertices(GLenum mode, const InputVertices& vertices, std::span<const std::uint32_t> indices);
  void play(Context& context) const;
  /// Keeps the vertices between a glBegin and a glEnd as InputVertices, which are drawn at once where the calls would be
  /// played. The calls stay for lists that are called within a primitive. To be called when the list is complete.
  void join_vertices();

 private:
  static constexpr std::size_t kAlignment = 16;
  using Play = void (*)(Context&, const void*);
  struct alignas(kAlignment) Header {
    Play play;            ///< null: the next one of owned_
    std::uint32_t bytes;  ///< of the arguments that follow it, a multiple of kAlignment
    CallKind kind;
  };
  /// Arguments of CallKind::joined, before the calls that it stands for.
  struct alignas(kAlignment) JoinedCall {
    std::size_t which;  ///< of joined_
    std::size_t bytes;  ///< of the calls
  };
  struct JoinedVertices {
    GLenum mode;
    InputVertices vertices;
    std::vector<std::uint32_t> indices;
  };
  /// The place of the arguments. Valid until the next call.
  void* add(Play play, std::size_t bytes, CallKind kind);
  /// Collects the vertices of the glBegin at a place in `collector`. The place after its glEnd; none: there are other calls
  /// between them, or an attribute that the first vertex takes from outside.
  [[nodiscard]] std::optional<std::size_t> end_of_vertices(std::size_t at, Context& collector) const;
  [[nodiscard]] const Header& header(std::size_t at) const { return *reinterpret_cast<const Header*>(&calls_[at]); }
  [[nodiscard]] std::size_t after(std::size_t at) const { return at + sizeof(Header) + header(at).bytes; }

  std::vector<std::byte> calls_;
  std::vector<std::function<void(Context&)>> owned_;
  std::vector<JoinedVertices> joined_;
};

/// Commands that are allowed between glBegin and glEnd (OpenGL 1.5, 2.6.3). A draw of arrays refuses itself when it is carried
/// out: a list may hold it there.
template <auto Command>
inline constexpr bool kIsAllowedInside =
    kCallKind<Command> != CallKind::other ||
    kIsOneOf<Command, &index, &material, &eval_coord1, &eval_coord2, &eval_point1, &eval_point2, &call_list,
             &call_lists, &array_element, &draw_arrays, &draw_elements, &draw_range_elements, &multi_draw_arrays,
             &multi_draw_elements>;

template <auto Command, class... Args>
void run(Context& context, const Args&... args) {
  if constexpr (!kIsAllowedInside<Command>) {
    if (context.inside_begin()) return context.fail(GL_INVALID_OPERATION);
    ++context.revision;
  }
  Command(context, args...);
}

template <auto Command, class... Args>
void issue_as(void (*)(Context&, Args...), Context& context, const std::type_identity_t<Args>&... args) {
  if (context.compiling != nullptr) {
    context.compiling->record<&run<Command, std::remove_cvref_t<Args>...>>(kCallKind<Command>, args...);
    if (!context.compiles_and_executes) return;
  }
  run<Command>(context, args...);
}
/// Entry of commands that go into display lists.
template <auto Command, class... Args>
void issue(Context& context, const Args&... args) {
  issue_as<Command>(Command, context, args...);
}

}  // namespace halfplane::gl
