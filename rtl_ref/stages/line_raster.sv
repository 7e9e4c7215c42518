// Line raster: the pixels of one line, from its start to its end.
//
// In: line setups, from the host. Out: one pixel per cycle. Error, position and planes are in registers, one adder
// each, with steps chosen by the sign of the error. The planes include half an LSB, so that a code is the upper bits.
// The next line is taken in the cycle in which the last pixel leaves; latency 1 cycle. Specification:
// model/stages/line_raster.hpp.
module line_raster (
    input logic clk_i,
    input logic rst_ni,

    // From the host
    input  logic                    line_valid_i,
    output logic                    line_ready_o,
    input  raster_pkg::line_setup_t line_i,

    // To primitive_join
    output logic                    pixel_valid_o,
    input  logic                    pixel_ready_i,
    output raster_pkg::line_pixel_t pixel_o
);

  localparam int PX = raster_pkg::PIXEL_X_BITS;
  localparam int PY = raster_pkg::PIXEL_Y_BITS;
  localparam int E = raster_pkg::LINE_ERROR_BITS;
  localparam int COUNT = raster_pkg::LINE_COUNT_BITS;
  localparam int PLANES = raster_pkg::PLANES;
  localparam logic [32*PLANES-1:0] CODE_BITS_OF = raster_pkg::AFFINE_CODE_BITS_OF;
  localparam logic [32*PLANES-1:0] CODE_AT = raster_pkg::AFFINE_CODE_AT;
  localparam logic [32*PLANES-1:0] LINE_BITS_OF = raster_pkg::LINE_BITS_OF;
  localparam logic [32*PLANES-1:0] LINE_AT = raster_pkg::LINE_AT;

  logic valid_q;  // a pixel is on offer
  raster_pkg::line_setup_t line_q;
  logic [PX-1:0]         x_q;
  logic [PY-1:0]         y_q;
  logic signed [E-1:0]   error_q;      // >= 0: the next pixel lies in the next row
  logic [COUNT-1:0]      remaining_q;  // pixels after this one
  logic                  is_before_start_q;

  logic is_last, takes, moves;
  assign is_last       = remaining_q == '0;
  assign line_ready_o  = !valid_q;  // so that nothing in here waits for downstream stages
  assign takes         = line_valid_i && line_ready_o;
  assign pixel_valid_o = valid_q;
  assign moves         = !error_q[E-1];

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= 1'b0;
    else valid_q <= takes || (valid_q && !(pixel_ready_i && is_last));
  end

  logic signed [E-1:0] step_stay, step_move;
  logic [PX-1:0]       step_x;
  logic [PY-1:0]       step_y;
  assign step_stay = E'(line_q.step_stay);
  assign step_move = E'($signed(line_q.step_move));
  // The step is 0 where the pixel stays: `moves` is not in the clock enable, where pixel_ready_i is late.
  assign step_x    = !line_q.is_x_major && !moves ? '0 : line_q.is_x_negative ? '1 : PX'(1);
  assign step_y    = line_q.is_x_major && !moves ? '0 : line_q.is_y_negative ? '1 : PY'(1);

  always_ff @(posedge clk_i) begin
    if (takes) begin
      line_q            <= line_i;
      x_q               <= line_i.x;
      y_q               <= line_i.y;
      error_q           <= line_i.error;
      remaining_q       <= line_i.remaining;
      is_before_start_q <= line_i.is_before_start;
    end else if (pixel_ready_i) begin
      x_q               <= x_q + step_x;
      y_q               <= y_q + step_y;
      error_q           <= error_q + (moves ? step_move : step_stay);
      remaining_q       <= remaining_q - 1'b1;
      is_before_start_q <= 1'b0;
    end
  end

  assign pixel_o.primitive_id = line_q.primitive_id;
  assign pixel_o.x            = x_q;
  assign pixel_o.y            = y_q;
  assign pixel_o.is_last      = is_last;

  genvar p;
  generate
    for (p = 0; p < raster_pkg::AFFINE_PLANES; p++) begin : gen_plane
      localparam int W = LINE_BITS_OF[32*p+:32];
      localparam int LINE = LINE_AT[32*p+:32];
      localparam int B = CODE_BITS_OF[32*p+:32];
      localparam int CODE = CODE_AT[32*p+:32];
      logic [W-1:0] value_q;
      always_ff @(posedge clk_i) begin
        if (takes) value_q <= line_i.value[LINE+:W];
        else if (pixel_ready_i) value_q <= value_q + line_q.step[LINE+:W];
      end
      assign pixel_o.code[CODE+:B] = is_before_start_q ? line_q.start[CODE+:B] : value_q[W-1-:B];
    end
  endgenerate

endmodule
