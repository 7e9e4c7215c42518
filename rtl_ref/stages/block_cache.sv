// Framebuffer of blocks: the depth and colour of blocks of 4x4 pixels on the chip, a non-blocking, direct-mapped write-back
// cache of the buffers in memory.
//
//   fragment -> cache_tags -> items -> [X: depth RAM] <-> depth_test -> (texture_unit) -> [W: color_write]
//                   '------ orders -> requests <- victims -----'------------'
//
// cache_tags looks fragments up as they come and orders what they need from memory; up to CACHE_QUEUE of them wait here for
// their answers. X hands them to depth_test with what is stored under them: from the RAM, the clear value, or the answer,
// which goes into the RAM with what is written. W writes colours; with blending it has answers of its own. A block that leaves
// goes from the RAMs into a slot of `victims`, its depths in X and its colours in W, a stamp a cycle, first the one that is
// about to be overwritten, and from there to memory.
// Specification: model/stages/block_cache.hpp; the times are those of model/engines/cycle/block_timing.hpp.
module block_cache (
    input logic clk_i,
    /* verilator lint_off UNUSEDSIGNAL */  // without a texture unit
    input logic power_on_ni,
    /* verilator lint_on UNUSEDSIGNAL */
    input logic rst_ni,

    // From primitive_join
    input  logic                         fragment_valid_i,
    output logic                         fragment_ready_o,
    input  raster_pkg::fragment_packet_t fragment_i,

    // To depth_test, which takes it at once; what is stored under it in the cycle after that
    output logic                                                       tested_valid_o,
    output raster_pkg::fragment_packet_t                               tested_o,
    output logic [raster_pkg::SAMPLES*raster_pkg::STORED_DEPTH_BITS-1:0] stored_depth_o,
    // And the constants of its triangle, where they are apart from fragments
    input  raster_pkg::context_packet_t                                context_i,

    // From depth_test: the write of the fragment of the cycle before
    /* verilator lint_off UNUSEDSIGNAL */  // where it goes is known here
    input logic                      write_valid_i,
    input raster_pkg::write_packet_t write_i,
    /* verilator lint_on UNUSEDSIGNAL */
    input logic [raster_pkg::SAMPLES*raster_pkg::STORED_DEPTH_BITS-1:0] word_i,  // what its samples have from now on

    // To and from memory_port
    output logic                         request_valid_o,
    input  logic                         request_ready_i,
    output raster_pkg::memory_request_t  request_o,        // without its data
    output logic [8*raster_pkg::REQUEST_BYTES-1:0] request_bytes_o,  // which are these, as they lie in memory
    input  logic                         response_valid_i,
    output logic                         response_ready_o,
    /* verilator lint_off UNUSEDSIGNAL */  // lanes wider than a depth code
    input  raster_pkg::memory_response_t response_i,
    /* verilator lint_on UNUSEDSIGNAL */

    // To and from the memory of textures, where there is a texture unit
    output logic                         texture_valid_o,
    output raster_pkg::texture_request_t texture_o,
    output logic                         texel_ready_o,
    /* verilator lint_off UNUSEDSIGNAL */
    input  logic                         texture_ready_i,
    input  logic                         texel_valid_i,
    input  raster_pkg::texel_beat_t      texel_i,
    /* verilator lint_on UNUSEDSIGNAL */

    // What W takes from the texture unit, for the co-simulation
    output logic                      color_valid_o,
    output logic                      color_ready_o,
    output raster_pkg::color_packet_t color_o,

    // Stamps that this cycle adds to the counters
    output logic [1:0] fill_o,
    output logic [1:0] evict_o,
    output logic [1:0] clear_o,

    // Samples of triangles, points and lines that are counted behind the texture, where the alpha test is
    output logic [$clog2(raster_pkg::SAMPLES+1)-1:0] written_o,
    output logic [$clog2(raster_pkg::SAMPLES+1)-1:0] killed_o,

    // What the texture unit makes of its cache: a sample was looked up, all of it was there, a line was asked for; lowest first
    output logic [6:0] texture_use_o,

    output logic at_token_o,  // a clear or a flush is at work, behind everything
    output logic idle_o       // nothing is under way
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int PIXELS = raster_pkg::PIXELS;
  localparam int COUNT = $clog2(SAMPLES + 1);
  localparam int CODE = raster_pkg::STORED_DEPTH_BITS;  // a depth, the stencil above it where there is one
  localparam int CODES = raster_pkg::ALL_FRAGMENT_BITS;  // of a pixel of a fragment; the lowest is its depth
  localparam int Z = raster_pkg::DEPTH_CODE_BITS;
  localparam bit HAS_STENCIL = raster_pkg::STENCIL_BITS != 0;
  localparam int COLOR = raster_pkg::STORED_COLOR_BITS;
  localparam int LANE = raster_pkg::MEMORY_LANE_BITS;
  localparam int INDEX = raster_pkg::STAMP_INDEX_BITS;
  localparam int SIDE_BITS = $clog2(raster_pkg::BLOCK_SIDE);
  localparam int TILE_BITS = $clog2(raster_pkg::BLOCKS_PER_ROW);
  localparam int STAMPS = raster_pkg::BLOCK_SIDE * raster_pkg::BLOCK_SIDE;  // of a block
  localparam int STAMP = (STAMPS == 1) ? 1 : 2 * SIDE_BITS;
  localparam int BLOCK_X = raster_pkg::TILE_X_BITS + TILE_BITS;
  localparam int BLOCK_Y = raster_pkg::TILE_Y_BITS + TILE_BITS;
  localparam int LINES = raster_pkg::CACHE_LINES;
  localparam int LINE = (LINES == 1) ? 1 : raster_pkg::LINE_X_BITS + raster_pkg::LINE_Y_BITS;
  localparam int ADDRESS = LINE + STAMP;
  localparam int VICTIMS = raster_pkg::CACHE_VICTIMS;
  localparam int VICTIM = $clog2(VICTIMS);
  localparam int WRITES = $clog2(VICTIMS + 1);
  localparam int QUEUE = raster_pkg::CACHE_QUEUE;
  localparam int LINE_X = raster_pkg::LINE_X_BITS;
  localparam int LINE_Y = raster_pkg::LINE_Y_BITS;
  localparam int TAG_X = (BLOCK_X > LINE_X) ? BLOCK_X - LINE_X : 1;
  localparam int TAG_Y = (BLOCK_Y > LINE_Y) ? BLOCK_Y - LINE_Y : 1;
  localparam bit APART = raster_pkg::COORDINATES != 0 && raster_pkg::MSAA_SAMPLES == 1;  // constants of triangles
  localparam int NUMBER = $clog2(raster_pkg::CONTEXT_SLOTS + QUEUE + 16);                // of raster_top
  localparam int STORED = raster_pkg::FRAGMENT_PACKET_BITS -
                          (APART ? raster_pkg::COORDINATE_FRAME_BITS - NUMBER +
                                   (PIXELS - 1) * (CODES - raster_pkg::ALL_AFFINE_CODE_BITS) : 0);
  localparam int ITEM = STORED + LINE + STAMP + 3 + 1 + TAG_X + TAG_Y + 2 * STAMPS + 2;
  localparam bit PACKS = raster_pkg::COORDINATES == 0 && raster_pkg::BLEND_LANES == 0 && raster_pkg::DITHER_UNIT == 0 &&
                         raster_pkg::ALPHA_UNIT == 0;  // items have colours as they are stored
  localparam int ORDER = WRITES + 1 + raster_pkg::TILE_X_BITS + raster_pkg::TILE_Y_BITS + INDEX;
  localparam bit BLENDS = raster_pkg::BLEND_LANES != 0;
  localparam bit LATE = raster_pkg::ALPHA_UNIT != 0 && raster_pkg::COORDINATES != 0;  // alpha is tested behind the texture
  localparam bit HAS_STATE = BLENDS || LATE || raster_pkg::DITHER_UNIT != 0;  // colours have operations that tokens set
  localparam int SHADED = raster_pkg::SHADED_COLOR_BITS;

  localparam int PLACES = raster_pkg::COORDINATES == 0 ? 2 : raster_pkg::TEXTURE_STAMPS;  // between X and W
  localparam int BEHIND = $clog2(PLACES + 1);
  localparam int RUN = raster_pkg::RUN_BITS;
  localparam bit COMPRESSES = raster_pkg::COMPRESS_UNIT != 0;
  localparam int PIXEL_COLORS = PIXELS * COLOR;  // of a stamp, one a pixel

  function automatic [STAMPS-1:0] lowest(input [STAMPS-1:0] set);
    lowest = set & (~set + 1'b1);
  endfunction
  function automatic [STAMP-1:0] number_of(input [STAMPS-1:0] one);
    number_of = '0;
    for (int i = 0; i < STAMPS; i++) if (one[i]) number_of = number_of | STAMP'(i);
  endfunction

  function automatic [COUNT-1:0] popcount(input [SAMPLES-1:0] mask);
    popcount = '0;
    for (int i = 0; i < SAMPLES; i++) popcount = popcount + COUNT'(mask[i]);
  endfunction

  // Of the lowest one, how many follow each other without a gap.
  function automatic [RUN-1:0] run_of(input [STAMPS-1:0] set);
    logic [STAMPS-1:0] gaps;  // above the lowest, from the first one that is missing on
    gaps   = ~set & ~(lowest(set) - 1'b1);
    run_of = '0;
    for (int i = 0; i < STAMPS; i++)
      if (set[i] && (gaps & ((STAMPS'(2) << i) - 1'b1)) == '0) run_of = run_of + 1'b1;
  endfunction

  genvar s;

  // ------------------------------------------------------------------------------------------------ tags, items, orders
  logic                             made_valid, made_ready, made_starts_color, made_evicts;
  raster_pkg::fragment_packet_t made;
  logic [LINE-1:0]                  made_line;
  logic [STAMP-1:0]                 made_stamp;
  raster_pkg::depth_source_t        made_source;
  /* verilator lint_off UNUSEDSIGNAL */  // without blending
  logic [raster_pkg::DEPTH_SOURCE_BITS-1:0] made_color_source;
  logic                             ordered_reads_color;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [1:0]                       made_fills;
  logic [BLOCK_X-1:0]               made_x;
  logic [BLOCK_Y-1:0]               made_y;
  logic [STAMPS-1:0]                made_depth, made_color;
  logic                             ordered_valid, ordered_ready, ordered_reads;
  logic [WRITES-1:0]                ordered_writes;
  logic [raster_pkg::TILE_X_BITS-1:0] ordered_x;
  logic [raster_pkg::TILE_Y_BITS-1:0] ordered_y;
  logic [INDEX-1:0]                 ordered_stamp;
  logic                             drained, flush_valid, tags_are_idle, is_cleared, is_resolved;
  localparam int WORD_X = (BLOCK_X > $clog2(raster_pkg::FLAG_WORD)) ? BLOCK_X - $clog2(raster_pkg::FLAG_WORD) : 1;
  /* verilator lint_off UNUSEDSIGNAL */  // without pixel_colors
  logic                             pixel_reads, pixel_writes;
  logic [WORD_X-1:0]                pixel_word_x;
  logic [BLOCK_Y-1:0]               pixel_word_y;
  logic [raster_pkg::FLAG_WORD-1:0] pixel_word_new;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [raster_pkg::FLAG_WORD-1:0] pixel_word;
  /* verilator lint_off UNUSEDSIGNAL */  // its data are flush_word, or the clear value
  raster_pkg::memory_request_t  flush_request;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [raster_pkg::FLAG_WORD-1:0] flush_word;
  logic [CODE-1:0]                  clear_depth;
  logic [COLOR-1:0]                 clear_color;

  cache_tags u_tags (
      .clk_i,
      .rst_ni,
      .fragment_valid_i,
      .fragment_ready_o,
      .fragment_i,
      .item_valid_o       (made_valid),
      .item_ready_i       (made_ready),
      .item_o             (made),
      .item_line_o        (made_line),
      .item_stamp_o       (made_stamp),
      .item_source_o      (made_source),
      .item_starts_color_o(made_starts_color),
      .item_color_source_o(made_color_source),
      .evicts_o           (made_evicts),
      .evicts_x_o         (made_x),
      .evicts_y_o         (made_y),
      .evicts_depth_o     (made_depth),
      .evicts_color_o     (made_color),
      .evicts_fills_o     (made_fills),
      .order_valid_o      (ordered_valid),
      .order_ready_i      (ordered_ready),
      .order_writes_o     (ordered_writes),
      .order_reads_o      (ordered_reads),
      .order_reads_color_o(ordered_reads_color),
      .order_tile_x_o     (ordered_x),
      .order_tile_y_o     (ordered_y),
      .order_stamp_o      (ordered_stamp),
      .drained_i          (drained),
      .request_valid_o    (flush_valid),
      .request_ready_i,
      .request_o          (flush_request),
      .request_word_o     (flush_word),
      .pixel_reads_o      (pixel_reads),
      .pixel_writes_o     (pixel_writes),
      .pixel_word_x_o     (pixel_word_x),
      .pixel_word_y_o     (pixel_word_y),
      .pixel_word_o       (pixel_word_new),
      .pixel_word_i       (pixel_word),
      .clear_depth_o      (clear_depth),
      .clear_color_o      (clear_color),
      .is_cleared_o       (is_cleared),
      .is_resolved_o      (is_resolved),
      .at_token_o,
      .idle_o             (tags_are_idle)
  );

  logic                             item_valid, takes_item, starts_color, evicts;
  raster_pkg::fragment_packet_t item;
  logic [LINE-1:0]                  item_line;
  logic [STAMP-1:0]                 item_stamp;
  logic [raster_pkg::DEPTH_SOURCE_BITS-1:0] source;
  logic [1:0]                       fills;
  logic [BLOCK_X-1:0]               evicts_x;
  logic [BLOCK_Y-1:0]               evicts_y;
  logic [STAMPS-1:0]                evicts_depth, evicts_color;
  localparam int BITS = ITEM + (BLENDS ? 2 : 0);
  logic [BITS-1:0] made_bits, item_bits;
  // Of a block that leaves the tag: its line is the item's.
  logic [TAG_X-1:0] evicts_tag_x;
  logic [TAG_Y-1:0] evicts_tag_y;
  /* verilator lint_off UNUSEDSIGNAL */  // wider than a block's y where the cache is larger than the target
  logic [LINE-1:0]  line_above_x;
  /* verilator lint_on UNUSEDSIGNAL */
  assign made_bits[ITEM-1:0] = {made_line, made_stamp, made_source, made_starts_color, made_evicts, TAG_X'(made_x >> LINE_X),
                                TAG_Y'(made_y >> LINE_Y), made_depth, made_color, made_fills, made_stored};
  assign {item_line, item_stamp, source, starts_color, evicts, evicts_tag_x, evicts_tag_y, evicts_depth, evicts_color, fills,
          item_stored} = item_bits[ITEM-1:0];
  logic [STORED-1:0] made_stored, item_stored;
  stored_fragment #(
      .APART (APART),
      .NUMBER(NUMBER),
      .WIDTH (STORED)
  ) u_stored (
      .fragment_i(made_packed),
      .bits_o    (made_stored),
      .bits_i    (item_stored),
      .fragment_o(item)
  );
  assign line_above_x = item_line >> LINE_X;
  assign evicts_x = (BLOCK_X'(evicts_tag_x) << LINE_X) | (BLOCK_X'(item_line) & BLOCK_X'((1 << LINE_X) - 1));
  assign evicts_y = (BLOCK_Y'(evicts_tag_y) << LINE_Y) | BLOCK_Y'(line_above_x);
  raster_pkg::fragment_packet_t made_packed;
  generate
    if (PACKS) begin : gen_packed
      logic [PIXELS*COLOR-1:0] made_colors;
      for (s = 0; s < PIXELS; s++) begin : gen_rop
        rop u_rop (
            .rgba_i (made.code[s*CODES+Z+:raster_pkg::VERTEX_COLOR_BITS]),
            .color_o(made_colors[s*COLOR+:COLOR])
        );
      end
      always_comb begin
        made_packed = made;
        for (int i = 0; i < PIXELS; i++)
          if (i != 0 || !HAS_STENCIL || made.kind != raster_pkg::PRIMITIVE_KIND_STATE)  // whose word is in the first
            made_packed.code[i*CODES+Z+:raster_pkg::VERTEX_COLOR_BITS] =
                raster_pkg::VERTEX_COLOR_BITS'(made_colors[i*COLOR+:COLOR]);
      end
    end else begin : gen_whole
      assign made_packed = made;
    end
  endgenerate
  // Of several samples a pixel depths and colours are most of an item, and nobody looks at them here.
  localparam int FURTHER = PIXELS * (raster_pkg::MSAA_SAMPLES - 1) * Z;
  logic items_are_done;
  registered_fifo #(
      .WIDTH (BITS),
      .DEPTH (QUEUE),
      .STORED(FURTHER == 0 ? 0 : FURTHER + PIXELS * CODES)
  ) u_items (
      .clk_i,
      .rst_ni,
      .valid_i   (made_valid),
      .ready_o   (made_ready),
      .data_i    (made_bits),
      .valid_o   (item_valid),
      .ready_i   (takes_item),
      .data_o    (item_bits),
      .is_empty_o(items_are_done)
  );

  logic                               order_valid, takes_order, order_reads;
  logic [WRITES-1:0]                  order_writes;
  logic [raster_pkg::TILE_X_BITS-1:0] order_x;
  logic [raster_pkg::TILE_Y_BITS-1:0] order_y;
  logic [INDEX-1:0]                   order_stamp;
  localparam int ORDER_BITS = ORDER + (BLENDS ? 1 : 0);
  logic [ORDER_BITS-1:0] ordered_bits, order_bits;
  assign ordered_bits[ORDER-1:0] = {ordered_writes, ordered_reads, ordered_x, ordered_y, ordered_stamp};
  assign {order_writes, order_reads, order_x, order_y, order_stamp} = order_bits[ORDER-1:0];
  generate
    if (BLENDS) begin : gen_color_bits
      assign made_bits[ITEM+:2]  = made_color_source;
      assign ordered_bits[ORDER] = ordered_reads_color;
    end
  endgenerate
  fifo #(
      .WIDTH(ORDER_BITS),
      .DEPTH(QUEUE)
  ) u_orders (
      .clk_i,
      .rst_ni,
      .valid_i(ordered_valid),
      .ready_o(ordered_ready),
      .data_i (ordered_bits),
      .valid_o(order_valid),
      .ready_i(takes_order),
      .data_o (order_bits)
  );

  // Answers: a place for each item that can wait for one, here for depth, and for colour (gen_blends) here and behind X.
  logic                      answer_valid, takes_answer, answers_depth, answers_ready;
  logic                      merges;  // answers are of a block that is merged
  logic [SAMPLES*CODE-1:0]   answer_q, response_depth;  // the answer that X took last
  /* verilator lint_off UNUSEDSIGNAL */  // without blending
  logic                      read_goes, reads_color, takes_color;  // a read goes out; it is one of colours
  /* verilator lint_on UNUSEDSIGNAL */
  logic                      of_pixels;  // the colours at work lie in memory with one a pixel
  logic                      order_reads_color, color_valid;
  logic [SAMPLES*COLOR-1:0]  stored_color;  // the answer that W took last
  logic [raster_pkg::DEPTH_SOURCE_BITS-1:0] color_source;  // of the item at the head
  sram_fifo #(
      .WIDTH(SAMPLES * CODE),
      .DEPTH(QUEUE),
      .BLOCK(!APART)  // whose constants want the block RAMs that an ECP5-25F has left
  ) u_answers (
      .clk_i,
      .rst_ni,
      .valid_i(answers_depth),
      .ready_o(answers_ready),
      .data_i (response_depth),
      .valid_o(answer_valid),
      .ready_i(takes_answer),
      .data_o (answer_q)
  );
  generate
    if (BLENDS) begin : gen_blends
      localparam int READS = 1 << $clog2(2 * QUEUE + PLACES);  // that may not have been answered
      logic                     is_color, color_ready, answers_pixels;  // the next answer
      logic [SAMPLES*COLOR-1:0] response_color;
      /* verilator lint_off UNUSEDSIGNAL */  // there is room, and one answer for each
      logic                     planes_ready, planes_valid;
      /* verilator lint_on UNUSEDSIGNAL */
      // Which plane the next answer is of: as the reads went out.
      localparam int PLANE = COMPRESSES ? 2 : 1;
      logic [PLANE-1:0] asked_plane, answered_plane;
      assign is_color = answered_plane[0];
      if (COMPRESSES) begin : gen_pixels
        assign asked_plane    = {of_pixels, reads_color};
        assign answers_pixels = answered_plane[1];
      end else begin : gen_samples
        assign asked_plane    = reads_color;
        assign answers_pixels = 1'b0;
      end
      fifo #(
          .WIDTH(PLANE),
          .DEPTH(READS)
      ) u_planes (
          .clk_i,
          .rst_ni,
          .valid_i(read_goes),
          .ready_o(planes_ready),
          .data_i (asked_plane),
          .valid_o(planes_valid),
          .ready_i(response_valid_i && response_ready_o && !merges),
          .data_o (answered_plane)
      );
      sram_fifo #(
          .WIDTH(SAMPLES * COLOR),
          .DEPTH(1 << $clog2(QUEUE + PLACES))
      ) u_color_answers (
          .clk_i,
          .rst_ni,
          .valid_i(response_valid_i && is_color && !merges),
          .ready_o(color_ready),
          .data_i (response_color),
          .valid_o(color_valid),
          .ready_i(takes_color),
          .data_o (stored_color)
      );
      genvar n;
      for (n = 0; n < SAMPLES; n++) begin : gen_response
        assign response_color[n*COLOR+:COLOR] =
            response_i.data[LANE*(n/raster_pkg::MSAA_SAMPLES)+:COLOR] & {COLOR{answers_pixels}} |
            response_i.data[n*LANE+:COLOR] & {COLOR{!answers_pixels}};
      end
      assign answers_depth     = response_valid_i && !is_color && !merges;
      assign response_ready_o  = merges || (is_color ? color_ready : answers_ready);
      assign color_source      = item_bits[ITEM+:2];
      assign order_reads_color = order_bits[ORDER];
    end else begin : gen_replaces
      assign answers_depth     = response_valid_i && !merges;
      assign response_ready_o  = merges || answers_ready;
      assign color_valid       = 1'b0;
      assign stored_color      = '0;
      assign color_source      = raster_pkg::DEPTH_SOURCE_NONE;
      assign order_reads_color = 1'b0;
    end
  endgenerate

  // --------------------------------------------------------------------------------------------------- X: the depth test
  logic              on_chip, in_memory, reads_victim, slot_free, goes, is_again, leaves_line;
  logic [STAMPS-1:0] left_q, left, next, item_bit;  // stamps of the last eviction that are still to be read
  logic [LINE-1:0]   left_line_q;
  logic [VICTIM:0]   taken_q;   // slots of victims that X has given away
  logic [BEHIND-1:0] behind_q;  // items between X and W: as many as the buffer holds
  logic              colors_done;  // W takes an item
  logic              finishes;     // an eviction is in memory
  logic              waits_for_late;  // for what W writes of depth (gen_late)
  logic              writes_word;  // the item may change a depth, or the stencil above it
  logic              tests_alpha, x1_late;  // by the register of the alpha test; the item depth_test has is late

  logic               x1_valid_q, x1_starts_color_q, x1_evicts_q;
  logic [LINE-1:0]    x1_line_q;
  logic [STAMP-1:0]   x1_stamp_q;
  logic [raster_pkg::DEPTH_SOURCE_BITS-1:0] x1_source_q;
  logic               x1_fills_q;
  logic [STAMPS-1:0]  x1_color_q;
  logic               x1_writes_q;  // the RAM, perhaps

  assign slot_free    = taken_q != (VICTIM + 1)'(VICTIMS);
  assign item_bit     = STAMPS'(1) << item_stamp;
  assign on_chip      = source == raster_pkg::DEPTH_SOURCE_CHIP;
  assign in_memory    = source == raster_pkg::DEPTH_SOURCE_MEMORY;
  assign is_again     = x1_valid_q && on_chip && x1_line_q == item_line && x1_stamp_q == item_stamp;  // the stamp at depth_test
  assign leaves_line  = x1_valid_q && x1_line_q == item_line && x1_writes_q;
  assign goes         = item_valid && !waits_for_late && (!evicts || (left_q == '0 && slot_free && !leaves_line)) &&
                        (!on_chip || left_q == '0) && (!in_memory || answer_valid) &&
                        (behind_q != BEHIND'(PLACES) || (colors_done && raster_pkg::COORDINATES == 0));
  assign left         = goes && evicts ? evicts_depth : left_q;
  assign next         = goes && (evicts || left_line_q == item_line) && (left & item_bit) != '0 ? item_bit : lowest(left);
  assign reads_victim = left != '0;
  assign takes_item      = goes;
  assign takes_answer    = goes && in_memory;
  assign tested_valid_o  = goes;
  assign tested_o        = item;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      left_q     <= '0;
      x1_valid_q <= 1'b0;
      taken_q    <= '0;
      behind_q   <= '0;
    end else begin
      left_q     <= left & ~next;
      x1_valid_q <= goes;
      taken_q    <= taken_q + (VICTIM + 1)'(goes && evicts) - (VICTIM + 1)'(finishes);
      behind_q   <= behind_q + BEHIND'(goes) - BEHIND'(colors_done);
    end
  end

  always_ff @(posedge clk_i) begin
    if (goes && evicts) left_line_q <= item_line;
    x1_line_q         <= item_line;
    x1_stamp_q        <= item_stamp;
    x1_source_q       <= source;
    x1_starts_color_q <= starts_color;
    x1_evicts_q       <= evicts;
    x1_fills_q        <= fills[1];
    x1_color_q        <= evicts_color;
    x1_writes_q       <= item.mask != '0 && !(tests_alpha && writes_word) &&
                         (writes_word || (!on_chip && source != raster_pkg::DEPTH_SOURCE_NONE));
  end
  generate
    if (HAS_STENCIL) begin : gen_writes_word
      assign writes_word = item.state.depth_write || item.state.writes_stencil;
    end else begin : gen_writes_depth
      assign writes_word = item.state.depth_write;
    end
  endgenerate

  // The depth RAM: of each sample its code, and whether memory does not have it. What a stamp is tested against comes from there,
  // from the answer, or stands in a register as it goes: the clear value, or what is written while the RAM is read.
  logic                    v_valid_q, v_last_q, v_fills_q, fills_q;  // a stamp of a victim has been read
  logic [STAMP-1:0]        v_stamp_q;
  logic [VICTIM-1:0]       v_slot_q, slot_q;  // of the next eviction
  logic [SAMPLES*CODE-1:0] v_depth;
  logic [SAMPLES-1:0]      v_depth_strobe;
  logic [ADDRESS-1:0]      depth_read_address;
  assign depth_read_address = {left_q != '0 ? left_line_q : item_line, reads_victim ? number_of(next) : item_stamp};

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      v_valid_q <= 1'b0;
      slot_q    <= '0;
    end else begin
      v_valid_q <= reads_victim;
      slot_q    <= slot_q + VICTIM'(goes && evicts);
    end
  end
  always_ff @(posedge clk_i) begin
    if (goes && evicts) fills_q <= fills[0];
    v_fills_q <= goes && evicts ? fills[0] : fills_q;
    v_stamp_q <= number_of(next);
    v_slot_q  <= goes && evicts ? slot_q : slot_q - 1'b1;
    v_last_q  <= left == next;
  end

  logic x1_on_chip;
  logic late_valid;  // W writes depths (gen_late)
  logic [SAMPLES-1:0]          late_writes;
  logic [SAMPLES*(CODE+1)-1:0] late_word;
  assign x1_on_chip = x1_source_q == raster_pkg::DEPTH_SOURCE_CHIP;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_depth
      logic [CODE-1:0] code, stored, held_q;
      logic            dirty, writes, strobe, is_forwarded, in_ram_q;
      logic [CODE:0]   word;
      assign response_depth[s*CODE+:CODE] = response_i.data[s*LANE+:CODE];
      assign stored       = in_ram_q ? code : x1_source_q == raster_pkg::DEPTH_SOURCE_MEMORY ? answer_q[s*CODE+:CODE] : held_q;
      assign is_forwarded = is_again && writes;  // not of a late one: behind that nothing in its place goes
      always_ff @(posedge clk_i) begin
        in_ram_q <= on_chip && !is_forwarded;
        held_q   <= is_forwarded ? word_i[s*CODE+:CODE] : clear_depth;
      end
      assign writes = write_i.write_depth[s] || (!x1_on_chip && x1_source_q != raster_pkg::DEPTH_SOURCE_NONE);
      assign word = late_valid ? late_word[s*(CODE+1)+:CODE+1] : {write_i.write_depth[s], word_i[s*CODE+:CODE]};
      assign stored_depth_o[s*CODE+:CODE] = stored;
      sram #(
          .WIDTH    (CODE + 1),
          .DEPTH    (1 << ADDRESS),
          .READS_OLD(0)
      ) u_depth (
          .clk_i,
          .read_i         (reads_victim || goes),
          .read_address_i (depth_read_address),
          .data_o         ({dirty, code}),
          .write_i        (late_valid ? late_writes[s] : write_valid_i && writes && !x1_late),
          .write_address_i(late_valid ? {w_line, w_stamp} : {x1_line_q, x1_stamp_q}),
          .data_i         (word)
      );
      assign strobe = v_fills_q || dirty;
      assign v_depth_strobe[s] = strobe;
      assign v_depth[s*CODE+:CODE] = code;
      assign lent_depth[s*CODE+:CODE] = sent_depth[s*CODE+:CODE] & {CODE{sent_depth_strobe[s]}};
    end
  endgenerate

  // ----------------------------------------------------------------------------------------------------------- W: colours
  localparam int CARRIED = LINE + STAMP + 1 + SAMPLES + 1 + 1 + STAMPS;
  localparam int STATES = 1 + 3 + 32;  // a token: that it is one, which register, its value
  // What W needs to write depths and to count.
  localparam int LATES = 4 + SAMPLES + (HAS_STENCIL ? SAMPLES : 0) + 2 * SAMPLES * CODE;
  localparam int LATE_AT = CARRIED + (HAS_STATE ? STATES : 0);
  localparam int ALL_CARRIED = LATE_AT + (LATE ? LATES : 0) + (BLENDS ? 2 : 0);
  logic                      w_valid, w_starts_color, w_evicts, w_fills, w_sets_state;
  logic [LINE-1:0]           w_line;
  logic [STAMP-1:0]          w_stamp;
  logic [SAMPLES-1:0]        w_mask, w_kept;  // samples whose colour is written by the depth test, and by the alpha test
  /* verilator lint_off UNUSEDSIGNAL */  // without a texture unit
  logic [PIXELS*8-1:0]       w_alpha;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [SAMPLES*SHADED-1:0] w_color;
  logic [STAMPS-1:0]         w_stamps;
  logic [ALL_CARRIED-1:0]    x1_carried, w_carried;
  logic [raster_pkg::DEPTH_FUNC_BITS-1:0]   w_register;
  logic [raster_pkg::DEPTH_SOURCE_BITS-1:0] w_source;
  logic [31:0]               w_word;
  /* verilator lint_off UNUSEDSIGNAL */  // what a texture unit looks at, or operations on colours, if there are any
  raster_pkg::fragment_packet_t x1_item_q;
  logic [raster_pkg::DEPTH_SOURCE_BITS-1:0] x1_color_source_q;
  /* verilator lint_on UNUSEDSIGNAL */
  always_ff @(posedge clk_i) begin
    x1_item_q         <= item;
    x1_color_source_q <= color_source;
  end
  logic [SAMPLES-1:0]        looked_at;  // by the alpha test: what it may keep from being written
  generate
    if (HAS_STENCIL) begin : gen_marked
      assign looked_at = write_i.passed | write_i.write_depth;
    end else begin : gen_passed
      assign looked_at = write_i.passed;
    end
  endgenerate
  logic                      texture_is_idle;
  assign x1_carried[CARRIED-1:0] = {x1_line_q, x1_stamp_q, x1_starts_color_q, write_i.write_color & {SAMPLES{write_valid_i}},
                                    x1_evicts_q, x1_fills_q, x1_color_q};
  assign {w_line, w_stamp, w_starts_color, w_mask, w_evicts, w_fills, w_stamps} = w_carried[CARRIED-1:0];
  generate
    if (HAS_STATE) begin : gen_state
      assign x1_carried[CARRIED+:STATES] = {x1_valid_q && x1_item_q.kind == raster_pkg::PRIMITIVE_KIND_STATE,
                                            x1_item_q.state.depth_test, x1_item_q.code[31:0]};
      assign w_sets_state = w_carried[CARRIED+STATES-1];
      assign w_register   = w_carried[CARRIED+32+:3];
      assign w_word       = w_carried[CARRIED+:32];
    end else begin : gen_no_state
      assign w_sets_state = 1'b0;
      assign w_register   = raster_pkg::STATE_REGISTER_COLOR_OPS;
      assign w_word       = '0;
    end
    if (BLENDS) begin : gen_color_source
      assign x1_carried[ALL_CARRIED-1-:2] = x1_color_source_q;
      assign w_source = w_carried[ALL_CARRIED-1-:2];
    end else begin : gen_no_color_source
      assign w_source = raster_pkg::DEPTH_SOURCE_NONE;
    end
  endgenerate
  /* verilator lint_off UNUSEDSIGNAL */  // as above
  raster_pkg::fragment_packet_t x1_item;
  /* verilator lint_on UNUSEDSIGNAL */
  whole_fragment #(
      .APART(APART)
  ) u_whole (
      .fragment_i(x1_item_q),
      .context_i,
      .fragment_o(x1_item)
  );
  colored_stamps #(
      .CARRIED(ALL_CARRIED),
      .PLACES (PLACES)
  ) u_colored (
      .clk_i,
      .power_on_ni,
      .rst_ni,
      .stamp_valid_i  (x1_valid_q),
      .carried_i      (x1_carried),
      .writes_i       ({SAMPLES{write_valid_i}} & (tests_alpha ? looked_at : write_i.write_color)),
      .color_i        (write_i.color),
      .fragment_i     (x1_item),
      .stamp_valid_o  (w_valid),
      .stamp_ready_i  (colors_done),
      .carried_o      (w_carried),
      .color_o        (w_color),
      .alpha_o        (w_alpha),
      .texture_valid_o,
      .texture_ready_i,
      .texture_o,
      .texel_valid_i,
      .texel_ready_o,
      .texel_i,
      .packet_valid_o (color_valid_o),
      .packet_o       (color_o),
      .texture_use_o,
      .texture_is_idle_o(texture_is_idle)
  );
  assign color_ready_o = colors_done;

  // Late: the alpha test comes behind the texture, so what it may still drop writes its depths here. At X an item waits for
  // what is late in its place, an eviction for what is late in its line, told apart by the lowest bits of the line; and one that
  // is not late for all that is.
  generate
    if (LATE) begin : gen_late
      localparam int NEAR = LINE < 4 ? LINE : 4;  // bits of a line that X looks at
      localparam int PLACE = NEAR + STAMP;
      localparam int PLACED = 1 << PLACE;
      logic [PLACED-1:0]    pending_q, sets, clears;
      logic [STAMPS-1:0]    pending_here;  // of the item's line
      logic [BEHIND-1:0]    late_behind_q;
      logic                 tests_alpha_q, is_late, enters, leaves;
      logic [raster_pkg::DEPTH_FUNC_BITS-1:0] func_q;
      logic [7:0]           reference_q;
      logic                 covers_q;  // alpha says how many samples of a pixel are drawn
      logic                 w_late, w_on_chip, w_counted, w_writes;
      logic [SAMPLES-1:0]   w_passed, w_changes, alpha_passes;  // passed the tests; the depth or the stencil changes
      logic                 x1_writes_word;
      logic [SAMPLES*CODE-1:0] w_depth, w_stored;

      // X
      assign is_late      = tests_alpha_q && writes_word && item.mask != '0;
      assign pending_here = pending_q[{item_line[NEAR-1:0], {STAMP{1'b0}}}+:STAMPS];
      assign waits_for_late = (item.mask != '0 && (is_late ? (pending_here & item_bit) != '0 : late_behind_q != '0)) ||
                              (evicts && pending_here != '0);
      assign enters = goes && is_late;
      assign leaves = colors_done && w_late;
      assign sets   = enters ? PLACED'(1) << {item_line[NEAR-1:0], item_stamp} : '0;
      assign clears = leaves ? PLACED'(1) << {w_line[NEAR-1:0], w_stamp} : '0;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          pending_q     <= '0;
          late_behind_q <= '0;
          tests_alpha_q <= 1'b0;
        end else begin
          pending_q     <= (pending_q & ~clears) | sets;
          late_behind_q <= late_behind_q + BEHIND'(enters) - BEHIND'(leaves);
          if (goes && item.kind == raster_pkg::PRIMITIVE_KIND_STATE &&
              item.state.depth_test == raster_pkg::STATE_REGISTER_ALPHA_TEST)
            tests_alpha_q <= item.code[2:0] != raster_pkg::DEPTH_FUNC_ALWAYS || (raster_pkg::MSAA_SAMPLES > 1 && item.code[11]);
        end
      end
      assign tests_alpha = tests_alpha_q;
      assign x1_late     = tests_alpha_q && x1_writes_word;
      if (HAS_STENCIL) begin : gen_changes
        assign x1_carried[LATE_AT+LATES-1-:SAMPLES] = write_i.write_depth;
        assign w_changes      = w_carried[LATE_AT+LATES-1-:SAMPLES];
        assign x1_writes_word = x1_item_q.state.depth_write || x1_item_q.state.writes_stencil;
      end else begin : gen_depths
        assign w_changes      = w_passed;
        assign x1_writes_word = x1_item_q.state.depth_write;
      end
      localparam int KNOWN = 4 + SAMPLES + 2 * SAMPLES * CODE;
      assign x1_carried[LATE_AT+:KNOWN] = {
        write_valid_i && x1_late, x1_on_chip,
        write_valid_i && (x1_item_q.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE || x1_item_q.kind[2]),
        x1_item_q.state.depth_write || x1_item_q.state.color_write, write_i.passed, word_i, stored_depth_o
      };

      // W
      assign {w_late, w_on_chip, w_counted, w_writes, w_passed, w_depth, w_stored} = w_carried[LATE_AT+:KNOWN];
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          func_q      <= raster_pkg::DEPTH_FUNC_ALWAYS;
          reference_q <= '0;
          covers_q    <= 1'b0;
        end else if (colors_done && w_sets_state && w_register == raster_pkg::STATE_REGISTER_ALPHA_TEST) begin
          func_q      <= w_word[2:0];
          reference_q <= w_word[10:3];
          covers_q    <= raster_pkg::MSAA_SAMPLES > 1 && w_word[11];
        end
      end
      alpha_test u_alpha (
          .func_i     (func_q),
          .reference_i(reference_q),
          .covers_i   (covers_q),
          .alpha_i    (w_alpha),
          .passes_o   (alpha_passes)
      );
      assign w_kept     = alpha_passes;
      assign late_valid = leaves;
      for (s = 0; s < SAMPLES; s++) begin : gen_sample
        logic is_kept;
        assign is_kept        = w_changes[s] && alpha_passes[s];
        assign late_writes[s] = is_kept || !w_on_chip;
        assign late_word[s*(CODE+1)+:CODE+1] = {is_kept, is_kept ? w_depth[s*CODE+:CODE] : w_stored[s*CODE+:CODE]};
      end
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          written_o <= '0;
          killed_o  <= '0;
        end else begin
          written_o <= colors_done && w_counted && w_writes ? popcount(w_passed & alpha_passes) : '0;
          killed_o  <= colors_done && w_counted ? popcount(w_passed & ~alpha_passes) : '0;
        end
      end
    end else begin : gen_early
      assign waits_for_late = 1'b0;
      assign tests_alpha    = 1'b0;
      assign x1_late        = 1'b0;
      assign w_kept         = '1;
      assign late_valid     = 1'b0;
      assign late_writes    = '0;
      assign late_word      = '0;
      assign written_o      = '0;
      assign killed_o       = '0;
    end
  endgenerate

  logic                     c_valid, c_ready, write_is_idle;  // colours of a victim have been read; all of one are there
  logic [STAMP-1:0]         c_stamp;
  logic [VICTIM-1:0]        c_slot;
  logic [SAMPLES*COLOR-1:0] c_color;
  logic [SAMPLES-1:0]       c_color_strobe;
  color_write u_write (
      .clk_i,
      .rst_ni,
      .stamp_valid_i  (w_valid),
      .stamp_ready_o  (colors_done),
      .line_i         (w_line),
      .stamp_i        (w_stamp),
      .starts_i       (w_starts_color),
      .mask_i         (w_mask & w_kept),
      .color_i        (w_color),
      .evicts_i       (w_evicts),
      .fills_i        (w_fills),
      .stamps_i       (w_stamps),
      .clear_color_i  (clear_color),
      .sets_state_i   (w_sets_state),
      .register_i     (w_register),
      .word_i         (w_word),
      .source_i       (w_source),
      .answer_valid_i (color_valid),
      .answer_i       (stored_color),
      .answer_ready_o (takes_color),
      .victim_valid_o (c_valid),
      .victim_slot_o  (c_slot),
      .victim_stamp_o (c_stamp),
      .victim_strobe_o(c_color_strobe),
      .victim_color_o (c_color),
      .victim_ready_o (c_ready),
      .idle_o         (write_is_idle)
  );

  // ------------------------------------------------------------------------------------ victims, and what goes to memory
  localparam int SLOTTED = VICTIM + STAMP;  // address of a stamp in the slots
  logic [SAMPLES*(CODE+1)-1:0]  victim_depth_q[0:(1<<SLOTTED)-1];
  logic [SAMPLES*(COLOR+1)-1:0] victim_color_q[0:(1<<SLOTTED)-1];
  logic [BLOCK_X+BLOCK_Y+2*STAMPS-1:0] victim_q[0:VICTIMS-1];  // where it belongs, and which of its stamps are in the slots
  logic [STAMPS-1:0] depth_left_q[0:VICTIMS-1];  // stamps still to be written
  logic [STAMPS-1:0] color_left_q[0:VICTIMS-1];
  logic [VICTIM-1:0] oldest_q;  // slot of the next to be written
  logic [VICTIM:0]   depth_ready_q, color_ready_q;  // evictions whose depths, and colours, are all here
  logic              is_ready;
  logic [WRITES-1:0] written_q;  // of the order at the head
  logic              depth_asked_q;  // likewise: its read of depths has been taken, that of colours has not

  logic                        sends, skips, wants_write, wants_read, is_color, ends_victim, is_here, takes_request;
  logic                        colors_known, asks_pixels;  // how colours are written or read; a read of a merge
  logic [STAMP-1:0]            asked_stamp;
  /* verilator lint_off UNUSEDSIGNAL */  // without pixel_colors
  logic [PIXEL_COLORS-1:0]     merged;
  /* verilator lint_on UNUSEDSIGNAL */
  logic                        takes_merged;  // all stamps of the block are written, with what was read
  logic [STAMPS-1:0]           depth_left, color_left, sent, here_depth, here_color;
  logic [STAMP-1:0]            sent_stamp;
  logic [BLOCK_X-1:0]          sent_x;
  logic [BLOCK_Y-1:0]          sent_y;
  logic [SAMPLES*CODE-1:0]     sent_depth, lent_depth;  // as it is in its slot; and 0 where it is not written
  logic [SAMPLES*COLOR-1:0]    sent_color;
  logic [SAMPLES-1:0]          sent_depth_strobe, sent_color_strobe;

  assign {sent_x, sent_y, here_depth, here_color} = victim_q[oldest_q];
  assign depth_left  = depth_left_q[oldest_q];
  assign color_left  = color_left_q[oldest_q];
  assign wants_write = order_valid && written_q != order_writes;
  assign wants_read  = order_valid && written_q == order_writes;  // an order that reads nothing ends with its writes
  assign is_ready    = depth_ready_q != '0 && color_ready_q != '0;
  assign sends       = wants_write && is_ready && (depth_left != '0 || (color_left != '0 && colors_known));
  assign skips       = wants_write && is_ready && depth_left == '0 && color_left == '0;
  assign is_color    = depth_left == '0;
  assign sent        = lowest(is_color ? color_left : depth_left);
  assign sent_stamp  = asks_pixels ? asked_stamp : number_of(sent);
  assign ends_victim = is_color ? color_left == sent : depth_left == sent && color_left == '0;
  assign is_here     = (sent & (is_color ? here_color : here_depth)) != '0;
  assign finishes    = skips || (sends && takes_request && ends_victim);
  assign reads_color = order_reads_color && (!order_reads || depth_asked_q);  // behind that of depth
  assign read_goes  = wants_read && takes_request;
  /* verilator lint_off UNUSEDSIGNAL */  // without pixel_colors
  logic reads_block, merge_answers;  // colours are read; an answer belongs to a merge
  /* verilator lint_on UNUSEDSIGNAL */
  assign reads_block   = wants_read && reads_color;
  assign merge_answers = response_valid_i && response_ready_o && merges;
  generate
    if (COMPRESSES) begin : gen_pixel_colors
      pixel_colors u_pixel_colors (
          .clk_i,
          .rst_ni,
          .begins_i      (goes && evicts),
          .begin_slot_i  (slot_q),
          .begin_fills_i (fills[1]),
          .comes_i       (c_valid),
          .come_slot_i   (c_slot),
          .come_strobe_i (c_color_strobe),
          .come_color_i  (c_color),
          .writes_i      (wants_write && is_ready && is_color && color_left != '0),
          .slot_i        (oldest_q),
          .is_every_i    (color_left == '1),
          .write_x_i     (sent_x),
          .write_y_i     (sent_y),
          .reads_i       (reads_block),
          .read_tile_x_i (order_x),
          .read_tile_y_i (order_y),
          .read_stamp_i  (order_stamp),
          .ends_i        (finishes || (reads_block && takes_request)),
          .is_known_o    (colors_known),
          .of_pixels_o   (of_pixels),
          .asks_o        (asks_pixels),
          .ask_stamp_o   (asked_stamp),
          .is_asked_i    (asks_pixels && takes_request),
          .other_asked_i (read_goes),
          .other_answered_i(response_valid_i && response_ready_o && !merges),
          .answers_i     (merge_answers),
          .answer_i      (response_i.data),
          .merges_o      (takes_merged),
          .takes_answers_o(merges),
          .stamp_i       (sent_stamp),
          .merged_o      (merged),
          .token_reads_i (pixel_reads),
          .token_writes_i(pixel_writes),
          .word_x_i      (pixel_word_x),
          .word_y_i      (pixel_word_y),
          .word_i        (pixel_word_new),
          .word_o        (pixel_word)
      );
    end else begin : gen_no_pixel_colors
      assign colors_known = 1'b1;
      assign of_pixels    = 1'b0;
      assign merges       = 1'b0;
      assign takes_merged = 1'b0;
      assign asks_pixels  = 1'b0;
      assign asked_stamp  = '0;
      assign merged       = '0;
      assign pixel_word   = '0;
    end
  endgenerate
  assign takes_order = (finishes && written_q + 1'b1 == order_writes && !order_reads && !order_reads_color) ||
                       (read_goes && (reads_color || !order_reads_color));
  generate
    if (BLENDS) begin : gen_asked
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) depth_asked_q <= 1'b0;
        else if (read_goes) depth_asked_q <= !takes_order;
      end
    end else begin : gen_not_asked
      assign depth_asked_q = 1'b0;
    end
  endgenerate

  assign request_valid_o = flush_valid || sends || asks_pixels || (wants_read && (!reads_color || colors_known));
  assign takes_request   = request_valid_o && request_ready_i;

  assign {sent_depth_strobe, sent_depth} = victim_depth_q[{oldest_q, sent_stamp}];
  assign {sent_color_strobe, sent_color} = victim_color_q[{oldest_q, sent_stamp}];

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      oldest_q      <= '0;
      depth_ready_q <= '0;
      color_ready_q <= '0;
      written_q     <= '0;
    end else begin
      oldest_q      <= oldest_q + VICTIM'(finishes);
      depth_ready_q <= depth_ready_q + (VICTIM + 1)'(goes && evicts && evicts_depth == '0) +
                       (VICTIM + 1)'(v_valid_q && v_last_q) - (VICTIM + 1)'(finishes);
      color_ready_q <= color_ready_q + (VICTIM + 1)'(c_ready) - (VICTIM + 1)'(finishes);
      written_q     <= takes_order ? '0 : written_q + WRITES'(finishes);
    end
  end

  always_ff @(posedge clk_i) begin
    if (v_valid_q) victim_depth_q[{v_slot_q, v_stamp_q}] <= {v_depth_strobe, v_depth};
    if (c_valid) victim_color_q[{c_slot, c_stamp}] <= {c_color_strobe, c_color};
    if (goes && evicts) victim_q[slot_q] <= {evicts_x, evicts_y, evicts_depth, evicts_color};
  end

  genvar v;
  generate
    for (v = 0; v < VICTIMS; v++) begin : gen_left
      logic begins, is_sent;
      assign begins  = goes && evicts && slot_q == VICTIM'(v);
      assign is_sent = sends && takes_request && oldest_q == VICTIM'(v);
      always_ff @(posedge clk_i) begin
        if (begins) begin
          depth_left_q[v] <= {STAMPS{fills[0]}};
          color_left_q[v] <= {STAMPS{fills[1]}};
        end else begin
          if (v_valid_q && v_slot_q == VICTIM'(v) && v_depth_strobe != '0)
            depth_left_q[v] <= depth_left_q[v] | (STAMPS'(1) << v_stamp_q);
          if (c_valid && c_slot == VICTIM'(v) && c_color_strobe != '0)
            color_left_q[v] <= color_left_q[v] | (STAMPS'(1) << c_stamp);
          if (is_sent && !is_color) depth_left_q[v] <= depth_left_q[v] & ~sent;
          if (is_sent && is_color) color_left_q[v] <= color_left_q[v] & ~sent;
          if (takes_merged && !colors_known && oldest_q == VICTIM'(v)) color_left_q[v] <= '1;
        end
      end
    end
  endgenerate

  // The request: a victim's stamp, a read, or what a flush writes.
  logic [raster_pkg::TILE_X_BITS-1:0] sent_tile_x;
  logic [raster_pkg::TILE_Y_BITS-1:0] sent_tile_y;
  logic [INDEX-1:0]                   sent_index;
  stamp_address u_sent_address (
      .block_x_i(sent_x),
      .block_y_i(sent_y),
      .stamp_i  (sent_stamp),
      .tile_x_o (sent_tile_x),
      .tile_y_o (sent_tile_y),
      .stamp_o  (sent_index)
  );
  // Its data.
  logic [raster_pkg::MEMORY_COLORS-1:0] color_strobe;
  victim_bytes u_bytes (
      .sends_depth_i  (sends && !is_color),
      .sends_color_i  (sends && is_color),
      .is_here_i      (is_here),
      .depth_i        (lent_depth),
      .color_i        (sent_color),
      .color_strobe_i (sent_color_strobe),
      .of_pixels_i    (of_pixels),
      .merges_i       (takes_merged),
      .merged_i       (merged),
      .sends_flags_i  (flush_valid && flush_request.plane[1]),
      .flags_i        (flush_word),
      .sends_cleared_i(flush_valid && !flush_request.plane[1]),
      .clear_depth_i  (clear_depth),
      .clear_color_i  (clear_color),
      .bytes_o        (request_bytes_o),
      .color_strobe_o (color_strobe)
  );

  raster_pkg::tile_plane_t color_plane;
  assign color_plane = of_pixels || asks_pixels ? raster_pkg::TILE_PLANE_PIXEL_COLOR : raster_pkg::TILE_PLANE_COLOR;
  always_comb begin
    request_o          = '0;
    request_o.is_write = sends;
    request_o.plane    = reads_color && !sends ? color_plane : raster_pkg::TILE_PLANE_DEPTH;
    request_o.tile_x   = order_x;
    request_o.tile_y   = order_y;
    request_o.stamp    = order_stamp;
    request_o.run      = RUN'(1);
    if (sends) begin
      request_o.run    = run_of(is_color ? color_left : depth_left);
      request_o.tile_x = sent_tile_x;
      request_o.tile_y = sent_tile_y;
      request_o.stamp  = sent_index;
      if (is_color) request_o.plane = color_plane;
      request_o.strobe = is_color ? SAMPLES'(color_strobe) : is_here ? sent_depth_strobe : '1;
    end
    if (asks_pixels) begin
      request_o.tile_x = sent_tile_x;
      request_o.tile_y = sent_tile_y;
      request_o.stamp  = sent_index;
      request_o.plane  = color_plane;
    end
    if (flush_valid) request_o = flush_request;
    request_o.data = '0;
  end

  assign drained = items_are_done && behind_q == '0 && !order_valid;
  assign idle_o  = tags_are_idle && drained && texture_is_idle && write_is_idle;
  assign fill_o  = {1'b0, read_goes || (asks_pixels && takes_request)};
  assign evict_o = {1'b0, (sends && takes_request) || is_resolved};
  assign clear_o = {1'b0, is_cleared};

endmodule
