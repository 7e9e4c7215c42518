// The framebuffer of blocks without shading, as raster_top joins its stages, without depth_test: the subject of the
// proofs block_cache_*. tools/prove.py inserts depth_cache, memory_answers and write_back as text, so that a property
// can name signals inside them.
module blocks (
    input logic clk_i,
    input logic rst_ni,

    input  logic                         fragment_valid_i,
    output logic                         fragment_ready_o,
    input  raster_pkg::fragment_packet_t fragment_i,

    output logic                                                         tested_valid_o,
    output raster_pkg::fragment_packet_t                                 tested_o,
    output logic [raster_pkg::SAMPLES*raster_pkg::STORED_DEPTH_BITS-1:0] stored_depth_o,
    input  logic                                                         write_valid_i,
    input  raster_pkg::write_packet_t                                    write_i,
    input  logic [raster_pkg::SAMPLES*raster_pkg::STORED_DEPTH_BITS-1:0] word_i,

    output logic                                   request_valid_o,
    input  logic                                   request_ready_i,
    output raster_pkg::memory_request_t            request_o,
    output logic [8*raster_pkg::REQUEST_BYTES-1:0] request_bytes_o,
    input  logic                                   response_valid_i,
    output logic                                   response_ready_o,
    input  raster_pkg::memory_response_t           response_i
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int CODE = raster_pkg::STORED_DEPTH_BITS;
  localparam int COLOR = raster_pkg::STORED_COLOR_BITS;
  localparam int STAMP = raster_pkg::BLOCK_STAMP_BITS;
  localparam int SLOT = raster_pkg::VICTIM_SLOT_BITS;
  localparam int WORD = raster_pkg::FLAG_WORD;
  localparam int INDEX = raster_pkg::STAMP_INDEX_BITS;

  logic                         made_valid, made_ready, ordered_valid, ordered_ready, flush_valid;
  raster_pkg::fragment_packet_t made, x1_fragment;
  raster_pkg::tag_result_t      made_result;
  raster_pkg::block_order_t     ordered;
  raster_pkg::memory_request_t  flush_request;
  logic [WORD-1:0]              flush_word, stored_pixel_word;
  raster_pkg::pixel_word_t      pixel_word;
  logic [CODE-1:0]              clear_depth;
  logic [COLOR-1:0]             clear_color;
  logic                         depths_are_idle, orders_are_done, is_cleared, is_resolved, at_token, tags_are_idle;
  cache_tags u_tags (
      .clk_i,
      .rst_ni,
      .fragment_valid_i,
      .fragment_ready_o,
      .fragment_i,
      .item_valid_o   (made_valid),
      .item_ready_i   (made_ready),
      .item_o         (made),
      .found_o        (made_result),
      .order_valid_o  (ordered_valid),
      .order_ready_i  (ordered_ready),
      .order_o        (ordered),
      .drained_i      (depths_are_idle && orders_are_done),
      .request_valid_o(flush_valid),
      .request_ready_i,
      .request_o      (flush_request),
      .request_word_o (flush_word),
      .pixel_word_o   (pixel_word),
      .pixel_word_i   (stored_pixel_word),
      .clear_depth_o  (clear_depth),
      .clear_color_o  (clear_color),
      .is_cleared_o   (is_cleared),
      .is_resolved_o  (is_resolved),
      .at_token_o     (at_token),
      .idle_o         (tags_are_idle)
  );

  logic                      answer_valid, answer_taken, x1_valid, colors_done, evicts_now, victim_valid, slot_again;
  logic [SAMPLES*CODE-1:0]   answer;
  raster_pkg::tested_stamp_t x1_stamp, w;
  logic [SAMPLES-1:0]        x1_samples;
  raster_pkg::eviction_t     eviction;
  raster_pkg::depth_victim_t depth_victim;
  logic                      never;
  logic [SAMPLES-1:0]        no_samples, all_samples;
  logic [SAMPLES*(CODE+1)-1:0] no_words;
  logic [SAMPLES*CODE-1:0]   ram_depth, held_depth;
  logic [SAMPLES-1:0]        depth_is_held;
  always_comb
    for (int s = 0; s < SAMPLES; s++)
      stored_depth_o[s*CODE+:CODE] = depth_is_held[s] ? held_depth[s*CODE+:CODE] : ram_depth[s*CODE+:CODE];
  assign never       = 1'b0;
  assign no_samples  = '0;
  assign all_samples = '1;
  assign no_words    = '0;
  depth_cache u_depths (
      .clk_i           (clk_i),
      .rst_ni          (rst_ni),
      .made_valid_i    (made_valid),
      .made_ready_o    (made_ready),
      .made_i          (made),
      .made_result_i   (made_result),
      .clear_depth_i   (clear_depth),
      .answer_valid_i  (answer_valid),
      .takes_answer_o  (answer_taken),
      .answer_i        (answer),
      .tested_valid_o  (tested_valid_o),
      .tested_o        (tested_o),
      .stored_depth_o  (ram_depth),
      .is_held_o       (depth_is_held),
      .held_depth_o    (held_depth),
      .write_valid_i   (write_valid_i),
      .write_i         (write_i),
      .word_i          (word_i),
      .stamp_valid_o   (x1_valid),
      .stamp_o         (x1_stamp),
      .stamp_fragment_o(x1_fragment),
      .stamp_writes_o  (x1_samples),
      .stamp_leaves_i  (colors_done),
      .late_valid_i    (never),
      .late_i          (w),
      .late_writes_i   (no_samples),
      .late_word_i     (no_words),
      .evicts_o        (evicts_now),
      .eviction_o      (eviction),
      .victim_valid_o  (victim_valid),
      .victim_o        (depth_victim),
      .slot_free_i     (slot_again),
      .idle_o          (depths_are_idle)
  );

  logic                     w_valid, has_room;
  logic [SAMPLES*COLOR-1:0] w_color;
  skid_buffer #(
      .WIDTH(raster_pkg::TESTED_STAMP_BITS + SAMPLES * COLOR)
  ) u_colored (
      .clk_i,
      .rst_ni,
      .valid_i(x1_valid),
      .ready_o(has_room),
      .data_i ({x1_stamp, write_i.color}),
      .valid_o(w_valid),
      .ready_i(colors_done),
      .data_o ({w, w_color})
  );

  logic                      c_valid, c_ready, write_is_idle, color_answer_valid, color_answer_taken;
  raster_pkg::color_victim_t c;
  logic [SAMPLES*COLOR-1:0]  color_answer;
  color_write u_write (
      .clk_i,
      .rst_ni,
      .stamp_valid_i  (w_valid),
      .stamp_ready_o  (colors_done),
      .tested_i       (w),
      .opaque_i       (all_samples),
      .color_i        (w_color),
      .clear_color_i  (clear_color),
      .answer_valid_i (color_answer_valid),
      .answer_i       (color_answer),
      .answer_ready_o (color_answer_taken),
      .victim_valid_o (c_valid),
      .victim_o       (c),
      .victim_ready_o (c_ready),
      .idle_o         (write_is_idle)
  );

  logic read_goes, read_color, read_of_pixels, merges, asks_stamp, writes_stamp;
  write_back u_write_back (
      .clk_i           (clk_i),
      .rst_ni          (rst_ni),
      .ordered_valid_i (ordered_valid),
      .ordered_ready_o (ordered_ready),
      .ordered_i       (ordered),
      .flush_valid_i   (flush_valid),
      .flush_i         (flush_request),
      .flush_word_i    (flush_word),
      .clear_depth_i   (clear_depth),
      .clear_color_i   (clear_color),
      .evicts_i        (evicts_now),
      .eviction_i      (eviction),
      .depth_valid_i   (victim_valid),
      .depth_i         (depth_victim),
      .slot_free_o     (slot_again),
      .color_valid_i   (c_valid),
      .color_i         (c),
      .color_ready_i   (c_ready),
      .request_valid_o (request_valid_o),
      .request_ready_i (request_ready_i),
      .request_o       (request_o),
      .request_bytes_o (request_bytes_o),
      .response_valid_i(response_valid_i),
      .response_ready_i(response_ready_o),
      .response_i      (response_i),
      .read_goes_o     (read_goes),
      .read_color_o    (read_color),
      .read_of_pixels_o(read_of_pixels),
      .merges_o        (merges),
      .token_i         (pixel_word),
      .token_word_o    (stored_pixel_word),
      .fills_o         (asks_stamp),
      .stores_o        (writes_stamp),
      .idle_o          (orders_are_done)
  );
  memory_answers u_answers (
      .clk_i           (clk_i),
      .rst_ni          (rst_ni),
      .read_goes_i     (read_goes),
      .read_color_i    (read_color),
      .read_of_pixels_i(read_of_pixels),
      .merges_i        (merges),
      .response_valid_i(response_valid_i),
      .response_ready_o(response_ready_o),
      .response_i      (response_i),
      .depth_valid_o   (answer_valid),
      .depth_ready_i   (answer_taken),
      .depth_o         (answer),
      .color_valid_o   (color_answer_valid),
      .color_ready_i   (color_answer_taken),
      .color_o         (color_answer)
  );

endmodule
