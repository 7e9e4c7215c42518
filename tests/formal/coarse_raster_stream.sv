
  // Each setup ends with exactly one packet that ends the primitive; an offer stays; no slot is assigned twice; the
  // stage is stuck only if a neighbour stalls it. At most two primitives are in the stage: the walked one, and a primitive
  // before it, whose last tile is on offer.
  logic       walked_q, ends, is_ending;
  logic [1:0] owed_q;  // primitives that came and have not ended
  raster_pkg::setup_packet_t g_q;
  raster_pkg::tile_packet_t  left_g_q;
  assign ends      = tile_valid_o && tile_ready_i && tile_o.ends_primitive;
  assign is_ending = left_valid_q && left_q.ends_primitive;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      walked_q <= 1'b0;
      owed_q   <= '0;
    end else begin
      walked_q <= takes || (walked_q && !finishes);
      owed_q   <= owed_q + 2'(takes) - 2'(ends);
    end
    if (takes) g_q <= setup_i;
    if (enters) left_g_q.key.primitive_id <= g_q.primitive_id;
    if (enters) left_g_q.kind <= g_q.kind;
  end
  // From outside: a box, a slot is freed when one is used.
  always_comb begin
    if (setup_valid_i) assume (setup_i.box.left <= setup_i.box.right && setup_i.box.top <= setup_i.box.bottom);
    if (setup_valid_i) assume (setup_i.kind != raster_pkg::PRIMITIVE_KIND_FAST_CLEAR || (setup_i.box.left == '0 && setup_i.box.top == '0));
    if (setup_valid_i && setup_i.kind != raster_pkg::PRIMITIVE_KIND_TRIANGLE)
      assume (setup_i.dx == '0 && setup_i.dy == '0 && setup_i.edge_value == '0);
    if (slot_free_i) assume (used_q > (SLOT + 1)'(state_q != IDLE) + (SLOT + 1)'(is_ending));
  end
  always_comb if (runs_q) begin
    assert (walked_q == (state_q != IDLE));
    assert (owed_q == 2'(walked_q) + 2'(is_ending));
    if (takes) assert (!walked_q);
    if (tile_valid_o) assert (tile_o.key.primitive_id == left_g_q.key.primitive_id && tile_o.kind == left_g_q.kind);
    if (left_valid_q) begin
      assert (left_q.key.primitive_id == left_g_q.key.primitive_id && left_q.kind == left_g_q.kind);
      assert (left_q.slot == (left_q.ends_primitive ? slot_q - SLOT'(1) : slot_q));
      if (!left_q.ends_primitive) assert (state_q == WALK && left_q.is_visit && left_q.key.primitive_id == g_q.primitive_id);
    end
    if (walked_q) assert (s_q == g_q && s_q.box.left <= s_q.box.right && s_q.box.top <= s_q.box.bottom);
    assert (used_q <= (SLOT + 1)'(SLOTS) && used_q >= (SLOT + 1)'(walked_q) + (SLOT + 1)'(is_ending));
    assert (state_q <= PASS);
    if (state_q == CLEAR || state_q == PASS) assert (s_q.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR);
    if (walked_q) assert (s_q.kind != raster_pkg::PRIMITIVE_KIND_FAST_CLEAR || (s_q.box.left == '0 && s_q.box.top == '0));
    if (state_q == WALK) assert (has_walk);
    if (walked_q) begin
      assert (tile_y_q <= s_q.box.bottom[PY-1:TS] && tile_x_q >= s_q.box.left[PX-1:TS] && tile_x_q <= s_q.box.right[PX-1:TS]);
      assert (start_x >= s_q.box.left[PX-1:TS] && start_x <= s_q.box.right[PX-1:TS]);
      if (must_return_q) assert (start_x != s_q.box.left[PX-1:TS] && !goes_left_q);
      if (!has_walk) assert (start_x == s_q.box.left[PX-1:TS] && !goes_left_q && !must_return_q);
    end
    // What is known a cycle ahead is so of the tile then.
    if (state_q == WALK) assert (is_last_column_q == (goes_left_q ? is_leftmost : is_rightmost) && is_last_row_q == is_last_row);
    if (state_q == WALK) assert (no_better_ahead_q == (goes_left_q ? no_better_left_q : no_better_right_q));
    if (clears)
      assert (is_last_column_q == ((tile_x_q ^ s_q.box.right[PX-1:TS]) >> raster_pkg::HIZ_GROUP_BITS == '0) &&
              is_last_row_q == is_last_row);
    if (state_q == PASS) assert (is_last_row && tile_x_q == s_q.box.right[PX-1:TS]);
    // With a ready consumer a tile goes on when HiZ is settled, soon after every visit has retired, and the walk goes
    // on with it: at once, or, where bounds matter, when the tile's bound has been read, which takes a cycle.
    if (left_valid_q && tile_ready_i && is_settled) assert (left_is_free);
    if (left_is_free && state_q == WALK && (is_outside || !is_eligible_q)) assert (steps);
    if (!left_valid_q && state_q == WALK && has_bound_q) assert (steps);
    if (left_is_free && passes_token) assert (finishes);
    if (!walked_q && !setup_ready_o) assert (used_q == (SLOT + 1)'(SLOTS));  // it waits only for a slot
    cover (ends && !is_visit);
    cover (ends && takes);
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q) && $past(tile_valid_o && !tile_ready_i)) begin
    assert (tile_valid_o && tile_o == $past(tile_o) && edges_o == $past(edges_o));
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(state_q == WALK && is_settled && !left_valid_q)) assert (has_bound_q);
    if ($past(state_q == PREPARE && visits_are_done && !left_valid_q)) assert (state_q != PREPARE);
    if ($past(state_q == CLEAR)) assert (state_q == PASS || {tile_y_q, tile_x_q} > $past({tile_y_q, tile_x_q}));
  end

  // A primitive without edges is outside none.
  genvar k;
  generate
    for (k = 0; k < 3; k++) begin : gen_proof
      always_comb if (runs_q && state_q != IDLE && !is_triangle) begin
        assert (gen_edge[k].value_q == '0 && (starts || is_start_q || gen_edge[k].row_q == '0) && s_q.dx[k*D+:D] == '0 && s_q.dy[k*D+:D] == '0);
        if (!starts) assert (!edge_is_outside_q[k]);
      end
    end
  endgenerate
