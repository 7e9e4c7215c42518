// Interpolate for the smallest parts: the same bits as interpolate.sv, with one context in use instead of one per step.
//
// The context RAM's output is the only copy of a context: it is read when the first stamp of a primitive waits and all
// stamps of the primitive before have left. Then one stamp a cycle; latency 2 cycles:
//   x, y  from the anchor to the stamp's first sample; from there to each sample, of which the code is a part
// Step y ends in a block RAM, from which a fragment is also offered: at most three wait there, the newest in step y,
// the others as in a skid buffer. So later stages wait for the framebuffer by registers alone. The fields that decide
// first, the accesses of a fragment, stand in registers all the way. Specification:
// model/stages/interpolate.hpp.
module interpolate_serial (
    input logic clk_i,
    input logic rst_ni,

    // From fine_raster
    input  logic                      stamp_valid_i,
    output logic                      stamp_ready_o,
    input  raster_pkg::stamp_packet_t stamp_i,

    // Context RAM: a read, and its answer in the next cycle, which stays until the next read
    output logic                             context_read_o,
    output logic [raster_pkg::SLOT_BITS-1:0] context_slot_o,
    input  raster_pkg::context_packet_t      context_i,
    output logic                             slot_free_o,  // the oldest slot will not be read again

    // To primitive_join
    output logic                         fragment_valid_o,
    input  logic                         fragment_ready_i,
    output raster_pkg::fragment_packet_t fragment_o
);

  localparam int STAMP = raster_pkg::STAMP_SIZE;
  localparam int STAMP_SHIFT = $clog2(STAMP);
  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int PLANES = raster_pkg::PLANES;
  localparam logic [32*PLANES-1:0] CODE_BITS_OF = raster_pkg::CODE_BITS_OF;
  localparam logic [32*PLANES-1:0] CODE_AT = raster_pkg::CODE_AT;
  localparam logic [32*PLANES-1:0] LOCAL_BITS_OF = raster_pkg::LOCAL_BITS_OF;
  localparam logic [32*PLANES-1:0] LOCAL_AT = raster_pkg::LOCAL_AT;
  localparam int CODES = raster_pkg::ALL_CODE_BITS;  // bits of a sample
  localparam int PIXEL = raster_pkg::TILE_PIXEL_BITS;
  localparam int L = raster_pkg::PLANE_LOCAL_GUARD_BITS;
  localparam int PER_ROW_BITS = PIXEL - STAMP_SHIFT;

  raster_pkg::stamp_packet_t x_stamp_q;
  localparam int FIRST = raster_pkg::KIND_BITS + raster_pkg::PRIMITIVE_ID_BITS + raster_pkg::TILE_X_BITS + raster_pkg::TILE_Y_BITS +
                         raster_pkg::STAMP_INDEX_BITS + raster_pkg::SAMPLE_MASK_BITS;  // kind, key, stamp, mask
  logic [FIRST-1:0] y_first_q;
  logic has_context_q, x_valid_q, y_valid_q;
  logic x_ready, y_ready, buffer_ready, is_empty;

  assign y_ready        = !y_valid_q || buffer_ready;
  assign x_ready        = !x_valid_q || y_ready;
  assign stamp_ready_o  = has_context_q && x_ready;
  assign is_empty       = !x_valid_q && !y_valid_q;
  assign context_read_o = stamp_valid_i && !has_context_q && is_empty;
  assign context_slot_o = stamp_i.slot;

  logic takes;
  assign takes = stamp_valid_i && stamp_ready_o;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      has_context_q <= 1'b0;
      x_valid_q     <= 1'b0;
      y_valid_q     <= 1'b0;
      slot_free_o   <= 1'b0;
    end else begin
      if (context_read_o) has_context_q <= 1'b1;
      else if (takes && stamp_i.ends_primitive) has_context_q <= 1'b0;
      if (x_ready) x_valid_q <= takes;
      if (y_ready) y_valid_q <= x_valid_q;
      slot_free_o <= context_read_o;
    end
  end

  always_ff @(posedge clk_i) begin
    if (x_ready) x_stamp_q <= stamp_i;
    if (y_ready) y_first_q <= {x_stamp_q.kind, x_stamp_q.key, x_stamp_q.stamp, x_stamp_q.mask};
  end

  // Offset of the stamp's first sample from the centre, in stamps: -n/2 ... n/2 - 1 of n in a row, two's complement.
  logic signed [PIXEL-1:0] to_x, to_y;  // pixels
  generate
    if (PER_ROW_BITS > 0) begin : gen_offset
      logic signed [PER_ROW_BITS-1:0] column, row;
      assign column = stamp_i.stamp[0+:PER_ROW_BITS] ^ {1'b1, {(PER_ROW_BITS - 1) {1'b0}}};
      assign row    = x_stamp_q.stamp[PER_ROW_BITS+:PER_ROW_BITS] ^ {1'b1, {(PER_ROW_BITS - 1) {1'b0}}};
      assign to_x   = PIXEL'(column) <<< STAMP_SHIFT;
      assign to_y   = PIXEL'(row) <<< STAMP_SHIFT;
    end else begin : gen_whole_tile
      assign to_x = PIXEL'(STAMP / 2);
      assign to_y = PIXEL'(STAMP / 2);
    end
  endgenerate

  logic [SAMPLES*CODES-1:0] code;
  genvar p, s;
  generate
    for (p = 0; p < PLANES; p++) begin : gen_plane
      localparam int W = LOCAL_BITS_OF[32*p+:32];
      localparam int LOCAL = LOCAL_AT[32*p+:32];
      localparam int B = CODE_BITS_OF[32*p+:32];
      localparam int CODE = CODE_AT[32*p+:32];
      logic [W-1:0] anchor, step_x, step_y, x_value, y_value, x_value_q;
      assign anchor = stamp_i.anchor[LOCAL+:W];
      assign step_x = context_i.step_x[LOCAL+:W];
      assign step_y = context_i.step_y[LOCAL+:W];

      plane_offset #(
          .WIDTH (W),
          .OFFSET(PIXEL),
          .LOWEST(STAMP_SHIFT)
      ) u_x (
          .value_i (anchor),
          .step_i  (step_x),
          .offset_i(to_x),
          .value_o (x_value)
      );
      plane_offset #(
          .WIDTH (W),
          .OFFSET(PIXEL),
          .LOWEST(STAMP_SHIFT)
      ) u_y (
          .value_i (x_value_q),
          .step_i  (step_y),
          .offset_i(to_y),
          .value_o (y_value)
      );
      always_ff @(posedge clk_i) if (x_ready) x_value_q <= x_value;

      for (s = 0; s < SAMPLES; s++) begin : gen_sample
        logic signed [W-1:0] value;
        edge_offset #(
            .WIDTH (W),
            .OFFSET(PIXEL)
        ) u_value (
            .value_i (y_value),
            .step_x_i(step_x),
            .step_y_i(step_y),
            .x_i     (PIXEL'(s % STAMP)),
            .y_i     (PIXEL'(s / STAMP)),
            .value_o (value)
        );
        assign code[s*CODES+CODE+:B] = {!value[L+B-1], value[L+:B-1]};  // anchors are offset by half of all codes
      end
    end
  endgenerate

  // ----------------------------------------------------------------------------------------------------- the way out
  skid_buffer #(
      .WIDTH(FIRST)
  ) u_first (
      .clk_i,
      .rst_ni,
      .valid_i(y_valid_q),
      .ready_o(buffer_ready),
      .data_i (y_first_q),
      .valid_o(fragment_valid_o),
      .ready_i(fragment_ready_i),
      .data_o ({fragment_o.kind, fragment_o.key, fragment_o.stamp, fragment_o.mask})
  );

  // The word on offer in the next cycle was written in an earlier one: a fragment is in step y first.
  logic [1:0] write_q, read_q, read;  // places in four words: of the next fragment; of the offer, now and next
  assign read = read_q + 2'(fragment_valid_o && fragment_ready_i);
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      write_q <= '0;
      read_q  <= '0;
    end else begin
      write_q <= write_q + 2'(x_valid_q && y_ready);
      read_q  <= read;
    end
  end
  sram #(
      .WIDTH    (raster_pkg::FRAGMENT_PACKET_BITS - FIRST),
      .DEPTH    (4),
      .READS_OLD(0),
      .BLOCK    (1)
  ) u_fragments (
      .clk_i,
      .read_i         (1'b1),
      .read_address_i (read),
      .data_o         ({fragment_o.ends_visit, fragment_o.ends_primitive, fragment_o.state, fragment_o.code}),
      .write_i        (x_valid_q && y_ready),
      .write_address_i(write_q),
      .data_i         ({x_stamp_q.ends_visit, x_stamp_q.ends_primitive, context_i.state, code})
  );

endmodule
