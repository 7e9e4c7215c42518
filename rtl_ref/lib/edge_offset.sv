// Edge offset: the edge function (or any plane) moved by a few pixels, value + x * step_x + y * step_y, as shifts and
// adds. With constant x and y these are the adders of one sample; with variable ones they find the first stamp of a
// tile's box.
//
// Bit b of a pixel offset changes the value from bit b up: narrow adders in a row, highest bit first, so that neighbours
// share them.
module edge_offset #(
    parameter int WIDTH  = 1,  // bits of a value; the caller has proven that the sum fits, or wants the residue
    parameter int OFFSET = 1   // bits of x and y, pixels
) (
    input  logic signed [WIDTH-1:0]  value_i,
    input  logic signed [WIDTH-1:0]  step_x_i,
    input  logic signed [WIDTH-1:0]  step_y_i,
    input  logic        [OFFSET-1:0] x_i,
    input  logic        [OFFSET-1:0] y_i,
    output logic signed [WIDTH-1:0]  value_o
);

  function automatic logic signed [WIDTH-1:0] moved(input logic signed [WIDTH-1:0] value, input logic signed [WIDTH-1:0] step,
                                                    input logic [OFFSET-1:0] offset);
    logic signed [WIDTH-1:0] term;
    moved = value;
    for (int b = OFFSET - 1; b >= 0; b--) begin
      term  = offset[b] ? step : '0;
      moved = (((moved >>> b) + term) <<< b) | (moved & WIDTH'((1 << b) - 1));
    end
  endfunction

  assign value_o = moved(moved(value_i, step_y_i, y_i), step_x_i, x_i);

endmodule
