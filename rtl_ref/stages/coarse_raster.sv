// Coarse raster: the tiles of a primitive's box, row by row, without those that it cannot change.
//
// In: a setup packet. Out: a tile packet for each tile that is neither outside an edge (trivial reject) nor behind the
// tile's HiZ bound; if the last tile of the walk was skipped, a packet without a visit that tells the primitive's end.
// Two cycles from the setup packet to the first tile; then one tile a cycle, two more for a visit where bounds are read.
//
// A row is walked to the right from its start, then from there to the left, each way until an edge has been left that gets
// no better that way. It starts below the first tile of the row above that was not outside.
//
// A primitive whose box touches at most 2x2 tiles reads no bounds. The bound of any other's next tile is read on the way to
// it, from PREPARE on, where the walk waits until it may be; a visit changes what bounds know, so behind each is a PREPARE.
// What a bound knows: hiz.sv.
// Specification: model/stages/coarse_raster.hpp, model/stages/hiz.hpp.
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
    input  logic                             slot_free_i,  // interpolate has read a slot for the last time

    // To fine_raster; edges_o is the context of the tile's primitive
    output logic                      tile_valid_o,
    input  logic                      tile_ready_i,
    output raster_pkg::tile_packet_t  tile_o,
    output raster_pkg::edge_context_t edges_o,

    // From depth_test: a tile visit has retired
    input logic                       retire_valid_i,
    input raster_pkg::retire_packet_t retire_i,

    // Counters: pulses for the tiles of triangles, and samples
    output logic                                 is_visited_o,
    output logic                                 is_outside_o,
    output logic                                 is_accepted_o,
    output logic                                 is_hiz_o,
    output logic [2*raster_pkg::TILE_SHIFT:0]    samples_tested_o,

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

  localparam logic [2:0] IDLE = 3'd0, PREPARE = 3'd1, WALK = 3'd2, OFFER = 3'd3, END = 3'd4, CLEAR = 3'd5;
  logic [2:0] state_q;

  /* verilator lint_off UNUSEDSIGNAL */  // the values are in the registers below
  raster_pkg::setup_packet_t s_q;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [TX-1:0]   tile_x_q;
  logic [TY-1:0]   tile_y_q;
  logic [SLOT-1:0] slot_q;   // of the primitive in s_q
  logic [SLOT:0]   used_q;   // slots that are not free

  logic is_triangle, is_fast_clear, has_walk, clears_bounds;
  logic takes, steps, is_last_column, is_last_row, is_last_tile, is_eligible, finishes;
  logic is_outside, is_inside, is_behind, is_settled, visits_are_done;
  assign is_triangle    = s_q.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE;
  assign is_fast_clear  = s_q.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR;
  assign has_walk       = !s_q.kind[1];  // bit 1 of a kind: a token (fast clear, flush, line, state)
  assign clears_bounds  = is_fast_clear && s_q.state.depth_write && raster_pkg::HIZ_BITS != 0;
  assign is_last_row    = tile_y_q == s_q.box.bottom[PY-1:TS];
  assign setup_ready_o  = (state_q == IDLE || finishes) && used_q != (SLOT + 1)'(SLOTS);
  assign takes          = setup_valid_i && setup_ready_o;
  assign context_slot_o = slot_q + SLOT'(state_q == IDLE ? 0 : 1);

  // --- The walk. A tile is left when it is skipped or taken by fine_raster.
  logic offers_visit, is_skipped, tile_taken;
  assign offers_visit = (state_q == WALK && !is_outside && !is_eligible && is_settled) || state_q == OFFER;
  assign is_skipped   = state_q == WALK && (is_outside || (is_eligible && is_behind));
  assign tile_valid_o = offers_visit || state_q == END;
  assign tile_taken   = tile_valid_o && tile_ready_i;
  assign steps        = is_skipped || (tile_taken && state_q != END);
  assign finishes     = tile_taken && (state_q == END || is_last_tile);

  // From a tile to the next one.
  logic [TX-1:0] start_x_q, next_x;  // start: of this row, then of the one below
  logic [TY-1:0] next_y;
  logic          goes_left_q;
  logic          must_return_q;  // there are tiles to the left of the start
  logic          is_empty_q;     // every tile of the row so far was outside
  logic          is_last_group, is_leftmost, is_rightmost, exits, must_return, turns_back, row_ends, moves_left, moves_start;
  logic          clears;     // the bounds of a group of tiles each cycle
  logic [TX-1:0] group_end;  // its last tile
  logic [2:0]    edge_is_outside, no_better_left, no_better_right;
  assign clears         = state_q == CLEAR;
  assign is_leftmost    = tile_x_q == s_q.box.left[PX-1:TS];
  assign is_rightmost   = tile_x_q == s_q.box.right[PX-1:TS];
  assign is_last_group  = (tile_x_q ^ s_q.box.right[PX-1:TS]) >> raster_pkg::HIZ_GROUP_BITS == '0;
  assign group_end      = tile_x_q | TX'((1 << raster_pkg::HIZ_GROUP_BITS) - 1);
  assign is_last_column = goes_left_q ? is_leftmost : (clears ? is_last_group : is_rightmost);
  assign is_last_tile   = is_last_column && !must_return_q && is_last_row;
  assign must_return    = must_return_q && (edge_is_outside & no_better_left) == '0;
  assign exits          = is_last_column || (edge_is_outside & (goes_left_q ? no_better_left : no_better_right)) != '0;
  assign turns_back     = exits && must_return;
  assign row_ends       = exits && !must_return;
  assign moves_left     = goes_left_q || turns_back;
  assign moves_start    = is_empty_q && is_outside;  // or all of it, down
  assign next_x         = exits ? start_x_q - TX'(turns_back) : goes_left_q ? tile_x_q - TX'(1) : (clears ? group_end : tile_x_q) + TX'(1);
  assign next_y         = tile_y_q + TY'(row_ends);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q <= IDLE;
      slot_q  <= '0;
      used_q  <= '0;
    end else begin
      if (finishes) begin
        state_q <= takes ? PREPARE : IDLE;
        slot_q  <= slot_q + SLOT'(1);
      end else begin
        case (state_q)
          IDLE: if (takes) state_q <= PREPARE;
          PREPARE:
          if (has_walk) state_q <= is_eligible && !is_settled ? PREPARE : WALK;
          else if (!clears_bounds) state_q <= END;
          else if (visits_are_done) state_q <= CLEAR;
          WALK:
          if (is_skipped) state_q <= row_ends && is_last_row ? END : WALK;
          else if (is_eligible) state_q <= OFFER;
          OFFER: if (tile_taken) state_q <= PREPARE;
          CLEAR: if (is_last_tile) state_q <= END;
          default: state_q <= state_q;
        endcase
      end
      used_q <= used_q + (SLOT + 1)'(takes) - (SLOT + 1)'(slot_free_i);
    end
  end

  logic goes_on;
  assign goes_on = (steps || clears) && !(row_ends && is_last_row);

  always_ff @(posedge clk_i) begin
    if (takes) begin
      s_q <= setup_i;
      if (setup_i.kind[1] && setup_i.kind != raster_pkg::PRIMITIVE_KIND_FAST_CLEAR) begin
        tile_x_q <= setup_i.box.right[PX-1:TS];
        tile_y_q <= setup_i.box.bottom[PY-1:TS];
      end else begin
        tile_x_q <= setup_i.box.left[PX-1:TS];
        tile_y_q <= setup_i.box.top[PY-1:TS];
      end
    end else if (state_q == PREPARE && !has_walk && !clears_bounds) begin
      tile_x_q <= s_q.box.right[PX-1:TS];  // nothing to clear here
      tile_y_q <= s_q.box.bottom[PY-1:TS];
    end else if (goes_on) begin
      tile_x_q <= next_x;
      tile_y_q <= next_y;
    end else if (clears) begin
      tile_x_q <= s_q.box.right[PX-1:TS];  // from its group to the last tile itself
    end
    if (takes) begin
      start_x_q     <= setup_i.box.left[PX-1:TS];
      goes_left_q   <= 1'b0;
      must_return_q <= 1'b0;
      is_empty_q    <= 1'b1;
    end else if (goes_on) begin
      if (moves_start) start_x_q <= next_x;
      goes_left_q   <= moves_left && !row_ends;
      must_return_q <= row_ends ? start_x_q != s_q.box.left[PX-1:TS] : must_return && !turns_back;
      is_empty_q    <= row_ends || moves_start;
    end
  end

  // --- Edges: one value each at the tile's first pixel, and the offsets to its best and its worst corner.
  logic [2:0]      edge_is_inside;
  logic [3*TE-1:0] edge_value;
  genvar i;
  generate
    for (i = 0; i < 3; i++) begin : gen_edge
      logic signed [V-1:0]  value_q, row_q, from, next;  // row: at the row's start
      logic [V-TS-1:0]      step;
      /* verilator lint_off UNUSEDSIGNAL */  // the carry's own bit
      logic [V-TS:0]        sum;
      /* verilator lint_on UNUSEDSIGNAL */
      logic signed [D-1:0]  dx, dy;
      logic signed [D:0]    best, worst;
      logic signed [TE-1:0] best_q, worst_q;
      logic signed [V:0]    largest, smallest;
      assign dx    = s_q.dx[i*D+:D];
      assign dy    = s_q.dy[i*D+:D];
      assign best  = (dx > 0 ? (D + 1)'(dx) : '0) - (dy < 0 ? (D + 1)'(dy) : '0);
      assign worst = (dx < 0 ? (D + 1)'(dx) : '0) - (dy > 0 ? (D + 1)'(dy) : '0);
      assign from  = exits ? row_q : value_q;
      assign step  = row_ends ? (V - TS)'(dx) : (V - TS)'(dy) ^ {(V - TS) {!moves_left}};
      assign sum   = {from[V-1:TS], 1'b1} + {step, !row_ends && !moves_left};
      assign next  = {sum[V-TS:1], from[TS-1:0]};
      assign no_better_left[i]  = !(dy > 0);
      assign no_better_right[i] = !dy[D-1];

      always_ff @(posedge clk_i) begin
        if (takes) begin
          value_q <= setup_i.edge_value[i*V+:V];
          row_q   <= setup_i.edge_value[i*V+:V];
        end else if (goes_on) begin
          value_q <= next;
          if (row_ends || moves_start) row_q <= next;
        end
        if (state_q == PREPARE) begin  // times T - 1
          best_q  <= (TE'(best) <<< TS) - TE'(best);
          worst_q <= (TE'(worst) <<< TS) - TE'(worst);
        end
      end

      assign largest            = (V + 1)'(value_q) + (V + 1)'(best_q);
      assign smallest           = (V + 1)'(value_q) + (V + 1)'(worst_q);
      assign edge_is_outside[i] = largest < 0;
      assign edge_is_inside[i]  = smallest >= 0;

      if (V > TE) begin : gen_saturate
        logic fits;
        assign fits = value_q[V-1:TE-1] == {(V - TE + 1) {value_q[V-1]}};
        assign edge_value[i*TE+:TE] = fits ? value_q[TE-1:0] : {value_q[V-1], {(TE - 1) {~value_q[V-1]}}};
      end else begin : gen_extend
        assign edge_value[i*TE+:TE] = TE'(value_q);
      end
    end
  endgenerate
  assign is_outside = edge_is_outside != '0;
  assign is_inside  = edge_is_inside == '1;

  // --- Planes: the wide value at the tile's anchor, but for the bits that no step changes; setup added what makes the local
  // anchor its high bits. In the context are steps per pixel, narrowed to the local guard bits.
  generate
    for (i = 0; i < PLANES; i++) begin : gen_plane
      localparam int P = PLANE_BITS_OF[32*i+:32];
      localparam int PLANE = PLANE_AT[32*i+:32];
      localparam int B = LOCAL_BITS_OF[32*i+:32];
      localparam int LOCAL = LOCAL_AT[32*i+:32];
      localparam int M = P - TS - S;  // a tile's step leaves the bits below as they are
      localparam int NARROW = P - B - S;  // bits that a local step loses
      /* verilator lint_off UNUSEDSIGNAL */  // those bits
      logic [P-1:0] value;
      /* verilator lint_on UNUSEDSIGNAL */
      logic [P-1:0] step_x, step_y;
      logic [M-1:0] value_q, row_q, from, step;
      /* verilator lint_off UNUSEDSIGNAL */  // the carry's own bit
      logic [M:0]   sum;
      /* verilator lint_on UNUSEDSIGNAL */
      assign value  = setup_i.value[PLANE+:P];
      assign step_x = setup_i.step_x[PLANE+:P];
      assign step_y = setup_i.step_y[PLANE+:P];
      assign from   = exits ? row_q : value_q;
      assign step   = row_ends ? s_q.step_y[PLANE+:M] : s_q.step_x[PLANE+:M] ^ {M{moves_left}};
      assign sum    = {from, 1'b1} + {step, !row_ends && moves_left};
      always_ff @(posedge clk_i) begin
        if (takes) begin
          value_q <= value[P-1-:M];
          row_q   <= value[P-1-:M];
        end else if (goes_on) begin
          value_q <= sum[M:1];
          if (row_ends || moves_start) row_q <= sum[M:1];
        end
      end
      assign tile_o.anchor[LOCAL+:B]    = value_q[M-1-:B];
      assign context_o.step_x[LOCAL+:B] = B'($signed(step_x) >>> NARROW) + B'(step_x[NARROW-1]);
      assign context_o.step_y[LOCAL+:B] = B'($signed(step_y) >>> NARROW) + B'(step_y[NARROW-1]);
    end
  endgenerate
  assign context_o.state = setup_i.state;
  assign context_o.range = setup_i.range;
  generate
    if (raster_pkg::COORDINATES != 0) begin : gen_coordinates
      assign context_o.coordinates = setup_i.coordinates;
    end
  endgenerate

  // --- Visits under way, and what is known of the depths of a tile
  logic          starts_visit, reads_bound;
  logic [TX-1:0] read_x;
  logic [TY-1:0] read_y;
  assign starts_visit = tile_taken && state_q != END;
  assign reads_bound  = state_q == PREPARE || is_skipped;
  assign read_x       = state_q == PREPARE ? tile_x_q : next_x;
  assign read_y       = state_q == PREPARE ? tile_y_q : next_y;
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
      .is_eligible_o    (is_eligible),
      .is_settled_o     (is_settled),
      .is_behind_o      (is_behind),
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

  assign tile_o.kind           = s_q.kind;
  assign tile_o.is_visit       = state_q != END;
  assign tile_o.ends_primitive = state_q == END || is_last_tile;
  assign tile_o.slot           = slot_q;
  assign tile_o.box            = box;
  assign tile_o.is_inside      = is_inside && state_q != END;
  assign tile_o.edge_value     = edge_value;

  assign tile_o.key.primitive_id = s_q.primitive_id;
  assign tile_o.key.tile_x       = tile_x_q;
  assign tile_o.key.tile_y       = tile_y_q;

  logic [3*D-1:0] step_x;
  generate
    for (i = 0; i < 3; i++) begin : gen_step
      assign step_x[i*D+:D] = -s_q.dy[i*D+:D];
    end
  endgenerate
  assign edges_o.step_x = step_x;
  assign edges_o.step_y = s_q.dx;

  // --- Counters
  logic [TS:0]     width, height;
  logic [2*TS:0]   area;
  assign width       = (TS + 1)'(box.right) - (TS + 1)'(box.left) + (TS + 1)'(1);
  assign height      = (TS + 1)'(box.bottom) - (TS + 1)'(box.top) + (TS + 1)'(1);
  always_comb begin  // no multiplier for a counter
    area = '0;
    for (int b = 0; b <= TS; b++) area = area + (height[b] ? (2 * TS + 1)'(width) << b : '0);
  end
  // One cycle late: what takes a tile comes late enough without the counters behind it.
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      is_visited_o     <= 1'b0;
      is_outside_o     <= 1'b0;
      is_hiz_o         <= 1'b0;
      is_accepted_o    <= 1'b0;
      samples_tested_o <= '0;
    end else begin
      is_visited_o     <= steps && is_triangle;
      is_outside_o     <= state_q == WALK && is_outside && is_triangle;
      is_hiz_o         <= state_q == WALK && !is_outside && is_eligible && is_behind && is_triangle;
      is_accepted_o    <= starts_visit && is_inside && is_triangle;
      samples_tested_o <= starts_visit && !is_inside && is_triangle ? area : '0;
    end
  end

  assign visits_are_done_o = visits_are_done;

endmodule
