
  // Every fragment with a covered sample, and every token, is one access; every covered one is one write a cycle later,
  // and the end of a visit one retirement another cycle later. Nothing waits after the access, so that this is
  // complete.
  logic sends_access;
  assign sends_access = access_valid_o && access_ready_i;
  always_comb if (runs_q) begin
    assert (sends_access == (takes_fragment && (fragment_i.mask != '0 || fragment_i.kind[1])));
    if (access_valid_o) assert (access_o == fragment_i);
    if (fragment_i.mask == '0 && !fragment_i.kind[1]) assert (fragment_ready_o);
    cover (must_wait && fragment_valid_i && access_ready_i);
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q)) begin
    assert (write_valid_o == $past(takes_fragment && fragment_i.mask != '0));
    if (write_valid_o) begin
      assert (write_o.key == $past(fragment_i.key) && write_o.stamp == $past(fragment_i.stamp));
      assert ((write_o.passed & ~$past(fragment_i.mask)) == '0);
      if ($past(fragment_i.state.depth_test) == raster_pkg::DEPTH_FUNC_ALWAYS) assert (write_o.passed == $past(fragment_i.mask));
      assert (write_o.write_depth == ($past(fragment_i.state.depth_write) ? write_o.passed : '0));
      assert (write_o.write_color == ($past(fragment_i.state.color_write) ? write_o.passed : '0));
      // A sample written one cycle after its access is not read by an access of this cycle.
      if (access_valid_o && write_o.write_depth != '0 && access_o.key.tile_x == write_o.key.tile_x &&
          access_o.key.tile_y == write_o.key.tile_y && access_o.stamp == write_o.stamp)
        assert ((write_o.write_depth & access_o.mask) == '0);
    end
    // An access on offer stays while its fragment does; no fragment waits for more than one cycle without an external
    // cause.
    if ($past(access_valid_o && !access_ready_i) && fragment_valid_i && fragment_i == $past(fragment_i))
      assert (access_valid_o);
    if ($past(must_wait && needs_access)) assert (!must_wait);
  end
  logic ended_q, ended_2_q;
  raster_pkg::fragment_packet_t before_q, before_2_q;
  always_ff @(posedge clk_i) begin
    ended_q    <= rst_ni && takes_fragment && fragment_i.ends_visit;
    ended_2_q  <= rst_ni && ended_q;
    before_q   <= fragment_i;
    before_2_q <= before_q;
  end
  always_comb if (runs_q) begin
    assert (retire_valid_o == ended_2_q);
    assert (ended_q == (valid_q && fragment_q.ends_visit) && fragment_q == before_q);
    if (retire_valid_o) assert (retire_o.key == before_2_q.key);
    assert (retire_key_q == before_2_q.key);
  end
  genvar k;
  generate
    for (k = 0; k < SAMPLES; k++) begin : gen_proof
      always_comb if (runs_q && write_valid_o) begin
        assert (write_o.depth[k*CODE+:CODE] == before_q.code[k*CODES+:CODE]);
        if (write_o.write_depth[k] || is_held_i[k])
          assert (word_o[k*CODE+:CODE] == (write_o.write_depth[k] ? write_o.depth[k*CODE+:CODE] : held_depth_i[k*CODE+:CODE]));
      end
    end
  endgenerate
