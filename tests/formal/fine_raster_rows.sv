
  // The edge values of each row of stamps, at its first column, against value + y step_y of the tile's packet: y of the
  // first row as the sum of its bits, from there row by row, in two bits more than the stage has, so that a sum out of
  // its range would show. And the ways from there to the middle of each pixel row.
  localparam int WIDE = W + 2;
  localparam logic [STEP-1:0] LOWEST = {1'b1, {(STEP - 1) {1'b0}}};  // not a difference of two coordinates
  localparam int LARGEST = 2 ** (STEP - 1) - 1;
  genvar k, r, j;
  generate
    for (k = 0; k < 3; k++) begin : gen_proof
      logic signed [WIDE-1:0] at_row, first, first_step, step;
      logic signed [WIDE-1:0] sum_q;
      assign at_row     = WIDE'(gen_edge[k].value_q);
      assign first_step = WIDE'($signed(edges_i.step_y[k*STEP+:STEP]));
      assign step       = WIDE'($signed(edges_q.step_y[k*STEP+:STEP]));
      always_comb begin
        first = WIDE'($signed(tile_i.edge_value[k*TILE_EDGE+:TILE_EDGE]));
        for (int b = PIXEL - 1; b >= 0; b--) if (first_y[b]) first = first + (first_step <<< b);
        assume (edges_i.step_y[k*STEP+:STEP] != LOWEST);
      end
      always_ff @(posedge clk_i) begin
        if (takes_tile) sum_q <= first;
        else if (row_leaves) sum_q <= sum_q + (step <<< STAMP_SHIFT);
      end
      always_comb if (runs_q && row_valid_q) begin
        assert (edges_q.step_y[k*STEP+:STEP] != LOWEST);
        assert (at_row == sum_q);
      end
      for (j = 0; j < STAMP; j++) begin : gen_proof_reach
        logic signed [WIDE-1:0] reach;
        assign reach = WIDE'($signed(gen_edge[k].reach[j*(STEP+PIXEL+1)+:STEP+PIXEL+1]));
        always_comb if (runs_q && row_valid_q)
          assert (reach == ((j & 2) ? step <<< 1 : '0) + ((j & 1) ? step : '0) +
                           (WIDE'($signed(edges_q.step_x[k*STEP+:STEP])) <<< (PIXEL - 1)));
      end
      for (r = 0; r < TILE; r = r + STAMP) begin : gen_proof_row  // for induction, and for fine_raster_samples
        localparam logic signed [WIDE-1:0] MOST = 2 ** (TILE_EDGE - 1) + r * LARGEST;
        always_comb if (runs_q && row_valid_q && y_q == PIXEL'(r)) assert (-MOST <= sum_q && sum_q <= MOST);
      end
    end
  endgenerate
  // From coarse_raster: a non-empty box. The walk ends with it.
  always_comb if (tile_valid_i) assume (tile_i.box.top <= tile_i.box.bottom);
  always_comb if (runs_q && row_valid_q) begin
    assert ((y_q & PIXEL'(STAMP - 1)) == '0);
    if (tile_q.is_visit) assert ((y_q >> STAMP_SHIFT) <= (tile_q.box.bottom >> STAMP_SHIFT));
  end
