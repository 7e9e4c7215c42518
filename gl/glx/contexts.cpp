// Contexts, and the current one of each thread.
#include "glx.hpp"

namespace halfplane::gl::glx {
namespace {

/// Throws GLXBadContext.
GlxContext& context_of(GLXContext handle) {
  const std::lock_guard lock(objects().mutex);
  const auto found = objects().contexts.find(reinterpret_cast<GlxContext*>(handle));
  if (found == objects().contexts.end()) glx_error(GLXBadContext);
  return **found;
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

Bool make_context_current(Display* display, GLXDrawable draw, GLXDrawable read, GLXContext handle) {
  thread_local ThreadEnd at_end;
  static_cast<void>(at_end);
  GlxContext* const before = here();
  if (before != nullptr && before->render_mode != GL_RENDER) glx_error(GLXBadContextState);
  if (handle == nullptr && draw == 0 && read == 0) {
    gl::make_current(nullptr, nullptr, nullptr);
    leave_thread(before);
    return True;
  }
  if (handle == nullptr) x_error(BadMatch);
  GlxContext& context = context_of(handle);
  if (draw == 0 || read == 0) x_error(BadMatch);
  if (context.is_destroyed) glx_error(GLXBadContext);
  if (context.is_current && &context != before) x_error(BadAccess);
  XSync(display, False);  // the driver's own connection is to know the program's windows
  const std::shared_ptr<GlxDrawable> to = drawable_for(display, draw, context);
  const std::shared_ptr<GlxDrawable> from = read == draw ? to : drawable_for(display, read, context);
  gl::make_current(&context, &to->window, &from->window);
  if (before != &context) leave_thread(before);
  const std::lock_guard lock(objects().mutex);
  context.is_current = true;
  context.display = display;
  context.draw = to;
  context.read = from;
  return True;
}

Bool make_current(Display* display, GLXDrawable drawable, GLXContext context) {
  return make_context_current(display, drawable, drawable, context);
}

GLXContext create(Display* display, const FbConfig& config, GLXContext share) {
  const GlxContext* const other = share == nullptr ? nullptr : &context_of(share);
  if (other != nullptr && !other->config->is_of_screen(config)) x_error(BadMatch);
  auto context = other == nullptr ? std::make_unique<GlxContext>() : std::make_unique<GlxContext>(other->shared);
  context->display = display;
  context->config = &config;
  const std::lock_guard lock(objects().mutex);
  objects().contexts.insert(context.get());
  return reinterpret_cast<GLXContext>(context.release());
}

GLXContext create_context(Display* display, XVisualInfo* visual, GLXContext share, Bool) {
  return create(display, config_of(display, visual), share);
}

GLXContext create_new_context(Display* display, GLXFBConfig handle, int render_type, GLXContext share, Bool) {
  const FbConfig& config = config_of(display, handle);
  if (render_type != GLX_RGBA_TYPE) x_error(render_type == GLX_COLOR_INDEX_TYPE ? BadMatch : BadValue);
  return create(display, config, share);
}

GLXContext create_context_attribs_arb(Display* display, GLXFBConfig handle, GLXContext share, Bool, const int* list) {
  const FbConfig& config = config_of(display, handle);
  Wishes wishes{{GLX_CONTEXT_MAJOR_VERSION_ARB, 1},
                {GLX_CONTEXT_MINOR_VERSION_ARB, 0},
                {GLX_CONTEXT_FLAGS_ARB, 0},
                {GLX_CONTEXT_PROFILE_MASK_ARB, GLX_CONTEXT_CORE_PROFILE_BIT_ARB},
                {GLX_RENDER_TYPE, GLX_RGBA_TYPE}};
  if (!read_list<0>(list, wishes)) x_error(BadValue);
  const auto major = wishes[GLX_CONTEXT_MAJOR_VERSION_ARB], minor = wishes[GLX_CONTEXT_MINOR_VERSION_ARB];
  const auto flags = wishes[GLX_CONTEXT_FLAGS_ARB], profile = wishes[GLX_CONTEXT_PROFILE_MASK_ARB];
  const auto render_type = wishes[GLX_RENDER_TYPE];
  constexpr int kLastMinor[] = {-1, 5, 1, 3, 6};  // of OpenGL 1, 2, 3, 4
  if ((flags & ~(GLX_CONTEXT_DEBUG_BIT_ARB | GLX_CONTEXT_FORWARD_COMPATIBLE_BIT_ARB)) != 0 ||
      (render_type != GLX_RGBA_TYPE && render_type != GLX_COLOR_INDEX_TYPE))
    x_error(BadValue);
  if (major < 1 || major > 4 || minor < 0 || minor > kLastMinor[major] || render_type != GLX_RGBA_TYPE ||
      ((flags & GLX_CONTEXT_FORWARD_COMPATIBLE_BIT_ARB) != 0 && major < 3))
    x_error(BadMatch);
  if (profile != GLX_CONTEXT_CORE_PROFILE_BIT_ARB && profile != GLX_CONTEXT_COMPATIBILITY_PROFILE_BIT_ARB)
    glx_error(GLXBadProfileARB);
  if (major > 1) glx_error(GLXBadFBConfig);
  return create(display, config, share);
}

void destroy_context(Display*, GLXContext handle) {
  GlxContext& context = context_of(handle);
  const std::lock_guard lock(objects().mutex);
  context.is_destroyed = true;
  if (!context.is_current) delete_context(&context);
}

void copy_context(Display*, GLXContext source, GLXContext destination, unsigned long mask) {
  GlxContext& from = context_of(source);
  GlxContext& to = context_of(destination);
  if (!from.config->is_of_screen(*to.config)) x_error(BadMatch);
  if (to.is_current) x_error(BadAccess);
  // glPushAttrib on the source and glPopAttrib on the target copy the attributes.
  std::vector<SavedAttributes> stack;
  stack.swap(from.attributes);
  push_attrib(from, static_cast<GLbitfield>(mask));
  to.attributes.push_back(std::move(from.attributes.back()));
  stack.swap(from.attributes);
  pop_attrib(to);
  ++to.revision;
}

Bool is_direct(Display*, GLXContext handle) { return static_cast<void>(context_of(handle)), True; }

int query_context(Display*, GLXContext handle, int name, int* value) {
  const FbConfig& config = *context_of(handle).config;
  switch (name) {
    case GLX_FBCONFIG_ID: *value = config.id; return 0;
    case GLX_RENDER_TYPE: *value = GLX_RGBA_TYPE; return 0;
    case GLX_SCREEN: *value = config.screen; return 0;
    default: return GLX_BAD_ATTRIBUTE;
  }
}

void wait_gl() {
  if (GlxContext* const context = here(); context != nullptr) finish(*context);
}
void wait_x() {
  if (GlxContext* const context = here(); context != nullptr) XSync(context->display, False);
}

}  // namespace

GlxContext* here() { return static_cast<GlxContext*>(current()); }

std::span<const Named> context_functions() {
  static const Named table[] = {
      {"glXCopyContext", entry<copy_context, X_GLXCopyContext>()},
      {"glXCreateContext", entry<create_context, X_GLXCreateContext>()},
      {"glXCreateContextAttribsARB", entry<create_context_attribs_arb, X_GLXCreateContextAttribsARB>()},
      {"glXCreateNewContext", entry<create_new_context, X_GLXCreateNewContext>()},
      {"glXDestroyContext", entry<destroy_context, X_GLXDestroyContext>()},
      {"glXIsDirect", entry<is_direct, X_GLXIsDirect>()},
      {"glXMakeContextCurrent", entry<make_context_current, X_GLXMakeContextCurrent>()},
      {"glXMakeCurrent", entry<make_current, X_GLXMakeCurrent>()},
      {"glXQueryContext", entry<query_context, X_GLXQueryContext, GLX_BAD_CONTEXT>()},
      {"glXUseXFont", address(use_x_font)},
      {"glXWaitGL", address(wait_gl)},
      {"glXWaitX", address(wait_x)},
  };
  return table;
}

}  // namespace halfplane::gl::glx
