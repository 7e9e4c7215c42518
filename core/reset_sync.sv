// An asynchronous reset for one clock: it begins at once and ends two cycles after rst_ni, at an edge of the clock.
module reset_sync (
    input  logic clk_i,
    input  logic rst_ni,  // at any time
    output logic rst_no
);

  logic meta_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) {rst_no, meta_q} <= 2'b00;
    else {rst_no, meta_q} <= {meta_q, 1'b1};
  end

endmodule
