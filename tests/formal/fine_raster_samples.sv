
  // Every sample of a row of stamps, from the row's edge values: covered when it is in the box and the tile is inside
  // or value + x step_x + y step_y >= 0 for the three edges, in two bits more than the stage has. For any register
  // content within its range, which fine_raster_rows proves.
  localparam int WIDE = W + 2;
  localparam logic [STEP-1:0] LOWEST = {1'b1, {(STEP - 1) {1'b0}}};  // not a difference of two coordinates
  localparam logic signed [WIDE-1:0] MOST = 2 ** (TILE_EDGE - 1) + (TILE - STAMP) * (2 ** (STEP - 1) - 1);
  genvar k, c, j;
  generate
    for (k = 0; k < 3; k++) begin : gen_proof
      logic signed [WIDE-1:0] at_row, sx, sy;
      assign at_row = WIDE'(gen_edge[k].value_q);
      assign sx     = WIDE'($signed(edges_q.step_x[k*STEP+:STEP]));
      assign sy     = WIDE'($signed(edges_q.step_y[k*STEP+:STEP]));
      always_comb begin
        assume (edges_q.step_x[k*STEP+:STEP] != LOWEST && edges_q.step_y[k*STEP+:STEP] != LOWEST);
        assume (-MOST <= at_row && at_row <= MOST);
      end
      for (j = 0; j < STAMP; j++) begin : gen_proof_reach  // which fine_raster_rows proves, too
        always_comb assume (WIDE'($signed(gen_edge[k].reach[j*(STEP+PIXEL+1)+:STEP+PIXEL+1])) ==
                            ((j & 2) ? sy <<< 1 : '0) + ((j & 1) ? sy : '0) + (sx <<< (PIXEL - 1)));
      end
      for (c = 0; c < STAMP * TILE; c++) begin : gen_proof_sample  // row in the stamp, column
        logic signed [WIDE-1:0] exact;
        // In the order of the RTL, rows first and the highest bit first: so that the solver recognises the same sums.
        assign exact = at_row + (((c / TILE) & 2) ? sy <<< 1 : '0) + (((c / TILE) & 1) ? sy : '0) +
                       (((c % TILE) & 4) ? sx <<< 2 : '0) + (((c % TILE) & 2) ? sx <<< 1 : '0) +
                       (((c % TILE) & 1) ? sx : '0);
        always_comb assert (outside[k*ROW+((c%TILE)/STAMP)*SAMPLES+(c/TILE)*STAMP+(c%TILE)%STAMP] == (exact < 0));
      end
    end
    for (c = 0; c < STAMP * TILE; c++) begin : gen_proof_covered
      localparam int AT = ((c % TILE) / STAMP) * SAMPLES + (c / TILE) * STAMP + (c % TILE) % STAMP;
      logic [PIXEL-1:0] y;
      assign y = y_q + PIXEL'(c / TILE);
      always_comb
        assert (covered[AT] == (tile_q.is_visit && PIXEL'(c % TILE) >= tile_q.box.left && PIXEL'(c % TILE) <= tile_q.box.right &&
                                y >= tile_q.box.top && y <= tile_q.box.bottom &&
                                (tile_q.is_inside || !(outside[AT] || outside[ROW+AT] || outside[2*ROW+AT]))));
    end
  endgenerate
