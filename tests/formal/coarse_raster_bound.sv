
  // hiz.sv: a verdict stays until the next read (hiz_bound), and while it is settled that is so until a visit starts.
  logic was_behind_q, was_settled_q, is_bound_q;
  always_ff @(posedge clk_i) begin
    was_behind_q  <= is_behind;
    was_settled_q <= is_settled && !starts_visit;
    is_bound_q    <= state_q == BOUND;
  end
  always_comb if (runs_q) begin
    if (is_bound_q && state_q == BOUND) assume (is_behind == was_behind_q);
    if (was_settled_q) assume (is_settled);
  end
