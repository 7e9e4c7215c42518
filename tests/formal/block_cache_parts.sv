
  // Parts of color_write, which the proof covers as well: its registers (tools/prove_list.py connects them).
  localparam int DELAY = 3 * STAMPS;
  localparam int TIME = $clog2(DELAY + 2);
  logic [STAMPS-1:0]        w_first_q, w_second_q, w_next;
  logic [LINE-1:0]          w_first_line_q, w_second_line_q;
  logic [SLOT-1:0]        w_first_slot_q, w_second_slot_q, w_slot_q;
  logic                     w_first_fills_q, w_second_fills_q, w_two_q, w_moves_up, w_started_q, w_starts, w_reads, c_fills_q;
  logic                     w_busy, w_writes_q;
  logic [DELAY-1:0]         w_delay_q;
  logic [LINE+STAMP-1:0]    w_read_address, w_write_address;
  logic [SAMPLES-1:0]       w_ram_dirty, w_ram_writes, w_ram_dirty_new, w_write_mask_q;
  logic [SAMPLES*COLOR-1:0] w_ram_code, w_ram_code_new;

  // Evictions that color_write has begun: the number of clocks since the begin of the older one, of the next one, and
  // of the block in any_slot, which is reported complete in its slot after more than DELAY. Its remaining stamps are read
  // until then.
  logic [TIME-1:0] first_time_q, second_time_q, any_time_q, first_left, second_left, started;
  always_comb begin
    first_left  = '0;
    second_left = '0;
    started     = '0;
    for (int i = 0; i < STAMPS; i++) begin
      first_left  = first_left + TIME'(w_first_q[i]);
      second_left = second_left + TIME'(w_second_q[i]);
    end
    for (int i = 0; i < DELAY; i++) started = started + TIME'(w_delay_q[i]);
  end
  logic [TIME-1:0] next_time;
  assign next_time = w_starts ? TIME'(1) : second_time_q + 1'b1;
  always_ff @(posedge clk_i) begin
    first_time_q  <= w_moves_up ? next_time : first_time_q + 1'b1;
    second_time_q <= next_time;
    if (w_starts && w_slot_q == any_slot) any_time_q <= TIME'(1);
    else if (any_time_q <= TIME'(DELAY)) any_time_q <= any_time_q + 1'b1;
  end
  logic [DELAY-1:0] older;  // begun before the eviction of any_slot, and not yet reported complete
  logic [TIME-1:0]  olders;
  assign older = any_time_q > TIME'(DELAY) ? '0 : w_delay_q >> any_time_q;
  always_comb begin
    olders = '0;
    for (int i = 0; i < DELAY; i++) olders = olders + TIME'(older[i]);
  end
  logic any_begun;  // color_write has begun it, and memory lacks a part of it
  assign any_begun = holds_any && 32'(taken_q) - 32'(evictions_behind) > 32'(age);
  always_comb if (runs_q) begin
    // An eviction takes the samples written since the last eviction of its line, whose reads are complete
    // (cache_tags_data).
    if (w_starts && w.line == w_first_line_q) assume ((w.evicted & w_first_q) == '0);
    if (w_first_q == '0) assert (w_second_q == '0 && !w_two_q);
    if (!w_two_q) assert (w_second_q == '0);
    if (w_first_q != '0 && w_first_line_q == w_second_line_q) assert ((w_first_q & w_second_q) == '0);
    if (w_first_q != '0) begin
      assert (w_first_slot_q == SLOT'(w_slot_q - 1'b1 - SLOT'(w_two_q)));
      assert (first_time_q != '0 && 32'(first_left) + (w_two_q ? 32'(second_left) : STAMPS) + 32'(first_time_q) <= DELAY);
      assert (w_delay_q[first_time_q-1'b1]);
      if (w_first_slot_q == any_slot) assert (any_time_q == first_time_q);
    end
    if (w_two_q) begin
      assert (w_second_slot_q == SLOT'(w_slot_q - 1'b1));
      assert (second_time_q != '0 && second_time_q < first_time_q);
      assert (32'(first_left) + 32'(second_left) + STAMPS + 32'(second_time_q) <= DELAY);
      assert (w_delay_q[second_time_q-1'b1]);
      if (w_second_slot_q == any_slot) assert (any_time_q == second_time_q);
    end
    if (any_begun) begin
      assert (any_time_q != '0 && any_time_q <= TIME'(DELAY + 1));
      if (any_time_q <= TIME'(DELAY)) assert (w_delay_q[any_time_q-1'b1] && 32'(age) == 32'(color_ready_q) + 32'(olders));
      else assert (32'(age) < 32'(color_ready_q));
    end
    if (c_valid && c.slot == any_slot) assert (any_begun && any_time_q <= TIME'(DELAY));
    // Data still to come into a slot come before the slot is reported complete.
    if (c_valid) assert (32'(SLOT'(c.slot - oldest_q)) >= 32'(color_ready_q));
    if (w_writes_q) assert (w_write_mask_q != '0);
  end

  // Tags and queues are cut out: items, orders and answers are arbitrary except for what cache_tags_stream, fifo_stream
  // and skid_buffer_stream prove. An arbitrary slot of the victims.
  (* anyconst *) logic [SLOT-1:0] any_slot;
  always_comb if (runs_q) begin
    if (item_valid && found.evicts) assume (found.source != raster_pkg::DEPTH_SOURCE_CHIP);
    if (item_valid && item.mask == '0) assume (found.source == raster_pkg::DEPTH_SOURCE_NONE && !found.starts_color);
    // A clear and the writes of a flush come after all items and orders (cache_tags_stream: DRAIN).
    if (flush_valid) assume (!order_valid && !item_valid && taken_q == '0 && behind_q == '0);
    if (clear_before_q != {clear_color, clear_depth}) assume (taken_q == '0 && behind_q == '0);
  end
  logic [COLOR+CODE-1:0] clear_before_q;
  always_ff @(posedge clk_i) clear_before_q <= {clear_color, clear_depth};

  // Between depth_cache and color_write: a queue of two (skid_buffer).
  localparam int COLORED = raster_pkg::TESTED_STAMP_BITS + SAMPLES * COLOR;
  logic [COLORED-1:0] first_q, second_q, entering;
  logic [1:0]         count_q;
  assign entering = {write_i.color, x1_stamp};
  always_ff @(posedge clk_i) begin
    count_q <= rst_ni ? count_q + 2'(x1_valid_q) - 2'(colors_done) : '0;
    if (x1_valid_q && count_q == 2'(colors_done)) first_q <= entering;
    else if (colors_done) first_q <= second_q;
    if (x1_valid_q) second_q <= entering;
  end
  logic [COLORED-1:0] leaving_w;
  assign leaving_w = {w_color, w};
  always_comb if (runs_q) begin
    assume (w_valid == (count_q != '0));
    if (w_valid) assume (leaving_w == first_q);
    assert (32'(behind_q) == 32'(count_q) + 32'(x1_valid_q) && behind_q <= 2'd2);  // there is always room in it
    assert (!(x1_valid_q && count_q == 2'd2));
  end

  // The slots: assigned to evictions in turn, written to memory in turn; which of them are in the queue.
  logic [1:0]      evictions_behind;  // evictions that color_write has not begun
  logic            holds_any, first_evicts, second_evicts;
  logic [SLOT:0] age;
  assign first_evicts     = count_q != '0 && first_q[STAMPS+1] && !w_started_q;
  assign second_evicts    = count_q == 2'd2 && second_q[STAMPS+1];
  assign evictions_behind = 2'(x1_valid_q && x1_q.evicts) + 2'(first_evicts) + 2'(second_evicts);
  assign age              = (SLOT + 1)'(SLOT'(any_slot - oldest_q));
  assign holds_any        = age < taken_q;
  logic [BLOCK_X-1:0] slot_x;
  logic [BLOCK_Y-1:0] slot_y;
  logic [STAMPS-1:0]  here_depth_any, here_color_any;
  assign {slot_x, slot_y, here_depth_any, here_color_any} = victim_q[any_slot];
  always_comb if (runs_q) begin
    assert (taken_q <= (SLOT + 1)'(VICTIMS));
    if (taken_q != '0) assert (oldest_depth_q == depth_left_q[oldest_q] && oldest_color_q == color_left_q[oldest_q]);
    assert (SLOT'(taken_q) == SLOT'(slot_q - oldest_q));
    assert (SLOT'(evictions_behind) == SLOT'(slot_q - w_slot_q) && 32'(evictions_behind) <= 32'(taken_q));
    assert (32'(depth_ready_q) + 32'(v_valid_q) == 32'(taken_q));
    assert (32'(color_ready_q) + 32'(started) + 32'(evictions_behind) == 32'(taken_q));
    if (left_q != '0) assert (v_valid_q);
    if (v_valid_q) assert (v_last_q == (left_q == '0) && v_slot_q == SLOT'(slot_q - 1'b1) && v_fills_q == fills_q);
    assert (!w_started_q);
    // A stamp about to be overwritten is not still to be read.
    if (w_writes_q && w_first_line_q == w_write_address[STAMP+:LINE]) assert ((w_first_q & (STAMPS'(1) << w_write_address[STAMP-1:0])) == '0);
    if (w_writes_q && w_second_line_q == w_write_address[STAMP+:LINE]) assert ((w_second_q & (STAMPS'(1) << w_write_address[STAMP-1:0])) == '0);
    if (x1_valid_q && x1_writes_q != '0 && left_line_q == x1_q.line) assert ((left_q & (STAMPS'(1) << x1_q.stamp)) == '0);
    // The queue agrees with the slots about them.
    if (x1_valid_q && x1_q.evicts && SLOT'(slot_q - 1'b1) == any_slot)
      assert (x1_q.color == here_color_any && {STAMPS{x1_q.fills[1]}} == color_left_q[any_slot]);
    if (second_evicts && SLOT'(w_slot_q + SLOT'(first_evicts)) == any_slot)
      assert (second_q[STAMPS-1:0] == here_color_any && {STAMPS{second_q[STAMPS]}} == color_left_q[any_slot]);
    if (first_evicts && w_slot_q == any_slot)
      assert (first_q[STAMPS-1:0] == here_color_any && {STAMPS{first_q[STAMPS]}} == color_left_q[any_slot]);
  end
