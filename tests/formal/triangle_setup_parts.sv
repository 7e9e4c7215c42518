
  // An arbitrary triangle of the stream: its phase, and the number of triangles ahead. The multipliers' results may be
  // anything.
  localparam int COUNT = $clog2(PARTS + 1);
  (* anyseq *) logic pick;
  logic             inside_q, done_q;
  logic [COUNT-1:0] ahead_q;  // setups that leave before it
  logic [COUNT-1:0] count_q;  // in all parts
  logic [OFFER:0]   it_at_q;
  raster_pkg::triangle_packet_t it_q;
  logic             enters, picks;
  logic [OFFER:0]   goes;
  assign enters = triangle_valid_i && triangle_ready_o;
  assign picks  = enters && pick && !inside_q && !done_q;
  assign goes   = {leaves, moves};
  function automatic [COUNT-1:0] ones(input [OFFER:0] bits);
    ones = '0;
    for (int i = 0; i <= OFFER; i++) ones = ones + COUNT'(bits[i]);
  endfunction
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      inside_q <= 1'b0;
      done_q   <= 1'b0;
      count_q  <= '0;
      it_at_q  <= '0;
    end else begin
      count_q <= count_q + COUNT'(enters) - COUNT'(leaves);
      if (picks) begin
        inside_q <= 1'b1;
        it_q     <= triangle_i;
        ahead_q  <= count_q - COUNT'(leaves);
        it_at_q  <= (OFFER + 1)'(1);
      end else if (inside_q) begin
        if (leaves) ahead_q <= ahead_q - COUNT'(1);
        it_at_q <= ((it_at_q & goes) << 1) | (it_at_q & ~goes);
        if (leaves && ahead_q == '0) begin
          inside_q <= 1'b0;
          done_q   <= 1'b1;
        end
      end
    end
  end
  always_comb if (runs_q) begin
    assert (count_q == ones(at_q));
    assert (inside_q == (it_at_q != '0) && (it_at_q & (it_at_q - 1'b1)) == '0 && (it_at_q & ~at_q) == '0);
    if (inside_q) assert (ahead_q == ones(at_q & ~(it_at_q | (it_at_q - 1'b1))) && !done_q);
  end
  // A part is ready when it is empty, or when the triangle in its last phase moves on.
  always_comb if (runs_q) begin
    assert (ready_q[LAST_PART] == (at_q[OFFER:LAST_PART*STEPS] == '0));
    for (int i = 0; i < LAST_PART; i++) assert (ready_q[i] == (at_q[i*STEPS+:STEPS] == '0 || moves[i*STEPS+STEPS-1]));
  end
  // A part holds one triangle, which is never a step less far than the one in the previous part; in the last part it may
  // wait for long.
  genvar m, n;
  generate
    for (m = 0; m <= OFFER; m++) begin : gen_order
      for (n = m + 1; n <= OFFER; n++) begin : gen_pair
        if (n / STEPS == m / STEPS || (n < m + STEPS && n != OFFER)) begin : gen_never
          always_comb if (runs_q) assert (!(at_q[m] && at_q[n]));
        end
      end
    end
  endgenerate
