// The raster pipeline: snapped primitives in, tiles of depth and colour in memory out.
//
//   cull -> triangle_setup -> coarse_raster -> fine_raster -> interpolate -.
//                               ^      '-> context_ram -------^            v
//                               |                  line_raster -> primitive_join
//                               |                                          | fragment
//                               |      .-----------------------------------'
//                               |      v
//                               |  cache_tags ----> depth_cache <--> depth_test
//                               |      |              |   |               |
//                               '------|--------------|---|-- retire -----'
//                                      |              |   v
//                                      |              |  light_stage -> texture_stage -> fog_stage -> stamp_rop
//                                      | orders       |    with a texture unit; else one queue           |
//                                      |      victims |                                                  v
//                                      v              v    victims                            late_test, color_write
//                                    write_back <---------------------------------------------------'    ^
//                                      | request                                                         |
//                                      v             response                                            |
//                                    memory_port ------------> memory_answers --- stored depths, colours-'
//                                      | beat ^ answer
//                                      v      |
//                                      memory
//
// This is the framebuffer of blocks (cache.kind). The framebuffer of tiles is one stage, next to depth_test.
//
// Every arrow that waits is a stream: a packet moves when valid and ready are both high. Bit raster_pkg::STALL_X of
// stall_i holds arrow X back for a cycle, for tests; hardware ties it to 0. Arrows are named X_data, X_valid, X_ready,
// as cosim/taps.svh expects. Results never depend on the timing of packets, only on their content. docs/pipeline.md
// lists the latency and the interval of each stage; the host must clear depth and colour once before it draws.
module raster_top (
    input logic clk_i,
    input logic rst_ni,       // at any time, for a cycle at least
    input logic power_on_ni,  // with rst_ni at power-on: earlier requests to memory are forgotten

    input logic [raster_pkg::STALL_BITS-1:0] stall_i,

    // From the host
    input  logic                          primitive_valid_i,
    output logic                          primitive_ready_o,
    input  raster_pkg::primitive_packet_t primitive_i,

    // From the host: the lines, in the order of the primitives of kind line that hold their places
    input  logic                    line_valid_i,
    output logic                    line_ready_o,
    input  raster_pkg::line_setup_t line_i,

    // To memory: bursts of beats. Each beat that was read is answered, and each burst that was written, in order
    input  raster_pkg::memory_layout_t layout_i,  // from the host; stays while anything is under way
    output logic                       beat_valid_o,
    input  logic                       beat_ready_i,
    output raster_pkg::memory_beat_t   beat_o,
    input  logic                       answer_valid_i,
    output logic                       answer_ready_o,
    input  raster_pkg::memory_answer_t answer_i,

    // To the texture memory: reads of lines, answered beat by beat in order
    output logic                         texture_valid_o,
    input  logic                         texture_ready_i,
    output raster_pkg::texture_request_t texture_o,
    input  logic                         texel_valid_i,
    output logic                         texel_ready_o,
    input  raster_pkg::texel_beat_t      texel_i,

    // Snapshot of the counters of one cycle: it stays while hold is high, to be read word by word; counting goes on
    input  logic                        counters_hold_i,
    output raster_pkg::counter_packet_t counters_o,
    // Nothing is in flight: every primitive of earlier cycles has been drawn, and memory has answered all requests. Pixels
    // drawn may lie on the chip alone; after a flush all of them are in memory.
    output logic                        idle_o,
    // For a cycle, once for each flush in their order: it and everything before it is in memory. At most three flushes may
    // be in flight where these pulses are counted.
    output logic                        flushed_o
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int PIXELS = raster_pkg::PIXELS;
  localparam int COUNT = raster_pkg::SAMPLE_COUNT_BITS;
  localparam int DEPTHS = SAMPLES * raster_pkg::STORED_DEPTH_BITS;  // bits of a stamp's stored words
  localparam bit HAS_TEXTURE = raster_pkg::COORDINATES != 0;
  localparam bit LATE = raster_pkg::LATE_ALPHA != 0;

  // ---------------------------------------------------------------------------------------------------------- the streams
  // Signals at the consumer.
  logic triangle_valid, triangle_ready, setup_valid, setup_ready, tile_valid, tile_ready, stamp_valid, stamp_ready;
  logic line_pixel_valid, line_pixel_ready, fragment_valid, fragment_ready, request_valid, request_ready;
  logic response_valid, response_ready, write_valid, retire_valid, color_valid, color_ready;
  raster_pkg::triangle_packet_t            triangle_data;
  raster_pkg::setup_packet_t               setup_data;
  raster_pkg::context_packet_t             context_data;
  raster_pkg::tile_packet_t                tile_data;
  raster_pkg::edge_context_t               edges_data;
  logic [3*raster_pkg::TILE_EDGE_BITS-1:0] visit_edges;
  raster_pkg::stamp_packet_t               stamp_data;
  raster_pkg::line_pixel_t                 line_pixel_data;
  raster_pkg::fragment_packet_t            fragment_data;  // without constants that are stored separately
  raster_pkg::write_packet_t               write_data;  // without its depths and words: the depths are the fragment's
  logic [DEPTHS-1:0]                       write_word;
  raster_pkg::retire_packet_t              retire_data;
  raster_pkg::memory_request_t             request_data;   // without its data, with the framebuffer of blocks
  logic [8*raster_pkg::REQUEST_BYTES-1:0]  request_bytes;  // its data as they lie in memory
  raster_pkg::memory_response_t            response_data;
  raster_pkg::color_packet_t               color_data;
  logic                                    tested_valid;   // the fragment in the test, with its stored words
  raster_pkg::fragment_packet_t            tested;

  // At the producer, before a stall.
  logic primitive_ready, triangle_offered, setup_offered, tile_offered, stamp_offered, fragment_offered;
  logic request_offered, response_offered, beat_offered, answer_ready, texture_offered, texel_accepted;
  logic triangle_accepted, setup_accepted, tile_accepted, stamp_accepted, fragment_accepted;
  logic request_accepted, response_accepted;
  assign primitive_ready_o = primitive_ready && !stall_i[raster_pkg::STALL_PRIMITIVE];
  assign triangle_valid    = triangle_offered && !stall_i[raster_pkg::STALL_TRIANGLE];
  assign triangle_ready    = triangle_accepted && !stall_i[raster_pkg::STALL_TRIANGLE];
  assign setup_valid       = setup_offered && !stall_i[raster_pkg::STALL_SETUP];
  assign setup_ready       = setup_accepted && !stall_i[raster_pkg::STALL_SETUP];
  assign tile_valid        = tile_offered && !stall_i[raster_pkg::STALL_TILE];
  assign tile_ready        = tile_accepted && !stall_i[raster_pkg::STALL_TILE];
  assign stamp_valid       = stamp_offered && !stall_i[raster_pkg::STALL_STAMP];
  assign stamp_ready       = stamp_accepted && !stall_i[raster_pkg::STALL_STAMP];
  assign fragment_valid    = fragment_offered && !stall_i[raster_pkg::STALL_FRAGMENT];
  assign fragment_ready    = fragment_accepted && !stall_i[raster_pkg::STALL_FRAGMENT];
  assign request_valid     = request_offered && !stall_i[raster_pkg::STALL_REQUEST];
  assign request_ready     = request_accepted && !stall_i[raster_pkg::STALL_REQUEST];
  assign response_valid    = response_offered && !stall_i[raster_pkg::STALL_RESPONSE];
  assign response_ready    = response_accepted && !stall_i[raster_pkg::STALL_RESPONSE];
  assign beat_valid_o      = beat_offered && !stall_i[raster_pkg::STALL_BEAT];
  assign answer_ready_o    = answer_ready && !stall_i[raster_pkg::STALL_ANSWER];
  assign texture_valid_o   = texture_offered && !stall_i[raster_pkg::STALL_TEXTURE];
  assign texel_ready_o     = texel_accepted && !stall_i[raster_pkg::STALL_TEXEL];

  // Next to the streams: context slots, counter events, idle flags.
  logic [raster_pkg::SLOT_BITS-1:0]                                   context_slot, read_slot;
  logic                                                               slot_free, context_read;
  raster_pkg::context_packet_t                                        stamp_context, tested_context;
  logic [raster_pkg::ALL_LOCAL_BITS-1:0]                              context_step;
  logic                                                               fragment_comes;
  logic [raster_pkg::TRIANGLE_BITS-1:0]                               triangle_number, coming_number;
  logic is_primitive, is_zero_area, is_backface, is_empty, is_no_sample, is_dropped;
  logic is_visited, is_outside, is_accepted, is_hiz, visits_are_done, lines_are_done;
  logic [2*raster_pkg::TILE_SHIFT+$clog2(raster_pkg::MSAA_SAMPLES):0] samples_tested;
  logic [COUNT-1:0] covered, passed, written, killed, tested_written, tested_killed, late_written, late_killed;
  logic             is_fill, is_evict, is_clear;
  logic [6:0]       texture_use;
  logic             framebuffer_idle, port_idle, moves_tiles;
  logic             flush_ends;  // memory_port has taken all of its requests

  // --------------------------------------------------------- primitives to fragments: pipelined, or a step at a time
  logic shaded_valid, shaded_ready;  // output of interpolate
  raster_pkg::fragment_packet_t shaded_data;
  generate
    if (raster_pkg::SETUP_KIND == 0) begin : gen_pipelined
      cull u_cull (
          .clk_i,
          .rst_ni,
          .primitive_valid_i(primitive_valid_i && !stall_i[raster_pkg::STALL_PRIMITIVE]),
          .primitive_ready_o(primitive_ready),
          .primitive_i,
          .triangle_valid_o (triangle_offered),
          .triangle_ready_i (triangle_ready),
          .triangle_o       (triangle_data),
          .is_primitive_o   (is_primitive),
          .is_zero_area_o   (is_zero_area),
          .is_backface_o    (is_backface),
          .is_empty_o       (is_empty),
          .is_no_sample_o   (is_no_sample),
          .is_dropped_o     (is_dropped)
      );
      triangle_setup u_triangle_setup (
          .clk_i,
          .rst_ni,
          .triangle_valid_i(triangle_valid),
          .triangle_ready_o(triangle_accepted),
          .triangle_i      (triangle_data),
          .setup_valid_o   (setup_offered),
          .setup_ready_i   (setup_ready),
          .setup_o         (setup_data)
      );
      coarse_raster u_coarse_raster (
          .clk_i,
          .rst_ni,
          .setup_valid_i    (setup_valid),
          .setup_ready_o    (setup_accepted),
          .setup_i          (setup_data),
          .context_slot_o   (context_slot),
          .context_o        (context_data),
          .context_step_o   (context_step),
          .slot_free_i      (slot_free),
          .tile_valid_o     (tile_offered),
          .tile_ready_i     (tile_ready),
          .tile_o           (tile_data),
          .edges_o          (edges_data),
          .visit_edges_o    (visit_edges),
          .retire_valid_i   (retire_valid),
          .retire_i         (retire_data),
          .is_visited_o     (is_visited),
          .is_outside_o     (is_outside),
          .is_accepted_o    (is_accepted),
          .is_hiz_o         (is_hiz),
          .samples_tested_o (samples_tested),
          .visits_are_done_o(visits_are_done)
      );
      fine_raster u_fine_raster (
          .clk_i,
          .rst_ni,
          .tile_valid_i (tile_valid),
          .tile_ready_o (tile_accepted),
          .tile_i       (tile_data),
          .edges_i      (edges_data),
          .visit_edges_i(visit_edges),
          .stamp_valid_o(stamp_offered),
          .stamp_ready_i(stamp_ready),
          .stamp_o      (stamp_data)
      );
      interpolate u_interpolate (
          .clk_i,
          .rst_ni,
          .stamp_valid_i   (stamp_valid),
          .stamp_ready_o   (stamp_accepted),
          .stamp_i         (stamp_data),
          .context_read_o  (context_read),
          .context_slot_o  (read_slot),
          .context_i       (stamp_context),
          .slot_free_o     (slot_free),
          .fragment_valid_o(shaded_valid),
          .fragment_ready_i(shaded_ready),
          .fragment_o      (shaded_data)
      );
    end else begin : gen_serial
      cull_serial u_cull (
          .clk_i,
          .rst_ni,
          .primitive_valid_i(primitive_valid_i && !stall_i[raster_pkg::STALL_PRIMITIVE]),
          .primitive_ready_o(primitive_ready),
          .primitive_i,
          .triangle_valid_o (triangle_offered),
          .triangle_ready_i (triangle_ready),
          .triangle_o       (triangle_data),
          .is_primitive_o   (is_primitive),
          .is_zero_area_o   (is_zero_area),
          .is_backface_o    (is_backface),
          .is_empty_o       (is_empty),
          .is_no_sample_o   (is_no_sample),
          .is_dropped_o     (is_dropped)
      );
      triangle_setup_serial u_triangle_setup (
          .clk_i,
          .rst_ni,
          .triangle_valid_i(triangle_valid),
          .triangle_ready_o(triangle_accepted),
          .triangle_i      (triangle_data),
          .setup_valid_o   (setup_offered),
          .setup_ready_i   (setup_ready),
          .setup_o         (setup_data)
      );
      coarse_raster_serial u_coarse_raster (
          .clk_i,
          .rst_ni,
          .setup_valid_i    (setup_valid),
          .setup_ready_o    (setup_accepted),
          .setup_i          (setup_data),
          .context_slot_o   (context_slot),
          .context_o        (context_data),
          .context_step_o   (context_step),
          .slot_free_i      (slot_free),
          .tile_valid_o     (tile_offered),
          .tile_ready_i     (tile_ready),
          .tile_o           (tile_data),
          .edges_o          (edges_data),
          .visit_edges_o    (visit_edges),
          .retire_valid_i   (retire_valid),
          .retire_i         (retire_data),
          .is_visited_o     (is_visited),
          .is_outside_o     (is_outside),
          .is_accepted_o    (is_accepted),
          .is_hiz_o         (is_hiz),
          .samples_tested_o (samples_tested),
          .visits_are_done_o(visits_are_done)
      );
      fine_raster_serial u_fine_raster (
          .clk_i,
          .rst_ni,
          .tile_valid_i (tile_valid),
          .tile_ready_o (tile_accepted),
          .tile_i       (tile_data),
          .edges_i      (edges_data),
          .visit_edges_i(visit_edges),
          .stamp_valid_o(stamp_offered),
          .stamp_ready_i(stamp_ready),
          .stamp_o      (stamp_data)
      );
      interpolate_serial u_interpolate (
          .clk_i,
          .rst_ni,
          .stamp_valid_i   (stamp_valid),
          .stamp_ready_o   (stamp_accepted),
          .stamp_i         (stamp_data),
          .context_read_o  (context_read),
          .context_slot_o  (read_slot),
          .context_i       (stamp_context),
          .slot_free_o     (slot_free),
          .fragment_valid_o(shaded_valid),
          .fragment_ready_i(shaded_ready),
          .fragment_o      (shaded_data)
      );
    end
  endgenerate
  context_ram u_context (
      .clk_i,
      .rst_ni,
      .write_i          (setup_valid && setup_accepted),
      .write_slot_i     (context_slot),
      .context_i        (context_data),
      .step_i           (context_step),
      .read_i           (context_read),
      .read_slot_i      (read_slot),
      .context_o        (stamp_context),
      .comes_i          (fragment_comes),
      .coming_number_i  (coming_number),
      .tested_context_o (tested_context),
      .number_o         (triangle_number)
  );

  // Lines: drawn in parallel, joined where their pixels are tested.
  generate
    if (raster_pkg::LINES_UNIT != 0) begin : gen_lines
      logic line_ready, pixel_offered, pixel_accepted;
      assign line_ready_o     = line_ready && !stall_i[raster_pkg::STALL_LINE];
      assign line_pixel_valid = pixel_offered && !stall_i[raster_pkg::STALL_LINE_PIXEL];
      assign line_pixel_ready = pixel_accepted && !stall_i[raster_pkg::STALL_LINE_PIXEL];
      assign lines_are_done   = !pixel_offered;
      line_raster u_line_raster (
          .clk_i,
          .rst_ni,
          .line_valid_i (line_valid_i && !stall_i[raster_pkg::STALL_LINE]),
          .line_ready_o (line_ready),
          .line_i,
          .pixel_valid_o(pixel_offered),
          .pixel_ready_i(line_pixel_ready),
          .pixel_o      (line_pixel_data)
      );
      primitive_join u_primitive_join (
          .fragment_valid_i(shaded_valid),
          .fragment_ready_o(shaded_ready),
          .fragment_i      (shaded_data),
          .pixel_valid_i   (line_pixel_valid),
          .pixel_ready_o   (pixel_accepted),
          .pixel_i         (line_pixel_data),
          .fragment_valid_o(fragment_offered),
          .fragment_ready_i(fragment_ready),
          .fragment_o      (fragment_data)
      );
    end else begin : gen_no_lines
      assign line_ready_o     = 1'b0;
      assign line_pixel_valid = 1'b0;
      assign line_pixel_ready = 1'b0;
      assign line_pixel_data  = '0;
      assign lines_are_done   = 1'b1;
      assign fragment_offered = shaded_valid;
      assign shaded_ready     = fragment_ready;
      assign fragment_data    = shaded_data;
    end
  endgenerate

  // ---------------------------------------------------------------------------------------------------------------- the test
  logic                         tested_ready, access_valid, access_ready;
  raster_pkg::fragment_packet_t access;
  logic [raster_pkg::STORED_COLOR_BITS-1:0] access_color;
  logic [DEPTHS-1:0]            stored_depth, held_depth;
  logic [raster_pkg::SAMPLES-1:0] depth_is_held;
  depth_test u_depth_test (
      .clk_i,
      .rst_ni,
      .fragment_valid_i(tested_valid),
      .fragment_ready_o(tested_ready),
      .fragment_i      (tested),
      .access_valid_o  (access_valid),
      .access_ready_i  (access_ready),
      .access_o        (access),
      .access_color_o  (access_color),
      .stored_depth_i  (stored_depth),
      .is_held_i       (depth_is_held),
      .held_depth_i    (held_depth),
      .write_valid_o   (write_valid),
      .write_o         (write_data),
      .word_o          (write_word),
      .retire_valid_o  (retire_valid),
      .retire_o        (retire_data),
      .covered_o       (covered),
      .passed_o        (passed),
      .written_o       (tested_written),
      .killed_o        (tested_killed)
  );

  // ------------------------------------------------------------------------------------ the framebuffer, and shading
  logic                         item_valid, item_ready, order_valid, order_ready, flush_valid;
  raster_pkg::fragment_packet_t item;
  raster_pkg::tag_result_t      found;
  raster_pkg::block_order_t     order;
  raster_pkg::memory_request_t  flush_data;
  raster_pkg::pixel_word_t      pixel_word;
  logic [raster_pkg::FLAG_WORD-1:0]         flush_word, stored_pixel_word;
  logic [raster_pkg::STORED_DEPTH_BITS-1:0] clear_depth;
  logic [raster_pkg::STORED_COLOR_BITS-1:0] clear_color;
  logic tags_are_idle, depths_are_idle, texture_is_idle, write_is_idle, orders_are_done;
  logic is_resolved, stores;

  logic                      evicts, slot_free_again, depth_victim_valid, color_victim_valid, colors_are_evicted;
  raster_pkg::eviction_t     eviction;
  raster_pkg::depth_victim_t depth_victim;
  raster_pkg::color_victim_t color_victim;
  logic                      read_goes, read_color, read_of_pixels, merges;  // write_back to memory_answers
  logic                      depth_valid, depth_taken, stored_color_valid, stored_color_taken;
  logic [DEPTHS-1:0]         answered_depth;
  logic [SAMPLES*raster_pkg::STORED_COLOR_BITS-1:0] stored_color;

  // From depth_cache through light, texture and fog to color_write.
  localparam int RGBA = 8 * raster_pkg::COLOR_PLANES;
  localparam int WRITTEN = raster_pkg::WRITTEN_COLOR_BITS;
  logic                         passed_valid, lit_valid, textured_valid, textured_ready, colored_valid, colored_ready;
  raster_pkg::tested_stamp_t    passed_stamp, lit_stamp, textured_stamp, colored_stamp;
  raster_pkg::fragment_packet_t passed_fragment, whole_fragment, lit_fragment;
  logic [SAMPLES-1:0]           passed_samples, opaque;
  logic [PIXELS-1:0]            passed_pixels, lit_pixels, textured_mask, fogged_mask;
  logic [PIXELS*WRITTEN-1:0]    passed_color, lit_color;
  logic [PIXELS*RGBA-1:0]       textured_rgba, fogged_rgba;
  logic [raster_pkg::FOG_WORD_BITS-1:0]               fog_entering, fog_leaving;
  logic [SAMPLES*raster_pkg::SHADED_COLOR_BITS-1:0] colored_color;
  logic [PIXELS*8-1:0]          colored_alpha;
  logic                         late_valid;
  logic [SAMPLES-1:0]           late_writes;
  logic [DEPTHS+SAMPLES-1:0]    late_word;

  genvar s;
  generate
    for (s = 0; s < PIXELS; s++) begin : gen_pixel
      localparam int N = raster_pkg::MSAA_SAMPLES;
      assign passed_pixels[s] = passed_samples[s*N+:N] != '0;
      assign passed_color[s*WRITTEN+:WRITTEN] = write_data.color[s*N*WRITTEN+:WRITTEN];
    end
    if (raster_pkg::CACHE_KIND == 0) begin : gen_tiles
      assign tested_valid      = fragment_valid;
      assign fragment_accepted = tested_ready;
      assign tested            = fragment_data;
      framebuffer u_framebuffer (
          .clk_i,
          .rst_ni,
          .access_valid_i  (access_valid),
          .access_ready_o  (access_ready),
          .access_i        (access),
          .access_color_i  (access_color),
          .stored_depth_o  (stored_depth),
          .write_valid_i   (write_valid),
          .write_i         (write_data),
          .request_valid_o (request_offered),
          .request_ready_i (request_ready),
          .request_o       (request_data),
          .response_valid_i(response_valid),
          .response_ready_o(response_accepted),
          .response_i      (response_data),
          .fill_o          (is_fill),
          .evict_o         (is_evict),
          .clear_o         (is_clear),
          .moves_tiles_o   (moves_tiles),
          .idle_o          (framebuffer_idle)
      );
      request_bytes u_request_bytes (
          .request_i(request_data),
          .bytes_o  (request_bytes)
      );
      assign fragment_comes = 1'b0;
      assign coming_number  = '0;
      assign depth_is_held = '0;
      assign held_depth    = '0;
      assign written    = tested_written;
      assign killed     = tested_killed;
      assign flush_ends = access_valid && access_ready && access.kind == raster_pkg::PRIMITIVE_KIND_FLUSH;
    end else begin : gen_blocks
      assign access_ready     = 1'b1;
      assign flush_ends       = fragment_valid && fragment_accepted && fragment_data.kind == raster_pkg::PRIMITIVE_KIND_FLUSH;
      assign written          = LATE ? late_written : tested_written;
      assign killed           = LATE ? late_killed : tested_killed;
      assign is_evict         = stores || is_resolved;
      assign framebuffer_idle = tags_are_idle && depths_are_idle && orders_are_done && texture_is_idle && write_is_idle;
      cache_tags u_tags (
          .clk_i,
          .rst_ni,
          .fragment_valid_i(fragment_valid),
          .fragment_ready_o(fragment_accepted),
          .fragment_i      (fragment_data),
          .item_valid_o    (item_valid),
          .item_ready_i    (item_ready),
          .item_o          (item),
          .found_o         (found),
          .order_valid_o   (order_valid),
          .order_ready_i   (order_ready),
          .order_o         (order),
          .drained_i       (depths_are_idle && orders_are_done),
          .request_valid_o (flush_valid),
          .request_ready_i (request_ready),
          .request_o       (flush_data),
          .request_word_o  (flush_word),
          .pixel_word_o    (pixel_word),
          .pixel_word_i    (stored_pixel_word),
          .clear_depth_o   (clear_depth),
          .clear_color_o   (clear_color),
          .is_cleared_o    (is_clear),
          .is_resolved_o   (is_resolved),
          .at_token_o      (moves_tiles),
          .idle_o          (tags_are_idle)
      );
      depth_cache u_depths (
          .clk_i,
          .rst_ni,
          .made_valid_i    (item_valid),
          .made_ready_o    (item_ready),
          .made_i          (item),
          .made_result_i   (found),
          .clear_depth_i   (clear_depth),
          .answer_valid_i  (depth_valid),
          .takes_answer_o  (depth_taken),
          .answer_i        (answered_depth),
          .comes_o         (fragment_comes),
          .coming_number_o (coming_number),
          .tested_valid_o  (tested_valid),
          .tested_o        (tested),
          .stored_depth_o  (stored_depth),
          .is_held_o       (depth_is_held),
          .held_depth_o    (held_depth),
          .write_valid_i   (write_valid),
          .write_i         (write_data),
          .word_i          (write_word),
          .stamp_valid_o   (passed_valid),
          .stamp_o         (passed_stamp),
          .stamp_fragment_o(passed_fragment),
          .stamp_writes_o  (passed_samples),
          .stamp_leaves_i  (colored_ready),
          .late_valid_i    (late_valid),
          .late_i          (colored_stamp),
          .late_writes_i   (late_writes),
          .late_word_i     (late_word),
          .evicts_o        (evicts),
          .eviction_o      (eviction),
          .victim_valid_o  (depth_victim_valid),
          .victim_o        (depth_victim),
          .slot_free_i     (slot_free_again),
          .idle_o          (depths_are_idle)
      );

      if (HAS_TEXTURE) begin : gen_shading
        whole_fragment u_whole (
            .fragment_i(passed_fragment),
            .context_i (tested_context),
            .fragment_o(whole_fragment)
        );
        light_stage u_light (
            .clk_i,
            .rst_ni,
            .stamp_valid_i(passed_valid),
            .stamp_i      (passed_stamp),
            .fragment_i   (whole_fragment),
            .writes_i     (passed_pixels),
            .color_i      (passed_color),
            .stamp_valid_o(lit_valid),
            .stamp_o      (lit_stamp),
            .fragment_o   (lit_fragment),
            .writes_o     (lit_pixels),
            .color_o      (lit_color)
        );
        fog_lookup u_fog_lookup (
            .clk_i,
            .rst_ni,
            .stamp_valid_i(lit_valid),
            .fragment_i   (lit_fragment),
            .word_o       (fog_entering)
        );
        texture_stage u_texture (
            .clk_i,
            .power_on_ni,
            .rst_ni,
            .stamp_valid_i  (lit_valid),
            .stamp_i        (lit_stamp),
            .fragment_i     (lit_fragment),
            .fog_i          (fog_entering),
            .writes_i       (lit_pixels),
            .color_i        (lit_color),
            .stamp_valid_o  (textured_valid),
            .stamp_ready_i  (textured_ready),
            .stamp_o        (textured_stamp),
            .fog_o          (fog_leaving),
            .mask_o         (textured_mask),
            .rgba_o         (textured_rgba),
            .texture_valid_o(texture_offered),
            .texture_ready_i(texture_ready_i && !stall_i[raster_pkg::STALL_TEXTURE]),
            .texture_o,
            .texel_valid_i  (texel_valid_i && !stall_i[raster_pkg::STALL_TEXEL]),
            .texel_ready_o  (texel_accepted),
            .texel_i,
            .use_o          (texture_use),
            .idle_o         (texture_is_idle)
        );
        fog_stage u_fog (
            .clk_i,
            .rst_ni,
            .stamp_valid_i(textured_valid),
            .stamp_ready_o(textured_ready),
            .stamp_i      (textured_stamp),
            .fog_i        (fog_leaving),
            .mask_i       (textured_mask),
            .rgba_i       (textured_rgba),
            .stamp_valid_o(colored_valid),
            .stamp_ready_i(colored_ready),
            .stamp_o      (colored_stamp),
            .mask_o       (fogged_mask),
            .rgba_o       (fogged_rgba)
        );
        stamp_rop u_rop (
            .mask_i  (fogged_mask),
            .rgba_i  (fogged_rgba),
            .color_o (colored_color),
            .alpha_o (colored_alpha),
            .packet_o(color_data)
        );
        assign color_valid = colored_valid && fogged_mask != '0;
        assign color_ready = colored_ready;
      end else begin : gen_unshaded
        logic                      has_room;  // always 1: depth_cache counts
        logic [PIXELS*WRITTEN-1:0] color;
        skid_buffer #(
            .WIDTH(raster_pkg::TESTED_STAMP_BITS + PIXELS * WRITTEN)
        ) u_colored (
            .clk_i,
            .rst_ni,
            .valid_i(passed_valid),
            .ready_o(has_room),
            .data_i ({passed_stamp, passed_color}),
            .valid_o(colored_valid),
            .ready_i(colored_ready),
            .data_o ({colored_stamp, color})
        );
        for (s = 0; s < SAMPLES; s++) begin : gen_sample
          assign colored_color[s*WRITTEN+:WRITTEN] = color[s/raster_pkg::MSAA_SAMPLES*WRITTEN+:WRITTEN];
        end
        assign colored_alpha   = '0;
        assign texture_is_idle = 1'b1;
      end

      late_test u_late_test (
          .clk_i,
          .rst_ni,
          .stamp_leaves_i(colored_ready),
          .stamp_i       (colored_stamp),
          .alpha_i       (colored_alpha),
          .opaque_o      (opaque),
          .late_valid_o  (late_valid),
          .late_writes_o (late_writes),
          .late_word_o   (late_word),
          .written_o     (late_written),
          .killed_o      (late_killed)
      );
      color_write u_write (
          .clk_i,
          .rst_ni,
          .stamp_valid_i  (colored_valid),
          .stamp_ready_o  (colored_ready),
          .tested_i       (colored_stamp),
          .opaque_i       (opaque),
          .color_i        (colored_color),
          .clear_color_i  (clear_color),
          .answer_valid_i (stored_color_valid),
          .answer_i       (stored_color),
          .answer_ready_o (stored_color_taken),
          .victim_valid_o (color_victim_valid),
          .victim_o       (color_victim),
          .victim_ready_o (colors_are_evicted),
          .idle_o         (write_is_idle)
      );
      write_back u_write_back (
          .clk_i,
          .rst_ni,
          .ordered_valid_i (order_valid),
          .ordered_ready_o (order_ready),
          .ordered_i       (order),
          .flush_valid_i   (flush_valid),
          .flush_i         (flush_data),
          .flush_word_i    (flush_word),
          .clear_depth_i   (clear_depth),
          .clear_color_i   (clear_color),
          .evicts_i        (evicts),
          .eviction_i      (eviction),
          .depth_valid_i   (depth_victim_valid),
          .depth_i         (depth_victim),
          .slot_free_o     (slot_free_again),
          .color_valid_i   (color_victim_valid),
          .color_i         (color_victim),
          .color_ready_i   (colors_are_evicted),
          .request_valid_o (request_offered),
          .request_ready_i (request_ready),
          .request_o       (request_data),
          .request_bytes_o (request_bytes),
          .response_valid_i(response_valid),
          .response_ready_i(response_accepted),
          .response_i      (response_data),
          .read_goes_o     (read_goes),
          .read_color_o    (read_color),
          .read_of_pixels_o(read_of_pixels),
          .merges_o        (merges),
          .token_i         (pixel_word),
          .token_word_o    (stored_pixel_word),
          .fills_o         (is_fill),
          .stores_o        (stores),
          .idle_o          (orders_are_done)
      );
      memory_answers u_answers (
          .clk_i,
          .rst_ni,
          .read_goes_i     (read_goes),
          .read_color_i    (read_color),
          .read_of_pixels_i(read_of_pixels),
          .merges_i        (merges),
          .response_valid_i(response_valid),
          .response_ready_o(response_accepted),
          .response_i      (response_data),
          .depth_valid_o   (depth_valid),
          .depth_ready_i   (depth_taken),
          .depth_o         (answered_depth),
          .color_valid_o   (stored_color_valid),
          .color_ready_i   (stored_color_taken),
          .color_o         (stored_color)
      );
    end
    if (!HAS_TEXTURE) begin : gen_no_texture
      assign color_valid     = 1'b0;
      assign color_ready     = 1'b0;
      assign color_data      = '0;
      assign texture_offered = 1'b0;
      assign texture_o       = '0;
      assign texel_accepted  = 1'b0;
      assign texture_use     = '0;
    end
  endgenerate

  memory_port u_memory_port (
      .clk_i,
      .power_on_ni,
      .rst_ni,
      .layout_i,
      .request_valid_i (request_valid),
      .request_ready_o (request_accepted),
      .request_i       (request_data),
      .bytes_i         (request_bytes),
      .response_valid_o(response_offered),
      .response_ready_i(response_ready),
      .response_o      (response_data),
      .beat_valid_o    (beat_offered),
      .beat_ready_i    (beat_ready_i && !stall_i[raster_pkg::STALL_BEAT]),
      .beat_o,
      .answer_valid_i  (answer_valid_i && !stall_i[raster_pkg::STALL_ANSWER]),
      .answer_ready_o  (answer_ready),
      .answer_i,
      .idle_o          (port_idle),
      .flush_ends_i    (flush_ends),
      .flushed_o
  );

  // -------------------------------------------------------------------------------------------------------- idle, and counters
  // Primitives between the host and the end of their last stamp.
  localparam int UNDER_WAY = $clog2(raster_pkg::CONTEXT_SLOTS + 24);
  logic [UNDER_WAY-1:0] under_way_q;  // one more where the last stamp has been taken in the cycle before, which is known late
  logic                 enters, ends_q;
  assign enters = primitive_valid_i && primitive_ready_o;
  assign idle_o = under_way_q == UNDER_WAY'(ends_q) && visits_are_done && framebuffer_idle && port_idle && lines_are_done;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      under_way_q <= '0;
      ends_q      <= 1'b0;
    end else begin
      under_way_q <= under_way_q + UNDER_WAY'(enters) - UNDER_WAY'(ends_q) - UNDER_WAY'(is_dropped);
      ends_q      <= fragment_valid && fragment_accepted && fragment_data.ends_primitive;
    end
  end
  performance_counters u_counters (
      .clk_i,
      .rst_ni,
      .is_primitive_i  (is_primitive),
      .is_zero_area_i  (is_zero_area),
      .is_backface_i   (is_backface),
      .is_empty_i      (is_empty),
      .is_no_sample_i  (is_no_sample),
      .is_visited_i    (is_visited),
      .is_outside_i    (is_outside),
      .is_accepted_i   (is_accepted),
      .is_hiz_i        (is_hiz),
      .samples_tested_i(samples_tested),
      .covered_i       (covered),
      .passed_i        (passed),
      .written_i       (written),
      .killed_i        (killed),
      .fill_i          (is_fill),
      .evict_i         (is_evict),
      .clear_i         (is_clear),
      .texture_use_i   (texture_use),
      .hold_i          (counters_hold_i),
      .counters_o
  );

endmodule
