// Triangle setup: all constants of a triangle, from its three vertices: the reciprocal of its area, and for each plane
// two gradients and the value at the anchor of its first tile.
//
// A triangle goes from phase to phase, a cycle each. A part is a group of phases as long as all planes take, a cycle or
// two each (setup.plane_clocks); a part holds one triangle, which waits in its last phase until the next part is free.
// Plane p is processed p or 2 p phases after plane 0, so that planes follow each other, and planes of one triangle
// follow the previous triangle's planes:
//   divide       the highest bit of the area; R = floor(2^k / A + 1/2), two quotient bits a cycle
//                (for each plane as many bits of R as its codes need, rounded separately)
//   differences  of the codes, and their ranges
//   numerators   N_x, N_y
//   gradients    round(N * R * 2^(F-k))
//   values       c_0 + g_x (x - x_0) + g_y (y - y_0)
// With one cycle per plane there are two lanes, for x and for y. With two there is one, which has x in a plane's first
// cycle and y in its second: half of the multipliers, one shifter. The result of a plane in a phase stands in one
// register until the next plane's. Such a register moves while any plane is in the phases around it, in whichever part:
// no register is overwritten while in use, because a triangle is never a step less far than the younger one in the part
// before. Occupancy: the cycles of all planes. Latency (embedded): 21, with two cycles per plane 25. As many triangles
// are under way as there are parts, six or four. With the planes of a texture unit states bypass the parts
// (setup_states.sv), a cycle each. Specification: model/stages/triangle_setup.hpp.
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
  localparam int CLOCKS = raster_pkg::SETUP_PLANE_CLOCKS;  // cycles per plane
  localparam int LANES = 2 / CLOCKS;                       // x and y, or x and then y
  localparam logic [32*PLANES-1:0] CODE_BITS_OF = raster_pkg::CODE_BITS_OF;
  localparam logic [32*PLANES-1:0] CODE_AT = raster_pkg::CODE_AT;
  localparam logic [32*PLANES-1:0] RECIPROCAL_BITS_OF = raster_pkg::RECIPROCAL_BITS_OF;
  localparam logic [32*PLANES-1:0] PLANE_BITS_OF = raster_pkg::PLANE_BITS_OF;
  localparam logic [32*PLANES-1:0] PLANE_AT = raster_pkg::PLANE_AT;
  localparam int CODES = raster_pkg::ALL_CODE_BITS;  // bits of a vertex's codes
  localparam int T = raster_pkg::TRIANGLE_PACKET_BITS;
  localparam int AFFINE = raster_pkg::AFFINE_PLANES;  // the later planes start at the vertex of the smallest 1/w
  // The parts have the width of the widest plane, whichever is processed.
  localparam int Z = raster_pkg::MAX_CODE_BITS;
  localparam int ZA = raster_pkg::MAX_AFFINE_CODE_BITS;  // bits of the planes that have a range
  localparam int ZW = CODE_BITS_OF[32*(PLANES>AFFINE?AFFINE:0)+:32];  // bits of 1/w
  localparam int ZC = ZW > ZA ? ZW : ZA;  // bits of the codes that are compared
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

  // ----------------------------------------------------------------------------------------------------------- phases
  // Phase 0 finds the highest bit. The quotient has one bit before the point and R after it, one more than is kept, for
  // the rounding.
  localparam int STEPS = PLANES * CLOCKS;  // phases of a part
  localparam int BITS_PER_CYCLE = 2;
  localparam int DIVIDE_CYCLES = (R + BITS_PER_CYCLE) / BITS_PER_CYCLE;
  localparam int DIVIDERS = (DIVIDE_CYCLES + STEPS - 1) / STEPS;
  localparam int QUOTIENT = BITS_PER_CYCLE * DIVIDE_CYCLES;
  localparam int ROUND = 1 + DIVIDE_CYCLES;
  // For plane 0:
  localparam int PRODUCT = ROUND + 1;  // N * R
  localparam int SHIFT = PRODUCT + 1;  // gradient
  localparam int MOVE = SHIFT + 1;     // step to the anchor
  localparam int SUM = MOVE + 1;
  localparam int NUMERATOR = PRODUCT - 2;        // and the next phase
  localparam int CORNERS = NUMERATOR + 1 - CLOCKS;  // from here on the corners' differences are known
  // Differences of codes; where a plane takes two cycles, both lie in one part.
  localparam int DELTA = (NUMERATOR - CLOCKS) / CLOCKS * CLOCKS;
  localparam int DELTA_PART = DELTA / STEPS;      // and the next part
  localparam int DELTA_LEFT = NUMERATOR - CLOCKS - DELTA;  // 1 if they wait a cycle for the numerators
  localparam int BASE = MOVE + AFFINE - 1;  // one cycle per plane: the vertex of the smallest 1/w is used from here on
  localparam int OFFER = SUM + STEPS;
  localparam int LAST_PART = OFFER / STEPS;
  localparam int PARTS = LAST_PART + 1;

  logic [OFFER:0]     at_q, at_d;  // a triangle is in the phase
  logic [OFFER-1:0]   moves;       // and goes on
  logic [PARTS-1:0]   ready_q, ready_d;
  logic [SUM:DELTA]   flows;  // some plane moves: from this phase if it is plane 0
  logic               takes, leaves, made_ready;

  // A part is ready when it is empty, or when the triangle in its last phase moves on. The last part is free a cycle
  // after its setup was taken: so the ready parts are known a cycle ahead.
  always_comb begin
    moves = at_q[OFFER-1:0];
    for (int i = 0; i < LAST_PART; i++) moves[i*STEPS+STEPS-1] = at_q[i*STEPS+STEPS-1] && ready_q[i+1];
    for (int i = DELTA; i <= SUM; i++) flows[i] = moves[i+:STEPS] != '0;
    at_d               = {moves, takes} | (at_q & ~{leaves, moves});
    ready_d            = '0;
    ready_d[LAST_PART] = at_d[OFFER:LAST_PART*STEPS] == '0;
    for (int i = LAST_PART - 1; i >= 0; i--)
      ready_d[i] = at_d[i*STEPS+:STEPS] == '0 || (at_d[i*STEPS+STEPS-1] && ready_d[i+1]);
  end
  assign leaves = at_q[OFFER] && made_ready;

  logic clk;
  clock_gate u_clock_gate (
      .clk_i,
      .reset_i (!rst_ni),
      .enable_i(takes || leaves || moves != '0),
      .clk_o   (clk)
  );

  always_ff @(posedge clk or negedge rst_ni) begin
    if (!rst_ni) begin
      at_q    <= '0;
      ready_q <= '1;
    end else begin
      at_q    <= at_d;
      ready_q <= ready_d;
    end
  end

  logic [PARTS*T-1:0] packets_q;  // one per part
  raster_pkg::triangle_packet_t first_packet, delta_packet, behind_packet, corner_packet, anchor_packet, base_packet,
      last_packet;
  assign first_packet  = packets_q[0+:T];
  assign delta_packet  = packets_q[DELTA_PART*T+:T];
  assign behind_packet = packets_q[(DELTA_PART+1)*T+:T];  // for planes that come after the triangle has moved on
  assign corner_packet = packets_q[(CORNERS-1)/STEPS*T+:T];
  assign anchor_packet = packets_q[(MOVE-CLOCKS)/STEPS*T+:T];
  assign base_packet   = packets_q[(PLANES>AFFINE?BASE/STEPS:0)*T+:T];
  assign last_packet   = packets_q[LAST_PART*T+:T];
  always_ff @(posedge clk) begin
    if (ready_q[0]) packets_q[0+:T] <= triangle_i;
    for (int i = 1; i < PARTS; i++) if (ready_q[i]) packets_q[i*T+:T] <= packets_q[(i-1)*T+:T];
  end

  // ----------------------------------------------------------------------------------------------------------- divide
  // The highest set bit of the area, 2^m: the lowest set bit of the mirrored area, which a carry finds.
  logic [A-1:0] first_area, mirrored, least, highest;
  assign first_area = first_packet.area;
  assign least      = mirrored & -mirrored;
  always_comb begin
    for (int i = 0; i < A; i++) begin
      mirrored[i] = first_area[A-1-i];
      highest[i]  = least[A-1-i];
    end
  end

  // Non-restoring division of 2^m, from the bit before the point, which is 1 only for A = 2^m. The sign of the
  // remainder less the area is the next bit. A negative remainder is not restored: the next step adds the area instead
  // of subtracting it. So the chain subtracts or adds, and the register holds twice its last result. Each divider
  // continues the previous one.
  localparam int AREA_AT = 3 * raster_pkg::EDGE_VALUE_BITS +  // in a packet
                           (raster_pkg::MSAA_SAMPLES > 1 ? 3 * raster_pkg::GRID_BITS : 0);
  localparam int REMAINDER = A + 2;                          // bounds: -2 A <= remainder < 2 A
  logic [DIVIDERS*REMAINDER-1:0] remainders;
  logic [DIVIDERS*QUOTIENT-1:0]  quotients;
  genvar d, b;
  generate
    for (d = 0; d < DIVIDERS; d++) begin : gen_divider
      localparam int CYCLES = d == DIVIDERS - 1 ? DIVIDE_CYCLES - d * STEPS : STEPS;
      localparam int BITS = BITS_PER_CYCLE * CYCLES;
      localparam int HEAD = BITS_PER_CYCLE * STEPS * d;  // bits of the earlier dividers
      logic [A-1:0]         area_q;
      logic [REMAINDER-1:0] remainder_q, remainder_d, start;
      logic [BITS-1:0]      bits_q, bits_d;
      logic [BITS_PER_CYCLE-1:0] newest;
      logic                 loads, iterates;
      assign loads    = moves[d*STEPS];
      assign iterates = moves[d*STEPS+1+:CYCLES] != '0;
      for (b = 0; b < BITS_PER_CYCLE; b++) begin : gen_bit
        logic [REMAINDER-1:0] from;
        logic [REMAINDER-2:0] rest;  // remainder less the area; one bit shorter
        if (b == 0) begin : gen_first_bit
          assign from = remainder_q;
        end else begin : gen_next_bit
          assign from = {gen_bit[b-1].rest, 1'b0};
        end
        add_or_subtract #(
            .WIDTH(REMAINDER - 1)
        ) u_rest (
            .subtracts_i(!from[REMAINDER-1]),
            .a_i        (from[REMAINDER-2:0]),
            .b_i        ({1'b0, area_q}),
            .sum_o      (rest)
        );
        assign newest[BITS_PER_CYCLE-1-b] = !rest[REMAINDER-2];
      end
      assign bits_d      = BITS'({bits_q, newest});
      assign remainder_d = {gen_bit[BITS_PER_CYCLE-1].rest, 1'b0};
      always_ff @(posedge clk) begin
        if (loads) begin
          area_q      <= packets_q[d*T+AREA_AT+:A];
          remainder_q <= start;
        end else if (iterates) remainder_q <= remainder_d;
        if (iterates) bits_q <= bits_d;
      end
      assign remainders[d*REMAINDER+:REMAINDER] = remainder_d;
      if (d == 0) begin : gen_first
        assign start                          = {2'b00, highest};
        assign quotients[d*QUOTIENT+:QUOTIENT] = QUOTIENT'(bits_d);
      end else begin : gen_next
        logic [HEAD-1:0] head_q;
        assign start                          = remainders[(d-1)*REMAINDER+:REMAINDER];
        assign quotients[d*QUOTIENT+:QUOTIENT] = QUOTIENT'({head_q, bits_d});
        always_ff @(posedge clk) if (loads) head_q <= quotients[(d-1)*QUOTIENT+:HEAD];
      end
    end
  endgenerate

  // m, when 2^m stands in the first divider.
  logic [M-1:0] log2_area;
  always_comb begin
    log2_area = '0;
    for (int i = 0; i < A; i++) if (gen_divider[0].remainder_q[i]) log2_area = log2_area | M'(i);
  end

  // For each plane the upper bits, rounded by the next one; the lower bits and spare bits are dropped.
  logic [QUOTIENT-1:0] quotient_q;
  logic [PLANES*R-1:0] uppers, halves;
  logic [R-1:0]        upper, half, reciprocal, reciprocal_q;
  genvar p;
  generate
    for (p = 0; p < PLANES; p++) begin : gen_reciprocal
      localparam int B = RECIPROCAL_BITS_OF[32*p+:32];
      assign uppers[p*R+:R] = R'(quotient_q[QUOTIENT-B+:B]) << (R - B);
      assign halves[p*R+:R] = R'(quotient_q[QUOTIENT-B-1]) << (R - B);
    end
  endgenerate
  always_comb begin
    upper = '0;
    half  = '0;
    for (int i = 0; i < PLANES; i++) begin
      if (at_q[ROUND+CLOCKS*i+:CLOCKS] != '0) begin
        upper = upper | uppers[i*R+:R];
        half  = half | halves[i*R+:R];
      end
    end
  end
  assign reciprocal = upper + half;
  always_ff @(posedge clk) begin
    if (moves[ROUND-1]) quotient_q <= quotients[(DIVIDERS-1)*QUOTIENT+:QUOTIENT];
    if (flows[ROUND]) reciprocal_q <= reciprocal;
  end

  // ------------------------------------------------------------------------------------------------------- differences
  // A plane's code at each vertex, the differences from vertex 0, the range. The cycles of a plane are in one part.
  localparam int CZ = Z + 1;  // with a sign
  logic [PLANES*CZ-1:0]        codes_0, codes_1, codes_2;
  logic [PLANES-1:0]           plane_differs;  // the differences of the plane are computed
  // Planes over w start at the vertex of the smallest 1/w, the first of several: vertex 2, 1, or neither. Plane AFFINE
  // is 1/w.
  logic [1:0]                  base, base_q;
  logic                        differs_over_w, differs_in_w;
  generate
    for (p = 0; p < PLANES; p++) begin : gen_codes
      localparam int B = CODE_BITS_OF[32*p+:32];
      localparam int AT = CODE_AT[32*p+:32];
      localparam bit SIGNED = p > AFFINE;  // u and v
      localparam bit IS_BEHIND = (DELTA + CLOCKS * p) / STEPS != DELTA_PART;
      logic [B-1:0] code_0, code_1, code_2;
      assign code_0            = IS_BEHIND ? behind_packet.vertex.code[AT+:B] : delta_packet.vertex.code[AT+:B];
      assign code_1            = IS_BEHIND ? behind_packet.vertex.code[CODES+AT+:B] :
                                 delta_packet.vertex.code[CODES+AT+:B];
      assign code_2            = IS_BEHIND ? behind_packet.vertex.code[2*CODES+AT+:B] :
                                 delta_packet.vertex.code[2*CODES+AT+:B];
      assign codes_0[p*CZ+:CZ] = {{(CZ - B) {SIGNED && code_0[B-1]}}, code_0};
      assign codes_1[p*CZ+:CZ] = {{(CZ - B) {SIGNED && code_1[B-1]}}, code_1};
      assign codes_2[p*CZ+:CZ] = {{(CZ - B) {SIGNED && code_2[B-1]}}, code_2};
      assign plane_differs[p]  = at_q[DELTA+CLOCKS*p+:CLOCKS] != '0;
    end
    if (PLANES > AFFINE) begin : gen_base
      assign differs_over_w = plane_differs[PLANES-1:AFFINE] != '0;
      assign differs_in_w   = plane_differs[AFFINE];
      always_ff @(posedge clk) if (moves[DELTA+CLOCKS*AFFINE+CLOCKS-1]) base_q <= base;
    end else begin : gen_no_base
      assign differs_over_w = 1'b0;
      assign differs_in_w   = 1'b0;
      assign base_q         = 2'b00;
    end
  endgenerate

  // Start of a plane: the code at vertex 0, with the offset of its window added (see values), or the code at the vertex
  // of the smallest 1/w.
  function automatic [Z:0] window_of(input [CZ-1:0] code, input [PLANES-1:0] plane);
    window_of = code;
    for (int i = 0; i < AFFINE; i++) begin
      if (plane[i]) begin
        window_of[CODE_BITS_OF[32*i+:32]]   = code[CODE_BITS_OF[32*i+:32]-1];
        window_of[CODE_BITS_OF[32*i+:32]-1] = !code[CODE_BITS_OF[32*i+:32]-1];
      end
    end
  endfunction

  // Inputs of later phases travel with a plane: the differences up to the numerators, the start up to the values.
  localparam int START = SUM + 1 - CLOCKS;               // the phase that takes the start
  localparam int TO_START = START - DELTA - CLOCKS + 1;  // number of registers
  logic signed [CZ-1:0]    c0;
  logic [CZ-1:0]           low, high;
  logic [DC-1:0]           ac_q, bc_q;
  logic [TO_START*(Z+1)-1:0] start_q;  // the newest lowest
  logic [Z:0]              start;
  logic                    starts;     // the plane is valid, and goes there
  always_comb begin
    c0 = '0;
    for (int i = 0; i < PLANES; i++) if (plane_differs[i]) c0 = c0 | codes_0[i*CZ+:CZ];
  end
  always_ff @(posedge clk) begin
    if (starts) start_q[0+:Z+1] <= start;
    for (int i = 1; i < TO_START; i++)
      if (flows[DELTA+CLOCKS-1+i]) start_q[i*(Z+1)+:Z+1] <= start_q[(i-1)*(Z+1)+:Z+1];
  end
  generate
    if (CLOCKS == 1) begin : gen_differences
      logic signed [CZ-1:0] c1, c2;
      logic signed [DC-1:0] ac, bc;
      logic                 is_1_below_0, is_2_below_0, is_2_below_1, is_1_less, is_2_less;
      logic [1:0]           vertex;
      always_comb begin
        c1 = '0;
        c2 = '0;
        for (int i = 0; i < PLANES; i++) begin
          if (plane_differs[i]) begin
            c1 = c1 | codes_1[i*CZ+:CZ];
            c2 = c2 | codes_2[i*CZ+:CZ];
          end
        end
      end
      assign ac           = $signed(DC'(c1) - DC'(c0));
      assign bc           = $signed(DC'(c2) - DC'(c0));
      assign is_1_below_0 = ac[DC-1];
      assign is_2_below_0 = bc[DC-1];
      assign is_2_below_1 = c2[ZC-1:0] < c1[ZC-1:0];
      assign low          = is_1_below_0 ? (is_2_below_1 ? c2 : c1) : (is_2_below_0 ? c2 : c0);
      assign high         = is_1_below_0 ? (is_2_below_0 ? c0 : c2) : (is_2_below_1 ? c1 : c2);
      assign is_1_less    = is_1_below_0;
      assign is_2_less    = is_1_below_0 ? is_2_below_1 : is_2_below_0;
      assign base         = {is_2_less, is_1_less && !is_2_less};
      assign vertex       = differs_in_w ? base : base_q & {2{differs_over_w}};
      assign start        = vertex[1] ? c2 : vertex[0] ? c1 : window_of(c0, plane_differs);
      assign starts       = flows[DELTA];
      always_ff @(posedge clk) begin
        if (flows[DELTA]) begin
          ac_q <= ac;
          bc_q <= bc;
        end
      end
    end else begin : gen_shared_differences
      // Vertex 1, then vertex 2; results of the first two comparisons wait in registers.
      logic signed [CZ-1:0] other;
      logic signed [DC-1:0] difference;
      logic [DC-1:0]        first_q, pair_a_q, pair_b_q;
      logic [CZ-1:0]        least_q, most_q;
      logic [ZC-1:0]        code_1_q;
      logic                 is_1_below_0_q, is_2_below_1, is_least, is_most, is_second, starts_at_1, starts_at_2;
      always_comb begin
        other     = '0;
        is_second = 1'b0;
        for (int i = 0; i < PLANES; i++) begin
          if (at_q[DELTA+CLOCKS*i]) other = other | codes_1[i*CZ+:CZ];
          if (at_q[DELTA+CLOCKS*i+1]) other = other | codes_2[i*CZ+:CZ];
          is_second = is_second | at_q[DELTA+CLOCKS*i+1];
        end
      end
      assign difference   = $signed(DC'(other) - DC'(c0));
      assign is_2_below_1 = other[ZC-1:0] < code_1_q;
      assign is_least     = is_1_below_0_q ? is_2_below_1 : difference[DC-1];
      assign is_most      = is_1_below_0_q ? !difference[DC-1] : !is_2_below_1;
      assign low          = is_least ? other : least_q;
      assign high         = is_most ? other : most_q;
      assign base         = {is_least, is_1_below_0_q && !is_least};
      assign starts_at_1  = differs_in_w ? difference[DC-1] : base_q[0];
      assign starts_at_2  = differs_in_w ? is_least : base_q[1];
      assign start        = differs_over_w && (is_second || starts_at_1) ? other : window_of(c0, plane_differs);
      assign starts       = flows[DELTA] && (!is_second || (differs_over_w && starts_at_2));
      always_ff @(posedge clk) begin
        if (flows[DELTA]) begin
          if (is_second) begin
            pair_a_q <= first_q;
            pair_b_q <= difference;
          end else begin
            first_q        <= difference;
            is_1_below_0_q <= difference[DC-1];
            code_1_q       <= other[ZC-1:0];
            least_q        <= difference[DC-1] ? other : c0;
            most_q         <= difference[DC-1] ? c0 : other;
          end
        end
      end
      if (DELTA_LEFT == 0) begin : gen_at_once
        assign ac_q = pair_a_q;
        assign bc_q = pair_b_q;
      end else begin : gen_waits
        always_ff @(posedge clk) begin
          if (flows[NUMERATOR-1]) begin
            ac_q <= pair_a_q;
            bc_q <= pair_b_q;
          end
        end
      end
    end
  endgenerate

  // The ranges of a triangle stay with the later parts. Planes over w have none.
  localparam int RANGES = 2 * AFFINE * ZA;
  localparam int RANGED = DELTA + CLOCKS * AFFINE - 1;  // the last range is complete
  localparam int RANGE_PART = (RANGED + 1) / STEPS;
  logic                    finds_range;
  logic [(AFFINE-1)*ZA-1:0] low_q, high_q;  // the newest lowest
  logic [(PARTS-RANGE_PART)*RANGES-1:0] ranges_q;
  always_comb begin
    finds_range = 1'b0;
    for (int i = 0; i < AFFINE; i++) finds_range = finds_range | moves[DELTA+CLOCKS*i+CLOCKS-1];
  end
  always_ff @(posedge clk) begin
    if (finds_range) begin
      low_q  <= {low[ZA-1:0], low_q[(AFFINE-1)*ZA-1:ZA]};
      high_q <= {high[ZA-1:0], high_q[(AFFINE-1)*ZA-1:ZA]};
    end
    if (moves[RANGED]) ranges_q[0+:RANGES] <= {high[ZA-1:0], high_q, low[ZA-1:0], low_q};
    for (int i = RANGE_PART + 1; i < PARTS; i++)
      if (ready_q[i]) ranges_q[(i-RANGE_PART)*RANGES+:RANGES] <= ranges_q[(i-RANGE_PART-1)*RANGES+:RANGES];
  end

  // -------------------------------------------------------------------------------------------------------- numerators
  // N_x = ac by - bc ay, N_y = ac (-bx) - bc (-ax).
  logic signed [D-1:0]       minus_ax_q, ay_q, minus_bx_q, by_q;
  logic [LANES*2*D-1:0]      factors;  // {-bx, -ax} or {by, ay}
  logic [LANES*N-1:0]        numerator;
  logic                      multiplies;
  assign multiplies = flows[NUMERATOR] || flows[NUMERATOR+1];
  always_ff @(posedge clk) begin
    if (moves[CORNERS-1]) begin
      minus_ax_q <= D'($signed(corner_packet.vertex.x[0+:C])) - D'($signed(corner_packet.vertex.x[C+:C]));
      ay_q       <= D'($signed(corner_packet.vertex.y[C+:C])) - D'($signed(corner_packet.vertex.y[0+:C]));
      minus_bx_q <= D'($signed(corner_packet.vertex.x[0+:C])) - D'($signed(corner_packet.vertex.x[2*C+:C]));
      by_q       <= D'($signed(corner_packet.vertex.y[2*C+:C])) - D'($signed(corner_packet.vertex.y[0+:C]));
    end
  end

  // The second cycle of some plane is in the phases from there on.
  function automatic is_y_in(input [STEPS-1:0] phases);
    is_y_in = 1'b0;
    for (int i = CLOCKS - 1; i < STEPS; i += CLOCKS) is_y_in = is_y_in | phases[i];
  endfunction

  genvar lane;
  generate
    if (LANES == 2) begin : gen_factors
      assign factors = {minus_bx_q, minus_ax_q, by_q, ay_q};
    end else begin : gen_shared_factors
      logic [2*D-1:0] factors_q;
      assign factors = factors_q;
      always_ff @(posedge clk)
        if (flows[NUMERATOR-1])
          factors_q <= is_y_in(at_q[NUMERATOR-1+:STEPS]) ? {minus_bx_q, minus_ax_q} : {by_q, ay_q};
    end
    for (lane = 0; lane < LANES; lane++) begin : gen_numerator
      cross_product #(
          .A_BITS  (DC),
          .D_BITS  (D),
          .OUT_BITS(N)
      ) u_numerator (
          .clk_i   (clk),
          .enable_i(multiplies),
          .a_i     (ac_q),
          .b_i     (bc_q),
          .c_i     (factors[2*lane*D+:D]),
          .d_i     (factors[(2*lane+1)*D+:D]),
          .bias_i  (1'b0),
          .result_o(numerator[lane*N+:N])
      );
    end
  endgenerate

  // The directions of the edges, in the part that is entered meanwhile and in later ones.
  localparam int EDGE_PART = CORNERS / STEPS + 1;
  logic [(PARTS-EDGE_PART)*6*D-1:0] edges_q;
  always_ff @(posedge clk) begin
    for (int i = EDGE_PART; i < PARTS; i++) begin
      if (ready_q[i]) begin
        if (i == EDGE_PART)
          edges_q[0+:6*D] <= {-by_q, by_q - ay_q, ay_q, minus_bx_q, minus_ax_q - minus_bx_q, -minus_ax_q};
        else edges_q[(i-EDGE_PART)*6*D+:6*D] <= edges_q[(i-EDGE_PART-1)*6*D+:6*D];
      end
    end
  end

  // -------------------------------------------------------------------------------------------------------- gradients
  // round_shift(N * R, k - F): k - F = m + OFFSET, which may be negative: LEFT zeros go below the product first, so
  // that a shift to the right by at least 1 remains, whose last bit the rounding takes.
  localparam int OFFSET = R - 1 - F;
  localparam int LEFT = OFFSET < 1 ? 1 - OFFSET : 0;
  localparam int SHIFT_BASE = OFFSET + LEFT - 1;
  localparam int PRODUCT_BITS = N + R + 1;
  localparam int SHIFT_BITS = $clog2(A + SHIFT_BASE + 1);
  localparam int LOG2_PART = PRODUCT / STEPS;

  logic [(LOG2_PART+1)*M-1:0]         log2_q;  // one per part
  logic [SHIFT_BITS-1:0]              shift_q;
  logic [LANES*PRODUCT_BITS-1:0]      product_q;
  logic [LANES*P-1:0]                 step_q;  // gradient per subpixel

  always_ff @(posedge clk) begin
    if (moves[1]) log2_q[0+:M] <= log2_area;
    for (int i = 1; i <= LOG2_PART; i++) if (ready_q[i]) log2_q[i*M+:M] <= log2_q[(i-1)*M+:M];
    if (moves[SHIFT-1]) shift_q <= SHIFT_BITS'(log2_q[LOG2_PART*M+:M]) + SHIFT_BITS'(SHIFT_BASE);
  end
  generate
    for (lane = 0; lane < LANES; lane++) begin : gen_gradient
      logic signed [PRODUCT_BITS+LEFT-1:0] shifted;
      logic [PRODUCT_BITS-1:0] product;
      long_product #(
          .LEFT        (N),
          .RIGHT       (R),
          .RIGHT_SIGNED(0),
          .OUT         (PRODUCT_BITS)
      ) u_product (
          .left_i   (numerator[lane*N+:N]),
          .right_i  (reciprocal_q),
          .product_o(product)
      );
      assign shifted = $signed({product_q[lane*PRODUCT_BITS+:PRODUCT_BITS], {LEFT{1'b0}}}) >>> shift_q;
      always_ff @(posedge clk) begin
        if (flows[PRODUCT]) product_q[lane*PRODUCT_BITS+:PRODUCT_BITS] <= product;
        if (flows[SHIFT]) step_q[lane*P+:P] <= shifted[1+:P] + P'(shifted[0]);
      end
    end
  endgenerate

  // ----------------------------------------------------------------------------------------------------------- values
  // The centre of pixel (T/2, T/2) of the first tile, subpixels.
  function automatic signed [C:0] centre_x(input [PX-TS-1:0] tile);
    centre_x = $signed((C + 1)'({tile, 1'b1, {(TS - 1) {1'b0}}}) << S) + $signed((C + 1)'(1 << (S - 1)));
  endfunction
  function automatic signed [C:0] centre_y(input [PY-TS-1:0] tile);
    centre_y = $signed((C + 1)'({tile, 1'b1, {(TS - 1) {1'b0}}}) << S) + $signed((C + 1)'(1 << (S - 1)));
  endfunction
  logic signed [C:0] anchor_x, anchor_y;
  assign anchor_x = centre_x(anchor_packet.box.left[PX-1:TS]);
  assign anchor_y = centre_y(anchor_packet.box.top[PY-1:TS]);

  // A plane at its vertex: its code with F fraction bits, half a unit of the local plane's last place, and the offset
  // of its wrap window (LocalFormat), 2^(B-1), so that a tile's anchor is a shift.
  localparam logic [F-1:0] HALVES = F'(1) << (F - L - 1) | F'(1) << (F - 1);
  localparam logic [F-1:0] HALVES_OVER_W = F'(1) << (F - raster_pkg::PERSPECTIVE_GUARD_BITS - 1);  // no wrap window
  logic                    sums_over_w;         // a plane over w starts
  logic [LANES*D-1:0]      to;                  // offset of the anchor from the plane's vertex
  logic [LANES*P-1:0]      move_q;
  logic [P-1:0]            start_value, sum;    // modulo 2^P
  logic                    sums;                // sum is a plane's value
  logic [2*PLANES*P-1:0]   steps_q;             // {y, x}, the newest highest
  logic [(PLANES-1)*P-1:0] sums_q;              // the newest highest
  assign start_value = P'({start_q[(TO_START-1)*(Z+1)+:Z+1], sums_over_w ? HALVES_OVER_W : HALVES});
  generate
    if (PLANES > AFFINE) begin : gen_over_w
      assign sums_over_w = at_q[START+CLOCKS*AFFINE+:CLOCKS*(PLANES-AFFINE)] != '0;
    end else begin : gen_affine
      assign sums_over_w = 1'b0;
    end
    for (lane = 0; lane < LANES; lane++) begin : gen_move
      logic [P-1:0] move;
      long_product #(
          .LEFT        (P),
          .RIGHT       (D),
          .RIGHT_SIGNED(1),
          .OUT         (P)
      ) u_move (
          .left_i   (step_q[lane*P+:P]),
          .right_i  (to[lane*D+:D]),
          .product_o(move)
      );
      always_ff @(posedge clk) if (flows[MOVE]) move_q[lane*P+:P] <= move;
    end
    if (CLOCKS == 1) begin : gen_values
      logic signed [D-1:0] to_anchor_x_q, to_anchor_y_q;
      always_ff @(posedge clk) begin
        if (moves[MOVE-1]) begin
          to_anchor_x_q <= D'(anchor_x) - D'($signed(anchor_packet.vertex.x[0+:C]));
          to_anchor_y_q <= D'(anchor_y) - D'($signed(anchor_packet.vertex.y[0+:C]));
        end
      end
      // The same from the vertex of the smallest 1/w, for the planes over w.
      if (PLANES > AFFINE) begin : gen_base
        logic                moves_over_w;
        logic signed [C-1:0] base_x, base_y;
        logic signed [D-1:0] to_base_x_q, to_base_y_q;
        assign base_x       = base_q[1] ? base_packet.vertex.x[2*C+:C] :
                              base_q[0] ? base_packet.vertex.x[C+:C] : base_packet.vertex.x[0+:C];
        assign base_y       = base_q[1] ? base_packet.vertex.y[2*C+:C] :
                              base_q[0] ? base_packet.vertex.y[C+:C] : base_packet.vertex.y[0+:C];
        assign moves_over_w = at_q[MOVE+AFFINE+:PLANES-AFFINE] != '0;
        assign to           = moves_over_w ? {to_base_y_q, to_base_x_q} : {to_anchor_y_q, to_anchor_x_q};
        always_ff @(posedge clk) begin
          if (moves[BASE]) begin
            to_base_x_q <= D'(centre_x(base_packet.box.left[PX-1:TS])) - D'(base_x);
            to_base_y_q <= D'(centre_y(base_packet.box.top[PY-1:TS])) - D'(base_y);
          end
        end
      end else begin : gen_vertex_0
        assign to = {to_anchor_y_q, to_anchor_x_q};
      end
      // Two sums in series: for one sum of three terms Yosys puts full adders before the carry chain.
      logic [P-1:0] moved;
      add_or_subtract #(
          .WIDTH(P)
      ) u_moved (
          .subtracts_i(1'b0),
          .a_i        (start_value),
          .b_i        (move_q[0+:P]),
          .sum_o      (moved)
      );
      assign sum  = moved + move_q[(LANES-1)*P+:P];
      assign sums = flows[SUM];
    end else begin : gen_shared_values
      // The offset to the anchor from one corner after the other: the corners and anchors wait next to the parts.
      localparam int WAY = MOVE - 1;
      logic [6*C-1:0]      corners_q;  // {y, x} of vertex 2, 1, 0
      logic [2*(C+1)-1:0]  anchor_q;   // {y, x}
      logic [D-1:0]        to_q;
      logic                is_y;
      logic [C-1:0]        from_0, from;
      logic [C:0]          anchor;
      assign is_y   = is_y_in(at_q[WAY+:STEPS]);
      assign from_0 = is_y ? corners_q[C+:C] : corners_q[0+:C];
      assign anchor = is_y ? anchor_q[C+1+:C+1] : anchor_q[0+:C+1];
      assign to     = to_q;
      if (PLANES > AFFINE) begin : gen_base
        logic         is_over_w;
        logic [1:0]   vertex;
        logic [C-1:0] from_1, from_2;
        assign from_1    = is_y ? corners_q[3*C+:C] : corners_q[2*C+:C];
        assign from_2    = is_y ? corners_q[5*C+:C] : corners_q[4*C+:C];
        assign is_over_w = at_q[WAY+CLOCKS*AFFINE+:CLOCKS*(PLANES-AFFINE)] != '0;
        assign vertex    = base_q & {2{is_over_w}};
        assign from      = vertex[1] ? from_2 : vertex[0] ? from_1 : from_0;
      end else begin : gen_vertex_0
        assign from = from_0;
      end
      always_ff @(posedge clk) begin
        if (moves[WAY-1]) begin
          corners_q <= {anchor_packet.vertex.y[2*C+:C], anchor_packet.vertex.x[2*C+:C],
                        anchor_packet.vertex.y[C+:C], anchor_packet.vertex.x[C+:C],
                        anchor_packet.vertex.y[0+:C], anchor_packet.vertex.x[0+:C]};
          anchor_q  <= {anchor_y, anchor_x};
        end
        if (flows[WAY]) to_q <= D'($signed(anchor)) - D'($signed(from));
      end
      // One adder: the start of a plane waits in the register of the sum.
      logic         begins;
      logic [P-1:0] rest_q;
      always_comb begin
        begins = 1'b0;
        for (int i = 0; i < STEPS; i += CLOCKS) begins = begins | moves[START+i];
      end
      assign sum  = rest_q + move_q;
      assign sums = flows[SUM] && is_y_in(at_q[SUM+:STEPS]);
      always_ff @(posedge clk) begin
        if (begins) rest_q <= start_value;
        else if (flows[SUM]) rest_q <= sum;
      end
    end
  endgenerate
  always_ff @(posedge clk) begin
    if (flows[MOVE]) steps_q <= {step_q, steps_q[2*PLANES*P-1:LANES*P]};
    if (sums) sums_q <= {sum, sums_q[(PLANES-1)*P-1:P]};
  end

  // ------------------------------------------------------------------------------------------------------------ packet
  logic [2*PLANES*P-1:0] setup_steps_q;
  logic [PLANES*P-1:0]   setup_values_q;
  always_ff @(posedge clk) begin
    if (moves[OFFER-1]) begin
      setup_steps_q  <= steps_q;
      setup_values_q <= {sum, sums_q};
    end
  end

  raster_pkg::setup_packet_t made;
  assign made.kind         = last_packet.kind;
  assign made.primitive_id = last_packet.primitive_id;
  assign made.box          = last_packet.box;
  assign made.state        = last_packet.state;
  assign made.dx           = edges_q[(LAST_PART-EDGE_PART)*6*D+:3*D];
  assign made.dy           = edges_q[(LAST_PART-EDGE_PART)*6*D+3*D+:3*D];
  assign made.edge_value   = last_packet.edge_value;

  generate
    if (raster_pkg::MSAA_SAMPLES > 1) begin : gen_edge_lows
      assign made.edge_low = last_packet.edge_low;
    end
    for (p = 0; p < PLANES; p++) begin : gen_plane
      localparam int B = PLANE_BITS_OF[32*p+:32];
      localparam int AT = PLANE_AT[32*p+:32];
      localparam int CB = CODE_BITS_OF[32*p+:32];
      localparam int CODE = CODE_AT[32*p+:32];
      localparam int RANGE = (LAST_PART - RANGE_PART) * RANGES;
      assign made.value[AT+:B]         = setup_values_q[p*P+:B];
      assign made.step_x[AT+:B]        = setup_steps_q[2*p*P+:B];
      assign made.step_y[AT+:B]        = setup_steps_q[(2*p+1)*P+:B];
      if (p < AFFINE) begin : gen_range
        assign made.range.low[CODE+:CB]  = ranges_q[RANGE+p*ZA+:CB];
        assign made.range.high[CODE+:CB] = ranges_q[RANGE+(AFFINE+p)*ZA+:CB];
      end
    end
    if (raster_pkg::COORDINATES != 0) begin : gen_coordinates
      assign made.coordinates = last_packet.coordinates;
    end
  endgenerate

  generate
    if (raster_pkg::COORDINATES != 0) begin : gen_states
      setup_states u_states (
          .clk_i,
          .rst_ni,
          .triangle_valid_i,
          .triangle_ready_o,
          .triangle_i,
          .part_ready_i(ready_q[0]),
          .part_takes_o(takes),
          .made_valid_i(at_q[OFFER]),
          .made_ready_o(made_ready),
          .made_i      (made),
          .setup_valid_o,
          .setup_ready_i,
          .setup_o
      );
    end else begin : gen_triangles
      assign triangle_ready_o = ready_q[0];
      assign takes            = triangle_valid_i && triangle_ready_o;
      assign setup_valid_o    = at_q[OFFER];
      assign made_ready       = setup_ready_i;
      assign setup_o          = made;
    end
  endgenerate

endmodule
