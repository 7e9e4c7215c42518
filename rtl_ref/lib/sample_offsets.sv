// Sample offsets: an edge function or a plane moved from a pixel's centre to each of its samples, value + X * step_x +
// Y * step_y, X and Y constant subpixels of MSAA_X and MSAA_Y. Shifts and adds; modulo 2^WIDTH.
//
// Samples lie opposite each other, and their X and Y have few magnitudes: an offset is made for the sample to the
// right, from products of magnitudes, and negated for the sample to the left. So terms that two samples share exist once.
module sample_offsets #(
    parameter int WIDTH = 1  // bits of a value
) (
    input  logic signed [WIDTH-1:0]                          value_i,
    input  logic signed [WIDTH-1:0]                          step_x_i,
    input  logic signed [WIDTH-1:0]                          step_y_i,
    output logic        [raster_pkg::MSAA_SAMPLES*WIDTH-1:0] value_o    // one value per sample
);

  function automatic logic [WIDTH-1:0] times(input logic [WIDTH-1:0] step, input logic [31:0] size);
    times = '0;
    for (int b = 0; b < 8; b++) if (size[b]) times = times + (step << b);
  endfunction

  genvar k;
  generate
    for (k = 0; k < raster_pkg::MSAA_SAMPLES; k++) begin : gen_sample
      localparam logic signed [31:0] X = $signed(raster_pkg::MSAA_X[32*k+:32]);
      localparam logic signed [31:0] Y = $signed(raster_pkg::MSAA_Y[32*k+:32]);
      localparam logic signed [31:0] SIZE_X = X < 0 ? -X : X;
      localparam logic signed [31:0] SIZE_Y = Y < 0 ? -Y : Y;
      logic [WIDTH-1:0] right, down, way;
      assign right = times(step_x_i, SIZE_X);
      assign down  = times(step_y_i, SIZE_Y);
      assign way   = (X < 0) == (Y < 0) ? right + down : right - down;
      assign value_o[k*WIDTH+:WIDTH] = X < 0 ? value_i - way : value_i + way;
    end
  endgenerate

endmodule
