
  // The bound of a visit that covered its tile with all depths passed: not below the depths of the tile's four corners.
  // The depths of a visit are a plane, rounded and clamped, so that the largest is at a corner. From fine_raster: the
  // stamps of a visit come in ascending order, each once. After its end the state is as before: one visit stands for
  // all.
  localparam int LAST = STAMPS - 1;
  localparam int PER_ROW = raster_pkg::STAMPS_PER_ROW;
  (* anyconst *) logic [CODE-1:0] c00, c01, c10, c11;  // of the chosen visit: row, column
  logic [STAMP_BITS:0] next_q;  // the stamps below this one have come or never will
  logic is_visit_stamp;
  assign is_visit_stamp = fragment_i.mask != '0 && !fragment_i.kind[1];
  always_ff @(posedge clk_i) begin
    if (!rst_ni) next_q <= '0;
    else if (takes_fragment && fragment_i.ends_visit) next_q <= '0;
    else if (takes_fragment && is_visit_stamp) next_q <= (STAMP_BITS + 1)'(fragment_i.stamp) + 1'b1;
  end
  always_comb if (is_visit_stamp) begin
    assume ((STAMP_BITS + 1)'(fragment_i.stamp) >= next_q);
    if (fragment_i.stamp == '0) assume (fragment_i.code[0+:CODE] == c00);
    if (32'(fragment_i.stamp) == PER_ROW - 1) assume (fragment_i.code[(STAMP-1)*CODES+:CODE] == c01);
    if (32'(fragment_i.stamp) == LAST - (PER_ROW - 1)) assume (fragment_i.code[(SAMPLES-STAMP)*CODES+:CODE] == c10);
    if (32'(fragment_i.stamp) == LAST) assume (fragment_i.code[(SAMPLES-1)*CODES+:CODE] == c11);
  end
  // A pixel of a line has no visit to end; a packet without samples changes and sends nothing else.
  always_comb if (fragment_i.kind[1]) assume (!fragment_i.ends_visit);

  // Content of D1: the stamps up to the stamp in fragment_q.
  logic [STAMP_BITS:0] before_q;  // next_q when that stamp was taken
  always_ff @(posedge clk_i) before_q <= next_q;
  logic [HIZ-1:0] h00, h01, h10, h11;
  assign {h00, h01, h10, h11} = {c00[CODE-1-:HIZ], c01[CODE-1-:HIZ], c10[CODE-1-:HIZ], c11[CODE-1-:HIZ]};
  logic holds_stamp;
  assign holds_stamp = is_stamp && !fragment_q.kind[1];
  always_comb if (runs_q && holds_stamp) begin  // assumptions made when the stamp came
    assert ((STAMP_BITS + 1)'(fragment_q.stamp) >= before_q);
    if (fragment_q.stamp == '0) assert (depth[0+:CODE] == c00);
    if (32'(fragment_q.stamp) == PER_ROW - 1) assert (depth[(STAMP-1)*CODE+:CODE] == c01);
    if (32'(fragment_q.stamp) == LAST - (PER_ROW - 1)) assert (depth[(SAMPLES-STAMP)*CODE+:CODE] == c10);
    if (32'(fragment_q.stamp) == LAST) assert (depth[(SAMPLES-1)*CODE+:CODE] == c11);
  end
  always_comb if (runs_q && valid_q)
    assert (next_q == (fragment_q.ends_visit ? '0 : holds_stamp ? (STAMP_BITS + 1)'(fragment_q.stamp) + 1'b1 : before_q));
  logic [STAMP_BITS:0] done;
  assign done = valid_q ? before_q : next_q;  // the position that max_q and `full_stamps` include
  // What is counted a cycle late, as it is with the stamp in fragment_q.
  logic [STAMP_BITS-1:0] full_stamps;
  logic any_passed, sets, clears, sets_q, clears_q;
  assign full_stamps = retire_valid_o ? '0 : gen_hiz.full_stamps_q + STAMP_BITS'(gen_hiz.in_visit_q && gen_hiz.is_full_q);
  assign any_passed  = !retire_valid_o && (gen_hiz.any_passed_q || (gen_hiz.in_visit_q && gen_hiz.any_kept_q));
  assign sets        = fragment_q.state.depth_write && kept == '1 && !is_late && full_stamps == STAMP_BITS'(LAST);
  assign clears      = fragment_q.state.depth_write && greater_passes && (any_passed || kept != '0);
  always_ff @(posedge clk_i) {sets_q, clears_q} <= {sets, clears};
  always_comb if (runs_q) begin
    assert (next_q <= (STAMP_BITS + 1)'(STAMPS));
    if (retire_valid_o) assert (gen_hiz.sets == sets_q && gen_hiz.clears == clears_q);
    assert ((STAMP_BITS + 1)'(full_stamps) <= done);
    // For the corners that have come.
    if ((STAMP_BITS + 1)'(full_stamps) == done && done <= (STAMP_BITS + 1)'(LAST)) begin
      if (32'(done) > 0) assert (gen_hiz.max_q >= h00);
      if (32'(done) > PER_ROW - 1) assert (gen_hiz.max_q >= h01);
      if (32'(done) > LAST - (PER_ROW - 1)) assert (gen_hiz.max_q >= h10);
    end
    if (valid_q && fragment_q.ends_visit && sets)
      assert (gen_hiz.max >= h00 && gen_hiz.max >= h01 && gen_hiz.max >= h10 && gen_hiz.max >= h11);
    // A visit that can raise a depth without setting the bound clears it.
    if (valid_q && fragment_q.ends_visit && fragment_q.state.depth_write && greater_passes && (passed != '0 || any_passed))
      assert (sets || clears);
    if (retire_o.update == raster_pkg::HIZ_UPDATE_CLEAR) assert (retire_o.hiz_code == '1);
    assert (done <= (STAMP_BITS + 1)'(STAMPS));
  end
