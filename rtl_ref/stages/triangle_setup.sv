// Triangle setup: everything that stays constant over the triangle, from its three vertices: the reciprocal of its area,
// and for each plane two gradients and the value at the anchor of its first tile.
//
// Three parts, each holding one triangle, so that three are under way:
//   divide     R = floor(2^k / A + 1/2), three quotient bits a cycle; meanwhile the numerators N_x, N_y of every plane
//   gradients  round(N * R * 2^(F-k)), one plane a cycle
//   values     c_0 + g_x (x - x_0) + g_y (y - y_0), one plane a cycle
// Occupancy (embedded): 8, 7 and 6 cycles; latency 21. A part hands over when the next one is free.
// Specification: model/stages/triangle_setup.hpp.
module triangle_setup (
    input logic clk_i,
    input logic rst_ni,

    // From cull
    input  logic                         triangle_valid_i,
    output logic                         triangle_ready_o,
    input  raster_pkg::triangle_packet_t triangle_i,

    // To coarse_raster
    output logic                      setup_valid_o,
    input  logic                      setup_ready_i,
    output raster_pkg::setup_packet_t setup_o
);

  localparam int D = raster_pkg::DELTA_BITS;
  localparam int C = raster_pkg::COORDINATE_BITS;
  localparam int PLANES = raster_pkg::PLANES;
  localparam logic [32*PLANES-1:0] CODE_BITS_OF = raster_pkg::CODE_BITS_OF;
  localparam logic [32*PLANES-1:0] CODE_AT = raster_pkg::CODE_AT;
  localparam logic [32*PLANES-1:0] PLANE_BITS_OF = raster_pkg::PLANE_BITS_OF;
  localparam logic [32*PLANES-1:0] PLANE_AT = raster_pkg::PLANE_AT;
  localparam int CODES = raster_pkg::ALL_CODE_BITS;  // of a vertex
  // The parts have the width of the widest plane, whichever is at work.
  localparam int Z = raster_pkg::MAX_CODE_BITS;
  localparam int DC = raster_pkg::MAX_DELTA_BITS;
  localparam int N = raster_pkg::MAX_NUMERATOR_BITS;
  localparam int P = raster_pkg::MAX_PLANE_BITS;
  localparam int A = raster_pkg::AREA_BITS;
  localparam int M = $clog2(A);  // bits of floor(log2 A)
  localparam int R = raster_pkg::RECIPROCAL_BITS;
  localparam int F = raster_pkg::PLANE_FRACTION;
  localparam int L = raster_pkg::PLANE_LOCAL_GUARD_BITS;
  localparam int S = raster_pkg::GRID_BITS;
  localparam int TS = raster_pkg::TILE_SHIFT;
  localparam int PX = raster_pkg::PIXEL_X_BITS;
  localparam int PY = raster_pkg::PIXEL_Y_BITS;

  // The quotient has one bit before the point and R after it: one more than is kept, for the rounding.
  localparam int BITS_PER_CYCLE = 3;
  localparam int DIVIDE_CYCLES = (R + BITS_PER_CYCLE - 1) / BITS_PER_CYCLE;
  localparam int QUOTIENT = 1 + BITS_PER_CYCLE * DIVIDE_CYCLES;
  localparam int DIVIDE_LAST = DIVIDE_CYCLES > PLANES + 3 ? DIVIDE_CYCLES : PLANES + 3;
  localparam int GRADIENT_LAST = PLANES + 2;
  localparam int VALUE_LAST = PLANES + 1;
  localparam int STEP = $clog2(DIVIDE_LAST + 1);

  // ----------------------------------------------------------------------------------------------------------- divide
  var raster_pkg::triangle_packet_t t_q;
  logic            divide_busy_q;
  logic [STEP-1:0] divide_step_q;
  logic            divide_hands_over, gradient_ready;

  assign divide_hands_over = divide_busy_q && divide_step_q == STEP'(DIVIDE_LAST) && gradient_ready;
  assign triangle_ready_o  = !divide_busy_q || divide_hands_over;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      divide_busy_q <= 1'b0;
      divide_step_q <= '0;
    end else if (triangle_ready_o) begin
      divide_busy_q <= triangle_valid_i;
      divide_step_q <= '0;
    end else if (divide_step_q != STEP'(DIVIDE_LAST)) divide_step_q <= divide_step_q + STEP'(1);
  end

  // The highest set bit of the area: 2^m and m.
  logic [A-1:0] highest;
  logic [M-1:0] log2_area;
  always_comb begin
    highest   = '0;
    log2_area = '0;
    for (int b = 0; b < A; b++) begin
      if (t_q.area[b]) begin
        highest    = '0;
        highest[b] = 1'b1;
        log2_area  = M'(b);
      end
    end
  end

  // The first quotient bit is 1 only for A = 2^m; then restoring division, BITS_PER_CYCLE bits a cycle.
  logic [A:0]          remainder_q, remainder_d;  // < 2 A
  logic [QUOTIENT-1:0] quotient_q, quotient_d;
  logic [M-1:0]        log2_area_q;
  always_comb begin
    remainder_d = remainder_q;
    quotient_d  = quotient_q;
    for (int b = 0; b < BITS_PER_CYCLE; b++) begin
      if (remainder_d >= {1'b0, t_q.area}) begin
        remainder_d = (remainder_d - {1'b0, t_q.area}) << 1;
        quotient_d  = {quotient_d[QUOTIENT-2:0], 1'b1};
      end else begin
        remainder_d = remainder_d << 1;
        quotient_d  = {quotient_d[QUOTIENT-2:0], 1'b0};
      end
    end
  end

  // One plane a cycle: its code at each vertex, the differences from vertex 0, the range.
  logic signed [D-1:0] ax_q, ay_q, bx_q, by_q, to_anchor_x_q, to_anchor_y_q;
  logic [Z-1:0]        c0, c1, c2, low, high;
  logic signed [DC-1:0] ac, bc, ac_q, bc_q;
  logic [PLANES*Z-1:0] low_q, high_q;  // the newest is the highest
  logic [PLANES*Z-1:0] codes_0, codes_1, codes_2;
  logic                is_1_below_0, is_2_below_0, is_2_below_1;
  genvar p;
  generate
    for (p = 0; p < PLANES; p++) begin : gen_codes
      localparam int B = CODE_BITS_OF[32*p+:32];
      localparam int AT = CODE_AT[32*p+:32];
      assign codes_0[p*Z+:Z] = Z'(t_q.vertex.code[AT+:B]);
      assign codes_1[p*Z+:Z] = Z'(t_q.vertex.code[CODES+AT+:B]);
      assign codes_2[p*Z+:Z] = Z'(t_q.vertex.code[2*CODES+AT+:B]);
    end
  endgenerate
  always_comb begin
    c0 = codes_0[0+:Z];
    c1 = codes_1[0+:Z];
    c2 = codes_2[0+:Z];
    for (int i = 1; i < PLANES; i++) begin
      if (divide_step_q == STEP'(i)) begin
        c0 = codes_0[i*Z+:Z];
        c1 = codes_1[i*Z+:Z];
        c2 = codes_2[i*Z+:Z];
      end
    end
  end
  assign ac           = $signed(DC'(c1) - DC'(c0));
  assign bc           = $signed(DC'(c2) - DC'(c0));
  assign is_1_below_0 = ac[DC-1];
  assign is_2_below_0 = bc[DC-1];
  assign is_2_below_1 = c2 < c1;
  assign low          = is_1_below_0 ? (is_2_below_1 ? c2 : c1) : (is_2_below_0 ? c2 : c0);
  assign high         = is_1_below_0 ? (is_2_below_0 ? c0 : c2) : (is_2_below_1 ? c1 : c2);

  // From vertex 0 to the centre of pixel (T/2, T/2) of the first tile, subpixels.
  logic signed [C:0] anchor_x, anchor_y;
  assign anchor_x = $signed((C + 1)'({t_q.box.left[PX-1:TS], 1'b1, {(TS - 1) {1'b0}}}) << S) + $signed((C + 1)'(1 << (S - 1)));
  assign anchor_y = $signed((C + 1)'({t_q.box.top[PY-1:TS], 1'b1, {(TS - 1) {1'b0}}}) << S) + $signed((C + 1)'(1 << (S - 1)));

  // The numerators: N_x = ac by - bc ay, N_y = ax bc - bx ac, one plane a cycle, into a chain that the gradients take them
  // from. A part is never a step behind the one before it, so whatever moves the chain moves it for both.
  logic                issues_numerator, numerator_done, takes_numerator;
  logic signed [N-1:0] numerator_x, numerator_y;
  logic [PLANES*N-1:0] numerators_x_q, numerators_y_q;  // the newest is the highest
  assign issues_numerator = divide_busy_q && divide_step_q >= STEP'(1) && divide_step_q <= STEP'(PLANES);

  cross_product #(
      .A_BITS  (DC),
      .D_BITS  (D),
      .OUT_BITS(N)
  ) u_numerator_x (
      .clk_i,
      .rst_ni,
      .start_i (issues_numerator),
      .a_i     (ac_q),
      .b_i     (bc_q),
      .c_i     (ay_q),
      .d_i     (by_q),
      .done_o  (numerator_done),
      .result_o(numerator_x)
  );

  /* verilator lint_off PINCONNECTEMPTY */
  cross_product #(
      .A_BITS  (D),
      .D_BITS  (DC),
      .OUT_BITS(N)
  ) u_numerator_y (
      .clk_i,
      .rst_ni,
      .start_i (issues_numerator),
      .a_i     (ax_q),
      .b_i     (bx_q),
      .c_i     (ac_q),
      .d_i     (bc_q),
      .done_o  (),
      .result_o(numerator_y)
  );
  /* verilator lint_on PINCONNECTEMPTY */

  always_ff @(posedge clk_i) begin
    if (triangle_ready_o) t_q <= triangle_i;
    if (divide_step_q == '0) begin
      remainder_q   <= (t_q.area == highest) ? '0 : {highest, 1'b0};
      quotient_q    <= QUOTIENT'(t_q.area == highest);
      log2_area_q   <= log2_area;
      ax_q          <= D'($signed(t_q.vertex.x[C+:C])) - D'($signed(t_q.vertex.x[0+:C]));
      ay_q          <= D'($signed(t_q.vertex.y[C+:C])) - D'($signed(t_q.vertex.y[0+:C]));
      bx_q          <= D'($signed(t_q.vertex.x[2*C+:C])) - D'($signed(t_q.vertex.x[0+:C]));
      by_q          <= D'($signed(t_q.vertex.y[2*C+:C])) - D'($signed(t_q.vertex.y[0+:C]));
      to_anchor_x_q <= D'(anchor_x) - D'($signed(t_q.vertex.x[0+:C]));
      to_anchor_y_q <= D'(anchor_y) - D'($signed(t_q.vertex.y[0+:C]));
    end else if (divide_step_q < STEP'(DIVIDE_CYCLES < DIVIDE_LAST ? DIVIDE_CYCLES + 1 : DIVIDE_LAST)) begin
      remainder_q <= remainder_d;
      quotient_q  <= quotient_d;
    end
    if (divide_step_q < STEP'(PLANES)) begin
      ac_q   <= ac;
      bc_q   <= bc;
      low_q  <= {low, low_q[Z+:(PLANES-1)*Z]};
      high_q <= {high, high_q[Z+:(PLANES-1)*Z]};
    end
    if (numerator_done || takes_numerator) begin
      numerators_x_q <= {numerator_x, numerators_x_q[N+:(PLANES-1)*N]};
      numerators_y_q <= {numerator_y, numerators_y_q[N+:(PLANES-1)*N]};
    end
  end

  // -------------------------------------------------------------------------------------------------------- gradients
  /* verilator lint_off UNUSEDSIGNAL */  // of the packets that ride along only what comes out is used
  var raster_pkg::triangle_packet_t g_q;
  /* verilator lint_on UNUSEDSIGNAL */
  logic                 gradient_busy_q;
  logic [STEP-1:0]      gradient_step_q;
  logic                 gradient_hands_over, value_ready;
  logic [QUOTIENT-1:0]  g_quotient_q;
  logic [R-1:0]         reciprocal_q;
  logic [M-1:0]         g_log2_area_q;
  logic [PLANES*P-1:0]  steps_x_q, steps_y_q;  // gradients per subpixel, the newest is the highest: a chain to the values
  logic                 gives_step, takes_step;
  logic [PLANES*Z-1:0]  g_low_q, g_high_q;
  logic signed [D-1:0]  g_to_anchor_x_q, g_to_anchor_y_q;
  logic [3*D-1:0]       g_dx_q, g_dy_q;

  assign gradient_hands_over = gradient_busy_q && gradient_step_q == STEP'(GRADIENT_LAST) && value_ready;
  assign gradient_ready      = !gradient_busy_q || gradient_hands_over;
  assign takes_numerator     = gradient_step_q >= STEP'(1) && gradient_step_q <= STEP'(PLANES);
  assign gives_step          = gradient_step_q >= STEP'(2) && gradient_step_q <= STEP'(PLANES + 1);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      gradient_busy_q <= 1'b0;
      gradient_step_q <= '0;
    end else if (gradient_ready) begin
      gradient_busy_q <= divide_hands_over;
      gradient_step_q <= '0;
    end else if (gradient_step_q != STEP'(GRADIENT_LAST)) gradient_step_q <= gradient_step_q + STEP'(1);
  end

  // round_shift(N * R, k - F): k - F = m + OFFSET, which may be negative: LEFT zeros go below the product first, so that
  // what remains is a shift to the right by at least 1, of which the rounding takes the last.
  localparam int OFFSET = R - 1 - F;
  localparam int LEFT = OFFSET < 1 ? 1 - OFFSET : 0;
  localparam int SHIFT_BASE = OFFSET + LEFT - 1;
  localparam int PRODUCT = N + R + 1;
  localparam int SHIFT = $clog2(A + SHIFT_BASE + 1);

  logic signed [PRODUCT-1:0]      product_x_q, product_y_q;
  /* verilator lint_off UNUSEDSIGNAL */  // planes live modulo 2^P
  logic signed [PRODUCT+LEFT-1:0] shifted_x, shifted_y;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [P-1:0]                   step_x, step_y;
  logic [SHIFT-1:0]               shift;
  assign shift     = SHIFT'(g_log2_area_q) + SHIFT'(SHIFT_BASE);
  assign shifted_x = $signed({product_x_q, {LEFT{1'b0}}}) >>> shift;
  assign shifted_y = $signed({product_y_q, {LEFT{1'b0}}}) >>> shift;
  assign step_x    = shifted_x[1+:P] + P'(shifted_x[0]);
  assign step_y    = shifted_y[1+:P] + P'(shifted_y[0]);

  always_ff @(posedge clk_i) begin
    if (gradient_ready) begin
      g_q              <= t_q;
      g_quotient_q     <= DIVIDE_LAST == DIVIDE_CYCLES ? quotient_d : quotient_q;  // the last bits may be new
      g_log2_area_q    <= log2_area_q;
      g_low_q          <= low_q;
      g_high_q         <= high_q;
      g_to_anchor_x_q  <= to_anchor_x_q;
      g_to_anchor_y_q  <= to_anchor_y_q;
      g_dx_q           <= {-bx_q, bx_q - ax_q, ax_q};
      g_dy_q           <= {-by_q, by_q - ay_q, ay_q};
    end else if (gradient_step_q == '0) begin
      // Spare quotient bits are dropped, the last one that counts is rounded.
      reciprocal_q <= g_quotient_q[QUOTIENT-R+:R] + R'(g_quotient_q[QUOTIENT-R-1]);
    end
    if (takes_numerator) begin
      product_x_q <= $signed(numerators_x_q[0+:N]) * $signed({1'b0, reciprocal_q});
      product_y_q <= $signed(numerators_y_q[0+:N]) * $signed({1'b0, reciprocal_q});
    end
    if (gives_step || takes_step) begin
      steps_x_q <= {step_x, steps_x_q[P+:(PLANES-1)*P]};
      steps_y_q <= {step_y, steps_y_q[P+:(PLANES-1)*P]};
    end
  end

  // ----------------------------------------------------------------------------------------------------------- values
  /* verilator lint_off UNUSEDSIGNAL */
  var raster_pkg::triangle_packet_t v_q;
  /* verilator lint_on UNUSEDSIGNAL */
  logic                value_busy_q;
  logic [STEP-1:0]     value_step_q;
  /* verilator lint_off UNUSEDSIGNAL */  // most planes have fewer bits than the widest
  logic [PLANES*P-1:0] v_steps_x_q, v_steps_y_q, values_q;
  logic [PLANES*Z-1:0] v_low_q, v_high_q;
  /* verilator lint_on UNUSEDSIGNAL */
  logic signed [D-1:0] v_to_anchor_x_q, v_to_anchor_y_q;
  logic [3*D-1:0]      v_dx_q, v_dy_q;
  logic [P-1:0]        move_x_q, move_y_q, start_q;  // modulo 2^P

  assign setup_valid_o = value_busy_q && value_step_q == STEP'(VALUE_LAST);
  assign takes_step    = value_busy_q && value_step_q < STEP'(PLANES);
  assign value_ready   = !value_busy_q || (setup_valid_o && setup_ready_i);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      value_busy_q <= 1'b0;
      value_step_q <= '0;
    end else if (value_ready) begin
      value_busy_q <= gradient_hands_over;
      value_step_q <= '0;
    end else if (value_step_q != STEP'(VALUE_LAST)) value_step_q <= value_step_q + STEP'(1);
  end

  // A plane at vertex 0: its code with F fraction bits, half a unit of the local plane's last place, and the offset of its
  // window (LocalFormat), 2^(B-1), so that a tile's anchor is a shift.
  localparam logic [F-1:0] HALVES = F'(1) << (F - L - 1) | F'(1) << (F - 1);
  logic [PLANES*(Z+1)-1:0] starts;  // without those halves
  logic [Z:0]              start;
  generate
    for (p = 0; p < PLANES; p++) begin : gen_start
      localparam int B = CODE_BITS_OF[32*p+:32];
      localparam int AT = CODE_AT[32*p+:32];
      logic [B-1:0] code;
      assign code                 = v_q.vertex.code[AT+:B];
      assign starts[p*(Z+1)+:Z+1] = (Z + 1)'({code[B-1], !code[B-1], code[0+:B-1]});
    end
  endgenerate
  always_comb begin
    start = starts[0+:Z+1];
    for (int i = 1; i < PLANES; i++) if (value_step_q == STEP'(i)) start = starts[i*(Z+1)+:Z+1];
  end

  always_ff @(posedge clk_i) begin
    if (value_ready) begin
      v_q             <= g_q;
      v_low_q         <= g_low_q;
      v_high_q        <= g_high_q;
      v_to_anchor_x_q <= g_to_anchor_x_q;
      v_to_anchor_y_q <= g_to_anchor_y_q;
      v_dx_q          <= g_dx_q;
      v_dy_q          <= g_dy_q;
    end
    if (takes_step) begin
      move_x_q    <= $signed(steps_x_q[0+:P]) * v_to_anchor_x_q;
      move_y_q    <= $signed(steps_y_q[0+:P]) * v_to_anchor_y_q;
      start_q     <= P'({start, HALVES});
      v_steps_x_q <= {steps_x_q[0+:P], v_steps_x_q[P+:(PLANES-1)*P]};
      v_steps_y_q <= {steps_y_q[0+:P], v_steps_y_q[P+:(PLANES-1)*P]};
    end
    if (value_step_q != STEP'(VALUE_LAST)) values_q <= {start_q + move_x_q + move_y_q, values_q[P+:(PLANES-1)*P]};
  end

  assign setup_o.kind         = v_q.kind;
  assign setup_o.primitive_id = v_q.primitive_id;
  assign setup_o.box          = v_q.box;
  assign setup_o.state        = v_q.state;
  assign setup_o.dx           = v_dx_q;
  assign setup_o.dy           = v_dy_q;
  assign setup_o.edge_value   = v_q.edge_value;

  generate
    for (p = 0; p < PLANES; p++) begin : gen_plane
      localparam int B = PLANE_BITS_OF[32*p+:32];
      localparam int AT = PLANE_AT[32*p+:32];
      localparam int CB = CODE_BITS_OF[32*p+:32];
      localparam int CODE = CODE_AT[32*p+:32];
      assign setup_o.value[AT+:B]         = values_q[p*P+:B];
      assign setup_o.step_x[AT+:B]        = v_steps_x_q[p*P+:B];
      assign setup_o.step_y[AT+:B]        = v_steps_y_q[p*P+:B];
      assign setup_o.range.low[CODE+:CB]  = v_low_q[p*Z+:CB];
      assign setup_o.range.high[CODE+:CB] = v_high_q[p*Z+:CB];
    end
  endgenerate

endmodule
