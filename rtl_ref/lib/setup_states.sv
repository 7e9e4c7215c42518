// The lane of states in triangle_setup: it runs next to the parts that process triangles for one cycle per plane, and
// joins them in one output register.
//
// A state knows the number of primitives before it, modulo more than the parts hold: it is next once that many have
// left; until then its successors wait in their last part. Nothing else joins the two streams. The register loads the
// output of the parts, or zeros and a state's codes, so that the planes need no gate. Specification:
// finish_flat_setup() of model/stages/triangle_setup.cpp; the times are those of pipelined_timing.hpp.
module setup_states (
    input logic clk_i,
    input logic rst_ni,

    // From cull
    input  logic                         triangle_valid_i,
    output logic                         triangle_ready_o,
    input  raster_pkg::triangle_packet_t triangle_i,

    // Packets that are not states: to the first part, and back from the last one
    input  logic                      part_ready_i,
    output logic                      part_takes_o,
    input  logic                      made_valid_i,
    output logic                      made_ready_o,
    input  raster_pkg::setup_packet_t made_i,

    // To coarse_raster
    output logic                      setup_valid_o,
    input  logic                      setup_ready_i,
    output raster_pkg::setup_packet_t setup_o
);

  localparam int PLANES = raster_pkg::PLANES;
  localparam int AFFINE = raster_pkg::AFFINE_PLANES;
  localparam int CODES = raster_pkg::ALL_CODE_BITS;  // bits of a vertex's codes
  localparam int F = raster_pkg::PLANE_FRACTION;
  localparam int L = raster_pkg::PLANE_LOCAL_GUARD_BITS;
  localparam logic [32*PLANES-1:0] CODE_BITS_OF = raster_pkg::CODE_BITS_OF;
  localparam logic [32*PLANES-1:0] CODE_AT = raster_pkg::CODE_AT;
  localparam logic [32*PLANES-1:0] PLANE_BITS_OF = raster_pkg::PLANE_BITS_OF;
  localparam logic [32*PLANES-1:0] PLANE_AT = raster_pkg::PLANE_AT;
  localparam int ID = raster_pkg::PRIMITIVE_ID_BITS;
  localparam int WAITING = 8;  // states that can wait
  localparam int NUMBER = 4;   // bits of a primitive's number: the parts hold at most 15

  logic is_state, enters, waits, is_next, takes_state, takes_made, is_free, valid_q;
  logic states_ready;
  logic [NUMBER-1:0] entered_q, left_q, number;
  logic [ID-1:0]     primitive_id;
  raster_pkg::depth_func_t which;  // the register that the state sets, in the place of the depth test
  logic [CODES-1:0]  code;
  assign is_state         = triangle_i.kind == raster_pkg::PRIMITIVE_KIND_STATE;
  assign triangle_ready_o = is_state ? states_ready : part_ready_i;
  assign enters           = triangle_valid_i && is_state;
  assign part_takes_o     = triangle_valid_i && !is_state && part_ready_i;

  fifo #(
      .WIDTH(NUMBER + ID + raster_pkg::DEPTH_FUNC_BITS + CODES),
      .DEPTH(WAITING)
  ) u_states (
      .clk_i,
      .rst_ni,
      .valid_i(enters),
      .ready_o(states_ready),
      .data_i ({entered_q, triangle_i.primitive_id, triangle_i.state.depth_test,
                triangle_i.vertex.code[2*CODES+:CODES]}),
      .valid_o(waits),
      .ready_i(takes_state),
      .data_o ({number, primitive_id, which, code})
  );

  assign is_free       = !valid_q || setup_ready_i;
  assign is_next       = waits && number == left_q;
  assign takes_state   = is_next && is_free;
  assign made_ready_o  = !is_next && is_free;
  assign takes_made    = made_valid_i && made_ready_o;
  assign setup_valid_o = valid_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_q   <= 1'b0;
      entered_q <= '0;
      left_q    <= '0;
    end else begin
      valid_q   <= takes_state || takes_made || (valid_q && !setup_ready_i);
      entered_q <= entered_q + NUMBER'(part_takes_o);
      left_q    <= left_q + NUMBER'(takes_made);
    end
  end

  raster_pkg::setup_packet_t setup_q;
  assign setup_o = setup_q;
  always_ff @(posedge clk_i) begin
    if (is_free) begin
      setup_q.kind         <= made_i.kind;
      setup_q.primitive_id <= is_next ? primitive_id : made_i.primitive_id;
      setup_q.state        <= made_i.state;
      setup_q.box          <= made_i.box;
      setup_q.dx           <= made_i.dx;
      setup_q.dy           <= made_i.dy;
      setup_q.edge_value   <= made_i.edge_value;
      setup_q.step_x       <= made_i.step_x;
      setup_q.step_y       <= made_i.step_y;
      if (is_next) begin
        setup_q.kind        <= raster_pkg::PRIMITIVE_KIND_STATE;
        setup_q.state       <= '0;
        setup_q.state.depth_test <= which;
        setup_q.box         <= '0;
        setup_q.dx          <= '0;
        setup_q.dy          <= '0;
        setup_q.edge_value  <= '0;
        setup_q.step_x      <= '0;
        setup_q.step_y      <= '0;
      end
    end
  end

  // A plane with gradients 0: its code, plus the constant that triangle_setup adds (HALVES there).
  localparam logic [F-1:0] HALVES = F'(1) << (F - L - 1) | F'(1) << (F - 1);
  localparam logic [F-1:0] HALVES_OVER_W = F'(1) << (F - raster_pkg::PERSPECTIVE_GUARD_BITS - 1);
  genvar p;
  generate
    if (raster_pkg::COORDINATES != 0) begin : gen_coordinates
      always_ff @(posedge clk_i)
        if (is_free) begin
          setup_q.coordinates <= made_i.coordinates;
          if (is_next) setup_q.coordinates <= '0;
        end
    end
    if (raster_pkg::MSAA_SAMPLES > 1) begin : gen_edge_lows
      always_ff @(posedge clk_i) if (is_free) setup_q.edge_low <= is_next ? '0 : made_i.edge_low;
    end
    for (p = 0; p < PLANES; p++) begin : gen_plane
      localparam int B = CODE_BITS_OF[32*p+:32];
      localparam int AT = CODE_AT[32*p+:32];
      localparam int PB = PLANE_BITS_OF[32*p+:32];
      localparam int PLANE = PLANE_AT[32*p+:32];
      localparam logic [F-1:0] BELOW = p < AFFINE ? HALVES : HALVES_OVER_W;
      logic [B-1:0]    own;
      logic [PB-F-1:0] above;
      assign own = code[AT+:B];
      if (p < AFFINE) begin : gen_range
        assign above = (PB - F)'({own[B-1], !own[B-1], own[B-2:0]});
        always_ff @(posedge clk_i) begin
          if (is_free) begin
            setup_q.range.low[AT+:B]  <= is_next ? own : made_i.range.low[AT+:B];
            setup_q.range.high[AT+:B] <= is_next ? own : made_i.range.high[AT+:B];
          end
        end
      end else begin : gen_over_w
        assign above = (PB - F)'({{(PB > B ? PB - B : 1) {p > AFFINE && own[B-1]}}, own});
      end
      always_ff @(posedge clk_i) begin
        if (is_free) begin
          setup_q.value[PLANE+F+:PB-F] <= is_next ? above : made_i.value[PLANE+F+:PB-F];
          setup_q.value[PLANE+:F]      <= made_i.value[PLANE+:F];
          if (is_next) setup_q.value[PLANE+:F] <= BELOW;
        end
      end
    end
  endgenerate

endmodule
