
  // value + x step_x + y step_y modulo 2^WIDTH, x and y as the sums of their bits, the highest first. Along one axis at
  // a time: the module is the same function twice, one after the other.
  function automatic [WIDTH-1:0] sum(input [WIDTH-1:0] value, input [OFFSET-1:0] n, input [WIDTH-1:0] step);
    sum = value;
    for (int b = OFFSET - 1; b >= 0; b--)
      sum = sum + (n[b] ? step << b : '0);
  endfunction
  always_comb begin
    if (y_i == '0) assert ($unsigned(value_o) == sum(value_i, x_i, step_x_i));
    if (x_i == '0) assert ($unsigned(value_o) == sum(value_i, y_i, step_y_i));
  end
