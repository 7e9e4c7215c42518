
  // An arbitrary block, and an arbitrary stamp of it: the actions of a cache with one line for it, and of memory.
  // `g_` is the specification (model/stages/cache_tags.hpp), fed with the outputs of this stage, in order; the RAM may
  // answer anything except for the words in which the block is (sram_word), and the flags anything except for the flags of
  // the block (clear_flags_data, whose assumptions are asserted here). From the host: tokens cover all blocks that are
  // ever drawn to.
  (* anyconst *) logic [BLOCK_X-1:0] any_x;
  (* anyconst *) logic [BLOCK_Y-1:0] any_y;
  (* anyconst *) logic [STAMP-1:0]   any_stamp;
  logic [LINE-1:0]   any_line;
  logic              is_it, misses_it, empties_it, here_q, has_depth_q, pending_q;
  logic [STAMPS-1:0] known_q, colored_q;
  logic [1:0]        flag_q;      // colour, depth: memory is stale
  logic [WRITES-1:0] age_q;       // of its newest waiting eviction: the number of older ones
  logic              drops_q;     // the last fast clear says that evicted depth is lost
  logic              drops, stores_depth, is_dirty, evicts_it, pending, is_looked_at;
  logic [1:0]        fills_it;
  logic              clears_it;   // a fast clear of the whole target, or of the block's bin
  logic [WRITES-1:0] age;
  assign clears_it    = is_clear && (!clears_bin || (any_x >> LINE_X == last_x >> LINE_X && any_y >> LINE_Y == last_y >> LINE_Y &&
                                                     any_x <= last_x && any_y <= last_y));
  assign any_line     = line_of(any_x, any_y);
  assign is_it        = is_access && block_x == any_x && block_y == any_y;
  assign empties_it   = valid_q && line_q == any_line && (walks_q || (is_access && !is_it));
  assign drops        = is_token && !is_clear && state_q != SERVE ? fragment_i.state.depth_test == raster_pkg::DEPTH_FUNC_NEVER : drops_q;
  assign stores_depth = has_depth_q && !drops;  // a flush decides for the depth it finds
  assign is_dirty     = stores_depth || colored_q != '0;
  assign evicts_it    = here_q && is_dirty && empties_it;
  assign fills_it     = flag_q & {colored_q != '0, stores_depth && known_q != '0};
  assign pending      = pending_q && age_q >= writes;
  assign age          = age_q - writes;
  assign is_looked_at = fragment_q.state.depth_test != raster_pkg::DEPTH_FUNC_ALWAYS || fragment_q.mask != '1 || keeps_some;
  always_comb begin
    if (fragment_valid_i && is_token && !clears_bin) assume (any_x <= last_x && any_y <= last_y);
    assume (32'(any_stamp) < STAMPS && 32'(any_x) < (raster_pkg::TILES_X << TILE_BITS) &&
            32'(any_y) < (raster_pkg::TILES_Y << TILE_BITS));
  end

  // A stencil stands above each depth: a draw that writes one of them, or tests the stencil, keeps a part of the stored
  // word, unless it replaces both. From the host: a draw that tests it has set the registers of its side.
  logic keeps_some, changes_word;
  generate
    if (raster_pkg::STENCIL_BITS != 0) begin : gen_stencil_claim
      logic [2:0] func_q[0:1], passes_q[0:1];
      logic [7:0] write_q[0:1], front_q;
      logic [1:0] has_test_q, has_update_q, passes_all, replaces_all;
      logic       is_test, is_update, side;
      assign is_test   = leaves && valid_q && !walks_q && fragment_q.kind == raster_pkg::PRIMITIVE_KIND_STATE &&
                         fragment_q.state.depth_test == raster_pkg::STATE_REGISTER_STENCIL_TEST;
      assign is_update = leaves && valid_q && !walks_q && fragment_q.kind == raster_pkg::PRIMITIVE_KIND_STATE &&
                         fragment_q.state.depth_test == raster_pkg::STATE_REGISTER_STENCIL_UPDATE;
      assign side      = fragment_q.state.is_back;
      always_ff @(posedge clk_i) begin
        if (is_test && fragment_q.code[19]) front_q <= fragment_q.code[10:3];
        for (int i = 0; i < 2; i++) begin
          if (is_test && fragment_q.code[19+i]) begin
            func_q[i]     <= fragment_q.code[2:0];
            has_test_q[i] <= 1'b1;
          end
          if (is_update && fragment_q.code[17+i]) begin
            passes_q[i]     <= fragment_q.code[8:6];
            write_q[i]      <= fragment_q.code[16:9];
            has_update_q[i] <= 1'b1;
          end
        end
        if (!rst_ni) {has_test_q, has_update_q} <= '0;
      end
      always_comb
        for (int i = 0; i < 2; i++) begin
          passes_all[i]   = func_q[i] == raster_pkg::DEPTH_FUNC_ALWAYS;
          replaces_all[i] = (passes_q[i] == raster_pkg::STENCIL_OP_ZERO || passes_q[i] == raster_pkg::STENCIL_OP_REPLACE) &&
                            write_q[i] == 8'd255;
        end
      assign keeps_some   = (fragment_q.state.depth_write || fragment_q.state.tests_stencil) &&
                            !(fragment_q.state.depth_write && fragment_q.state.tests_stencil && passes_all[side] && replaces_all[side]);
      assign changes_word = fragment_q.state.depth_write || fragment_q.state.writes_stencil;
      always_comb if (runs_q) begin
        if (is_access && fragment_q.state.tests_stencil) assume (has_test_q[side] && has_update_q[side]);
        for (int i = 0; i < 2; i++) begin
          if (has_test_q[i]) assert (gen_stencil.passes_all_q[i] == passes_all[i]);
          if (has_update_q[i]) assert (gen_stencil.replaces_q[i] == replaces_all[i]);
        end
        if (has_test_q[0]) assert (gen_stencil.clear_q == front_q);
        if (has_test_q[0] && state_q == DONE && is_clear && fragment_i.state.depth_write)
          assert (clear_depth_o == {front_q, fragment_i.code[0+:Z]});
      end
    end else begin : gen_depth_claim
      assign keeps_some   = 1'b0;
      assign changes_word = fragment_q.state.depth_write;
    end
  endgenerate

  always_ff @(posedge clk_i) begin
    if (leaves && is_it) begin
      here_q      <= 1'b1;
      known_q     <= (here_q ? known_q : '0) | (is_looked_at || fragment_q.state.depth_write ? stamp_bit : '0);
      colored_q   <= (here_q ? colored_q : '0) | (fragment_q.state.color_write ? stamp_bit : '0);
      has_depth_q <= (here_q && has_depth_q) || changes_word;
    end
    if (leaves && empties_it) here_q <= 1'b0;
    if (leaves && evicts_it) flag_q <= flag_q & ~fills_it;
    if (leaves || orders_all) begin
      pending_q <= pending || (leaves && evicts_it);
      age_q     <= leaves && evicts_it ? waiting_q - writes : age;
    end
    if (takes_token) drops_q <= is_clear && fragment_i.state.depth_test == raster_pkg::DEPTH_FUNC_NEVER;
    if (takes_token && is_clear) begin
      here_q <= 1'b0;
      flag_q <= flag_q | ({fragment_i.state.color_write, fragment_i.state.depth_write} & {2{clears_it}});
    end
    if (takes_token && !is_clear && raster_pkg::FRAME_CLEARS == 0) flag_q[1] <= 1'b0;
    if (!rst_ni) {here_q, pending_q, drops_q} <= '0;
  end

  always_comb if (runs_q && is_known_q) begin
    // A fragment of the block.
    if (leaves && is_it) begin
      assert (found_o.source == (here_q && known_q[stamp] ? raster_pkg::DEPTH_SOURCE_CHIP : !is_looked_at ? raster_pkg::DEPTH_SOURCE_NONE :
                                flag_q[0] ? raster_pkg::DEPTH_SOURCE_CLEAR : raster_pkg::DEPTH_SOURCE_MEMORY));
      assert (found_o.starts_color == (fragment_q.state.color_write && !(here_q && colored_q[stamp])));
      assert (order_o.reads == (found_o.source == raster_pkg::DEPTH_SOURCE_MEMORY));
      assert (!pending);  // its memory read comes after the writes of all evictions of the block
    end
    // The block leaves when another block comes, or a token walks by, and only then; with all of its data.
    if (leaves) assert ((found_o.evicts && line_x == any_x && line_y == any_y) == evicts_it);
    if (leaves && evicts_it) begin
      assert (found_o.depth == (stores_depth ? known_q : '0) && found_o.color == colored_q && found_o.fills == fills_it);
      assert (found_o.line == any_line);
    end
    if (takes_token) assert (!pending_q && (!here_q || clears_all));
    cover (leaves && is_it && order_o.reads && order_o.writes != '0);
    cover (leaves && evicts_it && fills_it == 2'b11);
    cover (leaves && evicts_it && has_depth_q && drops);
    cover (leaves && empties_it && here_q && has_depth_q && !evicts_it);
    cover (takes_token && !is_clear && flag_q != '0);
    // The specification's state in the hardware. The word of the line is old while its write is under way.
    if (!is_marking) begin
      assert (here_q == (word_valid && word_x == any_x && word_y == any_y));
      if (here_q)
        assert ({known_q, colored_q, has_depth_q, flag_q} == {word_known, word_colored, word_has_depth, word_cleared});
    end
    if (is_marking && !clears_all) assert (!here_q);
    if (here_q && !is_marking) assert (!pending_q);
  end

  // The line's word. A read in the cycle of its write is not used.
  logic [STATE-1:0]   word_q, read_word_q;
  logic               word_valid, word_dirty, word_falls, word_has_depth, word_has_color, is_marking, reads_it_q, collided_q, line_stays_q;
  logic [TAG_X-1:0]   word_tag_x;
  logic [TAG_Y-1:0]   word_tag_y;
  logic [STAMPS-1:0]  word_known, word_colored;
  logic [1:0]         word_cleared;
  logic [BLOCK_X-1:0] word_x;
  logic [BLOCK_Y-1:0] word_y;
  logic [STATE-1:0]   line_before_q;
  assign {word_valid, word_dirty, word_falls, word_tag_x, word_tag_y, word_known, word_colored, word_has_depth, word_has_color, word_cleared} =
      word_q[STATE-1-:REST];
  assign word_x     = (BLOCK_X'(word_tag_x) << LINE_X) | (any_x & BLOCK_X'((1 << LINE_X) - 1));
  assign word_y     = (BLOCK_Y'(word_tag_y) << LINE_Y) | (any_y & BLOCK_Y'((1 << LINE_Y) - 1));
  assign is_marking = state_q == MARK || ((state_q == READ || state_q == DONE) && is_clear);
  always_ff @(posedge clk_i) begin
    if (line_writes && line_write_address == any_line) word_q <= line_new;
    if (takes_fragment || looks) begin
      read_word_q <= word_q;
      reads_it_q  <= line_read_address == any_line;
      collided_q  <= line_writes && line_write_address == any_line;
    end
    line_stays_q  <= !(takes_fragment || looks);
    line_before_q <= line_read;
  end
  always_comb if (runs_q) begin
    if (line_stays_q) assume (line_read == line_before_q);
    if (reads_it_q && !collided_q) assume (line_read == read_word_q);
  end

  // The block's flags in clear_flags.
  logic [1:0] flag_ram_q;  // colour, depth
  logic       fell_q, fell_before_q, is_asked_q, line_is_it, read_is_it, waits_q;
  logic [WORD-1:0] depth_before_q, color_before_q;
  logic       sends_q, serves_q;
  assign line_is_it = line_x == any_x && line_y == any_y;
  assign read_is_it = read_x == any_x && read_y == any_y;
  always_ff @(posedge clk_i) begin
    if (leaves && falls && line_is_it) flag_ram_q <= flag_ram_q & ~fills;
    if (WORD_X'(any_x >> BIT) == word_x_q && any_y == word_y_q) begin
      if (token_writes[0]) flag_ram_q[0] <= token_word[bit_of(any_x)];
      if (token_writes[1]) flag_ram_q[1] <= token_word[bit_of(any_x)];
    end
    fell_q         <= rst_ni && leaves && falls;
    fell_before_q  <= rst_ni && fell_q;
    if (takes_fragment) is_asked_q <= needs_flags;
    sends_q        <= state_q == SEND;
    serves_q       <= state_q == SERVE;
    depth_before_q <= word_depth;
    color_before_q <= word_color;
    waits_q        <= rst_ni && falls && !leaves;
  end
  always_comb if (runs_q) begin
    assume (flags_are_busy == fell_q);
    if (is_asked_q && read_is_it) assume (read_cleared == (flag_ram_q & ~(fills & {2{falls && line_is_it}})));
    if (state_q == SEND && WORD_X'(any_x >> BIT) == word_x_q && any_y == word_y_q)
      assume ({word_color[bit_of(any_x)], word_depth[bit_of(any_x)]} == flag_ram_q);
    if (state_q == MARK && clears_bin && WORD_X'(any_x >> BIT) == word_x_q && any_y == word_y_q)
      assume (word_color[bit_of(any_x)] == flag_ram_q[1]);
    if (state_q == SEND && sends_q) assume (word_depth == depth_before_q && word_color == color_before_q);
    assert (!(fell_q && ((takes_fragment && needs_flags) || (leaves && falls))));
    if (waits_q) assert (falls);
    if (state_q == READ || token_writes != '0) assert (!falls && !fell_q && !fell_before_q);
    if (state_q == READ) assert (token_writes == '0);
  end

  // For induction: a read word equals the stored one; state under way.
  logic [1:0] marked, flag_now;  // content of the flag RAMs while a token or an eviction is at work
  logic words_passed, lines_passed;
  assign marked   = {fragment_i.state.color_write, fragment_i.state.depth_write} & {2{words_passed && clears_it}};
  assign words_passed = (is_clear ? words_done_q : state_q == DONE) || word_y_q > any_y ||
                        (word_y_q == any_y && word_x_q > WORD_X'(any_x >> BIT));
  assign lines_passed = state_q == LOOK ? !((valid_q && line_q <= any_line) || (!valid_q && read_valid_q && read_line_q <= any_line) ||
                        (!valid_q && !read_valid_q)) : lines_done_q || walk_q > any_line;
  always_comb if (runs_q) begin
    assert (state_q <= DONE);
    // Three steps: the line that is read is that of the fragment; the block of a fragment that has not asked for its
    // flags is on the chip.
    if (read_valid_q && !read_walks_q) assert (read_line_q == line_of(read_x, read_y) && (read_q.mask != '0 || !is_asked_q));
    if (valid_q && !walks_q) assert (line_q == line_of(block_x, block_y) && leaves_line_q == (fragment_q.mask != '0 && !hits_q));
    if (valid_q && walks_q) assert (leaves_line_q);
    for (int v = 0; v < VICTIMS; v++)
      if (valid_q) assert (is_same_q[v] == (victim_x_q[v] == block_x && victim_y_q[v] == block_y));
    if (has_read_q) assert ((state_q == SERVE || serves_q) && read_q.mask != '0 && !read_walks_q);
    if (state_q == DONE) assert (!serves_q);
    if (has_read_q && state_q == SERVE && read_is_it && !read_valid_q) assert (valid_q ? is_it : here_q);
    if (read_valid_q && !read_walks_q && read_q.mask != '0 && read_is_it && !is_asked_q) assert (valid_q ? is_it : here_q);
    if (read_valid_q && !read_walks_q && read_q.mask != '0) assert (has_read_q);
    if (read_valid_q && read_line_q == any_line) begin
      assert (reads_it_q && is_forwarded_q == collided_q);
      assert ((is_forwarded_q ? forward_q : line_read) == word_q);
    end
    if (read_valid_q) assert (reads_it_q == (read_line_q == any_line));
    assert (drops_depth_q == drops);
    assert (waiting_q <= WRITES'(VICTIMS) && writes <= waiting_q);
    if (state_q != SERVE)
      assert (fragment_valid_i && is_token && (!valid_q || (walks_q && state_q == LOOK)) && (!read_valid_q || (read_walks_q && state_q == LOOK)));
    if (state_q == SERVE) assert ((!valid_q || !walks_q) && (!read_valid_q || !read_walks_q));
    if (state_q == LOOK) begin
      assert (!clears_all);
      assert (lines_done_q ? walk_q == '0 || LINES != (1 << LINE) : walk_q < LINE'(LINES) || LINES == (1 << LINE));
      if (lines_done_q) assert (read_valid_q ? read_line_q == LINE'(LINES - 1) : valid_q && line_q == LINE'(LINES - 1));
      if (read_valid_q && !lines_done_q) assert (walk_q != '0 && read_line_q == walk_q - 1'b1);
      if (valid_q) assert (read_valid_q ? read_line_q != '0 && line_q == read_line_q - 1'b1 :
                           lines_done_q ? line_q == LINE'(LINES - 1) : walk_q != '0 && line_q == walk_q - 1'b1);
      if (!read_valid_q && !valid_q) assert (walk_q == '0);
    end
    if (state_q > ORDER) assert (waiting_q == '0 && !fell_q);
    if (state_q > DRAIN) assert (!fell_before_q);
    if (state_q == MARK) assert (is_clear);
    if (state_q == READ || state_q == SEND || state_q == RESOLVE) assert (!is_clear || (clears_bin && state_q == READ));
    if (state_q == RESOLVE) assert (resolves);
    if (state_q > DRAIN && state_q < DONE && !(is_clear && words_done_q))
      assert (word_x_q >= first_word && word_x_q <= last_word && word_y_q >= first_y && word_y_q <= last_y);
    if (clears_bin && state_q > DRAIN) assert (state_q == DONE || (lines_done_q && !words_done_q));
    // After a token nothing is on the chip until a fragment comes.
    if (is_empty_q) assert (is_known_q && !word_valid && !is_access && !(read_valid_q && !read_walks_q && read_q.mask != '0));
    if (!is_known_q && is_marking) assert ((flag_ram_q & marked) == marked);
    if (!is_known_q)
      assert (!here_q && !pending_q && !valid_q && !read_valid_q && !fell_q && !fell_before_q && (state_q == SERVE || is_marking || state_q == ORDER || state_q == DRAIN) && waiting_q == '0);
    if (valid_q && line_q == any_line) begin
      assert (line_state_q == word_q);
      if (is_it) assert (hits_q == here_q);
      else if (is_access && word_valid) assert (hits_q == (word_x == block_x && word_y == block_y));
    end
    if (is_known_q && word_valid) begin
      assert (word_has_color == (word_colored != '0));
      assert (word_dirty == (word_has_depth || word_colored != '0));
      assert (word_falls == ((word_cleared & {word_colored != '0, word_has_depth && word_known != '0}) != '0));
    end
    // Tokens: lines are empty after the walk has passed, flags are set and reset after it.
    if (state_q == LOOK ? lines_passed : state_q > LOOK && (!clears_all || (state_q >= MARK && lines_passed))) assert (!word_valid);
    if (state_q == DONE) assert (words_done_q && (is_clear ? lines_done_q : plane_q));
  end
  always_comb begin
    flag_now = flag_q;
    if (is_marking) flag_now = flag_q | marked;
    else if (state_q > DRAIN) flag_now[1] = flag_q[1] && !(raster_pkg::FRAME_CLEARS == 0 && plane_q && words_passed);
  end
  always_comb if (runs_q && is_known_q) begin
    assert (flag_ram_q == flag_now);
    if (is_it && !hits_q) assert (cleared_q == flag_ram_q);
    // The waiting evictions.
    if (pending_q)
      assert (age_q < waiting_q && victim_x_q[oldest_q+VICTIM'(age_q)] == any_x && victim_y_q[oldest_q+VICTIM'(age_q)] == any_y);
    for (int a = 0; a < VICTIMS; a++)
      if (WRITES'(a) < waiting_q && victim_x_q[oldest_q+VICTIM'(a)] == any_x && victim_y_q[oldest_q+VICTIM'(a)] == any_y)
        assert (pending_q && WRITES'(a) <= age_q);
  end

  // A flush writes the words of the flags, each once (depth flags only if depth is not lost), and, where colours are
  // resolved, every stamp of a block whose colours are still flagged.
  logic [INDEX-1:0] any_index;
  logic [1:0]       flags_sent_q;
  logic             is_sent_q, word_is_it, words_are_behind, has_sent, takes_request;
  localparam int ROW_BITS = $clog2(raster_pkg::STAMPS_PER_ROW);
  assign any_index     = INDEX'(((((8'(any_y) & 8'((1 << TILE_BITS) - 1)) << $clog2(raster_pkg::BLOCK_SIDE)) | (8'(any_stamp) >> $clog2(raster_pkg::BLOCK_SIDE))) << ROW_BITS) |
                                ((8'(any_x) & 8'((1 << TILE_BITS) - 1)) << $clog2(raster_pkg::BLOCK_SIDE)) | (8'(any_stamp) & 8'((1 << $clog2(raster_pkg::BLOCK_SIDE)) - 1)));
  assign takes_request = request_valid_o && request_ready_i;
  assign word_is_it    = word_x_q == WORD_X'(any_x >> BIT) && word_y_q == any_y;
  assign words_are_behind = state_q == DONE || word_y_q > any_y || (word_y_q == any_y && word_x_q > WORD_X'(any_x >> BIT));
  assign has_sent = flag_q[1] && resolves && (words_are_behind || (state_q == RESOLVE && word_is_it &&
                    (bits_q == '0 || resolve_x_q > any_x || (resolve_x_q == any_x && stamp_q > any_stamp))));
  always_ff @(posedge clk_i) begin
    if (state_q == DRAIN) {is_sent_q, flags_sent_q} <= '0;
    else if (takes_request) begin
      if (state_q == SEND && word_is_it) flags_sent_q <= flags_sent_q | {plane_q, !plane_q};
      if (state_q == RESOLVE && request_o.tile_x == any_x >> TILE_BITS && request_o.tile_y == any_y >> TILE_BITS &&
          request_o.stamp == any_index)
        is_sent_q <= 1'b1;
    end
  end
  always_comb if (runs_q && is_known_q) begin
    if (request_valid_o && state_q == SEND) begin
      assert (request_o.tile_x == word_x_q && request_o.tile_y == word_y_q >> TILE_BITS &&
              request_o.plane == (plane_q ? raster_pkg::TILE_PLANE_COLOR_FLAGS : raster_pkg::TILE_PLANE_DEPTH_FLAGS));
      if (word_is_it) assert (request_o.data[bit_of(any_x)] == flag_q[plane_q]);
    end
    if (request_valid_o && state_q == RESOLVE) assert (request_o.plane == raster_pkg::TILE_PLANE_COLOR);
    if (takes_token && !is_clear)
      assert (flags_sent_q[0] == !drops &&
              (raster_pkg::FRAME_CLEARS == 0 ? is_sent_q == flag_q[1] : flags_sent_q[1]));
    if (!is_clear && (state_q == READ || state_q == SEND || state_q == RESOLVE || state_q == DONE)) begin
      assert (flags_sent_q[0] == (!drops && (plane_q || words_are_behind)));
      assert (plane_q == (words_done_q || drops));
      if (raster_pkg::FRAME_CLEARS != 0) assert (flags_sent_q[1] == (plane_q && words_are_behind));
      assert (is_sent_q == has_sent);
    end
    if (state_q == RESOLVE && bits_q != '0) begin
      assert (WORD_X'(resolve_x_q >> BIT) == word_x_q &&
              (bits_q << (BIT + 1)'(bit_of(resolve_x_q)) >> bit_of(resolve_x_q)) == bits_q);
      if (word_is_it && resolve_x_q <= any_x) assert (bits_q[any_x-resolve_x_q] == flag_q[1]);
    end
    if (state_q == RESOLVE && !bits_q[0]) assert (stamp_q == '0);
    if (state_q == READ) assert (!(words_done_q && !plane_q));
  end
