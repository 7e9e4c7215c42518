
  // An arbitrary item: the n-th from now that enters is the n-th from now that leaves, unchanged. The choice is free;
  // so all items are covered. The FIFO downstream of the register is cut out; fifo_stream is assumed for it.
  (* anyconst *) logic [WIDTH-1:0] any_data;
  (* anyseq *) logic               is_chosen;
  logic            waits_q, is_out_q, was_chosen_q;  // the chosen item is in the FIFO, in the register
  logic [USED-1:0] ahead_q, count_q;                 // in the FIFO: items before it, items
  logic            moves;
  assign moves = waits && is_free;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      {waits_q, is_out_q, was_chosen_q} <= '0;
      {ahead_q, count_q}                <= '0;
    end else begin
      count_q <= count_q + USED'(enters) - USED'(moves);
      if (is_free) is_out_q <= moves && waits_q && ahead_q == '0;
      if (enters && is_chosen && !was_chosen_q) begin
        {waits_q, was_chosen_q} <= '1;
        ahead_q                 <= count_q - USED'(moves);
      end else if (moves) begin
        if (ahead_q == '0) waits_q <= 1'b0;
        ahead_q <= ahead_q - USED'(ahead_q != '0);
      end
    end
  end
  always_comb begin
    if (is_chosen && !was_chosen_q && valid_i) assume (data_i == any_data);
    assume (waits == (count_q != '0) && waiting_ready == (count_q != USED'(DEPTH)));
    if (waits_q && ahead_q == '0) assume (next == any_data);
    if (runs_q) begin
      assert (used_q == count_q + USED'(valid_o) && used_q <= USED'(DEPTH) && count_q <= used_q);
      assert (ready_o == (used_q != USED'(DEPTH)) && is_empty_o == (used_q == '0));  // room for DEPTH
      if (enters) assert (waiting_ready);
      if (waits_q) assert (ahead_q < count_q && was_chosen_q && !is_out_q);
      if (is_out_q) assert (valid_o && data_o == any_data && was_chosen_q);
      cover (leaves && is_out_q && used_q == USED'(DEPTH));
    end
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(valid_o && !ready_i)) assert (valid_o && data_o == $past(data_o));
    if ($past(waits)) assert (valid_o);  // no deadlock
  end
