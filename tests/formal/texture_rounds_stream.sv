
  // A group without a sample between two levels makes one round, any other two: first all live samples, some of which
  // wait for the second, then these alone; with the same payload, in order, and an offer stays.
  localparam int SECOND = TAIL + 36, ENDS = TAIL + 37, WAITS = TAIL + 38, LIVE = TAIL + 42;  // in the payload
  logic             left_turns_q;
  logic [3:0]       left_waits_q;
  logic [TAIL-1:0]  left_tail_q, entered_tail_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) left_turns_q <= 1'b0;
    else if (valid_o && ready_i) left_turns_q <= !ends_o;
    if (valid_o && ready_i) {left_waits_q, left_tail_q} <= {waits_o, tail_o};
    if (scales) entered_tail_q <= tail_i;
  end
  // The state after the round before, at each register.
  logic            agreed_turns, wrapped_turns, scaled_turns;
  logic [3:0]      agreed_waits, wrapped_waits, scaled_waits;
  logic [TAIL-1:0] agreed_tail, wrapped_tail, scaled_tail;
  assign {agreed_turns, agreed_waits, agreed_tail} = agreed_valid_q ? {!ends_o, waits_o, tail_o} :
                                                     {left_turns_q, left_waits_q, left_tail_q};
  assign {wrapped_turns, wrapped_waits, wrapped_tail} =
      wrapped_valid_q ? {!wrapped_along_q[ENDS], wrapped_along_q[WAITS+:4], wrapped_along_q[TAIL-1:0]} :
      {agreed_turns, agreed_waits, agreed_tail};
  assign {scaled_turns, scaled_waits, scaled_tail} =
      scaled_valid_q ? {!scaled_along_q[ENDS], scaled_along_q[WAITS+:4], scaled_along_q[TAIL-1:0]} :
      {wrapped_turns, wrapped_waits, wrapped_tail};
  // Relation of a round to the previous round.
  function automatic [0:0] follows(input [ALONG-1:0] round, input turned, input [3:0] waited, input [TAIL-1:0] tail);
    follows = round[SECOND] == turned && round[LIVE+:4] != '0 && round[ENDS] == (round[WAITS+:4] == '0) &&
              (round[WAITS+:4] & ~round[LIVE+:4]) == '0 &&
              (!turned || (round[ENDS] && round[LIVE+:4] == waited && round[TAIL-1:0] == tail));
  endfunction
  // A group on offer stays.
  always_ff @(posedge clk_i)
    if (runs_q && $past(runs_q) && $past(valid_i && !ready_o)) begin
      assume (valid_i && part_i == $past(part_i) && live_i == $past(live_i) && tail_i == $past(tail_i));
    end
  always_comb begin
    if (valid_i) assume (live_i != '0);
    if (is_second_q) assume (valid_i && (live_i & has_upper) == scaled_waits && tail_i == entered_tail_q);
    if (runs_q) begin
      assert (ready_o == (scales && ((live_i & has_upper) == '0 || is_second_q)));
      assert (is_second_q == scaled_turns);
      if (is_second_q) assert (scaled_waits != '0 && scaled_tail == entered_tail_q);
      if (scaled_valid_q) assert (follows(scaled_along_q, wrapped_turns, wrapped_waits, wrapped_tail));
      if (wrapped_valid_q) assert (follows(wrapped_along_q, agreed_turns, agreed_waits, agreed_tail));
      if (agreed_valid_q) assert (follows(agreed_along_q, left_turns_q, left_waits_q, left_tail_q));
      if (left_turns_q) assert (left_waits_q != '0);
      assert (is_empty_o == (!scaled_valid_q && !wrapped_valid_q && !agreed_valid_q));
      cover (valid_o && is_second_o && scaled_valid_q && wrapped_valid_q);
    end
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q) && $past(valid_o && !ready_i)) begin
    assert (valid_o && agreed_along_q == $past(agreed_along_q) && agree_o == $past(agree_o));
  end
