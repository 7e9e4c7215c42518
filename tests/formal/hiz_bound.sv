
  // An arbitrary tile, from the fast clear that gave it its bound. For any visits to the tile: `farthest_g` is its
  // largest depth in program order, the stored bits. A visit that cannot raise a depth keeps or lowers it; the visit's
  // update at retirement is not below it (depth_test_hiz). (1) A verdict uses the bound after the visits up to number n
  // - LAG, exactly. (2) If it rejects, the real depth test fails for any fragment not before depth_min against any
  // depth that the tile may hold, after all visits below n.
  localparam int CODE = raster_pkg::DEPTH_CODE_BITS;
  localparam int CODES = raster_pkg::ALL_CODE_BITS;
  localparam int SAMPLES = raster_pkg::SAMPLES;
  (* anyconst *) logic [TX-1:0] any_x;
  (* anyconst *) logic [TY-1:0] any_y;
  (* anyseq *) logic [HIZ-1:0] any_farthest;
  (* anyseq *) logic any_silence;
  logic [N-1:0] newest, retires;  // places in the ring of the starting and of the retiring visit
  assign newest  = started_q[N-1:0];
  assign retires = retired_q[N-1:0];
  (* anyseq *) logic is_it;  // the starting visit is in this tile
  logic reads_it, clears_it, raises, line_raises;
  assign reads_it  = read_x_i == any_x && read_y_i == any_y;
  logic clears_group;  // the tile is in the group being cleared
  assign clears_group = tile_x_i >> GROUP == any_x >> GROUP && tile_y_i == any_y;
  assign clears_it    = clears_i && clears_group;
  assign raises      = raises_i;
  assign line_raises = setup_i.state.depth_write && setup_i.state.depth_test[2];

  // For each visit not yet seen: whether it is in this tile, may raise depths, has no update; the farthest depth after
  // it; its update.
  logic [LAG-1:0]     is_it_g, raises_g, is_silent_g;
  logic [LAG*HIZ-1:0] farthest_of_g, code_g;
  logic [HIZ-1:0]     farthest_g, seen_farthest_g, bound_g;
  logic               has_bound_q, in_clear_q;
  logic               forgets;  // a fast clear of depth has come
  assign forgets = passes_i && setup_i.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR && setup_i.state.depth_write;
  logic sees_it;
  assign sees_it = sees && is_it_g[seen_q[N-1:0]];
  always_ff @(posedge clk_i) begin
    in_clear_q <= rst_ni && clears_i && (clears_group || in_clear_q);
    if (!rst_ni || forgets) has_bound_q <= 1'b0;
    else if (clears_i) has_bound_q <= clears_group || in_clear_q;
    if (clears_it) begin
      bound_g         <= setup_i.range.low[Z-1-:HIZ];
      farthest_g      <= setup_i.range.low[Z-1-:HIZ];
      seen_farthest_g <= setup_i.range.low[Z-1-:HIZ];
    end else begin
      if (sees_it && !is_silent_g[seen_q[N-1:0]]) bound_g <= code_g[32'(seen_q[N-1:0])*HIZ+:HIZ];
      if (sees) seen_farthest_g <= farthest_of_g[32'(seen_q[N-1:0])*HIZ+:HIZ];
      if (starts_visit_i && is_it) farthest_g <= any_farthest;
    end
    if (starts_visit_i) begin
      is_it_g[newest]                         <= is_it;
      raises_g[newest]                        <= raises;
      is_silent_g[newest]                     <= any_silence;
      farthest_of_g[32'(newest)*HIZ+:HIZ] <= is_it ? any_farthest : farthest_g;
    end
    if (retire_valid_i) code_g[32'(retires)*HIZ+:HIZ] <= retire_i.hiz_code;
  end
  logic retires_it;
  assign retires_it = retire_i.key.tile_x == any_x && retire_i.key.tile_y == any_y;
  always_comb begin
    assume (32'(any_y) < raster_pkg::TILES_Y && 32'(tile_y_i) < raster_pkg::TILES_Y);
    if (starts_visit_i && is_it && (!raises || any_silence)) assume (any_farthest <= farthest_g);
    if (retire_valid_i) begin
      assume (retires_it == is_it_g[retires]);
      if (retires_it) begin
        assume ((retire_i.update == raster_pkg::HIZ_UPDATE_NONE) == is_silent_g[retires]);
        assume (is_silent_g[retires] || retire_i.hiz_code >= farthest_of_g[32'(retires)*HIZ+:HIZ]);
      end
    end
  end

  // The RAMs are cut out. Assumed from sram_word: a read gives the last write of an earlier cycle; a word written in
  // the same cycle is arbitrary.
  logic           is_it_q, is_silent_q, is_said_q;
  logic [HIZ-1:0] code_q, word_q;
  logic           has_word_q;
  always_ff @(posedge clk_i) begin
    is_said_q   <= !(retire_valid_i && retires == seen_next[N-1:0]);
    is_it_q     <= is_it_g[seen_next[N-1:0]];
    is_silent_q <= is_silent_g[seen_next[N-1:0]];
    code_q      <= code_g[32'(seen_next[N-1:0])*HIZ+:HIZ];
    if (reads_i) begin
      has_word_q <= reads_it && !sees && !clears_i;
      word_q     <= bound_g;
    end
  end
  logic says_it;
  assign says_it = gen_hiz.update_x == any_x && gen_hiz.update_y == any_y;
  always_comb if (runs_q) begin
    if (has_update_q && is_said_q) begin
      assume (says_it == is_it_q);
      if (is_it_q) assume (gen_hiz.has_news == !is_silent_q && gen_hiz.update_code == code_q);
    end
    if (has_word_q) assume (gen_hiz.bound == word_q);
  end

  // Number of seen visits since the clear: all up to n - LAG and no other.
  logic [N-1:0] since_g;  // visits since the clear, LAG - 1 at most
  always_ff @(posedge clk_i) begin
    if (!rst_ni || clears_i) since_g <= '0;
    else if (starts_visit_i) since_g <= since_g + N'(since_g != '1);
  end
  // A verdict is good: it was read when the stage was settled, and no visit has started since.
  logic is_good_q, is_good;
  assign is_good = reads_i ? is_settled_o && reads_it && has_bound_q : is_good_q;
  always_ff @(posedge clk_i) is_good_q <= rst_ni && is_good && !starts_visit_i && !clears_i && !forgets;
  always_comb if (runs_q) begin
    if (has_update_q) assert (is_said_q && is_it_q == is_it_g[seen_q[N-1:0]] && is_silent_q == is_silent_g[seen_q[N-1:0]] &&
                              code_q == code_g[32'(seen_q[N-1:0])*HIZ+:HIZ]);
    if (is_settled_o) assert (unseen == {1'b0, since_g});
    else assert (since_g == '1);
    if (sees_it && has_bound_q) assert (gen_hiz.has_news == !is_silent_q);
    if (is_good_q) begin
      assert (has_bound_q && has_word_q && is_settled_o && word_q == bound_g);
      assert (gen_hiz.bound == bound_g);  // (1)
    end
    if (in_clear_q) assert (unseen == '0 && has_bound_q);
    // No visit between may have raised a depth.
    if (has_bound_q) begin
      assert (bound_g >= seen_farthest_g);
      if (unseen == '0) assert (farthest_g == seen_farthest_g);
      if (is_settled_o && gen_hiz.quiet_q == '1) assert (farthest_g <= seen_farthest_g);
    end
  end
  genvar k;
  generate
    for (k = 0; k < LAG; k++) begin : gen_visit
      localparam int BEFORE = (k + LAG - 1) % LAG;
      logic [N-1:0]   age;     // visits between it and the oldest unseen one
      logic [N-1:0]   youth;   // visits between it and the newest
      logic [HIZ-1:0] before;  // the farthest depth before it
      assign age    = N'(k) - seen_q[N-1:0];
      assign youth  = newest - N'(k) - N'(1);
      assign before = age == '0 ? seen_farthest_g : farthest_of_g[BEFORE*HIZ+:HIZ];
      always_comb if (runs_q && {1'b0, age} < unseen) begin
        if (raises_g[k]) assert (gen_hiz.quiet_q <= youth);
        if (has_bound_q) begin
          if (!raises_g[k] || is_silent_g[k] || !is_it_g[k]) assert (farthest_of_g[k*HIZ+:HIZ] <= before);
          if (youth == '0) assert (farthest_of_g[k*HIZ+:HIZ] == farthest_g);
          // The visits between it and the newest raised no depth if all is quiet.
          if (gen_hiz.quiet_q > youth) assert (farthest_g <= farthest_of_g[k*HIZ+:HIZ] && !raises_g[k]);
        end
        if ({1'b0, age} < unseen_retired && is_it_g[k] && !is_silent_g[k])
          assert (code_g[k*HIZ+:HIZ] >= farthest_of_g[k*HIZ+:HIZ]);
      end
    end
  endgenerate

  // A verdict belongs to a primitive that has been present for a cycle.
  raster_pkg::setup_packet_t was_setup_q;
  logic is_behind_o, has_stood, was_is_equal_behind;
  always_ff @(posedge clk_i) was_setup_q <= setup_i;
  assign was_is_equal_behind = was_setup_q.state.depth_test == raster_pkg::DEPTH_FUNC_LESS &&
                               (CODE == HIZ || ((CODE + 1)'(was_setup_q.range.low[0+:CODE]) + (CODE + 1)'(1)) << (HIZ + 1) >> (HIZ + 1) == '0);
  assign has_stood   = was_setup_q == setup_i;
  assign is_behind_o = {1'b0, bound_o} < limit_o && has_stood;
  always_comb if (runs_q)
    assert (gen_hiz.limit_q == (HIZ + 1)'(was_setup_q.range.low[Z-1-:HIZ]) + (HIZ + 1)'(was_is_equal_behind));
  // The depth test, with a fragment and stored depths that are only bounded.
  logic raised_q;  // by a line, since the last clear
  always_ff @(posedge clk_i) begin
    if (!rst_ni || forgets) raised_q <= 1'b0;
    else if (passes_i && setup_i.kind == raster_pkg::PRIMITIVE_KIND_LINE && line_raises) raised_q <= 1'b1;
  end
  always_comb if (runs_q && raised_q) assert (!gen_hiz.bounds_hold_q && !is_eligible_o);
  (* anyseq *) logic [SAMPLES*CODE-1:0] any_fragment, any_stored, any_held_depth;
  (* anyseq *) logic [SAMPLES-1:0] any_held;
  raster_pkg::fragment_packet_t fragment, access;
  raster_pkg::write_packet_t    write;
  raster_pkg::retire_packet_t   retire;
  always_comb begin
    fragment                  = '0;
    fragment.mask             = '1;
    fragment.state.depth_test = setup_i.state.depth_test;
    for (int s = 0; s < SAMPLES; s++) fragment.code[s*CODES+:CODE] = any_fragment[s*CODE+:CODE];
  end
  logic access_valid, write_valid, retire_valid, fragment_ready;
  depth_test u_depth_test (
      .clk_i, .rst_ni,
      .fragment_valid_i(1'b1), .fragment_ready_o(fragment_ready), .fragment_i(fragment),
      .access_valid_o(access_valid), .access_ready_i(1'b1), .access_o(access), .access_color_o(), .stored_depth_i(any_stored),
      .is_held_i(any_held), .held_depth_i(any_held_depth),
      .write_valid_o(write_valid), .write_o(write), .retire_valid_o(retire_valid), .retire_o(retire),
      .covered_o(), .passed_o(), .written_o()
  );
  // The cycle after: the fragment's depths against the stored ones.
  logic            rejected_q;
  logic [CODE-1:0] depth_min_q, farthest_q;
  always_ff @(posedge clk_i) begin
    rejected_q  <= rst_ni && is_good_q && is_eligible_o && is_behind_o;
    depth_min_q <= setup_i.range.low[0+:CODE];
    farthest_q  <= (CODE'(farthest_g) << (CODE - HIZ)) | CODE'((1 << (CODE - HIZ)) - 1);
  end
  generate
    for (k = 0; k < SAMPLES; k++) begin : gen_proof
      always_comb begin
        assume (any_fragment[k*CODE+:CODE] >= setup_i.range.low[0+:CODE]);
        assume (any_stored[k*CODE+:CODE] <= farthest_q && any_held_depth[k*CODE+:CODE] <= farthest_q);
      end
    end
  endgenerate
  always_comb if (runs_q && rejected_q) assert (write_valid && write.passed == '0);  // (2)
  always_comb if (runs_q) cover (rejected_q);
  // An assumption of coarse_raster: a verdict stays until the next read.
  logic was_good_q, was_behind_q, had_stood_q;
  always_ff @(posedge clk_i) begin
    was_good_q   <= rst_ni && !reads_i && is_good_q && !starts_visit_i && !clears_i;
    was_behind_q <= is_behind_o;
    had_stood_q  <= has_stood;
  end
  always_comb if (runs_q && was_good_q && has_stood && had_stood_q) assert (!is_good_q || is_behind_o == was_behind_q);
