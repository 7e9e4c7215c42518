// Pixel colours: blocks of 4x4 pixels whose pixels have one colour each lie in memory with one colour a pixel, others with one a
// sample. A bit for each block of the target, in words of FLAG_WORD blocks of a row, says which.
//
//   requests <-> [look: the block's bit] -> how its colours are written or read -> [merge: reads of its pixels, if need be]
//
// Whoever is about to ask for colours of a block, to write or to read, waits a cycle for its bit. What is written is uniform if of
// each pixel all samples are there, and equal, or none; the block then goes to memory with a colour a pixel where memory holds
// garbage, all of it is there, or memory has such a block already. One that is not uniform, over such a block, is merged: its
// pixels are read, behind everything that was asked for before, and kept here until the block has been written with all samples.
// Tokens read and write words when nothing else is under way.
// Specification: model/stages/pixel_colors.hpp; the times are those of model/engines/cycle/block_timing.hpp.
module pixel_colors #(
    parameter int SIDE_BITS = $clog2(raster_pkg::BLOCK_SIDE),  // derived; not to be set
    parameter int TILE_BITS = $clog2(raster_pkg::BLOCKS_PER_ROW),
    parameter int STAMPS = raster_pkg::BLOCK_SIDE * raster_pkg::BLOCK_SIDE,  // of a block
    parameter int STAMP = (STAMPS == 1) ? 1 : 2 * SIDE_BITS,
    parameter int BLOCK_X = raster_pkg::TILE_X_BITS + TILE_BITS,
    parameter int BLOCK_Y = raster_pkg::TILE_Y_BITS + TILE_BITS,
    parameter int WORD = raster_pkg::FLAG_WORD,
    parameter int BIT = $clog2(WORD),
    parameter int WORD_X = (BLOCK_X > BIT) ? BLOCK_X - BIT : 1,  // bits of a word's number in its row
    parameter int COLORS = raster_pkg::PIXELS * raster_pkg::STORED_COLOR_BITS  // of a stamp, one a pixel
) (
    input logic clk_i,
    input logic rst_ni,

    // Colours of a block are to be written, or read, in the order of requests, until the last of them has been taken
    input  logic               writes_i,
    input  logic               reads_i,
    input  logic [BLOCK_X-1:0] block_x_i,
    input  logic [BLOCK_Y-1:0] block_y_i,
    input  logic               ends_i,
    output logic               is_known_o,   // how: now
    output logic               of_pixels_o,  // then: with one colour a pixel

    // Of a block that is written
    input logic fills_i,       // memory holds garbage
    input logic is_uniform_i,
    input logic is_whole_i,    // all its samples are there

    // The merge: reads of its stamps, their answers in order, and one of them as it is written
    output logic              merges_o,
    output logic              asks_o,
    output logic [STAMP-1:0]  ask_stamp_o,
    input  logic              is_asked_i,  // taken
    input  logic              all_answered_i,  // nothing that was asked for before is under way
    input  logic              answers_i,
    input  logic [COLORS-1:0] answer_i,
    input  logic [STAMP-1:0]  stamp_i,
    output logic [COLORS-1:0] merged_o,

    // Tokens: a word is read, and is there in the next cycle; or written
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

  // The block at work.
  logic [WORD_X-1:0]  block_word;
  logic [WORD-1:0]    block_bit, word;
  logic               looks, known_q, is_stored, updates;
  logic               fills_q, is_uniform_q, is_whole_q;
  logic [ADDRESS-1:0] block_address, token_address;
  assign block_word    = WORD_X'(block_x_i >> BIT);
  assign block_bit     = WORD'(1) << BIT'(block_x_i);
  assign block_address = ADDRESS'({block_y_i, block_word});
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
  always_ff @(posedge clk_i) begin
    if (looks) begin
      fills_q      <= fills_i;
      is_uniform_q <= is_uniform_i;
      is_whole_q   <= is_whole_i;
    end
  end
  assign of_pixels_o = writes_i ? is_uniform_q && (fills_q || is_whole_q || is_stored) : is_stored;

  // The merge.
  logic [COUNT-1:0]  asked_q, answered_q;  // stamps
  logic [COLORS-1:0] merged_q[0:STAMPS-1];
  assign merges_o    = writes_i && known_q && !is_uniform_q && !fills_q && is_stored;
  assign asks_o      = merges_o && asked_q != COUNT'(STAMPS) && (all_answered_i || asked_q != '0);
  assign ask_stamp_o = STAMP'(asked_q);
  assign is_known_o  = known_q && (!merges_o || answered_q == COUNT'(STAMPS));
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      asked_q    <= '0;
      answered_q <= '0;
    end else begin
      asked_q    <= ends_i ? '0 : asked_q + COUNT'(is_asked_i);
      answered_q <= ends_i ? '0 : answered_q + COUNT'(answers_i);
    end
  end
  always_ff @(posedge clk_i) if (answers_i) merged_q[STAMP'(answered_q)] <= answer_i;
  assign merged_o = merged_q[stamp_i];

endmodule
