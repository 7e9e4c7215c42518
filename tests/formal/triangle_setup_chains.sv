
  // The result of a triangle in a phase is there in the next one: for each plane the differences, numerators, products,
  // gradients, moves; at the end the gradients and values of all planes. Values kept for several phases are there in
  // all of them.
  logic [OFFER-1:0] it_goes;
  assign it_goes = it_at_q[OFFER-1:0] & moves;
  genvar k, c, j;
  generate
    // A plane's differences, start, range and value. It has CLOCKS cycles; the result of the last one counts.
    for (k = 0; k < PLANES; k++) begin : gen_plane_proof
      localparam int FIRST = CLOCKS * k;
      localparam int LAST = FIRST + CLOCKS - 1;
      logic [DC-1:0] delta, delta_q;
      logic [Z:0]    code, code_q;
      logic [P-1:0]  total_q;
      if (CLOCKS == 1) begin : gen_both
        assign delta = gen_differences.ac;
        assign code  = start;
      end else begin : gen_in_turn
        logic [DC-1:0] first_q;
        logic [Z:0]    begun_q;
        logic [P-1:0]  begin_q, rest_q;
        assign delta = gen_shared_differences.first_q;
        assign code  = starts ? start : start_q[0+:Z+1];
        always_ff @(posedge clk_i) begin
          if (it_goes[DELTA+FIRST]) begin
            first_q <= gen_shared_differences.difference;
            begun_q <= start;
          end
          if (it_goes[START+FIRST]) begin_q <= start_value;
          if (it_goes[SUM+FIRST]) rest_q <= sum;
        end
        always_comb if (runs_q) begin
          if (it_at_q[DELTA+LAST])
            assert (gen_shared_differences.first_q == first_q && start_q[0+:Z+1] == begun_q);
          if (it_at_q[DELTA+FIRST+CLOCKS+:CLOCKS] != '0) assert (gen_shared_differences.pair_a_q == delta_q);
          if (it_at_q[SUM+FIRST]) assert (gen_shared_values.rest_q == begin_q);
          if (it_at_q[SUM+LAST]) assert (gen_shared_values.rest_q == rest_q);
        end
      end
      always_ff @(posedge clk_i) begin
        if (it_goes[DELTA+LAST]) begin
          delta_q <= delta;
          code_q  <= code;
        end
        if (it_goes[SUM+LAST]) total_q <= sum;
      end
      always_comb if (runs_q) begin
        if (it_at_q[NUMERATOR+FIRST+:CLOCKS] != '0) assert (ac_q == delta_q);
        if (it_at_q[OFFER]) assert (setup_values_q[k*P+:P] == total_q);
      end
      // In flight: the start; and in the chains, whose newest is the highest.
      for (c = 0; c < TO_START; c++) begin : gen_way
        always_comb if (runs_q && it_at_q[DELTA+FIRST+CLOCKS+c]) assert (start_q[c*(Z+1)+:Z+1] == code_q);
      end
      for (c = 1; c < PLANES - k; c++) begin : gen_sums
        always_comb if (runs_q && it_at_q[SUM+FIRST+CLOCKS*c+:CLOCKS] != '0)
          assert (sums_q[(PLANES-1-c)*P+:P] == total_q);
      end
      if (k < AFFINE) begin : gen_range_proof
        logic [ZA-1:0] low_end_q;
        always_ff @(posedge clk_i) if (it_goes[DELTA+LAST]) low_end_q <= low[ZA-1:0];
        for (c = 1; c < AFFINE - k; c++) begin : gen_ranges
          always_comb if (runs_q && it_at_q[DELTA+FIRST+CLOCKS*c+:CLOCKS] != '0)
            assert (low_q[(AFFINE-1-c)*ZA+:ZA] == low_end_q);
        end
        for (c = RANGE_PART; c < PARTS; c++) begin : gen_part
          localparam int FROM = c == RANGE_PART ? RANGED + 1 : c * STEPS;
          localparam int BEHIND = c == LAST_PART ? OFFER + 1 : (c + 1) * STEPS;
          always_comb if (runs_q && it_at_q[BEHIND-1:FROM] != '0)
            assert (ranges_q[(c-RANGE_PART)*RANGES+k*ZA+:ZA] == low_end_q);
        end
      end
    end

    // Values of a plane in each of its cycles, in the first lane.
    for (j = 0; j < STEPS; j++) begin : gen_cycle_proof
      logic [N-1:0]            numerator_q;  // the three values of the cycle before
      logic [PRODUCT_BITS-1:0] last_product_q;
      logic [P-1:0]            last_move_q;
      logic                    waits_for_product_q, waits_for_shift_q, waits_for_sum_q;
      logic [R-1:0]            factor_q;
      logic [P-1:0]            gradient_q;
      always_ff @(posedge clk_i) begin
        if (it_goes[ROUND+j]) factor_q <= reciprocal;
        if (it_goes[SHIFT+j]) gradient_q <= gen_gradient[0].shifted[1+:P] + P'(gen_gradient[0].shifted[0]);
        numerator_q         <= numerator[0+:N];
        last_product_q      <= product_q[0+:PRODUCT_BITS];
        last_move_q         <= move_q[0+:P];
        waits_for_product_q <= rst_ni && it_at_q[PRODUCT+j] && !moves[PRODUCT+j];
        waits_for_shift_q   <= rst_ni && it_at_q[SHIFT+j] && !moves[SHIFT+j];
        waits_for_sum_q     <= rst_ni && it_at_q[SUM+j] && !moves[SUM+j];
      end
      always_comb if (runs_q) begin
        if (waits_for_product_q) assert (numerator[0+:N] == numerator_q);
        if (waits_for_shift_q) assert (product_q[0+:PRODUCT_BITS] == last_product_q);
        if (waits_for_sum_q) assert (move_q[0+:P] == last_move_q);
        if (it_at_q[PRODUCT+j]) assert (reciprocal_q == factor_q);
        if (it_at_q[MOVE+j]) assert (step_q[0+:P] == gradient_q);
        if (it_at_q[OFFER-1]) assert (steps_q[j*LANES*P+:P] == gradient_q);
        if (it_at_q[OFFER]) assert (setup_steps_q[j*LANES*P+:P] == gradient_q);
      end
      for (c = 1; c < STEPS - j; c++) begin : gen_steps
        always_comb if (runs_q && it_at_q[MOVE+j+c]) assert (steps_q[(STEPS-c)*LANES*P+:P] == gradient_q);
      end
      if (CLOCKS == 2) begin : gen_shared
        logic [2*D-1:0] operands_q;
        logic [D-1:0]   way_q;
        always_ff @(posedge clk_i) begin
          if (it_goes[NUMERATOR-1+j]) operands_q <= j % 2 == 1 ? {minus_bx_q, minus_ax_q} : {by_q, ay_q};
          if (it_goes[MOVE-1+j])
            way_q <= D'($signed(gen_shared_values.anchor)) - D'($signed(gen_shared_values.from));
        end
        always_comb if (runs_q) begin
          if (it_at_q[NUMERATOR+j]) assert (factors == operands_q);
          if (it_at_q[MOVE+j]) assert (to == way_q);
        end
      end
    end
  endgenerate

  // Constants while its planes pass.
  logic [QUOTIENT-1:0] its_quotient_q;
  logic [SHIFT_BITS-1:0] its_shift_q;
  logic [D-1:0]        its_corner_q;
  always_ff @(posedge clk_i) begin
    if (it_goes[ROUND-1]) its_quotient_q <= quotients[(DIVIDERS-1)*QUOTIENT+:QUOTIENT];
    if (it_goes[SHIFT-1]) its_shift_q <= SHIFT_BITS'(log2_q[LOG2_PART*M+:M]) + SHIFT_BITS'(SHIFT_BASE);
    if (it_goes[CORNERS-1])
      its_corner_q <= D'($signed(corner_packet.vertex.x[0+:C])) - D'($signed(corner_packet.vertex.x[C+:C]));
  end
  always_comb if (runs_q) begin
    if (it_at_q[ROUND+:STEPS] != '0) assert (quotient_q == its_quotient_q);
    if (it_at_q[SHIFT+:STEPS] != '0) assert (shift_q == its_shift_q);
    if (it_at_q[CORNERS+:STEPS] != '0) assert (minus_ax_q == its_corner_q);
  end
  generate
    if (CLOCKS == 1) begin : gen_anchor_proof
      logic [D-1:0] its_anchor_q;
      always_ff @(posedge clk_i)
        if (it_goes[MOVE-1]) its_anchor_q <= D'(anchor_x) - D'($signed(anchor_packet.vertex.x[0+:C]));
      always_comb if (runs_q && it_at_q[MOVE+:STEPS] != '0) assert (gen_values.to_anchor_x_q == its_anchor_q);
    end else begin : gen_corners_proof
      logic [2*C-1:0] its_vertex_q;
      always_ff @(posedge clk_i)
        if (it_goes[MOVE-2]) its_vertex_q <= {anchor_packet.vertex.y[0+:C], anchor_packet.vertex.x[0+:C]};
      always_comb if (runs_q && it_at_q[MOVE-1+:STEPS] != '0)
        assert (gen_shared_values.corners_q[0+:2*C] == its_vertex_q);
    end
  endgenerate

  // The quotient, divider by divider: each continues the previous divider.
  genvar g;
  generate
    for (g = 0; g < DIVIDERS; g++) begin : gen_quotient
      localparam int BITS = BITS_PER_CYCLE * (g == DIVIDERS - 1 ? DIVIDE_CYCLES - g * STEPS : STEPS);
      localparam int CYCLES = BITS / BITS_PER_CYCLE;
      logic [REMAINDER-1:0] rest_q;  // remainder after the last cycle
      logic [BITS_PER_CYCLE-1:0] newest_q;
      always_ff @(posedge clk_i) begin
        if (it_goes[g*STEPS]) rest_q <= gen_divider[g].start;
        if (it_goes[g*STEPS+1+:CYCLES] != '0) begin
          rest_q   <= gen_divider[g].remainder_d;
          newest_q <= gen_divider[g].bits_d[BITS_PER_CYCLE-1:0];
        end
      end
      always_comb if (runs_q) begin
        if (it_at_q[g*STEPS+1+:CYCLES] != '0) assert (gen_divider[g].remainder_q == rest_q);
        if (CYCLES > 1 && it_at_q[g*STEPS+2+:CYCLES-(CYCLES>1?1:0)] != '0)
          assert (gen_divider[g].bits_q[BITS_PER_CYCLE-1:0] == newest_q);
      end
    end
  endgenerate
