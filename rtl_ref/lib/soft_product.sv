// Product of two short numbers where multipliers are expensive: rows for pairs of the left factor's bits, added as a
// tree.
module soft_product (
    input  logic        [7:0]  left_i,  // unsigned
    input  logic signed [8:0]  right_i,
    output logic signed [16:0] product_o
);

  logic signed [10:0] pair_0, pair_1, pair_2, pair_3;
  logic signed [12:0] low, high;
  function automatic signed [10:0] row_pair(input [1:0] bits, input signed [8:0] right);
    row_pair = (bits[0] ? 11'(right) : '0) + (bits[1] ? 11'(right) <<< 1 : '0);
  endfunction
  assign pair_0    = row_pair(left_i[1:0], right_i);
  assign pair_1    = row_pair(left_i[3:2], right_i);
  assign pair_2    = row_pair(left_i[5:4], right_i);
  assign pair_3    = row_pair(left_i[7:6], right_i);
  assign low       = 13'(pair_0) + (13'(pair_1) <<< 2);
  assign high      = 13'(pair_2) + (13'(pair_3) <<< 2);
  assign product_o = 17'(low) + (17'(high) <<< 4);

endmodule
