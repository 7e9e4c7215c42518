
  // Towards memory: an offer stays; the stamps of a buffer come in order, and from one tile. And no deadlock: while an
  // access waits, the remaining work decreases in every cycle in which memory does its part, and never grows; after a
  // fill its access is served. The measure, most significant first: before the fill or the walk, lines to look at,
  // buffers of a line; answers, or buffers, rows and columns of a walk; then rows of stamps, stamps of a row, and the
  // stamp on offer.
  always_comb if (runs_q) begin
    if (state_q == EVICT) assert (request_o.plane[0] ? line_color_dirty : line_depth_dirty);
    if (request_valid_o) assert (request_o.is_write == (state_q != FILL));
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(request_valid_o && !request_ready_i)) assert (request_valid_o && request_o == $past(request_o));
    if ($past(takes_request && runs && !ends_plane) && offers_q) assert (stamp_q > $past(stamp_q));
    if ($past(runs && state_q != FILL && !ends_plane))
      assert (state_q == $past(state_q) && request_o.plane == $past(request_o.plane) &&
              request_o.tile_x == $past(request_o.tile_x) && request_o.tile_y == $past(request_o.tile_y));
    if ($past(is_fill) && !is_fill) assert (state_q == SERVE && access_ready_o);
  end

  localparam int WIDE = ASK + LINE + TILE_X + TILE_Y;  // enough for each of them
  logic [1:0]        part, planes;
  logic [WIDE-1:0]   first, second, moving;
  logic [3:0]        stage;
  logic [3*WIDE+7:0] todo, todo_q;
  logic              memory_does, waited_q;
  logic [ROW_BITS:0] stamps_left;
  always_comb begin
    stamps_left = '0;
    for (int i = 0; i < ROWS; i++) stamps_left = stamps_left + (ROW_BITS + 1)'(left[i]);
    part   = state_q == CHECK || state_q == EVICT ? 2'd2 : state_q == SERVE ? 2'd0 : 2'd1;
    planes = '0;
    first  = '0;
    second = '0;
    stage  = '0;
    moving = runs ? WIDE'({(ROW_BITS + 1)'(ROWS) - row_q, stamps_left, offers_q}) : '0;
    if (part == 2'd2) begin
      first  = WIDE'(LINES - 1) - WIDE'(line_q);
      second = WIDE'(line_depth_dirty) + WIDE'(line_color_dirty);
      stage  = state_q == CHECK ? 4'd1 : 4'd0;
    end else if (is_fill) first = WIDE'(STAMPS) - WIDE'(answered);
    else if (walks_tiles && !walked_q) begin
      planes = state_q == MARK || !plane_q ? 2'd2 : 2'd1;
      first  = WIDE'(access_i.key.tile_y) - WIDE'(walk_y_q);
      second = resolves ? WIDE'(access_i.key.tile_x) - WIDE'(walk_x_q) : WIDE'(access_i.key.tile_x >> BIT) - WIDE'(walk_x_q >> BIT);
      stage  = state_q == READ ? 4'd2 : state_q == SEND ? 4'd1 : 4'd0;
    end
  end
  assign todo        = {part, planes, first, second, stage, moving};
  assign memory_does = (!request_valid_o || request_ready_i) && (unanswered_q == '0 || response_valid_i);
  always_ff @(posedge clk_i) begin
    todo_q   <= todo;
    waited_q <= rst_ni && state_q != SERVE;
  end
  always_comb if (runs_q && waited_q) assert (todo <= todo_q);
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(state_q != SERVE && memory_does && access_valid_i)) assert (todo < $past(todo));
  end
  always_comb if (runs_q) begin
    if (state_q == SERVE && access_valid_i && !access_ready_o) assert (state_d != SERVE);
    cover (access_valid_i && access_ready_o && token && !is_clear);
    cover (access_valid_i && access_ready_o && !token && access_waits_q);
  end
