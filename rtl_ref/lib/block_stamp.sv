// Block stamp: the block that holds a stamp of a tile, and the stamp's number in it. Combinational; the inverse is
// stamp_address. Specification: block_stamp() of model/stages/cache_tags.hpp.
module block_stamp #(
    parameter int TILE_BITS = $clog2(raster_pkg::BLOCKS_PER_ROW),  // derived; not to be set
    parameter int SIDE_BITS = $clog2(raster_pkg::BLOCK_SIDE),      // derived: log2 of the stamps along a side of a block
    parameter int STAMP = (SIDE_BITS == 0) ? 1 : 2 * SIDE_BITS     // derived: bits of a stamp's number in its block
) (
    input  logic [raster_pkg::TILE_X_BITS-1:0]           tile_x_i,
    input  logic [raster_pkg::TILE_Y_BITS-1:0]           tile_y_i,
    input  logic [raster_pkg::STAMP_INDEX_BITS-1:0]      stamp_i,
    output logic [raster_pkg::TILE_X_BITS+TILE_BITS-1:0] block_x_o,
    output logic [raster_pkg::TILE_Y_BITS+TILE_BITS-1:0] block_y_o,
    output logic [STAMP-1:0]                             stamp_o
);

  localparam int BLOCK_X = raster_pkg::TILE_X_BITS + TILE_BITS;
  localparam int BLOCK_Y = raster_pkg::TILE_Y_BITS + TILE_BITS;
  localparam int ROW_BITS = $clog2(raster_pkg::STAMPS_PER_ROW);
  localparam logic [15:0] SIDE_MASK = 16'((1 << SIDE_BITS) - 1);

  logic [15:0] column, row;  // column and row of the stamp in its tile
  assign column    = 16'(stamp_i) & 16'((1 << ROW_BITS) - 1);
  assign row       = 16'(stamp_i) >> ROW_BITS;
  assign block_x_o = (BLOCK_X'(tile_x_i) << TILE_BITS) | BLOCK_X'(column >> SIDE_BITS);
  assign block_y_o = (BLOCK_Y'(tile_y_i) << TILE_BITS) | BLOCK_Y'(row >> SIDE_BITS);
  assign stamp_o   = STAMP'(((row & SIDE_MASK) << SIDE_BITS) | (column & SIDE_MASK));

endmodule
