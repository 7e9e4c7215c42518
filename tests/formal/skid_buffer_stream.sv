
  // A queue of two, written independently of the buffer: an item that enters leaves once, unchanged, in order.
  logic [1:0]       count_q;
  logic [WIDTH-1:0] first_q, second_q;
  logic             pushes, pops;
  assign pushes = valid_i && ready_o;
  assign pops   = valid_o && ready_i;
  always_ff @(posedge clk_i) begin
    count_q <= rst_ni ? count_q + 2'(pushes) - 2'(pops) : '0;
    if (pushes && count_q - 2'(pops) == 2'd0) first_q <= data_i;
    else if (pops) first_q <= second_q;
    if (pushes) second_q <= data_i;
  end
  always_comb if (runs_q) begin
    assert (valid_o == (count_q != 0));
    if (valid_o) assert (data_o == first_q);
    assert (ready_o == (count_q < 2));          // room for two, and no deadlock: it takes an item or offers one
    assert (count_q <= 2);
    if (tail_valid_q) assert (tail_q == second_q && head_valid_q);  // for induction
    cover (count_q == 2 && pops);
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q) && $past(valid_o && !ready_i)) begin
    assert (valid_o && data_o == $past(data_o));
  end
