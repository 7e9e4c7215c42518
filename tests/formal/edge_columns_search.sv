
  // The sign of value + column step in every column, in so many bits that no sum wraps; the values of the first and of
  // the last column fit, so all between them fit. The value in the middle is given as what it is.
  localparam int WIDE = WIDTH + OFFSET + 1;
  always_comb assume (middle_i == value_i + (step_x_i <<< (OFFSET - 1)));
  genvar c;
  generate
    for (c = 0; c < 2 ** OFFSET; c++) begin : gen_proof
      logic signed [WIDE-1:0] exact;
      always_comb begin
        exact = WIDE'(value_i);
        for (int k = OFFSET - 1; k >= 0; k--) if ((c >> k) & 1) exact = exact + (WIDE'(step_x_i) <<< k);
        if (c == 2 ** OFFSET - 1) assume (exact >= -(WIDE'(1) <<< (WIDTH - 1)) && exact < (WIDE'(1) <<< (WIDTH - 1)));
        assert (outside_o[c] == (exact < 0));
      end
    end
  endgenerate
