// One coordinate of a sample: P over q, as a texel of the image. Six clocks from P to texel.
//
//   narrow   Pn = P / 2^(e+c) rounded, clamped to NARROW bits and a sign
//   product  Pn r, r the reciprocal of the normalised q
//   place    the texels: the product times 2^x, rounded at FRACTION bits, the fraction cut off
//   wrap     + u_ref, then onto the image
// A fixed pipeline without enables. Specification: narrow_p, over_q of model/stages/perspective.hpp, texels_around of
// texture_filter.hpp.
module texture_axis #(
    parameter int P_BITS = 28,          // with its sign; 18 to 33
    parameter int MANTISSA = 18,        // k
    parameter int NARROW = 17,          // k_P
    parameter int FRACTION = 8,         // f
    parameter int REFERENCE_BITS = 24,  // with its sign
    parameter int SIDE_BITS = 12,       // log2 of the longest side
    parameter int LINEAR = 0,  // 1 also gives the two texels whose centres are around the place, 2 the place alone
    parameter int BORDER = 0   // 1: texels may be the border's
) (
    input logic clk_i,

    // Inputs of clocks 0, 0, 3, 4, 5
    input logic [P_BITS-1:0]         p_i,
    input logic [5:0]                amount_i,  // e + c + NARROW; the shift to the right is NARROW less
    input logic [MANTISSA-2:0]       reciprocal_i,  // below its highest bit, which is set
    input logic [4:0]                reach_i,      // x, at most 20
    input logic [REFERENCE_BITS-1:0] reference_i,  // u_ref

    // Constants of the texture: they stay while samples are under way
    input logic [SIDE_BITS-1:0] last_i,   // size - 1
    input logic [2:0]           wrap_i,   // 0 repeat, 1 clamp, 2 mirror; with BORDER 3 border, 5 half_border
    input logic                 is_linear_i,

    // Outputs for the input six clocks ago
    output logic [SIDE_BITS-1:0] texel_o,
    output logic [SIDE_BITS-1:0] next_o,  // the next texel, where the filter is linear
    output logic [7:0]           part_o,  // weight of the next texel, in 256ths
    output logic [1:0]           border_o,  // the first texel, the next one: it is the border's
    output logic [REFERENCE_BITS+7:0] coordinate_o  // or the place before wrapping, 2^-8 texels
);

  // ----------------------------------------------------------------------------------------------------- clocks 0, 1: narrow
  logic [NARROW:0] narrow, narrow_2_q;
  over_w_narrow #(
      .P_BITS(P_BITS),
      .NARROW(NARROW)
  ) u_narrow (
      .clk_i,
      .p_i,
      .amount_i,
      .narrow_o(narrow)
  );
  always_ff @(posedge clk_i) narrow_2_q <= narrow;

  // ---------------------------------------------------------------------------------------------------- clock 3: the product
  // The highest bit of r is set: without it, as a signed number, r is no longer than a multiplier's input.
  localparam int PRODUCT = NARROW + 1 + MANTISSA;
  logic signed [PRODUCT-1:0] short_product, product_q;
  assign short_product = $signed(narrow_2_q) * $signed({1'b0, reciprocal_i});
  always_ff @(posedge clk_i)
    product_q <= short_product + $signed({narrow_2_q, {(MANTISSA - 1) {1'b0}}});

  // ------------------------------------------------------------------------------------------------------- clock 4: the place
  // Times 2^x, between the half that rounds and the highest bit of the texels: shifted by 8s, 2s, 1.
  localparam int POINT = MANTISSA + NARROW - 1;
  localparam int WHOLE = 22;                // bits of the texel number
  localparam int PLACE = WHOLE + FRACTION + 1;
  localparam int UP_2 = PLACE + 1;          // bits before the shift by 1
  localparam int UP_8 = UP_2 + 6;           // bits before that by 2s
  localparam int LONG = UP_8 + 24;          // bits before that by 8s
  localparam int ABOVE = POINT + WHOLE - PRODUCT;  // copies of the sign
  localparam int BELOW = LONG - PRODUCT - ABOVE;   // zeros

  function automatic [UP_8-1:0] up_8(input [LONG-1:0] value, input [1:0] n);
    case (n)
      2'd0: up_8 = value[24+:UP_8];
      2'd1: up_8 = value[16+:UP_8];
      2'd2: up_8 = value[8+:UP_8];
      default: up_8 = value[0+:UP_8];
    endcase
  endfunction
  function automatic [UP_2-1:0] up_2(input [UP_8-1:0] value, input [1:0] n);
    case (n)
      2'd0: up_2 = value[6+:UP_2];
      2'd1: up_2 = value[4+:UP_2];
      2'd2: up_2 = value[2+:UP_2];
      default: up_2 = value[0+:UP_2];
    endcase
  endfunction

  logic [LONG-1:0]  long;
  logic [UP_2-1:0]  placed_2;
  logic [PLACE-1:0] placed;
  logic [WHOLE-1:0] whole_q;
  logic             carries_q;
  logic [FRACTION-1:0] rounded_part;
  assign rounded_part = placed[FRACTION:1] + FRACTION'(placed[0]);
  generate
    if (BELOW >= 0) begin : gen_zeros
      assign long = {{ABOVE{product_q[PRODUCT-1]}}, product_q, {BELOW{1'b0}}};
    end else begin : gen_cut  // no reach shifts these bits up to the rounding bit
      logic [ABOVE+PRODUCT-1:0] all;
      assign all  = {{ABOVE{product_q[PRODUCT-1]}}, product_q};
      assign long = all[ABOVE+PRODUCT-1-:LONG];
    end
  endgenerate
  assign placed_2 = up_2(up_8(long, reach_i[4:3]), reach_i[2:1]);
  assign placed   = reach_i[0] ? placed_2[PLACE-1:0] : placed_2[UP_2-1:1];
  always_ff @(posedge clk_i) begin
    whole_q   <= placed[PLACE-1-:WHOLE];
    carries_q <= &placed[FRACTION:0];  // a half of the last bit carries into the texel number
  end

  // -------------------------------------------------------------------------------------------------------- clock 5: the wrap
  logic [REFERENCE_BITS-1:0] number;
  assign number = reference_i + {{(REFERENCE_BITS - WHOLE) {whole_q[WHOLE-1]}}, whole_q} + REFERENCE_BITS'(carries_q);

  generate
    if (LINEAR == 2) begin : gen_levels
      logic [FRACTION-1:0] part_q;
      always_ff @(posedge clk_i) begin
        part_q       <= rounded_part;
        coordinate_o <= {number, part_q, {(8 - FRACTION) {1'b0}}};
      end
      assign texel_o = '0;
      assign next_o  = '0;
      assign part_o  = '0;
      assign border_o = '0;
      logic unused;
      assign unused = &{last_i, wrap_i, is_linear_i};
    end else if (LINEAR == 1) begin : gen_linear
      // Less half a texel: measured from the centre of the previous texel.
      logic [FRACTION-1:0]       part_q;
      logic [7:0]                part, weight, held_weight;
      logic [1:0]                border;
      logic [REFERENCE_BITS-1:0] first, second;
      logic [SIDE_BITS-1:0]      texel, next;
      always_ff @(posedge clk_i) part_q <= rounded_part;
      assign part  = {part_q, {(8 - FRACTION) {1'b0}}};
      assign first = number - REFERENCE_BITS'(is_linear_i && !part[7]);
      texture_wrap #(
          .NUMBER_BITS(REFERENCE_BITS),
          .SIDE_BITS  (SIDE_BITS)
      ) u_first (
          .number_i(first),
          .last_i,
          .wrap_i  (wrap_i[1:0]),
          .texel_o (texel)
      );
      texture_wrap #(
          .NUMBER_BITS(REFERENCE_BITS),
          .SIDE_BITS  (SIDE_BITS)
      ) u_next (
          .number_i(second),
          .last_i,
          .wrap_i  (wrap_i[1:0]),
          .texel_o (next)
      );
      assign second = first + REFERENCE_BITS'(is_linear_i);
      assign weight = is_linear_i ? part ^ 8'h80 : '0;
      texture_border #(
          .NUMBER_BITS(REFERENCE_BITS),
          .SIDE_BITS  (SIDE_BITS),
          .BORDER     (BORDER)
      ) u_border (
          .first_i (first),
          .next_i  (second),
          .last_i,
          .wrap_i,
          .is_linear_i,
          .part_i  (weight),
          .border_o(border),
          .part_o  (held_weight)
      );
      always_ff @(posedge clk_i) begin
        texel_o  <= texel;
        next_o   <= next;
        part_o   <= held_weight;
        border_o <= border;
      end
      assign coordinate_o = '0;
    end else begin : gen_nearest
      logic [SIDE_BITS-1:0] texel;
      logic [1:0]           border;
      logic [7:0]           no_weight;
      texture_wrap #(
          .NUMBER_BITS(REFERENCE_BITS),
          .SIDE_BITS  (SIDE_BITS)
      ) u_wrap (
          .number_i(number),
          .last_i,
          .wrap_i  (wrap_i[1:0]),
          .texel_o (texel)
      );
      texture_border #(
          .NUMBER_BITS(REFERENCE_BITS),
          .SIDE_BITS  (SIDE_BITS),
          .BORDER     (BORDER)
      ) u_border (
          .first_i    (number),
          .next_i     (number),
          .last_i,
          .wrap_i,
          .is_linear_i(1'b0),
          .part_i     ('0),
          .border_o   (border),
          .part_o     (no_weight)
      );
      always_ff @(posedge clk_i) begin
        texel_o  <= texel;
        border_o <= border;
      end
      logic unused;
      assign unused = &no_weight;
      assign next_o       = '0;
      assign part_o       = '0;
      assign coordinate_o = '0;
    end
  endgenerate

endmodule
