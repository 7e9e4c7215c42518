// Cross product: a * d - b * c, the one multiplication of the pipeline: edge functions, plane numerators, and (with b = 0)
// their products with the reciprocal.
//
// SERIAL = 0: two multipliers, result two cycles after start, one start per cycle. SERIAL = 1: one bit of c and d per
// cycle, from the highest down, two adders: result D_BITS + 1 cycles after start; a...d must stay until done_o.
module cross_product #(
    parameter int A_BITS = 2,  // of a and b, signed
    parameter int D_BITS = 2,  // of c and d, signed
    parameter int OUT_BITS = 4,  // of the result, signed: the caller has proven that it fits, or wants a residue
    parameter int SERIAL = 0
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

  generate
    if (SERIAL == 0) begin : gen_parallel
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
    end else begin : gen_serial
      localparam int COUNT_BITS = $clog2(D_BITS + 1);
      logic [COUNT_BITS-1:0] count_q;  // bits still to do
      logic [D_BITS-1:0]     c_q, d_q;
      logic                  is_sign_q;  // the highest bit counts negative

      logic signed [OUT_BITS-1:0] ad, bc;
      assign ad = d_q[D_BITS-1] ? OUT_BITS'(a_i) : '0;
      assign bc = c_q[D_BITS-1] ? OUT_BITS'(b_i) : '0;

      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          count_q <= '0;
          done_o  <= 1'b0;
        end else begin
          done_o <= count_q == COUNT_BITS'(1);
          if (start_i) count_q <= COUNT_BITS'(D_BITS);
          else if (count_q != '0) count_q <= count_q - COUNT_BITS'(1);
        end
      end

      always_ff @(posedge clk_i) begin
        is_sign_q <= start_i;
        if (start_i) begin
          c_q      <= c_i;
          d_q      <= d_i;
          result_o <= '0;
        end else if (count_q != '0) begin
          c_q      <= c_q << 1;
          d_q      <= d_q << 1;
          result_o <= is_sign_q ? (result_o <<< 1) + bc - ad : (result_o <<< 1) + ad - bc;
        end
      end
    end
  endgenerate

endmodule
