// Victim bytes: the data of a memory write as they lie in memory: a stamp of an evicted block, or at a flush a cleared
// block or a word of flags. The five sources are masked and ORed, so no choice waits for another. Colours are one per
// sample, or one per pixel: the mean, or the only one. Combinational. Specification: capture() and compress() of
// model/stages/block_cache.cpp.
module victim_bytes #(
    parameter int SAMPLES = raster_pkg::SAMPLES,             // derived; not to be set
    parameter int PIXELS = raster_pkg::PIXELS,               // derived; not to be set
    parameter int CODE = raster_pkg::STORED_DEPTH_BITS,      // derived: bits of a stored depth
    parameter int COLOR = raster_pkg::STORED_COLOR_BITS,     // derived: bits of a stored colour
    parameter int MEMORY_COLORS = raster_pkg::MEMORY_COLORS  // of a stamp: one per sample, or the mean of each pixel
) (
    // A stamp of a victim
    input  logic                     sends_depth_i,
    input  logic                     sends_color_i,
    input  logic                     is_here_i,       // the stamp is in the slot; else it is cleared, or merged
    input  logic [SAMPLES*CODE-1:0]  depth_i,
    input  logic [SAMPLES*COLOR-1:0] color_i,
    input  logic [SAMPLES-1:0]       color_strobe_i,  // samples in the slot
    input  logic                     of_pixels_i,     // the stamp is written with one colour per pixel
    input  logic                     merges_i,        // written whole: missing samples get their pixel's colour
    input  logic [PIXELS*COLOR-1:0]  merged_i,

    // A flush: a word of flags, or a stamp of clear colours
    input logic                             sends_flags_i,
    input logic [raster_pkg::FLAG_WORD-1:0] flags_i,
    input logic                             sends_cleared_i,
    input logic [CODE-1:0]                  clear_depth_i,
    input logic [COLOR-1:0]                 clear_color_i,

    output logic [8*raster_pkg::REQUEST_BYTES-1:0] bytes_o,
    output logic [MEMORY_COLORS-1:0]               color_strobe_o  // colours that are written
);

  localparam int DEPTH_WIDTH = 8 * raster_pkg::DEPTH_SAMPLE_BYTES;
  localparam int COLOR_WIDTH = 8 * raster_pkg::COLOR_SAMPLE_BYTES;
  localparam int DEPTHS = SAMPLES * DEPTH_WIDTH;
  localparam int COLORS = MEMORY_COLORS * COLOR_WIDTH;
  localparam int DATA = 8 * raster_pkg::REQUEST_BYTES;
  localparam int N = raster_pkg::MSAA_SAMPLES;
  localparam bit COMPRESSES = raster_pkg::COMPRESS_UNIT != 0;
  logic [MEMORY_COLORS*COLOR-1:0] stored;  // colours as stored in memory
  logic [MEMORY_COLORS-1:0]       stored_strobe, is_written;
  logic                           sends_here, clears_depth, clears_color;
  logic [DEPTHS-1:0]              depth_bytes, clear_depths;
  logic [COLORS-1:0]              color_bytes, clear_colors;
  assign clears_depth = sends_depth_i && !is_here_i;
  assign color_strobe_o = stored_strobe | (is_written & {MEMORY_COLORS{!is_here_i}});
  genvar s;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_depths
      assign depth_bytes[s*DEPTH_WIDTH+:DEPTH_WIDTH]  = DEPTH_WIDTH'(depth_i[s*CODE+:CODE]);
      assign clear_depths[s*DEPTH_WIDTH+:DEPTH_WIDTH] = DEPTH_WIDTH'(clear_depth_i) & {DEPTH_WIDTH{clears_depth}};
    end
    for (s = 0; s < MEMORY_COLORS; s++) begin : gen_colors
      assign color_bytes[s*COLOR_WIDTH+:COLOR_WIDTH]  = COLOR_WIDTH'(stored[s*COLOR+:COLOR]);
      assign clear_colors[s*COLOR_WIDTH+:COLOR_WIDTH] =
          COLOR_WIDTH'(clear_color_i) & {COLOR_WIDTH{clears_color && is_written[s]}};
    end
    if (COMPRESSES) begin : gen_compress
      // The slot's colours over the colours read from memory; or the first sample of each pixel.
      logic [SAMPLES*COLOR-1:0] all_color;
      logic [SAMPLES-1:0]       here;
      assign here         = color_strobe_i & {SAMPLES{is_here_i}};
      assign sends_here   = is_here_i || merges_i;
      assign clears_color = (sends_color_i && !sends_here) || sends_cleared_i;
      for (s = 0; s < SAMPLES; s++) begin : gen_sample
        assign all_color[s*COLOR+:COLOR] =
            merges_i && !here[s] ? merged_i[s/N*COLOR+:COLOR] : color_i[s*COLOR+:COLOR];
        if (s < PIXELS) begin : gen_pixel
          assign is_written[s]           = 1'b1;
          assign stored[s*COLOR+:COLOR]  = of_pixels_i ? all_color[s*N*COLOR+:COLOR] : all_color[s*COLOR+:COLOR];
          assign stored_strobe[s]        = of_pixels_i ? here[s*N] : here[s] || merges_i;
        end else begin : gen_rest
          assign is_written[s]           = !of_pixels_i && !sends_cleared_i;
          assign stored[s*COLOR+:COLOR]  = all_color[s*COLOR+:COLOR] & {COLOR{!of_pixels_i}};
          assign stored_strobe[s]        = (here[s] || merges_i) && !of_pixels_i;
        end
      end
    end else begin : gen_no_compress
      assign is_written   = '1;
      assign sends_here   = is_here_i;
      assign clears_color = (sends_color_i && !is_here_i) || sends_cleared_i;
      if (raster_pkg::RESOLVE_UNIT != 0) begin : gen_resolve
        resolve u_resolve (
            .color_i(color_i),
            .color_o(stored)
        );
        for (s = 0; s < PIXELS; s++) begin : gen_strobe  // all of a pixel's samples are present, or none
          assign stored_strobe[s] = color_strobe_i[s*N];
        end
      end else begin : gen_samples
        assign stored        = color_i;
        assign stored_strobe = color_strobe_i;
      end
    end
  endgenerate

  logic [DEPTHS-1:0]                depth_part;
  logic [COLORS-1:0]                color_part;
  logic [raster_pkg::FLAG_WORD-1:0] flag_part;
  logic [DATA-1:0]                  clear_part;  // the same for all samples: chosen once
  assign depth_part = depth_bytes & {DEPTHS{sends_depth_i && is_here_i}};
  assign color_part = color_bytes & {COLORS{sends_color_i && sends_here}};
  assign flag_part  = flags_i & {raster_pkg::FLAG_WORD{sends_flags_i}};
  assign clear_part = DATA'(clear_depths) | DATA'(clear_colors);
  assign bytes_o    = DATA'(color_part) | DATA'(depth_part) | DATA'(flag_part) | clear_part;

endmodule
