// The co-simulation top: raster_top, and a tap on every arrow inside it. Simulation only; adds no logic to the design.
//
// The list of arrows, their bits and the wiring of the taps are generated from model/pipeline_graph.hpp: taps.svh.
//
// Every input is registered: the design sees the value at a clock edge in the cycle that begins with it. So
// no logic hangs on a port, and Verilator settles the design once a cycle, at the edge.
`include "cosim/taps.svh"
bind raster_top primitive_stream_checker u_primitive_stream_checker (.*);

module raster_cosim (
    input logic clk_i,
    input logic rst_ni,
    input logic power_on_ni,

    input logic [raster_pkg::STALL_BITS-1:0] stall_i,  // bit raster_pkg::STALL_X: arrow X moves nothing in this cycle
    input logic [15:0] mutant_i,  // which mutation is active, 0: none; mutated sources read raster_cosim.mutant_q

    // From the host
    input  logic                          primitive_valid_i,
    output logic                          primitive_ready_o,
    input  raster_pkg::primitive_packet_t primitive_i,

    input  logic                    line_valid_i,
    output logic                    line_ready_o,
    input  raster_pkg::line_setup_t line_i,

    // To and from the memory
    input  raster_pkg::memory_layout_t layout_i,
    output logic                       beat_valid_o,
    input  logic                       beat_ready_i,
    output raster_pkg::memory_beat_t   beat_o,
    input  logic                       answer_valid_i,
    output logic                       answer_ready_o,
    input  raster_pkg::memory_answer_t answer_i,
    output logic                         texture_valid_o,
    input  logic                         texture_ready_i,
    output raster_pkg::texture_request_t texture_o,
    input  logic                         texel_valid_i,
    output logic                         texel_ready_o,
    input  raster_pkg::texel_beat_t      texel_i,

    input  logic                        counters_hold_i,
    output raster_pkg::counter_packet_t counters_o,
    output logic                        idle_o,
    output logic                        moves_tiles_o,  // the framebuffer waits for memory or a clear
    output logic [63:0]                 config_id_o,

    // The taps
    `RASTER_TAP_PORTS
);

  logic [raster_pkg::STALL_BITS-1:0] stall_q;
  logic [15:0]                   mutant_q;
  logic                          reset_nq;
  logic                          primitive_valid_q, line_valid_q, beat_ready_q, answer_valid_q, counters_hold_q;
  logic                          texture_ready_q, texel_valid_q;
  raster_pkg::texel_beat_t       texel_q;
  raster_pkg::primitive_packet_t primitive_q;
  raster_pkg::line_setup_t       line_q;
  raster_pkg::memory_answer_t    answer_q;
  raster_pkg::memory_layout_t    layout_q;

  always_ff @(posedge clk_i) begin
    stall_q           <= stall_i;
    reset_nq          <= rst_ni;
    primitive_valid_q <= primitive_valid_i;
    primitive_q       <= primitive_i;
    line_valid_q      <= line_valid_i;
    line_q            <= line_i;
    layout_q          <= layout_i;
    beat_ready_q      <= beat_ready_i;
    answer_valid_q    <= answer_valid_i;
    answer_q          <= answer_i;
    texture_ready_q   <= texture_ready_i;
    texel_valid_q     <= texel_valid_i;
    texel_q           <= texel_i;
    counters_hold_q   <= counters_hold_i;
  end

  // A fault stays for good: a mutated expression is evaluated no more often than as written.
  always_ff @(negedge power_on_ni) mutant_q <= mutant_i;

  raster_top u_raster (
      .clk_i,
      .rst_ni(reset_nq),
      .power_on_ni,
      .stall_i(stall_q),
      .primitive_valid_i(primitive_valid_q),
      .primitive_ready_o,
      .primitive_i(primitive_q),
      .line_valid_i(line_valid_q),
      .line_ready_o,
      .line_i(line_q),
      .layout_i(layout_q),
      .beat_valid_o,
      .beat_ready_i(beat_ready_q),
      .beat_o,
      .answer_valid_i(answer_valid_q),
      .answer_ready_o,
      .answer_i(answer_q),
      .texture_valid_o,
      .texture_ready_i(texture_ready_q),
      .texture_o,
      .texel_valid_i(texel_valid_q),
      .texel_ready_o,
      .texel_i(texel_q),
      .counters_hold_i(counters_hold_q),
      .counters_o,
      .idle_o,
      .flushed_o()
  );

  assign moves_tiles_o = u_raster.moves_tiles;

  logic unused_mutant;
  assign unused_mutant = ^mutant_q;

  assign config_id_o = raster_pkg::CONFIG_ID;

  // Whole packets of the specification for arrows that raster_top carries in parts. A fragment whose triangle constants
  // are stored separately gets the constants of its triangle number; a line's fragment has no planes beyond the colours.
  raster_pkg::fragment_packet_t fragment_data;
  raster_pkg::write_packet_t    write_data;
  raster_pkg::memory_request_t  request_data;
  generate
    if (raster_pkg::STORE_CONSTANTS_SEPARATELY != 0) begin : gen_separate
      localparam int NUMBER = raster_pkg::TRIANGLE_BITS;
      localparam int CODES = raster_pkg::ALL_FRAGMENT_BITS;
      localparam int AFFINE = raster_pkg::ALL_AFFINE_CODE_BITS;
      raster_pkg::context_packet_t  contexts_q[0:(1<<NUMBER)-1];
      raster_pkg::fragment_packet_t whole;
      always_ff @(posedge clk_i)
        if (u_raster.setup_valid && u_raster.setup_ready) contexts_q[u_raster.triangle_number] <= u_raster.context_data;
      whole_fragment u_whole (
          .fragment_i(u_raster.fragment_data),
          .context_i (contexts_q[NUMBER'(u_raster.fragment_data.coordinates)]),
          .fragment_o(whole)
      );
      always_comb begin
        fragment_data = whole;
        for (int i = 0; i < raster_pkg::PIXELS; i++)
          if (whole.kind == raster_pkg::PRIMITIVE_KIND_LINE) fragment_data.code[i*CODES+AFFINE+:CODES-AFFINE] = '0;
      end
    end else begin : gen_together
      assign fragment_data = u_raster.fragment_data;
    end
  endgenerate
  // Stored words, where they are written.
  localparam int WORD = raster_pkg::STORED_DEPTH_BITS;
  always_comb begin
    write_data = u_raster.write_data;
    for (int s = 0; s < raster_pkg::SAMPLES; s++)
      if (write_data.write_depth[s]) write_data.depth[s*WORD+:WORD] = u_raster.write_word[s*WORD+:WORD];
  end
  // One lane per sample.
  logic [raster_pkg::SAMPLES*raster_pkg::MEMORY_LANE_BITS-1:0] request_lanes;
  request_lanes u_request_lanes (
      .plane_i(u_raster.request_data.plane),
      .bytes_i(u_raster.request_bytes),
      .data_o (request_lanes)
  );
  always_comb begin
    request_data = u_raster.request_data;
    if (raster_pkg::CACHE_KIND == 1) request_data.data = request_lanes;
  end

  `RASTER_TAPS

endmodule
