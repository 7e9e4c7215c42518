
  // A sample without a second level makes one pass, any other two, the first and the second, with the same payload; in
  // order, and an offer stays. `left` is the pass taken last.
  logic            left_first_q;
  logic [TAIL-1:0] left_tail_q, entered_tail_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) left_first_q <= 1'b0;
    else if (valid_o && ready_i) left_first_q <= is_first_o;
    if (valid_o && ready_i) left_tail_q <= tail_o;
    if (scales) entered_tail_q <= tail_i;
  end
  // A sample on offer stays.
  always_ff @(posedge clk_i)
    if (runs_q && $past(runs_q) && $past(valid_i && !ready_o)) begin
      assume (valid_i && part_i == $past(part_i) && tail_i == $past(tail_i));
    end
  always_comb begin
    if (is_second_q) assume (valid_i && has_second && tail_i == entered_tail_q);
    if (runs_q) begin
      assert (ready_o == (scales && (!has_second || is_second_q)));
      assert (is_second_q == (scaled_valid_q ? first_q : wrapped_valid_q ? is_first_o : left_first_q));
      if (scaled_valid_q) begin
        assert (second_q == (wrapped_valid_q ? is_first_o : left_first_q) && !(first_q && second_q));
        assert (tail_q == entered_tail_q);
        if (second_q) assert (tail_q == (wrapped_valid_q ? tail_o : left_tail_q));
        assert ((first_q || second_q) == (part_q != '0));
      end
      if (wrapped_valid_q) begin
        assert (is_second_o == left_first_q && !(is_first_o && is_second_o));
        if (is_second_o) assert (tail_o == left_tail_q);
        assert ((is_first_o || is_second_o) == (level_part_o != '0));
        if (!scaled_valid_q) assert (tail_o == entered_tail_q);
      end else if (!scaled_valid_q && left_first_q) begin
        assert (left_tail_q == entered_tail_q);
      end
      assert (is_empty_o == (!scaled_valid_q && !wrapped_valid_q));
      cover (valid_o && is_second_o && scaled_valid_q && first_q);
    end
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q) && $past(valid_o && !ready_i)) begin
    assert (valid_o && tail_o == $past(tail_o) && offset_o == $past(offset_o) && level_part_o == $past(level_part_o));
  end
