// Texture coordinates: from a sample's q, u and v to the texel that holds the place, one sample per lane and clock,
// eight clocks.
//
//   0  normalise    e = floor(log2 q), m the highest k bits of q
//   1  reciprocal   of m, four clocks                         | the shift of P
//   2  axes         P narrowed, next to the reciprocal; product, place, wrap (texture_axis.sv)
// Texture constants wait in RAMs, a word for each stamp in the unit, and are read where they are needed; samples that
// go together belong to one stamp, and share nothing else. A fixed pipeline without enables. Specification: divide_by_q
// of model/stages/perspective.hpp, and that of texture_axis.
module texture_coordinates #(
    parameter int LANES = 1,              // samples per clock, each with its own multipliers: 1 or 4
    parameter int Q_BITS = 27,            // bits of q, unsigned
    parameter int P_BITS = 28,            // bits of u and v over w, signed
    parameter int MANTISSA = 18,          // k: bits of q that its reciprocal looks at
    parameter int NARROW = 17,            // k_P: bits of P in the product
    parameter int FRACTION = 8,           // f: fraction bits of a coordinate, texels
    parameter int SHIFT_BITS = 6,         // bits of c, signed
    parameter int REACH_BITS = 5,         // bits of x
    parameter int REFERENCE_BITS = 24,    // bits of u_ref, signed
    parameter int QUEUE = 16,             // stamps in the unit; a power of two
    parameter int SIDE_BITS = 12,         // log2 of the longest side, texels
    parameter int LINEAR = 0,  // 1: also the two texels whose centres are around the place; 2: the place alone
    parameter int RECIPROCAL = 0,         // 0 from a table, 1 by division
    parameter int BORDER = 0,             // 1: texels may be the border's
    parameter int INDEX = $clog2(QUEUE),  // derived; not to be set
    parameter int EXPONENT = 5            // bits of e
) (
    input logic clk_i,

    // Constants of a stamp; u lowest
    input logic                        frame_valid_i,
    input logic [INDEX-1:0]            frame_index_i,
    input logic [2*SHIFT_BITS-1:0]     shift_i,      // c, at least -NARROW
    input logic [2*REACH_BITS-1:0]     reach_i,      // x
    input logic [2*REFERENCE_BITS-1:0] reference_i,  // u_ref

    // The samples
    input logic [INDEX-1:0]        index_i,  // index of their stamp
    input logic [LANES*Q_BITS-1:0] q_i,      // not 0
    input logic [LANES*P_BITS-1:0] u_i,
    input logic [LANES*P_BITS-1:0] v_i,

    // Constants of the texture
    input logic [2*SIDE_BITS-1:0] last_i,
    input logic [5:0]             wrap_i,
    input logic                   is_linear_i,

    // For the samples of eight clocks ago, x lowest
    output logic [LANES*2*SIDE_BITS-1:0] texel_o,
    output logic [LANES*2*SIDE_BITS-1:0] next_o,  // LINEAR 1: the next texel, and its weight
    output logic [LANES*16-1:0]          part_o,
    output logic [LANES*4-1:0]           border_o,  // with BORDER: the texel, the next one is the border's
    output logic [LANES*(2*REFERENCE_BITS+16)-1:0] coordinate_o,  // LINEAR 2: the place before wrapping, 2^-8 texels

    // For the samples of one clock ago: floor(log2 q), and the bits of q after its highest
    output logic [LANES*EXPONENT-1:0] exponent_o,
    output logic [LANES*8-1:0]        below_o,

    // For the samples of five clocks ago: the reciprocal, without its highest bit, which is set
    output logic [LANES*(MANTISSA-1)-1:0] reciprocal_o
);

  // The stamp's index, delayed with the sample.
  logic [7*INDEX-1:0] index_q;  // the last clock's lowest
  always_ff @(posedge clk_i) index_q <= {index_q[6*INDEX-1:0], index_i};

  logic [2*SHIFT_BITS-1:0]     shift_ram_q[0:QUEUE-1];
  logic [2*REACH_BITS-1:0]     reach_ram_q[0:QUEUE-1];
  logic [2*REFERENCE_BITS-1:0] reference_ram_q[0:QUEUE-1];
  logic [2*SHIFT_BITS-1:0]     shift;
  logic [2*REACH_BITS-1:0]     reach;
  logic [2*REFERENCE_BITS-1:0] reference;
  assign shift     = shift_ram_q[index_q[INDEX-1:0]];
  assign reach     = reach_ram_q[index_q[5*INDEX+:INDEX]];
  assign reference = reference_ram_q[index_q[6*INDEX+:INDEX]];
  always_ff @(posedge clk_i)
    if (frame_valid_i) begin
      shift_ram_q[frame_index_i]     <= shift_i;
      reach_ram_q[frame_index_i]     <= reach_i;
      reference_ram_q[frame_index_i] <= reference_i;
    end

  // ---------------------------------------------------------------------------------------------------- clock 0: normalise
  // Leading zeros are shifted out by 16, 8, 4, 2, 1: their number, and the bits below the highest.
  function automatic [EXPONENT+30:0] normalised(input [31:0] value);
    logic [31:0]         left;
    logic [EXPONENT-1:0] zeros;
    left = value;
    for (int n = EXPONENT - 1; n >= 0; n--) begin
      zeros[n] = (left >> (32 - (1 << n))) == '0;
      left     = zeros[n] ? left << (1 << n) : left;
    end
    normalised = {zeros, left[30:0]};
  endfunction

  genvar k, n;
  generate
    for (k = 0; k < LANES; k++) begin : gen_lane
      logic [EXPONENT-1:0] zeros;
      logic [30:0]         left;
      assign {zeros, left} = normalised({q_i[k*Q_BITS+:Q_BITS], {(32 - Q_BITS) {1'b0}}});

      logic [MANTISSA-2:0]  mantissa_q;  // without its highest bit
      logic [EXPONENT-1:0]  exponent_q;
      logic [2*P_BITS-1:0]  p_1_q, p_2_q;
      logic [11:0]          amount_q;
      logic [MANTISSA-1:0]  reciprocal;
      always_ff @(posedge clk_i) begin
        mantissa_q <= left[30-:MANTISSA-1];
        exponent_q <= EXPONENT'(Q_BITS - 1) - zeros;
        p_1_q      <= {v_i[k*P_BITS+:P_BITS], u_i[k*P_BITS+:P_BITS]};
        p_2_q      <= p_1_q;
        below_o[8*k+:8] <= left[30:23];
      end
      assign exponent_o[k*EXPONENT+:EXPONENT] = exponent_q;
      assign reciprocal_o[k*(MANTISSA-1)+:MANTISSA-1] = reciprocal[MANTISSA-2:0];

      if (RECIPROCAL == 0) begin : gen_table
        reciprocal_table #(
            .BITS(MANTISSA)
        ) u_reciprocal (
            .clk_i,
            .mantissa_i  (mantissa_q),
            .reciprocal_o(reciprocal)
        );
      end else begin : gen_division
        reciprocal_division #(
            .BITS(MANTISSA)
        ) u_reciprocal (
            .clk_i,
            .mantissa_i  (mantissa_q),
            .reciprocal_o(reciprocal)
        );
      end

      for (n = 0; n < 2; n++) begin : gen_axis
        logic signed [7:0] amount;
        assign amount = 8'($signed(shift[n*SHIFT_BITS+:SHIFT_BITS])) + 8'(exponent_q) + 8'(NARROW);
        always_ff @(posedge clk_i) amount_q[6*n+:6] <= amount[5:0];
        texture_axis #(
            .P_BITS        (P_BITS),
            .MANTISSA      (MANTISSA),
            .NARROW        (NARROW),
            .FRACTION      (FRACTION),
            .REFERENCE_BITS(REFERENCE_BITS),
            .SIDE_BITS     (SIDE_BITS),
            .LINEAR        (LINEAR),
            .BORDER        (BORDER)
        ) u_axis (
            .clk_i,
            .p_i         (p_2_q[n*P_BITS+:P_BITS]),
            .amount_i    (amount_q[6*n+:6]),
            .reciprocal_i(reciprocal[MANTISSA-2:0]),
            .reach_i     (5'(reach[n*REACH_BITS+:REACH_BITS])),
            .reference_i (reference[n*REFERENCE_BITS+:REFERENCE_BITS]),
            .last_i      (last_i[n*SIDE_BITS+:SIDE_BITS]),
            .wrap_i      (wrap_i[3*n+:3]),
            .is_linear_i,
            .texel_o     (texel_o[(2*k+n)*SIDE_BITS+:SIDE_BITS]),
            .next_o      (next_o[(2*k+n)*SIDE_BITS+:SIDE_BITS]),
            .part_o      (part_o[16*k+8*n+:8]),
            .border_o    (border_o[4*k+2*n+:2]),
            .coordinate_o(coordinate_o[(REFERENCE_BITS+8)*(2*k+n)+:REFERENCE_BITS+8])
        );
      end
    end
  endgenerate

endmodule
