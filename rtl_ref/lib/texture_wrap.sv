// Texture wrap: maps a texel number onto the image. Combinational. Specification: wrapped_texel of
// model/stages/texture_filter.hpp.
module texture_wrap #(
    parameter int NUMBER_BITS = 24,  // with its sign
    parameter int SIDE_BITS = 12     // log2 of the longest side
) (
    input  logic [NUMBER_BITS-1:0] number_i,
    input  logic [SIDE_BITS-1:0]   last_i,  // size - 1
    input  logic [1:0]             wrap_i,  // 0 repeat, 1 clamp, 2 mirror
    output logic [SIDE_BITS-1:0]   texel_o
);

  logic [SIDE_BITS-1:0] low, beyond;
  logic [SIDE_BITS:0]   turn;
  logic                 is_clamped, is_mirrored, is_above, is_turned;
  assign is_clamped  = wrap_i[0];
  assign is_mirrored = wrap_i[1];
  assign low         = number_i[SIDE_BITS-1:0];
  assign beyond      = low & ~last_i;
  assign is_above    = number_i[NUMBER_BITS-2:SIDE_BITS] != '0 || beyond != '0;
  assign turn        = number_i[SIDE_BITS:0] & ({last_i, 1'b1} ^ {1'b0, last_i});  // the bit above the image's bits
  assign is_turned   = is_mirrored && turn != '0;
  assign texel_o     = is_clamped && number_i[NUMBER_BITS-1] ? '0 :
                       is_clamped && is_above ? last_i : (low ^ {SIDE_BITS{is_turned}}) & last_i;

endmodule
