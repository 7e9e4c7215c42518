
  // Each fragment leaves once, in order, unchanged; an offer stays while the other side's FIFO has room. (FIFOs: ready
  // does not depend on valid, and falls only when an item enters.)
  logic is_stuck;
  assign is_stuck = is_settled && !leaves;
  always_comb if (runs_q) begin
    assert ((valid_q && leaves && is_item) == (item_valid_o && item_ready_i));
    assert (orders_all == (state_q == ORDER && !(order_valid_o && !order_ready_i)));
    if (item_valid_o && item_ready_i && is_order) assert (order_valid_o && order_ready_i);  // both leave together
    if (!walks_q && item_valid_o) assert (item_o == fragment_q);
    if (walks_q && item_valid_o) assert (item_o.mask == '0 && !item_o.ends_visit && found_o.evicts && !order_o.reads);
    if (valid_q && item_valid_o && item_o.mask == '0) assert (found_o.source == raster_pkg::DEPTH_SOURCE_NONE && !found_o.starts_color);
    if (found_o.source == raster_pkg::DEPTH_SOURCE_CHIP) assert (!found_o.evicts);
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(takes_fragment)) assert (read_valid_q && !read_walks_q && read_q == $past(fragment_i));
    if ($past(read_valid_q && !moves)) assert (read_valid_q && read_walks_q == $past(read_walks_q) && (read_walks_q || read_q == $past(read_q)));
    if ($past(read_valid_q && moves)) assert (valid_q && walks_q == $past(read_walks_q) && (walks_q || fragment_q == $past(read_q)));
    if ($past(!takes_fragment && !looks && moves)) assert (!read_valid_q);
    if ($past(!read_valid_q && leaves)) assert (!valid_q);
    if ($past(valid_q && !leaves)) assert (valid_q && walks_q == $past(walks_q) && fragment_q == $past(fragment_q));
    if ($past(is_stuck))
      assert (is_settled && item_o == $past(item_o) && found_o.line == $past(found_o.line) && found_o.stamp == $past(found_o.stamp) &&
              {order_o.writes, order_o.reads, found_o.evicts} == $past({order_o.writes, order_o.reads, found_o.evicts}) &&
              {found_o.source, found_o.depth, found_o.color, found_o.fills} ==
              $past({found_o.source, found_o.depth, found_o.color, found_o.fills}));
    if ($past(request_valid_o && !request_ready_i)) assert (request_valid_o && request_o == $past(request_o));
  end
  // write_back assembles a request's data from these.
  always_comb if (runs_q && request_valid_o)
    assert (request_o.data == (request_o.plane[1] ? (SAMPLES * LANE)'(request_word_o) : {SAMPLES{LANE'(clear_color_o)}}));
  // The RAMs: sram_word; the flags: clear_flags_data.
  logic              lines_stay_q, flags_stay_q, fell_q;
  logic [STATE-1:0]  line_before_q;
  logic [2*WORD-1:0] flags_before_q;
  always_ff @(posedge clk_i) begin
    lines_stay_q   <= !(takes_fragment || looks);
    flags_stay_q   <= state_q == SEND;
    fell_q         <= rst_ni && leaves && falls;
    line_before_q  <= line_read;
    flags_before_q <= {word_color, word_depth};
  end
  always_comb if (runs_q) begin
    if (lines_stay_q) assume (line_read == line_before_q);
    assume (flags_are_busy == fell_q);
    if (flags_stay_q && state_q == SEND) assume ({word_color, word_depth} == flags_before_q);
  end

  // No deadlock: when items, orders and requests are taken and orders are completed, a fragment leaves within four
  // cycles, and the remaining work of a token decreases in every cycle. The measure, most significant first: its parts;
  // lines to look at, or buffers; rows and columns of words; lines to mark; flags of a word and stamps of a block.
  logic             others_do;
  logic [2:0]       part;
  logic [2:0]       step;
  logic [LINE:0]    lines_left;
  logic [WORD_X:0]  columns_left;
  logic [BLOCK_Y:0] rows_left;
  logic [STAMP:0]   stamps_left;
  localparam int LEFT = 3 + 1 + BLOCK_Y + 1 + WORD_X + 1 + LINE + 1 + 3 + WORD + STAMP + 1;
  logic [LEFT-1:0]  left;
  assign others_do = item_ready_i && order_ready_i && drained_i && request_ready_i;
  always_comb begin
    part         = 3'd0;
    lines_left   = '0;
    rows_left    = '0;
    columns_left = '0;
    step         = '0;
    stamps_left  = '0;
    case (state_q)
      LOOK: begin
        part       = 3'd5;
        lines_left = lines_done_q ? '0 : (LINE + 1)'(LINES) - (LINE + 1)'(walk_q);
        step       = {read_valid_q, 2'(valid_q) + 2'(valid_q && falls && flags_are_busy)};
      end
      ORDER: part = 3'd4;
      DRAIN: part = 3'd3;
      MARK: begin
        part       = 3'd2;
        lines_left = lines_done_q ? '0 : (LINE + 1)'(LINES) - (LINE + 1)'(walk_q);
      end
      READ, SEND, RESOLVE: begin
        part        = 3'd2;
        step        = 3'(RESOLVE - state_q);
        stamps_left = state_q == RESOLVE ? (STAMP + 1)'(STAMPS) - (STAMP + 1)'(stamp_q) : '0;
      end
      default: part = state_q == DONE ? 3'd1 : 3'd6;
    endcase
    if (part == 3'd2 && !(is_clear && words_done_q)) begin
      rows_left    = (BLOCK_Y + 1)'(last_y) - (BLOCK_Y + 1)'(word_y_q) + 1'b1;
      columns_left = (WORD_X + 1)'(last_word) - (WORD_X + 1)'(word_x_q);
    end
    left = {part, part == 3'd2 && !is_clear && !plane_q, rows_left, columns_left, lines_left, step,
            state_q == RESOLVE ? bits_q : WORD'(0), stamps_left};
  end
  always_comb if (runs_q) begin
    assert (state_q <= DONE && waiting_q <= WRITES'(VICTIMS));
    if (state_q != SERVE)
      assert (fragment_valid_i && is_token && (!valid_q || (walks_q && state_q == LOOK)) && (!read_valid_q || (read_walks_q && state_q == LOOK)));
    if (state_q == SERVE) assert ((!valid_q || !walks_q) && (!read_valid_q || !read_walks_q));
    if (valid_q) assert (leaves_line_q == (walks_q || (fragment_q.mask != '0 && !hits_q)));
    if (state_q == LOOK) begin
      assert (lines_done_q ? walk_q == '0 || LINES != (1 << LINE) : walk_q < LINE'(LINES) || LINES == (1 << LINE));
      if (lines_done_q) assert (read_valid_q ? read_line_q == LINE'(LINES - 1) : valid_q && line_q == LINE'(LINES - 1));
      if (read_valid_q && !lines_done_q) assert (walk_q != '0 && read_line_q == walk_q - 1'b1);
      if (valid_q) assert (read_valid_q ? read_line_q != '0 && line_q == read_line_q - 1'b1 :
                           lines_done_q ? line_q == LINE'(LINES - 1) : walk_q != '0 && line_q == walk_q - 1'b1);
    end
    if (state_q == MARK) assert (is_clear);
    if (state_q == READ && is_clear) assert (clears_bin);
    else if (state_q == READ || state_q == SEND || state_q == RESOLVE) assert (!is_clear && (state_q == RESOLVE || !words_done_q || plane_q));
    if (clears_bin && state_q > DRAIN) assert (state_q == DONE || (lines_done_q && !words_done_q));
    if (state_q == RESOLVE) assert (resolves && (bits_q[0] || stamp_q == '0));
    if (state_q > DRAIN && state_q < DONE && !(is_clear && words_done_q)) assert (word_x_q <= last_word && word_y_q <= last_y);
    if (state_q == SERVE && fragment_valid_i && is_token && !read_valid_q && !valid_q) assert (state_d != SERVE);
    if (state_q == SERVE && !read_valid_q && !fell_q && !is_token) assert (fragment_ready_o);
    cover (takes_token && !is_clear && is_known_q);
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(others_do && valid_q && !fell_q)) assert ($past(leaves));
    if ($past(fell_q)) assert (!fell_q);
    if ($past(others_do && state_q != SERVE && state_q != DONE)) assert (left < $past(left));
    if ($past(state_q != SERVE && state_q != DONE)) assert (left <= $past(left));
    if ($past(state_q == DONE)) assert (state_q == SERVE && $past(takes_token));
  end
