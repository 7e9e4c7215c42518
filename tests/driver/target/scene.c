/* What instructions are counted of: a mesh of triangle strips, or nothing; for processors without an operating
   system. The
   program's only output is its exit code. WORK 0: the mesh and a clear; 1: and the mesh's strips; 2: and the strips, with every triangle culled. */
#include "halfplane.h"

#ifndef COLUMNS
#define COLUMNS 32
#endif
#define ROWS 4
#ifndef LEVELS
#define LEVELS 1
#endif

static hp_context context;
static uint32_t words[16384];
static hp_fixed position[(COLUMNS + 1) * 2 * ROWS * 3], texcoord[(COLUMNS + 1) * 2 * ROWS * 2];
static hp_fixed normal[(COLUMNS + 1) * 2 * ROWS * 3];
static uint32_t color[(COLUMNS + 1) * 2 * ROWS];

static int draw(void) {
  static const hp_fixed view[16] = {60000, 3000,  -2000, 500,        -3000, 60000, 900, 0,
                                    2100,  -1000, 65536, -3 * 65536, 0,     0,     0,   65536};
  static const hp_fixed projection[16] = {65536, 0, 0, 0, 0, 87381, 0, 0, 0, 0, -67000, -13000, 0, 0, -65536, 0};
  const hp_stream stream = {words, sizeof words / sizeof *words, 0, 0};
  const hp_target target = {
      320, 240, 0, 1u << HALFPLANE_PLANE_SHIFT, 0x60000, 0x68000, 320 / 8 * 2 << HALFPLANE_PLANE_SHIFT, 0x80000};
  const hp_vertices vertices = {position, color, texcoord, 12, 4, 8, 0, normal, 12};
  uint32_t n = 0;
  for (uint32_t row = 0; row < ROWS; ++row)
    for (uint32_t i = 0; i <= COLUMNS; ++i)
      for (uint32_t side = 0; side < 2; ++side, ++n) {
        position[3 * n] = (hp_fixed)(i * (131072 / COLUMNS)) - 65536;
        position[3 * n + 1] = (hp_fixed)((row + side) * (131072 / ROWS)) - 65536;
        position[3 * n + 2] = (hp_fixed)((i * 7 + side * 1000) % 9000);
        texcoord[2 * n] = (hp_fixed)(i * 3000);
        texcoord[2 * n + 1] = (hp_fixed)(side * 65536);
#ifdef LIT
        normal[3 * n] = (hp_fixed)(i * 5000) - 70000;
        normal[3 * n + 1] = (hp_fixed)(side * 9000);
        normal[3 * n + 2] = 65536;
#endif
        color[n] = n * 0x01030507u;
      }
  hp_init(&context);
  hp_begin(&context, &stream);
  hp_set_target(&context, &target);
  hp_set_matrices(&context, view, projection);
  hp_clear(&context, HP_CLEAR_COLOR | HP_CLEAR_DEPTH, 0, HP_DEPTH_ONE, 0);
  hp_state state = hp_default_state();
#if WORK == 2
  state.cull = HP_CULL_BOTH;
#endif
#ifdef LIT
  static hp_light_line lines[256];
  static const hp_light light = {{0, 0, 32767}, {0, 0, 32767}, 0x333333, 0xffffff, 0x808080, lines, 2};
  state.light = &light;
#endif
#ifdef TEXTURED
  static const hp_texture texture = {0, HP_RGB565, 6, 6, LEVELS};
  state.texture = &texture;
#if LEVELS > 1
  state.is_linear = 1;
  state.levels = HP_TWO_LEVELS;
#endif
#endif
  hp_set_state(&context, &state);
  static uint16_t indices[ROWS * 2 * (COLUMNS + 1)];
  for (uint32_t i = 0; i < ROWS * 2 * (COLUMNS + 1); ++i) indices[i] = (uint16_t)i;
#if WORK != 0
  for (uint32_t row = 0; row < ROWS; ++row)
    hp_draw(&context, HP_TRIANGLE_STRIP, &vertices, &indices[row * 2 * (COLUMNS + 1)], 2 * (COLUMNS + 1));
  if (hp_count(&context)->triangles != 2 * COLUMNS * ROWS) return 2;
#endif
  if (vertices.position[0] == 1 || normal[5] == 1 || indices[9] == 1) return 3; /* the mesh is made in any case */
  hp_flush(&context, 1);
  return (int)hp_status(&context);
}

void* memcpy(void* to, const void* from, size_t size) {
  unsigned char* t = to;
  const unsigned char* f = from;
  if ((((uintptr_t)t | (uintptr_t)f | size) & 3u) == 0) {
    for (; size != 0; size -= 4, t += 4, f += 4) *(uint32_t*)(void*)t = *(const uint32_t*)(const void*)f;
    return to;
  }
  for (; size != 0; --size) *t++ = *f++;
  return to;
}
void* memset(void* to, int value, size_t size) {
  unsigned char* t = to;
  for (; size != 0; --size) *t++ = (unsigned char)value;
  return to;
}

void _start(void);
void _start(void) {
  const int code = draw();
#if defined(__riscv)
  register long a0 __asm__("a0") = code, a7 __asm__("a7") = 93;
  __asm__ volatile("ecall" : : "r"(a0), "r"(a7));
#else
  register int r0 __asm__("r0") = code, r7 __asm__("r7") = 1;
  __asm__ volatile("svc 0" : : "r"(r0), "r"(r7));
#endif
  for (;;) {
  }
}
