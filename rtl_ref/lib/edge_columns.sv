// Edge columns: which pixels of a row of a tile are outside an edge, by the sign of its edge function at each pixel.
//
// Along a row the value rises or falls, so its sign changes once: a binary search finds that column, one bit of it at
// each step, and looks at log2(2^OFFSET) values instead of all. It begins in the middle and goes on, half as far each
// time, towards the change of sign, to column k: the columns after k are beyond the change. The value itself says
// whether column 0 is.
module edge_columns #(
    parameter int WIDTH  = 1,  // bits of a value; the caller has proven that the value fits in every column
    parameter int OFFSET = 1   // bits of a column
) (
    input  logic signed [WIDTH-1:0]     value_i,   // in column 0
    input  logic signed [WIDTH-1:0]     step_x_i,
    output logic        [2**OFFSET-1:0] outside_o  // by column
);

  logic              rises;
  logic [OFFSET-1:0] column;  // k
  assign rises = !step_x_i[WIDTH-1];

  genvar b, i;
  generate
    for (b = OFFSET; b >= 0; b--) begin : gen_look  // OFFSET: at column 0; below: for bit b of k
      logic signed [WIDTH-1:0] value;
      logic is_outside;
      if (b == OFFSET) begin : gen_first
        assign value = value_i;
      end else begin : gen_moved
        logic is_before;  // columns beyond the change of sign
        logic goes_left;
        logic [WIDTH-1:0] from;
        logic [WIDTH-b-1:0] moved;  // a step of 2^b columns leaves the bits below as they are
        if (b == OFFSET - 1) begin : gen_right
          assign goes_left = 1'b0;
        end else begin : gen_either
          assign goes_left = !gen_look[b+1].gen_moved.is_before;
        end
        assign from = gen_look[b+1].value;
        add_or_subtract #(
            .WIDTH(WIDTH - b)
        ) u_moved (
            .subtracts_i(goes_left),
            .a_i        (from[WIDTH-1:b]),
            .b_i        (step_x_i[WIDTH-b-1:0]),
            .sum_o      (moved)
        );
        assign value     = (WIDTH'(moved) << b) | (from & WIDTH'((1 << b) - 1));
        assign is_before = is_outside == rises;
        assign column[b] = is_before;
      end
      assign is_outside = value[WIDTH-1];
    end
    assign outside_o[0] = gen_look[OFFSET].is_outside;
    for (i = 1; i < 2 ** OFFSET; i++) begin : gen_column
      assign outside_o[i] = (OFFSET'(i) > column) != rises;
    end
  endgenerate

endmodule
