// The co-simulation top: raster_top, and a tap on every arrow inside it. Simulation only; adds no logic to the design.
//
// Which arrows there are, which bit is whose and how a tap is wired is generated from model/pipeline_graph.hpp: taps.svh.
//
// Every input is registered: what lies here at a clock edge is what the design sees in the cycle that begins with it. So
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
    output logic                        moves_tiles_o,  // the framebuffer is busy with memory or a clear
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
    mutant_q          <= mutant_i;
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
      .idle_o
  );

  assign moves_tiles_o = u_raster.moves_tiles;

  logic unused_mutant;
  assign unused_mutant = ^mutant_q;

  assign config_id_o = raster_pkg::CONFIG_ID;

  `RASTER_TAPS

endmodule
