// Shared by the files of the GLX library: configurations, drawables, contexts, and how a call ends with an error. GLX objects
// live in the program alone, so errors are made here as the X server would send them.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <type_traits>

#include "../core/commands.hpp"
#include "../window/attributes.hpp"
#include "../window/window.hpp"

#include <GL/glx.h>
#include <GL/glxext.h>
#include <X11/Xlibint.h>
#include <glvnd/libglxabi.h>

#include <GL/glxproto.h>
#undef min
#undef max

namespace halfplane::gl::glx {

// Errors.

/// Thrown by calls; `code` from GLXBadContext on where `is_glx`, else that of the X protocol.
struct Error {
  int code;
  bool is_glx;
  XID resource;
};
[[noreturn]] inline void x_error(int code, XID resource = 0) { throw Error{code, false, resource}; }
[[noreturn]] inline void glx_error(int code, XID resource = 0) { throw Error{code, true, resource}; }

/// Sends an error of request `minor` to the program's handler.
void send(Display* display, const Error& error, int minor);

/// The GLX call that `Function` is, which may throw: its error is that of request `Minor`, and it returns `OnError`.
template <auto Function, int Minor, int OnError, class Result, class... Args>
Result guarded(Display* display, Args... args) {
  try {
    return Function(display, args...);
  } catch (const Error& error) {
    send(display, error, Minor);
  } catch (const std::exception&) {
    send(display, {BadAlloc, false, 0}, Minor);
  }
  if constexpr (std::is_integral_v<Result>)
    return static_cast<Result>(OnError);
  else
    return Result();
}
template <auto Function, int Minor, int OnError = 0, class Result, class... Args>
void* entry(Result (*)(Display*, Args...)) {
  return address(guarded<Function, Minor, OnError, Result, Args...>);
}
/// `{"glXName", entry<function, X_GLXRequest>()}` is a row of a table of functions.
template <auto Function, int Minor, int OnError = 0>
void* entry() {
  return entry<Function, Minor, OnError>(Function);
}

// Configurations (configs.cpp).

struct FbConfig {
  Server* server = nullptr;
  int screen = 0, id = 0;
  PixelFormat format;
  bool shares_visual = false;  ///< glXGetConfig() reports another configuration of the visual

  [[nodiscard]] GLXFBConfig handle() const { return reinterpret_cast<GLXFBConfig>(const_cast<FbConfig*>(this)); }
  [[nodiscard]] bool is_of_screen(const FbConfig& other) const {
    return server == other.server && screen == other.screen;
  }
};

/// Null: no server answers.
[[nodiscard]] Server* server_of(Display* display);
/// A screen's configurations in the order of glXChooseFBConfig(). Their addresses stay valid.
[[nodiscard]] const std::vector<FbConfig>& fb_configs(Display* display, int screen);
/// Throws GLXBadFBConfig.
[[nodiscard]] const FbConfig& config_of(Display* display, GLXFBConfig handle);
/// Throws BadValue.
[[nodiscard]] const FbConfig& config_of(Display* display, const XVisualInfo* visual);

// Drawables (drawables.cpp) and contexts (contexts.cpp).

struct GlxDrawable {
  GlxDrawable(DrawableKind kind, const FbConfig& its_config, XID xid, int width, int height)
      : window(kind, its_config.server, xid, its_config.format, width, height), config(&its_config) {}
  gl::Window window;
  const FbConfig* config;
  bool is_plain = false;  ///< an X window made current without glXCreateWindow
  bool preserved = true, largest = false;
};

struct GlxContext : Context {
  using Context::Context;
  Display* display = nullptr;
  const FbConfig* config = nullptr;
  bool is_current = false, is_destroyed = false;
  std::shared_ptr<GlxDrawable> draw, read;
};

struct Objects {
  std::mutex mutex;
  std::map<std::pair<Server*, XID>, std::shared_ptr<GlxDrawable>> drawables;
  std::set<GlxContext*> contexts;
};
[[nodiscard]] Objects& objects();

/// The context of this thread; null: none.
[[nodiscard]] GlxContext* here();
/// Null where it is none.
[[nodiscard]] std::shared_ptr<GlxDrawable> find_drawable(Display* display, XID id);
/// The drawable of `id` for a context; an X window that no call has named becomes one. Throws.
[[nodiscard]] std::shared_ptr<GlxDrawable> drawable_for(Display* display, XID id, const GlxContext& context);

// Functions, by name. Functions of extensions come first in their table: their place is their number with libglvnd.
[[nodiscard]] std::span<const Named> extension_functions();
[[nodiscard]] std::span<const Named> config_functions();
[[nodiscard]] std::span<const Named> drawable_functions();
[[nodiscard]] std::span<const Named> context_functions();

/// glXUseXFont (font.cpp).
void use_x_font(Font font, int first, int count, int list_base);

}  // namespace halfplane::gl::glx
