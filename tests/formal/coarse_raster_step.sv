
  // The walk from tile to tile against values summed up outside of it: a column on, minus T dy; a row on, T dx from the
  // row's first tile. The tile that they belong to is counted here as well.
  logic [TX-1:0] tile_x_g;
  logic [TY-1:0] tile_y_g;
  logic          goes, wraps;
  var raster_pkg::setup_packet_t g_q;
  assign goes  = steps && !is_last_tile;
  assign wraps = tile_x_g == g_q.box.right[PX-1:TS];
  always_ff @(posedge clk_i) begin
    if (takes) begin
      g_q      <= setup_i;
      tile_x_g <= setup_i.box.left[PX-1:TS];
      tile_y_g <= setup_i.box.top[PY-1:TS];
    end else if (goes) begin
      tile_x_g <= wraps ? g_q.box.left[PX-1:TS] : tile_x_g + TX'(1);
      if (wraps) tile_y_g <= tile_y_g + TY'(1);
    end
  end
  logic walks;
  assign walks = runs_q && (state_q == WALK || state_q == BOUND) && has_walk;
  always_comb if (walks) begin
    assert (s_q == g_q && tile_x_q == tile_x_g && tile_y_q == tile_y_g);
  end
  always_comb if (runs_q && state_q != IDLE) assert (s_q == g_q);
  always_comb if (runs_q && state_q == PREPARE && has_walk)
    assert (tile_x_q == g_q.box.left[PX-1:TS] && tile_y_q == g_q.box.top[PY-1:TS] && tile_x_g == tile_x_q && tile_y_g == tile_y_q);
  genvar k;
  generate
    for (k = 0; k < 3; k++) begin : gen_proof
      logic [V-1:0] tile_q, row_first_q, dx_tiles, dy_tiles;
      assign dx_tiles = V'($signed(g_q.dx[k*D+:D])) << TS;
      assign dy_tiles = V'($signed(g_q.dy[k*D+:D])) << TS;
      always_ff @(posedge clk_i) begin
        if (takes) begin
          tile_q      <= setup_i.edge_value[k*V+:V];
          row_first_q <= setup_i.edge_value[k*V+:V];
        end else if (goes) begin
          tile_q <= wraps ? row_first_q + dx_tiles : tile_q - dy_tiles;
          if (wraps) row_first_q <= row_first_q + dx_tiles;
        end
      end
      always_comb if (runs_q && (walks || (state_q == PREPARE && has_walk)))
        assert (gen_edge[k].value_q == $signed(tile_q) && gen_edge[k].row_q == $signed(row_first_q));
      // The ways to the tile's corners: T - 1 times those of a pixel (coarse_raster_corners).
      logic signed [TE-1:0] best, worst;
      assign best  = (TE'(gen_edge[k].best) <<< TS) - TE'(gen_edge[k].best);
      assign worst = (TE'(gen_edge[k].worst) <<< TS) - TE'(gen_edge[k].worst);
      always_comb if (walks) assert (gen_edge[k].best_q == best && gen_edge[k].worst_q == worst);
    end
    for (k = 0; k < PLANES; k++) begin : gen_proof_plane
      localparam int P = PLANE_BITS_OF[32*k+:32];
      localparam int AT = PLANE_AT[32*k+:32];
      localparam int B = LOCAL_BITS_OF[32*k+:32];
      localparam int LOCAL = LOCAL_AT[32*k+:32];
      logic [P-1:0] tile_q, row_first_q, step_x, step_y, value;
      assign value  = setup_i.value[AT+:P];
      assign step_x = g_q.step_x[AT+:P] << (TS + S);
      assign step_y = g_q.step_y[AT+:P] << (TS + S);
      always_ff @(posedge clk_i) begin
        if (takes) begin
          tile_q      <= value;
          row_first_q <= value;
        end else if (goes) begin
          tile_q <= wraps ? row_first_q + step_y : tile_q + step_x;
          if (wraps) row_first_q <= row_first_q + step_y;
        end
      end
      always_comb if (runs_q && (walks || (state_q == PREPARE && has_walk)))
        assert (gen_plane[k].value_q == tile_q && gen_plane[k].row_q == row_first_q);
      always_comb if (walks) assert (tile_o.anchor[LOCAL+:B] == tile_q[P-1-:B]);
    end
  endgenerate
