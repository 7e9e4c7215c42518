// Checks both sides of an AXI4-Lite port. Simulation only:
//
//   bind halfplane_core axi_lite_protocol_checker u_axi_lite_protocol_checker (.*);
//
// A broken rule is an assertion that fails, with a message.
module axi_lite_protocol_checker #(
    parameter int ADDRESS_BITS = 7
) (
    input logic                    clk_i,
    input logic                    rst_ni,
    input logic                    s_axil_awvalid,
    input logic                    s_axil_awready,
    input logic [ADDRESS_BITS-1:0] s_axil_awaddr,
    input logic                    s_axil_wvalid,
    input logic                    s_axil_wready,
    input logic [31:0]             s_axil_wdata,
    input logic [3:0]              s_axil_wstrb,
    input logic                    s_axil_bvalid,
    input logic                    s_axil_bready,
    input logic [1:0]              s_axil_bresp,
    input logic                    s_axil_arvalid,
    input logic                    s_axil_arready,
    input logic [ADDRESS_BITS-1:0] s_axil_araddr,
    input logic                    s_axil_rvalid,
    input logic                    s_axil_rready,
    input logic [31:0]             s_axil_rdata,
    input logic [1:0]              s_axil_rresp
);

  /* verilator coverage_off */  // of the design alone
  // Requests without their response.
  int unsigned addresses, data, reads;

  always @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      addresses = 0;
      data      = 0;
      reads     = 0;
    end else begin
      assert (!s_axil_bvalid || (addresses > 0 && data > 0))
      else $error("axi-lite: B without a write that waits for it");
      assert (!s_axil_rvalid || reads > 0)
      else $error("axi-lite: R without a read that waits for it");
      if (s_axil_bvalid && s_axil_bready) begin
        addresses = addresses - 1;
        data      = data - 1;
      end
      if (s_axil_rvalid && s_axil_rready) reads = reads - 1;
      if (s_axil_awvalid && s_axil_awready) addresses = addresses + 1;
      if (s_axil_wvalid && s_axil_wready) data = data + 1;
      if (s_axil_arvalid && s_axil_arready) reads = reads + 1;
    end
  end

  axi_stream_protocol_checker #(
      .NAME("axi-lite: AW"),
      .BITS(ADDRESS_BITS)
  ) u_aw (
      .clk_i,
      .rst_ni,
      .valid(s_axil_awvalid),
      .ready(s_axil_awready),
      .data (s_axil_awaddr)
  );
  axi_stream_protocol_checker #(
      .NAME("axi-lite: W"),
      .BITS(36)
  ) u_w (
      .clk_i,
      .rst_ni,
      .valid(s_axil_wvalid),
      .ready(s_axil_wready),
      .data ({s_axil_wstrb, s_axil_wdata})
  );
  axi_stream_protocol_checker #(
      .NAME("axi-lite: B"),
      .BITS(2)
  ) u_b (
      .clk_i,
      .rst_ni,
      .valid(s_axil_bvalid),
      .ready(s_axil_bready),
      .data (s_axil_bresp)
  );
  axi_stream_protocol_checker #(
      .NAME("axi-lite: AR"),
      .BITS(ADDRESS_BITS)
  ) u_ar (
      .clk_i,
      .rst_ni,
      .valid(s_axil_arvalid),
      .ready(s_axil_arready),
      .data (s_axil_araddr)
  );
  axi_stream_protocol_checker #(
      .NAME("axi-lite: R"),
      .BITS(34)
  ) u_r (
      .clk_i,
      .rst_ni,
      .valid(s_axil_rvalid),
      .ready(s_axil_rready),
      .data ({s_axil_rresp, s_axil_rdata})
  );

endmodule
