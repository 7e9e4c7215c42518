
  // An arbitrary block, and its flags: set by tokens, less the fallen ones. `g_` is the specification
  // (model/stages/clear_flags.hpp); the RAMs may answer anything except for the word in which the block is (sram_word).
  (* anyconst *) logic [BLOCK_X-1:0] any_x;
  (* anyconst *) logic [BLOCK_Y-1:0] any_y;
  logic [1:0] g_flag_q, g_known_q;  // colour, depth; a token has written them
  logic       line_is_it, read_is_it, token_is_it, is_asked;
  assign line_is_it  = line_x_i == any_x && line_y_i == any_y;
  assign read_is_it  = read_x_i == any_x && read_y_i == any_y;
  assign token_is_it = word_of(BLOCK_X'(word_x_i) << BIT, word_y_i) == word_of(any_x, any_y);
  always_ff @(posedge clk_i) begin
    if (falls_i && line_is_it) g_flag_q <= g_flag_q & ~fills_i;
    for (int p = 0; p < 2; p++)
      if (token_writes_i[p] && token_is_it) begin
        g_flag_q[p]  <= word_i[bit_of(any_x)];
        g_known_q[p] <= 1'b1;
      end
    if (!rst_ni) g_known_q <= '0;
  end

  // Inputs as cache_tags makes them (cache_tags_data asserts it): no read during the read of a fall, falls are apart,
  // an announced fall comes, and tokens come alone.
  logic               was_asked_q, asks_q, waits_q;
  logic [BLOCK_X-1:0] asked_x_q, read_before_x_q, waits_x_q;
  logic [BLOCK_Y-1:0] asked_y_q, read_before_y_q, waits_y_q;
  logic [1:0]         waits_fills_q;
  assign is_asked = (asks_q && read_x_i == asked_x_q && read_y_i == asked_y_q) ||
                    (was_asked_q && read_x_i == read_before_x_q && read_y_i == read_before_y_q);
  always_ff @(posedge clk_i) begin
    asks_q          <= reads_i;
    asked_x_q       <= block_x_i;
    asked_y_q       <= block_y_i;
    was_asked_q     <= is_asked && !reads_i && token_writes_i == '0;
    read_before_x_q <= read_x_i;
    read_before_y_q <= read_y_i;
    waits_q         <= rst_ni && fills_i != '0 && !falls_i;
    waits_x_q       <= line_x_i;
    waits_y_q       <= line_y_i;
    waits_fills_q   <= fills_i;
  end
  always_comb begin
    if (reads_i || falls_i) assume (!is_busy_o);
    if (waits_q) assume (line_x_i == waits_x_q && line_y_i == waits_y_q && fills_i == waits_fills_q);
    if (token_reads_i || token_writes_i != '0) assume (!reads_i && fills_i == '0 && !reads_q && !writes_q);
    if (token_reads_i) assume (token_writes_i == '0);
    assume (32'(any_x) < (raster_pkg::TILES_X << TILE_BITS) && 32'(any_y) < (raster_pkg::TILES_Y << TILE_BITS));
  end

  logic [1:0] g_now;  // with the announced falls
  logic       token_read_q;
  assign g_now = g_flag_q & ~(fills_i & {2{line_is_it}});
  always_ff @(posedge clk_i) token_read_q <= rst_ni && token_reads_i && token_is_it;
  always_comb if (runs_q) begin
    for (int p = 0; p < 2; p++)
      if (g_known_q[p]) begin
        if (is_asked && read_is_it) assert (cleared_o[p] == g_now[p]);
        if (token_read_q) assert ((p == 1 ? word_color_o[bit_of(any_x)] : word_depth_o[bit_of(any_x)]) == g_flag_q[p]);
      end
    if (reads) assert (!(writes != '0 && read_address == write_address) || !token_reads_i);
    cover (is_asked && read_is_it && g_known_q == 2'b11 && reads_q && cleared_o != g_flag_q);
    cover (is_asked && read_is_it && g_known_q == 2'b11 && !is_fresh_q && g_flag_q == 2'b10);
  end

  // The RAMs: sram_word. A read in the cycle of a write of its word may give anything.
  logic            is_it_q, collided_q, stays_q;
  logic [1:0]      ram_q, read_q;
  logic [WORD-1:0] depth_before_q, color_before_q;
  always_ff @(posedge clk_i) begin
    if (write_address == word_of(any_x, any_y)) begin
      if (writes[0]) ram_q[0] <= word_depth_new[bit_of(any_x)];
      if (writes[1]) ram_q[1] <= word_color_new[bit_of(any_x)];
    end
    if (reads) begin
      is_it_q    <= read_address == word_of(any_x, any_y);
      collided_q <= writes != '0 && write_address == read_address;
      read_q     <= ram_q;
    end
    stays_q        <= !reads;
    depth_before_q <= word_depth;
    color_before_q <= word_color;
  end
  always_comb if (runs_q) begin
    if (stays_q) assume (word_depth == depth_before_q && word_color == color_before_q);
    if (is_it_q && !collided_q) assume ({word_color[bit_of(any_x)], word_depth[bit_of(any_x)]} == read_q);
  end

  // For induction: the state of flags while they fall.
  logic [1:0] falling;
  always_comb begin
    falling = '0;
    if (reads_q && reads_x_q == any_x && reads_y_q == any_y) falling = reads_fills_q;
    if (writes_q && writes_x_q == any_x && writes_y_q == any_y) falling = falling | writes_fills_q;
  end
  always_comb if (runs_q) begin
    assert (!(reads_q && writes_q));
    for (int p = 0; p < 2; p++)
      if (g_known_q[p]) begin
        assert (g_flag_q[p] == (ram_q[p] && !falling[p]));
        if (is_asked && read_is_it && !is_fresh_q && !asks_q) assert (!was_asked_q || (held_q[p] & ~(fills_i[p] & line_is_it)) == g_now[p]);
      end
    if (writes_q && word_of(writes_x_q, writes_y_q) == word_of(any_x, any_y)) assert (is_it_q && !collided_q && read_q == ram_q);
    if (is_fresh_q) assert (asks_q);
    if (is_fresh_q && asked_x_q == any_x && asked_y_q == any_y)
      assert (is_it_q && !collided_q && (read_q & ~written_q) == ram_q && !writes_q);
  end
