// Cull for the smallest parts: the same bits as cull.sv, from one comparator and one bit-serial cross product.
//
// The vertices stand in a ring of three. Two moves bring them into any order: turn (0 <- 1 <- 2 <- 0) and swap (0 <-> 1).
//   SORT   the smallest (Y, X) to the front: compare, swap, turn twice, compare, swap
//   BOX    pixel centres within the bounds, cut by the scissor, one vertex a cycle
//   AREA   edge 0 at vertex 2, which is twice the area; a negative one swaps vertices 1 and 2 (FLIP) and is repeated
//   EDGES  the edge functions at the first pixel of the box's first tile
// Occupancy: about 4 to 5 times the bits of an edge function. primitive_i must stay until primitive_ready_o, which
// comes with the result: fields that only pass through are not stored. Specification: model/stages/cull.hpp.
module cull_serial (
    input logic clk_i,
    input logic rst_ni,

    // From the host
    input  logic                          primitive_valid_i,
    output logic                          primitive_ready_o,
    input  raster_pkg::primitive_packet_t primitive_i,

    // To triangle_setup
    output logic                         triangle_valid_o,
    input  logic                         triangle_ready_i,
    output raster_pkg::triangle_packet_t triangle_o,

    // Counters: one pulse for each triangle
    output logic is_primitive_o,  // triangles, points and lines
    output logic is_zero_area_o,
    output logic is_backface_o,
    output logic is_empty_o,
    output logic is_no_sample_o,  // always 0: this stage tests no samples
    output logic is_dropped_o  // a dropped primitive of any kind
);

  localparam int C = raster_pkg::COORDINATE_BITS;
  localparam int D = raster_pkg::DELTA_BITS;
  localparam int CODES = raster_pkg::ALL_CODE_BITS;  // bits of a vertex's codes
  localparam int S = raster_pkg::GRID_BITS;
  localparam int TS = raster_pkg::TILE_SHIFT;
  localparam int PX = raster_pkg::PIXEL_X_BITS;
  localparam int PY = raster_pkg::PIXEL_Y_BITS;
  localparam int A = raster_pkg::AREA_BITS;
  localparam int V = raster_pkg::EDGE_VALUE_BITS;
  localparam int KEY = 2 * C;  // (Y, X) as one unsigned number
  localparam int LAST = A > S + V - 1 ? A : S + V - 1;  // the highest significant bit of a product; A: its sign
  localparam int COUNT = $clog2(LAST + 2);

  // ---------------------------------------------------------------------------------------------------------- control
  localparam logic [2:0] IDLE = 3'd0, SORT = 3'd1, BOX = 3'd2, AREA = 3'd3, JUDGE = 3'd4, FLIP = 3'd5, EDGES = 3'd6,
      OFFER = 3'd7;
  logic [2:0]       state_q;
  logic [COUNT-1:0] count_q;  // cycles in this state, or of this edge
  logic [1:0]       edge_q;
  logic             is_triangle, is_counted, takes, leaves, is_dropped, multiplies, product_ends;
  logic             is_negative_q;  // the area is negative
  assign is_triangle  = primitive_i.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE;
  assign is_counted   = is_triangle || primitive_i.kind[2];  // point, line
  assign takes        = state_q == IDLE && primitive_valid_i;
  assign multiplies   = state_q == AREA || state_q == EDGES;
  assign product_ends = multiplies && count_q == COUNT'(LAST + 1);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) state_q <= IDLE;
    else begin
      case (state_q)
        IDLE: if (takes) state_q <= SORT;
        SORT: if (count_q == COUNT'(5)) state_q <= BOX;
        BOX: if (count_q == COUNT'(4)) state_q <= is_triangle ? AREA : OFFER;
        AREA: if (product_ends) state_q <= JUDGE;
        JUDGE:
        if (is_dropped) state_q <= leaves ? IDLE : JUDGE;
        else state_q <= is_negative_q ? FLIP : EDGES;
        FLIP: state_q <= AREA;
        EDGES: if (product_ends && edge_q == 2'd2) state_q <= OFFER;
        default: if (leaves) state_q <= IDLE;
      endcase
    end
  end

  always_ff @(posedge clk_i) begin
    if (state_q == IDLE || state_q == JUDGE || state_q == FLIP || product_ends) count_q <= '0;
    else if (state_q == SORT ? count_q == COUNT'(5) : !multiplies && count_q == COUNT'(4)) count_q <= '0;
    else count_q <= count_q + COUNT'(1);
    if (state_q != EDGES) edge_q <= 2'd0;
    else if (product_ends) edge_q <= edge_q + 2'd1;
  end

  // --------------------------------------------------------------------------------------------------------- vertices
  // Vertex 0 is the subtrahend of all differences: its registers hold complements, so that no gate stands before a
  // carry.
  logic [C-1:0]     not_x0_q, not_y0_q, x0, y0, x1_q, x2_q, y1_q, y2_q;
  logic [CODES-1:0] not_code0_q, code0, code1_q, code2_q;
  logic             turns, swaps, is_odd_q;  // is_odd_q: the order is opposite to the host's
  assign x0    = ~not_x0_q;
  assign y0    = ~not_y0_q;
  assign code0 = ~not_code0_q;

  // Flipping the sign bits makes signed numbers comparable as unsigned ones. Equal keys, whatever the depths: a triangle
  // without area, dropped in any order, or a token, whose vertices stay where they are.
  logic [KEY-1:0] key0, key1;
  logic           is_1_first_q;  // in the cycle before
  assign key0 = {~y0[C-1], y0[0+:C-1], ~x0[C-1], x0[0+:C-1]};
  assign key1 = {~y1_q[C-1], y1_q[0+:C-1], ~x1_q[C-1], x1_q[0+:C-1]};

  assign turns = (state_q == SORT && count_q[1]) || (state_q == BOX && count_q < COUNT'(3)) || state_q == FLIP ||
                 (state_q == EDGES && product_ends);
  assign swaps = (state_q == SORT && !count_q[1] && count_q[0] && is_1_first_q) ||
                 (state_q == JUDGE && is_negative_q && !is_dropped);

  always_ff @(posedge clk_i) begin
    is_1_first_q <= key1 < key0;
    if (takes) begin
      {x2_q, x1_q}       <= primitive_i.vertex.x[C+:2*C];
      {y2_q, y1_q}       <= primitive_i.vertex.y[C+:2*C];
      {code2_q, code1_q} <= primitive_i.vertex.code[CODES+:2*CODES];
      not_x0_q           <= ~primitive_i.vertex.x[0+:C];
      not_y0_q           <= ~primitive_i.vertex.y[0+:C];
      not_code0_q        <= ~primitive_i.vertex.code[0+:CODES];
      is_odd_q           <= 1'b0;
    end else if (turns || swaps) begin
      {not_x0_q, not_y0_q, not_code0_q} <= ~{x1_q, y1_q, code1_q};
      {x1_q, y1_q, code1_q} <= swaps ? {x0, y0, code0} : {x2_q, y2_q, code2_q};
      if (!swaps) {x2_q, y2_q, code2_q} <= {x0, y0, code0};
      is_odd_q <= is_odd_q ^ swaps;
    end
  end

  // -------------------------------------------------------------------------------------------------------------- box
  // The first and the last pixel whose centre is not before, not after a vertex. The box is from the smallest first to
  // the largest last of the three vertices, cut by the scissor; a cycle a vertex, one for the scissor, one to check whether
  // a pixel is left.
  localparam int B = C + 1;      // a coordinate plus half a pixel
  localparam int N = C - S + 1;  // bits of a pixel in the guard band, or one outside it
  localparam logic signed [B-1:0] HALF = B'(1 << (S - 1));
  logic signed [B-1:0] above_x, below_x, above_y, below_y;
  logic signed [N-1:0] first_x, last_x, first_y, last_y, scissor_left, scissor_top, scissor_right, scissor_bottom;
  logic signed [N-1:0] left_q, right_q, top_q, bottom_q;
  logic                cuts_left, cuts_right, cuts_top, cuts_bottom;
  logic                is_first, is_empty, is_empty_q;
  // x0 + HALF - 1 and x0 - HALF, from the complement.
  assign above_x        = ~(B'($signed(not_x0_q)) - (HALF - B'(1)));
  assign below_x        = ~(B'($signed(not_x0_q)) + HALF);
  assign above_y        = ~(B'($signed(not_y0_q)) - (HALF - B'(1)));
  assign below_y        = ~(B'($signed(not_y0_q)) + HALF);
  assign first_x        = above_x[B-1:S];
  assign last_x         = below_x[B-1:S];
  assign first_y        = above_y[B-1:S];
  assign last_y         = below_y[B-1:S];
  // From the vertex to the centre of a held pixel, less half a pixel, in whole half pixels: negative where the vertex is at
  // the centre or beyond it. So the held pixel is compared with the vertex's own one without waiting for the sums above;
  // where both are the same pixel, either answer does.
  logic signed [N+1:0] to_left, to_right, to_bottom;
  assign to_left        = (N + 2)'($signed({left_q, 1'b1})) + (N + 2)'($signed(not_x0_q[C-1:S-1]));
  assign to_right       = (N + 2)'($signed({right_q, 1'b1})) + (N + 2)'($signed(not_x0_q[C-1:S-1]));
  assign to_bottom      = (N + 2)'($signed({bottom_q, 1'b1})) + (N + 2)'($signed(not_y0_q[C-1:S-1]));
  assign scissor_left   = N'(primitive_i.box.left);
  assign scissor_top    = N'(primitive_i.box.top);
  assign scissor_right  = N'(primitive_i.box.right);
  assign scissor_bottom = N'(primitive_i.box.bottom);
  assign cuts_left      = !is_triangle || !(left_q > scissor_left);
  assign cuts_top       = !is_triangle || !(top_q > scissor_top);
  assign cuts_right     = !is_triangle || right_q >= scissor_right;
  assign cuts_bottom    = !is_triangle || bottom_q >= scissor_bottom;
  assign is_first       = count_q == '0;
  assign is_empty       = left_q > right_q || top_q > bottom_q;

  always_ff @(posedge clk_i) begin
    is_empty_q <= is_empty;
    if (state_q == BOX && count_q < COUNT'(3)) begin
      if (is_first || !to_left[N+1]) left_q <= first_x;
      if (is_first || to_right[N+1]) right_q <= last_x;
      if (is_first) top_q <= first_y;  // vertex 0 is the highest
      if (is_first || to_bottom[N+1]) bottom_q <= last_y;
    end
    if (state_q == BOX && count_q == COUNT'(3)) begin
      if (cuts_left) left_q <= scissor_left;
      if (cuts_right) right_q <= scissor_right;
      if (cuts_top) top_q <= scissor_top;
      if (cuts_bottom) bottom_q <= scissor_bottom;
    end
  end

  // ---------------------------------------------------------------------------------------------------- cross product
  // dx * (y - y0) - dy * (x - x0), from vertex 0 to 1; (x, y) is vertex 2 or the first pixel's centre. One bit of the
  // differences a cycle, lowest first and sign-extended, so the product comes out modulo any power of two.
  logic signed [D-1:0] dx, dy, x, y;
  logic [D-1:0]        to_x_q, to_y_q;
  logic signed [D:0]   wide_dx, wide_dy, both_q;  // both: dx - dy
  logic signed [D:0]   addend, acc_q;
  logic [D+2:0]        total;  // its lowest bit only makes the carry
  logic                starts, subtracts, bit_out;
  assign starts = multiplies && count_q == '0;
  assign dx     = D'($signed(x1_q)) - D'($signed(x0));
  assign dy     = D'($signed(y1_q)) - D'($signed(y0));
  assign x      = state_q == AREA ? D'($signed(x2_q)) : D'({left_q[PX-1:TS], {TS{1'b0}}}) << S | D'(1 << (S - 1));
  assign y      = state_q == AREA ? D'($signed(y2_q)) : D'({top_q[PY-1:TS], {TS{1'b0}}}) << S | D'(1 << (S - 1));

  assign wide_dx   = (D + 1)'(dx);
  assign wide_dy   = (D + 1)'(dy);
  assign subtracts = to_x_q[0] && !to_y_q[0];
  always_comb begin
    addend = to_x_q[0] ? ~wide_dy : '0;
    if (to_y_q[0]) addend = to_x_q[0] ? both_q : wide_dx;
  end
  assign total   = {acc_q[D], acc_q, 1'b1} + {addend[D], addend, subtracts};
  assign bit_out = total[1];

  always_ff @(posedge clk_i) begin
    if (starts) begin
      to_x_q <= x - D'($signed(x0));
      to_y_q <= y - D'($signed(y0));
      both_q <= wide_dx - wide_dy;
      acc_q  <= '0;
    end else begin
      to_x_q <= {to_x_q[D-1], to_x_q[D-1:1]};
      to_y_q <= {to_y_q[D-1], to_y_q[D-1:1]};
      acc_q  <= total[D+2:2];
    end
  end

  // Results, the newest bit highest. An edge that is neither top nor left excludes samples on it: minus 1.
  logic [A-1:0]   area_q;
  logic [3*V-1:0] value_q;
  logic           any_q, borrow_q, is_top_left, is_value_bit;
  logic [COUNT-1:0] number;  // number of the output bit
  assign number       = count_q - COUNT'(1);
  assign is_top_left  = dy[D-1] || (dy == '0 && !dx[D-1]);
  assign is_value_bit = number >= COUNT'(S) && number < COUNT'(S + V);

  always_ff @(posedge clk_i) begin
    if (starts) begin
      any_q    <= 1'b0;
      borrow_q <= !is_top_left;
    end else if (multiplies) begin
      any_q    <= any_q || bit_out;
      borrow_q <= borrow_q && !bit_out;
    end
    if (takes) area_q <= '0;
    else if (state_q == AREA && !starts && number < COUNT'(A)) area_q <= {bit_out, area_q[A-1:1]};
    if (state_q == AREA && number == COUNT'(A)) is_negative_q <= bit_out;
    if (takes) value_q <= '0;
    else if (state_q == EDGES && !starts && is_value_bit) value_q <= {bit_out ^ borrow_q, value_q[3*V-1:1]};
  end

  // ------------------------------------------------------------------------------------------------------------ judge
  logic is_zero, is_front, is_back;
  assign is_zero    = state_q == JUDGE && !any_q;
  assign is_front   = (is_negative_q ^ is_odd_q) != primitive_i.front_cw;  // positive area: clockwise as seen
  assign is_back    = state_q == JUDGE && any_q && (is_front ? primitive_i.cull[1] : primitive_i.cull[0]);  // bit 1: front faces
  assign is_dropped = is_zero || is_back || ((state_q == JUDGE || state_q == OFFER) && is_empty_q);
  assign primitive_ready_o = is_dropped || (state_q == OFFER && triangle_ready_i);
  assign leaves            = primitive_valid_i && primitive_ready_o;
  assign is_primitive_o    = leaves && is_counted;
  assign is_zero_area_o    = leaves && is_zero;
  assign is_backface_o     = leaves && is_back;
  assign is_empty_o        = leaves && is_counted && is_empty_q && !is_zero && !is_back;
  assign is_no_sample_o    = 1'b0;
  assign is_dropped_o      = leaves && is_dropped;

  assign triangle_valid_o        = state_q == OFFER && primitive_valid_i && !is_empty_q;
  assign triangle_o.kind         = primitive_i.kind;
  assign triangle_o.primitive_id = primitive_i.primitive_id;
  assign triangle_o.box.left     = PX'(left_q);
  assign triangle_o.box.top      = PY'(top_q);
  assign triangle_o.box.right    = PX'(right_q);
  assign triangle_o.box.bottom   = PY'(bottom_q);
  assign triangle_o.state        = primitive_i.state;
  assign triangle_o.vertex.x     = {x2_q, x1_q, x0};
  assign triangle_o.vertex.y     = {y2_q, y1_q, y0};
  assign triangle_o.vertex.code  = {code2_q, code1_q, code0};
  assign triangle_o.area         = area_q;
  assign triangle_o.edge_value   = value_q;

endmodule
