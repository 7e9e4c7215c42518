
  // Assumptions on inputs. From depth_test: an access on offer stays unchanged until it is taken (depth_test_stream,
  // and the fragment on offer there stays: interpolate_stream, primitive_join_stream, line_raster_stream); the write of
  // an access with samples comes in the next cycle, and writes no sample whose depth the access of that cycle reads
  // (depth_test_stream); a token has no samples (fine_raster_stream: none without a visit; coarse_raster_stream). From
  // memory: an answer belongs to a read that was taken in an earlier cycle. All outputs of RAMs may be anything except
  // for the property of sram_word: they stay until the next read.
  logic token;  // fast clear, flush
  assign token = access_i.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR || access_i.kind == raster_pkg::PRIMITIVE_KIND_FLUSH;
  logic access_waits_q, access_waited_q, access_taken_q, takes_request;
  assign takes_request = request_valid_o && request_ready_i;
  raster_pkg::fragment_packet_t       access_before_q;
  logic [COLOR-1:0]                       access_color_before_q;
  logic [STAMP_BITS+1:0]                  unanswered_q;
  always_ff @(posedge clk_i) begin
    access_waits_q        <= rst_ni && (access_valid_i || access_waits_q) && !(access_valid_i && access_ready_o);
    access_waited_q       <= rst_ni && access_waits_q;
    access_taken_q        <= rst_ni && access_valid_i && access_ready_o && access_i.mask != '0;
    access_before_q       <= access_i;
    access_color_before_q <= access_color_i;
    unanswered_q          <= rst_ni ? unanswered_q + (takes_request && !request_o.is_write ? (STAMP_BITS + 2)'(request_o.run) : '0) -
                                      (STAMP_BITS + 2)'(response_valid_i) : '0;
  end
  always_comb if (runs_q) begin
    if (access_waits_q) assume (access_i == access_before_q);
    if (access_waits_q && access_waited_q) assume (access_color_i == access_color_before_q);  // one cycle late
    if (token) assume (access_i.mask == '0);
    assume (write_valid_i == access_taken_q);
    if (write_valid_i)
      assume (write_i.key.tile_x == access_before_q.key.tile_x && write_i.key.tile_y == access_before_q.key.tile_y &&
              write_i.stamp == access_before_q.stamp);
    if (write_valid_i && write_i.key.tile_x == access_i.key.tile_x && write_i.key.tile_y == access_i.key.tile_y && write_i.stamp == access_i.stamp)
      assume ((write_i.write_depth & access_i.mask) == '0);
    if (response_valid_i) assume (unanswered_q != '0);
  end
  logic [WORD-1:0] word_depth_before_q, word_color_before_q;
  logic            flags_stay_q, words_stay_q;
  always_ff @(posedge clk_i) begin
    word_depth_before_q <= word_depth;
    word_color_before_q <= word_color;
    flags_stay_q        <= !(state_q == CHECK || state_q == READ);
    words_stay_q        <= !reads;
  end
  always_comb if (runs_q && flags_stay_q) assume (word_depth == word_depth_before_q && word_color == word_color_before_q);
  logic [CODE-1:0]  clear_depth_q;
  logic [COLOR-1:0] clear_color_q;
  logic             marked_q;
  always_ff @(posedge clk_i) begin
    marked_q <= state_q == MARK;
    if (state_q == MARK && access_i.state.depth_write) clear_depth_q <= access_i.code[0+:CODE];
    if (state_q == MARK && access_i.state.color_write) clear_color_q <= access_color_i;
  end
  always_comb if (runs_q) begin
    if (!marked_q) assume (clear_depth == clear_depth_q && clear_color == clear_color_q);
    if (is_fill || is_resolve) assert (!marked_q);
  end
  genvar r;
  generate
    for (r = 0; r < SAMPLES; r++) begin : gen_word
      logic [CODE-1:0]  depth_before_q;
      logic [COLOR-1:0] color_before_q;
      always_ff @(posedge clk_i) begin
        depth_before_q <= gen_sample[r].depth;
        color_before_q <= gen_sample[r].color;
      end
      always_comb if (runs_q && words_stay_q)
        assume (gen_sample[r].depth == depth_before_q && gen_sample[r].color == color_before_q);
    end
  endgenerate

  // Invariants of the walks and the runs of stamps.
  logic walks_tiles;
  assign walks_tiles = state_q == MARK || state_q == READ || state_q == SEND || is_resolve;
  localparam int STAMPS = 32'(LAST_STAMP) + 1;
  localparam int ASK = STAMP_BITS + 2;
  logic [ASK-1:0] next, asked, answered;  // stamp after the last one read out; in a fill: reads taken, their answers
  always_comb begin
    next = ASK'(row_q) << ROW_BITS;
    for (int i = ROWS - 1; i >= 0; i--) if (left[i]) next = (ASK'(row_q) << ROW_BITS) - ASK'(ROWS - i);
  end
  assign asked    = left == '0 && !offers_q ? ASK'(STAMPS) : '0;  // all at once
  assign answered = ASK'(fill_stamp_q);
  always_comb if (runs_q) begin
    assert (access_waits_q || state_q == SERVE);
    if (walks_tiles) begin
      assert (token && walk_y_q <= access_i.key.tile_y);
      if (resolves) assert (walk_x_q <= access_i.key.tile_x);
      else assert (walk_x_q >> BIT <= access_i.key.tile_x >> BIT && walk_x_q >> BIT << BIT == walk_x_q);
    end else assert (walk_x_q == '0 && walk_y_q == '0);
    if (walked_q) assert (state_q == READ && walk_x_q == '0 && walk_y_q == '0 && (is_clear || plane_q));
    if (state_q == MARK) assert (is_clear);
    else if (walks_tiles && !walked_q) assert (!is_clear);
    if (state_q == CHECK || state_q == EVICT || is_fill) assert (token || line_q == access_line);
    if (state_q == CHECK || state_q == EVICT) assert (!(token && clears_all));
    if (state_q == EVICT) assert (plane_q ? line_color_dirty : line_depth_dirty);
    if (state_q == EVICT) assert (tile_x_q == victim_x && tile_y_q == ((tag_y << LINE_Y) | TILE_Y'(line_above_x)));
    if (is_fill) assert (tile_x_q == access_i.key.tile_x && tile_y_q == access_i.key.tile_y);
    if (state_q == SEND || is_resolve) assert (tile_x_q == walk_x_q && tile_y_q == walk_y_q);
    if (state_q == MARK || is_fill) assert (!plane_q);
    if (is_resolve) assert (resolves && flag_color);
    if (is_fill) assert (!token && !line_depth_dirty && !line_color_dirty);
    // A run of stamps: none twice, none skipped, each with its samples.
    assert (row_q <= (ROW_BITS + 1)'(ROWS) || !runs);
    if (runs) begin
      if (left != '0) assert (row_q != '0);
      if (offers_q) assert (ASK'(stamp_q) < next && strobe_q != '0);
      if (is_fill) begin
        assert (row_q == (ROW_BITS + 1)'(ROWS) && stamps_q <= (ROWS * SAMPLES)'(1));
        if (offers_q) assert (left == '0 && stamp_q == '0 && run_q == RUN'(STAMPS));
      end else if (takes_all) begin
        if (offers_q) assert (run_q == RUN'(STAMPS) - RUN'(stamp_q));
        assert (row_q != '0 || (state_q == EVICT && !offers_q));
        if (offers_q) assert (ASK'(stamp_q) + 1'b1 == next && strobe_q == '1);
        for (int i = 0; i < ROWS; i++) assert (stamps_q[i*SAMPLES+:SAMPLES] == '0 || stamps_q[i*SAMPLES+:SAMPLES] == '1);
        for (int i = 1; i < ROWS; i++) if (left[i-1]) assert (left[i]);
      end
    end else begin
      assert (!offers_q);
      if (!is_fill) assert (stamps_q == '0);
    end
    // A fill: stamps requested, answered, still to come.
    if (is_fill && !flag_depth) assert (asked <= ASK'(STAMPS) && answered <= asked && ASK'(unanswered_q) == asked - answered);
    else assert (unanswered_q == '0);
  end
