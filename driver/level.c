/* Lines of a triangle's level of detail (model/stages/level_of_detail.cpp): what a texture with levels needs besides
   codes over w. The model has them in binary64, products of 89 bits rounded to 53: so they are that here, in integers,
   step by step. Some 10,000 instructions a triangle on RV32IM. */
#include "internal.h"

#if HALFPLANE_TEXTURE_UNIT == 3

/* A binary64 without its bounds: +-size 2^exponent; 0, or bit 63 is set and the low 11 bits are clear. */
typedef struct real {
  uint64_t size;
  int32_t exponent;
  uint8_t is_negative;
} real;

/* To 53 bits, halves to even; `is_more`: the number is larger than its bits say. Bit 63 need not be set. */
static real made(uint64_t size, int32_t exponent, uint8_t is_negative, uint8_t is_more) {
  real result = {0, 0, is_negative};
  if (size == 0) return result;
  const uint32_t shift = 64 - hp_bits64(size);
  size <<= shift;
  result.exponent = exponent - (int32_t)shift;
  const uint32_t rest = (uint32_t)size & 0x7ffu;
  const uint8_t is_up = rest > 0x400u || (rest == 0x400u && (is_more != 0 || (size & 0x800u) != 0)) ? 1 : 0;
  const uint64_t kept = (size >> 11) + is_up; /* 2^53 at most: then it has one bit more */
  const uint32_t carry = (uint32_t)(kept >> 53);
  result.size = (kept >> carry) << 11;
  result.exponent += (int32_t)carry;
  return result;
}

static real from_integer(int64_t value) {
  return made(value < 0 ? 0u - (uint64_t)value : (uint64_t)value, 0, value < 0 ? 1 : 0, 0);
}

static real times(const real* a, const real* b) {
  const uint32_t a_high = (uint32_t)(a->size >> 32), a_low = (uint32_t)a->size;
  const uint32_t b_high = (uint32_t)(b->size >> 32), b_low = (uint32_t)b->size;
  const uint64_t low = (uint64_t)a_low * b_low, left = (uint64_t)a_high * b_low, right = (uint64_t)a_low * b_high;
  const uint64_t middle = (low >> 32) + (uint32_t)left + (uint32_t)right;
  const uint64_t high = (uint64_t)a_high * b_high + (left >> 32) + (right >> 32) + (middle >> 32);
  const uint32_t below = (uint32_t)low | (uint32_t)middle;
  /* The high word has 63 or 64 bits, 10 or 11 more than are kept: the rest only says whether there is more. */
  return made(high, a->exponent + b->exponent + 64, a->is_negative ^ b->is_negative, below != 0 ? 1 : 0);
}

/* Times a difference of coordinates, of 17 bits and a sign. */
static real times_small(const real* a, int32_t b) {
  const uint32_t factor = (uint32_t)(b < 0 ? -b : b);
  const uint64_t low = (uint64_t)(uint32_t)a->size * factor;
  const uint64_t high = (a->size >> 32) * factor + (low >> 32);
  const uint32_t bits = hp_bits32(factor); /* high has 31 or 32 more */
  return made((high << (32 - bits)) | ((uint32_t)low >> bits), a->exponent + (int32_t)bits,
              a->is_negative != (b < 0 ? 1 : 0) ? 1 : 0, ((uint32_t)low & (((uint32_t)1 << bits) - 1)) != 0 ? 1 : 0);
}

/* Whether |a| < |b|. */
static uint8_t is_smaller(const real* a, const real* b) {
  if (a->size == 0 || b->size == 0) return a->size == 0 && b->size != 0 ? 1 : 0;
  return (a->exponent != b->exponent ? a->exponent < b->exponent : a->size < b->size) ? 1 : 0;
}

static real plus(const real* a, const real* b) {
  if (is_smaller(a, b) != 0) {
    const real* larger = b;
    b = a;
    a = larger;
  }
  if (b->size == 0) return *a;
  const uint32_t apart = (uint32_t)(a->exponent - b->exponent) + 1; /* and one bit for the carry */
  const uint64_t part = apart < 64 ? b->size >> apart : 0;
  const uint8_t is_more = apart >= 64 || (part << apart) != b->size ? 1 : 0;
  const uint64_t whole = a->size >> 1;
  const uint64_t sum = a->is_negative == b->is_negative ? whole + part : whole - part - is_more;
  return made(sum, a->exponent + 1, a->is_negative, is_more);
}

/* floor(a + 1/2), modulo 2^32. |a| is below 2^40: the largest value is below 2^31, a line's ends are half a subpixel
   apart at least. */
static uint32_t residue(const real* value) {
  static const real half = {(uint64_t)1 << 63, -64, 0};
  const real a = plus(value, &half);
  const uint32_t down = (uint32_t)-a.exponent;
  const uint64_t whole = down < 64 ? a.size >> down : 0;
  const uint8_t has_part = down >= 64 || (whole << down) != a.size ? 1 : 0;
  return a.is_negative != 0 ? 0u - ((uint32_t)whole + has_part) : (uint32_t)whole;
}

/* 2^bits / divisor; the divisor has at most 62 bits. */
static real power_over(uint32_t bits, uint64_t divisor) {
  const uint32_t width = hp_bits64(divisor);
  uint64_t rest = (uint64_t)1 << (width - 1), quotient = 0; /* 2^(width - 1) / divisor: more than 1/2, at most 1 */
  for (uint32_t i = 0; i < 58; ++i) {
    quotient <<= 1;
    if (rest >= divisor) {
      rest -= divisor;
      ++quotient;
    }
    rest <<= 1;
  }
  return made(quotient, (int32_t)bits - (int32_t)width + 1 - 57, 0, rest != 0 ? 1 : 0);
}

/* One coordinate, in texels Q^2 a subpixel times the area: the slope of both lines, and the lines at the vertices. */
typedef struct numerators {
  real slope, row[3], column[3];
} numerators;

/* u: 2^-16 texels. */
static void numerators_of(const hp_vertex* const v[3], const uint32_t q[3], const int64_t u[3], numerators* n,
                          real* largest) {
  real c[3];
  for (uint32_t k = 0; k < 3; ++k) {
    const uint32_t i = (k + 1) % 3, j = (k + 2) % 3;
    real apart = from_integer(u[i] - u[j]);
    apart.exponent -= 16;
    const real both = from_integer((int64_t)q[i] * q[j]);
    c[k] = times(&both, &apart);
  }
  const real two = plus(&c[0], &c[1]);
  n->slope = plus(&two, &c[2]);
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t a = i == 0 ? 1 : 0, b = i == 2 ? 1 : 2;
    const real row_a = times_small(&c[a], (int32_t)v[i]->y - v[a]->y);
    const real row_b = times_small(&c[b], (int32_t)v[i]->y - v[b]->y);
    n->row[i] = plus(&row_a, &row_b);
    const real column_a = times_small(&c[a], (int32_t)v[i]->x - v[a]->x);
    const real column_b = times_small(&c[b], (int32_t)v[i]->x - v[b]->x);
    n->column[i] = plus(&column_a, &column_b);
    if (is_smaller(largest, &n->row[i]) != 0) *largest = n->row[i];
    if (is_smaller(largest, &n->column[i]) != 0) *largest = n->column[i];
  }
}

/* A line's value at pixel 0. */
static uint32_t at_zero(const real* value, const real* slope, int32_t position, const real* scale, uint32_t step) {
  const int32_t pixel = position >> HALFPLANE_GRID_BITS;
  const int32_t centre = pixel * (1 << HALFPLANE_GRID_BITS) + (1 << HALFPLANE_GRID_BITS) / 2;
  const real rise = times_small(slope, centre - position), there = plus(value, &rise);
  const real scaled = times(&there, scale);
  return residue(&scaled) - (uint32_t)pixel * step;
}

/* Whether a is before b in the order of vertices: by y, then x. */
static uint8_t is_before(const hp_vertex* a, const hp_vertex* b) { return a->y != b->y ? a->y < b->y : a->x < b->x; }

void hp_lines_of_levels(const hp_context* context, const hp_vertex* const vertex[3], int64_t area, uint32_t words[7]) {
  const hp_state* state = &context->state;
  const hp_texture* texture = state->texture;
  const uint32_t log2_size[2] = {texture->log2_width, texture->log2_height};
  uint32_t first = is_before(vertex[1], vertex[0]) != 0 ? 1 : 0;
  if (is_before(vertex[2], vertex[first]) != 0) first = 2;
  const hp_vertex *next = vertex[(first + 1) % 3], *last = vertex[(first + 2) % 3];
  const hp_vertex* const v[3] = {vertex[first], area < 0 ? last : next, area < 0 ? next : last};
  uint32_t q[3];
  hp_quantize_q(context, v, q);
  numerators n[2];
  real largest = {0, 0, 0};
  for (uint32_t c = 0; c < 2; ++c) {
    const int64_t size = (int64_t)1 << log2_size[c];
    const int64_t u[3] = {v[0]->texcoord[c] * size, v[1]->texcoord[c] * size, v[2]->texcoord[c] * size};
    numerators_of(v, q, u, &n[c], &largest);
  }
  for (uint32_t i = 0; i < 7; ++i) words[i] = 0;
  int32_t offset = -64 * 256;
  if (largest.size != 0) {
    real scale = power_over(HALFPLANE_GRID_BITS, (uint64_t)(area < 0 ? -area : area));
    largest.is_negative = 0;
    const int32_t g = 30 - (times(&largest, &scale).exponent + 63);
    scale.exponent += g;
    for (uint32_t c = 0; c < 2; ++c) {
      real step = times(&n[c].slope, &scale);
      step.exponent += HALFPLANE_GRID_BITS;
      words[4 + c] = residue(&step);
      words[c] = at_zero(&n[c].row[0], &n[c].slope, v[0]->y, &scale, words[4 + c]);
      words[2 + c] = at_zero(&n[c].column[0], &n[c].slope, v[0]->x, &scale, words[4 + c]);
    }
    offset = (2 * HALFPLANE_PERSPECTIVE_GUARD_BITS - g) * 256;
  }
  offset = hp_max(-32768, hp_min(32767, offset + state->level_bias));
  words[6] = (uint32_t)offset & 0xffffu;
}

#else
typedef int hp_no_levels; /* a translation unit is not empty */
#endif
