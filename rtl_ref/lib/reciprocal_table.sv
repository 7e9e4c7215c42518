// Reciprocal of a normalised 1/w, one a clock: floor(2^(2k) / d), d = 2m + 1, k = BITS. Four clocks from mantissa to result.
//
//   line_q     line of m's interval: the value where it begins and the drop over the interval, in halves
//   guess_q    the value on the line: the floor or one more
//   product_q  guess * d. 2^(2k) is 0 modulo 2^(k+2), and the guess is off by less than 2: the sign decides
//   reciprocal_o
// A fixed pipeline without enables: who uses it counts the clocks. Specification: model/stages/reciprocal.hpp.
module reciprocal_table #(
    parameter int BITS = 18  // k: bits of m and of the reciprocal; 2^((k + 1) / 2) words of ROM
) (
    input logic clk_i,

    input  logic [BITS-2:0] mantissa_i,   // m below its highest bit, which is set
    output logic [BITS-1:0] reciprocal_o  // for the mantissa of four clocks ago; its highest bit is set
);

  localparam int INTERVAL = (BITS + 1) / 2;
  localparam int PLACE = BITS - 1 - INTERVAL;
  localparam int LINES = 1 << INTERVAL;
  localparam int DROP = BITS / 2 + 1;
  localparam int SUM = BITS + 1 + PLACE;
  localparam int CHECK = BITS + 2;

  // 2^(2k) / d in halves, rounded, at the start of interval n.
  function automatic [63:0] node(input [63:0] n);
    node = ((64'd1 << (2 * BITS + 2)) / ((((64'd1 << INTERVAL) + n) << (PLACE + 1)) + 64'd1) + 64'd1) >> 1;
  endfunction

  // The highest bit of a start, 2^k halves, is always set and is not stored.
  (* rom_style = "block", syn_romstyle = "block_rom" *) logic [BITS+DROP-1:0] line_rom[0:LINES-1];
  initial begin
    for (int n = 0; n < LINES; n++)
      line_rom[n] = {BITS'(node(64'(n)) + 64'd1), DROP'(node(64'(n)) - node(64'(n) + 64'd1))};
  end

  logic [BITS+DROP-1:0] line_q;
  logic [BITS-2:0]      line_mantissa_q, guess_mantissa_q;
  logic [SUM-1:0]       on_line;  // truncated to an integer
  logic [BITS-1:0]      guess_q, product_guess_q;
  logic                 is_too_large_q;
  logic [CHECK-1:0]     product;

  assign on_line = {1'b1, line_q[DROP+:BITS], {PLACE{1'b0}}} - SUM'(line_q[0+:DROP]) * SUM'(line_mantissa_q[0+:PLACE]);
  assign product = CHECK'(guess_q) * CHECK'({1'b1, guess_mantissa_q, 1'b1});

  always_ff @(posedge clk_i) begin
    line_q           <= line_rom[mantissa_i[PLACE+:INTERVAL]];
    line_mantissa_q  <= mantissa_i;
    guess_q          <= on_line[PLACE+1+:BITS];
    guess_mantissa_q <= line_mantissa_q;
    product_guess_q  <= guess_q;
    is_too_large_q   <= !product[CHECK-1];
    reciprocal_o     <= product_guess_q - BITS'(is_too_large_q);
  end

endmodule
