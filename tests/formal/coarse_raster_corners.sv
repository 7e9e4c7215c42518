
  // The corners that the stage looks at, of one edge: the increment from the tile's first pixel to any of its samples,
  // x times -dy and y times dx, lies between T - 1 times `worst` and T - 1 times `best`, exactly, and both fit their
  // width. In steps, so that no sum is long: n of T - 1 steps; bounds in x and in y add up; T - 1 times is T times less
  // once.
  localparam int WIDE = TE + 2;
  localparam int MOST = raster_pkg::TILE_SIZE - 1;
  localparam logic [D-1:0] LOWEST = {1'b1, {(D - 1) {1'b0}}};  // not a difference of two coordinates
  logic signed [D-1:0] down, to_right;  // one pixel down adds dx, one to the right -dy
  assign down     = $signed(s_q.dx[0+:D]);
  assign to_right = -$signed(s_q.dy[0+:D]);
  always_comb assume (down != $signed(LOWEST) && to_right != $signed(LOWEST));

  logic signed [WIDE-1:0] up_x, up_y, low_x, low_y, best, worst;  // of one step
  assign up_x  = to_right > 0 ? WIDE'(to_right) : '0;
  assign up_y  = down > 0 ? WIDE'(down) : '0;
  assign low_x = to_right < 0 ? WIDE'(to_right) : '0;
  assign low_y = down < 0 ? WIDE'(down) : '0;
  assign best  = WIDE'(gen_edge[0].best);
  assign worst = WIDE'(gen_edge[0].worst);
  always_comb assert (best == up_x + up_y && worst == low_x + low_y);

  genvar n;
  generate
    for (n = 0; n <= MOST; n++) begin : gen_pixel
      always_comb begin
        assert ($signed(WIDE'(n)) * WIDE'(to_right) <= $signed(WIDE'(MOST)) * up_x);
        assert ($signed(WIDE'(n)) * WIDE'(to_right) >= $signed(WIDE'(MOST)) * low_x);
      end
    end
  endgenerate
  (* anyseq *) logic signed [WIDE-1:0] moved_x, moved_y;
  (* anyseq *) logic signed [WIDE-1:0] most_x, most_y, least_x, least_y;
  localparam logic signed [WIDE-1:0] RANGE = MOST * (2 ** (D - 1) - 1);
  always_comb begin
    assume (-RANGE <= least_x && least_x <= moved_x && moved_x <= most_x && most_x <= RANGE);
    assume (-RANGE <= least_y && least_y <= moved_y && moved_y <= most_y && most_y <= RANGE);
    assert (least_x + least_y <= moved_x + moved_y && moved_x + moved_y <= most_x + most_y);
  end
  logic signed [TE-1:0] narrow_best, narrow_worst;
  assign narrow_best  = (TE'(gen_edge[0].best) <<< TS) - TE'(gen_edge[0].best);
  assign narrow_worst = (TE'(gen_edge[0].worst) <<< TS) - TE'(gen_edge[0].worst);
  always_comb assert (WIDE'(narrow_best) == (best <<< TS) - best && WIDE'(narrow_worst) == (worst <<< TS) - worst);
