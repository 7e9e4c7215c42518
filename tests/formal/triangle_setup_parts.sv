
  // A triangle of the stream, any: in which of the three parts it is, and how many are ahead of it; what goes with the steps
  // of the parts. The multipliers' results may be anything.
  (* anyseq *) logic pick;
  logic       inside_q, done_q;
  logic [1:0] ahead_q;  // setups that leave before it
  logic [1:0] count_q;  // in the three parts
  logic [2:0] at_q;     // the part that it is in
  var raster_pkg::triangle_packet_t it_q;
  logic enters, leaves, picks;
  logic [2:0] busy;
  assign enters = triangle_valid_i && triangle_ready_o;
  assign leaves = setup_valid_o && setup_ready_i;
  assign picks  = enters && pick && !inside_q && !done_q;
  assign busy   = {value_busy_q, gradient_busy_q, divide_busy_q};
  function automatic [1:0] ones(input [2:0] bits);
    ones = 2'(bits[0]) + 2'(bits[1]) + 2'(bits[2]);
  endfunction
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      inside_q <= 1'b0;
      done_q   <= 1'b0;
      count_q  <= '0;
      at_q     <= '0;
    end else begin
      count_q <= count_q + 2'(enters) - 2'(leaves);
      if (picks) begin
        inside_q <= 1'b1;
        it_q     <= triangle_i;
        ahead_q  <= count_q - 2'(leaves);
        at_q     <= 3'b001;
      end else if (inside_q) begin
        if (leaves) ahead_q <= ahead_q - 2'd1;
        if ((at_q & {1'b0, gradient_hands_over, divide_hands_over}) != '0) at_q <= at_q << 1;
        if (leaves && ahead_q == '0) begin
          inside_q <= 1'b0;
          done_q   <= 1'b1;
          at_q     <= '0;
        end
      end
    end
  end
  always_comb if (runs_q) begin
    assert (count_q == ones(busy));
    assert (inside_q == (at_q != '0) && (at_q & (at_q - 3'd1)) == '0 && (at_q & ~busy) == '0);
    if (inside_q) assert (ahead_q == ones(busy & ~(at_q | (at_q - 3'd1))) && !done_q);
    // A part is never a step behind the one before it.
    if (divide_busy_q && gradient_busy_q) assert (gradient_step_q >= divide_step_q || gradient_step_q == STEP'(GRADIENT_LAST));
    if (gradient_busy_q && value_busy_q) assert (value_step_q >= gradient_step_q || value_step_q == STEP'(VALUE_LAST));
    assert (divide_step_q <= STEP'(DIVIDE_LAST) && gradient_step_q <= STEP'(GRADIENT_LAST) && value_step_q <= STEP'(VALUE_LAST));
    if (!divide_busy_q) assert (!issues_numerator);
  end
  // The numerators are with the cross products for two cycles.
  logic issued_q;
  always_ff @(posedge clk_i) issued_q <= rst_ni && issues_numerator;
  always_comb if (runs_q && divide_busy_q) begin
    assert (issued_q == (divide_step_q >= STEP'(2) && divide_step_q <= STEP'(PLANES + 1)));
    assert (numerator_done == (divide_step_q >= STEP'(3) && divide_step_q <= STEP'(PLANES + 2)));
  end
  always_comb if (runs_q && !divide_busy_q) assert (!issued_q && !numerator_done);
