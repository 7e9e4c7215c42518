// Checks both sides of a Wishbone port with classic cycles. Simulation only; names are those of the bus. A broken rule is an
// assertion that fails, with a message: a request stays as it is until ack or err, which answer a request alone.
module wishbone_protocol_checker (
    input logic        clk_i,
    input logic        rst_ni,
    input logic [29:0] adr,
    input logic [31:0] dat_w,
    input logic [3:0]  sel,
    input logic        cyc,
    input logic        stb,
    input logic        we,
    input logic        ack,
    input logic        err
);

  /* verilator coverage_off */  // of the design alone
  logic        waits_q;
  logic [66:0] request_q;
  logic [66:0] request;
  assign request = {we, sel, adr, we ? dat_w : 32'd0};

  always @(posedge clk_i) begin
    waits_q   <= rst_ni && cyc && stb && !ack && !err;
    request_q <= request;
    if (rst_ni) begin
      assert (!waits_q || (cyc && stb && request == request_q))
      else $error("wishbone: a request was taken back or changed before ack");
      assert (cyc || !stb)
      else $error("wishbone: stb without cyc");
      assert (!(ack || err) || (cyc && stb))
      else $error("wishbone: ack or err without a request");
    end
  end

endmodule
