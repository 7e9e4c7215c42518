
  // What it left behind in a phase is there in the next one: for each plane the differences, numerators, products, gradients,
  // moves; at the end the gradients and values of all planes. What it keeps for several phases is there in all of them.
  logic [OFFER-1:0] it_goes;
  assign it_goes = it_at_q[OFFER-1:0] & moves;
  genvar k, c;
  generate
    for (k = 0; k < PLANES; k++) begin : gen_proof
      logic [DC-1:0]           delta_q;
      logic [N-1:0]            numerator_q;  // as the three were in the cycle before
      logic [PRODUCT_BITS-1:0] product_q;
      logic [P-1:0]            move_q;
      logic                    waits_for_product_q, waits_for_shift_q, waits_for_sum_q;
      logic [R-1:0]            factor_q;
      logic [P-1:0]            gradient_q, total_q;
      logic [Z:0]              code_q;
      always_ff @(posedge clk_i) begin
        if (it_goes[DELTA+k]) begin
          delta_q <= ac;
          code_q  <= start;
        end
        if (it_goes[ROUND+k]) factor_q <= reciprocal;
        if (it_goes[SHIFT+k]) gradient_q <= shifted_x[1+:P] + P'(shifted_x[0]);
        if (it_goes[SUM+k]) total_q <= sum;
        numerator_q         <= numerator_x;
        product_q           <= product_x_q;
        move_q              <= move_x_q;
        waits_for_product_q <= rst_ni && it_at_q[PRODUCT+k] && !moves[PRODUCT+k];
        waits_for_shift_q   <= rst_ni && it_at_q[SHIFT+k] && !moves[SHIFT+k];
        waits_for_sum_q     <= rst_ni && it_at_q[SUM+k] && !moves[SUM+k];
      end
      always_comb if (runs_q) begin
        if (waits_for_product_q) assert (numerator_x == numerator_q);
        if (waits_for_shift_q) assert (product_x_q == product_q);
        if (waits_for_sum_q) assert (move_x_q == move_q);
        if (it_at_q[PRODUCT+k]) assert (reciprocal_q == factor_q);
        if (it_at_q[MOVE+k]) assert (step_x_q == gradient_q);
      end
      // On their way: differences, codes; and in the chains, whose newest is the highest.
      for (c = 1; c <= TO_SUM; c++) begin : gen_way
        always_comb if (runs_q && it_at_q[DELTA+k+c]) begin
          if (c <= TO_NUMERATOR) assert (ac_q[((c>TO_NUMERATOR?1:c)-1)*DC+:DC] == delta_q);
          assert (start_q[(c-1)*(Z+1)+:Z+1] == code_q);
        end
      end
      for (c = 1; c < PLANES - k; c++) begin : gen_chain
        always_comb if (runs_q) begin
          if (it_at_q[MOVE+k+c]) assert (steps_x_q[(PLANES-c)*P+:P] == gradient_q);
          if (it_at_q[SUM+k+c]) assert (sums_q[(PLANES-1-c)*P+:P] == total_q);
        end
      end
      always_comb if (runs_q) begin
        if (it_at_q[OFFER-1]) assert (steps_x_q[k*P+:P] == gradient_q);
        if (it_at_q[OFFER]) assert (setup_steps_x_q[k*P+:P] == gradient_q && setup_values_q[k*P+:P] == total_q);
      end
    end
  endgenerate

  // Constants while its planes pass by.
  logic [QUOTIENT-1:0] its_quotient_q;
  logic [SHIFT_BITS-1:0] its_shift_q;
  logic [D-1:0]        its_corner_q, its_anchor_q;
  always_ff @(posedge clk_i) begin
    if (it_goes[ROUND-1]) its_quotient_q <= quotients[(DIVIDERS-1)*QUOTIENT+:QUOTIENT];
    if (it_goes[SHIFT-1]) its_shift_q <= SHIFT_BITS'(log2_q[LOG2_PART*M+:M]) + SHIFT_BITS'(SHIFT_BASE);
    if (it_goes[NUMERATOR-1])
      its_corner_q <= D'($signed(corner_packet.vertex.x[C+:C])) - D'($signed(corner_packet.vertex.x[0+:C]));
    if (it_goes[MOVE-1]) its_anchor_q <= D'(anchor_x) - D'($signed(anchor_packet.vertex.x[0+:C]));
  end
  always_comb if (runs_q) begin
    if (it_at_q[ROUND+:PLANES] != '0) assert (quotient_q == its_quotient_q);
    if (it_at_q[SHIFT+:PLANES] != '0) assert (shift_q == its_shift_q);
    if (it_at_q[NUMERATOR+:PLANES] != '0) assert (ax_q == its_corner_q);
    if (it_at_q[MOVE+:PLANES] != '0) assert (to_anchor_x_q == its_anchor_q);
  end

  // The quotient, divider by divider: what one began the next one goes on with.
  genvar g;
  generate
    for (g = 0; g < DIVIDERS; g++) begin : gen_quotient
      localparam int BITS = BITS_PER_CYCLE * (g == DIVIDERS - 1 ? DIVIDE_CYCLES - g * STEPS : STEPS);
      localparam int CYCLES = BITS / BITS_PER_CYCLE;
      logic [REMAINDER-1:0] rest_q;  // as it left the last cycle
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
