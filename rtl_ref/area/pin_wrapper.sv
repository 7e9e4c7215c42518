// Pin wrapper: raster_top with six pins, for place and route only. A shift register feeds every input, and every output
// bit is folded into the same register on its way, so that no part of the core can be optimised away: the final content
// of the register is its signature. Everything is registered, so that every path begins and ends in a register. A wire
// between two registers adds no time to a path of the core.
module pin_wrapper (
    input  logic clk_i,
    input  logic rst_ni,
    input  logic data_i,    // the next bit of the inputs
    input  logic shift_i,   // shifts the inputs by one; otherwise they stay
    input  logic valid_i,   // a primitive and a line are offered
    output logic data_o     // the register's signature
);

  // Where each input begins in the register. The layout has no bits of its own but reuses the primitive's: core
  // registers stand between the uses of the two, so no gate sees both, and synthesis saves nothing. Below the primitive
  // are the five valid and ready bits, at the end the inputs that some cores do not read: without them they are gone.
  localparam int PRIMITIVE = 5;
  localparam int ANSWER = PRIMITIVE + raster_pkg::PRIMITIVE_PACKET_BITS - raster_pkg::PRIMITIVE_ID_BITS;
  localparam int PLANE = raster_pkg::ADDRESS_BITS - raster_pkg::PLANE_SHIFT;  // address bits that are not always 0
  localparam int FLAG_ROW = raster_pkg::ADDRESS_BITS - raster_pkg::FLAG_ROW_SHIFT;
  localparam int STRIDE = raster_pkg::ROW_STRIDE_BITS - raster_pkg::PLANE_SHIFT - 1;
  localparam int LAYOUT = 2 * PLANE + 2 * FLAG_ROW + STRIDE;
  localparam int USED = ANSWER + raster_pkg::MEMORY_ANSWER_BITS;
  localparam int TEXEL = USED;
  localparam int ID = TEXEL + raster_pkg::TEXEL_BEAT_BITS;
  localparam int LINE = ID + raster_pkg::PRIMITIVE_ID_BITS;
  localparam int IN = LINE + raster_pkg::LINE_SETUP_BITS;
  localparam int BEAT = 7;
  localparam int TEXTURE = BEAT + raster_pkg::MEMORY_BEAT_BITS;
  localparam int OUT = TEXTURE + raster_pkg::TEXTURE_REQUEST_BITS + raster_pkg::COUNTER_PACKET_BITS;

  // Three outputs and the shifted bit fit a gate of four inputs in front of a flip-flop that is there already.
  localparam int FOLDED = (OUT > 3 * USED) ? (OUT + USED - 1) / USED : 3;
  logic [IN-1:0]          in_q, folded;
  logic [FOLDED*USED-1:0] out_padded;
  logic                   valid_q, shift_q, data_q;
  assign out_padded = (FOLDED * USED)'(out);
  always_comb begin
    folded = '0;
    for (int i = 0; i < USED; i++) folded[i] = ^out_padded[FOLDED*i+:FOLDED];
  end
  always_ff @(posedge clk_i) begin
    data_q  <= data_i;
    shift_q <= shift_i;
    valid_q <= valid_i;
    data_o  <= in_q[USED-1];
    if (shift_q) in_q <= {in_q[IN-2:0], data_q} ^ folded;
  end

  raster_pkg::primitive_packet_t packet;
  raster_pkg::memory_layout_t   layout;
  always_comb begin
    {packet.kind, packet.box, packet.state, packet.cull, packet.front_cw, packet.vertex} =
        in_q[PRIMITIVE+:ANSWER-PRIMITIVE];
    packet.primitive_id = in_q[ID+:raster_pkg::PRIMITIVE_ID_BITS];
    layout = '0;
    {layout.depth_base[raster_pkg::ADDRESS_BITS-1-:PLANE], layout.color_base[raster_pkg::ADDRESS_BITS-1-:PLANE],
     layout.depth_flags_base[raster_pkg::ADDRESS_BITS-1-:FLAG_ROW],
     layout.color_flags_base[raster_pkg::ADDRESS_BITS-1-:FLAG_ROW],
     layout.row_stride[raster_pkg::ROW_STRIDE_BITS-1-:STRIDE]} = in_q[PRIMITIVE+:LAYOUT];
  end

  logic [OUT-1:0] out;
  raster_top u_core (
      .clk_i,
      .rst_ni,
      .power_on_ni      (rst_ni),
      .stall_i          ('0),
      .primitive_valid_i(valid_q),
      .primitive_ready_o(out[0]),
      .primitive_i      (packet),
      .line_valid_i     (valid_q),
      .line_ready_o     (out[1]),
      .line_i           (in_q[LINE+:raster_pkg::LINE_SETUP_BITS]),
      .layout_i         (layout),
      .beat_valid_o     (out[2]),
      .beat_ready_i     (in_q[0]),
      .beat_o           (out[BEAT+:raster_pkg::MEMORY_BEAT_BITS]),
      .answer_valid_i   (in_q[1]),
      .answer_ready_o   (out[3]),
      .answer_i         (in_q[ANSWER+:raster_pkg::MEMORY_ANSWER_BITS]),
      .texture_valid_o  (out[4]),
      .texture_ready_i  (in_q[2]),
      .texture_o        (out[TEXTURE+:raster_pkg::TEXTURE_REQUEST_BITS]),
      .texel_valid_i    (in_q[3]),
      .texel_ready_o    (out[5]),
      .texel_i          (in_q[TEXEL+:raster_pkg::TEXEL_BEAT_BITS]),
      .counters_hold_i  (in_q[4]),
      .counters_o       (out[OUT-1-:raster_pkg::COUNTER_PACKET_BITS]),
      .idle_o           (out[6]),
      .flushed_o        ()
  );

endmodule
