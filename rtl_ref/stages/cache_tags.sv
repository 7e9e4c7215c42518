// Cache tags: which blocks of 4x4 pixels are on the chip, looked up before the depth test, so that the memory reads of
// a fragment start while earlier fragments are still in flight.
//
// In: fragments, in program order. Out: items for the test, each with the result of its tag lookup, and orders: write
// back a number of evicted blocks, then read a stamp of depth, and with blending one of colour. A fragment becomes an
// item in three cycles, one per cycle: its line is read, compared, and the result leaves. Where the flag of a cleared
// block falls, a fragment of another block than the previous one's waits a cycle (clear_flags). Tokens stay until all their
// work is done: a walk over the lines that evicts the dirty ones, the marks of a fast clear, a word of flags a cycle,
// or a flush's requests. The words of a fast clear of one bin also hold flags of other bins: each is read, then
// written. Specification: model/stages/cache_tags.hpp.
module cache_tags #(
    parameter int STAMPS = raster_pkg::BLOCK_STAMPS,  // derived; not to be set
    parameter int STAMP = raster_pkg::BLOCK_STAMP_BITS,
    parameter int BLOCK_X = raster_pkg::BLOCK_X_BITS,
    parameter int BLOCK_Y = raster_pkg::BLOCK_Y_BITS,
    parameter int LINE = raster_pkg::CACHE_LINE_BITS,
    parameter int WRITES = raster_pkg::VICTIM_COUNT_BITS,
    parameter int WORD_X = raster_pkg::FLAG_WORD_X_BITS
) (
    input logic clk_i,
    input logic rst_ni,

    // From primitive_join
    input  logic                         fragment_valid_i,
    output logic                         fragment_ready_o,
    input  raster_pkg::fragment_packet_t fragment_i,

    // To depth_cache: the fragment, and the result of its tag lookup
    output logic                         item_valid_o,
    input  logic                         item_ready_i,
    output raster_pkg::fragment_packet_t item_o,
    output raster_pkg::tag_result_t      found_o,

    // To write_back: evicted blocks to be written, and a read
    output logic                     order_valid_o,
    input  logic                     order_ready_i,
    output raster_pkg::block_order_t order_o,

    // After all orders: the writes of a flush
    input  logic                        drained_i,  // no item and no order is under way
    output logic                        request_valid_o,
    input  logic                        request_ready_i,
    output raster_pkg::memory_request_t request_o,
    output logic [raster_pkg::FLAG_WORD-1:0] request_word_o,  // its data, if it writes a word of flags

    // Words of the bits of blocks with one colour per pixel: a word is read, and valid in the next cycle; or written
    output raster_pkg::pixel_word_t          pixel_word_o,
    input  logic [raster_pkg::FLAG_WORD-1:0] pixel_word_i,

    output logic [raster_pkg::STORED_DEPTH_BITS-1:0] clear_depth_o,
    output logic [raster_pkg::STORED_COLOR_BITS-1:0] clear_color_o,

    output logic is_cleared_o,  // a stamp begins with the clear value
    output logic is_resolved_o,  // a stamp of a cleared block goes to memory
    output logic at_token_o,  // a token is at work on lines and flags, after everything else
    output logic idle_o
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int Z = raster_pkg::DEPTH_CODE_BITS;
  localparam int CODE = raster_pkg::STORED_DEPTH_BITS;  // depth, above it the stencil, if there is one
  localparam int COLOR = raster_pkg::STORED_COLOR_BITS;
  localparam int LANE = raster_pkg::MEMORY_LANE_BITS;
  localparam int LINES = raster_pkg::CACHE_LINES;
  localparam int LINE_X = raster_pkg::LINE_X_BITS;  // may be 0, or more than BLOCK_X
  localparam int LINE_Y = raster_pkg::LINE_Y_BITS;
  localparam int TAG_X = raster_pkg::TAG_X_BITS;
  localparam int TAG_Y = raster_pkg::TAG_Y_BITS;
  localparam int TILE_BITS = $clog2(raster_pkg::BLOCKS_PER_ROW);
  localparam int INDEX = raster_pkg::STAMP_INDEX_BITS;
  localparam int RUN = raster_pkg::RUN_BITS;
  localparam int VICTIMS = raster_pkg::CACHE_VICTIMS;
  localparam int VICTIM = raster_pkg::VICTIM_SLOT_BITS;
  localparam int WORD = raster_pkg::FLAG_WORD;
  localparam int BIT = $clog2(WORD);
  localparam int KNOWN = raster_pkg::BLEND_LANES == 0 ? 0 : STAMPS;  // blending: stamps with their colours on the chip
  localparam int REST = 3 + TAG_X + TAG_Y + 2 * STAMPS + 4;
  localparam int STATE = REST + KNOWN;  // bits of a line's state
  localparam bit TESTS_ALPHA = raster_pkg::ALPHA_UNIT != 0 && raster_pkg::SETUP_KIND == 0;
  localparam logic [LINE-1:0] LINE_X_MASK = LINE'((1 << LINE_X) - 1);
  localparam logic [LINE-1:0] LINE_Y_MASK = LINE'((1 << LINE_Y) - 1);
  localparam logic [BLOCK_X-1:0] BIN_X = BLOCK_X'((1 << LINE_X) - 1);  // bits of a block's x within the bin
  localparam logic [BLOCK_Y-1:0] BIN_Y = BLOCK_Y'((1 << LINE_Y) - 1);

  localparam logic [3:0] SERVE = 4'd0;    // fragments
  localparam logic [3:0] LOOK = 4'd1;     // a token's walk reads a line
  localparam logic [3:0] ORDER = 4'd2;    // evicted blocks go to memory
  localparam logic [3:0] DRAIN = 4'd3;
  localparam logic [3:0] MARK = 4'd4;     // fast clear: empties lines, sets flags
  localparam logic [3:0] READ = 4'd5;     // flush: a word of flags
  localparam logic [3:0] SEND = 4'd6;     // the word goes to memory
  localparam logic [3:0] RESOLVE = 4'd7;  // its resolved blocks go to memory
  localparam logic [3:0] DONE = 4'd8;

  logic [3:0] state_q, state_d;

  // A fragment on offer.
  logic               is_clear, is_token, clears_all, clears_bin, skips_walk, takes_fragment;
  logic [BLOCK_X-1:0] fragment_x;
  logic [BLOCK_Y-1:0] fragment_y;
  logic [LINE-1:0]    fragment_line;

  function automatic [LINE-1:0] line_of(input [BLOCK_X-1:0] x, input [BLOCK_Y-1:0] y);
    line_of = (LINE'(x) & LINE_X_MASK) | ((LINE'(y) & LINE_Y_MASK) << LINE_X);
  endfunction
  function automatic [BIT-1:0] bit_of(input [BLOCK_X-1:0] x);
    bit_of = BIT'(x);
  endfunction

  assign is_clear      = fragment_i.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR;
  assign is_token      = is_clear || fragment_i.kind == raster_pkg::PRIMITIVE_KIND_FLUSH;  // excludes pixels of lines
  assign clears_bin    = is_clear && fragment_i.state.depth_test == raster_pkg::DEPTH_FUNC_EQUAL;
  assign clears_all    = is_clear && fragment_i.state.depth_write && fragment_i.state.color_write;
  assign skips_walk    = clears_all || clears_bin;  // over the lines: they are dropped, or empty
  assign fragment_line = line_of(fragment_x, fragment_y);
  block_stamp u_fragment_stamp (
      .tile_x_i (fragment_i.key.tile_x),
      .tile_y_i (fragment_i.key.tile_y),
      .stamp_i  (fragment_i.stamp),
      .block_x_o(fragment_x),
      .block_y_o(fragment_y),
      .stamp_o  ()
  );

  // The fragment, or line of a walk, whose line is being read; its flags are read meanwhile. No flags are needed for a
  // fragment without samples, or in the block of the fragment before if that has samples: it hits.
  logic                             read_valid_q, read_walks_q, has_read_q, moves, looks, needs_flags, flags_are_busy;
  raster_pkg::fragment_packet_t read_q;
  logic [LINE-1:0]                  read_line_q;
  // Progress of a token: line of its walk, word of flags.
  logic               lines_done_q;
  logic [LINE-1:0]    walk_q;
  logic [WORD_X-1:0]  word_x_q;
  logic [BLOCK_Y-1:0] word_y_q;
  logic [BLOCK_X-1:0]               read_x;
  logic [BLOCK_Y-1:0]               read_y;
  logic [1:0]                       read_cleared;
  // The fragment or line whose tag has been compared.
  logic                             valid_q, walks_q, is_access, leaves;
  raster_pkg::fragment_packet_t fragment_q;
  logic [LINE-1:0]                  line_q;

  assign needs_flags      = fragment_i.mask != '0 && !(has_read_q && fragment_x == read_x && fragment_y == read_y);
  assign fragment_ready_o = state_q == SERVE ? !is_token && (!read_valid_q || moves) && !(flags_are_busy && needs_flags) :
                            state_q == DONE;
  assign takes_fragment   = fragment_valid_i && fragment_ready_o && state_q == SERVE;
  assign looks            = state_q == LOOK && !lines_done_q && (!read_valid_q || moves);
  assign moves            = !valid_q || leaves;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      read_valid_q <= 1'b0;
      has_read_q   <= 1'b0;
      valid_q      <= 1'b0;
    end else begin
      read_valid_q <= takes_fragment || looks || (read_valid_q && !moves);
      if (takes_fragment || state_q != SERVE) has_read_q <= state_q == SERVE && fragment_i.mask != '0;
      if (moves) valid_q <= read_valid_q;
    end
  end

  logic [LINE-1:0] line_read_address;
  always_ff @(posedge clk_i) begin
    if (takes_fragment) read_q <= fragment_i;
    if (takes_fragment || looks) begin
      read_walks_q <= looks;
      read_line_q  <= line_read_address;
    end
    if (moves) begin
      fragment_q <= read_q;
      walks_q    <= read_walks_q;
      line_q     <= read_line_q;
    end
  end

  // The lines.
  logic [STATE-1:0]   line_read, read_state, line_state_q, line_new, forward_q;
  logic               is_forwarded_q, is_next, line_writes;
  logic [LINE-1:0]    line_write_address;
  logic [LINE-1:0]    line_above_x;
  logic [BLOCK_X-1:0] block_x, line_x;
  logic [BLOCK_Y-1:0] block_y, line_y;
  logic               line_valid, line_dirty, line_falls, line_has_depth, line_has_color;
  logic [TAG_X-1:0]   tag_x;
  logic [TAG_Y-1:0]   tag_y;
  logic [STAMPS-1:0]  line_known, line_colored;
  logic [1:0]         line_cleared;

  logic [STAMP-1:0] stamp;
  block_stamp u_block_stamp (
      .tile_x_i (fragment_q.key.tile_x),
      .tile_y_i (fragment_q.key.tile_y),
      .stamp_i  (fragment_q.stamp),
      .block_x_o(block_x),
      .block_y_o(block_y),
      .stamp_o  (stamp)
  );
  block_stamp u_read_stamp (
      .tile_x_i (read_q.key.tile_x),
      .tile_y_i (read_q.key.tile_y),
      .stamp_i  (read_q.stamp),
      .block_x_o(read_x),
      .block_y_o(read_y),
      .stamp_o  ()
  );

  assign line_read_address  = state_q == LOOK ? walk_q : fragment_line;
  assign line_write_address = state_q == MARK ? walk_q : line_q;
  sram #(
      .WIDTH    (STATE),
      .DEPTH    (LINES == 1 ? 2 : LINES),
      .READS_OLD(0)
  ) u_lines (
      .clk_i,
      .read_i         (takes_fragment || looks),
      .read_address_i (line_read_address),
      .data_o         (line_read),
      .write_i        (line_writes),
      .write_address_i(line_write_address),
      .data_i         (line_new)
  );

  // A line that is read while it is written; and a line that the previous fragment writes as it leaves.
  always_ff @(posedge clk_i) begin
    if (takes_fragment || looks) begin
      is_forwarded_q <= line_writes && line_read_address == line_write_address;
      forward_q      <= line_new;
    end
  end
  assign is_next    = (is_access || (valid_q && walks_q)) && line_q == read_line_q;
  assign read_state = is_next ? line_new : is_forwarded_q ? forward_q : line_read;
  always_ff @(posedge clk_i) if (moves) line_state_q <= read_state;
  // line_dirty, line_falls and line_has_color are derived from the other fields and stored with them, to be known at once:
  // samples may have been written; an eviction clears flags; a stamp has colours.
  assign {line_valid, line_dirty, line_falls, tag_x, tag_y, line_known, line_colored, line_has_depth, line_has_color,
          line_cleared} = line_state_q[STATE-1-:REST];
  assign line_x = (BLOCK_X'(tag_x) << LINE_X) | (BLOCK_X'(line_q) & BLOCK_X'((1 << LINE_X) - 1));
  assign line_above_x = line_q >> LINE_X;
  assign line_y = (BLOCK_Y'(tag_y) << LINE_Y) | BLOCK_Y'(line_above_x);

  // The tag is compared on each path that the line may come by, before one of them is chosen.
  logic [TAG_X+TAG_Y-1:0] read_tag;
  logic                   read_hits, forward_hits, next_hits, found, hits_q, leaves_line_q;
  logic [1:0]             cleared_q;
  assign read_tag     = {TAG_X'(read_x >> LINE_X), TAG_Y'(read_y >> LINE_Y)};
  assign read_hits    = line_read[STATE-1] && line_read[STATE-4-:TAG_X+TAG_Y] == read_tag;
  assign forward_hits = forward_q[STATE-1] && forward_q[STATE-4-:TAG_X+TAG_Y] == read_tag;
  assign next_hits    = block_x == read_x && block_y == read_y;
  assign found        = is_next ? next_hits : is_forwarded_q ? forward_hits : read_hits;
  always_ff @(posedge clk_i) begin
    if (moves) begin
      hits_q        <= found;
      leaves_line_q <= read_walks_q || (read_q.mask != '0 && !found);
      cleared_q     <= read_cleared;
    end
  end

  // The flags.
  logic [WORD-1:0] word_depth, word_color, marks, token_word;
  logic [1:0]      token_writes, fills;  // colour, depth
  logic            falls;
  clear_flags u_flags (
      .clk_i,
      .rst_ni,
      .is_busy_o     (flags_are_busy),
      .reads_i       (takes_fragment && needs_flags),
      .block_x_i     (fragment_x),
      .block_y_i     (fragment_y),
      .read_x_i      (read_x),
      .read_y_i      (read_y),
      .cleared_o     (read_cleared),
      .fills_i       (fills & {2{falls}}),
      .falls_i       (leaves && falls),
      .line_x_i      (line_x),
      .line_y_i      (line_y),
      .token_reads_i (state_q == READ),
      .token_writes_i(token_writes),
      .word_x_i      (word_x_q),
      .word_y_i      (word_y_q),
      .word_i        (token_word),
      .word_depth_o  (word_depth),
      .word_color_o  (word_color)
  );

  // The result of the tag lookup.
  logic is_dirty, evicts, is_full, is_known;
  logic starts_color, uses, stores_depth;
  logic sets_state;
  logic [1:0] cleared;
  raster_pkg::depth_source_t source;
  logic [STAMPS-1:0] stamp_bit, known, colored, line_depth;
  logic              drops_depth_q;  // evicted depth is lost, and its flag stays

  assign is_access  = valid_q && !walks_q && fragment_q.mask != '0;
  assign sets_state = valid_q && !walks_q && fragment_q.kind == raster_pkg::PRIMITIVE_KIND_STATE;
  assign is_full    = fragment_q.mask == '1;
  assign stamp_bit  = STAMPS'(1) << stamp;
  assign stores_depth = line_has_depth && !drops_depth_q;
  assign line_depth   = stores_depth ? line_known : '0;
  assign is_dirty     = line_valid && (drops_depth_q ? line_has_color : line_dirty);
  assign evicts       = is_dirty && leaves_line_q;
  assign fills        = line_cleared & {line_has_color, line_depth != '0};
  assign falls        = valid_q && evicts && (drops_depth_q ? fills[1] : line_falls);

  assign cleared      = hits_q ? line_cleared : cleared_q;
  assign known        = hits_q ? line_known : '0;
  assign colored      = hits_q ? line_colored : '0;
  assign is_known     = (known & stamp_bit) != '0;
  assign starts_color = is_access && fragment_q.state.color_write && (colored & stamp_bit) == '0;
  logic keeps_part, tests_alpha;  // a write keeps a part of the stored value; alpha may prevent a write
  always_comb begin
    source = raster_pkg::DEPTH_SOURCE_NONE;
    if (is_known) source = raster_pkg::DEPTH_SOURCE_CHIP;
    else if (fragment_q.state.depth_test != raster_pkg::DEPTH_FUNC_ALWAYS || !is_full || keeps_part ||
             (tests_alpha && fragment_q.state.depth_write))
      source = cleared[0] ? raster_pkg::DEPTH_SOURCE_CLEAR : raster_pkg::DEPTH_SOURCE_MEMORY;
    if (!is_access) source = raster_pkg::DEPTH_SOURCE_NONE;
  end
  // With a stencil: a write keeps a part of the stored word, the stencil is read; a clear has a stencil value.
  logic           writes_word;  // the depth or the stencil may change
  logic [CODE-1:0] clear_word;
  generate
    if (raster_pkg::STENCIL_BITS != 0) begin : gen_stencil
      localparam int SIDES = raster_pkg::DEPTH_FUNC_BITS + 16;  // bit of a token that selects the front side
      localparam int OP = raster_pkg::DEPTH_FUNC_BITS;  // eight operation codes per side
      localparam int UPDATE_SIDES = 3 * OP + 8;
      logic [7:0] clear_q;
      logic [1:0] passes_all_q, replaces_q;  // by side: every value passes; a passing value replaces the stored one
      logic       sets_test, sets_update, replaces;
      assign sets_test   = leaves && sets_state && fragment_q.state.depth_test == raster_pkg::STATE_REGISTER_STENCIL_TEST;
      assign sets_update = leaves && sets_state && fragment_q.state.depth_test == raster_pkg::STATE_REGISTER_STENCIL_UPDATE;
      always_ff @(posedge clk_i) begin
        if (sets_test && fragment_q.code[SIDES]) clear_q <= fragment_q.code[raster_pkg::DEPTH_FUNC_BITS+:8];
        for (int i = 0; i < 2; i++) begin
          if (sets_test && fragment_q.code[SIDES+i])
            passes_all_q[i] <= fragment_q.code[raster_pkg::DEPTH_FUNC_BITS-1:0] == raster_pkg::DEPTH_FUNC_ALWAYS;
          if (sets_update && fragment_q.code[UPDATE_SIDES+i])
            replaces_q[i] <= (fragment_q.code[2*OP+:OP] == raster_pkg::STENCIL_OP_ZERO ||
                              fragment_q.code[2*OP+:OP] == raster_pkg::STENCIL_OP_REPLACE) &&
                             fragment_q.code[UPDATE_SIDES-1-:8] == 8'hff;
        end
      end
      assign replaces    = passes_all_q[fragment_q.state.is_back] && replaces_q[fragment_q.state.is_back];
      assign keeps_part  = fragment_q.state.depth_write ? !(fragment_q.state.tests_stencil && replaces) :
                                                          fragment_q.state.tests_stencil;
      assign writes_word = fragment_q.state.depth_write || fragment_q.state.writes_stencil;
      assign clear_word  = {clear_q, fragment_i.code[0+:Z]};
    end else begin : gen_no_stencil
      assign keeps_part  = 1'b0;
      assign writes_word = fragment_q.state.depth_write;
      assign clear_word  = fragment_i.code[0+:Z];
    end
  endgenerate
  assign uses = source != raster_pkg::DEPTH_SOURCE_NONE || fragment_q.state.depth_write;

  // Colour operations: a register that tokens set. Where they read stored colours, a stamp's colours are requested
  // once; with an alpha test a sample that passes the depth test may still not be written, so depths are requested.
  raster_pkg::depth_source_t color_source;
  logic [REST-1:0]           line_rest;
  generate
    if (raster_pkg::BLEND_LANES != 0) begin : gen_reads_color
      localparam int READS = 28;  // the bit of an operations word that says that stored colours are read
      logic              reads_color_q;
      logic [STAMPS-1:0] color_known, color_known_new;
      assign color_known     = hits_q ? line_state_q[KNOWN-1:0] : '0;
      assign color_known_new = color_known | (color_source != raster_pkg::DEPTH_SOURCE_NONE ? stamp_bit : '0);
      assign line_new        = {line_rest, color_known_new};
      always_comb begin
        color_source = raster_pkg::DEPTH_SOURCE_NONE;
        if (is_access && fragment_q.state.color_write && reads_color_q) begin
          color_source = cleared[1] ? raster_pkg::DEPTH_SOURCE_CLEAR : raster_pkg::DEPTH_SOURCE_MEMORY;
          if ((color_known & stamp_bit) != '0) color_source = raster_pkg::DEPTH_SOURCE_CHIP;
        end
      end
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) reads_color_q <= 1'b0;
        else if (leaves && sets_state && fragment_q.state.depth_test == raster_pkg::STATE_REGISTER_COLOR_OPS)
          reads_color_q <= fragment_q.code[READS];
      end
    end else begin : gen_writes_color
      assign line_new     = line_rest;
      assign color_source = raster_pkg::DEPTH_SOURCE_NONE;
    end
    if (TESTS_ALPHA) begin : gen_tests_alpha
      logic tests_alpha_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) tests_alpha_q <= 1'b0;
        else if (leaves && sets_state && fragment_q.state.depth_test == raster_pkg::STATE_REGISTER_ALPHA_TEST)
          tests_alpha_q <= fragment_q.code[2:0] != raster_pkg::DEPTH_FUNC_ALWAYS ||
                           (raster_pkg::MSAA_SAMPLES > 1 && fragment_q.code[11]);
      end
      assign tests_alpha = tests_alpha_q;
    end else begin : gen_no_alpha
      assign tests_alpha = 1'b0;
    end
  endgenerate

  logic [STAMPS-1:0] known_new, colored_new;
  logic              has_depth_new;
  assign known_new     = known | (uses ? stamp_bit : '0);
  assign colored_new   = colored | (fragment_q.state.color_write ? stamp_bit : '0);
  assign has_depth_new = (hits_q && line_has_depth) || writes_word;
  assign line_writes   = (leaves && (is_access || walks_q)) || (state_q == MARK && !lines_done_q);
  always_comb begin
    line_rest = {
      1'b1, has_depth_new || colored_new != '0, (cleared & {colored_new != '0, has_depth_new && known_new != '0}) != '0,
      TAG_X'(block_x >> LINE_X), TAG_Y'(block_y >> LINE_Y), known_new, colored_new, has_depth_new, colored_new != '0, cleared
    };
    if (walks_q || state_q == MARK) line_rest[REST-1] = 1'b0;
  end

  // Evicted blocks whose data wait in a slot. The wanted block may be among them.
  logic [VICTIM-1:0]   oldest_q;  // number of the oldest, modulo VICTIMS
  logic [WRITES-1:0]   waiting_q, wanted, writes;
  logic [BLOCK_X-1:0]  victim_x_q[0:VICTIMS-1];
  logic [BLOCK_Y-1:0]  victim_y_q[0:VICTIMS-1];
  logic [VICTIM-1:0]   next_victim;
  logic                orders_all;

  // Each slot is compared in its place as the fragment moves; then the results are ordered by age, oldest first.
  logic [VICTIMS-1:0] is_same_q, is_same_by_age;
  logic               adds_victim;
  assign adds_victim    = leaves && evicts;
  assign next_victim    = oldest_q + VICTIM'(waiting_q);
  assign is_same_by_age = VICTIMS'({is_same_q, is_same_q} >> oldest_q);
  always_ff @(posedge clk_i) begin
    for (int v = 0; v < VICTIMS; v++)
      if (moves) is_same_q[v] <= adds_victim && next_victim == VICTIM'(v) ? line_x == read_x && line_y == read_y :
                                                                            victim_x_q[v] == read_x && victim_y_q[v] == read_y;
  end
  always_comb begin
    wanted = '0;
    for (int age = 0; age < VICTIMS; age++)
      if (WRITES'(age) < waiting_q && is_same_by_age[age]) wanted = WRITES'(age + 1);
    if (!is_access || hits_q) wanted = '0;
    writes = evicts && wanted == '0 && waiting_q == WRITES'(VICTIMS) ? WRITES'(1) : wanted;
    if (state_q == ORDER) writes = waiting_q;
  end
  assign orders_all = state_q == ORDER && (waiting_q == '0 || order_ready_i);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      oldest_q  <= '0;
      waiting_q <= '0;
    end else if (leaves || orders_all) begin
      oldest_q  <= oldest_q + VICTIM'(writes);
      waiting_q <= waiting_q - writes + WRITES'(evicts && leaves);
    end
  end

  always_ff @(posedge clk_i) begin
    if (adds_victim) begin
      victim_x_q[next_victim] <= line_x;
      victim_y_q[next_victim] <= line_y;
    end
  end

  // Items and orders leave together, when there is room for both, whichever of them leaves.
  logic is_item, is_order, is_settled;
  assign is_settled     = valid_q && !(falls && flags_are_busy);
  assign is_item        = !walks_q || evicts;
  assign is_order       = writes != '0 || source == raster_pkg::DEPTH_SOURCE_MEMORY ||
                          color_source == raster_pkg::DEPTH_SOURCE_MEMORY;
  assign item_valid_o   = is_settled && is_item && order_ready_i;
  assign order_valid_o  = state_q == ORDER ? waiting_q != '0 : is_settled && is_order && item_ready_i;
  assign leaves         = is_settled && item_ready_i && order_ready_i;
  assign order_o.writes = writes;
  assign order_o.reads  = source == raster_pkg::DEPTH_SOURCE_MEMORY;
  assign order_o.tile_x = fragment_q.key.tile_x;
  assign order_o.tile_y = fragment_q.key.tile_y;
  assign order_o.stamp  = fragment_q.stamp;

  always_comb begin
    item_o = fragment_q;
    if (walks_q) begin
      item_o.mask           = '0;
      item_o.ends_visit     = 1'b0;
    end
  end
  assign found_o.line         = line_q;
  assign found_o.stamp        = stamp;
  assign found_o.source       = source;
  assign found_o.starts_color = starts_color;
  assign found_o.evicts       = evicts;
  assign found_o.tag_x        = TAG_X'(line_x >> LINE_X);
  assign found_o.tag_y        = TAG_Y'(line_y >> LINE_Y);
  assign found_o.depth        = line_depth;
  assign found_o.color        = line_colored;
  assign found_o.fills        = fills;
  generate
    if (raster_pkg::BLEND_LANES != 0) begin : gen_color_source
      assign found_o.color_source = color_source;
      assign order_o.reads_color  = color_source == raster_pkg::DEPTH_SOURCE_MEMORY;
    end
  endgenerate
  assign is_cleared_o = leaves && source == raster_pkg::DEPTH_SOURCE_CLEAR;

  // Tokens.
  logic [WORD_X-1:0]       first_word, last_word;
  logic [BLOCK_Y-1:0]      first_y, last_y;
  logic [BLOCK_X-1:0]      first_x, last_x;
  logic                    words_done_q, ends_words, is_last_line, ends_mark, next_word;
  localparam bit COMPRESSES = raster_pkg::COMPRESS_UNIT != 0;
  logic                    plane_q;  // 1: colour
  logic                    pixels_q;  // then: which blocks have one colour per pixel
  logic                    is_last_plane;
  logic [WORD-1:0]         word, bits_q;  // a word of flags on its way to memory; flags of resolved colours
  logic [STAMP-1:0]        stamp_q;
  logic                    resolves, ends_block, begins;
  logic [CODE-1:0]         clear_depth_q;
  logic [COLOR-1:0]        clear_color_q, color;

  rop u_rop (
      .rgba_i (fragment_i.code[Z+:raster_pkg::VERTEX_COLOR_BITS]),
      .color_o(color)
  );

  assign begins       = state_q == SERVE && fragment_valid_i && is_token && !read_valid_q && !valid_q;
  assign last_x       = (BLOCK_X'(fragment_i.key.tile_x) << TILE_BITS) | BLOCK_X'((1 << TILE_BITS) - 1);
  assign last_y       = (BLOCK_Y'(fragment_i.key.tile_y) << TILE_BITS) | BLOCK_Y'((1 << TILE_BITS) - 1);
  assign first_x      = clears_bin ? last_x & ~BIN_X : '0;
  assign first_y      = clears_bin ? last_y & ~BIN_Y : '0;
  assign first_word   = WORD_X'(first_x >> BIT);
  assign last_word    = WORD_X'(last_x >> BIT);
  assign is_last_line = walk_q == LINE'(LINES - 1);
  assign ends_words   = word_x_q == last_word && word_y_q == last_y;
  assign ends_mark    = (lines_done_q || is_last_line) && (words_done_q || ends_words);
  assign marks        = (word_x_q == last_word ? ~({WORD{1'b1}} << 1 << bit_of(last_x)) : '1) &
                        (word_x_q == first_word ? {WORD{1'b1}} << bit_of(first_x) : '1);
  assign token_word   = state_q == MARK ? marks | (clears_bin ? word_color : '0) : '0;
  assign word         = COMPRESSES && pixels_q ? pixel_word_i : plane_q ? word_color : word_depth;
  assign resolves     = raster_pkg::FRAME_CLEARS == 0 && plane_q && !pixels_q;
  assign is_last_plane = COMPRESSES ? pixels_q : plane_q;
  assign ends_block   = request_valid_o && request_ready_i && stamp_q == STAMP'(STAMPS - 1);
  assign next_word    = (state_q == SEND && !resolves && request_ready_i) || (state_q == RESOLVE && (bits_q == '0 || (ends_block && bits_q[WORD-1:1] == '0)));

  always_comb begin
    state_d = state_q;
    case (state_q)
      SERVE: if (begins) state_d = skips_walk ? ORDER : LOOK;
      LOOK: if (leaves && line_q == LINE'(LINES - 1)) state_d = ORDER;
      ORDER: if (orders_all) state_d = DRAIN;
      DRAIN: if (drained_i) state_d = is_clear && !clears_bin ? MARK : READ;
      MARK:
      if (ends_mark) state_d = DONE;
      else if (clears_bin) state_d = READ;
      READ: state_d = is_clear ? MARK : SEND;
      SEND:
      if (resolves) state_d = RESOLVE;
      else if (next_word) state_d = ends_words && is_last_plane ? DONE : READ;
      RESOLVE: if (next_word) state_d = ends_words && is_last_plane ? DONE : READ;
      default: if (fragment_valid_i) state_d = SERVE;
    endcase
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) state_q <= SERVE;
    else state_q <= state_d;
  end

  always_ff @(posedge clk_i) begin
    if (state_q == SERVE || state_q == DRAIN) begin
      walk_q       <= '0;
      lines_done_q <= state_q == DRAIN && clears_bin;  // the lines are empty
      words_done_q <= 1'b0;
      word_x_q     <= first_word;
      word_y_q     <= first_y;
      plane_q      <= !is_clear && drops_depth_q;  // a flush that drops depth writes no flags of it
      pixels_q     <= 1'b0;
    end else begin
      if (looks || state_q == MARK) begin
        walk_q <= walk_q + 1'b1;
        if (is_last_line) lines_done_q <= 1'b1;
      end
      if (state_q == MARK || next_word) begin
        word_x_q <= word_x_q == last_word ? first_word : word_x_q + 1'b1;
        if (word_x_q == last_word) word_y_q <= ends_words ? '0 : word_y_q + 1'b1;
        if (ends_words) words_done_q <= 1'b1;
        if (ends_words) plane_q <= 1'b1;
        if (ends_words && plane_q) pixels_q <= COMPRESSES;
      end
    end
    if (state_q == SEND) bits_q <= word_color;
    else if (state_q == RESOLVE && (!bits_q[0] || ends_block)) bits_q <= bits_q >> 1;
    if (state_q == SEND) stamp_q <= '0;
    else if (request_valid_o && request_ready_i) stamp_q <= ends_block ? '0 : stamp_q + 1'b1;
    if (state_q == MARK && fragment_i.state.depth_write) clear_depth_q <= clear_word;
    if (state_q == MARK && fragment_i.state.color_write) clear_color_q <= color;
  end

  // A fast clear says whether later evictions lose their depth, a flush whether the depth now on the chip is lost.
  logic drops_depth;
  assign drops_depth = fragment_i.state.depth_test == raster_pkg::DEPTH_FUNC_NEVER;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) drops_depth_q <= 1'b0;
    else if (begins) drops_depth_q <= is_clear ? drops_depth_q : drops_depth;
    else if (state_q == DONE) drops_depth_q <= drops_depth && is_clear;
  end
  assign clear_depth_o = clear_depth_q;
  assign clear_color_o = clear_color_q;

  always_comb begin
    token_writes = '0;
    if (state_q == MARK) token_writes = {fragment_i.state.color_write, fragment_i.state.depth_write} & {2{!words_done_q}};
    if (state_q == RESOLVE) token_writes = {next_word, 1'b0};
  end

  logic [BLOCK_X-1:0] resolve_x_q;  // block column of the flag in bit 0 of bits_q
  always_ff @(posedge clk_i) begin
    if (state_q == SEND) resolve_x_q <= BLOCK_X'(word_x_q) << BIT;
    else if (state_q == RESOLVE && (!bits_q[0] || ends_block)) resolve_x_q <= resolve_x_q + 1'b1;
  end

  // A fast clear removes these bits; a flush that resolves cleared blocks to one colour per pixel sets them.
  assign pixel_word_o.reads  = COMPRESSES && state_q == READ;
  assign pixel_word_o.writes = COMPRESSES && token_writes[1];
  assign pixel_word_o.x      = word_x_q;
  assign pixel_word_o.y      = word_y_q;
  assign pixel_word_o.word   = !COMPRESSES ? '0 :
                          state_q == RESOLVE ? pixel_word_i | word_color : pixel_word_i & ~marks & {WORD{clears_bin}};

  assign request_word_o  = word;
  assign request_valid_o = (state_q == SEND && !resolves) || (state_q == RESOLVE && bits_q[0]);
  assign is_resolved_o   = state_q == RESOLVE && request_valid_o && request_ready_i;
  // The data of a cleared block at a flush, and the flags that follow those of colour.
  localparam int CLEARED_COLORS = COMPRESSES ? raster_pkg::PIXELS : raster_pkg::MEMORY_COLORS;
  logic [raster_pkg::TILE_X_BITS-1:0] resolve_tile_x;
  logic [raster_pkg::TILE_Y_BITS-1:0] resolve_tile_y;
  logic [INDEX-1:0]                   resolve_stamp;
  stamp_address u_resolve_address (
      .block_x_i(resolve_x_q),
      .block_y_i(word_y_q),
      .stamp_i  (stamp_q),
      .tile_x_o (resolve_tile_x),
      .tile_y_o (resolve_tile_y),
      .stamp_o  (resolve_stamp)
  );
  always_comb begin
    request_o          = '0;
    request_o.is_write = 1'b1;
    request_o.strobe   = '1;
    request_o.run      = RUN'(STAMPS) - RUN'(stamp_q);
    request_o.tile_y   = resolve_tile_y;  // a word of flags has the same tile_y: that of its row of blocks
    if (state_q == RESOLVE) begin
      request_o.plane  = COMPRESSES ? raster_pkg::TILE_PLANE_PIXEL_COLOR : raster_pkg::TILE_PLANE_COLOR;
      request_o.strobe = SAMPLES'({CLEARED_COLORS{1'b1}});
      request_o.tile_x = resolve_tile_x;
      request_o.stamp  = resolve_stamp;
      for (int s = 0; s < SAMPLES; s++) request_o.data[s*LANE+:LANE] = LANE'(clear_color_q);
    end else begin
      request_o.plane          = pixels_q ? raster_pkg::TILE_PLANE_PIXEL_FLAGS :
                                 plane_q ? raster_pkg::TILE_PLANE_COLOR_FLAGS : raster_pkg::TILE_PLANE_DEPTH_FLAGS;
      request_o.run            = RUN'(last_word) - RUN'(word_x_q) + 1'b1;
      request_o.tile_x         = raster_pkg::TILE_X_BITS'(word_x_q);
      request_o.stamp          = INDEX'(word_y_q) & INDEX'((1 << TILE_BITS) - 1);
      request_o.data[WORD-1:0] = word;
    end
  end

  assign at_token_o = state_q > DRAIN;
  assign idle_o     = state_q == SERVE && !fragment_valid_i && !read_valid_q && !valid_q;

endmodule
