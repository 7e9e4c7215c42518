// Texture border: which of a linear filter's two texels along an axis are the border's, and the weight of the second
// where half_border holds the place in the image; for a nearest filter both texels are the same one. Combinational.
// Specification: is_on_border, texels_around and nearest_texel of model/stages/texture_filter.hpp.
module texture_border #(
    parameter int NUMBER_BITS = 24,  // with its sign
    parameter int SIDE_BITS = 12,    // log2 of the longest side
    parameter int BORDER = 0         // 0: none is, and the weight stays
) (
    input  logic [NUMBER_BITS-1:0] first_i,  // texel numbers, not yet wrapped
    input  logic [NUMBER_BITS-1:0] next_i,
    input  logic [SIDE_BITS-1:0]   last_i,   // size - 1
    input  logic [2:0]             wrap_i,   // 3 border, 5 half_border
    input  logic                   is_linear_i,
    input  logic [7:0]             part_i,   // weight of the next texel, in 256ths
    output logic [1:0]             border_o, // the first texel, the next one
    output logic [7:0]             part_o
);

  function automatic is_above(input [NUMBER_BITS-1:0] texel, input [SIDE_BITS-1:0] side);
    is_above = !texel[NUMBER_BITS-1] &&
               (texel[NUMBER_BITS-2:SIDE_BITS] != '0 || (texel[SIDE_BITS-1:0] & ~side) != '0);
  endfunction

  generate
    if (BORDER != 0) begin : gen_border
      logic is_border, holds, first_is_below, next_is_below, first_is_above, next_is_above, is_held;
      assign is_border      = wrap_i[1:0] == 2'd3;
      assign holds          = wrap_i[2] && is_linear_i;
      assign first_is_below = first_i[NUMBER_BITS-1];
      assign next_is_below  = next_i[NUMBER_BITS-1];
      assign first_is_above = is_above(first_i, last_i);
      assign next_is_above  = is_above(next_i, last_i);
      // A held place is half a texel from the middle of the first texel or of the last one: beyond it the half is exceeded.
      assign is_held        = holds && ((first_is_below && (next_is_below || !part_i[7])) ||
                                        (next_is_above && (first_is_above || part_i[7])));
      assign border_o[0]    = (is_border && (first_is_below || first_is_above)) || (holds && first_is_below);
      assign border_o[1]    = (is_border && (next_is_below || next_is_above)) || (holds && next_is_above);
      assign part_o         = is_held ? 8'h80 : part_i;
    end else begin : gen_no_border
      assign border_o = '0;
      assign part_o   = part_i;
      logic unused;
      assign unused = &{first_i, next_i, last_i, wrap_i, is_linear_i};
    end
  endgenerate

endmodule
