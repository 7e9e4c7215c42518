// Enables for registers and logic that are read only while something moves.
//
// With CLOCK_GATES defined (clock_gate.sv) an enable is passed on, and Verilator skips what it guards, at the cost of a
// branch: a clock would cost 200 instructions a cycle. Without, as in an FPGA, the registers load in every cycle.
module register_gate #(
    parameter int WIDTH = 1
) (
    input  logic [WIDTH-1:0] enable_i,
    output logic [WIDTH-1:0] enable_o
);

`ifdef CLOCK_GATES
  assign enable_o = enable_i;
`else
  assign enable_o = '1;
`endif

endmodule
