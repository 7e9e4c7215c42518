// Coarse raster: the tiles of a primitive's box, row by row, without tiles that the primitive cannot change.
//
// In: a setup packet. Out: a tile packet for each tile that is neither outside an edge (trivial reject) nor behind the
// tile's HiZ bound; if the last tile of the walk was skipped, a packet without a visit marks the primitive's end. Three
// cycles from the setup packet to the first visit; a tile a cycle, and where bounds are read three for a visit.
//
// Two steps: the walk, and the tile that it has produced, which waits in a register until fine_raster takes it. So the
// decision about a tile starts from registers: its HiZ bound arrives with the tile, while the walk is one tile ahead.
//
// A row is walked to the right from its start, then from there to the left, each way until the tile is outside an edge
// whose value does not grow in that direction. It starts below the first tile of the row above that was not outside.
//
// A primitive whose box touches at most 2x2 tiles reads no bounds. For any other, the bound of the next tile is read on
// the way to it, from PREPARE on, when reading is allowed: not while a visit waits to start, which changes the content
// of bounds. A tile whose bound could not be read then, or was read too early, waits and reads it after that visit.
// Content of bounds: hiz.sv. Specification: model/stages/coarse_raster.hpp, model/stages/hiz.hpp.
module coarse_raster (
    input logic clk_i,
    input logic rst_ni,

    // From triangle_setup
    input  logic                      setup_valid_i,
    output logic                      setup_ready_o,
    input  raster_pkg::setup_packet_t setup_i,

    // To the context RAM, with the setup packet
    output logic [raster_pkg::SLOT_BITS-1:0] context_slot_o,
    output raster_pkg::context_packet_t      context_o,
    output logic [raster_pkg::ALL_LOCAL_BITS-1:0] context_step_o,  // the serial stage sends steps one after the other
    input  logic                             slot_free_i,  // interpolate has read a slot for the last time

    // To fine_raster; edges_o is the context of the tile's primitive
    output logic                      tile_valid_o,
    input  logic                      tile_ready_i,
    output raster_pkg::tile_packet_t  tile_o,
    output raster_pkg::edge_context_t edges_o,
    output logic [3*raster_pkg::TILE_EDGE_BITS-1:0] visit_edges_o,  // for fine_raster_serial

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
  localparam logic [32*PLANES-1:0] STEP_BITS_OF = raster_pkg::STEP_BITS_OF;
  localparam logic [32*PLANES-1:0] STEP_AT = raster_pkg::STEP_AT;
  localparam int S = raster_pkg::GRID_BITS;
  localparam int SAMPLE_SHIFT = $clog2(raster_pkg::MSAA_SAMPLES);
  localparam int SLOTS = raster_pkg::CONTEXT_SLOTS;
  localparam int SLOT = raster_pkg::SLOT_BITS;

  localparam logic [2:0] IDLE = 3'd0, PREPARE = 3'd1, WALK = 3'd2, CLEAR = 3'd3, PASS = 3'd4;
  logic [2:0] state_q;  // state of the walk. PASS: a token after its CLEAR

  raster_pkg::setup_packet_t s_q;
  logic [TX-1:0]   tile_x_q;
  logic [TY-1:0]   tile_y_q;
  logic [SLOT-1:0] slot_q;   // of the primitive in s_q, or of the next one
  logic [SLOT:0]   used_q;   // slots in use

  logic is_triangle, has_walk, clears_bounds;
  logic takes, steps, is_last_row, is_last_tile, is_eligible, is_eligible_q, finishes;
  logic is_outside, is_inside, is_settled, visits_are_done;
  logic [raster_pkg::HIZ_CODE_BITS-1:0] bound;
  logic [raster_pkg::HIZ_CODE_BITS:0]   limit;
  assign is_triangle    = s_q.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE;
  assign has_walk       = !s_q.kind[1];  // bit 1 of a kind: a token (fast clear, flush, line, state)
  assign clears_bounds  = s_q.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR && s_q.state.depth_write &&
                          raster_pkg::HIZ_BITS != 0;
  assign is_last_row    = tile_y_q == s_q.box.bottom[PY-1:TS];
  assign setup_ready_o  = state_q == IDLE && used_q != (SLOT + 1)'(SLOTS);
  assign takes          = setup_valid_i && setup_ready_o;
  assign context_slot_o = slot_q;

  // --- The tile that the walk has produced: on offer, or dropped where it lies behind its bound. The last tile of the
  // walk is on offer in any case, to mark the primitive's end.
  logic left_valid_q;
  logic left_behind;    // the tile lies behind its bound
  logic [raster_pkg::HIZ_CODE_BITS-1:0] left_bound_q;
  logic [raster_pkg::HIZ_CODE_BITS:0]   left_limit_q;
  logic left_raises_q;  // the primitive's state may raise a depth
  raster_pkg::tile_packet_t  left_q;
  raster_pkg::edge_context_t edges, left_edges_q;
  logic is_visit, is_dropped, tile_taken, left_is_free, left_is_empty;
  assign left_behind   = {1'b0, left_bound_q} < left_limit_q;
  assign is_visit      = left_q.is_visit && !left_behind;
  assign is_dropped    = left_valid_q && left_behind && !left_q.ends_primitive;
  assign tile_valid_o  = left_valid_q && (is_visit ? is_settled : left_q.ends_primitive);
  assign tile_taken    = tile_valid_o && tile_ready_i;
  assign left_is_empty = !left_valid_q || is_dropped;
  assign left_is_free  = left_is_empty || tile_taken;

  // --- The walk. The walk goes on when a tile is outside, or enters that register.
  logic ends_walk, passes_token, enters;
  logic has_bound_q;    // the tile's bound has been read, and no visit has started since or waits to start
  logic has_verdict;
  assign passes_token = (state_q == PREPARE && !has_walk && !clears_bounds) || state_q == PASS;
  assign has_verdict  = has_bound_q && left_is_empty;
  assign enters       = state_q == WALK ? (is_outside ? ends_walk && left_is_free :
                                                        is_eligible_q ? has_verdict : left_is_free) :
                                          passes_token && left_is_free;
  // The walk enters a tile or goes past one outside. That fine_raster takes a tile is known last: it is asked last.
  logic steps_at_once;
  assign steps_at_once = is_outside ? !ends_walk || left_is_empty : is_eligible_q ? has_verdict : left_is_empty;
  assign steps         = state_q == WALK && (steps_at_once || ((is_outside || !is_eligible_q) && tile_taken));
  assign finishes      = enters && (ends_walk || state_q != WALK);

  // From one tile to the next.
  logic [TX-1:0] start_x_q, next_x;  // start of this row, then of the next
  logic [TY-1:0] next_y;
  logic          goes_left_q;
  logic          must_return_q;  // there are tiles to the left of the start
  logic          is_empty_q;     // every tile of the row so far was outside
  logic          is_leftmost, is_rightmost, exits, must_return, turns_back, row_ends, moves_left, moves_start;
  logic          is_last_column_q, is_last_row_q;  // known a cycle ahead, as edge_is_outside_q is
  logic          is_start_q;        // this tile starts the row: row_q of edges and planes copies it now
  logic          moved_start_q;     // the row's start has moved to tile_x_q; start_x_q follows
  logic [TX-1:0] start_x;
  logic          moved_q, returned_q, row_ended_q, moved_left_q;  // in the cycle before, for the planes
  logic          clears;     // the bounds of a group of tiles each cycle
  logic [TX-1:0] group_end;  // its last tile
  logic [2:0]    edge_is_outside_q, no_better_left_q, no_better_right_q;
  logic [2:0]    no_better_ahead_q;  // in the direction of the walk
  assign clears         = state_q == CLEAR;
  assign is_leftmost    = tile_x_q == s_q.box.left[PX-1:TS];
  assign is_rightmost   = tile_x_q == s_q.box.right[PX-1:TS];
  assign group_end      = tile_x_q | TX'((1 << raster_pkg::HIZ_GROUP_BITS) - 1);
  assign is_last_tile   = is_last_column_q && !must_return_q && is_last_row_q;
  assign must_return    = must_return_q && (edge_is_outside_q & no_better_left_q) == '0;
  assign exits          = is_last_column_q || (edge_is_outside_q & no_better_ahead_q) != '0;
  assign turns_back     = exits && must_return;
  assign row_ends       = exits && !must_return;
  assign ends_walk      = row_ends && is_last_row_q;
  assign moves_left     = goes_left_q || turns_back;
  assign start_x        = moved_start_q ? tile_x_q : start_x_q;
  assign moves_start    = is_empty_q && is_outside;  // or moves all of it down
  assign next_x         = exits ? start_x - TX'(turns_back) : goes_left_q ? tile_x_q - TX'(1) : (clears ? group_end : tile_x_q) + TX'(1);
  assign next_y         = tile_y_q + TY'(row_ends);

  // In PREPARE the step is 0: next_is_outside is that of the first tile.
  logic goes_on, starts, returns, notes_start, moves_right;
  logic [TX-1:0] at_x;  // of the next tile, or of the first one
  logic [TY-1:0] at_y;
  assign starts      = state_q == PREPARE;
  assign at_x        = starts ? tile_x_q : next_x;
  assign at_y        = starts ? tile_y_q : next_y;
  assign returns     = exits && !starts && !is_start_q;
  assign moves_right = !starts && !row_ends && !moves_left;
  assign notes_start = starts || (goes_on && (row_ends || moves_start));
  assign goes_on = steps || (clears && !is_last_tile);  // the last step has no effect

  logic clk;  // of the walk, its state and slot, and of the tile it has produced
  clock_gate u_clock_gate (
      .clk_i,
      .reset_i (!rst_ni),
      .enable_i(takes || starts || clears || goes_on || is_start_q || moved_start_q || moved_q || enters),
      .clk_o   (clk)
  );

  always_ff @(posedge clk or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q <= IDLE;
      slot_q  <= '0;
    end else begin
      case (state_q)
        IDLE: if (takes) state_q <= PREPARE;
        PREPARE:
        if (has_walk) state_q <= WALK;
        else if (!clears_bounds) state_q <= enters ? IDLE : PREPARE;
        else if (visits_are_done && !(left_valid_q && is_visit)) state_q <= CLEAR;
        CLEAR: if (is_last_tile) state_q <= PASS;
        default: if (finishes) state_q <= IDLE;
      endcase
      if (finishes) slot_q <= slot_q + SLOT'(1);
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) used_q <= '0;
    else used_q <= used_q + (SLOT + 1)'(takes) - (SLOT + 1)'(slot_free_i);
  end

  always_ff @(posedge clk) begin
    if (state_q == IDLE) begin
      s_q <= setup_i;
      // A token goes straight to its last tile, unless it clears bounds group by group.
      if (setup_i.kind[1] && !(setup_i.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR && setup_i.state.depth_write &&
                               raster_pkg::HIZ_BITS != 0)) begin
        tile_x_q <= setup_i.box.right[PX-1:TS];
        tile_y_q <= setup_i.box.bottom[PY-1:TS];
      end else begin
        tile_x_q <= setup_i.box.left[PX-1:TS];
        tile_y_q <= setup_i.box.top[PY-1:TS];
      end
    end else if (goes_on) begin
      tile_x_q <= next_x;
      tile_y_q <= next_y;
    end else if (clears) begin
      tile_x_q <= s_q.box.right[PX-1:TS];  // from the last group to the last tile
    end
    // goes_on settles late and enables every register of the tile: the row's start is copied from them a cycle later.
    is_start_q    <= notes_start;
    moved_start_q <= goes_on && moves_start;
    if (state_q == IDLE) start_x_q <= setup_i.box.left[PX-1:TS];
    else if (moved_start_q) start_x_q <= tile_x_q;
    if (state_q == IDLE) begin
      goes_left_q   <= 1'b0;
      must_return_q <= 1'b0;
      is_empty_q    <= 1'b1;
    end else if (goes_on) begin
      goes_left_q   <= moves_left && !row_ends;
      must_return_q <= row_ends ? start_x != s_q.box.left[PX-1:TS] : must_return && !turns_back;
      is_empty_q    <= row_ends || moves_start;
    end
    if (starts) is_eligible_q <= is_eligible;
    if (starts || goes_on) begin
      is_last_column_q <= has_walk ? at_x == (moves_left && !row_ends ? s_q.box.left[PX-1:TS] : s_q.box.right[PX-1:TS]) :
                                     (at_x ^ s_q.box.right[PX-1:TS]) >> raster_pkg::HIZ_GROUP_BITS == '0;
      is_last_row_q    <= at_y == s_q.box.bottom[PY-1:TS];
    end
  end

  // --- Edges: one value each at the tile's first pixel, and the increments to its best and its worst corner. Whether a tile is
  // outside is known a cycle ahead, from the values that it will have: so the walk is decided by registers.
  logic [2:0]      edge_is_inside, next_is_outside;
  logic [3*TE-1:0] edge_value;
  genvar i;
  generate
    for (i = 0; i < 3; i++) begin : gen_edge
      logic signed [V-1:0]  value_q, row_q, from, next;  // row: at the row's start
      logic [V-TS-1:0]      step, sum;
      logic signed [D-1:0]  dx, dy;
      logic signed [D:0]    best, worst;
      logic signed [TE-1:0] to_best, to_worst;  // times T - 1
      logic signed [V:0]    largest, smallest;  // of the next tile; of this one
      assign dx    = s_q.dx[i*D+:D];
      assign dy    = s_q.dy[i*D+:D];
      assign best  = (dx[D-1] ? '0 : (D + 1)'(dx)) - (dy[D-1] ? (D + 1)'(dy) : '0);
      assign worst = (dx[D-1] ? (D + 1)'(dx) : '0) - (dy[D-1] ? '0 : (D + 1)'(dy));
      // With several samples per pixel the farthest possible one: half of |dx| + |dy| away, rounded up.
      logic [D-1:0] reach;
      if (raster_pkg::MSAA_SAMPLES > 1) begin : gen_reach
        logic [D:0] size;  // |dx| + |dy|
        assign size  = best - worst;
        assign reach = D'((size + (D + 1)'(1)) >> 1);
      end else begin : gen_centre
        assign reach = '0;
      end
      assign from  = returns ? row_q : value_q;
      assign step  = starts ? '0 : row_ends ? (V - TS)'(dx) : (V - TS)'(dy);
      assign next  = {sum, from[TS-1:0]};
      add_or_subtract #(
          .WIDTH(V - TS)
      ) u_next (
          .subtracts_i(moves_right),  // an edge's step in x is -dy
          .a_i        (from[V-1:TS]),
          .b_i        (step),
          .sum_o      (sum)
      );

      assign to_best  = (TE'(best) <<< TS) - TE'(best) + TE'(reach);
      assign to_worst = (TE'(worst) <<< TS) - TE'(worst) - TE'(reach);
      assign largest  = (V + 1)'(next) + (V + 1)'(to_best);
      assign smallest = (V + 1)'(value_q) + (V + 1)'(to_worst);
      assign next_is_outside[i] = largest[V];
      assign edge_is_inside[i]  = !smallest[V];

      always_ff @(posedge clk) begin
        if (state_q == IDLE) begin
          value_q <= setup_i.edge_value[i*V+:V];
        end else if (goes_on) value_q <= next;
        if (is_start_q) row_q <= value_q;
        if (starts || goes_on) edge_is_outside_q[i] <= next_is_outside[i];
        if (starts) begin
          no_better_left_q[i]  <= (dy[D-1] || dy == '0);
          no_better_right_q[i] <= !dy[D-1];
        end
        if (starts) no_better_ahead_q[i] <= !dy[D-1];
        else if (goes_on) no_better_ahead_q[i] <= moves_left && !row_ends ? no_better_left_q[i] : no_better_right_q[i];
      end

      if (V > TE) begin : gen_saturate
        logic fits;
        assign fits = value_q[V-1:TE-1] == {(V - TE + 1) {value_q[V-1]}};
        assign edge_value[i*TE+:TE] = fits ? value_q[TE-1:0] : {value_q[V-1], {(TE - 1) {~value_q[V-1]}}};
      end else begin : gen_extend
        assign edge_value[i*TE+:TE] = TE'(value_q);
      end
    end
  endgenerate
  assign is_outside = edge_is_outside_q != '0;
  assign is_inside  = edge_is_inside == '1;

  // --- Planes: the wide value at the tile's anchor, without the bits that no step changes; setup added the offset that
  // makes its high bits the local anchor. The context holds steps per pixel, narrowed to the local guard bits.
  // No decision waits for a plane, and where the walk goes is known late: planes keep the tile before, and how it was left.
  logic [raster_pkg::ALL_LOCAL_BITS-1:0] anchor;
  always_ff @(posedge clk) begin
    moved_q      <= goes_on;
    returned_q   <= returns;
    row_ended_q  <= row_ends;
    moved_left_q <= moves_left;
  end
  generate
    for (i = 0; i < PLANES; i++) begin : gen_plane
      localparam int P = PLANE_BITS_OF[32*i+:32];
      localparam int PLANE = PLANE_AT[32*i+:32];
      localparam int B = LOCAL_BITS_OF[32*i+:32];
      localparam int LOCAL = LOCAL_AT[32*i+:32];
      localparam int M = P - TS - S;  // a tile's step leaves the bits below as they are
      localparam int NARROW = P - B - S;  // bits removed from a local step
      localparam int SB = STEP_BITS_OF[32*i+:32];
      localparam int STEP = STEP_AT[32*i+:32];
      logic [P-1:0] value;
      logic [P-1:0] step_x, step_y;
      logic [M-1:0] before_q, row_q, from, step, here;
      assign value  = setup_i.value[PLANE+:P];
      assign step_x = setup_i.step_x[PLANE+:P];
      assign step_y = setup_i.step_y[PLANE+:P];
      assign from   = moved_q && returned_q ? row_q : before_q;
      assign step   = !moved_q ? '0 : row_ended_q ? s_q.step_y[PLANE+:M] : s_q.step_x[PLANE+:M];
      add_or_subtract #(
          .WIDTH(M)
      ) u_here (
          .subtracts_i(!row_ended_q && moved_left_q),
          .a_i        (from),
          .b_i        (step),
          .sum_o      (here)
      );
      always_ff @(posedge clk) begin
        if (state_q == IDLE) before_q <= value[P-1-:M];
        else if (moved_q) before_q <= here;
        if (is_start_q) row_q <= here;
      end
      assign anchor[LOCAL+:B]           = here[M-1-:B];
      assign context_o.step_x[STEP+:SB] = SB'($signed(step_x) >>> NARROW) + SB'(step_x[NARROW-1]);
      assign context_o.step_y[STEP+:SB] = SB'($signed(step_y) >>> NARROW) + SB'(step_y[NARROW-1]);
    end
  endgenerate
  assign context_step_o  = '0;
  assign context_o.state = setup_i.state;
  assign context_o.range = setup_i.range;
  generate
    if (raster_pkg::COORDINATES != 0) begin : gen_coordinates
      assign context_o.coordinates = setup_i.coordinates;
    end
  endgenerate

  // --- Visits under way, and bounds on the depths of a tile
  logic          starts_visit, reads_bound, reads_next;
  logic [TX-1:0] read_x;
  logic [TY-1:0] read_y;
  assign starts_visit = tile_taken && is_visit;
  assign reads_bound  = (state_q == PREPARE || state_q == WALK) && is_settled && !(left_valid_q && is_visit);
  assign reads_next   = state_q == WALK && (is_outside || has_verdict);  // where bounds matter the walk continues
  assign read_x       = reads_next ? next_x : tile_x_q;
  assign read_y       = reads_next ? next_y : tile_y_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) has_bound_q <= 1'b0;
    else has_bound_q <= reads_bound;
  end
  hiz u_hiz (
      .clk_i,
      .rst_ni,
      .setup_i          (s_q),
      .tile_x_i         (tile_x_q),
      .tile_y_i         (tile_y_q),
      .passes_i         (state_q == PREPARE),
      .reads_i          (reads_bound),
      .read_x_i         (read_x),
      .read_y_i         (read_y),
      .clears_i         (clears),
      .starts_visit_i   (starts_visit),
      .raises_i         (left_raises_q),
      .is_eligible_o    (is_eligible),
      .is_settled_o     (is_settled),
      .bound_o          (bound),
      .limit_o          (limit),
      .visits_are_done_o(visits_are_done),
      .retire_valid_i,
      .retire_i
  );

  // --- The packet
  raster_pkg::tile_box_t box;
  assign box.left   = is_leftmost ? s_q.box.left[TS-1:0] : '0;
  assign box.top    = tile_y_q == s_q.box.top[PY-1:TS] ? s_q.box.top[TS-1:0] : '0;
  assign box.right  = is_rightmost ? s_q.box.right[TS-1:0] : '1;
  assign box.bottom = is_last_row ? s_q.box.bottom[TS-1:0] : '1;

  logic [3*D-1:0] step_x;
  generate
    for (i = 0; i < 3; i++) begin : gen_step
      assign step_x[i*D+:D] = -s_q.dy[i*D+:D];
    end
    if (raster_pkg::MSAA_SAMPLES > 1) begin : gen_edge_lows
      assign edges.low = s_q.edge_low;
    end
  endgenerate
  assign edges.step_x = step_x;
  assign edges.step_y = s_q.dx;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) left_valid_q <= 1'b0;
    else if (left_is_free) left_valid_q <= enters;
  end
  always_ff @(posedge clk) begin
    if (left_is_free) begin
      left_bound_q               <= bound;
      left_limit_q               <= state_q == WALK && !is_outside && is_eligible_q ? limit : '0;
      left_raises_q              <= s_q.state.depth_write && s_q.state.depth_test[2];
      left_q.kind                <= s_q.kind;
      left_q.is_visit            <= state_q == WALK && !is_outside;  // unless the tile lies behind its bound
      left_q.ends_primitive      <= state_q != WALK || ends_walk;
      left_q.key.primitive_id    <= s_q.primitive_id;
      left_q.key.tile_x          <= tile_x_q;
      left_q.key.tile_y          <= tile_y_q;
      left_q.slot                <= slot_q;
      left_q.box                 <= box;
      left_q.is_inside           <= is_inside;
      left_q.edge_value          <= edge_value;
      left_q.anchor              <= anchor;
      left_edges_q               <= edges;
    end
  end
  always_comb begin
    tile_o           = left_q;
    tile_o.is_visit  = is_visit;
    tile_o.is_inside = left_q.is_inside && is_visit;
  end
  assign edges_o = left_edges_q;
  assign visit_edges_o = '0;

  // --- Counters
  logic            left_is_triangle;
  assign left_is_triangle = left_q.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE;
  logic [TS:0]     width, height;
  logic [2*TS:0]   area;
  assign width       = (TS + 1)'(left_q.box.right) - (TS + 1)'(left_q.box.left) + (TS + 1)'(1);
  assign height      = (TS + 1)'(left_q.box.bottom) - (TS + 1)'(left_q.box.top) + (TS + 1)'(1);
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
      is_outside_o     <= steps && is_outside && is_triangle;
      is_hiz_o         <= left_valid_q && left_q.is_visit && left_behind && left_is_free;  // a token's bound is undefined
      is_accepted_o    <= starts_visit && left_q.is_inside && left_is_triangle;
      samples_tested_o <= starts_visit && !left_q.is_inside && left_is_triangle ?
                          (2 * TS + 1 + SAMPLE_SHIFT)'(area) << SAMPLE_SHIFT : '0;
    end
  end

  assign visits_are_done_o = visits_are_done;

endmodule
