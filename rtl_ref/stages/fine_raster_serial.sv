// Fine raster for the smallest parts: the same bits as fine_raster.sv, one stamp position a cycle, stepped with two
// adders per edge: one to the right, and one that prepares the row below for the end of a row.
//
// From the tile's first pixel it steps right to the box's first column of stamps, then down to the first row; then it
// visits every stamp of the box, row by row. The row below is computed in the first column, for the next cycle: so a
// row of one stamp takes two cycles, and so does a row skipped on the way down. In the last row each covered stamp is
// held back until the next one is found, because the last of them ends the visit. The flag for a fully covered tile is
// not used: the edge tests give the same result at each stamp. tile_i and its edges are not stored: tile_ready_o comes
// with the last stamp. So a tile costs a cycle, one for each stamp of its box, and the steps to the first stamp.
// Specification: model/stages/fine_raster.hpp.
module fine_raster_serial (
    input logic clk_i,
    input logic rst_ni,

    // From coarse_raster
    input  logic                      tile_valid_i,
    output logic                      tile_ready_o,
    input  raster_pkg::tile_packet_t  tile_i,
    input  raster_pkg::edge_context_t edges_i,
    input  logic [3*raster_pkg::TILE_EDGE_BITS-1:0] visit_edges_i,  // edges at the start of a visit

    // To interpolate
    output logic                      stamp_valid_o,
    input  logic                      stamp_ready_i,
    output raster_pkg::stamp_packet_t stamp_o
);

  localparam int STAMP = raster_pkg::STAMP_SIZE;
  localparam int STAMP_SHIFT = $clog2(STAMP);
  localparam int PER_ROW = raster_pkg::STAMPS_PER_ROW;
  localparam int W = raster_pkg::SAMPLE_EDGE_BITS;
  localparam int STEP = raster_pkg::EDGE_STEP_BITS;
  localparam int TILE_EDGE = raster_pkg::TILE_EDGE_BITS;
  localparam int PIXEL = raster_pkg::TILE_PIXEL_BITS;
  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int COLUMN = PER_ROW > 1 ? $clog2(PER_ROW) : 1;

  // ------------------------------------------------------------------------------------------------------------- walk
  localparam logic [1:0] IDLE = 2'd0, RIGHT = 2'd1, DOWN = 2'd2, SCAN = 2'd3;
  (* fsm_encoding = "none" *) logic [1:0] state_q;  // RIGHT, DOWN: on the way to the first stamp of the box
  logic [COLUMN-1:0] column_q, row_q;  // position of the stamp whose edge values are held
  logic [COLUMN-1:0] first_column, last_column, first_row, last_row, next_column, next_row, column_after, row_after;
  logic              scans, is_first_column, is_end, starts, passes, is_way_down, moves, tile_leaves;
  logic              is_last_column_q, is_last_row_q;  // of the box; with the position, as the end of the tile comes late
  logic              has_below_q;  // below_q is the row below this one
  assign first_column   = COLUMN'(tile_i.box.left >> STAMP_SHIFT);
  assign last_column    = COLUMN'(tile_i.box.right >> STAMP_SHIFT);
  assign first_row      = COLUMN'(tile_i.box.top >> STAMP_SHIFT);
  assign last_row       = COLUMN'(tile_i.box.bottom >> STAMP_SHIFT);
  assign next_column    = column_q + COLUMN'(1);
  assign next_row       = row_q + COLUMN'(1);
  assign scans           = state_q == SCAN && (has_below_q || !is_last_column_q);
  assign is_first_column = column_q == first_column;
  assign is_end         = is_last_column_q && is_last_row_q;

  // Which way depends on the position only: whether the stamp is taken comes late.
  assign starts      = state_q == IDLE && tile_valid_i && tile_i.is_visit;
  assign is_way_down = state_q == DOWN || (state_q == SCAN && is_last_column_q);
  always_comb begin
    column_after = is_way_down ? first_column : next_column;
    row_after    = is_way_down ? next_row : row_q;
    if (starts) {column_after, row_after} = '0;
  end
  assign moves       = state_q == RIGHT || (state_q == DOWN && has_below_q) || passes;
  assign tile_leaves = tile_valid_i && tile_ready_o;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) state_q <= IDLE;
    else begin
      case (state_q)
        IDLE: if (starts) state_q <= first_column != '0 ? RIGHT : first_row != '0 ? DOWN : SCAN;
        RIGHT: if (next_column == first_column) state_q <= first_row != '0 ? DOWN : SCAN;
        DOWN: if (has_below_q && next_row == first_row) state_q <= SCAN;
        default: if (tile_leaves) state_q <= IDLE;
      endcase
    end
  end

  always_ff @(posedge clk_i) begin
    if (starts || moves) begin
      column_q         <= column_after;
      row_q            <= row_after;
      is_last_column_q <= column_after == last_column;
      is_last_row_q    <= row_after == last_row;
    end
    has_below_q <= !starts && !(moves && (is_way_down || state_q == RIGHT)) && (has_below_q || is_first_column);
  end

  logic [SAMPLES-1:0]   mask;
  logic [3*SAMPLES-1:0] outside;  // by edge
  genvar e, i, j;
  generate
    for (e = 0; e < 3; e++) begin : gen_edge
      logic signed [W-1:0] value_q, below_q;  // at the stamp's first sample; at that of the first stamp one row below
      logic signed [W-1:0] step_x, step_y, right;
      assign step_x = W'($signed(edges_i.step_x[e*STEP+:STEP]));
      assign step_y = W'($signed(edges_i.step_y[e*STEP+:STEP]));
      assign right  = value_q + (step_x <<< STAMP_SHIFT);
      always_ff @(posedge clk_i) begin
        if (starts) value_q <= W'($signed(visit_edges_i[e*TILE_EDGE+:TILE_EDGE]));
        else if (moves) value_q <= is_way_down ? below_q : right;
        if (is_first_column) below_q <= value_q + (step_y <<< STAMP_SHIFT);
      end

      for (j = 0; j < STAMP; j++) begin : gen_row
        for (i = 0; i < STAMP; i++) begin : gen_column
          logic signed [W-1:0] sample;
          edge_offset #(
              .WIDTH (W),
              .OFFSET(PIXEL)
          ) u_sample (
              .value_i (value_q),
              .step_x_i(step_x),
              .step_y_i(step_y),
              .x_i     (PIXEL'(i)),
              .y_i     (PIXEL'(j)),
              .value_o (sample)
          );
          assign outside[e*SAMPLES+j*STAMP+i] = sample[W-1];
        end
      end
    end

    for (j = 0; j < STAMP; j++) begin : gen_mask_row
      for (i = 0; i < STAMP; i++) begin : gen_mask_column
        localparam int AT = j * STAMP + i;
        logic is_sample_in_box;
        if (STAMP == 1) begin : gen_always
          assign is_sample_in_box = 1'b1;
        end else begin : gen_compare
          logic [PIXEL-1:0] x, y;
          assign x = PIXEL'(column_q) << STAMP_SHIFT | PIXEL'(i);
          assign y = PIXEL'(row_q) << STAMP_SHIFT | PIXEL'(j);
          assign is_sample_in_box = x >= tile_i.box.left && x <= tile_i.box.right && y >= tile_i.box.top && y <= tile_i.box.bottom;
        end
        assign mask[AT] = scans && is_sample_in_box &&
                          !(outside[AT] || outside[SAMPLES+AT] || outside[2*SAMPLES+AT]);
      end
    end
  endgenerate

  // ------------------------------------------------------------------------------------------------------------- send
  logic               held_valid_q;
  logic [COLUMN-1:0]  held_column_q, column;
  logic [SAMPLES-1:0] held_mask_q;
  logic               is_covered, sends_now, sends_held, sends_end, sends_token, uses_held;
  assign is_covered  = mask != '0;
  assign sends_now   = is_covered && !is_last_row_q;
  assign sends_held  = is_covered && is_last_row_q && held_valid_q;
  assign sends_end   = scans && is_end && !sends_held;
  assign sends_token = state_q == IDLE && !tile_i.is_visit;
  assign uses_held   = scans && held_valid_q && (sends_held || !is_covered);
  assign passes      = scans && !is_end && (stamp_ready_i || !(sends_now || sends_held));

  // The last stamp and the tile move in the same cycle, so that the visit is known before it can retire.
  assign stamp_valid_o = sends_now || sends_held || (tile_valid_i && (sends_end || sends_token));
  assign tile_ready_o  = stamp_ready_i && (sends_end || sends_token);

  always_ff @(posedge clk_i) begin
    if (starts || (sends_held && is_end && stamp_ready_i)) held_valid_q <= 1'b0;
    else if (passes && is_covered && is_last_row_q) begin
      held_valid_q  <= 1'b1;
      held_column_q <= column_q;
      held_mask_q   <= mask;
    end
  end

  assign column                 = uses_held ? held_column_q : is_covered ? column_q : '0;
  assign stamp_o.kind           = tile_i.kind;
  assign stamp_o.ends_visit     = sends_end;
  assign stamp_o.ends_primitive = (sends_end || sends_token) && tile_i.ends_primitive;
  assign stamp_o.key            = tile_i.key;
  assign stamp_o.slot           = tile_i.slot;
  assign stamp_o.mask           = uses_held ? held_mask_q : mask;
  assign stamp_o.anchor         = tile_i.anchor;

  generate
    if (PER_ROW == 1) begin : gen_one_stamp
      assign stamp_o.stamp = '0;
    end else begin : gen_stamps
      assign stamp_o.stamp = scans ? {row_q, column} : '0;
    end
  endgenerate

endmodule
