#include "detile.h"

static uint32_t log2_of(uint32_t value) {
  uint32_t shift = 0;
  while ((value >> shift) > 1u) ++shift;
  return shift;
}

static uint32_t code_at(const uint8_t* at, uint32_t bytes) {
  uint32_t code = 0;
  for (uint32_t n = 0; n < bytes; ++n) code |= (uint32_t)at[n] << (8u * n);
  return code;
}

/* Channel by channel to the nearest, halves up. */
static uint32_t mean_of(const uint8_t* at, uint32_t colors, uint32_t bytes) {
  static const uint8_t shift_of[2][4] = {{0, 5, 11, 16}, {0, 8, 16, 24}};
  static const uint8_t mask_of[2][4] = {{31, 63, 31, 0}, {255, 255, 255, 255}};
  const uint32_t kind = bytes == 2u ? 0u : 1u;
  uint32_t mean = 0;
  for (uint32_t c = 0; c < 4u; ++c) {
    uint32_t sum = colors / 2u;
    for (uint32_t n = 0; n < colors; ++n)
      sum += (code_at(at + n * bytes, bytes) >> shift_of[kind][c]) & mask_of[kind][c];
    mean |= (sum / colors) << shift_of[kind][c];
  }
  return mean;
}

static uint8_t* put(uint32_t code, uint32_t bytes, uint8_t* out, enum halfplane_format format) {
  uint32_t r, g, b; /* 8 bits each */
  if (bytes == 2u) {
    r = code >> 11;
    g = (code >> 5) & 63u;
    b = code & 31u;
    r = (r << 3) | (r >> 2);
    g = (g << 2) | (g >> 4);
    b = (b << 3) | (b >> 2);
  } else {
    r = code & 255u;
    g = (code >> 8) & 255u;
    b = (code >> 16) & 255u;
  }
  switch (format) {
    case HALFPLANE_OUT_RGB565:
      *out++ = (uint8_t)(((g & 0x1cu) << 3) | (b >> 3));
      *out++ = (uint8_t)((r & 0xf8u) | (g >> 5));
      break;
    case HALFPLANE_OUT_RGB888:
      *out++ = (uint8_t)r;
      *out++ = (uint8_t)g;
      *out++ = (uint8_t)b;
      break;
    case HALFPLANE_OUT_XRGB8888:
    default:
      *out++ = (uint8_t)b;
      *out++ = (uint8_t)g;
      *out++ = (uint8_t)r;
      *out++ = 0;
      break;
  }
  return out;
}

void halfplane_detile(const uint8_t* memory, const halfplane_layout* layout, uint32_t width, uint32_t height,
                      uint8_t* out, enum halfplane_format format) {
  const uint32_t tile = log2_of(layout->tile), block = log2_of(layout->block), stamp = log2_of(layout->stamp);
  const uint32_t bytes = layout->color_bytes, block_bytes = (uint32_t)layout->colors * bytes << (2u * block);
  const uint32_t in_tile = layout->tile - 1u, in_block = layout->block - 1u, in_stamp = layout->stamp - 1u;
  for (uint32_t y = 0; y < height; ++y) {
    const uint8_t* const row = memory + layout->color_base + (y >> tile) * layout->row_stride;
    const uint8_t* const flags = memory + layout->color_flags_base + (y >> block) * layout->flag_row_bytes;
    const uint32_t blocks_above = ((y & in_tile) >> block) << (tile - block); /* of the tile */
    const uint32_t pixels_above = (((y & in_block) >> stamp) << (block + stamp)) + ((y & in_stamp) << stamp);
    uint32_t is_cleared = 0, colors = layout->colors; /* of the block */
    for (uint32_t x = 0; x < width; ++x) {
      if ((x & in_block) == 0u) {
        const uint32_t byte = x >> block >> 3, bit = (x >> block) & 7u;
        is_cleared = layout->has_flags != 0 ? ((uint32_t)flags[byte] >> bit) & 1u : 0u;
        if (layout->compresses != 0) {
          const uint32_t is_of_pixels = ((uint32_t)flags[layout->flag_row_bytes / 2u + byte] >> bit) & 1u;
          colors = is_of_pixels != 0u ? 1u : layout->colors;
        }
      }
      if (is_cleared != 0u) {
        out = put(layout->clear_color, bytes, out, format);
        continue;
      }
      const uint32_t pixel = pixels_above + (((x & in_block) >> stamp) << (2u * stamp)) + (x & in_stamp);
      const uint8_t* const at = row + (x >> tile) * 2u * layout->plane_bytes +
                                (blocks_above + ((x & in_tile) >> block)) * block_bytes + pixel * colors * bytes;
      out = put(colors == 1u ? code_at(at, bytes) : mean_of(at, colors, bytes), bytes, out, format);
    }
  }
}
