
  // The verdict is that of the order of the two values.
  always_comb assert (passes_o == (value_i < other_i ? less_i : value_i == other_i ? equal_i : greater_i));
