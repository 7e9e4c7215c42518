
  // An arbitrary stamp of an arbitrary tile. `truth` of a buffer is the value that a framebuffer without a cache would
  // hold there: the last write or fast clear. (1) An access reads it. (2) When a flush is complete, memory holds it, or
  // the buffer's flag in memory says that it is the value of the last fast clear. In between it is in the line, if the
  // tile is there and, for a colour, written or cleared; if not written since the tile came in, it is in memory or,
  // with the flag set, the value of the last fast clear. From the host: a fast clear comes before all else, and covers
  // all tiles that are ever drawn to.
  (* anyconst *) logic [TILE_X-1:0]     any_x;
  (* anyconst *) logic [TILE_Y-1:0]     any_y;
  (* anyconst *) logic [STAMP_BITS-1:0] any_stamp;
  logic [LINE-1:0]        any_line;
  logic [ROW_BITS:0]      any_row;
  logic [ROW_ADDRESS-1:0] any_row_address;
  logic is_there, is_it, walk_is_it, has_passed, request_is_it, tile_is_it, word_is_it, evicts_it;
  assign any_line      = (LINE'(any_x) & LINE_X_MASK) | ((LINE'(any_y) & LINE_Y_MASK) << LINE_X);
  assign any_row       = (ROW_BITS + 1)'(any_stamp >> ROW_BITS);
  assign any_row_address = (ROW_ADDRESS'(any_line) << ROW_BITS) | ROW_ADDRESS'(any_stamp >> ROW_BITS);
  assign is_there      = valid_q[any_line] && tag_x_q[any_line] == any_x >> LINE_X && tag_y_q[any_line] == any_y >> LINE_Y &&
                         !(is_fill && line_q == any_line);
  assign is_it         = access_i.key.tile_x == any_x && access_i.key.tile_y == any_y;
  assign walk_is_it    = walk_x_q == any_x && walk_y_q == any_y;
  logic chooses;  // between tiles; otherwise the chosen tile is moved
  logic [TILE_X-1:0] x;
  logic [TILE_Y-1:0] y;
  assign chooses       = state_q == SERVE || state_q == CHECK || state_q == MARK || state_q == READ;
  assign x             = chooses ? tile_x : tile_x_q;
  assign y             = chooses ? tile_y : tile_y_q;
  assign tile_is_it    = x == any_x && y == any_y;
  assign word_is_it    = x >> BIT == any_x >> BIT && y == any_y;
  assign has_passed    = walk_y_q > any_y || (walk_y_q == any_y &&  // by the walk
                         (resolves ? walk_x_q > any_x : walk_x_q >> BIT > any_x >> BIT));
  assign request_is_it = takes_request && !sends && tile_is_it && stamp_q == any_stamp;
  assign evicts_it     = state_q == EVICT && is_there && line_q == any_line;
  always_comb begin
    assume (any_stamp <= LAST_STAMP);
    if (token) assume (any_x <= access_i.key.tile_x && any_y <= access_i.key.tile_y);
  end
  logic takes_access;
  assign takes_access = access_valid_i && access_ready_o;
  logic [ADDRESS-1:0]     read_q;  // address of the last read of the RAMs
  logic [ROW_ADDRESS-1:0] dirty_read_q;
  logic                   looked_q, read_known_q, word_read_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) read_known_q <= 1'b0;
    if (reads) begin
      read_q       <= read_address;
      read_known_q <= rst_ni;
    end
    dirty_read_q <= dirty_read_address;
    looked_q <= rst_ni && takes_access && !token && is_it && access_i.stamp == any_stamp;
    if (state_q == CHECK || state_q == READ) word_read_q <= word_is_it;  // the word of the tile's flags
  end
  always_comb if (runs_q) begin
    if (access_taken_q) assert (state_q == SERVE);
    if (write_valid_i)  // the tile is still there
      assert (valid_q[write_line] && tag_x_q[write_line] == write_i.key.tile_x >> LINE_X && tag_y_q[write_line] == write_i.key.tile_y >> LINE_Y);
    if (valid_q[any_line])
      assert (TILE_X'(tag_x_q[any_line] << LINE_X) >> LINE_X == tag_x_q[any_line] &&
              TILE_Y'(tag_y_q[any_line] << LINE_Y) >> LINE_Y == tag_y_q[any_line]);
    if (state_q == EVICT && offers_q) assert (read_known_q && read_q == {line_q, stamp_q});
    if (state_q == EVICT && row_q != (ROW_BITS + 1)'(ROWS))
      assert (dirty_read_q == ((ROW_ADDRESS'(line_q) << ROW_BITS) | ROW_ADDRESS'(row_q)));
    if (is_fill || state_q == EVICT || state_q == SEND || is_resolve) assert (word_read_q == word_is_it);
  end

  logic [1:0] flag_g, flag_then_q, memory_flag_q, dirty, known_q;
  logic       is_row;  // the row of its stamp is available
  assign dirty  = {dirty_color_q[any_line], dirty_depth_q[any_line]} & {2{valid_q[any_line]}};
  assign is_row = row_q == any_row + 1'b1;
  genvar p, m;
  generate
    for (p = 0; p < 2; p++) begin : gen_plane
      localparam int BITS = p == 0 ? CODE : COLOR;
      logic is_masked, is_marked, is_sent, word_bit;
      logic [ROW_BITS:0] dirty_bit;  // dirty bit of its stamp in the row's word
      assign dirty_bit = (ROW_BITS + 1)'(p * ROWS) | (ROW_BITS + 1)'(any_stamp & COLUMN_MASK);
      logic [BITS-1:0] cleared, value;
      assign is_masked = p == 0 ? access_i.state.depth_write : access_i.state.color_write;
      assign cleared   = p == 0 ? BITS'(clear_depth_q) : BITS'(clear_color_q);
      assign value     = p == 0 ? BITS'(access_i.code) : BITS'(access_color_i);
      assign is_marked = token && is_clear && is_masked && (state_q == MARK || walked_q);
      assign is_sent   = p == 0 || raster_pkg::FRAME_CLEARS != 0;  // the flags go to memory, not the colours
      assign word_bit  = p == 0 ? word_depth[BIT'(any_x)] : word_color[BIT'(any_x)];
      // The tile's flag in hardware, the value that a read of its word found (sram_word), and the flag in memory.
      always_ff @(posedge clk_i) begin
        if (flag_write[p] && flag_bit[BIT'(any_x)] && word_is_it) flag_g[p] <= state_q == MARK;
        if (state_q == CHECK || state_q == READ) flag_then_q[p] <= flag_g[p];
        if (takes_request && sends && word_is_it && plane_q == p) memory_flag_q[p] <= request_o.data[BIT'(any_x)];
        if (!rst_ni) known_q[p] <= 1'b0;
        else if (takes_access && token && is_clear && is_masked) known_q[p] <= 1'b1;
      end
      always_comb if (runs_q && known_q[p]) begin
        if (word_read_q && flags_stay_q == 1'b0) assume (word_bit == flag_then_q[p]);
        if (word_read_q && (is_fill || state_q == EVICT || state_q == SEND || is_resolve)) assert (word_bit == flag_g[p]);
      end
      always_comb if (runs_q) begin
        if (is_marked && (has_passed || walked_q)) assert (flag_g[p]);
        if (is_marked && (walked_q || walk_x_q != '0 || walk_y_q != '0)) assert (cleared == value);
        if (known_q[p] && walks_tiles && !is_clear && (walked_q || plane_q > p || (plane_q == p && has_passed)))
          assert (is_sent ? memory_flag_q[p] == flag_g[p] : !flag_g[p]);
        if (walks_tiles && !clears_all) assert (!dirty[p]);
        if ((state_q == CHECK || state_q == EVICT) && token && line_q > any_line) assert (!dirty[p]);
      end
      for (m = 0; m < SAMPLES; m++) begin : gen_truth
        logic [BITS-1:0] truth_q, word_q, memory_q, read_word_q, answer_q, word, lane, new_word, response, truth_then_q;
        logic            writes, writes_word, writes_then_q, asks, asked_q, looked_at_it_q;
        logic            is_new_q, is_new_then_q, writes_row, writes_row_then_q, reads_new;  // written since the tile came in
        assign word        = p == 0 ? BITS'(gen_sample[m].depth) : BITS'(gen_sample[m].color);
        assign new_word    = p == 0 ? BITS'(gen_sample[m].depth_new) : BITS'(gen_sample[m].color_new);
        assign lane        = request_o.data[m*LANE+:BITS];
        assign response    = response_i.data[m*LANE+:BITS];
        assign writes      = write_valid_i && (p == 0 ? write_i.write_depth[m] : write_i.write_color[m]);
        assign writes_word = (p == 0 ? gen_sample[m].writes_depth : gen_sample[m].writes_color) && {new_line, new_stamp} == {any_line, any_stamp};
        assign writes_row  = dirty_write_address == any_row_address && gen_sample[m].writes_dirty[dirty_bit];
        assign reads_new   = gen_sample[m].dirty[dirty_bit];
        assign asks        = takes_request && !request_o.is_write && tile_is_it && p == 0;  // for all of its stamps
        always_ff @(posedge clk_i) begin
          // The value without a cache.
          if (writes && write_i.key.tile_x == any_x && write_i.key.tile_y == any_y && write_i.stamp == any_stamp)
            truth_q <= p == 0 ? BITS'(write_i.depth[m*CODE+:CODE]) : BITS'(write_i.color[m*COLOR+:COLOR]);
          else if (takes_access && token && is_clear && is_masked) truth_q <= value;
          // The word of the RAM, its dirty bit, and memory.
          if (writes_word) word_q <= new_word;
          if (writes_row) is_new_q <= !is_fill;
          if (request_is_it && request_o.is_write && plane_q == p && request_o.strobe[m]) memory_q <= lane;
          if (reads) read_word_q <= word_q;
          is_new_then_q     <= is_new_q;
          writes_row_then_q <= writes_row;
          if (asks) answer_q <= memory_q;
          if (!is_fill || !rst_ni) asked_q <= 1'b0;
          else if (asks) asked_q <= 1'b1;
        end
        always_comb if (runs_q) begin
          // sram_word; not for a word that is written in the cycle of its read. And memory answers in order.
          if (!words_stay_q && !writes_then_q && read_q == {any_line, any_stamp}) assume (word == read_word_q);
          if (dirty_read_q == any_row_address && !writes_row_then_q) assume (reads_new == is_new_then_q);
          if (response_valid_i && asked_q && answered == ASK'(any_stamp)) assume (response == answer_q);
        end
        always_ff @(posedge clk_i) begin
          writes_then_q  <= writes_word;
          truth_then_q   <= truth_q;
          looked_at_it_q <= known_q[p] && access_i.mask[m];
        end
        logic filled, offered, waits, passed;  // this word, in the current fill; in the run of stamps
        assign filled  = is_fill && is_it && fill_stamp_q > any_stamp;
        assign offered = offers_q && stamp_q == any_stamp && strobe_q[m];
        assign waits   = is_row && stamps_q[32'(any_stamp & COLUMN_MASK)*SAMPLES+m];
        assign passed  = row_q > any_row && !waits && !offered;
        always_comb if (runs_q && state_q == EVICT) assert (!writes_row_then_q && is_new_then_q == is_new_q);
        always_comb if (runs_q && known_q[p]) begin
          if (p == 0 && looked_q && looked_at_it_q) assert (stored_depth_o[m*CODE+:CODE] == truth_then_q);
          if (takes_access && token && !is_clear) assert ((is_sent && memory_flag_q[p] ? cleared : memory_q) == truth_q);
          // Place of the value.
          if (is_there && (p == 0 || is_new_q || (flag_g[p] && !is_marked))) assert (word_q == truth_q);
          if ((!is_there || !dirty[p] || !is_new_q) && !is_marked) assert (truth_q == (flag_g[p] ? cleared : memory_q));
          if (evicts_it && plane_q == p) begin
            if (offered && read_q == {any_line, any_stamp}) assert (word == word_q);
            if (waits || offered) assert (is_new_q || flag_g[p]);
            if (passed) assert (memory_q == truth_q);
          end
          if (is_resolve && walk_is_it && p == 1 && passed) assert (memory_q == cleared);
          if (filled) assert (!is_new_q);
          if (filled && (p == 0 || flag_g[p])) assert (word_q == truth_q);
          if (p == 0 && is_fill && is_it && !flag_depth) begin
            assert (asked_q == (asked > ASK'(any_stamp)));
            if (asked_q) assert (answer_q == memory_q);
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
