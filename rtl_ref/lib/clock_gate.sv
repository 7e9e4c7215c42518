// Clock gate: passes the edges of the clock at which a stage has something to do.
//
// `enable_i` settles before the edge; the latch holds it while the clock is high. A stage enables its clock when one of
// its registers would change in a way that matters, so that the design is the same with gates and without. In reset
// the clock passes: a reset that begins low has no edge of its own.
// With CLOCK_GATES defined the gates are there: Verilator leaves out what depends on registers that had no edge. Without,
// as in an FPGA, the clock is a wire, and the condition has no reader.
module clock_gate (
    input  logic clk_i,
    input  logic reset_i,
    input  logic enable_i,
    output logic clk_o
);

`ifdef CLOCK_GATES
  logic enables_q;
  always_latch if (!clk_i) enables_q = enable_i || reset_i;
  assign clk_o = clk_i && enables_q;
`else
  assign clk_o = clk_i;
`endif

endmodule
