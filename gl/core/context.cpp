#include "context.hpp"

#include "list.hpp"

namespace halfplane::gl {
namespace {

thread_local Context* g_current = nullptr;

/// What waits in the command buffer of a context that a thread leaves (glXMakeCurrent and eglMakeCurrent flush it). Draws
/// wait in the drawable's frame in their order, so only a picture that no swap will show is to be shown.
void leave(const Context& context) {
  if (context.drawable != nullptr && context.drawable->single_buffered) context.drawable->present();
}

}  // namespace

Context::Context(std::shared_ptr<SharedObjects> shared_objects) : shared(std::move(shared_objects)) {
  texture_matrix.fill({kIdentity});
  for (std::size_t i = 0; i < kTextureTargets.size(); ++i) default_textures[i].target = kTextureTargets[i];
}

Context::~Context() {
  if (g_current == this) g_current = nullptr;
}

Context* current() { return g_current; }

void make_current(Context* context, Drawable* draw, Drawable* read) {
  if (g_current != nullptr && (g_current != context || g_current->drawable != draw)) leave(*g_current);
  g_current = context;
  if (context == nullptr) return;
  context->drawable = draw;
  context->read_drawable = read;
  ++context->revision;
  if (context->was_current || draw == nullptr) return;
  context->was_current = true;
  const int width = draw->frame.width(), height = draw->frame.height();
  State& state = context->state;
  state.viewport.width = state.scissor.width = width;
  state.viewport.height = state.scissor.height = height;
  if (draw->single_buffered) state.color.draw_buffer = state.pixel.read_buffer = GL_FRONT;
}

}  // namespace halfplane::gl
