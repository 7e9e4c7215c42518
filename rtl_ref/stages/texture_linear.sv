// Texture linear: texels of a linear filter. Places wait in a queue, look their lines up in a cache with four banks,
// and become one texel each. With levels, a place says which levels it reads, and some places take two passes.
//
//   places -> [levels, LEVELS] -> texture_cache_linear -> texture_filter -> [texture_blend, LEVELS] -> texels
//
// Specification: take() of model/stages/texture_unit.hpp; the times are those of model/engines/cycle/texture_timing.hpp.
module texture_linear #(
    parameter int LEVELS = 0,                 // 1: levels, and the blend of two
    parameter int REFERENCE_BITS = 24,        // bits of a place's texel number, with its sign
    parameter int SIDE_BITS = 12,             // log2 of the longest side, texels
    parameter int AHEAD = 16,                 // samples that wait for the cache; a power of two
    parameter int LINES = 64,                 // of the cache, 64 bytes each; a power of two, at least 16
    parameter int WAYS = 1,                   // of the cache: 1 or 2
    parameter int PORT_BITS = 64,             // of a beat: 16, 32 or 64
    parameter int IN_FLIGHT = 32,             // samples that wait for memory; a power of two
    parameter int TAIL = 1,                   // bits that go along with a sample
    parameter int BORDER = 0,                 // 1: texels may be the border's
    parameter int PLACE = REFERENCE_BITS + 8  // derived; not to be set
) (
    input logic clk_i,
    input logic rst_ni,
    input logic power_on_ni,

    // Places; at most AHEAD between here and pops_o
    input  logic                   valid_i,
    input  logic [2*SIDE_BITS-1:0] texel_i,
    input  logic [2*SIDE_BITS-1:0] next_i,
    input  logic [15:0]            part_i,
    input  logic [3:0]             border_i,
    input  logic [2*PLACE-1:0]     coordinate_i,
    input  logic [3:0]             level_i,
    input  logic [7:0]             level_part_i,
    input  logic                   is_linear_i,
    input  logic                   is_between_i,
    input  logic [TAIL-1:0]        tail_i,
    output logic                   pops_o,  // a place has left the queue

    // Constants of the texture: they stay while samples are upstream of the tags
    input logic        sets_state_i,
    input logic [7:0]  log2_size_i,
    input logic [5:0]  wrap_i,
    input logic [3:0]  row_i,
    input logic        shares_i,
    input logic [2:0]  format_i,
    input logic [25:0] base_i,
    input logic [1:0]  size_i,
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

    output logic sample_o,  // a sample has been looked up, on all of its levels
    output logic hit_o,     // all of its lines were present
    output logic miss_o,    // a line has been requested
    output logic idle_o
);

  localparam int PART = 16 + 4 * BORDER;  // weights, and which texels are the border's
  localparam int CARRIED = (LEVELS != 0) ? PART + 11 + TAIL : PART + TAIL;  // bits carried through the cache

  logic                   found_valid, found_ready, pass_valid, pass_ready, tags_are_empty, is_odd, code_valid, code_ready;
  logic [2*SIDE_BITS-1:0] pass_texel, pass_next;
  logic [CARRIED-1:0]     pass_carried, code_carried;
  logic [23:0]            offset;
  logic [3:0]             row;
  logic [127:0]           code;
  logic [2:0]             code_format;
  logic                   sum_valid, sum_ready;
  logic [95:0]            sum;
  logic [31:0]            sum_texel;
  logic [CARRIED-PART-1:0] sum_carried;
  logic                   found_has_room;
  assign pops_o = found_valid && found_ready;

  // Events: a sample between two levels counts once, with its second pass.
  logic               looked_up, finds_all;
  logic [CARRIED-1:0] looked_up_carried;
  generate
    if (LEVELS != 0) begin : gen_passes
      logic misses_first_q, ends_first, ends_second;
      assign ends_first  = looked_up && looked_up_carried[TAIL+1];
      assign ends_second = looked_up_carried[TAIL];
      always_ff @(posedge clk_i) if (ends_first) misses_first_q <= !finds_all;
      assign sample_o = looked_up && !ends_first;
      assign hit_o    = finds_all && !ends_first && !(ends_second && misses_first_q);
    end else begin : gen_samples
      assign sample_o = looked_up;
      assign hit_o    = finds_all;
    end
  endgenerate

  generate
    if (LEVELS != 0) begin : gen_levels
      logic [2*PLACE-1:0] found_coordinate;
      logic [3:0]         found_level;
      logic [7:0]         found_part, pass_level_part;
      logic               found_is_linear, found_is_between, pass_is_between, is_first, is_second, levels_are_empty;
      logic [15:0]        pass_part;
      logic [3:0]         pass_border;
      logic [TAIL-1:0]    found_tail, pass_tail;
      fifo #(
          .WIDTH(2 * PLACE + 14 + TAIL),
          .DEPTH(AHEAD)
      ) u_places (
          .clk_i,
          .rst_ni,
          .valid_i,
          .ready_o(found_has_room),
          .data_i ({coordinate_i, level_i, level_part_i, is_linear_i, is_between_i, tail_i}),
          .valid_o(found_valid),
          .ready_i(found_ready),
          .data_o ({found_coordinate, found_level, found_part, found_is_linear, found_is_between, found_tail})
      );
      texture_levels #(
          .REFERENCE_BITS(REFERENCE_BITS),
          .SIDE_BITS     (SIDE_BITS),
          .TAIL          (TAIL),
          .BORDER        (BORDER)
      ) u_texture_levels (
          .clk_i,
          .rst_ni,
          .valid_i     (found_valid),
          .ready_o     (found_ready),
          .coordinate_i(found_coordinate),
          .level_i     (found_level),
          .part_i      (found_part),
          .is_linear_i (found_is_linear),
          .is_between_i(found_is_between),
          .tail_i      (found_tail),
          .sets_state_i,
          .log2_size_i,
          .wrap_i,
          .size_i,
          .valid_o     (pass_valid),
          .ready_i     (pass_ready),
          .texel_o     (pass_texel),
          .next_o      (pass_next),
          .part_o      (pass_part),
          .border_o    (pass_border),
          .offset_o    (offset),
          .row_o       (row),
          .is_odd_o    (is_odd),
          .level_part_o(pass_level_part),
          .is_between_o(pass_is_between),
          .is_first_o  (is_first),
          .is_second_o (is_second),
          .tail_o      (pass_tail),
          .is_empty_o  (levels_are_empty)
      );
      assign pass_carried     = {PART'({pass_border, pass_part}), pass_level_part, pass_is_between, is_first, is_second, pass_tail};
      assign tags_are_empty_o = tags_are_empty && levels_are_empty;

      logic [7:0]      sum_level_part;
      logic            sum_is_between, sum_is_first, sum_is_second;
      logic [TAIL-1:0] sum_tail;
      assign {sum_level_part, sum_is_between, sum_is_first, sum_is_second, sum_tail} = sum_carried;
      texture_blend #(
          .TAIL(TAIL)
      ) u_blend (
          .clk_i,
          .rst_ni,
          .valid_i     (sum_valid),
          .ready_o     (sum_ready),
          .takes_i     (1'b1),
          .sum_i       (sum),
          .is_between_i(sum_is_between),
          .is_first_i  (sum_is_first),
          .is_second_i (sum_is_second),
          .part_i      (sum_level_part),
          .tail_i      (sum_tail),
          .valid_o     (texel_valid_o),
          .ready_i     (texel_ready_i),
          .texel_o,
          .tail_o      (texel_tail_o)
      );
      logic unused;
      assign unused = &{sum_texel, border_i};
    end else begin : gen_level
      logic [PART-1:0] found_part;
      logic [TAIL-1:0] found_tail;
      fifo #(
          .WIDTH(4 * SIDE_BITS + PART + TAIL),
          .DEPTH(AHEAD)
      ) u_places (
          .clk_i,
          .rst_ni,
          .valid_i,
          .ready_o(found_has_room),
          .data_i ({texel_i, next_i, PART'({border_i, part_i}), tail_i}),
          .valid_o(found_valid),
          .ready_i(found_ready),
          .data_o ({pass_texel, pass_next, found_part, found_tail})
      );
      assign pass_valid       = found_valid;
      assign found_ready      = pass_ready;
      assign pass_carried     = {found_part, found_tail};
      assign offset           = '0;
      assign row              = row_i;
      assign is_odd           = 1'b0;
      assign tags_are_empty_o = tags_are_empty;
      assign texel_valid_o    = sum_valid;
      assign sum_ready        = texel_ready_i;
      assign texel_o          = sum_texel;
      assign texel_tail_o     = sum_carried;
      logic unused;
      assign unused = &sum;
    end
  endgenerate

  texture_cache_linear #(
      .LINES    (LINES),
      .WAYS     (WAYS),
      .PORT_BITS(PORT_BITS),
      .IN_FLIGHT(IN_FLIGHT),
      .TAIL     (CARRIED),
      .SIDE_BITS(SIDE_BITS)
  ) u_cache (
      .clk_i,
      .rst_ni,
      .power_on_ni,
      .sample_valid_i  (pass_valid),
      .sample_ready_o  (pass_ready),
      .x_i             ({pass_next[SIDE_BITS-1:0], pass_texel[SIDE_BITS-1:0]}),
      .y_i             ({pass_next[2*SIDE_BITS-1:SIDE_BITS], pass_texel[2*SIDE_BITS-1:SIDE_BITS]}),
      .tail_i          (pass_carried),
      .offset_i        (offset),
      .row_i           (row),
      .is_odd_i        (is_odd),
      .format_i,
      .base_i,
      .size_i,
      .shares_i        (LEVELS != 0 && shares_i),
      .drop_i,
      .tags_are_empty_o(tags_are_empty),
      .code_valid_o    (code_valid),
      .code_ready_i    (code_ready),
      .code_o          (code),
      .code_format_o   (code_format),
      .code_tail_o     (code_carried),
      .request_valid_o,
      .request_ready_i,
      .request_address_o,
      .request_beats_o,
      .answer_valid_i,
      .answer_ready_o,
      .answer_data_i,
      .looked_up_o     (looked_up),
      .hit_o           (finds_all),
      .looked_up_tail_o(looked_up_carried),
      .miss_o,
      .idle_o
  );
  texture_filter #(
      .LEVELS(LEVELS),
      .TAIL  (CARRIED - PART),
      .BORDER(BORDER)
  ) u_filter (
      .clk_i,
      .rst_ni,
      .valid_i (code_valid),
      .ready_o (code_ready),
      .code_i  (code),
      .format_i(code_format),
      .part_i  (code_carried[CARRIED-1-:PART]),
      .border_i(border_color_i),
      .tail_i  (code_carried[CARRIED-PART-1:0]),
      .valid_o (sum_valid),
      .ready_i (sum_ready),
      .sum_o   (sum),
      .texel_o (sum_texel),
      .tail_o  (sum_carried)
  );

endmodule
