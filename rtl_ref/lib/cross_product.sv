// Cross product: a * d - b * c, the one multiplication of the pipeline: edge functions and plane numerators. Two
// multipliers; result two cycles after start, one start per cycle.
module cross_product #(
    parameter int A_BITS = 2,  // of a and b, signed
    parameter int D_BITS = 2,  // of c and d, signed
    parameter int OUT_BITS = 4  // of the result, signed: the caller has proven that it fits, or wants a residue
) (
    input  logic                       clk_i,
    input  logic                       rst_ni,
    input  logic                       start_i,
    input  logic signed [A_BITS-1:0]   a_i,
    input  logic signed [A_BITS-1:0]   b_i,
    input  logic signed [D_BITS-1:0]   c_i,
    input  logic signed [D_BITS-1:0]   d_i,
    output logic                       done_o,   // for one cycle, with the result
    output logic signed [OUT_BITS-1:0] result_o
);

  logic signed [A_BITS+D_BITS-1:0] ad_q, bc_q;
  logic                            product_valid_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      product_valid_q <= 1'b0;
      done_o          <= 1'b0;
    end else begin
      product_valid_q <= start_i;
      done_o          <= product_valid_q;
    end
  end

  always_ff @(posedge clk_i) begin
    ad_q     <= a_i * d_i;
    bc_q     <= b_i * c_i;
    result_o <= OUT_BITS'(ad_q - bc_q);
  end

endmodule
