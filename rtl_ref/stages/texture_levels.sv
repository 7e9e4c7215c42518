// Texture levels: samples with known levels become passes through cache and filter: one, or one on each of two levels.
// A pass gets its texels and the address of its level. Two registers, one pass per clock.
//
//   scale  the coordinates on the level; the blocks along its sides
//   wrap   its texels; the start of the level
// Levels are decreasing powers of two of blocks, so that the start of a level is the bits of one number, `ones_q`,
// above its own size: neither that sum nor a block's place in the level needs an adder. Specification: level_place of
// model/stages/texture_levels.hpp and texels_of of texture_unit.hpp.
module texture_levels #(
    parameter int REFERENCE_BITS = 24,        // bits of a place's texel number, with its sign
    parameter int SIDE_BITS = 12,             // log2 of the longest side, texels
    parameter int TAIL = 1,                   // bits that go along
    parameter int BORDER = 0,                 // 1: texels may be the border's
    parameter int PLACE = REFERENCE_BITS + 8  // derived; not to be set
) (
    input logic clk_i,
    input logic rst_ni,

    // Samples, u lowest
    input  logic               valid_i,
    output logic               ready_o,
    input  logic [2*PLACE-1:0] coordinate_i,  // 2^-8 texels of level 0
    input  logic [3:0]         level_i,       // the only level, or the lower one
    input  logic [7:0]         part_i,        // weight of the upper level; 0: it is not read
    input  logic               is_linear_i,
    input  logic               is_between_i,
    input  logic [TAIL-1:0]    tail_i,

    // Constants of the texture: they stay while samples are under way
    input logic       sets_state_i,
    input logic [7:0] log2_size_i,  // width lowest
    input logic [5:0] wrap_i,
    input logic [1:0] size_i,       // log2 of a line's bytes, less 4

    // Passes
    output logic                   valid_o,
    input  logic                   ready_i,
    output logic [2*SIDE_BITS-1:0] texel_o,
    output logic [2*SIDE_BITS-1:0] next_o,
    output logic [15:0]            part_o,        // weights of the next texels, along x lowest
    output logic [3:0]             border_o,      // the texel, the next one is the border's, likewise
    output logic [23:0]            offset_o,      // address of the level's first line, 16 bytes
    output logic [3:0]             row_o,         // log2 of the lines in a row, likewise
    output logic                   is_odd_o,      // the level is odd
    output logic [7:0]             level_part_o,  // weight of the upper level; 0: there is only one pass
    output logic                   is_between_o,
    output logic                   is_first_o,    // first of two passes
    output logic                   is_second_o,
    output logic [TAIL-1:0]        tail_o,

    output logic is_empty_o
);

  // --------------------------------------------------------------------------------------------------------- the texture
  function automatic [3:0] less(input [3:0] from, input [3:0] by);  // not below 0
    less = from > by ? from - by : 4'd0;
  endfunction

  logic [7:0]  log2_size_q;
  logic [3:0]  wide_q, high_q, first_of_one_q;  // log2 of the blocks along the sides; the first level of one block
  logic [20:0] ones_q;
  texture_sides u_sides (
      .clk_i,
      .sets_state_i,
      .log2_size_i,
      .log2_size_o   (log2_size_q),
      .wide_o        (wide_q),
      .high_o        (high_q),
      .first_of_one_o(first_of_one_q),
      .ones_o        (ones_q)
  );

  // ------------------------------------------------------------------------------------------------------------ two registers
  logic               is_second_q, has_second, scales, wraps, scaled_valid_q, wrapped_valid_q;
  logic [3:0]         level, wide_now_q, high_now_q, row_q;
  logic               is_small_q, is_corner_q, is_odd_q, is_between_q, first_q, second_q;
  logic [7:0]         part_q;
  logic [TAIL-1:0]    tail_q;
  logic [4:0]         blocks;  // log2 of the level's blocks
  logic [20:0]        begins;
  assign has_second = part_i != '0;
  assign level      = level_i + 4'(is_second_q);
  assign wraps      = scaled_valid_q && (!wrapped_valid_q || ready_i);
  assign scales     = valid_i && (!scaled_valid_q || wraps);
  assign ready_o    = scales && (!has_second || is_second_q);
  assign valid_o    = wrapped_valid_q;
  assign is_empty_o = !scaled_valid_q && !wrapped_valid_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      is_second_q     <= 1'b0;
      scaled_valid_q  <= 1'b0;
      wrapped_valid_q <= 1'b0;
    end else begin
      is_second_q     <= scales ? has_second && !is_second_q : is_second_q;
      scaled_valid_q  <= scales || (scaled_valid_q && !wraps);
      wrapped_valid_q <= wraps || (wrapped_valid_q && !ready_i);
    end
  end

  assign blocks = {1'b0, wide_now_q} + {1'b0, high_now_q};
  assign begins = (ones_q & (21'h1ffffe << blocks)) | 21'(is_small_q);
  always_ff @(posedge clk_i) begin
    if (scales) begin
      wide_now_q   <= less(wide_q, level);
      high_now_q   <= less(high_q, level);
      is_small_q   <= level > first_of_one_q;
      is_corner_q  <= level == first_of_one_q + 4'd2;
      is_odd_q     <= level[0];
      is_between_q <= is_between_i;
      first_q      <= has_second && !is_second_q;
      second_q     <= is_second_q;
      part_q       <= part_i;
      tail_q       <= tail_i;
    end
    if (wraps) begin
      offset_o     <= 24'(begins) << size_i;
      row_q        <= wide_now_q;
      is_odd_o     <= is_odd_q;
      is_between_o <= is_between_q;
      is_first_o   <= first_q;
      is_second_o  <= second_q;
      level_part_o <= part_q;
      tail_o       <= tail_q;
    end
  end
  assign row_o = row_q + 4'(size_i);

  genvar n;
  generate
    for (n = 0; n < 2; n++) begin : gen_axis
      texture_on_level #(
          .REFERENCE_BITS(REFERENCE_BITS),
          .SIDE_BITS     (SIDE_BITS),
          .BORDER        (BORDER)
      ) u_axis (
          .clk_i,
          .scales_i    (scales),
          .wraps_i     (wraps),
          .coordinate_i(coordinate_i[PLACE*n+:PLACE]),
          .level_i     (level),
          .is_linear_i (is_linear_i),
          .log2_size_i (log2_size_q[4*n+:4]),
          .wrap_i      (wrap_i[3*n+:3]),
          .is_corner_i (is_corner_q),
          .texel_o     (texel_o[SIDE_BITS*n+:SIDE_BITS]),
          .next_o      (next_o[SIDE_BITS*n+:SIDE_BITS]),
          .part_o      (part_o[8*n+:8]),
          .border_o    (border_o[2*n+:2])
      );
    end
  endgenerate

endmodule
