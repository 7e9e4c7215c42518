// Context RAM: the constants of a primitive that its stamps need, by the slot that coarse_raster assigns. A slot is not
// written before it is free, nor read before the first stamp arrives. The serial front writes one part a cycle.
//
// With planes over w and one sample per pixel (STORE_CONSTANTS_SEPARATELY) most constants are needed only after the
// depth test: the steps of those planes, and the texture constants. They lie in a RAM of their own by the triangle's
// number, which goes with the fragments instead of the texture constants. There are as many numbers as triangles
// between setup and test: one per slot, and one for each later fragment, since a triangle's end travels as a fragment.
// Specification: make_context() of model/stages/coarse_raster.hpp.
module context_ram #(
    parameter int SLOT = raster_pkg::SLOT_BITS  // derived; not to be set
) (
    input logic clk_i,
    input logic rst_ni,

    // From coarse_raster
    input logic                                  write_i,
    input logic [SLOT-1:0]                       write_slot_i,
    input raster_pkg::context_packet_t           context_i,
    input logic [raster_pkg::ALL_LOCAL_BITS-1:0] step_i,  // steps of the serial stages: x a cycle after write_i, then y

    // To interpolate, in the cycle after the read
    input  logic                        read_i,
    input  logic [SLOT-1:0]             read_slot_i,
    output raster_pkg::context_packet_t context_o,

    // The separate constants: read as a fragment comes to the head of the queue in front of the test, there while the
    // fragment that was at the head in the cycle before is in the test
    input  logic                                 comes_i,
    input  logic [raster_pkg::TRIANGLE_BITS-1:0] coming_number_i,
    output raster_pkg::context_packet_t          tested_context_o,
    output logic [raster_pkg::TRIANGLE_BITS-1:0] number_o  // number of the next triangle
);

  localparam bit STORE_CONSTANTS_SEPARATELY = raster_pkg::STORE_CONSTANTS_SEPARATELY != 0;
  localparam int NUMBER = raster_pkg::TRIANGLE_BITS;
  localparam int DEPTH = raster_pkg::CONTEXT_SLOTS;
  generate
    if (STORE_CONSTANTS_SEPARATELY) begin : gen_separate
      localparam int FRAME = raster_pkg::COORDINATE_FRAME_BITS;
      localparam int AT = raster_pkg::STEP_AT[32*raster_pkg::AFFINE_PLANES+:32];
      localparam int STEP = raster_pkg::ALL_STEP_BITS - AT;
      logic [NUMBER-1:0]       number_q;
      logic [2*STEP+FRAME-1:0] entering, constants, constants_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) number_q <= '0;
        else number_q <= number_q + NUMBER'(write_i);
      end
      assign number_o = number_q;
      assign entering = {context_i.step_y[AT+:STEP], context_i.step_x[AT+:STEP], context_i.coordinates};
      sram #(
          .WIDTH    (2 * STEP + FRAME),
          .DEPTH    (1 << NUMBER),
          .READS_OLD(0),
          .BLOCK    (1)
      ) u_constants (
          .clk_i,
          .read_i         (comes_i),
          .read_address_i (coming_number_i),
          .data_o         (constants),
          .write_i,
          .write_address_i(number_q),
          .data_i         (entering)
      );
      always_ff @(posedge clk_i) constants_q <= constants;
      always_comb begin
        tested_context_o             = '0;
        tested_context_o.coordinates = constants_q[0+:FRAME];
        tested_context_o.step_x      = raster_pkg::ALL_STEP_BITS'(constants_q[FRAME+:STEP]) << AT;
        tested_context_o.step_y      = raster_pkg::ALL_STEP_BITS'(constants_q[FRAME+STEP+:STEP]) << AT;
      end
    end else begin : gen_together
      assign number_o         = '0;
      assign tested_context_o = '0;
    end

    if (raster_pkg::SETUP_KIND == 0) begin : gen_context
      // The range of the codes is needed for colours over w only: no other code is clamped.
      localparam int FRAME = STORE_CONSTANTS_SEPARATELY ? NUMBER : raster_pkg::COORDINATE_FRAME_BITS;
      localparam int RANGE = 2 * raster_pkg::ALL_AFFINE_CODE_BITS;
      localparam int STEPS = raster_pkg::ALL_STEP_BITS;
      localparam int KEPT_STEPS = STORE_CONSTANTS_SEPARATELY ? raster_pkg::STEP_AT[32*(STORE_CONSTANTS_SEPARATELY ? raster_pkg::AFFINE_PLANES : 0)+:32] : STEPS;
      localparam int HEAD = raster_pkg::CONTEXT_PACKET_BITS - RANGE - raster_pkg::COORDINATE_FRAME_BITS -
                            2 * (STEPS - KEPT_STEPS);  // state and steps
      localparam int KEPT = raster_pkg::COLORS_OVER_W != 0 ? RANGE : 0;  // bits of the range
      logic [HEAD+KEPT+FRAME-1:0] entering, kept;
      logic [KEPT_STEPS-1:0]      step_x, step_y;
      sram #(
          .WIDTH    (HEAD + KEPT + FRAME),
          .DEPTH    (DEPTH),
          .READS_OLD(0),
          .BLOCK    (raster_pkg::QUEUE_BLOCK_RAM != 0)
      ) u_context (
          .clk_i,
          .read_i,
          .read_address_i (read_slot_i),
          .data_o         (kept),
          .write_i,
          .write_address_i(write_slot_i),
          .data_i         (entering)
      );
      assign entering[KEPT+FRAME+:HEAD] = {context_i.state, context_i.step_x[0+:KEPT_STEPS], context_i.step_y[0+:KEPT_STEPS]};
      assign {context_o.state, step_x, step_y} = kept[KEPT+FRAME+:HEAD];
      assign context_o.step_x = STEPS'(step_x);
      assign context_o.step_y = STEPS'(step_y);
      if (KEPT != 0) begin : gen_range
        assign entering[FRAME+:KEPT] = context_i.range;
        assign context_o.range       = kept[FRAME+:KEPT];
      end else begin : gen_no_range
        assign context_o.range = '0;
      end
      if (STORE_CONSTANTS_SEPARATELY) begin : gen_number
        assign entering[0+:FRAME]    = number_o;
        assign context_o.coordinates = raster_pkg::COORDINATE_FRAME_BITS'(kept[0+:FRAME]);
      end else if (FRAME != 0) begin : gen_frame
        assign entering[0+:FRAME]    = context_i.coordinates;
        assign context_o.coordinates = kept[0+:FRAME];
      end
    end else begin : gen_contexts
      localparam int STEP = raster_pkg::ALL_LOCAL_BITS;
      localparam int REST = raster_pkg::CONTEXT_PACKET_BITS - 2 * STEP;
      logic            writes_step_x_q, writes_step_y_q;
      logic [STEP-1:0] step_x, step_y;
      logic [REST-1:0] rest;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          writes_step_x_q <= 1'b0;
          writes_step_y_q <= 1'b0;
        end else begin
          writes_step_x_q <= write_i;
          writes_step_y_q <= writes_step_x_q;
        end
      end
      sram #(
          .WIDTH    (STEP),
          .DEPTH    (DEPTH),
          .READS_OLD(0),
          .BLOCK    (1)
      ) u_step_x (
          .clk_i,
          .read_i,
          .read_address_i (read_slot_i),
          .data_o         (step_x),
          .write_i        (writes_step_x_q),
          .write_address_i(write_slot_i),
          .data_i         (step_i)
      );
      sram #(
          .WIDTH    (STEP),
          .DEPTH    (DEPTH),
          .READS_OLD(0),
          .BLOCK    (1)
      ) u_step_y (
          .clk_i,
          .read_i,
          .read_address_i (read_slot_i),
          .data_o         (step_y),
          .write_i        (writes_step_y_q),
          .write_address_i(write_slot_i),
          .data_i         (step_i)
      );
      sram #(
          .WIDTH    (REST),
          .DEPTH    (DEPTH),
          .READS_OLD(0),
          .BLOCK    (1)
      ) u_rest (
          .clk_i,
          .read_i,
          .read_address_i (read_slot_i),
          .data_o         (rest),
          .write_i,
          .write_address_i(write_slot_i),
          .data_i         ({context_i.range, context_i.state})
      );
      assign context_o.step_x = step_x;
      assign context_o.step_y = step_y;
      assign {context_o.range, context_o.state} = rest;
    end
  endgenerate

endmodule
