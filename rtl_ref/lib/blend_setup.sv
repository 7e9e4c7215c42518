// Blend setup: the values of the blend registers as all lanes take them (blend_lane.sv). Combinational.
//
// A factor is one of the fragment's and the stored colours, chosen in each lane, or known here: a constant or 0. "One
// minus" is the complement, which for codes of 8 bits is an exclusive or with ones, of 0 as well. min and max get 0
// from here: a lane sees which colour it takes. Without blending the factors are 1 and 0, and the sum is the fragment's
// colour. Specification: blend_factor of model/stages/color_ops.hpp.
module blend_setup #(
    parameter int CHANNELS = 4  // stored channels: 3 or 4
) (
    input logic        blends_i,
    input logic [15:0] factors_i,   // 4 bits each: source, destination, source alpha, destination alpha
    input logic [5:0]  equation_i,  // 3 bits each: colour equation, alpha equation
    input logic [31:0] constant_i,

    // For each factor, lowest bit first: it is the source, the stored colour, the alpha of either, src_alpha_saturate;
    // the complement
    output logic [23:0]            chooses_o,
    output logic [16*CHANNELS-1:0] fixed_o,    // both factors of each channel, where they are constants
    output logic [5:0]             equation_o
);

  localparam logic [2:0] MIN = 3'd3;
  localparam logic [2:0] MAX = 3'd4;

  assign equation_o = blends_i ? equation_i : '0;

  genvar f, c;
  generate
    for (f = 0; f < 4; f++) begin : gen_factor
      localparam bit IS_ALPHA = f >= 2;
      logic [3:0] code;
      logic [2:0] equation;
      logic       is_chosen;  // chosen from colours or constants
      assign code      = factors_i[4*f+:4];
      assign equation  = equation_i[IS_ALPHA?3:0+:3];
      assign is_chosen = blends_i && equation != MIN && equation != MAX;
      assign chooses_o[6*f+:5] = {5{is_chosen}} & {code[3:1] == 3'd7 && !IS_ALPHA, code[3:1] == 3'd4, code[3:1] == 3'd3,
                                                   code[3:1] == 3'd2, code[3:1] == 3'd1};
      // For the alpha channel src_alpha_saturate is 1.
      assign chooses_o[6*f+5] = blends_i ? is_chosen && code[0] != (code[3:1] == 3'd7 && IS_ALPHA) : f % 2 == 0;
      for (c = IS_ALPHA ? 3 : 0; c < (IS_ALPHA ? CHANNELS : 3); c++) begin : gen_channel
        assign fixed_o[16*c+8*(f%2)+:8] = (constant_i[8*c+:8] & {8{is_chosen && code[3:1] == 3'd5}}) |
                                          (constant_i[31:24] & {8{is_chosen && code[3:1] == 3'd6}});
      end
    end
  endgenerate

endmodule
