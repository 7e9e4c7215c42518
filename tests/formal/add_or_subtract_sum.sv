
  always_comb assert (sum_o == (subtracts_i ? a_i - b_i : a_i + b_i));
