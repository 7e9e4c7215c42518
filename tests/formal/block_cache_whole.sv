
  // An arbitrary sample of an arbitrary stamp. `truth` of a buffer is the value that a framebuffer without a cache
  // would hold there: the last write or fast clear. (1) The test finds it under every fragment that reads it. (2) When
  // a flush is complete, memory holds it, or its flag is written and it equals the clear value. Memory answers with the
  // last write; where nothing was written, with an arbitrary value.
  (* anyconst *) logic [BLOCK_X-1:0]          any_x;
  (* anyconst *) logic [BLOCK_Y-1:0]          any_y;
  (* anyconst *) logic [INDEX-1:0]            any_stamp;
  (* anyconst *) logic [$clog2(SAMPLES+1)-1:0] any_sample;
  (* anyconst *) logic [1:0]                  any_garbage;
  logic tested_is_it_q, looks_q, request_is_it;
  logic truth_depth_q, truth_color_q, memory_depth_q, memory_color_q, cleared_depth_q, cleared_color_q;
  logic flag_depth_q, flag_color_q;  // as the last flush has written it
  logic [3:0] waits_is_it_q, waits_value_q;
  assign request_is_it = takes_request && request_o.tile_x == any_x && request_o.tile_y == any_y && request_o.stamp == any_stamp &&
                         request_o.plane[1] == 1'b0;
  always_comb begin
    assume (any_sample < SAMPLES);
    if (is_token && fragment_valid_i) assume (any_x <= fragment_i.key.tile_x && any_y <= fragment_i.key.tile_y);
  end
  localparam int WORD = raster_pkg::FLAG_WORD;
  logic flags_are_it;
  assign flags_are_it = takes_request && request_o.is_write && request_o.plane[1] && request_o.tile_x == any_x / WORD &&
                        request_o.tile_y == any_y && request_o.stamp == '0;
  logic [3:0] waits_next, values_next;
  always_comb begin
    waits_next  = waits_is_it_q;
    values_next = waits_value_q;
    if (takes_response) begin
      waits_next  = waits_next >> 1;
      values_next = values_next >> 1;
    end
    if (takes_read) begin
      waits_next[unanswered_q - 3'(takes_response)]  = request_is_it;
      values_next[unanswered_q - 3'(takes_response)] = memory_depth_q;
    end
  end
  always_ff @(posedge clk_i) begin
    tested_is_it_q <= tested_valid_o && tested_o.key.tile_x == any_x && tested_o.key.tile_y == any_y && tested_o.stamp == any_stamp &&
                      tested_o.mask[any_sample];
    looks_q        <= tested_o.state.depth_test != raster_pkg::DEPTH_FUNC_ALWAYS;
    waits_is_it_q  <= waits_next;
    waits_value_q  <= values_next;
    if (!rst_ni) begin
      memory_depth_q <= any_garbage[0];
      memory_color_q <= any_garbage[1];
    end else if (request_is_it && request_o.is_write && request_o.strobe[any_sample]) begin
      if (request_o.plane[0]) memory_color_q <= request_data[any_sample*LANE];
      else memory_depth_q <= request_data[any_sample*LANE];
    end
    if (!rst_ni) begin  // block_cache_start
      truth_depth_q   <= raster_pkg::FRAME_CLEARS == 0 ? any_garbage[0] : clear_depth;
      truth_color_q   <= raster_pkg::FRAME_CLEARS == 0 ? any_garbage[1] : clear_color;
      cleared_depth_q <= clear_depth;
      cleared_color_q <= clear_color;
    end
    if (rst_ni && takes_token && is_clear && fragment_i.state.depth_write) begin
      truth_depth_q   <= fragment_i.code[0];
      cleared_depth_q <= fragment_i.code[0];
    end else if (rst_ni && tested_is_it_q && write_valid_i && write_i.write_depth[any_sample]) truth_depth_q <= write_i.depth[any_sample*CODE];
    if (rst_ni && takes_token && is_clear && fragment_i.state.color_write) begin
      truth_color_q   <= fragment_i.code[CODE];
      cleared_color_q <= fragment_i.code[CODE];
    end else if (rst_ni && tested_is_it_q && write_valid_i && write_i.write_color[any_sample]) truth_color_q <= write_i.color[any_sample*COLOR];
    if (flags_are_it) begin
      if (request_o.plane[0]) flag_color_q <= request_data[any_x % WORD];
      else flag_depth_q <= request_data[any_x % WORD];
    end
  end
  always_comb begin
    if (takes_response && waits_is_it_q[0]) assume (response_i.data[any_sample*LANE] == waits_value_q[0]);
    if (runs_q) begin
      if (tested_is_it_q && looks_q) assert (stored_depth_o[any_sample*CODE] == truth_depth_q);
      if (takes_token && !is_clear) begin
        assert (flag_depth_q ? truth_depth_q == cleared_depth_q : truth_depth_q == memory_depth_q);
        if (raster_pkg::FRAME_CLEARS == 0) assert (truth_color_q == memory_color_q);
        else assert (flag_color_q ? truth_color_q == cleared_color_q : truth_color_q == memory_color_q);
      end
      cover (tested_is_it_q && looks_q && x1_q.source == raster_pkg::DEPTH_SOURCE_MEMORY && truth_depth_q != cleared_depth_q);
    end
  end
