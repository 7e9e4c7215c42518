/* Codes over w: Q = 2^e / w and P = u' Q of texture coordinates and colours (model/stages/perspective.hpp), in
   integers. Q is the
   exact quotient rounded, P the exact product rounded; binary64, as the model has it, gives the same wherever a product has at most
   53    bits (docs/driver.md). */
#include "internal.h"

#if HP_HAS_TEXTURES

#define HP_Q_BITS HALFPLANE_PERSPECTIVE_BITS
#define HP_FARTHEST (((int64_t)(1 << 20) - (1 << 11)) << 16) /* of a coordinate from its reference: 2^20 (1 - 2^-9) */

typedef struct format {
  uint32_t bits;        /* N_P */
  uint32_t narrow_bits; /* k_P */
  uint8_t is_centred;
} format;

typedef struct over_w {
  int64_t p[3];
  int32_t shift, reach;
  int32_t reference;
} over_w;

/* Q of a vertex: 2^e / w, rounded; w in 2^-16. */
static uint32_t q_code(uint32_t w, uint32_t e) { return hp_divide(((uint64_t)1 << e) + w / 2, w); }

/* The largest Q has HP_Q_BITS bits: e is that of the nearest vertex. */
static void quantize_q(const uint32_t w[3], uint32_t q[3]) {
  uint32_t nearest = w[0];
  for (uint32_t i = 1; i < 3; ++i)
    if (w[i] < nearest) nearest = w[i];
  uint32_t e = HP_Q_BITS - 1 + hp_bits32(nearest);
  if (q_code(nearest, e) >> HP_Q_BITS != 0) --e;
  for (uint32_t i = 0; i < 3; ++i) {
    q[i] = q_code(w[i], e);
    if (q[i] == 0) q[i] = 1;
  }
}

/* P of three values, 2^-16. */
static void quantize(const int64_t value[3], const uint32_t q[3], const format* of, over_w* out) {
  int64_t low = value[0], high = value[0], product[3];
  for (uint32_t i = 1; i < 3; ++i) {
    if (value[i] < low) low = value[i];
    if (value[i] > high) high = value[i];
  }
  out->reference = of->is_centred != 0 ? (int32_t)((low + high) >> 17) : 0;
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
  int32_t exponent = above - (int32_t)of->bits;
  for (uint32_t again = 0; again < 2; ++again) {
    uint8_t fits = 1;
    for (uint32_t i = 0; i < 3; ++i) {
      out->p[i] = hp_round_shift(product[i], 16 + exponent);
      if ((uint64_t)(out->p[i] < 0 ? -out->p[i] : out->p[i]) >> of->bits != 0) fits = 0;
    }
    if (fits != 0) break;
    ++exponent; /* rounded up to one bit more */
  }
  out->shift = 1 + out->reach - exponent - (int32_t)of->narrow_bits;
}

/* The reference as the unit wants it: modulo the period, or held. */
static int32_t wrapped(int32_t reference, uint32_t log2_size, uint8_t wrap) {
  const int32_t limit = (int32_t)1 << 22;
  if (wrap == HP_CLAMP) return hp_max(-limit, hp_min(limit, reference));
  return reference & (((int32_t)1 << (log2_size + (wrap == HP_MIRROR ? 1u : 0u))) - 1);
}

void hp_over_w(const hp_context* context, const hp_vertex* const v[3], uint32_t* out) {
  uint32_t* const words[3] = {out, out + HP_OVER_W_WORDS, out + 2 * HP_OVER_W_WORDS};
  uint32_t* const frame = out + 3 * HP_OVER_W_WORDS;
  const hp_state* state = &context->state;
  const format coordinate = {HP_Q_BITS, HALFPLANE_PERSPECTIVE_MANTISSA_BITS - 1, 1};
  uint32_t w[3], q[3];
  int64_t value[3];
  over_w made;
  for (uint32_t i = 0; i < 3; ++i) {
    w[i] = state->texture != NULL && state->is_affine != 0 ? (uint32_t)HP_ONE : (uint32_t)v[i]->w;
    for (uint32_t n = 0; n < HP_OVER_W_WORDS; ++n) words[i][n] = 0;
  }
  for (uint32_t n = 0; n < HP_FRAME_WORDS; ++n) frame[n] = 0;
  quantize_q(w, q);
  for (uint32_t i = 0; i < 3; ++i) hp_put_bits(words[i], 0, HP_Q_BITS, q[i]);
  for (uint32_t axis = 0; state->texture != NULL && axis < 2; ++axis) {
    const uint32_t log2_size = axis == 0 ? state->texture->log2_width : state->texture->log2_height;
    for (uint32_t i = 0; i < 3; ++i) value[i] = (int64_t)v[i]->texcoord[axis] * ((int64_t)1 << log2_size);
    quantize(value, q, &coordinate, &made);
    for (uint32_t i = 0; i < 3; ++i)
      hp_put_bits(words[i], HP_Q_BITS + axis * (HP_Q_BITS + 1), HP_Q_BITS + 1, (uint64_t)made.p[i]);
    hp_put_bits(frame, HALFPLANE_COORDINATE_FRAME_SHIFT_AT + axis * HALFPLANE_COORDINATE_SHIFT_BITS,
                HALFPLANE_COORDINATE_SHIFT_BITS, (uint64_t)(int64_t)made.shift);
    hp_put_bits(frame, HALFPLANE_COORDINATE_FRAME_REACH_AT + axis * HALFPLANE_COORDINATE_REACH_BITS,
                HALFPLANE_COORDINATE_REACH_BITS, (uint64_t)(int64_t)made.reach);
    hp_put_bits(frame, HALFPLANE_COORDINATE_FRAME_ORIGIN_AT + axis * HALFPLANE_COORDINATE_REFERENCE_BITS,
                HALFPLANE_COORDINATE_REFERENCE_BITS,
                (uint64_t)(int64_t)wrapped(made.reference, log2_size, axis == 0 ? state->wrap_u : state->wrap_v));
  }
#if HALFPLANE_COLORS_OVER_W != 0
  if (state->perspective_colors != 0) {
    const uint32_t code_bits = HALFPLANE_COLOR_OVER_W_CODE_BITS;
    const format color = {code_bits - 1, HALFPLANE_COLOR_NARROW_BITS, 0};
    hp_put_bits(frame, HALFPLANE_COORDINATE_FRAME_DIVIDES_COLORS_AT, 1, 1);
    for (uint32_t c = 0; c < HALFPLANE_COLORS_OVER_W; ++c) {
      for (uint32_t i = 0; i < 3; ++i) value[i] = (int64_t)(v[i]->color >> (8 * c) & 255u) << 16;
      quantize(value, q, &color, &made);
      for (uint32_t i = 0; i < 3; ++i)
        hp_put_bits(words[i], 3 * HP_Q_BITS + 2 + c * code_bits, code_bits, (uint64_t)made.p[i]);
      hp_put_bits(frame, HALFPLANE_COORDINATE_FRAME_COLOR_SHIFT_AT + c * HALFPLANE_COLOR_SHIFT_BITS,
                  HALFPLANE_COLOR_SHIFT_BITS, (uint64_t)(int64_t)made.shift);
      hp_put_bits(frame, HALFPLANE_COORDINATE_FRAME_COLOR_REACH_AT + c * HALFPLANE_COLOR_REACH_BITS,
                  HALFPLANE_COLOR_REACH_BITS, (uint64_t)(int64_t)made.reach);
    }
  }
#endif
}

#else
typedef int hp_no_textures; /* a translation unit is not empty */
#endif
