
  // A tile, any. A ghost of its bound has program order: the visits of the tile retire one after the other, each with its
  // update, and a clear sets it. (1) When the stage decides by the bound, it is that of every earlier visit. (2) When it
  // rejects, the real depth test fails for any fragment not before depth_min against any stored depth not behind the bound.
  localparam int CODE = raster_pkg::DEPTH_CODE_BITS;
  localparam int CODES = raster_pkg::ALL_CODE_BITS;
  localparam int SAMPLES = raster_pkg::SAMPLES;
  (* anyconst *) logic [TX-1:0] any_x;
  (* anyconst *) logic [TY-1:0] any_y;
  (* anyseq *) logic [SAMPLES*CODE-1:0] any_fragment, any_stored;
  logic [HIZ-1:0] bound_g;
  logic           has_bound_q;  // it was written once; before that the stream has no triangle
  logic           is_it, retires_it;
  assign is_it      = tile_x_q == any_x && tile_y_q == any_y;
  assign retires_it = retire_valid_i && retire_i.key.tile_x == any_x && retire_i.key.tile_y == any_y;
  always_comb assume (32'(any_y) < raster_pkg::TILES_Y && 32'(tile_y_q) < raster_pkg::TILES_Y);
  always_ff @(posedge clk_i) begin
    if (!rst_ni) has_bound_q <= 1'b0;
    else if (clears && is_it) begin
      bound_g     <= s_q.range.low[Z-1-:HIZ];
      has_bound_q <= 1'b1;
    end else if (retires_it && retire_i.update != raster_pkg::HIZ_UPDATE_NONE && !clears) begin
      bound_g     <= retire_i.hiz_code;
      has_bound_q <= 1'b1;
    end
  end

  // Visits retire in the order in which they started, and no more of them than started.
  always_comb if (retire_valid_i)
    assume (visit_valid_q[oldest_q] && {retire_i.key.tile_y, retire_i.key.tile_x} == visit_tile_q[32'(oldest_q)*(TX+TY)+:TX+TY]);

  logic decides;
  assign decides = runs_q && state_q == BOUND && is_it && has_bound_q;
  always_comb if (decides) assert (gen_hiz.bound == bound_g);
  always_comb if (runs_q && state_q == BOUND) assert (is_eligible && !is_outside && visit_conflicts == '0);
  // What sram_word proves of the RAM: a read gives what was written last in an earlier cycle.
  logic           reads_it_q;
  logic [HIZ-1:0] word_q;
  always_ff @(posedge clk_i) begin
    reads_it_q <= state_q == WALK && is_it && has_bound_q;
    word_q     <= bound_g;
  end
  always_comb if (runs_q && reads_it_q) assume (gen_hiz.bound == word_q);
  always_comb if (runs_q && state_q == BOUND && is_it) assert (!reads_it_q || word_q == bound_g);

  // The depth test, with a fragment and stored depths that are only bounded.
  var raster_pkg::fragment_packet_t fragment, access;
  var raster_pkg::write_packet_t    write;
  var raster_pkg::retire_packet_t   retire;
  logic rejected_q;
  logic [SAMPLES*CODE-1:0] stored;
  always_comb begin
    fragment                  = '0;
    fragment.mask             = '1;
    fragment.state.depth_test = s_q.state.depth_test;
    for (int s = 0; s < SAMPLES; s++) fragment.code[s*CODES+:CODE] = any_fragment[s*CODE+:CODE];
  end
  assign stored = any_stored;
  logic access_valid, write_valid, retire_valid, fragment_ready;
  depth_test u_depth_test (
      .clk_i, .rst_ni,
      .fragment_valid_i(1'b1), .fragment_ready_o(fragment_ready), .fragment_i(fragment),
      .access_valid_o(access_valid), .access_ready_i(1'b1), .access_o(access), .access_color_o(), .stored_depth_i(stored),
      .write_valid_o(write_valid), .write_o(write), .retire_valid_o(retire_valid), .retire_o(retire),
      .covered_o(), .passed_o(), .written_o()
  );
  // The cycle after: the fragment's depths against what is stored.
  logic [CODE-1:0] depth_min_q, farthest_q;
  always_ff @(posedge clk_i) begin
    rejected_q  <= decides && is_behind;
    depth_min_q <= s_q.range.low[0+:CODE];
    farthest_q  <= (CODE'(bound_g) << (CODE - HIZ)) | CODE'((1 << (CODE - HIZ)) - 1);
  end
  genvar k;
  generate
    for (k = 0; k < SAMPLES; k++) begin : gen_proof
      always_comb begin
        assume (any_fragment[k*CODE+:CODE] >= s_q.range.low[0+:CODE]);
        assume (any_stored[k*CODE+:CODE] <= farthest_q);
      end
    end
  endgenerate
  always_comb if (runs_q && rejected_q) assert (write_valid && write.passed == '0);
  always_comb if (runs_q) cover (rejected_q);
