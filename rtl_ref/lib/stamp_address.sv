// Stamp address: the tile that holds a stamp of a block, and the stamp's number in it. Combinational; the inverse is
// block_stamp. Specification: stamp_address() of model/stages/cache_tags.hpp.
module stamp_address #(
    parameter int TILE_BITS = $clog2(raster_pkg::BLOCKS_PER_ROW),  // derived; not to be set
    parameter int SIDE_BITS = $clog2(raster_pkg::BLOCK_SIDE),      // derived: log2 of the stamps along a side of a block
    parameter int STAMP = (SIDE_BITS == 0) ? 1 : 2 * SIDE_BITS     // derived: bits of a stamp's number in its block
) (
    input  logic [raster_pkg::TILE_X_BITS+TILE_BITS-1:0] block_x_i,
    input  logic [raster_pkg::TILE_Y_BITS+TILE_BITS-1:0] block_y_i,
    input  logic [STAMP-1:0]                             stamp_i,
    output logic [raster_pkg::TILE_X_BITS-1:0]           tile_x_o,
    output logic [raster_pkg::TILE_Y_BITS-1:0]           tile_y_o,
    output logic [raster_pkg::STAMP_INDEX_BITS-1:0]      stamp_o
);

  localparam int ROW_BITS = $clog2(raster_pkg::STAMPS_PER_ROW);
  localparam logic [15:0] TILE_MASK = 16'((1 << TILE_BITS) - 1);
  localparam logic [15:0] SIDE_MASK = 16'((1 << SIDE_BITS) - 1);

  logic [15:0] column, row;  // column and row of the stamp in its tile
  assign column   = ((16'(block_x_i) & TILE_MASK) << SIDE_BITS) | (16'(stamp_i) & SIDE_MASK);
  assign row      = ((16'(block_y_i) & TILE_MASK) << SIDE_BITS) | (16'(stamp_i) >> SIDE_BITS);
  assign tile_x_o = raster_pkg::TILE_X_BITS'(block_x_i >> TILE_BITS);
  assign tile_y_o = raster_pkg::TILE_Y_BITS'(block_y_i >> TILE_BITS);
  assign stamp_o  = raster_pkg::STAMP_INDEX_BITS'((row << ROW_BITS) | column);

endmodule
