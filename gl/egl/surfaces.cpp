// Surfaces: windows, pixmaps, pbuffers.
#include <utility>

#include "egl.hpp"

namespace halfplane::gl::egl {
namespace {

void* keep(EglDisplay& display, std::shared_ptr<Surface> surface) {
  void* const handle = surface.get();
  display.surfaces[handle] = std::move(surface);
  return handle;
}

/// Attributes of every surface. There is no other colour space than the linear one, and no OpenVG.
Wishes surface_wishes() {
  return {{EGL_GL_COLORSPACE, EGL_GL_COLORSPACE_LINEAR},
          {EGL_VG_COLORSPACE, EGL_VG_COLORSPACE_LINEAR},
          {EGL_VG_ALPHA_FORMAT, EGL_VG_ALPHA_FORMAT_NONPRE}};
}

/// The surface of an X window or pixmap.
template <class T>
EGLSurface create_on(EGLDisplay handle, DrawableKind kind, EGLConfig config_handle, XID xid, const T* list) {
  const bool is_window = kind == DrawableKind::window;
  const EGLint bad_native = is_window ? EGL_BAD_NATIVE_WINDOW : EGL_BAD_NATIVE_PIXMAP;
  const Call call(handle);
  Server* const server = call.display.server;
  require(server != nullptr, bad_native);
  const EglConfig& config = call.config(config_handle);
  Wishes wishes = surface_wishes();
  if (is_window) wishes[EGL_RENDER_BUFFER] = EGL_BACK_BUFFER;
  require(read_list<EGL_NONE>(list, wishes), EGL_BAD_ATTRIBUTE);
  const bool single = is_window && wishes[EGL_RENDER_BUFFER] == EGL_SINGLE_BUFFER;
  require(!is_window || single || wishes[EGL_RENDER_BUFFER] == EGL_BACK_BUFFER, EGL_BAD_ATTRIBUTE);
  require(wishes[EGL_GL_COLORSPACE] == EGL_GL_COLORSPACE_LINEAR, EGL_BAD_MATCH);
  call.display.flush();
  const auto geometry = server->geometry(xid, is_window);
  require(geometry.has_value(), bad_native);
  require(geometry->depth == config.format.visual.depth && geometry->screen == call.display.screen, EGL_BAD_MATCH);
  for (const auto& [other, surface] : call.display.surfaces) require(surface->window.xid != xid, EGL_BAD_ALLOC);
  return keep(call.display,
              std::make_shared<Surface>(kind, server, xid, config, single, geometry->width, geometry->height));
}

/// `Native` is the X window or pixmap, or with eglCreatePlatform... a pointer to one.
template <DrawableKind Kind, class Native, class T>
EGLSurface create(EGLDisplay display, EGLConfig config, Native native, const T* list) {
  if constexpr (std::is_pointer_v<Native>)
    return create_on(display, Kind, config, native == nullptr ? 0 : *static_cast<XID*>(native), list);
  else
    return create_on(display, Kind, config, static_cast<XID>(native), list);
}

EGLSurface create_pbuffer_surface(EGLDisplay handle, EGLConfig config_handle, const EGLint* list) {
  const Call call(handle);
  const EglConfig& config = call.config(config_handle);
  Wishes wishes = surface_wishes();
  wishes.insert({{EGL_WIDTH, 0},
                 {EGL_HEIGHT, 0},
                 {EGL_LARGEST_PBUFFER, EGL_FALSE},
                 {EGL_TEXTURE_FORMAT, EGL_NO_TEXTURE},
                 {EGL_TEXTURE_TARGET, EGL_NO_TEXTURE},
                 {EGL_MIPMAP_TEXTURE, EGL_FALSE}});
  require(read_list<EGL_NONE>(list, wishes), EGL_BAD_ATTRIBUTE);
  require(wishes[EGL_WIDTH] >= 0 && wishes[EGL_HEIGHT] >= 0, EGL_BAD_PARAMETER);
  const auto format = static_cast<EGLint>(wishes[EGL_TEXTURE_FORMAT]);
  const auto target = wishes[EGL_TEXTURE_TARGET];
  require(format == EGL_NO_TEXTURE || format == EGL_TEXTURE_RGB || format == EGL_TEXTURE_RGBA, EGL_BAD_ATTRIBUTE);
  require(target == EGL_NO_TEXTURE || target == EGL_TEXTURE_2D, EGL_BAD_ATTRIBUTE);
  require((format == EGL_NO_TEXTURE) == (target == EGL_NO_TEXTURE), EGL_BAD_MATCH);
  require(wishes[EGL_GL_COLORSPACE] == EGL_GL_COLORSPACE_LINEAR, EGL_BAD_MATCH);
  const bool largest = wishes[EGL_LARGEST_PBUFFER] != EGL_FALSE;
  const auto make = [&](int width, int height) {
    return std::make_shared<Surface>(DrawableKind::pbuffer, call.display.server, 0, config, false, width, height);
  };
  const std::shared_ptr<Surface> surface = make_pbuffer(wishes[EGL_WIDTH], wishes[EGL_HEIGHT], largest, make);
  surface->largest = largest ? EGL_TRUE : EGL_FALSE;
  surface->texture_format = format;
  surface->mipmap_texture = wishes[EGL_MIPMAP_TEXTURE] != EGL_FALSE ? EGL_TRUE : EGL_FALSE;
  return keep(call.display, surface);
}

/// Pbuffers of OpenVG's images, which do not exist here.
EGLSurface create_pbuffer_from_client_buffer(EGLDisplay handle, EGLenum, EGLClientBuffer, EGLConfig config,
                                             const EGLint*) {
  static_cast<void>(Call(handle).config(config));
  throw Error{EGL_BAD_PARAMETER};
}

void destroy_surface(EGLDisplay handle, EGLSurface surface) {
  const Call call(handle);
  require(call.display.surfaces.erase(surface) != 0, EGL_BAD_SURFACE);
}

void query_surface(EGLDisplay handle, EGLSurface surface, EGLint name, EGLint* value) {
  const Call call(handle);
  const Surface& s = *call.surface(surface);
  const auto of_pbuffer = [&](EGLint v) {
    if (s.window.kind == DrawableKind::pbuffer) *value = v;  // other surfaces do not change
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
    case EGL_MULTISAMPLE_RESOLVE: *value = EGL_MULTISAMPLE_RESOLVE_DEFAULT; break;
    case EGL_GL_COLORSPACE:
    case EGL_VG_COLORSPACE: *value = EGL_GL_COLORSPACE_LINEAR; break;  // has the number of EGL_VG_COLORSPACE_LINEAR
    case EGL_VG_ALPHA_FORMAT: *value = EGL_VG_ALPHA_FORMAT_NONPRE; break;
    default: throw Error{EGL_BAD_ATTRIBUTE};
  }
}

void surface_attrib(EGLDisplay handle, EGLSurface surface, EGLint name, EGLint value) {
  const Call call(handle);
  Surface& s = *call.surface(surface);
  switch (name) {
    case EGL_MIPMAP_LEVEL: s.mipmap_level = value; break;
    case EGL_MULTISAMPLE_RESOLVE:
      require(value != EGL_MULTISAMPLE_RESOLVE_BOX, EGL_BAD_MATCH);
      require(value == EGL_MULTISAMPLE_RESOLVE_DEFAULT, EGL_BAD_PARAMETER);
      break;
    case EGL_SWAP_BEHAVIOR:
      require(value == EGL_BUFFER_PRESERVED || value == EGL_BUFFER_DESTROYED, EGL_BAD_PARAMETER);
      s.swap_behavior = value;
      break;
    default: throw Error{EGL_BAD_ATTRIBUTE};
  }
}

/// eglBindTexImage copies the pbuffer to the texture: until eglReleaseTexImage nothing may be drawn to it.
template <bool Binds>
void tex_image(EGLDisplay handle, EGLSurface surface_handle, EGLint buffer) {
  const Call call(handle);
  Surface& surface = *call.surface(surface_handle);
  require(buffer == EGL_BACK_BUFFER, EGL_BAD_PARAMETER);
  require(surface.window.kind == DrawableKind::pbuffer, EGL_BAD_SURFACE);
  require(surface.texture_format != EGL_NO_TEXTURE, EGL_BAD_MATCH);
  require(!Binds || !surface.is_bound_to_texture, EGL_BAD_ACCESS);
  if (EglContext* const context = t_state.context.get(); Binds && context != nullptr) {
    Drawable* const read = std::exchange(context->read_drawable, &surface.window);
    copy_tex_image(*context, 2, GL_TEXTURE_2D, surface.mipmap_level,
                   surface.texture_format == EGL_TEXTURE_RGB ? GL_RGB : GL_RGBA, 0, 0, surface.window.frame.width(),
                   surface.window.frame.height(), 0);
    context->read_drawable = read;
    ++context->revision;
  }
  surface.is_bound_to_texture = Binds;
}

void swap_buffers(EGLDisplay handle, EGLSurface handle_of_surface) {
  std::shared_ptr<Surface> surface;
  {
    const Call call(handle);
    surface = call.surface(handle_of_surface);
    if (call.display.native != nullptr) XFlush(call.display.native);
  }
  require(t_state.context != nullptr && t_state.context->draw == surface, EGL_BAD_SURFACE);
  surface->window.swap();
}

void copy_buffers(EGLDisplay handle, EGLSurface surface_handle, EGLNativePixmapType pixmap) {
  const Call call(handle);
  const std::shared_ptr<Surface> surface = call.surface(surface_handle);
  require(call.display.server != nullptr, EGL_BAD_MATCH);
  call.display.flush();
  const auto geometry = call.display.server->geometry(static_cast<XID>(pixmap));
  require(geometry.has_value(), EGL_BAD_NATIVE_PIXMAP);
  require(geometry->depth == surface->config->format.visual.depth, EGL_BAD_MATCH);
  surface->window.show_in(static_cast<XID>(pixmap), surface->window.frame.picture());
  surface->window.finish();
}

void swap_interval(EGLDisplay handle, EGLint interval) {
  const Call call(handle);
  require(t_state.context != nullptr, EGL_BAD_CONTEXT);
  require(t_state.context->draw != nullptr, EGL_BAD_SURFACE);
  t_state.context->draw->window.swap_interval = std::max(interval, 0);
}

}  // namespace

std::span<const Named> surface_functions() {
  using enum DrawableKind;
  static const Named table[] = {
      {"eglBindTexImage", entry<tex_image<true>>()},
      {"eglCopyBuffers", entry<copy_buffers>()},
      {"eglCreatePbufferFromClientBuffer", entry<create_pbuffer_from_client_buffer>()},
      {"eglCreatePbufferSurface", entry<create_pbuffer_surface>()},
      {"eglCreatePixmapSurface", entry<create<pixmap, EGLNativePixmapType, EGLint>>()},
      {"eglCreatePlatformPixmapSurface", entry<create<pixmap, void*, EGLAttrib>>()},
      {"eglCreatePlatformPixmapSurfaceEXT", entry<create<pixmap, void*, EGLint>>()},
      {"eglCreatePlatformWindowSurface", entry<create<window, void*, EGLAttrib>>()},
      {"eglCreatePlatformWindowSurfaceEXT", entry<create<window, void*, EGLint>>()},
      {"eglCreateWindowSurface", entry<create<window, EGLNativeWindowType, EGLint>>()},
      {"eglDestroySurface", entry<destroy_surface>()},
      {"eglQuerySurface", entry<query_surface>()},
      {"eglReleaseTexImage", entry<tex_image<false>>()},
      {"eglSurfaceAttrib", entry<surface_attrib>()},
      {"eglSwapBuffers", entry<swap_buffers>()},
      {"eglSwapInterval", entry<swap_interval>()},
  };
  return table;
}

}  // namespace halfplane::gl::egl
