// Display lists, and how a command is issued: at once, into the list that is being compiled, or both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <new>
#include <tuple>
#include <type_traits>
#include <vector>

#include "context.hpp"

namespace halfplane::gl {

/// A row of calls in memory, each a function and its arguments. Arguments that own memory (images, tables) lie apart.
class DisplayList {
 public:
  template <auto Command, class... Args>
  void record(const Args&... args) {
    using Call = std::tuple<Args...>;
    if constexpr ((std::is_trivially_copyable_v<Args> && ...)) {
      static_assert(alignof(Call) <= kAlignment);
      void* at = add(
          [](Context& context, const void* call) {
            std::apply([&](const Args&... a) { Command(context, a...); }, *static_cast<const Call*>(call));
          },
          sizeof(Call));
      new (at) Call(args...);
    } else {
      owned_.push_back([call = Call(args...)](Context& context) {
        std::apply([&](const Args&... a) { Command(context, a...); }, call);
      });
      add(nullptr, 0);  // the next one of owned_
    }
  }
  void play(Context& context) const;

 private:
  static constexpr std::size_t kAlignment = 16;
  using Play = void (*)(Context&, const void*);
  struct alignas(kAlignment) Header {
    Play play;            ///< null: the next one of owned_
    std::uint64_t bytes;  ///< of the arguments that follow it, a multiple of kAlignment
  };
  /// The place of the arguments. Valid until the next call.
  void* add(Play play, std::size_t bytes);

  std::vector<std::byte> calls_;
  std::vector<std::function<void(Context&)>> owned_;
};

/// Whether a command is refused or allowed between glBegin and glEnd.
enum class InsideBegin { refused, allowed };

template <auto Command, InsideBegin Inside, class... Args>
void run(Context& context, const Args&... args) {
  if constexpr (Inside == InsideBegin::refused) {
    if (context.inside_begin()) return context.fail(GL_INVALID_OPERATION);
    ++context.revision;
  }
  Command(context, args...);
}

/// Entry of commands that go into display lists.
template <auto Command, InsideBegin Inside = InsideBegin::refused, class... Args>
void issue(Context& context, const Args&... args) {
  if (context.compiling != nullptr) {
    context.compiling->record<&run<Command, Inside, Args...>>(args...);
    if (!context.compiles_and_executes) return;
  }
  run<Command, Inside>(context, args...);
}

}  // namespace halfplane::gl
