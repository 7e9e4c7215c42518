// Order test: whether a value passes a comparison with another one, by the orders in which it passes (passing_orders).
// Combinational, for an other value that comes late: two carry chains, and one gate after them.
//
// Passing is `at most, and not less`, or its complement; a chain that the comparison does not use is forced to the value
// that lets the other one decide, by a bit above its operands.
module order_test #(
    parameter int WIDTH = 1
) (
    input  logic             less_i,
    input  logic             equal_i,
    input  logic             greater_i,
    input  logic [WIDTH-1:0] value_i,
    input  logic [WIDTH-1:0] other_i,
    output logic             passes_o
);

  logic forces_less, forced_less, forces_at_most, is_less, is_at_most, is_inverted;
  assign forces_less    = less_i == equal_i;
  assign forced_less    = equal_i == greater_i;
  assign forces_at_most = equal_i == greater_i;
  assign is_inverted    = equal_i ? less_i && greater_i : less_i || greater_i;
  assign is_less        = {forces_less && !forced_less, value_i} < {forces_less && forced_less, other_i};
  assign is_at_most     = {1'b0, value_i, 1'b0} < {forces_at_most, other_i, 1'b1};
  assign passes_o       = (is_at_most && !is_less) ^ is_inverted;

endmodule
