// Cull: decides by the signed area whether a triangle faces the right way, and by its box whether it can touch a sample.
//
// In: a primitive packet. Out: a triangle packet in canonical order (positive area, smallest (Y, X, Z) first), with its box
// and its three edge functions at the first pixel of the box's first tile: their sum is twice the area, so that no
// multiplication is spent on deciding alone. One cross product in turn for the three edges.
// Occupancy and latency: 7 or 8 cycles.
// Specification: model/stages/cull.hpp, edge_function() in model/stages/edge_function.hpp.
module cull (
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

    // Counters: one pulse for each
    output logic is_primitive_o,  // triangles, points and lines
    output logic is_zero_area_o,
    output logic is_backface_o,
    output logic is_empty_o,
    output logic is_dropped_o  // whatever the kind
);

  localparam int C = raster_pkg::COORDINATE_BITS;
  localparam int D = raster_pkg::DELTA_BITS;
  localparam int Z = raster_pkg::DEPTH_CODE_BITS;
  localparam int CODES = raster_pkg::ALL_CODE_BITS;  // of a vertex; the lowest is its depth, Z
  localparam int S = raster_pkg::GRID_BITS;
  localparam int TS = raster_pkg::TILE_SHIFT;
  localparam int PX = raster_pkg::PIXEL_X_BITS;
  localparam int PY = raster_pkg::PIXEL_Y_BITS;
  localparam int E = raster_pkg::EDGE_PRODUCT_BITS + 1;  // an exact edge function, before its sign is turned
  localparam int A = raster_pkg::AREA_BITS;
  localparam int V = raster_pkg::EDGE_VALUE_BITS;
  localparam int KEY = 2 * C + Z;  // (Y, X, Z) as one unsigned number

  // One step per cycle, but for the edges.
  localparam logic [1:0] IDLE = 2'd0, ROTATE = 2'd1, EDGES = 2'd2, OFFER = 2'd3;
  logic [1:0] step_q;

  /* verilator lint_off UNUSEDSIGNAL */  // box and vertices are in the registers below
  var raster_pkg::primitive_packet_t p_q;
  /* verilator lint_on UNUSEDSIGNAL */
  var raster_pkg::triangle_vertices_t vertex_q;
  var raster_pkg::pixel_box_t         box_q;
  logic           is_empty_q;
  logic [3*E-1:0] edge_q;  // before orientation; the newest is the highest
  logic [3*D-1:0] dx_q, dy_q;  // of the three edges, for the fill rule; likewise
  logic [1:0]     edge_count_q, issued_q;
  logic signed [E-1:0] area_q;

  logic is_triangle, is_counted, takes, is_zero, is_back, is_dropped;
  assign is_triangle       = p_q.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE;
  assign is_counted        = is_triangle || p_q.kind[2];  // point, line
  assign primitive_ready_o = step_q == IDLE || (step_q == OFFER && (triangle_ready_i || is_dropped));
  assign takes             = primitive_valid_i && primitive_ready_o;

  logic signed [C-1:0] x0, x1, x2, y0, y1, y2;
  assign x0 = vertex_q.x[0+:C];
  assign x1 = vertex_q.x[C+:C];
  assign x2 = vertex_q.x[2*C+:C];
  assign y0 = vertex_q.y[0+:C];
  assign y1 = vertex_q.y[C+:C];
  assign y2 = vertex_q.y[2*C+:C];

  // --- ROTATE, once or twice: the smallest (Y, X, Z) first. Flipping the sign bits makes signed numbers comparable as
  // unsigned ones.
  logic [KEY-1:0] key0, key1, key2;
  logic           is_0_first, is_1_first;
  assign key0 = {~y0[C-1], y0[0+:C-1], ~x0[C-1], x0[0+:C-1], vertex_q.code[0+:Z]};
  assign key1 = {~y1[C-1], y1[0+:C-1], ~x1[C-1], x1[0+:C-1], vertex_q.code[CODES+:Z]};
  assign key2 = {~y2[C-1], y2[0+:C-1], ~x2[C-1], x2[0+:C-1], vertex_q.code[2*CODES+:Z]};
  assign is_0_first = key0 <= key1 && key0 <= key2;
  assign is_1_first = key1 <= key2;

  // --- Meanwhile the box: pixel centres within the vertices' bounds, cut by the scissor.
  localparam int B = C + 1;  // a coordinate plus half a pixel
  localparam logic signed [B-1:0] HALF = B'(1 << (S - 1));
  logic signed [C-1:0] x_min, x_max, y_min, y_max;
  logic signed [B-1:0] first_x, first_y, last_x, last_y;  // pixels
  logic signed [B-1:0] left, top, right, bottom;
  always_comb begin
    x_min = x0 < x1 ? x0 : x1;
    x_min = x_min < x2 ? x_min : x2;
    x_max = x0 < x1 ? x1 : x0;
    x_max = x_max < x2 ? x2 : x_max;
    y_min = y0 < y1 ? y0 : y1;
    y_min = y_min < y2 ? y_min : y2;
    y_max = y0 < y1 ? y1 : y0;
    y_max = y_max < y2 ? y2 : y_max;
  end
  assign first_x = (B'(x_min) + HALF - B'(1)) >>> S;
  assign first_y = (B'(y_min) + HALF - B'(1)) >>> S;
  assign last_x  = (B'(x_max) - HALF) >>> S;
  assign last_y  = (B'(y_max) - HALF) >>> S;
  assign left    = is_triangle && first_x > $signed(B'(p_q.box.left)) ? first_x : $signed(B'(p_q.box.left));
  assign top     = is_triangle && first_y > $signed(B'(p_q.box.top)) ? first_y : $signed(B'(p_q.box.top));
  assign right   = is_triangle && last_x < $signed(B'(p_q.box.right)) ? last_x : $signed(B'(p_q.box.right));
  assign bottom  = is_triangle && last_y < $signed(B'(p_q.box.bottom)) ? last_y : $signed(B'(p_q.box.bottom));

  // --- EDGES, edge_function: E(p) = dx (p_y - y) - dy (p_x - x), p the centre of the first tile's first pixel; from vertex
  // 0 to 1, 1 to 2, 2 to 0. The vertices turn round once, so that the operands are always those of the lowest two.
  logic signed [C:0]   px, py;  // subpixels; the box is inside the target
  logic signed [D-1:0] dx, dy, to_px, to_py;
  logic                edge_start, edge_done;
  logic signed [E-1:0] edge_value;
  assign px    = $signed((C + 1)'({box_q.left[PX-1:TS], {TS{1'b0}}}) << S) + $signed((C + 1)'(1 << (S - 1)));
  assign py    = $signed((C + 1)'({box_q.top[PY-1:TS], {TS{1'b0}}}) << S) + $signed((C + 1)'(1 << (S - 1)));
  assign dx    = D'(x1) - D'(x0);
  assign dy    = D'(y1) - D'(y0);
  assign to_px = D'(px) - D'(x0);
  assign to_py = D'(py) - D'(y0);
  assign edge_start = step_q == EDGES && issued_q != 2'd3;

  cross_product #(
      .A_BITS  (D),
      .D_BITS  (D),
      .OUT_BITS(E)
  ) u_edge_function (
      .clk_i,
      .rst_ni,
      .start_i (edge_start),
      .a_i     (dx),
      .b_i     (dy),
      .c_i     (to_px),
      .d_i     (to_py),
      .done_o  (edge_done),
      .result_o(edge_value)
  );

  // --- OFFER, or drop
  logic is_negative, is_front;
  assign is_negative = area_q < 0;
  assign is_zero     = is_triangle && area_q == 0;
  assign is_front    = is_negative != p_q.front_cw;  // positive area: clockwise as seen
  assign is_back     = is_triangle && !is_zero && (is_front ? p_q.cull[1] : p_q.cull[0]);  // bit 1: front faces
  assign is_dropped  = is_zero || is_back || is_empty_q;

  logic leaves;
  assign leaves      = step_q == OFFER && primitive_ready_o;
  assign is_primitive_o = leaves && is_counted;
  assign is_zero_area_o = leaves && is_zero;
  assign is_backface_o  = leaves && is_back;
  assign is_empty_o     = leaves && is_counted && !is_zero && !is_back && is_empty_q;

  assign is_dropped_o   = leaves && is_dropped;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) step_q <= IDLE;
    else if (takes) step_q <= ROTATE;
    else begin
      case (step_q)
        ROTATE: if (is_0_first || is_1_first) step_q <= is_triangle ? EDGES : OFFER;  // otherwise once more
        EDGES: if (edge_done && edge_count_q == 2'd2) step_q <= OFFER;
        OFFER: if (leaves) step_q <= IDLE;
        default: step_q <= IDLE;
      endcase
    end
  end

  always_ff @(posedge clk_i) begin
    if (takes) begin
      p_q          <= primitive_i;
      vertex_q     <= primitive_i.vertex;
      edge_count_q <= 2'd0;
      issued_q     <= 2'd0;
      edge_q       <= '0;
      area_q       <= '0;
    end else if ((step_q == ROTATE && !is_0_first) || edge_start) begin
      vertex_q.x    <= {vertex_q.x[0+:C], vertex_q.x[C+:2*C]};
      vertex_q.y    <= {vertex_q.y[0+:C], vertex_q.y[C+:2*C]};
      vertex_q.code <= {vertex_q.code[0+:CODES], vertex_q.code[CODES+:2*CODES]};
    end
    if (step_q == ROTATE) begin
      box_q.left   <= PX'(left);
      box_q.top    <= PY'(top);
      box_q.right  <= PX'(right);
      box_q.bottom <= PY'(bottom);
      is_empty_q   <= left > right || top > bottom;
    end
    if (edge_start) begin
      issued_q <= issued_q + 2'd1;
      dx_q <= {dx, dx_q[D+:2*D]};
      dy_q <= {dy, dy_q[D+:2*D]};
    end
    if (step_q == EDGES && edge_done) begin
      edge_q       <= {edge_value, edge_q[E+:2*E]};
      area_q       <= area_q + edge_value;
      edge_count_q <= edge_count_q + 2'd1;
    end
  end

  // Of a triangle of negative area vertices 1 and 2 change places: its edges run the other way round.
  var raster_pkg::triangle_vertices_t turned_vertex;
  always_comb begin
    turned_vertex = vertex_q;
    if (is_negative) begin
      turned_vertex.x    = {vertex_q.x[C+:C], vertex_q.x[2*C+:C], vertex_q.x[0+:C]};
      turned_vertex.y    = {vertex_q.y[C+:C], vertex_q.y[2*C+:C], vertex_q.y[0+:C]};
      turned_vertex.code = {vertex_q.code[CODES+:CODES], vertex_q.code[2*CODES+:CODES], vertex_q.code[0+:CODES]};
    end
  end

  logic [3*V-1:0] value;
  genvar i;
  generate
    for (i = 0; i < 3; i++) begin : gen_edge
      // Edge i of the turned triangle is edge 2 - i, backwards.
      logic signed [E-1:0] exact, turned;
      logic signed [D-1:0] edge_dx, edge_dy;
      logic                is_top_left;
      assign exact       = is_negative ? edge_q[(2-i)*E+:E] : edge_q[i*E+:E];
      assign edge_dx     = is_negative ? dx_q[(2-i)*D+:D] : dx_q[i*D+:D];
      assign edge_dy     = is_negative ? dy_q[(2-i)*D+:D] : dy_q[i*D+:D];
      assign is_top_left = edge_dy == 0 ? (edge_dx < 0) == is_negative : (edge_dy < 0) != is_negative;
      // -x = ~x + 1 and x - 1 are one adder: the fill rule takes 1 away unless the edge is a top or left one.
      assign turned      = is_negative ? (~exact + E'(is_top_left ? 1 : 0)) : (exact - E'(is_top_left ? 0 : 1));
      assign value[i*V+:V] = is_triangle ? V'(turned >>> S) : '0;
    end
  endgenerate

  assign triangle_valid_o        = step_q == OFFER && !is_dropped;
  assign triangle_o.kind         = p_q.kind;
  assign triangle_o.primitive_id = p_q.primitive_id;
  assign triangle_o.box          = box_q;
  assign triangle_o.state        = p_q.state;
  assign triangle_o.vertex       = turned_vertex;
  assign triangle_o.area         = A'(is_negative ? -area_q : area_q);
  assign triangle_o.edge_value   = value;

endmodule
