/* Targets: buffers, viewport, scissor, clear, flush, present. */
#include "internal.h"

uint8_t hp_is_after_clear(hp_context* context) {
  if (context->is_cleared == 0) context->status |= HP_WRONG_ORDER;
  return context->is_cleared;
}

static uint8_t is_multiple(uint32_t address, uint32_t shift) { return (address & (((uint32_t)1 << shift) - 1)) == 0; }

static uint8_t is_valid_target(const hp_target* t) {
  const uint32_t tiles = ((uint32_t)t->width + HALFPLANE_TILE_SIZE - 1) >> HALFPLANE_TILE_SHIFT;
  if (t->width == 0 || t->height == 0 || t->width > HALFPLANE_TARGET_WIDTH || t->height > HALFPLANE_TARGET_HEIGHT)
    return 0;
  if ((t->row_stride >> HALFPLANE_ROW_STRIDE_BITS) != 0 || t->row_stride < tiles << (HALFPLANE_PLANE_SHIFT + 1))
    return 0;
  return is_multiple(t->depth | t->color | t->row_stride, HALFPLANE_PLANE_SHIFT) != 0 &&
         is_multiple(t->depth_flags | t->color_flags, HALFPLANE_FLAG_ROW_SHIFT) != 0 &&
         is_multiple(t->textures, 12) != 0;
}

/* Target, scissor and the pixels whose centres lie in the viewport. */
static void derive_rect(hp_context* context) {
  const hp_viewport* view = &context->viewport;
  const int32_t size[2] = {context->target.width, context->target.height};
  for (uint32_t axis = 0; axis < 2; ++axis) {
    const int32_t first = axis == 0 ? view->x : view->y, extent = axis == 0 ? view->width : view->height;
    const int64_t low = ((int64_t)first + 32767) >> 16, high = (((int64_t)first + extent + 32767) >> 16) - 1;
    const int32_t left = (int32_t)low, right = (int32_t)high;
    context->rect[axis] = hp_max(hp_max(0, context->scissor[axis]), left);
    context->rect[2 + axis] = hp_min(hp_min(size[axis] - 1, context->scissor[2 + axis]), right);
  }
}

void hp_set_target(hp_context* context, const hp_target* target) {
  if (is_valid_target(target) == 0) {
    context->status |= HP_BAD_VALUE;
    return;
  }
  if (context->is_drawn != 0) hp_flush(context, 0);
  if (context->is_drawn != 0 || hp_reserve(context, 8) == 0) return;
  hp_put(context, HP_SET_OF(HP_TARGET, 7));
  hp_put(context, (uint32_t)(target->width - 1) | ((uint32_t)(target->height - 1) << 16));
  hp_put(context, target->depth);
  hp_put(context, target->color);
  hp_put(context, target->depth_flags);
  hp_put(context, target->color_flags);
  hp_put(context, target->row_stride);
  hp_put(context, target->textures);
  hp_settle(context);
  context->target = *target;
  context->is_set = 1;
  context->is_cleared = 0;
  const hp_viewport whole = {0, 0, target->width * HP_ONE, target->height * HP_ONE, 0, HP_DEPTH_ONE, 0};
  context->scissor[0] = context->scissor[1] = 0;
  context->scissor[2] = target->width - 1;
  context->scissor[3] = target->height - 1;
  hp_set_viewport(context, &whole);
}

void hp_set_viewport(hp_context* context, const hp_viewport* viewport) {
  /* Inside the guard band, so that no sample of it is cut away. */
  const int64_t limit = (int64_t)hp_min(HALFPLANE_GUARD_BAND, 32767) << 16;
  const int64_t right = (int64_t)viewport->x + viewport->width, bottom = (int64_t)viewport->y + viewport->height;
  if (viewport->width <= 0 || viewport->height <= 0 || viewport->x <= -limit || viewport->y <= -limit ||
      right >= limit || bottom >= limit || viewport->near_depth > HP_DEPTH_ONE || viewport->far_depth > HP_DEPTH_ONE) {
    context->status |= HP_BAD_VALUE;
    return;
  }
  context->viewport = *viewport;
  hp_derive_view(context);
  derive_rect(context);
}

void hp_set_scissor(hp_context* context, int32_t x, int32_t y, int32_t width, int32_t height) {
  if (width < 0 || height < 0 || x < -65536 || y < -65536 || x > 65536 || y > 65536 || width > 65536 ||
      height > 65536) {
    context->status |= HP_BAD_VALUE;
    return;
  }
  context->scissor[0] = x;
  context->scissor[1] = y;
  context->scissor[2] = x + width - 1;
  context->scissor[3] = y + height - 1;
  derive_rect(context);
}

void hp_clear(hp_context* context, uint32_t buffers, uint32_t color, uint32_t depth, uint8_t stencil) {
  const int32_t right = (int32_t)context->target.width - 1, bottom = (int32_t)context->target.height - 1;
  const int32_t box[4] = {hp_max(0, context->scissor[0]), hp_max(0, context->scissor[1]),
                          hp_min(right, context->scissor[2]), hp_min(bottom, context->scissor[3])};
  if (context->is_set == 0 || buffers == 0 || buffers > 3 || depth > HP_DEPTH_ONE) {
    context->status |= HP_BAD_VALUE;
    return;
  }
  const uint8_t is_whole = box[0] == 0 && box[1] == 0 && box[2] == right && box[3] == bottom;
  const uint8_t is_first = is_whole != 0 && buffers == (HP_CLEAR_DEPTH | HP_CLEAR_COLOR);
  if ((is_first == 0 && hp_is_after_clear(context) == 0) || box[0] > box[2] || box[1] > box[3]) return;
  uint32_t word = HP_ALWAYS | (buffers & HP_CLEAR_DEPTH) << 3 | (buffers & HP_CLEAR_COLOR) << 3;
#if HP_HAS_STENCIL
  if ((buffers & HP_CLEAR_DEPTH) != 0) {
    const hp_stencil replaces = {HP_ALWAYS, stencil, 255, 255, HP_REPLACE, HP_REPLACE, HP_REPLACE};
    const hp_stencil side[2] = {replaces, replaces};
    if (is_whole == 0) word |= hp_stencil_flags(side);
    hp_set_stencil(context, side, 1, is_whole != 0 ? 0 : 1);
  }
#else
  (void)stencil;
#endif
#if HP_HAS_COLOR_OPS || HP_HAS_ALPHA_TEST
  if (is_whole == 0) { /* for earlier draws */
    hp_state plain = hp_default_state();
    if ((buffers & HP_CLEAR_COLOR) == 0) plain.color_mask = 0;
    hp_set_colors(context, &plain);
  }
#endif
  if (hp_reserve(context, 5 + 1 + HP_AFFINE_WORDS) == 0) return;
  if (is_whole == 0) {
    hp_send_state(context, word);
    hp_send_box(context, box[0], box[1], box[2], box[3]);
  }
  hp_put(context, is_whole != 0 ? HP_HEADER(HP_FAST_CLEAR, buffers) : HP_HEADER(HP_RECTANGLE, 0));
  hp_put_codes(context, (buffers & HP_CLEAR_DEPTH) != 0 ? hp_depth_code(depth) : 0,
               (buffers & HP_CLEAR_COLOR) != 0 ? color : 0);
  hp_settle(context);
  context->is_drawn = 1;
  if (is_first != 0) context->is_cleared = 1;
}

void hp_flush(hp_context* context, uint8_t loses_depth) {
  const uint32_t flag = loses_depth != 0 && HALFPLANE_CACHE_KIND == 1 ? 1 : 0; /* a cache of tiles has none */
  if (hp_is_after_clear(context) == 0) return;
  if (hp_put_command(context, HP_HEADER(HP_FLUSH, flag), 0, 0, 0) != 0) context->is_drawn = 0;
}
void hp_present(hp_context* context, uint32_t color, uint32_t color_flags) {
  if (is_multiple(color, HALFPLANE_PLANE_SHIFT) == 0 || is_multiple(color_flags, HALFPLANE_FLAG_ROW_SHIFT) == 0) {
    context->status |= HP_BAD_VALUE;
    return;
  }
  if (context->is_drawn != 0) {
    context->status |= HP_WRONG_ORDER;
    return;
  }
  (void)hp_put_command(context, HP_HEADER(HP_PRESENT, 0), 2, color, color_flags);
}
