// Reciprocal of a normalised 1/w, one bit per clock: floor(2^(2k) / d), d = 2m + 1, k = BITS, by restoring division.
//
// The highest bit of the quotient is always 1: the remainder of 2^(k+1) after it is -d modulo 2^(k+1), and k - 1 bits
// remain. The result is offered k clocks after the mantissa is taken. Specification: model/stages/reciprocal.hpp.
module reciprocal_restoring #(
    parameter int BITS = 18  // k: bits of m and of the reciprocal; a clock each
) (
    input logic clk_i,
    input logic rst_ni,

    input  logic            valid_i,
    output logic            ready_o,
    input  logic [BITS-2:0] mantissa_i,  // m below its highest bit, which is set

    output logic            valid_o,
    input  logic            ready_i,
    output logic [BITS-1:0] reciprocal_o
);

  logic            is_busy_q;
  logic [BITS-2:0] mantissa_q;
  logic [BITS:0]   remainder_q;  // below d
  logic [BITS-1:0] quotient_q;   // a 1 in front of the bits so far
  logic [BITS+1:0] trial;        // its highest bit: negative
  logic            is_done;

  assign is_done      = quotient_q[BITS-1];
  assign ready_o      = !is_busy_q;
  assign valid_o      = is_busy_q && is_done;
  assign reciprocal_o = quotient_q;
  assign trial        = {remainder_q, 1'b0} - {2'b01, mantissa_q, 1'b1};

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) is_busy_q <= 1'b0;
    else if (ready_o) is_busy_q <= valid_i;
    else if (valid_o && ready_i) is_busy_q <= 1'b0;
  end

  always_ff @(posedge clk_i) begin
    if (ready_o) begin
      mantissa_q  <= mantissa_i;
      remainder_q <= {1'b0, ~mantissa_i, 1'b1};
      quotient_q  <= BITS'(1);
    end else if (!is_done) begin
      remainder_q <= trial[BITS+1] ? {remainder_q[BITS-1:0], 1'b0} : trial[BITS:0];
      quotient_q  <= {quotient_q[BITS-2:0], !trial[BITS+1]};
    end
  end

endmodule
