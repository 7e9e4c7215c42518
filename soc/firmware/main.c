/* Frames of a turning scene, double buffered: the driver writes commands into a ring in memory, the core draws and shows
   them, and the processor sleeps until the interrupt of a frame's fence. Addresses are those of ../halfplane_soc.py. */
#include "halfplane.h"
#include "halfplane_registers.h"
#include "scene.h"
#include "system.h"

/* A register by its name; the struct is packed, so it is not read through. */
#define CORE(name) (*(volatile uint32_t*)(0x90000000u + offsetof(halfplane_t, name)))
#define CORE_IRQ (1u << 3)
#define MEMORY 0x40000000u

/* The memory: the ring; depth and two colour buffers, each colour buffer beside the depths of its tiles; rows of flags. */
#define RING_WORDS 4096u
#define RING MEMORY
#define TILES(pixels) (((uint32_t)(pixels) + HALFPLANE_TILE_SIZE - 1) / HALFPLANE_TILE_SIZE)
#define PLANE (1u << HALFPLANE_PLANE_SHIFT)
#define STRIDE (2 * PLANE * TILES(SCENE_WIDTH))
#define BUFFER (STRIDE * TILES(SCENE_HEIGHT))
#define FLAGS ((SCENE_HEIGHT / 4 + 1u) << HALFPLANE_FLAG_ROW_SHIFT)
#define BUFFERS (MEMORY + 0x10000u)
#define TEXTURE 0x8000u /* from MEMORY on */

static hp_context context;
static volatile uint32_t fence;

void trap(void);
/* The core's line alone is enabled. */
__attribute__((interrupt, aligned(4))) void trap(void) {
  CORE(IRQ_PENDING) = HALFPLANE__IRQ_PENDING__FENCE_bm;
  fence = CORE(FENCE);
}

static void enable_interrupts(void) {
  CORE(IRQ_ENABLE) = HALFPLANE__IRQ_PENDING__FENCE_bm;
  __asm__ volatile(".option arch, +zicsr\n csrw 0xbc0, %0" : : "r"(CORE_IRQ)); /* VexRiscv's mask of lines, in LiteX */
  __asm__ volatile(".option arch, +zicsr\n csrs mie, %0" : : "r"(1u << 11));
  __asm__ volatile(".option arch, +zicsr\n csrs mstatus, %0" : : "r"(1u << 3));
}

/* Sleeps until the fence. Interrupts are off between look and sleep, which ends with one that is pending all the same. */
static void wait_for(uint32_t tag) {
  for (;;) {
    __asm__ volatile(".option arch, +zicsr\n csrc mstatus, %0" : : "r"(1u << 3) : "memory");
    if (fence == tag) break;
    __asm__ volatile("wfi");
    __asm__ volatile(".option arch, +zicsr\n csrs mstatus, %0\n nop\n nop\n nop\n nop"
                     :
                     : "r"(1u << 3)
                     : "memory"); /* taken here */
  }
  __asm__ volatile(".option arch, +zicsr\n csrs mstatus, %0" : : "r"(1u << 3) : "memory");
}

/* Hands the words to the core; returns how many it has read. */
static uint32_t submit(uint32_t written) {
  CORE(RING_TAIL) = written & 0xfffffu;
  return CORE(WORDS);
}

static uint32_t wait_for_room(void* user, uint32_t written) {
  uint32_t read = submit(written);
  (void)user;
  while (written - read > RING_WORDS - HP_LONGEST) read = submit(written);
  return read;
}

#if HALFPLANE_TEXTURE_UNIT
static const hp_texture texture = {TEXTURE, HP_RGBA8888, SCENE_LOG2_TEXELS, SCENE_LOG2_TEXELS, 1};
#endif

static void draw(uint32_t frame) {
  const uint32_t back = frame & 1u, color = BUFFERS + PLANE + back * BUFFER, flags = BUFFERS + 3 * BUFFER;
  const hp_target target = {SCENE_WIDTH, SCENE_HEIGHT, BUFFERS, color, flags, flags + FLAGS * (1 + back),
                            STRIDE,      MEMORY};
  const hp_vertices mesh = {scene_position, scene_color, scene_texcoord, 12, 4, 8, 0, NULL, 0};
  hp_state state = hp_default_state();
  hp_set_target(&context, &target);
  hp_set_matrices(&context, scene_view[frame % SCENE_FRAMES], scene_projection);
  hp_clear(&context, HP_CLEAR_DEPTH | HP_CLEAR_COLOR, SCENE_CLEAR, HP_DEPTH_ONE, 0);
#if HALFPLANE_TEXTURE_UNIT
  state.texture = &texture;
  state.is_linear = 1;
  hp_set_state(&context, &state);
  hp_draw(&context, HP_TRIANGLES, &mesh, scene_floor, SCENE_FLOOR);
  state.texture = NULL;
#endif
  hp_set_state(&context, &state);
  hp_draw(&context, HP_TRIANGLES, &mesh, scene_triangles, SCENE_TRIANGLES);
  hp_draw(&context, HP_LINES, &mesh, scene_lines, SCENE_LINES);
  hp_flush(&context, 1);
  hp_present(&context, color, target.color_flags);
  hp_fence(&context, frame + 1);
  hp_wait_vblank(
      &context); /* then the other buffer is not shown any more: the next frame's commands wait in the ring */
  (void)submit(hp_written(&context));
}

#ifdef CSR_SDRAM_BASE
#define REGISTER(address) (*(volatile uint32_t*)(address))

static void delay(uint32_t turns) {
  while (turns--) __asm__ volatile("nop");
}

/* What LiteX's BIOS does: the steps of the SDRAM's data sheet, then LiteDRAM's controller has it. */
static void begin_sdram(void) {
  for (uint32_t step = 0; step < sizeof sdram_steps / sizeof *sdram_steps; ++step) {
    REGISTER(CSR_SDRAM_DFII_PI0_ADDRESS_ADDR) = sdram_steps[step].address;
    REGISTER(CSR_SDRAM_DFII_PI0_BADDRESS_ADDR) = sdram_steps[step].bank;
    if (sdram_steps[step].is_control) {
      REGISTER(CSR_SDRAM_DFII_CONTROL_ADDR) = sdram_steps[step].word;
    } else {
      REGISTER(CSR_SDRAM_DFII_PI0_COMMAND_ADDR) = sdram_steps[step].word;
      REGISTER(CSR_SDRAM_DFII_PI0_COMMAND_ISSUE_ADDR) = 1;
    }
    delay(sdram_steps[step].delay);
  }
  REGISTER(CSR_SDRAM_DFII_CONTROL_ADDR) = DFII_CONTROL_SEL;
}
#endif

int main(void) {
  const hp_stream ring = {(uint32_t*)RING, RING_WORDS, wait_for_room, NULL};
  if (CORE(CONFIG_ID_LOW) != (uint32_t)hp_config_id() || CORE(CONFIG_ID_HIGH) != (uint32_t)(hp_config_id() >> 32))
    return 1;
#ifdef CSR_SDRAM_BASE
  begin_sdram();
#endif
  CORE(RING_BASE) = RING;
  CORE(RING_SIZE) = RING_WORDS - 1;
  CORE(SCAN_SIZE) = (SCENE_WIDTH - 1) | (uint32_t)(SCENE_HEIGHT - 1) << 16;
  CORE(SCAN_STRIDE) = STRIDE;
  CORE(CONTROL) = HALFPLANE__CONTROL__START_bm;
  enable_interrupts();
  hp_init(&context);
  hp_begin(&context, &ring);
#if HALFPLANE_TEXTURE_UNIT
  hp_upload_texture(&context, (void*)(MEMORY + TEXTURE), &texture, scene_texels);
#endif
  for (uint32_t frame = 0; SCENE_IS_ENDLESS || frame < SCENE_FRAMES; ++frame) {
    draw(frame);
    wait_for(frame + 1);
    CORE(SCAN_CONTROL) = HALFPLANE__SCAN_CONTROL__ENABLE_bm; /* from the first picture on */
  }
  return (int)hp_status(&context);
}
