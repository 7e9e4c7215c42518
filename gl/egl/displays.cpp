// Displays, and the configurations of each.
#include <climits>
#include <set>

#include "egl.hpp"

namespace halfplane::gl::egl {
namespace {

constexpr EGLint kApis = EGL_OPENGL_BIT | EGL_OPENGL_ES_BIT;
/// EGL 1.5, table 3.1, with how eglChooseConfig() compares and its default (table 3.4).
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

EGLDisplay platform_display(EGLenum platform, void* native, const EGLAttrib* list) {
  const std::lock_guard lock(mutex());
  constexpr EGLAttrib kScreen = EGL_PLATFORM_X11_SCREEN_KHR;
  Wishes wishes;
  if (platform == EGL_PLATFORM_X11_KHR) wishes[kScreen] = -1;
  require(read_list<EGL_NONE>(list, wishes), EGL_BAD_ATTRIBUTE);
  const bool is_default = platform == EGL_NONE && native == nullptr;
  auto* const x_display = platform == EGL_PLATFORM_X11_KHR ? static_cast<Display*>(native) : nullptr;
  Server* server = nullptr;
  int screen = -1;
  if (is_default || platform == EGL_PLATFORM_X11_KHR) {
    server = Server::open(x_display == nullptr ? nullptr : DisplayString(x_display));
    if (server == nullptr && !is_default) return EGL_NO_DISPLAY;
    if (server != nullptr) {
      screen = wishes.empty() || wishes[kScreen] == -1 ? server->default_screen() : static_cast<int>(wishes[kScreen]);
      if (x_display != nullptr && wishes[kScreen] == -1) screen = DefaultScreen(x_display);
      require(screen >= 0 && screen < server->screens(), EGL_BAD_PARAMETER);
    }
  } else {
    require(platform == EGL_PLATFORM_SURFACELESS_MESA && native == nullptr, EGL_BAD_PARAMETER);
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
  return display.get();
}

void initialize(EGLDisplay handle, EGLint* major, EGLint* minor) {
  const Call call(handle, false);
  call.display.initialized = true;
  if (major != nullptr) *major = 1;
  if (minor != nullptr) *minor = 5;
}

void terminate(EGLDisplay handle) {
  const Call call(handle, false);
  call.display.initialized = false;
  call.display.surfaces.clear();  // a current surface stays until another one is made current
  call.display.contexts.clear();
  call.display.syncs.clear();
}

const char* query_string(EGLDisplay handle, EGLint name) {
  if (handle == EGL_NO_DISPLAY && name == EGL_VERSION) return "1.5";
  if (handle == EGL_NO_DISPLAY && name == EGL_EXTENSIONS) return "EGL_EXT_client_extensions EGL_EXT_platform_base";
  const Call call(handle);
  switch (name) {
    case EGL_CLIENT_APIS: return "OpenGL OpenGL_ES";
    case EGL_VENDOR: return "Halfplane";
    case EGL_VERSION: return "1.5";
    case EGL_EXTENSIONS:
      return "EGL_KHR_create_context EGL_KHR_get_all_proc_addresses EGL_KHR_no_config_context "
             "EGL_KHR_surfaceless_context";
    default: throw Error{EGL_BAD_PARAMETER};
  }
}

void choose(const Call& call, const Wishes& wishes, EGLConfig* configs, EGLint size, EGLint* count) {
  require(count != nullptr, EGL_BAD_PARAMETER);
  int depth = 0;
  if (const std::intptr_t pixmap = wishes.at(EGL_MATCH_NATIVE_PIXMAP); pixmap != EGL_NONE) {
    call.display.flush();
    Server* const server = call.display.server;
    const auto geometry = server == nullptr ? std::nullopt : server->geometry(static_cast<XID>(pixmap));
    require(geometry.has_value(), EGL_BAD_NATIVE_PIXMAP);
    depth = geometry->depth;
  }
  EGLint found = 0;
  // They differ in nothing that eglChooseConfig() sorts by but their numbers.
  for (EglConfig& config : call.display.configs) {
    if (!fits(kAttributes, config, wishes, EGL_CONFIG_ID) || (depth != 0 && depth != config.format.visual.depth))
      continue;
    if (configs != nullptr && found == size) break;
    if (configs != nullptr) configs[found] = &config;
    ++found;
  }
  *count = found;
}

Wishes config_wishes() {
  Wishes wishes = defaults(kAttributes);
  wishes[EGL_MATCH_NATIVE_PIXMAP] = EGL_NONE;
  return wishes;
}

void choose_config(EGLDisplay handle, const EGLint* list, EGLConfig* configs, EGLint size, EGLint* count) {
  const Call call(handle);
  Wishes wishes = config_wishes();
  require(read_list<EGL_NONE>(list, wishes) && wishes[EGL_LEVEL] != EGL_DONT_CARE, EGL_BAD_ATTRIBUTE);
  choose(call, wishes, configs, size, count);
}

void get_configs(EGLDisplay handle, EGLConfig* configs, EGLint size, EGLint* count) {
  const Call call(handle);
  Wishes wishes = config_wishes();
  wishes[EGL_SURFACE_TYPE] = 0;
  choose(call, wishes, configs, size, count);
}

void get_config_attrib(EGLDisplay handle, EGLConfig config, EGLint name, EGLint* value) {
  const Call call(handle);
  const EglConfig& of = call.config(config);
  const auto* const a = find_attribute(kAttributes, name);
  require(a != nullptr, EGL_BAD_ATTRIBUTE);
  *value = a->value(of);
}

}  // namespace

EGLDisplay get_platform_display(EGLenum platform, void* native, const EGLAttrib* list) {
  return guarded<platform_display, EGLDisplay>(platform, native, list);
}

Call::Call(EGLDisplay handle, bool must_be_initialized)
    : display([&]() -> EglDisplay& {
        for (const auto& [key, known] : displays())
          if (known.get() == handle) return *known;
        throw Error{EGL_BAD_DISPLAY};
      }()) {
  require(display.initialized || !must_be_initialized, EGL_NOT_INITIALIZED);
}

const EglConfig& Call::config(EGLConfig handle) const {
  for (const EglConfig& c : display.configs)
    if (&c == handle) return c;
  throw Error{EGL_BAD_CONFIG};
}

std::span<const Named> display_functions() {
  static const Named table[] = {
      {"eglChooseConfig", entry<choose_config>()}, {"eglGetConfigAttrib", entry<get_config_attrib>()},
      {"eglGetConfigs", entry<get_configs>()},     {"eglInitialize", entry<initialize>()},
      {"eglQueryString", entry<query_string>()},   {"eglTerminate", entry<terminate>()},
  };
  return table;
}

}  // namespace halfplane::gl::egl
