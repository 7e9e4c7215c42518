/* The state of draws. Only registers that differ are sent. */
#include "internal.h"

#if HP_HAS_TOKENS
/* Whether a register does not have the value yet. */
static uint8_t differs(hp_context* context, uint32_t which, uint32_t side, uint64_t value, uint32_t low_at) {
  uint32_t* held = context->token[which];
  const uint32_t known = HP_KNOWS_TOKEN(which, side);
  const uint8_t is_there = (context->known & known) != 0 && held[low_at] == (uint32_t)value &&
                           (low_at != 0 || (value >> 32) == 0 || held[1] == (uint32_t)(value >> 32));
  context->known |= known;
  held[low_at] = (uint32_t)value;
  return is_there == 0;
}

static void set_token(hp_context* context, uint32_t which, uint32_t value) {
  if (differs(context, which, 0, value, 0) != 0) hp_send_word(context, which, value);
}
#endif

/* ---- Unit registers of a draw */

#if HP_HAS_COLOR_OPS
static uint8_t is_constant(uint8_t factor) {
  return factor >= HP_CONSTANT_COLOR && factor <= HP_ONE_MINUS_CONSTANT_ALPHA;
}

/* Whether the result depends on the stored code: the operation's truth table has bits 1 and 3 where the stored bit is 0,
   and bits 0 and 2 where it is 1. */
static uint32_t reads_stored(uint8_t logic_op) { return ((uint32_t)logic_op ^ (uint32_t)logic_op >> 1) & 5u; }

/* The word of the colour operations, normalised as model/stages/color_ops.hpp does it: equal effect, equal word. */
static uint32_t color_ops(const hp_state* state, uint8_t* reads_constant) {
  const uint8_t has_alpha = HALFPLANE_COLOR_FORMAT == 1;
  uint8_t factor[4] = {HP_ONE_FACTOR, HP_ZERO, HP_ONE_FACTOR, HP_ZERO}, equation[2] = {HP_ADD, HP_ADD};
  const uint8_t is_logic = HALFPLANE_LOGIC_UNIT != 0 && state->logic_op != HP_LOGIC_COPY;
  if (state->blends != 0 && is_logic == 0) {
    equation[0] = state->equation;
    if (has_alpha != 0) equation[1] = state->equation_alpha;
    if (equation[0] < HP_MIN) {
      factor[0] = state->src;
      factor[1] = state->dst;
    }
    if (has_alpha != 0 && equation[1] < HP_MIN) {
      factor[2] = state->src_alpha;
      factor[3] = state->dst_alpha;
    }
    for (uint32_t part = 0; part < 2; ++part)
      if (equation[part] == HP_SUBTRACT && factor[2 * part] == HP_ONE_FACTOR && factor[2 * part + 1] == HP_ZERO)
        equation[part] = HP_ADD;
  }
  uint32_t word = 0;
  *reads_constant = 0;
  for (uint32_t i = 0; i < 4; ++i) {
    word |= (uint32_t)factor[i] << (4 * i);
    if (is_constant(factor[i]) != 0) *reads_constant = 1;
  }
  word |= ((uint32_t)equation[0] << 16) | ((uint32_t)equation[1] << 19);
  const uint32_t plain = HP_ONE_FACTOR | ((uint32_t)HP_ONE_FACTOR << 8); /* one, zero, add */
  const uint32_t blends = word != plain, writes = (state->color_mask & 15u) | (has_alpha != 0 ? 0u : 8u);
  const uint32_t dithers = state->dithers != 0 && has_alpha == 0;
  uint32_t reads = blends != 0 || writes != 15;
  if (is_logic != 0) { /* in the place of the first factor; the first equation, which is none, says so */
    word ^= ((uint32_t)HP_ONE_FACTOR ^ state->logic_op) | ((uint32_t)5 << 16);
    reads |= reads_stored(state->logic_op) != 0;
  }
  return word | (writes << 22) | (dithers << 26) | (blends << 27) | (reads << 28);
}
#endif

static uint8_t writes_color(const hp_state* state) {
  return (state->color_mask & (HALFPLANE_COLOR_FORMAT == 1 ? 15 : 7)) != 0;
}

#if HP_HAS_COLOR_OPS || HP_HAS_ALPHA_TEST
void hp_set_colors(hp_context* context, const hp_state* state) {
#if HP_HAS_COLOR_OPS
  if (writes_color(state) != 0) {
    uint8_t reads_constant = 0;
    set_token(context, HP_COLOR_OPS, color_ops(state, &reads_constant));
    if (reads_constant != 0) set_token(context, HP_BLEND_CONSTANT, state->blend_color);
  }
#endif
#if HP_HAS_ALPHA_TEST
  set_token(context, HP_ALPHA_TEST,
            (uint32_t)state->alpha_func | ((uint32_t)state->alpha_reference << 3) |
                ((uint32_t)(state->alpha_to_coverage != 0 ? 1 : 0) << 11));
#endif
}
#endif

#if HP_HAS_STENCIL
static uint32_t test_word(const hp_stencil* s) {
  return (uint32_t)s->func | ((uint32_t)s->reference << 3) | ((uint32_t)s->read_mask << 11);
}
static uint32_t update_word(const hp_stencil* s) {
  return (uint32_t)s->stencil_fails | ((uint32_t)s->depth_fails << 3) | ((uint32_t)s->passes << 6) |
         ((uint32_t)s->write_mask << 9);
}

/* A register of `sides` (bit 0: of fronts). Two equal sides are one token. */
static void set_sides(hp_context* context, uint32_t which, const uint32_t words[2], uint32_t sides) {
  const uint32_t at = which == HP_STENCIL_TEST ? 19 : 17;
  uint32_t wanted = 0;
  for (uint32_t n = 0; n < 2; ++n)
    if ((sides >> n & 1u) != 0 && differs(context, which, n, words[n], n) != 0) wanted |= 1u << n;
  if (wanted == 3 && words[0] == words[1]) {
    hp_send_word(context, which, words[0] | ((uint32_t)3 << at));
    return;
  }
  for (uint32_t n = 0; n < 2; ++n)
    if ((wanted >> n & 1u) != 0) hp_send_word(context, which, words[n] | ((uint32_t)1 << (at + n)));
}

void hp_set_stencil(hp_context* context, const hp_stencil side[2], uint32_t tests, uint32_t updates) {
  const uint32_t test[2] = {test_word(&side[0]), test_word(&side[1])};
  const uint32_t update[2] = {update_word(&side[0]), update_word(&side[1])};
  set_sides(context, HP_STENCIL_TEST, test, tests);
  set_sides(context, HP_STENCIL_UPDATE, update, updates);
}

uint32_t hp_stencil_flags(const hp_stencil side[2]) {
  uint32_t flags = 0;
  for (uint32_t i = 0; i < 2; ++i) {
    const hp_stencil* s = &side[i];
    const uint8_t fails = s->stencil_fails != HP_KEEP || s->depth_fails != HP_KEEP;
    if (s->write_mask != 0 && (fails != 0 || s->passes != HP_KEEP)) flags |= 3u << 8;
    if (s->func != HP_ALWAYS) flags |= 1u << 8;
    if (s->write_mask != 0 && fails != 0) flags |= 4u << 8;
  }
  return flags;
}
#endif

#if HP_HAS_TEXTURES
/* The words of fog, light, a texture's constant and its border share the register of levels: bits 44 to 41, `tag`, tell
   them apart. */
static void set_shared(hp_context* context, uint32_t known, uint32_t* held, uint64_t tag, uint32_t word) {
  if ((context->known & known) == 0 || *held != word) hp_send_word(context, HP_LEVELS, tag | word);
  context->known |= known;
  *held = word;
}

static uint8_t has_border(uint8_t wrap) { return wrap >= HP_BORDER; }
/* In the unit's word, where the lowest bit keeps texels in the image. */
static uint32_t wrap_code(uint8_t wrap) { return wrap == HP_HALF_BORDER ? 5 : wrap; }

static void set_texture(hp_context* context, const hp_state* state) {
  const hp_texture* texture = state->texture;
  uint64_t value = 0;
  if (texture != NULL) {
    const uint32_t wrap_u = wrap_code(state->wrap_u), wrap_v = wrap_code(state->wrap_v);
    value = 1u | ((uint64_t)texture->format << 2) | ((uint64_t)(state->combine & 3u) << 5) |
            ((uint64_t)(wrap_u & 3u) << 7) | ((uint64_t)(wrap_v & 3u) << 9) | ((uint64_t)texture->log2_width << 11) |
            ((uint64_t)texture->log2_height << 15) | ((uint64_t)(texture->address >> 6) << 19) |
            ((uint64_t)(state->is_linear != 0 ? 1 : 0) << 45) | ((uint64_t)(state->combine >> 2) << 46) |
            ((uint64_t)(wrap_u >> 2) << 47) | ((uint64_t)(wrap_v >> 2) << 48);
  }
  const uint8_t drops = context->drops_texels != 0 || (context->known & HP_KNOWS_TOKEN(HP_TEXTURE, 0)) == 0;
  const uint8_t is_new =
      differs(context, HP_TEXTURE, 0, value | ((uint64_t)1 << 63), 0); /* bit 63: the high word counts */
  if (is_new != 0 || drops != 0) hp_send_word(context, HP_TEXTURE, value | (drops != 0 ? 2u : 0u));
  context->token[HP_TEXTURE][1] = (uint32_t)(value >> 32) | ((uint32_t)1 << 31);
  context->drops_texels = 0;
  if (HALFPLANE_TEXTURE_CONSTANT != 0 && texture != NULL && state->combine == HP_BLEND_COLOR)
    set_shared(context, HP_KNOWS_CONSTANT, &context->texture_constant, (uint64_t)1 << 42,
               state->texture_constant & 0xffffffu);
  if (HALFPLANE_TEXTURE_BORDER != 0 && texture != NULL &&
      (has_border(state->wrap_u) | has_border(state->wrap_v)) != 0) {
    const uint8_t has_alpha = texture->format != HP_L8 && texture->format != HP_RGB565;
    set_shared(context, HP_KNOWS_BORDER, &context->texture_border, (uint64_t)1 << 41,
               state->texture_border | (has_alpha != 0 ? 0 : 0xff000000u));
  }
#if HALFPLANE_TEXTURE_UNIT == 3
  context->needs_lines = 0;
  if (texture == NULL) return;
  const uint32_t is_linear = (state->is_linear != 0) != (state->minifies_otherwise != 0) ? 1 : 0;
  const uint32_t largest = (uint32_t)hp_min(4095, hp_max(state->least_level, state->largest_level));
  const uint32_t last = texture->levels > 1 ? texture->levels - 1u : 0;
  set_token(
      context, HP_LEVELS,
      is_linear | ((uint32_t)state->levels << 1) | (last << 3) | ((uint32_t)state->least_level << 7) | (largest << 19));
  context->needs_lines =
      state->least_level != largest && (state->levels != HP_LEVEL_0 || state->minifies_otherwise != 0);
#endif
}
#endif

#if HALFPLANE_FOG_UNIT != 0
static void set_fog(hp_context* context, const hp_state* state) {
  const hp_fog* fog = state->fog;
  uint32_t word = 0;
  if (fog != NULL) word = (state->fog_color & 0xffffffu) | ((uint32_t)fog->octave_bits << 24) | ((uint32_t)1 << 27);
  set_shared(context, HP_KNOWS_FOG, &context->fog_word, (uint64_t)1 << 43, word);
  if (fog == NULL || context->fog_lines == fog->lines) return;
  for (uint32_t i = 0; i < 256; ++i)
    hp_send_word(context, HP_LEVELS,
                 ((uint64_t)2 << 43) | ((uint64_t)i << 35) |
                     ((uint64_t)((uint32_t)fog->lines[i].start & 0x3ffffu) << 17) |
                     ((uint32_t)fog->lines[i].rise & 0x1ffffu));
  context->fog_lines = fog->lines;
}
#endif

/* ---- Draws */

uint8_t hp_prepare(hp_context* context, uint8_t is_triangle) {
  const hp_state* state = &context->state;
  const int32_t* rect = context->rect;
  if (context->is_set == 0) context->status |= HP_BAD_VALUE;
  if (context->is_set == 0 || hp_is_after_clear(context) == 0 || rect[0] > rect[2] || rect[1] > rect[3]) return 0;
  uint32_t word = (uint32_t)state->depth_test | ((uint32_t)(state->depth_write != 0 ? 1 : 0) << 3) |
                  ((uint32_t)writes_color(state) << 4);
#if HALFPLANE_MSAA_SAMPLES > 1
  word |= (~(uint32_t)state->sample_mask & (((uint32_t)1 << HALFPLANE_MSAA_SAMPLES) - 1)) << 16;
#endif
  if (is_triangle != 0) word |= ((uint32_t)state->cull << 5) | ((uint32_t)state->front << 7);
#if HP_HAS_STENCIL
  if (state->has_stencil != 0) word |= hp_stencil_flags(state->stencil);
#endif
  if (hp_reserve(context, 5) == 0) return 0;
  hp_send_state(context, word);
  if (is_triangle != 0) hp_send_box(context, rect[0], rect[1], rect[2], rect[3]);
#if HP_HAS_COLOR_OPS || HP_HAS_ALPHA_TEST
  hp_set_colors(context, state);
#endif
#if HP_HAS_STENCIL
  if ((word >> 8 & 1u) != 0) hp_set_stencil(context, state->stencil, 3, 3);
#endif
#if HP_HAS_TEXTURES
  if (is_triangle != 0) {
    set_texture(context, state);
    context->is_fogged = state->fog != NULL && writes_color(state) != 0;
    context->is_over_w = state->texture != NULL || state->perspective_colors != 0 || context->is_fogged != 0;
#if HALFPLANE_NORMALS != 0
    context->is_lit = state->light != NULL && writes_color(state) != 0;
    if (context->is_lit != 0) context->is_over_w = 1;
    if (writes_color(state) != 0) hp_set_light(context, state->light);
#endif
#if HALFPLANE_FOG_UNIT != 0
    if (writes_color(state) != 0) set_fog(context, state);
#endif
  }
#endif
  context->is_drawn = 1;
  return 1;
}

/* ---- State */

static uint8_t is_supported(const hp_state* state) {
  if (HP_HAS_TEXTURES == 0 && state->texture != NULL) return 0;
  if (state->texture != NULL && state->is_linear != 0 && HALFPLANE_TEXTURE_UNIT < 2) return 0;
  if (HALFPLANE_TEXTURE_UNIT != 3 && state->texture != NULL &&
      (state->levels != HP_LEVEL_0 || state->minifies_otherwise != 0 || state->texture->levels > 1))
    return 0;
  if (HALFPLANE_TEXTURE_CONSTANT == 0 && state->texture != NULL && state->combine == HP_BLEND_COLOR) return 0;
  if (HALFPLANE_TEXTURE_BORDER == 0 && state->texture != NULL &&
      (state->wrap_u >= HP_BORDER || state->wrap_v >= HP_BORDER))
    return 0;
  if (HALFPLANE_COLORS_OVER_W == 0 && state->perspective_colors != 0) return 0;
  if (HALFPLANE_FOG_UNIT == 0 && state->fog != NULL) return 0;
  if (HALFPLANE_NORMALS == 0 && state->light != NULL) return 0;
  if (HP_HAS_STENCIL == 0 && state->has_stencil != 0) return 0;
  if (HP_HAS_ALPHA_TEST == 0 && state->alpha_func != HP_ALWAYS) return 0;
  if (HALFPLANE_MSAA_SAMPLES == 1 && state->sample_mask != 255) return 0;
  if ((HALFPLANE_MSAA_SAMPLES == 1 || HP_HAS_ALPHA_TEST == 0) && state->alpha_to_coverage != 0) return 0;
  if (HALFPLANE_LOGIC_UNIT == 0 && state->logic_op != HP_LOGIC_COPY) return 0;
  if (HALFPLANE_DITHER_UNIT == 0 && state->dithers != 0 && HALFPLANE_COLOR_FORMAT == 0) return 0;
  const uint32_t all = HALFPLANE_COLOR_FORMAT == 1 ? 15 : 7, mask = state->color_mask & all;
  return HALFPLANE_BLEND_LANES != 0 || (state->blends == 0 && (mask == 0 || mask == all));
}

static uint8_t is_valid(const hp_state* state) {
  const int32_t beside = HALFPLANE_GUARD_BAND - hp_max(HALFPLANE_TARGET_WIDTH, HALFPLANE_TARGET_HEIGHT);
  const int32_t widest = 2 * (beside - 1);
  const hp_texture* texture = state->texture;
  if (state->depth_test > HP_ALWAYS || state->cull > HP_CULL_BOTH || state->front > HP_CW || state->color_mask > 15 ||
      state->logic_op > HP_LOGIC_SET)
    return 0;
  if (state->line_rule > HP_DIAMOND || state->line_width == 0 || (state->line_width > 1 && state->line_width > widest))
    return 0;
  if (state->point_size < HP_ONE || (state->point_size > HP_ONE && (state->point_size + 65535) >> 16 > widest))
    return 0;
  if (state->levels > HP_TWO_LEVELS || state->level_bias < -4096 || state->level_bias > 4096 ||
      state->least_level > 3072 || state->largest_level > 3072)
    return 0;
  if (texture != NULL && texture->levels > 1 + hp_max(texture->log2_width, texture->log2_height)) return 0;
  if (texture != NULL && (texture->log2_width > 12 || texture->log2_height > 12 || texture->format > HP_RGBA8888 ||
                          (texture->address & 63u) != 0 || state->wrap_u > HP_HALF_BORDER ||
                          state->wrap_v > HP_HALF_BORDER || state->combine > HP_BLEND_COLOR))
    return 0;
  if (state->fog != NULL && (state->fog->lines == NULL || state->fog->octave_bits > 4)) return 0;
  if (state->light != NULL && (state->light->lines == NULL || state->light->narrow > 7)) return 0;
  /* A triangle has one Q. */
  return texture == NULL || state->is_affine == 0 ||
         (state->perspective_colors == 0 && state->fog == NULL && state->light == NULL);
}

void hp_set_state(hp_context* context, const hp_state* state) {
  if (is_valid(state) == 0) {
    context->status |= HP_BAD_VALUE;
  } else if (is_supported(state) == 0) {
    context->status |= HP_UNSUPPORTED;
  } else {
    context->state = *state;
    for (uint32_t is_negative = 0; is_negative < 2; ++is_negative) {
      const uint8_t is_front = (is_negative == 0) == (state->front == HP_CW);
      context->culls[is_negative] = (state->cull & (is_front != 0 ? HP_CULL_FRONT : HP_CULL_BACK)) != 0;
    }
  }
}
