/* Lines of a triangle's level of detail (model/stages/level_of_detail.cpp): what a texture with levels needs besides
   codes over w. The model has them in binary64, products of 89 bits rounded to 53: so they are that here, in integers,
   step by step, in some 9,000 instructions a triangle on RV32IM; but where numbers of 64 bits decide the same words for
   certain, in 2,500. */
#include "internal.h"

#if HALFPLANE_TEXTURE_UNIT == 3

#define HP_LOW_BITS HALFPLANE_PERSPECTIVE_BITS /* half of a product of two Q */

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

/* floor(2^(57 + bits of the area - 1) / area): more than 2^56, at most 2^57; `is_more`: there is a rest. An area has 32
   bits: twice that of a triangle in a square of 2^16 - 1. */
static uint64_t one_over(uint32_t area, uint8_t* is_more) {
  const uint64_t whole = (uint64_t)1 << (hp_bits32(area) - 1 + 28);
  const uint32_t first = hp_divide(whole, area);
  const uint64_t rest = (uint64_t)(uint32_t)((uint32_t)whole - first * area) << 29;
  const uint32_t second = hp_divide(rest, area);
  *is_more = (uint32_t)rest != second * area;
  return ((uint64_t)first << 29) | second;
}

/* 2^bits / area */
static real power_over(uint32_t bits, uint32_t area) {
  uint8_t is_more;
  const uint64_t quotient = one_over(area, &is_more);
  return made(quotient, (int32_t)bits - (int32_t)hp_bits32(area) + 1 - 57, 0, is_more);
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

static void find_exactly(const hp_vertex* const v[3], const uint32_t q[3], int64_t u[2][3], uint32_t area,
                         uint32_t words[7], int32_t* offset) {
  numerators n[2];
  real largest = {0, 0, 0};
  for (uint32_t c = 0; c < 2; ++c) numerators_of(v, q, u[c], &n[c], &largest);
  for (uint32_t i = 0; i < 6; ++i) words[i] = 0;
  if (largest.size == 0) return;
  real scale = power_over(HALFPLANE_GRID_BITS, area);
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
  *offset = (2 * HALFPLANE_PERSPECTIVE_GUARD_BITS - g) * 256;
}

/* ---- The quick way: 64 bits in place of binary64, with a bound of the error of both. Where a result lies within it of a
   tie, or the largest value of a power of two, the exact way decides. */

/* The high word of a product. */
static uint64_t high_product(uint64_t a, uint64_t b) {
  const uint32_t a_high = (uint32_t)(a >> 32), a_low = (uint32_t)a, b_high = (uint32_t)(b >> 32), b_low = (uint32_t)b;
  const uint64_t left = (uint64_t)a_high * b_low + hp_high(a_low, b_low), right = (uint64_t)a_low * b_high;
  return (uint64_t)a_high * b_high + (left >> 32) + (((left & 0xffffffffu) + right) >> 32);
}
static uint64_t size_of(int64_t value) { return value < 0 ? 0u - (uint64_t)value : (uint64_t)value; }
/* Times a number below 2^31. */
static int64_t times_short(int64_t a, int32_t b) { return a * b; }

/* A value times 2^left over the area, which is to have `fraction` fraction bits. */
typedef struct scale {
  uint64_t reciprocal;     /* of the area, 63 bits */
  uint32_t left, fraction; /* at most 31 */
  uint32_t error;          /* of a scaled value, below 2^fraction */
} scale;

/* floor(value + 1/2), modulo 2^32; 0: it is next to a tie. */
static uint8_t rounded_quickly(int64_t value, const scale* by, uint32_t* out) {
  const uint64_t size = high_product(size_of(value) << by->left, by->reciprocal);
  const uint64_t sum = (value < 0 ? 0u - size : size) + ((uint64_t)1 << (by->fraction - 1));
  const uint32_t rest = (uint32_t)sum & (((uint32_t)1 << by->fraction) - 1);
  *out = ((uint32_t)(sum >> 32) << (32 - by->fraction)) | ((uint32_t)sum >> by->fraction);
  return rest >= by->error && rest < ((uint32_t)1 << by->fraction) - by->error ? 1 : 0;
}

/* Lines and offset, or 0: the exact way is needed. */
static uint8_t find_quickly(const hp_vertex* const v[3], const uint32_t q[3], int64_t u[2][3], uint32_t area,
                            uint32_t words[7], int32_t* offset) {
  int64_t apart[2][3], c[2][3], row[2][3], column[2][3];
  uint64_t both[3], largest_apart = 0, largest_both = 0;
  int32_t dx[3], dy[3];
  uint32_t reach = 0;
  for (uint32_t k = 0; k < 3; ++k) {
    const uint32_t i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    both[k] = (uint64_t)q[i] * q[j];
    largest_both |= both[k];
    for (uint32_t n = 0; n < 2; ++n) {
      apart[n][k] = u[n][i] - u[n][j];
      largest_apart |= size_of(apart[n][k]);
    }
    dx[k] = (int32_t)v[j]->x - v[i]->x; /* along the side across from k */
    dy[k] = (int32_t)v[j]->y - v[i]->y;
    reach |= (uint32_t)(dx[k] < 0 ? -dx[k] : dx[k]) | (uint32_t)(dy[k] < 0 ? -dy[k] : dy[k]);
  }
  const uint32_t apart_bits = hp_bits64(largest_apart), both_bits = hp_bits64(largest_both),
                 reach_bits = hp_bits32(reach);
  if (apart_bits > 63 - HP_LOW_BITS) return 0;
  /* Products of 60 - reach_bits bits, off by less than 2, so that a line's numerators have 61. */
  const int32_t drop = hp_max(0, (int32_t)(apart_bits + both_bits + reach_bits) - 60);
  uint64_t largest = 0;
  for (uint32_t n = 0; n < 2; ++n) {
    for (uint32_t k = 0; k < 3; ++k) {
      const int64_t high = times_short(apart[n][k], (int32_t)(both[k] >> HP_LOW_BITS));
      const int64_t low = times_short(apart[n][k], (int32_t)(both[k] & (((uint32_t)1 << HP_LOW_BITS) - 1)));
      c[n][k] = drop >= HP_LOW_BITS ? (high + (low >> HP_LOW_BITS)) >> (drop - HP_LOW_BITS)
                                    : high * ((int64_t)1 << (HP_LOW_BITS - drop)) + (low >> drop);
    }
    for (uint32_t i = 0; i < 3; ++i) { /* from the two other vertices: a is the next one, b the one after it */
      const uint32_t a = i == 2 ? 0 : i + 1, b = i == 0 ? 2 : i - 1;
      row[n][i] = times_short(c[n][a], -dy[b]) + times_short(c[n][b], dy[a]);
      column[n][i] = times_short(c[n][a], -dx[b]) + times_short(c[n][b], dx[a]);
      const uint64_t row_size = size_of(row[n][i]), column_size = size_of(column[n][i]);
      if (row_size > largest) largest = row_size;
      if (column_size > largest) largest = column_size;
    }
  }
  if (largest >> 45 == 0) return 0; /* too few bits to shift, or 0 */
  /* Numerators are off by 2 units of two products, and the roundings of binary64 are 2^-53 of each of a few numbers below
     2^61 units; a line's slope, off by 6, is taken times a pixel. */
  const uint32_t left = 62 - hp_bits64(largest);
  const uint64_t error = ((((uint64_t)4 << reach_bits) + ((uint32_t)8 << HALFPLANE_GRID_BITS) + 2048) << left) + 2048;
  uint8_t is_more;
  scale by = {one_over(area, &is_more) << 6, left, 0, (uint32_t)error};
  const uint64_t top = high_product(largest << left, by.reciprocal);
  if (error >> 27 != 0) return 0;
  const uint32_t bits = hp_bits64(top); /* 59 to 62 */
  if (hp_bits64(top - error) != bits || hp_bits64(top + error) != bits) return 0;
  by.fraction = bits - 31;
  for (uint32_t n = 0; n < 2; ++n) {
    const int64_t slope = c[n][0] + c[n][1] + c[n][2];
    if (hp_bits64(size_of(slope)) + left + HALFPLANE_GRID_BITS > 62) return 0; /* smaller than a pixel */
    const int32_t half = 1 << (HALFPLANE_GRID_BITS - 1), inside = (1 << HALFPLANE_GRID_BITS) - 1;
    if (rounded_quickly(slope * (1 << HALFPLANE_GRID_BITS), &by, &words[4 + n]) == 0 ||
        rounded_quickly(row[n][0] + slope * (half - (v[0]->y & inside)), &by, &words[n]) == 0 ||
        rounded_quickly(column[n][0] + slope * (half - (v[0]->x & inside)), &by, &words[2 + n]) == 0)
      return 0;
    words[n] -= (uint32_t)(v[0]->y >> HALFPLANE_GRID_BITS) * words[4 + n];
    words[2 + n] -= (uint32_t)(v[0]->x >> HALFPLANE_GRID_BITS) * words[4 + n];
  }
  const int32_t exponent = (int32_t)bits - (int32_t)left - (int32_t)hp_bits32(area) + drop + HALFPLANE_GRID_BITS - 15;
  *offset = (2 * HALFPLANE_PERSPECTIVE_GUARD_BITS - (30 - exponent)) * 256;
  return 1;
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
  int64_t u[2][3];
  for (uint32_t c = 0; c < 2; ++c)
    for (uint32_t i = 0; i < 3; ++i) u[c][i] = (int64_t)v[i]->texcoord[c] * ((int64_t)1 << log2_size[c]);
  const uint32_t size = (uint32_t)(area < 0 ? -area : area);
  int32_t offset = -64 * 256;
  if (find_quickly(v, q, u, size, words, &offset) == 0) find_exactly(v, q, u, size, words, &offset);
  offset = hp_max(-32768, hp_min(32767, offset + state->level_bias));
  words[6] = (uint32_t)offset & 0xffffu;
}

#else
typedef int hp_no_levels; /* a translation unit is not empty */
#endif
