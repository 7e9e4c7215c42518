// Cross product: a * d - b * c - bias, the only multiplication in edge functions and plane numerators. Two multipliers;
// the result comes two enabled cycles after its operands, one result per cycle.
module cross_product #(
    parameter int A_BITS = 2,  // of a and b, signed
    parameter int D_BITS = 2,  // of c and d, signed
    parameter int OUT_BITS = 4  // of the result, signed: the caller has proven that it fits, or wants the residue
) (
    input  logic                       clk_i,
    input  logic                       enable_i,
    input  logic signed [A_BITS-1:0]   a_i,
    input  logic signed [A_BITS-1:0]   b_i,
    input  logic signed [D_BITS-1:0]   c_i,
    input  logic signed [D_BITS-1:0]   d_i,
    input  logic                       bias_i,
    output logic signed [OUT_BITS-1:0] result_o
);

  logic signed [A_BITS+D_BITS-1:0] ad_q, bc_q;
  logic                            bias_q;

  // x - y - bias = x + ~y + (1 - bias): the bias is a carry that comes in from one bit below.
  logic signed [A_BITS+D_BITS+1:0] sum;
  assign sum = {ad_q[A_BITS+D_BITS-1], ad_q, 1'b1} + {~bc_q[A_BITS+D_BITS-1], ~bc_q, !bias_q};

  always_ff @(posedge clk_i) begin
    if (enable_i) begin
      ad_q     <= a_i * d_i;
      bc_q     <= b_i * c_i;
      bias_q   <= bias_i;
      result_o <= OUT_BITS'(sum >>> 1);
    end
  end

endmodule
