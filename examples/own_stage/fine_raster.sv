// A student's fine raster in the place of rtl_ref/stages/fine_raster.sv: one pixel of the tile's box per cycle, so slower than
// that one, with the same packets. For stamps of one pixel with one sample (`tiny`).
// docs/your-rtl.md, "Your stage in the pipeline".
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

  localparam int VALUE = raster_pkg::TILE_EDGE_BITS;
  localparam int STEP = raster_pkg::EDGE_STEP_BITS;
  localparam int PIXEL = raster_pkg::TILE_PIXEL_BITS;
  localparam int SUM = VALUE + STEP;  // more than a sum can need

  typedef enum logic [1:0] {IDLE, WALK, FINISH} state_t;
  state_t                    state_q;
  raster_pkg::tile_packet_t  tile_q;
  raster_pkg::edge_context_t edges_q;
  logic [PIXEL-1:0]          x_q, y_q;
  logic                      held_q;   // a covered pixel of the last row waits, because the last one ends the visit
  logic [PIXEL-1:0]          held_x_q;
  logic                      out_valid_q;
  raster_pkg::stamp_packet_t out_q;

  // Ties are folded into the value: 0 is inside.
  logic [2:0] is_inside;
  for (genvar e = 0; e < 3; e++) begin : gen_edge
    logic signed [SUM-1:0] sum;
    assign sum = SUM'($signed(tile_q.edge_value[e*VALUE+:VALUE]))
               + SUM'($signed(edges_q.step_x[e*STEP+:STEP])) * SUM'($signed({1'b0, x_q}))
               + SUM'($signed(edges_q.step_y[e*STEP+:STEP])) * SUM'($signed({1'b0, y_q}));
    assign is_inside[e] = sum >= 0;
  end

  logic is_covered, is_last_row, is_last_pixel, moves, pushes;
  assign is_covered    = tile_q.is_inside || is_inside == 3'b111;
  assign is_last_row   = y_q == tile_q.box.bottom;
  assign is_last_pixel = is_last_row && x_q == tile_q.box.right;
  assign moves         = state_q != IDLE && (!out_valid_q || stamp_ready_i);
  assign pushes        = state_q == FINISH || (is_covered && (!is_last_row || held_q));

  raster_pkg::stamp_packet_t stamp;
  always_comb begin
    stamp        = '0;
    stamp.kind   = tile_q.kind;
    stamp.key    = tile_q.key;
    stamp.slot   = tile_q.slot;
    stamp.anchor = tile_q.anchor;
    stamp.stamp  = {y_q, is_last_row ? held_x_q : x_q};
    stamp.mask   = 1'b1;
    if (state_q == FINISH) begin
      stamp.stamp          = !tile_q.is_visit ? '0 : {tile_q.box.bottom, held_q ? held_x_q : PIXEL'(0)};
      stamp.mask           = held_q;
      stamp.ends_visit     = tile_q.is_visit;
      stamp.ends_primitive = tile_q.ends_primitive;
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q     <= IDLE;
      out_valid_q <= 1'b0;
    end else begin
      if (stamp_ready_i) out_valid_q <= 1'b0;
      if (moves && pushes) out_valid_q <= 1'b1;
      if (state_q == IDLE && tile_valid_i) state_q <= tile_i.is_visit ? WALK : FINISH;
      if (moves && state_q == WALK && is_last_pixel) state_q <= FINISH;
      if (moves && state_q == FINISH) state_q <= IDLE;
    end
  end

  always_ff @(posedge clk_i) begin
    if (state_q == IDLE) begin
      tile_q  <= tile_i;
      edges_q <= edges_i;
      x_q     <= tile_i.box.left;
      y_q     <= tile_i.box.top;
      held_q  <= 1'b0;
    end else if (moves && state_q == WALK) begin
      x_q <= x_q == tile_q.box.right ? tile_q.box.left : x_q + PIXEL'(1);
      if (x_q == tile_q.box.right) y_q <= y_q + PIXEL'(1);
      if (is_covered && is_last_row) begin
        held_q   <= 1'b1;
        held_x_q <= x_q;
      end
    end
    if (moves && pushes) out_q <= stamp;
  end

  assign tile_ready_o  = state_q == IDLE;
  assign stamp_valid_o = out_valid_q;
  assign stamp_o       = out_q;

  logic unused;
  assign unused = ^visit_edges_i;  // of fine_raster_serial
endmodule
