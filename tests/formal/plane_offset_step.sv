
  // value + n step modulo 2^WIDTH, n in two's complement as the sum of its bits; the lowest LOWEST are 0.
  logic [WIDTH-1:0] high, sum;
  assign high = value_i + (offset_i[OFFSET-2] ? step_i << (OFFSET - 2) : '0) -
                (offset_i[OFFSET-1] ? step_i << (OFFSET - 1) : '0);
  always_comb begin
    sum = high;
    for (int b = LOWEST; b < OFFSET - 2; b++) sum = sum + (offset_i[b] ? step_i << b : '0);
    assert (value_o == sum);
  end
