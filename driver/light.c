/* Light of each fragment (shade.unit, model/stages/phong.hpp): normals at the vertices, and the registers of the unit. */
#include "internal.h"

#if HALFPLANE_NORMALS != 0

/* floor of the square root. */
static uint32_t root(uint64_t square) {
  uint32_t result = 0;
  for (uint32_t bit = (uint32_t)1 << 31; bit != 0; bit >>= 1) {
    const uint32_t more = result | bit;
    if ((uint64_t)more * more <= square) result = more;
  }
  return result;
}

/* A component over the length, 2^-15, rounded: exact, because the candidate's lower border, 2 r - 1 half codes, is compared
   with it in squares. Nothing lies on a border: 2^32 less an odd square is no sum of two squares. `square`: that of the
   length, of which `length` is the root. */
static uint32_t unit_code(uint32_t size, uint32_t length, uint64_t square) {
  const uint32_t code = hp_divide(((uint64_t)size << 15) + length / 2, length);
  if (code == 0) return 0;
  const uint32_t border = (2 * code - 1) * (2 * code - 1);
  const uint64_t low = (uint64_t)border * (uint32_t)square;
  const uint64_t above = (uint64_t)border * (uint32_t)(square >> 32) + (low >> 32); /* 2^32 */
  return (uint64_t)size * size <= above ? code - 1 : code;
}

void hp_normal_codes(const hp_fixed normal[3], int32_t code[3]) {
  uint32_t size[3], all = 0;
  for (uint32_t i = 0; i < 3; ++i) {
    size[i] = normal[i] < 0 ? 0u - (uint32_t)normal[i] : (uint32_t)normal[i];
    all |= size[i];
  }
  code[0] = code[1] = code[2] = 0;
  if (all == 0) return;
  /* To 31 bits, of 32 there is -2^31 alone: the sum of squares is below 2^64, and the root has 31 bits at least. */
  const int32_t up = 31 - hp_min(31, (int32_t)hp_bits32(all));
  uint64_t square = 0;
  for (uint32_t i = 0; i < 3; ++i) {
    size[i] <<= up;
    square += (uint64_t)size[i] * size[i];
  }
  const uint32_t length = root(square);
  for (uint32_t i = 0; i < 3; ++i) {
    const int32_t unit = (int32_t)unit_code(size[i], length, square);
    code[i] = normal[i] < 0 ? -unit : unit;
  }
}

/* 0...255 as 0...2^12. */
static uint64_t factor(uint32_t color, uint32_t channel) {
  return (((color >> (8 * channel) & 255u) << 12) + 127) / 255;
}
static uint64_t factors(uint32_t color) {
  return factor(color, 0) | (factor(color, 1) << 13) | (factor(color, 2) << 26);
}
static uint64_t pair(int16_t low, int16_t high) { return (uint16_t)low | ((uint64_t)(uint16_t)high << 16); }

void hp_set_light(hp_context* context, const hp_light* light) {
  uint64_t value[6] = {0, 0, 0, 0, 0, 0};
  if (light != NULL) {
    value[0] = (light->specular & 0xffffffu) | ((uint32_t)1 << 24) | ((uint32_t)light->narrow << 25);
    value[1] = factors(light->ambient);
    value[2] = factors(light->diffuse);
    value[3] = pair(light->direction[0], light->direction[1]);
    value[4] = pair(light->direction[2], light->half[0]);
    value[5] = pair(light->half[1], light->half[2]);
  }
  for (uint32_t n = 0; n < (light != NULL ? 6u : 1u); ++n) {
    const uint64_t word = ((uint64_t)3 << 43) | ((uint64_t)n << 40) | value[n];
    if ((context->known & HP_KNOWS_LIGHT << n) == 0 || context->light_word[n] != word)
      hp_send_word(context, HP_LEVELS, word);
    context->known |= HP_KNOWS_LIGHT << n;
    context->light_word[n] = word;
  }
  if (light == NULL || context->light_lines == light->lines) return;
  for (uint32_t i = 0; i < 256; ++i)
    hp_send_word(context, HP_LEVELS,
                 ((uint64_t)3 << 43) | ((uint64_t)6 << 40) | ((uint64_t)i << 27) |
                     ((uint64_t)light->lines[i].start << 11) | (light->lines[i].fall & 0x7ffu));
  context->light_lines = light->lines;
}

#else
typedef int hp_no_light; /* a translation unit is not empty */
#endif
