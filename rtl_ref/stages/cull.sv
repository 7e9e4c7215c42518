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
  localparam int R = raster_pkg::VERTEX_COLOR_BITS;
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

  /* verilator lint_off UNUSEDSIGNAL */  // x, y, z, rgba are in the registers below from the first step on
  var raster_pkg::primitive_packet_t p_q;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [3*C-1:0] x_q, y_q;
  logic [3*Z-1:0] z_q;
  logic [3*R-1:0] rgba_q;
  logic [PX-1:0]  left_q, right_q;
  logic [PY-1:0]  top_q, bottom_q;
  logic           is_empty_q;
  logic [3*E-1:0] edge_q;  // before orientation; the newest is the highest
  logic [3*D-1:0] dx_q, dy_q;  // of the three edges, for the fill rule; likewise
  logic [1:0]     edge_count_q, issued_q;
  logic signed [E-1:0] area_q;

  logic is_triangle, is_counted, takes, is_zero, is_back, is_dropped;
  assign is_triangle       = p_q.kind == 3'd0;
  assign is_counted        = is_triangle || p_q.kind[2];
  assign primitive_ready_o = step_q == IDLE || (step_q == OFFER && (triangle_ready_i || is_dropped));
  assign takes             = primitive_valid_i && primitive_ready_o;

  // --- ROTATE, once or twice: the smallest (Y, X, Z) first. Flipping the sign bits makes signed numbers comparable as
  // unsigned ones.
  logic [KEY-1:0] key0, key1, key2;
  logic           is_0_first, is_1_first;
  assign key0 = {~y_q[C-1], y_q[0+:C-1], ~x_q[C-1], x_q[0+:C-1], z_q[0+:Z]};
  assign key1 = {~y_q[2*C-1], y_q[C+:C-1], ~x_q[2*C-1], x_q[C+:C-1], z_q[Z+:Z]};
  assign key2 = {~y_q[3*C-1], y_q[2*C+:C-1], ~x_q[3*C-1], x_q[2*C+:C-1], z_q[2*Z+:Z]};
  assign is_0_first = key0 <= key1 && key0 <= key2;
  assign is_1_first = key1 <= key2;

  // --- Meanwhile the box: pixel centres within the vertices' bounds, cut by the scissor.
  localparam int B = C + 1;  // a coordinate plus half a pixel
  localparam logic signed [B-1:0] HALF = B'(1 << (S - 1));
  logic signed [C-1:0] x0, x1, x2, y0, y1, y2, x_min, x_max, y_min, y_max;
  logic signed [B-1:0] first_x, first_y, last_x, last_y;  // pixels
  logic signed [B-1:0] left, top, right, bottom;
  assign x0 = x_q[0+:C];
  assign x1 = x_q[C+:C];
  assign x2 = x_q[2*C+:C];
  assign y0 = y_q[0+:C];
  assign y1 = y_q[C+:C];
  assign y2 = y_q[2*C+:C];
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
  assign left    = is_triangle && first_x > $signed(B'(p_q.left)) ? first_x : $signed(B'(p_q.left));
  assign top     = is_triangle && first_y > $signed(B'(p_q.top)) ? first_y : $signed(B'(p_q.top));
  assign right   = is_triangle && last_x < $signed(B'(p_q.right)) ? last_x : $signed(B'(p_q.right));
  assign bottom  = is_triangle && last_y < $signed(B'(p_q.bottom)) ? last_y : $signed(B'(p_q.bottom));

  // --- EDGES, edge_function: E(p) = dx (p_y - y) - dy (p_x - x), p the centre of the first tile's first pixel; from vertex
  // 0 to 1, 1 to 2, 2 to 0. The vertices turn round once, so that the operands are always those of the lowest two.
  logic signed [C:0]   px, py;  // subpixels; the box is inside the target
  logic signed [D-1:0] dx, dy, to_px, to_py;
  logic                edge_start, edge_done;
  logic signed [E-1:0] edge_value;
  assign px    = $signed((C + 1)'({left_q[PX-1:TS], {TS{1'b0}}}) << S) + $signed((C + 1)'(1 << (S - 1)));
  assign py    = $signed((C + 1)'({top_q[PY-1:TS], {TS{1'b0}}}) << S) + $signed((C + 1)'(1 << (S - 1)));
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
  assign is_back     = is_triangle && !is_zero && (is_front ? p_q.cull[1] : p_q.cull[0]);
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
      x_q          <= primitive_i.x;
      y_q          <= primitive_i.y;
      z_q          <= primitive_i.z;
      rgba_q       <= primitive_i.rgba;
      edge_count_q <= 2'd0;
      issued_q     <= 2'd0;
      edge_q       <= '0;
      area_q       <= '0;
    end else if ((step_q == ROTATE && !is_0_first) || edge_start) begin
      x_q    <= {x_q[0+:C], x_q[C+:2*C]};
      y_q    <= {y_q[0+:C], y_q[C+:2*C]};
      z_q    <= {z_q[0+:Z], z_q[Z+:2*Z]};
      rgba_q <= {rgba_q[0+:R], rgba_q[R+:2*R]};
    end
    if (step_q == ROTATE) begin
      left_q     <= PX'(left);
      top_q      <= PY'(top);
      right_q    <= PX'(right);
      bottom_q   <= PY'(bottom);
      is_empty_q <= left > right || top > bottom;
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
  logic [3*C-1:0] x, y;
  logic [3*Z-1:0] z;
  logic [3*R-1:0] rgba;
  assign x    = is_negative ? {x_q[C+:C], x_q[2*C+:C], x_q[0+:C]} : x_q;
  assign y    = is_negative ? {y_q[C+:C], y_q[2*C+:C], y_q[0+:C]} : y_q;
  assign z    = is_negative ? {z_q[Z+:Z], z_q[2*Z+:Z], z_q[0+:Z]} : z_q;
  assign rgba = is_negative ? {rgba_q[R+:R], rgba_q[2*R+:R], rgba_q[0+:R]} : rgba_q;

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
  assign triangle_o.left         = left_q;
  assign triangle_o.top          = top_q;
  assign triangle_o.right        = right_q;
  assign triangle_o.bottom       = bottom_q;
  assign triangle_o.depth_test   = p_q.depth_test;
  assign triangle_o.depth_write  = p_q.depth_write;
  assign triangle_o.color_write  = p_q.color_write;
  assign triangle_o.x            = x;
  assign triangle_o.y            = y;
  assign triangle_o.z            = z;
  assign triangle_o.rgba         = rgba;
  assign triangle_o.area         = A'(is_negative ? -area_q : area_q);
  assign triangle_o.edge_value   = value;

endmodule
