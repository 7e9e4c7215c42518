// Which of the four banks of lines a sample uses: one for each of its blocks, by the lowest bits of their columns and rows.
// Combinational. Specification: wants() of model/stages/texture_unit.hpp.
module texture_uses #(
    parameter int ENDS = 1  // texels of a sample along an axis: 1 or 2
) (
    input  logic [2*ENDS-1:0] odd_i,  // lowest bit of each texel's block along x and along y; the first texel lowest
    output logic [3:0]        uses_o  // columns lowest
);

  logic [1:0] columns, rows;  // uses an even one, an odd one
  assign columns = {odd_i[0] || odd_i[2*(ENDS-1)], !odd_i[0] || !odd_i[2*(ENDS-1)]};
  assign rows    = {odd_i[1] || odd_i[2*(ENDS-1)+1], !odd_i[1] || !odd_i[2*(ENDS-1)+1]};
  assign uses_o  = {{2{rows[1]}} & columns, {2{rows[0]}} & columns};

endmodule
