// Alpha test: keeps the samples of a stamp whose alpha passes the comparison with the reference. With alpha to coverage
// it also keeps only the first samples of each pixel, samples * alpha / 255 of them, rounded. Combinational.
// Specification: ColorState::keeps of model/stages/color_packets.hpp.
module alpha_test (
    input  logic [raster_pkg::DEPTH_FUNC_BITS-1:0] func_i,
    input  logic [7:0]                             reference_i,
    input  logic                                   covers_i,
    input  logic [8*raster_pkg::PIXELS-1:0]        alpha_i,
    output logic [raster_pkg::SAMPLES-1:0]         passes_o
);

  localparam int N = raster_pkg::MSAA_SAMPLES;
  localparam int SHIFT = $clog2(N);

  logic less_passes, equal_passes, greater_passes;
  passing_orders u_orders (
      .func_i   (func_i),
      .less_o   (less_passes),
      .equal_o  (equal_passes),
      .greater_o(greater_passes)
  );

  genvar p, k;
  generate
    for (p = 0; p < raster_pkg::PIXELS; p++) begin : gen_pixel
      logic is_less, is_equal, passes;
      assign is_less  = alpha_i[8*p+:8] < reference_i;
      assign is_equal = alpha_i[8*p+:8] == reference_i;
      assign passes   = is_less ? less_passes : (is_equal ? equal_passes : greater_passes);
      if (N > 1) begin : gen_covers
        logic [SHIFT+8:0] scaled, divided;
        logic [SHIFT:0]   count;
        assign scaled  = ((SHIFT + 9)'(alpha_i[8*p+:8]) << SHIFT) + (SHIFT + 9)'(128);
        assign divided = scaled + (scaled >> 8);
        assign count   = divided[SHIFT+8:8];
        for (k = 0; k < N; k++) begin : gen_sample
          assign passes_o[p*N+k] = passes && (!covers_i || (SHIFT + 1)'(k) < count);
        end
      end else begin : gen_one
        assign passes_o[p] = passes;
      end
    end
  endgenerate

endmodule
