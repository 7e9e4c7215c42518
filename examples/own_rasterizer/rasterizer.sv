// A rasterizer of somebody else's: triangles of one colour, no depths, a pixel of its square target a clock. Corners in
// subpixels, y down; top-left rule, both windings. Each triangle ends with a packet of its own.
module rasterizer #(
    parameter int SIZE          = 16,  // pixels
    parameter int SUBPIXEL_BITS = 2,
    parameter int BITS          = 8    // of a coordinate
) (
    input  logic                    clk_i,
    input  logic                    rst_ni,
    input  logic                    valid_i,
    output logic                    ready_o,
    input  logic [2:0][BITS-1:0]    corner_x_i,
    input  logic [2:0][BITS-1:0]    corner_y_i,
    input  logic [15:0]             color_i,
    output logic                    valid_o,
    input  logic                    ready_i,
    output logic                    is_end_o,
    output logic [$clog2(SIZE)-1:0] x_o,
    output logic [$clog2(SIZE)-1:0] y_o,
    output logic [15:0]             color_o
);
  localparam int LAST = SIZE * SIZE;  // the step of the end packet

  logic [2:0][BITS-1:0] corner_x, corner_y;
  int step;  // below 0: none under way

  // Twice the area of corners a and b with a point in subpixels; positive where it lies to the right of the way from a to b.
  function automatic int area(int a, int b, int x, int y);
    int ax = int'($signed(corner_x[a])), ay = int'($signed(corner_y[a]));
    return (int'($signed(corner_x[b])) - ax) * (y - ay) - (int'($signed(corner_y[b])) - ay) * (x - ax);
  endfunction

  function automatic bit is_inside(int x, int y);
    int whole = area(0, 1, int'($signed(corner_x[2])), int'($signed(corner_y[2])));
    bit turns = whole < 0;
    for (int a = 0; a < 3; a++) begin
      int b = (a + 1) % 3;
      int value = area(a, b, x, y);
      int right = int'($signed(corner_x[b])) - int'($signed(corner_x[a]));
      int down = int'($signed(corner_y[b])) - int'($signed(corner_y[a]));
      bit owns_ties = (down == 0 ? right > 0 : down < 0) != turns;
      if (value == 0 ? !owns_ties : (value < 0) != turns) return 1'b0;
    end
    return whole != 0;
  endfunction

  assign x_o      = $clog2(SIZE)'(step % SIZE);
  assign y_o      = $clog2(SIZE)'(step / SIZE);
  assign is_end_o = step == LAST;
  assign valid_o  = is_end_o || step >= 0 && is_inside(((step % SIZE) * 2 + 1) << (SUBPIXEL_BITS - 1),
                                                       ((step / SIZE) * 2 + 1) << (SUBPIXEL_BITS - 1));
  assign ready_o  = step < 0;

  always_ff @(posedge clk_i or negedge rst_ni)
    if (!rst_ni) step <= -1;
    else if (ready_o) begin
      if (valid_i) step <= 0;
      {corner_x, corner_y, color_o} <= {corner_x_i, corner_y_i, color_i};
    end else if (!valid_o || ready_i) step <= is_end_o ? -1 : step + 1;
endmodule
