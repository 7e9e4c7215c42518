// The vendor library that libglvnd loads for EGL 1.5. libEGL keeps what is current in each thread and which library a display
// belongs to; the rest is here. Platforms: X11, and surfaceless with pbuffers alone.
#include <algorithm>
#include <array>
#include <climits>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string_view>
#include <thread>
#include <utility>

#include "../core/commands.hpp"
#include "../core/entry_points.hpp"
#include "../window/config_attribute.hpp"
#include "../window/window.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <glvnd/libeglabi.h>

namespace halfplane::gl {
namespace {

// Configurations.

struct EglConfig {
  EGLint id = 0;
  PixelFormat format;
  [[nodiscard]] bool has_visual() const { return format.visual.visualid != 0; }
};

template <EGLint N>
EGLint constant(const EglConfig&) {
  return N;
}

constexpr EGLint kApis = EGL_OPENGL_BIT | EGL_OPENGL_ES_BIT;
/// EGL 1.5, table 3.1, with how eglChooseConfig() compares and what it takes where the program does not say (table 3.4).
constexpr ConfigAttribute<EglConfig> kAttributes[] = {
    {EGL_BUFFER_SIZE, Rule::at_least, 0, constant<4 * kColorBits>},
    {EGL_RED_SIZE, Rule::at_least, 0, constant<kColorBits>},
    {EGL_GREEN_SIZE, Rule::at_least, 0, constant<kColorBits>},
    {EGL_BLUE_SIZE, Rule::at_least, 0, constant<kColorBits>},
    {EGL_LUMINANCE_SIZE, Rule::at_least, 0, constant<0>},
    {EGL_ALPHA_SIZE, Rule::at_least, 0, constant<kColorBits>},
    {EGL_ALPHA_MASK_SIZE, Rule::at_least, 0, constant<0>},
    {EGL_BIND_TO_TEXTURE_RGB, Rule::exact, EGL_DONT_CARE, constant<EGL_TRUE>},
    {EGL_BIND_TO_TEXTURE_RGBA, Rule::exact, EGL_DONT_CARE, constant<EGL_TRUE>},
    {EGL_COLOR_BUFFER_TYPE, Rule::exact, EGL_RGB_BUFFER, constant<EGL_RGB_BUFFER>},
    {EGL_CONFIG_CAVEAT, Rule::exact, EGL_DONT_CARE, constant<EGL_NONE>},
    {EGL_CONFIG_ID, Rule::exact, EGL_DONT_CARE, [](const EglConfig& c) { return c.id; }},
    {EGL_CONFORMANT, Rule::mask, 0, constant<kApis>},
    {EGL_DEPTH_SIZE, Rule::at_least, 0, constant<kDepthBits>},
    {EGL_LEVEL, Rule::level, 0, constant<0>},
    {EGL_MAX_PBUFFER_WIDTH, Rule::not_compared, 0, [](const EglConfig&) { return largest_side(); }},
    {EGL_MAX_PBUFFER_HEIGHT, Rule::not_compared, 0, [](const EglConfig&) { return largest_side(); }},
    {EGL_MAX_PBUFFER_PIXELS, Rule::not_compared, 0, [](const EglConfig&) { return largest_side() * largest_side(); }},
    {EGL_MAX_SWAP_INTERVAL, Rule::exact, EGL_DONT_CARE, constant<INT_MAX>},
    {EGL_MIN_SWAP_INTERVAL, Rule::exact, EGL_DONT_CARE, constant<0>},
    {EGL_NATIVE_RENDERABLE, Rule::exact, EGL_DONT_CARE, [](const EglConfig& c) { return c.has_visual() ? 1 : 0; }},
    {EGL_NATIVE_VISUAL_ID, Rule::not_compared, 0,
     [](const EglConfig& c) { return static_cast<EGLint>(c.format.visual.visualid); }},
    {EGL_NATIVE_VISUAL_TYPE, Rule::exact, EGL_DONT_CARE,
     [](const EglConfig& c) { return c.has_visual() ? TrueColor : EGL_NONE; }},
    {EGL_RENDERABLE_TYPE, Rule::mask, EGL_OPENGL_ES_BIT, constant<kApis>},
    {EGL_SAMPLE_BUFFERS, Rule::at_least, 0, constant<0>},
    {EGL_SAMPLES, Rule::at_least, 0, constant<0>},
    {EGL_STENCIL_SIZE, Rule::at_least, 0, constant<kStencilBits>},
    {EGL_SURFACE_TYPE, Rule::mask, EGL_WINDOW_BIT,
     [](const EglConfig& c) {
       const EGLint on_x = c.has_visual() ? EGL_WINDOW_BIT | EGL_PIXMAP_BIT : 0;
       return on_x | EGL_PBUFFER_BIT | EGL_SWAP_BEHAVIOR_PRESERVED_BIT;
     }},
    {EGL_TRANSPARENT_TYPE, Rule::exact, EGL_NONE, constant<EGL_NONE>},
    {EGL_TRANSPARENT_RED_VALUE, Rule::not_compared, 0, constant<0>},
    {EGL_TRANSPARENT_GREEN_VALUE, Rule::not_compared, 0, constant<0>},
    {EGL_TRANSPARENT_BLUE_VALUE, Rule::not_compared, 0, constant<0>},
};

// Displays, surfaces, contexts.

struct Surface {
  Surface(DrawableKind kind, Server* server, XID xid, const EglConfig& its_config, bool single, int width, int height)
      : window(kind, server, xid, {its_config.format.visual, !single}, width, height), config(&its_config) {}
  Window window;
  const EglConfig* config;
  std::thread::id bound_to{};  ///< the thread where it is current
  EGLint texture_format = EGL_NO_TEXTURE, mipmap_texture = EGL_FALSE;
  bool is_bound_to_texture = false;
  EGLint largest = EGL_FALSE, mipmap_level = 0, swap_behavior = EGL_BUFFER_PRESERVED;
  EGLint resolve = EGL_MULTISAMPLE_RESOLVE_DEFAULT, colorspace = EGL_GL_COLORSPACE_LINEAR;
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
  void unbind() {
    if (context == nullptr) return;
    context->bound_to = {};
    for (const auto& surface : {context->draw, context->read})
      if (surface != nullptr) surface->bound_to = {};
    context->draw = context->read = nullptr;
    context->drawable = context->read_drawable = nullptr;
    context = nullptr;
  }
};
thread_local ThreadState t_state;

/// Of displays and what they own: held through every call that looks at them.
std::recursive_mutex& mutex() {
  static auto* const mutex = new std::recursive_mutex;  // threads may outlive main()
  return *mutex;
}
std::map<std::pair<void*, int>, std::unique_ptr<EglDisplay>>& displays() {
  static auto* const displays = new std::map<std::pair<void*, int>, std::unique_ptr<EglDisplay>>;
  return *displays;
}

ThreadState::~ThreadState() {
  const std::lock_guard lock(mutex());
  unbind();
}

/// Ends a call with an error: `return Failed{code}` is EGL_FALSE, a null handle or the like.
struct Failed {
  EGLint code;
  operator EGLBoolean() const { return t_state.error = code, EGL_FALSE; }
  operator void*() const { return t_state.error = code, nullptr; }
};
template <class Result>
Result done(Result result) {
  t_state.error = EGL_SUCCESS;
  return result;
}
EGLBoolean done() { return done<EGLBoolean>(EGL_TRUE); }

EglDisplay* find_display(EGLDisplay handle) {
  for (const auto& [key, display] : displays())
    if (display.get() == handle) return display.get();
  return nullptr;
}

/// What a call looks at, locked. An error other than EGL_SUCCESS has the call end.
struct Call {
  std::unique_lock<std::recursive_mutex> lock{mutex()};
  EGLint error = EGL_SUCCESS;
  EglDisplay* display = nullptr;
  const EglConfig* config = nullptr;
  std::shared_ptr<Surface> surface;

  explicit Call(EGLDisplay handle) : display(find_display(handle)) {
    error = display == nullptr ? EGL_BAD_DISPLAY : !display->initialized ? EGL_NOT_INITIALIZED : EGL_SUCCESS;
  }
  Call& with_config(EGLConfig handle) {
    if (error != EGL_SUCCESS) return *this;
    for (const EglConfig& c : display->configs)
      if (&c == handle) config = &c;
    if (config == nullptr) error = EGL_BAD_CONFIG;
    return *this;
  }
  Call& with_surface(EGLSurface handle) {
    if (error != EGL_SUCCESS) return *this;
    const auto found = display->surfaces.find(handle);
    if (found == display->surfaces.end())
      error = EGL_BAD_SURFACE;
    else
      surface = found->second;
    return *this;
  }
  [[nodiscard]] std::shared_ptr<EglContext> context(EGLContext handle) const {
    const auto found = display->contexts.find(handle);
    return found == display->contexts.end() ? nullptr : found->second;
  }
  [[nodiscard]] bool failed() const { return error != EGL_SUCCESS; }
};

using Wishes = std::map<EGLAttrib, EGLAttrib>;

/// Overwrites what a list says. False: it names what `wishes` does not have.
template <class T>
bool read_list(const T* list, Wishes& wishes) {
  for (; list != nullptr && *list != EGL_NONE; list += 2) {
    const auto wish = wishes.find(static_cast<EGLAttrib>(list[0]));
    if (wish == wishes.end()) return false;
    wish->second = static_cast<EGLAttrib>(list[1]);
  }
  return true;
}

EGLDisplay get_platform_display(EGLenum platform, void* native, const EGLAttrib* list) {
  const std::lock_guard lock(mutex());
  constexpr EGLAttrib kScreen = EGL_PLATFORM_X11_SCREEN_KHR;
  Wishes wishes;
  if (platform == EGL_PLATFORM_X11_KHR) wishes[kScreen] = -1;
  if (!read_list(list, wishes)) return Failed{EGL_BAD_ATTRIBUTE};
  const bool is_default = platform == EGL_NONE && native == nullptr;
  auto* const x_display = platform == EGL_PLATFORM_X11_KHR ? static_cast<Display*>(native) : nullptr;
  Server* server = nullptr;
  int screen = -1;
  if (is_default || platform == EGL_PLATFORM_X11_KHR) {
    server = Server::open(x_display == nullptr ? nullptr : DisplayString(x_display));
    if (server == nullptr && !is_default) return done<EGLDisplay>(EGL_NO_DISPLAY);
    if (server != nullptr) {
      screen = wishes.empty() || wishes[kScreen] == -1 ? server->default_screen() : static_cast<int>(wishes[kScreen]);
      if (x_display != nullptr && wishes[kScreen] == -1) screen = DefaultScreen(x_display);
      if (screen < 0 || screen >= server->screens()) return Failed{EGL_BAD_PARAMETER};
    }
  } else if (platform != EGL_PLATFORM_SURFACELESS_MESA || native != nullptr) {
    return Failed{EGL_BAD_PARAMETER};
  }
  // The default display and the surfaceless one have keys of their own.
  static char surfaceless = 0;
  void* const key = server == nullptr ? static_cast<void*>(&surfaceless) : x_display == nullptr ? server : native;
  std::unique_ptr<EglDisplay>& display = displays()[{key, screen}];
  if (display == nullptr) {
    display = std::make_unique<EglDisplay>();
    display->server = server;
    display->native = x_display;
    display->screen = std::max(screen, 0);
    std::vector<PixelFormat> formats(1);
    if (server != nullptr) formats = server->formats(screen);
    std::set<VisualID> seen;
    for (const PixelFormat& format : formats)
      if (seen.insert(format.visual.visualid).second)
        display->configs.push_back({static_cast<EGLint>(seen.size()), {format.visual, true}});
  }
  return done<EGLDisplay>(display.get());
}

// EGL 1.5.

EGLint egl_get_error() { return done(t_state.error); }

EGLBoolean egl_initialize(EGLDisplay handle, EGLint* major, EGLint* minor) {
  Call call(handle);
  if (call.error == EGL_BAD_DISPLAY) return Failed{call.error};
  call.display->initialized = true;
  if (major != nullptr) *major = 1;
  if (minor != nullptr) *minor = 5;
  return done();
}

EGLBoolean egl_terminate(EGLDisplay handle) {
  Call call(handle);
  if (call.error == EGL_BAD_DISPLAY) return Failed{call.error};
  call.display->initialized = false;
  call.display->surfaces.clear();  // what is current stays until it is not
  call.display->contexts.clear();
  call.display->syncs.clear();
  return done();
}

const char* egl_query_string(EGLDisplay handle, EGLint name) {
  if (handle == EGL_NO_DISPLAY && (name == EGL_EXTENSIONS || name == EGL_VERSION))
    return done(name == EGL_VERSION ? "1.5" : "EGL_EXT_client_extensions EGL_EXT_platform_base");
  const Call call(handle);
  t_state.error = call.error;
  if (call.failed()) return nullptr;
  switch (name) {
    case EGL_CLIENT_APIS: return "OpenGL OpenGL_ES";
    case EGL_VENDOR: return "Halfplane";
    case EGL_VERSION: return "1.5";
    case EGL_EXTENSIONS:
      return "EGL_KHR_create_context EGL_KHR_get_all_proc_addresses EGL_KHR_no_config_context "
             "EGL_KHR_surfaceless_context";
    default: t_state.error = EGL_BAD_PARAMETER; return nullptr;
  }
}

EGLBoolean choose(const Call& call, const Wishes& wishes, EGLConfig* configs, EGLint size, EGLint* count) {
  if (count == nullptr) return Failed{EGL_BAD_PARAMETER};
  int depth = 0;
  if (const auto pixmap = wishes.find(EGL_MATCH_NATIVE_PIXMAP); pixmap != wishes.end() && pixmap->second != EGL_NONE) {
    call.display->flush();
    const auto geometry = call.display->server == nullptr
                              ? std::nullopt
                              : call.display->server->geometry(static_cast<XID>(pixmap->second));
    if (!geometry) return Failed{EGL_BAD_NATIVE_PIXMAP};
    depth = geometry->depth;
  }
  EGLint found = 0;
  // They differ in nothing that eglChooseConfig() sorts by but their numbers.
  for (EglConfig& config : call.display->configs) {
    if (!fits(kAttributes, config, wishes, EGL_CONFIG_ID) || (depth != 0 && depth != config.format.visual.depth))
      continue;
    if (configs != nullptr && found == size) break;
    if (configs != nullptr) configs[found] = &config;
    ++found;
  }
  *count = found;
  return done();
}

EGLBoolean egl_choose_config(EGLDisplay handle, const EGLint* list, EGLConfig* configs, EGLint size, EGLint* count) {
  const Call call(handle);
  if (call.failed()) return Failed{call.error};
  Wishes wishes;
  for (; list != nullptr && *list != EGL_NONE; list += 2) {
    if (find_attribute(kAttributes, list[0]) == nullptr && list[0] != EGL_MATCH_NATIVE_PIXMAP)
      return Failed{EGL_BAD_ATTRIBUTE};
    if (list[0] == EGL_LEVEL && list[1] == EGL_DONT_CARE) return Failed{EGL_BAD_ATTRIBUTE};
    wishes[list[0]] = list[1];
  }
  return choose(call, wishes, configs, size, count);
}

EGLBoolean egl_get_configs(EGLDisplay handle, EGLConfig* configs, EGLint size, EGLint* count) {
  const Call call(handle);
  if (call.failed()) return Failed{call.error};
  return choose(call, {{EGL_SURFACE_TYPE, 0}}, configs, size, count);
}

EGLBoolean egl_get_config_attrib(EGLDisplay handle, EGLConfig config, EGLint name, EGLint* value) {
  const Call call = std::move(Call(handle).with_config(config));
  if (call.failed()) return Failed{call.error};
  const auto* const a = find_attribute(kAttributes, name);
  if (a == nullptr) return Failed{EGL_BAD_ATTRIBUTE};
  *value = a->value(*call.config);
  return done();
}

void* keep(EglDisplay& display, std::shared_ptr<Surface> surface) {
  void* const handle = surface.get();
  display.surfaces[handle] = std::move(surface);
  return done(handle);
}

/// Of an X window or pixmap.
template <class T>
EGLSurface create_on(EGLDisplay handle, DrawableKind kind, EGLConfig config, XID xid, const T* list) {
  const bool is_window = kind == DrawableKind::window;
  const EGLint bad_native = is_window ? EGL_BAD_NATIVE_WINDOW : EGL_BAD_NATIVE_PIXMAP;
  Call call(handle);
  if (!call.failed() && call.display->server == nullptr) return Failed{bad_native};
  if (call.with_config(config).failed()) return Failed{call.error};
  Wishes wishes{{EGL_GL_COLORSPACE, EGL_GL_COLORSPACE_LINEAR},
                {EGL_VG_COLORSPACE, EGL_VG_COLORSPACE_LINEAR},
                {EGL_VG_ALPHA_FORMAT, EGL_VG_ALPHA_FORMAT_NONPRE}};
  if (is_window) wishes[EGL_RENDER_BUFFER] = EGL_BACK_BUFFER;
  if (!read_list(list, wishes)) return Failed{EGL_BAD_ATTRIBUTE};
  const bool single = is_window && wishes[EGL_RENDER_BUFFER] == EGL_SINGLE_BUFFER;
  if (is_window && !single && wishes[EGL_RENDER_BUFFER] != EGL_BACK_BUFFER) return Failed{EGL_BAD_ATTRIBUTE};
  if (wishes[EGL_GL_COLORSPACE] != EGL_GL_COLORSPACE_LINEAR) return Failed{EGL_BAD_MATCH};
  call.display->flush();
  Server& server = *call.display->server;
  const auto geometry = is_window ? server.window_geometry(xid) : server.geometry(xid);
  if (!geometry) return Failed{bad_native};
  if (geometry->depth != call.config->format.visual.depth || geometry->screen != call.display->screen)
    return Failed{EGL_BAD_MATCH};
  for (const auto& [other, surface] : call.display->surfaces)
    if (surface->window.xid == xid) return Failed{EGL_BAD_ALLOC};
  try {
    return keep(*call.display,
                std::make_shared<Surface>(kind, &server, xid, *call.config, single, geometry->width, geometry->height));
  } catch (const std::exception&) {
    return Failed{EGL_BAD_ALLOC};
  }
}

EGLSurface egl_create_window_surface(EGLDisplay display, EGLConfig config, EGLNativeWindowType window,
                                     const EGLint* list) {
  return create_on(display, DrawableKind::window, config, static_cast<XID>(window), list);
}
EGLSurface egl_create_pixmap_surface(EGLDisplay display, EGLConfig config, EGLNativePixmapType pixmap,
                                     const EGLint* list) {
  return create_on(display, DrawableKind::pixmap, config, static_cast<XID>(pixmap), list);
}
/// `native` points to the X window or pixmap.
template <DrawableKind Kind, class T>
EGLSurface egl_create_platform_surface(EGLDisplay display, EGLConfig config, void* native, const T* list) {
  return create_on(display, Kind, config, native == nullptr ? 0 : *static_cast<XID*>(native), list);
}

EGLSurface egl_create_pbuffer_surface(EGLDisplay handle, EGLConfig config, const EGLint* list) {
  const Call call = std::move(Call(handle).with_config(config));
  if (call.failed()) return Failed{call.error};
  Wishes wishes{{EGL_WIDTH, 0},
                {EGL_HEIGHT, 0},
                {EGL_LARGEST_PBUFFER, EGL_FALSE},
                {EGL_TEXTURE_FORMAT, EGL_NO_TEXTURE},
                {EGL_TEXTURE_TARGET, EGL_NO_TEXTURE},
                {EGL_MIPMAP_TEXTURE, EGL_FALSE},
                {EGL_GL_COLORSPACE, EGL_GL_COLORSPACE_LINEAR},
                {EGL_VG_COLORSPACE, EGL_VG_COLORSPACE_LINEAR},
                {EGL_VG_ALPHA_FORMAT, EGL_VG_ALPHA_FORMAT_NONPRE}};
  if (!read_list(list, wishes)) return Failed{EGL_BAD_ATTRIBUTE};
  if (wishes[EGL_WIDTH] < 0 || wishes[EGL_HEIGHT] < 0) return Failed{EGL_BAD_PARAMETER};
  const auto texture_format = static_cast<EGLint>(wishes[EGL_TEXTURE_FORMAT]);
  const EGLAttrib texture_target = wishes[EGL_TEXTURE_TARGET];
  if ((texture_format != EGL_NO_TEXTURE && texture_format != EGL_TEXTURE_RGB && texture_format != EGL_TEXTURE_RGBA) ||
      (texture_target != EGL_NO_TEXTURE && texture_target != EGL_TEXTURE_2D))
    return Failed{EGL_BAD_ATTRIBUTE};
  if ((texture_format == EGL_NO_TEXTURE) != (texture_target == EGL_NO_TEXTURE) ||
      wishes[EGL_GL_COLORSPACE] != EGL_GL_COLORSPACE_LINEAR)
    return Failed{EGL_BAD_MATCH};
  const bool largest = wishes[EGL_LARGEST_PBUFFER] != EGL_FALSE;
  const EGLAttrib most = largest ? largest_side() : INT_MAX;
  auto width = static_cast<int>(std::clamp<EGLAttrib>(wishes[EGL_WIDTH], 1, most));
  auto height = static_cast<int>(std::clamp<EGLAttrib>(wishes[EGL_HEIGHT], 1, most));
  for (;; width -= width / 2, height -= height / 2) {
    try {
      auto surface =
          std::make_shared<Surface>(DrawableKind::pbuffer, call.display->server, 0, *call.config, false, width, height);
      surface->largest = largest ? EGL_TRUE : EGL_FALSE;
      surface->texture_format = texture_format;
      surface->mipmap_texture = wishes[EGL_MIPMAP_TEXTURE] != EGL_FALSE ? EGL_TRUE : EGL_FALSE;
      return keep(*call.display, std::move(surface));
    } catch (const std::exception&) {
      if (!largest || (width == 1 && height == 1)) return Failed{EGL_BAD_ALLOC};
    }
  }
}

/// Of OpenVG's images, which do not exist here.
EGLSurface egl_create_pbuffer_from_client_buffer(EGLDisplay handle, EGLenum, EGLClientBuffer, EGLConfig config,
                                                 const EGLint*) {
  const Call call = std::move(Call(handle).with_config(config));
  return Failed{call.failed() ? call.error : EGL_BAD_PARAMETER};
}

EGLBoolean egl_destroy_surface(EGLDisplay handle, EGLSurface surface) {
  const Call call = std::move(Call(handle).with_surface(surface));
  if (call.failed()) return Failed{call.error};
  call.display->surfaces.erase(surface);
  return done();
}

EGLBoolean egl_query_surface(EGLDisplay handle, EGLSurface surface, EGLint name, EGLint* value) {
  const Call call = std::move(Call(handle).with_surface(surface));
  if (call.failed()) return Failed{call.error};
  Surface& s = *call.surface;
  const bool is_pbuffer = s.window.kind == DrawableKind::pbuffer;
  const auto of_pbuffer = [&](EGLint v) {
    if (is_pbuffer) *value = v;  // of other surfaces nothing changes
  };
  switch (name) {
    case EGL_WIDTH: *value = s.window.frame.width(); break;
    case EGL_HEIGHT: *value = s.window.frame.height(); break;
    case EGL_CONFIG_ID: *value = s.config->id; break;
    case EGL_LARGEST_PBUFFER: of_pbuffer(s.largest); break;
    case EGL_TEXTURE_FORMAT: of_pbuffer(s.texture_format); break;
    case EGL_TEXTURE_TARGET: of_pbuffer(s.texture_format == EGL_NO_TEXTURE ? EGL_NO_TEXTURE : EGL_TEXTURE_2D); break;
    case EGL_MIPMAP_TEXTURE: of_pbuffer(s.mipmap_texture); break;
    case EGL_MIPMAP_LEVEL: of_pbuffer(s.mipmap_level); break;
    case EGL_HORIZONTAL_RESOLUTION:
    case EGL_VERTICAL_RESOLUTION: *value = EGL_UNKNOWN; break;
    case EGL_PIXEL_ASPECT_RATIO: *value = EGL_DISPLAY_SCALING; break;
    case EGL_RENDER_BUFFER: *value = s.window.single_buffered ? EGL_SINGLE_BUFFER : EGL_BACK_BUFFER; break;
    case EGL_SWAP_BEHAVIOR: *value = s.swap_behavior; break;
    case EGL_MULTISAMPLE_RESOLVE: *value = s.resolve; break;
    case EGL_GL_COLORSPACE:
    case EGL_VG_COLORSPACE: *value = EGL_GL_COLORSPACE_LINEAR; break;  // has the number of EGL_VG_COLORSPACE_LINEAR
    case EGL_VG_ALPHA_FORMAT: *value = EGL_VG_ALPHA_FORMAT_NONPRE; break;
    default: return Failed{EGL_BAD_ATTRIBUTE};
  }
  return done();
}

EGLBoolean egl_surface_attrib(EGLDisplay handle, EGLSurface surface, EGLint name, EGLint value) {
  const Call call = std::move(Call(handle).with_surface(surface));
  if (call.failed()) return Failed{call.error};
  switch (name) {
    case EGL_MIPMAP_LEVEL: call.surface->mipmap_level = value; return done();
    case EGL_MULTISAMPLE_RESOLVE:
      if (value == EGL_MULTISAMPLE_RESOLVE_BOX) return Failed{EGL_BAD_MATCH};
      return value == EGL_MULTISAMPLE_RESOLVE_DEFAULT ? done() : EGLBoolean(Failed{EGL_BAD_PARAMETER});
    case EGL_SWAP_BEHAVIOR:
      if (value != EGL_BUFFER_PRESERVED && value != EGL_BUFFER_DESTROYED) return Failed{EGL_BAD_PARAMETER};
      call.surface->swap_behavior = value;
      return done();
    default: return Failed{EGL_BAD_ATTRIBUTE};
  }
}

/// eglBindTexImage copies the pbuffer to the texture: until eglReleaseTexImage nothing may be drawn to it.
template <bool Binds>
EGLBoolean egl_tex_image(EGLDisplay handle, EGLSurface surface_handle, EGLint buffer) {
  const Call call = std::move(Call(handle).with_surface(surface_handle));
  if (call.failed()) return Failed{call.error};
  Surface& surface = *call.surface;
  if (buffer != EGL_BACK_BUFFER) return Failed{EGL_BAD_PARAMETER};
  if (surface.window.kind != DrawableKind::pbuffer) return Failed{EGL_BAD_SURFACE};
  if (surface.texture_format == EGL_NO_TEXTURE) return Failed{EGL_BAD_MATCH};
  if (Binds && surface.is_bound_to_texture) return Failed{EGL_BAD_ACCESS};
  if (EglContext* const context = t_state.context.get(); Binds && context != nullptr) {
    Drawable* const read = std::exchange(context->read_drawable, &surface.window);
    copy_tex_image(*context, 2, GL_TEXTURE_2D, surface.mipmap_level,
                   surface.texture_format == EGL_TEXTURE_RGB ? GL_RGB : GL_RGBA, 0, 0, surface.window.frame.width(),
                   surface.window.frame.height(), 0);
    context->read_drawable = read;
    ++context->revision;
  }
  surface.is_bound_to_texture = Binds;
  return done();
}

EGLBoolean egl_bind_api(EGLenum api) {
  if (api != EGL_OPENGL_API && api != EGL_OPENGL_ES_API) return Failed{EGL_BAD_PARAMETER};
  t_state.api = api;
  return done();
}
EGLenum egl_query_api() { return done(t_state.api); }
EGLBoolean get_supports_api(EGLenum api) {
  return api == EGL_OPENGL_API || api == EGL_OPENGL_ES_API ? EGL_TRUE : EGL_FALSE;
}

EGLContext egl_create_context(EGLDisplay handle, EGLConfig config, EGLContext share, const EGLint* list) {
  Call call(handle);
  if (config != EGL_NO_CONFIG_KHR) call.with_config(config);
  if (call.failed()) return Failed{call.error};
  const bool is_es = t_state.api == EGL_OPENGL_ES_API;
  Wishes wishes{{EGL_CONTEXT_MAJOR_VERSION, 1},
                {EGL_CONTEXT_MINOR_VERSION, 0},
                {EGL_CONTEXT_FLAGS_KHR, 0},
                {EGL_CONTEXT_OPENGL_DEBUG, EGL_FALSE},
                {EGL_CONTEXT_OPENGL_ROBUST_ACCESS, EGL_FALSE},
                {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_NO_RESET_NOTIFICATION}};
  if (!is_es) {
    wishes[EGL_CONTEXT_OPENGL_PROFILE_MASK] = EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT;
    wishes[EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE] = EGL_FALSE;
  }
  if (!read_list(list, wishes)) return Failed{EGL_BAD_ATTRIBUTE};
  const EGLAttrib major = wishes[EGL_CONTEXT_MAJOR_VERSION], minor = wishes[EGL_CONTEXT_MINOR_VERSION];
  const EGLAttrib flags = wishes[EGL_CONTEXT_FLAGS_KHR];
  constexpr EGLAttrib kForwardOrRobust =
      EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE_BIT_KHR | EGL_CONTEXT_OPENGL_ROBUST_ACCESS_BIT_KHR;
  if ((flags & ~(EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR | (is_es ? 0 : kForwardOrRobust))) != 0)
    return Failed{EGL_BAD_ATTRIBUTE};
  if (major != 1 || minor < 0 || minor > (is_es ? 0 : 5) || (flags & kForwardOrRobust) != 0 ||
      wishes[EGL_CONTEXT_OPENGL_ROBUST_ACCESS] != EGL_FALSE ||
      (!is_es && wishes[EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE] != EGL_FALSE))
    return Failed{EGL_BAD_MATCH};
  const std::shared_ptr<EglContext> other = call.context(share);
  if (share != EGL_NO_CONTEXT && other == nullptr) return Failed{EGL_BAD_CONTEXT};
  if (other != nullptr && other->api != t_state.api) return Failed{EGL_BAD_MATCH};
  try {
    auto context = other == nullptr ? std::make_shared<EglContext>() : std::make_shared<EglContext>(other->shared);
    context->api = t_state.api;
    context->is_embedded = is_es;
    context->config = call.config;
    void* const result = context.get();
    call.display->contexts[result] = std::move(context);
    return done(result);
  } catch (const std::bad_alloc&) {
    return Failed{EGL_BAD_ALLOC};
  }
}

EGLBoolean egl_destroy_context(EGLDisplay handle, EGLContext context) {
  const Call call(handle);
  if (call.failed()) return Failed{call.error};
  return call.display->contexts.erase(context) == 0 ? EGLBoolean(Failed{EGL_BAD_CONTEXT}) : done();
}

EGLBoolean egl_query_context(EGLDisplay handle, EGLContext handle_of_context, EGLint name, EGLint* value) {
  const Call call(handle);
  if (call.failed()) return Failed{call.error};
  const std::shared_ptr<EglContext> context = call.context(handle_of_context);
  if (context == nullptr) return Failed{EGL_BAD_CONTEXT};
  switch (name) {
    case EGL_CONFIG_ID: *value = context->config == nullptr ? 0 : context->config->id; break;
    case EGL_CONTEXT_CLIENT_TYPE: *value = static_cast<EGLint>(context->api); break;
    case EGL_CONTEXT_CLIENT_VERSION: *value = 1; break;
    case EGL_RENDER_BUFFER:
      *value = context->draw == nullptr                ? EGL_NONE
               : context->draw->window.single_buffered ? EGL_SINGLE_BUFFER
                                                       : EGL_BACK_BUFFER;
      break;
    default: return Failed{EGL_BAD_ATTRIBUTE};
  }
  return done();
}

void release() {
  make_current(nullptr, nullptr, nullptr);
  t_state.unbind();
}

EGLBoolean egl_make_current(EGLDisplay handle, EGLSurface draw, EGLSurface read, EGLContext handle_of_context) {
  Call call(handle);
  const bool is_release = handle_of_context == EGL_NO_CONTEXT && draw == EGL_NO_SURFACE && read == EGL_NO_SURFACE;
  if (call.error == EGL_BAD_DISPLAY || (call.failed() && !is_release)) return Failed{call.error};
  if (is_release) return release(), done();
  if (handle_of_context == EGL_NO_CONTEXT) return Failed{EGL_BAD_MATCH};
  const std::shared_ptr<EglContext> context = call.context(handle_of_context);
  if (context == nullptr) return Failed{EGL_BAD_CONTEXT};
  std::array<std::shared_ptr<Surface>, 2> surfaces;
  const EGLSurface handles[] = {draw, read};
  const auto is_elsewhere = [](std::thread::id bound) {
    return bound != std::thread::id() && bound != std::this_thread::get_id();
  };
  for (std::size_t i = 0; i < 2; ++i)
    if (handles[i] != EGL_NO_SURFACE) {
      if (call.with_surface(handles[i]).failed()) return Failed{call.error};
      surfaces[i] = call.surface;
    }
  if ((surfaces[0] == nullptr) != (surfaces[1] == nullptr)) return Failed{EGL_BAD_MATCH};
  if (is_elsewhere(context->bound_to)) return Failed{EGL_BAD_ACCESS};
  for (const auto& surface : surfaces)
    if (surface != nullptr) {
      if (is_elsewhere(surface->bound_to)) return Failed{EGL_BAD_ACCESS};
      if (context->config != nullptr && context->config->format.visual.depth != surface->config->format.visual.depth)
        return Failed{EGL_BAD_MATCH};
      call.display->flush();
      if (!surface->window.follow_size()) return Failed{EGL_BAD_NATIVE_WINDOW};
    }
  const auto drawable = [&](std::size_t i) { return surfaces[i] == nullptr ? nullptr : &surfaces[i]->window; };
  make_current(context.get(), drawable(0), drawable(1));
  if (t_state.context != context) t_state.unbind();
  for (const auto& surface : {context->draw, context->read})
    if (surface != nullptr) surface->bound_to = {};
  context->bound_to = std::this_thread::get_id();
  context->draw = surfaces[0];
  context->read = surfaces[1];
  for (const auto& surface : surfaces)
    if (surface != nullptr) surface->bound_to = std::this_thread::get_id();
  t_state.context = context;
  return done();
}

EGLBoolean egl_swap_buffers(EGLDisplay handle, EGLSurface handle_of_surface) {
  std::shared_ptr<Surface> surface;
  {
    const Call call = std::move(Call(handle).with_surface(handle_of_surface));
    if (call.failed()) return Failed{call.error};
    surface = call.surface;
    if (call.display->native != nullptr) XFlush(call.display->native);
  }
  if (t_state.context == nullptr || t_state.context->draw != surface) return Failed{EGL_BAD_SURFACE};
  surface->window.swap();
  return done();
}

EGLBoolean egl_copy_buffers(EGLDisplay handle, EGLSurface surface, EGLNativePixmapType pixmap) {
  const Call call = std::move(Call(handle).with_surface(surface));
  if (call.failed()) return Failed{call.error};
  if (call.display->server == nullptr) return Failed{EGL_BAD_MATCH};
  call.display->flush();
  const auto geometry = call.display->server->geometry(static_cast<XID>(pixmap));
  if (!geometry) return Failed{EGL_BAD_NATIVE_PIXMAP};
  if (geometry->depth != call.surface->config->format.visual.depth) return Failed{EGL_BAD_MATCH};
  call.surface->window.show(static_cast<XID>(pixmap));
  return done();
}

EGLBoolean egl_swap_interval(EGLDisplay handle, EGLint interval) {
  const Call call(handle);
  if (call.failed()) return Failed{call.error};
  if (t_state.context == nullptr) return Failed{EGL_BAD_CONTEXT};
  if (t_state.context->draw == nullptr) return Failed{EGL_BAD_SURFACE};
  t_state.context->draw->window.swap_interval = std::max(interval, 0);
  return done();
}

EGLBoolean egl_wait_client() {
  if (t_state.context != nullptr) finish(*t_state.context);
  return done();
}

EGLBoolean egl_wait_native(EGLint engine) {
  if (engine != EGL_CORE_NATIVE_ENGINE) return Failed{EGL_BAD_PARAMETER};
  const std::lock_guard lock(mutex());
  for (const auto& [key, display] : displays())
    if (display->initialized && t_state.context != nullptr) display->flush();
  return done();
}

EGLBoolean egl_release_thread() {
  const std::lock_guard lock(mutex());
  release();
  t_state.api = EGL_OPENGL_ES_API;
  return done();
}

// Fences: all that was issued is carried out as one is made, so each is signaled from the start.

EGLSync egl_create_sync(EGLDisplay handle, EGLenum type, const EGLAttrib* list) {
  const Call call(handle);
  if (call.failed()) return Failed{call.error};
  if (type != EGL_SYNC_FENCE || (list != nullptr && *list != EGL_NONE)) return Failed{EGL_BAD_ATTRIBUTE};
  if (t_state.context == nullptr) return Failed{EGL_BAD_MATCH};
  finish(*t_state.context);
  auto sync = std::make_unique<char>();
  void* const handle_of_sync = sync.get();
  call.display->syncs[handle_of_sync] = std::move(sync);
  return done(handle_of_sync);
}

EGLint check_sync(const Call& call, EGLSync sync) {
  return call.failed() ? call.error : call.display->syncs.contains(sync) ? EGL_SUCCESS : EGL_BAD_PARAMETER;
}

EGLBoolean egl_destroy_sync(EGLDisplay handle, EGLSync sync) {
  const Call call(handle);
  if (const EGLint error = check_sync(call, sync); error != EGL_SUCCESS) return Failed{error};
  call.display->syncs.erase(sync);
  return done();
}

EGLint egl_client_wait_sync(EGLDisplay handle, EGLSync sync, EGLint, EGLTime) {
  const Call call(handle);
  t_state.error = check_sync(call, sync);
  return t_state.error == EGL_SUCCESS ? EGL_CONDITION_SATISFIED : EGL_FALSE;
}

EGLBoolean egl_wait_sync(EGLDisplay handle, EGLSync sync, EGLint flags) {
  const Call call(handle);
  if (const EGLint error = check_sync(call, sync); error != EGL_SUCCESS) return Failed{error};
  if (t_state.context == nullptr) return Failed{EGL_BAD_MATCH};
  return flags == 0 ? done() : EGLBoolean(Failed{EGL_BAD_PARAMETER});
}

EGLBoolean egl_get_sync_attrib(EGLDisplay handle, EGLSync sync, EGLint name, EGLAttrib* value) {
  const Call call(handle);
  if (const EGLint error = check_sync(call, sync); error != EGL_SUCCESS) return Failed{error};
  switch (name) {
    case EGL_SYNC_TYPE: *value = EGL_SYNC_FENCE; break;
    case EGL_SYNC_STATUS: *value = EGL_SIGNALED; break;
    case EGL_SYNC_CONDITION: *value = EGL_SYNC_PRIOR_COMMANDS_COMPLETE; break;
    default: return Failed{EGL_BAD_ATTRIBUTE};
  }
  return done();
}

/// No kind of object can become an image.
EGLImage egl_create_image(EGLDisplay handle, EGLContext, EGLenum, EGLClientBuffer, const EGLAttrib*) {
  const Call call(handle);
  return Failed{call.failed() ? call.error : EGL_BAD_PARAMETER};
}
EGLBoolean egl_destroy_image(EGLDisplay handle, EGLImage) {
  const Call call(handle);
  return Failed{call.failed() ? call.error : EGL_BAD_PARAMETER};
}

template <class Function>
void* address(Function* function) {
  return reinterpret_cast<void*>(function);
}

void* get_proc_address(const char* name) {
  struct Named {
    std::string_view name;
    void* function;
  };
  static const Named table[] = {
      {"eglBindAPI", address(egl_bind_api)},
      {"eglBindTexImage", address(egl_tex_image<true>)},
      {"eglChooseConfig", address(egl_choose_config)},
      {"eglClientWaitSync", address(egl_client_wait_sync)},
      {"eglCopyBuffers", address(egl_copy_buffers)},
      {"eglCreateContext", address(egl_create_context)},
      {"eglCreateImage", address(egl_create_image)},
      {"eglCreatePbufferFromClientBuffer", address(egl_create_pbuffer_from_client_buffer)},
      {"eglCreatePbufferSurface", address(egl_create_pbuffer_surface)},
      {"eglCreatePixmapSurface", address(egl_create_pixmap_surface)},
      {"eglCreatePlatformPixmapSurface", address(egl_create_platform_surface<DrawableKind::pixmap, EGLAttrib>)},
      {"eglCreatePlatformPixmapSurfaceEXT", address(egl_create_platform_surface<DrawableKind::pixmap, EGLint>)},
      {"eglCreatePlatformWindowSurface", address(egl_create_platform_surface<DrawableKind::window, EGLAttrib>)},
      {"eglCreatePlatformWindowSurfaceEXT", address(egl_create_platform_surface<DrawableKind::window, EGLint>)},
      {"eglCreateSync", address(egl_create_sync)},
      {"eglCreateWindowSurface", address(egl_create_window_surface)},
      {"eglDestroyContext", address(egl_destroy_context)},
      {"eglDestroyImage", address(egl_destroy_image)},
      {"eglDestroySurface", address(egl_destroy_surface)},
      {"eglDestroySync", address(egl_destroy_sync)},
      {"eglGetConfigAttrib", address(egl_get_config_attrib)},
      {"eglGetConfigs", address(egl_get_configs)},
      {"eglGetError", address(egl_get_error)},
      {"eglGetSyncAttrib", address(egl_get_sync_attrib)},
      {"eglInitialize", address(egl_initialize)},
      {"eglMakeCurrent", address(egl_make_current)},
      {"eglQueryAPI", address(egl_query_api)},
      {"eglQueryContext", address(egl_query_context)},
      {"eglQueryString", address(egl_query_string)},
      {"eglQuerySurface", address(egl_query_surface)},
      {"eglReleaseTexImage", address(egl_tex_image<false>)},
      {"eglReleaseThread", address(egl_release_thread)},
      {"eglSurfaceAttrib", address(egl_surface_attrib)},
      {"eglSwapBuffers", address(egl_swap_buffers)},
      {"eglSwapInterval", address(egl_swap_interval)},
      {"eglTerminate", address(egl_terminate)},
      {"eglWaitClient", address(egl_wait_client)},
      {"eglWaitGL", address(egl_wait_client)},
      {"eglWaitNative", address(egl_wait_native)},
      {"eglWaitSync", address(egl_wait_sync)},
  };
  const auto* const found = std::ranges::find(table, std::string_view(name), &Named::name);
  return found != std::end(table) ? found->function : const_cast<void*>(entry_point(name));
}

const char* get_vendor_string(int name) {
  return name == __EGL_VENDOR_STRING_PLATFORM_EXTENSIONS
             ? "EGL_EXT_platform_x11 EGL_KHR_platform_x11 EGL_MESA_platform_surfaceless"
             : nullptr;
}

// There are no extension functions to dispatch.
void* get_dispatch_address(const char*) { return nullptr; }
void set_dispatch_index(const char*, int) {}

}  // namespace
}  // namespace halfplane::gl

extern "C" __attribute__((visibility("default"))) EGLBoolean __egl_Main(uint32_t version, const __EGLapiExports*,
                                                                        __EGLvendorInfo*, __EGLapiImports* imports) {
  if (EGL_VENDOR_ABI_GET_MAJOR_VERSION(version) != EGL_VENDOR_ABI_MAJOR_VERSION || !halfplane::gl::answers("EGL"))
    return EGL_FALSE;
  imports->getPlatformDisplay = halfplane::gl::get_platform_display;
  imports->getSupportsAPI = halfplane::gl::get_supports_api;
  imports->getVendorString = halfplane::gl::get_vendor_string;
  imports->getProcAddress = halfplane::gl::get_proc_address;
  imports->getDispatchAddress = halfplane::gl::get_dispatch_address;
  imports->setDispatchIndex = halfplane::gl::set_dispatch_index;
  return EGL_TRUE;
}
