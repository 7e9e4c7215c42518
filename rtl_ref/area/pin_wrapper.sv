// Pin wrapper: raster_top behind six pins, for place and route only. A shift register feeds every input, and every output
// bit is folded into one pin, so that nothing of the core can be left out. All of it is registered, so that every path
// begins and ends in a register. A wire between two registers costs no time that the core would not cost anywhere else.
module pin_wrapper (
    input  logic clk_i,
    input  logic rst_ni,
    input  logic data_i,    // the next bit of the inputs
    input  logic shift_i,   // move them by one; otherwise they stay
    input  logic valid_i,   // a primitive and a line are offered
    output logic data_o     // parity of all outputs, some cycles ago
);

  localparam int LINE = raster_pkg::LINE_SETUP_BITS;  // at the end of the register: gone with the unit of lines
  localparam int PRIMITIVE = 5;  // where each input begins; below them the five that say something is ready or there
  localparam int ANSWER = PRIMITIVE + raster_pkg::PRIMITIVE_PACKET_BITS;
  localparam int TEXEL = ANSWER + raster_pkg::MEMORY_ANSWER_BITS;
  localparam int LAYOUT = TEXEL + raster_pkg::TEXEL_BEAT_BITS;
  localparam int LAYOUTS = 4 * raster_pkg::ADDRESS_BITS + raster_pkg::ROW_STRIDE_BITS;
  localparam int IN = LAYOUT + LAYOUTS + LINE;
  localparam int BEAT = 7;
  localparam int TEXTURE = BEAT + raster_pkg::MEMORY_BEAT_BITS;
  localparam int OUT = TEXTURE + raster_pkg::TEXTURE_REQUEST_BITS + raster_pkg::COUNTER_PACKET_BITS;

  logic [IN-1:0] in_q;
  logic          valid_q, shift_q, data_q;
  always_ff @(posedge clk_i) begin
    data_q  <= data_i;
    shift_q <= shift_i;
    valid_q <= valid_i;
    if (shift_q) in_q <= {in_q[IN-2:0], data_q};
  end

  logic [OUT-1:0] out;
  raster_top u_core (
      .clk_i,
      .rst_ni,
      .power_on_ni      (rst_ni),
      .stall_i          ('0),
      .primitive_valid_i(valid_q),
      .primitive_ready_o(out[0]),
      .primitive_i      (in_q[PRIMITIVE+:raster_pkg::PRIMITIVE_PACKET_BITS]),
      .line_valid_i     (valid_q),
      .line_ready_o     (out[1]),
      .line_i           (in_q[IN-1-:LINE]),
      .layout_i         (in_q[LAYOUT+:LAYOUTS]),
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
      .idle_o           (out[6])
  );

  // Parity in registered layers of four-input gates.
  localparam int FOURS = (OUT + 3) / 4;
  localparam int SIXTEENS = (FOURS + 3) / 4;
  localparam int SIXTY_FOURS = (SIXTEENS + 3) / 4;
  logic [4*FOURS-1:0]       out_padded;
  logic [4*SIXTEENS-1:0]    fours_q;
  logic [4*SIXTY_FOURS-1:0] sixteens_q;
  logic [SIXTY_FOURS-1:0]   sixty_fours_q;
  assign out_padded = (4 * FOURS)'(out);
  always_ff @(posedge clk_i) begin
    fours_q    <= '0;
    sixteens_q <= '0;
    for (int i = 0; i < FOURS; i++) fours_q[i] <= ^out_padded[4*i+:4];
    for (int i = 0; i < SIXTEENS; i++) sixteens_q[i] <= ^fours_q[4*i+:4];
    for (int i = 0; i < SIXTY_FOURS; i++) sixty_fours_q[i] <= ^sixteens_q[4*i+:4];
    data_o <= ^sixty_fours_q;
  end

endmodule
