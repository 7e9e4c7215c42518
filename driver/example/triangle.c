/* Draws a triangle: its words to standard output, for halfplane_draw_words. docs/driver.md shows this program. */
#include <stdio.h>

#include "halfplane.h"

static hp_context context;
static uint32_t words[256];

int main(void) {
  /* x, y, z; the corners turn to the left */
  static const hp_fixed position[] = {-HP_ONE / 2, -HP_ONE / 2, 0, HP_ONE / 2, -HP_ONE / 2, 0, 0, HP_ONE / 2, 0};
  static const uint32_t color[] = {HP_RGBA(255, 0, 0, 255), HP_RGBA(0, 255, 0, 255), HP_RGBA(0, 0, 255, 255)};
  const hp_vertices vertices = {position, color, NULL, 3 * sizeof(hp_fixed), sizeof(uint32_t), 0, 0, NULL, 0};
  const hp_stream stream = {words, sizeof words / sizeof *words, NULL, NULL};
  /* 320x240 pixels; rows of tiles of 8x8 pixels, of which each takes 256 bytes: depth, then colour */
  const hp_target target = {320, 240, 0x0000, 0x0080, 0x60000, 0x68000, 320 / 8 * 256, 0x80000};

  hp_init(&context);
  hp_begin(&context, &stream);
  hp_set_target(&context, &target);
  hp_clear(&context, HP_CLEAR_COLOR | HP_CLEAR_DEPTH, HP_RGBA(32, 32, 48, 255), HP_DEPTH_ONE, 0);

  hp_state state = hp_default_state();
  state.cull = HP_CULL_BACK;
  hp_set_state(&context, &state);
  hp_draw(&context, HP_TRIANGLES, &vertices, NULL, 3);

  hp_flush(&context, 1);
  hp_fence(&context, 1);
  hp_present(&context, target.color, target.color_flags);
  hp_stop(&context);
  if (hp_status(&context) != 0) return 1;
  /* In a system: clean the cache, give the address and hp_written() words to the core, and wait for the fence's
     interrupt. */
  return fwrite(words, sizeof *words, hp_written(&context), stdout) == hp_written(&context) ? 0 : 1;
}
