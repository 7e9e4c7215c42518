
  // What hiz.sv takes for granted: a visit starts when it is settled, a clear has no visit under way. And a tile is rejected
  // by a verdict of its own: read at this tile when all was settled, and no visit has started since.
  logic reads, is_good_q;
  logic [TX-1:0] read_x_q;
  logic [TY-1:0] read_y_q;
  assign reads = state_q == WALK;
  always_ff @(posedge clk_i) begin
    is_good_q <= rst_ni && (reads ? is_settled : is_good_q) && !starts_visit && !clears;
    if (reads) {read_y_q, read_x_q} <= {tile_y_q, tile_x_q};
  end
  always_comb if (runs_q) begin
    if (starts_visit) assert (is_settled);
    if (clears) assert (!starts_visit && state_q != WALK);
    if (state_q == BOUND) assert (is_good_q && is_eligible && !is_outside && {read_y_q, read_x_q} == {tile_y_q, tile_x_q});
    if (is_hiz_o) assert (is_good_q && is_eligible && is_behind);
  end
