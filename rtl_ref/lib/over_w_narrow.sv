// P over w, narrowed for the product: Pn = P / 2^(e+c) rounded, clamped to NARROW bits and a sign. Two clocks.
//
// A fixed pipeline without enables. Specification: narrow_p of model/stages/perspective.hpp.
module over_w_narrow #(
    parameter int P_BITS = 28,  // with its sign; 18 to 33
    parameter int NARROW = 17   // k_P
) (
    input logic clk_i,

    input  logic [P_BITS-1:0] p_i,
    input  logic [5:0]        amount_i,  // e + c + NARROW; the shift to the right is NARROW less
    output logic [NARROW:0]   narrow_o   // input of two clocks ago
);

  // P with room below, and a bit for the half: shifted by 16s, 4s, 1s. Bits shifted out at the top must repeat the
  // sign.
  localparam int WIDE = NARROW + 65;
  localparam int BY_16 = NARROW + 17;
  localparam int BY_4 = NARROW + 5;
  localparam int BY_1 = NARROW + 2;

  function automatic [BY_16-1:0] by_16(input [WIDE-1:0] value, input [1:0] steps);
    case (steps)
      2'd0: by_16 = value[BY_16-1:0];
      2'd1: by_16 = value[16+:BY_16];
      2'd2: by_16 = value[32+:BY_16];
      default: by_16 = value[48+:BY_16];
    endcase
  endfunction
  function automatic [BY_4-1:0] by_4(input [BY_16-1:0] value, input [1:0] steps);
    case (steps)
      2'd0: by_4 = value[BY_4-1:0];
      2'd1: by_4 = value[4+:BY_4];
      2'd2: by_4 = value[8+:BY_4];
      default: by_4 = value[12+:BY_4];
    endcase
  endfunction
  function automatic [BY_1-1:0] by_1(input [BY_4-1:0] value, input [1:0] steps);
    case (steps)
      2'd0: by_1 = value[BY_1-1:0];
      2'd1: by_1 = value[1+:BY_1];
      2'd2: by_1 = value[2+:BY_1];
      default: by_1 = value[3+:BY_1];
    endcase
  endfunction

  logic             sign, lost_16, lost_4, lost_1;
  logic [WIDE-1:0]  wide;
  logic [BY_16-1:0] shifted_16;
  logic [BY_4-1:0]  shifted_4;
  logic [BY_1-1:0]  shifted_1, shifted_q;
  logic [11:0]      top_4;  // whether a bit differs from the sign
  logic [2:0]       top_1;
  logic             sign_q, is_held_q;
  logic [NARROW:0]  rounded;

  assign sign       = p_i[P_BITS-1];
  assign wide       = {{(WIDE - 1 - NARROW - P_BITS) {sign}}, p_i, {(NARROW + 1) {1'b0}}};
  assign shifted_16 = by_16(wide, amount_i[5:4]);
  assign shifted_4  = by_4(shifted_16, amount_i[3:2]);
  assign shifted_1  = by_1(shifted_4, amount_i[1:0]);
  assign top_4      = shifted_16[BY_4+:12] ^ {12{sign}};
  assign top_1      = shifted_4[BY_1+:3] ^ {3{sign}};
  assign lost_16    = amount_i[5:4] == 2'd0 && p_i[P_BITS-2:16] != {(P_BITS - 17) {sign}};
  assign lost_4     = (amount_i[3:2] == 2'd0 && top_4[3:0] != '0) || (!amount_i[3] && top_4[7:4] != '0) ||
                      (amount_i[3:2] != 2'd3 && top_4[11:8] != '0);
  assign lost_1     = (amount_i[1:0] == 2'd0 && top_1[0]) || (!amount_i[1] && top_1[1]) ||
                      (amount_i[1:0] != 2'd3 && top_1[2]);

  assign rounded = shifted_q[NARROW+1:1] + (NARROW + 1)'(shifted_q[0]);
  always_ff @(posedge clk_i) begin
    shifted_q  <= shifted_1;
    sign_q     <= sign;
    is_held_q  <= lost_16 || lost_4 || lost_1 || shifted_1[NARROW+1] != sign;
    narrow_o   <= (is_held_q || (!sign_q && rounded[NARROW])) ? {sign_q, {NARROW{!sign_q}}} : rounded;
  end

endmodule
