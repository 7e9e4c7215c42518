/* What the files of the driver share. Arithmetic shifts of negative numbers are floors, as every compiler has them that
   the driver is built with. */
#ifndef HALFPLANE_DRIVER_INTERNAL_H
#define HALFPLANE_DRIVER_INTERNAL_H

#include "halfplane.h"
#include "stream.h"

#if HALFPLANE_COORDINATE_BITS > 16
#error "the command stream has 16 bits for a coordinate: make guard.band or subpixel.bits smaller"
#endif
#if HALFPLANE_RESOLVE_UNIT != 0
#error "resolve.unit=1 wants a frame sorted by bins, and this driver sends draws as they come: set resolve.unit=0"
#endif

#define HP_HAS_TEXTURES (HALFPLANE_COORDINATES != 0)
#define HP_HAS_COLOR_OPS (HALFPLANE_BLEND_LANES != 0 || HALFPLANE_DITHER_UNIT != 0)
#define HP_HAS_ALPHA_TEST (HALFPLANE_ALPHA_UNIT != 0 && HALFPLANE_CACHE_KIND == 1 && HALFPLANE_SETUP_KIND == 0)
#define HP_HAS_STENCIL (HALFPLANE_STENCIL_BITS != 0)
#define HP_HAS_TOKENS (HP_HAS_TEXTURES || HP_HAS_COLOR_OPS || HP_HAS_ALPHA_TEST || HP_HAS_STENCIL)

#define HP_AFFINE_WORDS ((HALFPLANE_ALL_AFFINE_CODE_BITS + 31) / 32)
#define HP_OVER_W_BITS (HALFPLANE_ALL_CODE_BITS - HALFPLANE_ALL_AFFINE_CODE_BITS)
#define HP_OVER_W_WORDS ((HP_OVER_W_BITS + 31) / 32)
#define HP_FRAME_WORDS ((HALFPLANE_COORDINATE_FRAME_BITS + 31) / 32)
#define HP_TRIANGLE_WORDS \
  (1 + 3 * (1 + HP_AFFINE_WORDS) + (HP_HAS_TEXTURES ? 3 * HP_OVER_W_WORDS + HP_FRAME_WORDS : 0)) /* at most */
#define HP_LINE_WORDS ((HALFPLANE_LINE_SETUP_BITS - HALFPLANE_PRIMITIVE_ID_BITS + 31) / 32)

/* Bits of hp_context.known */
#define HP_KNOWS_TOKEN(which, side) ((uint32_t)1 << (2 * (uint32_t)(which) + (uint32_t)(side)))
#define HP_KNOWS_STATE ((uint32_t)1 << 16)
#define HP_KNOWS_BOX ((uint32_t)1 << 17)
#define HP_KNOWS_FOG ((uint32_t)1 << 18)
#define HP_KNOWS_CONSTANT ((uint32_t)1 << 19)
#define HP_KNOWS_BORDER ((uint32_t)1 << 20)
#define HP_KNOWS_LIGHT ((uint32_t)1 << 21) /* and of its other five words the next ones */

#define HP_NO_TAG ((uint32_t)0xffffffffu)
#define HP_CORNER_TAG ((uint32_t)0x10000u) /* tags from here on: corners of one polygon */

/* ---- Arithmetic */

/* Bits of a number: 0 of 0. */
extern const uint8_t hp_bits_of_byte[256];
static inline uint32_t hp_bits32(uint32_t v) {
#if defined(__ARM_FEATURE_CLZ) && defined(__GNUC__)
  return v == 0 ? 0 : 32 - (uint32_t)__builtin_clz(v);
#else
  const uint32_t low = (v >> 16) != 0 ? ((v >> 24) != 0 ? 24 : 16) : ((v >> 8) != 0 ? 8 : 0);
  return low + hp_bits_of_byte[v >> low];
#endif
}
static inline uint32_t hp_bits64(uint64_t v) {
  const uint32_t high = (uint32_t)(v >> 32);
  return high != 0 ? 32 + hp_bits32(high) : hp_bits32((uint32_t)v);
}

/* n / d for n / 2^32 < d: two divisions of 32 bits (schoolbook, digits of 16 bits). */
uint32_t hp_divide(uint64_t n, uint32_t d);
/* floor(n / d + 1/2), d > 0; beyond +-2^32 some number beyond. */
int64_t hp_divide_rounded(int64_t n, uint32_t d);

/* The high word of a product. */
static inline uint32_t hp_high(uint32_t a, uint32_t b) { return (uint32_t)(((uint64_t)a * b) >> 32); }

/* The number of bits by which w goes to the left to have 32. */
static inline uint32_t hp_shift_of(uint32_t w) { return 32 - hp_bits32(w); }
/* 2^62 / (w 2^shift), wrong by less than 2^-28 of it; it has 31 bits. A step of Newton's from a quotient of 17 bits. */
static inline uint32_t hp_reciprocal(uint32_t w, uint32_t shift) {
  const uint32_t normal = w << shift, first = (0xffffffffu / (normal >> 16)) << 15;
  return hp_high(first, 0u - hp_high(first, normal));
}
/* floor(n / w) from a guess and the low words of n and w; the guess is wrong by fewer than 2^31 / w. */
static inline uint32_t hp_corrected(uint32_t guess, uint32_t n, uint32_t w) {
  int32_t rest = (int32_t)(n - guess * w);
  for (; rest < 0; rest += (int32_t)w) --guess;
  for (; rest >= (int32_t)w; rest -= (int32_t)w) ++guess;
  return guess;
}

/* floor(v / 2^bits + 1/2); negative bits: v 2^-bits. */
static inline int64_t hp_round_shift(int64_t v, int32_t bits) {
  return bits <= 0 ? (int64_t)((uint64_t)v << -bits) : ((v >> (bits - 1)) + 1) >> 1;
}
static inline int32_t hp_min(int32_t a, int32_t b) { return a < b ? a : b; }
static inline int32_t hp_max(int32_t a, int32_t b) { return a > b ? a : b; }

/* An error, which sticks. */
static inline uint8_t hp_refuse(hp_context* context, uint32_t status) {
  context->status |= status;
  return 0;
}

/* ---- Words */

/* Waits for room for a command of `words` words; false: it is left out. */
uint8_t hp_make_room(hp_context* context, uint32_t words);
/* Room for a command of `words` words from context->next on; false: it is left out. */
static inline uint8_t hp_reserve(hp_context* context, uint32_t words) {
  return (uint32_t)(context->end - context->next) >= words ? 1 : hp_make_room(context, words);
}
/* Before a function of the interface returns: every word is in the stream. */
void hp_settle(hp_context* context);
static inline void hp_put(hp_context* context, uint32_t word) { *context->next++ = word; }
/* ORs the low `bits` bits (1 to 63) of a value into zeroed words. */
static inline void hp_put_bits(uint32_t* words, uint32_t at, uint32_t bits, uint64_t value) {
  value &= ((uint64_t)1 << bits) - 1;
  uint32_t* word = words + at / 32;
  const uint32_t shift = at % 32;
  *word |= (uint32_t)(value << shift);
  for (uint32_t put = 32 - shift; put < bits; put += 32) *++word |= (uint32_t)(value >> put);
}
/* The affine codes of a vertex: HP_AFFINE_WORDS words. */
static inline void hp_write_codes(uint32_t* to, uint32_t depth, uint32_t color) {
  const uint32_t planes = color & (0xffffffffu >> (32 - 8 * HALFPLANE_COLOR_PLANES));
#if HALFPLANE_DEPTH_BITS < 32
  to[0] = depth | (planes << HALFPLANE_DEPTH_BITS);
  if (HP_AFFINE_WORDS > 1) to[1] = planes >> (32 - HALFPLANE_DEPTH_BITS);
#else
  to[0] = depth;
  to[1] = planes;
#endif
}
void hp_put_codes(hp_context* context, uint32_t depth, uint32_t color);
/* The word STATE and the box, inclusive, if they differ; after hp_reserve(). */
void hp_send_state(hp_context* context, uint32_t word);
void hp_send_box(hp_context* context, int32_t left, int32_t top, int32_t right, int32_t bottom);
/* A header and 0 to 2 words after it; false: no room. */
uint8_t hp_put_command(hp_context* context, uint32_t header, uint32_t words, uint32_t first, uint32_t second);
/* A register of a unit; it overwrites the vertex slots. `value`: 128 bits; and one of 64. */
void hp_send_token(hp_context* context, uint32_t which, const uint32_t value[4]);
void hp_send_word(hp_context* context, uint32_t which, uint64_t value);

/* ---- Vertices */

/* A matrix: the last row is 0 0 0 1; or 0 0 -1 0, and none but the diagonal and the fourth element of the third row
   is there. */
enum { HP_IDENTITY, HP_GENERAL, HP_AFFINE, HP_PERSPECTIVE };

/* Code of a depth, u1.31: as binary64 rounds its product with 2^B - 1. */
static inline uint32_t hp_depth_code(uint32_t depth) {
#if HALFPLANE_DEPTH_BITS <= 22
  /* (depth (2^B - 1) + 2^30) / 2^31: what is left over of depth / 2^B takes one from the floor. */
  const uint32_t part = (depth + (((uint32_t)1 << HALFPLANE_DEPTH_BITS) - 1)) >> HALFPLANE_DEPTH_BITS;
  return (depth - part + ((uint32_t)1 << (30 - HALFPLANE_DEPTH_BITS))) >> (31 - HALFPLANE_DEPTH_BITS);
#else
  uint64_t product = (uint64_t)depth * (((uint64_t)1 << HALFPLANE_DEPTH_BITS) - 1); /* 31 fraction bits */
  const uint32_t bits = hp_bits64(product);
  if (bits > 53) { /* of which binary64 keeps 53, the nearest, halves to even */
    const uint32_t dropped = bits - 53;
    const uint64_t half = (uint64_t)1 << (dropped - 1), odd = (product >> dropped) & 1;
    product = ((product + half - 1 + odd) >> dropped) << dropped;
  }
  return (uint32_t)((product + ((uint64_t)1 << 30)) >> 31);
#endif
}
/* From clip space to the window: writes x, y, depth and w. */
void hp_project(const hp_context* context, const hp_fixed clip[4], hp_vertex* vertex);
/* A bit for each plane that has the point outside. */
uint8_t hp_outcode(const hp_context* context, const hp_fixed clip[4]);
int64_t hp_distance(const hp_plane* plane, const hp_fixed clip[4]);
/* Planes and constants from viewport and target. */
void hp_derive_view(hp_context* context);
/* A vertex of a draw, transformed and projected into its place of the cache; null: out of range. */
const hp_vertex* hp_transform(hp_context* context, const hp_vertices* vertices, uint32_t index, hp_vertex* vertex);

/* ---- Primitives */

/* Sends the registers and tokens that differ; false: there is nothing to draw, or no room. */
uint8_t hp_prepare(hp_context* context, uint8_t is_triangle);
/* Whether the target is cleared; else an error. */
uint8_t hp_is_after_clear(hp_context* context);
/* The registers of colours and of stencil, if they differ: of fronts with bit 0 of `tests` and `updates`. */
void hp_set_colors(hp_context* context, const hp_state* state);
void hp_set_stencil(hp_context* context, const hp_stencil side[2], uint32_t tests, uint32_t updates);
/* What a primitive says of the stencil in the word STATE: reads it, writes it, also where a test fails. */
uint32_t hp_stencil_flags(const hp_stencil side[2]);
/* Vertices without an outcode; and any others. */
void hp_send_triangle(hp_context* context, const hp_vertex* a, const hp_vertex* b, const hp_vertex* c);
void hp_clip_triangle(hp_context* context, const hp_vertex* a, const hp_vertex* b, const hp_vertex* c);
/* Twice the area in subpixels, positive where the corners turn to the right on the screen. */
static inline int64_t hp_area(const hp_vertex* a, const hp_vertex* b, const hp_vertex* c) {
  const int32_t ax = (int32_t)b->x - a->x, ay = (int32_t)b->y - a->y;
  const int32_t bx = (int32_t)c->x - a->x, by = (int32_t)c->y - a->y;
  return (int64_t)ax * by - (int64_t)ay * bx;
}
void hp_draw_line(hp_context* context, const hp_vertex* a, const hp_vertex* b);
void hp_draw_point(hp_context* context, const hp_vertex* v);
void hp_corner_of(const hp_vertex* v, hp_corner* corner);
void hp_cut(hp_corner* made, const hp_corner* in, const hp_corner* out, int64_t d_in, int64_t d_out);
/* A corner in the window. */
void hp_project_corner(const hp_context* context, const hp_corner* corner, hp_vertex* vertex);
/* The codes over w of the vertices of the three slots, and their frame: 3 HP_OVER_W_WORDS + HP_FRAME_WORDS words. */
#if HP_HAS_TEXTURES
void hp_over_w(const hp_context* context, const hp_vertex* const v[3], uint32_t* words);
uint32_t hp_quantize_q(const hp_context* context, const hp_vertex* const v[3], uint32_t q[3]);
/* The lines of the level of detail as words: 208 bits. */
void hp_lines_of_levels(const hp_context* context, const hp_vertex* const v[3], int64_t area, uint32_t words[7]);
#if HALFPLANE_NORMALS != 0
/* Codes of a normal of length 1, 2^-15; 0 of 0. */
void hp_normal_codes(const hp_fixed normal[3], int32_t code[3]);
/* Sends what the unit of light does not have yet; null: no light. */
void hp_set_light(hp_context* context, const hp_light* light);
#endif
#endif

#endif
