// One coordinate of a sample on a level of its texture: the texel that holds it, or the two whose centres are around
// it. Two clocks.
//
//   scale  the place divided by 2^level, at most by the side, with one more bit for rounding
//   wrap   rounded and half a texel less, or cut off; then onto the level's image
// Both have enables. Specification: at_level, rounded_at_level and texels_around of model/stages/texture_filter.hpp.
module texture_on_level #(
    parameter int REFERENCE_BITS = 24,  // bits of a place's texel number, with its sign
    parameter int SIDE_BITS = 12,       // log2 of the longest side
    parameter int BORDER = 0            // 1: texels may be the border's
) (
    input logic clk_i,
    input logic scales_i,  // enable of the first clock
    input logic wraps_i,   // enable of the second clock

    input logic [REFERENCE_BITS+7:0] coordinate_i,  // 2^-8 texels of level 0
    input logic [3:0]                level_i,
    input logic                      is_linear_i,

    // Constants of the texture: they stay while samples are under way
    input logic [3:0] log2_size_i,
    input logic [2:0] wrap_i,

    input  logic                 is_corner_i,  // in the second clock: the level's texel is (2, 2) of its block
    output logic [SIDE_BITS-1:0] texel_o,
    output logic [SIDE_BITS-1:0] next_o,
    output logic [7:0]           part_o,
    output logic [1:0]           border_o  // the texel, the next one: it is the border's
);

  localparam int PLACE = REFERENCE_BITS + 8;

  logic [3:0]           by, left;  // bits of the place that are shifted out, of the texel that remain
  logic signed [PLACE:0] long, scaled_q;
  logic [SIDE_BITS-1:0] last_q, first_texel, next_texel;
  logic                 is_linear_q;
  logic [PLACE-1:0]     place;
  logic [REFERENCE_BITS-1:0] first, second;
  logic [7:0]           part, weight;
  logic [1:0]           border;
  assign by   = level_i < log2_size_i ? level_i : log2_size_i;
  assign left = log2_size_i - by;
  assign long = {coordinate_i, 1'b0};
  always_ff @(posedge clk_i)
    if (scales_i) begin
      scaled_q    <= long >>> by;
      last_q      <= ~({SIDE_BITS{1'b1}} << left);
      is_linear_q <= is_linear_i;
    end

  assign place = scaled_q[PLACE:1] - PLACE'({is_linear_q, 7'd0}) + PLACE'(is_linear_q && scaled_q[0]);
  texture_wrap #(
      .NUMBER_BITS(REFERENCE_BITS),
      .SIDE_BITS  (SIDE_BITS)
  ) u_first (
      .number_i(first),
      .last_i  (last_q),
      .wrap_i  (wrap_i[1:0]),
      .texel_o (first_texel)
  );
  texture_wrap #(
      .NUMBER_BITS(REFERENCE_BITS),
      .SIDE_BITS  (SIDE_BITS)
  ) u_next (
      .number_i(second),
      .last_i  (last_q),
      .wrap_i  (wrap_i[1:0]),
      .texel_o (next_texel)
  );
  always_ff @(posedge clk_i)
    if (wraps_i) begin
      texel_o  <= first_texel | SIDE_BITS'({is_corner_i, 1'b0});
      next_o   <= next_texel | SIDE_BITS'({is_corner_i, 1'b0});
      part_o   <= weight;
      border_o <= border;
    end

  assign first  = place[PLACE-1:8];
  assign second = first + REFERENCE_BITS'(is_linear_q);
  assign part   = is_linear_q ? place[7:0] : '0;
  texture_border #(
      .NUMBER_BITS(REFERENCE_BITS),
      .SIDE_BITS  (SIDE_BITS),
      .BORDER     (BORDER)
  ) u_border (
      .first_i    (first),
      .next_i     (second),
      .last_i     (last_q),
      .wrap_i,
      .is_linear_i(is_linear_q),
      .part_i     (part),
      .border_o   (border),
      .part_o     (weight)
  );

endmodule
