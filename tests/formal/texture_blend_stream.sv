
  // The first of two levels does not leave, but is kept until the second is blended with it; all others leave once, in
  // order, and an offer stays.
  logic        first_waits_q;  // the last item was the first of two
  logic        second_q;       // the current item is the second
  logic [15:0] first_value_q;  // value of its lowest channel, 8 fraction bits
  always_ff @(posedge clk_i) begin
    if (!rst_ni) first_waits_q <= 1'b0;
    else if (valid_i && ready_o) first_waits_q <= is_first_i;
    if (ready_o) second_q <= is_second_i;
    if (valid_i && ready_o && is_first_i) first_value_q <= sum_i[23:8] + 16'(sum_i[7]);
  end
  always_comb begin
    assume (takes_i);  // one lane
    if (valid_i) begin
      assume (is_second_i == first_waits_q && !(is_first_i && is_second_i));  // texture_levels_stream
      assume (!(is_first_i || is_second_i) || is_between_i);
      assume (is_second_i || is_first_i || part_i == '0);
      assume (sum_i[23:0] <= 24'hff0000);
    end
    if (runs_q) begin
      assert (valid_o == (valid_q && !is_first_q));
      assert (ready_o == (!valid_o || ready_i));
      if (first_waits_q || (valid_q && second_q)) assert (lower_q[23:0] == {first_value_q, 8'd0});
      if (valid_q && is_first_q) assert (first_waits_q && !second_q);
      cover (valid_o && ready_i && part_q != '0);
    end
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q) && $past(valid_o && !ready_i)) begin
    assert (valid_o && tail_o == $past(tail_o) && part_q == $past(part_q));
    assert (lower_q == $past(lower_q) && upper_q == $past(upper_q));
  end
