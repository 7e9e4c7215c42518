
  // One item, any: the n-th from now that enters is the n-th from now that leaves, as it was. Which one is any; so all are.
  (* anyconst *) logic [WIDTH-1:0] any_data;
  (* anyseq *) logic               is_chosen;
  logic         under_way_q;       // the chosen item is in here
  logic [INDEX:0] ahead_q;         // items before it
  logic         was_chosen_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      {under_way_q, was_chosen_q} <= '0;
      ahead_q                     <= '0;
    end else begin
      if (enters && is_chosen && !was_chosen_q) begin
        {under_way_q, was_chosen_q} <= '1;
        ahead_q                     <= used_q - (INDEX + 1)'(leaves);
      end else if (leaves) begin
        if (ahead_q == '0) under_way_q <= 1'b0;
        ahead_q <= ahead_q - (INDEX + 1)'(ahead_q != '0);
      end
    end
  end
  logic [INDEX-1:0] between, place;  // where the next one enters, from the head on; the place of the item with so many before it
  assign between = tail_q - head_q;
  assign place = head_q + INDEX'(ahead_q) - INDEX'(valid_o);
  always_comb begin
    if (is_chosen && !was_chosen_q && valid_i) assume (data_i == any_data);
    if (runs_q) begin
      assert (used_q == waiting_q + (INDEX + 1)'(valid_o) && used_q <= (INDEX + 1)'(DEPTH) && waiting_q <= used_q);
      assert (between == waiting_q[INDEX-1:0]);
      assert (ready_o == (used_q != (INDEX + 1)'(DEPTH)) && is_empty_o == (used_q == '0));  // room for DEPTH
      if (under_way_q) assert (ahead_q < used_q && was_chosen_q);
      if (under_way_q && ahead_q >= (INDEX + 1)'(valid_o)) assert (memory_q[place] == any_data);
      if (under_way_q && ahead_q == '0 && valid_o) assert (data_o == any_data);
      cover (leaves && under_way_q && ahead_q == '0 && used_q == (INDEX + 1)'(DEPTH));
    end
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(valid_o && !ready_i)) assert (valid_o && data_o == $past(data_o));
    if ($past(waiting_q) != '0) assert (valid_o);  // no deadlock
  end
