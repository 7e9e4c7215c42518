
  // It leaves once, in order, unchanged. And no deadlock: unless the consumer holds a setup packet, the work before it
  // leaves decreases in every cycle.
  genvar q;
  generate
    for (q = 0; q < PARTS; q++) begin : gen_packet
      localparam int FIRST = q * STEPS;
      localparam int BEHIND = q == LAST_PART ? OFFER + 1 : FIRST + STEPS;
      always_comb if (runs_q && it_at_q[BEHIND-1:FIRST] != '0) assert (packets_q[q*T+:T] == it_q);
    end
  endgenerate
  always_comb if (runs_q) begin
    if (leaves && inside_q && ahead_q == '0) begin
      assert (it_at_q[OFFER]);
      assert (setup_o.kind == it_q.kind && setup_o.primitive_id == it_q.primitive_id && setup_o.box == it_q.box &&
              setup_o.state == it_q.state && setup_o.edge_value == it_q.edge_value);
    end
    cover (done_q);
    cover (leaves && count_q == COUNT'(LAST_PART));
  end

  // Phases still to pass, of it and of the triangles ahead.
  localparam int LEFT = $clog2(PARTS * (OFFER + 1) + 1);
  function automatic [LEFT-1:0] phases(input [OFFER:0] bits);
    phases = '0;
    for (int i = 0; i <= OFFER; i++) if (bits[i]) phases = phases + LEFT'(OFFER + 1 - i);
  endfunction
  logic [LEFT-1:0] left, left_q;
  logic            waits_q;
  assign left = phases(at_q & ~(it_at_q - 1'b1));
  always_ff @(posedge clk_i) begin
    left_q  <= left;
    waits_q <= rst_ni && inside_q && !(setup_valid_o && !setup_ready_i);
  end
  always_comb if (runs_q && waits_q && inside_q) assert (left < left_q);
  raster_pkg::setup_packet_t offered_q;
  logic                          stalled_q;
  always_ff @(posedge clk_i) begin
    offered_q <= setup_o;
    stalled_q <= rst_ni && setup_valid_o && !setup_ready_i;
  end
  always_comb if (runs_q && stalled_q) assert (setup_valid_o && setup_o == offered_q);
