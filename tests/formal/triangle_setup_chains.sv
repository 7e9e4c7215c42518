
  // What it put into the chains between the parts, numerators and then gradients, plane by plane, and where that is: each part
  // takes what the same triangle put in.
  logic [STEP-1:0] given, taken, gave, took;  // so far: numerators; gradients
  assign given = divide_step_q <= STEP'(3) ? '0 : divide_step_q >= STEP'(PLANES + 3) ? STEP'(PLANES) : divide_step_q - STEP'(3);
  assign taken = gradient_step_q <= STEP'(1) ? '0 : gradient_step_q >= STEP'(PLANES + 1) ? STEP'(PLANES) : gradient_step_q - STEP'(1);
  assign gave  = gradient_step_q <= STEP'(2) ? '0 : gradient_step_q >= STEP'(PLANES + 2) ? STEP'(PLANES) : gradient_step_q - STEP'(2);
  assign took  = value_step_q >= STEP'(PLANES) ? STEP'(PLANES) : value_step_q;
  genvar k, g;
  generate
    for (k = 0; k < PLANES; k++) begin : gen_proof
      logic [N-1:0] numerator_x_q, numerator_y_q;
      logic [P-1:0] gradient_x_q, gradient_y_q;
      always_ff @(posedge clk_i) begin
        if (at_q[0] && numerator_done && given == STEP'(k)) begin
          numerator_x_q <= numerator_x;
          numerator_y_q <= numerator_y;
        end
        if (at_q[1] && gives_step && gave == STEP'(k)) begin
          gradient_x_q <= step_x;
          gradient_y_q <= step_y;
        end
      end
      for (g = 0; g <= PLANES; g++) begin : gen_given
        localparam int TOP = PLANES - g + (k < g ? k : g - 1);  // where k is when g were put in at the top
        localparam int LOW = k >= g ? k - g : 0;                // or taken out below
        always_comb if (runs_q) begin
          if (k < g && at_q[0] && given == STEP'(g))
            assert (numerators_x_q[TOP*N+:N] == numerator_x_q && numerators_y_q[TOP*N+:N] == numerator_y_q);
          if (k >= g && at_q[1] && taken == STEP'(g))
            assert (numerators_x_q[LOW*N+:N] == numerator_x_q && numerators_y_q[LOW*N+:N] == numerator_y_q);
          if (k < g && at_q[1] && gave == STEP'(g))
            assert (steps_x_q[TOP*P+:P] == gradient_x_q && steps_y_q[TOP*P+:P] == gradient_y_q);
          if (k >= g && at_q[2] && took == STEP'(g))
            assert (steps_x_q[LOW*P+:P] == gradient_x_q && steps_y_q[LOW*P+:P] == gradient_y_q);
          if (k < g && at_q[2] && took == STEP'(g))
            assert (v_steps_x_q[TOP*P+:P] == gradient_x_q && v_steps_y_q[TOP*P+:P] == gradient_y_q);
        end
      end
    end
  endgenerate
