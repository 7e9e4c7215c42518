/* What the files of the driver share. Arithmetic shifts of negative numbers are floors, as every compiler has them that
   the driver is built with. */
#ifndef HALFPLANE_DRIVER_INTERNAL_H
#define HALFPLANE_DRIVER_INTERNAL_H

#include "halfplane.h"
#include "stream.h"

#if HALFPLANE_COORDINATE_BITS > 16
#error "the command stream has 16 bits for a coordinate: make guard.band or subpixel.bits smaller"
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
#define HP_LINE_WORDS ((HALFPLANE_LINE_SETUP_BITS - HALFPLANE_PRIMITIVE_ID_BITS + 31) / 32)

#define HP_NO_TAG ((uint32_t)0xffffffffu)
#define HP_CORNER_TAG ((uint32_t)0x10000u) /* tags from here on: corners of one polygon */

/* ---- Arithmetic */

/* Bits of a number: 0 of 0. */
static inline uint32_t hp_bits32(uint32_t v) {
  uint32_t bits = 0;
  for (uint32_t step = 16; step != 0; step >>= 1)
    if ((v >> step) != 0) {
      bits += step;
      v >>= step;
    }
  return bits + v;
}
static inline uint32_t hp_bits64(uint64_t v) {
  const uint32_t high = (uint32_t)(v >> 32);
  return high != 0 ? 32 + hp_bits32(high) : hp_bits32((uint32_t)v);
}

/* n / d for n / 2^32 < d: two divisions of 32 bits (schoolbook, digits of 16 bits). */
uint32_t hp_divide(uint64_t n, uint32_t d);
/* floor(n / d + 1/2), d > 0; beyond +-2^32 some number beyond. */
int64_t hp_divide_rounded(int64_t n, uint32_t d);

/* floor(v / 2^bits + 1/2); negative bits: v 2^-bits. */
static inline int64_t hp_round_shift(int64_t v, int32_t bits) {
  return bits <= 0 ? (int64_t)((uint64_t)v << -bits) : ((v >> (bits - 1)) + 1) >> 1;
}
static inline int32_t hp_min(int32_t a, int32_t b) { return a < b ? a : b; }
static inline int32_t hp_max(int32_t a, int32_t b) { return a > b ? a : b; }

/* ---- Words */

/* Room for a command of `words` words; false: it is left out. */
uint8_t hp_reserve(hp_context* context, uint32_t words);
static inline void hp_put(hp_context* context, uint32_t word) {
  context->stream.words[context->at] = word;
  if (++context->at == context->stream.size) context->at = 0;
  ++context->written;
}
/* ORs the low `bits` bits (1 to 64) of a value into zeroed words. */
static inline void hp_put_bits(uint32_t* words, uint32_t at, uint32_t bits, uint64_t value) {
  if (bits < 64) value &= ((uint64_t)1 << bits) - 1;
  uint32_t* word = words + at / 32;
  const uint32_t shift = at % 32;
  *word |= (uint32_t)(value << shift);
  for (uint32_t put = 32 - shift; put < bits; put += 32) *++word |= (uint32_t)(value >> put);
}
/* The affine codes of a vertex. */
void hp_put_codes(hp_context* context, uint32_t depth, uint32_t color);

/* ---- Vertices */

/* Code of a depth, u1.31: as binary64 rounds its product with 2^B - 1. */
uint32_t hp_depth_code(uint32_t depth);
/* From clip space to the window: writes x, y, depth and w. */
void hp_project(const hp_context* context, const hp_fixed clip[4], hp_vertex* vertex);
/* A bit for each plane that has the point outside. */
uint8_t hp_outcode(const hp_context* context, const hp_fixed clip[4]);
int64_t hp_distance(const hp_plane* plane, const hp_fixed clip[4]);
/* Planes and constants from viewport and target. */
void hp_derive_view(hp_context* context);
/* A vertex of a draw, transformed and projected; null: out of range. */
const hp_vertex* hp_fetch(hp_context* context, const hp_vertices* vertices, uint32_t index);

/* ---- Primitives */

/* Sends the registers and tokens that differ; false: there is nothing to draw, or no room. */
uint8_t hp_prepare(hp_context* context, uint8_t is_triangle);
/* Sends the box, inclusive, if it differs. */
void hp_send_box(hp_context* context, int32_t left, int32_t top, int32_t right, int32_t bottom);
void hp_draw_triangle(hp_context* context, const hp_vertex* const v[3]);
void hp_draw_line(hp_context* context, const hp_vertex* a, const hp_vertex* b);
void hp_draw_point(hp_context* context, const hp_vertex* v);
void hp_corner_of(const hp_vertex* v, hp_corner* corner);
void hp_cut(hp_corner* made, const hp_corner* in, const hp_corner* out, int64_t d_in, int64_t d_out);
/* A corner in the window. */
void hp_project_corner(const hp_context* context, const hp_corner* corner, hp_vertex* vertex);
/* The codes over w of three vertices and their frame: words[i] those of vertex i. */
#if HP_HAS_TEXTURES
void hp_over_w(const hp_context* context, const hp_vertex* const v[3], uint32_t words[3][HP_OVER_W_WORDS],
               uint32_t frame[HP_FRAME_WORDS]);
#endif

#endif
