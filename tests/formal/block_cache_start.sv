
  // A bounded proof starts after a token: no line is valid, and memory holds everything, or where a flush leaves flags
  // (frame.clears=flags), only cleared blocks. Lines are recognised by the width of their words.
  localparam int LINE_STATE = 3 + 2 + 2 * raster_pkg::BLOCK_SIDE * raster_pkg::BLOCK_SIDE + 4;
  logic starts_q = 1'b1;
  always_ff @(posedge clk_i) starts_q <= 1'b0;
  always_comb if (starts_q) begin
    for (int i = 0; i < DEPTH; i++) begin
      if (WIDTH == LINE_STATE) assume (!gen_whole.memory_q[i][WIDTH-1]);
      if (WIDTH == raster_pkg::FLAG_WORD) assume (gen_whole.memory_q[i] == {WIDTH{raster_pkg::FRAME_CLEARS != 0}});
    end
  end
