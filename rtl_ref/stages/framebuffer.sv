// Framebuffer: the tiles on the chip, a direct-mapped write-back cache of the depth and colour planes in memory.
//
// In: accesses of depth_test (a stamp, or a token: fast clear, flush) and its writes. Out: the stored depth codes of
// the stamp one cycle after the access, and requests to memory, in program order. A hit takes one cycle. A miss writes
// back what is dirty, then brings in the tile: a plane cleared since it was last written back is filled on the chip.
// The write of an access comes in the cycle after it, when the next access waits at the earliest: so whatever is looked
// at from the second cycle of a miss on is settled. Specification: model/stages/tile_cache.hpp.
module framebuffer (
    input logic clk_i,
    input logic rst_ni,

    /* verilator lint_off UNUSEDSIGNAL */  // of both packets only some fields matter here
    // From depth_test: accesses, answered in the next cycle; access_color_i is the stored colour of sample 0
    input  logic                                                       access_valid_i,
    output logic                                                       access_ready_o,
    input  raster_pkg::fragment_packet_t                               access_i,
    input  logic [raster_pkg::STORED_COLOR_BITS-1:0]                   access_color_i,
    output logic [raster_pkg::SAMPLES*raster_pkg::DEPTH_CODE_BITS-1:0] stored_depth_o,

    // From depth_test: the write of the access of the cycle before
    input logic                      write_valid_i,
    input raster_pkg::write_packet_t write_i,
    /* verilator lint_on UNUSEDSIGNAL */

    // Memory
    output logic                         request_valid_o,
    input  logic                         request_ready_i,
    output raster_pkg::memory_request_t  request_o,
    input  logic                         response_valid_i,
    output logic                         response_ready_o,
    input  raster_pkg::memory_response_t response_i,

    // Planes of tiles that this cycle adds to the counters
    output logic [1:0] fill_o,
    output logic [1:0] evict_o,
    output logic [1:0] clear_o,

    output logic moves_tiles_o,  // no access is served while tiles move, or are marked or looked at
    output logic idle_o          // nothing waits for memory
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int CODE = raster_pkg::DEPTH_CODE_BITS;
  localparam int COLOR = raster_pkg::STORED_COLOR_BITS;
  localparam int LANE = raster_pkg::MEMORY_LANE_BITS;
  localparam int TILE_X = raster_pkg::TILE_X_BITS;
  localparam int TILE_Y = raster_pkg::TILE_Y_BITS;
  localparam int STAMP_BITS = raster_pkg::STAMP_INDEX_BITS;
  localparam int LINES = raster_pkg::CACHE_LINES;
  localparam int LINE_X = raster_pkg::LINE_X_BITS;  // may be 0, or more than TILE_X
  localparam int LINE_Y = raster_pkg::LINE_Y_BITS;
  localparam int LINE = (LINES == 1) ? 1 : LINE_X + LINE_Y;
  localparam int ADDRESS = LINE + STAMP_BITS;  // of a stamp in the RAMs
  localparam int FLAGS = (raster_pkg::TILES_Y == 1 ? 2 : raster_pkg::TILES_Y) << TILE_X;  // addressed {tile y, tile x}
  localparam logic [STAMP_BITS-1:0] LAST_STAMP =
      STAMP_BITS'(raster_pkg::STAMPS_PER_ROW * raster_pkg::STAMPS_PER_ROW - 1);  // a power of two less 1
  localparam logic [LINE-1:0] LINE_X_MASK = LINE'((1 << LINE_X) - 1);
  localparam logic [LINE-1:0] LINE_Y_MASK = LINE'((1 << LINE_Y) - 1);

  localparam logic [2:0] SERVE = 3'd0;  // accesses that hit
  localparam logic [2:0] CHECK = 3'd1;  // is line_q dirty?
  localparam logic [2:0] EVICT = 3'd2;  // write back a plane of line_q
  localparam logic [2:0] FILL = 3'd3;   // bring in both planes of the tile
  localparam logic [2:0] MARK = 3'd4;   // fast clear: set the flags of a tile a cycle
  localparam logic [2:0] LOOK = 3'd5;   // flush: read the flags of a tile
  localparam logic [2:0] TEST = 3'd6;   // flush: are they set?
  localparam logic [2:0] CLEAR = 3'd7;  // flush: write a cleared plane to memory

  function automatic [STAMP_BITS-1:0] after(input [STAMP_BITS-1:0] stamp);
    after = (stamp + 1'b1) & LAST_STAMP;
  endfunction

  logic [2:0]            state_q, state_d;
  logic [LINE-1:0]       line_q;       // under eviction or fill
  logic [STAMP_BITS-1:0] stamp_q;      // of the request; rests at the last, so that the next is 0
  logic                  plane_q;      // 1: colour; in a fill the second plane that is read
  logic                  requested_q;  // fill: every request has been taken
  logic [STAMP_BITS-1:0] fill_stamp_q;  // next to be filled
  logic                  fill_plane_q;
  logic [TILE_X-1:0]     walk_x_q;     // tile of a fast clear's or flush's walk
  logic [TILE_Y-1:0]     walk_y_q;
  logic [CODE-1:0]       clear_depth_q;
  logic [COLOR-1:0]      clear_color_q;

  // Tags; those and the dirty bits of a line that is not valid mean nothing.
  logic [LINES-1:0]  valid_q;
  logic [TILE_X-1:0] tag_x_q[0:LINES-1];  // tile x without the bits that chose the line
  logic [TILE_Y-1:0] tag_y_q[0:LINES-1];
  logic              dirty_depth_q[0:LINES-1];
  logic              dirty_color_q[0:LINES-1];

  logic is_clear, is_token, clears_all, hits;
  logic [LINE-1:0] access_line, write_line, line;
  logic [TILE_X-1:0] tag_x;
  logic [TILE_Y-1:0] tag_y;
  logic line_depth_dirty, line_color_dirty, is_last_line;
  logic flag_depth, flag_color;  // the plane in memory is garbage: its value is the last fast clear's
  logic walk_ends_row, walk_ends, tile_done, walks;
  logic is_fill, is_write_back, takes_request, starts_plane, ends_plane, more_requests;
  logic fill_steps, fills_last, fill_ends, reads_both;
  logic sets_dirty_depth, sets_dirty_color;
  logic [LINE-1:0]   dirty_line;
  /* verilator lint_off UNUSEDSIGNAL */  // wider than a tile's y where the cache is larger than the target
  logic [LINE-1:0]   line_above_x;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [TILE_X-1:0] tile_x;
  logic [TILE_Y-1:0] tile_y;
  logic [1:0]        flag_write;  // colour, depth

  assign is_clear    = access_i.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR;
  assign is_token    = is_clear || access_i.kind == raster_pkg::PRIMITIVE_KIND_FLUSH;  // not a pixel of a line
  assign clears_all  = is_clear && access_i.state.depth_write && access_i.state.color_write;
  assign access_line = (LINE'(access_i.key.tile_x) & LINE_X_MASK) | ((LINE'(access_i.key.tile_y) & LINE_Y_MASK) << LINE_X);
  assign write_line  = (LINE'(write_i.key.tile_x) & LINE_X_MASK) | ((LINE'(write_i.key.tile_y) & LINE_Y_MASK) << LINE_X);

  // One look-up: of the access while it is served, of line_q after that.
  assign line  = state_q == SERVE ? access_line : line_q;
  assign tag_x = tag_x_q[line];
  assign tag_y = tag_y_q[line];
  assign hits  = valid_q[line] && tag_x == access_i.key.tile_x >> LINE_X && tag_y == access_i.key.tile_y >> LINE_Y;
  assign line_depth_dirty = valid_q[line] && dirty_depth_q[line];
  assign line_color_dirty = valid_q[line] && dirty_color_q[line];
  assign is_last_line     = line_q == LINE'(LINES - 1);

  assign walk_ends_row = walk_x_q == access_i.key.tile_x;
  assign walk_ends     = walk_ends_row && walk_y_q == access_i.key.tile_y;
  assign tile_done     = state_q == MARK || (state_q == TEST && !flag_depth && !flag_color);
  assign walks         = tile_done && (!walk_ends || access_valid_i);

  assign access_ready_o = state_q == SERVE ? !is_token && hits : tile_done && walk_ends;
  assign moves_tiles_o  = state_q != SERVE || (access_valid_i && !access_ready_o);
  assign idle_o         = state_q == SERVE && !access_valid_i;

  always_comb begin
    state_d = state_q;
    case (state_q)
      SERVE: if (access_valid_i && !access_ready_o) state_d = is_token && clears_all ? MARK : CHECK;
      CHECK:
      if (line_depth_dirty || line_color_dirty) state_d = EVICT;
      else if (!is_token) state_d = FILL;
      else if (is_last_line) state_d = is_clear ? MARK : LOOK;
      EVICT: if (ends_plane) state_d = CHECK;
      FILL: if (fill_ends) state_d = SERVE;
      MARK: if (walks && walk_ends) state_d = SERVE;
      LOOK: state_d = TEST;
      TEST:
      if (!tile_done) state_d = CLEAR;
      else if (walks) state_d = walk_ends ? SERVE : LOOK;
      default: if (ends_plane) state_d = LOOK;
    endcase
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) state_q <= SERVE;
    else state_q <= state_d;
  end

  always_ff @(posedge clk_i) begin
    if (state_q == SERVE) line_q <= is_token ? '0 : access_line;
    else if (state_q == CHECK && state_d == CHECK) line_q <= line_q + 1'b1;
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      walk_x_q <= '0;
      walk_y_q <= '0;
    end else if (walks) begin
      walk_x_q <= walk_ends_row ? '0 : walk_x_q + 1'b1;
      if (walk_ends_row) walk_y_q <= walk_ends ? '0 : walk_y_q + 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (state_q == MARK && access_i.state.depth_write) clear_depth_q <= access_i.code[0+:CODE];
    if (state_q == MARK && access_i.state.color_write) clear_color_q <= access_color_i;
  end

  // Requests: a plane is a run of stamps. Those of a fill may run ahead of the answers.
  assign is_fill         = state_q == FILL;
  assign is_write_back   = state_q == EVICT || state_q == CLEAR;
  assign request_valid_o = is_write_back || (is_fill && !requested_q && !(flag_depth && flag_color));
  assign takes_request   = request_valid_o && request_ready_i;
  assign ends_plane      = takes_request && stamp_q == LAST_STAMP;
  assign reads_both      = !flag_depth && !flag_color;
  assign more_requests   = is_fill && reads_both && !plane_q;  // after this plane
  assign starts_plane    = (state_q == CHECK && (state_d == EVICT || state_d == FILL)) ||
                           (state_q == TEST && !tile_done);

  always_ff @(posedge clk_i) begin
    if (state_q == SERVE) stamp_q <= LAST_STAMP;
    else if (starts_plane || (takes_request && (!ends_plane || more_requests))) stamp_q <= after(stamp_q);

    if (state_q == CHECK) plane_q <= !line_depth_dirty && line_color_dirty;
    else if (state_q == TEST) plane_q <= !flag_depth;
    else if (is_fill && ends_plane) plane_q <= 1'b1;

    if (state_q == SERVE) requested_q <= 1'b0;
    else if (ends_plane && is_fill && !more_requests) requested_q <= 1'b1;
  end

  // The tile that is moved, marked or looked at.
  assign line_above_x = line_q >> LINE_X;
  always_comb begin
    tile_x = is_token ? walk_x_q : access_i.key.tile_x;
    tile_y = is_token ? walk_y_q : access_i.key.tile_y;
    if (state_q == EVICT) begin
      tile_x = (tag_x << LINE_X) | (TILE_X'(line_q) & TILE_X'((1 << LINE_X) - 1));
      tile_y = (tag_y << LINE_Y) | TILE_Y'(line_above_x);
    end
  end

  assign request_o.is_write = is_write_back;
  assign request_o.plane    = plane_q || (is_fill && flag_depth) ? raster_pkg::TILE_PLANE_COLOR : raster_pkg::TILE_PLANE_DEPTH;
  assign request_o.strobe   = {SAMPLES{is_write_back}};
  assign request_o.tile_x   = tile_x;
  assign request_o.tile_y   = tile_y;
  assign request_o.stamp    = stamp_q;

  // The answers: room for all that was asked for. A plane that is cleared rides along with one that is read.
  assign response_ready_o = 1'b1;
  assign fill_steps       = is_fill && ((flag_depth && flag_color) || response_valid_i);
  assign fills_last       = fill_plane_q || !reads_both;
  assign fill_ends        = fill_steps && fills_last && fill_stamp_q == LAST_STAMP;

  always_ff @(posedge clk_i) begin
    if (!is_fill) begin
      fill_stamp_q <= '0;
      fill_plane_q <= 1'b0;
    end else if (fill_steps) begin
      fill_stamp_q <= after(fill_stamp_q);
      if (fill_stamp_q == LAST_STAMP) fill_plane_q <= 1'b1;
    end
  end

  // Tags and dirty bits.
  assign dirty_line       = state_q == SERVE ? write_line : line_q;
  assign sets_dirty_depth = state_q == SERVE && write_valid_i && write_i.write_depth != '0;
  assign sets_dirty_color = state_q == SERVE && write_valid_i && write_i.write_color != '0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= '0;
    else if (state_q == MARK && walk_ends) valid_q <= '0;
    else if (fill_ends) valid_q <= valid_q | LINES'(1) << line_q;
  end

  always_ff @(posedge clk_i) begin
    if (fill_ends) begin
      tag_x_q[line_q] <= access_i.key.tile_x >> LINE_X;
      tag_y_q[line_q] <= access_i.key.tile_y >> LINE_Y;
    end
    if (sets_dirty_depth || fill_ends || (state_q == EVICT && ends_plane && !plane_q))
      dirty_depth_q[dirty_line] <= state_q == SERVE;
    if (sets_dirty_color || fill_ends || (state_q == EVICT && ends_plane && plane_q))
      dirty_color_q[dirty_line] <= state_q == SERVE;
  end

  // Counters, one cycle late.
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      fill_o  <= '0;
      evict_o <= '0;
      clear_o <= '0;
    end else begin
      fill_o  <= fill_ends ? {reads_both, flag_depth ^ flag_color} : '0;
      evict_o <= {1'b0, is_write_back && ends_plane};
      clear_o <= fill_ends ? {flag_depth && flag_color, flag_depth ^ flag_color} : '0;
    end
  end

  // One bit a tile and plane.
  assign flag_write = (state_q == MARK) ? {access_i.state.color_write, access_i.state.depth_write}
                                        : {2{is_write_back && ends_plane}} & {plane_q, !plane_q};

  sram #(
      .WIDTH(1),
      .DEPTH(FLAGS)
  ) u_flag_depth (
      .clk_i,
      .read_i         (state_q == CHECK || state_q == LOOK),
      .read_address_i ({tile_y, tile_x}),
      .data_o         (flag_depth),
      .write_i        (flag_write[0]),
      .write_address_i({tile_y, tile_x}),
      .data_i         (state_q == MARK)
  );
  sram #(
      .WIDTH(1),
      .DEPTH(FLAGS)
  ) u_flag_color (
      .clk_i,
      .read_i         (state_q == CHECK || state_q == LOOK),
      .read_address_i ({tile_y, tile_x}),
      .data_o         (flag_color),
      .write_i        (flag_write[1]),
      .write_address_i({tile_y, tile_x}),
      .data_i         (state_q == MARK)
  );

  // The RAMs: one a sample and plane. While a plane is written back, the word behind the one on offer is read when that
  // one is taken. A word that is read while it is written is not looked at: depth_test keeps such stamps apart.
  logic [ADDRESS-1:0] read_address, write_address;
  logic               reads, fill_depth, fill_color;
  logic [LANE-1:0]    clear_lane;
  assign reads         = state_q == SERVE || state_q == CHECK || takes_request;
  assign read_address  = {line, state_q == SERVE ? access_i.stamp : after(stamp_q)};
  assign write_address = is_fill ? {line_q, fill_stamp_q} : {write_line, write_i.stamp};
  assign fill_depth    = fill_steps && !fill_plane_q;
  assign fill_color    = fill_steps && fills_last;
  assign clear_lane    = plane_q ? LANE'(clear_color_q) : LANE'(clear_depth_q);

  genvar s;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_sample
      logic [CODE-1:0]  depth, depth_new, depth_fill;
      logic [COLOR-1:0] color, color_new, color_fill;
      assign depth_fill = flag_depth ? clear_depth_q : response_i.data[s*LANE+:CODE];
      assign color_fill = flag_color ? clear_color_q : response_i.data[s*LANE+:COLOR];
      assign depth_new  = is_fill ? depth_fill : write_i.depth[s*CODE+:CODE];
      assign color_new  = is_fill ? color_fill : write_i.color[s*COLOR+:COLOR];

      sram #(
          .WIDTH    (CODE),
          .DEPTH    (1 << ADDRESS),
          .READS_OLD(0)
      ) u_depth (
          .clk_i,
          .read_i         (reads),
          .read_address_i (read_address),
          .data_o         (depth),
          .write_i        (is_fill ? fill_depth : write_valid_i && write_i.write_depth[s]),
          .write_address_i(write_address),
          .data_i         (depth_new)
      );
      sram #(
          .WIDTH    (COLOR),
          .DEPTH    (1 << ADDRESS),
          .READS_OLD(0)
      ) u_color (
          .clk_i,
          .read_i         (reads),
          .read_address_i (read_address),
          .data_o         (color),
          .write_i        (is_fill ? fill_color : write_valid_i && write_i.write_color[s]),
          .write_address_i(write_address),
          .data_i         (color_new)
      );

      assign stored_depth_o[s*CODE+:CODE] = depth;
      always_comb begin
        request_o.data[s*LANE+:LANE] = plane_q ? LANE'(color) : LANE'(depth);
        if (state_q == CLEAR) request_o.data[s*LANE+:LANE] = clear_lane;
        if (is_fill) request_o.data[s*LANE+:LANE] = '0;
      end
    end
  endgenerate

endmodule
