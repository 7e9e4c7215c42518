// Alpha test: the samples of a stamp whose alpha compares with the reference as the function says. Combinational.
// Specification: alpha_passes of model/stages/depth_test.hpp.
module alpha_test (
    input  logic [raster_pkg::DEPTH_FUNC_BITS-1:0] func_i,
    input  logic [7:0]                             reference_i,
    input  logic [8*raster_pkg::SAMPLES-1:0]       alpha_i,
    output logic [raster_pkg::SAMPLES-1:0]         passes_o
);

  // The function as the three orders in which it lets a sample pass.
  logic less_passes, equal_passes, greater_passes;
  assign less_passes    = func_i == raster_pkg::DEPTH_FUNC_LESS || func_i == raster_pkg::DEPTH_FUNC_LEQUAL ||
                          func_i == raster_pkg::DEPTH_FUNC_NOTEQUAL || func_i == raster_pkg::DEPTH_FUNC_ALWAYS;
  assign equal_passes   = func_i == raster_pkg::DEPTH_FUNC_EQUAL || func_i == raster_pkg::DEPTH_FUNC_LEQUAL ||
                          func_i == raster_pkg::DEPTH_FUNC_GEQUAL || func_i == raster_pkg::DEPTH_FUNC_ALWAYS;
  assign greater_passes = func_i == raster_pkg::DEPTH_FUNC_GREATER || func_i == raster_pkg::DEPTH_FUNC_GEQUAL ||
                          func_i == raster_pkg::DEPTH_FUNC_NOTEQUAL || func_i == raster_pkg::DEPTH_FUNC_ALWAYS;

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
