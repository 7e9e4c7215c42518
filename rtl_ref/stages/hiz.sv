// HiZ: a bound on the depths of each tile, by which coarse_raster drops tiles that cannot pass the depth test; and the
// visits under way, whose numbers say which updates a bound includes.
//
// Visit n sees the updates of all visits up to n - LAG and of no later one, whatever the timing: an update waits in a
// queue until LAG later visits have started. So the only wait is for visit n - LAG, and at most LAG visits are under
// way. Visits in flight that may raise a depth make the bounds unusable until they are seen. A bound is read in one
// cycle and valid from the next cycle to the next read, next to the limit of the primitive: the tile is behind where
// the bound is below the limit, as long as no visit starts. The primitive is present a cycle before. Specification:
// model/stages/hiz.hpp.
module hiz (
    input logic clk_i,
    input logic rst_ni,

    // The primitive of coarse_raster, and its current tile
    input raster_pkg::setup_packet_t          setup_i,
    input logic [raster_pkg::TILE_X_BITS-1:0] tile_x_i,
    input logic [raster_pkg::TILE_Y_BITS-1:0] tile_y_i,
    input logic                               passes_i,  // the primitive has just come
    input logic                               clears_i,  // the bounds of the tile's group; no visit is under way
    input logic                               reads_i,   // the bound of this tile:
    input logic [raster_pkg::TILE_X_BITS-1:0] read_x_i,
    input logic [raster_pkg::TILE_Y_BITS-1:0] read_y_i,
    input logic                               starts_visit_i,
    input logic                               raises_i,  // the visit may raise a depth by its state

    output logic is_eligible_o,    // bounds may reject its tiles
    output logic is_settled_o,     // visit n - LAG has been seen: a bound may be read, a visit may start
    output logic [raster_pkg::HIZ_CODE_BITS-1:0] bound_o,  // the bound that was read
    output logic [raster_pkg::HIZ_CODE_BITS:0]   limit_o,  // the least bound that is not behind; 0: no tile is behind
    output logic visits_are_done_o,

    // From depth_test: a tile visit has retired
    input logic                       retire_valid_i,
    input raster_pkg::retire_packet_t retire_i
);

  localparam int TX = raster_pkg::TILE_X_BITS;
  localparam int TY = raster_pkg::TILE_Y_BITS;
  localparam int TS = raster_pkg::TILE_SHIFT;
  localparam int PX = raster_pkg::PIXEL_X_BITS;
  localparam int PY = raster_pkg::PIXEL_Y_BITS;
  localparam int Z = raster_pkg::DEPTH_CODE_BITS;
  localparam int HIZ = raster_pkg::HIZ_BITS == 0 ? 0 : raster_pkg::HIZ_CODE_BITS;
  localparam int LAG = raster_pkg::HIZ_LAG;
  localparam int GROUP = raster_pkg::HIZ_GROUP_BITS;  // adjacent tiles that are cleared at once: 2^GROUP
  localparam int N = $clog2(LAG);  // bits of a place in the queue

  // Visits that have started, retired and been seen, since reset or the last clear of the bounds, modulo 2 LAG.
  logic [N:0] started_q, retired_q, seen_q, seen_next, full;
  logic       has_update_q;  // the oldest retired visit that has not been seen is available
  logic       sees;
  assign full              = seen_q + (N + 1)'(LAG);  // LAG visits have not been seen
  assign is_settled_o      = started_q != full;
  assign visits_are_done_o = started_q == retired_q;
  assign sees = has_update_q && (!is_settled_o || (starts_visit_i && started_q + (N + 1)'(1) == full));
  // A clear comes after all of them in program order: their updates are dropped.
  assign seen_next = clears_i ? started_q : seen_q + (N + 1)'(sees);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      started_q    <= '0;
      retired_q    <= '0;
      seen_q       <= '0;
      has_update_q <= 1'b0;
    end else begin
      started_q    <= started_q + (N + 1)'(starts_visit_i);
      retired_q    <= retired_q + (N + 1)'(retire_valid_i);
      seen_q       <= seen_next;
      has_update_q <= retired_q != seen_next;
    end
  end

  generate
    if (HIZ > 0) begin : gen_hiz
      logic can_raise, is_triangle, is_wide, is_high;
      logic marks_failed;  // a failed test shows in the stencil
      if (raster_pkg::STENCIL_BITS != 0) begin : gen_stencil
        assign marks_failed = setup_i.state.marks_failed;
      end else begin : gen_no_stencil
        assign marks_failed = 1'b0;
      end
      assign can_raise   = setup_i.state.depth_test[2];  // the functions that let a farther sample pass
      assign is_triangle = setup_i.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE;
      assign is_wide     = setup_i.box.right[PX-1:TS] - setup_i.box.left[PX-1:TS] > TX'(1);
      assign is_high     = setup_i.box.bottom[PY-1:TS] - setup_i.box.top[PY-1:TS] > TY'(1);

      logic         bounds_hold_q;  // no line can have raised a depth since the last fast clear
      logic [N-1:0] quiet_q;        // visits since one that may raise a depth, LAG - 1 at most
      assign is_eligible_o = bounds_hold_q && is_triangle && (is_wide || is_high) && !marks_failed &&
                             setup_i.state.depth_test != raster_pkg::DEPTH_FUNC_NEVER && !can_raise;

      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          bounds_hold_q <= 1'b1;
          quiet_q       <= '1;
        end else begin
          if (passes_i && setup_i.state.depth_write) begin
            if (setup_i.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR) bounds_hold_q <= 1'b1;
            if (raster_pkg::LINES_UNIT != 0 && setup_i.kind == raster_pkg::PRIMITIVE_KIND_LINE && can_raise) bounds_hold_q <= 1'b0;
          end
          if (clears_i) quiet_q <= '1;
          else if (starts_visit_i) quiet_q <= raises_i ? '0 : quiet_q + N'(quiet_q != '1);
        end
      end

      // Updates of retired visits, in order.
      localparam int UPDATE = TY + TX + HIZ + 1;
      logic           has_news;
      logic [TY-1:0]  update_y;
      logic [TX-1:0]  update_x;
      logic [HIZ-1:0] update_code;
      sram #(
          .WIDTH    (UPDATE),
          .DEPTH    (LAG),
          .READS_OLD(0),  // a read item was written in an earlier cycle
          .BLOCK    (raster_pkg::SETUP_KIND != 0)
      ) u_updates (
          .clk_i,
          .read_i         (1'b1),
          .read_address_i (seen_next[N-1:0]),
          .data_o         ({update_y, update_x, update_code, has_news}),
          .write_i        (retire_valid_i),
          .write_address_i(retired_q[N-1:0]),
          .data_i         ({retire_i.key.tile_y, retire_i.key.tile_x, retire_i.hiz_code,
                            retire_i.update != raster_pkg::HIZ_UPDATE_NONE})
      );

      // A word is a group of a row of tiles. Rows follow each other without the groups beyond the target where that halves
      // the RAM.
      localparam int ROW = (raster_pkg::TILES_X + (1 << GROUP) - 1) >> GROUP;
      localparam int BEYOND = (1 << (TX - GROUP)) - ROW;
      localparam int GAP = $clog2(raster_pkg::TILES_Y * ROW) < $clog2(raster_pkg::TILES_Y * (ROW + BEYOND)) ? BEYOND : 0;
      localparam int WORDS = raster_pkg::TILES_Y * (ROW + BEYOND - GAP);
      localparam int WORD = WORDS == 1 ? 1 : $clog2(WORDS);
      function automatic [WORD-1:0] word_of(input [TY-1:0] y, input [TX-1:0] x);
        word_of = WORD'({y, x} >> GROUP);
        for (int b = 0; b < TX; b++) if (GAP[b]) word_of = word_of - WORD'({{TX{1'b0}}, y} << b);
      endfunction
      // An upper bound of the depth codes of each tile, its high bits stored, all others taken as ones.
      logic [Z-1:0]   depth_min;
      logic [HIZ-1:0] bound;
      logic [HIZ:0]   limit_q;
      assign depth_min = setup_i.range.low[0+:Z];
      logic [(HIZ<<GROUP)-1:0] bounds;  // of the tiles of a group, each in a RAM of its own
      logic [GROUP-1:0]        read_q;  // tile of the group that was read
      always_ff @(posedge clk_i) if (reads_i) read_q <= read_x_i[GROUP-1:0];
      always_comb begin
        bound = bounds[0+:HIZ];
        for (int i = 1; i < 1 << GROUP; i++) if (read_q == GROUP'(i)) bound = bounds[HIZ*i+:HIZ];
      end
      logic [WORD-1:0]         write_word;
      assign write_word = clears_i ? word_of(tile_y_i, tile_x_i) : word_of(update_y, update_x);

      genvar t;
      for (t = 0; t < 1 << GROUP; t++) begin : gen_tile
        sram #(
            .WIDTH    (HIZ),
            .DEPTH    (WORDS == 1 ? 2 : WORDS),
            .READS_OLD(0)  // a bound read during a write is not used
        ) u_bound (
            .clk_i,
            .read_i         (reads_i),
            .read_address_i (word_of(read_y_i, read_x_i)),
            .data_o         (bounds[HIZ*t+:HIZ]),
            .write_i        (clears_i || (sees && has_news && update_x[GROUP-1:0] == GROUP'(t))),
            .write_address_i(write_word),
            .data_i         (clears_i ? depth_min[Z-1-:HIZ] : update_code)
        );
      end

      // Behind: depth_min > bound, or equal for `less`; all bits are compared, and those not stored are ones.
      logic is_equal_behind;
      if (HIZ == Z) begin : gen_exact
        assign is_equal_behind = setup_i.state.depth_test == raster_pkg::DEPTH_FUNC_LESS;
      end else begin : gen_high_bits
        assign is_equal_behind = setup_i.state.depth_test == raster_pkg::DEPTH_FUNC_LESS && depth_min[Z-HIZ-1:0] == '1;
      end
      always_ff @(posedge clk_i) limit_q <= (HIZ + 1)'(depth_min[Z-1-:HIZ]) + (HIZ + 1)'(is_equal_behind);
      assign bound_o = bound;
      assign limit_o = quiet_q == '1 ? limit_q : '0;
    end else begin : gen_no_hiz
      assign is_eligible_o = 1'b0;
      assign bound_o       = '0;
      assign limit_o       = '0;
    end
  endgenerate

endmodule
