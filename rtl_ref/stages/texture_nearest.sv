// Texture nearest: texels of a nearest filter. The address of each sample's line waits in a queue and is looked up; the
// code in the answer becomes a colour.
//
//   texels -> [address] -> texture_cache -> texture_decode -> colours
//
// Specification: take() of model/stages/texture_unit.hpp; the times are those of model/engines/cycle/texture_timing.hpp.
module texture_nearest #(
    parameter int SIDE_BITS = 12,  // log2 of the longest side, texels
    parameter int AHEAD = 16,      // samples that wait for the cache; a power of two
    parameter int LINES = 64,      // of the cache, 64 bytes each; a power of two, at least 2
    parameter int PORT_BITS = 64,  // of a beat: 16 to 128
    parameter int IN_FLIGHT = 32,  // samples that wait for memory; a power of two
    parameter int TAIL = 1,        // bits that go along with a sample
    parameter int BORDER = 0       // 1: texels may be the border's
) (
    input logic clk_i,
    input logic rst_ni,
    input logic power_on_ni,

    // Texels, x lowest; at most AHEAD between here and pops_o
    input  logic                   valid_i,
    input  logic [2*SIDE_BITS-1:0] texel_i,
    input  logic                   border_i,  // with BORDER: it is the border's
    input  logic [TAIL-1:0]        tail_i,
    output logic                   pops_o,  // a texel has left the queue

    // Constants of the texture: they stay while samples are upstream of the tags
    input logic [2:0]  format_i,
    input logic [25:0] base_i,
    input logic [1:0]  size_i,
    input logic [3:0]  row_i,
    input logic [31:0] border_color_i,  // it stays while samples are under way

    input  logic drop_i,
    output logic tags_are_empty_o,

    output logic            texel_valid_o,
    input  logic            texel_ready_i,
    output logic [31:0]     texel_o,
    output logic [TAIL-1:0] texel_tail_o,

    // Memory
    output logic                 request_valid_o,
    input  logic                 request_ready_i,
    output logic [31:0]          request_address_o,
    output logic [5:0]           request_beats_o,
    input  logic                 answer_valid_i,
    output logic                 answer_ready_o,
    input  logic [PORT_BITS-1:0] answer_data_i,

    output logic sample_o,  // a sample has been looked up
    output logic hit_o,
    output logic miss_o,
    output logic idle_o
);

  localparam int LINE = $clog2(LINES);
  localparam int LINE_X = (LINE + 1) / 2;
  localparam int LINE_Y = LINE / 2;
  localparam int BLOCK = SIDE_BITS - 2;

  // Blocks of 4x4 texels in rows; their lowest bits select the line.
  logic [BLOCK-1:0] block_x, block_y;
  logic [21:0]      place;
  logic [27:0]      address, found_address;
  logic [LINE-1:0]  line, found_line;
  logic [3:0]       texel, found_texel;
  localparam int KEPT = TAIL + BORDER;
  logic [KEPT-1:0]  kept, found_tail, code_tail;
  logic [31:0]      decoded;
  logic [31:0]      code;
  logic [2:0]       code_format;
  logic             found_valid, found_ready;
  logic             found_has_room;
  assign block_x          = texel_i[SIDE_BITS-1:2];
  assign block_y          = texel_i[2*SIDE_BITS-1:SIDE_BITS+2];
  assign texel            = {texel_i[SIDE_BITS+1:SIDE_BITS], texel_i[1:0]};
  assign place            = (22'(block_y) << row_i) | (22'(block_x) << size_i);
  assign address          = {base_i, 2'd0} + 28'(place);
  assign line[LINE_X-1:0] = block_x[LINE_X-1:0];
  assign pops_o           = found_valid && found_ready;
  generate
    if (LINE_Y > 0) begin : gen_line_y
      assign line[LINE-1:LINE_X] = block_y[LINE_Y-1:0];
    end
  endgenerate

  fifo #(
      .WIDTH(28 + LINE + 4 + KEPT),
      .DEPTH(AHEAD)
  ) u_addresses (
      .clk_i,
      .rst_ni,
      .valid_i,
      .ready_o(found_has_room),
      .data_i ({address, line, texel, kept}),
      .valid_o(found_valid),
      .ready_i(found_ready),
      .data_o ({found_address, found_line, found_texel, found_tail})
  );
  texture_cache #(
      .LINES    (LINES),
      .PORT_BITS(PORT_BITS),
      .IN_FLIGHT(IN_FLIGHT),
      .TAIL     (KEPT)
  ) u_cache (
      .clk_i,
      .rst_ni,
      .power_on_ni,
      .sample_valid_i  (found_valid),
      .sample_ready_o  (found_ready),
      .address_i       (found_address),
      .line_i          (found_line),
      .texel_i         (found_texel),
      .format_i,
      .tail_i          (found_tail),
      .drop_i,
      .tags_are_empty_o,
      .code_valid_o    (texel_valid_o),
      .code_ready_i    (texel_ready_i),
      .code_o          (code),
      .code_format_o   (code_format),
      .code_tail_o     (code_tail),
      .request_valid_o,
      .request_ready_i,
      .request_address_o,
      .request_beats_o,
      .answer_valid_i,
      .answer_ready_o,
      .answer_data_i,
      .hit_o,
      .miss_o,
      .idle_o
  );
  texture_decode u_decode (
      .code_i  (code),
      .format_i(code_format),
      .texel_o (decoded)
  );
  assign kept         = KEPT'({border_i, tail_i});
  assign texel_tail_o = code_tail[TAIL-1:0];
  generate
    if (BORDER != 0) begin : gen_border
      assign texel_o = code_tail[KEPT-1] ? border_color_i : decoded;
    end else begin : gen_image
      assign texel_o = decoded;
      logic unused;
      assign unused = &{border_i, border_color_i};
    end
  endgenerate

  assign sample_o = hit_o || miss_o;

endmodule
