// a + b, or a - b, in one carry chain: the chain itself inverts b.
//
// Yosys makes of a choice between a sum and a difference a chain and a gate a bit in front of it; its cell for both, `$alu`,
// can do without those gates; only a script that says so gets that cell.
module add_or_subtract #(
    parameter int WIDTH = 1  // bits of a, b and the result, which wraps
) (
    input  logic             subtracts_i,
    input  logic [WIDTH-1:0] a_i,
    input  logic [WIDTH-1:0] b_i,
    output logic [WIDTH-1:0] sum_o  // modulo 2^WIDTH
);

`ifdef YOSYS_ALU  // read_verilog -icells -DYOSYS_ALU
  wire [WIDTH-1:0] differs, carry;  // unused outputs of the cell
  \$alu #(
      .A_SIGNED(0),
      .B_SIGNED(0),
      .A_WIDTH (WIDTH),
      .B_WIDTH (WIDTH),
      .Y_WIDTH (WIDTH)
  ) u_alu (
      .A (a_i),
      .B (b_i),
      .BI(subtracts_i),
      .CI(subtracts_i),
      .X (differs),
      .Y (sum_o),
      .CO(carry)
  );
`else
  logic [WIDTH:0] sum;
  assign sum   = {a_i, subtracts_i} + {b_i ^ {WIDTH{subtracts_i}}, subtracts_i};
  assign sum_o = sum[WIDTH:1];
`endif

endmodule
