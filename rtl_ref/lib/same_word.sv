// Same word: whether two words are equal, by a carry chain over pairs of their bits. Combinational, for a word that comes
// late: synthesis that does not know when it comes makes gates in series of a plain comparison.
module same_word #(
    parameter int WIDTH = 1  // bits of a word
) (
    input  logic [WIDTH-1:0] a_i,
    input  logic [WIDTH-1:0] b_i,
    output logic             same_o
);

  localparam int PAIRS = (WIDTH + 1) / 2;
  logic [2*PAIRS-1:0] differs;
  logic [PAIRS-1:0]   same;
  logic [PAIRS:0]     sum;  // a one runs through pairs that are equal
  assign differs = (2 * PAIRS)'(a_i) ^ (2 * PAIRS)'(b_i);
  always_comb for (int i = 0; i < PAIRS; i++) same[i] = differs[2*i+:2] == '0;
  add_or_subtract #(
      .WIDTH(PAIRS + 1)
  ) u_sum (
      .subtracts_i(1'b0),
      .a_i        ({1'b0, same}),
      .b_i        ((PAIRS + 1)'(1)),
      .sum_o      (sum)
  );
  assign same_o = sum[PAIRS];

endmodule
