// What the handles of halfplane.h are, and how a function keeps exceptions inside.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "halfplane.h"
#include "model/config.hpp"
#include "model/counters.hpp"
#include "model/scene.hpp"
#include "model/stages/framebuffer.hpp"

namespace halfplane::capi {

using CounterNames = std::map<std::string, std::uint64_t, std::less<>>;

/// What halfplane_last_error() says from now on; control characters become blanks.
void set_last_error(std::string_view text);

/// What `work` returns, or `failure`, when it throws; then halfplane_last_error() says why.
template <class Failure, class Work>
auto guarded(Failure failure, Work&& work) noexcept -> decltype(work()) {
  try {
    try {
      return std::forward<Work>(work)();
    } catch (const std::bad_alloc&) {
      set_last_error("there is not enough memory");
    } catch (const std::exception& error) {
      set_last_error(error.what());
    }
  } catch (...) {  // of the texts
  }
  return failure;
}

template <class T>
T& required(T* pointer, const char* what) {
  if (pointer == nullptr) throw InputError(std::string(what) + " is NULL");
  return *pointer;
}
inline std::string_view text(const char* word, const char* what) { return &required(word, what); }

[[nodiscard]] CounterNames named(const Counters& counters);
[[nodiscard]] std::int64_t counter(const CounterNames& counters, std::string_view name);

/// halfplane_frame_plane of a frame.
[[nodiscard]] std::int64_t copy_plane(const Framebuffer& frame, std::string_view plane, std::uint32_t* values,
                                      std::size_t count);

}  // namespace halfplane::capi

struct halfplane_config {
  halfplane::Config config;
};
struct halfplane_scene {
  halfplane::Scene scene;
  halfplane::State state{};  ///< of the next draw from arrays
};
struct halfplane_frame {
  halfplane::Framebuffer frame;
  halfplane::capi::CounterNames counters;
  std::map<std::string, std::vector<double>, std::less<>> reals;  ///< of the golden
};
