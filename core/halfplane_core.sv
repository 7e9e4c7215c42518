// Halfplane on a bus: raster_top with registers, commands from a ring in memory or a stream, AXI4 masters and scan-out.
//
//   s_axil -> core_registers            ring in memory -> command_reader -.
//                                       s_axis ---------------------------+-> command_decoder -> raster_top
//                                                                                                  |     |
//   m_axi <- writes ------------------------------------------------------------- axi_frame_port --'     |
//         <- reads --- axi_arbiter <- scan_out, axi_frame_port, axi_texture_port ------------------------'
//                                  <- command_reader
//
// docs/core.md: registers and commands; docs/integrate.md: how to connect it. The configuration is raster_pkg.
module halfplane_core #(
    parameter bit RING = 1,           // commands come from a ring in memory; 0: from s_axis
    parameter bit SCAN_OUT = 1,       // with scan-out; 0: m_axis_video is silent, and PRESENT is done at once
    parameter bit TEXTURE_MASTER = 0,  // textures have m_axi_texture; 0: they use m_axi
    parameter int WATCHDOG = 24        // error STUCK after 2 to the power of so many cycles without progress; 0: never
) (
    input logic clk_i,
    input logic rst_ni,  // asynchronous, that of the bus

    // Registers
    input  logic [6:0]  s_axil_awaddr,
    input  logic [2:0]  s_axil_awprot,
    input  logic        s_axil_awvalid,
    output logic        s_axil_awready,
    input  logic [31:0] s_axil_wdata,
    input  logic [3:0]  s_axil_wstrb,
    input  logic        s_axil_wvalid,
    output logic        s_axil_wready,
    output logic [1:0]  s_axil_bresp,
    output logic        s_axil_bvalid,
    input  logic        s_axil_bready,
    input  logic [6:0]  s_axil_araddr,
    input  logic [2:0]  s_axil_arprot,
    input  logic        s_axil_arvalid,
    output logic        s_axil_arready,
    output logic [31:0] s_axil_rdata,
    output logic [1:0]  s_axil_rresp,
    output logic        s_axil_rvalid,
    input  logic        s_axil_rready,
    output logic        irq,

    // Commands, with RING = 0
    input  logic [31:0] s_axis_tdata,
    input  logic        s_axis_tvalid,
    output logic        s_axis_tready,

    // Memory: bursts of up to 16 beats, ID 0
    output logic [0:0]                                m_axi_awid,
    output logic [31:0]                               m_axi_awaddr,
    output logic [7:0]                                m_axi_awlen,
    output logic [2:0]                                m_axi_awsize,
    output logic [1:0]                                m_axi_awburst,
    output logic                                      m_axi_awlock,
    output logic [3:0]                                m_axi_awcache,
    output logic [2:0]                                m_axi_awprot,
    output logic                                      m_axi_awvalid,
    input  logic                                      m_axi_awready,
    output logic [raster_pkg::MEMORY_PORT_BITS-1:0]   m_axi_wdata,
    output logic [raster_pkg::MEMORY_PORT_BITS/8-1:0] m_axi_wstrb,
    output logic                                      m_axi_wlast,
    output logic                                      m_axi_wvalid,
    input  logic                                      m_axi_wready,
    input  logic [0:0]                                m_axi_bid,
    input  logic [1:0]                                m_axi_bresp,
    input  logic                                      m_axi_bvalid,
    output logic                                      m_axi_bready,
    output logic [0:0]                                m_axi_arid,
    output logic [31:0]                               m_axi_araddr,
    output logic [7:0]                                m_axi_arlen,
    output logic [2:0]                                m_axi_arsize,
    output logic [1:0]                                m_axi_arburst,
    output logic                                      m_axi_arlock,
    output logic [3:0]                                m_axi_arcache,
    output logic [2:0]                                m_axi_arprot,
    output logic                                      m_axi_arvalid,
    input  logic                                      m_axi_arready,
    input  logic [0:0]                                m_axi_rid,
    input  logic [raster_pkg::MEMORY_PORT_BITS-1:0]   m_axi_rdata,
    input  logic [1:0]                                m_axi_rresp,
    input  logic                                      m_axi_rlast,
    input  logic                                      m_axi_rvalid,
    output logic                                      m_axi_rready,

    // Textures, with TEXTURE_MASTER = 1: likewise, reads alone
    output logic [0:0]                                m_axi_texture_arid,
    output logic [31:0]                               m_axi_texture_araddr,
    output logic [7:0]                                m_axi_texture_arlen,
    output logic [2:0]                                m_axi_texture_arsize,
    output logic [1:0]                                m_axi_texture_arburst,
    output logic                                      m_axi_texture_arlock,
    output logic [3:0]                                m_axi_texture_arcache,
    output logic [2:0]                                m_axi_texture_arprot,
    output logic                                      m_axi_texture_arvalid,
    input  logic                                      m_axi_texture_arready,
    input  logic [0:0]                                m_axi_texture_rid,
    input  logic [raster_pkg::TEXTURE_PORT_BITS-1:0]  m_axi_texture_rdata,
    input  logic [1:0]                                m_axi_texture_rresp,
    input  logic                                      m_axi_texture_rlast,
    input  logic                                      m_axi_texture_rvalid,
    output logic                                      m_axi_texture_rready,

    // Video: red in bits 23...16, green, blue; tuser: the first pixel of a frame, tlast: the last of a line
    output logic [23:0] m_axis_video_tdata,
    output logic        m_axis_video_tvalid,
    input  logic        m_axis_video_tready,
    output logic        m_axis_video_tlast,
    output logic        m_axis_video_tuser
);

  localparam int PORT = raster_pkg::MEMORY_PORT_BITS;
  localparam logic [2:0] SIZE = 3'(raster_pkg::PORT_SHIFT);
  localparam logic [2:0] TEXTURE_SIZE = 3'($clog2(raster_pkg::TEXTURE_PORT_BITS / 8));
  localparam bit HAS_TEXTURE = raster_pkg::COORDINATES != 0;

  // ---------------------------------------------------------------------------------------------------------- resets
  logic rst_n, core_n, raster_n, power_on_n, forgets, restarts, is_restarting, timed_out;
  logic raster_idle, frame_idle, texture_idle, reader_idle;
  reset_sync u_reset_sync (
      .clk_i,
      .rst_ni,
      .rst_no(rst_n)
  );
  reset_order u_reset_order (
      .clk_i,
      .rst_ni     (rst_n),
      .restart_i  (restarts),
      .idle_i     (raster_idle && frame_idle && texture_idle && reader_idle),
      .core_no    (core_n),
      .raster_no  (raster_n),
      .power_on_no(power_on_n),
      .forget_o   (forgets),
      .is_busy_o  (is_restarting),
      .timed_out_o(timed_out)
  );

  // ------------------------------------------------------------------------------------------------------- registers
  logic        starts, stops, is_running, is_written, ring_is_empty, underrun, clears_underrun, scan_enable, scan_error;
  logic [3:0]  error;
  logic [4:0]  irq_enable, irq_pending, counter_index;
  logic        counters_hold, fence_valid, vblank, read_error, write_error, texture_error;
  logic [31:0] fence, fence_q, words, counter, clear_color;
  logic [15:0] flushed_q, vblanks_q, last_x, last_y;
  logic [21:0] ring_base;
  logic [10:0] ring_last;
  logic [19:0] ring_tail, scan_stride;
  logic        flushed, was_running_q, was_empty_q;
  logic        start_q;  // a start that came with a restart or during it, for its end
  logic [3:0]  errors, errors_q;  // of the stream and of memory: each raises the interrupt, also while another one stays
  assign errors = {error != core_pkg::ERROR_NONE, read_error, write_error, texture_error};

  core_registers u_registers (
      .clk_i,
      .rst_ni                      (rst_n),
      .s_axil_awvalid,
      .s_axil_awready,
      .s_axil_awaddr,
      .s_axil_wvalid,
      .s_axil_wready,
      .s_axil_wdata,
      .s_axil_wstrb,
      .s_axil_bvalid,
      .s_axil_bready,
      .s_axil_bresp,
      .s_axil_arvalid,
      .s_axil_arready,
      .s_axil_araddr,
      .s_axil_rvalid,
      .s_axil_rready,
      .s_axil_rdata,
      .s_axil_rresp,
      .config_id_low_value_i       (raster_pkg::CONFIG_ID[31:0]),
      .config_id_high_value_i      (raster_pkg::CONFIG_ID[63:32]),
      .units_lines_i               (raster_pkg::LINES_UNIT != 0),
      .units_counters_i            (raster_pkg::COUNTERS_UNIT != 0),
      .units_blocks_i              (raster_pkg::CACHE_KIND != 0),
      .units_texture_i             (2'(raster_pkg::TEXTURE_UNIT)),
      .units_perspective_colors_i  (raster_pkg::PERSPECTIVE_COLORS != 0),
      .units_alpha_i               (raster_pkg::ALPHA_UNIT != 0),
      .units_blend_i               (raster_pkg::BLEND_LANES != 0),
      .units_dither_i              (raster_pkg::DITHER_UNIT != 0),
      .units_fog_i                 (raster_pkg::FOG_UNIT != 0),
      .units_shade_i               (raster_pkg::SHADE_UNIT != 0),
      .units_stencil_i             (raster_pkg::STENCIL_BITS != 0),
      .units_resolve_i             (raster_pkg::RESOLVE_UNIT != 0),
      .units_compress_i            (raster_pkg::COMPRESS_UNIT != 0),
      .units_samples_i             (4'(raster_pkg::MSAA_SAMPLES)),
      .units_flags_i               (raster_pkg::FRAME_CLEARS != 0),
      .units_color_format_i        (raster_pkg::COLOR_FORMAT != 0),
      .units_scan_out_i            (SCAN_OUT),
      .units_ring_i                (RING),
      .limits_width_i              (16'(raster_pkg::TARGET_WIDTH)),
      .limits_height_i             (16'(raster_pkg::TARGET_HEIGHT)),
      .widths_subpixel_bits_i      (4'(raster_pkg::SUBPIXEL_BITS)),
      .widths_coordinate_bits_i    (5'(raster_pkg::COORDINATE_BITS)),
      .widths_depth_bits_i         (6'(raster_pkg::DEPTH_BITS)),
      .widths_tile_shift_i         (3'(raster_pkg::TILE_SHIFT)),
      .widths_stamp_shift_i        (2'($clog2(raster_pkg::STAMP_SIZE))),
      .widths_port_shift_i         (3'(raster_pkg::PORT_SHIFT)),
      .widths_perspective_bits_i   (6'(raster_pkg::PERSPECTIVE_BITS)),
      .control_start_o             (starts),
      .control_stop_o              (stops),
      .control_restart_o           (restarts),
      .status_running_i            (is_running),
      .status_idle_i               (raster_idle),
      .status_written_i            (is_written),
      .status_restarting_i         (is_restarting),
      .status_timed_out_i          (timed_out),
      .status_ring_empty_i         (ring_is_empty),
      .status_underrun_i           (underrun),
      .status_error_i              (error),
      .status_frame_read_error_i   (read_error),
      .status_frame_write_error_i  (write_error),
      .status_texture_error_i      (texture_error),
      .irq_enable_enable_o         (irq_enable),
      .irq_pending_fence_set_i     (fence_valid),
      .irq_pending_fence_o         (irq_pending[0]),
      .irq_pending_vblank_set_i    (vblank),
      .irq_pending_vblank_o        (irq_pending[1]),
      .irq_pending_error_set_i     ((errors & ~errors_q) != '0 || scan_error),
      .irq_pending_error_o         (irq_pending[2]),
      .irq_pending_stopped_set_i   (was_running_q && !is_running),
      .irq_pending_stopped_o       (irq_pending[3]),
      .irq_pending_ring_empty_set_i(ring_is_empty && !was_empty_q),
      .irq_pending_ring_empty_o    (irq_pending[4]),
      .fence_tag_i                 (fence_q),
      .frames_flushed_i            (flushed_q),
      .frames_vblanks_i            (vblanks_q),
      .words_count_i               (words),
      .ring_base_base_o            (ring_base),
      .ring_size_last_word_o       (ring_last),
      .ring_tail_index_clear_i     (restarts),
      .ring_tail_index_o           (ring_tail),
      .counter_index_index_o       (counter_index),
      .counter_index_hold_o        (counters_hold),
      .counter_data_value_i        (counter),
      .scan_control_enable_o       (scan_enable),
      .scan_control_clear_underrun_o(clears_underrun),
      .scan_size_last_x_o          (last_x),
      .scan_size_last_y_o          (last_y),
      .scan_stride_stride_o        (scan_stride),
      .scan_clear_color_o          (clear_color)
  );
  assign irq = (irq_enable & irq_pending) != '0;

  always_ff @(posedge clk_i or negedge rst_n) begin
    if (!rst_n) begin
      flushed_q     <= '0;
      vblanks_q     <= '0;
      errors_q      <= '0;
      was_running_q <= 1'b0;
      was_empty_q   <= 1'b1;
      start_q       <= 1'b0;
    end else begin
      flushed_q     <= flushed_q + 16'(flushed);
      vblanks_q     <= vblanks_q + 16'(vblank);
      errors_q      <= errors;
      was_running_q <= is_running;
      was_empty_q   <= ring_is_empty;
      start_q       <= (restarts || is_restarting) && (starts || (start_q && !restarts && !stops));
    end
  end
  always_ff @(posedge clk_i or negedge core_n) begin
    if (!core_n) fence_q <= '0;
    else if (fence_valid) fence_q <= fence;
  end

  // -------------------------------------------------------------------------------------------------------- commands
  logic            word_valid, word_ready, word_error, s_rerror;
  logic [31:0]     word;
  logic [3:0]      s_arvalid, s_arready, s_rvalid, s_rready;  // scan-out, frame, texture, ring
  logic [4*32-1:0] s_araddr;
  logic [4*8-1:0]  s_arlen;
  logic [PORT-1:0] s_rdata;
  generate
    if (RING) begin : gen_ring
      command_reader u_reader (
          .clk_i,
          .rst_ni      (rst_n),
          .clear_i     (!core_n),
          .base_i      (ring_base),
          .last_word_i (ring_last),
          .tail_i      (ring_tail),
          .head_i      (words[19:0]),
          .is_empty_o  (ring_is_empty),
          .word_valid_o(word_valid),
          .word_ready_i(word_ready),
          .word_o      (word),
          .word_error_o(word_error),
          .ring_arvalid(s_arvalid[3]),
          .ring_arready(s_arready[3]),
          .ring_araddr (s_araddr[96+:32]),
          .ring_arlen  (s_arlen[24+:8]),
          .ring_rvalid (s_rvalid[3]),
          .ring_rready (s_rready[3]),
          .ring_rdata  (s_rdata),
          .ring_rerror (s_rerror),
          .idle_o      (reader_idle)
      );
      assign s_axis_tready = 1'b0;
    end else begin : gen_stream
      assign word_valid       = s_axis_tvalid && core_n;
      assign word             = s_axis_tdata;
      assign word_error       = 1'b0;
      assign s_axis_tready    = word_ready && core_n;
      assign ring_is_empty    = 1'b1;
      assign reader_idle      = 1'b1;
      assign s_arvalid[3]     = 1'b0;
      assign s_araddr[96+:32] = '0;
      assign s_arlen[24+:8]   = '0;
      assign s_rready[3]      = 1'b1;
    end
  endgenerate

  logic                             primitive_valid, primitive_ready, line_valid, line_ready;
  raster_pkg::primitive_packet_t    packet;
  raster_pkg::line_setup_t          line;
  raster_pkg::memory_layout_t       layout;
  logic [31:12]                     texture_base;
  logic                             present_valid, present_ready;
  logic [31:0]                      present_base, present_flags_base;
  // between raster_top and memory
  logic                             beat_valid, beat_ready, answer_valid, answer_ready;
  command_decoder #(
      .WATCHDOG(WATCHDOG)
  ) u_decoder (
      .clk_i,
      .rst_ni                    (core_n),
      .start_i                   (starts || start_q),
      .stop_i                    (stops),
      .is_running_o              (is_running),
      .is_written_o              (is_written),
      .error_o                   (error),
      .words_o                   (words),
      .word_valid_i              (word_valid),
      .word_ready_o              (word_ready),
      .word_i                    (word),
      .word_error_i              (word_error),
      .is_owed_i                 (!ring_is_empty),
      .primitive_valid_o         (primitive_valid),
      .primitive_ready_i         (primitive_ready),
      .primitive_o               (packet),
      .line_valid_o              (line_valid),
      .line_ready_i              (line_ready),
      .line_o                    (line),
      .layout_o                  (layout),
      .texture_base_o            (texture_base),
      .idle_i                    (raster_idle),
      .flushed_i                 (flushed),
      .moves_i                   ((beat_valid && beat_ready) || (answer_valid && answer_ready)),
      .fence_valid_o             (fence_valid),
      .fence_o                   (fence),
      .present_valid_o           (present_valid),
      .present_ready_i           (present_ready),
      .present_color_base_o      (present_base),
      .present_color_flags_base_o(present_flags_base)
  );

  // -------------------------------------------------------------------------------------------------------- pipeline
  logic                         texture_valid, texture_ready, texel_valid, texel_ready;
  raster_pkg::memory_beat_t     beat;
  raster_pkg::memory_answer_t   answer;
  raster_pkg::texture_request_t texture;
  raster_pkg::texel_beat_t      texel;
  raster_pkg::counter_packet_t  counters;
  raster_top u_raster (
      .clk_i,
      .rst_ni           (raster_n),
      .power_on_ni      (power_on_n),
      .stall_i          ('0),
      .primitive_valid_i(primitive_valid),
      .primitive_ready_o(primitive_ready),
      .primitive_i      (packet),
      .line_valid_i     (line_valid),
      .line_ready_o     (line_ready),
      .line_i           (line),
      .layout_i         (layout),
      .beat_valid_o     (beat_valid),
      .beat_ready_i     (beat_ready),
      .beat_o           (beat),
      .answer_valid_i   (answer_valid),
      .answer_ready_o   (answer_ready),
      .answer_i         (answer),
      .texture_valid_o  (texture_valid),
      .texture_ready_i  (texture_ready),
      .texture_o        (texture),
      .texel_valid_i    (texel_valid),
      .texel_ready_o    (texel_ready),
      .texel_i          (texel),
      .counters_hold_i  (counters_hold),
      .counters_o       (counters),
      .idle_o           (raster_idle),
      .flushed_o        (flushed)
  );

  // The counters, one a word, the last field of the packet first.
  localparam int COUNTER = raster_pkg::COUNTER_BITS;
  localparam int COUNTERS = (raster_pkg::COUNTER_PACKET_BITS + COUNTER - 1) / COUNTER;
  logic [COUNTERS*COUNTER-1:0] counter_bits;
  assign counter_bits = (COUNTERS * COUNTER)'(counters);
  always_comb begin
    counter = '0;
    for (int i = 0; i < COUNTERS; i++)
      counter = counter | (32'(counter_bits[COUNTER*i+:COUNTER]) & {32{counter_index == 5'(i)}});
  end

  // ---------------------------------------------------------------------------------------------------------- memory
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
      .frame_araddr  (s_araddr[32+:32]),
      .frame_arlen   (s_arlen[8+:8]),
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
      .clear_errors_i(restarts),
      .read_error_o  (read_error),
      .write_error_o (write_error),
      .idle_o        (frame_idle)
  );

  generate
    if (HAS_TEXTURE) begin : gen_texture
      logic [31:0] araddr;
      logic [7:0]  arlen;
      logic        arvalid;
      axi_texture_port u_texture (
          .clk_i,
          .rst_ni         (rst_n),
          .forget_i       (forgets),
          .texture_base_i ({texture_base, 12'd0}),
          .texture_valid_i(texture_valid),
          .texture_ready_o(texture_ready),
          .texture_i      (texture),
          .texel_valid_o  (texel_valid),
          .texel_ready_i  (texel_ready),
          .texel_o        (texel),
          .texture_arvalid(arvalid),
          .texture_arready(TEXTURE_MASTER ? m_axi_texture_arready : s_arready[2]),
          .texture_araddr (araddr),
          .texture_arlen  (arlen),
          .texture_rvalid (TEXTURE_MASTER ? m_axi_texture_rvalid : s_rvalid[2]),
          .texture_rready (s_rready[2]),
          .texture_rdata  (TEXTURE_MASTER ? m_axi_texture_rdata : s_rdata),
          .texture_rerror (TEXTURE_MASTER ? m_axi_texture_rresp[1] : s_rerror),
          .clear_errors_i (restarts),
          .read_error_o   (texture_error),
          .idle_o         (texture_idle)
      );
      assign s_arvalid[2]          = arvalid && !TEXTURE_MASTER;
      assign s_araddr[64+:32]      = araddr;
      assign s_arlen[16+:8]        = arlen;
      assign m_axi_texture_arvalid = arvalid && TEXTURE_MASTER;
      assign m_axi_texture_araddr  = araddr;
      assign m_axi_texture_arlen   = arlen;
    end else begin : gen_no_texture
      assign texture_ready         = 1'b0;
      assign texel_valid           = 1'b0;
      assign texel                 = '0;
      assign texture_error         = 1'b0;
      assign texture_idle          = 1'b1;
      assign s_arvalid[2]          = 1'b0;
      assign s_araddr[64+:32]      = '0;
      assign s_arlen[16+:8]        = '0;
      assign s_rready[2]           = 1'b1;
      assign m_axi_texture_arvalid = 1'b0;
      assign m_axi_texture_araddr  = '0;
      assign m_axi_texture_arlen   = '0;
    end
  endgenerate
  assign m_axi_texture_rready  = s_rready[2];
  assign m_axi_texture_arid    = '0;
  assign m_axi_texture_arsize  = TEXTURE_SIZE;
  assign m_axi_texture_arburst = 2'd1;
  assign m_axi_texture_arlock  = 1'b0;
  assign m_axi_texture_arcache = 4'd3;
  assign m_axi_texture_arprot  = 3'd0;

  axi_arbiter #(
      .CLIENTS  (4),
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
  assign m_axi_awid    = '0;
  assign m_axi_awsize  = SIZE;
  assign m_axi_awburst = 2'd1;
  assign m_axi_awlock  = 1'b0;
  assign m_axi_awcache = 4'd3;
  assign m_axi_awprot  = 3'd0;
  assign m_axi_arid    = '0;
  assign m_axi_arsize  = SIZE;
  assign m_axi_arburst = 2'd1;
  assign m_axi_arlock  = 1'b0;
  assign m_axi_arcache = 4'd3;
  assign m_axi_arprot  = 3'd0;

  // -------------------------------------------------------------------------------------------------------- scan-out
  generate
    if (SCAN_OUT) begin : gen_scan_out
      // A frame that is in memory is the next shown frame at once; scan-out samples it at the next vertical blank.
      logic [31:0] base_q, flags_base_q;
      logic        waits_q, is_off;
      assign present_ready = waits_q && (vblank || is_off);
      always_ff @(posedge clk_i or negedge rst_n) begin
        if (!rst_n) waits_q <= 1'b0;
        else waits_q <= present_valid && !present_ready;
      end
      always_ff @(posedge clk_i) begin
        if (present_valid && !waits_q) begin
          base_q       <= present_base;
          flags_base_q <= present_flags_base;
        end
      end
      scan_out u_scan_out (
          .clk_i,
          .rst_ni            (rst_n),
          .enable_i          (scan_enable),
          .color_base_i      (base_q),
          .color_flags_base_i(flags_base_q),
          .row_stride_i      (32'(scan_stride)),
          .clear_color_i     (clear_color[raster_pkg::STORED_COLOR_BITS-1:0]),
          .last_x_i          (last_x[raster_pkg::PIXEL_X_BITS-1:0]),
          .last_y_i          (last_y[raster_pkg::PIXEL_Y_BITS-1:0]),
          .vblank_o          (vblank),
          .idle_o            (is_off),
          .underrun_o        (underrun),
          .error_o           (scan_error),
          .clear_underrun_i  (clears_underrun),
          .scan_arvalid      (s_arvalid[0]),
          .scan_arready      (s_arready[0]),
          .scan_araddr       (s_araddr[0+:32]),
          .scan_arlen        (s_arlen[0+:8]),
          .scan_rvalid       (s_rvalid[0]),
          .scan_rready       (s_rready[0]),
          .scan_rdata        (s_rdata),
          .scan_rerror       (s_rerror),
          .m_axis_video_tvalid,
          .m_axis_video_tready,
          .m_axis_video_tdata,
          .m_axis_video_tlast,
          .m_axis_video_tuser
      );
    end else begin : gen_no_scan_out
      assign present_ready       = 1'b1;
      assign vblank              = 1'b0;
      assign underrun            = 1'b0;
      assign scan_error          = 1'b0;
      assign s_arvalid[0]        = 1'b0;
      assign s_araddr[0+:32]     = '0;
      assign s_arlen[0+:8]       = '0;
      assign s_rready[0]         = 1'b1;
      assign m_axis_video_tvalid = 1'b0;
      assign m_axis_video_tdata  = '0;
      assign m_axis_video_tlast  = 1'b0;
      assign m_axis_video_tuser  = 1'b0;
    end
  endgenerate

endmodule
