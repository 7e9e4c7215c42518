// Colours over w: a sample's colour from its P over q, one sample a clock, eight clocks, in parallel with the
// coordinates and with their reciprocal.
//
//   1, 2  the shift of P, and P narrowed (over_w_narrow.sv)
//   5     the product with the reciprocal
//   6     times 2^x, rounded to a code
//   7     clamped to the range of the vertices' codes
// Constants of a triangle wait in RAMs, a word for each stamp in the unit, like those of coordinates. A fixed pipeline
// without enables. Specification: over_q, color_over_q of model/stages/perspective.hpp.
module colors_over_w #(
    parameter int CHANNELS = 3,           // channels of a colour, a multiplier each
    parameter int P_BITS = 24,            // bits of P in a tile, signed; at least 18
    parameter int MANTISSA = 18,          // k
    parameter int NARROW = 13,            // k_P
    parameter int SHIFT_BITS = 6,         // bits of c, signed
    parameter int REACH_BITS = 4,         // bits of x, at most 8
    parameter int QUEUE = 16,             // stamps in the unit; a power of two
    parameter int INDEX = $clog2(QUEUE),  // derived; not to be set
    parameter int EXPONENT = 5            // bits of e
) (
    input logic clk_i,

    // Constants of a stamp; red lowest
    input logic                           frame_valid_i,
    input logic [INDEX-1:0]               frame_index_i,
    input logic [CHANNELS*SHIFT_BITS-1:0] shift_i,     // c
    input logic [CHANNELS*REACH_BITS-1:0] reach_i,     // x
    input logic [CHANNELS*8-1:0]          least_i,     // minimum of the vertices' codes
    input logic [CHANNELS*8-1:0]          greatest_i,

    // The sample; its divisor, one and five clocks later
    input logic [INDEX-1:0]           index_i,  // index of its stamp
    input logic [CHANNELS*P_BITS-1:0] p_i,
    input logic [EXPONENT-1:0]        exponent_i,    // floor(log2 q)
    input logic [MANTISSA-2:0]        reciprocal_i,  // below its highest bit, which is set

    output logic [CHANNELS*8-1:0] color_o  // for the sample of eight clocks ago
);

  logic [7*INDEX-1:0] index_q;  // the last clock's lowest
  always_ff @(posedge clk_i) index_q <= {index_q[6*INDEX-1:0], index_i};

  logic [CHANNELS*SHIFT_BITS-1:0] shift_ram_q[0:QUEUE-1];
  logic [CHANNELS*REACH_BITS-1:0] reach_ram_q[0:QUEUE-1];
  logic [CHANNELS*16-1:0]         range_ram_q[0:QUEUE-1];
  logic [CHANNELS*SHIFT_BITS-1:0] shift;
  logic [CHANNELS*REACH_BITS-1:0] reach;
  logic [CHANNELS*8-1:0]          least, greatest;
  assign shift             = shift_ram_q[index_q[0+:INDEX]];
  assign reach             = reach_ram_q[index_q[5*INDEX+:INDEX]];
  assign {greatest, least} = range_ram_q[index_q[6*INDEX+:INDEX]];
  always_ff @(posedge clk_i)
    if (frame_valid_i) begin
      shift_ram_q[frame_index_i] <= shift_i;
      reach_ram_q[frame_index_i] <= reach_i;
      range_ram_q[frame_index_i] <= {greatest_i, least_i};
    end

  logic [CHANNELS*P_BITS-1:0] p_1_q, p_2_q;
  always_ff @(posedge clk_i) begin
    p_1_q <= p_i;
    p_2_q <= p_1_q;
  end

  genvar n;
  generate
    for (n = 0; n < CHANNELS; n++) begin : gen_channel
      // Below 0 a value that is not 0 saturates, as at 0.
      logic signed [7:0] amount;
      logic [5:0]        amount_q;
      logic [NARROW:0]   narrow, narrow_q;
      assign amount = 8'($signed(shift[n*SHIFT_BITS+:SHIFT_BITS])) + 8'(exponent_i) + 8'(NARROW);
      always_ff @(posedge clk_i) amount_q <= amount[5:0] & {6{!amount[7]}};
      over_w_narrow #(
          .P_BITS(P_BITS),
          .NARROW(NARROW)
      ) u_narrow (
          .clk_i,
          .p_i     (p_2_q[n*P_BITS+:P_BITS]),
          .amount_i(amount_q),
          .narrow_o(narrow)
      );

      // As in texture_axis: the highest bit of the reciprocal is separate. |Pn| <= 2^NARROW, r < 2^MANTISSA.
      localparam int PRODUCT = NARROW + 1 + MANTISSA;
      logic signed [PRODUCT-1:0] short_product, product_q;
      assign short_product = $signed(narrow_q) * $signed({1'b0, reciprocal_i});
      always_ff @(posedge clk_i) begin
        narrow_q  <= narrow;
        product_q <= short_product + $signed({narrow_q, {(MANTISSA - 1) {1'b0}}});
      end

      // The product times 2^x, x up to 8, and a half below the point. Nothing exceeds 2^9 + 1/2.
      localparam int POINT = MANTISSA + NARROW - 1;
      localparam int WHOLE = 11;  // bits of a code, signed
      logic signed [POINT+WHOLE-1:0] placed;
      logic signed [WHOLE-1:0]       code_q;
      logic [7:0]                    held;
      assign placed = (POINT + WHOLE)'(product_q) <<< reach[n*REACH_BITS+:REACH_BITS];
      assign held   = code_q < $signed(WHOLE'(least[n*8+:8]))    ? least[n*8+:8] :
                      code_q > $signed(WHOLE'(greatest[n*8+:8])) ? greatest[n*8+:8] : code_q[7:0];
      always_ff @(posedge clk_i) begin
        code_q           <= placed[POINT+:WHOLE] + WHOLE'(placed[POINT-1]);
        color_o[n*8+:8] <= held;
      end
    end
  endgenerate

endmodule
