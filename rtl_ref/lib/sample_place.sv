// Place of a sample in its block of 4x4 pixels: the low bits of its pixel's coordinates. Combinational.
module sample_place #(
    parameter int SAMPLE = 0,                                   // number in the stamp, pixel by pixel and row by row
    parameter int SIDE_BITS = $clog2(raster_pkg::BLOCK_SIDE),   // derived; not to be set
    parameter int STAMP = (SIDE_BITS == 0) ? 1 : 2 * SIDE_BITS  // derived: bits of a stamp's number in its block
) (
    input  logic [STAMP-1:0] stamp_i,  // number in the block, row by row
    output logic [1:0]       x_o,
    output logic [1:0]       y_o
);

  localparam int SIZE = raster_pkg::STAMP_SIZE;
  localparam int PIXEL = SAMPLE / raster_pkg::MSAA_SAMPLES;
  generate
    if (SIDE_BITS == 0) begin : gen_stamp
      assign x_o = 2'(PIXEL % SIZE);
      assign y_o = 2'(PIXEL / SIZE);
    end else begin : gen_stamps
      assign x_o = 2'(stamp_i[SIDE_BITS-1:0]) * 2'(SIZE) + 2'(PIXEL % SIZE);
      assign y_o = 2'(stamp_i[2*SIDE_BITS-1:SIDE_BITS]) * 2'(SIZE) + 2'(PIXEL / SIZE);
    end
  endgenerate

endmodule
