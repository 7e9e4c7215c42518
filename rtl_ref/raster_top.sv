// The raster pipeline: snapped primitives in, tiles of depth and colour in memory out.
//
//   cull -> triangle_setup -> coarse_raster -> fine_raster -> interpolate -> primitive_join -> depth_test -> framebuffer
//                                 ^                                   line_raster ^              |              ^ v
//                                 '-- the retirement of tile visits (HiZ) <----------------------'          memory_port
//                                                                                                               ^ v
//                                                                                                             memory
//
// With a texture unit, which stands inside the framebuffer of blocks, a second memory answers it.
//
// Every arrow that waits is a stream: a packet moves when valid and ready are both high. Bit raster_pkg::STALL_X of stall_i holds
// arrow X back for a cycle, for tests; hardware ties it to 0. The packets are X_data, X_valid, X_ready: so cosim/taps.svh
// finds them. Nothing in here depends on when packets come, only on what they say.
// docs/pipeline.md says what each stage takes and how long; the host must clear depth and colour once before it draws.
module raster_top (
    input logic clk_i,
    /* verilator lint_off SYNCASYNCNET */  // memory_port recovers from it
    input logic rst_ni,       // at any time, for a cycle at least
    /* verilator lint_on SYNCASYNCNET */
    input logic power_on_ni,  // with it when power comes: what memory was asked for before is forgotten

    /* verilator lint_off UNUSEDSIGNAL */  // without the unit of lines
    input logic [raster_pkg::STALL_BITS-1:0] stall_i,
    /* verilator lint_on UNUSEDSIGNAL */

    // From the host
    input  logic                          primitive_valid_i,
    output logic                          primitive_ready_o,
    input  raster_pkg::primitive_packet_t primitive_i,

    // From the host: the lines, in the order of the primitives of kind line that hold their places
    /* verilator lint_off UNUSEDSIGNAL */  // without the unit
    input  logic                    line_valid_i,
    output logic                    line_ready_o,
    input  raster_pkg::line_setup_t line_i,
    /* verilator lint_on UNUSEDSIGNAL */

    // To memory: bursts of beats. Each beat that was read is answered, and each burst that was written, in order
    input  raster_pkg::memory_layout_t layout_i,  // from the host; stays as it is while anything is under way
    output logic                       beat_valid_o,
    input  logic                       beat_ready_i,
    output raster_pkg::memory_beat_t   beat_o,
    input  logic                       answer_valid_i,
    output logic                       answer_ready_o,
    input  raster_pkg::memory_answer_t answer_i,

    // To the memory of textures: reads of lines, answered beat by beat in their order
    /* verilator lint_off UNUSEDSIGNAL */  // without a texture unit
    output logic                         texture_valid_o,
    input  logic                         texture_ready_i,
    output raster_pkg::texture_request_t texture_o,
    input  logic                         texel_valid_i,
    output logic                         texel_ready_o,
    input  raster_pkg::texel_beat_t      texel_i,
    /* verilator lint_on UNUSEDSIGNAL */

    // The counters of one cycle: while hold is high they stay, to be read word by word, and counting goes on
    input  logic                        counters_hold_i,
    output raster_pkg::counter_packet_t counters_o,
    // Nothing is under way: every primitive of the cycles before has been drawn, and memory has answered everything. What was
    // drawn may lie on the chip alone; after a flush all of it is in memory.
    output logic                        idle_o
);

  localparam int COUNTER = raster_pkg::COUNTER_BITS;
  localparam int COUNT = $clog2(raster_pkg::SAMPLES + 1);

  // The streams, as the consumer sees them.
  logic triangle_valid, triangle_ready, setup_valid, setup_ready, tile_valid, tile_ready;
  logic stamp_valid, stamp_ready, fragment_valid, fragment_ready;
  /* verilator lint_off UNUSEDSIGNAL */  // for the taps of the co-simulation where there is no unit of lines
  logic line_pixel_valid, line_pixel_ready;
  raster_pkg::line_pixel_t      line_pixel_data;
  /* verilator lint_on UNUSEDSIGNAL */
  raster_pkg::triangle_packet_t triangle_data;
  raster_pkg::setup_packet_t    setup_data;
  /* verilator lint_off UNUSEDSIGNAL */  // serial stages have its steps in another way
  raster_pkg::context_packet_t  context_data;
  /* verilator lint_on UNUSEDSIGNAL */
  raster_pkg::tile_packet_t     tile_data;
  raster_pkg::edge_context_t    edges_data;
  logic [3*raster_pkg::TILE_EDGE_BITS-1:0] visit_edges;
  raster_pkg::stamp_packet_t    stamp_data;
  raster_pkg::fragment_packet_t fragment;  // without the constants of its triangle where they are apart
  /* verilator lint_off UNUSEDSIGNAL */    // for the co-simulation
  raster_pkg::fragment_packet_t fragment_data;
  /* verilator lint_on UNUSEDSIGNAL */
  raster_pkg::memory_request_t      request;  // of the cache of blocks without its data
  /* verilator lint_off UNUSEDSIGNAL */  // for the co-simulation
  raster_pkg::memory_request_t      request_data;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [8*raster_pkg::REQUEST_BYTES-1:0] request_bytes;  // its data as they lie in memory
  raster_pkg::memory_response_t     response_data;
  logic                             request_valid, request_ready, response_valid, response_ready;
  logic                             write_valid, retire_valid;
  raster_pkg::write_packet_t    write_data;
  raster_pkg::retire_packet_t   retire_data;

  // The same at the producer, before a stall.
  logic primitive_ready, triangle_offered, setup_offered, tile_offered, stamp_offered, fragment_offered;
  logic request_offered, response_offered, beat_offered, answer_ready;
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

  logic is_primitive, is_zero_area, is_backface, is_empty, is_no_sample, is_dropped;
  logic [raster_pkg::SLOT_BITS-1:0] context_slot, read_slot;
  logic                             slot_free;
  logic is_visited, is_outside, is_accepted, is_hiz, visits_are_done;
  logic [2*raster_pkg::TILE_SHIFT+$clog2(raster_pkg::MSAA_SAMPLES):0] samples_tested;
  logic                              context_read;
  raster_pkg::context_packet_t   stamp_context;
  /* verilator lint_off UNUSEDSIGNAL */  // with pipelined stages
  logic [raster_pkg::ALL_LOCAL_BITS-1:0] context_step;
  /* verilator lint_on UNUSEDSIGNAL */

  logic shaded_valid, shaded_ready;  // what interpolate sends
  raster_pkg::fragment_packet_t shaded_data;
  logic                             lines_are_done;  // none is in the unit

  // The stages up to the fragments: with a packet in every step, or those for the smallest parts, which look at a packet
  // until they are through with it and do one thing at a time. The ports are the same.
`define RASTER_FRONT(CULL, TRIANGLE_SETUP, COARSE_RASTER, FINE_RASTER, INTERPOLATE) \
    CULL u_cull (                                                                       \
        .clk_i,                                                                         \
        .rst_ni,                                                                        \
        .primitive_valid_i(primitive_valid_i && !stall_i[raster_pkg::STALL_PRIMITIVE]), \
        .primitive_ready_o(primitive_ready),                                            \
        .primitive_i,                                                                   \
        .triangle_valid_o (triangle_offered),                                           \
        .triangle_ready_i (triangle_ready),                                             \
        .triangle_o       (triangle_data),                                              \
        .is_primitive_o   (is_primitive),                                               \
        .is_zero_area_o   (is_zero_area),                                               \
        .is_backface_o    (is_backface),                                                \
        .is_empty_o       (is_empty),                                                   \
        .is_no_sample_o   (is_no_sample),                                               \
        .is_dropped_o     (is_dropped)                                                  \
    );                                                                                  \
    TRIANGLE_SETUP u_triangle_setup (                                                   \
        .clk_i,                                                                         \
        .rst_ni,                                                                        \
        .triangle_valid_i(triangle_valid),                                              \
        .triangle_ready_o(triangle_accepted),                                           \
        .triangle_i      (triangle_data),                                               \
        .setup_valid_o   (setup_offered),                                               \
        .setup_ready_i   (setup_ready),                                                 \
        .setup_o         (setup_data)                                                   \
    );                                                                                  \
    COARSE_RASTER u_coarse_raster (                                                     \
        .clk_i,                                                                         \
        .rst_ni,                                                                        \
        .setup_valid_i   (setup_valid),                                                 \
        .setup_ready_o   (setup_accepted),                                              \
        .setup_i         (setup_data),                                                  \
        .context_slot_o  (context_slot),                                                \
        .context_o       (context_data),                                                \
        .context_step_o  (context_step),                                                \
        .slot_free_i     (slot_free),                                                   \
        .tile_valid_o    (tile_offered),                                                \
        .tile_ready_i    (tile_ready),                                                  \
        .tile_o          (tile_data),                                                   \
        .edges_o         (edges_data),                                                  \
        .visit_edges_o   (visit_edges),                                                 \
        .retire_valid_i  (retire_valid),                                                \
        .retire_i        (retire_data),                                                 \
        .is_visited_o    (is_visited),                                                  \
        .is_outside_o    (is_outside),                                                  \
        .is_accepted_o   (is_accepted),                                                 \
        .is_hiz_o        (is_hiz),                                                      \
        .samples_tested_o(samples_tested),                                              \
        .visits_are_done_o(visits_are_done)                                             \
    );                                                                                  \
    FINE_RASTER u_fine_raster (                                                         \
        .clk_i,                                                                         \
        .rst_ni,                                                                        \
        .tile_valid_i (tile_valid),                                                     \
        .tile_ready_o (tile_accepted),                                                  \
        .tile_i       (tile_data),                                                      \
        .edges_i      (edges_data),                                                     \
        .visit_edges_i(visit_edges),                                                    \
        .stamp_valid_o(stamp_offered),                                                  \
        .stamp_ready_i(stamp_ready),                                                    \
        .stamp_o      (stamp_data)                                                      \
    );                                                                                  \
    INTERPOLATE u_interpolate (                                                         \
        .clk_i,                                                                         \
        .rst_ni,                                                                        \
        .stamp_valid_i   (stamp_valid),                                                 \
        .stamp_ready_o   (stamp_accepted),                                              \
        .stamp_i         (stamp_data),                                                  \
        .context_read_o  (context_read),                                                \
        .context_slot_o  (read_slot),                                                   \
        .context_i       (stamp_context),                                               \
        .slot_free_o     (slot_free),                                                   \
        .fragment_valid_o(shaded_valid),                                                \
        .fragment_ready_i(shaded_ready),                                                \
        .fragment_o      (shaded_data)                                                  \
    );

  generate
    if (raster_pkg::SETUP_KIND == 0) begin : gen_pipelined
      `RASTER_FRONT(cull, triangle_setup, coarse_raster, fine_raster, interpolate)
    end else begin : gen_serial
      `RASTER_FRONT(cull_serial, triangle_setup_serial, coarse_raster_serial, fine_raster_serial, interpolate_serial)
    end
  endgenerate

  // Lines: drawn beside all that, joined where their pixels are tested.
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
          .fragment_o      (fragment)
      );
    end else begin : gen_no_lines
      assign line_ready_o     = 1'b0;
      assign line_pixel_valid = 1'b0;
      assign line_pixel_ready = 1'b0;
      assign line_pixel_data  = '0;
      assign lines_are_done   = 1'b1;
      assign fragment_offered = shaded_valid;
      assign shaded_ready     = fragment_ready;
      assign fragment         = shaded_data;
    end
  endgenerate

  // The constants of a primitive: a word, or a word for each step, written one after the other. A slot is not written before
  // it is free, nor read before the first stamp is there.
  logic writes_context;
  assign writes_context = setup_valid && setup_accepted;

  // With planes over w and one sample a pixel, what a triangle's fragments share lies apart from them until they are tested:
  // the steps of those planes, and the frame of coordinates, by a number that goes along. Only then are those planes moved to
  // the pixels. There are as many numbers as triangles can be between setup and test: those in slots of contexts, and one for
  // each fragment behind that, since a triangle's end goes as one.
  localparam bit APART = raster_pkg::COORDINATES != 0 && raster_pkg::MSAA_SAMPLES == 1;
  localparam int NUMBER = $clog2(raster_pkg::CONTEXT_SLOTS + raster_pkg::CACHE_QUEUE + 16);
  /* verilator lint_off UNUSEDSIGNAL */  // without such planes
  logic [NUMBER-1:0]           number_q;  // of the next triangle
  raster_pkg::context_packet_t tested_context;
  /* verilator lint_on UNUSEDSIGNAL */
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) number_q <= '0;
    else if (APART) number_q <= number_q + NUMBER'(writes_context);
  end
  generate
    if (raster_pkg::SETUP_KIND == 0) begin : gen_context
      // The range is wanted for colours over w alone: no other code is clamped. Of constants that are apart there is a number.
      localparam int FRAME = APART ? NUMBER : raster_pkg::COORDINATE_FRAME_BITS;
      localparam int RANGE = 2 * raster_pkg::ALL_AFFINE_CODE_BITS;
      localparam int STEPS = raster_pkg::ALL_STEP_BITS;
      localparam int KEPT_STEPS = APART ? raster_pkg::STEP_AT[32*(APART ? raster_pkg::AFFINE_PLANES : 0)+:32] : STEPS;
      localparam int HEAD = raster_pkg::CONTEXT_PACKET_BITS - RANGE - raster_pkg::COORDINATE_FRAME_BITS -
                            2 * (STEPS - KEPT_STEPS);  // state and steps
      localparam int KEPT = raster_pkg::COLORS_OVER_W != 0 ? RANGE : 0;  // of the range
      logic [HEAD+KEPT+FRAME-1:0] entering, kept;
      sram #(
          .WIDTH(HEAD + KEPT + FRAME),
          .DEPTH(raster_pkg::CONTEXT_SLOTS),
          .READS_OLD(0)
      ) u_context (
          .clk_i,
          .read_i         (context_read),
          .read_address_i (read_slot),
          .data_o         (kept),
          .write_i        (writes_context),
          .write_address_i(context_slot),
          .data_i         (entering)
      );
      logic [KEPT_STEPS-1:0] step_x, step_y;
      assign entering[KEPT+FRAME+:HEAD] = {context_data.state, context_data.step_x[0+:KEPT_STEPS],
                                           context_data.step_y[0+:KEPT_STEPS]};
      assign {stamp_context.state, step_x, step_y} = kept[KEPT+FRAME+:HEAD];
      assign stamp_context.step_x = STEPS'(step_x);
      assign stamp_context.step_y = STEPS'(step_y);
      if (KEPT != 0) begin : gen_range
        assign entering[FRAME+:KEPT] = context_data.range;
        assign stamp_context.range   = kept[FRAME+:KEPT];
      end else begin : gen_no_range
        assign stamp_context.range = '0;
      end
      if (APART) begin : gen_number
        assign entering[0+:FRAME]        = number_q;
        assign stamp_context.coordinates = raster_pkg::COORDINATE_FRAME_BITS'(kept[0+:FRAME]);
      end else if (FRAME != 0) begin : gen_frame
        assign entering[0+:FRAME]        = context_data.coordinates;
        assign stamp_context.coordinates = kept[0+:FRAME];
      end
    end else begin : gen_contexts
      localparam int STEP = raster_pkg::ALL_LOCAL_BITS;
      localparam int REST = raster_pkg::CONTEXT_PACKET_BITS - 2 * STEP;
      logic            writes_step_x_q, writes_step_y_q;
      logic [STEP-1:0] step_x, step_y;
      logic [REST-1:0] rest;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          writes_step_x_q <= 1'b0;
          writes_step_y_q <= 1'b0;
        end else begin
          writes_step_x_q <= writes_context;
          writes_step_y_q <= writes_step_x_q;
        end
      end
      sram #(
          .WIDTH    (STEP),
          .DEPTH    (raster_pkg::CONTEXT_SLOTS),
          .READS_OLD(0),
          .BLOCK    (1)
      ) u_step_x (
          .clk_i,
          .read_i         (context_read),
          .read_address_i (read_slot),
          .data_o         (step_x),
          .write_i        (writes_step_x_q),
          .write_address_i(context_slot),
          .data_i         (context_step)
      );
      sram #(
          .WIDTH    (STEP),
          .DEPTH    (raster_pkg::CONTEXT_SLOTS),
          .READS_OLD(0),
          .BLOCK    (1)
      ) u_step_y (
          .clk_i,
          .read_i         (context_read),
          .read_address_i (read_slot),
          .data_o         (step_y),
          .write_i        (writes_step_y_q),
          .write_address_i(context_slot),
          .data_i         (context_step)
      );
      sram #(
          .WIDTH    (REST),
          .DEPTH    (raster_pkg::CONTEXT_SLOTS),
          .READS_OLD(0),
          .BLOCK    (1)
      ) u_rest (
          .clk_i,
          .read_i         (context_read),
          .read_address_i (read_slot),
          .data_o         (rest),
          .write_i        (writes_context),
          .write_address_i(context_slot),
          .data_i         ({context_data.range, context_data.state})
      );
      assign stamp_context.step_x = step_x;
      assign stamp_context.step_y = step_y;
      assign {stamp_context.range, stamp_context.state} = rest;
    end
  endgenerate

  // The test, and what is behind it: whole tiles, looked up when they are tested; or blocks, looked up before.
  logic                             tested_valid, tested_ready;
  raster_pkg::fragment_packet_t tested;
  /* verilator lint_off UNUSEDSIGNAL */  // blocks take no accesses
  logic                                                       access_valid;
  raster_pkg::fragment_packet_t                           access;
  logic [raster_pkg::STORED_COLOR_BITS-1:0]                   access_color;
  logic                                                       moves_tiles;  // for the co-simulation
  /* verilator lint_on UNUSEDSIGNAL */
  logic                                                       access_ready;
  logic [raster_pkg::SAMPLES*raster_pkg::STORED_DEPTH_BITS-1:0] stored_depth;
  /* verilator lint_off UNUSEDSIGNAL */  // with tiles
  logic [raster_pkg::SAMPLES*raster_pkg::STORED_DEPTH_BITS-1:0] word;
  /* verilator lint_on UNUSEDSIGNAL */
  raster_pkg::write_packet_t tested_write;
  logic [COUNT-1:0]                                           covered, passed, written, killed, tested_written, tested_killed;
  logic [1:0]                                                 fill, evict, clear;
  /* verilator lint_off UNUSEDSIGNAL */  // without the unit of counters, or of textures
  logic [6:0]                                                 texture_use;
  logic [8:0]                                                 texture_use_q;
  /* verilator lint_on UNUSEDSIGNAL */
  /* verilator lint_off UNUSEDSIGNAL */  // for the co-simulation
  logic                                                       color_valid, color_ready;
  raster_pkg::color_packet_t                                  color_data;
  /* verilator lint_on UNUSEDSIGNAL */
  logic                                                       texture_offered, texel_accepted;
  assign texture_valid_o = texture_offered && !stall_i[raster_pkg::STALL_TEXTURE];
  assign texel_ready_o   = texel_accepted && !stall_i[raster_pkg::STALL_TEXEL];
  logic                                                       framebuffer_idle, port_idle;
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
      .write_valid_o   (write_valid),
      .write_o         (tested_write),
      .word_o          (word),
      .retire_valid_o  (retire_valid),
      .retire_o        (retire_data),
      .covered_o       (covered),
      .passed_o        (passed),
      .written_o       (tested_written),
      .killed_o        (tested_killed)
  );

  generate
    if (APART) begin : gen_apart
      localparam int FRAME = raster_pkg::COORDINATE_FRAME_BITS;
      localparam int AT = raster_pkg::STEP_AT[32*raster_pkg::AFFINE_PLANES+:32];
      localparam int STEP = raster_pkg::ALL_STEP_BITS - AT;
      localparam int CODES = raster_pkg::ALL_FRAGMENT_BITS;
      localparam int AFFINE = raster_pkg::ALL_AFFINE_CODE_BITS;
      logic [2*STEP+FRAME-1:0] entering, constants;
      assign entering = {context_data.step_y[AT+:STEP], context_data.step_x[AT+:STEP], context_data.coordinates};
      sram #(
          .WIDTH    (2 * STEP + FRAME),
          .DEPTH    (1 << NUMBER),
          .READS_OLD(0),
          .BLOCK    (1)
      ) u_constants (
          .clk_i,
          .read_i         (tested_valid),
          .read_address_i (NUMBER'(tested.coordinates)),
          .data_o         (constants),
          .write_i        (writes_context),
          .write_address_i(number_q),
          .data_i         (entering)
      );
      always_comb begin
        tested_context             = '0;
        tested_context.coordinates = constants[0+:FRAME];
        tested_context.step_x      = raster_pkg::ALL_STEP_BITS'(constants[FRAME+:STEP]) << AT;
        tested_context.step_y      = raster_pkg::ALL_STEP_BITS'(constants[FRAME+STEP+:STEP]) << AT;
      end

      // For the co-simulation the packet as it is specified: whole, and of lines nothing behind the colours.
      raster_pkg::context_packet_t  contexts_q[0:(1<<NUMBER)-1];
      raster_pkg::context_packet_t  fragment_context;
      raster_pkg::fragment_packet_t whole;
      always_ff @(posedge clk_i) if (writes_context) contexts_q[number_q] <= context_data;
      assign fragment_context = contexts_q[NUMBER'(fragment.coordinates)];
      whole_fragment #(
          .APART(1)
      ) u_whole (
          .fragment_i(fragment),
          .context_i (fragment_context),
          .fragment_o(whole)
      );
      always_comb begin
        fragment_data = whole;
        for (int i = 0; i < raster_pkg::PIXELS; i++)
          if (fragment.kind == raster_pkg::PRIMITIVE_KIND_LINE)
            fragment_data.code[i*CODES+AFFINE+:CODES-AFFINE] = '0;
      end
    end else begin : gen_together
      assign tested_context = '0;
      assign fragment_data  = fragment;
    end
  endgenerate

  // The packet as it is specified: words where they are written.
  localparam int WORD = raster_pkg::STORED_DEPTH_BITS;
  always_comb begin
    write_data = tested_write;
    for (int s = 0; s < raster_pkg::SAMPLES; s++)
      if (tested_write.write_depth[s]) write_data.depth[s*WORD+:WORD] = word[s*WORD+:WORD];
  end

  generate
    if (raster_pkg::CACHE_KIND == 0) begin : gen_tiles
      assign tested_valid      = fragment_valid;
      assign fragment_accepted = tested_ready;
      assign tested            = fragment;

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
          .request_o       (request),
          .response_valid_i(response_valid),
          .response_ready_o(response_accepted),
          .response_i      (response_data),
          .fill_o          (fill),
          .evict_o         (evict),
          .clear_o         (clear),
          .moves_tiles_o   (moves_tiles),
          .idle_o          (framebuffer_idle)
      );
      request_bytes u_request_bytes (
          .request_i(request),
          .bytes_o  (request_bytes)
      );
      assign request_data    = request;
      assign written         = tested_written;
      assign killed          = tested_killed;
      assign color_valid     = 1'b0;
      assign color_ready     = 1'b0;
      assign color_data      = '0;
      assign texture_offered = 1'b0;
      assign texture_o       = '0;
      assign texel_accepted  = 1'b0;
      assign texture_use     = '0;
    end else begin : gen_blocks
      assign access_ready = 1'b1;
      // Samples are counted where alpha is tested.
      localparam bit LATE = raster_pkg::ALPHA_UNIT != 0 && raster_pkg::COORDINATES != 0;
      logic [COUNT-1:0] late_written, late_killed;
      assign written = LATE ? late_written : tested_written;
      assign killed  = LATE ? late_killed : tested_killed;

      block_cache u_framebuffer (
          .clk_i,
          .power_on_ni,
          .rst_ni,
          .fragment_valid_i(fragment_valid),
          .fragment_ready_o(fragment_accepted),
          .fragment_i      (fragment),
          .tested_valid_o  (tested_valid),
          .tested_o        (tested),
          .stored_depth_o  (stored_depth),
          .context_i       (tested_context),
          .write_valid_i   (write_valid),
          .write_i         (write_data),
          .word_i          (word),
          .request_valid_o (request_offered),
          .request_ready_i (request_ready),
          .request_o       (request),
          .request_bytes_o (request_bytes),
          .response_valid_i(response_valid),
          .response_ready_o(response_accepted),
          .response_i      (response_data),
          .texture_valid_o (texture_offered),
          .texture_ready_i (texture_ready_i && !stall_i[raster_pkg::STALL_TEXTURE]),
          .texture_o,
          .texel_valid_i   (texel_valid_i && !stall_i[raster_pkg::STALL_TEXEL]),
          .texel_ready_o   (texel_accepted),
          .texel_i,
          .color_valid_o   (color_valid),
          .color_ready_o   (color_ready),
          .color_o         (color_data),
          .fill_o          (fill),
          .evict_o         (evict),
          .clear_o         (clear),
          .written_o       (late_written),
          .killed_o        (late_killed),
          .texture_use_o   (texture_use),
          .at_token_o      (moves_tiles),
          .idle_o          (framebuffer_idle)
      );

      logic [raster_pkg::SAMPLES*raster_pkg::MEMORY_LANE_BITS-1:0] request_lanes;
      request_lanes u_request_lanes (
          .plane_i(request.plane),
          .bytes_i(request_bytes),
          .data_o (request_lanes)
      );
      always_comb begin
        request_data      = request;
        request_data.data = request_lanes;
      end

      /* verilator lint_off UNUSEDSIGNAL */
      logic unused_tested_ready;
      assign unused_tested_ready = tested_ready;
      /* verilator lint_on UNUSEDSIGNAL */
    end
  endgenerate

  memory_port u_memory_port (
      .clk_i,
      .power_on_ni,
      .rst_ni,
      .layout_i,
      .request_valid_i    (request_valid),
      .request_ready_o    (request_accepted),
      .request_i          (request),
      .bytes_i            (request_bytes),
      .response_valid_o   (response_offered),
      .response_ready_i   (response_ready),
      .response_o         (response_data),
      .beat_valid_o       (beat_offered),
      .beat_ready_i       (beat_ready_i && !stall_i[raster_pkg::STALL_BEAT]),
      .beat_o,
      .answer_valid_i     (answer_valid_i && !stall_i[raster_pkg::STALL_ANSWER]),
      .answer_ready_o     (answer_ready),
      .answer_i,
      .idle_o             (port_idle)
  );

  // Primitives between the host and the end of their last stamp.
  localparam int UNDER_WAY = $clog2(raster_pkg::CONTEXT_SLOTS + 24);
  logic [UNDER_WAY-1:0] under_way_q;
  logic                 enters, ends;
  assign enters = primitive_valid_i && primitive_ready_o;
  assign ends   = fragment_valid && fragment_accepted && fragment.ends_primitive;
  assign idle_o = under_way_q == '0 && visits_are_done && framebuffer_idle && port_idle && lines_are_done;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) under_way_q <= '0;
    else under_way_q <= under_way_q + UNDER_WAY'(enters) - UNDER_WAY'(ends) - UNDER_WAY'(is_dropped);
  end

  // Performance counters: the work of triangles, points and lines, and the tile traffic of everything, since reset. What is
  // counted comes through a register; a counter whose highest bit falls has wrapped, and `overflow` stays. Without the
  // unit nothing moves, and nothing is left of it.
  localparam int COUNTERS = (raster_pkg::COUNTER_PACKET_BITS - 1) / COUNTER;
  raster_pkg::counter_packet_t counters_q, shown_q;
  logic [COUNTERS-1:0]         highest, highest_q;
  logic [1:0]                  fill_q, evict_q, clear_q;
  localparam int TEXTURE_AT = raster_pkg::COORDINATES != 0 && raster_pkg::ALPHA_UNIT != 0 ? COUNTER : 0;
  logic                        overflow_q;
  assign counters_o = shown_q;

  always_comb begin
    for (int i = 0; i < COUNTERS; i++) highest[i] = counters_q[i*COUNTER+COUNTER-1];
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      fill_q     <= '0;
      evict_q    <= '0;
      clear_q    <= '0;
      texture_use_q <= '0;
      highest_q  <= '0;
      overflow_q <= 1'b0;
      counters_q <= '0;
      shown_q    <= '0;
    end else if (raster_pkg::COUNTERS_UNIT != 0) begin
      fill_q     <= fill;
      evict_q    <= evict;
      clear_q    <= clear;
      texture_use_q <= 9'(texture_use);
      highest_q  <= highest;
      overflow_q <= overflow_q || (highest_q & ~highest) != '0;
      counters_q.primitives_in      <= counters_q.primitives_in + COUNTER'(is_primitive);
      counters_q.zero_area          <= counters_q.zero_area + COUNTER'(is_zero_area);
      counters_q.backface           <= counters_q.backface + COUNTER'(is_backface);
      counters_q.empty              <= counters_q.empty + COUNTER'(is_empty);
      if (raster_pkg::SETUP_KIND == 0) counters_q.no_sample <= counters_q.no_sample + COUNTER'(is_no_sample);
      counters_q.tiles_visited      <= counters_q.tiles_visited + COUNTER'(is_visited);
      counters_q.tiles_outside      <= counters_q.tiles_outside + COUNTER'(is_outside);
      counters_q.trivially_accepted <= counters_q.trivially_accepted + COUNTER'(is_accepted);
      counters_q.tiles_hiz          <= counters_q.tiles_hiz + COUNTER'(is_hiz);
      counters_q.samples_tested     <= counters_q.samples_tested + COUNTER'(samples_tested);
      counters_q.covered            <= counters_q.covered + COUNTER'(covered);
      counters_q.depth_passed       <= counters_q.depth_passed + COUNTER'(passed);
      counters_q.written            <= counters_q.written + COUNTER'(written);
      counters_q.tile_fills         <= counters_q.tile_fills + COUNTER'(fill_q);
      counters_q.tile_evictions     <= counters_q.tile_evictions + COUNTER'(evict_q);
      counters_q.tile_clears        <= counters_q.tile_clears + COUNTER'(clear_q);
      if (raster_pkg::ALPHA_UNIT != 0 && raster_pkg::CACHE_KIND == 1 && raster_pkg::SETUP_KIND == 0)
        counters_q[COUNTER-1:0] <= counters_q[COUNTER-1:0] + COUNTER'(killed);  // the last is alpha_killed
      if (raster_pkg::COORDINATES != 0)  // in front of that texture_samples, texture_hits, texture_fills
        for (int i = 0; i < 3; i++)
          counters_q[TEXTURE_AT+(2-i)*COUNTER+:COUNTER] <= counters_q[TEXTURE_AT+(2-i)*COUNTER+:COUNTER] +
                                                           COUNTER'(texture_use_q[3*i+:3]);
      if (!counters_hold_i) begin
        shown_q          <= counters_q;
        shown_q.overflow <= overflow_q;
      end
    end
  end

endmodule
