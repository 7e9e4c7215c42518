/* The command stream's numbers, those of core/. */
#ifndef HALFPLANE_DRIVER_STREAM_H
#define HALFPLANE_DRIVER_STREAM_H

#define HP_SET 0x01u
#define HP_FENCE 0x02u
#define HP_PRESENT 0x03u
#define HP_WAIT_VBLANK 0x04u
#define HP_STOP 0x05u
#define HP_TRIANGLE 0x10u
#define HP_RECTANGLE 0x11u
#define HP_FAST_CLEAR 0x12u
#define HP_FLUSH 0x13u
#define HP_POINT 0x14u
#define HP_LINE 0x16u
#define HP_TOKEN 0x17u

#define HP_HEADER(opcode, fields) (((uint32_t)(opcode) << 24) | (uint32_t)(fields))
#define HP_SET_OF(first, count) HP_HEADER(HP_SET, (uint32_t)(first) | ((uint32_t)(count) << 8))
#define HP_FLIP 8u /* of a triangle */
#define HP_OVER_W 16u

/* State registers */
#define HP_BOX_MIN 0u
#define HP_STATE 2u
#define HP_TARGET 3u

/* Registers of units: tokens */
enum {
  HP_TEXTURE,
  HP_LEVELS,
  HP_LINES_OF_LEVELS,
  HP_STENCIL_TEST,
  HP_COLOR_OPS,
  HP_BLEND_CONSTANT,
  HP_ALPHA_TEST,
  HP_STENCIL_UPDATE
};

#endif
