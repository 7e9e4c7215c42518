
  // Guarantees of coarse_raster and depth_test: a visit starts when the stage is settled (coarse_raster_hiz); it
  // retires once, after earlier ones; a clear waits for all of them.
  localparam int U = N + 1;
  logic [N:0] unseen, unseen_retired;  // visits not yet seen; visits of these that have retired
  assign unseen         = started_q - seen_q;
  assign unseen_retired = retired_q - seen_q;
  always_comb begin
    if (starts_visit_i) assume (is_settled_o);
    if (retire_valid_i) assume (!visits_are_done_o);
    if (clears_i) assume (visits_are_done_o && !starts_visit_i && !reads_i && !passes_i);
  end

  // The counts: seen visits have retired, retired visits have started, at most LAG are not seen.
  always_comb if (runs_q) begin
    assert (unseen <= U'(LAG) && unseen_retired <= unseen);
    if (has_update_q) assert (unseen_retired != '0);
    assert (is_settled_o == (unseen != U'(LAG)));
  end
  // When all visits have retired, the stage is settled two cycles later.
  logic done_q, done_before_q;
  always_ff @(posedge clk_i) begin
    done_q        <= rst_ni && visits_are_done_o && !starts_visit_i;
    done_before_q <= done_q && visits_are_done_o && !starts_visit_i;
  end
  always_comb if (runs_q && done_q && unseen != '0 && !is_settled_o && done_before_q) assert (has_update_q);
  always_comb if (runs_q && !is_settled_o && has_update_q) assert (sees || clears_i);
