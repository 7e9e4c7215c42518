// A comparison function as the three orders in which it passes: value less than the other, equal, greater.
// Combinational. Specification: DepthOutcomes of model/stages/fragment_ops.hpp.
module passing_orders (
    input  logic [raster_pkg::DEPTH_FUNC_BITS-1:0] func_i,
    output logic                                   less_o,
    output logic                                   equal_o,
    output logic                                   greater_o
);

  assign less_o    = func_i == raster_pkg::DEPTH_FUNC_LESS || func_i == raster_pkg::DEPTH_FUNC_LEQUAL ||
                     func_i == raster_pkg::DEPTH_FUNC_NOTEQUAL || func_i == raster_pkg::DEPTH_FUNC_ALWAYS;
  assign equal_o   = func_i == raster_pkg::DEPTH_FUNC_EQUAL || func_i == raster_pkg::DEPTH_FUNC_LEQUAL ||
                     func_i == raster_pkg::DEPTH_FUNC_GEQUAL || func_i == raster_pkg::DEPTH_FUNC_ALWAYS;
  assign greater_o = func_i == raster_pkg::DEPTH_FUNC_GREATER || func_i == raster_pkg::DEPTH_FUNC_GEQUAL ||
                     func_i == raster_pkg::DEPTH_FUNC_NOTEQUAL || func_i == raster_pkg::DEPTH_FUNC_ALWAYS;

endmodule
