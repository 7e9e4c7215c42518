// Triangle setup for the smallest parts: the same bits as triangle_setup.sv, from one adder and one shift-and-add
// multiplier, one bit a cycle. It costs about as many flip-flops as a setup packet has bits, because every intermediate
// waits in a result register that is not needed yet.
//
// Bits run lowest first through chains: shift registers that hold a field of all planes, plane 0 lowest.
// A pass moves a chain through once, plane by plane, so no bit is ever selected by an index.
//   SUBTRACT  the ring: raw coordinates become dx, dy and the offset to the anchor; meanwhile R, in its own subtractor
//   FIRST     numerators: (c2 - c0) d0 of all planes into the value chain
//   SECOND    and (c1 - c0) d2 added there
//   GRADIENT  numerator * R, shifted and rounded, into a step chain. These three states for y, then for x
//   VALUE     step * offset to the anchor, added to the value chain; for x, then for y
// The multiplier's operand is the lowest word of the ring, which rotates between the passes. Occupancy: about 1300
// cycles and 8 for each bit of the area. triangle_i must stay until triangle_ready_o, which comes after the result:
// fields that only pass through are not stored. Specification: model/stages/triangle_setup.hpp.
module triangle_setup_serial (
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
  localparam logic [32*PLANES-1:0] RECIPROCAL_BITS_OF = raster_pkg::RECIPROCAL_BITS_OF;
  localparam logic [32*PLANES-1:0] PLANE_BITS_OF = raster_pkg::PLANE_BITS_OF;
  localparam logic [32*PLANES-1:0] PLANE_AT = raster_pkg::PLANE_AT;
  localparam int A = raster_pkg::AREA_BITS;
  localparam int R = raster_pkg::RECIPROCAL_BITS;
  localparam int P = raster_pkg::MAX_PLANE_BITS;
  localparam int F = raster_pkg::PLANE_FRACTION;
  localparam int L = raster_pkg::PLANE_LOCAL_GUARD_BITS;
  localparam int S = raster_pkg::GRID_BITS;
  localparam int TS = raster_pkg::TILE_SHIFT;
  localparam int PX = raster_pkg::PIXEL_X_BITS;
  localparam int PY = raster_pkg::PIXEL_Y_BITS;
  localparam int CHAIN = raster_pkg::ALL_PLANE_BITS;  // a gradient or a value of every plane
  localparam int CODES = raster_pkg::ALL_CODE_BITS;  // a code of every plane
  localparam int RING = 8 * D;
  localparam int UNIT = $clog2(PLANES > 8 ? PLANES : 8);

  // The dividend starts at 1, so that after j = ceil(log2 A) quotient bits of 0 come the R significant ones, and
  // quotient = floor(2^(j + R - 1) / A). SHIFT = j + R - 2 - F brings a product to F fraction bits; it includes the
  // rounding bit, so LEAD zeros go below the product where it might be less than 1.
  localparam int LEAD = F + 3 - R > 0 ? F + 3 - R : 0;
  localparam int SHIFT_MAX = A + R - 2 - F + LEAD;
  localparam int COUNT = $clog2(SHIFT_MAX > P ? SHIFT_MAX : P);
  localparam int MOVED = $clog2(P + LEAD + 1);
  localparam int ACC = R > D ? R : D;

  // ---------------------------------------------------------------------------------------------------------- control
  localparam logic [3:0] IDLE = 4'd0, SUBTRACT = 4'd1, FIRST = 4'd2, TURN_A = 4'd3, SECOND = 4'd4, GRADIENT = 4'd5,
      TURN_B = 4'd6, TURN_C = 4'd7, VALUE_X = 4'd8, TURN_D = 4'd9, VALUE_Y = 4'd10, OFFER = 4'd11, TAKE = 4'd12;
  (* fsm_encoding = "none" *) logic [3:0] state_q;
  logic             is_x_q;  // the numerators and gradients in progress are of x
  logic [UNIT-1:0]  unit_q;  // plane, or word of the ring
  logic [COUNT-1:0] bit_q, last_bit, shift_q;  // shift_q: SHIFT + LEAD - 1
  logic             keeps_q;  // GRADIENT: the dropped bits have passed
  logic             waits_q, has_moved_q;  // the kept bits have passed too, but not the whole numerator
  logic [UNIT-1:0]  last_unit;
  logic [COUNT-1:0] code_bits, last_of_plane;  // of the plane
  logic [MOVED-1:0] last_moved;                // the last bit of its numerator, after LEAD zeros
  logic             is_numerator, is_gradient, is_value, is_turn, is_last_bit, unit_ends, state_ends, load;

  assign is_numerator = state_q == FIRST || state_q == SECOND;
  assign is_gradient  = state_q == GRADIENT;
  assign is_value     = state_q == VALUE_X || state_q == VALUE_Y;
  assign is_turn      = state_q == TURN_A || state_q == TURN_B || state_q == TURN_C || state_q == TURN_D;
  assign load         = state_q == IDLE;
  always_comb begin
    code_bits     = COUNT'(CODE_BITS_OF[0+:32]);
    last_of_plane = COUNT'(PLANE_BITS_OF[0+:32] - 1);
    last_moved    = MOVED'(PLANE_BITS_OF[0+:32] + LEAD - 1);
    for (int i = 1; i < PLANES; i++) begin
      if (unit_q == UNIT'(i)) begin
        code_bits     = COUNT'(CODE_BITS_OF[32*i+:32]);
        last_of_plane = COUNT'(PLANE_BITS_OF[32*i+:32] - 1);
        last_moved    = MOVED'(PLANE_BITS_OF[32*i+:32] + LEAD - 1);
      end
    end
  end
  always_comb begin
    last_bit = last_of_plane;
    if (is_turn || state_q == SUBTRACT) last_bit = COUNT'(D - 1);
    if (is_gradient && !keeps_q) last_bit = shift_q;
    case (state_q)
      SUBTRACT: last_unit = UNIT'(7);
      TURN_A, TURN_B: last_unit = UNIT'(1);
      TURN_C: last_unit = UNIT'(4);
      TURN_D: last_unit = UNIT'(3);
      default: last_unit = UNIT'(PLANES - 1);
    endcase
  end
  assign is_last_bit = bit_q == last_bit;
  always_comb begin
    unit_ends = is_last_bit;
    if (is_gradient) unit_ends = waits_q ? has_moved_q : keeps_q && is_last_bit && (LEAD < 2 || has_moved_q);
  end
  assign state_ends  = unit_ends && unit_q == last_unit;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) state_q <= IDLE;
    else if (load) state_q <= triangle_valid_i ? SUBTRACT : IDLE;
    else if (state_q == OFFER) state_q <= setup_ready_i ? TAKE : OFFER;
    else if (state_q == TAKE) state_q <= triangle_valid_i ? IDLE : TAKE;
    else if (state_ends) begin
      case (state_q)
        GRADIENT: state_q <= is_x_q ? TURN_C : TURN_B;
        TURN_B: state_q <= FIRST;
        TURN_C: state_q <= VALUE_X;
        default: state_q <= state_q + 4'd1;
      endcase
    end
  end

  always_ff @(posedge clk_i) begin
    if (load || is_last_bit || waits_q) bit_q <= '0;
    else bit_q <= bit_q + COUNT'(1);
    if (load || state_ends) unit_q <= '0;
    else if (unit_ends) unit_q <= unit_q + UNIT'(1);
    if (load) is_x_q <= 1'b0;
    else if (is_gradient && state_ends) is_x_q <= !is_x_q;
    if (load) keeps_q <= 1'b0;
    else if (is_gradient && is_last_bit && !waits_q) keeps_q <= !keeps_q;
    if (load || unit_ends) waits_q <= 1'b0;
    else if (keeps_q && is_last_bit && LEAD >= 2) waits_q <= 1'b1;
  end

  // ------------------------------------------------------------------------------------------------------- reciprocal
  // Restoring division on the complement of the remainder: a sum needs no inverter before its carries.
  logic [A:0]   not_remainder_q;
  logic [A+1:0] trial;  // complement of remainder - area; the highest bit: negative
  logic [R-1:0] quotient_q;
  assign trial = {1'b0, not_remainder_q} + {2'b00, triangle_i.area};

  always_ff @(posedge clk_i) begin
    if (load) begin
      not_remainder_q <= {{A{1'b1}}, 1'b0};  // remainder of 1
      quotient_q      <= '0;
      shift_q         <= COUNT'(LEAD - F - 3);
    end else if (!quotient_q[R-1]) begin
      not_remainder_q <= {trial[A+1] ? not_remainder_q[A-1:0] : trial[A-1:0], 1'b1};
      quotient_q      <= {quotient_q[R-2:0], !trial[A+1]};
      shift_q         <= shift_q + COUNT'(1);
    end
  end

  // ----------------------------------------------------------------------------------------------------------- chains
  logic [RING-1:0]  ring_q;  // at first x0, x1, x2, x0, y likewise; then dx, way to the anchor, dy, way to the anchor
  logic [CHAIN-1:0] step_x_q, step_y_q, value_q;
  logic [CODES-1:0] min_q, max_q;  // codes of vertices 1 and 2, until the last pass that needs them
  logic             moves_codes, keeps, moves_numerator;
  logic             ring_in, min_in, max_in, sum, c0, c1, c2;

  // Coordinates of the anchor of the first tile: the centre of pixel (T/2, T/2).
  logic [D-1:0] anchor_x, anchor_y;
  assign anchor_x = D'({triangle_i.box.left[PX-1:TS], 1'b1, {(TS - 1) {1'b0}}}) << S | D'(1 << (S - 1));
  assign anchor_y = D'({triangle_i.box.top[PY-1:TS], 1'b1, {(TS - 1) {1'b0}}}) << S | D'(1 << (S - 1));

  // The anchors meet the fourth and the eighth word of the ring; the second chain is the continuation of the first.
  logic [2*CHAIN-1:0] anchors;
  assign anchors = (2 * CHAIN)'(anchor_x) << (3 * D) | (2 * CHAIN)'(anchor_y) << (7 * D);

  // c_0 with F fraction bits, half a unit of the local plane's last place, and the offset of its wrap window
  // (LocalFormat).
  localparam logic [F-1:0] HALVES = F'(1) << (F - L - 1) | F'(1) << (F - 1);
  logic [CHAIN-1:0] base;
  genvar p;
  generate
    for (p = 0; p < PLANES; p++) begin : gen_base
      localparam int B = PLANE_BITS_OF[32*p+:32];
      localparam int AT = PLANE_AT[32*p+:32];
      localparam int CB = CODE_BITS_OF[32*p+:32];
      localparam int CODE = CODE_AT[32*p+:32];
      logic [CB-1:0] code;
      assign code        = triangle_i.vertex.code[CODE+:CB];
      assign base[AT+:B] = {code[CB-1], !code[CB-1], code[0+:CB-1], HALVES};
    end
  endgenerate

  assign moves_codes = is_numerator && bit_q < code_bits;
  assign keeps       = is_gradient && keeps_q;

  always_ff @(posedge clk_i) begin
    if (load) begin
      ring_q <= {
        D'($signed(triangle_i.vertex.y[0+:C])),
        D'($signed(triangle_i.vertex.y[2*C+:C])),
        D'($signed(triangle_i.vertex.y[C+:C])),
        D'($signed(triangle_i.vertex.y[0+:C])),
        D'($signed(triangle_i.vertex.x[0+:C])),
        D'($signed(triangle_i.vertex.x[2*C+:C])),
        D'($signed(triangle_i.vertex.x[C+:C])),
        D'($signed(triangle_i.vertex.x[0+:C]))
      };
    end else if (is_turn || state_q == SUBTRACT) ring_q <= {ring_in, ring_q[RING-1:1]};

    if (load) begin
      min_q <= triangle_i.vertex.code[CODES+:CODES];
      max_q <= triangle_i.vertex.code[2*CODES+:CODES];
    end else if (moves_codes) begin
      min_q <= {min_in, min_q[CODES-1:1]};
      max_q <= {max_in, max_q[CODES-1:1]};
    end

    // The codes of vertex 0 wait in the highest bits of step_x.
    if (load) step_x_q[CHAIN-1-:CODES] <= triangle_i.vertex.code[0+:CODES];
    else if (moves_codes || (keeps && is_x_q) || state_q == VALUE_X)
      step_x_q <= {is_numerator ? c0 : is_gradient ? sum : step_x_q[0], step_x_q[CHAIN-1:1]};

    if (load) step_y_q <= anchors[0+:CHAIN];
    else if (state_q == SUBTRACT || (keeps && !is_x_q) || state_q == VALUE_Y)
      step_y_q <= {is_gradient ? sum : is_value ? step_y_q[0] : value_q[0], step_y_q[CHAIN-1:1]};

    if (load) value_q <= anchors[CHAIN+:CHAIN];
    else if (state_q == TURN_C) value_q <= base;
    else if (state_q == SUBTRACT || is_numerator || moves_numerator || is_value)
      value_q <= {sum, value_q[CHAIN-1:1]};
  end

  // ------------------------------------------------------------------------------------------------ differences, range
  // A word of the ring is subtracted from the next one, or from the anchor.
  logic minuend, borrow_q;
  assign minuend = unit_q[1:0] == 2'd3 ? step_y_q[0] : ring_q[D];
  assign ring_in = is_turn ? ring_q[0] : minuend ^ ring_q[0] ^ borrow_q;

  // Codes have no sign, so the last borrow is the sign of a difference.
  logic              borrow_10_q, borrow_20_q, borrow_21_q;
  logic              ac, bc;
  logic [PLANES-1:0] is_1_below_0_q, is_2_below_0_q, is_2_below_1_q;  // from the pass before; the current plane lowest
  logic              sorts, is_min_1, is_min_2, is_max_1, is_max_2;
  assign c0       = step_x_q[CHAIN-CODES];
  assign c1       = min_q[0];
  assign c2       = max_q[0];
  assign ac       = moves_codes ? c1 ^ c0 ^ borrow_10_q : borrow_10_q;
  assign bc       = moves_codes ? c2 ^ c0 ^ borrow_20_q : borrow_20_q;
  assign sorts    = state_q == SECOND && is_x_q;
  assign is_min_2 = sorts && (is_1_below_0_q[0] ? is_2_below_1_q[0] : is_2_below_0_q[0]);
  assign is_min_1 = !sorts || (is_1_below_0_q[0] && !is_2_below_1_q[0]);
  assign is_max_2 = !sorts || !(is_1_below_0_q[0] ? is_2_below_0_q[0] : is_2_below_1_q[0]);
  assign is_max_1 = sorts && !is_1_below_0_q[0] && is_2_below_1_q[0];
  assign min_in   = is_min_2 ? c2 : is_min_1 ? c1 : c0;
  assign max_in   = is_max_2 ? c2 : is_max_1 ? c1 : c0;

  always_ff @(posedge clk_i) begin
    if (is_last_bit || load) borrow_q <= 1'b0;
    else borrow_q <= minuend ? ring_q[0] && borrow_q : ring_q[0] || borrow_q;
    if (unit_ends || load) begin
      borrow_10_q <= 1'b0;
      borrow_20_q <= 1'b0;
      borrow_21_q <= 1'b0;
    end else if (moves_codes) begin
      borrow_10_q <= c1 ? c0 && borrow_10_q : c0 || borrow_10_q;
      borrow_20_q <= c2 ? c0 && borrow_20_q : c0 || borrow_20_q;
      borrow_21_q <= c2 ? c1 && borrow_21_q : c1 || borrow_21_q;
    end
    if (is_numerator && unit_ends) begin
      is_1_below_0_q <= {borrow_10_q, is_1_below_0_q[PLANES-1:1]};
      is_2_below_0_q <= {borrow_20_q, is_2_below_0_q[PLANES-1:1]};
      is_2_below_1_q <= {borrow_21_q, is_2_below_1_q[PLANES-1:1]};
    end
  end

  // For each plane the bits of the quotient that it keeps, and below them the highest dropped bit.
  logic [PLANES*R-1:0] reciprocals;
  logic [R-1:0]        reciprocal;
  genvar b;
  generate
    for (p = 0; p < PLANES; p++) begin : gen_reciprocal
      localparam int DROPPED = R - RECIPROCAL_BITS_OF[32*p+:32];
      for (b = 0; b < R; b++) begin : gen_bit
        assign reciprocals[p*R+b] = quotient_q[b<DROPPED?DROPPED : b];
      end
    end
  endgenerate
  always_comb begin
    reciprocal = reciprocals[0+:R];
    for (int i = 1; i < PLANES; i++) if (unit_q == UNIT'(i)) reciprocal = reciprocals[i*R+:R];
  end

  // ------------------------------------------------------------------------------------------------- multiply and add
  // The serial factor comes lowest bit first, sign-extended, so the product comes out modulo any power of two.
  logic               factor, sign_q, restarts, product, addend, negates, carry_q;
  logic [MOVED-1:0]   moved_q;  // bits of the numerator that have passed, after LEAD zeros
  logic [ACC-1:0]     operand;
  logic [ACC+1:0]     total;  // its lowest bit only makes the carry
  logic [ACC-1:0]     acc_q;

  assign moves_numerator = is_gradient && moved_q >= MOVED'(LEAD) && !has_moved_q;
  always_comb begin
    case (state_q)
      FIRST: factor = bc;
      SECOND: factor = ac;
      GRADIENT: factor = moves_numerator ? value_q[0] : sign_q;
      VALUE_X: factor = step_x_q[0];
      default: factor = step_y_q[0];
    endcase
  end
  // R = (quotient + 1) >> 1: rounding enters as a carry, through ones in place of the dropped bits of a plane.
  assign operand = is_gradient ? ACC'(reciprocal[R-1:1]) : ACC'($signed(ring_q[0+:D]));
  assign total   = {acc_q[ACC-1], acc_q, 1'b1} +
      {operand[ACC-1] && factor, operand & {ACC{factor}}, is_gradient && reciprocal[0] && factor};
  assign product = total[1];

  // N_x = -(bc dy0 + ac dy2), N_y = bc dx0 + ac dx2.
  assign negates  = is_x_q && !is_gradient;
  assign addend   = (state_q == SECOND || is_value) && value_q[0];
  assign sum      = addend ^ product ^ negates ^ carry_q;
  assign restarts = unit_ends || !(is_numerator || is_gradient || is_value);

  always_ff @(posedge clk_i) begin
    if (restarts) begin
      sign_q  <= 1'b0;
      acc_q   <= '0;
      moved_q <= '0;
      has_moved_q <= 1'b0;
      carry_q <= negates;
    end else begin
      sign_q <= factor;
      acc_q  <= total[ACC+1:2];
      if (!has_moved_q) moved_q <= moved_q + MOVED'(1);
      has_moved_q <= has_moved_q || moved_q == last_moved;
      if (is_gradient && !keeps_q) carry_q <= product;  // the last dropped bit rounds
      else carry_q <= addend ? (product ^ negates) || carry_q : (product ^ negates) && carry_q;
    end
  end

  // ----------------------------------------------------------------------------------------------------------- result
  assign setup_valid_o    = state_q == OFFER;
  assign triangle_ready_o = state_q == TAKE;

  assign setup_o.kind         = triangle_i.kind;
  assign setup_o.primitive_id = triangle_i.primitive_id;
  assign setup_o.box          = triangle_i.box;
  assign setup_o.state        = triangle_i.state;
  assign setup_o.dx           = ring_q[D+:3*D];  // the ring has rotated by 15 words
  assign setup_o.dy           = ring_q[5*D+:3*D];
  assign setup_o.edge_value   = triangle_i.edge_value;
  assign setup_o.value        = value_q;
  assign setup_o.step_x       = step_x_q;
  assign setup_o.step_y       = step_y_q;
  assign setup_o.range.low    = min_q;
  assign setup_o.range.high   = max_q;

endmodule
