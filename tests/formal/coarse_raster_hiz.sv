
  // Assumptions of hiz.sv: a visit starts when the stage is settled, a clear has no visit under way. And a tile is
  // rejected by its own verdict: read at this tile when the stage was settled, with no visit started since or waiting
  // to start.
  logic is_good_q;
  logic [TX-1:0] read_x_q;
  logic [TY-1:0] read_y_q;
  always_ff @(posedge clk_i) begin
    is_good_q <= rst_ni && (reads_bound ? is_settled : is_good_q) && !starts_visit && !clears;
    if (reads_bound) {read_y_q, read_x_q} <= {read_y, read_x};
  end
  always_comb if (runs_q) begin
    if (starts_visit) assert (is_settled);
    if (clears) assert (!starts_visit && !reads_bound && !(left_valid_q && is_visit));
    if (has_bound_q) assert (is_good_q && is_settled);
    if (state_q == WALK && is_eligible_q && has_bound_q && !is_outside)
      assert ({read_y_q, read_x_q} == {tile_y_q, tile_x_q});
    if (state_q == WALK && enters && is_eligible_q && !is_outside)
      assert (is_good_q && !starts_visit && !(left_valid_q && is_visit));
    if (left_valid_q && is_dropped) assert (!tile_valid_o);
    cover (left_valid_q && left_behind);
  end
