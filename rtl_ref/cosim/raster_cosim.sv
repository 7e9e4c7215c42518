// The co-simulation top: raster_top, and a tap on every arrow inside it. Simulation only; adds no logic to the design.
//
// Which arrows there are, which bit is whose and how a tap is wired is generated from model/pipeline_graph.hpp: taps.svh.
//
// Every input is registered: what lies here at a clock edge is what the design sees in the cycle that begins with it. So
// no logic hangs on a port, and Verilator settles the design once a cycle, at the edge.
`include "cosim/taps.svh"
module raster_cosim (
    input logic clk_i,
    input logic rst_ni,

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
    output logic                         request_valid_o,
    input  logic                         request_ready_i,
    output raster_pkg::memory_request_t  request_o,
    input  logic                         response_valid_i,
    output logic                         response_ready_o,
    input  raster_pkg::memory_response_t response_i,

    output raster_pkg::counter_packet_t counters_o,
    output logic                        idle_o,
    output logic                        moves_tiles_o,  // the framebuffer is busy with memory or a clear
    output logic [63:0]                 config_id_o,

    // The taps
    `RASTER_TAP_PORTS
);

  logic [raster_pkg::STALL_BITS-1:0] stall_q;
  logic [15:0]                   mutant_q;
  logic                          primitive_valid_q, line_valid_q, request_ready_q, response_valid_q;
  raster_pkg::primitive_packet_t primitive_q;
  raster_pkg::line_setup_t       line_q;
  raster_pkg::memory_response_t  response_q;

  always_ff @(posedge clk_i) begin
    stall_q           <= stall_i;
    mutant_q          <= mutant_i;
    primitive_valid_q <= primitive_valid_i;
    primitive_q       <= primitive_i;
    line_valid_q      <= line_valid_i;
    line_q            <= line_i;
    request_ready_q   <= request_ready_i;
    response_valid_q  <= response_valid_i;
    response_q        <= response_i;
  end

  raster_top u_raster (
      .clk_i,
      .rst_ni,
      .stall_i(stall_q),
      .primitive_valid_i(primitive_valid_q),
      .primitive_ready_o,
      .primitive_i(primitive_q),
      .line_valid_i(line_valid_q),
      .line_ready_o,
      .line_i(line_q),
      .request_valid_o,
      .request_ready_i(request_ready_q),
      .request_o,
      .response_valid_i(response_valid_q),
      .response_ready_o,
      .response_i(response_q),
      .counters_o,
      .idle_o
  );

  assign moves_tiles_o = u_raster.moves_tiles;

  /* verilator lint_off UNUSEDSIGNAL */  // the sources as they are have no mutations
  logic unused_mutant;
  assign unused_mutant = ^mutant_q;
  /* verilator lint_on UNUSEDSIGNAL */

  assign config_id_o = raster_pkg::CONFIG_ID;

  `RASTER_TAPS

endmodule
