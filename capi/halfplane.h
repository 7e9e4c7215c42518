/* The C interface of Halfplane: configurations, scenes from memory, rendering, and each stage of the pipeline by itself, for
 * test benches (DPI-C, ctypes, cffi) and for drivers in other languages. docs/your-rtl.md shows it at work.
 *
 * Nothing here throws or aborts. A function that fails returns NULL or a negative number, and halfplane_last_error() says why
 * in one line. NULL in place of a handle is such an error; every ..._free takes NULL. A handle serves one thread at a time.
 *
 * Stable: what is declared here keeps its meaning while HALFPLANE_ABI is the same; additions leave it. */
#ifndef HALFPLANE_H
#define HALFPLANE_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define HALFPLANE_API __attribute__((visibility("default")))
#else
#define HALFPLANE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define HALFPLANE_ABI 1

/* HALFPLANE_ABI of the library that is loaded. */
HALFPLANE_API int halfplane_abi(void);

/* What the last call of this thread that failed has to say: one line, "" before any. Valid until the next failure. */
HALFPLANE_API const char* halfplane_last_error(void);

/* --- configurations ------------------------------------------------------------------------------------------------------ */

typedef struct halfplane_config halfplane_config;

/* A preset: "tiny", "small", "embedded" or "full". */
HALFPLANE_API halfplane_config* halfplane_config_new(const char* preset);
/* As `--set key=value`. Returns 0. Whether all values go together is looked at where the configuration is used. */
HALFPLANE_API int halfplane_config_set(halfplane_config* config, const char* key, const char* value);
/* Writes the value of a key and a 0, cut to `bytes`. Returns the length of the whole value. */
HALFPLANE_API int halfplane_config_get(const halfplane_config* config, const char* key, char* value, size_t bytes);
/* raster_pkg::CONFIG_ID of the hardware's settings: equal for equal hardware. 0: they do not go together. */
HALFPLANE_API uint64_t halfplane_config_id(const halfplane_config* config);
HALFPLANE_API void halfplane_config_free(halfplane_config* config);

/* --- scenes and images --------------------------------------------------------------------------------------------------- */

typedef struct halfplane_scene halfplane_scene;
typedef struct halfplane_frame halfplane_frame;

/* A capture (docs/capture.md) that lies in memory: exact to the bit, any state. The files of its
 * textures are looked for in the current folder; inline ones need none. */
HALFPLANE_API halfplane_scene* halfplane_scene_read(const char* text, size_t bytes);
/* A capture in a file; files of its textures are looked for next to it. */
HALFPLANE_API halfplane_scene* halfplane_scene_open(const char* path);
/* An empty scene of width * height pixels, to be filled by those below. */
HALFPLANE_API halfplane_scene* halfplane_scene_new(int width, int height);
/* Lines of a capture that hold from here on: clears, and what a draw depends on (space, state, texture, texels, planes). Each
 * call begins with a capture's defaults: what an earlier one set is set no more, but its textures keep their names.
 * Returns 0. */
HALFPLANE_API int halfplane_scene_say(halfplane_scene* scene, const char* lines, size_t bytes);
/* A texture of that name for `state texture NAME`, from width * height texels of R, G, B, A, a byte each, the row of v = 0 first.
 * `format`: as which its texels are stored, "rgba8888", "rgb565"...; `mips`: "none", "box", "box_linear" (docs/capture.md),
 * or "levels": the texels of the smaller levels follow, each of half the sides, down to 1x1.
 * A texture that has the name already is an error. Returns 0. */
HALFPLANE_API int halfplane_scene_texture(halfplane_scene* scene, const char* name, int width, int height,
                                          const uint8_t* rgba, const char* format, const char* mips);
/* `count` vertices from an array: x y z w, and where `numbers` is 8 r g b a (0 to 255), where it is 10 u v too. Returns the
 * index of the first. */
HALFPLANE_API int64_t halfplane_scene_vertices(halfplane_scene* scene, const double* values, int numbers, size_t count);

/* Where a vertex in memory has an attribute. A component is taken as the number that it is: 255 of a byte is 255. */
enum { HALFPLANE_NONE = 0, HALFPLANE_F64 = 1, HALFPLANE_F32 = 2, HALFPLANE_U8 = 3, HALFPLANE_I16 = 4 };
typedef struct halfplane_attribute {
  int type;       /* one of the above; HALFPLANE_NONE: the vertices do not have it */
  int components; /* one after the other, without gaps */
  size_t offset;  /* bytes from the vertex's first byte; no alignment is asked for */
} halfplane_attribute;
/* Vertices as they lie in memory, for example x y z w as floats with 8-bit colours behind them:
 *   {20, {HALFPLANE_F32, 4, 0}, {HALFPLANE_U8, 4, 16}, {HALFPLANE_NONE, 0, 0}, {HALFPLANE_NONE, 0, 0}} */
typedef struct halfplane_layout {
  size_t stride;                /* bytes from one vertex to the next */
  halfplane_attribute position; /* 2 to 4: x y, then z (else 0), then w (else 1) */
  halfplane_attribute color;    /* 3 or 4: r g b, then a (else 255), 0 to 255; without it white */
  halfplane_attribute texcoord; /* 2: u v; without it 0 0 */
  halfplane_attribute normal;   /* 3, of any length; without it none. Of `state shade phong` */
} halfplane_layout;
/* As halfplane_scene_vertices, of `count` vertices that lie in `bytes` bytes at `data`. */
HALFPLANE_API int64_t halfplane_scene_records(halfplane_scene* scene, const halfplane_layout* layout, const void* data,
                                              size_t bytes, size_t count);
/* A draw: "triangles", "triangle_strip", "triangle_fan", "lines", "line_strip", "line_loop" or "points" of indices that count
 * from 0 over the whole scene; 0xffffffff starts a strip, fan or loop anew. Returns 0. */
HALFPLANE_API int halfplane_scene_draw(halfplane_scene* scene, const char* topology, const uint32_t* indices,
                                       size_t count);
HALFPLANE_API void halfplane_scene_free(halfplane_scene* scene);

/* Draws a scene. Engines: "functional", "scalar" and "cycle" give the same bits; "golden" the exact image, rounded at the end.
 * "cycle" runs with an ideal memory, from reset to the answer to the last write. */
HALFPLANE_API halfplane_frame* halfplane_render(const halfplane_scene* scene, const halfplane_config* config,
                                                const char* engine);
/* The same with that many threads, 1 to 1024, where the engine has them ("functional"); no bit depends on it. */
HALFPLANE_API halfplane_frame* halfplane_render_threads(const halfplane_scene* scene, const halfplane_config* config,
                                                        const char* engine, int threads);
HALFPLANE_API int halfplane_frame_width(const halfplane_frame* frame); /* pixels */
HALFPLANE_API int halfplane_frame_height(const halfplane_frame* frame);
/* Copies a plane, row by row from the top, width * height values, and returns their number. Planes: "depth" (codes), "color"
 * (stored codes: rgb565, or R in the lowest byte), "stencil". `count`: the room in `values`, which must hold them all. */
HALFPLANE_API int64_t halfplane_frame_plane(const halfplane_frame* frame, const char* plane, uint32_t* values,
                                            size_t count);
/* Of "golden": "depth" in LSB of the interpolated depth, a value a pixel; "color" 0 to 255, R, G, B, A of each pixel. */
HALFPLANE_API int64_t halfplane_frame_reals(const halfplane_frame* frame, const char* plane, double* values,
                                            size_t count);
/* "primitives_in", "drawn", "covered", "depth_passed", "alpha_killed", "written"; of "cycle" also "cycles". */
HALFPLANE_API int64_t halfplane_frame_counter(const halfplane_frame* frame, const char* name);
HALFPLANE_API void halfplane_frame_free(halfplane_frame* frame);

/* --- targets ------------------------------------------------------------------------------------------------------------- */

/* A frame that stays: cleared and drawn on call by call, by the functional engine, as a driver does. The picture is that of a
 * scene with the same commands. A call that fails leaves frame, textures and state as they were. */
typedef struct halfplane_target halfplane_target;

/* Black and as far as can be. `planes`: the near and the far distance of a capture's `planes` line; NULL: none. */
HALFPLANE_API halfplane_target* halfplane_target_new(const halfplane_config* config, int width, int height,
                                                     const double* planes);
/* Threads of the draws that follow, 1 to 1024, 1 at first; no bit depends on it. Returns 0. */
HALFPLANE_API int halfplane_target_set_threads(halfplane_target* target, int threads);
/* As halfplane_scene_say; clears are done at once. */
HALFPLANE_API int halfplane_target_say(halfplane_target* target, const char* lines, size_t bytes);
/* As halfplane_scene_texture, but a texture that has the name already is replaced. */
HALFPLANE_API int halfplane_target_texture(halfplane_target* target, const char* name, int width, int height,
                                           const uint8_t* rgba, const char* format, const char* mips);
/* Clears inside the scissor of the state that was said. `color`: r g b a, 0 to 255, or NULL; `depth`: a window z, or NULL;
 * `stencil`: 0 to 255, or -1. What is NULL or -1 stays. Returns 0. */
HALFPLANE_API int halfplane_target_clear(halfplane_target* target, const double* color, const double* depth,
                                         int stencil);
/* Draws `vertices` vertices that lie in `bytes` bytes at `data`, in the state that was said. Topologies and indices as of
 * halfplane_scene_draw, from 0 over these vertices; NULL: in their order. Returns 0. */
HALFPLANE_API int halfplane_target_draw(halfplane_target* target, const char* topology, const halfplane_layout* layout,
                                        const void* data, size_t bytes, size_t vertices, const uint32_t* indices,
                                        size_t count);
/* Every command of a scene of this size and these planes. Returns 0. One that fails midway has drawn what comes before. */
HALFPLANE_API int halfplane_target_draw_scene(halfplane_target* target, const halfplane_scene* scene);
/* As halfplane_frame_plane and halfplane_frame_counter: the frame so far, and what the last call that drew counted. */
HALFPLANE_API int64_t halfplane_target_plane(const halfplane_target* target, const char* plane, uint32_t* values,
                                             size_t count);
HALFPLANE_API int64_t halfplane_target_counter(const halfplane_target* target, const char* name);
/* Copies the frame to memory of the caller's, or takes it over from there: `color` with 2 bytes a pixel (rgb565) or 4, `depth`
 * with 4; pitches are bytes from one row to the next. NULL leaves a buffer out. Returns 0. */
HALFPLANE_API int halfplane_target_copy_to(const halfplane_target* target, void* color, size_t color_pitch,
                                           uint32_t* depth, size_t depth_pitch);
HALFPLANE_API int halfplane_target_copy_from(halfplane_target* target, const void* color, size_t color_pitch,
                                             const uint32_t* depth, size_t depth_pitch);
HALFPLANE_API void halfplane_target_free(halfplane_target* target);

/* --- the whole pipeline -------------------------------------------------------------------------------------------------- */

/* raster_top of a configuration from reset, with its memory: what a scoreboard holds a design against. In goes what is on the
 * design's own input ports, packed structs of raster_pkg.sv as in the stages below, so that a monitor hands on what it sees.
 * Out comes, in the order of the hardware, what each primitive does, without time. docs/your-rtl.md has scoreboards. */
typedef struct halfplane_pipeline halfplane_pipeline;

enum { HALFPLANE_WRITES = 1, HALFPLANE_RETIRED = 2, HALFPLANE_BEATS = 4 };
/* `config_id`: raster_pkg::CONFIG_ID of the design, which must be that of the configuration. `outputs`: a sum of the three
 * above. An output that is named here is kept until it is taken; the others are not kept. */
HALFPLANE_API halfplane_pipeline* halfplane_pipeline_new(const halfplane_config* config, uint64_t config_id,
                                                         int outputs);
/* The next primitive_packet_t. Returns 0. One that breaks a rule of the stream (docs/interface.md) is an error, and nothing
 * happens. */
HALFPLANE_API int halfplane_pipeline_put_primitive(halfplane_pipeline* pipeline, const uint32_t* words);
/* The next line_setup_t, before or after the primitive of kind line that holds its place, which waits for it. Returns 0. */
HALFPLANE_API int halfplane_pipeline_put_line(halfplane_pipeline* pipeline, const uint32_t* words);

/* What happened: HALFPLANE_WRITES, a sample's words change; HALFPLANE_RETIRED, a primitive is through, whether it drew
 * anything or not. In SystemVerilog a packed struct, the last member first. */
enum { HALFPLANE_DEPTH = 1, HALFPLANE_COLOR = 2 };
typedef struct halfplane_event {
  uint32_t kind;
  uint32_t primitive;             /* counts all that were put, of every kind, from 0 */
  uint32_t x, y, sample;          /* pixels from the top left; the sample of the pixel, 0 without msaa */
  uint32_t parts;                 /* what is written: HALFPLANE_DEPTH (with the stencil), HALFPLANE_COLOR, or both */
  uint32_t depth, stencil, color; /* codes as halfplane_frame_plane gives them; 0 of a part that is not written */
} halfplane_event;
/* The next event. Returns 1; or 0 when there is none before more is put in. Clears and flushes retire, and write no samples. */
HALFPLANE_API int halfplane_pipeline_get_event(halfplane_pipeline* pipeline, halfplane_event* event);
/* The next memory_beat_t on the port to memory, reads and writes, likewise. */
HALFPLANE_API int halfplane_pipeline_get_beat(halfplane_pipeline* pipeline, uint32_t* words);

/* Where the buffers lie, the members of memory_layout_t: bases of depth, colour, flags of depth and flags of colour, bytes
 * from one row of tiles to the next. May be set before the first primitive. Returns 0. */
HALFPLANE_API int halfplane_pipeline_layout(const halfplane_pipeline* pipeline, uint32_t* bytes);
HALFPLANE_API int halfplane_pipeline_set_layout(halfplane_pipeline* pipeline, const uint32_t* bytes);
/* The bytes of memory as the hardware leaves them, frame and flags. Before the first primitive: what a test bench's memory may
 * begin with, so that bytes that nothing wrote are equal, too. */
HALFPLANE_API int64_t halfplane_pipeline_memory_size(const halfplane_pipeline* pipeline);
HALFPLANE_API int halfplane_pipeline_memory(const halfplane_pipeline* pipeline, uint32_t address, void* bytes,
                                            size_t count);
/* The picture in memory, as halfplane_frame_plane: of the target that the last fast clear gave. After a flush; what was drawn
 * since the last one is an error. */
HALFPLANE_API int64_t halfplane_pipeline_plane(const halfplane_pipeline* pipeline, const char* plane, uint32_t* values,
                                               size_t count);
/* From now on the texture memory holds the textures of a scene. Returns 0. */
HALFPLANE_API int halfplane_pipeline_textures(halfplane_pipeline* pipeline, const halfplane_scene* scene);
/* Bytes of the texture memory, for a test bench that answers its design; 0 beyond the textures. Returns 0. */
HALFPLANE_API int halfplane_pipeline_texels(const halfplane_pipeline* pipeline, uint32_t address, void* bytes,
                                            size_t count);
HALFPLANE_API void halfplane_pipeline_free(halfplane_pipeline* pipeline);

/* The host of a scene: the packets that raster_top gets for it, from a fast clear to the flush. */
typedef struct halfplane_host halfplane_host;
HALFPLANE_API halfplane_host* halfplane_host_new(const halfplane_scene* scene, const halfplane_config* config);
/* The next primitive_packet_t, and the line_setup_t of one of kind line. Returns 1, 2 with a line, 0 after the flush. */
HALFPLANE_API int halfplane_host_next(halfplane_host* host, uint32_t* primitive, uint32_t* line);
HALFPLANE_API void halfplane_host_free(halfplane_host* host);

/* Bits of the packets of an arrow of docs/pipeline.md: "primitive", "line", "beat". */
HALFPLANE_API int halfplane_packet_bits(const halfplane_config* config, const char* arrow);

/* --- a stage by itself --------------------------------------------------------------------------------------------------- */

/* The specification of one stage, from reset. It has ports, numbered as docs/your-rtl.md lists them; a packet is the packed
 * struct of raster_pkg.sv, 32 bits a word, the lowest first: what DPI-C passes for a packed struct. */
typedef struct halfplane_stage halfplane_stage;

HALFPLANE_API halfplane_stage* halfplane_stage_new(const halfplane_config* config, const char* name);
/* The number of ports that go in (is_out 0) or come out (is_out 1). */
HALFPLANE_API int halfplane_stage_ports(const halfplane_stage* stage, int is_out);
/* A port's name, and its packets' size in bits. */
HALFPLANE_API const char* halfplane_stage_port_name(const halfplane_stage* stage, int is_out, int port);
HALFPLANE_API int halfplane_stage_port_bits(const halfplane_stage* stage, int is_out, int port);
/* The fields of its packets, highest bits first, so the last element of an array before its first: "edge_value[2]",
 * "edge_value[1]", "edge_value[0]"; bits, negative for a signed field. */
HALFPLANE_API int halfplane_stage_fields(const halfplane_stage* stage, int is_out, int port);
HALFPLANE_API const char* halfplane_stage_field_name(const halfplane_stage* stage, int is_out, int port, int field);
HALFPLANE_API int halfplane_stage_field_bits(const halfplane_stage* stage, int is_out, int port, int field);
/* The next packet of a port that goes in. Bits above the packet's are not looked at. Returns 0. A place outside the
 * largest target is an error, and nothing happens. A packet that the stage cannot take is one too, and the stage takes nothing
 * more. What else no hardware sends is not looked for: something comes of it. In a child of fork() a stage of its parent takes
 * nothing. */
HALFPLANE_API int halfplane_stage_put(halfplane_stage* stage, int port, const uint32_t* words);
/* The next packet of a port that comes out. Returns 1; or 0 when there is none before more is put in. */
HALFPLANE_API int halfplane_stage_get(halfplane_stage* stage, int port, uint32_t* words);
HALFPLANE_API void halfplane_stage_free(halfplane_stage* stage);

#ifdef __cplusplus
}
#endif
#endif
