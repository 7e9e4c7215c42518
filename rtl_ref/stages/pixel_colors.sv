// Pixel colours: a block of 4x4 pixels with one colour in each pixel lies in memory with one colour per pixel, any
// other with one per sample. A bit for each block of the target, in words of FLAG_WORD blocks of a row, says which.
//
//   victims -> [slots: is it uniform, is it whole] --.
//   requests <-> [look: the block's bit] -> how its colours are written or read -> [merge: reads of its pixels, if need be]
//
// Before colours of a block are written or read, its bit is looked up, which takes one cycle. A victim is uniform if in
// each pixel all samples are present and equal, or none is; the block then goes to memory with one colour per pixel if
// memory is stale, all of the block is present, or memory holds it so already. A victim that is not uniform, over a
// block stored so, is merged: its pixels are read, after all earlier requests, and kept here until the block has been
// written with all samples. Tokens read and write words when nothing else is under way. Specification:
// model/stages/pixel_colors.hpp; the times are those of model/engines/cycle/block_timing.hpp.
module pixel_colors #(
    parameter int SIDE_BITS = $clog2(raster_pkg::BLOCK_SIDE),  // derived; not to be set
    parameter int TILE_BITS = $clog2(raster_pkg::BLOCKS_PER_ROW),
    parameter int STAMPS = raster_pkg::BLOCK_SIDE * raster_pkg::BLOCK_SIDE,  // stamps of a block
    parameter int STAMP = (STAMPS == 1) ? 1 : 2 * SIDE_BITS,
    parameter int BLOCK_X = raster_pkg::TILE_X_BITS + TILE_BITS,
    parameter int BLOCK_Y = raster_pkg::TILE_Y_BITS + TILE_BITS,
    parameter int WORD = raster_pkg::FLAG_WORD,
    parameter int BIT = $clog2(WORD),
    parameter int WORD_X = (BLOCK_X > BIT) ? BLOCK_X - BIT : 1,  // bits of a word's number in its row
    parameter int SAMPLES = raster_pkg::SAMPLES,
    parameter int COLOR = raster_pkg::STORED_COLOR_BITS,
    parameter int COLORS = raster_pkg::PIXELS * COLOR,  // bits of a stamp's colours, one per pixel
    parameter int VICTIMS = raster_pkg::CACHE_VICTIMS,
    parameter int VICTIM = $clog2(VICTIMS)
) (
    input logic clk_i,
    input logic rst_ni,

    // Slots of victims: an eviction begins, and whether its colours in memory are stale; a stamp of colours enters a
    // slot
    input logic                     begins_i,
    input logic [VICTIM-1:0]        begin_slot_i,
    input logic                     begin_fills_i,
    input logic                     comes_i,
    input logic [VICTIM-1:0]        come_slot_i,
    input logic [SAMPLES-1:0]       come_strobe_i,
    input logic [SAMPLES*COLOR-1:0] come_color_i,

    // Colours of a block are to be written, from a slot, or a stamp's are to be read; in the order of requests, until
    // the last of them has been taken
    input  logic                                    writes_i,
    input  logic [VICTIM-1:0]                       slot_i,
    input  logic                                    is_every_i,  // every stamp of it is written
    input  logic [BLOCK_X-1:0]                      write_x_i,
    input  logic [BLOCK_Y-1:0]                      write_y_i,
    input  logic                                    reads_i,
    input  logic [raster_pkg::TILE_X_BITS-1:0]      read_tile_x_i,
    input  logic [raster_pkg::TILE_Y_BITS-1:0]      read_tile_y_i,
    input  logic [raster_pkg::STAMP_INDEX_BITS-1:0] read_stamp_i,
    input  logic                                    ends_i,
    output logic                                    is_known_o,   // the block's bit is known
    output logic                                    of_pixels_o,  // with one colour per pixel

    // The merge: reads of its stamps, their answers in order, and the merged stamp being written
    output logic                             asks_o,
    output logic [STAMP-1:0]                 ask_stamp_o,
    input  logic                             is_asked_i,  // the read was taken
    input  logic                             other_asked_i,  // another read was taken, or answered
    input  logic                             other_answered_i,
    input  logic                             answers_i,
    input  logic [SAMPLES*raster_pkg::MEMORY_LANE_BITS-1:0] answer_i,
    output logic                             merges_o,  // all stamps are written, merged with the colours read
    output logic                             takes_answers_o,  // only its own answers are still to come
    input  logic [STAMP-1:0]                 stamp_i,
    output logic [COLORS-1:0]                merged_o,

    // Tokens: a word is read, and valid in the next cycle; or written
    input  logic               token_reads_i,
    input  logic               token_writes_i,
    input  logic [WORD_X-1:0]  word_x_i,
    input  logic [BLOCK_Y-1:0] word_y_i,
    input  logic [WORD-1:0]    word_i,
    output logic [WORD-1:0]    word_o
);

  localparam int WORDS = ((raster_pkg::TILES_Y << TILE_BITS) << WORD_X);
  localparam int ADDRESS = $clog2(WORDS);
  localparam int COUNT = $clog2(STAMPS + 1);
  localparam int N = raster_pkg::MSAA_SAMPLES;
  // Reads of depth, and with blending of colours, that may not have been answered.
  localparam int PLACES = raster_pkg::COORDINATES == 0 ? 2 : raster_pkg::TEXTURE_STAMPS;
  localparam int MOST = raster_pkg::BLEND_LANES == 0 ? raster_pkg::CACHE_QUEUE : 2 * raster_pkg::CACHE_QUEUE + PLACES;
  localparam int READS = $clog2(MOST + 1);

  // Colours of each slot: stale in memory; one per pixel; complete so far.
  logic [VICTIMS-1:0] fills_q, is_uniform_q, is_full_q;
  logic               is_uniform;  // the incoming stamp is uniform
  always_comb begin
    is_uniform = 1'b1;
    for (int i = 0; i < SAMPLES; i++)
      if (come_strobe_i[i] != come_strobe_i[i/N*N] || come_color_i[i*COLOR+:COLOR] != come_color_i[i/N*N*COLOR+:COLOR])
        is_uniform = 1'b0;
  end
  always_ff @(posedge clk_i) begin
    for (int i = 0; i < VICTIMS; i++) begin
      if (begins_i && begin_slot_i == VICTIM'(i)) begin
        fills_q[i]      <= begin_fills_i;
        is_uniform_q[i] <= 1'b1;
        is_full_q[i]    <= 1'b1;
      end else if (comes_i && come_slot_i == VICTIM'(i)) begin
        is_uniform_q[i] <= is_uniform_q[i] && is_uniform;
        is_full_q[i]    <= is_full_q[i] && come_strobe_i == '1;
      end
    end
  end

  // The block being looked up.
  logic [BLOCK_X-1:0] read_x, block_x;
  logic [BLOCK_Y-1:0] read_y, block_y;
  block_stamp u_read_block (
      .tile_x_i (read_tile_x_i),
      .tile_y_i (read_tile_y_i),
      .stamp_i  (read_stamp_i),
      .block_x_o(read_x),
      .block_y_o(read_y),
      .stamp_o  ()
  );
  assign block_x = writes_i ? write_x_i : read_x;
  assign block_y = writes_i ? write_y_i : read_y;
  logic [WORD_X-1:0]  block_word;
  logic [WORD-1:0]    block_bit, word;
  logic               looks, known_q, is_stored, updates;
  logic               fills, is_even, is_whole_q;
  logic [ADDRESS-1:0] block_address, token_address;
  assign block_word    = WORD_X'(block_x >> BIT);
  assign block_bit     = WORD'(1) << BIT'(block_x);
  assign block_address = ADDRESS'({block_y, block_word});
  assign token_address = ADDRESS'({word_y_i, word_x_i});
  assign looks         = (writes_i || reads_i) && !known_q;
  assign is_stored     = (word & block_bit) != '0;
  assign updates       = writes_i && known_q;
  sram #(
      .WIDTH    (WORD),
      .DEPTH    (WORDS),
      .READS_OLD(0)
  ) u_words (
      .clk_i,
      .read_i         (looks || token_reads_i),
      .read_address_i (token_reads_i ? token_address : block_address),
      .data_o         (word),
      .write_i        (updates || token_writes_i),
      .write_address_i(token_writes_i ? token_address : block_address),
      .data_i         (token_writes_i ? word_i : (word & ~block_bit) | (block_bit & {WORD{of_pixels_o}}))
  );
  assign word_o = word;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) known_q <= 1'b0;
    else known_q <= looks || (known_q && !ends_i);
  end
  always_ff @(posedge clk_i) if (looks) is_whole_q <= is_full_q[slot_i] && is_every_i;
  assign fills       = fills_q[slot_i];
  assign is_even     = is_uniform_q[slot_i];
  assign of_pixels_o = writes_i ? is_even && (fills || is_whole_q || is_stored) : is_stored;

  // The merge.
  logic [COUNT-1:0]  asked_q, answered_q;  // in stamps
  logic [READS-1:0]  others_q;  // reads that have not been answered
  logic [COLORS-1:0] merged_q[0:STAMPS-1], answer;
  assign merges_o    = writes_i && known_q && !is_even && !fills && is_stored;
  assign takes_answers_o = merges_o && others_q == '0;
  assign asks_o      = takes_answers_o && asked_q != COUNT'(STAMPS);
  assign ask_stamp_o = STAMP'(asked_q);
  assign is_known_o  = known_q && (!merges_o || answered_q == COUNT'(STAMPS));
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      asked_q    <= '0;
      answered_q <= '0;
      others_q   <= '0;
    end else begin
      others_q   <= others_q + READS'(other_asked_i) - READS'(other_answered_i);
      asked_q    <= ends_i ? '0 : asked_q + COUNT'(is_asked_i);
      answered_q <= ends_i ? '0 : answered_q + COUNT'(answers_i);
    end
  end
  genvar p;
  generate
    for (p = 0; p < raster_pkg::PIXELS; p++) begin : gen_answer
      assign answer[p*COLOR+:COLOR] = answer_i[p*raster_pkg::MEMORY_LANE_BITS+:COLOR];
    end
  endgenerate
  always_ff @(posedge clk_i) if (answers_i) merged_q[STAMP'(answered_q)] <= answer;
  assign merged_o = merged_q[stamp_i];

endmodule
