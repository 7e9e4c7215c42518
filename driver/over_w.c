/* Codes over w: Q = 2^e / w and P = u' Q of texture coordinates and colours (model/stages/perspective.hpp), in
   integers. Q is the
   exact quotient rounded, P the exact product rounded; binary64, as the model has it, gives the same wherever a product has at most
   53    bits (docs/driver.md). */
#include "internal.h"

#if HP_HAS_TEXTURES

#define HP_Q_BITS HALFPLANE_PERSPECTIVE_BITS
#if HALFPLANE_COLORS_OVER_W != 0
#define HP_COLOR_BITS (HALFPLANE_COLOR_OVER_W_CODE_BITS - 1)
#else
#define HP_COLOR_BITS HP_Q_BITS /* none */
#endif
#define HP_NORMAL_DROP (HP_Q_BITS < 20 ? 15 : HP_Q_BITS - 5) /* so that P of a normal has 20 bits, or those of Q */
#define HP_FARTHEST (((int64_t)(1 << 20) - (1 << 11)) << 16) /* of a coordinate from its reference: 2^20 (1 - 2^-9) */

typedef struct over_w {
  int32_t p[3];
  int32_t shift, reach;
  int32_t reference;
} over_w;

/* Q of a vertex: 2^e / w, rounded; w in 2^-16. */
static inline uint32_t q_code(const hp_vertex* v, uint32_t e) {
  const uint32_t w = (uint32_t)v->w, down = 62 - v->shift - e;
  if (w >> 30 != 0) return hp_divide(((uint64_t)1 << e) + w / 2, w);
  return hp_corrected(down < 32 ? v->reciprocal >> down : 0, (e < 32 ? (uint32_t)1 << e : 0) + w / 2, w);
}

/* The largest Q has HP_Q_BITS bits: e is that of the nearest vertex. Returns it. */
uint32_t hp_quantize_q(const hp_context* context, const hp_vertex* const v[3], uint32_t q[3]) {
  if (context->state.texture != NULL && context->state.is_affine != 0) { /* w is 1 */
    q[0] = q[1] = q[2] = (uint32_t)1 << (HP_Q_BITS - 1);
    return HP_Q_BITS - 1 + 16;
  }
  uint32_t shift = v[0]->shift;
  if (v[1]->shift > shift) shift = v[1]->shift;
  if (v[2]->shift > shift) shift = v[2]->shift;
  uint32_t e = HP_Q_BITS - 1 + 32 - shift;
  for (;; --e) {
    q[0] = q_code(v[0], e);
    q[1] = q_code(v[1], e);
    q[2] = q_code(v[2], e);
    if ((q[0] | q[1] | q[2]) >> HP_Q_BITS == 0) break;
  }
  for (uint32_t i = 0; i < 3; ++i)
    if (q[i] == 0) q[i] = 1;
  return e;
}

/* P of three values, 2^-16, of any size. */
static void quantize_wide(const int64_t value[3], const uint32_t q[3], uint8_t is_color, over_w* out) {
  const uint32_t bits = is_color != 0 ? HP_COLOR_BITS : HP_Q_BITS;
  const int32_t narrow_bits = is_color != 0 ? HALFPLANE_COLOR_NARROW_BITS : HALFPLANE_PERSPECTIVE_MANTISSA_BITS - 1;
  int64_t low = value[0], high = value[0], product[3];
  for (uint32_t i = 1; i < 3; ++i) {
    if (value[i] < low) low = value[i];
    if (value[i] > high) high = value[i];
  }
  out->reference = is_color != 0 ? 0 : (int32_t)((low + high) >> 17);
  uint64_t farthest = 0, largest = 0;
  for (uint32_t i = 0; i < 3; ++i) {
    int64_t u = value[i] - (int64_t)out->reference * HP_ONE;
    if (u > HP_FARTHEST) u = HP_FARTHEST;
    if (u < -HP_FARTHEST) u = -HP_FARTHEST;
    const uint64_t size = (uint64_t)(u < 0 ? -u : u);
    product[i] = u * q[i];
    if (size > farthest) farthest = size;
    if (size * q[i] > largest) largest = size * q[i];
  }
  out->reach = (int32_t)hp_bits64((farthest * 1025) >> 26);
  int32_t above = largest != 0 ? (int32_t)hp_bits64(largest) - 16 : out->reach - 1;
  if (above < out->reach - 1) above = out->reach - 1;
  for (int32_t exponent = above - (int32_t)bits;; ++exponent) { /* again, where one is rounded up to one bit more */
    uint32_t all = 0;
    for (uint32_t i = 0; i < 3; ++i) {
      out->p[i] = (int32_t)hp_round_shift(product[i], 16 + exponent);
      all |= (uint32_t)(out->p[i] < 0 ? -out->p[i] : out->p[i]);
    }
    out->shift = 1 + out->reach - exponent - narrow_bits;
    if (all >> bits == 0) return;
  }
}

/* A value, from the reference on, times Q. */
typedef struct part {
  uint32_t size, is_negative;
  uint64_t product; /* of the size */
} part;

static inline part part_of(int32_t value, int32_t from, uint32_t q) {
  const int32_t u = value - from;
  const uint32_t size = (uint32_t)(u < 0 ? -u : u);
  const part made = {size, (uint32_t)u >> 31, (uint64_t)size * q};
  return made;
}

/* The product's magnitude over 2^shift, rounded, halves up: down if it is negative. 0 < shift < 63; for Q of 24 bits and
   less it is below 32, because coordinates have 30 bits more than is kept, and colours 6. */
static inline uint32_t rounded(const part* of, uint32_t shift) {
  const uint64_t sum = of->product + (((uint64_t)1 << (shift - 1)) - of->is_negative);
  const uint32_t high = (uint32_t)(sum >> 32);
  return HP_Q_BITS > 24 && shift >= 32 ? high >> (shift - 32) : ((uint32_t)sum >> shift) | (high << (32 - shift));
}
static inline int32_t with_sign(uint32_t size, uint32_t is_negative) {
  return (int32_t)((size ^ (0u - is_negative)) + is_negative);
}

/* P of three values of less than 2^30; 0: they need the wide way. */
static inline uint8_t quantize_quickly(int32_t a, int32_t b, int32_t c, const uint32_t q[3], uint8_t is_color,
                                       over_w* out) {
  const uint32_t to_bits = is_color != 0 ? HP_COLOR_BITS : HP_Q_BITS;
  const int32_t narrow_bits = is_color != 0 ? HALFPLANE_COLOR_NARROW_BITS : HALFPLANE_PERSPECTIVE_MANTISSA_BITS - 1;
  const int32_t low = hp_min(hp_min(a, b), c), high = hp_max(hp_max(a, b), c);
  out->reference = is_color != 0 ? 0 : (low + high) >> 17;
  const int32_t from = out->reference * HP_ONE;
  const part x = part_of(a, from, q[0]), y = part_of(b, from, q[1]), z = part_of(c, from, q[2]);
  uint32_t farthest = x.size > y.size ? x.size : y.size;
  if (z.size > farthest) farthest = z.size;
  out->reach = (int32_t)hp_bits32(hp_high(farthest, 1025u << 6));
  /* The bits of the largest product. */
  uint32_t bits = hp_bits64(x.product | y.product | z.product);
  const uint32_t least = (uint32_t)(out->reach + 15);
  if (bits < least) bits = least;
  if (bits <= to_bits) return 0;
  uint32_t shift = bits - to_bits, p, r, s;
  for (;; ++shift) { /* again, where one is rounded up to one bit more */
    p = rounded(&x, shift);
    r = rounded(&y, shift);
    s = rounded(&z, shift);
    if ((p | r | s) >> to_bits == 0) break;
  }
  out->p[0] = with_sign(p, x.is_negative);
  out->p[1] = with_sign(r, y.is_negative);
  out->p[2] = with_sign(s, z.is_negative);
  out->shift = 17 + out->reach - (int32_t)shift - narrow_bits;
  return 1;
}

/* The reference as the unit wants it: modulo the period, or held. */
static int32_t wrapped(int32_t reference, uint32_t log2_size, uint8_t wrap) {
  const int32_t limit = (int32_t)1 << 22;
  if (wrap != HP_REPEAT && wrap != HP_MIRROR) return hp_max(-limit, hp_min(limit, reference));
  return reference & (((int32_t)1 << (log2_size + (wrap == HP_MIRROR ? 1u : 0u))) - 1);
}

/* P of three coordinates, each in 2^-16, times 2^log2_size. */
static void quantize(int32_t a, int32_t b, int32_t c, uint32_t log2_size, const uint32_t q[3], over_w* out) {
  const uint32_t limit = (uint32_t)1 << (30 - log2_size);
  if ((((uint32_t)a + limit) | ((uint32_t)b + limit) | ((uint32_t)c + limit)) < 2 * limit &&
      quantize_quickly(a * (1 << log2_size), b * (1 << log2_size), c * (1 << log2_size), q, 0, out) != 0)
    return;
  const int64_t scale = (int64_t)1 << log2_size, value[3] = {a * scale, b * scale, c * scale};
  quantize_wide(value, q, 0, out);
}

/* A field of less than 32 bits, at a place that the compiler knows. */
static inline void put(uint32_t* words, uint32_t at, uint32_t bits, uint32_t value) {
  const uint32_t shift = at % 32, field = value & (((uint32_t)1 << bits) - 1);
  words[at / 32] |= field << shift;
  if (shift + bits > 32) words[at / 32 + 1] |= field >> (32 - shift);
}

static inline void zero(uint32_t* words, uint32_t count) {
  for (uint32_t i = 0; i < count; ++i) words[i] = 0;
}

static inline void put_vertex(uint32_t* words, uint32_t q, int32_t u, int32_t v) {
  zero(words, HP_OVER_W_WORDS);
  put(words, 0, HP_Q_BITS, q);
  put(words, HP_Q_BITS, HP_Q_BITS + 1, (uint32_t)u);
  put(words, 2 * HP_Q_BITS + 1, HP_Q_BITS + 1, (uint32_t)v);
}

static inline void put_axis(uint32_t* frame, uint32_t axis, const over_w* made, int32_t reference) {
  put(frame, HALFPLANE_COORDINATE_FRAME_SHIFT_AT + axis * HALFPLANE_COORDINATE_SHIFT_BITS,
      HALFPLANE_COORDINATE_SHIFT_BITS, (uint32_t)made->shift);
  put(frame, HALFPLANE_COORDINATE_FRAME_REACH_AT + axis * HALFPLANE_COORDINATE_REACH_BITS,
      HALFPLANE_COORDINATE_REACH_BITS, (uint32_t)made->reach);
  put(frame, HALFPLANE_COORDINATE_FRAME_ORIGIN_AT + axis * HALFPLANE_COORDINATE_REFERENCE_BITS,
      HALFPLANE_COORDINATE_REFERENCE_BITS, (uint32_t)reference);
}

void hp_over_w(const hp_context* context, const hp_vertex* const vertex[3], uint32_t* out) {
  const hp_state* state = &context->state;
  const hp_texture* texture = state->texture;
  uint32_t* const frame = out + 3 * HP_OVER_W_WORDS;
  uint32_t q[3];
  over_w u = {{0, 0, 0}, 0, 0, 0}, v = {{0, 0, 0}, 0, 0, 0};
  const uint32_t e = hp_quantize_q(context, vertex, q);
  if (texture != NULL) {
    quantize(vertex[0]->texcoord[0], vertex[1]->texcoord[0], vertex[2]->texcoord[0], texture->log2_width, q, &u);
    quantize(vertex[0]->texcoord[1], vertex[1]->texcoord[1], vertex[2]->texcoord[1], texture->log2_height, q, &v);
    u.reference = wrapped(u.reference, texture->log2_width, state->wrap_u);
    v.reference = wrapped(v.reference, texture->log2_height, state->wrap_v);
  }
  put_vertex(out, q[0], u.p[0], v.p[0]);
  put_vertex(out + HP_OVER_W_WORDS, q[1], u.p[1], v.p[1]);
  put_vertex(out + 2 * HP_OVER_W_WORDS, q[2], u.p[2], v.p[2]);
  zero(frame, HP_FRAME_WORDS);
  put_axis(frame, 0, &u, u.reference);
  put_axis(frame, 1, &v, v.reference);
#if HALFPLANE_FOG_UNIT != 0
  if (context->is_fogged != 0) { /* the octave of Q = 1 in the table; w is in 2^-16 */
    const int32_t octave = 16 - (int32_t)e - HALFPLANE_PERSPECTIVE_GUARD_BITS - state->fog->first;
    put(frame, HALFPLANE_COORDINATE_FRAME_FOG_OCTAVE_AT, HALFPLANE_COORDINATE_FRAME_FOG_OCTAVE_BITS,
        (uint32_t)hp_max(-32, hp_min(31, octave)));
  }
#else
  (void)e;
#endif
#if HALFPLANE_NORMALS != 0
  if (context->is_lit != 0)
    for (uint32_t c = 0; c < 3; ++c)
      for (uint32_t i = 0; i < 3; ++i)
        put(out + i * HP_OVER_W_WORDS, 3 * HP_Q_BITS + 2 + c * HALFPLANE_NORMAL_OVER_W_CODE_BITS,
            HALFPLANE_NORMAL_OVER_W_CODE_BITS,
            (uint32_t)hp_round_shift((int64_t)vertex[i]->normal_code[c] * q[i], HP_NORMAL_DROP));
#endif
#if HALFPLANE_COLORS_OVER_W != 0
  if (state->perspective_colors != 0) {
    put(frame, HALFPLANE_COORDINATE_FRAME_DIVIDES_COLORS_AT, 1, 1);
    for (uint32_t c = 0; c < HALFPLANE_COLORS_OVER_W; ++c) {
      int64_t value[3];
      for (uint32_t i = 0; i < 3; ++i) value[i] = (int64_t)(vertex[i]->color >> (8 * c) & 255u) << 16;
      if (quantize_quickly((int32_t)value[0], (int32_t)value[1], (int32_t)value[2], q, 1, &u) == 0)
        quantize_wide(value, q, 1, &u);
      for (uint32_t i = 0; i < 3; ++i)
        put(out + i * HP_OVER_W_WORDS, 3 * HP_Q_BITS + 2 + c * (HP_COLOR_BITS + 1), HP_COLOR_BITS + 1,
            (uint32_t)u.p[i]);
      put(frame, HALFPLANE_COORDINATE_FRAME_COLOR_SHIFT_AT + c * HALFPLANE_COLOR_SHIFT_BITS, HALFPLANE_COLOR_SHIFT_BITS,
          (uint32_t)u.shift);
      put(frame, HALFPLANE_COORDINATE_FRAME_COLOR_REACH_AT + c * HALFPLANE_COLOR_REACH_BITS, HALFPLANE_COLOR_REACH_BITS,
          (uint32_t)u.reach);
    }
  }
#endif
}

#else
typedef int hp_no_textures; /* a translation unit is not empty */
#endif
