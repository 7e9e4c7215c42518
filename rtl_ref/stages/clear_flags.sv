// Clear flags: a bit for each block and plane of the target, set while the value of a fast clear counts instead of
// memory, in words of FLAG_WORD blocks of a row. They survive a flush.
//
// A fragment's word is read in the cycle in which the fragment comes; in every later cycle cleared_o gives the flags of
// its block, including all falls so far. A falling flag delays only fragments that need the read port: its word is read
// in the next cycle, in which they wait (is_busy_o), and written in the one after that. Falls are at least two cycles
// apart. Tokens read and write words when nothing else is under way. Specification: model/stages/clear_flags.hpp; the
// times are those of model/engines/cycle/block_timing.hpp.
module clear_flags #(
    parameter int TILE_BITS = $clog2(raster_pkg::BLOCKS_PER_ROW),  // derived; not to be set
    parameter int BLOCK_X = raster_pkg::TILE_X_BITS + TILE_BITS,   // derived: bits of a block's column
    parameter int BLOCK_Y = raster_pkg::TILE_Y_BITS + TILE_BITS,   // derived: bits of a block's row
    parameter int WORD = raster_pkg::FLAG_WORD,                    // derived: flags of a word
    parameter int BIT = $clog2(WORD),                              // derived: bits of a flag's place in its word
    parameter int WORD_X = (BLOCK_X > BIT) ? BLOCK_X - BIT : 1     // bits of a word's number in its row
) (
    input logic clk_i,
    input logic rst_ni,

    // A fragment arrives and asks for the flags of its block
    output logic               is_busy_o,  // the fragment has to wait
    input  logic               reads_i,
    input  logic [BLOCK_X-1:0] block_x_i,
    input  logic [BLOCK_Y-1:0] block_y_i,

    // The block of the last fragment, from the next cycle on
    input  logic [BLOCK_X-1:0] read_x_i,
    input  logic [BLOCK_Y-1:0] read_y_i,
    output logic [1:0]         cleared_o,  // colour, depth

    // An evicted block: its flags of these buffers fall in this cycle
    input logic [1:0]         fills_i,
    input logic               falls_i,
    input logic [BLOCK_X-1:0] line_x_i,
    input logic [BLOCK_Y-1:0] line_y_i,

    // Tokens: a word is read, and valid in the next cycle; its flags of either buffer are written
    input  logic               token_reads_i,
    input  logic [1:0]         token_writes_i,
    input  logic [WORD_X-1:0]  word_x_i,
    input  logic [BLOCK_Y-1:0] word_y_i,
    input  logic [WORD-1:0]    word_i,
    output logic [WORD-1:0]    word_depth_o,
    output logic [WORD-1:0]    word_color_o
);

  localparam int FLAGS = ((raster_pkg::TILES_Y << TILE_BITS) << WORD_X);
  localparam int FLAG = $clog2(FLAGS);

  function automatic [FLAG-1:0] word_of(input [BLOCK_X-1:0] x, input [BLOCK_Y-1:0] y);
    word_of = FLAG'({y, WORD_X'(x >> BIT)});
  endfunction
  function automatic [BIT-1:0] bit_of(input [BLOCK_X-1:0] x);
    bit_of = BIT'(x);
  endfunction

  // A falling flag: its word is read, then written.
  logic               reads_q, writes_q;
  logic [BLOCK_X-1:0] reads_x_q, writes_x_q;
  logic [BLOCK_Y-1:0] reads_y_q, writes_y_q;
  logic [1:0]         reads_fills_q, writes_fills_q;
  assign is_busy_o = reads_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      reads_q  <= 1'b0;
      writes_q <= 1'b0;
    end else begin
      reads_q  <= falls_i;
      writes_q <= reads_q;
    end
  end
  always_ff @(posedge clk_i) begin
    if (falls_i) begin
      reads_x_q     <= line_x_i;
      reads_y_q     <= line_y_i;
      reads_fills_q <= fills_i;
    end
    writes_x_q     <= reads_x_q;
    writes_y_q     <= reads_y_q;
    writes_fills_q <= reads_fills_q;
  end

  logic [FLAG-1:0] read_address, write_address;
  logic [WORD-1:0] word_depth, word_color, fallen, word_depth_new, word_color_new;
  logic [1:0]      writes;  // colour, depth
  logic            reads;
  always_comb begin
    read_address = word_of(block_x_i, block_y_i);
    if (reads_q) read_address = word_of(reads_x_q, reads_y_q);
    if (token_reads_i) read_address = word_of(BLOCK_X'(word_x_i) << BIT, word_y_i);
  end
  always_comb begin
    fallen = WORD'(1) << bit_of(writes_x_q);
    write_address  = word_of(BLOCK_X'(word_x_i) << BIT, word_y_i);
    writes         = token_writes_i;
    word_depth_new = word_i;
    word_color_new = word_i;
    if (writes_q) begin
      write_address  = word_of(writes_x_q, writes_y_q);
      writes         = writes_fills_q;
      word_depth_new = word_depth & ~fallen;
      word_color_new = word_color & ~fallen;
    end
  end

  assign reads = (reads_i && !(writes_q && write_address == read_address)) || reads_q || token_reads_i;

  // A word that is being written is not read again: the RAM outputs still hold it from the read before the write.
  sram #(
      .WIDTH(WORD),
      .DEPTH(FLAGS),
      .READS_OLD(0)
  ) u_depth (
      .clk_i,
      .read_i         (reads),
      .read_address_i (read_address),
      .data_o         (word_depth),
      .write_i        (writes[0]),
      .write_address_i(write_address),
      .data_i         (word_depth_new)
  );
  sram #(
      .WIDTH(WORD),
      .DEPTH(FLAGS),
      .READS_OLD(0)
  ) u_color (
      .clk_i,
      .read_i         (reads),
      .read_address_i (read_address),
      .data_o         (word_color),
      .write_i        (writes[1]),
      .write_address_i(write_address),
      .data_i         (word_color_new)
  );
  assign word_depth_o = word_depth;
  assign word_color_o = word_color;

  // The flags of the last block: in the cycle after it came from its word, less the flags being cleared then; from this
  // register in later cycles.
  logic       is_fresh_q;
  logic [1:0] held_q, written_q, read_flags, kept;
  assign read_flags = is_fresh_q ? {word_color[bit_of(read_x_i)], word_depth[bit_of(read_x_i)]} & ~written_q : held_q;
  always_comb begin
    kept = '1;
    if (line_x_i == read_x_i && line_y_i == read_y_i) kept = ~fills_i;
    if (reads_q && reads_x_q == read_x_i && reads_y_q == read_y_i) kept = kept & ~reads_fills_q;
  end
  assign cleared_o = read_flags & kept;

  always_ff @(posedge clk_i) begin
    is_fresh_q <= reads_i;
    held_q     <= cleared_o;
    written_q  <= writes_fills_q & {2{writes_q && block_x_i == writes_x_q && block_y_i == writes_y_q}};
  end

endmodule
