// Reciprocal of a normalised 1/w, one a clock: floor(2^(2k) / d), d = 2m + 1, k = BITS, by restoring division.
//
// The k subtractions of reciprocal_restoring.sv stand here in rows, a quarter of them between two registers: four
// clocks from mantissa to result, as in reciprocal_table.sv, without its RAM and multipliers. A fixed pipeline without
// enables: the user counts the clocks. Specification: model/stages/reciprocal.hpp.
module reciprocal_division #(
    parameter int BITS = 18  // k: bits of m and of the reciprocal; a subtraction row each
) (
    input logic clk_i,

    input  logic [BITS-2:0] mantissa_i,   // m below its highest bit, which is set
    output logic [BITS-1:0] reciprocal_o  // for the mantissa of four clocks ago; the highest bit is set
);

  localparam int CLOCKS = 4;
  localparam int STEPS = (BITS - 1 + CLOCKS - 1) / CLOCKS;  // quotient bits per clock; the highest bit is 1

  // From clock to clock: the divisor, the remainder (below d), the quotient bits so far without the highest.
  logic [CLOCKS*(BITS-1)-1:0] mantissa_q;
  logic [CLOCKS*(BITS+1)-1:0] left_q;
  logic [CLOCKS*(BITS-1)-1:0] bits_q;
  genvar c;
  generate
    for (c = 0; c < CLOCKS; c++) begin : gen_clock
      localparam int LAST = (c + 1) * STEPS < BITS - 1 ? STEPS : BITS - 1 - c * STEPS;
      logic [BITS-2:0] mantissa, bits_d, bits;
      logic [BITS:0]   left, left_d;
      logic [BITS+1:0] trial;  // its highest bit: negative
      if (c == 0) begin : gen_first
        assign mantissa = mantissa_i;
        assign left     = {1'b0, ~mantissa_i, 1'b1};  // the remainder of 2^(k+1) after the highest bit: -d modulo 2^(k+1)
        assign bits     = '0;
      end else begin : gen_next
        assign mantissa = mantissa_q[(c-1)*(BITS-1)+:BITS-1];
        assign left     = left_q[(c-1)*(BITS+1)+:BITS+1];
        assign bits     = bits_q[(c-1)*(BITS-1)+:BITS-1];
      end
      always_comb begin
        left_d = left;
        bits_d = bits;
        trial  = '0;
        for (int i = 0; i < LAST; i++) begin
          trial  = {left_d, 1'b0} - {2'b01, mantissa, 1'b1};
          left_d = trial[BITS+1] ? {left_d[BITS-1:0], 1'b0} : trial[BITS:0];
          bits_d = {bits_d[BITS-3:0], !trial[BITS+1]};
        end
      end
      always_ff @(posedge clk_i) begin
        mantissa_q[c*(BITS-1)+:BITS-1] <= mantissa;
        left_q[c*(BITS+1)+:BITS+1]     <= left_d;
        bits_q[c*(BITS-1)+:BITS-1]     <= bits_d;
      end
    end
  endgenerate
  assign reciprocal_o = {1'b1, bits_q[(CLOCKS-1)*(BITS-1)+:BITS-1]};

endmodule
