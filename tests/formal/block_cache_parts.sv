
  // Of color_write, which is what the proof is about as well: its registers (tools/prove_list.py connects them).
  logic [STAMPS-1:0]        w_left_q, w_next;
  logic [LINE-1:0]          w_left_line_q;
  logic                     w_started_q, w_starts, w_reads, w_fills_q, c_fills_q;
  logic [VICTIM-1:0]        w_slot_q;
  logic [SAMPLES-1:0]       w_ram_dirty, w_ram_writes, w_ram_dirty_new;
  logic [SAMPLES*COLOR-1:0] w_ram_code, w_ram_code_new;
  logic [SAMPLES-1:0]       w_writes;
  assign w_writes = w_mask | {SAMPLES{w_starts_color}};

  // Tags and queues are cut out: items, orders and answers may be any, but for what cache_tags_stream, fifo_stream and
  // skid_buffer_stream prove. One slot of the victims, any.
  (* anyconst *) logic [VICTIM-1:0] any_slot;
  always_comb if (runs_q) begin
    if (item_valid && evicts) assume (source != raster_pkg::DEPTH_SOURCE_CHIP);
    if (item_valid && item.mask == '0) assume (source == raster_pkg::DEPTH_SOURCE_NONE && !starts_color);
    // A clear and what a flush writes go behind all items and orders (cache_tags_stream: DRAIN).
    if (flush_valid) assume (!order_valid && !item_valid && taken_q == '0 && behind_q == '0);
    if (clear_before_q != {clear_color, clear_depth}) assume (taken_q == '0 && behind_q == '0);
  end
  logic [COLOR+CODE-1:0] clear_before_q;
  always_ff @(posedge clk_i) clear_before_q <= {clear_color, clear_depth};

  // Between X and W: a queue of two (skid_buffer, in colored_stamps).
  localparam int COLORED = CARRIED + SAMPLES * COLOR;
  logic [COLORED-1:0] first_q, second_q, entering;
  logic [1:0]         count_q;
  assign entering = {x1_line_q, x1_stamp_q, x1_starts_color_q, write_i.write_color & {SAMPLES{write_valid_i}}, write_i.color,
                     x1_evicts_q, x1_fills_q, x1_color_q};
  always_ff @(posedge clk_i) begin
    count_q <= rst_ni ? count_q + 2'(x1_valid_q) - 2'(colors_done) : '0;
    if (x1_valid_q && count_q == 2'(colors_done)) first_q <= entering;
    else if (colors_done) first_q <= second_q;
    if (x1_valid_q) second_q <= entering;
  end
  logic [COLORED-1:0] leaving;
  assign leaving = {w_line, w_stamp, w_starts_color, w_mask, w_color, w_evicts, w_fills, w_stamps};
  always_comb if (runs_q) begin
    assume (w_valid == (count_q != '0));
    if (w_valid) assume (leaving == first_q);
    assert (32'(behind_q) == 32'(count_q) + 32'(x1_valid_q) && behind_q <= 2'd2);  // room in it, always
    assert (!(x1_valid_q && count_q == 2'd2));
  end

  // The slots: given to evictions in turn, written to memory in turn; which are in the queue.
  logic [1:0]      evictions_behind;  // those that W has not begun
  logic            holds_any, first_evicts, second_evicts;
  logic [VICTIM:0] age;
  assign first_evicts     = count_q != '0 && first_q[STAMPS+1] && !w_started_q;
  assign second_evicts    = count_q == 2'd2 && second_q[STAMPS+1];
  assign evictions_behind = 2'(x1_valid_q && x1_evicts_q) + 2'(first_evicts) + 2'(second_evicts);
  assign age              = (VICTIM + 1)'(VICTIM'(any_slot - oldest_q));
  assign holds_any        = age < taken_q;
  logic [BLOCK_X-1:0] slot_x;
  logic [BLOCK_Y-1:0] slot_y;
  logic [STAMPS-1:0]  here_depth_any, here_color_any;
  assign {slot_x, slot_y, here_depth_any, here_color_any} = victim_q[any_slot];
  always_comb if (runs_q) begin
    assert (taken_q <= (VICTIM + 1)'(VICTIMS));
    assert (VICTIM'(taken_q) == VICTIM'(slot_q - oldest_q));
    assert (VICTIM'(evictions_behind) == VICTIM'(slot_q - w_slot_q) && 32'(evictions_behind) <= 32'(taken_q));
    assert (32'(depth_ready_q) + 32'(v_valid_q) == 32'(taken_q));
    assert (32'(color_ready_q) + 32'(c_valid) + 32'(evictions_behind) == 32'(taken_q));
    if (left_q != '0) assert (v_valid_q);
    if (w_left_q != '0) assert (c_valid);
    if (v_valid_q) assert (v_last_q == (left_q == '0) && v_slot_q == VICTIM'(slot_q - 1'b1) && v_fills_q == fills_q);
    if (c_valid) assert (c_last == (w_left_q == '0) && c_slot == VICTIM'(w_slot_q - 1'b1) && c_fills_q == w_fills_q);
    if (w_started_q) assert (w_valid && w_evicts);
    // What is about to be written is not still to be read.
    if (w_started_q && w_writes != '0 && w_left_line_q == w_line) assert ((w_left_q & (STAMPS'(1) << w_stamp)) == '0);
    if (x1_valid_q && x1_writes_q != '0 && left_line_q == x1_line_q) assert ((left_q & (STAMPS'(1) << x1_stamp_q)) == '0);
    // What the queue holds of them is what their slots hold.
    if (x1_valid_q && x1_evicts_q && VICTIM'(slot_q - 1'b1) == any_slot)
      assert (x1_color_q == here_color_any && {STAMPS{x1_fills_q}} == color_left_q[any_slot]);
    if (second_evicts && VICTIM'(w_slot_q + VICTIM'(first_evicts)) == any_slot)
      assert (second_q[STAMPS-1:0] == here_color_any && {STAMPS{second_q[STAMPS]}} == color_left_q[any_slot]);
    if (first_evicts && w_slot_q == any_slot)
      assert (first_q[STAMPS-1:0] == here_color_any && {STAMPS{first_q[STAMPS]}} == color_left_q[any_slot]);
  end
