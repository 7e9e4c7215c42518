// An asynchronous reset for one clock: it begins at once and ends two cycles after rst_ni, at an edge of the clock.
module reset_sync (
    input  logic clk_i,
    input  logic rst_ni,  // at any time
    output logic rst_no
);

  // Held as rst, not as its inverse: a part whose flip-flops have an active-high reset needs no inverter, of which Yosys 0.23
  // otherwise makes one a flip-flop (docs/core.md).
  logic rst_q, meta_q;
  assign rst_no = !rst_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) {rst_q, meta_q} <= 2'b11;
    else {rst_q, meta_q} <= {meta_q, 1'b0};
  end

endmodule
