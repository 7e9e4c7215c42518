// Combines a texel's colour with the primitive's. Combinational.
//
// Every mode is one product and one division by 255, floor((s + 128 + ((s + 128) >> 8)) >> 8), which is
// floor(257 (s + 128) / 65536): the multiplier gives 257 times the product, its left factor being written twice.
//   modulate  s = c t            replace  s = 255 t
//   decal     s = 255 c + a (t - c)
//   add       s = 255 min(c + t, 255), alpha as modulate
//   blend     s = 255 c + t (k - c), alpha as modulate: to the constant k
// Specification: combined of model/stages/texture_filter.hpp.
module texture_combine #(
    parameter int CHANNELS = 4,  // of the primitive's colour: 3 or 4
    parameter int CONSTANT = 0   // 1: blend exists
) (
    input  logic [31:0]           texel_i,      // 8 bits a channel, R lowest
    input  logic [8*CHANNELS-1:0] color_i,      // the primitive's, likewise
    input  logic [2:0]            combine_i,    // 0 modulate, 1 replace, 2 decal, 3 add, 4 blend
    input  logic [23:0]           constant_i,   // for blend
    input  logic                  has_alpha_i,  // the format stores alpha
    output logic [8*CHANNELS-1:0] color_o
);

  logic is_modulated, is_replaced, is_decal, is_added, is_blended;
  assign is_blended   = CONSTANT != 0 && combine_i[2];
  assign is_modulated = combine_i[1:0] == 2'd0 && !is_blended;
  assign is_replaced  = combine_i[1:0] == 2'd1;
  assign is_decal     = combine_i[1:0] == 2'd2;
  assign is_added     = combine_i[1:0] == 2'd3;

  genvar n;
  generate
    for (n = 0; n < CHANNELS; n++) begin : gen_channel
      logic [7:0]         color, texel, whole;
      logic [7:0]         left;  // left factor of the product
      logic signed [8:0]  right;
      logic signed [25:0] product;  // 257 times
      logic [23:0]        quotient;  // with 16 bits behind the point
      assign color   = color_i[8*n+:8];
      assign texel   = texel_i[8*n+:8];
      assign product = 26'($signed({1'b0, left, left}) * right);
      if (n < 3) begin : gen_color
        logic [8:0] sum;
        assign sum   = {1'b0, color} + {1'b0, texel};
        assign whole = is_replaced ? texel : is_added ? sum[7:0] | {8{sum[8]}} : is_decal || is_blended ? color : '0;
        assign left  = is_decal ? texel_i[31:24] : is_blended ? texel : is_modulated ? color : '0;
        assign right = $signed({1'b0, is_blended ? constant_i[8*n+:8] : texel}) -
                       $signed({1'b0, color & {8{is_decal || is_blended}}});
        // 257 (255 times a colour + 128): 65536 times the colour, 128 * 257 less once the colour below that. Two chains: a sum
        // of three at once waits for the product with all of it.
        logic [8:0] below;
        add_or_subtract #(
            .WIDTH(9)
        ) u_below (
            .subtracts_i(1'b1),
            .a_i        (9'd128),
            .b_i        ({1'b0, whole}),
            .sum_o      (below)
        );
        add_or_subtract #(
            .WIDTH(24)
        ) u_quotient (
            .subtracts_i(1'b0),
            .a_i        ({whole, !below[8], {7{below[8]}}, below[7:0]}),
            .b_i        (product[23:0]),
            .sum_o      (quotient)
        );
        assign color_o[8*n+:8] = quotient[23:16];
      end else begin : gen_alpha
        assign whole    = is_replaced && has_alpha_i ? texel : color;
        assign left     = color;
        assign right    = $signed({1'b0, texel});
        assign quotient = product[23:0] + 24'(257 * 128);
        assign color_o[8*n+:8] = is_modulated || is_added || is_blended ? quotient[23:16] : whole;
      end
    end
    if (CHANNELS == 3) begin : gen_opaque
      logic unused;
      assign unused = has_alpha_i;
    end
  endgenerate

endmodule
