// raster_top draws a capture (+scene=FILE): the packets are those of Halfplane's host, memory is an array that answers after a
// random time, and scoreboard.sv holds every beat against the model. At the end memory is the model's, byte for byte.
`timescale 1ns / 1ps
module testbench;
  import raster_pkg::*;
  import halfplane_dpi::*;

  localparam int BYTES = MEMORY_PORT_BITS / 8;
  logic clk = 1'b0, rst_n = 1'b0;
  always #5 clk = !clk;

  logic              primitive_valid = 1'b0, primitive_ready, line_valid = 1'b0, line_ready;
  primitive_packet_t packet, next_packet;
  line_setup_t       line, next_line, lines[$];
  memory_layout_t    layout;
  logic              beat_valid, beat_ready = 1'b0, answer_valid = 1'b0, answer_ready, idle;
  memory_beat_t      beat;
  memory_answer_t    answer, answers[$];

  raster_top dut (
      .clk_i(clk),
      .rst_ni(rst_n),
      .power_on_ni(rst_n),
      .stall_i(STALL_BITS'(0)),
      .primitive_valid_i(primitive_valid),
      .primitive_ready_o(primitive_ready),
      .primitive_i(packet),
      .line_valid_i(line_valid),
      .line_ready_o(line_ready),
      .line_i(line),
      .layout_i(layout),
      .beat_valid_o(beat_valid),
      .beat_ready_i(beat_ready),
      .beat_o(beat),
      .answer_valid_i(answer_valid),
      .answer_ready_o(answer_ready),
      .answer_i(answer),
      .texture_valid_o(),
      .texture_ready_i(1'b0),
      .texture_o(),
      .texel_valid_i(1'b0),
      .texel_ready_o(),
      .texel_i('0),
      .counters_hold_i(1'b0),
      .counters_o(),
      .idle_o(idle),
      .flushed_o()
  );

  // ---------------------------------------------------------------------------------------------------------- the host
  chandle scene, host;
  string  name;
  bit     is_sent = 1'b0;
  int     got;
  always @(posedge clk) begin
    if (rst_n && !is_sent && (!primitive_valid || primitive_ready)) begin
      got = host_next(host, next_packet, next_line);
      if (got == 2) lines.push_back(next_line);
      primitive_valid <= got != 0;
      packet <= next_packet;
      is_sent <= got == 0;
    end
    if (!line_valid || line_ready) begin
      line_valid <= lines.size() != 0;
      if (lines.size() != 0) line <= lines[0];
      if (lines.size() != 0) void'(lines.pop_front());
    end
  end

  // ---------------------------------------------------------------------------------------------------------- the memory
  logic [8*BYTES-1:0] memory[], word;
  int seed = 1;
  always @(posedge clk) begin
    beat_ready <= $random(seed) % 4 != 0;
    if (beat_valid && beat_ready) begin
      if (beat.is_write) begin
        word = memory[beat.address/BYTES];
        for (int i = 0; i < BYTES; i++) if (beat.strobe[i]) word[8*i+:8] = beat.data[8*i+:8];
        memory[beat.address/BYTES] = word;
        if (beat.length == 1) answers.push_back({1'b1, (8 * BYTES)'(0)});  // is_write, data
      end else
        for (int i = 0; i < int'(beat.length); i++) answers.push_back({1'b0, memory[beat.address/BYTES+i]});
    end
    if (answer_valid && answer_ready) void'(answers.pop_front());
    if (!answer_valid || answer_ready) begin
      answer_valid <= answers.size() != 0 && $random(seed) % 2 == 0;
      if (answers.size() != 0) answer <= answers[0];
    end
  end

  // ---------------------------------------------------------------------------------------------------------- the run
  chandle model;  // for the bytes that memory begins with; the scoreboard has its own
  initial begin
    if ($value$plusargs("scene=%s", name) == 0) name = "scene.hpt";
    scene = halfplane_scene_open(name);
    if (scene == null) $fatal(1, "%s", halfplane_last_error());
    host = new_host(scene);
    model = new_pipeline(0);
    layout = get_layout(model);
    memory = new[int'(halfplane_pipeline_memory_size(model)) / BYTES];
    foreach (memory[i]) memory[i] = memory_word(model, i * BYTES);
    repeat (4) @(negedge clk);
    rst_n = 1'b1;
  end
  int cycles = 0;
  always @(posedge clk) begin
    cycles++;
    if (cycles == 1_000_000) $fatal(1, "no end after %0d cycles, %0d primitives", cycles, dut.u_scoreboard.primitives);
    if (is_sent && idle) begin  // the last packet was a flush: memory has the picture
      foreach (memory[i])
        if (memory[i] != memory_word(dut.u_scoreboard.model, i * BYTES))
          $fatal(1, "memory %h: %h, the model: %h", i * BYTES, memory[i], memory_word(dut.u_scoreboard.model, i * BYTES));
      $display("%0d primitives, %0d beats, %0d bytes of memory: equal", dut.u_scoreboard.primitives, dut.u_scoreboard.beats,
               memory.size() * BYTES);
      $finish;
    end
  end
endmodule
