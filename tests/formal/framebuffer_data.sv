
  // One stamp of one tile, any. `truth` of a plane is what a framebuffer without a cache would hold there: the last write or
  // fast clear. (1) An access reads it. (2) When a flush is through, memory holds it. In between it is in one place: in the
  // line, when the tile is there; if that is clean or the tile is not there, in memory or, where the flag is set, it is the
  // value of the last fast clear. From the host: a fast clear before all else, and of all tiles that are ever drawn to.
  (* anyconst *) logic [TILE_X-1:0]     any_x;
  (* anyconst *) logic [TILE_Y-1:0]     any_y;
  (* anyconst *) logic [STAMP_BITS-1:0] any_stamp;
  logic [LINE-1:0] any_line;
  logic is_there, is_it, walk_is_it, has_passed, request_is_it, tile_is_it;
  assign any_line      = (LINE'(any_x) & LINE_X_MASK) | ((LINE'(any_y) & LINE_Y_MASK) << LINE_X);
  assign is_there      = valid_q[any_line] && tag_x_q[any_line] == any_x >> LINE_X && tag_y_q[any_line] == any_y >> LINE_Y &&
                         !(is_fill && line_q == any_line);
  assign is_it         = access_i.key.tile_x == any_x && access_i.key.tile_y == any_y;
  assign walk_is_it    = walk_x_q == any_x && walk_y_q == any_y;
  assign has_passed    = walk_y_q > any_y || (walk_y_q == any_y && walk_x_q > any_x);  // the walk
  assign tile_is_it    = tile_x == any_x && tile_y == any_y;
  assign request_is_it = takes_request && tile_is_it && stamp_q == any_stamp;
  always_comb begin
    assume (any_stamp <= LAST_STAMP);
    if (token) assume (any_x <= access_i.key.tile_x && any_y <= access_i.key.tile_y);
  end
  logic takes_access;
  assign takes_access = access_valid_i && access_ready_o;
  logic [ADDRESS-1:0] read_q;           // address of the last read of the RAMs
  logic               looked_q, read_known_q, flags_read_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) read_known_q <= 1'b0;
    if (reads) begin
      read_q       <= read_address;
      read_known_q <= rst_ni;
    end
    looked_q <= rst_ni && takes_access && !token && is_it && access_i.stamp == any_stamp;
    if (state_q == CHECK || state_q == LOOK) flags_read_q <= tile_is_it;  // those of the tile
  end
  always_comb if (runs_q) begin
    if (access_taken_q) assert (state_q == SERVE);
    if (write_valid_i)  // its tile is still there
      assert (valid_q[write_line] && tag_x_q[write_line] == write_i.key.tile_x >> LINE_X && tag_y_q[write_line] == write_i.key.tile_y >> LINE_Y);
    if (valid_q[any_line])
      assert (TILE_X'(tag_x_q[any_line] << LINE_X) >> LINE_X == tag_x_q[any_line] &&
              TILE_Y'(tag_y_q[any_line] << LINE_Y) >> LINE_Y == tag_y_q[any_line]);
    if (state_q == EVICT) assert (read_known_q && read_q == {line_q, stamp_q});
    if (is_fill) assert (flags_read_q == is_it);
    if (state_q == TEST || state_q == CLEAR) assert (flags_read_q == walk_is_it);
  end

  logic [1:0] flag, flag_g, dirty, flag_then_q, known_q;
  assign flag  = {flag_color, flag_depth};
  assign dirty = {dirty_color_q[any_line], dirty_depth_q[any_line]} & {2{valid_q[any_line]}};
  genvar p, m;
  generate
    for (p = 0; p < 2; p++) begin : gen_plane
      localparam int BITS = p == 0 ? CODE : COLOR;
      logic is_masked, is_marked;
      logic [BITS-1:0] cleared, value;
      assign is_masked = p == 0 ? access_i.state.depth_write : access_i.state.color_write;
      assign cleared   = p == 0 ? BITS'(clear_depth_q) : BITS'(clear_color_q);
      assign value     = p == 0 ? BITS'(access_i.code) : BITS'(access_color_i);
      assign is_marked = state_q == MARK && is_masked;
      // The flag of the tile, and what a read of it found: sram_word.
      always_ff @(posedge clk_i) begin
        if (flag_write[p] && tile_is_it) flag_g[p] <= state_q == MARK;
        if (state_q == CHECK || state_q == LOOK) flag_then_q[p] <= flag_g[p];
        if (!rst_ni) known_q[p] <= 1'b0;
        else if (takes_access && token && is_clear && is_masked) known_q[p] <= 1'b1;
      end
      always_comb if (runs_q && known_q[p]) begin
        if (flags_read_q && flags_stay_q == 1'b0) assume (flag[p] == flag_then_q[p]);
        if (is_fill && is_it) assert (flag[p] == flag_g[p]);
        if ((state_q == TEST || state_q == CLEAR) && walk_is_it) assert (flag[p] == flag_g[p]);
      end
      always_comb if (runs_q) begin
        if (state_q == MARK && is_masked && has_passed) assert (flag_g[p]);
        if (state_q == MARK && is_masked && (walk_x_q != '0 || walk_y_q != '0)) assert (cleared == value);
        if (known_q[p] && walks_tiles && !is_clear && has_passed) assert (!flag_g[p]);
        if (state_q == LOOK || state_q == TEST || state_q == CLEAR || (state_q == MARK && !clears_all)) assert (!dirty[p]);
        if ((state_q == CHECK || state_q == EVICT) && token && line_q > any_line) assert (!dirty[p]);
      end
      for (m = 0; m < SAMPLES; m++) begin : gen_truth
        logic [BITS-1:0] truth_q, word_q, memory_q, read_word_q, answer_q, word, lane, new_word, response;
        logic            writes, writes_word, writes_then_q, asks, asked_q, looked_at_it_q;
        logic [BITS-1:0] truth_then_q;
        logic [ASK-1:0]  turn_q;  // which read of the fill it was
        assign word        = p == 0 ? BITS'(gen_sample[m].depth) : BITS'(gen_sample[m].color);
        assign new_word    = p == 0 ? BITS'(gen_sample[m].depth_new) : BITS'(gen_sample[m].color_new);
        assign lane        = request_o.data[m*LANE+:BITS];
        assign response    = response_i.data[m*LANE+:BITS];
        assign writes      = write_valid_i && (p == 0 ? write_i.write_depth[m] : write_i.write_color[m]);
        assign writes_word = (is_fill ? (p == 0 ? fill_depth : fill_color) : writes) && write_address == {any_line, any_stamp};
        assign asks        = request_is_it && !request_o.is_write && request_o.plane == p;
        always_ff @(posedge clk_i) begin
          // Without a cache.
          if (writes && write_i.key.tile_x == any_x && write_i.key.tile_y == any_y && write_i.stamp == any_stamp)
            truth_q <= p == 0 ? BITS'(write_i.depth[m*CODE+:CODE]) : BITS'(write_i.color[m*COLOR+:COLOR]);
          else if (takes_access && token && is_clear && is_masked) truth_q <= value;
          // The word of the RAM, and of memory.
          if (writes_word) word_q <= new_word;
          if (request_is_it && request_o.is_write && request_o.plane == p) memory_q <= lane;
          if (reads) read_word_q <= word_q;
          if (asks) begin
            answer_q <= memory_q;
            turn_q   <= asked;
          end
          if (!is_fill || !rst_ni) asked_q <= 1'b0;
          else if (asks) asked_q <= 1'b1;
        end
        always_comb if (runs_q) begin
          // What sram_word proves; not of a word that is written in the cycle in which it is read. And memory: in turn.
          if (!words_stay_q && !writes_then_q && read_q == {any_line, any_stamp}) assume (word == read_word_q);
          if (response_valid_i && asked_q && answered == turn_q) assume (response == answer_q);
        end
        always_ff @(posedge clk_i) begin
          writes_then_q <= writes_word;
          truth_then_q  <= truth_q;
          looked_at_it_q <= known_q[p] && access_i.mask[m];
        end
        logic filled;  // this word, by the fill under way
        assign filled = is_fill && is_it &&
                        (p == 0 ? fill_plane_q || fill_stamp_q > any_stamp : fills_last && fill_stamp_q > any_stamp);
        always_comb if (runs_q && known_q[p]) begin
          if (p == 0 && looked_q && looked_at_it_q) assert (stored_depth_o[m*CODE+:CODE] == truth_then_q);
          if (takes_access && token && !is_clear) assert (memory_q == truth_q);
          // Where it is.
          if (is_there) assert (word_q == truth_q);
          if ((!is_there || !dirty[p]) && !is_marked) assert (truth_q == (flag_g[p] ? cleared : memory_q));
          if (state_q == EVICT && line_q == any_line && read_q == {any_line, any_stamp}) assert (word == word_q);
          if (state_q == EVICT && is_there && line_q == any_line && plane_q == p && stamp_q > any_stamp)
            assert (memory_q == word_q);
          if (state_q == CLEAR && walk_is_it && plane_q == p && stamp_q > any_stamp) assert (memory_q == cleared);
          if (filled) assert (word_q == truth_q);
          if (is_fill && is_it && !flag[p]) begin
            assert (asked_q == (asked > (p == 1 && reads_both ? ASK'(STAMPS) : '0) + ASK'(any_stamp)));
            if (asked_q) assert (turn_q == (p == 1 && reads_both ? ASK'(STAMPS) : '0) + ASK'(any_stamp) && answer_q == memory_q);
          end
          if (!is_it || !is_fill) assert (!asked_q || state_q == SERVE);
        end
      end
    end
  endgenerate
  always_comb if (runs_q) begin
    cover (takes_access && token && !is_clear && known_q == 2'b11 && gen_plane[0].gen_truth[0].truth_q != clear_depth_q);
    cover (looked_q && gen_plane[0].gen_truth[0].looked_at_it_q && stored_depth_o[0+:CODE] != clear_depth_q);
  end
