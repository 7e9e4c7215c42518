
  // Towards memory: an offer stays. Offers of tags and queues stay (cache_tags_stream, fifo_stream).
  raster_pkg::block_order_t        order_before_q;
  var raster_pkg::memory_request_t flush_before_q;
  logic                            order_stays_q, flush_stays_q;
  always_ff @(posedge clk_i) begin
    order_before_q <= order;
    flush_before_q <= flush_request;
    order_stays_q  <= rst_ni && order_valid && !takes_order;
    flush_stays_q  <= rst_ni && flush_valid && !request_ready_i;
  end
  always_comb if (runs_q) begin
    if (order_stays_q) assume (order_valid && order == order_before_q);
    if (flush_stays_q) assume (flush_valid && flush_request == flush_before_q);
    // Data of a flush, next to the request: cache_tags_stream.
    if (flush_valid) assume (flush_request.data == (flush_request.plane[1] ? (8 * raster_pkg::REQUEST_BYTES)'(flush_word) : {SAMPLES{LANE'(clear_color)}}));
    if (order_valid) assume (order.writes != '0 || order.reads);  // is_order
    if (order_valid) assert (written_q <= order.writes);
    if (order_valid && !order.reads) assert (written_q != order.writes);
    if (!order_valid) assert (written_q == '0);
    if (!sends && wants_read && takes_request)
      assert (!request_o.is_write && request_o.tile_x == order.tile_x && request_o.tile_y == order.tile_y &&
              request_o.stamp == order.stamp && request_o.plane == raster_pkg::TILE_PLANE_DEPTH);
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(request_valid_o && !request_ready_i)) assert (request_valid_o && request_o == $past(request_o) && request_bytes_o == $past(request_bytes_o));
  end

  // No read overtakes the write of an eviction of its block. For an arbitrary eviction and an arbitrary later order
  // that reads its block: the tags order the write with it or before it (cache_tags_data: nothing of the block is
  // pending). A queue of the writes in each order says how many evictions have to be written before an order's read;
  // the eviction is one of them.
  (* anyseq *) logic is_eviction, is_reader;  // the chosen eviction and reader
  localparam int N = $clog2(QUEUE * VICTIMS + VICTIMS + 1) + 1;
  logic [N-1:0] asked_q, ahead_q, needs_q, asked, queued;
  logic         evicted_q, unwritten_q, reader_waits_q;
  logic [$clog2(QUEUE):0] place_q, orders_q;  // place of the reader in the queue; orders in it
  logic [WRITES-1:0] writes_q[0:QUEUE-1];     // head at 0
  logic enters, starts_eviction, starts_reader;
  logic [N-1:0] waiting_q;                    // evictions without an order yet
  assign enters          = ordered_valid && ordered_ready;
  assign starts_eviction = made_valid && made_ready && made_result.evicts && is_eviction && !evicted_q;
  assign starts_reader   = enters && ordered.reads && is_reader && evicted_q && !reader_waits_q;
  assign asked           = asked_q + (enters ? N'(ordered.writes) : '0);
  logic [$clog2(QUEUE):0] last;
  assign last = orders_q - ($clog2(QUEUE) + 1)'(takes_order);
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      {asked_q, waiting_q, orders_q} <= '0;
      {evicted_q, unwritten_q, reader_waits_q} <= '0;
    end else begin
      asked_q   <= asked - N'(finishes);
      waiting_q <= waiting_q - (enters ? N'(ordered.writes) : '0) + N'(made_valid && made_ready && made_result.evicts);
      orders_q  <= last + ($clog2(QUEUE) + 1)'(enters);
      if (starts_eviction) begin
        {evicted_q, unwritten_q} <= '1;
        ahead_q                  <= asked_q + waiting_q - N'(finishes);
      end else if (finishes) begin
        if (ahead_q == '0) unwritten_q <= 1'b0;
        ahead_q <= ahead_q - N'(ahead_q != '0);
      end
      if (starts_reader) begin
        reader_waits_q <= 1'b1;
        place_q        <= last;
        needs_q        <= asked - N'(finishes);
      end else begin
        if (takes_order && place_q == '0) reader_waits_q <= 1'b0;
        if (takes_order) place_q <= place_q - 1'b1;
        needs_q <= needs_q - N'(finishes && reader_waits_q);
      end
    end
  end
  genvar q;
  generate
    for (q = 0; q < QUEUE; q++) begin : gen_queue
      always_ff @(posedge clk_i)
        if (enters && last == q) writes_q[q] <= ordered.writes;
        else if (takes_order && q + 1 < QUEUE) writes_q[q] <= writes_q[(q + 1) % QUEUE];
    end
  endgenerate
  logic [N-1:0] sum, sum_reader;
  always_comb begin
    sum        = '0;
    sum_reader = '0;
    for (int i = 0; i < QUEUE; i++) begin
      if (i < orders_q) sum = sum + N'(writes_q[i]);
      if (i <= place_q) sum_reader = sum_reader + N'(writes_q[i]);
    end
  end
  always_comb if (runs_q) begin
    // fifo_stream; and tags order each waiting eviction once.
    assume (order_valid == (orders_q != '0) && ordered_ready == (orders_q != QUEUE));
    if (order_valid) assume (order.writes == writes_q[0]);
    if (ordered_valid) assume (N'(ordered.writes) <= waiting_q && waiting_q <= VICTIMS && (ordered.writes != '0 || ordered.reads));
    if (made_valid && made_ready && made_result.evicts)
      assume (waiting_q - (enters ? N'(ordered.writes) : '0) < VICTIMS);
    if (starts_reader && unwritten_q) assume (ahead_q < asked);
    assert (orders_q <= QUEUE && waiting_q <= VICTIMS);
    for (int i = 0; i < QUEUE; i++) if (i < orders_q) assert (writes_q[i] <= VICTIMS);
    assert (asked_q + N'(written_q) == sum);
    if (unwritten_q) assert (evicted_q && ahead_q < asked_q + waiting_q);
    if (reader_waits_q) begin
      assert (evicted_q && place_q < orders_q && needs_q + N'(written_q) == sum_reader && needs_q <= asked_q);
      if (unwritten_q) assert (ahead_q < needs_q);
      if (place_q == '0 && wants_read) assert (!unwritten_q);  // the reader reads
    end
  end

  // No deadlock. An item waits for stamps that are read, one a cycle, for the item in the test, for color_write, which
  // takes one a cycle except for stamps that read colours, and then only for a slot or an answer; the next request to
  // memory waits only for data in flight from depth_cache and color_write.
  always_comb if (runs_q) begin
    if (item_valid && !goes && left_q == '0 && !x1_valid_q && count_q != 2'd2)
      assert ((found.evicts && !slot_free) || (found.source == raster_pkg::DEPTH_SOURCE_MEMORY && !answer_valid));
    if (order_valid && !request_valid_o) assert (skips || !is_ready);
    if (taken_q != '0 && left_q == '0 && w_delay_q == '0 && !v_valid_q && behind_q == '0) assert (is_ready);
    cover (reader_waits_q && !unwritten_q && place_q == '0 && wants_read && order.writes != '0);
    cover (item_valid && found.evicts && !goes && !slot_free);
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(left_q != '0 && !(goes && found.evicts))) assert (left_q < $past(left_q));
    if ($past(x1_valid_q && !goes)) assert (!x1_valid_q);
    if ($past(w_valid && !colors_done)) assert (!w_writes_q && (!w_two_q || ($past(w_two_q) && w_first_q < $past(w_first_q))));
    if ($past(v_valid_q)) assert (left_q != '0 || !v_valid_q || v_last_q);
    // A run of writes is consecutive in its block, each with the length of the rest.
    if ($past(sends && takes_request) && $past(request_o.run) != RUN'(1))
      assert (sends && request_o.run == $past(request_o.run) - 1'b1 && request_o.plane == $past(request_o.plane) &&
              sent_stamp == $past(sent_stamp) + 1'b1);
    if ($past(sends && takes_request && !ends_victim))
      assert (oldest_q == $past(oldest_q) && {depth_left, color_left} < $past({depth_left, color_left}));
  end
