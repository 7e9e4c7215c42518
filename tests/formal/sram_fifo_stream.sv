
  // An arbitrary item that enters at an arbitrary place: the n-th from now that enters is the n-th from now that
  // leaves, and data_o is it from the next cycle on until the next one leaves. The RAM, which may be read an item
  // ahead, is cut out: sram_word is assumed for it.
  (* anyconst *) logic [WIDTH-1:0] any_data;
  (* anyconst *) logic [INDEX-1:0] any_place;
  (* anyseq *) logic               is_chosen;
  logic             under_way_q, was_chosen_q, is_out_q;
  logic [INDEX:0]   ahead_q, count_q;  // items before it; items inside
  logic [WIDTH-1:0] word_q, answer_q;  // the RAM's word at any_place; the last answer
  logic             reads_it_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      {under_way_q, was_chosen_q, is_out_q, reads_it_q} <= '0;
      {ahead_q, count_q} <= '0;
    end else begin
      count_q <= count_q + (INDEX + 1)'(enters) - (INDEX + 1)'(leaves);
      if (enters && is_chosen && !was_chosen_q) begin
        {under_way_q, was_chosen_q} <= '1;
        ahead_q                     <= count_q - (INDEX + 1)'(leaves);
      end else if (leaves) begin
        if (ahead_q == '0) under_way_q <= 1'b0;
        ahead_q <= ahead_q - (INDEX + 1)'(ahead_q != '0);
      end
      if (leaves) is_out_q <= under_way_q && ahead_q == '0;
      if (leaves) reads_it_q <= place == any_place && !(enters && place == tail_q[INDEX-1:0]);
    end
    if (enters && tail_q[INDEX-1:0] == any_place) word_q <= data_i;
    if (leaves && place == any_place) answer_q <= word_q;
  end
  logic [INDEX-1:0] its_place;
  assign its_place = head_q[INDEX-1:0] + ahead_q[INDEX-1:0];
  always_comb begin
    if (enters && is_chosen && !was_chosen_q) assume (data_i == any_data && tail_q[INDEX-1:0] == any_place);
    if (reads_it_q) assume (item == answer_q);
    if (runs_q) begin
      assert (count_q == tail_q - head_q && count_q <= (INDEX + 1)'(DEPTH));
      assert (valid_o == (count_q != '0) && ready_o == (count_q != (INDEX + 1)'(DEPTH)));  // room for DEPTH, and no deadlock
      if (under_way_q) assert (ahead_q < count_q && its_place == any_place && word_q == any_data && was_chosen_q);
      if (is_out_q) assert (data_o == any_data);
      cover (is_out_q && count_q == (INDEX + 1)'(DEPTH));
    end
  end
  generate
    if (AHEAD == 0) begin : gen_item_late
      always_comb if (runs_q && is_out_q) assert (reads_it_q && answer_q == any_data);
    end else begin : gen_item_ahead
      always_comb
        if (runs_q && under_way_q && ahead_q == '0)
          assert (gen_ahead.passes_q ? gen_ahead.passed_q == any_data : reads_it_q && answer_q == any_data);
    end
  endgenerate
