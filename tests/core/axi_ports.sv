// The ports to memory as halfplane_core connects them, with flat signals for cocotb. Client 0 of the arbiter is the
// test's own, as scan-out would be; client 1 the frame port, client 2 the texture port.
module axi_ports #(
    parameter int PORT = raster_pkg::MEMORY_PORT_BITS
) (
    input  logic        clk_i,
    input  logic        rst_ni,
    output logic [31:0] buffer_bytes_o,  // of the configuration: the largest aligned array that a burst stays in
    output logic [31:0] read_beats_o,    // beats of a read

    input  logic forget_i,
    input  logic clear_errors_i,
    output logic frame_idle_o,
    output logic texture_idle_o,
    output logic arbiter_idle_o,
    output logic read_error_o,
    output logic write_error_o,
    output logic texture_error_o,

    input  logic                                     beat_valid,
    output logic                                     beat_ready,
    input  logic                                     beat_is_write,
    input  logic                                     beat_is_first,
    input  logic [31:0]                              beat_address,
    input  logic [raster_pkg::BURST_LENGTH_BITS-1:0] beat_length,
    input  logic [PORT/8-1:0]                        beat_strobe,
    input  logic [PORT-1:0]                          beat_data,
    output logic                                     answer_valid,
    input  logic                                     answer_ready,
    output logic                                     answer_is_write,
    output logic [PORT-1:0]                          answer_data,

    input  logic [31:0]     texture_base,
    input  logic            texture_valid,
    output logic            texture_ready,
    input  logic [31:0]     texture_address,
    input  logic [5:0]      texture_beats,
    output logic            texel_valid,
    input  logic            texel_ready,
    output logic [PORT-1:0] texel_data,

    input  logic            scan_arvalid,
    output logic            scan_arready,
    input  logic [31:0]     scan_araddr,
    input  logic [7:0]      scan_arlen,
    output logic            scan_rvalid,
    output logic [PORT-1:0] scan_rdata,
    output logic            scan_rlast,

    output logic              m_axi_awid,
    output logic              m_axi_awvalid,
    input  logic              m_axi_awready,
    output logic [31:0]       m_axi_awaddr,
    output logic [7:0]        m_axi_awlen,
    output logic [2:0]        m_axi_awsize,
    output logic [1:0]        m_axi_awburst,
    output logic              m_axi_wvalid,
    input  logic              m_axi_wready,
    output logic [PORT-1:0]   m_axi_wdata,
    output logic [PORT/8-1:0] m_axi_wstrb,
    output logic              m_axi_wlast,
    input  logic              m_axi_bid,
    input  logic              m_axi_bvalid,
    output logic              m_axi_bready,
    input  logic [1:0]        m_axi_bresp,
    output logic              m_axi_arid,
    output logic              m_axi_arvalid,
    input  logic              m_axi_arready,
    output logic [31:0]       m_axi_araddr,
    output logic [7:0]        m_axi_arlen,
    output logic [2:0]        m_axi_arsize,
    output logic [1:0]        m_axi_arburst,
    input  logic              m_axi_rid,
    input  logic              m_axi_rvalid,
    output logic              m_axi_rready,
    input  logic [PORT-1:0]   m_axi_rdata,
    input  logic              m_axi_rlast,
    input  logic [1:0]        m_axi_rresp
);

  assign m_axi_awid    = 1'b0;
  assign m_axi_awsize  = 3'(raster_pkg::PORT_SHIFT);
  assign m_axi_awburst = 2'd1;
  assign m_axi_arid    = 1'b0;
  assign m_axi_arsize  = 3'(raster_pkg::PORT_SHIFT);
  assign m_axi_arburst = 2'd1;

  localparam bit HAS_BLOCKS = raster_pkg::CACHE_KIND != 0;
  localparam int STAMP = raster_pkg::SAMPLES * raster_pkg::DEPTH_SAMPLE_BYTES;
  localparam int READ = HAS_BLOCKS ? STAMP : 1 << raster_pkg::PLANE_SHIFT;
  assign buffer_bytes_o = (raster_pkg::PLANE_SHIFT > raster_pkg::FLAG_ROW_SHIFT) ? 1 << raster_pkg::PLANE_SHIFT :
                                                                                  1 << raster_pkg::FLAG_ROW_SHIFT;
  assign read_beats_o   = (READ > PORT / 8) ? READ / (PORT / 8) : 1;

  raster_pkg::memory_beat_t     beat;
  raster_pkg::memory_answer_t   answer;
  raster_pkg::texture_request_t texture;
  raster_pkg::texel_beat_t      texel;
  assign beat.is_write   = beat_is_write;
  assign beat.is_first   = beat_is_first;
  assign beat.address    = beat_address;
  assign beat.length     = beat_length;
  assign beat.strobe     = beat_strobe;
  assign beat.data       = beat_data;
  assign answer_is_write = answer.is_write;
  assign answer_data     = answer.data;
  assign texture.address = texture_address;
  assign texture.beats   = texture_beats;
  assign texel_data      = texel.data;

  logic            frame_arvalid, frame_arready, frame_rvalid, frame_rready, rlast, rerror;
  logic            texture_arvalid, texture_arready, texture_rvalid, texture_rready;
  logic [31:0]     frame_araddr, texture_araddr;
  logic [7:0]      frame_arlen, texture_arlen;
  logic [PORT-1:0] rdata;

  axi_frame_port u_frame (
      .clk_i,
      .rst_ni,
      .forget_i,
      .beat_valid_i  (beat_valid),
      .beat_ready_o  (beat_ready),
      .beat_i        (beat),
      .answer_valid_o(answer_valid),
      .answer_ready_i(answer_ready),
      .answer_o      (answer),
      .frame_arvalid,
      .frame_arready,
      .frame_araddr,
      .frame_arlen,
      .frame_rvalid,
      .frame_rready,
      .frame_rdata   (rdata),
      .frame_rerror  (rerror),
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
      .clear_errors_i,
      .read_error_o,
      .write_error_o,
      .idle_o        (frame_idle_o)
  );
  axi_texture_port u_texture (
      .clk_i,
      .rst_ni,
      .forget_i,
      .texture_base_i (texture_base),
      .texture_valid_i(texture_valid),
      .texture_ready_o(texture_ready),
      .texture_i      (texture),
      .texel_valid_o  (texel_valid),
      .texel_ready_i  (texel_ready),
      .texel_o        (texel),
      .texture_arvalid,
      .texture_arready,
      .texture_araddr,
      .texture_arlen,
      .texture_rvalid,
      .texture_rready,
      .texture_rdata  (rdata),
      .texture_rerror (rerror),
      .clear_errors_i,
      .read_error_o   (texture_error_o),
      .idle_o         (texture_idle_o)
  );
  axi_arbiter #(
      .CLIENTS  (3),
      .PORT_BITS(PORT)
  ) u_arbiter (
      .clk_i,
      .rst_ni,
      .s_arvalid({texture_arvalid, frame_arvalid, scan_arvalid}),
      .s_arready({texture_arready, frame_arready, scan_arready}),
      .s_araddr ({texture_araddr, frame_araddr, scan_araddr}),
      .s_arlen  ({texture_arlen, frame_arlen, scan_arlen}),
      .s_rvalid ({texture_rvalid, frame_rvalid, scan_rvalid}),
      .s_rready ({texture_rready, frame_rready, 1'b1}),
      .s_rdata  (rdata),
      .s_rlast  (rlast),
      .s_rerror (rerror),
      .m_axi_arvalid,
      .m_axi_arready,
      .m_axi_araddr,
      .m_axi_arlen,
      .m_axi_rvalid,
      .m_axi_rready,
      .m_axi_rdata,
      .m_axi_rlast,
      .m_axi_rresp,
      .idle_o   (arbiter_idle_o)
  );
  assign scan_rdata = rdata;
  assign scan_rlast = rlast;

  axi_protocol_checker #(.PORT_BITS(PORT)) u_checker (.*);

endmodule
