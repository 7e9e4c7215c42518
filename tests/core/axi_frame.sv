// raster_top and its ports to memory, driven with packets: the cost of the bus alone, without commands.
module axi_frame #(
    parameter int PORT = raster_pkg::MEMORY_PORT_BITS
) (
    input  logic clk_i,
    input  logic rst_ni,
    input  logic restart_i,
    output logic is_busy_o,
    output logic timed_out_o,
    output logic idle_o,
    output logic has_error_o,

    input  logic                                       packet_valid,
    output logic                                       packet_ready,
    input  logic [raster_pkg::PRIMITIVE_PACKET_BITS-1:0] packet,
    input  logic [31:0]                                depth_base,
    input  logic [31:0]                                color_base,
    input  logic [31:0]                                depth_flags_base,
    input  logic [31:0]                                color_flags_base,
    input  logic [31:0]                                row_stride,

    // Signals of raster_top's own port, for checks
    output logic        beat_moves_o,
    output logic        beat_is_write_o,
    output logic [31:0] beat_address_o,

    output logic              m_axi_awvalid,
    input  logic              m_axi_awready,
    output logic [31:0]       m_axi_awaddr,
    output logic [7:0]        m_axi_awlen,
    output logic              m_axi_wvalid,
    input  logic              m_axi_wready,
    output logic [PORT-1:0]   m_axi_wdata,
    output logic [PORT/8-1:0] m_axi_wstrb,
    output logic              m_axi_wlast,
    input  logic              m_axi_bvalid,
    output logic              m_axi_bready,
    input  logic [1:0]        m_axi_bresp,
    output logic              m_axi_arvalid,
    input  logic              m_axi_arready,
    output logic [31:0]       m_axi_araddr,
    output logic [7:0]        m_axi_arlen,
    input  logic              m_axi_rvalid,
    output logic              m_axi_rready,
    input  logic [PORT-1:0]   m_axi_rdata,
    input  logic              m_axi_rlast,
    input  logic [1:0]        m_axi_rresp
);

  logic                         rst_n, core_n, raster_n, power_on_n, forgets, raster_idle, frame_idle, ready;
  logic                         beat_valid, beat_ready, answer_valid, answer_ready, read_error, write_error;
  raster_pkg::primitive_packet_t unpacked;
  raster_pkg::memory_layout_t   layout;
  raster_pkg::memory_beat_t     beat;
  raster_pkg::memory_answer_t   answer;
  assign unpacked                = packet;
  assign layout.depth_base       = depth_base;
  assign layout.color_base       = color_base;
  assign layout.depth_flags_base = depth_flags_base;
  assign layout.color_flags_base = color_flags_base;
  assign layout.row_stride       = raster_pkg::ROW_STRIDE_BITS'(row_stride);
  assign beat_moves_o            = beat_valid && beat_ready;
  assign beat_is_write_o         = beat.is_write;
  assign beat_address_o          = beat.address;
  assign idle_o                  = raster_idle && frame_idle;
  assign has_error_o             = read_error || write_error;
  assign packet_ready            = ready && core_n;

  reset_sync u_reset_sync (
      .clk_i,
      .rst_ni,
      .rst_no(rst_n)
  );
  reset_order #(
      .PATIENCE(10)
  ) u_reset_order (
      .clk_i,
      .rst_ni     (rst_n),
      .restart_i,
      .idle_i     (idle_o),
      .core_no    (core_n),
      .raster_no  (raster_n),
      .power_on_no(power_on_n),
      .forget_o   (forgets),
      .is_busy_o,
      .timed_out_o
  );
  raster_top u_raster (
      .clk_i,
      .rst_ni           (raster_n),
      .power_on_ni      (power_on_n),
      .stall_i          ('0),
      .primitive_valid_i(packet_valid && core_n),
      .primitive_ready_o(ready),
      .primitive_i      (unpacked),
      .line_valid_i     (1'b0),
      .line_ready_o     (),
      .line_i           ('0),
      .layout_i         (layout),
      .beat_valid_o     (beat_valid),
      .beat_ready_i     (beat_ready),
      .beat_o           (beat),
      .answer_valid_i   (answer_valid),
      .answer_ready_o   (answer_ready),
      .answer_i         (answer),
      .texture_valid_o  (),
      .texture_ready_i  (1'b0),
      .texture_o        (),
      .texel_valid_i    (1'b0),
      .texel_ready_o    (),
      .texel_i          ('0),
      .counters_hold_i  (1'b0),
      .counters_o       (),
      .idle_o           (raster_idle),
      .flushed_o        ()
  );

  logic [1:0]      s_arvalid, s_arready, s_rvalid, s_rready;  // no master, frame
  logic [63:0]     s_araddr;
  logic [15:0]     s_arlen;
  logic [PORT-1:0] s_rdata;
  logic            s_rerror;
  assign s_arvalid[0]   = 1'b0;
  assign s_araddr[31:0] = '0;
  assign s_arlen[7:0]   = '0;
  assign s_rready[0]    = 1'b1;
  axi_frame_port u_frame (
      .clk_i,
      .rst_ni        (rst_n),
      .forget_i      (forgets),
      .beat_valid_i  (beat_valid),
      .beat_ready_o  (beat_ready),
      .beat_i        (beat),
      .answer_valid_o(answer_valid),
      .answer_ready_i(answer_ready),
      .answer_o      (answer),
      .frame_arvalid (s_arvalid[1]),
      .frame_arready (s_arready[1]),
      .frame_araddr  (s_araddr[63:32]),
      .frame_arlen   (s_arlen[15:8]),
      .frame_rvalid  (s_rvalid[1]),
      .frame_rready  (s_rready[1]),
      .frame_rdata   (s_rdata),
      .frame_rerror  (s_rerror),
      .m_axi_awvalid,
      .m_axi_awready,
      .m_axi_awaddr,
      .m_axi_awlen,
      .m_axi_wvalid,
      .m_axi_wready,
      .m_axi_wdata,
      .m_axi_wstrb,
      .m_axi_wlast,
      .m_axi_bvalid,
      .m_axi_bready,
      .m_axi_bresp,
      .clear_errors_i(1'b0),
      .read_error_o  (read_error),
      .write_error_o (write_error),
      .idle_o        (frame_idle)
  );
  axi_arbiter #(
      .CLIENTS  (2),
      .PORT_BITS(PORT)
  ) u_arbiter (
      .clk_i,
      .rst_ni(rst_n),
      .s_arvalid,
      .s_arready,
      .s_araddr,
      .s_arlen,
      .s_rvalid,
      .s_rready,
      .s_rdata,
      .s_rlast(),
      .s_rerror,
      .m_axi_arvalid,
      .m_axi_arready,
      .m_axi_araddr,
      .m_axi_arlen,
      .m_axi_rvalid,
      .m_axi_rready,
      .m_axi_rdata,
      .m_axi_rlast,
      .m_axi_rresp,
      .idle_o()
  );

  localparam logic [2:0] SIZE = 3'(raster_pkg::PORT_SHIFT);
  axi_protocol_checker #(
      .PORT_BITS(PORT)
  ) u_checker (
      .rst_ni       (rst_n),
      .m_axi_awsize (SIZE),
      .m_axi_awburst(2'd1),
      .m_axi_arsize (SIZE),
      .m_axi_arburst(2'd1),
      .*
  );

endmodule
