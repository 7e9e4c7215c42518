// Framebuffer of tiles: depth and colour of a few tiles on the chip, a direct-mapped write-back cache of the buffers in
// memory.
//
// In: accesses of depth_test (a stamp, or a token: fast clear, flush) and its writes. Out: the stored depth codes of
// the stamp one cycle after the access, and requests to memory, in program order. A hit takes one cycle. A miss writes
// back the stamps that were written, then brings in the tile: its depth from memory, or both buffers from the clear
// value where a fast clear came after their last write-back; colour is only ever written. The write of an access comes
// in the cycle after it, when the next access waits at the earliest: so all state is settled from the second cycle of a
// miss on. Specification: model/stages/tile_cache.hpp.
module framebuffer (
    input logic clk_i,
    input logic rst_ni,

    // From depth_test: accesses, answered in the next cycle; access_color_i is the stored colour of sample 0 of the cycle
    // before
    input  logic                                                       access_valid_i,
    output logic                                                       access_ready_o,
    input  raster_pkg::fragment_packet_t                               access_i,
    input  logic [raster_pkg::STORED_COLOR_BITS-1:0]                   access_color_i,
    output logic [raster_pkg::SAMPLES*raster_pkg::DEPTH_CODE_BITS-1:0] stored_depth_o,

    // From depth_test: the write of the access of the cycle before
    input logic                      write_valid_i,
    input raster_pkg::write_packet_t write_i,

    // To and from memory_port
    output logic                         request_valid_o,
    input  logic                         request_ready_i,
    output raster_pkg::memory_request_t  request_o,
    input  logic                         response_valid_i,
    output logic                         response_ready_o,
    input  raster_pkg::memory_response_t response_i,

    // Stamps that this cycle adds to the counters
    output logic fill_o,
    output logic evict_o,
    output logic clear_o,

    output logic moves_tiles_o,  // no access is served while tiles move, are marked or are looked up
    output logic idle_o          // no memory access is pending
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int CODE = raster_pkg::DEPTH_CODE_BITS;
  localparam int COLOR = raster_pkg::STORED_COLOR_BITS;
  localparam int LANE = raster_pkg::MEMORY_LANE_BITS;
  localparam int TILE_X = raster_pkg::TILE_X_BITS;
  localparam int TILE_Y = raster_pkg::TILE_Y_BITS;
  localparam int STAMP_BITS = raster_pkg::STAMP_INDEX_BITS;
  localparam int RUN = raster_pkg::RUN_BITS;
  localparam int ROWS = raster_pkg::STAMPS_PER_ROW;  // of stamps in a tile, and stamps in a row; a power of two
  localparam int ROW_BITS = $clog2(ROWS);
  localparam int LINES = raster_pkg::CACHE_LINES;
  localparam int LINE_X = raster_pkg::LINE_X_BITS;  // may be 0, or more than TILE_X
  localparam int LINE_Y = raster_pkg::LINE_Y_BITS;
  localparam int LINE = (LINES == 1) ? 1 : LINE_X + LINE_Y;
  localparam int ADDRESS = LINE + STAMP_BITS;  // bits of a stamp's address in the RAMs
  localparam int ROW_ADDRESS = LINE + ROW_BITS;  // bits of a row's address
  localparam int WORD = raster_pkg::FLAG_WORD;
  localparam int BIT = $clog2(WORD);
  localparam int WORD_X = (TILE_X > BIT) ? TILE_X - BIT : 1;  // bits of a word's number in its row
  localparam int FLAGS = (raster_pkg::TILES_Y == 1 ? 2 : raster_pkg::TILES_Y) << WORD_X;  // addressed {tile y, word}
  localparam logic [STAMP_BITS-1:0] LAST_STAMP = STAMP_BITS'(ROWS * ROWS - 1);
  localparam logic [STAMP_BITS-1:0] COLUMN_MASK = STAMP_BITS'(ROWS - 1);
  localparam logic [LINE-1:0] LINE_X_MASK = LINE'((1 << LINE_X) - 1);
  localparam logic [LINE-1:0] LINE_Y_MASK = LINE'((1 << LINE_Y) - 1);

  localparam logic [2:0] SERVE = 3'd0;    // accesses that hit
  localparam logic [2:0] CHECK = 3'd1;    // is line_q dirty?
  localparam logic [2:0] EVICT = 3'd2;    // write back one buffer of line_q
  localparam logic [2:0] FILL = 3'd3;     // bring in the tile
  localparam logic [2:0] MARK = 3'd4;     // fast clear: set a word of flags a cycle
  localparam logic [2:0] READ = 3'd5;     // flush: read a word of flags; the end of any walk
  localparam logic [2:0] SEND = 3'd6;     // flush: the word goes to memory; or is the tile's flag set?
  localparam logic [2:0] RESOLVE = 3'd7;  // flush: write the clear colour of a tile

  logic [2:0]        state_q, state_d;
  logic [LINE-1:0]   line_q;    // under eviction or fill
  logic              plane_q;   // buffer of an eviction or walk; 1: colour
  logic [TILE_X-1:0] walk_x_q;  // tile of a fast clear's or flush's walk
  logic [TILE_Y-1:0] walk_y_q;
  logic              walked_q;  // the walk is complete
  logic [CODE-1:0]   clear_depth;  // value of the last fast clear
  logic [COLOR-1:0]  clear_color;

  // Tags; undefined for a line that is not valid, like its dirty bits.
  logic [LINES-1:0]  valid_q;
  logic [TILE_X-1:0] tag_x_q[0:LINES-1];  // tile x without the bits that select the line
  logic [TILE_Y-1:0] tag_y_q[0:LINES-1];
  logic              dirty_depth_q[0:LINES-1];
  logic              dirty_color_q[0:LINES-1];

  logic is_clear, is_token, clears_all, hits, is_fill, is_resolve;
  logic [LINE-1:0] access_line, write_line, line;
  logic [TILE_X-1:0] tag_x;
  logic [TILE_Y-1:0] tag_y;
  logic line_depth_dirty, line_color_dirty, is_last_line;
  logic [LINE-1:0]   line_above_x;
  logic [TILE_X-1:0] tile_x, tile_x_q, victim_x;
  logic [TILE_Y-1:0] tile_y, tile_y_q;
  logic              reads_flags;
  logic flag_depth, flag_color;  // the tile's buffer in memory is stale: the value of the last fast clear counts

  assign is_clear    = access_i.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR;
  assign is_token    = is_clear || access_i.kind == raster_pkg::PRIMITIVE_KIND_FLUSH;  // excludes pixels of lines
  assign clears_all  = is_clear && access_i.state.depth_write && access_i.state.color_write;
  assign access_line = (LINE'(access_i.key.tile_x) & LINE_X_MASK) | ((LINE'(access_i.key.tile_y) & LINE_Y_MASK) << LINE_X);
  assign write_line  = (LINE'(write_i.key.tile_x) & LINE_X_MASK) | ((LINE'(write_i.key.tile_y) & LINE_Y_MASK) << LINE_X);
  assign is_fill     = state_q == FILL;
  assign is_resolve  = state_q == RESOLVE;

  // One lookup: of the access while it is served, of line_q after that.
  assign line  = state_q == SERVE ? access_line : line_q;
  assign tag_x = tag_x_q[line];
  assign tag_y = tag_y_q[line];
  assign hits  = valid_q[line] && tag_x == access_i.key.tile_x >> LINE_X && tag_y == access_i.key.tile_y >> LINE_Y;
  assign line_depth_dirty = valid_q[line] && dirty_depth_q[line];
  assign line_color_dirty = valid_q[line] && dirty_color_q[line];
  assign is_last_line     = line_q == LINE'(LINES - 1);

  // The walk of a token: words of flags, or tile by tile where colours are resolved.
  logic resolves, walks, ends_row, ends_walk, sends;
  logic ends_plane, fill_ends;  // the last stamp of a buffer has been taken; the tile is complete
  assign resolves  = raster_pkg::FRAME_CLEARS == 0 && plane_q;
  assign sends     = state_q == SEND && !resolves;
  assign ends_row  = resolves ? walk_x_q == access_i.key.tile_x : walk_x_q >> BIT == access_i.key.tile_x >> BIT;
  assign ends_walk = ends_row && walk_y_q == access_i.key.tile_y;
  assign walks     = state_q == MARK || (state_q == SEND && (resolves ? !flag_color : request_ready_i)) ||
                     (is_resolve && ends_plane);

  assign access_ready_o = state_q == SERVE ? !is_token && hits : walked_q;
  assign moves_tiles_o  = state_q != SERVE || (access_valid_i && !access_ready_o);
  assign idle_o         = state_q == SERVE && !access_valid_i;

  always_comb begin
    state_d = state_q;
    case (state_q)
      SERVE: if (access_valid_i && !access_ready_o) state_d = clears_all ? MARK : CHECK;
      CHECK:
      if (line_depth_dirty || line_color_dirty) state_d = EVICT;
      else if (!is_token) state_d = FILL;
      else if (is_last_line) state_d = is_clear ? MARK : READ;
      EVICT: if (ends_plane) state_d = CHECK;
      FILL: if (fill_ends) state_d = SERVE;
      MARK: if (ends_walk) state_d = READ;
      READ: if (!walked_q) state_d = SEND;
      else if (access_valid_i) state_d = SERVE;
      default: if (walks) state_d = READ;
      else if (resolves) state_d = RESOLVE;
    endcase
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q  <= SERVE;
      walk_x_q <= '0;
      walk_y_q <= '0;
      walked_q <= 1'b0;
    end else begin
      state_q  <= state_d;
      walked_q <= state_d != SERVE && (walked_q || (walks && ends_walk && (is_clear || plane_q)));
      if (walks) begin
        walk_x_q <= ends_row ? '0 : walk_x_q + (resolves ? TILE_X'(1) : TILE_X'(WORD));
        if (ends_row) walk_y_q <= ends_walk ? '0 : walk_y_q + 1'b1;
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (state_q == SERVE) line_q <= is_token ? '0 : access_line;
    else if (state_q == CHECK && is_token && !line_depth_dirty && !line_color_dirty && !is_last_line) line_q <= line_q + 1'b1;
    if (state_q == SERVE || state_q == CHECK) plane_q <= state_q == CHECK && !line_depth_dirty && line_color_dirty;
    else if (walks && ends_walk) plane_q <= 1'b1;
  end

  // The values of the last fast clear, each a word of a RAM, read in every cycle: MARK writes it long before a tile is
  // filled with it.
  sram #(
      .WIDTH    (CODE),
      .READS_OLD(0),
      .BLOCK    (1)
  ) u_clear_depth (
      .clk_i,
      .read_i         (1'b1),
      .read_address_i (1'b0),
      .data_o         (clear_depth),
      .write_i        (state_q == MARK && access_i.state.depth_write),
      .write_address_i(1'b0),
      .data_i         (access_i.code[0+:CODE])
  );
  sram #(
      .WIDTH    (COLOR),
      .READS_OLD(0),
      .BLOCK    (1)
  ) u_clear_color (
      .clk_i,
      .read_i         (1'b1),
      .read_address_i (1'b0),
      .data_o         (clear_color),
      .write_i        (state_q == MARK && access_i.state.color_write),
      .write_address_i(1'b0),
      .data_i         (access_color_i)
  );

  // Stamps of a tile, in order: samples of stamps_q are the rest of the current row, the next row is read ahead. A
  // stamp is read out of the RAMs and is on offer in the next cycle. A stale buffer is written whole, and so is a tile
  // that a flush resolves: one burst; otherwise consecutive stamps of a row are one burst. A fill requests all its
  // stamps of depth at once.
  logic                    offers_q;  // stamp_q is on offer
  logic [STAMP_BITS-1:0]   stamp_q, stamp;
  logic [SAMPLES-1:0]      strobe_q, strobe;
  logic [ROWS*SAMPLES-1:0] stamps_q, dirty_row;
  logic [2*ROWS*SAMPLES-1:0] dirty_rows;  // colour, depth
  logic [ROW_BITS:0]       row_q, row, dirty_row_number;  // the next row; that of dirty bits
  logic [ROWS-1:0]         left, one;
  logic [RUN-1:0]          run, run_q;    // stamps of the burst from this one on
  logic                    gap;
  logic                    runs, is_free, steps, loads, begins_fill, takes_all;
  always_comb begin
    left = '0;
    for (int i = 0; i < ROWS; i++) left[i] = stamps_q[i*SAMPLES+:SAMPLES] != '0;
    one    = left & (~left + 1'b1);
    stamp  = is_fill ? '0 : (STAMP_BITS'(row_q) - 1'b1) << ROW_BITS;
    strobe = '0;
    for (int i = 0; i < ROWS; i++) begin
      if (one[i]) stamp = stamp | STAMP_BITS'(i);
      if (one[i]) strobe = strobe | stamps_q[i*SAMPLES+:SAMPLES];
    end
    run = '0;
    gap = 1'b0;
    for (int i = 0; i < ROWS; i++) begin
      if (left[i] && !gap) run = run + 1'b1;
      if (!left[i] && run != '0) gap = 1'b1;
    end
    if (takes_all) run = RUN'(ROWS * ROWS) - RUN'(stamp);
  end
  assign runs      = state_q == EVICT || is_resolve || (is_fill && !flag_depth);
  assign is_free   = !offers_q || request_ready_i;
  assign steps     = runs && left != '0 && is_free;
  assign loads     = runs ? row_q != (ROW_BITS + 1)'(ROWS) && (left == '0 || (steps && left == one)) :
                     begins_fill || (state_q == SEND && resolves && !walks);
  assign takes_all = state_q != EVICT || (plane_q ? flag_color : flag_depth);
  assign dirty_row = plane_q ? dirty_rows[ROWS*SAMPLES+:ROWS*SAMPLES] : dirty_rows[0+:ROWS*SAMPLES];
  assign begins_fill = state_q == CHECK && !line_depth_dirty && !line_color_dirty && !is_token;
  // Dirty bits count in an eviction alone: their address does not wait for the flags that say whether a fill runs.
  assign dirty_row_number = state_q == EVICT ? row_q + (ROW_BITS + 1)'(left == '0 || (is_free && left == one)) : '0;
  assign row       = begins_fill ? (ROW_BITS + 1)'(ROWS) : (runs ? row_q : '0) + (ROW_BITS + 1)'(loads);
  assign ends_plane      = left == '0 && row_q == (ROW_BITS + 1)'(ROWS) && is_free;
  assign request_valid_o = offers_q || sends;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      stamps_q <= '0;
      offers_q <= 1'b0;
    end else begin
      offers_q <= steps || !is_free;
      if (loads) stamps_q <= begins_fill ? (ROWS * SAMPLES)'(1) : (takes_all ? '1 : dirty_row);
      else if (!runs) stamps_q <= '0;
      else if (steps) for (int i = 0; i < ROWS; i++) if (one[i]) stamps_q[i*SAMPLES+:SAMPLES] <= '0;
    end
  end

  always_ff @(posedge clk_i) begin
    row_q <= row;
    if (steps) begin
      stamp_q  <= stamp;
      strobe_q <= strobe;
      run_q    <= run;
    end
  end

  // Answers: there is room for every request. A cleared tile is filled without any.
  logic [STAMP_BITS-1:0] fill_stamp_q;
  logic                  fill_steps;
  assign response_ready_o = 1'b1;
  assign fill_steps       = is_fill && (flag_depth || response_valid_i);
  assign fill_ends        = fill_steps && fill_stamp_q == LAST_STAMP;
  always_ff @(posedge clk_i) begin
    if (!is_fill) fill_stamp_q <= '0;
    else if (fill_steps) fill_stamp_q <= fill_stamp_q + 1'b1;
  end

  // Tags and dirty bits.
  logic [LINE-1:0] dirty_line;
  logic            sets_dirty_depth, sets_dirty_color;
  assign dirty_line       = state_q == SERVE ? write_line : line_q;
  assign sets_dirty_depth = state_q == SERVE && write_valid_i && write_i.write_depth != '0;
  assign sets_dirty_color = state_q == SERVE && write_valid_i && write_i.write_color != '0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= '0;
    else if (walked_q) valid_q <= '0;
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
      fill_o  <= 1'b0;
      evict_o <= 1'b0;
      clear_o <= 1'b0;
    end else begin
      fill_o  <= is_fill && !flag_depth && fill_steps;
      evict_o <= !is_fill && offers_q && request_ready_i;
      clear_o <= is_fill && flag_depth;
    end
  end

  // The tile that is marked or whose flags are read: for a dirty line, the evicted tile. In CHECK it is about to change
  // to the incoming tile; then a token's read is ignored. It stays in a register while it is moved.
  assign line_above_x = line_q >> LINE_X;
  assign victim_x     = (tag_x << LINE_X) | (TILE_X'(line_q) & TILE_X'((1 << LINE_X) - 1));
  always_comb begin
    tile_x = state_q == CHECK ? access_i.key.tile_x : walk_x_q;
    tile_y = state_q == CHECK ? access_i.key.tile_y : walk_y_q;
    if (state_q == CHECK && (line_depth_dirty || line_color_dirty)) begin
      tile_x = victim_x;
      tile_y = (tag_y << LINE_Y) | TILE_Y'(line_above_x);
    end
  end
  assign reads_flags = state_q == CHECK || state_q == READ;
  always_ff @(posedge clk_i) begin
    if (reads_flags) begin
      tile_x_q <= tile_x;
      tile_y_q <= tile_y;
    end
  end

  // Clear flags: a bit per tile and buffer, in words of a row of tiles. Flags beyond the target's right side mean
  // nothing.
  logic [WORD-1:0]    word_depth, word_color, flag_bit;
  logic [BIT-1:0]     bit_x;
  logic [1:0]         flag_write;  // colour, depth
  logic [TILE_X-1:0]  word_x, last_word;
  logic [TILE_Y+WORD_X-1:0] flag_read_address, flag_write_address;
  // After the read, the bit of the word's tile is looked at and, except in MARK, written.
  assign bit_x      = BIT'(tile_x_q);
  assign word_x     = tile_x_q >> BIT;
  assign last_word  = access_i.key.tile_x >> BIT;
  assign flag_read_address  = (TILE_Y + WORD_X)'({tile_y, WORD_X'(tile_x >> BIT)});
  assign flag_write_address = state_q == MARK ? flag_read_address : {tile_y_q, word_x[WORD_X-1:0]};
  assign flag_depth = word_depth[bit_x];
  assign flag_color = word_color[bit_x];
  assign flag_bit   = state_q == MARK ? '1 : WORD'(1) << bit_x;
  assign flag_write = (state_q == MARK) ? {access_i.state.color_write, access_i.state.depth_write}
                                        : {2{(state_q == EVICT || is_resolve) && ends_plane}} & {plane_q, !plane_q};

  masked_sram #(
      .WIDTH(WORD),
      .DEPTH(FLAGS)
  ) u_flag_depth (
      .clk_i,
      .read_i         (reads_flags),
      .read_address_i (flag_read_address),
      .data_o         (word_depth),
      .may_write_i    (1'b1),
      .write_i        (flag_bit & {WORD{flag_write[0]}}),
      .write_address_i(flag_write_address),
      .data_i         ({WORD{state_q == MARK}})
  );
  masked_sram #(
      .WIDTH(WORD),
      .DEPTH(FLAGS)
  ) u_flag_color (
      .clk_i,
      .read_i         (reads_flags),
      .read_address_i (flag_read_address),
      .data_o         (word_color),
      .may_write_i    (1'b1),
      .write_i        (flag_bit & {WORD{flag_write[1]}}),
      .write_address_i(flag_write_address),
      .data_i         ({WORD{state_q == MARK}})
  );

  // The RAMs: one per sample and buffer. A word that is read while it is written is not used: depth_test keeps such
  // stamps apart.
  logic                  reads;
  logic [ADDRESS-1:0]    read_address;
  logic [LINE-1:0]       new_line;  // line to be written
  logic [STAMP_BITS-1:0] new_stamp;
  logic [STAMP_BITS-1:0] new_row;
  assign reads        = state_q == SERVE || steps;
  assign read_address = {line, state_q == SERVE ? access_i.stamp : stamp};
  assign new_line     = is_fill ? line_q : write_line;
  assign new_stamp    = is_fill ? fill_stamp_q : write_i.stamp;
  assign new_row      = new_stamp >> ROW_BITS;

  // Next to them a bit per sample and buffer: written since the tile came in. A word is a row of stamps.
  logic [ROW_ADDRESS-1:0] dirty_read_address, dirty_write_address;
  logic [ROWS-1:0]        column;  // column of the written stamp
  assign dirty_read_address  = (ROW_ADDRESS'(line_q) << ROW_BITS) | (ROW_ADDRESS'(dirty_row_number) & ROW_ADDRESS'(ROWS - 1));
  assign dirty_write_address = (ROW_ADDRESS'(new_line) << ROW_BITS) | ROW_ADDRESS'(new_row);
  always_comb
    for (int i = 0; i < ROWS; i++) column[i] = (write_i.stamp & COLUMN_MASK) == STAMP_BITS'(i);

  logic [SAMPLES*LANE-1:0] data;
  genvar s, c;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_sample
      logic              writes_depth, writes_color, is_here;
      logic [CODE-1:0]   depth, depth_new;
      logic [COLOR-1:0]  color, color_new;
      logic [2*ROWS-1:0] dirty, writes_dirty;  // colour, depth
      assign writes_depth = is_fill ? fill_steps : write_valid_i && write_i.write_depth[s];
      assign writes_color = is_fill ? fill_steps && flag_color : write_valid_i && write_i.write_color[s];
      assign writes_dirty = {2 * ROWS{is_fill}} | {column & {ROWS{writes_color}}, column & {ROWS{writes_depth}}};
      always_comb begin
        depth_new = write_i.depth[s*CODE+:CODE];
        if (is_fill) depth_new = flag_depth ? clear_depth : response_i.data[s*LANE+:CODE];
        color_new = is_fill ? clear_color : write_i.color[s*COLOR+:COLOR];
      end

      sram #(
          .WIDTH    (CODE),
          .DEPTH    (1 << ADDRESS),
          .READS_OLD(0)
      ) u_depth (
          .clk_i,
          .read_i         (reads),
          .read_address_i (read_address),
          .data_o         (depth),
          .write_i        (writes_depth),
          .write_address_i({new_line, new_stamp}),
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
          .write_i        (writes_color),
          .write_address_i({new_line, new_stamp}),
          .data_i         (color_new)
      );
      // The write mask comes late, from the depth test; the write enable does not.
      for (c = 0; c < 2; c++) begin : gen_plane
        masked_sram #(
            .WIDTH(ROWS),
            .DEPTH(1 << ROW_ADDRESS),
            .EARLY(1)
        ) u_dirty (
            .clk_i,
            .read_i         (1'b1),
            .read_address_i (dirty_read_address),
            .data_o         (dirty[c*ROWS+:ROWS]),
            .may_write_i    (is_fill || write_valid_i),
            .write_i        (writes_dirty[c*ROWS+:ROWS]),
            .write_address_i(dirty_write_address),
            .data_i         ({ROWS{!is_fill}})
        );
      end
      for (c = 0; c < 2 * ROWS; c++) begin : gen_dirty
        assign dirty_rows[c*SAMPLES+s] = dirty[c];
      end

      assign stored_depth_o[s*CODE+:CODE] = depth;
      assign is_here = state_q == EVICT && strobe_q[s];
      assign data[s*LANE+:LANE] = is_resolve ? LANE'(clear_color) : (plane_q ? LANE'(color) : LANE'(depth)) & {LANE{is_here}};
    end
  endgenerate

  // The request: a stamp, or a word of flags.
  always_comb begin
    request_o.is_write = !is_fill;
    request_o.plane    = plane_q ? raster_pkg::TILE_PLANE_COLOR : raster_pkg::TILE_PLANE_DEPTH;
    request_o.strobe   = is_fill ? '0 : strobe_q;
    request_o.tile_x   = tile_x_q;
    request_o.tile_y   = tile_y_q;
    request_o.stamp    = stamp_q;
    request_o.run      = run_q;
    request_o.data     = data;
    if (sends) begin
      request_o.plane          = plane_q ? raster_pkg::TILE_PLANE_COLOR_FLAGS : raster_pkg::TILE_PLANE_DEPTH_FLAGS;
      request_o.strobe         = '1;
      request_o.tile_x         = word_x;
      request_o.stamp          = '0;
      request_o.run            = RUN'(last_word) - RUN'(word_x) + 1'b1;
      request_o.data[WORD-1:0] = plane_q ? word_color : word_depth;
    end
  end

endmodule
