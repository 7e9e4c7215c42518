/* The picture in a colour buffer, for a processor: the way of core/scan_out.sv. Freestanding C99, no heap, nothing of libc.
   docs/memory.md has the layout, docs/scan-out.md an example. */
#ifndef HALFPLANE_DETILE_H
#define HALFPLANE_DETILE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Where colours lie. The first part is the configuration's, HALFPLANE_LAYOUT() fills it from halfplane_config.h. */
typedef struct halfplane_layout {
  uint8_t tile;            /* pixels along a tile; all sizes are powers of two */
  uint8_t block;           /* pixels along a block: a cache line; with cache.kind tiles a tile */
  uint8_t stamp;           /* pixels along a stamp */
  uint8_t colors;          /* of a pixel in memory: its samples, or 1; at most 8 */
  uint8_t color_bytes;     /* 2: rgb565, 4: rgba8888 */
  uint8_t compresses;      /* 1: compress.unit, a flag tells blocks with one colour a pixel */
  uint8_t has_flags;       /* 1: frame.clears flags, a flag tells cleared blocks */
  uint32_t plane_bytes;    /* of a tile's buffer */
  uint32_t flag_row_bytes; /* from the flags of a row of blocks to those of the next */
  /* The frame's: as raster_top got them. */
  uint32_t color_base, color_flags_base, row_stride;
  uint32_t clear_color; /* stored code of the last fast clear */
} halfplane_layout;

/* clang-format off */
#define HALFPLANE_LAYOUT(color_base, color_flags_base, row_stride, clear_color)                       \
  { HALFPLANE_TILE_SIZE, HALFPLANE_BLOCK_SIDE * HALFPLANE_STAMP_SIZE, HALFPLANE_STAMP_SIZE,           \
    HALFPLANE_MEMORY_COLORS / HALFPLANE_PIXELS, HALFPLANE_COLOR_SAMPLE_BYTES,                         \
    HALFPLANE_COMPRESS_UNIT, HALFPLANE_FRAME_CLEARS == 1, 1u << HALFPLANE_PLANE_SHIFT,                \
    1u << HALFPLANE_FLAG_ROW_SHIFT, (color_base), (color_flags_base), (row_stride), (clear_color) }
/* clang-format on */

enum halfplane_format {
  HALFPLANE_OUT_RGB565,  /* 2 bytes a pixel, low byte first, red highest; of 8 bits a channel the highest are kept */
  HALFPLANE_OUT_RGB888,  /* 3 bytes: red, green, blue; narrow channels repeat their highest bits, as in the PNGs */
  HALFPLANE_OUT_XRGB8888 /* 4 bytes: blue, green, red, 0: a little-endian word with red in bits 23...16 */
};

/* Writes rows from the top without padding: width * height pixels, at least 1 each, which may be any part of the target
   from its first pixel on. `memory` is what address 0 of the layout is; several samples of a pixel give their mean. */
void halfplane_detile(const uint8_t* memory, const halfplane_layout* layout, uint32_t width, uint32_t height,
                      uint8_t* out, enum halfplane_format format);

#ifdef __cplusplus
}
#endif

#endif
