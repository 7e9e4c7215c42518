// Windows, pixmaps and pbuffers.
#include <climits>

#include "glx.hpp"

namespace halfplane::gl::glx {
namespace {

/// GLX reports no destruction of a plain X window that was made current.
void forget_gone_windows() {
  const std::lock_guard lock(objects().mutex);
  std::erase_if(objects().drawables, [](const auto& entry) {
    const auto& [key, drawable] = entry;
    return drawable->is_plain && drawable.use_count() == 1 && !key.first->geometry(key.second);
  });
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
XID create_on(Display* display, DrawableKind kind, const FbConfig& config, XID xid) {
  const bool is_window = kind == DrawableKind::window;
  XSync(display, False);
  const auto geometry = config.server->geometry(xid, is_window);
  if (!geometry) x_error(is_window ? BadWindow : BadPixmap, xid);
  if (geometry->depth != config.format.visual.depth || geometry->screen != config.screen) x_error(BadMatch, xid);
  if (is_window) {
    const std::lock_guard lock(objects().mutex);
    objects().drawables.erase({config.server, xid});  // a window that was made current without glXCreateWindow
    for (const auto& [key, drawable] : objects().drawables)
      if (key.first == config.server && drawable->window.xid == xid) x_error(BadAlloc, xid);
  }
  return keep(display, std::make_shared<GlxDrawable>(kind, config, xid, geometry->width, geometry->height));
}

/// GLX 1.4 defines no attributes of windows and pixmaps; attributes of extensions have no effect here.
template <DrawableKind Kind>
XID create(Display* display, GLXFBConfig handle, XID xid, const int*) {
  return create_on(display, Kind, config_of(display, handle), xid);
}

GLXPixmap create_glx_pixmap(Display* display, XVisualInfo* visual, Pixmap pixmap) {
  return create_on(display, DrawableKind::pixmap, config_of(display, visual), pixmap);
}

GLXPbuffer create_pbuffer(Display* display, GLXFBConfig handle, const int* list) {
  Wishes wishes{{GLX_PBUFFER_WIDTH, 0}, {GLX_PBUFFER_HEIGHT, 0}, {GLX_PRESERVED_CONTENTS, 1}, {GLX_LARGEST_PBUFFER, 0}};
  const FbConfig& config = config_of(display, handle);
  if (!read_list<0>(list, wishes) || std::ranges::any_of(wishes, [](const auto& wish) { return wish.second < 0; }))
    x_error(BadValue);
  const bool largest = wishes[GLX_LARGEST_PBUFFER] != 0;
  const auto make = [&](int width, int height) {
    return std::make_shared<GlxDrawable>(DrawableKind::pbuffer, config, 0, width, height);
  };
  const auto drawable = make_pbuffer(wishes[GLX_PBUFFER_WIDTH], wishes[GLX_PBUFFER_HEIGHT], largest, make);
  drawable->preserved = wishes[GLX_PRESERVED_CONTENTS] != 0;
  drawable->largest = largest;
  return keep(display, drawable);
}

template <DrawableKind Kind, int Error>
void destroy(Display* display, XID id) {
  const std::shared_ptr<GlxDrawable> drawable = find_drawable(display, id);
  if (drawable == nullptr || drawable->is_plain || drawable->window.kind != Kind) glx_error(Error, id);
  XSync(display, False);
  const bool is_gone = Kind == DrawableKind::window && !drawable->window.server->geometry(drawable->window.xid);
  {
    const std::lock_guard lock(objects().mutex);
    objects().drawables.erase({server_of(display), id});
  }
  if (is_gone) glx_error(Error, id);  // it went with its X window
}

void query_drawable(Display* display, GLXDrawable id, int name, unsigned* value) {
  const std::shared_ptr<GlxDrawable> drawable = find_drawable(display, id);
  Server* const server = server_of(display);
  XSync(display, False);
  const auto geometry =
      server == nullptr ? std::nullopt : server->geometry(drawable == nullptr ? id : drawable->window.xid);
  if (drawable == nullptr && !geometry) glx_error(GLXBadDrawable, id);
  const bool is_pbuffer = drawable != nullptr && drawable->window.kind == DrawableKind::pbuffer;
  const auto say = [&](int v) { *value = static_cast<unsigned>(v); };
  switch (name) {
    case GLX_WIDTH: say(geometry ? geometry->width : drawable->window.frame.width()); break;
    case GLX_HEIGHT: say(geometry ? geometry->height : drawable->window.frame.height()); break;
    case GLX_FBCONFIG_ID: say(drawable == nullptr ? 0 : drawable->config->id); break;
    case GLX_PRESERVED_CONTENTS:
      if (is_pbuffer) say(drawable->preserved);
      break;
    case GLX_LARGEST_PBUFFER:
      if (is_pbuffer) say(drawable->largest);
      break;
    case GLX_SWAP_INTERVAL_EXT: say(drawable == nullptr ? 1 : drawable->window.swap_interval); break;
    case GLX_MAX_SWAP_INTERVAL_EXT: say(INT_MAX); break;
    default: break;
  }
}

GlxDrawable& named(const std::shared_ptr<GlxDrawable>& drawable, XID id) {
  if (drawable == nullptr) glx_error(GLXBadDrawable, id);
  return *drawable;
}

void select_event(Display* display, GLXDrawable id, unsigned long mask) {
  named(find_drawable(display, id), id).window.event_mask = mask;
}
void get_selected_event(Display* display, GLXDrawable id, unsigned long* mask) {
  *mask = named(find_drawable(display, id), id).window.event_mask;
}

void swap_buffers(Display* display, GLXDrawable id) {
  XFlush(display);  // a program that waits for no event has its window mapped so
  const std::shared_ptr<GlxDrawable> drawable = find_drawable(display, id);
  if (drawable != nullptr)
    drawable->window.swap();
  else if (Server* const server = server_of(display); server == nullptr || !server->geometry(id, true))
    glx_error(GLXBadDrawable, id);
}

}  // namespace

std::shared_ptr<GlxDrawable> find_drawable(Display* display, XID id) {
  const std::lock_guard lock(objects().mutex);
  const auto found = objects().drawables.find({server_of(display), id});
  return found == objects().drawables.end() ? nullptr : found->second;
}

std::shared_ptr<GlxDrawable> drawable_for(Display* display, XID id, const GlxContext& context) {
  std::shared_ptr<GlxDrawable> drawable = find_drawable(display, id);
  const FbConfig& config = *context.config;
  if (const auto geometry = drawable == nullptr ? config.server->geometry(id, true) : std::nullopt) {
    forget_gone_windows();
    if (geometry->screen != config.screen || geometry->depth != config.format.visual.depth) x_error(BadMatch, id);
    drawable = std::make_shared<GlxDrawable>(DrawableKind::window, config, id, geometry->width, geometry->height);
    drawable->is_plain = true;
    const std::lock_guard lock(objects().mutex);
    objects().drawables[{config.server, id}] = drawable;
  }
  const FbConfig& has = *named(drawable, id).config;
  if (!has.is_of_screen(config) || has.format.visual.depth != config.format.visual.depth) x_error(BadMatch, id);
  if (!drawable->window.follow_size()) glx_error(drawable->is_plain ? GLXBadDrawable : GLXBadWindow, id);
  return drawable;
}

std::span<const Named> drawable_functions() {
  using enum DrawableKind;
  static const Named table[] = {
      {"glXCreateGLXPixmap", entry<create_glx_pixmap, X_GLXCreateGLXPixmap>()},
      {"glXCreatePbuffer", entry<create_pbuffer, X_GLXCreatePbuffer>()},
      {"glXCreatePixmap", entry<create<pixmap>, X_GLXCreatePixmap>()},
      {"glXCreateWindow", entry<create<window>, X_GLXCreateWindow>()},
      {"glXDestroyGLXPixmap", entry<destroy<pixmap, GLXBadPixmap>, X_GLXDestroyGLXPixmap>()},
      {"glXDestroyPbuffer", entry<destroy<pbuffer, GLXBadPbuffer>, X_GLXDestroyPbuffer>()},
      {"glXDestroyPixmap", entry<destroy<pixmap, GLXBadPixmap>, X_GLXDestroyPixmap>()},
      {"glXDestroyWindow", entry<destroy<window, GLXBadWindow>, X_GLXDestroyWindow>()},
      {"glXGetSelectedEvent", entry<get_selected_event, X_GLXGetDrawableAttributes>()},
      {"glXQueryDrawable", entry<query_drawable, X_GLXGetDrawableAttributes>()},
      {"glXSelectEvent", entry<select_event, X_GLXChangeDrawableAttributes>()},
      {"glXSwapBuffers", entry<swap_buffers, X_GLXSwapBuffers>()},
  };
  return table;
}

}  // namespace halfplane::gl::glx
