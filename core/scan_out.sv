// Scan-out: reads the colour buffer ahead of the display and gives one pixel a clock as AXI4-Stream video.
//
// A band is a row of blocks (4 lines; with cache.kind tiles a row of tiles). Two bands lie in block RAM as they lie in
// memory: one is filled while the other is shown. Memory is read in units: the blocks that a tile has in the band,
// which
// are consecutive, or single blocks where they can have one colour a pixel. A unit whose blocks are all cleared is not
// read; where samples are stored, their mean enters the buffer. Up to AHEAD units are asked for before they are
// answered.
//
// The registers are sampled in the cycle of vblank_o, after the last pixel of a frame was taken; so a frame is never
// torn, and from then on the earlier buffer is not read. Blanking is the time in which the display takes nothing
// (tready), or BLANK cycles. Layout: docs/memory.md; the same in C: driver/detile.c.
module scan_out #(
    parameter int FLAGS = raster_pkg::FRAME_CLEARS == 1 ? 1 : 0,  // 1: frame.clears flags: cleared blocks have a flag
    parameter int WIDEST = raster_pkg::TARGET_WIDTH,  // pixels of a line at most: the size of the buffers
    parameter int BURST = 16,                         // beats of a burst at most; a power of two
    parameter int AHEAD = 16,                         // units under way at most; a power of two
    parameter int BLANK = 0,                          // cycles from vblank_o to the first read at least
    parameter int PORT = raster_pkg::MEMORY_PORT_BITS // derived; not to be set
) (
    input logic clk_i,
    input logic rst_ni,

    // Registers, sampled in the cycle of vblank_o
    input logic                                     enable_i,
    input logic [                             31:0] color_base_i,
    input logic [                             31:0] color_flags_base_i,  // with FLAGS or compress.unit
    input logic [                             31:0] row_stride_i,
    input logic [raster_pkg::STORED_COLOR_BITS-1:0] clear_color_i,       // of the last fast clear; with FLAGS
    input logic [     raster_pkg::PIXEL_X_BITS-1:0] last_x_i,            // width - 1
    input logic [     raster_pkg::PIXEL_Y_BITS-1:0] last_y_i,            // height - 1

    // Status
    output logic vblank_o,    // a pulse: the next frame begins
    output logic idle_o,      // no frame is shown: enable_i is low
    output logic underrun_o,  // sticky: the display waited for a pixel inside a frame
    output logic error_o,     // a pulse: memory answered with an error; its data are shown
    input  logic clear_underrun_i,

    // Reads, answered in order
    output logic            scan_arvalid,
    input  logic            scan_arready,
    output logic [    31:0] scan_araddr,
    output logic [     7:0] scan_arlen,    // beats - 1
    input  logic            scan_rvalid,
    output logic            scan_rready,
    input  logic [PORT-1:0] scan_rdata,
    input  logic            scan_rerror,

    // Video
    output logic        m_axis_video_tvalid,
    input  logic        m_axis_video_tready,
    output logic [23:0] m_axis_video_tdata,   // red in bits 23...16, green, blue
    output logic        m_axis_video_tlast,   // the last pixel of a line
    output logic        m_axis_video_tuser    // the first pixel of a frame
);

  // The layout. All are powers of two but TILES.
  localparam bit COMPRESS = raster_pkg::COMPRESS_UNIT != 0;
  localparam int COLOR = raster_pkg::STORED_COLOR_BITS;
  localparam int N = raster_pkg::MEMORY_COLORS / raster_pkg::PIXELS;          // colours of a pixel in memory
  localparam int SIDE = raster_pkg::BLOCK_SIDE * raster_pkg::STAMP_SIZE;      // pixels along a block; lines of a band
  localparam int PER_TILE = raster_pkg::BLOCKS_PER_ROW;              // blocks of a tile in a band, bands of a tile
  localparam int UNITS = COMPRESS ? PER_TILE : 1;                             // of a tile in a band
  localparam int UNIT_BLOCKS = PER_TILE / UNITS;
  localparam int UNIT_PIXELS = UNIT_BLOCKS * SIDE * SIDE;
  localparam int UNIT_BEATS = (UNIT_PIXELS * N * COLOR <= PORT) ? 1 : UNIT_PIXELS * N * COLOR / PORT;
  localparam int PIXEL_BEATS = (UNIT_PIXELS * COLOR <= PORT) ? 1 : UNIT_PIXELS * COLOR / PORT;  // one colour a pixel
  localparam int FULL_BURST = UNIT_BEATS < BURST ? UNIT_BEATS : BURST;
  localparam int PIXEL_BURST = PIXEL_BEATS < BURST ? PIXEL_BEATS : BURST;
  localparam int UNIT_SHIFT = $clog2(UNIT_PIXELS * N * COLOR / 8);            // log2 of the bytes
  localparam int PORT_SHIFT = raster_pkg::PORT_SHIFT;
  localparam int PLANE = raster_pkg::PLANE_SHIFT;
  localparam int FLAG_ROW = raster_pkg::FLAG_ROW_SHIFT;
  localparam int TILE_PITCH = PLANE + 1;                    // log2 of the bytes
  localparam int TILES = (WIDEST - 1) / raster_pkg::TILE_SIZE + 1;
  localparam int FLAG_TILES = PORT / PER_TILE;                                // whose flags a beat has

  // A word of the buffer: the pixels of a beat if they have one colour each, at least one.
  localparam int WORD = (PORT < COLOR) ? 1 : (PORT / COLOR < UNIT_PIXELS) ? PORT / COLOR : UNIT_PIXELS;  // pixels
  localparam int UNIT_WORDS = UNIT_PIXELS / WORD;
  localparam int GATHER = (PORT < N * COLOR) ? N * COLOR / PORT : 1;          // beats of a pixel
  localparam int GATHER_PIXEL = (PORT < COLOR) ? COLOR / PORT : 1;            // the same with one colour a pixel
  // of a beat
  localparam int STEP = (PORT < 2 * N * COLOR) ? 1 : (PORT / (N * COLOR) < WORD) ? PORT / (N * COLOR) : WORD;
  localparam int WORD_BEATS = GATHER * (WORD / STEP);

  localparam int TILE = (TILES < 2) ? 1 : $clog2(TILES);
  localparam int UNIT = (UNITS < 2) ? 1 : $clog2(UNITS);
  localparam int BEAT = (UNIT_BEATS < 2) ? 1 : $clog2(UNIT_BEATS);
  localparam int INDEX = $clog2(UNITS * UNIT_WORDS);  // bits of a word's number in its tile and band
  localparam int ADDRESS = $clog2(2 * TILES * UNITS * UNIT_WORDS);
  localparam int FLAG_ADDRESS = $clog2(2 * TILES * UNITS);
  localparam int BAND = raster_pkg::PIXEL_Y_BITS - $clog2(SIDE);
  localparam int ITEM = TILE + UNIT + 4;

  // The frame.
  logic                              is_active_q;  // from the sampling of the registers to the last pixel
  logic [        31:TILE_PITCH]      stride_q;
  logic [                 31:0]      flags_base_q;
  logic [            COLOR-1:0]      clear_color_q;
  logic [raster_pkg::PIXEL_X_BITS-1:0] last_x_q;
  logic [raster_pkg::PIXEL_Y_BITS-1:0] last_y_q;
  logic                              may_fetch;    // blanking is over
  logic                              is_shown_q;   // the last pixel of the frame has been read from the buffer
  logic                              moves;        // a pixel may enter the output

  assign vblank_o = !is_active_q && enable_i;
  assign idle_o   = !is_active_q && !enable_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) is_active_q <= 1'b0;
    else is_active_q <= is_active_q ? !(is_shown_q && moves) : enable_i;
  end

  always_ff @(posedge clk_i) begin
    if (vblank_o) begin
      stride_q      <= row_stride_i[31:TILE_PITCH];
      flags_base_q  <= color_flags_base_i;
      clear_color_q <= clear_color_i;
      last_x_q      <= last_x_i;
      last_y_q      <= last_y_i;
    end
  end

  generate
    if (BLANK == 0) begin : gen_no_blank
      assign may_fetch = 1'b1;
    end else begin : gen_blank
      logic [$clog2(BLANK+1)-1:0] blank_q;
      assign may_fetch = blank_q == '0;
      always_ff @(posedge clk_i) begin
        if (vblank_o) blank_q <= $clog2(BLANK + 1)'(BLANK);
        else if (!may_fetch) blank_q <= blank_q - 1'b1;
      end
    end
  endgenerate

  // Requests.
  localparam logic [2:0] REST = 3'd0, START = 3'd1, CLEARED = 3'd2, PIXELS = 3'd3, WAIT = 3'd4, READ = 3'd5;
  logic [             2:0] state_q;
  logic [        BAND-1:0] band_q;
  logic [        TILE-1:0] tile_q;
  logic [        UNIT-1:0] unit_q;
  logic [        BEAT-1:0] sent_q;          // beats of the unit that were asked for
  logic                    asked_buffer_q;  // the buffer that requests are for
  logic [             1:0] is_used_q;       // buffers that are being filled or shown
  logic [31:PLANE] row_q; // the first tile of the row of tiles
  logic [31:TILE_PITCH]    at_tile;
  logic [            31:0] unit_address, flags_address, burst_address;
  logic [ UNIT_BLOCKS-1:0] unit_cleared;
  logic                    unit_of_pixels;  // one colour a pixel
  logic                    is_cleared, is_first, is_last_burst, is_last_tile, is_last_unit, is_last_band;
  logic                    asks_flags, asked, unit_ends, band_ends, has_flags;
  logic                    item_valid, item_ready, head_valid, head_taken;
  logic [        ITEM-1:0] item, head;

  assign is_first      = sent_q == '0;
  assign is_last_burst = unit_of_pixels ? sent_q == BEAT'(PIXEL_BEATS - PIXEL_BURST)
                                        : sent_q == BEAT'(UNIT_BEATS - FULL_BURST);
  assign is_last_tile  = tile_q == TILE'(32'(last_x_q) >> $clog2(raster_pkg::TILE_SIZE));
  assign is_last_unit  = is_last_tile && unit_q == UNIT'(UNITS - 1);
  assign is_last_band  = band_q == BAND'(32'(last_y_q) >> $clog2(SIDE));
  assign is_cleared    = FLAGS != 0 && &unit_cleared;
  assign asks_flags    = state_q == CLEARED || state_q == PIXELS;

  // A unit that is not read takes a cycle. Its item is sent only if it is the last one of the band.
  assign scan_arvalid = (asks_flags || (state_q == READ && !is_cleared)) && (item_ready || !(asks_flags || is_first));
  assign asked        = scan_arvalid && scan_arready;
  assign unit_ends    = state_q == READ && (is_cleared ? item_ready : asked && is_last_burst);
  assign band_ends    = unit_ends && is_last_unit;
  assign item_valid   = (asked && (asks_flags || is_first)) || (state_q == READ && is_cleared && is_last_unit);
  assign item         = {tile_q, unit_q, asks_flags, asks_flags ? state_q == PIXELS : unit_of_pixels,
                         !is_cleared || asks_flags, is_last_unit && !asks_flags};

  assign at_tile       = row_q[31:TILE_PITCH] + (32 - TILE_PITCH)'(tile_q);
  assign burst_address = 32'(sent_q) << PORT_SHIFT;
  assign unit_address  = {at_tile, row_q[PLANE], PLANE'(0)} | burst_address |
                         (32'(unit_q) << UNIT_SHIFT) |
                         ((32'(band_q) & 32'(PER_TILE - 1)) << (UNIT_SHIFT + $clog2(UNITS)));
  assign flags_address = {flags_base_q[31:FLAG_ROW] + (32 - FLAG_ROW)'(band_q),
                          FLAG_ROW'(0)} |
                         ((32'(tile_q) >> $clog2(FLAG_TILES)) << PORT_SHIFT) |
                         (state_q == PIXELS ? 32'd1 << (FLAG_ROW - 1) : 32'd0);
  assign scan_araddr   = asks_flags ? flags_address : unit_address;
  assign scan_arlen    = asks_flags ? 8'd0 : unit_of_pixels ? 8'(PIXEL_BURST - 1) : 8'(FULL_BURST - 1);

  // The first state that asks for flags.
  localparam logic [2:0] TO_FLAGS = FLAGS != 0 ? CLEARED : COMPRESS ? PIXELS : READ;
  logic begins_flags;  // the next tile is the first one of a beat of flags
  assign begins_flags = ((32'(tile_q) + 32'd1) & 32'(FLAG_TILES - 1)) == '0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q        <= REST;
      asked_buffer_q <= 1'b0;
    end else begin
      case (state_q)
        REST: if (vblank_o) state_q <= START;
        START: if (may_fetch && !is_used_q[asked_buffer_q]) state_q <= TO_FLAGS;
        CLEARED: if (asked) state_q <= COMPRESS ? PIXELS : WAIT;
        PIXELS: if (asked) state_q <= WAIT;
        WAIT: if (has_flags) state_q <= READ;
        default:
        if (band_ends) state_q <= is_last_band ? REST : START;
        else if (unit_ends && unit_q == UNIT'(UNITS - 1) && begins_flags) state_q <= TO_FLAGS;
      endcase
      asked_buffer_q <= asked_buffer_q ^ band_ends;
    end
  end

  always_ff @(posedge clk_i) begin
    if (vblank_o) begin
      row_q  <= color_base_i[31:PLANE];
      band_q <= '0;
    end else if (band_ends) begin
      band_q <= band_q + 1'b1;
      if ((32'(band_q) & 32'(PER_TILE - 1)) == 32'(PER_TILE - 1))
        row_q[31:TILE_PITCH] <= row_q[31:TILE_PITCH] + stride_q;
    end
    if (state_q == START) begin
      tile_q <= '0;
      unit_q <= '0;
      sent_q <= '0;
    end else if (unit_ends) begin
      sent_q <= '0;
      if (unit_q == UNIT'(UNITS - 1)) begin
        unit_q <= '0;
        tile_q <= tile_q + 1'b1;
      end else begin
        unit_q <= unit_q + 1'b1;
      end
    end else if (asked && !asks_flags) begin
      sent_q <= sent_q + (unit_of_pixels ? BEAT'(PIXEL_BURST) : BEAT'(FULL_BURST));
    end
  end

  // Requests in flight: an item for each unit or beat of flags, in order.
  fifo #(
      .WIDTH(ITEM),
      .DEPTH(AHEAD)
  ) u_items (
      .clk_i,
      .rst_ni,
      .valid_i(item_valid),
      .ready_o(item_ready),
      .data_i (item),
      .valid_o(head_valid),
      .ready_i(head_taken),
      .data_o (head)
  );

  // Answers.
  logic [TILE-1:0] head_tile;
  logic [UNIT-1:0] head_unit;
  logic [BEAT-1:0] beat_q;           // beats of the item that have arrived
  logic            head_is_flags, head_of_pixels, head_has_data, head_is_last, arrives, word_ends, filled_buffer_q;
  logic [     1:0] is_full_q;        // buffers that are filled
  logic            written;
  logic [ADDRESS-1:0] write_address, read_address;
  logic [WORD*COLOR-1:0] written_word, shown_word;

  assign {head_tile, head_unit, head_is_flags, head_of_pixels, head_has_data, head_is_last} = head;
  assign scan_rready = head_valid && head_has_data;
  assign arrives     = scan_rvalid && scan_rready;
  assign head_taken  = !head_has_data || (arrives && (head_is_flags ||
                       beat_q == (head_of_pixels ? BEAT'(PIXEL_BEATS - 1) : BEAT'(UNIT_BEATS - 1))));
  assign has_flags   = head_valid && head_taken && head_is_flags && head_of_pixels == COMPRESS;  // the last beat of flags
  assign error_o     = arrives && scan_rerror;
  assign word_ends   = head_of_pixels ? (32'(beat_q) & 32'(GATHER_PIXEL - 1)) == 32'(GATHER_PIXEL - 1)
                                      : (32'(beat_q) & 32'(WORD_BEATS - 1)) == 32'(WORD_BEATS - 1);
  assign written     = arrives && !head_is_flags && word_ends;
  assign write_address = (ADDRESS'(head_tile) << (INDEX + 1)) | (ADDRESS'(filled_buffer_q) << INDEX) |
                         (ADDRESS'(head_unit) << $clog2(UNIT_WORDS)) |
                         ADDRESS'(head_of_pixels ? 32'(beat_q) >> $clog2(GATHER_PIXEL)
                                                 : 32'(beat_q) >> $clog2(WORD_BEATS));

  logic fills, frees, starts;  // a buffer is full from now on, or free, or begins to be filled
  logic shown_buffer_q;
  function automatic [1:0] bit_of(input buffer);
    bit_of = {buffer, !buffer};
  endfunction
  logic [1:0] freed;
  assign starts = state_q == START && may_fetch;
  assign freed  = frees ? bit_of(shown_buffer_q) : 2'd0;
  assign fills = head_valid && head_taken && head_is_last;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      beat_q          <= '0;
      filled_buffer_q <= 1'b0;
      is_full_q       <= '0;
      is_used_q       <= '0;
    end else begin
      if (arrives) beat_q <= head_taken ? '0 : beat_q + 1'b1;
      filled_buffer_q <= filled_buffer_q ^ fills;
      is_full_q       <= (is_full_q | (fills ? bit_of(filled_buffer_q) : 2'd0)) & ~freed;
      is_used_q       <= (is_used_q | (starts ? bit_of(asked_buffer_q) : 2'd0)) & ~freed;
    end
  end

  // The beats of one pixel, the means of a beat's pixels, and the pixels of a word: the newest are the highest bits.
  localparam int RAW = (GATHER * PORT < STEP * N * COLOR) ? STEP * N * COLOR : GATHER * PORT;
  logic [RAW-1:0]        raw;
  logic [STEP*COLOR-1:0] mean;
  generate
    if (GATHER == 1) begin : gen_beat
      assign raw = scan_rdata;
    end else begin : gen_gather
      logic [(GATHER-1)*PORT-1:0] earlier_q;
      assign raw = {scan_rdata, earlier_q};
      always_ff @(posedge clk_i) if (arrives) earlier_q <= raw[GATHER*PORT-1:PORT];
    end
    if (N == 1) begin : gen_color
      assign mean = raw[STEP*COLOR-1:0];
    end else begin : gen_mean
      resolve #(
          .PIXELS(STEP)
      ) u_resolve (
          .color_i(raw[STEP*N*COLOR-1:0]),
          .color_o(mean)
      );
    end
    logic [WORD*COLOR-1:0] word;
    if (WORD == STEP) begin : gen_word
      assign word = mean;
    end else begin : gen_collect
      logic [(WORD-STEP)*COLOR-1:0] earlier_q;
      assign word = {mean, earlier_q};
      always_ff @(posedge clk_i)
        if (arrives && (32'(beat_q) & 32'(GATHER - 1)) == 32'(GATHER - 1)) earlier_q <= word[WORD*COLOR-1:STEP*COLOR];
    end
    if (COMPRESS) begin : gen_pixels
      assign written_word = head_of_pixels ? raw[(GATHER-GATHER_PIXEL)*PORT+:WORD*COLOR] : word;
    end else begin : gen_samples
      assign written_word = word;
    end
  endgenerate

  // Pixels.
  localparam int LANE = (WORD < 2) ? 1 : $clog2(WORD);
  localparam int BLOCK = (UNIT_BLOCKS < 2) ? 1 : $clog2(UNIT_BLOCKS);
  localparam int STAMP = raster_pkg::STAMP_SIZE;
  logic [raster_pkg::PIXEL_X_BITS-1:0] x_q;
  logic [raster_pkg::PIXEL_Y_BITS-1:0] y_q;
  logic                                is_valid_q, is_last_q, is_first_q, begun_q, underrun_q;
  logic                                has_pixel, shows, is_line_end, is_frame_end;
  logic [LANE-1:0]                     lane_q;
  logic [BLOCK-1:0]                    block_q;
  logic [31:0]                         x, y, p;  // in the tile, in the band, and the pixel's number there
  logic [COLOR-1:0]                    shown;

  sram #(
      .WIDTH    (WORD * COLOR),
      .DEPTH    (1 << ADDRESS),  // a power of two needs no multiplexer
      .READS_OLD(0),
      .BLOCK    (1)
  ) u_buffers (
      .clk_i,
      .read_i         (moves),
      .read_address_i (read_address),
      .data_o         (shown_word),
      .write_i        (written),
      .write_address_i(write_address),
      .data_i         (written_word)
  );

  // Flags of cleared blocks and of blocks with one colour a pixel: one beat; of cleared blocks, too, of both
  // bands.
  logic [UNIT_BLOCKS-1:0] shown_cleared;
  localparam int PLACE = (FLAG_TILES * UNITS < 2) ? 1 : $clog2(FLAG_TILES * UNITS);
  generate
    if (FLAGS != 0) begin : gen_cleared
      logic [PLACE-1:0] place;  // of the unit's flags in the beat
      assign place = PLACE'((32'(tile_q) << $clog2(UNITS)) | (UNITS == 1 ? 32'd0 : 32'(unit_q)));
      logic [PORT-1:0] flags_q;
      always_ff @(posedge clk_i) if (arrives && head_is_flags && !head_of_pixels) flags_q <= scan_rdata;
      assign unit_cleared = flags_q[(32'(place)*UNIT_BLOCKS)+:UNIT_BLOCKS];
      sram #(
          .WIDTH    (UNIT_BLOCKS),
          .DEPTH    (2 * TILES * UNITS),
          .READS_OLD(0),
          .BLOCK    (1)
      ) u_cleared (
          .clk_i,
          .read_i         (moves),
          .read_address_i ((FLAG_ADDRESS'(32'(x_q) >> $clog2(raster_pkg::TILE_SIZE)) << ($clog2(UNITS) + 1)) |
                           (FLAG_ADDRESS'(shown_buffer_q) << $clog2(UNITS)) |
                           (UNITS == 1 ? '0 : FLAG_ADDRESS'(p >> (2 * $clog2(SIDE))))),
          .data_o         (shown_cleared),
          .write_i        (unit_ends),
          .write_address_i((FLAG_ADDRESS'(tile_q) << ($clog2(UNITS) + 1)) |
                           (FLAG_ADDRESS'(asked_buffer_q) << $clog2(UNITS)) | FLAG_ADDRESS'(unit_q)),
          .data_i         (unit_cleared)
      );
    end else begin : gen_none_cleared
      assign unit_cleared  = '0;
      assign shown_cleared = '0;
    end
    if (COMPRESS) begin : gen_pixel_flags
      logic [PLACE-1:0] place;  // of the unit's flags in the beat
      assign place = PLACE'((32'(tile_q) << $clog2(UNITS)) | (UNITS == 1 ? 32'd0 : 32'(unit_q)));
      logic [PORT-1:0] flags_q;
      always_ff @(posedge clk_i) if (arrives && head_is_flags && head_of_pixels) flags_q <= scan_rdata;
      assign unit_of_pixels = flags_q[place];
    end else begin : gen_no_pixel_flags
      assign unit_of_pixels = 1'b0;
    end
  endgenerate

  assign x            = 32'(x_q) & 32'(raster_pkg::TILE_SIZE - 1);
  assign y            = 32'(y_q) & 32'(SIDE - 1);
  assign p            = ((x >> $clog2(SIDE)) << (2 * $clog2(SIDE))) |
                        ((y >> $clog2(STAMP)) << ($clog2(SIDE) + $clog2(STAMP))) |
                        (((x & 32'(SIDE - 1)) >> $clog2(STAMP)) << (2 * $clog2(STAMP))) |
                        ((y & 32'(STAMP - 1)) << $clog2(STAMP)) | (x & 32'(STAMP - 1));
  assign read_address = (ADDRESS'(32'(x_q) >> $clog2(raster_pkg::TILE_SIZE)) << (INDEX + 1)) |
                        (ADDRESS'(shown_buffer_q) << INDEX) | ADDRESS'(p >> $clog2(WORD));

  assign shows        = moves && has_pixel;
  assign moves        = !is_valid_q || m_axis_video_tready;
  assign has_pixel    = is_active_q && !is_shown_q && is_full_q[shown_buffer_q];
  assign is_line_end  = x_q == last_x_q;
  assign is_frame_end = is_line_end && y_q == last_y_q;
  assign frees        = shows && (is_frame_end || (is_line_end && &(y | ~(32'(SIDE - 1)))));

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      is_valid_q     <= 1'b0;
      is_shown_q     <= 1'b0;
      begun_q        <= 1'b0;
      underrun_q     <= 1'b0;
      shown_buffer_q <= 1'b0;
    end else begin
      if (moves) is_valid_q <= has_pixel;
      is_shown_q     <= is_active_q && (is_shown_q || (shows && is_frame_end));
      begun_q        <= is_active_q && !is_shown_q && (begun_q || shows);
      underrun_q     <= !clear_underrun_i && (underrun_q || (begun_q && !is_valid_q && m_axis_video_tready));
      shown_buffer_q <= shown_buffer_q ^ frees;
    end
  end

  always_ff @(posedge clk_i) begin
    if (vblank_o || (shows && is_line_end)) x_q <= '0;
    else if (shows) x_q <= x_q + 1'b1;
    if (vblank_o) y_q <= '0;
    else if (shows && is_line_end) y_q <= y_q + 1'b1;
    if (moves) begin
      is_last_q  <= is_line_end;
      is_first_q <= !begun_q;
      lane_q     <= LANE'(p & 32'(WORD - 1));
      block_q    <= BLOCK'(p >> (2 * $clog2(SIDE)));
    end
  end

  assign shown = (FLAGS != 0 && shown_cleared[UNIT_BLOCKS < 2 ? 0 : block_q]) ? clear_color_q
               : COLOR'(shown_word >> (32'(lane_q) * COLOR));
  assign underrun_o          = underrun_q;
  assign m_axis_video_tvalid = is_valid_q;
  assign m_axis_video_tlast  = is_last_q;
  assign m_axis_video_tuser  = is_first_q;
  generate
    if (raster_pkg::COLOR_FORMAT == 0) begin : gen_565  // narrow channels repeat their highest bits
      assign m_axis_video_tdata = {shown[15:11], shown[15:13], shown[10:5], shown[10:9], shown[4:0], shown[4:2]};
    end else begin : gen_8888
      assign m_axis_video_tdata = {shown[7:0], shown[15:8], shown[23:16]};
    end
  endgenerate

endmodule
