// Cull: tests the signed area (facing), the box (whether it contains a sample), and for small triangles the samples
// themselves.
//
// In: a primitive packet. Out: a triangle packet in canonical order (positive area, smallest (Y, X) first), with its
// box and its three edge functions at the first pixel of the box's first tile: their sum is twice the area, so that no
// multiplication serves the decision only.
//
// Two parts, each with one primitive for four steps; the three edges go in turn through one cross product:
//   sort    which vertex leads; then the box, and from there on one edge per step
//   decide  one edge function per step; in the last step the triangle is on offer, or dropped
// Occupancy 4 cycles, latency 8. A part passes its triangle on when the next one is free. Specification:
// model/stages/cull.hpp, edge_function() in model/stages/edge_function.hpp.
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

    // Counters: one pulse per event, a cycle late
    output logic is_primitive_o,  // triangles, points and lines
    output logic is_zero_area_o,
    output logic is_backface_o,
    output logic is_empty_o,
    output logic is_no_sample_o,
    output logic is_dropped_o  // a dropped primitive of any kind; not delayed
);

  localparam int C = raster_pkg::COORDINATE_BITS;
  localparam int D = raster_pkg::DELTA_BITS;
  localparam int CODES = raster_pkg::ALL_CODE_BITS;  // bits of a vertex's codes
  localparam int S = raster_pkg::GRID_BITS;
  localparam int TS = raster_pkg::TILE_SHIFT;
  localparam int PX = raster_pkg::PIXEL_X_BITS;
  localparam int PY = raster_pkg::PIXEL_Y_BITS;
  localparam int E = raster_pkg::EDGE_PRODUCT_BITS + 1;  // an exact edge function; its sign is valid either way round
  localparam int A = raster_pkg::AREA_BITS;
  localparam int V = raster_pkg::EDGE_VALUE_BITS;
  localparam int KEY = 2 * C;  // (Y, X) as one unsigned number
  localparam int N = S + 3;        // a side of less than 4 pixels, subpixels
  localparam int NV = S + 7;       // bits of the edge function of such a triangle, at a sample of its box

  // ------------------------------------------------------------------------------------------------------------- sort
  raster_pkg::primitive_packet_t p_q;
  logic       sort_busy_q;
  logic [1:0] sort_step_q;
  logic       sort_moves, decide_moves, hands_over, decide_ready;
  logic       is_triangle, is_state, is_sorted;

  // Where states overtake the setup of triangles they stay one cycle in each part.
  assign is_state          = raster_pkg::COORDINATES != 0 && p_q.kind == raster_pkg::PRIMITIVE_KIND_STATE;
  assign is_sorted         = sort_step_q == 2'd3 || is_state;
  assign hands_over        = sort_busy_q && is_sorted && decide_ready;
  assign sort_moves        = sort_busy_q && (!is_sorted || decide_ready);
  assign primitive_ready_o = !sort_busy_q || hands_over;
  assign is_triangle       = p_q.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE;

  logic leaves;  // from the next part
  logic clk;
  clock_gate u_clock_gate (
      .clk_i,
      .reset_i (!rst_ni),
      .enable_i((primitive_valid_i && primitive_ready_o) || sort_moves || decide_moves || leaves),
      .clk_o   (clk)
  );

  always_ff @(posedge clk or negedge rst_ni) begin
    if (!rst_ni) begin
      sort_busy_q <= 1'b0;
      sort_step_q <= '0;
    end else if (primitive_ready_o) begin
      sort_busy_q <= primitive_valid_i;
      sort_step_q <= '0;
    end else if (sort_moves) sort_step_q <= sort_step_q + 2'd1;
  end

  logic signed [C-1:0] x0, x1, x2, y0, y1, y2;
  assign x0 = p_q.vertex.x[0+:C];
  assign x1 = p_q.vertex.x[C+:C];
  assign x2 = p_q.vertex.x[2*C+:C];
  assign y0 = p_q.vertex.y[0+:C];
  assign y1 = p_q.vertex.y[C+:C];
  assign y2 = p_q.vertex.y[2*C+:C];

  // --- Step 0: the smallest (Y, X) leads. Flipping the sign bits makes signed numbers comparable as unsigned ones. Depths
  // of equal ones do not matter: a triangle without area is dropped, and the vertices of a token stay where they are.
  logic [KEY-1:0] key0, key1, key2;
  logic           is_0_first, is_1_first;
  assign key0 = {~y0[C-1], y0[0+:C-1], ~x0[C-1], x0[0+:C-1]};
  assign key1 = {~y1[C-1], y1[0+:C-1], ~x1[C-1], x1[0+:C-1]};
  assign key2 = {~y2[C-1], y2[0+:C-1], ~x2[C-1], x2[0+:C-1]};
  assign is_0_first = !(key1 < key0) && !(key2 < key0);  // <= would need a comparator for equality, not just a carry
  assign is_1_first = !(key2 < key1);

  // --- Meanwhile and in step 1 the box: pixel centres within the vertices' bounds, cut by the scissor.
  localparam int B = C + 1;  // a coordinate plus half a pixel
  localparam logic signed [B-1:0] HALF = B'(1 << (S - 1));
  logic signed [C-1:0] x_min, x_max, y_min, y_max, x_min_q, x_max_q, y_min_q, y_max_q;
  logic signed [B-1:0] first_x, first_y, last_x, last_y;  // pixels
  logic signed [B-1:0] left, top, right, bottom;
  raster_pkg::pixel_box_t box_q;
  logic                       is_empty_q;
  always_comb begin
    // Three comparisons at once; none waits for another's choice.
    x_min = x0 < x1 ? (x0 < x2 ? x0 : x2) : (x1 < x2 ? x1 : x2);
    x_max = x0 < x1 ? (x1 < x2 ? x2 : x1) : (x0 < x2 ? x2 : x0);
    y_min = y0 < y1 ? (y0 < y2 ? y0 : y2) : (y1 < y2 ? y1 : y2);
    y_max = y0 < y1 ? (y1 < y2 ? y2 : y1) : (y0 < y2 ? y2 : y0);
  end
  localparam bit HAS_SAMPLES = raster_pkg::MSAA_SAMPLES > 1;  // the box then has every pixel that the triangle touches
  localparam logic signed [B-1:0] TO_FIRST = HAS_SAMPLES ? '0 : HALF - B'(1);
  localparam logic signed [B-1:0] TO_LAST = HAS_SAMPLES ? '0 : HALF;
  assign first_x = (B'(x_min_q) + TO_FIRST) >>> S;
  assign first_y = (B'(y_min_q) + TO_FIRST) >>> S;
  assign last_x  = (B'(x_max_q) - TO_LAST) >>> S;
  assign last_y  = (B'(y_max_q) - TO_LAST) >>> S;
  assign left    = is_triangle && first_x > $signed(B'(p_q.box.left)) ? first_x : $signed(B'(p_q.box.left));
  assign top     = is_triangle && first_y > $signed(B'(p_q.box.top)) ? first_y : $signed(B'(p_q.box.top));
  assign right   = is_triangle && last_x < $signed(B'(p_q.box.right)) ? last_x : $signed(B'(p_q.box.right));
  assign bottom  = is_triangle && last_y < $signed(B'(p_q.box.bottom)) ? last_y : $signed(B'(p_q.box.bottom));

  // --- Steps 1 to 3, edge_function: E(p) = dx (p_y - y) - dy (p_x - x), p the centre of the first tile's first pixel;
  // from the leading vertex to the next one, and so on around.
  logic [1:0]               from_q, to;  // vertices
  logic signed [C-1:0]      from_x, from_y, to_x, to_y;
  logic [CODES-1:0]         from_code;
  logic [2*(2*C+CODES)-1:0] chain_q;  // vertices already used, the newest highest
  assign to = from_q[1] ? 2'd0 : from_q + 2'd1;
  always_comb begin
    from_x    = from_q[1] ? x2 : from_q[0] ? x1 : x0;
    from_y    = from_q[1] ? y2 : from_q[0] ? y1 : y0;
    from_code = from_q[1] ? p_q.vertex.code[2*CODES+:CODES] : from_q[0] ? p_q.vertex.code[CODES+:CODES] :
                            p_q.vertex.code[0+:CODES];
    to_x      = to[1] ? x2 : to[0] ? x1 : x0;
    to_y      = to[1] ? y2 : to[0] ? y1 : y0;
  end

  logic signed [C:0]   px, py;  // subpixels; the box is inside the target
  logic signed [C-1:0] from_x_q, from_y_q;
  logic signed [D-1:0] dx, dy, dx_q, dy_q, to_px, to_py;
  assign px    = $signed((C + 1)'({box_q.left[PX-1:TS], {TS{1'b0}}}) << S) + $signed((C + 1)'(1 << (S - 1)));
  assign py    = $signed((C + 1)'({box_q.top[PY-1:TS], {TS{1'b0}}}) << S) + $signed((C + 1)'(1 << (S - 1)));
  assign dx    = D'(to_x) - D'(from_x);
  assign dy    = D'(to_y) - D'(from_y);
  assign to_px = D'(px) - D'(from_x_q);
  assign to_py = D'(py) - D'(from_y_q);

  // The first pixel of the box, for small triangles.
  localparam logic [S-1:0] CENTRE = S'(1) << (S - 1);
  logic signed [N:0] to_cx, to_cy;
  assign to_cx = (N + 1)'({box_q.left, CENTRE}) - from_x_q[N:0];
  assign to_cy = (N + 1)'({box_q.top, CENTRE}) - from_y_q[N:0];

  always_ff @(posedge clk) begin
    if (primitive_ready_o) p_q <= primitive_i;
    if (sort_moves && sort_step_q == 2'd0) begin
      from_q  <= is_0_first ? 2'd0 : is_1_first ? 2'd1 : 2'd2;
      x_min_q <= x_min;
      x_max_q <= x_max;
      y_min_q <= y_min;
      y_max_q <= y_max;
    end else if (sort_moves) from_q <= to;
    if (sort_moves && sort_step_q == 2'd1) begin
      box_q.left   <= PX'(left);
      box_q.top    <= PY'(top);
      box_q.right  <= PX'(right);
      box_q.bottom <= PY'(bottom);
      is_empty_q   <= left > right || top > bottom;
    end
    if (sort_moves) begin
      from_x_q <= from_x;
      from_y_q <= from_y;
      dx_q     <= dx;
      dy_q     <= dy;
      chain_q  <= {from_x, from_y, from_code, chain_q[2*C+CODES+:2*C+CODES]};
    end
  end

  // ----------------------------------------------------------------------------------------------------------- decide
  logic       decide_busy_q;
  logic [1:0] decide_step_q;
  raster_pkg::primitive_kind_t          kind_q;
  logic [raster_pkg::PRIMITIVE_ID_BITS-1:0] id_q;
  raster_pkg::primitive_state_t         state_q;
  raster_pkg::cull_mode_t               mode_q;
  logic                                     front_cw_q, d_is_empty_q;
  raster_pkg::pixel_box_t               d_box_q;
  logic [3*(2*C+CODES)-1:0]                 vertex_q;
  logic                                     d_is_triangle, d_is_state, is_decided, is_counted, is_zero, is_back, is_dropped;

  assign d_is_state   = raster_pkg::COORDINATES != 0 && kind_q == raster_pkg::PRIMITIVE_KIND_STATE;
  assign is_decided   = decide_step_q == 2'd3 || d_is_state;
  assign decide_moves = decide_busy_q && !is_decided;
  assign leaves       = decide_busy_q && is_decided && (triangle_ready_i || is_dropped);
  assign decide_ready = !decide_busy_q || leaves;

  always_ff @(posedge clk or negedge rst_ni) begin
    if (!rst_ni) begin
      decide_busy_q <= 1'b0;
      decide_step_q <= '0;
    end else if (decide_ready) begin
      decide_busy_q <= hands_over;
      decide_step_q <= '0;
    end else if (decide_moves) decide_step_q <= decide_step_q + 2'd1;
  end

  // The fill rule goes into the edge function, E - [not top or left]. Seen from the other side, where the edge runs
  // backwards, it is -E - [top or left] = ~(E - [not top or left]): one number with all bits inverted.
  logic                is_top_left, is_biased, bias_q, edge_bias_q;
  logic signed [E-1:0] edge_value;
  assign is_top_left = dy_q[D-1] || (dy_q == '0 && (!dx_q[D-1] && dx_q != '0));
  assign is_biased   = !is_top_left;

  cross_product #(
      .A_BITS  (D),
      .D_BITS  (D),
      .OUT_BITS(E)
  ) u_edge_function (
      .clk_i   (clk),
      .enable_i(sort_moves || decide_moves),
      .a_i     (dx_q),
      .b_i     (dy_q),
      .c_i     (to_px),
      .d_i     (to_py),
      .bias_i  (is_biased),
      .result_o(edge_value)
  );

  // The same in fewer bits at the box's first pixel, for a triangle with sides shorter than 4 pixels.
  logic signed [S+NV-1:0] corner;
  cross_product #(
      .A_BITS  (N),
      .D_BITS  (N + 1),
      .OUT_BITS(S + NV)
  ) u_corner (
      .clk_i   (clk),
      .enable_i(sort_moves || decide_moves),
      .a_i     (dx_q[N-1:0]),
      .b_i     (dy_q[N-1:0]),
      .c_i     (to_cx),
      .d_i     (to_cy),
      .bias_i  (is_biased),
      .result_o(corner)
  );

  // The signs at that pixel and its neighbours to the right and below; pixels outside the box are masked later.
  logic                 is_short, is_short_q, edge_is_short_q;
  logic signed [N-1:0]  side_x_q, side_y_q, edge_x_q, edge_y_q;
  logic signed [NV-1:0] here, right_of, below, across;
  logic [3:0]           signs;
  assign is_short = dx_q[D-1:N-1] == {(D - N + 1) {dx_q[D-1]}} && dy_q[D-1:N-1] == {(D - N + 1) {dy_q[D-1]}};
  assign here     = corner[S+:NV];
  assign right_of = here - NV'(edge_y_q);
  assign below    = here + NV'(edge_x_q);
  assign across   = below - NV'(edge_y_q);
  assign signs    = {across[NV-1], below[NV-1], right_of[NV-1], here[NV-1]};

  // Twice the area is the sum of the exact edge functions; the bias comes back as a carry.
  logic [3*V-1:0]      edge_q;  // before orientation; the newest edge is the highest
  logic signed [E-1:0] area_q;
  logic signed [E:0]   area;
  assign area = {area_q, 1'b1} + {edge_value, edge_bias_q};

  // Inputs of the decision, known a cycle before it.
  logic       is_zero_q, is_back_q;  // area is 0; area has the sign of a culled side
  logic       is_small, is_small_q;  // all sides are short
  logic [3:0] has_inside, has_outside, has_inside_q, has_outside_q;  // per sample: inside, outside of some edge
  logic       is_sampleless_q;
  logic       is_front;
  // A sample is covered when it is on the same side of all edges, in either orientation. More than 2x2 samples are left
  // to fine_raster.
  logic [2:0] columns, rows;  // less one
  logic       has_2x2_q, has_column_q, has_row_q;  // at most 2x2; with a second column or row
  logic [3:0] is_missed;
  assign is_front    = area[E] != front_cw_q;  // positive area: clockwise as seen
  assign is_small    = is_small_q && edge_is_short_q;
  assign has_inside  = has_inside_q | ~signs;
  assign has_outside = has_outside_q | signs;

  always_ff @(posedge clk) begin
    if (sort_moves || decide_moves) begin
      bias_q          <= is_biased;
      edge_bias_q     <= bias_q;
      is_short_q      <= is_short;
      edge_is_short_q <= is_short_q;
      side_x_q        <= dx_q[N-1:0];
      side_y_q        <= dy_q[N-1:0];
      edge_x_q        <= side_x_q;
      edge_y_q        <= side_y_q;
    end
    if (decide_ready) begin
      kind_q        <= p_q.kind;
      id_q          <= p_q.primitive_id;
      state_q       <= p_q.state;
      mode_q        <= p_q.cull;
      front_cw_q    <= p_q.front_cw;
      d_box_q       <= box_q;
      d_is_empty_q  <= is_empty_q && !is_state;
      vertex_q      <= {from_x, from_y, from_code, chain_q};
      if (is_state) begin  // has no box, and equal vertices, of which the last goes on
        d_box_q                        <= '0;
        vertex_q[2*(2*C+CODES)-1:0]    <= '0;
      end
      area_q          <= '0;
      is_zero_q       <= 1'b1;
      is_back_q       <= 1'b0;
      is_small_q      <= 1'b1;
      has_inside_q    <= '0;
      has_outside_q   <= '0;
      is_sampleless_q <= 1'b0;
    end else if (decide_moves && d_is_triangle) begin
      area_q          <= area[E:1];
      is_zero_q       <= area[E:1] == '0;
      edge_q          <= {edge_value[S+:V], edge_q[V+:2*V]};
      is_back_q       <= is_front ? mode_q[1] : mode_q[0];  // bit 1: front faces
      is_small_q      <= is_small;
      has_inside_q    <= has_inside;
      has_outside_q   <= has_outside;
      is_sampleless_q <= !HAS_SAMPLES && has_2x2_q && is_small && is_missed == '1;
    end
  end

  // --- The last step: on offer or dropped, decided from registers, because the handshake depends on it.
  logic is_negative;
  assign d_is_triangle = kind_q == raster_pkg::PRIMITIVE_KIND_TRIANGLE;
  assign is_counted    = d_is_triangle || (kind_q[2] && !kind_q[0]);  // point, line
  assign is_negative   = area_q[E-1];
  assign is_zero       = d_is_triangle && is_zero_q;
  assign is_back       = is_back_q && !is_zero;
  assign is_dropped    = is_zero || is_back_q || d_is_empty_q || is_sampleless_q;

  assign columns       = d_box_q.right[2:0] - d_box_q.left[2:0];
  assign rows          = d_box_q.bottom[2:0] - d_box_q.top[2:0];
  always_ff @(posedge clk) begin  // known in the steps before
    has_2x2_q    <= d_is_triangle && columns <= 3'd1 && rows <= 3'd1;
    has_column_q <= columns != 3'd0;
    has_row_q    <= rows != 3'd0;
  end
  assign is_missed = (has_inside & has_outside) | ~{has_column_q && has_row_q, has_row_q, has_column_q, 1'b1};

  assign is_dropped_o   = leaves && is_dropped;
  // Counters, one cycle late: the signal that lets a triangle leave is late enough without them downstream.
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      is_primitive_o <= 1'b0;
      is_zero_area_o <= 1'b0;
      is_backface_o  <= 1'b0;
      is_empty_o     <= 1'b0;
      is_no_sample_o <= 1'b0;
    end else begin
      is_primitive_o <= leaves && is_counted;
      is_zero_area_o <= leaves && is_zero;
      is_backface_o  <= leaves && is_back;
      is_empty_o     <= leaves && is_counted && !is_zero && !is_back && d_is_empty_q;
      is_no_sample_o <= leaves && !is_zero && !is_back && !d_is_empty_q && is_sampleless_q;
    end
  end

  // With several samples per pixel the fraction bits of the edge functions go along.
  generate
    if (HAS_SAMPLES) begin : gen_edge_lows
      logic [3*S-1:0] low_q;  // before orientation; the newest edge is the highest
      genvar l;
      always_ff @(posedge clk) if (decide_moves && d_is_triangle) low_q <= {edge_value[0+:S], low_q[S+:2*S]};
      for (l = 0; l < 3; l++) begin : gen_edge
        assign triangle_o.edge_low[l*S+:S] = !d_is_triangle ? '0 : is_negative ? ~low_q[(2-l)*S+:S] : low_q[l*S+:S];
      end
    end
    if (raster_pkg::COORDINATES != 0) begin : gen_coordinates
      logic [raster_pkg::COORDINATE_FRAME_BITS-1:0] coordinates_q;
      always_ff @(posedge clk) if (decide_ready) coordinates_q <= p_q.coordinates;
      assign triangle_o.coordinates = raster_pkg::COORDINATE_FRAME_BITS'(coordinates_q);
    end
  endgenerate

  assign triangle_valid_o        = decide_busy_q && is_decided && !is_dropped;
  assign triangle_o.kind         = kind_q;
  assign triangle_o.primitive_id = id_q;
  assign triangle_o.box          = d_box_q;
  logic [E-1:0] size;
  add_or_subtract #(
      .WIDTH(E)
  ) u_size (
      .subtracts_i(is_negative),
      .a_i        ('0),
      .b_i        (area_q),
      .sum_o      (size)
  );
  assign triangle_o.area = A'(size);

  // With a stencil a triangle says which side it shows.
  raster_pkg::primitive_state_t state;
  generate
    if (raster_pkg::STENCIL_BITS != 0) begin : gen_side
      always_comb begin
        state         = state_q;
        state.is_back = d_is_triangle && state_q.tests_stencil && is_negative == front_cw_q;
      end
    end else begin : gen_no_side
      assign state = state_q;
    end
  endgenerate
  assign triangle_o.state = state;

  // In a triangle of negative area vertices 1 and 2 change places: its edges run the opposite way, edge i is edge 2 - i
  // reversed.
  genvar i;
  generate
    for (i = 0; i < 3; i++) begin : gen_vertex
      localparam int W = 2 * C + CODES;
      localparam int TURNED = (3 - i) % 3;
      logic [W-1:0] vertex;
      logic [V-1:0] value;
      assign vertex = is_negative ? vertex_q[TURNED*W+:W] : vertex_q[i*W+:W];
      assign value  = is_negative ? ~edge_q[(2-i)*V+:V] : edge_q[i*V+:V];
      assign triangle_o.vertex.x[i*C+:C]            = vertex[W-1-:C];
      assign triangle_o.vertex.y[i*C+:C]            = vertex[CODES+:C];
      assign triangle_o.vertex.code[i*CODES+:CODES] = vertex[0+:CODES];
      assign triangle_o.edge_value[i*V+:V]          = d_is_triangle ? value : '0;
    end
  endgenerate

endmodule
