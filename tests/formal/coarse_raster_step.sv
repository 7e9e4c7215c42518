
  // The walk from tile to tile against values summed up outside the stage, at the tile and at the row's start: one
  // column right, minus T dy; one left, plus T dy; one row down, plus T dx. The tiles of these values are counted here
  // as well: a move goes from a tile to one of its neighbours, or from the row's start to its left or down.
  logic [TX-1:0] tile_x_g, start_x_g;
  logic [TY-1:0] tile_y_g;
  raster_pkg::setup_packet_t g_q;
  always_ff @(posedge clk_i) begin
    if (takes) begin
      g_q       <= setup_i;
      tile_x_g  <= setup_i.box.left[PX-1:TS];
      tile_y_g  <= setup_i.box.top[PY-1:TS];
      start_x_g <= setup_i.box.left[PX-1:TS];
    end else if (goes_on) begin
      tile_x_g <= row_ends ? start_x_g : turns_back ? start_x_g - TX'(1) : goes_left_q ? tile_x_g - TX'(1) : tile_x_g + TX'(1);
      if (row_ends) tile_y_g <= tile_y_g + TY'(1);
      else if (moves_start) start_x_g <= turns_back ? start_x_g - TX'(1) : goes_left_q ? tile_x_g - TX'(1) : tile_x_g + TX'(1);
    end
  end
  logic walks;
  assign walks = runs_q && state_q == WALK && has_walk;
  always_comb if (walks) assert (s_q == g_q && tile_x_q == tile_x_g && tile_y_q == tile_y_g && start_x == start_x_g);
  always_comb if (runs_q && state_q != IDLE) assert (s_q == g_q);
  always_comb if (runs_q && state_q == WALK) assert (has_walk);
  always_comb if (runs_q && state_q == PREPARE && has_walk)
    assert (tile_x_q == tile_x_g && tile_y_q == tile_y_g && start_x == start_x_g);
  genvar k;
  generate
    for (k = 0; k < 3; k++) begin : gen_proof
      logic [V-1:0] tile_q, row_first_q, dx_tiles, dy_tiles, to;
      assign dx_tiles = V'($signed(g_q.dx[k*D+:D])) << TS;
      assign dy_tiles = V'($signed(g_q.dy[k*D+:D])) << TS;
      assign to       = row_ends ? row_first_q + dx_tiles : turns_back ? row_first_q + dy_tiles :
                                   goes_left_q ? tile_q + dy_tiles : tile_q - dy_tiles;
      always_ff @(posedge clk_i) begin
        if (takes) begin
          tile_q      <= setup_i.edge_value[k*V+:V];
          row_first_q <= setup_i.edge_value[k*V+:V];
        end else if (goes_on) begin
          tile_q <= to;
          if (row_ends || moves_start) row_first_q <= to;
        end
      end
      always_comb if (runs_q && (walks || (state_q == PREPARE && has_walk)))
        assert (gen_edge[k].value_q == $signed(tile_q) && (starts || is_start_q ? row_first_q == tile_q : gen_edge[k].row_q == $signed(row_first_q)));
      // The increment to the tile's best corner: T - 1 times that of a pixel (coarse_raster_corners). The verdict that was
      // made a cycle ahead is that of this tile.
      logic signed [TE-1:0] best;
      logic signed [V:0]    largest;
      assign best    = (TE'(gen_edge[k].best) <<< TS) - TE'(gen_edge[k].best) + TE'(gen_edge[k].reach);
      assign largest = (V + 1)'($signed(tile_q)) + (V + 1)'(best);
      always_comb if (walks) assert (edge_is_outside_q[k] == largest[V]);
    end
    for (k = 0; k < PLANES; k++) begin : gen_proof_plane
      localparam int P = PLANE_BITS_OF[32*k+:32];
      localparam int AT = PLANE_AT[32*k+:32];
      localparam int B = LOCAL_BITS_OF[32*k+:32];
      localparam int LOCAL = LOCAL_AT[32*k+:32];
      localparam int M = P - TS - S;  // no step changes the bits below this one
      logic [P-1:0] tile_q, row_first_q, step_x, step_y, value, to;
      assign value  = setup_i.value[AT+:P];
      assign step_x = g_q.step_x[AT+:P] << (TS + S);
      assign step_y = g_q.step_y[AT+:P] << (TS + S);
      assign to     = row_ends ? row_first_q + step_y : turns_back ? row_first_q - step_x :
                                 goes_left_q ? tile_q - step_x : tile_q + step_x;
      always_ff @(posedge clk_i) begin
        if (takes) begin
          tile_q      <= value;
          row_first_q <= value;
        end else if (goes_on) begin
          tile_q <= to;
          if (row_ends || moves_start) row_first_q <= to;
        end
      end
      always_comb if (runs_q && (walks || (state_q == PREPARE && has_walk)))
        assert (gen_plane[k].here == tile_q[P-1-:M] && (starts || is_start_q ? row_first_q == tile_q : gen_plane[k].row_q == row_first_q[P-1-:M]));
      // The offer is the tile that the walk has left.
      logic [B-1:0] left_g;
      always_ff @(posedge clk_i) if (left_is_free) left_g <= tile_q[P-1-:B];
      always_comb if (runs_q && left_valid_q && is_visit) assert (tile_o.anchor[LOCAL+:B] == left_g);
    end
  endgenerate
