// Blend lane: one sample's colour and the stored one become the blended one, every channel in its own multipliers.
// Combinational, so that the next clock may blend what comes of it again.
//
//   factors are chosen -> s fs + d fd, or a difference that is at least 0 -> / 255, at most 255
//
// min and max are sums too: of 255 times the smaller or larger one and 0 times the other.
// Specification: blended of model/color_ops.hpp.
module blend_lane #(
    parameter int CHANNELS = 4  // that are stored: 3 or 4
) (
    input logic [31:0] source_i,    // 8 bits a channel, R lowest
    input logic [31:0] stored_i,
    input logic [15:0] factors_i,   // 4 bits each: source, destination, and of alpha
    input logic [5:0]  equation_i,  // 3 bits each: of colour, of alpha
    input logic [31:0] constant_i,

    output logic [8*CHANNELS-1:0] color_o
);

  localparam logic [2:0] SUBTRACT = 3'd1;
  localparam logic [2:0] REVERSE_SUBTRACT = 3'd2;
  localparam logic [2:0] MIN = 3'd3;
  localparam logic [2:0] MAX = 3'd4;

  // Of a factor the lowest bit says "one minus", which for codes of 8 bits is the complement, of 0 as well.
  function automatic [7:0] factor_of(input [3:0] code, input [7:0] source, input [7:0] stored, input [7:0] constant,
                                     input [7:0] source_alpha, input [7:0] stored_alpha, input [7:0] constant_alpha,
                                     input is_alpha);
    logic [7:0] room;  // above the stored alpha
    room = ~stored_alpha;
    case (code[3:1])
      3'd0: factor_of = '0;
      3'd1: factor_of = source;
      3'd2: factor_of = stored;
      3'd3: factor_of = source_alpha;
      3'd4: factor_of = stored_alpha;
      3'd5: factor_of = constant;
      3'd6: factor_of = constant_alpha;
      default: factor_of = is_alpha ? '1 : (source_alpha < room ? source_alpha : room);  // src_alpha_saturate
    endcase
    factor_of = factor_of ^ {8{code[0]}};
  endfunction

  genvar c;
  generate
    for (c = 0; c < CHANNELS; c++) begin : gen_channel
      logic [2:0]  equation;
      logic [7:0]  source, stored, source_factor, stored_factor;
      logic        takes_source, is_extreme;  // min or max: of the two
      logic        subtracts, reverses;
      logic [15:0] source_product, stored_product;
      logic [17:0] sum;  // with its sign
      /* verilator lint_off UNUSEDSIGNAL */  // the fraction is dropped
      logic [16:0] rounded, quotient;
      /* verilator lint_on UNUSEDSIGNAL */

      assign equation     = c == 3 ? equation_i[5:3] : equation_i[2:0];
      assign source       = source_i[8*c+:8];
      assign stored       = stored_i[8*c+:8];
      assign is_extreme   = equation == MIN || equation == MAX;
      assign takes_source = (source < stored) == (equation == MIN);
      always_comb begin
        source_factor = factor_of(c == 3 ? factors_i[11:8] : factors_i[3:0], source, stored, constant_i[8*c+:8],
                                  source_i[31:24], stored_i[31:24], constant_i[31:24], c == 3);
        stored_factor = factor_of(c == 3 ? factors_i[15:12] : factors_i[7:4], source, stored, constant_i[8*c+:8],
                                  source_i[31:24], stored_i[31:24], constant_i[31:24], c == 3);
        if (is_extreme) begin
          source_factor = {8{takes_source}};
          stored_factor = {8{!takes_source}};
        end
      end
      assign subtracts      = equation == SUBTRACT;
      assign reverses       = equation == REVERSE_SUBTRACT;
      assign source_product = source * source_factor;
      assign stored_product = stored * stored_factor;
      assign sum = ({2'd0, source_product} ^ {18{reverses}}) + ({2'd0, stored_product} ^ {18{subtracts}}) +
                   18'(reverses || subtracts);

      assign rounded  = (sum[17] ? '0 : sum[16:0]) + 17'd128;
      assign quotient = rounded + {8'd0, rounded[16:8]};
      assign color_o[8*c+:8] = quotient[15:8] | {8{quotient[16]}};
    end
    if (CHANNELS == 3) begin : gen_opaque
      /* verilator lint_off UNUSEDSIGNAL */
      logic unused;
      assign unused = &{equation_i[5:3], factors_i[15:8]};
      /* verilator lint_on UNUSEDSIGNAL */
    end
  endgenerate

endmodule
