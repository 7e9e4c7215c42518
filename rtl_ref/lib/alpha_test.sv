// Alpha test: the samples of a stamp whose alpha compares with the reference as the function says. Combinational.
// Specification: alpha_passes of model/stages/depth_test.hpp.
module alpha_test (
    input  logic [raster_pkg::DEPTH_FUNC_BITS-1:0] func_i,
    input  logic [7:0]                             reference_i,
    input  logic [8*raster_pkg::SAMPLES-1:0]       alpha_i,
    output logic [raster_pkg::SAMPLES-1:0]         passes_o
);

  logic less_passes, equal_passes, greater_passes;
  passing_orders u_orders (
      .func_i   (func_i),
      .less_o   (less_passes),
      .equal_o  (equal_passes),
      .greater_o(greater_passes)
  );

  genvar s;
  generate
    for (s = 0; s < raster_pkg::SAMPLES; s++) begin : gen_sample
      logic is_less, is_equal;
      assign is_less     = alpha_i[8*s+:8] < reference_i;
      assign is_equal    = alpha_i[8*s+:8] == reference_i;
      assign passes_o[s] = is_less ? less_passes : (is_equal ? equal_passes : greater_passes);
    end
  endgenerate

endmodule
