// For synth_ice40, before its map_ram: sums and comparisons of at most LIMIT bits by gates, not by a carry chain.
//
// A comparison in a chain takes a logic cell a bit and another one where a bit is inverted, and none of these can hold
// anything else; as gates it takes about three cells for four bits. A chain that begins or ends in the fabric takes a cell
// more for each.
(* techmap_celltype = "$alu" *)
module short_alu #(
    parameter A_SIGNED = 0,
    parameter B_SIGNED = 0,
    parameter A_WIDTH = 1,
    parameter B_WIDTH = 1,
    parameter Y_WIDTH = 1
) (
    input  [A_WIDTH-1:0] A,
    input  [B_WIDTH-1:0] B,
    input                CI,
    input                BI,
    output [Y_WIDTH-1:0] X,
    output [Y_WIDTH-1:0] Y,
    output [Y_WIDTH-1:0] CO
);

  wire _TECHMAP_FAIL_ = Y_WIDTH > `LIMIT;
  wire [Y_WIDTH-1:0] a, b;
  wire [Y_WIDTH:0] carry;
  \$pos #(.A_SIGNED(A_SIGNED), .A_WIDTH(A_WIDTH), .Y_WIDTH(Y_WIDTH)) whole_a (.A(A), .Y(a));
  \$pos #(.A_SIGNED(B_SIGNED), .A_WIDTH(B_WIDTH), .Y_WIDTH(Y_WIDTH)) whole_b (.A(B), .Y(b));
  assign carry[0] = CI;
  assign X        = a ^ b ^ {Y_WIDTH{BI}};
  assign Y        = X ^ carry[Y_WIDTH-1:0];
  assign CO       = carry[Y_WIDTH:1];
  genvar i;
  generate
    for (i = 0; i < Y_WIDTH; i = i + 1) begin : bits
      assign carry[i+1] = (a[i] & (b[i] ^ BI)) | (carry[i] & (a[i] | (b[i] ^ BI)));
    end
  endgenerate

endmodule
