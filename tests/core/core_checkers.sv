// Every checker that halfplane_core has, bound as docs/core.md says. Tests send wrong words: these are not failures.
// s_axis has no checker: the core drives tready alone there, and tests withdraw a word after an error.
bind command_decoder command_stream_checker #(.CHECKS_ERRORS(0)) u_command_stream_checker (.*);
bind raster_top primitive_stream_checker u_primitive_stream_checker (.*);
bind halfplane_core axi_protocol_checker #(.PORT_BITS(raster_pkg::MEMORY_PORT_BITS)) u_axi_protocol_checker (.*);
bind halfplane_core axi_lite_protocol_checker u_axi_lite_protocol_checker (.*);
bind halfplane_core axi_stream_protocol_checker #(
    .NAME("m_axis_video"),
    .BITS(26),
    .LINES(1)
) u_video_checker (
    .clk_i,
    .rst_ni,
    .valid(m_axis_video_tvalid),
    .ready(m_axis_video_tready),
    .data ({m_axis_video_tuser, m_axis_video_tlast, m_axis_video_tdata})
);
bind halfplane_core axi_protocol_checker #(
    .PORT_BITS(raster_pkg::TEXTURE_PORT_BITS)
) u_texture_checker (
    .clk_i,
    .rst_ni,
    .m_axi_awvalid(1'b0),
    .m_axi_awready(1'b0),
    .m_axi_awaddr (32'd0),
    .m_axi_awlen  (8'd0),
    .m_axi_awsize (3'd0),
    .m_axi_awburst(2'd0),
    .m_axi_wvalid (1'b0),
    .m_axi_wready (1'b0),
    .m_axi_wdata  ('0),
    .m_axi_wstrb  ('0),
    .m_axi_wlast  (1'b0),
    .m_axi_bvalid (1'b0),
    .m_axi_bready (1'b0),
    .m_axi_bresp  (2'd0),
    .m_axi_arvalid(m_axi_texture_arvalid),
    .m_axi_arready(m_axi_texture_arready),
    .m_axi_araddr (m_axi_texture_araddr),
    .m_axi_arlen  (m_axi_texture_arlen),
    .m_axi_arsize (m_axi_texture_arsize),
    .m_axi_arburst(m_axi_texture_arburst),
    .m_axi_rvalid (m_axi_texture_rvalid),
    .m_axi_rready (m_axi_texture_rready),
    .m_axi_rdata  (m_axi_texture_rdata),
    .m_axi_rlast  (m_axi_texture_rlast),
    .m_axi_rresp  (m_axi_texture_rresp)
);
