
  // The stage's verdict on an edge holds for the whole tile: outside, the edge value is negative everywhere in the next
  // tile (coarse_raster_step: it is kept for that tile); inside, nowhere in this one; and the narrow value that goes to
  // fine_raster has the sign of the wide one. `moved` is the increment from the tile's first pixel to a sample: any value
  // between to_worst and to_best (coarse_raster_corners: all samples lie between). For any content of the registers.
  localparam int WIDE = V + 2;  // exact
  localparam logic signed [WIDE-1:0] MOST = 2 * (raster_pkg::TILE_SIZE - 1) * (2 ** (D - 1) - 1);
  logic walks;
  assign walks = has_walk && state_q == WALK;
  genvar k;
  generate
    for (k = 0; k < 3; k++) begin : gen_proof
      (* anyseq *) logic signed [WIDE-1:0] moved;
      logic signed [WIDE-1:0] sample, narrow, best, worst;
      assign best   = WIDE'(gen_edge[k].to_best);
      assign worst  = WIDE'(gen_edge[k].to_worst);
      assign sample = WIDE'(gen_edge[k].value_q) + moved;
      assign narrow = WIDE'($signed(edge_value[k*TE+:TE])) + moved;
      always_comb assume (-MOST <= worst && worst <= moved && moved <= best && best <= MOST);
      always_comb begin
        if (next_is_outside[k]) assert (WIDE'(gen_edge[k].next) + moved < 0);
        if (edge_is_inside[k]) assert (sample >= 0);
        assert ((narrow < 0) == (sample < 0));
      end
    end
  endgenerate
  always_comb if (walks) begin
    if (steps && !enters) assert (edge_is_outside_q != '0);
    if (is_outside) assert (edge_is_outside_q != '0);
    else assert (edge_is_outside_q == '0);
    if (is_inside) assert (edge_is_inside == '1);
  end
