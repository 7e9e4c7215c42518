/* Triangles inside the guard band: cull and words. One that shows the side that is culled, or has no area, is not
   sent. */
#include "internal.h"

/* The core's slot of a vertex that is in one, as a bit; 0: it is in none. */
static inline uint32_t held(const hp_context* context, const hp_vertex* v) {
  return context->slot[v->slot] == v->tag ? (uint32_t)1 << v->slot : 0;
}

/* A vertex that is in no slot takes the first one that this triangle does not use. So the slots are loaded in
   ascending order. */
static inline uint32_t* load(hp_context* context, hp_vertex* v, uint32_t* used, uint32_t* to) {
  const uint32_t taken = ~*used & (*used + 1); /* the lowest 0 */
  *used |= taken;
  v->slot = (uint8_t)(taken >> 1);
  context->slot[v->slot] = v->tag;
  ++context->counts.vertices;
  to[0] = (uint32_t)(uint16_t)v->x | ((uint32_t)(uint16_t)v->y << 16);
  hp_write_codes(to + 1, v->depth, v->color);
  return to + 1 + HP_AFFINE_WORDS;
}

/* Vertices go to the core's slots: one that is in a slot already is not sent again. */
void hp_send_triangle(hp_context* context, hp_vertex* a, hp_vertex* b, hp_vertex* c) {
  const int64_t area = hp_area(a, b, c);
  if (area == 0 || context->culls[(uint64_t)area >> 63] != 0) {
    ++context->counts.culled;
    return;
  }
  if (hp_reserve(context, HP_TRIANGLE_WORDS) == 0) return;
  uint32_t *const words = context->next, *to = words + 1;
  const uint32_t held_a = held(context, a), held_b = held(context, b), held_c = held(context, c);
  uint32_t used = held_a | held_b | held_c;
  const uint32_t kept = used;
  if (held_a == 0) to = load(context, a, &used, to);
  if (held_b == 0) to = load(context, b, &used, to);
  if (held_c == 0) to = load(context, c, &used, to);
  uint32_t header = HP_HEADER(HP_TRIANGLE, used ^ kept);
  const int32_t turn = (int32_t)b->slot - a->slot;
  if (turn != 1 && turn != -2) header |= HP_FLIP; /* an odd permutation */
#if HP_HAS_TEXTURES
  if (context->state.texture != NULL || context->state.perspective_colors != 0) {
    const hp_vertex* in_slot[3];
    in_slot[a->slot] = a;
    in_slot[b->slot] = b;
    in_slot[c->slot] = c;
    header |= HP_OVER_W;
    hp_over_w(context, in_slot, to);
    to += 3 * HP_OVER_W_WORDS + HP_FRAME_WORDS;
  }
#endif
  words[0] = header;
  context->next = to;
  ++context->counts.sent;
}
