// The co-simulation top: raster_top, and a tap on every arrow inside it. Simulation only; adds no logic to the design.
//
// fire_o: which arrows transfer a packet in this cycle, in the order of sim/cosim/arrows.hpp: triangle, setup, context,
// tile, edges, stamp, line_pixel, fragment, write, retire. X_o is the packet of arrow X, valid while its bit is set.
// stream_valid_o, stream_ready_o: the elastic streams among them: triangle, setup, tile, stamp, line_pixel, fragment.
//
// Every input is registered: what lies here at a clock edge is what the design sees in the cycle that begins with it. So
// no logic hangs on a port, and Verilator settles the design once a cycle, at the edge.
module raster_cosim (
    input logic clk_i,
    input logic rst_ni,

    input logic [9:0]  stall_i,  // bit s: stream s moves nothing in this cycle
    input logic [15:0] mutant_i, // which mutation is active, 0: none; mutated sources read raster_cosim.mutant_q

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
    output logic [9:0]                   fire_o,
    output logic [5:0]                   stream_valid_o,
    output logic [5:0]                   stream_ready_o,
    output raster_pkg::triangle_packet_t triangle_o,
    output raster_pkg::setup_packet_t    setup_o,
    output raster_pkg::context_packet_t  context_o,
    output raster_pkg::tile_packet_t     tile_o,
    output raster_pkg::edge_context_t    edges_o,
    output raster_pkg::stamp_packet_t    stamp_o,
    output raster_pkg::line_pixel_t      line_pixel_o,
    output raster_pkg::fragment_packet_t fragment_o,
    output raster_pkg::write_packet_t    write_o,
    output raster_pkg::retire_packet_t   retire_o
);

  logic [9:0]                    stall_q;
  logic [15:0]                   mutant_q;
  logic                          primitive_valid_q, line_valid_q, request_ready_q, response_valid_q;
  var raster_pkg::primitive_packet_t primitive_q;
  var raster_pkg::line_setup_t       line_q;
  var raster_pkg::memory_response_t  response_q;

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

  assign moves_tiles_o = u_raster.u_framebuffer.state_q != '0 ||
      (u_raster.u_framebuffer.access_valid_i && !u_raster.u_framebuffer.access_ready_o);

  /* verilator lint_off UNUSEDSIGNAL */  // the sources as they are have no mutations
  logic unused_mutant;
  assign unused_mutant = ^mutant_q;
  /* verilator lint_on UNUSEDSIGNAL */

  assign config_id_o = raster_pkg::CONFIG_ID;

  assign stream_valid_o = {
    u_raster.fragment_valid,
    u_raster.line_pixel_valid,
    u_raster.stamp_valid,
    u_raster.tile_valid,
    u_raster.setup_valid,
    u_raster.triangle_valid
  };
  assign stream_ready_o = {
    u_raster.fragment_ready,
    u_raster.line_pixel_ready,
    u_raster.stamp_ready,
    u_raster.tile_ready,
    u_raster.setup_ready,
    u_raster.triangle_ready
  };

  logic triangle_fire, setup_fire, tile_fire, stamp_fire, line_pixel_fire, fragment_fire;
  assign {fragment_fire, line_pixel_fire, stamp_fire, tile_fire, setup_fire, triangle_fire} = stream_valid_o & stream_ready_o;
  assign fire_o = {
    u_raster.retire_valid,
    u_raster.write_valid,
    fragment_fire,
    line_pixel_fire,
    stamp_fire,
    tile_fire,  // edges: beside the tile
    tile_fire,
    setup_fire,  // context: beside the setup packet
    setup_fire,
    triangle_fire
  };

  assign triangle_o   = u_raster.triangle_data;
  assign setup_o      = u_raster.setup_data;
  assign context_o    = u_raster.context_data;
  assign tile_o       = u_raster.tile_data;
  assign edges_o      = u_raster.edges_data;
  assign stamp_o      = u_raster.stamp_data;
  assign line_pixel_o = u_raster.line_pixel_data;
  assign fragment_o   = u_raster.fragment_data;
  assign write_o      = u_raster.write_data;
  assign retire_o     = u_raster.retire_data;

endmodule
