#include "context.hpp"

#include "commands.hpp"
#include "list.hpp"

namespace halfplane::gl {
namespace {

thread_local Context* g_current = nullptr;

/// Flushes a context that a thread leaves, as glXMakeCurrent and eglMakeCurrent must. Draws
/// wait in the drawable's frame in their order, so only a picture that no swap will show is to be shown.
void leave(const Context& context) {
  if (context.drawable != nullptr && context.drawable->single_buffered) context.drawable->present();
}

}  // namespace

void Drawable::swap() {
  const bool was_front = draws_to_front_;
  draw_to(false);
  frame.end([this](const Framebuffer& picture) { show(picture); });
  if (other_ != nullptr) make_front(true);
  draw_to(was_front);
}

void Drawable::draw_to(bool front) {
  if (single_buffered || front == draws_to_front_) return;
  if (draws_to_front_) show(frame.picture());  // no swap does
  make_front();
  frame.exchange_colors(*other_);
  draws_to_front_ = front;
}

const Framebuffer::Image& Drawable::colors(bool front) {
  const Framebuffer& picture = frame.picture();
  const bool is_other = other_ != nullptr && front != draws_to_front_ && other_->color.size() == picture.color.size();
  return is_other ? other_->color : picture.color;
}

void Drawable::make_front(bool copies) {
  const Framebuffer& picture = frame.picture();
  if (other_ == nullptr)
    other_ = std::make_unique<Framebuffer>(picture);
  else if (copies || other_->width != picture.width || other_->height != picture.height)
    *other_ = picture;
}

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
  if (draw == nullptr) return;
  if (context->was_current) return follow_draw_buffer(*context);
  context->was_current = true;
  const int width = draw->frame.width(), height = draw->frame.height();
  State& state = context->state;
  state.viewport.width = state.scissor.width = width;
  state.viewport.height = state.scissor.height = height;
  if (draw->single_buffered) state.color.draw_buffer = state.pixel.read_buffer = GL_FRONT;
}

}  // namespace halfplane::gl
