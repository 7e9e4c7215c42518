// Coarse raster for the smallest parts: the same bits as coarse_raster.sv, with one edge stepped and tested per cycle.
//
// The edges stand in a ring of three. TURN rotates it once: each edge is stepped to the next tile as it leaves the
// front, and tested at the back one cycle later. The planes are stepped meanwhile. The walk is that of
// coarse_raster.sv. Occupancy: 5 cycles a tile, one more for a visit, one more where a HiZ bound is read; a visited
// tile is offered until fine_raster has finished it. Specification: model/stages/coarse_raster.hpp,
// model/stages/hiz.hpp.
module coarse_raster_serial (
    input logic clk_i,
    input logic rst_ni,

    // From triangle_setup
    input  logic                      setup_valid_i,
    output logic                      setup_ready_o,
    input  raster_pkg::setup_packet_t setup_i,

    // To the context RAM, with the setup packet; the RAM takes the steps from context_step_o, step_x one cycle later
    // and step_y two; context_o carries only fields that pass through
    output logic [raster_pkg::SLOT_BITS-1:0]      context_slot_o,
    output raster_pkg::context_packet_t           context_o,
    output logic [raster_pkg::ALL_LOCAL_BITS-1:0] context_step_o,
    input  logic                             slot_free_i,  // interpolate has read a slot for the last time

    // To fine_raster; edges_o is the context of the tile's primitive, visit_edges_o the edge_value of tile_o for a
    // visit. No edge is far below 0 in a visit: so only large values are clamped
    output logic                      tile_valid_o,
    input  logic                      tile_ready_i,
    output raster_pkg::tile_packet_t  tile_o,
    output raster_pkg::edge_context_t edges_o,
    output logic [3*raster_pkg::TILE_EDGE_BITS-1:0] visit_edges_o,

    // From depth_test: a tile visit has retired
    input logic                       retire_valid_i,
    input raster_pkg::retire_packet_t retire_i,

    // Counters: pulses for the tiles of triangles, and samples
    output logic                                 is_visited_o,
    output logic                                 is_outside_o,
    output logic                                 is_accepted_o,
    output logic                                 is_hiz_o,
    output logic [2*raster_pkg::TILE_SHIFT+$clog2(raster_pkg::MSAA_SAMPLES):0] samples_tested_o,

    output logic visits_are_done_o  // every tile visit has retired
);

  localparam int V = raster_pkg::EDGE_VALUE_BITS;
  localparam int D = raster_pkg::DELTA_BITS;
  localparam int TE = raster_pkg::TILE_EDGE_BITS;
  localparam int TS = raster_pkg::TILE_SHIFT;
  localparam int TX = raster_pkg::TILE_X_BITS;
  localparam int TY = raster_pkg::TILE_Y_BITS;
  localparam int PX = raster_pkg::PIXEL_X_BITS;
  localparam int PY = raster_pkg::PIXEL_Y_BITS;
  localparam int PLANES = raster_pkg::PLANES;
  localparam logic [32*PLANES-1:0] PLANE_BITS_OF = raster_pkg::PLANE_BITS_OF;
  localparam logic [32*PLANES-1:0] PLANE_AT = raster_pkg::PLANE_AT;
  localparam logic [32*PLANES-1:0] LOCAL_BITS_OF = raster_pkg::LOCAL_BITS_OF;
  localparam logic [32*PLANES-1:0] LOCAL_AT = raster_pkg::LOCAL_AT;
  localparam int S = raster_pkg::GRID_BITS;
  localparam int SLOTS = raster_pkg::CONTEXT_SLOTS;
  localparam int SLOT = raster_pkg::SLOT_BITS;
  localparam int NARROW = raster_pkg::GUARD_BITS - raster_pkg::PLANE_LOCAL_GUARD_BITS;  // bits a local step loses

  // ------------------------------------------------------------------------------------------------------------- walk
  localparam logic [2:0] IDLE = 3'd0, TURN = 3'd1, WALK = 3'd2, BOUND = 3'd3, END = 3'd4, CLEAR = 3'd5,
      VISIT = 3'd6;
  logic [2:0] state_q;
  logic [1:0] turn_q;     // cycle of TURN
  logic       is_new_q;   // TURN for the first tile, without a step

  raster_pkg::setup_packet_t s_q;
  logic [TX-1:0]   tile_x_q;
  logic [TY-1:0]   tile_y_q;
  logic [SLOT-1:0] slot_q;   // of the primitive in s_q
  logic [SLOT:0]   used_q;   // slots in use

  logic is_triangle, is_fast_clear, is_token, clears_bounds;
  logic takes, steps, turns_end, is_last_column, is_last_row, is_last_tile, clears, finishes;
  logic is_eligible, is_eligible_q;  // HiZ may reject tiles
  logic [raster_pkg::HIZ_CODE_BITS-1:0] bound;
  logic [raster_pkg::HIZ_CODE_BITS:0]   limit;
  logic is_behind, is_settled, visits_are_done, is_skipped, tile_taken;
  logic outside_q, inside_q;      // some edge, all edges
  logic ends_way_q, ends_left_q;  // outside an edge whose value does not grow in this direction, to the left
  assign is_triangle    = s_q.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE;
  assign is_fast_clear  = s_q.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR;
  assign is_token       = s_q.kind[1];  // fast clear, flush, line
  assign clears_bounds  = is_fast_clear && s_q.state.depth_write && raster_pkg::HIZ_BITS != 0;
  assign clears         = state_q == CLEAR && clears_bounds && visits_are_done;  // the bounds of a group of tiles each
                                                                                 // cycle
  assign setup_ready_o  = state_q == IDLE && used_q != (SLOT + 1)'(SLOTS);
  assign takes          = setup_valid_i && setup_ready_o;
  assign context_slot_o = slot_q;
  assign turns_end      = state_q == TURN && turn_q == 2'd3;

  assign is_behind    = {1'b0, bound} < limit;
  assign is_skipped   = (state_q == WALK && outside_q) || (state_q == BOUND && is_behind);
  assign tile_valid_o = state_q == VISIT || state_q == END;
  assign tile_taken   = tile_valid_o && tile_ready_i;
  assign steps        = is_skipped || (tile_taken && state_q != END);
  assign finishes     = tile_taken && (state_q == END || is_last_tile);

  // From one tile to the next.
  logic [TX-1:0] start_x_q, next_x;  // start of this row, then of the next
  logic          goes_left_q;        // direction of this move and of the walk after it
  logic          must_return_q;      // there are tiles to the left of the start
  logic          is_empty_q;         // every tile of the row so far was outside
  logic          goes_down_q, turns_back_q, moves_start_q;  // this move
  logic          was_left_q;         // direction before the move
  logic [TX-1:0] group_end;  // the last tile of the group that is cleared
  logic          is_last_group, is_leftmost, is_rightmost, exits, must_return, turns_back, row_ends, goes_down;
  assign is_leftmost    = tile_x_q == s_q.box.left[PX-1:TS];
  assign is_rightmost   = tile_x_q == s_q.box.right[PX-1:TS];
  assign is_last_group  = (tile_x_q ^ s_q.box.right[PX-1:TS]) >> raster_pkg::HIZ_GROUP_BITS == '0;
  assign group_end      = tile_x_q | TX'((1 << raster_pkg::HIZ_GROUP_BITS) - 1);
  assign is_last_column = goes_left_q ? is_leftmost : (clears ? is_last_group : is_rightmost);
  assign is_last_row    = tile_y_q == s_q.box.bottom[PY-1:TS];
  assign is_last_tile   = is_last_column && !must_return_q && is_last_row;
  assign must_return    = must_return_q && !ends_left_q;
  assign exits          = is_last_column || ends_way_q;
  assign turns_back     = exits && must_return;
  assign row_ends       = exits && !must_return;
  assign goes_down      = is_token ? is_last_column : goes_down_q;
  assign next_x         = goes_down || turns_back_q ? start_x_q - TX'(turns_back_q) :
                                      goes_left_q ? tile_x_q - TX'(1) : (clears ? group_end : tile_x_q) + TX'(1);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q <= IDLE;
      slot_q  <= '0;
      used_q  <= '0;
    end else begin
      if (finishes) begin
        state_q <= IDLE;
        slot_q  <= slot_q + SLOT'(1);
      end else if (steps) state_q <= row_ends && is_last_row ? END : TURN;
      else begin
        case (state_q)
          IDLE: if (takes) state_q <= TURN;
          TURN: if (turns_end) state_q <= is_token ? CLEAR : WALK;
          WALK:
          if (is_settled) state_q <= is_eligible_q ? BOUND : VISIT;
          BOUND: state_q <= VISIT;
          CLEAR: if ((clears || !clears_bounds) && is_last_tile) state_q <= END;
          default: state_q <= state_q;
        endcase
      end
      used_q <= used_q + (SLOT + 1)'(takes) - (SLOT + 1)'(slot_free_i);
    end
  end

  always_ff @(posedge clk_i) begin
    turn_q <= state_q == TURN ? turn_q + 2'd1 : 2'd0;
    is_eligible_q <= is_eligible;
    if (takes) is_new_q <= 1'b1;
    else if (turns_end) is_new_q <= 1'b0;

    if (takes) begin
      s_q      <= setup_i;
      tile_x_q <= setup_i.box.left[PX-1:TS];
      tile_y_q <= setup_i.box.top[PY-1:TS];
    end else if (turns_end && is_token && !clears_bounds) begin
      tile_x_q <= s_q.box.right[PX-1:TS];  // nothing to clear here
      tile_y_q <= s_q.box.bottom[PY-1:TS];
    end else if ((turns_end && !is_new_q) || (clears && !is_last_tile)) begin
      tile_x_q <= next_x;
      tile_y_q <= tile_y_q + TY'(goes_down);
    end else if (clears) begin
      tile_x_q <= s_q.box.right[PX-1:TS];  // from the last group to the last tile
    end

    if (takes) begin
      start_x_q     <= setup_i.box.left[PX-1:TS];
      goes_left_q   <= 1'b0;
      must_return_q <= 1'b0;
      is_empty_q    <= 1'b1;
      goes_down_q   <= 1'b0;
      turns_back_q  <= 1'b0;
      moves_start_q <= 1'b0;
      was_left_q    <= 1'b0;
    end else if (steps) begin
      was_left_q    <= goes_left_q;
      goes_left_q   <= (goes_left_q || turns_back) && !row_ends;
      must_return_q <= row_ends ? start_x_q != s_q.box.left[PX-1:TS] : must_return && !turns_back;
      is_empty_q    <= row_ends || (is_empty_q && outside_q);
      goes_down_q   <= row_ends;
      turns_back_q  <= turns_back;
      moves_start_q <= is_empty_q && outside_q;
    end else if (turns_end && moves_start_q) start_x_q <= next_x;
  end

  // ------------------------------------------------------------------------------------------------------------ edges
  // Edge 0 lowest. value: at the tile's first pixel; row: at the start of its row, in use after the first turn; right,
  // down: one pixel that way. right is loaded as dy and negated in the first turn.
  logic [3*V-1:0]      values, row_q;
  logic [2*V-1:0]      value_q;
  logic signed [V-1:0] not_value_q;  // the edge at the back, complemented
  logic [3*D-1:0]      right_q, down_q;
  logic                moves_ring;
  logic signed [V-1:0] from, next;
  logic signed [D-1:0] step, right;
  logic [V-TS:0]       sum;
  assign values     = {~not_value_q, value_q};
  assign moves_ring = state_q == TURN && turn_q != 2'd3;
  assign from       = goes_down_q || turns_back_q ? row_q[0+:V] : value_q[0+:V];
  assign step       = is_new_q ? '0 : goes_down_q ? down_q[0+:D] : right_q[0+:D] ^ {D{goes_left_q}};
  assign sum        = {from[V-1:TS], 1'b1} + {(V - TS)'(step), goes_left_q};
  assign next       = {sum[V-TS:1], from[TS-1:0]};
  assign right      = (right_q[0+:D] ^ {D{is_new_q}}) + D'(is_new_q);

  always_ff @(posedge clk_i) begin
    if (takes) begin
      {not_value_q, value_q} <= {~setup_i.edge_value[2*V+:V], setup_i.edge_value[0+:2*V]};
      right_q <= setup_i.dy;
      down_q  <= setup_i.dx;
    end else if (moves_ring) begin
      {not_value_q, value_q} <= {~next, values[V+:2*V]};
      right_q <= {right, right_q[D+:2*D]};
      down_q  <= {down_q[0+:D], down_q[D+:2*D]};
    end
    if (moves_ring) row_q <= {is_new_q || goes_down_q || moves_start_q ? next : row_q[0+:V], row_q[V+:2*V]};
  end

  // The edge at the back, at the tile's best and at its worst corner: T - 1 pixels away.
  logic signed [D-1:0]  test_right, test_down;
  logic                 gets_no_better;  // outside this edge, whose value does not grow in this direction
  logic signed [D:0]    best, worst;
  logic signed [V:0]    less_best, less_worst;  // value - best, from the complement
  logic signed [V:0]    largest, smallest;
  assign test_right = right_q[2*D+:D];
  assign test_down  = down_q[2*D+:D];
  assign best       = (test_right[D-1] ? '0 : (D + 1)'(test_right)) + (test_down[D-1] ? '0 : (D + 1)'(test_down));
  assign worst      = (test_right[D-1] ? (D + 1)'(test_right) : '0) + (test_down[D-1] ? (D + 1)'(test_down) : '0);
  assign gets_no_better = goes_left_q ? !test_right[D-1] : test_right[D-1] || test_right == '0;
  assign less_best  = ~((V + 1)'(not_value_q) + (V + 1)'(best));
  assign less_worst = ~((V + 1)'(not_value_q) + (V + 1)'(worst));
  assign largest    = less_best + ((V + 1)'(best) <<< TS);
  assign smallest   = less_worst + ((V + 1)'(worst) <<< TS);

  always_ff @(posedge clk_i) begin
    if (state_q == TURN) begin
      outside_q   <= turn_q != 2'd0 && (outside_q || largest[V]);
      inside_q    <= turn_q == 2'd0 || (inside_q && !smallest[V]);
      ends_way_q  <= turn_q != 2'd0 && (ends_way_q || (largest[V] && gets_no_better));
      ends_left_q <= turn_q != 2'd0 && (ends_left_q || (largest[V] && !test_right[D-1]));
    end
  end

  logic [3*TE-1:0] edge_value;
  genvar i;
  generate
    for (i = 0; i < 3; i++) begin : gen_edge
      if (V > TE) begin : gen_saturate
        logic sign, fits;
        assign sign = values[i*V+V-1];
        assign fits = values[i*V+TE-1+:V-TE+1] == {(V - TE + 1) {sign}};
        assign edge_value[i*TE+:TE] = fits ? values[i*V+:TE] : {sign, {(TE - 1) {~sign}}};
        assign visit_edges_o[i*TE+:TE] = {sign, values[i*V+:TE-1] | {(TE - 1) {!sign && !fits}}};
      end else begin : gen_extend
        assign edge_value[i*TE+:TE] = TE'($signed(values[i*V+:V]));
        assign visit_edges_o[i*TE+:TE] = edge_value[i*TE+:TE];
      end
    end
  endgenerate

  // ----------------------------------------------------------------------------------------------------------- planes
  // The wide value at the tile's anchor; setup added the offset that makes its high bits the local anchor. In TURN,
  // cycle 0 goes back to the row's start where the move begins there, cycle 2 steps, and cycle 3 notes a new start. The
  // step to the right stands first in the ring, the step down second; they swap twice, around the step for a move down,
  // before it for a turn back. In the second swap the step to the right is complemented where the walk turns.
  logic loads_start, adds_step, notes_start, swaps, turns_step;
  assign loads_start = state_q == TURN && (is_new_q ? turn_q == 2'd2 : turn_q == 2'd0 && (goes_down_q || turns_back_q));
  assign adds_step   = state_q == TURN && turn_q == 2'd2 && !is_new_q;
  assign notes_start = turns_end && (goes_down_q || moves_start_q);
  assign swaps       = state_q == TURN && (((is_new_q || turns_back_q) && turn_q <= 2'd1) ||
                                           (goes_down_q && (turn_q == 2'd1 || turn_q == 2'd2)));
  assign turns_step  = turns_back_q ? turn_q == 2'd1 : turn_q == 2'd2 && was_left_q;

  // The context holds steps per pixel, narrowed to the local guard bits and rounded by the adder of the plane, while
  // there is no value yet. Cycle 0 of a new primitive adds half a unit to the step to the right, and cycle 1 to the
  // step down, which swap meanwhile; the value comes in cycle 2.
  generate
    for (i = 0; i < PLANES; i++) begin : gen_plane
      localparam int P = PLANE_BITS_OF[32*i+:32];
      localparam int PLANE = PLANE_AT[32*i+:32];
      localparam int B = LOCAL_BITS_OF[32*i+:32];
      localparam int LOCAL = LOCAL_AT[32*i+:32];
      localparam int M = P - TS - S;  // a tile's step leaves the bits below as they are
      localparam int T = NARROW + B;  // bits of a step per pixel; the highest bits of a step per tile have no effect
      logic [P-1:0] value, step_x, step_y;
      logic [M-1:0] plane_q, start_q;
      logic [T-1:0] step_q, other_step_q;
      logic [T:0]   moved;
      assign value      = setup_i.value[PLANE+:P];
      assign step_x     = setup_i.step_x[PLANE+:P];
      assign step_y     = setup_i.step_y[PLANE+:P];
      assign moved      = {T'(plane_q), 1'b1} + {step_q, goes_left_q};

      always_ff @(posedge clk_i) begin
        if (takes) begin
          step_q       <= step_x[T-1:0];
          other_step_q <= step_y[T-1:0];
        end else if (swaps) begin
          step_q       <= other_step_q ^ {T{turns_step}};
          other_step_q <= step_q;
        end
        if (takes) start_q <= value[P-1:TS+S];
        else if (notes_start) start_q <= plane_q;
        if (takes) plane_q <= M'(1) << (NARROW - 1);
        else if (loads_start) plane_q <= start_q;
        else if (adds_step) plane_q <= moved[M:1];
      end

      assign tile_o.anchor[LOCAL+:B]    = plane_q[M-1-:B];
      assign context_step_o[LOCAL+:B]   = moved[T-:B];
      assign context_o.step_x[LOCAL+:B] = B'($signed(step_x) >>> NARROW) + B'(step_x[NARROW-1]);
      assign context_o.step_y[LOCAL+:B] = B'($signed(step_y) >>> NARROW) + B'(step_y[NARROW-1]);
    end
  endgenerate

  assign context_o.state = setup_i.state;
  assign context_o.range = setup_i.range;

  // ----------------------------------------------------------------------------------------------------- visits, HiZ
  logic starts_visit;
  assign starts_visit = tile_taken && state_q != END;
  hiz u_hiz (
      .clk_i,
      .rst_ni,
      .setup_i          (s_q),
      .tile_x_i         (tile_x_q),
      .tile_y_i         (tile_y_q),
      .passes_i         (turns_end),
      .reads_i          (state_q == WALK),
      .read_x_i         (tile_x_q),
      .read_y_i         (tile_y_q),
      .clears_i         (clears),
      .starts_visit_i   (starts_visit),
      .raises_i         (s_q.state.depth_write && s_q.state.depth_test[2]),
      .is_eligible_o    (is_eligible),
      .is_settled_o     (is_settled),
      .bound_o          (bound),
      .limit_o          (limit),
      .visits_are_done_o(visits_are_done),
      .retire_valid_i,
      .retire_i
  );

  // ----------------------------------------------------------------------------------------------------------- result
  // The tile's part of the box comes a cycle after the tile's coordinates, before a packet is offered.
  raster_pkg::tile_box_t box, box_q;
  assign box.left   = is_leftmost ? s_q.box.left[TS-1:0] : '0;
  assign box.top    = tile_y_q == s_q.box.top[PY-1:TS] ? s_q.box.top[TS-1:0] : '0;
  assign box.right  = is_rightmost ? s_q.box.right[TS-1:0] : '1;
  assign box.bottom = is_last_row ? s_q.box.bottom[TS-1:0] : '1;
  always_ff @(posedge clk_i) box_q <= box;

  assign tile_o.kind           = s_q.kind;
  assign tile_o.is_visit       = state_q != END;
  assign tile_o.ends_primitive = state_q == END || is_last_tile;
  assign tile_o.slot           = slot_q;
  assign tile_o.box            = box_q;
  assign tile_o.is_inside      = inside_q && state_q != END;
  assign tile_o.edge_value     = edge_value;

  assign tile_o.key.primitive_id = s_q.primitive_id;
  assign tile_o.key.tile_x       = tile_x_q;
  assign tile_o.key.tile_y       = tile_y_q;

  assign edges_o.step_x        = right_q;
  assign edges_o.step_y        = down_q;

  // Counters
  logic [TS:0]     width, height;
  logic [2*TS:0]   area;
  assign width       = (TS + 1)'(box_q.right) - (TS + 1)'(box_q.left) + (TS + 1)'(1);
  assign height      = (TS + 1)'(box_q.bottom) - (TS + 1)'(box_q.top) + (TS + 1)'(1);
  always_comb begin  // no multiplier for a counter
    area = '0;
    for (int b = 0; b <= TS; b++) area = area + (height[b] ? (2 * TS + 1)'(width) << b : '0);
  end
  // One cycle late: the signal that takes a tile is late enough without the counters downstream.
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      is_visited_o     <= 1'b0;
      is_outside_o     <= 1'b0;
      is_hiz_o         <= 1'b0;
      is_accepted_o    <= 1'b0;
      samples_tested_o <= '0;
    end else begin
      is_visited_o     <= steps && is_triangle;
      is_outside_o     <= state_q == WALK && outside_q && is_triangle;
      is_hiz_o         <= state_q == BOUND && is_behind && is_triangle;
      is_accepted_o    <= starts_visit && inside_q && is_triangle;
      samples_tested_o <= starts_visit && !inside_q && is_triangle ? area : '0;
    end
  end

  assign visits_are_done_o = visits_are_done;

endmodule
