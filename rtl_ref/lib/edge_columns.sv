// Edge columns: which pixels of a row of a tile are outside an edge, by the sign of its edge function at each pixel.
//
// Along a row the value rises or falls, so its sign changes once: a binary search finds that column, one bit of it at
// each step, and looks at log2(2^OFFSET) values instead of all. It begins in the middle and goes on, half as far each
// time, towards the change of sign, to column k: the columns after k are beyond the change. The value itself says
// whether column 0 is. The value in the middle is given: the caller has a shorter way to it. The search turns over its
// highest bit where the value rises, and with it that of every sum: so the bit is the next step's direction.
module edge_columns #(
    parameter int WIDTH  = 1,  // bits of a value; the caller has proven that the value fits in every column
    parameter int OFFSET = 1   // bits of a column
) (
    input  logic signed [WIDTH-1:0]     value_i,   // in column 0
    input  logic signed [WIDTH-1:0]     middle_i,  // in column 2^(OFFSET-1)
    input  logic signed [WIDTH-1:0]     step_x_i,
    output logic        [2**OFFSET-1:0] outside_o  // by column
);

  logic              rises;
  logic [OFFSET-1:0] column;  // k
  assign rises = !step_x_i[WIDTH-1];

  genvar b, i;
  generate
    for (b = OFFSET - 1; b >= 0; b--) begin : gen_look  // for bit b of k
      logic [WIDTH-1:0] value;  // its highest bit: not beyond the change of sign
      if (b == OFFSET - 1) begin : gen_middle
        assign value = {middle_i[WIDTH-1] ^ rises, middle_i[WIDTH-2:0]};
      end else begin : gen_moved
        logic [WIDTH-1:0]   from;
        logic [WIDTH-b-1:0] moved;  // a step of 2^b columns leaves the bits below as they are
        assign from = gen_look[b+1].value;
        add_or_subtract #(
            .WIDTH(WIDTH - b)
        ) u_moved (
            .subtracts_i(from[WIDTH-1]),
            .a_i        (from[WIDTH-1:b]),
            .b_i        (step_x_i[WIDTH-b-1:0]),
            .sum_o      (moved)
        );
        assign value = (WIDTH'(moved) << b) | (from & WIDTH'((1 << b) - 1));
      end
      assign column[b] = !value[WIDTH-1];
    end
    assign outside_o[0] = value_i[WIDTH-1];
    for (i = 1; i < 2 ** OFFSET; i++) begin : gen_column
      assign outside_o[i] = (OFFSET'(i) > column) != rises;
    end
  endgenerate

endmodule
