
  // An arbitrary tile of the stream, and an arbitrary stamp of it: the stamp is sent once if a sample of it is covered,
  // with the mask of its row, in order, and the visit ends once, with its last packet.
  (* anyconst *) logic [PIXEL-1:0]  any_row;     // first pixel row of a row of stamps
  (* anyconst *) logic [COLUMN-1:0] any_column;  // column of stamps
  (* anyseq *)   logic              pick;
  logic in_rows_q, in_coverage_q, in_stamps_q, done_q, sent_q;  // place of the chosen tile
  logic [SAMPLES-1:0] want_q;                    // mask of the stamp, once its row has been looked at
  logic               has_want_q;
  logic [PIXEL:0]     last_q;                    // 1 + column of the last stamp of this row that was sent; 0: none
  raster_pkg::tile_packet_t g_q;
  logic picks, sends_it;
  assign picks     = takes_tile && pick && !in_rows_q && !in_coverage_q && !in_stamps_q && !done_q;
  assign sends_it  = stamp_leaves && in_stamps_q && mask != '0 && column == any_column && stamps_y_q == any_row;

  always_comb assume ((any_row & PIXEL'(STAMP - 1)) == '0 && {1'b0, any_column} < (COLUMN + 1)'(PER_ROW));
  // From coarse_raster: a non-empty box.
  always_comb if (tile_valid_i) assume (tile_i.box.top <= tile_i.box.bottom && tile_i.box.left <= tile_i.box.right);

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      in_rows_q   <= 1'b0;
      in_coverage_q <= 1'b0;
      in_stamps_q <= 1'b0;
      done_q      <= 1'b0;
      sent_q      <= 1'b0;
      has_want_q  <= 1'b0;
      want_q      <= '0;
    end else begin
      if (picks) begin
        in_rows_q <= 1'b1;
        g_q       <= tile_i;
      end else if (row_leaves && is_last_row) in_rows_q <= 1'b0;
      if (coverage_ready) in_coverage_q <= in_rows_q && row_valid_q;
      if (stamps_ready) in_stamps_q <= in_coverage_q && coverage_valid_q && row_is_sent;
      if (in_rows_q && row_leaves && g_q.is_visit && y_q == any_row) begin
        want_q     <= covered[32'(any_column)*SAMPLES+:SAMPLES];
        has_want_q <= 1'b1;
      end
      if (sends_it) sent_q <= 1'b1;
      if (stamp_leaves && in_stamps_q && stamps_last_row_q && is_last_stamp_q) done_q <= 1'b1;
    end
    if (stamps_ready) last_q <= '0;
    else if (stamp_leaves) last_q <= (PIXEL + 1)'(column) + 1'b1;
  end

  logic [SAMPLES-1:0] left_of_it;  // samples of the stamp still to be sent
  assign left_of_it = pending_q[32'(any_column)*SAMPLES+:SAMPLES];
  logic row_has_passed;
  assign row_has_passed = g_q.is_visit && any_row >= ((g_q.box.top >> STAMP_SHIFT) << STAMP_SHIFT) && any_row <= g_q.box.bottom;

  always_comb if (runs_q) begin
    // Nothing is lost or sent twice.
    if (sends_it) assert (!sent_q && has_want_q && mask == want_q);
    if (done_q) assert (sent_q == (want_q != '0) && has_want_q == row_has_passed);
    if (done_q) assert (!in_rows_q && !in_coverage_q && !in_stamps_q);
    if (stamp_leaves && in_stamps_q) begin
      assert (stamp_o.key == g_q.key && stamp_o.slot == g_q.slot && stamp_o.kind == g_q.kind);
      assert (stamp_o.ends_visit == (g_q.is_visit && stamps_last_row_q && is_last_stamp_q));
      assert (stamp_o.ends_primitive == (g_q.ends_primitive && stamps_last_row_q && is_last_stamp_q));
      if (mask != '0) assert ((PIXEL + 1)'(column) >= last_q);  // in order
    end
    // No deadlock: while the consumer is ready, a row moves on or a stamp leaves.
    if (stamp_ready_i && row_valid_q) assert (row_leaves || stamp_leaves);
    if (stamp_ready_i && coverage_valid_q) assert (coverage_ready || stamp_leaves);
    if (stamp_ready_i && stamps_valid_q) assert (stamp_leaves);

    // For induction: the place of the chosen tile, and the state of the stamp.
    if (stamps_valid_q) assert (is_last_stamp_q == is_one_stamp(pending_q));
    if (in_rows_q) assert (row_valid_q && tile_q == g_q && !done_q);
    if (in_coverage_q) assert (coverage_valid_q && coverage_tile_q == g_q && !done_q && coverage_last_row_q == !in_rows_q);
    if (in_stamps_q) assert (stamps_valid_q && stamp_tile_q == g_q && !done_q);
    if (in_stamps_q) assert (stamps_last_row_q == (!in_rows_q && !in_coverage_q));
    if (row_valid_q) assert ((y_q & PIXEL'(STAMP - 1)) == '0 && tile_q.box.top <= tile_q.box.bottom);
    if (row_valid_q) assert (y_q <= tile_q.box.bottom && (y_q >> STAMP_SHIFT) >= (tile_q.box.top >> STAMP_SHIFT));
    if (in_rows_q && y_q <= any_row) assert (!has_want_q);
    if (in_rows_q && y_q > any_row) assert (has_want_q == row_has_passed);
    if (!in_rows_q && (in_coverage_q || in_stamps_q || done_q)) assert (has_want_q == row_has_passed);
    if (!in_rows_q && !in_coverage_q && !in_stamps_q && !done_q) assert (!has_want_q && !sent_q);
    if (!has_want_q) assert (want_q == '0 && !sent_q);
    if (sent_q) assert (want_q != '0);
    if (in_coverage_q && coverage_y_q == any_row && g_q.is_visit)
      assert (has_want_q && !sent_q && covered_q[32'(any_column)*SAMPLES+:SAMPLES] == want_q);
    if (in_stamps_q && stamps_y_q == any_row && g_q.is_visit) assert (has_want_q && left_of_it == (sent_q ? '0 : want_q));
    if (has_want_q && !(in_stamps_q && stamps_y_q == any_row) && !(in_coverage_q && coverage_y_q == any_row))
      assert (sent_q == (want_q != '0));
    if (in_coverage_q && in_rows_q) assert (coverage_y_q < y_q);
    if (in_stamps_q && in_rows_q) assert (stamps_y_q < y_q);
    if (in_stamps_q && in_coverage_q) assert (stamps_y_q < coverage_y_q);
    if (row_valid_q && !tile_q.is_visit) assert (is_last_row && covered == '0);
    if (coverage_valid_q && !coverage_tile_q.is_visit) assert (coverage_last_row_q && covered_q == '0);
    if (stamps_valid_q && !stamp_tile_q.is_visit) assert (pending_q == '0);
    if (in_rows_q && !g_q.is_visit) assert (!in_coverage_q && !in_stamps_q);
    if (in_coverage_q && !g_q.is_visit) assert (!in_stamps_q);
    if (stamps_valid_q && !stamps_last_row_q) assert (pending_q != '0);
    if (in_coverage_q || in_stamps_q) assert (g_q.box.top <= g_q.box.bottom);
    if (in_coverage_q) assert (coverage_y_q <= g_q.box.bottom && (coverage_y_q & PIXEL'(STAMP - 1)) == '0);
    if (in_coverage_q && g_q.is_visit) assert (coverage_y_q >= ((g_q.box.top >> STAMP_SHIFT) << STAMP_SHIFT));
    if (in_coverage_q && coverage_last_row_q && g_q.is_visit)
      assert ((coverage_y_q >> STAMP_SHIFT) == (g_q.box.bottom >> STAMP_SHIFT));
    if (in_stamps_q) assert (stamps_y_q <= g_q.box.bottom && (stamps_y_q & PIXEL'(STAMP - 1)) == '0);
    if (in_stamps_q && g_q.is_visit) assert (stamps_y_q >= ((g_q.box.top >> STAMP_SHIFT) << STAMP_SHIFT));
    if (in_stamps_q && stamps_last_row_q && g_q.is_visit)
      assert ((stamps_y_q >> STAMP_SHIFT) == (g_q.box.bottom >> STAMP_SHIFT));
    cover (done_q && sent_q);
  end
  genvar k;
  generate
    for (k = 0; k < PER_ROW; k++) begin : gen_proof
      always_comb if (runs_q && stamps_valid_q && pending_q[k*SAMPLES+:SAMPLES] != '0) assert ((PIXEL + 1)'(k) >= last_q);
    end
  endgenerate
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q) && $past(stamp_valid_o && !stamp_ready_i)) begin
    assert (stamp_valid_o && stamp_o == $past(stamp_o));
  end
