// Fog unit: blends colours downstream of the texture unit with the fog's colour, by the distance of their samples. All
// samples of a stamp at once, three clocks.
//
//   1  the table line of each sample's place        2  f = start + rise * part, 0 to 1
//   3  colour + f (colour of the pixel - colour of the fog)
//
// Each register loads as soon as its content moves on. A token passes like a stamp, and its value holds for later
// stamps: a line of the table is set as the token enters, the fog's colour as it leaves the first register. A sample
// here is a pixel's shading point: one per pixel, however many samples coverage has. Specification: FogUnit of
// model/stages/fog_unit.hpp; the times are FogTiming's in model/engines/cycle/block_timing.hpp.
module fog_unit #(
    parameter int SAMPLES  = 4,
    parameter int CHANNELS = 4,  // channels of a colour
    parameter int PAYLOAD  = 1,  // bits that a stamp carries along
    parameter int WORD     = 76  // bits of a token, 43, or of the places, 19 per sample: the larger
) (
    input logic clk_i,
    input logic rst_ni,

    // From the texture unit
    input  logic                          stamp_valid_i,
    output logic                          stamp_ready_o,
    input  logic [PAYLOAD-1:0]            payload_i,
    input  logic [8*CHANNELS*SAMPLES-1:0] color_i,       // R lowest
    input  logic                          is_fogged_i,
    input  logic                          sets_color_i,  // a token: the word is the colour
    input  logic                          sets_line_i,   // likewise: a line's number, start and rise
    input  logic [WORD-1:0]               word_i,        // 19 bits per sample, fog_place; or a token's word

    // The same stamp with fog
    output logic                          stamp_valid_o,
    input  logic                          stamp_ready_i,
    output logic [PAYLOAD-1:0]            payload_o,
    output logic [8*CHANNELS*SAMPLES-1:0] color_o
);

  localparam int PLACE = 19;
  localparam int LINE = 8;
  localparam int PART = PLACE - LINE;
  localparam int START = 18;
  localparam int RISE = 17;
  localparam int FACTOR = 13;  // 0 to 2^12
  localparam int COLORS = 8 * CHANNELS * SAMPLES;

  // ----------------------------------------------------------------------------------------------------- pipeline registers
  logic valid_1_q, valid_2_q, valid_3_q, enters_1, enters_2, enters_3, frees_1, frees_2, frees_3;
  assign frees_3       = !valid_3_q || stamp_ready_i;
  assign frees_2       = !valid_2_q || frees_3;
  assign frees_1       = !valid_1_q || frees_2;
  assign stamp_ready_o = frees_1;
  assign enters_1      = stamp_valid_i && frees_1;
  assign enters_2      = valid_1_q && frees_2;
  assign enters_3      = valid_2_q && frees_3;
  assign stamp_valid_o = valid_3_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_1_q <= 1'b0;
      valid_2_q <= 1'b0;
      valid_3_q <= 1'b0;
    end else begin
      if (frees_1) valid_1_q <= stamp_valid_i;
      if (frees_2) valid_2_q <= valid_1_q;
      if (frees_3) valid_3_q <= valid_2_q;
    end
  end

  logic [PAYLOAD-1:0] payload_1_q, payload_2_q, payload_3_q;
  logic [COLORS-1:0]  color_1_q, color_2_q, color_3_q, mixed;
  logic               is_fogged_1_q, is_fogged_2_q, sets_color_1_q;
  logic [23:0]        word_1_q, fog_q;  // colour of a token in flight; the fog's colour
  always_ff @(posedge clk_i) begin
    if (enters_1) begin
      payload_1_q    <= payload_i;
      color_1_q      <= color_i;
      is_fogged_1_q  <= is_fogged_i;
      sets_color_1_q <= sets_color_i;
      word_1_q       <= word_i[23:0];
    end
    if (enters_2) begin
      payload_2_q   <= payload_1_q;
      color_2_q     <= color_1_q;
      is_fogged_2_q <= is_fogged_1_q;
      if (sets_color_1_q) fog_q <= word_1_q;
    end
    if (enters_3) begin
      payload_3_q <= payload_2_q;
      color_3_q   <= mixed;
    end
  end
  assign payload_o = payload_3_q;
  assign color_o   = color_3_q;

  // ---------------------------------------------------------------------------------------------------------- of each sample
  genvar s, c;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_sample
      logic [PART-1:0]             part_q;
      logic [RISE-1:0]             rise;
      logic [START-1:0]            start;
      logic [RISE+PART-1:0]        product;
      logic signed [START+PART:0]  sum;
      logic signed [15:0]          whole;
      logic [FACTOR-1:0]           factor, factor_q;

      sram #(
          .WIDTH    (START + RISE),
          .DEPTH    (1 << LINE),
          .READS_OLD(0)
      ) u_table (
          .clk_i,
          .read_i         (enters_1 && !sets_line_i),
          .read_address_i (word_i[PLACE*s+PART+:LINE]),
          .data_o         ({start, rise}),
          .write_i        (enters_1 && sets_line_i),
          .write_address_i(word_i[START+RISE+:LINE]),
          .data_i         (word_i[START+RISE-1:0])
      );
      always_ff @(posedge clk_i) if (enters_1) part_q <= word_i[PLACE*s+:PART];

      assign product = (RISE + PART)'(rise) * (RISE + PART)'(part_q);
      assign sum     = $signed({start[START-1], start, {PART{1'b0}}}) + $signed({2'b00, product}) + 30'sd8192;
      assign whole   = sum[START+PART-:16];  // 12 fraction bits
      assign factor  = whole[15] ? '0 : whole > 16'sd4096 ? 13'd4096 : whole[FACTOR-1:0];
      always_ff @(posedge clk_i) if (enters_2) factor_q <= factor;

      for (c = 0; c < CHANNELS; c++) begin : gen_channel
        localparam int AT = 8 * (CHANNELS * s + c);
        if (c < 3) begin : gen_mixed
          logic signed [8:0]  difference;
          logic signed [22:0] weighed;
          logic signed [22:0] rounded;
          assign difference = $signed({1'b0, color_2_q[AT+:8]}) - $signed({1'b0, fog_q[8*c+:8]});
          assign weighed    = 23'(difference * $signed({1'b0, factor_q}));
          assign rounded    = $signed({3'b000, fog_q[8*c+:8], 12'd2048}) + weighed;
          assign mixed[AT+:8] = is_fogged_2_q ? rounded[19:12] : color_2_q[AT+:8];
        end else begin : gen_alpha
          assign mixed[AT+:8] = color_2_q[AT+:8];
        end
      end
    end
  endgenerate

endmodule
