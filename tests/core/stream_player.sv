// command_decoder with its checker, for tests/core/stream_checker.py: plays the words of +words=FILE, one in a cycle, with a
// pipeline that takes everything and a memory that answers a flush a few cycles later. +silent: it answers none.
bind command_decoder command_stream_checker #(.PATIENCE(300)) u_command_stream_checker (.*);

module stream_player;
  bit clk, rst_n, start;
  logic [31:0] words[0:4095];
  string file;
  int count, next, idle;
  always #1 clk = !clk;

  logic ready, primitive_valid, flushed;
  raster_pkg::primitive_packet_t primitive_data;
  logic [7:0] answers_q;
  command_decoder dut (
      .clk_i(clk),
      .rst_ni(rst_n),
      .start_i(start),
      .stop_i(1'b0),
      .is_running_o(),
      .is_written_o(),
      .error_o(),
      .words_o(),
      .word_valid_i(rst_n && next < count),
      .word_ready_o(ready),
      .word_i(words[next]),
      .word_error_i(1'b0),
      .is_owed_i(1'b0),
      .primitive_valid_o(primitive_valid),
      .primitive_ready_i(1'b1),
      .primitive_o(primitive_data),
      .line_valid_o(),
      .line_ready_i(1'b1),
      .line_o(),
      .layout_o(),
      .texture_base_o(),
      .idle_i(1'b1),
      .flushed_i(flushed),
      .moves_i(1'b0),
      .fence_valid_o(),
      .fence_o(),
      .present_valid_o(),
      .present_ready_i(1'b1),
      .present_color_base_o(),
      .present_color_flags_base_o()
  );
  assign flushed = answers_q[7] && $test$plusargs("silent") == 0;
  always_ff @(posedge clk) begin
    answers_q <= {answers_q[6:0], primitive_valid && primitive_data.kind == raster_pkg::PRIMITIVE_KIND_FLUSH};
    start     <= !rst_n;
    if (!rst_n) answers_q <= '0;
    if (rst_n && next < count && ready) next <= next + 1;
    idle <= next < count && ready ? 0 : idle + 1;
    if (idle == 400) $finish;
  end
  initial begin
    void'($value$plusargs("words=%s", file));
    void'($value$plusargs("count=%d", count));
    $readmemh(file, words);
    repeat (3) @(posedge clk);
    rst_n <= 1'b1;
  end
endmodule
