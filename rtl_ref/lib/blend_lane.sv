// Blend lane: blends one sample's colour with the stored colour, every channel in its own multipliers. Combinational,
// so that the next clock may blend with the result.
//
//   factors -> s fs + d fd, or a difference that is at least 0 -> / 255, at most 255
//
// min and max are sums too: 255 times the smaller or larger colour and 0 times the other. blend_setup.sv gives the part
// of the factors that is the same for all lanes. Specification: blended of model/stages/color_ops.hpp.
module blend_lane #(
    parameter int CHANNELS = 4  // stored channels: 3 or 4
) (
    input logic [31:0] source_i,  // 8 bits a channel, R lowest
    input logic [31:0] stored_i,
    input logic [23:0] chooses_i,   // as blend_setup gives them
    input logic [5:0]  equation_i,  // 3 bits each: colour equation, alpha equation
    input logic [16*CHANNELS-1:0] fixed_i,

    output logic [8*CHANNELS-1:0] color_o
);

  localparam logic [2:0] SUBTRACT = 3'd1;
  localparam logic [2:0] REVERSE_SUBTRACT = 3'd2;
  localparam logic [2:0] MIN = 3'd3;
  localparam logic [2:0] MAX = 3'd4;

  // The part of the factors that is the same for all channels: an alpha, and whether factors are complements.
  logic [7:0] source_alpha, stored_alpha, room;  // 255 minus the stored alpha
  logic [31:0] alpha;  // one alpha per factor
  assign source_alpha = source_i[31:24];
  assign stored_alpha = stored_i[31:24];
  assign room         = ~stored_alpha;
  genvar c, f;
  generate
    for (f = 0; f < 4; f++) begin : gen_alpha
      assign alpha[8*f+:8] = {8{chooses_i[6*f+5]}} ^
                             ((source_alpha & {8{chooses_i[6*f+2]}}) | (stored_alpha & {8{chooses_i[6*f+3]}}) |
                              ((source_alpha < room ? source_alpha : room) & {8{chooses_i[6*f+4]}}));
    end

    for (c = 0; c < CHANNELS; c++) begin : gen_channel
      localparam int SET = c == 3 ? 2 : 0;  // number of the channel's first factor
      logic [2:0]  equation;
      logic [7:0]  source, stored;
      logic [15:0] factors;  // factor of the source; above it that of the stored colour
      logic        takes_source, is_extreme;  // min or max takes the source
      logic        subtracts, reverses;
      logic [15:0] source_product, stored_product;
      assign equation     = c == 3 ? equation_i[5:3] : equation_i[2:0];
      assign source       = source_i[8*c+:8];
      assign stored       = stored_i[8*c+:8];
      assign is_extreme   = equation == MIN || equation == MAX;
      assign takes_source = (source < stored) == (equation == MIN);
      for (f = 0; f < 2; f++) begin : gen_factor
        assign factors[8*f+:8] = ((source & {8{chooses_i[6*(SET+f)]}}) | (stored & {8{chooses_i[6*(SET+f)+1]}})) ^
                                 alpha[8*(SET+f)+:8] ^ fixed_i[16*c+8*f+:8] ^ {8{is_extreme && takes_source == (f == 0)}};
      end
      assign source_product = source * factors[7:0];
      assign stored_product = stored * factors[15:8];

      // One carry chain gives a + b, a - b and, turned around, b - a: that is ~(a - b - 1), and is inverted after the
      // division.
      logic        differs;  // the equation is not a sum
      logic [16:0] sum;      // less than 2^17; the highest bit is the sign of a difference
      logic [17:0] sum_and_carry;
      assign subtracts = equation == SUBTRACT;
      assign reverses  = equation == REVERSE_SUBTRACT;
      assign differs   = subtracts || reverses;
      add_or_subtract #(
          .WIDTH(18)
      ) u_sum (
          .subtracts_i(differs),
          .a_i        ({1'b0, source_product, subtracts}),
          .b_i        ({1'b0, stored_product, 1'b1}),
          .sum_o      (sum_and_carry)
      );
      assign sum = sum_and_carry[17:1];

      // floor(v / 255 + 1/2) = (t + (t >> 8)) >> 8, t = v + 128: v + (v >> 8), 128 and a carry where the fraction of v
      // / 256 is a half. The quotient of ~v is the complement if 128 is subtracted instead.
      logic signed [2:0]  upper;  // v >> 15, and 128 more or less, which changes nothing below that
      logic [17:0] quotient;  // its lowest bit only makes the carry
      logic        is_negative, is_above;
      assign upper       = {differs && sum[16], sum[16:15]} + (reverses ? 3'b111 : 3'b001);
      assign quotient    = {sum, 1'b1} + {{7{upper[2] && differs}}, upper, sum[14:8], sum[7]};
      assign is_negative = differs && sum[16] != reverses;
      assign is_above    = !differs && quotient[17];
      assign color_o[8*c+:8] = is_negative ? '0 : (quotient[16:9] ^ {8{reverses}}) | {8{is_above}};
    end
  endgenerate

endmodule
