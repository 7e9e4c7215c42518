
  // A beat on offer stays unchanged, through a reset as well. A burst that begins ends: one first beat, then each with
  // one beat less to go, at the next address, up to the last. A burst that a reset has cut continues without strobes.
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(beat_valid_o && !beat_ready_i)) assert (beat_valid_o && beat_o == $past(beat_o));
  end
  logic              open_q;  // a writing burst has begun and has not ended
  logic [LENGTH-1:0] to_go_q;
  logic [ADDRESS-1:PORT] next_q;
  always_ff @(posedge clk_i) begin
    if (!power_on_ni) open_q <= 1'b0;
    else if (sends && is_write_q) open_q <= length_q != LENGTH'(1);
    if (sends) begin
      to_go_q <= length_q - 1'b1;
      next_q  <= address_q + 1'b1;
    end
  end
  // Beats of the rest of the run, the gathering one included.
  localparam int COLOR_SHARED = (COLOR_SHIFT < PORT) ? PORT - COLOR_SHIFT : 0;
  localparam int FLAG_SHARED = (FLAG_SHIFT < PORT) ? PORT - FLAG_SHIFT : 0;
  logic [15:0]       place_in_beat_run, shared;
  logic [LENGTH-1:0] owed;
  assign shared = run_plane_q[1] ? FLAG_SHARED : (run_plane_q[0] ? COLOR_SHARED : DEPTH_SHARED);
  assign place_in_beat_run = run_place_q & ((16'd1 << shared) - 1'b1);
  assign owed = (shared != '0) ? LENGTH'((place_in_beat_run + 16'(run_left_q) + (16'd1 << shared) - 1'b1) >> shared) :
                LENGTH'(run_left_q) << (run_plane_q[1] ? FLAG_MORE : (run_plane_q[0] ? COLOR_MORE : DEPTH_MORE));
  localparam int FLAG_MORE = (FLAG_SHIFT > PORT) ? FLAG_SHIFT - PORT : 0;
  localparam int DEPTH_MORE = (DEPTH_SHIFT > PORT) ? DEPTH_SHIFT - PORT : 0;
  localparam int COLOR_MORE = (COLOR_SHIFT > PORT) ? COLOR_SHIFT - PORT : 0;
  logic open;  // a burst whose last beat has not moved
  assign open = (valid_q && is_write_q) || gathers_q || owes;
  always_comb if (runs_q) begin
    if (valid_q) assert (length_q != '0 && is_first_q == !open_q);
    if (valid_q && open_q) assert (is_write_q && length_q == to_go_q);
    // For induction.
    if (open_q) assert (to_go_q != '0 && open && !is_first_q);
    if (owes && !valid_q && !gathers_q) assert (open_q && length_q == to_go_q && strobe_q == '0);
    if (gathers_q) assert (!valid_q && is_write_q && in_burst_q && length_q != '0 && is_first_q == !open_q);
    if (gathers_q && open_q) assert (length_q == to_go_q);
    if (valid_q && is_write_q) assert (in_burst_q ? LENGTH'(more_q) < length_q : length_q == LENGTH'(more_q) + 1'b1);
    if (!discards && in_burst_q) begin
      assert (length_q == owed + (valid_q ? LENGTH'(more_q) + 1'b1 : '0));
      assert (gathers_q == (place_in_beat_run != '0 && !valid_q) && (!valid_q || place_in_beat_run == '0));
    end
    assert (run_left_q < RUN'(STAMPS_I));
    if (valid_q) assert (32'(more_q) < (32'd1 << (run_plane_q[1] ? FLAG_MORE : (run_plane_q[0] ? COLOR_MORE : DEPTH_MORE))));
    if (!valid_q && (gathers_q || owes)) assert (more_q == '0);
    assert (writes_out_q <= N'(255) && reads_out_q <= most_reads);
    if (recovers_q) assert (run_left_q == '0);
    if (!discards) assert (in_burst_q == (run_left_q != '0));
    assert (!(valid_q && gathers_q));
    if (in_burst_q && !is_write_q) assert (1'b0);
    if (valid_q && !is_write_q) assert (more_q == '0 && !in_burst_q && !open_q);

    // Every answer is counted, and idle means that memory owes none.
    assert (N'(reads_q) == reads_out_q + (valid_q && !is_write_q ? N'(length_q) : '0));
    assert (N'(writes_q) == writes_out_q + N'(open));
    assert (N'(reads_q) <= most_reads);
    if (idle_o) assert (reads_out_q == '0 && writes_out_q == '0 && !beat_valid_o && !open_q);

    // A reset: answers of memory to earlier requests are dropped, and no request is made until all have come.
    assert (stale_q <= N'(reads_q) + N'(writes_q));
    if (stale_q != '0) assert (discards && !response_valid_o && !takes);

    // No deadlock: the port takes a request, or has a beat on offer, or waits for an answer.
    if (!discards && !valid_q && request_valid_i) assert (request_ready_o || (begins && writes_q == '1));
    if (recovers_q && rst_ni && !valid_q && !gathers_q && !owes) assert (is_done || reads_out_q != '0 || writes_out_q != '0);
    if (answer_valid_i && response_ready_i && (answer_i.is_write || is_last)) assert (answer_ready_o);
    cover (recovers_q && owes && sends);
    cover (open_q && sends && length_q == LENGTH'(1) && !discards);
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(recovers_q && !valid_q && (gathers_q || owes))) assert (valid_q);
    if ($past(sends && more_q != '0)) assert (valid_q && more_q == $past(more_q) - 1'b1);
    if ($past(sends && length_q != LENGTH'(1) && recovers_q)) assert (length_q < $past(length_q));
  end
