// Texture rounds: groups of four samples with known levels become rounds: one of their only or lower levels, and if any
// sample lies between two levels, a second of the upper ones. Each round has the texels of its samples and the agreeing
// pairs: samples that agree are on one level, and go together. Three registers, one round per clock.
//
//   scale  each sample's coordinates on its level; the blocks along that level's sides
//   wrap   its texels
//   agree  which pairs go together
// The address of a level is computed for the pass that leaves, not for four samples. Specification: take_group() of
// model/stages/texture_unit.hpp, level_place of texture_levels.hpp.
module texture_rounds #(
    parameter int REFERENCE_BITS = 24,        // bits of a place's texel number, with its sign
    parameter int SIDE_BITS = 12,             // log2 of the longest side, texels
    parameter int TAIL = 1,                   // bits that go along with a group
    parameter int BORDER = 0,                 // 1: texels may be the border's
    parameter int PLACE = REFERENCE_BITS + 8  // derived; not to be set
) (
    input logic clk_i,
    input logic rst_ni,

    // Groups, some samples of them live; u lowest
    input  logic               valid_i,
    output logic               ready_o,
    input  logic [3:0]         live_i,
    input  logic [8*PLACE-1:0] coordinate_i,  // 2^-8 texels of level 0
    input  logic [15:0]        level_i,       // the only level, or the lower one
    input  logic [31:0]        part_i,        // weight of the upper level; 0: it is not read
    input  logic [3:0]         is_linear_i,
    input  logic [3:0]         is_between_i,
    input  logic [TAIL-1:0]    tail_i,

    // Constants of the texture: they stay while groups are under way
    input logic       sets_state_i,
    input logic [7:0] log2_size_i,  // width lowest
    input logic [5:0] wrap_i,
    input logic [1:0] size_i,       // log2 of a line's bytes, less 4

    // Rounds
    output logic                      valid_o,
    input  logic                      ready_i,
    output logic [3:0]                live_o,
    output logic [3:0]                waits_o,       // live samples whose upper level comes later
    output logic                      ends_o,        // the last round of its group
    output logic                      is_second_o,   // second of two rounds
    output logic [16*SIDE_BITS-1:0]   texel_o,       // for each sample x, y of its texel, then of the next texel
    output logic [63:0]               part_o,        // weight of the next texel, along x lowest
    output logic [15:0]               border_o,      // with BORDER: the texel, the next one is the border's, likewise
    output logic [5:0]                agree_o,       // 0 and 1, 0 and 2, 1 and 2, 0 and 3, 1 and 3, 2 and 3
    output logic [31:0]               level_part_o,
    output logic [3:0]                is_between_o,
    output logic [TAIL-1:0]           tail_o,

    // Address of a level, for the pass of a round with this first sample
    input  logic [1:0]  first_i,
    output logic [23:0] offset_o,  // address of the level's first line, 16 bytes
    output logic [3:0]  row_o,     // log2 of the lines in a row, likewise
    output logic        is_odd_o,  // the level is odd

    output logic is_empty_o
);

  localparam int LEVEL = 11;  // constants of a level: odd, small, log2 of its blocks and of the blocks in a row

  logic [7:0]  log2_size;
  logic [3:0]  wide, high, first_of_one;
  logic [20:0] ones;
  texture_sides u_sides (
      .clk_i,
      .sets_state_i,
      .log2_size_i,
      .log2_size_o   (log2_size),
      .wide_o        (wide),
      .high_o        (high),
      .first_of_one_o(first_of_one),
      .ones_o        (ones)
  );
  function automatic [3:0] less(input [3:0] from, input [3:0] by);  // not below 0
    less = from > by ? from - by : 4'd0;
  endfunction

  // ------------------------------------------------------------------------------------------------------------ the rounds
  logic       is_second_q, turns, scales, wraps, agrees, scaled_valid_q, wrapped_valid_q, agreed_valid_q;
  logic [3:0] has_upper;
  assign turns      = (live_i & has_upper) != '0 && !is_second_q;
  assign agrees     = wrapped_valid_q && (!agreed_valid_q || ready_i);
  assign wraps      = scaled_valid_q && (!wrapped_valid_q || agrees);
  assign scales     = valid_i && (!scaled_valid_q || wraps);
  assign ready_o    = scales && !turns;
  assign valid_o    = agreed_valid_q;
  assign is_empty_o = !scaled_valid_q && !wrapped_valid_q && !agreed_valid_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      is_second_q     <= 1'b0;
      scaled_valid_q  <= 1'b0;
      wrapped_valid_q <= 1'b0;
      agreed_valid_q  <= 1'b0;
    end else begin
      is_second_q     <= scales ? turns : is_second_q;
      scaled_valid_q  <= scales || (scaled_valid_q && !wraps);
      wrapped_valid_q <= wraps || (wrapped_valid_q && !agrees);
      agreed_valid_q  <= agrees || (agreed_valid_q && !ready_i);
    end
  end

  // Payload: live, waits, ends, second, weights of levels, between, tail.
  localparam int ALONG = 4 + 4 + 1 + 1 + 32 + 4 + TAIL;
  logic [ALONG-1:0] along, scaled_along_q, wrapped_along_q, agreed_along_q;
  assign along = {is_second_q ? live_i & has_upper : live_i, is_second_q ? 4'd0 : live_i & has_upper, !turns, is_second_q,
                  part_i, is_between_i, tail_i};
  assign {live_o, waits_o, ends_o, is_second_o, level_part_o, is_between_o, tail_o} = agreed_along_q;
  always_ff @(posedge clk_i) begin
    if (scales) scaled_along_q <= along;
    if (wraps) wrapped_along_q <= scaled_along_q;
    if (agrees) agreed_along_q <= wrapped_along_q;
  end

  // ----------------------------------------------------------------------------------------------------------- the samples
  logic [16*SIDE_BITS-1:0] texel;
  logic [63:0]             part;
  logic [15:0]             border;
  logic [15:0]             scaled_level_q, wrapped_level_q;
  logic [4*LEVEL-1:0]      place_q;
  genvar l, m, d;
  generate
    for (l = 0; l < 4; l++) begin : gen_lane
      logic [3:0] level, wide_q, high_q, wrapped_wide_q, wrapped_high_q;
      logic       is_small_q, is_corner_q, wrapped_is_small_q;
      assign has_upper[l] = part_i[8*l+:8] != '0;
      assign level        = level_i[4*l+:4] + 4'(is_second_q);
      always_ff @(posedge clk_i) begin
        if (scales) begin
          wide_q                 <= less(wide, level);
          high_q                 <= less(high, level);
          is_small_q             <= level > first_of_one;
          is_corner_q            <= level == first_of_one + 4'd2;
          scaled_level_q[4*l+:4] <= level;
        end
        if (wraps) begin
          wrapped_wide_q          <= wide_q;
          wrapped_high_q          <= high_q;
          wrapped_is_small_q      <= is_small_q;
          wrapped_level_q[4*l+:4] <= scaled_level_q[4*l+:4];
        end
        if (agrees)
          place_q[LEVEL*l+:LEVEL] <= {wrapped_level_q[4*l], wrapped_is_small_q, {1'b0, wrapped_wide_q} + {1'b0, wrapped_high_q},
                                      wrapped_wide_q};
      end
      for (d = 0; d < 2; d++) begin : gen_axis
        texture_on_level #(
            .REFERENCE_BITS(REFERENCE_BITS),
            .SIDE_BITS     (SIDE_BITS),
            .BORDER        (BORDER)
        ) u_axis (
            .clk_i,
            .scales_i    (scales),
            .wraps_i     (wraps),
            .coordinate_i(coordinate_i[PLACE*(2*l+d)+:PLACE]),
            .level_i     (level),
            .is_linear_i (is_linear_i[l]),
            .log2_size_i (log2_size[4*d+:4]),
            .wrap_i      (wrap_i[3*d+:3]),
            .is_corner_i (is_corner_q),
            .texel_o     (texel[SIDE_BITS*(4*l+d)+:SIDE_BITS]),
            .next_o      (texel[SIDE_BITS*(4*l+2+d)+:SIDE_BITS]),
            .part_o      (part[16*l+8*d+:8]),
            .border_o    (border[4*l+2*d+:2])
        );
      end
    end
  endgenerate

  // ------------------------------------------------------------------------------------------------------------- who agrees
  logic [5:0] texels_agree, agree;
  texture_agree #(
      .ENDS     (2),
      .SIDE_BITS(SIDE_BITS)
  ) u_agree (
      .texel_i(texel),
      .agree_o(texels_agree)
  );
  generate
    for (m = 1; m < 4; m++) begin : gen_second
      for (l = 0; l < m; l++) begin : gen_first
        localparam int PAIR = m * (m - 1) / 2 + l;
        assign agree[PAIR] = texels_agree[PAIR] && wrapped_level_q[4*l+:4] == wrapped_level_q[4*m+:4];
      end
    end
  endgenerate
  always_ff @(posedge clk_i)
    if (agrees) begin
      texel_o <= texel;
      part_o  <= part;
      border_o <= border;
      agree_o <= agree;
    end

  // ---------------------------------------------------------------------------------------------------- the level of a pass
  logic        is_small;
  logic [4:0]  blocks;
  logic [3:0]  row;
  logic [20:0] begins;
  logic [LEVEL-1:0] of_pass;
  assign of_pass = first_i[1] ? (first_i[0] ? place_q[3*LEVEL+:LEVEL] : place_q[2*LEVEL+:LEVEL]) :
                                (first_i[0] ? place_q[LEVEL+:LEVEL] : place_q[0+:LEVEL]);
  assign {is_odd_o, is_small, blocks, row} = of_pass;
  assign begins   = (ones & (21'h1ffffe << blocks)) | 21'(is_small);
  assign offset_o = 24'(begins) << size_i;
  assign row_o    = row + 4'(size_i);

endmodule
