// Shared by the files of the EGL library: displays, surfaces, contexts, and how a call ends with an error.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <type_traits>

#include "../core/commands.hpp"
#include "../window/attributes.hpp"
#include "../window/window.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <X11/Xlib.h>

namespace halfplane::gl::egl {

struct EglConfig {
  EGLint id = 0;
  PixelFormat format;
  [[nodiscard]] bool has_visual() const { return format.visual.visualid != 0; }
};

struct Surface {
  Surface(DrawableKind kind, Server* server, XID xid, const EglConfig& its_config, bool single, int width, int height)
      : window(kind, server, xid, {its_config.format.visual, !single}, width, height), config(&its_config) {}
  gl::Window window;
  const EglConfig* config;
  std::thread::id bound_to{};  ///< the thread where it is current
  EGLint texture_format = EGL_NO_TEXTURE, mipmap_texture = EGL_FALSE;
  bool is_bound_to_texture = false;
  EGLint largest = EGL_FALSE, mipmap_level = 0, swap_behavior = EGL_BUFFER_PRESERVED;
};

struct EglContext : Context {
  using Context::Context;
  EGLenum api = EGL_OPENGL_ES_API;
  const EglConfig* config = nullptr;  ///< null: EGL_NO_CONFIG_KHR
  std::thread::id bound_to{};
  std::shared_ptr<Surface> draw, read;
};

struct EglDisplay {
  Server* server = nullptr;  ///< null: surfaceless
  Display* native = nullptr;
  int screen = 0;
  bool initialized = false;
  std::vector<EglConfig> configs;
  std::map<void*, std::shared_ptr<Surface>> surfaces;
  std::map<void*, std::shared_ptr<EglContext>> contexts;
  std::map<void*, std::unique_ptr<char>> syncs;

  void flush() const {  // the driver's own connection is to know the program's windows
    if (native != nullptr) XSync(native, 0);
  }
};

struct ThreadState {
  EGLint error = EGL_SUCCESS;
  EGLenum api = EGL_OPENGL_ES_API;
  std::shared_ptr<EglContext> context;
  ~ThreadState();
  void unbind();
};
inline thread_local ThreadState t_state;

/// The lock of displays and their objects: held through every call that reads them.
[[nodiscard]] std::recursive_mutex& mutex();
/// The displays, by native display, or its substitute, and screen.
[[nodiscard]] std::map<std::pair<void*, int>, std::unique_ptr<EglDisplay>>& displays();

// Calls throw the error that they end with.

struct Error {
  EGLint code;
};
inline void require(bool holds, EGLint code) {
  if (!holds) throw Error{code};
}

/// The EGL call that `Function` is. One of no result gives EGL_TRUE; an error gives EGL_FALSE or null.
template <auto Function, class Result, class... Args>
auto guarded(Args... args) -> std::conditional_t<std::is_void_v<Result>, EGLBoolean, Result> {
  try {
    t_state.error = EGL_SUCCESS;
    if constexpr (std::is_void_v<Result>) {
      Function(args...);
      return EGL_TRUE;
    } else {
      return Function(args...);
    }
  } catch (const Error& error) {
    t_state.error = error.code;
  } catch (const std::exception&) {
    t_state.error = EGL_BAD_ALLOC;
  }
  return {};
}
template <auto Function, class Result, class... Args>
void* entry(Result (*)(Args...)) {
  return address(guarded<Function, Result, Args...>);
}
/// `{"eglName", entry<function>()}` is a row of a table of functions.
template <auto Function>
void* entry() {
  return entry<Function>(Function);
}

/// Throws `error` where it is none.
template <class Object>
[[nodiscard]] std::shared_ptr<Object> find(const std::map<void*, std::shared_ptr<Object>>& objects, void* handle,
                                           EGLint error) {
  const auto found = objects.find(handle);
  require(found != objects.end(), error);
  return found->second;
}

/// The objects of a call, locked. Its functions throw the error of an invalid handle.
struct Call {
  std::unique_lock<std::recursive_mutex> lock{mutex()};
  EglDisplay& display;

  explicit Call(EGLDisplay handle, bool must_be_initialized = true);
  [[nodiscard]] const EglConfig& config(EGLConfig handle) const;
  [[nodiscard]] std::shared_ptr<Surface> surface(EGLSurface handle) const {
    return find(display.surfaces, handle, EGL_BAD_SURFACE);
  }
  [[nodiscard]] std::shared_ptr<EglContext> context(EGLContext handle) const {
    return find(display.contexts, handle, EGL_BAD_CONTEXT);
  }
};

/// Display, surface and context calls, by name (displays.cpp, surfaces.cpp, contexts.cpp).
[[nodiscard]] std::span<const Named> display_functions();
[[nodiscard]] std::span<const Named> surface_functions();
[[nodiscard]] std::span<const Named> context_functions();
/// libglvnd's eglGetPlatformDisplay.
[[nodiscard]] EGLDisplay get_platform_display(EGLenum platform, void* native, const EGLAttrib* list);

}  // namespace halfplane::gl::egl
