// Sample offset: what an edge function or a plane gains on the way from a pixel's centre to a sample, value + X * step_x +
// Y * step_y, X and Y constant subpixels of MSAA_X and MSAA_Y. Shifts and adds; modulo 2^WIDTH.
module sample_offset #(
    parameter int        WIDTH  = 1,
    parameter int        SAMPLE = 0  // of the pixel
) (
    input  logic signed [WIDTH-1:0] value_i,
    input  logic signed [WIDTH-1:0] step_x_i,
    input  logic signed [WIDTH-1:0] step_y_i,
    output logic signed [WIDTH-1:0] value_o
);

  localparam logic signed [31:0] X = $signed(raster_pkg::MSAA_X[32*SAMPLE+:32]);
  localparam logic signed [31:0] Y = $signed(raster_pkg::MSAA_Y[32*SAMPLE+:32]);

  function automatic logic signed [WIDTH-1:0] moved(input logic signed [WIDTH-1:0] value, input logic signed [WIDTH-1:0] step,
                                                    input logic signed [31:0] way);
    logic [31:0] size;
    size  = way < 0 ? -way : way;
    moved = value;
    for (int b = 0; b < 8; b++) if (size[b]) moved = way < 0 ? moved - (step <<< b) : moved + (step <<< b);
  endfunction

  assign value_o = moved(moved(value_i, step_x_i, X), step_y_i, Y);

endmodule
