
  // Reset in the first cycle, never again.
  logic runs_q = 1'b0;
  always_ff @(posedge clk_i) runs_q <= 1'b1;
  always_comb assume (rst_ni == runs_q);
