
  // What comes in. From depth_test: an access on offer stays as it is until it is taken (depth_test_stream, and the fragment
  // on offer there stays: interpolate_stream, primitive_join_stream, line_raster_stream); the write of an access with
  // samples comes in the cycle after it, and writes no sample whose depth the access of that cycle looks at
  // (depth_test_stream); a token has no samples (fine_raster_stream: none without a visit; coarse_raster_stream).
  // From memory: an answer is one to a read that was taken in an earlier cycle. Of the RAMs all outputs may be anything but
  // for what sram_word proves: they stay until the next read.
  logic token;  // fast clear, flush
  assign token = access_i.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR || access_i.kind == raster_pkg::PRIMITIVE_KIND_FLUSH;
  logic access_waits_q, access_taken_q;
  raster_pkg::fragment_packet_t       access_before_q;
  logic [COLOR-1:0]                       access_color_before_q;
  logic [STAMP_BITS+1:0]                  unanswered_q;
  always_ff @(posedge clk_i) begin
    access_waits_q        <= rst_ni && (access_valid_i || access_waits_q) && !(access_valid_i && access_ready_o);
    access_taken_q        <= rst_ni && access_valid_i && access_ready_o && access_i.mask != '0;
    access_before_q       <= access_i;
    access_color_before_q <= access_color_i;
    unanswered_q          <= rst_ni ? unanswered_q + (STAMP_BITS + 2)'(takes_request && !request_o.is_write) -
                                      (STAMP_BITS + 2)'(response_valid_i) : '0;
  end
  always_comb if (runs_q) begin
    if (access_waits_q) assume (access_i == access_before_q && access_color_i == access_color_before_q);
    if (token) assume (access_i.mask == '0);
    assume (write_valid_i == access_taken_q);
    if (write_valid_i)
      assume (write_i.key.tile_x == access_before_q.key.tile_x && write_i.key.tile_y == access_before_q.key.tile_y &&
              write_i.stamp == access_before_q.stamp);
    if (write_valid_i && write_i.key.tile_x == access_i.key.tile_x && write_i.key.tile_y == access_i.key.tile_y && write_i.stamp == access_i.stamp)
      assume ((write_i.write_depth & access_i.mask) == '0);
    if (response_valid_i) assume (unanswered_q != '0);
  end
  logic flag_depth_before_q, flag_color_before_q, flags_stay_q, words_stay_q;
  always_ff @(posedge clk_i) begin
    flag_depth_before_q <= flag_depth;
    flag_color_before_q <= flag_color;
    flags_stay_q        <= !(state_q == CHECK || state_q == LOOK);
    words_stay_q        <= !reads;
  end
  always_comb if (runs_q && flags_stay_q) assume (flag_depth == flag_depth_before_q && flag_color == flag_color_before_q);
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

  // What the walks and the runs of stamps rest on.
  logic walks_tiles;
  assign walks_tiles = state_q == MARK || state_q == LOOK || state_q == TEST || state_q == CLEAR;
  localparam int STAMPS = 32'(LAST_STAMP) + 1;
  localparam int ASK = STAMP_BITS + 2;
  logic [ASK-1:0] asked, answered;  // reads of this fill, and their answers
  assign asked    = requested_q ? (reads_both ? ASK'(2 * STAMPS) : ASK'(STAMPS)) : (plane_q ? ASK'(STAMPS) : '0) + ASK'(stamp_q);
  assign answered = (fill_plane_q ? ASK'(STAMPS) : '0) + ASK'(fill_stamp_q);
  always_comb if (runs_q) begin
    assert (access_waits_q || state_q == SERVE);
    assert (stamp_q <= LAST_STAMP && fill_stamp_q <= LAST_STAMP);
    if (state_q == CHECK || state_q == LOOK || state_q == TEST) assert (stamp_q == LAST_STAMP);
    if (walks_tiles) assert (token && walk_x_q <= access_i.key.tile_x && walk_y_q <= access_i.key.tile_y);
    else assert (walk_x_q == '0 && walk_y_q == '0);
    if (state_q == MARK) assert (is_clear);
    else if (walks_tiles) assert (!is_clear);
    if (state_q == CHECK || state_q == EVICT || is_fill) assert (token || line_q == access_line);
    if (state_q == CHECK || state_q == EVICT) assert (!(token && clears_all));
    if (state_q == EVICT) assert (plane_q ? line_color_dirty : line_depth_dirty);
    if (state_q == CLEAR) assert (plane_q ? flag_color && !flag_depth : flag_depth);
    if (is_fill) assert (!token && !line_depth_dirty && !line_color_dirty);
    // A fill: what was asked for, what came back, what is to come.
    if (state_q == CHECK || state_q == EVICT) assert (!requested_q && fill_stamp_q == '0 && !fill_plane_q);
    if (is_fill) begin
      assert (asked <= ASK'(2 * STAMPS) && answered <= asked || (flag_depth && flag_color));
      assert (ASK'(unanswered_q) == (flag_depth && flag_color ? '0 : asked - answered));
      if (!reads_both) assert (!fill_plane_q && plane_q == requested_q);
      if (flag_depth && flag_color) assert (!requested_q);
      if (requested_q) assert (plane_q && stamp_q == LAST_STAMP);
    end else assert (unanswered_q == '0);
  end
