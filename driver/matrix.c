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

size_t hp_texture_bytes(const hp_texture* texture) {
  return (size_t)16 * texel_bytes(texture) * blocks(texture->log2_width) * blocks(texture->log2_height);
}

void hp_upload_texture(hp_context* context, void* memory, const hp_texture* texture, const void* texels) {
  const uint32_t bytes = texel_bytes(texture), width = (uint32_t)1 << texture->log2_width;
  const uint32_t height = (uint32_t)1 << texture->log2_height, run = width < 4 ? width : 4;
  const unsigned char* from = texels;
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; x += 4) {
      const uint32_t block = (y / 4) * blocks(texture->log2_width) + x / 4;
      memcpy((unsigned char*)memory + (size_t)(16 * block + 4 * (y % 4)) * bytes, from, (size_t)run * bytes);
      from += (size_t)run * bytes;
    }
  context->drops_texels = 1;
}
