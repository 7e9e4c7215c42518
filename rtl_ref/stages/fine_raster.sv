// Fine raster: one tile in, the covered samples of its stamps out.
//
// In: a tile packet and the triangle's edge context. Out: a stamp packet for each stamp with at least one covered sample,
// row by row. One stamp position of the tile's box per cycle; two cycles from the tile to its first stamp, no bubble
// between tiles. The edge values are stepped from stamp to stamp; nothing here multiplies.
// Specification: model/stages/fine_raster.hpp.
module fine_raster (
    input logic clk_i,
    input logic rst_ni,

    // From coarse_raster; edges_i is the context of tile_i.slot
    input  logic                      tile_valid_i,
    output logic                      tile_ready_o,
    input  raster_pkg::tile_packet_t  tile_i,
    input  raster_pkg::edge_context_t edges_i,

    // To interpolate
    output logic                      stamp_valid_o,
    input  logic                      stamp_ready_i,
    output raster_pkg::stamp_packet_t stamp_o
);

  localparam int STAMP = raster_pkg::STAMP_SIZE;
  localparam int STAMP_SHIFT = $clog2(STAMP);
  localparam int W = raster_pkg::SAMPLE_EDGE_BITS;
  localparam int STEP = raster_pkg::EDGE_STEP_BITS;
  localparam int TILE_EDGE = raster_pkg::TILE_EDGE_BITS;
  localparam int PIXEL = raster_pkg::TILE_PIXEL_BITS;
  localparam int SAMPLES = raster_pkg::SAMPLE_MASK_BITS;
  localparam int STAMP_BITS = raster_pkg::STAMP_PACKET_BITS;

  /* verilator lint_off UNUSEDSIGNAL */  // tile_q.edge_value: stepped in gen_edge from the moment it enters
  var raster_pkg::tile_packet_t  tile_q;
  /* verilator lint_on UNUSEDSIGNAL */
  var raster_pkg::edge_context_t edges_q;
  logic                      busy_q;
  logic [PIXEL-1:0]          x_q, y_q;  // first sample of the current stamp, pixels of the tile

  logic takes_tile, stamp_taken, is_last_column, is_last_stamp, out_ready;
  logic [PIXEL-1:0] first_x, first_y;  // the stamp that holds the first pixel of the new tile's box

  // All three edges at every sample: bit s is set where the sample is outside that edge.
  logic [3*SAMPLES-1:0] outside;
  logic [SAMPLES-1:0]   in_box, mask;

  assign first_x        = (tile_i.left >> STAMP_SHIFT) << STAMP_SHIFT;
  assign first_y        = (tile_i.top >> STAMP_SHIFT) << STAMP_SHIFT;
  assign is_last_column = (x_q >> STAMP_SHIFT) == (tile_q.right >> STAMP_SHIFT);
  assign is_last_stamp  = is_last_column && (y_q >> STAMP_SHIFT) == (tile_q.bottom >> STAMP_SHIFT);
  assign stamp_taken    = busy_q && (out_ready || mask == '0);
  assign tile_ready_o   = !busy_q || (stamp_taken && is_last_stamp);
  assign takes_tile     = tile_valid_i && tile_ready_o;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) busy_q <= 1'b0;
    else if (takes_tile) busy_q <= 1'b1;
    else if (stamp_taken && is_last_stamp) busy_q <= 1'b0;
  end

  always_ff @(posedge clk_i) begin
    if (takes_tile) begin
      tile_q  <= tile_i;
      edges_q <= edges_i;
      x_q     <= first_x;
      y_q     <= first_y;
    end else if (stamp_taken) begin
      x_q <= is_last_column ? (tile_q.left >> STAMP_SHIFT) << STAMP_SHIFT : x_q + PIXEL'(STAMP);
      if (is_last_column) y_q <= y_q + PIXEL'(STAMP);
    end
  end

  genvar e, i, j;
  generate
    for (e = 0; e < 3; e++) begin : gen_edge
      logic signed [W-1:0] value_q;  // edge value at the current stamp's first sample
      logic signed [W-1:0] row_q;    // the same at the first stamp of this row
      logic signed [W-1:0] new_step_x, new_step_y, step_x, step_y, start;

      assign new_step_x = W'($signed(edges_i.step_x[e*STEP +: STEP]));
      assign new_step_y = W'($signed(edges_i.step_y[e*STEP +: STEP]));
      assign step_x     = W'($signed(edges_q.step_x[e*STEP +: STEP]));
      assign step_y     = W'($signed(edges_q.step_y[e*STEP +: STEP]));

      // From the tile's first pixel to the box's first stamp: a sum of shifted steps, one for each bit of the offset.
      edge_offset #(
          .WIDTH (W),
          .OFFSET(PIXEL)
      ) u_start (
          .value_i (W'($signed(tile_i.edge_value[e*TILE_EDGE +: TILE_EDGE]))),
          .step_x_i(new_step_x),
          .step_y_i(new_step_y),
          .x_i     (first_x),
          .y_i     (first_y),
          .value_o (start)
      );

      always_ff @(posedge clk_i) begin
        if (takes_tile) begin
          value_q <= start;
          row_q   <= start;
        end else if (stamp_taken) begin
          value_q <= is_last_column ? row_q + (step_y <<< STAMP_SHIFT) : value_q + (step_x <<< STAMP_SHIFT);
          if (is_last_column) row_q <= row_q + (step_y <<< STAMP_SHIFT);
        end
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
          assign outside[e*SAMPLES+j*STAMP+i] = sample < 0;
        end
      end
    end

    for (j = 0; j < STAMP; j++) begin : gen_box_row
      for (i = 0; i < STAMP; i++) begin : gen_box_column
        assign in_box[j*STAMP+i] = x_q + PIXEL'(i) >= tile_q.left && x_q + PIXEL'(i) <= tile_q.right &&
                                   y_q + PIXEL'(j) >= tile_q.top && y_q + PIXEL'(j) <= tile_q.bottom;
      end
    end
  endgenerate

  assign mask = in_box & ~(outside[0+:SAMPLES] | outside[SAMPLES+:SAMPLES] | outside[2*SAMPLES+:SAMPLES]);

  var raster_pkg::stamp_packet_t stamp;
  assign stamp.primitive_id = tile_q.primitive_id;
  assign stamp.slot         = tile_q.slot;
  assign stamp.tile_x       = tile_q.tile_x;
  assign stamp.tile_y       = tile_q.tile_y;
  assign stamp.mask         = mask;

  generate
    if (STAMP == raster_pkg::TILE_SIZE) begin : gen_one_stamp
      assign stamp.stamp = '0;
    end else begin : gen_stamps
      assign stamp.stamp = {y_q[PIXEL-1:STAMP_SHIFT], x_q[PIXEL-1:STAMP_SHIFT]};
    end
  endgenerate

  skid_buffer #(
      .WIDTH(STAMP_BITS)
  ) u_out (
      .clk_i,
      .rst_ni,
      .valid_i(busy_q && mask != '0),
      .ready_o(out_ready),
      .data_i (stamp),
      .valid_o(stamp_valid_o),
      .ready_i(stamp_ready_i),
      .data_o (stamp_o)
  );

endmodule
