
  // Start of a level: the sum of the blocks of all larger levels, and one block more after the first level of one
  // block; for all sides, 2^0 to 2^12 texels, and levels. The image lies below the start's bits, so that the two can be
  // ORed.
  function automatic [3:0] blocks_of(input [3:0] log2_size);  // log2
    blocks_of = log2_size[3:1] == '0 ? 4'd0 : log2_size - 4'd2;
  endfunction
  (* anyconst *) logic [3:0] any_wide, any_high;
  logic       is_set_q;
  logic [3:0] scaled_level_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) is_set_q <= 1'b0;
    else if (sets_state_i) is_set_q <= 1'b1;
    if (scales) scaled_level_q <= level;
  end
  // Blocks of level n and of all before it; a counter runs along.
  logic [20:0] before;
  logic [3:0]  wide, high;
  always_comb begin
    wide   = blocks_of(any_wide);
    high   = blocks_of(any_high);
    before = 21'(scaled_level_q > (wide > high ? wide : high));
    for (int n = 0; n < 10; n++) begin
      if (4'(n) < scaled_level_q && (wide != '0 || high != '0))
        before = before + (21'd1 << ({1'b0, wide} + {1'b0, high}));
      wide = wide - 4'(wide != '0);
      high = high - 4'(high != '0);
    end
  end
  logic [3:0] any_longest;
  assign any_longest = any_wide > any_high ? any_wide : any_high;
  always_comb begin
    assume (any_wide <= 4'd12 && any_high <= 4'd12);
    if (sets_state_i) assume (log2_size_i == {any_high, any_wide} && is_empty_o);
    if (valid_i) assume (is_set_q && !sets_state_i && level <= any_longest);
    if (runs_q) begin
      if (is_set_q) begin
        assert (log2_size_q == {any_high, any_wide} && wide_q == blocks_of(any_wide) && high_q == blocks_of(any_high));
        assert (first_of_one_q == (wide_q > high_q ? wide_q : high_q));
        for (int i = 0; i < 21; i++)
          assert (ones_q[i] == (i <= 32'(wide_q) + 32'(high_q) &&
                                (i <= 32'(first_of_one_q) - (32'(wide_q) + 32'(high_q) - 32'(first_of_one_q)) ||
                                 ((i ^ (32'(wide_q) + 32'(high_q))) & 1) == 0)));
      end
      if (scaled_valid_q) begin
        assert (is_set_q && scaled_level_q <= any_longest);
        assert (wide_now_q == less(wide_q, scaled_level_q) && high_now_q == less(high_q, scaled_level_q));
        assert (is_small_q == (scaled_level_q > first_of_one_q));
        assert (is_corner_q == (scaled_level_q == first_of_one_q + 4'd2));
        assert (begins == before);
        assert ((begins & ((21'd1 << blocks) - 21'd1)) == '0);
        assert (!is_corner_q || (wide_now_q == '0 && high_now_q == '0));
      end
      cover (scaled_valid_q && is_corner_q);
    end
  end
