
  // Each setup ends with exactly one packet that ends the primitive; what is offered stays; no slot is given
  // twice; nothing is stuck that its neighbours do not hold.
  logic under_way_q, ends;
  assign ends = tile_valid_o && tile_ready_i && tile_o.ends_primitive;
  raster_pkg::setup_packet_t g_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) under_way_q <= 1'b0;
    else if (takes) under_way_q <= 1'b1;
    else if (ends) under_way_q <= 1'b0;
    if (takes) g_q <= setup_i;
  end
  // From outside: a box, a slot is freed when one is used.
  always_comb begin
    if (setup_valid_i) assume (setup_i.box.left <= setup_i.box.right && setup_i.box.top <= setup_i.box.bottom);
    if (setup_valid_i) assume (setup_i.kind != raster_pkg::PRIMITIVE_KIND_FAST_CLEAR || (setup_i.box.left == '0 && setup_i.box.top == '0));
    if (setup_valid_i && setup_i.kind != raster_pkg::PRIMITIVE_KIND_TRIANGLE)
      assume (setup_i.dx == '0 && setup_i.dy == '0 && setup_i.edge_value == '0);
    if (slot_free_i) assume (used_q > (SLOT + 1)'(state_q != IDLE));
  end
  always_comb if (runs_q) begin
    assert (under_way_q == (state_q != IDLE));
    if (takes) assert (!under_way_q || ends);
    if (tile_valid_o) assert (under_way_q && tile_o.key.primitive_id == g_q.primitive_id && tile_o.kind == g_q.kind);
    if (under_way_q) assert (s_q == g_q && s_q.box.left <= s_q.box.right && s_q.box.top <= s_q.box.bottom);
    assert (used_q <= (SLOT + 1)'(SLOTS) && used_q >= (SLOT + 1)'(under_way_q));
    assert (state_q <= CLEAR);
    if (state_q == CLEAR) assert (s_q.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR);
    if (under_way_q) assert (s_q.kind != raster_pkg::PRIMITIVE_KIND_FAST_CLEAR || (s_q.box.left == '0 && s_q.box.top == '0));
    if (state_q == WALK || state_q == OFFER) assert (has_walk);
    if (under_way_q) begin
      assert (tile_y_q <= s_q.box.bottom[PY-1:TS] && tile_x_q >= s_q.box.left[PX-1:TS] && tile_x_q <= s_q.box.right[PX-1:TS]);
      assert (start_x_q >= s_q.box.left[PX-1:TS] && start_x_q <= s_q.box.right[PX-1:TS]);
      if (must_return_q) assert (start_x_q != s_q.box.left[PX-1:TS] && !goes_left_q);
      if (!has_walk) assert (start_x_q == s_q.box.left[PX-1:TS] && !goes_left_q && !must_return_q);
    end
    if (state_q == END) assert (is_last_row);
    // With a ready consumer each state moves on when HiZ is settled, which it is soon after every visit has retired.
    if (tile_ready_i && is_settled && (state_q == WALK || state_q == OFFER))
      assert (steps || (state_q == WALK && is_eligible));
    if (tile_ready_i && state_q == END) assert (finishes);
    if (!under_way_q && !setup_ready_o) assert (used_q == (SLOT + 1)'(SLOTS));  // it waits for nothing but a slot
    cover (ends && state_q == END);
    cover (ends && state_q == WALK && takes);
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q) && $past(tile_valid_o && !tile_ready_i)) begin
    assert (tile_valid_o && tile_o == $past(tile_o) && edges_o == $past(edges_o));
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(state_q == PREPARE && visits_are_done && is_settled)) assert (state_q != PREPARE);
    if ($past(state_q == CLEAR)) assert (state_q == END || {tile_y_q, tile_x_q} > $past({tile_y_q, tile_x_q}));
  end

  // What has no edges is outside of none.
  genvar k;
  generate
    for (k = 0; k < 3; k++) begin : gen_proof
      always_comb if (runs_q && under_way_q && !is_triangle) begin
        assert (gen_edge[k].value_q == '0 && gen_edge[k].row_q == '0 && s_q.dx[k*D+:D] == '0 && s_q.dy[k*D+:D] == '0);
        if (state_q != PREPARE) assert (gen_edge[k].best_q == '0);
      end
    end
  endgenerate
