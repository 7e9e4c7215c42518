
  // A stamp of the stream, any: it leaves as the fragment of its turn, with what the context RAM answered for it.
  (* anyseq *) logic pick;
  logic       inside_q, done_q;
  logic [2:0] ahead_q;  // fragments that leave before it
  logic [4:0] at_q;     // the step that it is in: context, x, y, samples, codes
  logic [2:0] count_q;  // in the pipeline
  raster_pkg::stamp_packet_t   g_q;
  /* verilator lint_off UNUSEDSIGNAL */
  raster_pkg::context_packet_t context_q;
  /* verilator lint_on UNUSEDSIGNAL */
  logic enters, leaves, picks;
  assign enters = stamp_valid_i && stamp_ready_o;
  assign leaves = fragment_valid_o && fragment_ready_i;
  assign picks  = enters && pick && !inside_q && !done_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      inside_q <= 1'b0;
      done_q   <= 1'b0;
      count_q  <= '0;
      at_q     <= '0;
    end else begin
      count_q <= count_q + 3'(enters) - 3'(leaves);
      if (picks) begin
        inside_q <= 1'b1;
        g_q      <= stamp_i;
        ahead_q  <= count_q - 3'(leaves);
        at_q     <= 5'b00001;
      end else if (inside_q) begin
        if (leaves) ahead_q <= ahead_q - 3'd1;
        if (at_q[0] && x_ready) context_q <= context_i;
        if ((at_q & {codes_ready, samples_ready, y_ready, x_ready, 1'b0} >> 1) != '0) at_q <= at_q << 1;
        if (leaves && ahead_q == '0) begin
          inside_q <= 1'b0;
          done_q   <= 1'b1;
          at_q     <= '0;
        end
      end
    end
  end
  logic [4:0] valid;
  assign valid = {codes_valid_q, samples_valid_q, y_valid_q, x_valid_q, context_valid_q};
  function automatic [2:0] ones(input [4:0] bits);
    ones = 3'(bits[0]) + 3'(bits[1]) + 3'(bits[2]) + 3'(bits[3]) + 3'(bits[4]);
  endfunction
  always_comb if (runs_q) begin
    assert (count_q == ones(valid));
    assert (inside_q == (at_q != '0) && (at_q & (at_q - 5'd1)) == '0 && (at_q & ~valid) == '0);
    if (inside_q) assert (ahead_q == ones(valid & ~(at_q | (at_q - 5'd1))) && !done_q);
    if (at_q[0]) assert (context_stamp_q == g_q);
    if (at_q[1]) assert (x_stamp_q == g_q && x_context_q == context_q);
    if (at_q[2]) assert (y_stamp_q == g_q && y_context_q == context_q);
    if (at_q[3]) assert (samples_stamp_q == g_q && samples_context_q == context_q);
    if (at_q[4]) assert (codes_stamp_q == g_q && codes_context_q == context_q);
    if (leaves && inside_q && ahead_q == '0) begin
      assert (at_q[4]);
      assert (fragment_o.kind == g_q.kind && fragment_o.ends_visit == g_q.ends_visit &&
              fragment_o.ends_primitive == g_q.ends_primitive && fragment_o.key == g_q.key &&
              fragment_o.stamp == g_q.stamp && fragment_o.mask == g_q.mask && fragment_o.state == context_q.state);
    end
    if (fragment_ready_i) assert (stamp_ready_o);  // no deadlock
    cover (done_q);
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    if ($past(fragment_valid_o && !fragment_ready_i)) assert (fragment_valid_o && fragment_o == $past(fragment_o));
    // A slot is freed once for the stamp that ends its primitive: as that stamp leaves the context.
    assert (slot_free_o == $past(context_valid_q && x_ready && context_stamp_q.ends_primitive));
  end
