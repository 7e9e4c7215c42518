/* Triangles inside the guard band: cull and words. One that shows the side that is culled, or has no area, is not
   sent. */
#include "internal.h"

/* The core's slot of a vertex that is in one, as a bit; 0: it is in none. */
static inline uint32_t held(const uint32_t slot[3], uint32_t tag) {
  return tag == slot[0] ? 1 : tag == slot[1] ? 2 : tag == slot[2] ? 4 : 0;
}

/* A vertex that is in no slot takes the first one that this triangle does not use. So the slots are loaded in
   ascending order. Returns the slot's bit. */
static inline uint32_t load(hp_context* context, const hp_vertex* v, uint32_t used) {
  const uint32_t bit = ~used & (used + 1); /* the lowest 0 */
  uint32_t* to = context->next;
  context->slot[bit >> 1] = v->tag;
  ++context->counts.vertices;
  to[0] = (uint32_t)(uint16_t)v->x | ((uint32_t)(uint16_t)v->y << 16);
  hp_write_codes(to + 1, v->depth, v->color);
  context->next = to + 1 + HP_AFFINE_WORDS;
  return bit;
}

#if HALFPLANE_TEXTURE_UNIT == 3
#define HP_PART_BITS (HALFPLANE_STATE_WORD_BITS >= 104 ? 104u : 70u) /* of the lines in a token, the lowest first */

/* Sends the lines of a triangle's level of detail, if they differ from those before it. */
static void send_lines(hp_context* context, const hp_vertex* a, const hp_vertex* b, const hp_vertex* c, int64_t area) {
  const hp_vertex* const v[3] = {a, b, c};
  uint32_t lines[9] = {0}; /* 7 of them, and what the last part has beyond */
  hp_lines_of_levels(context, v, area, lines);
  uint8_t differs = context->has_lines == 0;
  for (uint32_t i = 0; i < 7; ++i)
    if (context->lines[i] != lines[i]) differs = 1;
  if (differs == 0) return;
  for (uint32_t i = 0; i < 7; ++i) context->lines[i] = lines[i];
  context->has_lines = 1;
  for (uint32_t at = 0; at < 208; at += HP_PART_BITS) {
    const uint32_t shift = at % 32;
    uint32_t part[4];
    for (uint32_t i = 0; i < 4; ++i) {
      const uint32_t n = at / 32 + i;
      part[i] = lines[n] >> shift;
      if (shift != 0) part[i] |= lines[n + 1] << (32 - shift);
    }
    part[HP_PART_BITS / 32] &= ((uint32_t)1 << HP_PART_BITS % 32) - 1;
    if (HP_PART_BITS < 96) part[3] = 0;
    hp_send_token(context, HP_LINES_OF_LEVELS, part);
  }
}
#endif

/* Vertices go to the core's slots: one that is in a slot already is not sent again. */
void hp_send_triangle(hp_context* context, const hp_vertex* a, const hp_vertex* b, const hp_vertex* c) {
  const int64_t area = hp_area(a, b, c);
  if (area == 0 || context->culls[(uint64_t)area >> 63] != 0) {
    ++context->counts.culled;
    return;
  }
#if HALFPLANE_TEXTURE_UNIT == 3
  if (context->needs_lines != 0) send_lines(context, a, b, c, area);
#endif
  if (hp_reserve(context, HP_TRIANGLE_WORDS) == 0) return;
  uint32_t* const words = context->next++;
  uint32_t slot_a = held(context->slot, a->tag), slot_b = held(context->slot, b->tag);
  uint32_t slot_c = held(context->slot, c->tag);
  const uint32_t kept = slot_a | slot_b | slot_c;
  if (slot_a == 0) slot_a = load(context, a, kept);
  if (slot_b == 0) slot_b = load(context, b, kept | slot_a);
  if (slot_c == 0) slot_c = load(context, c, kept | slot_a | slot_b);
  uint32_t header = HP_HEADER(HP_TRIANGLE, kept ^ 7u);
  if (slot_b != 2 * slot_a && slot_a != 4 * slot_b) header |= HP_FLIP; /* an odd permutation */
#if HP_HAS_TEXTURES
  if (context->is_over_w != 0) {
    const hp_vertex* in_slot[3];
    in_slot[slot_a >> 1] = a;
    in_slot[slot_b >> 1] = b;
    in_slot[slot_c >> 1] = c;
    header |= HP_OVER_W;
    hp_over_w(context, in_slot, context->next);
    context->next += 3 * HP_OVER_W_WORDS + HP_FRAME_WORDS;
  }
#endif
  words[0] = header;
  ++context->counts.sent;
}
