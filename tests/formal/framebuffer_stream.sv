
  // Towards memory: a plane is a run of requests, one a stamp, in order, of one tile; what is offered stays. And no deadlock:
  // while an access waits, what is left to do gets less in every cycle in which memory does its part, and never more; after
  // a fill its access is served. What is left, the most significant first: before the fill or the walk, of the lines that
  // are looked at, of the planes of a line, of the stamps of a plane; then answers and requests, or rows, columns, planes
  // and stamps.
  logic [STAMP_BITS-1:0] run_q;
  always_ff @(posedge clk_i) begin
    if (state_q == CHECK || state_q == TEST) run_q <= '0;
    else if (takes_request) run_q <= run_q == LAST_STAMP ? '0 : run_q + 1'b1;
  end
  always_comb if (runs_q) begin
    if (request_valid_o) assert (request_o.stamp == run_q && stamp_q == run_q);
    if (state_q == EVICT) assert (request_o.plane[0] ? line_color_dirty : line_depth_dirty);
    if (request_valid_o) assert (request_o.is_write == (state_q != FILL));
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(request_valid_o && !request_ready_i)) assert (request_valid_o && request_o == $past(request_o));
    if ($past(is_write_back && !ends_plane))
      assert (state_q == $past(state_q) && request_o.plane == $past(request_o.plane) &&
              request_o.tile_x == $past(request_o.tile_x) && request_o.tile_y == $past(request_o.tile_y));
    if ($past(is_fill) && !is_fill) assert (state_q == SERVE && access_ready_o);
  end

  // A flag that was reset is found so: sram_word.
  logic [1:0] reset_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni || walks || !walks_tiles) reset_q <= '0;
    else if (state_q == CLEAR && ends_plane) reset_q <= reset_q | {plane_q, !plane_q};
  end
  always_comb if (runs_q && state_q == TEST) assume ((reset_q & {flag_color, flag_depth}) == '0);
  always_comb if (runs_q && state_q == CLEAR) assert ((reset_q & {plane_q, !plane_q}) == '0);

  localparam int WIDE = ASK + LINE + TILE_X + TILE_Y;  // enough for any of them
  logic [1:0]      part, planes;
  logic [WIDE-1:0] first, second, stamps;
  logic [3*WIDE+3:0] left, left_q;
  logic              memory_does, waited_q;
  always_comb begin
    part   = state_q == CHECK || state_q == EVICT ? 2'd2 : state_q == SERVE ? 2'd0 : 2'd1;
    first  = '0;
    second = '0;
    planes = '0;
    stamps = '0;
    if (part == 2'd2) begin
      first  = WIDE'(LINES - 1) - WIDE'(line_q);
      planes = 2'(line_depth_dirty) + 2'(line_color_dirty);
      stamps = state_q == CHECK ? WIDE'(STAMPS + 1) : WIDE'(STAMPS) - WIDE'(stamp_q);
    end else if (is_fill) begin
      first  = WIDE'(2 * STAMPS) - WIDE'(answered);
      second = WIDE'(2 * STAMPS) - WIDE'(asked);
    end else if (walks_tiles) begin
      first  = WIDE'(access_i.key.tile_y) - WIDE'(walk_y_q);
      second = WIDE'(access_i.key.tile_x) - WIDE'(walk_x_q);
      planes = 2'd2 - (2'(reset_q[0]) + 2'(reset_q[1]));
      stamps = state_q == CLEAR ? WIDE'(STAMPS) - WIDE'(stamp_q) : state_q == TEST ? WIDE'(STAMPS + 1) : WIDE'(STAMPS + 2);
    end
  end
  assign left        = {part, first, second, planes, stamps};
  assign memory_does = (!request_valid_o || request_ready_i) && (unanswered_q == '0 || response_valid_i);
  always_ff @(posedge clk_i) begin
    left_q   <= left;
    waited_q <= rst_ni && state_q != SERVE;
  end
  always_comb if (runs_q && waited_q) assert (left <= left_q);
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(state_q != SERVE && memory_does && access_valid_i)) assert (left < $past(left));
  end
  always_comb if (runs_q) begin
    if (state_q == SERVE && access_valid_i && !access_ready_o) assert (state_d != SERVE);
    cover (access_valid_i && access_ready_o && token && !is_clear);
    cover (access_valid_i && access_ready_o && !token && access_waits_q);
  end
