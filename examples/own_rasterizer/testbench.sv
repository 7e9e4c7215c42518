// The rasterizer draws a capture (+scene=FILE) beside Halfplane's pipeline, which is called through DPI-C. The first triangle
// with other pixels ends it with a status other than 0. A capture that the rasterizer has no commands for is no failure.
`timescale 1ns / 1ps
module testbench;
  import raster_pkg::*;
  import halfplane_dpi::*;

  localparam int SIZE = 16;
  logic clk = 1'b0, rst_n = 1'b0, valid = 1'b0, ready, got_valid, got_ready = 1'b0, got_end;
  logic [2:0][COORDINATE_BITS-1:0] corner_x, corner_y;
  logic [15:0]             color, got_color;
  logic [$clog2(SIZE)-1:0] got_x, got_y;
  always #5 clk = !clk;

  rasterizer #(
      .SIZE(SIZE),
      .SUBPIXEL_BITS(SUBPIXEL_BITS),
      .BITS(COORDINATE_BITS)
  ) dut (
      .clk_i(clk),
      .rst_ni(rst_n),
      .valid_i(valid),
      .ready_o(ready),
      .corner_x_i(corner_x),
      .corner_y_i(corner_y),
      .color_i(color),
      .valid_o(got_valid),
      .ready_i(got_ready),
      .is_end_o(got_end),
      .x_o(got_x),
      .y_o(got_y),
      .color_o(got_color)
  );

  // ------------------------------------------------------------------------------- the host's packets as its own commands
  chandle scene, host, model;
  string name;
  primitive_packet_t packet, sent[$], waiting[$];
  line_setup_t line;

  // The first corner's colour, as rgb565.
  function automatic logic [15:0] color_of(primitive_packet_t p);
    logic [2:0][7:0] code = p.vertex.code[DEPTH_CODE_BITS+:24];  // red lowest
    return {5'((int'(code[0]) * 62 + 255) / 510), 6'((int'(code[1]) * 126 + 255) / 510), 5'((int'(code[2]) * 62 + 255) / 510)};
  endfunction

  // One colour, and states that the rasterizer has.
  function automatic bit is_plain(primitive_packet_t p);
    logic [2:0][ALL_CODE_BITS-1:0] code = p.vertex.code;
    bit is_flat = code[0][ALL_CODE_BITS-1:DEPTH_CODE_BITS] == code[1][ALL_CODE_BITS-1:DEPTH_CODE_BITS] &&
                  code[0][ALL_CODE_BITS-1:DEPTH_CODE_BITS] == code[2][ALL_CODE_BITS-1:DEPTH_CODE_BITS];
    return is_flat && p.cull == CULL_MODE_NONE &&
           p.state.depth_test == DEPTH_FUNC_ALWAYS && !p.state.depth_write && p.state.color_write;
  endfunction

  initial begin
    if ($value$plusargs("scene=%s", name) == 0) name = "scene.hpt";
    scene = halfplane_scene_open(name);
    if (scene == null) $fatal(1, "%s", halfplane_last_error());
    host = new_host(scene);
    model = new_pipeline(WRITES);
    while (host_next(host, packet, line) != 0) begin
      if (packet.kind == PRIMITIVE_KIND_TRIANGLE && is_plain(packet)) waiting.push_back(packet);
      else if (packet.kind == PRIMITIVE_KIND_FAST_CLEAR && waiting.size() == 0) put_primitive(model, packet);
      else if (packet.kind != PRIMITIVE_KIND_FLUSH) begin
        $display("nothing for this rasterizer");
        $finish;
        break;
      end
    end
    repeat (4) @(negedge clk);
    rst_n = 1'b1;
  end

  always @(posedge clk) begin
    if (rst_n && waiting.size() != 0 && (!valid || ready)) begin
      valid <= 1'b1;
      corner_x <= waiting[0].vertex.x;
      corner_y <= waiting[0].vertex.y;
      color <= color_of(waiting[0]);
      sent.push_back(waiting.pop_front());
    end else if (ready) valid <= 1'b0;
    got_ready <= $urandom % 4 != 0;
  end

  // ------------------------------------------------------------------------------------------------------ the scoreboard
  logic [15:0] drawn[int];  // the triangle under way: colours by place
  pipeline_event_t written;
  int place, triangles = 0;

  function automatic void wrong(string what);
    $fatal(1, "triangle %0d: pixel %0d %0d %s", triangles, place % SIZE, place / SIZE, what);
  endfunction

  always @(posedge clk) if (rst_n && got_valid && got_ready) begin
    if (!got_end) drawn[int'(got_y)*SIZE+int'(got_x)] = got_color;
    else begin
      put_primitive(model, sent.pop_front());
      while (get_event(model, written)) begin
        place = written.y * SIZE + written.x;
        if (drawn.exists(place) == 0) wrong("is missing");
        if (drawn[place] != written.color[15:0]) wrong("has another colour");
        drawn.delete(place);
      end
      if (drawn.first(place) != 0) wrong("is too much");
      triangles++;
    end
  end

  always @(posedge clk) if (rst_n && waiting.size() == 0 && sent.size() == 0 && !valid) begin
    $display("%0d triangles: equal", triangles);
    $finish;
  end
endmodule
