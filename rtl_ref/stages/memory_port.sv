// Memory port: turns the framebuffer's requests, one per stamp, into bursts of beats, and the answers of memory into
// stamps.
//
//   request -> address -> [word] -> beat          a word is a stamp, or several that share a beat
//   response <- [beats of a stamp] <- answer
//
// In: requests, in program order; a run of them is a burst, whose length the first request gives. Out: beats, each with
// its byte address and the number of beats left in its burst. A request waits a cycle in a register, which takes the
// next one in the cycle in which its last beat moves. Answers come in the order of the bursts: each beat that was read,
// and one word for each burst that was written. Bursts are counted, so idle_o means written, not taken.
//
// Reset: power_on_ni resets the port, rst_ni everything upstream of it at any time, for a cycle at least. A burst under
// way is then ended with beats that write nothing, and the answers that are still to come are dropped; only then
// requests are taken. Specification: model/stages/memory_port.hpp; the times are those of
// model/engines/cycle/port_timing.hpp.
module memory_port (
    input logic clk_i,
    input logic power_on_ni,
    input logic rst_ni,

    input raster_pkg::memory_layout_t layout_i,

    // From the framebuffer
    input  logic                        request_valid_i,
    output logic                        request_ready_o,
    input  raster_pkg::memory_request_t request_i,
    input  logic [8*raster_pkg::REQUEST_BYTES-1:0] bytes_i,  // its data, as they lie in memory (request_bytes)

    // To the framebuffer
    output logic                         response_valid_o,
    input  logic                         response_ready_i,
    output raster_pkg::memory_response_t response_o,

    // To memory
    output logic                     beat_valid_o,
    input  logic                     beat_ready_i,
    output raster_pkg::memory_beat_t beat_o,

    // From memory
    input  logic                       answer_valid_i,
    output logic                       answer_ready_o,
    input  raster_pkg::memory_answer_t answer_i,

    output logic idle_o,  // every request has been answered

    // A flush ends: all of its requests have been taken. Later, once for each, they and all before them are in memory.
    input  logic flush_ends_i,
    output logic flushed_o
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int LANE = raster_pkg::MEMORY_LANE_BITS;
  localparam int PORT = raster_pkg::PORT_SHIFT;
  localparam int BYTES = 1 << PORT;  // bytes of a beat
  localparam int HAS_BLOCKS = raster_pkg::CACHE_KIND;
  localparam int DEPTH_SHIFT = $clog2(SAMPLES * raster_pkg::DEPTH_SAMPLE_BYTES);  // log2 of the bytes of a stamp
  localparam int COLORS = raster_pkg::MEMORY_COLORS;  // colours of a stamp
  localparam int COLOR_SHIFT = $clog2(COLORS * raster_pkg::COLOR_SAMPLE_BYTES);
  localparam bit COMPRESSES = raster_pkg::COMPRESS_UNIT != 0;
  localparam int PIXEL_SHIFT = $clog2(raster_pkg::PIXELS * raster_pkg::COLOR_SAMPLE_BYTES);  // bytes of one colour per pixel
  localparam int FLAG_BYTES = raster_pkg::FLAG_WORD / 8;
  localparam int FLAG_SHIFT = $clog2(FLAG_BYTES);
  localparam int STAMP_SHIFT = (DEPTH_SHIFT > COLOR_SHIFT) ? DEPTH_SHIFT : COLOR_SHIFT;
  localparam int LARGEST = (FLAG_SHIFT > STAMP_SHIFT) ? FLAG_SHIFT : STAMP_SHIFT;
  localparam int WORD = 1 << ((LARGEST > PORT) ? LARGEST : PORT);  // bytes
  localparam int PLANE = raster_pkg::PLANE_SHIFT;
  localparam int TILE = PLANE + 1;
  localparam int ROW = raster_pkg::FLAG_ROW_SHIFT;
  localparam int LENGTH = raster_pkg::BURST_LENGTH_BITS;
  localparam int RUN = raster_pkg::RUN_BITS;
  localparam int ADDRESS = raster_pkg::ADDRESS_BITS;
  localparam int STRIDE = raster_pkg::ROW_STRIDE_BITS;

  // ---------------------------------------------------------------------------------------------------------- the way out
  // Where the stamp lies in its tile's buffer: block by block.
  localparam int ROW_BITS = $clog2(raster_pkg::STAMPS_PER_ROW);
  localparam int SIDE_BITS = $clog2(raster_pkg::BLOCK_SIDE);
  localparam int TILE_BITS = $clog2(raster_pkg::BLOCKS_PER_ROW);
  localparam logic [15:0] SIDE_MASK = 16'((1 << SIDE_BITS) - 1);
  logic [15:0] column, row, place;
  assign column = 16'(request_i.stamp) & 16'((1 << ROW_BITS) - 1);
  assign row    = 16'(request_i.stamp) >> ROW_BITS;
  assign place  = ((((row >> SIDE_BITS) << TILE_BITS) | (column >> SIDE_BITS)) << (2 * SIDE_BITS)) |
                  ((row & SIDE_MASK) << SIDE_BITS) | (column & SIDE_MASK);

  // The address: base, row of tiles, tile, stamp.
  logic                     is_color, is_flags, of_pixels;  // of_pixels: one colour per pixel, or flags of such blocks
  logic [ADDRESS-1:0]       address;
  logic [ADDRESS-PLANE-1:0] base, planes;  // buffers of tiles up to this one in its row
  logic [PLANE-1:0]         color_offset, offset;
  assign is_color = request_i.plane[0];
  assign is_flags = request_i.plane[1];
  assign base     = is_color ? layout_i.color_base[ADDRESS-1:PLANE] : layout_i.depth_base[ADDRESS-1:PLANE];
  assign planes   = base + (ADDRESS - PLANE)'({request_i.tile_x, 1'b0});
  generate
    if (COMPRESSES) begin : gen_pixel_offset
      localparam logic [15:0] IN_BLOCK = 16'((1 << (2 * SIDE_BITS)) - 1);
      assign of_pixels    = request_i.plane[2];  // from the start of the block in any case
      assign color_offset = (PLANE'(place & ~IN_BLOCK) << COLOR_SHIFT) |
                            (of_pixels ? PLANE'(place & IN_BLOCK) << PIXEL_SHIFT : PLANE'(place & IN_BLOCK) << COLOR_SHIFT);
    end else begin : gen_offset
      assign of_pixels    = 1'b0;
      assign color_offset = PLANE'(place) << COLOR_SHIFT;
    end
  endgenerate
  assign offset = is_color ? color_offset : PLANE'(place) << DEPTH_SHIFT;

  // The bytes, and their number of beats.
  logic [8*WORD-1:0] depth_word, color_word, flag_word, word, bytes;
  logic [WORD-1:0]   depth_strobe, color_strobe, flag_strobe, strobe;
  logic [7:0]        depth_more, color_more, flag_more, more;
  logic [LENGTH-1:0] depth_length, color_length, flag_length, length;
  logic              depth_ends, color_ends, flag_ends, ends;
  assign bytes = (8 * WORD)'(bytes_i);
  beat_bytes #(
      .SAMPLES     (SAMPLES),
      .SAMPLE_BYTES(raster_pkg::DEPTH_SAMPLE_BYTES),
      .WORD        (WORD)
  ) u_depth_bytes (
      .bytes_i (bytes),
      .strobe_i(request_i.strobe),
      .place_i (place),
      .run_i   (request_i.run),
      .word_o  (depth_word),
      .strobe_o(depth_strobe),
      .more_o  (depth_more),
      .length_o(depth_length),
      .ends_o  (depth_ends)
  );
  beat_bytes #(
      .SAMPLES     (COLORS),
      .SAMPLE_BYTES(raster_pkg::COLOR_SAMPLE_BYTES),
      .WORD        (WORD)
  ) u_color_bytes (
      .bytes_i (bytes),
      .strobe_i(request_i.strobe[COLORS-1:0]),
      .place_i (place),
      .run_i   (request_i.run),
      .word_o  (color_word),
      .strobe_o(color_strobe),
      .more_o  (color_more),
      .length_o(color_length),
      .ends_o  (color_ends)
  );
  logic [ADDRESS-ROW-1:0] flag_base, rows;  // rows of flags up to this one
  assign flag_base = is_color ? layout_i.color_flags_base[ADDRESS-1:ROW] : layout_i.depth_flags_base[ADDRESS-1:ROW];
  assign rows      = flag_base + ((ADDRESS - ROW)'(request_i.tile_y) << TILE_BITS) +
                     (ADDRESS - ROW)'(request_i.stamp);
  logic [ROW-1:0] flag_offset;
  assign flag_offset = ROW'(request_i.tile_x) << FLAG_SHIFT;
  assign address   = is_flags ? {rows, flag_offset | (ROW'(of_pixels) << (ROW - 1))} : {planes, offset};
  beat_bytes #(
      .SAMPLES     (1),
      .SAMPLE_BYTES(FLAG_BYTES),
      .WORD        (WORD)
  ) u_flag_bytes (
      .bytes_i (bytes),
      .strobe_i(request_i.is_write),
      .place_i (16'(request_i.tile_x)),
      .run_i   (request_i.run),
      .word_o  (flag_word),
      .strobe_o(flag_strobe),
      .more_o  (flag_more),
      .length_o(flag_length),
      .ends_o  (flag_ends)
  );
  logic [8*WORD-1:0] sample_word;
  logic [WORD-1:0]   sample_strobe;
  logic [7:0]        sample_more;
  logic [LENGTH-1:0] sample_length;
  logic              sample_ends;
  generate
    if (COMPRESSES) begin : gen_pixel_bytes
      logic [8*WORD-1:0] pixel_word;
      logic [WORD-1:0]   pixel_strobe;
      logic [7:0]        pixel_more;
      logic [LENGTH-1:0] pixel_length;
      logic              pixel_ends;
      beat_bytes #(
          .SAMPLES     (raster_pkg::PIXELS),
          .SAMPLE_BYTES(raster_pkg::COLOR_SAMPLE_BYTES),
          .WORD        (WORD)
      ) u_pixel_bytes (
          .bytes_i (bytes),
          .strobe_i(request_i.strobe[raster_pkg::PIXELS-1:0]),
          .place_i (16'(offset) >> PIXEL_SHIFT),
          .run_i   (request_i.run),
          .word_o  (pixel_word),
          .strobe_o(pixel_strobe),
          .more_o  (pixel_more),
          .length_o(pixel_length),
          .ends_o  (pixel_ends)
      );
      assign sample_word   = of_pixels ? pixel_word : color_word;
      assign sample_strobe = of_pixels ? pixel_strobe : color_strobe;
      assign sample_more   = of_pixels ? pixel_more : color_more;
      assign sample_length = of_pixels ? pixel_length : color_length;
      assign sample_ends   = of_pixels ? pixel_ends : color_ends;
    end else begin : gen_sample_bytes
      assign sample_word   = color_word;
      assign sample_strobe = color_strobe;
      assign sample_more   = color_more;
      assign sample_length = color_length;
      assign sample_ends   = color_ends;
    end
  endgenerate
  assign word   = is_flags ? flag_word : (is_color ? sample_word : depth_word);
  assign strobe = is_flags ? flag_strobe : (is_color ? sample_strobe : depth_strobe);
  assign more   = is_flags ? flag_more : (is_color ? sample_more : depth_more);
  assign length = is_flags ? flag_length : (is_color ? sample_length : depth_length);
  assign ends   = !request_i.is_write || request_i.run == RUN'(1) ||
                  (is_flags ? flag_ends : (is_color ? sample_ends : depth_ends));

  // A burst lies in one buffer of a tile, or in a row of flags: no beat moves the address beyond these bits.
  localparam int WIDEST = (PLANE > ROW) ? PLANE : ROW;
  localparam int INSIDE = (WIDEST > PORT) ? WIDEST : PORT + 1;

  // The output word. While it gathers stamps, it is not complete and not on offer.
  logic               valid_q, gathers_q, is_write_q, is_first_q, in_burst_q, recovers_q;
  logic [ADDRESS-1:PORT] address_q;  // without the offset of the rows above
  logic [raster_pkg::TILE_Y_BITS-1:0] rows_q;  // rows of tiles above; 0 for flags, whose address is complete
  logic [LENGTH-1:0]  length_q;  // beats left in the burst
  localparam bit SEVERAL = WORD > BYTES;  // beats in a word
  logic [7:0]         more_q;    // beats of the word after the beat on offer
  logic [8*WORD-1:0]  data_q;
  logic [WORD-1:0]    strobe_q;
  logic [7:0]         writes_q, writes;  // bursts without an answer: now, and from the next cycle on
  logic               takes, sends, discards, begins, owes, is_done;

  assign discards        = recovers_q || !rst_ni;
  assign begins          = request_i.is_write && !in_burst_q;
  assign request_ready_o = !discards && (!valid_q || (beat_ready_i && more_q == '0)) && !(begins && writes_q == '1);
  assign takes           = request_valid_i && request_ready_o;
  assign sends           = valid_q && beat_ready_i;
  assign owes            = in_burst_q && length_q != '0;  // beats of a burst whose stamps will not come

  always_ff @(posedge clk_i or negedge power_on_ni) begin
    if (!power_on_ni) begin
      valid_q    <= 1'b0;
      gathers_q  <= 1'b0;
      in_burst_q <= 1'b0;
      recovers_q <= 1'b0;
    end else begin
      if (takes) valid_q <= ends;
      else if (sends) valid_q <= more_q != '0;
      else if (recovers_q && !valid_q) valid_q <= gathers_q || owes;
      if (takes) gathers_q <= !ends;
      else if (recovers_q) gathers_q <= 1'b0;
      if (takes && request_i.is_write) in_burst_q <= request_i.run != RUN'(1);
      else if (recovers_q && is_done) in_burst_q <= 1'b0;
      recovers_q <= !rst_ni || (recovers_q && !is_done);
    end
  end

  // After the last beat of a word there are no strobes: this ends bursts that a reset has cut.
  always_ff @(posedge clk_i) begin
    if (takes) begin
      data_q   <= gathers_q ? data_q | word : word;
      strobe_q <= gathers_q ? strobe_q | strobe : strobe;
      more_q   <= SEVERAL && request_i.is_write ? more : '0;
      if (!gathers_q) begin
        is_write_q <= request_i.is_write;
        is_first_q <= !in_burst_q;
        address_q  <= address[ADDRESS-1:PORT];
        rows_q     <= is_flags ? '0 : request_i.tile_y;
        length_q   <= length;
      end
    end else if (sends) begin
      data_q     <= data_q >> (8 * BYTES);
      strobe_q   <= strobe_q >> BYTES;
      more_q     <= SEVERAL ? more_q - 8'(more_q != '0) : '0;
      is_first_q <= 1'b0;
      address_q[INSIDE-1:PORT] <= address_q[INSIDE-1:PORT] + 1'b1;
      length_q   <= length_q - 1'b1;
    end
  end

  assign beat_valid_o    = valid_q;
  logic [ADDRESS-TILE-1:0] above;  // tiles in the rows above; the product begins at a register, and the layout stays
  assign above           = (ADDRESS - TILE)'(rows_q) * (ADDRESS - TILE)'(layout_i.row_stride[STRIDE-1:TILE]);
  assign beat_o.is_write = is_write_q;
  assign beat_o.is_first = is_first_q;
  assign beat_o.address  = {address_q, PORT'(0)} + {above, TILE'(0)};
  assign beat_o.length   = length_q;
  assign beat_o.strobe   = strobe_q[BYTES-1:0];
  assign beat_o.data     = data_q[8*BYTES-1:0];

  // ---------------------------------------------------------------------------------------------------------- the way back
  localparam int DEPTH_BEATS = (DEPTH_SHIFT > PORT) ? 1 << (DEPTH_SHIFT - PORT) : 1;  // of a stamp
  localparam int STAMPS = raster_pkg::STAMPS_PER_ROW * raster_pkg::STAMPS_PER_ROW;
  localparam int DEPTH_SHARED = (DEPTH_SHIFT < PORT) ? PORT - DEPTH_SHIFT : 0;  // log2 of the stamps in a beat
  localparam int DEPTH_STAMPS = (STAMPS < (1 << DEPTH_SHARED)) ? STAMPS : 1 << DEPTH_SHARED;  // read with it
  // With blending colours are read too. Unless colour and depth stamps have one size and fill beats, the port records
  // which kind the next answer is. Likewise with COMPRESS_UNIT for one colour per pixel.
  localparam bit BLENDS = raster_pkg::BLEND_LANES != 0;
  localparam bit READS_COLOR = COMPRESSES || (BLENDS && (COLOR_SHIFT != DEPTH_SHIFT || DEPTH_SHIFT < PORT));
  localparam bit READS_SAMPLES = READS_COLOR && BLENDS;
  localparam int COLOR_BEATS = (READS_SAMPLES && COLOR_SHIFT > PORT) ? 1 << (COLOR_SHIFT - PORT) : 1;
  localparam int COLOR_SHARED = (READS_SAMPLES && COLOR_SHIFT < PORT) ? PORT - COLOR_SHIFT : 0;
  localparam int PIXEL_BEATS = (COMPRESSES && PIXEL_SHIFT > PORT) ? 1 << (PIXEL_SHIFT - PORT) : 1;
  localparam int PIXEL_SHARED = (COMPRESSES && PIXEL_SHIFT < PORT) ? PORT - PIXEL_SHIFT : 0;
  localparam int MOST_BEATS = (COLOR_BEATS > DEPTH_BEATS) ? COLOR_BEATS : DEPTH_BEATS;  // pixel colours need no more
  localparam int PART = (MOST_BEATS > 1) ? $clog2(MOST_BEATS) : 1;
  localparam int MOST_SHARED = (COLOR_SHARED > DEPTH_SHARED) ? COLOR_SHARED : DEPTH_SHARED;
  localparam int SHARED = (PIXEL_SHARED > MOST_SHARED) ? PIXEL_SHARED : MOST_SHARED;
  localparam int PARTS = (PART > SHARED) ? PART : SHARED;
  localparam int READ_WORD = MOST_BEATS * BYTES;
  // Reads in flight, in stamps: with blending also the reads of stamps between depth_cache and color_write.
  localparam int PLACES = (raster_pkg::COORDINATES == 0) ? 2 : raster_pkg::TEXTURE_STAMPS;
  localparam int WAITS = BLENDS ? 1 << $clog2(2 * raster_pkg::CACHE_QUEUE + PLACES) : raster_pkg::CACHE_QUEUE;
  localparam int IN_BLOCK = raster_pkg::BLOCK_SIDE * raster_pkg::BLOCK_SIDE;  // stamps of a merge
  localparam int WAITING = (COMPRESSES && WAITS < IN_BLOCK) ? IN_BLOCK : WAITS;
  localparam int MOST = MOST_BEATS * ((HAS_BLOCKS != 0) ? WAITING : STAMPS);
  localparam int READS = $clog2(MOST + 1);
  localparam int TAKEN = (READS < LENGTH) ? READS : LENGTH;

  logic [PARTS-1:0]       part_q;  // beats of the next stamp that have come, or stamps of the beat that have gone
  logic [PARTS-1:0]       sub;     // number of the next stamp in its beat
  logic [READS-1:0]       reads_q;
  logic [8*READ_WORD-1:0] beats;   // the newest beat highest
  logic [SAMPLES*LANE-1:0] depth_data;
  logic                   answers, is_read, responds, is_whole, is_last;
  logic                   answers_color;  // the next stamp is one of colours
  logic                   answers_pixels;  // it has one colour per pixel

  assign is_read           = answer_valid_i && !answer_i.is_write;
  assign is_whole          = (!READS_COLOR && DEPTH_SHARED != 0) ||
                             part_q == (answers_pixels ? PARTS'(PIXEL_BEATS - 1) :
                                        answers_color ? PARTS'(COLOR_BEATS - 1) : PARTS'(DEPTH_BEATS - 1));
  assign response_valid_o  = is_read && is_whole && !discards;
  assign responds          = response_valid_o && response_ready_i;
  assign answer_ready_o    = answer_i.is_write || discards || !is_whole || (is_last && response_ready_i);
  assign answers           = answer_valid_i && answer_ready_o;

  generate
    if (READ_WORD > BYTES) begin : gen_kept
      logic [8*(READ_WORD-BYTES)-1:0] kept_q;
      assign beats = {answer_i.data, kept_q};
      always_ff @(posedge clk_i) if (answers) kept_q <= beats[8*READ_WORD-1:8*BYTES];
    end else begin : gen_one
      assign beats = answer_i.data;
    end
    if (HAS_BLOCKS == 0) begin : gen_planes
      assign answers_color  = 1'b0;
      assign answers_pixels = 1'b0;
      assign sub     = part_q;  // whole buffers are read
      assign is_last = DEPTH_SHARED == 0 || part_q == PARTS'(DEPTH_STAMPS - 1);
    end else begin : gen_stamps
      assign is_last = 1'b1;  // single stamps are read
      if (READS_COLOR) begin : gen_both
        logic read_valid, read_ready;
        logic [PARTS-1:0] place_in_beat;
        localparam int READ = PARTS + (COMPRESSES ? 2 : 1);
        logic [READ-1:0] asked_read, answered_read;
        if (COMPRESSES) begin : gen_pixels
          assign place_in_beat  = of_pixels ? PARTS'(offset >> PIXEL_SHIFT) : PARTS'(place);
          assign asked_read     = {of_pixels, is_color, place_in_beat};
          assign answers_pixels = answered_read[READ-1];
        end else begin : gen_samples
          assign place_in_beat  = PARTS'(place);
          assign asked_read     = {is_color, place_in_beat};
          assign answers_pixels = 1'b0;
        end
        assign {answers_color, sub} = answered_read[PARTS:0];
        fifo #(
            .WIDTH(READ),
            .DEPTH(WAITING)
        ) u_reads (
            .clk_i,
            .rst_ni,
            .valid_i(takes && !request_i.is_write),
            .ready_o(read_ready),
            .data_i (asked_read),
            .valid_o(read_valid),
            .ready_i(responds),
            .data_o (answered_read)
        );
      end else if (DEPTH_SHARED != 0) begin : gen_subs
        assign answers_color  = 1'b0;
        assign answers_pixels = 1'b0;
        logic sub_valid, sub_ready;
        logic [DEPTH_SHARED-1:0] place_in_beat;
        assign place_in_beat = place[DEPTH_SHARED-1:0];
        fifo #(
            .WIDTH(DEPTH_SHARED),
            .DEPTH(raster_pkg::CACHE_QUEUE)
        ) u_subs (
            .clk_i,
            .rst_ni,
            .valid_i(takes && !request_i.is_write),
            .ready_o(sub_ready),
            .data_i (place_in_beat),
            .valid_o(sub_valid),
            .ready_i(responds),
            .data_o (sub[DEPTH_SHARED-1:0])
        );
        if (PARTS > DEPTH_SHARED) begin : gen_rest
          assign sub[PARTS-1:DEPTH_SHARED] = '0;
        end
      end else begin : gen_no_subs
        assign answers_color  = 1'b0;
        assign answers_pixels = 1'b0;
        assign sub = '0;
      end
    end
  endgenerate
  stamp_bytes #(
      .SAMPLE_BYTES(raster_pkg::DEPTH_SAMPLE_BYTES),
      .WORD        (DEPTH_SHARED != 0 ? BYTES : READ_WORD),
      .SHARED      (DEPTH_SHARED),
      .PART        (PARTS)
  ) u_depth_stamp (
      .word_i(beats[8*READ_WORD-1-:8*(DEPTH_SHARED!=0?BYTES:READ_WORD)]),
      .sub_i (sub),
      .data_o(depth_data)
  );
  generate
    if (READS_COLOR) begin : gen_color_stamp
      logic [SAMPLES*LANE-1:0] color_data, pixel_data;
      if (READS_SAMPLES) begin : gen_samples
        stamp_bytes #(
            .CODES       (COLORS),
            .SAMPLE_BYTES(raster_pkg::COLOR_SAMPLE_BYTES),
            .WORD        (COLOR_SHARED != 0 ? BYTES : READ_WORD),
            .SHARED      (COLOR_SHARED),
            .PART        (PARTS)
        ) u_color_stamp (
            .word_i(beats[8*READ_WORD-1-:8*(COLOR_SHARED!=0?BYTES:READ_WORD)]),
            .sub_i (sub),
            .data_o(color_data)
        );
      end else begin : gen_no_samples
        assign color_data = pixel_data;
      end
      if (COMPRESSES) begin : gen_pixels
        stamp_bytes #(
            .CODES       (raster_pkg::PIXELS),
            .SAMPLE_BYTES(raster_pkg::COLOR_SAMPLE_BYTES),
            .WORD        (PIXEL_SHARED != 0 ? BYTES : READ_WORD),
            .SHARED      (PIXEL_SHARED),
            .PART        (PARTS)
        ) u_pixel_stamp (
            .word_i(beats[8*READ_WORD-1-:8*(PIXEL_SHARED!=0?BYTES:READ_WORD)]),
            .sub_i (sub),
            .data_o(pixel_data)
        );
      end else begin : gen_no_pixels
        assign pixel_data = color_data;
      end
      assign response_o.data = answers_pixels ? pixel_data : answers_color ? color_data : depth_data;
    end else begin : gen_depth_alone
      assign response_o.data = depth_data;
    end
  endgenerate

  always_ff @(posedge clk_i or negedge power_on_ni) begin
    if (!power_on_ni) begin
      part_q   <= '0;
      reads_q  <= '0;
      writes_q <= '0;
    end else begin
      if (discards) part_q <= '0;
      else if (is_read && (is_whole ? responds : answers))
        part_q <= is_last && is_whole ? '0 : part_q + 1'b1;
      reads_q  <= reads_q + (takes && !request_i.is_write ? READS'(length[TAKEN-1:0]) : '0) - READS'(answers && is_read);
      writes_q <= writes;
    end
  end

  assign writes = writes_q + 8'(takes && begins) - 8'(answers && answer_i.is_write);

  // Writes that the last flush waits for. Answers come in order, so a flush that ends while another waits takes that one
  // with it. The host has at most three flushes under way.
  logic [7:0] unwritten_q;
  logic [1:0] flushes_q;
  assign flushed_o  = flushes_q != '0 && unwritten_q == '0;
  always_ff @(posedge clk_i or negedge power_on_ni) begin
    if (!power_on_ni) flushes_q <= '0;
    else if (discards) flushes_q <= '0;
    else flushes_q <= flushes_q + 2'(flush_ends_i) - 2'(flushed_o);
  end
  always_ff @(posedge clk_i) begin
    if (flush_ends_i) unwritten_q <= writes;
    else if (answers && answer_i.is_write && unwritten_q != '0) unwritten_q <= unwritten_q - 8'd1;
  end

  assign is_done = !valid_q && !gathers_q && !owes && reads_q == '0 && writes_q == '0;
  assign idle_o  = !discards && reads_q == '0 && writes_q == '0;  // a request not yet sent is not answered either

endmodule
