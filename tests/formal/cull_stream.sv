
  // Each primitive is offered once or dropped once, with its own number; what is offered stays. The multipliers' results
  // may be anything.
  logic under_way_q, sends, drops;
  assign sends = triangle_valid_o && triangle_ready_i;
  assign drops = is_dropped_o;
  logic [raster_pkg::PRIMITIVE_ID_BITS-1:0] id_q;
  logic [3:0] waits_q;  // cycles since it was taken, without those in which it was on offer
  always_ff @(posedge clk_i) begin
    if (!rst_ni) under_way_q <= 1'b0;
    else if (takes) under_way_q <= 1'b1;
    else if (sends || drops) under_way_q <= 1'b0;
    if (takes) id_q <= primitive_i.primitive_id;
    if (!rst_ni || takes || step_q == IDLE) waits_q <= '0;
    else if (step_q != OFFER) waits_q <= waits_q + 4'd1;
  end
  logic issued_before_q;  // the cross product has it; with edge_done its result is there
  always_ff @(posedge clk_i) issued_before_q <= rst_ni && edge_start;
  logic [1:0] in_flight;
  assign in_flight = 2'(issued_before_q) + 2'(edge_done);
  always_comb if (runs_q) begin
    assert (under_way_q == (step_q != IDLE));
    assert (!(sends && drops));
    if (takes) assert (!under_way_q || sends || drops);  // none is overtaken
    if (sends) assert (triangle_o.primitive_id == id_q);
    if (under_way_q) assert (p_q.primitive_id == id_q);
    if (step_q == OFFER && triangle_ready_i) assert (sends || drops);
    assert (waits_q <= 4'd7);  // no deadlock: at the latest then it is offered or dropped
    // For induction: what of the three edges is issued, under way and there.
    if (step_q == EDGES) assert (issued_q == edge_count_q + in_flight && issued_q <= 2'd3 && edge_count_q != 2'd3);
    if (step_q != EDGES) assert (in_flight == 2'd0);
    if (step_q == ROTATE) assert (issued_q == 2'd0 && edge_count_q == 2'd0 && waits_q <= 4'd1);
    if (step_q == ROTATE && waits_q == 4'd1) assert (is_0_first || is_1_first);
    if (step_q == EDGES) assert (waits_q >= 4'd1);
    if (step_q == EDGES && issued_q != 2'd3) assert (waits_q <= 4'd2 + 4'(issued_q));
    if (step_q == EDGES && issued_q == 2'd3) assert (waits_q <= 4'd4 + 4'(edge_count_q));
    cover (sends && takes);
    cover (drops);
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q) && $past(triangle_valid_o && !triangle_ready_i)) begin
    assert (triangle_valid_o && triangle_o == $past(triangle_o));
  end
