// Contexts, the current one of each thread, and fences.
#include "egl.hpp"

namespace halfplane::gl::egl {
namespace {

bool is_api(EGLenum api) { return api == EGL_OPENGL_API || api == EGL_OPENGL_ES_API; }

void bind_api(EGLenum api) {
  require(is_api(api), EGL_BAD_PARAMETER);
  t_state.api = api;
}
EGLenum query_api() { return t_state.api; }

EGLContext create_context(EGLDisplay handle, EGLConfig config, EGLContext share, const EGLint* list) {
  const Call call(handle);
  const EglConfig* const its_config = config == EGL_NO_CONFIG_KHR ? nullptr : &call.config(config);
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
  require(read_list<EGL_NONE>(list, wishes), EGL_BAD_ATTRIBUTE);
  const auto major = wishes[EGL_CONTEXT_MAJOR_VERSION], minor = wishes[EGL_CONTEXT_MINOR_VERSION];
  const auto flags = wishes[EGL_CONTEXT_FLAGS_KHR];
  constexpr EGLAttrib kForwardOrRobust =
      EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE_BIT_KHR | EGL_CONTEXT_OPENGL_ROBUST_ACCESS_BIT_KHR;
  require((flags & ~(EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR | (is_es ? 0 : kForwardOrRobust))) == 0, EGL_BAD_ATTRIBUTE);
  require(major == 1 && minor >= 0 && minor <= (is_es ? 1 : 5) && (flags & kForwardOrRobust) == 0 &&
              wishes[EGL_CONTEXT_OPENGL_ROBUST_ACCESS] == EGL_FALSE &&
              (is_es || wishes[EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE] == EGL_FALSE),
          EGL_BAD_MATCH);
  const std::shared_ptr<EglContext> other = share == EGL_NO_CONTEXT ? nullptr : call.context(share);
  require(other == nullptr || other->api == t_state.api, EGL_BAD_MATCH);
  auto context = other == nullptr ? std::make_shared<EglContext>() : std::make_shared<EglContext>(other->shared);
  context->api = t_state.api;
  context->is_embedded = is_es;
  context->config = its_config;
  void* const result = context.get();
  call.display.contexts[result] = std::move(context);
  return result;
}

void destroy_context(EGLDisplay handle, EGLContext context) {
  const Call call(handle);
  require(call.display.contexts.erase(context) != 0, EGL_BAD_CONTEXT);
}

void query_context(EGLDisplay handle, EGLContext handle_of_context, EGLint name, EGLint* value) {
  const Call call(handle);
  const EglContext& context = *call.context(handle_of_context);
  switch (name) {
    case EGL_CONFIG_ID: *value = context.config == nullptr ? 0 : context.config->id; break;
    case EGL_CONTEXT_CLIENT_TYPE: *value = static_cast<EGLint>(context.api); break;
    case EGL_CONTEXT_CLIENT_VERSION: *value = 1; break;
    case EGL_RENDER_BUFFER:
      *value = context.draw == nullptr                ? EGL_NONE
               : context.draw->window.single_buffered ? EGL_SINGLE_BUFFER
                                                      : EGL_BACK_BUFFER;
      break;
    default: throw Error{EGL_BAD_ATTRIBUTE};
  }
}

void release() {
  gl::make_current(nullptr, nullptr, nullptr);
  t_state.unbind();
}

/// Throws EGL_BAD_ACCESS for an object that is current in another thread.
void require_free(std::thread::id bound) {
  require(bound == std::thread::id() || bound == std::this_thread::get_id(), EGL_BAD_ACCESS);
}

void make_current(EGLDisplay handle, EGLSurface draw, EGLSurface read, EGLContext handle_of_context) {
  const bool is_release = handle_of_context == EGL_NO_CONTEXT && draw == EGL_NO_SURFACE && read == EGL_NO_SURFACE;
  const Call call(handle, !is_release);
  if (is_release) return release();
  require(handle_of_context != EGL_NO_CONTEXT, EGL_BAD_MATCH);
  const std::shared_ptr<EglContext> context = call.context(handle_of_context);
  const auto find = [&](EGLSurface surface) { return surface == EGL_NO_SURFACE ? nullptr : call.surface(surface); };
  const std::shared_ptr<Surface> surfaces[] = {find(draw), find(read)};
  require((surfaces[0] == nullptr) == (surfaces[1] == nullptr), EGL_BAD_MATCH);
  require_free(context->bound_to);
  for (const auto& surface : surfaces)
    if (surface != nullptr) {
      require_free(surface->bound_to);
      require(
          context->config == nullptr || context->config->format.visual.depth == surface->config->format.visual.depth,
          EGL_BAD_MATCH);
      call.display.flush();
      require(surface->window.follow_size(), EGL_BAD_NATIVE_WINDOW);
    }
  const auto drawable = [](const auto& surface) { return surface == nullptr ? nullptr : &surface->window; };
  gl::make_current(context.get(), drawable(surfaces[0]), drawable(surfaces[1]));
  if (t_state.context != context) t_state.unbind();
  for (const auto& surface : {context->draw, context->read})
    if (surface != nullptr) surface->bound_to = {};
  context->bound_to = std::this_thread::get_id();
  context->draw = surfaces[0];
  context->read = surfaces[1];
  for (const auto& surface : surfaces)
    if (surface != nullptr) surface->bound_to = std::this_thread::get_id();
  t_state.context = context;
}

void wait_client() {
  if (t_state.context != nullptr) finish(*t_state.context);
}

void wait_native(EGLint engine) {
  require(engine == EGL_CORE_NATIVE_ENGINE, EGL_BAD_PARAMETER);
  const std::lock_guard lock(mutex());
  for (const auto& [key, display] : displays())
    if (display->initialized && t_state.context != nullptr) display->flush();
}

void release_thread() {
  const std::lock_guard lock(mutex());
  release();
  t_state.api = EGL_OPENGL_ES_API;
}

// Fences: all that was issued is carried out as one is made, so each is signaled from the start.

EGLSync create_sync(EGLDisplay handle, EGLenum type, const EGLAttrib* list) {
  const Call call(handle);
  require(type == EGL_SYNC_FENCE && (list == nullptr || *list == EGL_NONE), EGL_BAD_ATTRIBUTE);
  require(t_state.context != nullptr, EGL_BAD_MATCH);
  finish(*t_state.context);
  auto sync = std::make_unique<char>();
  void* const handle_of_sync = sync.get();
  call.display.syncs[handle_of_sync] = std::move(sync);
  return handle_of_sync;
}

void require_sync(EGLDisplay handle, EGLSync sync) {
  require(Call(handle).display.syncs.contains(sync), EGL_BAD_PARAMETER);
}

void destroy_sync(EGLDisplay handle, EGLSync sync) {
  const Call call(handle);
  require(call.display.syncs.erase(sync) != 0, EGL_BAD_PARAMETER);
}

EGLint client_wait_sync(EGLDisplay handle, EGLSync sync, EGLint, EGLTime) {
  require_sync(handle, sync);
  return EGL_CONDITION_SATISFIED;
}

void wait_sync(EGLDisplay handle, EGLSync sync, EGLint flags) {
  require_sync(handle, sync);
  require(t_state.context != nullptr, EGL_BAD_MATCH);
  require(flags == 0, EGL_BAD_PARAMETER);
}

void get_sync_attrib(EGLDisplay handle, EGLSync sync, EGLint name, EGLAttrib* value) {
  require_sync(handle, sync);
  switch (name) {
    case EGL_SYNC_TYPE: *value = EGL_SYNC_FENCE; break;
    case EGL_SYNC_STATUS: *value = EGL_SIGNALED; break;
    case EGL_SYNC_CONDITION: *value = EGL_SYNC_PRIOR_COMMANDS_COMPLETE; break;
    default: throw Error{EGL_BAD_ATTRIBUTE};
  }
}

/// No kind of object can become an image.
EGLImage create_image(EGLDisplay handle, EGLContext, EGLenum, EGLClientBuffer, const EGLAttrib*) {
  const Call call(handle);
  throw Error{EGL_BAD_PARAMETER};
}
void destroy_image(EGLDisplay handle, EGLImage) {
  const Call call(handle);
  throw Error{EGL_BAD_PARAMETER};
}

}  // namespace

ThreadState::~ThreadState() {
  const std::lock_guard lock(mutex());
  unbind();
}

void ThreadState::unbind() {
  if (context == nullptr) return;
  context->bound_to = {};
  for (const auto& surface : {context->draw, context->read})
    if (surface != nullptr) surface->bound_to = {};
  context->draw = context->read = nullptr;
  context->drawable = context->read_drawable = nullptr;
  context = nullptr;
}

std::span<const Named> context_functions() {
  static const Named table[] = {
      {"eglBindAPI", entry<bind_api>()},
      {"eglClientWaitSync", entry<client_wait_sync>()},
      {"eglCreateContext", entry<create_context>()},
      {"eglCreateImage", entry<create_image>()},
      {"eglCreateSync", entry<create_sync>()},
      {"eglDestroyContext", entry<destroy_context>()},
      {"eglDestroyImage", entry<destroy_image>()},
      {"eglDestroySync", entry<destroy_sync>()},
      {"eglGetSyncAttrib", entry<get_sync_attrib>()},
      {"eglMakeCurrent", entry<make_current>()},
      {"eglQueryAPI", entry<query_api>()},
      {"eglQueryContext", entry<query_context>()},
      {"eglReleaseThread", entry<release_thread>()},
      {"eglWaitClient", entry<wait_client>()},
      {"eglWaitGL", entry<wait_client>()},
      {"eglWaitNative", entry<wait_native>()},
      {"eglWaitSync", entry<wait_sync>()},
  };
  return table;
}

}  // namespace halfplane::gl::egl
