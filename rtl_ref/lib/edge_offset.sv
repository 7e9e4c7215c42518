// Edge offset: the edge function moved by a few pixels, value + x * step_x + y * step_y, as shifts and adds. With a
// constant x and y it is the adders of one sample; with a variable one it finds the first stamp of a tile's box.
module edge_offset #(
    parameter int WIDTH  = 1,  // bits of a value; the caller has proven that the sum fits
    parameter int OFFSET = 1   // bits of x and y, pixels
) (
    input  logic signed [WIDTH-1:0]  value_i,
    input  logic signed [WIDTH-1:0]  step_x_i,
    input  logic signed [WIDTH-1:0]  step_y_i,
    input  logic        [OFFSET-1:0] x_i,
    input  logic        [OFFSET-1:0] y_i,
    output logic signed [WIDTH-1:0]  value_o
);

  always_comb begin
    value_o = value_i;
    for (int b = 0; b < OFFSET; b++) begin
      value_o = value_o + (x_i[b] ? step_x_i <<< b : '0) + (y_i[b] ? step_y_i <<< b : '0);
    end
  end

endmodule
