
  // From the product to the colour, for any product: times 2^x, to the nearest code, half up, and clamped to the range
  // of the vertices. So a colour lies between those of the vertices, and packing to rgb565, in which a code of 8 bits
  // may not show, hides no error.
  localparam int BITS = MANTISSA + NARROW + 9;
  logic signed [BITS-1:0] scaled;
  logic signed [BITS:0]   rounded;
  logic signed [11:0]     nearest_q;
  logic [7:0]             held_q, least_q, greatest_q;
  logic                   has_past_q, has_two_q;
  initial has_past_q = 1'b0;
  initial has_two_q = 1'b0;
  assign scaled  = $signed({{8{gen_channel[0].product_q[MANTISSA+NARROW]}}, gen_channel[0].product_q}) <<< reach;
  assign rounded = $signed({scaled[BITS-1], scaled}) + $signed((BITS + 1)'(1) << (MANTISSA + NARROW - 2));
  always_ff @(posedge clk_i) begin
    has_past_q <= 1'b1;
    has_two_q  <= has_past_q;
    nearest_q  <= 12'(rounded >>> (MANTISSA + NARROW - 1));
    held_q     <= nearest_q < $signed({4'd0, least}) ? least : nearest_q > $signed({4'd0, greatest}) ? greatest : nearest_q[7:0];
    least_q    <= least;
    greatest_q <= greatest;
  end
  always_comb begin
    assume (reach <= 4'd8 && least <= greatest);
    if (has_past_q) assert (gen_channel[0].code_q == nearest_q[10:0] && nearest_q[11] == nearest_q[10]);
    if (has_two_q) begin
      assert (color_o == held_q);
      assert (color_o >= least_q && color_o <= greatest_q);
    end
    cover (has_two_q && color_o > least_q && color_o < greatest_q);
  end
