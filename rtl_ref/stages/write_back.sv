// Write-back: the memory traffic of the framebuffer of blocks, in the order given by cache_tags: evicted blocks, then
// the read that ends an order; and the writes of a flush.
//
// An evicted block gets one of VICTIMS slots. Its depths come from depth_cache, its colours from color_write, a stamp a
// cycle; when all of both are in the slot the block is written, a stamp a request, depths first. With compress.unit
// pixel_colors says of each block whether its colours are written, or read, one per pixel. Specification:
// model/stages/block_cache.hpp, pixel_colors.hpp; the times are those of model/engines/cycle/block_timing.hpp.
module write_back #(
    parameter int SAMPLES = raster_pkg::SAMPLES,  // derived; not to be set
    parameter int CODE = raster_pkg::STORED_DEPTH_BITS,
    parameter int COLOR = raster_pkg::STORED_COLOR_BITS,
    parameter int STAMP = raster_pkg::BLOCK_STAMP_BITS,
    parameter int SLOT = raster_pkg::VICTIM_SLOT_BITS,
    parameter int WORD = raster_pkg::FLAG_WORD
) (
    input logic clk_i,
    input logic rst_ni,

    // From cache_tags: orders; after all of them the writes of a flush, whose data are the word, or the clear value
    input  logic                        ordered_valid_i,
    output logic                        ordered_ready_o,
    input  raster_pkg::block_order_t    ordered_i,
    input  logic                        flush_valid_i,
    input  raster_pkg::memory_request_t flush_i,
    input  logic [WORD-1:0]             flush_word_i,
    input  logic [CODE-1:0]             clear_depth_i,
    input  logic [COLOR-1:0]            clear_color_i,

    // From depth_cache: a block is evicted; stamps of its depths
    input  logic                    evicts_i,
    input  raster_pkg::eviction_t     eviction_i,
    input  logic                      depth_valid_i,
    input  raster_pkg::depth_victim_t depth_i,
    output logic                    slot_free_o,     // the oldest block is in memory

    // From color_write: stamps of its colours; all of the next block's are complete
    input logic                     color_valid_i,
    input raster_pkg::color_victim_t color_i,
    input logic                     color_ready_i,

    // To and from memory_port
    output logic                         request_valid_o,
    input  logic                         request_ready_i,
    output raster_pkg::memory_request_t  request_o,        // without its data
    output logic [8*raster_pkg::REQUEST_BYTES-1:0] request_bytes_o,  // its data, as they lie in memory
    input  logic                         response_valid_i,
    input  logic                         response_ready_i,
    input  raster_pkg::memory_response_t response_i,

    // To memory_answers: a read goes out; it reads colours; one per pixel; answers belong to a merge
    output logic read_goes_o,
    output logic read_color_o,
    output logic read_of_pixels_o,
    output logic merges_o,

    // Tokens: a word of the bits of blocks with one colour per pixel is read, and valid in the next cycle; or written
    input  raster_pkg::pixel_word_t token_i,
    output logic [WORD-1:0]         token_word_o,

    output logic fills_o,   // this cycle requests a stamp
    output logic stores_o,  // this cycle writes a stamp
    output logic idle_o     // no order is under way
);

  localparam int STAMPS = raster_pkg::BLOCK_STAMPS;
  localparam int VICTIMS = raster_pkg::CACHE_VICTIMS;
  localparam int WRITES = raster_pkg::VICTIM_COUNT_BITS;
  localparam int RUN = raster_pkg::RUN_BITS;
  localparam bit BLENDS = raster_pkg::BLEND_LANES != 0;
  localparam bit COMPRESSES = raster_pkg::COMPRESS_UNIT != 0;

  // Length of the run of ones from the lowest one on.
  function automatic [RUN-1:0] run_of(input [STAMPS-1:0] set);
    logic [STAMPS-1:0] gaps;  // above the lowest, from the first gap on
    gaps   = ~set & ~(raster_pkg::lowest_stamp(set) - 1'b1);
    run_of = '0;
    for (int i = 0; i < STAMPS; i++)
      if (set[i] && (gaps & ((STAMPS'(2) << i) - 1'b1)) == '0) run_of = run_of + 1'b1;
  endfunction

  logic                     order_valid, takes_order, order_reads_color;
  raster_pkg::block_order_t order;
  fifo #(
      .WIDTH(raster_pkg::BLOCK_ORDER_BITS),
      .DEPTH(raster_pkg::CACHE_QUEUE),
      .AHEAD(raster_pkg::BLOCK_ORDER_BITS)
  ) u_orders (
      .clk_i,
      .rst_ni,
      .valid_i(ordered_valid_i),
      .ready_o(ordered_ready_o),
      .data_i (ordered_i),
      .valid_o(order_valid),
      .ready_i(takes_order),
      .data_o (order)
  );
  assign idle_o = !order_valid;

  // ------------------------------------------------------------------------------------------------- slots, and which is sent
  localparam int PLACE = SLOT + STAMP;  // place of a stamp in the slots
  logic [SAMPLES*(CODE+1)-1:0]  victim_depth_q[0:(1<<PLACE)-1];
  logic [SAMPLES*(COLOR+1)-1:0] victim_color_q[0:(1<<PLACE)-1];
  logic [raster_pkg::VICTIM_BITS-1:0] victim_q[0:VICTIMS-1];
  logic [STAMPS-1:0] depth_left_q[0:VICTIMS-1];  // stamps still to be written
  logic [STAMPS-1:0] color_left_q[0:VICTIMS-1];
  logic [SLOT-1:0]   oldest_q;  // slot of the next block to be written
  logic [STAMPS-1:0] oldest_depth_q, oldest_color_q;  // depth_left_q and color_left_q of it: long paths start from them
  logic [SLOT:0]     depth_ready_q, color_ready_q;  // blocks whose depths, and colours, are complete
  logic              is_ready;
  logic [WRITES-1:0] written_q;  // blocks written of the order at the head
  logic              depth_asked_q;  // the order at the head: its depth read has been taken, its colour read has not

  logic                     sends, skips, wants_write, wants_read, is_color, ends_victim, is_here, takes_request, finishes;
  logic                     reads_color, colors_known, asks_pixels;  // the colours' form is known; a read of a merge
  logic                     of_pixels;  // the current colours lie in memory with one per pixel
  logic [STAMP-1:0]         asked_stamp, sent_stamp;
  logic                     takes_merged;  // all stamps of the block are written, with the merged colours
  logic [STAMPS-1:0]        depth_left, color_left, sent;
  raster_pkg::victim_t      leaving;
  logic [SAMPLES*CODE-1:0]  sent_depth, lent_depth;  // depths of the slot; lent_depth is 0 where they are not written
  logic [SAMPLES*COLOR-1:0] sent_color;
  logic [SAMPLES-1:0]       sent_depth_strobe, sent_color_strobe;

  assign leaving     = victim_q[oldest_q];
  assign depth_left  = oldest_depth_q;
  assign color_left  = oldest_color_q;
  assign wants_write = order_valid && written_q != order.writes;
  assign wants_read  = order_valid && written_q == order.writes;  // an order that reads nothing ends with its writes
  assign is_ready    = depth_ready_q != '0 && color_ready_q != '0;
  assign sends       = wants_write && is_ready && (depth_left != '0 || (color_left != '0 && colors_known));
  assign skips       = wants_write && is_ready && depth_left == '0 && color_left == '0;
  assign is_color    = depth_left == '0;
  assign sent        = raster_pkg::lowest_stamp(is_color ? color_left : depth_left);
  assign sent_stamp  = asks_pixels ? asked_stamp : raster_pkg::stamp_number(sent);
  assign ends_victim = is_color ? color_left == sent : depth_left == sent && color_left == '0;
  assign is_here     = (sent & (is_color ? leaving.color : leaving.depth)) != '0;
  assign finishes    = skips || (sends && takes_request && ends_victim);
  assign reads_color = order_reads_color && (!order.reads || depth_asked_q);  // after the depth read
  assign takes_order = (finishes && written_q + 1'b1 == order.writes && !order.reads && !order_reads_color) ||
                       (read_goes_o && (reads_color || !order_reads_color));
  assign request_valid_o = flush_valid_i || sends || asks_pixels || (wants_read && (!reads_color || colors_known));
  assign takes_request   = request_valid_o && request_ready_i;
  assign slot_free_o      = finishes;
  assign read_goes_o      = wants_read && takes_request;
  assign read_color_o     = reads_color;
  assign read_of_pixels_o = of_pixels;
  assign fills_o          = read_goes_o || (asks_pixels && takes_request);
  assign stores_o         = sends && takes_request;
  generate
    if (BLENDS) begin : gen_reads_color
      assign order_reads_color = order.reads_color;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) depth_asked_q <= 1'b0;
        else if (read_goes_o) depth_asked_q <= !takes_order;
      end
    end else begin : gen_reads_no_color
      assign order_reads_color = 1'b0;
      assign depth_asked_q     = 1'b0;
    end
  endgenerate

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      oldest_q      <= '0;
      depth_ready_q <= '0;
      color_ready_q <= '0;
      written_q     <= '0;
    end else begin
      oldest_q      <= oldest_q + SLOT'(finishes);
      depth_ready_q <= depth_ready_q + (SLOT + 1)'(evicts_i && eviction_i.block.depth == '0) +
                       (SLOT + 1)'(depth_valid_i && depth_i.last) - (SLOT + 1)'(finishes);
      color_ready_q <= color_ready_q + (SLOT + 1)'(color_ready_i) - (SLOT + 1)'(finishes);
      written_q     <= takes_order ? '0 : written_q + WRITES'(finishes);
    end
  end

  assign {sent_depth_strobe, sent_depth} = victim_depth_q[{oldest_q, sent_stamp}];
  assign {sent_color_strobe, sent_color} = victim_color_q[{oldest_q, sent_stamp}];
  always_ff @(posedge clk_i) begin
    if (depth_valid_i) victim_depth_q[{depth_i.slot, depth_i.stamp}] <= {depth_i.strobe, depth_i.depth};
    if (color_valid_i) victim_color_q[{color_i.slot, color_i.stamp}] <= {color_i.strobe, color_i.color};
    if (evicts_i) victim_q[eviction_i.slot] <= eviction_i.block;
  end

  genvar s, v;
  // The stamps left in a slot after what comes into it in this cycle.
  function automatic [STAMPS-1:0] depth_after(input [SLOT-1:0] slot, input [STAMPS-1:0] left);
    depth_after = left;
    if (depth_valid_i && depth_i.slot == slot && depth_i.strobe != '0) depth_after = left | (STAMPS'(1) << depth_i.stamp);
    if (evicts_i && eviction_i.slot == slot) depth_after = {STAMPS{eviction_i.fills[0]}};
  endfunction
  function automatic [STAMPS-1:0] color_after(input [SLOT-1:0] slot, input [STAMPS-1:0] left);
    color_after = left;
    if (color_valid_i && color_i.slot == slot && color_i.strobe != '0) color_after = left | (STAMPS'(1) << color_i.stamp);
    if (evicts_i && eviction_i.slot == slot) color_after = {STAMPS{eviction_i.fills[1]}};
  endfunction
  // Of the oldest slot, and of the one after it, which is the oldest when the former is finished.
  logic [SLOT-1:0]   second;
  logic [STAMPS-1:0] oldest_depth, oldest_color;
  assign second = oldest_q + 1'b1;
  always_comb begin
    oldest_depth = depth_after(oldest_q, depth_left & ~(sends && takes_request && !is_color ? sent : '0));
    oldest_color = color_after(oldest_q, color_left & ~(sends && takes_request && is_color ? sent : '0));
    if (takes_merged && !colors_known) oldest_color = '1;
  end
  always_ff @(posedge clk_i) begin
    oldest_depth_q <= finishes ? depth_after(second, depth_left_q[second]) : oldest_depth;
    oldest_color_q <= finishes ? color_after(second, color_left_q[second]) : oldest_color;
  end
  generate
    for (v = 0; v < VICTIMS; v++) begin : gen_left
      always_ff @(posedge clk_i) begin
        depth_left_q[v] <= oldest_q == SLOT'(v) ? oldest_depth : depth_after(SLOT'(v), depth_left_q[v]);
        color_left_q[v] <= oldest_q == SLOT'(v) ? oldest_color : color_after(SLOT'(v), color_left_q[v]);
      end
    end
    for (s = 0; s < SAMPLES; s++) begin : gen_lent
      assign lent_depth[s*CODE+:CODE] = sent_depth[s*CODE+:CODE] & {CODE{sent_depth_strobe[s]}};
    end
  endgenerate

  // ------------------------------------------------------------------------------------ blocks of one colour a pixel
  localparam int PIXEL_COLORS = raster_pkg::PIXELS * COLOR;  // bits of a stamp's colours, one per pixel
  logic [PIXEL_COLORS-1:0] merged;
  generate
    if (COMPRESSES) begin : gen_pixel_colors
      logic reads_block;  // colours are read
      assign reads_block = wants_read && reads_color;
      pixel_colors u_pixel_colors (
          .clk_i,
          .rst_ni,
          .begins_i      (evicts_i),
          .begin_slot_i  (eviction_i.slot),
          .begin_fills_i (eviction_i.fills[1]),
          .comes_i       (color_valid_i),
          .come_slot_i   (color_i.slot),
          .come_strobe_i (color_i.strobe),
          .come_color_i  (color_i.color),
          .writes_i      (wants_write && is_ready && is_color && color_left != '0),
          .slot_i        (oldest_q),
          .is_every_i    (color_left == '1),
          .write_x_i     (leaving.x),
          .write_y_i     (leaving.y),
          .reads_i       (reads_block),
          .read_tile_x_i (order.tile_x),
          .read_tile_y_i (order.tile_y),
          .read_stamp_i  (order.stamp),
          .ends_i        (finishes || (reads_block && takes_request)),
          .is_known_o    (colors_known),
          .of_pixels_o   (of_pixels),
          .asks_o        (asks_pixels),
          .ask_stamp_o   (asked_stamp),
          .is_asked_i    (asks_pixels && takes_request),
          .other_asked_i (read_goes_o),
          .other_answered_i(response_valid_i && response_ready_i && !merges_o),
          .answers_i     (response_valid_i && response_ready_i && merges_o),
          .answer_i      (response_i.data),
          .merges_o      (takes_merged),
          .takes_answers_o(merges_o),
          .stamp_i       (sent_stamp),
          .merged_o      (merged),
          .token_reads_i (token_i.reads),
          .token_writes_i(token_i.writes),
          .word_x_i      (token_i.x),
          .word_y_i      (token_i.y),
          .word_i        (token_i.word),
          .word_o        (token_word_o)
      );
    end else begin : gen_no_pixel_colors
      assign colors_known = 1'b1;
      assign of_pixels    = 1'b0;
      assign merges_o     = 1'b0;
      assign takes_merged = 1'b0;
      assign asks_pixels  = 1'b0;
      assign asked_stamp  = '0;
      assign merged       = '0;
      assign token_word_o = '0;
    end
  endgenerate

  // --------------------------------------------------- the request: a victim's stamp, a read, or a flush's write
  logic [raster_pkg::TILE_X_BITS-1:0]      sent_tile_x;
  logic [raster_pkg::TILE_Y_BITS-1:0]      sent_tile_y;
  logic [raster_pkg::STAMP_INDEX_BITS-1:0] sent_index;
  stamp_address u_sent_address (
      .block_x_i(leaving.x),
      .block_y_i(leaving.y),
      .stamp_i  (sent_stamp),
      .tile_x_o (sent_tile_x),
      .tile_y_o (sent_tile_y),
      .stamp_o  (sent_index)
  );
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
      .sends_flags_i  (flush_valid_i && flush_i.plane[1]),
      .flags_i        (flush_word_i),
      .sends_cleared_i(flush_valid_i && !flush_i.plane[1]),
      .clear_depth_i,
      .clear_color_i,
      .bytes_o        (request_bytes_o),
      .color_strobe_o (color_strobe)
  );

  raster_pkg::tile_plane_t color_plane;
  assign color_plane = of_pixels || asks_pixels ? raster_pkg::TILE_PLANE_PIXEL_COLOR : raster_pkg::TILE_PLANE_COLOR;
  always_comb begin
    request_o          = '0;
    request_o.is_write = sends;
    request_o.plane    = reads_color && !sends ? color_plane : raster_pkg::TILE_PLANE_DEPTH;
    request_o.tile_x   = order.tile_x;
    request_o.tile_y   = order.tile_y;
    request_o.stamp    = order.stamp;
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
    if (flush_valid_i) request_o = flush_i;
    request_o.data = '0;
  end

endmodule
