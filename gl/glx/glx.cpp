// The vendor library that libglvnd loads for GLX 1.4. libGLX keeps what is current in each thread and which library owns an
// object; the rest is here. GLX objects live in the program alone, so errors are made here as the X server would send them.
#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string_view>

#include "../core/commands.hpp"
#include "../core/entry_points.hpp"
#include "../core/list.hpp"
#include "../window/config_attribute.hpp"
#include "../window/window.hpp"

#include <GL/glx.h>
#include <GL/glxext.h>
#include <X11/Xlibint.h>
#include <glvnd/libglxabi.h>

#include <GL/glxproto.h>
#undef min
#undef max

namespace halfplane::gl {
namespace {

// Configurations.

struct FbConfig {
  Server* server = nullptr;
  int screen = 0, id = 0;
  PixelFormat format;
  bool shares_visual = false;  ///< another configuration is what glXGetConfig() says of the visual
};

template <int N>
int constant(const FbConfig&) {
  return N;
}

/// GLX 1.4, table 3.1, with how glXChooseFBConfig() compares and what it takes where the program does not say (table 3.4).
constexpr ConfigAttribute<FbConfig> kAttributes[] = {
    {GLX_FBCONFIG_ID, Rule::exact, kDontCare, [](const FbConfig& c) { return c.id; }},
    {GLX_BUFFER_SIZE, Rule::at_least, 0, constant<4 * kColorBits>},
    {GLX_LEVEL, Rule::level, 0, constant<0>},
    {GLX_DOUBLEBUFFER, Rule::exact, kDontCare, [](const FbConfig& c) { return c.format.double_buffered ? 1 : 0; }},
    {GLX_STEREO, Rule::exact, 0, constant<0>},
    {GLX_AUX_BUFFERS, Rule::at_least, 0, constant<0>},
    {GLX_RED_SIZE, Rule::at_least, 0, constant<kColorBits>},
    {GLX_GREEN_SIZE, Rule::at_least, 0, constant<kColorBits>},
    {GLX_BLUE_SIZE, Rule::at_least, 0, constant<kColorBits>},
    {GLX_ALPHA_SIZE, Rule::at_least, 0, constant<kColorBits>},
    {GLX_DEPTH_SIZE, Rule::at_least, 0, constant<kDepthBits>},
    {GLX_STENCIL_SIZE, Rule::at_least, 0, constant<kStencilBits>},
    {GLX_ACCUM_RED_SIZE, Rule::at_least, 0, constant<kAccumBits>},
    {GLX_ACCUM_GREEN_SIZE, Rule::at_least, 0, constant<kAccumBits>},
    {GLX_ACCUM_BLUE_SIZE, Rule::at_least, 0, constant<kAccumBits>},
    {GLX_ACCUM_ALPHA_SIZE, Rule::at_least, 0, constant<kAccumBits>},
    {GLX_SAMPLE_BUFFERS, Rule::at_least, 0, constant<0>},
    {GLX_SAMPLES, Rule::at_least, 0, constant<0>},
    {GLX_RENDER_TYPE, Rule::mask, GLX_RGBA_BIT, constant<GLX_RGBA_BIT>},
    {GLX_DRAWABLE_TYPE, Rule::mask, GLX_WINDOW_BIT, constant<GLX_WINDOW_BIT | GLX_PIXMAP_BIT | GLX_PBUFFER_BIT>},
    {GLX_X_RENDERABLE, Rule::exact, kDontCare, constant<1>},
    {GLX_X_VISUAL_TYPE, Rule::exact, kDontCare, constant<GLX_TRUE_COLOR>},
    {GLX_CONFIG_CAVEAT, Rule::exact, kDontCare, constant<GLX_NONE>},
    {GLX_TRANSPARENT_TYPE, Rule::exact, GLX_NONE, constant<GLX_NONE>},
    {GLX_TRANSPARENT_INDEX_VALUE, Rule::not_compared, kDontCare, constant<0>},
    {GLX_TRANSPARENT_RED_VALUE, Rule::not_compared, kDontCare, constant<0>},
    {GLX_TRANSPARENT_GREEN_VALUE, Rule::not_compared, kDontCare, constant<0>},
    {GLX_TRANSPARENT_BLUE_VALUE, Rule::not_compared, kDontCare, constant<0>},
    {GLX_TRANSPARENT_ALPHA_VALUE, Rule::not_compared, kDontCare, constant<0>},
    {GLX_MAX_PBUFFER_WIDTH, Rule::not_compared, kDontCare, [](const FbConfig&) { return largest_side(); }},
    {GLX_MAX_PBUFFER_HEIGHT, Rule::not_compared, kDontCare, [](const FbConfig&) { return largest_side(); }},
    {GLX_MAX_PBUFFER_PIXELS, Rule::not_compared, kDontCare,
     [](const FbConfig&) { return largest_side() * largest_side(); }},
    {GLX_VISUAL_ID, Rule::not_compared, kDontCare,
     [](const FbConfig& c) { return static_cast<int>(c.format.visual.visualid); }},
};

Server* server_of(Display* display) { return Server::open(DisplayString(display)); }

/// Of a screen, the single-buffered ones first, as glXChooseFBConfig() sorts them: they differ in nothing else that it
/// sorts by but their number.
const std::vector<FbConfig>& fb_configs(Display* display, int screen) {
  static std::mutex mutex;
  static auto* const all = new std::map<std::pair<Server*, int>, std::vector<FbConfig>>;  // handles point into it
  const std::lock_guard lock(mutex);
  Server* const server = server_of(display);
  std::vector<FbConfig>& configs = (*all)[{server, screen}];
  if (!configs.empty() || server == nullptr || screen < 0 || screen >= server->screens()) return configs;
  std::set<VisualID> seen;
  for (const PixelFormat& format : server->formats(screen))
    configs.push_back(
        {server, screen, static_cast<int>(configs.size()) + 1, format, !seen.insert(format.visual.visualid).second});
  std::ranges::stable_sort(configs, {}, [](const FbConfig& c) { return c.format.double_buffered; });
  return configs;
}

const FbConfig* find_config(Display* display, GLXFBConfig handle) {
  for (int screen = 0; screen < ScreenCount(display); ++screen)
    for (const FbConfig& config : fb_configs(display, screen))
      if (reinterpret_cast<GLXFBConfig>(const_cast<FbConfig*>(&config)) == handle) return &config;
  return nullptr;
}

const FbConfig* config_of_visual(Display* display, const XVisualInfo* visual) {
  if (visual != nullptr)
    for (const FbConfig& config : fb_configs(display, visual->screen))
      if (config.format.visual.visualid == visual->visualid && !config.shares_visual) return &config;
  return nullptr;
}

XVisualInfo* visual_of(Display* display, const FbConfig& config) {
  XVisualInfo wanted{};
  wanted.screen = config.screen;
  wanted.visualid = config.format.visual.visualid;
  int count = 0;
  return XGetVisualInfo(display, VisualScreenMask | VisualIDMask, &wanted, &count);
}

using Wishes = std::map<int, int>;  // by name

std::vector<const FbConfig*> matching(Display* display, int screen, const Wishes& wishes) {
  std::vector<const FbConfig*> result;
  for (const FbConfig& config : fb_configs(display, screen))
    if (fits(kAttributes, config, wishes, GLX_FBCONFIG_ID)) result.push_back(&config);
  return result;
}

// Contexts and drawables.

struct GlxDrawable {
  GlxDrawable(DrawableKind kind, const FbConfig& its_config, XID xid, int width, int height)
      : window(kind, its_config.server, xid, its_config.format, width, height), config(&its_config) {}
  Window window;
  const FbConfig* config;
  bool is_plain = false;  ///< an X window that was made current as it is
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
Objects& objects() {
  static Objects* const objects = new Objects;  // threads may outlive main()
  return *objects;
}

GlxContext* here() { return static_cast<GlxContext*>(current()); }

/// Null where it is none.
GlxContext* find_context(GLXContext handle) {
  const std::lock_guard lock(objects().mutex);
  const auto found = objects().contexts.find(reinterpret_cast<GlxContext*>(handle));
  return found == objects().contexts.end() ? nullptr : *found;
}

std::shared_ptr<GlxDrawable> find_drawable(Display* display, XID id) {
  const std::lock_guard lock(objects().mutex);
  const auto found = objects().drawables.find({server_of(display), id});
  return found == objects().drawables.end() ? nullptr : found->second;
}

/// Sends an error to the program's handler. `code` from `GLXBadContext` on where `is_glx`, else that of the X protocol.
void raise_error(Display* display, int code, bool is_glx, XID resource, int minor) {
  int opcode = 0, event = 0, first_error = 0;
  if (XQueryExtension(display, "GLX", &opcode, &event, &first_error) == 0 && is_glx) return;
  xError error{};
  error.type = X_Error;
  error.errorCode = static_cast<BYTE>(is_glx ? first_error + code : code);
  error.resourceID = static_cast<CARD32>(resource);
  error.minorCode = static_cast<CARD16>(minor);
  error.majorCode = static_cast<BYTE>(opcode);
  LockDisplay(display);
  error.sequenceNumber = static_cast<CARD16>(display->request);
  _XError(display, &error);
  UnlockDisplay(display);
}
std::nullptr_t x_error(Display* display, int code, XID resource, int minor) {
  raise_error(display, code, false, resource, minor);
  return nullptr;
}
std::nullptr_t glx_error(Display* display, int code, XID resource, int minor) {
  raise_error(display, code, true, resource, minor);
  return nullptr;
}

/// Precondition: the objects are locked.
void delete_context(GlxContext* context) {
  objects().contexts.erase(context);
  delete context;
}

void leave_thread(GlxContext* context) {
  if (context == nullptr) return;
  const std::lock_guard lock(objects().mutex);
  context->is_current = false;
  context->drawable = context->read_drawable = nullptr;
  context->draw = context->read = nullptr;
  if (context->is_destroyed) delete_context(context);
}

/// A thread that ends with a current context leaves it to others.
struct ThreadEnd {
  ~ThreadEnd() { leave_thread(here()); }
};

/// No call says that an X window which was made current as it is has been destroyed.
void forget_gone_windows() {
  const std::lock_guard lock(objects().mutex);
  std::erase_if(objects().drawables, [](const auto& entry) {
    const auto& [key, drawable] = entry;
    return drawable->is_plain && drawable.use_count() == 1 && !key.first->geometry(key.second);
  });
}

/// The drawable of `id`; an X window that no call has named becomes one. Null: an error has been raised.
std::shared_ptr<GlxDrawable> drawable_for(Display* display, XID id, const GlxContext& context, int minor) {
  std::shared_ptr<GlxDrawable> drawable = find_drawable(display, id);
  try {
    const auto geometry = drawable == nullptr ? context.config->server->window_geometry(id) : std::nullopt;
    if (geometry) {
      forget_gone_windows();
      drawable =
          std::make_shared<GlxDrawable>(DrawableKind::window, *context.config, id, geometry->width, geometry->height);
      if (geometry->screen != context.config->screen || geometry->depth != context.config->format.visual.depth)
        return x_error(display, BadMatch, id, minor);
      drawable->is_plain = true;
      const std::lock_guard lock(objects().mutex);
      objects().drawables[{context.config->server, id}] = drawable;
    }
  } catch (const std::exception&) {
    return x_error(display, BadAlloc, id, minor);
  }
  if (drawable == nullptr) return glx_error(display, GLXBadDrawable, id, minor);
  const FbConfig& has = *drawable->config;
  if (has.server != context.config->server || has.screen != context.config->screen ||
      has.format.visual.depth != context.config->format.visual.depth)
    return x_error(display, BadMatch, id, minor);
  if (drawable->window.follow_size()) return drawable;
  return glx_error(display, drawable->is_plain ? GLXBadDrawable : GLXBadWindow, id, minor);
}

Bool make_current(Display* display, GLXDrawable draw, GLXDrawable read, GLXContext handle, int minor) {
  thread_local ThreadEnd at_end;
  static_cast<void>(at_end);
  GlxContext* const before = here();
  if (before != nullptr && before->render_mode != GL_RENDER) {
    glx_error(display, GLXBadContextState, 0, minor);
    return False;
  }
  if (handle == nullptr && draw == 0 && read == 0) {
    gl::make_current(nullptr, nullptr, nullptr);
    leave_thread(before);
    return True;
  }
  GlxContext* const context = find_context(handle);
  if (handle == nullptr || (context != nullptr && (draw == 0 || read == 0)))
    x_error(display, BadMatch, 0, minor);
  else if (context == nullptr || context->is_destroyed)
    glx_error(display, GLXBadContext, 0, minor);
  else if (context->is_current && context != before)
    x_error(display, BadAccess, 0, minor);
  else {
    XSync(display, False);  // the driver's own connection is to know the program's windows
    const std::shared_ptr<GlxDrawable> to = drawable_for(display, draw, *context, minor);
    const std::shared_ptr<GlxDrawable> from =
        to == nullptr || read == draw ? to : drawable_for(display, read, *context, minor);
    if (from == nullptr) return False;
    gl::make_current(context, &to->window, &from->window);
    if (before != context) leave_thread(before);
    const std::lock_guard lock(objects().mutex);
    context->is_current = true;
    context->display = display;
    context->draw = to;
    context->read = from;
    return True;
  }
  return False;
}

GLXContext create_context(Display* display, const FbConfig& config, GLXContext share, int minor) {
  const GlxContext* const other = find_context(share);
  if (share != nullptr && other == nullptr) return glx_error(display, GLXBadContext, 0, minor);
  if (other != nullptr && (other->config->server != config.server || other->config->screen != config.screen))
    return x_error(display, BadMatch, 0, minor);
  try {
    auto context = other == nullptr ? std::make_unique<GlxContext>() : std::make_unique<GlxContext>(other->shared);
    context->display = display;
    context->config = &config;
    const std::lock_guard lock(objects().mutex);
    objects().contexts.insert(context.get());
    return reinterpret_cast<GLXContext>(context.release());
  } catch (const std::bad_alloc&) {
    return x_error(display, BadAlloc, 0, minor);
  }
}

XID keep(Display* display, std::shared_ptr<GlxDrawable> drawable) {
  LockDisplay(display);
  const XID id = XAllocID(display);
  UnlockDisplay(display);
  const std::lock_guard lock(objects().mutex);
  objects().drawables[{drawable->config->server, id}] = std::move(drawable);
  return id;
}

/// A GLXWindow or GLXPixmap of an X window or pixmap.
XID create_on(Display* display, DrawableKind kind, const FbConfig& config, XID xid, int minor) {
  const bool is_window = kind == DrawableKind::window;
  XSync(display, False);
  const auto geometry = is_window ? config.server->window_geometry(xid) : config.server->geometry(xid);
  if (!geometry)
    x_error(display, is_window ? BadWindow : BadPixmap, xid, minor);
  else if (geometry->depth != config.format.visual.depth || geometry->screen != config.screen)
    x_error(display, BadMatch, xid, minor);
  else {
    try {
      const auto is_taken = [&] {
        const std::lock_guard lock(objects().mutex);
        objects().drawables.erase({config.server, xid});  // of a window that was made current as it is
        return std::ranges::any_of(objects().drawables, [&](const auto& entry) {
          return entry.first.first == config.server && entry.second->window.xid == xid;
        });
      };
      if (is_window && is_taken()) return x_error(display, BadAlloc, xid, minor), 0;
      return keep(display, std::make_shared<GlxDrawable>(kind, config, xid, geometry->width, geometry->height));
    } catch (const std::exception&) {
      x_error(display, BadAlloc, xid, minor);
    }
  }
  return 0;
}

void destroy(Display* display, XID id, DrawableKind kind, int error, int minor) {
  const std::shared_ptr<GlxDrawable> drawable = find_drawable(display, id);
  if (drawable == nullptr || drawable->is_plain || drawable->window.kind != kind) {
    glx_error(display, error, id, minor);
    return;
  }
  XSync(display, False);
  const bool is_gone = kind == DrawableKind::window && !drawable->window.server->geometry(drawable->window.xid);
  {
    const std::lock_guard lock(objects().mutex);
    objects().drawables.erase({server_of(display), id});
  }
  if (is_gone) glx_error(display, error, id, minor);  // it went with its X window
}

// GLX 1.4, in the order of its functions' names.

XVisualInfo* glx_choose_visual(Display* display, int screen, int* list) {
  Wishes wishes{{GLX_DOUBLEBUFFER, 0}, {GLX_DRAWABLE_TYPE, GLX_WINDOW_BIT}};
  bool rgba = false;
  for (; list != nullptr && *list != 0; ++list) switch (*list) {
      case GLX_USE_GL: break;
      case GLX_RGBA: rgba = true; break;
      case GLX_DOUBLEBUFFER:
      case GLX_STEREO: wishes[*list] = 1; break;
      default:
        if (find_attribute(kAttributes, *list) == nullptr) return nullptr;
        wishes[list[0]] = list[1];
        ++list;
    }
  if (!rgba) return nullptr;  // there are no colour indices
  for (const FbConfig* config : matching(display, screen, wishes))
    if (!config->shares_visual) return visual_of(display, *config);
  return nullptr;
}

void glx_copy_context(Display* display, GLXContext source, GLXContext destination, unsigned long mask) {
  GlxContext* const from = find_context(source);
  GlxContext* const to = find_context(destination);
  if (from == nullptr || to == nullptr)
    glx_error(display, GLXBadContext, 0, X_GLXCopyContext);
  else if (from->config->server != to->config->server || from->config->screen != to->config->screen)
    x_error(display, BadMatch, 0, X_GLXCopyContext);
  else if (to->is_current)
    x_error(display, BadAccess, 0, X_GLXCopyContext);
  else {
    // What glPushAttrib saves of one, glPopAttrib gives to the other.
    std::vector<SavedAttributes> stack;
    stack.swap(from->attributes);
    push_attrib(*from, static_cast<GLbitfield>(mask));
    to->attributes.push_back(std::move(from->attributes.back()));
    stack.swap(from->attributes);
    pop_attrib(*to);
    ++to->revision;
  }
}

GLXContext glx_create_context(Display* display, XVisualInfo* visual, GLXContext share, Bool) {
  const FbConfig* const config = config_of_visual(display, visual);
  return config == nullptr ? x_error(display, BadValue, 0, X_GLXCreateContext)
                           : create_context(display, *config, share, X_GLXCreateContext);
}

GLXContext glx_create_new_context(Display* display, GLXFBConfig handle, int render_type, GLXContext share, Bool) {
  const FbConfig* const config = find_config(display, handle);
  if (config == nullptr) return glx_error(display, GLXBadFBConfig, 0, X_GLXCreateNewContext);
  if (render_type != GLX_RGBA_TYPE)
    return x_error(display, render_type == GLX_COLOR_INDEX_TYPE ? BadMatch : BadValue, 0, X_GLXCreateNewContext);
  return create_context(display, *config, share, X_GLXCreateNewContext);
}

GLXContext glx_create_context_attribs_arb(Display* display, GLXFBConfig handle, GLXContext share, Bool,
                                          const int* list) {
  constexpr int kMinor = X_GLXCreateContextAttribsARB;
  const FbConfig* const config = find_config(display, handle);
  if (config == nullptr) return glx_error(display, GLXBadFBConfig, 0, kMinor);
  Wishes wishes{{GLX_CONTEXT_MAJOR_VERSION_ARB, 1},
                {GLX_CONTEXT_MINOR_VERSION_ARB, 0},
                {GLX_CONTEXT_FLAGS_ARB, 0},
                {GLX_CONTEXT_PROFILE_MASK_ARB, GLX_CONTEXT_CORE_PROFILE_BIT_ARB},
                {GLX_RENDER_TYPE, GLX_RGBA_TYPE}};
  for (; list != nullptr && *list != 0; list += 2) {
    const auto wish = wishes.find(list[0]);
    if (wish == wishes.end()) return x_error(display, BadValue, 0, kMinor);
    wish->second = list[1];
  }
  const int major = wishes[GLX_CONTEXT_MAJOR_VERSION_ARB], minor = wishes[GLX_CONTEXT_MINOR_VERSION_ARB];
  const int flags = wishes[GLX_CONTEXT_FLAGS_ARB], profile = wishes[GLX_CONTEXT_PROFILE_MASK_ARB];
  constexpr int kLastMinor[] = {-1, 5, 1, 3, 6};  // of OpenGL 1, 2, 3, 4
  if ((flags & ~(GLX_CONTEXT_DEBUG_BIT_ARB | GLX_CONTEXT_FORWARD_COMPATIBLE_BIT_ARB)) != 0)
    return x_error(display, BadValue, 0, kMinor);
  const int render_type = wishes[GLX_RENDER_TYPE];
  if (render_type != GLX_RGBA_TYPE && render_type != GLX_COLOR_INDEX_TYPE) return x_error(display, BadValue, 0, kMinor);
  if (major < 1 || major > 4 || minor < 0 || minor > kLastMinor[major] || render_type != GLX_RGBA_TYPE ||
      ((flags & GLX_CONTEXT_FORWARD_COMPATIBLE_BIT_ARB) != 0 && major < 3))
    return x_error(display, BadMatch, 0, kMinor);
  if (profile != GLX_CONTEXT_CORE_PROFILE_BIT_ARB && profile != GLX_CONTEXT_COMPATIBILITY_PROFILE_BIT_ARB)
    return glx_error(display, GLXBadProfileARB, 0, kMinor);
  if (major > 1) return glx_error(display, GLXBadFBConfig, 0, kMinor);
  return create_context(display, *config, share, kMinor);
}

void glx_destroy_context(Display* display, GLXContext handle) {
  GlxContext* const context = find_context(handle);
  if (context == nullptr) {
    glx_error(display, GLXBadContext, 0, X_GLXDestroyContext);
    return;
  }
  const std::lock_guard lock(objects().mutex);
  context->is_destroyed = true;
  if (!context->is_current) delete_context(context);
}

GLXPixmap glx_create_glx_pixmap(Display* display, XVisualInfo* visual, Pixmap pixmap) {
  const FbConfig* const config = config_of_visual(display, visual);
  if (config != nullptr) return create_on(display, DrawableKind::pixmap, *config, pixmap, X_GLXCreateGLXPixmap);
  x_error(display, BadValue, 0, X_GLXCreateGLXPixmap);
  return 0;
}

/// GLX 1.4 defines no attributes of windows and pixmaps; what extensions define of them changes nothing here.
template <DrawableKind Kind, int Minor>
XID glx_create_on(Display* display, GLXFBConfig handle, XID xid, const int*) {
  if (const FbConfig* const config = find_config(display, handle); config != nullptr)
    return create_on(display, Kind, *config, xid, Minor);
  glx_error(display, GLXBadFBConfig, 0, Minor);
  return 0;
}

GLXPbuffer glx_create_pbuffer(Display* display, GLXFBConfig handle, const int* list) {
  constexpr int kMinor = X_GLXCreatePbuffer;
  Wishes wishes{{GLX_PBUFFER_WIDTH, 0}, {GLX_PBUFFER_HEIGHT, 0}, {GLX_PRESERVED_CONTENTS, 1}, {GLX_LARGEST_PBUFFER, 0}};
  const FbConfig* const config = find_config(display, handle);
  if (config == nullptr) return glx_error(display, GLXBadFBConfig, 0, kMinor), 0;
  for (; list != nullptr && *list != 0; list += 2) {
    const auto wish = wishes.find(list[0]);
    if (wish == wishes.end() || list[1] < 0) return x_error(display, BadValue, 0, kMinor), 0;
    wish->second = list[1];
  }
  const bool largest = wishes[GLX_LARGEST_PBUFFER] != 0;
  const int most = largest ? largest_side() : INT_MAX;
  int width = std::clamp(wishes[GLX_PBUFFER_WIDTH], 1, most), height = std::clamp(wishes[GLX_PBUFFER_HEIGHT], 1, most);
  for (;; width -= width / 2, height -= height / 2) {
    try {
      auto drawable = std::make_shared<GlxDrawable>(DrawableKind::pbuffer, *config, 0, width, height);
      drawable->preserved = wishes[GLX_PRESERVED_CONTENTS] != 0;
      drawable->largest = largest;
      return keep(display, std::move(drawable));
    } catch (const std::exception&) {
      if (!largest || (width == 1 && height == 1)) return x_error(display, BadAlloc, 0, kMinor), 0;
    }
  }
}

template <DrawableKind Kind, int Error, int Minor>
void glx_destroy(Display* display, XID id) {
  destroy(display, id, Kind, Error, Minor);
}

template <class Configs>
GLXFBConfig* handles(const Configs& configs, int* count) {
  *count = static_cast<int>(configs.size());
  if (configs.empty()) return nullptr;
  auto* const result = static_cast<GLXFBConfig*>(Xmalloc(sizeof(GLXFBConfig) * configs.size()));
  if (result != nullptr)
    std::ranges::transform(configs, result, [](const FbConfig* config) {
      return reinterpret_cast<GLXFBConfig>(const_cast<FbConfig*>(config));
    });
  return result;
}

GLXFBConfig* glx_choose_fb_config(Display* display, int screen, const int* list, int* count) {
  Wishes wishes;
  *count = 0;
  for (; list != nullptr && *list != 0; list += 2) {
    if (find_attribute(kAttributes, list[0]) == nullptr) return nullptr;
    wishes[list[0]] = list[1];
  }
  return handles(matching(display, screen, wishes), count);
}

GLXFBConfig* glx_get_fb_configs(Display* display, int screen, int* count) {
  std::vector<const FbConfig*> all;
  for (const FbConfig& config : fb_configs(display, screen)) all.push_back(&config);
  return handles(all, count);
}

int glx_get_fb_config_attrib(Display* display, GLXFBConfig handle, int name, int* value) {
  const FbConfig* const config = find_config(display, handle);
  const auto* const a = find_attribute(kAttributes, name);
  if (config == nullptr || a == nullptr) {
    if (config == nullptr) glx_error(display, GLXBadFBConfig, 0, X_GLXGetFBConfigs);
    return GLX_BAD_ATTRIBUTE;
  }
  *value = a->value(*config);
  return 0;
}

XVisualInfo* glx_get_visual_from_fb_config(Display* display, GLXFBConfig handle) {
  const FbConfig* const config = find_config(display, handle);
  return config == nullptr ? glx_error(display, GLXBadFBConfig, 0, X_GLXGetFBConfigs) : visual_of(display, *config);
}

int glx_get_config(Display* display, XVisualInfo* visual, int name, int* value) {
  const FbConfig* const config = config_of_visual(display, visual);
  if (name == GLX_USE_GL || (config != nullptr && name == GLX_RGBA)) {
    *value = config != nullptr ? 1 : 0;
    return 0;
  }
  if (config == nullptr) return GLX_BAD_VISUAL;
  return glx_get_fb_config_attrib(display, reinterpret_cast<GLXFBConfig>(const_cast<FbConfig*>(config)), name, value);
}

Bool glx_is_direct(Display* display, GLXContext handle) {
  if (find_context(handle) != nullptr) return True;
  glx_error(display, GLXBadContext, 0, X_GLXIsDirect);
  return False;
}

Bool glx_make_current(Display* display, GLXDrawable drawable, GLXContext context) {
  return make_current(display, drawable, drawable, context, X_GLXMakeCurrent);
}

Bool glx_make_context_current(Display* display, GLXDrawable draw, GLXDrawable read, GLXContext context) {
  return make_current(display, draw, read, context, X_GLXMakeContextCurrent);
}

int glx_query_context(Display* display, GLXContext handle, int name, int* value) {
  const GlxContext* const context = find_context(handle);
  if (context == nullptr) {
    glx_error(display, GLXBadContext, 0, X_GLXQueryContext);
    return GLX_BAD_CONTEXT;
  }
  switch (name) {
    case GLX_FBCONFIG_ID: *value = context->config->id; return 0;
    case GLX_RENDER_TYPE: *value = GLX_RGBA_TYPE; return 0;
    case GLX_SCREEN: *value = context->config->screen; return 0;
    default: return GLX_BAD_ATTRIBUTE;
  }
}

void glx_query_drawable(Display* display, GLXDrawable id, int name, unsigned* value) {
  const std::shared_ptr<GlxDrawable> drawable = find_drawable(display, id);
  Server* const server = server_of(display);
  XSync(display, False);
  const auto geometry =
      server == nullptr ? std::nullopt : server->geometry(drawable == nullptr ? id : drawable->window.xid);
  if (drawable == nullptr && !geometry) {
    glx_error(display, GLXBadDrawable, id, X_GLXGetDrawableAttributes);
    return;
  }
  const bool is_pbuffer = drawable != nullptr && drawable->window.kind == DrawableKind::pbuffer;
  switch (name) {
    case GLX_WIDTH: *value = static_cast<unsigned>(geometry ? geometry->width : drawable->window.frame.width()); break;
    case GLX_HEIGHT:
      *value = static_cast<unsigned>(geometry ? geometry->height : drawable->window.frame.height());
      break;
    case GLX_FBCONFIG_ID: *value = drawable == nullptr ? 0 : static_cast<unsigned>(drawable->config->id); break;
    case GLX_PRESERVED_CONTENTS:
      if (is_pbuffer) *value = drawable->preserved ? 1 : 0;
      break;
    case GLX_LARGEST_PBUFFER:
      if (is_pbuffer) *value = drawable->largest ? 1 : 0;
      break;
    case GLX_SWAP_INTERVAL_EXT:
      *value = drawable == nullptr ? 1 : static_cast<unsigned>(drawable->window.swap_interval);
      break;
    case GLX_MAX_SWAP_INTERVAL_EXT: *value = INT_MAX; break;
    default: break;
  }
}

constexpr char kExtensions[] =
    "GLX_ARB_create_context GLX_ARB_create_context_profile GLX_ARB_get_proc_address GLX_ARB_multisample "
    "GLX_EXT_swap_control GLX_EXT_visual_info GLX_EXT_visual_rating GLX_MESA_swap_control GLX_SGI_swap_control";

const char* glx_get_client_string(Display*, int name) {
  return name == GLX_VENDOR       ? "Halfplane"
         : name == GLX_VERSION    ? "1.4"
         : name == GLX_EXTENSIONS ? kExtensions
                                  : nullptr;
}
const char* glx_query_server_string(Display* display, int, int name) { return glx_get_client_string(display, name); }
const char* glx_query_extensions_string(Display*, int) { return kExtensions; }

void glx_select_event(Display* display, GLXDrawable id, unsigned long mask) {
  if (const auto drawable = find_drawable(display, id); drawable != nullptr)
    drawable->window.event_mask = mask;
  else
    glx_error(display, GLXBadDrawable, id, X_GLXChangeDrawableAttributes);
}

void glx_get_selected_event(Display* display, GLXDrawable id, unsigned long* mask) {
  if (const auto drawable = find_drawable(display, id); drawable != nullptr)
    *mask = drawable->window.event_mask;
  else
    glx_error(display, GLXBadDrawable, id, X_GLXGetDrawableAttributes);
}

void glx_swap_buffers(Display* display, GLXDrawable id) {
  XFlush(display);  // a program that waits for no event has its window mapped so
  const std::shared_ptr<GlxDrawable> drawable = find_drawable(display, id);
  if (drawable != nullptr)
    drawable->window.swap();
  else if (Server* const server = server_of(display); server == nullptr || !server->window_geometry(id))
    glx_error(display, GLXBadDrawable, id, X_GLXSwapBuffers);
}

/// A list that draws character `c`: its box in the font is [lbearing, rbearing) x [-descent, ascent).
void compile_character(Context& context, Display* display, GC gc, Pixmap pixmap, const XCharStruct& box, unsigned c) {
  auto bits = std::make_shared<Bitmap>();
  bits->width = std::max(0, box.rbearing - box.lbearing);
  bits->height = std::max(0, box.ascent + box.descent);
  bits->bit.resize(static_cast<std::size_t>(bits->width) * static_cast<std::size_t>(bits->height));
  const auto width = static_cast<unsigned>(bits->width), height = static_cast<unsigned>(bits->height);
  XImage* image = nullptr;
  if (!bits->bit.empty()) {
    const XChar2b text{static_cast<unsigned char>(c >> 8), static_cast<unsigned char>(c & 255)};
    XSetForeground(display, gc, 0);
    XFillRectangle(display, pixmap, gc, 0, 0, width, height);
    XSetForeground(display, gc, 1);
    XDrawString16(display, pixmap, gc, -box.lbearing, box.ascent, &text, 1);
    image = XGetImage(display, pixmap, 0, 0, width, height, 1, XYPixmap);
  }
  if (image != nullptr) {
    for (int y = 0; y < bits->height; ++y)
      for (int x = 0; x < bits->width; ++x)
        bits->bit[static_cast<std::size_t>(bits->height - 1 - y) * width + static_cast<std::size_t>(x)] =
            XGetPixel(image, x, y) != 0;
    XDestroyImage(image);
  }
  issue<&bitmap>(context, std::shared_ptr<const Bitmap>(bits), -static_cast<double>(box.lbearing),
                 static_cast<double>(box.descent), static_cast<double>(box.width), 0.0);
}

void glx_use_x_font(Font font, int first, int count, int list_base) {
  GlxContext* const context = here();
  if (context == nullptr) return;
  Display* const display = context->display;
  if (context->inside_begin() || context->compiling != nullptr || context->draw == nullptr) {
    glx_error(display, GLXBadContextState, 0, X_GLXUseXFont);
    return;
  }
  XFontStruct* const info = XQueryFont(display, font);
  if (info == nullptr) return;  // BadFont came from the server
  const int width = std::max(1, info->max_bounds.rbearing - info->min_bounds.lbearing);
  const int height = std::max(1, info->max_bounds.ascent + info->max_bounds.descent);
  const Pixmap pixmap = XCreatePixmap(display, RootWindow(display, context->config->screen),
                                      static_cast<unsigned>(width), static_cast<unsigned>(height), 1);
  const GC gc = XCreateGC(display, pixmap, 0, nullptr);
  XSetFont(display, gc, font);
  const unsigned columns = info->max_char_or_byte2 - info->min_char_or_byte2 + 1;
  for (int i = 0; i < count; ++i) {
    const auto c = static_cast<unsigned>(first + i);
    const unsigned row = c >> 8, column = info->max_byte1 == 0 ? c : c & 255;
    XCharStruct box{};
    if (column >= info->min_char_or_byte2 && column <= info->max_char_or_byte2 &&
        (info->max_byte1 == 0 || (row >= info->min_byte1 && row <= info->max_byte1)))
      box = info->per_char == nullptr ? info->max_bounds
                                      : info->per_char[(info->max_byte1 == 0 ? 0 : row - info->min_byte1) * columns +
                                                       column - info->min_char_or_byte2];
    new_list(*context, static_cast<GLuint>(list_base + i), GL_COMPILE);
    compile_character(*context, display, gc, pixmap, box, c);
    end_list(*context);
  }
  XFreeGC(display, gc);
  XFreePixmap(display, pixmap);
  XFreeFontInfo(nullptr, info, 1);
}

void glx_wait_gl() {
  if (GlxContext* const context = here(); context != nullptr) finish(*context);
}

void glx_wait_x() {
  if (GlxContext* const context = here(); context != nullptr) XSync(context->display, False);
}

// Extensions: what a program calls, and how libGLX finds this library for it.

const __GLXapiExports* g_exports = nullptr;

void glx_swap_interval_ext(Display* display, GLXDrawable id, int interval) {
  const std::shared_ptr<GlxDrawable> drawable = find_drawable(display, id);
  if (interval < 0)
    x_error(display, BadValue, static_cast<XID>(interval), X_GLXVendorPrivate);
  else if (drawable == nullptr)
    x_error(display, BadWindow, id, X_GLXVendorPrivate);
  else
    drawable->window.swap_interval = interval;
}

int glx_swap_interval_mesa(unsigned interval) {
  if (interval > INT_MAX) return GLX_BAD_VALUE;
  if (here() == nullptr) return GLX_BAD_CONTEXT;
  here()->draw->window.swap_interval = static_cast<int>(interval);
  return 0;
}

int glx_swap_interval_sgi(int interval) {
  return interval <= 0 ? GLX_BAD_VALUE : glx_swap_interval_mesa(static_cast<unsigned>(interval));
}

int glx_get_swap_interval_mesa() { return here() == nullptr ? 0 : here()->draw->window.swap_interval; }

int g_index[4];

template <int Slot, auto Function, class Result, class... Args>
Result call(__GLXvendorInfo* vendor, Args... args) {
  const auto found = vendor == nullptr ? nullptr : g_exports->fetchDispatchEntry(vendor, g_index[Slot]);
  return found == nullptr ? Result() : reinterpret_cast<decltype(Function)>(found)(args...);
}

void dispatch_swap_ext(Display* display, GLXDrawable drawable, int interval) {
  call<0, &glx_swap_interval_ext, void>(g_exports->vendorFromDrawable(display, drawable), display, drawable, interval);
}
int dispatch_swap_mesa(unsigned interval) {
  return call<1, &glx_swap_interval_mesa, int>(g_exports->getCurrentDynDispatch(), interval);
}
int dispatch_swap_sgi(int interval) {
  return call<2, &glx_swap_interval_sgi, int>(g_exports->getCurrentDynDispatch(), interval);
}
int dispatch_get_swap_mesa() { return call<3, &glx_get_swap_interval_mesa, int>(g_exports->getCurrentDynDispatch()); }

template <class Function>
void* address(Function* function) {
  return reinterpret_cast<void*>(function);
}

struct Named {
  std::string_view name;
  void* function;
  void* dispatch = nullptr;  ///< of extensions, by their place in g_index
};

std::span<const Named> functions() {
  constexpr auto kWindow = DrawableKind::window;
  constexpr auto kPixmap = DrawableKind::pixmap;
  constexpr auto kPbuffer = DrawableKind::pbuffer;
  static const Named table[] = {
      {"glXSwapIntervalEXT", address(glx_swap_interval_ext), address(dispatch_swap_ext)},
      {"glXSwapIntervalMESA", address(glx_swap_interval_mesa), address(dispatch_swap_mesa)},
      {"glXSwapIntervalSGI", address(glx_swap_interval_sgi), address(dispatch_swap_sgi)},
      {"glXGetSwapIntervalMESA", address(glx_get_swap_interval_mesa), address(dispatch_get_swap_mesa)},
      {"glXChooseFBConfig", address(glx_choose_fb_config)},
      {"glXChooseVisual", address(glx_choose_visual)},
      {"glXCopyContext", address(glx_copy_context)},
      {"glXCreateContext", address(glx_create_context)},
      {"glXCreateContextAttribsARB", address(glx_create_context_attribs_arb)},
      {"glXCreateGLXPixmap", address(glx_create_glx_pixmap)},
      {"glXCreateNewContext", address(glx_create_new_context)},
      {"glXCreatePbuffer", address(glx_create_pbuffer)},
      {"glXCreatePixmap", address(glx_create_on<kPixmap, X_GLXCreatePixmap>)},
      {"glXCreateWindow", address(glx_create_on<kWindow, X_GLXCreateWindow>)},
      {"glXDestroyContext", address(glx_destroy_context)},
      {"glXDestroyGLXPixmap", address(glx_destroy<kPixmap, GLXBadPixmap, X_GLXDestroyGLXPixmap>)},
      {"glXDestroyPbuffer", address(glx_destroy<kPbuffer, GLXBadPbuffer, X_GLXDestroyPbuffer>)},
      {"glXDestroyPixmap", address(glx_destroy<kPixmap, GLXBadPixmap, X_GLXDestroyPixmap>)},
      {"glXDestroyWindow", address(glx_destroy<kWindow, GLXBadWindow, X_GLXDestroyWindow>)},
      {"glXGetClientString", address(glx_get_client_string)},
      {"glXGetConfig", address(glx_get_config)},
      {"glXGetFBConfigAttrib", address(glx_get_fb_config_attrib)},
      {"glXGetFBConfigs", address(glx_get_fb_configs)},
      {"glXGetSelectedEvent", address(glx_get_selected_event)},
      {"glXGetVisualFromFBConfig", address(glx_get_visual_from_fb_config)},
      {"glXIsDirect", address(glx_is_direct)},
      {"glXMakeContextCurrent", address(glx_make_context_current)},
      {"glXMakeCurrent", address(glx_make_current)},
      {"glXQueryContext", address(glx_query_context)},
      {"glXQueryDrawable", address(glx_query_drawable)},
      {"glXQueryExtensionsString", address(glx_query_extensions_string)},
      {"glXQueryServerString", address(glx_query_server_string)},
      {"glXSelectEvent", address(glx_select_event)},
      {"glXSwapBuffers", address(glx_swap_buffers)},
      {"glXUseXFont", address(glx_use_x_font)},
      {"glXWaitGL", address(glx_wait_gl)},
      {"glXWaitX", address(glx_wait_x)},
  };
  return table;
}

std::string_view text(const GLubyte* name) { return reinterpret_cast<const char*>(name); }

const Named* find_function(const GLubyte* name) {
  const auto found = std::ranges::find(functions(), text(name), &Named::name);
  return found == functions().end() ? nullptr : &*found;
}

Bool is_screen_supported(Display* display, int screen) { return fb_configs(display, screen).empty() ? False : True; }

void* get_proc_address(const GLubyte* name) {
  const Named* const own = find_function(name);
  return own != nullptr ? own->function : const_cast<void*>(entry_point(text(name)));
}

void* get_dispatch_address(const GLubyte* name) {
  const Named* const own = find_function(name);
  return own != nullptr ? own->dispatch : nullptr;
}

void set_dispatch_index(const GLubyte* name, int index) {
  const Named* const own = find_function(name);
  if (own != nullptr && own->dispatch != nullptr) g_index[own - functions().data()] = index;
}

}  // namespace
}  // namespace halfplane::gl

extern "C" __attribute__((visibility("default"))) Bool __glx_Main(uint32_t version, const __GLXapiExports* exports,
                                                                  __GLXvendorInfo*, __GLXapiImports* imports) {
  if (GLX_VENDOR_ABI_GET_MAJOR_VERSION(version) != GLX_VENDOR_ABI_MAJOR_VERSION || !halfplane::gl::answers("GLX"))
    return False;
  halfplane::gl::g_exports = exports;
  imports->isScreenSupported = halfplane::gl::is_screen_supported;
  imports->getProcAddress = halfplane::gl::get_proc_address;
  imports->getDispatchAddress = halfplane::gl::get_dispatch_address;
  imports->setDispatchIndex = halfplane::gl::set_dispatch_index;
  return True;
}
