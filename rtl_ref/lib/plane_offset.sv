// Plane offset, from the centre of a tile to either side: value + offset * step modulo 2^WIDTH, by shifts and adds;
// offset is two's complement. Its two highest bits together are one digit out of -2, -1, 0, 1: three bits, two adders.
module plane_offset #(
    parameter int WIDTH  = 4,  // bits of a value
    parameter int OFFSET = 3,  // bits of the offset, at least 2
    parameter int LOWEST = 0   // bits of the offset below this one are 0
) (
    input  logic [WIDTH-1:0]  value_i,
    input  logic [WIDTH-1:0]  step_i,
    input  logic [OFFSET-1:0] offset_i,
    output logic [WIDTH-1:0]  value_o
);

  // A negative digit is added as a complement; the missing 1 comes in as a carry from one bit below.
  logic             is_negative, is_odd;
  logic [WIDTH-1:0] digit;
  logic [WIDTH:0]   total;
  assign is_negative = offset_i[OFFSET-1];
  assign is_odd      = offset_i[OFFSET-2];
  always_comb begin
    digit = is_odd ? step_i << (OFFSET - 2) : '0;
    if (is_negative) digit = is_odd ? ~(step_i << (OFFSET - 2)) : ~(step_i << (OFFSET - 1));
  end
  assign total = {value_i, 1'b1} + {digit, is_negative};

  always_comb begin
    value_o = total[WIDTH:1];
    for (int b = LOWEST; b < OFFSET - 2; b++) value_o = value_o + (offset_i[b] ? step_i << b : '0);
  end

endmodule
