/* The driver of the core: draws into a command stream of 32-bit words. Freestanding C99: no heap, no floating point, of
   libc memcpy and memset alone. docs/driver.md shows the whole of it on one page; core/ has the stream's words.

   Numbers are s15.16 (hp_fixed: 65536 is 1) unless a comment says otherwise. Errors stick: hp_status() has them, and no
   word is sent that the core refuses. One driver is compiled for one configuration, halfplane_config.h. */
#ifndef HALFPLANE_DRIVER_H
#define HALFPLANE_DRIVER_H

#include <stddef.h>
#include <stdint.h>

#ifdef HALFPLANE_CONFIG_FILE
#include HALFPLANE_CONFIG_FILE
#else
#include "halfplane_config.h"
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef int32_t hp_fixed;
typedef struct hp_context hp_context; /* at the end of this file; its content is the driver's */

#define HP_ONE ((hp_fixed)65536)
#define HP_DEPTH_ONE ((uint32_t)1 << 31) /* 1 of a depth: u1.31 */
#define HP_RESTART ((uint16_t)0xffffu)   /* among indices: ends a strip, fan or loop, and begins the next one */
#define HP_RGBA(r, g, b, a) \
  ((uint32_t)(r) | ((uint32_t)(g) << 8) | ((uint32_t)(b) << 16) | ((uint32_t)(a) << 24)) /* a colour: R lowest */

/* What hp_status() says; several may be set. */
#define HP_FULL ((uint32_t)1)         /* the stream had no room: words were left out */
#define HP_BAD_VALUE ((uint32_t)2)    /* an argument out of its range; the call did nothing */
#define HP_OUT_OF_RANGE ((uint32_t)4) /* a vertex beyond +-32768 after a matrix: its primitives were left out */
#define HP_POLYGON ((uint32_t)8)      /* a clipped triangle of too many corners was left out */
#define HP_UNSUPPORTED ((uint32_t)16) /* this configuration has no unit for it; the call did nothing */
/* A call before its turn, which did nothing: a draw, hp_flush() or another clear before the hp_clear() of depth and
   colour of the whole target, or hp_present() of what was drawn without hp_flush(). */
#define HP_WRONG_ORDER ((uint32_t)32)

enum hp_topology { HP_TRIANGLES, HP_TRIANGLE_STRIP, HP_TRIANGLE_FAN, HP_LINES, HP_LINE_STRIP, HP_LINE_LOOP, HP_POINTS };
enum hp_func { HP_NEVER, HP_LESS, HP_LEQUAL, HP_EQUAL, HP_GREATER, HP_GEQUAL, HP_NOTEQUAL, HP_ALWAYS };
enum hp_cull { HP_CULL_NONE, HP_CULL_BACK, HP_CULL_FRONT, HP_CULL_BOTH };
enum hp_front { HP_CCW, HP_CW }; /* as seen on the screen */
enum hp_factor {
  HP_ZERO,
  HP_ONE_FACTOR,
  HP_SRC_COLOR,
  HP_ONE_MINUS_SRC_COLOR,
  HP_DST_COLOR,
  HP_ONE_MINUS_DST_COLOR,
  HP_SRC_ALPHA,
  HP_ONE_MINUS_SRC_ALPHA,
  HP_DST_ALPHA,
  HP_ONE_MINUS_DST_ALPHA,
  HP_CONSTANT_COLOR,
  HP_ONE_MINUS_CONSTANT_COLOR,
  HP_CONSTANT_ALPHA,
  HP_ONE_MINUS_CONSTANT_ALPHA,
  HP_SRC_ALPHA_SATURATE
};
enum hp_equation { HP_ADD, HP_SUBTRACT, HP_REVERSE_SUBTRACT, HP_MIN, HP_MAX };
/* A fragment's code s and the stored code d, bit by bit. */
enum hp_logic {
  HP_LOGIC_CLEAR,
  HP_LOGIC_AND,
  HP_LOGIC_AND_REVERSE, /* s & ~d */
  HP_LOGIC_COPY,
  HP_LOGIC_AND_INVERTED, /* ~s & d */
  HP_LOGIC_NOOP,
  HP_LOGIC_XOR,
  HP_LOGIC_OR,
  HP_LOGIC_NOR,
  HP_LOGIC_EQUIV,
  HP_LOGIC_INVERT,
  HP_LOGIC_OR_REVERSE, /* s | ~d */
  HP_LOGIC_COPY_INVERTED,
  HP_LOGIC_OR_INVERTED, /* ~s | d */
  HP_LOGIC_NAND,
  HP_LOGIC_SET
};
enum hp_stencil_op { HP_KEEP, HP_TO_ZERO, HP_REPLACE, HP_INCR, HP_DECR, HP_INVERT, HP_INCR_WRAP, HP_DECR_WRAP };
enum hp_line_rule { HP_MIDPOINT, HP_BRESENHAM, HP_DIAMOND };
enum hp_texture_format { HP_L8, HP_LA88, HP_RGB565, HP_RGBA5551, HP_RGBA4444, HP_RGBA8888 };
/* Beyond the image; HP_HALF_BORDER: the last texel, of which a linear filter mixes half with the border (GL_CLAMP). */
enum hp_wrap { HP_REPEAT, HP_CLAMP, HP_MIRROR, HP_BORDER, HP_HALF_BORDER };
enum hp_levels { HP_LEVEL_0, HP_NEAREST_LEVEL, HP_TWO_LEVELS };
enum hp_combine { HP_MODULATE, HP_REPLACE_COLOR, HP_DECAL, HP_ADD_COLOR, HP_BLEND_COLOR }; /* the last: to a constant */

/* Where the words go: memory of the caller, a buffer or a ring. */
typedef struct hp_stream {
  uint32_t* words;
  uint32_t size; /* words, at least HP_LONGEST */
  /* Called where the next command does not fit: hands `written` (words since hp_begin, modulo 2^32) to the core,
     waits, and
     returns how many of them the core has read. Null: a buffer; where it ends, HP_FULL. */
  uint32_t (*wait)(void* user, uint32_t written);
  void* user;
} hp_stream;

/* The buffers in memory, as docs/memory.md says: byte addresses, and the bytes from one row of tiles to the next. */
typedef struct hp_target {
  uint16_t width, height;            /* pixels */
  uint32_t depth, color;             /* multiples of 1 << HALFPLANE_PLANE_SHIFT */
  uint32_t depth_flags, color_flags; /* of 1 << HALFPLANE_FLAG_ROW_SHIFT */
  uint32_t row_stride;               /* of 1 << HALFPLANE_PLANE_SHIFT; at least two of these for each tile of a row */
  uint32_t textures;                 /* of 4096 */
} hp_target;

typedef struct hp_viewport {
  hp_fixed x, y, width, height;   /* pixels, y down; inside the guard band */
  uint32_t near_depth, far_depth; /* u1.31: depths of the near and the far plane */
  uint8_t zero_to_one;            /* clip z is 0...w, not -w...w */
} hp_viewport;

typedef struct hp_stencil {
  uint8_t func, reference, read_mask, write_mask;
  uint8_t stencil_fails, depth_fails, passes;
} hp_stencil;

typedef struct hp_texture {
  uint32_t address; /* from hp_target.textures on; a multiple of 64 */
  uint8_t format;
  uint8_t log2_width, log2_height; /* 0 to 12 */
  uint8_t levels;                  /* in memory, each half of the one before; 0: 1 */
} hp_texture;

/* A table of fog over the distance w, for triangles (fog.unit): halfplane_fog_table writes one. */
typedef struct hp_fog_line {
  int32_t start, rise; /* 2^-15 */
} hp_fog_line;
typedef struct hp_fog {
  const hp_fog_line* lines; /* 256 */
  int16_t first;            /* of 2^octave_bits octaves of 1/w, log2 */
  uint8_t octave_bits;
} hp_fog;

/* Light of each fragment of triangles, from the normals of their vertices (shade.unit): the colour C becomes
   C (ambient + diffuse N.L) + specular (N.H)^shininess. halfplane_light_table writes one; direction and colours may be
   changed in a copy. */
typedef struct hp_light_line {
  uint16_t start, fall; /* 2^-15 */
} hp_light_line;
typedef struct hp_light {
  int16_t direction[3], half[3];       /* L to the light, H between that and the eye: of length 1, 2^-15 */
  uint32_t ambient, diffuse, specular; /* HP_RGBA */
  const hp_light_line* lines;          /* 256, of the power */
  uint8_t narrow;                      /* they cover 1 - N.H below 2^-narrow: 0 to 7 */
} hp_light;

/* The state of draws; hp_default_state() has that of OpenGL. */
typedef struct hp_state {
  uint8_t depth_test, depth_write;
  uint8_t color_mask; /* channels that are written: 1 R, 2 G, 4 B, 8 A */
  uint8_t cull, front;
  uint8_t blends; /* then: */
  uint8_t src, dst, src_alpha, dst_alpha, equation, equation_alpha;
  uint32_t blend_color;
  uint8_t logic_op; /* but with HP_LOGIC_COPY nothing blends */
  uint8_t dithers;
  uint8_t alpha_func, alpha_reference;
  uint8_t sample_mask;       /* bit k: sample k of a pixel is drawn (msaa.samples); 255: all */
  uint8_t alpha_to_coverage; /* alpha gives the number of samples that are drawn */
  uint8_t has_stencil;       /* then: */
  hp_stencil stencil[2];     /* of fronts, of backs */
  const hp_texture* texture; /* null: none; of triangles; it must stay until the state is replaced */
  uint8_t wrap_u, wrap_v, combine;
  uint32_t texture_constant, texture_border; /* HP_RGBA: of HP_BLEND_COLOR; of HP_BORDER and HP_HALF_BORDER */
  uint8_t is_linear;                         /* the filter */
  uint8_t minifies_otherwise;                /* the other filter where a pixel spans more than a texel */
  uint8_t levels;                            /* there: of a texture with levels */
  int16_t level_bias;                        /* 1/256 of a level */
  uint16_t least_level, largest_level;       /* likewise: 0 to 12 levels */
  uint8_t is_affine;                         /* coordinates are linear in the window, not on the surface */
  uint8_t perspective_colors;                /* colours are linear on the surface */
  const hp_fog* fog;                         /* null: none; of triangles; it must stay, too */
  uint32_t fog_color;
  const hp_light* light;        /* likewise */
  uint8_t line_rule, line_last; /* line_last: the last pixel, too; never with HP_DIAMOND */
  uint16_t line_width;          /* pixels */
  hp_fixed point_size;          /* pixels, at least 1: squares */
} hp_state;

/* Vertices: an array of each attribute, or one of structures. Strides are bytes from one vertex to the next. */
typedef struct hp_vertices {
  const hp_fixed* position; /* x y z; with has_w: x y z w */
  const uint32_t* color;    /* HP_RGBA; null: white */
  const hp_fixed* texcoord; /* u v, 1 is the whole texture; null: 0 */
  uint16_t position_stride, color_stride, texcoord_stride;
  uint8_t has_w;
  const hp_fixed* normal; /* x y z of any length, in the space of the light; null: 0 */
  uint16_t normal_stride;
} hp_vertices;

/* What happened since hp_begin(). */
typedef struct hp_counts {
  uint32_t triangles, lines, points; /* that came */
  uint32_t outside, cut, culled;     /* triangles and lines outside, or with a cut; triangles culled here */
  uint32_t sent, vertices;           /* triangles, lines and points sent; vertices sent for triangles */
  uint32_t transformed;              /* vertices */
} hp_counts;

/* ---- Once */

/* Everything to its default: no matrices, the state hp_default_state(). */
void hp_init(hp_context* context);
/* The configuration that the driver was compiled for: the core's register CONFIG_ID must have the same. */
uint64_t hp_config_id(void);

/* ---- A frame. A frame begins with hp_begin() and hp_set_target(); the first thing drawn is hp_clear() of colour and
   depth of the whole target. */

void hp_begin(hp_context* context, const hp_stream* stream);
/* Buffers and viewport (the whole of it); after another one was drawn to, flushes that first. */
void hp_set_target(hp_context* context, const hp_target* target);
/* Depth, colour (HP_RGBA) and stencil inside the scissor. `depth`: u1.31. */
#define HP_CLEAR_DEPTH ((uint32_t)1)
#define HP_CLEAR_COLOR ((uint32_t)2)
void hp_clear(hp_context* context, uint32_t buffers, uint32_t color, uint32_t depth, uint8_t stencil);
void hp_draw(hp_context* context, enum hp_topology topology, const hp_vertices* vertices, const uint16_t* indices,
             uint32_t count); /* indices null: 0, 1, 2... */
/* Everything drawn goes to memory. loses_depth: but depth (faster, where no draw needs it again). */
void hp_flush(hp_context* context, uint8_t loses_depth);
/* When the flushes before it are in memory the register FENCE becomes `tag`, with an interrupt. */
void hp_fence(hp_context* context, uint32_t tag);
/* Shows a flushed colour buffer from the next vertical blank on. */
void hp_present(hp_context* context, uint32_t color, uint32_t color_flags);
/* The stream waits until what was presented is shown. */
void hp_wait_vblank(hp_context* context);
/* The stream stops here until it is started again: the end of a buffer. */
void hp_stop(hp_context* context);
/* Words since hp_begin(), modulo 2^32. Where the core was restarted before hp_begin(), its low 20 bits are what the
   register RING_TAIL gets. */
uint32_t hp_written(const hp_context* context);

/* ---- State */

hp_state hp_default_state(void);
void hp_set_state(hp_context* context, const hp_state* state);
void hp_set_viewport(hp_context* context, const hp_viewport* viewport);
void hp_set_scissor(hp_context* context, int32_t x, int32_t y, int32_t width, int32_t height); /* pixels */
/* Row-major; a vertex is a column. Null: the identity. With both, a vertex is rounded after each. Elements of a row
   must
   be below 65536 in sum. */
void hp_set_matrices(hp_context* context, const hp_fixed view[16], const hp_fixed projection[16]);
/* out = a b, rounded once. `out` may be neither. */
void hp_multiply(hp_fixed out[16], const hp_fixed a[16], const hp_fixed b[16]);

/* ---- Textures */

/* Bytes of a texture in memory. */
size_t hp_texture_bytes(const hp_texture* texture);
/* Writes texels (rows from the top, each of its format, low byte first; level after level) as the unit reads them; `memory`: where the
   unit finds
   the texture. Texels that the unit had read before are dropped at the next draw. */
void hp_upload_texture(hp_context* context, void* memory, const hp_texture* texture, const void* texels);

/* ---- What happened */

uint32_t hp_status(const hp_context* context); /* HP_FULL... since hp_init() */
const hp_counts* hp_count(const hp_context* context);

/* ---- The driver's own memory. Nothing below is for the caller. */

#define HP_LONGEST ((uint32_t)64) /* words of a command with the registers before it, at most */
#ifndef HP_CORNERS
#define HP_CORNERS 16 /* of a clipped polygon: six planes leave nine, and a few more where rounding dents it */
#endif
#ifndef HP_CACHE
#define HP_CACHE 16 /* vertices that stay transformed; a power of two */
#endif

#define HP_PARTS (10 + HALFPLANE_NORMALS)

typedef struct hp_vertex { /* transformed; window coordinates where outcode is 0 */
  uint32_t tag;            /* its index; beyond 65535: no vertex, or a corner */
  hp_fixed clip[4];
  uint32_t color, depth; /* HP_RGBA; code */
  hp_fixed texcoord[2], w;
  int16_t x, y; /* snapped */
  uint8_t outcode;
  uint8_t shift; /* of w, and 2^62 / (w 2^shift), for what is over w */
  uint32_t reciprocal;
#if HALFPLANE_NORMALS != 0
  hp_fixed normal[3];
  int32_t normal_code[3]; /* of length 1, 2^-15 */
#endif
} hp_vertex;

typedef struct hp_corner { /* of a triangle that is cut */
  hp_fixed part[HP_PARTS]; /* x y z w, R G B A, u v; the normal */
} hp_corner;

typedef struct hp_plane {
  int64_t x, y, z, w;
} hp_plane;

struct hp_context {
  hp_stream stream;
  uint32_t *next, *end;   /* where words go next, and the end of the room there: in the stream or in wrapped */
  uint32_t written, read; /* since hp_begin: words before stream.words[at] or wrapped, words that the core has read */
  uint32_t at;            /* a place in the stream: where next was when `written` was counted */
  uint8_t wraps;          /* next is in: */
  uint32_t wrapped[HP_LONGEST]; /* a command over the end of a ring, on its way there */
  uint32_t status;
  hp_counts counts;
  hp_target target;
  hp_viewport viewport;
  int32_t scissor[4], rect[4]; /* left, top, right, bottom: as given; what is drawn */
  hp_fixed view[16], projection[16];
  uint8_t view_kind, projection_kind; /* what of them is not computed: matrix.c */
  uint8_t covers_view, is_quick;      /* nothing inside the view is outside the guard band; and its numbers are short */
  uint8_t is_whole_range;             /* of depth */
  int32_t quick_center[2];            /* the viewport's centre, and half a subpixel */
  hp_fixed center[2], half[2];
  int64_t view_offset[3]; /* of an affine view: the fourth column, and what rounds */
  hp_plane planes[6];
  hp_state state;
  uint8_t culls[2];                                    /* triangles of positive, of negative area */
  uint32_t box[2], state_word;                         /* of the core */
  uint32_t token[8][2];                                /* of its units */
  uint32_t lines[7];                                   /* of the level of detail */
  uint8_t needs_lines, has_lines;                      /* triangles do; the core has those */
  uint8_t is_over_w, is_fogged;                        /* of triangles: they have codes over w */
  uint32_t fog_word, texture_constant, texture_border; /* of the core */
  const hp_fog_line* fog_lines;                        /* likewise; null: unknown */
#if HALFPLANE_NORMALS != 0
  uint8_t is_lit;                   /* of triangles */
  uint64_t light_word[6];           /* of the core */
  const hp_light_line* light_lines; /* likewise; null: unknown */
#endif
  uint32_t known;                 /* a bit for each of these that the core has */
  uint8_t is_drawn, drops_texels; /* since the last flush */
  uint8_t is_set, is_cleared;     /* the target */
  uint32_t slot[3];               /* tags of the core's vertex slots */
  hp_vertex cache[HP_CACHE];
  hp_vertex corner[HP_CORNERS];
  hp_corner polygon[2][HP_CORNERS];
};

#ifdef __cplusplus
}
#endif
#endif
