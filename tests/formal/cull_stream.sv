
  // Each primitive is offered once or dropped once, with its own number; an offer stays. The multipliers' results may
  // be anything. The primitives in the two parts, tracked again:
  logic in_sort_q, in_decide_q, takes, sends, drops;
  logic [raster_pkg::PRIMITIVE_ID_BITS-1:0] sorted_id_q, decided_id_q;
  assign takes = primitive_valid_i && primitive_ready_o;
  assign sends = triangle_valid_o && triangle_ready_i;
  assign drops = is_dropped_o;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      in_sort_q   <= 1'b0;
      in_decide_q <= 1'b0;
    end else begin
      in_sort_q   <= takes || (in_sort_q && !hands_over);
      in_decide_q <= hands_over || (in_decide_q && !sends && !drops);
    end
    if (takes) sorted_id_q <= primitive_i.primitive_id;
    if (hands_over) decided_id_q <= sorted_id_q;
  end
  always_comb if (runs_q) begin
    assert (in_sort_q == sort_busy_q && in_decide_q == decide_busy_q);
    assert (!(sends && drops));
    if (takes) assert (!in_sort_q || hands_over);  // none is overtaken
    if (hands_over) assert (in_sort_q && (!in_decide_q || sends || drops));
    if (in_sort_q) assert (p_q.primitive_id == sorted_id_q);
    if (in_decide_q) assert (id_q == decided_id_q);
    if (sends) assert (in_decide_q && triangle_o.primitive_id == decided_id_q);
    if (drops) assert (in_decide_q);
    // No deadlock: four steps a part, and then the primitive goes on as soon as the one ahead is gone.
    if (in_decide_q && decide_step_q == 2'd3 && triangle_ready_i) assert (sends || drops);
    if (in_sort_q && sort_step_q == 2'd3 && (!in_decide_q || sends || drops)) assert (hands_over);
    // The edges are in turn: the later primitive is never a step further.
    if (in_sort_q && in_decide_q) assert (decide_step_q >= sort_step_q);
    // Flags known a cycle ahead.
    if (in_decide_q) assert (is_zero_q == (area_q == '0));
    if (in_decide_q && decide_step_q != '0)
      assert (has_2x2_q == (d_is_triangle && columns <= 3'd1 && rows <= 3'd1) && has_column_q == (columns != '0) &&
              has_row_q == (rows != '0));
    cover (sends && takes && hands_over);
    cover (drops);
  end
  logic [1:0] sort_was_q, decide_was_q;
  logic       sorts_on_q, decides_on_q;
  always_ff @(posedge clk_i) begin
    sort_was_q   <= sort_step_q;
    decide_was_q <= decide_step_q;
    sorts_on_q   <= rst_ni && in_sort_q && sort_step_q != 2'd3;
    decides_on_q <= rst_ni && in_decide_q && decide_step_q != 2'd3;
  end
  always_comb if (runs_q) begin
    if (sorts_on_q) assert (in_sort_q && sort_step_q == sort_was_q + 2'd1);
    if (decides_on_q) assert (in_decide_q && decide_step_q == decide_was_q + 2'd1);
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q) && $past(triangle_valid_o && !triangle_ready_i)) begin
    assert (triangle_valid_o && triangle_o == $past(triangle_o));
  end
