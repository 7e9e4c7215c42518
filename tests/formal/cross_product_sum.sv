
  // The result for the last cycle's operands, whatever the products are: their difference less the bias; it stays
  // without an enable.
  logic signed [A_BITS+D_BITS+1:0] expected;
  logic signed [OUT_BITS-1:0]      kept_q, expected_q;
  logic                            enabled_q, has_past_q;
  assign expected = (A_BITS + D_BITS + 2)'(ad_q) - (A_BITS + D_BITS + 2)'(bc_q) - (A_BITS + D_BITS + 2)'($signed({1'b0, bias_q}));
  initial has_past_q = 1'b0;
  always_ff @(posedge clk_i) begin
    has_past_q <= 1'b1;
    enabled_q  <= enable_i;
    kept_q     <= result_o;
    expected_q <= OUT_BITS'(expected);
  end
  always_comb if (has_past_q) assert (result_o == (enabled_q ? expected_q : kept_q));
