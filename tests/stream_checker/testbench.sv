// primitive_stream_checker bound as docs/interface.md says, in a simulation of its own: it is the ports that are checked, so a
// raster_top that draws nothing will do. +clear, +flush: the host sends one.
module raster_top (
    input  logic                          clk_i,
    input  logic                          rst_ni,
    input  logic                          primitive_valid_i,
    output logic                          primitive_ready_o,
    input  raster_pkg::primitive_packet_t primitive_i,
    input  logic                          line_valid_i,
    output logic                          line_ready_o,
    input  raster_pkg::line_setup_t       line_i,
    input  raster_pkg::memory_layout_t    layout_i,
    output logic                          idle_o
);
  assign primitive_ready_o = 1'b1;
  assign line_ready_o      = 1'b1;
  assign idle_o            = 1'b1;
endmodule

bind raster_top primitive_stream_checker u_primitive_stream_checker (.*);

module testbench;
  bit clk, rst_n, valid;
  raster_pkg::primitive_packet_t packet;
  always #1 clk = !clk;

  raster_top dut (
      .clk_i(clk),
      .rst_ni(rst_n),
      .primitive_valid_i(valid),
      .primitive_ready_o(),
      .primitive_i(packet),
      .line_valid_i(1'b0),
      .line_ready_o(),
      .line_i('0),
      .layout_i('0),
      .idle_o()
  );

  task automatic send(raster_pkg::primitive_kind_t kind);
    packet.kind              <= kind;
    packet.box.right         <= 7;
    packet.box.bottom        <= 7;
    packet.state.depth_test  <= raster_pkg::DEPTH_FUNC_ALWAYS;
    packet.state.depth_write <= 1'b1;
    packet.state.color_write <= 1'b1;
    valid <= 1'b1;
    @(posedge clk);
  endtask

  initial begin
    packet = '0;
    repeat (3) @(posedge clk);
    rst_n <= 1'b1;
    if ($test$plusargs("clear")) send(raster_pkg::PRIMITIVE_KIND_FAST_CLEAR);
    send(raster_pkg::PRIMITIVE_KIND_TRIANGLE);
    if ($test$plusargs("flush")) send(raster_pkg::PRIMITIVE_KIND_FLUSH);
    valid <= 1'b0;
    repeat (3) @(posedge clk);
    $display("written %b", dut.u_primitive_stream_checker.is_written);
    $finish;
  end
endmodule
