// An adder on the carry chain of an ECP5, whose carry-in is a constant: in front of synth_ecp5's own map of $alu.
//
// That map ties CIN of the first cell to the constant, and nextpnr puts a cell in front of it that brings the constant into the
// chain: two places an adder. Here the lower half of the first cell makes the carry out of bit 0, which needs no CIN, and bit 0
// itself is a gate. Adders of up to four bits stay gates, as there.
(* techmap_celltype = "$alu" *)
module ecp5_constant_carry (A, B, CI, BI, X, Y, CO);
  parameter A_SIGNED = 0;
  parameter B_SIGNED = 0;
  parameter A_WIDTH = 8;
  parameter B_WIDTH = 8;
  parameter Y_WIDTH = 8;
  parameter _TECHMAP_CONSTMSK_CI_ = 0;
  parameter _TECHMAP_CONSTVAL_CI_ = 0;
  parameter _TECHMAP_CONSTMSK_BI_ = 0;
  parameter _TECHMAP_CONSTVAL_BI_ = 0;

  (* force_downto *) input [A_WIDTH-1:0] A;
  (* force_downto *) input [B_WIDTH-1:0] B;
  (* force_downto *) output [Y_WIDTH-1:0] X, Y;
  input CI, BI;
  (* force_downto *) output [Y_WIDTH-1:0] CO;

  wire _TECHMAP_FAIL_ = Y_WIDTH <= 4 || !_TECHMAP_CONSTMSK_CI_ || !_TECHMAP_CONSTMSK_BI_;

  (* force_downto *) wire [Y_WIDTH-1:0] a, b_plain;
  \$pos #(.A_SIGNED(A_SIGNED), .A_WIDTH(A_WIDTH), .Y_WIDTH(Y_WIDTH)) a_conv (.A(A), .Y(a));
  \$pos #(.A_SIGNED(B_SIGNED), .A_WIDTH(B_WIDTH), .Y_WIDTH(Y_WIDTH)) b_conv (.A(B), .Y(b_plain));
  (* force_downto *) wire [Y_WIDTH-1:0] b = BI ? ~b_plain : b_plain;

  // The lower LUT2 of slot 0, over {b, a}: the carry out of bit 0.
  localparam [3:0] CARRY = _TECHMAP_CONSTVAL_BI_ ? (_TECHMAP_CONSTVAL_CI_ ? 4'b1011 : 4'b0010) :
                                                   (_TECHMAP_CONSTVAL_CI_ ? 4'b1110 : 4'b1000);
  localparam SUM = 16'b1001011010101010;  // as synth_ecp5 has it
  localparam CELLS = (Y_WIDTH + 1) / 2;
  // Slot k is bit k; one more where the width is odd.
  (* force_downto *) wire [2*CELLS-1:0] a_slot = a, b_slot = b_plain, y_slot;
  (* force_downto *) wire [CELLS-1:0] carry;  // out of each cell

  genvar i;
  generate
    for (i = 0; i < CELLS; i = i + 1) begin : cell_
      CCU2C #(
          .INIT0(i == 0 ? {12'b0, CARRY} : SUM),
          .INIT1(SUM),
          .INJECT1_0("NO"),
          .INJECT1_1("NO")
      ) ccu2c_i (
          .CIN(i == 0 ? 1'bx : carry[i == 0 ? 0 : i-1]),
          .A0(a_slot[2*i]), .B0(b_slot[2*i]), .C0(i == 0 ? 1'b1 : BI), .D0(1'b1),
          .A1(a_slot[2*i+1]), .B1(b_slot[2*i+1]), .C1(BI), .D1(1'b1),
          .S0(y_slot[2*i]), .S1(y_slot[2*i+1]),
          .COUT(carry[i])
      );
    end
  endgenerate
  assign Y[0] = a[0] ^ b[0] ^ CI;
  assign Y[Y_WIDTH-1:1] = y_slot[Y_WIDTH-1:1];
  assign X = a ^ b;

  // Carries that logic asks for: out of a cell its own, within one of the sum.
  generate
    for (i = 0; i < Y_WIDTH; i = i + 1) begin : carry_
      if (i % 2 == 1) begin : out
        assign CO[i] = carry[i/2];
      end else if (i == 0) begin : first
        assign CO[i] = CI ? a[0] || b[0] : a[0] && b[0];
      end else begin : within
        assign CO[i] = (a[i] && b[i]) || (carry[i/2-1] && (a[i] || b[i]));
      end
    end
  endgenerate
endmodule
