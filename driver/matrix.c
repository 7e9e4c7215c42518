/* Matrices, and the memory of textures. */
#include <string.h>

#include "internal.h"

static uint8_t fits(const hp_fixed matrix[16]) {
  for (uint32_t row = 0; row < 4; ++row) {
    uint64_t sum = 0;
    for (uint32_t i = 0; i < 4; ++i) {
      const int64_t element = matrix[4 * row + i];
      sum += (uint64_t)(element < 0 ? -element : element);
    }
    if (sum >> 32 != 0) return 0;
  }
  return 1;
}

static uint8_t kind_of(const hp_fixed m[16]) {
  if (m == NULL) return HP_IDENTITY;
  if (m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == HP_ONE) return HP_AFFINE;
  uint8_t is_perspective = m[14] == -HP_ONE;
  static const uint8_t zero[] = {1, 2, 3, 4, 6, 7, 8, 9, 12, 13, 15};
  for (uint32_t i = 0; i < sizeof zero; ++i)
    if (m[zero[i]] != 0) is_perspective = 0;
  return is_perspective != 0 ? HP_PERSPECTIVE : HP_GENERAL;
}

void hp_set_matrices(hp_context* context, const hp_fixed view[16], const hp_fixed projection[16]) {
  if ((view != NULL && fits(view) == 0) || (projection != NULL && fits(projection) == 0)) {
    context->status |= HP_BAD_VALUE;
    return;
  }
  context->view_kind = kind_of(view);
  context->projection_kind = kind_of(projection);
  for (uint32_t i = 0; view != NULL && i < 3; ++i) context->view_offset[i] = ((int64_t)view[4 * i + 3] * 65536) | 32768;
  if (view != NULL) memcpy(context->view, view, sizeof context->view);
  if (projection != NULL) memcpy(context->projection, projection, sizeof context->projection);
}

void hp_multiply(hp_fixed out[16], const hp_fixed a[16], const hp_fixed b[16]) {
  for (uint32_t row = 0; row < 4; ++row)
    for (uint32_t column = 0; column < 4; ++column) {
      uint64_t sum = 32768; /* modulo 2^64 */
      for (uint32_t i = 0; i < 4; ++i) sum += (uint64_t)((int64_t)a[4 * row + i] * b[4 * i + column]);
      out[4 * row + column] = (hp_fixed)((int64_t)sum >> 16);
    }
}

/* In memory: rows of blocks of 4x4 texels; sides below 4 are padded to a block. */
static uint32_t texel_bytes(const hp_texture* texture) {
  return texture->format == HP_L8 ? 1 : texture->format == HP_RGBA8888 ? 4 : 2;
}
static uint32_t blocks(uint32_t log2_size) { return log2_size < 2 ? 1 : (uint32_t)1 << (log2_size - 2); }

/* Where a level begins, in blocks from level 0 on: levels follow each other. After the first one of a block two more may
   come; they share the next block, the last one at its texel (2, 2). */
static uint32_t level_place(const hp_texture* texture, uint32_t level, uint8_t* is_corner) {
  uint32_t place = 0, width = texture->log2_width, height = texture->log2_height, n = 0;
  for (; n < level && (width > 2 || height > 2); ++n) {
    place += blocks(width) * blocks(height);
    if (width > 0) --width;
    if (height > 0) --height;
  }
  *is_corner = level == n + 2;
  return level > n ? place + 1 : place;
}
static uint32_t side(uint32_t log2_size, uint32_t level) { return log2_size > level ? log2_size - level : 0; }

size_t hp_texture_bytes(const hp_texture* texture) {
  const uint32_t last = texture->levels > 1 ? texture->levels - 1u : 0;
  uint8_t is_corner;
  const uint32_t place = level_place(texture, last, &is_corner);
  return (size_t)16 * texel_bytes(texture) *
         (place + blocks(side(texture->log2_width, last)) * blocks(side(texture->log2_height, last)));
}

void hp_upload_texture(hp_context* context, void* memory, const hp_texture* texture, const void* texels) {
  const uint32_t bytes = texel_bytes(texture);
  const unsigned char* from = texels;
  for (uint32_t level = 0; level == 0 || level < texture->levels; ++level) {
    const uint32_t log2_width = side(texture->log2_width, level);
    const uint32_t width = (uint32_t)1 << log2_width, run = width < 4 ? width : 4;
    const uint32_t height = (uint32_t)1 << side(texture->log2_height, level);
    uint8_t is_corner;
    const uint32_t place = level_place(texture, level, &is_corner), corner = is_corner != 0 ? 4 * 2 + 2 : 0;
    for (uint32_t y = 0; y < height; ++y)
      for (uint32_t x = 0; x < width; x += 4) {
        const uint32_t block = place + (y / 4) * blocks(log2_width) + x / 4;
        memcpy((unsigned char*)memory + (size_t)(16 * block + 4 * (y % 4) + corner) * bytes, from, (size_t)run * bytes);
        from += (size_t)run * bytes;
      }
  }
  context->drops_texels = 1;
}
