// A scoreboard for raster_top, bound from outside (docs/your-rtl.md): every beat on the memory port is the model's, in
// order. The first that differs ends the simulation, with the model's beat. Needs memory that begins with the model's
// bytes: testbench.sv.
module scoreboard (
    input logic clk_i,
    input logic rst_ni,
    input logic primitive_valid_i,
    input logic primitive_ready_o,
    input logic line_valid_i,
    input logic line_ready_o,
    input logic beat_valid_o,
    input logic beat_ready_i,
    input raster_pkg::primitive_packet_t primitive_i,
    input raster_pkg::line_setup_t       line_i,
    input raster_pkg::memory_layout_t    layout_i,
    input raster_pkg::memory_beat_t      beat_o
);
  chandle model = halfplane_dpi::new_pipeline(halfplane_dpi::BEATS);
  raster_pkg::memory_beat_t expected;
  int primitives = 0, beats = 0;

  always @(posedge clk_i) if (rst_ni) begin
    if (primitive_valid_i && primitive_ready_o) begin
      if (primitives == 0) halfplane_dpi::set_layout(model, layout_i);
      halfplane_dpi::put_primitive(model, primitive_i);
      primitives++;
    end
    if (line_valid_i && line_ready_o) halfplane_dpi::put_line(model, line_i);
    if (beat_valid_o && beat_ready_i) begin
      if (!halfplane_dpi::get_beat(model, expected))
        $fatal(1, "beat %0d, after %0d primitives: address %h, data %h; the model has none", beats, primitives,
               beat_o.address, beat_o.data);
      if (beat_o != expected)
        $fatal(1, "beat %0d, after %0d primitives: address %h, strobe %h, data %h; the model: address %h, strobe %h, data %h",
               beats, primitives, beat_o.address, beat_o.strobe, beat_o.data, expected.address, expected.strobe,
               expected.data);
      beats++;
    end
  end
endmodule

bind raster_top scoreboard u_scoreboard (.*);
