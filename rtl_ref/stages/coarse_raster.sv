// Coarse raster: the tiles of a primitive's box, row by row, without those that it cannot change.
//
// In: a setup packet. Out: a tile packet for each tile that is neither outside an edge (trivial reject) nor behind the
// tile's HiZ bound; if the last tile of the box was skipped, a packet without a visit that tells the primitive's end.
// Two cycles from the setup packet to the first tile; then one tile per cycle, two for a tile whose HiZ bound is read.
//
// A primitive whose box touches at most 2x2 tiles reads no bounds. What a bound knows, and for whom it waits: hiz.sv.
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
  localparam int NARROW = raster_pkg::GUARD_BITS - raster_pkg::PLANE_LOCAL_GUARD_BITS;  // bits a local step loses

  localparam logic [2:0] IDLE = 3'd0, PREPARE = 3'd1, WALK = 3'd2, BOUND = 3'd3, END = 3'd4, CLEAR = 3'd5;
  logic [2:0] state_q;

  /* verilator lint_off UNUSEDSIGNAL */  // the values are in the registers below
  var raster_pkg::setup_packet_t s_q;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [TX-1:0]   tile_x_q;
  logic [TY-1:0]   tile_y_q;
  logic [SLOT-1:0] slot_q;   // of the primitive in s_q
  logic [SLOT:0]   used_q;   // slots that are not free

  logic is_triangle, is_fast_clear, has_walk, clears_bounds;
  logic takes, steps, is_last_column, is_last_tile, is_eligible, finishes;
  logic is_outside, is_inside, is_behind, is_settled, visits_are_done;
  assign is_triangle    = s_q.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE;
  assign is_fast_clear  = s_q.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR;
  assign has_walk       = !s_q.kind[1];  // bit 1 of a kind: a token (fast clear, flush, line)
  assign clears_bounds  = is_fast_clear && s_q.state.depth_write && raster_pkg::HIZ_BITS != 0;
  assign is_last_column = tile_x_q == s_q.box.right[PX-1:TS];
  assign is_last_tile   = is_last_column && tile_y_q == s_q.box.bottom[PY-1:TS];
  assign setup_ready_o  = (state_q == IDLE || finishes) && used_q != (SLOT + 1)'(SLOTS);
  assign takes          = setup_valid_i && setup_ready_o;
  assign context_slot_o = slot_q + SLOT'(state_q == IDLE ? 0 : 1);

  // --- The walk. A tile is left when it is skipped or taken by fine_raster.
  logic offers_visit, is_skipped, tile_taken;
  assign offers_visit = ((state_q == WALK && !is_outside && !is_eligible) || (state_q == BOUND && !is_behind)) && is_settled;
  assign is_skipped   = (state_q == WALK && is_outside) || (state_q == BOUND && is_behind);
  assign tile_valid_o = offers_visit || state_q == END;
  assign tile_taken   = tile_valid_o && tile_ready_i;
  assign steps        = is_skipped || (tile_taken && state_q != END);
  assign finishes     = tile_taken && (state_q == END || is_last_tile);

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
          if (has_walk) state_q <= WALK;
          else if (!clears_bounds) state_q <= END;
          else if (visits_are_done) state_q <= CLEAR;
          WALK:
          if (is_outside && is_last_tile) state_q <= END;
          else if (!is_outside && is_eligible && is_settled) state_q <= BOUND;
          BOUND:
          if (is_behind && is_last_tile) state_q <= END;
          else if (steps) state_q <= WALK;
          CLEAR: if (is_last_tile) state_q <= END;
          default: state_q <= state_q;
        endcase
      end
      used_q <= used_q + (SLOT + 1)'(takes) - (SLOT + 1)'(slot_free_i);
    end
  end

  logic clears;  // one tile's bound per cycle
  assign clears = state_q == CLEAR;

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
    end else if ((steps || clears) && !is_last_tile) begin
      tile_x_q <= is_last_column ? s_q.box.left[PX-1:TS] : tile_x_q + TX'(1);
      if (is_last_column) tile_y_q <= tile_y_q + TY'(1);
    end
  end

  // --- Edges: one value each at the tile's first pixel, and the offsets to its best and its worst corner.
  logic [2:0]      edge_is_outside, edge_is_inside;
  logic [3*TE-1:0] edge_value;
  genvar i;
  generate
    for (i = 0; i < 3; i++) begin : gen_edge
      logic signed [V-1:0]  value_q, row_q, next;
      logic signed [D-1:0]  dx, dy;
      logic signed [D:0]    best, worst;
      logic signed [TE-1:0] best_q, worst_q;
      logic signed [V:0]    largest, smallest;
      assign dx    = s_q.dx[i*D+:D];
      assign dy    = s_q.dy[i*D+:D];
      assign best  = (dx > 0 ? (D + 1)'(dx) : '0) - (dy < 0 ? (D + 1)'(dy) : '0);
      assign worst = (dx < 0 ? (D + 1)'(dx) : '0) - (dy > 0 ? (D + 1)'(dy) : '0);
      assign next  = is_last_column ? row_q + (V'(dx) <<< TS) : value_q - (V'(dy) <<< TS);

      always_ff @(posedge clk_i) begin
        if (takes) begin
          value_q <= setup_i.edge_value[i*V+:V];
          row_q   <= setup_i.edge_value[i*V+:V];
        end else if (steps && !is_last_tile) begin
          value_q <= next;
          if (is_last_column) row_q <= next;
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

  // --- Planes: the wide value at the tile's anchor; setup added what makes the local anchor its high bits. In the context
  // are steps per pixel, narrowed to the local guard bits.
  generate
    for (i = 0; i < PLANES; i++) begin : gen_plane
      localparam int P = PLANE_BITS_OF[32*i+:32];
      localparam int PLANE = PLANE_AT[32*i+:32];
      localparam int B = LOCAL_BITS_OF[32*i+:32];
      localparam int LOCAL = LOCAL_AT[32*i+:32];
      logic [P-1:0] value_q, row_q, next, value, step_x, step_y;
      assign value  = setup_i.value[PLANE+:P];
      assign step_x = setup_i.step_x[PLANE+:P];
      assign step_y = setup_i.step_y[PLANE+:P];
      assign next   = is_last_column ? row_q + (s_q.step_y[PLANE+:P] << (TS + S)) :
                                       value_q + (s_q.step_x[PLANE+:P] << (TS + S));
      always_ff @(posedge clk_i) begin
        if (takes) begin
          value_q <= value;
          row_q   <= value;
        end else if (steps && !is_last_tile) begin
          value_q <= next;
          if (is_last_column) row_q <= next;
        end
      end
      assign tile_o.anchor[LOCAL+:B]    = value_q[P-1-:B];
      assign context_o.step_x[LOCAL+:B] = B'($signed(step_x) >>> NARROW) + B'(step_x[NARROW-1]);
      assign context_o.step_y[LOCAL+:B] = B'($signed(step_y) >>> NARROW) + B'(step_y[NARROW-1]);
    end
  endgenerate
  assign context_o.state = setup_i.state;
  assign context_o.range = setup_i.range;

  // --- Visits under way, and what is known of the depths of a tile
  logic starts_visit;
  assign starts_visit = tile_taken && state_q != END;
  hiz u_hiz (
      .clk_i,
      .rst_ni,
      .setup_i          (s_q),
      .tile_x_i         (tile_x_q),
      .tile_y_i         (tile_y_q),
      .passes_i         (state_q == PREPARE),
      .reads_i          (state_q == WALK),
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
  var raster_pkg::tile_box_t box;
  assign box.left   = tile_x_q == s_q.box.left[PX-1:TS] ? s_q.box.left[TS-1:0] : '0;
  assign box.top    = tile_y_q == s_q.box.top[PY-1:TS] ? s_q.box.top[TS-1:0] : '0;
  assign box.right  = is_last_column ? s_q.box.right[TS-1:0] : '1;
  assign box.bottom = tile_y_q == s_q.box.bottom[PY-1:TS] ? s_q.box.bottom[TS-1:0] : '1;

  assign tile_o.kind           = s_q.kind;
  assign tile_o.is_visit       = state_q != END;
  assign tile_o.ends_primitive = is_last_tile;
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
  assign is_visited_o  = steps && is_triangle;
  assign is_outside_o  = state_q == WALK && is_outside && is_triangle;
  assign is_hiz_o      = state_q == BOUND && is_behind && is_triangle;
  assign is_accepted_o = starts_visit && is_inside && is_triangle;
  assign samples_tested_o = starts_visit && !is_inside && is_triangle ? area : '0;

  assign visits_are_done_o = visits_are_done;

endmodule
