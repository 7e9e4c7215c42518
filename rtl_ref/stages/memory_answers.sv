// Memory answers: the answers of memory to reads of blocks, buffered for their consumers: depths for depth_cache, and
// with blending colours for color_write. A place for each read in flight, so that no answer waits for a fragment.
//
// Answers come in the order of the reads, so a queue of the reads' kinds says where they go. Answers to reads of a
// merge (pixel_colors) go to write_back. Specification: the answers of model/stages/block_cache.hpp.
module memory_answers #(
    parameter int SAMPLES = raster_pkg::SAMPLES,  // derived; not to be set
    parameter int CODE = raster_pkg::STORED_DEPTH_BITS,
    parameter int COLOR = raster_pkg::STORED_COLOR_BITS
) (
    input logic clk_i,
    input logic rst_ni,

    // From write_back: a read is requested; it reads colours; with one colour per pixel; answers belong to a merge
    input logic read_goes_i,
    input logic read_color_i,
    input logic read_of_pixels_i,
    input logic merges_i,

    // From memory_port
    input  logic                         response_valid_i,
    output logic                         response_ready_o,
    input  raster_pkg::memory_response_t response_i,

    // To depth_cache and to color_write: data follow in the cycle after the take
    output logic                     depth_valid_o,
    input  logic                     depth_ready_i,
    output logic [SAMPLES*CODE-1:0]  depth_o,
    output logic                     color_valid_o,
    input  logic                     color_ready_i,
    output logic [SAMPLES*COLOR-1:0] color_o
);

  localparam int LANE = raster_pkg::MEMORY_LANE_BITS;
  localparam int QUEUE = raster_pkg::CACHE_QUEUE;
  localparam int PLACES = raster_pkg::SHADED_STAMPS;
  localparam bit COMPRESSES = raster_pkg::COMPRESS_UNIT != 0;

  logic                    answers_depth, answers_ready;
  logic [SAMPLES*CODE-1:0] response_depth;
  genvar s;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_depth_code
      assign response_depth[s*CODE+:CODE] = response_i.data[s*LANE+:CODE];
    end
  endgenerate
  sram_fifo #(
      .WIDTH(SAMPLES * CODE),
      .DEPTH(QUEUE),
      // Separate constants need the block RAMs of an ECP5-25F, unless queues are to lie there.
      .BLOCK(raster_pkg::STORE_CONSTANTS_SEPARATELY == 0 || raster_pkg::QUEUE_BLOCK_RAM != 0),
      .AHEAD(1)  // depths go on to late_test and into a RAM in the same cycle
  ) u_answers (
      .clk_i,
      .rst_ni,
      .valid_i(answers_depth),
      .ready_o(answers_ready),
      .data_i (response_depth),
      .valid_o(depth_valid_o),
      .ready_i(depth_ready_i),
      .data_o (depth_o)
  );
  generate
    if (raster_pkg::BLEND_LANES != 0) begin : gen_blends
      localparam int READS = 1 << $clog2(2 * QUEUE + PLACES);  // reads that may not have been answered
      logic                     is_color, color_ready, answers_pixels;  // the next answer
      logic [SAMPLES*COLOR-1:0] response_color;
      logic                     planes_ready, planes_valid;
      // Buffer of the next answer, in the order of the reads.
      localparam int PLANE = COMPRESSES ? 2 : 1;
      logic [PLANE-1:0] asked_plane, answered_plane;
      assign is_color = answered_plane[0];
      if (COMPRESSES) begin : gen_pixels
        assign asked_plane    = {read_of_pixels_i, read_color_i};
        assign answers_pixels = answered_plane[1];
      end else begin : gen_samples
        assign asked_plane    = read_color_i;
        assign answers_pixels = 1'b0;
      end
      fifo #(
          .WIDTH(PLANE),
          .DEPTH(READS)
      ) u_planes (
          .clk_i,
          .rst_ni,
          .valid_i(read_goes_i),
          .ready_o(planes_ready),
          .data_i (asked_plane),
          .valid_o(planes_valid),
          .ready_i(response_valid_i && response_ready_o && !merges_i),
          .data_o (answered_plane)
      );
      sram_fifo #(
          .WIDTH(SAMPLES * COLOR),
          .DEPTH(1 << $clog2(QUEUE + PLACES))
      ) u_color_answers (
          .clk_i,
          .rst_ni,
          .valid_i(response_valid_i && is_color && !merges_i),
          .ready_o(color_ready),
          .data_i (response_color),
          .valid_o(color_valid_o),
          .ready_i(color_ready_i),
          .data_o (color_o)
      );
      for (s = 0; s < SAMPLES; s++) begin : gen_response
        assign response_color[s*COLOR+:COLOR] =
            response_i.data[LANE*(s/raster_pkg::MSAA_SAMPLES)+:COLOR] & {COLOR{answers_pixels}} |
            response_i.data[s*LANE+:COLOR] & {COLOR{!answers_pixels}};
      end
      assign answers_depth    = response_valid_i && !is_color && !merges_i;
      assign response_ready_o = merges_i || (is_color ? color_ready : answers_ready);
    end else begin : gen_replaces
      assign answers_depth    = response_valid_i && !merges_i;
      assign response_ready_o = merges_i || answers_ready;
      assign color_valid_o    = 1'b0;
      assign color_o          = '0;
    end
  endgenerate

endmodule
