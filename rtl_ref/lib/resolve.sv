// Resolve: the one colour of each multisampled pixel, of a stamp unless said otherwise: the mean of each stored
// channel, rounded to the nearest code, halves up. Combinational. Specification: mean_color of model/stages/resolve.hpp.
module resolve #(
    parameter int PIXELS = raster_pkg::PIXELS,    // whose samples come together
    parameter int N = raster_pkg::MSAA_SAMPLES    // samples of a pixel; not to be set
) (
    input  logic [PIXELS*N*raster_pkg::STORED_COLOR_BITS-1:0] color_i,
    output logic [PIXELS*raster_pkg::STORED_COLOR_BITS-1:0]   color_o
);

  localparam int SHIFT = $clog2(N);
  localparam int COLOR = raster_pkg::STORED_COLOR_BITS;
  localparam int CHANNELS = raster_pkg::COLOR_FORMAT == 0 ? 3 : 4;

  genvar p, c;
  generate
    for (p = 0; p < PIXELS; p++) begin : gen_pixel
      for (c = 0; c < CHANNELS; c++) begin : gen_channel
        localparam int AT = raster_pkg::COLOR_FORMAT != 0 ? 8 * c : c == 0 ? 0 : c == 1 ? 5 : 11;
        localparam int BITS = raster_pkg::COLOR_FORMAT != 0 ? 8 : c == 1 ? 6 : 5;
        logic [BITS+SHIFT-1:0] sum;
        always_comb begin
          sum = (BITS + SHIFT)'(N / 2);
          for (int k = 0; k < N; k++) sum = sum + (BITS + SHIFT)'(color_i[(p*N+k)*COLOR+AT+:BITS]);
        end
        assign color_o[p*COLOR+AT+:BITS] = sum[SHIFT+:BITS];
      end
    end
  endgenerate

endmodule
