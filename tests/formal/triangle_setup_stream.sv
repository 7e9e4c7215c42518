
  // It leaves once, in its turn, as it came. And no deadlock: unless the consumer holds a setup packet, what is left to do
  // before it leaves gets less in every cycle.
  always_comb if (runs_q) begin
    if (at_q[0]) assert (t_q == it_q);
    if (at_q[1]) assert (g_q == it_q);
    if (at_q[2]) assert (v_q == it_q);
    if (leaves && inside_q && ahead_q == '0) begin
      assert (at_q[2]);
      assert (setup_o.kind == it_q.kind && setup_o.primitive_id == it_q.primitive_id && setup_o.box == it_q.box &&
              setup_o.state == it_q.state && setup_o.edge_value == it_q.edge_value);
    end
    cover (done_q);
    cover (leaves && busy == 3'b111 && enters);
  end

  // What is left to do before it leaves, its own part first.
  logic [STEP:0] divide_left, gradient_left, value_left;
  logic [1:0]    parts;
  logic [3*STEP+4:0] left, left_q;
  logic              moves_q;
  assign divide_left   = at_q[0] ? (STEP + 1)'(DIVIDE_LAST) - (STEP + 1)'(divide_step_q) : '0;
  assign gradient_left = (at_q[0] || at_q[1]) && gradient_busy_q ? (STEP + 1)'(GRADIENT_LAST + 1) - (STEP + 1)'(gradient_step_q) : '0;
  assign value_left    = value_busy_q ? (STEP + 1)'(VALUE_LAST + 1) - (STEP + 1)'(value_step_q) : '0;
  assign parts         = at_q[0] ? 2'd3 : at_q[1] ? 2'd2 : at_q[2] ? 2'd1 : 2'd0;
  assign left          = {parts, divide_left, gradient_left, value_left};
  always_ff @(posedge clk_i) begin
    left_q  <= left;
    moves_q <= rst_ni && inside_q && !(setup_valid_o && !setup_ready_i);
  end
  always_comb if (runs_q && moves_q) assert (left < left_q);
  var raster_pkg::setup_packet_t offered_q;
  logic                          stalled_q;
  always_ff @(posedge clk_i) begin
    offered_q <= setup_o;
    stalled_q <= rst_ni && setup_valid_o && !setup_ready_i;
  end
  always_comb if (runs_q && stalled_q) assert (setup_valid_o && setup_o == offered_q);
