
  // An arbitrary stamp of the stream: four cycles later its fragment enters the FIFO, with the context RAM's answer for
  // it, and there is a place. The FIFO is cut out; registered_fifo_stream is assumed: it takes ROOM.
  (* anyseq *) logic pick;
  logic       done_q;
  logic [3:0] at_q;        // its step: context, x, y, samples
  logic [USED-1:0] held_q; // in the FIFO, or on offer
  raster_pkg::stamp_packet_t   g_q;
  raster_pkg::context_packet_t context_q;
  logic picks;
  assign picks = takes && pick && at_q == '0 && !done_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      done_q <= 1'b0;
      at_q   <= '0;
      held_q <= '0;
    end else begin
      at_q   <= picks ? 4'b0001 : at_q << 1;
      done_q <= done_q || at_q[3];
      held_q <= held_q + USED'(samples_valid_q && made_ready) - USED'(fragment_valid_o && fragment_ready_i);
    end
    if (picks) g_q <= stamp_i;
    if (at_q[0]) context_q <= context_i;
  end
  always_comb assume (made_ready == (held_q != USED'(ROOM)) && !(fragment_valid_o && held_q == '0));
  logic [3:0] valid;
  assign valid = {samples_valid_q, y_valid_q, x_valid_q, context_valid_q};
  always_comb if (runs_q) begin
    assert (used_q == held_q + USED'(valid[0]) + USED'(valid[1]) + USED'(valid[2]) + USED'(valid[3]));
    assert (used_q <= USED'(ROOM) && held_q <= USED'(ROOM) && has_room_q == (used_q != USED'(ROOM)));
    if (samples_valid_q) assert (made_ready);
    assert ((at_q & (at_q - 4'd1)) == '0 && (at_q & ~valid) == '0 && !(done_q && at_q != '0));
    if (at_q[0]) assert (context_stamp_q == g_q);
    if (at_q[1]) assert (x_stamp_q == g_q && x_context_q == context_q);
    if (at_q[2]) assert (y_stamp_q == g_q && y_context_q == context_q);
    if (at_q[3]) assert (samples_stamp_q == g_q && samples_context_q == context_q);
    if (at_q[3])
      assert (made.kind == g_q.kind && made.ends_visit == g_q.ends_visit && made.ends_primitive == g_q.ends_primitive &&
              made.key == g_q.key && made.stamp == g_q.stamp && made.mask == g_q.mask && made.state == context_q.state);
    if (!stamp_ready_o) assert (held_q != '0 || valid != '0);  // no deadlock: stamps under way get there
    cover (done_q && !stamp_ready_o);
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    // A slot is freed once for the stamp that ends its primitive: as that stamp leaves the context.
    assert (slot_free_o == $past(context_valid_q && context_stamp_q.ends_primitive));
  end
