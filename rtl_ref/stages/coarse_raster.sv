// Coarse raster: the tiles of a primitive's box, row by row, without those that it cannot change.
//
// In: a setup packet. Out: a tile packet for each tile that is neither outside an edge (trivial reject) nor behind the
// tile's HiZ bound; if the last tile of the box was skipped, a packet without a visit that tells the primitive's end.
// Two cycles from the setup packet to the first tile; then one tile per cycle, two for a tile whose HiZ bound is read.
//
// HiZ has program order: a primitive that reads bounds waits at a tile until every earlier visit of it has retired.
// One whose box touches at most 2x2 tiles neither reads nor waits.
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
    /* verilator lint_off UNUSEDSIGNAL */  // without HiZ only its coming counts
    input raster_pkg::retire_packet_t retire_i,
    /* verilator lint_on UNUSEDSIGNAL */

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
  localparam int Z = raster_pkg::DEPTH_CODE_BITS;
  localparam int HIZ = raster_pkg::HIZ_BITS == 0 ? 0 : raster_pkg::HIZ_CODE_BITS;
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
  logic is_outside, is_inside, is_behind, conflicts, visit_is_full, visits_are_done;
  assign is_triangle    = s_q.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE;
  assign is_fast_clear  = s_q.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR;
  assign has_walk       = !s_q.kind[1];  // bit 1 of a kind: a token (fast clear, flush, line)
  assign clears_bounds  = is_fast_clear && s_q.state.depth_write && HIZ != 0;
  assign is_last_column = tile_x_q == s_q.box.right[PX-1:TS];
  assign is_last_tile   = is_last_column && tile_y_q == s_q.box.bottom[PY-1:TS];
  assign setup_ready_o  = (state_q == IDLE || finishes) && used_q != (SLOT + 1)'(SLOTS);
  assign takes          = setup_valid_i && setup_ready_o;
  assign context_slot_o = slot_q + SLOT'(state_q == IDLE ? 0 : 1);

  // --- The walk. A tile is left when it is skipped or taken by fine_raster.
  logic offers_visit, is_skipped, tile_taken;
  assign offers_visit = ((state_q == WALK && !is_outside && !is_eligible) || (state_q == BOUND && !is_behind)) && !visit_is_full;
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
          else if (!is_outside && is_eligible && !conflicts) state_q <= BOUND;
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
    end else if (state_q == PREPARE && !has_walk && (!s_q.state.depth_write || HIZ == 0)) begin
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

  // --- Visits under way, oldest first: their tiles, for the wait, in a ring.
  localparam int VISITS = 8;
  localparam int VISIT = $clog2(VISITS);
  logic [VISITS-1:0]           visit_valid_q, visit_conflicts;
  /* verilator lint_off UNUSEDSIGNAL */  // without HiZ
  logic [VISITS*(TX+TY)-1:0]   visit_tile_q;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [VISIT-1:0]            newest_q, oldest_q;
  logic                        starts_visit;
  assign starts_visit    = tile_taken && state_q != END;
  assign visit_is_full   = visit_valid_q[newest_q];
  assign visits_are_done = visit_valid_q == '0;
  assign conflicts       = visit_conflicts != '0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      visit_valid_q <= '0;
      newest_q      <= '0;
      oldest_q      <= '0;
    end else begin
      if (starts_visit) begin
        visit_valid_q[newest_q] <= 1'b1;
        newest_q                <= newest_q + VISIT'(1);
      end
      if (retire_valid_i) begin
        visit_valid_q[oldest_q] <= 1'b0;
        oldest_q                <= oldest_q + VISIT'(1);
      end
    end
  end

  generate
    for (i = 0; i < VISITS; i++) begin : gen_visit
      if (HIZ > 0) begin : gen_tile
        always_ff @(posedge clk_i) begin
          if (starts_visit && newest_q == VISIT'(i)) visit_tile_q[i*(TX+TY)+:TX+TY] <= {tile_y_q, tile_x_q};
        end
        assign visit_conflicts[i] = visit_valid_q[i] && visit_tile_q[i*(TX+TY)+:TX+TY] == {tile_y_q, tile_x_q};
      end else begin : gen_no_tile
        assign visit_tile_q[i*(TX+TY)+:TX+TY] = '0;
        assign visit_conflicts[i] = 1'b0;
      end
    end

    // --- HiZ: an upper bound of the depth codes of each tile, its high bits stored, all others taken as ones.
    if (HIZ > 0) begin : gen_hiz
      logic [Z-1:0]   depth_min;
      logic [HIZ-1:0] bound;
      logic           is_wide, is_high, can_raise, writes;
      logic           bounds_hold_q;  // no line can have raised a depth since the last fast clear
      assign depth_min   = s_q.range.low[0+:Z];
      /* verilator lint_off CMPCONST */  // a small target has no such box
      assign is_wide     = s_q.box.right[PX-1:TS] - s_q.box.left[PX-1:TS] > TX'(1);
      assign is_high     = s_q.box.bottom[PY-1:TS] - s_q.box.top[PY-1:TS] > TY'(1);
      /* verilator lint_on CMPCONST */
      assign can_raise   = s_q.state.depth_test[2];  // the functions that let a farther sample pass
      assign is_eligible = bounds_hold_q && is_triangle && (is_wide || is_high) &&
                           s_q.state.depth_test != raster_pkg::DEPTH_FUNC_NEVER && !can_raise;
      assign writes      = clears || (retire_valid_i && retire_i.update != raster_pkg::HIZ_UPDATE_NONE);

      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) bounds_hold_q <= 1'b1;
        else if (state_q == PREPARE && s_q.state.depth_write) begin
          if (is_fast_clear) bounds_hold_q <= 1'b1;
          if (raster_pkg::LINES_UNIT != 0 && s_q.kind == raster_pkg::PRIMITIVE_KIND_LINE && can_raise) bounds_hold_q <= 1'b0;
        end
      end

      sram #(
          .WIDTH(HIZ),
          .DEPTH(raster_pkg::TILES_Y << TX)
      ) u_bound (
          .clk_i,
          .read_i         (state_q == WALK),
          .read_address_i ({tile_y_q, tile_x_q}),
          .data_o         (bound),
          .write_i        (writes),
          .write_address_i(clears ? {tile_y_q, tile_x_q} : {retire_i.key.tile_y, retire_i.key.tile_x}),
          .data_i         (clears ? depth_min[Z-1-:HIZ] : retire_i.hiz_code)
      );

      // Behind: depth_min > bound; for `less` equality will do.
      logic is_equal;
      if (HIZ == Z) begin : gen_exact
        assign is_equal = depth_min == bound;
      end else begin : gen_high_bits
        assign is_equal = depth_min[Z-1-:HIZ] == bound && depth_min[Z-HIZ-1:0] == '1;
      end
      assign is_behind = depth_min[Z-1-:HIZ] > bound || (s_q.state.depth_test == raster_pkg::DEPTH_FUNC_LESS && is_equal);
    end else begin : gen_no_hiz
      assign is_eligible = 1'b0;
      assign is_behind   = 1'b0;
    end
  endgenerate

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
