
  // An arbitrary item: the n-th from now that enters is the n-th from now that leaves, unchanged. The choice is free;
  // so all items are covered.
  (* anyconst *) logic [WIDTH-1:0] any_data;
  (* anyseq *) logic               is_chosen;
  logic         under_way_q;                       // the chosen item is inside
  logic [INDEX:0] ahead_q, count_q;                // items before it; items inside
  logic         was_chosen_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      {under_way_q, was_chosen_q} <= '0;
      {ahead_q, count_q}          <= '0;
    end else begin
      count_q <= count_q + (INDEX + 1)'(enters) - (INDEX + 1)'(leaves);
      if (enters && is_chosen && !was_chosen_q) begin
        {under_way_q, was_chosen_q} <= '1;
        ahead_q                     <= count_q - (INDEX + 1)'(leaves);
      end else if (leaves) begin
        if (ahead_q == '0) under_way_q <= 1'b0;
        ahead_q <= ahead_q - (INDEX + 1)'(ahead_q != '0);
      end
    end
  end
  logic [INDEX-1:0] place;
  assign place = head_q[INDEX-1:0] + ahead_q[INDEX-1:0];
  always_comb begin
    if (is_chosen && !was_chosen_q && valid_i) assume (data_i == any_data);
    if (runs_q) begin
      assert (count_q == tail_q - head_q && count_q <= (INDEX + 1)'(DEPTH));
      assert (valid_o == (count_q != '0) && ready_o == (count_q != (INDEX + 1)'(DEPTH)));  // room for DEPTH, and no deadlock
      if (under_way_q) assert (ahead_q < count_q && memory_q[place] == any_data && was_chosen_q);
      if (under_way_q && ahead_q == '0) assert (valid_o && data_o[WIDTH-1:0] == any_data);
      cover (leaves && under_way_q && ahead_q == '0 && count_q == (INDEX + 1)'(DEPTH));
    end
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q) && $past(valid_o && !ready_i)) begin
    assert (valid_o && data_o[WIDTH-1:0] == $past(data_o[WIDTH-1:0]));
  end
  generate
    if (NEXT != 0) begin : gen_next
      always_comb
        if (runs_q && under_way_q && ahead_q == (INDEX + 1)'(1)) assert (data_o[WIDTH+NEXT-1:WIDTH] == any_data[NEXT-1:0]);
    end
  endgenerate
