// Fine raster: one tile in, the covered samples of its stamps out.
//
// In: a tile packet and the primitive's edge context. Out: a stamp packet for each stamp with a covered sample, row by
// row; the last row sends one in any case, because it marks the end of the visit.
//
// Three parts: `rows` evaluates the edge functions of a whole row of stamps per cycle, stepping down the tile's box;
// `coverage` holds the covered samples of such a row, and drops an empty row; `stamps` sends the stamps of one row, one
// per cycle, while the next row is found. Three cycles from the tile to its first stamp, no bubble between rows or
// tiles. Nothing here multiplies. Specification: model/stages/fine_raster.hpp.
module fine_raster (
    input logic clk_i,
    input logic rst_ni,

    // From coarse_raster
    input  logic                      tile_valid_i,
    output logic                      tile_ready_o,
    input  raster_pkg::tile_packet_t  tile_i,
    input  raster_pkg::edge_context_t edges_i,
    input  logic [3*raster_pkg::TILE_EDGE_BITS-1:0] visit_edges_i,

    // To interpolate
    output logic                      stamp_valid_o,
    input  logic                      stamp_ready_i,
    output raster_pkg::stamp_packet_t stamp_o
);

  localparam int STAMP = raster_pkg::STAMP_SIZE;
  localparam int STAMP_SHIFT = $clog2(STAMP);
  localparam int TILE = raster_pkg::TILE_SIZE;
  localparam int PER_ROW = raster_pkg::STAMPS_PER_ROW;
  localparam int W = raster_pkg::SAMPLE_EDGE_BITS;
  localparam int STEP = raster_pkg::EDGE_STEP_BITS;
  localparam int TILE_EDGE = raster_pkg::TILE_EDGE_BITS;
  localparam int PIXEL = raster_pkg::TILE_PIXEL_BITS;
  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int N = raster_pkg::MSAA_SAMPLES;  // samples of a pixel
  localparam int PIXELS = raster_pkg::PIXELS;   // pixels of a stamp
  localparam int CENTRES = PER_ROW * PIXELS;
  localparam int S = raster_pkg::GRID_BITS;
  localparam int ROW = PER_ROW * SAMPLES;  // samples of a row of stamps; samples of one stamp are neighbours
  localparam int COLUMN = PER_ROW > 1 ? $clog2(PER_ROW) : 1;

  // -------------------------------------------------------------------------------------------------------------- rows
  raster_pkg::tile_packet_t  tile_q;
  raster_pkg::edge_context_t edges_q;
  logic             row_valid_q;
  logic [PIXEL-1:0] y_q;  // first pixel row of the current row of stamps

  logic             takes_tile, row_leaves, is_last_row, coverage_ready;
  logic [ROW-1:0]   covered;
  logic [3*ROW-1:0] outside;  // by edge
  logic [3*CENTRES-1:0] centres_outside;
  logic [CENTRES-1:0]   centre;  // pixels whose centres are covered
  logic [TILE-1:0]  column_in_box;
  logic [STAMP-1:0] row_in_box;
  logic [ROW-1:0]   in_box;
  logic [PIXEL-1:0] first_y;

  assign first_y      = (tile_i.box.top >> STAMP_SHIFT) << STAMP_SHIFT;
  assign is_last_row  = !tile_q.is_visit || (y_q >> STAMP_SHIFT) == (tile_q.box.bottom >> STAMP_SHIFT);
  assign covered      = in_box & ({ROW{tile_q.is_inside}} | ~(outside[0+:ROW] | outside[ROW+:ROW] | outside[2*ROW+:ROW]));
  assign row_leaves   = row_valid_q && coverage_ready;
  assign tile_ready_o = !row_valid_q || (coverage_ready && is_last_row);
  assign takes_tile   = tile_valid_i && tile_ready_o;

  logic clk;  // of this part
  clock_gate u_clock_gate (
      .clk_i,
      .reset_i (!rst_ni),
      .enable_i(takes_tile || row_leaves),
      .clk_o   (clk)
  );

  always_ff @(posedge clk or negedge rst_ni) begin
    if (!rst_ni) row_valid_q <= 1'b0;
    else if (tile_ready_o) row_valid_q <= tile_valid_i;
  end

  always_ff @(posedge clk) begin
    if (takes_tile) begin
      tile_q  <= tile_i;
      edges_q <= edges_i;
      y_q     <= first_y;
    end else if (row_leaves) y_q <= y_q + PIXEL'(STAMP);
  end

  localparam int PLACES = N == 1 ? 1 : N + 1;  // places of a pixel: its samples, then its centre
  genvar e, i, j, k;
  generate
    for (e = 0; e < 3; e++) begin : gen_edge
      logic signed [W-1:0] value_q;  // edge value at column 0 of the first pixel row of this row of stamps
      logic signed [W-1:0] step_x, step_y, start;

      assign step_x = W'($signed(edges_q.step_x[e*STEP+:STEP]));
      assign step_y = W'($signed(edges_q.step_y[e*STEP+:STEP]));

      // From the tile's first pixel to the box's first row of stamps.
      edge_offset #(
          .WIDTH (W),
          .OFFSET(PIXEL)
      ) u_start (
          .value_i (W'($signed(tile_i.edge_value[e*TILE_EDGE+:TILE_EDGE]))),
          .step_x_i('0),
          .step_y_i(W'($signed(edges_i.step_y[e*STEP+:STEP]))),
          .x_i     ('0),
          .y_i     (first_y),
          .value_o (start)
      );

      // Increment of the edge function from the pixel to each place.
      logic [PLACES*W-1:0] place_q;
      if (N == 1) begin : gen_one
        assign place_q = '0;
      end else begin : gen_places
        localparam int WIDE = STEP + S + 1;
        logic [N*WIDE-1:0] ways;
        sample_offsets #(
            .WIDTH(WIDE)
        ) u_ways (
            .value_i (WIDE'(edges_i.low[e*S+:S])),
            .step_x_i(WIDE'($signed(edges_i.step_x[e*STEP+:STEP]))),
            .step_y_i(WIDE'($signed(edges_i.step_y[e*STEP+:STEP]))),
            .value_o (ways)
        );
        assign place_q[N*W+:W] = '0;
        for (k = 0; k < N; k++) begin : gen_place
          logic signed [WIDE-1:0] gained;
          assign gained = $signed(ways[k*WIDE+:WIDE]) >>> S;
          logic signed [W-1:0] moved_q;
          always_ff @(posedge clk) if (takes_tile) moved_q <= W'(gained);
          assign place_q[k*W+:W] = moved_q;
        end
      end

      always_ff @(posedge clk) begin
        if (takes_tile) value_q <= start;
        else if (row_leaves) value_q <= value_q + (step_y <<< STAMP_SHIFT);
      end

      // From the first pixel of this row of stamps to the middle of each of its pixel rows: the search for an edge's
      // column begins there, one sum from `value_q`.
      localparam int REACH = STEP + PIXEL + 1;
      logic [STAMP*REACH-1:0] reach;
      for (j = 0; j < STAMP; j++) begin : gen_reach
        if (j == 0) begin : gen_first
          assign reach[j*REACH+:REACH] = REACH'(step_x) << (PIXEL - 1);
        end else begin : gen_further
          logic [REACH-1:0] reach_d, reach_q;
          edge_offset #(
              .WIDTH (REACH),
              .OFFSET(PIXEL)
          ) u_reach (
              .value_i (REACH'($signed(edges_i.step_x[e*STEP+:STEP])) << (PIXEL - 1)),
              .step_x_i('0),
              .step_y_i(REACH'($signed(edges_i.step_y[e*STEP+:STEP]))),
              .x_i     ('0),
              .y_i     (PIXEL'(j)),
              .value_o (reach_d)
          );
          always_ff @(posedge clk) if (takes_tile) reach_q <= reach_d;
          assign reach[j*REACH+:REACH] = reach_q;
        end
      end
      // At the centres of pixels, or at each of their samples and at the centres.
      for (k = 0; k < PLACES; k++) begin : gen_place
        logic signed [W-1:0] value;  // there, in the first pixel
        assign value = value_q + place_q[k*W+:W];
        for (j = 0; j < STAMP; j++) begin : gen_row
          logic signed [W-1:0] row_value, middle;
          logic [TILE-1:0]     outside_columns;
          edge_offset #(
              .WIDTH (W),
              .OFFSET(PIXEL)
          ) u_row (
              .value_i (value),
              .step_x_i('0),
              .step_y_i(step_y),
              .x_i     ('0),
              .y_i     (PIXEL'(j)),
              .value_o (row_value)
          );
          assign middle = value + W'($signed(reach[j*REACH+:REACH]));
          edge_columns #(
              .WIDTH (W),
              .OFFSET(PIXEL)
          ) u_columns (
              .value_i  (row_value),
              .middle_i (middle),
              .step_x_i (step_x),
              .outside_o(outside_columns)
          );
          for (i = 0; i < TILE; i++) begin : gen_column
            if (k < N) begin : gen_sample
              assign outside[e*ROW+(i/STAMP)*SAMPLES+(j*STAMP+i%STAMP)*N+k] = outside_columns[i];
            end else begin : gen_centre
              assign centres_outside[e*CENTRES+(i/STAMP)*PIXELS+j*STAMP+i%STAMP] = outside_columns[i];
            end
          end
        end
      end
    end

    // The box as masks of pixel columns and rows, and of samples in the order of `covered`.
    for (i = 0; i < TILE; i++) begin : gen_box_column
      assign column_in_box[i] = PIXEL'(i) >= tile_q.box.left && PIXEL'(i) <= tile_q.box.right;
    end
    for (j = 0; j < STAMP; j++) begin : gen_box_row
      assign row_in_box[j] = tile_q.is_visit && y_q + PIXEL'(j) >= tile_q.box.top && y_q + PIXEL'(j) <= tile_q.box.bottom;
      for (i = 0; i < TILE; i++) begin : gen_sample
        assign in_box[(i/STAMP)*SAMPLES+(j*STAMP+i%STAMP)*N+:N] = {N{column_in_box[i] && row_in_box[j]}};
        assign centre[(i/STAMP)*PIXELS+j*STAMP+i%STAMP] =
            column_in_box[i] && row_in_box[j] &&
            (tile_q.is_inside || !(centres_outside[(i/STAMP)*PIXELS+j*STAMP+i%STAMP] ||
                                   centres_outside[CENTRES+(i/STAMP)*PIXELS+j*STAMP+i%STAMP] ||
                                   centres_outside[2*CENTRES+(i/STAMP)*PIXELS+j*STAMP+i%STAMP]));
      end
    end
    if (N == 1) begin : gen_no_centres
      assign centres_outside = '0;
    end
  endgenerate

  // ---------------------------------------------------------------------------------------------------------- coverage
  raster_pkg::tile_packet_t coverage_tile_q;
  logic             coverage_valid_q;
  logic             coverage_last_row_q;
  logic [PIXEL-1:0] coverage_y_q;
  logic [ROW-1:0]   covered_q;
  logic             row_is_sent, stamps_ready;

  assign row_is_sent    = covered_q != '0 || coverage_last_row_q;  // the last row is sent in any case
  assign coverage_ready = !coverage_valid_q || stamps_ready || !row_is_sent;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) coverage_valid_q <= 1'b0;
    else if (coverage_ready) coverage_valid_q <= row_valid_q;
  end

  always_ff @(posedge clk_i) begin
    if (coverage_ready) begin
      coverage_tile_q     <= tile_q;
      coverage_last_row_q <= is_last_row;
      coverage_y_q        <= y_q;
      covered_q           <= covered;
    end
  end

  // ------------------------------------------------------------------------------------------------------------ stamps
  raster_pkg::tile_packet_t stamp_tile_q;
  logic             stamps_valid_q;
  logic             stamps_last_row_q;
  logic [PIXEL-1:0] stamps_y_q;
  logic [ROW-1:0]   pending_q, pending_d;  // samples of the row not yet sent

  logic [COLUMN-1:0]  column;  // of the first stamp with samples left
  logic [SAMPLES-1:0] mask;
  logic               stamp_leaves;

  always_comb begin
    column    = '0;
    mask      = '0;
    pending_d = pending_q;
    for (int s = PER_ROW - 1; s >= 0; s--) begin
      if (pending_q[s*SAMPLES+:SAMPLES] != '0) begin
        column = COLUMN'(s);
        mask   = pending_q[s*SAMPLES+:SAMPLES];
      end
    end
    for (int s = 0; s < PER_ROW; s++) if (COLUMN'(s) == column) pending_d[s*SAMPLES+:SAMPLES] = '0;
  end

  // At most one stamp has samples left: known a cycle ahead, because long paths start from it.
  function automatic logic is_one_stamp(input logic [ROW-1:0] samples);
    logic [PER_ROW-1:0] has_samples;
    is_one_stamp = 1'b1;
    for (int s = 0; s < PER_ROW; s++) has_samples[s] = samples[s*SAMPLES+:SAMPLES] != '0;
    for (int s = 1; s < PER_ROW; s++) if (has_samples[s] && (has_samples & PER_ROW'((1 << s) - 1)) != '0) is_one_stamp = 1'b0;
  endfunction
  logic is_last_stamp_q;
  assign stamp_valid_o = stamps_valid_q;
  assign stamp_leaves  = stamps_valid_q && stamp_ready_i;
  assign stamps_ready  = !stamps_valid_q || (stamp_ready_i && is_last_stamp_q);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) stamps_valid_q <= 1'b0;
    else if (stamps_ready) stamps_valid_q <= coverage_valid_q && row_is_sent;
  end

  always_ff @(posedge clk_i) begin
    if (stamps_ready) begin
      stamp_tile_q      <= coverage_tile_q;
      stamps_last_row_q <= coverage_last_row_q;
      stamps_y_q        <= coverage_y_q;
      pending_q         <= covered_q;
      is_last_stamp_q   <= is_one_stamp(covered_q);
    end else if (stamp_leaves) begin
      pending_q       <= pending_d;
      is_last_stamp_q <= is_one_stamp(pending_d);
    end
  end

  assign stamp_o.kind           = stamp_tile_q.kind;
  assign stamp_o.ends_visit     = stamps_last_row_q && is_last_stamp_q && stamp_tile_q.is_visit;
  assign stamp_o.ends_primitive = stamps_last_row_q && is_last_stamp_q && stamp_tile_q.ends_primitive;
  assign stamp_o.key            = stamp_tile_q.key;
  assign stamp_o.slot           = stamp_tile_q.slot;
  assign stamp_o.mask           = mask;
  // Next to the samples: the pixels of a row whose centres are covered.
  generate
    if (N > 1) begin : gen_centre
      logic [CENTRES-1:0] centre_q, stamps_centre_q;
      always_ff @(posedge clk_i) begin
        if (coverage_ready) centre_q <= centre;
        if (stamps_ready) stamps_centre_q <= centre_q;
      end
      logic [PIXELS-1:0] stamp_centre;
      always_comb begin
        stamp_centre = '0;
        for (int s = 0; s < PER_ROW; s++)
          if (mask != '0 && COLUMN'(s) == column) stamp_centre = stamps_centre_q[s*PIXELS+:PIXELS];
      end
      assign stamp_o.centre = stamp_centre;
    end
  endgenerate
  assign stamp_o.anchor         = stamp_tile_q.anchor;

  generate
    if (PER_ROW == 1) begin : gen_one_stamp
      assign stamp_o.stamp = '0;
    end else begin : gen_stamps
      assign stamp_o.stamp = stamp_tile_q.is_visit ? {stamps_y_q[PIXEL-1:STAMP_SHIFT], column} : '0;
    end
  endgenerate

endmodule
