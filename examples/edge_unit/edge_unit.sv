// A student's edge unit: is pixel (x, y) of a tile inside of one edge? The value is the edge function at the tile's first
// pixel, and gains step_x with each pixel to the right and step_y with each one down. Ties are folded into the value: 0 is
// inside. Built with EDGE_UNIT_BUG it forgets them.
module edge_unit #(
    parameter int VALUE_BITS = 16,
    parameter int STEP_BITS  = 10,
    parameter int PIXEL_BITS = 3
) (
    input  logic signed [VALUE_BITS-1:0] value_i,
    input  logic signed [ STEP_BITS-1:0] step_x_i,
    input  logic signed [ STEP_BITS-1:0] step_y_i,
    input  logic        [PIXEL_BITS-1:0] x_i,
    input  logic        [PIXEL_BITS-1:0] y_i,
    output logic                         inside_o
);
  localparam int BITS = VALUE_BITS + STEP_BITS;  // more than the sum can need

  logic signed [BITS-1:0] sum;
  assign sum = BITS'(value_i) + BITS'(step_x_i) * BITS'($signed({1'b0, x_i})) + BITS'(step_y_i) * BITS'($signed({1'b0, y_i}));
`ifdef EDGE_UNIT_BUG
  assign inside_o = sum > 0;
`else
  assign inside_o = sum >= 0;
`endif
endmodule
